//! What a road user did, from the path it drove: straight on, a turn, around the circle, or nothing.
//!
//! Rules and reasons: `docs/models/faithfulness.md`.

use super::layout::{Layout, bearing};
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::math;
use recrash_model::metrics::CheckResult;
use recrash_model::template::Movement;
use recrash_roads::{RoadNetwork, RoadPart};

/// Who drove less than this stood. [m] (assumed: half a car's length)
const STOOD_M: f64 = 2.0;

/// Heading change from which on a turn is one wherever it happens. [deg] (half of a right-angled turn)
const TURN_DEG: f64 = 45.0;

/// Heading change from which on a turn inside a junction, or off a plain road, has begun. [deg] (assumed)
const TURN_BEGUN_DEG: f64 = 20.0;

/// Heading change from which on a turn has begun in a junction while the vehicle still curves that way. [deg] (assumed:
/// more than steering noise, reached within 6 m on the widest left turn)
const TURN_CURVING_DEG: f64 = 8.0;

/// A path bent more than this is a turn's: the widest left turn on the maps has a radius of 41.5 m. [1/m]
const TURN_CURVATURE: f64 = 1.0 / 60.0;

/// Heading change from which on it is a U-turn. [deg]
const U_TURN_DEG: f64 = 150.0;

/// Shift across the road from which on it is a lane change: the middle of the box has crossed the line. [lane widths]
const LANE_CHANGE_WIDTHS: f64 = 0.5;

/// Cosine between heading and outward direction from which on a vehicle leaves a circle: exits begin at 0.5, the ring
/// stays below. (assumed)
const EXIT_OUTWARD: f64 = 0.6;

/// What a road user did.
#[derive(Debug, Clone, PartialEq)]
pub struct Driven {
    /// Kind.
    pub kind: DrivenKind,
    /// Heading change, less the road's own on a curve, left positive. [deg]
    pub turned_deg: f64,
    /// Shift to the left across the road; nil in a turn. [m]
    pub shifted_m: f64,
    /// Distance driven. [m]
    pub distance_m: f64,
    /// Whether the map has no junction to turn at.
    pub on_plain_road: bool,
}

/// Kind of movement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrivenKind {
    /// It stood.
    Stood,
    /// Straight on, in its lane or shifting less than a lane.
    Straight,
    /// Straight on, into another lane.
    LaneChange,
    /// A left turn, begun or done.
    Left,
    /// A right turn, begun or done.
    Right,
    /// A U-turn.
    UTurn,
    /// Around a circle and not yet out of it, past this many exits.
    Circling(u8),
    /// Into a circle, but not yet on its ring.
    Entering,
    /// On a circle's approach, never in the circle.
    NotInCircle,
}

/// What a road user did, from its boxes up to the end of the encounter.
pub fn driven(layout: &Layout, network: &RoadNetwork, track: &[OrientedBox]) -> Driven {
    let distance_m: f64 = track.windows(2).map(|pair| pair[0].centre.distance(pair[1].centre)).sum();
    let turned_rad: f64 = track.windows(2).map(|pair| turn_between(&pair[0], &pair[1])).sum();
    let on_plain_road = matches!(layout, Layout::Plain { .. });
    let (Some(first), Some(last)) = (track.first(), track.last()) else {
        return Driven { kind: DrivenKind::Stood, turned_deg: 0.0, shifted_m: 0.0, distance_m, on_plain_road };
    };
    let road_turned_rad = math::wrap_angle(layout.road_heading(last.centre) - layout.road_heading(first.centre));
    let turned_deg = degrees(turned_rad - road_turned_rad);
    let mut driven = Driven { kind: DrivenKind::Stood, turned_deg, shifted_m: 0.0, distance_m, on_plain_road };
    if distance_m < STOOD_M {
        return driven;
    }
    if let Layout::Circle { .. } = layout {
        driven.kind = around_circle(layout, network, track);
        return driven;
    }
    driven.kind = turn_kind(layout, track, turned_deg);
    if driven.kind == DrivenKind::Straight {
        driven.shifted_m = shift(layout, first, last);
        let lane_width_m = network.map.carriageway().lane_width_m;
        if driven.shifted_m.abs() >= LANE_CHANGE_WIDTHS * lane_width_m {
            driven.kind = DrivenKind::LaneChange;
        }
    }
    driven
}

fn turn_kind(layout: &Layout, track: &[OrientedBox], turned_deg: f64) -> DrivenKind {
    let size = turned_deg.abs();
    let side = if turned_deg > 0.0 { DrivenKind::Left } else { DrivenKind::Right };
    if size >= U_TURN_DEG {
        return DrivenKind::UTurn;
    }
    let has_junction = matches!(layout, Layout::Junction { .. });
    let entered = track.iter().any(|outline| {
        let nose = outline.centre + outline.axis * outline.half_length;
        layout.distance_from_junction(nose).is_none_or(|distance| distance <= 0.0)
    });
    let curving = has_junction && curvature_at_end(track) * turned_deg.signum() >= TURN_CURVATURE;
    let turning =
        size >= TURN_DEG || (entered && size >= TURN_BEGUN_DEG) || (entered && curving && size >= TURN_CURVING_DEG);
    if turning { side } else { DrivenKind::Straight }
}

/// Mean curvature of the last metres driven, positive to the left; nil while standing. [1/m]
fn curvature_at_end(track: &[OrientedBox]) -> f64 {
    const LAST_M: f64 = 3.0;
    let (mut length, mut turned) = (0.0, 0.0);
    for pair in track.windows(2).rev() {
        length += pair[0].centre.distance(pair[1].centre);
        turned += turn_between(&pair[0], &pair[1]);
        if length >= LAST_M {
            break;
        }
    }
    if length > 0.5 { turned / length } else { 0.0 }
}

/// Shift to the left across the road between two boxes, seen along the first one's heading. [m]
fn shift(layout: &Layout, first: &OrientedBox, last: &OrientedBox) -> f64 {
    match layout {
        Layout::Plain { along } => {
            let t = |outline: &OrientedBox| along.project(outline.centre, 0).t;
            let road = Vec2::from_heading(layout.road_heading(first.centre));
            let same_way = road.dot(first.axis) >= 0.0;
            if same_way { t(first) - t(last) } else { t(last) - t(first) }
        }
        Layout::Junction { .. } | Layout::Circle { .. } => (last.centre - first.centre).dot(first.axis.left()),
    }
}

/// The way around a circle. Traffic circulates anticlockwise; the arms lie at the four quarters as seen from the centre.
fn around_circle(layout: &Layout, network: &RoadNetwork, track: &[OrientedBox]) -> DrivenKind {
    let Layout::Circle { centre, radius_m } = layout else { return DrivenKind::NotInCircle };
    let part_at = |outline: &OrientedBox| {
        let nose = outline.centre + outline.axis * outline.half_length;
        let heading = math::atan2(outline.axis.y, outline.axis.x);
        network.lane_at(nose, heading).map(|id| network.road(network.lane(id).road).part)
    };
    // Looking up lanes is dear: only where the ring can be.
    let on_ring = |outline: &OrientedBox| {
        outline.centre.distance(*centre) <= radius_m + outline.half_length && part_at(outline) == Some(RoadPart::Ring)
    };
    let quarter = math::FRAC_PI_2;
    let Some(joined) = track.iter().position(on_ring) else {
        let entered = track.last().is_some_and(|last| part_at(last) == Some(RoadPart::Inner));
        return if entered { DrivenKind::Entering } else { DrivenKind::NotInCircle };
    };
    // The arm it came from; of a vehicle that was on the ring from the start, the ego's (west), as in `route`.
    let arm = if joined == 0 { math::PI } else { (bearing(*centre, track[0].centre) / quarter).round() * quarter };
    let mut around = math::wrap_angle(bearing(*centre, track[joined].centre) - arm);
    for pair in track[joined..].windows(2) {
        around += math::wrap_angle(bearing(*centre, pair[1].centre) - bearing(*centre, pair[0].centre));
    }
    let last = &track[track.len() - 1];
    let outward = last.centre - *centre;
    let left_again = match part_at(last) {
        // An exit leads out, an entry in; at first they overlap the ring.
        Some(RoadPart::Inner) => last.axis.dot(outward) > EXIT_OUTWARD * outward.length(),
        Some(RoadPart::Ring) => false,
        // On an arm, or beyond the end of one.
        _ => outward.length() > *radius_m,
    };
    if !left_again {
        return DrivenKind::Circling((around / quarter).floor().clamp(0.0, 4.0) as u8);
    }
    match (around / quarter).round() as i32 {
        i32::MIN..=1 => DrivenKind::Right,
        2 => DrivenKind::Straight,
        3 => DrivenKind::Left,
        _ => DrivenKind::UTurn,
    }
}

impl Driven {
    /// Whether this is `expected`.
    pub fn shows(&self, expected: Movement) -> CheckResult {
        // On a highway nobody can turn: reports call a move into the next lane that (`docs/models/rules.md`).
        let moved_over = self.kind == DrivenKind::LaneChange && self.on_plain_road;
        let shown = match expected {
            Movement::Straight => {
                matches!(
                    self.kind,
                    DrivenKind::Straight | DrivenKind::LaneChange | DrivenKind::Entering | DrivenKind::Circling(0 | 1)
                )
            }
            // Who drives around a circle turns left until it leaves.
            Movement::LeftTurn => {
                matches!(self.kind, DrivenKind::Left | DrivenKind::Circling(_)) || (moved_over && self.shifted_m > 0.0)
            }
            Movement::RightTurn => self.kind == DrivenKind::Right || (moved_over && self.shifted_m < 0.0),
            Movement::UTurn => self.kind == DrivenKind::UTurn,
            Movement::ChangingLanes | Movement::Passing | Movement::Merging => self.kind == DrivenKind::LaneChange,
            Movement::Stopped | Movement::Parked => self.kind == DrivenKind::Stood,
            Movement::ParkingManeuver
            | Movement::Backing
            | Movement::EnteringTraffic
            | Movement::LaneDeparture
            | Movement::CrossingIntoOpposingLane
            | Movement::WrongWay
            | Movement::NmCrossing
            | Movement::NmWaiting
            | Movement::NmAlongside
            | Movement::NmOnSidewalk
            | Movement::NmInRoadway => return CheckResult::CannotBeShown,
        };
        if shown { CheckResult::Shown } else { CheckResult::NotShown }
    }

    /// For the report.
    pub fn describe(&self) -> String {
        let turned = self.turned_deg.abs();
        let side = if self.turned_deg >= 0.0 { "left" } else { "right" };
        match self.kind {
            DrivenKind::Stood => format!("stood (drove {:.1} m)", self.distance_m),
            DrivenKind::Straight => format!("straight on (heading changed by {turned:.0}\u{b0})"),
            DrivenKind::LaneChange => {
                let to = if self.shifted_m >= 0.0 { "left" } else { "right" };
                format!("straight on, {:.1} m to the {to}", self.shifted_m.abs())
            }
            DrivenKind::Left | DrivenKind::Right => format!("turned {side} by {turned:.0}\u{b0}"),
            DrivenKind::UTurn => format!("turned around ({turned:.0}\u{b0})"),
            DrivenKind::Circling(0) => "drove around the circle, not yet past an exit".to_owned(),
            DrivenKind::Circling(exits) => format!("drove around the circle, past {exits} exit(s)"),
            DrivenKind::Entering => "entered the circle, not yet on its ring".to_owned(),
            DrivenKind::NotInCircle => "never entered the circle".to_owned(),
        }
    }
}

fn turn_between(before: &OrientedBox, after: &OrientedBox) -> f64 {
    math::atan2(before.axis.cross(after.axis), before.axis.dot(after.axis))
}

pub(super) fn degrees(radians: f64) -> f64 {
    radians * 180.0 / math::PI
}
