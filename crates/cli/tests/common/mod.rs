//! Helpers of the command's tests.

use assert_cmd::Command;
use std::collections::BTreeMap;
use std::path::Path;

/// The command, with a budget small enough for a test where it makes suites.
pub fn recrash(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("recrash").expect("the binary is built with its tests");
    command.args(arguments);
    command
}

/// Every file below a folder, with its content.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(&next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
                all.insert(name, std::fs::read(&path).unwrap());
            }
        }
    }
    all
}

/// Asserts that two folders hold the same files with the same bytes, and names the first that differs.
pub fn assert_same_files(left: &Path, right: &Path) {
    let (left, right) = (files(left), files(right));
    assert_eq!(left.keys().collect::<Vec<_>>(), right.keys().collect::<Vec<_>>());
    for (name, content) in &left {
        assert!(right[name] == *content, "{name} differs");
    }
}
