//! Which crate may use which, and which part of a crate which other part: the table in ARCHITECTURE.md against cargo's own
//! word, and no two files of a crate that use each other in a circle.

use crate::steps::{Result, cargo_command, root};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Names, and the names that each uses.
type Uses = BTreeMap<String, BTreeSet<String>>;

/// Crates that no table speaks of: what tests share, and the script language.
const FREE: [&str; 1] = ["testing"];

/// Every rule of this file.
pub fn problems(root: &Path) -> Result<Vec<String>> {
    let text = fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap_or_default();
    let mut problems = edge_problems(&allowed(&text), &crate_uses("normal,build")?, &crate_uses("dev")?);
    let entries = fs::read_dir(root.join("crates")).map_err(|error| format!("crates: {error}"))?;
    let mut crates: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.file_name())).collect();
    crates.sort();
    for name in &crates {
        let source = root.join("crates").join(name).join("src");
        for uses in [part_uses(&source), file_uses(&source)] {
            problems.extend(circle_problems(&name.to_string_lossy(), &uses));
        }
    }
    Ok(problems)
}

/// What the table of edges allows: for each crate what it may use, and what its tests may use besides.
fn allowed(text: &str) -> BTreeMap<String, [BTreeSet<String>; 2]> {
    let table = text.split("## Edges").nth(1).and_then(|rest| rest.split("\n## ").next()).unwrap_or_default();
    let names = |cell: &str| cell.split(',').map(|name| name.trim().to_owned()).filter(|name| name != "-").collect();
    table
        .lines()
        .filter_map(|line| {
            let cells: Vec<&str> = line.strip_prefix("| `")?.split('|').map(str::trim).collect();
            let [name, uses, tests, ..] = cells[..] else { return None };
            Some((name.trim_matches('`').to_owned(), [names(uses), names(tests)]))
        })
        .collect()
}

/// The crates of ours that each crate of ours uses, as cargo sees it.
fn crate_uses(kind: &str) -> Result<Uses> {
    let tree = ["tree", "--workspace", "--depth", "1", "--prefix", "depth", "--format", " {p}", "--all-features"];
    let output = cargo_command()
        .args(tree)
        .args(["--target", "all", "--no-dedupe", "--edges", kind])
        .current_dir(root())
        .output()
        .map_err(|error| format!("cargo tree: {error}"))?;
    if !output.status.success() {
        return Err(format!("cargo tree: {}", String::from_utf8_lossy(&output.stderr)));
    }
    Ok(tree_uses(&String::from_utf8_lossy(&output.stdout)))
}

/// Reads `cargo tree`: lines such as `0 recrash-cli v0.1.0 (...)` and, for what it uses, `1 recrash-model v0.1.0 (...)`.
fn tree_uses(tree: &str) -> Uses {
    let mut uses = Uses::new();
    let mut user = None;
    for line in tree.lines() {
        let Some((depth, rest)) = line.split_once(' ') else { continue };
        let Some(name) = rest.split(' ').next().and_then(|name| name.strip_prefix("recrash-")) else {
            // A crate that is not ours, or this one.
            user = if depth == "0" { None } else { user };
            continue;
        };
        match (depth, &user) {
            ("0", _) => {
                uses.entry(name.to_owned()).or_default();
                user = Some(name.to_owned());
            }
            (_, Some(user)) => {
                uses.entry(user.clone()).or_default().insert(name.to_owned());
            }
            (_, None) => {}
        }
    }
    uses
}

fn edge_problems(allowed: &BTreeMap<String, [BTreeSet<String>; 2]>, normal: &Uses, tests: &Uses) -> Vec<String> {
    let mut problems = Vec::new();
    for (number, (what, uses)) in [("", normal), ("tests of ", tests)].into_iter().enumerate() {
        for (name, used) in uses.iter().filter(|(name, _)| !FREE.contains(&name.as_str())) {
            let Some(may) = allowed.get(name) else {
                problems.push(format!("ARCHITECTURE.md: the table of edges has no line for {name}"));
                continue;
            };
            let used: BTreeSet<&String> = used.iter().filter(|name| !FREE.contains(&name.as_str())).collect();
            // What a crate may use its tests may use as well.
            let is_allowed = |other: &str| may[..=number].iter().any(|may| may.contains(other));
            let too_many = used.iter().filter(|other| !is_allowed(other));
            problems.extend(too_many.map(|other| {
                format!("crates/{name}: {what}{name} may not use {other}; see the table of edges in ARCHITECTURE.md")
            }));
            let stale = may[number].iter().filter(|other| !used.contains(other));
            problems.extend(stale.map(|other| {
                format!("ARCHITECTURE.md: the table of edges lets {what}{name} use {other}, which it does not")
            }));
        }
    }
    let gone = allowed.keys().filter(|name| !normal.contains_key(*name));
    problems.extend(gone.map(|name| format!("ARCHITECTURE.md: the table of edges names {name}, which is not there")));
    problems
}

/// The parts of a crate (files and folders of `src`) that each part uses. What `lib.rs` hands on counts as used from where
/// it is made. Tests at the end of a file do not count.
fn part_uses(source: &Path) -> Uses {
    let files = files_of(source);
    let parts: BTreeSet<String> = files.iter().map(|file| part_of(&file.0).to_owned()).collect();
    let handed_on = handed_on(&fs::read_to_string(source.join("lib.rs")).unwrap_or_default(), &parts);
    let mut uses = Uses::new();
    for (name, text) in &files {
        let part = part_of(name);
        if part == "lib" || part == "main" {
            continue;
        }
        let used = root_names(text, depth_of(name))
            .into_iter()
            .filter_map(|name| if parts.contains(&name) { Some(name) } else { handed_on.get(&name).cloned() });
        uses.entry(part.to_owned()).or_default().extend(used.filter(|other| other != part));
    }
    uses
}

/// The files of a crate by their modules, `a/b` of `a/b.rs` and `a` of `a/mod.rs`, and those that each uses. Its own folder's `mod.rs`
/// does not count.
fn file_uses(source: &Path) -> Uses {
    let files: BTreeMap<String, String> =
        files_of(source).into_iter().map(|(name, text)| (name.trim_end_matches("/mod").to_owned(), text)).collect();
    let file_of =
        |path: &Vec<String>| (1..=path.len()).rev().map(|n| path[..n].join("/")).find(|name| files.contains_key(name));
    let uses = |(name, text): (&String, &String)| {
        let is_other = |other: &String| other != name && !name.starts_with(&format!("{other}/"));
        let used = paths(text, name).iter().filter_map(file_of).filter(is_other).collect();
        (name.clone(), used)
    };
    files.iter().map(uses).collect()
}

/// Every Rust file below a folder: its name from there, and its text without the tests at its end.
fn files_of(source: &Path) -> Vec<(String, String)> {
    let mut paths = Vec::new();
    crate::tidy::collect(source, &mut paths);
    let named = |path: &Path| path.strip_prefix(source).ok().map(|name| name.to_string_lossy().replace('\\', "/"));
    paths
        .iter()
        .filter_map(|path| {
            let name = named(path)?.strip_suffix(".rs")?.to_owned();
            let text = fs::read_to_string(path).ok()?;
            Some((name, text.split("#[cfg(test)]").next().unwrap_or_default().to_owned()))
        })
        .collect()
}

/// `a` of `a`, `a/mod` and `a/b/c`.
fn part_of(name: &str) -> &str {
    name.split('/').next().unwrap_or_default()
}

/// How many `super::` lead from a file to the crate's root.
fn depth_of(name: &str) -> usize {
    name.split('/').filter(|segment| *segment != "mod").count()
}

/// What `lib.rs` hands on, and the part it comes from: `pub use suite::{Options, Suite as S};`.
fn handed_on(text: &str, parts: &BTreeSet<String>) -> BTreeMap<String, String> {
    let mut handed = BTreeMap::new();
    for item in text.split("pub use ").skip(1).chain(text.split("pub(crate) use ").skip(1)) {
        let item = item.split(';').next().unwrap_or_default();
        let part = item.split("::").next().unwrap_or_default().trim();
        if !parts.contains(part) {
            continue;
        }
        for name in item[part.len()..].split(|c: char| !c.is_alphanumeric() && c != '_').filter(|name| !name.is_empty())
        {
            handed.insert(name.to_owned(), part.to_owned());
        }
    }
    handed
}

/// Paths from the crate's root that the text of a module speaks of: `crate::a::{B, c::D}`, `super::e`.
fn paths(text: &str, module: &str) -> Vec<Vec<String>> {
    let code = without_comments(text);
    let mut found = Vec::new();
    for prefix in ["crate::", "super::"] {
        for at in begins(&code, prefix) {
            let mut base: Vec<String> = module.split('/').map(str::to_owned).collect();
            let mut rest = &code[at..];
            if prefix == "crate::" {
                base.clear();
                rest = &rest[prefix.len()..];
            }
            while let Some(above) = rest.strip_prefix("super::") {
                base.pop();
                rest = above;
            }
            found.extend(tree(rest, base));
        }
    }
    found
}

/// The paths of a tree: `a::{b, c::D}` below a base.
fn tree(text: &str, mut base: Vec<String>) -> Vec<Vec<String>> {
    if let Some(list) = text.trim_start().strip_prefix('{') {
        return members(list).into_iter().flat_map(|member| tree(member, base.clone())).collect();
    }
    let Some(name) = first_name(text) else { return Vec::new() };
    let rest = text.trim_start()[name.len()..].strip_prefix("::");
    if name != "self" {
        base.push(name);
    }
    let below = rest.map(|rest| tree(rest, base.clone())).unwrap_or_default();
    if below.is_empty() { vec![base] } else { below }
}

/// A text without the lines that are comments.
fn without_comments(text: &str) -> String {
    text.lines().filter(|line| !line.trim_start().starts_with("//")).map(|line| format!("{line}\n")).collect()
}

/// Where a path begins with this.
fn begins(code: &str, prefix: &str) -> Vec<usize> {
    let goes_on = |c: char| c.is_alphanumeric() || c == '_' || c == ':' || c == '$';
    let ats = code.match_indices(prefix).map(|(at, _)| at);
    ats.filter(|at| !code[..*at].chars().next_back().is_some_and(goes_on)).collect()
}

/// Names right below the crate's root that a text speaks of: `crate::a`, `crate::{a, b::c}`, `super::super::a`.
fn root_names(text: &str, depth: usize) -> BTreeSet<String> {
    let prefixes = ["crate::".to_owned(), "super::".repeat(depth)];
    let code = without_comments(text);
    let mut names = BTreeSet::new();
    for prefix in prefixes {
        for at in begins(&code, &prefix) {
            let rest = &code[at + prefix.len()..];
            match rest.strip_prefix('{') {
                Some(list) => names.extend(members(list).into_iter().filter_map(first_name)),
                None => names.extend(first_name(rest)),
            }
        }
    }
    names
}

fn first_name(text: &str) -> Option<String> {
    let name: String = text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    (!name.is_empty() && name != "super").then_some(name)
}

/// The members of a list in braces, whose opening one is gone.
fn members(list: &str) -> Vec<&str> {
    let (mut members, mut depth, mut begins) = (Vec::new(), 0, 0);
    for (at, letter) in list.char_indices() {
        match letter {
            '{' => depth += 1,
            ',' | '}' if depth == 0 => {
                members.push(&list[begins..at]);
                begins = at + 1;
                if letter == '}' {
                    break;
                }
            }
            '}' => depth -= 1,
            _ => {}
        }
    }
    members
}

fn circle_problems(of: &str, uses: &Uses) -> Vec<String> {
    let told = |circle: &BTreeSet<String>| {
        let edge = |name: &String| {
            let others: Vec<&str> = uses[name].intersection(circle).map(String::as_str).collect();
            format!("{name} uses {}", others.join(" and "))
        };
        let edges: Vec<String> = circle.iter().map(edge).collect();
        format!("crates/{of}/src: a circle: {}; move what both need into a part of its own", edges.join(", "))
    };
    circles(uses).iter().map(told).collect()
}

/// Sets of parts that all reach each other, of two parts or more.
fn circles(uses: &Uses) -> Vec<BTreeSet<String>> {
    let reached: Uses = uses.keys().map(|name| (name.clone(), reached_from(name, uses))).collect();
    let mut circles: Vec<BTreeSet<String>> = Vec::new();
    for (name, others) in &reached {
        let back = |other: &&String| reached.get(*other).is_some_and(|others| others.contains(name));
        let circle: BTreeSet<String> = others.iter().filter(back).cloned().collect();
        if circle.len() > 1 && !circles.contains(&circle) {
            circles.push(circle);
        }
    }
    circles
}

fn reached_from(name: &str, uses: &Uses) -> BTreeSet<String> {
    let mut reached = BTreeSet::new();
    let mut open = vec![name.to_owned()];
    while let Some(name) = open.pop() {
        for other in uses.get(&name).into_iter().flatten() {
            if reached.insert(other.clone()) {
                open.push(other.clone());
            }
        }
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(names: &[&str]) -> BTreeSet<String> {
        names.iter().map(|&name| name.to_owned()).collect()
    }

    fn uses(pairs: &[(&str, &[&str])]) -> Uses {
        pairs.iter().map(|(name, others)| ((*name).to_owned(), set(others))).collect()
    }

    #[test]
    fn crates_and_parts_keep_to_their_edges() {
        assert_eq!(problems(&root()), Ok(Vec::new()));
    }

    #[test]
    fn an_edge_that_is_not_allowed_and_one_that_is_gone_are_told() {
        let table = allowed(
            "## Edges\n| crate | may use | tests |\n|---|---|---|\n| `sim` | model, roads | - |\n| `old` | - | - |\n## More",
        );
        let tree = "0 recrash-sim v0.1.0\n1 recrash-model v0.1.0\n1 serde v1.0.0\n1 recrash-records v0.1.0\n\n0 xtask v0.1.0\n1 recrash-model v0.1.0\n";
        let problems = edge_problems(&table, &tree_uses(tree), &Uses::new());
        assert_eq!(problems.len(), 3, "{problems:#?}");
        for (problem, word) in problems.iter().zip(["sim may not use records", "lets sim use roads", "names old"]) {
            assert!(problem.contains(word), "{problem}");
        }
    }

    #[test]
    fn names_below_the_root_are_found_however_they_are_written() {
        let text =
            "use crate::{a::{B, C}, d};\nuse super::e::F;\n// crate::not_this\nfn f() { crate::g::h(); $crate::no }";
        assert_eq!(root_names(text, 1), set(&["a", "d", "e", "g"]));
        assert_eq!(root_names("use super::a; use super::super::b;", 2), set(&["b"]));
        let handed = handed_on("pub use suite::{Options, Suite};\npub use serde::X;", &set(&["suite"]));
        assert_eq!(handed.get("Suite").map(String::as_str), Some("suite"));
        assert_eq!(handed.len(), 2);
    }

    #[test]
    fn paths_are_found_from_the_root_however_they_are_written() {
        let text =
            "use crate::a::{B, c::{self, D}};\nuse super::e::F;\nfn f() { super::super::g() }\n// crate::not::this";
        let found: BTreeSet<String> = paths(text, "x/y").iter().map(|path| path.join("/")).collect();
        assert_eq!(found, set(&["a/B", "a/c", "a/c/D", "x/e/F", "g"]));
    }

    #[test]
    fn a_circle_is_told_with_its_edges() {
        let there_and_back = uses(&[("a", &["b"]), ("b", &["c"]), ("c", &["a"]), ("d", &["a"])]);
        let problems = circle_problems("x", &there_and_back);
        assert_eq!(problems.len(), 1, "{problems:?}");
        assert!(
            problems[0].starts_with("crates/x/src") && problems[0].contains("a uses b, b uses c, c uses a"),
            "{problems:?}"
        );
        assert!(!problems[0].contains("d uses"), "{problems:?}");
        assert_eq!(circle_problems("x", &uses(&[("a", &["b"]), ("b", &[])])), Vec::<String>::new());
    }
}
