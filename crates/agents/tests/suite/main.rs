//! Tests of the crate as its users see it, in one binary: a file a subject.

mod accounts;
mod designs;
mod narratives;
mod readings;
mod real_records;
mod restagings;
mod reviews;
mod support;
mod worked_examples;
