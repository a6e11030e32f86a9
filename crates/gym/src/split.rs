//! Which scenarios are for learning, and which are kept for the examination: crash by crash, so that nothing of a crash is in both.

use recrash_model::hash::Fnv;
use recrash_roads::Scenario;
use std::collections::BTreeMap;

/// For each scenario whether it is held out. Scenarios that share a report are of one crash; a share of the crashes, at least one
/// and not all, is held out, chosen by a hash of their reports: the order of the list does not matter, and a crash more moves few.
/// A single crash is not held out.
pub fn held_out(scenarios: &[&Scenario], share: f64) -> Vec<bool> {
    let crash_of = crashes(scenarios);
    let mut crashes: Vec<(u64, &str)> = crash_of.iter().map(|name| (hash(name), name.as_str())).collect();
    crashes.sort_unstable();
    crashes.dedup();
    let most = crashes.len().saturating_sub(1);
    let wanted =
        if share <= 0.0 { 0 } else { ((share * crashes.len() as f64).round() as usize).clamp(1.min(most), most) };
    crash_of.iter().map(|name| crashes[..wanted].contains(&(hash(name), name))).collect()
}

/// The crash of each scenario: the least name of a report among all that hang together, else the scenario's own.
fn crashes(scenarios: &[&Scenario]) -> Vec<String> {
    let reports = |scenario: &Scenario| -> Vec<String> {
        let mut names: Vec<String> =
            scenario.draft().source.records.iter().map(|record| record.report_id.clone()).collect();
        if names.is_empty() {
            names.push(format!("scenario {}", scenario.draft().id));
        }
        names
    };
    let mut crash: BTreeMap<String, String> = BTreeMap::new();
    loop {
        let mut changed = false;
        for names in scenarios.iter().map(|scenario| reports(scenario)) {
            let known = names.iter().map(|name| crash.get(name).unwrap_or(name));
            let Some(least) = known.min().cloned() else { continue };
            for name in names {
                changed |= crash.insert(name, least.clone()).as_ref() != Some(&least);
            }
        }
        if !changed {
            break;
        }
    }
    scenarios.iter().map(|scenario| crash[&reports(scenario)[0]].clone()).collect()
}

fn hash(name: &str) -> u64 {
    let mut hash = Fnv::default();
    hash.write(name.as_bytes());
    // The last bytes of a name stir the upper bits of FNV little.
    hash.finish().wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::record::RecordRef;
    use recrash_roads::{check, read_draft};

    fn scenario(id: &str, reports: &[&str]) -> Scenario {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/acts/01-lanes.json");
        let mut draft = read_draft(&std::fs::read_to_string(file).unwrap()).unwrap().value;
        draft.id = id.to_owned();
        draft.source.records =
            reports.iter().map(|name| RecordRef { report_id: (*name).to_owned(), version: 1 }).collect();
        check(draft).unwrap().value
    }

    #[test]
    fn what_shares_a_report_stays_together_in_any_order() {
        let mut all: Vec<Scenario> = (0..40).map(|n| scenario(&format!("s{n}"), &[&format!("r{n}")])).collect();
        all.push(scenario("bridge", &["r3", "r7"]));
        let forward: Vec<&Scenario> = all.iter().collect();
        let held = held_out(&forward, 0.25);
        assert_eq!((held[3], held[7]), (held[40], held[40]));
        // 39 crashes.
        let crashes = held[..40].iter().filter(|held| **held).count() - usize::from(held[3]);
        assert_eq!(crashes, 10);
        let backward: Vec<&Scenario> = all.iter().rev().collect();
        let mut held_backward = held_out(&backward, 0.25);
        held_backward.reverse();
        assert_eq!(held, held_backward);
    }

    #[test]
    fn both_sides_have_a_crash_where_there_are_two() {
        let all = [scenario("a", &[]), scenario("b", &[])];
        for share in [0.01, 0.5, 0.99] {
            assert_eq!(held_out(&[&all[0], &all[1]], share).iter().filter(|held| **held).count(), 1);
        }
        assert_eq!(held_out(&[&all[0]], 0.5), [false]);
        assert_eq!(held_out(&[&all[0], &all[1]], 0.0), [false, false]);
    }
}
