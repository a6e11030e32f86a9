//! Files that are damaged, cut, mixed or not what they should be. Whole files are refused with a reason; single rows are
//! rejected by number, and the rest goes on.

use crate::common;

use crate::common::builder::{header, row, second};
use crate::common::{codes, diagnostic, ingest_bytes, paper};
use proptest::prelude::*;
use recrash_model::record::{Coded, Edition, MPS_PER_MPH, OfVehicles, RecordSet, RejectReason};
use recrash_model::surroundings::{Surface, Weather};
use recrash_model::template::Movement;
use recrash_model::{Outcome, Severity};
use recrash_records::{IngestError, SAMPLE_CSV, SourceText, ingest};

fn error(bytes: &[u8]) -> IngestError {
    ingest(&[SourceText { name: "bad.csv", bytes }], &paper()).expect_err("a file that cannot be read")
}

fn malformed(set: &RecordSet) -> Vec<u64> {
    set.rejects.iter().filter(|reject| reject.reason == RejectReason::Malformed).map(|reject| reject.row).collect()
}

fn ids(set: &RecordSet) -> Vec<String> {
    set.records.iter().map(|record| record.id.to_string()).collect()
}

fn plain(id: &str) -> String {
    row(Edition::Second, id, &[])
}

#[test]
fn whole_files_are_refused_with_name_expectation_and_remedy() {
    let header_only = header(Edition::Second) + "\n";
    let no_narrative = second(&[plain("1-1")]).replacen(",Narrative,", ",Story,", 1);
    let cases: &[(&[u8], &[&str])] = &[
        (b"", &["empty"]),
        (b"\xef\xbb\xbf \r\n", &["empty"]),
        (header_only.as_bytes(), &["header", "second edition", "no data row"]),
        (b"PK\x03\x04....", &["ZIP archive or an Excel workbook", "save the sheet as CSV"]),
        (b"%PDF-1.7", &["PDF", "data dictionary"]),
        (b"\x1f\x8b\x08", &["gzip"]),
        (b"<!DOCTYPE html><html>", &["web page", "download"]),
        (b"Report ID\x00\x01\x02", &["binary"]),
        (b"just some words\nand more\n", &["not the header", "just some words", "Report ID"]),
        (b"id;speed;weather\n1;2;3\n", &["not the header"]),
        (no_narrative.as_bytes(), &["second edition", "lacks the column \"Narrative\"", "as published"]),
    ];
    for (bytes, wanted) in cases {
        let message = error(bytes).to_string();
        assert!(message.starts_with("bad.csv: "), "{message}");
        for words in *wanted {
            assert!(message.contains(words), "{words:?} is not in: {message}");
        }
    }
    assert_eq!(ingest(&[], &paper()).unwrap_err(), IngestError::NoFiles);
}

#[test]
fn utf_16_is_read_with_a_mark_and_without_one() {
    let text = second(&[row(Edition::Second, "1-1", &[("Narrative", "Caf\u{e9} on \u{416} Street.")]), plain("1-2")]);
    let expected = ingest_bytes(text.as_bytes()).value;
    assert_eq!(expected.records.len(), 2);
    for mark in ["", "\u{feff}"] {
        let units: Vec<u16> = format!("{mark}{text}").encode_utf16().collect();
        let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        for bytes in [little, big] {
            let set = ingest_bytes(&bytes).value;
            assert_eq!(set.rejects, expected.rejects);
            assert_eq!(set.records, expected.records);
        }
    }
}

#[test]
fn a_version_may_be_written_as_a_data_frame_writes_whole_numbers() {
    let version = |text: &str| row(Edition::Second, "1-1", &[("Report Version", text)]);
    let set = ingest_bytes(
        second(&[version("1.0"), version("2.00"), version("3.5"), version("4."), version(".0")]).as_bytes(),
    );
    assert_eq!(ids(&set.value), ["1-1/1", "1-1/2"]);
    assert_eq!(malformed(&set.value), [3, 4, 5]);
}

#[test]
fn missing_columns_are_all_named_with_the_edition() {
    let text =
        header(Edition::Third).replace("Roadway Type", "Kind").replace("Roadway-Work Zone", "Cones") + "\n1-1,1\n";
    match error(text.as_bytes()) {
        IngestError::MissingColumns { edition, missing, .. } => {
            assert!(edition.starts_with("third edition"), "{edition}");
            assert_eq!(missing, ["Roadway Type", "Roadway-Work Zone"]);
        }
        other => panic!("{other}"),
    }
}

#[test]
fn rows_with_too_many_or_too_few_fields_are_rejected_by_number_and_line() {
    let long = plain("1-2") + ",one more";
    let text = second(&[plain("1-1"), long, plain("1-3"), "1-4,1,x".to_owned(), plain("1-5")]);
    let outcome = ingest_bytes(text.as_bytes());
    assert_eq!(ids(&outcome.value), ["1-1/1", "1-3/1", "1-5/1"]);
    assert_eq!(malformed(&outcome.value), [2, 4]);
    assert_eq!(codes(&outcome.diagnostics), ["records.malformed-row"; 2]);
    assert_eq!(outcome.diagnostics[0].message, "too many fields: 138 instead of 137");
    assert_eq!(outcome.diagnostics[1].message, "too few fields: 3 instead of 137");
    assert_eq!((outcome.diagnostics[0].location.row, outcome.diagnostics[0].location.line), (Some(2), Some(3)));
    assert_eq!((outcome.diagnostics[1].location.row, outcome.diagnostics[1].location.line), (Some(4), Some(5)));
    let second_reject = &outcome.value.rejects[1];
    assert_eq!(second_reject.record.as_ref().map(ToString::to_string).as_deref(), Some("1-4/1"));
    let steps: Vec<usize> = outcome.value.funnel.iter().map(|step| step.remaining).collect();
    assert_eq!(steps, [5, 3, 3, 3]);
}

#[test]
fn a_file_cut_inside_a_quoted_field_loses_its_last_row_only() {
    let cut = |narrative: &str| second(&[plain("1-1"), row(Edition::Second, "1-2", &[("Narrative", narrative)])]);
    let whole = cut("First, it stopped.\nThen, it went.");
    for end in ["it stopped.", "Then, it", "First"] {
        let text = &whole[..whole.find(end).unwrap() + end.len()];
        let outcome = ingest_bytes(text.as_bytes());
        assert_eq!(ids(&outcome.value), ["1-1/1"], "{end}");
        assert_eq!(malformed(&outcome.value), [2], "{end}");
        assert!(diagnostic(&outcome, "records.malformed-row").message.contains("inside a quoted field"));
    }
    assert_eq!(ids(&ingest_bytes(whole.as_bytes()).value), ["1-1/1", "1-2/1"]);
    assert_eq!(ids(&ingest_bytes(whole.trim_end().as_bytes()).value), ["1-1/1", "1-2/1"], "no last line end");
}

#[test]
fn an_unclosed_quote_takes_one_row_and_not_those_below() {
    let broken = plain("1-2").replace("Northlight Robotics", "\"Northlight Robotics");
    let quoted = row(Edition::Second, "1-4", &[("Narrative", "It slowed, then stopped.")]);
    let text = second(&[plain("1-1"), broken, plain("1-3"), quoted, plain("1-5")]);
    let outcome = ingest_bytes(text.as_bytes());
    assert_eq!(ids(&outcome.value), ["1-1/1", "1-3/1", "1-4/1", "1-5/1"]);
    assert_eq!(malformed(&outcome.value), [2]);
    assert_eq!(outcome.value.records[1].provenance.row, 3);
    assert_eq!(outcome.value.usable.len() + outcome.value.rejects.len(), 5);
}

#[test]
fn a_file_in_which_every_line_swallows_the_rest_ends_in_bounded_time() {
    // Read from outside a quoted field or from inside one, this line ends inside one.
    let text = second(&vec!["1-1,1,a\",\"".to_owned(); 20_000]);
    let outcome = ingest_bytes(text.as_bytes());
    assert!(malformed(&outcome.value).len() < 100, "{} rows", malformed(&outcome.value).len());
    assert_eq!(diagnostic(&outcome, "records.quotes-broken").severity, Severity::Error);
    assert_adds_up(&outcome.value);
}

#[test]
fn rows_without_an_id_or_a_version_are_no_records() {
    let no_id = row(Edition::Second, " ", &[]);
    let no_version = row(Edition::Second, "1-2", &[("Report Version", "two")]);
    let outcome = ingest_bytes(second(&[no_id, no_version, plain("1-3")]).as_bytes());
    assert_eq!(malformed(&outcome.value), [1, 2]);
    assert_eq!(ids(&outcome.value), ["1-3/1"]);
}

#[test]
fn a_thousand_malformed_rows_are_all_rejected_and_told_in_short() {
    let rows: Vec<String> = (0..1000).map(|i| format!("1-{i},1")).chain([plain("2-1")]).collect();
    let outcome = ingest_bytes(second(&rows).as_bytes());
    assert_eq!(malformed(&outcome.value).len(), 1000);
    assert_eq!(outcome.diagnostics.len(), 101);
    assert!(outcome.diagnostics[100].message.starts_with("900 more rows"));
}

#[test]
fn two_editions_in_one_file_are_read_each_by_its_header() {
    let third = row(Edition::Third, "2-1", &[("Roadway-Work Zone", "Y"), ("Roadway-Wet Surface Condition", "Y")]);
    let text = second(&[plain("1-1"), plain("1-2")]) + &header(Edition::Third) + "\n" + &third + "\n";
    let outcome = ingest_bytes(text.as_bytes());
    let set = &outcome.value;
    assert_eq!(ids(set), ["1-1/1", "1-2/1", "2-1/1"]);
    let parts: Vec<_> = set.files.iter().map(|part| (part.edition, part.rows)).collect();
    assert_eq!(parts, [(Edition::Second, 2), (Edition::Third, 1)]);
    let last = &set.records[2];
    assert_eq!((last.provenance.edition, last.provenance.row), (Edition::Third, 3));
    assert_eq!((last.work_zone, last.surface, last.lighting), (true, Some(Surface::Wet), None));
    assert_eq!(diagnostic(&outcome, "records.second-header").location.line, Some(4));
}

#[test]
fn the_same_edition_twice_in_one_file_stays_one_part() {
    let text = second(&[plain("1-1")]) + &second(&[plain("1-2")]);
    let outcome = ingest_bytes(text.as_bytes());
    assert_eq!(outcome.value.files.len(), 1);
    assert_eq!(ids(&outcome.value), ["1-1/1", "1-2/1"]);
    assert_eq!(codes(&outcome.diagnostics), ["records.second-header"]);
}

#[test]
fn headers_are_bounded_in_width_and_number() {
    let wide = header(Edition::Second) + &",x".repeat(2000) + "\n";
    assert!(matches!(error(wide.as_bytes()), IngestError::UnknownHeader { .. }));
    let outcome = ingest_bytes(second(&[plain("1-1")]).repeat(150).as_bytes());
    assert_eq!((malformed(&outcome.value).len(), outcome.value.records.len()), (50, 150));
}

#[test]
fn every_edition_is_recognised_by_its_header() {
    for (edition, width) in [(Edition::First, 122), (Edition::Second, 137), (Edition::Third, 116)] {
        let severity =
            if edition == Edition::First { "Highest Injury Severity" } else { "Highest Injury Severity Alleged" };
        let changes = [("Weather - Rain", "Y"), (severity, "Minor"), ("Incident Date", "JUN-2023")];
        let text = header(edition) + "\n" + &row(edition, "1-1", &changes) + "\n";
        let outcome = ingest_bytes(text.as_bytes());
        assert_eq!(header(edition).split(',').count(), width);
        assert_eq!(outcome.value.files[0].edition, edition);
        assert_eq!(outcome.diagnostics, [], "{edition:?}");
        let record = &outcome.value.records[0];
        assert_eq!(record.sv_movement, Coded::Known(Movement::LeftTurn));
        assert_eq!(record.weather, [Weather::Rain]);
        assert_eq!(record.severity, Coded::Known(recrash_model::record::Severity::Minor));
        assert_eq!(record.when.unwrap().to_string(), "2023-06");
        assert_eq!(record.sv_speed_mps, Some(10.0 * MPS_PER_MPH));
        assert_eq!(outcome.value.usable, [0]);
    }
}

#[test]
fn whose_vehicle_was_towed_is_read_of_every_edition() {
    let read = |edition: Edition, changes: &[(&str, &str)]| {
        let text = header(edition) + "\n" + &row(edition, "1-1", changes) + "\n";
        let outcome = ingest_bytes(text.as_bytes());
        let record = &outcome.value.records[0];
        ([record.towed, record.airbags], outcome.diagnostics.len())
    };
    let of = |sv, cp| OfVehicles { sv, cp };
    let unknown = of(None, None);
    for edition in [Edition::First, Edition::Second] {
        let changes = [
            ("SV Was Vehicle Towed?", "Yes"),
            ("CP Was Vehicle Towed?", "Not Applicable"),
            ("SV Any Air Bags Deployed?", "No"),
            ("CP Any Air Bags Deployed?", "Unknown"),
        ];
        assert_eq!(read(edition, &changes), ([of(Some(true), Some(false)), of(Some(false), None)], 0), "{edition:?}");
        assert_eq!(read(edition, &[]), ([unknown; 2], 0), "{edition:?}");
    }
    let changes = [
        ("Was Any Vehicle Towed?", "Yes Subject Vehicle, Unknown Crash Partner"),
        ("Any Air Bags Deployed?", "No Subject Vehicle, No Crash Partner"),
    ];
    assert_eq!(read(Edition::Third, &changes), ([of(Some(true), None), of(Some(false), Some(false))], 0));
    assert_eq!(read(Edition::Third, &[("Was Any Vehicle Towed?", "Perhaps")]).1, 1);
    // A vehicle that was towed is one, whatever is not known of the other.
    assert_eq!(
        [of(Some(true), None).any(), of(Some(false), None).any(), of(Some(false), Some(false)).any()],
        [Some(true), None, Some(false)]
    );
}

#[test]
fn line_ends_marks_and_encodings_do_not_matter() {
    let narrative = "The AV waited.\nAn SUV, \"late\", turned at Pe\u{f1}a Street.";
    let text = second(&[plain("1-1"), row(Edition::Second, "1-2", &[("Narrative", narrative)])]);
    let read = |bytes: &[u8]| {
        let Outcome { value, diagnostics } = ingest_bytes(bytes);
        let narratives: Vec<String> = value.records.iter().map(|record| record.narrative.clone()).collect();
        (narratives, diagnostics)
    };
    let (plain_text, remarks) = read(text.as_bytes());
    assert_eq!((plain_text.last().map(String::as_str), remarks.len()), (Some(narrative), 0));

    // CRLF between rows, a bare line feed inside the narrative.
    let crlf = text.replace('\n', "\r\n").replace("waited.\r\n", "waited.\n");
    assert_eq!(read(crlf.as_bytes()), (plain_text.clone(), vec![]));
    let mark = [b"\xef\xbb\xbf", text.as_bytes()].concat();
    assert_eq!(read(&mark), (plain_text.clone(), vec![]));
    let utf16: Vec<u8> = [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    assert_eq!(read(&utf16), (plain_text.clone(), vec![]));

    let windows_1252: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect();
    let (narratives, remarks) = read(&windows_1252);
    assert_eq!(narratives, plain_text);
    assert_eq!(codes(&remarks), ["records.encoding"]);
    let twice: String = text.bytes().map(char::from).collect();
    let (narratives, remarks) = read(twice.as_bytes());
    assert_eq!(narratives, plain_text);
    assert_eq!(codes(&remarks), ["records.encoded-twice"]);
}

#[test]
fn letter_case_blanks_and_other_delimiters_do_not_matter() {
    let text =
        second(&[row(Edition::Second, "1-1", &[("Roadway Type", "  INTERSECTION "), ("SV Contact Area - Left", "y")])]);
    let (head, body) = text.split_once('\n').unwrap();
    let shouted = head.to_uppercase().replace(',', " , ").replace(" - ", "  -  ");
    let outcome = ingest_bytes(format!("{shouted}\n{body}").as_bytes());
    assert_eq!((outcome.value.usable.len(), outcome.diagnostics.len()), (1, 0), "{:?}", outcome.diagnostics);
    assert_eq!(outcome.value.records[0].sv_zones.len(), 1);
    for delimiter in [";", "\t"] {
        assert_eq!(ingest_bytes(text.replace(',', delimiter).as_bytes()).value.usable, [0]);
    }
}

#[test]
fn unknown_repeated_and_missing_columns_are_told() {
    let text = second(&[plain("1-1")]).replacen("Mileage,", "Odometer,", 1).replacen("Lighting,", "City,", 1);
    let outcome = ingest_bytes(text.as_bytes());
    let unknown = diagnostic(&outcome, "records.unknown-column");
    assert_eq!(unknown.severity, Severity::Note);
    assert!(unknown.message.contains("\"Odometer\""));
    assert!(diagnostic(&outcome, "records.repeated-column").message.contains("\"City\""));
    assert!(diagnostic(&outcome, "records.missing-column").message.contains("\"Lighting\""));
    assert_eq!(outcome.value.usable, [0]);
}

#[test]
fn unknown_codes_stay_as_text_and_are_listed_with_counts() {
    let bridge = |id: &str| row(Edition::Second, id, &[("Roadway Type", "Bridge")]);
    let outcome = ingest_bytes(second(&[bridge("1-1"), plain("1-2"), bridge("1-3")]).as_bytes());
    assert_eq!(outcome.value.records[0].road, Coded::Unlisted("Bridge".to_owned()));
    let remark = diagnostic(&outcome, "records.unlisted-code");
    assert_eq!(remark.location.column.as_deref(), Some("Roadway Type"));
    assert!(remark.message.contains("\"Bridge\" x 2 (first in row 1)"), "{remark}");
    assert_eq!(outcome.value.usable, [1]);
    assert_eq!(outcome.value.rejects[0].reason, RejectReason::RoadNotExpressible);
}

#[test]
fn unreadable_cells_are_empty_and_told() {
    let odd = [("SV Precrash Speed (MPH)", "fast"), ("Incident Time (24:00)", "25:00"), ("Incident Date", "soon")];
    let outcome = ingest_bytes(second(&[row(Edition::Second, "1-1", &odd)]).as_bytes());
    assert_eq!(codes(&outcome.diagnostics), ["records.unreadable-cell"; 3]);
    let record = &outcome.value.records[0];
    assert_eq!((record.sv_speed_mps, record.time_of_day_min, record.when), (None, None, None));
}

#[test]
fn a_speed_marked_unknown_is_unknown() {
    let cells = [("SV Precrash Speed (MPH)", "0"), ("SV Pre-crash Speed - Unknown", "Y")];
    let outcome = ingest_bytes(second(&[row(Edition::Second, "1-1", &cells)]).as_bytes());
    assert_eq!(outcome.value.records[0].sv_speed_mps, None);
}

#[test]
fn the_same_content_twice_counts_once() {
    let text = second(&[plain("1-1")]);
    let file = |name| SourceText { name, bytes: text.as_bytes() };
    let outcome = ingest(&[file("a.csv"), file("b.csv")], &paper()).unwrap();
    assert_eq!(ids(&outcome.value), ["1-1/1"]);
    assert_eq!(diagnostic(&outcome, "records.same-file").location.file.as_deref(), Some("b.csv"));
}

#[test]
fn a_stray_zero_byte_in_a_narrative_costs_nothing() {
    let text = second(&[row(Edition::Second, "1-1", &[("Narrative", "It \0 stopped.")])]);
    assert_eq!(ingest_bytes(text.as_bytes()).value.usable, [0]);
}

#[test]
fn rejects_come_in_the_order_of_files_and_rows() {
    let empty = |id: &str| row(Edition::Second, id, &[("Narrative", "")]);
    let first = second(&[empty("1-1"), "1-2,1".to_owned(), empty("1-3")]);
    let other = second(&[empty("2-1"), plain("2-2")]);
    let files =
        [SourceText { name: "z.csv", bytes: first.as_bytes() }, SourceText { name: "a.csv", bytes: other.as_bytes() }];
    let set = ingest(&files, &paper()).unwrap().value;
    let order: Vec<_> = set.rejects.iter().map(|reject| (reject.file.as_str(), reject.row)).collect();
    assert_eq!(order, [("z.csv", 1), ("z.csv", 2), ("z.csv", 3), ("a.csv", 1)]);
}

/// Every row in is usable or rejected, and positions are valid.
fn assert_adds_up(set: &RecordSet) {
    let rows: usize = set.files.iter().map(|part| part.rows).sum();
    assert_eq!(rows, set.usable.len() + set.rejects.len());
    assert!(set.usable.iter().all(|&i| i < set.records.len()));
    assert_eq!(set.funnel[0].remaining, rows);
    assert_eq!(set.funnel.last().unwrap().remaining, set.usable.len());
    let lost: usize = set.funnel.iter().flat_map(|step| &step.lost).map(|(_, count)| count).sum();
    assert_eq!(lost, set.rejects.len());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let below_header = [header(Edition::Third).as_bytes(), b"\n", &bytes].concat();
        for content in [bytes, below_header] {
            if let Ok(outcome) = ingest(&[SourceText { name: "random", bytes: &content }], &paper()) {
                assert_adds_up(&outcome.value);
            }
        }
    }

    #[test]
    fn a_damaged_sample_never_panics_and_adds_up(
        at in proptest::collection::vec((0..SAMPLE_CSV.len(), prop::sample::select(b"\",\n\r;\x00\xff7Y".to_vec())), 1..30),
        length in 2000..40_000usize,
    ) {
        let mut bytes = SAMPLE_CSV.as_bytes()[..length].to_vec();
        for (position, byte) in at {
            let position = position % length;
            bytes[position] = byte;
        }
        for profile in [paper(), common::one_per_incident()] {
            if let Ok(outcome) = ingest(&[SourceText { name: "damaged", bytes: &bytes }], &profile) {
                assert_adds_up(&outcome.value);
            }
        }
    }
}
