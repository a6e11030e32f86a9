//! JUnit and CSV of four made-up cases: fails as designed, tuned to fail, not faithful, refused.

use crate::suite;
use recrash_report::SuiteView;

fn four_cases() -> SuiteView {
    let mut suite = suite::demo();
    let all = std::mem::take(&mut suite.cases);
    suite.cases =
        all.into_iter().enumerate().filter(|(i, _)| [0, 8, 16, 18].contains(i)).map(|(_, case)| case).collect();
    suite
}

#[test]
fn junit() {
    insta::assert_snapshot!(recrash_report::junit(&four_cases()));
}

#[test]
fn results() {
    insta::assert_snapshot!(recrash_report::results_csv(&four_cases()).replace("\r\n", "\n"));
}
