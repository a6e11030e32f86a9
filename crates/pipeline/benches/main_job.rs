//! The main job and its parts: `cargo bench -p recrash-pipeline`. Committed runs are in `bench-runs/`.

use criterion::{Criterion, criterion_group, criterion_main};
use recrash_pipeline::{NoProgress, Options, Resources, Stage, Suite, load_profile, run_stage};
use recrash_records::{SAMPLE_CSV, SAMPLE_NAME, SourceText};
use recrash_select::SelectOptions;
use std::hint::black_box;
use std::time::Duration;

fn ingest(criterion: &mut Criterion) {
    let profile = load_profile("paper").unwrap();
    let files = [SourceText { name: SAMPLE_NAME, bytes: SAMPLE_CSV.as_bytes() }];
    criterion.bench_function("ingest the sample", |b| {
        b.iter(|| recrash_records::ingest(black_box(&files), &profile).unwrap());
    });
}

fn select(criterion: &mut Criterion) {
    let profile = load_profile("paper").unwrap();
    let files = [SourceText { name: SAMPLE_NAME, bytes: SAMPLE_CSV.as_bytes() }];
    let records = recrash_records::ingest(&files, &profile).unwrap().value;
    let options = SelectOptions::default();
    criterion.bench_function("select 20 of the sample", |b| {
        b.iter(|| recrash_select::select(black_box(&records), &profile, &options).unwrap());
    });
}

fn rollout(criterion: &mut Criterion) {
    let draft = recrash_roads::read_draft(include_str!("crossing.json")).unwrap().value;
    let scenario = recrash_roads::check(draft).unwrap().value;
    for ego in ["metadrive-idm", "idm"] {
        let ego = ego.parse().unwrap();
        criterion.bench_function(&format!("one rollout, {ego}"), |b| {
            b.iter(|| recrash_sim::simulate(black_box(&scenario), ego));
        });
    }
}

fn whole_run(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("whole run");
    group.sample_size(10).measurement_time(Duration::from_secs(30));
    group.bench_function("the sample, defaults", |b| {
        b.iter(|| {
            let folder = tempfile::tempdir().unwrap();
            let options = Options { profile: "paper".into(), ..Options::default() };
            let suite = Suite::open(folder.path(), options, Resources::default()).unwrap();
            for stage in Stage::ALL {
                run_stage(&suite, stage, &NoProgress).unwrap();
            }
        });
    });
    group.finish();
}

criterion_group!(benches, ingest, select, rollout, whole_run);
criterion_main!(benches);
