//! What the failures are worth: how the other egos fare in the same scenarios.

use super::{Case, Context, parts};
use crate::summary::Result;
use crate::view::{CaseRow, RunRow};
use crate::words::fixed;
use crate::{anchor, words};
use maud::{Markup, html};
use recrash_model::cause::Cause;
use recrash_model::metrics::{FindingKind, Timed};
use recrash_model::preventability::Preventability;
use recrash_model::rollout::TerminationKind;
use recrash_model::severity::Severity;
use recrash_model::triage::{EgoOutcome, FailureClass, Fared, Triage};

/// Scenarios of a class that are named; the table finds the rest. [count]
const LONGEST_LIST: usize = 30;

/// Failures by what led to them: one finding with many scenarios, the shortest run first.
pub fn by_cause(context: &Context) -> Markup {
    let failed: Vec<(&CaseRow, &RunRow)> = context
        .suite
        .cases
        .iter()
        .filter_map(|case| Some((case, case.last_run().filter(|run| run.failed())?)))
        .collect();
    let mut groups: Vec<(Cause, Vec<(&CaseRow, &RunRow)>)> = Cause::ALL
        .into_iter()
        .map(|cause| (cause, failed.iter().copied().filter(|(_, run)| run.cause == Some(cause)).collect()))
        .filter(|(_, of): &(Cause, Vec<_>)| !of.is_empty())
        .collect();
    groups.sort_by_key(|(_, of)| std::cmp::Reverse(of.len()));
    for (_, of) in &mut groups {
        of.sort_by(|a, b| a.1.metrics.duration_s.total_cmp(&b.1.metrics.duration_s));
    }
    let worst = |of: &[(&CaseRow, &RunRow)]| {
        of.iter()
            .filter_map(|(_, run)| run.severity.as_ref())
            .map(Severity::harm_mps)
            .fold(None, |most, harm| Some(most.map_or(harm, |most: f64| most.max(harm))))
    };
    html! {
        @if groups.is_empty() { p.empty { "There are no failures." } } @else {
            .table-wrap { table.plain {
                caption.hidden-text { "Failures by what led to them" }
                thead { tr { th scope="col" { "Cause" } th.right scope="col" { "Scenarios" } td {} th.right scope="col" title="the greater change of velocity of the two" { "Largest delta-v" } th scope="col" { "Which, the shortest first" } } }
                tbody { @for (cause, of) in &groups {
                    tr {
                        th scope="row" { (words::capital(cause.label())) @if *cause == Cause::StruckStanding { .muted { "seldom by what it drove" } } }
                        td.right.number { (of.len()) }
                        td.bar-cell { (parts::bar(of.len() as f64 / failed.len() as f64, if *cause == Cause::StruckStanding { "odd" } else { "bad" })) }
                        td.right { (parts::quantity(worst(of), 1, "m/s", "no contact of two road users")) }
                        td {
                            @for (i, (case, _)) in of.iter().take(LONGEST_LIST).enumerate() {
                                @if i > 0 { ", " }
                                a href={ "#" (anchor::anchor(&case.scenario_id)) } { (words::clean(&case.scenario_id, 80)) }
                            }
                            @if of.len() > LONGEST_LIST { " and " (of.len() - LONGEST_LIST) " more; results.csv names the cause of each" }
                        }
                    }
                } }
            } }
            p.muted { "Told by rules from the rollout and the road; they say what happened, not who is to blame: docs/models/causes.md." }
        }
    }
}

/// How many failures of each class there are, and which.
pub fn by_class(context: &Context) -> Markup {
    let failures = context.summary.failed_after;
    let share = |n: usize| if failures == 0 { 0.0 } else { n as f64 / failures as f64 };
    html! {
        .table-wrap { table.plain {
            caption.hidden-text { "Failures after tuning by what they are worth" }
            thead { tr { th scope="col" { "Failure" } th scope="col" { "What it means" } th.right scope="col" { "Scenarios" } td {} th scope="col" { "Which" } } }
            tbody { @for class in FailureClass::ALL {
                @let of_class: Vec<&CaseRow> = context.suite.cases.iter().filter(|case| case.triage.as_ref().is_some_and(|triage| triage.class == class)).collect();
                tr {
                    th scope="row" { (parts::class_chip(class)) }
                    td.muted { (meaning(class)) }
                    td.right.number { (of_class.len()) }
                    td.bar-cell { (parts::bar(share(of_class.len()), "bad")) }
                    td {
                        @for (i, case) in of_class.iter().take(LONGEST_LIST).enumerate() {
                            @if i > 0 { ", " }
                            a href={ "#" (anchor::anchor(&case.scenario_id)) } { (words::clean(&case.scenario_id, 80)) }
                        }
                        @if of_class.len() > LONGEST_LIST { " and " (of_class.len() - LONGEST_LIST) " more; search the table for \u{201c}" (class.label()) "\u{201d}" }
                    }
                }
            } }
        } }
        p.muted { "Of the " (failures) " scenarios the ego fails at last. The other egos drive the same scenario on the native simulator; what the " (words::REGULATION_DRIVERS) ", make of a contact stands with each scenario." }
    }
}

/// Every ego on the last run's scenario.
pub fn of_case(case: Case) -> Markup {
    let Some(last) = case.view.last_run() else { return html! { p.empty { "It was not run." } } };
    let Some(triage) = &case.view.triage else {
        return html! { p.empty { "The ego does not fail this scenario, so no other ego was asked." } };
    };
    let kinds = last.finding_kinds();
    html! {
        @if let Some(cause) = last.run.cause { p { b { "Cause: " } (cause.label()) ". " span.muted { "Told by rules from the rollout: docs/models/causes.md." } } }
        (two_answers(triage, last.run.preventability.as_ref()))
        h3 { "Other egos in the same scenario" }
        .table-wrap { table.plain {
            caption.hidden-text { "Every ego on this scenario" }
            thead { tr { th scope="col" { "Ego" } th scope="col" { "Avoids it" } th scope="col" { "Result" } th scope="col" { "Least gap" } th scope="col" { "Ended by" } th scope="col" { "Findings" } } }
            tbody {
                (row(html! { b { (words::clean(case.context.ego, 60)) } " (under test)" }, "no", Result::of(Some(&last.run.judgement)), last.run.least_gap(), last.metrics.termination, &kinds))
                @for other in &triage.others {
                    (row(html! { (words::clean(&other.ego, 60)) }, avoids(other), if other.failed { Result::Failed } else { Result::Passed }, other.min_gap, other.termination, &other.findings))
                }
            }
        } }
    }
}

/// Whether an ego avoids what the system under test fails by, in a word or two.
fn avoids(other: &EgoOutcome) -> &'static str {
    match other.fared {
        // Where the system crashes, who only comes near avoids that.
        Fared::Avoids if other.failed => "the crash, but fails",
        Fared::Avoids => "yes",
        Fared::BeyondTyres => "beyond tyres alone",
        Fared::Alike => "no",
        Fared::Otherwise => "fails otherwise",
    }
}

/// What a class means, with the name of an ego as a page quotes it.
fn meaning(class: FailureClass) -> String {
    class.meaning().replacen('`', "\u{201c}", 1).replacen('`', "\u{201d}", 1)
}

/// Two questions with two answers, side by side: how other egos fare, and what the regulation's drivers make of the contact.
fn two_answers(triage: &Triage, found: Option<&Preventability>) -> Markup {
    html! {
        p.muted { "Two questions, and their answers may differ: the first is asked in the whole scenario, from the handover on; the second only along the road, from what both did before the contact." }
        .table-wrap { table.plain {
            caption.hidden-text { "What others make of this failure" }
            thead { tr { th scope="col" { "Asked" } th scope="col" { "Answer" } th scope="col" { "In words" } } }
            tbody {
                tr {
                    th scope="row" { "Other egos in the same scenario" }
                    td { (parts::class_chip(triage.class)) }
                    td { (words::capital(&meaning(triage.class))) "." }
                }
                tr {
                    th scope="row" { (words::capital(words::REGULATION_DRIVERS)) }
                    @match found {
                        Some(found) => { td { (found.bracket().label()) } td { (in_their_place(found)) span.muted { "docs/models/reference-drivers.md" } } },
                        None => { td { (parts::missing("there is no contact")) } td.muted { "They are asked about contacts." } },
                    }
                }
            }
        } }
    }
}

/// Each reference driver of the regulation whose source covers the contact.
fn in_their_place(found: &Preventability) -> Markup {
    let number = |value: f64| fixed(value, 1).unwrap_or_default();
    html! {
        @for (i, driver) in found.drivers.iter().enumerate() {
            @if i > 0 { ", " }
            (words::clean(&driver.driver, 40))
            @match driver.closing_speed_mps {
                None => " avoids it",
                Some(left) => { " touches at " (number(left)) "\u{a0}m/s of closing speed (the ego at " (number(found.closing_speed_mps)) ")" }
            }
        }
        @if !found.drivers.is_empty() { ". " }
    }
}

fn row(
    ego: Markup,
    avoids: &str,
    result: Result,
    gap: Option<Timed>,
    ended: TerminationKind,
    findings: &[FindingKind],
) -> Markup {
    html! {
        tr {
            th scope="row" { (ego) }
            td { (avoids) }
            td { (parts::result_chip(result)) }
            td { (parts::timed(gap, 2, "m", "no scripted partner took part")) }
            td { (ended.label()) }
            td { @for kind in findings { (parts::finding_chip(*kind)) " " } @if findings.is_empty() { (parts::missing("no finding")) } }
        }
    }
}
