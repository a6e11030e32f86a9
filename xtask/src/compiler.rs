//! The compiler as cargo calls it for the crates of this project whenever xtask calls cargo: this program, which hands each call on
//! to Clippy's driver and notes it. So a crate is linted while it is built, and its pages are made of what was built; cargo alone
//! would check it, and every library that it uses, a second time for that (`bench-runs/2026-11-27-ci-same-machine.txt`).

use crate::steps::{Result, run, target};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::OnceLock;
use std::{env, fs};

/// Names the folder of the notes; set where this program stands in for the compiler.
const NOTES: &str = "RECRASH_XTASK_NOTES";
/// Clippy's arguments, apart as cargo clippy sets them.
const ARGUMENTS: &str = "-D__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__";

/// How the names of variables begin that code reads when it is compiled: cargo's, and those that build scripts of ours set. Others may be
/// secrets.
const READ: [&str; 6] =
    ["CARGO_PKG_", "CARGO_MANIFEST_", "CARGO_BIN_NAME", "CARGO_CRATE_NAME", "OUT_DIR", "RECRASH_CODE"];

/// What [`variables`] gives, once [`prepare`] has made it.
static VARIABLES: OnceLock<Vec<(&str, OsString)>> = OnceLock::new();

/// Variables that make cargo call the compiler through this program.
pub fn variables() -> impl Iterator<Item = (&'static str, &'static OsString)> {
    VARIABLES.get().into_iter().flatten().map(|(name, value)| (*name, value))
}

/// Puts a copy of this program where cargo will call it: the program itself cargo replaces when it builds the workspace.
///
/// # Errors
/// Clippy is not installed, or the folder of what is built cannot be written.
pub fn prepare() -> Result {
    if !tool("clippy-driver").is_file() {
        return Err("Clippy is not installed: rustup component add clippy".to_owned());
    }
    let stand_in = program();
    let copied = || {
        let program = fs::read(env::current_exe()?)?;
        if fs::read(&stand_in).is_ok_and(|there| there == program) {
            return Ok(());
        }
        fs::create_dir_all(folder())?;
        let fresh = stand_in.with_extension("new");
        fs::copy(env::current_exe()?, &fresh)?;
        fs::rename(fresh, &stand_in)
    };
    copied().map_err(|error: std::io::Error| format!("{}: {error}", stand_in.display()))?;
    let notes = folder().join("notes").into();
    let named = [("RUSTC_WORKSPACE_WRAPPER", stand_in.into()), ("CLIPPY_ARGS", ARGUMENTS.into()), (NOTES, notes)];
    // Who prepares twice gets the same.
    let _ = VARIABLES.set(named.into());
    Ok(())
}

/// The copy of this program, which stays where it is while cargo builds.
pub fn program() -> PathBuf {
    folder().join(format!("xtask{}", env::consts::EXE_SUFFIX))
}

/// Compiles what cargo asks for, if it is cargo that calls; `None` for everybody else.
pub fn stand_in() -> Option<ExitCode> {
    let notes = PathBuf::from(env::var_os(NOTES)?);
    let mut arguments = env::args_os().skip(1);
    let compiler = PathBuf::from(arguments.next()?);
    if compiler.file_stem()? != "rustc" {
        return None;
    }
    let arguments: Vec<OsString> = arguments.collect();
    let noted = note(&arguments).map_or(Ok(()), |(name, note)| {
        fs::create_dir_all(&notes)?;
        fs::write(notes.join(name), note.to_string())
    });
    if let Err(error) = noted {
        eprintln!("xtask: {}: {error}", notes.display());
        return Some(ExitCode::FAILURE);
    }
    let status = Command::new(compiler.with_file_name("clippy-driver")).arg(&compiler).args(&arguments).status();
    match status {
        Ok(status) => Some(status.code().map_or(ExitCode::FAILURE, |code| ExitCode::from(code.clamp(0, 255) as u8))),
        Err(error) => {
            eprintln!("xtask: clippy-driver: {error}");
            Some(ExitCode::FAILURE)
        }
    }
}

/// Name and content of the note of a call that builds a library or a program; `None` for tests, examples and questions. A program that no
/// test calls is built for its own tests alone: without `--test` that call is its.
fn note(arguments: &[OsString]) -> Option<(String, Value)> {
    let arguments: Vec<&str> = arguments.iter().map(|argument| argument.to_str()).collect::<Option<_>>()?;
    let after = |name: &str| Some(arguments[arguments.iter().position(|argument| *argument == name)? + 1]);
    let source = Path::new(arguments.iter().find(|argument| argument.ends_with(".rs"))?);
    let tested = arguments.contains(&"--test");
    let program = source.ends_with("src/main.rs");
    if tested && !program || !source.components().any(|part| part.as_os_str() == "src") {
        return None;
    }
    let (name, kind) = (after("--crate-name")?, if program { "bin" } else { after("--crate-type")? });
    let mut asked: Vec<&str> = arguments.iter().copied().filter(|argument| *argument != "--test").collect();
    if tested {
        asked.extend(["--crate-type", "bin"]);
    }
    let read = |name: &str| READ.iter().any(|known| name.starts_with(known));
    let variables: BTreeMap<String, String> = env::vars().filter(|(name, _)| read(name)).collect();
    let note = json!({ "name": name, "folder": env::current_dir().ok()?, "variables": variables, "arguments": asked });
    Some((format!("{name}-{kind}.json"), note))
}

/// A call of the compiler as it was noted.
struct Call {
    name: String,
    folder: PathBuf,
    variables: Vec<(String, String)>,
    arguments: Vec<String>,
}

impl Call {
    fn read(note: &Path) -> Option<Call> {
        let note: Value = serde_json::from_slice(&fs::read(note).ok()?).ok()?;
        let text = |value: &Value| value.as_str().map(str::to_owned);
        let variables = note["variables"].as_object()?.iter();
        Some(Call {
            name: text(&note["name"])?,
            folder: text(&note["folder"])?.into(),
            variables: variables.map(|(name, value)| Some((name.clone(), text(value)?))).collect::<Option<_>>()?,
            arguments: note["arguments"].as_array()?.iter().map(text).collect::<Option<_>>()?,
        })
    }

    /// What was asked, each with its value, if it has one, without what says which files are written and how code is made.
    fn asked(&self) -> Vec<(&str, Option<&str>)> {
        let mut left = self.arguments.iter().map(String::as_str);
        let mut asked = Vec::new();
        while let Some(argument) = left.next() {
            let value = if APART.contains(&argument) { left.next() } else { None };
            if !DROPPED.iter().any(|dropped| argument.starts_with(dropped)) {
                asked.push((argument, value));
            }
        }
        asked
    }

    /// The libraries that it uses itself.
    fn uses(&self) -> Vec<&str> {
        self.asked().into_iter().filter_map(library).collect()
    }

    /// A tool in the place of the compiler, as cargo would start it.
    fn again(&self, program: &str) -> Command {
        let mut command = Command::new(tool(program));
        command.current_dir(&self.folder).envs(self.variables.iter().map(|(name, value)| (name, value)));
        command
    }
}

/// Arguments whose value stands apart.
const APART: [&str; 8] = ["--cfg", "--check-cfg", "--crate-name", "--crate-type", "--extern", "--out-dir", "-C", "-L"];
/// Arguments about what is written.
const DROPPED: [&str; 5] = ["--emit", "--error-format", "--json", "--out-dir", "-C"];

/// Name of the library that an argument brings in.
fn library<'a>((argument, value): (&str, Option<&'a str>)) -> Option<&'a str> {
    let (name, _) = value.filter(|_| argument == "--extern")?.split_once('=')?;
    Some(name.rsplit(':').next().unwrap_or(name))
}

/// The noted calls, in the order of their names; of what is no more part of the project none.
fn calls() -> Result<Vec<Call>> {
    let notes = folder().join("notes");
    let entries = fs::read_dir(&notes).map_err(|error| format!("{}: {error}", notes.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    let read = paths.iter().map(|path| Call::read(path).ok_or_else(|| format!("{} is no note", path.display())));
    let source = |call: &Call| {
        call.arguments.iter().any(|argument| argument.ends_with(".rs") && call.folder.join(argument).is_file())
    };
    read.filter(|call| call.as_ref().map_or(true, source)).collect()
}

/// Pages of every library and program, warnings denied, and links that lead nowhere.
pub fn pages() -> Result {
    for call in calls()? {
        let mut rustdoc = call.again("rustdoc");
        for (argument, value) in call.asked() {
            if !argument.contains("=clippy::") {
                rustdoc.arg(argument).args(value);
            }
        }
        let pages = ["--document-private-items", "-D", "warnings", "--out-dir"];
        crate::links::checked(rustdoc.args(pages).arg(target().join("doc")))?;
    }
    Ok(())
}

/// Checks and lints a library without one of its features, which brings another library; and all that use it.
pub fn without(feature: &str, of: &str, brings: &str) -> Result {
    let into = folder().join(format!("without-{feature}"));
    fs::create_dir_all(&into).map_err(|error| format!("{}: {error}", into.display()))?;
    let (mut concerned, mut others): (Vec<Call>, Vec<Call>) = calls()?.into_iter().partition(|call| call.name == of);
    if concerned.is_empty() {
        return Err(format!("{of} was not built"));
    }
    while let Some(at) = others.iter().position(|call| call.uses().iter().any(|name| names(&concerned, name))) {
        concerned.push(others.remove(at));
    }
    let (switch, file) = (format!("feature=\"{feature}\""), |name: &str| into.join(format!("lib{name}.rmeta")));
    let all: Vec<String> = concerned.iter().map(|call| call.name.clone()).collect();
    // Each behind what it uses.
    while let Some(at) = concerned.iter().position(|call| !call.uses().iter().any(|name| names(&concerned, name))) {
        let call = concerned.remove(at);
        let mut driver = call.again("clippy-driver");
        driver.arg("rustc").env("CLIPPY_ARGS", ARGUMENTS);
        for asked @ (argument, value) in call.asked() {
            match library(asked) {
                _ if value == Some(&switch) => {}
                Some(name) if name == brings => {}
                Some(name) if all.iter().any(|known| known == name) => {
                    driver.arg(argument).arg(format!("{name}={}", file(name).display()));
                }
                _ => {
                    driver.arg(argument).args(value);
                }
            }
        }
        run(driver.arg("-L").arg(&into).arg(format!("--emit=metadata={}", file(&call.name).display())))?;
    }
    Ok(())
}

fn names(calls: &[Call], name: &str) -> bool {
    calls.iter().any(|call| call.name == name)
}

/// A tool of the compiler, beside the cargo that runs this.
fn tool(name: &str) -> PathBuf {
    let cargo = PathBuf::from(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.with_file_name(format!("{name}{}", env::consts::EXE_SUFFIX))
}

fn folder() -> PathBuf {
    target().join("xtask-compiler")
}
