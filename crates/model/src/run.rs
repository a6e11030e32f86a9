//! Judged runs: what one ego did in one scenario, and what that says. Every table, page and export of the suite reads this
//! one type.

use crate::cause::Cause;
use crate::hash::Fnv;
use crate::metrics::{Answer, CheckKind, CheckResult, Finding, FindingKind, Metrics, Timed, Verdict};
use crate::preventability::Preventability;
use crate::rollout::{EventKind, Rollout};
use crate::severity::Severity;
use serde::{Deserialize, Deserializer, Serialize};

/// The judged runs' format tag.
pub const RUN_FORMAT: &str = "recrash.run/2";

/// One run with all that was computed from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JudgedRun {
    /// What is said about it: enough for every table.
    pub judgement: Judgement,
    /// What happened.
    pub rollout: Rollout,
}

/// What is said about a run: a [`JudgedRun`] without its tracks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// Always [`RUN_FORMAT`].
    #[serde(deserialize_with = "known_format")]
    pub format: String,
    /// Name of the run by its content: scenario, ego, simulator and every state. Two runs of one id are the same run.
    pub id: String,
    /// Scenario.
    pub scenario_id: String,
    /// Ego that was run.
    pub ego: String,
    /// Simulator and its version.
    pub simulator: String,
    /// Hash of all states of the rollout: two runs of one hash drove the same.
    pub state_hash: String,
    /// Whether nobody was under test, as the ego was parked: the recorded driver drove, and fails nothing.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub parked: bool,
    /// What was measured.
    pub metrics: Metrics,
    /// What that says about the ego: failures first.
    pub findings: Vec<Finding>,
    /// Whether the rollout is true to its record.
    pub verdict: Verdict,
    /// How bad the ego's first contact with a road user is, or else with an obstacle, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub severity: Option<Severity>,
    /// What led to the failure, where it is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cause: Option<Cause>,
    /// What reference drivers make of the ego's contact, where they were asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preventability: Option<Preventability>,
}

fn known_format<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    crate::formats::known(deserializer, RUN_FORMAT)
}

impl JudgedRun {
    /// A run and what is said about it.
    pub fn new(
        rollout: Rollout,
        metrics: Metrics,
        findings: Vec<Finding>,
        severity: Option<Severity>,
        verdict: Verdict,
    ) -> Self {
        let judgement = Judgement {
            format: RUN_FORMAT.to_owned(),
            id: run_id(&rollout),
            scenario_id: rollout.scenario_id.clone(),
            ego: rollout.ego.clone(),
            simulator: rollout.simulator.clone(),
            state_hash: rollout.state_hash.clone(),
            parked: false,
            metrics,
            findings,
            verdict,
            severity,
            cause: None,
            preventability: None,
        };
        Self { judgement, rollout }
    }
}

/// What an ego crashes with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Crash {
    /// A road user: its position in [`Rollout::actors`].
    RoadUser(usize),
    /// A thing: its position in [`Rollout::obstacles`].
    Obstacle(usize),
    /// The road's end.
    OffRoad,
}

impl JudgedRun {
    /// What the ego crashes with first, by the findings.
    pub fn first_crash(&self) -> Option<Crash> {
        let crashes = self.findings.iter().filter(|finding| finding.kind.is_crash());
        let first = crashes.min_by(|a, b| a.time_s.total_cmp(&b.time_s))?;
        match first.kind {
            FindingKind::OffRoad => Some(Crash::OffRoad),
            FindingKind::ObstacleContact => self.rollout.events.iter().find_map(|event| match event.kind {
                EventKind::ObstacleContact { actor: 0, obstacle, .. } if event.time_s >= first.time_s => {
                    Some(Crash::Obstacle(obstacle))
                }
                _ => None,
            }),
            _ => self.metrics.contact.as_ref().map(|contact| Crash::RoadUser(contact.actor)),
        }
    }
}

impl std::ops::Deref for JudgedRun {
    type Target = Judgement;

    fn deref(&self) -> &Judgement {
        &self.judgement
    }
}

impl Judgement {
    /// Whether the system under test came into the situation of its record; nothing where that was not looked at.
    pub fn situation_met(&self) -> Option<bool> {
        let check = self.verdict.checks.iter().find(|check| check.kind == CheckKind::Situation)?;
        Some(check.result == CheckResult::Shown)
    }

    /// The findings that are failures of the ego, by kind; none where nobody was under test.
    pub fn failures(&self) -> impl Iterator<Item = FindingKind> {
        self.findings.iter().map(|finding| finding.kind).filter(|kind| !self.parked && kind.is_failure())
    }

    /// Whether the ego failed, by the profile's criteria.
    pub fn failed(&self) -> bool {
        self.failures().next().is_some()
    }

    /// Whether the ego brakes harder than tyres let a vehicle, anywhere.
    pub fn brakes_beyond_tyres(&self) -> bool {
        self.findings.iter().any(|finding| finding.kind == FindingKind::BrakingBeyondTyres)
    }

    /// Whether the rollout is true to its record.
    pub fn faithful(&self) -> Answer {
        self.verdict.faithful()
    }

    /// Kinds of findings, each once, failures first.
    pub fn finding_kinds(&self) -> Vec<FindingKind> {
        let mut kinds: Vec<FindingKind> = self.findings.iter().map(|finding| finding.kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        kinds
    }

    /// Least box gap to a scripted partner, or to a thing where nobody else is in the scene. [m]
    pub fn least_gap(&self) -> Option<Timed> {
        let things = self.metrics.obstacle_gaps.iter().copied().min_by(|a, b| a.value.total_cmp(&b.value));
        self.metrics.min_gap.or(things).filter(|gap| gap.value.is_finite())
    }

    /// The same without its time. [m]
    pub fn min_gap_m(&self) -> Option<f64> {
        self.least_gap().map(|gap| gap.value)
    }
}

/// Sixteen hexadecimal digits that name a run by its content.
fn run_id(rollout: &Rollout) -> String {
    let mut hash = Fnv::default();
    for part in [&rollout.scenario_id, &rollout.ego, &rollout.simulator, &rollout.state_hash] {
        hash.write_text(part);
    }
    hash.hexadecimal()
}
