//! Giving way where paths cross or merge: who may go first.

use crate::constants::{
    COMMITTED_M, HORIZON_S, MERGED_M, MERGING_S, PATIENCE_STEPS, STANDING_MPS, THEIR_ACCELERATION_MPS2,
};
use recrash_model::math;
use recrash_roads::{Conflict, Footprint, LanePath};
use serde::Serialize;

/// A place where an actor's path meets another's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Crossing {
    /// Whose path this is seen from. Actors are numbered: the ego, the partners, background traffic.
    pub me: usize,
    /// Whose path it meets.
    pub other: usize,
    /// The stretch of the own path on which the two can touch, for the centre of the vehicle.
    pub mine: Stretch,
    /// That of the other's path.
    pub theirs: Stretch,
    /// The paths go on in one lane; then the stretches have no end.
    pub merges: bool,
    /// They cross at so small an angle that who is ahead there is followed, rather than waited for. No policy of the paper's asks.
    #[serde(skip)]
    pub same_way: bool,
}

/// Below this angle paths go the same way: the stretch on which the two can touch has no clear end any more, and is cut off there
/// (`Conflict::reaches`).
const SAME_WAY_COS: f64 = 0.866;

/// A stretch of a path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Stretch {
    /// Its beginning along the path. [m]
    pub from: f64,
    /// Its end. [m]
    pub to: f64,
}

impl Crossing {
    /// The crossing of two paths, from their conflict.
    pub fn new(
        (me, path, size): (usize, &LanePath, Footprint),
        (other, other_path, other_size): (usize, &LanePath, Footprint),
        conflict: Conflict,
    ) -> Self {
        let (reach, other_reach) = conflict.reaches((path, size), (other_path, other_size));
        let turned = path.pose(conflict.s_a, 0.0).heading - other_path.pose(conflict.s_b, 0.0).heading;
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
            same_way: !conflict.merges && math::sincos(turned).1 > SAME_WAY_COS,
        }
    }

    /// How far the other is ahead of this one, centre to centre, where both go the same way; negative where it is behind. [m]
    pub fn lead(&self, me: Traveller, other: Traveller) -> Option<f64> {
        let left = |stretch: Stretch, at: Traveller| 0.5 * (stretch.from + stretch.to) - at.s_m;
        self.same_way.then(|| left(self.mine, me) - left(self.theirs, other))
    }
}

/// How careful somebody is about others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Manners {
    /// Time that must be left between one leaving the crossing and the other reaching it. [s]
    pub gap_s: f64,
}

/// Somebody on a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Traveller {
    /// How far along the path its centre is. [m]
    pub s_m: f64,
    /// [m/s]
    pub speed_mps: f64,
}

/// How far ahead the place to wait is, where somebody has to wait at this crossing now. [m]
///
/// `standing_steps` is how long it has been standing, `wanted_mps` the speed it would like.
pub fn stop_distance(
    crossing: &Crossing,
    me: Traveller,
    other: Traveller,
    standing_steps: u32,
    wanted_mps: f64,
    manners: Manners,
) -> Option<f64> {
    let ahead = crossing.mine.from - me.s_m;
    let waits = ahead >= -COMMITTED_M && must_wait(crossing, me, other, standing_steps, wanted_mps, manners);
    waits.then(|| ahead.max(0.0))
}

/// Whether somebody lets another go first at a crossing.
pub fn must_wait(
    crossing: &Crossing,
    me: Traveller,
    other: Traveller,
    standing_steps: u32,
    wanted_mps: f64,
    manners: Manners,
) -> bool {
    // Over, or (where the paths merge) now simply somebody in front.
    let their_end = if crossing.merges { crossing.theirs.from + MERGED_M } else { crossing.theirs.to };
    if other.s_m > their_end {
        return false;
    }
    if other.s_m > crossing.theirs.from {
        return true;
    }
    if other.speed_mps < STANDING_MPS {
        // Both stand: the first in the list goes, the other when he has waited long enough.
        return crossing.other < crossing.me && me.speed_mps < STANDING_MPS && standing_steps < PATIENCE_STEPS;
    }
    let ahead = crossing.mine.from - me.s_m;
    let speed = me.speed_mps.max(0.5 * wanted_mps).max(STANDING_MPS);
    let my_entry = ahead.max(0.0) / speed;
    let my_exit = if crossing.merges { my_entry + MERGING_S } else { (crossing.mine.to - me.s_m) / speed };
    let way = crossing.theirs.from - other.s_m;
    // The earliest they can be there: v t + a t^2 / 2 = way.
    let a = THEIR_ACCELERATION_MPS2;
    let their_entry = ((other.speed_mps * other.speed_mps + 2.0 * a * way).sqrt() - other.speed_mps) / a;
    let their_exit = if crossing.merges {
        way / other.speed_mps + MERGING_S
    } else {
        (crossing.theirs.to - other.s_m) / other.speed_mps
    };
    if their_entry > HORIZON_S || my_entry > HORIZON_S {
        return false;
    }
    let clear_before = my_exit + manners.gap_s <= their_entry;
    let clear_behind = their_exit + 0.5 * manners.gap_s <= my_entry;
    !clear_before && !clear_behind
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Crosses the other's way from 20 to 26 m of both ways.
    const CROSSING: Crossing = Crossing {
        me: 1,
        other: 0,
        mine: Stretch { from: 20.0, to: 26.0 },
        theirs: Stretch { from: 20.0, to: 26.0 },
        merges: false,
        same_way: false,
    };

    fn waits(my_s: f64, their_s: f64) -> Option<f64> {
        let at = |s_m| Traveller { s_m, speed_mps: 10.0 };
        stop_distance(&CROSSING, at(my_s), at(their_s), 0, 10.0, Manners { gap_s: 1.0 })
    }

    #[test]
    fn who_comes_at_the_same_time_waits_and_who_has_a_second_to_spare_goes() {
        assert_eq!(waits(0.0, 0.0), Some(20.0));
        // Out after 2.6 s; the other, who may speed up by 1 m/s^2, is there after 3.6 s at the earliest with 42.5 m to go.
        assert_eq!(waits(0.0, 20.0 - 42.6), None);
        assert_eq!(waits(0.0, 20.0 - 42.0), Some(20.0));
        // Half a second behind the other's leaving.
        assert_eq!(waits(0.0, 11.1), None);
        assert_eq!(waits(0.0, 10.0), Some(20.0));
    }

    #[test]
    fn who_is_over_the_line_goes_on() {
        assert_eq!(waits(20.9, 15.0), Some(0.0));
        assert_eq!(waits(21.1, 15.0), None);
    }

    #[test]
    fn where_both_stand_the_later_one_loses_patience() {
        let at = |s_m| Traveller { s_m, speed_mps: 0.0 };
        let waits = |steps| must_wait(&CROSSING, at(18.0), at(18.0), steps, 10.0, Manners { gap_s: 1.0 });
        assert!(waits(29) && !waits(30));
    }
}
