//! Networks of roads as areas and lines.

use super::{GroundShape, LineKind, RoadDrawing};
use crate::graph::{LEFT, RIGHT, points, side_of};
use crate::ground::{GroundArea, GroundKind};
use crate::network::{NamedRoad, RoadNetwork, RoadPart};
use recrash_model::geometry::Vec2;
use recrash_model::scenario::{Control, GraphMap, RoadSpec, Strip, StripKind};

/// Width of the stripes of a crosswalk, and of the gaps between them. [m]
const STRIPE_M: f64 = 0.5;

/// What a strip looks like, where it is not asphalt alone.
const fn shape_of(kind: StripKind) -> Option<GroundShape> {
    match kind {
        StripKind::Driving | StripKind::CentreTurn => None,
        StripKind::Bike => Some(GroundShape::Bike),
        StripKind::Parking | StripKind::Stalls => Some(GroundShape::Parking),
        StripKind::Shoulder => Some(GroundShape::Shoulder),
        StripKind::Median => Some(GroundShape::Median),
        StripKind::Sidewalk => Some(GroundShape::Sidewalk),
    }
}

/// The line along a road's reference line; a centre turn lane has its own.
fn middle_line(spec: &RoadSpec) -> Option<LineKind> {
    let first = |strips: &[Strip]| strips.first().map(|strip| strip.kind);
    match (first(&spec.right), first(&spec.left)) {
        (Some(StripKind::Driving), Some(StripKind::Driving)) => Some(LineKind::Centre),
        (Some(StripKind::CentreTurn), _) | (_, Some(StripKind::CentreTurn)) => None,
        (right, left) => right.into_iter().chain(left).any(StripKind::is_paved).then_some(LineKind::Edge),
    }
}

/// Left and right edge of one lane of a named road.
type Edges = [Vec<Vec2>; 2];

impl RoadNetwork {
    /// A network of roads as areas and lines.
    pub(super) fn draw_graph(&self, map: &GraphMap) -> RoadDrawing {
        let mut drawing = RoadDrawing::default();
        for (spec, line) in map.roads.iter().zip(&self.lines) {
            for (side, sign) in [(RIGHT, '+'), (LEFT, '-')] {
                self.draw_side(spec, side, sign, &mut drawing);
            }
            if let Some(kind) = middle_line(spec) {
                drawing.line(kind, points(&line.stretches));
            }
        }
        for area in &self.areas {
            self.draw_area(area, &mut drawing);
        }
        for road in self.roads.iter().filter(|road| road.part == RoadPart::Inner) {
            for lane in &road.lanes {
                drawing.line(LineKind::Guide, self.lane(*lane).polyline(0.0));
            }
        }
        drawing
    }

    fn draw_area(&self, area: &GroundArea, drawing: &mut RoadDrawing) {
        let shape = match area.kind {
            GroundKind::Paved | GroundKind::Junction => return drawing.surfaces.push(area.points.clone()),
            GroundKind::Crosswalk if !area.name.starts_with("areas[") => return stripes(&area.points, drawing),
            GroundKind::Stall => {
                // Its two sides; the next stall shares one.
                for side in [[0, 3], [1, 2]] {
                    drawing.line(LineKind::Stall, side.map(|corner| area.points[corner]).to_vec());
                }
                return;
            }
            GroundKind::Driveway => {
                drawing.surfaces.push(area.points.clone());
                GroundShape::Driveway
            }
            GroundKind::Crosswalk => GroundShape::Crosswalk,
            GroundKind::Island => GroundShape::Sidewalk,
            GroundKind::Building => GroundShape::Building,
        };
        drawing.area(shape, area.points.clone());
    }

    /// The strips of one side of a road, and the lines between them.
    fn draw_side(&self, spec: &RoadSpec, side: f64, sign: char, drawing: &mut RoadDrawing) {
        let strips = side_of(spec, side);
        let mut seen = [0_usize; StripKind::ALL.len()];
        for (index, strip) in strips.iter().enumerate() {
            let position = StripKind::ALL.iter().position(|kind| *kind == strip.kind).unwrap_or(0);
            let lane = seen[position];
            seen[position] += 1;
            let suffix =
                if strip.kind == StripKind::Driving { String::new() } else { format!(".{}", strip.kind.name()) };
            let name = format!("{}{sign}{suffix}", spec.id);
            let Some(named) = self.named.iter().find(|named| named.name == name) else { continue };
            let [left, right] = self.edges(named, lane);
            let outline: Vec<Vec2> = left.iter().copied().chain(right.iter().rev().copied()).collect();
            if strip.kind.is_paved() {
                drawing.surfaces.push(outline.clone());
            }
            if let Some(shape) = shape_of(strip.kind) {
                drawing.area(shape, outline);
            }
            // The line to its inner neighbour.
            let inner = index.checked_sub(1).map(|inner| strips[inner].kind);
            let kind = match (inner, strip.kind) {
                (Some(StripKind::Driving), StripKind::Driving) => Some(LineKind::LaneDivider),
                (Some(StripKind::CentreTurn), _) | (_, StripKind::CentreTurn) => Some(LineKind::Centre),
                (Some(inner), own) if inner.is_paved() || own.is_paved() => Some(LineKind::Edge),
                _ => None,
            };
            if let Some(kind) = kind {
                drawing.line(kind, left);
            }
            if index + 1 == strips.len() && strip.kind.is_paved() {
                drawing.line(LineKind::Edge, right);
            }
        }
    }

    /// The edges of a lane of a named road, from its beginning to its end.
    fn edges(&self, named: &NamedRoad, lane: usize) -> Edges {
        let mut edges = [Vec::new(), Vec::new()];
        for piece in &named.pieces {
            let Some(lane) = self.road(*piece).lanes.get(lane) else { continue };
            for (edge, side) in edges.iter_mut().zip([-0.5, 0.5]) {
                for point in self.lane(*lane).edge(side) {
                    if edge.last().is_none_or(|last: &Vec2| last.distance(point) > 1e-3) {
                        edge.push(point);
                    }
                }
            }
        }
        edges
    }

    /// The stop lines of devices that control traffic: of each the line across its lanes. [m]
    pub fn stop_lines(&self, control: &[Control]) -> Vec<[Vec2; 2]> {
        control.iter().flat_map(|device| self.stop_line(device)).collect()
    }

    fn stop_line(&self, device: &Control) -> Option<[Vec2; 2]> {
        let named = self.named.iter().find(|named| named.name == device.at)?;
        let all = self.lanes_of(named);
        let first = device.lanes.iter().copied().min().unwrap_or(0);
        let last = device.lanes.iter().copied().max().unwrap_or(all.checked_sub(1)?);
        let end = |lane: u8, side: f64| {
            let path = self.lane_of(named, lane).ok()?;
            let s = path.length_m - device.set_back_m;
            let segment = &path.segments[path.segment_at(s)];
            let width = self.lane(segment.lane).width_at(s - segment.start_m);
            Some(path.pose(s, side * width).position)
        };
        Some([end(first, -0.5)?, end(last, 0.5)?])
    }
}

/// The stripes of a crosswalk across a road, along it. The corners: two at its beginning along the road, right and left,
/// then left and right at its end.
fn stripes(corners: &[Vec2], drawing: &mut RoadDrawing) {
    let &[near_right, near_left, far_left, far_right] = corners else { return };
    let width = near_right.distance(near_left).max(far_right.distance(far_left));
    let count = (width / (2.0 * STRIPE_M)).floor().max(1.0) as u32;
    for stripe in 0..count {
        let share = |number: f64| number / (2.0 * f64::from(count));
        let (from, to) = (share(f64::from(2 * stripe) + 0.5), share(f64::from(2 * stripe) + 1.5));
        let on = |a: Vec2, b: Vec2, share: f64| a + (b - a) * share;
        let points = vec![
            on(near_right, near_left, from),
            on(near_right, near_left, to),
            on(far_right, far_left, to),
            on(far_right, far_left, from),
        ];
        drawing.area(GroundShape::Crosswalk, points);
    }
}
