//! The reader on the built-in sample: it finds what the stories of the generator mean.

#[path = "../../../records/examples/make_sample/generator/mod.rs"]
mod generator;

use generator::Meant;
use recrash_model::account::{Account, Fact};
use recrash_model::profile::SystemProfile;
use recrash_reader::{account, incidents};
use recrash_records::{SAMPLE_NAME, SourceText, ingest};
use std::collections::BTreeMap;

/// Least share of the stories in which a fact is as meant. The reader is not made to fit the sample.
const LEAST_SHARE: f64 = 0.95;

fn said<T: Copy>(fact: &Option<Fact<T>>) -> Option<T> {
    fact.as_ref().map(|fact| fact.value)
}

#[test]
fn the_sample_is_read_as_its_stories_mean_it() {
    let sample = generator::sample();
    let file = SourceText { name: SAMPLE_NAME, bytes: sample.csv.as_bytes() };
    let open: SystemProfile = toml::from_str(include_str!("../../../../profiles/open.toml")).unwrap();
    let records = ingest(&[file], &open).unwrap().value.records;
    let accounts: BTreeMap<String, Account> =
        incidents(&records).iter().filter_map(|incident| Some((incident.id.clone(), account(incident)?))).collect();
    let mut wrong: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for Meant { incident, kind, state, movement } in &sample.meant {
        let found = accounts.get(incident).unwrap_or_else(|| panic!("{incident} is not read"));
        let facts = [
            ("crash type", said(&found.crash_type) == Some(*kind)),
            ("state", said(&found.sv.state) == Some(*state)),
            ("movement", said(&found.sv.movement) == Some(*movement)),
        ];
        for (fact, _) in facts.into_iter().filter(|(_, as_meant)| !as_meant) {
            wrong.entry(fact).or_default().push(format!("{} ({kind:?}, {state:?}, {movement:?})", found.report));
        }
    }
    for (fact, reports) in &wrong {
        let right = 1.0 - reports.len() as f64 / sample.meant.len() as f64;
        assert!(right >= LEAST_SHARE, "{fact}: {right:.3} right; not {}", reports.join(", "));
    }
}
