//! What the rules say happened in a record, whether or not it can be staged: the reading in the terms of the labels.

use super::super::actors::Actor;
use super::{Relation, movement, read_sentences, relation_from_zones, zones};
use recrash_model::account::Account;
use recrash_model::narrative::Side;
use recrash_model::profile::SystemProfile;
use recrash_model::record::{ContactZone, CrashRecord};
use recrash_model::scenario::Approach;

/// Reads a record.
pub fn account(record: &CrashRecord, profile: &SystemProfile) -> Account {
    let sentences = read_sentences(record);
    let reading = super::reading_of(record, &sentences);
    let relation = reading.relation.as_ref().map(|(relation, _)| *relation);
    let sv_movement = movement::movement(&sentences, Actor::Sv, record.sv_movement.known(), relation);
    let cp_movement = movement::movement(&sentences, Actor::Cp, record.cp_movement.known(), relation);
    let told = |actor, column: &[ContactZone]| {
        let told = zones::told(&sentences, actor);
        if told.is_empty() { column.to_vec() } else { told }
    };
    let (sv_zones, cp_zones) = (told(Actor::Sv, &record.sv_zones), told(Actor::Cp, &record.cp_zones));
    let collision = reading.collision.map(|(kind, _)| kind);
    Account {
        road: record.road.known().map(Into::into),
        sv_movement,
        cp_movement,
        approach: approach(record, relation),
        order: super::first_mover(&sv_zones, &cp_zones),
        collision,
        excluded: Some(collision.is_some_and(|kind| profile.excludes.collisions.contains(&kind))),
        sv_zones,
        cp_zones,
    }
}

fn approach(record: &CrashRecord, relation: Option<Relation>) -> Option<Approach> {
    let side = |side| match side {
        Side::Left => Approach::Left,
        Side::Right => Approach::Right,
    };
    match relation {
        Some(Relation::From(from)) => Some(side(from)),
        Some(Relation::Oncoming) => Some(Approach::Opposite),
        Some(Relation::Beside(_) | Relation::Behind) => Some(Approach::Same),
        Some(Relation::Crossing) => relation_from_zones(record).map(side),
        None => None,
    }
}
