//! Prints the accounts of crash files as lines of JSON: `cargo run --release -p recrash-reader --example accounts -- FILE...`.

use recrash_model::profile::SystemProfile;
use recrash_records::{SourceText, ingest};
use std::io::Write;

fn main() {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    let bytes: Vec<Vec<u8>> = paths.iter().map(|path| std::fs::read(path).expect("a crash file")).collect();
    let sources: Vec<SourceText<'_>> =
        paths.iter().zip(&bytes).map(|(name, bytes)| SourceText { name, bytes }).collect();
    let profile: SystemProfile = toml::from_str(include_str!("../../../profiles/paper.toml")).expect("a profile");
    let mut profile = profile;
    profile.records.dedupe = recrash_model::profile::Dedupe::None;
    let set = ingest(&sources, &profile).expect("crash files").value;
    let begun = std::time::Instant::now();
    let incidents = recrash_reader::incidents(&set.records);
    let grouped = begun.elapsed();
    let accounts: Vec<_> = incidents.iter().filter_map(recrash_reader::account).collect();
    eprintln!(
        "{} records, {} incidents, {} accounts; grouped in {grouped:?}, all in {:?}",
        set.records.len(),
        incidents.len(),
        accounts.len(),
        begun.elapsed()
    );
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    for account in &accounts {
        writeln!(out, "{}", serde_json::to_string(account).expect("an account")).expect("standard output");
    }
}
