//! Reference lines of roads: stretches one behind the other.

use crate::curve::Stretch;
use recrash_model::geometry::{Pose, Vec2};

/// The reference line of a road.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceLine {
    /// The road's id.
    pub road: String,
    /// Its stretches, one behind the other.
    pub stretches: Vec<Stretch>,
    /// Length. [m]
    pub length_m: f64,
}

impl ReferenceLine {
    /// Of a road. [m]
    pub(crate) fn new(road: &str, stretches: Vec<Stretch>) -> Self {
        let length_m = stretches.iter().map(|stretch| stretch.length_m).sum();
        Self { road: road.to_owned(), stretches, length_m }
    }

    /// Place and direction, `s` from its beginning; continued at both ends. [m]
    pub fn pose(&self, s: f64) -> Pose {
        let mut left = s;
        let last = self.stretches.len().saturating_sub(1);
        for (index, stretch) in self.stretches.iter().enumerate() {
            if left <= stretch.length_m || index == last {
                let on = left.clamp(0.0, stretch.length_m);
                let pose = stretch.pose(on);
                return Pose { position: pose.position + Vec2::from_heading(pose.heading) * (left - on), ..pose };
            }
            left -= stretch.length_m;
        }
        Pose::default()
    }

    /// (s, t) of a point, t to the right: on the stretch it is nearest to. [m]
    pub fn local(&self, point: Vec2) -> (f64, f64) {
        let mut begins_m = 0.0;
        let mut best = (f64::INFINITY, 0.0, 0.0);
        for stretch in &self.stretches {
            let (s, t) = stretch.local(point);
            let on = s.clamp(0.0, stretch.length_m);
            let apart = stretch.pose(on).position.distance(point);
            if apart < best.0 - 1e-9 {
                best = (apart, begins_m + on, t);
            }
            begins_m += stretch.length_m;
        }
        (best.1, best.2)
    }

    /// The part between two places. [m]
    pub fn part(&self, from_m: f64, to_m: f64) -> Vec<Stretch> {
        let mut begins_m = 0.0;
        let mut parts = Vec::new();
        for stretch in &self.stretches {
            let (from, to) = ((from_m - begins_m).max(0.0), (to_m - begins_m).min(stretch.length_m));
            if to - from > 1e-9 {
                parts.push(stretch.part(from, to));
            }
            begins_m += stretch.length_m;
        }
        parts
    }

    /// The same line elsewhere: its beginning at a pose. [m]
    pub(crate) fn moved_to(&self, start: Pose) -> Self {
        let Some(first) = self.stretches.first() else { return self.clone() };
        let turned = start.heading - first.start.heading;
        let place = |pose: Pose| Pose {
            position: start.position + (pose.position - first.start.position).turned(turned),
            heading: pose.heading + turned,
        };
        let stretches = self.stretches.iter().map(|stretch| Stretch { start: place(stretch.start), ..*stretch });
        Self { stretches: stretches.collect(), ..self.clone() }
    }
}
