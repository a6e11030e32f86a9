//! The labels: read, and checked row by row.

use crate::error::PipelineError;
use recrash_model::labelled::LabelledAccount;
use recrash_model::record::RecordRef;
use recrash_model::{Diagnostic, Location, Severity};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The header of a label file.
pub const COLUMNS: [&str; 15] = [
    "half",
    "report",
    "version",
    "file",
    "entity",
    "road",
    "sv_movement",
    "cp_movement",
    "approach",
    "order",
    "sv_zones",
    "cp_zones",
    "collision",
    "excluded",
    "note",
];

/// Which half of the records a label belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Half {
    /// The rules were written reading records of this half.
    Dev,
    /// Nobody who writes rules reads records of this half.
    HeldOut,
}

impl Half {
    /// The half of a report: the SHA-256 of its id, taken as one integer, is even in the developed half
    /// (`docs/models/rules.md`).
    pub fn of(report_id: &str) -> Self {
        let last = Sha256::digest(report_id.as_bytes()).last().copied();
        if last.is_some_and(|last| last % 2 == 0) { Self::Dev } else { Self::HeldOut }
    }

    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Dev => "dev",
            Self::HeldOut => "held-out",
        }
    }
}

/// One labelled record.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Its half.
    pub half: Half,
    /// Record.
    pub record: RecordRef,
    /// Who reported it.
    pub entity: String,
    /// What a person who read it says; absent where a careful reader cannot tell.
    pub account: LabelledAccount,
}

/// Reads a label file.
///
/// # Errors
/// Every cell that is no label, with its row and column.
pub fn read_labels(name: &str, text: &str) -> Result<Vec<Label>, PipelineError> {
    let mut rows = Rows { name, labels: Vec::new(), problems: Vec::new() };
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
    let header: Vec<String> = match reader.headers() {
        Ok(header) => header.iter().map(str::to_owned).collect(),
        Err(error) => vec![error.to_string()],
    };
    if header != COLUMNS {
        return Err(PipelineError::bad_input(format!(
            "{name} is no label file: its header is \"{}\"; it must be \"{}\"",
            header.join(","),
            COLUMNS.join(",")
        )));
    }
    for (number, record) in (1..).zip(reader.records()) {
        match record {
            Ok(cells) if cells.len() == COLUMNS.len() => rows.row(number, &cells),
            Ok(cells) => rows.problem(number, None, format!("{} cells; {} are wanted", cells.len(), COLUMNS.len())),
            Err(error) => rows.problem(number, None, error.to_string()),
        }
    }
    if !rows.problems.is_empty() {
        return Err(PipelineError::BadInput {
            what: format!("{name}: {} labels cannot be used", rows.problems.len()),
            diagnostics: rows.problems,
        });
    }
    Ok(rows.labels)
}

struct Rows<'a> {
    name: &'a str,
    labels: Vec<Label>,
    problems: Vec<Diagnostic>,
}

impl Rows<'_> {
    fn problem(&mut self, row: u64, column: Option<&str>, message: String) {
        let location = Location { column: column.map(str::to_owned), ..Location::at_row(self.name, row) };
        self.problems.push(Diagnostic::new(Severity::Error, "eval.label", location, message));
    }

    fn row(&mut self, row: u64, cells: &csv::StringRecord) {
        let before = self.problems.len();
        let cell = |column: &str| {
            let position = COLUMNS.iter().position(|name| *name == column);
            position.and_then(|position| cells.get(position)).unwrap_or_default().trim().to_owned()
        };
        let half = self.value::<Half>(row, "half", &cell("half"));
        let version = cell("version").parse();
        if version.is_err() {
            self.problem(row, Some("version"), format!("\"{}\" is not a whole number", cell("version")));
        }
        let record = RecordRef { report_id: cell("report"), version: version.unwrap_or_default() };
        if record.report_id.is_empty() {
            self.problem(row, Some("report"), "there is no report id".into());
        }
        if let Some(stated) = half.filter(|stated| *stated != Half::of(&record.report_id)) {
            let right = Half::of(&record.report_id).label();
            let message = format!("{} is {right} by its hash, not {}", record.report_id, stated.label());
            self.problem(row, Some("half"), message);
        }
        if self.labels.iter().any(|label| label.record == record) {
            self.problem(row, Some("report"), format!("{record} is labelled twice"));
        }
        let collision = cell("collision");
        let account = LabelledAccount {
            road: self.value(row, "road", &cell("road")),
            sv_movement: self.value(row, "sv_movement", &cell("sv_movement")),
            cp_movement: self.value(row, "cp_movement", &cell("cp_movement")),
            approach: self.value(row, "approach", &cell("approach")),
            order: self.value(row, "order", &cell("order")),
            sv_zones: self.zones(row, "sv_zones", &cell("sv_zones")),
            cp_zones: self.zones(row, "cp_zones", &cell("cp_zones")),
            // Kinds beyond ours are told apart from unknown ones by `excluded` alone.
            collision: if collision == "other" { None } else { self.value(row, "collision", &collision) },
            excluded: self.yes_or_no(row, &cell("excluded")),
        };
        if let (Some(half), true) = (half, self.problems.len() == before) {
            self.labels.push(Label { half, record, entity: cell("entity"), account });
        }
    }

    /// A value as JSON spells it; `unknown` is none.
    fn value<T: DeserializeOwned>(&mut self, row: u64, column: &str, text: &str) -> Option<T> {
        if text == "unknown" {
            return None;
        }
        match serde_json::from_value(serde_json::Value::String(text.to_owned())) {
            Ok(value) => Some(value),
            Err(error) => {
                self.problem(row, Some(column), format!("{error}, or unknown"));
                None
            }
        }
    }

    fn zones<T: DeserializeOwned>(&mut self, row: u64, column: &str, text: &str) -> Vec<T> {
        let names = text.split(';').map(str::trim).filter(|name| !name.is_empty());
        names.filter_map(|name| self.value(row, column, name)).collect()
    }

    fn yes_or_no(&mut self, row: u64, text: &str) -> Option<bool> {
        match text {
            "yes" => Some(true),
            "no" => Some(false),
            "unknown" => None,
            other => {
                self.problem(row, Some("excluded"), format!("\"{other}\" is none of yes, no, unknown"));
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::template::Movement;

    const ROW: &str =
        "dev,1-1,1,a.csv,Acme,intersection,straight,left_turn,opposite,cp,front;front_left,right,angle,no,";

    /// A report id of the developed half.
    fn dev_id() -> String {
        (0..).map(|n| format!("1-{n}")).find(|id| Half::of(id) == Half::Dev).unwrap_or_default()
    }

    fn read(rows: &[String]) -> Result<Vec<Label>, PipelineError> {
        read_labels("labels.csv", &format!("{}\n{}\n", COLUMNS.join(","), rows.join("\n")))
    }

    fn row() -> String {
        ROW.replace("1-1,", &format!("{},", dev_id()))
    }

    #[test]
    fn a_row_becomes_an_account() {
        let labels = read(&[row()]).unwrap();
        assert_eq!(labels[0].account.cp_movement, Some(Movement::LeftTurn));
        assert_eq!(labels[0].account.sv_zones.len(), 2);
        assert_eq!(labels[0].account.excluded, Some(false));
    }

    #[test]
    fn every_wrong_cell_is_told_with_row_and_column() {
        for (from, to, column) in [
            ("intersection", "crossroads", "road"),
            ("left_turn", "turns left", "cp_movement"),
            ("opposite", "behind", "approach"),
            (",cp,", ",they,", "order"),
            ("front_left", "nose", "sv_zones"),
            (",no,", ",perhaps,", "excluded"),
            (",1,a", ",one,a", "version"),
            ("dev", "held-out", "half"),
        ] {
            let wrong = row().replacen(from, to, 1);
            assert_ne!(wrong, row(), "{from}");
            let Err(PipelineError::BadInput { diagnostics, .. }) = read(std::slice::from_ref(&wrong)) else {
                panic!("{wrong} is taken")
            };
            assert_eq!(diagnostics.len(), 1, "{diagnostics:?}");
            assert_eq!(diagnostics[0].location.column.as_deref(), Some(column));
            assert_eq!(diagnostics[0].location.row, Some(1));
        }
    }

    #[test]
    fn short_rows_doubles_and_other_files_are_refused() {
        assert!(read(&["dev,1-1".into()]).is_err());
        assert!(read(&[row(), row()]).unwrap_err().to_string().contains("1 labels"));
        assert!(read_labels("x", "a,b\n1,2\n").unwrap_err().to_string().contains("header"));
    }

    #[test]
    fn both_halves_hold_about_half() {
        let dev = (0..1000).filter(|n| Half::of(&format!("30270-{n}")) == Half::Dev).count();
        assert!((440..560).contains(&dev), "{dev}");
    }
}
