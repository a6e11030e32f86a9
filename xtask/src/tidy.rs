//! What no compiler checks. Every rule names the file and how to mend it.

use crate::steps::{Result, root};
use crate::tally::Tally;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Longest file of code, tests excepted. [lines]
const MAX_LINES: usize = 800;
/// Folders that hold nothing of ours.
const FOREIGN: [&str; 9] =
    ["target", ".git", ".venv", ".oracles", ".pytest_cache", ".mypy_cache", ".ruff_cache", "node_modules", "suite"];
/// Folders that need no line in the map.
const UNMAPPED: [&str; 3] = ["crates", ".cargo", ".ci"];

/// Runs every rule and prints what was found.
pub fn run(_: &mut Tally) -> Result {
    let root = root();
    let mut files = Vec::new();
    collect(&root, &mut files);
    let mut problems = map_problems(&root);
    problems.extend(crate::edges::problems(&root)?);
    for file in &files {
        let name = file.strip_prefix(&root).unwrap_or(file).to_string_lossy().replace('\\', "/");
        if let Ok(text) = fs::read_to_string(file) {
            problems.extend(file_problems(&name, &text));
        }
    }
    for problem in &problems {
        eprintln!("tidy: {problem}");
    }
    match problems.len() {
        0 => Ok(()),
        n => Err(format!("{n} problems")),
    }
}

/// Every file below a folder, in order; those of others left out.
pub fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().filter_map(|e| e.ok().map(|e| e.path())).collect();
    entries.sort();
    for entry in entries {
        let name = entry.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !entry.is_dir() {
            files.push(entry);
        } else if !FOREIGN.contains(&name.as_str()) && !entry.join("suite.json").exists() {
            collect(&entry, files);
        }
    }
}

/// The table in ARCHITECTURE.md names every folder there is, and no other.
fn map_problems(root: &Path) -> Vec<String> {
    let text = fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap_or_default();
    let mapped: BTreeSet<String> = mapped_folders(&text);
    let mut there = folders(root);
    there.retain(|folder| !UNMAPPED.contains(&folder.as_str()));
    there.extend(folders(&root.join("crates")).into_iter().map(|folder| format!("crates/{folder}")));
    let missing = there.difference(&mapped).map(|f| format!("ARCHITECTURE.md: the map has no line for {f}"));
    let gone = mapped.difference(&there).map(|f| format!("ARCHITECTURE.md: the map names {f}, which is not there"));
    missing.chain(gone).collect()
}

/// First cells of the rows of the map: `| `folder` | ...`.
fn mapped_folders(text: &str) -> BTreeSet<String> {
    let map = text.split("## Map").nth(1).and_then(|rest| rest.split("\n## ").next()).unwrap_or_default();
    map.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next().map(str::to_owned)).collect()
}

fn folders(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(|e| e.ok());
    entries
        .filter(|entry| entry.path().is_dir() && !entry.path().join("suite.json").exists())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| !FOREIGN.contains(&name.as_str()))
        .collect()
}

/// Rules for one file.
fn file_problems(name: &str, text: &str) -> Vec<String> {
    let mut problems = Vec::new();
    let code = [".rs", ".py", ".js", ".mjs", ".css", ".toml"].iter().any(|ending| name.ends_with(ending));
    let test = name.contains("/tests/") || name.starts_with("tests/");
    let lines = text.lines().count();
    if code && !test && lines > MAX_LINES {
        problems.push(format!("{name}: {lines} lines; split it, {MAX_LINES} is the most"));
    }
    if name.ends_with(".rs") && name != "xtask/src/tidy.rs" {
        for (pattern, advice) in [
            ("#[ignore", "run the test or remove it"),
            ("todo!(", "write it"),
            ("unimplemented!(", "write it"),
            ("use std::collections::HashMap", "use BTreeMap: the order of a HashMap is not the same twice"),
            ("use std::collections::HashSet", "use BTreeSet: the order of a HashSet is not the same twice"),
        ] {
            if text.contains(pattern) {
                problems.push(format!("{name}: holds `{pattern}`; {advice}"));
            }
        }
        let may_speak = ["crates/agents/", "crates/fetch/"].iter().any(|folder| name.starts_with(folder));
        if !may_speak && !test && name.starts_with("crates/") {
            for import in ["ureq::", "std::net"] {
                if text.contains(import) {
                    problems.push(format!("{name}: uses {import}; only agents and fetch speak to a network"));
                }
            }
        }
        if let Some(stage) = stage_crate(name) {
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            // Patience with a provider is measured by the clock; nothing that is written depends on it.
            let test = test || name == "crates/agents/src/llm/live.rs";
            for import in
                ["std::fs", "std::env", "std::thread", "time::Instant", "time::SystemTime", "std::net", "std::process"]
            {
                if !test && !name.contains("/examples/") && !name.contains("/benches/") && code.contains(import) {
                    problems.push(format!("{name}: stage crate {stage} uses {import}; that belongs in pipeline"));
                }
            }
        }
    }
    problems
}

/// The crate a file belongs to, where it is a stage: value in, value out.
fn stage_crate(name: &str) -> Option<&str> {
    let stage = name.strip_prefix("crates/")?.split('/').next()?;
    let stages = ["model", "records", "select", "roads", "sim", "metrics", "search", "report", "agents"];
    stages.contains(&stage).then_some(stage)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_of_the_architecture_holds() {
        assert_eq!(map_problems(&root()), Vec::<String>::new());
    }

    #[test]
    fn rows_of_the_map_are_read() {
        let text = "# A\n## Map\n| folder | what |\n|---|---|\n| `crates/model` | nouns |\n| `docs` | pages |\n## More\n| `x` | |";
        assert_eq!(mapped_folders(text), BTreeSet::from(["crates/model".into(), "docs".into()]));
    }

    #[test]
    fn a_stage_that_opens_files_is_told() {
        assert_eq!(file_problems("crates/sim/src/a.rs", "use std::fs::File;").len(), 1);
        assert_eq!(file_problems("crates/pipeline/src/a.rs", "use std::fs::File;").len(), 0);
    }

    #[test]
    fn a_crate_that_speaks_to_a_network_is_told() {
        assert_eq!(file_problems("crates/pipeline/src/a.rs", "use std::net::TcpStream;").len(), 1);
        assert_eq!(file_problems("crates/fetch/src/a.rs", "ureq::get(url)").len(), 0);
    }

    #[test]
    fn long_files_and_left_out_tests_are_told() {
        assert_eq!(file_problems("crates/sim/src/a.rs", &"\n".repeat(801)).len(), 1);
        assert_eq!(file_problems("crates/sim/tests/a.rs", "#[ignore] fn a() {}").len(), 1);
    }
}
