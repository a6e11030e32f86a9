//! Where reference lines lie: pieces one behind the other, roads behind each other, at junctions and along lanes.

use super::strips::{self, LEFT, RIGHT};
use super::{is_open, problem};
use crate::curve::{self, Stretch};
use crate::reference_line::ReferenceLine;
use recrash_model::Diagnostic;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::narrative::Side;
use recrash_model::scenario::{GraphMap, LinePiece, RoadSpec, RoadStart, StripKind};

/// What is on the inside of a bend keeps at least this radius. [m]
const LEAST_INNER_RADIUS_M: f64 = 0.5;

/// Lanes that follow each other meet within this distance: who follows them exactly does not jump. [m]
const JOINT_M: f64 = 0.001;

/// Reference lines are at most this long. [m]
const LONGEST_LINE_M: f64 = 5000.0;

/// The reference lines of all roads, in order.
pub(super) fn lines(map: &GraphMap, problems: &mut Vec<Diagnostic>) -> Vec<ReferenceLine> {
    let shapes: Vec<ReferenceLine> =
        map.roads.iter().enumerate().map(|(position, spec)| shape(position, spec, problems)).collect();
    if !problems.is_empty() {
        return shapes;
    }
    let mut placed: Vec<Option<ReferenceLine>> = vec![None; shapes.len()];
    loop {
        let before = placed.iter().flatten().count();
        for (position, spec) in map.roads.iter().enumerate() {
            if placed[position].is_none()
                && let Some(start) = start(map, spec, &shapes[position], &placed)
            {
                placed[position] = Some(shapes[position].moved_to(start));
            }
        }
        if placed.iter().flatten().count() == before {
            break;
        }
    }
    let mut lines = Vec::with_capacity(placed.len());
    for (position, line) in placed.into_iter().enumerate() {
        match line {
            Some(line) => lines.push(line),
            None => {
                let spec = &map.roads[position];
                let (message, hint) = (
                    format!("where {:?} begins hangs on itself, or on a lane that is not there", spec.id),
                    "give one of the roads in the circle a start {\"at\": ...}, and name a lane that its road has",
                );
                problems.push(problem("scenario.start-unknown", format!("map.roads[{position}].start"), message, hint));
            }
        }
    }
    if problems.is_empty() {
        joints(map, &lines, problems);
        ramps(map, problems);
        ends(map, &lines, problems);
    }
    lines
}

/// A road's line, beginning at the origin.
fn shape(position: usize, spec: &RoadSpec, problems: &mut Vec<Diagnostic>) -> ReferenceLine {
    let mut stretches: Vec<Stretch> = Vec::new();
    for (number, piece) in spec.line.iter().enumerate() {
        let at = || format!("map.roads[{position}].line[{number}]");
        let start = stretches.last().map_or_else(Pose::default, Stretch::end);
        let to_left = |to: &Side| if *to == Side::Left { 1.0 } else { -1.0 };
        let added = match piece {
            LinePiece::Straight { length_m } => vec![curve::straight(start, *length_m)],
            LinePiece::Arc { length_m, radius_m, to } => {
                vec![Stretch { start, curvature: to_left(to) / radius_m, length_m: *length_m }]
            }
            LinePiece::Spiral { length_m, from_radius_m, to_radius_m, to } => {
                let curvature = |radius: &Option<f64>| radius.map_or(0.0, |radius| to_left(to) / radius);
                curve::spiral(start, *length_m, curvature(from_radius_m), curvature(to_radius_m))
            }
            LinePiece::Points { points } => {
                let points: Vec<Vec2> =
                    points.iter().map(|[x, y]| start.position + Vec2::new(*x, *y).turned(start.heading)).collect();
                match curve::through(start, &points) {
                    Some(line) => line,
                    None => {
                        let message = "no smooth line leads through these points: two are one, or it turns back";
                        let hint = "allowed: points in the order of driving, each ahead of the one before it";
                        problems.push(problem("scenario.line", at(), message.to_owned(), hint));
                        return ReferenceLine::new(&spec.id, stretches);
                    }
                }
            }
        };
        let width = |side: f64| {
            let strips = strips::side_of(spec, side);
            let at = |u: f64| strips::inner_edge_m(strips, strips.len(), u);
            at(0.0).max(at(1.0))
        };
        let tightest = |side: f64| {
            added.iter().map(|s| -side / s.curvature).filter(|radius| *radius > 0.0).fold(f64::INFINITY, f64::min)
        };
        for (side, name) in [(RIGHT, "right"), (LEFT, "left")] {
            if tightest(side) < width(side) + LEAST_INNER_RADIUS_M {
                let message = format!(
                    "{:?} bends to the {name} with a radius of {:.1} m, and has {:.1} m of strips on that side",
                    spec.id,
                    tightest(side),
                    width(side)
                );
                let hint =
                    format!("allowed: a radius from {:.1} m, or fewer strips", width(side) + LEAST_INNER_RADIUS_M);
                problems.push(problem("scenario.curve-too-tight", at(), message, hint));
            }
        }
        stretches.extend(added);
    }
    let line = ReferenceLine::new(&spec.id, stretches);
    if line.length_m > LONGEST_LINE_M {
        let message = format!("{:?} is {:.0} m long", spec.id, line.length_m);
        let hint = format!("allowed: at most {LONGEST_LINE_M} m");
        problems.push(problem("scenario.range", format!("map.roads[{position}].line"), message, hint));
    }
    line
}

/// Where a road's reference line begins; `None` as long as what it hangs on has no place.
fn start(map: &GraphMap, spec: &RoadSpec, shape: &ReferenceLine, placed: &[Option<ReferenceLine>]) -> Option<Pose> {
    let line_of = |id: &str| {
        let position = map.roads.iter().position(|road| road.id == id)?;
        placed[position].as_ref().map(|line| (&map.roads[position], line))
    };
    match &spec.start {
        RoadStart::At { x_m, y_m, heading_deg } => {
            Some(Pose { position: Vec2::new(*x_m, *y_m), heading: heading_deg * math::PI / 180.0 })
        }
        RoadStart::After { road } => line_of(road).map(|(_, line)| line.pose(line.length_m)),
        RoadStart::Arm { junction, bearing_deg, from_m } => {
            let junction = map.junctions.iter().find(|known| known.id == *junction)?;
            let heading = bearing_deg * math::PI / 180.0;
            let centre = Vec2::new(junction.x_m, junction.y_m);
            Some(Pose { position: centre + Vec2::from_heading(heading) * *from_m, heading })
        }
        RoadStart::IntoLane { road, lane } => {
            let theirs = lane_end(line_of(undirected(road)?)?, road, *lane, false)?;
            Some(carried(shape, lane_end((spec, shape), "+", 0, true)?, theirs))
        }
        RoadStart::FromLane { road, lane } => {
            let theirs = lane_end(line_of(undirected(road)?)?, road, *lane, true)?;
            Some(carried(shape, lane_end((spec, shape), "+", 0, false)?, theirs))
        }
    }
}

/// The id in a road's name with direction.
pub(crate) fn undirected(name: &str) -> Option<&str> {
    name.strip_suffix(['+', '-'])
}

/// Where a line begins when a pose of it is carried to another.
fn carried(shape: &ReferenceLine, own: Pose, to: Pose) -> Pose {
    let turned = to.heading - own.heading;
    let origin = shape.pose(0.0);
    Pose { position: to.position + (origin.position - own.position).turned(turned), heading: origin.heading + turned }
}

/// Where a driving lane begins or ends, in its own direction; `name` ends with + or -.
fn lane_end((spec, line): (&RoadSpec, &ReferenceLine), name: &str, lane: u8, at_end: bool) -> Option<Pose> {
    let side = if name.ends_with('+') { RIGHT } else { LEFT };
    let strips = strips::side_of(spec, side);
    let index = *strips::of_kind(strips, StripKind::Driving).get(usize::from(lane))?;
    let pose = strips::strip_end(spec, line, side, index, at_end == (side > 0.0));
    Some(if side > 0.0 { pose } else { curve::turned_round(pose) })
}

/// Lanes of one number meet where one road follows another.
fn joints(map: &GraphMap, lines: &[ReferenceLine], problems: &mut Vec<Diagnostic>) {
    for (position, spec) in map.roads.iter().enumerate() {
        let RoadStart::After { road } = &spec.start else { continue };
        let Some(before) = map.roads.iter().position(|known| known.id == *road) else { continue };
        for sign in ["+", "-"] {
            let along = sign == "+";
            for lane in 0..=u8::MAX {
                let own = lane_end((spec, &lines[position]), sign, lane, !along);
                let theirs = lane_end((&map.roads[before], &lines[before]), sign, lane, along);
                let (Some(own), Some(theirs)) = (own, theirs) else { break };
                let apart = own.position.distance(theirs.position);
                if apart > JOINT_M {
                    let message = format!(
                        "lane {lane} of {:?} is {apart:.3} m beside that of {road:?}, which it follows",
                        format!("{}{sign}", spec.id)
                    );
                    let hint = format!(
                        "allowed: {JOINT_M} m; give strips between the reference line and it the same widths where the \
                                roads meet (end_width_m changes a width along a road)"
                    );
                    problems.push(problem("scenario.joint", format!("map.roads[{position}].start"), message, hint));
                    break;
                }
            }
        }
    }
}

/// The lanes that ramps lead to and come from are open where they meet.
fn ramps(map: &GraphMap, problems: &mut Vec<Diagnostic>) {
    for (position, spec) in map.roads.iter().enumerate() {
        let (name, lane, ends) = match &spec.start {
            RoadStart::IntoLane { road, lane } => (road, *lane, false),
            RoadStart::FromLane { road, lane } => (road, *lane, true),
            _ => continue,
        };
        let Some(other) = undirected(name).and_then(|id| map.roads.iter().find(|road| road.id == id)) else { continue };
        let side = if name.ends_with('+') { RIGHT } else { LEFT };
        let strips = strips::side_of(other, side);
        let Some(index) = strips::of_kind(strips, StripKind::Driving).get(usize::from(lane)).copied() else { continue };
        if !is_open(strips[index].widths_m(), ends == (side > 0.0)) {
            let what = if ends { "ends" } else { "begins" };
            let message = format!("lane {lane} of {name:?} is no lane where it {what}: it is too narrow there");
            let hint = "allowed: 1 m or more; let it be as wide as the ramp's lane where they meet";
            problems.push(problem("scenario.joint", format!("map.roads[{position}].start"), message, hint));
        }
    }
}

/// Roads that end at a junction lead to it.
fn ends(map: &GraphMap, lines: &[ReferenceLine], problems: &mut Vec<Diagnostic>) {
    for (number, junction) in map.junctions.iter().enumerate() {
        for (entry, id) in junction.ends.iter().enumerate() {
            let Some(line) = lines.iter().find(|line| line.road == *id) else { continue };
            let end = line.pose(line.length_m);
            let to_centre = Vec2::new(junction.x_m, junction.y_m) - end.position;
            let apart = to_centre.length();
            let bearing = math::wrap_angle(math::atan2(to_centre.y, to_centre.x) - end.heading).abs();
            if !(4.0..=100.0).contains(&apart) || bearing > 0.25 * math::PI {
                let message = format!(
                    "{id:?} ends {apart:.1} m from the centre of {:?}, which lies {:.0} deg beside its direction",
                    junction.id,
                    bearing * 180.0 / math::PI
                );
                let hint = "allowed: 4 to 100 m, and 45 deg";
                problems.push(problem(
                    "scenario.junction",
                    format!("map.junctions[{number}].ends[{entry}]"),
                    message,
                    hint,
                ));
            }
        }
    }
}
