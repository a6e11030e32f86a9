//! What a person is told at the end of a run.

use crate::agents::{AgentLog, Cast, RULES};
use crate::failures::Failure;
use crate::stages::Case;
use crate::suite::{RecordSource, Suite};
use recrash_model::metrics::{Answer, Check};
use recrash_model::narrative::Origin;
use recrash_model::record::{FunnelStep, RecordSet};
use recrash_model::run::JudgedRun;
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
    /// How the models did, one entry for each role that one plays; empty where the rules play all.
    #[serde(default)]
    pub models: Vec<ModelSummary>,
    /// One entry per scenario.
    pub cases: Vec<CaseSummary>,
}

/// How a model did in a role.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModelSummary {
    /// `paraphrase`, `design` or `tune`.
    pub role: String,
    /// Model that was asked.
    pub model: String,
    /// Scenarios whose first answer was accepted.
    pub first_answer: usize,
    /// Scenarios with an answer that was accepted after repair.
    pub after_repair: usize,
    /// Scenarios where the rules took over.
    pub fallback: usize,
    /// Scenarios with nothing to ask: a contact as designed needs no tuning.
    pub not_asked: usize,
    /// Why the rules took over.
    pub reasons: Vec<FallbackReason>,
}

/// Why the rules took over in one scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FallbackReason {
    /// Scenario.
    pub id: String,
    /// Why.
    pub why: String,
}

impl ModelSummary {
    /// Scenarios for which the model was asked.
    pub fn asked(&self) -> usize {
        self.first_answer + self.after_repair + self.fallback
    }

    /// For a line of text: `18 of 20 at the first answer, 1 after repair, 1 by the rules`.
    pub fn describe(&self) -> String {
        format!(
            "{} of {} at the first answer, {} after repair, {} by the rules",
            self.first_answer,
            self.asked(),
            self.after_repair,
            self.fallback
        )
    }
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
    /// How the tuned one came about, in the same words, or `not asked` where a contact as designed needs no tuning.
    #[serde(default)]
    pub tuned_by: Option<String>,
    /// Whose crash it tells, and why not the picked record's.
    pub origin: Option<Origin>,
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
    /// Whether it is true to its record.
    pub faithful: Answer,
    /// Facts that are not shown: what is told and what was observed.
    pub unfaithful: Vec<String>,
    /// Facts that cannot be shown.
    #[serde(default)]
    pub unchecked: Vec<String>,
}

impl RunSummary {
    pub(crate) fn new(run: &JudgedRun) -> Self {
        let told = |c: &Check| format!("{}: expected {}, observed {}", c.kind.label(), c.expected, c.observed);
        Self {
            min_gap_m: run.metrics.min_gap.map(|gap| gap.value),
            min_gap_time_s: run.metrics.min_gap.map(|gap| gap.time_s),
            min_centre_distance_m: run.metrics.min_centre_distance.map(|d| d.value),
            contact: run.metrics.contact.as_ref().map(|contact| contact.kind.label().to_owned()),
            failed: run.failed(),
            findings: run.finding_kinds().iter().map(|kind| kind.label().to_owned()).collect(),
            faithful: run.faithful(),
            unfaithful: run.verdict.failures().map(told).collect(),
            unchecked: run.verdict.unchecked().map(|check| check.kind.label().to_owned()).collect(),
        }
    }
}

impl Summary {
    /// Scenarios whose tuned run gives this answer to whether it is true to its record.
    pub fn faithful(&self, answer: Answer) -> usize {
        self.cases.iter().filter(|case| case.tuned.as_ref().is_some_and(|run| run.faithful == answer)).count()
    }

    /// Scenarios that tell their own record, another one, and nobody's crash.
    pub fn origins(&self) -> [usize; 3] {
        let named = |name| move |case: &&CaseSummary| case.origin.as_ref().is_some_and(|o| o.name() == name);
        ["own", "other", "invented"].map(|name| self.cases.iter().filter(named(name)).count())
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
        models: models(&suite.options().cast, cases),
        cases: cases
            .iter()
            .map(|case| CaseSummary {
                id: case.cluster.scenario_id.clone(),
                template: case.cluster.template,
                narrated: case.narrative.as_ref().map(|(_, log)| log.outcome().to_owned()),
                designed: case.design.as_ref().map(|log| log.outcome().to_owned()),
                tuned_by: case.tuned.as_ref().map(|tuned| tuned.agent.outcome().to_owned()),
                origin: case.narrative.as_ref().map(|(narrative, _)| narrative.origin.clone()),
                first: case.first.as_ref().map(|ran| RunSummary::new(&ran.run)),
                tuned: case.tuned.as_ref().map(|tuned| RunSummary::new(&tuned.ran.run)),
                triage: case.triage.clone(),
                failure: case.failure.clone(),
                points: case.tuned.as_ref().map_or(0, |tuned| tuned.log.points.len()),
            })
            .collect(),
    }
}

/// How the models of a cast did.
pub fn models(cast: &Cast, cases: &[Case]) -> Vec<ModelSummary> {
    type Told = Option<(&'static str, String)>;
    type Role<'a> = (&'static str, &'a String, &'a dyn Fn(&Case) -> Told);
    let of_agent = |log: &AgentLog| (log.outcome(), log.fallback.clone().unwrap_or_default());
    let narrated = |case: &Case| -> Told { case.narrative.as_ref().map(|(_, log)| of_agent(log)) };
    let designed = |case: &Case| -> Told { case.design.as_ref().map(|log| (log.outcome(), log.gave_up.join("; "))) };
    let tuned = |case: &Case| -> Told { case.tuned.as_ref().map(|tuned| of_agent(&tuned.agent)) };
    let roles: [Role; 3] = [
        ("paraphrase", &cast.paraphrase, &narrated),
        ("design", &cast.design, &designed),
        ("tune", &cast.tune, &tuned),
    ];
    let by_model = roles.into_iter().filter(|(_, model, _)| *model != RULES);
    by_model
        .map(|(role, model, told)| {
            let count = |word: &str| cases.iter().filter(|case| told(case).is_some_and(|(is, _)| is == word)).count();
            let reason = |case: &Case| {
                let why = told(case).filter(|(is, _)| *is == "fallback")?.1;
                Some(FallbackReason { id: case.cluster.scenario_id.clone(), why })
            };
            ModelSummary {
                role: role.to_owned(),
                model: model.clone(),
                first_answer: count("first answer"),
                after_repair: count("after repair"),
                fallback: count("fallback"),
                not_asked: count("not asked"),
                reasons: cases.iter().filter_map(reason).collect(),
            }
        })
        .collect()
}

/// The simulator that ran the scenarios, with its version.
pub fn simulator_name(cases: &[Case]) -> String {
    cases.iter().find_map(|case| case.first.as_ref()).map_or_else(String::new, |ran| ran.run.rollout.simulator.clone())
}
