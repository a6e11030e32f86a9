//! What each subcommand does.

use crate::args::{Cli, Command, ExportArgs, FetchArgs, RecordsArgs, SimulateArgs, SuiteArgs};
use crate::bars::Bars;
use crate::show;
use recrash_model::record::RecordSet;
use recrash_model::selection::Selection;
use recrash_pipeline::{
    ExportRequest, FetchLimits, FetchRequest, FileRequest, NoProgress, Options, PartnersAs, PipelineError, Progress,
    Stage, StageReport, Suite, Summary, TableFormat, TableRows, distributions, schema, simulate_file, write_records,
};
use std::path::PathBuf;

/// Runs a subcommand.
pub fn run(cli: &Cli) -> Result<(), PipelineError> {
    let output = Output { json: cli.json, quiet: cli.quiet };
    match &cli.command {
        Command::Run(args) => run_all(args, output),
        Command::Records(args) => records(args, output),
        Command::Select(args) => select(args, output),
        Command::Narrate(args) => one_stage(args, Stage::Narrate, output),
        Command::Design(args) => one_stage(args, Stage::Design, output),
        Command::Simulate(args) => simulate(args, output),
        Command::Tune(args) => one_stage(args, Stage::Tune, output),
        Command::Report(args) => report(args, output),
        Command::Export(args) => export(args, output),
        Command::Fetch(args) => fetch(args, output),
        Command::Schema => {
            show::json(&schema());
            Ok(())
        }
    }
}

#[derive(Clone, Copy)]
struct Output {
    json: bool,
    quiet: bool,
}

impl Output {
    fn progress(self) -> Box<dyn Progress> {
        if self.quiet || self.json { Box::new(NoProgress) } else { Box::new(Bars::new()) }
    }

    /// Whether to print tables for people.
    fn tables(self) -> bool {
        !self.quiet && !self.json
    }
}

/// The suite a stage works on, with what was typed over what is saved there.
fn open(args: &SuiteArgs, base: Options) -> Result<Suite, PipelineError> {
    Suite::open(&args.out, args.options(base), args.resources())
}

fn open_saved(args: &SuiteArgs) -> Result<Suite, PipelineError> {
    let saved = Suite::saved_options(&args.out)?;
    open(args, saved.unwrap_or_default())
}

fn run_all(args: &SuiteArgs, output: Output) -> Result<(), PipelineError> {
    let suite = open(args, Options::default())?;
    if output.tables() {
        show::heading(&suite);
    }
    let progress = output.progress();
    for stage in Stage::ALL {
        let report = suite.run_stage(stage, &*progress)?;
        if output.tables() {
            show::remarks(&report);
        }
    }
    finish(&suite, output)
}

fn finish(suite: &Suite, output: Output) -> Result<(), PipelineError> {
    let summary: Summary = suite.store().read_json("summary.json")?;
    if output.json {
        show::json(&summary);
    } else if !output.quiet {
        show::summary(&summary, suite.store().dir());
    }
    Ok(())
}

fn report(args: &SuiteArgs, output: Output) -> Result<(), PipelineError> {
    let suite = open_saved(args)?;
    suite.run_stage(Stage::Report, &*output.progress())?;
    finish(&suite, output)
}

fn one_stage(args: &SuiteArgs, stage: Stage, output: Output) -> Result<(), PipelineError> {
    let suite = open_saved(args)?;
    let report = suite.run_stage(stage, &*output.progress())?;
    show_stage(&report, stage, &suite, output);
    Ok(())
}

fn show_stage(report: &StageReport, stage: Stage, suite: &Suite, output: Output) {
    if output.json {
        show::json(&serde_json::json!({ "stage": stage.name(), "done": report.done, "skipped": report.skipped }));
    } else if !output.quiet {
        show::remarks(report);
        show::stage_done(report, stage, suite.store().dir());
    }
}

fn records(args: &RecordsArgs, output: Output) -> Result<(), PipelineError> {
    let mut suite_args = args.suite.clone();
    suite_args.records.extend(args.files.iter().cloned());
    let suite = open_saved(&suite_args)?;
    let report = suite.run_stage(Stage::Records, &*output.progress())?;
    let records: RecordSet = suite.store().read_json("1-records.json")?;
    let written = write_tables(args, &suite)?;
    let distributions = distributions(&records);
    if output.json {
        show::json(&serde_json::json!({
            "distributions": distributions,
            "files": records.files, "funnel": records.funnel, "usable": records.usable.len(),
            "diagnostics": report.diagnostics,
        }));
    } else if !output.quiet {
        show::remarks(&report);
        show::files(&records);
        show::funnel(&records.funnel);
        show::distributions(&distributions);
        written.iter().for_each(|(path, rows)| show::written(path, *rows));
    }
    Ok(())
}

/// Writes the tables that were asked for; gives each file with its rows.
fn write_tables(args: &RecordsArgs, suite: &Suite) -> Result<Vec<(PathBuf, usize)>, PipelineError> {
    let rows = if args.all { TableRows::All } else { TableRows::Usable };
    let mut wanted = Vec::new();
    wanted.extend(args.csv.iter().map(|path| (TableFormat::Csv, path)));
    #[cfg(feature = "parquet")]
    wanted.extend(args.parquet.iter().map(|path| (TableFormat::Parquet, path)));
    wanted.into_iter().map(|(format, path)| Ok((path.clone(), write_records(suite, rows, format, path)?))).collect()
}

fn fetch(args: &FetchArgs, output: Output) -> Result<(), PipelineError> {
    let request = FetchRequest {
        edition: args.published(),
        kind: args.crash_kind(),
        base_url: args.base_url.clone(),
        cache: args.cache.clone(),
    };
    if output.tables() {
        show::fetching(&request.url());
    }
    let fetched = recrash_pipeline::fetch(&request, &FetchLimits::default())?;
    if output.json {
        show::json(&fetched);
    } else if !output.quiet {
        show::fetched(&fetched);
    }
    Ok(())
}

fn select(args: &SuiteArgs, output: Output) -> Result<(), PipelineError> {
    let suite = open_saved(args)?;
    let report = suite.run_stage(Stage::Select, &*output.progress())?;
    let selection: Selection = suite.store().read_json("2-selection.json")?;
    if output.json {
        show::json(&selection);
    } else if !output.quiet {
        show::remarks(&report);
        show::tables(&selection.tables);
        show::coverage(&selection.coverage, &selection.templates);
        show::picks(&selection);
    }
    Ok(())
}

fn simulate(args: &SimulateArgs, output: Output) -> Result<(), PipelineError> {
    let Some(scenario) = &args.scenario else {
        return one_stage(&args.suite, Stage::Simulate, output);
    };
    let defaults = Options::default();
    let profile = args.suite.profile.as_deref().unwrap_or(&defaults.profile);
    let result = simulate_file(&FileRequest {
        scenario,
        profile,
        ego: args.suite.ego.as_deref(),
        simulator: args.suite.sim.unwrap_or_default(),
        python: &args.suite.python,
        rollout: args.rollout.as_deref(),
    })?;
    if output.json {
        show::json(&result.run);
    } else if !output.quiet {
        show::run(&result);
    }
    Ok(())
}

fn export(args: &ExportArgs, output: Output) -> Result<(), PipelineError> {
    let partners_as = if args.partners_as == "trajectory" { PartnersAs::Trajectory } else { PartnersAs::Actions };
    let report = recrash_pipeline::export(&ExportRequest {
        source: args.source.clone(),
        formats: args.to.clone(),
        partners_as,
        target: args.to_dir.clone(),
        force: args.force,
    })?;
    if output.json {
        show::json(&report);
    } else if !output.quiet {
        show::exported(&report);
    }
    match report.failures.is_empty() {
        true => Ok(()),
        false => Err(PipelineError::BadInput {
            what: format!("{} scenarios were not exported; the others were", report.failures.len()),
            diagnostics: report.failures,
        }),
    }
}
