//! A suite that goes by accounts: the recorded driver, the system under test in the crash as reconstructed, and after tuning are
//! told apart everywhere, and who was struck while it stood, or while it moved from where it does not look, is counted apart.

use crate::suite;
use recrash_model::account::{AccountSet, CrashType, FactShare};
use recrash_model::cause::Cause;
use recrash_model::metrics::{Check, CheckKind, CheckResult, Finding, FindingKind};
use recrash_report::{AccountRow, RunRow, SuiteView, html, junit, results_csv};

/// A run that came into the situation of its record, and failed or did not.
fn run(like: &RunRow, cause: Option<Cause>) -> RunRow {
    let mut run = like.clone();
    let (expected, observed) = ("near".to_owned(), "near".to_owned());
    run.judgement.verdict.checks =
        vec![Check { kind: CheckKind::Situation, expected, observed, result: CheckResult::Shown }];
    run.judgement.cause = cause;
    let sentence = "it touched".to_owned();
    let finding = Finding { kind: FindingKind::Contact, time_s: 1.0, value: 0.0, threshold: 0.0, sentence };
    run.judgement.findings = cause.map(|_| finding).into_iter().collect();
    run
}

/// Four scenarios: fails as reconstructed and was not tuned; was struck while it stood; passes, and is struck as it slows after tuning; passes
/// both.
fn retold() -> SuiteView {
    let mut suite = suite::demo().suite;
    suite.accounts = Some(AccountSet {
        format: "recrash.accounts/1".into(),
        incidents: 9,
        readable: 8,
        types: Vec::new(),
        facts: vec![FactShare { fact: CheckKind::Others, told: 7, shown: 4, not_drawn: 2 }],
        told: Vec::new(),
        untold: Vec::new(),
    });
    suite.cases.truncate(4);
    let like = suite.cases[0].before.clone().expect("it was run");
    let late = Some(Cause::BrakedLate);
    let of_cases = [
        (None, late),
        (None, Some(Cause::StruckStanding)),
        (Some(run(&like, None)), Some(Cause::WasStruck)),
        (Some(run(&like, None)), None),
    ];
    for (case, (untuned, last)) in suite.cases.iter_mut().zip(of_cases) {
        case.account = Some(AccountRow {
            incident: case.scenario_id.clone(),
            reports: 1,
            crash_type: CrashType::FrontToRear,
            role: None,
            driver: None,
        });
        // The recorded driver crashes in every one.
        case.before = Some(run(&like, Some(Cause::WasStruck)));
        case.after = Some(run(&like, last));
        // In the tuned scene it comes to another crash.
        case.told_tuned = untuned.as_ref().map(|_| RunRow { rerun_command: "tuned".into(), ..run(&like, None) });
        (case.untuned, case.triage, case.refused) = (untuned, None, None);
    }
    suite
}

#[test]
fn junit_has_the_runs_as_reconstructed_and_the_tuned_ones_apart_and_counts_both() {
    let xml = junit(&retold());
    assert!(xml.contains("<testsuite name=\"tested\" tests=\"4\" failures=\"2\""), "{xml}");
    assert!(xml.contains("<testsuite name=\"tuned\" tests=\"2\" failures=\"1\""), "{xml}");
    for (name, value) in [
        ("as-reconstructed.situation-met", 4),
        ("as-reconstructed.failed-otherwise", 1),
        ("as-reconstructed.struck-while-it-moved-or-had-just-stopped", 0),
        ("as-reconstructed.struck-while-it-stood", 1),
        ("after-tuning.failed-otherwise", 1),
        ("after-tuning.struck-while-it-moved-or-had-just-stopped", 1),
        ("after-tuning.struck-while-it-stood", 1),
        ("failed-after-tuning-alone", 1),
    ] {
        assert!(xml.contains(&format!("<property name=\"{name}\" value=\"{value}\"/>")), "{name}: {xml}");
    }
    assert!(xml.contains("type=\"struck standing\" message=\"contact, struck while it stood"), "{xml}");
    assert_eq!(xml.matches("found by tuning alone").count(), 1, "{xml}");
}

#[test]
fn a_run_that_never_came_into_the_situation_is_no_pass() {
    let mut suite = retold();
    let never = |run: &mut RunRow| run.judgement.verdict.checks[0].result = CheckResult::NotShown;
    for number in [0, 3] {
        let case = &mut suite.cases[number];
        case.after.iter_mut().chain(&mut case.untuned).for_each(never);
    }
    let xml = junit(&suite);
    assert!(xml.contains(" tests=\"6\" failures=\"3\" errors=\"0\" skipped=\"2\">"), "{xml}");
    assert_eq!(xml.matches("<skipped message=\"the system never came into the situation").count(), 2, "{xml}");
    assert_eq!(xml.matches("outside the situation of the record").count(), 1, "{xml}");
    assert!(!junit(&retold()).contains("skipped message"));
}

#[test]
fn an_ego_that_ends_is_an_error_and_no_skipped_test() {
    let mut suite = retold();
    let case = &mut suite.cases[0];
    (case.after, case.undriven, case.refused) = (None, true, Some("simulate: the ego ended".into()));
    let xml = junit(&suite);
    assert!(xml.contains(" tests=\"6\" failures=\"2\" errors=\"1\" skipped=\"0\">"), "{xml}");
    assert!(xml.contains("<error type=\"not run\" message=\"simulate: the ego ended\"/>"), "{xml}");
    // Where it ended in tuning, its first run is not its last one.
    let mut suite = retold();
    let case = &mut suite.cases[0];
    (case.untuned, case.undriven) = (case.after.take(), true);
    case.refused = Some("tune: the ego ended".into());
    let (_, tuned) = junit(&suite).split_once("name=\"tuned\"").map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
    assert!(tuned.contains("<error type=\"not run\" message=\"tune: the ego ended\"/>"), "{tuned}");
}

#[test]
fn the_table_has_a_row_for_each_run_and_marks_what_only_tuning_found() {
    let table = results_csv(&retold());
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let header = reader.headers().unwrap().clone();
    let at = |name: &str| header.iter().position(|column| column == name).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let told: Vec<[&str; 4]> = rows
        .iter()
        .map(|row| ["run", "failed", "struck_standing", "found_by_tuning"].map(|name| &row[at(name)]))
        .collect();
    let recorded = ["as told", "", "", ""];
    let recorded_tuned = ["as told, tuned", "", "", ""];
    let drove: Vec<&str> = rows.iter().take(2).map(|row| &row[at("ego")]).collect();
    assert_eq!(drove, ["recorded", "metadrive-idm"]);
    assert_eq!(
        told,
        [
            recorded,
            ["tested", "true", "false", "false"],
            recorded,
            ["tested", "true", "true", "false"],
            recorded,
            ["tested", "false", "false", ""],
            recorded_tuned,
            ["tuned", "true", "false", "true"],
            recorded,
            ["tested", "false", "false", ""],
            recorded_tuned,
            ["tuned", "false", "false", "false"],
        ]
    );
    for row in rows.iter().filter(|row| row[at("run")].starts_with("as told")) {
        let is_tuned = &row[at("run")] == recorded_tuned[0];
        assert_eq!(&row[at("command")] == "tuned", is_tuned, "the command is of its own run");
        assert_eq!(&row[at("ego")], "recorded");
    }
}

#[test]
fn the_page_counts_the_runs_of_the_system_alone_and_both_of_them() {
    let page = html(&retold());
    let text = page.replace("<b>", "").replace("</b>", "");
    for words in [
        "It fails 2 of those 4 as reconstructed, and 3 of 4 after tuning within what the reports leave open; 1 of them after tuning alone.",
        "1 struck while it stood, 1 struck from behind or beside while it moved or had just stopped, 1 otherwise",
        "fails 2 of 4 scenarios whose situation it met, as reconstructed and 3 after tuning",
    ] {
        assert!(text.contains(words), "{words}");
    }
    assert!(page.contains("2 of 7 stated facts are not drawn: neither shown nor shown otherwise."));
    assert!(page.contains(", 2 not drawn"), "with the fact");
    assert!(!page.contains("while driving"), "some of them were struck as they slowed");
    // Contacts by kind: two as reconstructed, three after tuning, and none of the recorded driver's four.
    let by_kind = page.split("Number of scenarios with a finding of each kind").nth(1).unwrap();
    let contacts = by_kind.split("<tr>").nth(2).unwrap();
    assert!(contacts.contains(">2</td>") && contacts.contains(">3</td>"), "{contacts}");
    let every = page.split("Findings of every run of the system under test").nth(1).unwrap();
    assert!(!every.split("</table>").next().unwrap().contains("as told"));
    assert_eq!(page.matches(">found by tuning</span>").count(), 1);
    assert!(page.contains(">struck standing</span>"));
}

#[test]
fn a_gap_that_nobody_came_nearer_to_is_told_so_beside_the_pass() {
    let mut suite = retold();
    let note = "stood so at the handover, not approached";
    let limit_m = suite.profile.failure.min_gap_m;
    let last = suite.cases[3].after.as_mut().unwrap();
    last.judgement.metrics.contact = None;
    last.judgement.metrics.min_gap = Some(recrash_model::metrics::Timed { value: 0.5 * limit_m, time_s: 4.0 });
    assert!(!last.failed());
    let told =
        |suite: &SuiteView| [html(suite), junit(suite), results_csv(suite)].map(|text| text.matches(note).count());
    assert_eq!(told(&suite), [1, 1, 1]);
    let last = suite.cases[3].after.as_mut().unwrap();
    last.judgement.metrics.min_gap.as_mut().unwrap().value = 2.0 * limit_m;
    assert_eq!(told(&suite), [0, 0, 0]);
}
