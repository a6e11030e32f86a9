//! How fast and in how much memory a large crash file is read: `cargo run --release -p recrash-records --example
//! large_file [MEGABYTES]` writes the sample over and over, with other report ids, to a temporary file, then reads that
//! in a process of its own and checks every count. Not among the tests: only an optimised build says anything.

use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_model::record::RejectReason;
use recrash_records::{IngestOptions, SAMPLE_CSV, SourceBytes, SourceText, ingest, ingest_sources};
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::Instant;

/// One row in so many copies of the sample is cut short, so that rejected rows are counted too.
const COPIES_PER_BAD_ROW: usize = 10;

fn main() -> std::io::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [command, path, copies] = &arguments[..]
        && command == "read"
    {
        return read(Path::new(path), copies.parse().expect("a number of copies"));
    }
    let megabytes: usize = arguments.first().map_or(100, |text| text.parse().expect("a number of megabytes"));
    let path = std::env::temp_dir().join(format!("recrash-large-{}.csv", std::process::id()));
    let copies = write(&path, megabytes * 1_000_000)?;
    let status = std::process::Command::new(std::env::current_exe()?)
        .args(["read", &path.to_string_lossy(), &copies.to_string()])
        .status();
    std::fs::remove_file(&path)?;
    assert!(status?.success());
    Ok(())
}

/// Writes the file, and gives the number of copies of the sample in it.
fn write(path: &Path, bytes: usize) -> std::io::Result<usize> {
    let (header, rows) = SAMPLE_CSV.split_once('\n').expect("the sample has a header");
    let mut file = BufWriter::new(std::fs::File::create(path)?);
    writeln!(file, "{header}")?;
    let copies = bytes.div_ceil(rows.len());
    for copy in 0..copies {
        // The sample's report ids begin with 9010 at the start of a line.
        let renumbered = format!("\n{rows}").replace("\n9010", &format!("\n9{copy:03}0"));
        file.write_all(renumbered.trim_start_matches('\n').as_bytes())?;
        if copy % COPIES_PER_BAD_ROW == 0 {
            writeln!(file, "12345-{copy},1,cut short")?;
        }
    }
    file.flush()?;
    Ok(copies)
}

fn read(path: &Path, copies: usize) -> std::io::Result<()> {
    let mut profile: SystemProfile =
        toml::from_str(include_str!("../../../profiles/paper.toml")).expect("profiles/paper.toml is a profile");
    profile.records.dedupe = Dedupe::None;
    let file = std::fs::File::open(path)?;
    let length = file.metadata()?.len();
    let begun = Instant::now();
    let source = SourceBytes { name: "large.csv", bytes: Box::new(file) };
    let set = ingest_sources(vec![source], &profile, &IngestOptions::default()).expect("it is readable").value;
    let seconds = begun.elapsed().as_secs_f64();

    let one =
        ingest(&[SourceText { name: "sample.csv", bytes: SAMPLE_CSV.as_bytes() }], &profile).expect("readable").value;
    let bad = copies.div_ceil(COPIES_PER_BAD_ROW);
    assert_eq!(set.records.len(), copies * one.records.len());
    assert_eq!(set.usable.len(), copies * one.usable.len());
    let malformed: Vec<u64> =
        set.rejects.iter().filter(|reject| reject.reason == RejectReason::Malformed).map(|reject| reject.row).collect();
    assert_eq!(malformed.len(), bad);
    let row_of = |n: usize| ((n * COPIES_PER_BAD_ROW + 1) * one.records.len() + n + 1) as u64;
    assert!(malformed.iter().enumerate().all(|(n, row)| *row == row_of(n)), "bad rows are told by their numbers");

    let megabytes = length as f64 / 1e6;
    println!("file                {megabytes:.1} MB, {} rows, {bad} of them malformed", set.records.len() + bad);
    println!("counts              correct (records, usable, malformed rows by number)");
    println!("ingest              {seconds:.2} s, {:.0} MB/s", megabytes / seconds);
    println!("most memory         {}", peak_memory());
    Ok(())
}

/// The most memory this process has held, as Linux tells it.
fn peak_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes: Option<f64> = line.and_then(|text| text.trim().trim_end_matches(" kB").parse().ok());
    kilobytes.map_or_else(|| "not told by this system".to_owned(), |kb| format!("{:.0} MB", kb * 1024.0 / 1e6))
}
