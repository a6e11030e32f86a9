//! Tuning: which numbers of a scenario may move and how far, and the log of a search over them.

use crate::metrics::{FindingKind, Timed};
use crate::scenario::{Policy, ScenarioDraft};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

/// The tune logs' format tag.
pub const TUNE_FORMAT: &str = "recrash.tune/1";

/// One number of a scenario that may move. Together they are the logical scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Parameter {
    /// JSON pointer into the scenario, such as `/partners/0/start/arrival_gap_s`.
    pub pointer: String,
    /// Unit, such as `m/s`.
    pub unit: String,
    /// Least value that keeps the narrative true.
    pub min: f64,
    /// Greatest value that keeps the narrative true.
    pub max: f64,
    /// Value in the scenario as designed.
    pub start: f64,
    /// Whether only whole numbers make sense (steps).
    pub integer: bool,
    /// Why these bounds.
    pub reason: String,
}

/// What a search looks for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Aim {
    /// The nearest failure: a small gap, a contact where there is one (the default).
    #[default]
    Failure,
    /// The worst contact: a great change of velocity.
    Severity,
}

impl Aim {
    /// Every aim, the default first.
    pub const ALL: [Self; 2] = [Self::Failure, Self::Severity];

    /// Name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Failure => "failure",
            Self::Severity => "severity",
        }
    }
}

/// What one point of a search scored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// What the search makes small: the least box gap plus penalties, see `docs/models/tuning.md`. [m]
    pub objective: f64,
    /// Least box gap to a scripted partner that came nearer than it stood at the handover, or at the start. [m]
    pub min_gap: Option<Timed>,
    /// How deep the ego and what it touched would go into one another, where they touch. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_m: Option<f64>,
    /// Speeds of the ego and of the other at the contact. [m/s]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_mps: Option<(f64, f64)>,
    /// The ego's hardest braking. [m/s^2]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub braking: Option<Timed>,
    /// Kinds of findings.
    pub findings: Vec<FindingKind>,
    /// Whether the point counts as a failure of the ego.
    pub failed: bool,
    /// Why the point was refused, where it was: degenerate, unfaithful or not runnable.
    pub refused: Vec<String>,
}

/// One point of a search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TunePoint {
    /// Number, from 0: the scenario as designed.
    pub number: usize,
    /// Who proposed it, such as `start`, `sobol`, `local`.
    pub proposed_by: String,
    /// Values, in the order of the parameters.
    pub values: Vec<f64>,
    /// What it scored.
    pub score: Score,
}

/// The log of a search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TuneLog {
    /// Always [`TUNE_FORMAT`].
    #[serde(deserialize_with = "known_format")]
    pub format: String,
    /// Scenario.
    pub scenario_id: String,
    /// Search that was run.
    pub searcher: String,
    /// Seed.
    pub seed: u64,
    /// What may move.
    pub parameters: Vec<Parameter>,
    /// Every point, in order.
    pub points: Vec<TunePoint>,
    /// Number of the point that was kept.
    pub best: usize,
}

fn known_format<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    crate::formats::known(deserializer, TUNE_FORMAT)
}

/// Sets the parameters of a scenario. Whole-number parameters are rounded. Who starts at its target speed in the draft
/// still does so afterwards: a vehicle above its target would brake hard at once, and one below it come late.
///
/// # Errors
/// A pointer that is not in the scenario, or a value its place cannot hold: the pointer and what serde said.
pub fn apply(draft: &ScenarioDraft, parameters: &[Parameter], values: &[f64]) -> Result<ScenarioDraft, String> {
    let mut document = serde_json::to_value(draft).map_err(|e| e.to_string())?;
    let together = start_speeds(draft);
    for (parameter, &value) in parameters.iter().zip(values) {
        let place = document
            .pointer_mut(&parameter.pointer)
            .ok_or_else(|| format!("{}: no such place in scenario {}", parameter.pointer, draft.id))?;
        let number = if parameter.integer {
            serde_json::Number::from(value.round() as i64)
        } else {
            serde_json::Number::from_f64(value)
                .ok_or_else(|| format!("{}: {value} is not a finite number", parameter.pointer))?
        };
        *place = serde_json::Value::Number(number.clone());
        let start = together.iter().find(|(_, target)| *target == parameter.pointer);
        if let Some(start) = start.and_then(|(start, _)| document.pointer_mut(start)) {
            *start = serde_json::Value::Number(number);
        }
    }
    serde_json::from_value(document).map_err(|e| format!("scenario {}: {e}", draft.id))
}

/// First speeds that are equal to the target speed of their vehicle, so that the two move together: JSON pointers of the
/// first and of the target speed.
pub fn start_speeds(draft: &ScenarioDraft) -> Vec<(String, String)> {
    let mut list = Vec::new();
    if draft.ego.speed_mps == draft.ego.target_speed_mps {
        list.push(("/ego/speed_mps".to_owned(), "/ego/target_speed_mps".to_owned()));
    }
    for (number, partner) in draft.partners.iter().enumerate() {
        let (target_mps, field) = match partner.policy {
            Policy::IdmNominal { target_speed_mps } => (target_speed_mps, "target_speed_mps"),
            Policy::SuddenBrake { target_speed, .. } => (target_speed, "target_speed"),
            _ => continue,
        };
        if partner.speed_mps == target_mps {
            list.push((format!("/partners/{number}/speed_mps"), format!("/partners/{number}/policy/{field}")));
        }
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draft() -> ScenarioDraft {
        let ego = serde_json::json!({
            "turn": "straight", "lane": 0, "s_m": 5.0, "speed_mps": 8.0, "target_speed_mps": 8.3
        });
        let partner = serde_json::json!({
            "id": "cp1", "kind": "passenger_car", "approach": "left", "turn": "straight",
            "start": { "arrival_gap_s": -0.4 }, "speed_mps": 9.0,
            "policy": { "type": "idm_nominal", "target_speed_mps": 9.0 }
        });
        let template = serde_json::json!({
            "road": "intersection", "sv": "straight", "cp": "straight", "work_zone": false
        });
        let draft = serde_json::json!({
            "format": crate::scenario::SCENARIO_FORMAT, "id": "crossing",
            "source": { "records": [], "template": template, "narrative": "", "author": "rules", "seed": 1 },
            "map": { "type": "X", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "arm_m": 60.0 },
            "ego": ego, "partners": [partner], "duration_s": 20.0
        });
        serde_json::from_value(draft).unwrap()
    }

    fn moved(draft: &ScenarioDraft, pointer: &str, to: f64) -> ScenarioDraft {
        let (pointer, unit, reason) = (pointer.to_owned(), "m/s".to_owned(), String::new());
        let parameter = Parameter { pointer, unit, min: 0.0, max: 30.0, start: 1.0, integer: false, reason };
        apply(draft, &[parameter], &[to]).unwrap()
    }

    #[test]
    fn who_starts_at_its_target_speed_still_does() {
        let mut draft = draft();
        draft.ego.speed_mps = draft.ego.target_speed_mps;
        let tuned = moved(&draft, "/ego/target_speed_mps", 6.5);
        assert_eq!((tuned.ego.speed_mps, tuned.ego.target_speed_mps), (6.5, 6.5));
        draft.ego.speed_mps = 1.0;
        assert_eq!(moved(&draft, "/ego/target_speed_mps", 6.5).ego.speed_mps, 1.0);
        draft.partners[0].policy = Policy::IdmNominal { target_speed_mps: 8.0 };
        draft.partners[0].speed_mps = 8.0;
        assert_eq!(moved(&draft, "/partners/0/policy/target_speed_mps", 9.5).partners[0].speed_mps, 9.5);
        draft.partners[0].speed_mps = 0.0;
        assert_eq!(moved(&draft, "/partners/0/policy/target_speed_mps", 9.5).partners[0].speed_mps, 0.0);
    }
}
