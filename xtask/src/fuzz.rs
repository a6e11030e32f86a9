//! Fuzzing with libFuzzer, whose targets are programs of the workspace in `fuzz`.

use crate::steps::{Result, cargo_command, root, run as run_command, target};
use crate::tally::Tally;
use recrash_testing::inputs;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The targets, each with the inputs that a short run tries: as many and the same on any machine, so that what it says of a state
/// of the code does not change.
const TARGETS: [(&str, u32); 4] =
    [("crash_file", 1_500), ("mapping", 30_000), ("openscenario", 20_000), ("scenario", 100_000)];
/// Longer than this no short run takes. [s]
const MOST_S: u32 = 60;
/// What libFuzzer wants of the compiler: counters of the edges reached, and the numbers that were compared.
const FLAGS: &str = "--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
    -Cllvm-args=-sanitizer-coverage-trace-compares";

/// A short run of every target, from the inputs that are known.
pub fn run(_: &mut Tally) -> Result {
    let programs = built()?;
    for (name, inputs) in TARGETS {
        let (fresh, known) = (folder(name, "fresh")?, known(name)?);
        let mut command = Command::new(programs.join(name));
        command.arg(fresh).arg(known).arg(root().join("fuzz/corpus").join(name));
        command.args(["-max_len=8192", "-seed=1", "-verbosity=0"]);
        command.args([format!("-runs={inputs}"), format!("-max_total_time={MOST_S}")]);
        command.arg(format!("-artifact_prefix={}/", folder(name, "findings")?.display()));
        let dictionary = root().join("fuzz/dictionaries").join(name);
        if dictionary.exists() {
            command.arg(format!("-dict={}", dictionary.display()));
        }
        run_command(&mut command)?;
    }
    Ok(())
}

/// Writes `fuzz/found` anew: of what is kept there and what runs here found, as few inputs as reach every edge of the code
/// that those written by hand do not.
pub fn keep() -> Result {
    let programs = built()?;
    for (name, _) in TARGETS {
        let (fresh, known, fewest) = (folder(name, "fresh")?, known(name)?, emptied(name, "fewest")?);
        let written = inputs::written(name);
        fill(&fewest, &written)?;
        let merge = ["-set_cover_merge=1", "-use_counters=0", "-max_len=8192", "-verbosity=1"];
        run_command(Command::new(programs.join(name)).args(merge).arg(&fewest).arg(known).arg(fresh))?;
        let entries = fs::read_dir(&fewest).map_err(|error| error.to_string())?.filter_map(|entry| entry.ok());
        let mut found: Vec<Vec<u8>> = entries.filter_map(|entry| fs::read(entry.path()).ok()).collect();
        found.retain(|input| !written.contains(input));
        println!("{name}: {} inputs written by hand, {} found", written.len(), found.len());
        let file = inputs::found_file(name);
        fs::write(&file, inputs::packed(found)).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(())
}

/// Builds all targets; the folder they are in.
///
/// Naming the host as the target keeps the counters out of what runs while building: macros and build scripts are those that the tests have.
fn built() -> Result<PathBuf> {
    let host = host()?;
    run_command(
        cargo_command()
            .args(["build", "--bins", "--target", &host, "--manifest-path"])
            .arg(root().join("fuzz/Cargo.toml"))
            .env("RUSTFLAGS", FLAGS)
            .env("CARGO_TARGET_DIR", target()),
    )?;
    Ok(target().join(host).join("debug"))
}

/// The machine that the compiler builds for when nobody says so.
fn host() -> Result<String> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).arg("-vV").output().map_err(|error| format!("rustc: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| "rustc -vV names no host".to_owned())
}

/// The inputs that fuzzing found before, as the files that libFuzzer reads.
fn known(name: &str) -> Result<PathBuf> {
    let folder = emptied(name, "known")?;
    fill(&folder, &inputs::found(name))?;
    Ok(folder)
}

fn fill(folder: &Path, inputs: &[Vec<u8>]) -> Result {
    for (number, input) in inputs.iter().enumerate() {
        let file = folder.join(number.to_string());
        fs::write(&file, input).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(())
}

fn emptied(name: &str, what: &str) -> Result<PathBuf> {
    let folder = folder(name, what)?;
    fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    self::folder(name, what)
}

/// A folder of a target that outlives the run.
fn folder(name: &str, what: &str) -> Result<PathBuf> {
    let folder = target().join("fuzz").join(name).join(what);
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    Ok(folder)
}
