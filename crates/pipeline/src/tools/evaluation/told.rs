//! What an account says of the fields that the labels have.

use recrash_model::account::{Account, CrashType, LeftRight, Origin, PlaceKind, told};
use recrash_model::labelled::{LabelledAccount, RoadGroup};
use recrash_model::metrics::CollisionKind;
use recrash_model::profile::SystemProfile;
use recrash_model::scenario::Approach;

/// An account in the terms of the labels.
pub fn in_labels(account: &Account, profile: &SystemProfile) -> LabelledAccount {
    let partner = account.partner.as_ref();
    let collision = collision(account);
    let known = account.crash_type.is_some();
    LabelledAccount {
        road: told(&account.place.kind).map(road),
        sv_movement: told(&account.sv.movement),
        cp_movement: partner.and_then(|partner| told(&partner.movement)),
        approach: told(&account.came_from).and_then(approach),
        order: told(&account.order),
        sv_zones: account.sv.zone_values(),
        cp_zones: partner.map(recrash_model::account::Party::zone_values).unwrap_or_default(),
        collision,
        excluded: known.then(|| collision.is_some_and(|kind| profile.excludes.collisions.contains(&kind))),
    }
}

fn road(kind: PlaceKind) -> RoadGroup {
    match kind {
        PlaceKind::Intersection => RoadGroup::Intersection,
        PlaceKind::Street | PlaceKind::Alley => RoadGroup::Street,
        PlaceKind::Highway => RoadGroup::Highway,
        PlaceKind::Circle => RoadGroup::Circle,
        PlaceKind::ParkingLot => RoadGroup::Parking,
        PlaceKind::Garage | PlaceKind::Driveway | PlaceKind::Other => RoadGroup::Other,
    }
}

fn approach(origin: Origin) -> Option<Approach> {
    let of = |side: LeftRight| match side {
        LeftRight::Left => Approach::Left,
        LeftRight::Right => Approach::Right,
    };
    match origin {
        Origin::Behind | Origin::Ahead | Origin::Beside { .. } | Origin::Parked { .. } => Some(Approach::Same),
        Origin::Opposite => Some(Approach::Opposite),
        Origin::Cross { side } => Some(of(side)),
        Origin::Stall { side } | Origin::Driveway { side } | Origin::Sidewalk { side } => side.map(of),
        Origin::Above => None,
    }
}

/// The kind of collision that the labels know; backing, doors and the like are none of them.
fn collision(account: &Account) -> Option<CollisionKind> {
    let front = |zones: &[recrash_model::zones::ContactZone]| zones.iter().any(|zone| zone.is_front());
    let sv = account.sv.zone_values();
    let cp = account.partner.as_ref().map(recrash_model::account::Party::zone_values).unwrap_or_default();
    let behind = matches!(told(&account.came_from), Some(Origin::Behind)) && sv.iter().any(|zone| zone.is_rear());
    match told(&account.crash_type)? {
        CrashType::FrontToRear if told(&account.came_from) == Some(Origin::Ahead) => Some(CollisionKind::RearEndByEgo),
        CrashType::FrontToRear => Some(CollisionKind::RearEndOfEgo),
        CrashType::Secondary | CrashType::Motorcycle | CrashType::Cyclist | CrashType::Pedestrian if behind => {
            Some(CollisionKind::RearEndOfEgo)
        }
        CrashType::HeadOn if front(&sv) && front(&cp) => Some(CollisionKind::HeadOn),
        CrashType::HeadOn | CrashType::Lateral => Some(CollisionKind::Sideswipe),
        CrashType::Intersection | CrashType::Motorcycle | CrashType::Cyclist | CrashType::Pedestrian => {
            Some(CollisionKind::Angle)
        }
        CrashType::Secondary | CrashType::SingleVehicle | CrashType::Backing | CrashType::Other => None,
    }
}
