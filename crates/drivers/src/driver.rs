//! What all reference drivers share: they keep their speed until they see danger, then they react.

use crate::sight::{BRAKING_JERK_MPS3, Body, FULL_BRAKING_MPS2, REACTION_TIME_S, STEPS_PER_S, Sees};
use crate::{careful, fuzzy, regulation, responsibility};

/// Which model drives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ReferenceDriver {
    /// The careful and competent human driver of UN R157.
    Careful,
    /// The fuzzy safety model.
    Fuzzy,
    /// Responsibility-sensitive safety.
    Responsibility,
    /// What UN R157 itself asks of the system in a cut-in.
    Regulation,
}

impl ReferenceDriver {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Careful, Self::Fuzzy, Self::Responsibility, Self::Regulation];

    /// Name in tables and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Careful => "careful",
            Self::Fuzzy => "fsm",
            Self::Responsibility => "rss",
            Self::Regulation => "reg157",
        }
    }

    /// How far behind a leader of the same speed it drives; `None` where its source says nothing of following. [m]
    pub fn following_distance_m(self, speed_mps: f64) -> Option<f64> {
        match self {
            Self::Careful => Some(careful::following_distance_m(speed_mps)),
            Self::Fuzzy => Some(fuzzy::following_distance_m(speed_mps)),
            Self::Responsibility => Some(responsibility::following_distance_m(speed_mps)),
            Self::Regulation => None,
        }
    }

    /// From seeing the danger to braking. [s]
    fn reaction_time_s(self) -> f64 {
        match self {
            Self::Careful | Self::Fuzzy | Self::Responsibility => REACTION_TIME_S,
            Self::Regulation => regulation::REACTION_TIME_S,
        }
    }
}

/// Where the danger comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conflict {
    /// From the lane beside: drivers judge whether it comes, and whether it comes too near.
    CutIn,
    /// It is in the lane ahead, and braking or standing: the careful driver and the regulation's act at once.
    Ahead,
}

/// One reference driver during one scenario.
#[derive(Debug, Clone)]
pub struct Driver {
    model: ReferenceDriver,
    conflict: Conflict,
    /// What is left of the reaction time. [s]
    waits_s: f64,
    /// Of the step before. [m/s^2]
    deceleration_mps2: f64,
    /// Of the step before; equal to the speed at the start. [m/s]
    speed_before_mps: Option<f64>,
    settled: bool,
    reacts: bool,
}

impl Driver {
    /// A driver that has seen nothing yet.
    pub fn new(model: ReferenceDriver, conflict: Conflict) -> Self {
        Self {
            model,
            conflict,
            waits_s: model.reaction_time_s(),
            deceleration_mps2: 0.0,
            speed_before_mps: None,
            settled: false,
            reacts: false,
        }
    }

    /// Whether the model has found the conflict to be none, and has nothing more to decide.
    pub fn settled(&self) -> bool {
        self.settled
    }

    /// Whether it has seen danger by now.
    pub fn reacts(&self) -> bool {
        self.reacts
    }

    /// Its speed one step on. [m/s]
    pub fn next_speed_mps(&mut self, ego: &Body, other: &Body) -> f64 {
        let acceleration_mps2 = (ego.speed_mps - self.speed_before_mps.unwrap_or(ego.speed_mps)) * STEPS_PER_S;
        self.speed_before_mps = Some(ego.speed_mps);
        let (sees, wanted_mps2) = self.look(ego, other, acceleration_mps2);
        self.settled |= sees == Sees::Settled;
        if sees != Sees::Danger {
            return ego.speed_mps;
        }
        self.reacts = true;
        if self.waits_s > 0.0 {
            self.waits_s -= 1.0 / STEPS_PER_S;
            if self.model == ReferenceDriver::Careful {
                self.deceleration_mps2 = careful::RELEASE_MPS2;
            }
            // The others hold their speed while they wait.
            return ego.speed_mps - self.deceleration_mps2 / STEPS_PER_S;
        }
        self.deceleration_mps2 = match self.model {
            ReferenceDriver::Regulation => wanted_mps2,
            _ => (self.deceleration_mps2 + BRAKING_JERK_MPS3 / STEPS_PER_S).min(wanted_mps2),
        };
        (ego.speed_mps - self.deceleration_mps2 / STEPS_PER_S).max(0.0)
    }

    /// What it sees, and how hard it wants to brake where that is danger. [m/s^2]
    fn look(&self, ego: &Body, other: &Body, acceleration_mps2: f64) -> (Sees, f64) {
        let cut_in = self.conflict == Conflict::CutIn;
        match self.model {
            ReferenceDriver::Careful if cut_in => (careful::sees(ego, other), FULL_BRAKING_MPS2),
            ReferenceDriver::Careful => (Sees::Danger, FULL_BRAKING_MPS2),
            ReferenceDriver::Fuzzy => fuzzy::sees(ego, other, acceleration_mps2),
            ReferenceDriver::Responsibility => (responsibility::sees(ego, other), FULL_BRAKING_MPS2),
            ReferenceDriver::Regulation if cut_in => (regulation::sees(ego, other), regulation::BRAKING_MPS2),
            ReferenceDriver::Regulation => (Sees::Danger, regulation::BRAKING_MPS2),
        }
    }
}
