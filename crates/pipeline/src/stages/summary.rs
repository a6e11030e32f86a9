//! What a person is told at the end of a run.

use super::failures::{Failure, missed, unfaithful_among};
use super::made::Case;
use super::run_summary::RunSummary;
use super::{Cases, DesignLog};
use crate::error::PipelineError;
use crate::models::cast::{AgentLog, Cast, RULES};
use crate::options::RecordSource;
use crate::suite::{Stage, Suite};
use recrash_agents::llm::Role;
use recrash_lab::coverage::{Incident, Tested, coverage};
use recrash_model::account::{AccountSet, CrashType, FactShare, TypeShare, Untold};
use recrash_model::cause::{Cause, Failures};
use recrash_model::coverage::CorpusCoverage;
use recrash_model::metrics::Answer;
use recrash_model::narrative::Origin;
use recrash_model::preventability::Bracket;
use recrash_model::record::{FunnelStep, RecordRef};
use recrash_model::review::Review;
use recrash_model::selection::{Coverage, EmbeddingInfo, StageTables, Strategy, TemplateCount};
use recrash_model::template::Template;
use recrash_model::triage::{FailureClass, Triage};
use recrash_report::Changed;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

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
    /// How much of the incidents is told, in a suite that goes by accounts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accounts: Option<AccountSummary>,
    /// What of all readable incidents the suite covers, where it goes by accounts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub corpus: Option<CorpusCoverage>,
    /// One entry per scenario.
    pub cases: Vec<CaseSummary>,
}

/// What became of all incidents.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AccountSummary {
    /// Incidents.
    pub incidents: usize,
    /// With a narrative that can be read.
    pub readable: usize,
    /// Of those, told as they happened: every checked fact is shown.
    pub told: usize,
    /// By crash type.
    pub types: Vec<TypeShare>,
    /// By kind of fact.
    pub facts: Vec<FactShare>,
    /// Why the others are not, most frequent first.
    pub untold: Vec<(Untold, usize)>,
}

impl AccountSummary {
    fn of(set: &AccountSet) -> Self {
        let mut counts: BTreeMap<Untold, usize> = BTreeMap::new();
        for incident in &set.untold {
            *counts.entry(incident.why).or_default() += 1;
        }
        let mut untold: Vec<(Untold, usize)> = counts.into_iter().collect();
        untold.sort_by_key(|(why, count)| (std::cmp::Reverse(*count), *why));
        Self {
            incidents: set.incidents,
            readable: set.readable,
            told: set.told.len(),
            types: set.types.clone(),
            facts: set.facts.clone(),
            untold,
        }
    }
}

/// How a model did in a role.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModelSummary {
    /// `paraphrase`, `design`, `tune` or `review`.
    pub role: String,
    /// Model that was asked.
    pub model: String,
    /// Scenarios whose first answer was accepted.
    pub first_answer: usize,
    /// Scenarios with an answer that was accepted after repair.
    pub after_repair: usize,
    /// Scenarios where the rules took over; of a review, those that nobody reviewed.
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
            "{} of {} at the first answer, {} after repair, {} {}",
            self.first_answer,
            self.asked(),
            self.after_repair,
            self.fallback,
            if self.is_review() { "by nobody" } else { "by the rules" }
        )
    }

    /// Whether it held replays against reports: no rules take over there.
    pub fn is_review(&self) -> bool {
        self.role == Role::Review.name()
    }
}

/// The rules took over from a model.
const FALLBACK: &str = "fallback";

/// How a role was played in one scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoleSummary {
    /// `rules`, `first answer`, `after repair`, `fallback` or `not asked` (a contact as designed needs no tuning).
    pub outcome: String,
    /// Why the rules took over, where they did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

/// One scenario in numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseSummary {
    /// Scenario.
    pub id: String,
    /// Template.
    pub template: Template,
    /// How the narrative came about.
    pub narrated: Option<RoleSummary>,
    /// How the design came about.
    pub designed: Option<RoleSummary>,
    /// How the tuned one came about.
    pub tuned_by: Option<RoleSummary>,
    /// Whose crash it tells, and why not the picked record's.
    pub origin: Option<Origin>,
    /// The record that is told; none where the crash is invented.
    pub told: Option<RecordRef>,
    /// Files that a person edited.
    pub edited: Vec<String>,
    /// Crash type, in a suite that goes by accounts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crash_type: Option<CrashType>,
    /// The recorded driver's run, in a suite that goes by accounts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recorded: Option<RunSummary>,
    /// How the review of that run came about, where a model is cast for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reviewed: Option<RoleSummary>,
    /// What it finds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub review: Option<Review>,
    /// Whether a signal or a sign stands in the scenario that the recorded driver drives.
    #[serde(default)]
    pub signs: bool,
    /// Whether the system under test came into the situation of its record; absent where that was not looked at.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub situation_met: Option<bool>,
    /// As designed.
    pub first: Option<RunSummary>,
    /// As tuned.
    pub tuned: Option<RunSummary>,
    /// What the failure of the tuned run is worth, and how the other egos fare there; absent where it does not fail.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub triage: Option<Triage>,
    /// What a model changed in what the rules staged, where one was cast and did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub changed: Option<Changed>,
    /// Why it went no further, where it did not.
    pub failure: Option<Failure>,
    /// Points the search scored.
    pub points: usize,
    /// Whether the system under test drove the same scenario otherwise when it was run in it again: a program whose answers do not
    /// repeat.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unrepeated: bool,
}

/// Reviews in numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reviews<'a> {
    /// The model that read.
    pub model: &'a str,
    /// Replays that it read.
    pub read: usize,
    /// Of those, replays that show the crash that is told.
    pub right: usize,
    /// By question, the others that show it otherwise; the most frequent first.
    pub wrong: Vec<(&'static str, usize)>,
}

/// Runs of the system under test, in numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TestedRuns {
    /// Runs.
    pub ran: usize,
    /// Of those, runs that came into the situation of the record.
    pub met: usize,
    /// Of those, failures.
    pub failures: Failures,
    /// Of those that came into the situation and did not fail, runs in which the ego brakes harder than tyres let a vehicle.
    pub beyond_tyres: usize,
}

/// Scenarios of a suite by whether the run that is held against the record shows its crash.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shown {
    /// No told fact is shown otherwise.
    pub as_told: usize,
    /// Told facts are shown otherwise: a person edited it, or the rules found no better.
    pub not_as_told: usize,
    /// There is no such run.
    pub not_run: usize,
}

impl Summary {
    /// Scenarios by whether their own run shows the crash.
    pub fn shown(&self) -> Shown {
        let count = |holds: fn(&CaseSummary) -> bool| self.cases.iter().filter(|case| holds(case)).count();
        let not_as_told = count(|case| case.faithful() == Some(Answer::No));
        let not_run = count(|case| case.recorded.is_none() && case.tuned.is_none());
        Shown { as_told: self.cases.len() - not_as_told - not_run, not_as_told, not_run }
    }

    /// Scenarios that could not be made or run to the end.
    pub fn failures(&self) -> impl Iterator<Item = (&CaseSummary, &Failure)> {
        self.cases.iter().filter_map(|case| Some((case, case.failure.as_ref()?)))
    }

    /// What of this run is not as it is asked for, in the terms of the commands that run one stage: scenarios that are not true to the
    /// records they tell, and such as could not be run.
    ///
    /// # Errors
    /// A file of the suite cannot be read.
    pub fn missed(&self, suite: &Suite) -> Result<Option<String>, PipelineError> {
        // What was edited after the search is another run than the one that is summed up here.
        let edited: Vec<&str> =
            self.cases.iter().filter(|case| !case.edited.is_empty()).map(|case| case.id.as_str()).collect();
        let mut lost: BTreeSet<&str> = BTreeSet::new();
        lost.extend(self.cases.iter().filter(|case| case.faithful() == Some(Answer::No)).map(|case| case.id.as_str()));
        let mut told = Vec::new();
        for stage in [Stage::Simulate, Stage::Triage] {
            told.extend(unfaithful_among(suite, stage, &edited)?);
        }
        lost.extend(told.iter().filter_map(|remark| remark.location.file.as_deref()));
        let not_run = self.failures().filter(|(_, failure)| failure.stage != Stage::Review.name()).count();
        Ok(missed(lost.len(), not_run))
    }

    /// Scenarios of their own record, and of another one, whose tuned run gives this answer to whether it is true to it.
    /// An invented one has no record to be true to.
    pub fn faithful(&self, answer: Answer) -> [usize; 2] {
        let answers = |case: &&CaseSummary| case.faithful() == Some(answer);
        let told = |name| self.cases.iter().filter(answers).filter(|case| case.is_told(name)).count();
        ["own", "other"].map(told)
    }

    /// Scenarios that tell their own record, another one, and nobody's crash.
    pub fn origins(&self) -> [usize; 3] {
        ["own", "other", "invented"].map(|name| self.cases.iter().filter(|case| case.is_told(name)).count())
    }

    /// What the model finds that holds replays against reports: who it is, how many it reads, how many of them show their crash, and in
    /// how many of the others each question is answered by no; nothing where none is cast.
    pub fn reviews(&self) -> Option<Reviews<'_>> {
        let model = self.models.iter().find(|model| model.is_review())?.model.as_str();
        let reviews: Vec<&Review> = self.cases.iter().filter_map(|case| case.review.as_ref()).collect();
        let mut wrong: Vec<(&'static str, usize)> = Vec::new();
        for name in reviews.iter().flat_map(|review| review.wrong()) {
            match wrong.iter_mut().find(|(known, _)| *known == name) {
                Some((_, count)) => *count += 1,
                None => wrong.push((name, 1)),
            }
        }
        wrong.sort_by_key(|(name, count)| (std::cmp::Reverse(*count), *name));
        let right = reviews.iter().filter(|review| review.is_right()).count();
        Some(Reviews { model, read: reviews.len(), right, wrong })
    }

    /// Which model looked at the replays of what the rules staged, how many scenarios it left as they are, changed, and was not content
    /// with in the end; nothing where none is cast, or the suite goes by templates.
    pub fn restagings(&self) -> Option<(&str, [usize; 3])> {
        let model = self.models.iter().find(|model| self.accounts.is_some() && model.role == Role::Design.name())?;
        let changed = self.cases.iter().filter(|case| case.changed.is_some()).count();
        let content = model.first_answer + model.after_repair;
        Some((&model.model, [content - changed.min(content), changed, model.fallback]))
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

    /// Failures of the last runs by what led to them: one finding each, the most frequent first.
    pub fn causes(&self) -> Vec<(Cause, usize)> {
        let count = |cause: Cause| self.last_failures().filter(|run| run.cause == Some(cause)).count();
        let mut causes: Vec<_> = Cause::ALL.into_iter().map(|cause| (cause, count(cause))).collect();
        causes.retain(|(_, count)| *count > 0);
        causes.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        causes
    }

    /// Failures of the last runs with a contact, by what reference drivers make of it.
    pub fn brackets(&self) -> BTreeMap<Bracket, usize> {
        let mut brackets = BTreeMap::new();
        for bracket in self.last_failures().filter_map(|run| run.preventability) {
            *brackets.entry(bracket).or_default() += 1;
        }
        brackets
    }

    fn last_failures(&self) -> impl Iterator<Item = &RunSummary> {
        self.cases.iter().filter_map(CaseSummary::last_run).filter(|run| run.failed)
    }

    /// In a suite that goes by accounts: the system under test in the crashes as reconstructed, and in its last runs there, after
    /// tuning where it answered. Its runs are held against one thing alone, whether it came into the situation of the record.
    pub fn tested(&self) -> [TestedRuns; 2] {
        let of = |run: fn(&CaseSummary) -> Option<&RunSummary>| {
            let runs: Vec<&RunSummary> = self.cases.iter().filter_map(run).collect();
            let met: Vec<&RunSummary> = runs.iter().copied().filter(|run| run.met == Some(true)).collect();
            TestedRuns {
                ran: runs.len(),
                met: met.len(),
                failures: Failures::of(met.iter().filter(|run| run.failed).map(|run| run.cause)),
                beyond_tyres: met.iter().filter(|run| !run.failed && run.brakes_beyond_tyres()).count(),
            }
        };
        [of(|case| case.first.as_ref()), of(CaseSummary::last_run)]
    }

    /// Scenarios the ego fails, as designed and as tuned.
    pub fn failed(&self) -> (usize, usize) {
        let count = |run: fn(&CaseSummary) -> &Option<RunSummary>| {
            self.cases.iter().filter(|case| run(case).as_ref().is_some_and(|run| run.failed)).count()
        };
        (count(|case| &case.first), count(|case| &case.tuned))
    }
}

impl CaseSummary {
    /// The last run of the system under test: in the tuned scenario, or as designed where it gave no answer after that.
    pub fn last_run(&self) -> Option<&RunSummary> {
        self.tuned.as_ref().or(self.first.as_ref())
    }

    /// Why the system under test gave no answer any more in a scenario that it has driven.
    pub fn unanswered(&self) -> Option<&Failure> {
        self.failure.as_ref().filter(|_| self.last_run().is_some())
    }

    /// Whether the system under test fails after tuning alone.
    pub fn found_by_tuning(&self) -> bool {
        let fails = |run: &Option<RunSummary>| run.as_ref().is_some_and(|run| run.failed);
        self.first.is_some() && !fails(&self.first) && fails(&self.tuned)
    }

    /// Whether it tells the crash of an `own` record, an `other` one, or an `invented` one.
    fn is_told(&self, name: &str) -> bool {
        self.origin.as_ref().is_some_and(|origin| origin.name() == name)
    }

    /// Whether the run that tells the record is true to it: the recorded driver's, or the tuned one where there is none; no
    /// answer where it was not run, or nobody's crash is told.
    pub fn faithful(&self) -> Option<Answer> {
        self.recorded.as_ref().or(self.tuned.as_ref()).filter(|_| !self.is_told("invented"))?.faithful
    }

    /// Of a case.
    pub(super) fn of(case: &Case) -> Self {
        let id = &case.cluster.scenario_id;
        let design = |log: &DesignLog| {
            let outcome = log.outcome();
            let why = (outcome == FALLBACK).then(|| log.gave_up.join("; "));
            RoleSummary { outcome: outcome.to_owned(), why }
        };
        Self {
            id: id.clone(),
            template: case.cluster.template,
            narrated: case.narrative.as_ref().map(|(_, log)| agent(log)),
            designed: case.design.as_ref().map(design),
            tuned_by: case.tuned.as_ref().map(|tuned| agent(&tuned.agent)),
            origin: case.narrative.as_ref().map(|(narrative, _)| narrative.origin.clone()),
            told: case.narrative.as_ref().and_then(|(narrative, _)| narrative.told_record().cloned()),
            edited: case.edited.clone(),
            crash_type: case.account.as_ref().map(|account| account.crash_type),
            recorded: case.recorded.as_ref().map(|ran| RunSummary::new(&ran.run)),
            reviewed: case.review.as_ref().map(|reviewed| agent(&reviewed.agent)),
            review: case.review.as_ref().and_then(|reviewed| reviewed.review.clone()),
            changed: case.design.as_ref().and_then(DesignLog::change),
            signs: case.recorded.as_ref().is_some_and(|ran| !ran.scenario.draft().control.is_empty()),
            situation_met: case
                .tuned
                .as_ref()
                .map(|tuned| &tuned.ran)
                .or(case.first.as_ref())
                .and_then(|ran| ran.run.situation_met()),
            first: case.first.as_ref().map(|ran| RunSummary::new(&ran.run)),
            tuned: case.tuned.as_ref().map(|tuned| RunSummary::new(&tuned.ran.run)),
            triage: case.triage.clone(),
            failure: case.failure.clone(),
            points: case.tuned.as_ref().map_or(0, |tuned| tuned.log.points.len()),
            unrepeated: case.first.as_ref().zip(case.tuned.as_ref()).is_some_and(|(first, tuned)| {
                let (before, after) = (&first.run.rollout, &tuned.ran.run.rollout);
                first.scenario.draft() == tuned.ran.scenario.draft() && before.state_hash != after.state_hash
            }),
        }
    }
}

/// Puts a run in numbers.
pub(super) fn summarise(suite: &Suite, cases: &Cases, summaries: Vec<CaseSummary>, simulator: String) -> Summary {
    let (records, selection) = (&cases.records, &cases.selection);
    Summary {
        format: "recrash.summary/2".into(),
        command: suite.options().command(),
        sample: suite.options().records == RecordSource::Sample,
        profile: suite.profile().name.clone(),
        ego: suite.ego().to_owned(),
        simulator,
        rows: records.files.iter().map(|file| file.rows).sum(),
        funnel: records.funnel.clone(),
        usable: records.usable.len(),
        strategy: selection.strategy,
        embedding: selection.embedding.clone(),
        tables: selection.tables.clone(),
        templates: selection.templates.clone(),
        coverage: selection.coverage.clone(),
        models: models(&suite.options().cast, &summaries, cases),
        accounts: cases.accounts.as_ref().map(AccountSummary::of),
        corpus: cases.accounts.as_ref().map(|accounts| corpus(accounts, &summaries)),
        cases: summaries,
    }
}

/// What of all readable incidents these cases cover.
fn corpus(accounts: &AccountSet, cases: &[CaseSummary]) -> CorpusCoverage {
    let told = |case: &CaseSummary| case.recorded.as_ref().is_some_and(|run| run.faithful != Some(Answer::No));
    let scenarios: BTreeMap<&RecordRef, Tested> = cases
        .iter()
        .filter(|case| told(case))
        .filter_map(|case| {
            let failed = case.last_run().is_some_and(|run| run.failed);
            Some((case.told.as_ref()?, Tested { met: case.situation_met == Some(true), failed, signs: case.signs }))
        })
        .collect();
    let incident = |account, tellable| Incident { account, tellable, scenario: None };
    let told = accounts
        .told
        .iter()
        .map(|account| Incident { scenario: scenarios.get(&account.report).copied(), ..incident(account, true) });
    let untold = accounts.untold.iter().map(|untold| incident(&untold.account, false));
    coverage(&told.chain(untold).collect::<Vec<_>>())
}

fn agent(log: &AgentLog) -> RoleSummary {
    RoleSummary { outcome: log.outcome().to_owned(), why: log.fallback.clone() }
}

/// How the models of a cast did. In a suite that goes by accounts the reading, and the staging of what the rules do not show as told, are
/// done before there are cases.
fn models(cast: &Cast, summaries: &[CaseSummary], cases: &Cases) -> Vec<ModelSummary> {
    type Played = Vec<(String, RoleSummary)>;
    let of_cases = |told: fn(&CaseSummary) -> Option<&RoleSummary>| -> Played {
        summaries.iter().filter_map(|case| Some((case.id.clone(), told(case)?.clone()))).collect()
    };
    let read = match cases.readers.is_empty() {
        true => of_cases(|case| case.narrated.as_ref()),
        false => cases.readers.iter().map(|(incident, log)| (incident.clone(), agent(log))).collect(),
    };
    let untold = cases.stagings.iter().filter(|(_, log)| !log.gave_up.is_empty()).map(|(incident, log)| {
        let why = Some(format!("its crash stays untold: {}", log.gave_up.join("; ")));
        (incident.clone(), RoleSummary { outcome: FALLBACK.to_owned(), why })
    });
    let designed = of_cases(|case| case.designed.as_ref()).into_iter().chain(untold).collect();
    let reviewer = cast.review.clone().unwrap_or_else(|| RULES.to_owned());
    let roles = [
        ("paraphrase", &cast.paraphrase, read),
        ("design", &cast.design, designed),
        ("tune", &cast.tune, of_cases(|case| case.tuned_by.as_ref())),
        (Role::Review.name(), &reviewer, of_cases(|case| case.reviewed.as_ref())),
    ];
    let of_model = |(role, model, played): (&str, &String, Played)| {
        let count = |word: &str| played.iter().filter(|(_, is)| is.outcome == word).count();
        let taken_over = played.iter().filter(|(_, is)| is.outcome == FALLBACK);
        let reason = |(id, is): &(String, RoleSummary)| FallbackReason {
            id: id.clone(),
            why: is.why.clone().unwrap_or_default(),
        };
        ModelSummary {
            role: role.to_owned(),
            model: model.clone(),
            first_answer: count("first answer"),
            after_repair: count("after repair"),
            fallback: count(FALLBACK),
            not_asked: count("not asked"),
            reasons: taken_over.map(reason).collect(),
        }
    };
    roles.into_iter().filter(|(_, model, _)| *model != RULES).map(of_model).collect()
}
