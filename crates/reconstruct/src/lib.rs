//! From an account to a scenario that shows the crash as it is told, with the recorded driver in the ego's seat; and every
//! told fact held against what the rollout shows.
//!
//! The crash is staged backwards: first how the two touch (`touch`: headings, zones, who closes on whom), then how each
//! of them came there (`came`), then the road around it (`ground`). What the account leaves open is chosen, and
//! named as assumed. A rollout decides: who is drawn and does not show a told fact is not told. Rules and numbers:
//! `docs/models/reconstruction.md`.

mod acts;
mod came;
mod choices;
mod control;
mod door;
mod entry;
mod extras;
mod facts;
mod ground;
mod keeping;
mod kerb;
mod lanes;
mod lateral;
mod layout;
mod movement;
mod near;
mod nearby;
mod others;
mod pace;
mod phases;
mod roadside;
mod role;
mod seen;
mod side;
mod sizes;
mod speeds;
mod strips;
mod sweep;
mod things;
mod thrown;
mod told;
mod touch;
mod trailer;

pub use choices::open_choices;

use choices::Choices;
use others::Extra;
use recrash_model::account::{Account, Untold};
use recrash_model::metrics::{Answer, Check, CheckKind, CheckResult, Verdict};
use recrash_model::rollout::Rollout;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::tuning::Parameter;
use recrash_roads::{Scenario, check_on};
use recrash_sim::Ego;
use std::rc::Rc;

/// Stagings of a variant that are tried first; and at most, where none of those of all variants shows every told fact, and in all.
const FIRST_TRIES: usize = 24;
pub(crate) const MOST_TRIES: usize = 400;
const MOST_RUNS: usize = 1000;

/// And where the same is tried in another way.
const AGAIN_RUNS: usize = 100;

/// Where one shows all that is told and nobody strays, no more are run to find one that keeps its lane better.
const ENOUGH_RUNS: usize = 36;

/// Where somebody strays in the best that shows all that is told, so many more are run after the first of every variant.
const BETTER_RUNS: usize = 100;

/// Where its way is absurd, so many are.
const ABSURD_RUNS: usize = 100;

/// That a way of touching is a step farther from the told zones is worth as much as so many half seconds off its lane.
const ZONE_STEP: usize = 3;

/// A crash, reconstructed.
#[derive(Debug, Clone, PartialEq)]
pub struct Reconstruction {
    /// The scenario, with the recorded driver.
    pub draft: ScenarioDraft,
    /// What it shows.
    pub rollout: Rollout,
    /// Every told fact, and whether it is shown.
    pub verdict: Verdict,
    /// What nobody told, and was chosen.
    pub assumed: Vec<String>,
}

impl Reconstruction {
    /// Whether no told fact is shown otherwise; some may be beyond what can be shown yet.
    pub fn is_true(&self) -> bool {
        self.verdict.faithful() != Answer::No
    }

    /// The first told fact without which this is not the crash: one that is shown otherwise, or something that the two are told to have
    /// done and that is not to be seen. Nothing where the crash is told; others, or why the ego stood, may still not be drawn.
    pub fn missed(&self) -> Option<&Check> {
        use CheckKind::{CpActs, CpMovement, PassedOn, SvActs, SvMovement};
        let is_deed = |kind| matches!(kind, SvMovement | CpMovement | SvActs | CpActs | PassedOn);
        let open = |check: &Check| check.result == CheckResult::CannotBeShown && is_deed(check.kind);
        self.verdict.failures().next().or_else(|| self.verdict.checks.iter().find(|check| open(check)))
    }
}

/// The kinds of facts that an account tells and that can be held against a rollout, whether or not it can be staged.
pub fn told_kinds(account: &Account) -> Vec<CheckKind> {
    told::Told::read(account).map(|told| told.kinds()).unwrap_or_default()
}

/// Told facts of an account, held against a rollout of any scenario. Of the scenario its roads, signals and stops are looked at.
///
/// # Errors
/// The account cannot be staged at all.
pub fn held_against(account: &Account, scenario: &Scenario, rollout: &Rollout) -> Result<Verdict, Untold> {
    Ok(Verdict { checks: facts::facts(&told::Told::of(account)?, scenario, rollout) })
}

/// For how long the partner of a reconstruction is in no lane of its direction before it does what is told to take it aside; nothing
/// where it does not come along lanes. [s]
pub fn off_lane_s(account: &Account, made: &Reconstruction) -> Option<f64> {
    let scenario = recrash_roads::check(made.draft.clone()).ok()?.value;
    facts::off_lane_s(&told::Told::read(account)?, &scenario, &made.rollout)
}

/// Stages an account: the first staging that shows every told fact, else the one that shows most.
///
/// # Errors
/// Why there is none.
pub fn reconstruct(account: &Account) -> Result<Reconstruction, Untold> {
    staged(told::Told::of(account)?, account)
}

/// The same with these values for what the account leaves open ([`open_choices`]).
///
/// # Errors
/// Why there is none.
pub fn reconstruct_with(account: &Account, open: &[Parameter], values: &[f64]) -> Result<Reconstruction, Untold> {
    let told = told::Told::of(account)?;
    staged(told.choosing(Choices::of(open, values)), account)
}

/// What cannot be shown in all its steps is shown in the last of them; and where the partner cannot come out of the middle of its lane, it
/// comes straight to where it touches. What the two did is brought into the told order where it is not.
fn staged(told: told::Told, account: &Account) -> Result<Reconstruction, Untold> {
    let fewer = told.plainly().into_iter().chain(told.in_fewer_steps());
    let others: Vec<told::Told> = fewer.chain([told.coming_straight()]).collect();
    let made = in_order(told, account, MOST_RUNS);
    let is_true = |made: &Result<Found, Untold>| made.as_ref().is_ok_and(|found| found.made.is_true());
    let other = match is_true(&made) {
        true => None,
        false => others.into_iter().map(|told| in_order(told, account, AGAIN_RUNS)).find(is_true),
    };
    other.unwrap_or(made).map(|found| found.made)
}

/// The same, of which one is taken at another time that shows more of what the two did, and no less else.
fn in_order(told: told::Told, account: &Account, most_runs: usize) -> Result<Found, Untold> {
    let (told, mut best) = near_or_far(told, account, most_runs)?;
    if !best.made.is_true() {
        return Ok(best);
    }
    for (told, helps) in told.in_other_times() {
        let open = [CheckKind::SvActs, CheckKind::CpActs]
            .map(|kind| best.made.verdict.checks.iter().any(|check| check.kind == kind && is_of_acts(check)));
        if !(open[0] && helps[0] || open[1] && helps[1]) {
            continue;
        }
        let other = searched(told, account, AGAIN_RUNS)
            .ok()
            .filter(|other| other.made.is_true() && other.strays <= best.strays);
        let open = |found: &Found| (acts_left_open(&found.made), left_open(&found.made));
        if let Some(other) = other.filter(|other| open(other).0 < open(&best).0 && open(other).1 <= open(&best).1) {
            best = other;
        }
    }
    Ok(best)
}

/// Who was behind the ego in a queue stands close to it; farther off where nothing true is found with that.
fn near_or_far(told: told::Told, account: &Account, most_runs: usize) -> Result<(told::Told, Found), Untold> {
    let near = searched(told.clone(), account, most_runs);
    let good = |found: &Result<Found, Untold>| {
        found.as_ref().is_ok_and(|found| found.made.is_true() && !found.strays && acts_left_open(&found.made) == 0)
    };
    if good(&near) {
        return near.map(|found| (told, found));
    }
    let afar = told.afar().map(|told| (searched(told.clone(), account, AGAIN_RUNS), told));
    match afar.filter(|(far, _)| good(far) || !near.as_ref().is_ok_and(|near| near.made.is_true())) {
        Some((far, told)) => far.map(|found| (told, found)),
        None => near.map(|found| (told, found)),
    }
}

/// A reconstruction, and whether somebody strays in it.
struct Found {
    made: Reconstruction,
    strays: bool,
}

fn searched(told: told::Told, account: &Account, most_runs: usize) -> Result<Found, Untold> {
    let mut search = Search { most_runs, ..Search::default() };
    let mut variants: Vec<_> = told.variants().into_iter().map(|told| (told, None)).collect();
    'tried: for tries in [0..FIRST_TRIES, FIRST_TRIES..MOST_TRIES] {
        for (told, stagings) in &mut variants {
            let (told, stagings) = (&*told, stagings.get_or_insert_with(|| touch::stagings(told)));
            for staging in stagings.iter().take(tries.end).skip(tries.start) {
                if search.runs(account, told, staging) {
                    break 'tried;
                }
            }
        }
        if search.best.as_ref().is_some_and(Best::is_good) {
            break;
        }
        // What shows all that is told has to be found better soon.
        if search.best.as_ref().is_some_and(|best| best.cost.0 == 0) {
            search.most_runs = search.most_runs.min(search.runs + BETTER_RUNS);
        }
    }
    let Search { best, fullest, refused, .. } = search;
    let best = best.ok_or(if refused > 0 { Untold::NoRoom } else { Untold::NoContact })?;
    let (cost, made) = (best.cost, best.with_near());
    // A partner that strays is worth less than others who are told of.
    let fuller = fullest
        .map(|(_, found)| found)
        .filter(|found| (found.cost.2 || found.cost.4 > 0) && made.is_true() && left_open(&made) > 0);
    let fuller = fuller.map(Best::with_near).filter(|fuller| left_open(fuller) < left_open(&made));
    let strays = fuller.is_some() || cost.1 || cost.2;
    Ok(Found { made: fuller.unwrap_or(made), strays })
}

/// How many told facts of what the two did are not shown.
fn acts_left_open(made: &Reconstruction) -> usize {
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
    fn runs(&mut self, account: &Account, told: &told::Told, staging: &touch::Staging) -> bool {
        let Ok(checked) = check_on(came::draft(account, told, staging), Some(&staging.ground.network)) else {
            self.refused += 1;
            return false;
        };
        if self.runs == self.most_runs {
            return true;
        }
        self.runs += 1;
        let scenario = checked.value;
        let rollout = recrash_sim::simulate(&scenario, Ego::Recorded);
        let verdict = Verdict { checks: facts::facts(told, &scenario, &rollout) };
        let others = facts::others_stray(told, &scenario, &rollout);
        let strays = facts::strays(told, &scenario, &rollout);
        let off = facts::off_its_way(told, &scenario, &rollout);
        // From beside the road it may show them by another way than along the ego's.
        let along = told.comes_along_lanes();
        let unseen = verdict.checks.iter().filter(|check| along && is_of_acts(check)).count();
        let shows = (verdict.failures().count(), others, strays, unseen);
        let cost = (shows.0, shows.1, shows.2, shows.3, off + ZONE_STEP * staging.cost.0 as usize);
        let missing = verdict.checks.iter().filter(|check| is_of_others(check)).count();
        let better = self.best.as_ref().is_none_or(|best| cost < best.cost);
        let fuller =
            self.fullest.as_ref().is_none_or(|(fewest, _)| missing < *fewest) && (cost.0, cost.1) == (0, false);
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
        let most = if self.best.as_ref().is_some_and(Best::is_absurd) { ABSURD_RUNS } else { ENOUGH_RUNS };
        let enough = self.runs >= most && self.best.as_ref().is_some_and(Best::shows_all);
        shows == (0, false, false, 0) && off == 0 || enough
    }
}

/// Whether a fact of others in the story is told, and not shown.
fn is_of_others(check: &Check) -> bool {
    matches!(check.kind, CheckKind::Reason | CheckKind::Others) && check.result == CheckResult::CannotBeShown
}

/// Whether an act of one of the two is told, and not to be seen.
fn is_of_acts(check: &Check) -> bool {
    matches!(check.kind, CheckKind::SvActs | CheckKind::CpActs) && check.result == CheckResult::CannotBeShown
}

fn left_open(made: &Reconstruction) -> usize {
    made.verdict.checks.iter().filter(|check| is_of_others(check)).count()
}

/// The best of what was tried: told facts that are not shown, then whether others are not as told, whether the partner strays, how many
/// told acts are not to be seen, and how far it is off its lane and weaves.
#[derive(Clone)]
struct Best {
    cost: (usize, bool, bool, usize, usize),
    made: Reconstruction,
    told: told::Told,
    ground: Rc<ground::Ground>,
}

impl Best {
    /// Whether every told fact is shown, and nobody strays.
    fn shows_all(&self) -> bool {
        matches!(self.cost, (0, false, false, 0, _))
    }

    /// Whether every told fact is shown, nobody strays, and the partner's way is none that nobody would drive.
    const fn is_good(&self) -> bool {
        matches!(self.cost, (0, false, false, ..)) && !self.is_absurd()
    }

    /// Whether the partner's way is one that nobody would drive.
    const fn is_absurd(&self) -> bool {
        self.cost.4 >= 2 * keeping::ABSURD
    }

    /// The same with those who have no part in what the ego does, where nothing told is missed for them.
    fn with_near(self) -> Reconstruction {
        let Self { cost, made, told, ground } = self;
        if cost.0 > 0 || told.wanted.is_empty() {
            return made;
        }
        let (draft, rollout, assumed) = nearby::with_near(&told, &ground, (made.draft.clone(), made.rollout.clone()));
        let Ok(checked) = check_on(draft, Some(&ground.network)) else { return made };
        let verdict = Verdict { checks: facts::facts(&told, &checked.value, &rollout) };
        if verdict.failures().count() > 0 {
            return made;
        }
        let assumed = made.assumed.iter().cloned().chain(assumed).collect();
        Reconstruction { draft: checked.value.draft().clone(), rollout, verdict, assumed }
    }
}
