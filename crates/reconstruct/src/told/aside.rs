//! How the two leave the lines that they drive on.

use crate::told::crash::Told;
use crate::told::phase::Phase;
use crate::told::side::Turning;
use crate::told::zones::side_of;
use crate::usual::LANE_M;
use recrash_model::account::{Act, ContactState, LaneLine, LeftRight, Origin, Striker};
use recrash_model::template::Movement;

/// Who leaves its lane leaves it by so much, who comes from the kerb or goes there by so much, and who changes lanes has done so much
/// of it at the contact. [m]
const DEPARTS_M: f64 = 1.6;
const DEPARTS_A_LITTLE_M: f64 = 0.8;
const WITHIN_LANE_M: f64 = 0.65;
const STOPS_WITHIN_LANE_M: f64 = 1.1;
const KERB_M: f64 = 2.6;
const ROUNDS_M: f64 = 2.0;
const CHANGES_M: f64 = 2.2;

/// An ego that leaves the kerb, and touches one that is parked there, leaves it by so much. [m]
const LEAVES_KERB_M: f64 = 1.2;

/// Who leaves its line in two goes has done so much of that at the end of the first; who stands over the line between two lanes there. [-]
const FIRST_PART: f64 = 0.3;
const FIRST_PART_OVER: f64 = 0.4;

/// Who pulls out has left the kerb by so much. [m]
const PULLS_OUT_M: f64 = 1.5;

/// A move out of the line that somebody drives on, to the right of it. [m]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aside {
    pub(crate) from_t_m: f64,
    pub(crate) to_t_m: f64,
    /// It is over before the contact.
    pub(crate) done: bool,
    /// It had left the other line for this one before.
    pub(crate) back: bool,
}

impl Told {
    /// How the ego leaves its line.
    pub(crate) fn sv_aside(&self) -> Option<Aside> {
        let (left, right) = (LeftRight::Left, LeftRight::Right);
        let back = self.sv.phases.contains(&Phase::Reverses);
        let stopped = self.sv.stopped_aside.filter(|_| !back && !self.sv.came_to_park && !self.is_at_kerb());
        let stands = self.sv.state.stands() && stopped.is_none();
        if self.sv.turning != Turning::No || stands || self.sv.state == ContactState::Reversing {
            return None;
        }
        let movement = match stopped {
            Some(Act::LaneChange) => Movement::ChangingLanes,
            Some(Act::PullOut) => Movement::EnteringTraffic,
            Some(Act::PullOver | Act::Park) => Movement::ParkingManeuver,
            Some(_) => Movement::LaneDeparture,
            None => self.sv.movement?,
        };
        let towards = self.sv_towards(stopped, movement);
        let by = |usual: LeftRight, way_m: f64| if towards.unwrap_or(usual) == left { -way_m } else { way_m };
        let (from_t_m, to_t_m) = match movement {
            // Who runs into one that is parked ahead of it has not come far.
            _ if self.leaves_kerb() => (KERB_M, if self.stands_beside(false) { KERB_M - LEAVES_KERB_M } else { 0.0 }),
            Movement::ChangingLanes | Movement::Merging => (0.0, by(left, LANE_M)),
            Movement::CrossingIntoOpposingLane => (0.0, -LANE_M),
            Movement::LaneDeparture => (0.0, by(right, self.sv_departs_m())),
            // From the kerb, or the one told.
            Movement::EnteringTraffic => {
                let from_left = self.sv.aside == Some(right) || self.leaves_left_kerb();
                (if from_left { -KERB_M } else { KERB_M }, 0.0)
            }
            Movement::ParkingManeuver => (0.0, by(right, KERB_M)),
            // It changed lanes on its way.
            Movement::Straight if self.sv.changed_lanes && self.sv.aside.is_some() => (0.0, by(left, LANE_M)),
            // Beside who stands at the edge of its lane.
            Movement::Passing if self.rounds_other() => (0.0, -ROUNDS_M),
            // It dodged, or drifted, while it drove on.
            Movement::Straight | Movement::Passing if self.sv.aside.is_some() => (0.0, by(left, self.sv_departs_m())),
            _ => return None,
        };
        let back = self.sv.returns && matches!(movement, Movement::ChangingLanes | Movement::Merging);
        let changed = movement == Movement::Straight && self.sv.changed_lanes;
        Some(Aside {
            from_t_m,
            to_t_m,
            done: (self.lane_changed || changed || self.sv.goes_round) && stopped.is_none(),
            back,
        })
    }

    /// To which side the ego leaves its line, by what it stopped for or how it moves, where that is told or follows from where the partner is.
    fn sv_towards(&self, stopped: Option<Act>, movement: Movement) -> Option<LeftRight> {
        let right = LeftRight::Right;
        // Who makes room for another before it stops does so away from it.
        let pulls_aside = matches!(stopped, Some(Act::PullOver | Act::Park)) && self.origin == Origin::Opposite;
        let makes_room =
            pulls_aside || matches!(stopped, Some(Act::Drift | Act::Swerve)) && self.striker == Some(Striker::Cp);
        // Who stopped on its way to another lane, and is passed by who was behind it, had gone away from that one's side.
        let passed = self.cp.passes_on().filter(|_| stopped == Some(Act::LaneChange) && self.origin == Origin::Behind);
        let towards = self.sv.aside.or(passed.map(LeftRight::other)).or(match self.origin {
            // For who has turned into the other direction it makes room at the kerb.
            Origin::Cross { .. } if makes_room && self.comes_against() => Some(right),
            Origin::Beside { side } | Origin::Cross { side } => Some(if makes_room { side.other() } else { side }),
            _ => None,
        });
        // Nobody parks, or makes room, in the way of who comes towards it.
        let pulls_over = movement == Movement::ParkingManeuver && self.origin == Origin::Opposite;
        let towards = towards.or(pulls_over.then_some(right));
        towards.or_else(|| side_of(&self.sv.zones).map(|side| if makes_room { side.other() } else { side }))
    }

    /// How far the ego leaves its line that drifts or dodges: no farther than its lane, where it is told to have stayed in that, or makes
    /// room in a narrow street. [m]
    fn sv_departs_m(&self) -> f64 {
        match self.squeezes_by() || self.sv.acts.iter().any(|doing| doing.within_lane) {
            // Where it stands it has done half of that.
            true if self.sv.state.stands() => STOPS_WITHIN_LANE_M,
            true => WITHIN_LANE_M,
            false => DEPARTS_M,
        }
    }

    /// How far to the right the ego goes before its last stand that leaves its line in two goes, with a stand between. [m]
    pub(crate) fn first_part_m(&self, aside: Aside) -> Option<f64> {
        let twice = self.sv.goes_aside_twice() && !self.sv.state.stands() && !aside.done && !aside.back;
        let part = if self.sv.is_over(LaneLine::Lanes) { FIRST_PART_OVER } else { FIRST_PART };
        twice.then_some(part * (aside.to_t_m - aside.from_t_m))
    }

    /// How far to the left of where it touches the partner came along, of who goes about the ego's way or against it. [m]
    pub(crate) fn cp_from_left_m(&self) -> Option<f64> {
        let against = match self.origin {
            Origin::Behind | Origin::Ahead | Origin::Beside { .. } => 1.0,
            Origin::Opposite => -1.0,
            Origin::Parked { .. } if self.cp.state != ContactState::Reversing => 1.0,
            _ => return None,
        };
        let way_m = match self.cp.movement? {
            // It has changed lanes, and comes straight on since.
            Movement::ChangingLanes | Movement::Merging if self.cp.changed_lanes => return None,
            Movement::ChangingLanes | Movement::Merging => CHANGES_M,
            Movement::CrossingIntoOpposingLane => CHANGES_M,
            // Into the lane of an ego that turns out of that it comes a little.
            Movement::LaneDeparture if self.goes_straight_beside() => DEPARTS_A_LITTLE_M,
            Movement::LaneDeparture => DEPARTS_M,
            Movement::EnteringTraffic | Movement::ParkingManeuver => PULLS_OUT_M,
            Movement::Straight if self.cp.aside.is_some() => DEPARTS_M,
            Movement::WrongWay if self.drifts_on_wrong_way() => DEPARTS_M,
            _ => return None,
        };
        // Who moves to its left came along on its right.
        let own_left = self.cp.aside.map(|side| -side.sign());
        let from_left = own_left.map(|own| own * against).or_else(|| match self.origin {
            // Who parks does so on the right; who came along behind the ego leaves its lane.
            _ if self.cp.movement == Some(Movement::ParkingManeuver) => Some(against),
            Origin::Behind if self.cp.merges_in => side_of(&self.sv.zones).map(LeftRight::sign),
            Origin::Behind => side_of(&self.sv.zones).map(|side| -side.sign()),
            Origin::Beside { side } | Origin::Parked { side: Some(side) } => Some(side.sign()),
            _ => side_of(&self.sv.zones).map(LeftRight::sign),
        });
        Some(from_left.unwrap_or(if against > 0.0 { -1.0 } else { 1.0 }) * way_m)
    }

    /// Whether the partner changes lanes behind the ego, and nobody tells to which side, nor that it was right behind it: that leaves its lane.
    pub(crate) fn may_come_from_either(&self) -> bool {
        let changes = matches!(self.cp.movement, Some(Movement::ChangingLanes | Movement::Merging));
        self.origin == Origin::Behind && changes && self.cp.aside.is_none() && !self.layout.right_behind
    }

    /// Whether the partner turns out of a crossing road into the ego's, against the ego's way.
    fn comes_against(&self) -> bool {
        let turns = match self.cp.turning {
            Turning::Left => LeftRight::Left,
            Turning::Right => LeftRight::Right,
            Turning::No | Turning::Round => return false,
        };
        self.origin == Origin::Cross { side: turns.other() }
    }
}
