//! One scenario on both simulators, compared; and what many of them say together.

use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::{FindingKind, Timed};
use recrash_model::rollout::{ActorTrack, Role, Rollout, STEP_S, TerminationKind};
use recrash_model::run::JudgedRun;
use recrash_model::scenario::{Policy, ScenarioDraft};
use serde::Serialize;

/// Least gaps that differ by no more than this agree. [m]
pub const GAP_TOLERANCE_M: f64 = 0.5;

/// Times of the least gap that differ by no more than this agree. [s]
pub const TIME_TOLERANCE_S: f64 = 0.3;

/// A gap that is no larger than the least by more than this is held: who stands beside somebody has its least gap all the time, and
/// rounding decides which step is called the least. [m]
pub const HELD_M: f64 = 0.02;

/// Times at which positions are compared. [s]
const TIMES_S: [f64; 8] = [1.0, 2.0, 3.0, 5.0, 8.0, 10.0, 15.0, 20.0];

/// What one simulator made of a scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairOutcome {
    /// How the run ended.
    pub end: TerminationKind,
    /// When. [s]
    pub end_s: f64,
    /// When the ego touched a road user, where it did. [s]
    pub contact_s: Option<f64>,
    /// Least box gap of the ego to a scripted partner (background traffic where there is none). [m]
    pub min_gap: Option<Timed>,
    /// From when until when the gap is held there: within [`HELD_M`] of the least. [s]
    pub held_s: Option<(f64, f64)>,
    /// Whether the ego failed, by the profile's criteria.
    pub failed: bool,
    /// What was found, each kind once.
    pub findings: Vec<FindingKind>,
}

/// A scenario on both simulators.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Pair {
    /// Name: the scenario's id, with its folder where it is one of a suite.
    pub name: String,
    /// Letter of its map.
    pub map: char,
    /// Policy of the first partner; `plan` where road users have plans, `none` where there are none.
    pub policy: &'static str,
    /// Kind of the first partner, or of the first with a plan.
    pub kind: Option<PartnerKind>,
    /// What else there is: obstacles, background traffic, a surface that is not dry, sideways moves, control, doors and the
    /// like, a handover from the recorded driver.
    pub extras: Vec<&'static str>,
    /// The native simulator.
    pub native: PairOutcome,
    /// MetaDrive.
    pub metadrive: Option<PairOutcome>,
    /// Why MetaDrive gave no outcome.
    pub error: Option<String>,
    /// How far apart the ego is on both, at 1, 2, 3, 5, 8, 10, 15 and 20 s, as long as both run. [m]
    pub ego_apart_m: Vec<f64>,
    /// The same for the partner that is farthest apart. [m]
    pub partner_apart_m: Vec<f64>,
}

impl PairOutcome {
    fn of(run: &JudgedRun) -> Self {
        let mut findings: Vec<FindingKind> = run.findings.iter().map(|finding| finding.kind).collect();
        findings.sort_unstable();
        findings.dedup();
        Self {
            end: run.metrics.termination,
            end_s: run.metrics.duration_s,
            contact_s: run.metrics.contact.as_ref().map(|contact| contact.time_s),
            min_gap: run.metrics.min_gap,
            held_s: run.metrics.min_gap.map(|least| held(&run.rollout, least)),
            failed: run.failed(),
            findings,
        }
    }
}

/// From when until when the gap to somebody is held at its least, around the time of the least.
fn held(rollout: &Rollout, least: Timed) -> (f64, f64) {
    let partners = rollout.actors.iter().any(|track| track.role == Role::Partner);
    let role = if partners { Role::Partner } else { Role::Traffic };
    let ego = rollout.ego_track();
    let others: Vec<_> = rollout.actors.iter().filter(|track| track.role == role).collect();
    let is_held = |step: &usize| {
        let own = ego.outline(*step);
        let there = |track: &&&ActorTrack| *step < track.states.len();
        others.iter().filter(there).any(|track| own.gap(&track.outline(*step)) <= least.value + HELD_M)
    };
    let at = ((least.time_s / STEP_S).round() as usize).min(ego.states.len().saturating_sub(1));
    let first = (0..at).rev().take_while(is_held).last().unwrap_or(at);
    let last = (at + 1..ego.states.len()).take_while(is_held).last().unwrap_or(at);
    (least.time_s.min(STEP_S * first as f64), least.time_s.max(STEP_S * last as f64))
}

impl Pair {
    /// What is different, in a few words.
    pub fn remark(&self) -> String {
        let Some((gap_m, time_s)) = self.gap_difference() else {
            return self.error.clone().unwrap_or_else(|| "a least gap on one of them only".to_owned());
        };
        let verdict = if self.same_verdict() { "" } else { "another verdict; " };
        format!("{verdict}least gaps differ by {gap_m:.2} m and {time_s:.1} s")
    }
}

impl Pair {
    /// Compares two runs of a scenario.
    pub fn of(name: String, draft: &ScenarioDraft, native: &JudgedRun, metadrive: Result<&JudgedRun, String>) -> Self {
        let apart = |role: Role| {
            metadrive.as_ref().map_or_else(|_| Vec::new(), |run| apart(&native.rollout, &run.rollout, role))
        };
        let first = draft.partners.first();
        let planned = draft.actors.first();
        Self {
            name,
            map: draft.map.letter(),
            policy: match (first, planned) {
                (Some(partner), _) => policy_name(&partner.policy),
                (None, Some(_)) => "plan",
                (None, None) => "none",
            },
            kind: first.map(|partner| partner.kind).or(planned.map(|actor| actor.kind)),
            extras: extras(draft),
            native: PairOutcome::of(native),
            ego_apart_m: apart(Role::Ego),
            partner_apart_m: apart(Role::Partner),
            metadrive: metadrive.as_ref().ok().map(|run| PairOutcome::of(run)),
            error: metadrive.err(),
        }
    }

    /// Both saw a contact, or neither did.
    pub fn same_verdict(&self) -> bool {
        self.metadrive.as_ref().is_some_and(|other| other.contact_s.is_some() == self.native.contact_s.is_some())
    }

    /// Difference of the least gaps, and of the times at which they are held; zero where neither has one. [m, s]
    pub fn gap_difference(&self) -> Option<(f64, f64)> {
        match (self.native.min_gap, self.metadrive.as_ref()?.min_gap) {
            (Some(ours), Some(theirs)) => {
                let when = |outcome: &PairOutcome, least: Timed| outcome.held_s.unwrap_or((least.time_s, least.time_s));
                let (first, second) = (when(&self.native, ours), when(self.metadrive.as_ref()?, theirs));
                let apart_s = (first.0 - second.1).max(second.0 - first.1).max(0.0);
                Some(((ours.value - theirs.value).abs(), apart_s))
            }
            (None, None) => Some((0.0, 0.0)),
            _ => None,
        }
    }

    /// The least gaps agree.
    pub fn same_gap(&self) -> bool {
        self.gap_difference().is_some_and(|(gap, _)| gap <= GAP_TOLERANCE_M)
    }

    /// So do their times; to a hair more, because both are decimals.
    pub fn same_time(&self) -> bool {
        self.gap_difference().is_some_and(|(_, time)| time <= TIME_TOLERANCE_S + 1e-9)
    }

    /// The ego arrived on both, or on neither.
    pub fn same_arrival(&self) -> bool {
        let arrived = |outcome: &PairOutcome| outcome.end == TerminationKind::Arrived;
        self.metadrive.as_ref().is_some_and(|other| arrived(other) == arrived(&self.native))
    }

    /// The ego failed natively.
    pub fn failed_natively(&self) -> bool {
        self.native.failed
    }

    /// The ego failed natively, and on MetaDrive too.
    pub fn confirmed(&self) -> bool {
        self.native.failed && self.metadrive.as_ref().is_some_and(|other| other.failed)
    }

    /// How far the two are apart: the larger the worse. A different verdict is worse than any difference of gaps.
    pub fn badness(&self) -> f64 {
        let Some((gap, time)) = self.gap_difference() else { return f64::INFINITY };
        gap + time + if self.same_verdict() { 0.0 } else { 1e3 }
    }
}

/// Counts over many pairs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Agreement {
    /// Pairs.
    pub pairs: usize,
    /// Contact on both or on neither.
    pub same_verdict: usize,
    /// Least gap within [`GAP_TOLERANCE_M`].
    pub same_gap: usize,
    /// Its time within [`TIME_TOLERANCE_S`].
    pub same_time: usize,
    /// Arrived on both or on neither.
    pub same_arrival: usize,
    /// Failures found natively.
    pub failed_natively: usize,
    /// Those that are failures on MetaDrive too.
    pub confirmed: usize,
    /// Pairs without an outcome on MetaDrive; they count as disagreeing.
    pub errors: usize,
}

impl Agreement {
    /// Of these pairs.
    pub fn of<'a>(pairs: impl IntoIterator<Item = &'a Pair>) -> Self {
        let mut all = Self::default();
        for pair in pairs {
            all.pairs += 1;
            all.same_verdict += usize::from(pair.same_verdict());
            all.same_gap += usize::from(pair.same_gap());
            all.same_time += usize::from(pair.same_time());
            all.same_arrival += usize::from(pair.same_arrival());
            all.failed_natively += usize::from(pair.failed_natively());
            all.confirmed += usize::from(pair.confirmed());
            all.errors += usize::from(pair.metadrive.is_none());
        }
        all
    }
}

/// Distance between the positions on both simulators at one time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Apart {
    /// Time. [s]
    pub time_s: f64,
    /// Pairs that are still running on both.
    pub pairs: usize,
    /// The ego: median and 90th percentile. [m]
    pub ego_m: (f64, f64),
    /// The partner farthest apart: median and 90th percentile. [m]
    pub partner_m: (f64, f64),
}

/// Distances over time.
pub fn apart_over_time(pairs: &[Pair]) -> Vec<Apart> {
    let at = |(position, time_s): (usize, f64)| {
        let of = |values: fn(&Pair) -> &Vec<f64>| {
            let mut all: Vec<f64> = pairs.iter().filter_map(|pair| values(pair).get(position).copied()).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let (ego, partner) = (of(|pair| &pair.ego_apart_m), of(|pair| &pair.partner_apart_m));
        let both = |all: &[f64]| (quantile(all, 0.5), quantile(all, 0.9));
        Apart { time_s, pairs: ego.len(), ego_m: both(&ego), partner_m: both(&partner) }
    };
    TIMES_S.into_iter().enumerate().map(at).filter(|apart| apart.pairs > 0).collect()
}

/// A quantile of sorted values, linear between them; 0 without any.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let place = share * last as f64;
    let (below, part) = (place.floor() as usize, place - place.floor());
    sorted[below] + (sorted[(below + 1).min(last)] - sorted[below]) * part
}

/// How far apart the actors of a role are (the farthest of them) at [`TIMES_S`], as long as both run.
fn apart(native: &Rollout, metadrive: &Rollout, role: Role) -> Vec<f64> {
    let steps = native.steps().min(metadrive.steps());
    TIMES_S
        .iter()
        .map(|time_s| (time_s / STEP_S).round() as usize)
        .take_while(|step| *step < steps)
        .map(|step| {
            let both = native.actors.iter().zip(&metadrive.actors).filter(|(actor, _)| actor.role == role);
            both.map(|(a, b)| a.states[step].position().distance(b.states[step].position())).fold(0.0, f64::max)
        })
        .collect()
}

/// A policy's name, as in scenario files.
pub fn policy_name(policy: &Policy) -> &'static str {
    match policy {
        Policy::SuddenBrake { .. } => "sudden_brake",
        Policy::AccelThenBrake { .. } => "accel_then_brake",
        Policy::IdmNominal { .. } => "idm_nominal",
        Policy::Stopped { .. } => "stopped",
        Policy::Yielding { .. } => "yielding",
    }
}

fn extras(draft: &ScenarioDraft) -> Vec<&'static str> {
    use recrash_model::surroundings::Surface;
    let mut all = Vec::new();
    all.extend((!draft.obstacles.is_empty() || !draft.objects.is_empty()).then_some("obstacles"));
    all.extend((draft.traffic.density > 0.0).then_some("traffic"));
    match draft.environment.surface {
        Surface::Dry => {}
        Surface::Wet => all.push("wet road"),
        Surface::SnowIce => all.push("icy road"),
    }
    all.extend(draft.partners.iter().any(|partner| !partner.lateral.is_empty()).then_some("sideways move"));
    all.extend((!draft.control.is_empty()).then_some("control"));
    all.extend(draft.actors.iter().any(|actor| !actor.parts.is_empty()).then_some("parts"));
    all.extend(draft.ego.handover_s.map(|_| "handover"));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_is_held_while_nobody_moves_and_for_a_moment_when_somebody_drives_by() {
        let text = |speed_mps: f64| {
            format!(
                r#"{{"format": "recrash.scenario/2", "id": "held", "source": {{}}, "duration_s": 8,
                "map": {{"type": "G", "roads": [{{"id": "main", "start": {{"at": {{"x_m": 0, "y_m": 0, "heading_deg": 0}}}},
                    "line": [{{"straight": {{"length_m": 120}}}}], "right": [{{"kind": "driving"}}, {{"kind": "driving"}}]}}]}},
                "ego": {{"route": ["main+"], "lane": 1, "target_speed_mps": 5, "recorded": {{"start": {{"road": "main+", "lane": 1, "s_m": 40}}}}}},
                "actors": [{{"id": "other", "plan": {{"start": {{"road": "main+", "lane": 0, "s_m": 20}},
                    "speed_mps": {speed_mps}, "course": [{{"lanes": {{"roads": ["main+"]}}}}]}}}}]}}"#
            )
        };
        let held_for = |speed_mps: f64| {
            let draft: ScenarioDraft = serde_json::from_str(&text(speed_mps)).expect("a scenario");
            let scenario = recrash_roads::check(draft).expect("it can run").value;
            let rollout = recrash_sim::simulate(&scenario, recrash_sim::Ego::Recorded);
            let gaps = recrash_metrics::series(&rollout).partners[0].gap_m.clone();
            let least = gaps.iter().enumerate().min_by(|one, other| one.1.total_cmp(other.1)).expect("steps");
            let (from_s, until_s) = held(&rollout, Timed { value: *least.1, time_s: STEP_S * least.0 as f64 });
            until_s - from_s
        };
        assert!(held_for(0.0) > 7.0, "{}", held_for(0.0));
        // Side by side for a length of both, at 5 m/s.
        assert!((1.0..2.2).contains(&held_for(5.0)), "{}", held_for(5.0));
    }

    #[test]
    fn quantiles_lie_between_their_neighbours() {
        assert_eq!(quantile(&[], 0.5), 0.0);
        assert_eq!(quantile(&[3.0], 0.9), 3.0);
        assert_eq!(quantile(&[0.0, 1.0, 2.0, 10.0], 0.5), 1.5);
        assert!((quantile(&[0.0, 10.0], 0.9) - 9.0).abs() < 1e-12);
    }
}
