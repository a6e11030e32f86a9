//! Those beside the ego's way: parked, in the next lane, or gone round.

use crate::others::crossing::WALKER_GAP_M;
use crate::others::scene::{BESIDE_M, PARKED_AHEAD_M, ROUND_AHEAD_M, Scene};
use crate::told::others::{Extra, Role};
use crate::told::side::size_of;
use crate::usual::{LANE_M, LEAD_GAP_M, ROOM_M, beyond_m};
use recrash_model::account::{ContactState, LeftRight, Origin};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::math;
use recrash_model::rollout::ActorTrack;
use recrash_model::scenario::{ActorPlan, Leg, Place, Strip, StripKind};

/// Who passes between two has so much room beside the one that it does not touch. [m]
const BETWEEN_M: f64 = 0.6;

/// Whom the partner passes before it comes in, it has passed so long before the contact, so far beside. [steps, m]
const PASSED_BEFORE: usize = 35;
const PASSED_BESIDE_M: f64 = 3.0;

/// One that the partner would touch as it leaves its line stands farther on by so much, so often. [m, -]
const FARTHER_M: f64 = 0.5;
const FARTHER_STEPS: u8 = 16;

/// Who is slow, and for whom the partner leaves its lane, drives at so much of the partner's speed. [-]
const SLOWER: f64 = 0.6;

/// Who drives in the next lane is so far ahead of the ego, and its course goes on so far. [m]
const ABREAST_M: f64 = 3.0;
const BEYOND_M: f64 = 160.0;

/// An ego that is faster than this all the time does not stand. [m/s]
const STEADY_MPS: f64 = 2.0;

/// Who hides somebody who comes across stands so far short of it; the sine of the least angle across. [m, -]
pub(crate) const HIDES_M: f64 = 0.8;
const ACROSS: f64 = 0.7;

impl Scene<'_> {
    /// Who is parked at the kerb ahead of the ego, on both sides where nobody tells on which; in a lot in a stall.
    pub(super) fn parked(&self, extra: &Extra, length_m: f64) -> Vec<ActorPlan> {
        let road = &self.ground.map.roads[self.ground.own_road()];
        // The ego goes against the line of a road that is drawn from the junction.
        let (right, left) = if self.ground.junction { (&road.left, &road.right) } else { (&road.right, &road.left) };
        let is = |strips: &[Strip], kind: StripKind| strips.iter().any(|strip| strip.kind == kind);
        let stalls = is(right, StripKind::Stalls);
        let has = |strips: &[Strip]| is(strips, StripKind::Parking) || is(strips, StripKind::Stalls);
        // Whom it passes is abreast of its front; between whom and the ego the partner passes is abreast of that.
        let far_m = match (extra.passed, self.told.layout.along_kerb) {
            (true, _) => 0.0,
            (false, true) => -self.front_m(),
            (false, false) => PARKED_AHEAD_M + 0.5 * length_m,
        };
        let ahead_m = self.at(self.until).0 + self.front_m() + far_m;
        // Nobody is parked in a junction.
        let before_m = if self.ground.junction { self.ground.first_m() - PARKED_AHEAD_M } else { f64::INFINITY };
        let wider_m = 0.5 * (StripKind::Stalls.usual_width_m() - StripKind::Parking.usual_width_m());
        let [left_m, right_m] = self.ground.kerbs_m.map(|kerb_m| kerb_m + if stalls { wider_m } else { 0.0 });
        let two_way = is(left, StripKind::Driving);
        let turned_deg = if stalls { 90.0 } else { 0.0 };
        let sides = [
            (LeftRight::Right, has(right), right_m, turned_deg),
            (LeftRight::Left, has(left), -left_m, if two_way && !stalls { 180.0 } else { turned_deg }),
        ];
        let told = |side: LeftRight| extra.side.is_none_or(|told| told == side);
        let plan = |(side, _, t_m, turned_deg): (LeftRight, bool, f64, f64)| {
            let hides_m = self.hides_m(t_m, length_m).filter(|_| turned_deg != 90.0);
            let walks_m = self.walks_across_m(side).filter(|_| turned_deg != 90.0);
            let hides_m = hides_m.or(walks_m.map(|at_m| at_m - HIDES_M - 0.5 * length_m));
            let hides_m = hides_m.or_else(|| self.passes_between(side));
            let pose = self.ground.pose(hides_m.unwrap_or(ahead_m).min(before_m), t_m);
            ActorPlan::standing(Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees() + turned_deg))
        };
        sides.into_iter().filter(|(side, is, ..)| *is && told(*side)).map(plan).collect()
    }

    /// Whom the partner goes round: in the line on which it came, where it has left that, or ahead of where it touches the ego.
    pub(super) fn passed(&self, extra: &Extra, (length_m, width_m): (f64, f64)) -> Option<ActorPlan> {
        let track = self.partner?;
        let (came, met) = (track.states[0].pose(), track.at(self.until).pose());
        let along = Vec2::from_heading(came.heading);
        let left = track.states[..=self.until]
            .iter()
            .find(|state| along.cross(state.position() - came.position).abs() > BESIDE_M);
        // Beside the line, on the ego's side, where it passes before it comes in.
        let before = track.within(self.until.saturating_sub(PASSED_BEFORE));
        let over = self.told.comes_over || extra.goes_out;
        let aside_m = if over { 0.0 } else { PASSED_BESIDE_M };
        let to_ego = along.cross(self.ego.states[self.until].position() - came.position).signum();
        let on_m = match left {
            _ if !over => along.dot(track.states[before].position() - came.position),
            Some(state) => along.dot(state.position() - came.position),
            None => along.dot(met.position - came.position) + 0.5 * (track.length_m + length_m) + ROUND_AHEAD_M,
        };
        // No nearer than where the partner, which leaves its line, has come clear of it.
        let stands = |on_m: f64| came.position + along * on_m + along.left() * (to_ego * aside_m);
        let clear = |on_m: &f64| {
            let pose = Pose { position: stands(*on_m), heading: came.heading };
            let body = OrientedBox::new(pose, length_m, width_m);
            (0..=self.until).all(|step| track.outline(track.within(step)).gap(&body) > BETWEEN_M)
        };
        let farther = (0..=FARTHER_STEPS).map(|step| on_m + f64::from(step) * FARTHER_M);
        let leaves = over && left.is_some() && !extra.slow;
        let on_m = farther.into_iter().find(|on_m| !leaves || clear(on_m)).unwrap_or(on_m);
        let at = stands(on_m);
        let place = |at: Vec2| Place::at(at.x, at.y, came.heading.to_degrees());
        let mean_mps = along.dot(met.position - came.position) / (0.1 * self.until.max(1) as f64);
        let speed_mps = if extra.slow { SLOWER * mean_mps } else { 0.0 };
        let begin = at - along * (speed_mps * self.told.contact_s);
        let to = Leg::Curve { to: place(at + along * beyond_m(speed_mps)), reverse: false };
        let course = if extra.slow { vec![to] } else { Vec::new() };
        (on_m > 0.0).then(|| ActorPlan { speed_mps, course, ..ActorPlan::standing(place(begin)) })
    }

    /// Where a partner that comes across passes a line beside the ego's way. [m]
    fn crossing_m(&self, t_m: f64) -> Option<f64> {
        let track = self.partner?;
        let at = |step: usize| self.ground.beside(track.states[step].position());
        let last = track.within(self.until);
        let across = |step: usize| {
            let (s_m, now_m) = at(step);
            let turned = math::wrap_angle(track.states[step].heading - self.ground.pose(s_m, 0.0).heading);
            (at(step - 1).1 - t_m) * (now_m - t_m) <= 0.0 && math::sin(turned).abs() > ACROSS
        };
        let crossed = (1..=last).find(|step| across(*step)).map(|step| at(step).0);
        // Its front is over the line: it stands short of where that came nearest.
        let near = |step: &usize| (at(*step).1 - t_m).abs() < track.length_m;
        let nearest = || (0..=last).filter(near).map(|step| at(step).0).fold(f64::INFINITY, f64::min);
        let over = |step: usize| (at(step).1 - t_m).abs() < 0.5 * track.length_m && self.is_across(track, step);
        crossed.or_else(|| over(last).then(nearest))
    }

    /// Whether somebody is at a wide angle to the ego's way.
    fn is_across(&self, track: &ActorTrack, step: usize) -> bool {
        let (s_m, _) = self.ground.beside(track.states[step].position());
        let turned = math::wrap_angle(track.states[step].heading - self.ground.pose(s_m, 0.0).heading);
        math::sin(turned).abs() > ACROSS
    }

    /// Where the ego is as it passes between one that is parked on this side and a partner that backs from the other. [m]
    fn passes_between(&self, side: LeftRight) -> Option<f64> {
        let other = self.told.comes_from_side() == Some(side.other());
        let drives = self.told.sv.state == ContactState::Moving;
        (other && drives && self.told.backs_across()).then(|| self.at(self.until).0)
    }

    /// Where somebody on foot, or an animal, that is one of the others crosses ahead of the ego, from this side. [m]
    fn walks_across_m(&self, side: LeftRight) -> Option<f64> {
        let crosses = |extra: &&Extra| matches!(extra.role, Role::Walker | Role::Animal) && !extra.stays;
        let walker = self.told.extras.iter().find(crosses)?;
        let (step, room_m) = self.stops();
        let from = walker.side.unwrap_or(LeftRight::Right);
        (from == side).then(|| self.at(step).0 + self.front_m() + room_m + WALKER_GAP_M)
    }

    /// Who hides a partner that comes across stands short of where that comes out. [m]
    pub(super) fn hides_m(&self, t_m: f64, length_m: f64) -> Option<f64> {
        let (partner_m, wide_m) = size_of(&self.told.cp);
        let half_m = 0.5 * partner_m.min(wide_m.max(1.0));
        Some(self.crossing_m(t_m)? - half_m - HIDES_M - 0.5 * length_m)
    }

    /// Who hides a partner that comes across stands in the next lane on its side, where no lane is there at the kerb, short of where it comes out,
    /// and of a junction.
    pub(super) fn screen(&self, extra: &Extra, length_m: f64) -> Option<ActorPlan> {
        let side = self.told.comes_from_side()?;
        let [left_m, right_m] = [self.ground.opposing_m - 0.5 * self.ground.lane_m, self.ground.lane_edges_m[1]];
        let against = side == LeftRight::Left && (extra.opposite || left_m < LANE_M);
        let t_m = match side {
            LeftRight::Left if against => -self.ground.opposing_m,
            LeftRight::Left => -LANE_M,
            LeftRight::Right if right_m < LANE_M => self.ground.kerbs_m[1],
            LeftRight::Right => LANE_M,
        };
        let before_m = self.ground.junction.then(|| self.ground.first_m() - 0.5 * length_m - ROOM_M);
        let hides_m = self.hides_m(t_m, length_m);
        let s_m = hides_m.into_iter().chain(before_m).reduce(f64::min)?;
        let pose = self.ground.pose(s_m, t_m);
        let turned_deg = if against { 180.0 } else { 0.0 };
        Some(ActorPlan::standing(Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees() + turned_deg)))
    }

    /// Who stands in the next lane where the ego is at the contact; ahead of a partner that is there too, and short of where one
    /// comes across.
    pub(super) fn stands_beside(&self, extra: &Extra, length_m: f64) -> ActorPlan {
        let usual = self.told.comes_from_side().or_else(|| self.partner_from()).unwrap_or(LeftRight::Right);
        let side = extra.side.unwrap_or(usual);
        let t_m = -side.sign() * LANE_M;
        let (s_m, _) = self.at(self.until);
        let there = |track: &ActorTrack| {
            let state = track.at(self.until);
            let (at_m, beside_m) = self.ground.beside(state.position());
            let on_side = beside_m * t_m > 0.0 && beside_m.abs() > 0.6 * LANE_M;
            on_side.then_some((at_m + 0.5 * track.length_m + ROOM_M + 0.5 * length_m).max(s_m))
        };
        let stands_m = self.hides_m(t_m, length_m).or_else(|| self.partner.and_then(there)).unwrap_or(s_m);
        let pose = self.ground.pose(stands_m, t_m);
        ActorPlan::standing(Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees()))
    }

    /// Who stands abreast of the ego, and leaves a partner that passes between the two the room that it takes.
    pub(super) fn passed_between(&self, extra: &Extra, (length_m, width_m): (f64, f64)) -> ActorPlan {
        let usual = self.told.comes_from_side().or_else(|| self.partner_from()).unwrap_or(LeftRight::Right);
        let sign = if extra.side.unwrap_or(usual) == LeftRight::Right { 1.0 } else { -1.0 };
        let (s_m, t_m) = self.at(self.until);
        let taken_m = |track: &ActorTrack| {
            let outlines = (0..=track.within(self.until)).map(|step| track.outline(step));
            let abreast = outlines.filter(|outline| {
                let along_m = (self.ground.beside(outline.centre).0 - s_m).abs();
                along_m < 0.5 * (track.length_m + length_m) + LEAD_GAP_M
            });
            let edges = abreast.flat_map(|outline| outline.corners().map(|corner| self.ground.beside(corner).1));
            edges.map(|edge_m| sign * (edge_m - t_m)).fold(0.0, f64::max)
        };
        let room_m = self.partner.map_or(0.0, taken_m) + BETWEEN_M + 0.5 * width_m;
        let pose = self.ground.pose(s_m, t_m + sign * room_m.max(LANE_M));
        // Beside one that comes towards the ego it stands as that drives.
        let turned_deg = if self.told.origin == Origin::Opposite { 180.0 } else { 0.0 };
        ActorPlan::standing(Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees() + turned_deg))
    }

    /// Who drives in the next lane as the ego does, a little ahead.
    pub(super) fn abreast(&self, extra: &Extra) -> ActorPlan {
        let (s_m, t_m) = self.at(0);
        let t_m = t_m + if extra.side == Some(LeftRight::Left) { -LANE_M } else { LANE_M };
        let place = |s_m: f64| {
            let pose = self.ground.pose(s_m, t_m);
            Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees())
        };
        // Beside an ego that only slows it drives on at one speed.
        let steady = (0..=self.until).all(|step| self.mps(step) > STEADY_MPS);
        let mean_mps = (self.at(self.until).0 - s_m) / (0.1 * self.until.max(1) as f64);
        ActorPlan {
            speed_mps: if steady { mean_mps } else { self.recorded.speed_mps },
            course: vec![Leg::Curve { to: place(self.at(self.until).0 + ABREAST_M + BEYOND_M), reverse: false }],
            acts: if steady { Vec::new() } else { self.recorded.acts.clone() },
            ..ActorPlan::standing(place(s_m + ABREAST_M))
        }
    }
}
