//! Reference drivers: what a careful, a fuzzy, a rule-bound driver does when somebody cuts in, cuts out or brakes ahead.
//!
//! UN Regulation 157 asks of an automated lane keeping system that it avoid what a careful and competent driver avoids. Four
//! published models say what that is: [`ReferenceDriver`]. They are tried on four grids of concrete scenarios on a straight
//! road ([`Grid`]), in the geometry and with the step of the European Commission's Joint Research Centre, so that verdicts can
//! be held against its own. And they are put in the ego's place in a contact that happened: [`preventability`]. Formulas, sources
//! and where they are valid: `docs/models/reference-drivers.md`.
//!
//! What this crate does **not** do: it knows neither maps nor records nor the native simulator, and a conflict that no source
//! covers (a crossing, a rear approach) cannot be asked about.

mod careful;
mod driver;
mod fuzzy;
mod grid;
mod limits;
mod prevent;
mod regulation;
mod responsibility;
mod scene;
mod sight;

pub use driver::{Conflict, Driver, ReferenceDriver};
pub use grid::{Concrete, Grid};
pub use limits::{Occupants, least_time_to_collision_s};
pub use prevent::preventability;
pub use scene::{Crash, WIDTH_M, drive};
pub use sight::{Body, STEPS_PER_S};
