//! Egos that are programs: the example in Python drives, and every fault ends in one clear line while others go on.
#![cfg(unix)]

use recrash_pipeline::{EgoCommand, EgoFault, ExternalEgo, Patience, PipelineError};
use recrash_roads::{Scenario, Simulator};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const CROSSING: &str = include_str!("../../benches/crossing.json");

/// Time enough for a busy machine.
const LONG: Patience = Patience { start: Duration::from_secs(60), answer: Duration::from_secs(30) };
/// Time enough for a program that is never going to answer.
const SHORT: Patience = Patience { start: Duration::from_secs(60), answer: Duration::from_secs(1) };

fn scenario() -> Scenario {
    let draft = recrash_roads::read_draft(CROSSING).expect("a draft").value;
    recrash_roads::check(draft).expect("a scenario").value
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("crates/pipeline").to_owned()
}

fn start(ego: &str, patience: Patience) -> Result<ExternalEgo, PipelineError> {
    ExternalEgo::start(EgoCommand::parse(ego).expect("a command line").expect("a command"), patience)
}

/// A shell script as the ego. `says` is what it does after the hello; $line is the next line it reads.
fn script(says: &str) -> String {
    let text = format!(r#"read line; echo "{{\"type\":\"ready\",\"protocol\":\"recrash.ego/1\"}}"; {says}"#);
    format!("cmd:sh -c '{}'", text.replace('\'', r"'\''"))
}

const READY: &str = r#"read line; echo "{\"type\":\"ready\"}"; "#;

/// What becomes of the scenario with such a script after the hello.
fn fault(says: &str, patience: Patience) -> String {
    let ego = start(&script(says), patience).expect("it says hello");
    match ego.run(&scenario()) {
        Err(error) => {
            assert_eq!(error.scenario_id, scenario().draft().id);
            let why = error.why.to_string();
            assert!(!why.contains('\n') && why.len() < 600, "{why}");
            why
        }
        Ok(rollout) => panic!("it drove: {:?}", rollout.termination),
    }
}

#[track_caller]
fn says(text: &str, words: &[&str]) {
    for word in words {
        assert!(text.contains(word), "does not say \"{word}\": {text}");
    }
}

#[test]
fn the_example_drives_and_repeats_to_the_bit() {
    let example = repository().join("docs/examples/ego.py");
    let ego = start(&format!("cmd:python3 '{}'", example.display()), LONG).expect("python3 and the example");
    let first = ego.run(&scenario()).expect("it drives");
    let states = &first.ego_track().states;
    assert!(states.last().expect("states").position().distance(states[0].position()) > 20.0, "it moved");
    assert!(first.ego.starts_with("cmd:python3"));
    let again = ego.run(&scenario()).expect("the same process");
    assert_eq!(first, again);
}

#[test]
fn one_process_per_thread_and_results_do_not_depend_on_which() {
    let example = repository().join("docs/examples/ego.py");
    let ego = start(&format!("cmd:python3 '{}'", example.display()), LONG).expect("python3 and the example");
    let hashes: Vec<String> = std::thread::scope(|scope| {
        let runs: Vec<_> =
            (0..3).map(|_| scope.spawn(|| ego.run(&scenario()).expect("it drives").state_hash)).collect();
        runs.into_iter().map(|run| run.join().expect("no panic")).collect()
    });
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:?}");
}

#[test]
fn both_forms_of_controls_drive() {
    let still = r#"while read line; do case "$line" in *reset*) echo "{\"type\":\"ready\"}";; *step*) echo "ANSWER";; esac; done"#;
    for answer in [
        r#"{\"type\":\"control\",\"throttle\":-0.1,\"steer\":0.0}"#,
        r#"{\"type\":\"control\",\"acceleration_mps2\":-2.727,\"wheel_angle_rad\":0,\"more\":1}"#,
    ] {
        let ego = start(&script(&still.replace("ANSWER", answer)), LONG).expect("it says hello");
        let rollout = ego.run(&scenario()).expect("it drives");
        let states = &rollout.ego_track().states;
        let braking = (states[5].speed() - states[6].speed()) / 0.1;
        assert!((braking - 2.727).abs() < 0.05, "{braking}");
    }
}

#[test]
fn a_program_that_is_not_there_is_told_with_its_name() {
    let error = start("cmd:no-such-program --x", LONG).err().expect("it is missing");
    assert_eq!(error.exit_code(), 3);
    says(&error.to_string(), &["no-such-program", "could not be started", "check the name"]);
}

#[test]
fn a_program_that_speaks_another_protocol_is_refused_at_the_start() {
    for (answer, found) in [
        (r#"{"type":"ready","protocol":"recrash.ego/7"}"#, r#"speaks "recrash.ego/7""#),
        (r#"{"type":"ready"}"#, "speaks no version"),
        ("Loading model ...", "something else than"),
        (r#"{"type":"error","message":"no licence"}"#, "no licence"),
    ] {
        let error =
            start(&format!("cmd:sh -c 'read line; echo '\\''{answer}'\\''; cat'"), LONG).err().expect("refused");
        says(&error.to_string(), &[found]);
    }
}

#[test]
fn a_program_that_hangs_is_ended_in_time() {
    let begun = Instant::now();
    says(&fault("sleep 600", SHORT), &["no answer to reset within 1 s"]);
    says(&fault(&format!("{READY} exec sleep 600"), SHORT), &["no answer to step 0 within 1 s"]);
    assert!(begun.elapsed() < Duration::from_secs(30), "{:?}", begun.elapsed());
    // One that does not even read.
    let error = start("cmd:sleep 600", Patience { start: Duration::from_secs(1), answer: LONG.answer }).err();
    says(&error.expect("no hello").to_string(), &["no answer to hello within 1 s"]);
}

#[test]
fn a_program_that_ends_is_told_with_its_last_words() {
    let why = fault(&format!("{READY} read line; echo out of memory >&2; exit 3"), LONG);
    says(&why, &["ended at step 0", "exit status: 3", "out of memory"]);
}

#[test]
fn rubbish_is_shown_and_explained() {
    let why = fault(&format!("{READY} read line; echo I am at step 0; cat >/dev/null"), LONG);
    says(&why, &["answered step 0", "I am at step 0", "\"control\"", "stderr"]);
    let why = fault(&format!(r#"{READY} read line; echo "{{\"type\":\"ready\"}}"; cat >/dev/null"#), LONG);
    says(&why, &["answered step 0", "\"control\""]);
}

#[test]
fn numbers_that_are_none_are_refused() {
    for number in ["NaN", "-Infinity"] {
        let answer = format!(r#"echo "{{\"type\":\"control\",\"throttle\":{number},\"steer\":0}}""#);
        let why = fault(&format!("{READY} read line; {answer}; cat >/dev/null"), LONG);
        says(&why, &["step 0", number, "finite"]);
    }
}

#[test]
fn ten_megabytes_without_an_end_are_refused() {
    let why = fault(&format!("{READY} read line; head -c 10000000 /dev/zero | tr \"\\000\" x; cat >/dev/null"), LONG);
    says(&why, &["step 0", "more than 1 MiB"]);
}

#[test]
fn after_a_fault_the_next_scenario_gets_a_new_process() {
    let folder = tempfile::tempdir().expect("a folder");
    let mark = folder.path().join("was-here");
    let example = repository().join("docs/examples/ego.py");
    // The first process ends at its first step, every later one is the example.
    let says_then = format!(
        r#"if [ -e {mark} ]; then exec python3 {example}; else touch {mark}; read line; echo "{{\"type\":\"ready\",\"protocol\":\"recrash.ego/1\"}}"; exit 1; fi"#,
        mark = mark.display(),
        example = example.display(),
    );
    let ego = start(&format!("cmd:sh -c '{}'", says_then.replace('\'', r"'\''")), LONG).expect("it says hello");
    assert!(ego.run(&scenario()).is_err());
    assert!(ego.run(&scenario()).is_ok());
}

#[test]
fn processes_are_ended_with_the_ego() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("pid");
    // Deaf to the end of its input: it has to be killed.
    let ego = start(&script(&format!("echo $$ > {}; exec sleep 600", file.display())), SHORT).expect("it says hello");
    let until = Instant::now() + Duration::from_secs(20);
    let process = loop {
        let text = std::fs::read_to_string(&file).unwrap_or_default();
        if text.ends_with('\n') || Instant::now() > until {
            break text.trim().to_owned();
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    assert!(Path::new(&format!("/proc/{process}")).exists() || !cfg!(target_os = "linux"));
    drop(ego);
    assert!(!Path::new(&format!("/proc/{process}")).exists(), "process {process} is gone");
}

#[test]
fn faults_are_values_that_programs_can_tell_apart() {
    let fault = EgoFault::Hung { question: "step 3".to_owned(), seconds: 10 };
    assert_eq!(fault.to_string(), "gave no answer to step 3 within 10 s");
}
