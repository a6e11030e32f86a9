//! Steering around what stands in the way, within the lanes of one's own direction.

use crate::scene::Scene;
use recrash_model::math;

/// Room between the own side and what is passed; assumed. [m]
const PASSING_ROOM_M: f64 = 0.4;

/// Room to the edge of the road. [m]
const EDGE_ROOM_M: f64 = 0.1;

/// It plans this far ahead, at least and in time. [m, s]
const LEAST_SIGHT_M: f64 = 60.0;
const SIGHT_S: f64 = 6.0;

/// Fastest sideways move, and as a share of the speed along the lane (an angle of 24 degrees); assumed. [m/s]
const SIDEWAYS_MPS: f64 = 1.2;
const SIDEWAYS_SHARE: f64 = 0.45;

/// Nobody may be on the other lane from this far behind to this far ahead. [m]
const FREE_BEHIND_M: f64 = 15.0;
const FREE_AHEAD_M: f64 = 25.0;

/// Where it drives beside the centre of its lane.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Swerve {
    /// The line it follows now, to the right of the lane's centre. [m]
    line_m: f64,
    /// The line it wants. [m]
    target_m: f64,
    /// It stays there until here on its path. [m]
    until_m: f64,
}

/// Something that stands, in the coordinates of the path: from the own centre, to the right, and its half extents. [m]
#[derive(Clone, Copy)]
struct Block {
    distance: f64,
    t: f64,
    half_across: f64,
    half_along: f64,
}

impl Swerve {
    /// Decides on the line, and moves towards it. `stands` tells which actors are not going to move.
    pub(crate) fn plan(&mut self, scene: &Scene<'_>, me: usize, stands: impl Fn(usize) -> bool + Copy) {
        let seen = &scene.actors[me];
        let sight = (SIGHT_S * seen.speed).max(LEAST_SIGHT_M);
        let here = scene.path_s(me);
        let clear = |line: f64| {
            blocks(scene, me, sight, stands)
                .all(|block| (block.t - line).abs() >= block.half_across + seen.half_width + 0.9 * PASSING_ROOM_M)
        };
        let (left, right) = bounds(scene, me);
        let fits = |line: f64| (left..=right).contains(&line) && clear(line) && beside_is_free(scene, me, line, stands);
        if self.target_m != 0.0 && here < self.until_m && clear(self.target_m) {
            // It stays beside what it is passing.
        } else if clear(0.0) {
            self.target_m = 0.0;
        } else {
            let mut best: Option<f64> = None;
            for block in blocks(scene, me, sight, stands) {
                let away = block.half_across + seen.half_width + PASSING_ROOM_M;
                for line in [block.t - away, block.t + away] {
                    if fits(line) && best.is_none_or(|least| line.abs() < least.abs()) {
                        best = Some(line);
                    }
                }
            }
            self.target_m = best.unwrap_or(0.0);
        }
        if self.target_m != 0.0 {
            let last = blocks(scene, me, sight, stands).map(|block| block.distance + block.half_along);
            let last = last.fold(f64::NEG_INFINITY, f64::max);
            if last > f64::NEG_INFINITY {
                self.until_m = self.until_m.max(here + last + seen.half_length + 1.0);
            }
        }
        self.line_m += self.rate(seen.speed) * recrash_model::rollout::STEP_S;
    }

    /// How fast the line moves to the right. [m/s]
    fn rate(&self, speed_mps: f64) -> f64 {
        let greatest = SIDEWAYS_MPS.min(SIDEWAYS_SHARE * speed_mps);
        ((self.target_m - self.line_m) / recrash_model::rollout::STEP_S).clamp(-greatest, greatest)
    }

    /// The line, and the angle to the left of the lane at which it runs. [m, rad]
    pub(crate) fn line(&self, speed_mps: f64) -> (f64, f64) {
        (self.line_m, math::asin((-self.rate(speed_mps) / speed_mps.max(1.0)).clamp(-0.5, 0.5)))
    }

    /// Where it will be beside its lane's centre after this way, from `t_m` now. [m]
    pub(crate) fn expected(&self, t_m: f64, way_m: f64, speed_mps: f64) -> f64 {
        let reach = 0.8 * way_m.max(0.0) * SIDEWAYS_SHARE.min(SIDEWAYS_MPS / speed_mps.max(0.1));
        t_m + (self.target_m - t_m).clamp(-reach, reach)
    }
}

/// Everything that stands ahead or beside.
fn blocks<'a>(
    scene: &'a Scene<'_>,
    me: usize,
    sight: f64,
    stands: impl Fn(usize) -> bool + Copy + 'a,
) -> impl Iterator<Item = Block> + 'a {
    let half_length = scene.actors[me].half_length;
    let actors = scene.actors.iter().enumerate();
    let parked = actors
        .filter(move |&(other, actor)| other != me && actor.present && stands(other))
        .map(|(_, actor)| (actor.pose.position, actor.forward, actor.half_length, actor.half_width));
    let obstacles = scene.obstacles.iter().map(|obstacle| {
        let outline = &obstacle.outline;
        (outline.centre, outline.axis, outline.half_length, outline.half_width)
    });
    obstacles.chain(parked).filter_map(move |(position, axis, half_of_length, half_of_width)| {
        let (distance, t, forward) = scene.ahead(me, position, sight)?;
        let half_across = half_of_length * axis.cross(forward).abs() + half_of_width * axis.dot(forward).abs();
        let half_along = half_of_length * axis.dot(forward).abs() + half_of_width * axis.cross(forward).abs();
        let near = distance < sight && distance > -(half_length + half_along + 1.0);
        near.then_some(Block { distance, t, half_across, half_along })
    })
}

/// The lines on which it stays on the lanes of its direction. [m]
fn bounds(scene: &Scene<'_>, me: usize) -> (f64, f64) {
    let lane = scene.lanes.lane(scene.path_lane(me));
    let lanes = scene.lanes.of_road(recrash_roads::RoadId(lane.road)).len() as f64;
    let (number, width) = (f64::from(lane.number), lane.width_m(0.5 * lane.length_m));
    let room = 0.5 * width - scene.actors[me].half_width - EDGE_ROOM_M;
    (-number * width - room, (lanes - 1.0 - number) * width + room)
}

/// Whether nobody drives where it would go: the strip around the line, beside it and a little before and behind.
fn beside_is_free(scene: &Scene<'_>, me: usize, line: f64, stands: impl Fn(usize) -> bool) -> bool {
    let seen = &scene.actors[me];
    let lane = scene.lanes.lane(scene.path_lane(me));
    let mut others = scene.actors.iter().enumerate();
    others.all(|(other, actor)| {
        if other == me || !actor.present || stands(other) {
            return true;
        }
        let along = (actor.pose.position - seen.pose.position).dot(seen.forward);
        let (_, t) = lane.local(actor.pose.position);
        let beside = (-FREE_BEHIND_M..FREE_AHEAD_M).contains(&along);
        !beside || (t - line).abs() > actor.half_width + seen.half_width + PASSING_ROOM_M
    })
}
