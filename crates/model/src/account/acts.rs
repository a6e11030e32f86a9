//! What road users do, and the state they are in when they touch.

use super::Source;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a road user does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Act {
    /// Drives on along its lane.
    Follow,
    /// Slows.
    Slow,
    /// Gains speed.
    Accelerate,
    /// Comes to a stop.
    Stop,
    /// Stands.
    Hold,
    /// Begins to move from a standstill.
    SetOff,
    /// Goes backwards.
    Reverse,
    /// Passes somebody.
    Pass,
    /// Changes lanes or merges.
    LaneChange,
    /// Leaves its place in the lane slowly.
    Drift,
    /// Leaves its path at once.
    Swerve,
    /// Turns.
    Turn,
    /// Turns round.
    UTurn,
    /// Comes out of a stall, a driveway, a lot or from the kerb.
    PullOut,
    /// Draws up at the kerb.
    PullOver,
    /// Parks, or tries to.
    Park,
    /// Somebody of it opens a door.
    OpenDoor,
    /// Crosses the road.
    Cross,
    /// Enters the junction or the road ahead.
    Enter,
    /// Goes on at a red signal.
    RunRed,
    /// Goes on at a stop sign.
    RunStop,
    /// Does not yield where it should.
    FailToYield,
    /// Is pushed or thrown by another.
    Pushed,
    /// Goes against the flow.
    WrongWay,
    /// Falls, or is laid down.
    Fall,
    /// Is no longer in its driver's control.
    LoseControl,
    /// Rolls away, with nobody or nothing that drives it.
    Roll,
    /// Leaves the place of the crash without stopping.
    Leave,
}

impl Act {
    /// Whether it is an act of one that stops or stands in traffic.
    pub fn stands(self) -> bool {
        matches!(self, Self::Stop | Self::Hold)
    }

    /// Whether it is an act of one that stops, stands or parks.
    pub fn rests(self) -> bool {
        self.stands() || self == Self::Park
    }

    /// Whether it is an act of one that slows, stops or stands.
    pub fn slows(self) -> bool {
        self.stands() || self == Self::Slow
    }

    /// Whether it is a turn, be it a U-turn.
    pub fn turns(self) -> bool {
        matches!(self, Self::Turn | Self::UTurn)
    }

    /// Whether it is an act of one that leaves its line along the road, without a turn.
    pub fn leaves_line(self) -> bool {
        matches!(self, Self::LaneChange | Self::Drift | Self::Swerve)
    }
}

/// Left or right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LeftRight {
    /// Left.
    Left,
    /// Right.
    Right,
}

impl LeftRight {
    /// The side of something that is so far to the left; what is straight ahead is on the right. [m]
    pub const fn of_left(left_m: f64) -> Self {
        if left_m > 0.0 { Self::Left } else { Self::Right }
    }

    /// 1 on the left, -1 on the right.
    pub const fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// Whether something that is so far to the left is on this side. [m]
    pub const fn is_at(self, left_m: f64) -> bool {
        matches!((self, left_m > 0.0), (Self::Left, true) | (Self::Right, false))
    }

    /// The other side.
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// One act of one road user.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ActFact {
    /// What.
    pub act: Act,
    /// To which side, seen from who does it.
    pub side: Option<LeftRight>,
    /// Place in the order of all acts of the story; who does things in the same clause of time has the same number.
    pub step: u32,
    /// It came after the contact.
    pub after_contact: bool,
    /// It was begun or attempted, and the contact came before it was done.
    pub begun: bool,
    /// It is told to have been done, or all but done, before what is told next.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub done: bool,
    /// Of the two that touch: the act of the other one behind which the words put it, by its place in the order.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after_other: Option<u32>,
    /// How fast it was done, where the words say so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manner: Option<Manner>,
    /// Where it stands.
    pub source: Source,
}

impl ActFact {
    /// Whether it was done by the time of the contact: it came before that, and was not only begun.
    pub fn happened(&self) -> bool {
        !self.after_contact && !self.begun
    }
}

/// How fast somebody is told to have driven, where no number is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Manner {
    /// "Slowly", "at a low speed".
    Slow,
    /// "At a high rate of speed"; of who brakes, hard; of who is on foot, at a run.
    Fast,
}

/// State at the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ContactState {
    /// It moved forward.
    Moving,
    /// It had just begun to move.
    SettingOff,
    /// It stood in traffic or at the kerb.
    Stopped,
    /// It was parked.
    Parked,
    /// It went backwards.
    Reversing,
}

impl ContactState {
    /// For tables and sentences.
    pub fn label(self) -> &'static str {
        match self {
            Self::Moving => "moving",
            Self::SettingOff => "setting off",
            Self::Stopped => "stopped",
            Self::Parked => "parked",
            Self::Reversing => "reversing",
        }
    }

    /// Whether it stood.
    pub fn stands(self) -> bool {
        matches!(self, Self::Stopped | Self::Parked)
    }
}

/// How long a road user had stood when it was touched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// It stood already when the story begins.
    FromTheStart,
    /// It came to a stop in the story.
    CameToStop,
    /// It was about to come to a stop.
    Stopping,
}

/// Why a road user stood.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StandReason {
    /// Passengers got in or out.
    PickupDropoff,
    /// It gave way.
    Yield,
    /// Traffic stood.
    Queue,
    /// A red signal.
    RedLight,
    /// One vehicle ahead had stopped.
    LeadVehicle,
    /// A stop sign.
    StopSign,
    /// It was parked.
    Parked,
    /// A person on foot or on wheels.
    Pedestrian,
    /// Something stood in the way.
    BlockedPath,
    /// It kept a junction clear.
    BlockedJunction,
    /// An animal.
    Animal,
    /// An emergency vehicle.
    EmergencyVehicle,
    /// A railway crossing, a gate or a toll.
    Barrier,
}

impl StandReason {
    /// For tables and sentences.
    pub const fn label(self) -> &'static str {
        match self {
            Self::PickupDropoff => "pick-up or drop-off",
            Self::Yield => "giving way",
            Self::Queue => "queue",
            Self::RedLight => "red light",
            Self::LeadVehicle => "vehicle ahead",
            Self::StopSign => "stop sign",
            Self::Parked => "parked",
            Self::Pedestrian => "pedestrian",
            Self::BlockedPath => "blocked path",
            Self::BlockedJunction => "blocked junction",
            Self::Animal => "animal",
            Self::EmergencyVehicle => "emergency vehicle",
            Self::Barrier => "railway crossing, gate or toll",
        }
    }
}

/// What a speed is the speed of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpeedMeaning {
    /// On the way to the conflict.
    Approach,
    /// At the contact, or just before it.
    Impact,
    /// The posted limit.
    Posted,
}

/// A speed and what it means.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Speed {
    /// The speed. [m/s]
    pub mps: f64,
    /// Of what.
    pub meaning: SpeedMeaning,
}
