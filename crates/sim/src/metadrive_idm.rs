//! MetaDrive's `IDMPolicy`, quirk for quirk.
//!
//! What looks odd here is odd there: this driver exists so that results on both simulators can be compared, and so that
//! the paper's findings about it ("early braking", "oscillation", "poor reaction to cones") can be found again. Each
//! quirk, with what was measured: `docs/models/metadrive-idm.md`.

use crate::chassis::Controls;
use crate::lanes::LaneIndex;
use crate::scene::Scene;
use crate::steering::LaneKeeper;
use recrash_model::geometry::Vec2;
use recrash_plan::constants::SIGHT_M;
use recrash_plan::{Lead, gap_law};
use recrash_roads::RoadId;

/// Metres per second to kilometres per hour.
const KMH_PER_MPS: f64 = 3.6;

/// Free space it wants on a lane before it changes there (`SAFE_LANE_CHANGE_DISTANCE`). [m]
const SAFE_LANE_CHANGE_M: f64 = 15.0;

/// A lane is worth changing to when traffic there is faster by this (`LANE_CHANGE_SPEED_INCREASE`). [km/h]
const WORTHWHILE_KMH: f64 = 10.0;

/// Speed assumed on an empty lane (`MAX_SPEED`). [km/h]
const EMPTY_LANE_KMH: f64 = 100.0;

/// No overtaking while it, or what is in front, is within this of the speed it wants. [km/h]
const CONTENT_KMH: f64 = 3.0;

/// Where it has to leave its lane, because the next road has fewer, it wants this much room ahead on the one beside. [m]
const ROOM_AHEAD_M: f64 = 5.0;

/// Its speed while it waits for that room (`CREEP_SPEED`, 5 km/h). [m/s]
const CREEP_MPS: f64 = 5.0 / KMH_PER_MPS;

/// Steps of plain following between lane changes (`LANE_CHANGE_FREQ`).
const LANE_CHANGE_PERIOD_STEPS: u32 = 50;

/// MetaDrive draws the timer from 0..25 at every change of lane. Both backends take the middle instead, so that a rollout
/// depends on nothing but its scenario.
const TIMER_AFTER_CHANGE_STEPS: u32 = LANE_CHANGE_PERIOD_STEPS / 4;

/// The state of one such driver.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MetadriveIdm {
    /// Speed it wants (`NORMAL_SPEED`). [m/s]
    target_mps: f64,
    keeper: LaneKeeper,
    /// The lane it follows (`routing_target_lane`).
    lane: Option<LaneIndex>,
    overtake_timer: u32,
    /// It waits for room beside it.
    creeps: bool,
}

/// What it sees on one lane.
#[derive(Debug, Clone, Copy)]
struct LaneView {
    front: Option<Lead>,
    front_m: f64,
    back_m: f64,
}

impl MetadriveIdm {
    /// `overtake_timer` is how long it has been following already. [steps]
    pub(crate) const fn new(target_mps: f64, overtake_timer: u32) -> Self {
        Self { target_mps, keeper: LaneKeeper::new(), lane: None, overtake_timer, creeps: false }
    }

    pub(crate) fn decide(&mut self, scene: &Scene<'_>, me: usize) -> Controls {
        let seen = &scene.actors[me];
        let lanes = scene.lanes_of(me);
        let (lane, routed) = self.choose_routing_lane(scene, me, lanes);
        let own = view(scene, me, lane);
        let (target, lead) = if routed { self.overtake(scene, me, lanes, lane, own) } else { (lane, own.front) };
        Controls {
            steer: self.keeper.steer(
                scene.lanes.lane(target),
                seen.pose,
                if me == 0 { scene.ego_beside_m } else { 0.0 },
                0.0,
            ),
            throttle: gap_law(
                seen.speed,
                if self.creeps { CREEP_MPS } else { self.target_mps },
                seen.forward,
                seen.velocity,
                lead,
            ),
        }
        .clipped()
    }

    /// Follows the route from road to road (`move_to_next_road`): the lane, and whether it is one of the current road.
    fn choose_routing_lane(&mut self, scene: &Scene<'_>, me: usize, lanes: &[LaneIndex]) -> (LaneIndex, bool) {
        let own = scene.actors[me].place.lane;
        let Some(lane) = self.lane else {
            self.lane = Some(own);
            return (own, lanes.contains(&own));
        };
        if !lanes.contains(&lane) {
            // Quirk, the lane-0 kick: roads are compared, not lanes, so the first lane of the new road is taken for one
            // step by whoever comes from any lane of the old one.
            let before = scene.lanes.lane(lane);
            let first_before = scene.lanes.lane(scene.lanes.of_road(RoadId(before.road))[0]);
            let connected = if first_before.leads_to(scene.lanes.lane(lanes[0])) {
                Some(lanes[0])
            } else {
                lanes.iter().copied().find(|&next| before.leads_to(scene.lanes.lane(next)))
            };
            return match connected {
                Some(next) => {
                    self.lane = Some(next);
                    (next, true)
                }
                None => (lane, false),
            };
        }
        if lane != own && lanes.contains(&own) {
            self.lane = Some(own);
            self.overtake_timer = TIMER_AFTER_CHANGE_STEPS;
            return (own, true);
        }
        (lane, true)
    }

    /// Follows or overtakes (`lane_change_policy`): the lane to steer to and whom to keep a distance from.
    fn overtake(
        &mut self,
        scene: &Scene<'_>,
        me: usize,
        lanes: &[LaneIndex],
        lane: LaneIndex,
        own: LaneView,
    ) -> (LaneIndex, Option<Lead>) {
        // Where the next road has fewer lanes, only those that go on are of use: the leftmost ones, if the first goes on.
        let number = usize::from(scene.lanes.lane(lane).number);
        let next = scene.lanes_after(me);
        let useful = match next {
            Some(next) if next.len() < lanes.len() => {
                if scene.lanes.lane(lanes[0]).leads_to(scene.lanes.lane(next[0])) {
                    0..next.len()
                } else {
                    lanes.len() - next.len()..lanes.len()
                }
            }
            _ => 0..lanes.len(),
        };
        if !useful.contains(&number) {
            let side = if number >= useful.end { number - 1 } else { number + 1 };
            let beside = view(scene, me, lanes[side]);
            self.creeps = beside.back_m < SAFE_LANE_CHANGE_M || beside.front_m < ROOM_AHEAD_M;
            return if self.creeps { (lane, own.front) } else { (lanes[side], beside.front) };
        }
        let differs = |speed_mps: f64| ((speed_mps - self.target_mps) * KMH_PER_MPS).abs() > CONTENT_KMH;
        if let Some(front) = own.front
            && self.overtake_timer > LANE_CHANGE_PERIOD_STEPS
            && differs(scene.actors[me].speed)
            && differs(front.speed_mps)
        {
            let left = number.checked_sub(1);
            let right = Some(number + 1).filter(|&right| right < lanes.len());
            for side in [left, right].into_iter().flatten() {
                let beside = view(scene, me, lanes[side]);
                // Quirk, the precedence slip: where somebody is in front on the other lane, only his speed counts, and
                // the space beside and behind is not looked at.
                let speed_kmh = match beside.front {
                    Some(other) => Some(other.speed_mps * KMH_PER_MPS),
                    None if beside.front_m > SAFE_LANE_CHANGE_M && beside.back_m > SAFE_LANE_CHANGE_M => {
                        Some(EMPTY_LANE_KMH)
                    }
                    None => None,
                };
                let faster = speed_kmh.is_some_and(|speed| speed - front.speed_mps * KMH_PER_MPS > WORTHWHILE_KMH);
                if faster && useful.contains(&side) {
                    return (lanes[side], beside.front);
                }
            }
        }
        self.creeps = false;
        self.overtake_timer += 1;
        (lane, own.front)
    }
}

/// Whom a driver with MetaDrive's eyes follows on this lane.
pub(crate) fn lead_on(scene: &Scene<'_>, me: usize, lane: LaneIndex) -> Option<Lead> {
    view(scene, me, lane).front
}

/// What is in front and behind on a lane (`get_find_front_back_objs`).
///
/// Quirk, sight by lane: an object counts where the lane it is registered to is this one, or begins where this one ends
/// (or the other way round, behind). Crossing and oncoming traffic is on other lanes and does not exist. A cone counts
/// by the lane it was registered to, wherever on it.
fn view(scene: &Scene<'_>, me: usize, lane: LaneIndex) -> LaneView {
    let geometry = scene.lanes.lane(lane);
    let seen = &scene.actors[me];
    let here = if lane == seen.place.lane { seen.place.s } else { geometry.local(seen.pose.position).0 };
    let left_over = geometry.length_m - here;
    let mut view = LaneView { front: None, front_m: SIGHT_M, back_m: SIGHT_M };
    let mut consider = |other_lane: LaneIndex, other_s: f64, velocity: Vec2, speed_mps: f64| {
        let ahead = if other_lane == lane {
            other_s - here
        } else {
            let other = scene.lanes.lane(other_lane);
            if geometry.leads_to(other) {
                other_s + left_over
            } else if other.leads_to(geometry) {
                let behind = other.length_m - other_s + here;
                view.back_m = view.back_m.min(behind);
                return;
            } else {
                return;
            }
        };
        if ahead > 0.0 && ahead < view.front_m {
            view.front_m = ahead;
            view.front = Some(Lead { distance_m: ahead, velocity, speed_mps });
        } else if ahead < 0.0 && -ahead < view.back_m && other_lane == lane {
            view.back_m = -ahead;
        }
    };
    for (other, actor) in scene.actors.iter().enumerate() {
        if other != me
            && actor.present
            && let Some((other_lane, other_s)) = scene.registered_lane(other)
        {
            consider(other_lane, other_s, actor.velocity, actor.speed);
        }
    }
    for obstacle in scene.obstacles {
        consider(obstacle.lane, obstacle.s, Vec2::default(), 0.0);
    }
    view
}
