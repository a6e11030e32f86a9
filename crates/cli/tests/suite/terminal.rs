//! What people see: clean text whoever wrote it, tables as wide as the terminal, and an end without a panic where nobody
//! looks.

use crate::common::{FEW, Place, SMALL, plain_recrash, recrash};
use recrash_records::SAMPLE_CSV;
use std::fs::File;
use std::process::{Output, Stdio};

/// Runs a command with its standard output going there.
fn into(target: Stdio, words: &[&str]) -> Output {
    let place = Place::new();
    let mut command = plain_recrash();
    command.args(words).current_dir(place.folder()).stdout(target).stderr(Stdio::piped());
    command.spawn().unwrap().wait_with_output().unwrap()
}

const PRINTING: [&[&str]; 8] = [
    &["records"],
    &["records", "--json"],
    &["schema"],
    &["--help"],
    &["--version"],
    &["doctor"],
    &["completions", "bash"],
    &["run", "--records", FEW, "--budget", "2", "--tune-budget", "1", "--json"],
];

#[test]
fn a_reader_that_has_gone_ends_a_run_quietly() {
    for words in PRINTING {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = into(writer.into(), words);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{words:?}: {error}");
        assert!(!error.contains("rror"), "{words:?}: {error}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn an_output_that_is_full_is_an_error() {
    let full = || Stdio::from(File::options().write(true).open("/dev/full").unwrap());
    for words in PRINTING {
        let output = into(full(), words);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{words:?}: {error}");
        assert!(error.contains("cannot write the standard output") && error.contains("space"), "{words:?}: {error}");
    }
    let mut command = crate::common::plain_recrash();
    let status = command.args(["records", "nowhere.csv"]).stderr(full()).status().unwrap();
    assert_eq!(status.code(), Some(3), "what cannot be told changes nothing");
}

/// The escape sequences that are our own colours.
fn without_colours(text: &str) -> String {
    ["0", "1", "2", "31", "33"].iter().fold(text.to_owned(), |text, code| text.replace(&format!("\u{1b}[{code}m"), ""))
}

#[test]
fn escapes_of_strangers_are_shown_and_not_obeyed() {
    let place = Place::new();
    let hostile = "\u{1b}]0;owned\u{7}\u{1b}[8mEvil\u{9b}2J\u{202e}";
    let (header, rows) = SAMPLE_CSV.split_once('\n').unwrap();
    let entity = rows.split(',').nth(2).unwrap();
    let header = header.replacen("VIN,", &format!("\u{1b}[8mVIN{hostile},"), 1);
    std::fs::write(place.path("a.csv"), format!("{header}\n{}", rows.replace(entity, hostile))).unwrap();
    let profile = include_str!("../../../../profiles/paper.toml");
    let name = profile.lines().find(|line| line.starts_with("name")).unwrap();
    let named = profile.replacen(name, "name = \"\\u001b[8m\\u001b]0;owned\\u0007\"", 1);
    std::fs::write(place.path("mine.toml"), named).unwrap();
    let back = format!("{hostile}\rerror: none");
    let forms: [&[&str]; 10] = [
        &["records", &back],
        &["records", "a.csv"],
        &["run", "--records", "a.csv", "--profile", "mine.toml", "--budget", "2", "--tune-budget", "1"],
        &["records", hostile],
        &["records", "--where", hostile],
        &["records", "--profile", hostile],
        &["run", "--strategy", hostile],
        &["run", "--ego", hostile],
        &[hostile],
        &["eval", "--records", "a.csv", "--half", hostile],
    ];
    for words in forms {
        let mut command = recrash(words);
        command.current_dir(place.folder()).env("CLICOLOR_FORCE", "1").env("HOME", place.path("home"));
        let output = command.output().unwrap();
        let shown = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        let plain = without_colours(&shown);
        assert!(!plain.contains(['\u{1b}', '\u{7}', '\u{9b}', '\u{202e}', '\r']), "{words:?}: {plain:?}");
    }
    let (_, shown, _) = place.run(&["records", "a.csv"]);
    assert!(shown.contains("\\u{1b}]0;owned\\u{7}"), "{shown}");
    let told = place.records(&["a.csv"]).to_string();
    let as_it_is = serde_json::to_string(hostile).unwrap();
    assert!(told.contains(as_it_is.trim_matches('"')), "JSON tells the text as it is");
}

/// The lines of the table of scenarios, as printed in so many columns.
fn scenarios(place: &Place, columns: Option<&str>) -> Vec<String> {
    let mut command = recrash(&["report", "--out", "suite"]);
    command.current_dir(place.folder()).env_remove("COLUMNS");
    if let Some(columns) = columns {
        command.env("COLUMNS", columns);
    }
    let shown = String::from_utf8(command.output().unwrap().stdout).unwrap();
    let table = shown.lines().skip_while(|line| !line.starts_with("Scenarios (")).skip(1);
    table.take_while(|line| !line.is_empty()).map(str::to_owned).collect()
}

#[test]
fn the_table_of_scenarios_keeps_to_the_width_of_the_terminal() {
    let place = Place::made(&SMALL);
    let summary = std::fs::read(place.path("suite/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    let id = summary["cases"][0]["id"].as_str().unwrap().to_owned();
    for (columns, width) in [(Some("60"), 60), (Some("80"), 80), (Some("150"), 150), (None, 100)] {
        let table = scenarios(&place, columns);
        let rule = table.iter().position(|line| line.contains('\u{2500}')).expect("a table");
        let end = table.iter().position(|line| line.contains("not shown in") || line.starts_with("  not")).unwrap_or(6);
        for line in &table[..end] {
            assert!(line.chars().count() <= width, "{width}: {line}");
        }
        let whole = table.join("\n");
        assert!(whole.contains(&id), "an id is not cut at {width}:\n{whole}");
        assert!(table[0].contains("scenario") && table[0].contains("verdict") && rule > 0, "{whole}");
        assert_eq!(whole.contains("not shown in"), width < 150, "{whole}");
    }
}

#[test]
fn every_command_has_completions_and_a_page() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let (code, script, error) = place.run(&["completions", shell]);
        assert_eq!(code, 0, "{error}");
        assert!(script.contains("recrash") && script.contains("tune-budget"), "{shell}");
    }
    let (code, _, error) = place.run(&["man", "pages/man1"]);
    assert_eq!(code, 0, "{error}");
    let page = std::fs::read_to_string(place.path("pages/man1/recrash-run.1")).unwrap();
    assert!(page.contains(".TH") && page.contains("budget") && page.contains("Examples"), "{page}");
    for name in ["recrash.1", "recrash-simulate.1", "recrash-model-pull.1"] {
        assert!(place.path("pages/man1").join(name).is_file(), "{name}");
    }
}
