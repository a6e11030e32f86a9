//! Tests of the crate as its users see it, in one binary: a file a subject.

mod acts;
mod behaviour;
mod common;
mod control;
mod demand;
mod driven;
mod gallery;
mod mutated;
mod parity;
mod partners;
mod reference;
mod runs;
mod steps;
mod vehicle;
