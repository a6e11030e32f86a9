//! Who touches whom.

use crate::impact;
use crate::movement::{Loose, Mover};
use crate::scene::Seen;
use crate::world::{Setting, State, Workspace, actor_state};
use recrash_model::geometry::OrientedBox;
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{Event, EventKind, STEP_S};

/// A thing lighter than this share of who hits it does not put that one off its way; assumed.
const LIGHT: f64 = 0.05;

/// Who has touched and drives on has left the other when they are this far apart. [m]
const APART_M: f64 = 0.05;

/// The pairs that may touch within the next step: those whose circles, widened by what both can drive, overlap.
pub(crate) fn find_near(setting: &Setting, state: &mut State, near: &mut Vec<(u16, u16)>) {
    near.clear();
    let actors = state.seen.len();
    let columns = actors + setting.obstacles.len();
    let radius = |actor: usize, seen: &Seen| {
        (math::sq(seen.half_length) + math::sq(seen.half_width)).sqrt().max(setting.parts_reach_m[actor])
    };
    for (a, first) in state.seen.iter().enumerate().filter(|(_, seen)| seen.present) {
        let reach = radius(a, first) + (first.speed + 1.0) * STEP_S;
        for (b, second) in state.seen.iter().enumerate().skip(a + 1).filter(|(_, seen)| seen.present) {
            let reach = reach + radius(b, second) + (second.speed + 1.0) * STEP_S;
            let offset = second.pose.position - first.pose.position;
            if offset.length_squared() > reach * reach {
                continue;
            }
            let pair = a * columns + b;
            // Who drives on after a touch may touch again.
            if state.touched[pair]
                && (goes_on(setting, state, a) || goes_on(setting, state, b))
                && first.outline().gap(&second.outline()) > APART_M
            {
                state.touched[pair] = false;
            }
            if !state.touched[pair] {
                near.push((a as u16, b as u16));
            }
        }
        for (position, obstacle) in setting.obstacles.iter().enumerate() {
            let reach = reach + obstacle.outline.radius();
            let offset = obstacle.outline.centre - first.pose.position;
            if offset.length_squared() <= reach * reach && !state.touched[a * columns + actors + position] {
                near.push((a as u16, (actors + position) as u16));
            }
        }
    }
}

/// Notes every first contact at this physics step, and who brakes for good because of it.
pub(crate) fn collide(setting: &Setting, state: &mut State, workspace: &mut Workspace, time_s: f64) {
    let actors = state.seen.len();
    let columns = actors + setting.obstacles.len();
    workspace.near.retain(|&(a, b)| {
        let (a, b) = (usize::from(a), usize::from(b));
        let outline = |actor: usize| {
            let member = &setting.cast[actor];
            OrientedBox::new(state.bodies[actor].pose, member.length_m, member.width_m)
        };
        let state_of = |actor: usize| {
            let body = &state.bodies[actor];
            actor_state(body.pose, body.velocity(), state.controls[actor])
        };
        let kind = if b < actors {
            // Circles first: the boxes cost a sine and a cosine each.
            let (first, second) = (&state.seen[a], &state.seen[b]);
            let reach = first.half_length + first.half_width + second.half_length + second.half_width;
            let offset = state.bodies[b].pose.position - state.bodies[a].pose.position;
            let parts_m = setting.parts_reach_m[a] + setting.parts_reach_m[b];
            let reach = reach + parts_m;
            if offset.length_squared() > reach * reach {
                return true;
            }
            let bodies = outline(a).overlaps(&outline(b));
            if !bodies && (parts_m == 0.0 || !parts_touch(setting, state, a, b)) {
                return true;
            }
            EventKind::Contact { a, b, a_state: state_of(a), b_state: state_of(b) }
        } else {
            let obstacle = b - actors;
            let thing = &setting.obstacles[obstacle].outline;
            if !outline(a).overlaps(thing) && !boxes_of(setting, state, a).skip(1).any(|part| part.overlaps(thing)) {
                return true;
            }
            EventKind::ObstacleContact { actor: a, obstacle, state: state_of(a) }
        };
        state.touched[a * columns + b] = true;
        if b < actors {
            state.halted[a] = true;
            state.halted[b] = true;
            if a == 0 && !state.ego_contact {
                state.ego_contact = true;
                state.contact_s = time_s;
            }
            push(setting, state, a, b);
        }
        workspace.events.push(Event { time_s, kind });
        false
    });
}

/// Whether it keeps to its plan after a touch.
fn goes_on(setting: &Setting, state: &State, actor: usize) -> bool {
    setting.outlasts_a_touch[actor] && state.movers[actor] == Mover::Plan
}

/// Whether what it has hit is a thing too light to matter.
fn shrugs_off(setting: &Setting, actor: usize, other: usize) -> bool {
    setting.cast[other].kind == PartnerKind::FixedObject && setting.masses_kg[other] < LIGHT * setting.masses_kg[actor]
}

/// The boxes of an actor: its own, then those of its parts.
fn boxes_of<'a>(setting: &'a Setting, state: &'a State, actor: usize) -> impl Iterator<Item = OrientedBox> + 'a {
    let (member, pose) = (&setting.cast[actor], state.bodies[actor].pose);
    let own = OrientedBox::new(pose, member.length_m, member.width_m);
    let parts = setting.parts.iter().zip(&state.parts).filter(move |(part, _)| usize::from(part.owner) == actor);
    std::iter::once(own).chain(parts.map(move |(part, now)| part.outline(now, pose)))
}

fn parts_touch(setting: &Setting, state: &State, a: usize, b: usize) -> bool {
    boxes_of(setting, state, a).any(|mine| boxes_of(setting, state, b).any(|theirs| mine.overlaps(&theirs)))
}

/// Passes momentum on between two who touch, where one of them moves by a plan or has been pushed: both are left to their
/// momentum then. A touch of a door or a mirror pushes nobody.
fn push(setting: &Setting, state: &mut State, a: usize, b: usize) {
    let planned = |actor: usize| state.movers[actor] != Mover::Wheels;
    let ego_goes_on = setting.after_contact_s > 0.0;
    if !(planned(a) || planned(b) || (a == 0 && ego_goes_on)) {
        return;
    }
    let heavy = |actor: usize| {
        let parts = setting.parts.iter().zip(&state.parts).filter(move |(part, _)| usize::from(part.owner) == actor);
        let pose = state.bodies[actor].pose;
        let own = OrientedBox::new(pose, setting.cast[actor].length_m, setting.cast[actor].width_m);
        std::iter::once(own)
            .chain(parts.filter(|(part, _)| part.pushes()).map(move |(part, now)| part.outline(now, pose)))
    };
    let touching = heavy(a).find_map(|mine| heavy(b).find(|theirs| mine.overlaps(theirs)).map(|theirs| (mine, theirs)));
    let Some((mine, theirs)) = touching else { return };
    let body = |actor: usize, outline: OrientedBox| impact::Body {
        outline,
        velocity: state.bodies[actor].velocity(),
        yaw_rate: state.bodies[actor].yaw_rate(),
        mass_kg: setting.masses_kg[actor],
    };
    let (first, second) = impact::collide(&body(a, mine), &body(b, theirs));
    for (actor, other, after) in [(a, b, first), (b, a, second)] {
        if goes_on(setting, state, actor) || shrugs_off(setting, actor, other) {
            continue;
        }
        state.loose[actor] = Loose { pose: state.bodies[actor].pose, ..after };
        state.movers[actor] = Mover::Momentum;
    }
}
