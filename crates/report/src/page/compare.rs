//! Faithfulness and metrics of a case, the run as designed beside the tuned one.

use super::{Case, parts, zones};
use crate::view::{RunNames, RunView};
use crate::words;
use maud::{Markup, html};
use recrash_model::metrics::{Check, PartnerMetrics};

/// The checks of faithfulness of every run.
pub fn checks(case: Case) -> Markup {
    let runs = case.view.runs();
    html! {
        p.muted { "What the report says, checked against what was driven. It is computed from the paths, never from the scenario's labels." }
        @if runs.is_empty() { p.empty { "It was not run." } }
        @if !case.view.assumed.is_empty() {
            p { "Chosen, as the report tells nothing of it at the contact: " (case.view.assumed.iter().map(|assumed| words::clean(assumed, 200).into_owned()).collect::<Vec<_>>().join("; ")) "." }
        }
        .columns {
            @for (name, run) in &runs {
                div {
                    h2 { (words::capital(name)) @if is_held(case, name) { " " (parts::faithful_chip(Some(&run.run.judgement), case.row.origin.as_ref())) } }
                    .table-wrap { table.plain {
                        thead { tr { th scope="col" { "Check" } th scope="col" { "Expected" } th scope="col" { "Observed" } th scope="col" { "Result" } } }
                        tbody { @for check in &run.verdict.checks { (check_row(check)) } }
                    } }
                    @for doubt in run.verdict.failures().filter_map(|check| check.kind.doubt()) { p.muted { (doubt) } }
                    @if run.verdict.checks.is_empty() { p.empty { "Nothing was checked." } }
                }
            }
        }
    }
}

/// Whether this run is held against the record; what the system under test does is its own.
fn is_held(case: Case, name: &str) -> bool {
    case.row.account.is_none() || RunNames::is_recorded(name)
}

fn check_row(check: &Check) -> Markup {
    html! {
        tr {
            th scope="row" { (check.kind.label()) }
            td { (parts::text_or(Some(&check.expected), "the record says nothing about it")) }
            td { (parts::text_or(Some(&check.observed), "the run shows nothing about it")) }
            td { (parts::check_chip(check.result)) }
        }
    }
}

/// The metrics of every run, the contact zones, and the findings.
pub fn metrics(case: Case) -> Markup {
    let runs = case.view.runs();
    if runs.is_empty() {
        return html! { p.empty { "It was not run." } };
    }
    html! {
        .columns {
            div {
                .table-wrap { table.plain {
                    caption.hidden-text { "Metrics, run by run" }
                    thead { tr { th scope="col" { "Metric" } @for (name, _) in &runs { th scope="col" { (words::capital(name)) } } } }
                    tbody { (ego_lines(&runs)) }
                    @for (actor, id) in partner_ids(&runs) { tbody { (partner_lines(&runs, actor, id)) } }
                } }
            }
            div {
                h2 { "Contact zones" }
                (zones::zones(case))
                h2 { "Findings" }
                @for (name, run) in &runs {
                    h3 { (words::capital(name)) }
                    @if run.findings.is_empty() { p.empty { "None." } }
                    ul.findings-list { @for finding in &run.findings {
                        li { (parts::finding_chip(finding.kind)) " " (words::clean(&finding.sentence, 300)) span.at { " at " } (parts::quantity(Some(finding.time_s), 1, "s", "")) }
                    } }
                }
            }
        }
    }
}

/// How each run ended, and how the ego drove.
fn ego_lines(runs: &[(&str, &RunView)]) -> Markup {
    html! {
        (line("Ended by", runs, |run| html! { (run.metrics.termination.label()) span.at { " at " } (parts::quantity(Some(run.metrics.duration_s), 1, "s", "")) }))
        (line("Contact", runs, |run| match &run.metrics.contact {
            Some(c) => html! { (c.kind.label()) " with " (words::clean(&c.id, 40)) span.at { " at " } (parts::quantity(Some(c.time_s), 2, "s", "")) },
            None => parts::missing("no contact with a road user"),
        }))
        (line("Contact speeds", runs, |run| match &run.metrics.contact {
            Some(c) => html! {
                "ego " (parts::quantity(Some(c.ego_speed_mps), 1, "m/s", "")) ", other " (parts::quantity(Some(c.other_speed_mps), 1, "m/s", ""))
                ", relative " (parts::quantity(Some(c.relative_speed_mps), 1, "m/s", ""))
            },
            None => parts::missing("no contact"),
        }))
        (line("Ego: hardest braking, by its brake", runs, |run| parts::timed(Some(run.metrics.ego.max_deceleration), 1, "m/s\u{b2}", "")))
        (line("Ego: braking with nothing in the way", runs, |run| parts::timed(run.metrics.ego.phantom_braking, 1, "m/s\u{b2}", "it never did")))
        (line("Ego: reversals in the window", runs, |run| html! { (run.metrics.ego.max_reversals) }))
        (line("Ego: farthest beyond its lane", runs, |run| parts::timed(Some(run.metrics.ego.max_lane_departure), 2, "m", "")))
        (line("Ego: mean speed", runs, |run| parts::quantity(Some(run.metrics.ego.mean_speed_mps), 1, "m/s", "")))
        (line("Ego: distance", runs, |run| parts::quantity(Some(run.metrics.ego.distance_m), 1, "m", "")))
        (line("Obstacles touched", runs, |run| html! { (run.metrics.obstacles_hit.len()) span.muted { " of " (run.metrics.obstacle_gaps.len()) } }))
    }
}

/// How near the ego and a partner came to each other.
fn partner_lines(runs: &[(&str, &RunView)], actor: usize, id: &str) -> Markup {
    html! {
        tr.group { th scope="rowgroup" colspan=(1 + runs.len()) { "Ego and " (words::clean(id, 40)) } }
        (partner_line("Least box gap", runs, actor, |p| parts::timed(Some(p.min_gap), 2, "m", "")))
        (partner_line("Least distance of the centres", runs, actor, |p| parts::timed(Some(p.min_centre_distance), 2, "m", "")))
        (partner_line("Least TTC", runs, actor, |p| parts::timed(p.min_ttc, 2, "s", "they were never on a course to touch")))
        (partner_line("PET", runs, actor, |p| parts::timed(p.pet, 2, "s", "no place was crossed by both, one after the other")))
        (partner_line("Greatest DRAC", runs, actor, |p| parts::timed(p.max_drac, 1, "m/s\u{b2}", "the ego did not close in on it from behind")))
        (partner_line("Greatest required deceleration", runs, actor, |p| parts::timed(p.max_required_deceleration, 1, "m/s\u{b2}", "the ego did not follow it, or had no need to brake for it")))
        (partner_line("Least time headway", runs, actor, |p| parts::timed(p.min_headway, 2, "s", "the ego did not follow it")))
    }
}

/// Every partner that a run measured, once.
fn partner_ids<'a>(runs: &[(&str, &'a RunView)]) -> Vec<(usize, &'a str)> {
    let mut ids: Vec<(usize, &str)> = Vec::new();
    for partner in runs.iter().flat_map(|(_, run)| &run.metrics.partners) {
        if !ids.iter().any(|(actor, _)| *actor == partner.actor) {
            ids.push((partner.actor, &partner.id));
        }
    }
    ids
}

fn line(name: &str, runs: &[(&str, &RunView)], of: impl Fn(&RunView) -> Markup) -> Markup {
    html! { tr { th scope="row" { (name) } @for (_, run) in runs { td { (of(run)) } } } }
}

fn partner_line(name: &str, runs: &[(&str, &RunView)], actor: usize, of: impl Fn(&PartnerMetrics) -> Markup) -> Markup {
    line(name, runs, |run| match run.metrics.partners.iter().find(|partner| partner.actor == actor) {
        Some(partner) => of(partner),
        None => parts::missing("it took no part in this run"),
    })
}
