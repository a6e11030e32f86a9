//! A narrative that was edited so that it contradicts its template is refused before its scenario runs.

use crate::common::{Place, SMALL, recrash};
use serde_json::Value;

#[test]
fn an_edited_narrative_that_contradicts_its_template_is_refused_with_what_is_wrong() {
    let place = Place::made(&SMALL);
    let suite = place.path("suite");
    let out = suite.to_str().unwrap();
    let narratives = std::fs::read_dir(suite.join("3-narratives")).unwrap().map(|entry| entry.unwrap().path());
    let file = narratives.filter(|path| !path.to_string_lossy().contains(".agent.")).min().unwrap();
    let mut narrative: Value = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    let facts = narrative["facts"].as_array_mut().unwrap();
    let moved = facts.iter_mut().find(|fact| fact["value"]["fact"] == "sv_movement").unwrap();
    moved["value"]["movement"] = "u_turn".into();
    std::fs::write(&file, narrative.to_string()).unwrap();
    let output = recrash(&["design", "--out", out]).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(told.contains("contradicts its template (facts[") && told.contains("SV is u-turn"), "{told}");
}
