//! A language model looks at the replay of what the rules staged of an account, and changes the scenario where that does not show the crash
//! as the reports tell it. What it makes is run and held against the account like the rules' own; where it is never content, theirs stays.

use super::design_log::{DesignAttempt, DesignLog};
use super::{Bench, CaseStage, Cases, StageWork, case_inputs, unit_name};
use crate::error::PipelineError;
use crate::models::Models;
use crate::models::cast::unusable;
use crate::progress::ProgressEvent;
use crate::suite::{Stage, Suite, Work, names};
use recrash_agents::Brief;
use recrash_agents::llm::{Question, Repairs, Staging, restage_question};
use recrash_lab::replay;
use recrash_model::Diagnostic;
use recrash_model::account::Account;
use recrash_model::metrics::{Check, CheckKind, CheckResult, Verdict};
use recrash_model::rollout::{ActorState, Rollout, STANDS_MPS, STEP_S};
use recrash_model::scenario::{EgoSpec, ScenarioDraft, Source};
use recrash_model::selection::Cluster;
use recrash_reconstruct::{HANDOVER_BEFORE_S, ROLLS_S, Reconstruction, held_against, reconstruct};
use recrash_roads::{MAX_WANTED_MPS, Simulator};
use recrash_sim::{Ego, Native};
use std::cell::RefCell;

/// Bytes of a first question, about: reports, scenario, replay and the schema.
const QUESTION_BYTES: usize = 48_000;

/// What the model makes of what the rules staged of a case, and how it came to that; as it is where no model is cast.
///
/// # Errors
/// An answer is still to come, or the run has to stop.
pub(super) fn restaged(
    bench: &Bench,
    cluster: &Cluster,
    account: &Account,
    draft: ScenarioDraft,
    log: DesignLog,
) -> Result<(ScenarioDraft, DesignLog), PipelineError> {
    let records = bench.cases.records_of(cluster);
    let brief = bench.cases.brief(bench.suite, cluster, &records, Some(account));
    looked_at(bench.suite, &brief, account, draft, log)
}

/// The same of what the rules staged of an account, as the first attempt of its log has it.
///
/// # Errors
/// The same.
pub(super) fn looked_at(
    suite: &Suite,
    brief: &Brief,
    account: &Account,
    draft: ScenarioDraft,
    log: DesignLog,
) -> Result<(ScenarioDraft, DesignLog), PipelineError> {
    let Some((models, name)) = suite.models().zip(suite.options().cast.designer()) else { return Ok((draft, log)) };
    let (given, of_rules) = rehearse(account, draft.clone(), &[])
        .map_err(|problems| PipelineError::scenario(brief.scenario_id, problems.join("; ")))?;
    let (repairs, attempts) = (Repairs::default(), RefCell::new(log.attempts.clone()));
    let shown: Vec<Check> = given.checks.iter().filter(|check| check.result == CheckResult::Shown).cloned().collect();
    let stage = |mut draft: ScenarioDraft| {
        // When the system takes over is computed from the run, which may be a shorter one now.
        draft.ego.handover_s = given.draft.ego.handover_s.map(|time_s| time_s.min(draft.duration_s));
        let (mut staged, rollout) = rehearse(account, draft, &shown)?;
        hand_over(&mut staged.draft.ego, &rollout, (&given.draft.ego, &of_rules));
        recrash_roads::check(staged.draft.clone()).map_err(errors)?;
        let (draft, unfaithful) = (staged.draft.clone(), Some(staged.missed.clone()));
        attempts.borrow_mut().push(DesignAttempt { draft, diagnostics: Vec::new(), unfaithful });
        Ok(staged)
    };
    let made = models.model(name, &suite.options().cast, &repairs).restage(brief, given.clone(), stage);
    let mut log = DesignLog { asked: name.to_owned(), repairs: repairs.all(), attempts: attempts.into_inner(), ..log };
    let taken = match made {
        // All of it may have been taken back.
        Ok(staging) if same_scene(&staging.draft, &draft) => draft,
        Ok(staging) => {
            log.changed = staging.changed;
            staging.draft
        }
        Err(error) => {
            log.gave_up.push(unusable(error)?);
            draft
        }
    };
    log.taken = log.attempts.iter().rposition(|attempt| attempt.draft == taken).unwrap_or(0);
    Ok((taken, log))
}

/// Whether two scenarios are the same but for who wrote them.
fn same_scene(one: &ScenarioDraft, other: &ScenarioDraft) -> bool {
    let author = other.source.author.clone();
    ScenarioDraft { source: Source { author, ..one.source.clone() }, ..one.clone() } == *other
}

/// The first question about what the rules staged of a case.
///
/// # Errors
/// Its account or its design is not there, or cannot be read or run.
pub(crate) fn question(
    suite: &Suite,
    cases: &Cases,
    cluster: &Cluster,
    model: &str,
) -> Result<Question, PipelineError> {
    let (id, records) = (&cluster.scenario_id, cases.records_of(cluster));
    let account: Account = suite.store().read_json(&names::account(id))?;
    let log: Option<DesignLog> = suite.store().read_json(&names::design_log(id)).ok();
    // Where the design waits for answers the rules stage it for the purpose.
    let draft = match log.and_then(|log| log.attempts.into_iter().next()) {
        Some(first) => first.draft,
        None => reconstruct(&account).map_err(|why| PipelineError::scenario(id, why.label()))?.draft,
    };
    let (given, _) = rehearse(&account, draft, &[]).map_err(|why| PipelineError::scenario(id, why.join("; ")))?;
    let brief = cases.brief(suite, cluster, &records, Some(&account));
    restage_question(model, &brief, &given).map_err(|e| PipelineError::bad_input(e.to_string()))
}

fn errors(why: Vec<Diagnostic>) -> Vec<String> {
    why.iter().filter(|told| told.is_error()).map(ToString::to_string).collect()
}

/// Runs the recorded driver in a scenario, and holds what comes of it against the account. `shown` are facts that it may not lose.
///
/// # Errors
/// It cannot be run.
fn rehearse(account: &Account, draft: ScenarioDraft, shown: &[Check]) -> Result<(Staging, Rollout), Vec<String>> {
    // As the stages behind this one read it from its file.
    let read = recrash_roads::read_draft(&recrash_roads::write_draft(&draft)).map_err(errors)?.value;
    let scenario = recrash_roads::check(read).map_err(errors)?.value;
    let rollout = Native::new(Ego::Recorded).run(&scenario).map_err(|why| vec![why.to_string()])?;
    let verdict = held_against(account, &scenario, &rollout).map_err(|why| vec![why.label().to_owned()])?;
    let replay = replay::in_words(scenario.draft(), &rollout) + &replay::in_the_plane(&rollout);
    let made = Reconstruction { draft: scenario.draft().clone(), rollout, verdict, assumed: Vec::new() };
    let missed = all_missed(&made, shown);
    let Reconstruction { draft, rollout, verdict, .. } = made;
    Ok((Staging { draft, replay, checks: verdict.checks, missed, changed: Vec::new() }, rollout))
}

/// What a reconstruction does not show, of what is told and of what was shown before.
fn all_missed(made: &Reconstruction, shown: &[Check]) -> Vec<Check> {
    let without = |observed: &str, check: &Check| Check {
        observed: observed.to_owned(),
        result: CheckResult::CannotBeShown,
        ..check.clone()
    };
    // Nothing else can be said of a run in which nobody touches the ego.
    let contact = || shown.iter().find(|check| check.kind == CheckKind::Contact);
    if made.rollout.first_contact_of(0).is_none()
        && let Some(contact) = contact()
    {
        return vec![without("no contact", contact)];
    }
    let same = |one: &Check, other: &Check| one.kind == other.kind && one.expected == other.expected;
    let lost = |check: &&Check| check.result != CheckResult::Shown && shown.iter().any(|other| same(check, other));
    let missed: Vec<&Check> = made.all_missed().collect();
    let is_missed = |check: &&Check| missed.contains(check) || lost(check);
    let checks = &made.verdict.checks;
    // Of what has no check any more nothing is to be seen.
    let gone = shown.iter().filter(|other| !checks.iter().any(|check| same(check, other)));
    checks.iter().filter(is_missed).cloned().chain(gone.map(|check| without("nothing of it", check))).collect()
}

/// An account's crash as a model staged it.
///
/// # Errors
/// It cannot be run.
pub(super) fn as_staged(account: &Account, draft: &ScenarioDraft) -> Result<Reconstruction, Vec<String>> {
    let (staging, rollout) = rehearse(account, draft.clone(), &[])?;
    let verdict = Verdict { checks: staging.checks };
    Ok(Reconstruction { draft: staging.draft, rollout, verdict, assumed: Vec::new() })
}

/// Has the system under test take over some time before the contact, and before the ego began to stop; as in what the rules staged, where
/// neither the ego nor the time of its contact is another.
fn hand_over(ego: &mut EgoSpec, rollout: &Rollout, (of_rules, before): (&EgoSpec, &Rollout)) {
    (ego.handover_s, ego.target_speed_mps) = (of_rules.handover_s, of_rules.target_speed_mps);
    let contact = |rollout: &Rollout| rollout.first_contact_of(0).map(|(time_s, _)| time_s);
    let Some(contact_s) = contact(rollout) else { return };
    if ego.recorded == of_rules.recorded && contact(before) == Some(contact_s) {
        return;
    }
    let speeds: Vec<f64> = rollout.ego_track().until(contact_s).iter().map(ActorState::speed).collect();
    ego.handover_s = of_rules.handover_s.map(|_| handover_s(&speeds, contact_s));
    // Whoever is tested wants to go no faster than a scenario allows.
    ego.target_speed_mps = speeds.iter().copied().fold(of_rules.target_speed_mps, f64::max).min(MAX_WANTED_MPS);
}

/// When that is, by the speeds of the ego until its contact, step by step. [s]
fn handover_s(speeds: &[f64], contact_s: f64) -> f64 {
    let stands = speeds.iter().rposition(|speed| speed.abs() > STANDS_MPS).map_or(0, |last| last + 1);
    let before_s = contact_s - HANDOVER_BEFORE_S;
    if stands == speeds.len() {
        return before_s.max(0.0);
    }
    let braked = (1..=stands).rev().find(|&step| speeds[step - 1] <= speeds[step]).unwrap_or(0);
    (braked as f64 * STEP_S - ROLLS_S).min(before_s).max(0.0)
}

/// About what so many first questions cost, in words.
pub(super) fn question_cost(models: &Models, name: &str, count: usize) -> String {
    models.estimate(name, count * QUESTION_BYTES, count)
}

/// Says before the first question how many replays are looked at, and what that costs about.
pub(super) fn tell_cost(work: &StageWork, declared: &CaseStage, cases: &Cases) -> Result<(), PipelineError> {
    let suite = work.suite;
    let Some((models, name)) = suite.models().zip(suite.options().cast.designer()) else { return Ok(()) };
    let clusters = cases.up_to(suite, Stage::Design);
    let is_open = |cluster: &&Cluster| -> Result<bool, PipelineError> {
        let id = &cluster.scenario_id;
        if cases.account(cluster).and_then(|account| cases.staged_again(account)).is_some() {
            return Ok(false);
        }
        let (unit, inputs) = (unit_name(Stage::Design, id), case_inputs(suite, declared, cases, cluster)?);
        let unit = Work { name: &unit, inputs: &inputs, editable: &(declared.editable)(id) };
        Ok(suite.must_be_current(Stage::Design, &unit).is_err())
    };
    let open: Vec<bool> = clusters.iter().map(is_open).collect::<Result<_, _>>()?;
    let count = open.into_iter().filter(|open| *open).count();
    if count > 0 {
        let cost = question_cost(models, name, count);
        let what = format!(
            "{name} looks at {count} of {} replays, and changes what they do not show as told: {cost}, and more for each change, as all \
             that was said before is sent again",
            clusters.len()
        );
        work.progress.event(ProgressEvent::Said { what: &what });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_system_takes_over_while_the_ego_still_rolls() {
        // It drives at 5 m/s, brakes from 4 s on and stands from 6.5 s on; the contact comes at 9 s.
        let speed = |step: usize| (5.0 - 2.0 * (step as f64 * STEP_S - 4.0).max(0.0)).max(0.0);
        let stops: Vec<f64> = (0..=90).map(speed).collect();
        assert!((handover_s(&stops, 9.0) - 3.0).abs() < 1e-9, "{}", handover_s(&stops, 9.0));
        assert_eq!(handover_s(&[5.0; 91], 9.0), 4.0);
        assert_eq!(handover_s(&[0.0; 91], 9.0), 0.0, "it stood from the start");
        assert_eq!(handover_s(&[5.0; 31], 3.0), 0.0);
    }
}
