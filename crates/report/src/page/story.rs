//! The records a case came from, and the narrative made of them: every fact with the words it came from.

use super::{Case, icon, parts};
use crate::view::Changed;
use crate::words::{self, LONGEST_TEXT};
use maud::{Markup, html};
use recrash_model::narrative::{Fact, FactSource, Narrative};
use recrash_model::record::{CrashRecord, RecordRef};
use recrash_model::review::{LONGEST_NOTE, ReviewBy};
use std::ops::Range;

/// Members of the cluster named besides those shown. [count]
const LONGEST_MEMBER_LIST: usize = 60;

/// Narrative and records.
pub fn story(case: Case) -> Markup {
    let (context, row) = (case.context, case.row);
    let facts = case.view.narrative.as_ref().map_or(&[][..], |narrative| &narrative.facts);
    let shown: Vec<&CrashRecord> = context.case_records(row).collect();
    let members = context.cluster.map_or(&[][..], |cluster| &cluster.members);
    let others: Vec<&CrashRecord> = members
        .iter()
        .filter(|member| !row.records.contains(member))
        .filter_map(|&member| context.records.get(member))
        .collect();
    html! {
        .columns.story {
            div {
                h2 { "Narrative of the scenario" }
                @if let Some(changed) = &row.changed { (restaged(changed)) }
                @match &case.view.narrative { Some(narrative) => (told(narrative, shown.first().map(|pick| &pick.id))), None => p.empty { "No narrative was written." } }
            }
            div {
                h2 { "Records" }
                @if let Some(by) = &row.review { (reviewed(by)) }
                @if shown.is_empty() { p.empty { "The suite names no record." } }
                @for (order, record) in shown.iter().enumerate() { (record_panel(record, facts, order == 0)) }
                @if !others.is_empty() {
                    p.muted { (words::count(others.len(), "more record")) " in the cluster: "
                        @for record in others.iter().take(LONGEST_MEMBER_LIST) { span.mono { (words::clean(&record.id.to_string(), 40)) } " " }
                        @if others.len() > LONGEST_MEMBER_LIST { "\u{2026}" }
                    }
                }
            }
        }
    }
}

/// What a language model finds that held the replay against these records.
fn reviewed(by: &ReviewBy) -> Markup {
    let wrong: Vec<&str> = by.review.wrong().collect();
    html! {
        p.review { "Read beside its report by " b { (words::clean(&by.model, 80)) } ": "
            @if wrong.is_empty() { "the recorded driver's run shows it." }
            @else { "the recorded driver's run does not show it (" (wrong.join(", ")) "): " span dir="auto" { (words::clean(&by.review.note, LONGEST_NOTE)) } }
        }
    }
}

/// What a language model changed in what the rules staged.
fn restaged(changed: &Changed) -> Markup {
    html! {
        p.review { "Staged by the rules, and changed by " b { (words::clean(&changed.model, 80)) } ": " span dir="auto" { (words::clean(&changed.what, LONGEST_TEXT)) } }
    }
}

fn told(narrative: &Narrative, pick: Option<&RecordRef>) -> Markup {
    html! {
        @if let Some(reason) = narrative.origin.reason() {
            p.banner role="note" { (icon::bang()) span { strong { (words::capital(narrative.origin.label())) ". " } @if pick.is_some() { "It takes the record's place: " } (words::clean(reason, 400)) } }
        }
        blockquote.narrative dir="auto" { (words::clean(&narrative.text, LONGEST_TEXT)) }
        p.muted { "Written by " (words::name(&narrative.author)) ". Point at a fact to see the words it came from." }
        .table-wrap { table.plain.facts {
            caption.hidden-text { "Facts the narrative states" }
            thead { tr { th scope="col" { "Fact" } th scope="col" { "Value" } th scope="col" { "From" } } }
            tbody { @for (number, fact) in narrative.facts.iter().enumerate() { (fact_row(number, fact, pick)) } }
        } }
        @if narrative.facts.is_empty() { p.empty { "It states no facts." } }
    }
}

/// The record a fact was taken from.
fn record_of(fact: &Fact) -> Option<&RecordRef> {
    match &fact.source {
        FactSource::Column { record, .. } | FactSource::Words { record, .. } => Some(record),
        FactSource::Assumed { .. } => None,
    }
}

fn fact_row(number: usize, fact: &Fact, pick: Option<&RecordRef>) -> Markup {
    let record = record_of(fact);
    let (name, value) = words::fact(&fact.value);
    let (kind, text) = words::source(&fact.source);
    let column = match &fact.source {
        FactSource::Column { column, .. } => Some(words::clean(column, 120)),
        _ => None,
    };
    html! {
        tr tabindex="0" data-fact=(number) data-column=[column] data-record=[record.map(short_id)] {
            th scope="row" { (name) }
            td { (value) }
            td { span.tag.{ "from-" (kind) } { (kind) } " " span.source { (text) }
                // Where another record of the cluster is retold, it is named.
                @if record.is_some() && record != pick { span.at { " in " span.mono { (record.map(short_id).unwrap_or_default()) } } }
            }
        }
    }
}

fn short_id(record: &RecordRef) -> String {
    words::clean(&record.to_string(), 60).into_owned()
}

fn record_panel(record: &CrashRecord, facts: &[Fact], pick: bool) -> Markup {
    let cited = facts.iter().any(|fact| record_of(fact) == Some(&record.id));
    let id = short_id(&record.id);
    html! {
        details.record open[pick || cited] data-record=(id) {
            summary {
                span.mono { (id) } " " span.muted { (words::clean(&record.entity, 60)) }
                @if pick { " " span.tag { "pick" } }
                @if cited && !pick { " " span.tag { "retold" } }
            }
            (columns(record))
            h3 { "Narrative as filed" }
            @if record.narrative.trim().is_empty() { p.empty { "The narrative is " (words::name(&record.redaction)) "." } }
            @else {
                blockquote.filed dir="auto" {
                    @for (text, of) in marked(&record.narrative, &record.id, facts) {
                        @if of.is_empty() { (text) } @else {
                            mark data-facts=(of.iter().map(usize::to_string).collect::<Vec<_>>().join(" ")) { (text) }
                        }
                    }
                }
            }
        }
    }
}

fn columns(record: &CrashRecord) -> Markup {
    let blank = "the cell is empty";
    let row = |name: &str, columns: &str, value: Result<Markup, &str>| {
        html! { tr data-columns=(columns) { th scope="row" { (name) } td { @match value { Ok(value) => (value), Err(why) => (parts::missing(why)) } } } }
    };
    let text = |value: String| html! { (value) };
    let coded_text = |value: Result<String, &'static str>| value.map(text);
    let speed = |value: Option<f64>| value.and_then(words::speed).map(text).ok_or(blank);
    let zones = |zones: &[recrash_model::zones::ContactZone]| {
        if zones.is_empty() { Err("no zone is ticked") } else { Ok(text(words::zones(zones))) }
    };
    let weather: Vec<String> = record.weather.iter().map(words::name).collect();
    let when = record.when.map(|when| {
        let clock = record.time_of_day_min.map(|minutes| format!(", {}", words::clock(minutes))).unwrap_or_default();
        html! { (when) (clock) }
    });
    html! {
        .record-columns {
            table.plain.tight { tbody {
                (row("When", "Incident Date Incident Time", when.ok_or(blank)))
                (row("Where", "City State", Ok(parts::text_or(Some(&record.place), blank))))
                (row("Vehicle", "Make Model", Ok(parts::text_or(Some(&record.vehicle), blank))))
                (row("Road", "Roadway Type", coded_text(words::coded(&record.road, |road| road.label().to_owned())).map(|road| html! { (road) @if record.work_zone { ", work zone" } })))
                (row("Surface, light", "Roadway Surface Lighting", Ok(html! {
                    (record.surface.map_or_else(|| "unknown".to_owned(), |s| words::name(&s))) ", " (record.lighting.map_or_else(|| "unknown".to_owned(), |l| words::name(&l)))
                })))
                (row("Weather", "Weather", if weather.is_empty() { Err(blank) } else { Ok(text(weather.join(", "))) }))
                (row("Posted speed", "Posted Speed Limit (MPH)", speed(record.posted_speed_mps)))
            } }
            table.plain.tight { tbody {
                (row("SV movement", "SV Pre-Crash Movement", coded_text(words::coded(&record.sv_movement, |m| m.label().to_owned()))))
                (row("SV speed", "SV Precrash Speed (MPH)", speed(record.sv_speed_mps)))
                (row("SV contact", "SV Contact Area SV and CP Contact Area", zones(&record.sv_zones)))
                (row("CP", "Crash With", coded_text(words::coded(&record.partner, |kind| words::name(&kind)))))
                (row("CP movement", "CP Pre-Crash Movement", coded_text(words::coded(&record.cp_movement, |m| m.label().to_owned()))))
                (row("CP contact", "CP Contact Area SV and CP Contact Area", zones(&record.cp_zones)))
                (row("Injury", "Highest Injury Severity Alleged", coded_text(words::coded(&record.severity, |s| words::name(&s)))))
            } }
        }
        p.muted.small { "Row " (record.provenance.row) " of " (words::clean(&record.provenance.file, 80)) @if let Some(incident) = &record.incident_id { ", incident " span.mono { (words::clean(incident, 60)) } } }
    }
}

/// The narrative cut into pieces, each with the numbers of the facts whose words it belongs to.
fn marked(narrative: &str, record: &RecordRef, facts: &[Fact]) -> Vec<(String, Vec<usize>)> {
    let text = words::clean(narrative, LONGEST_TEXT);
    let mut found: Vec<(usize, Range<usize>)> = Vec::new();
    for (number, fact) in facts.iter().enumerate() {
        if let FactSource::Words { record: of, words } = &fact.source
            && of == record
        {
            // Clauses that a source leaves out are written as dots; each part is looked for on its own.
            let parts = words.split("\u{2026}").flat_map(|part| part.split("...")).map(str::trim);
            found.extend(parts.filter(|part| !part.is_empty()).filter_map(|part| Some((number, find(&text, part)?))));
        }
    }
    let mut cuts: Vec<usize> = found.iter().flat_map(|(_, range)| [range.start, range.end]).collect();
    cuts.extend([0, text.len()]);
    cuts.sort_unstable();
    cuts.dedup();
    let piece = |cut: &[usize]| {
        let (start, end) = (cut[0], cut[1]);
        let mut of: Vec<usize> = found
            .iter()
            .filter(|(_, range)| range.start <= start && end <= range.end)
            .map(|(number, _)| *number)
            .collect();
        of.dedup();
        (text[start..end].to_owned(), of)
    };
    cuts.windows(2).map(piece).collect()
}

/// Where words stand in a text: as they are, or with other spaces and other case (ASCII).
fn find(text: &str, words: &str) -> Option<Range<usize>> {
    if let Some(start) = text.find(words) {
        return Some(start..start + words.len());
    }
    let squeeze = |text: &str| {
        let mut letters: Vec<(char, usize)> = Vec::with_capacity(text.len());
        for (position, letter) in text.char_indices() {
            let letter = if letter.is_whitespace() { ' ' } else { letter.to_ascii_lowercase() };
            if letter != ' ' || letters.last().is_some_and(|(last, _)| *last != ' ') {
                letters.push((letter, position));
            }
        }
        letters
    };
    let (text_letters, word_letters) = (squeeze(text), squeeze(words));
    let start = text_letters
        .windows(word_letters.len().max(1))
        .position(|window| window.iter().zip(&word_letters).all(|((a, _), (b, _))| a == b))?;
    let (last, position) = text_letters[start + word_letters.len().max(1) - 1];
    let end = text[position..].chars().next().map_or(position, |letter| position + letter.len_utf8());
    debug_assert!(last == ' ' || end <= text.len());
    Some(text_letters[start].1..end)
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::narrative::{FactValue, Signal};

    fn fact(words: &str) -> Fact {
        let record = RecordRef { report_id: "1".into(), version: 1 };
        let value = FactValue::SvSignal { signal: Signal::Green };
        Fact { value, source: FactSource::Words { record, words: words.into() } }
    }

    fn pieces(text: &str, facts: &[Fact]) -> Vec<(String, Vec<usize>)> {
        marked(text, &RecordRef { report_id: "1".into(), version: 1 }, facts)
    }

    #[test]
    fn overlapping_words_are_cut_where_they_begin_and_end() {
        let found = pieces("one two three four", &[fact("two three"), fact("three four")]);
        let expected = [("one ", vec![]), ("two ", vec![0]), ("three", vec![0, 1]), (" four", vec![1])];
        assert_eq!(found, expected.map(|(text, of)| (text.to_owned(), of)));
    }

    #[test]
    fn words_are_found_over_other_spaces_and_case() {
        let found = pieces("The \u{e9}clair TURNED\n  left here", &[fact("turned left")]);
        assert_eq!(found[1], ("TURNED\n  left".to_owned(), vec![0]));
    }

    #[test]
    fn words_that_do_not_stand_there_mark_nothing() {
        assert_eq!(pieces("one two", &[fact("three"), fact("")]), [("one two".to_owned(), vec![])]);
        assert!(pieces("", &[fact("x")]).is_empty());
    }
}
