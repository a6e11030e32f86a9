//! Plans of acts: what somebody does who moves exactly along a course.
//!
//! A scenario's [`recrash_model::scenario::ActorPlan`] becomes a [`Programme`]; a [`Progress`] says how far it has come. Once in
//! 0.1 s [`Programme::decide`] looks at the others and chooses an acceleration; [`Programme::advance`] moves along the course,
//! exactly, in steps of any length; [`Programme::motion`] says where that is in the plane. Both are plain data. Equations and
//! the meaning of every act and trigger: `docs/models/acts.md`.

mod decide;
mod names;
mod parts;
mod programme;
mod progress;
mod replay;

pub use decide::{Glimpse, Sight};
pub use names::Names;
pub use parts::{Attached, PartState};
pub use programme::{Deed, PlannedAct, Programme, When, Who};
pub use progress::{Mode, Progress};
pub use replay::{PartTrack, Replay, ReplayTrack, replay};
