//! What is changed when a design is tried again: levers, moved by what was wrong with the earlier tries.

use super::design::{gap_of_contact, shift_of_contact};
use crate::{Feedback, Problem};
use recrash_model::metrics::{Check, CheckKind, Metrics};
use recrash_model::record::ContactZone;
use recrash_model::scenario::{ScenarioDraft, Start};

/// How a try differs from the first design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levers {
    /// Position in the staging's list of lane plans.
    pub lane_plan: usize,
    /// Added to the arrival gap. [s]
    pub gap_shift_s: f64,
    /// Added to the partner's start along the road. [m]
    pub start_shift_m: f64,
    /// Factor on the sideways move.
    pub sideways_factor: f64,
    /// Factor on both speeds.
    pub speed_factor: f64,
    /// Factor on the lengths of approach and arms.
    pub length_factor: f64,
    /// Whether to pass each other closely rather than to touch.
    pub near_miss: bool,
    /// Whether the other one than the facts suggest goes first.
    pub swap_order: bool,
}

impl Default for Levers {
    fn default() -> Self {
        Self {
            lane_plan: 0,
            gap_shift_s: 0.0,
            start_shift_m: 0.0,
            sideways_factor: 1.0,
            speed_factor: 1.0,
            length_factor: 1.0,
            near_miss: false,
            swap_order: false,
        }
    }
}

/// What the facts say about the contact; empty where they say nothing.
#[derive(Debug, Clone, Copy)]
pub struct Wanted<'a> {
    /// On the ego.
    pub sv: &'a [ContactZone],
    /// On the partner.
    pub cp: &'a [ContactZone],
}

/// The levers after all feedback, oldest first.
pub fn levers(feedback: &[Feedback], wanted: Wanted) -> Levers {
    let mut levers = Levers::default();
    for (number, entry) in feedback.iter().enumerate() {
        match &entry.problem {
            Problem::NotRunnable { diagnostics } => {
                levers.length_factor *= 1.3;
                levers.speed_factor *= 0.9;
                let says = |word: &str| diagnostics.iter().any(|d| d.is_error() && d.code.contains(word));
                if says("overlap") {
                    levers.start_shift_m += 4.0;
                }
                if says("turn") || says("lane") || says("route") || says("conflict") {
                    levers.lane_plan += 1;
                }
            }
            Problem::NotFaithful { failures, metrics } => {
                unfaithful(&mut levers, &entry.draft, failures, metrics, wanted, number);
            }
        }
    }
    levers
}

fn unfaithful(
    levers: &mut Levers,
    draft: &ScenarioDraft,
    failures: &[Check],
    metrics: &Metrics,
    wanted: Wanted,
    number: usize,
) {
    let failed = |kind: CheckKind| failures.iter().any(|check| check.kind == kind);
    let movement = failed(CheckKind::SvMovement) || failed(CheckKind::CpMovement) || failed(CheckKind::Approach);
    if movement || failed(CheckKind::ExcludedCollision) {
        // Met too early in the turn, or at a bad angle: first pass closely, so that both finish their movement; then try
        // other lanes.
        if levers.near_miss {
            levers.lane_plan += 1;
            levers.swap_order = number % 2 == 1;
        } else {
            levers.near_miss = true;
        }
        if failed(CheckKind::CpMovement) {
            levers.sideways_factor *= 0.85;
        }
    } else if failed(CheckKind::ContactZones) {
        match &metrics.contact {
            Some(contact) if number < 3 => {
                let seen = Wanted { sv: &[contact.ego_zone], cp: &[contact.other_zone] };
                let partner = draft.partners.first();
                let speeds = (draft.ego.target_speed_mps, partner.map_or(8.0, |p| p.policy.target_speed().max(1.0)));
                match partner.map(|p| p.start) {
                    Some(Start::Offset { .. }) => {
                        levers.start_shift_m += shift_of_contact(wanted) - shift_of_contact(seen);
                    }
                    _ => levers.gap_shift_s += gap_of_contact(wanted, speeds) - gap_of_contact(seen, speeds),
                }
            }
            _ => levers.near_miss = true,
        }
    } else if failed(CheckKind::Encounter) {
        levers.gap_shift_s *= 0.5;
        levers.near_miss = false;
        levers.lane_plan += usize::from(number > 0);
    } else {
        levers.lane_plan += 1;
    }
}
