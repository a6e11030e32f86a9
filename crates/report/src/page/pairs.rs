//! The page of runs side by side: tables, then one replay after the other.

use super::{Cases, case, document, parts};
use crate::pairs::{PairView, PairsView, TableView};
use crate::{data, words};
use maud::{Markup, PreEscaped, html};
use serde_json::json;

const SCRIPT: &str = concat!(
    "'use strict';\n(() => {\n",
    include_str!("../../assets/data.js"),
    include_str!("../../assets/scene.js"),
    include_str!("../../assets/plots.js"),
    include_str!("../../assets/replay.js"),
    include_str!("../../assets/pairs.js"),
    "})();\n",
);

/// The page.
pub fn render(view: &PairsView) -> String {
    let limits = json!({ "minGap": view.criteria.min_gap_m, "hardBraking": view.criteria.hard_braking_mps2 });
    let title = words::clean(&view.title, 200);
    let body = html! {
        main #main {
            header.page-head {
                h1 { (title) }
                (parts::command(&view.command))
            }
            @for table in &view.tables { (table_of(table)) }
            @if view.pairs.len() > 1 { (index(view)) }
            @if let Some(more) = &view.more {
                details { summary { (words::clean(&more.caption, 200)) } (rows_of(more)) }
            }
            @for (position, pair) in view.pairs.iter().enumerate() { (section(view, position, pair)) }
        }
    };
    document(&title, &view.generated_by, &body, &limits, SCRIPT, Cases::Inside)
}

fn table_of(table: &TableView) -> Markup {
    html! {
        h2 { (words::clean(&table.caption, 200)) }
        (rows_of(table))
        @if table.rows.is_empty() { p.empty { "None." } }
    }
}

/// What is played below, each with a link.
fn index(view: &PairsView) -> Markup {
    html! {
        h2 { "Played below" }
        .table-wrap { table.plain {
            caption.hidden-text { "Scenarios that are played on this page" }
            thead { tr { th scope="col" { "scenario" } th scope="col" { "what is different" } } }
            tbody { @for (position, pair) in view.pairs.iter().enumerate() {
                tr {
                    td { a href={ "#pair-" (position) } { (words::clean(&pair.title, 120)) } }
                    td { (words::clean(&pair.remark, 400)) }
                }
            } }
        } }
    }
}

fn rows_of(table: &TableView) -> Markup {
    html! {
        .table-wrap { table.plain {
            caption.hidden-text { (words::clean(&table.caption, 200)) }
            thead { tr { @for name in &table.header { th scope="col" { (words::clean(name, 80)) } } } }
            tbody { @for row in &table.rows { tr { @for cell in row { td { (words::clean(cell, 400)) } } } } }
        } }
    }
}

fn section(view: &PairsView, position: usize, pair: &PairView) -> Markup {
    let id = format!("pair-{position}");
    let names = [words::capital(&view.names[0]), words::capital(&view.names[1])];
    html! {
        section.case id=(id) data-case=(position) aria-labelledby={ (id) "-title" } {
            h2 id={ (id) "-title" } { (words::clean(&pair.title, 120)) }
            p.case-what { (words::clean(&pair.remark, 600)) }
            (case::stage(&[("before", names[0].clone(), true), ("after", names[1].clone(), pair.second.is_some())], false))
            script type="application/json" id={ "case-data-" (position) } { (PreEscaped(data::embed(&data::pair(pair)))) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_escaped_and_nothing_may_load() {
        let bad = "</script><img src=x onerror=alert(1)>".to_owned();
        let view = PairsView {
            title: bad.clone(),
            generated_by: bad.clone(),
            command: bad.clone(),
            names: [bad.clone(), bad.clone()],
            criteria: criteria(),
            tables: vec![TableView { caption: bad.clone(), header: vec![bad.clone()], rows: vec![vec![bad.clone()]] }],
            pairs: Vec::new(),
            more: Some(TableView { caption: bad.clone(), header: vec![bad.clone()], rows: vec![vec![bad.clone()]] }),
        };
        let page = render(&view);
        assert!(!page.contains("<img") && page.contains("&lt;img"), "{page}");
        assert!(page.contains("default-src 'none'"));
        // One block of data, and two scripts: the first words and the rest.
        assert_eq!(page.matches("<script").count(), 3);
    }

    fn criteria() -> recrash_model::profile::FailureCriteria {
        recrash_model::profile::FailureCriteria {
            min_gap_m: 2.0,
            hard_braking_mps2: 4.0,
            phantom_braking_mps2: 3.0,
            oscillation_reversals: 4,
            oscillation_window_s: 5.0,
            lane_departure_m: 0.3,
        }
    }

    #[test]
    fn the_script_cannot_close_its_element() {
        assert!(!SCRIPT.contains("</script") && !SCRIPT.contains("<!--"));
    }
}
