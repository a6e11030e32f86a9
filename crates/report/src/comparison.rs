//! Results and their comparison for continuous integration: JUnit, annotations of GitHub, a summary in Markdown.
//!
//! A failure that the baseline had already is no news: in JUnit it is skipped, with what is known of it, and only what
//! got worse is red.

use crate::junit::{attributes, safe};
use crate::words::fixed;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use recrash_model::comparison::{Change, Compared, Comparison, Side, shown_p};
use recrash_model::results::{TestResult, TestResults, TestVerdict};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Tests that a summary tells one by one, of each change.
const TOLD: usize = 30;
/// Annotations of one level that GitHub shows of a step.
const ANNOTATED: usize = 10;

/// How a test stands in continuous integration.
enum Standing<'a> {
    Passed,
    Red(&'a str),
    Known(String),
    Error(&'a str),
}

/// How a test stands: against a baseline where there is one, by itself else.
fn standing<'a>(test: &'a TestResult, compared: Option<&'a Compared>) -> Standing<'a> {
    let why = || test.telling().and_then(|run| run.why.as_deref()).unwrap_or("no reason is told");
    match (test.verdict(), compared.map(|compared| compared.change)) {
        (TestVerdict::NotRun, _) => Standing::Error(why()),
        (_, Some(Change::Broken)) => Standing::Red("broken"),
        (_, Some(Change::Worse)) => Standing::Red("worse"),
        (TestVerdict::Passed, _) if test.never_met() => {
            Standing::Known("never in the situation of its record: no failure, and no pass".to_owned())
        }
        (TestVerdict::Passed, _) => Standing::Passed,
        (TestVerdict::Failed, Some(Change::Flaky)) => Standing::Known("flaky: it fails now and then".to_owned()),
        (TestVerdict::Failed, Some(Change::Same | Change::Better)) => {
            Standing::Known("known failure: the baseline fails as well".to_owned())
        }
        (TestVerdict::Failed, _) => Standing::Red("failed"),
    }
}

/// JUnit XML of results, by crash type.
pub fn junit(results: &TestResults, comparison: Option<&Comparison>) -> String {
    let compared: BTreeMap<&str, &Compared> =
        comparison.iter().flat_map(|all| &all.tests).map(|test| (test.id.as_str(), test)).collect();
    let mut groups: BTreeMap<&str, Vec<(&TestResult, Option<&Compared>)>> = BTreeMap::new();
    for test in &results.tests {
        let of = compared.get(test.id.as_str()).copied();
        groups.entry(test.about.crash_type_label()).or_default().push((test, of));
    }
    let all: Vec<(&TestResult, Option<&Compared>)> = groups.values().flatten().copied().collect();
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    let written = (|| {
        writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        let name = format!("{} in {}", results.ego, results.simulator);
        let head = counts(&name, &all);
        let suites = writer.create_element("testsuites").with_attributes(attributes(&pairs(&head)));
        suites.write_inner_content(|writer| {
            let mut groups = groups.iter().enumerate();
            groups.try_for_each(|(place, (kind, tests))| group(writer, results, kind, tests, place == 0))
        })?;
        std::io::Result::Ok(())
    })();
    written.expect("written into memory");
    let mut text = String::from_utf8(writer.into_inner()).expect("made of texts");
    text.push('\n');
    text
}

fn pairs<'a>(owned: &'a [(&'a str, String)]) -> Vec<(&'a str, &'a str)> {
    owned.iter().map(|(name, value)| (*name, value.as_str())).collect()
}

/// Name and counts of a group.
fn counts(name: &str, tests: &[(&TestResult, Option<&Compared>)]) -> Vec<(&'static str, String)> {
    let [mut failures, mut errors, mut skipped] = [0; 3];
    for (test, compared) in tests {
        match standing(test, *compared) {
            Standing::Passed => {}
            Standing::Red(_) => failures += 1,
            Standing::Known(_) => skipped += 1,
            Standing::Error(_) => errors += 1,
        }
    }
    let seconds: f64 = tests.iter().map(|(test, _)| seconds(test)).sum();
    vec![
        ("name", name.to_owned()),
        ("tests", tests.len().to_string()),
        ("failures", failures.to_string()),
        ("errors", errors.to_string()),
        ("skipped", skipped.to_string()),
        ("time", fixed(seconds, 3).unwrap_or_else(|| "0".to_owned())),
    ]
}

/// Simulated time: the clock would give other bytes each time. [s]
fn seconds(test: &TestResult) -> f64 {
    test.runs.iter().filter_map(|run| run.outcome.as_ref()).map(|outcome| outcome.duration_s).sum()
}

/// A crash type. What the whole run has in common stands in the first alone: readers that put all groups into one refuse a
/// property that comes twice.
fn group(
    writer: &mut Writer<Vec<u8>>,
    results: &TestResults,
    kind: &str,
    tests: &[(&TestResult, Option<&Compared>)],
    is_first: bool,
) -> std::io::Result<()> {
    let head = counts(kind, tests);
    writer.create_element("testsuite").with_attributes(attributes(&pairs(&head))).write_inner_content(|writer| {
        if is_first {
            let settings = [
                ("suite", results.suite.as_str()),
                ("profile", &results.profile),
                ("ego", &results.ego),
                ("simulator", &results.simulator),
                ("seeds", &results.seeds.to_string()),
                ("generator", &format!("recrash {}", results.recrash)),
            ];
            properties(writer, &settings)?;
        }
        tests.iter().try_for_each(|(test, compared)| case(writer, results, test, *compared))
    })?;
    Ok(())
}

fn properties(writer: &mut Writer<Vec<u8>>, all: &[(&str, &str)]) -> std::io::Result<()> {
    writer.create_element("properties").write_inner_content(|writer| {
        all.iter().try_for_each(|(name, value)| {
            let property = attributes(&[("name", name), ("value", value)]);
            writer.create_element("property").with_attributes(property).write_empty().map(|_| ())
        })
    })?;
    Ok(())
}

/// A test: what it is about, where it stands, and what its telling run shows.
fn case(
    writer: &mut Writer<Vec<u8>>,
    results: &TestResults,
    test: &TestResult,
    compared: Option<&Compared>,
) -> std::io::Result<()> {
    let class = format!(
        "recrash.{}.{}",
        results.profile,
        test.about.crash_type_label().replace([' ', '-'], "_").to_lowercase()
    );
    let time = fixed(seconds(test), 3).unwrap_or_else(|| "0".to_owned());
    let head = attributes(&[("classname", &class), ("name", &test.id), ("time", &time)]);
    writer.create_element("testcase").with_attributes(head).write_inner_content(|writer| {
        about(writer, test, compared)?;
        stands(writer, test, compared)?;
        writer.create_element("system-out").write_text_content(BytesText::new(&safe(&sentences(test))))?;
        Ok(())
    })?;
    Ok(())
}

/// What is known of a test, as properties.
fn about(writer: &mut Writer<Vec<u8>>, test: &TestResult, compared: Option<&Compared>) -> std::io::Result<()> {
    let outcome = test.telling().and_then(|run| run.outcome.as_ref());
    let told_record = test.about.told.as_ref().map(ToString::to_string).filter(|record| !record.is_empty());
    let met = outcome.and_then(|outcome| outcome.met);
    let known = [
        ("provenance", Some(test.about.provenance.label())),
        ("report", told_record.as_deref()),
        ("change", compared.map(|compared| compared.change.name())),
        ("cause", outcome.and_then(|outcome| outcome.cause).map(|cause| cause.label())),
        ("preventability", outcome.and_then(|outcome| outcome.bracket()).map(|bracket| bracket.label())),
        ("situation", met.map(|met| if met { "met" } else { "not met" })),
    ];
    let told: Vec<(&str, &str)> = known.into_iter().filter_map(|(name, value)| Some((name, value?))).collect();
    properties(writer, &told)
}

/// Where a test stands: nothing of one that passed.
fn stands(writer: &mut Writer<Vec<u8>>, test: &TestResult, compared: Option<&Compared>) -> std::io::Result<()> {
    let outcome = test.telling().and_then(|run| run.outcome.as_ref());
    let kinds = outcome.map_or_else(String::new, |outcome| {
        let kinds = outcome.kinds();
        kinds.iter().filter(|kind| kind.is_failure()).map(|kind| kind.label()).collect::<Vec<_>>().join(", ")
    });
    match standing(test, compared) {
        Standing::Passed => {}
        Standing::Red(how) => {
            let why = compared.map_or("", |compared| compared.why.as_str());
            let message = [how, why, &kinds].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(": ");
            let failure = attributes(&[("type", how), ("message", &message)]);
            let failure = writer.create_element("failure").with_attributes(failure);
            failure.write_text_content(BytesText::new(&safe(&sentences(test))))?;
        }
        Standing::Known(how) => {
            let message = format!("{how} ({kinds})");
            writer.create_element("skipped").with_attributes(attributes(&[("message", &message)])).write_empty()?;
        }
        Standing::Error(why) => {
            let error = attributes(&[("type", "not run"), ("message", why)]);
            writer.create_element("error").with_attributes(error).write_empty()?;
        }
    }
    Ok(())
}

/// What the telling run shows, a line a finding.
fn sentences(test: &TestResult) -> String {
    let outcome = test.telling().and_then(|run| run.outcome.as_ref());
    let lines = outcome.map(|outcome| outcome.findings.iter().map(|finding| finding.sentence.as_str()).collect());
    let lines: Vec<&str> = lines.unwrap_or_default();
    lines.join("\n")
}

/// Workflow commands of GitHub: an error for what is red, a warning for what is flaky, not met or not run, and one line for all.
pub fn github(comparison: &Comparison) -> String {
    let mut text = String::new();
    let escaped = |text: &str| text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A");
    let property = |text: &str| escaped(text).replace(':', "%3A").replace(',', "%2C");
    let levels: [(&str, &[Change], usize); 3] = [
        ("error", &[Change::Broken, Change::Worse], ANNOTATED),
        ("warning", &[Change::Flaky, Change::Unmet, Change::NotRun], ANNOTATED),
        // One is kept for the line about all.
        ("notice", &[Change::Fixed], ANNOTATED - 1),
    ];
    for (level, changes, room) in levels {
        let tests: Vec<&Compared> = changes.iter().flat_map(|change| comparison.of(*change)).collect();
        let told = if tests.len() > room { room - 1 } else { tests.len() };
        for test in &tests[..told] {
            let title = property(&format!("{}: {}", test.change.label(), test.id));
            let _ = writeln!(text, "::{level} title={title}::{}", escaped(&test.why));
        }
        let left = |change: &&Change| {
            let count = tests[told..].iter().filter(|test| test.change == **change).count();
            (count > 0).then(|| format!("{count} more {}", change.label()))
        };
        let left: Vec<String> = changes.iter().filter_map(|change| left(&change)).collect();
        if !left.is_empty() {
            let _ = writeln!(text, "::{level} title=and more::{}", left.join(", "));
        }
    }
    let _ = writeln!(text, "::notice title=recrash::{}", escaped(&sentence(comparison)));
    text
}

/// All of it in one sentence.
pub fn sentence(comparison: &Comparison) -> String {
    let changes = Change::ALL.into_iter().filter_map(|change| {
        let count = comparison.all.changes.get(&change)?;
        Some(format!("{count} {}", change.label()))
    });
    let random = comparison.tests.iter().filter(|test| test.p.is_some()).count();
    let level = comparison.level.map_or_else(String::new, |level| {
        format!("; of {random} with a p, those of {level:.1e} or below count (Benjamini-Hochberg)")
    });
    format!("{} tests: {}{level}", comparison.all.tests, changes.collect::<Vec<_>>().join(", "))
}

/// A summary for people, in Markdown as GitHub and GitLab show it.
pub fn markdown(comparison: &Comparison) -> String {
    let mut text = String::new();
    let [before, now] = comparison.egos.each_ref().map(|name| code(name));
    let _ = writeln!(text, "# {now} against {before}\n\n{}.\n", sentence(comparison));
    if comparison.suites[0] != comparison.suites[1] {
        let _ = writeln!(text, "The two were run on different suites; tests that differ are told as changed.\n");
    }
    let used: Vec<Change> =
        Change::ALL.into_iter().filter(|change| comparison.all.changes.contains_key(change)).collect();
    let header: String = used.iter().map(|change| format!(" {} |", change.label())).collect();
    let _ = writeln!(text, "| crash type | tests | failed before | failed now |{header} p |");
    let _ = writeln!(text, "|---|--:|--:|--:|{}--:|", "--:|".repeat(used.len()));
    for row in comparison.by_type.iter().chain([&comparison.all]) {
        let counts: String =
            used.iter().map(|change| format!(" {} |", row.changes.get(change).unwrap_or(&0))).collect();
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} |{counts} {} |",
            row.crash_type,
            row.tests,
            row.base_failed,
            row.new_failed,
            shown_p(row.p)
        );
    }
    let _ = writeln!(text, "\np: McNemar's exact test of broken against fixed.");
    for change in used.into_iter().filter(|change| *change != Change::Same) {
        let tests = comparison.of(change);
        let _ = writeln!(text, "\n## {} ({})\n", capital(change.label()), tests.len());
        for test in tests.iter().take(TOLD) {
            let p = test.p.map_or_else(String::new, |p| format!(" (p {})", shown_p(p)));
            let _ = writeln!(text, "- {}: {}{p}{}", code(&test.id), plain(&test.why), sides(test));
        }
        if tests.len() > TOLD {
            let _ = writeln!(text, "- and {} more", tests.len() - TOLD);
        }
    }
    text
}

/// Least gaps of both sides, where there are some.
fn sides(test: &Compared) -> String {
    let gap = |side: &Option<Side>| side.as_ref().and_then(|side| side.least_gap_m).and_then(|gap| fixed(gap, 2));
    match (gap(&test.base), gap(&test.new)) {
        (Some(before), Some(now)) if before != now => format!("; least gap {before} m, now {now} m"),
        _ => String::new(),
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Anybody's text as code.
fn code(text: &str) -> String {
    format!("`{}`", safe(text).replace(['`', '\n', '|'], "'"))
}

/// Anybody's text, in which nothing is markup.
fn plain(text: &str) -> String {
    let mut out = String::new();
    for letter in safe(text).chars() {
        match letter {
            '\n' => out.push(' '),
            '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '|' | '#' | '&' | '@' | '!' => {
                out.push('\\');
                out.push(letter);
            }
            other => out.push(other),
        }
    }
    out
}
