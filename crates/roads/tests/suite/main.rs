//! Tests of the crate as its users see it, in one binary: a file a subject.

mod any_draft;
mod any_graph;
mod check;
mod common;
mod docs;
mod drawing;
mod fuzz_corpus;
mod graph;
mod graph_areas;
mod graph_check;
mod metadrive_lanes;
mod networks;
mod read;
