//! Mapping files: any other crash database as crash records. TOML says which column holds which field and which value of
//! the column means which value of ours. `docs/mapping.md` is the manual.

mod read;
mod rules;

pub(crate) use read::read_mapped;

use crate::error::MappingError;
use crate::fields::Field;
use serde::Deserialize;
use serde::de::IntoDeserializer;
use std::collections::BTreeMap;

/// The mapping files' format tag.
pub const MAPPING_FORMAT: &str = "recrash.mapping/1";

/// Longest mapping file that is read. [bytes]
pub const MAX_MAPPING_BYTES: usize = 1 << 20;

/// A mapping that was read and checked as far as it can be without the crash files.
#[derive(Debug, Clone, PartialEq)]
pub struct Mapping {
    /// Name of the mapping file, for messages.
    file: String,
    /// Name of the database.
    name: String,
    /// File name of the main table, in which a row is a crash; `None` takes every file given.
    main: Option<String>,
    joins: Vec<Join>,
    rules: BTreeMap<Target, Rule>,
}

/// Another table, of whose rows one belongs to each row of the main table.
#[derive(Debug, Clone, PartialEq)]
struct Join {
    /// Prefix of its columns in the rules.
    prefix: String,
    /// File name.
    file: String,
    /// Column that both tables have.
    on: String,
    /// Only rows with these values count.
    only: Vec<(String, String)>,
    /// Line of the mapping file. [from 1]
    line: usize,
}

/// Where a field comes from.
#[derive(Debug, Clone, PartialEq)]
struct Rule {
    source: Source,
    values: BTreeMap<String, String>,
    otherwise: Option<String>,
    unit: Option<Unit>,
    line: usize,
}

#[derive(Debug, Clone, PartialEq)]
enum Source {
    /// A column of the main table (`None`) or of a joined one (its position).
    Column { join: Option<usize>, column: String },
    /// Text with other fields in it.
    Text(Vec<Piece>),
}

#[derive(Debug, Clone, PartialEq)]
enum Piece {
    Words(String),
    Field(Target),
}

/// Unit of a speed column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
enum Unit {
    #[serde(rename = "mph")]
    MilesPerHour,
    #[serde(rename = "km/h")]
    KilometresPerHour,
    #[serde(rename = "m/s")]
    MetresPerSecond,
}

/// What a mapping can fill.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Target {
    Report,
    Version,
    Incident,
    Entity,
    Vehicle,
    Place,
    Narrative,
    Date,
    Year,
    Month,
    Hour,
    Minute,
    PostedSpeed,
    SvSpeed,
    Road,
    SvMovement,
    CpMovement,
    Partner,
    Severity,
    Engagement,
    Surface,
    Lighting,
    Weather,
    SvZones,
    CpZones,
    WorkZone,
}

impl Target {
    /// Its name in a mapping file.
    fn name(self) -> &'static str {
        match self {
            Self::Report => "report",
            Self::Version => "version",
            Self::Incident => "incident",
            Self::Entity => "entity",
            Self::Vehicle => "vehicle",
            Self::Place => "place",
            Self::Narrative => "narrative",
            Self::Date => "date",
            Self::Year => "year",
            Self::Month => "month",
            Self::Hour => "hour",
            Self::Minute => "minute",
            Self::PostedSpeed => "posted_speed",
            Self::SvSpeed => "sv_speed",
            Self::Road => "road",
            Self::SvMovement => "sv_movement",
            Self::CpMovement => "cp_movement",
            Self::Partner => "partner",
            Self::Severity => "severity",
            Self::Engagement => "engagement",
            Self::Surface => "surface",
            Self::Lighting => "lighting",
            Self::Weather => "weather",
            Self::SvZones => "sv_zones",
            Self::CpZones => "cp_zones",
            Self::WorkZone => "work_zone",
        }
    }

    /// The target with a name.
    fn named(name: &str) -> Result<Self, serde::de::value::Error> {
        Self::deserialize(name.into_deserializer())
    }

    /// The names its values can have; `None` where it holds a text or a number.
    fn codes(self) -> Option<Vec<String>> {
        if self == Self::WorkZone {
            return Some(["yes", "no", "unknown"].map(str::to_owned).to_vec());
        }
        // What is coded has the name that the record's field has.
        let mut codes = Field::named(self.name())?.codes()?;
        codes.push("other".to_owned());
        Some(codes)
    }

    /// Whether it is a speed, which needs a unit.
    fn is_speed(self) -> bool {
        matches!(self, Self::PostedSpeed | Self::SvSpeed)
    }
}

impl Mapping {
    /// Reads a mapping file. `name` is the file's, for messages.
    ///
    /// # Errors
    /// What is wrong, with line and key.
    pub fn parse(text: &str, name: &str) -> Result<Self, MappingError> {
        rules::compile(text, name)
    }

    /// Name of the database.
    pub fn name(&self) -> &str {
        &self.name
    }

    fn error(&self, line: usize, key: String, message: String) -> MappingError {
        MappingError { file: self.file.clone(), line: Some(line), key, message }
    }
}
