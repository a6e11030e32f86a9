//! JUnit XML, in the form that Jenkins, GitLab and GitHub actions read.

use crate::results::other_egos;
use crate::view::{CaseRow, RunRow, SuiteView};
use crate::words::{self, fixed};
use recrash_model::metrics::{Answer, Check};
use recrash_model::triage::Triage;
use std::fmt::Write;

/// The document.
pub fn render(suite: &SuiteView) -> String {
    let designed: Vec<String> =
        suite.cases.iter().map(|case| test_case(suite, case, case.before.as_ref(), "as designed")).collect();
    let tuned: Vec<&CaseRow> = suite.cases.iter().filter(|case| case.after.is_some()).collect();
    let tuned_cases: Vec<String> =
        tuned.iter().map(|case| test_case(suite, case, case.after.as_ref(), "tuned")).collect();
    let failed = |run: Option<&RunRow>| usize::from(run.is_some_and(|run| run.failed()));
    let failed_designed: usize = suite.cases.iter().map(|case| failed(case.before.as_ref())).sum();
    let failed_tuned: usize = tuned.iter().map(|case| failed(case.after.as_ref())).sum();
    let skipped = suite.cases.iter().filter(|case| case.before.is_none()).count();
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<testsuites name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{skipped}\">",
        escape(&suite.title),
        suite.cases.len() + tuned.len(),
        failed_designed + failed_tuned
    );
    for (name, cases, failures, skipped) in
        [("as designed", designed, failed_designed, skipped), ("tuned", tuned_cases, failed_tuned, 0)]
    {
        let _ = writeln!(
            text,
            "  <testsuite name=\"{name}\" tests=\"{}\" failures=\"{failures}\" errors=\"0\" skipped=\"{skipped}\">",
            cases.len()
        );
        text.push_str("    <properties>\n");
        let settings = [
            ("profile", suite.profile.name.clone()),
            ("ego", suite.ego.clone()),
            ("simulator", suite.simulator.clone()),
            ("agents", suite.agents.clone()),
            ("seed", suite.seed.to_string()),
            ("command", suite.command.clone()),
            ("generator", suite.generated_by.clone()),
        ];
        for (name, value) in settings {
            let _ = writeln!(text, "      <property name=\"{name}\" value=\"{}\"/>", escape(&value));
        }
        text.push_str("    </properties>\n");
        text.extend(cases);
        text.push_str("  </testsuite>\n");
    }
    text.push_str("</testsuites>\n");
    text
}

fn test_case(suite: &SuiteView, case: &CaseRow, run: Option<&RunRow>, name: &str) -> String {
    let time = run.and_then(|run| fixed(run.metrics.duration_s, 3)).unwrap_or_else(|| "0".to_owned());
    let mut text = format!(
        "    <testcase classname=\"recrash.{}.{}\" name=\"{}\" time=\"{time}\">\n",
        escape(&suite.profile.name),
        name.replace(' ', "-"),
        escape(&case.scenario_id)
    );
    match run {
        None => {
            let why = case.refused.as_deref().unwrap_or("it was not run");
            let _ = writeln!(text, "      <skipped message=\"{}\"/>", escape(why));
        }
        Some(run) => {
            if run.failed() {
                let failures: Vec<_> = run.findings.iter().filter(|finding| finding.kind.is_failure()).collect();
                let kinds: Vec<_> = failures.iter().map(|finding| finding.kind.label()).collect();
                let sentences: Vec<_> = failures.iter().map(|finding| escape(&finding.sentence)).collect();
                let class = triage_of(case, run).map_or_else(String::new, |t| format!(" ({})", t.class.label()));
                let _ = writeln!(
                    text,
                    "      <failure type=\"{}\" message=\"{}{class}\">{}</failure>",
                    kinds.first().copied().unwrap_or_default(),
                    escape(&kinds.join(", ")),
                    sentences.join("\n")
                );
            }
            let _ = writeln!(text, "      <system-out>{}</system-out>", escape(&told(case, run)));
        }
    }
    text.push_str("    </testcase>\n");
    text
}

/// The triage, which is about the last run.
fn triage_of<'a>(case: &'a CaseRow, run: &RunRow) -> Option<&'a Triage> {
    case.triage.as_ref().filter(|_| case.last_run().is_some_and(|last| std::ptr::eq(run, last)))
}

/// What a person reads when the test has failed.
fn told(case: &CaseRow, run: &RunRow) -> String {
    let gap = run
        .min_gap_m()
        .and_then(|gap| fixed(gap, 2))
        .map_or("no gap was measured".to_owned(), |gap| format!("{gap} m"));
    let checked =
        |check: &Check| format!("{}: expected {}, observed {}", check.kind.label(), check.expected, check.observed);
    let listed = |answer: Answer, checks: Vec<&Check>| {
        format!("{} ({})", answer.label(), checks.into_iter().map(checked).collect::<Vec<_>>().join("; "))
    };
    let faithful = match case.faithful().map(|_| run.faithful()) {
        None => "there is no record to be true to".to_owned(),
        Some(Answer::Yes) => Answer::Yes.label().to_owned(),
        Some(Answer::Unchecked) => listed(Answer::Unchecked, run.verdict.unchecked().collect()),
        Some(Answer::No) => listed(Answer::No, run.verdict.failures().collect()),
    };
    let origin = words::provenance(case.origin.as_ref(), case.told.as_ref());
    let others = triage_of(case, run).map_or_else(String::new, |triage| {
        format!("\n{}: {}\nother egos: {}", triage.class.label(), triage.class.meaning(), other_egos(triage))
    });
    let edited = match &case.edited[..] {
        [] => String::new(),
        files => format!("\nedited by hand: {}", files.join(", ")),
    };
    format!(
        "template: {}\ntells: {origin}\nleast gap: {gap}\nended by: {}\nfaithful: {faithful}{others}{edited}\nagain: {}",
        case.template,
        words::name(&run.metrics.termination),
        run.rerun_command
    )
}

/// Text for XML 1.0, which has no way to write most control characters.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in words::clean(text, words::LONGEST_TEXT).chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&apos;"),
            '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            _ => escaped.push(letter),
        }
    }
    escaped
}
