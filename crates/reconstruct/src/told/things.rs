//! Questions to what is told of a thing: whether it moves, stands across, or lies where the ego drives over it.

use crate::told::crash::Told;
use crate::told::edge::LONG_M;
use crate::told::side::size_of;
use crate::told::zones::side_of;
use recrash_model::account::{ContactState, Kind, LeftRight};
use recrash_model::kinds::PartnerKind;
use recrash_model::zones::ContactZone;

impl Told {
    /// Whether the partner is told to have touched the ego's underside alone, and is no thing that stands.
    pub(crate) fn is_driven_over(&self) -> bool {
        let stands = |kind| matches!(kind, Kind::Wall | Kind::Pole | Kind::Gate | Kind::Barrier | Kind::Door);
        self.sv.only_below && (self.cp.kind == PartnerKind::Animal || self.thing.is_some_and(|kind| !stands(kind)))
    }
}

/// What fell off it slides for so long until it is met, and slows so; it is no slower than this. [s, m/s^2, m/s]
pub(crate) const DROPPED_S: f64 = 2.5;
pub(crate) const DROPPED_MPS2: f64 = 5.0;
const DROPPED_LEAST_MPS: f64 = 0.5;

impl Told {
    /// How fast a thing is yet that fell off the vehicle ahead. [m/s]
    pub(crate) fn dropped_mps(&self) -> Option<f64> {
        let slowed_mps = self.sv.speed_mps - DROPPED_MPS2 * DROPPED_S;
        self.dropped.map(|_| slowed_mps.max(DROPPED_LEAST_MPS.min(self.sv.speed_mps)))
    }

    /// Whether the partner is a kerb or a wall that stands across the ego's way: nobody tells on which side of it.
    pub(crate) fn stands_across(&self) -> bool {
        let along = matches!(self.thing, Some(Kind::Curb | Kind::Wall));
        let ahead = side_of(&self.sv.zones).is_none() || self.sv.zones.contains(&ContactZone::Front);
        along && ahead && self.lies.is_none() && self.edge.is_none()
    }

    /// On which side of its front the ego meets a chain or a wire that hangs across its lane.
    pub(crate) fn meets_chain(&self) -> Option<LeftRight> {
        let hangs = self.thing == Some(Kind::Chain) && self.lies.is_none() && self.edge.is_none();
        side_of(&self.sv.zones).filter(|_| hangs && self.sv.zones.iter().all(|zone| zone.is_front()))
    }

    /// Whether the partner is a chain, a closed gate or a barrier, which bars the ego's way: no side of it is told.
    pub(crate) fn bars_way(&self) -> bool {
        let bars = matches!(self.thing, Some(Kind::Chain | Kind::Gate | Kind::Barrier));
        let front = self.sv.zones.is_empty() || self.sv.zones.iter().any(|zone| zone.is_front());
        bars && front && self.cp.state.stands() && self.lies.is_none() && self.edge.is_none() && !self.gate_swings
    }

    /// Whether what bars the ego's way is long enough to lie across it: "a chain hung across the entrance".
    pub(crate) fn lies_across(&self) -> bool {
        let (length_m, width_m) = size_of(&self.cp);
        (self.bars_way() || self.stands_across()) && length_m.max(width_m) > LONG_M
    }

    /// Whether it is told, or known of its kind, how the partner lies, hangs or reaches into the ego's way.
    pub(crate) fn has_told_place(&self) -> bool {
        self.lies.is_some() || self.lies_across() || self.reaches_in.is_some()
    }

    /// Whether the partner is a thing that came into the way by itself.
    pub(crate) fn is_sliding(&self) -> bool {
        self.thing.is_some() && self.slides && self.cp.state == ContactState::Moving
    }

    /// Whether the partner comes across from aside: a thing, somebody on foot, or an animal.
    pub(crate) fn comes_across(&self) -> bool {
        self.is_sliding() || self.walks_across && self.cp.state == ContactState::Moving
    }
}
