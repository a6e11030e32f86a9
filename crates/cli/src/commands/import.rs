//! `recrash import`: a scenario of another format as a scenario file.

use super::simulate;
use crate::output::{self, Output};
use crate::screen::println;
use clap::Args;
use recrash_pipeline::{FileRequest, ImportRequest, Imported, Patience, PipelineError, SimulatorKind, SourceFormat};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  recrash import intersection-straight-straight-90101-80.xosc             writes intersection-straight-straight-90101-80.json
  recrash import edited.xosc --out edited.json --simulate           and runs it
  recrash import crash.json --out scenario.json                     the paper's JSON dialect

Of OpenSCENARIO only what recrash wrote is read: numbers from the parameter declarations, road users and map from the
properties. Edits elsewhere are told and not read. docs/formats/coverage.md lists every element.";

/// Options of `import`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct ImportArgs {
    /// OpenSCENARIO XML that recrash wrote, or a scenario in JSON: recrash's own or the paper's dialect.
    #[arg(value_name = "FILE")]
    pub source: PathBuf,
    /// Scenario file to write. [default: the scenario's id with .json, in this folder]
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Overwrite the scenario file if it is there already.
    #[arg(long)]
    pub force: bool,
    /// Run it in the native simulator, and show its metrics.
    #[arg(long)]
    pub simulate: bool,
    /// System under test to run it with. [default: that of the profile open]
    #[arg(long, value_name = "NAME", requires = "simulate")]
    pub ego: Option<String>,
}

/// Reads a scenario, writes it, and runs it where asked to.
///
/// # Errors
/// The source is no scenario that can be run, or a file cannot be read or written.
pub fn run(args: &ImportArgs, output: Output) -> Result<(), PipelineError> {
    let target = args.out.as_deref();
    let imported = recrash_pipeline::import(&ImportRequest { source: &args.source, target, force: args.force })?;
    let defaults = crate::options::defaults();
    let replay = || {
        recrash_pipeline::simulate_file(&FileRequest {
            scenario: &imported.file,
            profile: &defaults.profile,
            ego: args.ego.as_deref(),
            simulator: SimulatorKind::Native,
            python: Path::new(""),
            patience: Patience::default(),
            rollout: None,
            picture: None,
        })
    };
    let replayed = args.simulate.then(replay).transpose()?;
    if output.json {
        let run = replayed.map(|replayed| replayed.run);
        output::json(&serde_json::json!({ "imported": imported, "run": run }));
    } else if !output.quiet {
        show(&args.source, &imported);
        match replayed {
            Some(replayed) => simulate::show(&replayed),
            None => println!(
                "run it with: recrash simulate {}",
                recrash_pipeline::quoted(&imported.file.display().to_string())
            ),
        }
    }
    Ok(())
}

/// Prints what was read.
fn show(source: &Path, imported: &Imported) {
    imported.diagnostics.iter().for_each(output::remark);
    let scenario = &imported.scenario;
    let kind = match imported.read_as {
        SourceFormat::OpenScenario => "OpenSCENARIO",
        SourceFormat::Json => "JSON",
    };
    println!("{}, read as {kind} -> {}", source.display(), imported.file.display());
    println!(
        "{}: map {}, road users {}, things {}, {} s",
        scenario.id,
        scenario.map.letter(),
        1 + scenario.partners.len() + scenario.actors.len(),
        scenario.obstacles.len() + scenario.objects.len(),
        scenario.duration_s
    );
}
