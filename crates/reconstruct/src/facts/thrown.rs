//! From where who touched the partner first is told to come, held against its way.

use crate::told::crash::Told;
use crate::told::others::Thrower;
use crate::usual::LANE_M;
use recrash_model::account::LeftRight;
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::rollout::ActorTrack;

/// Who is told to come from a side is so much of a lane beside where it touches, at first; and from a crossing road at such an angle. [-, rad]
const ASIDE: f64 = 0.35;
const CROSSES_RAD: (f64, f64) = (0.6, 2.5);

/// Who is told to have come fast came to so much at least. [m/s]
const FAST_MPS: f64 = 12.0;

/// Whether who touched the partner first came from where it is told to, and as fast as it is.
pub(super) fn comes_as_told(told: &Told, ego: &ActorTrack, [partner, other]: [&ActorTrack; 2], step: usize) -> bool {
    let road = Vec2::from_heading(ego.states[0].heading);
    let met = partner.at(step).position();
    let of_ego = ego.at(step).position();
    // Of the ego, or of whom it touched.
    let on_side = |side: LeftRight| {
        let left_m = [met, of_ego].map(|from| road.cross(other.states[0].position() - from));
        let sign = side.sign();
        left_m.iter().any(|left_m| sign * left_m > ASIDE * LANE_M)
    };
    let way = other.at(step).position() - of_ego;
    let is_ahead = road.dot(way) > 0.0 && road.cross(way).abs() < 0.5 * LANE_M;
    let turned = math::wrap_angle(other.states[0].heading - ego.states[0].heading).abs();
    let fastest = other.states[..=other.within(step)].iter().map(|state| state.velocity().length());
    if told.pusher_fast && fastest.fold(0.0, f64::max) < FAST_MPS {
        return false;
    }
    match told.thrower {
        None => true,
        Some(Thrower::Beside(side)) => on_side(side),
        Some(Thrower::Ahead) => is_ahead && turned < CROSSES_RAD.0,
        Some(Thrower::Opposite) => turned >= CROSSES_RAD.1,
        Some(Thrower::Cross(side)) => on_side(side) && (CROSSES_RAD.0..CROSSES_RAD.1).contains(&turned),
    }
}
