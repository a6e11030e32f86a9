//! A network as areas and lines, to draw on a screen.

mod graph;

use crate::centreline::Centreline;
use crate::lane::Lane;
use crate::network::{Road, RoadNetwork, RoadPart};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::scenario::MapKind;
use serde::{Deserialize, Serialize};

/// A road as lines and areas, in the rollout's coordinates. [m]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RoadDrawing {
    /// Closed areas of asphalt (the last point joins the first); they may overlap.
    pub surfaces: Vec<Vec<Vec2>>,
    /// What lies on the asphalt or beside it, in the order of drawing; none on the paper's blocks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub areas: Vec<DrawnArea>,
    /// Lines on the road.
    pub lines: Vec<RoadLine>,
}

/// A closed area that is not asphalt alone. [m]
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DrawnArea {
    /// What it looks like.
    pub shape: GroundShape,
    /// Its corners; the last joins the first.
    pub points: Vec<Vec2>,
}

/// What the ground looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GroundShape {
    /// A bicycle lane.
    Bike,
    /// A parking lane, or the stalls of a lot.
    Parking,
    /// A paved shoulder.
    Shoulder,
    /// Between directions: not to be driven on.
    Median,
    /// A sidewalk, or a raised island.
    Sidewalk,
    /// A stripe of a crosswalk, or all of one.
    Crosswalk,
    /// A piece of private road, across sidewalk and planting.
    Driveway,
    /// A building or a wall.
    Building,
}

/// One line on the road.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoadLine {
    /// How it is painted.
    pub kind: LineKind,
    /// Its points.
    pub points: Vec<Vec2>,
}

/// How a line is painted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LineKind {
    /// The road's outer edge, or that of a roundabout's island (solid).
    Edge,
    /// Between lanes of one direction (dashed white).
    LaneDivider,
    /// Between directions (solid yellow).
    Centre,
    /// Centre line of a lane inside a junction or a roundabout (a faint guide).
    Guide,
    /// Between stalls (thin white).
    Stall,
    /// Where to stop (broad white).
    Stop,
}

/// How far a chord may run beside its arc. [m]
const SAGITTA_M: f64 = 0.02;

impl RoadDrawing {
    /// Least and greatest coordinates of the surfaces; two equal points where there are none. [m]
    pub fn bounds(&self) -> (Vec2, Vec2) {
        let mut points = self.surfaces.iter().flatten();
        let Some(first) = points.next() else { return (Vec2::default(), Vec2::default()) };
        points.fold((*first, *first), |(low, high), point| {
            (Vec2::new(low.x.min(point.x), low.y.min(point.y)), Vec2::new(high.x.max(point.x), high.y.max(point.y)))
        })
    }
}

impl Lane {
    /// The line `t` to the right of the centre line as points; arcs are sampled to 0.02 m.
    pub fn polyline(&self, t: f64) -> Vec<Vec2> {
        self.sampled(t.abs(), |_| t)
    }

    /// The line a share of its width to the right of the centre line: its right edge is 0.5.
    pub fn edge(&self, share: f64) -> Vec<Vec2> {
        self.sampled(share.abs() * self.width_m.max(self.end_width_m), |s| share * self.width_at(s))
    }

    fn sampled(&self, widest: f64, t: impl Fn(f64) -> f64) -> Vec<Vec2> {
        let pieces = match self.centreline {
            Centreline::Straight { .. } => 1,
            Centreline::Arc { radius, .. } => {
                // A chord over the angle a runs r (1 - cos(a / 2)) beside its arc.
                let widest = radius + widest;
                let angle = 2.0 * math::acos((1.0 - SAGITTA_M / widest).max(-1.0));
                ((self.length_m / radius / angle).ceil() as usize).clamp(2, 200)
            }
        };
        let s = |piece: usize| self.length_m * piece as f64 / pieces as f64;
        (0..=pieces).map(|piece| self.position(s(piece), t(s(piece)))).collect()
    }
}

impl RoadNetwork {
    /// The network as areas and lines.
    pub fn drawing(&self) -> RoadDrawing {
        if let Some(map) = self.map.network() {
            return self.draw_graph(map);
        }
        let mut drawing = RoadDrawing::default();
        let junction = self.map.kind() == MapKind::Junction;
        if junction {
            self.draw_junction(&mut drawing);
        }
        for road in &self.roads {
            let two_way = self.road_between(&opposite(&road.to), &opposite(&road.from)).is_some();
            if junction && road.part == RoadPart::Inner {
                for lane in &road.lanes {
                    drawing.line(LineKind::Guide, self.lane(*lane).polyline(0.0));
                }
                continue;
            }
            self.draw_road(road, two_way, &mut drawing);
        }
        drawing
    }

    fn draw_road(&self, road: &Road, two_way: bool, drawing: &mut RoadDrawing) {
        let (Some(first), Some(last)) = (road.lanes.first(), road.lanes.last()) else { return };
        let (leftmost, rightmost) = (self.lane(*first), self.lane(*last));
        let left = leftmost.polyline(-0.5 * leftmost.width_m);
        let right = rightmost.polyline(0.5 * rightmost.width_m);
        drawing.surfaces.push(left.iter().copied().chain(right.iter().rev().copied()).collect());
        // A ring's connector has the mouths of an exit and an entry at its right; everything else has an edge there.
        let connector = road.part == RoadPart::Ring && road.to.ends_with("_0_");
        if connector {
            drawing.line(LineKind::Guide, right);
        } else {
            drawing.line(LineKind::Edge, right);
        }
        if two_way {
            // Both directions share it; the ego's draws it.
            if !road.from.starts_with('-') {
                drawing.line(LineKind::Centre, left);
            }
        } else if road.part == RoadPart::Ring {
            drawing.line(LineKind::Edge, left);
        }
        if road.part == RoadPart::Inner && !two_way {
            for lane in &road.lanes {
                drawing.line(LineKind::Guide, self.lane(*lane).polyline(0.0));
            }
        } else {
            for lane in &road.lanes[1..] {
                let lane = self.lane(*lane);
                drawing.line(LineKind::LaneDivider, lane.polyline(-0.5 * lane.width_m));
            }
        }
    }

    /// The junction's area and its kerbs: around the corners by the right turns, and straight past a missing arm.
    fn draw_junction(&self, drawing: &mut RoadDrawing) {
        let letter = self.map.letter();
        let into = |arm: usize| if arm == 0 { ">>>".to_owned() } else { format!("-1{letter}{}_0_", arm - 1) };
        let out_of = |arm: usize| if arm == 0 { "->>>".to_owned() } else { format!("1{letter}{}_0_", arm - 1) };
        let mut area = Vec::new();
        for arm in 0..4 {
            let next = [arm + 1, arm + 2].into_iter().find_map(|to| self.road_between(&into(arm), &out_of(to % 4)));
            let Some(last) = next.and_then(|road| self.road(road).lanes.last()) else { continue };
            let lane = self.lane(*last);
            let kerb = lane.polyline(0.5 * lane.width_m);
            area.extend(kerb.iter().copied());
            drawing.line(LineKind::Edge, kerb);
        }
        drawing.surfaces.push(area);
    }
}

impl RoadDrawing {
    fn area(&mut self, shape: GroundShape, points: Vec<Vec2>) {
        self.areas.push(DrawnArea { shape, points });
    }

    fn line(&mut self, kind: LineKind, points: Vec<Vec2>) {
        self.lines.push(RoadLine { kind, points });
    }
}

/// The node of the other direction.
fn opposite(node: &str) -> String {
    node.strip_prefix('-').map_or_else(|| format!("-{node}"), str::to_owned)
}
