//! The suite on disk: a folder with one stage after the other in it, and which units of work are done.
//!
//! A unit is made of its own inputs alone, and made again when one of them changed. What a person edited is kept, and the
//! stages after it go on from there. A suite may come from a stranger: it is data, see [`Permissions`].

mod journal;
pub(crate) mod names;

use crate::error::PipelineError;
use crate::models::cast::RULES;
use crate::simulators::external::{EgoCommand, Patience};

use crate::files::json::to_json;
use crate::files::store::{CODE, Store, TEMPORARY_PREFIX, WriteFile, sha256, write_suite_file};
use crate::models::{AnswerMode, ModelAccess, Models};
use crate::options::{Options, RecordSource};
use crate::reading::records;
use crate::reading::retelling::Stagings;
use crate::simulators::{Simulator, start_simulator};
use journal::{Begun, Journal, Made, Unit};
use names::{EDITABLE_FOLDERS, is_failure_file};
use recrash_agents::llm::Spent;
use recrash_model::profile::SystemProfile;
use recrash_model::{Diagnostic, Location, Seed, Severity};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The suite files' format tag.
const SUITE_FORMAT: &str = "recrash.suite/2";
/// The file that makes a folder a suite.
pub(crate) const SUITE_FILE: &str = "suite.json";

/// The stages, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Crash files to records.
    Records,
    /// Records to picks.
    Select,
    /// Picks to narratives.
    Narrate,
    /// Narratives to scenarios.
    Design,
    /// Scenarios to judged runs.
    Simulate,
    /// Scenarios to tuned scenarios.
    Tune,
    /// Tuned scenarios to judged runs, and failures to what they are worth.
    Triage,
    /// Runs of the recorded driver to reviews, where a model is cast for that.
    Review,
    /// All of it to a page.
    Report,
}

impl Stage {
    /// Every stage, in order.
    pub const ALL: [Self; 9] = [
        Self::Records,
        Self::Select,
        Self::Narrate,
        Self::Design,
        Self::Simulate,
        Self::Tune,
        Self::Triage,
        Self::Review,
        Self::Report,
    ];

    /// Name of the stage and of its subcommand.
    pub fn name(self) -> &'static str {
        match self {
            Self::Records => "records",
            Self::Select => "select",
            Self::Narrate => "narrate",
            Self::Design => "design",
            Self::Simulate => "simulate",
            Self::Tune => "tune",
            Self::Triage => "triage",
            Self::Review => "review",
            Self::Report => "report",
        }
    }
}

/// What `suite.json` holds.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Saved {
    format: String,
    version: String,
    options: Options,
}

/// Files of a unit: name and content.
pub(crate) type Files = Vec<(String, Vec<u8>)>;

/// What became of a unit of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Course {
    /// It was done.
    Done,
    /// It was there already.
    Skipped,
    /// A person edited what it wrote, which is kept.
    Edited,
    /// The same, and what it would be made of has changed since.
    EditedAndOld,
}

/// A unit of work: its name, what decides it, and which of its files people may edit.
pub(crate) struct Work<'a> {
    /// Name.
    pub name: &'a str,
    /// Everything that decides what comes out.
    pub inputs: &'a [String],
    /// Files that a person may edit: they are kept.
    pub editable: &'a [String],
}

/// What the caller allows a run to do with a suite that is there already.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Permissions {
    /// Makes a suite of other records or of another profile in its place.
    pub replace: bool,
    /// Takes back what people edited.
    pub discard_edits: bool,
    /// Chooses the picks anew; without it, those of the last choice stay when records come in.
    pub reselect: bool,
    /// Starts programs that the suite names; without it only those that the caller names.
    pub trust: bool,
    /// Asks the language models of its options; without it only the ledger answers for them.
    pub ask_models: bool,
}

/// What a run may use of the machine, and what it may do. No byte of the results depends on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Resources {
    /// Worker threads; as many as there are cores where not given.
    pub threads: Option<usize>,
    /// Python interpreter for MetaDrive.
    pub python: PathBuf,
    /// How long answers of an external ego are waited for.
    pub patience: Patience,
    /// How models are asked.
    pub models: ModelAccess,
    /// What it may do with what is there.
    pub permissions: Permissions,
}

impl Default for Resources {
    fn default() -> Self {
        Self {
            threads: None,
            python: "python3".into(),
            patience: Patience::default(),
            models: ModelAccess::default(),
            permissions: Permissions::default(),
        }
    }
}

/// A suite on disk.
pub struct Suite {
    store: Store,
    profile: SystemProfile,
    journal: Mutex<Journal>,
    options: Options,
    permissions: Permissions,
    threads: rayon::ThreadPool,
    /// As many threads as questions may be under way; absent where nobody is asked over the network.
    askers: Option<rayon::ThreadPool>,
    python: PathBuf,
    patience: Patience,
    models: Option<Models>,
    remarks: Vec<Diagnostic>,
    stagings: Stagings,
    /// Whether the options stand in the suite's file.
    saved: Mutex<bool>,
    /// Keeps others from working in the folder at the same time.
    _lock: Option<File>,
    _folder: Option<MadeFolder>,
}

/// A folder that was made for a suite: it goes again where nothing comes into it.
struct MadeFolder(PathBuf);

impl Drop for MadeFolder {
    fn drop(&mut self) {
        // What holds something stays.
        let _ = std::fs::remove_dir(&self.0);
    }
}

impl Suite {
    /// The options of the suite in a folder; `None` where there is no suite in it.
    ///
    /// # Errors
    /// The suite file is damaged.
    pub fn saved_options(dir: &Path) -> Result<Option<Options>, PipelineError> {
        let there = dir.join(SUITE_FILE).symlink_metadata().is_ok();
        there.then(|| Ok(read_saved(&Store::at(dir))?.options)).transpose()
    }

    /// Opens the suite in a folder, or makes one. The options are saved with the first work that is done with them: a crash file
    /// that cannot be read leaves the folder as it was.
    ///
    /// # Errors
    /// The folder cannot be used, holds something else or a suite of other records or of another profile, or the options
    /// name no profile.
    pub fn open(dir: &Path, options: Options, resources: Resources) -> Result<Self, PipelineError> {
        Self::open_with(dir, options, resources, write_suite_file)
    }

    /// As [`Suite::open`], with another way of writing files.
    ///
    /// # Errors
    /// As [`Suite::open`].
    pub fn open_with(
        dir: &Path,
        options: Options,
        resources: Resources,
        write_file: WriteFile,
    ) -> Result<Self, PipelineError> {
        options.system_profile()?;
        options.must_be_text()?;
        records::read_filter(&options)?;
        let before = Self::saved_options(dir)?;
        if let Some(saved) = before.as_ref().filter(|_| !resources.permissions.replace) {
            refuse_other(dir, saved, &options)?;
        }
        let is_new = !dir.exists();
        let store = Store::create(dir, write_file)?;
        let folder = is_new.then(|| MadeFolder(dir.to_owned()));
        let lock = lock_folder(dir)?;
        if before.is_none() && !is_empty(dir)? {
            return Err(PipelineError::NotASuite { dir: dir.to_owned() });
        }
        let mut journal = read_journal(&store, resources.permissions.discard_edits)?;
        if before.is_some() {
            store.remove_leftovers()?;
        }
        journal.tidy(&store)?;
        let saved = Mutex::new(before.as_ref() == Some(&options));
        Ok(Self { saved, _folder: folder, ..Self::set_up(store, options, resources, journal, lock)? })
    }

    /// Saves the options, unless they are. Comes before anything else is written.
    pub(crate) fn save(&self) -> Result<(), PipelineError> {
        let mut saved = self.saved.lock().unwrap_or_else(PoisonError::into_inner);
        if !*saved {
            let now = Saved {
                format: SUITE_FORMAT.into(),
                version: env!("CARGO_PKG_VERSION").into(),
                options: self.options.clone(),
            };
            self.store.write(SUITE_FILE, &to_json(&now))?;
            *saved = true;
        }
        Ok(())
    }

    /// Opens a suite to read what is in it: nothing is written, and others may work in it.
    ///
    /// # Errors
    /// There is no suite in the folder, or its file is damaged.
    pub(crate) fn look(dir: &Path) -> Result<Self, PipelineError> {
        let store = Store::at(dir);
        let options = read_saved(&store)?.options;
        let journal = Journal::read(&store)?;
        Self::set_up(store, options, Resources::default(), journal, None)
    }

    fn set_up(
        store: Store,
        options: Options,
        resources: Resources,
        journal: Journal,
        lock: Option<File>,
    ) -> Result<Self, PipelineError> {
        let profile = options.system_profile()?;
        let threads = thread_pool(resources.threads.unwrap_or(0))?;
        let has_model = !options.cast.models().is_empty();
        let may_ask = resources.permissions.ask_models;
        let opened = has_model.then(|| Models::open(&store, &options.cast, &resources.models, may_ask)).transpose()?;
        let (models, remarks) = opened.map_or((None, Vec::new()), |(models, remarks)| (Some(models), remarks));
        let asks = has_model && resources.models.mode == AnswerMode::Live;
        let askers = asks.then(|| thread_pool(resources.models.concurrency)).transpose()?;
        let Resources { python, patience, permissions, .. } = resources;
        let journal = Mutex::new(journal);
        let (_lock, threads) = (lock, threads);
        Ok(Self {
            store,
            profile,
            journal,
            options,
            permissions,
            threads,
            askers,
            python,
            patience,
            models,
            remarks,
            stagings: Stagings::default(),
            saved: Mutex::new(true),
            _lock,
            _folder: None,
        })
    }

    /// Does the work of a stage on the threads that fit it: of one that a model plays, as many as may be asked at a time.
    pub(crate) fn on_threads<T: Send>(&self, stage: Stage, work: impl FnOnce() -> T + Send) -> T {
        let cast = &self.options.cast;
        let by_model = match stage {
            Stage::Narrate => cast.paraphrase != RULES,
            Stage::Design => cast.design != RULES,
            Stage::Tune => cast.tune != RULES,
            Stage::Review => cast.review.is_some(),
            Stage::Records | Stage::Select | Stage::Simulate | Stage::Triage | Stage::Report => false,
        };
        match self.askers.as_ref().filter(|_| by_model) {
            Some(askers) => askers.install(work),
            None => self.in_pool(work),
        }
    }

    /// Scenarios that the records stage of this run has found.
    pub(crate) fn stagings(&self) -> &Stagings {
        &self.stagings
    }

    /// What this run has spent on models.
    pub fn spent(&self) -> Option<Spent> {
        self.models.as_ref().map(Models::spent)
    }

    /// Does something on the suite's threads.
    pub(crate) fn in_pool<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.threads.install(work)
    }

    /// Python interpreter for what needs one.
    pub(crate) fn python(&self) -> &Path {
        &self.python
    }

    /// The profile.
    pub fn profile(&self) -> &SystemProfile {
        &self.profile
    }

    /// What the user chose.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Name of the ego to run.
    pub fn ego(&self) -> &str {
        self.options.ego.as_deref().unwrap_or(&self.profile.ego)
    }

    /// What the caller allows.
    pub(crate) fn permissions(&self) -> Permissions {
        self.permissions
    }

    /// The suite's folder.
    pub fn store(&self) -> &Store {
        &self.store
    }

    /// The simulator with the ego in it.
    ///
    /// # Errors
    /// It cannot be set up, or the ego is a program that only the suite names.
    pub(crate) fn simulator(&self) -> Result<Box<dyn Simulator>, PipelineError> {
        let ego = self.ego();
        refuse_untrusted(ego, self.permissions.trust)?;
        let workers = self.threads.current_num_threads();
        start_simulator(self.options.simulator, ego, &self.python, workers, self.patience)
    }

    /// The models' side; absent where the rules play every role.
    pub(crate) fn models(&self) -> Option<&Models> {
        self.models.as_ref()
    }

    /// What there was to say about the answers of a batch.
    pub fn remarks(&self) -> &[Diagnostic] {
        &self.remarks
    }

    pub(crate) fn seed(&self) -> Seed {
        Seed(self.options.seed)
    }

    /// Does a unit of work, unless it is done: the same inputs gave files that are still there. A failure is tried again.
    /// Files that a person edited are kept, and so is the rest of their unit.
    pub(crate) fn unit(
        &self,
        work: &Work,
        make: impl FnOnce() -> Result<Files, PipelineError>,
    ) -> Result<Course, PipelineError> {
        let inputs = hash_all(work.inputs);
        let before = self.lock().get(work.name).cloned();
        if let Some(unit) = &before {
            let is_current = unit.inputs == inputs;
            let changed = self.changed(unit);
            let edited = changed.iter().any(|file| self.is_edit(work.name, file, work.editable));
            if edited && !self.permissions.discard_edits {
                self.save()?;
                return Ok(if is_current { Course::Edited } else { Course::EditedAndOld });
            }
            let failed = unit.outputs.keys().any(|file| is_failure_file(file));
            if is_current && !failed && changed.is_empty() {
                self.save()?;
                return Ok(Course::Skipped);
            }
        }
        let files = make()?;
        self.save()?;
        self.write_unit(work, before.as_ref(), inputs, files)
    }

    /// Writes the files of a unit, and removes what it wrote before and does not any more. The journal says what is about to be written
    /// first: a program that ends in between leaves unfinished work, and no edits.
    fn write_unit(
        &self,
        work: &Work,
        before: Option<&Unit>,
        inputs: String,
        files: Files,
    ) -> Result<Course, PipelineError> {
        let of_others = self.of_others(work, before, &files);
        // What unfinished work left behind goes as well.
        let left = self.lock().begun(work.name).cloned().unwrap_or_default().into_iter();
        let mut writing: Begun = left.filter(|(file, hash)| hash.is_none() || self.store.hash(file) == *hash).collect();
        let left: Vec<String> = writing.keys().cloned().collect();
        let hash = |file: &String, content: &[u8]| work.editable.contains(file).then(|| sha256(content));
        writing.extend(files.iter().map(|(file, content)| (file.clone(), hash(file, content))));
        self.lock().begin(&self.store, work.name, writing)?;
        let mut outputs = BTreeMap::new();
        for (file, content) in files {
            let made = if of_others.contains(&file) {
                Made { hash: sha256(&content), size: content.len() as u64, changed_ns: 0 }
            } else {
                let hash = self.store.write(&file, &content)?;
                let (size, changed_ns) = self.store.stamp(&file).unwrap_or_default();
                Made { hash, size, changed_ns }
            };
            outputs.insert(file, made);
        }
        let stale = before.iter().flat_map(|unit| unit.outputs.keys()).chain(&left);
        for file in stale.filter(|file| !outputs.contains_key(*file)) {
            self.store.remove(file)?;
        }
        self.lock().note(&self.store, work.name, Unit { inputs, outputs })?;
        Ok(if of_others.is_empty() { Course::Done } else { Course::Edited })
    }

    /// Files in the place of those that a unit is about to write which no run wrote, as far as is known: they are a person's, and are kept.
    fn of_others(&self, work: &Work, before: Option<&Unit>, files: &Files) -> BTreeSet<String> {
        let is_other = |file: &String, content: &[u8]| {
            let is_known = before.is_some_and(|unit| unit.outputs.contains_key(file));
            !is_known
                && self.is_edit(work.name, file, work.editable)
                && self.store.hash(file).is_some_and(|hash| hash != sha256(content))
        };
        if self.permissions.discard_edits {
            return BTreeSet::new();
        }
        files.iter().filter(|(file, content)| is_other(file, content)).map(|(file, _)| file.clone()).collect()
    }

    /// Whether a file still is what its unit wrote.
    fn is_as_made(&self, file: &str, made: &Made) -> bool {
        match self.store.stamp(file) {
            None => false,
            Some((size, _)) if size != made.size => false,
            Some((_, changed_ns)) if changed_ns == made.changed_ns => true,
            // Another time and the same size: a copy of the suite, or an edit.
            Some(_) => self.store.hash(file).as_ref() == Some(&made.hash),
        }
    }

    /// Files of a unit that are not as it wrote them, or gone.
    fn changed<'a>(&self, unit: &'a Unit) -> Vec<&'a String> {
        unit.outputs.iter().filter(|(file, made)| !self.is_as_made(file, made)).map(|(file, _)| file).collect()
    }

    /// Whether a changed file is a person's edit: of what may be edited, not gone, and not what a run was writing when it ended.
    fn is_edit(&self, unit: &str, changed: &String, editable: &[String]) -> bool {
        editable.contains(changed) && self.store.stamp(changed).is_some() && !self.is_unfinished(unit, changed)
    }

    /// Whether a file is what its unit was writing when it ended.
    fn is_unfinished(&self, unit: &str, file: &str) -> bool {
        let hash = self.lock().begun(unit).and_then(|files| files.get(file).cloned()).flatten();
        hash.is_some() && self.store.hash(file) == hash
    }

    /// Has a unit made again, though what it was made of may not have changed.
    pub(crate) fn outdate(&self, unit: &str) {
        self.lock().outdate(unit);
    }

    /// Whether a finished unit wrote this file.
    pub(crate) fn wrote(&self, unit: &str, file: &str) -> bool {
        self.lock().get(unit).is_some_and(|unit| unit.outputs.contains_key(file))
    }

    /// Files of a finished unit that a person edited; none of an unfinished one.
    pub(crate) fn edited(&self, unit: &str, editable: &[String]) -> Vec<String> {
        let Some(made) = self.lock().get(unit).cloned() else { return Vec::new() };
        let changed = self.changed(&made);
        changed.into_iter().filter(|file| self.is_edit(unit, file, editable)).cloned().collect()
    }

    /// Forgets the units of a stage that are not among `names`, and removes their files but those a person edited, which
    /// are told of.
    pub(crate) fn keep_only(
        &self,
        stage: Stage,
        names: &[String],
        editable: impl Fn(&str) -> Vec<String>,
    ) -> Result<Vec<Diagnostic>, PipelineError> {
        let prefix = format!("{}/", stage.name());
        let all = self.lock().beginning_with(&prefix);
        let mut remarks = Vec::new();
        for name in all.iter().filter(|unit| !names.contains(unit)) {
            let edited = self.edited(name, &editable(name.strip_prefix(&prefix).unwrap_or(name)));
            for file in &self.written_by(name) {
                if edited.contains(file) && !self.permissions.discard_edits {
                    let message = "is no longer part of the suite; it was edited by hand, and is kept";
                    let location = Location { file: Some(file.clone()), ..Location::default() };
                    remarks.push(Diagnostic::new(Severity::Warning, "suite.edit-left-over", location, message));
                } else {
                    self.store.remove(file)?;
                }
            }
            // At last: where the program ends before, the rest is removed the next time.
            self.lock().forget(&self.store, name)?;
        }
        Ok(remarks)
    }

    /// Files that a unit wrote, or was writing when it ended.
    fn written_by(&self, name: &str) -> BTreeSet<String> {
        let journal = self.lock();
        let made = journal.get(name).into_iter().flat_map(|unit| unit.outputs.keys());
        let begun = journal.begun(name).into_iter().flatten().filter(|(file, hash)| match hash {
            Some(hash) => self.store.hash(file).as_ref() == Some(hash),
            None => true,
        });
        made.chain(begun.map(|(file, _)| file)).cloned().collect()
    }

    /// Hash of a file that a finished unit wrote, as it is now: a person may have edited it.
    pub(crate) fn output_hash(&self, stage: Stage, unit: &str, file: &str) -> Result<String, PipelineError> {
        let made = self.lock().get(unit).and_then(|unit| unit.outputs.get(file).cloned());
        let hash =
            made.and_then(|made| if self.is_as_made(file, &made) { Some(made.hash) } else { self.store.hash(file) });
        hash.ok_or_else(|| PipelineError::MissingStage { dir: self.store.dir().to_owned(), missing: stage.name() })
    }

    /// One hash of all files of a finished unit, as they are now.
    pub(crate) fn outputs_hash(&self, unit: &str) -> String {
        let Some(unit) = self.lock().get(unit).cloned() else { return String::new() };
        let hash = |(file, made): (&String, &Made)| {
            let now = if self.is_as_made(file, made) { Some(made.hash.clone()) } else { self.store.hash(file) };
            format!("{file} {}", now.unwrap_or_default())
        };
        unit.outputs.iter().map(hash).collect::<Vec<_>>().join("\n")
    }

    /// Refuses a unit that was made of something else, or whose files are not as they were made though nobody may edit them.
    pub(crate) fn must_be_current(&self, stage: Stage, work: &Work) -> Result<(), PipelineError> {
        let Some(unit) = self.lock().get(work.name).cloned() else {
            return Err(PipelineError::MissingStage { dir: self.store.dir().to_owned(), missing: stage.name() });
        };
        let changed = self.changed(&unit);
        let (edited, spoiled): (Vec<&String>, _) =
            changed.into_iter().partition(|file| self.is_edit(work.name, file, work.editable));
        if unit.inputs != hash_all(work.inputs) && edited.is_empty() {
            return Err(self.stale(stage));
        }
        match (spoiled.first(), edited.first()) {
            (None, _) => Ok(()),
            (Some(file), None) => {
                Err(PipelineError::ChangedByHand { path: self.store.path(file), stage: stage.name() })
            }
            (Some(file), Some(&edited)) => {
                Err(PipelineError::ChangedBesideEdit { path: self.store.path(file), edited: edited.clone() })
            }
        }
    }

    /// What a stage made is not of the options and files as they are now.
    pub(crate) fn stale(&self, stage: Stage) -> PipelineError {
        PipelineError::StaleStage { dir: self.store.dir().to_owned(), stage: stage.name() }
    }

    fn lock(&self) -> MutexGuard<'_, Journal> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Refuses to start a program that a file names: a suite may be a stranger's.
///
/// # Errors
/// The ego is a program, and the caller neither named it nor trusts the suite.
pub(crate) fn refuse_untrusted(ego: &str, trust: bool) -> Result<(), PipelineError> {
    if trust || matches!(EgoCommand::parse(ego), Ok(None)) {
        return Ok(());
    }
    Err(PipelineError::Untrusted { program: ego.to_owned() })
}

/// Refuses to make a suite of other records, or of another profile, where there is one already: its results would be lost.
/// Further files beside those it was made of are welcome.
fn refuse_other(dir: &Path, saved: &Options, options: &Options) -> Result<(), PipelineError> {
    let files = |source: &RecordSource| match source {
        RecordSource::Sample => vec!["the built-in sample".to_owned()],
        RecordSource::Files(paths) => {
            let name = |path: &PathBuf| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
            paths.iter().map(name).collect()
        }
    };
    let (before, now) = (files(&saved.records), files(&options.records));
    if let Some(missing) = before.iter().find(|file| !now.contains(file)) {
        let what = format!("records of {missing}, which these are not ({})", now.join(", "));
        return Err(PipelineError::OtherSuite { dir: dir.to_owned(), what });
    }
    if saved.profile != options.profile {
        let what = format!("profile \"{}\", not of \"{}\"", saved.profile, options.profile);
        return Err(PipelineError::OtherSuite { dir: dir.to_owned(), what });
    }
    Ok(())
}

/// A pool of so many threads; as many as there are cores for 0.
pub(crate) fn thread_pool(threads: usize) -> Result<rayon::ThreadPool, PipelineError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|e| PipelineError::Threads(e.to_string()))
}

/// Takes the folder for this program alone. Where the system cannot lock a folder, nothing is said: files are written
/// whole in any case.
fn lock_folder(dir: &Path) -> Result<Option<File>, PipelineError> {
    let Ok(folder) = File::open(dir) else { return Ok(None) };
    match folder.try_lock() {
        Err(TryLockError::WouldBlock) => Err(PipelineError::Busy { dir: dir.to_owned() }),
        Ok(()) | Err(TryLockError::Error(_)) => Ok(Some(folder)),
    }
}

fn read_saved(store: &Store) -> Result<Saved, PipelineError> {
    let unusable = |problem: String| {
        PipelineError::bad_input(format!(
            "{}: {problem}; nothing can go on in this folder: choose another folder (with a copy of ledger/ in it, answers \
             of models are kept)",
            store.path(SUITE_FILE).display()
        ))
    };
    let saved: serde_json::Value = store.read_json(SUITE_FILE).map_err(|error| match error {
        PipelineError::Damaged { problem, .. } => unusable(problem),
        PipelineError::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
            PipelineError::NoSuite { dir: store.dir().to_owned() }
        }
        other => other,
    })?;
    let format = saved["format"].as_str().unwrap_or_default().to_owned();
    if format != SUITE_FORMAT {
        return Err(unusable(format!("format is \"{format}\"; this version reads \"{SUITE_FORMAT}\"")));
    }
    serde_json::from_value(saved).map_err(|error| unusable(error.to_string()))
}

/// The journal of a folder that is about to be worked in. Where it is gone although there is work that people may have edited, nothing is
/// written over that unless the caller says so.
fn read_journal(store: &Store, discard_edits: bool) -> Result<Journal, PipelineError> {
    match Journal::read(store) {
        Err(_) if discard_edits => Ok(Journal::anew()),
        Ok(journal) if journal.is_empty() && !discard_edits => {
            match EDITABLE_FOLDERS.into_iter().find(|folder| !is_empty(&store.path(folder)).unwrap_or(true)) {
                Some(folder) => Err(journal::lost(store, format!("it is gone, though there are files in {folder}/"))),
                None => Ok(journal),
            }
        }
        read => read,
    }
}

/// Whether there is nothing in a folder but what is being written, or was when a program was killed.
fn is_empty(folder: &Path) -> Result<bool, PipelineError> {
    let failed = |source| PipelineError::Io { action: "read", path: folder.to_owned(), source };
    let mut entries = std::fs::read_dir(folder).map_err(failed)?;
    let is_ours = |entry: std::fs::DirEntry| entry.file_name().to_string_lossy().starts_with(TEMPORARY_PREFIX);
    Ok(entries.all(|entry| entry.is_ok_and(is_ours)))
}

/// One hash of several inputs and of the code of this program.
fn hash_all(inputs: &[String]) -> String {
    let mut all = CODE.as_bytes().to_vec();
    for input in inputs {
        all.extend((input.len() as u64).to_le_bytes());
        all.extend_from_slice(input.as_bytes());
    }
    sha256(&all)
}
