//! Speed of ingest in bytes of CSV a second, on the built-in sample told over and over with other report ids.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_records::{SAMPLE_CSV, SourceText, ingest};

/// Copies of the sample; 26 make 10 MB.
const COPIES: usize = 26;

fn many_reports() -> String {
    let (header, rows) = SAMPLE_CSV.split_once('\n').expect("the sample has a header");
    let mut text = format!("{header}\n");
    for copy in 0..COPIES {
        text.push_str(&rows.replace("\n9010", &format!("\n9{copy:02}0")));
    }
    text
}

fn profile(dedupe: Dedupe) -> SystemProfile {
    let mut profile: SystemProfile =
        toml::from_str(include_str!("../../../profiles/paper.toml")).expect("profiles/paper.toml is a profile");
    profile.records.dedupe = dedupe;
    profile
}

fn bench(c: &mut Criterion) {
    let text = many_reports();
    let mut group = c.benchmark_group("ingest");
    group.throughput(Throughput::Bytes(text.len() as u64)).sample_size(20);
    for (name, dedupe) in [("every row", Dedupe::None), ("one an incident", Dedupe::Incident)] {
        let profile = profile(dedupe);
        let files = [SourceText { name: "many.csv", bytes: text.as_bytes() }];
        group.bench_function(name, |b| b.iter(|| ingest(&files, &profile)));
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
