//! Scenic 3: one readable file per scenario that runs on the Newtonian simulator and on MetaDrive.

mod partners;
mod scene;

use crate::opendrive::DriveMap;
use crate::openscenario::names::Declarations;
use crate::openscenario::scene::is_scene;
use crate::xml::{number, rounded};
use crate::{ExportError, ExportFile};
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::Rollout;
use recrash_model::scenario::{DEFAULT_SPEED_KP, Policy};
use recrash_model::tuning::Parameter;
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::Plan;
use recrash_plan::constants::{
    ACCELERATION, CATCH_UP_S, COMMITTED_M, DECELERATION, GREATEST_BRAKING_MPS2, HOLD_BELOW_MPS, HOLD_BRAKE, HORIZON_S,
    MERGED_M, MERGING_S, PATIENCE_STEPS, SIGHT_M, STANDING_MPS, STANDSTILL_DISTANCE_M, STOP_SHORT_M,
    THEIR_ACCELERATION_MPS2, TIME_HEADWAY_S,
};
use recrash_roads::{LanePath, Placement, Scenario};
use std::fmt::Write;

/// The part that is the same in every file.
const LIBRARY: &str = include_str!("library.scenic");

/// Distance between two points of a way on a curve: 1 m on a radius of 10 m is off by 1.3 cm. [m]
const CURVE_STEP_M: f64 = 1.0;

/// What the parts of a file are made from.
struct Context<'a> {
    scenario: &'a Scenario,
    names: Declarations,
    parameters: &'a [Parameter],
}

impl Context<'_> {
    /// A number, or the name of the parameter that holds it.
    fn value(&self, pointer: &str, value: f64) -> String {
        match self.names.find(pointer) {
            Some(found) => constant(&found.name),
            None => number(value),
        }
    }
}

/// The files of a scenario: the scenario and its map.
pub(crate) fn files(
    scenario: &Scenario,
    rollout: Option<&Rollout>,
    parameters: &[Parameter],
) -> Result<Vec<ExportFile>, ExportError> {
    let draft = scenario.draft();
    let id = &draft.id;
    let map = DriveMap::new(scenario.network(), &scenario.draft().control)
        .document(scenario.network(), id)
        .document(&crate::comment(draft));
    let context = Context { scenario, names: Declarations::new(draft, parameters), parameters };
    let text = if is_scene(draft) {
        let recorded = rollout.ok_or_else(|| ExportError::NeedsRollout { scenario: id.clone() })?;
        scene::document(&context, recorded)
    } else {
        document(&context)
    };
    Ok(vec![
        ExportFile { name: format!("{id}.xodr"), content: map },
        ExportFile { name: format!("{id}.scenic"), content: text.into_bytes() },
    ])
}

fn document(context: &Context<'_>) -> String {
    let mut text = header(context, &run_it(context));
    text.push_str(&declarations(context));
    text.push('\n');
    text.push_str(&constants());
    text.push_str(LIBRARY);
    text.push_str(&ways(context));
    text.push_str(&cast(context));
    text
}

/// Title, source, and these lines on how to run it.
fn header(context: &Context<'_>, run_it: &str) -> String {
    let draft = context.scenario.draft();
    let mut text = String::from("\"\"\"\n");
    let _ = writeln!(text, "{}\n", doc_text(&crate::comment(draft)));
    let environment = serde_json::to_string(&draft.environment).unwrap_or_default();
    let _ = writeln!(text, "Not carried by Scenic's driving domain, so for information only: {environment}");
    if draft.traffic.density > 0.0 {
        let _ = writeln!(text, "Background traffic of density {} is left out.", number(draft.traffic.density));
    }
    let _ = write!(text, "\nRun it:\n{run_it}");
    text.push_str("\"\"\"\n");
    text
}

/// How to run a file whose partners act.
fn run_it(context: &Context<'_>) -> String {
    let draft = context.scenario.draft();
    let id = &draft.id;
    let steps = number((draft.duration_s * 10.0).ceil());
    let mut text = String::new();
    let _ = writeln!(
        text,
        "  scenic {id}.scenic --2d -S --count 1 --time {steps} -m scenic.simulators.newtonian.driving_model"
    );
    let _ = writeln!(text, "  netconvert --opendrive-files {id}.xodr -o {id}.net.xml    # once, for MetaDrive");
    let _ =
        writeln!(text, "  scenic {id}.scenic --2d -S --count 1 --time {steps} -m scenic.simulators.metadrive.model");
    let _ = writeln!(
        text,
        "With `-p sweep 1` the parameters below are drawn from their ranges. Newtonian brakes with 6.8 m/s^2 at most,"
    );
    let _ = writeln!(
        text,
        "and lets vehicles pass through each other. MetaDrive gets no cones: its Scenic interface has none."
    );
    text
}

/// Parameters with their ranges, then the model.
fn declarations(context: &Context<'_>) -> String {
    let id = &context.scenario.draft().id;
    let mut text = format!(
        "param map = localPath('{id}.xodr')\n\
         param sumo_map = localPath('{id}.net.xml')\n\
         param render = False\n\
         param real_time = False\n\
         param time_step = 0.1\n\
         param timestep = 0.1\n\
         param sweep = 0\n\
         model scenic.domains.driving.model\n\n\
         import math\n\
         import shapely.geometry\n\
         from scenic.core.distributions import distributionFunction\n\n\
         def varied(value, low, high):\n    return Range(low, high) if globalParameters.sweep else value\n\n"
    );
    for declaration in &context.names.list {
        let tunable = context.parameters.iter().find(|parameter| parameter.pointer == declaration.pointer);
        let value = number(declaration.value);
        let name = constant(&declaration.name);
        match tunable {
            Some(p) => {
                let (low, high) = (number(p.min), number(p.max));
                let _ = writeln!(
                    text,
                    "{name} = varied({value}, {low}, {high})    # [{}] {}",
                    p.unit,
                    crate::one_line(&p.reason)
                );
            }
            None => {
                let _ = writeln!(text, "{name} = {value}");
            }
        }
    }
    text
}

/// The numbers of `recrash_plan` that the library below needs.
fn constants() -> String {
    let mut text = String::from(
        "# What recrash's plans mean (docs/models/policies.md): SI units, and MetaDrive's own for its gap law.\n",
    );
    for (name, value) in [
        ("GAIN", DEFAULT_SPEED_KP),
        ("GREATEST_BRAKING", GREATEST_BRAKING_MPS2),
        ("CATCH_UP", CATCH_UP_S),
        ("STANDING", STANDING_MPS),
        ("HOLD_BELOW", HOLD_BELOW_MPS),
        ("HOLD_BRAKE", HOLD_BRAKE),
        ("STOP_SHORT", STOP_SHORT_M),
        ("COMMITTED", COMMITTED_M),
        ("PATIENCE", f64::from(PATIENCE_STEPS)),
        ("HORIZON", HORIZON_S),
        ("MERGED", MERGED_M),
        ("MERGING", MERGING_S),
        ("THEIR_ACCELERATION", THEIR_ACCELERATION_MPS2),
        ("SIGHT", SIGHT_M),
        ("STANDSTILL_DISTANCE", STANDSTILL_DISTANCE_M),
        ("TIME_HEADWAY", TIME_HEADWAY_S),
        ("COMFORT", 2.0 * (ACCELERATION * DECELERATION).sqrt()),
    ] {
        let _ = writeln!(text, "{name} = {}", number(rounded(value)));
    }
    text.push('\n');
    text
}

/// Everybody's way as a line of points.
fn ways(context: &Context<'_>) -> String {
    let mut text = String::from(
        "\n# ---- ways: the centre lines driven on, from the beginning of the arm to the end of the exit [m] ----------------\n\n",
    );
    let _ = writeln!(text, "EGO_WAY = {}", line_string(context.scenario.ego()));
    for (position, partner) in context.scenario.partners().iter().enumerate() {
        let _ = writeln!(text, "PARTNER{}_WAY = {}", position + 1, line_string(partner));
    }
    for position in 0..context.scenario.partners().len() {
        let bends = partners::bends(context, position);
        if !bends.is_empty() {
            // Each with a comma behind: one alone is a list too.
            let _ = writeln!(
                text,
                "PARTNER{}_BENDS = ({},)    # begin and end along it, and the most it drives there [m, m, m/s]",
                position + 1,
                bends.join(", ")
            );
        }
        let crossings = partners::crossings(context, position);
        if !crossings.is_empty() {
            let _ = writeln!(
                text,
                "PARTNER{}_CROSSINGS = (    # who else is met (0 is the ego), on which way, merging; begin and end on both ways [m]",
                position + 1,
            );
            crossings.iter().for_each(|crossing| text.push_str(crossing));
            text.push_str(")\n");
        }
    }
    text
}

/// The ego, the partners and the obstacles.
fn cast(context: &Context<'_>) -> String {
    let draft = context.scenario.draft();
    let mut text = String::from(
        "\n# ---- who does what ------------------------------------------------------------------------------------------------\n",
    );
    for position in 0..draft.partners.len() {
        text.push_str(&partners::behavior(context, position));
    }
    let ego = context.scenario.ego();
    let (s, speed) = (context.value("/ego/s_m", draft.ego.s_m), context.value("/ego/speed_mps", draft.ego.speed_mps));
    let target = context.value("/ego/target_speed_mps", draft.ego.target_speed_mps);
    let start = Placed { at: &on_way("EGO_WAY", &s, "0"), speed: &speed };
    let _ = writeln!(text, "\n# The system under test: replace Follow by your own behavior.");
    let _ = writeln!(text, "ego = {}", road_user(context, ego, &start, &format!("Follow(EGO_WAY, {target})"), true));
    for position in 0..draft.partners.len() {
        text.push_str(&partners::instance(context, position));
    }
    if !draft.obstacles.is_empty() {
        text.push_str(&obstacles(context));
    }
    text.push('\n');
    for position in 0..draft.partners.len() {
        let name = partners::variable(position);
        let _ = writeln!(text, "record (distance from ego to {name}) as \"centre distance to {name}\"");
        let _ = writeln!(text, "terminate when contact(ego, {name})");
    }
    let _ = writeln!(text, "terminate when along(EGO_WAY, ego) > EGO_WAY.length - 5");
    let duration = context.value("/duration_s", draft.duration_s);
    let _ = writeln!(text, "terminate after {duration} seconds");
    text
}

/// Where a road user starts, and how fast, as expressions.
struct Placed<'a> {
    at: &'a str,
    speed: &'a str,
}

/// A place on a way, heading along it.
fn on_way(way: &str, s: &str, t: &str) -> String {
    format!("at place({way}, {s}, {t}), facing direction({way}, {s})")
}

/// A road user at a place.
fn road_user(
    context: &Context<'_>,
    placement: &Placement,
    start: &Placed<'_>,
    behavior: &str,
    on_road: bool,
) -> String {
    let Placed { at, speed } = start;
    let spec = VehicleSpec::of(placement.kind);
    let stands = Policy::Stopped { depart_step: None, target_speed_mps: 0.0 };
    let surface = context.scenario.draft().environment.surface;
    let plan = Plan::new(placement.kind, &stands, 0.0, surface);
    let class = if placement.kind == PartnerKind::Pedestrian { "Pedestrian" } else { "Car" };
    let mut text = format!(
        "new {class} {at},\n    \
         with length {}, with width {}, with limits ({}, {}, {}, {}, {}),\n    \
         with speed {speed}, with requireVisible False",
        number(spec.length_m),
        number(spec.width_m),
        number(rounded(spec.max_acceleration_mps2)),
        number(rounded(spec.brake_demand_mps2)),
        number(rounded(spec.max_deceleration_mps2)),
        number(rounded(plan.comfortable_mps2)),
        number(rounded(plan.stopping_mps2)),
    );
    if !on_road {
        text.push_str(", with regionContainedIn everywhere");
    }
    let _ = write!(text, ",\n    with behavior {behavior}");
    text
}

fn obstacles(context: &Context<'_>) -> String {
    let draft = context.scenario.draft();
    let mut text = String::from("\nif not IN_METADRIVE:\n");
    for (position, obstacle) in draft.obstacles.iter().enumerate() {
        let placed = &context.scenario.obstacles()[position].placed;
        let kind = obstacle.kind.label();
        let s = context.value(&format!("/obstacles/{position}/s_m"), obstacle.s_m);
        let t = context.value(&format!("/obstacles/{position}/t_m"), obstacle.t_m);
        let _ = writeln!(
            text,
            "    new Object at place(EGO_WAY, {s}, {t}), facing direction(EGO_WAY, {s}), with length {}, with width {},\n        \
             with requireVisible False, with regionContainedIn everywhere    # {kind}",
            number(placed.length_m),
            number(placed.width_m),
        );
    }
    text
}

/// A way as points: the ends of straight pieces, and every metre of a curve.
fn line_string(placement: &Placement) -> String {
    let points: Vec<String> = stations(&placement.path)
        .into_iter()
        .map(|(segment, s)| {
            let (x, y) = point_of(&placement.path, segment, s);
            format!("({}, {})", number(millimetres(x)), number(millimetres(y)))
        })
        .collect();
    let mut text = String::from("shapely.geometry.LineString([");
    for chunk in points.chunks(6) {
        let _ = write!(text, "\n    {},", chunk.join(", "));
    }
    text.push_str("])");
    text
}

fn stations(path: &LanePath) -> Vec<(usize, f64)> {
    let mut list = Vec::new();
    for (position, segment) in path.segments.iter().enumerate() {
        let curved = path.curvature(segment.start_m + 0.5 * segment.length_m) != 0.0;
        let pieces = if curved { (segment.length_m / CURVE_STEP_M).ceil().max(1.0) } else { 1.0 };
        for piece in 0..pieces as usize {
            list.push((position, segment.start_m + segment.length_m * piece as f64 / pieces));
        }
    }
    list.push((path.segments.len() - 1, path.length_m));
    list
}

fn point_of(path: &LanePath, segment: usize, s: f64) -> (f64, f64) {
    let piece = &path.segments[segment];
    let point = piece.shape.frame(s - piece.start_m).0;
    (point.x, point.y)
}

fn millimetres(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

/// `partner1StartArrivalGapS` as a constant: `PARTNER1_START_ARRIVAL_GAP_S`.
fn constant(name: &str) -> String {
    let mut text = String::new();
    for c in name.chars() {
        if c.is_ascii_uppercase() {
            text.push('_');
        }
        text.push(c.to_ascii_uppercase());
    }
    text
}

/// Text that cannot end a documentation string.
fn doc_text(text: &str) -> String {
    text.replace('\\', "/").replace('"', "'")
}
