//! One scenario: what it stands for, the replay with its plots, and tabs with everything behind it. It stands in a file of its
//! own.

use super::{Case, compare, icon, parts, scenario, severity, story, triage};
use crate::summary::Result;
use crate::view::{AccountRow, CaseContext, CaseRow, CaseView, RunView};
use crate::{anchor, data, words};
use maud::{Markup, html};
use serde_json::json;

/// The file of one case: one call of the one function that the page offers, with one JSON value. The markup in it is text
/// like any other, and nothing in it runs.
pub fn file(context: &CaseContext, view: &CaseView, row: &CaseRow) -> String {
    let case = Case { context: *context, row, view };
    let given = json!({
        "stem": anchor::stem(&row.scenario_id),
        "data": data::case(view),
        "markup": inside(case).into_string(),
    });
    format!("recrashCase({});\n", data::embed(&given))
}

/// What stands inside the section of a case.
fn inside(case: Case) -> Markup {
    let (view, row) = (case.view, case.row);
    let anchor = anchor::anchor(&row.scenario_id);
    let tabs: [(&str, &str, Markup); 6] = [
        ("story", "Record and narrative", story::story(case)),
        ("checks", "Faithfulness", compare::checks(case)),
        ("metrics", "Metrics", compare::metrics(case)),
        ("triage", "Other egos", triage::of_case(case)),
        ("tuning", "Tuning", scenario::tuning(view)),
        ("scenario", "Scenario file", scenario::files(view)),
    ];
    html! {
        (head(case, &anchor))
        @if let Some(why) = &view.refused {
            p.banner.bad role="note" { (icon::cross()) span { strong { "Refused. " } (words::clean(why, 600)) } }
        }
        @if view.before.is_some() || view.after.is_some() {
            (stage(&modes(view), view.reference.is_some()))
            (numbers(case))
            (severity::of_case(case))
        }
        .tabs {
            div role="tablist" aria-label="About this scenario" {
                @for (i, (name, label, _)) in tabs.iter().enumerate() {
                    button type="button" role="tab" id={ (anchor) "--" (name) "-tab" } aria-controls={ (anchor) "--" (name) } aria-selected=(i == 0) tabindex=(if i == 0 { "0" } else { "-1" }) { (label) }
                }
            }
            @for (name, _, content) in &tabs {
                div.tab-panel role="tabpanel" id={ (anchor) "--" (name) } aria-labelledby={ (anchor) "--" (name) "-tab" } tabindex="0" { (content) }
            }
        }
    }
}

/// The runs that the replay can show: how the scripts call them, their names, and whether they are there.
fn modes(view: &CaseView) -> Vec<(&'static str, String, bool)> {
    let names = view.names();
    let mut modes = vec![("before", words::capital(names.before), view.before.is_some())];
    if view.untuned.is_some() {
        modes.push(("untuned", words::capital(names.untuned), true));
    }
    if view.told_tuned.is_some() {
        modes.push(("toldTuned", words::capital(names.told_tuned), true));
    }
    modes.push(("after", words::capital(names.after), view.after.is_some()));
    modes
}

fn head(case: Case, anchor: &str) -> Markup {
    let (view, row) = (case.view, case.row);
    let last = view.last_run();
    html! {
        .case-head {
            h1 id={ (anchor) "-title" } { (words::clean(&row.scenario_id, 120)) }
            .chips {
                (parts::result_chip(Result::of(last.map(|run| &run.run.judgement))))
                @if let Some(triage) = &view.triage { (parts::class_chip(triage.class)) }
                @if row.account.as_ref().is_some_and(AccountRow::human_drove) {
                    span.chip.odd title="the record's vehicle; in the test the system under test drives from the handover on" { "human at the contact" }
                }
                (parts::faithful_chip(row.telling_run().map(|run| &run.judgement), row.origin.as_ref()))
                (parts::review_chip(row.review.as_ref()))
                @match row.situation_met() { Some(true) => span.chip.none { "situation met" }, Some(false) => span.chip.odd { "situation not met" }, None => "" }
                @if row.account.is_some() && row.found_by_tuning() { (parts::tuning_chip()) }
                @for kind in last.map(|run| run.finding_kinds()).unwrap_or_default() { (parts::finding_chip(kind)) }
                (parts::origin_chip(row.origin.as_ref(), row.told.as_ref()))
                (parts::edited_chip(&row.edited))
            }
            p.case-what {
                @if let Some(account) = &row.account { b { (account.crash_type.label()) } ", incident " span.mono { (words::clean(&account.incident, 40)) } " with " (words::count(account.reports, "report")) ", " }
                b { (words::template(&row.template)) }
                @if let Some(cluster) = case.context.cluster.filter(|cluster| !cluster.invented) {
                    @if case.row.account.is_none() { ", cluster " (cluster.number) " of " (words::count(cluster.members.len(), "record")) }
                    // By accounts a number would change with every new incident, and the pages of all behind it.
                    @else if cluster.members.len() > 1 { ", stands for " (words::count(cluster.members.len(), "record")) }
                }
                ". Tells " (words::clean(&words::provenance(row.origin.as_ref(), row.told.as_ref()), 400)) "."
                @if let Some(narrative) = &view.narrative { " " span.told { (words::clean(&narrative.text, 600)) } }
            }
        }
    }
}

/// Replay and plots of one or two runs, which the scripts fill: their names, which of them there are, and whether the
/// reference driver's run is there to be seen beside the last.
pub(super) fn stage(runs: &[(&str, String, bool)], reference: bool) -> Markup {
    html! {
        noscript { p.banner { "The replay and the plots need scripts. Every number is in the tables below." } }
        .stage {
            .replay role="group" aria-label="Replay, seen from above" {
                (replay_bar(runs, reference))
                .views tabindex="0" role="img" aria-label="Top-down picture of the run; the plots and tables hold the same in numbers" {
                    @for (run, name, _) in runs { figure.view data-run=(run) hidden { canvas {} figcaption { (name) } } }
                    @if reference { figure.view data-run="reference" hidden { canvas {} figcaption { "Ego \u{201c}reference\u{201d}" } } }
                }
                (transport())
            }
            (plots(runs))
        }
    }
}

/// Whether a run is there, and its name.
fn run_of<'a>(runs: &'a [(&str, String, bool)], run: &str) -> (bool, &'a str) {
    runs.iter().find(|(name, ..)| *name == run).map_or((false, ""), |(_, name, there)| (*there, name.as_str()))
}

/// What is shown, and how near.
fn replay_bar(runs: &[(&str, String, bool)], reference: bool) -> Markup {
    let mut modes: Vec<(&str, &str, bool)> =
        runs.iter().map(|(run, name, there)| (*run, name.as_str(), *there)).collect();
    modes.push(("both", "Side by side", run_of(runs, "before").0 && run_of(runs, "after").0));
    if reference {
        modes.push(("reference", "Ego \u{201c}reference\u{201d}", true));
    }
    html! {
        .replay-bar {
            fieldset.segments {
                legend.hidden-text { "Which run" }
                @for (value, name, there) in modes {
                    button type="button" data-mode=(value) aria-pressed="false" disabled[!there] title=[(!there).then_some("there is no such run")] { (name) }
                }
            }
            .grow {}
            fieldset.segments {
                legend.hidden-text { "Camera" }
                @for (value, name) in [("fit", "Fit"), ("follow", "Follow ego"), ("map", "Whole map")] {
                    button type="button" data-camera=(value) aria-pressed=(value == "fit") { (name) }
                }
            }
            .zoom {
                button.small type="button" data-act="zoom-out" title="Zoom out ( \u{2212} )" aria-label="Zoom out" { (icon::minus()) }
                button.small type="button" data-act="zoom-in" title="Zoom in ( + )" aria-label="Zoom in" { (icon::plus()) }
            }
        }
    }
}

/// Play, steps, events and speed.
fn transport() -> Markup {
    html! {
        .transport {
            button.small type="button" data-act="start" title="To the start ( Home )" aria-label="To the start" { (icon::to_start()) }
            button.small type="button" data-act="back" title="One step back ( \u{2190} )" aria-label="One step back" { (icon::step_back()) }
            button.play type="button" data-act="play" title="Play or pause ( Space )" aria-label="Play" { (icon::play_pause()) }
            button.small type="button" data-act="on" title="One step on ( \u{2192} )" aria-label="One step on" { (icon::step_on()) }
            button.small type="button" data-act="event-back" title="To the event before ( , )" aria-label="To the event before" { (icon::event_back()) }
            button.small type="button" data-act="event-on" title="To the next event ( . )" aria-label="To the next event" { (icon::event_on()) }
            .track {
                input.scrub type="range" min="0" max="1" step="0.1" value="0" aria-label="Time in the run";
                .marks role="group" aria-label="Events" {}
            }
            output.clock { "0.0 s" }
            button.small type="button" data-act="closest" title="To the least gap ( M )" aria-label="To the moment of the least gap" { (icon::closest()) }
            button.small type="button" data-act="loop" title="Repeat ( L )" aria-label="Repeat" aria-pressed="false" { (icon::repeat()) }
            label { span.hidden-text { "Speed" } select data-act="rate" {
                @for (value, name) in [("0.25", "\u{bc}\u{d7}"), ("0.5", "\u{bd}\u{d7}"), ("1", "1\u{d7}"), ("2", "2\u{d7}"), ("4", "4\u{d7}")] {
                    option value=(value) selected[value == "1"] { (name) }
                }
            } }
        }
    }
}

/// Gap, speed and acceleration over time.
fn plots(runs: &[(&str, String, bool)]) -> Markup {
    let ((is_first, first), (is_second, second)) = (run_of(runs, "before"), run_of(runs, "after"));
    html! {
        .plots aria-label="Values over time" role="group" {
            .plot-key {
                @if is_second { span.key.solid { (uncapital(second)) } @if is_first { span.key.dashed { (uncapital(first)) } } }
                @else { span.key.solid { (uncapital(first)) } }
                span.key.ego { "ego" } span.key.partner { "partner" } }
            @for (name, title, unit) in [("gap", "Gap to the partner", "m"), ("speed", "Speed", "m/s"), ("acceleration", "Acceleration", "m/s\u{b2}")] {
                figure.plot data-plot=(name) { figcaption { b { (title) } " " span.muted { (unit) } span.readout {} } svg role="img" aria-label={ (title) " over time" } {} }
            }
        }
    }
}

/// A name within a line: "As designed" is "as designed", and "MetaDrive" stays what it is.
fn uncapital(name: &str) -> String {
    let mut letters = name.chars();
    let rest_is_small = name.chars().skip(1).all(|letter| !letter.is_uppercase());
    match letters.next() {
        Some(letter) if rest_is_small => letter.to_lowercase().chain(letters).collect(),
        _ => name.to_owned(),
    }
}

/// The few numbers everybody looks for, before and after; the recorded driver's in the crash as reconstructed alone.
fn numbers(of: Case) -> Markup {
    let case = of.view;
    let last = case.last_run();
    let worst = |run: &RunView, of: fn(&recrash_model::metrics::PartnerMetrics) -> Option<f64>, least: bool| {
        let values = run.metrics.partners.iter().filter_map(of).filter(|value| value.is_finite());
        if least { values.min_by(f64::total_cmp) } else { values.max_by(f64::total_cmp) }
    };
    let pair = |name: &str, unit: &str, decimals: usize, why: &str, of: &dyn Fn(&RunView) -> Option<f64>| {
        html! {
            .tile {
                dt { (name) }
                dd.value {
                    @if let Some(before) = &case.before { (parts::quantity(of(before), decimals, unit, why)) }
                    @if let Some(untuned) = &case.untuned { @if case.before.is_some() { " " span.arrow { "\u{2192}" } " " } (parts::quantity(of(untuned), decimals, unit, why)) }
                    @if let Some(after) = &case.after { @if case.before.is_some() { " " span.arrow { "\u{2192}" } " " } (parts::quantity(of(after), decimals, unit, why)) }
                }
            }
        }
    };
    let told_tuned = case.names().told_tuned;
    let names: Vec<&str> = case.runs().into_iter().map(|(name, _)| name).filter(|name| *name != told_tuned).collect();
    let note = last.and_then(|run| words::gap_note(run, of.context.min_gap_m, case.account.is_some()));
    html! {
        @if let Some(note) = note { p.muted.small { "Least gap of the last run: " (note) "." } }
        @if names.len() > 1 { p.muted.small { "Each value: " (names.join(" \u{2192} ")) "." } }
        dl.tiles.compact {
            (pair("Least gap", "m", 2, "nobody else and no thing took part", &|run: &RunView| run.min_gap_m()))
            (pair("Least TTC", "s", 2, "they were never on a course to touch", &|run| worst(run, |p| p.min_ttc.map(|t| t.value), true)))
            (pair("PET", "s", 2, "no place was crossed by both, one after the other", &|run| worst(run, |p| p.pet.map(|t| t.value), true)))
            (pair("Hardest braking of the ego, by its brake", "m/s\u{b2}", 1, "", &|run| Some(run.metrics.ego.max_deceleration.value)))
            .tile {
                dt { "Contact" }
                dd.value.words {
                    @match last.and_then(|run| run.metrics.contact.as_ref()) {
                        Some(contact) => { (contact.kind.label()) ", " (parts::quantity(Some(contact.relative_speed_mps), 1, "m/s", "")) },
                        None if last.is_some_and(|run| !run.metrics.obstacles_hit.is_empty()) => "a thing in its way",
                        None => (parts::missing("no contact in the last run")),
                    }
                }
            }
        }
    }
}
