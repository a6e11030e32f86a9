//! Helpers of the command's tests.

pub mod scripted;
pub mod server;

use assert_cmd::Command;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, Once, OnceLock};

/// Exit code of work that misses what is asked for: a scenario that is not true to its record, or that was not run.
pub const MISSED: i32 = 5;
/// A crash file with the first rows of the built-in sample, with [`UNREAD`] and [`GROUNDS`]. To stage the whole sample takes ten times as long: what is
/// not about all of its incidents is tested on these.
pub const FEW: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/few.csv");
/// A pickup that backed out of its space; the built-in reader does not say who struck whom.
pub const UNREAD: &str = "90101-251";
/// A crash beside things in a work zone, and one on a circle.
pub const GROUNDS: [&str; 2] = ["90106-197", "90101-342"];
/// Makes a small suite that goes by templates.
pub const SMALL: [&str; 8] = ["run", "--quiet", "--records", FEW, "--budget", "2", "--tune-budget", "4"];
/// Makes one that goes by accounts.
pub const TOLD: [&str; 11] =
    ["run", "--profile", "open", "--records", FEW, "--budget", "12", "--tune-budget", "6", "--seed", "3"];

/// The command. Where nothing else is said its suites go by templates, as the published method does; those that go by
/// accounts have tests of their own.
pub fn recrash(arguments: &[&str]) -> Command {
    few();
    let mut command = Command::cargo_bin("recrash").expect("the binary is built with its tests");
    command.args(arguments).env("RECRASH_PROFILE", "paper");
    command
}

/// The same command for processes that are stopped or watched on their way.
pub fn plain_recrash() -> std::process::Command {
    few();
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("recrash"));
    command.env("RECRASH_PROFILE", "paper");
    command
}

/// [`FEW`], which is written once.
pub fn few() -> &'static Path {
    static WRITTEN: Once = Once::new();
    // Whole or not at all: the tests of another process may read it.
    WRITTEN.call_once(|| {
        let fresh = tempfile::NamedTempFile::new_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
        write_rows(fresh.path(), |number, report| number < 60 || report == UNREAD || GROUNDS.contains(&report));
        fresh.persist(FEW).unwrap();
    });
    Path::new(FEW)
}

/// Writes rows of the sample, chosen by their number and report id.
fn write_rows(path: &Path, is_chosen: impl Fn(usize, &str) -> bool) {
    let mut table = csv::Reader::from_reader(recrash_records::SAMPLE_CSV.as_bytes());
    let mut file = csv::Writer::from_path(path).unwrap();
    file.write_record(table.headers().unwrap()).unwrap();
    for (_, row) in table.records().map(Result::unwrap).enumerate().filter(|(number, row)| is_chosen(*number, &row[0]))
    {
        file.write_record(&row).unwrap();
    }
    file.flush().unwrap();
}

/// Text of a Python program as the ego that drives on at a speed. [m/s]
pub fn driving_ego(speed_mps: f64) -> String {
    format!(
        r#"
import json, sys
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "step":
        slow = message["ego"]["speed"] < {speed_mps:?}
        answer = {{"type": "control", "throttle": 0.3 if slow else -0.2, "steer": 0.0}}
    else:
        answer = {{"type": "ready", "protocol": "recrash.ego/1"}}
    if message["type"] != "end":
        print(json.dumps(answer), flush=True)
"#
    )
}

/// A folder to run commands in.
pub struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// A place where a command has been run. It runs once for all tests that ask for it, and each gets a copy.
    pub fn made(arguments: &[&str]) -> Self {
        type Made = BTreeMap<Vec<String>, Arc<OnceLock<Place>>>;
        static MADE: Mutex<Made> = Mutex::new(Made::new());
        let words: Vec<String> = arguments.iter().map(|word| (*word).to_owned()).collect();
        let made = Arc::clone(MADE.lock().unwrap().entry(words).or_default());
        let first = made.get_or_init(|| {
            let place = Self { folder: tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap() };
            let (code, _, error) = place.run(arguments);
            assert_eq!(code, 0, "{arguments:?}: {error}");
            place
        });
        let place = Self::new();
        copy(first.folder(), place.folder());
        place
    }

    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes the first rows of the sample as `crashes.csv`.
    pub fn few_records(&self, rows: usize) {
        write_rows(&self.path("crashes.csv"), |number, _| number < rows);
    }

    /// Runs a command in the folder; gives exit code, standard output and standard error.
    pub fn run(&self, arguments: &[&str]) -> (i32, String, String) {
        self.run_within(arguments, 3600)
    }

    /// The same for at most this long; exit code 124 where that was not enough. [s]
    pub fn run_within(&self, arguments: &[&str], seconds: u64) -> (i32, String, String) {
        let mut command = recrash(arguments);
        command.timeout(std::time::Duration::from_secs(seconds));
        // Nothing that the user has counts: no proxy, and no weights of an embedding model.
        command.current_dir(self.folder.path()).env("RECRASH_CACHE", self.path("cache")).env("HOME", self.path("home"));
        for name in ["http_proxy", "HTTP_PROXY", "all_proxy", "ALL_PROXY", "XDG_CACHE_HOME", "HF_HOME", "HF_HUB_CACHE"]
        {
            command.env_remove(name);
        }
        for name in ["VIRTUAL_ENV", "CONDA_PREFIX", "RECRASH_EMBEDDING", "RECRASH_PYTHON", "COLUMNS"] {
            command.env_remove(name);
        }
        let output = command.output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (output.status.code().unwrap_or(124), text(&output.stdout), text(&output.stderr))
    }

    pub fn records(&self, extra: &[&str]) -> serde_json::Value {
        let arguments: Vec<&str> = ["records", "--json"].iter().chain(extra).copied().collect();
        let (code, shown, error) = self.run(&arguments);
        assert_eq!(code, 0, "{error}");
        serde_json::from_str(&shown).unwrap()
    }
}

/// Copies what a folder holds.
pub fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}
