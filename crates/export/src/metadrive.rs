//! MetaDrive: the scenario with everything resolved to MetaDrive's own terms, and the script that runs it. Both are what
//! recrash's own worker gets, so that they tell the same.

use crate::{ExportError, ExportFile, Format};
use recrash_plan::metadrive::{Run, SCRIPT, handover};
use recrash_roads::Scenario;
use serde::Serialize;
use serde_json::{Value, json};

/// The format tag of the JSON file.
const METADRIVE_FORMAT: &str = "recrash.metadrive/2";

#[derive(Serialize)]
struct MetaDriveScenario<'a> {
    format: &'static str,
    id: &'a str,
    title: String,
    records: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    whose_crash: Option<String>,
    narrative: &'a str,
    run: Run,
    /// What MetaDrive has no place for.
    not_carried: Value,
}

/// The files of a scenario: it as JSON, and the script.
pub(crate) fn files(scenario: &Scenario) -> Result<Vec<ExportFile>, ExportError> {
    let draft = scenario.draft();
    let cannot_hold =
        |why| ExportError::CannotHold { scenario: draft.id.clone(), format: Format::MetaDrive.name(), why };
    let resolved = MetaDriveScenario {
        format: METADRIVE_FORMAT,
        id: &draft.id,
        title: crate::title(draft),
        records: draft.source.records.iter().map(ToString::to_string).collect(),
        whose_crash: crate::whose_crash(draft),
        narrative: &draft.source.narrative,
        run: Run::new(scenario, handover(scenario)).map_err(cannot_hold)?,
        not_carried: json!({ "environment": { "lighting": draft.environment.lighting, "weather": draft.environment.weather } }),
    };
    let content = serde_json::to_string_pretty(&resolved).unwrap_or_default() + "\n";
    Ok(vec![
        ExportFile { name: format!("{}.metadrive.json", draft.id), content: content.into_bytes() },
        ExportFile { name: "run_metadrive.py".to_owned(), content: SCRIPT.as_bytes().to_vec() },
    ])
}
