//! A way of touching.

use crate::ground::way::Ground;
use crate::touch::opening::Opening;
use recrash_model::geometry::Pose;
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
    /// Along the ego's way and to the right of it, where the partner is at the contact that comes by it. [m]
    pub(crate) cp_follows_m: Option<(f64, f64)>,
    /// The last part of the partner's way, of who turns as it touches.
    pub(crate) bend: Option<Bend>,
    /// The door that takes part.
    pub(crate) door: Option<Opening>,
    /// How well it fits: zone steps off on both sides, then the order of trial.
    pub(crate) cost: (u32, usize),
}

/// The last part of the partner's way, which is a bend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bend {
    /// Where it begins.
    pub(crate) from: Pose,
    pub(crate) length_m: f64,
}
