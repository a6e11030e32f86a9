//! The steps of CI. Each is a few commands, run in the project's folder.

use crate::tidy;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// What a step gives: why it failed, in one line.
pub type Result<T = ()> = std::result::Result<T, String>;

/// Name of a step, and what it does.
type Step = (&'static str, fn() -> Result);

/// Everything, in order of cost.
pub fn ci() -> Result {
    let steps: [Step; 9] = [
        ("format", format),
        ("tidy", tidy::run),
        ("lint", lint),
        ("test", test),
        ("docs", docs),
        ("python", python),
        ("metadrive", metadrive),
        ("browser", browser),
        ("fuzz", fuzz),
    ];
    for (name, step) in steps {
        let begun = Instant::now();
        println!("== xtask {name}");
        step().map_err(|why| format!("{name}: {why}"))?;
        println!("== xtask {name}: done in {:.0} s", begun.elapsed().as_secs_f64());
    }
    Ok(())
}

/// Formatting.
pub fn format() -> Result {
    cargo(&["fmt", "--all", "--check"], &[])
}

/// Lints.
pub fn lint() -> Result {
    cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"], &[])?;
    // Without language models: a build that docs/language-models.md offers.
    let without_live = ["--no-default-features", "--features", "parquet"];
    let alone = ["clippy", "--package", "recrash-cli", "--all-targets"];
    cargo(&[&alone[..], &without_live, &["--", "-D", "warnings"]].concat(), &[])
}

/// Rust tests.
pub fn test() -> Result {
    cargo(&["test", "--workspace"], &[])
}

/// Documentation.
pub fn docs() -> Result {
    cargo(&["doc", "--workspace", "--no-deps", "--document-private-items"], &[("RUSTDOCFLAGS", "-D warnings")])
}

/// Python tests, in an environment of their own.
pub fn python() -> Result {
    let Some(python) = find_python() else {
        return missing("python", "Python 3.11 is not on the PATH");
    };
    let venv = root().join(".venv");
    let inside = venv.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    if !inside.exists() {
        run(Command::new(python).args(["-m", "venv"]).arg(&venv))?;
    }
    let requirements = root().join("requirements/dev.txt");
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"];
    run(Command::new(&inside).args(pip).arg(requirements))?;
    cargo(&["build", "--release", "--package", "recrash-cli"], &[])?;
    run(Command::new(&inside).args(["-m", "pytest", "--quiet", "tests"]).env("RECRASH", binary()))
}

/// The tests on a real MetaDrive, in the environment of `requirements/metadrive.txt`. The step before makes `.venv`.
pub fn metadrive() -> Result {
    let python = root().join(".venv").join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    if !python.exists() {
        return missing("metadrive", "there is no .venv; `cargo xtask python` makes it");
    }
    let script = "from oracles import environment; print(environment('metadrive') / 'python')";
    let output = Command::new(python)
        .args(["-c", script])
        .current_dir(root().join("tests"))
        .output()
        .map_err(|error| error.to_string())?;
    let metadrive = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    if !output.status.success() || metadrive.is_empty() {
        let said = String::from_utf8_lossy(&output.stderr);
        return missing("metadrive", said.lines().last().unwrap_or("its environment cannot be made"));
    }
    let arguments = ["test", "-p", "recrash-metadrive", "-p", "recrash-pipeline"];
    let tests = ["--test", "suite", "--", "real_metadrive::", "parity::"];
    cargo(&[&arguments[..], &tests].concat(), &[("RECRASH_METADRIVE_PYTHON", &metadrive)])
}

/// A short run of every fuzz target, from the inputs that longer runs found.
pub fn fuzz() -> Result {
    let tools = root().join("target/tools");
    let program = tools.join("bin").join(if cfg!(windows) { "cargo-fuzz.exe" } else { "cargo-fuzz" });
    if !program.exists() {
        let install = ["install", "cargo-fuzz@0.13.2", "--locked", "--quiet", "--root"];
        cargo(&[&install[..], &[&tools.to_string_lossy()]].concat(), &[])?;
    }
    for target in ["crash_file", "mapping", "openscenario", "scenario"] {
        let fresh = root().join("target/fuzz").join(target);
        std::fs::create_dir_all(&fresh).map_err(|error| format!("{}: {error}", fresh.display()))?;
        let known = ["corpus", "found"].map(|folder| root().join("fuzz").join(folder).join(target));
        let dictionary = root().join("fuzz/dictionaries").join(target);
        let mut command = Command::new(&program);
        // Coverage instrumentation is unstable in the compiler; this lets the stable one have it.
        command.env("RUSTC_BOOTSTRAP", "1").args(["fuzz", "run", "-s", "none", target]).arg(fresh);
        command.args(known.iter().filter(|folder| folder.is_dir()));
        command.args(["--", "-max_len=4096", "-max_total_time=20", "-verbosity=0"]);
        if dictionary.exists() {
            command.arg(format!("-dict={}", dictionary.display()));
        }
        run(&mut command)?;
    }
    Ok(())
}

/// The report of a fresh suite, in a browser.
pub fn browser() -> Result {
    let folder = root().join("crates/report/tests/browser");
    if run(Command::new("node").arg("--version")).is_err() {
        return missing("browser", "Node.js is not on the PATH");
    }
    let chromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    if !chromium.iter().any(|path| Path::new(path).exists()) {
        return missing("browser", "Chromium is not installed (Debian's package chromium)");
    }
    cargo(&["build", "--release", "--package", "recrash-cli"], &[])?;
    run(Command::new("npm").args(["ci", "--no-audit", "--no-fund"]).current_dir(&folder))?;
    let suite = root().join("target/browser-suite");
    run(Command::new(binary()).args(["run", "--quiet", "--out"]).arg(&suite))?;
    run(Command::new("node").arg(folder.join("check.mjs")).arg(suite.join("report.html")))
}

/// A step that cannot run here: an error in CI, a named skip elsewhere.
fn missing(step: &str, what: &str) -> Result {
    if std::env::var_os("CI").is_some() {
        return Err(what.to_owned());
    }
    println!("skipped: {step} ({what})");
    Ok(())
}

fn find_python() -> Option<&'static str> {
    ["python3.11", "python3", "python"].into_iter().find(|name| {
        let check = "import sys; sys.exit(sys.version_info < (3, 11))";
        Command::new(name).args(["-c", check]).status().is_ok_and(|status| status.success())
    })
}

fn binary() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    target.join(if cfg!(windows) { "release/recrash.exe" } else { "release/recrash" })
}

/// The project's folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the project").to_owned()
}

fn cargo(arguments: &[&str], environment: &[(&str, &str)]) -> Result {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    run(Command::new(cargo).args(arguments).envs(environment.iter().copied()))
}

fn run(command: &mut Command) -> Result {
    if command.get_current_dir().is_none() {
        command.current_dir(root());
    }
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?} ended with {status}")),
        Err(error) => Err(format!("cannot start {:?}: {error}", command.get_program())),
    }
}
