//! Checked scenarios: everything resolved, so that the simulator cannot fail.

use crate::conflict::Conflict;
use crate::course::{Course, StopLine};
use crate::drawing::{LineKind, RoadDrawing, RoadLine};
use crate::lane::LaneId;
use crate::network::RoadNetwork;
use crate::path::LanePath;
use recrash_model::geometry::Pose;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::PlacedObstacle;
use recrash_model::scenario::{Part, ScenarioDraft};
use recrash_model::vehicle::VehicleSpec;
use std::sync::Arc;

/// A scenario that passed the check. Made by [`crate::check()`] alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    pub(crate) draft: ScenarioDraft,
    pub(crate) network: Arc<RoadNetwork>,
    pub(crate) ego: Placement,
    pub(crate) partners: Vec<Placement>,
    pub(crate) obstacles: Vec<ObstaclePlacement>,
    pub(crate) actors: Vec<ActorPlacement>,
    pub(crate) recorded: Option<ActorPlacement>,
    pub(crate) control: Vec<ControlPlacement>,
}

/// A road user's start and way.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// Kind.
    pub kind: PartnerKind,
    /// The lanes it follows.
    pub path: LanePath,
    /// Start along its path. [m]
    pub s_m: f64,
    /// Start to the right of its path. [m]
    pub t_m: f64,
    /// Start in the world.
    pub pose: Pose,
    /// Speed at the start. [m/s]
    pub speed_mps: f64,
    /// Where its path meets the ego's (absent for the ego itself, and where they never meet).
    pub conflict: Option<Conflict>,
}

/// Somebody with a plan: where it starts, and the line it follows.
#[derive(Debug, Clone, PartialEq)]
pub struct ActorPlacement {
    /// Kind.
    pub kind: PartnerKind,
    /// Length of its box. [m]
    pub length_m: f64,
    /// Width of its box. [m]
    pub width_m: f64,
    /// Mass; `None` for what stands firm. [kg]
    pub mass_kg: Option<f64>,
    /// Centre of its box at the start.
    pub pose: Pose,
    /// The line of its rear axle.
    pub course: Course,
    /// Start beside that line, to its right. [m]
    pub t_m: f64,
    /// What belongs to it.
    pub parts: Vec<Part>,
}

/// Where control of traffic acts.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlPlacement {
    /// Lanes it is for, each with the place of its stop line along it. [m]
    pub lines: Vec<(LaneId, f64)>,
    /// Whether it may ask for a stop: all but a yield sign, at which only the rules of giving way hold.
    pub stops: bool,
}

/// A static obstacle in the world, and the lane it lies in (the nearest, where it lies beside all).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObstaclePlacement {
    /// Where.
    pub placed: PlacedObstacle,
    /// Lane.
    pub lane: LaneId,
}

impl Scenario {
    /// The draft it was checked from.
    pub fn draft(&self) -> &ScenarioDraft {
        &self.draft
    }

    /// Roads.
    pub fn network(&self) -> &RoadNetwork {
        &self.network
    }

    /// Roads as areas and lines, with the stop lines of signals and signs.
    pub fn drawing(&self) -> RoadDrawing {
        let mut drawing = self.network.drawing();
        let lines = self.network.stop_lines(&self.draft.control).into_iter();
        drawing.lines.extend(lines.map(|line| RoadLine { kind: LineKind::Stop, points: line.to_vec() }));
        drawing
    }

    /// The ego.
    pub fn ego(&self) -> &Placement {
        &self.ego
    }

    /// The partners, in the draft's order.
    pub fn partners(&self) -> &[Placement] {
        &self.partners
    }

    /// The obstacles, in the draft's order, and behind them its objects.
    pub fn obstacles(&self) -> &[ObstaclePlacement] {
        &self.obstacles
    }

    /// Road users with a plan, in the draft's order.
    pub fn actors(&self) -> &[ActorPlacement] {
        &self.actors
    }

    /// The ego as it was driven in the record, where that is told.
    pub fn recorded(&self) -> Option<&ActorPlacement> {
        self.recorded.as_ref()
    }

    /// Length and width of the ego. [m]
    pub fn ego_size_m(&self) -> (f64, f64) {
        ego_size_m(&self.draft, self.ego.kind)
    }

    /// Where the ego's path passes stop lines.
    pub fn ego_stop_lines(&self) -> impl Iterator<Item = StopLine> + '_ {
        let (path, half_length_m) = (&self.ego.path, 0.5 * self.ego_size_m().0);
        self.control.iter().enumerate().flat_map(move |(control, placed)| {
            placed.lines.iter().filter_map(move |&(lane, line_m)| {
                let segment = path.segments.iter().find(|segment| segment.lane == lane)?;
                Some(StopLine { at_m: segment.start_m + line_m - half_length_m, control })
            })
        })
    }

    /// Signals and signs, in the draft's order.
    pub fn control(&self) -> &[ControlPlacement] {
        &self.control
    }
}

/// Length and width of a draft's ego: its own, else those of its kind. [m]
pub(crate) fn ego_size_m(draft: &ScenarioDraft, kind: PartnerKind) -> (f64, f64) {
    let spec = VehicleSpec::of(kind);
    draft.ego.size.map_or((spec.length_m, spec.width_m), |size| (size.length_m, size.width_m))
}
