//! What pages and code point at is there: paths of the repository in backticks, and the keys of works in `docs/references.bib`.

use std::collections::BTreeSet;
use std::path::Path;

/// Rules for one file.
pub fn problems(root: &Path, name: &str, text: &str, works: &BTreeSet<String>) -> Vec<String> {
    let mut problems = Vec::new();
    // Entries of the past name what was there then.
    if name.ends_with(".md") && name != "CHANGELOG.md" {
        let gone = paths(root, text).into_iter().filter(|path| !root.join(path).exists());
        problems.extend(gone.map(|path| format!("{name}: there is no `{path}`")));
    }
    if [".md", ".rs", ".toml"].iter().any(|ending| name.ends_with(ending)) && !name.starts_with("xtask/") {
        let unknown = keys(text).into_iter().filter(|key| !works.contains(key));
        problems.extend(unknown.map(|key| format!("{name}: docs/references.bib has no {key}")));
    }
    problems
}

/// The keys of a file of references: `@article{key,`.
pub fn works(text: &str) -> BTreeSet<String> {
    let entry = |line: &str| Some(line.strip_prefix('@')?.split_once('{')?.1.trim_end_matches(',').to_owned());
    text.lines().filter_map(entry).collect()
}

/// What stands in backticks and begins with a folder of the repository.
fn paths(root: &Path, text: &str) -> BTreeSet<String> {
    let quoted = text.split('`').skip(1).step_by(2);
    let is_path = |part: &&str| {
        let first = part.split('/').next().unwrap_or_default();
        part.contains('/')
            && !part.contains(|c: char| c.is_whitespace() || "*<>{}$".contains(c))
            && !["", ".", ".."].contains(&first)
            && !["target", "suite"].contains(&first)
            && root.join(first).is_dir()
    };
    let path = |part: &str| part.split("::").next().unwrap_or_default().trim_end_matches('/').to_owned();
    quoted.filter(is_path).map(path).collect()
}

/// Words of the form of a key: a name and a year, as in `treiber2000`.
fn keys(text: &str) -> BTreeSet<String> {
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || "_-./:".contains(c)));
    words.map(|word| word.trim_end_matches(['.', ':'])).filter(|word| is_key(word)).map(str::to_owned).collect()
}

/// Three small letters at least, a year of four digits from 1900 on, and perhaps a word behind it.
fn is_key(word: &str) -> bool {
    let digits = word.find(|c: char| !c.is_ascii_lowercase()).unwrap_or(word.len());
    let (name, rest) = word.split_at(digits);
    let year = rest.get(..4).is_some_and(|year| {
        year.chars().all(|c| c.is_ascii_digit()) && (year.starts_with("19") || year.starts_with("20"))
    });
    name.len() >= 3 && year && rest[4..].chars().all(|c| c.is_ascii_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::steps::root;

    #[test]
    fn a_path_that_is_gone_is_told() {
        let told = |text: &str| problems(&root(), "docs/a.md", text, &BTreeSet::new());
        assert_eq!(
            told("see `xtask/src/pages.rs` and `docs/models/`, `a/b`, `suite/report.html`, `docs/*.md`"),
            [""; 0]
        );
        assert_eq!(told("see `xtask/src/gone.rs`"), ["docs/a.md: there is no `xtask/src/gone.rs`"]);
    }

    #[test]
    fn a_work_that_is_not_listed_is_told() {
        let works = works("@article{treiber2000,\n  year = {2000}\n}\n@inproceedings{lin2023crime,\n");
        let told = |text: &str| problems(&root(), "crates/a.rs", text, &works);
        assert_eq!(
            told("// (treiber2000; lin2023crime, section 4): sgo-ads-2025.csv, v2000, 2026-11-23, x1999"),
            [""; 0]
        );
        assert_eq!(told("// nobody1999: it"), ["crates/a.rs: docs/references.bib has no nobody1999"]);
    }
}
