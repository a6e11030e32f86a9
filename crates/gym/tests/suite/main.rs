//! Promises about batches of runs.

mod batches;
mod common;
mod views;
