//! Where things start: lane positions of reference points, as expressions of the parameters they depend on.
//!
//! OpenSCENARIO places a vehicle by its rear axle, recrash by the centre of its box (`docs/formats/conventions.md`).

use super::Context;
use crate::opendrive::LanePlace;
use crate::xml::{Element, number, rounded};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{Approach, Start};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{LanePath, Placement};

/// From the reference point forward to the centre of the box. [m]
pub(super) fn reference_to_centre(kind: PartnerKind) -> f64 {
    match kind {
        // Pedestrians and things are placed by their centre.
        PartnerKind::Pedestrian | PartnerKind::Animal | PartnerKind::FixedObject => 0.0,
        _ => VehicleSpec::of(kind).rear_axle_m,
    }
}

/// The reference point of a road user whose box is at `pose`.
pub(super) fn reference_point(kind: PartnerKind, pose: Pose) -> Pose {
    let behind = Vec2::from_heading(pose.heading) * reference_to_centre(kind);
    Pose { position: pose.position - behind, heading: pose.heading }
}

/// A number along a path as an expression of parameters.
struct Along {
    /// The expression, in parentheses where it is a sum; without `${}`.
    expression: String,
    /// Its value in this scenario. [m]
    value: f64,
}

/// The ego's start.
pub(super) fn ego_start(context: &Context<'_>) -> Element {
    let draft = context.scenario.draft();
    let along = Along { expression: context.names.reference("/ego/s_m", draft.ego.s_m), value: draft.ego.s_m };
    start(context, context.scenario.ego(), along, "0".to_owned(), 0.0)
}

/// A partner's start, by its position in the draft.
pub(super) fn partner_start(context: &Context<'_>, position: usize) -> Element {
    let placement = &context.scenario.partners()[position];
    let (t, t_m) = match context.scenario.draft().partners[position].start {
        Start::Offset { delta_t_m, .. } => {
            (context.names.reference(&format!("/partners/{position}/start/delta_t_m"), delta_t_m), delta_t_m)
        }
        Start::ArrivalGap { .. } => (number(rounded(placement.t_m)), placement.t_m),
    };
    start(context, placement, partner_along(context, position), t, t_m)
}

/// Where a partner starts along its way, and so much further on, as an attribute value. Not before the way begins.
pub(super) fn start_along(context: &Context<'_>, position: usize, further_m: f64) -> String {
    let along = partner_along(context, position);
    if along.value + further_m < 0.0 {
        return "0".to_owned();
    }
    if !along.expression.contains('$') {
        return number(rounded(along.value + further_m));
    }
    let sign = if further_m < 0.0 { "-" } else { "+" };
    format!("${{{} {sign} {}}}", along.expression, number(further_m.abs()))
}

fn partner_along(context: &Context<'_>, position: usize) -> Along {
    let draft = context.scenario.draft();
    let (ego, placement) = (&draft.ego, &context.scenario.partners()[position]);
    let partner = &draft.partners[position];
    let at = |field: &str, value: f64| context.names.reference(&format!("/partners/{position}/{field}"), value);
    let ego_s = context.names.reference("/ego/s_m", ego.s_m);
    let expression = match partner.start {
        Start::Offset { delta_s_m, .. } => {
            let (moved, ego_along) = (at("start/delta_s_m", delta_s_m), ego.s_m + delta_s_m);
            // Straight roads have equally long lanes; on a curve this is the tangent at the designed place.
            let sense = if partner.approach == Approach::Opposite { "-" } else { "+" };
            let rest = rounded(match partner.approach {
                Approach::Opposite => placement.s_m + ego_along,
                _ => placement.s_m - ego_along,
            });
            match (rest == 0.0, sense) {
                (true, "+") => format!("({ego_s} + {moved})"),
                _ => format!("({} {sense} ({ego_s} + {moved}))", number(rest)),
            }
        }
        Start::ArrivalGap { arrival_gap_s } => match (&placement.conflict, target_speed(context, position)) {
            (Some(conflict), Some(speed)) => format!(
                "({} - {speed} * (({} - {ego_s}) / {} + {}))",
                number(rounded(conflict.s_b)),
                number(rounded(conflict.s_a)),
                context.names.reference("/ego/target_speed_mps", ego.target_speed_mps),
                at("start/arrival_gap_s", arrival_gap_s),
            ),
            _ => number(placement.s_m),
        },
    };
    Along { expression, value: placement.s_m }
}

/// The parameter that holds the speed a partner's policy wants.
fn target_speed(context: &Context<'_>, position: usize) -> Option<String> {
    ["target_speed", "cruise_speed", "target_speed_mps"].iter().find_map(|field| {
        let found = context.names.find(&format!("/partners/{position}/policy/{field}"))?;
        Some(format!("${}", found.name))
    })
}

fn start(context: &Context<'_>, placement: &Placement, along: Along, t: String, t_m: f64) -> Element {
    let back = reference_to_centre(placement.kind);
    let Some((place, scale)) = place_on(context, &placement.path, along.value - back, t_m) else {
        return world_position(reference_point(placement.kind, placement.pose));
    };
    // s of the road = rest + scale * (s of the path).
    let rest = rounded(place.s - scale * along.value);
    let s = if along.expression.contains('$') {
        let term = match scale {
            1.0 => along.expression,
            -1.0 => format!("-1 * {}", along.expression),
            other => format!("{} * {}", number(rounded(other)), along.expression),
        };
        let (sign, size) = if rest < 0.0 { ("-", -rest) } else { ("+", rest) };
        format!("${{{term} {sign} {}}}", number(size))
    } else {
        number(rounded(place.s))
    };
    // Right of travel is right of the road on lanes along the reference line, left of it on the others.
    let offset = match (t.contains('$'), place.lane < 0) {
        (true, true) => format!("${{-1 * {t}}}"),
        (true, false) => t,
        (false, _) => number(rounded(place.offset)),
    };
    lane_element(place, s, offset)
}

/// A lane position without parameters.
pub(super) fn fixed_place(place: LanePlace) -> Element {
    lane_element(place, number(rounded(place.s)), number(rounded(place.offset)))
}

fn lane_element(place: LanePlace, s: String, offset: String) -> Element {
    // No orientation: without one an entity faces the way its lane is driven, on lanes of either sign.
    let element = Element::new("LanePosition")
        .with("roadId", place.road.to_string())
        .with("laneId", place.lane.to_string())
        .with("s", s)
        .with("offset", offset);
    Element::new("Position").child(element)
}

/// The place at (s, t) of a path, and how far the road's s goes per metre of the path. `None` outside the road.
pub(super) fn place_on(context: &Context<'_>, path: &LanePath, s: f64, t: f64) -> Option<(LanePlace, f64)> {
    if !(0.0..=path.length_m).contains(&s) {
        return None;
    }
    let segment = &path.segments[path.segment_at(s)];
    let network = context.scenario.network();
    let place = context.map.place(network, segment.lane, s - segment.start_m, t);
    let (road, lane) = context.map.lane(segment.lane);
    let scale = road.length_m / segment.length_m;
    Some((place, if lane < 0 { scale } else { -scale }))
}

/// A position in the world.
pub(super) fn world_position(pose: Pose) -> Element {
    Element::new("Position").child(
        Element::new("WorldPosition")
            .with_number("x", rounded(pose.position.x))
            .with_number("y", rounded(pose.position.y))
            .with("z", "0")
            .with_number("h", rounded(pose.heading)),
    )
}

/// The way along a path as waypoints: the beginning of the road it starts on (so that a start may be moved along it),
/// the middle of every road behind it that is not inside a junction, and the end.
pub(super) fn route(context: &Context<'_>, placement: &Placement, name: &str) -> Element {
    let path = &placement.path;
    let first = path.segment_at((placement.s_m - reference_to_centre(placement.kind)).max(0.0));
    let mut stations = vec![path.segments[first].start_m];
    for segment in path.segments.iter().skip(first + 1) {
        if context.map.lane(segment.lane).0.junction.is_none() {
            stations.push(segment.start_m + 0.5 * segment.length_m);
        }
    }
    stations.push((path.length_m - 1.0).max(placement.s_m));
    let waypoints = stations.into_iter().filter_map(|s| {
        let (place, _) = place_on(context, path, s, 0.0)?;
        Some(Element::new("Waypoint").with("routeStrategy", "shortest").child(fixed_place(place)))
    });
    Element::new("Route").with("name", name).with("closed", "false").children(waypoints)
}
