//! Selection on whole crash files: the built-in sample, and NHTSA's own where it is at hand.

use crate::common::{paper, real_file, sample};
use recrash_model::Seed;
use recrash_model::record::RecordSet;
use recrash_model::selection::Strategy;
use recrash_model::template::{Movement, RoadType};
use recrash_select::{SelectOptions, embed_records, select, stability};

const SEEDS: usize = 50;

/// The paper's tables, and the promise of the default strategy.
fn check_paper_file(records: &RecordSet) {
    let selection = select(records, &paper(), &SelectOptions { seed: Seed(7), ..SelectOptions::default() }).unwrap();
    assert!(selection.diagnostics.is_empty(), "{:?}", selection.diagnostics);
    let selection = selection.value;
    let tables = &selection.tables;
    let roads = [(RoadType::Intersection, 214), (RoadType::Highway, 20), (RoadType::TrafficCircle, 1)];
    assert_eq!(tables.road_types, roads);
    assert_eq!(tables.sv_movements, Movement::PAPER);
    let rows: Vec<(Movement, &[usize])> = tables.movements.iter().map(|(cp, row)| (*cp, row.as_slice())).collect();
    assert_eq!(rows[0], (Movement::Straight, [120, 26, 16].as_slice()));
    assert_eq!(rows[1], (Movement::LeftTurn, [36, 9, 1].as_slice()));
    assert_eq!(rows[2], (Movement::RightTurn, [9, 4, 14].as_slice()));
    assert_eq!((tables.largest_template, tables.work_zone), (104, 9));
    assert_eq!((selection.templates.len(), selection.templates[0].records), (14, 104));
    assert_eq!((selection.coverage.templates_possible, selection.coverage.records), (54, 235));
    assert_eq!(selection.clusters.len(), 20);

    let embedding = embed_records(records);
    let study = |strategy| {
        let options = SelectOptions { strategy, ..SelectOptions::default() };
        stability(records, &paper(), &options, &embedding, SEEDS).unwrap()
    };
    let (stratified, kmeans) = (study(Strategy::Stratified), study(Strategy::Kmeans));
    assert_eq!(stratified.templates_covered, [(14, SEEDS)]);
    assert!(stratified.mean_radius < kmeans.mean_radius, "{stratified:?} {kmeans:?}");
    assert!(stratified.mean_embedding_radius < kmeans.mean_embedding_radius, "{stratified:?} {kmeans:?}");
    assert!(stratified.picks_in_common > kmeans.picks_in_common, "{stratified:?} {kmeans:?}");
}

#[test]
fn the_sample_is_covered_for_every_seed() {
    check_paper_file(&sample());
}

#[test]
fn nhtsas_file_is_covered_for_every_seed() {
    let Some(records) = real_file() else { return };
    check_paper_file(&records);
}
