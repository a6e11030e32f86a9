//! Questions to who stands at the kerb, comes from there, or backs out beside the road.

use crate::told::crash::Told;
use crate::told::phase::Phase;
use crate::told::side::Turning;
use crate::told::zones::side_of;
use recrash_model::account::{Act, ContactState, LaneWord, LeftRight, Origin, PlaceKind, StandReason, Striker};
use recrash_model::template::Movement;

impl Told {
    /// Whether the ego stands at the kerb: it is parked, or is told to stand there or to have pulled over, and not to be in a lane.
    pub(crate) fn is_at_kerb(&self) -> bool {
        let stands = self.thing.is_some() && self.cp.state.stands();
        let parked = self.sv.state == ContactState::Parked || self.sv.came_to_park;
        let street = self.place.is_street();
        let there = (parked || self.stops_at_kerb()) && !self.is_in_lane(true);
        street && (there || self.is_partly_in_lane(true)) && !stands
    }

    /// Whether one of the two is told to stand in a driving lane: by a word for the lane, double-parked, or passed by who takes the opposite
    /// side for it.
    fn is_in_lane(&self, of_ego: bool) -> bool {
        let (side, told) = if of_ego { (&self.sv, self.layout.sv) } else { (&self.cp, self.layout.cp) };
        // Who lets passengers in or out, and is passed, is in the way, but where words for the kerb tell otherwise.
        let boards = self.reasons.contains(&StandReason::PickupDropoff) && !told.at_kerb;
        let passes = self.cp.lane == Some(LaneWord::Opposing) || boards && self.cp.movement == Some(Movement::Passing);
        let passed = self.origin == Origin::Behind && passes && self.cp.state != ContactState::Reversing;
        side.lane.is_some_and(|lane| lane != LaneWord::Curb) || told.in_lane || of_ego && passed
    }

    /// Whether one that stands is told to do so beside the lanes of a street: parked, or at the kerb.
    pub(crate) fn stands_beside(&self, of_ego: bool) -> bool {
        let (side, told) = if of_ego { (&self.sv, self.layout.sv) } else { (&self.cp, self.layout.cp) };
        let street = self.place.is_street();
        let parked = side.state == ContactState::Parked || side.came_to_park || side.state.stands() && told.at_kerb;
        street
            && parked
            && !self.is_partly_in_lane(of_ego)
            && !self.is_in_lane(of_ego)
            && !(of_ego && self.makes_room_in_lane())
            && (of_ego || self.thing.is_none())
    }

    /// Whether a parked partner's door touches that is on the ego's side only where the partner faces the other way.
    pub(crate) fn is_parked_against(&self) -> bool {
        let Origin::Parked { side: Some(side) } = self.origin else { return false };
        let stands = self.cp.state == ContactState::Parked && self.thing.is_none() && !self.diagonal;
        stands && self.door == Some(Striker::Cp) && side_of(&self.cp.zones) == Some(side)
    }

    /// Whether the partner parks, forwards, behind an ego that stands at the kerb.
    pub(crate) fn parks_behind(&self) -> bool {
        let last = self.cp.acts.last().is_none_or(|doing| doing.act == Act::Park);
        let parks = self.cp.movement == Some(Movement::ParkingManeuver) && last && !self.cp.backs_in;
        let moves = self.cp.state == ContactState::Moving;
        parks && moves && self.is_at_kerb() && matches!(self.origin, Origin::Behind | Origin::Parked { .. })
    }

    /// Whether an ego that stood at the kerb has just left it.
    pub(super) fn leaves_kerb(&self) -> bool {
        let leaves = match self.sv.movement {
            Some(Movement::ChangingLanes | Movement::Merging | Movement::LaneDeparture) => true,
            Some(Movement::Straight | Movement::Passing) => self.sv.aside == Some(LeftRight::Left),
            _ => false,
        };
        let left = self.sv.aside != Some(LeftRight::Right);
        let moves =
            self.sv.state == ContactState::SettingOff || self.sv.state == ContactState::Moving && self.sv.stood_first;
        self.layout.sv.at_kerb && moves && leaves && left
    }

    /// Whether an ego that pulls out meets one that is parked ahead of it with a left corner alone: nobody tells from which kerb it came, and that is
    /// so at the left one, of a one-way street.
    pub(crate) fn leaves_left_kerb(&self) -> bool {
        let pulls_out = self.sv.movement == Some(Movement::EnteringTraffic) && self.sv.aside.is_none();
        let ahead = self.origin == Origin::Ahead && self.cp.state == ContactState::Parked && self.stands_beside(false);
        let street = self.place == PlaceKind::Street && self.sv.turning == Turning::No;
        pulls_out
            && ahead
            && street
            && self.sv.zones.iter().all(|zone| zone.is_front())
            && side_of(&self.sv.zones) == Some(LeftRight::Left)
    }

    /// Whether an ego that stood at the kerb sets off straight on, or did, and touches one that stands there ahead of it: it is beside the lanes.
    pub(crate) fn sets_off_at_kerb(&self) -> bool {
        let moves = matches!(self.sv.state, ContactState::Moving | ContactState::SettingOff) && self.sv.stood_first;
        let straight = self.sv.turning == Turning::No && self.sv_aside().is_none() && self.sv.lane.is_none();
        let ahead = self.origin == Origin::Ahead && self.stands_beside(false);
        // Who has just set off has not left it.
        let just = self.sv.state == ContactState::SettingOff && !self.layout.sv.in_lane;
        self.layout.sv.at_kerb && straight && (just || moves && ahead)
    }

    /// Whether the ego went aside and stopped for one that comes towards it in a narrow street: it stays in its lane.
    fn makes_room_in_lane(&self) -> bool {
        self.squeezes_by() && matches!(self.sv.stopped_aside, Some(Act::Drift | Act::Swerve))
    }

    /// Whether an ego that is not parked stopped at the kerb, and has not moved since.
    fn stops_at_kerb(&self) -> bool {
        let steps = self.sv.phases.first().is_none_or(|phase| *phase == Phase::Stands);
        let stops = self.sv.state == ContactState::Stopped && steps && self.sv.turning == Turning::No;
        let pulls_over =
            matches!(self.sv.stopped_aside, Some(Act::PullOver | Act::Park)) && self.origin != Origin::Opposite;
        let to_right = self.sv.aside != Some(LeftRight::Left);
        stops && to_right && !self.makes_room_in_lane() && (self.layout.sv.at_kerb || pulls_over)
    }

    /// Whether an ego that is told to have stood at the kerb from the start, and not to be passed from behind, stands there all the time.
    pub(crate) fn stays_at_kerb(&self) -> bool {
        let stood = self.sv.state == ContactState::Stopped && self.sv.stands_from_start && self.sv.phases.is_empty();
        stood && self.origin != Origin::Behind && self.is_at_kerb()
    }

    /// Whether the partner comes out of a driveway or a lot onto a street along which the ego goes straight on: no road crosses that there.
    pub(crate) fn comes_off_drive(&self) -> bool {
        let drive = matches!(self.origin, Origin::Driveway { .. }) && self.place == PlaceKind::Street;
        drive && self.sv.turning == Turning::No && self.sv.control.is_none() && !self.enters() && !self.cp.enters()
    }

    /// Whether the partner reverses out of a stall or a driveway.
    pub(crate) fn backs_out(&self) -> bool {
        let beside = matches!(self.origin, Origin::Stall { .. } | Origin::Driveway { .. });
        beside && self.cp.state == ContactState::Reversing
    }

    /// Whether the partner backs from a stand across a street, and no road is told by which it would have come there.
    pub(crate) fn backs_across(&self) -> bool {
        let backs =
            self.cp.state == ContactState::Reversing && self.cp.turning == Turning::No && self.cp.slants.is_none();
        let across = matches!(self.origin, Origin::Cross { .. });
        across && backs && self.origin_told && self.place == PlaceKind::Street && !self.heading_told
    }

    /// Whether the partner comes out of a space where others park: at the kerb of a street, or in a stall beside it.
    pub(crate) fn leaves_space(&self) -> bool {
        let space = matches!(self.origin, Origin::Parked { .. } | Origin::Stall { .. });
        let street = self.place.is_street();
        space && street && self.cp.state != ContactState::Stopped && !self.is_in_lane(false) && self.thing.is_none()
    }

    /// From which side the partner comes across.
    pub(crate) fn comes_from_side(&self) -> Option<LeftRight> {
        match self.origin {
            Origin::Cross { side } => Some(side),
            Origin::Parked { side }
            | Origin::Driveway { side }
            | Origin::Stall { side }
            | Origin::Sidewalk { side } => side,
            _ => None,
        }
    }

    /// Whether the partner comes out of a space beside the road.
    pub(crate) fn comes_from_aside(&self) -> bool {
        matches!(self.origin, Origin::Driveway { .. } | Origin::Stall { .. } | Origin::Parked { .. })
    }
}
