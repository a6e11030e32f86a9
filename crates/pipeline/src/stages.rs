//! The stages: what each reads, does and writes.

use crate::agents::{self, AgentLog, RULES};
use crate::casework::{CaseRun, DesignLog, Designer, MAX_DESIGNS, design_case, read_scenario, run_scenario};
use crate::error::PipelineError;
use crate::progress::{Progress, ProgressEvent};
use crate::recording::RecordInput;
use crate::scoring::Scoring;
use crate::store::{to_compact_json, to_json};
use crate::suite::{Files, Stage, Suite};
use crate::{embedding, summary, view};
use rayon::prelude::*;
use recrash_agents::llm::{TuneBrief, prompts_version};
use recrash_agents::{Brief, Rules, expectation, parameters};
use recrash_model::metrics::Expectation;
use recrash_model::narrative::Narrative;
use recrash_model::record::{CrashRecord, RecordSet};
use recrash_model::scenario::ScenarioDraft;
use recrash_model::selection::{Cluster, Selection};
use recrash_model::tuning::{TuneLog, TunePoint};
use recrash_model::{Diagnostic, Outcome, Seed};
use recrash_search::{Task, TuneOptions};
use recrash_select::SelectOptions;
use std::cell::Cell;

/// Files and folders of a suite.
pub mod names {
    /// Records.
    pub const RECORDS: &str = "1-records.json";
    /// Remarks on the records.
    pub const RECORD_REMARKS: &str = "1-records.diagnostics.json";
    /// Selection.
    pub const SELECTION: &str = "2-selection.json";
    /// The page.
    pub const REPORT: &str = "report.html";
    /// For continuous integration.
    pub const JUNIT: &str = "junit.xml";
    /// One line per scenario.
    pub const RESULTS: &str = "results.csv";
    /// Everything a person is told at the end.
    pub const SUMMARY: &str = "summary.json";

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
        Stage::Select => select(&work),
        Stage::Narrate => narrate(&work),
        Stage::Design => design(&work),
        Stage::Simulate => simulate(&work),
        Stage::Tune => tune(&work),
        Stage::Report => report(&work),
    }
}

struct StageWork<'a> {
    suite: &'a Suite,
    stage: Stage,
    progress: &'a dyn Progress,
}

impl StageWork<'_> {
    /// A stage of one unit.
    fn whole(
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

    /// A stage of one unit per cluster, in parallel. `inputs` gives the hashes of what goes into a unit.
    fn per_case(
        &self,
        selection: &Selection,
        inputs: impl Fn(&Cluster) -> Result<Vec<String>, PipelineError> + Sync,
        work: impl Fn(&Cluster) -> Result<Files, PipelineError> + Sync,
    ) -> Result<StageReport, PipelineError> {
        let stage = self.stage.name();
        let unit_name = |cluster: &Cluster| format!("{stage}/{}", cluster.scenario_id);
        let names: Vec<String> = selection.clusters.iter().map(unit_name).collect();
        self.suite.keep_only(self.stage, &names)?;
        self.progress.event(ProgressEvent::Started { stage, units: names.len() });
        let results: Vec<Result<bool, PipelineError>> = selection
            .clusters
            .par_iter()
            .map(|cluster| {
                let inputs = inputs(cluster)?;
                let inputs: Vec<&[u8]> = inputs.iter().map(String::as_bytes).collect();
                let skipped = self.suite.unit(&unit_name(cluster), &inputs, || work(cluster))?;
                self.progress.event(ProgressEvent::Advanced { stage, unit: &cluster.scenario_id, skipped });
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
        Ok(StageReport { done: skipped.len() - there, skipped: there, diagnostics: Vec::new() })
    }

    /// Names of the simulator and the ego: what goes into the hash of everything that is run.
    fn system(&self) -> String {
        format!("{} {}", self.suite.options().simulator.name(), self.suite.ego())
    }

    /// Who plays a role, and with which prompts: what goes into the hash of everything that is written in it.
    fn player(&self, name: &str) -> String {
        match name {
            RULES => RULES.to_owned(),
            model => format!("{model} {} {}", self.suite.options().cast.repairs, prompts_version()),
        }
    }

    fn profile_json(&self) -> String {
        String::from_utf8(to_json(self.suite.profile())).unwrap_or_default()
    }
}

fn records(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let input = RecordInput::read(suite.options())?;
    let profile = work.profile_json();
    let mut inputs = vec![profile.as_bytes()];
    inputs.extend(input.parts());
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

fn select(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let options = suite.options();
    let records_hash = suite.output_hash(Stage::Records, Stage::Records.name(), names::RECORDS)?;
    let profile = work.profile_json();
    let choice = format!("{:?} {} {}", options.strategy, options.budget, options.seed);
    let model = options.model_dir.as_deref().map(embedding::load).transpose()?;
    let fingerprint = model.as_ref().map_or("lexical", |model| model.fingerprint());
    let inputs = [records_hash.as_bytes(), profile.as_bytes(), choice.as_bytes(), fingerprint.as_bytes()];
    work.whole(&inputs, || {
        let records: RecordSet = suite.store().read_json(names::RECORDS)?;
        let select_options = SelectOptions {
            strategy: options.strategy,
            budget: options.budget,
            seed: suite.seed().child("select"),
            ..SelectOptions::default()
        };
        let outcome = match &model {
            None => recrash_select::select(&records, suite.profile(), &select_options),
            Some(model) => embedding::embed(model, &records).and_then(|embedding| {
                recrash_select::select_with(&records, suite.profile(), &select_options, &embedding)
            }),
        }
        .map_err(|e| PipelineError::bad_input(e.to_string()))?;
        Ok(vec![(names::SELECTION.into(), to_json(&outcome.value))])
    })
}

/// What the stages after selection share.
struct Cases {
    records: RecordSet,
    selection: Selection,
    records_hash: String,
}

impl Cases {
    fn read(suite: &Suite) -> Result<Self, PipelineError> {
        let records_hash = suite.output_hash(Stage::Records, Stage::Records.name(), names::RECORDS)?;
        suite.output_hash(Stage::Select, Stage::Select.name(), names::SELECTION)?;
        let records: RecordSet = suite.store().read_json(names::RECORDS)?;
        let selection: Selection = suite.store().read_json(names::SELECTION)?;
        let bound = records.records.len();
        if selection.clusters.iter().any(|c| c.pick_index >= bound || c.members.iter().any(|&m| m >= bound)) {
            return Err(PipelineError::Damaged {
                path: suite.store().path(names::SELECTION),
                problem: "it names records that are not there".into(),
            });
        }
        Ok(Self { records, selection, records_hash })
    }

    /// The pick first, then a few members of its cluster.
    fn records_of(&self, cluster: &Cluster) -> Vec<&CrashRecord> {
        let others = cluster.members.iter().filter(|&&m| m != cluster.pick_index).take(MEMBERS_SHOWN);
        std::iter::once(&cluster.pick_index).chain(others).map(|&index| &self.records.records[index]).collect()
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
    let inputs = |cluster: &Cluster| {
        let mut inputs = cases.inputs(cluster);
        let player = work.player(&suite.options().cast.paraphrase);
        inputs.extend([work.profile_json(), suite.options().seed.to_string(), player]);
        Ok(inputs)
    };
    work.per_case(&cases.selection, inputs, |cluster| {
        let records = cases.records_of(cluster);
        let brief = brief(suite, cluster, &records);
        let (narrative, log) = agents::paraphrase(suite.models(), &suite.options().cast, &brief)?;
        let id = &cluster.scenario_id;
        Ok(vec![(names::narrative(id), to_json(&narrative)), (names::narrative_log(id), to_json(&log))])
    })
}

fn brief<'a>(suite: &'a Suite, cluster: &'a Cluster, records: &'a [&'a CrashRecord]) -> Brief<'a> {
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
    let inputs = |cluster: &Cluster| {
        let mut inputs = cases.inputs(cluster);
        inputs.push(case_hash(suite, Stage::Narrate, cluster, &names::narrative(&cluster.scenario_id))?);
        let player = work.player(&suite.options().cast.design);
        inputs.extend([work.profile_json(), work.system(), suite.options().seed.to_string(), player]);
        Ok(inputs)
    };
    work.per_case(&cases.selection, inputs, |cluster| {
        let records = cases.records_of(cluster);
        let brief = brief(suite, cluster, &records);
        let (narrative, expectation) = case_expectation(suite, &cases, cluster)?;
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

/// Reads and checks a scenario file of the suite.
fn scenario(suite: &Suite, name: &str) -> Result<recrash_roads::Scenario, PipelineError> {
    read_scenario(&suite.store().path(name)).map(|(scenario, _)| scenario)
}

fn simulate(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let cases = Cases::read(suite)?;
    let simulator = suite.simulator()?;
    let inputs = |cluster: &Cluster| {
        let id = &cluster.scenario_id;
        let mut inputs = cases.inputs(cluster);
        inputs.push(case_hash(suite, Stage::Narrate, cluster, &names::narrative(id))?);
        inputs.push(case_hash(suite, Stage::Design, cluster, &names::scenario(id))?);
        inputs.extend([work.profile_json(), work.system()]);
        Ok(inputs)
    };
    work.per_case(&cases.selection, inputs, |cluster| {
        let id = &cluster.scenario_id;
        let (_, expectation) = case_expectation(suite, &cases, cluster)?;
        let checked = scenario(suite, &names::scenario(id))?;
        let run = run_scenario(&checked, &simulator, suite.profile(), Some(&expectation))?;
        Ok(vec![(names::first_run(id), to_compact_json(&run))])
    })
}

fn tune(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let cases = Cases::read(suite)?;
    let simulator = suite.simulator()?;
    let options = TuneOptions {
        searcher: suite.options().searcher.parse().map_err(|e: String| PipelineError::bad_input(e))?,
        budget: suite.options().tune_budget,
    };
    let inputs = |cluster: &Cluster| {
        let id = &cluster.scenario_id;
        let mut inputs = cases.inputs(cluster);
        inputs.push(case_hash(suite, Stage::Narrate, cluster, &names::narrative(id))?);
        inputs.push(case_hash(suite, Stage::Design, cluster, &names::scenario(id))?);
        inputs.push(case_hash(suite, Stage::Simulate, cluster, &names::first_run(id))?);
        let chosen = suite.options();
        inputs.extend([work.profile_json(), work.system(), format!("{options:?}"), chosen.seed.to_string()]);
        inputs.push(format!("{} {}", work.player(&chosen.cast.tune), chosen.cast.rounds));
        Ok(inputs)
    };
    work.per_case(&cases.selection, inputs, |cluster| {
        let id = &cluster.scenario_id;
        let (narrative, expectation) = case_expectation(suite, &cases, cluster)?;
        let draft = scenario(suite, &names::scenario(id))?.draft().clone();
        let first: CaseRun = suite.store().read_json(&names::first_run(id))?;
        let parameters = parameters(&draft, &narrative, suite.profile());
        let scoring = Scoring::new(&draft, &parameters, &expectation, suite.profile(), &simulator, &first);
        // A faithful contact as designed is what the search looks for, at no distance from the record.
        let enough =
            |point: &TunePoint| point.number == 0 && point.score.refused.is_empty() && first.metrics.contact.is_some();
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
        Ok(vec![
            (names::tuned(id), to_json(&tuned)),
            (names::tune_log(id), to_compact_json(&log)),
            (names::tune_agent(id), to_json(&agent)),
            (names::tuned_run(id), to_compact_json(&run)),
        ])
    })
}

/// One case with everything that was made of it.
pub struct Case<'a> {
    /// Cluster and pick.
    pub cluster: &'a Cluster,
    /// The pick first, then a few members of its cluster.
    pub records: Vec<&'a CrashRecord>,
    /// Narrative.
    pub narrative: Narrative,
    /// Who wrote it.
    pub narrative_log: AgentLog,
    /// How the scenario was designed.
    pub design_log: DesignLog,
    /// Scenario as designed.
    pub scenario: recrash_roads::Scenario,
    /// First run.
    pub first: CaseRun,
    /// Tuned scenario.
    pub tuned: recrash_roads::Scenario,
    /// Run of the tuned scenario.
    pub tuned_run: CaseRun,
    /// Log of the search.
    pub tune_log: TuneLog,
    /// Who tuned it.
    pub tune_agent: AgentLog,
}

fn report(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let cases = Cases::read(suite)?;
    let mut inputs = vec![cases.records_hash.clone(), work.profile_json(), suite.options().command()];
    inputs.push(suite.output_hash(Stage::Select, Stage::Select.name(), names::SELECTION)?);
    for cluster in &cases.selection.clusters {
        let id = &cluster.scenario_id;
        for file in [names::narrative(id), names::narrative_log(id)] {
            inputs.push(case_hash(suite, Stage::Narrate, cluster, &file)?);
        }
        for file in [names::scenario(id), names::design_log(id)] {
            inputs.push(case_hash(suite, Stage::Design, cluster, &file)?);
        }
        inputs.push(case_hash(suite, Stage::Simulate, cluster, &names::first_run(id))?);
        for file in [names::tuned(id), names::tune_log(id), names::tune_agent(id), names::tuned_run(id)] {
            inputs.push(case_hash(suite, Stage::Tune, cluster, &file)?);
        }
    }
    let inputs: Vec<&[u8]> = inputs.iter().map(String::as_bytes).collect();
    work.whole(&inputs, || {
        let read = |cluster| -> Result<Case, PipelineError> { read_case(suite, &cases, cluster) };
        let all: Vec<Case> = cases.selection.clusters.iter().map(read).collect::<Result<_, _>>()?;
        let summary = summary::summarise(suite, &cases.records, &cases.selection, &all);
        let view = view::view(suite, &cases.records, &cases.selection, &all);
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
    Ok(Case {
        cluster,
        records: cases.records_of(cluster),
        narrative: store.read_json(&names::narrative(id))?,
        narrative_log: store.read_json(&names::narrative_log(id))?,
        design_log: store.read_json(&names::design_log(id))?,
        scenario: scenario(suite, &names::scenario(id))?,
        first: store.read_json(&names::first_run(id))?,
        tuned: scenario(suite, &names::tuned(id))?,
        tuned_run: store.read_json(&names::tuned_run(id))?,
        tune_log: store.read_json(&names::tune_log(id))?,
        tune_agent: store.read_json(&names::tune_agent(id))?,
    })
}
