//! What a kind of crash is: what it means, what the columns say, and the ways to tell it.
//!
//! Words in braces are filled in by `telling.rs`: `{sv}` the subject vehicle, `{cp}` the partner when first named, `{it}`
//! the partner after that, `{heading}` and `{cp_heading}` compass directions, `{street}` and `{cross}` the two roads,
//! `{at}` and `{cp_at}` a speed or nothing, `{llane}` a lane that has a neighbour on its right, `{rlane}` one that has a
//! neighbour on its left, `{lane}` any. A first letter in upper case asks for one in the text.

use super::telling::{IMPACTS, Partner};
use recrash_model::account::{ContactState, CrashType};
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone::{self, Front, FrontLeft, FrontRight, Left, Rear, RearLeft, RearRight, Right};

/// Where the partner comes from, seen from the subject vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum From {
    Same,
    Opposite,
    Left,
    Right,
}

/// Who can be the partner.
#[derive(Debug, Clone, Copy)]
pub enum Partners {
    /// Cars, pickups, vans, now and then a bus or a truck.
    Motor,
    /// Heavy trucks, about every other time.
    Trucks,
    /// Any of these.
    Of(&'static [Partner]),
}

/// Zones hit, on the subject vehicle and on the partner.
pub type Contacts = &'static [(&'static [ContactZone], &'static [ContactZone])];

/// One kind of crash.
#[derive(Clone, Copy)]
pub struct Story {
    /// What a reader should call it.
    pub kind: CrashType,
    /// What the subject vehicle does at the contact.
    pub state: ContactState,
    pub road: RoadType,
    pub sv: Movement,
    /// Nothing where there is no other road user, or where the column refers to the narrative.
    pub cp: Option<Movement>,
    pub work_zone: bool,
    /// How many incidents are of it.
    pub incidents: usize,
    pub from: From,
    pub partners: Partners,
    /// Least and greatest speed of the subject vehicle. [mi/h]
    pub sv_mph: (u32, u32),
    /// Least and greatest speed of the partner. [mi/h]
    pub cp_mph: (u32, u32),
    pub contacts: Contacts,
    pub tellings: &'static [&'static str],
    /// How the contact itself is told.
    pub impacts: &'static [&'static str],
}

/// A follower runs into a vehicle that stands in the street: what the kinds differ from.
pub const BASE: Story = Story {
    kind: CrashType::FrontToRear,
    state: ContactState::Stopped,
    road: RoadType::Street,
    sv: Movement::Stopped,
    cp: Some(Movement::Straight),
    work_zone: false,
    incidents: 0,
    from: From::Same,
    partners: Partners::Motor,
    sv_mph: (0, 0),
    cp_mph: (3, 25),
    contacts: REAR_OF_SV,
    tellings: &[],
    impacts: IMPACTS,
};

pub const REAR_OF_SV: Contacts = &[
    (&[Rear], &[Front]),
    (&[RearLeft, Rear, RearRight], &[FrontLeft, Front, FrontRight]),
    (&[RearLeft], &[FrontRight]),
    (&[Rear, RearRight], &[FrontLeft, Front]),
];
pub const FROM_LEFT: Contacts = &[
    (&[Left], &[Front]),
    (&[FrontLeft, Left], &[Front, FrontRight]),
    (&[Front], &[Right]),
    (&[Front, FrontLeft], &[FrontRight]),
    (&[RearLeft], &[Front]),
];
pub const FROM_RIGHT: Contacts = &[
    (&[Right], &[Front]),
    (&[Right, FrontRight], &[FrontLeft, Front]),
    (&[Front], &[Left]),
    (&[Front, FrontRight], &[FrontLeft]),
    (&[RearRight], &[Front]),
];
pub const CUT_IN_FROM_LEFT: Contacts =
    &[(&[FrontLeft], &[RearRight]), (&[FrontLeft], &[Right]), (&[FrontLeft, Left], &[RearRight, Right])];
pub const CUT_IN_FROM_RIGHT: Contacts =
    &[(&[FrontRight], &[RearLeft]), (&[FrontRight], &[Left]), (&[Right, FrontRight], &[Left, RearLeft])];
pub const DRIFT_FROM_LEFT: Contacts = &[(&[Left], &[Right]), (&[Left, RearLeft], &[Right, FrontRight])];
pub const DRIFT_FROM_RIGHT: Contacts = &[(&[Right], &[Left]), (&[RearRight, Right], &[FrontLeft, Left])];
/// The partner squeezes past on the left of a vehicle that stands.
pub const PASSES_ON_THE_LEFT: Contacts =
    &[(&[RearLeft], &[FrontRight]), (&[Left], &[Right]), (&[FrontLeft], &[RearRight]), (&[RearLeft], &[Right])];
pub const PASSES_ON_THE_RIGHT: Contacts = &[(&[RearRight], &[FrontLeft]), (&[Right], &[Left]), (&[RearRight], &[Left])];
