//! From opposite directions on one road: most often a narrow one, where the subject vehicle has stopped to let the partner by.

use super::super::story::{BASE, Contacts, From, Partners, Story};
use super::super::telling::WIDE;
use recrash_model::account::ContactState::{Moving, Parked as StandsParked};
use recrash_model::account::CrashType::HeadOn;
use recrash_model::template::Movement::{CrossingIntoOpposingLane, Parked, Passing, Straight, WrongWay};
use recrash_model::zones::ContactZone::{Front, FrontLeft, Left, RearLeft};

const MIRRORS: Contacts =
    &[(&[Left], &[Left]), (&[FrontLeft], &[FrontLeft]), (&[Left], &[FrontLeft]), (&[FrontLeft], &[Left])];
const ONCOMING: Story = Story { kind: HeadOn, from: From::Opposite, cp_mph: (4, 22), contacts: MIRRORS, ..BASE };

pub const STORIES: &[Story] = &[
    Story {
        incidents: 8,
        tellings: &[
            "{Sv} was {heading} on {street}, a narrow street with cars parked on both sides, and came to a stop to yield to {cp} coming the other way. As {it} passed{cp_at}, it scraped the driver side of {sv}.",
            "{Sv} pulled to the right and came to a stop on {street} to let an oncoming vehicle pass. {Cp} traveling {cp_heading} passed too closely and touched {sv}.",
            "{Sv} slowed to a stop on {heading} {street} when {cp} traveling in the opposite direction{cp_at} made contact with its left side.",
            "Parked cars left one lane of {street}. {Sv} had stopped and waited for {cp}, {cp_heading}, to come through, and its mirror was struck.",
            "{Sv} was stopped in a queue, {heading} on {street}. {Cp} traveling {cp_heading} in the opposite direction drifted towards it{cp_at} and sideswiped it.",
        ],
        ..ONCOMING
    },
    Story {
        incidents: 3,
        partners: Partners::Of(WIDE),
        cp_mph: (2, 10),
        tellings: &[
            "{Sv} had come to a stop on {heading} {street} for {cp} coming the other way. The driver of {it} tried to fit through the gap and its side scraped {sv}.",
            "{Sv} came to a stop beside parked cars, yielding to {cp} traveling {cp_heading}. {It} moved past and made contact with the left mirror of {sv}.",
        ],
        ..ONCOMING
    },
    Story {
        cp: Some(Passing),
        incidents: 2,
        tellings: &[
            "{Sv} was stopped on {heading} {street} to yield to oncoming traffic. {Cp} traveling {cp_heading} passed a double-parked van, came close to {sv}{cp_at}, and struck its left side.",
        ],
        ..ONCOMING
    },
    Story {
        cp: Some(CrossingIntoOpposingLane),
        incidents: 2,
        contacts: &[(&[FrontLeft], &[FrontLeft]), (&[Front], &[Front])],
        tellings: &[
            "{Sv} came to a stop on {heading} {street} for a red light. {Cp} traveling {cp_heading} crossed the double yellow line{cp_at} and struck it.",
            "{Sv} stopped when {cp} coming the other way crossed into its lane to get around a stopped bus. {It} did not stop and hit the front of {sv}.",
        ],
        ..ONCOMING
    },
    Story {
        cp: Some(WrongWay),
        incidents: 1,
        contacts: &[(&[Front], &[Front])],
        tellings: &[
            "{Cp} was traveling {cp_heading} the wrong way on {heading} {street}. {Sv} stopped, and {it} ran into its front{cp_at}.",
        ],
        ..ONCOMING
    },
    Story {
        state: StandsParked,
        sv: Parked,
        incidents: 2,
        contacts: &[(&[Left], &[Left]), (&[RearLeft], &[Left]), (&[FrontLeft], &[FrontLeft])],
        tellings: &[
            "{Sv} was parked at the right curb of {heading} {street}. {Cp} traveling {cp_heading} in the opposite direction passed too closely{cp_at} and struck its mirror.",
        ],
        ..ONCOMING
    },
    Story {
        state: Moving,
        sv: Straight,
        cp: Some(CrossingIntoOpposingLane),
        incidents: 2,
        sv_mph: (8, 25),
        cp_mph: (12, 30),
        contacts: &[(&[FrontLeft], &[FrontLeft]), (&[Left], &[Left])],
        tellings: &[
            "{Sv} was traveling {heading} on {street}{at}. {Cp} traveling {cp_heading} crossed the center line{cp_at} and sideswiped it.",
            "{Sv} was {heading} in its lane on {street}{at} when {cp} coming the other way around a bend crossed into its lane.",
        ],
        ..ONCOMING
    },
];
