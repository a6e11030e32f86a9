//! The search: tellings and ways of touching that are tried in turn, run, held against what is told, and compared.

mod best;
pub(crate) mod open;
pub(crate) mod reconstruction;
pub(crate) mod staged;
mod variants;
