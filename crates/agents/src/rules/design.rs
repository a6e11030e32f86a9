//! From a narrative to a scenario: map, lanes, speeds and timing that make the told conflict happen.

use super::limits::{LEAST_TOLD_SPEED_MPS, most_speed, most_speed_of};
use super::rehearsal::holds_speed;
use super::retry::{Plan, plan};
use super::staging::{ConflictKind, Ground, KNOWN, LanePlan, Staging, fits_three_way, ground, stagings};
use super::timing::{Course, Task, Timing, Wanted, best_timings};
use super::writing::Facts;
use crate::{AgentError, Brief, Feedback};
use recrash_model::kinds::PartnerKind;
use recrash_model::narrative::{FactValue, FirstMover, LongitudinalAction, Narrative, Side};
use recrash_model::record::CrashRecord;
use recrash_model::scenario::{
    Author, CrossMap, EgoSpec, Environment, LateralMove, MapSpec, MissingArm, Obstacle, ObstacleKind, Partner, Policy,
    RoundaboutMap, SCENARIO_FORMAT, ScenarioDraft, Source, Start, StraightMap, TeeMap, Traffic, Turn,
};
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;
use recrash_model::zones::ContactZone;

/// Lane width in towns, MetaDrive's. [m]
const LANE_WIDTH_M: f64 = 3.5;
/// How long the two drive before they meet: long enough to settle, short enough for the replay; assumed. [s]
const LEAD_TIME_S: f64 = 5.5;
/// The shortest the ego drives before the intersection, where the partner's way needs it to start nearer; assumed. [s]
const SHORTEST_LEAD_S: f64 = 1.5;
/// The ego's start along the approach: MetaDrive's. [m]
const EGO_START_M: f64 = 5.0;
/// Speed where neither record nor road sign tells one: 30 km/h, MetaDrive's. [m/s]
const DEFAULT_SPEED_MPS: f64 = 8.3;
/// Drivers near a conflict go slower than the posted speed; assumed.
const SHARE_OF_POSTED_SPEED: f64 = 0.8;
/// Who sets off does so at this throttle, about 1.5 m/s^2: brisk; assumed.
const SETTING_OFF_THROTTLE: f64 = 0.5;
/// Speed of somebody who has just set off. [m/s]
const SETTING_OFF_MPS: f64 = 1.0;
/// Records named in a scenario's source.
const MOST_SOURCES: usize = 4;

/// Designs the scenario, anew where there is feedback.
pub fn design(brief: &Brief, narrative: &Narrative, feedback: &[Feedback]) -> Result<ScenarioDraft, AgentError> {
    let facts = Facts(&narrative.facts);
    let Some(staging) = staging_of(narrative, &facts) else {
        return Err(AgentError::TemplateUnknown { template: narrative.template, known: KNOWN });
    };
    let told = facts
        .find(|value| match value {
            FactValue::Contact { sv, cp } => Some((sv.as_slice(), cp.as_slice())),
            _ => None,
        })
        .unwrap_or((&[], &[]));
    // A move that must show leads into the ego's lane; the others only come close.
    let moves_over =
        ground(&narrative.template, &staging) == Ground::Road && narrative.template.cp != Movement::Straight;
    let side_by_side = staging.conflict == ConflictKind::Sideways && !moves_over;
    let plan = plan(feedback, !told.0.is_empty(), side_by_side);
    Ok(Stage::new(brief, narrative, staging, plan, told).draft())
}

/// The staging the facts name, or the template's most typical one.
pub fn staging_of(narrative: &Narrative, facts: &Facts) -> Option<Staging> {
    let ways = stagings(&narrative.template);
    let (approach, side) = (facts.approach(), facts.side());
    ways.iter()
        .find(|way| Some(way.approach) == approach && (way.beside.is_none() || side.is_none() || way.beside == side))
        .or_else(|| ways.first())
        .copied()
}

/// Room behind the partner's start, in time at its speed; assumed. [s]
const ROOM_TO_COME_LATER_S: f64 = 1.0;

/// Everything that is decided before numbers are worked out.
struct Stage<'a> {
    brief: &'a Brief<'a>,
    narrative: &'a Narrative,
    facts: Facts<'a>,
    staging: Staging,
    plan: Plan,
    /// Zones told on the ego and on the partner.
    told: (&'a [ContactZone], &'a [ContactZone]),
    ego_mps: f64,
    partner_mps: f64,
    kind: PartnerKind,
    ground: Ground,
}

impl<'a> Stage<'a> {
    fn new(
        brief: &'a Brief<'a>,
        narrative: &'a Narrative,
        staging: Staging,
        plan: Plan,
        told_zones: (&'a [ContactZone], &'a [ContactZone]),
    ) -> Self {
        let facts = Facts(&narrative.facts);
        let kind = facts.partner().unwrap_or_default();
        let ground = ground(&narrative.template, &staging);
        let record = brief.told(narrative);
        let posted = record.and_then(|r| r.posted_speed_mps).map(|v| v * SHARE_OF_POSTED_SPEED);
        let drives = |speed: &f64| *speed >= LEAST_TOLD_SPEED_MPS;
        let (ego, partner) =
            (facts.find(FactValue::sv_speed).filter(drives), facts.find(FactValue::cp_speed).filter(drives));
        let limit = |speed: f64, movement| {
            let most = most_speed(ground, turn(ground, movement)).min(brief.profile.expresses.max_speed_mps);
            let least = brief.profile.expresses.min_speed_mps.max(LEAST_TOLD_SPEED_MPS).min(most);
            round_to((speed.clamp(least, most) * plan.speed_factor).max(least), 0.1)
        };
        let ego_mps = limit(ego.or(posted).unwrap_or(DEFAULT_SPEED_MPS), narrative.template.sv);
        let partner_mps = limit(partner.or(posted).unwrap_or(ego_mps), narrative.template.cp);
        let partner_mps = partner_mps.min(most_speed_of(kind));
        Self { brief, narrative, facts, staging, plan, told: told_zones, ego_mps, partner_mps, kind, ground }
    }

    fn draft(&self) -> ScenarioDraft {
        let factor = self.plan.length_factor;
        let approach_m = ((EGO_START_M + LEAD_TIME_S * self.ego_mps) * factor).clamp(40.0, 280.0).ceil();
        let arm_m = (LEAD_TIME_S * self.ego_mps.max(self.partner_mps) * 1.8 * factor + 20.0).clamp(60.0, 280.0).ceil();
        let (ego_turn, partner_turn) = (self.turn(self.narrative.template.sv), self.turn(self.narrative.template.cp));
        let plans: Vec<(LanePlan, Course)> = self
            .staging
            .lanes
            .iter()
            .filter_map(|lanes| {
                let map = self.map(lanes.lanes, approach_m, arm_m);
                let partner = (self.staging.approach, partner_turn, lanes.partner);
                Some((*lanes, Course::new(&map, (ego_turn, lanes.ego), partner)?))
            })
            .collect();
        let (lane_plans, courses): (Vec<LanePlan>, Vec<Course>) = plans.into_iter().unzip();
        let (policy, start_mps) = self.on_its_path();
        let on_its_path = (&policy, start_mps);
        // The partner must fit on its way: where it would start before it, the ego starts farther on.
        let mut ego_start_m = EGO_START_M;
        let farthest_m = (approach_m - SHORTEST_LEAD_S * self.ego_mps).max(EGO_START_M);
        let least_m = self.least_start_m();
        let mut timed = best_timings(&self.task(ego_start_m, on_its_path), &courses, &self.plan);
        for _ in 0..4 {
            let missing_m = timed.first().map_or(0.0, |(_, timing)| least_m - timing.partner_start_m);
            if missing_m <= 0.0 || ego_start_m >= farthest_m {
                break;
            }
            let partner_mps = timed.first().map_or(self.partner_mps, |(_, timing)| timing.partner_mps);
            let moved_m = missing_m / partner_mps.max(1.0) * self.ego_mps + 1.0;
            ego_start_m = round_to((ego_start_m + moved_m).min(farthest_m), 0.5);
            timed = best_timings(&self.task(ego_start_m, on_its_path), &courses, &self.plan);
        }
        let (position, timing) = timed.first().map_or((0, None), |(position, timing)| (*position, Some(*timing)));
        let lanes = lane_plans.get(position).copied().unwrap_or(self.staging.lanes[0]);
        let mut draft = self.frame(lanes, self.map(lanes.lanes, approach_m, arm_m), ego_start_m);
        if let Some(timing) = timing {
            self.apply(&mut draft, &timing);
        }
        if let Some(course) = courses.get(position) {
            self.place_obstacles(&mut draft, course, lanes);
            let length_m = course.ego.path.length_m;
            draft.duration_s = ((length_m - draft.ego.s_m) / self.ego_mps * 1.25 + 6.0).ceil().clamp(15.0, 60.0);
        }
        draft
    }

    fn turn(&self, movement: Movement) -> Turn {
        turn(self.ground, movement)
    }

    fn task<'b>(&'b self, ego_start_m: f64, (policy, start_mps): (&'b Policy, f64)) -> Task<'b> {
        Task {
            template: &self.narrative.template,
            ground: self.ground,
            conflict: self.staging.conflict,
            towards: if self.staging.beside == Some(Side::Left) { 1.0 } else { -1.0 },
            kind: self.kind,
            ego_start_m,
            ego_mps: self.ego_mps,
            partner_mps: self.partner_mps,
            policy,
            start_mps,
            wanted: Wanted {
                sv: self.told.0,
                cp: self.told.1,
                excluded: &self.brief.profile.excludes.collisions,
                partner_first: self.partner_first(),
            },
        }
    }

    /// Nearest to the beginning of its way that the partner may start: all of it on the road. One that sets off, and so
    /// starts near, keeps room to come a little later, which tuning may want. [m]
    fn least_start_m(&self) -> f64 {
        let (_, start_mps) = self.on_its_path();
        let later_m = if start_mps < self.partner_mps { ROOM_TO_COME_LATER_S * self.partner_mps } else { 0.0 };
        0.5 * VehicleSpec::of(self.kind).length_m + 1.0 + later_m
    }

    /// What a partner does whose path meets the ego's, and its first speed: one that had stood sets off. [m/s]
    fn on_its_path(&self) -> (Policy, f64) {
        let stood = self.staging.conflict == ConflictKind::Paths
            && self.facts.cp_did(LongitudinalAction::WasStopped)
            && self.partner_mps > SETTING_OFF_MPS;
        if stood {
            let acceleration = SETTING_OFF_THROTTLE * VehicleSpec::of(self.kind).max_acceleration_mps2;
            let policy = Policy::AccelThenBrake {
                accel_mag: SETTING_OFF_THROTTLE,
                accel_steps: ((self.partner_mps - SETTING_OFF_MPS) / acceleration * 10.0).ceil() as u32,
                cruise_speed: self.partner_mps,
                brake_step: 0,
                brake_steps: 0,
                speed_kp: None,
            };
            return (policy, SETTING_OFF_MPS);
        }
        if self.staging.beside.is_some() && self.narrative.template.work_zone {
            // The intelligent driver model would stop for cones that narrow its lane.
            return (holds_speed(self.partner_mps), self.partner_mps);
        }
        (Policy::IdmNominal { target_speed_mps: self.partner_mps }, self.partner_mps)
    }

    /// Puts a timing into the draft.
    fn apply(&self, draft: &mut ScenarioDraft, timing: &Timing) {
        let partner = &mut draft.partners[0];
        partner.speed_mps = timing.partner_mps;
        match self.staging.conflict {
            ConflictKind::Paths => {
                // Where even the nearest start of the ego leaves too short a way, the partner comes that much earlier.
                let missing_s =
                    ((self.least_start_m() - timing.partner_start_m) / timing.partner_mps.max(1.0)).max(0.0);
                partner.start = Start::ArrivalGap { arrival_gap_s: round_to(timing.start - missing_s, 0.01) };
                (partner.policy, partner.speed_mps) = self.on_its_path();
            }
            ConflictKind::Sideways => {
                partner.start = Start::Offset { delta_s_m: timing.start, delta_t_m: timing.start_t_m };
                // It holds its speed, whoever and whatever is near: a driver who comes over has not seen.
                partner.policy = holds_speed(timing.partner_mps);
                partner.lateral = timing.lateral.into_iter().collect();
                if let Some(over) = timing.lateral.filter(|_| timing.returns) {
                    let start_s = round_to(over.start_s + over.duration_s + 1.0, 0.1);
                    partner.lateral.push(LateralMove { start_s, duration_s: 2.0, to_t_m: 0.0 });
                }
            }
        }
    }

    /// The scenario without timing.
    fn frame(&self, lanes: LanePlan, map: MapSpec, ego_start_m: f64) -> ScenarioDraft {
        let template = self.narrative.template;
        let approach = self.staging.approach;
        ScenarioDraft {
            format: SCENARIO_FORMAT.to_owned(),
            id: self.brief.scenario_id.to_owned(),
            source: Source {
                records: self.narrative.sources().into_iter().take(MOST_SOURCES).collect(),
                origin: Some(self.narrative.origin.clone()),
                template: Some(template),
                narrative: self.narrative.text.clone(),
                author: Author::Rules,
                seed: self.brief.seed.0,
            },
            map,
            ego: EgoSpec {
                turn: self.turn(template.sv),
                lane: lanes.ego,
                s_m: ego_start_m,
                speed_mps: self.ego_mps,
                target_speed_mps: self.ego_mps,
                ..EgoSpec::default()
            },
            partners: vec![Partner {
                id: "cp1".to_owned(),
                kind: self.kind,
                approach,
                turn: self.turn(template.cp),
                lane_offset: lanes.partner as i8 - lanes.ego as i8,
                start: Start::ArrivalGap { arrival_gap_s: 0.0 },
                speed_mps: self.partner_mps,
                policy: Policy::IdmNominal { target_speed_mps: self.partner_mps },
                lateral: Vec::new(),
            }],
            obstacles: Vec::new(),
            traffic: Traffic::default(),
            environment: self.brief.told(self.narrative).map_or_else(Environment::default, environment),
            duration_s: 30.0,
            ..ScenarioDraft::default()
        }
    }

    fn map(&self, lanes: u8, approach_m: f64, arm_m: f64) -> MapSpec {
        let missing = self.facts.missing_arm();
        match self.ground {
            Ground::Circle => MapSpec::O(RoundaboutMap {
                lanes,
                lane_width_m: LANE_WIDTH_M,
                approach_m,
                arm_m,
                exit_radius_m: 10.0,
                inner_radius_m: 20.0,
            }),
            Ground::Junction => match missing.and_then(|arm| self.fitting_arm(arm)) {
                Some(missing) => MapSpec::T(TeeMap { lanes, lane_width_m: LANE_WIDTH_M, approach_m, arm_m, missing }),
                None => MapSpec::X(CrossMap { lanes, lane_width_m: LANE_WIDTH_M, approach_m, arm_m }),
            },
            Ground::Road => {
                // Room to meet, and twice as much to see what comes of it.
                let length_m = (self.ego_mps * 3.0 * LEAD_TIME_S).clamp(120.0, 600.0).ceil();
                MapSpec::S(StraightMap { lanes, lane_width_m: LANE_WIDTH_M, approach_m, length_m })
            }
        }
    }

    /// The missing arm that was told, or any other that neither needs.
    fn fitting_arm(&self, told: MissingArm) -> Option<MissingArm> {
        [told, MissingArm::Ahead, MissingArm::Right, MissingArm::Left]
            .into_iter()
            .find(|arm| fits_three_way(&self.narrative.template, &self.staging, *arm))
    }

    /// Who comes first where neither words nor contact areas tell: drawn by the seed.
    fn partner_first(&self) -> bool {
        match self.facts.first_mover() {
            Some(FirstMover::Cp) => true,
            Some(FirstMover::Sv) => false,
            Some(FirstMover::Both) | None => {
                self.brief.seed.child(self.brief.scenario_id).child("order").rng().below(2) == 0
            }
        }
    }

    /// Cones of a work zone, in the lane beside the ego's so that they narrow its way and do not block it.
    fn place_obstacles(&self, draft: &mut ScenarioDraft, course: &Course, lanes: LanePlan) {
        let told = self.facts.find_fact(|value| matches!(value, FactValue::Obstacles { .. }));
        if !self.narrative.template.work_zone && told.is_none() {
            return;
        }
        let side = match told.map(|fact| &fact.value) {
            Some(FactValue::Obstacles { side, .. }) => *side,
            _ => Side::Left,
        };
        let has_left = lanes.ego > 0;
        let has_right = lanes.ego + 1 < lanes.lanes;
        let side = match (side, has_left, has_right) {
            (Side::Left, true, _) | (Side::Right, true, false) => Side::Left,
            (Side::Right, _, true) | (Side::Left, false, true) => Side::Right,
            // One lane: along the centre line.
            (_, false, false) => Side::Left,
        };
        let sign = if side == Side::Left { -1.0 } else { 1.0 };
        let partner_there = self.staging.beside == Some(side);
        let end_m =
            if self.ground == Ground::Road { course.ego.path.length_m - 40.0 } else { course.ego.block_m - 6.0 };
        let first_m = (draft.ego.s_m + 18.0).min(end_m - 10.0).max(1.0);
        let count = 8_u32;
        let step_m = ((end_m - first_m) / f64::from(count)).clamp(1.0, 12.0);
        for number in 0..count {
            // A taper from the far side of the neighbouring lane to its near side; beside a partner the cones stay on the
            // far side, so that its way is narrowed too and not blocked.
            let share = f64::from(number) / f64::from(count - 1);
            let from_lane_edge = if partner_there { 3.2 } else { 2.4 - 1.8 * share };
            draft.obstacles.push(Obstacle {
                kind: ObstacleKind::Cone,
                s_m: round_to(first_m + step_m * f64::from(number), 0.5),
                t_m: round_to(sign * (0.5 * LANE_WIDTH_M + from_lane_edge), 0.05),
            });
        }
    }
}

/// The turn that shows a movement: on a road without junction there is none.
pub fn turn(ground: Ground, movement: Movement) -> Turn {
    match movement {
        _ if ground == Ground::Road => Turn::Straight,
        Movement::LeftTurn => Turn::Left,
        Movement::RightTurn => Turn::Right,
        _ => Turn::Straight,
    }
}

fn environment(record: &CrashRecord) -> Environment {
    Environment {
        surface: record.surface.unwrap_or_default(),
        lighting: record.lighting.unwrap_or_default(),
        weather: record.weather.first().copied().unwrap_or_default(),
    }
}

/// Rounded to a multiple of `step`, so that files stay readable.
fn round_to(value: f64, step: f64) -> f64 {
    let rounded = (value / step).round() * step;
    (rounded * 1e6).round() / 1e6
}
