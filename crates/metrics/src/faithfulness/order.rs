//! Who was first at the place where two paths cross.

use crate::scene::time_of;
use recrash_model::geometry::{OrientedBox, Vec2};

/// After a contact each would have gone on for this long. [s]
const ONWARD_S: f64 = 3.0;

/// Time by which the second came to the place where the paths cross later than the ego (positive), or earlier. [s]
///
/// The place of the ego is what the other's box sweeps, and the other way round; each comes to it when its own box first
/// touches what the other sweeps, now or later. A contact cuts the paths short, so both go straight on from their last
/// pose at their last speed. `None` where the paths have no place in common.
pub(super) fn lag(ego: &[OrientedBox], other: &[OrientedBox]) -> Option<f64> {
    let (ego, other) = (onward(ego), onward(other));
    let reach = ego.first()?.radius() + other.first()?.radius();
    let meets =
        |a: &OrientedBox, b: &OrientedBox| (a.centre - b.centre).length_squared() <= reach * reach && a.overlaps(b);
    let first = |of: &[OrientedBox], sweep: &[OrientedBox]| {
        of.iter().position(|outline| sweep.iter().any(|there| meets(outline, there)))
    };
    Some(time_of(first(&other, &ego)?) - time_of(first(&ego, &other)?))
}

/// A track, and how it would have gone on.
fn onward(track: &[OrientedBox]) -> Vec<OrientedBox> {
    let mut all = track.to_vec();
    let step_m = match track {
        [.., before, last] => before.centre.distance(last.centre),
        _ => 0.0,
    };
    if let Some(last) = track.last() {
        let steps = (ONWARD_S / time_of(1)).round() as u32;
        let place = |n: u32| Vec2 {
            x: last.centre.x + last.axis.x * step_m * f64::from(n),
            y: last.centre.y + last.axis.y * step_m * f64::from(n),
        };
        all.extend((1..=steps).map(|n| OrientedBox { centre: place(n), ..*last }));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::geometry::Pose;

    /// A car of 4 by 2 m from `at`, along `heading`, at 1 m a step.
    fn track(at: Vec2, heading: f64, steps: u32) -> Vec<OrientedBox> {
        let go = Vec2::from_heading(heading);
        let pose = |n: u32| Pose { position: at + go * f64::from(n), heading };
        (0..=steps).map(|n| OrientedBox::new(pose(n), 4.0, 2.0)).collect()
    }

    #[test]
    fn the_lag_is_that_of_the_arrivals_also_where_a_contact_cuts_the_paths_short() {
        let south = -recrash_model::math::FRAC_PI_2;
        // The ego touches the other's way after 18 steps (17.3 m), the other the ego's after 23 (22.4 m) or 13.
        for steps in [60, 20, 15] {
            let ego = track(Vec2::new(-20.3, 0.0), 0.0, steps);
            let late = lag(&ego, &track(Vec2::new(0.0, 25.4), south, steps)).expect("they cross");
            assert!((late - 0.5).abs() < 1e-9, "{late}");
            let early = lag(&ego, &track(Vec2::new(0.0, 15.4), south, steps)).expect("they cross");
            assert!((early + 0.5).abs() < 1e-9, "{early}");
        }
    }

    #[test]
    fn paths_that_never_meet_have_no_lag() {
        let ego = track(Vec2::new(0.0, 0.0), 0.0, 30);
        assert_eq!(lag(&ego, &track(Vec2::new(0.0, 30.0), 0.0, 30)), None);
        assert_eq!(lag(&ego, &[]), None);
    }
}
