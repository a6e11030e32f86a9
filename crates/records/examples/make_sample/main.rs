//! Writes the built-in sample to standard output:
//! `cargo run -p recrash-records --example make_sample > crates/records/data/sample.csv`.
//!
//! Events, companies, places and ids are invented, and so is every sentence. What follows NHTSA's file is the shape: the
//! columns, the shares of crash types, stops and companies, and the untidiness (redactions, copies, versions, gaps, slips of
//! the pen).
//!
//! With the word `meant`, what each incident's story means, as a table: what a reader should find.
//!
//! With a number, so many copies of it as reports of incidents of their own, for measuring large suites:
//! `cargo run -p recrash-records --example make_sample -- 10 > large.csv`.

mod generator;

use generator::Meant;
use std::io;

/// What stood beside the road in a copy, so that no two narratives are the same.
const BESIDE: [&str; 24] = [
    "ladders",
    "trees",
    "hedges",
    "fences",
    "mailboxes",
    "benches",
    "umbrellas",
    "kiosks",
    "awnings",
    "planters",
    "statues",
    "fountains",
    "banners",
    "bollards",
    "hydrants",
    "lamps",
    "crates",
    "barrels",
    "carts",
    "tents",
    "bins",
    "kites",
    "flags",
    "tiles",
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let sample = generator::sample();
    match std::env::args().nth(1).as_deref() {
        None => print!("{}", sample.csv),
        Some("meant") => print_meant(&sample.meant),
        Some(copies) => write_copies(&sample.csv, copies.parse()?)?,
    }
    Ok(())
}

fn print_meant(meant: &[Meant]) {
    println!("incident,crash_type,state,movement");
    for Meant { incident, kind, state, movement } in meant {
        println!("{incident},{},{},{}", kind.label(), state.label(), movement.label());
    }
}

fn write_copies(sample: &str, copies: usize) -> Result<(), Box<dyn std::error::Error>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(sample.as_bytes());
    let rows = reader.records().collect::<Result<Vec<_>, _>>()?;
    let [header, rows @ ..] = rows.as_slice() else { return Ok(()) };
    let at = |name: &str| header.iter().position(|column| column == name).ok_or(format!("there is no column {name}"));
    let (report, incident, narrative) = (at("Report ID")?, at("Same Incident ID")?, at("Narrative")?);
    let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(io::stdout().lock());
    writer.write_record(header)?;
    for copy in 0..copies {
        for (number, row) in rows.iter().enumerate() {
            let words: Vec<&str> =
                (0..3).map(|n| BESIDE[(copy * 7 + number * 5 + n * n * 11) % BESIDE.len()]).collect();
            let cells = row.iter().enumerate().map(|(column, cell)| match column {
                _ if cell.is_empty() => String::new(),
                _ if column == report => format!("{cell}{copy:02}"),
                _ if column == incident => format!("{cell}x{copy}"),
                _ if column == narrative => format!("{cell} There were {}.", words.join(", ")),
                _ => cell.to_owned(),
            });
            writer.write_record(cells)?;
        }
    }
    writer.flush()?;
    Ok(())
}
