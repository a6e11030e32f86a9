//! The best staging of one telling, and how it is found.

use crate::draft::scenario;
use crate::facts::keeping::ABSURD;
use crate::facts::{list, strays};
use crate::ground::way::Ground;
use crate::nearby::placed;
use crate::search::reconstruction::{Reconstruction, is_left_open};
use crate::told::crash::Told;
use crate::told::others::Extra;
use crate::touch::staging::Staging;
use crate::touch::stagings::{MOST_TRIES, Stagings};
use recrash_model::account::{Account, Untold};
use recrash_model::geometry::OrientedBox;
use recrash_model::metrics::{Check, CheckClass, Verdict};
use recrash_model::rollout::{ActorTrack, Role, Rollout};
use recrash_roads::check_on;
use recrash_sim::Ego;
use std::rc::Rc;

/// So many ways of touching of each telling are tried first.
const FIRST_TRIES: usize = 24;

/// Where one shows all that is told and nobody strays, no more are run to find one that keeps its lane better.
const ENOUGH_RUNS: usize = 36;

/// Where somebody strays in the best that shows all that is told, so many more are run after the first of every variant.
const BETTER_RUNS: usize = 100;

/// Where its way is absurd, so many are.
const ABSURD_RUNS: usize = 100;

/// That a way of touching is a step farther from the told zones is worth as much as so many half seconds off its lane.
const ZONE_STEP: usize = 3;

/// A reconstruction, and whether somebody strays in it.
pub(super) struct Found {
    pub(super) made: Reconstruction,
    pub(super) strays: bool,
}

pub(super) fn searched(told: Told, account: &Account, most_runs: usize) -> Result<Found, Untold> {
    let mut search = Search { most_runs, ..Search::default() };
    let variants = told.variants();
    let mut stagings: Vec<_> = variants.iter().map(|_| None).collect();
    'tried: for tries in [0..FIRST_TRIES, FIRST_TRIES..MOST_TRIES] {
        for (told, stagings) in variants.iter().zip(&mut stagings) {
            let stagings = stagings.get_or_insert_with(|| Stagings::of(told));
            for number in tries.clone() {
                let Some(staging) = stagings.get(number) else { break };
                if search.runs(account, told, staging) {
                    break 'tried;
                }
            }
        }
        if search.best.as_ref().is_some_and(Best::is_good) {
            break;
        }
        // What shows all that is told has to be found better soon.
        if search.best.as_ref().is_some_and(|best| best.cost.missed == 0) {
            search.most_runs = search.most_runs.min(search.runs + BETTER_RUNS);
        }
    }
    let Search { best, fullest, refused, .. } = search;
    let best = best.ok_or(if refused > 0 { Untold::NoRoom } else { Untold::NoContact })?;
    let (cost, made) = (best.cost, best.with_near());
    // A partner that strays is worth less than others who are told of.
    let fuller = fullest
        .map(|(_, found)| found)
        .filter(|found| (found.cost.strays || found.cost.off > 0) && made.is_true() && left_open(&made) > 0);
    let fuller = fuller.map(Best::with_near).filter(|fuller| left_open(fuller) < left_open(&made));
    let strays = fuller.is_some() || cost.others_stray || cost.strays;
    Ok(Found { made: fuller.unwrap_or(made), strays })
}

/// How many told facts of what the two did are not shown.
pub(super) fn acts_left_open(made: &Reconstruction) -> usize {
    made.verdict.checks.iter().filter(|check| is_of_acts(check)).count()
}

/// What was found among the stagings that were run.
#[derive(Default)]
struct Search {
    best: Option<Best>,
    /// The one with the fewest facts of others left open, of those that miss nothing; and how many.
    fullest: Option<(usize, Best)>,
    refused: usize,
    runs: usize,
    most_runs: usize,
}

impl Search {
    /// Runs a staging; true where nothing better can be found, or no more are run.
    fn runs(&mut self, account: &Account, told: &Told, staging: &Staging) -> bool {
        let Ok(checked) = check_on(scenario::draft(account, told, staging), Some(&staging.ground.network)) else {
            self.refused += 1;
            return false;
        };
        if self.runs == self.most_runs {
            return true;
        }
        self.runs += 1;
        let scenario = checked.value;
        let rollout = recrash_sim::rehearse(&scenario, Ego::Recorded);
        if !starts_apart(&rollout) {
            self.refused += 1;
            return false;
        }
        let verdict = Verdict { checks: list::facts(told, &scenario, &rollout) };
        // What misses more than the best is looked at no closer.
        if self.best.as_ref().is_some_and(|best| verdict.failures().count() > best.cost.missed) {
            return self.is_enough();
        }
        let others = strays::others_stray(told, &scenario, &rollout);
        let strays = strays::strays(told, &scenario, &rollout);
        let off = strays::off_its_way(told, &scenario, &rollout);
        // From beside the road it may show them by another way than along the ego's.
        let along = told.comes_along_lanes();
        let unseen = |check: &&Check| {
            let class = check.kind.class();
            is_left_open(check) && (along && class.is_deed() || class == CheckClass::Astride)
        };
        let cost = Cost {
            missed: verdict.failures().count(),
            others_stray: others,
            strays,
            unseen: verdict.checks.iter().filter(unseen).count(),
            off: off + ZONE_STEP * staging.cost.0 as usize,
        };
        let missing = verdict.checks.iter().filter(|check| is_of_others(check)).count();
        let better = self.best.as_ref().is_none_or(|best| cost < best.cost);
        let fuller =
            self.fullest.as_ref().is_none_or(|(fewest, _)| missing < *fewest) && cost.missed == 0 && !cost.others_stray;
        if better || fuller {
            let assumed = told.assumed.iter().cloned().chain(told.extras.iter().filter_map(Extra::assumed)).collect();
            let made = Reconstruction { draft: scenario.draft().clone(), rollout, verdict, assumed };
            let found = Best { cost, made, told: told.clone(), ground: Rc::clone(&staging.ground) };
            if fuller {
                self.fullest = Some((missing, found.clone()));
            }
            if better {
                self.best = Some(found);
            }
        }
        cost.shows_all() && off == 0 || self.is_enough()
    }

    /// Whether what was found is good enough for so many runs.
    fn is_enough(&self) -> bool {
        let most = if self.best.as_ref().is_some_and(Best::is_absurd) { ABSURD_RUNS } else { ENOUGH_RUNS };
        self.runs >= most && self.best.as_ref().is_some_and(Best::shows_all)
    }
}

/// Whether nobody is in touch with anybody from the beginning: a scenario leaves them 2 cm of room for rounding, and road users that
/// part within the first step have had no contact to be recorded.
fn starts_apart(rollout: &Rollout) -> bool {
    let there = |track: &&ActorTrack| track.role != Role::Part && track.is_present(0) && !track.states.is_empty();
    let boxes: Vec<OrientedBox> = rollout.actors.iter().filter(there).map(|track| track.outline(0)).collect();
    let touches = |(at, own): (usize, &OrientedBox)| boxes[..at].iter().any(|other| own.depth(other) > ROUNDING_M);
    !boxes.iter().enumerate().any(touches)
}

/// Less of one in the other is rounding. [m]
const ROUNDING_M: f64 = 1e-6;

/// Whether a fact of others in the story is told, and not shown.
fn is_of_others(check: &Check) -> bool {
    check.kind.class() == CheckClass::Others && is_left_open(check)
}

/// Whether an act of one of the two is told, and not to be seen.
pub(super) fn is_of_acts(check: &Check) -> bool {
    check.kind.class() == CheckClass::Acts && is_left_open(check)
}

pub(super) fn left_open(made: &Reconstruction) -> usize {
    made.verdict.checks.iter().filter(|check| is_of_others(check)).count()
}

/// What a staging lacks; of two the one with the less is better, by the first field in which they differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Cost {
    /// Stated facts that are not shown.
    missed: usize,
    /// Others are not where they are stated.
    others_stray: bool,
    /// The partner strays.
    strays: bool,
    /// Stated acts and lines that are not to be seen.
    unseen: usize,
    /// How far the partner is off its lane, weaves, and touches beside the stated zones.
    off: usize,
}

impl Cost {
    /// Whether every stated fact that can be is shown, and nobody strays.
    const fn nobody_strays(&self) -> bool {
        self.missed == 0 && !self.others_stray && !self.strays
    }

    /// Whether every stated fact is shown, and nobody strays.
    const fn shows_all(&self) -> bool {
        self.nobody_strays() && self.unseen == 0
    }
}

/// The best of what was tried.
#[derive(Clone)]
struct Best {
    cost: Cost,
    made: Reconstruction,
    told: Told,
    ground: Rc<Ground>,
}

impl Best {
    /// Whether every told fact is shown, and nobody strays.
    const fn shows_all(&self) -> bool {
        self.cost.shows_all()
    }

    /// Whether every told fact is shown, nobody strays, and the partner's way is none that nobody would drive.
    const fn is_good(&self) -> bool {
        self.cost.nobody_strays() && !self.is_absurd()
    }

    /// Whether the partner's way is one that nobody would drive.
    const fn is_absurd(&self) -> bool {
        self.cost.off >= 2 * ABSURD
    }

    /// The same with those who have no part in what the ego does, where nothing told is missed for them.
    fn with_near(self) -> Reconstruction {
        let Self { cost, made, told, ground } = self;
        if cost.missed > 0 || told.wanted.is_empty() {
            return made;
        }
        let (draft, rollout, assumed) = placed::with_near(&told, &ground, (made.draft.clone(), made.rollout.clone()));
        let Ok(checked) = check_on(draft, Some(&ground.network)) else { return made };
        let verdict = Verdict { checks: list::facts(&told, &checked.value, &rollout) };
        if verdict.failures().count() > 0 || !starts_apart(&rollout) {
            return made;
        }
        let assumed = made.assumed.iter().cloned().chain(assumed).collect();
        Reconstruction { draft: checked.value.draft().clone(), rollout, verdict, assumed }
    }
}
