//! The rules on NHTSA's file, on the half of it they may be developed on (`docs/models/rules.md`).

use crate::support;

use recrash_agents::{Design, Feedback, Paraphrase, Problem, Rules, expectation};
use recrash_metrics::{faithfulness, measure};
use recrash_model::metrics::Check;
use recrash_model::narrative::FactSource;
use recrash_model::profile::SystemProfile;
use recrash_model::record::CrashRecord;
use recrash_records::{SourceText, ingest};
use recrash_sim::{Ego, simulate};
use sha2::{Digest, Sha256};

const FILE: &str = "ads-2021-06-to-2025-06.csv";

/// Usable records of the developed half; `None` where the file is not there.
fn records() -> Option<Vec<CrashRecord>> {
    let path = recrash_testing::shared(&format!("data/nhtsa/{FILE}"))?;
    let bytes = std::fs::read(path).expect("a readable file");
    let set = ingest(&[SourceText { name: FILE, bytes: &bytes }], &support::paper()).expect("NHTSA's file").value;
    let developed = |record: &&CrashRecord| {
        let hash = Sha256::digest(record.id.report_id.as_bytes());
        hash.last().is_some_and(|byte| byte % 2 == 0)
    };
    Some(set.usable.iter().map(|&n| &set.records[n]).filter(developed).cloned().collect())
}

fn becomes_faithful(record: &CrashRecord, profile: &SystemProfile) -> bool {
    let records = [record];
    let brief = support::brief("01-test", &records, profile, 7);
    let narrative = Rules.paraphrase(&brief).expect("a narrative").value;
    let expected = expectation(&narrative, record, profile);
    let mut feedback = Vec::new();
    for _ in 0..6 {
        let draft = Rules.design(&brief, &narrative, &feedback).expect("a design");
        let scenario = match recrash_roads::check(draft.clone()) {
            Ok(checked) => checked.value,
            Err(diagnostics) => {
                feedback.push(Feedback { draft, problem: Problem::NotRunnable { diagnostics } });
                continue;
            }
        };
        let rollout = simulate(&scenario, Ego::MetadriveIdm);
        let metrics = measure(&scenario, &rollout, &profile.failure);
        let verdict = faithfulness(&scenario, &rollout, &metrics, &expected);
        let failures: Vec<Check> = verdict.failures().cloned().collect();
        if failures.is_empty() {
            return true;
        }
        feedback.push(Feedback { draft, problem: Problem::NotFaithful { failures, metrics: Box::new(metrics) } });
    }
    false
}

#[test]
fn quoted_words_of_real_narratives_stand_in_them() {
    let Some(records) = records() else { return };
    let profile = support::paper();
    assert_eq!(records.len(), 120);
    for record in &records {
        for fact in support::narrate(record, &profile).value.facts {
            if let FactSource::Words { words, .. } = fact.source {
                assert!(record.narrative.contains(&words), "{}", record.id);
            }
        }
    }
}

/// Told speeds bind as they are told, also where a turn cannot be driven as fast: suites leave such records to others.
#[test]
fn fourteen_of_fifteen_real_records_become_faithful_scenarios() {
    let Some(records) = records() else { return };
    let profile = support::paper();
    let some: Vec<&CrashRecord> = records.iter().step_by(2).collect();
    let faithful = some.iter().filter(|record| becomes_faithful(record, &profile)).count();
    assert!(faithful * 15 >= some.len() * 14, "{faithful} of {}", some.len());
}
