//! Two results of one frozen suite, test by test. Defined in `docs/models/comparison.md`.

mod exact;

use recrash_model::account::CrashType;
use recrash_model::comparison::{COMPARISON_FORMAT, Change, Compared, Comparison, Side, TypeRow};
use recrash_model::metrics::FindingKind;
use recrash_model::results::{TestOutcome, TestResult, TestResults, TestVerdict};
use std::collections::{BTreeMap, BTreeSet};

/// A change of delta-v in a contact that counts. Assumed: half the step that risk curves are told in. [m/s]
pub const HARM_MPS: f64 = 0.5;
/// A change of the least gap of a near miss that counts. Assumed: what two simulators differ by. [m]
pub const GAP_M: f64 = 0.1;
/// Of the tests whose shares of failures are told to differ, at most this share does so by chance.
pub const FALSE_CHANGES: f64 = 0.05;

/// Compares two results.
pub fn compare(base: &TestResults, new: &TestResults) -> Comparison {
    let by_id = |results: &TestResults| -> BTreeMap<String, usize> {
        results.tests.iter().enumerate().map(|(place, test)| (test.id.clone(), place)).collect()
    };
    let (before, now) = (by_id(base), by_id(new));
    let ids: BTreeSet<&String> = before.keys().chain(now.keys()).collect();
    let pair = |id: &String| [before.get(id).map(|&at| &base.tests[at]), now.get(id).map(|&at| &new.tests[at])];
    let chances = ids.iter().filter_map(|id| match pair(id) {
        [Some(old), Some(fresh)] => chance(old, fresh),
        _ => None,
    });
    let level = exact::benjamini_hochberg(chances.collect(), FALSE_CHANGES);
    let tests: Vec<Compared> = ids.iter().map(|id| one(id, pair(id), level)).collect();
    let types = CrashType::ALL.into_iter().map(Some).chain([None]);
    let of_type = |kind: Option<CrashType>| {
        let members: Vec<&Compared> = tests.iter().filter(|test| test.crash_type == kind).collect();
        (!members.is_empty()).then(|| row(kind.map_or("not stated", CrashType::label), &members))
    };
    Comparison {
        format: COMPARISON_FORMAT,
        egos: [base.ego.clone(), new.ego.clone()],
        simulators: [base.simulator.clone(), new.simulator.clone()],
        suites: [base.suite.clone(), new.suite.clone()],
        level,
        all: row("all", &tests.iter().collect::<Vec<_>>()),
        by_type: types.filter_map(of_type).collect(),
        tests,
    }
}

fn row(crash_type: &'static str, tests: &[&Compared]) -> TypeRow {
    let mut changes = BTreeMap::new();
    for test in tests {
        *changes.entry(test.change).or_default() += 1;
    }
    let count = |change: Change| changes.get(&change).copied().unwrap_or(0);
    let failed = |side: fn(&Compared) -> Option<&Side>| {
        tests.iter().filter(|test| side(test).is_some_and(|side| side.failures > 0)).count()
    };
    TypeRow {
        crash_type,
        tests: tests.len(),
        base_failed: failed(|test| test.base.as_ref()),
        new_failed: failed(|test| test.new.as_ref()),
        p: exact::mcnemar(count(Change::Broken), count(Change::Fixed)),
        changes,
    }
}

fn one(id: &str, [base, new]: [Option<&TestResult>; 2], level: Option<f64>) -> Compared {
    let crash_type = new.or(base).and_then(|test| test.about.crash_type);
    let (change, why, p) = match (base, new) {
        (Some(base), Some(new)) if base.content != new.content => {
            (Change::Changed, "its scenario is another one".to_owned(), None)
        }
        (Some(base), Some(new)) => verdict(base, new, level),
        (None, _) => (Change::Added, "the baseline has no such test".to_owned(), None),
        (_, None) => (Change::Removed, "only the baseline has such a test".to_owned(), None),
    };
    let identical = match (base, new) {
        (Some(base), Some(new)) => hashes(base) == hashes(new),
        _ => false,
    };
    let (base, new) = (base.map(side), new.map(side));
    Compared { id: id.to_owned(), crash_type, change, why, base, new, p, identical }
}

fn outcomes(test: &TestResult) -> impl Iterator<Item = &TestOutcome> {
    test.runs.iter().filter_map(|run| run.outcome.as_ref())
}

fn hashes(test: &TestResult) -> Vec<Option<&str>> {
    test.runs.iter().map(|run| run.outcome.as_ref().map(|outcome| outcome.state_hash.as_str())).collect()
}

fn side(test: &TestResult) -> Side {
    let telling = test.telling().and_then(|run| run.outcome.as_ref());
    Side {
        runs: outcomes(test).count(),
        failures: test.failures(),
        findings: telling.map(TestOutcome::kinds).unwrap_or_default(),
        least_gap_m: telling.and_then(|outcome| outcome.least_gap).map(|gap| gap.value),
        delta_v_mps: telling.map_or(0.0, TestOutcome::harm_mps),
    }
}

/// Failures and runs.
fn counts(test: &TestResult) -> [usize; 2] {
    [test.failures(), test.runs.len()]
}

/// How probable it is by chance that the shares of failures differ so; `None` where nothing is random or comparable.
fn chance(base: &TestResult, new: &TestResult) -> Option<f64> {
    let all_ran = |test: &TestResult| test.runs.iter().all(|run| run.verdict != TestVerdict::NotRun);
    let is_random = base.runs.len() > 1 || new.runs.len() > 1;
    // Who stays away from the situation does not fail less by chance.
    let stays_away = new.never_met() && !base.never_met();
    (is_random && !stays_away && base.content == new.content && all_ran(base) && all_ran(new))
        .then(|| exact::fisher(counts(base), counts(new)))
}

/// What became of a test that ran on both sides, why, and how probable that is by chance.
fn verdict(base: &TestResult, new: &TestResult, level: Option<f64>) -> (Change, String, Option<f64>) {
    for (test, which) in [(base, "the baseline"), (new, "this run")] {
        if let Some(run) = test.runs.iter().find(|run| run.verdict == TestVerdict::NotRun) {
            let why = run.why.as_deref().unwrap_or("no reason is told");
            return (Change::NotRun, format!("in {which}: {why}"), None);
        }
    }
    let (before, now) = (counts(base), counts(new));
    let told = |test: &TestResult, [failures, runs]: [usize; 2]| match (failures, telling(test)) {
        (0, _) if test.never_met() => "never in the situation of its record".to_owned(),
        (0, _) => "passed".to_owned(),
        (_, Some(outcome)) if runs == 1 => failed_how(outcome),
        _ => format!("failed {failures} of {runs}"),
    };
    let shares = format!("{}, now {}", told(base, before), told(new, now));
    if new.never_met() && !base.never_met() {
        // It may behave oddly as well.
        return match degree(base, new) {
            (Change::Worse, why) if before[0] == 0 => (Change::Worse, why, None),
            _ => (Change::Unmet, shares, None),
        };
    }
    let p = chance(base, new);
    let all = |[failures, runs]: [usize; 2]| failures == runs;
    let none = |[failures, _]: [usize; 2]| failures == 0;
    let clear = |p: Option<f64>| p.zip(level).is_some_and(|(p, level)| p <= level);
    let rises = now[0] * before[1] > before[0] * now[1];
    let falls = now[0] * before[1] < before[0] * now[1];
    if none(before) && all(now) || rises && clear(p) {
        (Change::Broken, shares, p)
    } else if all(before) && none(now) || falls && clear(p) {
        (Change::Fixed, shares, p)
    } else if [before, now].into_iter().any(|side| !all(side) && !none(side)) {
        (Change::Flaky, shares, p)
    } else {
        let (change, why) = degree(base, new);
        (change, why, p)
    }
}

fn telling(test: &TestResult) -> Option<&TestOutcome> {
    test.telling().and_then(|run| run.outcome.as_ref())
}

/// The failures of a run, and how fast the contact was.
fn failed_how(outcome: &TestOutcome) -> String {
    let kinds = outcome.kinds();
    let speed = outcome.contact.as_ref().map(|contact| format!(" at {:.1} m/s", contact.relative_speed_mps));
    let told = |kind: &FindingKind| match (kind, &speed) {
        (FindingKind::Contact, Some(speed)) => format!("{}{speed}", kind.label()),
        _ => kind.label().to_owned(),
    };
    kinds.iter().filter(|kind| kind.is_failure()).map(told).collect::<Vec<_>>().join(", ")
}

/// Whether a test of one verdict is worse or better than it was.
fn degree(base: &TestResult, new: &TestResult) -> (Change, String) {
    let (Some(before), Some(now)) = (telling(base), telling(new)) else { return (Change::Same, String::new()) };
    let by = |worse: bool, why: String| (if worse { Change::Worse } else { Change::Better }, why);
    let rank = |outcome: &TestOutcome| {
        let kinds = outcome.kinds();
        let failures = || kinds.iter().filter(|kind| kind.is_failure());
        if failures().any(|kind| kind.is_crash()) { 2 } else { usize::from(failures().next().is_some()) }
    };
    if rank(before) != rank(now) {
        return by(rank(now) > rank(before), format!("{}, now {}", failed_how(before), failed_how(now)));
    }
    let harm = now.harm_mps() - before.harm_mps();
    if harm.abs() > HARM_MPS {
        let why = format!("delta-v {:.1} m/s, now {:.1} m/s", before.harm_mps(), now.harm_mps());
        return by(harm > 0.0, why);
    }
    if rank(now) == 1
        && let (Some(was), Some(is)) = (before.least_gap, now.least_gap)
        && (is.value - was.value).abs() > GAP_M
    {
        return by(is.value < was.value, format!("least gap {:.2} m, now {:.2} m", was.value, is.value));
    }
    let kinds = |outcome: &TestOutcome| outcome.kinds().into_iter().collect::<BTreeSet<FindingKind>>();
    let (was, is) = (kinds(before), kinds(now));
    let labels = |kinds: Vec<&FindingKind>| kinds.iter().map(|kind| kind.label()).collect::<Vec<_>>().join(", ");
    let (more, less): (Vec<_>, Vec<_>) = (is.difference(&was).collect(), was.difference(&is).collect());
    match (more.is_empty(), less.is_empty()) {
        (false, true) => by(true, format!("{} as well", labels(more))),
        (true, false) => by(false, format!("no {} any more", labels(less))),
        _ => (Change::Same, String::new()),
    }
}

#[cfg(test)]
mod tests;
