//! The commands around MetaDrive, where there is no Python at all.

use crate::common::recrash;

#[test]
fn the_doctor_tells_how_to_get_what_is_missing_and_is_content() {
    let output = recrash(&["doctor", "--python", "no-such-python"]).output().unwrap();
    let shown = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{shown}");
    for words in ["MetaDrive", "missing", "pip install metadrive-simulator==0.4.3", "native simulator"] {
        assert!(shown.contains(words), "does not say \"{words}\":\n{shown}");
    }
    let output = recrash(&["doctor", "--python", "no-such-python", "--json"]).output().unwrap();
    let items: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let python = items.as_array().unwrap().iter().find(|item| item["name"] == "Python").unwrap();
    assert_eq!(python["state"], "missing");
}

#[test]
fn parity_without_python_stops_with_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("parity");
    let arguments = ["parity", "--n", "2", "--python", "no-such-python", "--out", out.to_str().unwrap()];
    let output = recrash(&arguments).output().unwrap();
    let shown = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{shown}");
    assert!(shown.contains("cannot start Python as `no-such-python`") && shown.lines().count() == 1, "{shown}");
    assert!(!out.exists(), "nothing was written");
}
