//! Which roads meet at a junction, and which of them is no street but a way off one.

use crate::ground::lanes::has;
use crate::told::crash::Told;
use crate::told::layout::OffStreet;
use crate::told::others::{Extra, Role};
use crate::told::side::{Turning, is_on_foot};
use recrash_model::account::{LeftRight, Origin};

/// Names of the four, of which the ego comes by the first.
pub(super) const OWN: &str = "own";
pub(super) const AHEAD: &str = "ahead";
pub(super) const LEFT: &str = "left";
pub(super) const RIGHT: &str = "right";

/// The roads of a junction, but for the usual four streets.
pub(super) struct Arms {
    /// A driveway, an alley, or the way into a lot: one lane each way, and nothing beside them.
    pub(super) off_street: Option<&'static str>,
    /// None is there.
    pub(super) missing: Option<&'static str>,
    /// Lanes in each direction of the ego's road, of the streets that cross it, and of the one by which the partner comes.
    pub(super) lanes: usize,
    pub(super) street: usize,
    pub(super) cross_lanes: usize,
}

/// A crossing street of a way off it has no more lanes each way.
const MOST_ACROSS: usize = 2;

impl Arms {
    /// The roads where a street has so many lanes each way.
    pub(super) fn of(told: &Told, street: usize) -> Self {
        let off_street = off_street(told);
        let own = off_street == Some(OWN);
        let lanes = if own { 1 } else { street };
        let street = if own { street.min(MOST_ACROSS) } else { street };
        let by_partner = off_street.is_some() && off_street == partners(told);
        let cross_lanes = if by_partner { 1 } else { street };
        Self { off_street, missing: missing(told, off_street), lanes, street, cross_lanes }
    }
}

/// The one that is no street: into which the ego turns, out of which it does, or the partner comes.
fn off_street(told: &Told) -> Option<&'static str> {
    let crosses = matches!(told.origin, Origin::Cross { .. });
    match told.layout.off_street {
        _ if told.edge.is_some() => None,
        Some(OffStreet::Into) if exit(told).is_some() => exit(told),
        Some(OffStreet::OutOf) if told.sv.lane.is_none() => Some(OWN),
        _ if told.layout.cp_into && told.cp.turning != Turning::No => Some(left_by(told)).filter(|arm| *arm != OWN),
        _ if told.layout.cp_off_street && crosses && !is_on_foot(told.cp.kind) => partners(told),
        _ => None,
    }
}

/// The one into which the ego turns.
pub(super) const fn exit(told: &Told) -> Option<&'static str> {
    match told.sv.turning {
        Turning::Left => Some(LEFT),
        Turning::Right => Some(RIGHT),
        Turning::No | Turning::Round => None,
    }
}

/// The one by which the partner comes.
const fn partners(told: &Told) -> Option<&'static str> {
    match told.origin {
        Origin::Cross { side: LeftRight::Left } => Some(LEFT),
        Origin::Cross { side: LeftRight::Right } => Some(RIGHT),
        Origin::Opposite => Some(AHEAD),
        _ => None,
    }
}

/// The one that is not there: across from a way off the street, or where three roads meet, if nobody comes or goes by it.
fn missing(told: &Told, off_street: Option<&'static str>) -> Option<&'static str> {
    let across: &[&'static str] = match off_street {
        Some(LEFT) => &[RIGHT],
        Some(RIGHT) => &[LEFT],
        Some(OWN) => &[AHEAD],
        _ if told.layout.three_arms => &[AHEAD, RIGHT, LEFT],
        _ => &[],
    };
    across.iter().copied().find(|arm| !is_used(told, arm))
}

/// Whether somebody comes or goes by one of them, as far as is told.
fn is_used(told: &Told, arm: &'static str) -> bool {
    let roles = [Role::Crosser, Role::Blocker, Role::Beyond];
    let crossed = told.crossed_near || roles.into_iter().any(|role| has(told, role));
    let comes = told.wanted.iter().any(|extra| {
        extra.role == Role::Oncoming || extra.near.is_some_and(|near| near.place == Some(Origin::Opposite))
    });
    let others = told.all_way || crossed || told.wanted.iter().any(Extra::is_at_junction) || arm == AHEAD && comes;
    let own = exit(told).unwrap_or(AHEAD) == arm;
    others || own || partners(told) == Some(arm) || goes_by(told, arm)
}

/// Whether the partner leaves by one of them; who comes out of a way off the street goes no farther than to that.
fn goes_by(told: &Told, arm: &'static str) -> bool {
    let straight = told.cp.turning == Turning::No;
    // It follows the ego, or is beside it.
    let with_ego = straight && partners(told).is_none();
    let ends = straight && told.layout.cp_off_street;
    left_by(told) == arm && !ends && !with_ego && told.cp.speed_mps > 0.0
}

/// The one by which the partner leaves.
fn left_by(told: &Told) -> &'static str {
    let turns = match told.cp.turning {
        Turning::No | Turning::Round => 2,
        Turning::Left => 1,
        Turning::Right => 3,
    };
    // Clockwise, each seen from the next: who turns left out of the first comes to the second.
    let round = [OWN, LEFT, AHEAD, RIGHT];
    let from = partners(told).unwrap_or(OWN);
    let from = round.iter().position(|name| *name == from).unwrap_or(0);
    round[(from + turns) % round.len()]
}
