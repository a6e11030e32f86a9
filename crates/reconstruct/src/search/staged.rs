//! The first telling of a crash that shows every told fact, else the one that shows most.

use crate::facts::list;
use crate::search::best::{Found, acts_left_open, is_of_acts, left_open, searched};
use crate::search::reconstruction::Reconstruction;
use crate::told::crash::Told;
use recrash_model::account::{Account, Untold};
use recrash_model::metrics::{CheckClass, CheckKind, Verdict};
use recrash_roads::check;

/// So many are run in all.
const MOST_RUNS: usize = 1000;

/// And where the same is tried in another way.
const AGAIN_RUNS: usize = 100;

/// What cannot be shown in all its steps is shown in the last of them; and where the partner cannot come out of the middle of its lane, it
/// comes straight to where it touches. What the two did is brought into the told order where it is not.
pub(crate) fn staged(told: Told, account: &Account) -> Result<Reconstruction, Untold> {
    let fewer = told.plainly().into_iter().chain(told.in_fewer_steps()).chain(told.touched_anyhow());
    let others: Vec<Told> = fewer.chain([told.coming_straight()]).collect();
    let asked = told.clone();
    let made = in_order(told, account, MOST_RUNS);
    let is_true = |made: &Result<Found, Untold>| made.as_ref().is_ok_and(|found| found.made.is_true());
    let other = match is_true(&made) {
        true => None,
        false => {
            let others = others.into_iter().map(|told| in_order(told, account, AGAIN_RUNS));
            others.map(|made| made.map(|found| held_again(found, &asked))).find(is_true)
        }
    };
    // The one that is kept is named by its states.
    let named = |made: Reconstruction| Reconstruction { rollout: made.rollout.named(), ..made };
    other.unwrap_or(made).map(|found| named(found.made))
}

/// The same, held against all that is told, and not against what was told for it.
fn held_again(found: Found, asked: &Told) -> Found {
    let Ok(scenario) = check(found.made.draft.clone()) else { return found };
    let checks = list::facts(asked, &scenario.value, &found.made.rollout);
    Found { made: Reconstruction { verdict: Verdict { checks }, ..found.made }, strays: found.strays }
}

/// The same, of which one is taken at another time that shows more of what the two did, and no less else. Where a light alone is shown otherwise,
/// the first that shows it too is taken, whatever it leaves open.
fn in_order(told: Told, account: &Account, most_runs: usize) -> Result<Found, Untold> {
    let (told, mut best) = near_or_far(told, account, most_runs)?;
    if !is_true_but_for_signals(&best.made) {
        return Ok(best);
    }
    for (told, helps) in told.in_other_times() {
        let open = [CheckKind::SvActs, CheckKind::CpActs]
            .map(|kind| best.made.verdict.checks.iter().any(|check| check.kind == kind && is_of_acts(check)));
        let late = !best.made.is_true();
        if !(late || open[0] && helps[0] || open[1] && helps[1]) {
            continue;
        }
        let other = searched(told, account, AGAIN_RUNS)
            .ok()
            .filter(|other| other.made.is_true() && (late || other.strays <= best.strays));
        let open = |found: &Found| (acts_left_open(&found.made), left_open(&found.made));
        let better = |other: &Found| open(other).0 < open(&best).0 && open(other).1 <= open(&best).1;
        if let Some(other) = other.filter(|other| late || better(other)) {
            best = other;
        }
    }
    Ok(best)
}

/// Whether no told fact but a light is shown otherwise: that may have had no time to change.
fn is_true_but_for_signals(made: &Reconstruction) -> bool {
    made.verdict.failures().all(|check| check.kind.class() == CheckClass::Signal)
}

/// Who was behind the ego in a queue stands close to it; farther off where nothing true is found with that.
fn near_or_far(told: Told, account: &Account, most_runs: usize) -> Result<(Told, Found), Untold> {
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
