//! What everybody with a plan does, as far as it depends on nobody who has none: for simulators that can only replay.
//!
//! The same steps as the native simulator's, without wheels and without collisions. Where a plan asks what the system under
//! test does, or somebody is pushed, the replay ends, and says why.

use super::decide::{Glimpse, Sight};
use super::names::Names;
use super::parts::{Attached, PartState};
use super::programme::{Deed, Programme, When};
use super::progress::{Mode, Progress};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::rollout::{STEP_S, SUBSTEPS};
use recrash_model::scenario::{ActorPlan, Aspect, Doing, Part};
use recrash_roads::{ActorPlacement, Scenario};

/// What everybody with a plan does.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// The recorded ego, up to the handover.
    pub ego: Option<ReplayTrack>,
    /// The actors, in the scenario's order.
    pub actors: Vec<ReplayTrack>,
    /// Parts of all of them, the actors' in order, the ego's last, as rollouts have them.
    pub parts: Vec<PartTrack>,
    /// From this step on nothing is known, and why; `None` where all is known to the end.
    pub ends: Option<(u32, String)>,
}

/// What one of them does: a state for every step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReplayTrack {
    /// x, y [m], heading [rad], velocity along x and y [m/s].
    pub states: Vec<[f64; 5]>,
    /// The first step at which it is there.
    pub appears: u32,
    /// The step at which it leaves.
    pub gone: Option<u32>,
    /// From this step on its plan changes nothing any more.
    pub over: u32,
    /// How fast it turns in its last state. [rad/s]
    pub turns_radps: f64,
}

/// Where a part is: a state for every step.
#[derive(Debug, Clone, PartialEq)]
pub struct PartTrack {
    /// Its owner's number: 0 is the ego, then partners, then actors.
    pub owner: usize,
    /// What it is.
    pub part: Part,
    /// x, y [m], heading [rad]; of the ego's, seen from the ego's centre and heading.
    pub states: Vec<[f64; 3]>,
}

/// Somebody with a plan.
struct Member<'a> {
    /// Its number: 0 is the ego, then partners, then actors.
    number: usize,
    name: &'a str,
    programme: Programme,
    progress: Progress,
    size_m: (f64, f64),
    track: ReplayTrack,
    parts: Vec<(Attached, PartState, PartTrack)>,
    /// Has touched somebody.
    hit: bool,
}

impl Member<'_> {
    fn pose(&self) -> (Pose, Vec2) {
        let (pose, velocity, _) = self.programme.motion(&self.progress);
        (pose, velocity)
    }

    fn outline(&self) -> OrientedBox {
        OrientedBox::new(self.pose().0, self.size_m.0, self.size_m.1)
    }

    /// What pushes and is pushed: itself, and its trailer.
    fn bodies(&self) -> Vec<OrientedBox> {
        let pose = self.pose().0;
        let trailers = self.parts.iter().filter(|(attached, ..)| attached.pushes());
        let trailers = trailers.map(|(attached, state, _)| attached.outline(state, pose));
        std::iter::once(self.outline()).chain(trailers).collect()
    }

    /// Writes down where everything is.
    fn note(&mut self) {
        let (pose, velocity, turns_radps) = self.programme.motion(&self.progress);
        let at = pose.position;
        self.track.turns_radps = turns_radps;
        self.track.states.push([at.x, at.y, pose.heading, velocity.x, velocity.y]);
        let owner = if self.number == 0 { Pose::default() } else { pose };
        for (attached, state, track) in &mut self.parts {
            let part = attached.pose(state, owner);
            track.states.push([part.position.x, part.position.y, part.heading]);
        }
    }

    /// Begins what is due by what it sees, turns its parts, and notes whether it leaves, and how long its plan goes on.
    fn decide(&mut self, sight: &Sight<'_>) {
        let (step, was_present, parts) = (sight.step, self.progress.present, &mut self.parts);
        self.programme.decide(&mut self.progress, self.number, sight, |part, to_rad, steps| {
            if let Some((_, state, _)) = parts.get_mut(usize::from(part)) {
                state.turn(to_rad, step, steps);
            }
        });
        if was_present && !self.progress.present {
            self.track.gone = Some(step);
        }
        if !self.programme.is_over(&self.progress) {
            self.track.over = step + 1;
        }
    }

    /// One physics step: its end, in steps.
    fn advance(&mut self, moves: bool, end: f64) {
        let before = self.pose().0;
        if moves && self.progress.present && !self.progress.stands() {
            self.programme.advance(&mut self.progress, STEP_S / SUBSTEPS as f64);
        }
        let after = self.pose().0;
        for (attached, state, _) in &mut self.parts {
            state.swing(end);
            attached.draw(state, before, after);
        }
    }
}

/// The replay of a scenario whose ego is recorded up to a step.
pub fn replay(scenario: &Scenario, handover: u32) -> Replay {
    let draft = scenario.draft();
    let partners = draft.partners.len();
    let names = Names(draft);
    let member = |number, name, plan: &ActorPlan, placement: &ActorPlacement, size_m: (f64, f64)| {
        let course = placement.course.clone();
        let half_length_m = 0.5 * placement.length_m;
        let programme = Programme::new(plan, course, placement.t_m, &placement.parts, half_length_m, &names);
        let progress = programme.start();
        let track = ReplayTrack { appears: programme.appears, ..ReplayTrack::default() };
        let facing = if number == 0 { 0.0 } else { programme.motion(&progress).0.heading };
        let attach = |part: &Part| {
            let attached = Attached { owner: number as u16, part: part.clone() };
            let track = PartTrack { owner: number, part: part.clone(), states: Vec::new() };
            (attached, PartState::resting(part, facing), track)
        };
        let parts = placement.parts.iter().map(attach).collect();
        Member { number, name, programme, progress, size_m, track, parts, hit: false }
    };
    let mut members = Vec::with_capacity(1 + draft.actors.len());
    if let (Some(placement), Some(plan)) = (scenario.recorded(), &draft.ego.recorded) {
        members.push(member(0, recrash_model::rollout::EGO_ID, plan, placement, scenario.ego_size_m()));
    }
    for (position, (actor, placement)) in draft.actors.iter().zip(scenario.actors()).enumerate() {
        let size_m = (placement.length_m, placement.width_m);
        members.push(member(1 + partners + position, &actor.id, &actor.plan, placement, size_m));
    }
    let steps = (draft.duration_s / STEP_S).ceil() as u32;
    let ends = run(&mut members, scenario, handover, steps);
    let mut tracks: Vec<ReplayTrack> = Vec::with_capacity(members.len());
    let (mut ego, mut parts, mut ego_parts) = (None, Vec::new(), Vec::new());
    for member in members {
        let own = member.parts.into_iter().map(|(.., track)| track);
        if member.number == 0 {
            ego = Some(member.track);
            ego_parts.extend(own);
        } else {
            tracks.push(member.track);
            parts.extend(own);
        }
    }
    parts.extend(ego_parts);
    Replay { ego, actors: tracks, parts, ends }
}

/// Takes everybody through the steps; where it ends before the last one, and why.
fn run(members: &mut [Member<'_>], scenario: &Scenario, handover: u32, steps: u32) -> Option<(u32, String)> {
    let draft = scenario.draft();
    let partners = draft.partners.len();
    let unknown = |step: u32, actor: u16| {
        let actor = usize::from(actor);
        (actor == 0 && step >= handover) || (1..=partners).contains(&actor)
    };
    for step in 0..=steps {
        let signals: Vec<Option<Aspect>> =
            draft.control.iter().map(|control| control.device.aspect(f64::from(step) * STEP_S)).collect();
        members.iter_mut().for_each(Member::note);
        let all = glimpses(members, 1 + partners + draft.actors.len(), |actor| unknown(step, actor));
        let sight = Sight { step, all: &all, signals: &signals };
        let waited_for = members.iter().filter_map(waits_for_ego).max();
        for member in members.iter_mut() {
            let driven = member.number == 0 && step >= handover;
            if driven && !matters(member, waited_for) {
                continue;
            }
            // Doors are opened by riders, whoever drives; but what waits for how it is driven is not known.
            if driven && !is_timed(member) {
                return Some((step, "an act of the recorded ego waits for how the ego is driven".to_owned()));
            }
            let asks = |member: &Member<'_>| if driven { None } else { asks_for(member, |actor| unknown(step, actor)) };
            if let Some(why) = asks(member) {
                return Some((step, why));
            }
            member.decide(&sight);
            if let Some(why) = asks(member) {
                return Some((step, why));
            }
        }
        if let Some(why) = advance(members, handover, step) {
            // The step in which they touch is known to its end.
            members.iter_mut().for_each(Member::note);
            return Some((step + 1, why));
        }
    }
    None
}

/// What is seen of so many; of who is unknown only what it has begun: what the recorded ego has begun stays so.
fn glimpses(members: &[Member<'_>], number: usize, unknown: impl Fn(u16) -> bool) -> Vec<Glimpse> {
    let nobody = Glimpse {
        outline: OrientedBox::new(Pose::default(), 0.0, 0.0),
        velocity: Vec2::default(),
        acceleration_mps2: 0.0,
        hit: false,
        present: false,
        begun: 0,
    };
    let mut all = vec![nobody; number];
    for member in members {
        let begun = member.progress.begun;
        all[member.number] = match unknown(member.number as u16) {
            true => Glimpse { begun, ..nobody },
            false => Glimpse {
                outline: member.outline(),
                velocity: member.pose().1,
                acceleration_mps2: member.progress.acceleration_mps2(),
                hit: member.hit,
                present: member.progress.present,
                begun,
            },
        };
    }
    all
}

/// Moves everybody through one step; who is pushed by whom, where two without the ego touch.
fn advance(members: &mut [Member<'_>], handover: u32, step: u32) -> Option<String> {
    for substep in 1..=SUBSTEPS {
        for member in members.iter_mut() {
            member.advance(member.number != 0 || step < handover, f64::from(step) + substep as f64 / SUBSTEPS as f64);
        }
        for first in 0..members.len() {
            let mine = members[first].bodies();
            for second in first + 1..members.len() {
                let (a, b) = (&members[first], &members[second]);
                if a.number == 0 || b.number == 0 || !a.progress.present || !b.progress.present {
                    continue;
                }
                if !b.bodies().iter().any(|theirs| mine.iter().any(|own| own.overlaps(theirs))) {
                    continue;
                }
                let goes_on = |member: &Member<'_>| member.programme.outlasts_a_touch(member.number as u16);
                if !goes_on(a) || !goes_on(b) {
                    return Some(format!("{} and {} push each other", a.name, b.name));
                }
                (members[first].hit, members[second].hit) = (true, true);
            }
        }
    }
    None
}

/// Why a plan goes on only with a look at somebody unknown.
fn asks_for(member: &Member<'_>, unknown: impl Fn(u16) -> bool) -> Option<String> {
    let (programme, progress) = (&member.programme, &member.progress);
    if !progress.present && progress.begun != 0 {
        return None;
    }
    let deed = |act: u8| programme.acts.get(usize::from(act)).map(|act| act.deed);
    if let Mode::Follow(act) = progress.mode
        && let Some(Deed::Follow { actor, .. }) = deed(act)
        && unknown(actor)
    {
        return Some(format!("{} follows somebody who has no plan then", member.name));
    }
    let (position, when) = progress.awaits(programme)?;
    match when {
        // Whoever has been hit ends a run where nobody can be pushed.
        When::State { is: Doing::Hit, .. } => None,
        When::Near { actor, .. } | When::State { actor, .. } if unknown(actor) => {
            Some(format!("act {} of {} waits for somebody who has no plan then", position + 1, member.name))
        }
        _ => None,
    }
}

/// The last act of the recorded ego that somebody still waits for.
fn waits_for_ego(member: &Member<'_>) -> Option<u8> {
    let rest = member.programme.acts.iter().skip(usize::from(member.progress.next));
    let waits = rest.filter_map(|planned| match planned.when {
        Some(When::Act { actor: 0, act }) => Some(act),
        _ => None,
    });
    waits.max()
}

/// Whether anybody sees that the recorded ego's next act begins, when somebody else drives.
fn matters(ego: &Member<'_>, waited_for: Option<u8>) -> bool {
    let next = ego.progress.next;
    let rest = ego.programme.acts.iter().skip(usize::from(next));
    let left = usize::from(next) < ego.programme.acts.len();
    left && (waited_for.is_some_and(|act| act >= next)
        || rest.into_iter().any(|act| matches!(act.deed, Deed::Part { .. })))
}

/// Whether its next act begins without a look at how it moves.
fn is_timed(ego: &Member<'_>) -> bool {
    let act = ego.programme.acts.get(usize::from(ego.progress.next));
    ego.progress.due.is_some()
        || act.is_some_and(|act| matches!(act.when, Some(When::Step(_) | When::Signal { .. } | When::Act { .. })))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight road, an ego recorded at 10 m/s, and a car ahead of it that does something.
    fn scenario(actors: &str) -> Scenario {
        let text = format!(
            r#"{{ "format": "recrash.scenario/2", "id": "t", "source": {{}}, "duration_s": 4,
                "map": {{ "type": "G", "roads": [{{ "id": "main", "start": {{ "at": {{ "x_m": 0, "y_m": 0, "heading_deg": 0 }} }},
                    "line": [{{ "straight": {{ "length_m": 200 }} }}], "right": [{{ "kind": "driving" }}] }}] }},
                "ego": {{ "route": ["main+"], "target_speed_mps": 10, "handover_s": 1,
                    "recorded": {{ "start": {{ "road": "main+", "s_m": 20 }}, "speed_mps": 10,
                        "course": [{{ "lanes": {{ "roads": ["main+"] }} }}],
                        "acts": [{{ "id": "brake", "when": {{ "time_s": 0.5 }}, "do": {{ "stop": {{ "rate_mps2": 2 }} }} }}] }} }},
                "actors": [{actors}] }}"#
        );
        let draft = recrash_roads::read_draft(&text).unwrap_or_else(|problems| panic!("{problems:#?}")).value;
        recrash_roads::check(draft).unwrap_or_else(|problems| panic!("{problems:#?}")).value
    }

    fn car(id: &str, s_m: f64, acts: &str) -> String {
        format!(
            r#"{{ "id": "{id}", "plan": {{ "start": {{ "road": "main+", "s_m": {s_m} }}, "speed_mps": 8,
                "course": [{{ "lanes": {{ "roads": ["main+"] }} }}], "acts": [{acts}] }} }}"#
        )
    }

    #[test]
    fn who_has_stopped_to_reverse_stays_where_it_stands() {
        let back_and_forth = r#"{ "id": "cp", "plan": { "start": { "x_m": 60, "y_m": 0 }, "speed_mps": 4,
            "course": [{ "curve": { "to": { "x_m": 64, "y_m": 0 } } }, { "curve": { "to": { "x_m": 60, "y_m": 0 }, "reverse": true } }],
            "acts": [{ "do": { "stop": { "rate_mps2": 2 } } },
                     { "when": { "time_s": 2.6 }, "do": { "speed": { "to_mps": 1.5, "rate_mps2": 1.5 } } }] } }"#;
        let states = &replay(&scenario(back_and_forth), 10).actors[0].states;
        let stands = states.iter().filter(|state| state[3] == 0.0).count();
        let backwards = states.iter().filter(|state| state[3] < 0.0).count();
        assert!(stands > 3 && backwards > 3, "{states:?}");
        for pair in states.windows(2) {
            assert!((pair[1][0] - pair[0][0]).abs() < 0.41 && pair[1][2].abs() < 1e-9, "{pair:?}");
        }
    }

    #[test]
    fn who_asks_nobody_is_known_to_the_end() {
        let replay = replay(&scenario(&car("cp", 60.0, "")), 10);
        assert_eq!(replay.ends, None);
        let states = &replay.actors[0].states;
        assert_eq!(states.len(), 41);
        assert!((states[30][0] - (60.0 + 3.0 * 8.0)).abs() < 1e-9, "{:?}", states[30]);
    }

    #[test]
    fn an_act_of_the_recorded_ego_is_seen_and_who_watches_the_driven_one_is_told() {
        let after_brake =
            r#"{ "when": { "act": { "actor": "ego", "act": "brake" } }, "do": { "stop": { "rate_mps2": 4 } } }"#;
        let seen = replay(&scenario(&car("cp", 60.0, after_brake)), 10);
        assert_eq!(seen.ends, None);
        assert!(seen.actors[0].states[40][3].abs() < 1e-9, "it stands: {:?}", seen.actors[0].states[40]);
        let near = r#"{ "when": { "near": { "actor": "ego", "within_m": 3 } }, "do": { "stop": { "rate_mps2": 4 } } }"#;
        let (step, why) = replay(&scenario(&car("cp", 60.0, near)), 10).ends.expect("it watches the ego");
        assert_eq!(step, 10);
        assert!(why.contains("act 1 of cp"), "{why}");
        // Recorded to the end, it is known.
        assert_eq!(replay(&scenario(&car("cp", 60.0, near)), u32::MAX).ends, None);
    }

    #[test]
    fn a_push_ends_it_in_the_step_of_the_touch() {
        let standing = r#"{ "when": { "time_s": 0 }, "do": { "stop": { "rate_mps2": 12 } } }"#;
        let both = format!("{}, {}", car("front", 80.0, standing), car("behind", 70.0, ""));
        let (step, why) = replay(&scenario(&both), 10).ends.expect("they touch");
        // The front one stands after 8 / 12 s and 2.67 m; the gap is 10 - 4.515 m.
        let touch_s = (10.0 - 4.515 + 8.0 * 8.0 / 24.0) / 8.0;
        assert!((f64::from(step) * STEP_S - touch_s).abs() <= 0.12, "{step} {touch_s}");
        assert_eq!(why, "front and behind push each other");
    }
}
