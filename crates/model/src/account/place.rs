//! Where it happened: road, lanes, signals and signs.

use super::Fact;
use crate::surroundings::{Lighting, Surface, Weather};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where it happened.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Place {
    /// Kind of place.
    pub kind: Option<Fact<PlaceKind>>,
    /// What the road has there.
    pub features: Vec<Fact<RoadFeature>>,
    /// Lanes in the subject vehicle's direction.
    pub lanes: Option<Fact<u8>>,
    /// Arms of the junction.
    pub arms: Option<Fact<u8>>,
    /// Posted limit. [m/s]
    pub posted_mps: Option<Fact<f64>>,
    /// Surface.
    pub surface: Option<Fact<Surface>>,
    /// Light.
    pub lighting: Option<Fact<Lighting>>,
    /// Weather, as ticked.
    pub weather: Vec<Fact<Weather>>,
}

/// Kind of place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PlaceKind {
    /// In or at a junction.
    Intersection,
    /// A street between junctions.
    Street,
    /// A highway or freeway.
    Highway,
    /// A roundabout.
    Circle,
    /// A parking lot.
    ParkingLot,
    /// A parking garage.
    Garage,
    /// An alley.
    Alley,
    /// A driveway or private ground.
    Driveway,
    /// Anywhere else.
    Other,
}

impl PlaceKind {
    /// Whether it is a street, at a junction or not; a place of no other kind is taken for one.
    pub const fn is_street(self) -> bool {
        matches!(self, Self::Street | Self::Intersection | Self::Other)
    }

    /// Whether it has stalls and aisles.
    pub const fn is_lot(self) -> bool {
        matches!(self, Self::ParkingLot | Self::Garage)
    }

    /// Whether it lies off the streets, where all drive slowly.
    pub const fn is_off_street(self) -> bool {
        self.is_lot() || matches!(self, Self::Driveway | Self::Alley)
    }
}

/// What a road has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RoadFeature {
    /// A junction.
    Intersection,
    /// A signal.
    Signal,
    /// A stop sign.
    StopSign,
    /// A yield sign.
    YieldSign,
    /// A lane or room for parked vehicles.
    ParkingLane,
    /// A turn lane.
    TurnLane,
    /// A bus lane.
    BusLane,
    /// A bicycle lane.
    BikeLane,
    /// A carpool lane.
    CarpoolLane,
    /// A driveway.
    Driveway,
    /// A parking lot.
    ParkingLot,
    /// A parking garage.
    Garage,
    /// A stall.
    Stall,
    /// A crosswalk.
    Crosswalk,
    /// A sidewalk.
    Sidewalk,
    /// A ramp.
    Ramp,
    /// A merge.
    Merge,
    /// Room for one only, or hardly two.
    NarrowStreet,
    /// One way.
    OneWay,
    /// A dead end.
    CulDeSac,
    /// A median.
    Median,
    /// A gate.
    Gate,
    /// An alley.
    Alley,
    /// A work zone.
    WorkZone,
    /// A shoulder.
    Shoulder,
    /// A centre line that may not be crossed.
    DoubleYellowLine,
    /// A roundabout.
    Roundabout,
    /// Rails.
    Rails,
    /// A bend.
    Bend,
    /// A slope.
    Slope,
}

/// One of eight directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Compass {
    /// North.
    North,
    /// North-east.
    Northeast,
    /// East.
    East,
    /// South-east.
    Southeast,
    /// South.
    South,
    /// South-west.
    Southwest,
    /// West.
    West,
    /// North-west.
    Northwest,
}

impl Compass {
    /// Every direction, clockwise from the north.
    pub const ALL: [Self; 8] = [
        Self::North,
        Self::Northeast,
        Self::East,
        Self::Southeast,
        Self::South,
        Self::Southwest,
        Self::West,
        Self::Northwest,
    ];

    /// Eighths of a full turn, clockwise, from this direction to the other: 0 to 7.
    pub fn eighths_to(self, other: Self) -> u8 {
        ((other as i16 - self as i16).rem_euclid(8)) as u8
    }

    /// This direction, turned by so many eighths clockwise.
    pub fn turned(self, eighths: u8) -> Self {
        Self::ALL[(self as usize + usize::from(eighths)) % 8]
    }
}

/// A lane as people say it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LaneWord {
    /// The leftmost, or the left of two.
    Left,
    /// One in the middle.
    Center,
    /// The rightmost, or the right of two.
    Right,
    /// A lane for turns to the left.
    LeftTurn,
    /// A lane for turns to the right.
    RightTurn,
    /// The bicycle lane.
    Bike,
    /// The bus lane.
    Bus,
    /// The shoulder.
    Shoulder,
    /// At the kerb, or where vehicles park.
    Curb,
    /// The sidewalk, of who goes along it.
    Sidewalk,
    /// On the opposite side.
    Opposing,
}

/// A signal or sign in front of somebody.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct Control {
    /// Which.
    pub device: ControlDevice,
    /// What the signal showed.
    pub state: Option<SignalState>,
    /// Whether it was obeyed.
    pub obeyed: Option<Obeyed>,
}

/// Signal or sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ControlDevice {
    /// A signal.
    Signal,
    /// A stop sign.
    StopSign,
    /// A yield sign.
    YieldSign,
}

/// What a signal shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SignalState {
    /// Red.
    Red,
    /// Yellow.
    Yellow,
    /// Green.
    Green,
    /// It had just changed from red to green.
    TurnedGreen,
    /// It had just changed to red.
    TurnedRed,
}

/// Whether a signal or sign was obeyed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Obeyed {
    /// It was.
    Yes,
    /// It was not.
    No,
}
