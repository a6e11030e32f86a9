//! Rows of crash files into incidents: versions, copies of other companies, entities and editions of one crash together.

use crate::frame::story;
use crate::world::Own;
use recrash_model::hash::Fnv;
use recrash_model::incident::{Incident, IncidentReport, Telling};
use recrash_model::record::{CrashRecord, Redaction};
use std::collections::{BTreeMap, BTreeSet};

/// Narratives with one of [`REFERENCES`] in them that are longer than this tell a story besides. [byte]
const LONGEST_REFERENCE_BYTES: usize = 420;

/// Turns of phrase of narratives that only refer to another report.
const REFERENCES: [&str; 10] = [
    "refer to",
    "see report",
    "for narrative details",
    "no update to narrative",
    "no additional information",
    "no new information",
    "no further information",
    "no change to narrative",
    "not received notice of any material new",
    "delete this report",
];

/// What companies write about another company's report, at any length.
const BOILERPLATE: [&str; 3] =
    ["duplicate of the redacted public copy", "is submitting a duplicate of", "incorporates cruise's responses"];

/// What companies write where they pass on the narrative of another company's report.
const PASSED_ON: [&str; 4] =
    ["incorporates the report by reference", "is a duplicate of", "duplicate of report", "excerpt from"];

/// Crashes of one incident id that lie further apart than this are two. [min]
const SAME_CRASH_MIN: u16 = 5;

/// A later version counts where it tells at least this share of what the fullest one tells.
const FULL_ENOUGH: f64 = 0.6;

/// Groups records into incidents, in the order of their ids. Every record is in exactly one.
pub fn incidents(records: &[CrashRecord]) -> Vec<Incident> {
    let looks: Vec<Look> = records.iter().map(Look::at).collect();
    let mut all: Vec<Incident> = groups(&looks).into_iter().map(|(id, group)| incident(&looks, id, group)).collect();
    all.sort_by(|one, other| one.id.cmp(&other.id));
    all
}

/// The id of the incident that each record belongs to, as [`incidents`] groups them: what joins a table of records with accounts.
pub fn incident_ids<'a>(records: impl Iterator<Item = &'a CrashRecord>) -> Vec<String> {
    let looks: Vec<Look> = records.map(Look::at).collect();
    let mut ids = vec![String::new(); looks.len()];
    for (id, group) in groups(&looks) {
        for number in group {
            ids[number].clone_from(&id);
        }
    }
    ids
}

/// A record, and what decides to which incident it belongs.
struct Look<'a> {
    record: &'a CrashRecord,
    telling: Telling,
    /// Report ids that its narrative names.
    names: Vec<String>,
}

impl<'a> Look<'a> {
    fn at(record: &'a CrashRecord) -> Self {
        let telling = match record.redaction {
            Redaction::Empty => Telling::Unreadable,
            // A narrative that is withheld in parts may still tell its story.
            Redaction::Redacted if readable(&record.narrative) < 120 => Telling::Unreadable,
            _ if only_refers(&record.narrative) => Telling::Refers,
            _ => Telling::Tells,
        };
        let names = report_ids(&record.narrative).filter(|id| *id != record.id.report_id).map(str::to_owned).collect();
        Self { record, telling, names }
    }

    fn report(&self) -> IncidentReport {
        let mut hash = Fnv::default();
        hash.write_text(&self.record.narrative);
        IncidentReport {
            text_hash: hash.hexadecimal(),
            telling: self.telling,
            names: self.names.clone(),
            changed: Vec::new(),
            record: self.record.clone(),
        }
    }
}

/// Ids of incidents, each with the positions of its records.
fn groups(reports: &[Look]) -> Vec<(String, Vec<usize>)> {
    let mut sets = Sets::new(reports.len());
    let mut by_report: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    let mut by_incident: BTreeMap<&str, usize> = BTreeMap::new();
    for (number, report) in reports.iter().enumerate() {
        let record = report.record;
        let of_id = by_report.entry(record.id.report_id.as_str()).or_default();
        match of_id.iter().find(|&&first| !is_of_another(reports[first].record, record)) {
            Some(&first) => sets.join(first, number),
            None => of_id.push(number),
        }
        if let Some(id) = record.incident_id.as_deref() {
            match by_incident.get(id) {
                Some(&first) => sets.join(first, number),
                None => {
                    by_incident.insert(id, number);
                }
            }
        }
    }
    // A report without a story of its own belongs to the one that it names.
    let told: Vec<usize> = (0..reports.len())
        .filter(|&number| reports[number].telling == Telling::Tells)
        .map(|number| sets.root(number))
        .collect();
    for (number, report) in reports.iter().enumerate() {
        let passed_on =
            report.telling == Telling::Tells && !report.names.is_empty() && passes_on(&report.record.narrative);
        let refers = report.telling == Telling::Refers && !told.contains(&sets.root(number));
        if !(passed_on || refers) {
            continue;
        }
        if let Some(&named) = report.names.iter().find_map(|name| by_report.get(name.as_str())?.first()) {
            sets.join(number, named);
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for number in 0..reports.len() {
        groups.entry(sets.root(number)).or_default().push(number);
    }
    let mut all: Vec<(String, Vec<usize>)> = groups.into_values().flat_map(|group| crashes(reports, group)).collect();
    all.sort_by(|one, other| one.0.cmp(&other.0));
    tell_apart(&mut all);
    all
}

/// Whether two rows of one report id are no versions of one report: another company reports another day. Whoever made the file gave
/// several reports one id.
fn is_of_another(one: &CrashRecord, other: &CrashRecord) -> bool {
    one.entity != other.entity && one.when != other.when
}

/// Gives incidents that share an id ids of their own.
fn tell_apart(all: &mut [(String, Vec<usize>)]) {
    let mut taken: BTreeSet<String> = all.iter().map(|(id, _)| id.clone()).collect();
    let mut before: Option<String> = None;
    for (id, _) in all {
        if before.as_ref() != Some(&*id) {
            before = Some(id.clone());
            continue;
        }
        let free = (2..).map(|number| format!("{id}#{number}")).find(|id| !taken.contains(id));
        if let Some(free) = free {
            taken.insert(free.clone());
            *id = free;
        }
    }
}

/// Bytes outside of brackets.
fn readable(text: &str) -> usize {
    let mut depth = 0_usize;
    let mut count = 0;
    for c in text.chars() {
        match c {
            '[' => depth += 1,
            ']' => depth = depth.saturating_sub(1),
            _ if depth == 0 => count += c.len_utf8(),
            _ => {}
        }
    }
    count
}

/// Whether a narrative tells no crash, but where else it is told.
pub fn only_refers(narrative: &str) -> bool {
    let lower = narrative.to_lowercase();
    if BOILERPLATE.iter().any(|phrase| lower.contains(phrase)) {
        return true;
    }
    let short = narrative.len() <= LONGEST_REFERENCE_BYTES;
    let refers = REFERENCES.iter().any(|phrase| lower.contains(phrase))
        || (lower.starts_with("see ") && lower.contains("report"));
    short && refers
}

fn passes_on(narrative: &str) -> bool {
    let lower = narrative.to_lowercase();
    PASSED_ON.iter().any(|phrase| lower.contains(phrase))
}

/// Report ids in a text: `30490-11294`, also with a version behind it.
fn report_ids(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_ascii_digit() || c == '-')).filter_map(|word| {
        let word = word.trim_matches('-');
        let mut parts = word.splitn(3, '-');
        let (entity, number) = (parts.next()?, parts.next()?);
        let is_id = (3..=6).contains(&entity.len()) && (1..=7).contains(&number.len());
        is_id.then(|| &word[..entity.len() + 1 + number.len()])
    })
}

/// The crashes of one group of reports: one, or several where reports of one company under one id lie apart in time.
fn crashes(reports: &[Look], group: Vec<usize>) -> Vec<(String, Vec<usize>)> {
    let mut clusters: Vec<Vec<usize>> = Vec::new();
    for &number in &group {
        let near = clusters
            .iter()
            .position(|cluster| cluster.iter().any(|&other| one_crash(&reports[other], &reports[number])));
        match near {
            Some(cluster) => clusters[cluster].push(number),
            None => clusters.push(vec![number]),
        }
    }
    let leader = reports[group[0]].record;
    let id = leader.incident_id.clone().unwrap_or_else(|| leader.id.report_id.clone());
    let several = clusters.len() > 1;
    clusters
        .into_iter()
        .enumerate()
        .map(|(place, cluster)| {
            let id = if several && place > 0 { format!("{id}#{}", place + 1) } else { id.clone() };
            (id, cluster)
        })
        .collect()
}

fn one_crash(one: &Look, other: &Look) -> bool {
    let (a, b) = (one.record, other.record);
    if a.id.report_id == b.id.report_id || a.entity != b.entity {
        return true;
    }
    if one.names.contains(&b.id.report_id) || other.names.contains(&a.id.report_id) {
        return true;
    }
    match (a.time_of_day_min, b.time_of_day_min) {
        (Some(a), Some(b)) => a.abs_diff(b) <= SAME_CRASH_MIN,
        _ => true,
    }
}

fn incident(reports: &[Look], id: String, mut group: Vec<usize>) -> Incident {
    group.sort_by(|&one, &other| {
        let key = |number: usize| (&reports[number].record.id, number);
        key(one).cmp(&key(other))
    });
    let mut all: Vec<IncidentReport> = group.iter().map(|&number| reports[number].report()).collect();
    for at in 1..all.len() {
        let (before, after) = all.split_at_mut(at);
        let (before, after) = (&before[at - 1], &mut after[0]);
        if before.record.id.report_id == after.record.id.report_id {
            after.changed = changes(before, after);
        }
    }
    let speaker = speaker(&all);
    Incident { id, reports: all, speaker }
}

/// The report that speaks: of those that tell nearly as much as the fullest, the latest; the first company's own before
/// others.
fn speaker(reports: &[IncidentReport]) -> Option<usize> {
    let tells: Vec<usize> = (0..reports.len()).filter(|&at| reports[at].telling == Telling::Tells).collect();
    if let [only] = tells.as_slice() {
        return Some(*only);
    }
    let told: Vec<usize> = tells.iter().map(|&at| events(&reports[at].record.narrative)).collect();
    let fullest = *told.iter().max()? as f64;
    let full = tells.iter().zip(&told).filter(|(_, told)| **told as f64 >= FULL_ENOUGH * fullest).map(|(at, _)| *at);
    full.max_by_key(|&at| {
        let record = &reports[at].record;
        let own = !record.narrative.to_lowercase().contains("duplicate");
        (own, record.provenance.edition, record.id.version, std::cmp::Reverse(at))
    })
}

/// How much a narrative tells: its events.
fn events(narrative: &str) -> usize {
    story(narrative, Own::default()).frames.iter().filter(|frame| frame.act().is_some() || frame.is_contact()).count()
}

/// What differs between two versions, or between two editions of the file.
fn changes(before: &IncidentReport, after: &IncidentReport) -> Vec<String> {
    let (a, b) = (&before.record, &after.record);
    let pairs = [
        ("Narrative", before.text_hash != after.text_hash),
        ("Roadway Type", a.road != b.road),
        ("Crash With", a.partner != b.partner),
        ("SV Pre-Crash Movement", a.sv_movement != b.sv_movement),
        ("CP Pre-Crash Movement", a.cp_movement != b.cp_movement),
        ("SV Precrash Speed (MPH)", a.sv_speed_mps != b.sv_speed_mps),
        ("SV Contact Area", a.sv_zones != b.sv_zones),
        ("CP Contact Area", a.cp_zones != b.cp_zones),
        ("Highest Injury Severity Alleged", a.severity != b.severity),
        ("Automation System Engaged?", a.engagement != b.engagement),
        ("Incident Time (24:00)", a.time_of_day_min != b.time_of_day_min),
    ];
    pairs.into_iter().filter(|(_, differs)| *differs).map(|(name, _)| name.to_owned()).collect()
}

/// Sets of numbers that are joined.
struct Sets(Vec<usize>);

impl Sets {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&mut self, mut number: usize) -> usize {
        while self.0[number] != number {
            self.0[number] = self.0[self.0[number]];
            number = self.0[number];
        }
        number
    }

    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        // The smaller number leads, so that the order of joining does not matter.
        self.0[one.max(other)] = one.min(other);
    }
}
