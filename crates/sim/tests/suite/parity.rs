//! Closed loop against MetaDrive: the six trials and 44 random scenarios over all maps, from `oracle/closed_loop.py`.

use recrash_model::geometry::Vec2;
use recrash_model::rollout::{Rollout, TerminationKind};
use recrash_model::scenario::ScenarioDraft;
use recrash_sim::{Ego, Runner, SummaryRecorder, simulate};
use serde_json::Value;

use crate::common;

/// What MetaDrive made of a scenario.
struct Reference {
    draft: ScenarioDraft,
    end: String,
    time_s: f64,
    min_gap_m: f64,
    min_gap_time_s: f64,
    /// Per actor, one position a second.
    positions: Vec<Vec<Vec2>>,
}

fn references() -> Vec<Reference> {
    let number = |value: &Value| value.as_f64().expect("a number");
    include_str!("../fixtures/closed_loop.jsonl")
        .lines()
        .map(|line| {
            let value: Value = serde_json::from_str(line).expect("JSON");
            let track = |track: &Value| {
                let points = track.as_array().expect("a track").iter();
                points.map(|point| Vec2::new(number(&point[0]), number(&point[1]))).collect()
            };
            Reference {
                draft: serde_json::from_value(value["draft"].clone()).expect("a draft"),
                end: value["end"].as_str().expect("an end").to_owned(),
                time_s: number(&value["time_s"]),
                min_gap_m: number(&value["min_gap_m"]),
                min_gap_time_s: number(&value["min_gap_time_s"]),
                positions: value["positions"].as_array().expect("positions").iter().map(track).collect(),
            }
        })
        .collect()
}

/// Greatest distance between the ego's positions on both backends.
fn ego_error(reference: &Reference, rollout: &Rollout) -> f64 {
    let native = rollout.ego_track().states.iter().step_by(10).map(|state| state.position());
    native.zip(&reference.positions[0]).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

#[test]
fn the_six_trials_go_as_in_metadrive() {
    let references = references();
    for reference in &references[..6] {
        let id = &reference.draft.id;
        assert!(id.starts_with("trial-"));
        let rollout = simulate(&common::checked(reference.draft.clone()), Ego::MetadriveIdm);
        let end = serde_json::to_value(rollout.termination.kind).expect("a word");
        assert_eq!(end, reference.end.as_str(), "{id}");
        assert!((rollout.termination.time_s - reference.time_s).abs() < 0.15, "{id}");
        assert!(ego_error(reference, &rollout) < 0.3, "{id}");
    }
}

#[test]
fn random_scenarios_end_as_in_metadrive() {
    let references = references();
    assert_eq!(references.len(), 50);
    let (mut runs, mut contact, mut gap, mut time) = (0, 0, 0, 0);
    let mut errors = Vec::new();
    let mut runner = Runner::new();
    for reference in &references {
        // The check may grow stricter after the references were made.
        let Ok(checked) = recrash_roads::check(reference.draft.clone()) else {
            println!("{}: no longer fit to run", reference.draft.id);
            continue;
        };
        let scenario = checked.value;
        runs += 1;
        let mut recorder = SummaryRecorder::new();
        let termination = runner.run(&scenario, Ego::MetadriveIdm, &mut recorder);
        let touched = reference.end == "contact";
        let reference_gap = if touched { 0.0 } else { reference.min_gap_m };
        let summary = recorder.summary;
        let same = [
            (termination.kind == TerminationKind::Contact) == touched,
            (summary.min_gap_m - reference_gap).abs() <= 0.5,
            (summary.min_gap_time_s - reference.min_gap_time_s).abs() <= 0.3,
        ];
        if same.contains(&false) {
            println!("{}: {} {reference_gap} m: {summary:?}", reference.draft.id, reference.end);
        }
        contact += usize::from(same[0]);
        gap += usize::from(same[1]);
        time += usize::from(same[2]);
        errors.push(ego_error(reference, &simulate(&scenario, Ego::MetadriveIdm)));
    }
    errors.sort_by(f64::total_cmp);
    println!("of {runs}: verdict {contact}, gap {gap}, time {time}; ego position {errors:.2?}");
    assert!(runs >= 40, "renew the references: only {runs} can still be run");
    // Issue 3 asks for 95 %, 90 % and 85 %.
    let share = |count: usize| count as f64 / f64::from(runs);
    assert!(share(contact) >= 0.96, "{contact} of {runs}");
    assert!(share(gap) >= 0.92, "{gap} of {runs}");
    assert!(share(time) >= 0.90, "{time} of {runs}");
    let median = errors[errors.len() / 2];
    assert!(median < 0.1, "{median}");
}
