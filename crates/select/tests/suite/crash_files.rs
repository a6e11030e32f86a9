//! Selection on whole crash files: the built-in sample, and NHTSA's own where it is at hand.

use crate::common::{paper, real_file, sample};
use recrash_model::Seed;
use recrash_model::record::RecordSet;
use recrash_model::selection::Strategy;
use recrash_model::template::{Movement, RoadType};
use recrash_select::{SelectOptions, embed_records, select, stability};

const SEEDS: usize = 50;

/// What the tables of a file say.
struct Wanted {
    records: usize,
    /// Intersection, highway, traffic circle.
    roads: [usize; 3],
    /// A row a movement of the partner: straight, left, right; a column a movement of the subject vehicle.
    movements: [[usize; 3]; 3],
    largest_template: usize,
    work_zone: usize,
}

/// The tables of a file in which every template of the paper is, and the promise of the default strategy.
fn check_paper_file(records: &RecordSet, wanted: &Wanted) {
    let selection = select(records, &paper(), &SelectOptions { seed: Seed(7), ..SelectOptions::default() }).unwrap();
    assert!(selection.diagnostics.is_empty(), "{:?}", selection.diagnostics);
    let selection = selection.value;
    let tables = &selection.tables;
    let roads = [RoadType::Intersection, RoadType::Highway, RoadType::TrafficCircle];
    let counts: Vec<(RoadType, usize)> = roads.into_iter().zip(wanted.roads).collect();
    assert_eq!(tables.road_types, counts);
    assert_eq!(tables.sv_movements, Movement::PAPER);
    for ((cp, row), (movement, wanted)) in
        tables.movements.iter().zip(Movement::PAPER.into_iter().zip(wanted.movements))
    {
        assert_eq!((*cp, row.as_slice()), (movement, wanted.as_slice()));
    }
    assert_eq!((tables.largest_template, tables.work_zone), (wanted.largest_template, wanted.work_zone));
    assert_eq!((selection.templates.len(), selection.templates[0].records), (14, wanted.largest_template));
    assert_eq!((selection.coverage.templates_possible, selection.coverage.records), (54, wanted.records));
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
    let wanted = Wanted {
        records: 88,
        roads: [72, 14, 2],
        movements: [[42, 9, 7], [12, 8, 1], [4, 1, 4]],
        largest_template: 31,
        work_zone: 5,
    };
    check_paper_file(&sample(), &wanted);
}

#[test]
fn nhtsas_file_is_covered_for_every_seed() {
    let Some(records) = real_file() else { return };
    let wanted = Wanted {
        records: 235,
        roads: [214, 20, 1],
        movements: [[120, 26, 16], [36, 9, 1], [9, 4, 14]],
        largest_template: 104,
        work_zone: 9,
    };
    check_paper_file(&records, &wanted);
}
