//! A small picture of a run for the table: the paths of the ego and its nearest partner, and where they were nearest.

use recrash_model::geometry::Vec2;
use recrash_model::rollout::{ActorTrack, Role, Rollout, STEP_S};
use recrash_model::run::JudgedRun;
use serde::{Deserialize, Serialize};

/// Width and height of the picture. [pixels]
pub const SIZE: [f64; 2] = [96.0, 60.0];
/// Points of a path. [count]
const POINTS: usize = 9;
/// Half the width of the world in the picture, about the encounter: the paths meet, and the road around shows. [m] (Chosen
/// by eye.)
const REACH_M: f64 = 26.0;

/// Paths in pixels, x to the right and y down.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Thumbnail {
    /// Path of the ego.
    pub ego: Vec<[i16; 2]>,
    /// Path of the partner that came nearest; empty where there is none.
    pub partner: Vec<[i16; 2]>,
    /// Where the ego was at the encounter.
    pub at: [i16; 2],
}

impl Thumbnail {
    /// Of a run; none where the ego was nowhere.
    pub fn of(run: &JudgedRun) -> Option<Self> {
        let rollout = &run.rollout;
        let ego = rollout.actors.iter().find(|actor| actor.role == Role::Ego)?;
        let partner = nearest_partner(run, rollout);
        let when = run.metrics.min_gap.map_or(rollout.termination.time_s, |gap| gap.time_s);
        let at = place(ego, when)?;
        let centre = match partner.and_then(|partner| place(partner, when)) {
            Some(other) => (at + other) * 0.5,
            None => at,
        };
        let scale = 0.5 * SIZE[0] / REACH_M;
        let pixel = |point: Vec2| {
            let pixels = [(point.x - centre.x) * scale + 0.5 * SIZE[0], (centre.y - point.y) * scale + 0.5 * SIZE[1]];
            pixels.map(|value| value.round().clamp(-400.0, 400.0) as i16)
        };
        // As long as either could be in the picture.
        let around = REACH_M * 1.2;
        let path = |actor: &ActorTrack| {
            let near: Vec<Vec2> = (actor.states.iter().map(|state| state.position()))
                .filter(|point| (*point - centre).length() < around)
                .collect();
            let step = near.len().saturating_sub(1) as f64 / (POINTS - 1) as f64;
            let mut points: Vec<[i16; 2]> = Vec::with_capacity(POINTS);
            for i in 0..POINTS.min(near.len()) {
                let point = pixel(near[(i as f64 * step).round() as usize]);
                push(&mut points, point);
            }
            points
        };
        Some(Self { ego: path(ego), partner: partner.map(path).unwrap_or_default(), at: pixel(at) })
    }
}

/// Adds a point, in place of the last where that lies on the way.
fn push(points: &mut Vec<[i16; 2]>, point: [i16; 2]) {
    if points.last() == Some(&point) {
        return;
    }
    if let [.., a, b] = points[..] {
        let [(ux, uy), (vx, vy)] =
            [(b, a), (point, a)].map(|(to, from)| (f64::from(to[0] - from[0]), f64::from(to[1] - from[1])));
        let aside = (ux * vy - uy * vx).abs() / (vx * vx + vy * vy).sqrt().max(1.0);
        if aside < 0.6 && ux * vx + uy * vy > 0.0 {
            points.pop();
        }
    }
    points.push(point);
}

fn nearest_partner<'a>(run: &JudgedRun, rollout: &'a Rollout) -> Option<&'a ActorTrack> {
    let gaps = run.metrics.partners.iter().filter(|partner| partner.min_gap.value.is_finite());
    let nearest = gaps.min_by(|a, b| a.min_gap.value.total_cmp(&b.min_gap.value))?;
    rollout.actors.get(nearest.actor)
}

fn place(actor: &ActorTrack, time_s: f64) -> Option<Vec2> {
    let step = (time_s / STEP_S).round().max(0.0) as usize;
    let position = actor.states.get(step.min(actor.states.len().checked_sub(1)?))?.position();
    (position.x.is_finite() && position.y.is_finite()).then_some(position)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_path_is_two_points_and_a_corner_stays() {
        let mut points = Vec::new();
        for point in [[0, 0], [10, 0], [10, 0], [20, 0], [20, 10], [20, 20]] {
            push(&mut points, point);
        }
        assert_eq!(points, [[0, 0], [20, 0], [20, 20]]);
    }
}
