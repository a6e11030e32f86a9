//! Tables and lines for people. Colours only on a terminal.

use anstream::{eprintln, println};
use comfy_table::{Attribute, Cell, CellAlignment, LineStyle, Table, presets};
use owo_colors::OwoColorize;
use recrash_model::diagnostic::{Diagnostic, Severity};
use recrash_model::record::{FunnelStep, RecordSet};
use recrash_model::selection::{Coverage, Selection, StageTables, TemplateCount};
use recrash_pipeline::{
    Distribution, ExportReport, Fetched, FileRun, PipelineError, RunSummary, Stage, StageReport, Suite, Summary,
};
use serde::Serialize;
use std::io::Write;
use std::path::Path;

/// Remarks of one stage that are shown one by one.
const REMARKS_SHOWN: usize = 8;
/// Values of a distribution that are shown.
const VALUES_SHOWN: usize = 8;

/// Prints a value as JSON.
pub fn json<T: Serialize>(value: &T) {
    let text = serde_json::to_string_pretty(value).unwrap_or_default();
    // A reader that has seen enough (`| head`) is no error.
    let _ = writeln!(std::io::stdout(), "{text}");
}

/// Prints why the command stopped.
pub fn error(error: &PipelineError) {
    eprintln!("{} {error}", "error:".red().bold());
    if let PipelineError::BadInput { diagnostics, .. } = error {
        for diagnostic in diagnostics.iter().take(REMARKS_SHOWN) {
            remark(diagnostic);
        }
        if diagnostics.len() > REMARKS_SHOWN {
            eprintln!("  ... and {} more", diagnostics.len() - REMARKS_SHOWN);
        }
    }
}

fn remark(diagnostic: &Diagnostic) {
    match diagnostic.severity {
        Severity::Error => eprintln!("  {} {diagnostic}", "error".red()),
        Severity::Warning => eprintln!("  {} {diagnostic}", "warning".yellow()),
        Severity::Note => eprintln!("  {} {diagnostic}", "note".dimmed()),
    }
}

/// Prints the remarks of a stage, warnings and errors one by one.
pub fn remarks(report: &StageReport) {
    let serious: Vec<_> = report.diagnostics.iter().filter(|d| d.severity > Severity::Note).collect();
    serious.iter().take(REMARKS_SHOWN).for_each(|d| remark(d));
    if serious.len() > REMARKS_SHOWN {
        eprintln!("  ... and {} more, in 1-records.diagnostics.json", serious.len() - REMARKS_SHOWN);
    }
    for (code, count, first) in notes_by_code(&report.diagnostics) {
        match count {
            1 => remark(first),
            _ => eprintln!("  {} {count} x {code}, the first: {}", "note".dimmed(), first.message),
        }
    }
}

/// Notes, which tell of nothing lost, by their code in order of first appearance: code, how many, the first one.
fn notes_by_code(diagnostics: &[Diagnostic]) -> Vec<(&str, usize, &Diagnostic)> {
    let mut groups: Vec<(&str, usize, &Diagnostic)> = Vec::new();
    for note in diagnostics.iter().filter(|d| d.severity == Severity::Note) {
        match groups.iter_mut().find(|(code, ..)| *code == note.code) {
            Some((_, count, _)) => *count += 1,
            None => groups.push((&note.code, 1, note)),
        }
    }
    groups
}

/// Prints what is about to be done.
pub fn heading(suite: &Suite) {
    let options = suite.options();
    eprintln!(
        "{} {}: profile {}, ego {}, budget {}, seed {} -> {}",
        "recrash".bold(),
        env!("CARGO_PKG_VERSION"),
        suite.profile().name,
        suite.ego(),
        options.budget,
        options.seed,
        suite.store().dir().display()
    );
}

/// Prints that a stage is done.
pub fn stage_done(report: &StageReport, stage: Stage, dir: &Path) {
    println!("{}: {} done, {} there already, in {}", stage.name(), report.done, report.skipped, dir.display());
}

fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    // A line under the header and none between rows: a table of 20 scenarios fits on a screen.
    table.load_style(presets::NOTHING.header_separator(LineStyle::new(' ', '\u{2500}', '\u{2500}', ' ')));
    table.set_header(header.iter().map(|h| Cell::new(h).add_attribute(Attribute::Bold)));
    table
}

fn number(value: impl ToString) -> Cell {
    Cell::new(value).set_alignment(CellAlignment::Right)
}

fn title(text: &str) {
    println!("\n{}", text.bold());
}

/// Prints the files read.
pub fn files(records: &RecordSet) {
    title("Files");
    let mut table = table(&["file", "edition", "rows", "SHA-256"]);
    for file in &records.files {
        let edition = format!("{:?}", file.edition).to_lowercase();
        table.add_row(vec![
            Cell::new(&file.name),
            Cell::new(edition),
            number(file.rows),
            Cell::new(&file.sha256[..12.min(file.sha256.len())]),
        ]);
    }
    println!("{table}");
}

/// Prints the way from rows to usable records.
pub fn funnel(steps: &[FunnelStep]) {
    title("From rows to usable records");
    let mut table = table(&["step", "remaining", "lost"]);
    for step in steps {
        let lost: Vec<String> = step.lost.iter().map(|(reason, n)| format!("{n} {}", reason.label())).collect();
        table.add_row(vec![Cell::new(&step.name), number(step.remaining), Cell::new(lost.join(", "))]);
    }
    println!("{table}");
}

/// Prints how the records are spread: of all that could be read, and of the usable ones.
pub fn distributions(all: &[Distribution]) {
    title("Distributions (records, usable ones behind the stroke)");
    for distribution in all {
        let shown: Vec<String> = distribution
            .values
            .iter()
            .take(VALUES_SHOWN)
            .map(|count| format!("{} {}/{}", count.value, count.records, count.usable))
            .collect();
        let more = distribution.values.len().saturating_sub(VALUES_SHOWN);
        let more = if more > 0 { format!(", and {more} more") } else { String::new() };
        println!("  {:<12} {}{more}", distribution.field, shown.join(", "));
    }
}

/// Prints that a table was written.
pub fn written(path: &Path, rows: usize) {
    println!("{rows} records in {}", path.display());
}

/// Prints what is about to be downloaded.
pub fn fetching(url: &str) {
    eprintln!("downloading {url}");
}

/// Prints what was downloaded.
pub fn fetched(fetched: &Fetched) {
    let state = if fetched.unchanged { "unchanged" } else { "saved" };
    println!("{state} {}", fetched.path.display());
    println!("{} bytes, SHA-256 {}", fetched.bytes, fetched.sha256);
    let edition = format!("{:?}", fetched.edition).to_lowercase();
    let modified = fetched.last_modified.as_ref().map(|when| format!(", last modified {when}")).unwrap_or_default();
    println!("{} rows, {edition} edition{modified}", fetched.rows);
    println!("use it with: recrash run --records {}", fetched.name);
}

/// Prints the paper's two tables.
pub fn tables(tables: &StageTables) {
    title("Road types");
    let mut roads = table(&["road type", "records"]);
    for (road, count) in &tables.road_types {
        roads.add_row(vec![Cell::new(road.label()), number(count)]);
    }
    println!("{roads}");
    title("Movements (rows: crash partner, columns: subject vehicle)");
    let header: Vec<&str> = std::iter::once("CP \\ SV").chain(tables.sv_movements.iter().map(|m| m.label())).collect();
    let mut movements = table(&header);
    for (movement, counts) in &tables.movements {
        movements.add_row(std::iter::once(Cell::new(movement.label())).chain(counts.iter().map(number)));
    }
    println!("{movements}");
    println!("largest template: {} records; work zone: {} records", tables.largest_template, tables.work_zone);
}

/// Prints what the picks cover.
pub fn coverage(coverage: &Coverage, templates: &[TemplateCount]) {
    title("Templates");
    let mut rows = table(&["template", "records", "picks"]);
    for count in templates {
        rows.add_row(vec![Cell::new(count.template), number(count.records), number(count.picks)]);
    }
    println!("{rows}");
    println!(
        "{} of {} observed templates covered ({} can be expressed); {} of {} records lie in them; farthest record {:.2} \
         from its pick, mean {:.2}",
        coverage.templates_covered,
        coverage.templates_observed,
        coverage.templates_possible,
        coverage.records_covered,
        coverage.records,
        coverage.radius,
        coverage.mean_distance
    );
    for hole in &coverage.holes_observed {
        println!("  not covered: {hole}");
    }
}

/// Prints the picks.
pub fn picks(selection: &Selection) {
    title("Picks");
    let mut rows = table(&["scenario", "record", "cluster of"]);
    for cluster in &selection.clusters {
        rows.add_row(vec![Cell::new(&cluster.scenario_id), Cell::new(&cluster.pick), number(cluster.members.len())]);
    }
    println!("{rows}");
}

fn gap(run: &RunSummary) -> String {
    match (&run.contact, run.min_gap_m) {
        (Some(kind), _) => format!("contact: {kind}"),
        (None, Some(gap)) if gap < 0.01 => "< 0.01 m".into(),
        (None, Some(gap)) => format!("{gap:.2} m"),
        (None, None) => "-".into(),
    }
}

/// Prints a whole run in tables.
pub fn summary(summary: &Summary, dir: &Path) {
    funnel(&summary.funnel);
    tables(&summary.tables);
    coverage(&summary.coverage, &summary.templates);
    title("Scenarios (least box gap to the partner, as designed and as tuned)");
    let mut rows = table(&["scenario", "from", "designed", "tuned", "verdict", "findings"]);
    for case in &summary.cases {
        let verdict = if case.tuned.faithful { "faithful" } else { "NOT FAITHFUL" };
        rows.add_row(vec![
            Cell::new(&case.id),
            Cell::new(if case.alternative.is_some() { "alternative" } else { "record" }),
            Cell::new(gap(&case.first)),
            Cell::new(gap(&case.tuned)),
            Cell::new(verdict),
            Cell::new(case.tuned.findings.join(", ")),
        ]);
    }
    println!("{rows}");
    for case in summary.cases.iter().filter(|case| !case.tuned.faithful) {
        println!("  {} {}: {}", "not faithful:".yellow(), case.id, case.tuned.unfaithful.join("; "));
    }
    let total = summary.cases.len();
    let (first, tuned) = summary.failed();
    println!(
        "\n{} {total} scenarios run; {} faithful; {} fails {first} as designed and {tuned} after tuning",
        "result:".bold(),
        summary.faithful(),
        summary.ego,
    );
    if summary.sample {
        println!("records: the built-in sample, invented; give real crash files with --records FILE");
    }
    println!("report: {}", dir.join("report.html").display());
}

/// Prints one run of one scenario file.
pub fn run(result: &FileRun) {
    let run = &result.run;
    result.diagnostics.iter().for_each(remark);
    println!(
        "{} under {}: {:?} after {:.1} s",
        run.rollout.scenario_id.bold(),
        run.rollout.ego,
        run.metrics.termination,
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
    for finding in &run.findings {
        let mark = if finding.kind.is_failure() { "FAIL".red().to_string() } else { "odd ".yellow().to_string() };
        println!("  {mark} {}", finding.sentence);
    }
    println!("state hash {}", run.rollout.state_hash);
}

/// Prints what was exported.
pub fn exported(report: &ExportReport) {
    let mut folders: Vec<(&Path, usize)> = Vec::new();
    for folder in report.files.iter().filter_map(|file| file.parent()) {
        match folders.last_mut() {
            Some((last, count)) if *last == folder => *count += 1,
            _ => folders.push((folder, 1)),
        }
    }
    for (folder, count) in folders {
        println!("{count} files in {}", folder.display());
    }
}
