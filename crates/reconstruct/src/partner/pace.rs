//! How the partner's speed comes to what it is at the contact.

use crate::ego::pace::{AT_LINE_M, REVERSES_M, SWINGS_LATE_M, ego_paces};
use crate::ground::pieces::corner_m;
use crate::pace::last::{BACKS_EARLIER_S, BEHIND_M, FOLLOWS_S, last_pace};
use crate::pace::lead::{self, Lead, MOVES_UP_M};
use crate::pace::plain::{
    Pace, SETS_OFF_MPS2, STANDING, braked_hard, first_time, sets_off, slows, slows_abreast, start_after, start_over,
    stops_over, when,
};
use crate::partner::beside::{self, PULL_OUT_M};
use crate::told::crash::Told;
use crate::told::doing::Doing;
use crate::told::others::Role;
use crate::told::phase::Phase;
use crate::told::queue::CREEPS_MPS;
use crate::told::side::{Turning, size_of};
use crate::told::things::{DROPPED_MPS2, DROPPED_S};
use crate::told::zones::side_of;
use crate::touch::lanes;
use crate::touch::staging::Staging;
use crate::usual::STOOD_S;
use recrash_model::account::{ContactState, LeftRight, Origin, Striker};
use recrash_model::math;
use recrash_model::scenario::Deed;
use recrash_model::template::Movement;

/// What the partner did before its last phase where that is told, or follows from what the ego did; and its last pace.
pub(super) fn partner_paces(told: &Told, staging: &Staging) -> (Option<Lead>, Pace) {
    let (lead, last) = usual_paces(told, staging);
    let lead = lead.map(|lead| if told.cp.came_hard { lead.came_hard() } else { lead });
    (lead, if told.cp.brakes_hard { braked_hard(last) } else { last })
}

/// The same, where it brakes as is usual.
fn usual_paces(told: &Told, staging: &Staging) -> (Option<Lead>, Pace) {
    let (cp, contact_s) = (&told.cp, told.contact_s);
    let (ego_lead, ego) = ego_paces(told, &staging.ground, staging.sv_s_m);
    let ego_m = ego.driven_m + ego_lead.as_ref().map_or(0.0, Lead::driven_m);
    let backs_last = told.sv.state == ContactState::Reversing;
    let ego_backs_s = ego_lead.as_ref().and_then(|lead| lead.backs_s).or(backs_last.then(|| first_time(&ego.acts)));
    let ego_moves_s = ego_lead.as_ref().and_then(Lead::sets_off_s).unwrap_or_else(|| first_time(&ego.acts));
    let ego_backs_s = ego_backs_s.filter(|_| told.backs_first == Some(Striker::Cp));
    let ego_brakes_s = ego_lead.as_ref().filter(|lead| lead.speed_mps > 0.0).map(|lead| first_time(&lead.acts));
    let before_s = match (told.backs_early, ego_brakes_s.filter(|_| told.backs_as_it_comes)) {
        (_, Some(brakes_s)) => Some(brakes_s),
        (true, None) => Some(ego_moves_s),
        (false, None) => ego_backs_s,
    };
    let last = thing_pace(told)
        .or_else(|| beside_from_line(told, staging))
        .or_else(|| cross_from_line(told, staging))
        .or_else(|| cross_from_stalls(told, staging))
        .or_else(|| beside::from_kerb(told, staging))
        .or_else(|| beside::runs_out(told, staging))
        .unwrap_or_else(|| partner_pace(told, staging, &EgoWay { pace: &ego, driven_m: ego_m, before_s }));
    // Who stands behind an ego that came along, stood and backs came along behind it.
    let came_m = ego_lead.as_ref().filter(|lead| lead.speed_mps > 0.0 && backs_last).map(Lead::driven_m);
    let came_m = came_m.map(|came_m| came_m - ego.driven_m + CAME_BEHIND_M);
    let behind = told.origin == Origin::Behind && cp.state == ContactState::Stopped && cp.phases.is_empty();
    if let Some(came_m) = came_m.filter(|came_m| behind && *came_m > last.driven_m) {
        return (None, stops_over(told.choices.rolling_mps, came_m).unwrap_or(last));
    }
    let stands = cp.state.stands();
    if last.speed_mps > 0.0 && !stands {
        return (None, last);
    }
    let waited_s = told.choices.longer_s[1];
    let begins_s = if stands { contact_s - STOOD_S - waited_s } else { first_time(&last.acts) };
    let waited_s = if stands { 0.0 } else { waited_s };
    // Who waited behind an ego that came along came along behind it.
    let ego_came = ego.speed_mps > 0.0 || ego_lead.as_ref().is_some_and(|lead| lead.speed_mps > 0.0);
    let came_behind = [Phase::Drives, Phase::Stands, Phase::Drives];
    let phases: &[Phase] = match told.waits_behind() && cp.phases.is_empty() && ego_came && ego_m > last.driven_m {
        true => &came_behind,
        false => &cp.phases,
    };
    let lead = |longer_s: f64| lead::lead(phases, begins_s, told.choices.rolling_mps, MOVES_UP_M, longer_s + waited_s);
    let Some(usual) = lead(0.0) else { return (None, last) };
    let last = if stands { STANDING } else { last };
    // Who is ahead came ahead of the ego, and stopped before it did.
    let driven_m = usual.driven_m() + if cp.state == ContactState::Reversing { -last.driven_m } else { last.driven_m };
    let past_m = driven_m - ego_m + AHEAD_M;
    match told.origin == Origin::Ahead && usual.speed_mps > 0.0 && past_m > 0.0 {
        true => (lead(past_m / usual.speed_mps), last),
        false => (Some(usual), last),
    }
}

/// What the ego does until the contact: its last pace, how far it drives in all, and when it begins what the partner backs before. [m, s]
struct EgoWay<'a> {
    pace: &'a Pace,
    driven_m: f64,
    before_s: Option<f64>,
}

/// How the partner's speed comes to what it is at the contact, from its last stand where it stood.
fn partner_pace(told: &Told, staging: &Staging, ego: &EgoWay<'_>) -> Pace {
    if let Some(pace) = sets_off_behind(told, ego) {
        return pace;
    }
    let (cp, contact_s, usual) = (&told.cp, told.contact_s, last_pace(told));
    let ahead = told.origin == Origin::Ahead && usual.driven_m > ego.driven_m - 0.3;
    let enters = cp.movement == Some(Movement::EnteringTraffic);
    match cp.state {
        ContactState::Moving if told.gives_way_to_merge && cp.speed_mps < ego.pace.speed_mps - 1.0 => {
            slows_abreast(contact_s, cp.speed_mps, ego.pace)
        }
        ContactState::Moving if told.brakes_late() => slows(contact_s, cp),
        ContactState::Moving if told.slows_as_ego_does() && usual.driven_m < ego.driven_m + 5.0 => {
            slows_with(ego.pace, contact_s, cp.speed_mps)
        }
        // Who is ahead and slower has not come from behind the ego: it has just set off.
        ContactState::Moving if ahead => sets_off(contact_s, cp.speed_mps, (0.8 * ego.driven_m).max(0.2)),
        ContactState::Reversing => {
            start_over(contact_s, cp.speed_mps, backs_m(told, staging, ego.before_s)).unwrap_or(usual)
        }
        // Who comes from the kerb or out of a stall stood there.
        ContactState::Moving if told.stood_beside() || enters && from_stand(told) => {
            let moving_s = (2.0 * out_m(told, staging) / cp.speed_mps * 10.0).round() / 10.0;
            let go = Deed::Speed { to_mps: cp.speed_mps, rate_mps2: cp.speed_mps / moving_s };
            Pace { speed_mps: 0.0, acts: vec![when(contact_s - moving_s, go)], driven_m: 0.5 * cp.speed_mps * moving_s }
        }
        // Who stood and turned has room for its turn.
        ContactState::Moving if cp.stood_first && matches!(cp.turning, Turning::Left | Turning::Right) => {
            let from_line =
                turn_from_line_m(told, staging).and_then(|way_m| start_over(contact_s, cp.speed_mps, way_m));
            from_line.or_else(|| start_over(contact_s, cp.speed_mps, TURNS_M)).unwrap_or(usual)
        }
        ContactState::Stopped if ahead => STANDING,
        // It stood before the story begins.
        ContactState::Stopped if cp.stands_from_start && told.origin != Origin::Behind => STANDING,
        // Who sets off has room to leave its line.
        ContactState::Moving | ContactState::SettingOff if usual.speed_mps == 0.0 && !told.waits_behind() => {
            let room_m = beside::room_m(told, staging);
            let more = start_over(contact_s, cp.speed_mps, room_m).filter(|_| room_m > usual.driven_m);
            more.unwrap_or(usual)
        }
        _ => usual,
    }
}

/// Who waited behind the ego sets off after it, from behind where it stood.
fn sets_off_behind(told: &Told, ego: &EgoWay<'_>) -> Option<Pace> {
    let (cp, contact_s, way_m) = (&told.cp, told.contact_s, ego.driven_m + BEHIND_M);
    if !told.waits_behind() {
        return None;
    }
    let follows = told.sv.state == ContactState::Moving && ego.pace.speed_mps == 0.0;
    let ego_s = contact_s - first_time(&ego.pace.acts);
    let after = follows.then(|| start_after(contact_s, cp.speed_mps, way_m, ego_s - FOLLOWS_S)).flatten();
    // Behind one that has come into the junction since it stood behind where that did.
    let moved_up = told.sv.phases == [Phase::Stands, Phase::Drives, Phase::Stands] && told.sv.enters();
    let comes = moved_up && cp.state != ContactState::Reversing;
    after.or_else(|| comes.then(|| start_over(contact_s, cp.speed_mps, way_m)).flatten())
}

/// Slows with an ego that it follows, and brakes after that does.
fn slows_with(ego: &Pace, contact_s: f64, to_mps: f64) -> Pace {
    let from_mps = (ego.speed_mps + FOLLOWS_BY_MPS).max(to_mps);
    let braking_s = (contact_s - first_time(&ego.acts) - BRAKES_LATER_S).max(LEAST_BRAKING_S);
    let brake = Deed::Speed { to_mps, rate_mps2: ((from_mps - to_mps) / braking_s).max(0.05) };
    let driven_m = from_mps * (contact_s - braking_s) + 0.5 * (from_mps + to_mps) * braking_s;
    Pace { speed_mps: from_mps, acts: vec![when(contact_s - braking_s, brake)], driven_m }
}

/// By how much the partner has turned since it left its line. [rad]
fn turned_rad(staging: &Staging) -> f64 {
    math::wrap_angle(staging.cp.heading - staging.cp_came).abs()
}

/// How far a partner has backed at the contact: out of where it stood, and for longer where it began to before the ego did something. [m]
fn backs_m(told: &Told, staging: &Staging, before_s: Option<f64>) -> f64 {
    let cp = &told.cp;
    let turn = turned_rad(staging);
    let swings = turn > SWINGS_RAD;
    let way_m = match told.origin {
        _ if cp.backs_in => BACKS_IN_M,
        Origin::Stall { .. } => beside::out_m(told, staging).max(LEAST_OUT_M).max(LEAST_BACK_M * turn),
        Origin::Driveway { .. } => beside::out_m(told, staging).max(BACKS_OUT_M),
        // It has no more time for that.
        _ if told.backs_late && !cp.phases.is_empty() => SWINGS_LATE_M,
        _ if swings && !cp.phases.is_empty() => SWINGS_BACK_M.max(LEAST_BACK_M * turn),
        _ => REVERSES_M.max(LEAST_BACK_M * turn),
    };
    let backing_s = before_s.map_or(0.0, |from_s| told.contact_s - from_s + BACKS_EARLIER_S);
    let longer_m = cp.speed_mps * (backing_s - 0.5 * cp.speed_mps / SETS_OFF_MPS2);
    // Nobody stood deeper than in its stall.
    let most_m = match told.origin {
        Origin::Stall { .. } => way_m.max(beside::out_m(told, staging) + IN_STALL_M),
        _ => f64::INFINITY,
    };
    way_m.max(longer_m).min(most_m)
}

/// How far a partner has driven at the contact out of where it stood beside the lanes. [m]
fn out_m(told: &Told, staging: &Staging) -> f64 {
    let cp = &told.cp;
    match told.origin {
        Origin::Driveway { .. } => beside::out_m(told, staging).max(PULL_OUT_M),
        // It has come no farther than out of its stall, but where it gains speed, or turns, on that.
        Origin::Stall { .. } => {
            let gains_m = 0.5 * cp.speed_mps * cp.speed_mps / NOSES_OUT_MPS2;
            let aside_m = if cp.aside.is_some() { ASIDE_OUT_M } else { 0.0 };
            beside::out_m(told, staging).max(gains_m).max(LEAST_BACK_M * turned_rad(staging)).max(aside_m)
        }
        _ => PULL_OUT_M,
    }
}

/// How far somebody who stood before it turned has driven at the contact. [m]
const TURNS_M: f64 = 8.0;

/// Who came along ahead of the ego was so much farther ahead than it is at the contact, at least. [m]
const AHEAD_M: f64 = 1.0;

/// Who backs out of a driveway has done so for so far, out of a stall for so far; in that it stood no deeper than in its middle by so much; who
/// drives out of it, and goes aside, has done so for so far, and gains speed by no more than this. [m, m/s^2]
const BACKS_OUT_M: f64 = 4.5;
const LEAST_OUT_M: f64 = 0.8;
const IN_STALL_M: f64 = 1.0;
const ASIDE_OUT_M: f64 = 3.4;
const NOSES_OUT_MPS2: f64 = 2.5;

/// Who came along the road, and turned by more than this while it reversed, has reversed so far. [rad, m]
const SWINGS_RAD: f64 = 0.2;
const SWINGS_BACK_M: f64 = 6.0;

/// Nobody backs on a tighter circle. [m]
const LEAST_BACK_M: f64 = 5.0;

/// Whether somebody that enters traffic did so from a stand; not who is told to have come along ahead of the ego, or beside it.
fn from_stand(told: &Told) -> bool {
    let comes = matches!(told.origin, Origin::Cross { .. } | Origin::Behind | Origin::Opposite);
    !comes && !told.rolls_out() && !told.came_along_there()
}

/// Who follows an ego that slows brakes so long after it, for so long at least. [s]
const BRAKES_LATER_S: f64 = 0.6;
const LEAST_BRAKING_S: f64 = 0.4;

/// Who follows an ego that slows is faster than it by so much before. [m/s]
const FOLLOWS_BY_MPS: f64 = 1.0;

/// Who stood beside the ego before a junction sets off from the same line.
fn beside_from_line(told: &Told, staging: &Staging) -> Option<Pace> {
    let (cp, ground) = (&told.cp, &staging.ground);
    if !cp.stood_first || !ground.junction || !matches!(told.origin, Origin::Beside { .. }) {
        return None;
    }
    let line_m = ground.first_m() - 0.5 * size_of(cp).0 - AT_LINE_M;
    start_over(told.contact_s, cp.speed_mps, ground.beside(staging.cp.position).0 - line_m)
}

/// Who stood at a signal or a sign on the crossing road, or where all stop, or has come into the junction since, sets off from its stop line.
fn cross_from_line(told: &Told, staging: &Staging) -> Option<Pace> {
    let (cp, ground) = (&told.cp, &staging.ground);
    let Origin::Cross { side } = told.origin else { return None };
    let stood = cp.stood_first || cp.state == ContactState::SettingOff;
    let at_line = cp.control.is_some() || cp.enters() || told.all_way;
    if !stood || !at_line || !ground.junction || cp.state == ContactState::Reversing {
        return None;
    }
    let line_m = corner_m(ground.lanes) + AT_LINE_M + 0.5 * size_of(cp).0;
    let left_m = staging.cp.position.y - ground.centre_y_m();
    let to_line_m = if side == LeftRight::Left { line_m - left_m } else { line_m + left_m };
    start_over(told.contact_s, cp.speed_mps, to_line_m)
}

/// Who crosses a lot where no road crosses it sets off from among the stalls of its side.
fn cross_from_stalls(told: &Told, staging: &Staging) -> Option<Pace> {
    let lot = told.place.is_lot() && !staging.ground.junction;
    let drives = told.comes_along_lanes() && told.cp.state == ContactState::Moving;
    // Who is told to pass comes along.
    let passes = told.cp.acts.iter().any(Doing::is_pass);
    let crosses = lot && drives && !passes && matches!(told.origin, Origin::Cross { .. });
    crosses.then(|| start_over(told.contact_s, told.cp.speed_mps, beside::out_m(told, staging))).flatten()
}

/// How far it is from the stop line of who stood at the junction, across from the ego or on the crossing road, to where it touches in its
/// turn. [m]
fn turn_from_line_m(told: &Told, staging: &Staging) -> Option<f64> {
    let (cp, ground) = (&told.cp, &staging.ground);
    let line_m = corner_m(ground.lanes) + AT_LINE_M + 0.5 * size_of(cp).0;
    let left_m = staging.cp.position.y - ground.centre_y_m();
    let along_m = match told.origin {
        _ if !ground.junction => return None,
        Origin::Opposite => line_m - staging.cp.position.x,
        Origin::Cross { side: LeftRight::Left } => line_m - left_m,
        Origin::Cross { side: LeftRight::Right } => line_m + left_m,
        _ => return None,
    };
    let turn = math::wrap_angle(staging.cp.heading - staging.cp_came).abs();
    let (sine, radius_m) = (math::sin(turn), lanes::turn_m(told));
    (along_m > radius_m * sine).then_some(along_m + radius_m * (turn - sine))
}

/// Who came along behind the ego was so far behind it. [m]
const CAME_BEHIND_M: f64 = 4.0;

/// From how far away it does. [m]
const SLIDES_M: f64 = 4.0;

/// The same from the edge of the ego's lane, and how much farther to its other side. [m]
const FROM_EDGE_M: f64 = 1.5;
const TO_FAR_SIDE_M: f64 = 0.7;

/// The pace of a thing, or of who comes across on foot: it lies or stands aside, and then comes; or it comes off the vehicle ahead.
fn thing_pace(told: &Told) -> Option<Pace> {
    if let Some(dropped) = told.dropped_pace() {
        return Some(dropped);
    }
    // From the lane's edge where somebody drives in the next one.
    let abreast = told.extras.iter().any(|extra| matches!(extra.role, Role::Abreast | Role::Beside));
    let far = match (told.origin, side_of(&told.sv.zones)) {
        (Origin::Beside { side }, Some(touched)) => side != touched,
        _ => false,
    };
    let way_m = match abreast && told.thing.is_some() {
        true => FROM_EDGE_M + if far { TO_FAR_SIDE_M } else { 0.0 },
        false => SLIDES_M,
    };
    told.comes_across().then(|| start_over(told.contact_s, told.cp.speed_mps, way_m)).flatten()
}

/// How far somebody has backed into a space at the kerb at the contact. [m]
const BACKS_IN_M: f64 = 7.5;

impl Told {
    /// Whether the partner came up behind an ego that stands and braked, but not enough: it is told to be this slow when they touch, and
    /// not that it had stood.
    fn brakes_late(&self) -> bool {
        let slow = self.cp.impact_mps.is_some_and(|mps| mps < CREEPS_MPS);
        self.origin == Origin::Behind
            && self.cp.state == ContactState::Moving
            && !self.cp.stood_first
            && !self.cp.gains
            && self.cp.phases.is_empty()
            && self.sv.state.stands()
            && slow
    }

    /// Whether the partner slows with an ego that it follows, or is beside: not who stood, nor whom the ego passes, has come along behind it.
    fn slows_as_ego_does(&self) -> bool {
        let follows = matches!(self.origin, Origin::Behind | Origin::Beside { .. }) && self.ahead != Some(true);
        let passed = self.sv.acts.iter().any(Doing::is_pass);
        self.sv.slowed_from.is_some() && follows && !self.sv.reacts && !self.cp.stood_first && !passed
    }

    /// The pace of what falls off the vehicle ahead: it comes along as fast as the ego, and slides.
    fn dropped_pace(&self) -> Option<Pace> {
        let (from_mps, to_mps) = (self.sv.speed_mps, self.dropped_mps()?);
        let sliding_s = (from_mps - to_mps) / DROPPED_MPS2;
        let slows = Deed::Speed { to_mps, rate_mps2: DROPPED_MPS2 };
        let on_m = from_mps * (self.contact_s - DROPPED_S) + to_mps * (DROPPED_S - sliding_s);
        let driven_m = on_m + 0.5 * (from_mps + to_mps) * sliding_s;
        Some(Pace { speed_mps: from_mps, acts: vec![when(self.contact_s - DROPPED_S, slows)], driven_m })
    }
}
