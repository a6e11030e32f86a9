//! CommonRoad 2020a: lanelets, recorded partners and a planning problem for the ego.

mod lanelets;

use crate::xml::{Element, number};
use crate::{ExportError, ExportFile, ExportOptions};
use recrash_model::geometry::Pose;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorState, ActorTrack, PlacedObstacle, Rollout, STEP_S};
use recrash_model::scenario::{Environment, MapKind, ObstacleKind, Turn};
use recrash_model::surroundings::{Lighting, Surface, Weather};
use recrash_roads::Scenario;

/// First ids of each kind of element; lanelets count from 1, and a map has a few hundred.
const FIRST_INTERSECTION: usize = 1001;
const FIRST_STATIC_OBSTACLE: usize = 2001;
const FIRST_DYNAMIC_OBSTACLE: usize = 3001;
const PLANNING_PROBLEM: usize = 9001;

/// The ego has arrived this near to the end of its way, as in MetaDrive. [m]
const ARRIVED_M: f64 = 5.0;

/// The file of a scenario.
pub(crate) fn files(
    scenario: &Scenario,
    rollout: Option<&Rollout>,
    options: &ExportOptions,
) -> Result<Vec<ExportFile>, ExportError> {
    let draft = scenario.draft();
    let rollout = rollout.ok_or_else(|| ExportError::NeedsRollout { scenario: draft.id.clone() })?;
    let moving = rollout.actors.iter().skip(1).enumerate();
    let root = Element::new("commonRoad")
        .with("timeStepSize", number(STEP_S))
        .with("commonRoadVersion", "2020a")
        .with("author", "recrash")
        .with("affiliation", "recrash")
        .with("source", "NHTSA SGO crash records, re-created by recrash")
        .with("benchmarkID", benchmark_id(&draft.id))
        .with("date", options.created.split('T').next().unwrap_or("2024-01-01"))
        .child(location(&draft.environment))
        .child(tags(scenario))
        .children(lanelets::lanelets(scenario.network()))
        .children(lanelets::intersections(scenario.network(), FIRST_INTERSECTION))
        .children(
            rollout
                .obstacles
                .iter()
                .enumerate()
                .map(|(position, obstacle)| static_obstacle(FIRST_STATIC_OBSTACLE + position, obstacle)),
        )
        .children(moving.map(|(position, track)| dynamic_obstacle(FIRST_DYNAMIC_OBSTACLE + position, track)))
        .child(planning_problem(scenario));
    Ok(vec![ExportFile { name: format!("{}.cr.xml", draft.id), content: root.document(&crate::comment(draft)) }])
}

/// CommonRoad's name of a benchmark: country (ZAM is made up), map, numbers.
fn benchmark_id(id: &str) -> String {
    let mut name = String::new();
    for part in id.split(|c: char| !c.is_ascii_alphanumeric()).filter(|part| !part.is_empty()) {
        let (first, rest) = part.split_at(1);
        name.push_str(&first.to_ascii_uppercase());
        name.push_str(rest);
    }
    format!("ZAM_{}-1_1_T-1", if name.is_empty() { "Recrash" } else { &name })
}

/// The place of the crash is not carried: the numbers say "unknown" in CommonRoad's own way.
fn location(environment: &Environment) -> Element {
    Element::new("location")
        .children([leaf("geoNameId", "-999"), leaf("gpsLatitude", "999"), leaf("gpsLongitude", "999")])
        .children(environment_element(environment))
}

/// Weather and light, where they have a name that the 2020a schema and commonroad-io 2026.1 both know. For clear and
/// cloudy weather the schema says `sunny` and the reader `clear`, for daylight `day` and `noon`: what one takes the other
/// refuses, so that the element is left out there.
fn environment_element(environment: &Environment) -> Option<Element> {
    let weather = match environment.weather {
        Weather::Rain => "light_rain",
        Weather::Snow => "snow",
        Weather::Fog => "fog",
        Weather::Clear | Weather::Cloudy | Weather::SevereWind | Weather::Indoor => return None,
    };
    let underground = match environment.surface {
        Surface::Dry => "clean",
        Surface::Wet => "wet",
        Surface::SnowIce => "snow",
    };
    let (time, part_of_day) = match environment.lighting {
        Lighting::Daylight => ("12:00:00", "unknown"),
        Lighting::DawnDusk => ("21:15:00", "unknown"),
        Lighting::DarkLighted | Lighting::DarkNotLighted | Lighting::DarkUnknown => ("00:00:00", "night"),
    };
    Some(Element::new("environment").children([
        leaf("time", time),
        leaf("timeOfDay", part_of_day),
        leaf("weather", weather),
        leaf("underground", underground),
    ]))
}

/// Tags that follow from the map and the ego's turn.
fn tags(scenario: &Scenario) -> Element {
    let draft = scenario.draft();
    let mut tags = vec!["critical", "simulated"];
    match draft.map.kind() {
        MapKind::Road => tags.extend(["rural", "oncoming_traffic"]),
        MapKind::Junction => tags.extend(["urban", "intersection"]),
        MapKind::Roundabout => tags.extend(["urban", "roundabout"]),
        MapKind::Network => tags.push("urban"),
    }
    match (draft.ego.turn, draft.map.kind()) {
        (Turn::Left, MapKind::Junction) => tags.push("turn_left"),
        (Turn::Right, MapKind::Junction) => tags.push("turn_right"),
        _ => {}
    }
    tags.push(match draft.map.carriageway().lanes {
        1 => "single_lane",
        2 => "two_lane",
        _ => "multi_lane",
    });
    Element::new("scenarioTags").children(tags.into_iter().map(Element::new))
}

fn static_obstacle(id: usize, obstacle: &PlacedObstacle) -> Element {
    let kind = match obstacle.kind {
        ObstacleKind::Cone | ObstacleKind::Barrier => "constructionZone",
        _ => "unknown",
    };
    Element::new("staticObstacle").with("id", id.to_string()).children([
        leaf("type", kind),
        Element::new("shape").child(rectangle(obstacle.length_m, obstacle.width_m)),
        Element::new("initialState").children([
            position(obstacle.pose),
            exact("orientation", obstacle.pose.heading),
            leaf_in("time", "exact", "0"),
        ]),
    ])
}

fn dynamic_obstacle(id: usize, track: &ActorTrack) -> Element {
    let kind = match track.kind {
        PartnerKind::PassengerCar | PartnerKind::Suv | PartnerKind::Van | PartnerKind::PickupTruck => "car",
        PartnerKind::HeavyTruck => "truck",
        PartnerKind::Bus => "bus",
        PartnerKind::Motorcycle => "motorcycle",
        PartnerKind::Cyclist | PartnerKind::OtherNonMotorist => "bicycle",
        PartnerKind::Pedestrian => "pedestrian",
        PartnerKind::FirstResponder => "priorityVehicle",
        PartnerKind::Animal | PartnerKind::FixedObject => "unknown",
    };
    // A trajectory has at least one state behind the first: whoever has none stays where it is for a step.
    let last = track.states.len() - 1;
    let states = (1..=last.max(1)).map(|step| state("state", step, &track.states[step.min(last)]));
    Element::new("dynamicObstacle").with("id", id.to_string()).children([
        leaf("type", kind),
        Element::new("shape").child(rectangle(track.length_m, track.width_m)),
        state("initialState", 0, &track.states[0]),
        Element::new("trajectory").children(states),
    ])
}

/// The ego's start, and a rectangle at the end of its way to reach within the scenario's time.
fn planning_problem(scenario: &Scenario) -> Element {
    let (draft, ego) = (scenario.draft(), scenario.ego());
    let carriageway = draft.map.carriageway();
    // Any of the road's lanes will do: the middle of them all, seen from the ego's.
    let t = (0.5 * (f64::from(carriageway.lanes) - 1.0) - f64::from(draft.ego.lane)) * carriageway.lane_width_m;
    let goal = ego.path.pose(ego.path.length_m - ARRIVED_M, t);
    let width = f64::from(carriageway.lanes) * carriageway.lane_width_m;
    let steps = (draft.duration_s / STEP_S).ceil().max(1.0);
    let area =
        rectangle(2.0 * ARRIVED_M, width).child(leaf("orientation", &micro(goal.heading))).child(point("center", goal));
    Element::new("planningProblem").with("id", PLANNING_PROBLEM.to_string()).children([
        Element::new("initialState").children([
            position(ego.pose),
            exact("velocity", ego.speed_mps),
            exact("orientation", ego.pose.heading),
            exact("yawRate", 0.0),
            exact("slipAngle", 0.0),
            leaf_in("time", "exact", "0"),
        ]),
        Element::new("goalState").children([
            Element::new("time").children([leaf("intervalStart", "0"), leaf("intervalEnd", &number(steps))]),
            Element::new("position").child(area),
        ]),
    ])
}

fn state(name: &str, step: usize, state: &ActorState) -> Element {
    Element::new(name).children([
        position(state.pose()),
        exact("orientation", state.heading),
        leaf_in("time", "exact", &step.to_string()),
        exact("velocity", state.speed()),
    ])
}

fn rectangle(length: f64, width: f64) -> Element {
    Element::new("rectangle").children([leaf("length", &number(length)), leaf("width", &number(width))])
}

fn position(pose: Pose) -> Element {
    Element::new("position").child(point("point", pose))
}

fn point(name: &str, pose: Pose) -> Element {
    Element::new(name).children([leaf("x", &micro(pose.position.x)), leaf("y", &micro(pose.position.y))])
}

fn exact(name: &str, value: f64) -> Element {
    leaf_in(name, "exact", &micro(value))
}

fn leaf_in(name: &str, inner: &str, text: &str) -> Element {
    Element::new(name).child(leaf(inner, text))
}

fn leaf(name: &str, text: &str) -> Element {
    Element::new(name).text(text)
}

/// To a millionth: micrometres, microradians.
fn micro(value: f64) -> String {
    number((value * 1e6).round() / 1e6)
}
