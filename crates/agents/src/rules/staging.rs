//! Which conflicts of a template can be staged, and in which lanes: the geometry of the five maps put into a table.
//!
//! A turning vehicle must be well inside its turn when the two meet, so that its movement can be read from its path, and
//! the meeting must not be head-on. With n lanes of width w the left turn of lane k has the radius 10 + (n + k) w, the
//! right turn 10 + (n - 1 - k) w; where the centre lines cross follows from that. A test computes every row's conflict
//! from the road network and holds it against these rules.

use recrash_model::narrative::Side;
use recrash_model::scenario::{Approach, MissingArm};
use recrash_model::template::{Movement, RoadType, Template};

/// One way to stage a template.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Staging {
    /// From where the partner comes.
    pub approach: Approach,
    /// On which side of the ego it drives, where it comes from the same road.
    pub beside: Option<Side>,
    /// How the two get into conflict.
    pub conflict: ConflictKind,
    /// Lanes to use, best first.
    pub lanes: &'static [LanePlan],
}

/// How the two get into conflict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConflictKind {
    /// Their paths cross, or merge into one lane.
    Paths,
    /// Their paths are parallel; the partner leaves its lane towards the ego.
    Sideways,
}

/// Lanes of a staging.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LanePlan {
    /// Lanes in each direction.
    pub lanes: u8,
    /// The ego's, 0 is the leftmost.
    pub ego: u8,
    /// The partner's on its own road.
    pub partner: u8,
}

const fn plan(lanes: u8, ego: u8, partner: u8) -> LanePlan {
    LanePlan { lanes, ego, partner }
}

const fn crossing(approach: Approach, lanes: &'static [LanePlan]) -> Staging {
    Staging { approach, beside: None, conflict: ConflictKind::Paths, lanes }
}

const fn beside(side: Side, conflict: ConflictKind, lanes: &'static [LanePlan]) -> Staging {
    Staging { approach: Approach::Same, beside: Some(side), conflict, lanes }
}

use Approach::{Left as FromLeft, Opposite, Right as FromRight};
use ConflictKind::{Paths, Sideways};
use Side::{Left, Right};

/// Parallel lanes: in turning lanes of a junction, or around a circle.
const SIDE_BY_SIDE: &[Staging] = &[
    beside(Left, Sideways, &[plan(2, 1, 0), plan(3, 2, 1)]),
    beside(Right, Sideways, &[plan(2, 0, 1), plan(3, 1, 2)]),
];
/// On a circle, the same exit: into the ring before or behind a partner that is on it, or side by side around it.
const CIRCLE_SAME_EXIT: &[Staging] = &[
    beside(Left, Sideways, &[plan(2, 1, 0), plan(3, 2, 1)]),
    beside(Right, Sideways, &[plan(2, 0, 1), plan(3, 1, 2)]),
    crossing(FromLeft, CIRCLE_MERGE),
];
/// Who is on the ring from the start is seen to go far around it.
const CIRCLE_BOTH_LEFT: &[Staging] = &[
    beside(Left, Sideways, &[plan(2, 1, 0), plan(3, 2, 1)]),
    beside(Right, Sideways, &[plan(2, 0, 1), plan(3, 1, 2)]),
    crossing(Approach::Ring, CIRCLE_MERGE),
    crossing(FromLeft, CIRCLE_MERGE),
];
/// Both in one lane of the ring.
const CIRCLE_MERGE: &[LanePlan] = &[plan(1, 0, 0), plan(2, 1, 1), plan(2, 0, 0)];
/// The partner leaves before the ego, out of the inner lane across the ego's.
const CIRCLE_PARTNER_LEAVES_FIRST: &[Staging] = &[beside(Left, Paths, &[plan(2, 1, 0), plan(3, 2, 1)])];
/// The ego leaves before the partner, out of the inner lane across the partner's.
const CIRCLE_EGO_LEAVES_FIRST: &[Staging] = &[beside(Right, Paths, &[plan(2, 0, 1), plan(3, 1, 2)])];

/// Both straight: the cross streets meet at right angles in any lanes.
const STRAIGHT_STRAIGHT: &[Staging] = &[
    crossing(FromLeft, &[plan(2, 1, 1), plan(2, 1, 0), plan(2, 0, 1), plan(2, 0, 0)]),
    crossing(FromRight, &[plan(2, 1, 1), plan(2, 1, 0), plan(2, 0, 1), plan(2, 0, 0)]),
    beside(Left, Sideways, &[plan(2, 1, 0), plan(3, 1, 0)]),
    beside(Right, Sideways, &[plan(2, 0, 1), plan(3, 1, 2)]),
];

const STRAIGHT_LEFT: &[Staging] = &[
    crossing(Opposite, &[plan(2, 1, 0), plan(2, 1, 1), plan(1, 0, 0)]),
    crossing(FromLeft, &[plan(2, 0, 1), plan(2, 1, 1), plan(2, 0, 0)]),
    crossing(FromRight, &[plan(1, 0, 0), plan(2, 1, 0), plan(2, 0, 0)]),
    beside(Right, Paths, &[plan(2, 0, 1), plan(3, 0, 1), plan(3, 1, 2)]),
];

const STRAIGHT_RIGHT: &[Staging] = &[
    crossing(FromRight, &[plan(2, 1, 1), plan(2, 0, 0), plan(1, 0, 0)]),
    beside(Left, Paths, &[plan(2, 1, 0), plan(3, 2, 1), plan(3, 1, 0)]),
];

const LEFT_STRAIGHT: &[Staging] = &[
    crossing(Opposite, &[plan(2, 0, 1), plan(2, 0, 0), plan(1, 0, 0)]),
    crossing(FromLeft, &[plan(1, 0, 0), plan(2, 0, 1), plan(2, 0, 0)]),
    crossing(FromRight, &[plan(2, 0, 0), plan(2, 1, 1), plan(1, 0, 0)]),
    beside(Left, Paths, &[plan(2, 1, 0), plan(3, 1, 0)]),
];

const LEFT_LEFT: &[Staging] = &[
    beside(Left, Sideways, &[plan(2, 1, 0), plan(3, 1, 0)]),
    beside(Right, Sideways, &[plan(2, 0, 1), plan(3, 0, 1)]),
    crossing(FromLeft, &[plan(2, 1, 1), plan(2, 0, 1)]),
    crossing(FromRight, &[plan(2, 1, 1), plan(2, 1, 0)]),
];

const LEFT_RIGHT: &[Staging] = &[crossing(Opposite, &[plan(2, 0, 0), plan(2, 1, 1), plan(1, 0, 0)])];

const RIGHT_STRAIGHT: &[Staging] = &[
    crossing(FromLeft, &[plan(2, 1, 1), plan(2, 0, 0), plan(1, 0, 0)]),
    beside(Right, Paths, &[plan(2, 0, 1), plan(3, 1, 2), plan(3, 0, 1)]),
];

const RIGHT_LEFT: &[Staging] = &[crossing(Opposite, &[plan(2, 1, 1), plan(2, 0, 0), plan(1, 0, 0)])];

/// On a road without junction the partner moves sideways.
const ROAD_SIDEWAYS: &[Staging] = &[
    beside(Left, Sideways, &[plan(3, 1, 0), plan(4, 2, 1), plan(2, 1, 0)]),
    beside(Right, Sideways, &[plan(3, 1, 2), plan(4, 1, 2), plan(2, 0, 1)]),
];
/// A left turn on a highway: off it at a junction, across the ego's way, or a move to the left into the ego's lane.
const ROAD_STRAIGHT_LEFT: &[Staging] = &[
    crossing(Opposite, &[plan(2, 1, 0), plan(2, 1, 1)]),
    beside(Right, Sideways, &[plan(3, 0, 1), plan(4, 1, 2)]),
    crossing(FromLeft, &[plan(2, 0, 1), plan(2, 1, 1)]),
    crossing(FromRight, &[plan(2, 1, 0), plan(1, 0, 0)]),
];
/// The same to the right.
const ROAD_STRAIGHT_RIGHT: &[Staging] =
    &[beside(Left, Sideways, &[plan(3, 2, 1), plan(4, 2, 1)]), crossing(FromRight, &[plan(2, 1, 1), plan(2, 0, 0)])];

/// What the rules can stage, for error messages.
pub const KNOWN: &str = "templates with both going straight, left or right";

/// Every way to stage a template, most typical first; empty where there is none.
pub fn stagings(template: &Template) -> &'static [Staging] {
    use Movement::{LeftTurn, RightTurn, Straight};
    match (template.road, template.sv, template.cp) {
        (_, sv, cp) if ![sv, cp].iter().all(|movement| Movement::PAPER.contains(movement)) => &[],
        (RoadType::TrafficCircle, LeftTurn, LeftTurn) => CIRCLE_BOTH_LEFT,
        (RoadType::TrafficCircle, RightTurn, RightTurn) => SIDE_BY_SIDE,
        (RoadType::TrafficCircle, Straight, Straight) => CIRCLE_SAME_EXIT,
        (RoadType::TrafficCircle, _, RightTurn) | (RoadType::TrafficCircle, LeftTurn, _) => CIRCLE_PARTNER_LEAVES_FIRST,
        (RoadType::TrafficCircle, ..) => CIRCLE_EGO_LEAVES_FIRST,
        (RoadType::Intersection, Straight, Straight) => STRAIGHT_STRAIGHT,
        (RoadType::Intersection, Straight, LeftTurn) => STRAIGHT_LEFT,
        (RoadType::Intersection, Straight, RightTurn) => STRAIGHT_RIGHT,
        (_, Straight, Straight) => ROAD_SIDEWAYS,
        (_, Straight, LeftTurn) => ROAD_STRAIGHT_LEFT,
        (_, Straight, RightTurn) => ROAD_STRAIGHT_RIGHT,
        (_, LeftTurn, Straight) => LEFT_STRAIGHT,
        (_, LeftTurn, LeftTurn) => LEFT_LEFT,
        (_, LeftTurn, RightTurn) => LEFT_RIGHT,
        (_, RightTurn, Straight) => RIGHT_STRAIGHT,
        (_, RightTurn, RightTurn) => SIDE_BY_SIDE,
        (_, RightTurn, LeftTurn) => RIGHT_LEFT,
        _ => &[],
    }
}

/// What lies under a staging.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ground {
    /// A road without junction.
    Road,
    /// An intersection.
    Junction,
    /// A roundabout.
    Circle,
}

/// Where a staging of a template takes place: who turns off a highway or street needs a junction to turn at, who moves
/// sideways on it does not.
pub fn ground(template: &Template, staging: &Staging) -> Ground {
    let ego_straight = template.sv == Movement::Straight;
    match template.road {
        RoadType::TrafficCircle => Ground::Circle,
        RoadType::Intersection => Ground::Junction,
        _ if ego_straight && staging.conflict == ConflictKind::Sideways => Ground::Road,
        _ => Ground::Junction,
    }
}

/// Whether a three-way intersection without this arm still holds both ways.
pub fn fits_three_way(template: &Template, staging: &Staging, missing: MissingArm) -> bool {
    // Arms anticlockwise from the ego's: 0 its own, 1 right, 2 ahead, 3 left.
    let leaves_by = |from: usize, movement: Movement| match movement {
        Movement::LeftTurn => (from + 3) % 4,
        Movement::RightTurn => (from + 1) % 4,
        _ => (from + 2) % 4,
    };
    let from = match staging.approach {
        Approach::Right => 1,
        Approach::Opposite => 2,
        Approach::Left => 3,
        Approach::Same | Approach::Ring => 0,
    };
    let absent = match missing {
        MissingArm::Right => 1,
        MissingArm::Ahead => 2,
        MissingArm::Left => 3,
    };
    template.road == RoadType::Intersection
        && ![leaves_by(0, template.sv), from, leaves_by(from, template.cp)].contains(&absent)
}
