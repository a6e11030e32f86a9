//! Where tests come from: a suite, or scenario files. What is read of a suite is read in [`of_suite`] and nowhere else.

use super::{FreezeRequest, Test};
use crate::error::PipelineError;
use crate::files::json::from_json;
use crate::files::store::{Store, io, read_text};
use crate::reading::documents::read_document;
use crate::reading::scenarios::read_scenario;
use crate::suite::Suite;
use crate::suite::names;
use crate::tools::reconstructing::indexed_types;
use recrash_agents::expectation;
use recrash_model::account::{Account, CrashType, told};
use recrash_model::frozen::{About, FROZEN_FILE, FROZEN_FORMAT, FrozenSuite, Provenance};
use recrash_model::narrative::Narrative;
use recrash_model::record::{RecordRef, RecordSet};
use recrash_model::scenario::NOTHING_TO_TEST;
use recrash_model::selection::Selection;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A folder is looked through so deep, and no more files than this are read.
const DEEPEST: usize = 6;
const MOST_FILES: usize = 100_000;
/// A larger file about scenarios is refused. [bytes]
const MAX_ABOUT: u64 = 1 << 28;

/// Everything that is to be frozen.
pub(super) struct Gathered {
    pub tests: Vec<Test>,
    pub profile: String,
    pub left_out: Vec<String>,
}

/// Reads every source.
pub(super) fn gather(request: &FreezeRequest) -> Result<Gathered, PipelineError> {
    let mut gathered = Gathered { tests: Vec::new(), profile: request.default_profile.clone(), left_out: Vec::new() };
    for source in &request.sources {
        if source.join(FROZEN_FILE).is_file() {
            let why = "it is a frozen suite already; it is tested as it is, and its folder `scenarios` holds its scenario files";
            return Err(PipelineError::bad_input(format!("{}: {why}", source.display())));
        }
        if source.join(crate::suite::SUITE_FILE).is_file() {
            of_suite(source, request.tuned, &mut gathered)?;
        } else {
            let mut files = Vec::new();
            scenario_files(source, DEEPEST, &mut files)?;
            for file in files {
                let (scenario, _) = read_scenario(&file)?;
                let about = About::of(&scenario.draft().source);
                gathered.add(Test { scenario, about, expectation: None, account: None });
            }
        }
    }
    if let Some(profile) = &request.profile {
        gathered.profile.clone_from(profile);
    }
    if let Some(file) = &request.about {
        tell(&mut gathered.tests, file)?;
    }
    Ok(gathered)
}

/// The tests of a suite: its scenarios, what each must show, and whose crash it is.
fn of_suite(dir: &Path, tuned: bool, gathered: &mut Gathered) -> Result<(), PipelineError> {
    let suite = Suite::look(dir)?;
    gathered.profile.clone_from(&suite.options().profile);
    let store = suite.store();
    for missing in [names::RECORDS, names::SELECTION] {
        if !store.path(missing).exists() {
            return Err(PipelineError::MissingStage { dir: dir.to_owned(), missing: "select" });
        }
    }
    let records: RecordSet = store.read_json(names::RECORDS)?;
    let selection: Selection = store.read_json(names::SELECTION)?;
    for cluster in &selection.clusters {
        let id = &cluster.scenario_id;
        let file = if tuned { names::tuned(id) } else { names::scenario(id) };
        if !store.path(&file).exists() {
            gathered.left_out.push(format!("{id}: it has no scenario file"));
            continue;
        }
        store.must_be_a_file(&file)?;
        let (scenario, _) = read_scenario(&store.path(&file))?;
        if store.path(&names::account(id)).exists() {
            let account: Account = store.read_json(&names::account(id))?;
            gathered.add(Test { scenario, about: about_account(&account), expectation: None, account: Some(account) });
            continue;
        }
        let narrative: Narrative = store.read_json(&names::narrative(id))?;
        let about = About::of(&scenario.draft().source);
        let told = narrative.told_record().unwrap_or(&cluster.pick);
        let record = records.records.iter().find(|record| record.id == *told);
        let expectation = record.map(|record| expectation(&narrative, record, suite.profile()));
        gathered.add(Test { scenario, about, expectation, account: None });
    }
    Ok(())
}

/// Crash types of the scenarios that a folder holds, by their ids: of a frozen suite, of one by accounts, or of reconstructions with
/// their index. Another folder tells none, nor does a file that cannot be read: the scenarios are there without.
pub fn crash_types(folder: &Path) -> BTreeMap<String, CrashType> {
    let list = folder.join(FROZEN_FILE);
    if list.is_file() {
        let suite: Option<FrozenSuite> = read_document(&list, "frozen suite", FROZEN_FORMAT).ok();
        let tests = suite.into_iter().flat_map(|suite| suite.tests);
        return tests.filter_map(|test| Some((test.id, test.about.crash_type?))).collect();
    }
    let store = Store::at(folder);
    let selection: Option<Selection> = store.read_json(names::SELECTION).ok();
    if selection.is_none() {
        return indexed_types(folder);
    }
    let ids = selection.into_iter().flat_map(|selection| selection.clusters).map(|cluster| cluster.scenario_id);
    let of = |id: String| {
        let account: Account = store.read_json(&names::account(&id)).ok()?;
        told(&account.crash_type).map(|kind| (id, kind))
    };
    ids.filter_map(of).collect()
}

/// Whose crash an account tells.
fn about_account(account: &Account) -> About {
    About {
        provenance: Provenance::Own,
        told: Some(account.report.clone()),
        incident: Some(account.incident.clone()),
        reports: account.reports.clone(),
        crash_type: told(&account.crash_type),
    }
}

impl Gathered {
    /// Takes a test, unless there is nothing to test: of a record whose ego was parked, nobody takes over.
    fn add(&mut self, test: Test) {
        let draft = test.scenario.draft();
        match draft.is_tested() {
            true => self.tests.push(test),
            false => self.left_out.push(format!("{}: {NOTHING_TO_TEST}", draft.id)),
        }
    }
}

/// A scenario file, or all that a folder holds, in the order of their names. Links are not followed.
fn scenario_files(source: &Path, deep: usize, files: &mut Vec<PathBuf>) -> Result<(), PipelineError> {
    if !source.is_dir() {
        files.push(source.to_owned());
        return Ok(());
    }
    let failed = |error| io("read", source, error);
    let mut entries = std::fs::read_dir(source).and_then(Iterator::collect::<Result<Vec<_>, _>>).map_err(failed)?;
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let kind = entry.file_type().map_err(failed)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if kind.is_dir() && deep > 0 && !name.starts_with('.') {
            scenario_files(&entry.path(), deep - 1, files)?;
        } else if kind.is_file() && name.ends_with(".json") && !name.starts_with('.') {
            files.push(entry.path());
        }
        if files.len() > MOST_FILES {
            let message =
                format!("{}: it holds more than {MOST_FILES} files; name a folder of scenarios", source.display());
            return Err(PipelineError::bad_input(message));
        }
    }
    Ok(())
}

/// What `recrash reconstruct --json` says of an incident.
#[derive(Deserialize)]
struct Told {
    incident: String,
    report: String,
    crash_type: Option<CrashType>,
}

#[derive(Deserialize)]
struct AllTold {
    reconstructions: Vec<Told>,
}

/// Adds incidents and crash types to the tests that are of their reports.
fn tell(tests: &mut [Test], file: &Path) -> Result<(), PipelineError> {
    let text = read_text(file, MAX_ABOUT)?;
    let read: AllTold = from_json(text.as_bytes()).map_err(|misread| {
        let why = format!("{}: {misread}", file.display());
        PipelineError::bad_input(format!("{why}; what `recrash reconstruct` prints as JSON is read"))
    })?;
    let by_report: BTreeMap<String, &Told> =
        read.reconstructions.iter().map(|told| (told.report.clone(), told)).collect();
    for test in tests {
        let of = |report: &RecordRef| by_report.get(&report.to_string());
        let Some(told) = test.about.told.iter().chain(&test.about.reports).find_map(of) else { continue };
        test.about.incident = Some(told.incident.clone());
        test.about.crash_type = told.crash_type;
    }
    Ok(())
}
