//! Untrusted text, numbers that are none, and positions that lead nowhere: the page, the XML and the table stay whole.

#[allow(dead_code)]
#[path = "../examples/demo/drive.rs"]
mod drive;
#[allow(dead_code)]
#[path = "../examples/demo/roads.rs"]
mod roads;
#[path = "../examples/demo/suite.rs"]
mod suite;

use recrash_model::metrics::Timed;
use recrash_model::narrative::{FactSource, Origin};
use recrash_model::record::Coded;
use recrash_report::{CaseView, RunView, SuiteView, html, junit, results_csv};

const HOSTILE: &str = "</script></style></title><img src=x onerror=alert(1)><!--\" ' ` ../../etc/passwd {{7*7}} ]]> \u{202e}\u{1f697} \u{0} &lt;b&gt;";

/// The made-up suite with hostile text in every place that can hold text.
fn hostile() -> SuiteView {
    let mut suite = suite::demo();
    let long = format!("{HOSTILE} {}", "a ".repeat(50_000));
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
        record.narrative = long.clone();
        record.incident_id = Some(HOSTILE.to_owned());
        record.partner = Coded::Unlisted(HOSTILE.to_owned());
    }
    for diagnostic in &mut suite.diagnostics {
        diagnostic.code = HOSTILE.to_owned();
        diagnostic.message = HOSTILE.to_owned();
        diagnostic.hint = HOSTILE.to_owned();
        diagnostic.location.file = Some(HOSTILE.to_owned());
    }
    let ids: Vec<_> = suite.records.records.iter().map(|record| record.id.clone()).collect();
    for case in &mut suite.cases {
        case.scenario_id = HOSTILE.to_owned();
        case.refused = Some(HOSTILE.to_owned());
        let narrative = case.narrative.as_mut().unwrap();
        narrative.text = long.clone();
        narrative.origin = Origin::Invented { reason: HOSTILE.to_owned() };
        for fact in &mut narrative.facts {
            fact.source =
                FactSource::Words { record: ids[case.records[0]].clone(), words: "onerror=alert(1)".to_owned() };
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
    suite
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
    for finding in &mut run.run.judgement.findings {
        finding.sentence = HOSTILE.to_owned();
    }
    for check in &mut run.run.judgement.verdict.checks {
        check.expected = HOSTILE.to_owned();
        check.observed = HOSTILE.to_owned();
    }
    for partner in &mut run.run.judgement.metrics.partners {
        partner.id = HOSTILE.to_owned();
    }
    if let Some(contact) = &mut run.run.judgement.metrics.contact {
        contact.id = HOSTILE.to_owned();
    }
}

/// Numbers that are none, and positions out of range.
fn broken() -> SuiteView {
    let mut suite = suite::demo();
    suite.selection.map[0].cluster = 999;
    suite.selection.map[1].record = 9999;
    suite.selection.map[2].x = f64::NAN;
    suite.selection.coverage.radius = f64::NAN;
    suite.selection.embedding.explained_variance = f64::NAN;
    suite.cases[0].cluster = Some(999);
    suite.cases[0].records = vec![9999];
    suite.cases[0].narrative = None;
    suite.cases[0].tune_log = None;
    let spoil = |case: &mut CaseView, of: fn(&mut RunView)| case.before.iter_mut().chain(&mut case.after).for_each(of);
    spoil(&mut suite.cases[1], |run| run.run.rollout.actors.clear());
    spoil(&mut suite.cases[2], |run| {
        run.series.partners.clear();
        run.run.rollout.actors[1].states[3].x = f64::NAN;
        run.run.judgement.metrics.min_gap = Some(Timed { value: f64::NAN, time_s: f64::INFINITY });
    });
    spoil(&mut suite.cases[3], |run| {
        run.run.judgement.verdict.checks.clear();
        run.run.judgement.metrics.partners.clear();
        run.run.judgement.metrics.min_gap = None;
        run.series.partners[0].gap_m.iter_mut().for_each(|gap| *gap = f64::NAN);
        run.series.partners[0].actor = 77;
    });
    suite.cases[4].tune_log.as_mut().unwrap().best = 4711;
    suite.cases[5].tune_log.as_mut().unwrap().points.clear();
    suite.cases[6].tune_log.as_mut().unwrap().points.iter_mut().for_each(|point| {
        point.values.clear();
        point.score.objective = f64::INFINITY;
    });
    suite
}

fn empty() -> SuiteView {
    let mut suite = suite::demo();
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
    let page = html(&hostile());
    assert_eq!(tags(&page, "img"), 0);
    assert!(!page.contains("<!--"));
    assert_eq!(tags(&page, "script"), 20 + 2, "a data block for each case, one for the suite, and the script");
    assert_eq!(page.matches("</script").count(), 20 + 2);
    assert_eq!((tags(&page, "style"), page.matches("</style").count()), (1, 1));
    let control = page
        .find('\u{0}')
        .map(|at| page[..at].chars().rev().take(260).collect::<Vec<_>>().into_iter().rev().collect::<String>());
    assert_eq!(control, None, "a control character behind this");
    // Only these attributes lead anywhere, and they lead into the page.
    for attribute in ["href=\"", "src=\""] {
        for (at, _) in page.match_indices(attribute) {
            let target = &page[at + attribute.len()..];
            assert!(target.starts_with('#') || target.starts_with("data:,\""), "{}", &target[..60]);
        }
    }
}

#[test]
fn hostile_text_is_shown_as_it_is() {
    let page = html(&hostile());
    assert!(page.contains("&lt;/script&gt;&lt;/style&gt;&lt;/title&gt;&lt;img src=x onerror=alert(1)&gt;&lt;!--"));
    assert!(page.contains("&amp;lt;b&amp;gt;"));
}

#[test]
fn long_texts_are_cut_and_the_page_stays_small() {
    let (plain, spoilt) = (html(&suite::demo()).len(), html(&hostile()).len());
    assert!(plain < 3_000_000, "{plain} bytes for 20 scenarios");
    assert!(spoilt < 12_000_000, "{spoilt} bytes with 23 MB of narratives");
}

#[test]
fn anchors_differ_although_every_id_is_the_same() {
    let page = html(&hostile());
    let mut ids: Vec<&str> =
        page.match_indices(" id=\"").map(|(at, _)| page[at + 5..].split('"').next().unwrap()).collect();
    let all = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all);
}

#[test]
fn broken_and_empty_suites_are_rendered() {
    for suite in [broken(), empty()] {
        let page = html(&suite);
        assert!(page.ends_with("</html>"));
        // The only ones stand in the script.
        assert_eq!(page.matches("NaN").count(), html(&suite::demo()).matches("NaN").count());
        assert!(junit(&suite).ends_with("</testsuites>\n"));
        assert!(results_csv(&suite).starts_with("scenario,run,"));
    }
}

#[test]
fn a_run_in_which_nothing_was_checked_is_not_called_faithful() {
    let mut suite = suite::demo();
    for case in &mut suite.cases {
        case.before.iter_mut().chain(&mut case.after).for_each(|run| run.run.judgement.verdict.checks.clear());
    }
    let page = html(&suite);
    assert!(page.contains("not checked") && !page.contains("</svg>faithful<"));
}

#[test]
fn xml_has_no_character_that_xml_forbids_and_every_tag_is_closed() {
    let xml = junit(&hostile());
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
    let mut suite = hostile();
    suite.cases[0].scenario_id = "=cmd|' /C calc'!A0".to_owned();
    let table = results_csv(&suite);
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let rows: Vec<csv::StringRecord> =
        reader.records().map(|row| row.expect("every row is as long as the header")).collect();
    let runs: usize =
        suite.cases.iter().map(|case| [&case.before, &case.after].into_iter().flatten().count().max(1)).sum();
    assert_eq!(rows.len(), runs);
    assert_eq!(&rows[0][0], "'=cmd|' /C calc'!A0");
    assert_eq!(&rows[rows.len() - 1][9], HOSTILE.replace('\u{0}', "\u{fffd}"));
}

#[test]
fn same_view_same_bytes() {
    let suite = suite::demo();
    assert_eq!(html(&suite), html(&suite.clone()));
    assert_eq!(html(&suite::demo()), html(&suite));
}
