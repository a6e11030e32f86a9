//! `recrash records` and `recrash fetch`, as a user of them meets them.

use crate::common::Place;
use recrash_records::SAMPLE_CSV;
use std::collections::BTreeSet;
use std::io::{Read, Write};
use std::net::TcpListener;
use std::path::Path;

#[test]
fn the_funnel_and_the_distributions_are_shown_on_a_screen() {
    let place = Place::new();
    let (code, shown, remarks) = place.run(&["records"]);
    assert_eq!(code, 0, "{remarks}");
    for words in ["From rows to usable records", "Distributions", "entity", "road", "intersection", "severity", "month"]
    {
        assert!(shown.contains(words), "{words}:\n{shown}");
    }
    assert!(shown.lines().count() + remarks.lines().count() < 50, "{shown}{remarks}");
}

#[test]
fn nothing_is_written_but_what_was_asked_for() {
    let place = Place::new();
    place.records(&[]);
    assert_eq!(files_of(place.folder()), [] as [&str; 0]);
    place.records(&["--csv", "a.csv", "--out", "s"]);
    assert_eq!(files_of(place.folder()), ["a.csv", "s"]);
    assert_eq!(
        files_of(&place.path("s")),
        ["1-records.diagnostics.json", "1-records.json", "suite.json", "units.jsonl"]
    );
}

#[test]
fn the_counts_are_shown_to_add_up() {
    let place = Place::new();
    let header = SAMPLE_CSV.lines().next().unwrap();
    std::fs::write(place.path("cut.csv"), format!("{SAMPLE_CSV}90-1,1,\"It was")).unwrap();
    std::fs::write(place.path("long.csv"), format!("{SAMPLE_CSV}90-1,1{}\n", ",".repeat(141))).unwrap();
    std::fs::write(place.path("twice.csv"), format!("{SAMPLE_CSV}{header}\n90-1,1,short\n")).unwrap();
    for (file, told) in [
        ("cut.csv", "row 452, line 751: the file ends inside a quoted field"),
        ("long.csv", "row 452, line 751: too many fields: 143 instead of 137"),
        ("twice.csv", "row 452, line 752: too few fields: 3 instead of 137"),
    ] {
        let (code, shown, remarks) = place.run(&["records", file]);
        assert_eq!(code, 0, "{remarks}");
        assert!(shown.contains("452 rows = 88 usable + 364 rejected + 0 merged"), "{shown}");
        assert!(remarks.contains(told), "{told}:\n{remarks}");
    }
    let (_, shown, _) = place.run(&["records", "--dedupe", "incident"]);
    let line = shown.lines().find(|line| line.contains(" merged")).unwrap();
    let sum = shown.lines().find(|line| line.contains(" rows = ")).unwrap();
    let merged: String = line.chars().skip_while(|c| !c.is_ascii_digit()).collect();
    assert!(merged.contains("merged into another") && !sum.contains("+ 0 merged"), "{shown}");
}

#[test]
fn rows_that_share_id_and_version_and_differ_are_told() {
    let place = Place::new();
    let mut table = csv::Reader::from_reader(SAMPLE_CSV.as_bytes());
    let mut file = csv::Writer::from_path(place.path("one-id.csv")).unwrap();
    file.write_record(table.headers().unwrap()).unwrap();
    for row in table.records().map(Result::unwrap) {
        let same = ["90999-1", "1"].into_iter().chain(row.iter().skip(2));
        file.write_record(same).unwrap();
    }
    file.flush().unwrap();
    for profile in ["paper", "open"] {
        let (code, _, remarks) = place.run(&["records", "one-id.csv", "--profile", profile]);
        assert_eq!(code, 0, "{remarks}");
        let told = "451 rows share report id and version with another one and differ; the first: 90999-1/1 in row 1 of one-id.csv";
        assert!(remarks.contains(told) && remarks.contains("records.same-id"), "{remarks}");
    }
    let (_, _, remarks) = place.run(&["records"]);
    assert!(!remarks.contains("records.same-id"), "{remarks}");
}

#[test]
fn tables_hold_the_usable_records_or_all() {
    let place = Place::new();
    let usable = place.records(&["--csv", "usable.csv"])["usable"].as_u64().unwrap();
    place.records(&["--csv", "all.csv", "--all"]);
    let rows = |name: &str| {
        let bytes = std::fs::read(place.path(name)).unwrap();
        csv::Reader::from_reader(bytes.as_slice()).into_records().filter(|row| row.is_ok()).count() as u64
    };
    assert_eq!((usable, rows("usable.csv"), rows("all.csv")), (88, 88, 451));
    let (code, _, error) = place.run(&["records", "--csv", "no/such/folder/x.csv"]);
    assert_eq!(code, 1, "{error}");
    assert!(error.contains("no/such/folder"), "{error}");
}

/// Accounts name an incident by the first of its reports, and so do records: also of a later version without the file's own id.
#[test]
fn records_and_accounts_are_joined_by_their_incident() {
    let place = Place::new();
    let mut sample = csv::Reader::from_reader(SAMPLE_CSV.as_bytes());
    let header = sample.headers().unwrap().clone();
    let at = |name: &str| header.iter().position(|other| other == name).unwrap();
    let mut written = csv::Writer::from_path(place.path("crashes.csv")).unwrap();
    written.write_record(&header).unwrap();
    for row in sample.records().map(|row| row.unwrap()) {
        written.write_record(&row).unwrap();
        let later = row.iter().enumerate().map(|(column, cell)| match column {
            column if column == at("Report Version") => "9",
            column if column == at("Same Incident ID") => "",
            _ => cell,
        });
        written.write_record(later).unwrap();
    }
    written.flush().unwrap();
    place.records(&["crashes.csv", "--csv", "records.csv", "--all"]);
    assert_eq!(place.run(&["read", "crashes.csv", "--csv", "accounts.csv"]).0, 0);
    let rows = |name: &str, columns: [&str; 3]| -> BTreeSet<[String; 3]> {
        let mut table = csv::Reader::from_path(place.path(name)).unwrap();
        let header = table.headers().unwrap().clone();
        let at = columns.map(|column| header.iter().position(|other| other == column).unwrap());
        table.records().map(|row| row.unwrap()).map(|row| at.map(|at| row[at].to_owned())).collect()
    };
    let accounts = rows("accounts.csv", ["incident", "report", "version"]);
    let records = rows("records.csv", ["incident", "report", "version"]);
    assert!(accounts.len() > 300 && accounts.is_subset(&records), "{:?}", accounts.difference(&records).next());
    assert!(!accounts.is_subset(&rows("records.csv", ["same_incident_id", "report", "version"])));
}

#[cfg(feature = "parquet")]
#[test]
fn a_parquet_table_is_one() {
    let place = Place::new();
    place.records(&["--parquet", "usable.parquet"]);
    let bytes = std::fs::read(place.path("usable.parquet")).unwrap();
    assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
}

#[test]
fn two_files_of_one_name_are_told_apart() {
    let place = Place::new();
    for (folder, id) in [("2024", "9010"), ("2025", "9110")] {
        std::fs::create_dir(place.path(folder)).unwrap();
        std::fs::write(place.path(folder).join("ads.csv"), SAMPLE_CSV.replace("\n9010", &format!("\n{id}"))).unwrap();
    }
    let told = place.records(&["2024/ads.csv", "2025/ads.csv", "--csv", "all.csv", "--all"]);
    let names: Vec<&str> = told["files"].as_array().unwrap().iter().filter_map(|file| file["name"].as_str()).collect();
    assert_eq!(names, ["2024/ads.csv", "2025/ads.csv"]);
    let mut table = csv::Reader::from_path(place.path("all.csv")).unwrap();
    let at = table.headers().unwrap().iter().position(|name| name == "file").unwrap();
    let files: BTreeSet<String> = table.records().map(|row| row.unwrap()[at].to_owned()).collect();
    assert_eq!(files, BTreeSet::from(["2024/ads.csv".to_owned(), "2025/ads.csv".to_owned()]));
    let alone = place.records(&["2024/ads.csv"]);
    assert_eq!(alone["files"][0]["name"], "ads.csv");
}

#[test]
fn a_filter_narrows_the_records_and_stays_with_the_suite() {
    let place = Place::new();
    let all = place.records(&[])["usable"].as_u64().unwrap();
    let filter = ["--where", "road = highway or severity >= moderate", "--out", "s"];
    let some = place.records(&filter)["usable"].as_u64().unwrap();
    assert!(0 < some && some < all, "{some} of {all}");
    let saved = place.records(&["--out", "s"]);
    assert_eq!(saved["usable"].as_u64(), Some(some));
    let steps: Vec<&str> = saved["funnel"].as_array().unwrap().iter().filter_map(|s| s["name"].as_str()).collect();
    assert!(steps.contains(&"where road = highway or severity >= moderate"), "{steps:?}");
    assert_eq!(place.records(&["--out", "s", "--where", ""])["usable"].as_u64(), Some(all));
    assert_eq!(place.records(&[])["usable"].as_u64(), Some(all), "without --out no suite is looked at");

    let (code, _, error) = place.run(&["records", "--where", "raod = highway"]);
    assert_eq!(code, 3, "{error}");
    assert!(error.contains("the filter, column 1") && error.contains("did you mean \"road\""), "{error}");
    let (_, help, _) = place.run(&["records", "--help"]);
    assert!(help.contains("time_of_day_min") && help.contains("contains, in (a, b)"), "{help}");
}

#[test]
fn counting_rows_or_incidents_is_the_user_s_choice() {
    let place = Place::new();
    let merged = |records: &serde_json::Value| records["funnel"].to_string().contains("one report an incident");
    assert!(!merged(&place.records(&[])), "the paper's profile counts every row");
    assert!(merged(&place.records(&["--dedupe", "incident"])));
    assert!(!merged(&place.records(&["--dedupe", "none"])));
    let (code, _, error) = place.run(&["records", "--dedupe", "some"]);
    assert_eq!(code, 2);
    assert!(error.contains("none") && error.contains("incident"), "{error}");
}

#[test]
fn equal_notes_are_one_line_with_their_count() {
    let place = Place::new();
    let (_, _, remarks) = place.run(&["records", "--dedupe", "incident"]);
    let lent: Vec<&str> = remarks.lines().filter(|line| line.contains("records.narrative-lent")).collect();
    assert_eq!(lent.len(), 1, "{remarks}");
    assert!(lent[0].contains(" x records.narrative-lent, the first: "), "{remarks}");
}

#[test]
fn another_database_is_read_through_its_mapping() {
    let place = Place::new();
    std::fs::write(place.path("map.toml"), include_str!("../../../../docs/mappings/crss.toml")).unwrap();
    let accident = "CASENUM,YEAR,MONTH,HOUR,MINUTE,RELJCT2,WRK_ZONE,LGT_COND,WEATHER,MAX_SEV\n1,2022,6,7,5,2,0,1,1,2\n";
    let vehicle =
        "CASENUM,VEH_NO,BODY_TYP,P_CRASH1,TRAV_SP,VSPD_LIM,VSURCOND,IMPACT1\n1,1,4,11,15,35,1,12\n1,2,14,1,30,35,1,9\n";
    std::fs::write(place.path("accident.csv"), accident).unwrap();
    std::fs::write(place.path("vehicle.csv"), vehicle).unwrap();
    let records = place.records(&["accident.csv", "vehicle.csv", "--mapping", "map.toml"]);
    assert_eq!(records["usable"].as_u64(), Some(1));
    std::fs::write(place.path("map.toml"), "format = \"recrash.mapping/1\"\nname = \"x\"\nfeilds = 1\n").unwrap();
    let (code, _, error) = place.run(&["records", "--mapping", "map.toml"]);
    assert_eq!(code, 3, "{error}");
    assert!(error.contains("map.toml, line 3") && error.contains("feilds"), "{error}");
}

/// Serves one file, once; gives the address of its folder.
fn serve(content: &'static [u8], promised: usize) -> (String, std::thread::JoinHandle<String>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let base = format!("http://{}/sgo", listener.local_addr().unwrap());
    let served = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let mut request = [0; 4096];
        let n = stream.read(&mut request).unwrap();
        let head = format!("HTTP/1.1 200 OK\r\nContent-Type: text/csv\r\nContent-Length: {promised}\r\n\r\n");
        let _ = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(content));
        String::from_utf8_lossy(&request[..n]).lines().next().unwrap_or_default().to_owned()
    });
    (base, served)
}

fn files_of(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_crash_file_is_downloaded_and_then_found_by_its_name() {
    let place = Place::new();
    let (base, served) = serve(SAMPLE_CSV.as_bytes(), SAMPLE_CSV.len());
    let (code, shown, error) = place.run(&["fetch", "--edition", "archive", "--base-url", &base]);
    assert_eq!(code, 0, "{error}");
    assert_eq!(served.join().unwrap(), "GET /sgo/Archive-2021-2025/SGO-2021-01_Incident_Reports_ADS.csv HTTP/1.1");
    let size = format!("{} bytes, SHA-256 ", SAMPLE_CSV.len());
    for words in ["saved ", &size, "451 rows, second edition", "--records sgo-ads-archive.csv"] {
        assert!(shown.contains(words), "{words}:\n{shown}");
    }
    assert_eq!(place.records(&["--records", "sgo-ads-archive.csv"])["usable"].as_u64(), Some(88));
    assert_eq!(place.records(&["sgo-ads-archive"])["usable"].as_u64(), Some(88));

    let (base, served) = serve(SAMPLE_CSV.as_bytes(), SAMPLE_CSV.len());
    let (_, shown, _) = place.run(&["fetch", "--edition", "archive", "--base-url", &base]);
    served.join().unwrap();
    assert!(shown.starts_with("unchanged "), "{shown}");
}

#[test]
fn a_download_that_fails_keeps_what_was_there_and_leaves_nothing_else() {
    let place = Place::new();
    std::fs::create_dir(place.path("cache")).unwrap();
    std::fs::write(place.path("cache/sgo-ads-current.csv"), "before").unwrap();
    let broken: [(&[u8], usize, &str); 3] = [
        (&SAMPLE_CSV.as_bytes()[..5000], SAMPLE_CSV.len(), "broke off"),
        (b"<html>moved</html>", 18, "web page"),
        (b"a,b\n1,2\n", 8, "not the header"),
    ];
    for (content, promised, words) in broken {
        let (base, served) = serve(content, promised);
        let (code, _, error) = place.run(&["fetch", "--base-url", &base]);
        served.join().unwrap();
        assert_eq!(code, 1, "{error}");
        assert!(error.contains(words), "{words}: {error}");
        assert_eq!(files_of(&place.path("cache")), ["sgo-ads-current.csv"]);
        assert_eq!(std::fs::read(place.path("cache/sgo-ads-current.csv")).unwrap(), b"before");
    }
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let (code, _, error) = place.run(&["fetch", "--base-url", &format!("http://127.0.0.1:{port}")]);
    assert_eq!(code, 1);
    assert!(error.contains("are you offline?") && error.contains("read that file"), "{error}");
}
