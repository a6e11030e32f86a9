//! Tests of the crate as its users see it, in one binary: a file a subject.

mod acts;
mod behaviour;
mod common;
mod driven;
mod parity;
mod partners;
mod reference;
mod runs;
mod vehicle;
