//! Front on rear, one way: most often into a subject vehicle that stands.

use super::super::story::{BASE, Story};
use recrash_model::account::ContactState::{Moving, SettingOff};
use recrash_model::template::Movement::{LeftTurn, RightTurn, Stopped, Straight};
use recrash_model::template::RoadType::{Highway, Intersection, ParkingLot};
use recrash_model::zones::ContactZone::{Front, FrontLeft, FrontRight, Rear, RearLeft, RearRight};

pub const STORIES: &[Story] = &[
    Story {
        road: Intersection,
        incidents: 18,
        tellings: &[
            "{Sv} came to a stop for a red light on {heading} {street} at {cross}. {Cp} approached from behind{cp_at} and did not stop.",
            "{Sv} came to a stop for the red signal at {cross}. About four seconds later {cp} behind it ran into its back.",
            "While waiting at the light, {heading} on {street} in {lane}, {sv} was struck from behind by {cp}.",
            "{Sv} was the second vehicle of a queue at the red light of {street} and {cross}. {Cp} approaching from behind slowed too late{cp_at}.",
            "{Sv} slowed and stopped behind the limit line for a red light. {Cp} that had been standing behind it let go of the brake and rolled into it.",
            "The light at {cross} was red and {sv} was stationary in {lane}. The driver of {cp} behind it moved off when the light of the turn lane changed, and hit the rear of {sv}.",
            "{Sv} slowed to a stop in {lane} of {street} behind other cars at a red light. {Cp} came up from behind{cp_at} and rear-ended it.",
            "Stopped at the signal of {street} and {cross}, {sv} was rear-ended by {cp}{cp_at}.",
        ],
        ..BASE
    },
    Story {
        incidents: 11,
        tellings: &[
            "{Sv} came to a stop in a queue of traffic on {heading} {street} when {cp} approached from behind{cp_at} and struck it.",
            "Traffic ahead on {street} had come to a halt. {Sv} came to a stop behind it, and {cp} following {sv} ran into its rear.",
            "{Sv} was {heading} on {street} in {lane} and came to a stop behind a line of cars. {Cp} behind it ran into its rear{cp_at}.",
            "With a bus loading ahead, {sv} stood in {lane} of {street}. {Cp} approaching from behind hit its rear bumper.",
            "{Sv} slowed to a stop as the vehicle ahead of it stopped. {Cp} traveling behind {sv}{cp_at} failed to stop and made contact with its rear.",
            "Stopped in traffic on {heading} {street}, {sv} was struck from behind by {cp}, whose driver had looked away.",
        ],
        ..BASE
    },
    Story {
        incidents: 6,
        tellings: &[
            "{Sv} pulled over on {heading} {street} and came to a stop for a passenger drop-off. {Cp} came up from behind{cp_at} and hit its rear.",
            "{Sv} came to a stop on {street} with its hazard lights on to pick up a rider. {Cp} approaching from behind did not go around it and ran into its back.",
            "During a drop-off on {street}, {sv} stood at the curb when {cp} behind it rolled forward into it{cp_at}.",
        ],
        ..BASE
    },
    Story {
        road: Intersection,
        incidents: 8,
        cp_mph: (2, 12),
        tellings: &[
            "{Sv} came to a stop at the stop sign on {street}. {Cp} behind it kept rolling{cp_at} and bumped its rear.",
            "{Sv} slowed to a stop at a crosswalk of {street} and {cross}, yielding to a pedestrian, when {cp} approaching from behind struck it.",
            "At the stop sign of {cross}, {sv} waited for cross traffic. The driver of {cp} behind it thought that it had gone, moved up and made contact with its rear.",
            "{Sv} stopped to yield to two people on the crosswalk. {Cp} behind it failed to stop{cp_at}.",
            "{Sv} had been standing at the stop line for ten seconds when {cp} bumped into it from behind.",
        ],
        ..BASE
    },
    Story {
        incidents: 6,
        tellings: &[
            "{Sv} came to a stop on {heading} {street} to let an oncoming truck through. {Cp} behind it did not notice{cp_at} and hit its rear.",
            "A car ahead was parallel parking, so {sv} stopped and waited. {Cp} approaching from behind ran into it.",
            "{Sv} was stopped in {lane} of {street} behind a double-parked van, waiting for a gap, when {cp} drove into it from behind.",
            "{Sv} came to a stop for a dog on {street}. {Cp} following it braked late and struck the rear of {sv}{cp_at}.",
        ],
        ..BASE
    },
    Story {
        road: Highway,
        incidents: 2,
        cp_mph: (10, 35),
        tellings: &[
            "Traffic on {heading} {street} had come to a standstill. {Sv} was stopped in {lane}, and {cp} approaching from behind ran into its rear{cp_at}.",
            "{Sv} was stopped at the end of a queue on the off-ramp of {street} when {cp} struck it from behind.",
        ],
        ..BASE
    },
    Story {
        road: ParkingLot,
        incidents: 2,
        cp_mph: (2, 7),
        tellings: &[
            "{Sv} was stopped at the exit of a parking lot, waiting for a gap, when {cp} behind it moved forward and bumped its rear.",
            "{Sv} stood in the aisle of a parking lot because a shopper crossed ahead of it. {Cp} behind it rolled into its rear{cp_at}.",
        ],
        ..BASE
    },
    Story {
        road: Intersection,
        cp: Some(RightTurn),
        incidents: 2,
        cp_mph: (2, 10),
        tellings: &[
            "{Sv} was stopped at the yield line of the right turn lane at {cross}. {Cp} behind it looked left, moved up to turn right, and hit the rear of {sv}.",
            "Waiting to turn right on red from {street}, {sv} was stationary. {Cp} behind it, also turning right, ran into its back{cp_at}.",
        ],
        ..BASE
    },
    // From here on the subject vehicle rolls.
    Story {
        state: SettingOff,
        road: Intersection,
        sv: Straight,
        incidents: 3,
        sv_mph: (1, 3),
        cp_mph: (2, 14),
        tellings: &[
            "{Sv} was stopped at a red light on {heading} {street} at {cross}, second in line. The light changed, {sv} began to roll, and {cp} behind it moved off faster and ran into it.",
            "Waiting at the signal on {heading} {street}, {sv} had just started forward on green when {cp} that had been standing behind it drove into its back{cp_at}.",
            "The light at {cross} turned green and {sv} began to move forward slowly behind the car ahead. {Cp} behind it accelerated and hit the rear of {sv}.",
        ],
        ..BASE
    },
    Story {
        state: Moving,
        road: Intersection,
        sv: Straight,
        incidents: 4,
        sv_mph: (3, 22),
        cp_mph: (10, 35),
        tellings: &[
            "{Sv} was {heading} on {street} in {lane}{at}. The light at {cross} turned yellow, {sv} slowed, and {cp} following closely hit it from behind{cp_at}.",
            "As {sv} neared {cross} on a green light it braked for a dog that ran off the median. {Cp} behind it braked late and made contact.",
            "While approaching a crosswalk on {heading} {street}, {sv} slowed for two pedestrians. {Cp} in the same lane did not slow down.",
            "{Sv} braked for an ambulance that was crossing the intersection of {street} and {cross} with its siren on. {Cp} behind {sv} could not stop and rear-ended it.",
            "{Sv} let a bus merge back into {lane} just before {cross}. The driver of {cp} behind it was said to be looking at a phone and ran into the rear of {sv}{cp_at}.",
        ],
        ..BASE
    },
    Story {
        state: Moving,
        sv: Straight,
        incidents: 9,
        sv_mph: (5, 25),
        cp_mph: (12, 38),
        tellings: &[
            "{Sv} slowed for a speed bump on {street} and {cp} behind it ran into its rear.",
            "{Sv} was {heading} on {street} in {lane}{at} when {cp} approached from behind{cp_at} and struck it.",
            "{Sv} was slowing for a queue ahead on {heading} {street}. {Cp} traveling behind it ran into its rear{cp_at}.",
            "A box truck ahead signaled to pull out, and {sv} slowed to let it go{at}. {Cp} following {sv} made contact with its rear.",
            "{Sv} was traveling {heading} on {street}{at}. A van ahead braked, {sv} braked too, and {cp} behind it could not slow in time.",
        ],
        ..BASE
    },
    Story {
        state: Moving,
        road: Highway,
        sv: Straight,
        incidents: 2,
        sv_mph: (30, 62),
        cp_mph: (45, 75),
        tellings: &[
            "Traffic on {street} slowed for a stalled car. {Sv} slowed with it, in {lane}, and was hit from behind by {cp}{cp_at}.",
            "{Sv} was traveling {heading} in {lane} of {street}{at} when {cp} came up from behind much faster and did not change lanes.",
        ],
        ..BASE
    },
    Story {
        state: Moving,
        road: Highway,
        sv: Straight,
        work_zone: true,
        incidents: 1,
        sv_mph: (3, 25),
        cp_mph: (20, 50),
        tellings: &[
            "{Sv} slowed for the end of a queue before a lane closure marked with cones on {heading} {street}. {Cp} behind it did not slow down in time{cp_at}.",
        ],
        ..BASE
    },
    Story {
        state: Moving,
        road: Intersection,
        sv: Straight,
        incidents: 1,
        sv_mph: (6, 20),
        cp_mph: (0, 8),
        contacts: &[(&[Front], &[Rear]), (&[FrontLeft, Front, FrontRight], &[RearLeft, Rear, RearRight])],
        tellings: &[
            "{Sv} was following {cp} through {cross}{at}. Its driver stopped abruptly for a squirrel, and {sv} braked but touched its rear.",
        ],
        ..BASE
    },
    Story {
        state: Moving,
        sv: Straight,
        cp: Some(Stopped),
        incidents: 2,
        sv_mph: (3, 12),
        cp_mph: (0, 0),
        contacts: &[(&[Front], &[Rear]), (&[FrontRight], &[RearLeft])],
        tellings: &[
            "{Sv} was following {cp} on {heading} {street}{at}. {It} stopped suddenly for a pedestrian, and the front of {sv} made contact with its rear.",
            "{Cp} had stopped in {lane} of {street} ahead of {sv}. {Sv} braked but did not stop in time{at} and ran into the rear of {it}.",
        ],
        ..BASE
    },
    Story {
        road: Intersection,
        sv: RightTurn,
        incidents: 1,
        cp_mph: (3, 15),
        tellings: &[
            "{Sv} had pulled up to the line to turn right on red from {street}, moved a little, and stopped for a cyclist. {Cp} behind it drove on and hit it from behind{cp_at}.",
            "{Sv} was turning right onto {cross} and stopped for pedestrians in the crosswalk. {Cp} following it did not.",
        ],
        ..BASE
    },
    Story {
        state: SettingOff,
        road: Intersection,
        sv: LeftTurn,
        incidents: 1,
        sv_mph: (1, 4),
        cp_mph: (4, 14),
        tellings: &[
            "{Sv} was stopped in the left turn lane of {heading} {street} and began to move off on the green arrow. {Cp} behind it moved off faster and hit it from behind.",
        ],
        ..BASE
    },
    Story {
        road: Intersection,
        sv: RightTurn,
        cp: Some(RightTurn),
        incidents: 1,
        cp_mph: (2, 14),
        tellings: &[
            "{Sv} was in the right turn slip lane from {street} to {cross} and stopped at the yield sign for a car. {Cp} also turning right looked left and ran into its back{cp_at}.",
            "{Sv} and {cp} were both turning right on red. {Sv} stopped again for cross traffic and {it} behind it ran into its rear.",
        ],
        ..BASE
    },
    Story {
        road: Intersection,
        sv: LeftTurn,
        cp: Some(LeftTurn),
        incidents: 1,
        cp_mph: (3, 12),
        tellings: &[
            "{Sv} was turning left behind a line of cars and stopped inside the turn because the exit was full. {Cp} behind it, also turning left, ran into its rear{cp_at}.",
        ],
        ..BASE
    },
    Story {
        sv: Straight,
        state: SettingOff,
        incidents: 4,
        sv_mph: (1, 4),
        cp_mph: (4, 14),
        tellings: &[
            "{Sv} had stopped on {street} for a parking car and began to move again{at}. {Cp} behind it moved off faster and ran into its rear.",
            "After a drop-off on {heading} {street}, {sv} began to move forward when {cp} hit it from behind{cp_at}.",
        ],
        ..BASE
    },
];
