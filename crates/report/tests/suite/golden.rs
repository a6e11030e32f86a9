//! JUnit and CSV of made-up cases: fails as designed, another record's, nobody's crash and edited, tuned to fail, not faithful,
//! refused.

use crate::hostile::wrong;
use crate::suite;
use recrash_model::cause::Cause;
use recrash_model::preventability::Preventability;
use recrash_report::SuiteView;

fn some_cases() -> SuiteView {
    let mut suite = suite::demo().suite;
    let all = std::mem::take(&mut suite.cases);
    suite.cases =
        all.into_iter().enumerate().filter(|(i, _)| [0, 5, 6, 8, 16, 18].contains(i)).map(|(_, case)| case).collect();
    let failed = suite.cases[0].before.as_mut().expect("it was run");
    failed.judgement.cause = Some(Cause::BrakedLate);
    failed.judgement.preventability = Some(Preventability { closing_speed_mps: 5.0, drivers: Vec::new() });
    suite.cases[0].review = Some(wrong("m", "=told is a lane change, shown is none"));
    suite.cases[1].edited = vec!["4-scenarios/06-intersection-straight-left.json".to_owned()];
    suite
}

#[test]
fn junit() {
    insta::assert_snapshot!(recrash_report::junit(&some_cases()));
}

#[test]
fn results() {
    insta::assert_snapshot!(recrash_report::results_csv(&some_cases()).replace("\r\n", "\n"));
}
