//! What the rules say happened in a record, whether or not it can be staged: the reading in the terms of the labels.

use super::super::actors::Actor;
use super::order::{Met, first};
use super::zones::zones;
use super::{Relation, movement, only, read_sentences, reading_of, road, side_from_zones};
use recrash_model::kinds::PartnerKind;
use recrash_model::labelled::{LabelledAccount, RoadGroup};
use recrash_model::metrics::CollisionKind;
use recrash_model::narrative::Side;
use recrash_model::profile::SystemProfile;
use recrash_model::record::CrashRecord;
use recrash_model::scenario::Approach;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// Reads a record.
pub fn account(record: &CrashRecord, profile: &SystemProfile) -> LabelledAccount {
    let sentences = read_sentences(record);
    let reading = reading_of(record, &sentences);
    let relation = reading.relation.as_ref().map(|(relation, _)| *relation);
    let collision = reading.collision.map(|(kind, _)| kind);
    let mut sv_zones = zones(&sentences, Actor::Sv, &record.sv_zones);
    let mut cp_zones = zones(&sentences, Actor::Cp, &record.cp_zones);
    // In a rear-end collision a front meets a rear, whether or not that is ticked.
    let ends = match collision {
        Some(CollisionKind::RearEndOfEgo) => Some((ContactZone::Rear, ContactZone::Front)),
        Some(CollisionKind::RearEndByEgo) => Some((ContactZone::Front, ContactZone::Rear)),
        _ => None,
    };
    // Non-motorists have no zones.
    if let (Some((sv, cp)), Some(Movement::Straight | Movement::Stopped)) = (ends, record.cp_movement.known()) {
        if sv_zones.is_empty() {
            sv_zones.push(sv);
        }
        if cp_zones.is_empty()
            && record.partner.known().is_some_and(|kind| {
                !matches!(
                    kind,
                    PartnerKind::Cyclist
                        | PartnerKind::Pedestrian
                        | PartnerKind::OtherNonMotorist
                        | PartnerKind::Animal
                )
            })
        {
            cp_zones.push(cp);
        }
    }
    let sv_movement = movement::movement(&sentences, Actor::Sv, record.sv_movement.known(), relation);
    let mut account = LabelledAccount {
        road: road::road(record, &sentences, relation, sv_movement),
        sv_movement,
        cp_movement: movement::movement(&sentences, Actor::Cp, record.cp_movement.known(), relation),
        approach: None,
        order: None,
        collision,
        excluded: Some(collision.is_some_and(|kind| profile.excludes.collisions.contains(&kind))),
        sv_zones,
        cp_zones,
        ..LabelledAccount::default()
    };
    account.approach = told_approach(record, relation).or_else(|| likely_approach(record, &account));
    account.order = first(&Met {
        relation,
        collision,
        movements: (account.sv_movement, account.cp_movement),
        zones: (&account.sv_zones, &account.cp_zones),
    });
    account
}

fn approach_from(side: Side) -> Approach {
    match side {
        Side::Left => Approach::Left,
        Side::Right => Approach::Right,
    }
}

fn told_approach(record: &CrashRecord, relation: Option<Relation>) -> Option<Approach> {
    match relation? {
        Relation::From(side) => Some(approach_from(side)),
        Relation::Oncoming => Some(Approach::Opposite),
        Relation::Beside(_) | Relation::Behind => Some(Approach::Same),
        Relation::Crossing => side_from_zones(record).map(approach_from),
    }
}

/// What kind of collision, movements and contact areas make likely where nobody says from where the partner came.
fn likely_approach(record: &CrashRecord, account: &LabelledAccount) -> Option<Approach> {
    use Movement::{
        Backing, ChangingLanes, EnteringTraffic, LaneDeparture, Merging, Parked, Passing, Stopped, Straight,
    };
    match account.collision {
        Some(CollisionKind::RearEndByEgo | CollisionKind::RearEndOfEgo) => return Some(Approach::Same),
        Some(CollisionKind::HeadOn) => return Some(Approach::Opposite),
        _ => {}
    }
    match account.cp_movement {
        Some(Parked | Passing | ChangingLanes | Merging | LaneDeparture) => return Some(Approach::Same),
        Some(EnteringTraffic) => return side_from_zones(record).map(approach_from),
        _ => {}
    }
    let (sv, cp) = (&account.sv_zones, &account.cp_zones);
    if account.road == Some(RoadGroup::Highway) || account.cp_movement == Some(Stopped) {
        return Some(Approach::Same);
    }
    let ends = (only(sv, ContactZone::is_rear) && !cp.iter().any(|zone| zone.is_rear()))
        || (only(sv, ContactZone::is_front) && only(cp, ContactZone::is_rear));
    if ends {
        return Some(Approach::Same);
    }
    // A front in the middle of a side, where both go straight: they crossed.
    let flank = sv.contains(&ContactZone::Left) != sv.contains(&ContactZone::Right);
    let straight = matches!(account.sv_movement, Some(Straight | Stopped)) && account.cp_movement == Some(Straight);
    if flank && straight && cp.contains(&ContactZone::Front) {
        return side_from_zones(record).map(approach_from);
    }
    if flank && !cp.iter().any(|zone| zone.is_front()) && account.cp_movement != Some(Backing) && !cp.is_empty() {
        return Some(Approach::Same);
    }
    None
}
