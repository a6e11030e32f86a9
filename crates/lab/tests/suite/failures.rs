//! Failures of random scenarios: what they need, how robust they are, and what a search for them aims at.

use recrash_lab::minimal::{minimal, without_each};
use recrash_lab::parity::{random_scenario, random_scene};
use recrash_lab::perturb::{Nudge, Who, nudged};
use recrash_lab::robustness::{Robustness, robustness};
use recrash_lab::{Scoring, judge, run_scenario, run_scenario_in, triage};
use recrash_model::Seed;
use recrash_model::geometry::OrientedBox;
use recrash_model::metrics::{Finding, FindingKind};
use recrash_model::narrative::Origin;
use recrash_model::profile::SystemProfile;
use recrash_model::rollout::{ActorState, Role, Substeps};
use recrash_model::run::JudgedRun;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::triage::{FailureClass, Fared};
use recrash_model::tuning::Aim;
use recrash_roads::Simulator;
use recrash_sim::{Ego, Native};

/// Failures that are looked at.
const FAILURES: usize = 100;

/// The profile that every command takes without `--profile`.
fn profile() -> SystemProfile {
    toml::from_str(include_str!("../../../../profiles/open.toml")).expect("a profile")
}

/// Random scenarios that the ego fails.
fn failing(simulator: &Native) -> Vec<ScenarioDraft> {
    let profile = profile();
    let fails =
        |scenario: &recrash_roads::Scenario| run_scenario(scenario, simulator, &profile, None).unwrap().failed();
    let all = (0..).map(|number| random_scenario(14, number)).filter(fails);
    all.map(|scenario| scenario.draft().clone()).take(FAILURES).collect()
}

#[test]
fn a_minimal_failure_passes_without_any_one_element_and_its_twin_passes() {
    let (simulator, profile) = (Native::new(Ego::MetadriveIdm), profile());
    let gravest = |draft: &ScenarioDraft| {
        let scenario = recrash_roads::check(draft.clone()).unwrap().value;
        run_scenario(&scenario, &simulator, &profile, None).unwrap().failures().min()
    };
    let (mut twins, mut taken, mut needed) = (0, 0, 0);
    for draft in failing(&simulator) {
        let found = minimal(&draft, None, &simulator, &profile).unwrap();
        assert_eq!(gravest(&found.draft), gravest(&draft), "the same failure: {}", draft.id);
        let each = without_each(&found.draft, None, &simulator, &profile).unwrap();
        let still: Vec<_> = each.iter().filter(|(_, failed)| *failed == Some(true)).collect();
        assert!(still.is_empty(), "{}: {still:?}", draft.id);
        let passing = each.iter().filter(|(_, failed)| *failed == Some(false)).count();
        assert_eq!(passing, found.needed.len(), "{}", draft.id);
        if let Some(twin) = &found.twin {
            assert_eq!(gravest(&twin.draft), None, "{}: {}", draft.id, twin.difference);
            twins += 1;
        }
        taken += found.taken.len();
        needed += found.needed.len();
    }
    println!("{FAILURES} failures: {taken} elements taken, {needed} needed, {twins} twins");
    assert!(twins >= 90 && taken > FAILURES, "{twins} twins, {taken} taken");
}

#[test]
fn numbers_go_back_to_the_record_where_the_failure_does_not_need_them() {
    let (simulator, profile) = (Native::new(Ego::MetadriveIdm), profile());
    let mut looked_at = 0;
    for record in failing(&simulator).into_iter().filter(|draft| !draft.partners.is_empty()).take(20) {
        let mut varied = record.clone();
        varied.ego.target_speed_mps *= 0.98;
        varied.partners[0].speed_mps *= 0.99;
        let Ok(checked) = recrash_roads::check(varied.clone()) else { continue };
        if !run_scenario(&checked.value, &simulator, &profile, None).unwrap().failed() {
            continue;
        }
        let found = minimal(&varied, Some(&record), &simulator, &profile).unwrap();
        let each = without_each(&found.draft, Some(&record), &simulator, &profile).unwrap();
        assert!(each.iter().all(|(_, failed)| *failed != Some(true)), "{each:?}");
        looked_at += usize::from(found.taken.iter().any(|name| name.contains("where the record has")));
    }
    assert!(looked_at >= 10, "{looked_at}");
}

#[test]
fn what_was_taken_away_does_not_come_back_from_the_record() {
    let (mut record, profile) = crossing();
    record.traffic.density = 0.1;
    let found = minimal(&record, Some(&record), &Native::new(Ego::MetadriveIdm), &profile).unwrap();
    assert!(found.taken.iter().any(|name| name == "background traffic"), "{:?}", found.taken);
    assert_eq!(found.draft.traffic.density, 0.0);
}

#[test]
fn robustness_repeats_and_finds_what_lives_on_little() {
    let (simulator, profile) = (Native::new(Ego::MetadriveIdm), profile());
    let failing = failing(&simulator);
    let of = |draft: &ScenarioDraft, seed| robustness(draft, &simulator, &profile, 20, Seed(seed)).unwrap();
    let all: Vec<_> = failing.iter().map(|draft| of(draft, 1)).collect();
    assert!(failing.iter().zip(&all).take(10).all(|(draft, found)| of(draft, 1) == *found), "the same twice");
    assert!(all.iter().all(|found| found.failed <= found.tries && found.crashed <= found.tries));
    let share = |marginal: bool| {
        let of: Vec<f64> = all.iter().filter(|found| found.is_marginal() == marginal).map(|f| f.share()).collect();
        of.iter().sum::<f64>() / of.len() as f64
    };
    let marginal = all.iter().filter(|found| found.is_marginal()).count();
    println!("{marginal} of {FAILURES} live on little, share {:.2}; the others {:.2}", share(true), share(false));
    assert!(marginal > 0 && share(true) < share(false) - 0.2);
    // The ego in the way of somebody far deeper than any change: nothing undoes it.
    assert!(all.iter().any(|found| found.share() == 1.0));
}

/// A car crosses in front of an ego that does not look to the side. Only a contact is a failure.
fn crossing() -> (ScenarioDraft, SystemProfile) {
    let json = r#"{
        "format": "recrash.scenario/1", "id": "crossing", "source": {}, "duration_s": 12.0,
        "map": { "type": "X", "lanes": 1, "lane_width_m": 3.5, "approach_m": 60.0, "arm_m": 100.0 },
        "environment": { "lighting": "daylight", "weather": "clear", "surface": "dry" },
        "ego": { "lane": 0, "turn": "straight", "s_m": 5.0, "speed_mps": 8.0, "target_speed_mps": 8.0 },
        "partners": [{
            "id": "cp1", "kind": "passenger_car", "approach": "left", "turn": "straight", "lane_offset": 0,
            "start": { "arrival_gap_s": 0.0 }, "speed_mps": 8.0,
            "policy": { "type": "sudden_brake", "target_speed": 8.0, "brake_step": 0, "brake_steps": 0 }
        }]
    }"#;
    let mut profile = profile();
    profile.failure.min_gap_m = 0.0;
    (recrash_roads::read_draft(json).expect("a draft").value, profile)
}

#[test]
fn a_contact_of_millimetres_that_one_physics_step_shows_is_marked_and_a_robust_one_is_not() {
    let (middle, profile) = crossing();
    let simulator = Native::new(Ego::MetadriveIdm);
    let later = |by_s: f64| nudged(&middle, Who::Partner(0), Nudge::Later(by_s));
    let run = |by_s: f64| {
        let scenario = recrash_roads::check(later(by_s)).expect("it may be run").value;
        run_scenario(&scenario, &simulator, &profile, None).expect("it never fails")
    };
    // Up to where the other comes just late enough, to a nanosecond.
    let (mut fails_s, mut passes_s) = (0.0, 3.0);
    assert!(run(fails_s).failed() && !run(passes_s).failed());
    for _ in 0..32 {
        let between_s = 0.5 * (fails_s + passes_s);
        *(if run(between_s).failed() { &mut fails_s } else { &mut passes_s }) = between_s;
    }
    // They touch by less than 5 mm: with sides that much shorter they do not.
    let grazed = run(fails_s);
    let (other, _, ego_state, other_state) = grazed.rollout.first_ego_contact().expect("they touch");
    let shorter = |actor: usize, state: &ActorState| {
        let track = &grazed.rollout.actors[actor];
        OrientedBox::new(state.pose(), track.length_m - 0.005, track.width_m - 0.005)
    };
    assert!(!shorter(0, &ego_state).overlaps(&shorter(other, &other_state)));
    let find = |by_s: f64| robustness(&later(by_s), &simulator, &profile, 40, Seed(1)).expect("it never fails");
    let artefact: Robustness = find(fails_s);
    let scenario = recrash_roads::check(later(fails_s)).expect("it may be run").value;
    let gaps: Vec<f64> = artefact
        .lives_on_step
        .iter()
        .map(|&substeps| run_scenario_in(&scenario, &simulator, &profile, substeps).expect("it never fails"))
        .map(|run| run.expect("it can").metrics.partners[0].min_gap.value)
        .collect();
    println!("{artefact:?}, gaps {gaps:?} m");
    assert!(artefact.is_step_artefact() && !artefact.is_robust());
    assert!(!artefact.lives_on_step.contains(&Substeps::default()));
    assert!(gaps.iter().all(|gap| *gap > 0.0), "it passes there");
    let robust = find(0.0);
    println!("{robust:?}");
    assert!(!robust.is_step_artefact() && !robust.is_marginal() && robust.is_robust());
    assert!(robust.other_steps > robust.tries / 2 && robust.other_steps < robust.tries);
}

#[test]
fn a_search_for_severity_takes_the_worse_contact_and_one_for_failures_does_not_ask() {
    let (simulator, profile) = (Native::new(Ego::MetadriveIdm), profile());
    let run = |scenario: &recrash_roads::Scenario| run_scenario(scenario, &simulator, &profile, None).unwrap();
    let scenario = (0..)
        .map(|number| random_scenario(14, number))
        .find(|scenario| run(scenario).severity.is_some())
        .expect("one that crashes");
    let first = run(&scenario);
    let objective = |aim: Aim, delta_v_mps: f64| {
        let judge = |_: &recrash_roads::Scenario| {
            let mut worse = first.clone();
            let severity = worse.judgement.severity.as_mut().expect("it crashes");
            (severity.first.delta_v_mps, severity.second.delta_v_mps) = (delta_v_mps, 1.0);
            Ok(worse)
        };
        Scoring::of(&[], |_| Ok(scenario.clone()), judge, &first).aiming_at(aim).score(&[]).objective
    };
    assert_eq!(objective(Aim::Failure, 9.0), objective(Aim::Failure, 3.0));
    assert!((objective(Aim::Severity, 3.0) - objective(Aim::Severity, 9.0) - 6.0).abs() < 1e-9);
    // A contact of any harm is nearer to what is looked for than a gap.
    assert!(objective(Aim::Severity, 0.0) < 0.1);
}

#[test]
fn who_was_parked_is_not_taken_over_from_and_fails_nothing() {
    let profile = profile();
    let mut crashes = 0;
    for number in 0..60 {
        let mut draft = random_scene(5, number).draft().clone();
        if draft.ego.recorded.is_none() {
            continue;
        }
        (draft.source.origin, draft.ego.handover_s) = (Some(Origin::Own), None);
        let scenario = recrash_roads::check(draft).unwrap().value;
        let run = |ego: Ego| run_scenario(&scenario, &Native::new(ego), &profile, None).unwrap();
        let recorded = run(Ego::Recorded);
        crashes += usize::from(recorded.finding_kinds().into_iter().any(FindingKind::is_failure));
        assert!(recorded.parked && !recorded.failed() && recorded.failures().next().is_none());
        for ego in Ego::DRIVERS {
            assert_eq!(run(ego), recorded, "{}: nobody takes over", scenario.draft().id);
        }
    }
    assert!(crashes > 0, "one of them crashes as recorded");
}

#[test]
fn a_gap_counts_in_a_search_once_somebody_came_nearer() {
    let (simulator, profile) = (Native::new(Ego::MetadriveIdm), profile());
    let run = |scenario: &recrash_roads::Scenario| run_scenario(scenario, &simulator, &profile, None).unwrap();
    let scored = |scenario: &recrash_roads::Scenario, run: &JudgedRun| {
        Scoring::of(&[], |_| Ok(scenario.clone()), |_| Ok(run.clone()), run).score(&[])
    };
    let alone = |run: &JudgedRun| run.rollout.actors.iter().filter(|track| track.role == Role::Partner).count() == 1;
    let (scenario, met) = (0..)
        .map(|number| random_scenario(14, number))
        .map(|scenario| (run(&scenario), scenario))
        .find(|(run, _)| alone(run) && run.failures().eq([FindingKind::NearMiss]))
        .map(|(run, scenario)| (scenario, run))
        .expect("one that comes too near");
    assert_eq!(scored(&scenario, &met).min_gap, met.metrics.min_gap);
    assert!(scored(&scenario, &met).failed && scored(&scenario, &met).objective < 900.0);
    // The two stand so near from the beginning: nothing is found about the ego, and nearer would be no better.
    let time_s = met.metrics.min_gap.expect("measured").time_s;
    let mut rollout = met.rollout.clone();
    for track in &mut rollout.actors {
        let there = track.states[(time_s * 10.0).round() as usize];
        track.states.fill(there);
    }
    let stood = judge(&scenario, rollout, &profile, None);
    assert_eq!(stood.min_gap_m(), met.min_gap_m());
    let score = scored(&scenario, &stood);
    assert!(!score.failed && score.min_gap.is_none() && score.objective > 900.0, "{score:?}");
}

#[test]
fn a_failure_is_unavoidable_only_where_every_ego_touches_the_same_one() {
    let (system, profile) = (Native::new(Ego::MetadriveIdm), profile());
    let egos = [Ego::Idm, Ego::Reference];
    let others: Vec<Box<dyn Simulator>> = egos.iter().map(|&ego| Box::new(Native::new(ego)) as _).collect();
    let mut of = [0; FailureClass::ALL.len()];
    for draft in failing(&system) {
        let scenario = recrash_roads::check(draft).unwrap().value;
        let failed = run_scenario(&scenario, &system, &profile, None).unwrap();
        let (found, _) = triage(&scenario, &failed, &profile, &others).unwrap();
        of[FailureClass::ALL.iter().position(|&class| class == found.class).unwrap()] += 1;
        // Asked of the rollouts, and not of the findings.
        let touched = |run: &JudgedRun| run.rollout.first_ego_contact().map(|(other, ..)| other);
        let alike =
            |ego| touched(&run_scenario(&scenario, &Native::new(ego), &profile, None).unwrap()) == touched(&failed);
        if found.class == FailureClass::Unavoidable && touched(&failed).is_some() {
            assert!(egos.into_iter().all(alike), "{}", scenario.draft().id);
        }
    }
    println!("of {FAILURES} failures: {:?}", FailureClass::ALL.iter().zip(of).collect::<Vec<_>>());
    assert!(of.iter().filter(|count| **count > 0).count() >= 3, "{of:?}");
}

#[test]
fn who_touches_another_fails_otherwise() {
    let (system, profile) = (Native::new(Ego::MetadriveIdm), profile());
    let mut runs = (0..).map(|number| run_scenario(&random_scenario(14, number), &system, &profile, None).unwrap());
    let crash = runs.find(|run| run.metrics.contact.is_some()).unwrap();
    assert_eq!(Fared::of(&crash, &crash), Fared::Alike);
    let mut other = crash.clone();
    other.judgement.metrics.contact.as_mut().unwrap().actor += 1;
    assert_eq!(Fared::of(&crash, &other), Fared::Otherwise);
    other.judgement.findings.clear();
    assert_eq!(Fared::of(&crash, &other), Fared::Avoids);
    let sentence = String::new();
    let braking =
        Finding { kind: FindingKind::BrakingBeyondTyres, time_s: 1.0, value: 15.0, threshold: 9.81, sentence };
    other.judgement.findings.push(braking);
    assert_eq!(Fared::of(&crash, &other), Fared::BeyondTyres);
    // Who came too near to one fails alike where the other ego touches that one, and not where it crashes with anybody.
    let nears = |run: &JudgedRun| run.first_crash().is_none() && run.failures().eq([FindingKind::NearMiss]);
    let near = runs.find(nears).unwrap();
    let gaps = near.metrics.partners.iter();
    let nearest = gaps.min_by(|a, b| a.min_gap.value.total_cmp(&b.min_gap.value)).unwrap().actor;
    let mut other = crash.clone();
    other.judgement.metrics.contact.as_mut().unwrap().actor = nearest;
    assert_eq!(Fared::of(&near, &other), Fared::Alike);
    other.judgement.metrics.contact.as_mut().unwrap().actor = nearest + 1;
    assert_eq!(Fared::of(&near, &other), Fared::Otherwise);
}
