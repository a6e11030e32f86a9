//! Rays from the ego's centre, evenly around it, as a lidar without noise would have them.

use crate::kinematics::{EgoFrame, Thing, others, thing};
use crate::scene::Scene;
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_sim::Observation;

/// Rays around the ego: the first forward, the others anticlockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Rays {
    /// How far they reach. [m]
    pub range_m: f64,
    directions: Vec<Vec2>,
}

impl Rays {
    /// So many rays of this reach. [m]
    pub fn new(count: usize, range_m: f64) -> Self {
        let direction = |ray: usize| Vec2::from_heading(math::TAU * ray as f64 / count as f64);
        Self { range_m, directions: (0..count).map(direction).collect() }
    }

    /// How many.
    pub fn count(&self) -> usize {
        self.directions.len()
    }

    /// Writes for each ray how far it goes before it meets somebody, as a share of its reach (1 where it meets nobody), and
    /// behind all of them how fast what it meets comes nearer along it, as a share of 30 m/s.
    pub(crate) fn write(&self, scene: &Scene, observation: &Observation<'_>, frame: &EgoFrame, out: &mut [f32]) {
        let (distances, speeds) = out.split_at_mut(self.count());
        distances.fill(1.0);
        speeds.fill(0.0);
        others(scene, observation, |least_m, number| {
            if least_m > self.range_m {
                return;
            }
            let Thing { outline, velocity } = thing(scene, observation, number);
            let (centre, axis, speed) =
                (frame.seen(outline.centre), frame.turned(outline.axis), frame.relative(velocity));
            for ((direction, distance), closing) in self.directions.iter().zip(&mut *distances).zip(&mut *speeds) {
                let Some(met_m) = meets(*direction, centre, axis, outline.half_length, outline.half_width) else {
                    continue;
                };
                let share = (met_m / self.range_m) as f32;
                if share < *distance {
                    *distance = share;
                    *closing = (-speed.dot(*direction) / 30.0).clamp(-1.0, 1.0) as f32;
                }
            }
        });
    }
}

/// How far from the origin a ray enters a box; 0 from inside. [m]
fn meets(direction: Vec2, centre: Vec2, axis: Vec2, half_length: f64, half_width: f64) -> Option<f64> {
    let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
    for (axis, half) in [(axis, half_length), (axis.left(), half_width)] {
        let (along, at) = (direction.dot(axis), centre.dot(axis));
        if along.abs() < 1e-12 {
            if at.abs() > half {
                return None;
            }
            continue;
        }
        let (one, other) = ((at - half) / along, (at + half) / along);
        enters = enters.max(one.min(other));
        leaves = leaves.min(one.max(other));
    }
    (enters <= leaves).then_some(enters)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_a_box_at_its_near_side() {
        let (forward, left) = (Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0));
        // A car of 4 m by 2 m, 10 m ahead, lengthwise and crosswise.
        assert_eq!(meets(forward, Vec2::new(10.0, 0.5), forward, 2.0, 1.0), Some(8.0));
        assert_eq!(meets(forward, Vec2::new(10.0, 0.5), left, 2.0, 1.0), Some(9.0));
        assert_eq!(meets(forward, Vec2::new(10.0, 1.5), forward, 2.0, 1.0), None);
        assert_eq!(meets(forward, Vec2::new(-10.0, 0.0), forward, 2.0, 1.0), None);
        assert_eq!(meets(left, Vec2::new(0.5, 0.0), forward, 2.0, 1.0), Some(0.0));
    }
}
