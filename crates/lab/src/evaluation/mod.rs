//! Accounts of a reader against labels that people wrote. Described in `docs/models/evaluation.md`.

mod scores;

pub use scores::*;
