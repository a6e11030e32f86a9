//! Questions to what is told of somebody who comes over a crosswalk.

use crate::told::crash::Told;
use crate::told::side::{Turning, size_of};
use recrash_model::account::{ContactState, LeftRight, Origin};
use recrash_model::kinds::PartnerKind;
use recrash_model::zones::ContactZone;

impl Told {
    /// Whether the partner crosses at a junction where people walk: on foot, or told to ride over the crosswalk or off the sidewalk.
    pub(crate) fn crosses_at_walk(&self) -> bool {
        let walks = match self.cp.kind {
            PartnerKind::Pedestrian => !self.layout.beside_crosswalk,
            PartnerKind::Cyclist | PartnerKind::OtherNonMotorist => self.layout.crosswalk,
            _ => false,
        };
        let moves = matches!(self.cp.state, ContactState::Moving | ContactState::SettingOff);
        let street = self.place.is_street();
        walks && moves && street && matches!(self.origin, Origin::Cross { .. }) && self.edge.is_none()
    }

    /// Whether the partner crosses on foot short of the crosswalk, before a junction that the ego has not entered: off the kerb of the ego's road.
    pub(crate) fn crosses_before_walk(&self) -> bool {
        let moves = matches!(self.cp.state, ContactState::Moving | ContactState::SettingOff);
        let short = self.cp.kind == PartnerKind::Pedestrian && self.layout.beside_crosswalk && moves;
        short && matches!(self.origin, Origin::Cross { .. }) && self.sv.turning == Turning::No && !self.enters()
    }

    /// The side to which the ego turns into the road over which the partner walks. Who turns right as somebody comes from the right meets that one
    /// before it has come there.
    pub(crate) fn turns_over_walk(&self) -> Option<LeftRight> {
        let near = self.origin == Origin::Cross { side: LeftRight::Right };
        match self.sv.turning {
            _ if self.sv.turns_later => None,
            Turning::Right if near => None,
            Turning::Left if self.crosses_at_walk() => Some(LeftRight::Left),
            Turning::Right if self.crosses_at_walk() => Some(LeftRight::Right),
            _ => None,
        }
    }

    /// From the middle of the ego ahead to its touched part: its front, its rear or a flank. [m]
    pub(crate) fn touched_ahead_m(&self) -> f64 {
        let of = |wanted: fn(ContactZone) -> bool| self.sv.zones.iter().any(|zone| wanted(*zone));
        let half_m = 0.5 * size_of(&self.sv).0;
        match (of(ContactZone::is_front) || self.sv.zones.is_empty(), of(ContactZone::is_rear)) {
            (true, false) => half_m,
            (false, true) => -half_m,
            _ => 0.0,
        }
    }
}
