//! What `recrash run` and `recrash report` print of a suite that goes by accounts: the worst scenarios, then the result.

use super::reconstruct::not_drawn;
use super::simulate::REGULATION_DRIVERS;
use crate::output::title;
use crate::screen::{bold, one_line, println, sentence, yellow};
use crate::table::{Cell, number, table};
use recrash_model::account::CrashType;
use recrash_model::metrics::Answer;
use recrash_model::review::Review;
use recrash_pipeline::{AccountSummary, CaseSummary, Reviews, RunSummary, Shown, Summary, TestedRuns};
use std::path::Path;

/// Scenarios that the terminal lists; the page and results.csv have all.
const CASES_SHOWN: usize = 10;
/// The column of what a contact does to both.
pub(super) const DELTA_V: &str = "delta-v ego / partner [m/s]";
/// Remarks on scenarios that the terminal tells one by one.
const REMARKS_SHOWN: usize = 5;
/// Longest reason that it tells with one. [characters]
const LONGEST_WHY: usize = 300;

/// How a scenario ended for the system under test, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    /// It failed, and was not struck while it stood.
    Fail,
    /// It failed, and stood when it was struck.
    Struck,
    /// It did not fail, where it came into the situation of the record.
    Pass,
    /// It did not fail, and never came into that situation: no pass.
    NotMet,
    /// It was parked: nothing to test.
    Parked,
    /// It could not be run.
    NotRun,
}

impl Verdict {
    fn of(case: &CaseSummary) -> Self {
        match case.last_run() {
            Some(run) if run.struck_standing() => Self::Struck,
            Some(run) if run.failed => Self::Fail,
            Some(_) if case.situation_met == Some(false) => Self::NotMet,
            Some(_) => Self::Pass,
            None if case.recorded.is_some() && case.failure.is_none() => Self::Parked,
            None => Self::NotRun,
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::Fail => "FAIL",
            Self::Struck => "STRUCK",
            Self::Pass => "PASS",
            Self::NotMet => "NOT MET",
            Self::Parked => "parked",
            Self::NotRun => "NOT RUN",
        }
    }
}

/// The worst first: by verdict, in the situation of the record before others, by the larger change of velocity, by the gap.
fn worst_first(cases: &[CaseSummary]) -> Vec<&CaseSummary> {
    let harm = |case: &CaseSummary| case.last_run().map_or(0.0, RunSummary::harm_mps);
    let gap = |case: &CaseSummary| case.last_run().and_then(|run| run.min_gap_m).unwrap_or(f64::MAX);
    let mut ranked: Vec<&CaseSummary> = cases.iter().collect();
    ranked.sort_by(|a, b| {
        let group = |case: &CaseSummary| (Verdict::of(case), case.situation_met != Some(true));
        group(a).cmp(&group(b)).then(harm(b).total_cmp(&harm(a))).then(gap(a).total_cmp(&gap(b)))
    });
    ranked
}

/// What led to the failure, or its kind where no rule tells.
fn what_failed(case: &CaseSummary) -> String {
    let Some(run) = case.last_run().filter(|run| run.failed) else { return "-".into() };
    run.cause.map_or_else(|| run.findings_in_words(), |cause| cause.label().to_owned())
}

/// In which run it fails first.
fn found(case: &CaseSummary) -> &'static str {
    match case.last_run() {
        Some(run) if run.failed && case.found_by_tuning() => "by tuning",
        Some(run) if run.failed => "as is",
        _ => "-",
    }
}

fn delta_v(run: Option<&RunSummary>) -> String {
    run.and_then(|run| run.delta_v_mps).map_or("-".into(), |[ego, partner]| format!("{ego:.1} / {partner:.1}"))
}

/// Prints a run of a suite that goes by accounts.
pub fn show(summary: &Summary, accounts: &AccountSummary, dir: &Path) {
    remarks(summary);
    worst(&summary.cases, summary.reviews().is_some());
    result(summary);
    let whole: usize = accounts.types.iter().map(|share| share.whole).sum();
    sentence(&format!(
        "records: {} of {} readable incidents reconstructed: {whole} show every stated fact, {} contradict none but leave some undrawn; {}; \
         invented: 0",
        accounts.told,
        accounts.readable,
        accounts.told.saturating_sub(whole),
        in_this_suite(&summary.shown()),
    ));
    sentence(&format!("  {}", not_drawn(&accounts.facts)));
    restagings(summary);
    reviews(summary);
    if summary.sample {
        println!("  the built-in sample, invented; give real crash files with --records FILE");
    }
    println!(
        "report: {} (every scenario, crash types, why others are not reconstructed)",
        dir.join("report.html").display()
    );
}

/// How many scenarios of the suite show their crash by its own runs.
fn in_this_suite(shown: &Shown) -> String {
    let Shown { as_told, not_as_told, not_run } = *shown;
    let all = as_told + not_as_told + not_run;
    if as_told == all {
        return format!("{all} are in this suite");
    }
    let not_as_told = also(", ", not_as_told, "not as told");
    format!("{as_told} of the {all} in this suite show it{not_as_told}{}", also(", ", not_run, "not run"))
}

/// A count with its words, where there is any.
fn also(before: &str, count: usize, words: &str) -> String {
    if count > 0 { format!("{before}{count} {words}") } else { String::new() }
}

/// Why scenarios were not run: the reason of the first.
fn why_not_run(summary: &Summary) -> String {
    let first = summary.failures().next();
    first.map_or_else(String::new, |(_, failure)| {
        let why: String = failure.to_string().chars().take(LONGEST_WHY).collect();
        format!("not run ({})", one_line(&why))
    })
}

/// What the model made of the replays that changes scenarios.
fn restagings(summary: &Summary) {
    let Some((model, [as_staged, changed, not_content])) = summary.restagings() else { return };
    let looked_at = as_staged + changed + not_content;
    let stay = if not_content == 0 {
        String::new()
    } else {
        format!(
            "; {not_content} stay as the rules staged them, or untold, since nothing usable came of its answers (summary.json says why)"
        )
    };
    sentence(&format!(
        "{model} was asked about {looked_at} replays of what the rules staged: {as_staged} are as told, {changed} it changed{stay}"
    ));
}

/// What the model finds that holds replays against reports.
fn reviews(summary: &Summary) {
    let Some(Reviews { model, read, right, wrong }) = summary.reviews() else { return };
    let named: Vec<String> = wrong.iter().map(|(name, count)| format!("{name} {count}")).collect();
    let named = if named.is_empty() { String::new() } else { format!(": {}", named.join(", ")) };
    let show = if right == 1 { "shows it" } else { "show them" };
    let do_not = if read - right == 1 { "does not" } else { "do not" };
    sentence(&format!(
        "{model} reads {read} replays beside their reports: {right} {show}, {} {do_not}{named}",
        read - right
    ));
    for model in summary.models.iter().filter(|model| model.is_review()) {
        for reason in model.reasons.iter().take(REMARKS_SHOWN) {
            let why: String = reason.why.chars().take(LONGEST_WHY).collect();
            println!("  {} {}: {}", yellow("not reviewed:"), reason.id, one_line(&why));
        }
    }
}

/// Scenarios that were not run, or are not as told.
fn remarks(summary: &Summary) {
    let told = |case: &CaseSummary| {
        if let Some(failure) = &case.failure {
            let what = if case.unanswered().is_some() { "not answered:" } else { "not run:" };
            return Some(format!("{} {}: {failure}", yellow(what), case.id));
        }
        let why = case.recorded.as_ref().map_or_else(String::new, |run| run.unfaithful.join("; "));
        (case.faithful() == Some(Answer::No)).then(|| format!("{} {}: {why}", yellow("not as told:"), case.id))
    };
    let told: Vec<String> = summary.cases.iter().filter_map(told).collect();
    for line in told.iter().take(REMARKS_SHOWN) {
        println!("  {line}");
    }
    if told.len() > REMARKS_SHOWN {
        println!("  and {} more, on the page", told.len() - REMARKS_SHOWN);
    }
}

/// The scenarios in a table, the worst first; with what was found beside their reports, where somebody read.
fn worst(cases: &[CaseSummary], reviewed: bool) {
    title(&format!("Scenarios, the worst {} of {}", CASES_SHOWN.min(cases.len()), cases.len()));
    let mut header = vec!["verdict", "scenario", "what failed", "found", DELTA_V, "situation", "crash type", "as told"];
    header.extend(reviewed.then_some("read"));
    let spare = ["as told", "crash type", "situation", "found", DELTA_V, "read"];
    let mut rows = table(&header).named_by("scenario").whole("what failed").without_first(&spare);
    let worst: Vec<&CaseSummary> = worst_first(cases).into_iter().take(CASES_SHOWN).collect();
    for case in &worst {
        let as_told = match case.faithful() {
            Some(Answer::Yes) => "yes",
            Some(Answer::Unchecked) => "not all checked",
            Some(Answer::No) => "NO",
            None => "NOT RUN",
        };
        let situation = match case.situation_met {
            Some(true) => "met",
            Some(false) => "not met",
            None if Verdict::of(case) == Verdict::Parked => "parked",
            None => "-",
        };
        let mut row = vec![
            Cell::new(Verdict::of(case).label()),
            Cell::new(&case.id),
            Cell::new(what_failed(case)),
            Cell::new(found(case)),
            number(delta_v(case.last_run())),
            Cell::new(situation),
            Cell::new(case.crash_type.map_or("", CrashType::label)),
            Cell::new(as_told),
        ];
        row.extend(reviewed.then(|| Cell::new(case.review.as_ref().map_or("-", Review::label))));
        rows.add_row(row);
    }
    println!("{rows}");
    let shown = |verdict| worst.iter().any(|case| Verdict::of(case) == verdict);
    if shown(Verdict::Struck) {
        sentence("  STRUCK: it failed, and had stood for a second when it was struck: seldom by what it drove");
    }
    if shown(Verdict::NotMet) {
        sentence("  NOT MET: it never came into the situation of the record: no failure, and no pass");
    }
    if rows.shows("found") {
        sentence("  found: as is, in the crash as reconstructed; by tuning, only within what the report leaves open");
    }
}

fn failures(runs: &TestedRuns) -> String {
    let total = runs.failures.total();
    let of = format!("{total} of {}", runs.met);
    if total == 0 { of } else { format!("{of}: {}", runs.failures) }
}

/// That the ego does not repeat, where it drove one scenario in two ways.
pub fn unrepeated(summary: &Summary) {
    let cases: Vec<&str> = summary.cases.iter().filter(|case| case.unrepeated).map(|case| case.id.as_str()).collect();
    if let Some(first) = cases.first() {
        let others = if cases.len() > 1 { format!(" and {} others", cases.len() - 1) } else { String::new() };
        sentence(&format!(
            "{} the ego does not repeat: it drove {first}{others} twice, and otherwise the second time; what it fails may pass the next time",
            yellow("warning:")
        ));
    }
}

fn result(summary: &Summary) {
    let count = |holds: &dyn Fn(&CaseSummary) -> bool| summary.cases.iter().filter(|case| holds(case)).count();
    let [first, last] = summary.tested();
    let parked = count(&|case| Verdict::of(case) == Verdict::Parked);
    let not_run = count(&|case| Verdict::of(case) == Verdict::NotRun);
    let unanswered = count(&|case| case.unanswered().is_some());
    println!("\n{} {} fails, where it came into the situation of the record,", bold("result:"), summary.ego);
    sentence(&format!("  as reconstructed, from the handover on: {}", failures(&first)));
    // With a budget of one point nothing was searched.
    let searched = summary.cases.iter().any(|case| case.points > 1);
    if searched {
        sentence(&format!(
            "  after tuning within what reports leave open: {}; {} by tuning alone",
            failures(&last),
            count(&CaseSummary::found_by_tuning)
        ));
    }
    let outside = count(&|case| case.situation_met == Some(false) && case.last_run().is_some_and(|run| run.failed));
    sentence(&format!(
        "  {} scenarios: {} driven, {} of them never in the situation{}{}{}{}",
        summary.cases.len(),
        last.ran,
        last.ran - last.met,
        also(", where ", outside, "failed in another way"),
        also("; ", unanswered, "driven as reconstructed, with no answer after that"),
        also("; ", parked, "parked, nothing to test"),
        also("; ", not_run, &why_not_run(summary)),
    ));
    if last.beyond_tyres > 0 {
        sentence(&format!(
            "  in {} of the {} that it passes it brakes harder than tyres can, so that a real vehicle might not pass",
            last.beyond_tyres,
            last.met - last.failures.total()
        ));
    }
    let edited = count(&|case| !case.edited.is_empty());
    if edited > 0 {
        println!("  {edited} edited by hand, and kept");
    }
    unrepeated(summary);
    let listed = |counts: Vec<(&str, usize)>| {
        let listed: Vec<String> = counts.into_iter().map(|(label, count)| format!("{label} {count}")).collect();
        listed.join(", ")
    };
    let causes = summary.causes();
    if !causes.is_empty() {
        // Here all count, also those outside the situation.
        let of_all = also(", of all ", causes.iter().map(|(_, count)| count).sum(), "failures");
        let of_all = if outside > 0 { of_all } else { String::new() };
        let causes = causes.iter().map(|(cause, count)| (cause.label(), *count)).collect();
        let when = if searched { "after tuning, by cause" } else { "by cause" };
        sentence(&format!("{when}{of_all}: {}", listed(causes)));
        let untold = count(&|case| case.triage.is_none() && case.last_run().is_some_and(|run| run.failed));
        let classes = summary.failure_classes().into_iter().map(|(class, count)| (class.label(), count));
        let classes = classes.chain((untold > 0).then_some(("not answered", untold))).collect();
        sentence(&format!("  other egos in the same scenario: {}", listed(classes)));
        let brackets = summary.brackets().into_iter().map(|(bracket, count)| (bracket.label(), count)).collect();
        sentence(&format!("  of contacts, {REGULATION_DRIVERS}: {}", listed(brackets)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::cause::Failures;

    #[test]
    fn a_suite_counts_its_own_runs() {
        let shown = |as_told, not_as_told, not_run| in_this_suite(&Shown { as_told, not_as_told, not_run });
        assert_eq!(shown(60, 0, 0), "60 are in this suite");
        assert_eq!(shown(58, 1, 1), "58 of the 60 in this suite show it, 1 not as told, 1 not run");
    }

    #[test]
    fn failures_come_before_those_that_struck_a_standing_ego_and_who_was_struck_as_it_slowed_is_counted_apart() {
        assert!(Verdict::Fail < Verdict::Struck && Verdict::Struck < Verdict::Pass && Verdict::Pass < Verdict::Parked);
        let counted = Failures { struck_standing: 12, struck_moving: 9, otherwise: 17 };
        let told = failures(&TestedRuns { ran: 54, met: 51, failures: counted, beyond_tyres: 0 });
        let words = "38 of 51: 12 struck while it stood, 9 struck from behind or beside while it moved or had just stopped, 17 otherwise";
        assert_eq!(told, words);
    }
}
