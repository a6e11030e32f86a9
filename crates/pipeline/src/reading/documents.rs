//! JSON documents of ours that anybody may have written: bounded, with the place of what is wrong.

use crate::error::PipelineError;
use crate::files::json::{Misread, from_json};
use crate::files::store::read_text;
use serde::de::DeserializeOwned;
use std::path::Path;

/// Larger documents are refused. [bytes]
const MAX_DOCUMENT: u64 = 1 << 29;

/// Reads a document of a format.
///
/// # Errors
/// The file cannot be read, is of another format, or something in it is not as the format has it: where.
pub fn read_document<T: DeserializeOwned>(path: &Path, what: &str, format: &str) -> Result<T, PipelineError> {
    let bad = |why: String| PipelineError::bad_input(format!("{}: {why}", path.display()));
    let text = read_text(path, MAX_DOCUMENT)?;
    #[derive(serde::Deserialize)]
    struct Tag {
        format: Option<String>,
    }
    let tag: Tag = serde_json::from_slice(text.as_bytes()).map_err(|error| bad(format!("it is no {what}: {error}")))?;
    match tag.format {
        Some(tag) if tag == format => {}
        Some(tag) => {
            return Err(bad(format!(
                "it is no {what} that this version reads: its format is \"{}\", and \"{format}\" is read",
                tag.chars().take(60).collect::<String>()
            )));
        }
        None => return Err(bad(format!("it is no {what}: it has no format; \"{format}\" is read"))),
    }
    from_json(text.as_bytes()).map_err(|Misread { path, error }| {
        let inner: String = error.to_string().chars().take(300).collect();
        bad(format!("{path}: {inner}"))
    })
}
