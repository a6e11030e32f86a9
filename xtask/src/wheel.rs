//! The Python package: its wheel is built, installed where nothing else is, and held against its gates.

use crate::licences;
use crate::steps::{
    Result, built, cargo_command, command, find_python, metadrive_python, missing, root, run, target, told, uv,
};
use crate::tally::Tally;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A wheel that is given to anybody, of a release build, is smaller. [bytes]
const MAX_WHEEL_BYTES: u64 = 12_000_000;

/// What a source distribution needs beside the crates: they read it when they are compiled.
const SDIST_NEEDS: [&str; 6] = [
    "LICENSES.txt",
    "Cargo.lock",
    "profiles/open.toml",
    "profiles/paper.toml",
    "eval/labels.csv",
    "crates/python/src/lib.rs",
];

/// Lint, types, the wheel and the tests in it, the notebook, the API pages, and what a source distribution holds.
///
/// The wheel is of the dev profile, and of the libraries that the tests compiled: about half a minute for what is left, where a
/// release build takes ten.
pub fn step(tally: &mut Tally) -> Result {
    let Some(python) = find_python() else {
        return missing(tally, "wheel", "Python 3.11 is not on the PATH");
    };
    let (package, environment) = (root().join("python"), target().join("wheel-venv"));
    let own = |name: &str| environment.join(if cfg!(windows) { "Scripts" } else { "bin" }).join(name);
    // uv takes four seconds of processor time where pip takes forty: that compiles every module of Ray and the like, imported or not.
    let uv = uv();
    if !own("python").exists() {
        match &uv {
            Some(uv) => {
                run(Command::new(uv).args(["venv", "--quiet", "--seed", "--python", python]).arg(&environment))?
            }
            None => run(Command::new(python).args(["-m", "venv"]).arg(&environment))?,
        }
    }
    let pip = |arguments: &[&str]| {
        let mut command = Command::new(uv.clone().unwrap_or_else(|| own("python")));
        match uv {
            Some(_) => command.args(["pip", "install", "--python"]).arg(own("python")),
            None => command.args(["-m", "pip", "install", "--disable-pip-version-check"]),
        };
        command.arg("--quiet").args(arguments);
        command
    };
    run(pip(&["--requirement"]).arg(root().join("requirements/python.txt")))?;
    licences::check()?;
    run(Command::new(own("ruff")).args(["format", "--check"]).arg(&package))?;
    run(Command::new(own("ruff")).arg("check").arg(&package))?;
    let wheels = target().join("wheels-dev");
    // An older wheel would be found instead of the one that is built.
    let _ = fs::remove_dir_all(&wheels);
    shared_with_tests()?;
    let build = ["build", "--profile", "dev", "--features", "as-tests", "--interpreter"];
    run(command(own("maturin")).args(build).arg(own("python")).arg("--out").arg(&wheels).current_dir(&package))?;
    let wheel = only_file(&wheels)?;
    run(pip(&["--force-reinstall", "--no-deps"]).arg(&wheel))?;
    let installed = "import recrash, pathlib; print(pathlib.Path(recrash.__file__).parent)";
    run(Command::new(own("python")).args(["-c", installed]))?;
    run(Command::new(own("mypy")).args(["--package", "recrash"]).current_dir(&package))?;
    run(Command::new(own("stubtest")).args(["--ignore-disjoint-bases", "recrash._recrash"]))?;
    let mut tests = Command::new(own("pytest"));
    tests.args(["--quiet", "--nbmake", "-p", "no:cacheprovider", "--config-file"]).arg(package.join("pyproject.toml"));
    tests.arg(package.join("tests")).arg(package.join("examples/tutorial.ipynb")).env("RECRASH", built()?);
    if let Some(python) = metadrive_python() {
        tests.env("RECRASH_METADRIVE_PYTHON", python);
    }
    told(&mut tests, tally)?;
    let (pages, made) = (package.join("docs"), target().join("python-docs"));
    run(Command::new(own("sphinx-build")).args(["-q", "-W", "--keep-going", "-E"]).arg(&pages).arg(&made))?;
    source_distribution(&own("maturin"), &package)?;
    if released().is_empty() {
        println!("no release wheel in {}: its size is not checked", released_folder().display());
        return Ok(());
    }
    sizes()
}

/// Every release wheel is small enough. `pip wheel ./python` and `maturin build --release` leave theirs where this looks.
pub fn sizes() -> Result {
    let wheels = released();
    if wheels.is_empty() {
        return Err(format!("no wheel in {}", released_folder().display()));
    }
    for wheel in wheels {
        let bytes = fs::metadata(&wheel).map_err(|error| format!("{}: {error}", wheel.display()))?.len();
        let told = format!("{}: {bytes} bytes, under {MAX_WHEEL_BYTES} asked for", wheel.display());
        println!("{told}");
        if bytes >= MAX_WHEEL_BYTES {
            return Err(told);
        }
    }
    Ok(())
}

fn released_folder() -> PathBuf {
    target().join("wheels")
}

fn released() -> Vec<PathBuf> {
    let files = fs::read_dir(released_folder()).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
    files.filter(|file| file.extension().is_some_and(|extension| extension == "whl")).collect()
}

/// A source distribution is made, and everything that its crates read stands in it. That one builds from nothing is tried by hand:
/// it takes ten minutes (`bench-runs`).
fn source_distribution(maturin: &Path, package: &Path) -> Result {
    let folder = target().join("sdist");
    let _ = fs::remove_dir_all(&folder);
    run(command(maturin).args(["sdist", "--out"]).arg(&folder).current_dir(package))?;
    let sdist = only_file(&folder)?;
    let listed = Command::new("tar").arg("tzf").arg(&sdist).output().map_err(|error| format!("tar: {error}"))?;
    let listed = String::from_utf8_lossy(&listed.stdout);
    let held: Vec<&str> = listed.lines().filter_map(|name| name.split_once('/')).map(|(_, name)| name).collect();
    let missing: Vec<&str> = SDIST_NEEDS.into_iter().filter(|name| !held.contains(name)).collect();
    if missing.is_empty() { Ok(()) } else { Err(format!("{} lacks {}", sdist.display(), missing.join(", "))) }
}

/// With its feature `as-tests` the wheel asks of every library what the tests ask of it: else cargo would compile the library once
/// more, and all that use it.
fn shared_with_tests() -> Result {
    let tests = libraries(&["--workspace", "--edges", "normal,build,dev"])?;
    let wheel = libraries(&["--package", "recrash-python", "--features", "as-tests", "--edges", "normal,build"])?;
    let apart: Vec<&String> =
        wheel.difference(&tests).filter(|library| !library.starts_with("recrash-python ")).collect();
    if apart.is_empty() {
        return Ok(());
    }
    Err(format!("`as-tests` of crates/python/Cargo.toml asks for other features than the tests do: {apart:?}"))
}

/// Name, version and features of all libraries.
fn libraries(of: &[&str]) -> Result<BTreeSet<String>> {
    let mut tree = cargo_command();
    tree.args(["tree", "--quiet", "--no-dedupe", "--prefix", "none", "--format", "{p} [{f}]"]).args(of);
    let output = tree.current_dir(root()).output().map_err(|error| format!("cargo tree: {error}"))?;
    if !output.status.success() {
        return Err(format!("cargo tree: {}", String::from_utf8_lossy(&output.stderr)));
    }
    Ok(String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect())
}

fn only_file(folder: &Path) -> Result<PathBuf> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    match (files.next(), files.next()) {
        (Some(file), None) => Ok(file),
        _ => Err(format!("{} does not hold one file", folder.display())),
    }
}
