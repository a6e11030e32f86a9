//! Scenarios in the formats of other tools: OpenSCENARIO XML 1.3 with OpenDRIVE 1.7, Scenic 3, MetaDrive, CommonRoad
//! 2020a and ScenarioNet; and our own OpenSCENARIO read back.
//!
//! Every format is a function of the checked scenario, of its rollout where recorded motion is asked for, and of the
//! numbers that may move. What each element means is listed in `docs/formats/coverage.md`, and what each tool takes for
//! a position, a heading and a unit in `docs/formats/conventions.md`.
//!
//! What this crate does **not** do: it writes no file, and simulates nothing.

mod commonroad;
mod import;
mod metadrive;
mod opendrive;
mod openscenario;
mod scenarionet;
mod scenic;
mod xml;

pub use import::{MAX_IMPORT_BYTES, import, parameter_name};

use recrash_model::narrative::Origin;
use recrash_model::rollout::Rollout;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::tuning::Parameter;
use recrash_roads::Scenario;

/// A format to export to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// OpenSCENARIO XML 1.3 with an OpenDRIVE 1.7 map.
    OpenScenario,
    /// Scenic 3, with the map as OpenDRIVE.
    Scenic,
    /// The scenario as JSON and a Python file that runs it in MetaDrive 0.4.3.
    MetaDrive,
    /// CommonRoad 2020a.
    CommonRoad,
    /// The scenario description of ScenarioNet and MetaDrive's `ScenarioEnv`.
    ScenarioNet,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 5] = [Self::OpenScenario, Self::Scenic, Self::MetaDrive, Self::CommonRoad, Self::ScenarioNet];
    /// Their names, as on the command line and of folders.
    pub const NAMES: [&'static str; 5] = ["openscenario", "scenic", "metadrive", "commonroad", "scenarionet"];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::OpenScenario => Self::NAMES[0],
            Self::Scenic => Self::NAMES[1],
            Self::MetaDrive => Self::NAMES[2],
            Self::CommonRoad => Self::NAMES[3],
            Self::ScenarioNet => Self::NAMES[4],
        }
    }
}

impl std::str::FromStr for Format {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|format| format.name() == text)
            .ok_or_else(|| format!("there is no format \"{text}\"; there are: {}", Self::NAMES.join(", ")))
    }
}

/// How the partners move in an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum PartnersAs {
    /// By their policies, as actions with triggers.
    #[default]
    Actions,
    /// As they were recorded in the rollout.
    Trajectory,
}

/// How to export.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportOptions {
    /// The format.
    pub format: Format,
    /// How the partners move (OpenSCENARIO only; Scenic and MetaDrive act, CommonRoad and ScenarioNet replay).
    pub partners_as: PartnersAs,
    /// A gap below this is a close call. [m]
    pub min_gap_m: f64,
    /// Time written into headers that demand one, as `2024-01-01T00:00:00`.
    pub created: String,
}

impl ExportOptions {
    /// The defaults of a format: partners act, close calls below 2 m (the paper's threshold), and a fixed date, so that
    /// the same scenario gives the same bytes.
    pub fn new(format: Format) -> Self {
        let created = "2024-01-01T00:00:00".to_owned();
        Self { format, partners_as: PartnersAs::Actions, min_gap_m: 2.0, created }
    }
}

/// One file of an export.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExportFile {
    /// Name, without folder.
    pub name: String,
    /// Content.
    pub content: Vec<u8>,
}

/// Why a scenario cannot be exported.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// The format, or recorded partners, need a rollout.
    #[error("scenario {scenario}: its rollout is needed for recorded partners; simulate it first")]
    NeedsRollout {
        /// Scenario.
        scenario: String,
    },
    /// The format has no way to say what happens.
    #[error("scenario {scenario}: {format} cannot hold it: {why}")]
    CannotHold {
        /// Scenario.
        scenario: String,
        /// The format.
        format: &'static str,
        /// What it cannot hold.
        why: String,
    },
}

/// Exports a scenario. `parameters` are the numbers that may move; without any there is no logical scenario.
///
/// # Errors
/// [`ExportError::NeedsRollout`] where recorded motion is asked for and there is none, [`ExportError::CannotHold`] where the
/// format cannot say what happens.
pub fn export(
    scenario: &Scenario,
    rollout: Option<&Rollout>,
    parameters: &[Parameter],
    options: &ExportOptions,
) -> Result<Vec<ExportFile>, ExportError> {
    match options.format {
        Format::OpenScenario => openscenario::files(scenario, rollout, parameters, options),
        Format::Scenic => scenic::files(scenario, rollout, parameters),
        Format::MetaDrive => metadrive::files(scenario),
        Format::CommonRoad => commonroad::files(scenario, rollout, options),
        Format::ScenarioNet => scenarionet::files(scenario, rollout),
    }
}

/// One line that says what a scenario is.
pub(crate) fn title(draft: &ScenarioDraft) -> String {
    let template = draft.source.template.as_ref().map_or_else(String::new, |template| format!(" ({template})"));
    format!("{}{template}", draft.id)
}

/// What stands at the top of every file, on one line: where it comes from, and whose crash it tells.
pub(crate) fn comment(draft: &ScenarioDraft) -> String {
    let records: Vec<String> = draft.source.records.iter().map(ToString::to_string).collect();
    let records = if records.is_empty() { "none".to_owned() } else { records.join(", ") };
    let whose = whose_crash(draft).map_or_else(String::new, |whose| format!(" Whose crash: {whose}."));
    let title = title(draft);
    let text = format!("{title}. Made by recrash from crash records: {records}.{whose} {}", draft.source.narrative);
    one_line(text.trim_end())
}

/// Whose crash a scenario tells, where that is known: its own record's, another one's, or nobody's.
pub(crate) fn whose_crash(draft: &ScenarioDraft) -> Option<String> {
    Some(match draft.source.origin.as_ref()? {
        Origin::Own => "own record".to_owned(),
        Origin::Other { record, .. } => format!("another record, {record}"),
        Origin::Invented { .. } => "invented, no record".to_owned(),
    })
}

/// Text that cannot end a line.
pub(crate) fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || c == '\u{2028}' || c == '\u{2029}' { ' ' } else { c }).collect()
}
