//! What is aimed at when a design is tried again: told by what was wrong with the earlier tries.

use crate::{Feedback, Problem};
use recrash_model::metrics::CheckKind;
use recrash_model::scenario::{ScenarioDraft, Start};

/// What a try aims at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// The contact the facts tell of.
    Touch,
    /// To pass each other at this distance. [m]
    Pass(f64),
}

/// A near miss: close enough for the profile of the paper to count it, too close for comfort. [m]
const CLOSE_PASS_M: f64 = 1.2;
/// A miss that no check takes for nearly a contact (below 2 m the zones of a near miss are predicted). [m]
const WIDE_PASS_M: f64 = 2.8;

/// How a try differs from the first design.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What it aims at.
    pub aim: Aim,
    /// Whether the other one than the facts suggest goes first.
    pub swap_order: bool,
    /// Factor on both speeds.
    pub speed_factor: f64,
    /// Factor on the lengths of approach and arms.
    pub length_factor: f64,
    /// Lane numbers and start of every earlier try.
    pub tried: Vec<Tried>,
}

/// Lanes and start of an earlier try.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// Lanes in each direction.
    pub lanes: u8,
    /// The ego's lane.
    pub ego_lane: u8,
    /// Arrival gap [s], or place ahead of the ego [m].
    pub start: f64,
}

impl Tried {
    /// Of a draft with a partner.
    fn of(draft: &ScenarioDraft) -> Option<Self> {
        let start = match draft.partners.first()?.start {
            Start::ArrivalGap { arrival_gap_s } => arrival_gap_s,
            Start::Offset { delta_s_m, .. } => delta_s_m,
        };
        Some(Self { lanes: draft.map.carriageway().lanes, ego_lane: draft.ego.lane, start })
    }
}

/// The plan after all feedback. `told` says whether the facts tell of a contact.
///
/// The first try lets the two pass each other where and in the order that is told, too wide to count as a failure: to find
/// the failure is the search's part. Where that is not faithful and a contact is told, three tries aim at it in ever other
/// ways, then one lets the two pass close. Where none is told, what failed decides whether closer or wider.
///
/// Two that drive side by side are close anyway, so that a wide pass is left for the last tries.
pub fn plan(feedback: &[Feedback], told: bool, side_by_side: bool) -> Plan {
    let mut plan = Plan {
        aim: if side_by_side { Aim::Pass(CLOSE_PASS_M) } else { Aim::Pass(WIDE_PASS_M) },
        swap_order: false,
        speed_factor: 1.0,
        length_factor: 1.0,
        tried: feedback.iter().filter_map(|entry| Tried::of(&entry.draft)).collect(),
    };
    let mut unfaithful = 0;
    for entry in feedback {
        match &entry.problem {
            Problem::NotRunnable { .. } => {
                plan.length_factor *= 1.3;
                plan.speed_factor *= 0.85;
            }
            Problem::NotFaithful { failures, .. } => {
                unfaithful += 1;
                let failed = |kind: CheckKind| failures.iter().any(|check| check.kind == kind);
                let too_far = failed(CheckKind::Encounter);
                plan.aim = match (told, unfaithful) {
                    (true, 1..=3) => Aim::Touch,
                    (true, 4) => Aim::Pass(CLOSE_PASS_M),
                    // They were nearest where they began, side by side: only what touches is nearer.
                    _ if side_by_side && failed(CheckKind::Road) => Aim::Touch,
                    _ if too_far => Aim::Pass(CLOSE_PASS_M),
                    _ => Aim::Pass(WIDE_PASS_M),
                };
                plan.swap_order = unfaithful >= 5 || (!told && unfaithful >= 2);
            }
        }
    }
    plan
}
