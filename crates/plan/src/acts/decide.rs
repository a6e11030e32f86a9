//! What a plan asks for at a moment, from what its driver sees then.

use super::programme::{Deed, Programme, When};
use super::progress::{MEMORY, Mode, Progress, Shift, WaitsFor};
use crate::constants::{SIGN_STEPS, STANDING_MPS};
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::math;
use recrash_model::rollout::STEP_S;
use recrash_model::scenario::{Aspect, Doing};

/// Deceleration at the end of a leg, of who has no other word for it: what drivers find comfortable (treiber2013). [m/s^2]
const EASY_STOP_MPS2: f64 = 2.0;

/// Deceleration of who stops for a signal or a sign: a firm stop, below the 3.4 m/s^2 of aashto2018. [m/s^2]
const SIGNAL_STOP_MPS2: f64 = 3.0;

/// The most it brakes for a red signal that it sees late. [m/s^2]
const HARD_STOP_MPS2: f64 = 6.0;

/// Deceleration of who is told to stand and still moves. [m/s^2]
const HOLD_MPS2: f64 = 3.0;

/// A place that is no farther away than this has been reached. [m]
const THERE_M: f64 = 0.02;

/// Somebody loses speed faster than this: others see it brake. [m/s^2]
const SEEN_BRAKING_MPS2: f64 = 1.0;

/// What can be seen of somebody.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glimpse {
    /// Its box.
    pub outline: OrientedBox,
    /// [m/s]
    pub velocity: Vec2,
    /// How fast its speed grows. [m/s^2]
    pub acceleration_mps2: f64,
    /// Has touched somebody.
    pub hit: bool,
    /// In the world.
    pub present: bool,
    /// Acts that have begun, a bit each.
    pub begun: u64,
}

/// The frozen world of one decision.
#[derive(Debug, Clone, Copy)]
pub struct Sight<'a> {
    /// Number of the step, from 0.
    pub step: u32,
    /// Everybody: the ego, partners, actors, traffic.
    pub all: &'a [Glimpse],
    /// What signals show, in the scenario's order of control; `None` for signs.
    pub signals: &'a [Option<Aspect>],
}

impl Programme {
    /// Begins acts that are due, and chooses the acceleration of the next 0.1 s. `me` is the own number. Part moves that begin
    /// are handed to `part`: number, angle [rad], duration [steps].
    pub fn decide(&self, now: &mut Progress, me: usize, sight: &Sight<'_>, mut part: impl FnMut(u8, f64, u32)) {
        if sight.step < self.appears {
            return;
        }
        if sight.step == self.appears {
            now.present = true;
        }
        self.pass_leg_ends(now);
        while let Some(act) = self.acts.get(usize::from(now.next)) {
            if now.due.is_none() {
                let Some(from) = (match act.when {
                    None => now.is_done(sight).then_some(sight.step),
                    Some(when) => now.met(when, me, sight),
                }) else {
                    break;
                };
                now.due = Some(from + act.delay);
            }
            if now.due.is_some_and(|due| sight.step < due) {
                break;
            }
            now.due = None;
            now.begun |= 1 << now.next.min(63);
            self.begin(now, act.deed, sight, &mut part);
            now.next += 1;
        }
        self.choose(now, me, sight);
    }

    /// Whether nothing in it will change a standstill any more.
    pub fn is_over(&self, now: &Progress) -> bool {
        let idle = now.speed_mps == 0.0 && (now.cruise_mps == 0.0 || !matches!(now.mode, Mode::Cruise));
        !now.present && now.begun != 0 || idle && usize::from(now.next) >= self.acts.len()
    }

    fn begin(&self, now: &mut Progress, deed: Deed, sight: &Sight<'_>, part: &mut impl FnMut(u8, f64, u32)) {
        now.waits_for = WaitsFor::Nothing;
        match deed {
            Deed::Speed { to_mps, rate_mps2 } => {
                (now.cruise_mps, now.cruise_rate_mps2, now.mode) = (to_mps, rate_mps2, Mode::Cruise);
                now.waits_for = WaitsFor::Speed(to_mps);
            }
            Deed::Stop { rate_mps2, at_m } => {
                now.mode = Mode::Stop { rate_mps2, at_m };
                now.waits_for = WaitsFor::Standstill;
            }
            Deed::Hold { steps } => {
                now.mode = Mode::Hold;
                now.waits_for = steps.map_or(WaitsFor::Never, |steps| WaitsFor::Step(sight.step + steps));
            }
            Deed::Shift { to_t_m, over_m } => {
                now.shift = Shift::begin(now.shift.beside(now.s_m), now.s_m, to_t_m, over_m);
                now.waits_for = WaitsFor::ShiftEnd;
            }
            Deed::Follow { actor, speed_mps, .. } => {
                now.mode = Mode::Follow(now.next);
                now.cruise_mps = speed_mps;
                now.seen_count = 0;
                now.waits_for = WaitsFor::Both(actor);
            }
            Deed::Part { part: number, to_rad, steps } => {
                part(number, to_rad, steps);
                now.waits_for = WaitsFor::Step(sight.step + steps);
            }
            Deed::Obey { control } => now.obeys_control = control,
            Deed::Leave => now.present = false,
        }
    }

    /// Goes on to the next leg where the end of this one has been reached: on the move where the gear stays, from a stand where
    /// it changes.
    fn pass_leg_ends(&self, now: &mut Progress) {
        while let Some(next) = self.course.legs.get(usize::from(now.leg) + 1) {
            let leg = &self.course.legs[usize::from(now.leg)];
            let left_m = leg.end_m - now.s_m;
            let passes =
                if next.reverse == leg.reverse { left_m <= 0.0 } else { now.speed_mps == 0.0 && left_m <= THERE_M };
            if !passes {
                return;
            }
            if next.reverse != leg.reverse {
                now.s_m = leg.end_m;
                // A hair on lies the next leg's line, which leads the other way.
                now.piece = self.course.piece_at(now.s_m + 1e-6, usize::from(now.piece)) as u16;
            }
            now.leg += 1;
        }
    }

    /// Where this leg makes it stop, along the course. [m]
    pub(super) fn end_of_gear_m(&self, now: &Progress) -> Option<f64> {
        let mut at = usize::from(now.leg);
        loop {
            let leg = &self.course.legs[at];
            match self.course.legs.get(at + 1) {
                Some(next) if next.reverse == leg.reverse => at += 1,
                Some(_) => return Some(leg.end_m),
                None => return leg.ends.then_some(leg.end_m),
            }
        }
    }

    fn choose(&self, now: &mut Progress, me: usize, sight: &Sight<'_>) {
        let v = now.speed_mps;
        let (mut acceleration, mut bound) = toward(v, now.cruise_mps, now.cruise_rate_mps2);
        match now.mode {
            Mode::Cruise => {}
            Mode::Stop { rate_mps2, at_m: None } => (acceleration, bound) = (-rate_mps2, 0.0),
            Mode::Stop { rate_mps2, at_m: Some(at_m) } => {
                let left_m = self.left_m(now, at_m);
                if left_m <= THERE_M && v == 0.0 {
                    (acceleration, bound) = (0.0, 0.0);
                } else if let Some(braking) = brake_to(v, left_m, rate_mps2, f64::INFINITY) {
                    (acceleration, bound) = (-braking, 0.0);
                }
            }
            Mode::Hold => (acceleration, bound) = (-HOLD_MPS2, 0.0),
            Mode::Follow(act) => {
                if let Deed::Follow { actor, .. } = self.acts[usize::from(act)].deed {
                    let wanted = self.follow(now, act, usize::from(actor), me, sight);
                    (acceleration, bound) = (wanted, if wanted < 0.0 { 0.0 } else { now.cruise_mps.max(v) });
                }
            }
        }
        let mut stop_at = |at_m: f64, rate_mps2: f64, hardest_mps2: f64| {
            let left_m = self.left_m(now, at_m);
            if v == 0.0 && left_m <= THERE_M {
                (acceleration, bound) = (0.0, 0.0);
            } else if let Some(braking) = brake_to(v, left_m, rate_mps2, hardest_mps2)
                && -braking < acceleration
            {
                (acceleration, bound) = (-braking, 0.0);
            }
        };
        if let Some(end_m) = self.end_of_gear_m(now) {
            stop_at(end_m, EASY_STOP_MPS2, f64::INFINITY);
        }
        if now.obeys_control {
            for line in &self.course.lines {
                let left_m = line.at_m - now.s_m;
                if left_m < -THERE_M || usize::from(now.passed_sign) == line.control {
                    continue;
                }
                match sight.signals.get(line.control).copied().flatten() {
                    Some(Aspect::Green | Aspect::Dark) => {}
                    // Who cannot stop any more goes on.
                    Some(Aspect::Yellow) if v * v > 2.0 * SIGNAL_STOP_MPS2 * left_m.max(0.0) => {}
                    Some(Aspect::Red | Aspect::Yellow | Aspect::FlashingRed) | None => {
                        stop_at(line.at_m, SIGNAL_STOP_MPS2, HARD_STOP_MPS2);
                    }
                }
            }
            self.stand_at_signs(now, sight);
        }
        (now.acceleration_mps2, now.bound_mps) = (acceleration, bound);
    }

    /// Counts how long it has been standing at a stop sign, and lets it go.
    fn stand_at_signs(&self, now: &mut Progress, sight: &Sight<'_>) {
        let at_sign = self.course.lines.iter().find(|line| {
            let is_sign = matches!(sight.signals.get(line.control), Some(None | Some(Aspect::FlashingRed)));
            is_sign && (line.at_m - now.s_m).abs() <= 0.5
        });
        match at_sign {
            Some(line) if now.speed_mps == 0.0 => {
                now.stood_steps += 1;
                if now.stood_steps >= SIGN_STEPS {
                    now.passed_sign = line.control as u16;
                }
            }
            _ => now.stood_steps = 0,
        }
    }

    /// The intelligent driver model (treiber2000), with what was seen a reaction time ago. [m/s^2]
    fn follow(&self, now: &mut Progress, act: u8, leader: usize, me: usize, sight: &Sight<'_>) -> f64 {
        let Deed::Follow { speed_mps, gap_m, headway_s, reaction, acceleration_mps2, braking_mps2, .. } =
            self.acts[usize::from(act)].deed
        else {
            return 0.0;
        };
        let mine = &sight.all[me];
        let seen = sight.all.get(leader).filter(|other| other.present && leader != me).map_or((1e6, 0.0), |other| {
            let way = other.outline.centre - mine.outline.centre;
            let forward = mine.outline.axis;
            if way.dot(forward) <= 0.0 {
                return (1e6, 0.0);
            }
            let gap = mine.outline.gap(&other.outline);
            (gap as f32, other.velocity.dot(forward).max(0.0) as f32)
        });
        now.seen_at = ((usize::from(now.seen_at) + 1) % MEMORY) as u8;
        now.seen[usize::from(now.seen_at)] = seen;
        now.seen_count = (now.seen_count + 1).min(MEMORY as u8);
        let back = (reaction as usize).min(usize::from(now.seen_count) - 1);
        let (gap, lead) = now.seen[(usize::from(now.seen_at) + MEMORY - back) % MEMORY];
        let (gap, lead, v) = (f64::from(gap).max(0.01), f64::from(lead), now.speed_mps);
        let comfortable = 2.0_f64;
        let dynamic = v * headway_s + v * (v - lead) / (2.0 * (acceleration_mps2 * comfortable).sqrt());
        let wanted = gap_m + dynamic.max(0.0);
        let free = 1.0 - math::sq(math::sq(v / speed_mps.max(0.1)));
        (acceleration_mps2 * (free - math::sq(wanted / gap))).clamp(-braking_mps2, acceleration_mps2)
    }
}

impl Progress {
    /// Whether the act that began last is done.
    fn is_done(&self, sight: &Sight<'_>) -> bool {
        match self.waits_for {
            WaitsFor::Nothing => true,
            WaitsFor::Speed(to_mps) => self.speed_mps == to_mps,
            WaitsFor::Standstill => self.speed_mps == 0.0,
            WaitsFor::Step(step) => sight.step >= step,
            WaitsFor::ShiftEnd => self.s_m >= self.shift.from_m + self.shift.over_m,
            WaitsFor::Both(other) => {
                let other = sight.all.get(usize::from(other));
                self.speed_mps < 0.05 && other.is_some_and(|other| other.velocity.length() < STANDING_MPS)
            }
            WaitsFor::Never => false,
        }
    }

    /// The step from which a trigger holds, where it does now. What others do is seen one step after they began it; the
    /// delay of an act counts from that beginning.
    fn met(&self, when: When, me: usize, sight: &Sight<'_>) -> Option<u32> {
        let before = sight.step.saturating_sub(1);
        let other = |actor: u16| sight.all.get(usize::from(actor)).filter(|other| other.present);
        match when {
            When::Step(step) => (sight.step >= step).then_some(step),
            When::At { s_m } => (self.s_m >= s_m - 1e-9).then_some(sight.step),
            When::Near { actor, within_m } => {
                other(actor).filter(|other| other.outline.gap(&sight.all[me].outline) <= within_m).map(|_| sight.step)
            }
            When::State { actor, is } => other(actor)
                .filter(|other| match is {
                    Doing::Standing => other.velocity.length() < STANDING_MPS,
                    Doing::Moving => other.velocity.length() >= STANDING_MPS,
                    Doing::Braking => other.acceleration_mps2 < -SEEN_BRAKING_MPS2,
                    Doing::Hit => other.hit,
                })
                .map(|_| before),
            When::Signal { control, shows } => {
                (sight.signals.get(usize::from(control)).copied().flatten() == Some(shows)).then_some(sight.step)
            }
            When::Act { actor, act } => {
                let begun = sight.all.get(usize::from(actor)).is_some_and(|other| other.begun >> act.min(63) & 1 == 1);
                begun.then_some(before)
            }
            When::Never => None,
        }
    }
}

/// Acceleration and bound of a change to a speed.
fn toward(v: f64, to_mps: f64, rate_mps2: f64) -> (f64, f64) {
    (if to_mps >= v { rate_mps2 } else { -rate_mps2 }, to_mps)
}

/// The constant deceleration that ends at a place, where it is time for it: a step later more than the rate would be needed.
/// No more than the hardest, and there, to the millimetre, no less than the rate: else it would creep on for ever.
fn brake_to(v: f64, left_m: f64, rate_mps2: f64, hardest_mps2: f64) -> Option<f64> {
    if v <= 0.0 {
        return None;
    }
    let later_m = left_m - v * STEP_S;
    let least_mps2 = if left_m < 1e-3 { rate_mps2 } else { 0.0 };
    let needed = |left_m: f64| (v * v / (2.0 * left_m.max(1e-3))).max(least_mps2);
    (later_m <= v * v / (2.0 * rate_mps2)).then(|| needed(left_m).min(hardest_mps2.max(rate_mps2)))
}
