//! The first view: what this is, the headline numbers, and the table of scenarios.

use super::parts::{self, missing};
use super::{Context, corpus, icon, types};
use crate::summary::{Result, Summary, Tested};
use crate::view::{CaseRow, RunRow};
use crate::words::{self, fixed, thousands};
use crate::{anchor, search, thumbnail};
use maud::{Markup, html};
use recrash_model::account::{AccountSet, TypeShare};
use recrash_model::cause::Failures;
use recrash_model::narrative::Origin;
use recrash_model::severity::Severity;
use std::collections::BTreeSet;
use std::fmt::Write;

/// The overview.
pub fn section(context: &Context) -> Markup {
    let suite = context.suite;
    html! {
        section.page.current #overview aria-labelledby="overview-title" {
            .page-head {
                h1 #overview-title { (words::clean(&suite.title, 200)) }
                p.lead { @match &suite.accounts { Some(accounts) => (account_sentence(context, accounts)), None => (sentence(context)) } }
            }
            @if suite.sample {
                p.banner role="note" {
                    (icon::bang())
                    span { strong { "Built-in sample. " } "These records were written for recrash, with the shares of crash types in NHTSA's files. No real crash is shown. Give " code { "--records FILE" } " to use NHTSA's file." }
                }
            }
            @match &suite.accounts { Some(accounts) => (account_tiles(context, accounts)), None => (tiles(context)) }
            @if let Some(accounts) = &suite.accounts { details.fold { summary { "Crash types: how much of each is reconstructed and tested" } (types::types(context, accounts)) } }
            @if let Some(corpus) = &suite.corpus { details.fold { summary { "What of the corpus is covered" } (corpus::corpus(corpus)) } }
            h2 { "Scenarios" @if suite.accounts.is_some() { ", the worst first" } }
            noscript { p.banner { "A scenario opens with scripts only. This table, results.csv and the scenario files of the suite need none." } }
            @if suite.cases.is_empty() { p.empty { "The suite has no scenario." } } @else { (controls(suite.accounts.is_some(), suite.cases.iter().any(|case| case.review.is_some()))) (table(context)) }
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

/// What was found, in a few sentences: first what the numbers are about.
fn sentence(context: &Context) -> Markup {
    let (suite, s) = (context.suite, &context.summary);
    html! {
        b { (thousands(s.origins[0])) " of " (words::count(s.cases, "scenario")) } " tell their own record; "
        b { (thousands(s.own_faithful)) " of those " (thousands(s.origins[0])) } " show every stated fact. "
        b { (words::clean(&suite.ego, 60)) } " fails " b { (thousands(s.failed_before)) " of the " (thousands(s.ran)) } " that ran as designed and "
        b { (thousands(s.failed_after)) } " after tuning"
        @if s.passed_before() > 0 {
            "; of the " (thousands(s.passed_before())) " it passed at first, tuning brought the partner closer in " (thousands(s.closer))
        }
        ". A failure is a contact, a box gap below " (fixed(suite.profile.failure.min_gap_m, 1).unwrap_or_default())
        "\u{a0}m, leaving the road, or getting stuck."
    }
}

/// Failures by how they came about.
fn manners(failures: Failures) -> Markup {
    html! { @for (i, (count, words)) in failures.told().enumerate() { @if i > 0 { ", " } b { (thousands(count)) } " " (words) } }
}

/// The same of a suite that goes by accounts.
fn account_sentence(context: &Context, accounts: &AccountSet) -> Markup {
    let (suite, s) = (context.suite, &context.summary);
    let [first, last] = s.tested;
    html! {
        b { (thousands(accounts.told.len())) " of " (thousands(accounts.readable)) } " readable incidents are reconstructed: no stated fact is contradicted, and nothing that the two did is left out. "
        (thousands(accounts.types.iter().map(|share| share.whole).sum())) " show every stated fact. Stated is what the program read in a report; it cannot notice its own misreadings. "
        @if s.cases < accounts.told.len() { b { (thousands(s.cases)) } " were selected. " } @else { "All of them are here. " }
        (not_shown_here(s))
        b { (words::clean(&suite.ego, 60)) } " drove " (thousands(first.ran)) " of them from the handover on"
        @if s.parked > 0 { " (in " (thousands(s.parked)) " it was parked, and there is nothing to test)" }
        ", and got into the reported situation in " b { (thousands(first.met)) } ". It fails " b { (thousands(first.failures.total())) " of those " (thousands(first.met)) } " as reconstructed"
        @if s.tuned { ", and " b { (thousands(last.failures.total())) " of " (thousands(last.met)) } " after tuning within what the reports leave open; " (thousands(s.by_tuning)) " of them after tuning alone" }
        @else { "; tuning within what the reports leave open kept no other scenario" }
        (beyond_tyres(last))
        ". A failure is a contact, a box gap below " (fixed(suite.profile.failure.min_gap_m, 1).unwrap_or_default())
        "\u{a0}m, leaving the road, or getting stuck."
    }
}

/// Scenarios of the suite itself that do not show their crash as told: a person edited them, or they were not run.
fn not_shown_here(s: &Summary) -> Markup {
    let shown = s.cases - s.own_unfaithful - s.own_not_run;
    html! {
        @if shown < s.cases {
            b { (thousands(shown)) " of the " (thousands(s.cases)) " in this suite" } " show it"
            @if s.own_unfaithful > 0 { ", " b { (thousands(s.own_unfaithful)) } " not as told" }
            @if s.own_not_run > 0 { ", " b { (thousands(s.own_not_run)) } " not run" }
            ". "
        }
    }
}

/// What its passes are worth where it brakes as no vehicle can.
fn beyond_tyres(tested: Tested) -> Markup {
    html! {
        @if tested.beyond_tyres > 0 {
            ". In " b { (thousands(tested.beyond_tyres)) " of the " (thousands(tested.passed())) } " that it passes it brakes harder than tyres can, so that a real vehicle might not pass"
        }
    }
}

fn tile(name: &str, value: Markup, note: Markup, bar: Option<(f64, &str)>) -> Markup {
    html! {
        .tile {
            dt { (name) }
            dd.value { (value) }
            @if let Some((share, class)) = bar { dd.tile-bar { (parts::bar(share, class)) } }
            dd.note { (note) }
        }
    }
}

fn account_tiles(context: &Context, accounts: &AccountSet) -> Markup {
    let s = &context.summary;
    let [first, last] = s.tested;
    let here: BTreeSet<_> =
        context.suite.cases.iter().filter_map(|case| Some(case.account.as_ref()?.crash_type)).collect();
    let types = |of: fn(&TypeShare) -> bool| {
        accounts.types.iter().filter(|share| share.crash_type.is_some() && of(share)).count()
    };
    html! {
        dl.tiles {
            (tile(
                "Incidents",
                html! { (thousands(s.rows)) " \u{2192} " (thousands(accounts.incidents)) },
                html! { "rows read, incidents; " (thousands(accounts.readable)) " with a narrative that can be read" },
                Some((parts::share(accounts.readable, accounts.incidents), "plain")),
            ))
            (tile(
                "Reconstructed",
                html! { (thousands(accounts.told.len())) span.of { " of " (thousands(accounts.readable)) } },
                html! { "readable incidents: no stated fact contradicted, nothing that the two did left out; invented: 0" },
                Some((parts::share(accounts.told.len(), accounts.readable), "good")),
            ))
            (tile(
                "Crash types in the suite",
                html! { (here.len()) span.of { " of " (types(|_| true)) } },
                html! { "that occur; " (types(|share| share.told > 0)) " of them can be reconstructed" },
                None,
            ))
            (tile(
                "Situation met",
                html! { (thousands(first.met)) span.of { " of " (thousands(first.ran)) } },
                html! { "driven by the system under test, as reconstructed" @if s.parked > 0 { "; " (thousands(s.parked)) " parked, not tested" } },
                Some((parts::share(first.met, first.ran), "plain")),
            ))
            (tile(
                "Ego fails, as reconstructed",
                html! { (thousands(first.failures.total())) span.of { " of " (thousands(first.met)) } },
                html! { (manners(first.failures)) @if !s.tuned { (against_others(context)) } },
                Some((parts::share(first.failures.total(), first.met), "bad")),
            ))
            @if s.tuned {
                (tile(
                    "Ego fails, after tuning",
                    html! { (thousands(last.failures.total())) span.of { " of " (thousands(last.met)) } },
                    html! { (manners(last.failures)) "; " (thousands(s.by_tuning)) " found by tuning alone" (against_others(context)) },
                    Some((parts::share(last.failures.total(), last.met), "bad")),
                ))
            }
        }
    }
}

/// What the failures are worth beside other egos.
fn against_others(context: &Context) -> Markup {
    let classes = &context.summary.classes;
    html! {
        @if !classes.is_empty() { ". Against other egos: " }
        @for (i, (class, count)) in classes.iter().enumerate() { @if i > 0 { ", " } (thousands(*count)) " " (class.label()) }
    }
}

fn tiles(context: &Context) -> Markup {
    let (s, coverage) = (&context.summary, &context.suite.selection.coverage);
    let gap = |value: Option<f64>| value.and_then(|value| fixed(value, 2)).unwrap_or_else(|| "\u{2013}".to_owned());
    let arrow = || html! { " " span.arrow { "\u{2192}" } " " };
    html! {
        dl.tiles {
            (tile(
                "Records",
                html! { (thousands(s.rows)) (arrow()) (thousands(s.usable)) },
                html! { "rows read, records usable" },
                Some((parts::share(s.usable, s.rows), "plain")),
            ))
            (tile(
                "Templates covered",
                html! { (coverage.templates_covered) span.of { " of " (coverage.templates_observed) } },
                html! { "observed; the profile can express " (coverage.templates_possible) },
                Some((parts::share(coverage.templates_covered, coverage.templates_observed), "good")),
            ))
            (tile(
                "Tell their own record",
                html! { (thousands(s.origins[0])) span.of { " of " (thousands(s.cases)) } },
                html! {
                    (thousands(s.origins[1])) " tell another one, " (thousands(s.origins[2])) " are invented"
                    @if s.refused > 0 { ", " b { (thousands(s.refused)) " refused" } }
                    @if s.edited > 0 { ", " (thousands(s.edited)) " edited by hand" }
                },
                Some((parts::share(s.origins[0], s.cases), "plain")),
            ))
            (tile(
                "Show every stated fact",
                html! { (thousands(s.own_faithful)) span.of { " of those " (thousands(s.origins[0])) } },
                html! {
                    (thousands(s.own_unfaithful)) " show something else, " (thousands(s.origins[0] - s.own_faithful - s.own_unfaithful)) " are unchecked or did not run"
                    @if s.origins[1] > 0 { "; " (thousands(s.other_faithful)) " of the " (thousands(s.origins[1])) " with another record do" }
                },
                Some((parts::share(s.own_faithful, s.origins[0]), "good")),
            ))
            (tile(
                "Ego fails",
                html! { (thousands(s.failed_before)) (arrow()) (thousands(s.failed_after)) span.of { " of " (thousands(s.ran)) } },
                html! {
                    "as designed, after tuning"
                    @if !s.classes.is_empty() { ": " }
                    @for (i, (class, count)) in s.classes.iter().enumerate() { @if i > 0 { ", " } (thousands(*count)) " " (class.label()) }
                },
                Some((parts::share(s.failed_after, s.ran), "bad")),
            ))
            (tile(
                "Median least gap",
                html! { (gap(s.median_before_m)) (arrow()) (gap(s.median_after_m)) span.of { "\u{a0}m" } },
                html! { "as designed, after tuning" },
                None,
            ))
        }
    }
}

/// Keys to sort by, as the scripts know them.
const SORTS: [(&str, &str); 12] = [
    ("worst", "Worst first"),
    ("order", "Order of the suite"),
    ("operator", "Operator"),
    ("city", "City"),
    ("kind", "Partner"),
    ("before", "Least gap before tuning"),
    ("after", "Least gap after tuning"),
    ("impact", "Impact speed"),
    ("severity", "Largest delta-v"),
    ("harm", "Injury in the record"),
    ("findings", "Findings"),
    ("faithful", "True to its record"),
];

fn controls(accounts: bool, reviewed: bool) -> Markup {
    let by_template = [
        ("all", "All"),
        ("failed", "Fails"),
        ("passed", "Passes"),
        ("beyond", "Passes beyond tyres"),
        ("faithful", "Faithful"),
        ("unfaithful", "Not faithful"),
        ("unchecked", "Unchecked"),
        ("other", "Another record"),
        ("invented", "Invented"),
        ("refused", "Refused"),
        ("edited", "Edited"),
    ];
    let by_account = [
        ("all", "All"),
        ("failed", "Fails"),
        ("driving", "Fails, not struck standing"),
        ("struck", "Struck while it stood"),
        ("tuning", "Found by tuning"),
        ("passed", "Passes"),
        ("beyond", "Passes beyond tyres"),
        ("met", "Situation met"),
        ("unmet", "Situation not met"),
        ("human", "Human at the contact"),
        ("parked", "Parked"),
        ("unfaithful", "Not as told"),
        ("refused", "Refused"),
        ("edited", "Edited"),
    ];
    let mut filters = if accounts { by_account.to_vec() } else { by_template.to_vec() };
    if reviewed {
        filters.extend([
            ("reviewed-right", "Read beside its report: right"),
            ("reviewed-wrong", "Read beside its report: wrong"),
        ]);
    }
    // Of a suite that goes by accounts the worst come first; the paper's has its own order.
    let sorted = if accounts { "worst" } else { "order" };
    html! {
        .controls {
            label { span.hidden-text { "Search scenarios" } input #case-search type="search" placeholder="Search id, record, operator, city, kind, words  ( / )"; }
            label.field { span { "Show" } select #case-filter { @for (value, name) in filters { option value=(value) { (name) } } } }
            @for (key, name) in [("operator", "Operator"), ("city", "City"), ("kind", "Partner"), ("injury", "Injury")] {
                label.field { span { (name) } select data-only=(key) { option value="" { "any" } } }
            }
            @if accounts { label.field { span { "Crash type" } select data-only="type" { option value="" { "any" } } } }
            label.field { span { "Sort by" } select #case-sort { @for (key, name) in SORTS { option value=(key) selected[key == sorted] { (name) } } } }
            button.small #case-direction type="button" aria-pressed="false" title="Turn the order round" { "\u{2191}" span.hidden-text { " turn the order round" } }
            span #case-count.muted role="status" {}
            button type="button" #case-reset hidden { "Show all" }
        }
    }
}

fn table(context: &Context) -> Markup {
    let heads = [
        ("scene", "Scene", None, "paths of ego and partner about the encounter"),
        ("what", "Scenario", Some("order"), "its id and template"),
        ("crash", "Record", Some("operator"), "the record whose crash it is: id, operator, city, kind of partner"),
        ("gap", "Least gap", Some("after"), "box to box, before and after tuning"),
        (
            "impact",
            "Impact",
            Some("impact"),
            "relative speed at the ego's contact in the last run, the speed of each, and what it does to the velocity of each",
        ),
        ("injury", "Injury", Some("harm"), "highest injury that the record alleges"),
        ("ego", "Ego", Some("findings"), "what it did in the last run"),
        (
            "true",
            "True to record",
            Some("faithful"),
            "whether what was read in the report is shown: computed from the paths driven in the last run",
        ),
    ];
    html! {
        table #cases.cases {
            caption.hidden-text { "Scenarios, one a row. The buttons in the head sort." }
            thead { tr {
                @for (class, name, key, what) in heads {
                    th.(class) scope="col" title=(what) { @match key { Some(key) => button.sort type="button" data-sort=(key) { (name) }, None => (name) } }
                }
            } }
            tbody { @for (position, case) in context.suite.cases.iter().enumerate() { (row(context, position, case)) } }
        }
        p #case-more.muted hidden {}
        p #case-none.empty hidden { "No scenario matches." }
    }
}

fn delta_v(severity: &Severity) -> Markup {
    let [ego, other] = [&severity.first, &severity.second].map(|side| fixed(side.delta_v_mps, 1).unwrap_or_default());
    html! { .muted { "delta-v ego " (ego) ", " (severity.other()) " " (other) } }
}

fn row(context: &Context, position: usize, case: &CaseRow) -> Markup {
    let last = case.last_run();
    let anchor = anchor::anchor(&case.scenario_id);
    let not_run = if case.refused.is_some() { "refused" } else { words::not_run(case) };
    let contact = last.and_then(|run| run.metrics.contact.as_ref());
    let severity = last.and_then(|run| run.severity.as_ref());
    html! {
        tr data-row=(position) {
            td.scene { (scene(case)) }
            th.what scope="row" {
                a.case-link href={ "#" (anchor) } { (words::clean(&case.scenario_id, 80)) }
                @if let Some(account) = &case.account { div { (account.crash_type.label()) @if let Some(role) = account.role { ", ego " (words::name(&role)) } } }
                .muted { (words::template(&case.template)) }
                @if let Some(why) = &case.refused { .refused-why { (icon::cross()) "refused: " (words::clean(why, 200)) } }
                (parts::edited_chip(&case.edited))
            }
            td.crash { (crash(context, position, case)) }
            td.gap {
                @if last.is_none() { (missing(not_run)) } @else {
                    @if case.is_tuned() || case.account.is_none() { (metres(case.first_run())) } @else { b { (metres(last)) } }
                    @if let Some(after) = case.after.as_ref().filter(|_| case.is_tuned()) { " \u{2192} " b { (metres(Some(after))) } }
                    @if let Some(note) = last.and_then(|run| words::gap_note(run, context.suite.profile.failure.min_gap_m, case.account.is_some())) { .muted { (note) } }
                }
            }
            td.impact {
                @match contact {
                    Some(contact) => {
                        b { (fixed(contact.relative_speed_mps, 1).unwrap_or_default()) "\u{a0}m/s" }
                        .muted { "ego " (fixed(contact.ego_speed_mps, 1).unwrap_or_default()) ", partner " (fixed(contact.other_speed_mps, 1).unwrap_or_default()) }
                        @if let Some(severity) = severity { (delta_v(severity)) }
                    },
                    None => {
                        @if let Some(severity) = severity.filter(|severity| severity.obstacle.is_some()) {
                            b { (fixed(severity.closing_speed_mps, 1).unwrap_or_default()) "\u{a0}m/s" }
                            .muted { "on a " (severity.other()) }
                            (delta_v(severity))
                        } @else { (missing(if last.is_some() { "no contact" } else { not_run })) }
                    },
                }
            }
            td.injury { @match context.told.at(position) { Some(record) => (search::injury(record)), None => (missing("it tells no record")) } }
            td.ego { (ego(case, not_run)) }
            td.true {
                (parts::faithful_chip(case.telling_run().map(|run| &run.judgement), case.origin.as_ref()))
                @if case.review.is_some() { " " (parts::review_chip(case.review.as_ref())) }
                @if case.situation_met() == Some(false) { " " span.chip.odd { "situation not met" } }
            }
        }
    }
}

fn metres(run: Option<&RunRow>) -> Markup {
    match run.and_then(|run| run.min_gap_m()).and_then(|gap| fixed(gap, 2)) {
        Some(gap) => html! { (gap) "\u{a0}m" },
        None => missing("no gap"),
    }
}

/// The record that is told, and by whom, where and with whom; or that nobody's crash is.
fn crash(context: &Context, position: usize, case: &CaseRow) -> Markup {
    let pick = context.suite.case_records(case).next();
    html! {
        @match &case.told {
            Some(told) => span.mono { (words::clean(&told.to_string(), 40)) },
            None => @if let Some(pick) = pick { span.muted { "for " span.mono { (words::clean(&pick.id.to_string(), 40)) } } } @else { (missing("no record")) },
        }
        @if !matches!(case.origin, None | Some(Origin::Own)) { " " (parts::origin_chip(case.origin.as_ref(), case.told.as_ref())) }
        @if let Some(record) = context.told.at(position) {
            div { (words::clean(&record.entity, 60)) }
            .muted { (words::clean(&record.place, 60)) ", " (search::partner(record)) }
        }
    }
}

/// How the ego fared: as designed and at last, what the failure is worth, and what was found.
fn ego(case: &CaseRow, not_run: &str) -> Markup {
    let Some(last) = case.last_run() else { return missing(not_run) };
    let result = |run: &RunRow| Result::of(Some(&run.judgement));
    let first = case.first_run().filter(|first| case.is_tuned() && result(first) != result(last));
    html! {
        @if let Some(first) = first { span.muted { (result(first).label()) " \u{2192}" } " " }
        (parts::result_chip(result(last)))
        @if let Some(triage) = &case.triage { " " (parts::class_chip(triage.class)) }
        @if case.account.is_some() && case.found_by_tuning() { " " (parts::tuning_chip()) }
        @let kinds = last.finding_kinds();
        @if !kinds.is_empty() { .why { (kinds.iter().map(|kind| kind.label()).collect::<Vec<_>>().join(", ")) } }
    }
}

/// The paths of the last run.
fn scene(case: &CaseRow) -> Markup {
    let Some(picture) = &case.thumbnail else { return html! {} };
    let path = |points: &[[i16; 2]]| {
        let mut path = String::new();
        let mut last = [0, 0];
        for (i, &[x, y]) in points.iter().enumerate() {
            let _ = match i {
                0 => write!(path, "M{x} {y}"),
                _ => write!(path, "l{} {}", x - last[0], y - last[1]),
            };
            last = [x, y];
        }
        path
    };
    let [width, height] = thumbnail::SIZE;
    html! {
        svg.thumb viewBox={ "0 0 " (width) " " (height) } aria-hidden="true" {
            @if !picture.partner.is_empty() { path.p d=(path(&picture.partner)) {} }
            path.e d=(path(&picture.ego)) {}
            circle cx=(picture.at[0]) cy=(picture.at[1]) r="3" {}
        }
    }
}
