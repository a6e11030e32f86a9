//! The two as a rollout shows them, and the road around them, for those who are near.

use crate::ground::pieces::corner_m;
use crate::ground::way::Ground;
use crate::told::crash::Told;
use crate::usual::LANE_M;
use recrash_model::account::{LeftRight, PlaceKind};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::rollout::{ActorTrack, EventKind, Rollout};
use recrash_model::scenario::{Strip, StripKind};

/// Usual speeds: on a street, in a lot, of who rides. [m/s]
pub(super) const DRIVES_MPS: f64 = 7.0;
pub(super) const LOT_MPS: f64 = 3.0;
pub(super) const RIDES_MPS: f64 = 4.0;

/// The crash, as it is without whoever is near.
pub(super) struct Scene<'a> {
    pub(super) told: &'a Told,
    pub(super) ground: &'a Ground,
    pub(super) ego: &'a ActorTrack,
    pub(super) partner: Option<&'a ActorTrack>,
    pub(super) contact_s: f64,
    pub(super) until: usize,
    /// Whoever is near is so on the road into which the ego has turned.
    pub(super) turned: bool,
}

impl<'a> Scene<'a> {
    pub(super) fn of(told: &'a Told, ground: &'a Ground, rollout: &'a Rollout) -> Option<Self> {
        let touched = |event: &recrash_model::rollout::Event| {
            let ego =
                matches!(event.kind, EventKind::Contact { a: 0, .. } | EventKind::ObstacleContact { actor: 0, .. });
            ego.then_some(event.time_s)
        };
        let contact_s = rollout.events.iter().find_map(touched)?;
        let ego = rollout.ego_track();
        let until = ego.step_at(contact_s);
        let partner = rollout.actors.iter().find(|track| track.id == "cp");
        Some(Self { told, ground, ego, partner, contact_s, until, turned: false })
    }

    pub(super) fn front_m(&self) -> f64 {
        0.5 * self.ego.length_m
    }

    /// How far along its road the ego is, and how far to the right of its line. [m]
    pub(super) fn at(&self, step: usize) -> (f64, f64) {
        self.ground.beside(self.ego.states[step].position())
    }

    /// A place on the ego's road; where the ego turns, straight on through the junction, but for who is met behind its turn.
    pub(super) fn road(&self, s_m: f64, t_m: f64) -> Pose {
        let line_m = self.ground.first_m();
        if s_m <= line_m || !self.ground.junction || self.turned {
            return self.ground.pose(s_m, t_m);
        }
        let line = self.ground.pose(line_m, t_m);
        Pose { position: line.position + Vec2::from_heading(line.heading) * (s_m - line_m), ..line }
    }

    pub(super) fn against(&self, s_m: f64) -> Pose {
        self.against_in(0, s_m)
    }

    /// In a lane towards the ego, 0 is the next one.
    pub(super) fn against_in(&self, lane: usize, s_m: f64) -> Pose {
        let pose = self.road(s_m, -self.ground.opposing_m - lane as f64 * self.ground.lane_m);
        Pose { heading: pose.heading + std::f64::consts::PI, ..pose }
    }

    /// How fast the ego came, on average, and the usual speed.
    pub(super) fn speeds(&self) -> [f64; 2] {
        let way_m: f64 = (0..self.until)
            .map(|step| self.ego.states[step].position().distance(self.ego.states[step + 1].position()))
            .sum();
        let lot = self.told.place.is_lot() || self.told.place == PlaceKind::Driveway;
        let usual_mps = if lot { LOT_MPS } else { DRIVES_MPS };
        [(way_m / self.contact_s.max(1.0)).max(LOT_MPS), usual_mps]
    }

    /// Strips on the right and on the left of the ego's road.
    pub(super) fn sides(&self) -> [&[Strip]; 2] {
        let road = &self.ground.map.roads[self.ground.own_road()];
        // The ego goes against the line of a road that is drawn from the junction.
        if self.ground.junction { [&road.left, &road.right] } else { [&road.right, &road.left] }
    }

    pub(super) fn is_two_way(&self) -> bool {
        self.sides()[1].iter().any(|strip| strip.kind == StripKind::Driving)
    }

    /// The ego's line, those of the lanes beside it, and that to which it goes. [m]
    pub(super) fn lines(&self) -> Vec<f64> {
        let to_m = self.told.sv_aside().map(|aside| aside.to_t_m).filter(|to_m| to_m.abs() >= LANE_M);
        let from_m = self.told.sv_aside().map_or(0.0, |aside| aside.from_t_m);
        // Beside it only where lanes lead its way.
        let [_, right_m] = self.ground.lane_edges_m;
        let left_m = self.ground.opposing_m - 0.5 * self.ground.lane_m;
        let lane_m = self.ground.lane_m;
        let beside = [-lane_m, lane_m].into_iter().filter(|t_m| *t_m < right_m && -*t_m < left_m);
        to_m.into_iter().chain([from_m]).chain(beside).collect()
    }

    /// Whether a lane lies there, of either direction.
    pub(super) fn lies_in_lane(&self, t_m: f64) -> bool {
        let [left_m, right_m] = self.ground.kerbs_m.map(|kerb_m| kerb_m - 0.5 * StripKind::Parking.usual_width_m());
        t_m < right_m && t_m > -left_m
    }

    pub(super) fn beside_m(&self, side: LeftRight, step: usize) -> f64 {
        let wide_m = self.ground.lane_m;
        let lane_m = (self.at(step).1 / wide_m).round() * wide_m;
        lane_m + if side == LeftRight::Left { -wide_m } else { wide_m }
    }

    /// Where the crossing road's lanes from one side, and to it, are: a pose on the line where the junction begins, facing into it.
    pub(super) fn arm(&self, side: LeftRight, out: bool, back_m: f64) -> Option<Pose> {
        if !self.ground.junction {
            return None;
        }
        let corner_m = corner_m(self.ground.lanes);
        let centre_m = self.ground.first_m() + corner_m;
        // The middle of the ego's road, and of the crossing one.
        let middle_m = 0.5 * LANE_M - self.ground.opposing_m;
        let sign = -side.sign();
        // Seen from the ego, who comes from the left drives on its own right: nearer to the ego.
        let lane_m = 0.5 * LANE_M * sign * if out { -1.0 } else { 1.0 };
        let pose = self.road(centre_m + lane_m, middle_m + sign * (corner_m + back_m));
        let turned = 0.5 * std::f64::consts::PI * sign * if out { -1.0 } else { 1.0 };
        Some(Pose { heading: pose.heading + turned, ..pose })
    }
}
