//! The same scenarios on two simulators: which ones, and how far they agree. Described in `docs/models/parity.md`.

pub mod compare;
mod draw;
mod scenes;

pub use compare::{Agreement, Apart, GAP_TOLERANCE_M, Pair, PairOutcome, TIME_TOLERANCE_S};
pub use draw::random_scenario;
pub use scenes::random_scene;
