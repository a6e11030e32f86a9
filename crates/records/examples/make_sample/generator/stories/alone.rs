//! No other road user: kerbs, debris, potholes, gates, chains, cones, parked vehicles.

use super::super::story::{BASE, Contacts, Partners, Story};
use super::super::telling::{
    CHAINS, CONES, CURBS, DEBRIS, GATES, IMPACTS_OF_THINGS, IMPACTS_UNDERNEATH, LOOSE, PARKED_CARS, POLES, POTHOLES,
    Partner,
};
use recrash_model::account::ContactState::{Moving, Reversing, SettingOff};
use recrash_model::account::CrashType::SingleVehicle;
use recrash_model::template::Movement::{Backing, ChangingLanes, LeftTurn, Parked, RightTurn, Straight};
use recrash_model::template::RoadType::{Highway, Intersection, ParkingLot};
use recrash_model::zones::ContactZone::{Bottom, Front, FrontLeft, FrontRight, Rear, RearRight, Right};

const UNDERNEATH: Contacts = &[(&[Bottom], &[])];
const IN_FRONT: Contacts = &[(&[Front], &[]), (&[FrontRight], &[]), (&[FrontLeft], &[])];
const ALONE: Story = Story {
    kind: SingleVehicle,
    state: Moving,
    sv: Straight,
    cp: None,
    partners: Partners::Of(DEBRIS),
    sv_mph: (5, 25),
    cp_mph: (0, 0),
    contacts: IN_FRONT,
    impacts: IMPACTS_OF_THINGS,
    ..BASE
};
const fn with(partners: &'static [Partner], incidents: usize) -> Story {
    Story { partners: Partners::Of(partners), incidents, ..ALONE }
}

pub const STORIES: &[Story] = &[
    Story {
        contacts: UNDERNEATH,
        impacts: IMPACTS_UNDERNEATH,
        tellings: &[
            "{Sv} was traveling {heading} on {street} in {lane}{at} when it drove over {cp} that lay in the lane.",
            "{Cp} lay in {lane} of {street}. {Sv} braked{at} and ran over it.",
            "{Sv} was {heading} on {street}{at} and struck {cp} in the roadway.",
            "{Sv} was driving on {street} after dark{at}. {Cp} lay in its lane, and {sv} made contact with it.",
        ],
        ..with(DEBRIS, 5)
    },
    Story {
        road: Highway,
        sv_mph: (50, 65),
        tellings: &[
            "{Sv} was {heading} on {street} in {lane}{at} when it struck {cp} that lay in the roadway.",
            "{Cp} lay in {lane} of {street}. {Sv} began to slow{at} and made contact with it.",
        ],
        ..with(DEBRIS, 2)
    },
    Story {
        sv: RightTurn,
        road: Intersection,
        sv_mph: (4, 12),
        contacts: &[(&[FrontRight], &[]), (&[RearRight], &[]), (&[Bottom], &[])],
        tellings: &[
            "{Sv} was making a right turn onto {cross}{at} and its right wheels made contact with {cp}.",
            "While turning right from {heading} {street}{at}, {sv} ran its rear tire over {cp} of the corner.",
        ],
        ..with(CURBS, 3)
    },
    Story {
        sv_mph: (4, 20),
        contacts: &[(&[FrontRight], &[]), (&[Right], &[]), (&[Bottom], &[])],
        tellings: &[
            "{Sv} was traveling {heading} on {street}{at} and moved to the right for a drop-off. Its front right tire struck {cp}.",
            "{Sv} moved to the right on {heading} {street} to make room for a fire engine{at}. Its right front wheel struck {cp}.",
        ],
        ..with(CURBS, 2)
    },
    Story {
        contacts: UNDERNEATH,
        impacts: IMPACTS_UNDERNEATH,
        tellings: &[
            "{Sv} was traveling {heading} on {street}{at} when it drove over {cp}.",
            "{Sv} was {heading} in {lane} of {street}{at}. Rain had filled {cp}, and {sv} drove into it.",
        ],
        ..with(POTHOLES, 4)
    },
    Story {
        road: ParkingLot,
        sv_mph: (2, 9),
        tellings: &[
            "{Sv} was leaving a parking lot{at} when it drove into {cp} across the exit.",
            "{Sv} was entering the lot of a store{at} and drove into {cp} that hung across the entrance.",
        ],
        ..with(CHAINS, 4)
    },
    Story {
        road: ParkingLot,
        sv_mph: (1, 6),
        tellings: &[
            "{Sv} was following a car through the exit of a garage{at} when {cp} came down on it.",
            "{Sv} was entering a depot{at}. {Cp} began to close and made contact with {sv}.",
        ],
        ..with(GATES, 3)
    },
    Story {
        sv: LeftTurn,
        road: Intersection,
        sv_mph: (4, 14),
        tellings: &[
            "{Sv} was making a left turn from {street} onto {cross}{at} and made contact with {cp} in the median.",
        ],
        ..with(POLES, 2)
    },
    Story {
        sv: ChangingLanes,
        sv_mph: (5, 18),
        tellings: &["{Sv} was changing lanes to the left around a street sweeper on {street}{at} when it struck {cp}."],
        ..with(CONES, 1)
    },
    Story {
        work_zone: true,
        tellings: &[
            "{Sv} was passing road work on {heading} {street}{at} and made contact with {cp} that stood in its lane.",
        ],
        ..with(CONES, 2)
    },
    Story {
        cp: Some(Parked),
        sv_mph: (2, 12),
        contacts: &[(&[FrontRight], &[RearRight]), (&[Right], &[FrontRight]), (&[Right], &[RearRight])],
        tellings: &[
            "{Sv} was traveling {heading} on {street}{at}, a narrow street. Its right side made contact with {cp} at the curb, in which nobody was.",
            "{Sv} moved to the right to let an oncoming bus pass{at} and scraped {cp}, which was unoccupied.",
        ],
        ..with(PARKED_CARS, 4)
    },
    Story {
        tellings: &[
            "{Sv} was traveling {heading} on {street}{at} when {cp} rolled off the sidewalk into its lane. {Sv} braked and struck it.",
        ],
        ..with(LOOSE, 2)
    },
    Story {
        state: SettingOff,
        sv_mph: (1, 3),
        contacts: &[(&[FrontRight], &[])],
        tellings: &[
            "{Sv} had stopped to pick up a rider on {street}. It began to move forward, and its front right corner made contact with {cp}.",
        ],
        ..with(POLES, 1)
    },
    Story {
        state: Reversing,
        sv: Backing,
        road: ParkingLot,
        sv_mph: (1, 3),
        contacts: &[(&[Rear], &[]), (&[RearRight], &[])],
        tellings: &["{Sv} was reversing out of a stall in its own depot{at} and its rear made contact with {cp}."],
        ..with(POLES, 1)
    },
];
