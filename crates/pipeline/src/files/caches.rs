//! Folders of the platform that outlive a suite.

use crate::error::PipelineError;
use std::ffi::OsString;
use std::path::PathBuf;

/// Environment variable with the folder of downloaded files.
pub const CACHE_VARIABLE: &str = "RECRASH_CACHE";

/// Reads a variable of the environment; empty ones count as not set. A function, so that tests can give their own.
pub type Variable<'a> = &'a dyn Fn(&str) -> Option<OsString>;

/// A variable of this process.
pub fn variable(name: &str) -> Option<OsString> {
    std::env::var_os(name).filter(|value| !value.is_empty())
}

/// Where downloaded files are kept.
pub fn cache_folder(variable: Variable<'_>) -> Option<PathBuf> {
    match variable(CACHE_VARIABLE) {
        Some(folder) => Some(folder.into()),
        None => platform_caches(variable).map(|folder| folder.join("recrash")),
    }
}

/// The error where there is none.
pub fn no_cache_folder() -> PipelineError {
    PipelineError::bad_input(format!("no folder for caches is known here; name one in {CACHE_VARIABLE}"))
}

/// The platform's folder for caches.
fn platform_caches(variable: Variable<'_>) -> Option<PathBuf> {
    let folder = |name: &str| variable(name).map(PathBuf::from);
    if cfg!(windows) {
        folder("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        folder("HOME").map(|home| home.join("Library/Caches"))
    } else {
        folder("XDG_CACHE_HOME").or_else(|| folder("HOME").map(|home| home.join(".cache")))
    }
}
