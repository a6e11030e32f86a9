//! A door, or the arm of a gate, that takes part in a crash.

use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::scenario::Part;
use recrash_model::zones::ContactZone;
use recrash_plan::acts::{Attached, PartState};

/// From the hinge of a door to its end, and its thickness. [m]
pub(crate) const DOOR_M: f64 = 1.0;
pub(super) const THICK_M: f64 = 0.08;

/// Doors open so far, in this time. [deg, s]
pub(super) const OPEN_DEG: f64 = 70.0;
pub(super) const OPENS_S: f64 = 1.0;

/// A door that takes part in a crash.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Opening {
    /// Whose it is: the subject vehicle's, or else the partner's.
    pub(crate) of_sv: bool,
    pub(crate) part: Part,
    /// It begins to open so long before the contact. [s]
    pub(crate) before_s: f64,
    /// The angle that it opens to. [deg]
    pub(crate) to_deg: f64,
    /// From its end to where it meets the other. [m]
    pub(crate) met_m: f64,
}

impl Opening {
    /// It opens for so long. [s]
    pub(crate) const OPENS_S: f64 = OPENS_S;

    /// Its box, so long before the contact.
    pub(super) fn outline(&self, owner: Pose, before_s: f64) -> OrientedBox {
        let share = ((self.before_s - before_s) / OPENS_S).clamp(0.0, 1.0);
        let angle = (share * self.to_deg).to_radians();
        let attached = Attached { owner: 0, part: self.part.clone() };
        attached.outline(&PartState { angle, ..PartState::default() }, owner)
    }
}

/// The zone of its owner that a door belongs to.
pub(crate) fn zone_of(owner: &OrientedBox, door: &OrientedBox) -> ContactZone {
    let hinge = owner.to_local(door.centre - door.axis * door.half_length);
    let side = hinge.y.signum() * owner.half_width;
    ContactZone::at(owner, owner.to_world(Vec2::new(hinge.x - 0.5 * DOOR_M, side)))
}

/// Whether a door stands open: it points away from its owner's side by more than 10 degrees.
pub(crate) fn is_open(owner: &OrientedBox, door: &OrientedBox) -> bool {
    // Shut, it points back along the body.
    owner.axis.dot(door.axis) > -OPEN_COSINE
}

/// Cosine of 10 degrees.
const OPEN_COSINE: f64 = 0.9848;
