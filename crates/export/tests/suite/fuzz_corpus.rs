//! What the fuzz target checks, once over every file of its corpus: the short run of fuzzing that every build does.

#[path = "../../../../fuzz/checks/openscenario.rs"]
mod openscenario;

#[test]
fn openscenario_files() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/openscenario");
    let mut files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 5, "{}: {} files", folder.display(), files.len());
    for file in files {
        let bytes = std::fs::read(&file).unwrap();
        for part in 1..=16 {
            openscenario::check(&bytes[..bytes.len() * part / 16]);
        }
    }
}
