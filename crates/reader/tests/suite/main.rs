//! Tests of the crate as its users see it, in one binary: a file a subject.

mod any_text;
mod columns;
mod common;
mod incidents;
mod nobody;
mod sample;
mod scores;
mod stories;
