//! Policies as speed actions: when each begins, and how the speed goes from there.

use super::Context;
use super::driven::{Driven, corners};
use crate::xml::{Element, number, rounded};
use recrash_model::rollout::STEP_S;
use recrash_model::scenario::{Partner, Policy};
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::{Alone, Plan, Way};
use std::ops::Range;

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
    let writer = Writer::new(context, position, driven);
    match writer.partner.policy {
        // Braking within the throttle's time: the parts would not follow one another.
        Policy::AccelThenBrake { accel_steps, brake_step, brake_steps, .. }
            if brake_steps > 0 && brake_step < accel_steps =>
        {
            vec![writer.as_it_is()]
        }
        Policy::SuddenBrake { target_speed, brake_step, brake_steps, .. } => {
            let target = writer.named("target_speed", target_speed);
            let braking = writer.braking(brake_step, brake_steps);
            let mut list = Vec::new();
            if brake_step > 0 || brake_steps == 0 {
                list.push(writer.hold("hold", at_once(), 0.0..writer.until(&braking), &target, Some(&writer.initial)));
            }
            list.extend(writer.brake_and_go_on(&braking, &target));
            list
        }
        Policy::AccelThenBrake { accel_mag, accel_steps, cruise_speed, brake_step, brake_steps, .. } => {
            let cruise = writer.named("cruise_speed", cruise_speed);
            let during = writer.named("accel_steps", f64::from(accel_steps));
            let braking = writer.braking(brake_step, brake_steps);
            let throttles = accel_steps > 0;
            let mut list = Vec::new();
            if throttles {
                list.push(writer.throttle(accel_mag, &during));
            }
            if brake_step > accel_steps || brake_steps == 0 {
                let start = if throttles { at_step(&during) } else { at_once() };
                let initial = (!throttles).then_some(&writer.initial);
                list.push(writer.hold("cruise", start, in_seconds(&during)..writer.until(&braking), &cruise, initial));
            }
            list.extend(writer.brake_and_go_on(&braking, &cruise));
            list
        }
        Policy::Stopped { depart_step, target_speed_mps } => {
            let mut list = vec![Phase { name: "stand", start: at_once(), action: brake(&writer.spec) }];
            if let Some(step) = depart_step {
                let from = writer.named("depart_step", f64::from(step));
                let target = writer.named("target_speed_mps", target_speed_mps);
                list.push(writer.hold("set off", at_step(&from), in_seconds(&from)..writer.end_s, &target, None));
            }
            list
        }
        // These react to others, which no action can: with a rollout, what they did there; else what they would do alone.
        Policy::IdmNominal { target_speed_mps } | Policy::Yielding { target_speed_mps, .. } => {
            let target = writer.named("target_speed_mps", target_speed_mps);
            vec![writer.hold("drive", at_once(), 0.0..writer.end_s, &target, Some(&writer.initial))]
        }
    }
}

/// A number of the scenario: as the file names it, and its value.
struct Named {
    name: String,
    value: f64,
}

/// The full brake of a policy, both in steps.
struct Braking {
    from: Named,
    during: Named,
}

impl Braking {
    /// Whether it brakes at all.
    fn happens(&self) -> bool {
        self.during.value > 0.0
    }
}

/// The beginning of the scenario, as an attribute value.
fn at_once() -> String {
    "0".to_owned()
}

/// The time of a step, as an attribute value.
fn at_step(step: &Named) -> String {
    format!("${{{} * 0.1}}", step.name)
}

/// The time of a step. [s]
fn in_seconds(step: &Named) -> f64 {
    step.value * STEP_S
}

/// What the parts of one partner's policy have in common.
struct Writer<'a> {
    context: &'a Context<'a>,
    position: usize,
    partner: &'a Partner,
    spec: VehicleSpec,
    curve: Alone,
    end_s: f64,
    /// Speed at the start. [m/s]
    initial: Named,
}

impl<'a> Writer<'a> {
    fn new(context: &'a Context<'a>, position: usize, driven: Option<&Driven>) -> Self {
        let draft = context.scenario.draft();
        let partner = &draft.partners[position];
        let name = context.names.reference(&format!("/partners/{position}/speed_mps"), partner.speed_mps);
        Self {
            context,
            position,
            partner,
            spec: VehicleSpec::of(partner.kind),
            curve: curve(context, position, driven),
            end_s: draft.duration_s,
            initial: Named { name, value: partner.speed_mps },
        }
    }

    /// A number of the policy.
    fn named(&self, field: &str, value: f64) -> Named {
        let pointer = format!("/partners/{}/policy/{field}", self.position);
        Named { name: self.context.names.reference(&pointer, value), value }
    }

    /// The brake of the policy.
    fn braking(&self, step: u32, steps: u32) -> Braking {
        Braking { from: self.named("brake_step", f64::from(step)), during: self.named("brake_steps", f64::from(steps)) }
    }

    /// The time at which it brakes, or the end where it never does. [s]
    fn until(&self, braking: &Braking) -> f64 {
        if braking.happens() { in_seconds(&braking.from) } else { self.end_s }
    }

    /// The whole drive as a profile without names.
    fn as_it_is(&self) -> Phase {
        let action = profile(&self.curve, 0.0, self.end_s, |speed| number(rounded(speed)), plain_time);
        Phase { name: "drive", start: at_once(), action }
    }

    /// A part in which a speed is reached and held, from the speed at the start where that is known.
    fn hold(
        &self,
        name: &'static str,
        start: String,
        time_s: Range<f64>,
        target: &Named,
        initial: Option<&Named>,
    ) -> Phase {
        let action = approach(&self.curve, time_s.start, time_s.end.min(self.end_s), target, initial);
        Phase { name, start, action }
    }

    /// A part with a constant throttle for so many steps.
    fn throttle(&self, magnitude: f64, during: &Named) -> Phase {
        let until_s = in_seconds(during);
        let accelerate = self.named("accel_mag", magnitude);
        // The speed that the throttle alone would lead to, as what it depends on.
        let rate = number(rounded(self.spec.max_acceleration_mps2 * STEP_S));
        let free = Named {
            name: format!("({} + {} * {rate} * {})", self.initial.name, accelerate.name, during.name),
            value: self.initial.value + magnitude * self.spec.max_acceleration_mps2 * until_s,
        };
        let speed = |speed: f64| mixed(&self.initial, &free, speed).unwrap_or_else(|| number(rounded(speed)));
        let time = |time_s: f64| format!("${{{} * {}}}", during.name, short(time_s / during.value));
        Phase { name: "throttle", start: at_once(), action: profile(&self.curve, 0.0, until_s, speed, time) }
    }

    /// The parts from the brake on: full brake, and then a speed again; none where it never brakes.
    fn brake_and_go_on(&self, braking: &Braking, target: &Named) -> Vec<Phase> {
        if !braking.happens() {
            return Vec::new();
        }
        let Braking { from, during } = braking;
        // As many steps as can be counted.
        let again = Named {
            name: format!("({} + {})", from.name, during.name),
            value: (from.value + during.value).min(f64::from(u32::MAX)),
        };
        vec![
            Phase { name: "brake", start: at_step(from), action: brake(&self.spec) },
            self.hold("go on", at_step(&again), in_seconds(&again)..self.end_s, target, None),
        ]
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
fn approach(curve: &Alone, from_s: f64, to_s: f64, target: &Named, start: Option<&Named>) -> Element {
    let Named { name, value: target_mps } = target;
    let reached = |speed: f64| (speed - target_mps).abs() < REACHED_MPS;
    if start.is_none_or(|start| reached(start.value))
        && between(curve, from_s, to_s).iter().all(|&speed| reached(speed))
    {
        return speed_at_once(name);
    }
    let write = |speed: f64| {
        if reached(speed) {
            return name.clone();
        }
        // On the way from one to the other it is a mix of both.
        if let Some(mix) = start.and_then(|start| mixed(start, target, speed)) {
            return mix;
        }
        if *target_mps > 0.0 { format!("${{{name} * {}}}", short(speed / target_mps)) } else { number(rounded(speed)) }
    };
    profile(curve, from_s, to_s, write, plain_time)
}

/// A speed between two others that have names, as a mix of them.
fn mixed(start: &Named, end: &Named, speed: f64) -> Option<String> {
    let between = (start.value.min(end.value)..=start.value.max(end.value)).contains(&speed);
    let share = (speed - start.value) / (end.value - start.value);
    let apart = (start.value - end.value).abs() > 0.3;
    (between && apart)
        .then(|| format!("${{{} * {} + {} * {}}}", start.name, short(1.0 - share), end.name, short(share)))
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
