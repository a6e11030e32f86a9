//! How the ego's speed comes to what it is at the contact.

use crate::ground::way::Ground;
use crate::pace::last::{BACKS_EARLIER_S, last_pace};
use crate::pace::lead::{self, Lead, MOVES_UP_M};
use crate::pace::plain::{
    Pace, SETS_OFF_MPS2, STANDING, STOPPING_MPS2, braked_hard, first_time, pace, start_over, starts_and_slows, when,
};
use crate::told::crash::Told;
use crate::told::doing::Doing;
use crate::told::phase::Phase;
use crate::told::side::{Turning, size_of};
use recrash_model::account::{ContactState, ControlDevice, Manner, Obeyed, Origin};
use recrash_model::scenario::{Act, Deed, Trigger};
use recrash_model::template::Movement;

/// Who stood behind the ego before it set off has stood for so long. [s]
const WAITED_S: f64 = 1.0;

/// Who leaves its line between two stands drives so far meanwhile. [m]
const SHIFTS_M: f64 = 6.0;

/// How long the ego has stood when somebody who came to a stop behind it sets off. [s]
const STOOD_LONG_S: f64 = 5.0;

/// Who stood already when the story begins has stood for so much longer than who came to a stop in it. [s]
const STOOD_LONGER_S: f64 = 3.0;

/// An ego that has come to a stop behind who then reverses has stood for so much longer: it stands before that. [s]
const STOOD_A_LITTLE_S: f64 = 1.0;

/// An ego that comes to a stop is seen rolling for so long. [s]
const LEAST_ROLL_S: f64 = 0.3;

/// What the ego did before its last phase where that is told, and its last pace.
pub(crate) fn ego_paces(told: &Told, ground: &Ground, sv_s_m: f64) -> (Option<Lead>, Pace) {
    let (sv, contact_s) = (&told.sv, told.contact_s);
    if told.stays_at_kerb() || told.stands_for_slow_backer() {
        return (None, STANDING);
    }
    let choices = &told.choices;
    let longer_s = choices.longer_s[0];
    let stood_s = longer_s
        + match told.waits_behind() {
            true => STOOD_LONG_S.max(contact_s - first_time(&last_pace(told).acts) + WAITED_S),
            // Whoever moved up behind it before it was thrown at it did so while the ego stood.
            false if told.is_thrown() && told.cp.phases.len() > 1 && sv.phases.is_empty() => contact_s,
            false if told.origin == Origin::Ahead && told.cp.state == ContactState::Reversing => {
                told.choices.stood_s + STOOD_A_LITTLE_S
            }
            false if told.origin == Origin::Ahead => told.choices.stood_s,
            false
                if told.stood_before
                    || told.passes_from_behind()
                    || told.comes_up_slowly()
                    || told.stops_behind_and_is_thrown() =>
            {
                told.choices.stood_s + STOOD_LONGER_S
            }
            false => told.choices.stood_s,
        };
    let stood_s = stood_s.min(contact_s - told.rolling_mps() / STOPPING_MPS2 - LEAST_ROLL_S);
    let stood_s = comes_over_line(told, ground, sv_s_m).map_or(stood_s, |most_s| stood_s.min(most_s));
    let stood_s = if told.backs_early { LEAST_STOOD_S } else { stood_s };
    let usual = from_line(told, ground, sv_s_m)
        .or_else(|| before_who_waits(told))
        .or_else(|| before_who_backs(told))
        .or_else(|| towards_who_stands(told))
        .or_else(|| out_of_line(told))
        .or_else(|| slows_in_turn(told, past_line_m(told, ground, sv_s_m)))
        .unwrap_or_else(|| braked_earlier(pace(contact_s, sv, told.rolling_mps(), stood_s), longer_s));
    // So does who slows behind one that brakes hard.
    let behind = told.origin == Origin::Ahead && told.cp.brakes_hard;
    let usual = if sv.brakes_hard || behind { braked_hard(usual) } else { usual };
    let begins_s = match sv.state.stands() {
        true => contact_s - choices.stood_s - longer_s,
        false if usual.speed_mps > 0.0 => return (None, usual),
        false => first_time(&usual.acts),
    };
    let moved_up_m = past_line_m(told, ground, sv_s_m).filter(|_| sv.state.stands()).unwrap_or(MOVES_UP_M);
    let least_m = if told.sv_aside().is_some() { SHIFTS_M } else { MOVES_UP_M };
    // Who moved up more than once did so by a part of that each time.
    let stood = sv.phases.iter().skip_while(|phase| **phase != Phase::Stands);
    let times = stood.filter(|phase| **phase == Phase::Drives).count().max(1) as f64;
    let waited_s = if sv.state.stands() { 0.0 } else { longer_s.max(0.0) };
    let lead = lead::lead(&sv.phases, begins_s, told.rolling_mps(), (moved_up_m / times).max(least_m), waited_s);
    match lead.map(|lead| if sv.came_hard { lead.came_hard() } else { lead }) {
        Some(lead) if sv.state.stands() => (Some(lead), STANDING),
        lead => (lead, usual),
    }
}

/// The same of who slows before the contact, so much earlier.
fn braked_earlier(pace: Pace, by_s: f64) -> Pace {
    let brakes = match pace.acts.as_slice() {
        [Act { when: Some(Trigger::TimeS(from_s)), deed: Deed::Speed { to_mps, .. }, .. }] => Some((*from_s, *to_mps)),
        _ => None,
    };
    let Some((from_s, to_mps)) = brakes.filter(|(from_s, to_mps)| *to_mps < pace.speed_mps && by_s < *from_s) else {
        return pace;
    };
    let by_s = by_s.max(0.0);
    let act = Act { when: Some(Trigger::TimeS(from_s - by_s)), ..pace.acts[0].clone() };
    Pace { acts: vec![act], driven_m: pace.driven_m - (pace.speed_mps - to_mps) * by_s, ..pace }
}

/// Who sets off before somebody who waited behind it does so earlier, and creeps.
fn before_who_waits(told: &Told) -> Option<Pace> {
    let (sv, contact_s) = (&told.sv, told.contact_s);
    if sv.state != ContactState::SettingOff || !told.waits_behind() {
        return None;
    }
    let moving_s = contact_s - first_time(&last_pace(told).acts) + told.head_start_s();
    start_over(contact_s, sv.speed_mps, sv.speed_mps * (moving_s - 0.5 * sv.speed_mps / SETS_OFF_MPS2))
}

/// Who sets off before the partner backs.
fn before_who_backs(told: &Told) -> Option<Pace> {
    let speed_mps = told.sv.speed_mps;
    if !told.backs_late || !(told.sv.stood_first || told.sv.state == ContactState::SettingOff) {
        return None;
    }
    let way_m = if told.cp.phases.is_empty() { REVERSES_M } else { SWINGS_LATE_M };
    let moving_s = 0.5 * told.cp.speed_mps / SETS_OFF_MPS2 + way_m / told.cp.speed_mps + BACKS_EARLIER_S;
    start_over(told.contact_s, speed_mps, speed_mps * (moving_s - 0.5 * speed_mps / SETS_OFF_MPS2))
}

/// Who stood and goes straight on to one that stands, or a thing, sets off from farther than it holds the place where they touch.
fn towards_who_stands(told: &Told) -> Option<Pace> {
    let sv = &told.sv;
    let ahead = told.cp.state.stands() && told.door.is_none() && told.origin != Origin::Behind;
    let enters = sv.movement == Some(Movement::EnteringTraffic);
    let straight = sv.state == ContactState::Moving && sv.turning == Turning::No && !enters;
    let plain = sv.stood_first && straight && ahead && sv.slowed_from.is_none() && sv.phases.is_empty();
    start_over(told.contact_s, sv.speed_mps, MOVES_UP_M).filter(|_| plain)
}

/// An ego that stood and leaves its line has driven so many times as far as it goes aside, so that it does not turn across the road; who has
/// just set off has done so for so long at most. [1, s]
const LEAVES_BY: f64 = 2.4;
const JUST_S: f64 = 5.5;

/// Who stood and leaves its line sets off from far enough for that.
fn out_of_line(told: &Told) -> Option<Pace> {
    let sv = &told.sv;
    let aside = told.sv_aside().filter(|aside| !aside.done)?;
    let sets_off = sv.state == ContactState::SettingOff;
    let stood = sets_off || sv.state == ContactState::Moving && (sv.stood_first || !sv.phases.is_empty());
    let least_m = LEAVES_BY * (aside.to_t_m - aside.from_t_m).abs();
    let just_m = sv.speed_mps * (JUST_S - 0.5 * sv.speed_mps / SETS_OFF_MPS2);
    let driven_m = if sets_off { least_m.min(just_m) } else { least_m };
    let usual_m = pace(told.contact_s, sv, told.rolling_mps(), told.choices.stood_s).driven_m;
    let plain = stood && sv.slowed_from.is_none() && driven_m > usual_m;
    start_over(told.contact_s, sv.speed_mps, driven_m).filter(|_| plain)
}

/// How far behind the stop line of a junction the ego is. [m]
fn past_line_m(told: &Told, ground: &Ground, sv_s_m: f64) -> Option<f64> {
    ground.junction.then(|| sv_s_m - (ground.first_m() - 0.5 * size_of(&told.sv).0 - AT_LINE_M))
}

/// How long an ego that has come to a stop in a junction may have stood there, so that it is seen to come over its stop line. [s]
fn comes_over_line(told: &Told, ground: &Ground, sv_s_m: f64) -> Option<f64> {
    let past_m = past_line_m(told, ground, sv_s_m).filter(|past_m| *past_m > 0.0)?;
    let rolling_mps = told.rolling_mps();
    let most_s = told.contact_s - 0.5 * rolling_mps / STOPPING_MPS2 - (past_m + BEFORE_LINE_M) / rolling_mps;
    (most_s > LEAST_STOOD_S).then_some(most_s)
}

/// It comes along for so long before its stop line at least, and has stood for so long. [m, s]
const BEFORE_LINE_M: f64 = 3.0;
const LEAST_STOOD_S: f64 = 1.2;

/// How far somebody has reversed at the contact; and who came along, and begins to when the ego has set off. [m]
pub(crate) const REVERSES_M: f64 = 2.5;
pub(crate) const SWINGS_LATE_M: f64 = 4.5;

/// Who stood before a junction, and is in it at the contact, sets off from its stop line.
fn from_line(told: &Told, ground: &Ground, sv_s_m: f64) -> Option<Pace> {
    let sv = &told.sv;
    let stops = match sv.control.filter(|said| said.obeyed != Some(Obeyed::No)) {
        // Who slows for a sign and is not told to have stood or come past it has yet to come to it.
        Some(said) => {
            let on_its_way = told.origin == Origin::Behind || said.obeyed.is_none() && !sv.enters();
            let yet_to_stop = on_its_way && sv.slowed_from.is_some();
            let at_sign = said.device == ControlDevice::StopSign && !yet_to_stop;
            sv.state == ContactState::SettingOff || sv.stood_first || at_sign
        }
        // Who sets off and comes into the junction did so from before it; so did who stood where all do.
        None => sv.stood_first || sv.state == ContactState::SettingOff && (told.enters() || told.all_way),
    };
    let stops = stops && matches!(sv.state, ContactState::SettingOff | ContactState::Moving);
    let driven_m = past_line_m(told, ground, sv_s_m).filter(|_| stops)?;
    // Who slows again before it has come so far stood behind others, and not at the line.
    let slows = sv.slowed_from.and_then(|_| starts_and_slows(told.contact_s, sv.speed_mps, driven_m));
    slows.or_else(|| start_over(told.contact_s, sv.speed_mps, driven_m))
}

/// Who stops at a line stops so far before it. [m]
pub(crate) const AT_LINE_M: f64 = 0.5;

/// Speeds in a turn to what is met at the end of it, changes of speed, and how long somebody is seen before it sets off. [m/s, m/s^2, s]
const TURNS_MPS: [f64; 4] = [3.0, 4.0, 5.0, 6.0];
const GAINS_MPS2: f64 = 1.6;
const SLOWS_MPS2: f64 = 1.5;
const SEEN_S: f64 = 1.0;

/// Who turns to what it meets at the edge of the road that it enters, or across it, and is slow there, has been faster in its turn: it comes along, or
/// from its stop line where it stood.
fn slows_in_turn(told: &Told, past_line_m: Option<f64>) -> Option<Pace> {
    let (sv, end_s) = (&told.sv, told.contact_s);
    let turns = (told.edge.is_some() || told.stands_across() || told.at_entrance)
        && matches!(sv.turning, Turning::Left | Turning::Right);
    let line_m = past_line_m.filter(|_| turns && sv.state == ContactState::Moving && sv.phases.is_empty())?;
    let slows = |from_mps: f64| {
        let over_s = (from_mps - sv.speed_mps) / SLOWS_MPS2;
        let brake = when(end_s - over_s, Deed::Speed { to_mps: sv.speed_mps, rate_mps2: SLOWS_MPS2 });
        (over_s, 0.5 * (from_mps + sv.speed_mps) * over_s, brake)
    };
    let faster = TURNS_MPS.into_iter().filter(|mps| *mps > sv.speed_mps);
    if !sv.stood_first {
        if sv.speed_mps * end_s > line_m {
            return None;
        }
        return faster.into_iter().find_map(|from_mps| {
            let (over_s, over_m, brake) = slows(from_mps);
            let driven_m = from_mps * (end_s - over_s) + over_m;
            (driven_m > line_m).then(|| Pace { speed_mps: from_mps, acts: vec![brake], driven_m })
        });
    }
    faster.into_iter().find_map(|most_mps| {
        let (over_s, over_m, brake) = slows(most_mps);
        let gaining_s = most_mps / GAINS_MPS2;
        let holds_m = line_m - over_m - 0.5 * most_mps * gaining_s;
        let from_s = end_s - over_s - gaining_s - holds_m / most_mps;
        let go = when(from_s, Deed::Speed { to_mps: most_mps, rate_mps2: GAINS_MPS2 });
        (holds_m > 0.0 && from_s > SEEN_S).then(|| Pace { speed_mps: 0.0, acts: vec![go, brake], driven_m: line_m })
    })
}

/// Who backs no faster than this takes all the time that there is. [m/s]
const SLOW_BACKER_MPS: f64 = 0.6;

impl Told {
    /// How fast an ego came along that comes to a stop. [m/s]
    pub(crate) fn rolling_mps(&self) -> f64 {
        self.sv.rolled_mps.unwrap_or(self.choices.rolling_mps)
    }

    /// Whether the ego is told to have stood before the partner began to back, which does so very slowly: it has stood there from the start.
    fn stands_for_slow_backer(&self) -> bool {
        let backs = self.cp.state == ContactState::Reversing && self.cp.speed_mps <= SLOW_BACKER_MPS;
        let plain = self.sv.phases.is_empty() && self.cp.phases.is_empty() && self.sv.state == ContactState::Stopped;
        backs && plain && self.sv.stands_from_start && self.stood_before
    }

    /// Whether the partner is told to have come to a stop behind an ego that stood, and was thrown against it then.
    fn stops_behind_and_is_thrown(&self) -> bool {
        let stops = |doing: &Doing| doing.comes_to_stand() && doing.is_behind_other();
        self.is_thrown() && self.sv.state.stands() && self.cp.acts.iter().any(stops)
    }

    /// Whether the partner is told to have come up slowly behind an ego that stands: that has stood for long.
    fn comes_up_slowly(&self) -> bool {
        let slow = self.cp.manner == Some(Manner::Slow) && self.cp.state == ContactState::Moving;
        self.origin == Origin::Behind && slow && self.sv.state.stands()
    }
}
