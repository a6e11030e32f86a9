//! One of the two goes backwards.

use super::super::story::{BASE, Partners, Story};
use super::super::telling::PARKED_CARS;
use recrash_model::account::ContactState::{Moving, Parked as StandsParked, Reversing};
use recrash_model::account::CrashType;
use recrash_model::template::Movement::{Backing, Parked, ParkingManeuver, Straight};
use recrash_model::template::RoadType::{Intersection, ParkingLot};
use recrash_model::zones::ContactZone::{Front, FrontLeft, FrontRight, Left, Rear, RearLeft, RearRight, Right};

const BACKS: Story =
    Story { kind: CrashType::Backing, cp: Some(Backing), cp_mph: (1, 5), contacts: FRONT_BY_REAR, ..BASE };
const FRONT_BY_REAR: super::super::story::Contacts =
    &[(&[Front], &[Rear]), (&[FrontRight], &[RearLeft]), (&[FrontLeft, Front, FrontRight], &[Rear])];

pub const STORIES: &[Story] = &[
    Story {
        incidents: 9,
        tellings: &[
            "{Sv} came to a stop behind {cp} on {street}, which reversed to parallel park and backed into its front.",
            "{Sv} came to a stop behind {cp} on {heading} {street}. {It} then reversed and struck the front of {sv}.",
            "{Cp} ahead of {sv} had passed a parking space. {Sv} stopped to give it room, and {it} backed up into {sv}{cp_at}.",
            "A van blocked {street}, so {cp} ahead of {sv} stopped and began to back up. {Sv} was stopped and sounded its horn.",
            "{Sv} was stopped in traffic on {street} when {cp} directly ahead of it rolled backwards{cp_at} into its front.",
        ],
        ..BACKS
    },
    Story {
        road: ParkingLot,
        incidents: 7,
        contacts: &[(&[Right], &[Rear]), (&[Left], &[Rear]), (&[FrontRight], &[RearLeft])],
        tellings: &[
            "{Sv} came to a stop in the aisle of a parking lot for a pick-up when {cp} reversed out of a parking space into it.",
            "{Sv} had stopped in a parking lot to let a shopper cross. {Cp} backed out of its stall{cp_at} and made contact with {sv}.",
            "In the lot of a market, {sv} stood waiting for a passenger. The driver of {cp} in a stall beside it backed up without looking.",
        ],
        ..BACKS
    },
    Story {
        incidents: 4,
        contacts: &[(&[Right], &[Rear]), (&[RearRight], &[Rear]), (&[Left], &[RearRight])],
        tellings: &[
            "{Sv} pulled over and came to a stop on {heading} {street} to let a rider out. {Cp} backed out of a driveway{cp_at} and struck it.",
            "{Cp} reversed out of a driveway into {sv}, which had stopped and sounded its horn.",
            "{Sv} was stopped in a queue beside a driveway on {street} when {cp} backing out of it made contact with {sv}.",
        ],
        ..BACKS
    },
    Story {
        road: Intersection,
        incidents: 3,
        tellings: &[
            "{Sv} came to a stop at a red light behind {cp}, which stood over the crosswalk. {It} reversed to clear it and backed into the front of {sv}.",
            "{Cp} ahead of {sv} entered {cross}, stopped for cross traffic, and backed up{cp_at} into {sv}, which was stopped at the stop sign.",
        ],
        ..BACKS
    },
    Story {
        state: StandsParked,
        sv: Parked,
        incidents: 8,
        tellings: &[
            "{Sv} was parked at the curb of {heading} {street}. {Cp} parked ahead of it reversed{cp_at} into its front.",
            "{Sv} was parked and empty on {street} when {cp} backed into it while leaving the space ahead.",
            "While {sv} was parked at the right curb waiting for a trip, the driver of {cp} ahead backed up and made contact with it.",
            "{Sv} was parked along {street}. {Cp} ahead of it was maneuvering out of its space, reversed, and bumped the front of {sv}.",
        ],
        ..BACKS
    },
    Story {
        road: ParkingLot,
        state: StandsParked,
        sv: Parked,
        incidents: 2,
        contacts: &[(&[RearRight], &[Rear]), (&[FrontLeft], &[RearRight])],
        tellings: &[
            "{Sv} was parked in a charging stall of a parking lot. {Cp} backed out of a stall across from it{cp_at} and struck it.",
        ],
        ..BACKS
    },
    Story {
        cp: Some(ParkingManeuver),
        incidents: 2,
        tellings: &[
            "{Sv} was stopped on {street} to yield to {cp} ahead, which was parallel parking. {It} reversed, swung out, and backed into the front of {sv}.",
        ],
        ..BACKS
    },
    Story {
        road: ParkingLot,
        state: Moving,
        sv: Straight,
        incidents: 4,
        sv_mph: (2, 8),
        cp_mph: (1, 6),
        contacts: &[(&[Right], &[Rear]), (&[Left], &[Rear]), (&[RearRight], &[Rear])],
        tellings: &[
            "{Sv} was driving down a parking aisle{at} when {cp} backed out of its space into the side of {sv}.",
            "{Sv} was traveling slowly through a parking lot{at}. {Cp} reversed out of a stall{cp_at} and backed into {sv}.",
        ],
        ..BACKS
    },
    Story {
        road: ParkingLot,
        state: Reversing,
        sv: Backing,
        cp: Some(Parked),
        partners: Partners::Of(PARKED_CARS),
        incidents: 1,
        sv_mph: (1, 3),
        cp_mph: (0, 0),
        contacts: &[(&[Rear], &[FrontLeft]), (&[RearLeft], &[Right])],
        tellings: &[
            "{Sv} was reversing out of a stall of a parking lot{at}. Its rear made contact with {cp}, in which the driver sat and waited.",
        ],
        ..BACKS
    },
    Story {
        state: Reversing,
        sv: Backing,
        cp: Some(Straight),
        incidents: 2,
        sv_mph: (1, 4),
        cp_mph: (3, 12),
        contacts: &[(&[Rear], &[Front]), (&[RearLeft], &[FrontRight])],
        tellings: &[
            "{Sv} was backing up on {street} to get clear of a closed road{at}. {Cp} came up behind it{cp_at} and the two touched.",
            "{Sv} was reversing out of a driveway onto {street}{at} when {cp} traveling {heading} on {street} struck its rear.",
        ],
        ..BACKS
    },
];
