//! Rows that the paper's profile cannot use: other movements and roads.

use super::story::{From, Partners, Story};
use recrash_model::template::Movement::{
    Backing, ChangingLanes, LaneDeparture, NmCrossing, Parked, Stopped, Straight, UTurn,
};
use recrash_model::template::RoadType::{Highway, Intersection, ParkingLot, RuralRoad, Street};
use recrash_model::zones::ContactZone::{Front, FrontRight, Left, Rear, RearLeft, Right};

const BASE: Story = Story {
    road: Street,
    sv: Stopped,
    cp: Straight,
    work_zone: false,
    rows: 0,
    from: From::Same,
    partners: Partners::Motor,
    sv_mph: (0, 0),
    cp_mph: (3, 30),
    contacts: &[(&[Rear], &[Front]), (&[RearLeft], &[FrontRight])],
    tellings: &[],
};

pub const OTHERS: &[Story] = &[
    Story {
        rows: 16,
        tellings: &[
            "{Sv} was stopped in {lane} of {street} behind a double-parked truck when {cp} drove into it from behind.",
            "{Sv} stood still on {heading} {street} to let a passenger out. {Cp} coming up behind noticed it late{cp_at}.",
            "While {sv} waited for a gap to go around a parked bus, {cp} tried to pass and touched it.",
        ],
        ..BASE
    },
    Story {
        road: Intersection,
        rows: 14,
        tellings: &[
            "{Sv} was stopped at a red light at {street} and {cross} and {cp} hit it from behind{cp_at}.",
            "{Sv} had been standing at the stop line for ten seconds when {cp} bumped into it.",
        ],
        ..BASE
    },
    Story {
        cp: Backing,
        rows: 9,
        cp_mph: (1, 5),
        contacts: &[(&[Front], &[Rear])],
        tellings: &[
            "{Sv} was stopped behind {cp} on {street}, which reversed to parallel park and backed into its front.",
            "{Cp} backed out of a driveway into {sv}, which had stopped and sounded its horn.",
        ],
        ..BASE
    },
    Story {
        road: ParkingLot,
        sv: Straight,
        cp: Backing,
        rows: 8,
        sv_mph: (2, 8),
        cp_mph: (1, 6),
        contacts: &[(&[Right], &[Rear]), (&[Left], &[Rear])],
        tellings: &[
            "{Sv} was driving down a parking aisle{at} when {cp} backed out of its space into the side of {sv}.",
        ],
        ..BASE
    },
    Story {
        sv: Parked,
        rows: 6,
        contacts: &[(&[Left], &[Right])],
        partners: Partners::Any,
        tellings: &["{Sv} was parked at the curb of {street}, empty. {Cp} passing it scraped the mirror side."],
        ..BASE
    },
    Story {
        sv: Straight,
        cp: ChangingLanes,
        rows: 9,
        sv_mph: (10, 34),
        contacts: &[(&[FrontRight], &[Left]), (&[Right], &[Left])],
        tellings: &[
            "{Sv} was {heading} in {llane} of {street}{at}. {Cp} on its right changed lanes into it.",
            "Between two junctions, {cp} moved over from the right without a signal and met {sv}{at}.",
        ],
        ..BASE
    },
    Story {
        sv: Straight,
        rows: 5,
        sv_mph: (8, 25),
        tellings: &["{Sv} slowed for a speed bump on {street} and {cp} behind it did not."],
        ..BASE
    },
    Story {
        road: RuralRoad,
        sv: Straight,
        rows: 1,
        sv_mph: (25, 45),
        tellings: &["{Sv} was on a country road{at} when {cp} ran into its back."],
        ..BASE
    },
    Story {
        road: Intersection,
        sv: ChangingLanes,
        rows: 3,
        sv_mph: (8, 24),
        contacts: &[(&[Left], &[FrontRight])],
        tellings: &["{Sv} was changing to the left lane before {cross} when {cp} coming from behind sped up{cp_at}."],
        ..BASE
    },
    Story {
        road: Highway,
        sv: Straight,
        cp: LaneDeparture,
        rows: 3,
        sv_mph: (45, 65),
        cp_mph: (45, 70),
        contacts: &[(&[Left], &[Right])],
        tellings: &["{Cp} left its lane on {street}, hit the barrier and bounced into the side of {sv}{at}."],
        ..BASE
    },
    Story {
        road: Intersection,
        sv: Straight,
        cp: NmCrossing,
        rows: 3,
        partners: Partners::Riders,
        sv_mph: (1, 10),
        cp_mph: (3, 12),
        contacts: &[(&[Front], &[])],
        tellings: &[
            "{Cp} crossed the crosswalk at {cross} against the signal, and {sv} braked but touched the front wheel.",
        ],
        ..BASE
    },
    Story {
        sv: UTurn,
        rows: 1,
        sv_mph: (3, 8),
        tellings: &["{Sv} was making a U-turn at a dead end of {street} when {cp} came around the bend{cp_at}."],
        ..BASE
    },
];
