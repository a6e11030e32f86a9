//! Numbers and lengths that more than one part goes by, where nobody tells another.

use recrash_model::math;
use recrash_plan::constants::COMFORTABLE_MPS2;

/// Width of driving lanes. [m]
pub(crate) const LANE_M: f64 = 3.4;

/// From the ego's front to who stands ahead. [m]
pub(crate) const LEAD_GAP_M: f64 = 2.5;

/// Room that is left before somebody, or behind. [m]
pub(crate) const ROOM_M: f64 = 2.0;

pub(crate) use recrash_model::rollout::STANDS_MPS;

/// A course goes on behind the place of the contact, so far that nobody slows for its end before it. [m]
pub(crate) fn beyond_m(speed_mps: f64) -> f64 {
    20.0 + (5.0 * speed_mps).max(0.5 * speed_mps * speed_mps / COMFORTABLE_MPS2).min(MOST_BEYOND_M)
}

/// A road goes on for no longer. [m]
const MOST_BEYOND_M: f64 = 280.0;

/// Nothing on wheels, longer than the first, bends its line tighter than the second. [m]
pub(crate) const WHEELED_M: f64 = 2.5;
pub(crate) const TIGHTEST_M: f64 = 4.5;

/// How long others who stopped have stood when they are hit. [s]
pub(crate) const STOOD_S: f64 = 2.0;

/// Speed of others on their way to a stop. [m/s]
pub(crate) const ROLLING_MPS: f64 = 7.0;

/// How fast a thing is that rolls or slides. [m/s]
pub(crate) const SLIDES_MPS: f64 = 2.0;

/// Usual speed on foot. [m/s]
pub(crate) const WALKS_MPS: f64 = 1.4;

/// Usual speed of who runs, on foot or on four legs; nobody is told to run who is slower than the second. [m/s]
pub(crate) const RUNS_MPS: f64 = 3.0;
pub(crate) const RUNS_LEAST_MPS: f64 = 2.0;

/// Who is told to brake hard. [m/s^2]
pub(crate) const HARD_MPS2: f64 = 6.0;

/// Usual speed in a turn. [m/s]
pub(crate) const TURNS_MPS: f64 = 5.0;

/// Who is narrower rides beside the driving lanes, and gets by beside somebody. [m]
pub(crate) const NARROW_M: f64 = 1.2;

/// Who turns by this much and bends to the other side for it first, by more than the second, swings out. [rad]
const TURNED_RAD: f64 = 0.35;
pub(crate) const SWINGS_OUT_RAD: f64 = 0.14;

/// How far somebody who turns bends to the other side for it first; 0 of who goes straight on. [rad]
pub(crate) fn swing_rad(headings: impl Iterator<Item = f64>) -> f64 {
    let (mut turned, mut last, [mut least, mut most]) = (0.0_f64, None, [0.0_f64; 2]);
    for heading in headings {
        turned += math::wrap_angle(heading - last.unwrap_or(heading));
        last = Some(heading);
        (least, most) = (least.min(turned), most.max(turned));
    }
    match turned.abs() > TURNED_RAD {
        true if turned > 0.0 => -least,
        true => most,
        false => 0.0,
    }
}
