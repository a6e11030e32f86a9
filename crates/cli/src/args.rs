//! What may be typed.

use clap::{Args, Parser, Subcommand};
use recrash_model::selection::Strategy;
use recrash_pipeline::{AnswerMode, Cast, Format, Options, RecordSource, Resources, SimulatorKind};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash run                                            the built-in sample, everything else by default, into suite/
  recrash run --records SGO-2021-01_Incident_Reports_ADS.csv --profile paper --out paper-suite
  recrash simulate suite/6-tuned/01-intersection-straight-straight.json --ego idm
  recrash export suite --to openscenario,scenic          the suite for other tools, in suite/exports/
  recrash records SGO-2021-01_Incident_Reports_ADS.csv   what is in a crash file, and what of it can be used

Exit codes: 0 done; 1 a file could not be read or written; 2 wrong usage; 3 the input cannot be used;
  4 questions wait for a batch";

/// Turns real crash records of automated vehicles into a simulation test suite for one system under test.
#[derive(Debug, Parser)]
#[command(name = "recrash", version, about, after_help = EXAMPLES, max_term_width = 110)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Print results as JSON on standard output.
    #[arg(long, global = true)]
    pub json: bool,
    /// Print errors only.
    #[arg(long, short, global = true)]
    pub quiet: bool,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Do everything: read, select, narrate, design, simulate, tune, report.
    Run(SuiteArgs),
    /// Stage 1: read crash files, and show what of them can be used.
    Records(RecordsArgs),
    /// Stage 2: choose a few records that stand for all.
    Select(SuiteArgs),
    /// Stage 3: paraphrase the narratives of the picks.
    Narrate(SuiteArgs),
    /// Stage 4: design a scenario for each narrative, checked by running it.
    Design(SuiteArgs),
    /// Stage 5: run the scenarios of a suite; or run one scenario file and show its metrics.
    Simulate(SimulateArgs),
    /// Stage 6: search each scenario's parameters for the nearest failure that is still true to the record.
    Tune(SuiteArgs),
    /// Stage 7: write report.html, junit.xml and results.csv.
    Report(SuiteArgs),
    /// Write the scenarios of a suite, or one scenario file, in the formats of other tools.
    Export(ExportArgs),
    /// Print the JSON Schema of scenario files.
    Schema,
}

/// Options of a suite. A stage on its own takes what is not given from the suite it works on.
#[derive(Debug, Clone, Default, Args)]
pub struct SuiteArgs {
    /// Folder of the suite; finished work in it is kept.
    #[arg(long, short, value_name = "DIR", default_value = "suite")]
    pub out: PathBuf,
    /// SGO crash file (CSV); may be given several times. [default: the built-in sample]
    #[arg(long, value_name = "FILE")]
    pub records: Vec<PathBuf>,
    /// System profile: a built-in name or a TOML file. [default: paper]
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// Scenarios to make. [default: 20]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=2000))]
    pub budget: Option<u16>,
    /// How the picks are chosen: stratified, or kmeans as in the paper. [default: stratified]
    #[arg(long, value_name = "NAME", value_parser = strategy)]
    pub strategy: Option<Strategy>,
    /// Who paraphrases, designs and tunes: rules, or a language model by name (see --llm). [default: rules]
    #[arg(long, value_name = "rules|MODEL")]
    pub agent: Option<String>,
    /// Who paraphrases. [default: as --agent]
    #[arg(long, value_name = "rules|MODEL")]
    pub paraphrase: Option<String>,
    /// Who designs. [default: as --agent]
    #[arg(long, value_name = "rules|MODEL")]
    pub design: Option<String>,
    /// Who tunes; rules is the search. [default: as --agent]
    #[arg(long, value_name = "rules|MODEL")]
    pub tune: Option<String>,
    /// Rounds of a model that tunes. [default: 3]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=50))]
    pub rounds: Option<u16>,
    /// How a model is asked: batch writes requests.jsonl in OpenAI's Batch form, stops, and goes on when responses.jsonl
    /// lies beside it; replay takes answers from the suite's ledger alone.
    #[arg(long, value_name = "MODE", value_parser = ["batch", "replay"], default_value = "batch")]
    pub llm: String,
    /// Folder with the files of all-MiniLM-L6-v2, to embed narratives with. [default: a lexical embedding]
    #[arg(long, value_name = "DIR")]
    pub model_dir: Option<PathBuf>,
    /// Simulator: native, or metadrive (needs Python with metadrive-simulator 0.4.3). [default: native]
    #[arg(long, value_name = "NAME")]
    pub sim: Option<SimulatorKind>,
    /// Python interpreter for MetaDrive.
    #[arg(long, value_name = "FILE", env = "RECRASH_PYTHON", default_value = "python3")]
    pub python: PathBuf,
    /// System under test: metadrive-idm, idm. [default: the profile's]
    #[arg(long, value_name = "NAME")]
    pub ego: Option<String>,
    /// Points the search of each scenario may score; 1 turns tuning off. [default: 160]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub tune_budget: Option<u32>,
    /// Optimiser of the search: cma, halton. [default: cma]
    #[arg(long, value_name = "NAME")]
    pub searcher: Option<String>,
    /// Seed of everything random. [default: 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Worker threads; the results do not depend on it. [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// Options of `records`.
#[derive(Debug, Clone, Args)]
pub struct RecordsArgs {
    /// SGO crash files (CSV), as with --records. [default: the built-in sample]
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Options of the suite.
    #[command(flatten)]
    pub suite: SuiteArgs,
}

/// Options of `export`.
#[derive(Debug, Clone, Args)]
pub struct ExportArgs {
    /// Folder of a suite, or a scenario file (JSON).
    #[arg(value_name = "SUITE|SCENARIO")]
    pub source: PathBuf,
    /// Formats, separated by commas: openscenario (with OpenDRIVE), scenic, metadrive, commonroad.
    #[arg(long, value_name = "FORMATS", value_delimiter = ',', required = true)]
    pub to: Vec<Format>,
    /// How partners move: by their policies as actions, or on the trajectory that was recorded.
    #[arg(long = "as", value_name = "HOW", value_parser = ["actions", "trajectory"], default_value = "actions")]
    pub partners_as: String,
    /// Target folder; each format gets a folder in it. [default: exports, in the suite or beside the file]
    #[arg(long, value_name = "DIR")]
    pub to_dir: Option<PathBuf>,
    /// Overwrite files that are there already.
    #[arg(long)]
    pub force: bool,
}

/// Options of `simulate`.
#[derive(Debug, Clone, Args)]
pub struct SimulateArgs {
    /// One scenario file (JSON); without it, the scenarios of the suite are run.
    #[arg(value_name = "SCENARIO")]
    pub scenario: Option<PathBuf>,
    /// Where to write the rollout of the one scenario (JSON).
    #[arg(long, value_name = "FILE", requires = "scenario")]
    pub rollout: Option<PathBuf>,
    /// Options of the suite.
    #[command(flatten)]
    pub suite: SuiteArgs,
}

impl SuiteArgs {
    /// What was typed, over `base`.
    pub fn options(&self, base: Options) -> Options {
        Options {
            records: if self.records.is_empty() { base.records } else { RecordSource::Files(self.records.clone()) },
            profile: self.profile.clone().unwrap_or(base.profile),
            budget: self.budget.map_or(base.budget, usize::from),
            strategy: self.strategy.unwrap_or(base.strategy),
            model_dir: self.model_dir.clone().or(base.model_dir),
            cast: self.cast(base.cast),
            simulator: self.sim.unwrap_or(base.simulator),
            ego: self.ego.clone().or(base.ego),
            tune_budget: self.tune_budget.map_or(base.tune_budget, |n| n as usize),
            searcher: self.searcher.clone().unwrap_or(base.searcher),
            seed: self.seed.unwrap_or(base.seed),
        }
    }
}

impl SuiteArgs {
    fn cast(&self, base: Cast) -> Cast {
        let role = |own: &Option<String>, base: String| own.clone().or_else(|| self.agent.clone()).unwrap_or(base);
        Cast {
            paraphrase: role(&self.paraphrase, base.paraphrase),
            design: role(&self.design, base.design),
            tune: role(&self.tune, base.tune),
            rounds: self.rounds.map_or(base.rounds, usize::from),
        }
    }

    /// What may be used of the machine.
    pub fn resources(&self) -> Resources {
        let answers = if self.llm == "replay" { AnswerMode::Replay } else { AnswerMode::Batch };
        Resources { threads: self.threads.map(usize::from), python: self.python.clone(), answers }
    }
}

fn strategy(name: &str) -> Result<Strategy, String> {
    serde_json::from_value(serde_json::Value::String(name.to_owned())).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn what_is_typed_wins_over_what_was_saved() {
        let saved = Options { budget: 7, seed: 9, ..Options::default() };
        let typed = SuiteArgs { seed: Some(3), ..SuiteArgs::default() };
        let options = typed.options(saved);
        assert_eq!((options.budget, options.seed), (7, 3));
    }

    #[test]
    fn a_wrong_strategy_lists_the_right_ones() {
        assert!(strategy("k-means").unwrap_err().contains("kmeans"));
    }
}
