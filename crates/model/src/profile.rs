//! The system profile: what the system under test and its simulator can express, what is not to be generated, and what
//! counts as a failure. Another profile gives another suite from the same records.

use crate::conflict::CollisionKind;
use crate::kinds::PartnerKind;
use crate::template::{Movement, RoadType, Template};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The profile files' format tag.
pub const PROFILE_FORMAT: &str = "recrash.profile/1";

/// A system profile (`profiles/*.toml`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SystemProfile {
    /// Always [`PROFILE_FORMAT`].
    pub format: String,
    /// Short name, such as `paper`.
    pub name: String,
    /// One sentence on what it stands for.
    pub description: String,
    /// The ego that is run where the user names none.
    pub ego: String,
    /// How records are counted and filtered.
    pub records: RecordRules,
    /// What can be expressed.
    pub expresses: Expressible,
    /// What is not to be generated.
    pub excludes: Excluded,
    /// What counts as a failure.
    pub failure: FailureCriteria,
}

/// How records are counted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordRules {
    /// Which reports of one incident are merged.
    pub dedupe: Dedupe,
    /// What scenarios are made of.
    #[serde(default)]
    pub tells: Tells,
}

/// What scenarios are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Tells {
    /// Templates: the categorical columns of single reports, staged with the system under test (the paper's way).
    #[default]
    Templates,
    /// Accounts: what all reports of an incident tell, reconstructed with the recorded driver, each told fact held against
    /// the rollout; the system under test takes over before the contact.
    Accounts,
}

/// Which reports of one incident are merged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Dedupe {
    /// None: every row counts (the paper's counting).
    None,
    /// Newest version of each report, one report per incident.
    Incident,
}

/// What the system under test and its simulator can express.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expressible {
    /// Road types, in the order of tables.
    pub road_types: Vec<RoadType>,
    /// Movements of the subject vehicle, in the order of tables.
    pub sv_movements: Vec<Movement>,
    /// Movements of the crash partner, in the order of tables.
    pub cp_movements: Vec<Movement>,
    /// Whether work zones can be set up.
    pub work_zone: bool,
    /// Kinds of crash partner that can be simulated as themselves; other kinds are replaced by a passenger car, and
    /// the narrative says so.
    pub partner_kinds: Vec<PartnerKind>,
    /// Least target speed of the ego. [m/s]
    pub min_speed_mps: f64,
    /// Greatest target speed of any vehicle. [m/s]
    pub max_speed_mps: f64,
    /// Greatest background traffic density, in the sense of MetaDrive. [vehicles per 10 m of lane]
    pub max_traffic_density: f64,
}

/// What is not to be generated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Excluded {
    /// Kinds of collision.
    pub collisions: Vec<CollisionKind>,
}

/// What counts as a failure of the ego.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FailureCriteria {
    /// A box gap to a partner below this is a failure. [m]
    pub min_gap_m: f64,
    /// Braking harder than this is a finding. [m/s^2, positive]
    pub hard_braking_mps2: f64,
    /// Braking harder than this with nothing in the way is phantom braking. [m/s^2, positive]
    pub phantom_braking_mps2: f64,
    /// Changes from braking to accelerating and back within [`Self::oscillation_window_s`] that make an oscillation.
    pub oscillation_reversals: u32,
    /// Window of the oscillation count. [s]
    pub oscillation_window_s: f64,
    /// Leaving the lane by more than this is a finding. [m, box edge beyond the lane's edge]
    pub lane_departure_m: f64,
}

impl SystemProfile {
    /// Whether records of this template can be re-created under this profile.
    pub fn expresses(&self, template: &Template) -> bool {
        let e = &self.expresses;
        e.road_types.contains(&template.road)
            && e.sv_movements.contains(&template.sv)
            && e.cp_movements.contains(&template.cp)
            && (e.work_zone || !template.work_zone)
    }

    /// Every template the profile can express, in the order of tables.
    pub fn templates(&self) -> Vec<Template> {
        let e = &self.expresses;
        let zones: &[bool] = if e.work_zone { &[false, true] } else { &[false] };
        let mut all = Vec::new();
        for &road in &e.road_types {
            for &sv in &e.sv_movements {
                for &cp in &e.cp_movements {
                    for &work_zone in zones {
                        all.push(Template { road, sv, cp, work_zone });
                    }
                }
            }
        }
        all
    }
}
