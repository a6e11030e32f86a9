//! Who touches whom.

use crate::chassis::Controls;
use crate::scene::Seen;
use crate::world::{Setting, State, Workspace};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::math;
use recrash_model::rollout::{ActorState, Event, EventKind, STEP_S};

/// The pairs that may touch within the next step: those whose circles, widened by what both can drive, overlap.
pub(crate) fn find_near(setting: &Setting, state: &State, near: &mut Vec<(u16, u16)>) {
    near.clear();
    let actors = state.seen.len();
    let columns = actors + setting.obstacles.len();
    let radius = |seen: &Seen| (math::sq(seen.half_length) + math::sq(seen.half_width)).sqrt();
    for (a, first) in state.seen.iter().enumerate().filter(|(_, seen)| seen.present) {
        let reach = radius(first) + (first.speed + 1.0) * STEP_S;
        for (b, second) in state.seen.iter().enumerate().skip(a + 1).filter(|(_, seen)| seen.present) {
            let reach = reach + radius(second) + (second.speed + 1.0) * STEP_S;
            let offset = second.pose.position - first.pose.position;
            if offset.length_squared() <= reach * reach && !state.touched[a * columns + b] {
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
            if offset.length_squared() > reach * reach || !outline(a).overlaps(&outline(b)) {
                return true;
            }
            EventKind::Contact { a, b, a_state: state_of(a), b_state: state_of(b) }
        } else {
            let obstacle = b - actors;
            if !outline(a).overlaps(&setting.obstacles[obstacle].outline) {
                return true;
            }
            EventKind::ObstacleContact { actor: a, obstacle, state: state_of(a) }
        };
        state.touched[a * columns + b] = true;
        if b < actors {
            state.halted[a] = true;
            state.halted[b] = true;
            state.ego_contact |= a == 0;
        }
        workspace.events.push(Event { time_s, kind });
        false
    });
}

/// A state as it is recorded.
pub(crate) fn actor_state(pose: Pose, velocity: Vec2, controls: Controls) -> ActorState {
    ActorState {
        x: pose.position.x,
        y: pose.position.y,
        heading: math::wrap_angle(pose.heading),
        vx: velocity.x,
        vy: velocity.y,
        steer: controls.steer,
        throttle: controls.throttle,
    }
}
