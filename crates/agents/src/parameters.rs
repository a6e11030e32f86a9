//! Which numbers of a scenario may move, and how far, while its narrative stays true.

use crate::rules::limits::{ground_of, most_speed, most_speed_of};
use crate::rules::staged::Facts;
use recrash_model::narrative::{Fact, FactSource, FactValue, FirstMover, Narrative};
use recrash_model::profile::SystemProfile;
use recrash_model::scenario::{Approach, Partner, Policy, ScenarioDraft, Start};
use recrash_model::tuning::Parameter;
use recrash_model::vehicle::VehicleSpec;

/// Speeds may differ by this share: police reports and readers of dashboards err by as much. Assumed.
const SPEED_SHARE: f64 = 0.3;
/// Arrival gaps may differ by this: about the time in which one car clears the way of another. Assumed. [s]
const GAP_TOLERANCE_S: f64 = 1.2;
/// Who was first may be told wrong by this much. Assumed. [s]
const ORDER_TOLERANCE_S: f64 = 0.3;
/// Starts along the road may differ by this: a car's length and a half. Assumed. [m]
const START_TOLERANCE_M: f64 = 7.0;
/// Starts across the lane may differ by this: a car keeps in its lane. Assumed. [m]
const LATERAL_TOLERANCE_M: f64 = 0.4;
/// Cones may differ by this across the road. Assumed. [m]
const CONE_TOLERANCE_M: f64 = 0.4;
/// Manoeuvres may begin this much sooner or later. Assumed. [s]
const TIME_TOLERANCE_S: f64 = 1.5;
/// Steps in a second.
const STEPS_PER_S: f64 = 10.0;

/// The numbers of a draft that may move, each with its bounds and the reason for them. The pointers are those of the
/// draft written as JSON.
///
/// An empty partner list gives the ego's speed alone. Bounds always hold the value the draft has.
pub fn parameters(draft: &ScenarioDraft, narrative: &Narrative, profile: &SystemProfile) -> Vec<Parameter> {
    let mut list = List { found: Vec::new() };
    let ground = ground_of(&draft.map);
    let least = profile.expresses.min_speed_mps;
    let most = most_speed(ground, draft.ego.turn).min(profile.expresses.max_speed_mps);
    let facts = Facts(&narrative.facts);
    let reason = speed_reason(facts.find_fact(|value| matches!(value, FactValue::SvSpeed { .. })));
    list.speed("/ego/target_speed_mps", draft.ego.target_speed_mps, (least, most), &reason);
    for (number, partner) in draft.partners.iter().enumerate() {
        let at = format!("/partners/{number}");
        let most = most_speed(ground, partner.turn).min(profile.expresses.max_speed_mps);
        let most = most.min(most_speed_of(partner.kind));
        list.start(&at, partner, draft, narrative);
        let reason = speed_reason(facts.find_fact(|value| matches!(value, FactValue::CpSpeed { .. })));
        list.policy(&at, partner, (0.5_f64.min(most), most), &reason);
        list.lateral(&at, partner, draft.map.carriageway().lane_width_m);
    }
    // The cone nearest to the ego's lane is the one that narrows its way.
    let nearest = (0..draft.obstacles.len())
        .min_by(|a, b| draft.obstacles[*a].t_m.abs().total_cmp(&draft.obstacles[*b].t_m.abs()));
    if let Some(number) = nearest {
        let t_m = draft.obstacles[number].t_m;
        let half_lane = 0.5 * draft.map.carriageway().lane_width_m + 0.1;
        let (mut min, mut max) = (t_m - CONE_TOLERANCE_M, t_m + CONE_TOLERANCE_M);
        // It stays on its side, out of the ego's lane.
        if t_m > half_lane {
            min = min.max(half_lane);
        } else if t_m < -half_lane {
            max = max.min(-half_lane);
        }
        let reason = "cones stand along the edge of the ego's lane, not in it";
        list.add(format!("/obstacles/{number}/t_m"), "m", (min, max), t_m, reason);
    }
    list.found
}

fn speed_reason(fact: Option<&Fact>) -> String {
    match fact.map(|fact| &fact.source) {
        Some(FactSource::Column { column, .. }) => format!("30 % around the speed of the column {column}"),
        Some(FactSource::Words { words, .. }) => format!("30 % around the speed told (\"{words}\")"),
        Some(FactSource::Assumed { .. }) | None => "30 % around the assumed speed".to_owned(),
    }
}

struct List {
    found: Vec<Parameter>,
}

impl List {
    fn add(&mut self, pointer: String, unit: &str, (min, max): (f64, f64), start: f64, reason: &str) {
        let (min, max) = (round(min).min(start), round(max).max(start));
        if start.is_finite() && min.is_finite() && max.is_finite() && max > min {
            let (unit, reason) = (unit.to_owned(), reason.to_owned());
            self.found.push(Parameter { pointer, unit, min, max, start, integer: false, reason });
        }
    }

    fn steps(&mut self, pointer: String, start: u32, around_s: f64, least: u32, reason: &str) {
        let around = around_s * STEPS_PER_S;
        let start = f64::from(start);
        let bounds = ((start - around).max(f64::from(least)), start + around);
        self.add(pointer, "steps of 0.1 s", bounds, start, reason);
        if let Some(added) = self.found.last_mut().filter(|added| added.unit == "steps of 0.1 s") {
            (added.min, added.max, added.integer) = (added.min.ceil(), added.max.floor(), true);
        }
    }

    fn speed(&mut self, pointer: &str, start: f64, (least, most): (f64, f64), reason: &str) {
        let bounds = ((start * (1.0 - SPEED_SHARE)).max(least), (start * (1.0 + SPEED_SHARE)).min(most));
        self.add(pointer.to_owned(), "m/s", bounds, start, reason);
    }

    fn start(&mut self, at: &str, partner: &Partner, draft: &ScenarioDraft, narrative: &Narrative) {
        match partner.start {
            Start::ArrivalGap { arrival_gap_s } => {
                let (mut min, mut max) = (arrival_gap_s - GAP_TOLERANCE_S, arrival_gap_s + GAP_TOLERANCE_S);
                let mut reason = "about one vehicle length of time around the design's gap";
                if narrative.told_record().is_some() {
                    match Facts(&narrative.facts).first_mover() {
                        Some(FirstMover::Cp) => {
                            max = max.min(ORDER_TOLERANCE_S);
                            reason = "the record says that the partner was first";
                        }
                        Some(FirstMover::Sv) => {
                            min = min.max(-ORDER_TOLERANCE_S);
                            reason = "the record says that the ego was first";
                        }
                        Some(FirstMover::Both) | None => {}
                    }
                }
                self.add(format!("{at}/start/arrival_gap_s"), "s", (min, max), arrival_gap_s, reason);
            }
            Start::Offset { delta_s_m, delta_t_m } => {
                // It may not start inside the ego when it starts in the ego's lane.
                let (mut min, mut max) = (delta_s_m - START_TOLERANCE_M, delta_s_m + START_TOLERANCE_M);
                if partner.lane_offset == 0 && delta_s_m.abs() > 6.0 {
                    (min, max) = if delta_s_m > 0.0 { (min.max(6.0), max) } else { (min, max.min(-6.0)) };
                }
                if partner.approach == Approach::Same {
                    // On the road, with its rear.
                    min = min.max(0.5 * VehicleSpec::of(partner.kind).length_m - draft.ego.s_m);
                }
                let reason = "the record tells the lane, not the place along it";
                self.add(format!("{at}/start/delta_s_m"), "m", (min, max), delta_s_m, reason);
                let bounds = (delta_t_m - LATERAL_TOLERANCE_M, delta_t_m + LATERAL_TOLERANCE_M);
                self.add(format!("{at}/start/delta_t_m"), "m", bounds, delta_t_m, "it stays in its lane");
            }
        }
    }

    fn policy(&mut self, at: &str, partner: &Partner, limits: (f64, f64), reason: &str) {
        let to = |field: &str| format!("{at}/policy/{field}");
        match partner.policy {
            Policy::IdmNominal { target_speed_mps } => {
                self.speed(&to("target_speed_mps"), target_speed_mps, limits, reason);
            }
            Policy::SuddenBrake { target_speed, brake_step, brake_steps, .. } => {
                self.speed(&to("target_speed"), target_speed, limits, reason);
                // Without steps of braking it holds its speed all along, and that is what the narrative says.
                if brake_steps > 0 {
                    self.steps(to("brake_step"), brake_step, TIME_TOLERANCE_S, 0, "the record does not tell when");
                    self.steps(to("brake_steps"), brake_steps, 1.0, 1, "the record does not tell how long");
                }
            }
            Policy::AccelThenBrake { accel_mag, accel_steps, cruise_speed, .. } => {
                let bounds = ((accel_mag - 0.2).max(0.15), (accel_mag + 0.2).min(0.9));
                self.add(to("accel_mag"), "1", bounds, accel_mag, "everyday to brisk setting off");
                self.steps(to("accel_steps"), accel_steps, 1.0, 1, "the record does not tell how long");
                self.speed(&to("cruise_speed"), cruise_speed, limits, reason);
            }
            Policy::Stopped { depart_step, target_speed_mps } => {
                if let Some(step) = depart_step {
                    self.steps(to("depart_step"), step, TIME_TOLERANCE_S, 0, "the record does not tell when");
                    self.speed(&to("target_speed_mps"), target_speed_mps, limits, reason);
                }
            }
            Policy::Yielding { target_speed_mps, gap_s } => {
                self.speed(&to("target_speed_mps"), target_speed_mps, limits, reason);
                let bounds = ((gap_s - 1.0).max(0.5), gap_s + 1.0);
                self.add(to("gap_s"), "s", bounds, gap_s, "drivers accept gaps of this order");
            }
        }
    }

    fn lateral(&mut self, at: &str, partner: &Partner, lane_width_m: f64) {
        for (number, step) in partner.lateral.iter().enumerate() {
            // Moves follow each other: two that move at once share the time between them.
            let slack_s = partner
                .lateral
                .get(number + 1)
                .map_or(f64::INFINITY, |next| 0.5 * (next.start_s - step.start_s - step.duration_s).max(0.0));
            let to = |field: &str| format!("{at}/lateral/{number}/{field}");
            if number == 0 {
                let latest = step.start_s + TIME_TOLERANCE_S.min(slack_s);
                let bounds = ((step.start_s - TIME_TOLERANCE_S).max(0.0), latest);
                self.add(to("start_s"), "s", bounds, step.start_s, "the record does not tell when");
            }
            let longest = (step.duration_s * 1.6).min(6.0).min(step.duration_s + slack_s);
            let bounds = ((step.duration_s * 0.6).max(0.8), longest);
            self.add(to("duration_s"), "s", bounds, step.duration_s, "a lane change takes 1 to 6 s");
            if step.to_t_m == 0.0 {
                continue;
            }
            // Into the ego's lane by up to a lane width, and no less than towards it.
            let size = step.to_t_m.abs();
            let (near, far) = ((0.6 * size).max(0.3), (1.5 * size).min(1.2 * lane_width_m).max(size));
            let bounds = if step.to_t_m >= 0.0 { (near, far) } else { (-far, -near) };
            let reason = "the record tells the side, not how far; at most into the next lane";
            self.add(to("to_t_m"), "m", bounds, step.to_t_m, reason);
        }
    }
}

/// Bounds are read by people: two decimals.
fn round(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}
