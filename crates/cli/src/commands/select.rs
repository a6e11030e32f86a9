//! `recrash select`: a few records that stand for all.

use crate::options::SuiteArgs;
use crate::output::{self, Output, title};
use crate::screen::println;
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_model::selection::{Coverage, Selection, StageTables, TemplateCount};
use recrash_pipeline::{PipelineError, SelectionStudy, Stage, StrategyStudy, Suite, run_stage};

const EXAMPLES: &str = "\
Examples:
  recrash select --records archive.csv                  begins a suite where there is none
  recrash select --budget 30 --weighting severity       harmful kinds of crash get more scenarios
  recrash select --strategy kmeans --embedding minilm   the paper's choice
  recrash select --study                                every strategy over 50 seeds; many budgets

How records are chosen, and what that guarantees: docs/models/selection.md";

/// Options of `select`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct SelectArgs {
    /// Also repeat the choice under many seeds with every strategy, and at many budgets: stability, elbow, silhouette.
    #[arg(long)]
    pub study: bool,
    /// Seeds of the study.
    #[arg(long, value_name = "N", default_value_t = 50, requires = "study", value_parser = clap::value_parser!(u16).range(2..=1000))]
    pub study_seeds: u16,
    /// Options of the suite.
    #[command(flatten)]
    pub suite: SuiteArgs,
}

/// Chooses the records and shows the choice.
///
/// # Errors
/// The stage's.
pub fn run(args: &SelectArgs, output: Output) -> Result<(), PipelineError> {
    let is_new = Suite::saved_options(&args.suite.out)?.is_none();
    let names_records = args.suite.source.is_given();
    let suite = if names_records { args.suite.open_or_begin()? } else { args.suite.open_saved()? };
    let progress = output.progress();
    if is_new || names_records || args.suite.profile.is_some() {
        let report = run_stage(&suite, Stage::Records, &*progress)?;
        if output.tables() {
            output::remarks(&report);
        }
    }
    let report = run_stage(&suite, Stage::Select, &*progress)?;
    let selection: Selection = suite.store().read_json("2-selection.json")?;
    let study = args.study.then(|| suite.study_selection(usize::from(args.study_seeds))).transpose()?;
    if output.json {
        match study {
            None => output::json(&selection),
            Some(study) => output::json(&serde_json::json!({ "selection": selection, "study": study })),
        }
    } else if !output.quiet {
        output::remarks(&report);
        tables(&selection.tables);
        coverage(&selection.coverage, &selection.templates);
        picks(&selection);
        how(&selection);
        study.iter().for_each(show_study);
    }
    Ok(())
}

/// Prints how the choice was made.
fn how(selection: &Selection) {
    let Selection { embedding, strategy, weighting, .. } = selection;
    println!(
        "chosen by {}, weighted by {}; narratives by {}: {} of {} dimensions keep {:.0} % of the variance",
        strategy.name(),
        weighting.name(),
        embedding.name,
        embedding.dimensions,
        embedding.source_dimensions,
        100.0 * embedding.explained_variance
    );
}

/// Prints the study of a choice.
fn show_study(study: &SelectionStudy) {
    let seeds = study.strategies.first().map_or(0, |s| s.stability.seeds);
    title(&format!("Every strategy over {seeds} seeds (distances: worst and mean of a record to its nearest pick)"));
    let mut rows = table(&["strategy", "templates (seeds)", "worst", "mean", "picks in common", "same clusters"]);
    for StrategyStudy { strategy, stability } in &study.strategies {
        let covered: Vec<String> =
            stability.templates_covered.iter().map(|(n, seeds)| format!("{n} ({seeds})")).collect();
        rows.add_row(vec![
            Cell::new(strategy.name()),
            Cell::new(covered.join(", ")),
            number(format!("{:.3}", stability.mean_radius)),
            number(format!("{:.3}", stability.mean_distance)),
            number(format!("{:.2}", stability.picks_in_common)),
            number(format!("{:.2}", stability.cluster_agreement)),
        ]);
    }
    println!("{rows}");
    title("Budgets");
    let mut rows = table(&["budget", "inertia", "silhouette", "templates", "worst", "mean", ""]);
    for row in &study.budgets {
        let mut marks = Vec::new();
        marks.extend((study.elbow == Some(row.budget)).then_some("elbow"));
        marks.extend((study.best_silhouette == Some(row.budget)).then_some("best silhouette"));
        rows.add_row(vec![
            number(row.budget),
            number(format!("{:.2}", row.inertia)),
            number(row.silhouette.map_or("-".to_owned(), |s| format!("{s:.3}"))),
            number(row.templates_covered),
            number(format!("{:.3}", row.radius)),
            number(format!("{:.3}", row.mean_distance)),
            Cell::new(marks.join(", ")),
        ]);
    }
    println!("{rows}");
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
        let invented = templates.iter().any(|row| row.template == *hole && row.picks > 0);
        let why = if invented { " (no record of it is told; its scenario is invented)" } else { "" };
        println!("  not covered: {hole}{why}");
    }
}

/// Prints the picks.
fn picks(selection: &Selection) {
    title("Picks");
    let mut rows = table(&["scenario", "record", "cluster of"]);
    for cluster in &selection.clusters {
        let pick = if cluster.invented { "none: invented".to_owned() } else { cluster.pick.to_string() };
        rows.add_row(vec![Cell::new(&cluster.scenario_id), Cell::new(pick), number(cluster.members.len())]);
    }
    println!("{rows}");
}
