//! Names, counts and ranges: everything that can be said without looking at the road.

use super::graph;
use super::remarks::{At, Remarks, name, shorten, shown};
use recrash_model::scenario::{
    LateralMove, MapSpec, Obstacle, Partner, Policy, SCENARIO_FORMAT, SCENARIO_FORMAT_1, ScenarioDraft, Start,
};
use std::collections::BTreeSet;

/// The fastest any vehicle drives: MetaDrive cuts the engine at 80 km/h. [m/s]
pub(super) const MAX_SPEED_MPS: f64 = 80.0 / 3.6;

/// The fastest that an ego may want on a road network, where recorded drivers may be faster than its engine: it then holds what it
/// has. 100 mph. [m/s]
pub const MAX_WANTED_MPS: f64 = 44.7;

/// The radius of the innermost lane of a curve, at least: two thirds more than a car's own turning circle. [m]
const MIN_LANE_RADIUS_M: f64 = 5.0;

/// Which parts of a draft have numbers that geometry can be built from.
pub(super) struct Fit {
    /// Whether there are no more road users and obstacles than may be compared with each other.
    pub counts: bool,
    pub map: bool,
    pub ego: bool,
    pub partners: Vec<bool>,
    pub obstacles: Vec<bool>,
}

/// Checks names, counts and ranges.
pub(super) fn check(draft: &ScenarioDraft, remarks: &mut Remarks) -> Fit {
    if ![SCENARIO_FORMAT, SCENARIO_FORMAT_1].contains(&draft.format.as_str()) {
        let message = format!("format is {:?}, not {SCENARIO_FORMAT:?}", shorten(&draft.format));
        remarks.error("scenario.format", "format", message, "write the format tag as shown");
    }
    name("id", &draft.id, 80, "._-", remarks);
    let map = map(&draft.map, remarks);
    remarks.number("duration_s", draft.duration_s, 1.0, 120.0, "s");
    let ego = {
        let speed = remarks.number("ego.speed_mps", draft.ego.speed_mps, 0.0, MAX_SPEED_MPS, "m/s");
        let (fastest, longest) = match &draft.map {
            MapSpec::G(_) => (MAX_WANTED_MPS, 2000.0),
            _ if map => (MAX_SPEED_MPS, draft.map.carriageway().approach_m),
            _ => (MAX_SPEED_MPS, 300.0),
        };
        let target = remarks.number("ego.target_speed_mps", draft.ego.target_speed_mps, 1.0, fastest, "m/s");
        let start = remarks.number("ego.s_m", draft.ego.s_m, 0.0, longest, "m");
        speed && target && start
    };
    let partners_fit = remarks.count("partners", draft.partners.len(), 16);
    let obstacles_fit = remarks.count("obstacles", draft.obstacles.len(), 64);
    remarks.number("traffic.density", draft.traffic.density, 0.0, 1.0, "");
    let mut ids = BTreeSet::new();
    let mut partners = Vec::with_capacity(draft.partners.len());
    for (position, each) in draft.partners.iter().enumerate() {
        let path = format!("partners[{position}]");
        name(format_args!("{path}.id"), &each.id, 32, "_-", remarks);
        if each.id == recrash_model::rollout::EGO_ID {
            remarks.error("scenario.id", format!("{path}.id"), "\"ego\" is the ego's own name", "choose another id");
        } else if !ids.insert(each.id.as_str()) {
            let message = format!("a partner before has the id {:?} too", shorten(&each.id));
            remarks.error("scenario.duplicate-id", format!("{path}.id"), message, "give each partner its own id");
        }
        partners.push(partner(each, format_args!("{path}"), remarks));
    }
    let obstacles = draft.obstacles.iter().enumerate().map(|(n, each)| obstacle(each, n, remarks)).collect();
    Fit { counts: partners_fit && obstacles_fit, map, ego, partners, obstacles }
}

fn map(map: &MapSpec, remarks: &mut Remarks) -> bool {
    if let Some(roads) = map.network() {
        return graph::numbers(roads, remarks);
    }
    let shared = map.carriageway();
    let mut fit = true;
    if !(1..=4).contains(&shared.lanes) {
        let message = format!("lanes is {}, out of range", shared.lanes);
        remarks.error("scenario.range", "map.lanes", message, "allowed: 1 to 4 in each direction");
        fit = false;
    }
    let width_fits = remarks.number("map.lane_width_m", shared.lane_width_m, 2.5, 4.5, "m");
    fit &= width_fits;
    fit &= remarks.number("map.approach_m", shared.approach_m, 20.0, 300.0, "m");
    match map {
        MapSpec::S(m) => fit &= remarks.number("map.length_m", m.length_m, 20.0, 600.0, "m"),
        MapSpec::C(m) => {
            fit &= remarks.number("map.length_m", m.length_m, 10.0, 300.0, "m");
            fit &= remarks.number("map.angle_deg", m.angle_deg, 10.0, 135.0, "deg");
            let radius_fits = remarks.number("map.radius_m", m.radius_m, 15.0, 200.0, "m");
            fit &= radius_fits;
            if radius_fits && width_fits && m.direction == recrash_model::narrative::Side::Left {
                let inner = f64::from(2 * shared.lanes.min(4)) * shared.lane_width_m - shared.lane_width_m;
                let least = inner + MIN_LANE_RADIUS_M;
                if m.radius_m < least {
                    let message = format!(
                        "with {} lanes of {} m each way the innermost oncoming lane of this left curve would have a radius of {} m",
                        shared.lanes,
                        shown(shared.lane_width_m),
                        shown(m.radius_m - inner)
                    );
                    let hint = format!("allowed: radius_m from {} m, or fewer lanes, or a right curve", shown(least));
                    remarks.error("scenario.curve-too-tight", "map.radius_m", message, hint);
                    fit = false;
                }
            }
        }
        MapSpec::X(m) => fit &= remarks.number("map.arm_m", m.arm_m, 20.0, 300.0, "m"),
        MapSpec::T(m) => fit &= remarks.number("map.arm_m", m.arm_m, 20.0, 300.0, "m"),
        MapSpec::O(m) => {
            fit &= remarks.number("map.arm_m", m.arm_m, 20.0, 300.0, "m");
            fit &= remarks.number("map.exit_radius_m", m.exit_radius_m, 5.0, 15.0, "m");
            fit &= remarks.number("map.inner_radius_m", m.inner_radius_m, 15.0, 45.0, "m");
        }
        MapSpec::G(_) => {}
    }
    fit
}

/// Whether what a placement needs is in range.
fn partner(partner: &Partner, path: At<'_>, remarks: &mut Remarks) -> bool {
    let mut fit = remarks.number(format_args!("{path}.speed_mps"), partner.speed_mps, 0.0, MAX_SPEED_MPS, "m/s");
    match partner.start {
        Start::Offset { delta_s_m, delta_t_m } => {
            fit &= remarks.number(format_args!("{path}.start.delta_s_m"), delta_s_m, -1000.0, 1000.0, "m");
            fit &= remarks.number(format_args!("{path}.start.delta_t_m"), delta_t_m, -10.0, 10.0, "m");
        }
        Start::ArrivalGap { arrival_gap_s } => {
            fit &= remarks.number(format_args!("{path}.start.arrival_gap_s"), arrival_gap_s, -60.0, 60.0, "s");
        }
    }
    for (position, step) in partner.lateral.iter().enumerate() {
        lateral(step, format_args!("{path}.lateral[{position}]"), remarks);
    }
    remarks.count(format_args!("{path}.lateral"), partner.lateral.len(), 32);
    policy(&partner.policy, format_args!("{path}.policy"), remarks) && fit
}

fn lateral(step: &LateralMove, path: At<'_>, remarks: &mut Remarks) {
    remarks.number(format_args!("{path}.start_s"), step.start_s, 0.0, 120.0, "s");
    remarks.number(format_args!("{path}.duration_s"), step.duration_s, 0.5, 120.0, "s");
    remarks.number(format_args!("{path}.to_t_m"), step.to_t_m, -10.0, 10.0, "m");
}

fn policy(policy: &Policy, path: At<'_>, remarks: &mut Remarks) -> bool {
    let gain = |kp: Option<f64>, remarks: &mut Remarks| {
        if let Some(kp) = kp {
            remarks.number(format_args!("{path}.speed_kp"), kp, 0.01, 10.0, "throttle per m/s");
        }
    };
    // IDM divides by the speed it wants, so that may not be nothing.
    let least_idm_speed = 0.5;
    match *policy {
        Policy::SuddenBrake { target_speed, brake_step, brake_steps, speed_kp } => {
            remarks.steps(format_args!("{path}.brake_step"), brake_step);
            remarks.steps(format_args!("{path}.brake_steps"), brake_steps);
            gain(speed_kp, remarks);
            remarks.number(format_args!("{path}.target_speed"), target_speed, 0.0, MAX_SPEED_MPS, "m/s")
        }
        Policy::AccelThenBrake { accel_mag, accel_steps, cruise_speed, brake_step, brake_steps, speed_kp } => {
            remarks.number(format_args!("{path}.accel_mag"), accel_mag, -1.0, 1.0, "");
            remarks.steps(format_args!("{path}.accel_steps"), accel_steps);
            remarks.steps(format_args!("{path}.brake_step"), brake_step);
            remarks.steps(format_args!("{path}.brake_steps"), brake_steps);
            gain(speed_kp, remarks);
            remarks.number(format_args!("{path}.cruise_speed"), cruise_speed, 0.0, MAX_SPEED_MPS, "m/s")
        }
        Policy::IdmNominal { target_speed_mps } => remarks.number(
            format_args!("{path}.target_speed_mps"),
            target_speed_mps,
            least_idm_speed,
            MAX_SPEED_MPS,
            "m/s",
        ),
        Policy::Stopped { depart_step, target_speed_mps } => {
            if let Some(step) = depart_step {
                remarks.steps(format_args!("{path}.depart_step"), step);
            }
            let least = if depart_step.is_some() { least_idm_speed } else { 0.0 };
            remarks.number(format_args!("{path}.target_speed_mps"), target_speed_mps, least, MAX_SPEED_MPS, "m/s")
        }
        Policy::Yielding { target_speed_mps, gap_s } => {
            remarks.number(format_args!("{path}.gap_s"), gap_s, 0.0, 20.0, "s");
            remarks.number(
                format_args!("{path}.target_speed_mps"),
                target_speed_mps,
                least_idm_speed,
                MAX_SPEED_MPS,
                "m/s",
            )
        }
    }
}

fn obstacle(obstacle: &Obstacle, position: usize, remarks: &mut Remarks) -> bool {
    let along = remarks.number(format_args!("obstacles[{position}].s_m"), obstacle.s_m, 0.0, 2000.0, "m");
    let across = remarks.number(format_args!("obstacles[{position}].t_m"), obstacle.t_m, -50.0, 50.0, "m");
    along && across
}
