//! Headings of the partner to try: as it came, and at the contact.

use crate::told::crash::Told;
use crate::told::side::{Slant, Turning, is_on_foot};
use crate::told::zones::side_of;
use recrash_model::account::{ContactState, LeftRight, Origin};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// How far somebody has turned at least that turns across from the next lane. [deg]
const BESIDE_DEG: f64 = 22.0;

/// How far somebody has turned whose turn is over. [deg]
const OVER_DEG: [f64; 5] = [90.0, 80.0, 72.0, 100.0, 60.0];

pub(super) const fn sign(side: LeftRight) -> f64 {
    match side {
        LeftRight::Left => 1.0,
        LeftRight::Right => -1.0,
    }
}

/// Headings of the partner to try: as it came, and at the contact. Of who reverses, the way it faces. `behind`: of the ego's way where
/// somebody is who touches its rear. [rad]
pub(super) fn headings(told: &Told, sv_heading: f64, behind: f64) -> Vec<(f64, f64)> {
    let degrees = |deg: f64| deg * math::PI / 180.0;
    let reverses = told.cp.state == ContactState::Reversing;
    let unknown = |side: Option<LeftRight>| match side {
        Some(side) => vec![sign(side)],
        None => {
            let left = told
                .sv
                .zones
                .iter()
                .any(|z| matches!(z, ContactZone::Left | ContactZone::FrontLeft | ContactZone::RearLeft));
            if left { vec![1.0, -1.0] } else { vec![-1.0, 1.0] }
        }
    };
    // Into the ego's road, towards it.
    let into = |came: f64| {
        let left = if told.cp.turning == Turning::Left { 1.0 } else { -1.0 };
        let turned = [90.0, 86.0, 94.0, 82.0, 98.0, 75.0, 105.0].map(|off| came + left * degrees(off));
        turned.map(|heading| (came, heading)).into_iter().filter(|(_, heading)| math::cos(*heading) < -0.2)
    };
    let aside: &[f64] = &[0.0, 4.0, -4.0, 8.0, -8.0, 14.0, -14.0, 22.0, -22.0];
    let mut list: Vec<(f64, f64)> = Vec::new();
    let turned = |came: f64, list: &mut Vec<(f64, f64)>| match told.cp.turning {
        Turning::No => {
            for off in [0.0, 15.0, -15.0, 30.0, -30.0, 45.0, -45.0] {
                list.push((came, came + degrees(off)));
            }
        }
        Turning::Left | Turning::Round => {
            let over = if told.cp.turned { &OVER_DEG[..] } else { &[40.0, 60.0, 25.0, 75.0, 90.0, 12.0, 120.0] };
            list.extend(over.iter().map(|off| (came, came + degrees(*off))));
        }
        Turning::Right => {
            let over = if told.cp.turned { &OVER_DEG[..] } else { &[40.0, 60.0, 25.0, 75.0, 90.0, 12.0] };
            list.extend(over.iter().map(|off| (came, came - degrees(*off))));
        }
    };
    if told.lies.is_some() {
        return vec![(sv_heading, sv_heading)];
    }
    if told.stands_across() {
        list.push((sv_heading, sv_heading + math::FRAC_PI_2));
    }
    if told.cp.backs_in {
        return backing_in().collect();
    }
    if told.comes_across() {
        return coming_across(told).into_iter().map(math::wrap_angle).map(|heading| (heading, heading)).collect();
    }
    let along_kerb = matches!(told.origin, Origin::Parked { .. }) && !is_on_foot(told.cp.kind);
    if told.backs_from_behind() {
        list.extend(REAR_TO_REAR_DEG.map(degrees).map(|heading| (heading, heading)));
    }
    match told.origin {
        Origin::Behind | Origin::Ahead | Origin::Beside { .. } => {
            // Along the road, or as the ego has turned.
            match told.cp.slants {
                Some(Slant::Stood { side, oncoming }) => {
                    let came = if oncoming { 180.0 } else { 0.0 };
                    let signs = side.map_or(vec![1.0, -1.0], |side| vec![sign(side)]);
                    let turned =
                        signs.iter().flat_map(|sign| [60.0, 90.0, 45.0, 30.0].map(|off| degrees(came + sign * off)));
                    list.extend(turned.map(|heading| (heading, heading)));
                }
                Some(Slant::Swung) => {
                    let slanted = [30.0, -30.0, 22.0, -22.0, 45.0, -45.0, 60.0, -60.0, 90.0, -90.0];
                    list.extend(slanted.map(|off| (0.0, degrees(off))));
                }
                None => {}
            }
            let follows = told.origin == Origin::Behind && told.sv.turning != Turning::No;
            // Who touches the outer side of who turns ahead of it goes straight on.
            let outer = match told.sv.turning {
                Turning::Left => Some(-1.0),
                Turning::Right => Some(1.0),
                Turning::No | Turning::Round => None,
            };
            let goes_on = told.passes_from_behind()
                || told.cp.movement == Some(Movement::Straight) && outer.is_some() && side_of(&told.sv.zones) == outer;
            let bases = match (sv_heading.abs() > 0.02, follows) {
                (false, _) => vec![0.0],
                (true, true) if goes_on => vec![0.0, behind, sv_heading],
                (true, true) => vec![behind, sv_heading, 0.0],
                (true, false) if told.sv.turned => vec![sv_heading, 0.0],
                (true, false) => vec![0.0, sv_heading],
            };
            // Who turned beside it goes as it does.
            let abreast = told.sv.turned && told.cp.turning == told.sv.turning;
            if told.cp.turning == Turning::No || abreast {
                // Along the road that the ego has turned into, or along its way.
                let came = |base: f64| if told.sv.turned && !abreast && !follows { base } else { 0.0 };
                list.extend(
                    bases.iter().flat_map(|base| aside.iter().map(move |off| (came(*base), base + degrees(*off)))),
                );
            } else {
                turned(0.0, &mut list);
                // Out of the next lane some come no farther round.
                let from_beside = matches!(told.origin, Origin::Beside { .. }) && !told.cp.turned;
                let by = if told.cp.turning == Turning::Right { -BESIDE_DEG } else { BESIDE_DEG };
                list.extend(from_beside.then_some((0.0, degrees(by))));
            }
            if reverses {
                list.extend([90.0, -90.0, 60.0, -60.0, 30.0, -30.0].map(|off| (0.0, degrees(off))));
            }
        }
        Origin::Opposite => {
            if told.cp.turning == Turning::No {
                list.extend(aside.iter().map(|off| (math::PI, math::PI + degrees(*off))));
            } else {
                turned(math::PI, &mut list);
            }
        }
        Origin::Cross { side } => {
            // From the left it moves to the right; who reverses faces back.
            let came = -sign(side) * math::FRAC_PI_2 + if reverses { math::PI } else { 0.0 };
            let turns = matches!(told.cp.turning, Turning::Left | Turning::Right);
            if turns && (told.cp.turns_wide || told.sv.state.stands()) {
                list.extend(into(came));
            }
            if !told.cp.turns_wide {
                turned(came, &mut list);
            }
        }
        Origin::Stall { side } | Origin::Driveway { side } | Origin::Sidewalk { side } | Origin::Parked { side }
            if !along_kerb =>
        {
            for from in unknown(side) {
                let moves = -from * math::FRAC_PI_2;
                if matches!(told.cp.turning, Turning::Left | Turning::Right) && !reverses {
                    turned(moves, &mut list);
                    continue;
                }
                for off in [0.0, 20.0, 40.0, 60.0, -20.0, -40.0, 75.0] {
                    let toward = moves + from * degrees(off);
                    list.push((
                        if reverses { toward + math::PI } else { moves },
                        if reverses { toward + math::PI } else { toward },
                    ));
                }
            }
        }
        // It has come round the ego, and is beside it.
        Origin::Parked { .. } if told.cp.state == ContactState::Parked => {
            let faces = if told.is_parked_against() { math::PI } else { 0.0 };
            list.push((faces, faces));
        }
        Origin::Parked { .. } if told.comes_round => list.extend(aside.iter().map(|off| (0.0, degrees(*off)))),
        Origin::Stall { side } | Origin::Driveway { side } | Origin::Sidewalk { side } | Origin::Parked { side } => {
            for from in unknown(side) {
                for off in [10.0, 18.0, 28.0, 5.0, 40.0] {
                    list.push((0.0, -from * degrees(off)));
                }
            }
            if reverses {
                list.extend(aside.iter().map(|off| (0.0, degrees(*off))));
            }
        }
        Origin::Above => {}
    }
    if matches!(told.cp.kind, PartnerKind::FixedObject) {
        list.extend([0.0, 90.0, 45.0].map(|off| (sv_heading, sv_heading + degrees(off))));
    }
    list.into_iter().map(|(came, at)| (math::wrap_angle(came), math::wrap_angle(at))).collect()
}

/// Headings of who backs towards the ego from behind: its rear comes first. [deg]
const REAR_TO_REAR_DEG: [f64; 5] = [180.0, 165.0, -165.0, 150.0, -150.0];

/// Angles of who backs into a space at the kerb, to the road; its rear points to the kerb. [deg]
const BACKS_IN_DEG: [f64; 7] = [25.0, 30.0, 20.0, 35.0, 12.0, 5.0, 0.0];

/// Headings of who backs into a space on the right. [rad]
fn backing_in() -> impl Iterator<Item = (f64, f64)> {
    BACKS_IN_DEG.into_iter().map(|degrees| (0.0, degrees * math::PI / 180.0))
}

/// Across the ego's lane: from the told side, or from both.
fn coming_across(told: &Told) -> Vec<f64> {
    let from = match told.origin {
        Origin::Beside { side } | Origin::Cross { side } => vec![side],
        _ => vec![LeftRight::Right, LeftRight::Left],
    };
    let across = |side: LeftRight| if side == LeftRight::Left { -math::FRAC_PI_2 } else { math::FRAC_PI_2 };
    from.into_iter().flat_map(|side| [0.0, 0.5, -0.5].map(|off| across(side) + off)).collect()
}
