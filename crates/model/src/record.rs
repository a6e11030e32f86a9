//! Crash records: one version of one report, in SI units, with where it came from.

pub use crate::origin::RecordRef;

use crate::account::{CrashType, Driver, Role, Untold};
use crate::kinds::PartnerKind;
use crate::surroundings::{Lighting, Surface, Weather};
use crate::template::{Movement, RoadType, Template};
use crate::zones::ContactZone;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Metres per second in one mile per hour (exact: 1609.344 m / 3600 s).
pub const MPS_PER_MPH: f64 = 0.447_04;

/// A coded value: one we know, or the text of one we do not (kept and listed, never guessed).
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coded<T> {
    /// A value of the code table.
    Known(T),
    /// `Other, see Narrative`.
    Other,
    /// `Unknown`.
    Unknown,
    /// Empty cell.
    Blank,
    /// A text that is in no code table, as it stood.
    Unlisted(String),
}

impl<T: Copy> Coded<T> {
    /// The known value, if there is one.
    pub fn known(&self) -> Option<T> {
        match self {
            Self::Known(value) => Some(*value),
            _ => None,
        }
    }
}

/// Edition of the SGO file, recognised by its header.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edition {
    /// 122 columns: June 2021 to mid 2023.
    First,
    /// 137 columns: to June 2025.
    Second,
    /// 116 columns: since the third amendment of June 2025.
    Third,
    /// No SGO file: another database, read through a mapping file.
    Mapped,
}

impl Edition {
    /// For tables.
    pub const fn label(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Second => "second",
            Self::Third => "third",
            Self::Mapped => "mapped",
        }
    }
}

/// Where a record came from.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Provenance {
    /// File name, without folders where no other file read has it.
    pub file: String,
    /// Edition of the file.
    pub edition: Edition,
    /// Data row, counted from 1 without the header.
    pub row: u64,
}

/// Month and year of the incident (days are not published).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct YearMonth {
    /// Year, such as 2025.
    pub year: u16,
    /// Month, 1 to 12.
    pub month: u8,
}

impl std::fmt::Display for YearMonth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:04}-{:02}", self.year, self.month)
    }
}

/// Highest injury severity alleged, in the order of harm. The third edition's split by hospitalisation is merged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// No injury reported.
    None,
    /// Minor.
    Minor,
    /// Moderate.
    Moderate,
    /// Serious.
    Serious,
    /// Fatality.
    Fatality,
}

/// What is reported of the vehicles of both sides: whether one was towed, or its air bags deployed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct OfVehicles {
    /// Of the subject vehicle; `None` where that is not known.
    pub sv: Option<bool>,
    /// Of the crash partner; `Some(false)` too where it has no such thing.
    pub cp: Option<bool>,
}

impl OfVehicles {
    /// Of any of the two; not known where one is not known and the other was not.
    pub fn any(self) -> Option<bool> {
        match (self.sv, self.cp) {
            (Some(true), _) | (_, Some(true)) => Some(true),
            (Some(false), Some(false)) => Some(false),
            _ => None,
        }
    }
}

/// Which automation system was engaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Engagement {
    /// Automated driving system (SAE level 3 to 5).
    Ads,
    /// Driver assistance (SAE level 2).
    Adas,
    /// `Verified Not Engaged` (third edition).
    NotEngaged,
}

/// Whether the narrative can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Redaction {
    /// Narrative given (single words may be masked as `[XXX]`).
    Open,
    /// Withheld as confidential business information.
    Redacted,
    /// No narrative at all.
    Empty,
}

/// One version of one crash report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CrashRecord {
    /// Report id and version.
    pub id: RecordRef,
    /// Column `Same Incident ID`: equal for reports of one incident.
    pub incident_id: Option<String>,
    /// Who reported it.
    pub entity: String,
    /// Make and model of the subject vehicle.
    pub vehicle: String,
    /// Month of the incident.
    pub when: Option<YearMonth>,
    /// Local time of day, minutes after midnight. [min]
    pub time_of_day_min: Option<u16>,
    /// City and state.
    pub place: String,
    /// Road type.
    pub road: Coded<RoadType>,
    /// Whether the road description names a work zone.
    pub work_zone: bool,
    /// Surface.
    pub surface: Option<Surface>,
    /// Light.
    pub lighting: Option<Lighting>,
    /// Weather, as ticked.
    pub weather: Vec<Weather>,
    /// Posted speed limit. [m/s]
    pub posted_speed_mps: Option<f64>,
    /// Crash partner.
    pub partner: Coded<PartnerKind>,
    /// Movement of the crash partner.
    pub cp_movement: Coded<Movement>,
    /// Movement of the subject vehicle.
    pub sv_movement: Coded<Movement>,
    /// Speed of the subject vehicle before the crash. [m/s]
    pub sv_speed_mps: Option<f64>,
    /// Contact zones ticked for the subject vehicle.
    pub sv_zones: Vec<ContactZone>,
    /// Contact zones ticked for the crash partner.
    pub cp_zones: Vec<ContactZone>,
    /// Highest injury severity alleged.
    pub severity: Coded<Severity>,
    /// Whose vehicle was towed.
    #[serde(default)]
    pub towed: OfVehicles,
    /// Whose air bags deployed.
    #[serde(default)]
    pub airbags: OfVehicles,
    /// Which automation was engaged.
    pub engagement: Coded<Engagement>,
    /// Narrative, as it stands in the file (characters that were encoded twice are mended). Untrusted text.
    pub narrative: String,
    /// Whether the narrative can be read.
    pub redaction: Redaction,
    /// Where the record came from.
    pub provenance: Provenance,
    /// What the account of its incident says, where a profile goes by accounts and this record's narrative speaks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reading: Option<Reading>,
}

/// What an account says of its crash, for choosing and for tables.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// The incident.
    pub incident: String,
    /// Reports of the incident.
    pub reports: usize,
    /// Crash type.
    pub crash_type: CrashType,
    /// Whose move brought the conflict about.
    pub role: Option<Role>,
    /// Who drove the subject vehicle at the contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub driver: Option<Driver>,
    /// Road and movements as they are told; where no movement is, as the state at the contact has it.
    pub template: Template,
}

impl CrashRecord {
    /// The record's template: as its account has it where there is one, else as the columns, where road type and both
    /// movements are known.
    pub fn template(&self) -> Option<Template> {
        if let Some(reading) = &self.reading {
            return Some(reading.template);
        }
        Some(Template {
            road: self.road.known()?,
            sv: self.sv_movement.known()?,
            cp: self.cp_movement.known()?,
            work_zone: self.work_zone,
        })
    }
}

/// Why a row or record went no further.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RejectReason {
    /// The row has too many or too few fields, or its quoting is broken.
    Malformed,
    /// The row is no crash report (`No New or Updated Incident Reports`).
    NotACrash,
    /// The narrative is redacted.
    RedactedNarrative,
    /// The narrative is empty.
    EmptyNarrative,
    /// Another version or another entity's report of the same incident is kept instead.
    Merged,
    /// The user's filter (`--where`) is not true of it.
    FilteredOut,
    /// A movement the profile cannot express, or none known.
    MovementNotExpressible,
    /// A road type the profile cannot express, or none known.
    RoadNotExpressible,
    /// Its crash cannot be told.
    Untold(Untold),
}

impl RejectReason {
    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Malformed => "malformed row",
            Self::NotACrash => "not a crash report",
            Self::RedactedNarrative => "narrative redacted",
            Self::EmptyNarrative => "narrative empty",
            Self::Merged => "merged into another report of the incident",
            Self::FilteredOut => "left out by the filter",
            Self::MovementNotExpressible => "movement not expressible",
            Self::RoadNotExpressible => "road type not expressible",
            Self::Untold(why) => why.label(),
        }
    }
}

/// A row that went no further, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reject {
    /// File name without folders.
    pub file: String,
    /// Data row, counted from 1 without the header.
    pub row: u64,
    /// The record, where the row could be read that far.
    pub record: Option<RecordRef>,
    /// Why.
    pub reason: RejectReason,
}

/// One step of the funnel from rows to usable records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FunnelStep {
    /// What the step does.
    pub name: String,
    /// How many remain after it.
    pub remaining: usize,
    /// How many it took away, by reason.
    pub lost: Vec<(RejectReason, usize)>,
}

/// What ingest gives: rows in = usable + rejected.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordSet {
    /// Files read, with the edition recognised and the count of data rows.
    pub files: Vec<SourceFile>,
    /// Every record that could be read, usable or not, in file order.
    pub records: Vec<CrashRecord>,
    /// Positions in `records` of those the profile can use.
    pub usable: Vec<usize>,
    /// Rows that went no further.
    pub rejects: Vec<Reject>,
    /// From rows to usable records.
    pub funnel: Vec<FunnelStep>,
    /// Usable records whose own crash is not told, and why: another record of the incident tells it, or none can. By position
    /// in `records`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub untold: BTreeMap<usize, String>,
}

/// A file that was read. A file that holds several editions, one after the other, is listed once for each.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceFile {
    /// Name without folders.
    pub name: String,
    /// Edition recognised.
    pub edition: Edition,
    /// Data rows.
    pub rows: usize,
    /// SHA-256 of the content, in hexadecimal.
    pub sha256: String,
}
