//! What kind of crash it is, and who had it.

use super::LeftRight;
use crate::kinds::PartnerKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kind of a road user or thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A car, hatchback, sedan, coupe or taxi.
    PassengerCar,
    /// A sport utility vehicle or crossover.
    Suv,
    /// A van.
    Van,
    /// A minivan.
    Minivan,
    /// A pickup.
    Pickup,
    /// A pickup or car that tows a trailer.
    PickupWithTrailer,
    /// A police car.
    PoliceCar,
    /// An ambulance.
    Ambulance,
    /// A fire engine.
    FireTruck,
    /// A vehicle of first responders, of which no more is told.
    FirstResponder,
    /// A truck of which no more is told.
    HeavyTruck,
    /// A box or delivery truck.
    BoxTruck,
    /// A tractor with a semi-trailer.
    SemiTrailerTruck,
    /// A garbage truck.
    GarbageTruck,
    /// A tow truck.
    TowTruck,
    /// A food truck.
    FoodTruck,
    /// A construction truck, roller, loader or excavator.
    ConstructionVehicle,
    /// A street sweeper.
    StreetSweeper,
    /// A forklift.
    Forklift,
    /// A bus or shuttle.
    Bus,
    /// A school bus.
    SchoolBus,
    /// A tram, streetcar or train.
    Tram,
    /// A trailer by itself.
    Trailer,
    /// A vehicle of which no more is told.
    Vehicle,
    /// A motorcycle.
    Motorcycle,
    /// A moped or motor scooter.
    Moped,
    /// A bicycle and who rides it.
    Bicycle,
    /// A bicycle with a motor and who rides it.
    EBike,
    /// Somebody on a scooter that one stands on.
    ScooterRider,
    /// Somebody on a skateboard.
    Skateboarder,
    /// Somebody on foot.
    Pedestrian,
    /// Somebody in a wheelchair.
    Wheelchair,
    /// An animal.
    Animal,
    /// A delivery robot.
    DeliveryRobot,
    /// A wall, pillar or building.
    Wall,
    /// A pole, post, tree or hydrant.
    Pole,
    /// A kerb or median.
    Curb,
    /// A gate, or the arm of one.
    Gate,
    /// A chain, cable or wire.
    Chain,
    /// A barrier, fence or guard rail.
    Barrier,
    /// A cone, pylon, delineator or barricade that gives way.
    Cone,
    /// A sign.
    Sign,
    /// Something that lies on the road.
    Debris,
    /// A wheel that came off.
    LooseWheel,
    /// A branch of a tree.
    TreeBranch,
    /// A hole, plate or bump of the road.
    Pothole,
    /// A shopping cart or the like.
    Cart,
    /// A scooter or bicycle that nobody rides.
    Scooter,
    /// Cargo or equipment of another vehicle.
    Cargo,
    /// A thing of which no more is told.
    Object,
    /// A door.
    Door,
}

/// Kinds that crash types tell apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum KindGroup {
    /// Cars, vans and pickups.
    Car,
    /// Trucks, buses and machines.
    Truck,
    /// Motorcycles and mopeds.
    Motorcycle,
    /// Cyclists.
    Cyclist,
    /// People on foot, on scooters and skateboards.
    OnFoot,
    /// Animals.
    Animal,
    /// Things.
    Object,
    /// Anything else.
    Other,
}

impl Kind {
    /// Its group.
    pub fn group(self) -> KindGroup {
        match self {
            Self::PassengerCar
            | Self::Suv
            | Self::Van
            | Self::Minivan
            | Self::Pickup
            | Self::PickupWithTrailer
            | Self::PoliceCar
            | Self::FirstResponder
            | Self::Vehicle => KindGroup::Car,
            Self::Ambulance
            | Self::FireTruck
            | Self::HeavyTruck
            | Self::BoxTruck
            | Self::SemiTrailerTruck
            | Self::GarbageTruck
            | Self::TowTruck
            | Self::FoodTruck
            | Self::ConstructionVehicle
            | Self::StreetSweeper
            | Self::Forklift
            | Self::Bus
            | Self::SchoolBus
            | Self::Tram
            | Self::Trailer => KindGroup::Truck,
            Self::Motorcycle | Self::Moped => KindGroup::Motorcycle,
            Self::Bicycle | Self::EBike => KindGroup::Cyclist,
            Self::ScooterRider | Self::Skateboarder | Self::Pedestrian | Self::Wheelchair => KindGroup::OnFoot,
            Self::Animal => KindGroup::Animal,
            Self::DeliveryRobot => KindGroup::Other,
            Self::Wall
            | Self::Pole
            | Self::Curb
            | Self::Gate
            | Self::Chain
            | Self::Barrier
            | Self::Cone
            | Self::Sign
            | Self::Debris
            | Self::LooseWheel
            | Self::TreeBranch
            | Self::Pothole
            | Self::Cart
            | Self::Scooter
            | Self::Cargo
            | Self::Object
            | Self::Door => KindGroup::Object,
        }
    }

    /// Whether it is a car or a truck, in the wide sense of [`KindGroup`]: a tram and a trailer are, a motorcycle is not.
    pub fn is_vehicle(self) -> bool {
        matches!(self.group(), KindGroup::Car | KindGroup::Truck)
    }

    /// The kind of the column that it belongs to, where there is one.
    pub fn partner_kind(self) -> Option<PartnerKind> {
        Some(match self {
            Self::PassengerCar => PartnerKind::PassengerCar,
            Self::Suv => PartnerKind::Suv,
            Self::Van | Self::Minivan => PartnerKind::Van,
            Self::Pickup | Self::PickupWithTrailer => PartnerKind::PickupTruck,
            Self::PoliceCar | Self::Ambulance | Self::FireTruck | Self::FirstResponder => PartnerKind::FirstResponder,
            Self::Bus | Self::SchoolBus => PartnerKind::Bus,
            Self::Motorcycle | Self::Moped => PartnerKind::Motorcycle,
            Self::Bicycle | Self::EBike => PartnerKind::Cyclist,
            Self::Pedestrian => PartnerKind::Pedestrian,
            Self::ScooterRider | Self::Skateboarder | Self::Wheelchair => PartnerKind::OtherNonMotorist,
            Self::Animal => PartnerKind::Animal,
            Self::Vehicle | Self::DeliveryRobot => return None,
            other if other.group() == KindGroup::Object => PartnerKind::FixedObject,
            _ => PartnerKind::HeavyTruck,
        })
    }
}

/// The eleven crash types, in the order of their rules: the first that fits (`docs/models/crash-types.md`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CrashType {
    /// Another contact of the partner threw it at the subject vehicle.
    Secondary,
    /// With somebody on foot, on a scooter or a skateboard.
    Pedestrian,
    /// With a cyclist.
    Cyclist,
    /// With a motorcycle.
    Motorcycle,
    /// With no other road user.
    SingleVehicle,
    /// One of the two went backwards.
    Backing,
    /// One way, front on rear.
    FrontToRear,
    /// From opposite directions on one road.
    HeadOn,
    /// Crossing or turning paths.
    Intersection,
    /// One way, side by side.
    Lateral,
    /// Opened doors, animals, robots, cargo, anything else.
    Other,
}

impl CrashType {
    /// Every type, in the order of tables.
    pub const ALL: [Self; 11] = [
        Self::Secondary,
        Self::Pedestrian,
        Self::Cyclist,
        Self::Motorcycle,
        Self::SingleVehicle,
        Self::Backing,
        Self::FrontToRear,
        Self::HeadOn,
        Self::Intersection,
        Self::Lateral,
        Self::Other,
    ];

    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Secondary => "Secondary",
            Self::Pedestrian => "Pedestrian",
            Self::Cyclist => "Cyclist",
            Self::Motorcycle => "Motorcycle",
            Self::SingleVehicle => "Single vehicle",
            Self::Backing => "Backing",
            Self::FrontToRear => "Front to rear",
            Self::HeadOn => "Head-on",
            Self::Intersection => "Intersection",
            Self::Lateral => "Lateral",
            Self::Other => "All others",
        }
    }
}

/// Whose move brought the conflict about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// The subject vehicle's.
    Initiator,
    /// The other's.
    Responder,
    /// Both took part.
    Both,
}

/// Who moved into whom, or whose door took part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Striker {
    /// The subject vehicle.
    Sv,
    /// The partner.
    Cp,
    /// Each into the other.
    Both,
}

/// Who drove the subject vehicle at the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Driver {
    /// The automated driving system.
    System,
    /// A human, all the time that is told.
    Human,
    /// A human, who had taken over before the contact.
    HumanTookOver,
}

/// First harmful contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FirstContact {
    /// Between the subject vehicle and the partner.
    SvAndPartner,
    /// Between the partner and somebody else.
    PartnerAndOther,
    /// Between two others: the subject vehicle was not touched.
    OthersOnly,
    /// Of the subject vehicle with a thing.
    Object,
}

/// From where somebody or something comes, seen from the subject vehicle before any turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// Behind, in its lane or beside it.
    Behind,
    /// Ahead, going or facing the same way.
    Ahead,
    /// From the opposite direction.
    Opposite,
    /// Beside it, going the same way.
    Beside {
        /// On which side.
        side: LeftRight,
    },
    /// From a crossing road or path.
    Cross {
        /// From which side.
        side: LeftRight,
    },
    /// Out of a stall.
    Stall {
        /// On which side, where told.
        side: Option<LeftRight>,
    },
    /// Out of a driveway, a lot or an alley.
    Driveway {
        /// On which side, where told.
        side: Option<LeftRight>,
    },
    /// From where it was parked at the kerb.
    Parked {
        /// On which side, where told.
        side: Option<LeftRight>,
    },
    /// From the sidewalk.
    Sidewalk {
        /// On which side, where told.
        side: Option<LeftRight>,
    },
    /// From above.
    Above,
}

impl Origin {
    /// For tables and sentences: where it is, seen from the subject vehicle.
    pub fn words(self) -> String {
        let sided = |place: &str, side: Option<LeftRight>| match side {
            Some(LeftRight::Left) => format!("{place} on the left"),
            Some(LeftRight::Right) => format!("{place} on the right"),
            None => place.to_owned(),
        };
        match self {
            Self::Behind => "from behind".to_owned(),
            Self::Ahead => "from ahead".to_owned(),
            Self::Opposite => "from the opposite direction".to_owned(),
            Self::Beside { side } => sided("from beside,", Some(side)),
            Self::Cross { side } => sided("from a crossing road", Some(side)),
            Self::Stall { side } => sided("out of a stall", side),
            Self::Driveway { side } => sided("out of a driveway", side),
            Self::Parked { side } => sided("from the kerb", side),
            Self::Sidewalk { side } => sided("from a sidewalk", side),
            Self::Above => "from above".to_owned(),
        }
    }
}

/// The 37 pre-crash scenarios of NHTSA (Najm, Smith and Yanagisawa 2007, DOT HS 810 767), in its order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PrecrashScenario {
    /// Vehicle failure.
    VehicleFailure,
    /// Control loss with prior vehicle action.
    ControlLossWithManeuver,
    /// Control loss without prior vehicle action.
    ControlLoss,
    /// Running red light.
    RunningRedLight,
    /// Running stop sign.
    RunningStopSign,
    /// Road edge departure with prior vehicle manoeuvre.
    RoadDepartureWithManeuver,
    /// Road edge departure without prior vehicle manoeuvre.
    RoadDeparture,
    /// Road edge departure while backing up.
    RoadDepartureBacking,
    /// Animal crash with prior vehicle manoeuvre.
    AnimalWithManeuver,
    /// Animal crash without prior vehicle manoeuvre.
    Animal,
    /// Pedestrian crash with prior vehicle manoeuvre.
    PedestrianWithManeuver,
    /// Pedestrian crash without prior vehicle manoeuvre.
    Pedestrian,
    /// Pedalcyclist crash with prior vehicle manoeuvre.
    CyclistWithManeuver,
    /// Pedalcyclist crash without prior vehicle manoeuvre.
    Cyclist,
    /// Backing up into another vehicle.
    Backing,
    /// Vehicle(s) turning, same direction.
    TurningSameDirection,
    /// Vehicle(s) changing lanes, same direction.
    ChangingLanesSameDirection,
    /// Vehicle(s) drifting, same direction.
    DriftingSameDirection,
    /// Vehicle(s) parking, same direction.
    ParkingSameDirection,
    /// Vehicle(s) making a manoeuvre, opposite direction.
    OppositeWithManeuver,
    /// Vehicle(s) not making a manoeuvre, opposite direction.
    Opposite,
    /// Following vehicle making a manoeuvre.
    FollowingWithManeuver,
    /// Lead vehicle accelerating.
    LeadAccelerating,
    /// Lead vehicle moving at lower constant speed.
    LeadSlower,
    /// Lead vehicle decelerating.
    LeadDecelerating,
    /// Lead vehicle stopped.
    LeadStopped,
    /// Left turn across path from opposite directions at signalised junctions.
    LeftTurnOppositeSignal,
    /// Vehicle turning right at signalised junctions.
    RightTurnSignal,
    /// Left turn across path from opposite directions at non-signalised junctions.
    LeftTurnOpposite,
    /// Straight crossing paths at non-signalised junctions.
    StraightCrossing,
    /// Vehicle(s) turning at non-signalised junctions.
    TurningCrossing,
    /// Evasive action with prior vehicle manoeuvre.
    EvasiveWithManeuver,
    /// Evasive action without prior vehicle manoeuvre.
    Evasive,
    /// Non-collision incident.
    NonCollision,
    /// Object crash with prior vehicle manoeuvre.
    ObjectWithManeuver,
    /// Object crash without prior vehicle manoeuvre.
    Object,
    /// Other.
    Other,
}

impl PrecrashScenario {
    /// Its number in the report, 1 to 37.
    pub fn number(self) -> u8 {
        self as u8 + 1
    }
}

/// Cell of the objects-by-events matrix of EU 2022/1426, Annex III, Appendix 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct MatrixCell {
    /// Row.
    pub object: MatrixObject,
    /// Event of the row.
    pub event: MatrixEvent,
}

/// Rows of the matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MatrixObject {
    /// Vehicles.
    Vehicle,
    /// Pedestrians.
    Pedestrian,
    /// Pedal cyclists.
    Cyclist,
    /// Animals.
    Animal,
    /// Debris.
    Debris,
    /// Other objects that move.
    OtherObject,
}

/// Events of the matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MatrixEvent {
    /// Lead vehicle decelerating.
    LeadDecelerating,
    /// Lead vehicle stopped.
    LeadStopped,
    /// Lead vehicle accelerating.
    LeadAccelerating,
    /// Changing lanes.
    ChangingLanes,
    /// Cutting in.
    CuttingIn,
    /// Turning.
    Turning,
    /// Encroaching from the opposite direction.
    EncroachingOpposing,
    /// Encroaching from an adjacent lane.
    EncroachingAdjacent,
    /// Entering the roadway.
    EnteringRoadway,
    /// Cutting out.
    CuttingOut,
    /// Crossing the road inside a crosswalk.
    CrossingInCrosswalk,
    /// Crossing the road outside a crosswalk.
    CrossingOutsideCrosswalk,
    /// On the sidewalk or the shoulder.
    AlongRoad,
    /// Riding in the lane.
    RidingInLane,
    /// Riding in an adjacent or dedicated lane.
    RidingBeside,
    /// Static in the lane.
    StaticInLane,
    /// Moving into or out of the lane.
    MovingIntoLane,
}
