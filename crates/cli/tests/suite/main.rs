//! Tests of the crate as its users see it, in one binary: a file a subject.

mod accounts;
mod assess;
mod bad_input;
mod batch;
mod check_driver;
mod common;
mod contradictions;
mod edits;
mod egos;
mod eval;
mod export;
mod live;
mod nightly;
mod outputs;
mod paper;
mod read;
mod reconstruct;
mod records;
mod repeatable;
mod second_reading;
mod selection;
mod stranger;
mod suite_folder;
mod sweep;
mod terminal;
mod tools;
