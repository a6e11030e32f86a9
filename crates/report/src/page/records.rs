//! The records: funnel, the paper's tables for this run, the cluster map, and what the picks cover.

use super::{Context, cluster_map, coverage, parts};
use crate::anchor;
use crate::view::CaseRow;
use crate::words::{self, thousands};
use maud::{Markup, html};
use recrash_model::record::RejectReason;

/// Scenarios of a template that are linked. [count]
const LONGEST_LIST: usize = 24;

/// The section.
pub fn section(context: &Context) -> Markup {
    let selection = &context.suite.selection;
    // A table of many movements has no room beside another.
    let wide = selection.tables.sv_movements.len() > 4;
    html! {
        section.page #records aria-labelledby="records-title" {
            .page-head {
                h1 #records-title { "Records and coverage" }
                p.lead {
                    (thousands(context.summary.rows)) " rows, " (thousands(context.summary.usable)) " usable records in "
                    (selection.coverage.templates_observed) " templates, " (selection.clusters.iter().filter(|cluster| !cluster.invented).count()) " picks."
                }
            }
            .columns {
                .panel { h2 { "From rows to usable records" } (funnel(context)) }
                .panel { h2 { "Road types" } (road_types(context)) @if !wide { h2 { "Movements" } (movements(context)) } }
            }
            @if wide { .panel { h2 { "Movements" } (movements(context)) } }
            .panel { h2 { "Templates" } (templates(context)) }
            .panel { h2 { "Map of the records" } (cluster_map::map(context)) }
            .panel { h2 { "What the picks cover" } (coverage::coverage(context)) }
        }
    }
}

fn funnel(context: &Context) -> Markup {
    let steps = &context.suite.records.funnel;
    let first = steps.first().map_or(0, |step| step.remaining);
    let rejects = &context.suite.records.rejects;
    let mut reasons: Vec<(RejectReason, usize)> = Vec::new();
    for reject in rejects {
        match reasons.iter_mut().find(|(reason, _)| *reason == reject.reason) {
            Some((_, n)) => *n += 1,
            None => reasons.push((reject.reason, 1)),
        }
    }
    reasons.sort();
    let told: usize = steps.iter().flat_map(|step| &step.lost).map(|(_, n)| n).sum();
    html! {
        table.plain {
            caption.hidden-text { "How many rows remain after each step" }
            thead { tr { th scope="col" { "Step" } th.right scope="col" { "Remain" } td {} th scope="col" { "Taken away" } } }
            tbody {
                @for step in steps {
                    tr {
                        th scope="row" { (words::clean(&step.name, 120)) }
                        td.right.number { (thousands(step.remaining)) }
                        td.bar-cell { (parts::bar(parts::share(step.remaining, first), "plain")) }
                        td {
                            @for (reason, n) in &step.lost { div { span.number { (thousands(*n)) } " " (reason.label()) } }
                            @if step.lost.is_empty() { (parts::missing("nothing was taken away")) }
                        }
                    }
                }
            }
        }
        @if told < rejects.len() {
            p.muted { "Rows that went no further: " @for (i, (reason, n)) in reasons.iter().enumerate() { @if i > 0 { ", " } (thousands(*n)) " " (reason.label()) } "." }
        }
    }
}

fn road_types(context: &Context) -> Markup {
    let tables = &context.suite.selection.tables;
    let most = tables.road_types.iter().map(|(_, n)| *n).max().unwrap_or(0);
    html! {
        table.plain {
            caption.hidden-text { "Usable records by road type" }
            tbody { @for (road, n) in &tables.road_types {
                tr { th scope="row" { (road.label()) } td.right.number { (thousands(*n)) } td.bar-cell { (parts::bar(parts::share(*n, most), "plain")) } }
            } }
        }
        p.muted { (words::count(tables.work_zone, "record")) " in work zones; the largest template has " (thousands(tables.largest_template)) "." }
    }
}

fn movements(context: &Context) -> Markup {
    let tables = &context.suite.selection.tables;
    let most = tables.movements.iter().flat_map(|(_, row)| row).copied().max().unwrap_or(0);
    let by_sv = |column: usize| tables.movements.iter().map(|(_, row)| row[column]).sum::<usize>();
    let sv: Vec<usize> = (0..tables.sv_movements.len()).filter(|column| by_sv(*column) > 0).collect();
    let cp = || tables.movements.iter().filter(|(_, row)| row.iter().any(|n| *n > 0));
    let nobody = tables.sv_movements.len() - sv.len() + tables.movements.len() - cp().count();
    html! {
        .table-wrap { table.matrix.small[sv.len() > 4] {
            caption { "Rows: crash partner (CP). Columns: subject vehicle (SV)." }
            thead { tr { td {} @for column in &sv { th scope="col" { "SV " (tables.sv_movements[*column].label().to_lowercase()) } } } }
            tbody { @for (cp, row) in cp() {
                tr {
                    th scope="row" { "CP " (cp.label().to_lowercase()) }
                    @for n in sv.iter().map(|column| row[*column]) { td.number.(parts::heat(n, most)) { (thousands(n)) } }
                }
            } }
        } }
        @if nobody > 0 { p.muted { "Left out: " (words::count(nobody, "movement")) " of SV or CP that no record has." } }
    }
}

fn templates(context: &Context) -> Markup {
    let selection = &context.suite.selection;
    let most = selection.templates.iter().map(|count| count.records).max().unwrap_or(0);
    // A suite of accounts picks incidents, and fills no table of templates.
    let by_account = context.suite.accounts.is_some();
    let unpicked = selection.templates.iter().filter(|count| count.picks == 0).count();
    html! {
        @if by_account && unpicked > 0 { p.muted { "Templates with a scenario; left out: " (words::count(unpicked, "template")) " of records of which none was picked." } }
        .table-wrap {
            table.plain.sortable {
                caption.hidden-text { "Observed templates, most frequent first" }
                thead { tr {
                    @for name in ["#", "Road", "SV (ego)", "CP (partner)", "Work zone"] { th scope="col" { (name) } }
                    th.right scope="col" { "Records" } td {} th.right scope="col" { "Picks" } th scope="col" { "Scenarios" }
                } }
                tbody { @for (order, count) in selection.templates.iter().enumerate().filter(|(_, count)| count.picks > 0 || !by_account) {
                    @let t = count.template;
                    tr {
                        td.number { (order + 1) }
                        td { (t.road.label()) } td { (t.sv.label()) } td { (t.cp.label()) }
                        td { @if t.work_zone { "yes" } @else { span.muted { "no" } } }
                        td.right.number { (thousands(count.records)) }
                        td.bar-cell { (parts::bar(parts::share(count.records, most), "plain")) }
                        td.right.number { (count.picks) }
                        td {
                            @let cases: Vec<(usize, &CaseRow)> = context.suite.cases.iter().enumerate().filter(|(_, case)| case.template == t).collect();
                            @for (position, case) in cases.iter().take(LONGEST_LIST) {
                                a.tag href={ "#" (anchor::anchor(&case.scenario_id)) } title=(words::clean(&case.scenario_id, 80)) { (position + 1) } " "
                            }
                            @if cases.len() > LONGEST_LIST { "and " (cases.len() - LONGEST_LIST) " more" }
                            @if count.picks == 0 { span.chip.bad { "no pick" } }
                        }
                    }
                } }
            }
        }
    }
}
