//! Sideways moves as lane changes with an offset.

use super::Context;
use super::places::{place_on, reference_to_centre};
use crate::xml::{Element, number, rounded};
use recrash_model::scenario::{Partner, Start};
use recrash_model::vehicle::VehicleSpec;

/// One sideways move: when it begins, as an attribute value, and its action.
pub(super) fn moves(context: &Context<'_>, position: usize) -> Vec<(String, Element)> {
    let draft = context.scenario.draft();
    let partner = &draft.partners[position];
    let placement = &context.scenario.partners()[position];
    let width = draft.map.carriageway().lane_width_m;
    let mut from = offset_at(partner, 0.0);
    let mut travelled = placement.s_m;
    let mut clock = 0.0;
    let mut list = Vec::new();
    for (number_of, step) in partner.lateral.iter().enumerate() {
        let at = |field: &str, value: f64| {
            context.names.reference(&format!("/partners/{position}/lateral/{number_of}/{field}"), value)
        };
        // Where it is by then decides which lane is left of which; its target speed is near enough.
        travelled += (step.start_s - clock) * partner.policy.target_speed().max(0.0);
        clock = step.start_s;
        let s = travelled.clamp(0.0, placement.path.length_m);
        let (lanes_right, offset_t) = lane_and_offset(context, position, s, step.to_t_m, width);
        let (lanes_from, _) = lane_and_offset(context, position, s, from, width);
        let along_line = place_on(context, &placement.path, s, 0.0).is_none_or(|(place, _)| place.lane < 0);
        let target = at("to_t_m", step.to_t_m);
        let shift = rounded(f64::from(lanes_right) * width);
        let offset = match (target.contains('$'), along_line) {
            (false, true) => number(rounded(-offset_t)),
            (false, false) => number(rounded(offset_t)),
            (true, true) => format!("${{{} - {target}}}", number(shift)),
            (true, false) if shift < 0.0 => format!("${{{target} + {}}}", number(-shift)),
            (true, false) => format!("${{{target} - {}}}", number(shift)),
        };
        let action = Element::new("PrivateAction").child(
            Element::new("LateralAction").child(
                Element::new("LaneChangeAction").with("targetLaneOffset", offset).children([
                    Element::new("LaneChangeActionDynamics")
                        .with("dynamicsShape", "linear")
                        .with("value", at("duration_s", step.duration_s))
                        .with("dynamicsDimension", "time"),
                    Element::new("LaneChangeTarget").child(
                        // Lanes to the left of the entity's own heading count up.
                        Element::new("RelativeTargetLane")
                            .with("entityRef", &partner.id)
                            .with("value", (lanes_from - lanes_right).to_string()),
                    ),
                ]),
            ),
        );
        let lag = lag_s(partner);
        let start = at("start_s", step.start_s);
        let start = match (start.contains('$'), lag > 0.0) {
            (_, false) => start,
            (true, true) => format!("${{{start} + {}}}", number(lag)),
            (false, true) => number(rounded(step.start_s + lag)),
        };
        list.push((start, action));
        from = step.to_t_m;
    }
    list
}

/// How late a steered vehicle follows a target that moves sideways: the time for some metres of way. Fitted to the native
/// simulator so that centres are nearest, from motorcycle to heavy truck; `docs/formats/openscenario.md` has what is left. [s]
fn lag_s(partner: &Partner) -> f64 {
    if reference_to_centre(partner.kind) == 0.0 {
        return 0.0;
    }
    let spec = VehicleSpec::of(partner.kind);
    let way = 1.6 + 0.25 * (spec.front_axle_m + spec.rear_axle_m);
    let lag = way / partner.policy.target_speed().max(1.0);
    (lag.min(1.0) * 100.0).round() / 100.0
}

/// Where the actions put a partner to the right of its way at a time. [m]
pub(super) fn offset_at(partner: &Partner, time_s: f64) -> f64 {
    let mut offset = match partner.start {
        Start::Offset { delta_t_m, .. } => delta_t_m,
        Start::ArrivalGap { .. } => 0.0,
    };
    for step in partner.lateral.iter().filter(|step| time_s > step.start_s) {
        offset += (step.to_t_m - offset) * ((time_s - step.start_s) / step.duration_s).min(1.0);
    }
    offset
}

/// A lateral place as lanes to the right of the partner's own, and the rest of it. [m]
///
/// Lanes there are not count as the last one there is: a vehicle on the verge is beside the outermost lane.
fn lane_and_offset(context: &Context<'_>, position: usize, s: f64, t: f64, width: f64) -> (i32, f64) {
    let network = context.scenario.network();
    let path = &context.scenario.partners()[position].path;
    let lane = path.segments[path.segment_at(s)].lane;
    let own = i32::from(network.lane(lane).index);
    let (road, _) = context.map.lane(lane);
    let count = i32::try_from(network.road(network.lane(lane).road).lanes.len()).unwrap_or(1);
    let least = if road.backward.is_some() { -count } else { 0 };
    let wanted = (t / width).round() as i32;
    let lanes_right = wanted.clamp(least - own, count - 1 - own);
    (lanes_right, t - f64::from(lanes_right) * width)
}
