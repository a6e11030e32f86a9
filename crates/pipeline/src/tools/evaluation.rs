//! How well an agent reads records: its accounts against labels that people wrote. Definitions and targets:
//! `docs/models/evaluation.md`.

mod labels;
mod told;

pub use labels::{Half, Label};
pub use recrash_lab::evaluation::{Field, FieldScore, TwoReaders};

use crate::error::{Choice, PipelineError};
use crate::files::store::{Store, read_bytes, read_text, write_file_whole};
use crate::models::cast::{Cast, RULES, reading_brief, unusable};
use crate::models::{ModelAccess, Models};
use crate::profiles::load_profile;
use crate::reading::fetching::cached;
use labels::{ACCOUNTS, RECORDS, Sheet, agreement, read_labels};
use recrash_agents::Rules;
use recrash_agents::llm::Repairs;
use recrash_model::incident::Incident;
use recrash_model::labelled::LabelledAccount;
use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_model::record::{CrashRecord, RecordRef};
use recrash_model::{Diagnostic, Location, Severity};
use recrash_records::{SourceText, ingest};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Label files larger than this are refused. [bytes]
const MAX_LABELS: u64 = 1 << 24;
/// Name of the reader whose accounts `recrash read` shows.
const READER: &str = "reader";
/// Names under which `recrash fetch` keeps NHTSA's files.
const DOWNLOADED: [&str; 2] = ["sgo-ads-archive.csv", "sgo-ads-current.csv"];
/// Where a development checkout keeps them, as the labels name them; the variable overrides the folder `../shared`.
const SHARED: [&str; 2] = ["data/nhtsa/ads-2021-06-to-2025-06.csv", "data/nhtsa/ads-2025-06-to-2026-01.csv"];
const SHARED_VARIABLE: &str = "RECRASH_SHARED";

/// What is evaluated, and on what.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluationRequest {
    /// `rules`, `reader` (the accounts of `recrash read`), or a model by name.
    pub agent: String,
    /// Label file; the built-in labels where none is given.
    pub labels: Option<PathBuf>,
    /// Crash files; the downloaded ones where none is given.
    pub records: Vec<PathBuf>,
    /// The half that is looked at; both where none is given.
    pub half: Option<Half>,
    /// Profile whose exclusions count.
    pub profile: String,
    /// Folder of a model's questions and answers.
    pub out: PathBuf,
    /// Where a model's answers come from.
    pub models: ModelAccess,
}

/// What came of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// Always `recrash.evaluation/1`.
    pub format: String,
    /// Who was evaluated.
    pub agent: String,
    /// Held-out half first.
    pub halves: Vec<HalfScore>,
    /// Where the agent and the labels differ: of the developed half, or of the half that was asked for alone.
    pub disagreements: Vec<Disagreement>,
    /// Labelled records that are in none of the crash files.
    pub missing: Vec<RecordRef>,
    /// Records a model could not be asked about, or gave no usable account of, and why; every field counts as wrong.
    pub unread: Vec<(RecordRef, String)>,
}

/// Scores on one half.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HalfScore {
    /// Half.
    pub half: Half,
    /// Labelled records that were found.
    pub records: usize,
    /// Score of every field.
    pub fields: Vec<FieldScore>,
}

/// One field of one record on which agent and label differ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Disagreement {
    /// Record.
    pub record: RecordRef,
    /// Who reported it.
    pub entity: String,
    /// Half.
    pub half: Half,
    /// Field.
    pub field: Field,
    /// What the label says.
    pub label: String,
    /// What the agent says.
    pub said: String,
}

/// Reads every labelled record with the agent, and compares.
///
/// # Errors
/// Labels or crash files that cannot be used; questions that wait for a batch.
pub fn evaluate(request: &EvaluationRequest) -> Result<Evaluation, PipelineError> {
    let profile = load_profile(&request.profile)?;
    // Who reads accounts is held against accounts, the rules of templates against what a template asks of a record.
    let sheet = if request.agent == RULES { &RECORDS } else { &ACCOUNTS };
    let labels = match &request.labels {
        None => read_labels(sheet.name, sheet.built_in, sheet)?,
        Some(path) => read_labels(&path.to_string_lossy(), &read_text(path, MAX_LABELS)?, sheet)?,
    };
    let labels: Vec<Label> =
        labels.into_iter().filter(|label| request.half.is_none_or(|half| half == label.half)).collect();
    let records = crash_records(&request.records, &profile)?;
    let find = |wanted: &RecordRef| records.iter().rev().find(|record| record.id == *wanted);
    let missing: Vec<RecordRef> =
        labels.iter().map(|label| &label.record).filter(|id| find(id).is_none()).cloned().collect();
    let found: Vec<(&Label, &CrashRecord)> =
        labels.iter().filter_map(|label| Some((label, find(&label.record)?))).collect();
    if found.is_empty() {
        return Err(PipelineError::BadInput {
            what: "none of the labelled records is in the crash files; give NHTSA's files".into(),
            diagnostics: missing.iter().take(8).map(missing_record).collect(),
        });
    }
    let mut unread = Vec::new();
    let accounts = match request.agent.as_str() {
        RULES => found.iter().map(|(_, record)| Rules.account(record, &profile)).collect(),
        READER => told_accounts(&records, &found),
        _ => model_accounts(request, &profile, &records, &found, &mut unread)?,
    };
    Ok(compare(request, sheet, &found, &accounts, missing, unread))
}

/// Scores by half, and the disagreements that may be shown: those of the held-out half only where it is asked for by name,
/// because rules that are tuned on what it shows make its figures worthless.
fn compare(
    request: &EvaluationRequest,
    sheet: &Sheet,
    found: &[(&Label, &CrashRecord)],
    accounts: &[LabelledAccount],
    missing: Vec<RecordRef>,
    unread: Vec<(RecordRef, String)>,
) -> Evaluation {
    let pairs = || found.iter().copied().zip(accounts);
    // How far two readers agree is known of the built-in accounts alone.
    let two_readers = request.labels.is_none() && request.agent != RULES;
    let mut halves = Vec::new();
    for half in [Half::HeldOut, Half::Dev] {
        let of_half: Vec<(&Label, &LabelledAccount)> =
            pairs().filter(|((label, _), _)| label.half == half).map(|((label, _), said)| (label, said)).collect();
        if of_half.is_empty() {
            continue;
        }
        let fields = sheet.fields.iter().map(|&field| {
            let verdicts: Vec<Option<bool>> =
                of_half.iter().map(|(label, said)| field.agrees(&label.account, said)).collect();
            let readers = if two_readers { agreement(half, field) } else { None };
            FieldScore::of(field, &verdicts, readers)
        });
        halves.push(HalfScore { half, records: of_half.len(), fields: fields.collect() });
    }
    let shown = request.half.unwrap_or(Half::Dev);
    let mut disagreements = Vec::new();
    for ((label, record), said) in pairs().filter(|((label, _), _)| label.half == shown) {
        for &field in sheet.fields.iter().filter(|field| field.agrees(&label.account, said) == Some(false)) {
            disagreements.push(Disagreement {
                record: label.record.clone(),
                entity: record.entity.clone(),
                half: label.half,
                field,
                label: field.text(&label.account),
                said: field.text(said),
            });
        }
    }
    Evaluation {
        format: "recrash.evaluation/1".into(),
        agent: request.agent.clone(),
        halves,
        disagreements,
        missing,
        unread,
    }
}

/// The reader reads incidents, and so may tell of a record what another report of it tells.
fn told_accounts(records: &[CrashRecord], found: &[(&Label, &CrashRecord)]) -> Vec<LabelledAccount> {
    let mut by_report = BTreeMap::new();
    for account in recrash_reader::incidents(records).iter().filter_map(recrash_reader::account) {
        let said = told::in_labels(&account);
        for report in account.reports {
            by_report.insert(report.report_id, said.clone());
        }
    }
    found.iter().map(|(label, _)| by_report.get(&label.record.report_id).cloned().unwrap_or_default()).collect()
}

/// A model reads through the same role that reads incidents for a suite, over the account of the reader.
fn model_accounts(
    request: &EvaluationRequest,
    profile: &SystemProfile,
    records: &[CrashRecord],
    found: &[(&Label, &CrashRecord)],
    unread: &mut Vec<(RecordRef, String)>,
) -> Result<Vec<LabelledAccount>, PipelineError> {
    let store = Store::create(&request.out, write_file_whole)?;
    let cast = Cast { paraphrase: request.agent.clone(), ..Cast::default() };
    let (models, _) = Models::open(&store, &cast, &request.models, |_| true)?;
    let incidents = recrash_reader::incidents(records);
    let of_report: BTreeMap<&str, &Incident> = incidents
        .iter()
        .flat_map(|incident| incident.reports.iter().map(move |report| (report.record.id.report_id.as_str(), incident)))
        .collect();
    // Why there is none, where the model gives no usable one; what stops the run is an error.
    let read = |label: &Label| -> Result<Result<LabelledAccount, String>, PipelineError> {
        let incident = of_report.get(label.record.report_id.as_str()).copied();
        let Some((incident, base)) = incident.and_then(|it| Some((it, recrash_reader::account(it)?))) else {
            return Ok(Err("it has no narrative that can be read".to_owned()));
        };
        let reports: Vec<&CrashRecord> = incident.reports.iter().map(|report| &report.record).collect();
        let scenario_id = format!("eval-{}", base.incident);
        let brief = reading_brief(&scenario_id, &reports, profile, &base);
        let repairs = Repairs::default();
        match models.model(&request.agent, &cast, &repairs).read(&brief, &base) {
            Ok(account) => Ok(Ok(told::in_labels(&account))),
            Err(error) => unusable(error).map(Err),
        }
    };
    let mut accounts = Vec::with_capacity(found.len());
    let mut waiting = false;
    for (label, _) in found {
        accounts.push(match read(label) {
            Ok(Ok(account)) => account,
            Ok(Err(why)) => {
                unread.push((label.record.clone(), why));
                LabelledAccount::default()
            }
            Err(PipelineError::AnswerPending) => {
                waiting = true;
                LabelledAccount::default()
            }
            Err(error) => return Err(error),
        });
    }
    if waiting {
        let (requests, count) = models.write_requests()?;
        return Err(PipelineError::WaitingForBatch { requests, count });
    }
    Ok(accounts)
}

fn crash_records(files: &[PathBuf], profile: &SystemProfile) -> Result<Vec<CrashRecord>, PipelineError> {
    let paths: Vec<PathBuf> = match files {
        [] => default_files(),
        files => files.iter().map(|file| cached_or(file)).collect(),
    };
    if paths.is_empty() {
        return Err(PipelineError::choose(
            "there are no crash files to evaluate on; give NHTSA's, or download them",
            Choice::Records,
        ));
    }
    let files = paths.iter().map(|path| {
        Ok((path.to_string_lossy().into_owned(), read_bytes(path, recrash_records::MAX_FILE_BYTES as u64)?))
    });
    let files = files.collect::<Result<Vec<_>, PipelineError>>()?;
    let sources: Vec<SourceText> = files.iter().map(|(name, bytes)| SourceText { name, bytes }).collect();
    // Labels are of single versions: nothing may be merged away.
    let mut profile = profile.clone();
    profile.records.dedupe = Dedupe::None;
    let set = ingest(&sources, &profile).map_err(|e| PipelineError::bad_input(e.to_string()))?;
    Ok(set.value.records)
}

/// The downloaded files, else those of a development checkout.
fn default_files() -> Vec<PathBuf> {
    let downloaded: Vec<PathBuf> = DOWNLOADED.iter().filter_map(|name| cached(Path::new(name))).collect();
    if !downloaded.is_empty() {
        return downloaded;
    }
    let shared = std::env::var_os(SHARED_VARIABLE).map_or_else(|| PathBuf::from("../shared"), PathBuf::from);
    SHARED.iter().map(|name| shared.join(name)).filter(|path| path.is_file()).collect()
}

fn cached_or(file: &Path) -> PathBuf {
    if file.exists() { file.to_owned() } else { cached(file).unwrap_or_else(|| file.to_owned()) }
}

fn missing_record(id: &RecordRef) -> Diagnostic {
    Diagnostic::new(Severity::Warning, "eval.missing", Location::default(), format!("{id} is in no crash file"))
}
