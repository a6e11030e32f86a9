//! What somebody did before its last phase: it came and stood, moved up and stood again, or reversed first.

use crate::pace::plain::{Pace, braked_hard, first_time, when};
use crate::told::phase::Phase;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::scenario::{self, ActorPlan, Deed, Leg, Place};
use recrash_roads::Course;

/// Who moves up between two stands gains speed so fast. [m/s^2]
const MOVES_UP_MPS2: f64 = 1.2;

/// Who backs gains this speed in so long, and whoever moves between two stands loses its speed in so long. [m/s, s]
const BACKS_UP: (f64, f64) = (1.5, 1.2);
const BRAKES_S: f64 = 1.2;

/// It brakes for its first stop with so much: less than makes plans brake by themselves before they change gear. [m/s^2]
const BRAKES_MPS2: f64 = 1.8;

/// How far somebody moves up, where nothing tells it. [m]
pub(crate) const MOVES_UP_M: f64 = 2.9;

/// It stands for so long between, and it rolls for so long before it brakes for its first stop. [s]
const STANDS_S: f64 = 1.0;
const ROLLS_S: f64 = 0.3;

/// Who has no time to come from a distance stands from the start. [s]
const LEAST_APPROACH_S: f64 = 1.0;

/// How somebody came from its first stop to its last phase.
pub(crate) struct Lead {
    pub(crate) speed_mps: f64,
    pub(crate) acts: Vec<scenario::Act>,
    /// What is driven before the last phase, and whether in reverse, in order. [m]
    stretches: Vec<(f64, bool)>,
    /// It begins to reverse then, where it does. [s]
    pub(crate) backs_s: Option<f64>,
    /// It stands then: after it has reversed, or before it moves up. [s]
    stands_s: f64,
}

impl Lead {
    /// Whether it is also driven backwards.
    pub(crate) fn reverses(&self) -> bool {
        self.stretches.iter().any(|(_, reverse)| *reverse)
    }

    /// How far it goes, back and forth. [m]
    pub(crate) fn driven_m(&self) -> f64 {
        self.stretches.iter().map(|(length_m, reverse)| if *reverse { -length_m } else { *length_m }).sum()
    }

    /// When it last sets off.
    pub(crate) fn sets_off_s(&self) -> Option<f64> {
        let goes = |act: &&scenario::Act| matches!(act.deed, Deed::Speed { to_mps, .. } if to_mps > 0.0);
        self.acts.iter().rfind(goes).map(|act| first_time(std::slice::from_ref(act)))
    }

    /// It leaves its line on its last way, or on so many before that too, of which half is done where that ends.
    pub(crate) fn shifts(&mut self, to_t_m: f64, before: usize) {
        let ways = self.stretches.iter().rev().take(before + 1).map(|(way_m, _)| way_m);
        let over_m = 2.0 * ways.sum::<f64>();
        if over_m == 0.0 {
            return;
        }
        let starts =
            |(_, act): &(usize, &scenario::Act)| matches!(act.deed, Deed::Speed { to_mps, .. } if to_mps > 0.0);
        let at = self.acts.iter().enumerate().filter(starts).rev().nth(before).map_or(0, |(at, _)| at);
        let shift = scenario::Act { deed: Deed::Shift { to_t_m, over_m }, ..self.acts[at].clone() };
        self.acts.insert(at, shift);
    }

    /// It leaves its line by a first part on its last way, and is there where that ends; on no more than so much of it. [m]
    pub(crate) fn goes_aside(&mut self, to_t_m: f64, most_m: f64) {
        let Some((way_m, _)) = self.stretches.last().copied() else { return };
        let over_m = way_m.min(most_m);
        let starts = |act: &scenario::Act| matches!(act.deed, Deed::Speed { to_mps, .. } if to_mps > 0.0);
        let goes = self.acts.iter().rposition(starts);
        let (at, begins_s) = match (goes, self.acts.first().map(|act| &act.deed)) {
            (Some(at), _) => (at, first_time(&self.acts[at..])),
            // It comes along, and brakes.
            (None, Some(Deed::Stop { rate_mps2, .. })) => {
                let braking_m = 0.5 * self.speed_mps * self.speed_mps / rate_mps2;
                let rolling_s = (over_m - braking_m).max(0.0) / self.speed_mps.max(0.1);
                (0, ((first_time(&self.acts) - rolling_s) * 10.0).floor().max(0.0) / 10.0)
            }
            _ => return,
        };
        self.acts.insert(at, when(begins_s, Deed::Shift { to_t_m, over_m }));
    }

    /// The same, where it came along and braked hard.
    pub(crate) fn came_hard(mut self) -> Self {
        let stops = matches!(self.acts.first(), Some(scenario::Act { deed: Deed::Stop { .. }, .. }));
        if let Some((way_m, _)) = self.stretches.first_mut().filter(|_| stops && self.speed_mps > 0.0) {
            let came = Pace { speed_mps: self.speed_mps, acts: vec![self.acts[0].clone()], driven_m: *way_m };
            let Pace { mut acts, driven_m, .. } = braked_hard(came);
            (self.acts[0], *way_m) = (acts.remove(0), driven_m);
        }
        self
    }

    /// Forward all the way, and then the last pace.
    pub(crate) fn then(self, last: Pace) -> Pace {
        let before_m = self.driven_m();
        let acts = self.acts.into_iter().chain(last.acts).collect();
        Pace { speed_mps: self.speed_mps, acts, driven_m: before_m + last.driven_m }
    }

    /// When the system under test takes over: where the ego stands before it moves up, this late at most. No system reverses:
    /// where the ego did it is over then. [s]
    pub(crate) fn handover_s(&self, latest_s: f64) -> f64 {
        if self.reverses() { self.stands_s } else { self.stands_s.min(latest_s) }
    }
}

/// What comes before the last phase of somebody, which begins then: before it sets off, or before it stands. [s]
/// `moves_up_m`: how far it moves between two stands; `longer_s`: so much longer it stands where it stood first.
pub(crate) fn lead(
    phases: &[Phase],
    mut time_s: f64,
    rolling_mps: f64,
    moves_up_m: f64,
    longer_s: f64,
) -> Option<Lead> {
    let before = phases.split_last().map(|(_, before)| before).filter(|before| !before.is_empty())?;
    let (came, before) = match before.split_first() {
        Some((Phase::Drives, rest)) => (true, rest),
        _ => (false, before),
    };
    // From the end: what is done at which time.
    time_s = (time_s * 10.0).floor() / 10.0;
    let mut moves: Vec<(f64, (f64, f64), bool)> = Vec::new();
    for phase in before.iter().rev() {
        match phase {
            Phase::Stands => time_s -= STANDS_S,
            Phase::Drives | Phase::Reverses => {
                let reverse = *phase == Phase::Reverses;
                let way = if reverse { BACKS_UP } else { moves_up(moves_up_m) };
                time_s -= way.1 + BRAKES_S;
                moves.push((time_s, way, reverse));
            }
        }
    }
    if time_s < 0.0 {
        return None;
    }
    moves.reverse();
    let reversed = moves.iter().rfind(|(_, _, reverse)| *reverse);
    let stands_s = match (reversed, moves.last()) {
        (Some((from_s, way, _)), _) => from_s + way.1 + BRAKES_S,
        (None, Some((from_s, ..))) => from_s - 0.5 * STANDS_S,
        (None, None) => time_s,
    };
    let backs_s = moves.iter().find(|(_, _, reverse)| *reverse).map(|(from_s, ..)| *from_s);
    let mut lead = Lead { backs_s, speed_mps: 0.0, acts: Vec::new(), stretches: Vec::new(), stands_s };
    if came && time_s - longer_s >= LEAST_APPROACH_S {
        // It comes along, brakes, and stands.
        let stands_s = if before.first() == Some(&Phase::Stands) { time_s } else { time_s - STANDS_S } - longer_s;
        let speed_mps = rolling_mps.min(BRAKES_MPS2 * (stands_s - ROLLS_S)).max(0.5);
        let braking_s = (speed_mps / BRAKES_MPS2 * 10.0).ceil() / 10.0;
        let from_s = stands_s - braking_s;
        lead.acts.push(when(from_s, Deed::Stop { rate_mps2: speed_mps / braking_s, at_m: None }));
        lead.speed_mps = speed_mps;
        lead.stretches.push((speed_mps * (from_s + 0.5 * braking_s), false));
    }
    for (from_s, (speed_mps, gaining_s), reverse) in moves {
        lead.acts.push(when(from_s, Deed::Speed { to_mps: speed_mps, rate_mps2: speed_mps / gaining_s }));
        let stop = Deed::Stop { rate_mps2: speed_mps / BRAKES_S, at_m: None };
        lead.acts.push(when(from_s + gaining_s, stop));
        lead.stretches.push((0.5 * speed_mps * (gaining_s + BRAKES_S), reverse));
    }
    Some(lead)
}

/// The speed that somebody gains who moves up so far between two stands, and how long it gains it. [m/s, s]
fn moves_up(way_m: f64) -> (f64, f64) {
    let gained_mps = 0.5 * MOVES_UP_MPS2 * ((BRAKES_S * BRAKES_S + 8.0 * way_m / MOVES_UP_MPS2).sqrt() - BRAKES_S);
    let gaining_s = (gained_mps / MOVES_UP_MPS2 * 10.0).round().max(1.0) / 10.0;
    (2.0 * way_m / (gaining_s + BRAKES_S), gaining_s)
}

/// Who changes gear stops so far before the end of a leg: a hair behind it, it would stand on the next one. [m]
pub(crate) const STOPS_SHORT_M: f64 = 0.002;

/// Who came over from another line before its first stop was on its own so far before that, and took so long at least and at most. [m]
const CAME_OVER_M: f64 = 4.0;
const COMES_OVER_M: (f64, f64) = (12.0, 30.0);

/// Another line, so far to the left of the one on which somebody stops; and the arm of who comes over from it. [m]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beside {
    pub(crate) left_m: f64,
    pub(crate) arm_m: f64,
}

impl Beside {
    /// The way from there to the own line, of a first stretch of this length: so much longer it is than straight on, and from where along
    /// that to where it goes over. [m]
    fn over(self, length_m: f64) -> Option<(f64, [f64; 2])> {
        let joins_m = length_m - CAME_OVER_M;
        let leaves_m = (joins_m - COMES_OVER_M.1).max(1.0);
        let at = |x_m: f64, y_m: f64| Pose { position: Vec2::new(x_m, y_m), heading: 0.0 };
        let mut course = Course::begin(self.arm_m);
        let over = course.curve(at(leaves_m, self.left_m), at(joins_m, 0.0), false);
        let longer_m = course.length_m() - (joins_m - leaves_m);
        (over && joins_m - leaves_m >= COMES_OVER_M.0 && longer_m < leaves_m).then_some((longer_m, [leaves_m, joins_m]))
    }
}

/// The same plan with what came before it: along the line on which it begins, back and forth; `from`: it came over from another line.
pub(crate) fn before(lead: Lead, plan: ActorPlan, begin: Pose, from: Option<Beside>) -> ActorPlan {
    let ahead = Vec2::from_heading(begin.heading);
    let degrees = begin.heading.to_degrees();
    let beside = |x_m: f64, left_m: f64| {
        let point = begin.position + ahead * x_m + ahead.left() * left_m;
        Place::at(point.x, point.y, degrees)
    };
    let place = |x_m: f64| beside(x_m, 0.0);
    let gear = |reverse: bool| if reverse { -1.0 } else { 1.0 };
    let start_m = -lead.driven_m();
    let first = lead.stretches.first().filter(|(_, reverse)| lead.speed_mps > 0.0 && !reverse);
    let over = from.zip(first).and_then(|(from, (length_m, _))| Some((from.left_m, from.over(*length_m)?)));
    let start = over.map_or(place(start_m), |(left_m, (longer_m, _))| beside(start_m + longer_m, left_m));
    let (mut x_m, mut course) = (start_m, Vec::new());
    if let Some((left_m, (_, [leaves_m, joins_m]))) = over {
        let to = [beside(start_m + leaves_m, left_m), place(start_m + joins_m)];
        course.extend(to.map(|to| Leg::Curve { to, reverse: false }));
    }
    let own = course.len();
    for (length_m, reverse) in &lead.stretches {
        x_m += gear(*reverse) * length_m;
        // What goes on in the same gear is one leg.
        if matches!(course[own..].last(), Some(Leg::Curve { reverse: before, .. }) if before == reverse) {
            course.pop();
        }
        course.push(Leg::Curve { to: place(x_m + gear(*reverse) * STOPS_SHORT_M), reverse: *reverse });
    }
    course.extend(plan.course);
    let acts = lead.acts.into_iter().chain(plan.acts).collect();
    ActorPlan { speed_mps: lead.speed_mps, course, acts, start, ..plan }
}
