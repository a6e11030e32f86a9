//! Small parts that many sections use.

use super::icon;
use crate::summary::Result;
use crate::words;
use maud::{Markup, html};
use recrash_model::metrics::{Answer, Check, CheckResult, FindingKind, Timed};
use recrash_model::narrative::Origin;
use recrash_model::record::RecordRef;
use recrash_model::review::ReviewBy;
use recrash_model::run::Judgement;
use recrash_model::triage::FailureClass;

/// A dash that says why there is no value.
pub fn missing(why: &str) -> Markup {
    let why = words::clean(why, 300);
    html! { span.missing title=(why) { "\u{2013}" span.hidden-text { " (" (why) ")" } } }
}

/// A number with its unit, or a dash that says why there is none.
pub fn quantity(value: Option<f64>, decimals: usize, unit: &str, why: &str) -> Markup {
    match value.map(|value| words::fixed(value, decimals)) {
        Some(Some(text)) => html! { span.number { (text) @if !unit.is_empty() { "\u{a0}" (unit) } } },
        Some(None) => missing("the value is not a finite number"),
        None => missing(why),
    }
}

/// A number with its unit and when it was taken.
pub fn timed(value: Option<Timed>, decimals: usize, unit: &str, why: &str) -> Markup {
    html! {
        (quantity(value.map(|timed| timed.value), decimals, unit, why))
        @if let Some(at) = value.and_then(|timed| words::fixed(timed.time_s, 1)) { span.at { " at " (at) "\u{a0}s" } }
    }
}

/// A text, or a dash that says why there is none.
pub fn text_or(value: Option<&str>, why: &str) -> Markup {
    match value {
        Some(text) if !text.trim().is_empty() => html! { (words::clean(text, 200)) },
        _ => missing(why),
    }
}

/// Whether the ego failed: a word, a colour, and the sign that the style gives to every chip of its class.
pub fn result_chip(result: Result) -> Markup {
    let class = match result {
        Result::Failed => "bad",
        Result::Struck => "odd",
        Result::Passed => "good",
        Result::NotMet | Result::Missing => "none",
    };
    let why = match result {
        Result::Struck => Some("a failure: it had stood for a second when it was struck, seldom by what it drove"),
        Result::NotMet => Some("it never came into the situation of the record: no failure, and no pass"),
        _ => None,
    };
    html! { span.chip.(class) title=[why] { (result.label()) } }
}

/// That a failure is one of the tuned scenario alone.
pub fn tuning_chip() -> Markup {
    html! { span.chip.odd title="it passes the crash as reconstructed, and fails after tuning within what the report leaves open" { "found by tuning" } }
}

/// Whether a run is true to its record, with the checks that say otherwise. Nobody's crash has no record to be true to.
pub fn faithful_chip(run: Option<&Judgement>, origin: Option<&Origin>) -> Markup {
    let Some(run) = run else { return missing("it was not run") };
    if matches!(origin, Some(Origin::Invented { .. })) {
        return html! { span.chip.none { "no record" } };
    }
    let listed = |checks: Vec<&Check>| {
        html! { @if !checks.is_empty() { span.why { (checks.iter().map(|check| check.kind.label()).collect::<Vec<_>>().join(", ")) } } }
    };
    match run.faithful() {
        Answer::Yes => html! { span.chip.good { "faithful" } },
        Answer::Unchecked => html! { span.chip.odd { "unchecked" } (listed(run.verdict.unchecked().collect())) },
        Answer::No => html! { span.chip.bad { "not faithful" } (listed(run.verdict.failures().collect())) },
    }
}

/// What a model finds that read the replay beside its report.
pub fn review_chip(review: Option<&ReviewBy>) -> Markup {
    let told = |by: &ReviewBy| format!("read beside its report by {}", words::clean(&by.model, 80));
    html! {
        @match review {
            None => "",
            Some(by) if by.review.is_right() => span.chip.good title=(told(by)) { "read: right" },
            Some(by) => span.chip.bad title=(told(by)) { "read: wrong" },
        }
    }
}

/// Whose crash is told, where it is not the picked record's own.
pub fn origin_chip(origin: Option<&Origin>, told: Option<&RecordRef>) -> Markup {
    let why = words::provenance(origin, told);
    html! {
        @match origin {
            None | Some(Origin::Own) => "",
            Some(Origin::Other { .. }) => span.chip.odd title=(words::clean(&why, 200)) { "another record" },
            Some(Origin::Invented { .. }) => span.chip.odd title=(words::clean(&why, 200)) { "invented" },
        }
    }
}

/// That a person edited files of a scenario, and which.
pub fn edited_chip(files: &[String]) -> Markup {
    html! {
        @if !files.is_empty() {
            span.chip.odd { "edited by hand" } span.why { (words::clean(&files.join(", "), 300)) }
        }
    }
}

/// The result of a check.
pub fn check_chip(result: CheckResult) -> Markup {
    match result {
        CheckResult::Shown => html! { span.chip.good { "shown" } },
        CheckResult::NotShown => html! { span.chip.bad { "not shown" } },
        CheckResult::CannotBeShown => html! { span.chip.odd { "cannot be shown" } },
        CheckResult::NotTold => html! { span.chip.none { "not stated" } },
    }
}

/// A kind of finding.
pub fn finding_chip(kind: FindingKind) -> Markup {
    let class = if kind.is_failure() { "bad" } else { "odd" };
    html! { span.chip.(class) { (kind.label()) } }
}

/// What a failure is worth.
pub fn class_chip(class: FailureClass) -> Markup {
    let kind = match class {
        FailureClass::Avoidable | FailureClass::Quirk => "bad",
        FailureClass::BeyondReference => "odd",
        FailureClass::Unavoidable | FailureClass::Unclear => "none",
    };
    html! { span.chip.(kind) { (class.label()) } }
}

/// A command with a button that copies it.
pub fn command(command: &str) -> Markup {
    html! {
        .command {
            code { (words::clean(command, 2000)) }
            button.small type="button" data-copy="" title="Copy" aria-label="Copy the command" { (icon::copy()) }
        }
    }
}

/// A bar for a share in [0, 1], drawn without inline style.
pub fn bar(share: f64, class: &str) -> Markup {
    let width = words::fixed(share.clamp(0.0, 1.0) * 100.0, 1).unwrap_or_default();
    html! { svg.bar.(class) viewBox="0 0 100 8" preserveAspectRatio="none" aria-hidden="true" { rect.ground width="100" height="8" {} rect.fill width=(width) height="8" {} } }
}

/// The share of a part in a whole; 0 of nothing.
pub fn share(part: usize, whole: usize) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}

/// One of six shades; roots, so that small counts can be told apart.
pub fn heat(n: usize, most: usize) -> &'static str {
    const SHADES: [&str; 6] = ["heat-0", "heat-1", "heat-2", "heat-3", "heat-4", "heat-5"];
    if n == 0 {
        return SHADES[0];
    }
    SHADES[1 + (share(n, most).sqrt() * 4.999) as usize % 5]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shades_grow_with_the_count_and_keep_zero_apart() {
        assert_eq!([0, 1, 30, 60, 120].map(|n| heat(n, 120)), ["heat-0", "heat-1", "heat-3", "heat-4", "heat-5"]);
    }
}
