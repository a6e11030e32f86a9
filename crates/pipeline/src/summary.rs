//! What a person is told at the end of a run.

use crate::casework::CaseRun;
use crate::failures::Failure;
use crate::stages::Case;
use crate::suite::{RecordSource, Suite};
use recrash_model::metrics::CheckResult;
use recrash_model::narrative::Origin;
use recrash_model::record::{FunnelStep, RecordSet};
use recrash_model::selection::{Coverage, EmbeddingInfo, Selection, StageTables, Strategy, TemplateCount};
use recrash_model::template::Template;
use recrash_model::triage::{FailureClass, Triage};
use serde::{Deserialize, Serialize};

/// A whole run in numbers (`summary.json`, and `recrash run --json`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Always `recrash.summary/1`.
    pub format: String,
    /// The command that makes the suite.
    pub command: String,
    /// Whether the records are the built-in sample.
    pub sample: bool,
    /// Profile.
    pub profile: String,
    /// Ego that was run.
    pub ego: String,
    /// Simulator.
    pub simulator: String,
    /// Rows read.
    pub rows: usize,
    /// From rows to usable records.
    pub funnel: Vec<FunnelStep>,
    /// Usable records.
    pub usable: usize,
    /// How the picks were chosen.
    pub strategy: Strategy,
    /// Embedding of the narratives.
    pub embedding: EmbeddingInfo,
    /// Cross tables.
    pub tables: StageTables,
    /// Observed templates.
    pub templates: Vec<TemplateCount>,
    /// What the picks cover.
    pub coverage: Coverage,
    /// One entry per scenario.
    pub cases: Vec<CaseSummary>,
}

/// One scenario in numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseSummary {
    /// Scenario.
    pub id: String,
    /// Template.
    pub template: Template,
    /// How the narrative came about: `rules`, `first answer`, `after repair` or `fallback`.
    pub narrated: Option<String>,
    /// How the design came about, in the same words.
    pub designed: Option<String>,
    /// Why the record itself was not used, where it was not.
    pub alternative: Option<String>,
    /// As designed.
    pub first: Option<RunSummary>,
    /// As tuned.
    pub tuned: Option<RunSummary>,
    /// What the failure of the tuned run is worth, and how the other egos fare there; absent where it does not fail.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub triage: Option<Triage>,
    /// Why it went no further, where it did not.
    pub failure: Option<Failure>,
    /// Points the search scored.
    pub points: usize,
}

/// One run in numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunSummary {
    /// Least box gap to a scripted partner. [m]
    pub min_gap_m: Option<f64>,
    /// When. [s]
    pub min_gap_time_s: Option<f64>,
    /// Least distance of centres to a scripted partner. [m]
    pub min_centre_distance_m: Option<f64>,
    /// Contact with a road user: kind of collision.
    pub contact: Option<String>,
    /// Whether the ego failed, by the profile's criteria.
    pub failed: bool,
    /// Kinds of findings, each once, failures first.
    pub findings: Vec<String>,
    /// Whether every check of faithfulness passed.
    pub faithful: bool,
    /// Checks that failed: what is expected and what was observed.
    pub unfaithful: Vec<String>,
}

impl RunSummary {
    fn new(run: &CaseRun) -> Self {
        let mut kinds: Vec<_> = run.findings.iter().map(|f| f.kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let checks = run.verdict.iter().flat_map(|v| &v.checks);
        let unfaithful = checks
            .filter(|check| check.result == CheckResult::Fail)
            .map(|c| format!("{}: expected {}, observed {}", c.kind.label(), c.expected, c.observed))
            .collect();
        Self {
            min_gap_m: run.metrics.min_gap.map(|gap| gap.value),
            min_gap_time_s: run.metrics.min_gap.map(|gap| gap.time_s),
            min_centre_distance_m: run.metrics.min_centre_distance.map(|d| d.value),
            contact: run.metrics.contact.as_ref().map(|contact| contact.kind.label().to_owned()),
            failed: run.failed(),
            findings: kinds.iter().map(|kind| kind.label().to_owned()).collect(),
            faithful: run.faithful(),
            unfaithful,
        }
    }
}

impl Summary {
    /// Scenarios whose tuned run is faithful.
    pub fn faithful(&self) -> usize {
        self.cases.iter().filter(|case| case.tuned.as_ref().is_some_and(|run| run.faithful)).count()
    }

    /// Scenarios that went all the way.
    pub fn run(&self) -> usize {
        self.cases.iter().filter(|case| case.tuned.is_some()).count()
    }

    /// Failures of each class, after tuning; classes without any are left out.
    pub fn failure_classes(&self) -> Vec<(FailureClass, usize)> {
        let classes = self.cases.iter().filter_map(|case| case.triage.as_ref()).map(|triage| triage.class);
        let classes: Vec<FailureClass> = classes.collect();
        let count = |class| classes.iter().filter(|&&other| other == class).count();
        FailureClass::ALL.into_iter().map(|class| (class, count(class))).filter(|(_, count)| *count > 0).collect()
    }

    /// Scenarios the ego fails, as designed and as tuned.
    pub fn failed(&self) -> (usize, usize) {
        let count = |run: fn(&CaseSummary) -> &Option<RunSummary>| {
            self.cases.iter().filter(|case| run(case).as_ref().is_some_and(|run| run.failed)).count()
        };
        (count(|case| &case.first), count(|case| &case.tuned))
    }
}

/// Puts a run in numbers.
pub fn summarise(suite: &Suite, records: &RecordSet, selection: &Selection, cases: &[Case]) -> Summary {
    Summary {
        format: "recrash.summary/1".into(),
        command: suite.options().command(),
        sample: suite.options().records == RecordSource::Sample,
        profile: suite.profile().name.clone(),
        ego: suite.ego().to_owned(),
        simulator: simulator_name(cases),
        rows: records.files.iter().map(|file| file.rows).sum(),
        funnel: records.funnel.clone(),
        usable: records.usable.len(),
        strategy: selection.strategy,
        embedding: selection.embedding.clone(),
        tables: selection.tables.clone(),
        templates: selection.templates.clone(),
        coverage: selection.coverage.clone(),
        cases: cases
            .iter()
            .map(|case| CaseSummary {
                id: case.cluster.scenario_id.clone(),
                template: case.cluster.template,
                narrated: case.narrative.as_ref().map(|(_, log)| log.outcome().to_owned()),
                designed: case.design.as_ref().map(|log| log.outcome().to_owned()),
                alternative: case.narrative.as_ref().and_then(|(narrative, _)| match &narrative.origin {
                    Origin::Record => None,
                    Origin::Alternative { reason } => Some(reason.clone()),
                }),
                first: case.first.as_ref().map(|ran| RunSummary::new(&ran.run)),
                tuned: case.tuned.as_ref().map(|(ran, _)| RunSummary::new(&ran.run)),
                triage: case.triage.clone(),
                failure: case.failure.clone(),
                points: case.tuned.as_ref().map_or(0, |(_, log)| log.points.len()),
            })
            .collect(),
    }
}

/// The simulator that ran the scenarios, with its version.
pub fn simulator_name(cases: &[Case]) -> String {
    cases.iter().find_map(|case| case.first.as_ref()).map_or_else(String::new, |ran| ran.run.rollout.simulator.clone())
}
