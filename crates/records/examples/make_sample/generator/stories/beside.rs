//! Side by side, one way: passed too closely while standing, lane changes, drifts, double turn lanes.

use super::super::story::{
    BASE, CUT_IN_FROM_LEFT, CUT_IN_FROM_RIGHT, DRIFT_FROM_LEFT, DRIFT_FROM_RIGHT, PASSES_ON_THE_LEFT,
    PASSES_ON_THE_RIGHT, Partners, Story,
};
use super::super::telling::WIDE;
use recrash_model::account::ContactState::{Moving, Parked as StandsParked};
use recrash_model::account::CrashType::Lateral;
use recrash_model::template::Movement::{
    ChangingLanes, EnteringTraffic, LaneDeparture, LeftTurn, Merging, Parked, Passing, RightTurn, Straight,
};
use recrash_model::template::RoadType::{Highway, Intersection, ParkingLot};
use recrash_model::zones::ContactZone::{FrontLeft, FrontRight, Left, RearLeft, RearRight, Right};

const STANDS: Story = Story { kind: Lateral, cp: Some(Passing), cp_mph: (3, 20), contacts: PASSES_ON_THE_LEFT, ..BASE };
const MOVES: Story = Story { kind: Lateral, state: Moving, sv: Straight, cp: Some(Straight), ..BASE };

pub const STORIES: &[Story] = &[
    Story {
        incidents: 6,
        tellings: &[
            "{Sv} came to a stop in a queue on {heading} {street}. {Cp} behind it went around it on the left{cp_at} and scraped along its side.",
            "{Sv} was stopped behind a double-parked truck on {street} when {cp} passed it on the left and touched it.",
            "While {sv} waited for a gap to go around a parked bus, {cp} behind it tried to pass on the left and made contact with it.",
            "{Sv} came to a stop on {heading} {street} behind stopped traffic. {Cp} traveling the same way squeezed past on its left{cp_at}.",
            "A narrow gap was left beside {sv}, which was stopped in {lane} of {street} to yield. {Cp} passed on the left side and did not keep clear of {sv}.",
        ],
        ..STANDS
    },
    Story {
        incidents: 3,
        contacts: PASSES_ON_THE_RIGHT,
        tellings: &[
            "{Sv} was stopped in the left lane of {street} waiting to turn. {Cp} behind it passed on the right{cp_at} and touched its side.",
            "{Sv} slowed to a stop for a queue on {heading} {street}. {Cp} behind it passed it on the right{cp_at} and came too close.",
        ],
        ..STANDS
    },
    Story {
        incidents: 4,
        tellings: &[
            "{Sv} pulled over and came to a stop on {heading} {street} for a passenger drop-off. {Cp} approaching from behind passed on the left{cp_at} and made contact with it.",
            "{Sv} stood at the curb with its hazard lights on to pick up a rider. The driver of {cp} went around it on the left and cut back too early.",
            "During a pick-up on {street}, {sv} was stopped when {cp} passing it on the left brushed its side.",
        ],
        ..STANDS
    },
    Story {
        road: Intersection,
        cp: Some(ChangingLanes),
        incidents: 3,
        contacts: &[(&[FrontLeft], &[Right]), (&[FrontLeft], &[RearRight])],
        tellings: &[
            "{Sv} came to a stop at a red light on {street} at {cross}. {Cp} in the lane to its left changed lanes to the right ahead of it and made contact with it.",
            "{Sv} was stationary in {rlane} at the signal when {cp} in the left turn lane beside it changed lanes to the right{cp_at}.",
        ],
        ..STANDS
    },
    Story {
        road: Intersection,
        incidents: 3,
        tellings: &[
            "{Sv} came to a stop at a red light in {rlane}. {Cp} traveling the same direction passed it on the left{cp_at} and touched it.",
            "{Sv} waited at the crosswalk of {cross}. {Cp} behind it pulled out and passed on the left, scraping its side.",
        ],
        ..STANDS
    },
    Story {
        cp: Some(EnteringTraffic),
        incidents: 2,
        cp_mph: (2, 8),
        contacts: &[(&[Right], &[FrontLeft]), (&[FrontRight], &[Left])],
        tellings: &[
            "{Sv} was stopped in traffic on {heading} {street}. {Cp} parked along the right curb pulled out and made contact with its right side.",
            "{Sv} came to a stop behind a queue. {Cp} beside it pulled away from the right curb and sideswiped {sv}.",
        ],
        ..STANDS
    },
    Story {
        partners: Partners::Of(WIDE),
        incidents: 2,
        cp_mph: (3, 12),
        contacts: &[(&[Left], &[Right]), (&[FrontLeft], &[RearRight])],
        tellings: &[
            "{Sv} was stopped in {rlane} of {street} at the end of a queue. {Cp} in the lane to its left moved forward, and its right side scraped the left mirror of {sv}.",
            "{Sv} stood in {rlane} behind a taxi. {Cp} passing on the left{cp_at} swung its tail towards {sv}.",
        ],
        ..STANDS
    },
    Story {
        state: StandsParked,
        sv: Parked,
        incidents: 7,
        tellings: &[
            "{Sv} was parked at the curb of {heading} {street}, empty. {Cp} passing it on the left scraped its mirror.",
            "{Sv} was legally parked along the right curb of {street} when {cp} traveling the same direction passed it too closely{cp_at}.",
            "{Sv} was parked between two cars, waiting for its next trip. The driver of {cp} passed on the left and made contact with it.",
        ],
        ..STANDS
    },
    Story {
        state: StandsParked,
        sv: Parked,
        cp: Some(LaneDeparture),
        incidents: 1,
        contacts: &[(&[RearLeft], &[FrontRight])],
        tellings: &[
            "{Sv} was parked at the right curb of {heading} {street}. {Cp} traveling the same direction drifted to the right out of its lane{cp_at} and sideswiped it.",
        ],
        ..STANDS
    },
    Story {
        road: ParkingLot,
        state: StandsParked,
        sv: Parked,
        incidents: 2,
        cp_mph: (2, 8),
        contacts: &[(&[Left], &[Right]), (&[RearLeft], &[FrontRight])],
        tellings: &[
            "{Sv} was parked in a marked stall of a parking lot when {cp} passing on the left{cp_at} rubbed along its side.",
        ],
        ..STANDS
    },
    Story {
        cp: Some(ChangingLanes),
        incidents: 2,
        sv_mph: (10, 34),
        cp_mph: (12, 40),
        contacts: CUT_IN_FROM_RIGHT,
        tellings: &[
            "{Sv} was {heading} in {llane} of {street}{at}. {Cp} in the lane to its right changed lanes to the left into it.",
            "Between two junctions, {cp} in the right adjacent lane changed lanes to the left without a signal and made contact with {sv}{at}.",
        ],
        ..MOVES
    },
    Story {
        cp: Some(ChangingLanes),
        incidents: 2,
        sv_mph: (10, 34),
        cp_mph: (12, 40),
        contacts: CUT_IN_FROM_LEFT,
        tellings: &[
            "{Sv} was traveling {heading} in {rlane} of {street}{at} when {cp} in the lane to its left changed lanes to the right in front of it.",
            "{Cp} overtook {sv} on the left{cp_at} and changed lanes to the right before it was clear of {sv}.",
        ],
        ..MOVES
    },
    Story {
        sv: ChangingLanes,
        incidents: 1,
        sv_mph: (8, 24),
        cp_mph: (10, 32),
        contacts: &[(&[Left], &[FrontRight]), (&[RearLeft], &[FrontRight])],
        tellings: &[
            "{Sv} was changing lanes to the left on {heading} {street}{at} when {cp} in the left lane sped up{cp_at} and made contact with it.",
            "{Sv} signaled and began to change lanes to the left around a stopped van. {Cp} coming from behind in the left lane did not yield.",
        ],
        ..MOVES
    },
    Story {
        cp: Some(Merging),
        incidents: 1,
        sv_mph: (10, 30),
        cp_mph: (10, 30),
        contacts: CUT_IN_FROM_RIGHT,
        tellings: &[
            "{Sv} was {heading} in {llane} of {street}{at}. The lane to its right ends there, and {cp} in it merged to the left into {sv}.",
        ],
        ..MOVES
    },
    Story {
        cp: Some(Passing),
        incidents: 1,
        sv_mph: (4, 15),
        cp_mph: (10, 28),
        contacts: PASSES_ON_THE_LEFT,
        tellings: &[
            "{Sv} was slowing down for a drop-off on {heading} {street}{at} when {cp} behind it passed on the left and brushed it.",
            "{Sv} was traveling {heading} on {street}{at}. {Cp} passed it on the left{cp_at} and returned to the lane too early.",
        ],
        ..MOVES
    },
    // Within the paper's templates.
    Story {
        road: Intersection,
        incidents: 2,
        sv_mph: (8, 28),
        cp_mph: (15, 38),
        contacts: CUT_IN_FROM_LEFT,
        tellings: &[
            "{Sv} was {heading} in {rlane} of {street} on a green light{at}. {Cp} in the lane to its left sped up{cp_at}, and inside the intersection with {cross} changed lanes to the right directly in front of it.",
            "Just past the stop line at {cross}, {cp} overtook {sv} on the left and cut in so closely that it touched the left front of {sv}.",
        ],
        ..MOVES
    },
    Story {
        road: Intersection,
        incidents: 2,
        sv_mph: (8, 28),
        cp_mph: (15, 38),
        contacts: CUT_IN_FROM_RIGHT,
        tellings: &[
            "{Sv} was {heading} in {llane} of {street}{at}. {Cp} in the lane to its right met a double-parked car near {cross} and swerved left into the lane of {sv}.",
            "{Cp} passed {sv} on the right{cp_at} and changed lanes to the left in front of it in the middle of the intersection. {Sv} braked but could not open the gap.",
        ],
        ..MOVES
    },
    Story {
        road: Intersection,
        incidents: 1,
        sv_mph: (6, 25),
        cp_mph: (8, 30),
        contacts: DRIFT_FROM_LEFT,
        tellings: &[
            "While {sv} was proceeding straight through {cross}{at}, {cp} to its left drifted right over the dashed line.",
        ],
        ..MOVES
    },
    Story {
        road: Intersection,
        incidents: 1,
        sv_mph: (6, 25),
        cp_mph: (8, 30),
        contacts: DRIFT_FROM_RIGHT,
        tellings: &[
            "{Sv} was {heading} in {llane} of {street}. {Cp} on its right drifted across the lane line in the intersection and rubbed against it.",
        ],
        ..MOVES
    },
    Story {
        road: Intersection,
        sv: RightTurn,
        incidents: 1,
        sv_mph: (2, 12),
        cp_mph: (8, 25),
        contacts: &[(&[Left], &[Right]), (&[FrontLeft], &[RearRight])],
        tellings: &[
            "{Sv} slowed to turn right from {rlane}. {Cp} behind it pulled out to the left, went past straight on{cp_at}, and brushed its left side.",
        ],
        ..MOVES
    },
    Story {
        road: Intersection,
        sv: RightTurn,
        cp: Some(RightTurn),
        incidents: 2,
        sv_mph: (4, 12),
        cp_mph: (6, 18),
        contacts: &[(&[Left], &[Right]), (&[FrontLeft], &[Right]), (&[FrontLeft, Left], &[RearRight, Right])],
        tellings: &[
            "Two lanes turn right from {street} onto {cross}. {Sv} was in the inner one{at}. {Cp} in the outer lane on its left cut the corner and came into its lane.",
            "{Cp} turned right from the lane to the left of {sv}, which was turning right as well, and squeezed it towards the curb.",
        ],
        ..MOVES
    },
    Story {
        road: Intersection,
        sv: LeftTurn,
        cp: Some(LeftTurn),
        incidents: 2,
        sv_mph: (5, 15),
        cp_mph: (6, 18),
        contacts: &[(&[Right], &[Left]), (&[FrontRight], &[Left]), (&[RearRight, Right], &[FrontLeft])],
        tellings: &[
            "Two lanes turn left from {street} to {cross}. {Sv} was in the inner one{at}, {cp} in the outer one, on the right. The partner cut across the dotted guide line into {sv}.",
            "{Sv} was turning left in the left one of two turn lanes on a green arrow{at}. {Cp} turning left in the lane to its right turned too tightly and sideswiped it.",
        ],
        ..MOVES
    },
    Story {
        road: Highway,
        partners: Partners::Trucks,
        incidents: 2,
        sv_mph: (45, 65),
        cp_mph: (50, 75),
        contacts: CUT_IN_FROM_LEFT,
        tellings: &[
            "{Sv} was {heading} on {street} in {rlane}{at}. {Cp} passing on the left{cp_at} changed lanes to the right before it had cleared the front of {sv}.",
            "{Cp} crossed from the left lane to reach the exit and cut in ahead of {sv}.",
        ],
        ..MOVES
    },
    Story {
        road: Highway,
        partners: Partners::Trucks,
        incidents: 1,
        sv_mph: (50, 65),
        cp_mph: (50, 70),
        contacts: DRIFT_FROM_RIGHT,
        tellings: &[
            "{Cp} in the lane to the right of {sv} drifted left over the lane line, {heading} on {street}, and scraped its side{at}.",
        ],
        ..MOVES
    },
    Story {
        road: Highway,
        work_zone: true,
        partners: Partners::Trucks,
        incidents: 2,
        sv_mph: (30, 55),
        cp_mph: (35, 60),
        contacts: CUT_IN_FROM_RIGHT,
        tellings: &[
            "The right lane of {street} was closed for road work with a taper of cones. {Cp} stayed in it to the end and merged left into {sv}, which was in {llane}{at}.",
            "In a construction zone on {heading} {street}, {cp} beside {sv} on the right merged to the left{cp_at} where traffic cones closed its lane.",
        ],
        ..MOVES
    },
];
