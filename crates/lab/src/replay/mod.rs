//! A replay in words: a scenario and what its rollout shows, for a reader who has no picture, person or language model. It says
//! what is there and what moves, seen from the ego, and nothing of what anybody thinks of it.

mod ground;
mod plane;
mod strips;
#[cfg(test)]
mod tests;

pub use plane::in_the_plane;

use recrash_metrics::contact::contact_geometry;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{
    ActorState, ActorTrack, Event, EventKind, PlacedObstacle, Role, Rollout, STEP_S, TerminationKind,
};
use recrash_model::scenario::{MapSpec, ScenarioDraft};

/// Steps between two lines of who is where; the last step before the first contact has one as well.
const LINE_STEPS: usize = 5;
/// So many steps after the first contact are told.
const STEPS_AFTER: usize = 10;
/// Parts shorter than this are doors, others of their owner's kind are arms. [m]
const DOOR_M: f64 = 1.5;
/// An arm that has turned by more than this is seen to turn. [deg]
const TURNS_DEG: i64 = 1;

/// The replay of a scenario.
pub fn in_words(draft: &ScenarioDraft, rollout: &Rollout) -> String {
    let contact = first_contact_step(rollout);
    let mut lines = ground::map(&draft.map);
    lines.extend(ground::controls(draft, rollout));
    lines.extend(rollout.obstacles.iter().enumerate().map(|(number, thing)| placed(rollout, number, thing)));
    lines.push(format!(
        "Road users: {}",
        rollout.actors.iter().map(|actor| user(rollout, actor)).collect::<Vec<_>>().join("; ")
    ));
    if let MapSpec::G(network) = &draft.map {
        let last = if rollout.events.iter().any(is_touch) { "contact" } else { "end" };
        for (name, step) in [("start", 0), (last, contact)] {
            let there = rollout.actors.iter().filter(|actor| actor.role != Role::Part && actor.is_present(step));
            let told =
                there.map(|actor| format!("{}: {}", actor.id, strips::stands_on(network, actor, &actor.states[step])));
            lines.push(format!("Centres at the {name}: {}", told.collect::<Vec<_>>().join("; ")));
        }
    }
    lines.extend(rollout.actors.iter().filter_map(|part| part_in_words(rollout, part, contact)));
    let end = rollout.steps().min(contact + STEPS_AFTER + 1);
    let told = |step: &usize| *step == contact || step.is_multiple_of(LINE_STEPS);
    lines.extend((0..end).filter(told).map(|step| moment(rollout, step)));
    lines.push(format!("Events: {}", events(rollout)));
    lines.push(ending(rollout));
    lines.join("\n") + "\n"
}

/// The step at or before the ego's first contact; of a run without one the first of anybody, else the last step.
fn first_contact_step(rollout: &Rollout) -> usize {
    let last = rollout.steps() - 1;
    let of_ego = |actor: usize| actor == 0 || rollout.actors[actor].part_of == Some(0);
    let meets = |event: &&Event| match &event.kind {
        EventKind::Contact { a, b, .. } => of_ego(*a) || of_ego(*b),
        EventKind::ObstacleContact { actor, .. } => of_ego(*actor),
        EventKind::Gone { .. } => false,
    };
    let touch = rollout.events.iter().find(meets).or_else(|| rollout.events.iter().find(|event| is_touch(event)));
    touch.map_or(last, |event| ((event.time_s / STEP_S + 1e-9) as usize).min(last))
}

fn is_touch(event: &Event) -> bool {
    !matches!(event.kind, EventKind::Gone { .. })
}

fn degrees(angle: f64) -> i64 {
    math::wrap_angle(angle).to_degrees().round() as i64
}

/// An angle with its sign.
fn signed(degrees: i64) -> String {
    format!("{degrees:+}")
}

fn placed(rollout: &Rollout, number: usize, thing: &PlacedObstacle) -> String {
    let ego = &rollout.actors[0].states[0];
    let turned = degrees(thing.pose.heading - ego.heading);
    format!(
        "Thing {number} is {}, {:.2} m long and {:.2} m wide: {} of the ego as it starts, its length at {} deg to the ego's heading",
        thing.kind.with_article(),
        thing.length_m,
        thing.width_m,
        from(ego, thing.pose.position),
        signed(turned)
    )
}

fn user(rollout: &Rollout, actor: &ActorTrack) -> String {
    let owner = actor.part_of.map_or_else(String::new, |owner| format!(", part of {}", rollout.actors[owner].id));
    let appears = if actor.appears_s > 0.0 { format!(", there from {:.1} s", actor.appears_s) } else { String::new() };
    let gone = actor.gone_s.map_or_else(String::new, |gone_s| format!(", gone at {gone_s:.1} s"));
    let (kind, length_m, width_m) = (actor.kind.label(), actor.length_m, actor.width_m);
    format!("{}: {kind}, {length_m:.2} x {width_m:.2} m{owner}{appears}{gone}", actor.id)
}

/// A door: how far it is open at the contact; an arm of a gate: when it turns.
fn part_in_words(rollout: &Rollout, part: &ActorTrack, contact: usize) -> Option<String> {
    let owner = &rollout.actors[part.part_of?];
    let against = |step: usize| part.states[step].heading - owner.states[step].heading;
    if part.length_m < DOOR_M {
        let opened = degrees(against(contact) - against(0)).abs();
        return Some(format!("Door of {}: turned by {opened} deg from shut at the contact", owner.id));
    }
    if part.kind != owner.kind || part.kind != PartnerKind::FixedObject {
        return None;
    }
    let turned = |step: &usize| degrees(part.states[*step].heading - part.states[0].heading);
    Some(match (0..=contact).find(|step| turned(step).abs() > TURNS_DEG) {
        None => format!("Arm of {}: does not turn", owner.id),
        Some(begins) => format!(
            "Arm of {}: begins to turn at {:.1} s, turned by {} deg at the contact",
            owner.id,
            begins as f64 * STEP_S,
            signed(turned(&contact))
        ),
    })
}

/// Where everybody is at a step.
fn moment(rollout: &Rollout, step: usize) -> String {
    let track = &rollout.actors[0];
    let (start, ego) = (&track.states[0], &track.states[step]);
    let way = Vec2::from_heading(start.heading);
    let gone = ego.position() - start.position();
    let mut line = format!(
        "{:4.1} s | ego {:.1} m along, {:+.1} m to the left of where it began, turned {} deg, {}",
        step as f64 * STEP_S,
        gone.dot(way),
        gone.dot(way.left()),
        signed(degrees(ego.heading - start.heading)),
        pace(ego)
    );
    for other in &rollout.actors[1..] {
        let owner = other.part_of.map(|owner| rollout.actors[owner].kind);
        if owner == Some(other.kind) || !other.is_present(step) {
            continue;
        }
        let state = &other.states[step];
        line += &format!(
            " | {} {}, points {} deg to the ego's heading, {}",
            other.id,
            from(ego, state.position()),
            signed(degrees(state.heading - ego.heading)),
            pace(state)
        );
    }
    line
}

/// Where a place is, in the frame of the ego as it stands then.
fn from(ego: &ActorState, place: Vec2) -> String {
    let way = Vec2::from_heading(ego.heading);
    let (ahead, left) = ((place - ego.position()).dot(way), (place - ego.position()).dot(way.left()));
    format!(
        "{:.1} m {}, {:.1} m {}",
        ahead.abs(),
        if ahead >= 0.0 { "ahead" } else { "behind" },
        left.abs(),
        if left >= 0.0 { "left" } else { "right" }
    )
}

fn pace(state: &ActorState) -> String {
    let reverse = if state.speed() < -0.1 { " in reverse" } else { "" };
    format!("{:.1} m/s{reverse}", state.velocity().length())
}

fn events(rollout: &Rollout) -> String {
    if rollout.events.is_empty() {
        return "nobody touches anybody or anything".to_owned();
    }
    rollout.events.iter().map(|event| event_in_words(rollout, event)).collect::<Vec<_>>().join("; ")
}

fn event_in_words(rollout: &Rollout, event: &Event) -> String {
    let name = |actor: usize| rollout.actors[actor].id.as_str();
    let outline = |actor: usize, state: &ActorState| {
        OrientedBox::new(state.pose(), rollout.actors[actor].length_m, rollout.actors[actor].width_m)
    };
    let what = match &event.kind {
        EventKind::Contact { a, b, a_state, b_state } => {
            let (a_speed, b_speed) = (a_state.velocity(), b_state.velocity());
            let touch = contact_geometry(&outline(*a, a_state), a_speed, &outline(*b, b_state), b_speed);
            format!(
                "{} and {} touch: {} of {} on {} of {}, {:.1} m/s relative",
                name(*a),
                name(*b),
                touch.ego_zone.label(),
                name(*a),
                touch.other_zone.label(),
                name(*b),
                (b_speed - a_speed).length()
            )
        }
        EventKind::ObstacleContact { actor, obstacle, state } => {
            let thing = &rollout.obstacles[*obstacle];
            let touch = contact_geometry(&outline(*actor, state), state.velocity(), &thing.outline(), Vec2::default());
            let (who, zone, what) = (name(*actor), touch.ego_zone.label(), thing.kind.label());
            format!("{who} touches thing {obstacle} ({what}) with its {zone}, at {:.1} m/s", state.velocity().length())
        }
        EventKind::Gone { actor } => format!("{} is gone", name(*actor)),
    };
    format!("{:.2} s: {what}", event.time_s)
}

fn ending(rollout: &Rollout) -> String {
    let why = match rollout.termination.kind {
        TerminationKind::Contact => "after the ego's contact",
        other => other.label(),
    };
    format!("It ends at {:.1} s: {why}", rollout.termination.time_s)
}
