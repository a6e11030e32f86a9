//! Seeded search over a scenario's numeric parameters.
//!
//! One entry, [`tune`]: it asks an optimiser for points, scores them with a function it is given, and logs every one.
//! What this crate does **not** do: it knows neither roads nor physics nor what a good score means.
//!
//! Optimisers see the unit cube. [`Searcher`] names them; a new one is a variant, a file, and an arm in
//! `Searcher::optimiser`.

mod cma;
mod halton;

use recrash_model::Seed;
use recrash_model::tuning::{Parameter, Score, TUNE_FORMAT, TuneLog, TunePoint};
use std::cell::RefCell;

/// Which optimiser proposes the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Searcher {
    /// A scrambled Halton sequence over the whole box: no learning, even coverage.
    Halton,
    /// A quarter of the budget on the Halton sequence, then (1+1)-CMA-ES from the best points found.
    Cma,
}

impl Searcher {
    /// Name in logs and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Halton => "halton",
            Self::Cma => "cma",
        }
    }

    fn optimiser(self, dimensions: usize, budget: usize, seed: Seed) -> Box<dyn Optimiser> {
        match self {
            Self::Halton => Box::new(halton::Halton::new(dimensions, seed)),
            Self::Cma => Box::new(cma::ExploreThenCma::new(dimensions, budget, seed)),
        }
    }
}

impl std::str::FromStr for Searcher {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "halton" => Ok(Self::Halton),
            "cma" => Ok(Self::Cma),
            _ => Err(format!("no search is called \"{name}\"; there are: cma, halton")),
        }
    }
}

/// How long and with what to search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TuneOptions {
    /// Optimiser.
    pub searcher: Searcher,
    /// Points to score at most, the scenario as designed included.
    pub budget: usize,
}

impl Default for TuneOptions {
    fn default() -> Self {
        Self { searcher: Searcher::Cma, budget: 160 }
    }
}

/// Proposes points in the unit cube, and learns from what they scored.
trait Optimiser {
    /// The next point, and a word on how it came about.
    fn ask(&mut self) -> (Vec<f64>, &'static str);

    /// The objective of a point: of the last one asked for, or of the scenario as designed. Infinite where refused.
    fn tell(&mut self, point: &[f64], objective: f64);

    /// Another one that has learned the same.
    fn copy(&self) -> Box<dyn Optimiser>;
}

/// The points that a search comes to next, as many as are asked for, if neither the one that is scored nor they are better than the best so
/// far. Most are not: who has time to spare may make ready for them.
pub type Next<'a> = &'a dyn Fn(usize) -> Vec<Vec<f64>>;

/// What is searched.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// Scenario.
    pub scenario_id: &'a str,
    /// What may move.
    pub parameters: &'a [Parameter],
    /// Seed.
    pub seed: Seed,
    /// Who proposes the points, for the log.
    pub searcher: &'a str,
}

/// Searches for values of `parameters` that make `score(values, next).objective` small, with one of our optimisers.
///
/// Point 0 is the scenario as designed. Refused points are logged and never kept. Of the others a failure is kept before
/// any point that passes, and among equals the one with the least objective; where every point is refused, the start is
/// kept. The search ends early at a score that `enough` accepts.
pub fn tune(
    scenario_id: &str,
    parameters: &[Parameter],
    options: TuneOptions,
    seed: Seed,
    mut score: impl FnMut(&[f64], Next<'_>) -> Score,
    enough: impl Fn(&TunePoint) -> bool,
) -> TuneLog {
    let optimiser = RefCell::new(options.searcher.optimiser(parameters.len(), options.budget, seed));
    let propose = |history: &[TunePoint]| {
        let mut optimiser = optimiser.borrow_mut();
        if let Some(last) = history.last() {
            let objective = if last.score.refused.is_empty() { last.score.objective } else { f64::INFINITY };
            optimiser.tell(&all_to_unit(parameters, &last.values), objective);
        }
        Ok(asked(&mut **optimiser, parameters))
    };
    let score = |values: &[f64]| {
        score(values, &|count| {
            let (mut optimiser, mut values) = (optimiser.borrow().copy(), values.to_vec());
            let after = |_| {
                optimiser.tell(&all_to_unit(parameters, &values), f64::INFINITY);
                values = asked(&mut *optimiser, parameters).0;
                values.clone()
            };
            (0..count).map(after).collect()
        })
    };
    let task = Task { scenario_id, parameters, seed, searcher: options.searcher.name() };
    match tune_with(&task, options.budget, propose, score, enough) {
        Ok(log) => log,
        Err(never) => {
            let never: std::convert::Infallible = never;
            match never {}
        }
    }
}

/// As [`tune`], with points that somebody else proposes, who sees all points so far.
///
/// # Errors
/// Whatever `propose` fails with.
pub fn tune_with<E>(
    task: &Task,
    budget: usize,
    mut propose: impl FnMut(&[TunePoint]) -> Result<(Vec<f64>, &'static str), E>,
    mut score: impl FnMut(&[f64]) -> Score,
    enough: impl Fn(&TunePoint) -> bool,
) -> Result<TuneLog, E> {
    let budget = if task.parameters.is_empty() { 1 } else { budget.max(1) };
    let mut points: Vec<TunePoint> = Vec::with_capacity(budget);
    let mut best = 0;
    for number in 0..budget {
        let (values, proposed_by) = match number {
            0 => (task.parameters.iter().map(|p| p.start).collect(), "start"),
            _ => propose(&points)?,
        };
        let score = score(&values);
        let point = TunePoint { number, proposed_by: proposed_by.to_owned(), values, score };
        if is_better(&point, &points, best) {
            best = number;
        }
        let done = enough(&point);
        points.push(point);
        if done {
            break;
        }
    }
    Ok(TuneLog {
        format: TUNE_FORMAT.to_owned(),
        scenario_id: task.scenario_id.to_owned(),
        searcher: task.searcher.to_owned(),
        seed: task.seed.0,
        parameters: task.parameters.to_vec(),
        points,
        best,
    })
}

/// The next point of an optimiser, and a word on how it came about.
fn asked(optimiser: &mut dyn Optimiser, parameters: &[Parameter]) -> (Vec<f64>, &'static str) {
    let (unit, proposed_by) = optimiser.ask();
    (parameters.iter().zip(&unit).map(|(p, &u)| from_unit(p, u)).collect(), proposed_by)
}

/// Whether a point is kept instead of the best one so far. What is looked for is a failure, so one comes before all that
/// pass, whatever their objectives: a gap of somebody who never came nearer is smaller than many a near miss.
fn is_better(point: &TunePoint, earlier: &[TunePoint], best: usize) -> bool {
    let Some(best) = earlier.get(best) else { return true };
    let (point, best) = (&point.score, &best.score);
    let order = (!point.failed).cmp(&!best.failed).then(point.objective.total_cmp(&best.objective));
    point.refused.is_empty() && (!best.refused.is_empty() || order.is_lt())
}

fn all_to_unit(parameters: &[Parameter], values: &[f64]) -> Vec<f64> {
    parameters.iter().zip(values).map(|(p, &value)| to_unit(p, value)).collect()
}

fn to_unit(parameter: &Parameter, value: f64) -> f64 {
    let width = parameter.max - parameter.min;
    if width > 0.0 { ((value - parameter.min) / width).clamp(0.0, 1.0) } else { 0.5 }
}

/// The value at `unit`, rounded to six decimals so that files say what was run.
fn from_unit(parameter: &Parameter, unit: f64) -> f64 {
    let value = parameter.min + (parameter.max - parameter.min) * unit;
    let value = if parameter.integer { value.round() } else { (value * 1e6).round() / 1e6 };
    value.clamp(parameter.min, parameter.max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(min: f64, max: f64, start: f64) -> Parameter {
        Parameter {
            pointer: "/duration_s".into(),
            unit: "s".into(),
            min,
            max,
            start,
            integer: false,
            reason: "test".into(),
        }
    }

    fn scored(objective: f64, refused: bool) -> Score {
        Score {
            depth_m: None,
            contact_mps: None,
            braking: None,
            objective,
            min_gap: None,
            findings: vec![],
            failed: false,
            refused: if refused { vec!["refused".into()] } else { vec![] },
        }
    }

    fn best_of(searcher: Searcher, budget: usize, seed: u64, f: impl Fn(&[f64]) -> f64) -> f64 {
        let parameters: Vec<_> = (0..4).map(|i| parameter(-1.0, 3.0, 2.0 - f64::from(i) * 0.3)).collect();
        let options = TuneOptions { searcher, budget };
        let log = tune("t", &parameters, options, Seed(seed), |x, _| scored(f(x), false), |_| false);
        assert_eq!(log.points.len(), budget);
        log.points[log.best].score.objective
    }

    #[test]
    fn cma_finds_the_bottom_of_an_ill_scaled_bowl() {
        for seed in 0..10 {
            let best = best_of(Searcher::Cma, 600, seed, |x| {
                x.iter()
                    .enumerate()
                    .map(|(i, v)| recrash_model::math::pow(10.0, i as f64) * (v - 0.5) * (v - 0.5))
                    .sum()
            });
            assert!(best < 1e-3, "seed {seed}: {best}");
        }
    }

    #[test]
    fn cma_beats_even_coverage_on_a_bowl() {
        let bowl = |x: &[f64]| x.iter().map(|v| (v - 0.5) * (v - 0.5)).sum();
        assert!(best_of(Searcher::Cma, 200, 1, bowl) < 0.01 * best_of(Searcher::Halton, 200, 1, bowl));
    }

    #[test]
    fn the_start_is_kept_when_every_other_point_is_refused() {
        let parameters = [parameter(0.0, 1.0, 0.5)];
        let log = tune(
            "t",
            &parameters,
            TuneOptions { budget: 20, ..TuneOptions::default() },
            Seed(1),
            |x, _| scored(-x[0].abs(), x[0] != 0.5),
            |_| false,
        );
        assert_eq!(log.best, 0);
        assert_eq!(log.points.len(), 20);
    }

    #[test]
    fn a_refused_start_gives_way_to_any_accepted_point() {
        let parameters = [parameter(0.0, 1.0, 0.5)];
        let log = tune("t", &parameters, TuneOptions::default(), Seed(1), |x, _| scored(5.0, x[0] == 0.5), |_| false);
        assert_ne!(log.best, 0);
    }

    #[test]
    fn a_failure_is_kept_before_every_point_that_passes() {
        let parameters = [parameter(0.0, 1.0, 0.5)];
        // Few points fail, and whatever passes has the smaller objective; of what is refused nothing is kept.
        let score = |x: &[f64], _: Next<'_>| {
            let failed = (0.6..0.8).contains(&x[0]);
            let refused = (0.7..0.75).contains(&x[0]);
            Score { failed, ..scored(if failed { 1.0 + x[0] } else { x[0] - 5.0 }, refused) }
        };
        for searcher in [Searcher::Halton, Searcher::Cma] {
            let log = tune("t", &parameters, TuneOptions { searcher, budget: 40 }, Seed(3), score, |_| false);
            let accepted = |point: &&TunePoint| point.score.failed && point.score.refused.is_empty();
            let failures = log.points.iter().filter(accepted);
            let nearest = failures.min_by(|a, b| a.score.objective.total_cmp(&b.score.objective)).unwrap();
            assert_eq!(log.best, nearest.number, "{searcher:?}");
        }
    }

    #[test]
    fn what_comes_next_is_told_where_nothing_better_is_found() {
        let parameters = [parameter(0.0, 1.0, 0.5), parameter(0.0, 9.0, 1.0)];
        let (budget, ahead) = (60, 5);
        for searcher in [Searcher::Halton, Searcher::Cma] {
            let mut told = Vec::new();
            let score = |values: &[f64], next: Next<'_>| {
                told.push(next(ahead));
                scored(f64::from(u8::from(values != [0.5, 1.0])), false)
            };
            let log = tune("t", &parameters, TuneOptions { searcher, budget }, Seed(4), score, |_| false);
            for (number, told) in told.iter().enumerate().filter(|(number, _)| number + ahead < budget) {
                let came: Vec<_> = log.points[number + 1..=number + ahead].iter().map(|point| &point.values).collect();
                assert_eq!(told.iter().collect::<Vec<_>>(), came, "{searcher:?}, point {number}");
            }
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_points_and_another_seed_others() {
        let parameters = [parameter(0.0, 1.0, 0.5), parameter(0.0, 9.0, 1.0)];
        let run = |seed| {
            tune("t", &parameters, TuneOptions::default(), Seed(seed), |x, _| scored(x[0] + x[1], false), |_| false)
        };
        assert_eq!(run(4), run(4));
        assert_ne!(run(4), run(5));
    }

    #[test]
    fn values_stay_in_their_bounds_and_whole_numbers_are_whole() {
        let mut whole = parameter(1.0, 7.0, 3.0);
        whole.integer = true;
        let parameters = [whole, parameter(-2.0, -1.0, -1.5)];
        let log = tune("t", &parameters, TuneOptions::default(), Seed(9), |x, _| scored(x[0], false), |_| false);
        for point in &log.points {
            assert!((1.0..=7.0).contains(&point.values[0]) && point.values[0].fract() == 0.0, "{point:?}");
            assert!((-2.0..=-1.0).contains(&point.values[1]), "{point:?}");
        }
        assert_eq!(log.points[log.best].values[0], 1.0);
    }
}
