//! What the fuzz target checks, once over every input of it: the short run of fuzzing that every build does.

#[path = "../../../../fuzz/checks/openscenario.rs"]
mod openscenario;

#[test]
fn openscenario_files() {
    recrash_testing::inputs::over_all("openscenario", openscenario::check);
}
