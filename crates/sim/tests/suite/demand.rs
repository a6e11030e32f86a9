//! Whether the format can write what 140 random incidents need, word by word and counted by incident.

use crate::gallery::case_names;
use std::collections::{BTreeMap, BTreeSet};

/// A line of the table: column, word, in the format, case.
fn table() -> Vec<[&'static str; 4]> {
    let text = include_str!("../fixtures/demand.txt");
    let row = |line: &'static str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        <[&str; 4]>::try_from(cells).unwrap_or_else(|cells| panic!("{cells:?}"))
    };
    text.lines().filter(|line| !line.starts_with('#')).map(row).collect()
}

#[test]
fn every_need_has_a_case() {
    let names = case_names();
    for [column, word, written, case] in table() {
        assert!(!written.is_empty(), "{column} {word}");
        assert!(case == "-" || names.contains(case), "{column} {word}: no case {case}");
    }
}

#[test]
fn needs_of_random_incidents_can_be_written() {
    let Some(file) = recrash_testing::shared("data/demand.csv") else { return };
    let rows = table();
    let knows = |column: &str, word: &str| rows.iter().any(|row| row[0] == column && row[1] == word);
    let cannot: BTreeMap<&str, &str> =
        rows.iter().filter(|row| row[0] == "cannot").map(|row| (row[1], row[2])).collect();
    let mut reader = csv::Reader::from_path(file).unwrap();
    let headers = reader.headers().unwrap().clone();
    let (mut counts, mut missing, mut refused) = ([0; 4], BTreeSet::new(), BTreeSet::new());
    for incident in reader.records().map(Result::unwrap) {
        let cell = |name: &str| incident.get(headers.iter().position(|header| header == name).unwrap()).unwrap();
        let words = |name: &str| -> Vec<String> {
            let told = without_brackets(cell(name));
            told.split(';').map(|word| word.trim().to_owned()).filter(|word| !word.is_empty()).collect()
        };
        let mut lacks = false;
        let columns = [
            ("act", "sv_acts"),
            ("act", "cp_acts"),
            ("kind", "cp_kind"),
            ("from", "cp_from"),
            ("other", "others_needed"),
            ("road", "road_features"),
        ];
        for (column, name) in columns {
            for word in words(name).into_iter().filter(|word| !knows(column, word)) {
                missing.insert(format!("{column} {word}"));
                lacks = true;
            }
        }
        // Control is told in sentences: each of them names something known.
        let control = without_brackets(cell("control")).to_lowercase();
        for sentence in control.split([';', ',']) {
            if !rows.iter().any(|row| row[0] == "control" && sentence.contains(row[1])) {
                missing.insert(format!("control {sentence}"));
                lacks = true;
            }
        }
        if let Some(why) = cannot.get(cell("report")) {
            refused.insert(format!("{}: {why}", cell("report")));
            lacks = true;
        }
        let tellable = usize::from(cell("tellable") == "yes");
        counts[0] += 1;
        counts[1] += usize::from(!lacks);
        counts[2] += tellable;
        counts[3] += tellable * usize::from(!lacks);
    }
    let [all, written, tellable, told] = counts;
    println!("{written} of {all} incidents can be written, {told} of the {tellable} that can be told");
    println!("words without a way to write them: {missing:?}; incidents that need more: {refused:#?}");
    assert!(all >= 100 && written as f64 >= 0.95 * all as f64, "{missing:?}");
    assert!(told as f64 >= 0.95 * tellable as f64, "{missing:?}");
}

/// What is in brackets says more of a word, and is no need of its own.
fn without_brackets(text: &str) -> String {
    let mut depth = 0_u32;
    let outside = |letter: &char| {
        match letter {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0 && *letter != ')'
    };
    text.chars().filter(outside).collect()
}
