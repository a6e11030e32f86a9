//! The labels: read, and checked row by row.

use crate::error::PipelineError;
use recrash_lab::evaluation::{Field, TwoReaders};
use recrash_model::labelled::LabelledAccount;
use recrash_model::record::RecordRef;
use recrash_model::{Diagnostic, Location, Severity};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// A kind of label file: what it asks, and the one that comes with recrash.
#[derive(Debug)]
pub struct Sheet {
    /// Name of the built-in labels in messages.
    pub name: &'static str,
    /// The built-in labels.
    pub built_in: &'static str,
    /// Header.
    pub columns: &'static [&'static str],
    /// What is scored, in the order of tables.
    pub fields: &'static [Field],
}

/// Labels of records, for who reads them one by one.
pub const RECORDS: Sheet = Sheet {
    name: "eval/labels.csv",
    built_in: include_str!("../../../../../eval/labels.csv"),
    columns: &[
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
    ],
    fields: &Field::OF_RECORDS,
};

/// Labels of accounts, by two readers each, for the reader that suites use.
pub const ACCOUNTS: Sheet = Sheet {
    name: "eval/accounts.csv",
    built_in: include_str!("../../../../../eval/accounts.csv"),
    columns: &[
        "half",
        "report",
        "version",
        "file",
        "crash_type",
        "role",
        "striker",
        "sv_state",
        "sv_since",
        "driver",
        "sv_movement",
        "cp_movement",
        "came_from",
        "order",
        "first_contact",
        "sv_zones",
        "cp_zones",
        "sv_impact_mps",
        "note",
    ],
    fields: &Field::OF_ACCOUNTS,
};

impl Sheet {
    /// A cell of a row; absent where this kind of file has no such column.
    fn cell<'a>(&self, cells: &'a csv::StringRecord, column: &str) -> Option<&'a str> {
        let position = self.columns.iter().position(|name| *name == column)?;
        cells.get(position).map(str::trim)
    }
}

/// How often the two readers of `eval/accounts.csv` agree, by half and field.
const AGREEMENT: &str = include_str!("../../../../../eval/agreement.csv");

/// How often the two readers of the built-in accounts agree on a field.
pub fn agreement(half: Half, field: Field) -> Option<TwoReaders> {
    #[derive(Deserialize)]
    struct Row {
        half: Half,
        field: Field,
        agreed: usize,
        both_told: usize,
    }
    let mut reader = csv::Reader::from_reader(AGREEMENT.as_bytes());
    let row = reader.deserialize::<Row>().flatten().find(|row| (row.half, row.field) == (half, field))?;
    Some(TwoReaders { agreed: row.agreed, both_told: row.both_told })
}

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
    /// What a person who read it says; absent where a careful reader cannot tell.
    pub account: LabelledAccount,
}

/// Reads a label file.
///
/// # Errors
/// Every cell that is no label, with its row and column.
pub fn read_labels(name: &str, text: &str, sheet: &Sheet) -> Result<Vec<Label>, PipelineError> {
    let mut rows = Rows { name, sheet, labels: Vec::new(), problems: Vec::new() };
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
    let header: Vec<String> = match reader.headers() {
        Ok(header) => header.iter().map(str::to_owned).collect(),
        Err(error) => vec![error.to_string()],
    };
    if header != sheet.columns {
        return Err(PipelineError::bad_input(format!(
            "{name} is no label file: its header is \"{}\"; it must be \"{}\"",
            header.join(","),
            sheet.columns.join(",")
        )));
    }
    for (number, record) in (1..).zip(reader.records()) {
        match record {
            Ok(cells) if cells.len() == sheet.columns.len() => rows.row(number, &cells),
            Ok(cells) => {
                rows.problem(number, None, format!("{} cells; {} are wanted", cells.len(), sheet.columns.len()))
            }
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
    sheet: &'a Sheet,
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
        let cell = |column| self.sheet.cell(cells, column).unwrap_or_default();
        let (half, version) = (cell("half"), cell("version"));
        let record = RecordRef { report_id: cell("report").to_owned(), version: version.parse().unwrap_or_default() };
        if version.parse::<u32>().is_err() {
            self.problem(row, Some("version"), format!("\"{version}\" is not a whole number"));
        }
        let half = self.value::<Half>(row, "half", half);
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
        let cp_unmoved = self.sheet.cell(cells, "cp_movement") == Some("none");
        let account = LabelledAccount {
            road: self.coded(row, cells, "road"),
            sv_movement: self.coded(row, cells, "sv_movement"),
            cp_movement: if cp_unmoved { None } else { self.coded(row, cells, "cp_movement") },
            approach: self.coded(row, cells, "approach"),
            order: self.coded(row, cells, "order"),
            sv_zones: self.zones(row, cells, "sv_zones"),
            cp_zones: self.zones(row, cells, "cp_zones"),
            // Kinds beyond ours are told apart from unknown ones by `excluded` alone.
            collision: match self.sheet.cell(cells, "collision") {
                Some("other") => None,
                _ => self.coded(row, cells, "collision"),
            },
            excluded: self.yes_or_no(row, cells),
            crash_type: self.coded(row, cells, "crash_type"),
            role: self.coded(row, cells, "role"),
            striker: self.coded(row, cells, "striker"),
            sv_state: self.coded(row, cells, "sv_state"),
            sv_since: self.coded(row, cells, "sv_since"),
            driver: self.coded(row, cells, "driver"),
            cp_unmoved,
            came_from: self.coded(row, cells, "came_from"),
            first_contact: self.coded(row, cells, "first_contact"),
            sv_impact_mps: self.speed(row, cells),
        };
        if let (Some(half), true) = (half, self.problems.len() == before) {
            self.labels.push(Label { half, record, account });
        }
    }

    /// The value of a cell, where these labels ask it.
    fn coded<T: DeserializeOwned>(&mut self, row: u64, cells: &csv::StringRecord, column: &str) -> Option<T> {
        let text = self.sheet.cell(cells, column)?;
        self.value(row, column, text)
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

    fn zones<T: DeserializeOwned>(&mut self, row: u64, cells: &csv::StringRecord, column: &str) -> Vec<T> {
        let text = self.sheet.cell(cells, column).unwrap_or_default();
        let names = text.split(';').map(str::trim).filter(|name| !name.is_empty());
        names.filter_map(|name| self.value(row, column, name)).collect()
    }

    fn yes_or_no(&mut self, row: u64, cells: &csv::StringRecord) -> Option<bool> {
        match self.sheet.cell(cells, "excluded")? {
            "yes" => Some(true),
            "no" => Some(false),
            "unknown" => None,
            other => {
                self.problem(row, Some("excluded"), format!("\"{other}\" is none of yes, no, unknown"));
                None
            }
        }
    }

    fn speed(&mut self, row: u64, cells: &csv::StringRecord) -> Option<f64> {
        let text = self.sheet.cell(cells, "sv_impact_mps").filter(|text| *text != "unknown")?;
        let speed = text.parse::<f64>().ok().filter(|mps| (0.0..100.0).contains(mps));
        if speed.is_none() {
            self.problem(row, Some("sv_impact_mps"), format!("\"{text}\" is no speed in m/s, or unknown"));
        }
        speed
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
        read_labels("labels.csv", &format!("{}\n{}\n", RECORDS.columns.join(","), rows.join("\n")), &RECORDS)
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
        assert!(read_labels("x", "a,b\n1,2\n", &RECORDS).unwrap_err().to_string().contains("header"));
    }

    #[test]
    fn both_halves_hold_about_half() {
        let dev = (0..1000).filter(|n| Half::of(&format!("30270-{n}")) == Half::Dev).count();
        assert!((440..560).contains(&dev), "{dev}");
    }

    #[test]
    fn the_built_in_labels_are_read_and_the_readers_agreement_is_known_of_every_field() {
        for sheet in [&RECORDS, &ACCOUNTS] {
            assert!(read_labels(sheet.name, sheet.built_in, sheet).unwrap().len() > 150, "{}", sheet.name);
        }
        for (half, field) in
            [Half::Dev, Half::HeldOut].into_iter().flat_map(|half| ACCOUNTS.fields.iter().map(move |f| (half, *f)))
        {
            let told = agreement(half, field).unwrap();
            assert!(told.agreed <= told.both_told && told.both_told > 100, "{field:?} {told:?}");
        }
        assert_eq!(agreement(Half::Dev, Field::Road), None);
    }

    #[test]
    fn a_row_of_accounts_is_read_and_its_wrong_cells_are_told() {
        let row = format!(
            "dev,{},1,a.csv,single_vehicle,initiator,sv,moving,under_way,system,straight,none,ahead,cp,object,front,,4.5,",
            dev_id()
        );
        let read =
            |row: &str| read_labels("accounts.csv", &format!("{}\n{row}\n", ACCOUNTS.columns.join(",")), &ACCOUNTS);
        let labels = read(&row).unwrap();
        let account = &labels[0].account;
        assert!(account.cp_unmoved && account.road.is_none() && account.excluded.is_none());
        assert_eq!(
            (account.sv_impact_mps, account.sv_since),
            (Some(4.5), Some(recrash_model::labelled::Since::UnderWay))
        );
        assert_eq!(read(&row.replace("4.5", "unknown")).unwrap()[0].account.sv_impact_mps, None);
        for (from, to, column) in [
            ("4.5", "fast", "sv_impact_mps"),
            ("under_way", "lately", "sv_since"),
            ("ahead", "same", "came_from"),
            ("none", "nothing", "cp_movement"),
        ] {
            let Err(PipelineError::BadInput { diagnostics, .. }) = read(&row.replacen(from, to, 1)) else {
                panic!("{to} is taken")
            };
            assert_eq!(diagnostics[0].location.column.as_deref(), Some(column), "{diagnostics:?}");
        }
    }
}
