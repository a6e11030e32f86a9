//! The nearest failure of a scenario that stands in no suite: its numbers move as a search of a suite would move them.

use crate::error::PipelineError;
use crate::simulators::Simulator;
use recrash_agents::parameters;
use recrash_lab::{Scoring, is_sound_contact, run_scenario};
use recrash_model::Seed;
use recrash_model::narrative::{NARRATIVE_FORMAT, Narrative, Origin};
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_model::scenario::{Author, NOTHING_TO_TEST, ScenarioDraft};
use recrash_model::template::{Movement, RoadType, Template};
use recrash_model::tuning::{Parameter, TuneLog, TunePoint, apply};
use recrash_roads::{RunError, Scenario};
use recrash_search::TuneOptions;

/// A tuned scenario.
pub struct TunedScenario {
    /// The scenario at the best point.
    pub scenario: Scenario,
    /// The ego's run in it.
    pub run: JudgedRun,
    /// What was tried.
    pub log: TuneLog,
}

/// Searches the nearest failure of an ego around a scenario. Same arguments, same result, wherever it is run.
///
/// # Errors
/// There is no such searcher, there is nothing to test in the scenario, nothing varies in it, or the ego cannot be run in it.
pub fn tune_scenario(
    scenario: &Scenario,
    simulator: &dyn Simulator,
    profile: &SystemProfile,
    searcher: &str,
    budget: usize,
    seed: u64,
) -> Result<TunedScenario, PipelineError> {
    let options =
        TuneOptions { searcher: searcher.parse().map_err(|why: String| PipelineError::bad_input(why))?, budget };
    let draft = scenario.draft();
    if !draft.is_tested() {
        return Err(PipelineError::bad_input(format!("{}: {NOTHING_TO_TEST}", draft.id)));
    }
    let parameters = movable(draft, profile);
    if parameters.is_empty() {
        return Err(PipelineError::bad_input(format!("nothing varies in {}, so there is nothing to search", draft.id)));
    }
    let make = |values: &[f64]| {
        let checked = recrash_roads::check(apply(draft, &parameters, values)?);
        checked
            .map(|checked| checked.value)
            .map_err(|told| told.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
    };
    let run = |scenario: &Scenario| -> Result<JudgedRun, RunError> { run_scenario(scenario, simulator, profile, None) };
    let first = run(scenario)?;
    let scoring = Scoring::of(&parameters, make, run, &first);
    let sound = is_sound_contact(&first.rollout);
    let enough = |point: &TunePoint| point.number == 0 && point.score.refused.is_empty() && sound;
    let seed = Seed(seed).child("tune").child(&draft.id);
    let log = recrash_search::tune(&draft.id, &parameters, options, seed, |values, _| scoring.score(values), enough);
    let tuned = make(&log.points[log.best].values).map_err(|why| PipelineError::scenario(&draft.id, why))?;
    let run = run(&tuned)?;
    Ok(TunedScenario { scenario: tuned, run, log })
}

/// What a search would move in a scenario of which no narrative is known: everything may move by what is usual.
pub(crate) fn movable(draft: &ScenarioDraft, profile: &SystemProfile) -> Vec<Parameter> {
    let straight = Movement::Straight;
    let any = Template { road: RoadType::Intersection, sv: straight, cp: straight, work_zone: false };
    let untold = Narrative {
        format: NARRATIVE_FORMAT.to_owned(),
        scenario_id: draft.id.clone(),
        template: draft.source.template.unwrap_or(any),
        records: Vec::new(),
        text: String::new(),
        facts: Vec::new(),
        origin: Origin::Invented { reason: String::new() },
        author: Author::Person,
    };
    parameters(draft, &untold, profile)
}
