//! What the fuzz target checks, once over every input of it: the short run of fuzzing that every build does.

#[path = "../../../../fuzz/checks/scenario.rs"]
mod scenario;

#[test]
fn scenario_files() {
    recrash_testing::inputs::over_all("scenario", scenario::check);
}
