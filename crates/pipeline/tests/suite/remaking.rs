//! A suite that is made anew by other options, and is stopped between any two files: what the run had written by then is no edit of a
//! person's, and the next run ends with the bytes of a suite that nobody disturbed.

use recrash_pipeline::{NoProgress, Options, PipelineError, Resources, Stage, Suite, run_stage};
use std::collections::BTreeMap;
use std::io::{Error, ErrorKind};
use std::path::Path;
use std::sync::atomic::{AtomicI64, Ordering};

/// Folders with files that people may edit.
const EDITABLE: [&str; 3] = ["3-narratives", "4-scenarios", "6-tuned"];
/// Files that may still be written to them.
static LEFT: AtomicI64 = AtomicI64::new(0);

fn write_some(path: &Path, content: &[u8]) -> std::io::Result<()> {
    let is_editable = path.parent().and_then(Path::file_name).is_some_and(|name| EDITABLE.iter().any(|it| name == *it));
    if is_editable && LEFT.fetch_sub(1, Ordering::SeqCst) <= 0 {
        return Err(Error::from(ErrorKind::StorageFull));
    }
    std::fs::write(path, content)
}

fn run_all(suite: &Suite) -> Result<(), PipelineError> {
    Stage::ALL.into_iter().try_for_each(|stage| run_stage(suite, stage, &NoProgress).map(drop))
}

fn run(dir: &Path, options: &Options) {
    run_all(&Suite::open(dir, options.clone(), Resources::default()).unwrap()).unwrap();
}

/// Every file of a suite but its journal.
fn files(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut folders = vec![dir.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            match path.is_dir() {
                true => folders.push(path),
                false => {
                    let name = path.strip_prefix(dir).unwrap().to_string_lossy().into_owned();
                    all.insert(name, std::fs::read(path).unwrap());
                }
            }
        }
    }
    all.remove("units.jsonl");
    all
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for path in std::fs::read_dir(from).unwrap().map(|entry| entry.unwrap().path()) {
        let target = to.join(path.file_name().unwrap());
        match path.is_dir() {
            true => copy(&path, &target),
            false => drop(std::fs::copy(path, target).unwrap()),
        }
    }
}

/// As a kill between the last file of a unit and its line in the journal leaves it.
fn drop_last_line(dir: &Path) {
    let journal = dir.join("units.jsonl");
    let text = std::fs::read_to_string(&journal).unwrap();
    let last = text.trim_end().rfind('\n').map_or(0, |at| at + 1);
    // Work that began is noted before the first file is written.
    if text[last..].contains("\"made\"") {
        std::fs::write(journal, &text[..last]).unwrap();
    }
}

#[test]
fn a_suite_that_is_made_anew_and_stopped_between_two_files_holds_no_edits() {
    for profile in ["paper", "open"] {
        let folder = tempfile::tempdir().unwrap();
        let options = |seed| Options {
            budget: Some(2),
            tune_budget: 3,
            profile: profile.into(),
            filter: Some("road = intersection".into()),
            seed,
            ..Options::default()
        };
        let [base, fresh, dir] = ["base", "fresh", "suite"].map(|name| folder.path().join(name));
        run(&base, &options(1));
        run(&fresh, &options(2));
        let whole = files(&fresh);
        let one_thread = Resources { threads: Some(1), ..Resources::default() };
        let mut stops = 0;
        for (place, drops_line) in (0..1000).flat_map(|place| [(place, false), (place, true)]) {
            let _ = std::fs::remove_dir_all(&dir);
            copy(&base, &dir);
            LEFT.store(place, Ordering::SeqCst);
            let suite = Suite::open_with(&dir, options(2), one_thread.clone(), write_some).unwrap();
            let stopped = run_all(&suite).is_err();
            drop(suite);
            if drops_line {
                drop_last_line(&dir);
            }
            run(&dir, &options(2));
            let now = files(&dir);
            assert_eq!(now.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>(), "{profile} {place}");
            let other = whole.iter().find(|(name, content)| now[*name] != **content).map(|(name, _)| name);
            assert_eq!(other, None, "{profile}, stopped before file {place}, {drops_line}");
            if !stopped {
                break;
            }
            stops += 1;
        }
        assert!(stops >= 8, "{profile}: {stops}");
    }
}
