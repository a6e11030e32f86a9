//! Tests of the crate as its users see it, in one binary: a file a subject.

mod common;
mod coverage;
mod export;
mod fuzz_corpus;
mod goldens;
mod import;
mod scenes;
