//! Hashes the code of all crates, so that a suite that other code made is made again, whatever its version says.

use std::fs;
use std::path::{Path, PathBuf};

/// Folders of a crate that no result depends on.
const BESIDE: [&str; 3] = ["tests", "benches", "examples"];
/// Crates that no result depends on.
const PRESENTING: [&str; 2] = ["cli", "fetch"];

fn main() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut hash = 0xcbf2_9ce4_8422_2325;
    for folder in entries(&crates).into_iter().filter(|folder| !is_one_of(folder, &PRESENTING)) {
        for part in entries(&folder).into_iter().filter(|part| !is_one_of(part, &BESIDE)) {
            println!("cargo::rerun-if-changed={}", part.display());
            add(&part, &mut hash);
        }
    }
    println!("cargo::rustc-env=RECRASH_CODE={hash:016x}");
}

/// Takes a file, or every file of a folder, into an FNV-1a hash. Line ends do not count: some checkouts change them.
fn add(path: &Path, hash: &mut u64) {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let content = if path.is_dir() { Vec::new() } else { fs::read(path).unwrap_or_default() };
    for byte in name.bytes().chain([0]).chain(content).filter(|byte| *byte != b'\r') {
        *hash = (*hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    }
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
