//! From a narrative to a scenario: map, lanes, speeds and timing that make the told conflict happen.

use super::limits::{LEAST_TOLD_SPEED_MPS, most_speed, most_speed_of};
use super::retry::{Levers, Wanted, levers};
use super::staging::{ConflictKind, Ground, KNOWN, LanePlan, Staging, fits_three_way, ground, stagings};
use super::writing::Facts;
use crate::{AgentError, Brief, Feedback};
use recrash_model::narrative::{FactValue, FirstMover, LongitudinalAction, Narrative, Side};
use recrash_model::record::{ContactZone, CrashRecord, PartnerKind};
use recrash_model::scenario::{
    Approach, Author, CrossMap, EgoSpec, Environment, LateralMove, MapSpec, MissingArm, Obstacle, ObstacleKind,
    Partner, Policy, RoundaboutMap, SCENARIO_FORMAT, ScenarioDraft, Source, Start, StraightMap, TeeMap, Traffic, Turn,
};
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{LanePath, RoadNetwork, RoadPart};

/// Lane width in towns, MetaDrive's. [m]
const LANE_WIDTH_M: f64 = 3.5;
/// How long the two drive before they meet: long enough to settle, short enough for the replay; assumed. [s]
const LEAD_TIME_S: f64 = 5.5;
/// The ego's start along the approach: MetaDrive's. [m]
const EGO_START_M: f64 = 5.0;
/// Speed where neither record nor road sign tells one: 30 km/h, MetaDrive's. [m/s]
const DEFAULT_SPEED_MPS: f64 = 8.3;
/// Drivers near a conflict go slower than the posted speed; assumed.
const SHARE_OF_POSTED_SPEED: f64 = 0.8;
/// Half the length of a passenger car. [m]
const HALF_LENGTH_M: f64 = 2.2575;
/// Half its width. [m]
const HALF_WIDTH_M: f64 = 0.926;
/// Records named in a scenario's source.
const MOST_SOURCES: usize = 4;

/// Designs the scenario, anew where there is feedback.
pub fn design(brief: &Brief, narrative: &Narrative, feedback: &[Feedback]) -> Result<ScenarioDraft, AgentError> {
    let facts = Facts(&narrative.facts);
    let Some(staging) = staging_of(narrative, &facts) else {
        let scenario_id = brief.scenario_id.to_owned();
        return Err(AgentError::TemplateUnknown { scenario_id, template: narrative.template, known: KNOWN });
    };
    let wanted = facts
        .find(|value| match value {
            FactValue::Contact { sv, cp } => Some(Wanted { sv, cp }),
            _ => None,
        })
        .unwrap_or(Wanted { sv: &[], cp: &[] });
    let levers = levers(feedback, wanted);
    Ok(Stage::new(brief, narrative, staging, levers, wanted).draft())
}

/// The staging the facts name, or the template's most typical one.
fn staging_of(narrative: &Narrative, facts: &Facts) -> Option<Staging> {
    let ways = stagings(&narrative.template);
    let approach = facts.find(|value| match value {
        FactValue::Approach { approach } => Some(*approach),
        _ => None,
    });
    let side = facts.find(|value| match value {
        FactValue::CpLaneOffset { lanes } => super::paraphrase::offset_side(*lanes),
        _ => None,
    });
    ways.iter()
        .find(|way| Some(way.approach) == approach && (way.beside.is_none() || side.is_none() || way.beside == side))
        .or_else(|| ways.first())
        .copied()
}

/// The gap in arrival at the conflict point that brings these zones together, for paths at right angles. [s]
///
/// With f and g the places of the zones along the ego and the partner (1 front, -1 rear), and L and W half length and
/// width: a front touches the near side of the other, W before the point where the centre lines cross, so a vehicle that
/// is hit with its zone at x reaches the point (x L + \[x is front\] W) / v after the contact.
pub fn gap_of_contact(zones: Wanted, (ego_mps, partner_mps): (f64, f64)) -> f64 {
    let reach = |zones: &[ContactZone]| {
        let along = along(zones);
        along * HALF_LENGTH_M + if along >= 0.7 { HALF_WIDTH_M } else { 0.0 }
    };
    reach(zones.cp) / partner_mps - reach(zones.sv) / ego_mps
}

/// How far ahead of the ego a partner beside it must be to bring these zones together. [m]
pub fn shift_of_contact(zones: Wanted) -> f64 {
    (along(zones.sv) - along(zones.cp)) * HALF_LENGTH_M
}

/// Mean place of zones along a vehicle: 1 front, 0 middle, -1 rear.
fn along(zones: &[ContactZone]) -> f64 {
    let place = |zone: &ContactZone| match zone {
        ContactZone::Front => Some(1.0),
        ContactZone::FrontLeft | ContactZone::FrontRight => Some(0.75),
        ContactZone::Left | ContactZone::Right => Some(0.0),
        ContactZone::RearLeft | ContactZone::RearRight => Some(-0.75),
        ContactZone::Rear => Some(-1.0),
        ContactZone::Top | ContactZone::Bottom => None,
    };
    let places: Vec<f64> = zones.iter().filter_map(place).collect();
    if places.is_empty() { 0.0 } else { places.iter().sum::<f64>() / places.len() as f64 }
}

/// Everything that is decided before numbers are worked out.
struct Stage<'a> {
    brief: &'a Brief<'a>,
    narrative: &'a Narrative,
    facts: Facts<'a>,
    staging: Staging,
    lanes: LanePlan,
    levers: Levers,
    wanted: Wanted<'a>,
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
        levers: Levers,
        wanted: Wanted<'a>,
    ) -> Self {
        let facts = Facts(&narrative.facts);
        let kind = facts.find(|value| match value {
            FactValue::Partner { kind } => Some(*kind),
            _ => None,
        });
        let kind = kind.unwrap_or_default();
        let lanes = staging.lanes[levers.lane_plan % staging.lanes.len()];
        let ground = ground(&narrative.template, &staging);
        let record = brief.records.first().copied();
        let told = |pick: fn(&FactValue) -> Option<f64>| facts.find(pick).filter(|v| *v >= LEAST_TOLD_SPEED_MPS);
        let posted = record.and_then(|r| r.posted_speed_mps).map(|v| v * SHARE_OF_POSTED_SPEED);
        let ego = told(|value| match value {
            FactValue::SvSpeed { speed_mps } => Some(*speed_mps),
            _ => None,
        });
        let partner = told(|value| match value {
            FactValue::CpSpeed { speed_mps } => Some(*speed_mps),
            _ => None,
        });
        let limit = |speed: f64, movement| {
            let most = most_speed(ground, turn(ground, movement)).min(brief.profile.expresses.max_speed_mps);
            let least = brief.profile.expresses.min_speed_mps.max(LEAST_TOLD_SPEED_MPS).min(most);
            round_to((speed * levers.speed_factor).clamp(least, most), 0.1)
        };
        let ego_mps = limit(ego.or(posted).unwrap_or(DEFAULT_SPEED_MPS), narrative.template.sv);
        let partner_mps = limit(partner.or(posted).unwrap_or(ego_mps), narrative.template.cp);
        let partner_mps = partner_mps.min(most_speed_of(kind));
        Self { brief, narrative, facts, staging, lanes, levers, wanted, ego_mps, partner_mps, kind, ground }
    }

    fn draft(&self) -> ScenarioDraft {
        let approach_m = ((EGO_START_M + LEAD_TIME_S * self.ego_mps) * self.levers.length_factor).clamp(40.0, 280.0);
        let arm_m = (LEAD_TIME_S * self.ego_mps.max(self.partner_mps) * 1.5 * self.levers.length_factor + 20.0)
            .clamp(60.0, 280.0);
        let map = self.map(approach_m.ceil(), arm_m.ceil());
        let network = RoadNetwork::build(&map);
        let way = Way::new(&network, Approach::Same, turn(self.ground, self.narrative.template.sv), self.lanes.ego);
        let other = Way::new(
            &network,
            self.staging.approach,
            turn(self.ground, self.narrative.template.cp),
            self.lanes.partner,
        );
        let mut draft = self.frame(map);
        match self.staging.conflict {
            ConflictKind::Paths => self.stage_paths(&mut draft, &network, &way, &other),
            ConflictKind::Sideways => self.stage_sideways(&mut draft, &way, &other),
        }
        self.place_obstacles(&mut draft, &way);
        let length_m = way.as_ref().map_or(200.0, |way| way.path.length_m);
        draft.duration_s = ((length_m - draft.ego.s_m) / self.ego_mps * 1.25 + 6.0).ceil().clamp(15.0, 60.0);
        draft
    }

    /// The scenario without timing.
    fn frame(&self, map: MapSpec) -> ScenarioDraft {
        let template = self.narrative.template;
        let approach = self.staging.approach;
        ScenarioDraft {
            format: SCENARIO_FORMAT.to_owned(),
            id: self.brief.scenario_id.to_owned(),
            source: Source {
                records: self.narrative.records.iter().take(MOST_SOURCES).cloned().collect(),
                template: Some(template),
                narrative: self.narrative.text.clone(),
                author: Author::Rules,
                seed: self.brief.seed.0,
            },
            map,
            ego: EgoSpec {
                turn: turn(self.ground, template.sv),
                lane: self.lanes.ego,
                s_m: EGO_START_M,
                speed_mps: self.ego_mps,
                target_speed_mps: self.ego_mps,
            },
            partners: vec![Partner {
                id: "cp1".to_owned(),
                kind: self.kind,
                approach,
                turn: turn(self.ground, template.cp),
                lane_offset: self.lanes.partner as i8 - self.lanes.ego as i8,
                start: Start::ArrivalGap { arrival_gap_s: 0.0 },
                speed_mps: self.partner_mps,
                policy: Policy::IdmNominal { target_speed_mps: self.partner_mps },
                lateral: Vec::new(),
            }],
            obstacles: Vec::new(),
            traffic: Traffic::default(),
            environment: self.brief.records.first().map_or_else(Environment::default, |record| environment(record)),
            duration_s: 30.0,
        }
    }

    fn map(&self, approach_m: f64, arm_m: f64) -> MapSpec {
        let lanes = self.lanes.lanes;
        let missing = self.facts.find(|value| match value {
            FactValue::ThreeWay { missing } => Some(*missing),
            _ => None,
        });
        match self.ground {
            Ground::Circle => MapSpec::O(RoundaboutMap {
                lanes,
                lane_width_m: LANE_WIDTH_M,
                approach_m,
                arm_m,
                exit_radius_m: 10.0,
                inner_radius_m: 30.0,
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
        let told = self.facts.find(|value| match value {
            FactValue::Order { first } => Some(*first),
            _ => None,
        });
        let first = match told {
            Some(FirstMover::Cp) => true,
            Some(FirstMover::Sv) => false,
            Some(FirstMover::Both) | None => {
                self.brief.seed.child(self.brief.scenario_id).child("order").rng().below(2) == 0
            }
        };
        first != self.levers.swap_order
    }

    /// Arrival gap that brings the told zones together, or lets the two pass closely. [s]
    fn arrival_gap(&self) -> f64 {
        let touched = !self.wanted.sv.is_empty();
        if touched && !self.levers.near_miss {
            return gap_of_contact(self.wanted, (self.ego_mps, self.partner_mps)) + self.levers.gap_shift_s;
        }
        // Two cars at right angles touch while their gap is below (2 L + 2 W) / v of the later one; a little more passes.
        let later_mps = if self.partner_first() { self.ego_mps } else { self.partner_mps };
        let clear = 2.0 * (HALF_LENGTH_M + HALF_WIDTH_M + 0.7) / later_mps;
        let length = 0.5 * (VehicleSpec::of(self.kind).length_m - 2.0 * HALF_LENGTH_M).max(0.0) / self.partner_mps;
        let gap = clear + length + self.levers.gap_shift_s.abs();
        if self.partner_first() { -gap } else { gap }
    }

    /// Paths that cross or merge: the arrival gap makes the meeting.
    fn stage_paths(&self, draft: &mut ScenarioDraft, network: &RoadNetwork, way: &Option<Way>, other: &Option<Way>) {
        let mut gap = self.arrival_gap();
        let (policy, start_mps, lost_s) = self.policy();
        gap -= lost_s;
        let partner = &mut draft.partners[0];
        partner.policy = policy;
        partner.speed_mps = start_mps;
        partner.start = Start::ArrivalGap { arrival_gap_s: round_to(gap, 0.01) };
        let (Some(way), Some(other)) = (way, other) else { return };
        let width = VehicleSpec::of(self.kind).width_m;
        let Some(conflict) = way.path.conflict(&other.path, network, 2.0 * HALF_WIDTH_M, width) else { return };
        // The partner must fit on its arm: where it would start before it, the ego starts nearer.
        let meets_s = (conflict.s_a - draft.ego.s_m) / self.ego_mps;
        let start_m = conflict.s_b - self.partner_mps * (meets_s + gap);
        let least_m = 0.5 * VehicleSpec::of(self.kind).length_m + 1.0;
        if start_m < least_m {
            let moved = (least_m - start_m) / self.partner_mps * self.ego_mps;
            let most = way.block_m - self.ego_mps * 2.0;
            draft.ego.s_m = round_to((draft.ego.s_m + moved).min(most.max(draft.ego.s_m)), 0.5);
        }
    }

    /// What the partner does along its lane, its first speed, and how much later it arrives for it. [s]
    fn policy(&self) -> (Policy, f64, f64) {
        let target = self.partner_mps;
        if self.facts.cp_did(LongitudinalAction::WasStopped) {
            // Sets off at half throttle, about 1.5 m/s^2.
            let throttle = 0.5;
            let acceleration = throttle * VehicleSpec::of(self.kind).max_acceleration_mps2;
            let start_mps = 1.0_f64.min(target);
            let speeding_up_s = (target - start_mps) / acceleration;
            let lost_s = (target - start_mps) * speeding_up_s / (2.0 * target);
            let policy = Policy::AccelThenBrake {
                accel_mag: throttle,
                accel_steps: (speeding_up_s * 10.0).ceil() as u32,
                cruise_speed: target,
                brake_step: 600,
                brake_steps: 1,
                speed_kp: None,
            };
            return (policy, start_mps, lost_s);
        }
        (Policy::IdmNominal { target_speed_mps: target }, target, 0.0)
    }

    /// Parallel paths: the partner drives beside the ego and comes over.
    fn stage_sideways(&self, draft: &mut ScenarioDraft, way: &Option<Way>, other: &Option<Way>) {
        let (Some(way), Some(other)) = (way, other) else { return };
        let on_highway = self.ground == Ground::Road;
        let (ego_place, partner_place) = way.meeting(other, self.ego_mps);
        let meets_s = (ego_place - draft.ego.s_m) / self.ego_mps;
        // The partner keeps beside the ego on the inside or outside of the turn.
        let block = way.block_m;
        let ratio = if ego_place > block { (partner_place - block) / (ego_place - block) } else { 1.0 };
        let partner_mps = round_to(self.ego_mps * ratio, 0.01);
        let towards = if self.staging.beside == Some(Side::Left) { 1.0 } else { -1.0 };
        let touched = !self.wanted.sv.is_empty() && !self.wanted.cp.is_empty() && !self.levers.near_miss;
        let ahead =
            if touched { shift_of_contact(self.wanted).clamp(-4.0, 4.0) } else { 5.5 } + self.levers.start_shift_m;
        let delta_s = partner_place + ahead - partner_mps * meets_s - draft.ego.s_m;
        if delta_s < 0.0 {
            draft.ego.s_m = round_to(draft.ego.s_m - delta_s, 0.5);
        }
        let delta_s = partner_place + ahead - partner_mps * (ego_place - draft.ego.s_m) / self.ego_mps - draft.ego.s_m;
        let cp_turns = self.narrative.template.cp != Movement::Straight;
        let clearance = LANE_WIDTH_M - HALF_WIDTH_M - 0.5 * VehicleSpec::of(self.kind).width_m;
        // On a road without junction a move of half a lane counts as a turn to that side; a partner whose move must show
        // starts on the far side of its lane, so that it has moved so far before the two can touch.
        let (from_t, to_t) = match (on_highway, cp_turns) {
            (true, false) => (0.0, 0.8 * LANE_WIDTH_M),
            (true, true) => (-0.7, LANE_WIDTH_M),
            (false, _) if touched => (0.0, clearance + 0.6),
            (false, _) => (0.0, 0.6 * clearance),
        };
        let move_s: f64 = if on_highway { 2.5 } else { 1.8 };
        let partner = &mut draft.partners[0];
        partner.speed_mps = partner_mps;
        partner.policy = Policy::IdmNominal { target_speed_mps: partner_mps };
        partner.start = Start::Offset { delta_s_m: round_to(delta_s, 0.1), delta_t_m: round_to(from_t * towards, 0.1) };
        partner.lateral = vec![LateralMove {
            start_s: round_to((meets_s - move_s).max(0.5), 0.1),
            duration_s: move_s,
            to_t_m: round_to((from_t + (to_t - from_t) * self.levers.sideways_factor) * towards, 0.05),
        }];
    }

    /// Cones of a work zone, in the lane beside the ego's so that they narrow its way and do not block it.
    fn place_obstacles(&self, draft: &mut ScenarioDraft, way: &Option<Way>) {
        let told = self.facts.find_fact(|value| matches!(value, FactValue::Obstacles { .. }));
        if !self.narrative.template.work_zone && told.is_none() {
            return;
        }
        let Some(way) = way else { return };
        let side = match told.map(|fact| &fact.value) {
            Some(FactValue::Obstacles { side, .. }) => *side,
            _ => Side::Left,
        };
        let has_left = self.lanes.ego > 0;
        let has_right = self.lanes.ego + 1 < self.lanes.lanes;
        let side = match (side, has_left, has_right) {
            (Side::Left, true, _) | (Side::Right, true, false) => Side::Left,
            (Side::Right, _, true) | (Side::Left, false, true) => Side::Right,
            // One lane: along the centre line.
            (_, false, false) => Side::Left,
        };
        let sign = if side == Side::Left { -1.0 } else { 1.0 };
        let partner_there = self.staging.beside == Some(side);
        let end_m = if self.ground == Ground::Road { way.path.length_m - 40.0 } else { way.block_m - 6.0 };
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

/// A way through the map, with the places that matter.
struct Way {
    path: LanePath,
    /// Where the block begins. [m]
    block_m: f64,
    /// The part of the block in which the movement shows: the connector of a junction, the way out of a circle. [m]
    show: Option<(f64, f64)>,
}

impl Way {
    fn new(network: &RoadNetwork, approach: Approach, turn: Turn, lane: u8) -> Option<Self> {
        let roads = network.route(approach, turn)?;
        let path = LanePath::new(network, roads.clone(), lane);
        let part = |n: usize| network.road(roads[n]).part;
        let inside: Vec<usize> =
            (0..roads.len()).filter(|n| matches!(part(*n), RoadPart::Inner | RoadPart::Ring)).collect();
        let start = |n: usize| path.segments.get(n).map_or(path.length_m, |segment| segment.start_m);
        let block_m = inside.first().map_or(0.5 * path.length_m, |n| start(*n));
        let show = inside.last().map(|n| (start(*n), start(*n + 1)));
        Some(Self { block_m, show, path })
    }

    /// Where two that drive side by side meet, along each path: well inside the movement that must show.
    fn meeting(&self, other: &Self, ego_mps: f64) -> (f64, f64) {
        match (self.show, other.show) {
            (Some(show), Some(other_show)) => {
                let share = 0.6;
                (show.0 + share * (show.1 - show.0), other_show.0 + share * (other_show.1 - other_show.0))
            }
            _ => {
                let place = EGO_START_M + LEAD_TIME_S * ego_mps;
                (place, place)
            }
        }
    }
}

/// The turn that shows a movement: on a road without junction there is none.
fn turn(ground: Ground, movement: Movement) -> Turn {
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
