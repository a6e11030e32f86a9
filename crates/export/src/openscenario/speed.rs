//! Policies as speed actions: when each begins, and how the speed goes from there.

use super::Context;
use super::lateral::offset_at;
use super::places::reference_point;
use crate::xml::{Element, number, rounded};
use recrash_model::rollout::{EventKind, STEP_S};
use recrash_model::scenario::{DEFAULT_SPEED_KP, Policy};
use recrash_model::vehicle::VehicleSpec;

/// Speeds nearer to their target than this have reached it. [m/s]
const REACHED_MPS: f64 = 0.02;

/// A straight piece of a speed profile stays this near to the curve it stands for. [m/s]
const PROFILE_TOLERANCE_MPS: f64 = 0.02;

/// A part of a policy: from when on, and what then.
pub(super) struct Phase {
    /// Name of its event.
    pub name: &'static str,
    /// Time it begins at, as an attribute value.
    pub start: String,
    /// The action.
    pub action: Element,
}

/// Speed at every step of 0.1 s.
struct Curve(Vec<f64>);

impl Curve {
    fn at(&self, time_s: f64) -> f64 {
        let position = (time_s / STEP_S).max(0.0);
        let before = position.floor() as usize;
        let last = self.0.len() - 1;
        let (a, b) = (self.0[before.min(last)], self.0[(before + 1).min(last)]);
        a + (b - a) * (position - position.floor())
    }

    /// Every step from one time to another, two at least.
    fn between(&self, from_s: f64, to_s: f64) -> Vec<f64> {
        let count = (((to_s - from_s) / STEP_S).round() as usize).max(1);
        (0..=count).map(|step| self.at(from_s + step as f64 * STEP_S)).collect()
    }
}

/// The parts of a partner's policy, in order of time.
pub(super) fn phases(context: &Context<'_>, position: usize) -> Vec<Phase> {
    let draft = context.scenario.draft();
    let partner = &draft.partners[position];
    let spec = VehicleSpec::of(partner.kind);
    let nominal = nominal_curve(&partner.policy, partner.speed_mps, &spec, draft.duration_s);
    let recorded = recorded_curve(context, position);
    let end_s = draft.duration_s;
    let pointer = |field: &str| format!("/partners/{position}/policy/{field}");
    let named = |field: &str, value: f64| context.names.reference(&pointer(field), value);
    let initial = context.names.reference(&format!("/partners/{position}/speed_mps"), partner.speed_mps);
    let curve = recorded.as_ref().unwrap_or(&nominal);
    let steps = |value: &str| format!("${{{value} * 0.1}}");
    let after = |from: &str, count: &str| format!("${{({from} + {count}) * 0.1}}");
    let in_seconds = |step: u32| f64::from(step) * STEP_S;
    let zero = || "0".to_owned();
    let hold = |from_s: f64, to_s: f64, target: (&str, f64), start: Option<(&str, f64)>| {
        approach(curve, from_s, to_s.min(end_s), target, start)
    };
    let alone = |curve: &Curve| {
        vec![Phase { name: "drive", start: zero(), action: profile(curve, 0.0, end_s, |speed| number(rounded(speed))) }]
    };
    match partner.policy {
        // Braking within the throttle's time: the parts would not follow one another.
        Policy::AccelThenBrake { accel_steps, brake_step, brake_steps, .. }
            if brake_steps > 0 && brake_step < accel_steps =>
        {
            alone(curve)
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
            if accel_steps > 0 {
                let reached = curve.at(cruise_s);
                // The speed at the end of the throttle, told as what it depends on where that is exact.
                let free = partner.speed_mps + accel_mag.max(0.0) * spec.max_acceleration_mps2 * cruise_s;
                let target = if accel_mag >= 0.0 && (free - reached).abs() < 0.3 {
                    let rate = number(rounded(spec.max_acceleration_mps2 * STEP_S));
                    format!("${{{initial} + {accelerate} * {rate} * {during}}}")
                } else {
                    number(rounded(reached))
                };
                list.push(Phase {
                    name: "throttle",
                    start: zero(),
                    action: speed_action("linear", "time", &steps(&during), &target),
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
            let action = match &recorded {
                Some(recorded) => return alone(recorded),
                None => hold(0.0, end_s, (&target, target_speed_mps), Some((&initial, partner.speed_mps))),
            };
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
fn approach(curve: &Curve, from_s: f64, to_s: f64, target: (&str, f64), start: Option<(&str, f64)>) -> Element {
    let (name, target_mps) = target;
    let reached = |speed: f64| (speed - target_mps).abs() < REACHED_MPS;
    if start.is_none_or(|(_, speed)| reached(speed)) && curve.between(from_s, to_s).iter().all(|&speed| reached(speed))
    {
        return speed_at_once(name);
    }
    profile(curve, from_s, to_s, |speed| {
        if reached(speed) {
            return name.to_owned();
        }
        // On the way from one to the other it is a mix of both.
        if let Some((start_name, start_mps)) = start
            && (start_mps - target_mps).abs() > REACHED_MPS
            && (start_mps.min(target_mps)..=start_mps.max(target_mps)).contains(&speed)
        {
            let share = (speed - start_mps) / (target_mps - start_mps);
            return format!("${{{start_name} * {} + {name} * {}}}", short(1.0 - share), short(share));
        }
        if target_mps > 0.0 { format!("${{{name} * {}}}", short(speed / target_mps)) } else { number(rounded(speed)) }
    })
}

/// Four decimals: well within what a profile stands for. Never negative: `- -0.1` is no expression everywhere.
fn short(value: f64) -> String {
    number((value.max(0.0) * 1e4).round() / 1e4)
}

/// The curve between two times as a speed profile of straight pieces.
fn profile(curve: &Curve, from_s: f64, to_s: f64, write: impl Fn(f64) -> String) -> Element {
    let speeds = curve.between(from_s, to_s);
    let count = speeds.len() - 1;
    let mut corners = Vec::new();
    simplify(&speeds, 0, count, &mut corners);
    corners.push(count);
    // Nothing is said by holding a speed to the end.
    if let [.., before, end] = corners[..]
        && (speeds[before] - speeds[end]).abs() < REACHED_MPS
    {
        corners.pop();
    }
    let mut last = 0;
    let entries: Vec<Element> = corners
        .into_iter()
        .map(|corner| {
            let time = (corner - last) as f64 * STEP_S;
            last = corner;
            Element::new("SpeedProfileEntry").with("speed", write(speeds[corner])).with_number("time", rounded(time))
        })
        .collect();
    longitudinal(Element::new("SpeedProfileAction").with("followingMode", "position").children(entries))
}

/// Corners between two ends of a polyline that stays near all points (Ramer, Douglas and Peucker), in order.
fn simplify(speeds: &[f64], first: usize, last: usize, corners: &mut Vec<usize>) {
    let slope = (speeds[last] - speeds[first]) / (last - first).max(1) as f64;
    let off = |position: usize| (speeds[position] - speeds[first] - slope * (position - first) as f64).abs();
    let farthest = (first + 1..last).max_by(|&a, &b| off(a).total_cmp(&off(b)));
    if let Some(corner) = farthest.filter(|&corner| off(corner) > PROFILE_TOLERANCE_MPS) {
        simplify(speeds, first, corner, corners);
        corners.push(corner);
        simplify(speeds, corner, last, corners);
    }
}

/// How fast the partner moved along its way in the rollout, up to its first contact.
///
/// Not its speed over ground: a vehicle that sways or cuts a curve is faster than it gets on, and actions know no swaying.
fn recorded_curve(context: &Context<'_>, position: usize) -> Option<Curve> {
    let rollout = context.rollout?;
    let actor = position + 1;
    let track = rollout.actors.get(actor)?;
    let contact_s = rollout.events.iter().find_map(|event| match event.kind {
        EventKind::Contact { a, b, .. } if a == actor || b == actor => Some(event.time_s),
        EventKind::ObstacleContact { actor: who, .. } if who == actor => Some(event.time_s),
        _ => None,
    });
    let count = track.states.len();
    let until = contact_s.map_or(count, |time| (time / STEP_S).floor() as usize + 1).min(count);
    if until < 3 {
        return None;
    }
    let path = &context.scenario.partners()[position].path;
    let mut segment = 0;
    let draft = context.scenario.draft();
    let partner = &draft.partners[position];
    // A metre of the lane's centre is more or less than a metre beside it, where the lane bends.
    let places: Vec<(f64, f64)> = track.states[..until]
        .iter()
        .enumerate()
        .map(|(step, state)| {
            let point = reference_point(track.kind, state.pose()).position;
            let found = path.project(context.scenario.network(), point, segment);
            segment = found.segment;
            (found.s, 1.0 + path.curvature(found.s) * offset_at(partner, step as f64 * STEP_S))
        })
        .collect();
    let speed = |from: usize, at: usize, to: usize| {
        let time = (to - from) as f64 * STEP_S;
        ((places[to].0 - places[from].0) * places[at].1 / time).max(0.0)
    };
    let mut speeds = vec![track.states[0].speed];
    speeds.extend((1..until - 1).map(|step| speed(step - 1, step, step + 1)));
    speeds.push(speed(until - 2, until - 1, until - 1));
    // Behind the end of the record it goes on as its policy would.
    let spec = VehicleSpec::of(track.kind);
    let mut speed = speeds[until - 1];
    let steps = (draft.duration_s / STEP_S).ceil() as usize;
    for step in until..=steps {
        speed = next_speed(&partner.policy, speed, u32::try_from(step - 1).unwrap_or(u32::MAX), &spec);
        speeds.push(speed);
    }
    Some(Curve(speeds))
}

/// What a policy does to the speed with nobody else on the road: `docs/models/policies.md`, without tyres.
fn nominal_curve(policy: &Policy, start_mps: f64, spec: &VehicleSpec, duration_s: f64) -> Curve {
    let steps = (duration_s / STEP_S).ceil() as u32;
    let mut speeds = vec![start_mps];
    let mut speed = start_mps;
    for step in 0..steps {
        speed = next_speed(policy, speed, step, spec);
        speeds.push(speed);
    }
    Curve(speeds)
}

fn next_speed(policy: &Policy, speed: f64, step: u32, spec: &VehicleSpec) -> f64 {
    let hold = |target: f64, gain: Option<f64>| gain.unwrap_or(DEFAULT_SPEED_KP) * (target - speed);
    let braking = |from: u32, count: u32| (from..from.saturating_add(count)).contains(&step);
    let throttle = match *policy {
        Policy::SuddenBrake { brake_step, brake_steps, .. }
        | Policy::AccelThenBrake { brake_step, brake_steps, .. }
            if braking(brake_step, brake_steps) =>
        {
            -1.0
        }
        Policy::AccelThenBrake { accel_mag, accel_steps, .. } if step < accel_steps => accel_mag,
        Policy::SuddenBrake { target_speed, speed_kp, .. } => hold(target_speed, speed_kp),
        Policy::AccelThenBrake { cruise_speed, speed_kp, .. } => hold(cruise_speed, speed_kp),
        Policy::IdmNominal { target_speed_mps } if target_speed_mps > 0.0 => {
            1.0 - recrash_model::math::pow(speed / target_speed_mps, 10.0)
        }
        Policy::Stopped { depart_step, .. } if depart_step.is_none_or(|depart| step < depart) => -1.0,
        Policy::Stopped { target_speed_mps, .. }
        | Policy::Yielding { target_speed_mps, .. }
        | Policy::IdmNominal { target_speed_mps } => hold(target_speed_mps, None),
    }
    .clamp(-1.0, 1.0);
    let acceleration = if throttle < 0.0 {
        (throttle * spec.brake_demand_mps2).max(-spec.max_deceleration_mps2)
    } else if speed > spec.max_speed_mps {
        0.0
    } else {
        throttle * spec.max_acceleration_mps2
    };
    (speed + acceleration * STEP_S).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::record::PartnerKind;

    const CAR: VehicleSpec = VehicleSpec::of(PartnerKind::PassengerCar);

    #[test]
    fn full_brake_from_ten_metres_per_second_takes_two_thirds_of_a_second() {
        let policy = Policy::SuddenBrake { target_speed: 10.0, brake_step: 0, brake_steps: 20, speed_kp: None };
        let curve = nominal_curve(&policy, 10.0, &CAR, 2.0);
        // 10 / 15.13 = 0.66 s: moving after 0.6 s, standing after 0.7 s.
        assert!((curve.at(0.6) - (10.0 - 0.6 * 15.13)).abs() < 1e-9);
        assert!(curve.at(0.7) < 1e-9);
        assert_eq!(curve.at(2.0), 0.0);
    }

    #[test]
    fn throttle_is_a_share_of_the_engines_acceleration() {
        let policy = Policy::AccelThenBrake {
            accel_mag: 0.5,
            accel_steps: 20,
            cruise_speed: 20.0,
            brake_step: 200,
            brake_steps: 1,
            speed_kp: None,
        };
        let curve = nominal_curve(&policy, 8.0, &CAR, 2.0);
        assert!((curve.at(2.0) - (8.0 + 2.0 * 0.5 * CAR.max_acceleration_mps2)).abs() < 1e-9);
    }

    #[test]
    fn a_straight_piece_has_no_corners_and_a_bend_has_one() {
        let mut corners = Vec::new();
        simplify(&[0.0, 1.0, 2.0, 3.0], 0, 3, &mut corners);
        assert_eq!(corners, [] as [usize; 0]);
        simplify(&[0.0, 1.0, 2.0, 2.0, 2.0], 0, 4, &mut corners);
        assert_eq!(corners, [2]);
    }
}
