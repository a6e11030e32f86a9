//! What a contact with a wall does to the ego stands wherever delta-v of a contact with a road user does.

use crate::suite;
use recrash_model::metrics::{Finding, FindingKind};
use recrash_model::scenario::ObstacleKind;
use recrash_report::{SuiteView, html, junit, results_csv};

/// One scenario, in which the ego strikes a wall.
fn struck() -> SuiteView {
    let mut suite = suite::demo().suite;
    let with = |run: &recrash_report::RunRow| run.severity.is_some();
    suite.cases.retain(|case| case.after.is_none() && case.before.as_ref().is_some_and(with));
    suite.cases.truncate(1);
    let run = &mut suite.cases[0].before.as_mut().expect("it was run").judgement;
    run.metrics.contact = None;
    let (kind, sentence) = (FindingKind::ObstacleContact, "The ego hit a wall.".to_owned());
    run.findings = vec![Finding { kind, time_s: 2.0, value: 7.4, threshold: 0.0, sentence }];
    let severity = run.severity.as_mut().expect("it has one");
    severity.obstacle = Some(ObstacleKind::Wall);
    severity.closing_speed_mps = 7.4;
    (severity.first.delta_v_mps, severity.second.delta_v_mps, severity.second.mass_kg) = (7.3, 0.0, None);
    suite
}

#[test]
fn the_page_junit_and_the_table_say_what_a_wall_does() {
    let suite = struck();
    assert_eq!(suite.cases.len(), 1);
    let xml = junit(&suite);
    assert!(xml.contains("delta-v: ego 7.3 m/s, wall 0.0 m/s"), "{xml}");
    let csv = results_csv(&suite);
    let mut table = csv::Reader::from_reader(csv.as_bytes());
    let header = table.headers().expect("a header").clone();
    let row = table.records().next().expect("a row").expect("it is one");
    let cell = |name: &str| &row[header.iter().position(|column| column == name).expect("a column")];
    assert_eq!((cell("ego_delta_v_mps"), cell("other_delta_v_mps")), ("7.300", "0.000"));
    let page = html(&suite);
    assert!(page.contains("delta-v ego 7.3, wall 0.0") && page.contains("on a wall"), "the list of scenarios");
    let findings = page.split("Findings of every run").nth(1).and_then(|rest| rest.split("</table>").next());
    assert!(findings.is_some_and(|table| table.contains("7.3")), "{findings:?}");
}
