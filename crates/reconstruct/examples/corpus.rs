//! How much of a corpus is told: `cargo run --release -p recrash-reconstruct --example corpus -- FILE... [--list]`.

use rayon::prelude::*;
use recrash_model::account::{Account, told};
use recrash_model::metrics::{Answer, CheckKind, CheckResult};
use recrash_model::profile::SystemProfile;
use recrash_model::rollout::{ActorTrack, EventKind};
use recrash_model::vehicle::VehicleSpec;
use recrash_reconstruct::{Reconstruction, off_lane_s, reconstruct};
use recrash_records::{SourceText, ingest};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Rules are written looking at this half only: SHA-256 of the report id is even.
fn is_developed(account: &Account) -> bool {
    Sha256::digest(account.report.report_id.as_bytes())[31] % 2 == 0
}

/// Whether the partner, where it is a vehicle, is beside the road at some second before they touch.
fn drives_beside(made: &Reconstruction) -> bool {
    let scenario = recrash_roads::check(made.draft.clone()).expect("it ran").value;
    let vehicle = |track: &&ActorTrack| track.id == "cp" && VehicleSpec::of(track.kind).length_m > 2.5;
    let Some(track) = made.rollout.actors.iter().find(vehicle) else { return false };
    track.states.iter().take(90).step_by(10).any(|state| !scenario.network().on_road(state.position()))
}

/// Whether two others than the ego touch whom nobody had touched before, but for who throws the partner.
fn others_crash(made: &Reconstruction) -> bool {
    let mut touched = vec![false; made.rollout.actors.len()];
    let pushes = |a: usize, b: usize| [a, b].iter().any(|of| made.rollout.actors[*of].id == "pusher");
    made.rollout.events.iter().any(|event| match event.kind {
        EventKind::Contact { a, b, .. } => {
            let crash = a > 0 && !touched[a] && !touched[b] && !pushes(a, b);
            (touched[a], touched[b]) = (a > 0, true);
            crash
        }
        _ => false,
    })
}

fn main() {
    let (flags, paths): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|arg| arg.starts_with("--"));
    let bytes: Vec<Vec<u8>> = paths.iter().map(|path| std::fs::read(path).expect("a crash file")).collect();
    let sources: Vec<SourceText<'_>> =
        paths.iter().zip(&bytes).map(|(name, bytes)| SourceText { name, bytes }).collect();
    let mut profile: SystemProfile = toml::from_str(include_str!("../../../profiles/paper.toml")).expect("a profile");
    profile.records.dedupe = recrash_model::profile::Dedupe::None;
    let set = ingest(&sources, &profile).expect("crash files").value;
    let begun = std::time::Instant::now();
    let incidents = recrash_reader::incidents(&set.records);
    let accounts: Vec<Account> = incidents.par_iter().filter_map(recrash_reader::account).collect();
    let read = begun.elapsed();
    let shown: Vec<&str> = flags.iter().filter_map(|flag| flag.strip_prefix("--show=")).collect();
    let wanted = |account: &Account| shown.is_empty() || shown.contains(&account.report.report_id.as_str());
    let accounts: Vec<Account> = accounts.into_iter().filter(wanted).collect();
    let results: Vec<_> = accounts.par_iter().map(|account| (account, reconstruct(account))).collect();
    println!(
        "{} incidents, {} accounts in {read:?}, staged in {:?}",
        incidents.len(),
        accounts.len(),
        begun.elapsed() - read
    );
    let list = flags.iter().any(|flag| flag == "--list");
    let mut by_type: BTreeMap<String, [usize; 4]> = BTreeMap::new();
    let mut reasons: BTreeMap<&'static str, usize> = BTreeMap::new();
    let mut facts: BTreeMap<CheckKind, [usize; 2]> = BTreeMap::new();
    let mut left_open: BTreeMap<CheckKind, usize> = BTreeMap::new();
    for (account, result) in &results {
        let kind = told(&account.crash_type).map_or("none".to_owned(), |kind| format!("{kind:?}"));
        let row = by_type.entry(kind.clone()).or_default();
        row[0] += 1;
        match result {
            Ok(made) => {
                row[1] += 1;
                row[2] += usize::from(made.missed().is_none());
                row[3] += usize::from(made.verdict.faithful() == Answer::Yes);
                for fact in &made.verdict.checks {
                    let open = made.missed().is_none() && fact.result == CheckResult::CannotBeShown;
                    if open && flags.iter().any(|flag| flag == "--open") && is_developed(account) {
                        println!("{} {}: {} | {}", account.report, fact.kind.label(), fact.expected, fact.observed);
                    }
                    *left_open.entry(fact.kind).or_default() += usize::from(open);
                    let count = facts.entry(fact.kind).or_default();
                    count[0] += 1;
                    count[1] += usize::from(fact.result == CheckResult::Shown);
                }
                if made.missed().is_some() && list && is_developed(account) {
                    let missed: Vec<String> = made
                        .verdict
                        .failures()
                        .map(|fact| format!("{}: {}, not {}", fact.kind.label(), fact.observed, fact.expected))
                        .collect();
                    println!("{} {kind}: {}", account.report, missed.join("; "));
                }
            }
            Err(reason) => {
                *reasons.entry(reason.label()).or_default() += 1;
                if list && is_developed(account) {
                    println!("{} {kind}: {reason}", account.report);
                }
            }
        }
    }
    for wanted in &shown {
        for (account, result) in results.iter().filter(|(account, _)| account.report.report_id == *wanted) {
            if !is_developed(account) {
                continue;
            }
            let side = |party: &recrash_model::account::Party| {
                format!("{:?} {:?} {:?} {:?}", party.kind, party.state, party.movement, party.speeds)
            };
            println!("{wanted}: sv {}", side(&account.sv));
            println!("  cp {}", account.partner.as_ref().map_or_else(String::new, side));
            println!("  came {:?} place {:?}", account.came_from, account.place.kind);
            if let Ok(made) = result {
                for track in &made.rollout.actors {
                    let states: Vec<String> = track
                        .states
                        .iter()
                        .step_by(10)
                        .map(|s| format!("({:.1} {:.1} {:.0}d {:.1})", s.x, s.y, s.heading.to_degrees(), s.speed()))
                        .collect();
                    println!("  {}: {}", track.id, states.join(" "));
                }
                println!("  {:?}", made.assumed);
            }
        }
    }
    println!("type: accounts, staged, told, with every told fact shown");
    let mut sum = [0; 4];
    for row in by_type.values() {
        sum.iter_mut().zip(row).for_each(|(sum, count)| *sum += count);
    }
    for (kind, row) in by_type.iter().map(|(kind, row)| (kind.as_str(), row)).chain([("all", &sum)]) {
        let share = |count: usize| 100.0 * count as f64 / row[0] as f64;
        println!(
            "  {kind:<14} {:>5} {:>5} {:>5}  {:.1} % {:>5}  {:.1} %",
            row[0],
            row[1],
            row[2],
            share(row[2]),
            row[3],
            share(row[3])
        );
    }
    println!("not staged: {reasons:?}");
    let beside = results
        .par_iter()
        .filter(|(_, result)| result.as_ref().is_ok_and(|made| made.is_true() && drives_beside(made)));
    println!("partners of told ones that are beside the road at some second before the contact: {}", beside.count());
    let off: Vec<_> = results
        .par_iter()
        .filter_map(|(account, result)| {
            let made = result.as_ref().ok().filter(|made| made.is_true())?;
            Some((account, off_lane_s(account, made)?))
        })
        .collect();
    if flags.iter().any(|flag| flag == "--off") {
        for (account, off_s) in off.iter().filter(|(account, off_s)| *off_s > 0.0 && is_developed(account)) {
            let cp = account.partner.as_ref().and_then(|party| told(&party.movement));
            println!("{} off its lane for {off_s:.1} s: {:?} {cp:?}", account.report, told(&account.came_from));
        }
    }
    let keep = off.iter().filter(|(_, off_s)| *off_s == 0.0).count();
    println!("partners of told ones that come along lanes: {}, that keep their lane: {keep}", off.len());
    let crash = results
        .iter()
        .filter_map(|(account, result)| Some((account, result.as_ref().ok().filter(|made| others_crash(made))?)));
    let crash: Vec<bool> = crash
        .map(|(account, made)| {
            if list && is_developed(account) {
                println!("{}: others crash", account.report);
            }
            made.is_true()
        })
        .collect();
    let told_ones = crash.iter().filter(|is_true| **is_true).count();
    println!("staged ones in which two others touch: {}, {told_ones} of them told", crash.len());
    for (kind, [told, shown]) in &facts {
        let open = left_open.get(kind).copied().unwrap_or_default();
        println!("  {:<20} told {told:>5}, shown {shown:>5}, left open in a told scene {open:>3}", kind.label());
    }
}
