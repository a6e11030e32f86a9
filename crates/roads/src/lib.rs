//! Road geometry of the paper's five blocks (S, C, X, T, O) and of networks of roads (G), and the check that turns a draft into a runnable scenario.
//!
//! Lane-local coordinates are the one road interface: `s` along the centre line, `t` to the **right** of it. [m]
//! Lane 0 is the leftmost of its road.

mod blocks;
mod centreline;
pub mod check;
mod conflict;
pub mod course;
mod curve;
pub mod drawing;
pub mod graph;
mod ground;
mod json_parts;
pub mod json_place;
pub mod lane;
mod lane_change;
mod map;
mod near;
pub mod network;
mod paper_dialect;
pub mod path;
pub mod place;
mod read;
mod reference_line;
pub mod scenario;
pub mod simulator;
pub mod traffic;
mod ways;

pub use centreline::Centreline;
pub use check::{MAX_WANTED_MPS, arm_m, check, check_on};
pub use conflict::{Conflict, Footprint};
pub use course::{Beside, Course, CourseLeg, CoursePiece, Spot, StopLine};
pub use drawing::{DrawnArea, GroundShape, LineKind, RoadDrawing, RoadLine};
pub use json_place::{add_lines, locate, path_at};
pub use lane::{Lane, LaneId, RoadId};
pub use near::nearest;
pub use network::{NamedRoad, Road, RoadNetwork, RoadPart};
pub use path::{LanePath, PathPoint};
pub use place::{BEYOND_END_M, OnLane, OnRoad, PlaceError, Placed};
pub use read::{MAX_SCENARIO_BYTES, read_draft, scenario_schema, write_draft};
pub use scenario::{ActorPlacement, ControlPlacement, ObstaclePlacement, Placement, Scenario};
pub use simulator::{AnswerTimes, RunError, Simulator};
pub use traffic::{TRAFFIC_SPEED_MPS, TrafficPlacement, background_traffic};
