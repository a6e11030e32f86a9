//! What a selection promises, on records made by hand.

use crate::common::{crossing, on_a_line, paper, record_set};
use recrash_model::record::{Coded, RecordSet, Severity};
use recrash_model::selection::{Selection, Strategy, Weighting};
use recrash_model::template::{Movement, Template};
use recrash_model::{Diagnostic, Seed};
use recrash_select::{
    Embedding, SelectError, SelectOptions, budget_table, select, select_onward, select_with, stability,
};

const STRAIGHT: Movement = Movement::Straight;
const LEFT: Movement = Movement::LeftTurn;
const RIGHT: Movement = Movement::RightTurn;

fn options(strategy: Strategy, budget: usize) -> SelectOptions {
    SelectOptions { strategy, budget, ..SelectOptions::default() }
}

fn choose(records: &[(Template, f32)], options: &SelectOptions) -> (Selection, Vec<Diagnostic>) {
    let (set, rows) = on_a_line(records);
    let embedding = Embedding::new("line", &rows).unwrap();
    let outcome = select_with(&set, &paper(), options, &embedding).unwrap();
    check_invariants(&set, &outcome.value);
    (outcome.value, outcome.diagnostics)
}

/// True of every selection.
fn check_invariants(set: &RecordSet, selection: &Selection) {
    let mut members: Vec<usize> = selection.clusters.iter().flat_map(|c| c.members.iter().copied()).collect();
    members.sort_unstable();
    assert_eq!(members, set.usable, "every usable record is in one cluster");
    for (i, cluster) in selection.clusters.iter().enumerate() {
        assert_eq!(cluster.number, i + 1);
        assert_eq!(cluster.members[0], cluster.pick_index);
        assert_eq!(cluster.pick, set.records[cluster.pick_index].id);
        assert_eq!(Some(cluster.template), set.records[cluster.pick_index].template());
        assert_eq!(cluster.scenario_id, format!("{}-{}", cluster.template.slug(), cluster.pick.report_id));
    }
    assert_eq!(selection.map.iter().map(|p| p.record).collect::<Vec<_>>(), set.usable);
    for point in &selection.map {
        assert!(selection.clusters[point.cluster].members.contains(&point.record));
    }
    let c = &selection.coverage;
    assert_eq!(c.templates_covered + c.holes_observed.len(), c.templates_observed);
    assert_eq!(c.templates_observed + c.holes_possible.len(), c.templates_possible);
    assert_eq!(c.pairs.covered + c.pairs.holes_observed.len(), c.pairs.observed);
    assert_eq!(c.pairs.observed + c.pairs.holes_possible.len(), c.pairs.possible);
    assert_eq!(selection.templates.iter().map(|t| t.picks).sum::<usize>(), selection.clusters.len());
    assert!(c.mean_distance <= c.radius);
}

fn heaps() -> Vec<(Template, f32)> {
    let (a, b, c) = (crossing(STRAIGHT, STRAIGHT), crossing(STRAIGHT, LEFT), crossing(LEFT, RIGHT));
    vec![(b, 0.0), (a, 0.0), (a, 0.1), (a, 0.2), (a, 0.9), (a, 1.0), (b, 0.3), (c, 0.5), (a, 1.2)]
}

#[test]
fn stratified_gives_each_template_one_and_the_frequent_one_the_rest() {
    let (selection, diagnostics) = choose(&heaps(), &options(Strategy::Stratified, 4));
    // a: {0, 0.1, 0.2} with centre 0.1 and {0.9, 1, 1.2} with centre 1.033; b: centre 0.15, equally far, first by position.
    let templates: Vec<String> = selection.clusters.iter().map(|c| c.template.slug()).collect();
    assert_eq!(
        templates,
        [
            "intersection-straight-straight",
            "intersection-straight-straight",
            "intersection-straight-left",
            "intersection-left-right",
        ]
    );
    let picks: Vec<usize> = selection.clusters.iter().map(|c| c.pick_index).collect();
    assert_eq!(picks, [2, 5, 0, 7]);
    assert_eq!(selection.clusters[0].members, [2, 1, 3]);
    assert_eq!(selection.clusters[1].members, [5, 4, 8]);
    assert!((selection.clusters[1].radius - 0.2).abs() < 1e-6);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    let c = &selection.coverage;
    assert_eq!((c.templates_observed, c.templates_covered, c.records_covered, c.records), (3, 3, 9, 9));
    // Farthest from its pick: 0.3 of b, from 0.
    assert!((c.radius - 0.3).abs() < 1e-6);
    // Distances 0, 0, 0.1, 0, 0.1, 0.1, 0, 0.3, 0, 0.2 over nine records.
    assert!((c.mean_distance - 0.8 / 9.0).abs() < 1e-6);
    assert!((c.embedding_radius - 0.3).abs() < 1e-6);
}

#[test]
fn the_second_further_pick_goes_to_the_worst_served_record() {
    // Three of a (0, 0.1, 0.2), two of b far apart: after one pick each, frequency gives a the first, distance b the second.
    let (a, b) = (crossing(STRAIGHT, STRAIGHT), crossing(STRAIGHT, LEFT));
    let records = [(a, 0.0), (a, 0.1), (a, 0.2), (a, 0.3), (b, 0.0), (b, 0.9)];
    let picks = |budget| -> Vec<usize> {
        choose(&records, &options(Strategy::Stratified, budget)).0.templates.iter().map(|t| t.picks).collect()
    };
    assert_eq!(picks(3), [2, 1]);
    assert_eq!(picks(4), [2, 2]);
}

#[test]
fn a_short_budget_goes_to_the_most_frequent_and_the_rest_are_holes() {
    let (selection, diagnostics) = choose(&heaps(), &options(Strategy::Stratified, 2));
    assert_eq!(selection.coverage.holes_observed, [crossing(LEFT, RIGHT)]);
    assert_eq!(selection.coverage.templates_covered, 2);
    assert_eq!(selection.coverage.records_covered, 8);
    assert_eq!(diagnostics[0].code, "select.templates-without-pick");
    assert!(diagnostics[0].hint.contains("budget of 3"));
}

#[test]
fn a_greater_budget_takes_no_template_away() {
    let records = heaps();
    let mut before = vec![0; 3];
    for budget in 1..=9 {
        let (selection, _) = choose(&records, &options(Strategy::Stratified, budget));
        let picks: Vec<usize> = selection.templates.iter().map(|t| t.picks).collect();
        assert!(picks.iter().zip(&before).all(|(now, before)| now >= before), "{before:?} -> {picks:?}");
        assert_eq!(picks.iter().sum::<usize>(), budget);
        before = picks;
    }
}

#[test]
fn every_strategy_keeps_the_promises_and_serves_all_when_the_budget_allows() {
    for strategy in Strategy::ALL {
        for budget in [1, 2, 5, 9] {
            let (selection, _) = choose(&heaps(), &options(strategy, budget));
            assert_eq!(selection.clusters.len(), budget, "{}", strategy.name());
        }
        let (all, _) = choose(&heaps(), &options(strategy, 9));
        assert_eq!((all.coverage.radius, all.inertia), (0.0, 0.0), "{}", strategy.name());
    }
}

#[test]
fn fewer_different_records_than_the_budget_give_fewer_picks_and_a_warning() {
    let a = crossing(STRAIGHT, STRAIGHT);
    for strategy in Strategy::ALL {
        let (selection, diagnostics) = choose(&[(a, 0.5), (a, 0.5), (a, 0.7)], &options(strategy, 20));
        assert_eq!(selection.clusters.len(), 2);
        assert_eq!(diagnostics.iter().map(|d| d.code.as_str()).collect::<Vec<_>>(), ["select.fewer-picks"]);
    }
}

#[test]
fn one_record_is_its_own_suite() {
    let set = record_set(&[(crossing(STRAIGHT, LEFT), "The partner turned left.")]);
    let outcome = select(&set, &paper(), &SelectOptions::default()).unwrap();
    check_invariants(&set, &outcome.value);
    assert!(outcome.value.clusters[0].scenario_id.starts_with("intersection-straight-left-"));
}

#[test]
fn work_zones_show_in_the_id() {
    let template = Template { work_zone: true, ..crossing(STRAIGHT, LEFT) };
    let (selection, _) = choose(&[(template, 0.0)], &options(Strategy::Kmeans, 1));
    assert!(selection.clusters[0].scenario_id.starts_with("intersection-straight-left-wz-"));
    assert_eq!(selection.tables.work_zone, 1);
}

#[test]
fn template_weight_decides_between_template_and_narrative() {
    // Two heaps by narrative, 0 and 1, and two by template, crosswise.
    let (a, b) = (crossing(STRAIGHT, STRAIGHT), crossing(STRAIGHT, LEFT));
    let records = [(a, 0.0), (a, 0.0), (a, 1.0), (b, 1.0), (b, 1.0), (b, 0.0)];
    let together = |template_weight: f64| {
        let options = SelectOptions { template_weight, ..options(Strategy::Kmeans, 2) };
        let (selection, _) = choose(&records, &options);
        let of = |record: usize| selection.map[record].cluster;
        (of(0) == of(2), of(0) == of(5))
    };
    assert_eq!(together(5.0), (true, false));
    assert_eq!(together(0.1), (false, true));
}

#[test]
fn weighting_decides_who_gets_more() {
    let (a, b) = (crossing(STRAIGHT, STRAIGHT), crossing(STRAIGHT, LEFT));
    let records = [(a, 0.0), (a, 0.2), (a, 0.4), (a, 0.6), (b, 0.0), (b, 0.2)];
    let (mut set, rows) = on_a_line(&records);
    set.records[4].severity = Coded::Known(Severity::Fatality);
    let embedding = Embedding::new("line", &rows).unwrap();
    let picks = |weighting| -> Vec<usize> {
        let options = SelectOptions { weighting, ..options(Strategy::Stratified, 3) };
        let selection = select_with(&set, &paper(), &options, &embedding).unwrap().value;
        selection.templates.iter().map(|t| t.picks).collect()
    };
    assert_eq!(picks(Weighting::Frequency), [2, 1]);
    // 16 + 1 against 4.
    assert_eq!(picks(Weighting::Severity), [1, 2]);
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let narratives = ["left turn across", "ran the light", "cut in", "mirror touched", "fell", "left across"];
    let templates = [crossing(STRAIGHT, STRAIGHT), crossing(STRAIGHT, LEFT)];
    let records: Vec<(Template, &str)> = (0..24).map(|i| (templates[i % 2], narratives[i % 6])).collect();
    let set = record_set(&records);
    for strategy in Strategy::ALL {
        let options = SelectOptions { seed: Seed(42), ..options(strategy, 5) };
        let once = serde_json::to_string(&select(&set, &paper(), &options).unwrap()).unwrap();
        assert_eq!(once, serde_json::to_string(&select(&set, &paper(), &options).unwrap()).unwrap());
    }
}

#[test]
fn nothing_to_choose_from_is_an_error_with_a_hint() {
    let error = select(&record_set(&[]), &paper(), &SelectOptions::default()).unwrap_err();
    assert_eq!(error, SelectError::NoUsableRecords);
    assert!(error.to_string().contains("recrash records"));
}

#[test]
fn records_the_profile_cannot_express_are_left_out_aloud() {
    let uturn = crossing(Movement::UTurn, STRAIGHT);
    let (set, rows) = on_a_line(&[(uturn, 0.0), (crossing(STRAIGHT, STRAIGHT), 1.0)]);
    let embedding = Embedding::new("line", &rows).unwrap();
    let outcome = select_with(&set, &paper(), &options(Strategy::Stratified, 1), &embedding).unwrap();
    assert_eq!(outcome.value.coverage.records, 1);
    assert_eq!(outcome.diagnostics[0].code, "select.not-expressible");
    assert!(outcome.diagnostics[0].message.contains("T-0/1"));
}

#[test]
fn what_does_not_fit_is_refused() {
    let (set, rows) = on_a_line(&heaps());
    let fitting = Embedding::new("line", &rows).unwrap();
    let short = Embedding::new("line", &rows[1..]).unwrap();
    let run = |set: &RecordSet, options: &SelectOptions, embedding: &Embedding| {
        select_with(set, &paper(), options, embedding).unwrap_err()
    };
    let good = SelectOptions::default();
    assert_eq!(run(&set, &good, &short), SelectError::EmbeddingRows { expected: 9, found: 8 });
    for bad in [
        SelectOptions { budget: 0, ..good.clone() },
        SelectOptions { dimensions: 0, ..good.clone() },
        SelectOptions { restarts: 0, ..good.clone() },
        SelectOptions { template_weight: f64::NAN, ..good.clone() },
        SelectOptions { template_weight: -1.0, ..good.clone() },
    ] {
        assert!(matches!(run(&set, &bad, &fitting), SelectError::BadOption { .. }));
    }
    for usable in [vec![0, 99], vec![0, 0]] {
        let damaged = RecordSet { usable, ..set.clone() };
        let embedding = Embedding::new("line", &rows[..2]).unwrap();
        assert!(matches!(run(&damaged, &good, &embedding), SelectError::DamagedRecordSet { entry: 1, .. }));
        assert!(select(&damaged, &paper(), &good).is_err());
    }
}

#[test]
fn studies_agree_with_the_selection_they_repeat() {
    let (set, rows) = on_a_line(&heaps());
    let embedding = Embedding::new("line", &rows).unwrap();
    let options = options(Strategy::KCenter, 4);
    let selection = select_with(&set, &paper(), &options, &embedding).unwrap().value;
    let table = budget_table(&set, &paper(), &options, &embedding, &[4, 9]).unwrap();
    assert_eq!((table[0].inertia, table[0].radius), (selection.inertia, selection.coverage.radius));
    assert!(table[0].silhouette.is_some() && table[1].silhouette.is_none());
    // k-center uses no seed: all runs are the same.
    let stability = stability(&set, &paper(), &options, &embedding, 3).unwrap();
    assert_eq!((stability.picks_in_common, stability.cluster_agreement), (1.0, 1.0));
    assert_eq!(stability.templates_covered, [(selection.coverage.templates_covered, 3)]);
    assert_eq!(stability.mean_radius, selection.coverage.radius);
}

#[test]
fn picks_are_records_whose_crash_is_told() {
    let (a, b) = (crossing(STRAIGHT, STRAIGHT), crossing(STRAIGHT, LEFT));
    let (mut set, rows) = on_a_line(&[(a, 0.0), (a, 0.1), (a, 0.25), (a, 0.9), (a, 1.0), (a, 1.1), (b, 0.0), (b, 0.1)]);
    let embedding = Embedding::new("line", &rows).unwrap();
    let mut choose = |untold: &[usize], strategy| {
        set.untold = untold.iter().map(|&at| (at, "it cannot be told".to_owned())).collect();
        let outcome = select_with(&set, &paper(), &options(strategy, 3), &embedding).unwrap();
        check_invariants(&set, &outcome.value);
        let picks: Vec<usize> = outcome.value.clusters.iter().map(|cluster| cluster.pick_index).collect();
        let covered = outcome.value.coverage.templates_covered;
        let codes: Vec<String> = outcome.diagnostics.iter().map(|remark| remark.code.to_string()).collect();
        (picks, covered, codes)
    };
    assert_eq!(choose(&[], Strategy::Stratified).0, [1, 4, 6]);
    // The nearest to the centre that is told.
    assert_eq!(choose(&[1, 6], Strategy::Stratified).0, [0, 4, 7]);
    // A group without one takes of the others of its template.
    assert_eq!(choose(&[3, 4, 5], Strategy::Stratified).0, [1, 2, 6]);
    // A template gets no more picks than it has records that are told, but one; that one covers nothing.
    let (picks, covered, codes) = choose(&[0, 1, 2, 3, 4, 5], Strategy::Stratified);
    assert_eq!((picks.len(), covered), (3, 1));
    assert!(codes.contains(&"select.templates-invented".to_owned()), "{codes:?}");
    for strategy in Strategy::ALL {
        let (picks, ..) = choose(&[0, 2, 3, 5, 6], strategy);
        assert!(picks.iter().all(|pick| [1, 4, 7].contains(pick)), "{strategy:?}: {picks:?}");
    }
}

#[test]
fn picks_of_the_last_choice_stay_when_records_come_in_and_new_templates_without_one_are_named() {
    let (a, b, c) = (crossing(STRAIGHT, STRAIGHT), crossing(STRAIGHT, LEFT), crossing(LEFT, STRAIGHT));
    let (set, rows) = on_a_line(&[(a, 0.0), (a, 0.1), (b, 0.5), (c, 0.2), (a, 0.05)]);
    let embedding = Embedding::new("line", &rows).unwrap();
    let go_on = |earlier: &[Vec<usize>], budget| {
        let outcome =
            select_onward(&set, &paper(), &options(Strategy::Stratified, budget), &embedding, earlier).unwrap();
        check_invariants(&set, &outcome.value);
        let picks: Vec<usize> = outcome.value.clusters.iter().map(|cluster| cluster.pick_index).collect();
        let is_new = |remark: &&Diagnostic| remark.code == "select.new-without-pick";
        (picks, outcome.diagnostics.iter().find(is_new).map(|remark| remark.message.clone()))
    };
    let said = |words: &str| Some(format!("{words} no pick, as those of the last choice stay"));
    // Records 3 and 4 came in, and with them the template of 3.
    assert_eq!(go_on(&[vec![1, 0], vec![2]], 2), (vec![1, 2], said("1 new template has")));
    assert_eq!(go_on(&[vec![1, 0]], 1), (vec![1], said("2 new templates have")));
    // Where there is room it gets a pick.
    assert_eq!(go_on(&[vec![1, 0], vec![2]], 3), (vec![1, 2, 3], None));
    // A template that had no pick before is no news.
    assert_eq!(go_on(&[vec![1, 0, 2, 3]], 1), (vec![1], None));
    // A pick that is gone makes room for one of its template; the others stay.
    assert_eq!(go_on(&[vec![usize::MAX, 0], vec![2], vec![3]], 3), (vec![0, 2, 3], None));
    // None of them is left: chosen anew.
    assert_eq!(go_on(&[vec![usize::MAX, 0]], 3), go_on(&[], 3));
}
