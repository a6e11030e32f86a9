//! What the suite found out about the ego.

use super::{Context, parts, triage};
use crate::anchor;
use crate::view::RunRow;
use crate::words::{self, fixed, thousands};
use maud::{Markup, html};
use recrash_model::metrics::{Finding, FindingKind};
use recrash_model::vehicle::TYRE_LIMIT_MPS2;

/// Findings listed; the rest stand with their scenarios. [count]
const LONGEST_LIST: usize = 200;

const KINDS: [FindingKind; 10] = [
    FindingKind::Contact,
    FindingKind::ObstacleContact,
    FindingKind::NearMiss,
    FindingKind::OffRoad,
    FindingKind::Stuck,
    FindingKind::HardBraking,
    FindingKind::BrakingBeyondTyres,
    FindingKind::PhantomBraking,
    FindingKind::Oscillation,
    FindingKind::LaneDeparture,
];

/// The section.
pub fn section(context: &Context) -> Markup {
    html! {
        section.page #findings aria-labelledby="findings-title" {
            .page-head {
                h1 #findings-title { "Findings about the ego" }
                p.lead {
                    b { (words::clean(&context.suite.ego, 60)) } " fails " (fails(context)) ". The other kinds are odd behaviour worth a look."
                }
            }
            .panel { h2 { "Causes of the failures" @if context.summary.tuned { " after tuning" } ": one finding each" } (triage::by_cause(context)) }
            .panel { h2 { "How other egos fare in the same scenarios" } (triage::by_class(context)) }
            .panel { h2 { "By kind" } (by_kind(context)) }
            .panel { h2 { "Every finding" } (every(context)) }
        }
    }
}

/// Of how many it fails: where the suite goes by accounts, as the overview counts them, of those in which it met the situation.
fn fails(context: &Context) -> Markup {
    let (s, [first, last]) = (&context.summary, context.summary.tested);
    let (before, after, of) = if context.suite.accounts.is_some() {
        (first.failures.total(), last.failures.total(), first.met)
    } else {
        (s.failed_before, s.failed_after, s.ran)
    };
    html! {
        (before) " of " (of) " scenarios " @if context.suite.accounts.is_some() { "whose situation it met, " } (untuned(context))
        @if s.tuned { " and " (after) " after tuning" }
    }
}

/// What the scenarios before tuning are called.
fn untuned(context: &Context) -> &'static str {
    if context.suite.accounts.is_some() { "as reconstructed" } else { "as designed" }
}

fn has(run: Option<&RunRow>, kind: FindingKind) -> bool {
    run.is_some_and(|run| run.findings.iter().any(|finding| finding.kind == kind))
}

fn by_kind(context: &Context) -> Markup {
    let cases = &context.suite.cases;
    let ran = context.summary.ran;
    let share = |n: usize| if ran == 0 { 0.0 } else { n as f64 / ran as f64 };
    html! {
        .table-wrap {
            table.plain {
                caption.hidden-text { "Number of scenarios with a finding of each kind" }
                thead { tr { th scope="col" { "Finding" } th scope="col" { "What it means" } th.right scope="col" { (words::capital(untuned(context))) } td {} th.right scope="col" { "After tuning" } td {} } }
                tbody { @for kind in KINDS {
                    @let before = cases.iter().filter(|case| has(case.first_run(), kind)).count();
                    @let after = cases.iter().filter(|case| has(case.last_run(), kind)).count();
                    @let class = if kind.is_failure() { "bad" } else { "odd" };
                    tr {
                        th scope="row" { (parts::finding_chip(kind)) }
                        td.muted { (meaning(kind, context)) }
                        td.right.number { (before) } td.bar-cell { (parts::bar(share(before), class)) }
                        td.right.number { (after) } td.bar-cell { (parts::bar(share(after), class)) }
                    }
                } }
            }
        }
        p.muted { "Scenarios with at least one finding of the kind, of " (ran) " that the system under test drove." }
    }
}

fn meaning(kind: FindingKind, context: &Context) -> String {
    let limits = &context.suite.profile.failure;
    let number = |value: f64| fixed(value, 1).unwrap_or_default();
    match kind {
        FindingKind::Contact => "the ego's box touches a road user's".to_owned(),
        FindingKind::ObstacleContact => "the ego's box touches an obstacle".to_owned(),
        FindingKind::NearMiss => format!("box gap below {} m", number(limits.min_gap_m)),
        FindingKind::OffRoad => "the ego leaves the road".to_owned(),
        FindingKind::Stuck => "the ego stands still and never arrives".to_owned(),
        FindingKind::HardBraking => format!("braking above {} m/s\u{b2}", number(limits.hard_braking_mps2)),
        FindingKind::BrakingBeyondTyres => format!(
            "braking above {} m/s\u{b2} on a dry road, less on others: tyres do not give it, so the run says nothing of a real vehicle",
            number(TYRE_LIMIT_MPS2)
        ),
        FindingKind::PhantomBraking => {
            format!("braking above {} m/s\u{b2} with nothing in the way", number(limits.phantom_braking_mps2))
        }
        FindingKind::Oscillation => format!(
            "{} changes between braking and accelerating within {} s",
            limits.oscillation_reversals,
            number(limits.oscillation_window_s)
        ),
        FindingKind::LaneDeparture => {
            format!("a corner more than {} m beyond the lane", number(limits.lane_departure_m))
        }
    }
}

/// Of the contact that was measured, what it does to the velocity of the two.
fn harm(run: &RunRow, finding: &Finding) -> Option<f64> {
    let severity = run.severity.as_ref()?;
    let of = if severity.obstacle.is_some() { FindingKind::ObstacleContact } else { FindingKind::Contact };
    let first = run.findings.iter().find(|other| other.kind == of)?;
    (first == finding).then(|| severity.harm_mps())
}

fn every(context: &Context) -> Markup {
    let runs = context
        .suite
        .cases
        .iter()
        .flat_map(|case| case.system_runs().into_iter().map(move |(name, run)| (case, name, run)));
    let mut rows: Vec<_> = runs
        .flat_map(|(case, name, run)| run.judgement.findings.iter().map(move |f| (case, name, f, harm(run, f))))
        .collect();
    rows.sort_by(|a, b| b.3.unwrap_or(-1.0).total_cmp(&a.3.unwrap_or(-1.0)));
    html! {
        @if rows.is_empty() { p.empty { "There are none." } } @else {
            @if rows.len() > LONGEST_LIST {
                p.muted { "The worst " (LONGEST_LIST) " of " (thousands(rows.len())) ". Each scenario lists its own, and results.csv names the kinds of all." }
            }
            .table-wrap {
                table.plain {
                    caption.hidden-text { "Findings of every run of the system under test" }
                    thead { tr { th scope="col" { "Scenario" } th scope="col" { "Run" } th.right scope="col" { "Time" } th.right scope="col" title="the greater change of velocity of the two" { "Largest delta-v" } th scope="col" { "Finding" } th scope="col" { "In words" } } }
                    tbody { @for (case, name, finding, harm) in rows.into_iter().take(LONGEST_LIST) {
                        tr {
                            th scope="row" { a href={ "#" (anchor::anchor(&case.scenario_id)) } { (words::clean(&case.scenario_id, 80)) } }
                            td { (name) }
                            td.right { (parts::quantity(Some(finding.time_s), 1, "s", "")) }
                            td.right { (parts::quantity(harm, 1, "m/s", "no contact, or not the one that is measured")) }
                            td { (parts::finding_chip(finding.kind)) }
                            td { (words::clean(&finding.sentence, 300)) }
                        }
                    } }
                }
            }
        }
    }
}
