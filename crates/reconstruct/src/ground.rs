//! The road around a crash: drawn from what is told of the place, with the ego's lane along the x axis.

use crate::told::{Told, Turning};
use recrash_model::account::{ContactState, Origin, PlaceKind};
use recrash_model::geometry::Pose;
use recrash_model::scenario::{GraphMap, JunctionSpec, LinePiece, MapSpec, RoadSpec, RoadStart, Strip, StripKind};
use recrash_roads::{LanePath, RoadNetwork};

/// Width of driving lanes. [m]
pub(crate) const LANE_M: f64 = 3.4;

/// Length of the ego's road before a junction, and of a street on each side of the contact. [m]
const APPROACH_M: f64 = 320.0;

/// From a junction's centre to where its arms begin. [m]
const CORNER_M: f64 = 13.0;

/// A road and the ego's way on it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ground {
    pub(crate) map: GraphMap,
    /// Roads of the ego's way.
    pub(crate) route: Vec<String>,
    pub(crate) lane: u8,
    /// The ego's way.
    way: LanePath,
    /// Places along it to try. [m]
    places: Vec<f64>,
    /// Whether crossing roads are there.
    pub(crate) junction: bool,
}

impl Ground {
    pub(crate) fn places(&self) -> Vec<f64> {
        self.places.clone()
    }

    /// Length of the first road of the way. [m]
    pub(crate) fn first_m(&self) -> f64 {
        if self.junction { APPROACH_M } else { 2.0 * APPROACH_M }
    }

    pub(crate) fn sv_pose(&self, s_m: f64) -> Pose {
        self.way.pose(s_m, 0.0)
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
    let crossing = matches!(told.origin, Origin::Cross { .. })
        || told.sv.turning != Turning::No && told.sv.turning != Turning::Round
        || told.cp.turning != Turning::No;
    let lot = matches!(told.place, PlaceKind::ParkingLot | PlaceKind::Garage | PlaceKind::Driveway | PlaceKind::Alley);
    if crossing && !lot || told.place == PlaceKind::Intersection {
        return junction(told, crossing);
    }
    let (right, left) = match told.place {
        PlaceKind::Highway => (strips(3, &[StripKind::Shoulder]), Vec::new()),
        _ if lot => (strips(1, &[StripKind::Stalls]), strips(1, &[StripKind::Stalls])),
        _ => (
            strips(2, &[StripKind::Parking, StripKind::Sidewalk]),
            strips(1, &[StripKind::Parking, StripKind::Sidewalk]),
        ),
    };
    let lanes = right.iter().filter(|strip| strip.kind == StripKind::Driving).count();
    // The rightmost lane, but for a partner that comes by on the right.
    let lane = if lanes > 1 && passes_right(told) { lanes - 2 } else { lanes - 1 };
    let start = RoadStart::At { x_m: -APPROACH_M, y_m: (lane as f64 + 0.5) * LANE_M, heading_deg: 0.0 };
    let map = GraphMap {
        roads: vec![straight("main", start, 2.0 * APPROACH_M, right, left)],
        junctions: Vec::new(),
        areas: Vec::new(),
    };
    with_way(map, vec!["main+".to_owned()], lane as u8, vec![APPROACH_M], false)
}

fn passes_right(told: &Told) -> bool {
    use recrash_model::account::LeftRight::Right;
    matches!(told.origin, Origin::Beside { side: Right })
        || told.origin == Origin::Behind
            && told.cp.state == ContactState::Moving
            && told.sv.zones.iter().any(|zone| {
                matches!(zone, recrash_model::zones::ContactZone::Right | recrash_model::zones::ContactZone::FrontRight)
            })
}

/// Four arms; the ego comes along the one that lies behind it.
fn junction(told: &Told, crossing: bool) -> Ground {
    let arm = |id: &str, bearing_deg: f64, length_m: f64| {
        let start = RoadStart::Arm { junction: "j".to_owned(), bearing_deg, from_m: CORNER_M };
        straight(id, start, length_m, strips(2, &[StripKind::Sidewalk]), strips(2, &[StripKind::Sidewalk]))
    };
    // The ego's lane, the outer of two, lies on the x axis.
    let centre_y = 1.5 * LANE_M;
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
    let (exit, lane) = match told.sv.turning {
        Turning::Left => ("left+", 0),
        Turning::Right => ("right+", 1),
        Turning::No | Turning::Round => ("ahead+", 1),
    };
    let inside = |list: &[f64]| list.iter().map(|share| APPROACH_M + share).collect::<Vec<f64>>();
    let places = if told.sv.turning != Turning::No {
        inside(&[10.0, 14.0, 6.0, 18.0, 3.0, 22.0, 28.0])
    } else if crossing {
        inside(&[12.0, 8.0, 16.0, 5.0, 20.0])
    } else {
        // Before the line, in front of it.
        vec![APPROACH_M - 5.0]
    };
    with_way(map, vec!["own-".to_owned(), exit.to_owned()], lane, places, true)
}

fn with_way(map: GraphMap, route: Vec<String>, lane: u8, places: Vec<f64>, junction: bool) -> Ground {
    let network = RoadNetwork::build(&MapSpec::G(map.clone()));
    let way = network.way(&route, lane, None).expect("the ego's way is on the map that was drawn for it");
    Ground { map, route, lane, way, places, junction }
}
