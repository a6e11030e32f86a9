//! The two as they come to the contact, seen by those who are placed around them.

use crate::ground::way::Ground;
use crate::told::crash::Told;
use crate::told::side::{Turning, size_of};
use crate::usual::{LANE_M, ROOM_M};
use recrash_model::account::LeftRight;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::rollout::ActorTrack;
use recrash_model::scenario::ActorPlan;

/// An ego that slows for somebody could stop before it, braking so. [m/s^2]
pub(super) const BRAKES_MPS2: f64 = 2.5;

/// Who crosses, or comes by, does so before the contact: the ego stands for it, or slows; and before an ego that stood sets off, or
/// begins its turn. [s]
const CROSSES_BEFORE_S: f64 = 1.0;
pub(super) const MET_BEFORE_S: f64 = 0.5;
const CLEARED_S: f64 = 0.8;

/// From the ego's front to who is parked ahead at the kerb, and to whom it goes round. [m]
pub(super) const PARKED_AHEAD_M: f64 = 9.0;
pub(super) const ROUND_AHEAD_M: f64 = 6.0;

/// Who goes round somebody has left its line by so much, and leaves so much room beside it. [m]
pub(super) const BESIDE_M: f64 = 2.4;
pub(super) const ROOM_BESIDE_M: f64 = 0.6;

/// The two, as they come to the contact.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) told: &'a Told,
    pub(super) ground: &'a Ground,
    /// The ego's plan.
    pub(super) recorded: &'a ActorPlan,
    pub(super) ego: &'a ActorTrack,
    pub(super) partner: Option<&'a ActorTrack>,
    /// The step of the contact.
    pub(super) until: usize,
    /// When the ego stood last.
    pub(super) stand: Option<(usize, usize)>,
}

impl Scene<'_> {
    pub(super) fn front_m(&self) -> f64 {
        0.5 * size_of(&self.told.sv).0
    }

    pub(super) fn mps(&self, step: usize) -> f64 {
        self.ego.states[step].velocity().length()
    }

    /// How far along its way the ego is, and how far to the right of it. [m]
    pub(super) fn at(&self, step: usize) -> (f64, f64) {
        self.ground.beside(self.ego.states[step].position())
    }

    /// A place so far ahead of where the ego is: along its way, or straight ahead where it has left that.
    pub(super) fn ahead(&self, step: usize, ahead_m: f64) -> Pose {
        let (s_m, t_m) = self.at(step);
        let pose = self.ego.states[step].pose();
        let way = self.ground.pose(s_m, 0.0);
        match math::wrap_angle(way.heading - pose.heading).abs() < 0.1 {
            true => self.ground.pose(s_m + ahead_m, t_m),
            false => Pose { position: pose.position + Vec2::from_heading(pose.heading) * ahead_m, ..pose },
        }
    }

    /// Where the ego stands or slows for somebody, and how far ahead of it that one is at least. [m]
    pub(super) fn stops(&self) -> (usize, f64) {
        match self.stand {
            Some((from, _)) => (from, 0.0),
            None => (self.until, ROOM_M + 0.5 * self.mps(self.until) * self.mps(self.until) / BRAKES_MPS2),
        }
    }

    /// Whether the ego stood, and drives at the contact.
    pub(super) fn sets_off(&self) -> Option<usize> {
        self.stand.map(|(_, to)| to).filter(|to| *to + 1 < self.until)
    }

    /// When somebody crosses ahead, or comes by. [s]
    pub(super) fn clears_s(&self) -> f64 {
        let (until_s, turning) = (0.1 * self.until as f64, self.told.sv.turning != Turning::No);
        let came = self.ego.states[0].heading;
        let turns = |step: &usize| math::wrap_angle(self.ego.states[*step].heading - came).abs() > 0.15;
        let turned = (0..self.until).find(turns).filter(|_| turning && !self.told.sv.state.stands());
        match (self.sets_off(), turned) {
            (Some(to), _) => 0.1 * to as f64 - CLEARED_S,
            (None, Some(turned)) => 0.1 * turned as f64 - MET_BEFORE_S,
            (None, None) if self.stand.is_some() => until_s - CROSSES_BEFORE_S,
            (None, None) => until_s - MET_BEFORE_S,
        }
        .max(1.0)
    }

    /// From which side a partner comes that begins beside the ego's lane.
    pub(super) fn partner_from(&self) -> Option<LeftRight> {
        let (_, t_m) = self.ground.beside(self.partner?.states[0].position());
        (t_m.abs() > LANE_M).then_some(if t_m < 0.0 { LeftRight::Left } else { LeftRight::Right })
    }
}
