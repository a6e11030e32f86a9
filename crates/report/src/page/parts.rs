//! Small parts that many sections use.

use super::icon;
use crate::summary::Result;
use crate::view::RunView;
use crate::words;
use maud::{Markup, html};
use recrash_model::metrics::{Answer, CheckResult, FindingKind, Timed};
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

/// Whether the ego failed: a sign, a word and a colour.
pub fn result_chip(result: Result) -> Markup {
    let (class, sign) = match result {
        Result::Failed => ("bad", icon::cross()),
        Result::Passed => ("good", icon::tick()),
        Result::Missing => ("none", icon::dash()),
    };
    html! { span.chip.(class) { (sign) (result.label()) } }
}

/// Whether a run is faithful, with the checks that failed.
pub fn faithful_chip(run: Option<&RunView>) -> Markup {
    let Some(run) = run else { return missing("it was not run") };
    match run.faithful() {
        Answer::Unchecked => return html! { span.chip.odd { (icon::bang()) "not all checked" } },
        Answer::Yes => return html! { span.chip.good { (icon::tick()) "faithful" } },
        Answer::No => {}
    }
    let why: Vec<&str> = run.verdict.failures().map(|check| check.kind.label()).collect();
    html! { span.chip.bad { (icon::cross()) "not faithful" } span.why { (why.join(", ")) } }
}

/// The result of a check.
pub fn check_chip(result: CheckResult) -> Markup {
    match result {
        CheckResult::Shown => html! { span.chip.good { (icon::tick()) "shown" } },
        CheckResult::NotShown => html! { span.chip.bad { (icon::cross()) "not shown" } },
        CheckResult::CannotBeShown => html! { span.chip.odd { (icon::bang()) "cannot be shown" } },
        CheckResult::NotTold => html! { span.chip.none { (icon::dash()) "not told" } },
    }
}

/// A kind of finding.
pub fn finding_chip(kind: FindingKind) -> Markup {
    let (class, sign) = if kind.is_failure() { ("bad", icon::cross()) } else { ("odd", icon::bang()) };
    html! { span.chip.(class) { (sign) (kind.label()) } }
}

/// What a failure is worth.
pub fn class_chip(class: FailureClass) -> Markup {
    let (kind, sign) = match class {
        FailureClass::Avoidable | FailureClass::Quirk => ("bad", icon::bang()),
        FailureClass::BeyondReference => ("odd", icon::bang()),
        FailureClass::Unavoidable => ("none", icon::dash()),
    };
    html! { span.chip.(kind) title=(class.meaning()) { (sign) (class.label()) } }
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
