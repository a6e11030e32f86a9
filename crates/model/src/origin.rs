//! Where something comes from: the record, and whose crash it tells.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

impl RecordRef {
    /// Whether somebody who writes this means it: the report's id, with its version or without.
    pub fn is_called(&self, name: &str) -> bool {
        let rest = name.strip_prefix(&self.report_id);
        rest.is_some_and(|rest| rest.is_empty() || rest.strip_prefix('/') == Some(&self.version.to_string()))
    }
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

/// Whose crash is told.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", tag = "is", deny_unknown_fields)]
pub enum Origin {
    /// The picked record's own.
    Own,
    /// Another real record's, which takes the picked one's place.
    Other {
        /// The record that is told.
        record: RecordRef,
        /// Why the picked one is not.
        reason: String,
    },
    /// Nobody's: a plausible course of the same template.
    Invented {
        /// Why no record is told.
        reason: String,
    },
}

impl Origin {
    /// One word for files and tables: `own`, `other` or `invented`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Other { .. } => "other",
            Self::Invented { .. } => "invented",
        }
    }

    /// For sentences.
    pub fn label(&self) -> &'static str {
        match self {
            Self::Own => "own record",
            Self::Other { .. } => "another record",
            Self::Invented { .. } => "invented",
        }
    }

    /// Why the picked record is not told, where it is not.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Own => None,
            Self::Other { reason, .. } | Self::Invented { reason } => Some(reason),
        }
    }
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
}
