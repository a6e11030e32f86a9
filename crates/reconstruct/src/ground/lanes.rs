//! How many lanes the ego's road has, and which is the ego's.

use crate::told::crash::Told;
use crate::told::layout::strip_of;
use crate::told::near::{Does, Near};
use crate::told::others::{Extra, Role};
use crate::told::side::{Turning, size_of};
use crate::told::zones::side_of;
use crate::usual::{LANE_M, NARROW_M};
use recrash_model::account::{ContactState, KindGroup, LaneLine, LaneWord, LeftRight, Origin};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// Who is parked on the left, facing as the ego does, is so on a one-way street; not where it is told to face the other way, or somebody comes
/// towards the ego.
pub(super) fn is_one_way(told: &Told) -> bool {
    let drives = |near: Near| near.place == Some(Origin::Opposite) && near.does != Does::Stands;
    // From between those who wait in the lane towards it somebody comes out.
    let queues = |extra: &Extra| {
        let opposite = extra.opposite || extra.near.is_some_and(|near| near.place == Some(Origin::Opposite));
        extra.hides && opposite
    };
    let oncoming = |extra: &Extra| extra.role == Role::Oncoming || queues(extra) || extra.near.is_some_and(drives);
    let left = matches!(told.origin, Origin::Parked { side: Some(LeftRight::Left) });
    left && !told.faces && !told.wanted.iter().any(oncoming) || told.leaves_left_kerb()
}

/// Lanes in the ego's direction: as told, and at least as many as the told lanes need.
pub(super) fn lanes_for(told: &Told, usual: usize) -> usize {
    // Who comes by on the opposite side, or comes over from there, does so beside the only lane.
    let beside_opposite = told.cp.lane == Some(LaneWord::Opposing) || told.comes_over || told.is_passed_by_oncoming();
    let beside_opposite = beside_opposite || told.rounds_other();
    // Out of the kerb on the right somebody comes to an ego that is about to turn left from the only lane.
    let from_right = matches!(told.origin, Origin::Parked { side: Some(LeftRight::Right) });
    let beside_both = beside_opposite || from_right && told.waits_to_turn_left();
    let usual = if beside_both && told.sv.lane.is_none() { 1 } else { usual };
    // A street with driveways, or stalls, on both sides.
    let from_left = matches!(
        told.origin,
        Origin::Stall { side: Some(LeftRight::Left) } | Origin::Driveway { side: Some(LeftRight::Left) }
    );
    let comes_out = told.backs_out() || told.comes_off_drive() && told.cp.turning != Turning::No;
    let usual = if from_left && comes_out || told.layout.narrow { 1 } else { usual };
    // The lane by whose edge something stands is the only one of the road that the ego turns into.
    let turns = matches!(told.sv.turning, Turning::Left | Turning::Right);
    if told.edge.is_some() && turns && told.sv.lane.is_none() {
        return 1;
    }
    // A lane of a crossing road is none of a narrow street's.
    let crosses = told.layout.narrow && matches!(told.origin, Origin::Cross { .. });
    let words = [(told.sv.lane, true), (told.cp.lane.filter(|_| !crosses), false)];
    let needed = words.into_iter().map(|(word, of_ego)| match word {
        // A lane that is counted from one side is not the last on the other, but where as many are told.
        Some(LaneWord::Center) => match told.counted(of_ego) {
            Some(counted) => counted.number + usize::from(told.lanes.map(usize::from) != Some(counted.number)),
            None => 3,
        },
        Some(LaneWord::Left | LaneWord::Right | LaneWord::LeftTurn | LaneWord::RightTurn) => 2,
        _ => 1,
    });
    // Beside the ego on both sides.
    let between = told.is_beside_other(LeftRight::Left) && told.sv.lane.is_none() && passes_right(told);
    let usual = if between { usual.max(3) } else { usual };
    let more = usize::from(told.more_lanes) + usize::from(told.layout.turn_lane || told.layout.right_lane);
    let over = told.sv.is_over(LaneLine::Lanes) || told.cp.is_over(LaneLine::Lanes);
    let usual = if over { usual.max(2) } else { usual };
    let lanes = told.lanes.map_or(usual, usize::from).max(needed.max().unwrap_or(1)) + more;
    lanes.clamp(1, MOST_LANES)
}

/// No road has more lanes in one direction.
const MOST_LANES: usize = 5;

/// The ego's lane, where none is told: the rightmost, but for a partner that comes by on the right, or where the ego leaves it to the right.
pub(super) fn usual_lane(told: &Told, lanes: usize, one_way: bool) -> usize {
    let to_right = told.sv_aside().is_some_and(|aside| aside.to_t_m >= LANE_M);
    match lanes {
        _ if one_way => 0,
        _ if told.sv.is_over(LaneLine::Centre) || told.cp.is_over(LaneLine::Centre) => 0,
        _ if told.edge == Some(LeftRight::Left) || told.layout.left_to_come || told.is_met_over_line() => 0,
        2.. if told.edge.is_none()
            && (to_right
                || passes_right(told)
                || told.is_beside_other(LeftRight::Right)
                || told.is_hidden_on_right()) =>
        {
            lanes - 2
        }
        _ => lanes - 1,
    }
}

/// The ego's lane, where it is told, 0 is the leftmost.
pub(super) fn told_lane(told: &Told, lanes: usize) -> Option<usize> {
    // Of two lanes that turn the ego's is the other one.
    if told.turns_abreast() {
        match (told.sv.lane, told.origin) {
            (Some(LaneWord::LeftTurn), Origin::Beside { side: LeftRight::Left }) if lanes > 1 => return Some(1),
            (Some(LaneWord::RightTurn), Origin::Beside { side: LeftRight::Right }) => return lanes.checked_sub(2),
            _ => {}
        }
    }
    if told.sv.lane.is_some() {
        let number = told.lane_number(true, lanes);
        // Who goes out of the told lane and comes back to it has its line beside it.
        let back = told.sv_aside().filter(|aside| aside.back);
        return match back.map(|aside| aside.to_t_m > aside.from_t_m) {
            Some(true) => number?.checked_sub(1),
            Some(false) => number.map(|lane| lane + 1).filter(|lane| *lane < lanes),
            None => number,
        };
    }
    // The partner's lane tells the ego's, where the two go one way; of who changes into it that beside it.
    let other = told.lane_number(false, lanes)?;
    let left_m = told.sv_aside().map_or(0.0, |aside| aside.from_t_m - aside.to_t_m);
    match told.origin {
        Origin::Behind | Origin::Ahead if left_m >= LANE_M => (other + 1 < lanes).then_some(other + 1),
        Origin::Behind | Origin::Ahead if left_m <= -LANE_M => other.checked_sub(1),
        Origin::Behind | Origin::Ahead => Some(other),
        Origin::Beside { side: LeftRight::Left } => (other + 1 < lanes).then_some(other + 1),
        Origin::Beside { side: LeftRight::Right } => other.checked_sub(1),
        _ => None,
    }
}

/// Whether somebody with this part is drawn.
pub(super) fn has(told: &Told, role: Role) -> bool {
    told.extras.iter().any(|extra| extra.role == role)
}

fn passes_right(told: &Told) -> bool {
    let in_lane = told.cp.lane.and_then(strip_of).is_none();
    // Who stands beside the lanes does so beside the outermost.
    let in_lane = in_lane && !told.stands_beside(false) && told.thing.is_none();
    let touched = |zone: &ContactZone| matches!(zone, ContactZone::Right | ContactZone::FrontRight);
    let moves = told.cp.state == ContactState::Moving;
    let passes = told.cp.movement == Some(Movement::Passing) && side_of(&told.sv.zones) == Some(LeftRight::Right)
        || told.cp.passes_on() == Some(LeftRight::Right);
    let goes = matches!(told.cp.movement, Some(Movement::ChangingLanes | Movement::Merging | Movement::Passing));
    let goes = goes && moves && told.cp.aside == Some(LeftRight::Right) && !told.is_at_kerb();
    let by = moves && told.sv.zones.iter().any(touched) || passes || goes;
    // Who comes across on foot needs no lane there, nor who is narrow, and comes by between the ego and the kerb.
    let between = told.wanted.iter().any(|extra| extra.between);
    let squeezes = told.layout.along_kerb && size_of(&told.cp).1 < NARROW_M && !between;
    let drives = !told.comes_across() && !squeezes;
    in_lane && drives && matches!(told.origin, Origin::Beside { side: LeftRight::Right })
        || in_lane && !squeezes && told.origin == Origin::Behind && by
}

impl Told {
    /// Whether another vehicle passes the ego on its left: in a lane that leads its way.
    pub(super) fn lets_by_on_left(&self) -> bool {
        let left = Some(Origin::Beside { side: LeftRight::Left });
        self.wanted.iter().filter_map(|extra| extra.near).any(|near| near.does == Does::Passes && near.place == left)
    }

    /// Whether the street is told to be one-way, and nobody of the story is told to be on its other side.
    pub(super) fn keeps_one_way(&self) -> bool {
        let lanes = [self.sv.lane, self.cp.lane];
        // Who goes the wrong way does so along it.
        let against = self.cp.movement == Some(Movement::WrongWay);
        let opposing = self.origin == Origin::Opposite && !against || lanes.contains(&Some(LaneWord::Opposing));
        let over = [self.sv.movement, self.cp.movement].contains(&Some(Movement::CrossingIntoOpposingLane));
        self.layout.one_way && !opposing && !over && !has(self, Role::Oncoming)
    }

    /// Whether one that stands hides a partner that comes from the right: in the next lane.
    fn is_hidden_on_right(&self) -> bool {
        let right = self.comes_from_side() == Some(LeftRight::Right) && self.sv.turning == Turning::No;
        right && self.wanted.iter().any(|extra| extra.role == Role::Screen)
    }

    /// Whether another vehicle drives in the lane beside an ego that keeps its own, or comes over from there.
    fn is_beside_other(&self, side: LeftRight) -> bool {
        let along = matches!(self.origin, Origin::Behind | Origin::Ahead | Origin::Beside { .. });
        let beside = |extra: &Extra| match (extra.role, extra.near) {
            (Role::Merger | Role::Abreast, _) => extra.side == Some(side),
            (_, Some(near)) => near.place == Some(Origin::Beside { side }) && near.does.is_in_lane(),
            _ => false,
        };
        let drives = |extra: &Extra| {
            matches!(extra.kind.group(), KindGroup::Car | KindGroup::Truck) && !extra.parked && beside(extra)
        };
        let plain = self.edge.is_none() && !self.is_at_kerb() && self.sv.turning == Turning::No;
        along && plain && self.sv_aside().is_none() && self.wanted.iter().any(drives)
    }

    /// Whether the partner comes over the line between the directions to the ego's left, which is then in the lane beside that: from the
    /// opposite direction, out of a turn against the ego's way, or by the opposite side past it.
    fn is_met_over_line(&self) -> bool {
        let left = side_of(&self.sv.zones) == Some(LeftRight::Left);
        let against = matches!(
            (self.origin, self.cp.turning),
            (Origin::Opposite, Turning::No)
                | (Origin::Cross { side: LeftRight::Left }, Turning::Right)
                | (Origin::Cross { side: LeftRight::Right }, Turning::Left)
        );
        let passes = self.cp.movement == Some(Movement::Passing) && self.layout.centre_line;
        let over = self.cp.movement == Some(Movement::CrossingIntoOpposingLane) || passes;
        let comes_by = over && matches!(self.origin, Origin::Behind | Origin::Beside { side: LeftRight::Left });
        let no_lane = self.sv.lane.is_none() && self.cp.lane.is_none();
        no_lane && left && self.sv.turning == Turning::No && self.edge.is_none() && (against || comes_by)
    }
}
