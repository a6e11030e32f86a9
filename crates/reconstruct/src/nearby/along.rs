//! Ways of others near who drive or stand in the lanes: ahead of the ego, behind it, beside it, or towards it.

use crate::facts::near::NEAR_M;
use crate::ground::pieces::corner_m;
use crate::nearby::scene::{LOT_MPS, Scene};
use crate::nearby::way::{BRAKES_MPS2, PASSES_BY_MPS, Way};
use crate::others::stand::stands;
use crate::told::others::Role;
use crate::usual::LANE_M;
use recrash_model::account::{LeftRight, Origin};
use recrash_model::geometry::{Pose, Vec2};

/// Who comes along and stands at the contact drives as far as in this share of the time at its speed. [-]
const COMES_SHARE: f64 = 0.7;

/// What fell off somebody begins so far behind it. [m]
const RIGHT_BEHIND_M: f64 = 0.7;

/// Who goes by before the ego sets off does so this long before. [s]
const GONE_BEFORE_S: [f64; 4] = [0.8, 2.3, 1.5, 3.5];

/// Who makes room for somebody between it and the ego is so far over in its lane. [m]
const FAR_OVER_M: f64 = 0.9;

/// Who comes over ahead of an ego that stands does so slowly. [m/s]
const MERGES_MPS: f64 = 3.0;

impl<'a> Scene<'a> {
    /// In the lane towards the ego: it comes by, is yet to come, or drives off where the ego's road begins behind a junction.
    pub(super) fn oncoming(&self, half_m: f64) -> Vec<Way> {
        if !self.is_two_way() {
            return Vec::new();
        }
        let (s_m, _) = self.at(self.until);
        let [_, usual_mps] = self.speeds();
        let at = |on_m: f64| Way::straight(self.against(s_m + on_m), usual_mps, self.contact_s);
        let from_m = self.ground.first_m() - half_m - 2.0;
        let off = (self.ground.junction && from_m > s_m - NEAR_M)
            .then(|| Way::straight(self.against(from_m), usual_mps, 0.0));
        [12.0, 24.0, -10.0, -25.0].into_iter().map(at).chain(off).collect()
    }

    /// In a lane towards the ego: it goes by before that, which stood, sets off.
    pub(super) fn gone_by(&self) -> Vec<Way> {
        let [_, usual_mps] = self.speeds();
        let (s_m, _) = self.at(0);
        let off_s = stands(self.ego, self.until).first().map_or(self.contact_s, |(_, to)| 0.1 * *to as f64);
        let lanes = if self.is_two_way() { 0..self.ground.oncoming.max(1) } else { 0..0 };
        let ways = lanes.flat_map(|lane| GONE_BEFORE_S.map(|before_s| (lane, off_s - before_s)));
        let ways = ways.filter(|(_, at_s)| *at_s > 0.0);
        ways.map(|(lane, at_s)| Way::straight(self.against_in(lane, s_m), usual_mps, at_s)).collect()
    }

    /// The same in the other lanes towards the ego.
    pub(super) fn oncoming_beyond(&self) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let [_, usual_mps] = self.speeds();
        let in_lane =
            |(lane, on_m): (usize, f64)| Way::straight(self.against_in(lane, s_m + on_m), usual_mps, self.contact_s);
        let lanes = if self.is_two_way() { 1..self.ground.oncoming.max(1) } else { 0..0 };
        lanes.flat_map(|lane| [12.0, 24.0, -10.0, -25.0].map(|on_m| (lane, on_m))).map(in_lane).collect()
    }

    /// In the lane towards the ego, where no junction is; else at the other side of it.
    pub(super) fn waits_opposite(&self, half_m: f64) -> Vec<Way> {
        if !self.is_two_way() {
            return Vec::new();
        }
        let (s_m, _) = self.at(self.until);
        let line_m = self.ground.first_m();
        let across_m = line_m + 2.0 * corner_m(self.ground.lanes) + half_m + 1.0;
        let place = |lane: usize, on_m: f64| {
            let at_m = s_m + on_m;
            let inside = self.ground.junction && at_m + half_m > line_m;
            Way::stands(self.against_in(lane, if inside { at_m.max(across_m) } else { at_m }))
        };
        let lanes = 0..self.ground.oncoming.max(1);
        lanes.flat_map(|lane| [10.0, 20.0, 30.0, 4.0].map(|on_m| place(lane, on_m))).collect()
    }

    /// Comes along to where somebody stands.
    pub(super) fn coming_to(&self, way: &Way) -> Way {
        let [_, speed_mps] = self.speeds();
        let way_m = COMES_SHARE * speed_mps * self.contact_s;
        let from = way.from.position - Vec2::from_heading(way.from.heading) * way_m;
        Way { speed_mps, stops_m: Some(way_m), ..Way::stands(Pose { position: from, ..way.from }) }
    }

    /// Ahead in the ego's lane, or beside that, and drives on.
    pub(super) fn leads(&self, half_m: f64) -> Vec<Way> {
        let (s_m, _) = self.at(0);
        let mut list = Vec::new();
        for t_m in self.own_line_first() {
            for speed_mps in self.speeds() {
                let from =
                    |on_m: f64| Way::straight(self.road(s_m + self.front_m() + half_m + on_m, t_m), speed_mps, 0.0);
                list.extend([8.0, 14.0, 22.0, 30.0].map(from));
            }
        }
        list
    }

    /// In the lane in which the ego came first: whom it changes lanes for is not in that to which it goes.
    fn own_line_first(&self) -> Vec<f64> {
        let own_m = self.told.sv_aside().map_or(0.0, |aside| aside.from_t_m);
        let mut lines = self.lines();
        lines.sort_by_key(|t_m| *t_m != own_m);
        lines
    }

    /// Drives on ahead of what fell off it.
    pub(super) fn loses(&self, half_m: f64) -> Option<Way> {
        let thing = self.partner.filter(|_| self.told.dropped.is_some())?;
        let (pose, on_m) = (thing.states[0].pose(), 0.5 * thing.length_m + half_m + RIGHT_BEHIND_M);
        let from = Pose { position: pose.position + Vec2::from_heading(pose.heading) * on_m, ..pose };
        let (s_m, _) = self.ground.beside(from.position);
        Some(Way::straight(self.road(s_m, self.at(0).1), thing.states[0].speed(), 0.0))
    }

    /// In the ego's lane ahead of a partner that stands or backs there, and before the junction.
    fn stands_ahead_of_partner(&self, half_m: f64) -> Vec<Way> {
        let Some(track) = self.partner.filter(|_| self.told.origin == Origin::Ahead) else { return Vec::new() };
        let own_m = self.at(self.until).1;
        let places = track.states[..=self.until].iter().map(|state| self.ground.beside(state.position()));
        let farthest =
            places.filter(|(_, t_m)| (t_m - own_m).abs() < 0.5 * LANE_M).map(|(s_m, _)| s_m).reduce(f64::max);
        let front_m = farthest.map(|s_m| s_m + 0.5 * track.length_m + half_m);
        let before = |s_m: &f64| !self.ground.junction || s_m + half_m <= self.ground.first_m();
        let places = [2.5, 1.5, 4.0].into_iter().filter_map(|on_m| Some(front_m? + on_m)).filter(before);
        places.map(|s_m| Way::stands(self.road(s_m, own_m))).collect()
    }

    pub(super) fn stands_ahead(&self, half_m: f64, least_m: f64) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let front_m = s_m + self.front_m() + half_m;
        let far = [3.0, 5.0, 7.5, 10.0, 16.0, 24.0, 30.0].into_iter().filter(|on_m| *on_m >= least_m);
        let own_m = self.told.sv_aside().map_or(0.0, |aside| aside.from_t_m);
        let lines = self.own_line_first();
        let mut places: Vec<(f64, f64)> =
            far.flat_map(|on_m| lines.clone().into_iter().map(move |t_m| (front_m + on_m, t_m))).collect();
        // Ahead of a partner, or of the queue's first one, that is in that lane itself.
        let queue = self.told.extras.iter().any(|extra| extra.role == Role::Lead && !extra.goes);
        if self.told.origin == Origin::Ahead || queue {
            places.sort_by_key(|(_, t_m)| *t_m != own_m);
        }
        let across_m = self.ground.first_m() + 2.0 * corner_m(self.ground.lanes) + half_m;
        let inside = |s_m: f64| self.ground.junction && s_m + half_m > self.ground.first_m() && s_m < across_m;
        let beyond = self.ground.junction.then(|| Way::stands(self.road(across_m + 1.0, 0.0)));
        let stands = |(s_m, t_m): (f64, f64)| Way::stands(self.road(s_m, t_m));
        let ahead = self.stands_ahead_of_partner(half_m);
        let places = places.into_iter().filter(|(s_m, _)| !inside(*s_m)).map(stands);
        ahead.into_iter().chain(places).chain(beyond).collect()
    }

    /// Behind the ego: it follows one that drives, comes along and stands, or stands where the ego does from the start.
    pub(super) fn follows(&self, half_m: f64) -> Vec<Way> {
        let rear = (0..=self.until).map(|step| self.at(step).0).fold(f64::MAX, f64::min) - self.front_m() - half_m;
        let (s_m, _) = self.at(self.until);
        let mut list = Vec::new();
        if !self.ego.states[self.until].stands() {
            let place = |behind_m: f64| self.road(s_m - self.front_m() - half_m - behind_m, 0.0);
            let [mean_mps, _] = self.speeds();
            // It brakes as they touch.
            let brakes_m = 0.5 * mean_mps * mean_mps / BRAKES_MPS2;
            let stops_m = Some(mean_mps * self.contact_s + brakes_m);
            let follows = |behind_m: f64| Way { stops_m, ..Way::straight(place(behind_m), mean_mps, self.contact_s) };
            list.extend([brakes_m + 4.0, brakes_m + 8.0, 6.0, 12.0, 20.0].map(follows));
        }
        for t_m in self.lines().into_iter().filter(|t_m| *t_m == 0.0 || self.ground.lanes > 1) {
            for speed_mps in self.speeds().into_iter().rev() {
                for behind_m in [6.0, 12.0, 18.0, 26.0] {
                    let rests_m = s_m - self.front_m() - half_m - behind_m;
                    let way_m = COMES_SHARE * speed_mps * self.contact_s;
                    let from = self.road(rests_m - way_m, t_m);
                    list.push(Way { speed_mps, stops_m: Some(way_m), ..Way::stands(from) });
                }
            }
            list.extend([6.0, 12.0, 20.0].map(|behind_m| Way::stands(self.road(rear - behind_m, t_m))));
        }
        list
    }

    pub(super) fn beside(&self, side: LeftRight) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let t_m = [self.beside_m(side, self.until), self.beside_m(side, 0)];
        let mut list = Vec::new();
        for speed_mps in self.speeds() {
            for (on_m, before_s) in [(4.0, 0.0), (10.0, 0.0), (-8.0, 0.0), (14.0, 0.0), (6.0, 2.0), (0.0, 4.0)] {
                let at = |t_m: f64| Way::straight(self.road(s_m + on_m, t_m), speed_mps, self.contact_s - before_s);
                list.extend(t_m.map(at));
            }
            // It comes along, and stands there.
            let way_m = COMES_SHARE * speed_mps * self.contact_s;
            let rests = |on_m: f64| Way {
                speed_mps,
                stops_m: Some(way_m),
                ..Way::stands(self.road(s_m + on_m - way_m, t_m[0]))
            };
            list.extend([0.0, -6.0, 6.0, -12.0].map(rests));
        }
        // Far over in its lane, where somebody comes between.
        let sign = -side.sign();
        let over = |way: &Way| {
            let away = Vec2::from_heading(way.from.heading).left() * (-sign * FAR_OVER_M);
            Way { from: Pose { position: way.from.position + away, ..way.from }, by: Vec::new(), ..*way }
        };
        let far: Vec<Way> = list.iter().map(over).collect();
        list.extend(far);
        list
    }

    /// Comes from behind, and is beside the ego or ahead of it at the contact.
    pub(super) fn passers(&self, place: Option<Origin>, half_m: f64) -> Vec<Way> {
        let (s_m, t_m) = self.at(self.until);
        let sides = match place {
            Some(Origin::Beside { side }) => vec![side],
            _ => vec![LeftRight::Left, LeftRight::Right],
        };
        let mut list = Vec::new();
        for side in sides {
            let sign = -side.sign();
            for on_m in [8.0, 14.0, 4.0, 22.0] {
                let speed_mps = self.speeds()[0].max(LOT_MPS) + PASSES_BY_MPS;
                // Beside one that is parked it comes along the lane.
                let line_m =
                    if t_m.abs() > 0.5 * LANE_M && t_m * sign < 0.0 { 0.0 } else { self.beside_m(side, self.until) };
                list.push(Way::straight(self.road(s_m + on_m + half_m, line_m), speed_mps, self.contact_s));
            }
        }
        list
    }

    /// Changes from beside the ego's lane into that, ahead of it.
    pub(super) fn mergers(&self, from: LeftRight, half_m: f64) -> Vec<Way> {
        let (s_m, t_m) = self.at(self.until);
        let to_m = self.told.sv_aside().map_or(t_m, |aside| aside.from_t_m);
        let shifts_m = from.sign() * LANE_M;
        let [mean_mps, _] = self.speeds();
        let place = |on_m: f64| self.road(s_m + self.front_m() + half_m + on_m, to_m - shifts_m);
        let way = |speed_mps: f64, on_m: f64| Way { shifts_m, ..Way::straight(place(on_m), speed_mps, self.contact_s) };
        match self.ego.states[self.until].stands() {
            true => [14.0, 18.0, 22.0].map(|on_m| way(MERGES_MPS, on_m)).into(),
            false => [6.0, 10.0, 14.0, 20.0].map(|on_m| way(mean_mps, on_m)).into(),
        }
    }

    /// Changes from one lane to the next, ahead of the ego or beside it.
    pub(super) fn changers(&self, place: Option<Origin>, side: Option<LeftRight>, half_m: f64) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let behind = place == Some(Origin::Behind);
        let far: &[f64] = if behind { &[-18.0, -24.0, -32.0] } else { &[8.0, 14.0, 3.0, 22.0, 30.0] };
        let sides = side.map_or(vec![LeftRight::Left, LeftRight::Right], |side| vec![side]);
        let mut list = Vec::new();
        for side in sides {
            let shifts_m = -side.sign() * LANE_M;
            for to_m in [-LANE_M, LANE_M, 0.0] {
                for speed_mps in self.speeds() {
                    for on_m in far {
                        let at = self.road(s_m + self.front_m() + half_m + on_m, to_m - shifts_m);
                        list.push(Way { shifts_m, ..Way::straight(at, speed_mps, self.contact_s) });
                    }
                }
            }
        }
        list
    }
}
