//! The stages: what each reads, does and writes.

use crate::agents::{self, AgentLog, RULES};
use crate::casework::{DesignLog, Designer, MAX_DESIGNS, design_case, read_scenario, run_scenario};
use crate::error::PipelineError;
use crate::failures::Failure;
use crate::progress::{Progress, ProgressEvent};
use crate::recording::RecordInput;
use crate::scoring::{Scoring, is_sound_contact};
use crate::store::{to_compact_json, to_json};
use crate::suite::{Files, Stage, Suite};
use crate::triage::triage;
use crate::{failures, selecting, summary, view};
use rayon::prelude::*;
use recrash_agents::llm::{TuneBrief, prompts_version};
use recrash_agents::{Brief, Rules, expectation, narrative_contradictions, parameters};
use recrash_model::metrics::Expectation;
use recrash_model::narrative::Narrative;
use recrash_model::record::{CrashRecord, RecordSet};
use recrash_model::run::JudgedRun;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::selection::{Cluster, Selection};
use recrash_model::triage::{TRIAGE_FORMAT, Triage};
use recrash_model::tuning::{TuneLog, TunePoint};
use recrash_model::{Diagnostic, Outcome, Seed};
use recrash_search::{Task, TuneOptions};
use serde::de::DeserializeOwned;
use std::cell::Cell;

/// Files and folders of a suite.
pub mod names {
    use crate::suite::Stage;

    /// Records.
    pub const RECORDS: &str = "1-records.json";
    /// Remarks on the records.
    pub const RECORD_REMARKS: &str = "1-records.diagnostics.json";
    /// Selection.
    pub const SELECTION: &str = "2-selection.json";
    /// Remarks on the selection.
    pub const SELECTION_REMARKS: &str = "2-selection.diagnostics.json";
    /// How the selection depends on seed, strategy and budget.
    pub const SELECTION_STUDY: &str = "2-selection.study.json";
    /// Rows of the embedding model, by content.
    pub const EMBEDDING: &str = "2-embedding.json";
    /// The page.
    pub const REPORT: &str = "report.html";
    /// For continuous integration.
    pub const JUNIT: &str = "junit.xml";
    /// One line per scenario.
    pub const RESULTS: &str = "results.csv";
    /// Everything a person is told at the end.
    pub const SUMMARY: &str = "summary.json";

    /// Ending of files that say why a scenario went no further.
    pub const FAILURE: &str = ".failed.json";

    /// Why a scenario went no further than this stage.
    pub fn failure(stage: Stage, id: &str) -> String {
        let folder = match stage {
            Stage::Design => "4-scenarios",
            Stage::Simulate => "5-rollouts",
            Stage::Tune => "6-tuned",
            _ => "3-narratives",
        };
        format!("{folder}/{id}{FAILURE}")
    }
    /// Narrative of a scenario.
    pub fn narrative(id: &str) -> String {
        format!("3-narratives/{id}.json")
    }
    /// Scenario as designed.
    pub fn scenario(id: &str) -> String {
        format!("4-scenarios/{id}.json")
    }
    /// Who wrote the narrative.
    pub fn narrative_log(id: &str) -> String {
        format!("3-narratives/{id}.agent.json")
    }
    /// How it was designed.
    pub fn design_log(id: &str) -> String {
        format!("4-scenarios/{id}.design.json")
    }
    /// First run.
    pub fn first_run(id: &str) -> String {
        format!("5-rollouts/{id}.json")
    }
    /// Tuned scenario.
    pub fn tuned(id: &str) -> String {
        format!("6-tuned/{id}.json")
    }
    /// Log of the search.
    pub fn tune_log(id: &str) -> String {
        format!("6-tuned/{id}.search.json")
    }
    /// Who tuned it.
    pub fn tune_agent(id: &str) -> String {
        format!("6-tuned/{id}.agent.json")
    }
    /// How the other egos fare in the tuned scenario, where the system under test fails.
    pub fn triage(id: &str) -> String {
        format!("6-tuned/{id}.triage.json")
    }
    /// Run of the reference driver in it.
    pub fn reference_run(id: &str) -> String {
        format!("6-tuned/{id}.reference.json")
    }
    /// Run of the tuned scenario.
    pub fn tuned_run(id: &str) -> String {
        format!("6-tuned/{id}.run.json")
    }
}

/// Members of a cluster that the agents see beside the pick.
const MEMBERS_SHOWN: usize = 4;

/// What a stage did.
#[derive(Debug, Clone, PartialEq)]
pub struct StageReport {
    /// Units that were done.
    pub done: usize,
    /// Units that were there already.
    pub skipped: usize,
    /// Remarks worth showing.
    pub diagnostics: Vec<Diagnostic>,
}

/// Runs one stage.
pub fn run(suite: &Suite, stage: Stage, progress: &dyn Progress) -> Result<StageReport, PipelineError> {
    let work = StageWork { suite, stage, progress };
    match stage {
        Stage::Records => records(&work),
        Stage::Select => selecting::run(&work),
        Stage::Narrate => narrate(&work),
        Stage::Design => design(&work),
        Stage::Simulate => simulate(&work),
        Stage::Tune => tune(&work),
        Stage::Report => report(&work),
    }
}

/// A stage at work.
pub struct StageWork<'a> {
    /// Where.
    pub suite: &'a Suite,
    stage: Stage,
    progress: &'a dyn Progress,
}

impl StageWork<'_> {
    /// A stage of one unit.
    pub(crate) fn whole(
        &self,
        inputs: &[&[u8]],
        work: impl FnOnce() -> Result<Files, PipelineError>,
    ) -> Result<StageReport, PipelineError> {
        let stage = self.stage.name();
        self.progress.event(ProgressEvent::Started { stage, units: 1 });
        let skipped = self.suite.unit(stage, inputs, work)?;
        self.progress.event(ProgressEvent::Advanced { stage, unit: stage, skipped });
        self.progress.event(ProgressEvent::Finished { stage });
        Ok(StageReport { done: usize::from(!skipped), skipped: usize::from(skipped), diagnostics: Vec::new() })
    }

    /// A stage of one unit per cluster, in parallel, without those that failed before.
    fn per_case(
        &self,
        cases: &Cases,
        work: impl Fn(&Cluster) -> Result<Files, PipelineError> + Sync,
    ) -> Result<StageReport, PipelineError> {
        let stage = self.stage.name();
        let clusters = cases.up_to(self.suite, self.stage);
        let names: Vec<String> = clusters.iter().map(|cluster| unit_name(self.stage, cluster)).collect();
        self.suite.keep_only(self.stage, &names)?;
        self.progress.event(ProgressEvent::Started { stage, units: names.len() });
        let results: Vec<Result<bool, PipelineError>> = clusters
            .par_iter()
            .map(|&cluster| {
                let inputs = case_inputs(self.suite, self.stage, cases, cluster)?;
                let inputs: Vec<&[u8]> = inputs.iter().map(String::as_bytes).collect();
                let id = &cluster.scenario_id;
                let work = || failures::keep(self.stage, id, work(cluster));
                let skipped = self.suite.unit(&unit_name(self.stage, cluster), &inputs, work)?;
                self.progress.event(ProgressEvent::Advanced { stage, unit: id, skipped });
                Ok(skipped)
            })
            .collect();
        let waits = |result: &Result<bool, PipelineError>| matches!(result, Err(PipelineError::AnswerPending));
        let waiting = results.iter().any(waits);
        let skipped = results.into_iter().filter(|r| !waits(r)).collect::<Result<Vec<bool>, _>>()?;
        if let (true, Some(models)) = (waiting, self.suite.models()) {
            let (requests, count) = models.write_requests()?;
            return Err(PipelineError::WaitingForBatch { requests, count });
        }
        self.progress.event(ProgressEvent::Finished { stage });
        let there = skipped.iter().filter(|&&s| s).count();
        let failed = |cluster: &&Cluster| {
            let id = &cluster.scenario_id;
            failures::at(self.suite, id, self.stage).map(|failure| failures::remark(id, &failure))
        };
        let diagnostics = clusters.iter().filter_map(failed).collect();
        Ok(StageReport { done: skipped.len() - there, skipped: there, diagnostics })
    }
}

/// Name of a unit of a stage that works scenario by scenario.
fn unit_name(stage: Stage, cluster: &Cluster) -> String {
    format!("{}/{}", stage.name(), cluster.scenario_id)
}

fn profile_json(suite: &Suite) -> String {
    String::from_utf8(to_json(suite.profile())).unwrap_or_default()
}

/// Everything that decides what a stage makes of a scenario, as hashes and words.
fn case_inputs(suite: &Suite, stage: Stage, cases: &Cases, cluster: &Cluster) -> Result<Vec<String>, PipelineError> {
    let (id, chosen) = (&cluster.scenario_id, suite.options());
    let before = [
        (Stage::Narrate, names::narrative(id)),
        (Stage::Design, names::scenario(id)),
        (Stage::Simulate, names::first_run(id)),
    ];
    let mut inputs = cases.inputs(cluster);
    for (earlier, file) in before.iter().filter(|(earlier, _)| *earlier < stage) {
        inputs.push(case_hash(suite, *earlier, cluster, file)?);
    }
    inputs.push(profile_json(suite));
    if stage > Stage::Narrate {
        inputs.push(format!("{} {}", chosen.simulator.name(), suite.ego()));
    }
    // Who plays a role, and with which prompts.
    let player = |name: &str| match name {
        RULES => RULES.to_owned(),
        model => format!("{model} {} {}", chosen.cast.repairs, prompts_version()),
    };
    match stage {
        Stage::Narrate => inputs.extend([chosen.seed.to_string(), player(&chosen.cast.paraphrase)]),
        Stage::Design => inputs.extend([chosen.seed.to_string(), player(&chosen.cast.design)]),
        Stage::Tune => inputs.extend([
            format!("{:?}", tune_options(suite)?),
            chosen.seed.to_string(),
            format!("{} {}", player(&chosen.cast.tune), chosen.cast.rounds),
            TRIAGE_FORMAT.to_owned(),
        ]),
        Stage::Records | Stage::Select | Stage::Simulate | Stage::Report => {}
    }
    Ok(inputs)
}

fn records(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let input = RecordInput::read(suite.options())?;
    let inputs = record_inputs(suite, &input);
    let inputs: Vec<&[u8]> = inputs.iter().map(String::as_bytes).collect();
    let mut report = work.whole(&inputs, || {
        let Outcome { value, diagnostics } = input.ingest(suite.profile())?;
        Ok(vec![
            (names::RECORDS.into(), to_compact_json(&value)),
            (names::RECORD_REMARKS.into(), to_json(&diagnostics)),
        ])
    })?;
    report.diagnostics = suite.store().read_json(names::RECORD_REMARKS)?;
    Ok(report)
}

fn record_inputs(suite: &Suite, input: &RecordInput) -> Vec<String> {
    std::iter::once(profile_json(suite)).chain(input.parts()).collect()
}

/// What the stages after selection share.
pub(crate) struct Cases {
    /// All records.
    pub records: RecordSet,
    /// Which were picked.
    pub selection: Selection,
    records_hash: String,
}

impl Cases {
    pub fn read(suite: &Suite) -> Result<Self, PipelineError> {
        let records_hash = suite.output_hash(Stage::Records, Stage::Records.name(), names::RECORDS)?;
        suite.output_hash(Stage::Select, Stage::Select.name(), names::SELECTION)?;
        let records: RecordSet = suite.store().read_json(names::RECORDS)?;
        let selection: Selection = suite.store().read_json(names::SELECTION)?;
        let bound = records.records.len();
        let named = |c: &Cluster| c.pick_index < bound && records.records[c.pick_index].id == c.pick;
        if selection.clusters.iter().any(|c| !named(c) || c.members.iter().any(|&m| m >= bound)) {
            return Err(suite.stale(Stage::Select));
        }
        Ok(Self { records, selection, records_hash })
    }

    /// The pick first, then a few members of its cluster.
    pub fn records_of(&self, cluster: &Cluster) -> Vec<&CrashRecord> {
        let others = cluster.members.iter().filter(|&&m| m != cluster.pick_index).take(MEMBERS_SHOWN);
        std::iter::once(&cluster.pick_index).chain(others).map(|&index| &self.records.records[index]).collect()
    }

    /// The clusters that no stage before this one failed on.
    fn up_to(&self, suite: &Suite, stage: Stage) -> Vec<&Cluster> {
        let whole = |cluster: &&Cluster| failures::before(suite, &cluster.scenario_id, stage).is_none();
        self.selection.clusters.iter().filter(whole).collect()
    }

    /// Hashes that say which records a cluster stands for.
    fn inputs(&self, cluster: &Cluster) -> Vec<String> {
        let cluster = String::from_utf8(to_json(cluster)).unwrap_or_default();
        vec![self.records_hash.clone(), cluster]
    }
}

fn case_seed(suite: &Suite, cluster: &Cluster) -> Seed {
    suite.seed().child("case").child(&cluster.scenario_id)
}

fn narrate(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let cases = Cases::read(suite)?;
    work.per_case(&cases, |cluster| {
        let records = cases.records_of(cluster);
        let brief = brief(suite, cluster, &records);
        let (narrative, log) = agents::paraphrase(suite.models(), &suite.options().cast, &brief)?;
        let id = &cluster.scenario_id;
        Ok(vec![(names::narrative(id), to_json(&narrative)), (names::narrative_log(id), to_json(&log))])
    })
}

/// What an agent is told about a case.
pub(crate) fn brief<'a>(suite: &'a Suite, cluster: &'a Cluster, records: &'a [&'a CrashRecord]) -> Brief<'a> {
    Brief {
        scenario_id: &cluster.scenario_id,
        template: cluster.template,
        records,
        profile: suite.profile(),
        seed: case_seed(suite, cluster),
    }
}

/// Hash of a file that a unit of an earlier stage wrote for a cluster.
fn case_hash(suite: &Suite, stage: Stage, cluster: &Cluster, file: &str) -> Result<String, PipelineError> {
    suite.output_hash(stage, &format!("{}/{}", stage.name(), cluster.scenario_id), file)
}

fn case_expectation(
    suite: &Suite,
    cases: &Cases,
    cluster: &Cluster,
) -> Result<(Narrative, Expectation), PipelineError> {
    let narrative: Narrative = suite.store().read_json(&names::narrative(&cluster.scenario_id))?;
    let expectation = expectation(&narrative, &cases.records.records[cluster.pick_index], suite.profile());
    Ok((narrative, expectation))
}

fn design(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let cases = Cases::read(suite)?;
    let simulator = suite.simulator()?;
    work.per_case(&cases, |cluster| {
        let records = cases.records_of(cluster);
        let brief = brief(suite, cluster, &records);
        let (narrative, expectation) = case_expectation(suite, &cases, cluster)?;
        refuse_contradictions(&narrative, &brief)?;
        let cast = &suite.options().cast;
        let (name, repairs) = (&cast.design, Cell::new(0));
        let model = suite.models().filter(|_| name != RULES).map(|models| models.model(name, cast, &repairs));
        let by_model = model.as_ref().map(|agent| Designer { name, agent, tries: cast.repairs + 1 });
        let by_rules = Designer { name: RULES, agent: &Rules, tries: MAX_DESIGNS };
        let designers: Vec<Designer> = by_model.into_iter().chain([by_rules]).collect();
        let (draft, log): (ScenarioDraft, DesignLog) =
            design_case(&designers, &brief, &narrative, &expectation, &simulator)?;
        let log = DesignLog { repairs: repairs.get(), ..log };
        let id = &cluster.scenario_id;
        Ok(vec![(names::scenario(id), to_json(&draft)), (names::design_log(id), to_json(&log))])
    })
}

/// Nothing runs for a narrative that contradicts its template: agents mend theirs, so that such a one was edited by hand.
fn refuse_contradictions(narrative: &Narrative, brief: &Brief) -> Result<(), PipelineError> {
    let contradictions = narrative_contradictions(&narrative.facts, brief.template, brief.profile);
    if contradictions.is_empty() {
        return Ok(());
    }
    let why = contradictions.join("; ");
    Err(PipelineError::scenario(
        brief.scenario_id,
        format!("the narrative contradicts its template ({why}); mend it, or remove its file"),
    ))
}

/// Reads and checks a scenario file of the suite.
fn scenario(suite: &Suite, name: &str) -> Result<recrash_roads::Scenario, PipelineError> {
    read_scenario(&suite.store().path(name)).map(|(scenario, _)| scenario)
}

fn simulate(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let cases = Cases::read(suite)?;
    let simulator = suite.simulator()?;
    work.per_case(&cases, |cluster| {
        let id = &cluster.scenario_id;
        let (_, expectation) = case_expectation(suite, &cases, cluster)?;
        let checked = scenario(suite, &names::scenario(id))?;
        let run = run_scenario(&checked, &simulator, suite.profile(), Some(&expectation))?;
        Ok(vec![(names::first_run(id), to_compact_json(&run))])
    })
}

fn tune_options(suite: &Suite) -> Result<TuneOptions, PipelineError> {
    let searcher = suite.options().searcher.parse().map_err(|e: String| PipelineError::bad_input(e))?;
    Ok(TuneOptions { searcher, budget: suite.options().tune_budget })
}

fn tune(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let cases = Cases::read(suite)?;
    let simulator = suite.simulator()?;
    let options = tune_options(suite)?;
    work.per_case(&cases, |cluster| {
        let id = &cluster.scenario_id;
        let (narrative, expectation) = case_expectation(suite, &cases, cluster)?;
        let draft = scenario(suite, &names::scenario(id))?.draft().clone();
        let first: JudgedRun = suite.store().read_json(&names::first_run(id))?;
        let parameters = parameters(&draft, &narrative, suite.profile());
        let scoring = Scoring::new(&draft, &parameters, &expectation, suite.profile(), &simulator, &first);
        // A faithful contact as designed is what the search looks for, at no distance from the record.
        let sound = is_sound_contact(&first.rollout);
        let enough = |point: &TunePoint| point.number == 0 && point.score.refused.is_empty() && sound;
        let seed = case_seed(suite, cluster).child("tune");
        let search = || recrash_search::tune(id, &parameters, options, seed, |values| scoring.score(values), enough);
        let cast = &suite.options().cast;
        let (log, agent): (TuneLog, AgentLog) = match suite.models().filter(|_| cast.tune != RULES) {
            None => (search(), AgentLog::rules()),
            Some(models) => {
                let (name, repairs) = (&cast.tune, Cell::new(0));
                let model = models.model(name, cast, &repairs);
                let records = cases.records_of(cluster);
                let brief = brief(suite, cluster, &records);
                let (narrative, draft, metrics) = (&narrative, &draft, &first.metrics);
                let propose = |history: &[TunePoint]| {
                    let told = TuneBrief { narrative, draft, metrics, parameters: &parameters, history };
                    model.propose(&brief, &told).map(|values| (values, "model"))
                };
                let task = Task { scenario_id: id, parameters: &parameters, seed, searcher: name };
                match recrash_search::tune_with(&task, cast.rounds + 1, propose, |v| scoring.score(v), enough) {
                    Ok(log) => {
                        let agent =
                            AgentLog { needless: log.points.len() == 1, ..AgentLog::model(name, repairs.get()) };
                        (log, agent)
                    }
                    Err(error) => {
                        let why = agents::unusable(error)?;
                        (search(), AgentLog::fallback(name, repairs.get(), why))
                    }
                }
            }
        };
        let tuned = recrash_model::tuning::apply(&draft, &parameters, &log.points[log.best].values)
            .map_err(|e| PipelineError::bad_input(format!("tuned {id}: {e}")))?;
        let scenario = recrash_roads::check(tuned.clone()).map_err(|diagnostics| PipelineError::BadInput {
            what: format!("tuned {id} cannot be run"),
            diagnostics,
        })?;
        let run = run_scenario(&scenario.value, &simulator, suite.profile(), Some(&expectation))?;
        let mut files = vec![
            (names::tuned(id), to_json(&tuned)),
            (names::tune_log(id), to_compact_json(&log)),
            (names::tune_agent(id), to_json(&agent)),
            (names::tuned_run(id), to_compact_json(&run)),
        ];
        if run.failed() {
            let (triage, reference) = triage(&scenario.value, suite.ego(), &run.findings, suite.profile())?;
            files.push((names::triage(id), to_json(&triage)));
            files.extend(reference.map(|run| (names::reference_run(id), to_compact_json(&run))));
        }
        Ok(files)
    })
}

/// One case with everything that was made of it, as far as it went.
pub struct Case<'a> {
    /// Cluster and pick.
    pub cluster: &'a Cluster,
    /// The pick first, then a few members of its cluster.
    pub records: Vec<&'a CrashRecord>,
    /// Narrative, and who wrote it.
    pub narrative: Option<(Narrative, AgentLog)>,
    /// How the scenario was designed.
    pub design: Option<DesignLog>,
    /// As designed.
    pub first: Option<Ran>,
    /// As tuned.
    pub tuned: Option<Tuned>,
    /// How the other egos fare where the system under test fails at last.
    pub triage: Option<Triage>,
    /// The reference driver's run there.
    pub reference: Option<JudgedRun>,
    /// Why it went no further, where it did not.
    pub failure: Option<Failure>,
}

/// A scenario and its run.
pub struct Ran {
    /// What was run.
    pub scenario: recrash_roads::Scenario,
    /// What came of it.
    pub run: JudgedRun,
}

/// A tuned scenario.
pub struct Tuned {
    /// It, and its run.
    pub ran: Ran,
    /// Log of the search.
    pub log: TuneLog,
    /// Who tuned it.
    pub agent: AgentLog,
}

/// A report tells of one system and one set of records: what every stage made must be of the options and the files as
/// they are now. Crash files that have gone since are taken as they were.
fn refuse_stale(suite: &Suite, cases: &Cases) -> Result<(), PipelineError> {
    if let Ok(input) = RecordInput::read(suite.options()) {
        suite.must_be_made_of(Stage::Records, Stage::Records.name(), &record_inputs(suite, &input))?;
    }
    for stage in failures::CASE_STAGES {
        for cluster in cases.up_to(suite, stage) {
            let inputs = case_inputs(suite, stage, cases, cluster)?;
            suite.must_be_made_of(stage, &unit_name(stage, cluster), &inputs)?;
        }
    }
    Ok(())
}

fn report(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let cases = Cases::read(suite)?;
    refuse_stale(suite, &cases)?;
    let mut inputs = vec![cases.records_hash.clone(), profile_json(suite), suite.options().command()];
    inputs.push(suite.output_hash(Stage::Select, Stage::Select.name(), names::SELECTION)?);
    for cluster in &cases.selection.clusters {
        let id = &cluster.scenario_id;
        let made = [
            (Stage::Narrate, vec![names::narrative(id), names::narrative_log(id)]),
            (Stage::Design, vec![names::scenario(id), names::design_log(id)]),
            (Stage::Simulate, vec![names::first_run(id)]),
            (Stage::Tune, vec![names::tuned(id), names::tune_log(id), names::tune_agent(id), names::tuned_run(id)]),
        ];
        for (stage, files) in made {
            if let Some(failure) = failures::at(suite, id, stage) {
                inputs.push(failure.to_string());
                break;
            }
            for file in files {
                inputs.push(case_hash(suite, stage, cluster, &file)?);
            }
        }
        for file in [names::triage(id), names::reference_run(id)] {
            inputs.push(suite.store().hash(&file).unwrap_or_default());
        }
    }
    let inputs: Vec<&[u8]> = inputs.iter().map(String::as_bytes).collect();
    work.whole(&inputs, || {
        let read = |cluster| -> Result<Case, PipelineError> { read_case(suite, &cases, cluster) };
        let all: Vec<Case> = cases.selection.clusters.iter().map(read).collect::<Result<_, _>>()?;
        let summary = summary::summarise(suite, &cases.records, &cases.selection, &all);
        let remarks = suite.store().read_json(names::RECORD_REMARKS)?;
        let view = view::view(suite, &cases.records, &cases.selection, &all, remarks);
        Ok(vec![
            (names::SUMMARY.into(), to_json(&summary)),
            (names::REPORT.into(), recrash_report::html(&view).into_bytes()),
            (names::JUNIT.into(), recrash_report::junit(&view).into_bytes()),
            (names::RESULTS.into(), recrash_report::results_csv(&view).into_bytes()),
        ])
    })
}

fn read_case<'a>(suite: &Suite, cases: &'a Cases, cluster: &'a Cluster) -> Result<Case<'a>, PipelineError> {
    let id = &cluster.scenario_id;
    let store = suite.store();
    let failure = failures::before(suite, id, Stage::Report);
    let made = |stage: Stage| failures::before(suite, id, stage).is_none() && failures::at(suite, id, stage).is_none();
    let narrative = made(Stage::Narrate)
        .then(|| Ok((store.read_json(&names::narrative(id))?, store.read_json(&names::narrative_log(id))?)))
        .transpose()?;
    let design = made(Stage::Design).then(|| store.read_json(&names::design_log(id))).transpose()?;
    let first = made(Stage::Simulate).then(|| ran(suite, &names::scenario(id), &names::first_run(id))).transpose()?;
    let tuned = made(Stage::Tune)
        .then(|| {
            let (log, agent) = (store.read_json(&names::tune_log(id))?, store.read_json(&names::tune_agent(id))?);
            Ok(Tuned { ran: ran(suite, &names::tuned(id), &names::tuned_run(id))?, log, agent })
        })
        .transpose()?;
    let triage = optional(suite, &names::triage(id), tuned.is_some())?;
    let reference = optional(suite, &names::reference_run(id), triage.is_some())?;
    let records = cases.records_of(cluster);
    Ok(Case { cluster, records, narrative, design, first, tuned, triage, reference, failure })
}

/// Reads a file that not every unit writes; a stage removes what an earlier run left.
fn optional<T: DeserializeOwned>(suite: &Suite, file: &str, wanted: bool) -> Result<Option<T>, PipelineError> {
    let there = wanted && suite.store().path(file).exists();
    there.then(|| suite.store().read_json(file)).transpose()
}

fn ran(suite: &Suite, file: &str, run: &str) -> Result<Ran, PipelineError> {
    Ok(Ran { scenario: scenario(suite, file)?, run: suite.store().read_json(run)? })
}
