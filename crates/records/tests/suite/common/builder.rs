//! Small CSV files in the published columns, for tests: rows are named cells, everything else is blank.

use recrash_model::record::Edition;
use recrash_records::published_header;

/// The header of an edition as a line.
pub fn header(edition: Edition) -> String {
    published_header(edition).collect::<Vec<_>>().join(",")
}

/// A row of an edition: the cells of a plain, usable record, with these changed.
pub fn row(edition: Edition, id: &str, changes: &[(&str, &str)]) -> String {
    let plain = [
        ("Report ID", id),
        ("Report Version", "1"),
        ("Reporting Entity", "Northlight Robotics"),
        ("Roadway Type", "Intersection"),
        ("Crash With", "SUV"),
        ("CP Pre-Crash Movement", "Proceeding Straight"),
        ("SV Pre-Crash Movement", "Making Left Turn"),
        ("SV Precrash Speed (MPH)", "10"),
        ("Narrative", "The AV was turning left when an SUV ran the red light."),
    ];
    let cell = |column: &str| {
        let changed = changes.iter().find(|(name, _)| *name == column);
        let cell = changed.or_else(|| plain.iter().find(|(name, _)| *name == column)).map_or("", |(_, value)| value);
        if cell.contains([',', '"', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
    };
    published_header(edition).map(cell).collect::<Vec<_>>().join(",")
}

/// A file of the second edition with these rows.
pub fn second(rows: &[String]) -> String {
    let mut lines = vec![header(Edition::Second)];
    lines.extend(rows.iter().cloned());
    lines.join("\n") + "\n"
}
