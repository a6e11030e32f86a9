//! What a check has to say, and the checks of numbers, counts and names that all its parts use.

use recrash_model::Diagnostic;
use std::fmt::Display;

/// Steps a policy may count, 0.1 s each: more than the longest rollout has.
const MAX_STEPS: u32 = 10_000;

/// A JSON path, which is written out only where there is something to say of it.
pub(super) type At<'a> = std::fmt::Arguments<'a>;

/// The diagnostics of one check.
#[derive(Default)]
pub(super) struct Remarks {
    pub(super) list: Vec<Diagnostic>,
}

impl Remarks {
    pub(super) fn error(
        &mut self,
        code: &str,
        path: impl Into<String>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.list.push(Diagnostic::error_at(code, path, message).with_hint(hint));
    }

    pub(super) fn warn(
        &mut self,
        code: &str,
        path: impl Into<String>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.list.push(Diagnostic::warning_at(code, path, message).with_hint(hint));
    }

    /// How many of them are errors.
    pub(super) fn errors(&self) -> usize {
        self.list.iter().filter(|remark| remark.is_error()).count()
    }

    /// Whether a number is finite and in range; says so where it is not.
    pub(super) fn number(&mut self, path: impl Display, value: f64, min: f64, max: f64, unit: &str) -> bool {
        if (min..=max).contains(&value) {
            return true;
        }
        let path = path.to_string();
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let allowed = format!("allowed: {} to {}{unit}", shown(min), shown(max));
        let (code, message) = if value.is_finite() {
            ("scenario.range", format!("{} is {}{unit}, out of range", last_name(&path), shown(value)))
        } else {
            ("scenario.not-finite", format!("{} is {value}, which is no finite number", last_name(&path)))
        };
        self.error(code, path, message, allowed);
        false
    }

    pub(super) fn count(&mut self, path: impl Display, found: usize, most: usize) -> bool {
        if found > most {
            let path = path.to_string();
            let message = format!("{found} {path}, at most {most} are allowed");
            self.error("scenario.count", path, message, "leave out those that the conflict does not need");
        }
        found <= most
    }

    pub(super) fn steps(&mut self, path: impl Display, value: u32) {
        if value > MAX_STEPS {
            let path = path.to_string();
            let message = format!("{} is {value} steps, out of range", last_name(&path));
            self.error("scenario.range", path, message, format!("allowed: 0 to {MAX_STEPS} steps of 0.1 s"));
        }
    }
}

fn last_name(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// The beginning of a text that may be very long.
pub(super) fn shorten(text: &str) -> String {
    if text.chars().count() <= 40 { text.to_owned() } else { text.chars().take(40).chain(['…']).collect() }
}

pub(super) fn name(path: impl Display, text: &str, longest: usize, marks: &str, remarks: &mut Remarks) {
    let length = text.chars().count();
    let allowed = || {
        let listed = marks.chars().map(|mark| format!("'{mark}'")).collect::<Vec<_>>().join(", ");
        format!("allowed: 1 to {longest} letters a-z A-Z, digits and {listed}")
    };
    let (message, hint) = if length == 0 || length > longest {
        (format!("the id has {length} characters"), allowed())
    } else if let Some(bad) = text.chars().find(|c| !c.is_ascii_alphanumeric() && !marks.contains(*c)) {
        (format!("the id {:?} holds {bad:?}", shorten(text)), allowed())
    } else if text.starts_with('.') {
        (format!("the id {text:?} begins with a dot"), "begin with a letter or digit".to_owned())
    } else {
        return;
    };
    remarks.error("scenario.id", path.to_string(), message, hint);
}

/// A number for a message: at most three decimals, as short as possible.
pub(super) fn shown(value: f64) -> String {
    if !value.is_finite() {
        return format!("{value}");
    }
    if value != 0.0 && !(1e-3..1e9).contains(&value.abs()) {
        return format!("{value:e}");
    }
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
