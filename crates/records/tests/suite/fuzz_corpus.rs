//! What the fuzz targets check, once over every file of their corpus: the short run of fuzzing that every build does.

#[path = "../../../../fuzz/checks/crash_file.rs"]
mod crash_file;
#[path = "../../../../fuzz/checks/mapping.rs"]
mod mapping;

/// Runs a check over the inputs written by hand and over their beginnings, as if they had been cut; and over those that
/// fuzzing found.
fn over_corpus(target: &str, check: fn(&[u8])) {
    for bytes in files("corpus", target) {
        for part in 1..=16 {
            check(&bytes[..bytes.len() * part / 16]);
        }
    }
    files("found", target).iter().for_each(|bytes| check(bytes));
}

fn files(kind: &str, target: &str) -> Vec<Vec<u8>> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz").join(kind).join(target);
    let mut files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 4, "{}: {} files", folder.display(), files.len());
    files.iter().map(|file| std::fs::read(file).unwrap()).collect()
}

#[test]
fn crash_files() {
    over_corpus("crash_file", crash_file::check);
}

#[test]
fn mapping_files() {
    over_corpus("mapping", mapping::check);
}
