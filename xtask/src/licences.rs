//! `python/LICENSES.txt`: what stands in a wheel, whose it is, and under which licence. Written here, and carried by every wheel.

use crate::steps::{Result, cargo_command, root};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Where it stands.
pub fn file() -> PathBuf {
    root().join("python/LICENSES.txt")
}

/// Writes it anew.
pub fn write() -> Result {
    fs::write(file(), text()?).map_err(|error| format!("{}: {error}", file().display()))
}

/// Whether it tells what is built.
pub fn check() -> Result {
    let kept = fs::read_to_string(file()).unwrap_or_default();
    if kept == text()? {
        return Ok(());
    }
    Err("python/LICENSES.txt does not tell what is built; `cargo xtask licences` writes it anew".to_owned())
}

/// A library that is built into the extension module.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Part {
    name: String,
    version: String,
    licence: String,
    folder: PathBuf,
}

fn text() -> Result<String> {
    let mut text = String::from(
        "recrash is licensed under MIT or Apache-2.0, at your choice; both texts stand below. Its wheel holds these libraries, whose\n\
         texts follow. Where a library has a choice of licences with MIT among them, it is used under MIT.\n\n",
    );
    // Name of a text's first user, and who shares it.
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for own in ["LICENSE-MIT", "LICENSE-APACHE"] {
        texts.entry(read(&root().join(own))?).or_default().push("recrash".to_owned());
    }
    for part in parts()? {
        let _ = writeln!(text, "{} {}: {}", part.name, part.version, part.licence);
        for file in licence_files(&part) {
            texts.entry(read(&file)?).or_default().push(part.name.clone());
        }
    }
    let mut by_user: Vec<(&Vec<String>, &String)> = texts.iter().map(|(text, users)| (users, text)).collect();
    by_user.sort();
    for (users, licence) in by_user {
        let users: BTreeSet<&str> = users.iter().map(String::as_str).collect();
        let users: Vec<&str> = users.into_iter().collect();
        let _ = write!(text, "\n{}\n{}\n\n{licence}", "=".repeat(100), users.join(", "));
    }
    Ok(text)
}

/// Everything that is linked into the extension module on any platform, by name.
fn parts() -> Result<BTreeSet<Part>> {
    let output = cargo_command()
        .args(["metadata", "--format-version", "1", "--locked"])
        .current_dir(root())
        .output()
        .map_err(|error| format!("cargo metadata: {error}"))?;
    if !output.status.success() {
        return Err(format!("cargo metadata: {}", String::from_utf8_lossy(&output.stderr)));
    }
    let told: Value = serde_json::from_slice(&output.stdout).map_err(|error| format!("cargo metadata: {error}"))?;
    let by_id = |list: &Value| -> BTreeMap<String, Value> {
        let entries = list.as_array().into_iter().flatten();
        entries.map(|entry| (entry["id"].as_str().unwrap_or_default().to_owned(), entry.clone())).collect()
    };
    let (packages, nodes) = (by_id(&told["packages"]), by_id(&told["resolve"]["nodes"]));
    let first = packages.iter().find(|(_, package)| package["name"] == "recrash-python").map(|(id, _)| id.clone());
    let mut waiting = vec![first.ok_or("cargo metadata knows no package recrash-python")?];
    let (mut seen, mut parts) = (BTreeSet::new(), BTreeSet::new());
    while let Some(id) = waiting.pop() {
        if !seen.insert(id.clone()) {
            continue;
        }
        let package = &packages[&id];
        let word = |name: &str| package[name].as_str().unwrap_or_default().to_owned();
        if !package["source"].is_null() {
            let manifest = PathBuf::from(word("manifest_path"));
            let folder = manifest.parent().unwrap_or(Path::new("")).to_owned();
            parts.insert(Part { name: word("name"), version: word("version"), licence: word("license"), folder });
        }
        let needs = nodes[&id]["deps"].as_array().into_iter().flatten();
        // Of kind null: neither for tests alone nor for building alone.
        let linked =
            needs.filter(|need| need["dep_kinds"].as_array().into_iter().flatten().any(|of| of["kind"].is_null()));
        waiting.extend(linked.filter_map(|need| need["pkg"].as_str().map(str::to_owned)));
    }
    Ok(parts)
}

/// Files with the texts of a library: of MIT alone where it offers that.
fn licence_files(part: &Part) -> Vec<PathBuf> {
    let entries =
        fs::read_dir(&part.folder).into_iter().flatten().filter_map(|entry| entry.ok().map(|entry| entry.path()));
    let name = |file: &Path| file.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
    let mut files: Vec<PathBuf> = entries
        .filter(|file| {
            let begins = ["LICENSE", "LICENCE", "COPYING", "NOTICE", "UNLICENSE"];
            file.is_file() && begins.iter().any(|begin| name(file).starts_with(begin))
        })
        .collect();
    files.sort();
    let chosen = part.licence.contains("MIT") && !part.licence.contains(" AND ");
    if chosen && files.iter().any(|file| name(file).contains("MIT")) {
        files.retain(|file| name(file).contains("MIT") || name(file).starts_with("NOTICE"));
    }
    files
}

/// A text with one line end and without spaces at the ends of its lines, so that equal ones are equal.
fn read(file: &Path) -> Result<String> {
    let bytes = fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let text = String::from_utf8_lossy(&bytes);
    let lines: Vec<&str> = text.trim().lines().map(str::trim_end).collect();
    Ok(lines.join("\n") + "\n")
}
