//! `recrash sweep`: the table, and that it does not depend on the number of threads.
#![cfg(feature = "parquet")]

use crate::common::{Place, SMALL, copy, recrash};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn crossing() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("crates/cli");
    root.join("crates/pipeline/benches/crossing.json").display().to_string()
}

struct Case {
    folder: tempfile::TempDir,
}

impl Case {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder") }
    }

    fn out(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Sweeps the crossing into a file; gives standard output.
    fn sweep(&self, name: &str, more: &[&str]) -> String {
        let out = self.out(name).display().to_string();
        let crossing = crossing();
        let arguments = [&["sweep", &crossing, "--out", &out, "--json"], more].concat();
        let output = recrash(&arguments).output().expect("it runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// The rows of a table.
    fn rows(&self, name: &str) -> Vec<BTreeMap<String, Field>> {
        let reader = SerializedFileReader::new(std::fs::File::open(self.out(name)).expect("a file")).expect("Parquet");
        let rows = reader.get_row_iter(None).expect("rows");
        rows.map(|row| row.expect("a row").into_columns().into_iter().collect()).collect()
    }
}

const GAP: &str = "/partners/0/start/arrival_gap_s";

#[test]
fn the_same_bytes_for_any_number_of_threads_and_others_for_another_seed() {
    let case = Case::new();
    let bytes = |name: &str, more: &[&str]| {
        case.sweep(name, &[&["-n", "3000"], more].concat());
        std::fs::read(case.out(name)).expect("a file")
    };
    let one = bytes("one.parquet", &["--threads", "1"]);
    assert!(bytes("eight.parquet", &["--threads", "8"]) == one);
    assert!(bytes("seed.parquet", &["--seed", "2"]) != one);
}

#[test]
fn a_row_holds_what_was_drawn_and_what_came_of_it() {
    let case = Case::new();
    let vary = format!("{GAP}=-1:2.5");
    let summary = case.sweep("a.parquet", &["-n", "500", "--vary", &vary]);
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    let rows = case.rows("a.parquet");
    assert_eq!(rows.len(), 500);
    let mut verdicts: BTreeMap<String, u64> = BTreeMap::new();
    for (number, row) in rows.iter().enumerate() {
        assert_eq!(row["rollout"], Field::Long(number as i64));
        let Field::Double(gap_s) = row[GAP] else { panic!("{row:?}") };
        assert!((-1.0..2.5).contains(&gap_s));
        let Field::Str(verdict) = &row["verdict"] else { panic!("{row:?}") };
        *verdicts.entry(verdict.clone()).or_default() += 1;
        if verdict == "contact" {
            assert_eq!((&row["min_gap_m"], &row["failed"]), (&Field::Double(0.0), &Field::Bool(true)));
            assert!(matches!(row["contact_kind"], Field::Str(_)));
        }
        assert_eq!(verdict == "refused", row["state_hash"] == Field::Null);
    }
    assert_eq!(serde_json::to_value(&verdicts).expect("JSON"), summary["verdicts"]);
    assert!(verdicts["contact"] > 10 && verdicts.len() > 1, "{verdicts:?}");
}

#[test]
fn the_scenario_of_a_row_gives_the_states_of_the_row() {
    let case = Case::new();
    let vary = format!("{GAP}=0:2");
    case.sweep("a.parquet", &["-n", "40", "--vary", &vary]);
    case.sweep("one.json", &["-n", "40", "--vary", &vary, "--rollout", "17"]);
    let file = case.out("one.json").display().to_string();
    let shown = recrash(&["simulate", &file, "--json"]).output().expect("it runs").stdout;
    let run: serde_json::Value = serde_json::from_slice(&shown).expect("JSON");
    let Field::Str(hash) = &case.rows("a.parquet")[17]["state_hash"] else { panic!("no hash") };
    assert_eq!(run["rollout"]["state_hash"], hash.as_str());
}

#[test]
fn a_killed_or_failed_sweep_leaves_the_old_file() {
    let case = Case::new();
    case.sweep("a.parquet", &["-n", "10"]);
    let before = std::fs::read(case.out("a.parquet")).expect("a file");
    let out = case.out("a.parquet").display().to_string();
    let mut child = crate::common::plain_recrash()
        .args(["sweep", &crossing(), "-n", "100000000", "--threads", "1", "--out", &out, "--quiet"])
        .spawn()
        .expect("it starts");
    std::thread::sleep(std::time::Duration::from_millis(500));
    child.kill().expect("it still runs");
    child.wait().expect("it ends");
    assert!(std::fs::read(case.out("a.parquet")).expect("a file") == before);
    case.sweep("a.parquet", &["-n", "10"]);
    let left: Vec<_> = std::fs::read_dir(case.folder.path()).expect("a folder").collect();
    assert_eq!(left.len(), 1, "nothing else is left: {left:?}");
}

#[test]
fn a_deleted_scenario_of_a_suite_is_told() {
    let case = Case::new();
    let (suite, out) = (case.out("s").display().to_string(), case.out("a.parquet").display().to_string());
    copy(&Place::made(&SMALL).path("suite"), &case.out("s"));
    let sweep = |more: &[&str]| {
        recrash(&[&["sweep", &suite, "-n", "4", "--out", &out], more].concat()).output().expect("it runs")
    };
    assert!(!String::from_utf8_lossy(&sweep(&[]).stderr).contains("not swept"));
    let names = std::fs::read_dir(case.out("s/4-scenarios"))
        .expect("it was there")
        .map(|entry| entry.expect("a name").file_name());
    let mut ids: Vec<String> =
        names.map(|name| name.to_string_lossy().split('.').next().expect("an id").to_owned()).collect();
    ids.sort();
    let deleted = ids[0].as_str();
    std::fs::remove_file(case.out(&format!("s/6-tuned/{deleted}.json"))).expect("it was there");
    let told = String::from_utf8_lossy(&sweep(&[]).stderr).into_owned();
    assert!(told.contains("1 scenarios without a tuned file are not swept") && told.contains(deleted), "{told}");
    let summary: serde_json::Value = serde_json::from_slice(&sweep(&["--json"]).stdout).expect("JSON");
    assert_eq!(summary["passed_over"], serde_json::json!([deleted]));
}

#[test]
fn a_scenario_in_which_nothing_may_move_is_skipped_and_told() {
    let case = Case::new();
    let (suite, out) = (case.out("s").display().to_string(), case.out("a.parquet").display().to_string());
    copy(&Place::made(&SMALL).path("suite"), &case.out("s"));
    let sweep = |more: &[&str]| {
        recrash(&[&["sweep", &suite, "-n", "4", "--out", &out], more].concat()).output().expect("it runs")
    };
    let logs = std::fs::read_dir(case.out("s/6-tuned")).expect("a folder").map(|entry| entry.expect("a name").path());
    let mut logs: Vec<PathBuf> = logs.filter(|path| path.to_string_lossy().ends_with(".search.json")).collect();
    logs.sort();
    let fix = |path: &Path| {
        let mut log: serde_json::Value = serde_json::from_slice(&std::fs::read(path).expect("a log")).expect("JSON");
        log["parameters"] = serde_json::json!([]);
        std::fs::write(path, log.to_string()).expect("written");
    };
    fix(&logs[0]);
    let id = logs[0].file_name().expect("a name").to_string_lossy().replace(".search.json", "");
    let output = sweep(&["--json"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.success() && told.contains("1 scenarios in which no number may move") && told.contains(&id),
        "{told}"
    );
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&summary["fixed"], &summary["rollouts"]), (&serde_json::json!([id]), &serde_json::json!(4)));
    logs[1..].iter().for_each(|path| fix(path));
    let output = sweep(&[]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(3) && told.contains("nothing varies in"), "{told}");
}

#[test]
fn what_cannot_vary_is_refused_with_its_pointer() {
    let case = Case::new();
    let out = case.out("a.parquet").display().to_string();
    for (vary, says) in [("/partners/7/speed_mps=1:2", "/partners/7/speed_mps"), ("/id=1:2", "no such number")] {
        let output = recrash(&["sweep", &crossing(), "--out", &out, "--vary", vary]).output().expect("it runs");
        assert_eq!(output.status.code(), Some(3));
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(errors.contains(says), "{errors}");
    }
    let output = recrash(&["sweep", &crossing(), "--vary", "speed=1:2"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_damaged_log_of_the_search_is_told_and_not_swept_around() {
    let case = Case::new();
    std::fs::copy(crossing(), case.out("x.json")).expect("copied");
    std::fs::write(case.out("x.search.json"), "{\"format\": \"recr").expect("written");
    let (file, out) = (case.out("x.json").display().to_string(), case.out("x.parquet").display().to_string());
    let output = recrash(&["sweep", &file, "-n", "2", "--out", &out]).output().expect("it runs");
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{error}");
    assert!(error.contains("x.search.json") && !case.out("x.parquet").exists(), "{error}");
}
