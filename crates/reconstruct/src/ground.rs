//! The road around a crash: drawn from what is told of the place, with the ego's lane along the x axis.

use crate::extras;
use crate::layout::Counted;
use crate::others::{self, Role};
use crate::side::{self, Turning};
use crate::strips::strip_of;
use crate::things::Lies;
use crate::told::{Aside, Told};
use crate::touch::{side_of, size_of};
use recrash_model::account::{ContactState, ControlDevice, LaneWord, LeftRight, Origin, PlaceKind};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{GraphMap, JunctionSpec, LinePiece, MapSpec, RoadSpec, RoadStart, Strip, StripKind};
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;
use recrash_model::zones::ContactZone;
use recrash_roads::{LanePath, RoadNetwork};
use std::rc::Rc;
use std::sync::Arc;

/// Width of driving lanes. [m]
pub(crate) const LANE_M: f64 = 3.4;

/// Length of the ego's road before a junction, and of a street on each side of the contact. [m]
const APPROACH_M: f64 = 320.0;

/// Whose turn is over has turned by so much; places to try are so far behind that. [rad, m]
const TURNED_RAD: f64 = 1.3;
const AFTER_TURN_M: [f64; 4] = [0.0, 3.0, 6.0, 10.0];

/// Places of who has yet to turn, from where the junction begins. [m]
const BEFORE_TURN_M: [f64; 3] = [-5.0, -2.0, -9.0];

/// From a junction's centre to where its arms begin. [m]
const CORNER_M: f64 = 13.0;

/// A road and the ego's way on it. Hundreds of ways of touching are tried on one: they share what is large.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ground {
    pub(crate) map: Rc<GraphMap>,
    /// Its network: a scenario on it need not build it again.
    pub(crate) network: Arc<RoadNetwork>,
    /// Roads of the ego's way.
    pub(crate) route: Vec<String>,
    pub(crate) lane: u8,
    /// The ego's way; and how far to the right of it the ego drives, whose lane does not lead where it turns. [m]
    way: Rc<LanePath>,
    pub(crate) off_route_m: f64,
    /// Places along it to try. [m]
    places: Vec<f64>,
    /// Whether crossing roads are there.
    pub(crate) junction: bool,
    /// In one direction, and in the other.
    pub(crate) lanes: usize,
    pub(crate) oncoming: usize,
    /// From the ego's line to the middle of who is parked at the kerb on the left, and on the right. [m]
    pub(crate) kerbs_m: [f64; 2],
    /// From the ego's line to where it stands, to the right: it is parked at the kerb. [m]
    pub(crate) stands_m: f64,
    /// What lies beside the lanes of the partner's road, from them outwards.
    pub(crate) beside: Vec<StripKind>,
    /// From the ego's line to the outer edge of the lanes on the left, and on the right. [m]
    pub(crate) lane_edges_m: [f64; 2],
    /// From the ego's line to the middle of the nearest lane of those who come towards it. [m]
    pub(crate) opposing_m: f64,
    /// The drift that brings the ego to what stands at the edge of its road.
    pub(crate) drift: Option<Aside>,
}

impl Ground {
    pub(crate) fn places(&self) -> Vec<f64> {
        self.places.clone()
    }

    /// Length of the first road of the way. [m]
    pub(crate) fn first_m(&self) -> f64 {
        if self.junction { APPROACH_M } else { 2.0 * APPROACH_M }
    }

    /// How far along the ego's way a place is, and how far beside it. [m]
    pub(crate) fn beside(&self, place: Vec2) -> (f64, f64) {
        let found = self.way.project(place, 0);
        (found.s, found.t - self.off_route_m)
    }

    /// A pose along the ego's way, or beside it.
    pub(crate) fn pose(&self, s_m: f64, t_m: f64) -> Pose {
        self.way.pose(s_m, t_m + self.off_route_m)
    }

    /// Along the road where the ego's line is 0, of a street. [m]
    pub(crate) const fn begins_m(&self) -> f64 {
        APPROACH_M
    }

    /// The same, with the ego's front so far behind where the road begins that it turns into.
    fn at_entry(self, ego_m: f64, behind_m: &[f64]) -> Self {
        let centre_y_m = self.centre_y_m();
        let entry_m = (0..1000)
            .map(|step| APPROACH_M + 0.05 * f64::from(step))
            .find(|s_m| (self.sv_pose(*s_m).position.y - centre_y_m).abs() >= corner_m(self.lanes))
            .unwrap_or(APPROACH_M);
        Self { places: behind_m.iter().map(|behind_m| entry_m - 0.5 * ego_m + behind_m).collect(), ..self }
    }

    /// The same, with the places first at which the ego's turn is over.
    fn after_turn(mut self) -> Self {
        let turned = |s_m: &f64| self.sv_pose(*s_m).heading.abs() > TURNED_RAD;
        let over_m = (0..120).map(|step| APPROACH_M + 0.5 * f64::from(step)).find(turned);
        let places = over_m.iter().flat_map(|over_m| AFTER_TURN_M.map(|behind_m| over_m + behind_m));
        self.places = places.chain(self.places.iter().copied()).collect();
        self
    }

    /// The same, with an ego that drifts.
    pub(crate) fn drifting(&self, drift: Aside) -> Self {
        Self { drift: Some(drift), ..self.clone() }
    }

    /// The same, with an ego whose line is so far to the right of its lane's. [m]
    pub(crate) fn standing(&self, stands_m: f64) -> Self {
        Self { stands_m, ..self.clone() }
    }

    /// Where the middle of a junction is. [m]
    pub(crate) fn centre_y_m(&self) -> f64 {
        (self.lanes as f64 - 0.5) * LANE_M
    }

    /// Where the middle of the nearest lane of those is who come towards the ego. [m]
    pub(crate) fn opposing_y_m(&self) -> f64 {
        self.sv_pose(0.0).position.y + self.opposing_m
    }

    /// Where the middle of a told lane of those is who come towards the ego, else that of the nearest. [m]
    pub(crate) fn oncoming_y_m(&self, lane: Option<LaneWord>) -> f64 {
        let number = match lane {
            Some(LaneWord::Center) => self.oncoming / 2,
            Some(LaneWord::Right | LaneWord::RightTurn) => self.oncoming.saturating_sub(1),
            _ => 0,
        };
        self.opposing_y_m() + number as f64 * LANE_M
    }

    pub(crate) fn sv_pose(&self, s_m: f64) -> Pose {
        self.pose(s_m, 0.0)
    }
}

fn strips(driving: usize, beside: &[StripKind]) -> Vec<Strip> {
    let lane = Strip { width_m: Some(LANE_M), ..Strip::of(StripKind::Driving) };
    let mut list = vec![lane; driving];
    list.extend(beside.iter().map(|kind| Strip::of(*kind)));
    list
}

fn straight(id: &str, start: RoadStart, length_m: f64, right: Vec<Strip>, left: Vec<Strip>) -> RoadSpec {
    RoadSpec {
        id: id.to_owned(),
        start,
        line: vec![LinePiece::Straight { length_m }],
        right,
        left,
        speed_limit_mps: None,
        crosswalks: Vec::new(),
        driveways: Vec::new(),
    }
}

/// The road for an account.
pub(crate) fn ground_for(told: &Told) -> Ground {
    let crossing = matches!(told.origin, Origin::Cross { .. }) && !told.crosses_street()
        || told.sv.turning != Turning::No && told.sv.turning != Turning::Round
        || told.cp.turning != Turning::No;
    // Aisles cross where somebody turns.
    let lot = matches!(told.place, PlaceKind::ParkingLot | PlaceKind::Garage | PlaceKind::Driveway | PlaceKind::Alley)
        && !matches!(told.sv.turning, Turning::Left | Turning::Right);
    let controlled = told.is_controlled() && told.place != PlaceKind::Highway;
    // Who gives way to crossing traffic, or keeps a junction clear, is at one.
    let at_one = [Role::Crosser, Role::Blocker, Role::Beyond].into_iter().any(|role| has(told, role));
    let gives_way = told.place != PlaceKind::Highway && (at_one || told.crossed_near);
    let entered = told.place != PlaceKind::Highway && (told.enters() || told.is_followed_in());
    if (crossing || controlled || gives_way || entered) && !lot || told.place == PlaceKind::Intersection {
        let ground = junction(told, crossing);
        let behind_m: &[f64] = match (told.edge, told.lies) {
            (Some(_), _) => &BEHIND_ENTRY_M,
            (None, Some(Lies::Edge)) => &[0.0],
            // At the end of the space that it turned into, or across the entrance.
            _ if told.stands_across() || told.at_entrance => &BEHIND_ENTRY_M,
            _ => &[],
        };
        let turns = matches!(told.sv.turning, Turning::Left | Turning::Right);
        return if turns && !behind_m.is_empty() { ground.at_entry(size_of(&told.sv).0, behind_m) } else { ground };
    }
    let one_way = is_one_way(told);
    let one_sided = one_way || told.keeps_one_way() || told.edge == Some(LeftRight::Left) && !told.edge_is_median();
    let oncoming = if one_sided || told.place == PlaceKind::Highway { 0 } else { 1 };
    let (right, left) = match told.place {
        _ if let Some(side) = told.edge => beside_edge(told, side, lot, oncoming),
        PlaceKind::Highway => (strips(lanes_for(told, 3), &told.beside_lanes(&[StripKind::Shoulder])), Vec::new()),
        _ if lot => (strips(lanes_for(told, 1), &[StripKind::Stalls]), strips(oncoming, &[StripKind::Stalls])),
        _ => {
            let stalls = matches!(told.origin, Origin::Stall { .. });
            let usual = [if stalls { StripKind::Stalls } else { StripKind::Parking }, StripKind::Sidewalk];
            let beside = told.beside_lanes(&usual);
            (strips(lanes_for(told, 2), &beside), strips(oncoming, &beside))
        }
    };
    let lanes = right.iter().filter(|strip| strip.kind == StripKind::Driving).count();
    let beside = right.iter().map(|strip| strip.kind).filter(|kind| *kind != StripKind::Driving).collect();
    let usual = usual_lane(told, lanes, one_way);
    let lane = told_lane(told, lanes).unwrap_or(usual);
    let start = RoadStart::At { x_m: -APPROACH_M, y_m: (lane as f64 + 0.5) * LANE_M, heading_deg: 0.0 };
    let map = GraphMap {
        roads: vec![straight("main", start, 2.0 * APPROACH_M, right, left)],
        junctions: Vec::new(),
        areas: Vec::new(),
    };
    let across = Across { lanes, lane, oncoming, beside };
    let ground = with_way(map, vec!["main+".to_owned()], across, vec![APPROACH_M], false);
    let at_kerb = told.is_at_kerb() && !lot && told.place != PlaceKind::Highway && !one_way;
    let stands_m = if at_kerb { ground.kerbs_m[1] } else { 0.0 };
    Ground { stands_m, ..ground }
}

impl Told {
    /// Whether a partner that goes the ego's way is told to have come into the junction, and the ego drives: both are in it.
    fn is_followed_in(&self) -> bool {
        let along = matches!(self.origin, Origin::Behind | Origin::Ahead | Origin::Beside { .. });
        !self.plainly && along && self.cp.enters() && self.sv.state == ContactState::Moving
    }

    /// Which lane of its road one of the two is told to be in, counted from a side.
    pub(crate) fn counted(&self, of_ego: bool) -> Option<Counted> {
        if of_ego { self.layout.sv.counted } else { self.layout.cp.counted }
    }

    /// Whether the ego sets off at a signal with nobody ahead of it.
    pub(crate) fn sets_off_first(&self) -> bool {
        let at_signal = self.sv.control.is_some_and(|said| said.device == ControlDevice::Signal);
        // Who waits behind it sets the pace where it does.
        let waits = self.cp.stood_first || self.cp.state == ContactState::SettingOff || self.queued;
        let once = self.sv.phases.len() <= 3 && !waits && !self.plainly;
        self.sv.state == ContactState::SettingOff && at_signal && self.origin == Origin::Behind && once
    }

    /// Whether the partner comes over the line between the directions to the ego's left, which is then in the lane beside that: from the
    /// opposite direction, out of a turn against the ego's way, or by the opposite side past it.
    fn is_met_over_line(&self) -> bool {
        let left = side_of(&self.sv.zones) == Some(1.0);
        let against = matches!(
            (self.origin, self.cp.turning),
            (Origin::Opposite, Turning::No | Turning::Left)
                | (Origin::Cross { side: LeftRight::Left }, Turning::Right)
                | (Origin::Cross { side: LeftRight::Right }, Turning::Left)
        );
        let passes = self.cp.movement == Some(Movement::Passing) && self.layout.centre_line;
        let over = self.cp.movement == Some(Movement::CrossingIntoOpposingLane) || passes;
        let comes_by = over && matches!(self.origin, Origin::Behind | Origin::Beside { side: LeftRight::Left });
        let no_lane = self.sv.lane.is_none() && self.cp.lane.is_none();
        no_lane && left && self.sv.turning == Turning::No && self.edge.is_none() && (against || comes_by)
    }

    /// Whether the street is told to be one-way, and nobody of the story is told to be on its other side.
    fn keeps_one_way(&self) -> bool {
        let lanes = [self.sv.lane, self.cp.lane];
        let opposing = self.origin == Origin::Opposite || lanes.contains(&Some(LaneWord::Opposing));
        let over = [self.sv.movement, self.cp.movement].contains(&Some(Movement::CrossingIntoOpposingLane));
        self.layout.one_way && !opposing && !over && !has(self, Role::Oncoming)
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

    /// Whether the partner crosses a street on foot, or as an animal, where no road crosses it.
    fn crosses_street(&self) -> bool {
        matches!(self.cp.kind, PartnerKind::Pedestrian | PartnerKind::Animal) && self.place == PlaceKind::Street
    }
}

/// From where the road begins that the ego turns into to the ego's front, where it meets what stands at the edge of that road, or across
/// it. [m]
const BEHIND_ENTRY_M: [f64; 3] = [3.0, 5.0, 8.0];

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

/// The same, on the other side of a median.
fn behind_median(strips: Vec<Strip>) -> Vec<Strip> {
    [Strip::of(StripKind::Median)].into_iter().chain(strips).collect()
}

/// Who is parked on the left, facing as the ego does, is so on a one-way street.
fn is_one_way(told: &Told) -> bool {
    matches!(told.origin, Origin::Parked { side: Some(LeftRight::Left) })
}

/// Lanes in the ego's direction: as told, and at least as many as the told lanes need.
fn lanes_for(told: &Told, usual: usize) -> usize {
    // Who comes by on the opposite side, or comes over from there, does so beside the only lane.
    let beside_opposite = told.cp.lane == Some(LaneWord::Opposing) || told.comes_over || told.is_passed_by_oncoming();
    let usual = if beside_opposite && told.sv.lane.is_none() { 1 } else { usual };
    // A street with driveways, or stalls, on both sides.
    let from_left = matches!(
        told.origin,
        Origin::Stall { side: Some(LeftRight::Left) } | Origin::Driveway { side: Some(LeftRight::Left) }
    );
    let usual = if from_left && told.backs_out() || told.layout.narrow { 1 } else { usual };
    // The lane by whose edge something stands is the only one of the road that the ego turns into.
    let turns = matches!(told.sv.turning, Turning::Left | Turning::Right);
    if told.edge.is_some() && turns && told.sv.lane.is_none() {
        return 1;
    }
    let needed = [(told.sv.lane, true), (told.cp.lane, false)].into_iter().map(|(word, of_ego)| match word {
        // A lane that is counted from one side is not the last on the other, but where as many are told.
        Some(LaneWord::Center) => match told.counted(of_ego) {
            Some(counted) => counted.number + usize::from(told.lanes.map(usize::from) != Some(counted.number)),
            None => 3,
        },
        Some(LaneWord::Left | LaneWord::Right | LaneWord::LeftTurn | LaneWord::RightTurn) => 2,
        _ => 1,
    });
    let more = usize::from(told.more_lanes) + usize::from(told.layout.turn_lane);
    let lanes = told.lanes.map_or(usual, usize::from).max(needed.max().unwrap_or(1)) + more;
    lanes.clamp(1, MOST_LANES)
}

/// No road has more lanes in one direction.
const MOST_LANES: usize = 5;

impl Told {
    /// The driving lane that one of the two is told to be in, of so many; 0 is the leftmost.
    pub(crate) fn lane_number(&self, of_ego: bool, lanes: usize) -> Option<usize> {
        match if of_ego { self.sv.lane? } else { self.cp.lane? } {
            LaneWord::Center if let Some(counted) = self.counted(of_ego) => counted.place(lanes),
            // In a lot there may be one lane.
            LaneWord::Left if of_ego && self.layout.turn_lane => Some(1.min(lanes - 1)),
            LaneWord::Left | LaneWord::LeftTurn => Some(0),
            LaneWord::Right | LaneWord::RightTurn => Some(lanes - 1),
            LaneWord::Center => Some(lanes / 2),
            _ => None,
        }
    }
}

/// The ego's lane, where none is told: the rightmost, but for a partner that comes by on the right, or where the ego leaves it to the right.
fn usual_lane(told: &Told, lanes: usize, one_way: bool) -> usize {
    let to_right = told.sv_aside().is_some_and(|aside| aside.to_t_m >= LANE_M);
    match lanes {
        _ if one_way => 0,
        _ if told.edge == Some(LeftRight::Left) || told.layout.left_to_come || told.is_met_over_line() => 0,
        2.. if told.edge.is_none() && (to_right || passes_right(told)) => lanes - 2,
        _ => lanes - 1,
    }
}

/// The ego's lane, where it is told, 0 is the leftmost.
fn told_lane(told: &Told, lanes: usize) -> Option<usize> {
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

/// From the stop line to the middle of an ego that stands in a queue: the first of it stands at the line; of several there are two. [m]
fn queue_m(told: &Told) -> Option<f64> {
    let lead = told.extras.iter().find(|extra| extra.role == Role::Lead)?;
    let kind = lead.kind.partner_kind().unwrap_or(PartnerKind::PassengerCar);
    let long_m = side::size_of(lead.kind).map_or(VehicleSpec::of(kind).length_m, |size| size.length_m);
    let ahead = if lead.several { 2.0 } else { 1.0 };
    let aside_m = if told.sv_aside().is_some() { extras::ROOM_M } else { 0.0 };
    let stands_m = 0.5 * size_of(&told.sv).0 + ahead * (extras::LEAD_GAP_M + long_m) + aside_m + FIRST_AT_LINE_M;
    // Who has set off behind it has come nearer to the line.
    let came_m = 0.5 * told.sv.speed_mps * told.sv.speed_mps / SETS_OFF_MPS2;
    Some(if others::sets_off(told) { stands_m - came_m } else { stands_m })
}

/// Whether somebody with this part is drawn.
fn has(told: &Told, role: Role) -> bool {
    told.extras.iter().any(|extra| extra.role == role)
}

fn passes_right(told: &Told) -> bool {
    let in_lane = told.cp.lane.and_then(strip_of).is_none();
    // Who stands beside the lanes does so beside the outermost.
    let in_lane = in_lane && !told.stands_beside(false) && told.thing.is_none();
    let touched = |zone: &ContactZone| matches!(zone, ContactZone::Right | ContactZone::FrontRight);
    let moves = told.cp.state == ContactState::Moving;
    let passes = told.cp.movement == Some(Movement::Passing) && side_of(&told.sv.zones) == Some(-1.0)
        || told.cp.passes_on() == Some(LeftRight::Right);
    let by = moves && told.sv.zones.iter().any(touched) || passes;
    in_lane && matches!(told.origin, Origin::Beside { side: LeftRight::Right })
        || in_lane && told.origin == Origin::Behind && by
}

/// Who is no longer than this has room between the ego and the stop line. [m]
const USUAL_M: f64 = 6.0;

/// Who stands at the kerb does so before a junction by so much. [m]
const KERB_BEFORE_M: f64 = 10.0;

/// The first of a queue stands so far before the line. [m]
const FIRST_AT_LINE_M: f64 = 0.6;

/// No ego that sets off behind it comes nearer to the line by more than with this. [m/s^2]
const SETS_OFF_MPS2: f64 = 2.0;

/// From a junction's centre to where its arms begin, wider with more lanes. [m]
pub(crate) fn corner_m(lanes: usize) -> f64 {
    CORNER_M + (lanes.max(2) - 2) as f64 * LANE_M
}

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

/// Four arms; the ego comes along the one that lies behind it.
fn junction(told: &Told, crossing: bool) -> Ground {
    let lanes = lanes_for(told, 2);
    let corner_m = corner_m(lanes);
    let exits_by = match told.sv.turning {
        Turning::Left => "left",
        Turning::Right => "right",
        Turning::No | Turning::Round => "own",
    };
    let one_way = is_one_way(told);
    let at_kerb = told.is_at_kerb() && !crossing && told.sv.turning == Turning::No && !one_way;
    let parks = at_kerb
        || told.stands_beside(false)
        || has(told, Role::Kerb)
        || told.extras.iter().any(|extra| extra.between)
        || told.crossed_near && told.cp.state == ContactState::Parked;
    let usual: &[StripKind] = if parks { &[StripKind::Parking, StripKind::Sidewalk] } else { &[StripKind::Sidewalk] };
    // Of the partner's road, on both sides of the junction.
    let beside = told.beside_lanes(usual);
    let crosses = matches!(told.origin, Origin::Cross { .. });
    let along = if crosses { ["left", "right"] } else { ["own", "ahead"] };
    let arm = |id: &str, bearing_deg: f64, length_m: f64| {
        let start = RoadStart::Arm { junction: "j".to_owned(), bearing_deg, from_m: corner_m };
        let usual = || strips(lanes, if along.contains(&id) { &beside } else { usual });
        let (away, towards) = match told.edge.filter(|_| id == exits_by) {
            Some(LeftRight::Right) if id == "own" => (usual(), strips(lanes, &told.beside_edge())),
            Some(LeftRight::Left) if id == "own" => (behind_median(usual()), usual()),
            Some(LeftRight::Right) => (strips(lanes, &told.beside_edge()), usual()),
            Some(LeftRight::Left) => (usual(), behind_median(usual())),
            None => (usual(), usual()),
        };
        straight(id, start, length_m, away, towards)
    };
    let (exit, lane) = match told.sv.turning {
        Turning::Left => ("left+", told_lane(told, lanes).unwrap_or(0)),
        Turning::Right => ("right+", told_lane(told, lanes).unwrap_or(lanes - 1)),
        Turning::No | Turning::Round => {
            let usual = if at_kerb { lanes - 1 } else { usual_lane(told, lanes, one_way) };
            ("ahead+", told_lane(told, lanes).unwrap_or(usual))
        }
    };
    // The ego's lane lies on the x axis, or beside it.
    let centre_y = (lanes as f64 - 0.5) * LANE_M;
    let map = GraphMap {
        roads: vec![
            arm("own", 180.0, APPROACH_M),
            arm("ahead", 0.0, APPROACH_M),
            arm("left", 90.0, APPROACH_M),
            arm("right", 270.0, APPROACH_M),
        ],
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
        ContactState::Stopped if told.sv.control.is_some() && told.sv.turning == Turning::No => match queue_m {
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
        all.extend(if waits && told.sv.turning == Turning::Right {
            // It has begun to turn.
            inside(&[6.0, 10.0, 14.0, 3.0, 18.0, 22.0, 28.0])
        } else if told.goes_straight_behind() {
            inside(&[8.0, 9.0, 10.0, 14.0, 18.0, 22.0])
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
            true => inside(&INSIDE_M),
            // From its line.
            false if told.sets_off_first() && before_m < USUAL_M => vec![APPROACH_M - over_line_m(told)],
            false => vec![APPROACH_M - before_m - if both { 10.0 } else { 0.0 }],
        }
    };
    let beside = if crosses { usual.to_vec() } else { beside };
    let across = Across { lanes, lane, oncoming: if one_way { 0 } else { lanes }, beside };
    let ground = with_way(map, vec!["own-".to_owned(), exit.to_owned()], across, places, true);
    let stands_m = if at_kerb { ground.kerbs_m[1] } else { 0.0 };
    let ground = Ground { stands_m, ..ground };
    if told.sv.turned { ground.after_turn() } else { ground }
}

/// Lanes in the ego's direction, the ego's, 0 is the leftmost, those of who comes towards it, and what lies beside them.
struct Across {
    lanes: usize,
    lane: usize,
    oncoming: usize,
    beside: Vec<StripKind>,
}

impl Across {
    /// From the ego's line to the middle of who is parked at the kerb on the left, and on the right. [m]
    fn kerbs_m(&self) -> [f64; 2] {
        let moving = self.beside.iter().take_while(|kind| **kind == StripKind::Bike);
        let half_m = 0.5 * StripKind::Parking.usual_width_m() + moving.map(|kind| kind.usual_width_m()).sum::<f64>();
        self.lane_edges_m().map(|edge_m| edge_m + half_m)
    }

    /// From the ego's line to the outer edge of the lanes on the left, and on the right. [m]
    fn lane_edges_m(&self) -> [f64; 2] {
        [self.oncoming + self.lane, self.lanes - self.lane - 1].map(|between| (between as f64 + 0.5) * LANE_M)
    }
}

fn with_way(map: GraphMap, route: Vec<String>, across: Across, places: Vec<f64>, junction: bool) -> Ground {
    let network = RoadNetwork::build(&MapSpec::G(map.clone()));
    let lane = across.lane as u8;
    let way = network.way(&route, lane, None).expect("the ego's way is on the map that was drawn for it");
    let (kerbs_m, opposing_m) = (across.kerbs_m(), (across.lane + 1) as f64 * LANE_M);
    // Of a road before a junction the rightmost lane lies on the x axis.
    let own_y_m = if junction { (across.lanes - across.lane - 1) as f64 * LANE_M } else { 0.0 };
    let off_m = way.pose(APPROACH_M - 1.0, 0.0).position.y - own_y_m;
    let off_route_m = if off_m.abs() > 0.5 * LANE_M { off_m } else { 0.0 };
    Ground {
        map: Rc::new(map),
        network: Arc::new(network),
        route,
        lane,
        way: Rc::new(way),
        off_route_m,
        places,
        junction,
        lanes: across.lanes,
        oncoming: across.oncoming,
        kerbs_m,
        lane_edges_m: across.lane_edges_m(),
        beside: across.beside,
        stands_m: 0.0,
        opposing_m,
        drift: None,
    }
}
