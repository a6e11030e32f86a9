//! Files and folders of a suite.

use super::Stage;

/// Records.
pub const RECORDS: &str = "1-records.json";
/// Accounts of the incidents, in a suite that goes by accounts.
pub const ACCOUNTS: &str = "1-accounts.json";
/// Which of them a language model was asked about, and what came of it.
pub const ACCOUNT_READERS: &str = "1-accounts.agents.json";
/// Crashes that a language model was asked to stage, since the rules do not show them as told, and what came of it.
pub const STAGED_AGAIN: &str = "1-accounts.stagings.json";
/// Remarks on the records.
pub const RECORD_REMARKS: &str = "1-records.diagnostics.json";
/// Selection.
pub const SELECTION: &str = "2-selection.json";
/// Remarks on the selection.
pub const SELECTION_REMARKS: &str = "2-selection.diagnostics.json";
/// How the selection depends on seed, strategy and budget.
pub const SELECTION_STUDY: &str = "2-selection.study.json";
/// The groups by the records' names, which the next choice goes on from.
pub const SELECTION_GROUPS: &str = "2-selection.groups.json";
/// Rows of the embedding model, by content.
pub const EMBEDDING: &str = "2-embedding.json";
/// The page.
pub const REPORT: &str = "report.html";
/// For continuous integration.
pub const JUNIT: &str = "junit.xml";
/// One line per scenario.
pub const RESULTS: &str = "results.csv";
/// Everything a person is told at the end.
pub const SUMMARY: &str = "summary.json";

/// Folders with files that people may edit.
pub const EDITABLE_FOLDERS: [&str; 3] = ["3-narratives", "4-scenarios", "6-tuned"];

/// Ending of files that say why a scenario went no further.
const FAILURE: &str = ".failed.json";

/// Whether a file says why a scenario went no further.
pub fn is_failure_file(file: &str) -> bool {
    file.ends_with(FAILURE)
}

/// Why a scenario went no further than this stage.
pub fn failure(stage: Stage, id: &str) -> String {
    let folder = match stage {
        Stage::Design => "4-scenarios",
        Stage::Simulate => "5-runs",
        Stage::Tune => "6-tuned",
        Stage::Triage => "7-tuned-runs",
        // Beside the review, which is beside the run that it is of.
        Stage::Review => return format!("5-runs/{id}.review{FAILURE}"),
        Stage::Records | Stage::Select | Stage::Narrate | Stage::Report => "3-narratives",
    };
    format!("{folder}/{id}{FAILURE}")
}
/// Narrative of a scenario.
pub fn narrative(id: &str) -> String {
    format!("3-narratives/{id}.json")
}
/// Account of an incident, in a suite that goes by accounts.
pub fn account(id: &str) -> String {
    format!("3-narratives/{id}.account.json")
}
/// Who wrote the narrative.
pub fn narrative_log(id: &str) -> String {
    format!("3-narratives/{id}.agent.json")
}
/// Scenario as designed.
pub fn scenario(id: &str) -> String {
    format!("4-scenarios/{id}.json")
}
/// How it was designed.
pub fn design_log(id: &str) -> String {
    format!("4-scenarios/{id}.design.json")
}
/// Judged run of the recorded driver.
pub fn recorded_run(id: &str) -> String {
    format!("5-runs/{id}.recorded.json")
}
/// What a reader finds who holds that run against its report.
pub fn review(id: &str) -> String {
    format!("5-runs/{id}.review.json")
}
/// Judged run of the scenario as designed.
pub fn first_run(id: &str) -> String {
    format!("5-runs/{id}.json")
}
/// Tuned scenario.
pub fn tuned(id: &str) -> String {
    format!("6-tuned/{id}.json")
}
/// Log of the search.
pub fn tune_log(id: &str) -> String {
    format!("6-tuned/{id}.search.json")
}
/// Who tuned it.
pub fn tune_agent(id: &str) -> String {
    format!("6-tuned/{id}.agent.json")
}
/// Judged run of the tuned scenario.
pub fn tuned_run(id: &str) -> String {
    format!("7-tuned-runs/{id}.json")
}
/// Judged run of the recorded driver in the tuned scenario.
pub fn tuned_recorded_run(id: &str) -> String {
    format!("7-tuned-runs/{id}.recorded.json")
}
/// How the other egos fare in the tuned scenario, where the system under test fails.
pub fn triage(id: &str) -> String {
    format!("7-tuned-runs/{id}.triage.json")
}
/// Run of the reference driver in it.
pub fn reference_run(id: &str) -> String {
    format!("7-tuned-runs/{id}.reference.json")
}
