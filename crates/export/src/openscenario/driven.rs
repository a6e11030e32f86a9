//! What a partner did in the rollout, told of its reference point: how actions are fitted to it.

use super::Context;
use super::places::{reference_point, reference_to_centre};
use recrash_model::geometry::Pose;
use recrash_model::rollout::STEP_S;
use recrash_roads::PathPoint;

/// A partner in the rollout, step by step up to its first contact.
pub(super) struct Driven {
    /// Its reference point.
    pub poses: Vec<Pose>,
    /// The same along its way.
    pub places: Vec<PathPoint>,
    /// Whether its first contact follows on the last step.
    pub touches: bool,
    /// Speed it started with. [m/s]
    start_mps: f64,
    /// From its reference point forward to its centre. [m]
    to_centre_m: f64,
}

impl Driven {
    /// That of a partner, by its position in the draft. `None` without a rollout, or with a contact at once.
    pub fn new(context: &Context<'_>, position: usize) -> Option<Self> {
        let rollout = context.rollout?;
        let actor = position + 1;
        let track = rollout.actors.get(actor)?;
        let contact_s = rollout.first_contact_of(actor).map(|(time_s, _)| time_s);
        let count = track.states.len();
        let until = contact_s.map_or(count, |time| (time / STEP_S).floor() as usize + 1).min(count);
        if until < 4 {
            return None;
        }
        let path = &context.scenario.partners()[position].path;
        let poses: Vec<Pose> =
            track.states[..until].iter().map(|state| reference_point(track.kind, state.pose())).collect();
        let mut segment = 0;
        let places = poses.iter().map(|pose| {
            let place = path.project(pose.position, segment);
            segment = place.segment;
            place
        });
        Some(Self {
            places: places.collect(),
            touches: contact_s.is_some(),
            start_mps: track.states[0].speed(),
            to_centre_m: reference_to_centre(track.kind),
            poses,
        })
    }

    /// Time of the last step. [s]
    pub fn end_s(&self) -> f64 {
        (self.poses.len() - 1) as f64 * STEP_S
    }

    /// How long it takes from its reference point's place to its centre's, on average between two steps: whoever moves
    /// sideways turns, and moves its centre ahead of that. [s]
    pub fn lever_s(&self, first: usize, last: usize) -> f64 {
        let way_m: f64 =
            self.poses[first..=last].windows(2).map(|pair| pair[0].position.distance(pair[1].position)).sum();
        self.to_centre_m * (last - first) as f64 * STEP_S / way_m.max(0.1)
    }

    /// Speeds at the steps which, joined by straight lines, cover the distances that were driven. [m/s]
    pub fn speeds(&self) -> Vec<f64> {
        let means: Vec<f64> =
            self.poses.windows(2).map(|pair| (pair[1].position - pair[0].position).length() / STEP_S).collect();
        let mut speeds = vec![self.start_mps, means[1]];
        speeds.extend(means.windows(2).skip(1).map(|pair| 0.5 * (pair[0] + pair[1])));
        speeds.push(means[means.len() - 1]);
        // In the first tick of the physics nothing moves yet, in MetaDrive as in ours. Steps 1 and 2 make up for that
        // between them, the first for most of it, so that no position is more than 0.0125 s late or early.
        let ahead_m = (0.5 * (speeds[0] + speeds[1]) - means[0]) * STEP_S;
        for (step, share) in [(1, 0.75), (2, 0.25)] {
            speeds[step] = (speeds[step] - share * ahead_m / STEP_S).max(0.0);
        }
        speeds
    }
}

/// Corners between two ends of a curve which straight pieces between them follow well enough (after Ramer, Douglas and
/// Peucker), in order. `off(first, position, last)` says how far a position is off the piece from `first` to `last`: the
/// farthest becomes a corner, if for any position the second number, where 1 is too much, says so.
pub(super) fn corners(first: usize, last: usize, off: &impl Fn(usize, usize, usize) -> (f64, f64)) -> Vec<usize> {
    let (mut corner, mut farthest, mut too_much) = (first + 1, 0.0, false);
    for position in first + 1..last {
        let (far, much) = off(first, position, last);
        too_much |= much > 1.0;
        if far > farthest {
            (corner, farthest) = (position, far);
        }
    }
    if !too_much {
        return Vec::new();
    }
    let mut list = corners(first, corner, off);
    list.push(corner);
    list.extend(corners(corner, last, off));
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_piece_has_no_corners_and_a_bend_has_one() {
        let found = |curve: &[f64]| {
            let off = |first: usize, position: usize, last: usize| {
                let slope = (curve[last] - curve[first]) / (last - first) as f64;
                let off = (curve[position] - curve[first] - slope * (position - first) as f64).abs();
                (off, off / 0.01)
            };
            corners(0, curve.len() - 1, &off)
        };
        assert_eq!(found(&[0.0, 1.0, 2.0, 3.0]), [] as [usize; 0]);
        assert_eq!(found(&[0.0, 1.0, 2.0, 2.0, 2.0]), [2]);
    }
}
