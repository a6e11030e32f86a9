//! The subcommands: one file each, with what may be typed, what is done and what is shown.

mod assess;
mod bench;
mod bench_embed;
mod bench_sim;
mod check_driver;
mod doctor;
mod eval;
mod evidence;
mod export;
mod failures;
mod fetch;
mod freeze;
mod import;
mod ledger;
mod model;
mod parity;
mod profile;
mod prompt;
mod read;
mod reconstruct;
mod records;
mod retold;
mod run;
mod schema;
mod select;
mod shell;
mod simulate;
mod stage;
#[cfg(feature = "parquet")]
mod sweep;
mod test;

use crate::options::{StageArgs, SuiteArgs};
use crate::output::Output;
use clap::{Parser, Subcommand};
use recrash_pipeline::{PipelineError, Stage};

const EXAMPLES: &str = "\
Examples:
  recrash run                                            the built-in sample, everything else by default, into suite/
  recrash run --records SGO-2021-01_Incident_Reports_ADS.csv --profile paper --out paper-suite
  recrash simulate suite/6-tuned/intersection-straight-straight-90101-80.json --ego idm
  recrash export suite --to openscenario,scenic          the suite for other tools, in suite/exports/
  recrash run --profile paper --agent gpt-5-mini --max-cost 2    a language model in the roles; recrash prompt shows its questions
  recrash records SGO-2021-01_Incident_Reports_ADS.csv   what is in a crash file, and what of it can be used
  recrash fetch --edition archive                        NHTSA's crash file, for --records sgo-ads-archive.csv

Exit codes: 0 done; 1 a file that is there could not be read, or one could not be written; 2 wrong usage;
  3 the input is not there or cannot be used;
  4 the run stopped and the same command goes on: questions wait for a batch, or a cap is reached;
  5 a share or speed that is asked for was missed, or what run, simulate or tune ran is not true to its record,
    or could not be run; 130 interrupted";

const RUN_EXAMPLES: &str = "\
Examples:
  recrash run                                            the built-in sample, into suite/
  recrash run --records archive.csv --records current.csv --budget all --tune-budget 1 --out corpus
                                                         every crash that can be told
  recrash run --records ads.csv --profile paper --out paper-suite
                                                         the published method
  recrash run --where 'road = intersection' --budget 10 --out crossings
  recrash run --ego 'cmd:python3 my_ego.py'              a system of yours
  recrash run --profile paper --agent gpt-5-mini --max-cost 2    a language model in the roles
  recrash run --records ads.csv --review gpt-5-mini --max-cost 2
                                                         a language model reads each replay beside its report

The same command goes on where it was stopped. Exit code 5: a scenario is not true to its record, or could not be run; the results
are written all the same.";
const NARRATE_EXAMPLES: &str = "\
Examples:
  recrash narrate                                        the picks of suite/, by the rules
  recrash narrate mini-suite --paraphrase gpt-5-mini";
const DESIGN_EXAMPLES: &str = "\
Examples:
  recrash design                                         the narratives of suite/, by the rules
  recrash design mini-suite --design gpt-5-mini --repairs 2";
const TUNE_EXAMPLES: &str = "\
Examples:
  recrash tune                                           160 points for each scenario of suite/
  recrash tune paper-suite --searcher halton --tune-budget 500
  recrash tune --aim severity                            the worst contact instead of the nearest failure

Exit code 5: a scenario is not true to its record as tuned, or could not be run; the results are written all the same.";
const REVIEW_EXAMPLES: &str = "\
Examples:
  recrash review suite --review gpt-5-mini               the replays of suite/; then recrash report
  recrash review suite --review nobody                   takes what was found away again";
const REPORT_EXAMPLES: &str = "\
Examples:
  recrash report                                         of the suite in suite/
  recrash report paper-suite --json";
const SCHEMA_EXAMPLES: &str = "\
Examples:
  recrash schema > scenario.schema.json                  for an editor or a validator";

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
    #[command(after_help = RUN_EXAMPLES)]
    Run(SuiteArgs),
    /// Stage 1: read crash files, and show what of them can be used.
    Records(records::RecordsArgs),
    /// Stage 2: choose a few records that stand for all.
    Select(select::SelectArgs),
    /// Stage 3: paraphrase the narratives of the picks.
    #[command(after_help = NARRATE_EXAMPLES)]
    Narrate(StageArgs),
    /// Stage 4: design a scenario for each narrative, checked by running it.
    #[command(after_help = DESIGN_EXAMPLES)]
    Design(StageArgs),
    /// Stage 5: run the scenarios of a suite; or run one scenario file and show its metrics.
    Simulate(simulate::SimulateArgs),
    /// Stage 6: search each scenario's parameters for the nearest failure that is still true to the record.
    #[command(after_help = TUNE_EXAMPLES)]
    Tune(StageArgs),
    /// Stage 6 again for other egos: run the tuned scenarios, and where the system fails, run the other egos too.
    #[command(
        after_help = "Examples:\n  recrash triage                 the tuned scenarios of suite/\n  recrash triage --ego idm       another system under test in the same tuned scenarios"
    )]
    Triage(StageArgs),
    /// Have a language model read each replay beside its report, of a suite that goes by accounts; it changes no scenario.
    #[command(after_help = REVIEW_EXAMPLES)]
    Review(StageArgs),
    /// Stage 7: write report.html, junit.xml and results.csv.
    #[command(after_help = REPORT_EXAMPLES)]
    Report(StageArgs),
    /// Write the scenarios of a suite, or one scenario file, in the formats of other tools.
    Export(export::ExportArgs),
    /// Read a scenario back: OpenSCENARIO that recrash wrote, or the paper's JSON dialect.
    Import(import::ImportArgs),
    /// Read each incident of crash files into an account: what happened, with the words or the column each fact stands in.
    Read(read::ReadArgs),
    /// Each incident of crash files as a scenario that shows its own crash, with the recorded driver
    Reconstruct(reconstruct::ReconstructArgs),
    /// Freeze the scenarios of a suite, or scenario files, into a folder of tests that runs anywhere, without the crash file.
    Freeze(freeze::FreezeArgs),
    /// Run a frozen suite with an ego: what failed, how bad it is, what led to it, and what changed against a baseline.
    Test(test::TestArgs),
    /// Hold two results of frozen suites against each other.
    Compare(test::CompareArgs),
    /// Tell how robust the failures of a frozen suite are: under small changes, and on MetaDrive.
    Robustness(failures::RobustnessArgs),
    /// Strip the failures of a frozen suite to what they need, each with the nearest scenario that passes.
    Minimise(failures::MinimiseArgs),
    /// Say what of all readable crashes a suite covers: by crash type, road and partner, by the matrix of EU 2022/1426, and
    /// by the four dimensions of the UN guidance, with the holes.
    Coverage(assess::CoverageArgs),
    /// Rank a suite's failures by severity, and hold computed severity against what the records report.
    Severity(assess::SeverityArgs),
    /// Write a folder of evidence: claims with numbers, and a checker that works each of them out again.
    Evidence(evidence::EvidenceArgs),
    /// Say how well the reader, the rules or a model read records: accuracy by field against labels of independent readers (language-model agents).
    Eval(eval::EvalArgs),
    /// Show what a language model would be asked, without asking it.
    Prompt(prompt::PromptArgs),
    /// Tell what language models were asked for a suite, what they answered, and what it cost.
    Ledger(ledger::LedgerArgs),
    /// Download NHTSA's crash file, whole or not at all, for --records.
    Fetch(fetch::FetchArgs),
    /// Get or find the files of the embedding model all-MiniLM-L6-v2.
    Model(model::ModelArgs),
    /// Run the same scenarios on both simulators, and tell how far they agree.
    Parity(parity::ParityArgs),
    /// Try drivers in cut-ins, cut-outs and behind braking leaders: those of UN R157, and an ego.
    CheckDriver(check_driver::CheckDriverArgs),
    /// Tell what is installed of all that can be used, and how to get the rest.
    Doctor(doctor::DoctorArgs),
    /// Measure speeds on this machine.
    Bench(bench::BenchArgs),
    /// Run very many rollouts around a scenario or a suite, into a Parquet file.
    #[cfg(feature = "parquet")]
    Sweep(sweep::SweepArgs),
    /// Print the JSON Schema of scenario files.
    #[command(after_help = SCHEMA_EXAMPLES)]
    Schema,
    /// Print a built-in system profile, to write one's own after.
    Profile(profile::ProfileArgs),
    /// Print the completions of a shell.
    Completions(shell::CompletionArgs),
    /// Write the manual pages.
    Man(shell::ManArgs),
}

impl Command {
    /// Whether the same command goes on where it was stopped: what works in a suite, or with a ledger.
    pub fn goes_on(&self) -> bool {
        use Command::{Design, Eval, Narrate, Records, Report, Review, Run, Select, Simulate, Triage, Tune};
        match self {
            Records(args) => args.out.is_some(),
            Simulate(args) => args.scenario.as_ref().is_none_or(|given| given.is_dir()),
            Run(_) | Select(_) | Narrate(_) | Design(_) | Tune(_) | Triage(_) | Review(_) | Report(_) | Eval(_) => true,
            _ => false,
        }
    }
}

/// Runs a subcommand.
///
/// # Errors
/// Why it stopped.
pub fn run(cli: &Cli) -> Result<(), PipelineError> {
    let output = Output { json: cli.json, quiet: cli.quiet };
    match &cli.command {
        Command::Run(args) => run::run(args, output),
        Command::Records(args) => records::run(args, output),
        Command::Select(args) => select::run(args, output),
        Command::Narrate(args) => stage::run(&args.suite(), &[Stage::Narrate], output),
        Command::Design(args) => stage::run(&args.suite(), &[Stage::Design], output),
        Command::Simulate(args) => simulate::run(args, output),
        Command::Tune(args) => stage::run(&args.suite(), &[Stage::Tune, Stage::Triage], output),
        Command::Triage(args) => stage::run(&args.suite(), &[Stage::Triage], output),
        Command::Review(args) => stage::run(&args.suite(), &[Stage::Review], output),
        Command::Report(args) => run::report(args, output),
        Command::Export(args) => export::run(args, output),
        Command::Import(args) => import::run(args, output),
        Command::Read(args) => read::run(args, output),
        Command::Reconstruct(args) => reconstruct::run(args, output),
        Command::Freeze(args) => freeze::run(args, output),
        Command::Test(args) => test::run(args, output),
        Command::Compare(args) => test::compare(args, output),
        Command::Robustness(args) => failures::robustness(args, output),
        Command::Minimise(args) => failures::minimise(args, output),
        Command::Coverage(args) => assess::coverage(args, output),
        Command::Severity(args) => assess::severity(args, output),
        Command::Evidence(args) => evidence::run(args, output),
        Command::Eval(args) => eval::run(args, output),
        Command::Prompt(args) => prompt::run(args, output),
        Command::Ledger(args) => ledger::run(args, output),
        Command::Fetch(args) => fetch::run(args, output),
        Command::Model(args) => model::run(args, output),
        Command::Parity(args) => parity::run(args, output),
        Command::CheckDriver(args) => check_driver::run(args, output),
        Command::Doctor(args) => doctor::run(args, output),
        Command::Bench(args) => bench::run(args, output),
        #[cfg(feature = "parquet")]
        Command::Sweep(args) => sweep::run(args, output),
        Command::Schema => schema::run(),
        Command::Profile(args) => profile::run(args),
        Command::Completions(args) => {
            shell::completions(args);
            Ok(())
        }
        Command::Man(args) => shell::man(args, output),
    }
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
    fn only_what_keeps_something_goes_on() {
        let goes_on = |words: &[&str]| Cli::try_parse_from(words).expect("it is a command").command.goes_on();
        assert!(goes_on(&["recrash", "run"]) && goes_on(&["recrash", "records", "--out", "suite"]));
        assert!(goes_on(&["recrash", "simulate"]));
        for nothing in [&["recrash", "records"][..], &["recrash", "reconstruct"], &["recrash", "simulate", "a.json"]] {
            assert!(!goes_on(nothing), "{nothing:?}");
        }
    }

    #[test]
    fn every_command_has_examples() {
        fn without(command: &clap::Command) -> Vec<String> {
            let told = command.get_after_help().is_some_and(|help| help.to_string().contains("Examples:\n"));
            let own = (!told).then(|| command.get_name().to_owned());
            own.into_iter().chain(command.get_subcommands().flat_map(without)).collect()
        }
        assert_eq!(without(&Cli::command()), [""; 0]);
    }
}
