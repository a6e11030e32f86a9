//! What of the crash files a suite holds, as a list that the checker counts in.

use super::number::{Number, counted, holds};
use super::structure::Structure;
use crate::error::PipelineError;
use crate::suite::SUITE_FILE;
use crate::tools::assessing::coverage_where_told;
use serde_json::{Value, json};
use std::path::Path;

/// Name of the list.
pub const NAME: &str = "coverage";
/// Where it stands in the folder.
pub const FILE: &str = "reports/coverage.json";
/// The tables that are claimed of: those that list every cell they have, and what each is called.
const TABLES: [(&str, &str); 5] = [
    ("eu-2022-1426", "the objects-by-events matrix of EU 2022/1426, Annex III, Appendix 1"),
    ("operational-environment", "the operational environment"),
    ("behavioural-competency", "behavioural competency"),
    ("scenario-type", "scenario type"),
    ("rules-of-the-road", "the rules of the road"),
];

/// Every cell of these tables, where the source is a suite by accounts with its report.
pub fn of(source: &Path) -> Result<Option<Value>, PipelineError> {
    if !source.join(SUITE_FILE).is_file() {
        return Ok(None);
    }
    let Some(corpus) = coverage_where_told(source)? else { return Ok(None) };
    let tables = TABLES.iter().filter_map(|(id, _)| corpus.table(id));
    let cells = tables.flat_map(|table| {
        table.cells.iter().filter(|cell| !cell.untold).map(|cell| {
            json!({
                "table": table.id,
                "cell": cell.name(),
                "incidents": cell.counts.incidents,
                "tellable": cell.counts.tellable,
                "own_crash_told": cell.counts.told,
                "seen": cell.counts.incidents > 0,
                "told": cell.counts.told > 0,
            })
        })
    });
    Ok(Some(json!({ "format": "recrash.coverage-cells/1", "cells": cells.collect::<Vec<_>>() })))
}

/// Conditions of the counts of a table.
fn counts(table: &str) -> [(String, Value); 3] {
    [
        (format!("coverage: {table}"), json!({ "table": table })),
        (format!("coverage: {table}, seen"), json!({ "table": table, "seen": true })),
        (format!("coverage: {table}, told"), json!({ "table": table, "told": true })),
    ]
}

/// How many cells each table has, in how many an incident was seen, and of how many one is told.
pub fn numbers(report: &Value, numbers: &mut Vec<Number>) {
    let cells = report["cells"].as_array().map_or(&[][..], Vec::as_slice);
    for (id, filter) in TABLES.iter().flat_map(|(table, _)| counts(table)) {
        let count = cells.iter().filter(|cell| holds(cell, &filter)).count();
        numbers.push(counted(&id, [FILE, "cells"], filter, count));
    }
}

/// What that says of the suite.
pub fn claims(all: &mut Structure<'_>, there: bool) {
    let ids: Vec<String> = (1..=TABLES.len()).map(|number| format!("K{number}")).collect();
    let under: Vec<&str> = if there { ids.iter().map(String::as_str).collect() } else { vec!["K1"] };
    all.add("S4", "strategy", "Over the crash files: what of them the suite holds.", &under, &["C5"]);
    all.add(
        "C5",
        "context",
        "A cell is told where the suite holds the own crash of at least one of its incidents, no stated fact shown otherwise; the cells, and what telling one incident does not claim: docs/models/coverage.md.",
        &[],
        &[],
    );
    if !there {
        let why = "What of the crash files is held: the evidence was made of a frozen suite, or of one without accounts or report.";
        all.add("K1", "undeveloped", why, &[], &[]);
        return;
    }
    for (id, (table, name)) in ids.iter().zip(TABLES) {
        let [cells, seen, told] = counts(table).map(|(number, _)| format!("{{{number}}}"));
        let text = format!(
            "Of the {cells} cells of {name} the crash files have readable incidents in {seen}, and of {told} the suite tells one."
        );
        all.add(id, "goal", &text, &["Sn5"], &[]);
    }
    all.add("Sn5", "solution", FILE, &[], &[]);
}
