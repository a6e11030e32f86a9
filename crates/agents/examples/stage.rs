//! Runs paraphrase, design, check, simulation and the faithfulness check on records of a crash file, a few of each
//! template, and prints what came of it: for those who work on the rules.
//!
//! `cargo run -p recrash-agents --example stage [FILE.csv|sample] [PER-TEMPLATE] [EGO] [trace]`

use recrash_agents::{Brief, Design, Feedback, Paraphrase, Problem, Rules, expectation, parameters};
use recrash_metrics::{faithfulness, measure};
use recrash_model::Seed;
use recrash_model::metrics::Check;
use recrash_model::profile::SystemProfile;
use recrash_model::record::CrashRecord;
use recrash_model::template::Template;
use recrash_records::{SAMPLE_CSV, SAMPLE_NAME, SourceText, ingest};
use recrash_sim::{Ego, simulate};
use std::collections::BTreeMap;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().filter(|file| file != "sample");
    let per_template: usize = arguments.next().map_or(Ok(2), |n| n.parse())?;
    let ego: Ego = arguments.next().map_or(Ok(Ego::MetadriveIdm), |name| name.parse())?;
    let trace = arguments.next().is_some();
    let profile: SystemProfile = toml::from_str(include_str!("../../../profiles/paper.toml"))?;
    let bytes = match &file {
        Some(path) => std::fs::read(path)?,
        None => SAMPLE_CSV.as_bytes().to_vec(),
    };
    let source = SourceText { name: file.as_deref().unwrap_or(SAMPLE_NAME), bytes: &bytes };
    let set = ingest(&[source], &profile)?.value;
    let mut by_template: BTreeMap<Template, Vec<&CrashRecord>> = BTreeMap::new();
    for &position in &set.usable {
        let record = &set.records[position];
        if let Some(template) = record.template() {
            by_template.entry(template).or_default().push(record);
        }
    }
    let (mut all, mut faithful, mut first, mut touched, mut close) = (0, 0, 0, 0, 0);
    for (template, records) in by_template {
        let step = (records.len() / per_template.max(1)).max(1);
        for (number, position) in (0..records.len()).step_by(step).take(per_template).enumerate() {
            let mut cluster = vec![records[position]];
            cluster.extend(records.iter().filter(|r| r.id != records[position].id).take(8));
            let id = format!("{number:02}-{}", template.slug());
            let brief = Brief { scenario_id: &id, template, records: &cluster, profile: &profile, seed: Seed(7) };
            let narrative = Rules.paraphrase(&brief)?.value;
            println!("== {id} {} {}", records[position].id, narrative.text);
            if let recrash_model::narrative::Origin::Alternative { reason } = &narrative.origin {
                println!("   alternative: {reason}");
            }
            let expectation = expectation(&narrative, records[position], &profile);
            let mut feedback = Vec::new();
            let mut good = false;
            for attempt in 0..6 {
                let draft = Rules.design(&brief, &narrative, &feedback)?;
                let partner = &draft.partners[0];
                print!(
                    "   [{attempt}] {} lanes {} ego {:?} lane {} s {} v {:.1} | cp {:?} {:?} off {} {:?} v {:.1}/{:.1} {:?}",
                    draft.map.letter(),
                    draft.map.carriageway().lanes,
                    draft.ego.turn,
                    draft.ego.lane,
                    draft.ego.s_m,
                    draft.ego.target_speed_mps,
                    partner.approach,
                    partner.turn,
                    partner.lane_offset,
                    partner.start,
                    partner.speed_mps,
                    partner.policy.target_speed(),
                    partner.lateral,
                );
                println!();
                let scenario = match recrash_roads::check(draft.clone()) {
                    Ok(checked) => {
                        for remark in &checked.diagnostics {
                            println!("       remark {remark}");
                        }
                        checked.value
                    }
                    Err(diagnostics) => {
                        for remark in &diagnostics {
                            println!("       NOT RUNNABLE {remark}");
                        }
                        feedback.push(Feedback { draft, problem: Problem::NotRunnable { diagnostics } });
                        continue;
                    }
                };
                let rollout = simulate(&scenario, ego);
                let metrics = measure(&scenario, &rollout, &profile.failure);
                let verdict = faithfulness(&scenario, &rollout, &metrics, &expectation);
                println!(
                    "       end {:?} at {:.1} s, gap {:?}, contact {:?}, parameters {}",
                    rollout.termination.kind,
                    rollout.termination.time_s,
                    metrics.min_gap,
                    metrics.contact.as_ref().map(|c| (c.time_s, c.ego_zone, c.other_zone, c.kind)),
                    parameters(&draft, &narrative, &profile).len(),
                );
                if trace {
                    for step in (0..rollout.steps()).step_by(5) {
                        let (ego, cp) = (rollout.actors[0].states[step], rollout.actors[1].states[step]);
                        println!(
                            "       {:5.1} ego {:7.2} {:7.2} {:5.0} {:5.1}   cp {:7.2} {:7.2} {:5.0} {:5.1}",
                            step as f64 * 0.1,
                            ego.x,
                            ego.y,
                            ego.heading.to_degrees(),
                            ego.speed,
                            cp.x,
                            cp.y,
                            cp.heading.to_degrees(),
                            cp.speed
                        );
                    }
                }
                let failures: Vec<Check> = verdict.failures().cloned().collect();
                for check in &failures {
                    println!(
                        "       FAILED {:?}: expected {}, observed {}",
                        check.kind, check.expected, check.observed
                    );
                }
                if attempt == 0 {
                    all += 1;
                    first += usize::from(failures.is_empty());
                    touched += usize::from(metrics.contact.is_some());
                    close += usize::from(metrics.min_gap.is_some_and(|gap| gap.value < 8.0));
                }
                if failures.is_empty() {
                    good = true;
                    break;
                }
                feedback
                    .push(Feedback { draft, problem: Problem::NotFaithful { failures, metrics: Box::new(metrics) } });
            }
            faithful += usize::from(good);
        }
    }
    println!(
        "{all} scenarios: {first} faithful at the first shot, {faithful} in the end; first shots: {touched} touch, {close} closer than 8 m"
    );
    Ok(())
}
