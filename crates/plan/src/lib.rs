//! What a road user that is no system under test does: one meaning, written once.
//!
//! A scenario's policy and its sideways moves become a [`Plan`]: plain data. The functions here say what a plan asks for
//! at a moment, from what its driver sees then. The native simulator calls them; the rehearsal of the rules and the
//! exports ask what a plan does with nobody else on the road ([`Alone`]); MetaDrive's Python reads the same plans and
//! the same constants as data ([`metadrive`]). Equations and sources: `docs/models/policies.md`.
//!
//! What this crate does **not** do: it moves nobody. Vehicles belong to the simulators.

pub mod acts;
mod alone;
pub mod constants;
mod follow;
mod give_way;
mod line;
pub mod metadrive;
mod pedal;
mod speed;
mod steering;
mod way;

pub use alone::Alone;
pub use constants::Constants;
pub use follow::{Lead, gap_law};
pub use give_way::{Crossing, Manners, Stretch, Traveller, must_wait, stop_distance};
pub use line::{drift, lateral_target};
pub use pedal::hold_still;
pub use speed::{Moment, Plan, SpeedPlan};
pub use steering::{LaneKeeper, Line};
pub use way::{Bend, Blocked, Way};
