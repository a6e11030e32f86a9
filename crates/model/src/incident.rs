//! Incidents: one crash, and every report of it: versions, copies of other companies, entities, editions of the file.

use crate::origin::RecordRef;
use crate::record::CrashRecord;
use serde::{Deserialize, Serialize};

/// One crash and its reports.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Incident {
    /// *Same Incident ID*, or the report's id where it has none; `#2` and so on behind it for each further crash that the
    /// file keeps under one id.
    pub id: String,
    /// Every report, by report id, version and place in the files.
    pub reports: Vec<IncidentReport>,
    /// Position in `reports` of the one whose narrative speaks; `None` where no narrative can be read.
    pub speaker: Option<usize>,
}

/// One version of one report of an incident.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct IncidentReport {
    /// The row, read.
    pub record: CrashRecord,
    /// Hash of the narrative, beside id and version: editions of the file change narratives under the same id and version.
    pub text_hash: String,
    /// How well the narrative tells the crash.
    pub telling: Telling,
    /// Report ids that the narrative names.
    pub names: Vec<String>,
    /// Names of what differs from the version before, in this file or an earlier one.
    pub changed: Vec<String>,
}

/// How well a narrative tells its crash.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Telling {
    /// Withheld, or empty.
    Unreadable,
    /// A company's boilerplate about another company's report, or no more than "no update".
    Refers,
    /// It tells the crash.
    Tells,
}

impl Incident {
    /// The report whose narrative speaks.
    pub fn spoken(&self) -> Option<&IncidentReport> {
        self.speaker.and_then(|position| self.reports.get(position))
    }

    /// The report that columns are taken from: the one that speaks, else the last one.
    pub fn leading(&self) -> Option<&IncidentReport> {
        self.spoken().or_else(|| self.reports.last())
    }

    /// Ids and versions of all reports, each once.
    pub fn references(&self) -> Vec<RecordRef> {
        let mut all: Vec<RecordRef> = self.reports.iter().map(|report| report.record.id.clone()).collect();
        all.dedup();
        all
    }
}
