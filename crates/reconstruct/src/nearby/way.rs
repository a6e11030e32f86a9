//! How somebody comes to be near.

use crate::pace::plain::{next, when};
use recrash_model::account::LeftRight;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::scenario::{ActorPlan, Deed, Leg, Place};

/// Who slows does so long before the contact, by so much; who passes is faster than the ego by so much. [s, m/s]
const SLOWS_BEFORE_S: f64 = 3.0;
pub(super) const SLOWS_BY_MPS: f64 = 2.0;
pub(super) const PASSES_BY_MPS: f64 = 4.0;
pub(super) const BRAKES_MPS2: f64 = 2.5;

/// Who backs begins to so long before the contact, and does so over this way. [s, m, m/s, m/s^2]
const BACKS_BEFORE_S: f64 = 2.5;
const BACKS_M: f64 = 1.5;
const BACKS_MPS: f64 = 1.0;
const BACKS_MPS2: f64 = 1.0;

/// Who changes lanes takes so long, and has done so this long before the contact. [s]
const CHANGES_S: f64 = 3.5;
const CHANGED_BEFORE_S: f64 = 0.5;

/// How somebody comes to be near: where it is at first, what it drives, and where it goes.
#[derive(Clone)]
pub(super) struct Way {
    pub(super) from: Pose,
    pub(super) speed_mps: f64,
    /// It stands after so much of its way. [m]
    pub(super) stops_m: Option<f64>,
    pub(super) slows: bool,
    /// It moves so far to the right before the contact. [m]
    pub(super) shifts_m: f64,
    /// From when, and for how long, where that is not the usual. [s]
    pub(super) shifts_s: Option<(f64, f64)>,
    /// It goes backwards.
    pub(super) backs: bool,
    /// It stands at first, and sets off at a time to a speed. [s, m/s]
    pub(super) sets_off: Option<(f64, f64)>,
    /// Places on its way, after which it goes straight on.
    pub(super) by: Vec<Pose>,
}

impl Way {
    pub(super) fn stands(from: Pose) -> Self {
        Self {
            from,
            speed_mps: 0.0,
            stops_m: None,
            slows: false,
            shifts_m: 0.0,
            shifts_s: None,
            backs: false,
            sets_off: None,
            by: Vec::new(),
        }
    }

    /// Straight on, where it is at a place at a time.
    pub(super) fn straight(at: Pose, speed_mps: f64, at_s: f64) -> Self {
        let from = Pose { position: at.position - Vec2::from_heading(at.heading) * (speed_mps * at_s), ..at };
        Self { speed_mps, ..Self::stands(from) }
    }

    /// The same, and aside by so much.
    pub(super) fn aside(self, side: LeftRight, by_m: f64) -> Self {
        Self { shifts_m: -side.sign() * by_m, ..self }
    }

    pub(super) fn plan(&self, contact_s: f64) -> ActorPlan {
        if self.backs {
            let end = Pose { position: self.from.position - Vec2::from_heading(self.from.heading) * 20.0, ..self.from };
            let begins_s = tenth((contact_s - BACKS_BEFORE_S).max(0.1));
            let goes = when(begins_s, Deed::Speed { to_mps: BACKS_MPS, rate_mps2: BACKS_MPS2 });
            return ActorPlan {
                course: vec![Leg::Curve { to: place(end), reverse: true }],
                acts: vec![goes, next(Deed::Stop { rate_mps2: BACKS_MPS2, at_m: Some(BACKS_M) })],
                ..ActorPlan::standing(place(self.from))
            };
        }
        if let Some(off) = self.sets_off {
            return self.out(off);
        }
        if self.speed_mps == 0.0 {
            return ActorPlan::standing(place(self.from));
        }
        let last = self.by.last().copied().unwrap_or(self.from);
        let on_m = self.speed_mps * (contact_s + 10.0) + 20.0;
        let end = Pose { position: last.position + Vec2::from_heading(last.heading) * on_m, ..last };
        let stops = self.stops_m.map(|at_m| when(0.1, Deed::Stop { rate_mps2: BRAKES_MPS2, at_m: Some(at_m) }));
        let slower = Deed::Speed { to_mps: self.speed_mps - SLOWS_BY_MPS, rate_mps2: BRAKES_MPS2 };
        let slows = self.slows.then(|| when(tenth(contact_s - SLOWS_BEFORE_S), slower));
        let (from_s, over_s) = self.shifts_s.unwrap_or((contact_s - CHANGES_S - CHANGED_BEFORE_S, CHANGES_S));
        let shift = Deed::Shift { to_t_m: self.shifts_m, over_m: over_s * self.speed_mps };
        let shifts = (self.shifts_m != 0.0).then(|| when(tenth(from_s), shift));
        ActorPlan {
            speed_mps: self.speed_mps,
            course: self.by.iter().chain([&end]).map(|to| Leg::Curve { to: place(*to), reverse: false }).collect(),
            acts: stops.into_iter().chain(slows).chain(shifts).collect(),
            ..ActorPlan::standing(place(self.from))
        }
    }
}

fn place(pose: Pose) -> Place {
    Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees())
}

fn tenth(time_s: f64) -> f64 {
    (time_s * 10.0).round() / 10.0
}

/// Who sets off comes to this speed, so fast; who comes out of a space is out after so much way, and begins to leave it so soon after.
/// [m/s, m/s^2, m, s]
pub(super) const GOES_MPS: f64 = 6.0;
pub(super) const LEADS_MPS: f64 = 8.0;
const GOES_MPS2: f64 = 1.5;
const OUT_OVER_M: f64 = 10.0;
const LEAVES_S: f64 = 0.4;

impl Way {
    /// It stands, sets off, and leaves the place to one side where it is told to.
    fn out(&self, (at_s, to_mps): (f64, f64)) -> ActorPlan {
        let end = Pose { position: self.from.position + Vec2::from_heading(self.from.heading) * 200.0, ..self.from };
        let goes = when(tenth(at_s), Deed::Speed { to_mps, rate_mps2: GOES_MPS2 });
        let shift = Deed::Shift { to_t_m: self.shifts_m, over_m: OUT_OVER_M };
        let shifts = (self.shifts_m != 0.0).then(|| when(tenth(at_s + LEAVES_S), shift));
        ActorPlan {
            course: vec![Leg::Curve { to: place(end), reverse: false }],
            acts: [goes].into_iter().chain(shifts).collect(),
            ..ActorPlan::standing(place(self.from))
        }
    }
}
