//! Crash files of another database, read by the rules of a mapping.

use super::{Join, Mapping, Piece, Source, Target, Unit};
use crate::cells::{self, Cell};
use crate::error::IngestError;
use crate::fields::{UNKNOWN, code_named};
use crate::file::{FileContent, RawTable, raw_table};
use crate::notes::{Notes, Remark};
use crate::row::{Draft, redaction_of};
use crate::text::{decode, excerpt, header_key};
use crate::{MAX_FILE_BYTES, SourceBytes};
use csv::ByteRecord;
use recrash_model::record::{
    Coded, CrashRecord, Edition, MPS_PER_MPH, OfVehicles, Provenance, RecordRef, Reject, RejectReason, SourceFile,
    YearMonth,
};
use recrash_model::{Diagnostic, Location, Severity};
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::io::{Read, Seek};

/// Above this a speed is a code or a slip of the pen. [m/s; 150 mi/h as for SGO files, assumed]
const GREATEST_SPEED_MPS: f64 = 150.0 * MPS_PER_MPH;

/// Most malformed rows that get a diagnostic of their own.
const MOST_MALFORMED_TOLD: usize = 100;

/// A file, read whole: joined tables are looked into in any order.
struct MappedFile<'a> {
    name: &'a str,
    bytes: Vec<u8>,
    sha256: &'a str,
}

impl<'a> MappedFile<'a> {
    fn read(mut source: SourceBytes<'a>, sha256: &'a str) -> Result<Self, IngestError> {
        let (name, mut bytes) = (source.name, Vec::new());
        let limit = MAX_FILE_BYTES as u64 + 1;
        let read = source.bytes.rewind().and_then(|()| source.bytes.take(limit).read_to_end(&mut bytes));
        read.map_err(|error| IngestError::unreadable(name, &error))?;
        if bytes.len() > MAX_FILE_BYTES {
            let (bytes, limit) = (bytes.len() as u64, MAX_FILE_BYTES);
            return Err(IngestError::TooLarge { file: name.to_owned(), bytes, limit });
        }
        Ok(Self { name, bytes, sha256 })
    }
}

/// A table of a file: where each column stands, and the rows.
struct Table {
    name: String,
    keys: Vec<String>,
    names: Vec<String>,
    raw: RawTable,
}

/// A joined table by its key.
struct Joined<'a> {
    table: &'a Table,
    rows: BTreeMap<String, &'a ByteRecord>,
    repeated: usize,
}

/// Reads the files of another database. One content per main file, in the order given.
pub fn read_mapped(
    sources: Vec<SourceBytes<'_>>,
    hashes: &[String],
    mapping: &Mapping,
) -> Result<Vec<FileContent>, IngestError> {
    let files: Vec<MappedFile<'_>> = sources
        .into_iter()
        .zip(hashes)
        .map(|(source, hash)| MappedFile::read(source, hash))
        .collect::<Result<_, _>>()?;
    let files = files.as_slice();
    let tables = joined_tables(mapping, files)?;
    let joined: Vec<Joined<'_>> = mapping
        .joins
        .iter()
        .zip(&tables)
        .map(|(join, table)| join_by_key(mapping, join, table))
        .collect::<Result<_, _>>()?;

    let mut contents = Vec::new();
    for source in files {
        let wanted = mapping.main.as_deref().is_none_or(|name| is_named(source, name));
        if wanted && !mapping.joins.iter().any(|join| is_named(source, &join.file)) {
            contents.push(read_main(source, mapping, &joined)?);
        }
    }
    match (contents.first_mut(), &mapping.main) {
        (Some(first), _) => tell_joined(first, mapping, &joined, files),
        (None, main) => {
            return Err(no_file(mapping, 1, "file".into(), main.as_deref().unwrap_or("a main table"), files));
        }
    }
    Ok(contents)
}

/// Whether a file is called so. A name has folders in it where they are needed to tell files apart.
fn is_named(file: &MappedFile<'_>, name: &str) -> bool {
    file.name.rsplit(['/', '\\']).next().is_some_and(|last| last.eq_ignore_ascii_case(name))
}

/// The table of each join.
fn joined_tables(mapping: &Mapping, files: &[MappedFile<'_>]) -> Result<Vec<Table>, IngestError> {
    let table = |join: &Join| {
        let found = files.iter().find(|file| is_named(file, &join.file));
        let missing = || no_file(mapping, join.line, format!("join.{}.file", join.prefix), &join.file, files);
        read_table(found.ok_or_else(missing)?)
    };
    mapping.joins.iter().map(table).collect()
}

/// The rows of a joined table by its key, the first of those that have the same.
fn join_by_key<'a>(mapping: &Mapping, join: &Join, table: &'a Table) -> Result<Joined<'a>, IngestError> {
    let column = |name: &str, key: &str| {
        let key = format!("join.{}.{key}", join.prefix);
        table.column(name).ok_or_else(|| no_column(mapping, join.line, key, name, table))
    };
    let on = column(&join.on, "on")?;
    let only: Vec<(usize, &str)> = join
        .only
        .iter()
        .map(|(name, value)| Ok((column(name, &format!("only.{name}"))?, value.trim())))
        .collect::<Result<_, IngestError>>()?;
    let mut rows = BTreeMap::new();
    let mut repeated = 0;
    for (_, row) in &table.raw.rows {
        if only.iter().all(|(position, value)| text(row, *position) == *value) {
            match rows.entry(text(row, on)) {
                std::collections::btree_map::Entry::Vacant(entry) => drop(entry.insert(row)),
                std::collections::btree_map::Entry::Occupied(_) => repeated += 1,
            }
        }
    }
    Ok(Joined { table, rows, repeated })
}

/// The joined files stand among the sources, with no rows of their own: a row of theirs is a part of a report.
fn tell_joined(content: &mut FileContent, mapping: &Mapping, joined: &[Joined<'_>], files: &[MappedFile<'_>]) {
    for (join, joined) in mapping.joins.iter().zip(joined) {
        let name = &joined.table.name;
        let sha256 =
            files.iter().find(|file| file.name == *name).map(|file| file.sha256.to_owned()).unwrap_or_default();
        if !content.sources.iter().any(|part| part.name == *name) {
            content.sources.push(SourceFile { name: name.clone(), edition: Edition::Mapped, rows: 0, sha256 });
        }
        let location = Location { file: Some(name.clone()), ..Location::default() };
        if !joined.table.raw.malformed.is_empty() {
            let message = format!("{} rows are malformed and were not joined", joined.table.raw.malformed.len());
            let code = "records.malformed-row";
            content.diagnostics.push(Diagnostic::new(Severity::Warning, code, location.clone(), message));
        }
        if joined.repeated > 0 {
            let message = format!(
                "{} rows have a {} that an earlier row has; the first was joined as {}",
                joined.repeated, join.on, join.prefix
            );
            let diagnostic = Diagnostic::new(Severity::Note, "records.joined-twice", location, message);
            content.diagnostics.push(diagnostic.with_hint("narrow the join with only = { ... }"));
        }
    }
}

fn no_file(mapping: &Mapping, line: usize, key: String, name: &str, files: &[MappedFile<'_>]) -> IngestError {
    let given: Vec<&str> = files.iter().map(|file| file.name).collect();
    let message = format!("\"{name}\" is not among the files given ({}); name it among the records", given.join(", "));
    IngestError::Mapping(mapping.error(line, key, message))
}

fn no_column(mapping: &Mapping, line: usize, key: String, column: &str, table: &Table) -> IngestError {
    let names: Vec<String> = table.names.iter().take(60).map(|name| excerpt(name)).collect();
    let message = format!("{} has no column \"{column}\"; it has: {}", table.name, names.join(", "));
    IngestError::Mapping(mapping.error(line, key, message))
}

fn read_table(source: &MappedFile<'_>) -> Result<Table, IngestError> {
    let raw = raw_table(source.name, &source.bytes)?;
    let names: Vec<String> = raw.header.iter().map(|name| decode(name).0.trim().to_owned()).collect();
    let keys = names.iter().map(|name| header_key(name)).collect();
    Ok(Table { name: source.name.to_owned(), keys, names, raw })
}

impl Table {
    fn column(&self, name: &str) -> Option<usize> {
        let key = header_key(name);
        self.keys.iter().position(|other| *other == key)
    }
}

fn text(row: &ByteRecord, position: usize) -> String {
    decode(row.get(position).unwrap_or_default()).0.trim().to_owned()
}

fn read_main(source: &MappedFile<'_>, mapping: &Mapping, joined: &[Joined<'_>]) -> Result<FileContent, IngestError> {
    let table = read_table(source)?;
    let mut keys = Vec::new();
    for join in &mapping.joins {
        let key = format!("join.{}.on", join.prefix);
        keys.push(table.column(&join.on).ok_or_else(|| no_column(mapping, join.line, key, &join.on, &table))?);
    }
    let mut positions = BTreeMap::new();
    for (target, rule) in &mapping.rules {
        let Source::Column { join, column } = &rule.source else { continue };
        let of = join.map_or(&table, |join| joined[join].table);
        let key = || format!("fields.{}.column", target.name());
        let position = of.column(column).ok_or_else(|| no_column(mapping, rule.line, key(), column, of))?;
        positions.insert(*target, position);
    }

    let mut content =
        FileContent { sources: Vec::new(), drafts: Vec::new(), rejects: Vec::new(), diagnostics: Vec::new() };
    let mut notes = Notes::default();
    let mut malformed: Vec<(u64, String)> = table.raw.malformed.clone();
    for (number, row) in &table.raw.rows {
        let others = joined.iter().zip(&keys).map(|(joined, key)| joined.rows.get(&text(row, *key)).copied()).collect();
        let mut cells = MappedRow { mapping, positions: &positions, row, others, number: *number, notes: &mut notes };
        match cells.draft(source.name) {
            Some(draft) => content.drafts.push(draft),
            None => malformed.push((*number, "the report id is empty or too long".to_owned())),
        }
    }
    malformed.sort();
    for (told, (row, problem)) in malformed.into_iter().enumerate() {
        let (file, reason) = (source.name.to_owned(), RejectReason::Malformed);
        content.rejects.push(Reject { file, row, record: None, reason });
        if told < MOST_MALFORMED_TOLD {
            let location = Location::at_row(source.name, row);
            let code = "records.malformed-row";
            content.diagnostics.push(Diagnostic::new(Severity::Warning, code, location, problem));
        }
    }
    let rows = content.drafts.len() + content.rejects.len();
    if rows == 0 {
        return Err(IngestError::HeaderOnly { file: source.name.to_owned(), edition: "mapped" });
    }
    let sha256 = source.sha256.to_owned();
    content.sources.push(SourceFile { name: source.name.to_owned(), edition: Edition::Mapped, rows, sha256 });
    content.diagnostics.extend(notes.diagnostics(source.name));
    Ok(content)
}

struct MappedRow<'a> {
    mapping: &'a Mapping,
    positions: &'a BTreeMap<Target, usize>,
    row: &'a ByteRecord,
    others: Vec<Option<&'a ByteRecord>>,
    number: u64,
    notes: &'a mut Notes,
}

impl MappedRow<'_> {
    fn draft(&mut self, file: &str) -> Option<Draft> {
        let report_id = self.value(Target::Report);
        if report_id.is_empty() || report_id.len() > 40 {
            return None;
        }
        let version = self.whole(Target::Version).unwrap_or(1);
        let narrative = self.value(Target::Narrative);
        let redaction = redaction_of(&narrative);
        let hour: Option<u16> = self.whole(Target::Hour).filter(|hour| *hour <= 24);
        let minute: u16 = self.whole(Target::Minute).filter(|minute| *minute < 60).unwrap_or(0);
        let record = CrashRecord {
            id: RecordRef { report_id, version },
            incident_id: Some(self.value(Target::Incident)).filter(|text| !text.is_empty()),
            entity: self.value(Target::Entity),
            vehicle: self.value(Target::Vehicle),
            when: self.when(),
            time_of_day_min: hour.map(|hour| hour % 24 * 60 + minute),
            place: self.value(Target::Place),
            road: self.code(Target::Road),
            work_zone: self.value(Target::WorkZone) == "yes",
            surface: self.code(Target::Surface).known(),
            lighting: self.code(Target::Lighting).known(),
            weather: self.code(Target::Weather).known().into_iter().collect(),
            posted_speed_mps: self.speed(Target::PostedSpeed).filter(|limit| *limit > 0.0),
            partner: self.code(Target::Partner),
            cp_movement: self.code(Target::CpMovement),
            sv_movement: self.code(Target::SvMovement),
            sv_speed_mps: self.speed(Target::SvSpeed),
            sv_zones: self.code(Target::SvZones).known().into_iter().collect(),
            cp_zones: self.code(Target::CpZones).known().into_iter().collect(),
            severity: self.code(Target::Severity),
            towed: OfVehicles::default(),
            airbags: OfVehicles::default(),
            engagement: self.code(Target::Engagement),
            narrative,
            redaction,
            provenance: Provenance { file: file.to_owned(), edition: Edition::Mapped, row: self.number },
            reading: None,
        };
        Some(Draft { record, not_a_crash: false, operator_reports: true })
    }

    /// The text of a field after `values` and `otherwise`; empty where it is not known.
    fn value(&self, target: Target) -> String {
        let mapped = self.mapped(target);
        if mapped == UNKNOWN { String::new() } else { mapped }
    }

    fn mapped(&self, target: Target) -> String {
        let Some(rule) = self.mapping.rules.get(&target) else { return String::new() };
        let cell = match &rule.source {
            Source::Column { join, .. } => {
                let row = join.map_or(Some(self.row), |join| self.others.get(join).copied().flatten());
                row.zip(self.positions.get(&target)).map(|(row, position)| text(row, *position)).unwrap_or_default()
            }
            Source::Text(pieces) => pieces
                .iter()
                .map(|piece| match piece {
                    Piece::Words(words) => words.clone(),
                    Piece::Field(field) => {
                        let value = self.mapped(*field).replace('_', " ");
                        if value.is_empty() { UNKNOWN.to_owned() } else { value }
                    }
                })
                .collect(),
        };
        match (rule.values.get(&cell), &rule.otherwise) {
            (Some(value), _) => value.clone(),
            (None, Some(otherwise)) => otherwise.clone(),
            (None, None) => cell,
        }
    }

    fn code<T: DeserializeOwned>(&mut self, target: Target) -> Coded<T> {
        let name = self.mapped(target);
        match name.as_str() {
            "" => return Coded::Blank,
            "other" => return Coded::Other,
            UNKNOWN => return Coded::Unknown,
            _ => {}
        }
        match code_named(&name) {
            Some(value) => Coded::Known(value),
            None => {
                self.notes.add(Remark::UnlistedCode, target.name(), &name, self.number);
                Coded::Unlisted(name)
            }
        }
    }

    fn whole<T: std::str::FromStr>(&mut self, target: Target) -> Option<T> {
        let text = self.value(target);
        let number = text.parse().ok();
        if number.is_none() && !text.is_empty() {
            self.notes.add(Remark::Unreadable, target.name(), &text, self.number);
        }
        number
    }

    fn when(&mut self) -> Option<YearMonth> {
        if self.mapping.rules.contains_key(&Target::Date) {
            let text = self.value(Target::Date);
            // `2024-06-13` is a month and a day that is not kept.
            let month = if text.len() >= 10 && text.as_bytes()[4] == b'-' { text.get(..7) } else { None };
            return match cells::year_month(month.unwrap_or(&text)) {
                Cell::Value(when) => Some(when),
                Cell::Empty => None,
                Cell::Unreadable => {
                    self.notes.add(Remark::Unreadable, "date", &text, self.number);
                    None
                }
            };
        }
        let (year, month): (Option<u16>, Option<u8>) = (self.whole(Target::Year), self.whole(Target::Month));
        let (year, month) = (year?, month?);
        ((1900..2200).contains(&year) && (1..=12).contains(&month)).then_some(YearMonth { year, month })
    }

    fn speed(&mut self, target: Target) -> Option<f64> {
        let text = self.value(target);
        if text.is_empty() {
            return None;
        }
        let factor = match self.mapping.rules.get(&target)?.unit? {
            Unit::MilesPerHour => MPS_PER_MPH,
            Unit::KilometresPerHour => 1.0 / 3.6,
            Unit::MetresPerSecond => 1.0,
        };
        let plain = text.bytes().all(|b| b.is_ascii_digit() || b == b'.');
        let speed = text.parse::<f64>().ok().filter(|_| plain).map(|speed| speed * factor);
        let speed = speed.filter(|speed| (0.0..=GREATEST_SPEED_MPS).contains(speed));
        if speed.is_none() {
            self.notes.add(Remark::Unreadable, target.name(), &text, self.number);
        }
        speed
    }
}
