//! Records as a table: one row a record, one column a field. Value in, bytes out.

use crate::fields::{Field, FieldValue};
use recrash_model::record::{CrashRecord, RecordSet, Reject};
use recrash_model::spreadsheet::inert;
use std::collections::BTreeMap;

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

/// Records as a table: every field of `Field::ALL`, then the report's version and row, the template, whether the
/// record is usable and, if not, why.
pub fn record_table(set: &RecordSet, rows: TableRows) -> RecordTable {
    let mut usable = vec![false; set.records.len()];
    set.usable.iter().for_each(|&i| usable[i] = true);
    let shown: Vec<usize> = (0..set.records.len()).filter(|&i| rows == TableRows::All || usable[i]).collect();
    let records = || shown.iter().map(|&i| &set.records[i]);

    let mut columns: Vec<(&'static str, Column)> =
        Field::ALL.into_iter().map(|field| (field.name(), column(field, records()))).collect();
    let rejects: BTreeMap<(&str, u64), &Reject> = set.rejects.iter().map(|r| ((r.file.as_str(), r.row), r)).collect();
    let reason = |record: &CrashRecord| {
        let place = (record.provenance.file.as_str(), record.provenance.row);
        rejects.get(&place).map(|reject| reject.reason.label().to_owned())
    };
    let whole = |number: u64| i64::try_from(number).ok();
    columns.insert(1, ("version", Column::Whole(records().map(|r| Some(i64::from(r.id.version))).collect())));
    columns.extend([
        ("row", Column::Whole(records().map(|r| whole(r.provenance.row)).collect())),
        ("template", Column::Text(records().map(|r| r.template().map(|template| template.slug())).collect())),
        ("usable", Column::Flag(shown.iter().map(|&i| Some(usable[i])).collect())),
        ("lost", Column::Text(shown.iter().map(|&i| if usable[i] { None } else { reason(&set.records[i]) }).collect())),
    ]);
    RecordTable { columns, rows: shown.len() }
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
    /// The table as CSV: a header, commas, quotes where needed, UTF-8, a line feed behind each row; `true` and `false`,
    /// and nothing where a value is missing. Texts that a spreadsheet would run as formulas are made inert
    /// ([`recrash_model::spreadsheet`]).
    pub fn to_csv(&self) -> Vec<u8> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut write = |fields: Vec<String>| {
            // Into memory, and every row has the header's width.
            writer.write_record(fields).expect("a row of the header's width is written into memory");
        };
        write(self.columns.iter().map(|(name, _)| (*name).to_owned()).collect());
        for row in 0..self.rows {
            write(self.columns.iter().map(|(_, column)| column.cell(row)).collect());
        }
        writer.into_inner().unwrap_or_default()
    }
}

impl Column {
    fn cell(&self, row: usize) -> String {
        fn text<T: ToString>(values: &[Option<T>], row: usize) -> String {
            values.get(row).and_then(Option::as_ref).map(T::to_string).unwrap_or_default()
        }
        match self {
            Self::Text(values) => inert(&text(values, row)).into_owned(),
            Self::Whole(values) => text(values, row),
            Self::Number(values) => text(values, row),
            Self::Flag(values) => text(values, row),
        }
    }
}
