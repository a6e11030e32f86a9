//! Policies as speed actions: when each begins, and how the speed goes from there.

use super::Context;
use super::driven::{Driven, corners};
use crate::xml::{Element, number, rounded};
use recrash_model::rollout::STEP_S;
use recrash_model::scenario::Policy;
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::{Alone, Plan, Way};

/// Speeds nearer to their target than this have reached it. [m/s]
const REACHED_MPS: f64 = 0.005;

/// A straight piece of a speed profile stays this near to the curve it stands for, in speed and in distance since the
/// piece began. [m/s], [m]
const PROFILE_TOLERANCE: (f64, f64) = (0.05, 0.02);

/// A part of a policy: from when on, and what then.
pub(super) struct Phase {
    /// Name of its event.
    pub name: &'static str,
    /// Time it begins at, as an attribute value.
    pub start: String,
    /// The action.
    pub action: Element,
}

/// The speed at every step from one time to another, two at least. [m/s]
fn between(curve: &Alone, from_s: f64, to_s: f64) -> Vec<f64> {
    let count = (((to_s - from_s) / STEP_S).round() as usize).max(1);
    (0..=count).map(|step| curve.speed(from_s + step as f64 * STEP_S)).collect()
}

/// The parts of a partner's policy, in order of time.
pub(super) fn phases(context: &Context<'_>, position: usize, driven: Option<&Driven>) -> Vec<Phase> {
    let draft = context.scenario.draft();
    let partner = &draft.partners[position];
    let spec = VehicleSpec::of(partner.kind);
    let curve = curve(context, position, driven);
    let end_s = draft.duration_s;
    let pointer = |field: &str| format!("/partners/{position}/policy/{field}");
    let named = |field: &str, value: f64| context.names.reference(&pointer(field), value);
    let initial = context.names.reference(&format!("/partners/{position}/speed_mps"), partner.speed_mps);
    let steps = |value: &str| format!("${{{value} * 0.1}}");
    let after = |from: &str, count: &str| format!("${{({from} + {count}) * 0.1}}");
    let in_seconds = |step: u32| f64::from(step) * STEP_S;
    let zero = || "0".to_owned();
    let hold = |from_s: f64, to_s: f64, target: (&str, f64), start: Option<(&str, f64)>| {
        approach(&curve, from_s, to_s.min(end_s), target, start)
    };
    match partner.policy {
        // Braking within the throttle's time: the parts would not follow one another.
        Policy::AccelThenBrake { accel_steps, brake_step, brake_steps, .. }
            if brake_steps > 0 && brake_step < accel_steps =>
        {
            let action = profile(&curve, 0.0, end_s, |speed| number(rounded(speed)), plain_time);
            vec![Phase { name: "drive", start: zero(), action }]
        }
        Policy::SuddenBrake { target_speed, brake_step, brake_steps, .. } => {
            let target = named("target_speed", target_speed);
            let (from, count) =
                (named("brake_step", f64::from(brake_step)), named("brake_steps", f64::from(brake_steps)));
            let (brake_s, again_s) = (in_seconds(brake_step), in_seconds(brake_step.saturating_add(brake_steps)));
            let mut list = Vec::new();
            if brake_step > 0 || brake_steps == 0 {
                let until = if brake_steps == 0 { end_s } else { brake_s };
                let first = Some((initial.as_str(), partner.speed_mps));
                list.push(Phase {
                    name: "hold",
                    start: zero(),
                    action: hold(0.0, until, (&target, target_speed), first),
                });
            }
            if brake_steps > 0 {
                list.push(Phase { name: "brake", start: steps(&from), action: brake(&spec) });
                list.push(Phase {
                    name: "go on",
                    start: after(&from, &count),
                    action: hold(again_s, end_s, (&target, target_speed), None),
                });
            }
            list
        }
        Policy::AccelThenBrake { accel_mag, accel_steps, cruise_speed, brake_step, brake_steps, .. } => {
            let cruise = named("cruise_speed", cruise_speed);
            let (accelerate, during) = (named("accel_mag", accel_mag), named("accel_steps", f64::from(accel_steps)));
            let (from, count) =
                (named("brake_step", f64::from(brake_step)), named("brake_steps", f64::from(brake_steps)));
            let (cruise_s, brake_s) = (in_seconds(accel_steps), in_seconds(brake_step));
            let again_s = in_seconds(brake_step.saturating_add(brake_steps));
            let mut list = Vec::new();
            // The speed that the throttle alone would lead to, as what it depends on.
            let free_mps = partner.speed_mps + accel_mag * spec.max_acceleration_mps2 * cruise_s;
            let rate = number(rounded(spec.max_acceleration_mps2 * STEP_S));
            let free = format!("({initial} + {accelerate} * {rate} * {during})");
            if accel_steps > 0 {
                let ends = ((initial.as_str(), partner.speed_mps), (free.as_str(), free_mps));
                let speed = |speed: f64| mixed(ends.0, ends.1, speed).unwrap_or_else(|| number(rounded(speed)));
                let time = |time_s: f64| format!("${{{during} * {}}}", short(time_s / f64::from(accel_steps)));
                list.push(Phase {
                    name: "throttle",
                    start: zero(),
                    action: profile(&curve, 0.0, cruise_s, speed, time),
                });
            }
            let start = if accel_steps > 0 { steps(&during) } else { zero() };
            let first = (accel_steps == 0).then_some((initial.as_str(), partner.speed_mps));
            if brake_step > accel_steps || brake_steps == 0 {
                let until = if brake_steps == 0 { end_s } else { brake_s };
                let action = hold(cruise_s, until, (&cruise, cruise_speed), first);
                list.push(Phase { name: "cruise", start, action });
            }
            if brake_steps > 0 {
                list.push(Phase { name: "brake", start: steps(&from), action: brake(&spec) });
                list.push(Phase {
                    name: "go on",
                    start: after(&from, &count),
                    action: hold(again_s, end_s, (&cruise, cruise_speed), None),
                });
            }
            list
        }
        Policy::Stopped { depart_step, target_speed_mps } => {
            let mut list = vec![Phase { name: "stand", start: zero(), action: brake(&spec) }];
            if let Some(step) = depart_step {
                let (from, target) =
                    (named("depart_step", f64::from(step)), named("target_speed_mps", target_speed_mps));
                list.push(Phase {
                    name: "set off",
                    start: steps(&from),
                    action: hold(in_seconds(step), end_s, (&target, target_speed_mps), None),
                });
            }
            list
        }
        // These react to others, which no action can: with a rollout, what they did there; else what they would do alone.
        Policy::IdmNominal { target_speed_mps } | Policy::Yielding { target_speed_mps, .. } => {
            let target = named("target_speed_mps", target_speed_mps);
            let action = hold(0.0, end_s, (&target, target_speed_mps), Some((&initial, partner.speed_mps)));
            vec![Phase { name: "drive", start: zero(), action }]
        }
    }
}

/// Full brake to a stand.
pub(super) fn brake(spec: &VehicleSpec) -> Element {
    speed_action("linear", "rate", &number(spec.max_deceleration_mps2), "0")
}

/// A speed at once.
pub(super) fn speed_at_once(speed: &str) -> Element {
    speed_action("step", "time", "0", speed)
}

fn speed_action(shape: &str, dimension: &str, value: &str, target: &str) -> Element {
    longitudinal(
        Element::new("SpeedAction").children([
            Element::new("SpeedActionDynamics")
                .with("dynamicsShape", shape)
                .with("value", value)
                .with("dynamicsDimension", dimension),
            Element::new("SpeedActionTarget").child(Element::new("AbsoluteTargetSpeed").with("value", target)),
        ]),
    )
}

fn longitudinal(action: Element) -> Element {
    Element::new("PrivateAction").child(Element::new("LongitudinalAction").child(action))
}

/// From the speed it has to a target, along the curve between two times; in terms of the target's name, and of the
/// speed at the start where that has one.
fn approach(curve: &Alone, from_s: f64, to_s: f64, target: (&str, f64), start: Option<(&str, f64)>) -> Element {
    let (name, target_mps) = target;
    let reached = |speed: f64| (speed - target_mps).abs() < REACHED_MPS;
    if start.is_none_or(|(_, speed)| reached(speed)) && between(curve, from_s, to_s).iter().all(|&speed| reached(speed))
    {
        return speed_at_once(name);
    }
    let write = |speed: f64| {
        if reached(speed) {
            return name.to_owned();
        }
        // On the way from one to the other it is a mix of both.
        if let Some(mix) = start.and_then(|start| mixed(start, target, speed)) {
            return mix;
        }
        if target_mps > 0.0 { format!("${{{name} * {}}}", short(speed / target_mps)) } else { number(rounded(speed)) }
    };
    profile(curve, from_s, to_s, write, plain_time)
}

/// A speed between two others that have names, as a mix of them.
fn mixed((start, start_mps): (&str, f64), (end, end_mps): (&str, f64), speed: f64) -> Option<String> {
    let between = (start_mps.min(end_mps)..=start_mps.max(end_mps)).contains(&speed);
    let share = (speed - start_mps) / (end_mps - start_mps);
    let apart = (start_mps - end_mps).abs() > 0.3;
    (between && apart).then(|| format!("${{{start} * {} + {end} * {}}}", short(1.0 - share), short(share)))
}

/// Five decimals: well within what a profile stands for. Never negative: `- -0.1` is no expression everywhere.
fn short(value: f64) -> String {
    number((value.max(0.0) * 1e5).round() / 1e5)
}

fn plain_time(seconds: f64) -> String {
    number(rounded(seconds))
}

/// The curve between two times as a speed profile of straight pieces.
fn profile(
    curve: &Alone,
    from_s: f64,
    to_s: f64,
    write: impl Fn(f64) -> String,
    write_time: impl Fn(f64) -> String,
) -> Element {
    let speeds = between(curve, from_s, to_s);
    let mut distances = vec![0.0];
    for pair in speeds.windows(2) {
        distances.push(distances[distances.len() - 1] + 0.5 * (pair[0] + pair[1]) * STEP_S);
    }
    let off = |first: usize, position: usize, last: usize| {
        let slope = (speeds[last] - speeds[first]) / (last - first) as f64;
        let along = (position - first) as f64;
        let speed = speeds[position] - speeds[first] - slope * along;
        let distance = distances[position] - distances[first] - (speeds[first] + 0.5 * slope * along) * along * STEP_S;
        (speed.abs(), (speed.abs() / PROFILE_TOLERANCE.0).max(distance.abs() / PROFILE_TOLERANCE.1))
    };
    let last = speeds.len() - 1;
    let mut found = corners(0, last, &off);
    // Nothing is said by holding a speed to the end.
    let holds = found.last().is_some_and(|&before| (speeds[before] - speeds[last]).abs() < REACHED_MPS);
    if !holds {
        found.push(last);
    }
    let mut before = 0;
    let entries: Vec<Element> = found
        .into_iter()
        .map(|corner| {
            let time = (corner - before) as f64 * STEP_S;
            before = corner;
            Element::new("SpeedProfileEntry").with("speed", write(speeds[corner])).with("time", write_time(time))
        })
        .collect();
    longitudinal(Element::new("SpeedProfileAction").with("followingMode", "position").children(entries))
}

/// Speeds at the steps of a scenario: those of the rollout, and behind them what the plan does alone.
fn curve(context: &Context<'_>, position: usize, driven: Option<&Driven>) -> Alone {
    let draft = context.scenario.draft();
    let (partner, placement) = (&draft.partners[position], &context.scenario.partners()[position]);
    let plan = Plan::new(partner.kind, &partner.policy, placement.t_m, draft.environment.surface);
    let way = Way::new(context.scenario, position, &plan);
    let speeds = driven.map_or_else(|| vec![partner.speed_mps], Driven::speeds);
    Alone::after(&plan, &way, placement.s_m, speeds, draft.duration_s)
}
