//! Mapping files: another database as records, and what is said of a mapping that does not fit.

use crate::common::paper;
use recrash_model::kinds::PartnerKind;
use recrash_model::record::{Coded, Edition, RejectReason, Severity};
use recrash_model::surroundings::{Lighting, Surface, Weather};
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone;
use recrash_records::{IngestError, IngestOptions, Mapping, SourceText, ingest_with};

const CRSS: &str = include_str!("../../../../docs/mappings/crss.toml");

/// Four crashes of our own making, in the columns of CRSS.
const ACCIDENT: &str = "\
CASENUM,YEAR,MONTH,HOUR,MINUTE,RELJCT2,WRK_ZONE,LGT_COND,WEATHER,MAX_SEV,EXTRA
101,2022,6,7,5,2,0,1,1,2,x
102,2022,12,99,99,18,1,3,2,0,x
103,2022,3,23,59,1,0,2,77,9,x
104,2022,3
";
const VEHICLE: &str = "\
CASENUM,VEH_NO,BODY_TYP,P_CRASH1,TRAV_SP,VSPD_LIM,VSURCOND,IMPACT1
101,1,4,11,15,35,1,12
101,2,14,1,30,35,1,9
102,1,4,1,55,60,2,6
102,2,66,3,998,60,2,12
103,1,4,99,999,99,1,0
";

fn files<'a>(accident: &'a str, vehicle: &'a str) -> [SourceText<'a>; 2] {
    [
        SourceText { name: "accident.csv", bytes: accident.as_bytes() },
        SourceText { name: "VEHICLE.CSV", bytes: vehicle.as_bytes() },
    ]
}

#[test]
fn crss_tables_become_records() {
    let mapping = Mapping::parse(CRSS, "crss.toml").unwrap_or_else(|error| panic!("{error}"));
    let options = IngestOptions { filter: None, mapping: Some(&mapping) };
    let set = ingest_with(&files(ACCIDENT, VEHICLE), &paper(), &options).unwrap().value;
    assert_eq!(set.records.len(), 3);
    assert_eq!(set.usable, [0, 1]);
    assert_eq!(
        set.rejects.iter().map(|r| (r.row, r.reason)).collect::<Vec<_>>(),
        [(3, RejectReason::MovementNotExpressible), (4, RejectReason::Malformed)]
    );
    let sources: Vec<_> = set.files.iter().map(|f| (f.name.as_str(), f.edition, f.rows)).collect();
    assert_eq!(sources, [("accident.csv", Edition::Mapped, 4), ("VEHICLE.CSV", Edition::Mapped, 0)]);

    let first = &set.records[0];
    assert_eq!(first.id.to_string(), "101/1");
    assert_eq!((first.road.clone(), first.work_zone), (Coded::Known(RoadType::Intersection), false));
    assert_eq!(first.sv_movement, Coded::Known(Movement::LeftTurn));
    assert_eq!(first.cp_movement, Coded::Known(Movement::Straight));
    assert_eq!(first.partner, Coded::Known(PartnerKind::Suv));
    assert_eq!(first.severity, Coded::Known(Severity::Minor));
    assert_eq!((first.surface, first.lighting), (Some(Surface::Dry), Some(Lighting::Daylight)));
    assert_eq!((first.sv_zones[0], first.cp_zones[0]), (ContactZone::Front, ContactZone::Left));
    assert_eq!((first.when.unwrap().to_string().as_str(), first.time_of_day_min), ("2022-06", Some(425)));
    assert_eq!(first.sv_speed_mps, Some(15.0 * 0.44704));
    assert!(first.narrative.starts_with("Vehicle 1 was moving: left turn. Vehicle 2, a suv,"), "{}", first.narrative);

    let second = &set.records[1];
    assert_eq!((second.road.clone(), second.work_zone), (Coded::Known(RoadType::Highway), true));
    assert_eq!((second.time_of_day_min, &second.weather[..]), (None, &[Weather::Rain][..]));
    // Crash 103 has no second vehicle.
    let third = &set.records[2];
    assert_eq!((third.sv_movement.clone(), third.partner.clone()), (Coded::Unknown, Coded::Other));
    assert_eq!((third.sv_speed_mps, third.posted_speed_mps), (None, None));
}

#[test]
fn one_flat_table_needs_no_names_and_codes_without_a_value_are_listed() {
    let mapping = "format = \"recrash.mapping/1\"\nname = \"flat\"\n[fields]\n\
        report = { column = \"id\" }\ndate = { column = \"day\" }\nroad = { column = \"road\" }\n\
        sv_movement = { column = \"a\" }\ncp_movement = { column = \"b\" }\nnarrative = { column = \"what\" }\n\
        sv_speed = { column = \"v\", unit = \"km/h\" }\n";
    let mapping = Mapping::parse(mapping, "flat.toml").unwrap();
    let csv = "id;day;road;a;b;what;v\n7;2024-06-13;intersection;straight;left_turn;It went.;36\n8;soon;Bridge;;other;;fast\n";
    let options = IngestOptions { filter: None, mapping: Some(&mapping) };
    let outcome = ingest_with(&[SourceText { name: "any.csv", bytes: csv.as_bytes() }], &paper(), &options).unwrap();
    let set = outcome.value;
    assert_eq!(set.usable, [0]);
    assert_eq!(set.records[0].sv_speed_mps, Some(10.0));
    assert_eq!(set.records[0].when.unwrap().to_string(), "2024-06");
    assert_eq!(set.records[1].road, Coded::Unlisted("Bridge".into()));
    assert_eq!((set.records[1].sv_movement.clone(), set.records[1].cp_movement.clone()), (Coded::Blank, Coded::Other));
    let told: Vec<_> = outcome.diagnostics.iter().filter_map(|d| d.location.column.as_deref()).collect();
    assert_eq!(told, ["road", "date", "sv_speed"]);
}

#[test]
fn a_mapping_that_is_wrong_names_file_line_and_key() {
    let cases = [
        ("format = \"recrash.mapping/1\"", "format = \"recrash.mapping/9\"", Some(5), "format", "recrash.mapping/1"),
        ("[fields.road]", "[fields.raod]", None, "fields.raod", "`road`"),
        ("\"2\" = \"intersection\"", "\"2\" = \"crossing\"", None, "fields.road.values.2", "traffic_circle"),
        ("year = { column", "year = { colum", None, "", "colum"),
        ("\"sv.VSURCOND\"", "\"xx.VSURCOND\"", None, "fields.surface.column", "[join.xx]"),
        ("unit = \"mph\", values = { \"0\"", "values = { \"0\"", None, "fields.posted_speed", "needs its unit"),
        ("unit = \"mph\", values = { \"0\"", "unit = \"knots\", values = { \"0\"", None, "", "knots"),
        ("{sv_zones}", "{sv_zone}", None, "fields.narrative.text", "{sv_zone}"),
        ("{sv_zones}", "{narrative}", None, "fields.narrative.text", "{narrative}"),
        ("at its {cp_zones}", "at its {cp_zones", None, "fields.narrative.text", "never closed"),
        ("file = \"accident.csv\"", "", None, "file", "needs its name"),
        ("report = {", "version = {", None, "fields.report", "no rule fills it"),
        ("name = \"NHTSA CRSS\"", "name = NHTSA", Some(6), "", ""),
    ];
    for (from, to, line, key, words) in cases {
        assert!(CRSS.contains(from), "{from}");
        let error = Mapping::parse(&CRSS.replacen(from, to, 1), "my.toml").expect_err(to);
        assert_eq!((error.file.as_str(), error.key.as_str()), ("my.toml", key), "{to}: {error}");
        assert!(error.message.contains(words), "{to}: {error}");
        if let Some(line) = line {
            assert_eq!(error.line, Some(line), "{to}: {error}");
        }
        let changed = CRSS.lines().position(|text| text.contains(from)).unwrap() + 1;
        let about_a_line = !to.is_empty() && !key.is_empty() && key != "fields.report";
        assert!(!about_a_line || error.line.is_some_and(|line| line.abs_diff(changed) <= 1), "{changed}: {error}");
    }
    assert!(Mapping::parse(&"#".repeat(2 << 20), "long.toml").is_err());
}

#[test]
fn a_mapping_that_does_not_fit_the_files_names_what_is_missing() {
    let mapping = Mapping::parse(CRSS, "crss.toml").unwrap();
    let options = IngestOptions { filter: None, mapping: Some(&mapping) };
    let error = |files: &[SourceText<'_>]| match ingest_with(files, &paper(), &options) {
        Err(IngestError::Mapping(error)) => error,
        other => panic!("{other:?}"),
    };
    let no_vehicle = error(&files(ACCIDENT, VEHICLE)[..1]);
    assert_eq!(no_vehicle.key, "join.cp.file");
    assert!(no_vehicle.message.contains("vehicle.csv") && no_vehicle.message.contains("accident.csv"), "{no_vehicle}");
    let no_accident = error(&files(ACCIDENT, VEHICLE)[1..]);
    assert!(no_accident.message.contains("accident.csv"), "{no_accident}");
    let renamed = ACCIDENT.replacen("RELJCT2", "JUNCTION", 1);
    let no_column = error(&files(&renamed, VEHICLE));
    assert_eq!((no_column.key.as_str(), no_column.line.is_some()), ("fields.road.column", true));
    assert!(no_column.message.contains("RELJCT2") && no_column.message.contains("JUNCTION"), "{no_column}");
    let no_key = error(&files(ACCIDENT, &VEHICLE.replacen("CASENUM", "CASE", 1)));
    assert_eq!(no_key.key, "join.cp.on");
}
