//! An act that is told and can be seen, and by how much somebody does something who does it.

use recrash_model::account::{Act, LeftRight};

/// An act that is told, and can be seen in a way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Doing {
    pub(crate) act: Act,
    pub(crate) side: Option<LeftRight>,
    /// It was begun or attempted.
    pub(crate) begun: bool,
    /// A turn is told behind it: it was over then.
    pub(crate) over: bool,
    /// No words tell it: what is told behind it begins with it.
    pub(crate) implied: bool,
    /// It is told not to have left its lane by that.
    pub(crate) within_lane: bool,
    /// It braked hard.
    pub(crate) hard: bool,
    /// Its place in the order of all acts, and that of the other one's act behind which the words put it.
    pub(crate) step: u32,
    pub(crate) after_other: Option<u32>,
}

impl Doing {
    /// An act of which no more is told than when.
    pub(crate) const fn plain(act: Act, step: u32, after_other: Option<u32>) -> Self {
        Self {
            act,
            side: None,
            begun: false,
            over: false,
            implied: false,
            within_lane: false,
            hard: false,
            step,
            after_other,
        }
    }

    pub(crate) fn goes_aside(&self) -> bool {
        matches!(least(self.act), Some(Least::Aside(_) | Least::Any))
    }

    /// Whether it passes, and touches beside.
    pub(crate) const fn is_pass(&self) -> bool {
        matches!(self.act, Act::Pass) && !self.begun
    }

    /// Whether the words put it behind something that the other one did.
    pub(crate) const fn is_behind_other(&self) -> bool {
        self.after_other.is_some()
    }

    /// Whether who does it leaves the line that it drives on.
    pub(crate) fn is_aside(&self) -> bool {
        matches!(least(self.act), Some(Least::Aside(_) | Least::Turn(_) | Least::Any | Least::By))
    }

    /// Whether it changes lanes, drifts or swerves.
    pub(super) const fn leaves_line(&self) -> bool {
        matches!(self.act, Act::LaneChange | Act::Drift | Act::Swerve)
    }

    /// Whether it is that it swerved.
    pub(crate) const fn is_swerve(&self) -> bool {
        matches!(self.act, Act::Swerve)
    }

    /// Whether it was only about to pass.
    pub(crate) const fn is_begun_pass(&self) -> bool {
        matches!(self.act, Act::Pass) && self.begun
    }

    /// Whether it was coming to a stop.
    pub(crate) const fn is_begun_stop(&self) -> bool {
        matches!(self.act, Act::Stop) && self.begun
    }

    /// To which side it passes, or was about to.
    pub(super) fn passes_on(&self) -> Option<LeftRight> {
        self.side.filter(|_| self.act == Act::Pass)
    }

    /// Whether it is a stop, or slowing, behind something by which the other one left its line, and that one's way to it.
    pub(super) fn answers(&self, other: &[Doing]) -> bool {
        let slows = matches!(self.act, Act::Stop | Act::Slow);
        let aside = |doing: &Doing| doing.goes_aside() && self.is_behind(doing);
        slows && other.iter().any(aside)
    }

    /// The same, where the other one had left its line by then.
    pub(crate) fn answers_done(&self, other: &[Doing]) -> bool {
        let aside = |doing: &Doing| doing.goes_aside() && !doing.begun && self.is_behind(doing);
        matches!(self.act, Act::Stop | Act::Slow) && other.iter().any(aside)
    }

    /// Whether the words put it behind what the other one did.
    fn is_behind(&self, doing: &Doing) -> bool {
        self.after_other.is_some_and(|after| doing.step <= after)
    }

    /// Whether it is that it set off, and the words put that behind the same of the other one.
    pub(crate) fn sets_off_behind(&self, other: &[Doing]) -> bool {
        let before =
            |doing: &Doing| doing.act == Act::SetOff && self.after_other.is_some_and(|after| doing.step <= after);
        self.act == Act::SetOff && other.iter().any(before)
    }

    /// Whether it passes, and is told to have turned behind that.
    pub(crate) const fn is_pass_before_turn(&self) -> bool {
        self.is_pass() && self.over
    }

    /// Whether it is that it slowed, or came to a stop.
    pub(crate) const fn slows(&self) -> bool {
        matches!(self.act, Act::Stop | Act::Slow)
    }

    /// Whether it is a stand.
    pub(super) const fn is_stand(&self) -> bool {
        matches!(self.act, Act::Stop | Act::Hold)
    }

    /// Whether it is a stop.
    pub(crate) const fn comes_to_stand(&self) -> bool {
        matches!(self.act, Act::Stop) && !self.begun
    }

    /// Whether it comes into a junction.
    pub(crate) const fn is_entry(&self) -> bool {
        matches!(self.act, Act::Enter)
    }

    /// Whether it is a turn: of who may have begun it, or has yet to, none is asked for.
    pub(crate) const fn is_turn(&self) -> bool {
        matches!(self.act, Act::Turn)
    }
}

/// By how much somebody does something who does it.
pub(crate) enum Least {
    /// Loses or gains speed. [m/s]
    Speed(f64),
    /// Stands; and comes to a stand.
    Stand,
    Halt,
    /// Drives from a stand.
    Start,
    /// Drives backwards.
    Back,
    /// Goes aside. [m]
    Aside(f64),
    /// Turns. [deg]
    Turn(f64),
    /// Goes aside, turns, or drives backwards.
    Any,
    /// Comes beside the other one, which was ahead of it on its own way.
    By,
    /// Its front comes into the junction.
    In,
}

/// Who slows or gains speed does so by this. [m/s]
pub(crate) const CHANGES_MPS: f64 = 0.8;

/// Who changes lanes has gone aside by so much, and who drifts or swerves. [m]
const CHANGES_LANES_M: f64 = 0.8;
const DRIFTS_M: f64 = 0.2;

/// Who turns has turned by so much, and who turns round. [deg]
const TURNS_DEG: f64 = 15.0;
const ROUND_DEG: f64 = 50.0;

/// How an act is seen; nothing where a way does not tell it.
pub(crate) fn least(act: Act) -> Option<Least> {
    Some(match act {
        Act::Slow => Least::Speed(-CHANGES_MPS),
        Act::Accelerate => Least::Speed(CHANGES_MPS),
        Act::Stop => Least::Halt,
        Act::Hold => Least::Stand,
        Act::SetOff => Least::Start,
        Act::Reverse => Least::Back,
        Act::LaneChange => Least::Aside(CHANGES_LANES_M),
        Act::Drift | Act::Swerve => Least::Aside(DRIFTS_M),
        Act::Turn => Least::Turn(TURNS_DEG),
        Act::UTurn => Least::Turn(ROUND_DEG),
        Act::PullOut | Act::PullOver | Act::Park => Least::Any,
        Act::Pass => Least::By,
        Act::Enter => Least::In,
        // Of these a way shows nothing of its own, or another fact holds them: signals, who threw whom, doors.
        Act::Follow
        | Act::OpenDoor
        | Act::Cross
        | Act::RunRed
        | Act::RunStop
        | Act::FailToYield
        | Act::Pushed
        | Act::WrongWay
        | Act::Fall
        | Act::LoseControl
        | Act::Roll
        | Act::Leave => return None,
    })
}
