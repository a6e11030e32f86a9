//! The storyboard: how it begins, who does what when, what is watched, and when it stops.

use super::driven::Driven;
use super::line::line;
use super::speed::{Phase, brake, phases, speed_at_once};
use super::{Context, LANES, WATCH, obstacle_name};
use crate::openscenario::environment::environment_action;
use crate::openscenario::places::{
    ego_start, fixed_place, partner_start, place_on, reference_point, route, world_position,
};
use crate::openscenario::{lateral, names::Declarations};
use crate::xml::{Element, number, rounded};
use recrash_model::geometry::Pose;
use recrash_model::rollout::{ActorState, ActorTrack, EGO_ID, Role, STEP_S};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::Placement;

/// Acceleration of an ego without a controller. Comfortable; assumed. [m/s^2]
const EGO_ACCELERATION_MPS2: f64 = 2.0;

/// The scenario goes on this long after the ego's contact, so that a trace shows it. [s]
const AFTER_CONTACT_S: f64 = 1.0;

/// The ego has arrived this near to the end of its way, as in MetaDrive. [m]
const ARRIVED_M: f64 = 5.0;

/// The storyboard.
pub(super) fn storyboard(context: &Context<'_>) -> Element {
    let mut stories = vec![ego_story(context)];
    if !context.scenario.partners().is_empty() {
        stories.push(partners_story(context));
        stories.push(watch_story(context));
    }
    Element::new("Storyboard").child(init(context)).children(stories).child(stop_trigger(context))
}

fn init(context: &Context<'_>) -> Element {
    let draft = context.scenario.draft();
    let names = &context.names;
    let activate = Element::new("ActivateControllerAction")
        .with("lateral", "$egoControllerActive")
        .with("longitudinal", "$egoControllerActive");
    let mut actions = vec![
        environment_action(&draft.environment),
        Element::new("Private").with("entityRef", EGO_ID).children([
            private(teleport(ego_start(context))),
            speed_at_once(&names.reference("/ego/speed_mps", draft.ego.speed_mps)),
            assign_route(context, context.scenario.ego(), "way of the ego"),
            private(Element::new("ControllerAction").child(activate)),
        ]),
    ];
    for (position, partner) in draft.partners.iter().enumerate() {
        let placement = &context.scenario.partners()[position];
        let mut element = Element::new("Private").with("entityRef", &partner.id);
        match context.tracks.get(position) {
            Some(track) => {
                let pose = reference_point(track.kind, track.states[0].pose());
                element = element
                    .child(private(teleport(world_position(pose))))
                    .child(speed_at_once(&number(rounded(track.states[0].speed()))));
            }
            None => {
                let speed = names.reference(&format!("/partners/{position}/speed_mps"), partner.speed_mps);
                element = element
                    .child(private(teleport(partner_start(context, position))))
                    .child(speed_at_once(&speed))
                    .child(assign_route(context, placement, &format!("way of {}", partner.id)));
            }
        }
        actions.push(element);
    }
    for position in 0..draft.obstacles.len() {
        actions.push(
            Element::new("Private")
                .with("entityRef", obstacle_name(position))
                .child(private(teleport(obstacle_place(context, position)))),
        );
    }
    Element::new("Init").child(Element::new("Actions").children(actions))
}

/// An obstacle's place, from the road it stands on.
fn obstacle_place(context: &Context<'_>, position: usize) -> Element {
    let obstacle = &context.scenario.draft().obstacles[position];
    let placed = &context.scenario.obstacles()[position].placed;
    let Some((place, _)) = place_on(context, &context.scenario.ego().path, obstacle.s_m, obstacle.t_m) else {
        return world_position(placed.pose);
    };
    let mut element = fixed_place(place);
    let t = context.names.reference(&format!("/obstacles/{position}/t_m"), obstacle.t_m);
    if t.contains('$')
        && let Some(lane) = element.children.first_mut()
        && let Some((_, value)) = lane.attributes.iter_mut().find(|(name, _)| name == "offset")
    {
        *value = if place.lane < 0 { format!("${{-1 * {t}}}") } else { t };
    }
    element
}

fn ego_story(context: &Context<'_>) -> Element {
    let draft = context.scenario.draft();
    let target = context.names.reference("/ego/target_speed_mps", draft.ego.target_speed_mps);
    let drive = private(
        Element::new("LongitudinalAction").child(
            Element::new("SpeedAction").children([
                Element::new("SpeedActionDynamics")
                    .with("dynamicsShape", "linear")
                    .with_number("value", EGO_ACCELERATION_MPS2)
                    .with("dynamicsDimension", "rate"),
                Element::new("SpeedActionTarget").child(Element::new("AbsoluteTargetSpeed").with("value", target)),
            ]),
        ),
    );
    let event = event(
        "ego: drive",
        "ego: to the target speed",
        drive,
        Element::new("ConditionGroup").child(controller_is("no system under test", "false")),
    );
    story("ego", vec![group("ego", Some(EGO_ID), vec![maneuver("ego: speed", vec![event])])])
}

fn partners_story(context: &Context<'_>) -> Element {
    let draft = context.scenario.draft();
    let groups = draft.partners.iter().enumerate().map(|(position, partner)| {
        let id = partner.id.as_str();
        // Speed and lane are two maneuvers: an event stops whatever else runs in its own.
        let (mut events, mut lane_events) = (Vec::new(), Vec::new());
        match context.tracks.get(position) {
            Some(track) => {
                let name = format!("{id}: recorded");
                let follow = follow_trajectory(context, position + 1, track, &name);
                events.push(event(&name, &format!("{id}: follow"), follow, at_time(&name, "0")));
            }
            None => {
                let driven = Driven::new(context, position);
                for Phase { name, start, action } in phases(context, position, driven.as_ref()) {
                    let name = format!("{id}: {name}");
                    let trigger = at_time(&format!("{name}: time"), &start);
                    events.push(event(&name, &format!("{name}: speed"), action, trigger));
                }
                let name = format!("{id}: line");
                if let Some(action) = driven.as_ref().and_then(|driven| line(context, position, driven, &name)) {
                    let trigger = at_time(&format!("{name}: time"), "0");
                    lane_events.push(event(&name, &format!("{name}: follow"), action, trigger));
                } else {
                    let moves = lateral::moves(context, position, driven.as_ref());
                    for (number_of, (start, action)) in moves.into_iter().enumerate() {
                        let name = format!("{id}: move {}", number_of + 1);
                        let trigger = at_time(&format!("{name}: time"), &start);
                        lane_events.push(event(&name, &format!("{name}: lane"), action, trigger));
                    }
                }
                // Whoever has touched another brakes to a stand, as in the simulator.
                let name = format!("{id}: halt");
                let halt = brake(&VehicleSpec::of(partner.kind));
                let touched = collision(&format!("{id} touched the ego"), id, EGO_ID, 0.0);
                events.push(event(
                    &name,
                    &format!("{name}: brake"),
                    halt,
                    Element::new("ConditionGroup").child(touched),
                ));
            }
        }
        let lanes = (!lane_events.is_empty()).then(|| maneuver(&format!("{id}{LANES}"), lane_events));
        group(id, Some(id), std::iter::once(maneuver(&format!("{id}: speed"), events)).chain(lanes).collect())
    });
    story("partners", groups.collect())
}

/// Sets variables a runner can read: whether the ego touched a partner, and whether it came too near to one.
fn watch_story(context: &Context<'_>) -> Element {
    let draft = context.scenario.draft();
    let gap = number(context.options.min_gap_m);
    let collided = draft.partners.iter().map(|partner| {
        Element::new("ConditionGroup").child(collision(
            &format!("contact with {}", partner.id),
            EGO_ID,
            &partner.id,
            0.0,
        ))
    });
    let near = draft.partners.iter().map(|partner| {
        Element::new("ConditionGroup").child(by_entity(
            &format!("gap to {}", partner.id),
            EGO_ID,
            0.0,
            Element::new("RelativeDistanceCondition")
                .with("entityRef", &partner.id)
                .with("relativeDistanceType", "euclidianDistance")
                .with("coordinateSystem", "entity")
                .with("freespace", "true")
                .with("rule", "lessOrEqual")
                .with("value", &gap),
        ))
    });
    let contact = event_on("watch: contact", "watch: set egoCollided", set_variable("egoCollided"), collided.collect());
    let close = event_on("watch: gap", "watch: set closeCall", set_variable("closeCall"), near.collect());
    let maneuvers = vec![maneuver("watch: contacts", vec![contact]), maneuver("watch: gaps", vec![close])];
    story(WATCH, vec![group(WATCH, None, maneuvers)])
}

fn stop_trigger(context: &Context<'_>) -> Element {
    let draft = context.scenario.draft();
    let duration = context.names.reference("/duration_s", draft.duration_s);
    let mut groups = vec![at_time("time is up", &duration)];
    let ego = context.scenario.ego();
    if let Some((end, _)) = place_on(context, &ego.path, (ego.path.length_m - ARRIVED_M).max(0.0), 0.0) {
        groups.push(Element::new("ConditionGroup").child(by_entity(
            "ego arrived",
            EGO_ID,
            0.0,
            Element::new("ReachPositionCondition").with_number("tolerance", ARRIVED_M).child(fixed_place(end)),
        )));
    }
    for partner in &draft.partners {
        let name = format!("after contact with {}", partner.id);
        groups.push(Element::new("ConditionGroup").child(collision(&name, EGO_ID, &partner.id, AFTER_CONTACT_S)));
    }
    Element::new("StopTrigger").children(groups)
}

/// The recorded way of a partner as a polyline in time, with the moment of its first contact between two steps: what it does
/// in the step of it is no straight line.
pub(super) fn follow_trajectory(context: &Context<'_>, actor: usize, track: &ActorTrack, name: &str) -> Element {
    let contact = context.rollout.and_then(|rollout| rollout.first_contact_of(actor));
    let present = track.states.iter().enumerate().filter(|(step, _)| track.is_present(*step));
    let mut moments: Vec<(f64, &ActorState)> = present.map(|(step, state)| (step as f64 * STEP_S, state)).collect();
    if let Some((time_s, state)) = contact
        && let Some(after) = moments.iter().position(|(time, _)| *time > time_s + 1e-6)
        && after > 0
        && time_s > moments[after - 1].0 + 1e-6
    {
        moments.insert(after, (time_s, state));
    }
    let vertices = moments.into_iter().map(|(time_s, state)| {
        Element::new("Vertex")
            .with_number("time", rounded(time_s))
            .child(world_position(reference_of(track, state.pose())))
    });
    let shape = Element::new("Shape").child(Element::new("Polyline").children(vertices));
    private(Element::new("RoutingAction").child(Element::new("FollowTrajectoryAction").children([
        Element::new("Trajectory").with("name", name).with("closed", "false").child(shape),
        Element::new("TimeReference").child(
            Element::new("Timing").with("domainAbsoluteRelative", "absolute").with("scale", "1").with("offset", "0"),
        ),
        Element::new("TrajectoryFollowingMode").with("followingMode", "position"),
    ])))
}

/// The reference point of a track's box: parts are placed by their centre.
pub(super) fn reference_of(track: &ActorTrack, pose: Pose) -> Pose {
    if track.role == Role::Part { pose } else { reference_point(track.kind, pose) }
}

/// The variables the watch sets.
pub(super) fn variables() -> Element {
    Element::new("VariableDeclarations").children(["egoCollided", "closeCall"].map(|name| {
        Element::new("VariableDeclaration").with("name", name).with("variableType", "boolean").with("value", "false")
    }))
}

/// The parameter declarations, with the ego's controller switch.
pub(super) fn parameters(names: &Declarations) -> Element {
    names.element().child(
        Element::new("ParameterDeclaration")
            .with("name", "egoControllerActive")
            .with("parameterType", "boolean")
            .with("value", "false"),
    )
}

pub(super) fn private(action: Element) -> Element {
    Element::new("PrivateAction").child(action)
}

pub(super) fn teleport(position: Element) -> Element {
    Element::new("TeleportAction").child(position)
}

fn assign_route(context: &Context<'_>, placement: &Placement, name: &str) -> Element {
    private(
        Element::new("RoutingAction").child(Element::new("AssignRouteAction").child(route(context, placement, name))),
    )
}

pub(super) fn story(name: &str, groups: Vec<Element>) -> Element {
    let act = Element::new("Act")
        .with("name", format!("{name}: act"))
        .children(groups)
        .child(Element::new("StartTrigger").child(at_time(&format!("{name}: start"), "0")));
    Element::new("Story").with("name", format!("{name}: story")).child(act)
}

pub(super) fn maneuver(name: &str, events: Vec<Element>) -> Element {
    Element::new("Maneuver").with("name", name).children(events)
}

pub(super) fn group(name: &str, actor: Option<&str>, maneuvers: Vec<Element>) -> Element {
    let actors = Element::new("Actors")
        .with("selectTriggeringEntities", "false")
        .children(actor.map(|id| Element::new("EntityRef").with("entityRef", id)));
    Element::new("ManeuverGroup")
        .with("name", format!("{name}: group"))
        .with("maximumExecutionCount", "1")
        .child(actors)
        .children(maneuvers)
}

pub(super) fn event(name: &str, action_name: &str, action: Element, trigger: Element) -> Element {
    event_on(name, action_name, action, vec![trigger])
}

/// An event that starts on any of these groups of conditions.
pub(super) fn event_on(name: &str, action_name: &str, action: Element, groups: Vec<Element>) -> Element {
    Element::new("Event")
        .with("name", name)
        .with("priority", "override")
        .with("maximumExecutionCount", "1")
        .child(Element::new("Action").with("name", action_name).child(action))
        .child(Element::new("StartTrigger").children(groups))
}

pub(super) fn set_variable(name: &str) -> Element {
    Element::new("GlobalAction").child(
        Element::new("VariableAction").with("variableRef", name).child(Element::new("SetAction").with("value", "true")),
    )
}

pub(super) fn at_time(name: &str, time: &str) -> Element {
    let condition = Element::new("SimulationTimeCondition").with("rule", "greaterOrEqual").with("value", time);
    Element::new("ConditionGroup").child(by_value(name, condition))
}

/// Whether somebody has put a system under test there, `true` or `false`.
pub(super) fn controller_is(name: &str, active: &str) -> Element {
    by_value(
        name,
        Element::new("ParameterCondition")
            .with("parameterRef", "egoControllerActive")
            .with("rule", "equalTo")
            .with("value", active),
    )
}

fn by_value(name: &str, condition: Element) -> Element {
    Element::new("Condition")
        .with("name", name)
        .with("delay", "0")
        .with("conditionEdge", "none")
        .child(Element::new("ByValueCondition").child(condition))
}

pub(super) fn collision(name: &str, entity: &str, other: &str, delay_s: f64) -> Element {
    let condition = Element::new("CollisionCondition").child(Element::new("EntityRef").with("entityRef", other));
    by_entity(name, entity, delay_s, condition)
}

fn by_entity(name: &str, entity: &str, delay_s: f64, condition: Element) -> Element {
    let who = Element::new("TriggeringEntities")
        .with("triggeringEntitiesRule", "any")
        .child(Element::new("EntityRef").with("entityRef", entity));
    Element::new("Condition")
        .with("name", name)
        .with_number("delay", delay_s)
        .with("conditionEdge", "none")
        .child(Element::new("ByEntityCondition").child(who).child(Element::new("EntityCondition").child(condition)))
}
