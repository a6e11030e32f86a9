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

/// Parallel lanes with the partner on the left or right; the second plans leave a lane's room on the other side.
const SIDE_BY_SIDE: &[Staging] = &[
    beside(Left, Sideways, &[plan(2, 1, 0), plan(3, 1, 0), plan(3, 2, 1)]),
    beside(Right, Sideways, &[plan(2, 0, 1), plan(3, 1, 2), plan(3, 0, 1)]),
];

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

const RIGHT_RIGHT: &[Staging] = &[
    beside(Left, Sideways, &[plan(2, 1, 0), plan(3, 2, 1)]),
    beside(Right, Sideways, &[plan(2, 0, 1), plan(3, 1, 2)]),
];

const RIGHT_LEFT: &[Staging] = &[crossing(Opposite, &[plan(2, 1, 1), plan(2, 0, 0), plan(1, 0, 0)])];

/// On a straight road nobody can turn: the partner moves sideways, to its left where the template says left.
const HIGHWAY_EITHER: &[Staging] = &[
    beside(Left, Sideways, &[plan(3, 1, 0), plan(4, 2, 1)]),
    beside(Right, Sideways, &[plan(3, 1, 2), plan(4, 1, 2)]),
];
const HIGHWAY_TO_THE_LEFT: &[Staging] = &[beside(Right, Sideways, &[plan(3, 1, 2), plan(4, 1, 2), plan(3, 0, 1)])];
const HIGHWAY_TO_THE_RIGHT: &[Staging] = &[beside(Left, Sideways, &[plan(3, 1, 0), plan(4, 2, 1), plan(3, 2, 1)])];

/// What the rules can stage, for error messages.
pub const KNOWN: &str = "intersections and traffic circles with both going straight, left or right, and highways with the ego going straight";

/// Every way to stage a template, most typical first; empty where there is none.
pub fn stagings(template: &Template) -> &'static [Staging] {
    use Movement::{LeftTurn, RightTurn, Straight};
    match (template.road, template.sv, template.cp) {
        (RoadType::Intersection, Straight, Straight) => STRAIGHT_STRAIGHT,
        (RoadType::Intersection, Straight, LeftTurn) => STRAIGHT_LEFT,
        (RoadType::Intersection, Straight, RightTurn) => STRAIGHT_RIGHT,
        (RoadType::Intersection, LeftTurn, Straight) => LEFT_STRAIGHT,
        (RoadType::Intersection, LeftTurn, LeftTurn) => LEFT_LEFT,
        (RoadType::Intersection, LeftTurn, RightTurn) => LEFT_RIGHT,
        (RoadType::Intersection, RightTurn, Straight) => RIGHT_STRAIGHT,
        (RoadType::Intersection, RightTurn, RightTurn) => RIGHT_RIGHT,
        (RoadType::Intersection, RightTurn, LeftTurn) => RIGHT_LEFT,
        (RoadType::Highway, Straight, Straight) => HIGHWAY_EITHER,
        (RoadType::Highway, Straight, LeftTurn) => HIGHWAY_TO_THE_LEFT,
        (RoadType::Highway, Straight, RightTurn) => HIGHWAY_TO_THE_RIGHT,
        (RoadType::TrafficCircle, sv, cp) if sv == cp && Movement::PAPER.contains(&sv) => SIDE_BY_SIDE,
        _ => &[],
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
