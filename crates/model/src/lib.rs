//! The nouns of recrash, and nothing else: every stage takes some of these and gives some of these.
//!
//! The flow is one way: [`record::CrashRecord`] -> [`template::Template`] -> [`selection::Selection`] ->
//! [`narrative::Narrative`] -> [`scenario::ScenarioDraft`] -> [`rollout::Rollout`] -> [`metrics::Metrics`] ->
//! [`tuning::TuneLog`].
//!
//! What this crate does **not** do: it opens no file, reads no clock, and knows neither roads nor physics. Units are SI
//! and stand in the field's name or at the end of its documentation.

pub mod account;
pub mod cause;
pub mod comparison;
mod conflict;
pub mod coverage;
pub mod diagnostic;
mod formats;
pub mod frozen;
pub mod geometry;
pub mod hash;
pub mod incident;
pub mod kinds;
pub mod labelled;
pub mod math;
pub mod metrics;
pub mod narrative;
mod origin;
pub mod polygon;
pub mod preventability;
pub mod profile;
pub mod record;
pub mod results;
pub mod review;
pub mod rollout;
pub mod run;
pub mod scenario;
pub mod seed;
pub mod selection;
pub mod severity;
pub mod spreadsheet;
pub mod surroundings;
pub mod template;
pub mod triage;
pub mod tuning;
pub mod vehicle;
pub mod zones;

pub use diagnostic::{Diagnostic, Location, Outcome, Severity};
pub use seed::Seed;
