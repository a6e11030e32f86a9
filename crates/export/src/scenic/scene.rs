//! Scenic files of scenarios whose road users have plans: everybody follows what was recorded, the ego up to its handover.

use super::{Context, line_string, millimetres, road_user};
use crate::openscenario::names::Declarations;
use crate::xml::{number, rounded};
use recrash_model::geometry::Pose;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorTrack, Role, Rollout, STEP_S};
use recrash_model::scenario::ScenarioDraft;
use std::fmt::Write;

/// What follows a recording.
const RECORDED: &str = include_str!("recorded.scenic");

/// How far off, east of where it would be, somebody stands who is not in the world. [m]
const AWAY_M: f64 = 1000.0;

/// The document.
pub(super) fn document(context: &Context<'_>, rollout: &Rollout) -> String {
    let draft = context.scenario.draft();
    let steps = rollout.steps() - 1;
    let run = format!(
        "  scenic {}.scenic --2d -S --count 1 --time {steps} -m scenic.simulators.newtonian.driving_model\n",
        draft.id
    );
    let mut text = super::header(context, &(run + &remarks(draft, rollout)));
    text.push_str(&super::declarations(&Context { names: Declarations::default(), ..*context }));
    text.push('\n');
    text.push_str(&super::constants());
    text.push_str(super::LIBRARY);
    text.push_str(RECORDED);
    text.push_str("\n# ---- what was recorded: x, y, heading and speed every 0.1 s [m, m, rad, m/s] ------------------------------------\n\n");
    let _ = writeln!(text, "EGO_WAY = {}", line_string(context.scenario.ego()));
    for (at, track) in rollout.actors.iter().enumerate() {
        let _ = writeln!(text, "{} = {}", track_name(at), recording(track));
    }
    text.push_str(&cast(context, rollout));
    text
}

/// What the file does not carry, a line each.
fn remarks(draft: &ScenarioDraft, rollout: &Rollout) -> String {
    let mut list = vec![
        "Everybody follows what was recorded with the recorded driver in the ego's seat: nobody reacts.".to_owned(),
        "On Newtonian alone: Scenic's MetaDrive interface sets no headings. recrash's own export to MetaDrive runs there.".to_owned(),
    ];
    if rollout.actors.iter().any(|track| track.role == Role::Part) {
        list.push("Doors, mirrors, arms and trailers are objects of their own.".to_owned());
    }
    for track in &rollout.actors {
        let from = (track.appears_s > 0.0).then(|| format!("before {} s", number(rounded(track.appears_s))));
        let to = track.gone_s.map(|gone_s| format!("from {} s on", number(rounded(gone_s))));
        let absent: Vec<String> = from.into_iter().chain(to).collect();
        if !absent.is_empty() {
            let (id, when) = (super::doc_text(&crate::one_line(&track.id)), absent.join(" and "));
            list.push(format!("{id} is not in the world {when}: it stands {} m to the east then.", number(AWAY_M)));
        }
    }
    if !draft.control.is_empty() {
        list.push("What signals show is not carried.".to_owned());
    }
    if !draft.ego.stops.is_empty() {
        list.push("The stops of the ego's task are not carried.".to_owned());
    }
    list.into_iter().fold(String::new(), |text, remark| text + &remark + "\n")
}

/// The name of what somebody did.
fn track_name(at: usize) -> String {
    if at == 0 { "EGO_TRACK".to_owned() } else { format!("TRACK{at}") }
}

/// Where somebody is at a step; off where it is not in the world.
fn pose(track: &ActorTrack, step: usize) -> Pose {
    let mut pose = track.states[step].pose();
    if !track.is_present(step) {
        pose.position.x += AWAY_M;
    }
    pose
}

/// What somebody did, a tuple for every step; one alone for who never moves.
fn recording(track: &ActorTrack) -> String {
    let mut points: Vec<String> = (0..track.states.len())
        .map(|step| {
            let Pose { position, heading } = pose(track, step);
            let speed = if track.is_present(step) { track.states[step].speed() } else { 0.0 };
            let [x, y, speed] = [position.x, position.y, speed].map(|value| number(millimetres(value)));
            format!("({x}, {y}, {}, {speed})", number((heading * 1e5).round() / 1e5))
        })
        .collect();
    if points.iter().all(|point| *point == points[0]) {
        points.truncate(1);
    }
    let mut text = String::from("[");
    for chunk in points.chunks(4) {
        let _ = write!(text, "\n    {},", chunk.join(", "));
    }
    text.push(']');
    text
}

/// Ego, road users and things, and when it ends.
fn cast(context: &Context<'_>, rollout: &Rollout) -> String {
    let draft = context.scenario.draft();
    let mut text = String::from(
        "\n# ---- who does what ------------------------------------------------------------------------------------------------\n\n",
    );
    let handover_s = draft.ego.handover_s.unwrap_or(0.0);
    let _ = writeln!(
        text,
        "behavior Ego():\n    do Recorded(EGO_TRACK) until seconds() >= {}\n    \
         # Here the system under test takes over: put your own behavior in place of this one, such as Follow(EGO_WAY, {}).\n    \
         do Recorded(EGO_TRACK)\n",
        number(rounded(handover_s)),
        number(rounded(draft.ego.target_speed_mps)),
    );
    let ego = super::Placed { at: &start(&rollout.actors[0]), speed: &start_speed(&rollout.actors[0]) };
    let _ = writeln!(text, "ego = {}", road_user(context, context.scenario.ego(), &ego, "Ego()", false));
    for (at, track) in rollout.actors.iter().enumerate().skip(1) {
        let _ = writeln!(
            text,
            "user{at} = new {} {}, with name {},\n    with length {}, with width {}, with speed {}, {ANYWHERE},\n    \
             with behavior Recorded({})",
            class(track),
            start(track),
            quoted(&track.id),
            number(rounded(track.length_m)),
            number(rounded(track.width_m)),
            start_speed(track),
            track_name(at),
        );
    }
    for placed in &rollout.obstacles {
        let _ = writeln!(
            text,
            "new Object {}, with length {}, with width {}, {ANYWHERE}    # {}",
            at(placed.pose),
            number(rounded(placed.length_m)),
            number(rounded(placed.width_m)),
            placed.kind.label(),
        );
    }
    text.push('\n');
    for (at, track) in rollout.actors.iter().enumerate().skip(1).filter(|(_, track)| track.part_of != Some(0)) {
        let _ = writeln!(text, "record contact(ego, user{at}) as {}", quoted(&format!("contact with {}", track.id)));
    }
    let _ = writeln!(text, "terminate after {} seconds", number(rounded((rollout.steps() - 1) as f64 * STEP_S)));
    text
}

/// What is recorded stands where it stood: boxes may touch, and nobody has to be on a road.
const ANYWHERE: &str = "with allowCollisions True, with requireVisible False, with regionContainedIn everywhere";

/// Where somebody is at the beginning.
fn start(track: &ActorTrack) -> String {
    at(pose(track, 0))
}

fn start_speed(track: &ActorTrack) -> String {
    number(millimetres(track.states[0].speed().abs()))
}

fn at(pose: Pose) -> String {
    let [x, y] = [pose.position.x, pose.position.y].map(|value| number(millimetres(value)));
    format!("at ({x}, {y}), facing {}", number(((pose.heading.to_degrees() - 90.0) * 1e4).round() / 1e4) + " deg")
}

/// Scenic's class of a kind.
fn class(track: &ActorTrack) -> &'static str {
    match track.kind {
        _ if track.role == Role::Part => "Object",
        PartnerKind::Pedestrian => "Pedestrian",
        PartnerKind::Animal | PartnerKind::FixedObject => "Object",
        PartnerKind::Cyclist | PartnerKind::Motorcycle | PartnerKind::OtherNonMotorist => "Vehicle",
        _ => "Car",
    }
}

/// A string of Scenic.
fn quoted(text: &str) -> String {
    format!("\"{}\"", super::doc_text(&crate::one_line(text)))
}
