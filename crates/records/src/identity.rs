//! Which rows tell of the same thing: versions of one report, and reports of one incident.

use crate::row::Draft;
use recrash_model::record::{CrashRecord, RecordRef, Redaction};
use recrash_model::{Diagnostic, Location, Severity};
use std::collections::BTreeMap;

/// A narrative up to this long with one of [`REFERENCES`] in it only refers to another report. In the published files
/// the longest such has 355 bytes, and no story up to 420 holds one of the phrases. [byte]
const LONGEST_REFERENCE_BYTES: usize = 400;

/// Turns of phrase of narratives that only refer to another report.
const REFERENCES: [&str; 11] = [
    "refer to",
    "see report",
    "for narrative details",
    "no update to narrative",
    "no additional information",
    "no new information",
    "no further information",
    "no change to narrative",
    "see original report",
    "not received notice of any material new",
    "delete this report",
];

/// Which drafts are merged into another one, and remarks. In this order: the newest version of each report stays, with
/// the narrative of an earlier version where its own cannot be read or only refers to it; a report that only refers to
/// another report gives way to that one; of the reports of one incident one stays, readable before withheld, the
/// operator's own before a manufacturer's copy, one with a template before one without, the first in file order.
pub fn merge(drafts: &mut [Draft]) -> (Vec<bool>, Vec<Diagnostic>) {
    let mut merged = vec![false; drafts.len()];
    let mut diagnostics = Vec::new();

    for versions in groups(drafts, |draft| Some(&draft.record.id.report_id)) {
        let newest = versions.iter().copied().max_by_key(|&i| (drafts[i].record.id.version, i));
        let Some(newest) = newest else { continue };
        let mut older: Vec<usize> = versions.into_iter().filter(|&i| i != newest).collect();
        older.sort_by_key(|&i| std::cmp::Reverse((drafts[i].record.id.version, i)));
        if !tells_its_story(&drafts[newest])
            && let Some(&source) = older.iter().find(|&&i| tells_its_story(&drafts[i]))
        {
            diagnostics.push(take_narrative(drafts, newest, source));
        }
        older.into_iter().for_each(|i| merged[i] = true);
    }

    for (to, from) in references(drafts, &merged) {
        merged[to] = true;
        diagnostics.push(refers_to(drafts, to, from));
    }

    for reports in groups(drafts, |draft| draft.record.incident_id.as_deref()) {
        let reports: Vec<usize> = reports.into_iter().filter(|&i| !merged[i]).collect();
        let best = reports.iter().copied().max_by_key(|&i| {
            let draft = &drafts[i];
            (tells_its_story(draft), draft.operator_reports, draft.record.template().is_some(), std::cmp::Reverse(i))
        });
        reports.into_iter().filter(|&i| Some(i) != best).for_each(|i| merged[i] = true);
    }
    (merged, diagnostics)
}

/// What there is to say about rows that share report id and version and differ: each report is there once in a published file.
pub fn differing(drafts: &[Draft]) -> Option<Diagnostic> {
    let mut of_id: BTreeMap<&RecordRef, Vec<&CrashRecord>> = BTreeMap::new();
    drafts.iter().for_each(|draft| of_id.entry(&draft.record.id).or_default().push(&draft.record));
    let differ = |records: &[&CrashRecord]| records[1..].iter().any(|record| !is_same(records[0], record));
    let groups: Vec<(&RecordRef, Vec<&CrashRecord>)> =
        of_id.into_iter().filter(|(_, records)| differ(records)).collect();
    let (id, first) = groups.first()?;
    let count: usize = groups.iter().map(|(_, records)| records.len()).sum();
    let rows: Vec<String> = first
        .iter()
        .take(ROWS_SHOWN)
        .map(|record| format!("row {} of {}", record.provenance.row, record.provenance.file))
        .collect();
    let more = if first.len() > rows.len() { format!(" and {} more", first.len() - rows.len()) } else { String::new() };
    let message = format!(
        "{count} rows share report id and version with another one and differ; the first: {id} in {}{more}",
        rows.join(", ")
    );
    let location = Location::at_row(first[0].provenance.file.clone(), first[0].provenance.row);
    let remark = Diagnostic::new(Severity::Warning, "records.same-id", location, message);
    Some(remark.with_hint(
        "where they are different reports, give each an id of its own: rows of one id are versions of one report",
    ))
}

/// Rows that are named.
const ROWS_SHOWN: usize = 3;

/// Whether two rows say the same, wherever they stand.
fn is_same(one: &CrashRecord, other: &CrashRecord) -> bool {
    *one == CrashRecord { provenance: one.provenance.clone(), ..other.clone() }
}

/// Drafts with the same key, in the order of keys, each group in file order.
fn groups(drafts: &[Draft], key: impl Fn(&Draft) -> Option<&str>) -> Vec<Vec<usize>> {
    let mut by_key: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (i, draft) in drafts.iter().enumerate() {
        if let Some(key) = key(draft) {
            by_key.entry(key).or_default().push(i);
        }
    }
    by_key.into_values().collect()
}

/// Reports that only refer to another one, and the one they name: `(to, from)`.
fn references(drafts: &[Draft], merged: &[bool]) -> Vec<(usize, usize)> {
    let kept = || (0..drafts.len()).filter(|&i| !merged[i]);
    let reports: BTreeMap<&str, usize> = kept().map(|i| (drafts[i].record.id.report_id.as_str(), i)).collect();
    let referring = kept().filter(|&i| drafts[i].record.redaction == Redaction::Open && !tells_its_story(&drafts[i]));
    let named = |i: usize| report_ids(&drafts[i].record.narrative).find_map(|id| reports.get(id).copied());
    let found = referring.filter_map(|i| Some((i, named(i)?)));
    found.filter(|&(to, from)| to != from && tells_its_story(&drafts[from])).collect()
}

/// Whether the narrative can be read and tells what happened, rather than where else to look.
fn tells_its_story(draft: &Draft) -> bool {
    let record = &draft.record;
    record.redaction == Redaction::Open && !only_refers(&record.narrative)
}

/// Whether a narrative only refers to another one.
pub fn only_refers(narrative: &str) -> bool {
    if narrative.len() > LONGEST_REFERENCE_BYTES {
        return false;
    }
    let lower = narrative.to_lowercase();
    REFERENCES.iter().any(|phrase| lower.contains(phrase)) || (lower.starts_with("see ") && lower.contains("report"))
}

/// Report ids in a text: `30490-11294`, also with a version behind it, as in `30490-11294-1`.
fn report_ids(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_ascii_digit() || c == '-')).filter_map(|word| {
        let mut parts = word.splitn(3, '-');
        let (entity, number) = (parts.next()?, parts.next()?);
        let is_id = (3..=6).contains(&entity.len()) && (1..=7).contains(&number.len());
        is_id.then(|| &word[..entity.len() + 1 + number.len()])
    })
}

fn take_narrative(drafts: &mut [Draft], to: usize, from: usize) -> Diagnostic {
    let narrative = drafts[from].record.narrative.clone();
    let source: RecordRef = drafts[from].record.id.clone();
    let target = &mut drafts[to].record;
    target.narrative = narrative;
    target.redaction = Redaction::Open;
    let location = Location::at_row(target.provenance.file.clone(), target.provenance.row);
    let message = format!("report {} gives no narrative of its own; the earlier version {source} lends it", target.id);
    Diagnostic::new(Severity::Note, "records.narrative-lent", location, message)
}

fn refers_to(drafts: &[Draft], to: usize, from: usize) -> Diagnostic {
    let (record, source) = (&drafts[to].record, &drafts[from].record.id);
    let location = Location::at_row(record.provenance.file.clone(), record.provenance.row);
    let message = format!("report {} only refers to report {source}, which stays in its place", record.id);
    Diagnostic::new(Severity::Note, "records.refers-to-report", location, message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_told_from_stories() {
        assert!(only_refers("No update to narrative. Please refer to the operator's first report."));
        assert!(only_refers("See Northlight report 123 for narrative details."));
        assert!(!only_refers("Our shuttle was hit from behind by a van while it waited at the light."));
        let long = format!("Please refer to the map. {}", "The van went on. ".repeat(30));
        assert!(!only_refers(&long));
    }

    #[test]
    fn report_ids_are_found_with_and_without_version() {
        let ids: Vec<&str> = report_ids("see 30490-11294-1 and (502-77), not 1-2, 2021-, or --").collect();
        assert_eq!(ids, ["30490-11294", "502-77"]);
    }
}
