//! The road for what is told: a street, a lot, a highway or a junction.

use crate::ground::junction::junction;
use crate::ground::lanes::{has, is_one_way, lanes_for, told_lane, usual_lane};
use crate::ground::pieces::{APPROACH_M, behind_median, straight, strips, strips_of};
use crate::ground::way::{Across, Ground, with_way};
use crate::told::crash::Told;
use crate::told::lies::Lies;
use crate::told::others::Role;
use crate::told::side::{Turning, size_of};
use crate::usual::LANE_M;
use recrash_model::account::{ContactState, LeftRight, Origin, PlaceKind};
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{GraphMap, RoadStart, Strip, StripKind};
use recrash_model::template::Movement;

/// The road for an account.
pub(crate) fn ground_for(told: &Told) -> Ground {
    let turns = |turning: Turning| matches!(turning, Turning::Left | Turning::Right);
    let crosses = matches!(told.origin, Origin::Cross { .. });
    let crossing = crosses && !told.crosses_street() && !told.backs_across()
        || turns(told.sv.turning)
        || told.cp.turning != Turning::No
            && !told.turns_round_in_street()
            && (!told.comes_off_drive() || told.crossed_near);
    // Aisles cross where somebody turns.
    let lot = told.place.is_off_street()
        && !turns(told.sv.turning)
        && !(turns(told.cp.turning) && crosses && told.comes_along_lanes());
    if (crossing || told.is_at_crossing()) && !lot || told.place == PlaceKind::Intersection {
        let ground = junction(told, crossing);
        let behind_m = told.behind_entry_m();
        let at_entry = turns(told.sv.turning) && !behind_m.is_empty();
        return if at_entry { ground.at_entry(size_of(&told.sv).0, behind_m) } else { ground };
    }
    street(told, lot)
}

/// A road that no other one crosses.
fn street(told: &Told, lot: bool) -> Ground {
    let highway = told.place == PlaceKind::Highway;
    let one_way = is_one_way(told);
    let one_sided = one_way || told.keeps_one_way() || told.edge == Some(LeftRight::Left) && !told.edge_is_median();
    let oncoming = if one_sided || highway && !told.is_met_on_highway() { 0 } else { 1 };
    let narrow = told.layout.narrow && told.edge.is_none() && !highway;
    let lane_m = if narrow { NARROW_LANE_M } else { LANE_M };
    let (right, left) = sides(told, lot, (oncoming, lane_m));
    let lanes = right.iter().filter(|strip| strip.kind == StripKind::Driving).count();
    let beside = right.iter().map(|strip| strip.kind).filter(|kind| *kind != StripKind::Driving).collect();
    let lane = told_lane(told, lanes).unwrap_or(usual_lane(told, lanes, one_way));
    let start = RoadStart::At { x_m: -APPROACH_M, y_m: (lane as f64 + 0.5) * lane_m, heading_deg: 0.0 };
    let map = GraphMap {
        roads: vec![straight("main", start, 2.0 * APPROACH_M, right, left)],
        junctions: Vec::new(),
        areas: Vec::new(),
    };
    let across = Across { lanes, lane, oncoming, beside, cross_lanes: lanes, lane_m };
    let ground = with_way(map, vec!["main+".to_owned()], across, vec![APPROACH_M], false);
    let at_kerb = (told.is_at_kerb() || told.sets_off_at_kerb()) && !lot && !highway && !one_way;
    let ground = if at_kerb { ground.at_kerb() } else { ground };
    ground.over_line(told)
}

/// Strips of such a road on the right and on the left, with so many lanes on the left, and so wide ones. [1, m]
fn sides(told: &Told, lot: bool, (oncoming, lane_m): (usize, f64)) -> (Vec<Strip>, Vec<Strip>) {
    match told.place {
        _ if let Some(side) = told.edge => beside_edge(told, side, lot, oncoming),
        PlaceKind::Highway => {
            let beside = told.beside_lanes(&[StripKind::Shoulder]);
            (strips(lanes_for(told, 3), &beside), if oncoming == 0 { Vec::new() } else { strips(oncoming, &beside) })
        }
        _ if lot => {
            let beside = [told.beside_aisle()];
            (strips_of(lane_m, lanes_for(told, 1), &beside), strips_of(lane_m, oncoming, &beside))
        }
        _ => {
            let stalls = matches!(told.origin, Origin::Stall { .. });
            let usual = [if stalls { StripKind::Stalls } else { StripKind::Parking }, StripKind::Sidewalk];
            let beside = told.beside_lanes(&usual);
            (strips_of(lane_m, lanes_for(told, 2), &beside), strips_of(lane_m, oncoming, &beside))
        }
    }
}

/// From where the road begins that the ego turns into to the ego's front, where it meets what stands at the edge of that road, or across
/// it. [m]
const BEHIND_ENTRY_M: [f64; 3] = [3.0, 5.0, 8.0];

/// How wide a lane of a narrow street is. [m]
const NARROW_LANE_M: f64 = 2.7;

/// Strips of a road at whose edge something stands.
fn beside_edge(told: &Told, side: LeftRight, lot: bool, oncoming: usize) -> (Vec<Strip>, Vec<Strip>) {
    let usual: &[StripKind] = match told.place {
        PlaceKind::Highway => &[StripKind::Shoulder],
        PlaceKind::Alley => &[],
        _ if lot => &[StripKind::Stalls],
        _ => &[StripKind::Parking, StripKind::Sidewalk],
    };
    let edge = told.beside_edge();
    let lanes = if lot { 1 } else { lanes_for(told, if told.place == PlaceKind::Highway { 3 } else { 2 }) };
    match side {
        LeftRight::Right => {
            let opposite: &[StripKind] = if told.place == PlaceKind::Highway { &[] } else { usual };
            (strips(lanes, &edge), strips(oncoming, opposite))
        }
        LeftRight::Left if told.edge_is_median() => (strips(lanes, usual), behind_median(strips(oncoming, usual))),
        LeftRight::Left => (strips(lanes, usual), strips(0, &edge)),
    }
}

impl Told {
    /// Whether the two meet at a junction, or before one, whether or not anybody crosses it or turns.
    fn is_at_crossing(&self) -> bool {
        let highway = self.place == PlaceKind::Highway;
        let controlled = self.is_controlled() && !highway && !self.comes_off_drive();
        // Who gives way to crossing traffic, or keeps a junction clear, is at one.
        let at_one = [Role::Crosser, Role::Blocker, Role::Beyond].into_iter().any(|role| has(self, role));
        let gives_way = !highway && (at_one || self.crossed_near);
        let entered = !highway && (self.enters() || self.is_followed_in());
        let to_come = self.waits_to_turn_left() && matches!(self.origin, Origin::Behind | Origin::Opposite);
        controlled || gives_way || entered || self.stops_before_junction() || to_come
    }

    /// How far behind where the road begins that it turns into an ego meets what stands there, where it does. [m]
    fn behind_entry_m(&self) -> &'static [f64] {
        match (self.edge, self.lies) {
            (Some(_), _) => &BEHIND_ENTRY_M,
            (None, Some(Lies::Edge)) => &[0.0],
            // At the end of the space that it turned into, or across the entrance.
            _ if self.stands_across() || self.at_entrance => &BEHIND_ENTRY_M,
            _ => &[],
        }
    }

    /// Whether the partner turns round on a street along which both go, or out of its kerb: it needs no road that crosses.
    fn turns_round_in_street(&self) -> bool {
        let crosses = matches!(self.origin, Origin::Cross { .. } | Origin::Opposite);
        self.cp.turning == Turning::Round && self.place == PlaceKind::Street && !crosses
    }

    /// Whether the ego is told to stop, or to slow, at a junction, and meets one that goes its way.
    fn stops_before_junction(&self) -> bool {
        let along = matches!(self.origin, Origin::Behind | Origin::Ahead | Origin::Beside { .. });
        let stops = self.sv.state == ContactState::Stopped || self.sv.slowed_from.is_some();
        let plain = self.thing.is_none() && self.edge.is_none() && self.sv.turning == Turning::No && !self.is_at_kerb();
        self.layout.at_junction && self.place == PlaceKind::Street && along && stops && plain
    }

    /// What lies beside an aisle of a lot, or an alley: that has no stalls, but where somebody stands in one or comes out of it.
    fn beside_aisle(&self) -> StripKind {
        let stalls = matches!(self.origin, Origin::Stall { .. } | Origin::Parked { .. }) || self.layout.stalls;
        if self.place == PlaceKind::Alley && !stalls { StripKind::Shoulder } else { StripKind::Stalls }
    }

    /// Whether the partner crosses a street on foot, as an animal, or as a rider that does what walkers do, where no road crosses it; or a highway.
    fn crosses_street(&self) -> bool {
        let rides = matches!(self.cp.kind, PartnerKind::Cyclist | PartnerKind::OtherNonMotorist);
        let crosses = self.cp.movement == Some(Movement::NmCrossing);
        let walk = rides && (crosses || self.layout.crosswalk || self.layout.beside_crosswalk);
        let on_foot = matches!(self.cp.kind, PartnerKind::Pedestrian | PartnerKind::Animal);
        on_foot && self.place == PlaceKind::Highway || (on_foot || walk) && self.place == PlaceKind::Street
    }
}
