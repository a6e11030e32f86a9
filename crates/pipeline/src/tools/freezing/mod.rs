//! Frozen suites: a folder of tests that runs anywhere, without the crash file. Described in `docs/nightly.md`.

mod open;
mod sources;

pub(crate) use open::Opened;
pub use sources::crash_types;

use crate::error::{Choice, PipelineError};
use crate::files::folders::must_be_free;
use crate::files::json::to_json;
use crate::files::paths;
use crate::files::store::{Store, sha256, write_suite_file};
use crate::profiles::load_profile;
use recrash_model::account::Account;
use recrash_model::frozen::{
    About, FROZEN_FILE, FROZEN_FORMAT, FrozenFile, FrozenSuite, FrozenTest, Provenance, scenario_content,
};
use recrash_model::metrics::Expectation;
use recrash_roads::Scenario;
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What to freeze, and where to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FreezeRequest {
    /// A suite's folder, folders of scenario files, or scenario files.
    pub sources: Vec<PathBuf>,
    /// What `recrash reconstruct --json` printed of the scenario files: their incidents and crash types.
    pub about: Option<PathBuf>,
    /// The folder to make.
    pub out: PathBuf,
    /// Profile that says what a failure is; the suite's where none is named.
    pub profile: Option<String>,
    /// The profile of scenarios that are no suite's, where none is named.
    pub default_profile: String,
    /// Of a suite: its scenarios as tuned, in place of those as designed.
    pub tuned: bool,
    /// Whether the text of narratives goes along.
    pub narratives: bool,
    /// Whether a frozen suite that is there already may be replaced.
    pub replace: bool,
}

/// What was frozen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Freezing {
    /// Name of the suite by its content.
    pub content: String,
    /// Tests.
    pub tests: usize,
    /// By whose crash it is.
    pub provenance: BTreeMap<Provenance, usize>,
    /// Tests whose crash type is known.
    pub typed: usize,
    /// The folder.
    #[serde(serialize_with = "paths::as_text")]
    pub folder: PathBuf,
    /// Scenarios that were left out, each with the reason.
    pub left_out: Vec<String>,
}

/// One scenario and what is said of it: all that freezing asks of whatever gave it.
pub(crate) struct Test {
    pub scenario: Scenario,
    pub about: About,
    pub expectation: Option<Expectation>,
    pub account: Option<Account>,
}

/// Freezes a suite.
///
/// # Errors
/// A source cannot be read or run, two scenarios have one id, or the folder holds something else.
pub fn freeze(request: &FreezeRequest) -> Result<Freezing, PipelineError> {
    let gathered = sources::gather(request)?;
    let profile = load_profile(&gathered.profile)?;
    let mut tests = gathered.tests;
    tests.sort_by(|a, b| a.scenario.draft().id.cmp(&b.scenario.draft().id));
    if let Some(pair) = tests.windows(2).find(|pair| pair[0].scenario.draft().id == pair[1].scenario.draft().id) {
        let id = &pair[0].scenario.draft().id;
        return Err(PipelineError::bad_input(format!("two scenarios have the id {id}; a suite holds each id once")));
    }
    if tests.is_empty() {
        return Err(PipelineError::bad_input(
            "there is no scenario to freeze; name a suite, a folder or scenario files",
        ));
    }
    may_be_made(request)?;
    let store = Store::create(&request.out, write_suite_file)?;
    let mut files = BTreeSet::new();
    let mut frozen = Vec::new();
    for test in &tests {
        frozen.push(write(&store, test, request.narratives, &mut files)?);
    }
    let suite = FrozenSuite {
        format: FROZEN_FORMAT.to_owned(),
        recrash: env!("CARGO_PKG_VERSION").to_owned(),
        content: FrozenSuite::content_of(&profile, &frozen),
        profile,
        narratives: request.narratives,
        tests: frozen,
    };
    remove_others(&store, &files)?;
    // The list comes last: a folder without it is no frozen suite, and one that was interrupted says so.
    store.write(FROZEN_FILE, &to_json(&suite))?;
    let mut provenance = BTreeMap::new();
    for test in &suite.tests {
        *provenance.entry(test.about.provenance).or_default() += 1;
    }
    Ok(Freezing {
        content: suite.content,
        tests: suite.tests.len(),
        provenance,
        typed: suite.tests.iter().filter(|test| test.about.crash_type.is_some()).count(),
        folder: request.out.clone(),
        left_out: gathered.left_out,
    })
}

/// Writes the files of one test.
fn write(
    store: &Store,
    test: &Test,
    narratives: bool,
    files: &mut BTreeSet<String>,
) -> Result<FrozenTest, PipelineError> {
    let mut draft = test.scenario.draft().clone();
    if !narratives {
        draft.source.narrative.clear();
    }
    let scenario = format!("scenarios/{}.json", draft.id);
    let sha256 = store.write(&scenario, recrash_roads::write_draft(&draft).as_bytes())?;
    files.insert(scenario.clone());
    let account = match &test.account {
        Some(account) => {
            let file = format!("accounts/{}.json", draft.id);
            let sha256 = store.write(&file, &to_json(&account_to_freeze(account, narratives)))?;
            files.insert(file.clone());
            Some(FrozenFile { file, sha256 })
        }
        None => None,
    };
    Ok(FrozenTest {
        content: scenario_content(&draft),
        id: draft.id,
        scenario,
        sha256,
        account,
        about: test.about.clone(),
        expectation: test.expectation.clone(),
    })
}

/// An account as JSON; without the narrative's words where those stay behind. Where they stood is kept.
fn account_to_freeze(account: &Account, narratives: bool) -> Value {
    let mut value = serde_json::to_value(account).unwrap_or_default();
    if !narratives {
        blank_words(&mut value);
        value["contradictions"] = Value::Array(Vec::new());
    }
    value
}

fn blank_words(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            if let Some(Value::Object(words)) = fields.get_mut("words") {
                words.insert("text".to_owned(), Value::String(String::new()));
            }
            fields.values_mut().for_each(blank_words);
        }
        Value::Array(values) => values.iter_mut().for_each(blank_words),
        _ => {}
    }
}

/// Whether the folder is free, or holds a frozen suite that may go.
fn may_be_made(request: &FreezeRequest) -> Result<(), PipelineError> {
    let out = &request.out;
    let refused = |why: &str| Err(PipelineError::bad_input(format!("{}: {why}", out.display())));
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    let holds = |source: &PathBuf| real(source).zip(real(out)).is_some_and(|(source, out)| source.starts_with(out));
    if request.sources.iter().any(holds) {
        return refused("what is read lies in it; name another folder");
    }
    if out.join(FROZEN_FILE).is_file() && !request.replace {
        let what = format!("{}: it holds a frozen suite; name another folder, or replace it", out.display());
        return Err(PipelineError::choose(what, Choice::FrozenSuite));
    }
    must_be_free(out, Some(FROZEN_FILE))
}

/// Removes what a frozen suite that is replaced had, and this one has not.
fn remove_others(store: &Store, files: &BTreeSet<String>) -> Result<(), PipelineError> {
    for folder in ["scenarios", "accounts"] {
        let Ok(entries) = std::fs::read_dir(store.path(folder)) else { continue };
        for entry in entries.flatten() {
            let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
            if name.ends_with(".json") && !files.contains(&name) {
                store.remove(&name)?;
            }
        }
    }
    Ok(())
}

/// SHA-256 of a file's text, as the list has it.
pub(crate) fn hash_of(text: &str) -> String {
    sha256(text.as_bytes())
}
