//! Reconstructions as scenario files, one an incident, and as a table of what became of each.

use crate::error::PipelineError;
use crate::files::folders::must_be_absent_or_same;
use crate::files::output::Outputs;
use crate::files::store::io;
use crate::reading::accounts::coded;
use crate::reading::retelling::{Impact, Retold};
use rayon::prelude::*;
use recrash_model::account::{Account, CrashType, told};
use recrash_model::metrics::CheckResult;
use recrash_reconstruct::Reconstruction;
use recrash_records::{Column, RecordTable};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The table beside scenario files: what became of each incident, and of which crash type it is.
const INDEX: &str = "index.csv";

/// Writes the scenarios that show every told fact that is checked, each as a file named by its incident, and `index.csv` beside them.
/// Gives the files of scenarios.
///
/// # Errors
/// A file cannot be written, or is one of the inputs.
pub fn write_reconstructions(
    accounts: &[Account],
    retold: &[Retold],
    folder: &Path,
    outputs: &mut Outputs,
) -> Result<Vec<PathBuf>, PipelineError> {
    if folder.exists() && !folder.is_dir() {
        return Err(PipelineError::bad_input(format!(
            "{} is a file; name a folder for the scenarios",
            folder.display()
        )));
    }
    std::fs::create_dir_all(folder).map_err(|source| io("create", folder, source))?;
    let mut files = Vec::new();
    let text = |made: &Reconstruction| recrash_roads::write_draft(&made.draft);
    // All of them before the first is written.
    for made in retold.iter().filter(|each| each.untold().is_none()).filter_map(|each| each.result.as_ref().ok()) {
        must_be_absent_or_same(&folder.join(format!("{}.json", made.draft.id)), text(made).as_bytes())?;
    }
    let index = index(&folder.join(INDEX), &reconstruction_table(accounts, retold))?;
    for each in retold.iter().filter(|each| each.untold().is_none()) {
        let Ok(made) = &each.result else { continue };
        let file = folder.join(format!("{}.json", made.draft.id));
        let output = outputs.claim(&file)?;
        output.write(text(made).as_bytes())?;
        files.push(file);
    }
    outputs.claim(&folder.join(INDEX))?.write(&index)?;
    Ok(files)
}

/// What became of each account, a row an incident: whether its crash is shown, how many of its told facts are, and how the two touch
/// in the scenario. `docs/tables.md` has the columns.
pub fn reconstruction_table(accounts: &[Account], retold: &[Retold]) -> RecordTable {
    let impacts: Vec<Option<Impact>> = retold.par_iter().map(Retold::impact).collect();
    let account = |each: &Retold| &accounts[each.account];
    let text = |of: &dyn Fn(&Retold) -> Option<String>| Column::Text(retold.iter().map(of).collect());
    let whole = |of: &dyn Fn(&Retold) -> Option<usize>| {
        Column::Whole(retold.iter().map(|each| of(each).and_then(|count| i64::try_from(count).ok())).collect())
    };
    let facts = |each: &Retold, counts: fn(CheckResult) -> bool| {
        let made = each.result.as_ref().ok()?;
        Some(made.verdict.checks.iter().filter(|check| counts(check.result)).count())
    };
    let number =
        |of: fn(&Impact) -> f64| Column::Number(impacts.iter().map(|impact| impact.as_ref().map(of)).collect());
    let columns = vec![
        ("incident", text(&|each| Some(account(each).incident.clone()))),
        ("report", text(&|each| Some(account(each).report.report_id.clone()))),
        ("version", whole(&|each| Some(account(each).report.version as usize))),
        ("crash_type", text(&|each| told(&account(each).crash_type).map(|kind| coded(&kind)))),
        ("standing", text(&|each| Some(standing(each).to_owned()))),
        ("reason", text(&Retold::reason)),
        ("scenario", text(&|each| each.shown().map(|made| made.draft.id.clone()))),
        ("facts_told", whole(&|each| facts(each, |result| result != CheckResult::NotTold))),
        ("facts_shown", whole(&|each| facts(each, |result| result == CheckResult::Shown))),
        ("ego_impact_speed_mps", number(|impact| impact.ego_impact_speed_mps)),
        ("other_impact_speed_mps", number(|impact| impact.other_impact_speed_mps)),
        ("closing_speed_mps", number(|impact| impact.closing_speed_mps)),
        ("delta_v_mps", number(|impact| impact.delta_v_mps)),
        ("other_delta_v_mps", number(|impact| impact.other_delta_v_mps)),
    ];
    RecordTable { columns, rows: retold.len() }
}

/// What became of an account, in a word.
fn standing(each: &Retold) -> &'static str {
    match &each.result {
        Ok(_) if each.shown().is_some() => "shown",
        Ok(_) => "not_shown",
        Err(_) => "untold",
    }
}

/// The table as CSV, behind the rows of other incidents that the file has already: a folder may be filled bit by bit.
fn index(file: &Path, table: &RecordTable) -> Result<Vec<u8>, PipelineError> {
    let failed = |source| io("write", file, source);
    let mut made = Vec::new();
    table.write_csv(&mut made).map_err(failed)?;
    let Ok(before) = std::fs::read(file) else { return Ok(made) };
    if before.split(|byte| *byte == b'\n').next() != made.split(|byte| *byte == b'\n').next() {
        must_be_absent_or_same(file, &made)?;
    }
    let mut rows: BTreeMap<Vec<u8>, csv::ByteRecord> = BTreeMap::new();
    let mut writer = csv::Writer::from_writer(Vec::new());
    for (text, is_ours) in [(&before, false), (&made, true)] {
        let mut reader = csv::Reader::from_reader(text.as_slice());
        if is_ours {
            let header = reader.byte_headers().map_err(|error| failed(error.into()))?;
            writer.write_byte_record(header).map_err(|error| failed(error.into()))?;
        }
        let told = reader.into_byte_records().filter_map(Result::ok);
        rows.extend(told.map(|row| (row.get(0).unwrap_or_default().to_vec(), row)));
    }
    for row in rows.values() {
        writer.write_byte_record(row).map_err(|error| failed(error.into()))?;
    }
    writer.into_inner().map_err(|error| failed(error.into_error()))
}

/// Crash types of the scenarios that lie beside an `index.csv`, by their ids; none where there is no such table, or it is another one.
pub(crate) fn indexed_types(folder: &Path) -> BTreeMap<String, CrashType> {
    let Ok(mut reader) = csv::Reader::from_path(folder.join(INDEX)) else { return BTreeMap::new() };
    let Ok(header) = reader.headers().cloned() else { return BTreeMap::new() };
    let at = |name: &str| header.iter().position(|other| other == name);
    let (Some(scenario), Some(crash_type)) = (at("scenario"), at("crash_type")) else { return BTreeMap::new() };
    let of = |row: csv::StringRecord| {
        let kind = serde_json::from_value(serde_json::Value::from(row.get(crash_type)?)).ok()?;
        Some((row.get(scenario).filter(|id| !id.is_empty())?.to_owned(), kind))
    };
    reader.into_records().filter_map(Result::ok).filter_map(of).collect()
}
