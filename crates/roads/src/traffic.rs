//! Background traffic: where it stands at the start, and where it wants to go.
//!
//! MetaDrive's trigger mode: a share of a grid of places on the block's spawn lanes is filled at random; everybody
//! stands until the ego enters the road that leads to the block. It is placed here, so that every simulator gets the
//! same vehicles in the same places. See `docs/models/policies.md`.

use crate::lane::RoadId;
use crate::network::RoadPart;
use crate::path::LanePath;
use crate::scenario::Scenario;
use recrash_model::Seed;
use recrash_model::geometry::{OrientedBox, Pose};
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{Approach, Turn};
use recrash_model::vehicle::VehicleSpec;

/// Speed background traffic wants: MetaDrive's 30 km/h. [m/s]
pub const TRAFFIC_SPEED_MPS: f64 = 30.0 / 3.6;

/// Spacing of the places (`VEHICLE_GAP`). [m]
const PLACE_SPACING_M: f64 = 10.0;

/// No more background vehicles than this.
const MOST_VEHICLES: usize = 64;

/// Free room to everything else at the start. [m]
const FREE_ROOM_M: f64 = 1.0;

/// MetaDrive draws the overtaking timer of its policy below this at the start (`LANE_CHANGE_FREQ`). [steps]
const OVERTAKE_TIMER_STEPS: usize = 50;

/// Below this density there is none (MetaDrive's own threshold).
const LEAST_DENSITY: f64 = 1e-2;

/// A background vehicle at the start, where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct TrafficPlacement {
    /// Kind.
    pub kind: PartnerKind,
    /// The lanes it takes, from the one it stands on.
    pub path: LanePath,
    /// Start along its path. [m]
    pub s_m: f64,
    /// Start in the world.
    pub pose: Pose,
    /// How long it has been following already by the count of its overtaking timer. [steps]
    pub overtake_timer_steps: u32,
}

/// The background traffic of a scenario; none below a density of 0.01.
pub fn background_traffic(scenario: &Scenario) -> Vec<TrafficPlacement> {
    let traffic = scenario.draft().traffic;
    if traffic.density < LEAST_DENSITY {
        return Vec::new();
    }
    let network = scenario.network();
    let routes = all_routes(scenario);
    let mut places: Vec<(RoadId, u8, f64)> = Vec::new();
    let mut total_length_m = 0.0;
    for (position, road) in network.roads.iter().enumerate() {
        let id = RoadId(position as u16);
        if !is_spawn_road(scenario, road.part) || !routes.iter().any(|route| route.contains(&id)) {
            continue;
        }
        for (number, &lane) in road.lanes.iter().enumerate() {
            let length_m = network.lane(lane).length_m;
            total_length_m += length_m;
            let count = (length_m / PLACE_SPACING_M).floor() as usize;
            places.extend((0..count).map(|i| (id, number as u8, i as f64 * PLACE_SPACING_M)));
        }
    }
    let wanted = ((total_length_m / PLACE_SPACING_M).floor() * traffic.density.min(1.0)).floor() as usize;
    let seed = Seed(traffic.seed);
    seed.child("places").rng().shuffle(&mut places);
    places.truncate(wanted.min(MOST_VEHICLES));

    let mut taken = scripted_outlines(scenario);
    let mut spawns = Vec::new();
    for (road, lane, s) in places {
        // One stream per place: whether one is dropped changes nothing for the others.
        let mut rng = seed.child(&format!("vehicle {} {lane} {s}", road.0)).rng();
        let kind = kind_of(rng.uniform());
        let candidates: Vec<&Vec<RoadId>> = destinations(scenario, &routes, road);
        let Some(route) = candidates.get(rng.below(candidates.len())) else { continue };
        let Some(start) = route.iter().position(|&other| other == road) else { continue };
        let path = LanePath::new(network, route[start..].to_vec(), lane);
        let pose = path.pose(s, 0.0);
        let spec = VehicleSpec::of(kind);
        let outline = OrientedBox::new(pose, spec.length_m + 2.0 * FREE_ROOM_M, spec.width_m);
        if taken.iter().any(|other| other.overlaps(&outline)) {
            continue;
        }
        taken.push(outline);
        let overtake_timer_steps = rng.below(OVERTAKE_TIMER_STEPS) as u32;
        spawns.push(TrafficPlacement { kind, path, s_m: s, pose, overtake_timer_steps });
    }
    spawns
}

/// MetaDrive's small, medium, large and extra-large vehicles come at 0.2, 0.3, 0.3 and 0.2; the first two are cars.
fn kind_of(draw: f64) -> PartnerKind {
    if draw < 0.5 {
        PartnerKind::PassengerCar
    } else if draw < 0.8 {
        PartnerKind::Suv
    } else {
        PartnerKind::PickupTruck
    }
}

/// Junctions are entered from their arms, roundabouts from arms and ring; straights and curves are filled themselves.
fn is_spawn_road(scenario: &Scenario, part: RoadPart) -> bool {
    match scenario.network().map.letter() {
        'X' | 'T' => part == RoadPart::ArmIn,
        'O' => matches!(part, RoadPart::ArmIn | RoadPart::Ring),
        _ => matches!(part, RoadPart::Inner | RoadPart::ArmOut),
    }
}

/// Every way through the map.
fn all_routes(scenario: &Scenario) -> Vec<Vec<RoadId>> {
    let mut routes: Vec<Vec<RoadId>> = Vec::new();
    for approach in [Approach::Same, Approach::Opposite, Approach::Left, Approach::Right, Approach::Ring] {
        for turn in [Turn::Straight, Turn::Left, Turn::Right] {
            if let Some(route) = scenario.network().route(approach, turn)
                && !routes.contains(&route)
            {
                routes.push(route);
            }
        }
    }
    routes
}

/// The ways a vehicle on this road may go on: from an arm to the ego's own arm (MetaDrive's choice for whoever comes
/// from the far side), from anywhere else to one of the others.
fn destinations<'a>(scenario: &Scenario, routes: &'a [Vec<RoadId>], road: RoadId) -> Vec<&'a Vec<RoadId>> {
    let network = scenario.network();
    let from_arm = network.road(road).part == RoadPart::ArmIn;
    let ends_at_ego = |route: &&Vec<RoadId>| {
        route.last().is_some_and(|&last| network.road(last).part == RoadPart::Departure) == from_arm
    };
    routes.iter().filter(|route| route.contains(&road)).filter(ends_at_ego).collect()
}

/// Where the ego, the partners and the obstacles are at the start.
fn scripted_outlines(scenario: &Scenario) -> Vec<OrientedBox> {
    let actors = std::iter::once(scenario.ego()).chain(scenario.partners()).map(|placement| {
        let spec = VehicleSpec::of(placement.kind);
        OrientedBox::new(placement.pose, spec.length_m + 2.0 * FREE_ROOM_M, spec.width_m)
    });
    actors.chain(scenario.obstacles().iter().map(|obstacle| obstacle.placed.outline())).collect()
}
