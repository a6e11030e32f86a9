//! The fields of a record by name: one list for filters, tables and mapping files.

use recrash_model::record::{Coded, CrashRecord};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Text of a value that is not known, in filters and tables.
pub const UNKNOWN: &str = "unknown";

/// A field of a record that can be asked for by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    Report,
    Incident,
    Entity,
    Vehicle,
    Place,
    Narrative,
    File,
    Year,
    Month,
    TimeOfDay,
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
    Redaction,
    Edition,
    WorkZone,
}

/// What a field holds.
#[derive(Debug, Clone, PartialEq)]
pub enum FieldValue<'a> {
    /// Free text; empty where nothing was reported.
    Text(&'a str),
    /// A whole number; `None` where not known.
    Whole(Option<i64>),
    /// A measured number; `None` where not known.
    Number(Option<f64>),
    /// Names of coded values, none of which may be there. More than one where several can be ticked.
    Codes(Vec<String>),
    /// Yes or no.
    Flag(bool),
}

impl Field {
    /// Every field, in the order of tables.
    pub const ALL: [Self; 26] = [
        Self::Report,
        Self::Incident,
        Self::Entity,
        Self::Vehicle,
        Self::Year,
        Self::Month,
        Self::TimeOfDay,
        Self::Place,
        Self::Road,
        Self::WorkZone,
        Self::Surface,
        Self::Lighting,
        Self::Weather,
        Self::PostedSpeed,
        Self::Partner,
        Self::CpMovement,
        Self::SvMovement,
        Self::SvSpeed,
        Self::SvZones,
        Self::CpZones,
        Self::Severity,
        Self::Engagement,
        Self::Narrative,
        Self::Redaction,
        Self::File,
        Self::Edition,
    ];

    /// Name in filters, tables and mapping files; numbers have their unit in it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Report => "report",
            Self::Incident => "incident",
            Self::Entity => "entity",
            Self::Vehicle => "vehicle",
            Self::Place => "place",
            Self::Narrative => "narrative",
            Self::File => "file",
            Self::Year => "year",
            Self::Month => "month",
            Self::TimeOfDay => "time_of_day_min",
            Self::PostedSpeed => "posted_speed_mps",
            Self::SvSpeed => "sv_speed_mps",
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
            Self::Redaction => "redaction",
            Self::Edition => "edition",
            Self::WorkZone => "work_zone",
        }
    }

    /// The field with a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|field| field.name() == name)
    }

    /// The names a coded field's values can have; `None` for the other kinds of field.
    pub fn codes(self) -> Option<Vec<String>> {
        use recrash_model::kinds::PartnerKind;
        use recrash_model::record::Severity;
        use recrash_model::record::{Edition, Engagement, Redaction};
        use recrash_model::surroundings::Lighting;
        use recrash_model::surroundings::{Surface, Weather};
        use recrash_model::template::{Movement, RoadType};
        use recrash_model::zones::ContactZone;
        let mut names = match self {
            Self::Road => code_names::<RoadType>(),
            Self::SvMovement | Self::CpMovement => code_names::<Movement>(),
            Self::Partner => code_names::<PartnerKind>(),
            Self::Severity => code_names::<Severity>(),
            Self::Engagement => code_names::<Engagement>(),
            Self::Surface => code_names::<Surface>(),
            Self::Lighting => code_names::<Lighting>(),
            Self::Weather => code_names::<Weather>(),
            Self::SvZones | Self::CpZones => code_names::<ContactZone>(),
            Self::Redaction => code_names::<Redaction>(),
            Self::Edition => code_names::<Edition>(),
            _ => return None,
        };
        if !names.iter().any(|name| name == UNKNOWN) {
            names.push(UNKNOWN.to_owned());
        }
        Some(names)
    }

    /// What the field holds in a record.
    pub fn of(self, record: &CrashRecord) -> FieldValue<'_> {
        use FieldValue::{Codes, Flag, Number, Text, Whole};
        fn one<T: Copy + Serialize>(code: &Coded<T>) -> FieldValue<'static> {
            Codes(code.known().iter().map(code_name).collect())
        }
        fn all<T: Serialize>(codes: &[T]) -> FieldValue<'static> {
            Codes(codes.iter().map(code_name).collect())
        }
        match self {
            Self::Report => Text(&record.id.report_id),
            Self::Incident => Text(record.incident_id.as_deref().unwrap_or_default()),
            Self::Entity => Text(&record.entity),
            Self::Vehicle => Text(&record.vehicle),
            Self::Place => Text(&record.place),
            Self::Narrative => Text(&record.narrative),
            Self::File => Text(&record.provenance.file),
            Self::Year => Whole(record.when.map(|when| i64::from(when.year))),
            Self::Month => Whole(record.when.map(|when| i64::from(when.month))),
            Self::TimeOfDay => Whole(record.time_of_day_min.map(i64::from)),
            Self::PostedSpeed => Number(record.posted_speed_mps),
            Self::SvSpeed => Number(record.sv_speed_mps),
            Self::Road => one(&record.road),
            Self::SvMovement => one(&record.sv_movement),
            Self::CpMovement => one(&record.cp_movement),
            Self::Partner => one(&record.partner),
            Self::Severity => one(&record.severity),
            Self::Engagement => one(&record.engagement),
            Self::Surface => all(record.surface.as_slice()),
            Self::Lighting => all(record.lighting.as_slice()),
            Self::Weather => all(&record.weather),
            Self::SvZones => all(&record.sv_zones),
            Self::CpZones => all(&record.cp_zones),
            Self::Redaction => all(&[record.redaction]),
            Self::Edition => all(&[record.provenance.edition]),
            Self::WorkZone => Flag(record.work_zone),
        }
    }
}

/// The name of a coded value, as suite files have it: `traffic_circle`.
pub fn code_name<T: Serialize>(value: &T) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(name)) => name,
        _ => UNKNOWN.to_owned(),
    }
}

/// The coded value with a name.
pub fn code_named<T: DeserializeOwned>(name: &str) -> Option<T> {
    serde_json::from_value(serde_json::Value::String(name.to_owned())).ok()
}

/// Every name of a code table, in its order. Serde knows them; asked for one that does not exist, it lists them.
fn code_names<T: DeserializeOwned>() -> Vec<String> {
    struct Variants(Vec<String>);
    struct Asked<'a>(&'a mut Variants);
    impl<'de> serde::Deserializer<'de> for Asked<'_> {
        type Error = serde::de::value::Error;
        fn deserialize_any<V: serde::de::Visitor<'de>>(self, _: V) -> Result<V::Value, Self::Error> {
            Err(serde::de::Error::custom("only the names of an enum are asked for"))
        }
        fn deserialize_enum<V: serde::de::Visitor<'de>>(
            self,
            _: &'static str,
            variants: &'static [&'static str],
            _: V,
        ) -> Result<V::Value, Self::Error> {
            self.0.0 = variants.iter().map(|name| (*name).to_owned()).collect();
            Err(serde::de::Error::custom("only the names of an enum are asked for"))
        }
        serde::forward_to_deserialize_any! {
            bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct
            newtype_struct seq tuple tuple_struct map struct identifier ignored_any
        }
    }
    let mut variants = Variants(Vec::new());
    let _ = T::deserialize(Asked(&mut variants));
    variants.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_is_listed_once_and_found_by_its_name() {
        for field in Field::ALL {
            assert_eq!(Field::named(field.name()), Some(field));
        }
        assert_eq!(Field::named("speed"), None);
    }

    #[test]
    fn codes_are_those_of_the_suite_files() {
        assert_eq!(Field::Severity.codes().unwrap(), ["none", "minor", "moderate", "serious", "fatality", "unknown"]);
        assert!(Field::Road.codes().unwrap().contains(&"traffic_circle".to_owned()));
        assert_eq!(Field::Year.codes(), None);
    }
}
