//! Many runs at once, for drivers that learn: a [`Batch`] of slots, each with a [`Run`](recrash_sim::Run) of one of a list
//! of [`Scene`]s, stepped together on the threads that are asked for, written into memory that the caller owns.
//!
//! - [`Scene`]: a scenario, wound forward to where the ego's seat takes over.
//! - [`View`]: what a driver is shown: numbers about its surroundings, rays, or a picture from above.
//! - [`Handles`]: what a driver answers: pedals and wheel, an acceleration and a place beside the route, or one of a few acts.
//! - [`Reward`]: what is good and bad, as documented terms with weights.
//! - [`Batch`]: steps, ends episodes, begins new ones, judges those that ended.
//!
//! The same seed and actions give the same bytes for any number of threads. A step allocates nothing, unless episodes are
//! judged. An episode is the run that the simulator gives: same controls, same states, same hash.
//!
//! What this crate does **not** do: it knows nothing of Python and opens no file. A clock tells its threads alone how long they stay awake
//! between two steps (200 µs); nothing that is computed depends on it.

mod batch;
mod ground;
mod handles;
mod kinematics;
mod outputs;
mod raster;
mod rays;
mod reward;
mod scene;
mod settings;
mod slot;
mod split;
mod view;

pub use batch::{Actions, Batch, BatchError};
pub use handles::{ACTS, Act, Handles};
pub use kinematics::{FIELDS_ALWAYS, FIELDS_OF_OTHER, Field, MOST_NEIGHBOURS};
pub use outputs::Outputs;
pub use raster::{CHANNELS, Raster};
pub use rays::Rays;
pub use reward::{Reward, TERMS};
pub use scene::{Scene, SceneError};
pub use settings::{Autoreset, Settings};
pub use split::held_out;
pub use view::{View, ViewError};
