//! All ways of touching, the best first.

use crate::ground::drawn::ground_for;
use crate::told::crash::Told;
use crate::touch::bodies::Bodies;
use crate::touch::staging::Staging;
use crate::touch::sweep::BENT;
use crate::touch::{doors, roadside};
use recrash_model::math;
use std::rc::Rc;
use std::vec;

/// So many ways of touching are tried of one telling, where none of the first of all shows every told fact.
pub(crate) const MOST_TRIES: usize = 400;

/// Ways of touching, the best first, of which no two are almost the same. They are looked for as they are asked for: tens of thousands may be
/// found, and one of the first is mostly taken.
pub(crate) struct Stagings<'a> {
    /// In the order of trial; nothing where all are found.
    trials: Option<Box<dyn Iterator<Item = Staging> + 'a>>,
    /// Those that were found and wait for the last trial.
    wait: Vec<Staging>,
    /// The same in their order, once that is over.
    sorted: vec::IntoIter<Staging>,
    /// What was asked for.
    kept: Vec<Staging>,
}

impl<'a> Stagings<'a> {
    pub(crate) fn of(told: &'a Told) -> Self {
        Self { trials: Some(trials(told)), wait: Vec::new(), sorted: Vec::new().into_iter(), kept: Vec::new() }
    }

    /// The one with this number; nothing where there are not so many.
    pub(crate) fn get(&mut self, number: usize) -> Option<&Staging> {
        while self.kept.len() <= number {
            let next = self.next_best()?;
            if !self.kept.iter().any(|kept| is_like(kept, &next)) {
                self.kept.push(next);
            }
        }
        self.kept.get(number)
    }

    /// The next best. What fits as told, without a bend, comes in the order of trial: nothing that is found later comes before it.
    fn next_best(&mut self) -> Option<Staging> {
        if let Some(trials) = &mut self.trials {
            for staging in trials {
                if staging.cost.0 == 0 && staging.cost.1 < BENT {
                    return Some(staging);
                }
                self.wait.push(staging);
            }
            self.trials = None;
            self.wait.sort_by_cached_key(|staging| staging.cost);
            self.sorted = std::mem::take(&mut self.wait).into_iter();
        }
        self.sorted.next()
    }
}

/// All that is found, in the order of trial.
fn trials(told: &Told) -> Box<dyn Iterator<Item = Staging> + '_> {
    let ground = Rc::new(ground_for(told));
    let by_part = told.door.is_some() || told.gate_swings;
    match told.edge {
        _ if by_part => Box::new(doors::stagings(told, &ground).into_iter()),
        Some(side) => Box::new(roadside::stagings(told, &ground, side).into_iter()),
        None => Box::new(Bodies::of(told, ground).flatten()),
    }
}

/// Whether two ways of touching are almost the same.
fn is_like(kept: &Staging, staging: &Staging) -> bool {
    kept.bend.is_some() == staging.bend.is_some()
        && (kept.sv_s_m - staging.sv_s_m).abs() < 0.5
        && kept.cp.position.distance(staging.cp.position) < 0.25
        && math::wrap_angle(kept.cp.heading - staging.cp.heading).abs() < 0.04
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_records::{SAMPLE_CSV, SAMPLE_NAME, SourceText, ingest};

    /// Accounts of the built-in sample.
    fn told() -> impl Iterator<Item = Told> {
        let profile = toml::from_str(include_str!("../../../../profiles/open.toml")).expect("a profile");
        let file = SourceText { name: SAMPLE_NAME, bytes: SAMPLE_CSV.as_bytes() };
        let records = ingest(&[file], &profile).expect("the sample is read").value.records;
        let incidents = recrash_reader::incidents(&records).into_iter();
        incidents.filter_map(|incident| Told::read(&recrash_reader::account(&incident)?))
    }

    #[test]
    fn the_best_come_first_however_few_are_asked_for() {
        let mut seen = 0;
        for told in told().step_by(12) {
            let mut all: Vec<Staging> = trials(&told).collect();
            all.sort_by_key(|staging| staging.cost);
            let mut stagings = Stagings::of(&told);
            let mut best: Vec<Staging> = Vec::new();
            for staging in all {
                if best.len() < 60 && !best.iter().any(|kept| is_like(kept, &staging)) {
                    assert_eq!(stagings.get(best.len()), Some(&staging));
                    best.push(staging);
                }
            }
            seen += best.len();
        }
        assert!(seen > 500, "{seen}");
    }
}
