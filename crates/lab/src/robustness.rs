//! How robust a failure is: the share of small changes of its scenario under which it is still one. Described in
//! `docs/models/robustness.md`.

use crate::judging::{run_scenario, run_scenario_in};
use crate::perturb::{Nudge, Who, everybody, nudged};
use recrash_model::Seed;
use recrash_model::metrics::FindingKind;
use recrash_model::profile::SystemProfile;
use recrash_model::rollout::Substeps;
use recrash_model::run::JudgedRun;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::seed::Rng;
use recrash_roads::{RunError, Simulator};
use serde::{Deserialize, Serialize};

/// Largest random changes: along and across the way, in time and of speed. Assumed: what a reconstruction leaves open at least.
/// [m, m, s, share]
const LARGEST: (f64, f64, f64, f64) = (0.25, 0.1, 0.1, 0.02);
/// A failure that a move of somebody by this undoes lives on centimetres. [m]
const CENTIMETRES_M: f64 = 0.05;
/// A failure that a delay of somebody by this undoes lives on tenths of a second. [s]
const TENTH_S: f64 = 0.1;
/// Other physics steps that are tried: 25, 12.5 and 10 ms in place of 20 ms.
const OTHER_STEPS: [Substeps; 3] = [Substeps::new(4), Substeps::new(8), Substeps::new(10)];
/// A scenario that may not be run as changed is drawn again, so often.
const DRAWN_AGAIN: u32 = 4;
/// A failure with a greater share is robust.
const ROBUST: f64 = 0.8;

/// How robust a failure is.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Robustness {
    /// Random changes that were run.
    pub tries: u32,
    /// Of those, the ones that fail.
    pub failed: u32,
    /// Of those, the ones that crash.
    pub crashed: u32,
    /// Who, moved by 5 cm one way or the other, undoes the failure.
    pub lives_on_centimetres: Vec<String>,
    /// Who, 0.1 s sooner or later, undoes the failure.
    pub lives_on_tenths: Vec<String>,
    /// Of the tries, those with another physics step than the usual one; none where the simulator has one only.
    #[serde(default)]
    pub other_steps: u32,
    /// Physics steps in 0.1 s that undo the failure, nothing else being changed.
    #[serde(default)]
    pub lives_on_step: Vec<Substeps>,
}

impl Robustness {
    /// Share of the changes that still fail; 1 where none could be run.
    pub fn share(&self) -> f64 {
        if self.tries == 0 { 1.0 } else { f64::from(self.failed) / f64::from(self.tries) }
    }

    /// Whether it lives on less than 5 cm or 0.1 s.
    pub fn is_marginal(&self) -> bool {
        !self.lives_on_centimetres.is_empty() || !self.lives_on_tenths.is_empty()
    }

    /// Whether it is an artefact of the physics step: another one undoes it.
    pub fn is_step_artefact(&self) -> bool {
        !self.lives_on_step.is_empty()
    }

    /// Whether more than 80 % of the changes still fail.
    pub fn is_robust(&self) -> bool {
        self.share() > ROBUST
    }
}

/// Whether a draft fails, and crashes; `None` where it may not be run.
fn fails(
    draft: ScenarioDraft,
    simulator: &dyn Simulator,
    profile: &SystemProfile,
) -> Result<Option<(bool, bool)>, RunError> {
    let Ok(checked) = recrash_roads::check(draft) else { return Ok(None) };
    Ok(Some(outcome(&run_scenario(&checked.value, simulator, profile, None)?)))
}

/// The same with another physics step; `None` also where the simulator has one only.
fn fails_in(
    draft: ScenarioDraft,
    simulator: &dyn Simulator,
    profile: &SystemProfile,
    substeps: Substeps,
) -> Result<Option<(bool, bool)>, RunError> {
    let Ok(checked) = recrash_roads::check(draft) else { return Ok(None) };
    Ok(run_scenario_in(&checked.value, simulator, profile, substeps)?.as_ref().map(outcome))
}

fn outcome(run: &JudgedRun) -> (bool, bool) {
    (run.failed(), run.finding_kinds().into_iter().any(FindingKind::is_crash))
}

/// Changes a failing scenario by little, over and over, and looks whether it still fails.
///
/// # Errors
/// The simulator or the ego failed.
pub fn robustness(
    draft: &ScenarioDraft,
    simulator: &dyn Simulator,
    profile: &SystemProfile,
    tries: u32,
    seed: Seed,
) -> Result<Robustness, RunError> {
    let mut found = Robustness::default();
    let seed = seed.child(&draft.id);
    for number in 0..tries {
        let mut rng = seed.child(&format!("try {number}")).rng();
        for _ in 0..=DRAWN_AGAIN {
            let changed = shaken(draft, &mut rng);
            let other = match drawn_step(&mut rng) {
                Some(substeps) => fails_in(changed.clone(), simulator, profile, substeps)?,
                None => None,
            };
            let run = if other.is_some() { other } else { fails(changed, simulator, profile)? };
            if let Some((failed, crashed)) = run {
                found.tries += 1;
                found.other_steps += u32::from(other.is_some());
                found.failed += u32::from(failed);
                found.crashed += u32::from(crashed);
                break;
            }
        }
    }
    let undoes = |who: Who, nudge: fn(f64) -> Nudge, by: f64| -> Result<bool, RunError> {
        for sign in [1.0, -1.0] {
            if let Some((false, _)) = fails(nudged(draft, who, nudge(sign * by)), simulator, profile)? {
                return Ok(true);
            }
        }
        Ok(false)
    };
    for who in everybody(draft) {
        let name = || who.name(draft);
        if undoes(who, Nudge::Along, CENTIMETRES_M)? || undoes(who, Nudge::Across, CENTIMETRES_M)? {
            found.lives_on_centimetres.push(name());
        }
        if undoes(who, Nudge::Later, TENTH_S)? {
            found.lives_on_tenths.push(name());
        }
    }
    for substeps in OTHER_STEPS {
        if let Some((false, _)) = fails_in(draft.clone(), simulator, profile, substeps)? {
            found.lives_on_step.push(substeps);
        }
    }
    Ok(found)
}

/// The usual physics step (`None`) or another one, each as likely.
fn drawn_step(rng: &mut Rng) -> Option<Substeps> {
    OTHER_STEPS.get(rng.below(OTHER_STEPS.len() + 1)).copied()
}

/// Everybody a little elsewhere, sooner or later, faster or slower.
fn shaken(draft: &ScenarioDraft, rng: &mut Rng) -> ScenarioDraft {
    let (along_m, across_m, later_s, faster) = LARGEST;
    let mut draft = draft.clone();
    for who in everybody(&draft) {
        draft = nudged(&draft, who, Nudge::Along(rng.range(-along_m, along_m)));
        draft = nudged(&draft, who, Nudge::Across(rng.range(-across_m, across_m)));
        draft = nudged(&draft, who, Nudge::Later(rng.range(-later_s, later_s)));
        draft = nudged(&draft, who, Nudge::Faster(1.0 + rng.range(-faster, faster)));
    }
    draft
}
