//! The pictures of `docs/gallery`: one of each case, as its recorded driver drove.

use recrash_pipeline::{FileRequest, Patience, SimulatorKind, simulate_file};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// All pictures together are no larger: people look at them over a network. [bytes]
const MOST_BYTES: usize = 1_500_000;

fn listed(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a readable folder").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == ending));
    files.sort();
    files
}

/// To renew them after a change of the model or of the drawing run with `RECRASH_RENEW_GOLDENS=1`; that run fails.
#[test]
fn every_case_has_its_picture() {
    let root = recrash_testing::root();
    let gallery = root.join("docs/gallery");
    let renew = std::env::var_os("RECRASH_RENEW_GOLDENS").is_some();
    let drawn = tempfile::tempdir().expect("a folder");
    let (mut names, mut bytes) = (BTreeSet::new(), 0);
    for folder in ["acts", "control", "crashes", "kinds", "roads"] {
        for case in listed(&root.join("cases").join(folder), "json") {
            let name = format!("{folder}-{}.svg", case.file_stem().expect("a name").to_string_lossy());
            let picture = drawn.path().join(&name);
            // Without a recorded driver the name `recorded` is refused; there the built-in one drives.
            let recorded = fs::read_to_string(&case).expect("a case").contains("\"recorded\"");
            let request = FileRequest {
                scenario: &case,
                profile: "paper",
                ego: Some(if recorded { "recorded" } else { "idm" }),
                simulator: SimulatorKind::Native,
                python: Path::new(""),
                patience: Patience::default(),
                rollout: None,
                picture: Some(&picture),
            };
            simulate_file(&request).unwrap_or_else(|error| panic!("{name}: {error}"));
            let is = fs::read_to_string(&picture).expect("it was drawn");
            bytes += is.len();
            if renew {
                fs::create_dir_all(&gallery).expect("a folder");
                fs::write(gallery.join(&name), &is).expect("a picture");
            }
            let was = fs::read_to_string(gallery.join(&name)).unwrap_or_default();
            assert!(
                is == was,
                "{name} is drawn otherwise than docs/gallery has it; RECRASH_RENEW_GOLDENS=1 renews all"
            );
            names.insert(name);
        }
    }
    let committed = listed(&gallery, "svg")
        .into_iter()
        .map(|file| file.file_name().expect("a name").to_string_lossy().into_owned());
    assert_eq!(committed.collect::<BTreeSet<String>>(), names);
    assert!(bytes < MOST_BYTES, "{bytes} bytes");
    assert!(!renew, "the pictures have been renewed: look at them, then run again without RECRASH_RENEW_GOLDENS");
}
