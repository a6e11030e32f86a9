//! What a point of a search scores, and which points are refused. Described in `docs/models/tuning.md`.

use crate::judging::run_scenario;
use recrash_metrics::came_nearer;
use recrash_model::geometry::{OrientedBox, Pose};
use recrash_model::math::wrap_angle;
use recrash_model::metrics::{Expectation, PartnerMetrics, Timed};
use recrash_model::profile::SystemProfile;
use recrash_model::rollout::{ActorState, Role, Rollout, STEP_S};
use recrash_model::run::JudgedRun;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::severity::Severity;
use recrash_model::tuning::{Aim, Parameter, Score, apply};
use recrash_roads::{RunError, Scenario, Simulator};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A least gap before this time says more about the start than about the ego. [s]
const EARLIEST_MINIMUM_S: f64 = 1.0;
/// A least gap this near the end of a rollout without contact says that it was cut off. [s]
const LATEST_MINIMUM_S: f64 = 0.3;
/// Hardest braking of a real car on a dry road, 0.9 g: partners that brake harder are implausible. [m/s^2]
const PLAUSIBLE_BRAKING_MPS2: f64 = 0.9 * 9.81;
/// Braking is taken over this many steps, so that a contact's last step does not count. [0.1 s]
const BRAKING_STEPS: usize = 3;
/// Price of the distance from the scenario as designed: among equal outcomes the nearest to the record wins. [m]
const DISTANCE_PRICE_M: f64 = 0.05;
/// A contact this deep is one in another simulator as well, and a gap this wide is none there. Twice what the partners of the
/// exports are off in esmini at the time of contact, `docs/formats/esmini.md`. [m]
const MARGIN_M: f64 = 0.1;
/// How deep a contact is shows within this time. [s]
const DEPTH_TIME_S: f64 = 0.3;
/// Times at which it is looked at in that, as often as the physics steps.
const DEPTH_LOOKS: u8 = 15;
/// After this many failures of a program that hangs or ends, the search of a scenario asks no more of it.
const MAX_FAULTS: usize = 3;
/// What counts as the gap where nobody came nearer to the ego: farther than any. [m]
const NOBODY_NEARER_M: f64 = 1e3;
/// Worth of each kind of odd behaviour. [m]
const ODD_BEHAVIOUR_WORTH_M: f64 = 0.1;

/// Worth of a contact's change of velocity, where the search aims at severity: more than all else together. [m for each m/s]
const HARM_WORTH: f64 = 1.0;

/// Makes the scenario of a point.
type Make<'a> = Box<dyn Fn(&[f64]) -> Result<Scenario, String> + 'a>;
/// Runs and judges it.
type Judge<'a> = Box<dyn Fn(&Scenario) -> Result<JudgedRun, RunError> + 'a>;

/// Everything a score depends on but the values.
pub struct Scoring<'a> {
    /// What may move.
    pub parameters: &'a [Parameter],
    make: Make<'a>,
    judge: Judge<'a>,
    /// Hardest braking of partners as designed, which the narrative asks for. [m/s^2]
    designed_braking_mps2: f64,
    /// What the search looks for.
    aim: Aim,
    /// Points that could not be run.
    faults: AtomicUsize,
}

impl<'a> Scoring<'a> {
    /// Scoring around a designed scenario and its first run.
    pub fn new(
        draft: &'a ScenarioDraft,
        parameters: &'a [Parameter],
        expectation: &'a Expectation,
        profile: &'a SystemProfile,
        simulator: &'a dyn Simulator,
        first: &JudgedRun,
    ) -> Self {
        let make = |values: &[f64]| {
            let checked = recrash_roads::check(apply(draft, parameters, values)?);
            checked.map(|checked| checked.value).map_err(|diagnostics| {
                diagnostics.iter().find(|d| d.is_error()).map(ToString::to_string).unwrap_or_default()
            })
        };
        let judge = |scenario: &Scenario| run_scenario(scenario, simulator, profile, Some(expectation));
        Self::of(parameters, make, judge, first)
    }

    /// Scoring of scenarios that are made and judged otherwise.
    pub fn of(
        parameters: &'a [Parameter],
        make: impl Fn(&[f64]) -> Result<Scenario, String> + 'a,
        judge: impl Fn(&Scenario) -> Result<JudgedRun, RunError> + 'a,
        first: &JudgedRun,
    ) -> Self {
        let designed_braking_mps2 = hardest_partner_braking(&first.rollout);
        let (make, judge) = (Box::new(make), Box::new(judge));
        Self { parameters, make, judge, designed_braking_mps2, aim: Aim::default(), faults: AtomicUsize::new(0) }
    }

    /// The same with another aim.
    #[must_use]
    pub fn aiming_at(self, aim: Aim) -> Self {
        Self { aim, ..self }
    }

    /// Makes the scenario of the values, runs, measures and judges it.
    pub fn score(&self, values: &[f64]) -> Score {
        let refused = |why: String| Score {
            objective: f64::MAX,
            min_gap: None,
            depth_m: None,
            contact_mps: None,
            braking: None,
            findings: Vec::new(),
            failed: false,
            refused: vec![why],
        };
        let scenario = match (self.make)(values) {
            Err(why) => return refused(format!("not runnable: {why}")),
            Ok(scenario) => scenario,
        };
        if self.faults.load(Ordering::Relaxed) >= MAX_FAULTS {
            return refused(format!("not run: the simulator or the ego failed {MAX_FAULTS} times here"));
        }
        let run = match (self.judge)(&scenario) {
            Ok(run) => run,
            Err(why) => {
                self.faults.fetch_add(1, Ordering::Relaxed);
                return refused(format!("not run: {why}"));
            }
        };
        let refused = self.refusals(&run);
        let mut kinds: Vec<_> = run.findings.iter().map(|f| f.kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let odd = kinds.iter().filter(|kind| !kind.is_failure()).count();
        let depth_m = contact_depth(&run.rollout);
        let min_gap = approached_gap(&scenario, &run);
        let gap = match depth_m {
            Some(depth_m) => -depth_m.min(MARGIN_M),
            None => min_gap.map_or(NOBODY_NEARER_M, |gap| gap.value.max(MARGIN_M)),
        };
        let harm = match self.aim {
            Aim::Failure => 0.0,
            Aim::Severity => run.severity.as_ref().map_or(0.0, Severity::harm_mps),
        };
        Score {
            objective: gap + DISTANCE_PRICE_M * self.distance(values)
                - ODD_BEHAVIOUR_WORTH_M * odd as f64
                - HARM_WORTH * harm,
            min_gap,
            depth_m,
            contact_mps: run.metrics.contact.as_ref().map(|contact| (contact.ego_speed_mps, contact.other_speed_mps)),
            braking: Some(run.metrics.ego.max_deceleration).filter(|braking| braking.value > 0.0),
            failed: refused.is_empty() && run.failed(),
            findings: kinds,
            refused,
        }
    }

    /// Why a run is refused: unfaithful, degenerate or implausible. Empty for an accepted one.
    fn refusals(&self, run: &JudgedRun) -> Vec<String> {
        let mut why: Vec<String> = run
            .verdict
            .failures()
            .map(|c| format!("unfaithful: {} is {}, not {}", c.kind.label(), c.observed, c.expected))
            .collect();
        if let Some(gap) = run.metrics.min_gap {
            let contact = run.metrics.contact.is_some();
            if gap.time_s < EARLIEST_MINIMUM_S {
                why.push(format!("degenerate: least gap at the start ({:.1} s)", gap.time_s));
            } else if !contact && gap.time_s > run.metrics.duration_s - LATEST_MINIMUM_S {
                why.push(format!("degenerate: least gap at the end ({:.1} s)", gap.time_s));
            }
        }
        let braking = hardest_partner_braking(&run.rollout);
        if braking > PLAUSIBLE_BRAKING_MPS2.max(self.designed_braking_mps2 + 0.1) {
            why.push(format!("implausible: a partner brakes with {braking:.1} m/s^2"));
        }
        why
    }

    /// Root mean square of the parameters' moves, as shares of their ranges.
    fn distance(&self, values: &[f64]) -> f64 {
        let squares: f64 = self
            .parameters
            .iter()
            .zip(values)
            .map(|(p, v)| if p.max > p.min { (v - p.start) / (p.max - p.min) } else { 0.0 })
            .map(|share| share * share)
            .sum();
        (squares / self.parameters.len().max(1) as f64).sqrt()
    }
}

/// Whether a point is what a search looks for: accepted, and a contact that no small difference would undo.
pub fn is_sound(score: &Score) -> bool {
    score.refused.is_empty() && score.depth_m.is_some_and(|depth_m| depth_m >= MARGIN_M)
}

/// Whether a run ends in a contact of the ego that no small difference would undo.
pub fn is_sound_contact(rollout: &Rollout) -> bool {
    contact_depth(rollout).is_some_and(|depth_m| depth_m >= MARGIN_M)
}

/// The least box gap to a scripted partner (background traffic where there is none) that came nearer after the handover. What
/// the scene begins with does not count: a search would move who stands beside the ego, and find nothing about it.
fn approached_gap(scenario: &Scenario, run: &JudgedRun) -> Option<Timed> {
    let handover_s = scenario.draft().ego.handover_s.unwrap_or(0.0);
    let role = |partner: &PartnerMetrics| run.rollout.actors.get(partner.actor).map(|track| track.role);
    let partners = &run.metrics.partners;
    let counted = if partners.iter().any(|of| role(of) == Some(Role::Partner)) { Role::Partner } else { Role::Traffic };
    let nearer = |of: &&PartnerMetrics| role(of) == Some(counted) && came_nearer(&run.rollout, handover_s, of);
    partners.iter().filter(nearer).map(|of| of.min_gap).min_by(|a, b| a.value.total_cmp(&b.value))
}

/// How deep into one another the ego and what it touched would go, if both went on for a moment as they came, at the same
/// speed: along the same arc or straight on, whichever is less deep. [m]
fn contact_depth(rollout: &Rollout) -> Option<f64> {
    let (other, time_s, ego_state, other_state) = rollout.first_ego_contact()?;
    let step = ((time_s / STEP_S - 1e-6).floor() as usize).min(rollout.steps() - 1);
    let shape = |actor: usize, state: &ActorState, after_s: f64, turning: bool| {
        let (track, pose) = (&rollout.actors[actor], state.pose());
        let since_s = (time_s - step as f64 * STEP_S).max(1e-3);
        let rate = if turning { wrap_angle(pose.heading - track.states[step].heading) / since_s } else { 0.0 };
        // The chord of an arc is half turned.
        let chord = state.velocity().turned(0.5 * rate * after_s) * after_s;
        let pose = Pose { position: pose.position + chord, heading: pose.heading + rate * after_s };
        OrientedBox::new(pose, track.length_m, track.width_m)
    };
    let deepest = |turning: bool| {
        let depths = (0..=DEPTH_LOOKS).map(|look| {
            let after_s = DEPTH_TIME_S * f64::from(look) / f64::from(DEPTH_LOOKS);
            shape(0, &ego_state, after_s, turning).depth(&shape(other, &other_state, after_s, turning))
        });
        depths.fold(0.0, f64::max)
    };
    Some(deepest(true).min(deepest(false)))
}

fn hardest_partner_braking(rollout: &Rollout) -> f64 {
    rollout
        .actors
        .iter()
        .filter(|actor| actor.role == Role::Partner)
        .flat_map(|actor| actor.states.windows(BRAKING_STEPS + 1))
        .map(|states| (states[0].speed() - states[BRAKING_STEPS].speed()) / (BRAKING_STEPS as f64 * STEP_S))
        .fold(0.0, f64::max)
}
