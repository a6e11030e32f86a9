//! Tests of the crate as its users see it, in one binary: a file a subject.

mod failures;
mod findings;
