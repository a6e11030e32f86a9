//! Ways in which the bodies of the two touch.

use crate::ego::plan::sv_at_contact;
use crate::ground::way::Ground;
use crate::told::crash::Told;
use crate::told::side::{Turning, size_of};
use crate::told::zones::{side_of, zones_off};
use crate::touch::boxes::{Meeting, cp_points, sv_points, velocity, zone_pairs};
use crate::touch::fit::{aside_before_m, is_face_on};
use crate::touch::headings::headings;
use crate::touch::lanes;
use crate::touch::staging::Staging;
use crate::touch::sweep::{self, BENT};
use recrash_metrics::contact::contact_geometry;
use recrash_model::geometry::{OrientedBox, Pose};
use recrash_model::math;
use recrash_model::zones::ContactZone;
use std::rc::Rc;
use std::vec;

/// Ways in which their bodies touch, in the order of trial: those of one place, or of one heading there, at a time.
pub(super) struct Bodies<'a> {
    told: &'a Told,
    ground: Rc<Ground>,
    pairs: Vec<(ContactZone, ContactZone)>,
    /// Places of the ego that are yet to be tried; where it is, and headings of the partner that are to be tried there.
    places: vec::IntoIter<f64>,
    sv_at: (f64, Pose),
    headings: vec::IntoIter<(f64, f64)>,
    /// So many ways were tried, and the nearest of them is so many steps off the told zones.
    trial: usize,
    nearest: u32,
    is_over: bool,
}

impl Iterator for Bodies<'_> {
    type Item = Vec<Staging>;

    fn next(&mut self) -> Option<Vec<Staging>> {
        let found = match self.headings.next() {
            Some(heading) => self.touching(heading),
            None => match self.places.next() {
                Some(sv_s_m) => self.coming_to(sv_s_m),
                None => return self.sweeping(),
            },
        };
        self.nearest = found.iter().map(|staging| staging.cost.0).fold(self.nearest, u32::min);
        Some(found)
    }
}

impl<'a> Bodies<'a> {
    pub(super) fn of(told: &'a Told, ground: Rc<Ground>) -> Self {
        Self {
            told,
            pairs: zone_pairs(told),
            places: ground.places().into_iter(),
            ground,
            sv_at: (0.0, Pose::default()),
            headings: Vec::new().into_iter(),
            trial: 0,
            nearest: u32::MAX,
            is_over: false,
        }
    }

    /// Goes on to a place of the ego; the partner that comes behind it by its way.
    fn coming_to(&mut self, sv_s_m: f64) -> Vec<Staging> {
        let told = self.told;
        let Some(sv) = sv_at_contact(told, &self.ground, sv_s_m) else { return Vec::new() };
        let behind_m = 0.5 * (size_of(&told.sv).0 + size_of(&told.cp).0);
        let behind = self.ground.sv_pose((sv_s_m - behind_m).max(0.0)).heading;
        self.sv_at = (sv_s_m, sv);
        let mut all = headings(told, sv.heading, behind);
        all.retain(|(came, at)| came == at || !self.ground.is_for_straight(sv_s_m));
        self.headings = all.into_iter();
        let mut found = Vec::new();
        for beside_m in follows_beside(told) {
            self.trial += 1;
            let found_there = follows(told, &self.ground, self.sv_at, beside_m);
            let Some((back_m, cp, (sv_seen, cp_seen))) = found_there else { continue };
            let (sv_off, cp_off) = (zones_off(&told.sv.zones, sv_seen), zones_off(&told.cp.zones, cp_seen));
            // Zones are told to a step: its way through the turn is worth more than that.
            let fits = sv_off.max(cp_off) <= 1;
            // Beside the ego's line where it does not come to the told zones on that.
            if beside_m != 0.0 && !fits {
                continue;
            }
            let off = if fits { 0 } else { sv_off + cp_off };
            let cp_follows_m = Some((sv_s_m - back_m, beside_m));
            found.push(Staging { cp_follows_m, ..self.staging((0.0, cp), (off, self.trial)) });
            if fits {
                break;
            }
        }
        found
    }

    /// The partner with this heading, as it came and at the contact.
    fn touching(&mut self, (came, heading): (f64, f64)) -> Vec<Staging> {
        let (told, sv) = (self.told, self.sv_at.1);
        let mut found = Vec::new();
        let Some(meeting) = Meeting::of(told, sv, heading) else { return found };
        for &(sv_zone, cp_zone) in &self.pairs {
            for &sv_point in sv_points(told, sv_zone) {
                for &cp_point in cp_points(told, cp_zone) {
                    self.trial += 1;
                    let Some((cp, sv_seen, cp_seen)) = meeting.touch(sv_point, cp_point) else { continue };
                    let off = zones_off(&told.sv.zones, sv_seen) + zones_off(&told.cp.zones, cp_seen);
                    let worse = self.worse((came, cp), (sv_seen, cp_seen));
                    let bends = lanes::bends(told, (&self.ground, sv), cp, came);
                    found.push(self.staging((came, cp), (off + worse, bends as usize * BENT + self.trial)));
                }
            }
        }
        found
    }

    /// The partner that turns as it touches, where nothing nearer was found.
    fn sweeping(&mut self) -> Option<Vec<Staging>> {
        let far = self.nearest >= if self.told.rubs_by() { RUBS_OFF } else { FAR_OFF };
        if std::mem::replace(&mut self.is_over, true) || !far || self.told.goes_straight_beside() {
            return None;
        }
        Some(sweep::stagings(self.told, &self.ground, self.trial, self.nearest))
    }

    /// How much worse it is than the zones that meet, in steps from those that are told.
    fn worse(&self, (came, cp): (f64, Pose), seen: (ContactZone, ContactZone)) -> u32 {
        let (told, ground, (sv_s_m, sv)) = (self.told, &*self.ground, self.sv_at);
        let beside = told.scrapes() || told.passes_narrow();
        let face_on = beside && is_face_on(told, sv, cp);
        let along = (told.runs_into_rear() || told.backs_in_line()) && !is_face_on(told, sv, cp);
        let round = math::wrap_angle(cp.heading - came).abs();
        let swings =
            told.goes_straight_behind() && round > SWINGS_RAD || told.goes_straight_beside() && round > STRAIGHT_RAD;
        // Who keeps its lane behind an ego that leaves its own does not turn with that.
        let off_m = (cp.position.y - ground.sv_pose(sv_s_m).position.y).abs();
        let leaves = told.keeps_straight_behind() && (round > KEEPS_RAD || off_m > KEEPS_M);
        let late = told.goes_straight_behind() && sv.heading.abs() > EARLY_RAD;
        let squeezed = told.turns_from_beside() && aside_before_m(told, sv, cp, came) < BESIDE_M;
        // Who turns across an oncoming partner meets it in that one's lane.
        let before = told.sv.turning == Turning::Left && told.is_met_on_wrong_side(ground, cp);
        let worse = [
            (before, BEFORE_LANE),
            (face_on || along, FACE_ON),
            (swings, SWINGS),
            (told.crosses_at_walk() && round > STRAIGHT_RAD, WALKS_ASKEW),
            (leaves, LEAVES),
            (told.goes_right_way(cp), RIGHT_WAY),
            (late, LATE),
            (squeezed, SQUEEZED),
            (told.is_struck_otherwise(seen), OTHER_WAY),
            (told.strikes_otherwise((sv, cp)), STRIKES),
            (told.crosses_off_lanes(ground, cp), OFF_LANES),
            (told.is_parked_otherwise(ground, cp), PARKED_OTHERWISE),
            (told.swings_out(ground, cp.heading - came), SWINGS_OUT),
            (told.stands_askew(cp), STANDS_ASKEW),
            (told.stays_in_lane(ground, cp), STAYS_IN_LANE),
        ];
        worse.iter().filter(|(is, _)| *is).map(|(_, steps)| steps).sum()
    }

    fn staging(&self, (cp_came, cp): (f64, Pose), cost: (u32, usize)) -> Staging {
        let (ground, (sv_s_m, sv)) = (Rc::clone(&self.ground), self.sv_at);
        Staging { ground, sv_s_m, sv, cp, cp_came, cp_follows_m: None, bend: None, door: None, cost }
    }
}

/// Where no way of touching is nearer than this to the told zones, the partner turns as it touches; the second of who passes and touches with
/// its flank or its rear.
const FAR_OFF: u32 = 2;
const RUBS_OFF: u32 = 1;

/// Of who rubs along the other, a front on a rear is worth as much as so many zone steps, and so is a flank where a front is told on a
/// rear; and of who goes straight on behind an ego that turns, that it swings by more than this. [rad]
const FACE_ON: u32 = 2;
const SWINGS: u32 = 2;
const SWINGS_RAD: f64 = 0.35;

/// Of who goes straight on beside an ego that turns, that it swings by more than this. [rad]
const STRAIGHT_RAD: f64 = 0.15;

/// Of who comes over a crosswalk, that it does not come straight.
const WALKS_ASKEW: u32 = 1;

/// Of an oncoming partner, that the ego, which turns, has not come to its lane.
const BEFORE_LANE: u32 = 3;

/// Of who changes lanes by a column alone, and touches a told side, that it does not come to the line.
const STAYS_IN_LANE: u32 = 2;

/// Of who has a signal or a sign on the crossing road, that it does not come along the lanes that lead there.
const OFF_LANES: u32 = 1;

/// Of who passes an ego at the kerb, that it swings out from there as it touches.
const SWINGS_OUT: u32 = 2;

/// Of who is told to stand beside the lanes, that its middle is in one, or that it stands askew.
const PARKED_OTHERWISE: u32 = 2;

/// Of who stood from the start on the ego's side of the road, that it stands askew.
const STANDS_ASKEW: u32 = 1;

/// Of who strikes the other with parts that nobody tells, that the other one's front does.
const OTHER_WAY: u32 = 1;

/// Of two that drive on beside each other, that the one comes to the other who is not told to have struck it.
const STRIKES: u32 = 1;

/// Of who keeps its lane behind an ego that leaves its own, that it is at more than this to its way, or farther beside it. [rad, m]
const LEAVES: u32 = 1;
const KEEPS_RAD: f64 = 0.08;
const KEEPS_M: f64 = 1.2;

/// Of who goes the wrong way along a crossing road, that it is on the side where that is the right one, or near the middle.
const RIGHT_WAY: u32 = 1;

/// And of who turns across from beside, that it was nearer to the ego's line than this before its turn. [m]
const SQUEEZED: u32 = 1;
const BESIDE_M: f64 = 2.4;

/// Of who goes straight on behind an ego that turns, that the ego has turned by more than this. [rad]
const LATE: u32 = 1;
const EARLY_RAD: f64 = 0.6;

/// Who follows an ego through its turn does so on its line, or beside that on the touched side. [m]
const FOLLOWS_BESIDE_M: [f64; 3] = [0.0, 0.6, 1.0];

fn follows_beside(told: &Told) -> impl Iterator<Item = f64> + use<> {
    let to_right = side_of(&told.sv.zones).map(|side| -side.sign());
    let beside_m = if to_right.is_some() { &FOLLOWS_BESIDE_M[..] } else { &FOLLOWS_BESIDE_M[..1] };
    beside_m.iter().map(move |beside_m| to_right.unwrap_or(1.0) * beside_m)
}

/// Who comes behind an ego that turns comes by its way: how far behind it on that, where they touch, and the zones that then meet.
fn follows(
    told: &Told,
    ground: &Ground,
    (sv_s_m, sv): (f64, Pose),
    beside_m: f64,
) -> Option<(f64, Pose, (ContactZone, ContactZone))> {
    if !told.turns_behind() {
        return None;
    }
    let ((sv_length, sv_width), (cp_length, cp_width)) = (size_of(&told.sv), size_of(&told.cp));
    let own = OrientedBox::new(sv, sv_length, sv_width);
    let at = |back_m: f64| OrientedBox::new(ground.pose(sv_s_m - back_m, beside_m), cp_length, cp_width);
    let (mut inside, mut outside) = (0.25 * cp_length, sv_length + cp_length);
    if outside > sv_s_m || !at(inside).overlaps(&own) || at(outside).overlaps(&own) {
        return None;
    }
    for _ in 0..30 {
        let middle = 0.5 * (inside + outside);
        if at(middle).overlaps(&own) { inside = middle } else { outside = middle }
    }
    let (cp, touching) = (ground.pose(sv_s_m - inside, beside_m), at(inside - 0.01));
    let velocities = (velocity(&told.sv, sv.heading), velocity(&told.cp, cp.heading));
    let geometry = contact_geometry(&own, velocities.0, &touching, velocities.1);
    Some((inside, cp, (geometry.ego_zone, geometry.other_zone)))
}
