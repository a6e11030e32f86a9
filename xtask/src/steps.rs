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
    let steps: [Step; 7] = [
        ("format", format),
        ("tidy", tidy::run),
        ("lint", lint),
        ("test", test),
        ("docs", docs),
        ("python", python),
        ("browser", browser),
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
    cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"], &[])
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
