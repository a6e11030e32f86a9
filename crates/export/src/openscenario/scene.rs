//! Scenarios whose road users have plans: everybody follows what was recorded, the ego too, up to the handover.

use super::entities::{property, vehicle};
use super::storyboard::{
    at_time, controller_is, event, event_on, follow_trajectory, group, maneuver, private, reference_of, set_variable,
    story, teleport,
};
use super::{Context, ENTITIES, STORYBOARD, WATCH, entities, header, storyboard};
use crate::openscenario::environment::environment_action;
use crate::openscenario::names::Declarations;
use crate::openscenario::places::world_position;
use crate::openscenario::speed::speed_at_once;
use crate::xml::{Element, number, rounded};
use recrash_model::rollout::{ActorTrack, EGO_ID, Role, Rollout, STEP_S};
use recrash_model::scenario::{Aspect, Device, Phase, ScenarioDraft};

/// The property of the header that holds the whole scenario, where entities do not.
pub(crate) const WHOLE: &str = "recrash.scenario/2";

/// Whether a scenario is told by what was recorded alone: road users have plans.
pub(crate) fn is_scene(draft: &ScenarioDraft) -> bool {
    !draft.actors.is_empty() || draft.ego.recorded.is_some()
}

/// The document.
pub(super) fn document(context: &Context<'_>, rollout: &Rollout, title: &str, map_file: &str) -> Element {
    let draft = context.scenario.draft();
    let (entities, storyboard) = (entities_of(context, rollout), storyboard_of(context, rollout));
    let mut properties = vec![
        property("recrash.id", &draft.id),
        property(WHOLE, &serde_json::to_string(draft).unwrap_or_default()),
        property(ENTITIES, &entities.fingerprint()),
        property(STORYBOARD, &storyboard.fingerprint()),
    ];
    let remarks = remarks(draft).into_iter().enumerate();
    properties.extend(remarks.map(|(position, remark)| property(&format!("recrash.remark.{}", position + 1), &remark)));
    Element::new("OpenSCENARIO").children([
        header(context, title).child(Element::new("Properties").children(properties)),
        storyboard::parameters(&Declarations::default()),
        storyboard::variables(),
        Element::new("CatalogLocations"),
        road_network(draft, map_file),
        entities,
        storyboard,
    ])
}

/// What the file does not carry.
fn remarks(draft: &ScenarioDraft) -> Vec<String> {
    let mut list = vec![
        "everybody follows what was recorded with the recorded driver in the ego's seat: nobody reacts".to_owned(),
    ];
    if draft.actors.iter().any(|actor| !actor.parts.is_empty()) || !draft.ego.parts.is_empty() {
        list.push(
            "doors, mirrors, arms and trailers are objects of their own that follow what was recorded".to_owned(),
        );
    }
    if !draft.control.is_empty() && draft.map.network().is_none() {
        list.push("signals and signs of this map are not carried".to_owned());
    }
    if !draft.ego.stops.is_empty() {
        list.push("the stops of the ego's task are not carried".to_owned());
    }
    list
}

/// The map, and the programs of its signals, which have the ids of the map's.
fn road_network(draft: &ScenarioDraft, map_file: &str) -> Element {
    let element = Element::new("RoadNetwork").child(Element::new("LogicFile").with("filepath", map_file));
    let signals = draft.control.iter().enumerate().filter_map(|(position, control)| match &control.device {
        Device::Signal { program, offset_s } => Some((position + 1, program, *offset_s)),
        Device::StopSign {} | Device::YieldSign {} => None,
    });
    let controllers: Vec<Element> = signals
        .map(|(id, program, offset_s)| {
            let phases = from_offset(program, offset_s).into_iter().enumerate().map(|(number_of, phase)| {
                let state = Element::new("TrafficSignalState")
                    .with("trafficSignalId", id.to_string())
                    .with("state", lamp(phase.show));
                Element::new("Phase")
                    .with("name", format!("{} {}", number_of + 1, lamp(phase.show)))
                    .with_number("duration", rounded(phase.for_s))
                    .child(state)
            });
            Element::new("TrafficSignalController").with("name", format!("signal {id}")).children(phases)
        })
        .collect();
    if controllers.is_empty() || draft.map.network().is_none() {
        return element;
    }
    element.child(Element::new("TrafficSignals").children(controllers))
}

/// A program as it goes on from a time that it has been running: the phase it is in comes first with what is left of it, and last
/// with the rest.
fn from_offset(program: &[Phase], offset_s: f64) -> Vec<Phase> {
    let cycle_s: f64 = program.iter().map(|phase| phase.for_s).sum();
    let mut done_s = offset_s - (offset_s / cycle_s).floor() * cycle_s;
    let mut first = 0;
    while first + 1 < program.len() && done_s >= program[first].for_s {
        done_s -= program[first].for_s;
        first += 1;
    }
    let mut list = vec![Phase { for_s: program[first].for_s - done_s, ..program[first] }];
    list.extend(program[first + 1..].iter().chain(&program[..first]));
    if done_s > 0.0 {
        list.push(Phase { for_s: done_s, ..program[first] });
    }
    list
}

fn lamp(aspect: Aspect) -> &'static str {
    match aspect {
        Aspect::Green => "green",
        Aspect::Yellow => "yellow",
        Aspect::Red => "red",
        Aspect::FlashingRed => "flashing red",
        Aspect::Dark => "off",
    }
}

fn entities_of(context: &Context<'_>, rollout: &Rollout) -> Element {
    let draft = context.scenario.draft();
    let object = |name: &str, child: Element| Element::new("ScenarioObject").with("name", name).child(child);
    let ego = vehicle("ego", draft.ego.kind, context.scenario.ego_size_m(), &draft.ego);
    let mut list = vec![object(EGO_ID, ego).child(Element::new("ObjectController").child(entities::controller_slot()))];
    for track in &rollout.actors[1..] {
        list.push(object(&track.id, entities::recorded(track)));
    }
    for (position, placed) in rollout.obstacles.iter().enumerate() {
        list.push(object(&super::obstacle_name(position), entities::thing(placed)));
    }
    Element::new("Entities").children(list)
}

fn storyboard_of(context: &Context<'_>, rollout: &Rollout) -> Element {
    let draft = context.scenario.draft();
    let mut actions = vec![environment_action(&draft.environment)];
    for track in rollout.actors.iter().filter(|track| track.is_present(0)) {
        let state = &track.states[0];
        actions.push(Element::new("Private").with("entityRef", &track.id).children([
            private(teleport(world_position(reference_of(track, state.pose())))),
            speed_at_once(&number(rounded(state.speed()))),
        ]));
    }
    for (position, placed) in rollout.obstacles.iter().enumerate() {
        let place = private(teleport(world_position(placed.pose)));
        actions.push(Element::new("Private").with("entityRef", super::obstacle_name(position)).child(place));
    }
    let init = Element::new("Init").child(Element::new("Actions").children(actions));
    let groups = rollout.actors.iter().enumerate().map(|(number_of, track)| follows(context, number_of, track));
    let stories = vec![story("everybody", groups.collect()), watch(rollout)];
    let end_s = (rollout.steps() - 1) as f64 * STEP_S;
    let stop = Element::new("StopTrigger").child(at_time("the recording ends", &number(rounded(end_s))));
    Element::new("Storyboard").child(init).children(stories).child(stop)
}

/// Everything that one of them does.
fn follows(context: &Context<'_>, actor: usize, track: &ActorTrack) -> Element {
    let id = track.id.as_str();
    let name = format!("{id}: recorded");
    let begins_s = number(rounded(track.appears_s));
    let follow = follow_trajectory(context, actor, track, &name);
    let mut maneuvers = vec![maneuver(
        &format!("{id}: way"),
        vec![event(&name, &format!("{id}: follow"), follow, at_time(&name, &begins_s))],
    )];
    let mut there = Vec::new();
    let entity = |action: Element| {
        Element::new("GlobalAction").child(Element::new("EntityAction").with("entityRef", id).child(action))
    };
    if track.appears_s > 0.0 {
        let first = (track.appears_s / STEP_S).round() as usize;
        let pose = reference_of(track, track.states[first.min(track.states.len() - 1)].pose());
        let name = format!("{id}: appears");
        let add = entity(Element::new("AddEntityAction").child(world_position(pose)));
        there.push(event(&name, &format!("{name}: add"), add, at_time(&format!("{name}: time"), &begins_s)));
    }
    if let Some(gone_s) = track.gone_s {
        let name = format!("{id}: leaves");
        let time = at_time(&format!("{name}: time"), &number(rounded(gone_s)));
        there.push(event(&name, &format!("{name}: delete"), entity(Element::new("DeleteEntityAction")), time));
    }
    if !there.is_empty() {
        maneuvers.push(maneuver(&format!("{id}: presence"), there));
    }
    if track.role == Role::Ego {
        // The system under test takes over where the record says, once somebody has put one there.
        let handover_s = number(context.scenario.draft().ego.handover_s.unwrap_or(0.0));
        let activate = Element::new("ActivateControllerAction").with("lateral", "true").with("longitudinal", "true");
        let action = private(Element::new("ControllerAction").child(activate));
        let trigger =
            at_time("ego: handover", &handover_s).child(controller_is("a system under test is there", "true"));
        maneuvers.push(maneuver("ego: handover", vec![event("ego: hand over", "ego: activate", action, trigger)]));
    }
    group(id, Some(id), maneuvers)
}

/// Sets the variable that a runner reads: whether the ego touched a road user.
fn watch(rollout: &Rollout) -> Element {
    let others = rollout.actors[1..].iter().filter(|track| track.role != Role::Part);
    let touched = others.map(|track| {
        let name = format!("contact with {}", track.id);
        Element::new("ConditionGroup").child(storyboard::collision(&name, EGO_ID, &track.id, 0.0))
    });
    let touched: Vec<Element> = touched.collect();
    let set = set_variable("egoCollided");
    let maneuvers = if touched.is_empty() {
        Vec::new()
    } else {
        vec![maneuver("watch: contacts", vec![event_on("watch: contact", "watch: set egoCollided", set, touched)])]
    };
    story(WATCH, vec![group(WATCH, None, maneuvers)])
}

/// The scenario in a header, where it stands there as a whole.
pub(crate) fn whole(properties: &Element) -> Option<&str> {
    let found = properties.all("Property").find(|property| property.attribute("name") == Some(WHOLE));
    found.and_then(|property| property.attribute("value"))
}
