//! When somebody comes into the junction.

use recrash_model::geometry::Vec2;
use recrash_model::rollout::ActorTrack;
use recrash_model::scenario::RoadStart;
use recrash_roads::Scenario;

/// The inside of a junction: where its arms begin. Arms are at right angles, so it is a square.
pub(super) struct Junction {
    centre: Vec2,
    half_m: f64,
}

impl Junction {
    /// The one that is drawn.
    pub(super) fn of(scenario: &Scenario) -> Option<Self> {
        let map = scenario.draft().map.network()?;
        let junction = map.junctions.first()?;
        let half_m = map.roads.iter().find_map(|road| match road.start {
            RoadStart::Arm { from_m, .. } => Some(from_m),
            _ => None,
        })?;
        Some(Self { centre: Vec2::new(junction.x_m, junction.y_m), half_m })
    }

    /// The first step at which somebody's front is inside.
    pub(super) fn entered(&self, track: &ActorTrack) -> Option<usize> {
        let inside = |way: Vec2| way.x.abs() < self.half_m && way.y.abs() < self.half_m;
        track.states.iter().position(|state| {
            let front = state.position() + Vec2::from_heading(state.heading) * (0.5 * track.length_m);
            inside(front - self.centre)
        })
    }
}
