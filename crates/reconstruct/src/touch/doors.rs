//! Crashes with a door: it opens into who is beside it, or stands open when somebody comes.

use crate::ego::plan::sv_at_contact;
use crate::ground::way::Ground;
use crate::told::crash::Told;
use crate::told::layout::StoodOpen;
use crate::told::side::{Side, Turning, size_of};
use crate::told::zones::{side_of, zones_off};
use crate::touch::boxes::{points, velocity};
use crate::touch::headings::headings;
use crate::touch::opening::{DOOR_M, OPEN_DEG, OPENS_S, Opening, THICK_M, zone_of};
use crate::touch::staging::Staging;
use recrash_metrics::contact::contact_geometry;
use recrash_model::account::{Act, ContactState, LeftRight, Origin, Striker};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::scenario::{Part, PartKind, StripKind};
use recrash_model::zones::ContactZone;
use std::rc::Rc;

/// A door that stands open when somebody comes has begun to open so long before. [s]
const OPENED_BEFORE_S: f64 = 2.0;

/// One that is told to have stood open then has for so long, and one that nobody opened, for longer than there is a scene. [s]
const OPENED_SHORTLY_S: f64 = 4.0;
const OPEN_ALL_ALONG_S: f64 = 60.0;

/// Who comes to an open door meets it so far from its end, and who has one swung into him so far. [m]
const MET_AT_M: f64 = 0.3;
const SWUNG_INTO_M: f64 = 0.02;

/// The hinge of a front door lies so far behind the front of a car, that of a rear door so far behind its middle. [m]
const FRONT_HINGE_M: f64 = 1.7;
const REAR_HINGE_M: f64 = 0.2;

/// Who passes a door comes along beside it for so long. [s]
const PASSES_S: f64 = 1.2;

/// Who has doors on its sides.
fn has_doors(kind: PartnerKind) -> bool {
    !matches!(
        kind,
        PartnerKind::Cyclist
            | PartnerKind::Motorcycle
            | PartnerKind::Pedestrian
            | PartnerKind::OtherNonMotorist
            | PartnerKind::Animal
            | PartnerKind::FixedObject
    )
}

/// The doors to try: those of the told zones' side first, then those of the side where the other comes by.
fn openings(told: &Told, owner: &Side, of_sv: bool) -> Vec<Opening> {
    let (length_m, width_m) = size_of(owner);
    let other_is = match told.origin {
        Origin::Beside { side: LeftRight::Left } => 1.0,
        Origin::Beside { side: LeftRight::Right } => -1.0,
        Origin::Parked { side: Some(LeftRight::Right) } => -1.0,
        _ => 1.0,
    };
    // Seen from the partner the ego is on the other side.
    let usual = if of_sv { other_is } else { -other_is };
    let first = side_of(&owner.zones).map_or(usual, LeftRight::sign);
    let (front_m, rear_m) = (0.5 * length_m - FRONT_HINGE_M, -REAR_HINGE_M);
    let is_rear = owner.zones.iter().any(|zone| zone.is_rear());
    let hinges = match told.layout.rear_door {
        Some(true) => vec![rear_m],
        Some(false) => vec![front_m],
        None if is_rear || of_sv => vec![rear_m, front_m],
        None => vec![front_m, rear_m],
    };
    let opened_s = match told.layout.stood_open {
        Some(StoodOpen::AllAlong) => vec![OPEN_ALL_ALONG_S],
        Some(StoodOpen::Shortly) => vec![OPENED_SHORTLY_S],
        None if drives_open(told, of_sv) => vec![OPEN_ALL_ALONG_S],
        None => vec![0.5, 0.7, 0.4, 0.9, OPENED_BEFORE_S],
    };
    let mut list = Vec::new();
    for side in [first, -first] {
        for &x_m in &hinges {
            for &before_s in &opened_s {
                let part = Part {
                    id: "door".to_owned(),
                    kind: PartKind::Door,
                    x_m,
                    y_m: side * 0.5 * width_m,
                    length_m: DOOR_M,
                    width_m: THICK_M,
                    axle_m: None,
                };
                let met_m = if before_s > OPENS_S { MET_AT_M } else { SWUNG_INTO_M };
                list.push(Opening { of_sv, part, before_s, to_deg: OPEN_DEG, met_m });
            }
        }
    }
    list
}

/// Whether the door is that of a partner that drives, and nobody is told to open it: it was open, more likely.
fn drives_open(told: &Told, of_sv: bool) -> bool {
    let opened = told.cp.acts.iter().any(|doing| doing.act == Act::OpenDoor);
    !of_sv && told.cp.state == ContactState::Moving && told.thing.is_none() && !opened
}

/// The arm of a gate, and where it may meet the other, from its end. [m]
const ARM_M: f64 = 3.6;
const ARM_THICK_M: f64 = 0.1;
const ARM_MET_M: [f64; 5] = [0.3, 0.02, 0.8, 1.5, 2.2];

/// Arms of a gate to try: they lie along the way through it, and swing across it.
fn arms() -> Vec<Opening> {
    let part = Part {
        id: "arm".to_owned(),
        kind: PartKind::Arm,
        x_m: 0.0,
        y_m: 0.0,
        length_m: ARM_M,
        width_m: ARM_THICK_M,
        axle_m: None,
    };
    let mut list = Vec::new();
    for to_deg in [90.0, -90.0] {
        for before_s in [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3] {
            let arm = |met_m: f64| Opening { of_sv: false, part: part.clone(), before_s, to_deg, met_m };
            list.extend(ARM_MET_M.map(arm));
        }
    }
    list
}

/// Ways of touching in which a door meets the other vehicle, and bodies do not.
pub(super) fn stagings(told: &Told, ground: &Ground) -> Vec<Staging> {
    let of_sv = told.door == Some(Striker::Sv);
    let (owner, other) = if of_sv { (&told.sv, &told.cp) } else { (&told.cp, &told.sv) };
    let openings = match told.gate_swings {
        true => arms(),
        false if !has_doors(owner.kind) || told.thing.is_some() => return Vec::new(),
        false => openings(told, owner, of_sv),
    };
    let mut found = Vec::new();
    let mut trial = 0;
    let beside: Vec<Rc<Ground>> = beside_line(told, ground).into_iter().map(Rc::new).collect();
    for (sv_s_m, ground) in ground.places().into_iter().flat_map(|s_m| beside.iter().map(move |ground| (s_m, ground))) {
        let Some(sv) = sv_at_contact(told, ground, sv_s_m) else { continue };
        // The post of a gate is not at an angle to the way through it.
        let through = [sv.heading, sv.heading + math::PI].map(math::wrap_angle).map(|heading| (heading, heading));
        // One that opens lies across it, and swings along it.
        let across =
            through.map(|(_, heading)| math::wrap_angle(heading + math::FRAC_PI_2)).map(|heading| (heading, heading));
        let faces = match told.gate_swings {
            true if told.gate_opens => [across, through].concat(),
            true => through.to_vec(),
            false => headings(told, sv.heading, sv.heading),
        };
        for (came, heading) in faces {
            for opening in &openings {
                for &point in met_points(told, other).iter() {
                    trial += 1;
                    let Some((cp, owner_zone, other_zone)) = touch(told, opening, sv, heading, point) else { continue };
                    let owner_off = if told.gate_swings { 0 } else { zones_off(&owner.zones, owner_zone) };
                    let in_lane = if told.has_kerb(ground) && ground.is_in_lanes(cp, size_of(&told.cp).1, IN_LANE_M) {
                        IN_LANE
                    } else {
                        0
                    };
                    let off = owner_off + zones_off(&other.zones, other_zone) + in_lane;
                    let (ground, door) = (Rc::clone(ground), Some(opening.clone()));
                    found.push(Staging {
                        ground,
                        sv_s_m,
                        sv,
                        cp,
                        cp_came: came,
                        bend: None,
                        cp_follows_m: None,
                        door,
                        cost: (off, trial),
                    });
                }
            }
        }
    }
    found
}

/// An ego that drives past who is parked keeps beside the middle of its lane by so much. [m]
const BESIDE_LINE_M: [f64; 5] = [0.0, 0.25, -0.25, 0.5, -0.5];

/// Of who is parked at the kerb, that it stands in the lane, by more than this. [m]
const IN_LANE: u32 = 2;
const IN_LANE_M: f64 = 0.1;

/// The road, with an ego that drives in the middle of its lane, or beside it, where that passes who is parked.
fn beside_line(told: &Told, ground: &Ground) -> Vec<Ground> {
    let drives = matches!(told.sv.state, ContactState::Moving) && told.sv.turning == Turning::No;
    let keeps = drives && told.sv_aside().is_none() && ground.drift.is_none() && ground.stands_m == 0.0;
    match keeps && told.has_kerb(ground) {
        true => BESIDE_LINE_M.map(|stands_m| ground.standing(stands_m)).to_vec(),
        false => vec![ground.clone()],
    }
}

/// Points of the other's outline that the door may meet: shares of half of its length and width. Who comes along a door that stands open has
/// come to it with the front of its flank.
fn met_points(told: &Told, other: &Side) -> Vec<(f64, f64)> {
    use ContactZone as Z;
    let usual = [Z::Left, Z::Right, Z::FrontLeft, Z::FrontRight];
    let mut zones = if other.zones.is_empty() { usual.to_vec() } else { other.zones.clone() };
    if told.layout.stood_open.is_some() || drives_open(told, told.door == Some(Striker::Sv)) {
        let side = side_of(&other.zones);
        zones.extend(side.map(|side| if side == LeftRight::Left { Z::FrontLeft } else { Z::FrontRight }));
    }
    zones.iter().flat_map(|zone| points(*zone).iter().copied()).collect()
}

/// Places the partner so that the end of the door meets that point of the other. `None` where bodies would touch, or the door
/// would be met earlier.
fn touch(
    told: &Told,
    opening: &Opening,
    sv: Pose,
    heading: f64,
    point: (f64, f64),
) -> Option<(Pose, ContactZone, ContactZone)> {
    let outline = |side: &Side, pose: Pose| {
        let (length_m, width_m) = size_of(side);
        OrientedBox::new(pose, length_m, width_m)
    };
    let met = |outline: &OrientedBox| {
        outline.to_world(Vec2::new(point.0 * outline.half_length, point.1 * outline.half_width))
    };
    let origin = Pose { position: Vec2::new(0.0, 0.0), heading };
    let end = |owner: Pose| {
        let door = opening.outline(owner, 0.0);
        door.centre + door.axis * (door.half_length - opening.met_m)
    };
    let position = if opening.of_sv {
        end(sv) - met(&outline(&told.cp, origin))
    } else {
        met(&outline(&told.sv, sv)) - end(origin)
    };
    let cp = Pose { position, heading };
    let (owner, other) =
        if opening.of_sv { ((&told.sv, sv), (&told.cp, cp)) } else { ((&told.cp, cp), (&told.sv, sv)) };
    let back = |(side, pose): (&Side, Pose), before_s: f64| Pose {
        position: pose.position - velocity(side, pose.heading) * before_s,
        ..pose
    };
    for tick in 0..=(PASSES_S / 0.04) as usize {
        let before_s = 0.04 * tick as f64;
        let (mine, theirs) = (back(owner, before_s), back(other, before_s));
        let theirs = outline(other.0, theirs);
        if outline(owner.0, mine).overlaps(&theirs) {
            return None;
        }
        let touched = opening.outline(mine, before_s).overlaps(&theirs);
        // It meets the door now and not before.
        if touched != (tick == 0) && tick != 1 {
            return None;
        }
    }
    let door = opening.outline(owner.1, 0.0);
    let own = outline(owner.0, owner.1);
    let still = Vec2::new(0.0, 0.0);
    let geometry = contact_geometry(&outline(other.0, other.1), velocity(other.0, other.1.heading), &door, still);
    Some((cp, zone_of(&own, &door), geometry.ego_zone))
}

impl Told {
    /// Whether the partner is told to stand beside the lanes, and there is room for it.
    fn has_kerb(&self, ground: &Ground) -> bool {
        self.stands_beside(false) && ground.beside.contains(&StripKind::Parking)
    }
}
