//! What a rollout must show to be true to a narrative.

use crate::rules::limits::{LEAST_TOLD_SPEED_MPS, most_speed, most_speed_of};
use crate::rules::staged::{Facts, Ground, ground, staging_of, turn};
use recrash_model::metrics::Expectation;
use recrash_model::narrative::{FactSource, FactValue, Narrative};
use recrash_model::profile::SystemProfile;
use recrash_model::record::CrashRecord;
use recrash_model::scenario::Approach;
use recrash_model::template::RoadType;

/// What the rollout must show: the template; the partner's approach and side where the narrative states them; speeds that
/// the record or its narrative tells, as far as the map allows them; who was first and the contact zones of `record`, the
/// one whose crash is told (an invented narrative is nobody's, so that none bind); and none of the collisions the profile
/// excludes.
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
    let ground = staging_of(narrative, &facts).map_or(Ground::Junction, |way| ground(&narrative.template, &way));
    let most = |movement| most_speed(ground, turn(ground, movement)).min(profile.expresses.max_speed_mps);
    let most_of_partner = most(narrative.template.cp).min(facts.partner().map_or(f64::INFINITY, most_speed_of));
    let sv_speed = told_speed(narrative, |value| match value {
        FactValue::SvSpeed { speed_mps } => Some(*speed_mps),
        _ => None,
    });
    let cp_speed = told_speed(narrative, |value| match value {
        FactValue::CpSpeed { speed_mps } => Some(*speed_mps),
        _ => None,
    });
    Expectation {
        template: narrative.template,
        approach,
        side: facts.side(),
        order: facts.first_mover().filter(|_| binds && has_place),
        sv_speed_mps: sv_speed.map(|told| told.min(most(narrative.template.sv))),
        cp_speed_mps: cp_speed.filter(|_| crosses).map(|told| told.min(most_of_partner)),
        sv_zones: if binds { record.sv_zones.clone() } else { Vec::new() },
        cp_zones: if binds { record.cp_zones.clone() } else { Vec::new() },
        excluded: profile.excludes.collisions.clone(),
        obstacles_named: narrative.facts.iter().any(|fact| matches!(fact.value, FactValue::Obstacles { .. })),
    }
}

/// A speed that somebody stated. Crawling speeds are those of a vehicle that had braked.
fn told_speed(narrative: &Narrative, pick: fn(&FactValue) -> Option<f64>) -> Option<f64> {
    let stated = narrative.facts.iter().filter(|fact| !matches!(fact.source, FactSource::Assumed { .. }));
    stated.filter_map(|fact| pick(&fact.value)).next().filter(|told| *told >= LEAST_TOLD_SPEED_MPS)
}
