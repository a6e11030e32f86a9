//! Doors, animals, cargo, robots; crashes thrown at the subject vehicle; people on foot and on two wheels.

use super::super::story::{BASE, Contacts, From, Partners, Story};
use super::super::telling::{
    ANIMALS, CARGO, CYCLISTS, DELIVERY_ROBOTS, IMPACTS_LIGHT, IMPACTS_OF_ANIMALS, IMPACTS_OF_DOORS, IMPACTS_OF_THINGS,
    MOTORCYCLES, SCOOTERS, WALKERS,
};
use recrash_model::account::ContactState::{Moving, Parked as StandsParked};
use recrash_model::account::CrashType::{Cyclist, Motorcycle, Other, Pedestrian, Secondary};
use recrash_model::template::Movement::{
    ChangingLanes, LeftTurn, NmCrossing, NmInRoadway, Parked, Passing, RightTurn, Stopped, Straight,
};
use recrash_model::template::RoadType::Intersection;
use recrash_model::zones::ContactZone::{Front, FrontLeft, FrontRight, Left, Rear, RearLeft, RearRight, Right};

const DOOR_ON_THE_LEFT: Contacts = &[(&[Left], &[Right]), (&[RearLeft], &[FrontRight])];
const DOOR: Story = Story {
    kind: Other,
    cp: Some(Passing),
    cp_mph: (4, 18),
    contacts: DOOR_ON_THE_LEFT,
    impacts: IMPACTS_OF_DOORS,
    ..BASE
};
const PUSHED: Story =
    Story { kind: Secondary, cp: Some(Stopped), cp_mph: (0, 0), contacts: &[(&[Rear], &[Front])], ..BASE };
const RIDES: Story = Story { impacts: IMPACTS_LIGHT, cp_mph: (5, 14), ..BASE };

pub const STORIES: &[Story] = &[
    Story {
        incidents: 5,
        tellings: &[
            "{Sv} was stopped on {heading} {street} for a drop-off. A passenger opened the rear left door into the path of {cp} passing on the left{cp_at}.",
            "{Sv} was stopped at the curb to let a rider out. As {cp} passed on the left, the rider opened the left rear door of {sv} and it struck {it}.",
            "While {sv} was stopped in a queue on {street}, its passenger opened the left door. {Cp} passing on the left{cp_at} made contact with the open door.",
        ],
        ..DOOR
    },
    Story {
        state: StandsParked,
        sv: Parked,
        incidents: 4,
        tellings: &[
            "{Sv} was parked at the right curb of {heading} {street}. A rider opened the left rear door, and {cp} passing on the left{cp_at} struck the door.",
            "{Sv} was parked to unload a passenger. The passenger opened the door on the street side as {cp} passed, and the two made contact.",
        ],
        ..DOOR
    },
    Story {
        state: Moving,
        sv: Passing,
        cp: Some(Parked),
        incidents: 2,
        sv_mph: (5, 14),
        cp_mph: (0, 0),
        contacts: &[(&[Right], &[Left]), (&[FrontRight], &[Left])],
        tellings: &[
            "{Sv} was passing {cp} parked at the right curb of {street}{at}. Its driver opened the door, which made contact with the right side of {sv}.",
            "As {sv} passed {cp} that was parked along {heading} {street}{at}, the driver door of {it} was opened into the side of {sv}.",
        ],
        ..DOOR
    },
    Story {
        kind: Other,
        state: Moving,
        sv: Straight,
        cp: None,
        partners: Partners::Of(ANIMALS),
        incidents: 4,
        sv_mph: (12, 40),
        cp_mph: (0, 0),
        contacts: &[(&[Front], &[]), (&[FrontRight], &[]), (&[FrontLeft], &[])],
        impacts: IMPACTS_OF_ANIMALS,
        tellings: &[
            "{Sv} was traveling {heading} on {street}{at} when {cp} ran into the road from the right. {Sv} braked but struck it.",
            "{Cp} crossed {street} from the left in front of {sv}{at}. {Sv} slowed down and made contact with it.",
            "{Sv} was {heading} on {street} before dawn{at}. {Cp} jumped into its lane and was struck.",
        ],
        ..BASE
    },
    Story {
        kind: Other,
        state: Moving,
        sv: Straight,
        cp: None,
        partners: Partners::Of(DELIVERY_ROBOTS),
        incidents: 1,
        sv_mph: (2, 8),
        cp_mph: (2, 4),
        contacts: &[(&[FrontRight], &[])],
        impacts: IMPACTS_OF_THINGS,
        tellings: &["{Sv} was turning into {street}{at} when {cp} left the sidewalk and crossed in front of it."],
        ..BASE
    },
    Story {
        kind: Other,
        partners: Partners::Of(CARGO),
        incidents: 1,
        sv_mph: (0, 0),
        cp_mph: (0, 0),
        contacts: &[(&[Front], &[])],
        impacts: &["It fell on the hood of {sv}.", "The front of {sv} was hit by the load."],
        tellings: &[
            "{Sv} was stopped at a red light behind {cp} on {street}. Part of its load came loose and fell off the truck onto {sv}.",
        ],
        ..BASE
    },
    // Thrown at the subject vehicle by another contact.
    Story {
        incidents: 5,
        tellings: &[
            "{Sv} was stopped in a queue on {heading} {street} with {cp} stopped behind it. A pickup truck struck {it} from behind and pushed it into the rear of {sv}.",
            "{Sv} was stopped at a red light. {Cp} behind it was rear-ended by a van, pushing {it} into the rear of {sv}.",
            "Traffic on {street} had stopped. The driver of a delivery van ran into {cp} behind {sv}, and {it} was pushed forward into {sv}.",
        ],
        ..PUSHED
    },
    Story {
        road: Intersection,
        cp: Some(Straight),
        incidents: 1,
        cp_mph: (15, 35),
        contacts: &[(&[FrontLeft], &[Right])],
        tellings: &[
            "{Sv} was stopped at a red light on {street}. Two other vehicles, {cp} and a van, collided in the intersection, and {it} was pushed into the front of {sv}.",
        ],
        ..PUSHED
    },
    Story {
        state: Moving,
        sv: Straight,
        cp: Some(Straight),
        incidents: 2,
        sv_mph: (10, 30),
        cp_mph: (10, 30),
        contacts: &[(&[Left], &[Right]), (&[FrontLeft], &[RearRight])],
        tellings: &[
            "{Sv} was {heading} in {rlane} of {street}{at}. In the lane to its left, a van ran into {cp}, and {it} was pushed into the left side of {sv}.",
        ],
        ..PUSHED
    },
    // On two wheels and on foot.
    Story {
        kind: Cyclist,
        partners: Partners::Of(CYCLISTS),
        cp: Some(Passing),
        incidents: 2,
        contacts: &[(&[RearRight], &[Front]), (&[Right], &[Left])],
        tellings: &[
            "{Sv} was stopped in a queue on {heading} {street} when {cp} approaching from behind{cp_at} rode into its rear right corner.",
            "{Sv} was stopped on {street} to let a passenger out. {Cp} passing it on the right made contact with its side.",
        ],
        ..RIDES
    },
    Story {
        kind: Cyclist,
        partners: Partners::Of(CYCLISTS),
        road: Intersection,
        cp: Some(Straight),
        incidents: 1,
        contacts: &[(&[Rear], &[Front])],
        tellings: &[
            "{Sv} was stopped at a stop sign on {street} when {cp} coming from behind ran into its rear{cp_at}.",
        ],
        ..RIDES
    },
    Story {
        kind: Cyclist,
        state: Moving,
        partners: Partners::Of(CYCLISTS),
        road: Intersection,
        sv: Straight,
        cp: Some(Straight),
        from: From::Right,
        incidents: 2,
        sv_mph: (2, 15),
        contacts: &[(&[Front], &[Left]), (&[FrontRight], &[Left])],
        tellings: &[
            "{Sv} had a green light on {heading} {street}{at}. {Cp} left the sidewalk on the right and rode across the crosswalk against the signal{cp_at}.",
            "{Sv} was leaving a stop sign at {cross} when {cp} came from the right on the wrong side of the road and crossed in front of it.",
        ],
        ..RIDES
    },
    Story {
        kind: Cyclist,
        state: Moving,
        partners: Partners::Of(CYCLISTS),
        road: Intersection,
        sv: RightTurn,
        cp: Some(Straight),
        incidents: 1,
        sv_mph: (3, 11),
        cp_mph: (8, 18),
        contacts: &[(&[Right], &[Left]), (&[FrontRight], &[FrontLeft])],
        tellings: &[
            "{Sv} had checked the bike lane and begun its right turn. {Cp} came up from behind on the right at speed and made contact.",
        ],
        ..RIDES
    },
    Story {
        kind: Pedestrian,
        partners: Partners::Of(SCOOTERS),
        cp: Some(Passing),
        incidents: 2,
        contacts: &[(&[RearRight], &[Front]), (&[Right], &[Left])],
        tellings: &[
            "{Sv} was stopped in traffic on {heading} {street}. {Cp} riding between the lanes passed it on the right{cp_at} and touched it.",
            "{Sv} was stopped at the curb for a pick-up when {cp} approaching from behind ran into its rear right corner.",
        ],
        ..RIDES
    },
    Story {
        kind: Pedestrian,
        state: Moving,
        partners: Partners::Of(WALKERS),
        sv: Straight,
        cp: Some(NmCrossing),
        incidents: 2,
        from: From::Right,
        sv_mph: (2, 12),
        cp_mph: (2, 4),
        contacts: &[(&[Front], &[]), (&[FrontRight], &[])],
        tellings: &[
            "{Sv} was traveling {heading} on {street}{at}. {Cp} stepped off the right curb between two parked cars and crossed in front of it. {Sv} braked hard.",
            "{Cp} ran across {street} from the right outside of a crosswalk. {Sv} braked{at} but made contact.",
        ],
        ..RIDES
    },
    Story {
        kind: Pedestrian,
        partners: Partners::Of(WALKERS),
        road: Intersection,
        cp: Some(NmInRoadway),
        incidents: 1,
        cp_mph: (2, 4),
        contacts: &[(&[FrontLeft], &[]), (&[Front], &[])],
        tellings: &[
            "{Sv} was stopped at the crosswalk of {cross} to yield. {Cp} crossing from the left walked into its front corner.",
        ],
        ..RIDES
    },
    Story {
        kind: Motorcycle,
        partners: Partners::Of(MOTORCYCLES),
        cp: Some(Passing),
        incidents: 2,
        cp_mph: (8, 25),
        contacts: &[(&[Left], &[Right]), (&[RearLeft], &[FrontRight])],
        tellings: &[
            "{Sv} was stopped in a queue on {heading} {street} when {cp} passing between the lanes on its left{cp_at} touched its side.",
            "{Sv} was stopped at a red light. {Cp} coming from behind passed on the left and made contact with its rear left corner.",
        ],
        ..BASE
    },
    Story {
        kind: Motorcycle,
        state: Moving,
        partners: Partners::Of(MOTORCYCLES),
        road: Intersection,
        sv: Straight,
        cp: Some(LeftTurn),
        from: From::Opposite,
        incidents: 1,
        sv_mph: (10, 25),
        cp_mph: (8, 18),
        contacts: &[(&[FrontLeft], &[FrontRight])],
        tellings: &[
            "{Sv} was {heading} on {street} and entered {cross} on a green light{at}. {Cp} coming {cp_heading} the other way turned left across its path{cp_at}.",
        ],
        ..BASE
    },
    Story {
        kind: Motorcycle,
        state: Moving,
        partners: Partners::Of(MOTORCYCLES),
        sv: ChangingLanes,
        incidents: 1,
        sv_mph: (8, 20),
        cp_mph: (15, 35),
        contacts: &[(&[RearLeft], &[Front]), (&[Left], &[FrontRight])],
        tellings: &[
            "{Sv} was changing lanes to the left on {heading} {street}{at} when {cp} coming from behind in that lane{cp_at} hit its side.",
        ],
        ..BASE
    },
];
