//! Crash files from disk into the first stage, and records from it onto the disk as tables.

use crate::error::PipelineError;
use crate::fetching::cached;
use crate::options::{Options, RecordSource};
use crate::store::{read_bytes, read_text, sha256, write_file_whole};
use recrash_model::Outcome;
use recrash_model::profile::SystemProfile;
use recrash_model::record::RecordSet;
use recrash_records::{
    Filter, IngestOptions, MAX_MAPPING_BYTES, Mapping, SAMPLE_CSV, SAMPLE_NAME, SourceText, TableRows, ingest_with,
    record_table,
};
use std::path::{Path, PathBuf};

/// Crash files larger than this are refused. [bytes]
const MAX_CRASH_FILE: u64 = 1 << 30;

/// Everything that decides which records come of the first stage, beside the profile.
pub struct RecordInput {
    files: Vec<(String, Vec<u8>)>,
    filter: Option<Filter>,
    mapping: Option<Mapping>,
    mapping_text: String,
}

impl RecordInput {
    /// Reads what the options name.
    ///
    /// # Errors
    /// A file cannot be read, or the filter or the mapping cannot be used.
    pub fn read(options: &Options) -> Result<Self, PipelineError> {
        let filter = read_filter(options)?;
        let (mapping, mapping_text) = match &options.mapping {
            None => (None, String::new()),
            Some(path) => {
                let text = read_text(path, MAX_MAPPING_BYTES as u64)?;
                let mapping = Mapping::parse(&text, &path.to_string_lossy());
                (Some(mapping.map_err(|e| PipelineError::bad_input(e.to_string()))?), text)
            }
        };
        let files = match &options.records {
            RecordSource::Sample if mapping.is_some() => {
                return Err(PipelineError::bad_input("a mapping needs its crash files: give them with --records"));
            }
            RecordSource::Sample => vec![(SAMPLE_NAME.to_owned(), SAMPLE_CSV.as_bytes().to_vec())],
            RecordSource::Files(paths) => paths.iter().map(|path| crash_file(path)).collect::<Result<_, _>>()?,
        };
        Ok(Self { files, filter, mapping, mapping_text })
    }

    /// What decides, for telling whether the stage is done: names, and hashes of contents.
    pub fn parts(&self) -> Vec<String> {
        let filter = self.filter.as_ref().map_or("", Filter::text);
        let mut all = vec![filter.to_owned(), self.mapping_text.clone()];
        for (name, content) in &self.files {
            all.extend([name.clone(), sha256(content)]);
        }
        all
    }

    /// The records. The files' contents are gone afterwards: nobody should hold 100 MB of them beside the records.
    ///
    /// # Errors
    /// A file is no crash file, or does not fit the mapping.
    pub fn ingest(self, profile: &SystemProfile) -> Result<Outcome<RecordSet>, PipelineError> {
        let sources: Vec<SourceText> = self.files.iter().map(|(name, bytes)| SourceText { name, bytes }).collect();
        let options = IngestOptions { filter: self.filter.as_ref(), mapping: self.mapping.as_ref() };
        ingest_with(&sources, profile, &options).map_err(|e| PipelineError::bad_input(e.to_string()))
    }
}

/// The filter of the options, read.
///
/// # Errors
/// It cannot be read: with its column.
pub fn read_filter(options: &Options) -> Result<Option<Filter>, PipelineError> {
    let read = options.filter.as_deref().map(Filter::parse).transpose();
    read.map_err(|e| PipelineError::bad_input(format!("--where, {e}\n  recrash records --help lists the fields")))
}

/// A file by its path; a bare name that is no file here is looked up among the downloaded ones.
fn crash_file(path: &Path) -> Result<(String, Vec<u8>), PipelineError> {
    let found = if path.exists() { None } else { cached(path) };
    let path: PathBuf = found.unwrap_or_else(|| path.to_owned());
    let name = path.file_name().map_or_else(|| path.to_string_lossy(), |n| n.to_string_lossy());
    Ok((name.into_owned(), read_bytes(&path, MAX_CRASH_FILE)?))
}

/// Formats of tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableFormat {
    /// Comma-separated values.
    Csv,
    /// Parquet.
    #[cfg(feature = "parquet")]
    Parquet,
}

/// Reads crash files without making a suite: the first stage's result, and nothing written.
///
/// # Errors
/// A file cannot be read or is no crash file, or the filter, the mapping or the profile cannot be used.
pub fn read_records(options: &Options) -> Result<Outcome<RecordSet>, PipelineError> {
    let profile = options.system_profile()?;
    RecordInput::read(options)?.ingest(&profile)
}

/// Writes records as a table, whole or not at all. Gives the number of rows.
///
/// # Errors
/// The file cannot be written.
pub fn write_records(
    records: &RecordSet,
    rows: TableRows,
    format: TableFormat,
    path: &Path,
) -> Result<usize, PipelineError> {
    let table = record_table(records, rows);
    let bytes = match format {
        TableFormat::Csv => table.to_csv(),
        #[cfg(feature = "parquet")]
        TableFormat::Parquet => table.to_parquet(),
    };
    let failed = |source| PipelineError::Io { action: "write", path: path.to_owned(), source };
    write_file_whole(path, &bytes).map_err(failed)?;
    Ok(table.rows)
}
