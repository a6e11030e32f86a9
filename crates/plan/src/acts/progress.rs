//! How far somebody has come with a plan.

use super::programme::{Programme, When};
use crate::constants::STANDING_MPS;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::scenario::Doing;
use recrash_roads::Beside;

/// Steps that a follower may look back: 2.4 s.
pub(super) const MEMORY: usize = 25;

/// How far somebody has come. Copies are independent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Along the course. [m]
    pub s_m: f64,
    /// On its own line, which is longer or shorter than the course where it is beside a bend; never negative. [m/s]
    pub speed_mps: f64,
    /// What it does along its course.
    pub mode: Mode,
    /// Whether it is in the world.
    pub present: bool,
    /// Acts that have begun, a bit each.
    pub begun: u64,
    /// The acceleration of this step, until `bound_mps` is reached. [m/s^2]
    pub(super) acceleration_mps2: f64,
    pub(super) bound_mps: f64,
    /// The speed it holds when nothing else is to be done. [m/s]
    pub(super) cruise_mps: f64,
    pub(super) cruise_rate_mps2: f64,
    pub(super) leg: u8,
    pub(super) piece: u16,
    /// The next act, and the step at which it begins where its trigger has been met.
    pub(super) next: u8,
    pub(super) due: Option<u32>,
    /// When the act that began last is done.
    pub(super) waits_for: WaitsFor,
    pub(super) shift: Shift,
    pub(super) obeys_control: bool,
    /// The stop sign it has stood at long enough, and for how long it has stood at one.
    pub(super) passed_sign: u16,
    pub(super) stood_steps: u32,
    /// What a follower saw of whom it follows, the latest at `seen_at`: gap [m], speed [m/s].
    pub(super) seen: [(f32, f32); MEMORY],
    pub(super) seen_at: u8,
    pub(super) seen_count: u8,
}

/// What somebody does along its course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mode {
    /// Changes to the speed it holds, and holds it.
    Cruise,
    /// Brakes to a stand, and stands.
    Stop {
        /// [m/s^2]
        rate_mps2: f64,
        /// Where; at once where not given. [m]
        at_m: Option<f64>,
    },
    /// Stands.
    Hold,
    /// Follows somebody: the act's number.
    Follow(u8),
}

/// What ends the act that began last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum WaitsFor {
    Nothing,
    Speed(f64),
    Standstill,
    Step(u32),
    ShiftEnd,
    Both(u16),
    Never,
}

/// A sideways move: a polynomial of fifth degree over a distance.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Shift {
    pub(super) from_m: f64,
    pub(super) over_m: f64,
    /// Where it ends, to the right. [m]
    to_t_m: f64,
    /// Coefficients by rising power of the share of the distance. [m]
    by_power: [f64; 6],
}

impl Shift {
    /// At rest beside the line.
    pub(super) fn at(t_m: f64) -> Self {
        Self { to_t_m: t_m, by_power: [t_m, 0.0, 0.0, 0.0, 0.0, 0.0], ..Self::default() }
    }

    /// From where it is, and as it moves there, to a place where it rests.
    pub(super) fn begin(now: Beside, s_m: f64, to_t_m: f64, over_m: f64) -> Self {
        let (start, rate, bend) = (now.t_m, now.slope * over_m, now.bend * over_m * over_m);
        let way = to_t_m - start;
        let by_power = [
            start,
            rate,
            0.5 * bend,
            10.0 * way - 6.0 * rate - 1.5 * bend,
            -15.0 * way + 8.0 * rate + 1.5 * bend,
            6.0 * way - 3.0 * rate - 0.5 * bend,
        ];
        Self { from_m: s_m, over_m, to_t_m, by_power }
    }

    pub(super) fn beside(&self, s_m: f64) -> Beside {
        let along = s_m - self.from_m;
        if along >= self.over_m {
            return Beside { t_m: self.to_t_m, ..Beside::default() };
        }
        let x = along / self.over_m;
        let [c0, c1, c2, c3, c4, c5] = self.by_power;
        let t_m = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))));
        let first = c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)));
        let second = 2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5));
        Beside { t_m, slope: first / self.over_m, bend: second / math::sq(self.over_m) }
    }
}

impl Programme {
    /// Whether it goes on after a touch: one of its acts waits for that. `me` is the own number.
    pub fn outlasts_a_touch(&self, me: u16) -> bool {
        self.acts.iter().any(|act| act.when == Some(When::State { actor: me, is: Doing::Hit }))
    }

    /// At the start.
    pub fn start(&self) -> Progress {
        Progress {
            s_m: 0.0,
            speed_mps: self.speed_mps,
            mode: Mode::Cruise,
            present: self.appears == 0,
            begun: 0,
            acceleration_mps2: 0.0,
            bound_mps: self.speed_mps,
            cruise_mps: self.speed_mps,
            cruise_rate_mps2: 1.0,
            leg: 0,
            piece: 0,
            next: 0,
            due: None,
            waits_for: WaitsFor::Nothing,
            shift: Shift::at(self.t_m),
            obeys_control: self.obeys_control,
            passed_sign: u16::MAX,
            stood_steps: 0,
            seen: [(0.0, 0.0); MEMORY],
            seen_at: 0,
            seen_count: 0,
        }
    }

    /// Goes on along the course for a time with the acceleration that was chosen; exact for any step, but while it moves
    /// sideways in a bend. [s]
    pub fn advance(&self, now: &mut Progress, time_s: f64) {
        let (v, a, bound) = (now.speed_mps, now.acceleration_mps2, now.bound_mps);
        let mut driven_m = v * time_s;
        if v != bound && a != 0.0 {
            let until_s = (bound - v) / a;
            // A hair late is rounding.
            if until_s <= time_s + 1e-9 {
                driven_m = 0.5 * (v + bound) * until_s + bound * (time_s - until_s).max(0.0);
                now.speed_mps = bound;
            } else {
                driven_m = (v + 0.5 * a * time_s) * time_s;
                now.speed_mps = v + a * time_s;
            }
        }
        let t_m = now.shift.beside(now.s_m).t_m;
        now.s_m = self.course.after(usize::from(now.piece), now.s_m, self.reverses(now), t_m, driven_m);
        // Where it changes gear the line goes on the other way; until then it is on this gear's, also a hair behind its end.
        let on_m = self.end_of_gear_m(now).map_or(now.s_m, |end_m| now.s_m.min(end_m));
        now.piece = self.course.piece_at(on_m, usize::from(now.piece)) as u16;
    }

    /// How far it has yet to drive to a place along its course, beside the line as it is now. [m]
    pub(super) fn left_m(&self, now: &Progress, at_m: f64) -> f64 {
        let t_m = now.shift.beside(now.s_m).t_m;
        self.course.driven(usize::from(now.piece), (now.s_m, at_m), self.reverses(now), t_m)
    }

    fn reverses(&self, now: &Progress) -> bool {
        self.course.legs[usize::from(now.leg)].reverse
    }

    /// Pose and velocity of its centre, and its yaw rate. [m/s, rad/s]
    pub fn motion(&self, now: &Progress) -> (Pose, Vec2, f64) {
        let (reverse, piece) = (self.reverses(now), usize::from(now.piece));
        let beside = now.shift.beside(now.s_m);
        let along_mps = now.speed_mps / self.course.stretch(piece, now.s_m, reverse, beside.t_m);
        self.course.motion(piece, now.s_m, reverse, beside, along_mps)
    }
}

impl Progress {
    /// Goes on in somebody else's hands: what of the plan is not driving still happens. [m/s, s]
    pub fn be_driven(&mut self, speed_mps: f64, time_s: f64) {
        self.s_m += speed_mps * time_s;
        self.speed_mps = if speed_mps < STANDING_MPS { 0.0 } else { speed_mps };
    }

    /// Whether it stands, and goes on standing in this step.
    pub fn stands(&self) -> bool {
        self.speed_mps == 0.0 && (self.bound_mps == 0.0 || self.acceleration_mps2 == 0.0)
    }

    /// The act that begins next, and what it waits for; `None` where it waits for nobody, or only for its delay.
    pub(super) fn awaits(&self, programme: &Programme) -> Option<(u8, When)> {
        let act = programme.acts.get(usize::from(self.next)).filter(|_| self.due.is_none())?;
        act.when.map(|when| (self.next, when))
    }

    /// The acceleration it has chosen along its course; 0 once the speed it aims at is reached. [m/s^2]
    pub fn acceleration_mps2(&self) -> f64 {
        if self.speed_mps == self.bound_mps { 0.0 } else { self.acceleration_mps2 }
    }
}
