//! Faithfulness: whether a rollout shows what its record tells.
//!
//! A witness's view: the map's roads, the paths driven and the boxes at the closest encounter. What the scenario's
//! author wrote beside them (`turn`, `approach`, the template in `source`) is never read. Rules and reasons:
//! `docs/models/faithfulness.md`.

pub mod layout;
pub mod movement;
mod order;

use crate::contact::{ContactGeometry, contact_geometry};
use crate::scene::{Scene, time_of};
use layout::Layout;
use movement::{degrees, driven};
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::math;
use recrash_model::metrics::{
    Check, CheckKind, CheckResult, CollisionKind, Expectation, Metrics, PartnerMetrics, Verdict,
};
use recrash_model::narrative::{FirstMover, Side};
use recrash_model::rollout::{Role, Rollout};
use recrash_model::scenario::Approach;
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone;
use recrash_roads::{RoadNetwork, RoadPart, Scenario};

/// A crash this near a junction is an intersection's. [m] (assumed; crash data call 15 to 75 m intersection-related)
const JUNCTION_INFLUENCE_M: f64 = 30.0;

/// Obstacles the ego comes this near to are on its way. [m] (the range in which MetaDrive's IDM sees)
const OBSTACLE_NEAR_M: f64 = 30.0;

/// Who is told first may come this much later: a car's length of time in town. [s] (assumed)
const ORDER_TOLERANCE_S: f64 = 0.5;

/// The paths are looked at this long before and after the closest encounter. [steps]
const ORDER_STEPS: usize = 80;

/// Who are told together come within this: one that passes the other without contact must clear its way first. [s]
/// (assumed)
const TOGETHER_S: f64 = 2.5;

/// Told speeds may be wrong by this share... (assumed: a little more than tuning may move them)
const SPEED_SHARE: f64 = 0.4;

/// ... or by this, which is more at low speeds. [m/s] (assumed: 5 mph)
const SPEED_MARGIN_MPS: f64 = 2.2;

/// A partner beside the ego is at least this far to one side: half a car. [m] (assumed)
const BESIDE_M: f64 = 0.9;

/// Farther apart, nobody calls it an encounter, unless the times below say so. [m] (assumed)
const ENCOUNTER_M: f64 = 10.0;

/// Time to collision or post-encroachment time that makes an encounter of a larger gap. [s] (assumed)
const ENCOUNTER_S: f64 = 3.0;

/// A least gap this early is where the vehicles were put, not something they did. [s]
const START_S: f64 = 0.3;

/// Zones and kind of collision are predicted for near misses closer than this. [m]
const PREDICTED_BELOW_M: f64 = 2.0;

/// Zones this many steps around the box apart still agree: reports name neighbouring zones for one blow.
const ZONE_STEPS: u8 = 1;

/// Whether a rollout is true to its record.
pub fn faithfulness(scenario: &Scenario, rollout: &Rollout, metrics: &Metrics, expectation: &Expectation) -> Verdict {
    faithfulness_on(scenario.network(), rollout, metrics, expectation)
}

/// [`faithfulness`] on a road network: nothing else of the scenario is looked at.
pub fn faithfulness_on(
    network: &RoadNetwork,
    rollout: &Rollout,
    metrics: &Metrics,
    expectation: &Expectation,
) -> Verdict {
    let scene = Scene::new(rollout, 0.0);
    let partner = closest_partner(rollout, metrics);
    let Some(layout) = Layout::of(network).filter(|_| scene.steps() > 0) else {
        return Verdict { checks: vec![check(CheckKind::Road, "a rollout", "no rollout", false)] };
    };
    let witness = Witness { network, layout, partner, scene, metrics, expectation };
    Verdict {
        checks: vec![
            witness.road(),
            witness.work_zone(),
            witness.movement(CheckKind::SvMovement, Some(0), expectation.template.sv),
            witness.movement(CheckKind::CpMovement, partner.map(|partner| partner.actor), expectation.template.cp),
            witness.approach(),
            witness.order(),
            witness.speed(CheckKind::SvSpeed, Some(0), expectation.sv_speed_mps),
            witness.speed(CheckKind::CpSpeed, partner.map(|partner| partner.actor), expectation.cp_speed_mps),
            witness.encounter(),
            witness.contact_zones(),
            witness.excluded_collision(),
        ],
    }
}

/// The partner the encounter is with: the one the ego touched, else the one it came closest to.
fn closest_partner<'a>(rollout: &Rollout, metrics: &'a Metrics) -> Option<&'a PartnerMetrics> {
    metrics
        .partners
        .iter()
        .filter(|partner| rollout.actors.get(partner.actor).is_some_and(|track| track.role == Role::Partner))
        .min_by(|a, b| a.min_gap.value.total_cmp(&b.min_gap.value))
}

/// All that is looked at.
struct Witness<'a> {
    network: &'a RoadNetwork,
    layout: Layout,
    partner: Option<&'a PartnerMetrics>,
    scene: Scene<'a>,
    metrics: &'a Metrics,
    expectation: &'a Expectation,
}

impl Witness<'_> {
    fn road(&self) -> Check {
        let expected = self.expectation.template.road;
        let place = self.boxes_at_encounter().map_or(self.scene.outlines[0][self.scene.steps() - 1], |(ego, _)| ego);
        let distance = self.layout.distance_from_junction(place.centre);
        let at_junction = distance.is_some_and(|distance| distance <= JUNCTION_INFLUENCE_M);
        let at_circle = at_junction && matches!(self.layout, Layout::Circle { .. });
        let template = &self.expectation.template;
        let turns = |movement| matches!(movement, Movement::LeftTurn | Movement::RightTurn | Movement::UTurn);
        let agrees = match expected {
            RoadType::Intersection => at_junction && !at_circle,
            RoadType::TrafficCircle => at_circle,
            // Who turns off a highway or street may need somewhere to turn to: a junction at grade.
            RoadType::Highway | RoadType::Street | RoadType::RuralRoad | RoadType::UnpavedRoad => {
                !at_circle && (!at_junction || turns(template.sv) || turns(template.cp))
            }
            RoadType::ParkingLot | RoadType::ParkingGarage => false,
        };
        let observed = match (at_circle, at_junction, distance) {
            (true, ..) => "at a roundabout".to_owned(),
            (_, true, Some(distance)) if distance > 0.0 => format!("{distance:.0} m before or behind a junction"),
            (_, true, _) => "in a junction".to_owned(),
            (_, _, Some(distance)) => format!("on a road, {distance:.0} m from the junction"),
            (_, _, None) => "on a road without junction".to_owned(),
        };
        check(CheckKind::Road, expected.label(), observed, agrees)
    }

    fn work_zone(&self) -> Check {
        let near = self.metrics.obstacle_gaps.iter().filter(|gap| gap.value <= OBSTACLE_NEAR_M).count();
        let all = self.scene.obstacles.len();
        let in_junction = |outline: &&OrientedBox| self.layout.distance_from_junction(outline.centre) == Some(0.0);
        let misplaced = self.scene.obstacles.iter().filter(in_junction).count();
        let observed = match (near, all) {
            _ if misplaced > 0 => format!("{misplaced} obstacle(s) in the junction"),
            (_, 0) => "no obstacles".to_owned(),
            (0, all) => format!("{all} obstacle(s), none within {OBSTACLE_NEAR_M:.0} m of the ego's way"),
            (near, _) => format!("{near} obstacle(s) on the ego's way"),
        };
        let (expected, agrees) = if self.expectation.template.work_zone {
            ("work zone", near > 0 && misplaced == 0)
        } else if self.expectation.obstacles_named {
            ("no work zone, obstacles in the narrative", near > 0 && misplaced == 0)
        } else {
            ("no work zone", all == 0)
        };
        check(CheckKind::WorkZone, expected, observed, agrees)
    }

    fn movement(&self, kind: CheckKind, actor: Option<usize>, expected: Movement) -> Check {
        let Some(actor) = actor else { return check(kind, expected.label(), "no scripted partner", false) };
        let driven = driven(&self.layout, self.network, &self.scene.outlines[actor]);
        Check {
            kind,
            expected: expected.label().to_owned(),
            observed: driven.describe(),
            result: driven.shows(expected),
        }
    }

    fn approach(&self) -> Check {
        let Some(expected) = self.expectation.approach else {
            return not_told(CheckKind::Approach, "not stated", "");
        };
        let first = |actor: usize| self.scene.outlines.get(actor).and_then(|outlines| outlines.first());
        let pair = self.partner.and_then(|partner| Some((first(0)?, first(partner.actor)?)));
        let Some((ego, other)) = pair else {
            return check(CheckKind::Approach, label(expected), "no scripted partner", false);
        };
        let observed = self.approach_of(ego, other);
        let side = self.side_of(ego, other);
        let text = |approach: Approach, side: Option<Side>| match (approach, side) {
            (Approach::Same, Some(Side::Left)) => format!("{}, on its left", label(approach)),
            (Approach::Same, Some(Side::Right)) => format!("{}, on its right", label(approach)),
            _ => label(approach).to_owned(),
        };
        let beside = self.expectation.side.filter(|_| expected == Approach::Same);
        let agrees = observed == Some(expected) && beside.is_none_or(|told| side == Some(told));
        let shown = observed.map_or_else(|| "from no arm in particular".to_owned(), |approach| text(approach, side));
        check(CheckKind::Approach, text(expected, beside), shown, agrees)
    }

    /// On which side of the ego another starts; `None` in line with it.
    fn side_of(&self, ego: &OrientedBox, other: &OrientedBox) -> Option<Side> {
        let left_m = match &self.layout {
            Layout::Plain { along } => {
                let t = |outline: &OrientedBox| along.project(outline.centre, 0).t;
                let road = self.layout.road_heading(ego.centre);
                let with_road = Vec2::from_heading(road).dot(ego.axis) >= 0.0;
                if with_road { t(ego) - t(other) } else { t(other) - t(ego) }
            }
            Layout::Junction { .. } | Layout::Circle { .. } => ego.to_local(other.centre).y,
        };
        match left_m {
            left if left >= BESIDE_M => Some(Side::Left),
            left if left <= -BESIDE_M => Some(Side::Right),
            _ => None,
        }
    }

    fn order(&self) -> Check {
        let Some(expected) = self.expectation.order else {
            return not_told(CheckKind::Order, "not stated", "");
        };
        let told = match expected {
            FirstMover::Sv => "the ego first",
            FirstMover::Cp => "the partner first",
            FirstMover::Both => "both at about the same time",
        };
        let Some(partner) = self.partner else {
            return check(CheckKind::Order, told, "no scripted partner", false);
        };
        let around = self.step_at(partner.min_gap.time_s, partner.actor);
        let near = |actor: usize| {
            let outlines = &self.scene.outlines[actor];
            &outlines[around.saturating_sub(ORDER_STEPS)..(around + ORDER_STEPS).min(outlines.len())]
        };
        let Some(lag_s) = order::lag(near(0), near(partner.actor)) else {
            return check(CheckKind::Order, told, "their paths do not meet", false);
        };
        let agrees = match expected {
            FirstMover::Sv => lag_s >= -ORDER_TOLERANCE_S,
            FirstMover::Cp => lag_s <= ORDER_TOLERANCE_S,
            FirstMover::Both => lag_s.abs() <= TOGETHER_S,
        };
        let first = if lag_s >= 0.0 { "the ego" } else { "the partner" };
        check(CheckKind::Order, told, format!("{first} first, by {:.1} s", lag_s.abs()), agrees)
    }

    /// The greatest speed up to the encounter: what comes after braking for it is no told speed.
    fn speed(&self, kind: CheckKind, actor: Option<usize>, told_mps: Option<f64>) -> Check {
        let Some(told_mps) = told_mps else { return not_told(kind, "not stated", "") };
        let expected = format!("about {told_mps:.1} m/s");
        let Some(actor) = actor else { return check(kind, expected, "no scripted partner", false) };
        let all = self.scene.outlines[actor].len();
        let steps =
            self.partner.map_or(all, |partner| all.min(self.step_at(partner.min_gap.time_s, partner.actor) + 1));
        let driven = (0..steps).map(|step| self.scene.velocity(actor, step).length()).fold(0.0, f64::max);
        let agrees = (driven - told_mps).abs() <= (SPEED_SHARE * told_mps).max(SPEED_MARGIN_MPS);
        check(kind, expected, format!("up to {driven:.1} m/s"), agrees)
    }

    /// From where a road user comes that starts as `other`, seen from the ego's start.
    fn approach_of(&self, ego: &OrientedBox, other: &OrientedBox) -> Option<Approach> {
        if matches!(self.layout, Layout::Circle { .. }) {
            let heading = math::atan2(other.axis.y, other.axis.x);
            let lane = self.network.lane_at(other.centre, heading)?;
            if self.network.road(self.network.lane(lane).road).part == RoadPart::Ring {
                return Some(Approach::Ring);
            }
        }
        let road = |outline: &OrientedBox| self.layout.road_heading(outline.centre);
        let relative = math::atan2(ego.axis.cross(other.axis), ego.axis.dot(other.axis));
        let turned = degrees(math::wrap_angle(relative - (road(other) - road(ego))));
        let on_left = ego.to_local(other.centre).y > 0.0;
        match turned {
            t if t.abs() <= 45.0 => Some(Approach::Same),
            t if t.abs() >= 135.0 => Some(Approach::Opposite),
            // Who comes from the left heads to the right.
            t if t < 0.0 && on_left => Some(Approach::Left),
            t if t > 0.0 && !on_left => Some(Approach::Right),
            _ => None,
        }
    }

    fn encounter(&self) -> Check {
        const EXPECTED: &str = "the partner in the closest encounter";
        let Some(partner) = self.partner else {
            return check(CheckKind::Encounter, EXPECTED, "no scripted partner", false);
        };
        if let Some(contact) = &self.metrics.contact {
            let observed = format!("contact with {} at {:.1} s", contact.id, contact.time_s);
            return check(CheckKind::Encounter, EXPECTED, observed, contact.actor == partner.actor);
        }
        let closer = self.metrics.partners.iter().find(|other| other.min_gap.value < partner.min_gap.value);
        if let Some(closer) = closer {
            let observed = format!("{} came closer ({:.1} m)", closer.id, closer.min_gap.value);
            return check(CheckKind::Encounter, EXPECTED, observed, false);
        }
        let gap = partner.min_gap;
        let soon = |value: Option<recrash_model::metrics::Timed>| value.is_some_and(|value| value.value <= ENCOUNTER_S);
        let met = gap.value <= ENCOUNTER_M || soon(partner.min_ttc) || soon(partner.pet);
        let (observed, agrees) = if !met {
            (format!("never closer than {:.1} m", gap.value), false)
        } else if gap.time_s < START_S {
            (format!("closest at the very start ({:.1} m)", gap.value), false)
        } else {
            (format!("{:.1} m to {} at {:.1} s", gap.value, partner.id, gap.time_s), true)
        };
        check(CheckKind::Encounter, EXPECTED, observed, agrees)
    }

    fn contact_zones(&self) -> Check {
        let bind =
            |zones: &[ContactZone]| zones.iter().copied().filter(|zone| zone.steps_apart(*zone).is_some()).collect();
        let (sv, cp): (Vec<ContactZone>, Vec<ContactZone>) =
            (bind(&self.expectation.sv_zones), bind(&self.expectation.cp_zones));
        let name = |zones: &[ContactZone]| match zones {
            [] => "any".to_owned(),
            zones => zones.iter().map(|zone| zone.label()).collect::<Vec<_>>().join(", "),
        };
        let expected = format!("SV {}; CP {}", name(&sv), name(&cp));
        let told = !(sv.is_empty() && cp.is_empty());
        let Some((geometry, predicted)) = self.contact() else {
            let result = if told { CheckResult::CannotBeShown } else { CheckResult::NotTold };
            return Check { kind: CheckKind::ContactZones, expected, observed: "no contact".to_owned(), result };
        };
        let (on_sv, on_cp) = (geometry.ego_zone, geometry.other_zone);
        let how = if predicted { ", as predicted from the closest approach" } else { "" };
        let observed = format!("SV {}; CP {}{how}", on_sv.label(), on_cp.label());
        if !told {
            return not_told(CheckKind::ContactZones, &expected, &observed);
        }
        let agree = |zones: &[ContactZone], shown: ContactZone| {
            zones.is_empty()
                || zones.iter().any(|zone| zone.steps_apart(shown).is_some_and(|steps| steps <= ZONE_STEPS))
        };
        check(CheckKind::ContactZones, expected, observed, agree(&sv, on_sv) && agree(&cp, on_cp))
    }

    fn excluded_collision(&self) -> Check {
        let excluded = &self.expectation.excluded;
        if excluded.is_empty() {
            return not_told(CheckKind::ExcludedCollision, "no kind excluded", "");
        }
        let expected = format!("no {}", excluded.iter().map(|kind| kind.label()).collect::<Vec<_>>().join(", no "));
        match self.contact() {
            None => check(CheckKind::ExcludedCollision, expected, "no contact", true),
            Some((geometry, predicted)) => {
                let article = if geometry.kind == CollisionKind::Angle { "an" } else { "a" };
                let nearly = if predicted { "nearly " } else { "" };
                let observed = format!("{nearly}{article} {} collision", geometry.kind.label());
                check(CheckKind::ExcludedCollision, expected, observed, !excluded.contains(&geometry.kind))
            }
        }
    }

    /// The geometry of the contact, or of the one a near miss would have been, and whether it is predicted.
    fn contact(&self) -> Option<(ContactGeometry, bool)> {
        if let Some((contact, ego, other)) = self.scene.contact_boxes() {
            let (ego_velocity, other_velocity) = (contact.ego.velocity(), contact.other.velocity());
            return Some((contact_geometry(&ego, ego_velocity, &other, other_velocity), false));
        }
        let partner = self.partner.filter(|partner| partner.min_gap.value < PREDICTED_BELOW_M)?;
        let step = self.step_at(partner.min_gap.time_s, partner.actor);
        let (ego, other) = (&self.scene.outlines[0][step], &self.scene.outlines[partner.actor][step]);
        let (ego_velocity, other_velocity) = (self.scene.velocity(0, step), self.scene.velocity(partner.actor, step));
        Some((contact_geometry(ego, ego_velocity, other, other_velocity), true))
    }

    /// Both boxes at the contact, or at the closest approach to the partner.
    fn boxes_at_encounter(&self) -> Option<(OrientedBox, OrientedBox)> {
        if let Some((_, ego, other)) = self.scene.contact_boxes() {
            return Some((ego, other));
        }
        let partner = self.partner?;
        let step = self.step_at(partner.min_gap.time_s, partner.actor);
        Some((self.scene.outlines[0][step], self.scene.outlines[partner.actor][step]))
    }

    fn step_at(&self, time_s: f64, actor: usize) -> usize {
        ((time_s / time_of(1)).round() as usize).min(self.scene.steps_with(actor).saturating_sub(1))
    }
}

fn label(approach: Approach) -> &'static str {
    match approach {
        Approach::Same => "in the ego's direction",
        Approach::Opposite => "from ahead, towards the ego",
        Approach::Left => "from the left",
        Approach::Right => "from the right",
        Approach::Ring => "on the ring",
    }
}

fn check(kind: CheckKind, expected: impl Into<String>, observed: impl Into<String>, agrees: bool) -> Check {
    let result = if agrees { CheckResult::Shown } else { CheckResult::NotShown };
    Check { kind, expected: expected.into(), observed: observed.into(), result }
}

fn not_told(kind: CheckKind, expected: &str, observed: &str) -> Check {
    Check { kind, expected: expected.to_owned(), observed: observed.to_owned(), result: CheckResult::NotTold }
}
