//! Tests of the crate as its users see it, in one binary: a file a subject.

mod common;
mod faults;
mod real_metadrive;
mod scenes;
