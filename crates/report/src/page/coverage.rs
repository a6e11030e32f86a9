//! What the picks cover: numbers, a grid of every template the profile can express, and the holes by name.

use super::{Context, parts};
use crate::words::{self, fixed, thousands};
use maud::{Markup, html};
use recrash_model::template::{RoadType, Template};

/// The numbers, the grid and the holes.
pub fn coverage(context: &Context) -> Markup {
    let c = &context.suite.selection.coverage;
    let share = |part: usize, whole: usize| {
        let percent = if whole == 0 { None } else { fixed(100.0 * part as f64 / whole as f64, 0) };
        html! { @if let Some(percent) = percent { span.muted { " (" (percent) "\u{a0}%)" } } }
    };
    html! {
        .two {
            table.plain {
                caption.hidden-text { "Coverage in numbers" }
                tbody {
                    tr { th scope="row" { "Observed templates with a pick whose crash is told" } td.number { (c.templates_covered) " of " (c.templates_observed) (share(c.templates_covered, c.templates_observed)) } }
                    tr { th scope="row" { "Templates the profile can express with such a pick" } td.number { (c.templates_covered) " of " (c.templates_possible) (share(c.templates_covered, c.templates_possible)) } }
                    tr { th scope="row" { "Records whose template has such a pick" } td.number { (thousands(c.records_covered)) " of " (thousands(c.records)) (share(c.records_covered, c.records)) } }
                    tr { th scope="row" { "Pairs of values with a pick" } td.number { (c.pairs.covered) " of " (c.pairs.observed) " observed, " (c.pairs.possible) " possible" } }
                }
            }
            table.plain {
                caption.hidden-text { "Distances in the clustering space" }
                tbody {
                    tr { th scope="row" { "Worst-served record to its nearest pick" } td.number { (parts::quantity(Some(c.radius), 2, "", "")) } }
                    tr { th scope="row" { "Mean record to its nearest pick" } td.number { (parts::quantity(Some(c.mean_distance), 2, "", "")) } }
                    tr { th scope="row" { "The same by narrative alone, worst" } td.number { (parts::quantity(Some(c.embedding_radius), 2, "", "")) } }
                    tr { th scope="row" { "The same by narrative alone, mean" } td.number { (parts::quantity(Some(c.embedding_mean_distance), 2, "", "")) } }
                }
            }
        }
        p.muted { "Distances have no unit: they are lengths in the space the clusters were made in. Smaller is better." }
        @if context.suite.accounts.is_none() { (grids(context)) }
        .two {
            (holes("Holes that records show: templates with records and no pick whose crash is told", &c.holes_observed, true))
            (holes("Holes no record shows: templates the profile can express and no record has", &c.holes_possible, false))
        }
        @if !c.pairs.holes_observed.is_empty() || !c.pairs.holes_possible.is_empty() {
            details { summary { "Pairs of values no pick has (" (c.pairs.holes_observed.len() + c.pairs.holes_possible.len()) ")" }
                ul.flow {
                    @for pair in &c.pairs.holes_observed { li { (pair) " \u{2013} seen in records" } }
                    @for pair in &c.pairs.holes_possible { li { (pair) } }
                }
            }
        }
    }
}

fn holes(name: &str, holes: &[Template], open: bool) -> Markup {
    html! {
        @if holes.is_empty() {
            p.empty { (name) ": none." }
        } @else {
            details open[open] { summary { (name) " (" (holes.len()) ")" } ul.flow { @for hole in holes { li { (words::template(hole)) } } } }
        }
    }
}

fn grids(context: &Context) -> Markup {
    let expresses = &context.suite.profile.expresses;
    let zones: &[bool] = if expresses.work_zone { &[false, true] } else { &[false] };
    html! {
        .grid-legend {
            span { span.cell.heat-3 { "9" span.dots { "\u{25cf}" } } " records, and one dot a scenario" }
            span { span.cell.hole { "3!" } " records and no scenario" }
            span { span.cell.heat-0 { "\u{b7}" } " no record" }
        }
        .grids { @for road in &expresses.road_types { @for zone in zones { (grid(context, *road, *zone)) } } }
    }
}

fn grid(context: &Context, road: RoadType, work_zone: bool) -> Markup {
    let selection = &context.suite.selection;
    let expresses = &context.suite.profile.expresses;
    let most = selection.templates.iter().map(|count| count.records).max().unwrap_or(0);
    html! {
        table.matrix.small {
            caption { (road.label()) @if work_zone { ", work zone" } }
            thead { tr { td {} @for sv in &expresses.sv_movements { th scope="col" title=(sv.label()) { "SV " (sv.slug()) } } } }
            tbody { @for cp in &expresses.cp_movements { tr {
                th scope="row" title=(cp.label()) { "CP " (cp.slug()) }
                @for sv in &expresses.sv_movements {
                    @let template = Template { road, sv: *sv, cp: *cp, work_zone };
                    @let found = selection.templates.iter().find(|count| count.template == template);
                    @match found {
                        Some(count) if count.picks > 0 => td.(parts::heat(count.records, most)) title={ (template) ": " (count.records) " records, " (count.picks) " scenarios" } {
                            (count.records) span.dots aria-label={ (count.picks) " scenarios" } { @for _ in 0..count.picks.min(8) { "\u{25cf}" } }
                        },
                        Some(count) => td.hole title={ (template) ": " (count.records) " records, no scenario" } { (count.records) "!" },
                        None => td.heat-0 title={ (template) ": no record" } { "\u{b7}" },
                    }
                }
            } } }
        }
    }
}
