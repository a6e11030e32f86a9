//! Where somebody with a plan starts, and the line it follows.

use super::arm_m;
use crate::check::remarks::{Remarks, shown};
use crate::course::{Beside, Course, CoursePiece, StopLine, rear_of};
use crate::network::RoadNetwork;
use crate::path::LanePath;
use crate::place::PlaceError;
use crate::scenario::{ActorPlacement, ControlPlacement};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::scenario::{ActorPlan, Leg, Part, Place, Size};
use recrash_model::vehicle::VehicleSpec;

/// The tightest bend of a course of who has an axle, by what its wheels can do, times this: a plan may cut it fine.
const TIGHTEST_SHARE: f64 = 0.9;

/// Who begins along lanes faces along them, but for this. [rad]
const FACING_RAD: f64 = 0.02;

/// Where somebody with a plan starts, and the line it follows.
pub(in crate::check) fn placement(
    network: &RoadNetwork,
    control: &[ControlPlacement],
    (kind, size, parts): (PartnerKind, Option<Size>, &[Part]),
    plan: &ActorPlan,
    path: &str,
    remarks: &mut Remarks,
) -> Option<ActorPlacement> {
    let spec = VehicleSpec::of(kind);
    let (length_m, width_m) = size.map_or((spec.length_m, spec.width_m), |size| (size.length_m, size.width_m));
    let arm_m = arm_m(kind, length_m);
    let start = match network.place(&plan.start) {
        Ok(start) => start.pose,
        Err(error) => {
            remarks.error("scenario.place", format!("{path}.start"), error.message, error.hint);
            return None;
        }
    };
    let mut layout = Layout { network, plan, start, course: Course::begin(arm_m), t_m: 0.0 };
    for (number, leg) in plan.course.iter().enumerate() {
        if let Err(Refused { code, field, message, hint }) = layout.add(number, leg) {
            remarks.error(code, format!("{path}.course[{number}].{field}"), message, hint);
            return None;
        }
    }
    let Layout { mut course, t_m, .. } = layout;
    if course.legs.is_empty() {
        course = Course::standing(start, arm_m);
    }
    tight_bends(&course, kind, path, remarks);
    course.lines = stop_lines(&course, control, 0.5 * length_m);
    let pose = course.motion(0, 0.0, course.legs[0].reverse, Beside { t_m, ..Default::default() }, 0.0).0;
    let mass_kg = VehicleSpec::mass_kg(kind);
    Some(ActorPlacement { kind, length_m, width_m, mass_kg, pose, course, t_m, parts: parts.to_vec() })
}

/// A course that is being laid out, leg by leg.
struct Layout<'a> {
    network: &'a RoadNetwork,
    plan: &'a ActorPlan,
    start: Pose,
    course: Course,
    /// Where it starts beside the line, to the right. [m]
    t_m: f64,
}

/// Why a leg cannot be driven.
struct Refused {
    code: &'static str,
    /// Its field that says so.
    field: &'static str,
    message: String,
    hint: String,
}

impl Refused {
    fn new(code: &'static str, field: &'static str, message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { code, field, message: message.into(), hint: hint.into() }
    }

    /// A place that is not there.
    fn place(code: &'static str, field: &'static str) -> impl Fn(PlaceError) -> Self {
        move |error| Self::new(code, field, error.message, error.hint)
    }
}

impl Layout<'_> {
    /// Adds a leg.
    fn add(&mut self, number: usize, leg: &Leg) -> Result<(), Refused> {
        match leg {
            Leg::Lanes { roads, until_m, lane, against, reverse } => {
                let from = self.centre();
                let first_lane = self.first_lane(number, roads);
                let (way, enters_m) = lanes_leg(self.network, roads, first_lane, *lane, *against, from)
                    .map_err(Refused::place("scenario.way", "lanes.roads"))?;
                let beside = way.project(from.position, 0);
                if number == 0 {
                    faces_along(&way, beside.s, from, *reverse)?;
                    self.t_m = if *reverse { -beside.t } else { beside.t };
                }
                // Who faces along the line of motion has its rear axle behind, who drives backwards ahead.
                let arm_m = if *reverse { -self.course.arm_m } else { self.course.arm_m };
                let from_m = beside.s - arm_m;
                let to_m = until_m.map_or(way.length_m, |until_m| enters_m + until_m) - arm_m;
                if to_m <= from_m {
                    let message = format!("the leg would end {} m behind where it begins", shown(from_m - to_m));
                    return Err(Refused::new("scenario.way", "lanes.until_m", message, "allowed: farther along"));
                }
                self.course.follow(&way, (from_m, to_m), *against, *reverse, until_m.is_some());
            }
            Leg::Curve { to, reverse } => self.curve(to, *reverse)?,
            Leg::Path { points } => self.course.walk(self.start, points),
        }
        Ok(())
    }

    /// The centre at the end of what there is so far.
    fn centre(&self) -> Pose {
        self.course.end_pose().map_or(self.start, |rear| rear_of(rear, -self.course.arm_m))
    }

    /// The lane that a leg begins on, where the start says so: who stands on a strip beside the lanes follows the nearest of them.
    fn first_lane(&self, number: usize, roads: &[String]) -> Option<u8> {
        match &self.plan.start {
            Place::Lane { road, lane, .. } if number == 0 && roads.first() == Some(road) => Some(*lane),
            _ => None,
        }
    }

    /// Adds a leg along a smooth curve.
    fn curve(&mut self, to: &Place, reverse: bool) -> Result<(), Refused> {
        let to = self.network.place(to).map_err(Refused::place("scenario.place", "curve.to"))?.pose;
        if self.course.curve(self.start, to, reverse) {
            return Ok(());
        }
        let hint = "allowed: a place ahead of where it begins (behind, with \"reverse\"), that needs no turn of \
                    more than half a circle; go there in two curves";
        Err(Refused::new("scenario.curve", "curve.to", "no smooth curve leads there", hint))
    }
}

/// Whether who begins beside this place of the lanes faces along them.
fn faces_along(way: &LanePath, s_m: f64, start: Pose, reverse: bool) -> Result<(), Refused> {
    let facing = way.pose(s_m, 0.0).heading + if reverse { math::PI } else { 0.0 };
    let turned = math::wrap_angle(facing - start.heading).abs();
    if turned > FACING_RAD {
        let message = format!("it faces {} deg off the lanes it is to follow", shown(turned.to_degrees()));
        let hint = "begin with a {\"curve\": ...} onto the lane, give heading_deg 0 (180 with \"against\"), or set \
                    \"reverse\"";
        return Err(Refused::new("scenario.facing", "lanes", message, hint));
    }
    Ok(())
}

/// A way along lanes, and where it enters its last road. [m]
fn lanes_leg(
    network: &RoadNetwork,
    roads: &[String],
    first_lane: Option<u8>,
    last_lane: Option<u8>,
    against: bool,
    from: Pose,
) -> Result<(LanePath, f64), PlaceError> {
    let first_lane = match first_lane {
        Some(lane) => lane,
        None => nearest_lane(network, &roads[0], from.position)?,
    };
    let way = if against {
        network.way_against(roads, first_lane, last_lane)?
    } else {
        network.way(roads, first_lane, last_lane)?
    };
    let last = network.named_road(&roads[roads.len() - 1], "roads")?;
    let pieces = &network.named[last].pieces;
    let enters = way.segments.iter().find(|segment| pieces.contains(&network.lane(segment.lane).road));
    let enters_m = enters.map_or(0.0, |segment| segment.start_m);
    Ok((way, enters_m))
}

/// The number of the lane of a road that passes nearest to a point.
fn nearest_lane(network: &RoadNetwork, road: &str, point: Vec2) -> Result<u8, PlaceError> {
    let road = &network.named[network.named_road(road, "roads[0]")?];
    let mut best = (f64::INFINITY, 0);
    for lane in 0..network.lanes_of(road) {
        let path = network.lane_of(road, lane)?;
        let beside = path.project(point, 0);
        let apart = path.pose(beside.s, 0.0).position.distance(point);
        if apart < best.0 {
            best = (apart, lane);
        }
    }
    Ok(best.1)
}

/// Bends that its wheels cannot follow.
fn tight_bends(course: &Course, kind: PartnerKind, path: &str, remarks: &mut Remarks) {
    let spec = VehicleSpec::of(kind);
    if course.arm_m == 0.0 {
        return;
    }
    let wheelbase_m = spec.front_axle_m + spec.rear_axle_m;
    let least_m = TIGHTEST_SHARE * wheelbase_m / math::tan(spec.max_wheel_angle_rad);
    let tightest = course.pieces.iter().map(|piece| piece.shape.curvature().abs()).fold(0.0, f64::max);
    if tightest * least_m > 1.0 {
        let message = format!("its course bends with a radius of {} m", shown(1.0 / tightest));
        let hint = format!("its kind turns with {} m or more; leave more room, or take two curves", shown(least_m));
        remarks.warn("scenario.tight-course", format!("{path}.course"), message, hint);
    }
}

/// The stop lines on a course, in order.
fn stop_lines(course: &Course, control: &[ControlPlacement], half_length_m: f64) -> Vec<StopLine> {
    let mut lines = Vec::new();
    for (number, placed) in control.iter().enumerate().filter(|(_, placed)| placed.stops) {
        for &(lane, line_m) in &placed.lines {
            for piece in course.pieces.iter().filter(|piece| piece.lane == Some(lane)) {
                let line = network_point(piece, line_m);
                if let Some(along_m) = line {
                    // The course is the rear axle's.
                    let at_m = piece.start_m + along_m - course.arm_m - half_length_m;
                    lines.push(StopLine { at_m, control: number });
                }
            }
        }
    }
    lines.sort_by(|a, b| a.at_m.total_cmp(&b.at_m));
    lines
}

/// Where along a piece of a course a place along its lane lies; `None` off the piece. [m]
fn network_point(piece: &CoursePiece, line_m: f64) -> Option<f64> {
    let along_m = line_m - piece.lane_from_m;
    (-1e-6..=piece.length_m + 1e-6).contains(&along_m).then_some(along_m)
}
