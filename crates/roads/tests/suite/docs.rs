//! The page on roads lists every code that the crate can tell.

use std::collections::BTreeSet;

const SOURCES: [&str; 20] = [
    include_str!("../../src/check/graph.rs"),
    include_str!("../../src/curve.rs"),
    include_str!("../../src/graph/junction.rs"),
    include_str!("../../src/graph/mod.rs"),
    include_str!("../../src/graph/place.rs"),
    include_str!("../../src/graph/strips.rs"),
    include_str!("../../src/check/actors.rs"),
    include_str!("../../src/check/actors/course.rs"),
    include_str!("../../src/check/actors/numbers.rs"),
    include_str!("../../src/check/control.rs"),
    include_str!("../../src/check.rs"),
    include_str!("../../src/check/motion.rs"),
    include_str!("../../src/check/numbers.rs"),
    include_str!("../../src/check/obstacles.rs"),
    include_str!("../../src/check/places.rs"),
    include_str!("../../src/check/remarks.rs"),
    include_str!("../../src/check/starts.rs"),
    include_str!("../../src/json_parts.rs"),
    include_str!("../../src/read.rs"),
    include_str!("../../src/paper_dialect.rs"),
];

/// Every `scenario.name` between two such marks.
fn codes(text: &str, mark: char) -> BTreeSet<&str> {
    let is_name = |text: &str| text.chars().all(|c| c.is_ascii_lowercase() || c == '-') && !text.is_empty();
    text.split(mark).filter(|piece| piece.strip_prefix("scenario.").is_some_and(is_name)).collect()
}

#[test]
fn the_page_lists_the_codes_and_no_others() {
    let told: BTreeSet<&str> = SOURCES.iter().flat_map(|source| codes(source, '"')).collect();
    let listed = codes(include_str!("../../../../docs/models/roads.md"), '`');
    assert!(told.len() > 25);
    assert_eq!(told, listed);
}
