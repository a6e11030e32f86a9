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

/// Off the line of who keeps to it. [deg]
const ASIDE_DEG: [f64; 9] = [0.0, 4.0, -4.0, 8.0, -8.0, 14.0, -14.0, 22.0, -22.0];

/// What hangs across the lane, and is met with a corner, is aslant by so much. [deg]
const HANGS_DEG: f64 = 10.0;

/// Headings as somebody came, and at the contact. [rad]
type Headings = (f64, f64);

fn rad(degrees: f64) -> f64 {
    degrees * math::PI / 180.0
}

/// Headings of the partner to try. Of who reverses, the way it faces. `behind`: of the ego's way where somebody is who touches its
/// rear. [rad]
pub(super) fn headings(told: &Told, sv_heading: f64, behind: f64) -> Vec<Headings> {
    if told.lies.is_some() {
        return vec![(sv_heading, sv_heading)];
    }
    if told.cp.backs_in {
        return backing_in().collect();
    }
    if told.comes_across() {
        return coming_across(told).into_iter().map(math::wrap_angle).map(|heading| (heading, heading)).collect();
    }
    let mut list = Vec::new();
    if told.stands_across() {
        list.push((sv_heading, sv_heading + math::FRAC_PI_2));
    }
    // It hangs a little aslant: the told corner comes to it first. What bars the way does so where the ego has turned, too.
    list.extend(told.meets_chain().map(|side| (sv_heading, sv_heading + side.sign() * rad(HANGS_DEG))));
    list.extend(told.bars_way().then_some((sv_heading, sv_heading)));
    if told.backs_from_behind() {
        list.extend(REAR_TO_REAR_DEG.map(rad).map(|heading| (heading, heading)));
    }
    if let (Some(turn), Origin::Cross { side }) = (told.turns_over_walk(), told.origin) {
        list.extend(over_walk(turn, side));
    }
    let along_kerb = !is_on_foot(told.cp.kind);
    list.extend(match told.origin {
        Origin::Behind | Origin::Ahead | Origin::Beside { .. } => along_the_road(told, sv_heading, behind),
        Origin::Opposite if told.cp.turning == Turning::No => {
            ASIDE_DEG.map(|off| (math::PI, math::PI + rad(off))).to_vec()
        }
        Origin::Opposite => turned(told, math::PI),
        Origin::Cross { side } => crossing(told, side),
        Origin::Parked { side } if along_kerb => from_the_kerb(told, side),
        Origin::Stall { side } | Origin::Driveway { side } | Origin::Sidewalk { side } | Origin::Parked { side } => {
            from_beside_the_road(told, side)
        }
        Origin::Above => Vec::new(),
    });
    if matches!(told.cp.kind, PartnerKind::FixedObject) {
        list.extend([0.0, 90.0, 45.0].map(|off| (sv_heading, sv_heading + rad(off))));
    }
    list.into_iter().map(|(came, at)| (math::wrap_angle(came), math::wrap_angle(at))).collect()
}

/// Of who came so and turns as it is told to.
fn turned(told: &Told, came: f64) -> Vec<Headings> {
    let offs: &[f64] = match told.cp.turning {
        Turning::No => &[0.0, 15.0, -15.0, 30.0, -30.0, 45.0, -45.0],
        _ if told.cp.turned => &OVER_DEG,
        Turning::Left | Turning::Round => &[40.0, 60.0, 25.0, 75.0, 90.0, 12.0, 120.0],
        Turning::Right => &[40.0, 60.0, 25.0, 75.0, 90.0, 12.0],
    };
    let left = if told.cp.turning == Turning::Right { -1.0 } else { 1.0 };
    offs.iter().map(|off| (came, came + left * rad(*off))).collect()
}

/// Of who drives along the ego's road, or as the ego has turned.
fn along_the_road(told: &Told, sv_heading: f64, behind: f64) -> Vec<Headings> {
    let mut list = told.cp.slants.map_or(Vec::new(), slanted);
    // Who turned beside it goes as it does.
    let abreast = told.sv.turned && told.cp.turning == told.sv.turning;
    if told.cp.turning == Turning::No || abreast {
        let follows = told.origin == Origin::Behind && told.sv.turning != Turning::No;
        // Along the road that the ego has turned into, or along its way.
        let came = |base: f64| if told.sv.turned && !abreast && !follows { base } else { 0.0 };
        let bases = along(told, sv_heading, follows.then_some(behind));
        list.extend(bases.iter().flat_map(|base| ASIDE_DEG.map(|off| (came(*base), base + rad(off)))));
    } else {
        // Who follows it through its turn is about as far in that.
        let follows = told.origin == Origin::Behind && told.cp.turning == told.sv.turning && !told.cp.turned;
        list.extend(ASIDE_DEG.iter().filter(|_| follows).map(|off| (0.0, behind + rad(*off))));
        list.extend(turned(told, 0.0));
        // Out of the next lane some come no farther round.
        let from_beside = matches!(told.origin, Origin::Beside { .. }) && !told.cp.turned;
        let by = if told.cp.turning == Turning::Right { -BESIDE_DEG } else { BESIDE_DEG };
        list.extend(from_beside.then_some((0.0, rad(by))));
    }
    if told.cp.state == ContactState::Reversing {
        list.extend([90.0, -90.0, 60.0, -60.0, 30.0, -30.0].map(|off| (0.0, rad(off))));
    }
    list
}

/// Of who stood aslant, or swung round.
fn slanted(slant: Slant) -> Vec<Headings> {
    match slant {
        Slant::Stood { side, oncoming } => {
            let came = if oncoming { 180.0 } else { 0.0 };
            let signs = side.map_or(vec![1.0, -1.0], |side| vec![side.sign()]);
            let offs = signs.iter().flat_map(|sign| [60.0, 90.0, 45.0, 30.0].map(|off| rad(came + sign * off)));
            offs.map(|heading| (heading, heading)).collect()
        }
        Slant::Swung => {
            let offs = [30.0, -30.0, 22.0, -22.0, 45.0, -45.0, 60.0, -60.0, 90.0, -90.0];
            offs.map(|off| (0.0, rad(off))).to_vec()
        }
    }
}

/// Directions to drive along: of the ego's road and of the ego, which may have turned. `behind`: of who follows it through its turn.
fn along(told: &Told, sv_heading: f64, behind: Option<f64>) -> Vec<f64> {
    if sv_heading.abs() <= 0.02 {
        return vec![0.0];
    }
    // Who touches the outer side of who turns ahead of it goes straight on.
    let outer = match told.sv.turning {
        Turning::Left => Some(LeftRight::Right),
        Turning::Right => Some(LeftRight::Left),
        Turning::No | Turning::Round => None,
    };
    let goes_on = told.passes_from_behind()
        || told.cp.movement == Some(Movement::Straight) && outer.is_some() && side_of(&told.sv.zones) == outer;
    match behind {
        Some(behind) if goes_on => vec![0.0, behind, sv_heading],
        Some(behind) => vec![behind, sv_heading, 0.0],
        None if told.sv.turned => vec![sv_heading, 0.0],
        None => vec![0.0, sv_heading],
    }
}

/// Of who comes from the road that crosses the ego's: from the left it moves to the right; who reverses faces back.
fn crossing(told: &Told, side: LeftRight) -> Vec<Headings> {
    let reverses = told.cp.state == ContactState::Reversing;
    let came = -side.sign() * math::FRAC_PI_2 + if reverses { math::PI } else { 0.0 };
    let turns = matches!(told.cp.turning, Turning::Left | Turning::Right);
    let mut list = Vec::new();
    if turns && (told.cp.turns_wide || told.sv.state.stands()) {
        // Into the ego's road, towards it.
        let left = if told.cp.turning == Turning::Left { 1.0 } else { -1.0 };
        let into = [90.0, 86.0, 94.0, 82.0, 98.0, 75.0, 105.0].map(|off| came + left * rad(off));
        list.extend(into.into_iter().filter(|heading| math::cos(*heading) < -0.2).map(|heading| (came, heading)));
    }
    if !told.cp.turns_wide {
        list.extend(turned(told, came));
    }
    list
}

/// Of who walks over the road that the ego turns into, from the told side of that.
fn over_walk(turn: LeftRight, side: LeftRight) -> [Headings; 3] {
    let came = (turn.sign() - side.sign()) * math::FRAC_PI_2;
    [0.0, 10.0, -10.0].map(|off| (came, came + rad(off)))
}

/// The sides that somebody beside the road may come from, the likely one first. [1 is left, -1 right]
fn from(told: &Told, side: Option<LeftRight>) -> Vec<f64> {
    let left = |zone: &ContactZone| matches!(zone, ContactZone::Left | ContactZone::FrontLeft | ContactZone::RearLeft);
    match side {
        Some(side) => vec![side.sign()],
        None if told.sv.zones.iter().any(left) => vec![1.0, -1.0],
        None => vec![-1.0, 1.0],
    }
}

/// Of who comes onto the road from beside it.
fn from_beside_the_road(told: &Told, side: Option<LeftRight>) -> Vec<Headings> {
    let reverses = told.cp.state == ContactState::Reversing;
    let turns = matches!(told.cp.turning, Turning::Left | Turning::Right) && !reverses;
    let from_side = |from: f64| {
        let moves = -from * math::FRAC_PI_2;
        if turns {
            return turned(told, moves);
        }
        let toward = [0.0, 20.0, 40.0, 60.0, -20.0, -40.0, 75.0].map(|off| moves + from * rad(off));
        let faces = |toward: f64| if reverses { (toward + math::PI, toward + math::PI) } else { (moves, toward) };
        toward.map(faces).to_vec()
    };
    from(told, side).into_iter().flat_map(from_side).collect()
}

/// Of a vehicle that stands at the kerb, or leaves it.
fn from_the_kerb(told: &Told, side: Option<LeftRight>) -> Vec<Headings> {
    if told.cp.state == ContactState::Parked {
        let faces = if told.is_parked_against() { math::PI } else { 0.0 };
        return vec![(faces, faces)];
    }
    let aside = ASIDE_DEG.map(|off| (0.0, rad(off)));
    // It has come round the ego, and is beside it.
    if told.comes_round {
        return aside.to_vec();
    }
    let turns_round = told.cp.turning == Turning::Round;
    let offs = if turns_round { [75.0, 90.0, 65.0, 110.0, 130.0] } else { [10.0, 18.0, 28.0, 5.0, 40.0] };
    let leaves = |from: f64| offs.map(|off| (0.0, -from * rad(off)));
    let mut list: Vec<Headings> = from(told, side).into_iter().flat_map(leaves).collect();
    if told.cp.state == ContactState::Reversing {
        list.extend(aside);
    }
    list
}

/// Headings of who backs towards the ego from behind: its rear comes first. [deg]
const REAR_TO_REAR_DEG: [f64; 5] = [180.0, 165.0, -165.0, 150.0, -150.0];

/// Angles of who backs into a space at the kerb, to the road; its rear points to the kerb. [deg]
const BACKS_IN_DEG: [f64; 7] = [25.0, 30.0, 20.0, 35.0, 12.0, 5.0, 0.0];

/// Headings of who backs into a space on the right. [rad]
fn backing_in() -> impl Iterator<Item = (f64, f64)> {
    BACKS_IN_DEG.into_iter().map(|degrees| (0.0, rad(degrees)))
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
