//! `recrash select`: a few records that stand for all.

use crate::options::SuiteArgs;
use crate::output::{self, Output, number, table, title};
use anstream::println;
use comfy_table::Cell;
use recrash_model::selection::{Coverage, Selection, StageTables, TemplateCount};
use recrash_pipeline::{PipelineError, Stage};

/// Chooses the records and shows the choice.
///
/// # Errors
/// The stage's.
pub fn run(args: &SuiteArgs, output: Output) -> Result<(), PipelineError> {
    let suite = args.open_saved()?;
    let report = suite.run_stage(Stage::Select, &*output.progress())?;
    let selection: Selection = suite.store().read_json("2-selection.json")?;
    if output.json {
        output::json(&selection);
    } else if !output.quiet {
        output::remarks(&report);
        tables(&selection.tables);
        coverage(&selection.coverage, &selection.templates);
        picks(&selection);
    }
    Ok(())
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
fn picks(selection: &Selection) {
    title("Picks");
    let mut rows = table(&["scenario", "record", "cluster of"]);
    for cluster in &selection.clusters {
        rows.add_row(vec![Cell::new(&cluster.scenario_id), Cell::new(&cluster.pick), number(cluster.members.len())]);
    }
    println!("{rows}");
}
