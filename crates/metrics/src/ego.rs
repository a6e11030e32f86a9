//! Measures of the ego alone: braking, phantom braking, oscillation, lane departure, distance, speed.
//!
//! Models and thresholds: `docs/models/ego-behaviour.md`.

use crate::following::Following;
use crate::scene::{Along, EgoWay, STANDSTILL_MPS, Scene, time_of};
use crate::swept::time_to_collision;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::math;
use recrash_model::metrics::{EgoMetrics, Timed};
use recrash_model::profile::FailureCriteria;
use recrash_model::scenario::{Aspect, Device, MapKind};
use recrash_model::vehicle::TYRE_LIMIT_MPS2;
use recrash_roads::{RoadId, RoadPart};

/// Weaker braking is no braking: engine drag alone gives 0.36 m/s^2. [m/s^2] (assumed)
const LEAST_BRAKING_MPS2: f64 = 0.5;

/// A weaker command to the brake is none: this one gives those 0.5 m/s^2. [share of full brake]
const LEAST_BRAKE: f64 = 0.02;

/// Whatever lies in the corridor within this time at present speed is a reason to brake. [s] (assumed)
const LOOK_AHEAD_S: f64 = 3.0;

/// And within this distance at any speed. [m] (assumed)
const LOOK_AHEAD_M: f64 = 10.0;

/// Whatever would come within the margin in this time, if all went straight on, is a reason to brake. [s] (assumed)
const CROSSING_AHEAD_S: f64 = 4.0;

/// Whoever comes into the corridor within this time, no farther ahead than this time at present speed, is a reason to
/// brake. [s] (assumed; gap acceptance at junctions is 4 to 7 s)
const GIVE_WAY_S: f64 = 5.0;

/// And within this distance at any speed. [m] (assumed)
const GIVE_WAY_M: f64 = 15.0;

/// Room a driver leaves beside the vehicle. [m] (assumed)
const MARGIN_M: f64 = 0.5;

/// A reason to brake counts for this long after it is gone: reaction and release of the brake. [s] (assumed)
const RELEASE_S: f64 = 0.5;

/// A curve that would ask for more sideways acceleration than this is a reason to brake. [m/s^2] (comfort limit, about
/// 0.2 g)
const COMFORT_LATERAL_MPS2: f64 = 2.0;

/// A comfortable stop: for a line or a stop of its task the ego may begin to brake so far away that it takes no more. [m/s^2]
/// (the drivers' own, `docs/models/control.md`)
const COMFORT_STOP_MPS2: f64 = 2.0;

/// A stop farther behind than this is done. [m] (as for the drivers)
const PASSED_STOP_M: f64 = 5.0;

/// A stop line farther behind than this is passed. [m] (as for the drivers)
const PASSED_LINE_M: f64 = 1.5;

/// Where a stop of its task lies beside the lane, it pulls over and out again within this of it. [m] (as the drivers do)
const PULL_OVER_M: f64 = 34.0;

/// Who heads within this of a lane drives along it. [rad]
const ALONG_RAD: f64 = 45.0 * math::PI / 180.0;

/// A lane change that takes longer than this is a departure. [s] (twice a slow lane change)
const LANE_CHANGE_S: f64 = 4.0;

/// Measures of the ego alone over the scene.
pub fn measure_ego(scene: &Scene<'_>, way: &EgoWay<'_>, along: &[Along], criteria: &FailureCriteria) -> EgoMetrics {
    let (max_reversals, max_reversals_time_s) = most_reversals(scene, criteria.oscillation_window_s);
    let ego = || scene.ego().map(|(_, outline)| outline.centre);
    let distance_m = ego().zip(ego().skip(1)).map(|(from, to)| from.distance(to)).sum::<f64>();
    let driven_s = time_of(scene.counted().len().saturating_sub(1));
    EgoMetrics {
        max_deceleration: hardest_braking(scene),
        tyre_limit_mps2: TYRE_LIMIT_MPS2 * way.surface.relative_friction(),
        phantom_braking: hardest_phantom_braking(scene, way, along),
        max_reversals,
        max_reversals_time_s,
        max_lane_departure: farthest_departure(scene, way, along),
        distance_m,
        mean_speed_mps: if driven_s > 0.0 { distance_m / driven_s } else { 0.0 },
    }
}

/// How the ego's brake is told from other losses of speed: a steered wheel costs speed, too.
struct Brake {
    /// Whether the rollout says what the ego commanded; without, every deceleration counts as braking.
    commands_known: bool,
}

impl Brake {
    fn of(scene: &Scene<'_>) -> Self {
        let ego = scene.rollout.actors.first();
        Self { commands_known: ego.is_some_and(|track| track.states.iter().any(|state| state.throttle != 0.0)) }
    }

    /// Deceleration over the step that begins at `step`, where the ego brakes; else nil. [m/s^2, positive]
    fn deceleration(&self, scene: &Scene<'_>, step: usize) -> f64 {
        if self.commands_known && scene.state(0, step).throttle > -LEAST_BRAKE {
            return 0.0;
        }
        (-scene.acceleration(0, step)).max(0.0)
    }
}

fn hardest_braking(scene: &Scene<'_>) -> Timed {
    let brake = Brake::of(scene);
    let mut hardest = Timed { value: 0.0, time_s: 0.0 };
    for step in scene.first..scene.steps().saturating_sub(1) {
        let deceleration = brake.deceleration(scene, step);
        if deceleration > hardest.value {
            hardest = Timed { value: deceleration, time_s: time_of(step) };
        }
    }
    hardest
}

fn hardest_phantom_braking(scene: &Scene<'_>, way: &EgoWay<'_>, along: &[Along]) -> Option<Timed> {
    let release_steps = (RELEASE_S / time_of(1)).round() as usize;
    let brake = Brake::of(scene);
    let mut hardest: Option<Timed> = None;
    // What was there before the first step nobody has recorded: until it would be forgotten, nothing is judged.
    for step in scene.first.max(release_steps)..scene.steps().saturating_sub(1) {
        let deceleration = brake.deceleration(scene, step);
        if deceleration < LEAST_BRAKING_MPS2 || hardest.is_some_and(|hardest| deceleration <= hardest.value) {
            continue;
        }
        let had_reason = (step.saturating_sub(release_steps)..=step).any(|at| reason_to_brake(scene, way, along, at));
        if !had_reason {
            hardest = Some(Timed { value: deceleration, time_s: time_of(step) });
        }
    }
    hardest
}

/// Whether anything asks the ego to brake: a road user or obstacle in its corridor, one about to cross it, a curve, its
/// own target speed, a signal or sign, a stop of its task, or the end of its way.
fn reason_to_brake(scene: &Scene<'_>, way: &EgoWay<'_>, along: &[Along], step: usize) -> bool {
    let (ego, ego_along) = (&scene.outlines[0][step], &along[step]);
    let speed = scene.speed(0, step);
    let look_ahead_m = (LOOK_AHEAD_S * speed).max(LOOK_AHEAD_M);
    if speed > way.target_speed_mps + 0.1
        || way.path.length_m - ego_along.s < look_ahead_m
        || curve_asks(way, ego_along.s, look_ahead_m, speed)
        || stop_asks(way, ego_along.s, look_ahead_m.max(math::sq(speed) / (2.0 * COMFORT_STOP_MPS2)), time_of(step))
    {
        return true;
    }
    let asks = |other: &OrientedBox, velocity: Vec2| {
        let wide = OrientedBox {
            half_length: other.half_length + MARGIN_M,
            half_width: other.half_width + MARGIN_M,
            ..*other
        };
        if time_to_collision(ego, scene.velocity(0, step), &wide, velocity).is_some_and(|ttc| ttc <= CROSSING_AHEAD_S) {
            return true;
        }
        let other_along = Along::of(way, other, ego_along.segment);
        ego_along.free_space_to(&other_along, MARGIN_M).is_some_and(|free| free <= look_ahead_m)
    };
    let mut others = (1..scene.outlines.len()).filter(|&actor| step < scene.outlines[actor].len());
    others.any(|actor| {
        asks(&scene.outlines[actor][step], scene.velocity(actor, step))
            || comes_into_the_way(way, ego_along, speed, &scene.outlines[actor][step..])
    }) || scene.obstacles.iter().any(|obstacle| asks(obstacle, Vec2::default()))
}

/// Whether a road user that is not in the ego's corridor now comes into it soon, as it really drove.
fn comes_into_the_way(way: &EgoWay<'_>, ego: &Along, speed: f64, future: &[OrientedBox]) -> bool {
    const EVERY: usize = 5;
    let near_m = (GIVE_WAY_S * speed).max(GIVE_WAY_M);
    let in_the_way = |outline: &OrientedBox| {
        let free = ego.free_space_to(&Along::of(way, outline, ego.segment), MARGIN_M);
        free.is_some_and(|free| free <= near_m)
    };
    let last = (GIVE_WAY_S / time_of(1)).round() as usize;
    let now_in_lane =
        future.first().is_some_and(|now| ego.free_space_to(&Along::of(way, now, ego.segment), 0.0).is_some());
    !now_in_lane && future.iter().take(last + 1).step_by(EVERY).any(in_the_way)
}

fn curve_asks(way: &EgoWay<'_>, s: f64, look_ahead_m: f64, speed: f64) -> bool {
    way.path.segments.iter().any(|segment| {
        let (begin, end) = (segment.start_m, segment.start_m + segment.length_m);
        let ahead = begin <= s + look_ahead_m && end >= s;
        ahead && math::sq(speed) * way.path.curvature(0.5 * (begin + end)).abs() > COMFORT_LATERAL_MPS2
    })
}

/// Whether a stop line asks the ego to stand or to look, or a stop of its task comes, within a distance. [m, s]
fn stop_asks(way: &EgoWay<'_>, s: f64, within_m: f64, time_s: f64) -> bool {
    let asks = |device: &Device| !matches!(device.aspect(time_s), Some(Aspect::Green | Aspect::Dark));
    way.lines.iter().any(|&(at_m, device)| (-PASSED_LINE_M..within_m).contains(&(at_m - s)) && asks(device))
        || way.stops.iter().any(|stop| (-PASSED_STOP_M..within_m).contains(&(stop.s_m - s)))
}

/// The most changes between braking and accelerating within a window, and when that window ended.
fn most_reversals(scene: &Scene<'_>, window_s: f64) -> (u32, f64) {
    let mut reversals: Vec<f64> = Vec::new();
    let brake = Brake::of(scene);
    let mut braked: Option<bool> = None;
    for step in scene.first..scene.steps().saturating_sub(1) {
        let brakes = brake.deceleration(scene, step) >= LEAST_BRAKING_MPS2;
        let accelerates = scene.acceleration(0, step) >= LEAST_BRAKING_MPS2;
        if !(brakes || accelerates) || scene.speed(0, step).abs() < STANDSTILL_MPS {
            continue;
        }
        if braked.is_some_and(|before| before != brakes) {
            reversals.push(time_of(step));
        }
        braked = Some(brakes);
    }
    let (mut most, mut when, mut first) = (0, 0.0, 0);
    for (last, &time_s) in reversals.iter().enumerate() {
        while time_s - reversals[first] > window_s + 1e-9 {
            first += 1;
        }
        let count = (last + 1 - first) as u32;
        if count > most {
            (most, when) = (count, time_s);
        }
    }
    (most, when)
}

/// The lane the ego is in at a step, and how far its box reaches over each edge of it. [m]
#[derive(Clone, Copy)]
struct InLane {
    /// Lanes to the right of the one its way follows.
    lane: i32,
    over_left_m: f64,
    over_right_m: f64,
}

impl InLane {
    fn is_inside(self) -> bool {
        self.over_left_m <= 0.0 && self.over_right_m <= 0.0
    }
}

/// Farthest a corner went over the edge of its lane, lane changes and unmarked junction areas left out.
fn farthest_departure(scene: &Scene<'_>, way: &EgoWay<'_>, along: &[Along]) -> Timed {
    let mut track: Vec<Option<InLane>> = scene.ego().map(|(step, ego)| in_lane(way, ego, &along[step])).collect();
    // Who is put beside its lane, at the kerb or in a garage, has not left it: it counts from where it has come into it.
    let entered = track.iter().position(|here| here.is_some_and(|here| here.is_inside())).unwrap_or(track.len());
    track[..entered].fill(None);
    let around = (LANE_CHANGE_S / time_of(1)).round() as usize;
    let mut farthest = Timed { value: 0.0, time_s: 0.0 };
    for (at, here) in track.iter().enumerate() {
        let Some(here) = here else { continue };
        let step = scene.first + at;
        for (over_m, neighbour) in [(here.over_left_m, here.lane - 1), (here.over_right_m, here.lane + 1)] {
            if over_m <= farthest.value {
                continue;
            }
            // Cut short by a contact while still over that edge: nobody knows what it was to become.
            let unfinished = scene.contact.is_some()
                && at + around >= track.len()
                && track.last().copied().flatten().is_some_and(|last| {
                    if neighbour < here.lane { last.over_left_m > 0.0 } else { last.over_right_m > 0.0 }
                });
            let window = at.saturating_sub(around)..=(at + around).min(track.len() - 1);
            let changes = track[window].iter().flatten().any(|there| there.lane == neighbour);
            let excused = changes || (unfinished && has_lane(way, along[step].segment, neighbour));
            if !excused {
                farthest = Timed { value: over_m, time_s: time_of(step) };
            }
        }
    }
    farthest
}

/// `None` where there is no lane to keep: in a junction, and where the ego drives along a lane that is not of its way.
fn in_lane(way: &EgoWay<'_>, outline: &OrientedBox, along: &Along) -> Option<InLane> {
    if is_unmarked(way, along.segment) {
        return None;
    }
    let lane = way.network.lane(way.path.segments[along.segment].lane);
    let width_m = lane.width_at(lane.local(outline.centre).0);
    let last = way.network.road(lane.road).lanes.len() as i32 - 1;
    let index = i32::from(lane.index);
    let told_m = told_beside_m(way, along.s);
    // Who is told to pull over is where it is told to be, not in the next lane.
    let offset = if told_m == 0.0 { ((along.t / width_m).round() as i32).clamp(-index, last - index) } else { 0 };
    let (mut over_left_m, mut over_right_m) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    for corner in outline.corners() {
        // From the segment before on: the rear may still be there.
        let place = way.path.project(corner, along.segment.saturating_sub(1));
        if is_unmarked(way, place.segment) {
            continue;
        }
        let t = place.t - f64::from(offset) * width_m;
        over_right_m = over_right_m.max(t - (0.5 * width_m).max(told_m + outline.half_width));
        over_left_m = over_left_m.max(-t - (0.5 * width_m).max(outline.half_width - told_m));
    }
    let beyond = (along.t - f64::from(offset) * width_m).abs() > 0.5 * width_m;
    (!(beyond && drives_elsewhere(way, outline, lane.road))).then_some(InLane {
        lane: offset,
        over_left_m,
        over_right_m,
    })
}

/// How far beside its lane's centre, to the right, a stop of its task nearby tells it to stand; 0 where none does. [m]
fn told_beside_m(way: &EgoWay<'_>, s: f64) -> f64 {
    let near = way.stops.iter().filter(|stop| stop.t_m != 0.0 && (stop.s_m - s).abs() <= PULL_OVER_M);
    near.min_by(|a, b| (a.s_m - s).abs().total_cmp(&(b.s_m - s).abs())).map_or(0.0, |stop| stop.t_m)
}

/// Whether the ego is on another road's driving lane and goes along with it.
fn drives_elsewhere(way: &EgoWay<'_>, outline: &OrientedBox, own: RoadId) -> bool {
    let heading = math::atan2(outline.axis.y, outline.axis.x);
    way.network.lanes.iter().any(|lane| {
        let is_driven = !matches!(way.network.road(lane.road).part, RoadPart::Beside(_));
        let turned = || math::wrap_angle(lane.heading(lane.local(outline.centre).0) - heading).abs();
        lane.road != own && is_driven && lane.contains(outline.centre) && turned() < ALONG_RAD
    })
}

/// Whether a road of the way has a lane this many lanes to the right of the one followed.
fn has_lane(way: &EgoWay<'_>, segment: usize, to_the_right: i32) -> bool {
    let lane = way.network.lane(way.path.segments[segment].lane);
    let index = i32::from(lane.index) + to_the_right;
    (0..way.network.road(lane.road).lanes.len() as i32).contains(&index)
}

/// Whether a segment of the way crosses a junction, where no lanes are marked.
fn is_unmarked(way: &EgoWay<'_>, segment: usize) -> bool {
    matches!(way.network.map.kind(), MapKind::Junction | MapKind::Network)
        && way.network.road(way.path.roads[segment]).part == RoadPart::Inner
}

/// Whether `other` leads the ego at a step.
pub fn following(scene: &Scene<'_>, way: &EgoWay<'_>, ego: &Along, actor: usize, step: usize) -> Option<Following> {
    let outline = &scene.outlines[actor][step];
    let other = Along::of(way, outline, ego.segment);
    let speed = scene.velocity(0, step).dot(ego.forward);
    let leader_speed = scene.velocity(actor, step).dot(other.forward);
    Following::find(ego, speed, &other, leader_speed, scene.acceleration(actor, step))
}
