//! Crossing and turning paths at junctions, driveways and the exits of lots.

use super::super::story::{BASE, FROM_LEFT, FROM_RIGHT, From, Partners, Story};
use recrash_model::account::ContactState::{Moving, Parked as StandsParked};
use recrash_model::account::CrashType;
use recrash_model::template::Movement::{EnteringTraffic, LeftTurn, Parked, RightTurn, Straight};
use recrash_model::template::RoadType::{Highway, Intersection, TrafficCircle};
use recrash_model::zones::ContactZone::{Front, FrontLeft, FrontRight, Left, RearLeft, RearRight, Right};

const CROSSES: Story = Story {
    kind: CrashType::Intersection,
    state: Moving,
    road: Intersection,
    sv: Straight,
    sv_mph: (4, 28),
    cp_mph: (8, 40),
    ..BASE
};

pub const STORIES: &[Story] = &[
    Story {
        from: From::Left,
        incidents: 3,
        cp_mph: (15, 45),
        contacts: FROM_LEFT,
        tellings: &[
            "{Sv} was {heading} on {street} in {lane} and entered the intersection with {cross} on a green light{at}. {Cp} traveling {cp_heading} on {cross} ran the red light{cp_at} and came from the left into the path of {sv}.",
            "With a green light, {sv} proceeded straight across {cross}{at}. {Cp} came from its left without stopping for the red signal.",
            "{Sv} had made a full stop at the four-way stop of {street} and {cross} and went ahead as its turn came. {Cp} coming {cp_heading} from the left rolled through its own stop sign{cp_at}.",
        ],
        ..CROSSES
    },
    Story {
        from: From::Right,
        incidents: 3,
        cp_mph: (12, 45),
        contacts: FROM_RIGHT,
        tellings: &[
            "{Sv} traveling {heading} on {street} entered the intersection at {cross} on green{at}. From the right, {cp} {cp_heading} on {cross} ran a red light{cp_at}.",
            "{Sv} was passing through the intersection of {street} and {cross} in {lane}. {Cp} entered from the right side street past its stop sign{cp_at} and the two collided.",
            "At the all-way stop of {street} and {cross}, {sv} arrived first and proceeded. {Cp} arriving from its right did not stop.",
        ],
        ..CROSSES
    },
    Story {
        cp: Some(LeftTurn),
        from: From::Opposite,
        incidents: 3,
        sv_mph: (12, 34),
        cp_mph: (8, 22),
        contacts: &[(&[Front], &[Right]), (&[FrontLeft], &[FrontRight]), (&[FrontLeft, Left], &[Front])],
        tellings: &[
            "{Sv} was {heading} on {street} in {lane} and entered {cross} on a green light{at}. {Cp} coming {cp_heading} the other way turned left across its path{cp_at}.",
            "An oncoming driver in {cp} waiting to turn left from {street} onto {cross} misjudged the gap and turned left in front of {sv}, which was going straight on{at}.",
            "{Sv} proceeded through the intersection on yellow. {Cp} facing it began an unprotected left turn and crossed its lane.",
        ],
        ..CROSSES
    },
    Story {
        cp: Some(LeftTurn),
        from: From::Left,
        incidents: 1,
        cp_mph: (6, 20),
        contacts: &[(&[FrontLeft], &[Right]), (&[FrontLeft, Left], &[FrontRight])],
        tellings: &[
            "{Sv} was {heading} in {lane} of {street}{at}. {Cp} stopped at the stop sign on {cross}, to the left, then turned left into the lane of {sv} without waiting for it to pass.",
            "{Cp} coming from the left on {cross} turned left onto {heading} {street} against a red light{cp_at} and hit the side of {sv}, which had green.",
        ],
        ..CROSSES
    },
    Story {
        cp: Some(LeftTurn),
        from: From::Right,
        incidents: 1,
        cp_mph: (6, 20),
        contacts: &[(&[Front], &[Left]), (&[FrontRight], &[FrontLeft])],
        tellings: &[
            "{Sv} was going straight through the intersection when {cp} ran the stop sign on the right{cp_at} and turned left across its lane.",
        ],
        ..CROSSES
    },
    Story {
        sv: LeftTurn,
        from: From::Opposite,
        incidents: 2,
        sv_mph: (3, 15),
        cp_mph: (15, 42),
        contacts: &[(&[Right], &[Front]), (&[FrontRight], &[FrontLeft]), (&[RearRight, Right], &[Front])],
        tellings: &[
            "{Sv} was making a left turn from {heading} {street} onto {cross} on a green arrow{at}. {Cp} coming {cp_heading} ran the red light{cp_at} and struck it.",
            "While {sv} was completing an unprotected left turn at {cross}, {cp} coming the other way sped up to make the yellow light and hit it on the passenger side.",
        ],
        ..CROSSES
    },
    Story {
        sv: LeftTurn,
        from: From::Right,
        incidents: 1,
        sv_mph: (4, 15),
        contacts: &[(&[RearRight], &[Front]), (&[Right], &[FrontLeft])],
        tellings: &["{Sv} was turning left on a green light{at} when {cp} ran the red light from the right."],
        ..CROSSES
    },
    Story {
        sv: LeftTurn,
        work_zone: true,
        from: From::Opposite,
        incidents: 1,
        sv_mph: (4, 12),
        cp_mph: (12, 30),
        contacts: &[(&[Right, FrontRight], &[Front]), (&[FrontRight], &[FrontLeft])],
        tellings: &[
            "Traffic cones closed the left turn lane at {cross}. {Sv} made its left turn from the through lane as the signs ask. Oncoming, {cp} went straight on and struck it.",
        ],
        ..CROSSES
    },
    Story {
        sv: RightTurn,
        from: From::Left,
        incidents: 2,
        sv_mph: (3, 12),
        contacts: &[(&[RearLeft], &[FrontRight]), (&[Left], &[Front])],
        tellings: &[
            "{Sv} was making a right turn from {heading} {street} onto {cross}{at} after a full stop. {Cp} traveling {cp_heading} on {cross} came from the left and struck its left side.",
            "{Sv} was turning right on a green light from {heading} {street}{at}. {Cp} traveling {cp_heading} on {cross} ran the red light{cp_at} and struck its left side.",
        ],
        ..CROSSES
    },
    Story {
        cp: Some(RightTurn),
        from: From::Right,
        incidents: 2,
        sv_mph: (10, 30),
        cp_mph: (5, 16),
        contacts: &[(&[FrontRight], &[Left]), (&[Front, FrontRight], &[RearLeft]), (&[Right], &[FrontLeft])],
        tellings: &[
            "{Sv} was {heading} on {street} in the right lane{at} with a green light. {Cp} on {cross} turned right on red from the right side into its lane{cp_at}.",
            "{Cp} rolled past the stop sign on the right and made a wide right turn into the lane in which {sv} was going straight on.",
        ],
        ..CROSSES
    },
    Story {
        cp: Some(RightTurn),
        incidents: 1,
        sv_mph: (6, 25),
        cp_mph: (8, 22),
        contacts: &[(&[FrontLeft], &[Right]), (&[Front, FrontLeft], &[RearRight, Right])],
        tellings: &[
            "{Sv} was going straight through {cross} in the right lane{at}. {Cp} in the lane to its left turned right across its front.",
        ],
        ..CROSSES
    },
    Story {
        sv: LeftTurn,
        cp: Some(LeftTurn),
        from: From::Opposite,
        incidents: 1,
        sv_mph: (4, 12),
        cp_mph: (6, 16),
        contacts: &[(&[FrontRight], &[FrontRight])],
        tellings: &[
            "{Sv} was turning left from {heading} {street} onto {cross}. {Cp} traveling {cp_heading} on {street} was turning left at the same time, cut its turn short, and clipped {sv}.",
        ],
        ..CROSSES
    },
    Story {
        sv: LeftTurn,
        cp: Some(RightTurn),
        from: From::Opposite,
        incidents: 1,
        sv_mph: (5, 14),
        cp_mph: (5, 16),
        contacts: &[(&[FrontRight], &[Left]), (&[Right], &[FrontLeft])],
        tellings: &[
            "{Sv} was turning left from {street} onto {cross} on a green arrow{at}. {Cp} traveling {cp_heading} on {street} turned right at the same time and took the same exit lane.",
        ],
        ..CROSSES
    },
    Story {
        sv: RightTurn,
        cp: Some(LeftTurn),
        from: From::Opposite,
        incidents: 1,
        sv_mph: (5, 11),
        cp_mph: (8, 18),
        contacts: &[(&[FrontLeft], &[FrontRight])],
        tellings: &[
            "{Sv} was turning right from {street} onto {cross} on a green light{at}. {Cp} traveling {cp_heading} on {street} turned left without yielding and ran wide into the lane of {sv}.",
        ],
        ..CROSSES
    },
    Story {
        road: TrafficCircle,
        sv: LeftTurn,
        cp: Some(LeftTurn),
        from: From::Right,
        incidents: 1,
        sv_mph: (8, 14),
        cp_mph: (8, 18),
        contacts: &[(&[FrontRight], &[FrontLeft])],
        tellings: &[
            "{Sv} was circulating in the roundabout at {street} and {cross} to take the third exit{at}. {Cp} entered from the right without stopping at the yield sign, also going around to the left.",
        ],
        ..CROSSES
    },
    Story {
        sv: LeftTurn,
        incidents: 1,
        sv_mph: (3, 14),
        cp_mph: (10, 30),
        contacts: &[(&[Left], &[Right]), (&[FrontLeft], &[FrontRight])],
        tellings: &[
            "{Sv} was turning left from the left turn lane of {street} onto {cross}{at}. {Cp} behind it crossed the double yellow line and tried to pass on the left.",
            "With its turn signal on, {sv} began a left turn at {cross}. {Cp} overtook it on the left{cp_at} and the two touched.",
        ],
        ..CROSSES
    },
    Story {
        road: Highway,
        cp: Some(LeftTurn),
        partners: Partners::Trucks,
        incidents: 2,
        sv_mph: (35, 60),
        cp_mph: (15, 45),
        contacts: &[(&[FrontRight], &[Left]), (&[Front, FrontRight], &[FrontLeft, Left])],
        tellings: &[
            "{Sv} was {heading} in {llane} of {street}{at}. {Cp} in the lane to its right turned left towards an opening in the median, across the path of {sv}.",
            "{Sv} was {heading} in {llane} of {street}{at}. {Cp} in the lane to its right made a left turn towards a median crossover{cp_at} and crossed in front of {sv}.",
        ],
        ..CROSSES
    },
    // From here on outside of the paper's templates.
    Story {
        road: BASE.road,
        cp: Some(EnteringTraffic),
        from: From::Right,
        incidents: 1,
        sv_mph: (10, 28),
        cp_mph: (4, 12),
        contacts: &[(&[FrontRight], &[FrontLeft]), (&[Right], &[Front])],
        tellings: &[
            "{Sv} was traveling {heading} on {street}{at} when {cp} pulled out of a driveway on the right and struck it.",
            "{Sv} was {heading} on {street}{at}. {Cp} pulled out of the exit of a parking lot on the right{cp_at} into the path of {sv}.",
        ],
        ..CROSSES
    },
    Story {
        state: BASE.state,
        sv: BASE.sv,
        cp: Some(LeftTurn),
        from: From::Left,
        incidents: 2,
        sv_mph: (0, 0),
        cp_mph: (4, 15),
        contacts: &[(&[FrontLeft], &[FrontLeft]), (&[FrontLeft, Left], &[Left])],
        tellings: &[
            "{Sv} was stopped at a red light on {heading} {street} at {cross}. {Cp} turning left from {cross} onto {street} cut the corner{cp_at} and struck it.",
            "{Sv} was stopped at the stop sign when {cp} made a left turn from {cross}, from the left of {sv}, and turned too tightly.",
        ],
        ..CROSSES
    },
    Story {
        state: BASE.state,
        sv: BASE.sv,
        cp: Some(RightTurn),
        from: From::Right,
        incidents: 1,
        sv_mph: (0, 0),
        cp_mph: (4, 12),
        contacts: &[(&[FrontLeft], &[Left])],
        tellings: &[
            "{Sv} was stopped at the stop line of {cross}. {Cp} coming from the right on {cross} made a wide right turn into {street} and made contact with it.",
        ],
        ..CROSSES
    },
    Story {
        state: StandsParked,
        sv: Parked,
        cp: Some(LeftTurn),
        from: From::Left,
        incidents: 1,
        sv_mph: (0, 0),
        cp_mph: (5, 15),
        contacts: &[(&[RearLeft], &[Front])],
        tellings: &[
            "{Sv} was parked on {heading} {street} just past {cross}. {Cp} made a left turn from {cross}{cp_at}, lost grip on the wet road, and struck it.",
        ],
        ..CROSSES
    },
];
