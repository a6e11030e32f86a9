//! Crash files from disk into the first stage, and records from it onto the disk as tables.

use crate::error::{Choice, PipelineError};
use crate::files::output::{Output, Outputs};
use crate::files::store::{io, read_bytes, read_text};
use crate::options::{Options, RecordSource};
use crate::reading::fetching::cached;
use crate::reading::named;
use recrash_model::Outcome;
use recrash_model::incident::Incident;
use recrash_model::profile::{Dedupe, RecordRules, SystemProfile, Tells};
use recrash_model::record::{CrashRecord, RecordSet, RejectReason};
use recrash_records::{
    Bytes, Filter, IngestOptions, MAX_FILE_BYTES, MAX_MAPPING_BYTES, Mapping, RecordTable, SAMPLE_CSV, SAMPLE_NAME,
    SourceBytes, TableRows, ingest_sources, write_csv,
};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Everything that decides which records come of the first stage, beside the profile.
pub struct RecordInput {
    files: Vec<(String, Content)>,
    filter: Option<Filter>,
    mapping: Option<Mapping>,
    mapping_text: String,
}

/// What a crash file holds.
enum Content {
    /// A regular file: read as it goes, so that 100 MB of it do not stand in memory beside the records.
    File(File),
    /// What can be read only once, such as a pipe; and the sample.
    Memory(Cow<'static, [u8]>),
}

impl Content {
    fn open(path: &Path) -> Result<Self, PipelineError> {
        if std::fs::metadata(path).is_ok_and(|there| there.is_file()) {
            return File::open(path).map(Self::File).map_err(|source| io("read", path, source));
        }
        read_bytes(path, MAX_FILE_BYTES as u64).map(|bytes| Self::Memory(bytes.into()))
    }

    fn bytes(&self) -> Box<dyn Bytes + '_> {
        match self {
            Self::File(file) => Box::new(file),
            Self::Memory(bytes) => Box::new(Cursor::new(bytes)),
        }
    }
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
                return Err(PipelineError::bad_input("a mapping needs its crash files: name them too"));
            }
            RecordSource::Sample => vec![(SAMPLE_NAME.to_owned(), Content::Memory(SAMPLE_CSV.as_bytes().into()))],
            RecordSource::Files(paths) => {
                let paths: Vec<PathBuf> = paths.iter().map(|path| crash_file(path)).collect();
                let named = names(&paths).into_iter().zip(&paths);
                named.map(|(name, path)| Ok((name, Content::open(path)?))).collect::<Result<_, PipelineError>>()?
            }
        };
        Ok(Self { files, filter, mapping, mapping_text })
    }

    /// What decides, for telling whether the stage is done: names, and hashes of contents.
    pub fn parts(&self) -> Vec<String> {
        let filter = self.filter.as_ref().map_or("", Filter::text);
        let mut all = vec![filter.to_owned(), self.mapping_text.clone()];
        for (name, content) in &self.files {
            // A file that cannot be read is another input, and is told when its records are asked for.
            let hash = recrash_records::sha256(&mut *content.bytes()).unwrap_or_else(|error| error.to_string());
            all.extend([name.clone(), hash]);
        }
        all
    }

    /// Every crash report, for incidents, which are made of all of theirs; and the filter, which keeps incidents then.
    ///
    /// # Errors
    /// As [`Self::ingest`].
    pub fn ingest_all(
        mut self,
        profile: &SystemProfile,
    ) -> Result<(Outcome<RecordSet>, Option<Filter>), PipelineError> {
        let filter = self.filter.take();
        let records = RecordRules { dedupe: Dedupe::None, tells: Tells::Accounts };
        Ok((self.ingest(&SystemProfile { records, ..profile.clone() })?, filter))
    }

    /// The records. In memory is what is kept of the files.
    ///
    /// # Errors
    /// A file is no crash file, or does not fit the mapping.
    pub fn ingest(self, profile: &SystemProfile) -> Result<Outcome<RecordSet>, PipelineError> {
        let sources = self.files.iter().map(|(name, content)| SourceBytes { name, bytes: content.bytes() }).collect();
        let options = IngestOptions { filter: self.filter.as_ref(), mapping: self.mapping.as_ref() };
        ingest_sources(sources, profile, &options).map_err(|e| PipelineError::bad_input(e.to_string()))
    }
}

/// The incidents of crash files. Reports that say themselves that there was no crash belong to none.
pub(crate) fn incidents(set: &RecordSet) -> Vec<Incident> {
    if set.usable.len() == set.records.len() {
        return recrash_reader::incidents(&set.records);
    }
    let crashes: Vec<CrashRecord> = set.usable.iter().map(|&at| set.records[at].clone()).collect();
    recrash_reader::incidents(&crashes)
}

/// The filter of the options, read.
///
/// # Errors
/// It cannot be read: with its column.
pub fn read_filter(options: &Options) -> Result<Option<Filter>, PipelineError> {
    let read = options.filter.as_deref().map(Filter::parse).transpose();
    read.map_err(|e| PipelineError::choose(format!("the filter, {e}"), Choice::Filter))
}

/// A file by its path; a bare name that is no file here is looked up among the downloaded ones.
fn crash_file(path: &Path) -> PathBuf {
    let found = if path.exists() { None } else { cached(path) };
    found.unwrap_or_else(|| path.to_owned())
}

/// What files are called in messages and provenance: their names without folders, and with as many folders as tell files
/// of one name apart.
fn names(paths: &[PathBuf]) -> Vec<String> {
    let named = |path: &Path, parts: usize| -> String {
        let all: Vec<_> = path.components().collect();
        all[all.len().saturating_sub(parts)..].iter().collect::<PathBuf>().display().to_string()
    };
    let name = |path: &PathBuf| {
        let most = path.components().count().max(1);
        let differs = |parts: &usize| {
            let others = paths.iter().filter(|other| *other != path);
            others.into_iter().all(|other| named(other, *parts) != named(path, *parts))
        };
        named(path, (1..most).find(differs).unwrap_or(most))
    };
    paths.iter().map(name).collect()
}

/// What may be written beside reading the records of these options; a suite that they go into counts as read.
pub fn record_outputs(options: &Options, suite: Option<&Path>) -> Outputs {
    let files: &[PathBuf] = match &options.records {
        RecordSource::Sample => &[],
        RecordSource::Files(files) => files,
    };
    let read =
        files.iter().map(|path| crash_file(path)).chain(options.mapping.clone()).chain(suite.map(Path::to_owned));
    Outputs::of_inputs(read.chain(named::of_profile_and_ego(Some(&options.profile), None)))
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

/// Records as a table, each with the incident that accounts know it by.
pub fn record_table(records: &RecordSet, rows: TableRows) -> RecordTable {
    recrash_records::record_table(records, &incidents_of_records(records), rows)
}

/// The incident of each record, under the id that [`incidents`] gives it; none of a row that says there was no crash.
fn incidents_of_records(set: &RecordSet) -> Vec<Option<String>> {
    let place = |file: &str, row: u64| (file.to_owned(), row);
    let no_crash: BTreeSet<(String, u64)> = set
        .rejects
        .iter()
        .filter(|reject| reject.reason == RejectReason::NotACrash)
        .map(|reject| place(&reject.file, reject.row))
        .collect();
    let is_crash = |record: &&CrashRecord| {
        no_crash.is_empty() || !no_crash.contains(&place(&record.provenance.file, record.provenance.row))
    };
    let mut ids = recrash_reader::incident_ids(set.records.iter().filter(is_crash)).into_iter();
    set.records.iter().map(|record| if is_crash(&record) { ids.next() } else { None }).collect()
}

/// Writes records as a table. Gives the number of rows.
///
/// # Errors
/// The file cannot be written.
pub fn write_records(
    records: &RecordSet,
    rows: TableRows,
    format: TableFormat,
    output: &Output,
) -> Result<usize, PipelineError> {
    match format {
        TableFormat::Csv => {
            let failed = |source| io("write", output.name(), source);
            let mut begun = output.begin()?;
            let written = write_csv(records, &incidents_of_records(records), rows, &mut begun).map_err(failed)?;
            begun.finish().map_err(failed)?;
            Ok(written)
        }
        #[cfg(feature = "parquet")]
        TableFormat::Parquet => {
            let table = record_table(records, rows);
            output.write(&table.to_parquet())?;
            Ok(table.rows)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_one_name_are_told_apart_by_their_folders() {
        let named = |paths: &[&str]| names(&paths.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(named(&["a/x.csv", "b/y.csv"]), ["x.csv", "y.csv"]);
        let folders = |parts: &[&str]| parts.iter().collect::<PathBuf>().display().to_string();
        assert_eq!(
            named(&["a/x.csv", "b/x.csv", "y.csv"]),
            [folders(&["a", "x.csv"]), folders(&["b", "x.csv"]), "y.csv".into()]
        );
        assert_eq!(named(&["x.csv", "b/x.csv"]), ["x.csv".to_owned(), folders(&["b", "x.csv"])]);
        assert_eq!(named(&["1/c/x.csv", "2/c/x.csv"]), [folders(&["1", "c", "x.csv"]), folders(&["2", "c", "x.csv"])]);
    }
}
