//! What is told to stand at the edge of the road, held against where it is touched.

use crate::told::crash::Told;
use crate::told::edge::{ALONG_DEG, LONG_M};
use recrash_model::account::LeftRight;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::math;
use recrash_model::rollout::ActorState;
use recrash_roads::{RoadPart, Scenario};

/// What stands at the edge reaches no farther into a lane. [m]
const INTO_LANE_M: f64 = 0.15;

pub(super) fn words(side: LeftRight) -> String {
    let side = if side == LeftRight::Left { "left" } else { "right" };
    format!("at the edge of the road, on the {side}")
}

/// Whether what the ego touches stands at the edge of the road that it is on, on the told side, and along it where it is long.
pub(super) fn check(
    told: &Told,
    side: LeftRight,
    scenario: &Scenario,
    ego: &ActorState,
    other: &OrientedBox,
) -> (bool, String) {
    let network = scenario.network();
    let left = Vec2::from_heading(ego.heading).cross(other.centre - ego.position()) > 0.0;
    let seen_on = if left { LeftRight::Left } else { LeftRight::Right };
    let part = |point: Vec2| network.lane_at(point, ego.heading).map(|lane| network.road(network.lane(lane).road).part);
    let (long_m, wide_m) = ((other.half_length - INTO_LANE_M).max(0.0), (other.half_width - INTO_LANE_M).max(0.0));
    let shares = || [-1.0, -0.5, 0.0, 0.5, 1.0].into_iter();
    let within = shares().flat_map(|x| shares().map(move |y| Vec2::new(x * long_m, y * wide_m)));
    let in_lane = within
        .map(|local| part(other.to_world(local)))
        .any(|part| part.is_some_and(|part| !matches!(part, RoadPart::Beside(_))));
    let road = network.lane_at(ego.position(), ego.heading).map(|lane| {
        let lane = network.lane(lane);
        lane.heading(lane.local(ego.position()).0)
    });
    let angle = road.map_or(0.0, |road| {
        let angle = math::wrap_angle(math::atan2(other.axis.y, other.axis.x) - road).to_degrees().abs();
        angle.min(180.0 - angle)
    });
    let along = 2.0 * other.half_length < LONG_M || (angle <= ALONG_DEG) != told.diagonal;
    let place = if in_lane { "in a lane" } else { "beside the lanes" };
    let seen = format!("{place}, on the {}, at {angle:.0} degrees to the road", if left { "left" } else { "right" });
    (seen_on == side && !in_lane && along, seen)
}
