//! Crash records: one version of one report, in SI units, with where it came from.

use crate::geometry::{OrientedBox, Vec2};
use crate::template::{Movement, RoadType, Template};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Metres per second in one mile per hour (exact: 1609.344 m / 3600 s).
pub const MPS_PER_MPH: f64 = 0.447_04;

/// Report id and version, written `30270-7733/2`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
#[schemars(with = "String")]
pub struct RecordRef {
    /// Column `Report ID`.
    pub report_id: String,
    /// Column `Report Version`.
    pub version: u32,
}

impl std::fmt::Display for RecordRef {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.report_id, self.version)
    }
}

impl From<RecordRef> for String {
    fn from(value: RecordRef) -> Self {
        value.to_string()
    }
}

impl TryFrom<String> for RecordRef {
    type Error = String;

    fn try_from(value: String) -> Result<Self, Self::Error> {
        let parsed = value.rsplit_once('/').and_then(|(id, version)| Some((id, version.parse().ok()?)));
        match parsed {
            Some((report_id, version)) if !report_id.is_empty() => {
                Ok(Self { report_id: report_id.to_owned(), version })
            }
            _ => Err(format!("\"{value}\" is not a record reference; expected REPORT-ID/VERSION, as in 30270-7733/2")),
        }
    }
}

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

/// Condition of the road surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Surface {
    /// Dry.
    #[default]
    Dry,
    /// Wet.
    Wet,
    /// Snow, slush or ice.
    SnowIce,
}

impl Surface {
    /// Friction relative to a dry road. Assumed: textbook ratios of locked-wheel friction at town speeds are 0.6 to 0.8
    /// for wet asphalt and 0.2 to 0.4 for packed snow (wong2008).
    pub const fn relative_friction(self) -> f64 {
        match self {
            Self::Dry => 1.0,
            Self::Wet => 0.7,
            Self::SnowIce => 0.3,
        }
    }
}

/// Light at the time of the crash.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Lighting {
    /// `Daylight`.
    #[default]
    Daylight,
    /// `Dawn / Dusk`.
    DawnDusk,
    /// `Dark - Lighted`.
    DarkLighted,
    /// `Dark - Not Lighted`.
    DarkNotLighted,
    /// `Dark - Unknown Lighting`.
    DarkUnknown,
}

/// Weather; a record may name several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Weather {
    /// Clear.
    #[default]
    Clear,
    /// Cloudy or partly cloudy.
    Cloudy,
    /// Rain.
    Rain,
    /// Snow.
    Snow,
    /// Fog, smoke or haze.
    Fog,
    /// Severe wind, hurricane or dust storm.
    SevereWind,
    /// Indoors.
    Indoor,
}

/// Kind of crash partner (column `Crash With`), and of any road user in a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PartnerKind {
    /// `Passenger Car`.
    #[default]
    PassengerCar,
    /// `SUV`.
    Suv,
    /// `Van`.
    Van,
    /// `Pickup Truck`.
    PickupTruck,
    /// `Heavy Truck`.
    HeavyTruck,
    /// `Bus`.
    Bus,
    /// `Motorcycle`.
    Motorcycle,
    /// `Non-Motorist: Cyclist`.
    Cyclist,
    /// `Non-Motorist: Pedestrian`.
    Pedestrian,
    /// `Non-Motorist: Other` (scooters, skateboards).
    OtherNonMotorist,
    /// `First Responder Vehicle`.
    FirstResponder,
    /// `Animal`.
    Animal,
    /// `Other Fixed Object`, `Pole / Tree`.
    FixedObject,
}

impl PartnerKind {
    /// Every kind.
    pub const ALL: [Self; 13] = [
        Self::PassengerCar,
        Self::Suv,
        Self::Van,
        Self::PickupTruck,
        Self::HeavyTruck,
        Self::Bus,
        Self::Motorcycle,
        Self::Cyclist,
        Self::Pedestrian,
        Self::OtherNonMotorist,
        Self::FirstResponder,
        Self::Animal,
        Self::FixedObject,
    ];
}

/// One of the ten contact zones of a vehicle (the `... Contact Area - ...` columns).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ContactZone {
    /// Front.
    Front,
    /// Front left.
    FrontLeft,
    /// Left side.
    Left,
    /// Rear left.
    RearLeft,
    /// Rear.
    Rear,
    /// Rear right.
    RearRight,
    /// Right side.
    Right,
    /// Front right.
    FrontRight,
    /// Top.
    Top,
    /// Bottom.
    Bottom,
}

/// Part of the length, and of the width, that a corner zone takes at each end (`docs/models/contact-zones.md`).
const CORNER_SHARE: f64 = 0.25;

impl ContactZone {
    /// Every zone: the eight around the box anticlockwise from the front, then top and bottom.
    pub const ALL: [Self; 10] = [
        Self::Front,
        Self::FrontLeft,
        Self::Left,
        Self::RearLeft,
        Self::Rear,
        Self::RearRight,
        Self::Right,
        Self::FrontRight,
        Self::Top,
        Self::Bottom,
    ];

    /// The zone of a vehicle's outline that a point on or near its edge belongs to.
    pub fn at(outline: &OrientedBox, point: Vec2) -> Self {
        let local = outline.to_local(point);
        let (x, y) = (local.x.abs() / outline.half_length, local.y.abs() / outline.half_width);
        let corner_from = 1.0 - 2.0 * CORNER_SHARE;
        let at_side = y >= corner_from;
        // Deep inside, the nearer edge.
        let nearer_end = outline.half_length - local.x.abs() < outline.half_width - local.y.abs();
        let at_end = x >= corner_from || (!at_side && nearer_end);
        match (at_end, at_side, local.x >= 0.0, local.y >= 0.0) {
            (true, true, true, true) => Self::FrontLeft,
            (true, true, true, false) => Self::FrontRight,
            (true, true, false, true) => Self::RearLeft,
            (true, true, false, false) => Self::RearRight,
            (true, false, true, _) => Self::Front,
            (true, false, false, _) => Self::Rear,
            (false, _, _, true) => Self::Left,
            (false, _, _, false) => Self::Right,
        }
    }

    /// Front, front left or front right.
    pub fn is_front(self) -> bool {
        matches!(self, Self::Front | Self::FrontLeft | Self::FrontRight)
    }

    /// Rear, rear left or rear right.
    pub fn is_rear(self) -> bool {
        matches!(self, Self::Rear | Self::RearLeft | Self::RearRight)
    }

    /// Steps around the box between two zones, 0 to 4; `None` with top or bottom.
    pub fn steps_apart(self, other: Self) -> Option<u8> {
        let index = |zone: Self| Self::ALL[..8].iter().position(|&z| z == zone);
        let distance = index(self)?.abs_diff(index(other)?);
        Some(distance.min(8 - distance) as u8)
    }

    /// For tables and sentences.
    pub fn label(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::FrontLeft => "front left",
            Self::Left => "left",
            Self::RearLeft => "rear left",
            Self::Rear => "rear",
            Self::RearRight => "rear right",
            Self::Right => "right",
            Self::FrontRight => "front right",
            Self::Top => "top",
            Self::Bottom => "bottom",
        }
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
    /// Which automation was engaged.
    pub engagement: Coded<Engagement>,
    /// Narrative, as it stands in the file (characters that were encoded twice are mended). Untrusted text.
    pub narrative: String,
    /// Whether the narrative can be read.
    pub redaction: Redaction,
    /// Where the record came from.
    pub provenance: Provenance,
}

impl CrashRecord {
    /// The record's template, where road type and both movements are known.
    pub fn template(&self) -> Option<Template> {
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
    /// A partner kind the profile cannot express.
    PartnerNotExpressible,
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
            Self::FilteredOut => "left out by --where",
            Self::MovementNotExpressible => "movement not expressible",
            Self::RoadNotExpressible => "road type not expressible",
            Self::PartnerNotExpressible => "partner kind not expressible",
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn record_references_round_trip() {
        let parsed: RecordRef = serde_json::from_str("\"30270-7733/2\"").unwrap();
        assert_eq!(parsed, RecordRef { report_id: "30270-7733".into(), version: 2 });
        assert_eq!(serde_json::to_string(&parsed).unwrap(), "\"30270-7733/2\"");
        assert!(serde_json::from_str::<RecordRef>("\"30270-7733\"").is_err());
    }

    #[test]
    fn zones_are_neighbours_around_the_box() {
        assert_eq!(ContactZone::Front.steps_apart(ContactZone::FrontRight), Some(1));
        assert_eq!(ContactZone::Front.steps_apart(ContactZone::Rear), Some(4));
        assert_eq!(ContactZone::Left.steps_apart(ContactZone::Top), None);
    }
}
