//! What of all readable incidents the suite covers, in the cells that assessors ask for, and the holes.

use crate::words::thousands;
use maud::{Markup, html};
use recrash_model::coverage::{CorpusCoverage, CoverageCell, CoverageCounts, CoverageTable, Hole};

/// Cells of a table that the page shows, and holes of each sort that it names; `recrash coverage` has all. [count]
const LONGEST_TABLE: usize = 80;
const LONGEST_LIST: usize = 40;

/// Folded: a line for each table, and in it the cells and the holes.
pub fn corpus(corpus: &CorpusCoverage) -> Markup {
    let CoverageCounts { incidents, tellable, told, met, failed } = corpus.all;
    html! {
        p.muted {
            "Of " (thousands(incidents)) " readable incidents " (thousands(tellable)) " can be reconstructed, " (thousands(told)) " are in this suite, the ego came into the situation of "
            (thousands(met)) " and failed " (thousands(failed)) " of those. Covered means that the incident's own crash is in the suite, not that some file was made; one incident covers a cell."
        }
        @for table in &corpus.tables { (folded(table)) }
    }
}

fn folded(table: &CoverageTable) -> Markup {
    let holes = table.holes(Hole::NotTold).len();
    html! {
        details {
            summary {
                (table.name) ": " (thousands(table.told())) " of " (thousands(table.seen())) " cells with incidents are in the suite, " (thousands(table.met())) " tested"
                @if holes > 0 { ", " b { (thousands(holes)) " without a scenario" } }
                span.muted { "; " (thousands(table.unseen())) " of " (thousands(table.possible)) " cells without an incident" }
            }
            @if table.cells.len() <= LONGEST_TABLE { (cells(table)) }
            (list("Incidents, but no scenario", &table.holes(Hole::NotTold)))
            (list("Scenarios, but the situation never met", &table.holes(Hole::NotMet)))
            @if table.cells.len() > LONGEST_TABLE { (list("No incident", &table.holes(Hole::NotSeen))) }
            @if table.overlapping { p.muted.small { "An incident may stand in several cells." } }
        }
    }
}

fn cells(table: &CoverageTable) -> Markup {
    html! {
        .table-wrap { table.plain.small {
            caption.hidden-text { (table.name) }
            thead { tr {
                @for axis in &table.axes { th scope="col" { (axis) } }
                th.right scope="col" { "Incidents" } th.right scope="col" { "In suite" } th.right scope="col" { "Tested" } th.right scope="col" { "Failed" } th scope="col" { "Hole" }
            } }
            tbody {
                @for cell in &table.cells { tr { @for value in &cell.values { td { (value) } } (numbers(&cell.counts)) td { (cell.hole().map_or("", Hole::label)) } } }
                @for outside in &table.outside { tr.muted { td colspan=(table.axes.len()) { "in no cell: " (outside.why) } (numbers(&outside.counts)) td {} } }
            }
        } }
    }
}

fn numbers(counts: &CoverageCounts) -> Markup {
    html! {
        @for count in [counts.incidents, counts.told, counts.met, counts.failed] { td.right.number { (thousands(count)) } }
    }
}

fn list(name: &str, holes: &[&CoverageCell]) -> Markup {
    html! {
        @if !holes.is_empty() {
            p { b { (name) " (" (thousands(holes.len())) "): " }
                @for (i, cell) in holes.iter().take(LONGEST_LIST).enumerate() {
                    @if i > 0 { "; " }
                    (cell.name()) @if cell.counts.incidents > 0 { span.muted { " (" (thousands(cell.counts.incidents)) ")" } }
                }
                @if holes.len() > LONGEST_LIST { "; and more, told by recrash coverage" }
            }
        }
    }
}
