//! JSON of ours, read and written. Every reader of the crate goes through [`from_json`]: the code that reads a noun is large, and
//! made anew for every way to read it.

use recrash_roads::path_at;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Reads a value.
///
/// # Errors
/// What is wrong, and the path of the value where it is.
pub(crate) fn from_json<T: DeserializeOwned>(text: &[u8]) -> Result<T, Misread> {
    serde_json::from_slice(text).map_err(|error| Misread { path: path_at(text, error.line(), error.column()), error })
}

/// Why a text was not read.
#[derive(Debug, thiserror::Error)]
#[error("{path}: {error}")]
pub(crate) struct Misread {
    /// Where in the text, such as `cases[3].run`.
    pub(crate) path: String,
    /// What is wrong.
    pub(crate) error: serde_json::Error,
}

/// JSON of large values, on one line.
pub(crate) fn to_compact_json<T: Serialize>(value: &T) -> Vec<u8> {
    let mut text = serde_json::to_vec(value).expect("nouns serialise");
    text.push(b'\n');
    text
}

/// JSON as files hold it: indented, with a line break at the end.
pub(crate) fn to_json<T: Serialize>(value: &T) -> Vec<u8> {
    let mut text = serde_json::to_vec_pretty(value).expect("nouns serialise");
    text.push(b'\n');
    text
}
