//! What the failures are worth: how the other egos fare in the same scenarios.

use super::case::Case;
use super::{Context, parts};
use crate::summary::Result;
use crate::view::CaseRow;
use crate::{anchor, words};
use maud::{Markup, html};
use recrash_model::metrics::{FindingKind, Timed};
use recrash_model::rollout::TerminationKind;
use recrash_model::triage::FailureClass;

/// Scenarios of a class that are named; the table finds the rest. [count]
const LONGEST_LIST: usize = 30;

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
                    td.muted { (class.meaning()) }
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
        p.muted { "Of the " (failures) " scenarios the ego fails at last. The other egos drive the same scenario on the native simulator." }
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
        p { (parts::class_chip(triage.class)) " " (words::capital(triage.class.meaning())) "." }
        .table-wrap { table.plain {
            caption.hidden-text { "Every ego on this scenario" }
            thead { tr { th scope="col" { "Ego" } th scope="col" { "Avoids it" } th scope="col" { "Result" } th scope="col" { "Least gap" } th scope="col" { "Ended by" } th scope="col" { "Findings" } } }
            tbody {
                (row(html! { b { (words::clean(case.context.ego, 60)) } " (under test)" }, false, last.failed(), last.metrics.min_gap, last.metrics.termination, &kinds))
                @for other in &triage.others {
                    (row(html! { (words::clean(&other.ego, 60)) }, other.avoids, other.failed, other.min_gap, other.termination, &other.findings))
                }
            }
        } }
    }
}

fn row(
    ego: Markup,
    avoids: bool,
    failed: bool,
    gap: Option<Timed>,
    ended: TerminationKind,
    findings: &[FindingKind],
) -> Markup {
    html! {
        tr {
            th scope="row" { (ego) }
            td { @if avoids { "yes" } @else { "no" } }
            td { (parts::result_chip(if failed { Result::Failed } else { Result::Passed })) }
            td { (parts::timed(gap, 2, "m", "no scripted partner took part")) }
            td { (words::name(&ended)) }
            td { @for kind in findings { (parts::finding_chip(*kind)) " " } @if findings.is_empty() { (parts::missing("no finding")) } }
        }
    }
}
