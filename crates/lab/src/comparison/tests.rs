use super::*;
use recrash_model::frozen::About;
use recrash_model::metrics::{Finding, Timed};
use recrash_model::results::{RESULTS_FORMAT, TestRun};
use recrash_model::rollout::TerminationKind;

fn outcome(kinds: &[FindingKind], gap_m: f64) -> TestOutcome {
    let finding = |&kind| Finding { kind, time_s: 1.0, value: 1.0, threshold: 0.0, sentence: String::new() };
    TestOutcome {
        state_hash: format!("{kinds:?} {gap_m}"),
        termination: TerminationKind::Arrived,
        duration_s: 10.0,
        findings: kinds.iter().map(finding).collect(),
        contact: None,
        least_gap: Some(Timed { value: gap_m, time_s: 1.0 }),
        severity: None,
        preventability: None,
        cause: None,
        faithful: None,
        met: None,
    }
}

fn run(kinds: &[FindingKind], gap_m: f64) -> TestRun {
    let failed = kinds.iter().any(|kind| kind.is_failure());
    let verdict = if failed { TestVerdict::Failed } else { TestVerdict::Passed };
    TestRun { seed: 1, verdict, why: None, outcome: Some(outcome(kinds, gap_m)) }
}

fn results(tests: Vec<(&str, Vec<TestRun>)>) -> TestResults {
    let test = |(id, runs): (&str, Vec<TestRun>)| TestResult {
        id: id.to_owned(),
        content: "c".to_owned(),
        about: About { crash_type: Some(CrashType::HeadOn), ..About::default() },
        runs,
    };
    TestResults {
        unrepeated: None,
        format: RESULTS_FORMAT.to_owned(),
        recrash: String::new(),
        suite: String::new(),
        profile: String::new(),
        ego: String::new(),
        simulator: String::new(),
        seeds: 1,
        tests: tests.into_iter().map(test).collect(),
    }
}

fn change(base: Vec<TestRun>, new: Vec<TestRun>) -> Change {
    compare(&results(vec![("a", base)]), &results(vec![("a", new)])).tests[0].change
}

use FindingKind::{Contact, HardBraking, NearMiss};

#[test]
fn a_test_is_broken_fixed_worse_better_or_the_same() {
    let (pass, near, crash) = (|| run(&[], 5.0), |gap| run(&[NearMiss], gap), || run(&[Contact], 0.0));
    assert_eq!(change(vec![pass()], vec![crash()]), Change::Broken);
    assert_eq!(change(vec![near(1.0)], vec![pass()]), Change::Fixed);
    assert_eq!(change(vec![near(1.0)], vec![crash()]), Change::Worse);
    assert_eq!(change(vec![crash()], vec![near(1.0)]), Change::Better);
    assert_eq!(change(vec![near(1.0)], vec![near(0.5)]), Change::Worse);
    assert_eq!(change(vec![near(1.0)], vec![near(0.95)]), Change::Same);
    assert_eq!(change(vec![pass()], vec![run(&[HardBraking], 3.0)]), Change::Worse);
    assert_eq!(change(vec![pass()], vec![run(&[], 4.0)]), Change::Same);
}

#[test]
fn who_never_came_into_the_situation_is_not_told_to_have_passed() {
    let elsewhere = || {
        let mut elsewhere = run(&[], 9.0);
        elsewhere.outcome.as_mut().unwrap().met = Some(false);
        elsewhere
    };
    let (pass, crash) = (|| run(&[], 5.0), || run(&[Contact], 0.0));
    let comparison = compare(&results(vec![("a", vec![crash()])]), &results(vec![("a", vec![elsewhere()])]));
    assert_eq!(comparison.tests[0].why, "contact, now never in the situation of its record");
    assert_eq!(comparison.tests[0].change, Change::Unmet, "a failure is not fixed by staying away");
    assert_eq!(change(vec![pass()], vec![elsewhere()]), Change::Unmet);
    assert_eq!(change(vec![elsewhere()], vec![pass()]), Change::Same, "it is there now, and passes");
    let mut brakes = elsewhere();
    brakes.outcome.as_mut().unwrap().findings = run(&[HardBraking], 9.0).outcome.unwrap().findings;
    assert_eq!(change(vec![pass()], vec![brakes]), Change::Worse, "odd behaviour is red wherever it is");
    assert_eq!(change(vec![crash(), crash()], vec![elsewhere(), pass()]), Change::Fixed, "in it once, and no failure");
    assert_eq!(change(vec![elsewhere()], vec![crash()]), Change::Broken, "a failure that nobody knew of is red");
    assert_eq!(change(vec![elsewhere()], vec![elsewhere()]), Change::Same);
}

#[test]
fn what_is_random_is_flaky_until_it_is_clear() {
    let of = |failed: usize, runs: usize| -> Vec<TestRun> {
        (0..runs).map(|at| if at < failed { run(&[Contact], 0.0) } else { run(&[], 5.0) }).collect()
    };
    assert_eq!(change(of(1, 5), of(2, 5)), Change::Flaky);
    assert_eq!(change(of(0, 5), of(5, 5)), Change::Broken);
    assert_eq!(change(of(9, 10), of(1, 10)), Change::Fixed);
    assert_eq!(change(of(0, 5), of(2, 5)), Change::Flaky);
    assert_eq!(change(of(5, 5), of(5, 5)), Change::Same);
}

#[test]
fn one_of_many_tests_has_to_be_clearer_than_one_alone() {
    let of = |failed: usize, runs: usize| -> Vec<TestRun> {
        (0..runs).map(|at| if at < failed { run(&[Contact], 0.0) } else { run(&[], 5.0) }).collect()
    };
    let names: Vec<String> = (0..20).map(|number| format!("test-{number:02}")).collect();
    let changes = |first: [(usize, usize); 2]| {
        let side = |first: (usize, usize)| {
            let runs = |at: usize| if at == 0 { of(first.0, first.1) } else { of(2, first.1) };
            results(names.iter().enumerate().map(|(at, id)| (id.as_str(), runs(at))).collect())
        };
        let comparison = compare(&side(first[0]), &side(first[1]));
        (comparison.tests[0].change, comparison.level.unwrap())
    };
    // p = 0.048: enough for one test, too little for the first of twenty.
    assert_eq!(change(of(0, 5), of(4, 5)), Change::Broken);
    assert_eq!(changes([(0, 5), (4, 5)]), (Change::Flaky, 0.0025));
    assert_eq!(changes([(1, 10), (9, 10)]), (Change::Broken, 0.0025));
}

#[test]
fn tests_that_come_go_or_are_others_are_told_apart() {
    let pass = || vec![run(&[], 5.0)];
    let base = results(vec![("a", pass()), ("b", pass()), ("c", pass())]);
    let mut new = results(vec![("b", pass()), ("c", pass()), ("d", pass())]);
    new.tests[1].content = "other".to_owned();
    new.tests[0].runs = vec![TestRun { seed: 1, verdict: TestVerdict::NotRun, why: None, outcome: None }];
    let changes: Vec<Change> = compare(&base, &new).tests.iter().map(|test| test.change).collect();
    assert_eq!(changes, [Change::Removed, Change::NotRun, Change::Changed, Change::Added]);
}

#[test]
fn a_row_counts_its_type_and_says_how_clear_the_changes_are() {
    let fail = || vec![run(&[Contact], 0.0)];
    let pass = || vec![run(&[], 5.0)];
    let names = ["a", "b", "c", "d", "e", "f"];
    let base = results(names.iter().map(|id| (*id, pass())).collect());
    let new = results(names.iter().map(|id| (*id, if *id == "f" { pass() } else { fail() })).collect());
    let comparison = compare(&base, &new);
    let [only] = &comparison.by_type[..] else { panic!("one type: {:?}", comparison.by_type) };
    assert_eq!((only.crash_type, only.tests, only.base_failed, only.new_failed), ("Head-on", 6, 0, 5));
    assert_eq!(only.changes, BTreeMap::from([(Change::Broken, 5), (Change::Same, 1)]));
    assert!((only.p - 0.0625).abs() < 1e-12, "{}", only.p);
    assert_eq!(compare(&base, &base).all.changes, BTreeMap::from([(Change::Same, 6)]));
}
