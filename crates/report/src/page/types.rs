//! Crash types: how much of each is told and tested, and why the others are not.

use super::{Context, parts};
use crate::view::{CaseRow, RunRow};
use crate::words::{self, fixed, thousands};
use maud::{Markup, html};
use recrash_model::account::{AccountSet, CrashType, FactShare, TypeShare, Untold};
use std::collections::BTreeMap;

/// Two tables: by crash type, and by reason; and by kind of fact.
pub fn types(context: &Context, accounts: &AccountSet) -> Markup {
    html! {
        .table-wrap { table.plain {
            caption.hidden-text { "Readable incidents by crash type" }
            thead { tr {
                th scope="col" { "Type" } th.number scope="col" { "Readable incidents" } th.number scope="col" title="no stated fact is contradicted, and nothing that the two did is left out" { "Reconstructed" }
                th.number scope="col" title="no stated fact was left open" { "Of those, every stated fact shown" }
                th.number scope="col" title="a stated fact that the scene neither shows nor shows otherwise" { "A fact not drawn" }
                th.number scope="col" title="facts that stand in the narratives, for every 100 words" { "Facts per 100 words" }
                th.number scope="col" { "Scenarios here" } th.number scope="col" title="in the crash as reconstructed" { "Situation met" }
                th.number scope="col" title="of those, in the crash as reconstructed" { "Ego fails" } th.number scope="col" title="within what the report leaves open" { "After tuning" }
            } }
            tbody { @for share in &accounts.types { (crash_type(share, &context.suite.cases)) } }
        } }
        .two {
            div {
                h3 { "Why the others are not reconstructed" }
                (reasons(accounts))
            }
            div {
                h3 { "Stated facts that are shown, over all readable incidents" }
                (facts(accounts))
            }
        }
    }
}

fn percent(part: usize, whole: usize) -> String {
    fixed(100.0 * part as f64 / whole.max(1) as f64, 0).unwrap_or_default()
}

/// The row of a crash type: how much of it is told, and what became of its scenarios here.
fn crash_type(share: &TypeShare, cases: &[CaseRow]) -> Markup {
    let in_type =
        cases.iter().filter(|case| case.account.as_ref().map(|account| account.crash_type) == share.crash_type);
    let count = |run: fn(&CaseRow) -> Option<&RunRow>, failed: bool| {
        let met = in_type.clone().filter_map(run).filter(|run| run.situation_met() == Some(true));
        met.filter(|run| !failed || run.failed()).count()
    };
    let (scenarios, met) = (in_type.clone().count(), count(CaseRow::first_run, false));
    let failed = [count(CaseRow::first_run, true), count(CaseRow::last_run, true)];
    html! {
        tr {
            th scope="row" { (share.crash_type.map_or("not stated", CrashType::label)) }
            td.number { (thousands(share.incidents)) }
            td.number { (thousands(share.told)) span.muted { " (" (percent(share.told, share.incidents)) "\u{a0}%)" } }
            td.number { (thousands(share.whole)) }
            td.number { (thousands(share.told - share.whole)) }
            td.number { (parts::quantity(Some(share.facts_per_100_words), 1, "", "")) }
            @if share.crash_type.is_some() { td.number { (thousands(scenarios)) } td.number { (thousands(met)) } @for failed in failed { td.number { (thousands(failed)) } } }
            @else { td {} td {} td {} td {} }
        }
    }
}

/// Why incidents are not told, the most frequent reason first.
fn reasons(accounts: &AccountSet) -> Markup {
    let mut reasons: BTreeMap<Untold, usize> = BTreeMap::new();
    for untold in &accounts.untold {
        *reasons.entry(untold.why).or_default() += 1;
    }
    let mut reasons: Vec<(Untold, usize)> = reasons.into_iter().collect();
    reasons.sort_by_key(|(why, count)| (std::cmp::Reverse(*count), *why));
    html! {
        @if reasons.is_empty() { p.empty { "All are." } } @else {
            table.plain { tbody { @for (why, count) in reasons { tr { th scope="row" { (words::capital(why.label())) } td.number { (thousands(count)) } } } } }
        }
    }
}

/// How many of the stated facts are shown, by kind.
fn facts(accounts: &AccountSet) -> Markup {
    let all = |of: fn(&FactShare) -> usize| accounts.facts.iter().map(of).sum::<usize>();
    html! {
        p.muted { (thousands(all(|share| share.not_drawn))) " of " (thousands(all(|share| share.told))) " stated facts are not drawn: neither shown nor shown otherwise." }
        table.plain { tbody { @for share in accounts.facts.iter().filter(|share| share.told > 0) {
            tr { th scope="row" { (words::capital(share.fact.label())) } td.number { (thousands(share.shown)) " of " (thousands(share.told)) span.muted { " (" (percent(share.shown, share.told)) "\u{a0}%)" @if share.not_drawn > 0 { ", " (thousands(share.not_drawn)) " not drawn" } } } }
        } } }
    }
}
