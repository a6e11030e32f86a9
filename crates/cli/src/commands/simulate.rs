//! `recrash simulate`: the scenarios of a suite, or one scenario file with its metrics.

use super::stage;
use crate::options::SuiteArgs;
use crate::output::{self, Output};
use crate::screen::{bold, println, red, yellow};
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_model::cause::Cause;
use recrash_model::preventability::Preventability;
use recrash_model::severity::{InjuryOutcome, Suffered};
use recrash_pipeline::{FileRequest, FileRun, PipelineError, Stage, preventability, simulate_file};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash simulate                                       the scenarios of suite/, as designed
  recrash simulate suite/6-tuned/intersection-straight-straight-90101-80.json --ego idm
  recrash simulate paper-suite --ego reference           the scenarios of another suite
  recrash simulate scenario.json --rollout rollout.json --json
  recrash simulate scenario.json --ego recorded --picture scenario.svg
  recrash simulate scenario.json --ego recorded --words  the replay for a reader without a picture

Exit code 5: a scenario of the suite is not true to its record, or could not be run; the results are written all the same.";

/// Options of `simulate`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct SimulateArgs {
    /// One scenario file (JSON), or the folder of a suite, as with --out; without it, the scenarios of the suite are run.
    #[arg(value_name = "SCENARIO|SUITE")]
    pub scenario: Option<PathBuf>,
    /// Where to write the rollout of the one scenario (JSON).
    #[arg(long, value_name = "FILE", requires = "scenario")]
    pub rollout: Option<PathBuf>,
    /// Where to draw the one scenario: its roads, everybody's way, and where all are at the ego's first contact (SVG).
    #[arg(long, value_name = "FILE", requires = "scenario")]
    pub picture: Option<PathBuf>,
    /// Print in words what the one scenario shows: roads, signals, where everybody is every half second, who touches whom.
    #[arg(long, requires = "scenario", conflicts_with = "json")]
    pub words: bool,
    /// Options of the suite.
    #[command(flatten)]
    pub suite: SuiteArgs,
}

/// Runs the scenarios.
///
/// # Errors
/// The scenario cannot be run, or a file cannot be read or written.
pub fn run(args: &SimulateArgs, output: Output) -> Result<(), PipelineError> {
    let Some(scenario) = &args.scenario else {
        return stage::run(&args.suite, &[Stage::Simulate], output);
    };
    if scenario.is_dir() {
        let given =
            [("--rollout", args.rollout.is_some()), ("--picture", args.picture.is_some()), ("--words", args.words)];
        if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
            let what = format!("{option} is for one scenario file, and {} is a folder", scenario.display());
            return Err(PipelineError::Usage(what));
        }
        if args.suite.names_a_folder() {
            let what =
                format!("the suite is named twice: {} and --out {}", scenario.display(), args.suite.out.display());
            return Err(PipelineError::Usage(what));
        }
        let suite = SuiteArgs { out: scenario.clone(), ..args.suite.clone() };
        return stage::run(&suite, &[Stage::Simulate], output);
    }
    if args.suite.is_about_a_suite() {
        let file = scenario.display();
        let what = format!(
            "{file} is one scenario file: --profile, --ego, --ego-timeout, --sim, --python, --rollout, --picture and --words are for it, and the other options for suites"
        );
        return Err(PipelineError::Usage(what));
    }
    let defaults = crate::options::defaults();
    let profile = args.suite.profile.as_deref().unwrap_or(&defaults.profile);
    let result = simulate_file(&FileRequest {
        scenario,
        profile,
        ego: args.suite.ego.as_deref(),
        simulator: args.suite.sim.unwrap_or_default(),
        python: &args.suite.python,
        patience: args.suite.patience(),
        rollout: args.rollout.as_deref(),
        picture: args.picture.as_deref(),
    })?;
    if output.json {
        output::json(&result.run);
    } else if args.words {
        println!("{}", result.words.trim_end());
    } else if !output.quiet {
        show(&result);
    }
    Ok(())
}

/// Prints one run of one scenario file.
pub(super) fn show(result: &FileRun) {
    let run = &result.run;
    result.diagnostics.iter().for_each(output::remark);
    println!(
        "{} under {}: {} after {:.1} s",
        bold(&run.rollout.scenario_id),
        run.rollout.ego,
        run.metrics.termination.label(),
        run.metrics.duration_s
    );
    let mut rows = table(&["with", "min gap", "at", "centres", "TTC", "PET", "DRAC", "headway"]);
    let timed = |value: Option<f64>, unit: &str| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.2} {unit}"));
    for partner in &run.metrics.partners {
        rows.add_row(vec![
            Cell::new(&partner.id),
            number(format!("{:.2} m", partner.min_gap.value)),
            number(format!("{:.1} s", partner.min_gap.time_s)),
            number(format!("{:.2} m", partner.min_centre_distance.value)),
            number(timed(partner.min_ttc.map(|t| t.value), "s")),
            number(timed(partner.pet.map(|t| t.value), "s")),
            number(timed(partner.max_drac.map(|t| t.value), "m/s2")),
            number(timed(partner.min_headway.map(|t| t.value), "s")),
        ]);
    }
    println!("{rows}");
    if let Some(contact) = &run.metrics.contact {
        println!(
            "contact at {:.2} s with {}: {}, {} of the ego on {} of the partner, {:.1} m/s relative",
            contact.time_s,
            contact.id,
            contact.kind.label(),
            contact.ego_zone.label(),
            contact.other_zone.label(),
            contact.relative_speed_mps
        );
    }
    if let Some(severity) = &run.severity {
        println!("  {}", suffered("the ego", &severity.first));
        println!("  {}", suffered(&format!("the {}", severity.other()), &severity.second));
    }
    if let Some(prevented) = run.metrics.contact.as_ref().and_then(|_| preventability(&run.rollout)) {
        println!("  {REGULATION_DRIVERS}: {}", in_their_place(&prevented));
    }
    for finding in &run.findings {
        let struck = run.cause == Some(Cause::StruckStanding);
        let mark = match finding.kind.is_failure() {
            true if run.parked => yellow("as recorded:"),
            true if struck => red("FAIL (struck while it stood, whatever it drove)"),
            true => red("FAIL"),
            false => yellow("odd "),
        };
        println!("  {mark} {}", finding.sentence);
    }
    println!("state hash {}", run.rollout.state_hash);
}

/// What a contact does to one of the two, in a line.
fn suffered(who: &str, side: &Suffered) -> String {
    let mut line = format!("{who}: delta-v {:.1} m/s", side.delta_v_mps);
    if let Some(hour) = side.force_clock {
        line += &format!(", force from {hour} o'clock");
    }
    let told = [InjuryOutcome::Mais3, InjuryOutcome::Fatal];
    for risk in side.risks.iter().filter(|risk| told.contains(&risk.outcome)) {
        line += &format!("; {} {:.1} % ({})", risk.outcome.label(), 100.0 * risk.probability, risk.curve.source());
    }
    line
}

/// Who is asked about a contact; how other egos fare in the scenario is another question.
pub(super) const REGULATION_DRIVERS: &str = "reference drivers of UN R157, on its straight-road model";

/// What the reference drivers make of a contact, in a line.
fn in_their_place(prevented: &Preventability) -> String {
    let each: Vec<String> = prevented
        .drivers
        .iter()
        .map(|driver| match driver.closing_speed_mps {
            None => format!("{} avoids it", driver.driver),
            Some(closing_mps) => format!("{} closes with {closing_mps:.1} m/s", driver.driver),
        })
        .collect();
    let told = if each.is_empty() { String::new() } else { format!(": {}", each.join(", ")) };
    format!("{}{told}", prevented.bracket().label())
}
