//! The stages of a suite that goes by accounts: each case is the crash of one incident, reconstructed with the recorded
//! driver; the system under test takes over before the contact.

use super::ahead::Ahead;
use super::cases::{case_seed, edited, of_case, scenario, text_of};
use super::design_log::{DesignAttempt, DesignLog};
use super::restage::restaged;
use super::tune::tune_options;
use super::{Bench, CaseStage, player};
use crate::error::PipelineError;
use crate::files::json::{to_compact_json, to_json};
use crate::models::cast::AgentLog;
use crate::reading::retelling::{Staged, what_is_missed};
use crate::simulators::{Simulator, built_in};
use crate::suite::names;
use crate::suite::{Files, Stage, Suite};
use recrash_drivers::preventability;
use recrash_lab::{Scoring, is_sound_contact, judge_by, run_scenario, situation, triage};
use recrash_model::account::{Account, Untold};
use recrash_model::metrics::Verdict;
use recrash_model::run::JudgedRun;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::selection::Cluster;
use recrash_model::triage::TRIAGE_FORMAT;
use recrash_model::tuning::{Aim, Parameter, TunePoint};
use recrash_reconstruct::{Reconstruction, held_against, open_choices, reconstruct, reconstruct_with};
use recrash_roads::{RunError, Scenario};
use recrash_search::Next;
use recrash_sim::{Ego, Native};

/// The stages that make something of a case, in order.
pub(super) const DECLARED: [CaseStage; 5] = [
    CaseStage {
        stage: Stage::Narrate,
        reads: |_| Vec::new(),
        editable: |id| vec![names::account(id)],
        decides: |_| Ok(Vec::new()),
        runs_ego: false,
        work: narrate,
    },
    CaseStage {
        stage: Stage::Design,
        reads: |id| vec![(Stage::Narrate, names::account(id))],
        editable: |id| vec![names::scenario(id)],
        // The seed stands in the scenario's source.
        decides: |suite| Ok(vec![player(suite, &suite.options().cast.design), text_of(&suite.options().seed)]),
        runs_ego: false,
        work: design,
    },
    CaseStage {
        stage: Stage::Simulate,
        reads: |id| vec![(Stage::Narrate, names::account(id)), (Stage::Design, names::scenario(id))],
        editable: |_| Vec::new(),
        decides: |_| Ok(Vec::new()),
        runs_ego: true,
        work: simulate,
    },
    CaseStage {
        stage: Stage::Tune,
        reads: |id| {
            vec![
                (Stage::Narrate, names::account(id)),
                (Stage::Design, names::scenario(id)),
                (Stage::Simulate, names::recorded_run(id)),
            ]
        },
        editable: |id| vec![names::tuned(id)],
        decides: |suite| {
            let chosen = suite.options();
            Ok(vec![format!("{:?}", tune_options(suite)?), text_of(&chosen.aim), text_of(&chosen.seed)])
        },
        runs_ego: true,
        work: tune,
    },
    CaseStage {
        stage: Stage::Triage,
        reads: |id| vec![(Stage::Narrate, names::account(id)), (Stage::Tune, names::tuned(id))],
        editable: |_| Vec::new(),
        decides: |_| Ok(vec![TRIAGE_FORMAT.to_owned()]),
        runs_ego: true,
        work: judge,
    },
];

/// The account of a case, as it stands in its file: a person may have edited it.
pub(super) fn account(suite: &Suite, id: &str) -> Result<Account, PipelineError> {
    suite.store().read_json(&names::account(id)).map_err(|error| of_case(id, edited(error)))
}

fn narrate(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let id = &cluster.scenario_id;
    let account = bench.cases.account(cluster).ok_or_else(|| bench.suite.stale(Stage::Records))?;
    let log = bench.cases.readers.get(&account.incident).cloned().unwrap_or_else(AgentLog::rules);
    Ok(vec![(names::account(id), to_json(account)), (names::narrative_log(id), to_json(&log))])
}

fn design(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let id = &cluster.scenario_id;
    let account = account(bench.suite, id)?;
    if let Some(log) = bench.cases.staged_again(&account) {
        let mut log = log.clone();
        for attempt in &mut log.attempts {
            attempt.draft = named(attempt.draft.clone(), bench, cluster);
        }
        let draft = log.attempts[log.taken].draft.clone();
        return Ok(vec![(names::scenario(id), to_json(&draft)), (names::design_log(id), to_json(&log))]);
    }
    let found = bench.suite.stagings().take(&account);
    let (draft, log) = match found.map_or_else(|| staged(&account), Ok) {
        Ok(staged) => {
            let draft = named(staged.draft, bench, cluster);
            let attempt = DesignAttempt { draft: draft.clone(), diagnostics: Vec::new(), unfaithful: Some(Vec::new()) };
            let log = DesignLog { assumed: staged.assumed, ..DesignLog::by_rules(attempt) };
            restaged(bench, cluster, &account, draft, log)?
        }
        Err(why) => staged_anew(bench, cluster, &account, &why)?,
    };
    Ok(vec![(names::scenario(id), to_json(&draft)), (names::design_log(id), to_json(&log))])
}

/// What a model stages of an account that the rules show otherwise than told: a person edited it.
fn staged_anew(
    bench: &Bench,
    cluster: &Cluster,
    account: &Account,
    why: &str,
) -> Result<(ScenarioDraft, DesignLog), PipelineError> {
    let untold = |more: &str| PipelineError::scenario(&cluster.scenario_id, format!("{why}{more}"));
    let made = bench.suite.options().stager().and_then(|_| reconstruct(account).ok()).ok_or_else(|| untold(""))?;
    let draft = named(made.draft.clone(), bench, cluster);
    let log = DesignLog::begun_with(&Reconstruction { draft: draft.clone(), ..made });
    let (draft, log) = restaged(bench, cluster, account, draft, log)?;
    match log.gave_up.is_empty() {
        true => Ok((draft, log)),
        false => Err(untold(&format!("; {}", log.gave_up.join("; ")))),
    }
}

/// The scenario of an account in which every told fact that can be shown is shown; else why there is none.
fn staged(account: &Account) -> Result<Staged, String> {
    let made = reconstruct(account).map_err(|why| why.label().to_owned())?;
    match made.missed() {
        None => Ok(Staged { draft: made.draft, assumed: made.assumed }),
        Some(missed) => Err(format!("{}: {}", Untold::NotShown.label(), what_is_missed(missed))),
    }
}

/// The same with these values for what the account leaves open.
fn staged_with(account: &Account, open: &[Parameter], values: &[f64]) -> Result<ScenarioDraft, String> {
    let made = reconstruct_with(account, open, values).map_err(|why| why.label().to_owned())?;
    match made.missed() {
        None => Ok(made.draft),
        Some(missed) => {
            Err(format!("not as told: {} is {}, not {}", missed.kind.label(), missed.observed, missed.expected))
        }
    }
}

/// A reconstruction as a case of the suite.
fn named(mut draft: ScenarioDraft, bench: &Bench, cluster: &Cluster) -> ScenarioDraft {
    draft.id.clone_from(&cluster.scenario_id);
    draft.source.template = Some(cluster.template);
    draft.source.seed = case_seed(bench.suite, cluster).0;
    draft
}

/// The recorded driver's run, which is held against the account; and the run of the system under test.
fn simulate(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let (suite, id) = (bench.suite, &cluster.scenario_id);
    let scenario = scenario(suite, id, &names::scenario(id))?;
    let recorded = recorded_run(suite, id, &scenario)?;
    let mut files = vec![(names::recorded_run(id), to_compact_json(&recorded))];
    if scenario.draft().is_tested() {
        let run = tested_run(suite, &scenario, bench.simulator(), &recorded)?;
        files.push((names::first_run(id), to_compact_json(&run)));
    }
    Ok(files)
}

fn recorded_run(suite: &Suite, id: &str, scenario: &Scenario) -> Result<JudgedRun, PipelineError> {
    let rollout = Native::new(Ego::Recorded).run(scenario)?;
    let verdict = held_against(&account(suite, id)?, scenario, &rollout)
        .map_err(|why| PipelineError::scenario(id, format!("the account cannot be staged: {why}")))?;
    Ok(judge_by(scenario, rollout, suite.profile(), verdict))
}

fn tested_run(
    suite: &Suite,
    scenario: &Scenario,
    simulator: &dyn Simulator,
    recorded: &JudgedRun,
) -> Result<JudgedRun, RunError> {
    let mut run = run_scenario(scenario, simulator, suite.profile(), None)?;
    run.judgement.preventability = preventability(&run.rollout);
    run.judgement.verdict = Verdict { checks: vec![situation(&run, recorded)] };
    Ok(run)
}

/// What the account leaves open is searched for the nearest failure. A scenario that a person edited, or a model staged anew, is not
/// the rules' staging any more, and stays as it is; so does one with nothing to test.
fn tune(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let (suite, id) = (bench.suite, &cluster.scenario_id);
    let scenario = scenario(suite, id, &names::scenario(id))?;
    let design: DesignLog = suite.store().read_json(&names::design_log(id))?;
    let account = account(suite, id)?;
    let as_designed = design.attempts.get(design.taken).is_some_and(|taken| taken.draft == *scenario.draft());
    let as_designed = as_designed && scenario.draft().source.author.is_rules();
    let open = if as_designed && scenario.draft().is_tested() { open_choices(&account) } else { Vec::new() };
    let first: JudgedRun = suite.store().read_json(&match scenario.draft().is_tested() {
        true => names::first_run(id),
        false => names::recorded_run(id),
    })?;
    let is_start = |values: &[f64]| values.iter().zip(&open).all(|(value, parameter)| *value == parameter.start);
    let draft_of = |values: &[f64]| match is_start(values) {
        true => Ok(scenario.draft().clone()),
        false => staged_with(&account, &open, values).map(|draft| named(draft, bench, cluster)),
    };
    let drafts = Ahead::new(draft_of);
    let make = |values: &[f64]| {
        let checked = recrash_roads::check(drafts.of(values)?);
        checked
            .map(|checked| checked.value)
            .map_err(|told| told.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
    };
    let run = |scenario: &Scenario| {
        let recorded = Native::new(Ego::Recorded).run(scenario)?;
        tested_run(
            suite,
            scenario,
            bench.simulator(),
            &judge_by(scenario, recorded, suite.profile(), Verdict::default()),
        )
    };
    let aim = suite.options().aim;
    let scoring = Scoring::of(&open, make, run, &first).aiming_at(aim);
    let sound = is_sound_contact(&first.rollout) && first.situation_met() == Some(true) && aim == Aim::Failure;
    let enough = |point: &TunePoint| open.is_empty() || point.number == 0 && point.score.refused.is_empty() && sound;
    let seed = case_seed(suite, cluster).child("tune");
    let options = tune_options(suite)?;
    let score = |values: &[f64], next: Next<'_>| {
        // Where the start is enough nothing comes next.
        if !is_start(values) {
            drafts.prepare(values, next);
        }
        scoring.score(values)
    };
    let log = recrash_search::tune(id, &open, options, seed, score, enough);
    let tuned = drafts.of(&log.points[log.best].values).map_err(|why| PipelineError::scenario(id, why))?;
    Ok(vec![
        (names::tuned(id), to_json(&tuned)),
        (names::tune_log(id), to_compact_json(&log)),
        (names::tune_agent(id), to_json(&AgentLog::rules())),
    ])
}

fn judge(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let (suite, id) = (bench.suite, &cluster.scenario_id);
    let scenario = scenario(suite, id, &names::tuned(id))?;
    if !scenario.draft().is_tested() {
        return Ok(Vec::new());
    }
    let recorded = recorded_run(suite, id, &scenario)?;
    let run = tested_run(suite, &scenario, bench.simulator(), &recorded)?;
    let mut files = vec![
        (names::tuned_run(id), to_compact_json(&run)),
        (names::tuned_recorded_run(id), to_compact_json(&recorded)),
    ];
    if run.failed() {
        let (triage, reference) = triage(&scenario, &run, suite.profile(), &built_in())?;
        files.push((names::triage(id), to_json(&triage)));
        files.extend(reference.map(|run| (names::reference_run(id), to_compact_json(&run))));
    }
    Ok(files)
}
