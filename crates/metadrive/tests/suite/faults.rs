//! Interpreters that are not what they should be: each ends in one clear line, and the run goes on.
#![cfg(unix)]

use crate::common::{checked, crossing};
use recrash_metadrive::{Drive, Metadrive, MetadriveError, NotReady, Options, WorkerFault, inspect};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const HELLO: &str = r#"echo '{"hello":{"python":"3.11.7","metadrive":"0.4.3","problem":null}}'"#;

/// An answer that fits the crossing: two actors, one step.
const DONE: &str = r#"echo '{"id":1,"done":{"end":"timeout","time_s":0.0,"tracks":[[[5,0,0,8,0,0,0]],[[9,9,0,8,0,0,0]]],"events":[],"maps":1}}'"#;

/// A program in place of Python. It takes the worker's script from its stdin, as Python would, then does this.
fn program(folder: &Path, then: &str) -> PathBuf {
    let path = folder.join("python");
    // Written aside and renamed: a file still open for writing cannot be started.
    let draft = folder.join("draft");
    let text = format!("#!/bin/sh\nhead -c \"$3\" >/dev/null\nhere='{}'\n{then}\n", folder.display());
    std::fs::write(&draft, text).expect("a writable folder");
    std::fs::set_permissions(&draft, std::fs::Permissions::from_mode(0o755)).expect("its owner's");
    std::fs::rename(&draft, &path).expect("the same folder");
    path
}

fn options(python: PathBuf) -> Options {
    Options { python, workers: 1, start_patience: Duration::from_secs(20), run_patience: Duration::from_secs(20) }
}

/// Why the pool does not start with such a program.
fn refused(then: &str) -> MetadriveError {
    let folder = tempfile::tempdir().expect("a folder");
    Metadrive::start(options(program(folder.path(), then))).expect_err("it is refused")
}

/// What becomes of one scenario with such a program.
fn outcome(then: &str, run_patience: Duration) -> Result<String, MetadriveError> {
    let folder = tempfile::tempdir().expect("a folder");
    let options = Options { run_patience, ..options(program(folder.path(), then)) };
    let metadrive = Metadrive::start(options)?;
    metadrive.simulate(&checked(&crossing()), &Drive::MetadriveIdm).map(|rollout| rollout.state_hash)
}

#[track_caller]
fn failed(result: Result<String, MetadriveError>) -> (WorkerFault, WorkerFault) {
    match result {
        Err(MetadriveError::Failed { scenario, first, second }) => {
            assert_eq!(scenario, "crossing");
            (first, second)
        }
        other => panic!("{other:?}"),
    }
}

const LONG: Duration = Duration::from_secs(20);

#[test]
fn a_missing_interpreter_is_told_with_its_name() {
    let error = Metadrive::start(options(PathBuf::from("no-such-python"))).expect_err("it is missing");
    let text = error.to_string();
    assert!(matches!(error, MetadriveError::NoPython { .. }));
    assert!(text.contains("no-such-python") && text.contains("install Python") && !text.contains('\n'), "{text}");
    let found = inspect(Path::new("no-such-python"), LONG);
    assert!(found.to_string().starts_with("MetaDrive: not usable: cannot start Python"), "{found}");
}

#[test]
fn a_missing_or_other_metadrive_is_told_with_the_fix() {
    let hello = |metadrive: &str, kind: &str| {
        format!(
            r#"echo '{{"hello":{{"python":"3.9.1","metadrive":{metadrive},"problem":{{"kind":"{kind}","detail":"x"}}}}}}'"#
        )
    };
    let error = refused(&hello("null", "metadrive_missing")).to_string();
    assert_eq!(
        error,
        "MetaDrive is not installed in Python 3.9.1; pip install metadrive-simulator==0.4.3 (Python 3.7 to 3.11)"
    );
    let error = refused(&hello("\"0.3.0\"", "metadrive_version")).to_string();
    assert!(error.starts_with("MetaDrive 0.3.0 is installed, but 0.4.3 is needed; pip install"), "{error}");
    let error = refused(&hello("\"0.4.3\"", "import_failed")).to_string();
    assert_eq!(error, "MetaDrive cannot be imported: x");
}

#[test]
fn a_program_that_is_no_python_is_told_with_what_it_said() {
    let no_worker = |then: &str| match refused(then) {
        MetadriveError::NotReady { reason: NotReady::NoWorker { fault } } => fault,
        other => panic!("{other}"),
    };
    let died = no_worker("echo 'what is this?' >&2; exit 3");
    assert_eq!(died, WorkerFault::Died { complaint: "what is this?".to_owned() });
    assert_eq!(no_worker("echo hello; sleep 20"), WorkerFault::Rubbish { beginning: "hello".to_owned() });
    assert!(matches!(no_worker("echo '[1,2]'; sleep 20"), WorkerFault::Rubbish { .. }));
}

#[test]
fn a_worker_that_hangs_is_ended_and_its_scenario_reported() {
    let begin = Instant::now();
    let (first, second) = failed(outcome(&format!("{HELLO}\nsleep 60"), Duration::from_millis(300)));
    assert!(matches!((first, second), (WorkerFault::Hung { .. }, WorkerFault::Hung { .. })));
    assert!(begin.elapsed() < Duration::from_secs(30));
}

#[test]
fn a_worker_that_dies_is_replaced_and_its_scenario_tried_once_more() {
    let once =
        format!("{HELLO}\nread line\n[ -e \"$here/seen\" ] || {{ touch \"$here/seen\"; exit 1; }}\n{DONE}\nread line");
    assert!(outcome(&once, LONG).is_ok());
    let always = format!("{HELLO}\nread line\necho 'Segmentation fault' >&2; exit 139");
    let (first, second) = failed(outcome(&always, LONG));
    assert_eq!(first, WorkerFault::Died { complaint: "Segmentation fault".to_owned() });
    assert_eq!(first, second);
}

#[test]
fn a_worker_that_prints_rubbish_is_not_believed() {
    let says = |answer: &str| failed(outcome(&format!("{HELLO}\nread line\n{answer}\nread line"), LONG)).1;
    for answer in [
        "echo 'done!'",
        "echo '{}'",
        "echo '{\"id\":1}'",
        "printf '\\377\\376\\n'",
        // Another question's answer, NaN, no actors, one actor too few, an event of nobody.
        r#"echo '{"id":2,"error":"x"}'"#,
        r#"echo '{"id":1,"done":{"end":"timeout","time_s":NaN,"tracks":[],"events":[],"maps":1}}'"#,
        r#"echo '{"id":1,"done":{"end":"timeout","time_s":0.0,"tracks":[],"events":[],"maps":1}}'"#,
        r#"echo '{"id":1,"done":{"end":"timeout","time_s":0.0,"tracks":[[[5,0,0,8,0,0,0]]],"events":[],"maps":1}}'"#,
        r#"echo '{"id":1,"done":{"end":"contact","time_s":0.0,"tracks":[[[5,0,0,8,0,0,0]],[[9,9,0,8,0,0,0]]],"events":[{"time_s":0,"a":7,"a_state":[0,0,0,0,0,0,0],"obstacle":0}],"maps":1}}'"#,
        "head -c 10000000 /dev/zero | tr '\\0' 'x'; echo",
    ] {
        let fault = says(answer);
        assert!(matches!(fault, WorkerFault::Rubbish { .. }), "{answer}: {fault}");
    }
}

#[test]
fn an_error_inside_metadrive_is_passed_on() {
    let raised = format!("{HELLO}\nread line\necho '{{\"id\":1,\"error\":\"KeyError: 7\"}}'\nread line");
    assert_eq!(failed(outcome(&raised, LONG)).0, WorkerFault::Raised { error: "KeyError: 7".to_owned() });
}

#[test]
fn a_worker_that_complains_without_end_does_not_block() {
    let loud = format!("{HELLO}\nread line\nhead -c 3000000 /dev/zero | tr '\\0' 'x' >&2\n{DONE}\nread line");
    assert!(outcome(&loud, LONG).is_ok());
}

#[test]
fn the_others_go_on_when_one_scenario_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    // Whoever gets the scenario called `bad` dies.
    let picky = format!("{HELLO}\nread line\ncase \"$line\" in *12.5*) exit 1;; esac\n{DONE}\nread line");
    let metadrive = Metadrive::start(options(program(folder.path(), &picky))).expect("it starts");
    let mut bad = crossing();
    bad["duration_s"] = serde_json::json!(12.5);
    bad["id"] = serde_json::json!("bad");
    let scenarios = [checked(&crossing()), checked(&bad)];
    let results = metadrive.simulate_all(&scenarios, &Drive::MetadriveIdm, &|_| {});
    assert!(results[0].is_ok());
    assert!(matches!(&results[1], Err(MetadriveError::Failed { scenario, .. }) if scenario == "bad"));
}
