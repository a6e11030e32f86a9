//! Questions to who waits: the partner behind the ego, and the ego behind others.

use crate::told::aside::Aside;
use crate::told::crash::Told;
use crate::told::doing::Doing;
use crate::told::phase::Phase;
use crate::told::side::Turning;
use crate::usual::LANE_M;
use recrash_model::account::{ContactState, Origin, StandReason};
use recrash_model::template::Movement;

impl Told {
    /// Whether the partner stood behind the ego and set off then.
    pub(crate) fn waits_behind(&self) -> bool {
        let stood = self.cp.state == ContactState::SettingOff || self.cp.stood_first || self.queues();
        self.origin == Origin::Behind && (stood || self.creeps_up())
    }

    /// Whether the partner crept into an ego that stands: it gained speed, and is told to have been this slow when they touch. It has come
    /// to a stop behind that before.
    fn creeps_up(&self) -> bool {
        let slow = self.cp.impact_mps.is_some_and(|mps| mps < CREEPS_MPS) && self.cp.gains;
        slow && self.cp.state == ContactState::Moving && self.cp.phases.is_empty() && self.sv.state.stands()
    }

    /// Whether the partner stood behind the ego and goes round it.
    pub(crate) fn comes_round_from_stand(&self) -> bool {
        let aside = self.comes_round_ego() || self.cp.acts.iter().any(Doing::is_aside);
        let straight = self.cp.turning == Turning::No && self.sv.turning == Turning::No;
        self.waits_behind() && aside && straight && self.cp.state != ContactState::Reversing
    }

    /// Whether the partner is drawn as one that stood in a queue behind the ego, though only its place is told.
    pub(super) const fn queues(&self) -> bool {
        self.queued && self.close
    }

    /// Whether the partner leaves its lane to come by.
    pub(crate) fn comes_round_ego(&self) -> bool {
        let stands = self.sv.state.stands();
        match self.cp.movement {
            Some(Movement::Passing) => true,
            Some(Movement::ChangingLanes | Movement::CrossingIntoOpposingLane) => stands,
            _ => false,
        }
    }
}

/// Who is slower than this in traffic has set off, or comes to a stop. [m/s]
pub(crate) const CREEPS_MPS: f64 = 4.0;

/// Whether the partner stands in the queue ahead of the ego, or backs out of it.
pub(crate) fn waits_ahead(told: &Told) -> bool {
    let queue = told.reasons.contains(&StandReason::Queue) && told.sv.state.stands();
    queue && told.origin == Origin::Ahead && told.cp.state == ContactState::Reversing
}

/// Whether the ego stood, and is under way again at the contact.
pub(crate) fn sets_off(told: &Told) -> bool {
    let stood = told.sv.stood_first || told.sv.phases.contains(&Phase::Stands);
    told.sv.state == ContactState::SettingOff || told.sv.state == ContactState::Moving && stood
}

/// Whether the ego stood, and leaves its lane.
pub(crate) fn leaves_lane(told: &Told) -> bool {
    let leaves = |aside: Aside| aside.from_t_m == 0.0 && aside.to_t_m.abs() >= LANE_M;
    sets_off(told) && told.sv_aside().is_some_and(leaves)
}
