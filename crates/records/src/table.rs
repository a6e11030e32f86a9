//! Records as a table: one row a record, one column a field. Value in, bytes out.

use crate::fields::{Field, FieldValue};
use recrash_model::record::{CrashRecord, RecordSet, Reject};
use recrash_model::spreadsheet::{inert, visible};
use std::collections::BTreeMap;
use std::io::Write;

/// Parts several codes in one cell: `front;front_left`.
const CODE_SEPARATOR: &str = ";";

/// Which records go into a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TableRows {
    /// Those the profile can use.
    #[default]
    Usable,
    /// Every record that could be read. Rows that are no record have no fields to show.
    All,
}

/// A column of a table. Every value may be missing.
#[derive(Debug, Clone, PartialEq)]
pub enum Column {
    /// Texts and names of codes.
    Text(Vec<Option<String>>),
    /// Whole numbers.
    Whole(Vec<Option<i64>>),
    /// Measured numbers, in the unit that the column's name ends with.
    Number(Vec<Option<f64>>),
    /// Yes or no.
    Flag(Vec<Option<bool>>),
}

/// A table: columns of one length, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordTable {
    /// Name and content of each column.
    pub columns: Vec<(&'static str, Column)>,
    /// Rows.
    pub rows: usize,
}

/// Rows of a CSV table that are put together at once.
const CHUNK: usize = 4096;

/// Name of the column of the file's own *Same Incident ID*.
const SAME_INCIDENT: &str = "same_incident_id";

/// Records as a table: every field of `Field::ALL`, then the report's version and row, the template, whether the
/// record is usable and, if not, why.
///
/// `incidents` has the incident of each record of the set, as accounts name it: reports are grouped by more than the file's
/// *Same Incident ID*, which stands beside it.
pub fn record_table(set: &RecordSet, incidents: &[Option<String>], rows: TableRows) -> RecordTable {
    let source = TableSource::new(set, incidents);
    source.table(&source.shown(rows))
}

/// Writes [`record_table`] as CSV, with a few thousand rows in memory: a header, commas, quotes where needed, UTF-8, a line
/// feed behind each row; `true` and `false`, and nothing where a value is missing. Texts that a spreadsheet would run as
/// formulas are made inert, and characters that a terminal obeys are replaced ([`recrash_model::spreadsheet`]). Gives the number of rows.
///
/// # Errors
/// The sink cannot be written.
pub fn write_csv(
    set: &RecordSet,
    incidents: &[Option<String>],
    rows: TableRows,
    sink: impl Write,
) -> std::io::Result<usize> {
    let source = TableSource::new(set, incidents);
    let shown = source.shown(rows);
    let mut writer = csv::Writer::from_writer(sink);
    source.table(&[]).write_header(&mut writer)?;
    for chunk in shown.chunks(CHUNK) {
        source.table(chunk).write_rows(&mut writer)?;
    }
    writer.flush()?;
    Ok(shown.len())
}

/// Records, and what a table tells about each beside its fields.
struct TableSource<'a> {
    set: &'a RecordSet,
    incidents: &'a [Option<String>],
    usable: Vec<bool>,
    rejects: BTreeMap<(&'a str, u64), &'a Reject>,
}

impl<'a> TableSource<'a> {
    fn new(set: &'a RecordSet, incidents: &'a [Option<String>]) -> Self {
        let mut usable = vec![false; set.records.len()];
        set.usable.iter().for_each(|&i| usable[i] = true);
        let rejects = set.rejects.iter().map(|r| ((r.file.as_str(), r.row), r)).collect();
        Self { set, incidents, usable, rejects }
    }

    /// Positions of the records that are shown.
    fn shown(&self, rows: TableRows) -> Vec<usize> {
        (0..self.set.records.len()).filter(|&i| rows == TableRows::All || self.usable[i]).collect()
    }

    fn reason(&self, record: &CrashRecord) -> Option<String> {
        let place = (record.provenance.file.as_str(), record.provenance.row);
        self.rejects.get(&place).map(|reject| reject.reason.label().to_owned())
    }

    /// The table of these records.
    fn table(&self, shown: &[usize]) -> RecordTable {
        let records = || shown.iter().map(|&i| &self.set.records[i]);
        let mut columns: Vec<(&'static str, Column)> =
            Field::ALL.into_iter().map(|field| (field.name(), column(field, records()))).collect();
        let whole = |number: u64| i64::try_from(number).ok();
        let lost = |&i: &usize| if self.usable[i] { None } else { self.reason(&self.set.records[i]) };
        // The filter's field of this name is the file's id, as the row has it; a table goes by incidents.
        if let Some(at) = columns.iter().position(|(name, _)| *name == Field::Incident.name()) {
            columns[at].0 = SAME_INCIDENT;
            let incidents = shown.iter().map(|&i| self.incidents.get(i).cloned().flatten()).collect();
            columns.insert(at, (Field::Incident.name(), Column::Text(incidents)));
        }
        columns.insert(1, ("version", Column::Whole(records().map(|r| Some(i64::from(r.id.version))).collect())));
        columns.extend([
            ("row", Column::Whole(records().map(|r| whole(r.provenance.row)).collect())),
            ("template", Column::Text(records().map(|r| r.template().map(|template| template.slug())).collect())),
            ("usable", Column::Flag(shown.iter().map(|&i| Some(self.usable[i])).collect())),
            ("lost", Column::Text(shown.iter().map(lost).collect())),
        ]);
        RecordTable { columns, rows: shown.len() }
    }
}

/// A field of some records as a column.
fn column<'a>(field: Field, records: impl Iterator<Item = &'a CrashRecord>) -> Column {
    let mut texts = Vec::new();
    let mut wholes = Vec::new();
    let mut numbers = Vec::new();
    let mut flags = Vec::new();
    for record in records {
        match field.of(record) {
            FieldValue::Text(text) => texts.push(Some(text.to_owned()).filter(|text| !text.is_empty())),
            FieldValue::Codes(codes) => {
                texts.push(Some(codes.join(CODE_SEPARATOR)).filter(|codes| !codes.is_empty()));
            }
            FieldValue::Whole(number) => wholes.push(number),
            FieldValue::Number(number) => numbers.push(number),
            FieldValue::Flag(flag) => flags.push(Some(flag)),
        }
    }
    match field {
        Field::Year | Field::Month | Field::TimeOfDay => Column::Whole(wholes),
        Field::PostedSpeed | Field::SvSpeed => Column::Number(numbers),
        Field::WorkZone => Column::Flag(flags),
        _ => Column::Text(texts),
    }
}

impl RecordTable {
    /// Writes the table as CSV, as [`write_csv`] writes records.
    ///
    /// # Errors
    /// The sink cannot be written.
    pub fn write_csv(&self, sink: impl Write) -> std::io::Result<()> {
        let mut writer = csv::Writer::from_writer(sink);
        self.write_header(&mut writer)?;
        self.write_rows(&mut writer)?;
        writer.flush()
    }

    fn write_header<W: Write>(&self, writer: &mut csv::Writer<W>) -> std::io::Result<()> {
        Ok(writer.write_record(self.columns.iter().map(|(name, _)| *name))?)
    }

    fn write_rows<W: Write>(&self, writer: &mut csv::Writer<W>) -> std::io::Result<()> {
        for row in 0..self.rows {
            writer.write_record(self.columns.iter().map(|(_, column)| column.cell(row)))?;
        }
        Ok(())
    }
}

impl Column {
    fn cell(&self, row: usize) -> String {
        fn text<T: ToString>(values: &[Option<T>], row: usize) -> String {
            values.get(row).and_then(Option::as_ref).map(T::to_string).unwrap_or_default()
        }
        match self {
            Self::Text(values) => inert(&visible(&text(values, row))).into_owned(),
            Self::Whole(values) => text(values, row),
            Self::Number(values) => text(values, row),
            Self::Flag(values) => text(values, row),
        }
    }
}
