//! The headline numbers, computed once, so that no two places of the report can disagree.

use crate::view::{CaseRow, RunRow, SuiteView};
use recrash_model::cause::{Cause, Failures};
use recrash_model::metrics::Answer;
use recrash_model::run::Judgement;
use recrash_model::triage::FailureClass;

/// How a run ended for the ego.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Result {
    /// It failed, and was not struck while it stood.
    Failed,
    /// It failed, and stood in its own way when it was struck: seldom by what it drove.
    Struck,
    /// It did not.
    Passed,
    /// It did not, and never came into the situation of its record: no pass.
    NotMet,
    /// There is no run.
    Missing,
}

impl Result {
    /// Of a run.
    pub fn of(run: Option<&Judgement>) -> Self {
        match run {
            Some(run) if struck_standing(run) => Self::Struck,
            Some(run) if run.failed() => Self::Failed,
            Some(run) if run.situation_met() == Some(false) => Self::NotMet,
            Some(_) => Self::Passed,
            None => Self::Missing,
        }
    }

    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Failed => "fails",
            Self::Struck => "struck standing",
            Self::Passed => "passes",
            Self::NotMet => "not met",
            Self::Missing => "not run",
        }
    }
}

/// Whether the ego failed by being struck while it stood, seldom by what it drove.
pub fn struck_standing(run: &Judgement) -> bool {
    run.failed() && run.cause == Some(Cause::StruckStanding)
}

/// Runs of the system under test.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tested {
    /// Runs.
    pub ran: usize,
    /// Of those, runs that came into the situation of the record.
    pub met: usize,
    /// Of those, failures.
    pub failures: Failures,
    /// Of those that came into the situation and did not fail, runs in which the ego brakes harder than tyres let a vehicle.
    pub beyond_tyres: usize,
}

impl Tested {
    fn of<'a>(runs: impl Iterator<Item = &'a RunRow>) -> Self {
        let runs: Vec<&RunRow> = runs.collect();
        let met: Vec<&RunRow> = runs.iter().copied().filter(|run| run.situation_met() == Some(true)).collect();
        let failures = Failures::of(met.iter().filter(|run| run.failed()).map(|run| run.cause));
        let beyond_tyres = met.iter().filter(|run| !run.failed() && run.brakes_beyond_tyres()).count();
        Self { ran: runs.len(), met: met.len(), failures, beyond_tyres }
    }

    /// Runs that came into the situation and did not fail.
    pub fn passed(&self) -> usize {
        self.met - self.failures.total()
    }
}

/// Headline numbers of a suite. "After" is the last run of each case: the tuned one, or the one as designed where tuning
/// kept it.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Data rows of all files.
    pub rows: usize,
    /// Records the profile can use.
    pub usable: usize,
    /// Scenarios.
    pub cases: usize,
    /// Scenarios that ran.
    pub ran: usize,
    /// Scenarios that were refused.
    pub refused: usize,
    /// Scenarios that tell their own record, another one, and nobody's crash.
    pub origins: [usize; 3],
    /// Scenarios with nothing to test: who was parked has nothing to answer for.
    pub parked: usize,
    /// In a suite that goes by accounts: the system under test in the crashes as reconstructed, and after tuning.
    pub tested: [Tested; 2],
    /// Whether tuning kept another scenario than the first anywhere.
    pub tuned: bool,
    /// Scenarios that the system under test fails after tuning alone.
    pub by_tuning: usize,
    /// Scenarios that tell their own record and whose run shows every fact told.
    pub own_faithful: usize,
    /// Scenarios that tell their own record and whose last run shows something else.
    pub own_unfaithful: usize,
    /// Scenarios without the run that is held against the record.
    pub own_not_run: usize,
    /// Scenarios that tell another record and whose last run shows every fact told.
    pub other_faithful: usize,
    /// Scenarios in which a person edited a file.
    pub edited: usize,
    /// Scenarios the ego fails before tuning: as designed, or as reconstructed.
    pub failed_before: usize,
    /// Scenarios the ego fails after tuning.
    pub failed_after: usize,
    /// Failures after tuning of each class that has any.
    pub classes: Vec<(FailureClass, usize)>,
    /// Scenarios that passed as designed and have a smaller least gap after tuning.
    pub closer: usize,
    /// Median of the least gaps as designed. [m]
    pub median_before_m: Option<f64>,
    /// Median of the least gaps after tuning. [m]
    pub median_after_m: Option<f64>,
}

impl Summary {
    /// Of a suite.
    pub fn of(suite: &SuiteView) -> Self {
        let count = |holds: &dyn Fn(&CaseRow) -> bool| suite.cases.iter().filter(|case| holds(case)).count();
        let fails = |case: &CaseRow| case.last_run().is_some_and(|run| run.failed());
        let tells = |case: &CaseRow, name: &str| case.origin.as_ref().is_some_and(|origin| origin.name() == name);
        let answers = |case: &CaseRow, answer| case.faithful() == Some(answer);
        // By accounts failures are counted where the situation of the record was met.
        let counts = |case: &CaseRow| case.account.is_none() || case.situation_met() == Some(true);
        let gaps = |of: &dyn Fn(&CaseRow) -> Option<f64>| median(suite.cases.iter().filter_map(of).collect());
        Self {
            rows: suite.records.files.iter().map(|file| file.rows).sum(),
            usable: suite.records.usable.len(),
            cases: suite.cases.len(),
            ran: count(&|case| case.last_run().is_some()),
            refused: count(&|case| case.refused.is_some()),
            origins: ["own", "other", "invented"].map(|name| count(&|case| tells(case, name))),
            parked: count(&|case| case.account.is_some() && case.before.is_some() && case.after.is_none()),
            tested: [CaseRow::first_run, CaseRow::last_run]
                .map(|run: fn(&CaseRow) -> Option<&RunRow>| Tested::of(suite.cases.iter().filter_map(run))),
            tuned: suite.cases.iter().any(CaseRow::is_tuned),
            by_tuning: count(&CaseRow::found_by_tuning),
            own_faithful: count(&|case| tells(case, "own") && answers(case, Answer::Yes)),
            own_unfaithful: count(&|case| tells(case, "own") && answers(case, Answer::No)),
            own_not_run: count(&|case| case.telling_run().is_none()),
            other_faithful: count(&|case| tells(case, "other") && answers(case, Answer::Yes)),
            edited: count(&|case| !case.edited.is_empty()),
            failed_before: count(&|case| case.first_run().is_some_and(|run| run.failed())),
            failed_after: count(&fails),
            classes: FailureClass::ALL
                .into_iter()
                .map(|class| {
                    (
                        class,
                        count(&|case| counts(case) && case.triage.as_ref().is_some_and(|triage| triage.class == class)),
                    )
                })
                .filter(|(_, count)| *count > 0)
                .collect(),
            closer: count(&|case| closer(case) == Some(true)),
            median_before_m: gaps(&|case| case.first_run()?.min_gap_m()),
            median_after_m: gaps(&|case| case.last_run()?.min_gap_m()),
        }
    }

    /// Scenarios that ran and passed as designed.
    pub fn passed_before(&self) -> usize {
        self.ran - self.failed_before
    }
}

/// Whether tuning brought the partner closer, where the ego did not fail as designed.
fn closer(case: &CaseRow) -> Option<bool> {
    let (before, after) = (case.first_run().filter(|_| case.is_tuned())?, case.after.as_ref()?);
    Some(!before.failed() && after.min_gap_m()? < before.min_gap_m()?)
}

/// The median: the middle value, or the mean of the two in the middle.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        n if n.is_multiple_of(2) => Some(0.5 * (values[middle - 1] + values[middle])),
        _ => Some(values[middle]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!(median(vec![]), None);
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
    }
}
