//! Findings: what a rollout shows about the ego, one sentence each.

use crate::scene::{STANDSTILL_MPS, first_step, gap_at, time_of, with_parts};
use recrash_model::metrics::{EgoMetrics, Finding, FindingKind, Metrics, PartnerMetrics, Timed};
use recrash_model::profile::FailureCriteria;
use recrash_model::rollout::{EventKind, Role, Rollout, TerminationKind};

/// A near miss is one of somebody who came at least this much nearer than the scene (or the system's part of it) begins with: a conflict is two road
/// users who approach each other (amundsen1977), and lanes side by side are nearer than some limits. Assumed: more than
/// lane keeping moves a car sideways. [m]
const APPROACH_M: f64 = 0.1;

/// What a rollout shows about the ego, from the handover on: failures first, then odd behaviour, each in order of time.
pub fn findings(rollout: &Rollout, handover_s: f64, metrics: &Metrics, criteria: &FailureCriteria) -> Vec<Finding> {
    let first = first_step(rollout, handover_s);
    let mut all = Vec::new();
    all.extend(contact(metrics));
    all.extend(obstacle_contacts(rollout, first, metrics));
    all.extend(near_misses(rollout, first, metrics, criteria));
    all.extend(ending(rollout, metrics, criteria));
    all.extend(odd_behaviour(metrics, criteria));
    all.sort_by(|a, b| b.kind.is_failure().cmp(&a.kind.is_failure()).then(a.time_s.total_cmp(&b.time_s)));
    all
}

fn contact(metrics: &Metrics) -> Option<Finding> {
    let contact = metrics.contact.as_ref()?;
    let (ego_zone, other_zone) = (contact.ego_zone.label(), contact.other_zone.label());
    Some(Finding {
        kind: FindingKind::Contact,
        time_s: contact.time_s,
        value: contact.relative_speed_mps,
        threshold: 0.0,
        sentence: format!(
            "The ego and {} touched at {:.2} s, {ego_zone} against {other_zone} ({} collision), at {:.1} m/s relative speed; \
             the ego drove {:.1} m/s, the other {:.1} m/s.",
            contact.id,
            contact.time_s,
            contact.kind.label(),
            contact.relative_speed_mps,
            contact.ego_speed_mps,
            contact.other_speed_mps,
        ),
    })
}

fn obstacle_contacts<'a>(
    rollout: &'a Rollout,
    first: usize,
    metrics: &'a Metrics,
) -> impl Iterator<Item = Finding> + 'a {
    let counts = move |time_s: f64| time_s >= time_of(first) - 1e-9;
    metrics.obstacles_hit.iter().filter_map(move |&hit| {
        let kind = rollout.obstacles.get(hit)?.kind.with_article();
        let (time_s, speed) = rollout.events.iter().find_map(|event| match event.kind {
            EventKind::ObstacleContact { actor: 0, obstacle, state } if obstacle == hit && counts(event.time_s) => {
                Some((event.time_s, state.velocity().length()))
            }
            _ => None,
        })?;
        Some(Finding {
            kind: FindingKind::ObstacleContact,
            time_s,
            value: speed,
            threshold: 0.0,
            sentence: format!("The ego hit {kind} (obstacle {}) at {time_s:.2} s with {speed:.1} m/s.", hit + 1),
        })
    })
}

fn near_misses<'a>(
    rollout: &'a Rollout,
    first: usize,
    metrics: &'a Metrics,
    criteria: &'a FailureCriteria,
) -> impl Iterator<Item = Finding> + 'a {
    let touched = metrics.contact.as_ref().map(|contact| contact.actor);
    metrics
        .partners
        .iter()
        .filter(move |partner| Some(partner.actor) != touched)
        .filter(|partner| rollout.actors.get(partner.actor).is_some_and(|track| track.role == Role::Partner))
        .filter(|partner| partner.min_gap.value < criteria.min_gap_m)
        .filter(move |partner| has_approached(rollout, first, partner))
        .map(|partner| {
            let Timed { value, time_s } = partner.min_gap;
            Finding {
                kind: FindingKind::NearMiss,
                time_s,
                value,
                threshold: criteria.min_gap_m,
                sentence: format!(
                    "The ego came within {value:.2} m of {} at {time_s:.1} s; the profile asks for {:.1} m.",
                    partner.id, criteria.min_gap_m
                ),
            }
        })
}

/// Whether a partner and the ego came nearer to each other than they stood at the handover, or at the start where there
/// is none. The least gap to all others says how the scene begins, and nothing about the ego.
pub fn came_nearer(rollout: &Rollout, handover_s: f64, partner: &PartnerMetrics) -> bool {
    has_approached(rollout, first_step(rollout, handover_s), partner)
}

fn has_approached(rollout: &Rollout, first: usize, partner: &PartnerMetrics) -> bool {
    first_gap_m(rollout, first, partner.actor) - partner.min_gap.value > APPROACH_M
}

/// Box gap between the ego and another at the first step that counts, parts of both included. [m]
fn first_gap_m(rollout: &Rollout, first: usize, actor: usize) -> f64 {
    let gap_m = gap_at(rollout, (&with_parts(rollout, 0), &with_parts(rollout, actor)), first);
    if gap_m.is_finite() { gap_m } else { 0.0 }
}

fn ending(rollout: &Rollout, metrics: &Metrics, criteria: &FailureCriteria) -> Option<Finding> {
    let time_s = rollout.termination.time_s;
    match metrics.termination {
        TerminationKind::OffRoad => {
            let value = metrics.ego.max_lane_departure.value;
            Some(Finding {
                kind: FindingKind::OffRoad,
                time_s,
                value,
                threshold: criteria.lane_departure_m,
                sentence: format!("The ego left the road at {time_s:.1} s, {value:.2} m beyond the edge of its lane."),
            })
        }
        TerminationKind::Stuck => {
            let value = standing_s(rollout);
            Some(Finding {
                kind: FindingKind::Stuck,
                time_s,
                value,
                threshold: 0.0,
                sentence: format!(
                    "The ego stood still for the last {value:.1} s and never arrived, after {:.0} m.",
                    metrics.ego.distance_m
                ),
            })
        }
        _ => None,
    }
}

/// How long the ego had been standing when the rollout ended. [s]
fn standing_s(rollout: &Rollout) -> f64 {
    let Some(ego) = rollout.actors.first() else { return 0.0 };
    time_of(ego.states.iter().rev().take_while(|state| state.velocity().length() < STANDSTILL_MPS).count())
}

/// What is odd about how the ego drove, whoever else was there.
fn odd_behaviour(metrics: &Metrics, criteria: &FailureCriteria) -> Vec<Finding> {
    let ego = &metrics.ego;
    let above = |kind, Timed { value, time_s }: Timed, threshold: f64, sentence: String| {
        (value > threshold).then_some(Finding { kind, time_s, value, threshold, sentence })
    };
    let braking = ego.max_deceleration;
    let braked = format!("The ego braked with {:.1} m/s\u{b2} at {:.1} s", braking.value, braking.time_s);
    let hard_braking = above(
        FindingKind::HardBraking,
        braking,
        criteria.hard_braking_mps2,
        format!("{braked}; hard braking starts at {:.1} m/s\u{b2}.", criteria.hard_braking_mps2),
    );
    let beyond_tyres = above(
        FindingKind::BrakingBeyondTyres,
        braking,
        ego.tyre_limit_mps2,
        format!(
            "{braked}; tyres give at most {:.1} m/s\u{b2} on this road, so a real vehicle would have been faster here.",
            ego.tyre_limit_mps2
        ),
    );
    let phantom_braking = ego.phantom_braking.and_then(|phantom| {
        above(
            FindingKind::PhantomBraking,
            phantom,
            criteria.phantom_braking_mps2,
            format!(
                "The ego braked with {:.1} m/s\u{b2} at {:.1} s with nothing close ahead that asks for it; the profile allows {:.1} m/s\u{b2}.",
                phantom.value, phantom.time_s, criteria.phantom_braking_mps2
            ),
        )
    });
    let departure = ego.max_lane_departure;
    let lane_departure = above(
        FindingKind::LaneDeparture,
        departure,
        criteria.lane_departure_m,
        format!(
            "The ego's box reached {:.2} m over the edge of its lane at {:.1} s without changing lanes; {:.2} m are allowed.",
            departure.value, departure.time_s, criteria.lane_departure_m
        ),
    );
    let all = [hard_braking, beyond_tyres, phantom_braking, lane_departure, oscillation(ego, criteria)];
    all.into_iter().flatten().collect()
}

/// Going to and fro between braking and accelerating.
fn oscillation(ego: &EgoMetrics, criteria: &FailureCriteria) -> Option<Finding> {
    (ego.max_reversals >= criteria.oscillation_reversals.max(1)).then(|| Finding {
        kind: FindingKind::Oscillation,
        time_s: ego.max_reversals_time_s,
        value: f64::from(ego.max_reversals),
        threshold: f64::from(criteria.oscillation_reversals),
        sentence: format!(
            "The ego changed {} times between braking and accelerating within {:.0} s, up to {:.1} s; {} make an oscillation.",
            ego.max_reversals,
            criteria.oscillation_window_s,
            ego.max_reversals_time_s,
            criteria.oscillation_reversals
        ),
    })
}
