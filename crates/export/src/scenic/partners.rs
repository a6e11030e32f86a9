//! The partners of a Scenic file: a behavior for each policy, and where each starts.

use super::{Context, constant, millimetres, road_user};
use crate::xml::{number, rounded};
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{Approach, DEFAULT_SPEED_KP, Policy, Start};
use recrash_plan::{Crossing, Plan, Way};
use recrash_roads::Footprint;

/// The name of a partner's object.
pub(super) fn variable(position: usize) -> String {
    format!("partner{}", position + 1)
}

/// The bends of a partner's way as `(begin, end, speed)`: where it slows, and to what. [m, m, m/s]
pub(super) fn bends(context: &Context<'_>, position: usize) -> Vec<String> {
    let draft = context.scenario.draft();
    let partner = &draft.partners[position];
    if partner.kind == PartnerKind::Pedestrian {
        return Vec::new();
    }
    let start_t_m = context.scenario.partners()[position].t_m;
    let plan = Plan::new(partner.kind, &partner.policy, start_t_m, draft.environment.surface);
    let text = |value: f64| number(millimetres(value));
    Way::new(context.scenario, position, &plan)
        .bends
        .iter()
        .map(|bend| format!("({}, {}, {})", text(bend.from_m), text(bend.to_m), text(bend.speed_mps)))
        .collect()
}

/// Where the way of a partner that gives way meets others' ways, a line each.
pub(super) fn crossings(context: &Context<'_>, position: usize) -> Vec<String> {
    if !matches!(context.scenario.draft().partners[position].policy, Policy::Yielding { .. }) {
        return Vec::new();
    }
    let (ego, partners) = (context.scenario.ego(), context.scenario.partners());
    let me = position + 1;
    let member = |number: usize| {
        let placement = if number == 0 { ego } else { &partners[number - 1] };
        (number, &placement.path, Footprint::of(placement.kind))
    };
    let text = |value: f64| if value.is_finite() { number(millimetres(value)) } else { "math.inf".to_owned() };
    (0..=partners.len())
        .filter(|&other| other != me)
        .filter_map(|other| {
            let (mine, theirs) = (member(me), member(other));
            let conflict = mine.1.conflict(theirs.1, mine.2.width_m, theirs.2.width_m)?;
            let crossing = Crossing::new(mine, theirs, conflict);
            let way = if other == 0 { "EGO_WAY".to_owned() } else { format!("PARTNER{other}_WAY") };
            let merges = if crossing.merges { "True" } else { "False" };
            let ends = [crossing.mine.from, crossing.mine.to, crossing.theirs.from, crossing.theirs.to].map(text);
            Some(format!("    ({other}, {way}, {merges}, {}),\n", ends.join(", ")))
        })
        .collect()
}

/// The definition of a partner's behavior.
pub(super) fn behavior(context: &Context<'_>, position: usize) -> String {
    let partner = &context.scenario.draft().partners[position];
    if partner.kind == PartnerKind::Pedestrian {
        return walk(context, position);
    }
    let writer = Writer::new(context, position);
    let number = position + 1;
    let head = format!("\nbehavior Partner{number}():    # \"{}\", {}\n", partner.id, policy_name(&partner.policy));
    head + &match partner.policy {
        Policy::SuddenBrake { target_speed, brake_step, brake_steps, speed_kp } => {
            let speed = writer.value("target_speed", target_speed);
            writer.holds(&hold(&speed, speed_kp)) + &writer.brakes(brake_step, brake_steps)
        }
        Policy::AccelThenBrake { accel_mag, accel_steps, cruise_speed, brake_step, brake_steps, speed_kp } => {
            let speed = writer.value("cruise_speed", cruise_speed);
            let throttle = writer.value("accel_mag", accel_mag);
            writer.holds(&hold(&speed, speed_kp))
                + &writer.window("0", &writer.step("accel_steps", accel_steps), &throttle)
                + &writer.brakes(brake_step, brake_steps)
        }
        Policy::IdmNominal { target_speed_mps } => {
            let speed = writer.value("target_speed_mps", target_speed_mps);
            writer.always(&format!("follow(self, {}, {speed})", writer.way))
        }
        Policy::Stopped { depart_step, target_speed_mps } => {
            let speed = writer.value("target_speed_mps", target_speed_mps);
            let until = depart_step.map_or_else(|| "math.inf".to_owned(), |from| writer.step("depart_step", from));
            writer.holds(&hold(&speed, None)) + &writer.window("0", &until, "-1")
        }
        Policy::Yielding { target_speed_mps, gap_s } => {
            let speed = writer.value("target_speed_mps", target_speed_mps);
            if crossings(context, position).is_empty() {
                writer.always(&hold(&speed, None))
            } else {
                writer.yields(&speed, &writer.value("gap_s", gap_s))
            }
        }
    }
}

/// The command that holds a speed.
fn hold(speed: &str, gain: Option<f64>) -> String {
    match gain {
        Some(gain) if gain != DEFAULT_SPEED_KP => format!("hold(self, {speed}, {})", number(gain)),
        _ => format!("hold(self, {speed})"),
    }
}

/// Writes the body of one partner's behavior.
struct Writer<'a> {
    context: &'a Context<'a>,
    position: usize,
    way: String,
    /// Its place across its lane.
    t: String,
    bends: String,
}

impl<'a> Writer<'a> {
    fn new(context: &'a Context<'a>, position: usize) -> Self {
        let number = position + 1;
        let bent = !bends(context, position).is_empty();
        Self {
            context,
            position,
            way: format!("PARTNER{number}_WAY"),
            t: lateral_term(context, position),
            bends: if bent { format!("PARTNER{number}_BENDS") } else { "()".to_owned() },
        }
    }

    /// A number of the policy.
    fn value(&self, field: &str, value: f64) -> String {
        self.context.value(&format!("/partners/{}/policy/{field}", self.position), value)
    }

    /// A step of the policy, as a time.
    fn step(&self, field: &str, value: u32) -> String {
        format!("{} * STEP", self.value(field, f64::from(value)))
    }

    fn take(&self, command: &str) -> String {
        format!("take drive(self, {}, {command}, {}, {})", self.way, self.t, self.bends)
    }

    /// A command that nothing interrupts.
    fn always(&self, command: &str) -> String {
        format!("    while True:\n        {}\n", self.take(command))
    }

    /// A command that windows interrupt.
    fn holds(&self, command: &str) -> String {
        format!("    try:\n        while True:\n            {}\n", self.take(command))
    }

    /// Another command for a while.
    fn window(&self, from: &str, until: &str, command: &str) -> String {
        format!("    interrupt when {from} <= seconds() + 1e-6 < {until}:\n        {}\n", self.take(command))
    }

    /// Full brake for some steps.
    fn brakes(&self, step: u32, steps: u32) -> String {
        let (from, during) = (self.step("brake_step", step), self.step("brake_steps", steps));
        self.window(&from, &format!("{from} + {during}"), "-1")
    }

    /// Holds a speed, and waits for who comes first.
    fn yields(&self, speed: &str, gap: &str) -> String {
        let Self { way, t, bends, .. } = self;
        format!(
            "    standing = 0\n    while True:\n        standing = standing + 1 if self.speed < STANDING else 0\n        \
             wait = wait_after(self, {way}, PARTNER{}_CROSSINGS, {speed}, {gap}, standing)\n        \
             take drive(self, {way}, {}, {t}, {bends}, wait)\n",
            self.position + 1,
            hold(speed, None)
        )
    }
}

/// A pedestrian walks along its way.
fn walk(context: &Context<'_>, position: usize) -> String {
    let partner = &context.scenario.draft().partners[position];
    let way = format!("PARTNER{}_WAY", position + 1);
    let (from, speed) = match partner.policy {
        Policy::Stopped { depart_step, target_speed_mps } => (
            depart_step.map_or_else(|| "math.inf".to_owned(), |step| number(rounded(f64::from(step) * 0.1))),
            target_speed_mps,
        ),
        _ => ("0".to_owned(), partner.policy.target_speed()),
    };
    format!(
        "\nbehavior Partner{0}():    # \"{1}\", walks\n    while True:\n        \
         take (SetWalkingDirectionAction(direction({way}, along({way}, self))),\n            \
         SetWalkingSpeedAction({2} if seconds() >= {from} else 0))\n",
        position + 1,
        partner.id,
        number(speed),
    )
}

/// The partner's object.
pub(super) fn instance(context: &Context<'_>, position: usize) -> String {
    let draft = context.scenario.draft();
    let partner = &draft.partners[position];
    let placement = &context.scenario.partners()[position];
    let at = |field: &str, value: f64| context.value(&format!("/partners/{position}/{field}"), value);
    let ego_s = context.value("/ego/s_m", draft.ego.s_m);
    let s = match partner.start {
        Start::Offset { delta_s_m, .. } => {
            let moved = at("start/delta_s_m", delta_s_m);
            let along = draft.ego.s_m + delta_s_m;
            match partner.approach {
                Approach::Opposite => format!("{} - ({ego_s} + {moved})", number(rounded(placement.s_m + along))),
                _ if rounded(placement.s_m - along) == 0.0 => format!("{ego_s} + {moved}"),
                _ => format!("{} + {ego_s} + {moved}", number(rounded(placement.s_m - along))),
            }
        }
        Start::ArrivalGap { arrival_gap_s } => match &placement.conflict {
            Some(conflict) => format!(
                "{} - {} * (({} - {ego_s}) / {} + {})",
                number(rounded(conflict.s_b)),
                target_name(context, position),
                number(rounded(conflict.s_a)),
                context.value("/ego/target_speed_mps", draft.ego.target_speed_mps),
                at("start/arrival_gap_s", arrival_gap_s),
            ),
            None => number(rounded(placement.s_m)),
        },
    };
    let t = match partner.start {
        Start::Offset { delta_t_m, .. } => at("start/delta_t_m", delta_t_m),
        Start::ArrivalGap { .. } => number(rounded(placement.t_m)),
    };
    let outline = recrash_model::geometry::OrientedBox::new(
        placement.pose,
        recrash_model::vehicle::VehicleSpec::of(placement.kind).length_m,
        recrash_model::vehicle::VehicleSpec::of(placement.kind).width_m,
    );
    let on_road = outline.corners().into_iter().all(|corner| context.scenario.network().on_road(corner));
    let speed = at("speed_mps", partner.speed_mps);
    let way = format!("PARTNER{}_WAY", position + 1);
    let behavior = format!("Partner{}()", position + 1);
    let at = super::on_way(&way, &format!("PARTNER{}_S", position + 1), &t);
    let begins = super::Placed { at: &at, speed: &speed };
    format!(
        "\nPARTNER{0}_S = {s}    # start along its way [m]\nrequire 0 <= PARTNER{0}_S <= PARTNER{0}_WAY.length\n{1} = {2}\n",
        position + 1,
        variable(position),
        road_user(context, placement, &begins, &behavior, on_road)
    )
}

/// The parameter that holds the speed a partner's policy wants.
fn target_name(context: &Context<'_>, position: usize) -> String {
    ["target_speed", "cruise_speed", "target_speed_mps"]
        .iter()
        .find_map(|field| context.names.find(&format!("/partners/{position}/policy/{field}")))
        .map_or_else(
            || number(context.scenario.draft().partners[position].policy.target_speed()),
            |found| constant(&found.name),
        )
}

/// The lateral target over time.
fn lateral_term(context: &Context<'_>, position: usize) -> String {
    let partner = &context.scenario.draft().partners[position];
    let start = context.scenario.partners()[position].t_m;
    let start_text = match partner.start {
        Start::Offset { .. } => context.value(&format!("/partners/{position}/start/delta_t_m"), start),
        Start::ArrivalGap { .. } => number(rounded(start)),
    };
    if partner.lateral.is_empty() {
        return if start == 0.0 && context.parameters.is_empty() { "0".to_owned() } else { start_text };
    }
    let moves: Vec<String> = partner
        .lateral
        .iter()
        .enumerate()
        .map(|(number_of, step)| {
            let at = |field: &str, value: f64| {
                context.value(&format!("/partners/{position}/lateral/{number_of}/{field}"), value)
            };
            format!(
                "({}, {}, {})",
                at("start_s", step.start_s),
                at("duration_s", step.duration_s),
                at("to_t_m", step.to_t_m)
            )
        })
        .collect();
    format!("lateral(self, {start_text}, [{}])", moves.join(", "))
}

fn policy_name(policy: &Policy) -> &'static str {
    match policy {
        Policy::SuddenBrake { .. } => "sudden_brake: holds a speed, brakes fully for a while, holds it again",
        Policy::AccelThenBrake { .. } => {
            "accel_then_brake: a throttle, a speed, full brake for a while, the speed again"
        }
        Policy::IdmNominal { .. } => "idm_nominal: MetaDrive's gap law",
        Policy::Stopped { .. } => "stopped: stands, then sets off",
        Policy::Yielding { .. } => "yielding: holds a speed, waits while the ego is about to come",
    }
}
