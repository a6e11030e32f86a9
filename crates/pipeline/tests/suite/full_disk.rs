//! A disk that fills up: the run stops with a clear error, what was finished stays, and the next run goes on.

use recrash_pipeline::{NoProgress, Options, PipelineError, Resources, Stage, Suite, run_stage};
use std::io::{Error, ErrorKind};
use std::path::Path;
use std::sync::atomic::{AtomicI64, Ordering};

static ROOM: AtomicI64 = AtomicI64::new(0);

/// Writes as long as there is room. [bytes]
fn write_with_room(path: &Path, content: &[u8]) -> std::io::Result<()> {
    if ROOM.fetch_sub(content.len() as i64, Ordering::SeqCst) < content.len() as i64 {
        return Err(Error::from(ErrorKind::StorageFull));
    }
    std::fs::write(path, content)
}

fn run_all(suite: &Suite) -> Result<(), PipelineError> {
    Stage::ALL.into_iter().try_for_each(|stage| run_stage(suite, stage, &NoProgress).map(drop))
}

#[test]
fn a_full_disk_stops_the_run_and_the_next_run_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let options = Options { budget: Some(3), tune_budget: 8, profile: "paper".into(), ..Options::default() };
    let fresh = folder.path().join("fresh");
    run_all(&Suite::open(&fresh, options.clone(), Resources::default()).unwrap()).unwrap();
    let size = std::fs::metadata(fresh.join("1-records.json")).unwrap().len() as i64;

    let dir = folder.path().join("suite");
    ROOM.store(size + 60_000, Ordering::SeqCst);
    let error = Suite::open_with(&dir, options.clone(), Resources::default(), write_with_room)
        .and_then(|suite| run_all(&suite))
        .expect_err("there is not enough room");
    assert!(matches!(&error, PipelineError::Io { source, .. } if source.kind() == ErrorKind::StorageFull), "{error}");
    assert_eq!(error.exit_code(), 1);
    assert!(error.to_string().contains("finished work is kept"), "{error}");
    assert!(dir.join("1-records.json").exists() && !dir.join("report.html").exists());

    run_all(&Suite::open(&dir, options, Resources::default()).unwrap()).unwrap();
    for file in ["suite.json", "summary.json", "report.html", "results.csv", "junit.xml"] {
        assert!(std::fs::read(dir.join(file)).unwrap() == std::fs::read(fresh.join(file)).unwrap(), "{file}");
    }
}
