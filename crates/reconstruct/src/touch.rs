//! How two touch: headings, speeds and the zones that meet, searched for what fits what is told.
//!
//! Everything is seen from the road that the ego came along: x ahead, y to its left.

use crate::MOST_TRIES;
use crate::acts::Doing;
use crate::came::sv_at_contact;
use crate::door::{self, Opening};
use crate::ground::{Ground, LANE_M, ground_for};
use crate::kerb;
use crate::lanes;
use crate::lateral::{is_on_foot, turn_m};
use crate::roadside;
use crate::side::{Side, Slant, Turning};
use crate::sweep::{self, Bend};
use crate::things;
use crate::told::Told;
use crate::trailer::{self, Rig};
use recrash_metrics::contact::contact_geometry;
use recrash_model::account::{ContactState, CrashType, LaneWord, LeftRight, Origin, Striker};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;
use recrash_model::zones::ContactZone;
use std::rc::Rc;

/// A way of touching.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Staging {
    /// The road: hundreds of ways of touching are tried on one.
    pub(crate) ground: Rc<Ground>,
    /// Along the ego's way, where its centre is at the contact. [m]
    pub(crate) sv_s_m: f64,
    /// The ego at the contact.
    pub(crate) sv: Pose,
    /// The partner at the contact.
    pub(crate) cp: Pose,
    /// Heading of the partner some seconds before, of who does not reverse the way it moves. [rad]
    pub(crate) cp_came: f64,
    /// Along the ego's way, where the partner is at the contact that comes by it. [m]
    pub(crate) cp_follows_m: Option<f64>,
    /// The last part of the partner's way, of who turns as it touches.
    pub(crate) bend: Option<Bend>,
    /// The door that takes part.
    pub(crate) door: Option<Opening>,
    /// How well it fits: zone steps off on both sides, then the order of trial.
    pub(crate) cost: (u32, usize),
}

/// Points of a box's outline, by zone, where it may be touched: shares of half of its length and width.
pub(crate) fn points(zone: ContactZone) -> &'static [(f64, f64)] {
    match zone {
        ContactZone::Front => &[(1.0, 0.0), (1.0, 0.3), (1.0, -0.3)],
        ContactZone::FrontLeft => &[(1.0, 1.0), (1.0, 0.75), (0.75, 1.0)],
        ContactZone::Left => &[(0.0, 1.0), (0.35, 1.0), (-0.35, 1.0)],
        ContactZone::RearLeft => &[(-1.0, 1.0), (-1.0, 0.75), (-0.75, 1.0)],
        ContactZone::Rear => &[(-1.0, 0.0), (-1.0, 0.3), (-1.0, -0.3)],
        ContactZone::RearRight => &[(-1.0, -1.0), (-1.0, -0.75), (-0.75, -1.0)],
        ContactZone::Right => &[(0.0, -1.0), (0.35, -1.0), (-0.35, -1.0)],
        ContactZone::FrontRight => &[(1.0, -1.0), (1.0, -0.75), (0.75, -1.0)],
        ContactZone::Top | ContactZone::Bottom => &[],
    }
}

/// Length and width of one side's box. [m]
pub(crate) fn size_of(side: &Side) -> (f64, f64) {
    let spec = VehicleSpec::of(side.kind);
    side.size.map_or((spec.length_m, spec.width_m), |size| (size.length_m, size.width_m))
}

/// Ways of touching, the best first.
pub(crate) fn stagings(told: &Told) -> Vec<Staging> {
    let ground = Rc::new(ground_for(told));
    let by_part = told.door.is_some() || told.gate_swings;
    let mut found = match told.edge {
        _ if by_part => door::stagings(told, &ground),
        Some(side) => roadside::stagings(told, &ground, side),
        None => bodies(told, &ground),
    };
    found.sort_by_key(|staging| staging.cost);
    // Of those that are almost the same, one.
    let mut kept: Vec<Staging> = Vec::new();
    for staging in found {
        let like = |other: &Staging| {
            other.cp.position.distance(staging.cp.position) < 0.25
                && math::wrap_angle(other.cp.heading - staging.cp.heading).abs() < 0.04
                && (other.sv_s_m - staging.sv_s_m).abs() < 0.5
                && other.bend.is_some() == staging.bend.is_some()
        };
        if kept.len() < MOST_TRIES && !kept.iter().any(like) {
            kept.push(staging);
        }
    }
    kept
}

/// Ways in which their bodies touch.
fn bodies(told: &Told, ground: &Rc<Ground>) -> Vec<Staging> {
    let mut found: Vec<Staging> = Vec::new();
    let mut trial = 0;
    for sv_s_m in ground.places() {
        let Some(sv) = sv_at_contact(told, ground, sv_s_m) else { continue };
        let behind_m = 0.5 * (size_of(&told.sv).0 + size_of(&told.cp).0);
        let behind = ground.sv_pose((sv_s_m - behind_m).max(0.0)).heading;
        trial += 1;
        if let Some((back_m, cp, (sv_seen, cp_seen))) = follows(told, ground, (sv_s_m, sv)) {
            let (sv_off, cp_off) = (zones_off(&told.sv.zones, sv_seen), zones_off(&told.cp.zones, cp_seen));
            // Zones are told to a step: its way through the turn is worth more than that.
            let off = if sv_off.max(cp_off) <= 1 { 0 } else { sv_off + cp_off };
            let (ground, cp_follows_m) = (Rc::clone(ground), Some(sv_s_m - back_m));
            found.push(Staging {
                ground,
                sv_s_m,
                sv,
                cp,
                cp_came: 0.0,
                cp_follows_m,
                bend: None,
                door: None,
                cost: (off, trial),
            });
        }
        for (came, heading) in headings(told, sv.heading, behind) {
            for (sv_zone, cp_zone) in zone_pairs(told) {
                for &sv_point in things::sv_points(told, sv_zone) {
                    for &cp_point in things::cp_points(told, cp_zone) {
                        trial += 1;
                        let Some((cp, sv_seen, cp_seen)) = touch(told, sv, heading, sv_point, cp_point) else {
                            continue;
                        };
                        let off = zones_off(&told.sv.zones, sv_seen) + zones_off(&told.cp.zones, cp_seen);
                        let face_on = told.scrapes() && is_face_on(told, sv, cp);
                        let along = told.runs_into_rear() && !is_face_on(told, sv, cp);
                        let swings = told.goes_straight_behind() && math::wrap_angle(heading - came).abs() > SWINGS_RAD;
                        // Who keeps its lane behind an ego that leaves its own does not turn with that.
                        let turned = math::wrap_angle(heading - came).abs() > KEEPS_RAD;
                        let off_m = (cp.position.y - ground.sv_pose(sv_s_m).position.y).abs();
                        let leaves = told.keeps_straight_behind() && (turned || off_m > KEEPS_M);
                        let late = told.goes_straight_behind() && sv.heading.abs() > EARLY_RAD;
                        let squeezed = told.turns_from_beside() && aside_before_m(told, sv, cp, came) < BESIDE_M;
                        let other_way = told.is_struck_otherwise((sv_seen, cp_seen));
                        // Who turns across an oncoming partner meets it in that one's lane.
                        let before = told.sv.turning == Turning::Left && told.is_met_on_wrong_side(ground, cp);
                        let worse = [
                            (before, BEFORE_LANE),
                            (face_on || along, FACE_ON),
                            (swings, SWINGS),
                            (leaves, LEAVES),
                            (told.goes_right_way(cp), RIGHT_WAY),
                            (late, LATE),
                            (squeezed, SQUEEZED),
                            (other_way, OTHER_WAY),
                            (told.strikes_otherwise((sv, cp)), STRIKES),
                            (told.crosses_off_lanes(ground, cp), OFF_LANES),
                            (told.is_parked_otherwise(ground, cp), PARKED_OTHERWISE),
                            (told.swings_out(ground, heading - came), SWINGS_OUT),
                        ];
                        let worse: u32 = worse.iter().filter(|(is, _)| *is).map(|(_, steps)| steps).sum();
                        let bends = lanes::bends(told, (ground, sv), cp, came);
                        let cost = (off + worse, bends as usize * BENT + trial);
                        let (ground, bend, door) = (Rc::clone(ground), None, None);
                        let cp_follows_m = None;
                        found.push(Staging { ground, sv_s_m, sv, cp, cp_came: came, cp_follows_m, bend, door, cost });
                    }
                }
            }
        }
    }
    let nearest = found.iter().map(|staging| staging.cost.0).min().unwrap_or(u32::MAX);
    if nearest >= if told.rubs_by() { RUBS_OFF } else { FAR_OFF } {
        found.extend(sweep::stagings(told, ground, trial, nearest));
    }
    found
}

/// Where no way of touching is nearer than this to the told zones, the partner turns as it touches; the second of who passes and touches with
/// its flank or its rear.
const FAR_OFF: u32 = 2;
const RUBS_OFF: u32 = 1;

/// Of ways of touching that fit alike, those are tried first to which the partner comes along a lane; more than there are ways. [trials]
pub(crate) const BENT: usize = 1_000_000;

/// Whether two that touch do so with a front on a rear, and not along a flank: seen along the ego they overlap less than across it.
fn is_face_on(told: &Told, sv: Pose, cp: Pose) -> bool {
    let ((sv_length, sv_width), (cp_length, cp_width)) = (size_of(&told.sv), size_of(&told.cp));
    let (ahead, way) = (Vec2::from_heading(sv.heading), cp.position - sv.position);
    let turn = cp.heading - sv.heading;
    let (cos, sin) = (math::cos(turn).abs(), math::sin(turn).abs());
    let along_m = 0.5 * (sv_length + cos * cp_length + sin * cp_width) - way.dot(ahead).abs();
    let across_m = 0.5 * (sv_width + cos * cp_width + sin * cp_length) - ahead.cross(way).abs();
    along_m < across_m
}

/// Of who rubs along the other, a front on a rear is worth as much as so many zone steps, and so is a flank where a front is told on a
/// rear; and of who goes straight on behind an ego that turns, that it swings by more than this. [rad]
const FACE_ON: u32 = 2;
const SWINGS: u32 = 2;
const SWINGS_RAD: f64 = 0.35;

/// Of an oncoming partner, that the ego, which turns, has not come to its lane.
const BEFORE_LANE: u32 = 3;

/// Of who has a signal or a sign on the crossing road, that it does not come along the lanes that lead there.
const OFF_LANES: u32 = 1;

/// Of who passes an ego at the kerb, that it swings out from there as it touches.
const SWINGS_OUT: u32 = 2;

/// Of who is told to stand beside the lanes, that its middle is in one, or that it stands askew.
const PARKED_OTHERWISE: u32 = 2;

/// Of who strikes the other with parts that nobody tells, that the other one's front does.
const OTHER_WAY: u32 = 1;

/// Of two that drive on beside each other, that the one comes to the other who is not told to have struck it.
const STRIKES: u32 = 1;

/// Of who keeps its lane behind an ego that leaves its own, that it is at more than this to its way, or farther beside it. [rad, m]
const LEAVES: u32 = 1;
const KEEPS_RAD: f64 = 0.08;
const KEEPS_M: f64 = 1.2;

/// Of who goes the wrong way along a crossing road, that it is on the side where that is the right one, or nearer to the
/// middle than this. [m]
const RIGHT_WAY: u32 = 1;
const RIGHT_SIDE_M: f64 = 1.8;

/// And of who turns across from beside, that it was nearer to the ego's line than this before its turn. [m]
const SQUEEZED: u32 = 1;
const BESIDE_M: f64 = 2.4;

/// How far beside the ego's line somebody came along that turned to this pose. [m]
fn aside_before_m(told: &Told, sv: Pose, cp: Pose, came: f64) -> f64 {
    let turn = math::wrap_angle(cp.heading - came);
    (cp.position.y - turn.signum() * turn_m(told) * (1.0 - math::cos(turn)) - sv.position.y).abs()
}

/// How far somebody has turned at least that turns across from the next lane. [deg]
const BESIDE_DEG: f64 = 22.0;

/// How far somebody has turned whose turn is over. [deg]
const OVER_DEG: [f64; 5] = [90.0, 80.0, 72.0, 100.0, 60.0];

/// The same of it, that the ego has turned by more than this. [rad]
const LATE: u32 = 1;
const EARLY_RAD: f64 = 0.6;

/// Who comes behind an ego that turns comes by its way: how far behind it on that, where they touch, and the zones that then meet.
fn follows(told: &Told, ground: &Ground, (sv_s_m, sv): (f64, Pose)) -> Option<(f64, Pose, (ContactZone, ContactZone))> {
    if !told.turns_behind() {
        return None;
    }
    let ((sv_length, sv_width), (cp_length, cp_width)) = (size_of(&told.sv), size_of(&told.cp));
    let own = OrientedBox::new(sv, sv_length, sv_width);
    let at = |back_m: f64| OrientedBox::new(ground.sv_pose(sv_s_m - back_m), cp_length, cp_width);
    let (mut inside, mut outside) = (0.25 * cp_length, sv_length + cp_length);
    if outside > sv_s_m || !at(inside).overlaps(&own) || at(outside).overlaps(&own) {
        return None;
    }
    for _ in 0..30 {
        let middle = 0.5 * (inside + outside);
        if at(middle).overlaps(&own) { inside = middle } else { outside = middle }
    }
    let (cp, touching) = (ground.sv_pose(sv_s_m - inside), at(inside - 0.01));
    let velocities = (velocity(&told.sv, sv.heading), velocity(&told.cp, cp.heading));
    let geometry = contact_geometry(&own, velocities.0, &touching, velocities.1);
    Some((inside, cp, (geometry.ego_zone, geometry.other_zone)))
}

impl Told {
    /// Whether the partner turns across the ego's way from the lane beside it.
    fn turns_from_beside(&self) -> bool {
        matches!(self.origin, Origin::Beside { .. }) && matches!(self.cp.turning, Turning::Left | Turning::Right)
    }

    /// Whether the front of the one who is told to have been struck meets a flank of the one who is told to have struck it.
    fn is_struck_otherwise(&self, (sv_seen, cp_seen): (ContactZone, ContactZone)) -> bool {
        let flank = |zone: ContactZone| matches!(zone, ContactZone::Left | ContactZone::Right);
        let drives = |side: &Side| side.state == ContactState::Moving;
        match self.striker {
            Some(Striker::Cp) if drives(&self.cp) && self.cp.zones.is_empty() => sv_seen.is_front() && flank(cp_seen),
            Some(Striker::Sv) if drives(&self.sv) && self.sv.zones.is_empty() => cp_seen.is_front() && flank(sv_seen),
            _ => false,
        }
    }

    /// Whether of two that drive on beside each other, of whom the partner leaves its lane, the one comes to the other who is not told to have
    /// struck it.
    fn strikes_otherwise(&self, (sv, cp): (Pose, Pose)) -> bool {
        let drives = |side: &Side| side.state == ContactState::Moving && side.turning == Turning::No;
        let beside = self.crash_type == CrashType::Lateral && matches!(self.origin, Origin::Beside { .. });
        // Across the road.
        let to_cp = (cp.position.y - sv.position.y).signum();
        let comes = |side: &Side, pose: Pose| velocity(side, pose.heading).y * to_cp;
        let (sv_mps, cp_mps) = (comes(&self.sv, sv), -comes(&self.cp, cp));
        let other = match self.striker {
            Some(Striker::Cp) => sv_mps > cp_mps,
            Some(Striker::Sv) => cp_mps > sv_mps,
            _ => false,
        };
        beside && self.leaves_its_lane() && drives(&self.sv) && drives(&self.cp) && other
    }

    /// Whether the partner is told to pass, and to touch with its flank or its rear.
    fn rubs_by(&self) -> bool {
        self.cp.acts.iter().any(Doing::is_pass)
    }

    /// Whether both are side by side in lanes for the same turn.
    pub(crate) fn turns_abreast(&self) -> bool {
        let beside = matches!(self.origin, Origin::Beside { .. });
        beside && self.sv.lane == self.cp.lane && matches!(self.sv.lane, Some(LaneWord::LeftTurn | LaneWord::RightTurn))
    }

    /// Whether the partner comes behind an ego that turns, by the same way.
    fn turns_behind(&self) -> bool {
        let turns = match self.sv.turning {
            Turning::Left => Movement::LeftTurn,
            Turning::Right => Movement::RightTurn,
            Turning::No | Turning::Round => return false,
        };
        // Behind an ego that has turned it goes straight on again.
        let over = self.sv.turned || self.sv.state.stands();
        let same = self.cp.movement.is_none_or(|movement| movement == turns || over && movement == Movement::Straight);
        let moves = matches!(self.cp.state, ContactState::Moving | ContactState::SettingOff);
        same && moves && self.origin == Origin::Behind && self.thing.is_none() && self.rig.is_none()
    }

    /// Whether the partner is told to go straight on behind an ego that turns.
    pub(crate) fn goes_straight_behind(&self) -> bool {
        let turns = matches!(self.sv.turning, Turning::Left | Turning::Right);
        turns
            && self.origin == Origin::Behind
            && self.cp.movement == Some(Movement::Straight)
            && !self.sv.state.stands()
            && !self.sv.turned
    }

    /// Whether a partner that is told to go the wrong way along a crossing road is on the side of it where its way is the right one.
    fn goes_right_way(&self, cp: Pose) -> bool {
        let wrong_way = self.cp.movement == Some(Movement::WrongWay);
        matches!(self.origin, Origin::Cross { side } if wrong_way && sign(side) * cp.position.x < RIGHT_SIDE_M)
    }

    /// Whether a partner that has a signal or a sign on the crossing road, and goes straight on, is beside the lanes that lead there.
    fn crosses_off_lanes(&self, ground: &Ground, cp: Pose) -> bool {
        let own_way = !matches!(self.cp.movement, Some(Movement::WrongWay | Movement::Backing));
        let straight = self.cp.turning == Turning::No && self.cp.state != ContactState::Reversing && own_way;
        let lanes_m = ground.lanes as f64 * LANE_M;
        let told = straight && self.cp.control.is_some() && ground.junction;
        matches!(self.origin, Origin::Cross { side } if told && !(0.0..=lanes_m).contains(&(-sign(side) * cp.position.x)))
    }

    /// Whether the partner drives straight on behind an ego that leaves its lane.
    fn keeps_straight_behind(&self) -> bool {
        let drives = |side: &Side| side.state == ContactState::Moving && side.turning == Turning::No;
        let straight = self.cp.movement.is_none_or(|movement| movement == Movement::Straight) && !self.cp.dodges;
        self.origin == Origin::Behind && drives(&self.sv) && drives(&self.cp) && straight && self.sv_aside().is_some()
    }

    /// Whether they rub along each other: a flank takes part, and it is not the front of the one on the rear of the other.
    fn scrapes(&self) -> bool {
        self.crash_type == CrashType::Lateral && side_of(&self.sv.zones).is_some()
    }
}

impl Told {
    /// Whether the front of the one is told to have met the rear of the other, both in one lane.
    fn runs_into_rear(&self) -> bool {
        let in_line = matches!(self.origin, Origin::Behind | Origin::Ahead);
        let straight = self.sv.turning == Turning::No && self.cp.turning == Turning::No && self.thing.is_none();
        self.crash_type == CrashType::FrontToRear && in_line && straight
    }
}

/// Steps around the box from the nearest told zone; none where none is told. Of several on one flank all count on that, and what is told to be
/// the rear no front shows.
pub(crate) fn zones_off(told: &[ContactZone], seen: ContactZone) -> u32 {
    let nearest = told.iter().filter_map(|zone| zone.steps_apart(seen)).min().map_or(0, u32::from);
    let flank = side_of(&[seen]);
    let along = told.iter().filter(|zone| flank.is_some() && side_of(&[**zone]) == flank);
    let farthest = along.filter_map(|zone| zone.steps_apart(seen)).max().map_or(0, u32::from);
    let is_rear = told.iter().any(|zone| zone.is_rear()) && !told.iter().any(|zone| zone.is_front());
    match nearest {
        0 => 0,
        _ if is_rear && seen.is_front() => nearest.max(farthest).max(REAR_OFF),
        _ => nearest.max(farthest),
    }
}

/// Who is told to touch with its rear is so many steps off with its front. [steps]
const REAR_OFF: u32 = 2;

/// The side on which these zones lie, front and rear aside: 1 left, -1 right; nothing where they lie on both, or on neither.
pub(crate) fn side_of(zones: &[ContactZone]) -> Option<f64> {
    let side = |zone: &ContactZone| match zone {
        ContactZone::FrontLeft | ContactZone::Left | ContactZone::RearLeft => 1.0,
        ContactZone::FrontRight | ContactZone::Right | ContactZone::RearRight => -1.0,
        _ => 0.0,
    };
    let first = zones.iter().map(side).find(|side| *side != 0.0)?;
    zones.iter().all(|zone| side(zone) != -first).then_some(first)
}

/// Zones to try: the told ones, or all where none is told; then the neighbours of told ones, since a zone is told to a step.
pub(crate) fn zone_pairs(told: &Told) -> Vec<(ContactZone, ContactZone)> {
    if let Some(pair) = things::across(told) {
        return vec![pair];
    }
    let all = || ContactZone::ALL[..8].to_vec();
    let of = |zones: &[ContactZone]| if zones.is_empty() { all() } else { zones.to_vec() };
    let near = |zones: &[ContactZone]| -> Vec<ContactZone> {
        all().into_iter().filter(|zone| !zones.contains(zone) && zones_off(zones, *zone) == 1).collect()
    };
    let flanks = [ContactZone::Left, ContactZone::Right];
    let (sv, cp) = (of(&told.sv.zones), if told.stands_across() { flanks.to_vec() } else { of(&told.cp.zones) });
    let (sv_near, cp_near) = (near(&told.sv.zones), near(&told.cp.zones));
    let mut pairs = Vec::new();
    for (first, second) in [(&sv, &cp), (&sv, &cp_near), (&sv_near, &cp), (&sv_near, &cp_near)] {
        pairs.extend(first.iter().flat_map(|&a| second.iter().map(move |&b| (a, b))));
    }
    pairs
}

const fn sign(side: LeftRight) -> f64 {
    match side {
        LeftRight::Left => 1.0,
        LeftRight::Right => -1.0,
    }
}

/// Headings of the partner to try: as it came, and at the contact. Of who reverses, the way it faces. `behind`: of the ego's way where
/// somebody is who touches its rear. [rad]
pub(crate) fn headings(told: &Told, sv_heading: f64, behind: f64) -> Vec<(f64, f64)> {
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
        return kerb::headings().collect();
    }
    if told.comes_across() {
        return things::headings(told).into_iter().map(math::wrap_angle).map(|heading| (heading, heading)).collect();
    }
    let along_kerb = matches!(told.origin, Origin::Parked { .. }) && !is_on_foot(told.cp.kind);
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
        Origin::Parked { .. } if told.cp.state == ContactState::Parked => list.push((0.0, 0.0)),
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

/// Velocity at the contact. [m/s]
pub(crate) fn velocity(side: &Side, heading: f64) -> Vec2 {
    velocity_along(side, Vec2::from_heading(heading))
}

/// The same of who faces along this. [m/s]
pub(crate) fn velocity_along(side: &Side, axis: Vec2) -> Vec2 {
    let backwards = if side.state == ContactState::Reversing { -1.0 } else { 1.0 };
    axis * (backwards * side.speed_mps)
}

/// Places the partner so that the two points meet, and takes it back to where the boxes just touch; the zones that then
/// meet. `None` where they do not close on each other there.
pub(crate) fn touch(
    told: &Told,
    sv: Pose,
    heading: f64,
    sv_point: (f64, f64),
    cp_point: (f64, f64),
) -> Option<(Pose, ContactZone, ContactZone)> {
    let (sv_length, sv_width) = size_of(&told.sv);
    let (cp_length, cp_width) =
        told.rig.map_or_else(|| size_of(&told.cp), |rig| (rig.trailer.length_m, rig.trailer.width_m));
    let own = OrientedBox::new(sv, sv_length, sv_width);
    let met = own.to_world(Vec2::new(sv_point.0 * own.half_length, sv_point.1 * own.half_width));
    let other = OrientedBox::new(Pose { heading, ..sv }, cp_length, cp_width);
    let axis = other.axis;
    let centre = met - axis * (cp_point.0 * 0.5 * cp_length) - axis.left() * (cp_point.1 * 0.5 * cp_width);
    let velocities = (velocity_along(&told.sv, own.axis), velocity_along(&told.cp, axis));
    let closing = velocities.1 - velocities.0;
    let speed = closing.length();
    if speed < 0.05 {
        return None;
    }
    let way = closing * (1.0 / speed);
    let at = |back_m: f64| OrientedBox { centre: centre - way * back_m, ..other };
    // Apart some way back, together here or a little later.
    let (mut inside, mut outside) = (-0.05, None);
    if !at(inside).overlaps(&own) {
        return None;
    }
    for step in 1..=24 {
        let back_m = -0.05 + 0.1 * f64::from(step);
        if !at(back_m).overlaps(&own) {
            outside = Some(back_m);
            break;
        }
        inside = back_m;
    }
    let mut outside = outside?;
    for _ in 0..30 {
        let middle = 0.5 * (inside + outside);
        if at(middle).overlaps(&own) { inside = middle } else { outside = middle }
    }
    // They stay apart on the way there.
    if (1..=12).any(|step| at(outside + 0.25 * f64::from(step)).overlaps(&own)) {
        return None;
    }
    // Who draws a trailer gets by.
    let gets_by = |rig: Rig| (0..=60).all(|step| !rig.tractor(&at(inside + 0.25 * f64::from(step))).overlaps(&own));
    if !told.rig.is_none_or(gets_by) {
        return None;
    }
    let touching = at(inside - 0.01);
    let geometry = contact_geometry(&own, velocities.0, &touching, velocities.1);
    let cp = trailer::pose(told.rig, Pose { position: at(inside).centre, heading });
    let cp_zone = told.rig.map_or(geometry.other_zone, |rig| rig.zone(&touching, &geometry));
    Some((cp, geometry.ego_zone, cp_zone))
}
