//! Hashes the code of all crates and the versions of their dependencies, so that a suite that other code made is made again, whatever its
//! version says.

#[allow(dead_code, reason = "what is not needed here is needed there")]
#[path = "../model/src/hash.rs"]
mod hash;

use hash::Fnv;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders of a crate that no result depends on.
const BESIDE: [&str; 3] = ["tests", "benches", "examples"];
/// Crates that no result depends on.
const APART: [&str; 3] = ["cli", "fetch", "testing"];

fn main() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let crates = here.join("..");
    let mut hash = Fnv::default();
    for folder in entries(&crates).into_iter().filter(|folder| !is_one_of(folder, &APART)) {
        for part in entries(&folder).into_iter().filter(|part| !is_one_of(part, &BESIDE)) {
            println!("cargo::rerun-if-changed={}", part.display());
            add(&part, &mut hash);
        }
    }
    // Of the workspace; a package that is built elsewhere may have it in another folder above, or none.
    if let Some(lock) = here.ancestors().map(|folder| folder.join("Cargo.lock")).find(|lock| lock.is_file()) {
        println!("cargo::rerun-if-changed={}", lock.display());
        add(&lock, &mut hash);
    }
    println!("cargo::rustc-env=RECRASH_CODE={}", hash.hexadecimal());
}

/// Takes a file, or every file of a folder, into a hash. Line ends do not count: some checkouts change them.
fn add(path: &Path, hash: &mut Fnv) {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let content = if path.is_dir() { Vec::new() } else { fs::read(path).unwrap_or_default() };
    let bytes: Vec<u8> = name.bytes().chain([0]).chain(content).filter(|byte| *byte != b'\r').collect();
    hash.write(&bytes);
    entries(path).iter().for_each(|entry| add(entry, hash));
}

/// What lies in a folder, in order; nothing in a file.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let list = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let mut paths: Vec<PathBuf> = list.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

fn is_one_of(path: &Path, names: &[&str]) -> bool {
    path.file_name().is_some_and(|name| names.iter().any(|other| name == *other))
}
