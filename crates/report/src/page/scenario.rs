//! The search over a case's numbers, and its scenario files.

use super::{icon, parts};
use crate::view::CaseView;
use crate::words::{self, fixed};
use maud::{Markup, html};
use recrash_model::tuning::{Parameter, TuneLog};

/// The tune log: how the search went, and what may move.
pub fn tuning(case: &CaseView) -> Markup {
    let Some(log) = &case.tune_log else {
        return html! { p.empty { "It was not tuned." } };
    };
    let untuned = if case.account.is_some() { "as reconstructed" } else { "as designed" };
    let kept = log.points.iter().find(|point| point.number == log.best);
    let refused = log.points.iter().filter(|point| !point.score.refused.is_empty()).count();
    let failed = log.points.iter().filter(|point| point.score.failed && point.score.refused.is_empty()).count();
    html! {
        p { "The search " b { (words::clean(&log.searcher, 80)) } " tried " (words::count(log.points.len(), "point")) " (seed " (log.seed) "): "
            (failed) " made the ego fail, " (refused) " were refused. "
            @if log.best == 0 { "None was better than the scenario " (untuned) "." } @else { "Point " b { (log.best) } " was kept." } }
        .columns {
            figure.tune-figure {
                figcaption { b { "Objective by point" } " " span.muted { "least box gap plus penalties, m; smaller is worse for the ego" } }
                p.plot-key { span.key.point { "passes" } span.key.failed { "fails" } span.key.refused { "refused" } span.key.best { "best so far" } span.key.kept { "kept" } }
                svg.tune-plot role="application" tabindex="0" aria-label="Objective of each point; arrow keys go from point to point" {}
                p.tune-detail.muted role="status" aria-live="polite" { "Point at a mark, or put the focus on the plot and use the arrow keys." }
            }
            .table-wrap { table.plain.tuning {
                caption.hidden-text { "Numbers that may move" }
                thead { tr { th scope="col" { "Number" } th.right scope="col" { "From" } th.right scope="col" { "To" } th.right scope="col" { (words::capital(untuned)) } th.right scope="col" { "Kept" } th scope="col" { "In its bounds" } } }
                tbody { @for (i, parameter) in log.parameters.iter().enumerate() { (parameter_row(parameter, kept.and_then(|point| point.values.get(i)).copied())) } }
            } }
        }
        @if log.parameters.is_empty() { p.empty { "No number may move." } }
        (refusals(log))
    }
}

fn parameter_row(parameter: &Parameter, kept: Option<f64>) -> Markup {
    let decimals = if parameter.integer { 0 } else { 2 };
    let number = |value: f64| html! { @match fixed(value, decimals) { Some(text) => (text), None => (parts::missing("the value is not a finite number")) } };
    let width = parameter.max - parameter.min;
    let place = |value: f64| {
        fixed(4.0 + 92.0 * if width > 0.0 { ((value - parameter.min) / width).clamp(0.0, 1.0) } else { 0.5 }, 1)
            .unwrap_or_default()
    };
    html! {
        tr {
            th scope="row" { code { (words::clean(&parameter.pointer, 120)) } " " span.muted { (words::clean(&parameter.unit, 20)) } .muted.small { (words::clean(&parameter.reason, 300)) } }
            td.right.number { (number(parameter.min)) } td.right.number { (number(parameter.max)) }
            td.right.number { (number(parameter.start)) }
            td.right.number { @match kept { Some(value) => b { (number(value)) }, None => (parts::missing("the log does not hold the point that was kept")) } }
            td { svg.range viewBox="0 0 100 14" aria-hidden="true" {
                line.axis x1="4" x2="96" y1="7" y2="7" {}
                @if let Some(value) = kept { line.change x1=(place(parameter.start)) x2=(place(value)) y1="7" y2="7" {} }
                circle.before cx=(place(parameter.start)) cy="7" r="4" {}
                @if let Some(value) = kept { circle.after cx=(place(value)) cy="7" r="4.2" {} }
            } }
        }
    }
}

fn refusals(log: &TuneLog) -> Markup {
    let mut reasons: Vec<(&str, usize)> = Vec::new();
    for reason in log.points.iter().flat_map(|point| &point.score.refused) {
        match reasons.iter_mut().find(|(known, _)| known == reason) {
            Some((_, n)) => *n += 1,
            None => reasons.push((reason, 1)),
        }
    }
    reasons.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
    html! {
        @if !reasons.is_empty() {
            details open[reasons.len() <= 6] {
                summary { "Why points were refused (" (words::count(reasons.len(), "reason")) ")" }
                ul.flow { @for (reason, n) in reasons.iter().take(40) { li { span.number { (n) "\u{d7} " } (words::clean(reason, 300)) } } }
            }
        }
    }
}

/// The scenario files, and the commands that run them.
pub fn files(case: &CaseView) -> Markup {
    let runs = case.runs();
    html! {
        @if runs.is_empty() { p.empty { "No scenario was run, so there is no file to show." } }
        .columns {
            @for (order, (name, run)) in runs.iter().enumerate() {
                @let json = serde_json::to_string_pretty(&run.scenario).unwrap_or_default();
                div {
                    h2 { (words::capital(name)) }
                    p.muted { "Run it again, in the folder of the suite:" }
                    (parts::command(&run.rerun_command))
                    p.muted.small { "Simulated by " (words::clean(&run.rollout.simulator, 60)) " with " (words::clean(&run.rollout.ego, 60)) "; states " code { (words::clean(&run.rollout.state_hash, 64)) } }
                    details.json open[order + 1 == runs.len()] {
                        summary { "Scenario JSON" }
                        .code-box {
                            button.small type="button" data-copy="" title="Copy" aria-label={ "Copy the scenario JSON, " (name) } { (icon::copy()) }
                            pre tabindex="0" { code { (words::clean(&json, 60_000)) } }
                        }
                    }
                }
            }
        }
    }
}
