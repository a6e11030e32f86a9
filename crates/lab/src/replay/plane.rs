//! Where everybody is in the coordinates of the scenario, for who changes it.

use super::{degrees, first_contact_step};
use recrash_metrics::contact::contact_geometry;
use recrash_model::geometry::{OrientedBox, Pose};
use recrash_model::rollout::{ActorState, ActorTrack, PlacedObstacle, Role, Rollout, STEP_S};

/// Steps between two lines.
const LINE_STEPS: usize = 10;

/// A part of this length is a trailer or an arm, and no door or mirror. [m]
const LONG_PART_M: f64 = 2.5;

/// Centres and headings in the plane, every second and at the first contact; of a run in which the ego touches nobody, how near it came
/// to each.
pub fn in_the_plane(rollout: &Rollout) -> String {
    let contact = first_contact_step(rollout);
    let is_shown = |actor: &&ActorTrack| actor.role != Role::Part || actor.length_m >= LONG_PART_M;
    let users: Vec<&ActorTrack> = rollout.actors.iter().filter(is_shown).collect();
    let place = |actor: &ActorTrack, step: usize| {
        let state = &actor.states[step];
        let (at, heading) = (state.position(), degrees(state.heading));
        format!("{} ({:.2}, {:.2}, {heading})", actor.id, at.x, at.y)
    };
    let line = |step: usize| {
        let there = users.iter().filter(|actor| actor.is_present(step));
        format!(
            "{:4.1} s: {}",
            step as f64 * STEP_S,
            there.map(|actor| place(actor, step)).collect::<Vec<_>>().join(", ")
        )
    };
    let mut lines = vec!["Centres in the plane (x m, y m, heading deg):".to_owned()];
    lines.extend((0..=contact).filter(|step| *step == contact || step.is_multiple_of(LINE_STEPS)).map(line));
    lines.extend(place_of_touch(rollout));
    if rollout.first_contact_of(0).is_none() {
        let whole = users[1..].iter().filter(|other| other.part_of.is_none());
        lines.extend(whole.filter_map(|other| nearest(users[0], other)));
        lines.extend(nearest_thing(users[0], &rollout.obstacles));
    }
    lines.join("\n") + "\n"
}

/// Where on both bodies the ego and the first whom it touches meet.
fn place_of_touch(rollout: &Rollout) -> Option<String> {
    let (other, _, own_state, other_state) = rollout.first_ego_contact()?;
    let outline = |actor: usize, state: &ActorState| {
        OrientedBox::new(state.pose(), rollout.actors[actor].length_m, rollout.actors[actor].width_m)
    };
    let (own, of_other) = (outline(0, &own_state), outline(other, &other_state));
    let touch = contact_geometry(&own, own_state.velocity(), &of_other, other_state.velocity());
    let place = |outline: &OrientedBox, id: &str| {
        let at = outline.to_local(touch.point);
        let (along, aside) = (if at.x < 0.0 { "behind" } else { "ahead" }, if at.y < 0.0 { "right" } else { "left" });
        format!("{:.1} m {along} and {:.1} m to the {aside} of the centre of {id}", at.x.abs(), at.y.abs())
    };
    let id = &rollout.actors[other].id;
    Some(format!("The contact of ego and {id} is {}, {}", place(&own, "ego"), place(&of_other, id)))
}

/// How near two came to each other, and where both were then.
fn nearest(ego: &ActorTrack, other: &ActorTrack) -> Option<String> {
    let gap = |step: usize| ego.outline(step).gap(&other.outline(step));
    let there = (0..ego.states.len()).filter(|step| other.is_present(*step));
    let (gap_m, step) = there.map(|step| (gap(step), step)).min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(gap_line((gap_m, step), ego, &other.id, other.states[step].pose()))
}

/// How near the ego came to the thing that it came nearest to.
fn nearest_thing(ego: &ActorTrack, things: &[PlacedObstacle]) -> Option<String> {
    let gaps = things.iter().enumerate().flat_map(|(number, thing)| {
        let outline = thing.outline();
        (0..ego.states.len()).map(move |step| (ego.outline(step).gap(&outline), step, number))
    });
    let (gap_m, step, number) = gaps.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(gap_line((gap_m, step), ego, &format!("thing {number}"), things[number].pose))
}

fn gap_line((gap_m, step): (f64, usize), ego: &ActorTrack, other: &str, at: Pose) -> String {
    let place = |pose: Pose| format!("({:.2}, {:.2}, {})", pose.position.x, pose.position.y, degrees(pose.heading));
    let time_s = step as f64 * STEP_S;
    let own = place(ego.states[step].pose());
    format!("Least gap of ego and {other}: {gap_m:.2} m at {time_s:.1} s, at {own} and {}", place(at))
}
