//! From an account to a scenario that shows the crash as it is told, with the recorded driver in the ego's seat; and every
//! told fact held against what the rollout shows.
//!
//! The crash is staged backwards: first how the two touch (`touch`: headings, zones, who closes on whom), then how each
//! of them came there (`ego`, `partner`), on the road around it (`ground`). What the account leaves open is chosen, and
//! named as assumed. A rollout decides: who is drawn and does not show a told fact is not told (`facts`, `search`). Rules and
//! numbers: `docs/models/reconstruction.md`.
//!
//! The folders are layers: each uses only those before it in this order: `told`, `reading`, `ground`, `pace`, `ego`, `touch`,
//! `partner`, `others`, `draft`, `facts`, `nearby`, `search`. `ARCHITECTURE.md` says what stands where.

mod draft;
mod ego;
mod facts;
mod ground;
mod nearby;
mod others;
mod pace;
mod partner;
mod reading;
mod search;
mod told;
mod touch;
mod usual;

pub use draft::scenario::HANDOVER_BEFORE_S;
pub use ego::plan::ROLLS_S;
pub use search::open::open_choices;
pub use search::reconstruction::Reconstruction;

use crate::facts::{list, strays};
use crate::search::staged::staged;
use crate::told::choices::Choices;
use crate::told::crash::Told;
use recrash_model::account::{Account, Untold};
use recrash_model::metrics::{CheckKind, Verdict};
use recrash_model::rollout::Rollout;
use recrash_model::tuning::Parameter;
use recrash_roads::Scenario;

/// The kinds of facts that an account tells and that can be held against a rollout, whether or not it can be staged.
pub fn told_kinds(account: &Account) -> Vec<CheckKind> {
    Told::read(account).map(|told| list::kinds(&told)).unwrap_or_default()
}

/// Told facts of an account, held against a rollout of any scenario. Of the scenario its roads, signals and stops are looked at.
///
/// # Errors
/// The account cannot be staged at all.
pub fn held_against(account: &Account, scenario: &Scenario, rollout: &Rollout) -> Result<Verdict, Untold> {
    Ok(Verdict { checks: list::facts(&Told::of(account)?, scenario, rollout) })
}

/// For how long the partner of a reconstruction is in no lane of its direction before it does what is told to take it aside; nothing
/// where it does not come along lanes. [s]
pub fn off_lane_s(account: &Account, made: &Reconstruction) -> Option<f64> {
    let scenario = recrash_roads::check(made.draft.clone()).ok()?.value;
    strays::off_lane_s(&Told::read(account)?, &scenario, &made.rollout)
}

/// Stages an account: the first staging that shows every told fact, else the one that shows most.
///
/// # Errors
/// Why there is none.
pub fn reconstruct(account: &Account) -> Result<Reconstruction, Untold> {
    staged(Told::of(account)?, account)
}

/// The same with these values for what the account leaves open ([`open_choices`]).
///
/// # Errors
/// Why there is none.
pub fn reconstruct_with(account: &Account, open: &[Parameter], values: &[f64]) -> Result<Reconstruction, Untold> {
    let told = Told::of(account)?;
    staged(told.choosing(Choices::of(open, values)), account)
}
