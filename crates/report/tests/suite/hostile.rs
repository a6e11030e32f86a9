//! Untrusted text, numbers that are none, and positions that lead nowhere: the page, the XML and the table stay whole.

use crate::suite::{self, Demo};
use recrash_model::metrics::Timed;
use recrash_model::narrative::{FactSource, Origin};
use recrash_model::record::{Coded, RecordRef};
use recrash_model::review::{Review, ReviewBy, Shown};
use recrash_model::run::Judgement;
use recrash_report::{
    CaseRow, CaseView, RunRow, RunView, SuiteView, case_file, case_file_name, html, junit, results_csv,
};

const HOSTILE: &str = "</script></style></title><img src=x onerror=alert(1)><!--\" ' ` ../../etc/passwd {{7*7}} ]]> \u{202e}\u{1f697} \u{0} &lt;b&gt;";

/// A review by this model that finds a movement otherwise than told.
pub(super) fn wrong(model: &str, note: &str) -> ReviewBy {
    let yes = Shown::Yes;
    let (who, side, order, standstill, striker, zones) = (yes, yes, Shown::Untold, yes, yes, yes);
    let review = Review { who, side, movements: Shown::No, order, standstill, striker, zones, note: note.to_owned() };
    ReviewBy { model: model.to_owned(), review }
}

/// The made-up suite with hostile text in every place that can hold text.
fn hostile() -> Demo {
    let Demo { mut suite, mut driven } = suite::demo();
    let long = format!("{HOSTILE} {}", "a ".repeat(50_000));
    spoil_suite(&mut suite, &long);
    let ids: Vec<_> = suite.records.records.iter().map(|record| record.id.clone()).collect();
    for (number, row) in suite.cases.iter_mut().enumerate() {
        row.scenario_id = format!("{HOSTILE}{number}");
        row.told = Some(ids[row.records[0]].clone());
        spoil_row(row, &long);
    }
    for (case, row) in driven.iter_mut().zip(&suite.cases) {
        spoil_case(case, &ids[row.records[0]], &long);
    }
    Demo { suite, driven }
}

/// Everything of a suite but its scenarios.
fn spoil_suite(suite: &mut SuiteView, long: &str) {
    for text in [
        &mut suite.title,
        &mut suite.generated_by,
        &mut suite.command,
        &mut suite.ego,
        &mut suite.simulator,
        &mut suite.agents,
    ] {
        *text = HOSTILE.to_owned();
    }
    suite.generated_at = Some(HOSTILE.to_owned());
    suite.profile.name = HOSTILE.to_owned();
    suite.profile.description = HOSTILE.to_owned();
    suite.selection.embedding.name = HOSTILE.to_owned();
    for file in &mut suite.records.files {
        file.name = HOSTILE.to_owned();
        file.sha256 = HOSTILE.to_owned();
    }
    for step in &mut suite.records.funnel {
        step.name = HOSTILE.to_owned();
    }
    for (index, record) in suite.records.records.iter_mut().enumerate() {
        record.id.report_id = format!("{HOSTILE}{index}");
        for text in [&mut record.entity, &mut record.vehicle, &mut record.place, &mut record.provenance.file] {
            *text = HOSTILE.to_owned();
        }
        record.narrative = long.to_owned();
        record.incident_id = Some(HOSTILE.to_owned());
        record.partner = Coded::Unlisted(HOSTILE.to_owned());
    }
    for diagnostic in &mut suite.diagnostics {
        diagnostic.code = HOSTILE.to_owned();
        diagnostic.message = HOSTILE.to_owned();
        diagnostic.hint = HOSTILE.to_owned();
        diagnostic.location.file = Some(HOSTILE.to_owned());
    }
}

fn spoil_row(row: &mut CaseRow, long: &str) {
    row.refused = Some(HOSTILE.to_owned());
    row.narrative = long.to_owned();
    row.origin = Some(Origin::Invented { reason: HOSTILE.to_owned() });
    row.edited = vec![HOSTILE.to_owned()];
    row.review = Some(wrong(HOSTILE, long));
    for run in row.before.iter_mut().chain(&mut row.after) {
        run.rerun_command = HOSTILE.to_owned();
        spoil_judgement(&mut run.judgement);
    }
}

fn spoil_case(case: &mut CaseView, told: &RecordRef, long: &str) {
    case.refused = Some(HOSTILE.to_owned());
    let narrative = case.narrative.as_mut().unwrap();
    narrative.text = long.to_owned();
    narrative.origin = Origin::Invented { reason: HOSTILE.to_owned() };
    for fact in &mut narrative.facts {
        fact.source = FactSource::Words { record: told.clone(), words: "onerror=alert(1)".to_owned() };
    }
    for run in [&mut case.before, &mut case.after].into_iter().flatten() {
        spoil_run(run);
    }
    if let Some(log) = &mut case.tune_log {
        log.searcher = HOSTILE.to_owned();
        for parameter in &mut log.parameters {
            parameter.pointer = HOSTILE.to_owned();
            parameter.unit = HOSTILE.to_owned();
            parameter.reason = HOSTILE.to_owned();
        }
        for point in &mut log.points {
            point.proposed_by = HOSTILE.to_owned();
            point.score.refused = vec![HOSTILE.to_owned()];
        }
    }
}

fn spoil_run(run: &mut RunView) {
    run.rerun_command = HOSTILE.to_owned();
    run.scenario.id = HOSTILE.to_owned();
    run.scenario.source.narrative = HOSTILE.to_owned();
    run.run.rollout.simulator = HOSTILE.to_owned();
    run.run.rollout.ego = HOSTILE.to_owned();
    run.run.rollout.state_hash = HOSTILE.to_owned();
    for actor in &mut run.run.rollout.actors {
        actor.id = HOSTILE.to_owned();
    }
    spoil_judgement(&mut run.run.judgement);
}

fn spoil_judgement(judgement: &mut Judgement) {
    for text in [&mut judgement.id, &mut judgement.ego, &mut judgement.simulator] {
        *text = HOSTILE.to_owned();
    }
    for finding in &mut judgement.findings {
        finding.sentence = HOSTILE.to_owned();
    }
    for check in &mut judgement.verdict.checks {
        check.expected = HOSTILE.to_owned();
        check.observed = HOSTILE.to_owned();
    }
    for partner in &mut judgement.metrics.partners {
        partner.id = HOSTILE.to_owned();
    }
    if let Some(contact) = &mut judgement.metrics.contact {
        contact.id = HOSTILE.to_owned();
    }
}

/// Numbers that are none, and positions out of range.
fn broken() -> Demo {
    let Demo { mut suite, mut driven } = suite::demo();
    suite.selection.map[0].cluster = 999;
    suite.selection.map[1].record = 9999;
    suite.selection.map[2].x = f64::NAN;
    suite.selection.coverage.radius = f64::NAN;
    suite.selection.embedding.explained_variance = f64::NAN;
    suite.cases[0].cluster = Some(999);
    suite.cases[0].records = vec![9999];
    suite.cases[0].origin = None;
    suite.cases[0].told = None;
    driven[0].narrative = None;
    driven[0].tune_log = None;
    let spoil_rows =
        |case: &mut CaseRow, of: fn(&mut RunRow)| case.before.iter_mut().chain(&mut case.after).for_each(of);
    spoil_rows(&mut suite.cases[2], |run| {
        run.judgement.metrics.min_gap = Some(Timed { value: f64::NAN, time_s: f64::INFINITY });
        if let Some(contact) = &mut run.judgement.metrics.contact {
            contact.relative_speed_mps = f64::NAN;
        }
    });
    spoil_rows(&mut suite.cases[3], |run| {
        run.judgement.verdict.checks.clear();
        run.judgement.metrics.partners.clear();
        run.judgement.metrics.min_gap = None;
    });
    let spoil = |case: &mut CaseView, of: fn(&mut RunView)| case.before.iter_mut().chain(&mut case.after).for_each(of);
    spoil(&mut driven[1], |run| run.run.rollout.actors.clear());
    spoil(&mut driven[2], |run| {
        run.series.partners.clear();
        run.run.rollout.actors[1].states[3].x = f64::NAN;
        run.run.judgement.metrics.min_gap = Some(Timed { value: f64::NAN, time_s: f64::INFINITY });
    });
    spoil(&mut driven[3], |run| {
        run.run.judgement.verdict.checks.clear();
        run.run.judgement.metrics.partners.clear();
        run.run.judgement.metrics.min_gap = None;
        run.series.partners[0].gap_m.iter_mut().for_each(|gap| *gap = f64::NAN);
        run.series.partners[0].actor = 77;
    });
    driven[4].tune_log.as_mut().unwrap().best = 4711;
    driven[5].tune_log.as_mut().unwrap().points.clear();
    driven[6].tune_log.as_mut().unwrap().points.iter_mut().for_each(|point| {
        point.values.clear();
        point.score.objective = f64::INFINITY;
    });
    Demo { suite, driven }
}

/// The JSON value of a case's file, and that nothing else stands in it.
fn value_of(file: &str) -> serde_json::Value {
    let json = file.strip_prefix("recrashCase(").and_then(|rest| rest.strip_suffix(");\n")).expect("one call");
    serde_json::from_str(json).expect("of one JSON value")
}

/// The markup of every case.
fn markup(demo: &Demo) -> Vec<String> {
    let cases = 0..demo.suite.cases.len();
    cases.map(|position| value_of(&demo.case_file(position))["markup"].as_str().unwrap().to_owned()).collect()
}

fn empty() -> SuiteView {
    let mut suite = suite::demo().suite;
    suite.cases.clear();
    suite.diagnostics.clear();
    suite.records.files.clear();
    suite.records.records.clear();
    suite.records.usable.clear();
    suite.records.rejects.clear();
    suite.records.funnel.clear();
    suite.selection.clusters.clear();
    suite.selection.templates.clear();
    suite.selection.map.clear();
    suite
}

/// Start tags of this name.
fn tags(page: &str, name: &str) -> usize {
    page.matches(&format!("<{name}")).count()
}

#[test]
fn hostile_text_makes_no_element_and_closes_none() {
    let demo = hostile();
    let page = html(&demo.suite);
    assert_eq!(tags(&page, "script"), 3, "the first words, the suite's data, and the script");
    assert_eq!(page.matches("</script").count(), 3);
    assert_eq!((tags(&page, "style"), page.matches("</style").count()), (1, 1));
    let cases = markup(&demo);
    for case in &cases {
        assert_eq!((tags(case, "script"), tags(case, "style")), (0, 0));
    }
    for text in cases.iter().chain([&page]) {
        assert_eq!(tags(text, "img"), 0);
        assert!(!text.contains("<!--"));
        let control = text.find('\u{0}').map(|at| text[..at].chars().rev().take(260).collect::<String>());
        assert_eq!(control, None, "a control character behind this, backwards");
        // Only these attributes lead anywhere, and they lead into the page.
        for attribute in [" href=\"", " src=\""] {
            for (at, _) in text.match_indices(attribute) {
                let target = &text[at + attribute.len()..];
                assert!(target.starts_with('#') || target.starts_with("data:,\""), "{}", &target[..60]);
            }
        }
    }
}

#[test]
fn a_file_of_a_case_is_one_call_with_one_value_and_no_text_can_leave_it() {
    let demo = hostile();
    for position in 0..demo.suite.cases.len() {
        let file = demo.case_file(position);
        assert!(!file.contains(['<', '>', '&', '\u{2028}', '\u{2029}', '\u{0}']), "{position}");
        let value = value_of(&file);
        let name = case_file_name(&demo.suite.cases[position].scenario_id);
        assert_eq!(name, format!("report/{}.js", value["stem"].as_str().unwrap()));
        assert!(!name.contains("..") && name.matches('/').count() == 1, "{name}");
    }
}

#[test]
fn a_file_of_a_case_depends_on_that_case_alone() {
    let demo = suite::demo();
    let row = &demo.suite.cases[3];
    let mut other = demo.suite.clone();
    other.title = "another".to_owned();
    other.seed = 99;
    other.cases.truncate(4);
    other.cases[0].scenario_id = "something-else".to_owned();
    for record in 0..other.records.records.len() {
        if !other.selection.clusters[3].members.contains(&record) {
            other.records.records[record].narrative = "changed".to_owned();
        }
    }
    let case = demo.case(3);
    assert_eq!(case_file(&other.context(&other.cases[3]), &case, &other.cases[3]), demo.case_file(3));
    let mut edited = row.clone();
    edited.edited = vec!["4-scenarios/x.json".to_owned()];
    assert_ne!(case_file(&demo.suite.context(row), &case, &edited), demo.case_file(3));
}

#[test]
fn hostile_text_is_shown_as_it_is() {
    let demo = hostile();
    for text in [html(&demo.suite), markup(&demo).concat()] {
        assert!(text.contains("&lt;/script&gt;&lt;/style&gt;&lt;/title&gt;&lt;img src=x onerror=alert(1)&gt;&lt;!--"));
        assert!(text.contains("&amp;lt;b&amp;gt;"));
    }
}

#[test]
fn long_texts_are_cut_and_the_files_stay_small() {
    let (plain, spoilt) = (suite::demo(), hostile());
    assert!(html(&plain.suite).len() < 400_000, "{} bytes for 20 scenarios", html(&plain.suite).len());
    assert!(html(&spoilt.suite).len() < 800_000, "{} bytes with 23 MB of narratives", html(&spoilt.suite).len());
    for position in 0..spoilt.suite.cases.len() {
        assert!(plain.case_file(position).len() < 150_000, "{} bytes", plain.case_file(position).len());
        assert!(spoilt.case_file(position).len() < 600_000, "{} bytes", spoilt.case_file(position).len());
    }
}

#[test]
fn a_suite_of_two_thousand_is_read_in_less_than_five_megabytes() {
    let page = html(&suite::demo_of(2000).suite);
    assert!(page.len() < 5_000_000, "{} bytes", page.len());
    assert_eq!(page.matches("data-row=").count(), 2000);
}

#[test]
fn no_id_stands_twice_in_the_page_and_its_cases() {
    let demo = hostile();
    let whole = html(&demo.suite) + &markup(&demo).concat();
    let mut ids: Vec<&str> =
        whole.match_indices(" id=\"").map(|(at, _)| whole[at + 5..].split('"').next().unwrap()).collect();
    let all = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all);
}

#[test]
fn broken_and_empty_suites_are_rendered() {
    let demo = suite::demo();
    let nan = html(&demo.suite).matches("NaN").count();
    for suite in [broken().suite, empty()] {
        let page = html(&suite);
        assert!(page.ends_with("</html>"));
        // The only ones stand in the script.
        assert_eq!(page.matches("NaN").count(), nan);
        assert!(junit(&suite).ends_with("</testsuites>\n"));
        assert!(results_csv(&suite).starts_with("scenario,run,"));
    }
    let broken = broken();
    for position in 0..broken.suite.cases.len() {
        assert!(!broken.case_file(position).contains("NaN"), "{position}");
    }
}

#[test]
fn only_a_yes_is_called_faithful() {
    let mut demo = suite::demo();
    for case in &mut demo.suite.cases {
        case.before.iter_mut().chain(&mut case.after).for_each(|run| run.judgement.verdict.checks.clear());
    }
    for case in &mut demo.driven {
        case.before.iter_mut().chain(&mut case.after).for_each(|run| run.run.judgement.verdict.checks.clear());
    }
    for text in [html(&demo.suite), markup(&demo).concat()] {
        assert!(text.contains(">unchecked<") && !text.contains(">faithful<"));
    }
    assert!(html(&demo.suite).contains("<b>0 of those 16</b>"));
    assert!(junit(&demo.suite).contains("faithful: unchecked") && !junit(&demo.suite).contains("faithful: yes"));
}

#[test]
fn the_first_screen_tells_its_denominators_and_nobodys_crash_is_true_to_no_record() {
    let demo = suite::demo();
    let page = html(&demo.suite);
    assert!(
        page.contains("<b>16 of 20 scenarios</b> tell their own record; <b>11 of those 16</b> show every stated fact.")
    );
    // The sixth tells nobody's crash, and its run shows what it should.
    assert!(demo.suite.cases[5].last_run().is_some_and(|run| run.faithful() == recrash_model::metrics::Answer::Yes));
    assert_eq!(demo.suite.cases[5].faithful(), None);
    let row = page.split("data-row=").nth(6).unwrap();
    assert!(row.contains("invented") && row.contains("no record") && !row.contains("faithful"), "{row}");
    assert!(page.contains(">faithful<") && markup(&demo)[0].contains(">faithful<"));
    assert!(markup(&demo)[5].contains("invented") && !markup(&demo)[5].contains(">faithful<"));
}

#[test]
fn xml_has_no_character_that_xml_forbids_and_every_tag_is_closed() {
    let xml = junit(&hostile().suite);
    assert!(xml.chars().all(|c| !c.is_control() || c == '\n'));
    assert!(!xml.contains("<img"));
    for name in ["testsuites", "testsuite ", "testcase", "failure", "properties"] {
        let name = name.trim_end();
        let opened = xml.matches(&format!("<{name} ")).count() + xml.matches(&format!("<{name}>")).count();
        assert_eq!(opened, xml.matches(&format!("</{name}>")).count(), "{name}");
    }
}

#[test]
fn the_table_has_one_length_of_row_and_gives_its_text_back() {
    let mut suite = hostile().suite;
    suite.cases[0].scenario_id = "=cmd|' /C calc'!A0".to_owned();
    let table = results_csv(&suite);
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let rows: Vec<csv::StringRecord> =
        reader.records().map(|row| row.expect("every row is as long as the header")).collect();
    let runs: usize =
        suite.cases.iter().map(|case| [&case.before, &case.after].into_iter().flatten().count().max(1)).sum();
    assert_eq!(rows.len(), runs);
    assert_eq!(&rows[0][0], "'=cmd|' /C calc'!A0");
    let refused = reader.headers().unwrap().iter().position(|name| name == "refused_because").unwrap();
    assert_eq!(&rows[rows.len() - 1][refused], HOSTILE.replace('\u{0}', "\u{fffd}"));
}

#[test]
fn same_view_same_bytes() {
    let (one, again) = (suite::demo(), suite::demo());
    assert_eq!(html(&one.suite), html(&again.suite));
    assert_eq!(one.case_file(7), again.case_file(7));
}
