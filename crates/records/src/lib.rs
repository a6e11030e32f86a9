//! Reads crash reports filed with NHTSA under Standing General Order 2021-01 ("SGO"): CSV in, [`RecordSet`] out.
//!
//! Every edition is recognised by its header, never by its name: 122 columns (2021 to mid 2023), 137 (to June 2025), 116
//! (since), reports on automated driving and on driver assistance alike. Every row in is usable or rejected with a
//! reason, and the counts add up. Miles per hour exist in this crate only.
//!
//! What this crate does **not** do: it opens no file (bytes come in), it does not read narratives (the
//! reader does) but for the names of contact areas, which tell what the ticks of a file mean (`areas.rs`), and it never guesses: a code it does
//! not know stays as text and is listed.

mod areas;
mod cells;
mod codes;
mod columns;
mod distribution;
mod error;
mod fields;
mod file;
mod filter;
mod funnel;
mod identity;
mod mapping;
mod notes;
#[cfg(feature = "parquet")]
mod parquet;
mod row;
mod stream;
mod table;
mod text;

pub use columns::published_header;
pub use distribution::{Distribution, ValueCount, distributions};
pub use error::{IngestError, MappingError};
pub use filter::{FILTER_HELP, Filter, FilterError};
pub use mapping::{MAPPING_FORMAT, MAX_MAPPING_BYTES, Mapping};
#[cfg(feature = "parquet")]
pub use parquet::ParquetWriter;
pub use stream::{Bytes, sha256};
pub use table::{Column, RecordTable, TableRows, record_table, write_csv};

use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_model::record::{FunnelStep, RecordSet, Reject, RejectReason, SourceFile};
use recrash_model::{Diagnostic, Location, Outcome, Severity};
use row::Draft;
use std::collections::BTreeMap;
use std::io::Cursor;

/// Name of the built-in sample.
pub const SAMPLE_NAME: &str = "built-in sample";

/// The built-in sample: invented reports of invented companies in the columns of the second edition, with the real file's
/// shares of crash types, stops, companies, copies and versions. Written by `cargo run -p recrash-records --example make_sample`.
pub const SAMPLE_CSV: &str = include_str!("../data/sample.csv");

/// Largest file that is read, in bytes.
pub const MAX_FILE_BYTES: usize = 1 << 30;

/// A file's content and the name it is called by.
#[derive(Debug, Clone, Copy)]
pub struct SourceText<'a> {
    /// Name for messages and provenance: without folders, or with as many as tell files of one name apart.
    pub name: &'a str,
    /// The whole content.
    pub bytes: &'a [u8],
}

/// A file that is read as it goes, and the name it is called by.
pub struct SourceBytes<'a> {
    /// Name for messages and provenance: without folders, or with as many as tell files of one name apart.
    pub name: &'a str,
    /// The content.
    pub bytes: Box<dyn Bytes + 'a>,
}

/// What may be asked of [`ingest_with`] beyond the profile.
#[derive(Debug, Clone, Copy, Default)]
pub struct IngestOptions<'a> {
    /// Keeps the records of which this is true, of those that remain after merging.
    pub filter: Option<&'a Filter>,
    /// The files are those of another database; without it they are SGO files.
    pub mapping: Option<&'a Mapping>,
}

/// As [`ingest_with`], of SGO files and without a filter.
pub fn ingest(files: &[SourceText<'_>], profile: &SystemProfile) -> Result<Outcome<RecordSet>, IngestError> {
    ingest_with(files, profile, &IngestOptions::default())
}

/// Reads crash files and filters their records by what the profile can express, in the order of the paper: merge (where
/// the profile asks for it), the user's filter, readable narratives, expressible movements and roads. For a profile that
/// goes by accounts every crash report that is left is usable: what of it can be told, its reader says.
///
/// Bad rows are rejected by row number and the rest goes on; an error means that a whole file is unusable.
///
/// # Errors
/// No file, or one of them cannot be read at all.
pub fn ingest_with(
    files: &[SourceText<'_>],
    profile: &SystemProfile,
    options: &IngestOptions<'_>,
) -> Result<Outcome<RecordSet>, IngestError> {
    fn source<'a>(file: &SourceText<'a>) -> SourceBytes<'a> {
        SourceBytes { name: file.name, bytes: Box::new(Cursor::new(file.bytes)) }
    }
    ingest_sources(files.iter().map(source).collect(), profile, options)
}

/// As [`ingest_with`], of files that are read as it goes: in memory is what is kept of them.
///
/// # Errors
/// As [`ingest_with`].
pub fn ingest_sources(
    files: Vec<SourceBytes<'_>>,
    profile: &SystemProfile,
    options: &IngestOptions<'_>,
) -> Result<Outcome<RecordSet>, IngestError> {
    if files.is_empty() {
        return Err(IngestError::NoFiles);
    }
    let mut diagnostics = Vec::new();
    let Gathered { sources, mut drafts, file_of_draft, mut rejects } = gather(files, options, &mut diagnostics)?;
    let rows = drafts.len() + rejects.len();
    diagnostics.extend(identity::differing(&drafts));
    let (fates, funnel) = fates(&mut drafts, rejects.len(), profile, options.filter, &mut diagnostics);

    for ((draft, fate), number) in drafts.iter().zip(&fates).zip(file_of_draft) {
        let Some(reason) = *fate else { continue };
        let (file, row) = (draft.record.provenance.file.clone(), draft.record.provenance.row);
        rejects.push((number, Reject { file, row, record: Some(draft.record.id.clone()), reason }));
    }
    rejects.sort_by_key(|(number, reject)| (*number, reject.row));
    let rejects: Vec<Reject> = rejects.into_iter().map(|(_, reject)| reject).collect();
    let usable: Vec<usize> = (0..drafts.len()).filter(|&i| fates[i].is_none()).collect();
    assert_eq!(rows, usable.len() + rejects.len(), "every row in is usable or rejected");
    let records = drafts.into_iter().map(|draft| draft.record).collect();
    Ok(Outcome {
        value: RecordSet { files: sources, records, usable, rejects, funnel, untold: BTreeMap::new() },
        diagnostics,
    })
}

/// What all files hold.
struct Gathered {
    sources: Vec<SourceFile>,
    drafts: Vec<Draft>,
    /// The position of each draft's file among those that differ.
    file_of_draft: Vec<usize>,
    /// Malformed rows, each with the position of its file.
    rejects: Vec<(usize, Reject)>,
}

/// Reads all files, one behind the other.
fn gather(
    files: Vec<SourceBytes<'_>>,
    options: &IngestOptions<'_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<Gathered, IngestError> {
    let mut all = Gathered { sources: Vec::new(), drafts: Vec::new(), file_of_draft: Vec::new(), rejects: Vec::new() };
    for (number, content) in read(files, options, diagnostics)?.into_iter().enumerate() {
        all.sources.extend(content.sources);
        if all.drafts.is_empty() {
            all.drafts = content.drafts;
        } else {
            all.drafts.extend(content.drafts);
        }
        all.file_of_draft.resize(all.drafts.len(), number);
        all.rejects.extend(content.rejects.into_iter().map(|reject| (number, reject)));
        diagnostics.extend(content.diagnostics);
    }
    Ok(all)
}

/// Why each draft is left out, nothing where it is usable; and how many are left after each step, behind so many malformed rows.
fn fates(
    drafts: &mut [Draft],
    malformed: usize,
    profile: &SystemProfile,
    filter: Option<&Filter>,
    diagnostics: &mut Vec<Diagnostic>,
) -> (Vec<Option<RejectReason>>, Vec<FunnelStep>) {
    let rows = drafts.len() + malformed;
    let mut funnel = vec![FunnelStep { name: "rows".to_owned(), remaining: rows, lost: Vec::new() }];
    if malformed > 0 {
        let lost = vec![(RejectReason::Malformed, malformed)];
        funnel.push(FunnelStep { name: "well formed".to_owned(), remaining: drafts.len(), lost });
    }
    let mut fates: Vec<Option<RejectReason>> = vec![None; drafts.len()];
    if profile.records.dedupe == Dedupe::Incident {
        let (merged, remarks) = identity::merge(drafts);
        diagnostics.extend(remarks);
        for (fate, merged) in fates.iter_mut().zip(merged) {
            *fate = merged.then_some(RejectReason::Merged);
        }
        funnel.push(funnel::tally("one report an incident", &fates, &funnel));
    }
    if let Some(filter) = filter {
        for (draft, fate) in drafts.iter().zip(fates.iter_mut()).filter(|(_, fate)| fate.is_none()) {
            *fate = (!filter.keeps(&draft.record)).then_some(RejectReason::FilteredOut);
        }
        funnel.push(funnel::tally(&format!("where {}", filter.text()), &fates, &funnel));
    }
    funnel::run(drafts, profile, &mut fates, &mut funnel);
    (fates, funnel)
}

/// Every file, read; the same content twice counts once.
fn read(
    files: Vec<SourceBytes<'_>>,
    options: &IngestOptions<'_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<Vec<file::FileContent>, IngestError> {
    let mut hashes: Vec<String> = Vec::new();
    let mut different = Vec::new();
    for mut source in files {
        let hash = stream::sha256(&mut *source.bytes).map_err(|e| IngestError::unreadable(source.name, &e))?;
        if hashes.contains(&hash) {
            diagnostics.push(same_file_twice(source.name));
        } else {
            hashes.push(hash);
            different.push(source);
        }
    }
    match options.mapping {
        Some(mapping) => mapping::read_mapped(different, &hashes, mapping),
        None => {
            let with_hash = different.iter_mut().zip(&hashes);
            with_hash.map(|(source, hash)| file::read_file(source.name, &mut *source.bytes, hash)).collect()
        }
    }
}

fn same_file_twice(name: &str) -> Diagnostic {
    let location = Location { file: Some(name.to_owned()), ..Location::default() };
    Diagnostic::new(Severity::Warning, "records.same-file", location, "the same content was given before; left out")
        .with_hint("give each file once")
}
