//! A junction of four arms, and where on it the ego may be at the contact.

use crate::ground::arms::{AHEAD, Arms, LEFT, OWN, RIGHT};
use crate::ground::lanes::{has, is_one_way, lanes_for, told_lane, usual_lane};
use crate::ground::pieces::{APPROACH_M, behind_median, corner_m, straight, strips};
use crate::ground::way::{Across, Ground, with_way};
use crate::told::crash::{AtRed, Told};
use crate::told::near::{Does, Near};
use crate::told::others::Role;
use crate::told::side::{Turning, size_of};
use crate::told::{queue, sizes};
use crate::usual::{LANE_M, LEAD_GAP_M, ROOM_M};
use recrash_model::account::{ContactState, LeftRight, Origin, PlaceKind, StandReason};
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{GraphMap, JunctionSpec, RoadSpec, RoadStart, StripKind};
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;

/// Places of who has yet to turn, from where the junction begins. [m]
const BEFORE_TURN_M: [f64; 3] = [-5.0, -2.0, -9.0];

impl Told {
    /// Whether a partner that goes the ego's way is told to have come into the junction, and the ego drives: both are in it.
    pub(super) fn is_followed_in(&self) -> bool {
        let along = matches!(self.origin, Origin::Behind | Origin::Ahead | Origin::Beside { .. });
        !self.plainly && along && self.cp.enters() && self.sv.state == ContactState::Moving
    }
}

/// From the stop line to the middle of an ego that stands in a queue: the first of it stands at the line; of several there are as many as are drawn. [m]
fn queue_m(told: &Told) -> Option<f64> {
    let lead = told.extras.iter().find(|extra| extra.role == Role::Lead)?;
    let kind = lead.kind.partner_kind().unwrap_or(PartnerKind::PassengerCar);
    let long_m = sizes::size_of(lead.kind).map_or(VehicleSpec::of(kind).length_m, |size| size.length_m);
    // "behind a van and a hatchback": another one of them is of another kind.
    let stands = |near: Near| near.place == Some(Origin::Ahead) && near.does == Does::Stands;
    let two = told.wanted.iter().any(|extra| extra.near.is_some_and(stands));
    let ahead = if lead.several {
        lead.number as f64
    } else if two {
        2.0
    } else {
        1.0
    };
    let aside_m = if told.sv_aside().is_some() { ROOM_M } else { 0.0 };
    let stands_m = 0.5 * size_of(&told.sv).0 + ahead * (LEAD_GAP_M + long_m) + aside_m + FIRST_AT_LINE_M;
    // Who has set off behind it has come nearer to the line.
    let came_m = 0.5 * told.sv.speed_mps * told.sv.speed_mps / CAME_MPS2;
    // Who slows for it has yet to come to its stand.
    let slows = told.sv.state == ContactState::Moving && told.sv.slowed_from.is_some();
    let yet_m = if slows { 0.5 * told.sv.speed_mps * told.sv.speed_mps / BRAKES_MPS2 } else { 0.0 };
    Some(if queue::sets_off(told) { stands_m - came_m } else { stands_m + yet_m })
}

/// Who is no longer than this has room between the ego and the stop line. [m]
const USUAL_M: f64 = 6.0;

/// Who stands at the kerb does so before a junction by so much. [m]
const KERB_BEFORE_M: f64 = 10.0;

/// The first of a queue stands so far before the line. [m]
const FIRST_AT_LINE_M: f64 = 0.6;

/// No ego that sets off behind it comes nearer to the line by more than with this. [m/s^2]
const CAME_MPS2: f64 = 2.0;

/// An ego that has yet to stop behind it brakes with this, once it is hit. [m/s^2]
const BRAKES_MPS2: f64 = 5.0;

/// Who stands first at a signal stands so far before its line, and sets off from there for so long, for so far at least and at most.
/// [m, s, m]
const AT_LINE_M: f64 = 0.5;
const SETS_OFF_S: f64 = 4.0;
const SETS_OFF_M: (f64, f64) = (0.6, 2.8);

/// From where a junction begins back to the middle of an ego that sets off from its line. [m]
fn over_line_m(told: &Told) -> f64 {
    let driven_m = (SETS_OFF_S * told.sv.speed_mps).clamp(SETS_OFF_M.0, SETS_OFF_M.1);
    0.5 * size_of(&told.sv).0 + AT_LINE_M - driven_m
}

/// Places of who goes straight on and is told to be in the junction, where nobody crosses it or turns. [m]
const INSIDE_M: [f64; 3] = [2.5, 7.0, 12.0];

/// The same of who is over its line at red by a little. [m]
const CREEPS_M: [f64; 2] = [0.4, 0.0];

/// The same of who has come through it, from where it ends. [m]
const BEYOND_M: [f64; 3] = [4.0, 10.0, 2.0];

/// Four arms; the ego comes along the one that lies behind it.
pub(super) fn junction(told: &Told, crossing: bool) -> Ground {
    let aisles = matches!(told.place, PlaceKind::ParkingLot | PlaceKind::Garage) && told.layout.off_street.is_none();
    let arms = Arms::of(told, lanes_for(told, if aisles { 1 } else { 2 }));
    let (lanes, cross_lanes) = (arms.lanes, arms.cross_lanes);
    let corner_m = corner_m(lanes);
    let exits_by = match told.sv.turning {
        Turning::Left => LEFT,
        Turning::Right => RIGHT,
        Turning::No | Turning::Round => OWN,
    };
    let one_way = is_one_way(told);
    let at_kerb =
        (told.is_at_kerb() || told.sets_off_at_kerb()) && !crossing && told.sv.turning == Turning::No && !one_way;
    let parks = at_kerb
        || told.stands_beside(false)
        || has(told, Role::Kerb)
        || told.extras.iter().any(|extra| extra.between)
        || told.crossed_near && told.cp.state == ContactState::Parked
        || told.leaves_space();
    // Stalls leave no room for more between the arms.
    let stalls = matches!(told.origin, Origin::Stall { .. }) && told.strip().is_none();
    let usual: &[StripKind] = match parks {
        _ if aisles || parks && stalls => &[StripKind::Stalls],
        true => &[StripKind::Parking, StripKind::Sidewalk],
        false => &[StripKind::Sidewalk],
    };
    // Of the partner's road, on both sides of the junction.
    let beside = told.beside_lanes(usual);
    let crosses = matches!(told.origin, Origin::Cross { .. });
    let along = if crosses { [LEFT, RIGHT] } else { [OWN, AHEAD] };
    let usual_strips = |id: &str| if along.contains(&id) { beside.as_slice() } else { usual };
    // Nobody comes towards an ego that has others parked on its left.
    let alone = one_way && told.sv.turning == Turning::No && !has(told, Role::Oncoming);
    // Nor along a one-way street; with who crosses, or a thing, another way may be meant.
    let told_so = told.keeps_one_way() && told.edge.is_none() && told.thing.is_none() && !crosses;
    let one_sided = alone || told_so;
    let arm = |id: &str, bearing_deg: f64, length_m: f64| {
        let start = RoadStart::Arm { junction: "j".to_owned(), bearing_deg, from_m: corner_m };
        let off_street = arms.off_street == Some(id);
        let lanes = match id {
            _ if off_street => 1,
            OWN | AHEAD => lanes,
            _ => arms.street,
        };
        let usual = || strips(lanes, if off_street { &[] } else { usual_strips(id) });
        let (away, towards) = match told.edge.filter(|_| id == exits_by) {
            Some(LeftRight::Right) if id == OWN => (usual(), strips(lanes, &told.beside_edge())),
            Some(LeftRight::Left) if id == OWN => (behind_median(usual()), usual()),
            Some(LeftRight::Right) => (strips(lanes, &told.beside_edge()), usual()),
            Some(LeftRight::Left) => (usual(), behind_median(usual())),
            None if one_sided && id == OWN => (strips(0, usual_strips(id)), usual()),
            None if one_sided && id == AHEAD => (usual(), strips(0, usual_strips(id))),
            None => (usual(), usual()),
        };
        straight(id, start, length_m, away, towards)
    };
    let (exit, lane) = match told.sv.turning {
        Turning::Left => (LEFT, told_lane(told, lanes).unwrap_or(usize::from(told.lets_by_on_left()).min(lanes - 1))),
        Turning::Right => (RIGHT, told_lane(told, lanes).unwrap_or(lanes - 1)),
        Turning::No | Turning::Round => {
            let usual = if at_kerb { lanes - 1 } else { usual_lane(told, lanes, one_way) };
            (AHEAD, told_lane(told, lanes).unwrap_or(usual))
        }
    };
    // The ego's lane lies on the x axis, or beside it.
    let centre_y = (lanes as f64 - 0.5) * LANE_M;
    let [own, ahead] = [arm(OWN, 180.0, APPROACH_M), arm(AHEAD, 0.0, APPROACH_M)];
    let sides = [arm(LEFT, 90.0, APPROACH_M), arm(RIGHT, 270.0, APPROACH_M)];
    // The first road of a map has lanes in its own direction.
    let along = if one_sided { [ahead, own] } else { [own, ahead] };
    let roads = along.into_iter().chain(sides).filter(|road| arms.missing != Some(road.id.as_str()));
    // Into one of which nobody is told to come.
    let exit_name = if arms.off_street == Some(exit) && !crosses { "driveway" } else { exit };
    let named = |road: RoadSpec| RoadSpec { id: if road.id == exit { exit_name.to_owned() } else { road.id }, ..road };
    let map = GraphMap {
        roads: roads.map(named).collect(),
        junctions: vec![JunctionSpec {
            id: "j".to_owned(),
            x_m: 0.0,
            y_m: centre_y,
            ends: Vec::new(),
            u_turns: Vec::new(),
        }],
        areas: Vec::new(),
    };
    let inside = |list: &[f64]| list.iter().map(|share| APPROACH_M + share).collect::<Vec<f64>>();
    let queue_m = queue_m(told);
    let at_line: Vec<f64> = match told.sv.state {
        _ if told.enters() => Vec::new(),
        ContactState::Stopped if told.stops_at_line() => match queue_m {
            // At the line, before the crosswalk.
            None if told.crosses_at_walk() => vec![-0.5 * size_of(&told.sv).0 - AT_LINE_M, -5.0, -8.0],
            Some(queue_m) => vec![-queue_m, -queue_m - 2.0],
            None => vec![-5.0, -8.0],
        },
        ContactState::SettingOff if told.sv.control.is_some() => vec![3.0, 1.0, 5.0, -3.0],
        _ => Vec::new(),
    };
    let places = if crossing || told.sv.turning != Turning::No {
        let mut all = inside(&at_line);
        let waits = told.sv.state == ContactState::Stopped && told.origin == Origin::Behind;
        if told.sv.turns_later {
            all.extend(inside(&BEFORE_TURN_M));
        }
        all.extend(if told.turns_as_ego() {
            // Farther in it, who follows has begun it too.
            inside(if waits {
                &[9.0, 8.0, 6.0, 10.0, 14.0, 3.0, 18.0, 22.0, 28.0]
            } else {
                &[14.0, 10.0, 6.0, 18.0, 3.0, 22.0, 28.0]
            })
        } else if waits && told.sv.turning == Turning::Right {
            // It has begun to turn.
            inside(&[6.0, 10.0, 14.0, 3.0, 18.0, 22.0, 28.0])
        } else if told.goes_straight_behind() {
            // A turn to the right is over sooner.
            let right: &[f64] = if told.sv.turning == Turning::Right { &[6.0, 5.0, 7.0] } else { &[] };
            inside(&[right, &[8.0, 9.0, 10.0, 14.0, 18.0, 22.0]].concat())
        } else if told.goes_straight_beside() {
            // Where it has begun to turn, and has not come to the partner's lane; a turn to the right is over sooner.
            let right: &[f64] = if told.sv.turning == Turning::Right { &[6.0, 5.0, 7.0, 4.0, 8.0] } else { &[] };
            inside(&[right, &[12.0, 11.0, 13.0, 10.0, 14.0, 6.0, 18.0, 3.0, 22.0, 28.0]].concat())
        } else if told.turns_into_own_road() {
            inside(&[26.0, 30.0, 22.0, 12.0, 8.0, 16.0, 5.0, 20.0])
        } else if told.sv.turning != Turning::No {
            inside(&[10.0, 14.0, 6.0, 18.0, 3.0, 22.0, 28.0])
        } else {
            inside(&[12.0, 8.0, 16.0, 5.0, 20.0])
        });
        all
    } else {
        // At the line, or behind who stands there.
        let behind = has(told, Role::Lead) || told.origin == Origin::Ahead && told.thing.is_none();
        // What is long stands before the line too.
        let longer_m = if told.origin == Origin::Ahead { (size_of(&told.cp).0 - USUAL_M).max(0.0) } else { 0.0 };
        let both = has(told, Role::Lead) && told.origin == Origin::Ahead;
        let before_m = match queue_m.filter(|_| !both) {
            Some(queue_m) => queue_m,
            None if behind => 13.0 + longer_m,
            None => 5.0,
        };
        let before_m = if at_kerb { KERB_BEFORE_M } else { before_m };
        match (told.enters() || told.is_followed_in()) && !at_kerb && told.edge.is_none() {
            true if told.sv.crossed => inside(&BEYOND_M.map(|beyond_m| 2.0 * corner_m + beyond_m)),
            // No farther than who does not run its red light.
            true if told.keeps_red() == Some(AtRed::Creeps) => inside(&CREEPS_M),
            true => inside(&INSIDE_M),
            // From its line.
            false if told.sets_off_first() && before_m < USUAL_M => vec![APPROACH_M - over_line_m(told)],
            false => vec![APPROACH_M - before_m - if both { 10.0 } else { 0.0 }],
        }
    };
    let beside = if crosses { usual.to_vec() } else { beside };
    let across = Across {
        lanes,
        lane,
        oncoming: if one_way || one_sided { 0 } else { lanes },
        beside,
        cross_lanes,
        lane_m: LANE_M,
    };
    let ground = with_way(map, vec!["own-".to_owned(), format!("{exit_name}+")], across, places, true);
    let ground = if at_line.is_empty() { ground.at_walk(told).in_their_lanes(told) } else { ground };
    let ground = if at_kerb { ground.at_kerb() } else { ground }.over_line(told);
    if told.sv.turned { ground.after_turn() } else { ground }
}

impl Told {
    /// Whether an ego that stands, and does not turn, stands before the junction: at a signal or a sign, or for somebody who walks across.
    fn stops_at_line(&self) -> bool {
        let walks = self.reasons.contains(&StandReason::Pedestrian) && has(self, Role::Walker);
        (self.sv.control.is_some() || walks) && self.sv.turning == Turning::No
    }

    /// Whether the partner runs into the rear of an ego that has begun its turn, and is told to make the same.
    fn turns_as_ego(&self) -> bool {
        let same = match self.sv.turning {
            Turning::Left => Movement::LeftTurn,
            Turning::Right => Movement::RightTurn,
            Turning::No | Turning::Round => return false,
        };
        self.origin == Origin::Behind && !self.sv.turns_later && self.cp.turns_later && self.cp.movement == Some(same)
    }

    /// Whether the partner turns out of a crossing road into the ego's, the ego's way.
    fn turns_into_own_road(&self) -> bool {
        let side = match self.cp.turning {
            Turning::Left => LeftRight::Left,
            Turning::Right => LeftRight::Right,
            Turning::No | Turning::Round => return false,
        };
        self.origin == Origin::Cross { side } && self.sv.turning == Turning::No && self.sv.state == ContactState::Moving
    }
}
