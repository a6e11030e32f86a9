//! Metrics of one rollout.

use crate::contact::contact_geometry;
use crate::ego::{following, measure_ego};
use crate::encroachment::post_encroachment_time;
use crate::scene::{Along, EgoWay, Scene, gap_at, time_of, with_parts};
use crate::swept::time_to_collision;
use recrash_model::geometry::OrientedBox;
use recrash_model::metrics::{Contact, Metrics, PartnerMetrics, PartnerSeries, Series, Timed};
use recrash_model::profile::FailureCriteria;
use recrash_model::rollout::{EventKind, Role, Rollout, STEP_S};
use recrash_roads::Scenario;

/// Metrics of a rollout of a scenario. Nothing before the handover is measured (a run of the recorded driver has none), and
/// nothing after the ego's first contact with a road user.
pub fn measure(scenario: &Scenario, rollout: &Rollout, criteria: &FailureCriteria) -> Metrics {
    measure_on(&EgoWay::of(scenario), rollout, criteria)
}

/// Metrics of a rollout on a way of the ego's.
pub fn measure_on(way: &EgoWay<'_>, rollout: &Rollout, criteria: &FailureCriteria) -> Metrics {
    let scene = Scene::new(rollout, way.handover_s);
    let along = Along::track(way, scene.outlines.first().map_or(&[], Vec::as_slice));
    let partners: Vec<PartnerMetrics> =
        (1..rollout.actors.len()).filter_map(|actor| measure_partner(&scene, way, &along, actor)).collect();
    Metrics {
        obstacle_gaps: (0..scene.obstacles.len()).filter_map(|obstacle| obstacle_gap(&scene, obstacle)).collect(),
        contact: first_contact(&scene),
        obstacles_hit: obstacle_contacts(&scene).map(|(obstacle, _)| obstacle).collect(),
        min_gap: least_of(&partners, rollout, |partner| partner.min_gap),
        min_centre_distance: least_of(&partners, rollout, |partner| partner.min_centre_distance),
        partners,
        ego: measure_ego(&scene, way, &along, criteria),
        termination: rollout.termination.kind,
        duration_s: rollout.termination.time_s,
    }
}

/// Time series of a rollout, for plots: every recorded step, those after a contact too.
pub fn series(rollout: &Rollout) -> Series {
    let Some(ego) = rollout.actors.first() else {
        return Series {
            time_s: Vec::new(),
            ego_speed_mps: Vec::new(),
            ego_acceleration_mps2: Vec::new(),
            partners: Vec::new(),
        };
    };
    let mine = with_parts(rollout, 0);
    let speeds = |actor: usize| rollout.actors[actor].states.iter().map(|state| state.speed()).collect::<Vec<f64>>();
    let partners = rollout.actors.iter().enumerate().filter(|(_, track)| track.role == Role::Partner);
    let partners = partners
        .map(|(actor, track)| {
            let steps = ego.states.len().min(track.states.len());
            let theirs = with_parts(rollout, actor);
            let mut series = PartnerSeries {
                actor,
                id: track.id.clone(),
                speed_mps: speeds(actor),
                acceleration_mps2: differences(&speeds(actor)),
                gap_m: Vec::with_capacity(steps),
                centre_distance_m: Vec::with_capacity(steps),
                ttc_s: Vec::with_capacity(steps),
            };
            for step in 0..steps {
                let (a, b) = (ego.outline(step), track.outline(step));
                let (velocity_a, velocity_b) = (ego.states[step].velocity(), track.states[step].velocity());
                series.gap_m.push(gap_at(rollout, (&mine, &theirs), step));
                series.centre_distance_m.push(a.centre.distance(b.centre));
                series.ttc_s.push(time_to_collision(&a, velocity_a, &b, velocity_b));
            }
            series
        })
        .collect();
    let ego_speed_mps = speeds(0);
    Series {
        time_s: (0..ego.states.len()).map(time_of).collect(),
        ego_acceleration_mps2: differences(&ego_speed_mps),
        ego_speed_mps,
        partners,
    }
}

/// Forward differences per second, the last one repeated.
fn differences(speeds: &[f64]) -> Vec<f64> {
    let mut all: Vec<f64> = speeds.windows(2).map(|pair| (pair[1] - pair[0]) / STEP_S).collect();
    if !speeds.is_empty() {
        all.push(all.last().copied().unwrap_or(0.0));
    }
    all
}

fn measure_partner(scene: &Scene<'_>, way: &EgoWay<'_>, along: &[Along], actor: usize) -> Option<PartnerMetrics> {
    let (egos, others) = (&scene.outlines[0], &scene.outlines[actor]);
    let touched = scene.contact_boxes().filter(|(contact, ..)| contact.actor == actor);
    let steps = scene.counted_with(actor);
    if steps.is_empty() && touched.is_none() {
        return None;
    }
    let boxes = Boxes::of(scene, actor);
    let mut min_gap = Timed { value: f64::INFINITY, time_s: 0.0 };
    let mut min_centre_distance = min_gap;
    let (mut min_ttc, mut max_drac, mut max_required_deceleration, mut min_headway) = (None, None, None, None);
    for step in steps.clone() {
        let (ego, other, time_s) = (&egos[step], &others[step], time_of(step));
        let distance = ego.centre.distance(other.centre);
        if distance < min_centre_distance.value {
            min_centre_distance = Timed { value: distance, time_s };
        }
        let gap = boxes.least_gap(step, min_gap.value);
        if gap < min_gap.value {
            min_gap = Timed { value: gap, time_s };
        }
        let ttc = time_to_collision(ego, scene.velocity(0, step), other, scene.velocity(actor, step));
        keep_least(&mut min_ttc, ttc, time_s);
        if let Some(following) = following(scene, way, &along[step], actor, step) {
            keep_least(&mut min_headway, following.headway_s(), time_s);
            keep_greatest(&mut max_drac, following.drac_mps2(), time_s);
            let required = following.required_deceleration_mps2();
            keep_greatest(&mut max_required_deceleration, (required > 0.0).then_some(required), time_s);
        }
    }
    let mut pet = post_encroachment_time((egos, scene.counted()), (others, scene.present(actor)), STEP_S);
    if let Some((contact, ego, other)) = touched {
        let touched = Timed { value: 0.0, time_s: contact.time_s };
        (min_gap, min_ttc, pet) = (touched, Some(touched), Some(touched));
        let distance = ego.centre.distance(other.centre);
        if distance < min_centre_distance.value {
            min_centre_distance = Timed { value: distance, time_s: contact.time_s };
        }
    }
    Some(PartnerMetrics {
        actor,
        id: scene.rollout.actors[actor].id.clone(),
        min_gap,
        min_centre_distance,
        min_ttc,
        pet,
        max_drac,
        max_required_deceleration,
        min_headway,
    })
}

/// The boxes of the ego and of another, with those of their parts.
struct Boxes<'a> {
    mine: Vec<&'a [OrientedBox]>,
    theirs: Vec<&'a [OrientedBox]>,
}

impl<'a> Boxes<'a> {
    fn of(scene: &'a Scene<'_>, actor: usize) -> Self {
        let all = |actor: usize| {
            let members = with_parts(scene.rollout, actor);
            members.into_iter().map(|member| scene.outlines[member].as_slice()).collect()
        };
        Self { mine: all(0), theirs: all(actor) }
    }

    /// The least gap of two of them at a step, where that is below what is known already.
    fn least_gap(&self, step: usize, known_m: f64) -> f64 {
        let pairs = self.mine.iter().flat_map(|mine| self.theirs.iter().map(move |theirs| (mine, theirs)));
        let there = pairs.filter_map(|(mine, theirs)| mine.get(step).zip(theirs.get(step)));
        there.fold(known_m, |least, (mine, theirs)| {
            // The boxes lie inside circles around their centres: most steps need no exact gap.
            let apart = mine.centre.distance(theirs.centre) - mine.radius() - theirs.radius();
            if apart < least { least.min(mine.gap(theirs)) } else { least }
        })
    }
}

fn keep_least(kept: &mut Option<Timed>, value: Option<f64>, time_s: f64) {
    if let Some(value) = value
        && kept.is_none_or(|kept| value < kept.value)
    {
        *kept = Some(Timed { value, time_s });
    }
}

fn keep_greatest(kept: &mut Option<Timed>, value: Option<f64>, time_s: f64) {
    if let Some(value) = value
        && kept.is_none_or(|kept| value > kept.value)
    {
        *kept = Some(Timed { value, time_s });
    }
}

/// The least over the scripted partners; over background traffic where there is no scripted one.
fn least_of(partners: &[PartnerMetrics], rollout: &Rollout, of: impl Fn(&PartnerMetrics) -> Timed) -> Option<Timed> {
    let least = |role: Role| {
        partners
            .iter()
            .filter(|partner| rollout.actors[partner.actor].role == role)
            .map(&of)
            .min_by(|a, b| a.value.total_cmp(&b.value))
    };
    least(Role::Partner).or_else(|| least(Role::Traffic))
}

fn first_contact(scene: &Scene<'_>) -> Option<Contact> {
    let (contact, ego, other) = scene.contact_boxes()?;
    let (ego_velocity, other_velocity) = (contact.ego.velocity(), contact.other.velocity());
    let geometry = contact_geometry(&ego, ego_velocity, &other, other_velocity);
    Some(Contact {
        actor: contact.actor,
        id: scene.rollout.actors[contact.actor].id.clone(),
        time_s: contact.time_s,
        ego_zone: geometry.ego_zone,
        other_zone: geometry.other_zone,
        kind: geometry.kind,
        relative_speed_mps: (other_velocity - ego_velocity).length(),
        ego_speed_mps: ego_velocity.length(),
        other_speed_mps: other_velocity.length(),
    })
}

/// Obstacles the ego touched at the steps that count, in order of time, with the time.
pub(crate) fn obstacle_contacts<'a>(scene: &'a Scene<'_>) -> impl Iterator<Item = (usize, f64)> + 'a {
    let counts = time_of(scene.first) - 1e-9..=scene.end_s + 1e-9;
    scene.rollout.events.iter().filter(move |event| counts.contains(&event.time_s)).filter_map(|event| {
        match event.kind {
            EventKind::ObstacleContact { actor: 0, obstacle, .. } => Some((obstacle, event.time_s)),
            _ => None,
        }
    })
}

/// `None` only where no state of the ego counts.
fn obstacle_gap(scene: &Scene<'_>, obstacle: usize) -> Option<Timed> {
    if let Some((_, time_s)) = obstacle_contacts(scene).find(|&(hit, _)| hit == obstacle) {
        return Some(Timed { value: 0.0, time_s });
    }
    let outline = &scene.obstacles[obstacle];
    let mut least = Timed { value: f64::INFINITY, time_s: 0.0 };
    for (step, ego) in scene.ego() {
        if ego.centre.distance(outline.centre) - ego.radius() - outline.radius() < least.value {
            let gap = ego.gap(outline);
            if gap < least.value {
                least = Timed { value: gap, time_s: time_of(step) };
            }
        }
    }
    least.value.is_finite().then_some(least)
}
