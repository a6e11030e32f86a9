//! From nouns to words and numbers to text, the same everywhere on the page.

use crate::view::CaseRow;
use recrash_model::metrics::FindingKind;
use recrash_model::narrative::{FactSource, FactValue, Origin};
use recrash_model::record::{Coded, MPS_PER_MPH, RecordRef};
use recrash_model::run::Judgement;
use recrash_model::template::Template;
use recrash_model::zones::ContactZone;
use serde::Serialize;
use serde_json::Value;
use std::borrow::Cow;

/// The driver who drives as recorded; the system under test takes over in the runs of all others.
pub const RECORDED: &str = "recorded";

/// Longest text shown of one field of a record; the rest stays in the file. [characters]
pub const LONGEST_TEXT: usize = 12_000;

/// Who [`recrash_model::preventability`] is about, told apart from the other egos of [`recrash_model::triage`].
pub const REGULATION_DRIVERS: &str = "reference drivers of UN R157, on its straight-road model";

/// A number with so many decimals; never `-0.00`. Not a finite number: `None`.
pub fn fixed(value: f64, decimals: usize) -> Option<String> {
    if !value.is_finite() {
        return None;
    }
    let text = format!("{value:.decimals$}");
    let zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    Some(if zero { text.trim_start_matches('-').to_owned() } else { text })
}

/// A speed in both units, such as `8.0 m/s (18 mph)`.
pub fn speed(mps: f64) -> Option<String> {
    Some(format!("{}\u{a0}m/s ({}\u{a0}mph)", fixed(mps, 1)?, fixed(mps / MPS_PER_MPH, 0)?))
}

/// A count with its noun, such as `1 record`, `2 records`.
pub fn count(n: usize, noun: &str) -> String {
    if n == 1 { format!("1 {noun}") } else { format!("{} {noun}s", thousands(n)) }
}

/// A whole number with commas between thousands.
pub fn thousands(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (position, digit) in digits.chars().enumerate() {
        if position > 0 && (digits.len() - position).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Untrusted text made fit to print: control characters replaced, and no longer than `longest` characters.
pub fn clean(text: &str, longest: usize) -> Cow<'_, str> {
    let odd = |c: char| c.is_control() && !matches!(c, '\n' | '\r' | '\t');
    let end = text.char_indices().nth(longest).map(|(position, _)| position);
    let head = end.map_or(text, |end| &text[..end]);
    let head = if head.contains(odd) { Cow::Owned(head.replace(odd, "\u{fffd}")) } else { Cow::Borrowed(head) };
    if end.is_some() { Cow::Owned(format!("{head}\u{2026}")) } else { head }
}

/// The name of a unit variant, in words: `heavy_truck` is "heavy truck".
pub fn name(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(Value::String(text)) => in_words(&text),
        Ok(Value::Object(map)) => map.keys().next().map_or_else(String::new, |key| in_words(key)),
        _ => String::new(),
    }
}

fn in_words(name: &str) -> String {
    let word = |word: &str| match word {
        "suv" | "sv" | "cp" | "ads" | "adas" | "idm" => word.to_uppercase(),
        _ => word.to_owned(),
    };
    name.split('_').map(word).collect::<Vec<_>>().join(" ")
}

/// The same with a capital letter.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Contact zones, joined.
pub fn zones(zones: &[ContactZone]) -> String {
    zones.iter().map(|zone| zone.label()).collect::<Vec<_>>().join(", ")
}

/// A coded value, or what stands in its place and why.
pub fn coded<T: Copy>(value: &Coded<T>, label: impl Fn(T) -> String) -> Result<String, &'static str> {
    match value {
        Coded::Known(value) => Ok(label(*value)),
        Coded::Other => Ok("other, see narrative".to_owned()),
        Coded::Unknown => Ok("unknown".to_owned()),
        Coded::Blank => Err("the cell is empty"),
        Coded::Unlisted(text) => Ok(format!("\u{201c}{}\u{201d} (in no code table)", clean(text, 80))),
    }
}

/// What a fact states: its name and its value.
pub fn fact(value: &FactValue) -> (String, String) {
    if let FactValue::Contact { sv, cp } = value {
        let told = |of: &[ContactZone]| if of.is_empty() { "none named".to_owned() } else { zones(of) };
        return ("Contact".to_owned(), format!("SV {}; CP {}", told(sv), told(cp)));
    }
    let Ok(Value::Object(fields)) = serde_json::to_value(value) else { return (String::new(), String::new()) };
    let tag = fields.get("fact").and_then(Value::as_str).unwrap_or_default();
    let parts: Vec<String> = fields
        .iter()
        .filter(|(key, _)| *key != "fact")
        .map(|(key, value)| field(key, value, fields.len() > 2))
        .collect();
    let said = if parts.is_empty() { "yes".to_owned() } else { parts.join(", ") };
    (capital(&in_words(tag)), said)
}

fn field(key: &str, value: &Value, named: bool) -> String {
    let unit = [("_mps2", "m/s\u{b2}"), ("_mps", "m/s"), ("_s", "s"), ("_m", "m")];
    let (name, unit) = unit
        .iter()
        .find_map(|(end, unit)| key.strip_suffix(end).map(|name| (name, format!("\u{a0}{unit}"))))
        .unwrap_or((key, String::new()));
    let text = match value {
        Value::String(text) => in_words(&clean(text, 200)),
        Value::Array(items) if items.is_empty() => "none named".to_owned(),
        Value::Array(items) => items.iter().map(|item| field("", item, false)).collect::<Vec<_>>().join(" + "),
        Value::Number(number) if number.is_f64() => {
            number.as_f64().and_then(|number| fixed(number, 1)).unwrap_or_default() + &unit
        }
        Value::Bool(true) => "yes".to_owned(),
        Value::Bool(false) => "no".to_owned(),
        Value::Null => "none".to_owned(),
        other => other.to_string() + &unit,
    };
    if named { format!("{} {text}", in_words(name)) } else { text }
}

/// Where a fact came from: the kind of source, and its words.
pub fn source(source: &FactSource) -> (&'static str, Cow<'_, str>) {
    match source {
        FactSource::Column { column, text, .. } => {
            ("column", Cow::Owned(format!("{}: {}", clean(column, 120), clean(text, 200))))
        }
        FactSource::Words { words, .. } => ("words", Cow::Owned(format!("\u{201c}{}\u{201d}", clean(words, 400)))),
        FactSource::Assumed { why } => ("assumed", clean(why, 400)),
    }
}

/// Whose crash is told, such as `another record, 90000-1001/1: the pick is redacted`.
pub fn provenance(origin: Option<&Origin>, told: Option<&RecordRef>) -> String {
    let Some(origin) = origin else { return "no narrative was written".to_owned() };
    let record = told.map_or_else(String::new, |record| format!(", {record}"));
    let reason = origin.reason().map_or_else(String::new, |reason| format!(": {reason}"));
    format!("{}{record}{reason}", origin.label())
}

/// A template in few words, such as "Intersection, SV straight, CP left turn".
pub fn template(template: &Template) -> String {
    template.to_string().replace("proceeding straight", "straight")
}

/// Time of day from minutes after midnight.
pub fn clock(minutes: u16) -> String {
    format!("{:02}:{:02}", minutes / 60 % 24, minutes % 60)
}

/// What is said beside a least gap below the limit of a near miss that is none: nobody came nearer than the scene, or the
/// system's part of it, begins with.
pub fn gap_note(run: &Judgement, limit_m: f64, by_account: bool) -> Option<&'static str> {
    let near = run.metrics.min_gap.is_some_and(|gap| gap.value < limit_m);
    let found = run.findings.iter().any(|finding| finding.kind == FindingKind::NearMiss);
    let handed_over = by_account && run.ego != RECORDED;
    (near && !found && run.metrics.contact.is_none()).then_some(match handed_over {
        true => "stood so at the handover, not approached",
        false => "stood so at the start, not approached",
    })
}

/// Why the system under test was not run in a scenario that was not refused.
pub fn not_run(case: &CaseRow) -> &'static str {
    match &case.account {
        Some(_) if case.before.is_some() => "it was parked: there is nothing to test",
        _ => "it was not run",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_never_show_a_negative_zero_nor_what_is_not_finite() {
        assert_eq!(fixed(-0.001, 2).as_deref(), Some("0.00"));
        assert_eq!(fixed(-1.5, 1).as_deref(), Some("-1.5"));
        assert_eq!(fixed(f64::NAN, 1), None);
        assert_eq!(fixed(f64::INFINITY, 1), None);
    }

    #[test]
    fn thousands_are_parted() {
        assert_eq!([0, 999, 1000, 2_295_000].map(thousands), ["0", "999", "1,000", "2,295,000"]);
    }

    #[test]
    fn cleaning_cuts_at_characters_and_replaces_controls() {
        assert_eq!(clean("a\u{0}b\nc", 10), "a\u{fffd}b\nc");
        assert_eq!(clean("\u{1f697}\u{1f697}\u{1f697}", 2), "\u{1f697}\u{1f697}\u{2026}");
    }

    #[test]
    fn facts_are_told_in_words_with_units() {
        use recrash_model::narrative::Signal;
        use recrash_model::scenario::Approach;
        assert_eq!(fact(&FactValue::SvSpeed { speed_mps: 8.04 }), ("SV speed".into(), "8.0\u{a0}m/s".into()));
        assert_eq!(fact(&FactValue::Approach { approach: Approach::Left }), ("Approach".into(), "left".into()));
        assert_eq!(fact(&FactValue::CpSignal { signal: Signal::StopSign }), ("CP signal".into(), "stop sign".into()));
        let zones = FactValue::Contact { sv: vec![ContactZone::FrontLeft, ContactZone::Left], cp: vec![] };
        assert_eq!(fact(&zones), ("Contact".into(), "SV front left, left; CP none named".into()));
    }
}
