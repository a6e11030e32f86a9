//! Boxes that belong to a road user and stick out of its own, or follow it: mirrors, doors, arms, trailers.

use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::math;
use recrash_model::scenario::{Part, PartKind};

/// A box that belongs to a road user.
#[derive(Debug, Clone, PartialEq)]
pub struct Attached {
    /// Its owner's number.
    pub owner: u16,
    /// What it is.
    pub part: Part,
}

/// Where a part is now.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PartState {
    /// Angle of a door or an arm; a trailer's heading in the world. [rad]
    pub angle: f64,
    /// A move of it: where it begins and ends, and the steps of both. [rad]
    pub from: f64,
    /// See [`Self::from`].
    pub to: f64,
    /// See [`Self::from`].
    pub from_step: u32,
    /// See [`Self::from`].
    pub to_step: u32,
}

impl PartState {
    /// At rest, on an owner that faces this way.
    pub fn resting(part: &Part, heading: f64) -> Self {
        let angle = if part.kind == PartKind::Trailer { heading } else { 0.0 };
        Self { angle, from: angle, to: angle, ..Self::default() }
    }

    /// Begins to turn.
    pub fn turn(&mut self, to: f64, step: u32, steps: u32) {
        *self = Self { from: self.angle, to, from_step: step, to_step: step + steps, ..*self };
    }

    /// Where it is at a time, in steps.
    pub fn swing(&mut self, step: f64) {
        if self.to_step > self.from_step {
            let share = ((step - f64::from(self.from_step)) / f64::from(self.to_step - self.from_step)).clamp(0.0, 1.0);
            self.angle = self.from + (self.to - self.from) * share;
        }
    }
}

impl Attached {
    /// Draws a trailer on behind its hitch, which has moved (the tractrix of its axle).
    pub fn draw(&self, state: &mut PartState, before: Pose, after: Pose) {
        if self.part.kind != PartKind::Trailer {
            return;
        }
        let axle_m = self.axle_m();
        let axle = self.hitch(before) - Vec2::from_heading(state.angle) * axle_m;
        let way = self.hitch(after) - axle;
        if way.length() > 1e-6 {
            state.angle = math::atan2(way.y, way.x);
        }
    }

    fn axle_m(&self) -> f64 {
        self.part.axle_m.unwrap_or(0.8 * self.part.length_m)
    }

    fn hitch(&self, owner: Pose) -> Vec2 {
        let axis = Vec2::from_heading(owner.heading);
        owner.position + axis * self.part.x_m + axis.left() * self.part.y_m
    }

    /// Its middle and heading.
    pub fn pose(&self, state: &PartState, owner: Pose) -> Pose {
        let hinge = self.hitch(owner);
        let half = 0.5 * self.part.length_m;
        match self.part.kind {
            PartKind::Mirror | PartKind::Sensor | PartKind::Load => Pose { position: hinge, heading: owner.heading },
            PartKind::Door => {
                // Closed it points back along the body; it opens away from it.
                let side = if self.part.y_m >= 0.0 { -1.0 } else { 1.0 };
                let heading = math::wrap_angle(owner.heading + math::PI + side * state.angle);
                Pose { position: hinge + Vec2::from_heading(heading) * half, heading }
            }
            PartKind::Arm => {
                let heading = math::wrap_angle(owner.heading + state.angle);
                Pose { position: hinge + Vec2::from_heading(heading) * half, heading }
            }
            PartKind::Trailer => {
                Pose { position: hinge - Vec2::from_heading(state.angle) * half, heading: state.angle }
            }
        }
    }

    /// Its box.
    pub fn outline(&self, state: &PartState, owner: Pose) -> OrientedBox {
        OrientedBox::new(self.pose(state, owner), self.part.length_m, self.part.width_m)
    }

    /// How far it can reach from its owner's centre. [m]
    pub fn reach_m(&self) -> f64 {
        math::hypot(self.part.x_m, self.part.y_m) + self.part.length_m + self.part.width_m
    }

    /// Whether it hands on a push to its owner: a door or a mirror gives way.
    pub fn pushes(&self) -> bool {
        self.part.kind == PartKind::Trailer
    }
}
