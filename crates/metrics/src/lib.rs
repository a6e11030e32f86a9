//! What a rollout says about the ego, and whether it is true to its record.
//!
//! - [`measure()`]: gaps, contact, time to collision, post-encroachment time, deceleration needed, headway, and the
//!   ego's own behaviour. Formulas and sources: one page each in `docs/models/`.
//! - [`findings()`]: failures and odd behaviour against the profile's criteria, one sentence each.
//! - [`faithfulness()`]: whether the rollout shows what the record tells, from the paths driven alone.
//! - [`series()`]: time series for plots.
//! - [`severity_of()`]: how bad the ego's contact is: delta-v by momentum, risk of injury by published curves.
//!
//! What this crate does **not** do: it never simulates, never reads a record, and never trusts a scenario's labels when
//! it judges faithfulness. It takes rollouts of any simulator that gives poses every 0.1 s.

pub mod contact;
mod ego;
pub mod encroachment;
pub mod faithfulness;
pub mod findings;
pub mod following;
pub mod measure;
#[cfg(test)]
mod oracle;
mod scene;
pub mod severity;
pub mod swept;

pub use faithfulness::{faithfulness, faithfulness_on};
pub use findings::{came_nearer, findings};
pub use measure::{measure, measure_on, series};
pub use scene::EgoWay;
pub use severity::severity_of;
