//! The suite on disk: options, stages, and which units of work are done.

use crate::agents::{Cast, RULES};
use crate::embedding::EmbeddingKind;
use crate::error::PipelineError;
use crate::external::Patience;
use crate::models::{AnswerMode, ModelAccess, Models};
use crate::paths;
use crate::profiles::load_profile;
use crate::progress::Progress;
use crate::recording;
use crate::simulator::{Simulator, SimulatorKind, start_simulator};
use crate::stages::names::FAILURE;
use crate::stages::{self, StageReport};
use crate::store::{Store, WriteFile, sha256, to_json, write_file_whole};
use recrash_agents::llm::Spent;
use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_model::selection::{Strategy, Weighting};
use recrash_model::{Diagnostic, Seed};
use recrash_select::SelectOptions;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The suite files' format tag.
const SUITE_FORMAT: &str = "recrash.suite/1";
/// The file that makes a folder a suite.
const SUITE_FILE: &str = "suite.json";

/// Where crash records come from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RecordSource {
    /// The built-in sample.
    Sample,
    /// SGO files, or those of another database where there is a mapping. A name that is no file here is looked up among
    /// the downloaded ones.
    Files(Vec<PathBuf>),
}

/// What the user chose. Everything that can change a byte of the results, and nothing else.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Options {
    /// Crash records.
    pub records: RecordSource,
    /// Which reports of one incident are merged; as the profile has it where not given.
    #[serde(default)]
    pub dedupe: Option<Dedupe>,
    /// Keeps the records of which this filter is true.
    #[serde(default)]
    pub filter: Option<String>,
    /// Mapping file: the records are those of another database.
    #[serde(default)]
    pub mapping: Option<PathBuf>,
    /// Profile: a built-in name or a path.
    pub profile: String,
    /// Scenarios to make.
    pub budget: usize,
    /// How the picks are chosen.
    pub strategy: Strategy,
    /// How much one record counts in sharing out the picks.
    #[serde(default)]
    pub weighting: Weighting,
    /// Weight of a template against a narrative: the length of its one-hot vector in the clustering space.
    #[serde(default = "default_template_weight")]
    pub template_weight: f64,
    /// Principal components of the embedding that enter the clustering space.
    #[serde(default = "default_dimensions")]
    pub dimensions: usize,
    /// Runs of k-means, of which the best is kept.
    #[serde(default = "default_restarts")]
    pub restarts: usize,
    /// Which embedding of the narratives.
    #[serde(default)]
    pub embedding: EmbeddingKind,
    /// Folder with the files of the embedding model; looked for where not given.
    #[serde(default)]
    pub model_dir: Option<PathBuf>,
    /// Who plays which role.
    #[serde(default)]
    pub cast: Cast,
    /// Simulator.
    #[serde(default)]
    pub simulator: SimulatorKind,
    /// Ego to run; the profile's where not given.
    pub ego: Option<String>,
    /// Points the search of each scenario may score.
    pub tune_budget: usize,
    /// Optimiser of the search.
    pub searcher: String,
    /// Seed of everything random.
    pub seed: u64,
}

fn default_template_weight() -> f64 {
    SelectOptions::default().template_weight
}

fn default_dimensions() -> usize {
    SelectOptions::default().dimensions
}

fn default_restarts() -> usize {
    SelectOptions::default().restarts
}

impl Default for Options {
    fn default() -> Self {
        Self {
            records: RecordSource::Sample,
            dedupe: None,
            filter: None,
            mapping: None,
            profile: "paper".into(),
            budget: 20,
            strategy: Strategy::Stratified,
            weighting: Weighting::default(),
            template_weight: default_template_weight(),
            dimensions: default_dimensions(),
            restarts: default_restarts(),
            embedding: EmbeddingKind::default(),
            model_dir: None,
            cast: Cast::default(),
            simulator: SimulatorKind::Native,
            ego: None,
            tune_budget: 160,
            searcher: "cma".into(),
            seed: 1,
        }
    }
}

impl Options {
    /// The command that makes the suite, without the output folder.
    pub fn command(&self) -> String {
        let default = Self::default();
        let mut words = vec!["recrash run".to_owned()];
        if let RecordSource::Files(files) = &self.records {
            words.extend(files.iter().map(|f| format!("--records {}", quoted(&f.to_string_lossy()))));
        }
        let mut option = |name: &str, value: String, default: String| {
            if value != default {
                words.push(format!("--{name} {}", quoted(&value)));
            }
        };
        let mapping = self.mapping.as_ref().map(|file| file.to_string_lossy().into_owned());
        option("mapping", mapping.unwrap_or_default(), String::new());
        option("dedupe", self.dedupe.map(dedupe_name).unwrap_or_default(), String::new());
        option("where", self.filter.clone().unwrap_or_default(), String::new());
        option("profile", self.profile.clone(), default.profile);
        option("budget", self.budget.to_string(), default.budget.to_string());
        option("strategy", self.strategy.name().into(), default.strategy.name().into());
        option("weighting", self.weighting.name().into(), default.weighting.name().into());
        option("template-weight", self.template_weight.to_string(), default.template_weight.to_string());
        option("dimensions", self.dimensions.to_string(), default.dimensions.to_string());
        option("restarts", self.restarts.to_string(), default.restarts.to_string());
        option("embedding", self.embedding.name().into(), default.embedding.name().into());
        let model_dir = self.model_dir.as_ref().map(|dir| dir.to_string_lossy().into_owned());
        option("model-dir", model_dir.unwrap_or_default(), String::new());
        option("paraphrase", self.cast.paraphrase.clone(), default.cast.paraphrase);
        option("design", self.cast.design.clone(), default.cast.design);
        option("tune", self.cast.tune.clone(), default.cast.tune);
        option("rounds", self.cast.rounds.to_string(), default.cast.rounds.to_string());
        option("repairs", self.cast.repairs.to_string(), default.cast.repairs.to_string());
        option("sim", self.simulator.name().into(), default.simulator.name().into());
        option("ego", self.ego.clone().unwrap_or_default(), String::new());
        option("tune-budget", self.tune_budget.to_string(), default.tune_budget.to_string());
        option("searcher", self.searcher.clone(), default.searcher);
        option("seed", self.seed.to_string(), default.seed.to_string());
        words.join(" ")
    }

    /// The profile, with what the options change in it.
    ///
    /// # Errors
    /// There is no such profile, or the file is none.
    pub(crate) fn system_profile(&self) -> Result<SystemProfile, PipelineError> {
        let mut profile = load_profile(&self.profile)?;
        profile.records.dedupe = self.dedupe.unwrap_or(profile.records.dedupe);
        Ok(profile)
    }
}

fn dedupe_name(dedupe: Dedupe) -> String {
    serde_json::to_value(dedupe).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
}

pub(crate) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

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
    /// Scenarios to rollouts, metrics and verdicts.
    Simulate,
    /// Scenarios to tuned scenarios.
    Tune,
    /// All of it to a page.
    Report,
}

impl Stage {
    /// Every stage, in order.
    pub const ALL: [Self; 7] =
        [Self::Records, Self::Select, Self::Narrate, Self::Design, Self::Simulate, Self::Tune, Self::Report];

    /// Name of the stage and of its subcommand.
    pub fn name(self) -> &'static str {
        match self {
            Self::Records => "records",
            Self::Select => "select",
            Self::Narrate => "narrate",
            Self::Design => "design",
            Self::Simulate => "simulate",
            Self::Tune => "tune",
            Self::Report => "report",
        }
    }
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct State {
    format: String,
    version: String,
    options: Options,
    units: BTreeMap<String, Unit>,
}

/// A finished unit of work: the hash of what went in, and the files that came out with theirs.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Unit {
    inputs: String,
    outputs: BTreeMap<String, String>,
}

/// Files of a unit: name and content.
pub(crate) type Files = Vec<(String, Vec<u8>)>;

/// A suite on disk.
pub struct Suite {
    store: Store,
    profile: SystemProfile,
    state: Mutex<State>,
    options: Options,
    threads: rayon::ThreadPool,
    /// As many threads as questions may be under way; absent where nobody is asked over the network.
    askers: Option<rayon::ThreadPool>,
    python: PathBuf,
    patience: Patience,
    models: Option<Models>,
    remarks: Vec<Diagnostic>,
    /// Keeps others from working in the folder at the same time.
    _lock: Option<File>,
}

/// What a run may use of the machine. No byte of the results depends on it.
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
}

impl Default for Resources {
    fn default() -> Self {
        let python = "python3".into();
        Self { threads: None, python, patience: Patience::default(), models: ModelAccess::default() }
    }
}

impl Suite {
    /// The options of the suite in a folder; `None` where there is no suite in it.
    ///
    /// # Errors
    /// The suite file is damaged.
    pub fn saved_options(dir: &Path) -> Result<Option<Options>, PipelineError> {
        if !dir.join(SUITE_FILE).exists() {
            return Ok(None);
        }
        Ok(Some(read_state(&Store::at(dir))?.options))
    }

    /// Opens the suite in a folder, or makes one.
    ///
    /// # Errors
    /// The folder cannot be used, holds something else, or the options name no profile.
    pub fn open(dir: &Path, options: Options, resources: Resources) -> Result<Self, PipelineError> {
        Self::open_with(dir, options, resources, write_file_whole)
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
        paths::must_be_text(&options)?;
        recording::read_filter(&options)?;
        let store = Store::create(dir, write_file)?;
        let lock = lock_folder(dir)?;
        let units = if dir.join(SUITE_FILE).exists() {
            read_state(&store)?.units
        } else if is_empty(&store)? {
            BTreeMap::new()
        } else {
            return Err(PipelineError::NotASuite { dir: dir.to_owned() });
        };
        store.remove_leftovers()?;
        let suite = Self::set_up(store, options, resources, units, lock)?;
        suite.save(&suite.lock())?;
        Ok(suite)
    }

    /// Opens a suite to read what is in it: nothing is written, and others may work in it.
    ///
    /// # Errors
    /// There is no suite in the folder, or its file is damaged.
    pub(crate) fn look(dir: &Path) -> Result<Self, PipelineError> {
        let store = Store::at(dir);
        let State { options, units, .. } = read_state(&store)?;
        Self::set_up(store, options, Resources::default(), units, None)
    }

    fn set_up(
        store: Store,
        options: Options,
        resources: Resources,
        units: BTreeMap<String, Unit>,
        lock: Option<File>,
    ) -> Result<Self, PipelineError> {
        let profile = options.system_profile()?;
        let threads = thread_pool(resources.threads.unwrap_or(0))?;
        let state = State {
            format: SUITE_FORMAT.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            options: options.clone(),
            units,
        };
        let has_model = !options.cast.models().is_empty();
        let opened = has_model.then(|| Models::open(&store, &options.cast, &resources.models)).transpose()?;
        let (models, remarks) = opened.map_or((None, Vec::new()), |(models, remarks)| (Some(models), remarks));
        let asks = has_model && resources.models.mode == AnswerMode::Live;
        let askers = asks.then(|| thread_pool(resources.models.concurrency)).transpose()?;
        let (state, python, patience) = (Mutex::new(state), resources.python, resources.patience);
        Ok(Self { store, profile, state, options, threads, askers, python, patience, models, remarks, _lock: lock })
    }

    /// Runs one stage; the stages before must be finished.
    ///
    /// # Errors
    /// A stage before is missing, the input is bad, or a file cannot be read or written. Finished units stay.
    pub fn run_stage(&self, stage: Stage, progress: &dyn Progress) -> Result<StageReport, PipelineError> {
        let cast = &self.options.cast;
        let by_model = match stage {
            Stage::Narrate => cast.paraphrase != RULES,
            Stage::Design => cast.design != RULES,
            Stage::Tune => cast.tune != RULES,
            Stage::Records | Stage::Select | Stage::Simulate | Stage::Report => false,
        };
        match self.askers.as_ref().filter(|_| by_model) {
            Some(askers) => askers.install(|| stages::run(self, stage, progress)),
            None => self.in_pool(|| stages::run(self, stage, progress)),
        }
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

    /// The suite's folder.
    pub fn store(&self) -> &Store {
        &self.store
    }

    /// The simulator with the ego in it.
    pub(crate) fn simulator(&self) -> Result<Box<dyn Simulator>, PipelineError> {
        let workers = self.threads.current_num_threads();
        start_simulator(self.options.simulator, self.ego(), &self.python, workers, self.patience)
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

    /// Does a unit of work, unless it is done: the same inputs gave files that are still there. Gives whether it was
    /// skipped. A failure is tried again.
    pub(crate) fn unit(
        &self,
        name: &str,
        inputs: &[&[u8]],
        work: impl FnOnce() -> Result<Files, PipelineError>,
    ) -> Result<bool, PipelineError> {
        let inputs = hash_all(inputs);
        let before = self.lock().units.get(name).cloned();
        if let Some(unit) = &before
            && unit.inputs == inputs
            && !unit.outputs.keys().any(|file| file.ends_with(FAILURE))
            && unit.outputs.iter().all(|(file, hash)| self.store.hash(file).as_ref() == Some(hash))
        {
            return Ok(true);
        }
        let mut outputs = BTreeMap::new();
        for (file, content) in work()? {
            let hash = self.store.write(&file, &content)?;
            outputs.insert(file, hash);
        }
        for stale in before.iter().flat_map(|unit| unit.outputs.keys()).filter(|file| !outputs.contains_key(*file)) {
            self.store.remove(stale)?;
        }
        let mut state = self.lock();
        state.units.insert(name.to_owned(), Unit { inputs, outputs });
        self.save(&state)?;
        Ok(false)
    }

    /// Forgets the units of a stage that are not among `names`, and removes their files.
    pub(crate) fn keep_only(&self, stage: Stage, names: &[String]) -> Result<(), PipelineError> {
        let mut state = self.lock();
        let prefix = format!("{}/", stage.name());
        let stale: Vec<String> =
            state.units.keys().filter(|unit| unit.starts_with(&prefix) && !names.contains(unit)).cloned().collect();
        for name in &stale {
            let unit = state.units.remove(name);
            for file in unit.iter().flat_map(|unit| unit.outputs.keys()) {
                self.store.remove(file)?;
            }
        }
        if !stale.is_empty() {
            self.save(&state)?;
        }
        Ok(())
    }

    /// Hash of a file that a finished unit wrote, as it is now: a person may have edited it.
    pub(crate) fn output_hash(&self, stage: Stage, unit: &str, file: &str) -> Result<String, PipelineError> {
        let finished = self.lock().units.get(unit).is_some_and(|u| u.outputs.contains_key(file));
        let hash = finished.then(|| self.store.hash(file)).flatten();
        hash.ok_or_else(|| PipelineError::MissingStage { dir: self.store.dir().to_owned(), missing: stage.name() })
    }

    /// Refuses a unit that was made of something else.
    pub(crate) fn must_be_made_of(&self, stage: Stage, unit: &str, inputs: &[String]) -> Result<(), PipelineError> {
        let inputs: Vec<&[u8]> = inputs.iter().map(String::as_bytes).collect();
        match self.lock().units.get(unit) {
            None => Err(PipelineError::MissingStage { dir: self.store.dir().to_owned(), missing: stage.name() }),
            Some(made) if made.inputs != hash_all(&inputs) => Err(self.stale(stage)),
            Some(_) => Ok(()),
        }
    }

    /// What a stage made is not of the options and files as they are now.
    pub(crate) fn stale(&self, stage: Stage) -> PipelineError {
        PipelineError::StaleStage { dir: self.store.dir().to_owned(), stage: stage.name() }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn save(&self, state: &State) -> Result<(), PipelineError> {
        self.store.write(SUITE_FILE, &to_json(state)).map(drop)
    }
}

fn thread_pool(threads: usize) -> Result<rayon::ThreadPool, PipelineError> {
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

fn read_state(store: &Store) -> Result<State, PipelineError> {
    let unusable = |problem: String| {
        PipelineError::bad_input(format!(
            "{}: {problem}; nothing can go on in this folder: choose another --out (with a copy of ledger/ in it, answers \
             of models are kept)",
            store.path(SUITE_FILE).display()
        ))
    };
    let state: State = store.read_json(SUITE_FILE).map_err(|error| match error {
        PipelineError::Damaged { problem, .. } => unusable(problem),
        other => other,
    })?;
    if state.format != SUITE_FORMAT {
        return Err(unusable(format!("format is \"{}\"; this version reads \"{SUITE_FORMAT}\"", state.format)));
    }
    Ok(state)
}

fn is_empty(store: &Store) -> Result<bool, PipelineError> {
    store.remove_leftovers()?;
    let mut entries = std::fs::read_dir(store.dir()).map_err(|source| PipelineError::Io {
        action: "read",
        path: store.dir().to_owned(),
        source,
    })?;
    Ok(entries.next().is_none())
}

/// One hash of several inputs and of the code of this program.
fn hash_all(inputs: &[&[u8]]) -> String {
    let mut all = concat!(env!("CARGO_PKG_VERSION"), " ", env!("RECRASH_CODE")).as_bytes().to_vec();
    for input in inputs {
        all.extend((input.len() as u64).to_le_bytes());
        all.extend_from_slice(input);
    }
    sha256(&all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_names_what_differs_from_the_defaults_and_quotes_it() {
        assert_eq!(Options::default().command(), "recrash run");
        let options = Options {
            records: RecordSource::Files(vec!["my file.csv".into()]),
            dedupe: Some(Dedupe::Incident),
            filter: Some("road = street".into()),
            budget: 5,
            strategy: Strategy::Kmeans,
            ..Options::default()
        };
        assert_eq!(
            options.command(),
            "recrash run --records 'my file.csv' --dedupe incident --where 'road = street' --budget 5 --strategy kmeans"
        );
    }
}
