//! `recrash coverage` and `recrash severity`: what an assessor asks of a suite.

use crate::output::{self, Output, title};
use crate::screen::println;
use crate::table::{Cell, Table, number, table};
use clap::Args;
use recrash_model::coverage::{CorpusCoverage, CoverageCell, CoverageCounts, CoverageTable, Hole};
use recrash_model::severity::{Interval, SeverityAgreement};
use recrash_pipeline::{PipelineError, SevereFailure, suite_coverage, suite_severity};
use std::path::PathBuf;

const COVERAGE_EXAMPLES: &str = "\
Examples:
  recrash coverage suite                                 every table in a line, and the holes
  recrash coverage suite --table eu-2022-1426            the matrix of the EU, cell by cell
  recrash coverage suite --table rules-of-the-road --holes 50
  recrash coverage suite --csv coverage.csv              every cell of every table
  recrash coverage suite --json

Covered means: the suite tells the incident's own crash, and the reconstruction shows every stated fact that is checked.
What each cell means, and what this does not claim: docs/models/coverage.md.";

const SEVERITY_EXAMPLES: &str = "\
Examples:
  recrash severity suite                                 the worst failures, and what their records report
  recrash severity suite --list 100
  recrash severity suite --json

Formulas, curves and where they are valid: docs/models/severity.md.";

/// Options of `coverage`.
#[derive(Debug, Clone, Args)]
#[command(after_help = COVERAGE_EXAMPLES)]
pub struct CoverageArgs {
    /// The suite's folder, with its report.
    #[arg(value_name = "SUITE", default_value = "suite")]
    pub suite: PathBuf,
    /// Show this table cell by cell; may be given more than once.
    #[arg(long, value_name = "TABLE")]
    pub table: Vec<String>,
    /// Holes that are named of each table.
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub holes: usize,
    /// Write every cell of every table.
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
}

/// Options of `severity`.
#[derive(Debug, Clone, Args)]
#[command(after_help = SEVERITY_EXAMPLES)]
pub struct SeverityArgs {
    /// The suite's folder, with its report.
    #[arg(value_name = "SUITE", default_value = "suite")]
    pub suite: PathBuf,
    /// Failures that the screen tells one by one.
    #[arg(long, value_name = "N", default_value_t = 30)]
    pub list: usize,
}

/// Says what a suite covers.
///
/// # Errors
/// There is no suite with a report, a table is not known, or the file cannot be written.
pub fn coverage(args: &CoverageArgs, output: Output) -> Result<(), PipelineError> {
    let corpus = suite_coverage(&args.suite, args.csv.as_deref())?;
    let find = |id: &String| {
        corpus.table(id).ok_or_else(|| {
            let known: Vec<&str> = corpus.tables.iter().map(|table| table.id.as_str()).collect();
            PipelineError::Usage(format!("no table is called \"{id}\"; there are: {}", known.join(", ")))
        })
    };
    let asked: Vec<&CoverageTable> = args.table.iter().map(find).collect::<Result<_, _>>()?;
    if output.json {
        output::json(&corpus);
        return Ok(());
    }
    if !output.tables() {
        return Ok(());
    }
    if asked.is_empty() {
        overview(&corpus);
    }
    for table in &asked {
        cells(table);
    }
    let tables = if asked.is_empty() { corpus.tables.iter().collect() } else { asked };
    for table in tables {
        holes(table, args.holes);
    }
    let CoverageCounts { incidents, tellable, told, met, failed } = corpus.all;
    println!(
        "\nof {incidents} readable incidents {tellable} can be reconstructed, {told} are in this suite, the ego came into the situation of {met} and failed {failed} of those"
    );
    if let Some(csv) = &args.csv {
        println!("cells: {}", csv.display());
    }
    Ok(())
}

fn overview(corpus: &CorpusCoverage) {
    title("Cells with incidents, with scenarios in this suite, and with tests that met the situation");
    let mut rows = table(&["table", "cells", "seen", "in suite", "tested", "incidents outside"])
        .without_first(&["incidents outside", "cells"]);
    for table in &corpus.tables {
        let outside: usize = table.outside.iter().map(|outside| outside.counts.incidents).sum();
        rows.add_row([
            Cell::new(&table.id),
            number(table.possible),
            number(table.seen()),
            number(table.told()),
            number(table.met()),
            number(outside),
        ]);
    }
    println!("{rows}");
}

fn counted(names: &[&str]) -> Table {
    table(&[names, &["incidents", "reconstructed", "in suite", "tested", "failed", "hole"]].concat())
        .without_first(&["reconstructed", "failed"])
}

fn counts(cell: &CoverageCell) -> impl Iterator<Item = Cell> {
    let hole = cell.hole().map_or("", Hole::label);
    let CoverageCounts { incidents, tellable, told, met, failed } = cell.counts;
    [incidents, tellable, told, met, failed].map(number).into_iter().chain([Cell::new(hole)])
}

fn cells(table: &CoverageTable) {
    title(&table.name);
    let axes: Vec<&str> = table.axes.iter().map(String::as_str).collect();
    let mut rows = counted(&axes);
    for cell in &table.cells {
        rows.add_row(cell.values.iter().map(Cell::new).chain(counts(cell)));
    }
    println!("{rows}");
    for outside in &table.outside {
        let CoverageCounts { incidents, told, .. } = outside.counts;
        println!("  in no cell: {incidents} incidents, {told} of them told: {}", outside.why);
    }
    if table.overlapping {
        println!("  an incident may stand in several cells");
    }
}

/// Names the cells that lack something, those with the most incidents first.
fn holes(table: &CoverageTable, most: usize) {
    let list = |hole: Hole| {
        let found = table.holes(hole);
        let named = found.iter().take(most).map(|cell| match hole {
            Hole::NotSeen => cell.name(),
            Hole::NotTold | Hole::NotMet => format!("{} ({})", cell.name(), cell.counts.incidents),
        });
        (found.len(), named.collect::<Vec<_>>().join("; "))
    };
    let told = [Hole::NotTold, Hole::NotMet, Hole::NotSeen].map(|hole| (hole, list(hole)));
    if most == 0 || told.iter().all(|(_, (count, _))| *count == 0) {
        return;
    }
    title(&format!("Holes of {}", table.id));
    for (hole, (count, named)) in told {
        // A product of many values names only what it has seen.
        let count = if hole == Hole::NotSeen { table.unseen() } else { count };
        if count > 0 {
            let named = if named.is_empty() { String::new() } else { format!(": {named}") };
            let more = if count > most && !named.is_empty() {
                format!("; and {} more, told by --json and --csv", count - most)
            } else {
                String::new()
            };
            let cells = if count == 1 { "cell" } else { "cells" };
            println!("  {}, {count} {cells}{named}{more}", hole.label());
        }
    }
}

/// Says how bad failures are.
///
/// # Errors
/// There is no suite with a report in the folder, or it goes by templates.
pub fn severity(args: &SeverityArgs, output: Output) -> Result<(), PipelineError> {
    let severity = suite_severity(&args.suite)?;
    if output.json {
        output::json(&severity);
    } else if output.tables() {
        failures(&severity.failures, args.list);
        agreement(&severity.agreement);
    }
    Ok(())
}

fn failures(failures: &[SevereFailure], most: usize) {
    title("Failures with a contact, the worst first, and what the record reports of its own crash");
    let header =
        ["scenario", "situation", "delta-v ego", "other", "serious injury", "failure", "injury", "towed", "air bags"];
    let mut rows = table(&header).without_first(&["air bags", "towed", "failure", "situation"]);
    let known = |value: Option<bool>| Cell::new(value.map_or("unknown", |yes| if yes { "yes" } else { "no" }));
    for failure in failures.iter().take(most) {
        let [ego, other] = failure.delta_v_mps.map(|value| number(format!("{value:.1} m/s")));
        rows.add_row([
            Cell::new(&failure.id),
            Cell::new(if failure.met { "met" } else { "not met" }),
            ego,
            other,
            number(failure.serious_injury.map_or_else(|| "-".to_owned(), |risk| format!("{:.1} %", 100.0 * risk))),
            Cell::new(failure.class.unwrap_or("")),
            Cell::new(failure.injury.as_deref().unwrap_or("unknown")),
            known(failure.towed),
            known(failure.airbags),
        ]);
    }
    println!("{rows}");
    if failures.len() > most {
        println!("  and {} more, told by --json", failures.len() - most);
    }
}

fn agreement(agreement: &SeverityAgreement) {
    title("Rank correlation of computed severity, as the crash is told, with what records report (95 % interval)");
    let mut rows = table(&["reported", "against", "incidents", "with harm", "Spearman's rho", "Kendall's tau-b"])
        .without_first(&["Kendall's tau-b"]);
    let interval = |found: Option<Interval>| {
        number(found.map_or_else(
            || "-".to_owned(),
            |found| format!("{:+.2} ({:+.2} to {:+.2})", found.value, found.low, found.high),
        ))
    };
    for rank in &agreement.ranks {
        rows.add_row([
            Cell::new(&rank.outcome),
            Cell::new(&rank.measure),
            number(rank.incidents),
            number(rank.harmed),
            interval(rank.spearman),
            interval(rank.kendall),
        ]);
    }
    println!("{rows}");
    let levels = agreement
        .by_injury
        .iter()
        .map(|level| format!("{} {:.1} m/s ({})", level.injury, level.median_delta_v_mps, level.incidents));
    println!("  median delta-v by reported injury: {}", levels.collect::<Vec<_>>().join(", "));
    println!(
        "  {} told crashes have a contact of two road users; of {} the speeds of both are told, or they stood",
        agreement.contacts, agreement.speeds_told
    );
}
