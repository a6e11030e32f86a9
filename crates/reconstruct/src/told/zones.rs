//! Zones: on which side of somebody they lie, and how far one is off those that are told.

use recrash_model::account::LeftRight;
use recrash_model::zones::ContactZone;

/// Steps around the box from the nearest told zone; none where none is told. Of several on one flank all count on that, and what is told to be
/// the rear no front shows.
pub(crate) fn zones_off(told: &[ContactZone], seen: ContactZone) -> u32 {
    let nearest = told.iter().filter_map(|zone| zone.steps_apart(seen)).min().map_or(0, u32::from);
    let flank = side_of(&[seen]);
    let along = told.iter().filter(|zone| flank.is_some() && side_of(&[**zone]) == flank);
    let farthest = along.filter_map(|zone| zone.steps_apart(seen)).max().map_or(0, u32::from);
    let is_rear = told.iter().any(|zone| zone.is_rear()) && !told.iter().any(|zone| zone.is_front());
    match nearest {
        // All of an end that is ticked is its middle.
        0 if is_whole_end(told, seen) => 1,
        0 => 0,
        _ if is_rear && seen.is_front() => nearest.max(farthest).max(REAR_OFF),
        _ => nearest.max(farthest),
    }
}

/// Whether a corner is one of an end of which both corners and the middle are told.
fn is_whole_end(told: &[ContactZone], seen: ContactZone) -> bool {
    use ContactZone as Z;
    let end = match seen {
        Z::FrontLeft | Z::FrontRight => [Z::FrontLeft, Z::Front, Z::FrontRight],
        Z::RearLeft | Z::RearRight => [Z::RearLeft, Z::Rear, Z::RearRight],
        _ => return false,
    };
    end.iter().all(|zone| told.contains(zone))
}

/// Who is told to touch with its rear is so many steps off with its front. [steps]
const REAR_OFF: u32 = 2;

/// The side on which these zones lie, front and rear aside; nothing where they lie on both, or on neither.
pub(crate) fn side_of(zones: &[ContactZone]) -> Option<LeftRight> {
    let side = |zone: &ContactZone| match zone {
        ContactZone::FrontLeft | ContactZone::Left | ContactZone::RearLeft => Some(LeftRight::Left),
        ContactZone::FrontRight | ContactZone::Right | ContactZone::RearRight => Some(LeftRight::Right),
        ContactZone::Front | ContactZone::Rear | ContactZone::Top | ContactZone::Bottom => None,
    };
    let first = zones.iter().find_map(side)?;
    zones.iter().all(|zone| side(zone) != Some(first.other())).then_some(first)
}
