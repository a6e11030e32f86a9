//! What the fuzz target checks, once over every file of its corpus: the short run of fuzzing that every build does.

#[path = "../../../../fuzz/checks/scenario.rs"]
mod scenario;

#[test]
fn scenario_files() {
    for bytes in files("corpus") {
        for part in 1..=16 {
            scenario::check(&bytes[..bytes.len() * part / 16]);
        }
    }
    files("found").iter().for_each(|bytes| scenario::check(bytes));
}

fn files(kind: &str) -> Vec<Vec<u8>> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz").join(kind).join("scenario");
    let mut files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 4, "{}: {} files", folder.display(), files.len());
    files.iter().map(|file| std::fs::read(file).unwrap()).collect()
}
