//! Entities: the ego with its controller slot, the partners, cones and barriers.

use super::{Context, obstacle_name};
use crate::openscenario::places::reference_to_centre;
use crate::xml::{Element, number};
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorTrack, EGO_ID, PlacedObstacle, Role};
use recrash_model::scenario::ObstacleKind;
use recrash_model::vehicle::VehicleSpec;
use serde::Serialize;

/// Property that holds what the format has no element for, as JSON of `recrash.scenario/1`.
pub(crate) const PROPERTY: &str = "recrash.scenario/1";

/// All entities, the ego first.
pub(super) fn entities(context: &Context<'_>) -> Element {
    let draft = context.scenario.draft();
    let mut list = vec![
        Element::new("ScenarioObject")
            .with("name", EGO_ID)
            .child(vehicle("ego", PartnerKind::PassengerCar, context.scenario.ego_size_m(), &draft.ego))
            .child(Element::new("ObjectController").child(controller_slot())),
    ];
    for partner in &draft.partners {
        list.push(Element::new("ScenarioObject").with("name", &partner.id).child(road_user(partner.kind, partner)));
    }
    for (position, obstacle) in draft.obstacles.iter().enumerate() {
        let placed = &context.scenario.obstacles()[position].placed;
        list.push(Element::new("ScenarioObject").with("name", obstacle_name(position)).child(misc_object(
            obstacle.kind.label(),
            if obstacle.kind == ObstacleKind::Barrier { "barrier" } else { "obstacle" },
            [placed.length_m, placed.width_m, obstacle.kind.height_m()],
            obstacle,
        )));
    }
    Element::new("Entities").children(list)
}

/// Where the user's system under test goes: replace the controller, and set the parameter `egoControllerActive`.
pub(super) fn controller_slot() -> Element {
    let note = "put the system under test here and set the parameter egoControllerActive to true; \
                until then the ego drives along its route at its target speed";
    Element::new("Controller")
        .with("name", "system-under-test")
        .with("controllerType", "movement")
        // esmini knows a slot for a program of the user by this name.
        .child(
            Element::new("Properties")
                .children([property("slot", note), property("esminiController", "ExternalController")]),
        )
}

/// Somebody as a rollout has it, with the size it had.
pub(super) fn recorded(track: &ActorTrack) -> Element {
    if track.role == Role::Part {
        let size = [track.length_m, track.width_m, height_m(track.kind)];
        return misc_object("part", "none", size, &track.kind);
    }
    let mut element = road_user(track.kind, &track.kind);
    let boxes = element.children.iter_mut().filter(|child| child.name == "BoundingBox");
    for sizes in boxes.flat_map(|bounds| &mut bounds.children).filter(|child| child.name == "Dimensions") {
        for (name, value) in &mut sizes.attributes {
            match name.as_str() {
                "length" => *value = number(track.length_m),
                "width" => *value = number(track.width_m),
                _ => {}
            }
        }
    }
    element
}

/// A thing as a rollout has it.
pub(super) fn thing(placed: &PlacedObstacle) -> Element {
    let size = [placed.length_m, placed.width_m, placed.kind.height_m()];
    let category = if placed.kind == ObstacleKind::Barrier { "barrier" } else { "obstacle" };
    misc_object(placed.kind.label(), category, size, &placed.kind)
}

fn road_user(kind: PartnerKind, description: &impl Serialize) -> Element {
    let spec = VehicleSpec::of(kind);
    match kind {
        PartnerKind::Pedestrian | PartnerKind::Animal => {
            let category = if kind == PartnerKind::Animal { "animal" } else { "pedestrian" };
            Element::new("Pedestrian")
                .with("name", category)
                .with("mass", "80")
                .with("pedestrianCategory", category)
                .child(bounding_box(0.0, [spec.length_m, spec.width_m, height_m(kind)]))
                .child(properties(description).child(between_vertices()))
        }
        PartnerKind::FixedObject => {
            misc_object("object", "obstacle", [spec.length_m, spec.width_m, height_m(kind)], description)
        }
        _ => vehicle(kind.label(), kind, (spec.length_m, spec.width_m), description),
    }
}

pub(super) fn vehicle(
    name: &str,
    kind: PartnerKind,
    (length_m, width_m): (f64, f64),
    description: &impl Serialize,
) -> Element {
    let spec = VehicleSpec::of(kind);
    let to_centre = reference_to_centre(kind);
    let axle = |element: &str, steering: f64, x: f64| {
        Element::new(element)
            .with_number("maxSteering", steering)
            .with("wheelDiameter", "0.626")
            .with_number("trackWidth", (0.88 * width_m * 1e3).round() / 1e3)
            .with_number("positionX", x)
            .with("positionZ", "0.313")
    };
    let mut element = Element::new("Vehicle").with("name", name).with("vehicleCategory", category(kind));
    if kind == PartnerKind::FirstResponder {
        element = element.with("role", "police");
    }
    element
        .child(bounding_box(to_centre, [length_m, width_m, height_m(kind)]))
        .child(
            Element::new("Performance")
                .with_number("maxSpeed", spec.max_speed_mps)
                .with_number("maxAcceleration", spec.max_acceleration_mps2)
                .with_number("maxDeceleration", spec.max_deceleration_mps2),
        )
        .child(Element::new("Axles").children([
            axle("FrontAxle", spec.max_wheel_angle_rad, spec.front_axle_m + to_centre),
            axle("RearAxle", 0.0, 0.0),
        ]))
        .child(properties(description).child(between_vertices()))
}

fn misc_object(name: &str, category: &str, size: [f64; 3], description: &impl Serialize) -> Element {
    Element::new("MiscObject")
        .with("name", name)
        .with("miscObjectCategory", category)
        .with("mass", "5")
        .child(bounding_box(0.0, size))
        .child(properties(description))
}

/// A box of length, width and height whose centre is this far ahead of the reference point. [m]
fn bounding_box(to_centre: f64, [length, width, height]: [f64; 3]) -> Element {
    Element::new("BoundingBox").children([
        Element::new("Center").with_number("x", to_centre).with("y", "0").with_number("z", 0.5 * height),
        Element::new("Dimensions")
            .with_number("width", width)
            .with_number("length", length)
            .with_number("height", height),
    ])
}

fn properties(description: &impl Serialize) -> Element {
    let json = serde_json::to_string(description).unwrap_or_default();
    Element::new("Properties").child(property(PROPERTY, &json))
}

/// Headings between the vertices of a trajectory go evenly from one to the next. esmini asks for this in so many words, as
/// otherwise it turns at the vertices; other players pass over it.
fn between_vertices() -> Element {
    property("plineInterpolation", "segment")
}

pub(super) fn property(name: &str, value: &str) -> Element {
    Element::new("Property").with("name", name).with("value", value)
}

/// Heights of road users; the plane model has none. Usual sizes, assumed. [m]
pub(crate) fn height_m(kind: PartnerKind) -> f64 {
    match kind {
        PartnerKind::PassengerCar | PartnerKind::Motorcycle | PartnerKind::FirstResponder => 1.5,
        PartnerKind::Suv | PartnerKind::PickupTruck => 1.8,
        PartnerKind::Van => 2.2,
        PartnerKind::HeavyTruck | PartnerKind::Bus => 3.2,
        PartnerKind::Cyclist | PartnerKind::Pedestrian | PartnerKind::OtherNonMotorist => 1.75,
        PartnerKind::Animal | PartnerKind::FixedObject => 1.0,
    }
}

fn category(kind: PartnerKind) -> &'static str {
    match kind {
        PartnerKind::Van => "van",
        PartnerKind::HeavyTruck => "truck",
        PartnerKind::Bus => "bus",
        PartnerKind::Motorcycle => "motorbike",
        PartnerKind::Cyclist | PartnerKind::OtherNonMotorist => "bicycle",
        _ => "car",
    }
}
