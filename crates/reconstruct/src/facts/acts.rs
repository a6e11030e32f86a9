//! What each of the two is told to have done before the contact, one after the other, found in the way that was driven.

use crate::facts::movement::LEFT_LINE_M;
use crate::told::doing::{CHANGES_MPS, Doing, Least, least};
use crate::usual::{LANE_M, STANDS_MPS};
use recrash_model::account::{Act, LeftRight};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::metrics::CheckResult;
use recrash_model::rollout::{ActorState, ActorTrack};

impl Doing {
    /// How long before it is seen its beginning is found. [steps]
    fn found_early(&self) -> usize {
        let slow = matches!(least(self.act), Some(Least::Speed(_) | Least::Aside(_) | Least::Turn(_) | Least::Any));
        if slow || self.begun { FOUND_EARLY } else { 0 }
    }

    /// How long before an act of the other one it may begin that is told behind that. [steps]
    fn before_other(&self) -> usize {
        match self.act {
            Act::SetOff if self.implied => BEFORE_OTHER + 2 * FOUND_EARLY,
            Act::SetOff if !self.begun => JUST_BEFORE_OTHER,
            _ => BEFORE_OTHER + 2 * self.found_early(),
        }
    }
}

/// Who comes to a stop was faster before. [m/s]
const CAME_MPS: f64 = 0.5;

/// Who had changed lanes before it turned has gone aside by so much, at no more than this angle to its line. [m, rad]
const CHANGED_LANES_M: f64 = 2.2;
const CHANGES_LANES_RAD: f64 = 0.6;

/// Who has begun to pass has gone aside by so much. [m]
const BEGUN_PASS_M: f64 = 0.5;

/// What is told to have come behind an act of the other one begins no earlier than so long before that; what is seen at once, no earlier
/// than this. [steps]
const BEFORE_OTHER: usize = 5;
const JUST_BEFORE_OTHER: usize = 2;

/// An ego that stopped behind something that the other one did began to brake no earlier than so long before it may; it brakes while it loses so much a
/// step. [steps, m/s]
const ANSWERS_EARLY: usize = 10;
const SLOWER_MPS: f64 = 0.02;

/// Who passes the other one comes near it so long before it is beside it. [steps]
const NEARS: usize = 25;

/// Who is told to have stayed in its lane may be over its edge by so much. [m]
const OVER_EDGE_M: f64 = 0.3;

/// What begins little by little is found by so much before it is seen. [steps]
const FOUND_EARLY: usize = 7;

/// Who passes comes beside the other one by so much of its length at least: a front on a rear has none. [m]
const BESIDE_M: f64 = 0.3;

/// One that is at more than this to another's way, and to the way back, stands across it. [rad]
const ALONG_RAD: f64 = 0.9;

/// Who brakes hard loses so much in so long. [m/s, steps]
const BRAKES_BY_MPS: f64 = 1.6;
const BRAKES_OVER: usize = 4;

/// Who comes from the kerb, or draws up at it, has turned by so much where it does not go aside. [deg]
const BENDS_DEG: f64 = 8.0;

/// Of what was begun, so much is seen.
const BEGUN: f64 = 0.2;

/// An act takes no longer, and is seen so soon by so much of it. [steps]
const LONGEST: usize = 60;
const SOON: usize = 10;
const SOON_SHARE: f64 = 0.04;

/// Who did one thing after another may have begun the second so much earlier. [steps]
const OVERLAP: usize = 5;

/// One of the two: what is told of it, its way, the first step at which its front is in the junction, and whether it is the ego.
pub(super) struct Did<'a> {
    pub(crate) is_ego: bool,
    pub(crate) told: &'a [Doing],
    pub(crate) track: &'a ActorTrack,
    pub(crate) entered: Option<usize>,
}

impl Did<'_> {
    /// Its way until then, beside that of the other one.
    fn way<'a>(&'a self, other: Option<&'a Did<'_>>, time_s: f64) -> Way<'a> {
        let until = |track: &ActorTrack| track.step_at(time_s);
        let by = other.map(|other| Other {
            states: &other.track.states[..=until(other.track)],
            half_m: 0.5 * (self.track.length_m + other.track.length_m),
            beyond_m: 0.5 * (other.track.length_m - self.track.length_m),
        });
        let until = until(self.track);
        let room_m = 0.5 * (LANE_M - self.track.width_m) + OVER_EDGE_M;
        let entered = self.entered.filter(|at| *at <= until);
        Way { is_ego: self.is_ego, states: &self.track.states[..=until], other: by, entered, room_m }
    }
}

/// Whether everything that is told of somebody is seen, in order, and behind what the other one had done by the words; and what is.
pub(super) fn check(one: &Did<'_>, other: Option<&Did<'_>>, time_s: f64) -> (CheckResult, String) {
    let (told, way) = (one.told, one.way(other, time_s));
    let others: Vec<Bound> = other.map_or(Vec::new(), |other| {
        let seen = other.way(Some(one), time_s).times(other.told, &[]);
        // Passing goes on while the other one does something: that one has come near by then.
        let since = |doing: &Doing, at: usize| match doing.is_pass() {
            true => at.saturating_sub(NEARS),
            false => at + doing.found_early(),
        };
        let bounds = other.told.iter().zip(seen);
        bounds
            .filter_map(|(doing, at)| {
                Some(Bound {
                    step: doing.step,
                    at: since(doing, at?),
                    moves: doing.is_aside() || doing.act == Act::Reverse,
                })
            })
            .collect()
    });
    let (alone, in_order) = (way.times(told, &[]), way.times(told, &others));
    let of = |wanted: fn(Option<usize>, Option<usize>) -> bool| -> Vec<Doing> {
        let all = told.iter().zip(alone.iter().zip(&in_order));
        all.filter(|(_, (alone, ordered))| wanted(**alone, **ordered)).map(|(doing, _)| *doing).collect()
    };
    let (missed, early) = (of(|alone, _| alone.is_none()), of(|alone, ordered| alone.is_some() && ordered.is_none()));
    match (missed.is_empty(), early.is_empty()) {
        (true, true) => (CheckResult::Shown, "all of it".to_owned()),
        (false, _) => (CheckResult::CannotBeShown, format!("not that it {}", words(&missed))),
        (true, false) => (CheckResult::CannotBeShown, format!("too early against the other: {}", words(&early))),
    }
}

/// An act of the other one, by its place in the order: when it was seen, and whether that one backed, or left its line by it.
struct Bound {
    step: u32,
    at: usize,
    moves: bool,
}

/// The states of somebody until the contact, those of the other one, when its front was in the junction, and the room in its lane.
struct Way<'a> {
    is_ego: bool,
    states: &'a [ActorState],
    other: Option<Other<'a>>,
    entered: Option<usize>,
    /// How far it may go aside that stays in its lane. [m]
    room_m: f64,
}

/// The other one's states, half of the length of both, and how far the middle of who has passed it is ahead of its middle. [m]
#[derive(Clone, Copy)]
struct Other<'a> {
    states: &'a [ActorState],
    half_m: f64,
    beyond_m: f64,
}

/// So much to the left, as much towards a side; where none is told, to either.
fn towards(side: Option<LeftRight>, left: f64) -> f64 {
    match side {
        Some(LeftRight::Left) => left,
        Some(LeftRight::Right) => -left,
        None => left.abs(),
    }
}

impl Way<'_> {
    fn speed(&self, at: usize) -> f64 {
        self.states[at].speed()
    }

    /// When each of the told acts begins, one after the other; none of them before the other one's behind which it is told, whose times
    /// these are.
    fn times(&self, told: &[Doing], others: &[Bound]) -> Vec<Option<usize>> {
        // Who goes aside or turns may have entered before.
        let (mut from, mut since) = (0, 0);
        let begins = |doing: &Doing| {
            // Who stands may have stood before.
            let bound = doing.after_other.filter(|_| doing.act != Act::Hold);
            // Behind what cannot be seen it is behind the last that can be before that.
            let behind = others.iter().filter(|other| bound.is_some_and(|bound| other.step <= bound));
            let behind = behind.max_by_key(|other| other.step);
            let least = behind.map_or(0, |other| other.at.saturating_sub(doing.before_other()));
            let earliest = if doing.is_entry() { since } else { from };
            let at = self.begins(*doing, earliest.max(least))?;
            // An ego that stopped behind that the other one backed, or left its line, did not brake long before that.
            let answers = self.is_ego && doing.comes_to_stand() && behind.is_some_and(|other| other.moves);
            if answers && self.brakes(at) + ANSWERS_EARLY < least {
                return None;
            }
            // What was under way then had begun before; who goes aside may go on to.
            if at == least && from < least && !doing.goes_aside() && self.begins(*doing, from) != Some(at) {
                return None;
            }
            let least = if doing.is_entry() { from } else { 0 };
            from = at.saturating_sub(OVERLAP).max(least);
            if !doing.is_aside() {
                since = from;
            }
            Some(at)
        };
        told.iter().map(begins).collect()
    }

    /// When who comes to a stand then began to brake for it.
    fn brakes(&self, at: usize) -> usize {
        (1..=at)
            .rev()
            .take_while(|at| self.speed(at - 1).abs() > self.speed(*at).abs() + SLOWER_MPS)
            .last()
            .map_or(at, |at| at - 1)
    }

    fn is_still(&self, at: usize) -> bool {
        self.states[at].stands()
    }

    fn last(&self) -> usize {
        self.states.len() - 1
    }

    /// The first step from this one on at which a value, of that step and a later one, begins to come to this much and does.
    fn comes_to(&self, from: usize, least: f64, value: impl Fn(usize, usize) -> f64) -> Option<usize> {
        let until = |at: usize, steps: usize| (at + steps).min(self.last());
        (from..self.last()).find(|at| {
            value(*at, until(*at, SOON)) > SOON_SHARE * least
                && (at + 1..=until(*at, LONGEST)).any(|then| value(*at, then) > least)
        })
    }

    /// How far it is ahead of the other one's middle at a step, the way that it goes itself; along that one, but where it stands across. [m]
    fn ahead_m(&self, other: &[ActorState], at: usize) -> f64 {
        let (own, other) = (&self.states[at], &other[at.min(other.len() - 1)]);
        let turned = math::wrap_angle(own.heading - other.heading).abs();
        let along = |heading: f64| Vec2::from_heading(heading).dot(own.position() - other.position());
        match turned {
            turned if turned < ALONG_RAD => along(other.heading),
            turned if turned > math::PI - ALONG_RAD => -along(other.heading),
            _ => along(own.heading),
        }
    }

    /// When it comes beside the other one, on the told side of that, behind which it was on its own way, from this step on; where it turned
    /// then, when its front is beyond that one.
    fn passes(&self, doing: Doing, from: usize) -> Option<usize> {
        let Other { states, half_m, beyond_m } = self.other?;
        let ahead_m = |at: usize| self.ahead_m(states, at);
        let left = |at: usize| {
            let (own, other) = (&self.states[at], &states[at.min(states.len() - 1)]);
            let turned = math::wrap_angle(own.heading - other.heading).abs();
            let across = (ALONG_RAD..=math::PI - ALONG_RAD).contains(&turned);
            // One that stands across has no side of its own there.
            let along = if across { own.heading } else { other.heading };
            Vec2::from_heading(along).cross(own.position() - other.position()) > 0.0
        };
        let least_m = if doing.is_pass_before_turn() { beyond_m } else { BESIDE_M - half_m };
        let behind = (from..self.last()).find(|at| ahead_m(*at) < -half_m)?;
        let beside = (behind..=self.last()).find(|at| ahead_m(*at) > least_m)?;
        doing.side.is_none_or(|side| left(beside) == (side == LeftRight::Left)).then_some(beside)
    }

    /// When somebody stands, from this step on.
    fn stands(&self, from: usize) -> Option<usize> {
        (from..=self.last()).find(|at| self.is_still(*at))
    }

    /// How far somebody goes to a side between two steps, or to any: seen along the road that it came by, until it turns off that. Who straightens
    /// out does not go aside. [m]
    fn aside_m(&self, side: Option<LeftRight>, at: usize, then: usize) -> f64 {
        let first = self.states[0].heading;
        let (now, then) = (&self.states[at], &self.states[then]);
        let along = match math::wrap_angle(now.heading - first).abs() < CHANGES_LANES_RAD {
            true => first,
            false => now.heading,
        };
        towards(side, Vec2::from_heading(along).cross(then.position() - now.position()))
    }

    /// By how much it turns to a side between two steps, or to any. [deg]
    fn turned_deg(&self, side: Option<LeftRight>, at: usize, then: usize) -> f64 {
        towards(side, math::wrap_angle(self.states[then].heading - self.states[at].heading).to_degrees())
    }

    /// How much slower it is at the second of two steps. [m/s]
    fn slower_mps(&self, at: usize, then: usize) -> f64 {
        self.speed(at) - self.speed(then)
    }

    /// Whether it brakes hard, not long before a step or behind it.
    fn brakes_hard(&self, at: usize) -> bool {
        let until_last = |at: usize| at.min(self.last());
        let mut around = at.saturating_sub(LONGEST)..until_last(at + LONGEST);
        around.any(|at| self.slower_mps(at, until_last(at + BRAKES_OVER)) > BRAKES_BY_MPS)
    }

    /// When it changes lanes and then turns, from this step on: aside, before it has turned.
    fn changes_lanes(&self, side: Option<LeftRight>, from: usize) -> Option<usize> {
        self.comes_to(from, CHANGED_LANES_M, |at, then| {
            let turned = math::wrap_angle(self.states[then].heading - self.states[at].heading).abs();
            if turned < CHANGES_LANES_RAD { self.aside_m(side, at, then) } else { 0.0 }
        })
    }

    /// When somebody that moved comes to a stand, from this step on.
    fn halts(&self, from: usize) -> Option<usize> {
        let halts = |at: &usize| self.is_still(*at) && !self.is_still(at - 1);
        let came = |at: &usize| (0..*at).any(|before| self.speed(before).abs() > CAME_MPS);
        (from.max(1)..=self.last()).find(|at| halts(at) && came(at))
    }

    /// When somebody that stands drives off, from this step on.
    fn starts(&self, from: usize) -> Option<usize> {
        let stood = self.stands(from)?;
        (stood..self.last()).find(|at| self.is_still(*at) && !self.is_still(at + 1))
    }

    /// When a told act begins, from this step on.
    fn begins(&self, doing: Doing, from: usize) -> Option<usize> {
        if doing.hard {
            return self.begins(Doing { hard: false, ..doing }, from).filter(|at| self.brakes_hard(*at));
        }
        let share = if doing.begun { BEGUN } else { 1.0 };
        let aside = |at: usize, then: usize| self.aside_m(doing.side, at, then);
        let turned = |at: usize, then: usize| self.turned_deg(doing.side, at, then);
        let slower = |at: usize, then: usize| self.slower_mps(at, then);
        let backs = || (from..=self.last()).find(|at| self.speed(*at) < -STANDS_MPS);
        match least(doing.act)? {
            Least::Aside(_) if doing.act == Act::LaneChange && doing.over && !doing.begun => {
                self.changes_lanes(doing.side, from)
            }
            Least::Speed(by) if by < 0.0 => self.comes_to(from, -by, slower),
            Least::Speed(by) => self.comes_to(from, by, |at, then| -slower(at, then)),
            Least::Stand => self.stands(from),
            // Who was coming to a stop has slowed for it.
            Least::Halt if doing.begun => self.comes_to(from, CHANGES_MPS, slower),
            Least::Halt => self.halts(from),
            Least::Start => self.starts(from),
            Least::Back => backs(),
            Least::Aside(_)
                if doing.within_lane && (from..=self.last()).any(|then| aside(from, then) > self.room_m) =>
            {
                None
            }
            Least::Aside(by) => self.comes_to(from, share * by, aside),
            Least::Turn(by) => self.comes_to(from, share * by, turned),
            Least::By if doing.begun => self.comes_to(from, BEGUN_PASS_M, aside),
            Least::By => self.passes(doing, from),
            Least::In => self.entered.filter(|at| *at >= from),
            Least::Any => self
                .comes_to(from, share * LEFT_LINE_M, aside)
                .or_else(|| self.comes_to(from, share * BENDS_DEG, turned))
                .or_else(backs),
        }
    }
}

/// For sentences.
pub(super) fn words(told: &[Doing]) -> String {
    let word = |doing: &Doing| {
        let verb = match doing.act {
            Act::Slow => "slowed",
            Act::Accelerate => "gained speed",
            Act::Stop => "stopped",
            Act::Hold => "stood",
            Act::SetOff => "set off",
            Act::Reverse => "reversed",
            Act::LaneChange => "changed lanes",
            Act::Drift => "went aside",
            Act::Swerve => "swerved",
            Act::Turn => "turned",
            Act::UTurn => "turned round",
            Act::PullOut => "pulled out",
            Act::PullOver => "pulled over",
            Act::Pass => "passed",
            Act::Enter => "entered the junction",
            Act::Park => "parked",
            // No way shows these, and none of them is asked for.
            Act::Follow => "drove on",
            Act::OpenDoor => "opened a door",
            Act::Cross => "crossed",
            Act::RunRed => "ran a red light",
            Act::RunStop => "ran a stop sign",
            Act::FailToYield => "did not yield",
            Act::Pushed => "was pushed",
            Act::WrongWay => "went against the flow",
            Act::Fall => "fell",
            Act::LoseControl => "lost control",
            Act::Roll => "rolled away",
            Act::Leave => "left",
        };
        let sideless =
            matches!(doing.act, Act::Stop | Act::Hold | Act::SetOff | Act::Slow | Act::Accelerate | Act::Reverse);
        let side = match doing.side.filter(|_| !sideless) {
            Some(LeftRight::Left) if doing.act == Act::Pass => " on the left",
            Some(LeftRight::Right) if doing.act == Act::Pass => " on the right",
            Some(LeftRight::Left) => " to the left",
            Some(LeftRight::Right) => " to the right",
            None => "",
        };
        let hard = if doing.hard { " hard" } else { "" };
        format!("{}{verb}{hard}{side}", if doing.begun { "began: " } else { "" })
    };
    told.iter().map(word).collect::<Vec<_>>().join(", ")
}
