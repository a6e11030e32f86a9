//! Plans: what a road user does, as data. A course through the plane, and acts with triggers along it.
//!
//! Who has a plan moves exactly along its course: its rear axle stays on the line, its speed changes at the stated rates,
//! and who stands, stands. Equations: `docs/models/acts.md`.

use super::control::Aspect;
use super::place::Place;
use crate::kinds::PartnerKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A road user with a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Actor {
    /// Unique in the scenario: letters, digits, `_` and `-`, at most 32.
    pub id: String,
    /// Kind.
    #[serde(default)]
    pub kind: PartnerKind,
    /// Length and width, where they differ from its kind's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<Size>,
    /// Mass with who is in or on it, where it differs from its kind's. A `fixed_object` stands firm without one, and is pushed
    /// aside with one; who weighs twenty times as much goes on as before. [kg]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.1, max = 60000.0))]
    pub mass_kg: Option<f64>,
    /// What sticks out or follows: mirrors, doors, a trailer; at most 8.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<Part>,
    /// What it does.
    pub plan: ActorPlan,
}

/// Length and width of a box. [m]
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Size {
    /// 0.05 to 40. [m]
    #[schemars(range(min = 0.05, max = 40.0))]
    pub length_m: f64,
    /// 0.05 to 20. [m]
    #[schemars(range(min = 0.05, max = 20.0))]
    pub width_m: f64,
}

/// What a road user does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ActorPlan {
    /// Where its centre is at the start, and which way it faces.
    pub start: Place,
    /// Speed at the start, along its course. [m/s]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 60.0))]
    pub speed_mps: f64,
    /// Where it goes, leg by leg, at most 32; it stays where it is where none is given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub course: Vec<Leg>,
    /// What it does on the way, in order, at most 64.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub acts: Vec<Act>,
    /// It stops for red signals and at stop signs on its course, unless an act says otherwise.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub obeys_control: bool,
    /// It is not there before this time. [s]
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = 120.0))]
    pub appears_s: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl ActorPlan {
    /// Stands at a place.
    pub const fn standing(start: Place) -> Self {
        Self { start, speed_mps: 0.0, course: Vec::new(), acts: Vec::new(), obeys_control: false, appears_s: 0.0 }
    }
}

/// A leg of a course. Where two legs differ in gear, the road user stops between them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Leg {
    /// Along lanes, from where it is.
    Lanes {
        /// Roads with direction, in order; the first is the one it is on. Between two of them the shortest way is taken.
        roads: Vec<String>,
        /// How far on the last road the leg ends, from where it enters it; at its end where not given. [m]
        #[serde(default, skip_serializing_if = "Option::is_none")]
        until_m: Option<f64>,
        /// Lane on the last road; as near as may be to the one it comes from where not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        lane: Option<u8>,
        /// Against the lanes' direction: wrong way, or backwards with `reverse`. The roads are passed in the order given.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        against: bool,
        /// In reverse gear.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        reverse: bool,
    },
    /// A smooth curve to a place: two arcs that touch.
    Curve {
        /// Where its centre is then, and which way it faces.
        to: Place,
        /// In reverse gear.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        reverse: bool,
    },
    /// Straight from point to point: on foot, mostly.
    Path {
        /// 1 to 64 points. [m]
        points: Vec<[f64; 2]>,
    },
}

/// Something to do, and when.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Act {
    /// A name that triggers of others can refer to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// When it begins; when the act before it is done where not given. Acts begin in order.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub when: Option<Trigger>,
    /// It begins this long after its trigger: a reaction time. [s]
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = 60.0))]
    pub delay_s: f64,
    /// What to do.
    #[serde(rename = "do")]
    pub deed: Deed,
}

/// What to do.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Deed {
    /// Changes to a speed, and holds it. Done when it is reached.
    Speed {
        /// [m/s]
        #[schemars(range(min = 0.0, max = 60.0))]
        to_mps: f64,
        /// Acceleration or deceleration on the way. [m/s^2]
        #[schemars(range(min = 0.05, max = 12.0))]
        rate_mps2: f64,
    },
    /// Brakes to a stand. Done when it stands.
    Stop {
        /// Deceleration. [m/s^2]
        #[schemars(range(min = 0.05, max = 12.0))]
        rate_mps2: f64,
        /// Where its centre then is, along its course from the start: it brakes as late as the rate allows. [m]
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at_m: Option<f64>,
    },
    /// Stands. Done after the time; never where none is given.
    Hold {
        /// [s]
        #[serde(default, skip_serializing_if = "Option::is_none")]
        for_s: Option<f64>,
    },
    /// Moves sideways: a lane change, a drift, a swerve, room made for somebody. Done at its end.
    Shift {
        /// To the right of the course's line. [m]
        #[schemars(range(min = -50.0, max = 50.0))]
        to_t_m: f64,
        /// Distance driven meanwhile. [m]
        #[schemars(range(min = 0.5, max = 500.0))]
        over_m: f64,
    },
    /// Follows somebody: keeps a gap by the intelligent driver model, with a reaction time. Done when both stand.
    Follow {
        /// Whom.
        actor: String,
        /// Speed it wants. [m/s]
        #[schemars(range(min = 0.5, max = 60.0))]
        speed_mps: f64,
        /// Bumper-to-bumper gap at a standstill. [m]
        #[serde(default = "two")]
        #[schemars(range(min = 0.1, max = 50.0))]
        gap_m: f64,
        /// Time headway. [s]
        #[serde(default = "one")]
        #[schemars(range(min = 0.0, max = 10.0))]
        headway_s: f64,
        /// What it sees is this old; 0 to 2.4. [s]
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 2.4))]
        reaction_s: f64,
        /// Acceleration. [m/s^2]
        #[serde(default = "one_and_a_half")]
        #[schemars(range(min = 0.1, max = 6.0))]
        acceleration_mps2: f64,
        /// Hardest braking. [m/s^2]
        #[serde(default = "six")]
        #[schemars(range(min = 0.5, max = 12.0))]
        braking_mps2: f64,
    },
    /// Moves one of its parts: opens a door, turns an arm. Done at its end.
    Part {
        /// The part.
        part: String,
        /// Its new angle. [deg]
        #[schemars(range(min = -180.0, max = 180.0))]
        to_deg: f64,
        /// [s]
        #[schemars(range(min = 0.1, max = 60.0))]
        over_s: f64,
    },
    /// Obeys signals and signs from now on, or does not.
    Obey {
        /// Whether it does.
        control: bool,
    },
    /// Is gone.
    Leave {},
}

const fn two() -> f64 {
    2.0
}
const fn one() -> f64 {
    1.0
}
const fn one_and_a_half() -> f64 {
    1.5
}
const fn six() -> f64 {
    6.0
}

/// When an act begins.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Trigger {
    /// At a time. [s]
    TimeS(f64),
    /// When its centre has come this far along its course. [m]
    AtM(f64),
    /// When the gap between the boxes is no more than this.
    Near {
        /// To whom: an actor, a partner, or `ego`.
        actor: String,
        /// [m]
        #[schemars(range(min = 0.0, max = 500.0))]
        within_m: f64,
    },
    /// When somebody is in a state.
    Actor {
        /// Who: an actor, a partner, or `ego`.
        actor: String,
        /// The state.
        is: Doing,
    },
    /// When a signal shows something.
    Signal {
        /// The control's road with direction.
        at: String,
        /// What it shows.
        shows: Aspect,
    },
    /// When an act of another actor, or of the recorded ego, has begun.
    Act {
        /// Who: an actor, or `ego`.
        actor: String,
        /// The act's name.
        act: String,
    },
}

/// A state that others can see.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Doing {
    /// Stands.
    Standing,
    /// Moves.
    Moving,
    /// Loses more than 1 m/s in a second.
    Braking,
    /// Has touched, or been touched by, somebody. Who waits for its own touch goes on with its plan after it; everybody else
    /// is left to momentum.
    Hit,
}

/// A box that belongs to a road user and sticks out of its own, or follows it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Unique for its owner: letters, digits, `_` and `-`, at most 24.
    pub id: String,
    /// What it is.
    pub kind: PartKind,
    /// From the owner's centre forward: to the middle of the part, a door's hinge, a trailer's hitch. [m]
    #[schemars(range(min = -20.0, max = 20.0))]
    pub x_m: f64,
    /// From the owner's centre to the left, likewise. [m]
    #[schemars(range(min = -10.0, max = 10.0))]
    pub y_m: f64,
    /// Length: along the owner; of a door, from the hinge to its end. [m]
    #[schemars(range(min = 0.02, max = 25.0))]
    pub length_m: f64,
    /// Width: across the owner; of a door, its thickness. [m]
    #[schemars(range(min = 0.02, max = 5.0))]
    pub width_m: f64,
    /// A trailer: from the hitch back to its axle; 0.8 of its length where not given. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.5, max = 20.0))]
    pub axle_m: Option<f64>,
}

/// What a part is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PartKind {
    /// A mirror.
    Mirror,
    /// A sensor beside or above the body.
    Sensor,
    /// Cargo, a bicycle rack, a ladder.
    Load,
    /// A door: it lies along the body, pointing back, at 0 degrees, and opens outwards.
    Door,
    /// Something hinged that turns about its hinge, from pointing forward at 0 degrees anticlockwise: the arm of a gate.
    Arm,
    /// A trailer, drawn behind a hitch.
    Trailer,
}
