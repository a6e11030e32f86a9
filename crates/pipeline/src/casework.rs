//! Work on one case: the loop of design, check, rollout and verdict; and one run of one scenario.

use crate::agents::{RULES, unusable};
use crate::error::PipelineError;
use crate::external::Patience;
use crate::output::Outputs;
use crate::paths;
use crate::profiles::load_profile;
use crate::simulator::{Simulator, SimulatorKind, start_simulator};
use crate::store::{read_text, to_compact_json};
use recrash_agents::{Brief, Design, Feedback, Problem, inexpressible};
use recrash_metrics::{faithfulness, findings, measure};
use recrash_model::metrics::{Check, Expectation};
use recrash_model::narrative::Narrative;
use recrash_model::profile::SystemProfile;
use recrash_model::rollout::Rollout;
use recrash_model::run::JudgedRun;
use recrash_model::scenario::{Author, ScenarioDraft};
use recrash_model::{Diagnostic, Outcome};
use recrash_roads::Scenario;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Scenario files larger than this are refused. [bytes]
const MAX_SCENARIO_FILE: u64 = 1 << 20;
/// Designs of the rules that are tried before the best so far is taken.
pub const MAX_DESIGNS: usize = 6;

/// Runs a scenario and computes everything from its rollout.
///
/// # Errors
/// The simulator failed; the native one cannot.
pub fn run_scenario(
    scenario: &Scenario,
    simulator: &dyn Simulator,
    profile: &SystemProfile,
    expectation: Option<&Expectation>,
) -> Result<JudgedRun, PipelineError> {
    let rollout = simulator.run(scenario).map_err(|error| PipelineError::not_run(&error))?;
    Ok(judge(scenario, rollout, profile, expectation))
}

/// Computes everything from a rollout of a scenario, whichever simulator it comes from.
pub(crate) fn judge(
    scenario: &Scenario,
    rollout: Rollout,
    profile: &SystemProfile,
    expectation: Option<&Expectation>,
) -> JudgedRun {
    let metrics = measure(scenario, &rollout, &profile.failure);
    let found = findings(scenario, &rollout, &metrics, &profile.failure);
    let verdict = expectation.map(|e| faithfulness(scenario, &rollout, &metrics, e)).unwrap_or_default();
    JudgedRun::new(rollout, metrics, found, verdict)
}

/// What became of the designs of one scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DesignLog {
    /// `rules`, or the model that was asked first.
    pub asked: String,
    /// Answers that went back to the model, because of their form or of what the check or the rollout said.
    pub repairs: usize,
    /// Every try, in order.
    pub attempts: Vec<DesignAttempt>,
    /// Number of the try that was taken, from 0.
    pub taken: usize,
    /// Designers that did not come to a faithful scenario, and why.
    pub gave_up: Vec<String>,
}

/// One try.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DesignAttempt {
    /// The design.
    pub draft: ScenarioDraft,
    /// What the check said.
    pub diagnostics: Vec<Diagnostic>,
    /// Checks of faithfulness that failed; absent where it did not run.
    pub unfaithful: Option<Vec<Check>>,
}

impl DesignLog {
    /// One word for tables: `rules`, `first answer`, `after repair` or `fallback`.
    pub fn outcome(&self) -> &'static str {
        match self.attempts.get(self.taken).map(|attempt| &attempt.draft.source.author) {
            _ if self.asked == RULES => "rules",
            None | Some(Author::Rules) => "fallback",
            _ if self.taken == 0 && self.repairs == 0 => "first answer",
            _ => "after repair",
        }
    }
}

impl DesignAttempt {
    /// The fewer the better: not runnable counts as worse than any unfaithfulness.
    fn faults(&self) -> usize {
        self.unfaithful.as_ref().map_or(usize::MAX, Vec::len)
    }
}

/// A designer and how often it may try.
pub struct Designer<'a> {
    /// Name: `rules` or a model.
    pub name: &'a str,
    /// The agent.
    pub agent: &'a dyn Design,
    /// Tries.
    pub tries: usize,
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
pub fn design_case(
    designers: &[Designer],
    brief: &Brief,
    narrative: &Narrative,
    expectation: &Expectation,
    simulator: &dyn Simulator,
) -> Result<(ScenarioDraft, DesignLog), PipelineError> {
    let asked = designers.first().map_or(RULES, |designer| designer.name).to_owned();
    let mut log = DesignLog { asked, repairs: 0, attempts: Vec::new(), taken: 0, gave_up: Vec::new() };
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

/// One scenario file, run.
#[derive(Debug, Clone, PartialEq)]
pub struct FileRun {
    /// The run.
    pub run: JudgedRun,
    /// Remarks on the file.
    pub diagnostics: Vec<Diagnostic>,
}

/// How one scenario file is run.
#[derive(Debug, Clone, PartialEq)]
pub struct FileRequest<'a> {
    /// The file.
    pub scenario: &'a Path,
    /// Profile with the failure criteria, and the ego where none is named.
    pub profile: &'a str,
    /// Ego.
    pub ego: Option<&'a str>,
    /// Simulator.
    pub simulator: SimulatorKind,
    /// Python interpreter for MetaDrive.
    pub python: &'a Path,
    /// How long answers of an external ego are waited for.
    pub patience: Patience,
    /// Where to write the rollout.
    pub rollout: Option<&'a Path>,
}

/// Reads, checks and runs one scenario file.
///
/// # Errors
/// The file cannot be read, is no scenario, or cannot be run: every problem with its place.
pub fn simulate_file(request: &FileRequest) -> Result<FileRun, PipelineError> {
    let read = paths::of_profile_and_ego(Some(request.profile), request.ego).into_iter();
    let mut outputs = Outputs::of_inputs(read.chain([request.scenario.to_owned()]));
    let rollout = request.rollout.map(|target| outputs.claim(target)).transpose()?;
    let profile = load_profile(request.profile)?;
    let (scenario, diagnostics) = read_scenario(request.scenario)?;
    let ego = request.ego.unwrap_or(&profile.ego);
    let simulator = start_simulator(request.simulator, ego, request.python, 1, request.patience)?;
    let run = run_scenario(&scenario, &simulator, &profile, None)?;
    if let Some(rollout) = rollout {
        rollout.write(&to_compact_json(&run.rollout))?;
    }
    Ok(FileRun { run, diagnostics })
}

/// Reads and checks a scenario file.
///
/// # Errors
/// As [`simulate_file`].
pub fn read_scenario(path: &Path) -> Result<(Scenario, Vec<Diagnostic>), PipelineError> {
    let text = read_text(path, MAX_SCENARIO_FILE)?;
    match scenario_from(&text) {
        Ok(read) => Ok((read.value, read.diagnostics)),
        Err(diagnostics) => Err(not_runnable(path, diagnostics)),
    }
}

/// Reads and checks a scenario's JSON: recrash's own, or the paper's dialect.
pub(crate) fn scenario_from(json: &str) -> Result<Outcome<Scenario>, Vec<Diagnostic>> {
    let draft = recrash_roads::read_draft(json)?;
    let with_lines = |mut list: Vec<Diagnostic>| {
        recrash_roads::add_lines(json, &mut list);
        list
    };
    let mut checked = recrash_roads::check(draft.value).map_err(with_lines)?;
    checked.diagnostics = draft.diagnostics.into_iter().chain(with_lines(checked.diagnostics)).collect();
    Ok(checked)
}

pub(crate) fn not_runnable(path: &Path, diagnostics: Vec<Diagnostic>) -> PipelineError {
    PipelineError::BadInput { what: format!("{} is not a scenario that can be run", path.display()), diagnostics }
}
