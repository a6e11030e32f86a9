//! The first view: what this is, the headline numbers, and the table of scenarios.

use super::parts::{self, missing};
use super::{Context, icon};
use crate::summary::Result;
use crate::view::{CaseView, RunView};
use crate::words::{self, fixed, thousands};
use maud::{Markup, html};
use recrash_model::metrics::Answer;
use recrash_model::metrics::FindingKind;
use recrash_model::narrative::Origin;

/// Greatest gap on the scale of the table's gap chart. [m]
const CHART_M: f64 = 10.0;

/// The overview.
pub fn section(context: &Context) -> Markup {
    let suite = context.suite;
    html! {
        section.page #overview aria-labelledby="overview-title" {
            .page-head {
                h1 #overview-title { (words::clean(&suite.title, 200)) }
                p.lead { (sentence(context)) }
            }
            @if suite.sample {
                p.banner role="note" {
                    (icon::bang())
                    span { strong { "Built-in sample. " } "These records were written for recrash, with the paper's template counts. No real crash is shown. Give " code { "--records FILE" } " to use NHTSA's file." }
                }
            }
            (tiles(context))
            h2 { "Scenarios" }
            @if suite.cases.is_empty() { p.empty { "The suite has no scenario." } } @else { (controls()) (table(context)) }
            .two {
                div { h3 { "Make this suite again" } (parts::command(&suite.command)) }
                div {
                    h3 { "Made with" }
                    p.muted {
                        "Profile " b { (words::clean(&suite.profile.name, 60)) } ", ego " b { (words::clean(&suite.ego, 60)) }
                        ", simulator " b { (words::clean(&suite.simulator, 60)) } ", agents " b { (words::clean(&suite.agents, 60)) }
                        ", seed " b { (suite.seed) } ". " a href="#about" { "Files, hashes and settings" }
                    }
                }
            }
        }
    }
}

/// What was found, in one or two sentences.
fn sentence(context: &Context) -> Markup {
    let (suite, s) = (context.suite, &context.summary);
    html! {
        (words::count(s.cases, "scenario")) " from " (words::count(s.usable, "usable crash record")) ", run with "
        b { (words::clean(&suite.ego, 60)) } ". It fails " b { (s.failed_before) } " of " (s.ran) " as designed and "
        b { (s.failed_after) } " of " (s.ran) " after tuning"
        @if s.passed_before() > 0 {
            "; of the " (s.passed_before()) " it passed at first, tuning brought the partner closer in " (s.closer)
        }
        ". A failure is a contact, a box gap below " (fixed(suite.profile.failure.min_gap_m, 1).unwrap_or_default())
        "\u{a0}m, leaving the road, or getting stuck."
    }
}

fn tiles(context: &Context) -> Markup {
    let (s, coverage) = (&context.summary, &context.suite.selection.coverage);
    let gap = |value: Option<f64>| value.and_then(|value| fixed(value, 2)).unwrap_or_else(|| "\u{2013}".to_owned());
    let share = |part: usize, whole: usize| if whole == 0 { 0.0 } else { part as f64 / whole as f64 };
    let tile = |name: &str, value: Markup, note: Markup, bar: Option<(f64, &str)>| {
        html! {
            .tile {
                dt { (name) }
                dd.value { (value) }
                @if let Some((share, class)) = bar { dd.tile-bar { (parts::bar(share, class)) } }
                dd.note { (note) }
            }
        }
    };
    let arrow = || html! { span.arrow { "\u{2192}" } };
    html! {
        dl.tiles {
            (tile(
                "Records",
                html! { (thousands(s.rows)) (arrow()) (thousands(s.usable)) },
                html! { "rows read, records usable" },
                Some((share(s.usable, s.rows), "plain")),
            ))
            (tile(
                "Templates covered",
                html! { (coverage.templates_covered) span.of { " of " (coverage.templates_observed) } },
                html! { "observed; the profile can express " (coverage.templates_possible) },
                Some((share(coverage.templates_covered, coverage.templates_observed), "good")),
            ))
            (tile(
                "Scenarios",
                html! { (s.cases) },
                html! {
                    (s.origins[0]) " tell their own record, " (s.origins[1]) " another one, " (s.origins[2]) " are invented"
                    @if s.refused > 0 { ", " b { (s.refused) " refused" } }
                },
                None,
            ))
            (tile(
                "Faithful",
                html! { (s.faithful) span.of { " of " (s.cases) } },
                html! { "checked from the paths driven" },
                Some((share(s.faithful, s.cases), "good")),
            ))
            (tile(
                "Ego fails",
                html! { (s.failed_before) (arrow()) (s.failed_after) span.of { " of " (s.ran) } },
                html! {
                    "as designed, after tuning"
                    @for (class, count) in &s.classes { br; (count) " " (class.label()) }
                },
                Some((share(s.failed_after, s.ran), "bad")),
            ))
            (tile(
                "Median least gap",
                html! { (gap(s.median_before_m)) (arrow()) (gap(s.median_after_m)) span.of { " m" } },
                html! { "as designed, after tuning" },
                None,
            ))
        }
    }
}

fn controls() -> Markup {
    html! {
        .controls {
            label { span.hidden-text { "Search scenarios" } input #case-search type="search" placeholder="Search id, template, record, finding  ( / )"; }
            fieldset.segments {
                legend.hidden-text { "Show" }
                @for (value, name) in [("all", "All"), ("failed", "Fails"), ("passed", "Passes"), ("unfaithful", "Not faithful"), ("other", "Another record"), ("invented", "Invented"), ("refused", "Refused")] {
                    label { input type="radio" name="case-filter" value=(value) checked[value == "all"]; span { (name) } }
                }
            }
            span #case-count.muted role="status" {}
        }
    }
}

fn table(context: &Context) -> Markup {
    let heads = [
        ("Scene", false, "at the least gap of the last run"),
        ("Scenario", true, "its number and template"),
        ("Records", true, "the record it came from, and how many the cluster holds"),
        ("Least gap", true, "box to box: hollow as designed, filled after tuning"),
        ("As designed", true, "first shot: least gap and verdict"),
        ("Tuned", true, "after tuning: least gap and verdict"),
        ("Collision", true, "kind by geometry, in the last run"),
        ("Findings", true, "in the last run"),
        ("Faithful", true, "computed from the paths driven in the last run"),
    ];
    html! {
        .table-wrap {
            table #cases.cases {
                caption.hidden-text { "Scenarios, one a row. The buttons in the head sort." }
                thead { tr {
                    @for (name, sorts, what) in heads {
                        th scope="col" title=(what) { @if sorts { button.sort type="button" { (name) } } @else { (name) } }
                    }
                } }
                tbody { @for (position, case) in context.suite.cases.iter().enumerate() { (row(context, position, case)) } }
            }
        }
        p #case-none.empty hidden { "No scenario matches. " button type="button" #case-reset { "Show all" } }
    }
}

fn row(context: &Context, position: usize, case: &CaseView) -> Markup {
    let suite = context.suite;
    let last = case.last_run();
    let result = Result::of(last);
    let faithful = last.map(|run| run.faithful());
    let origin = case.narrative.as_ref().map(|narrative| &narrative.origin);
    let mut tags = vec![match result {
        Result::Failed => "failed",
        Result::Passed => "passed",
        Result::Missing => "missing",
    }];
    for (tag, holds) in [
        ("unfaithful", faithful == Some(Answer::No)),
        ("other", matches!(origin, Some(Origin::Other { .. }))),
        ("invented", matches!(origin, Some(Origin::Invented { .. }))),
        ("refused", case.refused.is_some()),
    ] {
        if holds {
            tags.push(tag);
        }
    }
    let members = suite.cluster(case).map_or(0, |cluster| cluster.members.len());
    let sort_gap =
        |run: Option<&RunView>| run.and_then(|run| run.min_gap_m()).and_then(|gap| fixed(gap, 4)).unwrap_or_default();
    let contact = last.and_then(|run| run.metrics.contact.as_ref());
    let kinds = last.map(|run| run.finding_kinds()).unwrap_or_default();
    let anchor = context.anchors.case(position);
    let not_run = case.refused.as_deref().unwrap_or("it was not run");
    html! {
        tr data-tags=(tags.join(" ")) {
            td { a.thumb-link href={ "#" (anchor) } tabindex="-1" aria-hidden="true" { canvas.thumb width="192" height="120" data-case=(position) {} } }
            th scope="row" data-sort=(position) {
                a.case-link href={ "#" (anchor) } { (words::clean(&case.scenario_id, 80)) }
                .muted { (words::template(&case.template)) }
                @if let Some(why) = &case.refused { .refused-why { (icon::cross()) "refused: " (words::clean(why, 200)) } }
            }
            td data-sort=(members) {
                @match suite.case_records(case).next() {
                    Some(pick) => span.mono { (words::clean(&pick.id.to_string(), 40)) },
                    None => (missing("the suite names no record")),
                }
                .muted {
                    @if members > 0 { "cluster of " (members) }
                    @if let Some(origin) = origin.filter(|origin| **origin != Origin::Own) {
                        br;
                        span.chip.odd { (icon::bang()) (origin.label()) }
                    }
                }
            }
            td data-sort=(sort_gap(last)) { (gap_chart(case, suite.profile.failure.min_gap_m)) }
            (gap_cell(case.before.as_ref(), not_run, &sort_gap(case.before.as_ref())))
            (gap_cell(case.after.as_ref(), if last.is_some() { "tuning kept the scenario as designed" } else { not_run }, &sort_gap(case.after.as_ref())))
            td data-sort=(contact.map_or("", |contact| contact.kind.label())) {
                @match contact { Some(contact) => (contact.kind.label()), None => (missing("no contact")) }
            }
            td.findings data-sort=(finding_weight(&kinds)) {
                @if let Some(triage) = &case.triage { (parts::class_chip(triage.class)) " " }
                @for kind in &kinds { (parts::finding_chip(*kind)) " " }
                @if kinds.is_empty() { (missing(if last.is_some() { "no finding" } else { not_run })) }
            }
            td data-sort=(match faithful { Some(Answer::Yes) => "3", Some(Answer::Unchecked) => "2", Some(Answer::No) => "1", None => "" }) { (parts::faithful_chip(last)) }
        }
    }
}

/// Failures count more than odd behaviour.
fn finding_weight(kinds: &[FindingKind]) -> usize {
    kinds.iter().map(|kind| if kind.is_failure() { 100 } else { 1 }).sum()
}

fn gap_cell(run: Option<&RunView>, why: &str, sort: &str) -> Markup {
    html! {
        td data-sort=(sort) {
            @match run {
                Some(run) => {
                    (parts::quantity(run.min_gap_m(), 2, "m", "no scripted partner took part"))
                    " " (parts::result_chip(Result::of(Some(run))))
                },
                None => (missing(why)),
            }
        }
    }
}

/// Least gap as designed and tuned on one scale, with the profile's threshold.
fn gap_chart(case: &CaseView, threshold_m: f64) -> Markup {
    let at = |gap: f64| 8.0 + 124.0 * (gap / CHART_M).clamp(0.0, 1.0);
    let place = |gap: f64| fixed(at(gap), 1).unwrap_or_default();
    let before = case.before.as_ref().and_then(|run| run.min_gap_m());
    let after = case.after.as_ref().and_then(|run| run.min_gap_m());
    if before.or(after).is_none() {
        return missing("no gap was measured");
    }
    let told = |gap: Option<f64>| gap.and_then(|gap| fixed(gap, 2)).map_or("none".to_owned(), |gap| format!("{gap} m"));
    let label = format!("Least gap as designed {}, tuned {}; failure below {threshold_m} m", told(before), told(after));
    html! {
        svg.gap-chart viewBox="0 0 140 26" role="img" aria-label=(label) {
            title { (label) }
            rect.fail-zone x="8" y="3" width=(fixed(at(threshold_m) - 8.0, 1).unwrap_or_default()) height="20" {}
            line.axis x1="8" x2="132" y1="13" y2="13" {}
            line.threshold x1=(place(threshold_m)) x2=(place(threshold_m)) y1="3" y2="23" {}
            @if let (Some(before), Some(after)) = (before, after) {
                line.change x1=(place(before)) x2=(place(after)) y1="13" y2="13" {}
            }
            @if let Some(before) = before {
                @if before > CHART_M { path.before.beyond d="M128 8.5l8 4.5-8 4.5z" {} } @else { circle.before cx=(place(before)) cy="13" r="4.4" {} }
            }
            @if let Some(after) = after {
                @if after > CHART_M { path.after.beyond d="M128 8.5l8 4.5-8 4.5z" {} } @else { circle.after cx=(place(after)) cy="13" r="4.6" {} }
            }
        }
    }
}
