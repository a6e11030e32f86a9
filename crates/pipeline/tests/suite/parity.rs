//! Both simulators side by side, with a MetaDrive that fails everywhere, and with a real one where
//! `RECRASH_METADRIVE_PYTHON` names an interpreter that has it.

use recrash_lab::judge;
use recrash_lab::parity::{Agreement, Pair};
use recrash_metadrive::{Drive, Metadrive};
use recrash_model::rollout::Rollout;
use recrash_pipeline::{
    NoProgress, OpenLoopRequest, Options, Parity, ParityRequest, ParitySource, PipelineError, Resources, Stage, Suite,
    load_profile, open_loop, parity, run_stage,
};
use recrash_roads::Scenario;
use recrash_sim::Ego;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn request(source: ParitySource, python: PathBuf, out: &Path) -> ParityRequest {
    ParityRequest { source, python, workers: 2, out: out.to_owned() }
}

/// The interpreter with MetaDrive, where there is one.
fn metadrive() -> Option<PathBuf> {
    recrash_testing::named_by("RECRASH_METADRIVE_PYTHON")
}

fn suite(dir: &Path, options: Options) {
    let suite = Suite::open(dir, options, Resources::default()).expect("a suite");
    for stage in Stage::ALL {
        run_stage(&suite, stage, &NoProgress).expect("the sample runs");
    }
}

fn shown(parity: &Parity) -> String {
    parity.tables().iter().map(|table| format!("{}\n{:#?}\n", table.caption, table.rows)).collect()
}

#[test]
fn without_metadrive_it_is_told_in_one_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = ParitySource::Random { count: 1, seed: 1 };
    let error = parity(&request(source, "no-such-python".into(), folder.path()), &NoProgress).expect_err("no Python");
    assert_eq!(error.exit_code(), 3);
    assert!(error.to_string().contains("no-such-python") && !error.to_string().contains('\n'), "{error}");
}

#[test]
fn a_folder_that_is_no_suite_and_a_suite_with_another_ego_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = ParitySource::Suite { dir: folder.path().to_owned() };
    let error = parity(&request(source, "python3".into(), folder.path()), &NoProgress).expect_err("no suite");
    assert!(error.to_string().contains("it holds no suite.json"), "{error}");

    let dir = folder.path().join("suite");
    let options = Options {
        ego: Some("idm".into()),
        budget: Some(1),
        tune_budget: 1,
        profile: "paper".into(),
        ..Options::default()
    };
    suite(&dir, options);
    let source = ParitySource::Suite { dir };
    let error = parity(&request(source, "python3".into(), folder.path()), &NoProgress).expect_err("another ego");
    assert!(matches!(error, PipelineError::BadInput { .. }) && error.to_string().contains("is idm"), "{error}");
}

#[cfg(unix)]
#[test]
fn scenarios_that_metadrive_fails_on_count_as_disagreeing_and_the_results_are_written() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a folder");
    let (draft, python) = (folder.path().join("draft"), folder.path().join("python"));
    let hello = r#"{"hello":{"python":"3.11.7","metadrive":"0.4.3","problem":null}}"#;
    let program =
        format!("#!/bin/sh\nhead -c \"$3\" >/dev/null\necho '{hello}'\nread line\necho 'no memory' >&2\nexit 1\n");
    // Written aside and renamed: a file still open for writing cannot be started.
    std::fs::write(&draft, program).expect("a writable folder");
    std::fs::set_permissions(&draft, std::fs::Permissions::from_mode(0o755)).expect("its owner's");
    std::fs::rename(&draft, &python).expect("the same folder");

    let out = folder.path().join("parity");
    let source = ParitySource::Random { count: 2, seed: 1 };
    let result = parity(&request(source, python, &out), &NoProgress).expect("failures are data");
    assert!(!result.passed());
    assert_eq!((result.agreement.pairs, result.agreement.errors, result.agreement.same_verdict), (2, 2, 0));
    let told = result.pairs[0].error.as_deref().unwrap_or_default();
    assert!(told.contains("random-0000") && told.contains("no memory"), "{told}");
    for file in ["parity.json", "parity.csv", "parity.html", "worst/scene-0000.json"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    let csv = std::fs::read_to_string(out.join("parity.csv")).expect("text");
    assert_eq!(csv.lines().count(), 3);
}

#[test]
fn random_scenarios_agree_and_any_number_of_workers_gives_the_same_bytes() {
    let Some(python) = metadrive() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let source = ParitySource::Random { count: 25, seed: 11 };
    let (two, one) = (folder.path().join("two"), folder.path().join("one"));
    let result = parity(&request(source, python.clone(), &two), &NoProgress).expect("MetaDrive runs");
    println!("{}", shown(&result));
    assert!(result.passed(), "{}", shown(&result));
    assert_eq!(result.agreement.errors, 0);

    let few = ParitySource::Random { count: 5, seed: 11 };
    let alone = ParityRequest { workers: 1, ..request(few, python, &one) };
    let first = parity(&alone, &NoProgress).expect("MetaDrive runs");
    assert_eq!(first.pairs[..], result.pairs[..5]);
    let page = std::fs::read_to_string(two.join("parity.html")).expect("text");
    assert!(page.contains("data-case=\"9\"") && page.contains("Side by side"));
}

/// A street with a bend, far from where the map begins, and a car that stands on it.
fn street(ego: Value, car: Value) -> Scenario {
    let draft = json!({
        "format": "recrash.scenario/2", "id": "street", "source": {}, "duration_s": 4,
        "map": {"type": "G", "roads": [{"id": "main", "start": {"at": {"x_m": 200, "y_m": 0, "heading_deg": 30}},
            "line": [{"straight": {"length_m": 40}}, {"arc": {"length_m": 80, "radius_m": 60, "to": "left"}}],
            "right": [{"kind": "driving"}, {"kind": "sidewalk"}], "left": [{"kind": "driving"}]}]},
        "ego": ego, "actors": [{"id": "cp", "kind": "van", "plan": car}],
    });
    let draft = recrash_roads::read_draft(&draft.to_string()).expect("a draft").value;
    recrash_roads::check(draft).expect("a scenario").value
}

#[test]
fn the_ego_takes_over_and_sees_who_is_there_in_the_same_step_on_both() {
    let Some(python) = metadrive() else { return };
    let metadrive = Metadrive::start(recrash_metadrive::Options::new(python)).expect("it starts");
    // From the recorded driver, in a bend, to full brakes a step later: for somebody who appears then.
    let handed_over = json!({"route": ["main+"], "target_speed_mps": 9, "handover_s": 2.0,
        "recorded": {"start": {"road": "main+", "s_m": 30}, "speed_mps": 9, "course": [{"lanes": {"roads": ["main+"]}}]}});
    let appears = json!({"start": {"road": "main+", "s_m": 72}, "appears_s": 2.0});
    // Full brakes in the first step.
    let own = json!({"route": ["main+"], "s_m": 8, "speed_mps": 9, "target_speed_mps": 9});
    let waits = json!({"start": {"road": "main+", "s_m": 34}});
    for (scenario, first) in [(street(handed_over, appears), 21), (street(own, waits), 0)] {
        let ours = recrash_sim::simulate(&scenario, Ego::MetadriveIdm);
        let theirs = metadrive.simulate(&scenario, &Drive::MetadriveIdm).expect("it runs");
        let states = ours.actors[0].states.iter().zip(&theirs.actors[0].states);
        for (step, (here, there)) in states.enumerate().take(first + 16) {
            let apart = here.position().distance(there.position());
            assert!(apart < 0.05, "step {step}: {apart} m, {here:?} and {there:?}");
        }
        let brakes = |rollout: &Rollout| rollout.actors[0].states.iter().position(|state| state.throttle == -1.0);
        assert_eq!((brakes(&ours), brakes(&theirs)), (Some(first), Some(first)));
    }
}

/// Every case of the gallery that MetaDrive can hold, with its policy in the ego's seat.
#[test]
fn the_gallery_agrees() {
    let Some(python) = metadrive() else { return };
    let metadrive =
        Metadrive::start(recrash_metadrive::Options { workers: 2, ..recrash_metadrive::Options::new(python) });
    let metadrive = metadrive.expect("it starts");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let folders = std::fs::read_dir(root).expect("there are cases").map(|entry| entry.expect("readable").path());
    let files =
        folders.filter(|folder| folder.is_dir()).flat_map(|folder| std::fs::read_dir(folder).expect("readable"));
    let mut files: Vec<PathBuf> = files.map(|entry| entry.expect("readable").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    let read = |file: &PathBuf| {
        let text = std::fs::read_to_string(file).expect("readable");
        recrash_roads::check(recrash_roads::read_draft(&text).expect("a draft").value).expect("a scenario").value
    };
    let cases: Vec<Scenario> = files.iter().map(read).collect();
    let profile = load_profile("paper").expect("it is there");
    let (mut pairs, mut refused) = (Vec::new(), Vec::new());
    let theirs = metadrive.simulate_all(&cases, &Drive::MetadriveIdm, &|_| {});
    for (case, theirs) in cases.iter().zip(theirs) {
        match theirs {
            Err(error) if error.is_refused() => refused.push(error.to_string()),
            theirs => {
                let ours = judge(case, recrash_sim::simulate(case, Ego::MetadriveIdm), &profile, None);
                let theirs = theirs.map(|rollout| judge(case, rollout, &profile, None));
                let theirs = theirs.as_ref().map_err(ToString::to_string);
                pairs.push(Pair::of(case.draft().id.clone(), case.draft(), &ours, theirs));
            }
        }
    }
    let other: Vec<_> = pairs.iter().filter(|pair| !pair.same_verdict() || !pair.same_gap()).collect();
    for pair in &other {
        println!("{}: {}", pair.name, pair.remark());
    }
    let all = Agreement::of(&pairs);
    println!("{} cases, {} refused: {refused:#?}\n{all:?}", cases.len(), refused.len());
    assert!(all.pairs * 100 >= 85 * cases.len() && all.errors == 0, "{refused:#?}");
    assert!(all.same_verdict * 100 >= 95 * all.pairs && all.same_gap * 100 >= 90 * all.pairs, "{all:?}");
}

/// Somebody beside the lanes is nobody to follow, and is one as soon as the lane begins under him.
#[test]
fn who_comes_from_the_sidewalk_is_seen_by_both_when_on_the_lane() {
    let Some(python) = metadrive() else { return };
    let metadrive = Metadrive::start(recrash_metadrive::Options::new(python)).expect("it starts");
    let own = json!({"route": ["main+"], "s_m": 2, "speed_mps": 6, "target_speed_mps": 6});
    let crosses = json!({"start": {"road": "main+", "s_m": 30, "t_m": 2.6, "heading_deg": 90},
        "course": [{"path": {"points": [[225.98, 15.0], [222.0, 22.0]]}}],
        "acts": [{"when": {"time_s": 1.0}, "do": {"speed": {"to_mps": 1.4, "rate_mps2": 1.5}}}]});
    let mut scenario = street(own, crosses).draft().clone();
    scenario.actors[0].kind = recrash_model::kinds::PartnerKind::Pedestrian;
    let scenario = recrash_roads::check(scenario).expect("a scenario").value;
    let ours = recrash_sim::simulate(&scenario, Ego::MetadriveIdm);
    let theirs = metadrive.simulate(&scenario, &Drive::MetadriveIdm).expect("it runs");
    let brakes = |rollout: &Rollout| rollout.actors[0].states.iter().position(|state| state.throttle < -0.5);
    let (here, there) = (brakes(&ours), brakes(&theirs));
    assert!(here.is_some_and(|step| step > 10) && here == there, "{here:?} {there:?}");
}

#[test]
fn the_vehicle_alone_agrees() {
    let Some(python) = metadrive() else { return };
    let result = open_loop(&OpenLoopRequest { count: 36, seed: 5, python, workers: 1 }, &NoProgress).expect("it runs");
    println!("{result:#?}");
    assert!(result.limits.iter().all(|limit| limit.apart_m.len() == 12));
    assert!(result.passed(), "{result:#?}");
}

#[test]
fn failures_of_a_suite_are_confirmed() {
    let Some(python) = metadrive() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let dir = folder.path().join("suite");
    suite(&dir, Options { budget: Some(6), tune_budget: 60, profile: "paper".into(), ..Options::default() });
    let out = folder.path().join("parity");
    let result = parity(&request(ParitySource::Suite { dir }, python, &out), &NoProgress).expect("MetaDrive runs");
    println!("{}", shown(&result));
    assert!(result.agreement.failed_natively >= 3, "{}", shown(&result));
    assert!(result.passed(), "{}", shown(&result));
}
