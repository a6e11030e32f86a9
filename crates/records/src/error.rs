//! What is wrong with a whole file: which file, what was expected, how to mend it.

use thiserror::Error;

/// Why a mapping file cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{file}{}{}: {message}", line.map(|line| format!(", line {line}")).unwrap_or_default(), if key.is_empty() { String::new() } else { format!(", key {key}") })]
pub struct MappingError {
    /// Name of the mapping file.
    pub file: String,
    /// Line, counted from 1, where it is known.
    pub line: Option<usize>,
    /// Key, such as `fields.road.values.2`; may be empty.
    pub key: String,
    /// What is wrong, and what is allowed.
    pub message: String,
}

/// A file that cannot be read at all. Single bad rows are no error: they are rejected by row number.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum IngestError {
    /// No file was given.
    #[error("no crash file was given; expected at least one SGO CSV file")]
    NoFiles,
    /// The file has no bytes, or blanks only.
    #[error("{file}: the file is empty; expected an SGO CSV file with a header and data rows (was the download cut?)")]
    Empty {
        /// File name.
        file: String,
    },
    /// The file is larger than [`crate::MAX_FILE_BYTES`].
    #[error(
        "{file}: {bytes} bytes, more than the {limit} that are read; split the file by rows, each part with the header"
    )]
    TooLarge {
        /// File name.
        file: String,
        /// Its size, in bytes.
        bytes: u64,
        /// The limit, in bytes.
        limit: usize,
    },
    /// The system does not give the bytes.
    #[error("{file}: it cannot be read to its end: {why}; check the disk, or get the file again")]
    Unreadable {
        /// File name.
        file: String,
        /// What the system said.
        why: String,
    },
    /// The file is no text.
    #[error("{file}: this is {looks_like}, not a CSV file; expected comma-separated text; {hint}")]
    NotText {
        /// File name.
        file: String,
        /// What it looks like.
        looks_like: &'static str,
        /// How to mend it.
        hint: &'static str,
    },
    /// The first line names next to no column of any edition.
    #[error(
        "{file}: the first line is not the header of an SGO crash file (it starts \"{start}\"); \
         expected columns such as \"Report ID\", \"Roadway Type\" and \"Narrative\"; \
         use a file as NHTSA publishes it, header included"
    )]
    UnknownHeader {
        /// File name.
        file: String,
        /// How the first line starts.
        start: String,
    },
    /// The header lacks columns that are needed.
    #[error(
        "{file}: it looks like the {edition}, but lacks the column{} {}; \
         use the file as published, without taking out or renaming columns",
        if .missing.len() == 1 { "" } else { "s" }, quoted(.missing)
    )]
    MissingColumns {
        /// File name.
        file: String,
        /// The edition it looks like.
        edition: &'static str,
        /// The columns that are missing.
        missing: Vec<&'static str>,
    },
    /// A mapping names a file or a column that is not there.
    #[error("{0}")]
    Mapping(MappingError),
    /// There is a header, and nothing below it.
    #[error(
        "{file}: a header ({edition}) and no data row below it; expected one row per crash report (was the download cut?)"
    )]
    HeaderOnly {
        /// File name.
        file: String,
        /// The edition it looks like.
        edition: &'static str,
    },
}

impl IngestError {
    /// What the system said about a file.
    pub(crate) fn unreadable(file: &str, error: &std::io::Error) -> Self {
        Self::Unreadable { file: file.to_owned(), why: error.to_string() }
    }
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}

/// Content that is no text, by its first bytes: what it is, and what to do about it.
const SIGNATURES: [(&[u8], &str, &str); 7] = [
    (b"PK\x03\x04", "a ZIP archive or an Excel workbook", "unpack it, or save the sheet as CSV"),
    (b"%PDF", "a PDF document", "give the CSV file, not the data dictionary"),
    (b"\x1f\x8b", "a gzip file", "unpack it with gunzip"),
    (b"PAR1", "a Parquet file", "give the CSV file it was made from"),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook", "save the sheet as CSV"),
    (b"SQLite format", "a SQLite database", "export the table as CSV"),
    (b"\x89PNG", "a picture", "give the CSV file"),
];

/// How far to look for bytes that no text has, in bytes.
const BINARY_PROBE_BYTES: usize = 8192;

/// What the file is, when its first bytes are those of another format: `(looks like, hint)`.
pub fn other_format(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    if let Some((_, looks_like, hint)) = SIGNATURES.iter().find(|(magic, ..)| bytes.starts_with(magic)) {
        return Some((looks_like, hint));
    }
    let start = bytes.trim_ascii_start();
    let opening = &start[..start.len().min(9)];
    if opening.eq_ignore_ascii_case(b"<!doctype") || opening.to_ascii_lowercase().starts_with(b"<html") {
        return Some(("a web page", "download the CSV file itself; the link led to a page"));
    }
    None
}

/// Whether the bytes are no text: a text has no zero bytes. Asked only where no header was found, so that one stray zero
/// in a narrative costs nothing.
pub fn is_binary(bytes: &[u8]) -> bool {
    bytes[..bytes.len().min(BINARY_PROBE_BYTES)].contains(&0)
}
