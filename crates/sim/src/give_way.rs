//! Giving way where paths cross or merge: who may go first, and where the other waits.

use crate::scene::Scene;
use recrash_roads::{Conflict, Footprint, LanePath};

/// A place where an actor's path meets another's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossing {
    /// Whose path this is seen from, and whose it meets.
    pub(crate) me: usize,
    pub(crate) other: usize,
    /// The stretch of each path on which the two can touch, for the centre of the vehicle. [m]
    pub(crate) mine: Stretch,
    pub(crate) theirs: Stretch,
    /// The paths go on in one lane.
    pub(crate) merges: bool,
}

/// A stretch of a path. [m]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stretch {
    pub(crate) from: f64,
    pub(crate) to: f64,
}

impl Crossing {
    /// The crossing of two paths, from their conflict.
    pub(crate) fn new(
        (me, path, size): (usize, &LanePath, Footprint),
        (other, other_path, other_size): (usize, &LanePath, Footprint),
        conflict: Conflict,
    ) -> Self {
        let (reach, other_reach) = conflict.reaches((path, size), (other_path, other_size));
        let stretch = |s: f64, reach: f64| Stretch {
            from: s - reach,
            to: if conflict.merges { f64::INFINITY } else { s + reach },
        };
        Self {
            me,
            other,
            mine: stretch(conflict.s_a, reach),
            theirs: stretch(conflict.s_b, other_reach),
            merges: conflict.merges,
        }
    }
}

/// How careful somebody is about others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Manners {
    /// Time that must be left between one leaving the crossing and the other reaching it. [s]
    pub(crate) gap_s: f64,
}

/// Somebody below this speed is waiting, not coming. [m/s]
const WAITING_MPS: f64 = 0.3;

/// After standing this long at a crossing where the other stands too, the one who came later goes as well. [steps]
const PATIENCE_STEPS: u32 = 30;

/// Nobody further away than this is thought about. [s]
const HORIZON_S: f64 = 12.0;

/// Where paths merge, the other has gone first when he is this far along the common lane. [m]
pub(crate) const MERGED_M: f64 = 12.0;

/// Who has come this far past the place to wait goes on; the stretch itself begins a little behind that place. [m]
const COMMITTED_M: f64 = 1.0;

/// Others may speed up; going first allows for this. [m/s^2]
const THEIR_ACCELERATION_MPS2: f64 = 1.0;

/// What has to be remembered between decisions.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct GiveWay {
    standing_steps: u32,
}

impl GiveWay {
    /// The distance from the centre of the vehicle to where it has to wait; `None` where it may go. [m]
    pub(crate) fn stop_line(
        &mut self,
        scene: &Scene<'_>,
        me: usize,
        crossings: &[Crossing],
        wanted_mps: f64,
        manners: Manners,
    ) -> Option<f64> {
        self.count_standing(scene, me);
        self.stop_lines(scene, me, crossings, wanted_mps, manners)
            .map(|(_, distance)| distance)
            .fold(None, |nearest, distance| Some(nearest.map_or(distance, |least: f64| least.min(distance))))
    }

    /// Once per decision: how long it has been standing.
    pub(crate) fn count_standing(&mut self, scene: &Scene<'_>, me: usize) {
        let stands = scene.actors[me].speed < WAITING_MPS;
        self.standing_steps = if stands { self.standing_steps + 1 } else { 0 };
    }

    /// Every crossing it has to wait at now, with the distance from its centre to the place to wait. [m]
    pub(crate) fn stop_lines<'a>(
        &'a self,
        scene: &'a Scene<'_>,
        me: usize,
        crossings: &'a [Crossing],
        wanted_mps: f64,
        manners: Manners,
    ) -> impl Iterator<Item = (&'a Crossing, f64)> + 'a {
        let s = scene.path_s(me);
        crossings.iter().filter(move |crossing| crossing.me == me).filter_map(move |crossing| {
            let ahead = crossing.mine.from - s;
            let waits = ahead >= -COMMITTED_M && self.must_wait(scene, me, crossing, ahead, s, wanted_mps, manners);
            waits.then(|| (crossing, ahead.max(0.0)))
        })
    }

    #[allow(clippy::too_many_arguments, reason = "one private caller")]
    fn must_wait(
        &self,
        scene: &Scene<'_>,
        me: usize,
        crossing: &Crossing,
        ahead: f64,
        s: f64,
        wanted_mps: f64,
        manners: Manners,
    ) -> bool {
        let other = &scene.actors[crossing.other];
        if !other.present {
            return false;
        }
        let other_s = scene.path_s(crossing.other);
        // Over, or (where the paths merge) now simply somebody in front.
        let their_end = if crossing.merges { crossing.theirs.from + MERGED_M } else { crossing.theirs.to };
        if other_s > their_end {
            return false;
        }
        let inside = other_s > crossing.theirs.from;
        if inside {
            return true;
        }
        if other.speed < WAITING_MPS {
            // Both stand: the first in the list goes, the other when he has waited long enough.
            return crossing.other < me && scene.actors[me].speed < WAITING_MPS && self.standing_steps < PATIENCE_STEPS;
        }
        let speed = scene.actors[me].speed.max(0.5 * wanted_mps).max(WAITING_MPS);
        let my_entry = ahead.max(0.0) / speed;
        let my_exit = if crossing.merges { my_entry + 1.0 } else { (crossing.mine.to - s) / speed };
        let way = crossing.theirs.from - other_s;
        // The earliest they can be there: v t + a t^2 / 2 = way.
        let a = THEIR_ACCELERATION_MPS2;
        let their_entry = ((other.speed * other.speed + 2.0 * a * way).sqrt() - other.speed) / a;
        let their_exit =
            if crossing.merges { way / other.speed + 1.0 } else { (crossing.theirs.to - other_s) / other.speed };
        if their_entry > HORIZON_S || my_entry > HORIZON_S {
            return false;
        }
        let clear_before = my_exit + manners.gap_s <= their_entry;
        let clear_behind = their_exit + 0.5 * manners.gap_s <= my_entry;
        !clear_before && !clear_behind
    }
}
