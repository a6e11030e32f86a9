//! What led to a failure, told from its rollout and the road. Rules and limits: `docs/models/causes.md`.

use recrash_model::cause::Cause;
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::metrics::{Finding, FindingKind, Metrics};
use recrash_model::results::{TestOutcome, TestResult, TestVerdict};
use recrash_model::rollout::{ActorState, ActorTrack, Rollout, STEP_S};
use recrash_model::scenario::MapSpec;
use recrash_model::zones::ContactZone;
use recrash_roads::{LaneId, RoadNetwork, RoadPart};
use serde::Serialize;
use std::collections::BTreeMap;

/// Slower than this somebody stands. Assumed. [m/s]
const STANDS_MPS: f64 = 0.5;
/// Who has stood for so long stands; less is a stop that was still going on. Assumed. [s]
const STANDS_S: f64 = 1.0;
/// How far back is looked: a driver who reacts at all has reacted by then (green2000: 1.5 s to a surprise). [s]
const BEFORE_S: f64 = 2.0;
/// Braking from here on is a reaction; less is what rolling, bends and speed keeping take. Assumed. [m/s^2]
const REACTION_MPS2: f64 = 1.5;
/// Braking is taken over this many steps.
const BRAKING_STEPS: usize = 3;
/// Who creeps at the contact, drove before and has not stood since, has braked. Assumed. [m/s]
const CREEPS_MPS: f64 = 1.0;
const DROVE_MPS: f64 = 3.0;
const STOOD_MPS: f64 = 0.1;
/// Braking with nothing in the way counts from here on, and this long before the contact. Assumed. [m/s^2, s]
const PHANTOM_MPS2: f64 = 2.0;
const PHANTOM_S: f64 = 4.0;
/// A turn is more than this within four seconds. Assumed: a lane change is less. [rad]
const TURN_RAD: f64 = 25.0 * math::PI / 180.0;
const TURN_S: f64 = 4.0;
/// Who heads within this of the ego goes its way; beyond its opposite, comes towards it. [rad]
const SAME_WAY_RAD: f64 = 45.0 * math::PI / 180.0;
/// Going sideways by more than this is a move; lane keeping takes less. Assumed. [m]
const SIDEWAYS_M: f64 = 0.8;
/// Who is farther beside a lane than this is not along it: two lanes. Assumed. [m]
const BESIDE_M: f64 = 8.0;
/// Whom it could have seen ahead: within this of its heading. [rad]
const AHEAD_RAD: f64 = 100.0 * math::PI / 180.0;
/// A gap to the one ahead of less than this, in time, is too close (the two-second rule halved; assumed). [s]
const CLOSE_S: f64 = 1.0;

/// The contact that a failure is, with what came before it.
struct Encounter<'a> {
    network: &'a RoadNetwork,
    metrics: &'a Metrics,
    ego: &'a ActorTrack,
    other: &'a ActorTrack,
    /// Last step before the contact.
    end: usize,
    time_s: f64,
    at: [ActorState; 2],
    zone: ContactZone,
}

/// One rule.
type Rule = fn(&Encounter) -> bool;

/// Rules of contacts, in order: the first that holds tells the cause.
const RULES: [(Cause, Rule); 12] = [
    (Cause::StoodInTheWay, |e| e.stood(e.ego) && !e.goes_same_way() && e.blocks()),
    (Cause::StruckStanding, |e| e.stood(e.ego)),
    (Cause::BrakedForNothing, |e| e.is_behind() && !e.stood(e.other) && e.braked_for_nothing()),
    (Cause::TurnedAcross, |e| {
        e.turned(e.ego) && !e.turned(e.other) && !e.stood(e.other) && !e.is_behind() && !e.goes_same_way_before()
    }),
    (Cause::MovedInto, |e| e.goes_same_way() && e.sideways_m(e.ego) > SIDEWAYS_M.max(e.sideways_m(e.other))),
    (Cause::WasStruck, |e| !e.is_frontal() && !e.was_ahead()),
    (Cause::MetCutIn, |e| e.goes_same_way() && !e.stood(e.other) && e.sideways_m(e.other) > SIDEWAYS_M),
    (Cause::IgnoredCrossing, |e| !e.reacted() && e.crosses()),
    (Cause::IgnoredOncoming, |e| !e.reacted() && !e.goes_same_way() && !e.stood(e.other)),
    (Cause::IgnoredAhead, |e| !e.reacted()),
    (Cause::FollowedTooClosely, |e| e.goes_same_way() && !e.stood(e.other) && e.followed_closely()),
    (Cause::BrakedLate, |_| true),
];

/// What led to the first crash of a run, or where there is none, to its first failure; `None` where it has not failed.
pub fn cause(network: &RoadNetwork, rollout: &Rollout, metrics: &Metrics, findings: &[Finding]) -> Option<Cause> {
    let crash = findings.iter().find(|finding| finding.kind.is_crash());
    let first = crash.or_else(|| findings.iter().find(|finding| finding.kind.is_failure()))?;
    Some(match first.kind {
        FindingKind::Contact => {
            let encounter = Encounter::of(network, rollout, metrics)?;
            RULES.iter().find(|(_, holds)| holds(&encounter))?.0
        }
        FindingKind::ObstacleContact => Cause::HitObject,
        FindingKind::OffRoad => Cause::LeftRoad,
        FindingKind::Stuck => Cause::StoppedForGood,
        FindingKind::NearMiss => Cause::PassedTooNear,
        FindingKind::HardBraking
        | FindingKind::BrakingBeyondTyres
        | FindingKind::PhantomBraking
        | FindingKind::Oscillation
        | FindingKind::LaneDeparture => return None,
    })
}

impl<'a> Encounter<'a> {
    fn of(network: &'a RoadNetwork, rollout: &'a Rollout, metrics: &'a Metrics) -> Option<Self> {
        let (actor, time_s, ego_at, other_at) = rollout.first_ego_contact()?;
        let (ego, other) = (rollout.actors.first()?, rollout.actors.get(actor)?);
        let last = ego.states.len().min(other.states.len()).checked_sub(1)?;
        let end = ((time_s / STEP_S + 1e-6).floor() as usize).min(last);
        let zone = metrics.contact.as_ref()?.ego_zone;
        Some(Self { network, metrics, ego, other, end, time_s, at: [ego_at, other_at], zone })
    }

    /// The state so long before the contact.
    fn before<'t>(&self, track: &'t ActorTrack, seconds: f64) -> &'t ActorState {
        &track.states[self.end.saturating_sub((seconds / STEP_S).round() as usize)]
    }

    fn window<'t>(&self, track: &'t ActorTrack, seconds: f64) -> &'t [ActorState] {
        &track.states[self.end.saturating_sub((seconds / STEP_S).round() as usize)..=self.end]
    }

    /// Whether somebody had been standing.
    fn stood(&self, track: &ActorTrack) -> bool {
        self.window(track, STANDS_S).iter().all(|state| state.velocity().length() < STANDS_MPS)
    }

    /// Whether the ego, somewhere along its middle, is on a lane whose direction is another one than its own.
    fn blocks(&self) -> bool {
        let state = &self.ego.states[self.end];
        let forward = Vec2::from_heading(state.heading);
        let crosses = |point: Vec2| {
            self.network.lanes.iter().any(|lane| {
                let is_driven = !matches!(self.network.road(lane.road).part, RoadPart::Beside(_));
                let turned = || math::wrap_angle(lane.heading(lane.local(point).0) - state.heading).abs();
                is_driven && lane.contains(point) && turned() > SAME_WAY_RAD
            })
        };
        [-0.5, 0.0, 0.5].into_iter().any(|share| crosses(state.position() + forward * (share * self.ego.length_m)))
    }

    fn is_frontal(&self) -> bool {
        matches!(self.zone, ContactZone::Front | ContactZone::FrontLeft | ContactZone::FrontRight)
    }

    fn is_behind(&self) -> bool {
        matches!(self.zone, ContactZone::Rear | ContactZone::RearLeft | ContactZone::RearRight)
    }

    fn braked_for_nothing(&self) -> bool {
        self.metrics.ego.phantom_braking.is_some_and(|braking| {
            braking.value >= PHANTOM_MPS2 && (0.0..=PHANTOM_S).contains(&(self.time_s - braking.time_s))
        })
    }

    fn turned(&self, track: &ActorTrack) -> bool {
        let now = track.states[self.end].heading;
        math::wrap_angle(now - self.before(track, TURN_S).heading).abs() > TURN_RAD
    }

    /// Between the ways of the two: 0 for the same way. [rad]
    fn between_rad(ego: &ActorState, other: &ActorState) -> f64 {
        math::wrap_angle(other.heading - ego.heading).abs()
    }

    fn goes_same_way(&self) -> bool {
        Self::between_rad(&self.at[0], &self.at[1]) < SAME_WAY_RAD
    }

    fn goes_same_way_before(&self) -> bool {
        Self::between_rad(self.before(self.ego, TURN_S), self.before(self.other, TURN_S)) < SAME_WAY_RAD
    }

    fn crosses(&self) -> bool {
        let between = Self::between_rad(&self.at[0], &self.at[1]);
        (SAME_WAY_RAD..=math::PI - SAME_WAY_RAD).contains(&between) && !self.stood(self.other)
    }

    /// How far somebody went across the way that it had: along its lane and those that follow it; straight on where there is
    /// none, it does not go along it or backs, or a junction begins, in which to turn is to leave one's line. [m]
    fn sideways_m(&self, track: &ActorTrack) -> f64 {
        let (from, to) = (self.before(track, BEFORE_S), &track.states[self.end]);
        let straight_m = || {
            let across = Vec2::from_heading(from.heading).left();
            (to.position() - from.position()).dot(across).abs()
        };
        let Some(id) = self.network.lane_at(from.position(), from.heading) else { return straight_m() };
        let lane = self.network.lane(id);
        let (s, before_m) = lane.local(from.position());
        let backs = from.velocity().dot(Vec2::from_heading(from.heading)) < 0.0;
        if backs || math::wrap_angle(lane.heading(s) - from.heading).abs() > SAME_WAY_RAD {
            return straight_m();
        }
        let reach_m = s + 2.0 * from.position().distance(to.position());
        self.beside_m(id, to.position(), reach_m).map_or_else(straight_m, |now_m| (now_m - before_m).abs())
    }

    /// How far to the right of a lane, or of one that follows within reach, a place lies: the least of them. [m]
    fn beside_m(&self, id: LaneId, place: Vec2, reach_m: f64) -> Option<f64> {
        let lane = self.network.lane(id);
        if self.network.road(lane.road).part == RoadPart::Inner && !matches!(self.network.map, MapSpec::C(_)) {
            return None;
        }
        let (s, t) = lane.local(place);
        if (0.0..=lane.length_m).contains(&s) && t.abs() < BESIDE_M {
            return Some(t);
        }
        if reach_m <= lane.length_m {
            return None;
        }
        let next = self.network.followers[usize::from(id.0)].iter();
        let all = next.filter_map(|&next| self.beside_m(next, place, reach_m - lane.length_m));
        all.min_by(|a, b| a.abs().total_cmp(&b.abs()))
    }

    /// Whether the other was where a driver looks.
    fn was_ahead(&self) -> bool {
        let (ego, other) = (self.before(self.ego, BEFORE_S), self.before(self.other, BEFORE_S));
        let to = other.position() - ego.position();
        let forward = Vec2::from_heading(ego.heading);
        math::atan2(forward.cross(to), forward.dot(to)).abs() < AHEAD_RAD
    }

    fn reacted(&self) -> bool {
        let window = self.window(self.ego, BEFORE_S);
        let braking = window.windows(BRAKING_STEPS + 1).map(|states| {
            (states[0].velocity().length() - states[BRAKING_STEPS].velocity().length())
                / (BRAKING_STEPS as f64 * STEP_S)
        });
        braking.fold(0.0, f64::max) >= REACTION_MPS2 || self.had_braked()
    }

    /// Whether it creeps, having come down from more and not stood since: it reacted before the window.
    fn had_braked(&self) -> bool {
        let speeds = || self.ego.states[..=self.end].iter().rev().map(|state| state.velocity().length());
        let creeps = speeds().next().is_some_and(|speed| speed < CREEPS_MPS);
        creeps && speeds().take_while(|speed| *speed >= STOOD_MPS).any(|speed| speed > DROVE_MPS)
    }

    /// Whether the gap was small, in time, before either braked.
    fn followed_closely(&self) -> bool {
        let (ego, other) = (self.before(self.ego, TURN_S), self.before(self.other, TURN_S));
        let distance_m = (other.position() - ego.position()).dot(Vec2::from_heading(ego.heading));
        let gap_m = distance_m - 0.5 * (self.ego.length_m + self.other.length_m);
        (0.0..CLOSE_S * ego.velocity().length()).contains(&gap_m)
    }
}

/// Tests that failed of one cause: one finding with many scenarios.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CauseGroup {
    /// The cause; absent where no rule holds.
    pub cause: Option<Cause>,
    /// Tests, by id.
    pub tests: Vec<String>,
    /// The one whose run is shortest: the first to look at.
    pub example: String,
    /// Greatest change of velocity in a contact among them. [m/s]
    pub worst_delta_v_mps: f64,
}

/// Failed tests by cause: the most frequent first, then in the order of the rules.
pub fn by_cause(tests: &[TestResult]) -> Vec<CauseGroup> {
    let mut groups: BTreeMap<Option<usize>, Vec<(&str, &TestOutcome)>> = BTreeMap::new();
    for test in tests.iter().filter(|test| test.verdict() == TestVerdict::Failed) {
        let Some(outcome) = test.telling().and_then(|run| run.outcome.as_ref()) else { continue };
        let place = outcome.cause.and_then(|cause| Cause::ALL.iter().position(|other| *other == cause));
        groups.entry(place).or_default().push((&test.id, outcome));
    }
    let group = |(place, members): (Option<usize>, Vec<(&str, &TestOutcome)>)| {
        let shortest = members.iter().min_by(|a, b| a.1.duration_s.total_cmp(&b.1.duration_s).then(a.0.cmp(b.0)));
        CauseGroup {
            cause: place.map(|place| Cause::ALL[place]),
            example: shortest.map_or_else(String::new, |(id, _)| (*id).to_owned()),
            worst_delta_v_mps: members.iter().map(|(_, outcome)| outcome.harm_mps()).fold(0.0, f64::max),
            tests: members.iter().map(|(id, _)| (*id).to_owned()).collect(),
        }
    };
    let mut groups: Vec<CauseGroup> = groups.into_iter().map(group).collect();
    groups.sort_by_key(|group| std::cmp::Reverse(group.tests.len()));
    groups
}

#[cfg(test)]
mod tests;
