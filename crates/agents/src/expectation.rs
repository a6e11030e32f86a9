//! What a rollout must show to be true to a narrative.

use crate::rules::staged::Facts;
use recrash_model::metrics::Expectation;
use recrash_model::narrative::{Fact, FactSource, FactValue, Narrative};
use recrash_model::profile::SystemProfile;
use recrash_model::record::CrashRecord;
use recrash_model::scenario::Approach;
use recrash_model::template::RoadType;

/// What the rollout must show: the template; the partner's approach and side where the narrative states them; speeds that
/// the record or its narrative tells, who was first, and the contact zones of `record`, the one whose crash is told (an
/// invented narrative is nobody's, so that none bind); and none of the collisions the profile excludes.
///
/// On a road without junction nobody can turn: there a move of at least half a lane width to one side counts as the turn
/// to that side (see `docs/models/rules.md` and `docs/models/faithfulness.md`).
pub fn expectation(narrative: &Narrative, record: &CrashRecord, profile: &SystemProfile) -> Expectation {
    let facts = Facts(&narrative.facts);
    let approach = facts.approach();
    let binds = narrative.told_record().is_some();
    // Side by side nobody is first at a place, and the partner keeps to the ego's speed.
    let crosses = approach.is_some_and(|approach| approach != Approach::Same);
    // On a circle paths run into one, and who is ahead there follows from how far around each drives.
    let has_place = crosses && narrative.template.road != RoadType::TrafficCircle;
    // Of a speed that nobody stated nothing must be seen, and an invented crash is nobody's.
    let stated = |fact: &&Fact| binds && !matches!(fact.source, FactSource::Assumed { .. });
    let told =
        |pick: fn(&FactValue) -> Option<f64>| narrative.facts.iter().filter(stated).find_map(|fact| pick(&fact.value));
    Expectation {
        template: narrative.template,
        approach,
        side: facts.side(),
        order: facts.first_mover().filter(|_| binds && has_place),
        sv_speed_mps: told(FactValue::sv_speed),
        cp_speed_mps: told(FactValue::cp_speed).filter(|_| crosses),
        sv_zones: if binds { record.sv_zones.clone() } else { Vec::new() },
        cp_zones: if binds { record.cp_zones.clone() } else { Vec::new() },
        excluded: profile.excludes.collisions.clone(),
        obstacles_named: narrative.facts.iter().any(|fact| matches!(fact.value, FactValue::Obstacles { .. })),
    }
}
