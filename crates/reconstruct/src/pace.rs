//! How the speed of each of the two comes to what it is at the contact.

use crate::acts::Doing;
use crate::ground::{Ground, corner_m};
use crate::kerb;
use crate::lateral::{self, PULL_OUT_M};
use crate::phases::{self, Lead, MOVES_UP_M, Phase};
use crate::roadside;
use crate::side::{Side, Turning};
use crate::speeds::WALKS_MPS;
use crate::things;
use crate::told::Told;
use crate::touch::{Staging, size_of};
use recrash_model::account::{
    Account, Act as Done, ContactState, ControlDevice, LeftRight, Manner, Obeyed, Origin, Party, Source, Striker,
};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::STEP_S;
use recrash_model::scenario::{Act, Deed, Trigger};
use recrash_model::template::Movement;

/// Deceleration of who comes to a stop before it is hit. [m/s^2]
pub(crate) const STOPPING_MPS2: f64 = 2.0;

/// How long others who stopped have stood when they are hit. [s]
pub(crate) const STOOD_S: f64 = 2.0;

/// Acceleration of who sets off. [m/s^2]
const SETS_OFF_MPS2: f64 = 1.2;

/// Acceleration of who stood before, and is under way at the contact. [m/s^2]
const STARTS_MPS2: f64 = 1.6;

/// Speed of others on their way to a stop. [m/s]
pub(crate) const ROLLING_MPS: f64 = 7.0;

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

/// Nobody takes longer to set off. [s]
const LONGEST_START_S: f64 = 6.0;

/// The speeds of one side until the contact: speed at the start, acts, and what is driven until then. [m/s, m]
#[derive(Clone)]
pub(crate) struct Pace {
    pub(crate) speed_mps: f64,
    pub(crate) acts: Vec<Act>,
    pub(crate) driven_m: f64,
}

/// Stands from the start.
pub(crate) const STANDING: Pace = Pace { speed_mps: 0.0, acts: Vec::new(), driven_m: 0.0 };

pub(crate) fn when(time_s: f64, deed: Deed) -> Act {
    Act { id: None, when: Some(Trigger::TimeS(time_s)), delay_s: 0.0, deed }
}

pub(crate) fn next(deed: Deed) -> Act {
    Act { id: None, when: None, delay_s: 0.0, deed }
}

/// Who is told to be slow is no faster than this: in a lot, a garage or a driveway, and elsewhere. [m/s]
const SLOWLY_MPS: (f64, f64) = (2.0, 2.8);

/// Who is told to be fast drives so many times as fast as is posted, or as is usual where nothing is, and faster by so much at most.
/// [m/s]
const FAST_SHARE: f64 = 1.4;
const FASTER_BY_MPS: f64 = 9.0;
const FAST_MPS: (f64, f64) = (5.0, 11.2);

/// A usual speed at the contact, as far as words tell how fast somebody drove.
pub(crate) fn as_told(manner: Option<Manner>, usual_mps: f64, in_lot: bool, posted_mps: Option<f64>) -> f64 {
    let of = |(lot, road): (f64, f64)| if in_lot { lot } else { road };
    match manner {
        None => usual_mps,
        Some(Manner::Slow) => usual_mps.min(of(SLOWLY_MPS)),
        Some(Manner::Fast) => {
            let allowed_mps = posted_mps.unwrap_or(of(FAST_MPS));
            usual_mps.max((FAST_SHARE * allowed_mps).min(allowed_mps + FASTER_BY_MPS))
        }
    }
}

/// For sentences.
pub(crate) const fn manner_words(manner: Option<Manner>) -> &'static str {
    match manner {
        None => "",
        Some(Manner::Slow) => ", as it is told to be slow",
        Some(Manner::Fast) => ", as it is told to be fast",
    }
}

/// What the ego did before its last phase where that is told, and its last pace.
pub(crate) fn ego_paces(told: &Told, ground: &Ground, sv_s_m: f64) -> (Option<Lead>, Pace) {
    let (sv, contact_s) = (&told.sv, told.contact_s);
    if told.stays_at_kerb() {
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
            false if told.stood_before || told.passes_from_behind() || told.comes_up_slowly() => {
                told.choices.stood_s + STOOD_LONGER_S
            }
            false => told.choices.stood_s,
        };
    let stood_s = stood_s.min(contact_s - told.choices.rolling_mps / STOPPING_MPS2 - LEAST_ROLL_S);
    let stood_s = comes_over_line(told, ground, sv_s_m).map_or(stood_s, |most_s| stood_s.min(most_s));
    let stood_s = if told.backs_early { LEAST_STOOD_S } else { stood_s };
    let usual = from_line(told, ground, sv_s_m)
        .or_else(|| before_who_waits(told))
        .or_else(|| before_who_backs(told))
        .or_else(|| towards_who_stands(told))
        .or_else(|| out_of_line(told, ground))
        .or_else(|| roadside::slows_in_turn(told, past_line_m(told, ground, sv_s_m)))
        .unwrap_or_else(|| braked_earlier(pace(contact_s, sv, told.choices.rolling_mps, stood_s), longer_s));
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
    match phases::lead(&sv.phases, begins_s, choices.rolling_mps, (moved_up_m / times).max(least_m), waited_s) {
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

/// How far somebody goes until it touches the one that it waited behind, which set off earlier, and creeps. [m]
fn catches_up_m(told: &Told) -> f64 {
    let (ego_mps, cp_mps) = (told.sv.speed_mps, told.cp.speed_mps);
    let head_m = ego_mps * (0.5 * (cp_mps - ego_mps) / SETS_OFF_MPS2 + told.head_start_s()) + BEHIND_M;
    (head_m / (1.0 - ego_mps / cp_mps).max(0.1)).max(MOVES_UP_M)
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
    let moving_s = 0.5 * told.cp.speed_mps / SETS_OFF_MPS2 + REVERSES_M / told.cp.speed_mps + BACKS_EARLIER_S;
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
fn out_of_line(told: &Told, ground: &Ground) -> Option<Pace> {
    let sv = &told.sv;
    let aside = told.sv_aside().filter(|aside| !aside.done && ground.drift.is_none())?;
    let sets_off = sv.state == ContactState::SettingOff;
    let stood = sets_off || sv.state == ContactState::Moving && (sv.stood_first || !sv.phases.is_empty());
    let least_m = LEAVES_BY * (aside.to_t_m - aside.from_t_m).abs();
    let just_m = sv.speed_mps * (JUST_S - 0.5 * sv.speed_mps / SETS_OFF_MPS2);
    let driven_m = if sets_off { least_m.min(just_m) } else { least_m };
    let usual_m = pace(told.contact_s, sv, told.choices.rolling_mps, told.choices.stood_s).driven_m;
    let plain = stood && sv.slowed_from.is_none() && driven_m > usual_m;
    start_over(told.contact_s, sv.speed_mps, driven_m).filter(|_| plain)
}

/// Who waited behind somebody sets off so long after it, or before it where that is told. [s]
const FOLLOWS_S: f64 = 0.5;

/// How far behind the stop line of a junction the ego is. [m]
fn past_line_m(told: &Told, ground: &Ground, sv_s_m: f64) -> Option<f64> {
    ground.junction.then(|| sv_s_m - (ground.first_m() - 0.5 * size_of(&told.sv).0 - AT_LINE_M))
}

/// How long an ego that has come to a stop in a junction may have stood there, so that it is seen to come over its stop line. [s]
fn comes_over_line(told: &Told, ground: &Ground, sv_s_m: f64) -> Option<f64> {
    let past_m = past_line_m(told, ground, sv_s_m).filter(|past_m| *past_m > 0.0)?;
    let rolling_mps = told.choices.rolling_mps;
    let most_s = told.contact_s - 0.5 * rolling_mps / STOPPING_MPS2 - (past_m + BEFORE_LINE_M) / rolling_mps;
    (most_s > LEAST_STOOD_S).then_some(most_s)
}

/// It comes along for so long before its stop line at least, and has stood for so long. [m, s]
const BEFORE_LINE_M: f64 = 3.0;
const LEAST_STOOD_S: f64 = 1.2;

impl Told {
    /// How much earlier than the partner that waited behind it the ego sets off: less than nothing where it is told to have done so after that. [s]
    fn head_start_s(&self) -> f64 {
        let behind = self.sv.acts.iter().any(|doing| doing.sets_off_behind(&self.cp.acts));
        if behind { -FOLLOWS_S } else { FOLLOWS_S }
    }

    /// Whether the partner stood behind the ego and set off then.
    fn waits_behind(&self) -> bool {
        let stood = self.cp.state == ContactState::SettingOff || self.cp.stood_first || self.queues();
        self.origin == Origin::Behind && (stood || self.creeps_up())
    }

    /// Whether the partner crept into an ego that stands: it gained speed, and is told to have been this slow when they touch. It has come
    /// to a stop behind that before.
    fn creeps_up(&self) -> bool {
        let slow = self.cp.impact_mps.is_some_and(|mps| mps < CREEPS_MPS) && self.cp.gains;
        slow && self.cp.state == ContactState::Moving && self.cp.phases.is_empty() && self.sv.state.stands()
    }

    /// Whether the partner stood behind the ego and goes round it.
    pub(crate) fn comes_round_from_stand(&self) -> bool {
        let aside = self.comes_round_ego() || self.cp.acts.iter().any(Doing::is_aside);
        let straight = self.cp.turning == Turning::No && self.sv.turning == Turning::No;
        self.waits_behind() && aside && straight && self.cp.state != ContactState::Reversing
    }

    /// Whether the partner is drawn as one that stood in a queue behind the ego, though only its place is told.
    pub(crate) const fn queues(&self) -> bool {
        self.queued && self.close
    }

    /// Whether the partner is told to have been behind an ego that stood and set off, and nothing tells that it came up to it.
    pub(crate) fn was_in_queue(&self, account: &Account, partner: &Party) -> bool {
        let went = self.sv.state == ContactState::SettingOff
            || self.sv.state == ContactState::Moving && self.sv.stood_first && self.sv.turning == Turning::No;
        let plain = self.cp.state == ContactState::Moving && !self.cp.stood_first && self.cp.turning == Turning::No;
        let straight = matches!(self.cp.movement, None | Some(Movement::Straight)) && self.cp.manner.is_none();
        let words = |source: &Source| match source {
            Source::Words { text, .. } => text.to_lowercase(),
            _ => String::new(),
        };
        let place = account.came_from.as_ref().map_or(String::new(), |fact| words(&fact.source));
        let comes = |text: &str| ["approach", "came", "coming", "from behind"].iter().any(|word| text.contains(word));
        let acts = &mut partner.acts.iter().filter(|fact| !fact.after_contact);
        let only_there = acts.all(|fact| fact.act == Done::Follow && !comes(&words(&fact.source)));
        self.origin == Origin::Behind
            && went
            && plain
            && straight
            && !self.pushed
            && only_there
            && place.contains("behind")
            && !comes(&place)
    }

    /// Whether the partner stood beside the ego's way, or across from it, and passed it then.
    pub(crate) fn passes_after_stand(&self) -> bool {
        let stood = self.cp.acts.iter().position(Doing::is_stand);
        let passed = self.cp.acts.iter().rposition(Doing::is_pass);
        let beside = matches!(self.origin, Origin::Opposite | Origin::Beside { .. }) && !self.plainly;
        beside && self.cp.state == ContactState::Moving && self.sv.state.stands() && stood.is_some() && stood < passed
    }

    /// Whether the partner leaves its lane to come by.
    fn comes_round_ego(&self) -> bool {
        let stands = self.sv.state.stands();
        match self.cp.movement {
            Some(Movement::Passing) => true,
            Some(Movement::ChangingLanes | Movement::CrossingIntoOpposingLane) => stands,
            _ => false,
        }
    }

    /// The same with the partner farther behind the ego, where that matters.
    pub(crate) fn afar(&self) -> Option<Self> {
        let comes_round = self.waits_behind() && self.comes_round_ego();
        let told = (self.close && (self.queued || comes_round)).then(|| Self { close: false, ..self.clone() });
        told.map(|told| {
            let choices = told.choices;
            told.choosing(choices)
        })
    }

    /// Whether the partner is told to have come up slowly behind an ego that stands: that has stood for long.
    fn comes_up_slowly(&self) -> bool {
        let slow = self.cp.manner == Some(Manner::Slow) && self.cp.state == ContactState::Moving;
        self.origin == Origin::Behind && slow && self.sv.state.stands()
    }

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
}

/// What the partner did before its last phase where that is told, or follows from what the ego did; and its last pace.
pub(crate) fn partner_paces(told: &Told, staging: &Staging) -> (Option<Lead>, Pace) {
    let (cp, contact_s) = (&told.cp, told.contact_s);
    let (ego_lead, ego) = ego_paces(told, &staging.ground, staging.sv_s_m);
    let ego_m = ego.driven_m + ego_lead.as_ref().map_or(0.0, Lead::driven_m);
    let ego_backs_s = ego_lead.as_ref().and_then(|lead| lead.backs_s);
    let ego_moves_s = ego_lead.as_ref().and_then(Lead::sets_off_s).unwrap_or_else(|| first_time(&ego.acts));
    let ego_backs_s = ego_backs_s.filter(|_| told.backs_first == Some(Striker::Cp));
    let before_s = if told.backs_early { Some(ego_moves_s) } else { ego_backs_s };
    let last = things::pace(told)
        .or_else(|| beside_from_line(told, staging))
        .or_else(|| cross_from_line(told, staging))
        .or_else(|| lateral::from_kerb(told, staging))
        .unwrap_or_else(|| partner_pace(told, staging, (&ego, ego_m, before_s)));
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
    let lead =
        |longer_s: f64| phases::lead(phases, begins_s, told.choices.rolling_mps, MOVES_UP_M, longer_s + waited_s);
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

/// The partner's last pace, where it does not depend on what the ego does.
fn last_pace(told: &Told) -> Pace {
    let (cp, contact_s) = (&told.cp, told.contact_s);
    let rolling_mps = if cp.kind == PartnerKind::Pedestrian { WALKS_MPS } else { 5.0 };
    let usual = pace(contact_s, cp, rolling_mps, STOOD_S + told.choices.longer_s[1]);
    // Who stood behind an ego that moved up stood behind where that was; who comes round it has room for that.
    let moved_up = told.sv.state.stands() && told.sv.phases.iter().skip(1).any(|phase| *phase == Phase::Drives);
    let from_m = match told.waits_behind() {
        true if told.comes_round_ego() && told.close => COMES_ROUND_CLOSE_M,
        true if cp.movement == Some(Movement::Passing) => COMES_ROUND_M,
        true if moved_up => MOVES_UP_M + BEHIND_M,
        true if told.sv.state == ContactState::SettingOff => catches_up_m(told),
        true if usual.speed_mps > 0.0 => MOVES_UP_M,
        // Who stood and then passed has come by from there.
        false if told.passes_after_stand() => 0.5 * (size_of(cp).0 + size_of(&told.sv).0) + STANDS_SHORT_M,
        _ => return usual,
    };
    start_over(contact_s, cp.speed_mps, from_m).unwrap_or(usual)
}

/// How the partner's speed comes to what it is at the contact, from its last stand where it stood.
fn partner_pace(told: &Told, staging: &Staging, (ego, ego_m, before_s): (&Pace, f64, Option<f64>)) -> Pace {
    let (cp, contact_s) = (&told.cp, told.contact_s);
    let usual = last_pace(told);
    if told.waits_behind() && told.sv.state == ContactState::Moving && ego.speed_mps == 0.0 {
        let ego_s = contact_s - first_time(&ego.acts);
        if let Some(pace) = start_after(contact_s, cp.speed_mps, ego_m + BEHIND_M, ego_s - FOLLOWS_S) {
            return pace;
        }
    }
    let same_way = matches!(told.origin, Origin::Behind | Origin::Ahead);
    let follows = matches!(told.origin, Origin::Behind | Origin::Beside { .. });
    let follows = follows && told.ahead != Some(true) && !told.sv.reacts;
    let enters = cp.movement == Some(Movement::EnteringTraffic);
    match cp.state {
        ContactState::Moving if told.gives_way_to_merge && cp.speed_mps < ego.speed_mps - 1.0 => {
            slows_abreast(contact_s, cp.speed_mps, ego)
        }
        ContactState::Moving if told.brakes_late() => slows(contact_s, cp),
        // It slows with the ego that it follows.
        ContactState::Moving if told.sv.slowed_from.is_some() && follows && usual.driven_m < ego_m + 5.0 => {
            let from_mps = (ego.speed_mps + FOLLOWS_BY_MPS).max(cp.speed_mps);
            // It brakes after the ego does.
            let braking_s = (contact_s - first_time(&ego.acts) - BRAKES_LATER_S).max(LEAST_BRAKING_S);
            let brake =
                Deed::Speed { to_mps: cp.speed_mps, rate_mps2: ((from_mps - cp.speed_mps) / braking_s).max(0.05) };
            let driven_m = from_mps * (contact_s - braking_s) + 0.5 * (from_mps + cp.speed_mps) * braking_s;
            Pace { speed_mps: from_mps, acts: vec![when(contact_s - braking_s, brake)], driven_m }
        }
        // Who is ahead and slower has not come from behind the ego: it has just set off.
        ContactState::Moving if same_way && told.origin == Origin::Ahead && usual.driven_m > ego_m - 0.3 => {
            sets_off(contact_s, cp.speed_mps, (0.8 * ego_m).max(0.2))
        }
        ContactState::Reversing => {
            let turn = math::wrap_angle(staging.cp.heading - staging.cp_came).abs();
            let swings = turn > SWINGS_RAD;
            let way_m = match told.origin {
                _ if cp.backs_in => kerb::BACKS_IN_M,
                Origin::Stall { .. } | Origin::Driveway { .. } => kerb::out_m(told, staging).max(BACKS_OUT_M),
                _ if swings && !cp.phases.is_empty() => SWINGS_BACK_M.max(LEAST_BACK_M * turn),
                _ => REVERSES_M.max(LEAST_BACK_M * turn),
            };
            // Who backed before the ego did something backs for longer.
            let backing_s = before_s.map_or(0.0, |from_s| contact_s - from_s + BACKS_EARLIER_S);
            start_over(
                contact_s,
                cp.speed_mps,
                way_m.max(cp.speed_mps * (backing_s - 0.5 * cp.speed_mps / SETS_OFF_MPS2)),
            )
            .unwrap_or(usual)
        }
        // Who comes from the kerb or out of a stall stood there.
        ContactState::Moving if told.stood_beside() || enters && from_stand(told.origin) => {
            let way_m = match told.origin {
                Origin::Driveway { .. } => kerb::out_m(told, staging).max(PULL_OUT_M),
                _ => PULL_OUT_M,
            };
            let moving_s = (2.0 * way_m / cp.speed_mps * 10.0).round() / 10.0;
            let go = Deed::Speed { to_mps: cp.speed_mps, rate_mps2: cp.speed_mps / moving_s };
            Pace { speed_mps: 0.0, acts: vec![when(contact_s - moving_s, go)], driven_m: 0.5 * cp.speed_mps * moving_s }
        }
        // Who stood and turned has room for its turn.
        ContactState::Moving if cp.stood_first && matches!(cp.turning, Turning::Left | Turning::Right) => {
            let from_line =
                turn_from_line_m(told, staging).and_then(|way_m| start_over(contact_s, cp.speed_mps, way_m));
            from_line.or_else(|| start_over(contact_s, cp.speed_mps, TURNS_M)).unwrap_or(usual)
        }
        ContactState::Stopped if told.origin == Origin::Ahead && usual.driven_m > ego_m - 0.3 => STANDING,
        // It stood before the story begins.
        ContactState::Stopped if cp.stands_from_start && told.origin != Origin::Behind => STANDING,
        // Who sets off has room to leave its line.
        ContactState::Moving | ContactState::SettingOff if usual.speed_mps == 0.0 && !told.waits_behind() => {
            let room_m = lateral::room_m(told, staging);
            let more = start_over(contact_s, cp.speed_mps, room_m).filter(|_| room_m > usual.driven_m);
            more.unwrap_or(usual)
        }
        _ => usual,
    }
}

/// Who stood behind the ego and comes round it has driven so far at the contact; farther where it has no room for that. [m]
const COMES_ROUND_CLOSE_M: f64 = 8.0;
const COMES_ROUND_M: f64 = 12.0;

/// Who was in a queue behind the ego runs into it at this speed. [m/s]
pub(crate) const QUEUED_MPS: f64 = 4.0;

/// Who stood, and passed the ego then, stood so far short of it at least. [m]
const STANDS_SHORT_M: f64 = 3.0;

/// How far somebody who stood before it turned has driven at the contact. [m]
const TURNS_M: f64 = 8.0;

/// Who stands behind the ego stands so far behind it. [m]
const BEHIND_M: f64 = 2.0;

/// Who is slower than this in traffic has set off, or comes to a stop. [m/s]
const CREEPS_MPS: f64 = 4.0;

/// How far somebody has reversed at the contact. [m]
const REVERSES_M: f64 = 2.5;

/// Who came along ahead of the ego was so much farther ahead than it is at the contact, at least. [m]
const AHEAD_M: f64 = 1.0;

/// Who backed first did so by so long. [s]
const BACKS_EARLIER_S: f64 = 1.0;

/// Who backs out of a stall or a driveway has done so for so far. [m]
const BACKS_OUT_M: f64 = 4.5;

/// Who came along the road, and turned by more than this while it reversed, has reversed so far. [rad, m]
const SWINGS_RAD: f64 = 0.2;
const SWINGS_BACK_M: f64 = 6.0;

/// Nobody backs on a tighter circle. [m]
const LEAST_BACK_M: f64 = 5.0;

fn from_stand(origin: Origin) -> bool {
    !matches!(origin, Origin::Cross { .. } | Origin::Behind | Origin::Opposite)
}

pub(crate) fn first_time(acts: &[Act]) -> f64 {
    acts.iter()
        .find_map(|act| match act.when {
            Some(Trigger::TimeS(time_s)) => Some(time_s),
            _ => None,
        })
        .unwrap_or(0.0)
}

/// When somebody has yet to drive so far to the contact. [s]
pub(crate) fn time_before(contact_s: f64, pace: &Pace, left_m: f64) -> f64 {
    let steps = (contact_s / STEP_S).round() as usize;
    let (mut speed_mps, mut driven_m) = (pace.speed_mps, vec![0.0]);
    for step in 0..steps {
        let begun = pace.acts.iter().rfind(|act| first_time(std::slice::from_ref(act)) <= STEP_S * step as f64 + 1e-9);
        if let Some(Deed::Speed { to_mps, rate_mps2 }) = begun.map(|act| act.deed.clone()) {
            let by_mps = rate_mps2 * STEP_S;
            speed_mps += (to_mps - speed_mps).clamp(-by_mps, by_mps);
        }
        driven_m.push(driven_m[step] + speed_mps * STEP_S);
    }
    let from = driven_m.iter().position(|driven| driven_m[steps] - driven <= left_m).unwrap_or(0);
    STEP_S * from as f64
}

/// From a stand to a speed within a distance, or less.
fn sets_off(contact_s: f64, speed_mps: f64, within_m: f64) -> Pace {
    let moving_s =
        ((2.0 * within_m / speed_mps.max(0.05)).min(speed_mps / SETS_OFF_MPS2) * 10.0).floor().max(2.0) / 10.0;
    let rate_mps2 = (speed_mps / moving_s).clamp(0.05, 8.0);
    let go = Deed::Speed { to_mps: speed_mps, rate_mps2 };
    Pace { speed_mps: 0.0, acts: vec![when(contact_s - moving_s, go)], driven_m: 0.5 * speed_mps * moving_s }
}

/// How somebody's speed comes to what it is at the contact.
fn pace(contact_s: f64, side: &Side, rolling_mps: f64, stood_s: f64) -> Pace {
    match side.state {
        ContactState::Parked => STANDING,
        ContactState::Stopped => {
            let braking_s = rolling_mps / STOPPING_MPS2;
            let from_s = ((contact_s - stood_s - braking_s) * 10.0).floor() / 10.0;
            let driven_m = rolling_mps * from_s + 0.5 * rolling_mps * braking_s;
            let acts = vec![
                when(from_s, Deed::Stop { rate_mps2: STOPPING_MPS2, at_m: None }),
                next(Deed::Hold { for_s: None }),
            ];
            Pace { speed_mps: rolling_mps, acts, driven_m }
        }
        ContactState::Moving if side.slowed_from.is_some() && (side.stood_first || !side.phases.is_empty()) => {
            starts_and_slows(contact_s, side.speed_mps, 0.0).unwrap_or_else(|| slows(contact_s, side))
        }
        ContactState::Moving if side.stood_first || !side.phases.is_empty() => {
            let moving_s = ((side.speed_mps / STARTS_MPS2).min(LONGEST_START_S) * 10.0).ceil().max(5.0) / 10.0;
            let go = Deed::Speed { to_mps: side.speed_mps, rate_mps2: side.speed_mps / moving_s };
            let driven_m = 0.5 * side.speed_mps * moving_s;
            Pace { speed_mps: 0.0, acts: vec![when(contact_s - moving_s, go)], driven_m }
        }
        ContactState::SettingOff | ContactState::Reversing => {
            // So that it sets off at a step: the rate gives way.
            let moving_s = ((side.speed_mps / SETS_OFF_MPS2).min(LONGEST_START_S) * 10.0).ceil().max(5.0) / 10.0;
            let rate_mps2 = (side.speed_mps / moving_s).max(0.05);
            let driven_m = 0.5 * side.speed_mps * moving_s;
            let go = Deed::Speed { to_mps: side.speed_mps, rate_mps2 };
            Pace { speed_mps: 0.0, acts: vec![when(contact_s - moving_s, go)], driven_m }
        }
        ContactState::Moving if side.slowed_from.is_some() => slows(contact_s, side),
        ContactState::Moving if side.gains => gains(contact_s, side.speed_mps),
        ContactState::Moving => {
            Pace { speed_mps: side.speed_mps, acts: Vec::new(), driven_m: side.speed_mps * contact_s }
        }
    }
}

/// It brakes down to its speed at the contact.
fn slows(contact_s: f64, side: &Side) -> Pace {
    let (usual_mps, rate_mps2) = if side.reacts { (REACTS_BY_MPS, REACTS_MPS2) } else { (SLOWS_BY_MPS, SLOWS_MPS2) };
    let told_mps = side.slowed_from.and_then(|slowed| slowed.0).filter(|from| *from > side.speed_mps + 1.0);
    let from_mps = told_mps.unwrap_or(side.speed_mps + usual_mps).min(side.speed_mps + MOST_SLOWED_MPS);
    let by_mps = from_mps - side.speed_mps;
    let braking_s = (by_mps / rate_mps2 * 10.0).ceil() / 10.0;
    let brake = Deed::Speed { to_mps: side.speed_mps, rate_mps2: by_mps / braking_s };
    let driven_m = from_mps * (contact_s - braking_s) + 0.5 * (from_mps + side.speed_mps) * braking_s;
    Pace { speed_mps: from_mps, acts: vec![when(contact_s - braking_s, brake)], driven_m }
}

/// It comes along as fast as the ego does, slows when that does, and goes on slowly.
fn slows_abreast(contact_s: f64, speed_mps: f64, ego: &Pace) -> Pace {
    let (from_s, by_mps) = (first_time(&ego.acts), ego.speed_mps - speed_mps);
    let braking_s = (by_mps / STOPPING_MPS2).min(contact_s - from_s);
    let brake = Deed::Speed { to_mps: speed_mps, rate_mps2: by_mps / braking_s };
    let driven_m = ego.speed_mps * from_s
        + 0.5 * (ego.speed_mps + speed_mps) * braking_s
        + speed_mps * (contact_s - from_s - braking_s);
    Pace { speed_mps: ego.speed_mps, acts: vec![when(from_s, brake)], driven_m }
}

/// From a stand up to more than its speed at the contact, and down to that: so far, by less where that takes farther, or as far as the
/// usual takes.
fn starts_and_slows(contact_s: f64, speed_mps: f64, driven_m: f64) -> Option<Pace> {
    let by_less = [1.0, 0.75, 0.5].map(|share| share * STARTS_AND_SLOWS_MPS);
    let least = |by_mps: f64| {
        let from_mps = speed_mps + by_mps;
        let gaining_s = (from_mps / STARTS_MPS2 * 10.0).ceil() / 10.0;
        let braking_s = (by_mps / SLOWS_MPS2 * 10.0).ceil() / 10.0;
        let least_m = 0.5 * from_mps * gaining_s + 0.5 * (from_mps + speed_mps) * braking_s;
        (from_mps, gaining_s, braking_s, least_m)
    };
    let fits = by_less.into_iter().find(|by_mps| least(*by_mps).3 <= driven_m).unwrap_or(STARTS_AND_SLOWS_MPS);
    let (from_mps, gaining_s, braking_s, least_m) = least(fits);
    let keeps_s = ((driven_m.max(least_m) - least_m) / from_mps * 10.0).round() / 10.0;
    let begins_s = contact_s - gaining_s - keeps_s - braking_s;
    let acts = vec![
        when(begins_s, Deed::Speed { to_mps: from_mps, rate_mps2: from_mps / gaining_s }),
        when(contact_s - braking_s, Deed::Speed { to_mps: speed_mps, rate_mps2: fits / braking_s }),
    ];
    let driven_m = least_m + from_mps * keeps_s;
    (begins_s > 1.0).then_some(Pace { speed_mps: 0.0, acts, driven_m })
}

/// Who set off and slowed again was faster by so much between. [m/s]
pub(crate) const STARTS_AND_SLOWS_MPS: f64 = 3.0;

/// It gains speed until the contact.
fn gains(contact_s: f64, speed_mps: f64) -> Pace {
    let by_mps = GAINS_MPS.min(0.5 * speed_mps);
    let (from_mps, gaining_s) = (speed_mps - by_mps, (by_mps / STARTS_MPS2 * 10.0).ceil() / 10.0);
    let gain = Deed::Speed { to_mps: speed_mps, rate_mps2: by_mps / gaining_s };
    let driven_m = from_mps * (contact_s - gaining_s) + 0.5 * (from_mps + speed_mps) * gaining_s;
    Pace { speed_mps: from_mps, acts: vec![when(contact_s - gaining_s, gain)], driven_m }
}

/// Who gained speed before the contact gained so much, at most half of it. [m/s]
pub(crate) const GAINS_MPS: f64 = 3.0;

/// Who follows an ego that slows brakes so long after it, for so long at least. [s]
const BRAKES_LATER_S: f64 = 0.6;
const LEAST_BRAKING_S: f64 = 0.4;

/// Who follows an ego that slows is faster than it by so much before. [m/s]
const FOLLOWS_BY_MPS: f64 = 1.0;

/// Who slowed before the contact came faster by so much where nobody says from which speed, at most so much, and brakes so. [m/s, m/s,
/// m/s^2]
const SLOWS_BY_MPS: f64 = 4.0;
const MOST_SLOWED_MPS: f64 = 12.0;
const SLOWS_MPS2: f64 = 2.5;

/// The same of who brakes hard because another turns across its way. [m/s, m/s^2]
const REACTS_BY_MPS: f64 = 3.0;
const REACTS_MPS2: f64 = 5.0;

/// Who stood before a junction, and is in it at the contact, sets off from its stop line.
fn from_line(told: &Told, ground: &Ground, sv_s_m: f64) -> Option<Pace> {
    let sv = &told.sv;
    let stops = match sv.control.filter(|said| said.obeyed != Some(Obeyed::No)) {
        // Who slows for a sign and is not told to have stood has yet to come to it, when it is hit from behind.
        Some(said) => {
            let yet_to_stop = told.origin == Origin::Behind && sv.slowed_from.is_some();
            let at_sign = said.device == ControlDevice::StopSign && !yet_to_stop;
            sv.state == ContactState::SettingOff || sv.stood_first || at_sign
        }
        None => sv.stood_first,
    };
    let stops = stops && matches!(sv.state, ContactState::SettingOff | ContactState::Moving);
    let driven_m = past_line_m(told, ground, sv_s_m).filter(|_| stops)?;
    // Who slows again before it has come so far stood behind others, and not at the line.
    let slows = sv.slowed_from.and_then(|_| starts_and_slows(told.contact_s, sv.speed_mps, driven_m));
    slows.or_else(|| start_over(told.contact_s, sv.speed_mps, driven_m))
}

/// Who stood beside the ego before a junction sets off from the same line.
fn beside_from_line(told: &Told, staging: &Staging) -> Option<Pace> {
    let (cp, ground) = (&told.cp, &staging.ground);
    if !cp.stood_first || !ground.junction || !matches!(told.origin, Origin::Beside { .. }) {
        return None;
    }
    let line_m = ground.first_m() - 0.5 * size_of(cp).0 - AT_LINE_M;
    start_over(told.contact_s, cp.speed_mps, ground.beside(staging.cp.position).0 - line_m)
}

/// Who stood at a signal or a sign on the crossing road sets off from its stop line.
fn cross_from_line(told: &Told, staging: &Staging) -> Option<Pace> {
    let (cp, ground) = (&told.cp, &staging.ground);
    let Origin::Cross { side } = told.origin else { return None };
    let stood = cp.stood_first || cp.state == ContactState::SettingOff;
    if !stood || cp.control.is_none() || !ground.junction || cp.state == ContactState::Reversing {
        return None;
    }
    let line_m = corner_m(ground.lanes) + AT_LINE_M + 0.5 * size_of(cp).0;
    let left_m = staging.cp.position.y - ground.centre_y_m();
    let to_line_m = if side == LeftRight::Left { line_m - left_m } else { line_m + left_m };
    start_over(told.contact_s, cp.speed_mps, to_line_m)
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
    let (sine, radius_m) = (math::sin(turn), lateral::turn_m(told));
    (along_m > radius_m * sine).then_some(along_m + radius_m * (turn - sine))
}

/// From a stand to a speed, and so far: it gains its speed on the way, or earlier and keeps it.
pub(crate) fn start_over(contact_s: f64, speed_mps: f64, driven_m: f64) -> Option<Pace> {
    if driven_m < 0.3 {
        return None;
    }
    let rate_mps2 = (0.5 * speed_mps * speed_mps / driven_m).max(SETS_OFF_MPS2);
    let gaining_s = speed_mps / rate_mps2;
    let moving_s = gaining_s + (driven_m - 0.5 * speed_mps * gaining_s) / speed_mps;
    if moving_s > contact_s - 1.0 || rate_mps2 > STRONGEST_START_MPS2 {
        return None;
    }
    // It sets off at a step.
    let from_s = ((contact_s - moving_s) * 10.0).round() / 10.0;
    let go = Deed::Speed { to_mps: speed_mps, rate_mps2 };
    Some(Pace { speed_mps: 0.0, acts: vec![when(from_s, go)], driven_m })
}

/// From a stand to a speed, so far and in so long.
fn start_after(contact_s: f64, speed_mps: f64, driven_m: f64, moving_s: f64) -> Option<Pace> {
    let moving_s = (moving_s * 10.0).floor() / 10.0;
    let gaining_s = 2.0 * (moving_s - driven_m / speed_mps);
    let rate_mps2 = speed_mps / gaining_s;
    if !(0.1..=moving_s).contains(&gaining_s) || rate_mps2 > STRONGEST_START_MPS2 || moving_s > contact_s - 1.0 {
        return None;
    }
    let go = Deed::Speed { to_mps: speed_mps, rate_mps2 };
    Some(Pace { speed_mps: 0.0, acts: vec![when(contact_s - moving_s, go)], driven_m })
}

/// Nobody sets off harder. [m/s^2]
const STRONGEST_START_MPS2: f64 = 5.0;

/// Who stops at a line stops so far before it. [m]
const AT_LINE_M: f64 = 0.5;
