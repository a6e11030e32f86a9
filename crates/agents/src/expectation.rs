//! What a rollout must show to be true to a narrative.

use recrash_model::metrics::Expectation;
use recrash_model::narrative::{FactValue, Narrative, Origin};
use recrash_model::profile::SystemProfile;
use recrash_model::record::CrashRecord;

/// What the rollout must show: the template; the partner's approach where the narrative states one; the record's contact
/// zones where the narrative retells the record (an alternative is another collision, so they do not bind); and none of
/// the collisions the profile excludes.
///
/// On a road without junction nobody can turn: there a move of at least half a lane width to one side counts as the turn
/// to that side (see `docs/models/rules.md` and `docs/models/faithfulness.md`).
pub fn expectation(narrative: &Narrative, record: &CrashRecord, profile: &SystemProfile) -> Expectation {
    let approach = narrative.facts.iter().find_map(|fact| match fact.value {
        FactValue::Approach { approach } => Some(approach),
        _ => None,
    });
    let binds = narrative.origin == Origin::Record;
    Expectation {
        template: narrative.template,
        approach,
        sv_zones: if binds { record.sv_zones.clone() } else { Vec::new() },
        cp_zones: if binds { record.cp_zones.clone() } else { Vec::new() },
        excluded: profile.excludes.collisions.clone(),
        obstacles_named: narrative.facts.iter().any(|fact| matches!(fact.value, FactValue::Obstacles { .. })),
    }
}
