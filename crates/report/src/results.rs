//! The results as a table for spreadsheets and data frames.

use crate::summary::struck_standing;
use crate::view::{CaseRow, RunNames, RunRow, SuiteView};
use crate::words::{self, fixed};
use recrash_model::metrics::{Check, PartnerMetrics, Timed};
use recrash_model::preventability::Preventability;
use recrash_model::severity::Severity;
use recrash_model::spreadsheet::inert;
use recrash_model::triage::Triage;

const HEADER: [&str; 60] = [
    "scenario",
    "run",
    "road",
    "sv_movement",
    "cp_movement",
    "work_zone",
    "cluster",
    "record",
    "origin",
    "told_record",
    "profile",
    "ego",
    "simulator",
    "seed",
    "failed",
    "faithful",
    "not_faithful_because",
    "unchecked_because",
    "findings",
    "min_gap_m",
    "min_gap_time_s",
    "min_centre_distance_m",
    "min_ttc_s",
    "pet_s",
    "max_drac_mps2",
    "min_headway_s",
    "contact_with",
    "contact_time_s",
    "collision",
    "ego_zone",
    "other_zone",
    "relative_speed_mps",
    "ego_contact_speed_mps",
    "other_contact_speed_mps",
    "ego_max_deceleration_mps2",
    "ego_max_lane_departure_m",
    "termination",
    "duration_s",
    "run_id",
    "state_hash",
    "failure_class",
    "other_egos",
    "refused_because",
    "edited_files",
    "command",
    "incident",
    "crash_type",
    "role",
    "situation_met",
    "ego_delta_v_mps",
    "other_delta_v_mps",
    "serious_injury_probability",
    "cause",
    "preventability",
    "struck_standing",
    "found_by_tuning",
    "reviewed",
    "review_note",
    "restaged_because",
    "min_gap_note",
];

/// The table.
pub fn render(suite: &SuiteView) -> String {
    let mut writer = csv::WriterBuilder::new().terminator(csv::Terminator::CRLF).from_writer(Vec::new());
    // Into memory, and every row has the header's width.
    let mut write = |cells: Vec<String>| {
        let cells = cells.iter().map(|text| cell(text));
        writer.write_record(cells).expect("a row of the header's width");
    };
    write(HEADER.map(str::to_owned).into());
    for case in &suite.cases {
        for (name, run) in case.runs() {
            write(row(suite, case, name, Some(run)));
        }
        if case.runs().is_empty() {
            write(row(suite, case, "not run", None));
        }
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).expect("made of texts")
}

/// The row of a run, or of a scenario that was not run.
fn row(suite: &SuiteView, case: &CaseRow, name: &str, run: Option<&RunRow>) -> Vec<String> {
    let is_recorded = run.is_some() && RunNames::is_recorded(name);
    let mut row = scenario_cells(suite, case, name);
    row.push(suite.profile.name.clone());
    row.push(if is_recorded { "recorded".to_owned() } else { suite.ego.clone() });
    row.push(suite.simulator.clone());
    row.push(suite.seed.to_string());
    match run {
        // By accounts the recorded driver's run is held against the record, by templates each.
        Some(run) => {
            // Who drove in the record is not under test.
            row.push(if is_recorded { String::new() } else { run.failed().to_string() });
            row.extend(measured(case, run, case.account.is_none() || is_recorded));
        }
        None => row.extend(std::iter::repeat_n(String::new(), 26)),
    }
    // The triage is about the last run.
    let is_last = run.is_some() && name == case.last_name();
    let triage = case.triage.as_ref().filter(|_| is_last);
    row.push(triage.map_or_else(String::new, |triage| triage.class.label().to_owned()));
    row.push(triage.map_or_else(String::new, other_egos));
    row.push(case.refused.clone().unwrap_or_default());
    row.push(case.edited.join("; "));
    row.push(run.map_or_else(String::new, |run| run.rerun_command.clone()));
    row.extend(account_cells(case, run));
    row.extend(severity_cells(run));
    row.push(run.filter(|_| !is_recorded).map_or_else(String::new, |run| struck_standing(run).to_string()));
    row.push(if is_last { case.found_by_tuning().to_string() } else { String::new() });
    let review = case.review.as_ref().map(|by| &by.review);
    row.push(review.map_or_else(String::new, |review| review.label().to_owned()));
    row.push(review.map_or_else(String::new, |review| review.note.clone()));
    row.push(case.changed.as_ref().map_or_else(String::new, |changed| changed.what.clone()));
    let limit_m = suite.profile.failure.min_gap_m;
    let note = run.and_then(|run| words::gap_note(run, limit_m, case.account.is_some()));
    row.push(note.unwrap_or_default().to_owned());
    row
}

/// The scenario, its template and whose crash it tells: up to `told_record`.
fn scenario_cells(suite: &SuiteView, case: &CaseRow, name: &str) -> Vec<String> {
    let t = case.template;
    let cluster = suite.cluster(case);
    vec![
        case.scenario_id.clone(),
        name.to_owned(),
        t.road.slug().to_owned(),
        t.sv.slug().to_owned(),
        t.cp.slug().to_owned(),
        t.work_zone.to_string(),
        cluster.map_or_else(String::new, |cluster| cluster.number.to_string()),
        suite.case_records(case).next().map_or_else(String::new, |record| record.id.to_string()),
        case.origin.as_ref().map_or("", |origin| origin.name()).to_owned(),
        case.told.as_ref().map_or_else(String::new, ToString::to_string),
    ]
}

/// The account, and whether the run came into its situation: `incident` to `situation_met`.
fn account_cells(case: &CaseRow, run: Option<&RunRow>) -> [String; 4] {
    let account = case.account.as_ref();
    let met = run.filter(|_| account.is_some()).and_then(|run| run.situation_met());
    [
        account.map_or_else(String::new, |account| account.incident.clone()),
        account.map_or_else(String::new, |account| words::name(&account.crash_type)),
        account.and_then(|account| account.role).map_or_else(String::new, |role| words::name(&role)),
        met.map_or_else(String::new, |met| met.to_string()),
    ]
}

/// How hard it was, and what led to it: `ego_delta_v_mps` to `preventability`.
fn severity_cells(run: Option<&RunRow>) -> [String; 5] {
    let severity = run.and_then(|run| run.severity.as_ref());
    let number = |value: Option<f64>| value.and_then(|value| fixed(value, 3)).unwrap_or_default();
    let bracket = run.and_then(|run| run.preventability.as_ref()).map(Preventability::bracket);
    [
        number(severity.map(|severity| severity.first.delta_v_mps)),
        number(severity.map(|severity| severity.second.delta_v_mps)),
        number(severity.and_then(Severity::serious_injury)),
        run.and_then(|run| run.cause).map_or_else(String::new, |cause| cause.label().to_owned()),
        bracket.map_or_else(String::new, |bracket| bracket.label().to_owned()),
    ]
}

/// How the others fared, such as `idm avoids it, 3.20 m; reference does not, 0.00 m`.
pub fn other_egos(triage: &Triage) -> String {
    let told = triage.others.iter().map(|other| {
        let gap =
            other.min_gap.and_then(|gap| fixed(gap.value, 2)).map_or("no gap".to_owned(), |gap| format!("{gap} m"));
        format!("{} {}, {gap}", other.ego, other.fared.label())
    });
    told.collect::<Vec<_>>().join("; ")
}

fn measured(case: &CaseRow, run: &RunRow, tells: bool) -> Vec<String> {
    let m = &run.metrics;
    let number = |value: Option<f64>| value.and_then(|value| fixed(value, 3)).unwrap_or_default();
    let worst = |of: fn(&PartnerMetrics) -> Option<Timed>| m.partners.iter().filter_map(of).map(|timed| timed.value);
    let least = |of| number(worst(of).min_by(f64::total_cmp));
    let contact = m.contact.as_ref();
    let kinds: Vec<&str> = run.finding_kinds().into_iter().map(|kind| kind.label()).collect();
    let named = |checks: Vec<&Check>| checks.iter().map(|check| check.kind.label()).collect::<Vec<_>>().join("; ");
    vec![
        // Nobody's crash has no record to be true to; a test is held against the situation alone.
        case.faithful()
            .filter(|_| tells && run.situation_met().is_none())
            .map_or("", |_| run.faithful().label())
            .to_owned(),
        named(run.verdict.failures().collect()),
        named(run.verdict.unchecked().collect()),
        kinds.join("; "),
        number(run.min_gap_m()),
        number(run.least_gap().map(|gap| gap.time_s)),
        number(m.min_centre_distance.map(|distance| distance.value)),
        least(|partner| partner.min_ttc),
        least(|partner| partner.pet),
        number(worst(|partner| partner.max_drac).max_by(f64::total_cmp)),
        least(|partner| partner.min_headway),
        contact.map_or_else(String::new, |contact| contact.id.clone()),
        number(contact.map(|contact| contact.time_s)),
        contact.map_or("", |contact| contact.kind.label()).to_owned(),
        contact.map_or("", |contact| contact.ego_zone.label()).to_owned(),
        contact.map_or("", |contact| contact.other_zone.label()).to_owned(),
        number(contact.map(|contact| contact.relative_speed_mps)),
        number(contact.map(|contact| contact.ego_speed_mps)),
        number(contact.map(|contact| contact.other_speed_mps)),
        number(Some(m.ego.max_deceleration.value)),
        number(Some(m.ego.max_lane_departure.value)),
        m.termination.label().to_owned(),
        number(Some(m.duration_s)),
        run.id.clone(),
        run.state_hash.clone(),
    ]
}

/// A cell, which no spreadsheet takes for a formula.
fn cell(text: &str) -> String {
    inert(&words::clean(text, words::LONGEST_TEXT)).into_owned()
}
