//! One row: cells in, a record out.

use crate::cells::{self, Cell};
use crate::codes;
use crate::columns::{Column, Columns, SidesColumns, WorkZoneColumn};
use crate::notes::{Notes, Remark};
use crate::text::{decode, mend_twice_encoded, same_code};
use csv::ByteRecord;
use recrash_model::record::{Coded, CrashRecord, Engagement, OfVehicles, Provenance, RecordRef, Redaction};
use recrash_model::surroundings::Surface;
use std::borrow::Cow;

/// NHTSA's mark for a narrative, or a part of one, withheld as confidential business information.
const REDACTED: &str = "[REDACTED, MAY CONTAIN CONFIDENTIAL BUSINESS INFORMATION]";

/// A record, and what only this crate needs to know about it.
#[derive(Debug)]
pub struct Draft {
    pub record: CrashRecord,
    /// The row says that there is nothing to report.
    pub not_a_crash: bool,
    /// The reporting entity is the operator itself, and no manufacturer that passes its report on.
    pub operator_reports: bool,
}

/// The row's report id and version, where they can be read.
pub fn record_ref(row: &ByteRecord, columns: &Columns) -> Option<RecordRef> {
    let report_id = decode(row.get(columns.report_id.at?)?).0.trim().to_owned();
    let version = decode(row.get(columns.report_version.at?)?).0;
    // Spreadsheets and data frames write whole numbers as `1.0`.
    let version = match version.trim().split_once('.') {
        Some((whole, zeros)) if !zeros.is_empty() && zeros.bytes().all(|digit| digit == b'0') => whole.parse(),
        _ => version.trim().parse(),
    };
    let version = version.ok()?;
    let plausible = !report_id.is_empty() && report_id.len() <= 40;
    plausible.then_some(RecordRef { report_id, version })
}

/// How much of a narrative may be read.
pub fn redaction_of(narrative: &str) -> Redaction {
    if narrative.contains(REDACTED) {
        Redaction::Redacted
    } else if narrative.is_empty() {
        Redaction::Empty
    } else {
        Redaction::Open
    }
}

/// Reads a row of the right width; an error says what makes it no record.
pub fn read(row: &ByteRecord, columns: &Columns, file: &str, number: u64, notes: &mut Notes) -> Result<Draft, String> {
    let id = record_ref(row, columns)
        .ok_or("the report id is empty or too long, or the report version is no whole number")?;
    let mut cells = Cells { row, number, notes };

    let entity = cells.owned(columns.entity);
    let operator = cells.text(columns.operator);
    let narrative = cells.narrative(columns.narrative);
    let redaction = redaction_of(&narrative);
    let record = CrashRecord {
        id,
        incident_id: Some(cells.owned(columns.incident_id)).filter(|text| !text.is_empty()),
        vehicle: joined(" ", &[cells.text(columns.model_year), cells.text(columns.make), cells.text(columns.model)]),
        when: cells.read(columns.date, cells::year_month),
        time_of_day_min: cells.read(columns.time, cells::time_of_day_min),
        place: joined(", ", &[cells.text(columns.city), cells.text(columns.state)]),
        road: cells.code(columns.road, codes::ROAD_TYPES),
        work_zone: cells.work_zone(columns.work_zone),
        surface: cells.surface(columns),
        lighting: cells.code(columns.lighting, codes::LIGHTINGS).known(),
        weather: cells.ticks(&columns.weather, "Weather"),
        // A posted limit of 0 is a slip of the pen.
        posted_speed_mps: cells.read(columns.posted_speed, cells::speed_mps).filter(|limit| *limit > 0.0),
        partner: cells.code(columns.crash_with, codes::PARTNERS),
        cp_movement: cells.code(columns.cp_movement, codes::MOVEMENTS),
        sv_movement: cells.code(columns.sv_movement, codes::MOVEMENTS),
        sv_speed_mps: cells
            .read(columns.sv_speed, cells::speed_mps)
            .filter(|_| !cells.is_ticked(columns.sv_speed_unknown)),
        sv_zones: cells.ticks(&columns.sv_zones, "SV Contact Area"),
        cp_zones: cells.ticks(&columns.cp_zones, "CP Contact Area"),
        severity: cells.code(columns.severity, codes::SEVERITIES),
        towed: cells.of_vehicles(columns.towed),
        airbags: cells.of_vehicles(columns.airbags),
        engagement: cells.engagement(columns),
        narrative,
        redaction,
        provenance: Provenance { file: file.to_owned(), edition: columns.edition, row: number },
        reading: None,
        entity,
    };
    let not_a_crash = same_code(&cells.text(columns.report_type), codes::NO_REPORT);
    let operator_reports = same_entity(&record.entity, &operator);
    Ok(Draft { record, not_a_crash, operator_reports })
}

/// Whether two names are the same company: `Zoox, Inc.` operates as `Zoox`.
fn same_entity(entity: &str, operator: &str) -> bool {
    let first_word =
        |name: &str| -> String { name.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default().to_lowercase() };
    !operator.is_empty() && first_word(entity) == first_word(operator)
}

fn joined(separator: &str, parts: &[Cow<'_, str>]) -> String {
    let given: Vec<&str> = parts.iter().map(AsRef::as_ref).filter(|part| !part.is_empty()).collect();
    given.join(separator)
}

struct Cells<'a> {
    row: &'a ByteRecord,
    number: u64,
    notes: &'a mut Notes,
}

impl<'a> Cells<'a> {
    fn bytes(&self, column: Column) -> &'a [u8] {
        column.at.and_then(|at| self.row.get(at)).unwrap_or_default().trim_ascii()
    }

    fn text(&mut self, column: Column) -> Cow<'a, str> {
        let (text, windows_1252) = decode(self.bytes(column));
        if windows_1252 {
            self.notes.add_windows_1252();
        }
        text
    }

    fn owned(&mut self, column: Column) -> String {
        self.text(column).into_owned()
    }

    fn narrative(&mut self, column: Column) -> String {
        let text = self.owned(column);
        match mend_twice_encoded(&text) {
            Some(mended) => {
                self.notes.add_mended();
                mended
            }
            None => text,
        }
    }

    fn code<T: Copy>(&mut self, column: Column, table: &codes::Table<T>) -> Coded<T> {
        let text = self.text(column);
        let coded = codes::look_up(table, &text);
        if let Coded::Unlisted(text) = &coded {
            self.notes.add(Remark::UnlistedCode, column.name, text, self.number);
        }
        coded
    }

    fn read<T>(&mut self, column: Column, reader: fn(&str) -> Cell<T>) -> Option<T> {
        let text = self.text(column);
        match reader(&text) {
            Cell::Value(value) => Some(value),
            Cell::Empty => None,
            Cell::Unreadable => {
                self.notes.add(Remark::Unreadable, column.name, &text, self.number);
                None
            }
        }
    }

    fn is_ticked(&mut self, column: Column) -> bool {
        let bytes = self.bytes(column);
        match cells::ticked(bytes) {
            Cell::Value(()) => true,
            Cell::Empty => false,
            Cell::Unreadable => {
                self.notes.add(Remark::Unreadable, column.name, &decode(bytes).0, self.number);
                false
            }
        }
    }

    fn ticks<T: Copy + PartialEq>(&mut self, columns: &[(usize, T)], group: &'static str) -> Vec<T> {
        let mut all = Vec::new();
        for (position, value) in columns {
            if self.is_ticked(Column { at: Some(*position), name: group }) && !all.contains(value) {
                all.push(*value);
            }
        }
        all
    }

    fn work_zone(&mut self, column: WorkZoneColumn) -> bool {
        match column {
            WorkZoneColumn::Flag(column) => self.is_ticked(column),
            WorkZoneColumn::Description(column) => {
                matches!(self.code(column, codes::ROAD_DESCRIPTIONS), Coded::Known(codes::RoadDescription::WorkZone))
            }
        }
    }

    /// The third edition ticks a wet surface; where it ticks that nothing was unusual instead, the surface was dry.
    fn surface(&mut self, columns: &Columns) -> Option<Surface> {
        if columns.surface.at.is_some() {
            return self.code(columns.surface, codes::SURFACES).known();
        }
        if self.is_ticked(columns.surface_wet) {
            return Some(Surface::Wet);
        }
        self.is_ticked(columns.surface_usual).then_some(Surface::Dry)
    }

    fn of_vehicles(&mut self, columns: SidesColumns) -> OfVehicles {
        match columns {
            SidesColumns::Both(column) => self.read(column, cells::of_vehicles).unwrap_or_default(),
            SidesColumns::Each { sv, cp } => {
                let mut known = |column| self.code(column, codes::YES_OR_NO).known();
                OfVehicles { sv: known(sv), cp: known(cp) }
            }
        }
    }

    fn engagement(&mut self, columns: &Columns) -> Coded<Engagement> {
        let system = self.code(columns.engaged, codes::ENGAGEMENTS);
        match self.code(columns.engagement_status, codes::ENGAGEMENT_STATUSES) {
            Coded::Known(codes::EngagementStatus::NotEngaged) => Coded::Known(Engagement::NotEngaged),
            _ => system,
        }
    }
}
