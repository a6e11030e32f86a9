//! What is found of every case under `cases/`, with each built-in ego: a golden.

use recrash_lab::{run_scenario, situation};
use recrash_model::metrics::{CheckResult, FindingKind};
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_roads::Scenario;
use recrash_sim::{Ego, Native};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const EGOS: [Ego; 4] = [Ego::Recorded, Ego::Idm, Ego::MetadriveIdm, Ego::Reference];

fn profile() -> SystemProfile {
    toml::from_str(include_str!("../../../../profiles/open.toml")).expect("a profile")
}

/// All cases, in order of their names: paths below `cases/` without `.json`.
fn cases() -> BTreeMap<String, Scenario> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let inside = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
    };
    let files = inside(&root).into_iter().filter(|path| path.is_dir()).flat_map(|folder| inside(&folder));
    let mut cases = BTreeMap::new();
    for file in files.filter(|file| file.extension().is_some_and(|extension| extension == "json")) {
        let name = file.strip_prefix(&root).unwrap().with_extension("").to_string_lossy().replace('\\', "/");
        let draft = recrash_roads::read_draft(&std::fs::read_to_string(&file).unwrap()).unwrap().value;
        cases.insert(name, recrash_roads::check(draft).unwrap().value);
    }
    cases
}

fn line(name: &str, ego: Ego, run: &JudgedRun) -> String {
    let mut line = format!("{name} {ego}:");
    for finding in &run.findings {
        write!(line, " {} {:.2} at {:.1} s;", finding.kind.label(), finding.value, finding.time_s).unwrap();
    }
    if run.findings.is_empty() {
        line += " nothing;";
    }
    match run.cause {
        Some(cause) => write!(line, " it {}", cause.label()).unwrap(),
        None => _ = line.pop(),
    }
    line
}

/// To renew it after a change run with `RECRASH_RENEW_GOLDENS=1`; that run fails.
#[test]
fn what_is_found_of_each_case_is_as_it_was_looked_at() {
    let (profile, mut golden, mut counts) = (profile(), String::new(), BTreeMap::<FindingKind, usize>::new());
    for (name, scenario) in cases() {
        for ego in EGOS {
            let run = run_scenario(&scenario, &Native::new(ego), &profile, None).unwrap();
            golden += &line(&name, ego, &run);
            golden += "\n";
            for finding in &run.findings {
                *counts.entry(finding.kind).or_default() += 1;
            }
        }
    }
    for (kind, count) in counts {
        writeln!(golden, "all: {} {count}", kind.label()).unwrap();
    }
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/findings.txt");
    if std::env::var_os("RECRASH_RENEW_GOLDENS").is_some() {
        std::fs::write(file, golden).unwrap();
        panic!("the golden has been renewed: look at the difference, then run again without RECRASH_RENEW_GOLDENS");
    }
    let committed = std::fs::read_to_string(file).unwrap();
    for (is, was) in golden.lines().zip(committed.lines()) {
        assert_eq!(is, was);
    }
    assert_eq!(golden.lines().count(), committed.lines().count());
}

/// Whoever passes another obstacle than the one that was hit has not met it.
#[test]
fn the_situation_is_that_of_what_was_hit_in_the_record() {
    let scenario = &cases()["kinds/24-debris-and-pothole"];
    let run = |ego: Ego| run_scenario(scenario, &Native::new(ego), &profile(), None).unwrap();
    let mut recorded = run(Ego::Recorded);
    let mut tested = run(Ego::Recorded);
    // Nobody else is there: the least gap is that to a thing.
    assert_eq!((recorded.metrics.min_gap, recorded.min_gap_m()), (None, Some(0.0)));
    recorded.judgement.metrics.obstacles_hit = vec![1];
    let met = |tested: &JudgedRun| situation(tested, &recorded).result == CheckResult::Shown;
    assert!(met(&tested));
    tested.judgement.metrics.obstacle_gaps[1].value = 20.0;
    assert!(!met(&tested), "{:?}", tested.metrics.obstacle_gaps);
}
