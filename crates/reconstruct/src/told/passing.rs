//! Questions to who passes, comes over, or comes towards the ego.

use crate::told::aside::Aside;
use crate::told::crash::Told;
use crate::told::doing::Doing;
use crate::told::layout::strip_of;
use crate::told::side::{Turning, is_on_foot};
use crate::told::zones::side_of;
use crate::usual::LANE_M;
use recrash_model::account::{ContactState, LaneLine, LaneWord, LeftRight, Origin, PlaceKind};
use recrash_model::kinds::PartnerKind;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

impl Told {
    /// On which side the ego is touched.
    pub(crate) fn touched_side(&self) -> Option<LeftRight> {
        side_of(&self.sv.zones)
    }

    /// Whether the partner comes along the ego's lane behind it and passes it.
    pub(crate) fn passes_from_behind(&self) -> bool {
        let own_lane = match (self.cp.lane, self.sv.lane) {
            (Some(cp), sv) if strip_of(cp).is_some() => sv != Some(cp),
            (Some(LaneWord::Opposing), _) => false,
            _ if self.cp.lane_to_come => false,
            (Some(cp), Some(sv)) => cp != sv,
            _ => self.bus_lane().is_some(),
        };
        let own_lane = own_lane || self.leaves_to_who_passes();
        // Who changes lanes to pass has not come back where it touches no front.
        let pulls_out = self.cp.passes && !self.sv.zones.iter().any(|zone| zone.is_front());
        self.origin == Origin::Behind
            && (self.cp.movement == Some(Movement::Passing) || pulls_out || self.goes_out())
            && matches!(self.cp.state, ContactState::Moving | ContactState::SettingOff)
            && self.cp.turning == Turning::No
            && (!own_lane || self.splits_lanes().is_some())
    }

    /// On which side of an ego that keeps its lane the partner comes by between that and the next one.
    pub(crate) fn splits_lanes(&self) -> Option<LeftRight> {
        let keeps = self.sv.turning == Turning::No && self.cp.turning == Turning::No && self.sv_aside().is_none();
        let over = self.cp_drives_over() && self.cp.is_over(LaneLine::Lanes);
        let moves = self.cp.state == ContactState::Moving && (!self.cp.stood_first || over) && !self.is_at_kerb();
        let splits = (self.layout.splits || over) && self.origin == Origin::Behind && keeps && moves;
        self.cp.passes_on().or_else(|| side_of(&self.sv.zones)).filter(|_| splits)
    }

    /// Whether the partner rolls back in line: from straight ahead, its rear against the ego's front.
    pub(crate) fn backs_in_line(&self) -> bool {
        let (sv, cp) = (&self.sv, &self.cp);
        let straight = cp.turning == Turning::No && sv.turning == Turning::No && cp.slants.is_none() && !cp.backs_in;
        let backs = self.origin == Origin::Ahead && cp.state == ContactState::Reversing;
        let rear = cp.zones.is_empty() || cp.zones.contains(&ContactZone::Rear);
        backs && straight && rear && sv.zones.contains(&ContactZone::Front)
    }

    /// Whether the partner backs towards the ego from behind that, and did not swing or turn off for it.
    pub(crate) fn backs_from_behind(&self) -> bool {
        let plain = self.cp.slants.is_none() && !self.cp.backs_in && self.cp.turning == Turning::No;
        self.origin == Origin::Behind && self.cp.state == ContactState::Reversing && plain
    }

    /// On which side of the ego the partner passes it in the lane for buses, in which the ego is not.
    pub(crate) fn bus_lane(&self) -> Option<LeftRight> {
        let alone = self.cp.lane == Some(LaneWord::Bus) && self.sv.lane != Some(LaneWord::Bus);
        self.cp.passes_on().or_else(|| side_of(&self.sv.zones)).filter(|_| alone && self.origin == Origin::Behind)
    }

    /// Whether the ego changes into the lane in which the partner passes it, and meets it on that side.
    fn leaves_to_who_passes(&self) -> bool {
        let left_m = self.sv_aside().map_or(0.0, |aside| aside.from_t_m - aside.to_t_m);
        let touched = side_of(&self.sv.zones).map_or(0.0, LeftRight::sign);
        self.cp.movement == Some(Movement::Passing) && left_m * touched >= LANE_M
    }

    /// Whether the partner keeps its lane beside an ego that changes into that, and is touched by its front or its flank.
    pub(crate) fn keeps_lane_beside(&self, aside: Aside) -> bool {
        let by_m = aside.to_t_m - aside.from_t_m;
        let to = if by_m < 0.0 { LeftRight::Left } else { LeftRight::Right };
        let there = match self.origin {
            Origin::Beside { side } => side == to,
            Origin::Behind => side_of(&self.sv.zones) == Some(to),
            _ => false,
        };
        let leaves = |doing: &Doing| doing.is_aside() && !doing.is_pass();
        let straight = matches!(self.cp.movement, None | Some(Movement::Straight | Movement::Passing))
            && self.cp.turning == Turning::No
            && !self.cp.dodges
            && !self.cp.changed_lanes
            && !self.cp.acts.iter().any(leaves);
        let beside = !self.sv.zones.is_empty() && !self.sv.zones.iter().any(|zone| zone.is_rear());
        there && straight && beside && self.cp.state == ContactState::Moving && by_m.abs() >= LANE_M
    }

    /// Whether the partner stood behind the ego and changes lanes to the side on which it touches it then: out of the ego's lane.
    pub(crate) fn goes_out(&self) -> bool {
        let to = self.cp.aside.or_else(|| self.cp.passes_on());
        let touched = side_of(&self.sv.zones);
        let changes = self.cp.movement == Some(Movement::ChangingLanes);
        changes && self.cp.stood_first && to.is_some() && to == touched && !self.plainly
    }

    /// Whether the ego stopped for an oncoming partner that had begun to come over.
    pub(crate) fn stops_for_who_comes_over(&self) -> bool {
        !self.plainly && self.comes_over && self.sv.acts.iter().any(|doing| doing.answers(&self.cp.acts))
    }

    /// Whether the ego slowed or stopped for a partner that had come over, and not only begun to.
    pub(crate) fn slows_for_who_came_over(&self) -> bool {
        let straight = self.sv.turning == Turning::No && !self.plainly;
        straight && self.sv.acts.iter().any(|doing| doing.answers_done(&self.cp.acts))
    }

    /// Whether the partner stood behind the ego, and comes out of its lane to go round it.
    pub(crate) fn comes_out_from_stand(&self) -> bool {
        let stood = self.cp.stood_first || self.cp.state == ContactState::SettingOff;
        self.passes_from_behind() && stood && self.sv.turning == Turning::No && !self.plainly
    }

    /// Whether the partner's way is staged by what it did before.
    pub(crate) fn does_before(&self) -> bool {
        self.comes_out_from_stand()
            || self.stops_for_who_comes_over()
            || self.slows_for_who_came_over()
            || self.passes_after_stand()
    }

    /// Whether the partner comes along the lane beside which the ego is parked.
    pub(crate) fn comes_along_kerb(&self) -> bool {
        self.is_at_kerb()
            && self.origin == Origin::Behind
            && self.cp.state == ContactState::Moving
            && !self.cp.stood_first
            && self.cp.lane.and_then(strip_of).is_none()
            && !self.is_thrown()
            && !self.rides_along_kerb()
    }

    /// Whether a rider goes straight on along the kerb, into the rear of an ego that stands there: nobody tells that it left a lane.
    pub(crate) fn rides_along_kerb(&self) -> bool {
        let rides = matches!(self.cp.kind, PartnerKind::Cyclist | PartnerKind::OtherNonMotorist);
        let aside = self.cp.dodges || self.cp.acts.iter().any(Doing::is_aside);
        let straight = self.cp.movement == Some(Movement::Straight) && self.cp.turning == Turning::No && !aside;
        let rear = !self.sv.zones.is_empty() && self.sv.zones.iter().all(|zone| zone.is_rear());
        rides && straight && rear && self.origin == Origin::Behind && self.is_at_kerb()
    }

    /// Whether an oncoming partner drives straight on past an ego that stands, and touches it.
    pub(crate) fn is_met_by_oncoming(&self) -> bool {
        self.origin == Origin::Opposite
            && self.cp.turning == Turning::No
            && self.sv.state.stands()
            && self.thing.is_none()
            && self.door.is_none()
            && matches!(self.cp.movement, None | Some(Movement::Straight | Movement::Passing))
    }

    /// Whether that is in a narrow street: it comes along the middle of it.
    pub(crate) fn squeezes_by(&self) -> bool {
        self.layout.narrow && self.is_met_by_oncoming()
    }

    /// Whether the ego goes round somebody on its side of the road, as the partner comes towards it.
    pub(crate) fn rounds_other(&self) -> bool {
        self.sv.goes_round && self.origin == Origin::Opposite
    }

    /// Whether the ego drives straight on past an oncoming partner that has stopped in a narrow street: that has no lane of its own there.
    pub(crate) fn meets_in_narrow(&self) -> bool {
        let straight = self.sv.turning == Turning::No && self.cp.turning == Turning::No && self.sv_aside().is_none();
        let met = self.origin == Origin::Opposite && straight && self.thing.is_none() && self.door.is_none();
        let stands = self.cp.state == ContactState::Stopped && self.sv.state == ContactState::Moving;
        self.layout.narrow && met && stands && !self.comes_over
    }

    /// Whether an oncoming partner that drives straight on touches an ego that goes straight on or stands.
    pub(crate) fn is_passed_by_oncoming(&self) -> bool {
        self.origin == Origin::Opposite
            && self.cp.turning == Turning::No
            && self.sv.turning == Turning::No
            && self.thing.is_none()
            && (matches!(self.cp.movement, None | Some(Movement::Straight | Movement::Passing))
                || self.pulls_out_opposite())
    }

    /// Whether an oncoming partner pulled out from the kerb of its own side.
    pub(crate) fn pulls_out_opposite(&self) -> bool {
        let stood = self.layout.cp.at_kerb && self.cp.stood_first;
        let pulls_out = self.cp.movement == Some(Movement::EnteringTraffic) || stood;
        let moves = self.cp.state == ContactState::Moving;
        self.origin == Origin::Opposite && pulls_out && moves && self.cp.turning == Turning::No && self.thing.is_none()
    }

    /// Whether the partner came along behind the ego on the opposite side, and changed from there into a lane of its own direction.
    pub(crate) fn leaves_opposite(&self) -> bool {
        let changes = matches!(self.cp.movement, Some(Movement::ChangingLanes | Movement::Merging));
        self.origin == Origin::Behind && self.cp.lane == Some(LaneWord::Opposing) && changes
    }

    /// Whether the partner has to keep to the lanes of the ego's direction: nobody tells that it left them.
    pub(crate) fn keeps_direction(&self) -> bool {
        let along = matches!(self.origin, Origin::Ahead | Origin::Behind | Origin::Beside { .. });
        let over = matches!(
            self.cp.movement,
            Some(Movement::CrossingIntoOpposingLane | Movement::WrongWay | Movement::UTurn | Movement::Passing)
        );
        // Who backs out of the lane ahead does so in that.
        let backs = self.origin == Origin::Ahead && self.cp.state == ContactState::Reversing;
        let backs = backs && self.cp.slants.is_none() && !self.cp.backs_in;
        // Who turns from beside the ego, out of no lane that is counted, came along one of its direction until then.
        let beside = matches!(self.origin, Origin::Beside { .. }) && (self.cp.lane.is_none() || self.turns_abreast());
        let until_then = match self.cp.turning {
            Turning::No => true,
            Turning::Left | Turning::Right => beside,
            Turning::Round => false,
        };
        let drives = (self.cp.state == ContactState::Moving || backs) && until_then;
        let street = self.place != PlaceKind::Highway && !self.place.is_off_street();
        along && !over && drives && street && self.cp.lane != Some(LaneWord::Opposing) && self.thing.is_none()
    }

    /// Whether the partner comes along lanes of the ego's direction, and nothing tells that it was beside them, or on the other side.
    pub(crate) fn keeps_within_lanes(&self) -> bool {
        let along = matches!(self.origin, Origin::Behind | Origin::Beside { .. });
        let elsewhere = matches!(
            self.cp.movement,
            Some(
                Movement::CrossingIntoOpposingLane
                    | Movement::WrongWay
                    | Movement::UTurn
                    | Movement::EnteringTraffic
                    | Movement::ParkingManeuver
            )
        );
        let drives = self.cp.state == ContactState::Moving && !elsewhere && self.comes_along_lanes();
        let place = matches!(self.place, PlaceKind::Street | PlaceKind::Intersection | PlaceKind::Highway);
        // Who passes may have squeezed by.
        let passes = self.cp.acts.iter().any(Doing::is_pass);
        let beside = self.is_at_kerb() || self.bus_lane().is_some() || self.edge.is_some() || self.pushed || passes;
        along && drives && place && !beside && self.cp.lane != Some(LaneWord::Opposing)
    }

    /// Whether the partner stood beside the lanes before it came: at the kerb, in a stall or in a driveway.
    pub(crate) fn stood_beside(&self) -> bool {
        let beside = matches!(self.origin, Origin::Parked { .. } | Origin::Stall { .. } | Origin::Driveway { .. });
        let stood = beside && !self.rolls_out();
        stood && self.cp.state == ContactState::Moving && !is_on_foot(self.cp.kind) && self.thing.is_none()
    }

    /// Whether the partner came along out of a lot or a driveway, without a stop before the road.
    pub(crate) const fn rolls_out(&self) -> bool {
        let there = matches!(self.origin, Origin::Driveway { .. }) && matches!(self.cp.state, ContactState::Moving);
        there && self.cp.rolls_out && !self.comes_round
    }

    /// Whether the partner stood beside the ego's way, or across from it, and passed it then.
    pub(crate) fn passes_after_stand(&self) -> bool {
        let stood = self.cp.acts.iter().position(Doing::is_stand);
        let passed = self.cp.acts.iter().rposition(Doing::is_pass);
        let beside = matches!(self.origin, Origin::Opposite | Origin::Beside { .. }) && !self.plainly;
        beside && self.cp.state == ContactState::Moving && self.sv.state.stands() && stood.is_some() && stood < passed
    }
}
