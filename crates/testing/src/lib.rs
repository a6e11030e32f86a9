//! What the tests of several crates share: skips that are told, files that not every machine has, and the inputs of the
//! fuzz targets. No code of the product uses it.

pub mod inputs;

use std::io::Write;
use std::path::{Path, PathBuf};

/// Tells that the running test is skipped, and why. The line goes past the test harness, which keeps what a passing test
/// prints: `cargo test` shows it, and `cargo xtask` counts it.
pub fn skip(why: &str) {
    let package = std::env::var("CARGO_PKG_NAME").unwrap_or_default();
    let thread = std::thread::current();
    let line = format!("skipped: {package} {} ({why})\n", thread.name().unwrap_or("a test"));
    let _ = std::io::stderr().write_all(line.as_bytes());
}

/// A file or folder of `../shared`, beside the checkout (`RECRASH_SHARED` names another place). Users do not have it: where
/// it is not there, the test is skipped.
pub fn shared(path: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("RECRASH_SHARED").map_or_else(|| root().join("../shared"), PathBuf::from);
    let path = folder.join(path);
    if path.exists() {
        return Some(path);
    }
    skip("needs ../shared");
    None
}

/// What a variable of the environment names, such as an interpreter; where it is not set, the test is skipped.
pub fn named_by(variable: &str) -> Option<PathBuf> {
    let named = std::env::var_os(variable).filter(|value| !value.is_empty()).map(PathBuf::from);
    if named.is_none() {
        skip(&format!("needs {variable}"));
    }
    named
}

/// The project's folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("crates/testing").to_owned()
}
