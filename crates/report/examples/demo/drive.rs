//! Driving for the made-up suite: two cars on paths at planned speeds, and the numbers that follow.

use super::roads::{self, Arm, Path, Way};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::metrics::*;
use recrash_model::rollout::*;
use recrash_model::run::JudgedRun;
use recrash_model::scenario::*;
use recrash_model::selection::Cluster;
use recrash_model::severity::{InjuryOutcome, InjuryRisk, RiskCurve, Severity, Suffered};
use recrash_model::template::{Movement, RoadType};
use recrash_model::vehicle::VehicleSpec;
use recrash_model::zones::ContactZone;
use recrash_report::{RoadDrawing, RunView};

/// Time after which every run ends. [s]
const END_S: f64 = 14.0;

/// One case, planned.
pub struct Plan {
    road: RoadType,
    work_zone: bool,
    ego: Path,
    partner: Path,
    partner_kind: PartnerKind,
    drift: bool,
    slow_mps: f64,
    /// Speed of the ego. [m/s]
    pub ego_speed: f64,
    /// Speed of the partner. [m/s]
    pub partner_speed: f64,
    /// The partner's delay as designed. [s]
    pub designed_gap_s: f64,
    meet: (f64, f64),
}

fn way(movement: Movement) -> Way {
    match movement {
        Movement::LeftTurn => Way::Left,
        Movement::RightTurn => Way::Right,
        _ => Way::Straight,
    }
}

impl Plan {
    /// The plan of a cluster's scenario.
    pub fn of(cluster: &Cluster) -> Self {
        let t = cluster.template;
        let number = cluster.number as f64;
        let arm = if cluster.number.is_multiple_of(2) { Arm::Left } else { Arm::Right };
        let (ego, partner) = match t.road {
            RoadType::Highway => (roads::straight(1), roads::straight(0)),
            RoadType::TrafficCircle => {
                (roads::roundabout(Arm::Same, way(t.sv)), roads::roundabout(Arm::Left, way(t.cp)))
            }
            _ => {
                let lane = u8::from(t.sv != Movement::LeftTurn);
                let (arm, cp) = match (t.sv, t.cp) {
                    (Movement::Straight, Movement::LeftTurn) => (Arm::Ahead, Way::Left),
                    (Movement::RightTurn, Movement::Straight) => (Arm::Left, Way::Straight),
                    (Movement::RightTurn, Movement::RightTurn) => (Arm::Same, Way::Right),
                    (_, cp) => (arm, way(cp)),
                };
                let cp_lane = if arm == Arm::Same { 0 } else { 1 };
                (roads::crossing(Arm::Same, way(t.sv), lane), roads::crossing(arm, cp, cp_lane))
            }
        };
        let drift = t.road == RoadType::Highway;
        let meet = if drift { (85.0, 85.0) } else { nearest(&ego, &partner) };
        let kinds = [
            PartnerKind::PassengerCar,
            PartnerKind::Suv,
            PartnerKind::Bus,
            PartnerKind::Motorcycle,
            PartnerKind::Cyclist,
        ];
        Self {
            road: t.road,
            work_zone: t.work_zone,
            ego,
            partner,
            partner_kind: kinds[cluster.number % kinds.len()],
            drift,
            slow_mps: if cluster.number % 4 == 1 { 3.0 } else { 0.9 },
            ego_speed: 7.0 + 0.13 * number,
            partner_speed: 8.6 - 0.11 * number,
            designed_gap_s: if cluster.number % 5 == 1 { 0.2 } else { 1.6 + 0.06 * number },
            meet,
        }
    }

    /// The road.
    pub fn drawing(&self) -> RoadDrawing {
        match self.road {
            RoadType::Highway => roads::straight_drawing(),
            RoadType::TrafficCircle => roads::roundabout_drawing(),
            _ => roads::crossing_drawing(),
        }
    }

    fn states(&self, arrival_gap_s: f64) -> [Vec<ActorState>; 2] {
        let arrive = 6.0;
        let ego = sample(&self.ego, |time| {
            let s = self.meet.0 + self.ego_speed * (time - arrive);
            // It slows from 4.6 s on, by `slow_mps` in all, and would otherwise have been there earlier.
            let slowed = self.slow_mps / 6.0 * math::ln(1.0 + math::exp(6.0 * (time - 4.6)));
            (s - slowed + self.slow_mps * (arrive - 4.6), 0.0)
        });
        let partner = sample(&self.partner, |time| {
            let s = self.meet.1 + self.partner_speed * (time - arrive - arrival_gap_s);
            let lateral = if self.drift { 3.0 / (1.0 + math::exp(-1.6 * (time - 6.5))) } else { 0.0 };
            (s, lateral)
        });
        [ego, partner]
    }
}

fn nearest(ego: &Path, partner: &Path) -> (f64, f64) {
    let mut best = (0.0, 0.0, f64::INFINITY);
    for i in 0..160 {
        for j in 0..160 {
            let (s, u) = (ego.length() * f64::from(i) / 160.0, partner.length() * f64::from(j) / 160.0);
            let distance = ego.at(s, 0.0).0.distance(partner.at(u, 0.0).0);
            if distance < best.2 {
                best = (s, u, distance);
            }
        }
    }
    (best.0, best.1)
}

fn sample(path: &Path, place: impl Fn(f64) -> (f64, f64)) -> Vec<ActorState> {
    let steps = (END_S / STEP_S) as usize;
    let at = |step: usize| {
        let (s, t) = place(step as f64 * STEP_S);
        (path.at(s, t), s)
    };
    let speed = |step: usize| (at(step + 1).1 - at(step).1) / STEP_S;
    (0..=steps)
        .map(|step| {
            let ((position, heading), _) = at(step);
            let throttle = (speed(step + 1) - speed(step)) / STEP_S / 3.0;
            let moving = ActorState::moving(Pose { position, heading }, speed(step));
            ActorState { throttle: throttle.clamp(-1.0, 1.0), ..moving }
        })
        .collect()
}

fn outline(state: &ActorState, kind: PartnerKind) -> OrientedBox {
    let size = VehicleSpec::of(kind);
    OrientedBox::new(state.pose(), size.length_m, size.width_m)
}

fn gaps(plan: &Plan, ego: &[ActorState], partner: &[ActorState]) -> Vec<f64> {
    let boxes = ego.iter().zip(partner);
    boxes.map(|(e, p)| outline(e, PartnerKind::PassengerCar).gap(&outline(p, plan.partner_kind))).collect()
}

fn least(values: impl Iterator<Item = f64>) -> Timed {
    let mut best = Timed { value: f64::INFINITY, time_s: 0.0 };
    for (step, value) in values.enumerate() {
        if value < best.value {
            best = Timed { value, time_s: step as f64 * STEP_S };
        }
    }
    best
}

/// Least gap with this delay.
pub fn least_gap(plan: &Plan, arrival_gap_s: f64) -> Timed {
    let [ego, partner] = plan.states(arrival_gap_s);
    least(gaps(plan, &ego, &partner).into_iter())
}

/// A run with this delay, up to a contact.
pub fn run(cluster: &Cluster, plan: &Plan, arrival_gap_s: f64, rerun_command: String) -> RunView {
    let driven = Driven::of(plan, arrival_gap_s);
    let series = driven.series();
    let contact = driven.contact(cluster);
    let metrics = driven.metrics(&series, contact.clone(), arrival_gap_s);
    let findings = findings(&metrics);
    let severity = contact.as_ref().map(severity);
    RunView {
        scenario: scenario(cluster, plan, arrival_gap_s),
        run: JudgedRun::new(driven.rollout(cluster), metrics, findings, severity, verdict(cluster, contact.is_some())),
        series,
        rerun_command,
    }
}

/// Two cars that were driven, up to where they touch.
struct Driven<'a> {
    plan: &'a Plan,
    ego: Vec<ActorState>,
    partner: Vec<ActorState>,
    touched: bool,
}

impl<'a> Driven<'a> {
    fn of(plan: &'a Plan, arrival_gap_s: f64) -> Self {
        let [mut ego, mut partner] = plan.states(arrival_gap_s);
        let touch = gaps(plan, &ego, &partner).iter().position(|gap| *gap == 0.0);
        if let Some(step) = touch {
            ego.truncate(step + 1);
            partner.truncate(step + 1);
        }
        Self { plan, ego, partner, touched: touch.is_some() }
    }

    /// Time of the last state. [s]
    fn end_s(&self) -> f64 {
        (self.ego.len() - 1) as f64 * STEP_S
    }

    /// The states that the run ends with.
    fn last(&self) -> (ActorState, ActorState) {
        (self.ego[self.ego.len() - 1], self.partner[self.partner.len() - 1])
    }

    fn ends(&self) -> Termination {
        let kind = if self.touched { TerminationKind::Contact } else { TerminationKind::Arrived };
        Termination { kind, time_s: self.end_s() }
    }

    fn series(&self) -> Series {
        let speeds = |states: &[ActorState]| states.iter().map(|state| state.speed()).collect();
        let accelerations = |states: &[ActorState]| {
            let change = states.windows(2).map(|pair| (pair[1].speed() - pair[0].speed()) / STEP_S);
            change.chain([0.0]).collect()
        };
        let (ego, partner) = (&self.ego, &self.partner);
        Series {
            time_s: (0..ego.len()).map(|step| step as f64 * STEP_S).collect(),
            ego_speed_mps: speeds(ego),
            ego_acceleration_mps2: accelerations(ego),
            partners: vec![PartnerSeries {
                actor: 1,
                id: "cp1".into(),
                speed_mps: speeds(partner),
                acceleration_mps2: accelerations(partner),
                gap_m: gaps(self.plan, ego, partner),
                centre_distance_m: ego.iter().zip(partner).map(|(e, p)| e.position().distance(p.position())).collect(),
                ttc_s: vec![None; ego.len()],
            }],
        }
    }

    fn contact(&self, cluster: &Cluster) -> Option<Contact> {
        let (ego, partner) = self.last();
        self.touched.then(|| Contact {
            actor: 1,
            id: "cp1".into(),
            time_s: self.end_s(),
            ego_zone: if cluster.number.is_multiple_of(2) { ContactZone::Left } else { ContactZone::FrontRight },
            other_zone: ContactZone::Front,
            kind: if self.plan.drift { CollisionKind::Sideswipe } else { CollisionKind::Angle },
            relative_speed_mps: (ego.speed() + partner.speed()) * 0.7,
            ego_speed_mps: ego.speed(),
            other_speed_mps: partner.speed(),
        })
    }

    fn metrics(&self, series: &Series, contact: Option<Contact>, arrival_gap_s: f64) -> Metrics {
        let min_gap = least(series.partners[0].gap_m.iter().copied());
        let centres = least(series.partners[0].centre_distance_m.iter().copied());
        let hardest = least(series.ego_acceleration_mps2.iter().copied());
        let pet = Timed { value: (arrival_gap_s - 0.6).max(0.1), time_s: min_gap.time_s };
        Metrics {
            partners: vec![PartnerMetrics {
                actor: 1,
                id: "cp1".into(),
                min_gap,
                min_centre_distance: centres,
                min_ttc: Some(Timed { value: 0.4 + min_gap.value / 3.0, time_s: (min_gap.time_s - 0.5).max(0.0) }),
                pet: contact.is_none().then_some(pet),
                max_drac: Some(Timed { value: 9.0 / (0.6 + min_gap.value), time_s: min_gap.time_s }),
                max_required_deceleration: Some(Timed { value: 6.0 / (0.6 + min_gap.value), time_s: min_gap.time_s }),
                min_headway: None,
            }],
            obstacle_gaps: vec![],
            contact,
            obstacles_hit: vec![],
            min_gap: Some(min_gap),
            min_centre_distance: Some(centres),
            ego: EgoMetrics {
                max_deceleration: Timed { value: -hardest.value, time_s: hardest.time_s },
                tyre_limit_mps2: recrash_model::vehicle::TYRE_LIMIT_MPS2,
                phantom_braking: None,
                max_reversals: 1,
                max_reversals_time_s: 4.0,
                max_lane_departure: Timed { value: 0.05, time_s: 5.0 },
                distance_m: self.plan.ego_speed * self.end_s(),
                mean_speed_mps: self.plan.ego_speed,
            },
            termination: self.ends().kind,
            duration_s: self.end_s(),
        }
    }

    fn rollout(self, cluster: &Cluster) -> Rollout {
        let plan = self.plan;
        let termination = self.ends();
        let (a_state, b_state) = self.last();
        let contact = Event { time_s: termination.time_s, kind: EventKind::Contact { a: 0, b: 1, a_state, b_state } };
        Rollout {
            format: ROLLOUT_FORMAT.into(),
            scenario_id: cluster.scenario_id.clone(),
            simulator: "demonstration kinematics".into(),
            ego: "metadrive-idm".into(),
            events: if self.touched { vec![contact] } else { vec![] },
            actors: vec![
                track(EGO_ID, Role::Ego, PartnerKind::PassengerCar, self.ego),
                track("cp1", Role::Partner, plan.partner_kind, self.partner),
            ],
            obstacles: if plan.work_zone { (0..5).map(cone).collect() } else { vec![] },
            termination,
            state_hash: format!("{:016x}", 0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(cluster.number as u64)),
        }
    }
}

fn track(id: &str, role: Role, kind: PartnerKind, states: Vec<ActorState>) -> ActorTrack {
    let size = VehicleSpec::of(kind);
    ActorTrack {
        part_of: None,
        mass_kg: None,
        appears_s: 0.0,
        gone_s: None,
        id: id.into(),
        role,
        kind,
        length_m: size.length_m,
        width_m: size.width_m,
        states,
    }
}

/// One of the cones beside the ego's way.
fn cone(number: i32) -> PlacedObstacle {
    PlacedObstacle {
        kind: ObstacleKind::Cone,
        pose: Pose { position: Vec2::new(45.0 + 6.0 * f64::from(number), -2.4), heading: 0.0 },
        length_m: 0.4,
        width_m: 0.4,
    }
}

/// A contact or a near miss, and hard braking.
fn findings(metrics: &Metrics) -> Vec<Finding> {
    let PartnerMetrics { min_gap, .. } = metrics.partners[0];
    let braking = metrics.ego.max_deceleration;
    let near = metrics.contact.is_none() && min_gap.value < 2.0;
    let contact = metrics.contact.as_ref().map(|contact| Finding {
        kind: FindingKind::Contact,
        time_s: contact.time_s,
        value: contact.relative_speed_mps,
        threshold: 0.0,
        sentence: format!("The ego touched cp1 at a relative speed of {:.1} m/s.", contact.relative_speed_mps),
    });
    let near_miss = near.then(|| Finding {
        kind: FindingKind::NearMiss,
        time_s: min_gap.time_s,
        value: min_gap.value,
        threshold: 2.0,
        sentence: format!("The gap to cp1 fell to {:.2} m, below 2.00 m.", min_gap.value),
    });
    let hard_braking = (braking.value > 4.0).then(|| Finding {
        kind: FindingKind::HardBraking,
        time_s: braking.time_s,
        value: braking.value,
        threshold: 4.0,
        sentence: format!("The ego braked at {:.1} m/s².", braking.value),
    });
    [contact, near_miss, hard_braking].into_iter().flatten().collect()
}

/// Two of one mass that stick together, head-on.
fn severity(contact: &Contact) -> Severity {
    let side = |impact_speed_mps: f64| Suffered {
        impact_speed_mps,
        mass_kg: Some(1500.0),
        delta_v_mps: contact.relative_speed_mps / 2.0,
        force_clock: Some(12),
        risks: vec![InjuryRisk {
            outcome: InjuryOutcome::Mais3,
            probability: (0.001 * contact.relative_speed_mps).min(1.0),
            curve: RiskCurve::Wang2022,
        }],
    };
    Severity {
        closing_speed_mps: contact.relative_speed_mps,
        normal_speed_mps: contact.relative_speed_mps,
        overlap: 1.0,
        first: side(contact.ego_speed_mps),
        second: side(contact.other_speed_mps),
        obstacle: None,
        nobody: None,
    }
}

fn verdict(cluster: &Cluster, touched: bool) -> Verdict {
    let t = cluster.template;
    let check = |kind, expected: &str, observed: &str, result| Check {
        kind,
        expected: expected.into(),
        observed: observed.into(),
        result,
    };
    let turned_back = cluster.number == 17;
    Verdict {
        checks: vec![
            check(CheckKind::Road, t.road.label(), t.road.label(), CheckResult::Shown),
            check(CheckKind::SvMovement, t.sv.label(), t.sv.label(), CheckResult::Shown),
            check(
                CheckKind::CpMovement,
                t.cp.label(),
                if turned_back { "Proceeding straight" } else { t.cp.label() },
                if turned_back { CheckResult::NotShown } else { CheckResult::Shown },
            ),
            check(CheckKind::Encounter, "the partner is nearest to the ego", "it is", CheckResult::Shown),
            if touched {
                check(CheckKind::ContactZones, "left; front", "left; front", CheckResult::Shown)
            } else {
                check(CheckKind::ContactZones, "left; front", "no contact", CheckResult::CannotBeShown)
            },
        ],
    }
}

fn scenario(cluster: &Cluster, plan: &Plan, arrival_gap_s: f64) -> ScenarioDraft {
    ScenarioDraft {
        format: SCENARIO_FORMAT.into(),
        id: cluster.scenario_id.clone(),
        source: Source {
            records: vec![cluster.pick.clone()],
            origin: None,
            template: Some(cluster.template),
            narrative: String::new(),
            author: Author::Rules,
            seed: 7,
        },
        map: MapSpec::X(CrossMap {
            lanes: 2,
            lane_width_m: roads::LANE,
            approach_m: roads::APPROACH,
            arm_m: roads::APPROACH,
        }),
        ego: EgoSpec {
            turn: Turn::Straight,
            lane: 1,
            s_m: 5.0,
            speed_mps: plan.ego_speed,
            target_speed_mps: plan.ego_speed,
            ..EgoSpec::default()
        },
        partners: vec![Partner {
            id: "cp1".into(),
            kind: plan.partner_kind,
            approach: Approach::Left,
            turn: Turn::Straight,
            lane_offset: 0,
            start: Start::ArrivalGap { arrival_gap_s },
            speed_mps: plan.partner_speed,
            policy: Policy::IdmNominal { target_speed_mps: plan.partner_speed },
            lateral: vec![],
        }],
        obstacles: vec![],
        traffic: Traffic::default(),
        environment: Environment::default(),
        duration_s: 40.0,
        ..ScenarioDraft::default()
    }
}
