//! What may be typed.

use clap::{Args, Parser, Subcommand};
use recrash_model::profile::Dedupe;
use recrash_model::selection::Strategy;
use recrash_pipeline::{
    CrashKind, FILTER_HELP, Format, Options, PublishedEdition, RecordSource, Resources, SimulatorKind,
};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash run                                            the built-in sample, everything else by default, into suite/
  recrash run --records SGO-2021-01_Incident_Reports_ADS.csv --profile paper --out paper-suite
  recrash simulate suite/6-tuned/01-intersection-straight-straight.json --ego idm
  recrash export suite --to openscenario,scenic          the suite for other tools, in suite/exports/
  recrash records SGO-2021-01_Incident_Reports_ADS.csv   what is in a crash file, and what of it can be used
  recrash fetch --edition archive                        NHTSA's crash file, for --records sgo-ads-archive.csv

Exit codes: 0 done; 1 a file could not be read or written; 2 wrong usage; 3 the input cannot be used";

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
    /// Download NHTSA's crash file, whole or not at all, for --records.
    Fetch(FetchArgs),
    /// Print the JSON Schema of scenario files.
    Schema,
}

/// Options of a suite. A stage on its own takes what is not given from the suite it works on.
#[derive(Debug, Clone, Default, Args)]
pub struct SuiteArgs {
    /// Folder of the suite; finished work in it is kept.
    #[arg(long, short, value_name = "DIR", default_value = "suite")]
    pub out: PathBuf,
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
    /// System profile: a built-in name or a TOML file. [default: paper]
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// Scenarios to make. [default: 20]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=2000))]
    pub budget: Option<u16>,
    /// How the picks are chosen: stratified, or kmeans as in the paper. [default: stratified]
    #[arg(long, value_name = "NAME", value_parser = strategy)]
    pub strategy: Option<Strategy>,
    /// Who paraphrases and designs: the built-in rules. [default: rules]
    #[arg(long, value_name = "NAME", value_parser = ["rules"])]
    pub agent: Option<String>,
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
    /// Write the usable records as a CSV table.
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write the usable records as a Parquet table.
    #[cfg(feature = "parquet")]
    #[arg(long, value_name = "FILE")]
    pub parquet: Option<PathBuf>,
    /// Write every record that could be read into the tables, with why it was lost.
    #[arg(long)]
    pub all: bool,
    /// Options of the suite.
    #[command(flatten)]
    pub suite: SuiteArgs,
}

/// Options of `fetch`.
#[derive(Debug, Clone, Args)]
pub struct FetchArgs {
    /// Reports since June 2025 (current), or from June 2021 to June 2025 (archive).
    #[arg(long, value_name = "NAME", value_parser = ["current", "archive"], default_value = "current")]
    pub edition: String,
    /// Automated driving (ads), driver assistance of level 2 (adas), or other.
    #[arg(long, value_name = "NAME", value_parser = ["ads", "adas", "other"], default_value = "ads")]
    pub kind: String,
    /// Folder to download from. [default: NHTSA's]
    #[arg(long, value_name = "URL")]
    pub base_url: Option<String>,
    /// Folder to keep the file in. [default: recrash in the platform's folder for caches]
    #[arg(long, value_name = "DIR", env = "RECRASH_CACHE")]
    pub cache: Option<PathBuf>,
}

impl FetchArgs {
    /// Which edition.
    pub fn published(&self) -> PublishedEdition {
        if self.edition == "archive" { PublishedEdition::Archive } else { PublishedEdition::Current }
    }

    /// Which kind.
    pub fn crash_kind(&self) -> CrashKind {
        match self.kind.as_str() {
            "adas" => CrashKind::Adas,
            "other" => CrashKind::Other,
            _ => CrashKind::Ads,
        }
    }
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
            dedupe: self.dedupe.or(base.dedupe),
            // An empty filter takes a saved one away.
            filter: self.filter.clone().or(base.filter).filter(|text| !text.trim().is_empty()),
            mapping: self.mapping.clone().or(base.mapping),
            profile: self.profile.clone().unwrap_or(base.profile),
            budget: self.budget.map_or(base.budget, usize::from),
            strategy: self.strategy.unwrap_or(base.strategy),
            model_dir: self.model_dir.clone().or(base.model_dir),
            simulator: self.sim.unwrap_or(base.simulator),
            ego: self.ego.clone().or(base.ego),
            tune_budget: self.tune_budget.map_or(base.tune_budget, |n| n as usize),
            searcher: self.searcher.clone().unwrap_or(base.searcher),
            seed: self.seed.unwrap_or(base.seed),
        }
    }
}

impl SuiteArgs {
    /// What may be used of the machine.
    pub fn resources(&self) -> Resources {
        Resources { threads: self.threads.map(usize::from), python: self.python.clone() }
    }
}

fn dedupe(name: &str) -> Result<Dedupe, String> {
    serde_json::from_value(serde_json::Value::String(name.to_owned())).map_err(|e| e.to_string())
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
