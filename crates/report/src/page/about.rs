//! Where everything came from: command, versions, files with their hashes, settings, remarks; and the words used.

use super::{Context, parts};
use crate::words::{self, fixed, thousands};
use maud::{Markup, html};
use recrash_model::Diagnostic;

/// Remarks listed; the rest are counted. [count]
const LONGEST_LIST: usize = 200;

/// The section.
pub fn section(context: &Context) -> Markup {
    html! {
        section.page #about aria-labelledby="about-title" {
            .page-head { h1 #about-title { "About this run" } p.lead { "Same records, settings and seed give the same suite, byte for byte." } }
            .panel { h2 { "Make it again" } (parts::command(&context.suite.command)) }
            .columns {
                .panel { h2 { "Settings" } (settings(context)) }
                .panel { h2 { "System profile" } (profile(context)) }
            }
            .panel { h2 { "Files read" } (files(context)) }
            .panel { h2 { "Remarks" } (remarks(&context.suite.diagnostics)) }
            .panel { h2 { "Words and measures" } (glossary(context.suite.accounts.is_some())) }
        }
    }
}

fn settings(context: &Context) -> Markup {
    let (suite, selection) = (context.suite, &context.suite.selection);
    let row = |name: &str, value: Markup| html! { tr { th scope="row" { (name) } td { (value) } } };
    html! {
        table.plain { tbody {
            (row("Written by", html! { (words::clean(&suite.generated_by, 80)) }))
            @if let Some(when) = &suite.generated_at { (row("Written at", html! { (words::clean(when, 80)) })) }
            (row("Records", html! { @if suite.sample { "built-in sample" } @else { "the files below" } }))
            (row("Ego", html! { (words::clean(&suite.ego, 80)) }))
            (row("Simulator", html! { (words::clean(&suite.simulator, 80)) }))
            (row("Agents", html! { (words::clean(&suite.agents, 80)) }))
            (row("Selection", html! { (selection.strategy.name()) ", budget " (selection.budget) ", counted by " (selection.weighting.name()) }))
            (row("Seed", html! { (suite.seed) span.muted { "; of the selection " (selection.seed) } }))
            (row("Embedding", html! {
                (words::clean(&selection.embedding.name, 80)) ", " (selection.embedding.source_dimensions) " \u{2192} " (selection.embedding.dimensions) " dimensions, "
                (fixed(100.0 * selection.embedding.explained_variance, 1).unwrap_or_default()) "\u{a0}% of the variance"
            }))
            (row("Weight of the template", html! { (fixed(selection.template_weight, 2).unwrap_or_default()) }))
        } }
    }
}

fn profile(context: &Context) -> Markup {
    let profile = &context.suite.profile;
    let row = |name: &str, value: Markup| html! { tr { th scope="row" { (name) } td { (value) } } };
    let list = |items: Vec<&str>| html! { (items.join(", ")) };
    let (e, f) = (&profile.expresses, &profile.failure);
    let number = |value: f64| fixed(value, 1).unwrap_or_default();
    html! {
        p.muted { b { (words::clean(&profile.name, 60)) } ": " (words::clean(&profile.description, 400)) }
        table.plain { tbody {
            (row("Road types", list(e.road_types.iter().map(|road| road.label()).collect())))
            (row("SV movements", list(e.sv_movements.iter().map(|movement| movement.label()).collect())))
            (row("CP movements", list(e.cp_movements.iter().map(|movement| movement.label()).collect())))
            (row("Work zones", html! { @if e.work_zone { "yes" } @else { "no" } }))
            (row("Speeds", html! { (number(e.min_speed_mps)) " to " (number(e.max_speed_mps)) "\u{a0}m/s" }))
            @if !profile.excludes.collisions.is_empty() { (row("Not generated", list(profile.excludes.collisions.iter().map(|kind| kind.label()).collect()))) }
            (row("Failure: box gap below", html! { (number(f.min_gap_m)) "\u{a0}m" }))
            (row("Finding: braking above", html! { (number(f.hard_braking_mps2)) "\u{a0}m/s\u{b2}, or " (number(f.phantom_braking_mps2)) "\u{a0}m/s\u{b2} with nothing in the way" }))
            (row("Finding: oscillation", html! { (f.oscillation_reversals) " reversals in " (number(f.oscillation_window_s)) "\u{a0}s" }))
            (row("Finding: lane departure", html! { "more than " (number(f.lane_departure_m)) "\u{a0}m" }))
        } }
    }
}

fn files(context: &Context) -> Markup {
    html! {
        .table-wrap { table.plain {
            thead { tr { th scope="col" { "File" } th scope="col" { "Edition" } th.right scope="col" { "Rows" } th scope="col" { "SHA-256" } } }
            tbody { @for file in &context.suite.records.files {
                tr {
                    th scope="row" { (words::clean(&file.name, 120)) }
                    td { (file.edition.label()) }
                    td.right.number { (thousands(file.rows)) }
                    td { code.hash { (words::clean(&file.sha256, 64)) } }
                }
            } }
        } }
        @if context.suite.records.files.is_empty() { p.empty { "No file was read." } }
    }
}

fn remarks(diagnostics: &[Diagnostic]) -> Markup {
    let mut codes: Vec<(&str, usize)> = Vec::new();
    for diagnostic in diagnostics {
        match codes.iter_mut().find(|(code, _)| *code == diagnostic.code) {
            Some((_, n)) => *n += 1,
            None => codes.push((&diagnostic.code, 1)),
        }
    }
    codes.sort();
    html! {
        @if diagnostics.is_empty() { p.empty { "There are none." } } @else {
            p { @for (code, n) in &codes { span.tag { code { (words::clean(code, 80)) } " " (n) } " " } }
            details { summary { "List" @if diagnostics.len() > LONGEST_LIST { " (the first " (LONGEST_LIST) " of " (thousands(diagnostics.len())) ")" } }
                .table-wrap { table.plain {
                    thead { tr { th scope="col" { "Severity" } th scope="col" { "Where" } th scope="col" { "What" } th scope="col" { "How to fix it" } } }
                    tbody { @for diagnostic in diagnostics.iter().take(LONGEST_LIST) {
                        tr {
                            td { (words::name(&diagnostic.severity)) }
                            td { (words::clean(&diagnostic.location.to_string(), 200)) }
                            td { (words::clean(&diagnostic.message, 400)) " " code { (words::clean(&diagnostic.code, 80)) } }
                            td { (parts::text_or(Some(&diagnostic.hint), "no hint")) }
                        }
                    } }
                } }
            }
        }
    }
}

/// Words of a suite that goes by accounts.
const OF_ACCOUNTS: [(&str, &str); 12] = [
    (
        "Reconstructed, stated",
        "An incident is reconstructed where its scenario contradicts no fact of its reports and leaves out nothing that the two did; else the reason is counted. A fact is stated where a narrative or a column says it, as far as the program read it: what it misread, it cannot notice.",
    ),
    (
        "Crash type",
        "What the vehicles were doing to each other, such as front to rear; “not stated” where the narrative does not say.",
    ),
    (
        "Initiator, responder",
        "Whose move brought the conflict about, and who had to answer it. Said of the subject vehicle.",
    ),
    (
        "As told",
        "The run of the recorded driver, a script that does what the report says, in the crash as reconstructed. It is checked against the report.",
    ),
    (
        "As told, tuned",
        "The recorded driver in the scenario that tuning kept, where that is another one: the same record with other values for what it leaves open, and not the crash as reconstructed.",
    ),
    (
        "Tested, as reconstructed",
        "The run of the system under test in the same crash: it takes over from the recorded driver at the handover.",
    ),
    (
        "Tuned, after tuning",
        "The system under test after a search over what the report leaves open, for the nearest failure. Every scenario that it tries shows the stated facts too, but it is not the crash as reconstructed. “Found by tuning”: it passes that, and fails here.",
    ),
    (
        "Situation met",
        "The system under test came within a few metres or seconds of what the record's vehicle crashed with. Without that a pass says nothing of the crash.",
    ),
    (
        "Struck standing, struck moving, otherwise",
        "Failures are counted by how they came about. The ego had stood in its own way for a second and somebody drove into it: what it drove seldom has to do with that; whether another ego avoids it is shown beside it. It moved, slowed or had just stopped, and was struck from behind or beside, outside of where a driver looks: often by a partner that does not react to it. All others follow from what it did or did not do.",
    ),
    (
        "Quirk, avoidable, beyond reference, unavoidable, unclear",
        "Of a failure: every other ego avoids it in the same scenario; the ego “reference” does, and another fails; “reference” fails, and another avoids it; every ego fails in the same way; nobody gets through, but not all by the same contact.",
    ),
    (
        "Avoided by all, some, no reference driver",
        "Of a contact: what the drivers of UN R157 make of it on its straight-road model. It is another question than how other egos fare.",
    ),
    (
        "Delta-v",
        "Change of velocity in the contact, of the ego and of the partner. Lists are sorted by the larger of the two.",
    ),
];

/// Words of a suite that goes by templates.
const OF_TEMPLATES: [(&str, &str); 2] = [
    ("As designed", "The scenario as it was made from the narrative: the first shot."),
    ("Tuned", "The same scenario with other numbers, inside bounds that keep the narrative true, nearer to a failure."),
];

fn glossary(by_account: bool) -> Markup {
    let special: &[(&str, &str)] = if by_account { &OF_ACCOUNTS } else { &OF_TEMPLATES };
    let words = [
        (
            "SV, ego",
            "The subject vehicle of the record: the automated vehicle. In a scenario it is the ego, driven by the system under test.",
        ),
        ("CP, partner", "The crash partner: the other road user."),
        ("Template", "Road type, movement of the SV, movement of the CP, and whether it was a work zone."),
        ("Pick", "The record that stands for its cluster. Each pick becomes one scenario."),
        (
            "Faithful",
            "Every stated fact was checked and is shown by what was driven. Computed from the paths, never from the scenario's labels.",
        ),
        (
            "Unchecked",
            "Nothing speaks against the run, and not every stated fact could be checked. It is not called faithful.",
        ),
        (
            "Own, another, invented",
            "Whose crash is told: the picked record's, another real record's in its place, or nobody's. Nobody's crash has no record to be true to.",
        ),
        ("Impact speed", "Relative speed of the ego and what it touches, at the contact."),
        ("Box gap", "Shortest distance between the outlines of two road users; 0 on contact."),
        ("TTC", "Time to collision: when the outlines would touch if both kept speed and direction."),
        ("PET", "Post-encroachment time: between the first leaving the place both crossed and the second reaching it."),
        ("DRAC", "Deceleration rate to avoid a crash: the constant braking that would just have sufficed."),
        ("Time headway", "Gap to the road user ahead divided by the ego's speed."),
    ];
    html! { dl.glossary { @for (word, meaning) in special.iter().chain(&words) { dt { (word) } dd { (meaning) } } } }
}
