//! Tables of records and how the records are spread.

use crate::common::builder::{row, second};
use crate::common::{ingest_bytes, paper};
use recrash_model::record::{Edition, RecordSet};
use recrash_model::spreadsheet::original;
use recrash_records::{SAMPLE_CSV, SourceText, TableRows, distributions, ingest, write_csv};

fn csv_of(set: &RecordSet, rows: TableRows) -> Vec<u8> {
    let mut csv = Vec::new();
    write_csv(set, &[], rows, &mut csv).unwrap();
    csv
}

fn cells(csv: &[u8]) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(csv);
    reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect()
}

#[test]
fn a_csv_table_has_a_row_a_record_and_nothing_where_nothing_is_known() {
    let narrative = "It said \"stop\",\nand went.";
    let changes = [
        ("Narrative", narrative),
        ("Incident Date", "JUN-2024"),
        ("Incident Time (24:00)", "7:05"),
        ("SV Contact Area - Front", "Y"),
        ("SV Contact Area - Left", "Y"),
    ];
    let text =
        second(&[row(Edition::Second, "1-1", &changes), row(Edition::Second, "1-2", &[("Roadway Type", "Bridge")])]);
    let set = ingest_bytes(text.as_bytes()).value;
    let usable = cells(&csv_of(&set, TableRows::Usable));
    let all = cells(&csv_of(&set, TableRows::All));
    assert_eq!((usable.len(), all.len()), (2, 3));
    assert_eq!(usable[..2], all[..2]);
    let cell = |row: usize, name: &str| {
        let column = all[0].iter().position(|other| other == name).unwrap_or_else(|| panic!("{name}"));
        all[row][column].clone()
    };
    assert_eq!(cell(1, "report"), "1-1");
    assert_eq!(cell(1, "version"), "1");
    assert_eq!(
        (cell(1, "year"), cell(1, "month"), cell(1, "time_of_day_min")),
        ("2024".into(), "6".into(), "425".into())
    );
    assert_eq!(cell(1, "narrative"), narrative);
    assert_eq!(cell(1, "sv_zones"), "front;left");
    assert_eq!(cell(1, "sv_speed_mps"), "4.4704");
    assert_eq!(cell(1, "template"), "intersection-left-straight");
    assert_eq!((cell(1, "usable"), cell(1, "lost")), ("true".into(), String::new()));
    assert_eq!((cell(2, "road"), cell(2, "year"), cell(2, "surface")), (String::new(), String::new(), String::new()));
    assert_eq!((cell(2, "usable"), cell(2, "lost").as_str()), ("false".into(), "road type not expressible"));
}

#[test]
fn an_incident_has_the_name_that_is_given_and_the_files_own_beside_it() {
    let row = row(Edition::Second, "1-1", &[("Same Incident ID", "aa")]);
    let set = ingest_bytes(second(&[row]).as_bytes()).value;
    let table = recrash_records::record_table(&set, &[Some("bb".to_owned())], TableRows::All);
    let column = |name: &str| table.columns.iter().find(|(other, _)| *other == name).unwrap().1.clone();
    let text = |text: &str| recrash_records::Column::Text(vec![Some(text.to_owned())]);
    assert_eq!((column("incident"), column("same_incident_id")), (text("bb"), text("aa")));
}

#[test]
fn a_spreadsheet_runs_no_cell_of_a_csv_table_and_every_text_comes_back() {
    let texts = ["=cmd|' /C calc'!A0", "+1+1", "-1-1", "@SUM(A1)", "'=1", "It's 3 - 2 = 1."];
    let rows: Vec<String> = (1..)
        .zip(texts)
        .map(|(n, text)| row(Edition::Second, &format!("1-{n}"), &[("Reporting Entity", text)]))
        .collect();
    let set = ingest_bytes(second(&rows).as_bytes()).value;
    let table = cells(&csv_of(&set, TableRows::All));
    let at = table[0].iter().position(|name| name == "entity").unwrap();
    for (row, text) in table[1..].iter().zip(texts) {
        assert!(
            !row.iter().any(|cell| cell.starts_with(['=', '+', '@', '\t', '\r']) || cell.starts_with("-1-")),
            "{row:?}"
        );
        assert_eq!(original(&row[at]), text);
    }
}

#[test]
fn a_csv_table_holds_nothing_that_a_terminal_obeys() {
    let odd = [
        ("Reporting Entity", "A\u{1b}[2J Inc.\u{202e}"),
        ("Narrative", "It \u{1b}]0;x\u{7} stopped.\nThen it went on."),
    ];
    let set = ingest_bytes(second(&[row(Edition::Second, "1-\u{202e}1", &odd)]).as_bytes()).value;
    let table = String::from_utf8(csv_of(&set, TableRows::All)).unwrap();
    let obeyed = |c: char| c.is_control() && !matches!(c, '\n' | '\r' | '\t') || c == '\u{202e}';
    assert!(!table.contains(obeyed), "{table:?}");
    assert!(table.contains("A\u{fffd}[2J Inc.") && table.contains("stopped.\nThen"), "{table:?}");
}

#[test]
fn the_sample_spreads_as_its_generator_says() {
    let set = ingest(&[SourceText { name: "sample.csv", bytes: SAMPLE_CSV.as_bytes() }], &paper()).unwrap().value;
    let all = distributions(&set);
    let names: Vec<&str> = all.iter().map(|d| d.field.as_str()).collect();
    assert_eq!(names, ["entity", "road", "sv_movement", "cp_movement", "partner", "severity", "year", "month"]);
    for distribution in &all {
        let records: usize = distribution.values.iter().map(|v| v.records).sum();
        let usable: usize = distribution.values.iter().map(|v| v.usable).sum();
        assert_eq!((records, usable), (set.records.len(), set.usable.len()), "{}", distribution.field);
    }
    let road = |name: &str| all[1].values.iter().find(|v| v.value == name).map(|v| v.usable);
    assert_eq!((road("intersection"), road("highway"), road("traffic_circle")), (Some(72), Some(14), Some(2)));
}

#[cfg(feature = "parquet")]
mod parquet_files {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;
    use recrash_records::record_table;

    #[test]
    fn a_parquet_table_reads_back_as_the_csv_table() {
        let set = ingest(&[SourceText { name: "sample.csv", bytes: SAMPLE_CSV.as_bytes() }], &paper()).unwrap().value;
        let table = record_table(&set, &[], TableRows::All);
        let bytes = table.to_parquet();
        assert_eq!(bytes, table.to_parquet());
        let csv = cells(&csv_of(&set, TableRows::All));
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        assert_eq!(reader.metadata().file_metadata().num_rows() as usize, set.records.len());
        let mut rows = 0;
        for (row, wanted) in reader.get_row_iter(None).unwrap().zip(&csv[1..]) {
            for ((name, field), wanted) in row.unwrap().into_columns().into_iter().zip(wanted) {
                let found = match field {
                    Field::Null => String::new(),
                    Field::Str(text) => text,
                    Field::Long(number) => number.to_string(),
                    Field::Double(number) => number.to_string(),
                    Field::Bool(flag) => flag.to_string(),
                    other => panic!("{name}: {other:?}"),
                };
                assert_eq!(found, *wanted, "{name}");
            }
            rows += 1;
        }
        assert_eq!(rows, set.records.len());
    }
}
