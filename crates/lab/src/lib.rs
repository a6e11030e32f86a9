//! What is computed over runs: a run is [judged](run_scenario), a point of a search [scored](Scoring), a failure
//! [triaged](triage), two simulators [compared](parity), a reader [scored](evaluation), results of a frozen suite
//! [compared](comparison), what led to a failure [told](causes), what of a corpus is [covered](coverage).
//!
//! What this crate does **not** do: it opens no file, reads no clock and starts no thread or program. Whoever wires it hands
//! it scenarios and simulators.

pub mod causes;
pub mod comparison;
pub mod coverage;
pub mod evaluation;
mod harm;
mod judging;
pub mod minimal;
pub mod parity;
pub mod perturb;
mod ranks;
pub mod replay;
pub mod robustness;
mod scoring;
mod triage;

pub use harm::{HarmCase, severity_agreement};
pub use judging::{judge, judge_by, run_scenario, run_scenario_in, situation};
pub use scoring::{Scoring, is_sound, is_sound_contact};
pub use triage::triage;
