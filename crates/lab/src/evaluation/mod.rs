//! Accounts of a reader against labels of independent readers. Described in `docs/models/evaluation.md`.

mod scores;

pub use scores::*;
