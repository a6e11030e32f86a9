//! Measures every strategy on a crash file over many seeds: the table of `docs/models/selection.md`.
//!
//!     cargo run --release -p recrash-select --example measure -- ../shared/data/nhtsa/ads-2021-06-to-2025-06.csv
//!
//! Without a file the built-in sample is measured. With a second argument the embedding, the templates and the k-means
//! clusters of each seed go to that file as JSON, for `crates/select/oracle/oracle.py`. A third argument is a profile
//! instead of the paper's.

use recrash_model::Seed;
use recrash_model::profile::SystemProfile;
use recrash_model::record::RecordSet;
use recrash_model::selection::Strategy;
use recrash_records::{SAMPLE_CSV, SAMPLE_NAME, SourceText, ingest};
use recrash_select::{Embedding, SelectError, SelectOptions, budget_table, embed_records, select_with, stability};
use std::time::Instant;

const SEEDS: usize = 50;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (name, bytes) = match arguments.first() {
        Some(path) => (path.as_str(), std::fs::read(path)?),
        None => (SAMPLE_NAME, SAMPLE_CSV.as_bytes().to_vec()),
    };
    let profile: SystemProfile = match arguments.get(2) {
        Some(path) => toml::from_str(&std::fs::read_to_string(path)?)?,
        None => toml::from_str(include_str!("../../../profiles/paper.toml"))?,
    };
    let records = ingest(&[SourceText { name, bytes: &bytes }], &profile)?.value;
    let started = Instant::now();
    let embedding = embed_records(&records);
    println!(
        "{} usable records, embedding of {} dimensions in {:?}",
        embedding.rows(),
        embedding.dimensions(),
        started.elapsed()
    );

    strategies(&records, &profile, &embedding)?;
    one_selection(&records, &profile, &embedding)?;
    budgets(&records, &profile, &embedding)?;
    if let Some(path) = arguments.get(1) {
        std::fs::write(path, dump(&records, &profile, &embedding)?.to_string())?;
    }
    Ok(())
}

/// How well each strategy covers, and how much its picks depend on the seed.
fn strategies(records: &RecordSet, profile: &SystemProfile, embedding: &Embedding) -> Result<(), SelectError> {
    println!(
        "| strategy | templates covered (seeds) | radius | mean | narrative radius | narrative mean | same picks | same clusters |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for strategy in Strategy::ALL {
        let options = SelectOptions { strategy, ..SelectOptions::default() };
        let s = stability(records, profile, &options, embedding, SEEDS)?;
        println!(
            "| {} | {:?} | {:.3} | {:.3} | {:.3} | {:.3} | {:.2} | {:.2} |",
            strategy.name(),
            s.templates_covered,
            s.mean_radius,
            s.mean_distance,
            s.mean_embedding_radius,
            s.mean_embedding_distance,
            s.picks_in_common,
            s.cluster_agreement
        );
    }
    Ok(())
}

/// What one selection covers, cluster by cluster.
fn one_selection(records: &RecordSet, profile: &SystemProfile, embedding: &Embedding) -> Result<(), SelectError> {
    let started = Instant::now();
    let selection = select_with(records, profile, &SelectOptions::default(), embedding)?.value;
    println!("\none selection in {:?}, variance kept {:.3}", started.elapsed(), selection.embedding.explained_variance);
    println!(
        "pairs {} covered / {} observed / {} possible",
        selection.coverage.pairs.covered, selection.coverage.pairs.observed, selection.coverage.pairs.possible
    );
    for cluster in &selection.clusters {
        println!("{:40} {:>3} records, radius {:.3}", cluster.scenario_id, cluster.members.len(), cluster.radius);
    }
    Ok(())
}

/// What larger budgets give.
fn budgets(records: &RecordSet, profile: &SystemProfile, embedding: &Embedding) -> Result<(), SelectError> {
    println!("\n| budget | inertia | silhouette | templates | radius | mean |\n|---|---|---|---|---|---|");
    for row in budget_table(records, profile, &SelectOptions::default(), embedding, &[5, 10, 14, 20, 30, 40, 60])? {
        let silhouette = row.silhouette.map_or("-".to_owned(), |s| format!("{s:.3}"));
        println!(
            "| {} | {:.2} | {silhouette} | {} | {:.3} | {:.3} |",
            row.budget, row.inertia, row.templates_covered, row.radius, row.mean_distance
        );
    }
    Ok(())
}

/// What scikit-learn needs to do the same, and what k-means gave here for 20 seeds.
fn dump(records: &RecordSet, profile: &SystemProfile, embedding: &Embedding) -> Result<serde_json::Value, SelectError> {
    let options = SelectOptions { strategy: Strategy::Kmeans, ..SelectOptions::default() };
    let mut inertia = Vec::new();
    let mut labels: Vec<Vec<usize>> = Vec::new();
    let mut explained_variance = 0.0;
    for seed in 0..20 {
        let options = SelectOptions { seed: Seed(seed), ..options.clone() };
        let selection = select_with(records, profile, &options, embedding)?.value;
        inertia.push(selection.inertia);
        labels.push(selection.map.iter().map(|point| point.cluster).collect());
        explained_variance = selection.embedding.explained_variance;
    }
    let templates: Vec<String> =
        records.usable.iter().filter_map(|&i| Some(records.records[i].template()?.slug())).collect();
    let rows: Vec<&[f64]> = (0..embedding.rows()).map(|i| embedding.row(i)).collect();
    Ok(serde_json::json!({
        "rows": rows, "templates": templates, "budget": options.budget, "dimensions": options.dimensions,
        "restarts": options.restarts, "inertia": inertia, "labels": labels, "explained_variance": explained_variance,
    }))
}
