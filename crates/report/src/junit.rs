//! JUnit XML, in the form that Jenkins, GitLab and GitHub actions read.

use crate::results::other_egos;
use crate::summary::{Result as Outcome, Summary, struck_standing};
use crate::view::{CaseRow, RunNames, RunRow, SuiteView};
use crate::words::{self, fixed};
use quick_xml::Writer;
use quick_xml::events::attributes::Attribute;
use quick_xml::events::{BytesDecl, BytesText, Event};
use quick_xml::name::QName;
use recrash_model::metrics::{Answer, Check};
use recrash_model::triage::Triage;

/// The document.
pub fn render(suite: &SuiteView) -> String {
    let groups = groups(suite);
    let total = |of: fn(&Group) -> usize| groups.iter().map(of).sum::<usize>().to_string();
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    let written = (|| {
        writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        let suites = writer.create_element("testsuites").with_attributes(attributes(&[
            ("name", &suite.title),
            ("tests", &total(|group| group.cases.len())),
            ("failures", &total(|group| group.failed())),
            ("errors", &total(|group| group.errors())),
            ("skipped", &total(|group| group.skipped())),
        ]));
        suites.write_inner_content(|writer| {
            groups.iter().enumerate().try_for_each(|(place, group)| group.write(writer, suite, place == 0))
        })?;
        std::io::Result::Ok(())
    })();
    written.expect("written into memory");
    let mut text = String::from_utf8(writer.into_inner()).expect("made of texts");
    text.push('\n');
    text
}

/// Why the system under test was not driven in a scenario that there is.
fn not_driven(case: &CaseRow) -> Option<&str> {
    case.refused.as_deref().filter(|_| case.undriven)
}

/// Whether a run is no failure, and no pass either.
fn says_nothing(run: &RunRow) -> bool {
    Outcome::of(Some(run)) == Outcome::NotMet
}

/// The cases of one kind of run.
struct Group<'a> {
    name: &'static str,
    cases: Vec<&'a CaseRow>,
    run: fn(&CaseRow) -> Option<&RunRow>,
}

/// As designed and as tuned; in a suite that goes by accounts, the system under test in the crashes as reconstructed, and in
/// those where tuning kept another scenario.
fn groups(suite: &SuiteView) -> Vec<Group<'_>> {
    let by_account = suite.accounts.is_some();
    let names = if by_account { RunNames::RETOLD_TUNED } else { RunNames::DESIGNED };
    let tuned = suite.cases.iter().filter(|case| match by_account {
        true => case.is_tuned() || case.untuned.is_some() && not_driven(case).is_some(),
        false => case.after.is_some(),
    });
    vec![
        Group { name: names.untuned, cases: suite.cases.iter().collect(), run: CaseRow::first_run },
        Group { name: names.after, cases: tuned.collect(), run: |case| case.after.as_ref() },
    ]
}

impl Group<'_> {
    fn failed(&self) -> usize {
        self.cases.iter().filter_map(|case| (self.run)(case)).filter(|run| run.failed()).count()
    }

    fn skipped(&self) -> usize {
        let skipped = |case: &&&CaseRow| match (self.run)(case) {
            Some(run) => says_nothing(run),
            None => not_driven(case).is_none(),
        };
        self.cases.iter().filter(skipped).count()
    }

    fn errors(&self) -> usize {
        self.cases.iter().filter(|case| (self.run)(case).is_none() && not_driven(case).is_some()).count()
    }

    /// What the whole run has in common stands in the first group alone: readers that put all groups into one refuse a
    /// property that comes twice.
    fn write(&self, writer: &mut Writer<Vec<u8>>, suite: &SuiteView, is_first: bool) -> std::io::Result<()> {
        let element = writer.create_element("testsuite").with_attributes(attributes(&[
            ("name", self.name),
            ("tests", &self.cases.len().to_string()),
            ("failures", &self.failed().to_string()),
            ("errors", &self.errors().to_string()),
            ("skipped", &self.skipped().to_string()),
        ]));
        element.write_inner_content(|writer| {
            let settings = [
                ("profile", &suite.profile.name),
                ("ego", &suite.ego),
                ("simulator", &suite.simulator),
                ("agents", &suite.agents),
                ("seed", &suite.seed.to_string()),
                ("command", &suite.command),
                ("generator", &suite.generated_by),
            ];
            if is_first {
                let counted = counted(suite);
                let counted = counted.iter().map(|(name, value)| (*name, value));
                writer.create_element("properties").write_inner_content(|writer| {
                    for (name, value) in settings.into_iter().chain(counted) {
                        let property = attributes(&[("name", name), ("value", value)]);
                        writer.create_element("property").with_attributes(property).write_empty()?;
                    }
                    Ok(())
                })?;
            }
            self.cases.iter().try_for_each(|case| test_case(writer, suite, case, (self.run)(case), self.name))
        })?;
        Ok(())
    }
}

/// Failures in numbers, in a suite that goes by accounts: of the runs that came into the situation of their record.
fn counted(suite: &SuiteView) -> Vec<(&'static str, String)> {
    if suite.accounts.is_none() {
        return Vec::new();
    }
    let summary = Summary::of(suite);
    let [first, last] = summary.tested;
    let numbers = [
        ("as-reconstructed.situation-met", first.met),
        ("as-reconstructed.struck-while-it-stood", first.failures.struck_standing),
        ("as-reconstructed.struck-while-it-moved-or-had-just-stopped", first.failures.struck_moving),
        ("as-reconstructed.failed-otherwise", first.failures.otherwise),
        ("after-tuning.situation-met", last.met),
        ("after-tuning.struck-while-it-stood", last.failures.struck_standing),
        ("after-tuning.struck-while-it-moved-or-had-just-stopped", last.failures.struck_moving),
        ("after-tuning.failed-otherwise", last.failures.otherwise),
        ("failed-after-tuning-alone", summary.by_tuning),
    ];
    numbers.into_iter().map(|(name, number)| (name, number.to_string())).collect()
}

fn test_case(
    writer: &mut Writer<Vec<u8>>,
    suite: &SuiteView,
    case: &CaseRow,
    run: Option<&RunRow>,
    name: &str,
) -> std::io::Result<()> {
    // The triage is about the last run.
    let is_last = name == case.last_name();
    let triage = case.triage.as_ref().filter(|_| is_last);
    let time = run.and_then(|run| fixed(run.metrics.duration_s, 3)).unwrap_or_else(|| "0".to_owned());
    let class = format!("recrash.{}.{}", suite.profile.name, name.replace(' ', "-"));
    let element = writer.create_element("testcase").with_attributes(attributes(&[
        ("classname", &class),
        ("name", &case.scenario_id),
        ("time", &time),
    ]));
    element.write_inner_content(|writer| {
        let Some(run) = run else {
            if let Some(why) = not_driven(case) {
                let error = writer
                    .create_element("error")
                    .with_attributes(attributes(&[("type", "not run"), ("message", why)]));
                error.write_empty()?;
                return Ok(());
            }
            let why = case.refused.as_deref().unwrap_or(words::not_run(case));
            writer.create_element("skipped").with_attributes(attributes(&[("message", why)])).write_empty()?;
            return Ok(());
        };
        if says_nothing(run) {
            let why = [("message", "the system never came into the situation of the record: no failure, and no pass")];
            writer.create_element("skipped").with_attributes(attributes(&why)).write_empty()?;
        }
        if run.failed() {
            let failures: Vec<_> = run.findings.iter().filter(|finding| finding.kind.is_failure()).collect();
            let kinds: Vec<_> = failures.iter().map(|finding| finding.kind.label()).collect();
            let sentences: Vec<_> = failures.iter().map(|finding| safe(&finding.sentence)).collect();
            let class = triage.map_or_else(String::new, |t| format!(" ({})", t.class.label()));
            let harm = run.severity.as_ref().and_then(|severity| fixed(severity.harm_mps(), 1));
            let harm = harm.map_or_else(String::new, |harm| format!(", largest delta-v {harm} m/s"));
            let struck = if struck_standing(run) { ", struck while it stood" } else { "" };
            let met = if run.situation_met() == Some(false) { ", outside the situation of the record" } else { "" };
            let by_tuning = if is_last && case.found_by_tuning() { ", found by tuning alone" } else { "" };
            let message = format!("{}{struck}{class}{harm}{met}{by_tuning}", kinds.join(", "));
            let kind = if struck.is_empty() { kinds.first().copied().unwrap_or_default() } else { "struck standing" };
            let failure = writer.create_element("failure");
            let failure = failure.with_attributes(attributes(&[("type", kind), ("message", &message)]));
            failure.write_text_content(BytesText::new(&sentences.join("\n")))?;
        }
        writer
            .create_element("system-out")
            .write_text_content(BytesText::new(&safe(&told(suite, case, run, triage))))?;
        Ok(())
    })?;
    Ok(())
}

/// Attributes whose values are cleaned; the library escapes them.
pub(crate) fn attributes<'a>(pairs: &[(&'a str, &str)]) -> Vec<Attribute<'a>> {
    let attribute = |(name, value): &(&'a str, &str)| {
        let value = quick_xml::escape::escape(safe(value)).into_owned();
        Attribute { key: QName(name), value: value.into() }
    };
    pairs.iter().map(attribute).collect()
}
/// What a person reads when the test has failed.
fn told(suite: &SuiteView, case: &CaseRow, run: &RunRow, triage: Option<&Triage>) -> String {
    let gap = run
        .min_gap_m()
        .and_then(|gap| fixed(gap, 2))
        .map_or("no gap was measured".to_owned(), |gap| format!("{gap} m"));
    let note = words::gap_note(run, suite.profile.failure.min_gap_m, case.account.is_some());
    let gap = gap + &note.map_or_else(String::new, |note| format!(" ({note})"));
    let checked =
        |check: &Check| format!("{}: expected {}, observed {}", check.kind.label(), check.expected, check.observed);
    let listed = |answer: Answer, checks: Vec<&Check>| {
        format!("{} ({})", answer.label(), checks.into_iter().map(checked).collect::<Vec<_>>().join("; "))
    };
    let run_told = case.telling_run().filter(|_| case.account.is_some()).unwrap_or(run);
    let faithful = match case.faithful().map(|_| run_told.faithful()) {
        None => "there is no record to be true to".to_owned(),
        Some(Answer::Yes) => Answer::Yes.label().to_owned(),
        Some(Answer::Unchecked) => listed(Answer::Unchecked, run_told.verdict.unchecked().collect()),
        Some(Answer::No) => listed(Answer::No, run_told.verdict.failures().collect()),
    };
    let origin = words::provenance(case.origin.as_ref(), case.told.as_ref());
    let severity = run.severity.as_ref().map_or_else(String::new, |severity| {
        let number = |value: f64| fixed(value, 1).unwrap_or_default();
        let [ego, other] = [&severity.first, &severity.second].map(|side| number(side.delta_v_mps));
        let risk = severity
            .serious_injury()
            .map_or_else(String::new, |risk| format!("; serious injury: {} %", number(100.0 * risk)));
        format!("\ndelta-v: ego {ego} m/s, {} {other} m/s{risk}", severity.other())
    });
    let others = triage.map_or_else(String::new, |triage| {
        format!(
            "\nother egos in the same scenario: {}, {} ({})",
            triage.class.label(),
            triage.class.meaning(),
            other_egos(triage)
        )
    });
    let cause = run.cause.map_or_else(String::new, |cause| format!("\ncause: {}", cause.label()));
    let bracket = run
        .preventability
        .as_ref()
        .map_or_else(String::new, |found| format!("\n{}: {}", words::REGULATION_DRIVERS, found.bracket().label()));
    let edited = match &case.edited[..] {
        [] => String::new(),
        files => format!("\nedited by hand: {}", files.join(", ")),
    };
    let what = case.account.as_ref().map_or(String::new(), |account| {
        let met = run.situation_met().map_or("not looked at", |met| if met { "yes" } else { "no" });
        format!("crash type: {}\nincident: {}\nsituation met: {met}\n", account.crash_type.label(), account.incident)
    });
    format!(
        "{what}template: {}\ntells: {origin}\nleast gap: {gap}{severity}{cause}{bracket}\nended by: {}\nfaithful: {faithful}{others}{edited}\nagain: {}",
        case.template,
        run.metrics.termination.label(),
        run.rerun_command
    )
}

/// Text of characters that XML 1.0 can hold.
pub(crate) fn safe(text: &str) -> String {
    words::clean(text, words::LONGEST_TEXT).replace(['\u{fffe}', '\u{ffff}'], "\u{fffd}")
}
