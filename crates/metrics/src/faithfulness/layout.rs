//! What the map looks like to a witness: where its junction or circle lies, and which way the road runs.

use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::scenario::{Approach, MapKind, Turn};
use recrash_roads::{Lane, LanePath, RoadNetwork, RoadPart};

/// The parts of a map that matter to what was driven on it. Made from its lanes, never from anybody's labels.
#[derive(Debug, Clone)]
pub enum Layout {
    /// A road without junction, straight or curved.
    Plain {
        /// The leftmost lane along it.
        along: LanePath,
    },
    /// A junction: the upright rectangle around its connecting lanes.
    Junction {
        /// Least corner. [m]
        min: Vec2,
        /// Greatest corner. [m]
        max: Vec2,
    },
    /// A roundabout.
    Circle {
        /// Its centre. [m]
        centre: Vec2,
        /// Distance of the outermost ring lane's outer edge from the centre. [m]
        radius_m: f64,
    },
}

impl Layout {
    /// The layout of a network; `None` for one without roads.
    pub fn of(network: &RoadNetwork) -> Option<Self> {
        match network.map.kind() {
            MapKind::Road => {
                let roads = network.route(Approach::Same, Turn::Straight).filter(|roads| !roads.is_empty())?;
                Some(Self::Plain { along: LanePath::new(network, roads, 0) })
            }
            MapKind::Junction => {
                let (min, max) = extent(network, RoadPart::Inner)?;
                Some(Self::Junction { min, max })
            }
            MapKind::Network => match extent(network, RoadPart::Inner) {
                Some((min, max)) => Some(Self::Junction { min, max }),
                None => {
                    let roads =
                        network.named.first().map(|road| road.pieces.clone()).filter(|roads| !roads.is_empty())?;
                    Some(Self::Plain { along: LanePath::new(network, roads, 0) })
                }
            },
            MapKind::Roundabout => {
                let (min, max) = extent(network, RoadPart::Ring)?;
                let centre = (min + max) * 0.5;
                Some(Self::Circle { centre, radius_m: 0.5 * (max.x - min.x) })
            }
        }
    }

    /// Distance of a point from the junction or circle, 0 inside; `None` on a road without. [m]
    pub fn distance_from_junction(&self, point: Vec2) -> Option<f64> {
        match self {
            Self::Plain { .. } => None,
            Self::Junction { min, max } => {
                let outside = Vec2::new(
                    (min.x - point.x).max(point.x - max.x).max(0.0),
                    (min.y - point.y).max(point.y - max.y).max(0.0),
                );
                Some(outside.length())
            }
            Self::Circle { centre, radius_m } => Some((point.distance(*centre) - radius_m).max(0.0)),
        }
    }

    /// Heading of the road at a point, in the direction the ego comes from; nil where the road has no one direction. [rad]
    pub fn road_heading(&self, point: Vec2) -> f64 {
        match self {
            Self::Plain { along } => along.pose(along.project(point, 0).s, 0.0).heading,
            Self::Junction { .. } | Self::Circle { .. } => 0.0,
        }
    }
}

/// The upright rectangle around the lanes of one part of the map, edges included.
fn extent(network: &RoadNetwork, part: RoadPart) -> Option<(Vec2, Vec2)> {
    let (mut min, mut max) = (Vec2::new(f64::INFINITY, f64::INFINITY), Vec2::new(f64::NEG_INFINITY, f64::NEG_INFINITY));
    for lane in network.lanes.iter().filter(|lane| network.road(lane.road).part == part) {
        for point in edge_points(lane) {
            min = Vec2::new(min.x.min(point.x), min.y.min(point.y));
            max = Vec2::new(max.x.max(point.x), max.y.max(point.y));
        }
    }
    (min.x <= max.x).then_some((min, max))
}

/// Points on both edges of a lane, close enough for the rectangle around it.
fn edge_points(lane: &Lane) -> impl Iterator<Item = Vec2> + '_ {
    const PIECES: usize = 16;
    (0..=PIECES).flat_map(move |piece| {
        let s = lane.length_m * piece as f64 / PIECES as f64;
        [-0.5, 0.5].map(|side| lane.position(s, side * lane.width_m))
    })
}

/// Angle of a point seen from another. [rad]
pub fn bearing(from: Vec2, to: Vec2) -> f64 {
    let d = to - from;
    math::atan2(d.y, d.x)
}
