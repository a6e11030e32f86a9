//! The page in a real browser: headless Chromium runs `tests/browser/check.mjs` on a made-up suite, a hostile one
//! and an empty one. Needs node, Chromium and `npm ci` in `tests/browser`; says so where one is missing.

use crate::suite;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What stands in the way of running it.
fn missing(folder: &Path, chromium: &Path) -> Option<&'static str> {
    if !folder.join("node_modules/playwright-core").is_dir() {
        Some("needs `npm ci` in crates/report/tests/browser")
    } else if !chromium.exists() {
        Some("needs Chromium; set CHROMIUM to its path")
    } else if Command::new("node").arg("--version").output().is_err() {
        Some("needs node")
    } else {
        None
    }
}

#[test]
fn the_page_works_in_a_browser() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser");
    let chromium = std::env::var_os("CHROMIUM").map_or_else(|| PathBuf::from("/usr/bin/chromium"), PathBuf::from);
    if let Some(why) = missing(&folder, &chromium) {
        return recrash_testing::skip(why);
    }
    let mut odd = suite::demo();
    odd.title = "</script><img src=x onerror=alert(1)>".to_owned();
    for record in &mut odd.records.records {
        record.narrative = "from the left </script><img src=x onerror=alert(1)> against a red light".to_owned();
    }
    for case in &mut odd.cases {
        case.scenario_id = "</script><img src=x onerror=alert(1)>".to_owned();
    }
    odd.cases[1].after = None;
    odd.cases[1].before.as_mut().unwrap().run.rollout.actors.clear();
    odd.cases[2].before = None;
    odd.cases[3].after.as_mut().unwrap().series.partners.clear();
    odd.cases[4].tune_log.as_mut().unwrap().points.clear();
    let mut empty = suite::demo();
    empty.cases.clear();
    empty.selection.map.clear();
    let here = tempfile::tempdir().unwrap();
    for (name, view) in [("demo", suite::demo()), ("odd", odd), ("empty", empty)] {
        let page = here.path().join(format!("{name}.html"));
        std::fs::write(&page, recrash_report::html(&view)).unwrap();
        let mut check = Command::new("node");
        let output = check.arg(folder.join("check.mjs")).arg(&page).arg("--chromium").arg(&chromium).output().unwrap();
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    }
}
