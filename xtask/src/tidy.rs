//! What no compiler checks. Every rule names the file and how to mend it.

use crate::steps::{Result, root};
use crate::tally::Tally;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Longest file of code, tests excepted. [lines]
const MAX_LINES: usize = 800;
/// Two screens of a terminal, on which ARCHITECTURE.md says the shape. [lines of 120 columns]
const SHAPE_LINES: usize = 100;
const SHAPE_COLUMNS: usize = 120;
/// Folders that hold nothing of ours.
const FOREIGN: [&str; 8] =
    ["target", ".git", ".venv", ".oracles", ".pytest_cache", ".mypy_cache", ".ruff_cache", "node_modules"];
/// Folders that need no line in the map.
const UNMAPPED: [&str; 3] = ["crates", ".cargo", ".ci"];

/// Runs every rule and prints what was found.
pub fn run(_: &mut Tally) -> Result {
    let root = root();
    let mut files = Vec::new();
    collect(&root, &mut files);
    let mut problems = map_problems(&root);
    problems.extend(test_binary_problems(&files.iter().map(|file| below(&root, file)).collect::<Vec<_>>()));
    problems.extend(shape_problems(&fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap_or_default()));
    problems.extend(crate::edges::problems(&root)?);
    let works = crate::pages::works(&fs::read_to_string(root.join("docs/references.bib")).unwrap_or_default());
    for file in &files {
        let name = below(&root, file);
        if let Ok(text) = fs::read_to_string(file) {
            problems.extend(file_problems(&name, &text));
            problems.extend(crate::pages::problems(&root, &name, &text, &works));
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

/// A file's name from the root on.
fn below(root: &Path, file: &Path) -> String {
    file.strip_prefix(root).unwrap_or(file).to_string_lossy().replace('\\', "/")
}

/// Each file or folder of a crate's `tests` is a program of its own, which takes seconds to link.
fn test_binary_problems(files: &[String]) -> Vec<String> {
    let mut programs: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for file in files {
        let Some((folder, rest)) = file.strip_prefix("crates/").and_then(|path| path.split_once("/tests/")) else {
            continue;
        };
        let of_its_own = !folder.contains('/')
            && match rest.split_once('/') {
                None => rest.ends_with(".rs"),
                Some((_, inner)) => inner == "main.rs",
            };
        if of_its_own {
            programs.entry(folder).or_default().push(rest);
        }
    }
    let several = programs.into_iter().filter(|(_, found)| found.len() > 1);
    several
        .map(|(name, found)| {
            format!("crates/{name}: has {} test programs ({}); make them modules of one", found.len(), found.join(", "))
        })
        .collect()
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

/// What a newcomer reads first stands before what is looked up, and on two screens.
fn shape_problems(text: &str) -> Option<String> {
    let Some((shape, _)) = text.split_once("\n# To look things up\n") else {
        return Some("ARCHITECTURE.md: has no line `# To look things up`, which ends what is read first".into());
    };
    let lines: usize = shape.lines().map(|line| line.chars().count().div_ceil(SHAPE_COLUMNS).max(1)).sum();
    (lines > SHAPE_LINES).then(|| {
        format!(
            "ARCHITECTURE.md: the shape takes {lines} lines; move what is looked up down, {SHAPE_LINES} are two screens"
        )
    })
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
        for (pattern, advice) in
            [("#[ignore", "run the test or remove it"), ("todo!(", "write it"), ("unimplemented!(", "write it")]
        {
            if text.contains(pattern) {
                problems.push(format!("{name}: holds `{pattern}`; {advice}"));
            }
        }
        for (path, advice) in [
            ("std::collections::HashMap", "use BTreeMap: the order of a HashMap is not the same twice"),
            ("std::collections::HashSet", "use BTreeSet: the order of a HashSet is not the same twice"),
        ] {
            if uses(text, path) {
                problems.push(format!("{name}: uses `{path}`; {advice}"));
            }
        }
        let may_speak = ["crates/agents/", "crates/fetch/"].iter().any(|folder| name.starts_with(folder));
        if !may_speak && !test && name.starts_with("crates/") {
            for import in ["ureq::", "std::net"] {
                if uses(text, import) {
                    problems.push(format!("{name}: uses {import}; only agents and fetch speak to a network"));
                }
            }
        }
        let library = name.starts_with("crates/") && name.contains("/src/") && !test;
        if library && !KNOW_OPTIONS.iter().any(|folder| name.starts_with(folder)) {
            for (line, option) in options_named(text) {
                problems.push(format!(
                    "{name}:{line}: names the option {option}; a library does not know how it is called, so say it in plain \
                     words and let the command name the option"
                ));
            }
        }
        if let Some(stage) = stage_crate(name) {
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            let test = test || name.contains("/examples/") || name.contains("/benches/");
            for path in BEYOND_VALUES {
                if !test && !ALLOWED.contains(&(name, path)) && uses(code, path) {
                    problems.push(format!("{name}: stage crate {stage} uses {path}; that belongs in pipeline"));
                }
            }
        }
    }
    problems
}

/// Commands of other programs, whose options are theirs.
const OTHER_PROGRAMS: [&str; 3] = ["netconvert ", "pip download ", "scenic {"];

/// Where options are named: the command, and files and pages that tell the command which makes them again.
const KNOW_OPTIONS: [&str; 8] = [
    "crates/cli/",
    "crates/pipeline/src/embedding/weights.rs",
    "crates/pipeline/src/options.rs",
    "crates/pipeline/src/stages/view.rs",
    "crates/pipeline/src/tools/comparing/page.rs",
    "crates/pipeline/src/tools/evidence/claims.rs",
    "crates/pipeline/src/tools/parity/tables.rs",
    "crates/report/src/page/overview.rs",
];

/// Lines whose texts name an option of a command line. A text that is nothing but an option is an argument of a program.
fn options_named(text: &str) -> Vec<(usize, String)> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let named = |line: &str| {
        line.match_indices("--").find_map(|(at, _)| {
            let word: String = line[at + 2..].chars().take_while(|c| c.is_ascii_lowercase() || *c == '-').collect();
            let (before, behind) = (line[..at].chars().last()?, line[at + 2 + word.len()..].chars().next());
            let told = matches!(before, ' ' | '`') || (before == '"' && behind != Some('"'));
            let ours = !OTHER_PROGRAMS.iter().any(|program| line[..at].contains(program));
            (told && ours && word.starts_with(|c: char| c.is_ascii_lowercase())).then(|| format!("--{word}"))
        })
    };
    let lines =
        code.lines().enumerate().filter(|(_, line)| line.contains("--") && !line.trim_start().starts_with("//"));
    lines.filter_map(|(number, line)| Some((number + 1, named(line)?))).collect()
}

/// What a crate that only turns values into values has no use for.
const BEYOND_VALUES: [&str; 7] =
    ["std::fs", "std::env", "std::thread", "std::time::Instant", "std::time::SystemTime", "std::net", "std::process"];

/// Where it is used all the same. Nothing that is written depends on it: patience with a provider, and threads of a batch that
/// stay awake for a moment between two steps.
const ALLOWED: [(&str, &str); 5] = [
    ("crates/agents/src/llm/live.rs", "std::net"),
    ("crates/agents/src/llm/live.rs", "std::thread"),
    ("crates/agents/src/llm/live.rs", "std::time::Instant"),
    ("crates/gym/src/batch.rs", "std::thread"),
    ("crates/gym/src/batch.rs", "std::time::Instant"),
];

/// Whether code names a path: as it is, or as one of several in the braces of a `use`.
fn uses(code: &str, path: &str) -> bool {
    let trees = code.split(';').filter_map(|part| Some(part.rsplit_once("use ")?.1)).filter(|tree| tree.contains('{'));
    code.contains(path) || trees.flat_map(|tree| expanded("", tree)).any(|found| is_below(&found, path))
}

fn is_below(found: &str, path: &str) -> bool {
    found.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

/// The paths of a `use`: `a::{b, c::{d, e}}` is `a::b`, `a::c::d` and `a::c::e`.
fn expanded(before: &str, tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some((path, inner)) = tree.split_once('{') else {
        return vec![format!("{before}{}", tree.split(" as ").next().unwrap_or(tree))];
    };
    let inner = inner.trim_end().strip_suffix('}').unwrap_or(inner);
    let before = format!("{before}{}", path.trim());
    let (mut depth, mut start, mut all) = (0, 0, Vec::new());
    for (at, c) in inner.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                all.extend(expanded(&before, &inner[start..at]));
                start = at + 1;
            }
            _ => {}
        }
    }
    all.extend(expanded(&before, &inner[start..]));
    all
}

/// The crate a file belongs to, where it is a stage: value in, value out.
fn stage_crate(name: &str) -> Option<&str> {
    let stage = name.strip_prefix("crates/")?.split('/').next()?;
    let stages = [
        "agents",
        "drivers",
        "embed",
        "export",
        "gym",
        "lab",
        "metrics",
        "model",
        "plan",
        "reader",
        "reconstruct",
        "records",
        "report",
        "roads",
        "search",
        "select",
        "sim",
    ];
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
    fn what_is_checked_has_the_parts_and_tests_that_are_named_as_a_run_s_folder_is() {
        let mut files = Vec::new();
        collect(&root().join("crates/pipeline"), &mut files);
        for part in ["src/suite", "tests/suite"] {
            assert!(files.iter().any(|file| file.starts_with(root().join("crates/pipeline").join(part))), "{part}");
        }
    }

    #[test]
    fn rows_of_the_map_are_read() {
        let text = "# A\n## Map\n| folder | what |\n|---|---|\n| `crates/model` | nouns |\n| `docs` | pages |\n## More\n| `x` | |";
        assert_eq!(mapped_folders(text), BTreeSet::from(["crates/model".into(), "docs".into()]));
    }

    #[test]
    fn the_shape_of_the_house_stands_on_two_screens() {
        let told = |text: &str| shape_problems(text).unwrap_or_default();
        assert_eq!(told(&fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap()), "");
        assert!(told("# A\n").contains("has no line"));
        let screens = |lines: usize| format!("{}# To look things up\n", "flow\n".repeat(lines));
        assert_eq!(told(&screens(SHAPE_LINES)), "");
        assert!(told(&screens(SHAPE_LINES + 1)).contains("takes 101 lines"));
        let long = format!("{}\n{}", "x".repeat(SHAPE_COLUMNS + 1), screens(SHAPE_LINES - 1));
        assert!(told(&long).contains("takes 101 lines"));
    }

    #[test]
    fn a_stage_that_opens_files_is_told() {
        assert_eq!(file_problems("crates/sim/src/a.rs", "use std::fs::File;").len(), 1);
        assert_eq!(file_problems("crates/pipeline/src/a.rs", "use std::fs::File;").len(), 0);
    }

    #[test]
    fn an_import_is_found_however_it_is_written() {
        for code in [
            "use std::time::Instant;",
            "use std::time::{Duration, Instant};",
            "use std::{\n    collections::BTreeMap,\n    time::{Duration, Instant as Now},\n};",
            "let now = std::time::Instant::now();",
        ] {
            let told = file_problems("crates/lab/src/a.rs", code);
            assert_eq!(told.len(), 1, "{code}: {told:?}");
        }
        assert_eq!(file_problems("crates/lab/src/a.rs", "use std::time::{Duration};").len(), 0);
        assert_eq!(file_problems("crates/cli/src/a.rs", "use std::collections::{BTreeMap, HashMap};").len(), 1);
        assert_eq!(expanded("", "a::{b, c::{d, e}}"), ["a::b", "a::c::d", "a::c::e"]);
    }

    #[test]
    fn a_crate_that_speaks_to_a_network_is_told() {
        assert_eq!(file_problems("crates/pipeline/src/a.rs", "use std::net::TcpStream;").len(), 1);
        assert_eq!(file_problems("crates/fetch/src/a.rs", "ureq::get(url)").len(), 0);
    }

    #[test]
    fn a_library_that_names_an_option_is_told() {
        let told = |name: &str, line: &str| file_problems(name, line).len();
        let error = r#"    bad("it is there already; add --force to overwrite it")"#;
        for name in ["crates/sim/src/a.rs", "crates/fetch/src/a.rs", "crates/pipeline/src/tools/a.rs"] {
            assert_eq!(told(name, error), 1, "{name}");
        }
        for name in ["crates/cli/src/a.rs", "crates/sim/tests/suite/a.rs", "xtask/src/a.rs"] {
            assert_eq!(told(name, error), 0, "{name}");
        }
        for (line, expected) in [
            (r#"format!("--vary {pointer}: there is no such number")"#, 1),
            (r#"hint("run `recrash simulate --out suite`")"#, 1),
            (r#".args(["-c", BOOT, "--worker"])"#, 0),
            (r#"path stroke="var(--ego)" {}"#, 0),
            (r#"hint("`pip download --no-deps {package}` gets it")"#, 0),
            ("    /// As `--force` of the command does.", 0),
            ("let x = a - -b; // -- a rule --", 0),
            ("#[cfg(test)]\nmod tests { const WORDS: &str = \"run --quiet\"; }", 0),
        ] {
            assert_eq!(told("crates/sim/src/a.rs", line), expected, "{line}");
        }
    }

    #[test]
    fn a_crate_with_two_test_programs_is_told() {
        let told =
            |files: &[&str]| test_binary_problems(&files.iter().map(|file| (*file).to_owned()).collect::<Vec<_>>());
        let one =
            ["crates/sim/tests/suite/main.rs", "crates/sim/tests/suite/runs.rs", "crates/sim/tests/fixtures/a.txt"];
        assert_eq!(told(&one), Vec::<String>::new());
        assert_eq!(told(&[&one[..], &["crates/drivers/tests/published.rs", "tests/main.rs"]].concat()).len(), 0);
        for second in ["crates/sim/tests/fast.rs", "crates/sim/tests/other/main.rs"] {
            assert_eq!(told(&[&one[..], &[second]].concat()).len(), 1, "{second}");
        }
    }

    #[test]
    fn long_files_and_left_out_tests_are_told() {
        assert_eq!(file_problems("crates/sim/src/a.rs", &"\n".repeat(801)).len(), 1);
        assert_eq!(file_problems("crates/sim/tests/a.rs", "#[ignore] fn a() {}").len(), 1);
    }
}
