//! Narratives to scenarios: the loop of design, check, rollout and verdict.

use super::cases::text_of;
use super::design_log::{DesignAttempt, DesignLog};
use super::{Bench, CaseStage, player};
use crate::error::PipelineError;
use crate::files::json::to_json;
use crate::models::cast::{RULES, unusable};
use crate::simulators::Simulator;
use crate::suite::names;
use crate::suite::{Files, Stage};
use recrash_agents::llm::Repairs;
use recrash_agents::{Brief, Design, Feedback, Problem, Rules, inexpressible, narrative_contradictions};
use recrash_lab::run_scenario;
use recrash_model::Outcome;
use recrash_model::metrics::{Check, Expectation};
use recrash_model::narrative::Narrative;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::selection::Cluster;

/// Designs of the rules that are tried before the best so far is taken.
const MAX_DESIGNS: usize = 6;

/// The stage.
pub(super) const DECLARED: CaseStage = CaseStage {
    stage: Stage::Design,
    reads: |id| vec![(Stage::Narrate, names::narrative(id))],
    editable: |id| vec![names::scenario(id)],
    decides: |suite| {
        let chosen = suite.options();
        Ok(vec![text_of(&chosen.seed), player(suite, &chosen.cast.design)])
    },
    runs_ego: true,
    work: design,
};

fn design(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let suite = bench.suite;
    let records = bench.cases.records_of(cluster);
    let brief = bench.cases.brief(suite, cluster, &records, None);
    let (narrative, expectation) = bench.cases.expectation(suite, cluster)?;
    refuse_contradictions(&narrative, &brief)?;
    let cast = &suite.options().cast;
    let (name, repairs) = (&cast.design, Repairs::default());
    // There is nothing to read of a template without records.
    let model =
        suite.models().filter(|_| name != RULES && !cluster.invented).map(|models| models.model(name, cast, &repairs));
    let by_model = model.as_ref().map(|agent| Designer { name, agent, tries: cast.repairs + 1 });
    let by_rules = Designer { name: RULES, agent: &Rules, tries: MAX_DESIGNS };
    let designers: Vec<Designer> = by_model.into_iter().chain([by_rules]).collect();
    let (draft, log) = design_case(&designers, &brief, &narrative, &expectation, bench.simulator())?;
    let log = DesignLog { repairs: repairs.all(), ..log };
    let id = &cluster.scenario_id;
    Ok(vec![(names::scenario(id), to_json(&draft)), (names::design_log(id), to_json(&log))])
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

/// What the best design of the rules does not show; nothing where it shows everything.
///
/// # Errors
/// None of the designs can be run.
pub(super) fn staged_by_rules(
    brief: &Brief,
    narrative: &Narrative,
    expectation: &Expectation,
    simulator: &dyn Simulator,
) -> Result<Option<Check>, PipelineError> {
    let by_rules = Designer { name: RULES, agent: &Rules, tries: MAX_DESIGNS };
    let (_, log) = design_case(&[by_rules], brief, narrative, expectation, simulator)?;
    let missed = log.attempts.get(log.taken).and_then(|attempt| attempt.unfaithful.as_ref()?.first().cloned());
    Ok(missed)
}

/// A designer and how often it may try.
struct Designer<'a> {
    /// Name: `rules` or a model.
    name: &'a str,
    /// The agent.
    agent: &'a dyn Design,
    /// Tries.
    tries: usize,
}

/// What became of one designer's tries.
enum Course {
    /// The last try is faithful.
    Faithful,
    /// The tries are used up.
    UsedUp,
    /// The agent has no further answer, and why.
    GaveUp(String),
}

/// Designs a scenario: each try is checked, run and judged, and what was wrong goes into the next. The designers come in
/// turn until a try is faithful; else the one with the fewest faults is taken.
///
/// # Errors
/// An answer is still to come, or none of the designs can be run.
fn design_case(
    designers: &[Designer],
    brief: &Brief,
    narrative: &Narrative,
    expectation: &Expectation,
    simulator: &dyn Simulator,
) -> Result<(ScenarioDraft, DesignLog), PipelineError> {
    let mut log = DesignLog::asking(designers.first().map_or(RULES, |designer| designer.name));
    for designer in designers {
        match design_by(designer, brief, narrative, expectation, simulator, &mut log.attempts)? {
            Course::Faithful => break,
            Course::UsedUp => {
                log.gave_up.push(format!("{}: none of {} tries is faithful", designer.name, designer.tries));
            }
            Course::GaveUp(why) => log.gave_up.push(why),
        }
    }
    let best = (0..log.attempts.len()).min_by_key(|&i| log.attempts[i].faults());
    let Some(taken) = best.filter(|&i| log.attempts[i].unfaithful.is_some()) else {
        let mut why = vec!["no design can be run".to_owned()];
        why.extend(log.gave_up);
        why.extend(best.iter().flat_map(|&i| &log.attempts[i].diagnostics).map(ToString::to_string));
        return Err(PipelineError::scenario(brief.scenario_id, why.join("; ")));
    };
    log.taken = taken;
    Ok((log.attempts[taken].draft.clone(), log))
}

fn design_by(
    designer: &Designer,
    brief: &Brief,
    narrative: &Narrative,
    expectation: &Expectation,
    simulator: &dyn Simulator,
    attempts: &mut Vec<DesignAttempt>,
) -> Result<Course, PipelineError> {
    let mut feedback = Vec::new();
    for _ in 0..designer.tries {
        let draft = match designer.agent.design(brief, narrative, &feedback) {
            Ok(draft) => draft,
            Err(error) => return unusable(error).map(Course::GaveUp),
        };
        let beyond = inexpressible(&draft, brief.profile);
        let checked = if beyond.is_empty() { recrash_roads::check(draft.clone()) } else { Err(beyond) };
        let (attempt, problem) = match checked {
            Err(diagnostics) => (
                DesignAttempt { draft: draft.clone(), diagnostics: diagnostics.clone(), unfaithful: None },
                Some(Problem::NotRunnable { diagnostics }),
            ),
            Ok(Outcome { value: scenario, diagnostics }) => {
                let run = run_scenario(&scenario, simulator, brief.profile, Some(expectation))?;
                let failures: Vec<Check> = run.verdict.failures().cloned().collect();
                let problem = (!failures.is_empty()).then(|| Problem::NotFaithful {
                    failures: failures.clone(),
                    metrics: Box::new(run.judgement.metrics),
                });
                (DesignAttempt { draft: draft.clone(), diagnostics, unfaithful: Some(failures) }, problem)
            }
        };
        attempts.push(attempt);
        match problem {
            Some(problem) => feedback.push(Feedback { draft, problem }),
            None => return Ok(Course::Faithful),
        }
    }
    Ok(Course::UsedUp)
}
