//! Tests of the crate as its users see it, in one binary: a file a subject.

mod areas;
mod bad_input;
mod common;
mod filter;
mod fuzz_corpus;
mod identity;
mod mapping;
mod real_files;
mod sample;
mod table;
