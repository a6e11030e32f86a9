//! Tests of the crate as its users see it, in one binary: a file a subject.

mod faithfulness;
mod measure;
mod tested;
mod world;
