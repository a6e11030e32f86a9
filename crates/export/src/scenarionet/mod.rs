//! ScenarioNet: the pickled dict that MetaDrive's `ScenarioEnv`, ScenarioNet and the learning simulators read. What was
//! driven is replayed, ego and all. What each entry means: `docs/formats/scenarionet.md`.

mod map;
mod pickle;

use crate::openscenario::height_m;
use crate::{ExportError, ExportFile};
use pickle::Value;
use recrash_model::geometry::Vec2;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorTrack, EGO_ID, Event, EventKind, PlacedObstacle, Role, Rollout, STEP_S};
use recrash_model::scenario::{Aspect, ObstacleKind};
use recrash_roads::Scenario;

/// The version of the description; ScenarioNet takes any text.
const VERSION: &str = "recrash.scenarionet/1";

/// The file of a scenario. Its name begins as those of ScenarioNet's data sets do, or MetaDrive would pass it over.
pub(crate) fn files(scenario: &Scenario, rollout: Option<&Rollout>) -> Result<Vec<ExportFile>, ExportError> {
    let id = &scenario.draft().id;
    let rollout = rollout.ok_or_else(|| ExportError::NeedsRollout { scenario: id.clone() })?;
    let content = description(scenario, rollout).pickled();
    Ok(vec![ExportFile { name: format!("sd_recrash_{id}.pkl"), content }])
}

fn description(scenario: &Scenario, rollout: &Rollout) -> Value {
    let draft = scenario.draft();
    let steps = rollout.steps();
    // Readers move everything so that the ego starts at 0, 0, and forget some of it: it is there already.
    let origin = rollout.ego_track().states[0].position();
    let present = rollout.actors.iter().filter(|track| (0..steps).any(|step| track.is_present(step)));
    let mut tracks: Vec<(String, Value)> =
        present.map(|actor| (actor.id.clone(), moving(actor, steps, origin))).collect();
    for (position, obstacle) in rollout.obstacles.iter().enumerate() {
        let id = format!("obstacle{}", position + 1);
        tracks.push((id.clone(), standing(&id, obstacle, steps, origin)));
    }
    let records = draft.source.records.iter().map(ToString::to_string);
    let metadata = Value::dict([
        ("dataset", "recrash".into()),
        ("scenario_id", draft.id.clone().into()),
        ("sdc_id", EGO_ID.into()),
        ("coordinate", "metadrive".into()),
        ("metadrive_processed", Value::Truth(false)),
        ("ts", Value::Floats((0..steps).map(|step| (step as f64 * STEP_S) as f32).collect(), 0)),
        ("old_origin_in_current_coordinate", point(-origin)),
        ("title", crate::title(draft).into()),
        ("records", Value::texts(records)),
        ("whose_crash", crate::whose_crash(draft).unwrap_or_default().into()),
        ("narrative", draft.source.narrative.clone().into()),
        ("simulator", rollout.simulator.clone().into()),
        ("ego", rollout.ego.clone().into()),
        ("contacts", Value::List(contacts(rollout))),
    ]);
    Value::dict([
        ("id", draft.id.clone().into()),
        ("version", VERSION.into()),
        ("length", Value::Integer(i32::try_from(steps).expect("a rollout has at most 1201 steps"))),
        ("tracks", Value::Dict(tracks)),
        ("dynamic_map_states", Value::Dict(signals(scenario, steps, origin))),
        ("map_features", Value::Dict(map::features(scenario, origin))),
        ("metadata", metadata),
    ])
}

/// What a road user did. Where it is not in the world, every number is 0.
fn moving(track: &ActorTrack, steps: usize, origin: Vec2) -> Value {
    let kind = match (track.role, track.kind) {
        (Role::Part, _) => "OTHER",
        (_, PartnerKind::Pedestrian | PartnerKind::Animal) => "PEDESTRIAN",
        (_, PartnerKind::Cyclist | PartnerKind::OtherNonMotorist) => "CYCLIST",
        (_, PartnerKind::FixedObject) => "TRAFFIC_OBJECT",
        _ => "VEHICLE",
    };
    let rows = (0..steps).map(|step| {
        let state = &track.states[step];
        let row = Row { at: state.position() - origin, heading: state.heading, velocity: state.velocity() };
        track.is_present(step).then_some(row)
    });
    let size = [track.length_m, track.width_m, height_m(track.kind)];
    let mut value = object(&track.id, kind, &rows.collect::<Vec<_>>(), size);
    describe(&mut value, "kind", word(&track.kind));
    if let Some(owner) = track.part_of {
        describe(&mut value, "part_of", Value::Integer(i32::try_from(owner).expect("actors are few")));
    }
    value
}

/// What stands or lies on the ground all the time.
fn standing(id: &str, obstacle: &PlacedObstacle, steps: usize, origin: Vec2) -> Value {
    let kind = match obstacle.kind {
        ObstacleKind::Cone => "TRAFFIC_CONE",
        ObstacleKind::Barrier => "TRAFFIC_BARRIER",
        _ => "TRAFFIC_OBJECT",
    };
    let (at, heading) = (obstacle.pose.position - origin, obstacle.pose.heading);
    let row = Some(Row { at, heading, velocity: Vec2::default() });
    let size = [obstacle.length_m, obstacle.width_m, obstacle.kind.height_m()];
    let mut value = object(id, kind, &vec![row; steps], size);
    describe(&mut value, "kind", word(&obstacle.kind));
    value
}

/// Where something is at a step.
#[derive(Clone, Copy)]
struct Row {
    at: Vec2,
    heading: f64,
    velocity: Vec2,
}

/// A track: a row for every step, none where it is not in the world.
fn object(id: &str, kind: &str, rows: &[Option<Row>], size: [f64; 3]) -> Value {
    fn column<const N: usize>(rows: &[Option<Row>], of: impl Fn(&Row) -> [f64; N]) -> Value {
        let numbers = rows.iter().flat_map(|row| row.as_ref().map_or([0.0; N], &of)).map(|number| number as f32);
        Value::Floats(numbers.collect(), if N == 1 { 0 } else { N })
    }
    let state = Value::dict([
        ("position", column(rows, |row| [row.at.x, row.at.y, 0.0])),
        ("heading", column(rows, |row| [row.heading])),
        ("velocity", column(rows, |row| [row.velocity.x, row.velocity.y])),
        ("valid", Value::Truths(rows.iter().map(Option::is_some).collect())),
        ("length", column(rows, |_| [size[0]])),
        ("width", column(rows, |_| [size[1]])),
        ("height", column(rows, |_| [size[2]])),
    ]);
    let metadata = Value::dict([("type", kind.into()), ("object_id", id.into()), ("dataset", "recrash".into())]);
    Value::dict([("type", kind.into()), ("state", state), ("metadata", metadata)])
}

/// One more thing said in the metadata of a track.
fn describe(track: &mut Value, key: &str, value: Value) {
    if let Value::Dict(entries) = track
        && let Some((_, Value::Dict(metadata))) = entries.iter_mut().find(|(key, _)| key == "metadata")
    {
        metadata.push((key.to_owned(), value));
    }
}

/// What signals show at every step, by the lane they stand at. A lane has one signal: the first.
fn signals(scenario: &Scenario, steps: usize, origin: Vec2) -> Vec<(String, Value)> {
    let mut lights: Vec<(String, Value)> = Vec::new();
    for (control, placement) in scenario.draft().control.iter().zip(scenario.control()) {
        if control.device.aspect(0.0).is_none() {
            continue;
        }
        for &(lane, s) in &placement.lines {
            let id = map::lane_name(lane);
            if lights.iter().any(|(known, _)| *known == id) {
                continue;
            }
            let at = scenario.network().lane(lane).position(s, 0.0) - origin;
            let shown = (0..steps).map(|step| state(control.device.aspect(step as f64 * STEP_S)).to_owned());
            let metadata = Value::dict([
                ("type", "TRAFFIC_LIGHT".into()),
                ("object_id", id.clone().into()),
                ("dataset", "recrash".into()),
            ]);
            let light = Value::dict([
                ("type", "TRAFFIC_LIGHT".into()),
                ("lane", id.clone().into()),
                ("stop_point", Value::Floats(vec![at.x as f32, at.y as f32, 0.0], 0)),
                ("state", Value::dict([("object_state", Value::texts(shown))])),
                ("metadata", metadata),
            ]);
            lights.push((id, light));
        }
    }
    lights
}

fn state(aspect: Option<Aspect>) -> &'static str {
    match aspect {
        Some(Aspect::Green) => "LANE_STATE_GO",
        Some(Aspect::Yellow) => "LANE_STATE_CAUTION",
        Some(Aspect::Red) => "LANE_STATE_STOP",
        Some(Aspect::FlashingRed) => "LANE_STATE_FLASHING_STOP",
        Some(Aspect::Dark) | None => "LANE_STATE_UNKNOWN",
    }
}

/// Who touched whom or what, and when: no reader of the format asks, and every one who looks at a crash does.
fn contacts(rollout: &Rollout) -> Vec<Value> {
    let contact = |time_s: f64, a: usize, b: String| {
        Value::dict([("time_s", Value::Number(time_s)), ("a", rollout.actors[a].id.clone().into()), ("b", b.into())])
    };
    let of = |event: &Event| match event.kind {
        EventKind::Contact { a, b, .. } => Some(contact(event.time_s, a, rollout.actors[b].id.clone())),
        EventKind::ObstacleContact { actor, obstacle, .. } => {
            Some(contact(event.time_s, actor, format!("obstacle{}", obstacle + 1)))
        }
        EventKind::Gone { .. } => None,
    };
    rollout.events.iter().filter_map(of).collect()
}

fn point(at: Vec2) -> Value {
    Value::Floats(vec![at.x as f32, at.y as f32], 0)
}

/// A kind as recrash's own files name it.
fn word(kind: &impl serde::Serialize) -> Value {
    Value::Text(serde_json::to_value(kind).ok().and_then(|value| value.as_str().map(str::to_owned)).unwrap_or_default())
}
