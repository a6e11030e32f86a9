//! Writes the built-in sample to standard output:
//! `cargo run -p recrash-records --example make_sample > crates/records/data/sample.csv`.
//!
//! Events, companies, places and ids are invented, and so is every sentence. What follows NHTSA's file is the shape: the
//! columns, the template counts of the paper, and the untidiness (redactions, copies, versions, gaps, slips of the pen).

mod generator;

fn main() {
    print!("{}", generator::sample_csv());
}
