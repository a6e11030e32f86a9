//! A scenario, ready to be begun again and again.

use crate::ground::Ground;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{LanePath, Scenario};
use recrash_sim::{Recorder, RolloutRecorder, Run, Seat, Snapshot};

/// Distance between two points of a way. [m]
const SPACING_M: f64 = 1.0;

/// The ego's name in rollouts of episodes.
const EGO: &str = "gym";

/// A scenario, wound forward to the step at which the ego's seat takes over from the recorded driver.
#[derive(Debug, Clone)]
pub struct Scene {
    pub(crate) scenario: Scenario,
    pub(crate) start: Snapshot,
    /// What happened before that step.
    pub(crate) before: RolloutRecorder,
    pub(crate) way: Way,
    pub(crate) vehicle: VehicleSpec,
    pub(crate) outlines: Vec<Outline>,
    pub(crate) obstacles: Vec<OrientedBox>,
    pub(crate) ground: Option<Ground>,
}

/// How large an actor is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outline {
    pub(crate) length_m: f64,
    pub(crate) width_m: f64,
    /// Of the circle around it. [m]
    pub(crate) radius_m: f64,
    /// Of a part: its owner's position in the cast.
    pub(crate) owner: Option<u16>,
}

/// Why a scenario gives no episodes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SceneError {
    /// The recorded driver drives until the end.
    #[error(
        "{id}: the recorded driver drives until the run is over, so there is nothing to decide; give its ego an earlier \"handover_s\""
    )]
    NoHandover {
        /// The scenario.
        id: String,
    },
}

impl Scene {
    /// Winds a scenario forward to its handover.
    ///
    /// # Errors
    /// There is none before the run is over.
    pub fn new(scenario: Scenario) -> Result<Self, SceneError> {
        let mut run = Run::new(&scenario, Seat::Outside);
        let mut before = RolloutRecorder::new();
        before.begin(&scenario, EGO, run.cast());
        let mut start = run.snapshot();
        while run.observe().recorded {
            if run.termination().is_some() {
                return Err(SceneError::NoHandover { id: scenario.draft().id.clone() });
            }
            start = run.snapshot();
            run.step(None);
            // In the step of the handover the seat's controls count already: it belongs to the episode.
            if run.observe().recorded {
                before.step(run.decided());
                run.events().iter().for_each(|event| before.event(event));
            }
        }
        if run.observe().step == 0 && run.termination().is_some() {
            return Err(SceneError::NoHandover { id: scenario.draft().id.clone() });
        }
        let outlines = run.cast().iter().map(|member| Outline {
            length_m: member.length_m,
            width_m: member.width_m,
            radius_m: 0.5 * (member.length_m * member.length_m + member.width_m * member.width_m).sqrt(),
            owner: member.owner,
        });
        Ok(Self {
            start,
            before,
            way: Way::of(&scenario.ego().path),
            vehicle: VehicleSpec::of(scenario.ego().kind),
            outlines: outlines.collect(),
            obstacles: scenario.obstacles().iter().map(|obstacle| obstacle.placed.outline()).collect(),
            ground: None,
            scenario,
        })
    }

    /// The scenario.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }
}

/// A path as points at even distances, for look-ups in every step.
#[derive(Debug, Clone)]
pub(crate) struct Way {
    points: Vec<(Vec2, Vec2)>,
    pub(crate) length_m: f64,
}

impl Way {
    fn of(path: &LanePath) -> Self {
        let pieces = (path.length_m / SPACING_M).ceil().max(1.0) as usize;
        let point = |piece: usize| {
            let pose = path.pose(piece as f64 * SPACING_M, 0.0);
            (pose.position, Vec2::from_heading(pose.heading))
        };
        Self { points: (0..=pieces).map(point).collect(), length_m: path.length_m }
    }

    /// Point and direction at a place; before the beginning and behind the end it goes straight on.
    pub(crate) fn at(&self, s_m: f64) -> (Vec2, Vec2) {
        let place = s_m / SPACING_M;
        let piece = (place.floor().max(0.0) as usize).min(self.points.len() - 1);
        let (position, forward) = self.points[piece];
        (position + forward * (s_m - piece as f64 * SPACING_M), forward)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_roads::{check, read_draft};

    fn scene(name: &str) -> Result<Scene, SceneError> {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
        let text = std::fs::read_to_string(file).unwrap();
        Scene::new(check(read_draft(&text).unwrap().value).unwrap().value)
    }

    #[test]
    fn a_scene_begins_at_its_handover() {
        let scene = scene("crashes/29-left-turn-across.json").unwrap();
        let mut run = Run::new(scene.scenario(), Seat::Outside);
        run.restore(&scene.start);
        // "handover_s": 2
        assert_eq!(run.observe().step, 20);
        assert!(run.observe().recorded);
        run.step(Some(recrash_sim::Controls { steer: 0.0, throttle: -1.0 }));
        assert_eq!((run.observe().recorded, run.decided()[0].throttle), (false, -1.0));
    }

    #[test]
    fn a_way_is_the_path_to_a_decimetre() {
        let scene = scene("roads/17-roundabout.json").unwrap();
        let path = &scene.scenario().ego().path;
        for place in 0..(path.length_m * 3.0) as usize {
            let s_m = place as f64 / 3.0;
            let (exact, near) = (path.pose(s_m, 0.0).position, scene.way.at(s_m).0);
            assert!(exact.distance(near) < 0.1, "{s_m}: {exact:?} {near:?}");
        }
    }
}
