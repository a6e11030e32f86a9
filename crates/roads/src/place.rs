//! Places by name: [`Place`] to a pose on a network.

use crate::lane::LaneId;
use crate::near::near_names;
use crate::network::{NamedRoad, RoadNetwork};
use crate::path::LanePath;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::scenario::{Along, Place};

/// A place on a road may lie this far before its beginning or behind its end: straight on from there. [m]
pub const BEYOND_END_M: f64 = 50.0;

/// A place on a network.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// Where its centre is, and which way it faces.
    pub pose: Pose,
    /// The lane it is on, or beside; of a place in the plane the lane under it.
    pub on: Option<OnLane>,
    /// Where it is on the road that was named.
    pub road: Option<OnRoad>,
}

/// Coordinates on a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnLane {
    /// The lane.
    pub lane: LaneId,
    /// Along it. [m]
    pub s_m: f64,
    /// To the right of its centre line. [m]
    pub t_m: f64,
}

/// Coordinates on a named road.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnRoad {
    /// Position of the road in [`RoadNetwork::named`].
    pub road: usize,
    /// Number of the lane, 0 is the leftmost.
    pub lane: u8,
    /// Along the lane, from the road's beginning. [m]
    pub s_m: f64,
    /// To the right of its centre line. [m]
    pub t_m: f64,
}

/// Why words name no place and no way.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlaceError {
    /// The field at fault, below that of the place: `road`, `lane`, `s_m`, `to_end_m`; of a way `roads[1]`, `lane`.
    pub field: String,
    /// What is wrong.
    pub message: String,
    /// What is allowed.
    pub hint: String,
}

impl PlaceError {
    pub(crate) fn new(field: impl Into<String>, message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { field: field.into(), message: message.into(), hint: hint.into() }
    }
}

impl std::fmt::Display for PlaceError {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{} ({})", self.message, self.hint)
    }
}

impl std::error::Error for PlaceError {}

impl RoadNetwork {
    /// Position in [`Self::named`] of a road; `field` is where its name stands.
    ///
    /// # Errors
    /// Where there is no such road.
    pub fn named_road(&self, name: &str, field: &str) -> Result<usize, PlaceError> {
        self.named.iter().position(|road| road.name == name).ok_or_else(|| {
            let names: Vec<&str> = self.named.iter().map(|road| road.name.as_str()).collect();
            let shown: String = name.chars().take(60).collect();
            PlaceError::new(field, format!("there is no road {shown:?}"), near_names(name, &names))
        })
    }

    /// How many lanes a named road has.
    pub fn lanes_of(&self, road: &NamedRoad) -> u8 {
        let lanes = road.pieces.iter().map(|piece| self.road(*piece).lanes.len()).min().unwrap_or(0);
        u8::try_from(lanes).unwrap_or(u8::MAX)
    }

    /// A lane of a named road, from its beginning to its end.
    ///
    /// # Errors
    /// Where the road has no such lane.
    pub fn lane_of(&self, road: &NamedRoad, lane: u8) -> Result<LanePath, PlaceError> {
        let lanes = self.lanes_of(road);
        if lane >= lanes {
            let message = format!("{:?} has no lane {lane}", road.name);
            let hint = match lanes {
                0 | 1 => "allowed: 0".to_owned(),
                _ => format!("allowed: 0 (leftmost) to {}", lanes - 1),
            };
            return Err(PlaceError::new("lane", message, hint));
        }
        Ok(LanePath::new(self, road.pieces.clone(), lane))
    }

    /// Where a place is.
    ///
    /// # Errors
    /// Where it names no road or lane, or lies too far beyond a road's ends.
    pub fn place(&self, place: &Place) -> Result<Placed, PlaceError> {
        let radians = |degrees: f64| degrees * math::PI / 180.0;
        match place {
            Place::Plane { x_m, y_m, heading_deg } => {
                let pose = Pose { position: Vec2::new(*x_m, *y_m), heading: math::wrap_angle(radians(*heading_deg)) };
                let on = self.lane_at(pose.position, pose.heading).map(|lane| {
                    let (s_m, t_m) = self.lane(lane).local(pose.position);
                    OnLane { lane, s_m, t_m }
                });
                Ok(Placed { pose, on, road: None })
            }
            Place::Lane { road, lane, along, t_m, heading_deg } => {
                let position = self.named_road(road, "road")?;
                let path = self.lane_of(&self.named[position], *lane)?;
                let (field, s_m, given) = match *along {
                    Along::FromStart(s) => ("s_m", s, s),
                    Along::BeforeEnd(s) => ("to_end_m", path.length_m - s, s),
                };
                if !(-BEYOND_END_M..=path.length_m + BEYOND_END_M).contains(&s_m) {
                    let message = format!("{given} m is no place on {road:?}, which is {:.1} m long", path.length_m);
                    let hint = format!("allowed: -{BEYOND_END_M} to {:.1} m", path.length_m + BEYOND_END_M);
                    return Err(PlaceError::new(field, message, hint));
                }
                let mut pose = path.pose(s_m, *t_m);
                pose.heading = math::wrap_angle(pose.heading + radians(*heading_deg));
                let segment = &path.segments[path.segment_at(s_m)];
                let on = OnLane { lane: segment.lane, s_m: s_m - segment.start_m, t_m: *t_m };
                let on_road = OnRoad { road: position, lane: *lane, s_m, t_m: *t_m };
                let beyond = !(0.0..=path.length_m).contains(&s_m);
                Ok(Placed { pose, on: (!beyond).then_some(on), road: Some(on_road) })
            }
        }
    }
}
