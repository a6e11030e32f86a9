//! Post-encroachment time: how long after the one left a spot the other came to it.
//!
//! Model, formula and sources: `docs/models/post-encroachment-time.md`.

use crate::swept::separating_axes;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::metrics::Timed;
use recrash_model::polygon::ConvexPolygon;
use std::ops::Range;

/// Segments in one block of the coarse search.
const BLOCK: usize = 8;

/// Who comes later than this has not met the other. [s] (assumed; conflict studies use 5 s and less)
const LONGEST_S: f64 = 10.0;

/// Post-encroachment time of two tracks sampled every `step_s`: the least time between one box leaving a spot and the
/// other reaching it, with the time at which the second one came. `None` where no spot is shared within 10 s. [s]
///
/// Each track comes with its samples that count: nobody sweeps anything on the way from or to where who is not in the world
/// is put. Between two samples a box moves in a straight line at constant velocity, with the heading of its middle.
pub fn post_encroachment_time(a: Track<'_>, b: Track<'_>, step_s: f64) -> Option<Timed> {
    let (blocks_a, blocks_b) = (blocks(a.0), blocks(b.0));
    let mut best = Best { lag: LONGEST_S / step_s, second: None };
    // Outwards from the diagonal: the least lag a block pair can have grows, and ends the search.
    for apart in 0..blocks_a.len().max(blocks_b.len()) {
        if (apart as f64 - 1.0) * BLOCK as f64 >= best.lag {
            break;
        }
        for (i, block_a) in blocks_a.iter().enumerate() {
            let later = Some(i + apart);
            let earlier = if apart > 0 { i.checked_sub(apart) } else { None };
            for j in [later, earlier].into_iter().flatten() {
                if blocks_b.get(j).is_some_and(|block_b| block_a.meets(block_b)) {
                    search_block(&a, &b, i * BLOCK, j * BLOCK, &mut best);
                }
            }
        }
    }
    best.second.map(|second| Timed { value: best.lag * step_s, time_s: second * step_s })
}

/// The boxes of somebody, and the samples among them that count.
pub type Track<'a> = (&'a [OrientedBox], Range<usize>);

/// Least lag found so far, and when the second of the two came; before any is found, the longest that counts. [steps]
struct Best {
    lag: f64,
    second: Option<f64>,
}

/// The upright rectangle around some consecutive boxes.
struct Extent {
    min: Vec2,
    max: Vec2,
}

impl Extent {
    fn meets(&self, other: &Self) -> bool {
        self.min.x <= other.max.x && other.min.x <= self.max.x && self.min.y <= other.max.y && other.min.y <= self.max.y
    }
}

fn blocks(track: &[OrientedBox]) -> Vec<Extent> {
    let segments = track.len().saturating_sub(1);
    (0..segments)
        .step_by(BLOCK)
        .map(|start| {
            let mut extent = Extent {
                min: Vec2::new(f64::INFINITY, f64::INFINITY),
                max: Vec2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
            };
            for outline in &track[start..=(start + BLOCK).min(segments)] {
                let reach = Vec2::new(
                    outline.half_length * outline.axis.x.abs() + outline.half_width * outline.axis.y.abs(),
                    outline.half_length * outline.axis.y.abs() + outline.half_width * outline.axis.x.abs(),
                );
                let (low, high) = (outline.centre - reach, outline.centre + reach);
                extent.min = Vec2::new(extent.min.x.min(low.x), extent.min.y.min(low.y));
                extent.max = Vec2::new(extent.max.x.max(high.x), extent.max.y.max(high.y));
            }
            extent
        })
        .collect()
}

fn search_block((a, in_a): &Track<'_>, (b, in_b): &Track<'_>, start_a: usize, start_b: usize, best: &mut Best) {
    // Segments of a block between two samples that count.
    let segments = |start: usize, counted: &Range<usize>| {
        start.max(counted.start)..(start + BLOCK).min(counted.end.saturating_sub(1))
    };
    for i in segments(start_a, in_a) {
        for j in segments(start_b, in_b) {
            if (i.abs_diff(j) as f64 - 1.0) < best.lag {
                search_segments([&a[i], &a[i + 1]], [&b[j], &b[j + 1]], i as f64, j as f64, best);
            }
        }
    }
}

/// One segment of each track. With u and v the parts of the segments that have passed, the boxes overlap where
/// |d0 + p u + q v| <= reach on each of the four axes: a convex polygon in the unit square of (u, v). The lag
/// |(i + u) - (j + v)| is least at one of its corners, or nil where it changes sign.
fn search_segments(a: [&OrientedBox; 2], b: [&OrientedBox; 2], i: f64, j: f64, best: &mut Best) {
    let offset = b[0].centre - a[0].centre;
    let (move_a, move_b) = (a[1].centre - a[0].centre, b[1].centre - b[0].centre);
    let reach = a[0].radius() + b[0].radius();
    let apart_squared = (offset + (move_b - move_a) * 0.5).length_squared();
    // From middle to middle of the segments; each end is half a move away.
    if apart_squared > 2.0 * (reach * reach + 0.5 * (move_a.length_squared() + move_b.length_squared())) {
        return;
    }
    let middle_a = OrientedBox { axis: mean_axis(a), ..*a[0] };
    let middle_b = OrientedBox { axis: mean_axis(b), ..*b[0] };
    let constraints = separating_axes(&middle_a, &middle_b)
        .map(|(axis, reach)| (axis.dot(offset), Vec2::new(-axis.dot(move_a), axis.dot(move_b)), reach));
    for (distance, rate, reach) in constraints {
        let middle = distance + 0.5 * (rate.x + rate.y);
        let spread = 0.5 * (rate.x.abs() + rate.y.abs());
        if middle.abs() - spread > reach {
            return;
        }
    }
    let square = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0), Vec2::new(1.0, 1.0), Vec2::new(0.0, 1.0)];
    let mut together = ConvexPolygon::quad(square);
    for (distance, rate, reach) in constraints {
        together = together.cut(rate, reach - distance).cut(-rate, reach + distance);
    }
    let (mut before, mut after) = (false, false);
    for corner in together.corners() {
        let (time_a, time_b) = (i + corner.x, j + corner.y);
        let lag = (time_a - time_b).abs();
        before |= time_a <= time_b;
        after |= time_a >= time_b;
        if lag < best.lag {
            *best = Best { lag, second: Some(time_a.max(time_b)) };
        }
    }
    if before && after && best.lag > 0.0 {
        *best = Best { lag: 0.0, second: Some(i.max(j)) };
    }
}

fn mean_axis(pair: [&OrientedBox; 2]) -> Vec2 {
    let sum = pair[0].axis + pair[1].axis;
    let length = sum.length();
    if length > 1e-9 { sum * (1.0 / length) } else { pair[0].axis }
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::geometry::Pose;
    use recrash_model::math;

    const STEP: f64 = 0.1;

    fn post_encroachment_time(a: &[OrientedBox], b: &[OrientedBox], step_s: f64) -> Option<Timed> {
        super::post_encroachment_time((a, 0..a.len()), (b, 0..b.len()), step_s)
    }

    fn track(x: f64, y: f64, heading: f64, speed: f64, steps: usize) -> Vec<OrientedBox> {
        let go = Vec2::from_heading(heading) * speed;
        (0..steps)
            .map(|k| {
                let position = Vec2::new(x, y) + go * (k as f64 * STEP);
                OrientedBox::new(Pose { position, heading }, 4.0, 2.0)
            })
            .collect()
    }

    #[test]
    fn crossing_at_right_angles_it_is_from_rear_bumper_out_to_front_bumper_in() {
        // The first one's rear leaves the square (x <= 21) at (21 + 2) / 10 = 2.3 s. The other's front comes to y = -1
        // from y = -36.3 at 10 m/s: 3.53 s.
        let first = track(0.0, 0.0, 0.0, 10.0, 60);
        let second = track(20.0, -38.3, math::FRAC_PI_2, 10.0, 60);
        let pet = post_encroachment_time(&first, &second, STEP).unwrap();
        assert!((pet.value - 1.23).abs() < 1e-9, "{pet:?}");
        assert!((pet.time_s - 3.53).abs() < 1e-9, "{pet:?}");
        // Either order of the arguments.
        assert!((post_encroachment_time(&second, &first, STEP).unwrap().value - 1.23).abs() < 1e-9);
    }

    #[test]
    fn following_it_is_the_time_gap() {
        // 10 m/s, 15 m between the bumpers.
        let leader = track(19.0, 0.0, 0.0, 10.0, 80);
        let follower = track(0.0, 0.0, 0.0, 10.0, 80);
        let pet = post_encroachment_time(&follower, &leader, STEP).unwrap();
        assert!((pet.value - 1.5).abs() < 1e-9, "{pet:?}");
    }

    #[test]
    fn at_an_angle_it_is_found_spot_by_spot() {
        let first = track(0.0, 0.0, 0.0, 10.0, 80);
        let second = track(0.0, -40.0, math::PI / 4.0, 12.0, 80);
        let pet = post_encroachment_time(&first, &second, STEP).unwrap();
        let stepped = brute_force([0.0, 0.0, 0.0, 10.0], [0.0, -40.0, math::PI / 4.0, 12.0], 0.005, 7.9);
        assert!((pet.value - stepped).abs() < 0.011, "{pet:?} {stepped}");
    }

    #[test]
    fn who_appears_or_leaves_sweeps_nothing_on_the_way() {
        // Somebody stands 30 m beside the way, and is a million metres away before and after.
        let ego = track(0.0, 0.0, 0.0, 10.0, 60);
        let (here, nowhere) = (track(20.0, -30.0, 0.0, 0.0, 60), track(1e6, 1e6, 0.0, 0.0, 60));
        let other: Vec<OrientedBox> =
            (0..60).map(|step| if (20..40).contains(&step) { here[step] } else { nowhere[step] }).collect();
        assert!(post_encroachment_time(&ego, &other, STEP).is_some(), "the sweep through the scene");
        assert_eq!(super::post_encroachment_time((&ego, 0..60), (&other, 20..40), STEP), None);
    }

    #[test]
    fn lanes_side_by_side_share_no_spot() {
        assert_eq!(
            post_encroachment_time(&track(0.0, 0.0, 0.0, 9.0, 99), &track(-20.0, 3.5, 0.0, 14.0, 99), STEP),
            None
        );
    }

    #[test]
    fn boxes_in_one_place_at_one_time_have_none() {
        let pet = post_encroachment_time(
            &track(0.0, 0.0, 0.0, 10.0, 40),
            &track(20.0, -20.0, math::FRAC_PI_2, 10.0, 40),
            STEP,
        );
        assert_eq!(pet.unwrap().value, 0.0);
    }

    #[test]
    fn too_few_samples_give_none() {
        assert_eq!(post_encroachment_time(&[], &[], STEP), None);
        assert_eq!(post_encroachment_time(&track(0.0, 0.0, 0.0, 1.0, 1), &track(0.0, 0.0, 0.0, 1.0, 5), STEP), None);
    }

    /// Least lag over all pairs of times, in small steps.
    fn brute_force(a: [f64; 4], b: [f64; 4], step: f64, end: f64) -> f64 {
        let at = |[x, y, heading, speed]: [f64; 4], time: f64| {
            let position = Vec2::new(x, y) + Vec2::from_heading(heading) * (speed * time);
            OrientedBox::new(Pose { position, heading }, 4.0, 2.0)
        };
        let steps = (end / step) as usize;
        let boxes: Vec<_> = (0..=steps).map(|k| (at(a, k as f64 * step), at(b, k as f64 * step))).collect();
        let mut best = f64::INFINITY;
        for i in 0..=steps {
            for j in 0..=steps {
                let lag = i.abs_diff(j) as f64 * step;
                if lag < best && boxes[i].0.overlaps(&boxes[j].1) {
                    best = lag;
                }
            }
        }
        best
    }
}
