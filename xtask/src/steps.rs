//! The steps of CI. Each is a few commands, run in the project's folder.

use crate::tally::Tally;
use crate::{compiler, fuzz, tidy, wheel};
use std::ffi::{OsStr, OsString};
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::Instant;

/// What a step gives: why it failed, in one line.
pub type Result<T = ()> = std::result::Result<T, String>;

/// Name of a step, and what it does.
type Step = (&'static str, fn(&mut Tally) -> Result);

/// All steps.
pub const STEPS: [Step; 10] = [
    ("format", format),
    ("tidy", tidy::run),
    ("prepare", prepare),
    ("test", test),
    ("python", python),
    ("browser", browser),
    ("build", build),
    ("fuzz", fuzz::run),
    ("wheel", wheel::step),
    ("docs", docs),
];

/// Names the program that is tested. Who asks cargo for it waits until nobody else builds.
const BUILT: &str = "RECRASH";
/// Set once this process has built it. To ask cargo again builds what the wheel asks of its libraries back.
static HAS_BUILT: OnceLock<()> = OnceLock::new();
/// What [`ci`] does first: what is cheap, and what tests need. What they run is built before anybody else asks cargo for something.
const FIRST: [&str; 4] = ["format", "tidy", "prepare", "build"];
/// Then, one after the other in a process of its own, the steps that run what was built; they keep about one core busy.
const RUNNING: [&str; 3] = ["test", "python", "browser"];
/// Beside them, one after the other, the steps that build something else.
const BUILDING: [&str; 3] = ["fuzz", "wheel", "docs"];

/// Everything. The first failure ends what it is in, but of what runs beside each other the other one goes on to its end: so one
/// run tells more of what is wrong, and leaves no test behind that nobody waits for.
pub fn ci(tally: &mut Tally) -> Result {
    in_turn(&FIRST, tally)?;
    let aside = Aside::begin(&RUNNING, &program())?;
    let beside = in_turn(&BUILDING, tally);
    if let Err(why) = &beside {
        eprintln!("xtask: {why}; {} go on to their end", RUNNING.join(", "));
    }
    let aside = aside.told(tally);
    beside.and(aside)
}

/// The steps of these names, each begun when the one before it has ended; none behind one that failed.
pub fn in_turn(names: &[impl AsRef<str>], tally: &mut Tally) -> Result {
    names.iter().try_for_each(|name| {
        let named = STEPS.iter().find(|(step, _)| *step == name.as_ref());
        let (name, step) = named.ok_or_else(|| format!("there is no step {}", name.as_ref()))?;
        timed(name, || step(tally))
    })
}

/// Runs a step, and says how long that took.
fn timed(name: &str, step: impl FnOnce() -> Result) -> Result {
    let (begun, before) = (Instant::now(), processor_seconds());
    println!("== xtask {name}");
    step().map_err(|why| format!("{name}: {why}"))?;
    let processor =
        processor_seconds().zip(before).map(|(now, before)| format!(", {:.0} s of processor", now - before));
    println!("== xtask {name}: done in {:.0} s{}", begun.elapsed().as_secs_f64(), processor.unwrap_or_default());
    Ok(())
}

/// Steps in a process of their own, which ends with whoever asked for them. What they say is kept in a file, and shown in one piece.
struct Aside(Child, PathBuf);

impl Drop for Aside {
    fn drop(&mut self) {
        // It has ended already, or nobody waits for it.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Aside {
    fn begin(names: &[&str], program: &Path) -> Result<Aside> {
        let told = target().join("xtask-aside.txt");
        let begin = || {
            let file = std::fs::File::create(&told)?;
            let errors = file.try_clone()?;
            let mut command = Command::new(compiler::program());
            command.args(names).env(BUILT, program).stdin(Stdio::null()).stdout(file).stderr(errors).spawn()
        };
        begin().map(|child| Aside(child, told.clone())).map_err(|error| format!("{}: {error}", names.join(", ")))
    }

    /// Waits for them; shows and counts what they said.
    fn told(mut self, tally: &mut Tally) -> Result {
        let status = self.0.wait().map_err(|error| error.to_string())?;
        let told = std::fs::read(&self.1).map_err(|error| error.to_string())?;
        for line in String::from_utf8_lossy(&told).lines() {
            println!("{line}");
            tally.read(line);
        }
        if status.success() { Ok(()) } else { Err(format!("{} ended with {status}, see above", RUNNING.join(", "))) }
    }
}

/// Processor time of the programs that ended so far, with those that they started; where the system tells it. [s]
fn processor_seconds() -> Option<f64> {
    let told = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The 16th and 17th field count hundredths of a second; the second, a name in brackets, may hold blanks.
    let (_, after) = told.rsplit_once(") ")?;
    let ticks = after.split(' ').skip(13).take(2).map(|field| field.parse::<f64>().ok());
    ticks.sum::<Option<f64>>().map(|ticks| ticks / 100.0)
}

fn format(_: &mut Tally) -> Result {
    cargo(&["fmt", "--all", "--check"], &[])
}

/// Everything that tests, examples and benchmarks are made of, linted while it is built.
fn build(_: &mut Tally) -> Result {
    cargo(&["test", "--workspace", "--all-targets", "--no-run", "--quiet"], &[])?;
    let _ = HAS_BUILT.set(());
    Ok(())
}

/// What tests need and cargo does not bring: `.venv`, a Python with MetaDrive, and what drives the browser.
fn prepare(tally: &mut Tally) -> Result {
    let Some(python) = find_python() else {
        return missing(tally, "prepare", "Python 3.11 is not on the PATH");
    };
    if !venv_python().exists() {
        run(Command::new(python).args(["-m", "venv"]).arg(root().join(".venv")))?;
    }
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"];
    run(Command::new(venv_python()).args(pip).arg(root().join("requirements/dev.txt")))?;
    let script = "from oracles import environment; print(environment('metadrive') / 'python')";
    let output = Command::new(venv_python())
        .args(["-c", script])
        .current_dir(root().join("tests"))
        .output()
        .map_err(|error| error.to_string())?;
    if output.status.success() {
        std::fs::create_dir_all(target()).map_err(|error| error.to_string())?;
        std::fs::write(metadrive_note(), output.stdout).map_err(|error| error.to_string())?;
    } else {
        let said = String::from_utf8_lossy(&output.stderr);
        missing(tally, "prepare", said.lines().last().unwrap_or("MetaDrive's environment cannot be made"))?;
    }
    if Command::new("npm").arg("--version").output().is_err() {
        return missing(tally, "prepare", "npm of Node.js is not on the PATH");
    }
    run(Command::new("npm").args(["ci", "--no-audit", "--no-fund"]).current_dir(browser_folder()))
}

fn test(tally: &mut Tally) -> Result {
    let mut command = cargo_command();
    // What a run says of a state of the code does not change; tests that are called otherwise try other numbers each time.
    command.args(["test", "--workspace", "--no-fail-fast"]).env("PROPTEST_RNG_SEED", "1");
    if let Some(python) = metadrive_python() {
        command.env("RECRASH_METADRIVE_PYTHON", python);
    }
    counted(&mut command, tally)
}

/// The pages of every crate that was built, by the tests or for the wheel; and that it builds without language models, as `docs/language-models.md` offers.
fn docs(_: &mut Tally) -> Result {
    built()?;
    compiler::pages()?;
    compiler::without("live", "recrash_agents", "ureq")
}

/// The Python tests, of the program that the Rust tests had built.
fn python(tally: &mut Tally) -> Result {
    if !venv_python().exists() {
        return missing(tally, "python", "there is no .venv; `cargo xtask prepare` makes it");
    }
    let mut command = command(venv_python());
    command.args(["-m", "pytest", "--quiet", "tests"]).env(BUILT, built()?);
    told(&mut command, tally)
}

/// The reports of fresh suites, by templates and by accounts, in a browser.
fn browser(tally: &mut Tally) -> Result {
    if !browser_folder().join("node_modules").is_dir() {
        return missing(tally, "browser", "what drives it is not there; `cargo xtask prepare` gets it");
    }
    let chromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    if !chromium.iter().any(|path| Path::new(path).exists()) {
        return missing(tally, "browser", "Chromium is not installed (Debian's package chromium)");
    }
    for profile in ["paper", "open"] {
        let suite = target().join(format!("browser-{profile}"));
        let words = ["run", "--quiet", "--profile", profile, "--budget", "20", "--tune-budget", "20", "--out"];
        run(Command::new(built()?).args(words).arg(&suite))?;
        run(Command::new("node").arg(browser_folder().join("check.mjs")).arg(suite.join("report.html")))?;
    }
    Ok(())
}

/// What cannot run here: an error in CI, a named skip elsewhere.
pub fn missing(tally: &mut Tally, step: &str, what: &str) -> Result {
    if std::env::var_os("CI").is_some() {
        return Err(what.to_owned());
    }
    tally.skip_step(step, what);
    Ok(())
}

pub fn find_python() -> Option<&'static str> {
    ["python3.11", "python3", "python"].into_iter().find(|name| {
        let check = "import sys; sys.exit(sys.version_info < (3, 11))";
        Command::new(name).args(["-c", check]).status().is_ok_and(|status| status.success())
    })
}

fn venv_python() -> PathBuf {
    root().join(".venv").join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

/// uv, where `prepare` has set it up.
pub fn uv() -> Option<PathBuf> {
    Some(venv_python().with_file_name(if cfg!(windows) { "uv.exe" } else { "uv" })).filter(|program| program.exists())
}

/// The interpreter that has MetaDrive: the one that is named, else the one that `prepare` has set up.
pub fn metadrive_python() -> Option<OsString> {
    let noted = || std::fs::read_to_string(metadrive_note()).ok().map(|known| known.trim().into());
    std::env::var_os("RECRASH_METADRIVE_PYTHON").or_else(noted).filter(|python| Path::new(python).is_file())
}

/// Where `prepare` notes the interpreter that has MetaDrive.
fn metadrive_note() -> PathBuf {
    target().join("metadrive-python.txt")
}

fn browser_folder() -> PathBuf {
    root().join("crates/report/tests/browser")
}

/// The program as the Rust tests run it: one build serves all. Nothing is built where this program has built it, or where `RECRASH` names one.
pub fn built() -> Result<PathBuf> {
    if let Some(program) = std::env::var_os(BUILT) {
        return Ok(program.into());
    }
    if HAS_BUILT.get().is_none() {
        build(&mut Tally::default())?;
    }
    Ok(program())
}

/// Where cargo puts the program as the tests run it.
fn program() -> PathBuf {
    target().join(if cfg!(windows) { "debug/recrash.exe" } else { "debug/recrash" })
}

/// The project's folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the project").to_owned()
}

/// The folder of what is built.
pub fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

fn cargo(arguments: &[&str], environment: &[(&str, &str)]) -> Result {
    run(cargo_command().args(arguments).envs(environment.iter().copied()))
}

/// The cargo that runs this.
pub fn cargo_command() -> Command {
    command(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// A program that may call cargo, for which [`compiler`] compiles. What cargo told this program about the package xtask is taken away: build scripts that look at
/// it would run again, and half of the libraries with them, whenever somebody calls cargo otherwise in between.
pub fn command(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    for (name, _) in std::env::vars_os() {
        let text = name.to_string_lossy();
        if ["CARGO_PKG_", "CARGO_MANIFEST_", "CARGO_BIN_", "CARGO_CRATE_"].iter().any(|of| text.starts_with(of)) {
            command.env_remove(&name);
        }
    }
    command.envs(compiler::variables());
    command
}

/// Runs a command to its end; in the project's folder where it names no other.
pub fn run(command: &mut Command) -> Result {
    in_project(command);
    let status = command.status();
    judged(command, status)
}

/// The same with pytest, which is told to say what `counted` reads.
pub fn told(pytest: &mut Command, tally: &mut Tally) -> Result {
    counted(pytest.args(["-p", "counted"]).env("PYTHONPATH", root().join("tests/plugin")), tally)
}

/// The same with a runner of tests, whose lines are shown and counted.
fn counted(command: &mut Command, tally: &mut Tally) -> Result {
    in_project(command);
    let status = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().and_then(|mut child| {
        let (said, warned) = (child.stdout.take(), child.stderr.take());
        let (told, counts) = std::thread::scope(|scope| {
            let aside = scope.spawn(|| lines(warned, |line| eprintln!("{line}")));
            (lines(said, |line| println!("{line}")), aside.join().unwrap_or_default())
        });
        told.iter().chain(&counts).for_each(|line| tally.read(line));
        child.wait()
    });
    judged(command, status)
}

/// The lines of a stream, each shown as it comes.
fn lines(stream: Option<impl Read>, show: impl Fn(&str)) -> Vec<String> {
    let mut kept = Vec::new();
    for line in stream.into_iter().flat_map(|stream| BufReader::new(stream).split(b'\n')) {
        let Ok(line) = line else { break };
        let line = String::from_utf8_lossy(&line).into_owned();
        show(&line);
        kept.push(line);
    }
    kept
}

fn in_project(command: &mut Command) {
    if command.get_current_dir().is_none() {
        command.current_dir(root());
    }
}

fn judged(command: &Command, status: std::io::Result<std::process::ExitStatus>) -> Result {
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?} ended with {status}")),
        Err(error) => Err(format!("cannot start {:?}: {error}", command.get_program())),
    }
}
