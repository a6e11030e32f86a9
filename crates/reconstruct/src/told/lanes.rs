//! Questions to what is told of lanes: which it is, and who keeps its own.

use crate::told::crash::Told;
use crate::told::doing::Doing;
use crate::told::layout::strip_of;
use crate::told::side::{Turning, is_on_foot};
use recrash_model::account::{ContactState, LaneWord, LeftRight, Origin, PlaceKind};
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::StripKind;
use recrash_model::template::Movement;

impl Told {
    /// Whether the partner drives along lanes until it touches, or leaves them: none of who walks, stands from the start, or comes out of
    /// what is beside them.
    pub(crate) fn comes_along_lanes(&self) -> bool {
        let along = matches!(
            self.origin,
            Origin::Behind | Origin::Ahead | Origin::Beside { .. } | Origin::Opposite | Origin::Cross { .. }
        );
        let along = along || self.rolls_out();
        let drives = !is_on_foot(self.cp.kind) && !matches!(self.cp.kind, PartnerKind::FixedObject);
        let across = self.comes_across() || self.crosses_at_walk() || self.rides_along_kerb();
        along && drives && self.thing.is_none() && self.cp.state != ContactState::Parked && !across
    }

    /// Whether the partner is told to have gone aside before the contact: turned, changed lanes, drifted, passed, pulled out or parked.
    pub(crate) fn leaves_its_lane(&self) -> bool {
        let cp = &self.cp;
        let goes_on = cp.movement.is_none_or(|movement| {
            matches!(movement, Movement::Straight | Movement::Stopped | Movement::Backing | Movement::WrongWay)
        });
        !goes_on
            || cp.turning != Turning::No
            || cp.dodges
            || cp.slants.is_some()
            || cp.backs_in
            || self.comes_over
            || self.comes_along_kerb()
            || cp.acts.iter().any(Doing::is_aside)
    }

    /// Whether the ego is told to be about to turn left, of which no lane is told, and goes straight on until the contact, or stands.
    pub(crate) fn waits_to_turn_left(&self) -> bool {
        let street = matches!(self.place, PlaceKind::Street | PlaceKind::Intersection);
        let plain = self.sv.turning == Turning::No && !self.is_at_kerb() && self.sv_aside().is_none();
        self.layout.left_to_come && self.sv.lane.is_none() && street && plain
    }

    /// In which lane one of the two is told to be: who is about to turn left is in the one from which that is done.
    pub(crate) fn lane_word(&self, of_ego: bool) -> Option<LaneWord> {
        let side = if of_ego { &self.sv } else { &self.cp };
        let to_turn = || (of_ego && self.waits_to_turn_left()).then_some(LaneWord::LeftTurn);
        side.lane.filter(|_| !side.lane_to_come).or_else(to_turn)
    }

    /// Whether the partner is told to have driven where no lane of its direction is.
    pub(crate) fn drives_elsewhere(&self) -> bool {
        self.cp.movement == Some(Movement::WrongWay) || self.cp.lane == Some(LaneWord::Opposing)
    }

    /// Whether the partner comes towards the ego along a highway, on its own side: that is not divided.
    pub(crate) fn is_met_on_highway(&self) -> bool {
        self.origin == Origin::Opposite && self.cp.movement != Some(Movement::WrongWay) && self.thing.is_none()
    }

    /// Whether an oncoming partner comes along the ego's side of the road, and drifts there.
    pub(crate) fn drifts_on_wrong_way(&self) -> bool {
        let there = self.origin == Origin::Opposite && self.cp.movement == Some(Movement::WrongWay) && !self.comes_over;
        there && self.cp.acts.iter().any(Doing::goes_aside)
    }

    /// Whether an oncoming partner is told to have gone straight by the ego, and not to have come over.
    pub(crate) fn comes_straight_by(&self) -> bool {
        let aside = |doing: &Doing| doing.is_aside() && !doing.is_pass();
        self.is_passed_by_oncoming() && !self.comes_over && !self.cp.dodges && !self.cp.acts.iter().any(aside)
    }

    /// Whether the partner comes by in a lane of its own: it has not to come out of the ego's for that, nor round who stands in it.
    pub(crate) fn has_own_lane(&self) -> bool {
        let beside = match self.origin {
            Origin::Beside { .. } => true,
            Origin::Behind => self.comes_along_kerb() || self.cp.movement == Some(Movement::Passing),
            Origin::Opposite => self.comes_straight_by(),
            _ => false,
        };
        beside && self.cp.turning == Turning::No && (!self.passes_from_behind() || self.comes_along_kerb())
    }

    /// The driving lane that one of the two is told to be in, of so many; 0 is the leftmost.
    pub(crate) fn lane_number(&self, of_ego: bool, lanes: usize) -> Option<usize> {
        match if of_ego { self.sv.lane? } else { self.cp.lane? } {
            LaneWord::Center if let Some(counted) = self.counted(of_ego) => counted.place(lanes),
            // In a lot there may be one lane.
            LaneWord::Left if of_ego && self.layout.turn_lane => Some(1.min(lanes - 1)),
            LaneWord::Right if self.layout.right_lane => lanes.checked_sub(2),
            LaneWord::Left | LaneWord::LeftTurn => Some(0),
            LaneWord::Right | LaneWord::RightTurn => Some(lanes - 1),
            // Along the kerb.
            LaneWord::Bus if !of_ego && self.origin == Origin::Opposite => Some(lanes - 1),
            LaneWord::Center => Some(lanes / 2),
            _ => None,
        }
    }

    /// Whether both are side by side in lanes for the same turn.
    pub(crate) fn turns_abreast(&self) -> bool {
        let beside = matches!(self.origin, Origin::Beside { .. });
        beside && self.sv.lane == self.cp.lane && matches!(self.sv.lane, Some(LaneWord::LeftTurn | LaneWord::RightTurn))
    }

    /// Whether the partner is told to go straight on behind an ego that turns, or to pass it on the side to which it turns.
    pub(crate) fn goes_straight_behind(&self) -> bool {
        let inside = match self.sv.turning {
            Turning::Left => LeftRight::Left,
            Turning::Right => LeftRight::Right,
            Turning::No | Turning::Round => return false,
        };
        let passes = self.cp.movement == Some(Movement::Passing) && self.touched_side() == Some(inside);
        self.origin == Origin::Behind
            && (passes || self.cp.movement == Some(Movement::Straight))
            && !self.sv.state.stands()
            && !self.sv.turned
    }

    /// Whether the partner is beside an ego that turns, and is not told to turn with it.
    pub(crate) fn goes_straight_beside(&self) -> bool {
        let turns = matches!(self.sv.turning, Turning::Left | Turning::Right) && !self.sv.turned;
        let straight = self.cp.turning == Turning::No && !self.cp.turns_later;
        turns && straight && matches!(self.origin, Origin::Beside { .. }) && self.comes_along_lanes()
    }

    /// The strip that the partner is told to be in, else the ego.
    pub(crate) fn strip(&self) -> Option<StripKind> {
        [self.cp.lane, self.sv.lane].into_iter().flatten().find_map(strip_of)
    }

    /// What lies beside the lanes, from them outwards, where else the usual strips lie there. A shoulder lies where others park.
    pub(crate) fn beside_lanes(&self, usual: &[StripKind]) -> Vec<StripKind> {
        let strip = self.strip().filter(|strip| !usual.contains(strip));
        let stays = |kind: &&StripKind| !(strip == Some(StripKind::Shoulder) && **kind == StripKind::Parking);
        strip.into_iter().chain(usual.iter().filter(stays).copied()).collect()
    }

    /// Whether the partner is told to have come along a strip beside the driving lanes, on the side where it is drawn.
    pub(crate) fn comes_along_strip(&self) -> Option<StripKind> {
        let strip = self.cp.lane.and_then(strip_of)?;
        let left = matches!(self.origin, Origin::Beside { side: LeftRight::Left });
        let along = matches!(self.origin, Origin::Behind | Origin::Ahead | Origin::Beside { .. } | Origin::Opposite);
        (along && !left).then_some(strip)
    }
}
