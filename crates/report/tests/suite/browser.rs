//! The page in a real browser: headless Chromium runs `tests/browser/check.mjs` on a made-up suite, a hostile one,
//! an empty one, and one of two thousand scenarios. Needs node, Chromium and `npm ci` in `tests/browser`; says so where one
//! is missing.

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
    odd.suite.title = "</script><img src=x onerror=alert(1)>".to_owned();
    for record in &mut odd.suite.records.records {
        record.narrative = "from the left </script><img src=x onerror=alert(1)> against a red light".to_owned();
    }
    for (number, case) in odd.suite.cases.iter_mut().enumerate() {
        case.scenario_id = format!("</script><img src=x onerror=alert(1)> {number}");
    }
    odd.suite.cases[1].after = None;
    odd.driven[1].after = None;
    odd.driven[1].before.as_mut().unwrap().run.rollout.actors.clear();
    odd.suite.cases[2].before = None;
    odd.driven[2].before = None;
    odd.driven[3].after.as_mut().unwrap().series.partners.clear();
    odd.driven[4].tune_log.as_mut().unwrap().points.clear();
    let mut empty = suite::demo();
    empty.suite.cases.clear();
    empty.suite.selection.map.clear();
    let here = tempfile::tempdir().unwrap();
    for (name, demo) in [("demo", suite::demo()), ("odd", odd), ("empty", empty), ("large", suite::demo_of(2000))] {
        let folder_of_page = here.path().join(name);
        demo.write(&folder_of_page).unwrap();
        let page = folder_of_page.join("report.html");
        let mut check = Command::new("node");
        let output = check.arg(folder.join("check.mjs")).arg(&page).arg("--chromium").arg(&chromium).output().unwrap();
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        print!("{}", String::from_utf8_lossy(&output.stdout));
    }
}
