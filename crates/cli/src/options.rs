//! Options that several commands share.

use crate::model_options::ModelArgs;
use clap::Args;
use recrash_model::comparison::Change;
use recrash_model::profile::Dedupe;
use recrash_model::selection::{Strategy, Weighting};
use recrash_model::tuning::Aim;
use recrash_pipeline::{
    EmbeddingKind, FILTER_HELP, MayAsk, Options, Patience, Permissions, PipelineError, RecordSource, Resources,
    SimulatorKind, Suite,
};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Where crash records come from.
#[derive(Debug, Clone, Default, Args)]
pub struct SourceArgs {
    /// SGO crash file (CSV), or the name of a downloaded one; may be given several times. [default: the built-in sample]
    #[arg(long, value_name = "FILE")]
    pub records: Vec<PathBuf>,
    /// Mapping file (TOML): the crash files are those of another database.
    #[arg(long, value_name = "FILE")]
    pub mapping: Option<PathBuf>,
    /// Which reports of one incident are merged: none, or incident (one incident, one record). [default: the profile's]
    #[arg(long, value_name = "NAME", value_parser = dedupe)]
    pub dedupe: Option<Dedupe>,
    /// Keep the records of which this is true, such as 'road = intersection and year >= 2024'; --help tells more.
    #[arg(long = "where", value_name = "EXPR", long_help = FILTER_HELP)]
    pub filter: Option<String>,
}

/// Names the profile where neither an option nor a suite does.
const PROFILE_VARIABLE: &str = "RECRASH_PROFILE";

/// The options of who types none.
pub fn defaults() -> Options {
    let base = Options::default();
    Options { profile: std::env::var(PROFILE_VARIABLE).unwrap_or(base.profile), ..base }
}

/// How many scenarios are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Budget {
    /// As many as can be told.
    All,
    /// No more than this.
    AtMost(usize),
}

fn budget(text: &str) -> Result<Budget, String> {
    match text.parse() {
        _ if text == "all" => Ok(Budget::All),
        Ok(number) if (1..=20_000).contains(&number) => Ok(Budget::AtMost(number)),
        _ => Err("it must be a number from 1 to 20000, or all".to_owned()),
    }
}

/// How records are chosen.
#[derive(Debug, Clone, Default, Args)]
pub struct ChoiceArgs {
    /// Scenarios to make, 1 to 20000, or all: one for every crash that can be told. [default: 20]
    #[arg(long, help_heading = "Selection", value_name = "N|all", value_parser = budget)]
    pub budget: Option<Budget>,
    /// Also invent a crash for every template of the profile that no record is of; with a profile that goes by templates.
    #[arg(long, help_heading = "Selection")]
    pub invent: bool,
    /// How the picks are chosen: stratified (every template first), kmeans (the paper's), k-center (no record far from
    /// its pick) or facility-location (near on average). [default: stratified]
    #[arg(long, help_heading = "Selection", value_name = "NAME", value_parser = strategy)]
    pub strategy: Option<Strategy>,
    /// How much a record counts: frequency (each one), severity (by the worst injury) or template (each kind of crash
    /// the same). [default: frequency]
    #[arg(long, help_heading = "Selection", value_name = "NAME", value_parser = weighting)]
    pub weighting: Option<Weighting>,
    /// Weight of the template against the narrative in the clusters; stratified needs none. [default: 1, as in the paper]
    #[arg(long, help_heading = "Selection", value_name = "X")]
    pub template_weight: Option<f64>,
    /// Principal components of the narratives' embedding that count. [default: 6, as in the paper]
    #[arg(long, help_heading = "Selection", value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub dimensions: Option<u16>,
    /// Runs of k-means, of which the best is kept. [default: 20]
    #[arg(long, help_heading = "Selection", value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub restarts: Option<u16>,
    /// Embedding of the narratives: auto (MiniLM where its files are on this machine, see recrash model), lexical or
    /// minilm. [default: auto]
    #[arg(long, help_heading = "Selection", value_name = "NAME", value_parser = embedding, env = "RECRASH_EMBEDDING")]
    pub embedding: Option<EmbeddingKind>,
    /// Folder with the files of all-MiniLM-L6-v2. [default: looked for]
    #[arg(long, help_heading = "Selection", value_name = "DIR")]
    pub model_dir: Option<PathBuf>,
}

/// The folder of a suite where none is named.
const DEFAULT_FOLDER: &str = "suite";

/// Options of a stage on its own.
#[derive(Debug, Clone, Args)]
pub struct StageArgs {
    /// Folder of the suite, as with --out.
    #[arg(value_name = "SUITE", conflicts_with = "out")]
    folder: Option<PathBuf>,
    #[command(flatten)]
    suite: SuiteArgs,
}

impl StageArgs {
    /// The suite and its options.
    pub fn suite(&self) -> SuiteArgs {
        let out = self.folder.as_ref().unwrap_or(&self.suite.out).clone();
        SuiteArgs { out, ..self.suite.clone() }
    }
}

/// Options of a suite. A stage on its own takes what is not given from the suite it works on.
#[derive(Debug, Clone, Default, Args)]
pub struct SuiteArgs {
    /// Folder of the suite; finished work in it is kept.
    #[arg(long, short, value_name = "DIR", default_value = DEFAULT_FOLDER)]
    pub out: PathBuf,
    /// Where crash records come from.
    #[command(flatten)]
    pub source: SourceArgs,
    /// System profile: open (every crash that can be told, by its incident's account), paper (the published method: templates),
    /// or a TOML file. [default: open, or what the variable RECRASH_PROFILE names]
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// How records are chosen.
    #[command(flatten)]
    pub choice: ChoiceArgs,
    /// Simulator: native, or metadrive (needs Python with metadrive-simulator 0.4.3). [default: native]
    #[arg(long, value_name = "NAME")]
    pub sim: Option<SimulatorKind>,
    /// Python interpreter for MetaDrive, and for an ego py:MODULE:NAME.
    #[arg(long, value_name = "FILE", env = "RECRASH_PYTHON", default_value = "python3")]
    pub python: PathBuf,
    /// System under test: metadrive-idm, idm, reference, metadrive-expert (on metadrive), a program of yours as
    /// 'cmd:PROGRAM ARGS', which speaks JSON lines as docs/ego-protocol.md says, or a Python class or function as py:MODULE:NAME (docs/python.md). [default: the profile's]
    #[arg(long, value_name = "NAME|cmd:PROGRAM|py:MODULE:NAME")]
    pub ego: Option<String>,
    /// Seconds such a program may take for an answer; six times that to start.
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u16).range(1..=3600), default_value_t = 10)]
    pub ego_timeout: u16,
    /// Points the search of each scenario may score; 1 turns tuning off. [default: 160]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub tune_budget: Option<u32>,
    /// Optimiser of the search: cma, halton. [default: cma]
    #[arg(long, value_name = "NAME")]
    pub searcher: Option<String>,
    /// What the search looks for: failure (the nearest one) or severity (the contact with the greatest change of velocity).
    /// [default: failure]
    #[arg(long, value_name = "NAME", value_parser = aim)]
    pub aim: Option<Aim>,
    /// Seed of everything random. [default: 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Make this suite in the place of one of other records or of another profile; its results are lost.
    #[arg(long, help_heading = "What is there already")]
    pub replace: bool,
    /// Make anew what was edited by hand; without it, edited files are kept and the stages after them go on from there.
    #[arg(long, help_heading = "What is there already")]
    pub discard_edits: bool,
    /// Choose the picks anew; without it, those of the last choice stay when records come in, as long as their own can be told.
    #[arg(long, help_heading = "What is there already")]
    pub reselect: bool,
    /// Start the program that the suite names as its ego, and ask the language models it names; without it, only those named here.
    #[arg(long, help_heading = "What is there already")]
    pub trust: bool,
    /// Worker threads; the results do not depend on it. [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Agents and models.
    #[command(flatten)]
    pub models: ModelArgs,
}

/// Who drives, and in which simulator.
#[derive(Debug, Clone, Args)]
pub struct EgoArgs {
    /// System under test: metadrive-idm, idm, reference, or a program of yours as 'cmd:PROGRAM ARGS', which speaks JSON
    /// lines as docs/ego-protocol.md says. [default: the profile's]
    #[arg(long, value_name = "NAME|cmd:PROGRAM")]
    pub ego: Option<String>,
    /// Seconds such a program may take for an answer; six times that to start.
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u16).range(1..=3600), default_value_t = 10)]
    pub ego_timeout: u16,
    /// Simulator: native, or metadrive (needs Python with metadrive-simulator 0.4.3). [default: native]
    #[arg(long, value_name = "NAME")]
    pub sim: Option<SimulatorKind>,
    /// Python interpreter for MetaDrive, and for an ego py:MODULE:NAME.
    #[arg(long, value_name = "FILE", env = "RECRASH_PYTHON", default_value = "python3")]
    pub python: PathBuf,
    /// Worker threads; the results do not depend on it. [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

impl EgoArgs {
    /// How long a program that is the ego is waited for.
    pub fn patience(&self) -> Patience {
        patience(self.ego_timeout)
    }
}

/// How long a program is waited for that may take so long for an answer. [s]
pub fn patience(answer_s: u16) -> Patience {
    let answer = Duration::from_secs(u64::from(answer_s));
    Patience { start: 6 * answer, answer }
}

/// A change of a test by its name.
///
/// # Errors
/// There is no such change.
pub fn one_change(name: &str) -> Result<Change, String> {
    name.parse()
}

impl SourceArgs {
    /// What was typed, over `base`.
    pub fn over(&self, base: Options) -> Options {
        Options {
            records: if self.records.is_empty() { base.records } else { RecordSource::Files(self.records.clone()) },
            dedupe: self.dedupe.or(base.dedupe),
            // An empty filter takes a saved one away.
            filter: self.filter.clone().or(base.filter).filter(|text| !text.trim().is_empty()),
            mapping: self.mapping.clone().or(base.mapping),
            ..base
        }
    }

    /// Whether anything was typed.
    pub fn is_given(&self) -> bool {
        !self.records.is_empty() || self.dedupe.is_some() || self.filter.is_some() || self.mapping.is_some()
    }
}

impl ChoiceArgs {
    /// What was typed, over `base`.
    pub fn over(&self, base: Options) -> Options {
        Options {
            budget: match self.budget {
                None => base.budget,
                Some(Budget::All) => None,
                Some(Budget::AtMost(budget)) => Some(budget),
            },
            invent: self.invent || base.invent,
            strategy: self.strategy.unwrap_or(base.strategy),
            weighting: self.weighting.unwrap_or(base.weighting),
            template_weight: self.template_weight.unwrap_or(base.template_weight),
            dimensions: self.dimensions.map_or(base.dimensions, usize::from),
            restarts: self.restarts.map_or(base.restarts, usize::from),
            embedding: self.embedding.unwrap_or(base.embedding),
            model_dir: self.model_dir.clone().or(base.model_dir),
            ..base
        }
    }
}

impl SuiteArgs {
    /// The suite a stage works on, with what was typed over `base`.
    ///
    /// # Errors
    /// The folder cannot be used, or an option names what there is not.
    pub fn open(&self, base: Options) -> Result<Suite, PipelineError> {
        Suite::open(&self.out, self.options(base), self.resources())
    }

    /// The suite a stage works on, with what was typed over what is saved there; begun where there is none.
    ///
    /// # Errors
    /// As [`SuiteArgs::open`].
    pub fn open_or_begin(&self) -> Result<Suite, PipelineError> {
        self.open(Suite::saved_options(&self.out)?.unwrap_or_else(defaults))
    }

    /// The suite a stage works on, with what was typed over what is saved there.
    ///
    /// # Errors
    /// As [`SuiteArgs::open`], or there is no suite: a mistyped folder is not made.
    pub fn open_saved(&self) -> Result<Suite, PipelineError> {
        let saved = Suite::saved_options(&self.out)?;
        self.open(saved.ok_or_else(|| PipelineError::NoSuite { dir: self.out.clone() })?)
    }

    /// What was typed, over `base`.
    pub fn options(&self, base: Options) -> Options {
        let base = self.choice.over(self.source.over(base));
        Options {
            profile: self.profile.clone().unwrap_or(base.profile),
            cast: self.models.cast(base.cast),
            simulator: self.sim.unwrap_or(base.simulator),
            ego: self.ego.clone().or(base.ego),
            tune_budget: self.tune_budget.map_or(base.tune_budget, |n| n as usize),
            searcher: self.searcher.clone().unwrap_or(base.searcher),
            aim: self.aim.unwrap_or(base.aim),
            seed: self.seed.unwrap_or(base.seed),
            ..base
        }
    }

    /// Whether anything was typed that says nothing about one scenario file, and is not as when nothing is; a variable of the environment was
    /// not typed.
    pub fn is_about_a_suite(&self) -> bool {
        let none = Options::default();
        let typed = self.options(none.clone());
        let of_a_file = Options {
            profile: typed.profile.clone(),
            ego: typed.ego.clone(),
            simulator: typed.simulator,
            embedding: typed.embedding,
            ..none
        };
        let Permissions { replace, discard_edits, reselect, .. } = self.permissions();
        typed != of_a_file || replace || discard_edits || reselect || self.names_a_folder()
    }

    /// Whether another folder than the usual one is named.
    pub fn names_a_folder(&self) -> bool {
        self.out != Path::new(DEFAULT_FOLDER)
    }

    /// What may be used of the machine.
    pub fn resources(&self) -> Resources {
        let (threads, python) = (self.threads.map(usize::from), self.python.clone());
        let permissions = self.permissions();
        Resources { threads, python, patience: self.patience(), models: self.models.access.access(), permissions }
    }

    /// What may be done with a suite that is there already.
    pub fn permissions(&self) -> Permissions {
        let Self { replace, discard_edits, reselect, .. } = *self;
        let models = if self.trust { MayAsk::All } else { MayAsk::Named(self.models.named()) };
        Permissions { replace, discard_edits, reselect, trust: self.trust || self.ego.is_some(), models }
    }

    /// How long a program that is the ego is waited for.
    pub fn patience(&self) -> Patience {
        patience(self.ego_timeout)
    }
}

fn dedupe(name: &str) -> Result<Dedupe, String> {
    serde_json::from_value(serde_json::Value::String(name.to_owned())).map_err(|e| e.to_string())
}

fn strategy(name: &str) -> Result<Strategy, String> {
    one_of(&Strategy::ALL, Strategy::name, name)
}

fn aim(name: &str) -> Result<Aim, String> {
    one_of(&Aim::ALL, Aim::name, name)
}

fn weighting(name: &str) -> Result<Weighting, String> {
    one_of(&Weighting::ALL, Weighting::name, name)
}

fn embedding(name: &str) -> Result<EmbeddingKind, String> {
    one_of(&EmbeddingKind::ALL, EmbeddingKind::name, name)
}

/// The value of this name; else the names there are.
fn one_of<T: Copy>(all: &[T], name_of: fn(T) -> &'static str, name: &str) -> Result<T, String> {
    let names = || all.iter().map(|&value| name_of(value)).collect::<Vec<_>>().join(", ");
    all.iter().copied().find(|&value| name_of(value) == name).ok_or_else(|| format!("there are: {}", names()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_typed_wins_over_what_was_saved() {
        let saved = Options { budget: Some(7), seed: 9, dimensions: 4, ..Options::default() };
        let choice = ChoiceArgs { dimensions: Some(5), ..ChoiceArgs::default() };
        let typed = SuiteArgs { seed: Some(3), choice, ..SuiteArgs::default() };
        let options = typed.options(saved);
        assert_eq!((options.budget, options.seed, options.dimensions), (Some(7), 3, 5));
    }

    #[test]
    fn a_wrong_strategy_lists_the_right_ones() {
        assert!(strategy("k-means").unwrap_err().contains("kmeans"));
    }
}
