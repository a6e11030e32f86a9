//! Networks of roads and junctions: from [`GraphMap`] to lanes.
//!
//! Every centre line is a chain of lines and arcs. A road of several stretches becomes several [`Road`]s one behind the
//! other, and a connection across a junction a chain of roads with one lane each.

mod areas;
mod junction;
mod place;
mod strips;

pub use crate::curve::Stretch;
pub use crate::ground::{GroundArea, GroundKind};
pub use crate::reference_line::ReferenceLine;
pub(crate) use areas::points;
pub(crate) use place::undirected;
pub use strips::inner_edge_m;
pub(crate) use strips::{LEFT, RIGHT, side_of};

use crate::lane::{Lane, LaneId, RoadId};
use crate::network::{NamedRoad, Road, RoadNetwork, RoadPart, followers};
use recrash_model::Diagnostic;
use recrash_model::scenario::{GraphMap, MapSpec, RoadSpec, StripKind};
use strips::{Parts, StripPiece};

/// The most lanes a network may have: a lane of each stretch counts.
const MOST_LANES: usize = 6000;

/// A lane that is narrower than this at an end begins or ends there: none follows it, or it follows none. [m]
const OPEN_M: f64 = 1.0;

/// Whether a lane or strip with widths at its beginning and end is open at one of them.
fn is_open((start, end): (f64, f64), at_end: bool) -> bool {
    (if at_end { end } else { start }) >= OPEN_M
}

/// Builds the network of a map, whose numbers are in range.
pub(crate) fn build(map: &GraphMap) -> Result<RoadNetwork, Vec<Diagnostic>> {
    let mut problems = Vec::new();
    let lines = place::lines(map, &mut problems);
    if !problems.is_empty() {
        return Err(problems);
    }
    let network = RoadNetwork {
        map: MapSpec::G(map.clone()),
        roads: Vec::new(),
        lanes: Vec::new(),
        followers: Vec::new(),
        named: Vec::new(),
        lines,
        areas: Vec::new(),
    };
    let mut builder = Builder { map, network, problems, mouths: Vec::new() };
    for (position, spec) in map.roads.iter().enumerate() {
        builder.road(position, spec);
    }
    builder.follow();
    if builder.problems.is_empty() {
        for position in 0..map.junctions.len() {
            builder.junction(position);
        }
    }
    if !builder.problems.is_empty() {
        return Err(builder.problems);
    }
    builder.network.areas = areas::areas(map, &builder.network, &builder.mouths);
    Ok(builder.network)
}

/// A problem with a map.
fn problem(code: &str, path: String, message: String, hint: impl Into<String>) -> Diagnostic {
    Diagnostic::error_at(code, path, message).with_hint(hint)
}

struct Builder<'a> {
    map: &'a GraphMap,
    network: RoadNetwork,
    problems: Vec<Diagnostic>,
    /// Where the arms of each junction begin, anticlockwise.
    mouths: Vec<Vec<areas::Mouth>>,
}

impl Builder<'_> {
    fn problem(&mut self, code: &str, path: String, message: String, hint: impl Into<String>) {
        self.problems.push(problem(code, path, message, hint));
    }

    /// A road: its strips of each kind and direction.
    fn road(&mut self, position: usize, spec: &RoadSpec) {
        let line = self.network.lines[position].clone();
        let parts = Parts::of(spec, &line);
        for side in [RIGHT, LEFT] {
            for kind in StripKind::ALL {
                let indices = strips::of_kind(strips::side_of(spec, side), kind);
                let lanes: Option<Vec<_>> =
                    indices.iter().map(|index| parts.strip(strips::side_of(spec, side), side, *index)).collect();
                let Some(lanes) = lanes else {
                    let message = format!("a strip on the inside of a bend of {:?} turns back in itself", spec.id);
                    let hint = "allowed: a larger radius, or a longer piece, or less change of width";
                    self.problem("scenario.curve-too-tight", format!("map.roads[{position}].line"), message, hint);
                    return;
                };
                if lanes.is_empty() {
                    continue;
                }
                self.bundles(spec, side, kind, &lanes);
                // A centre turn lane is one of both directions.
                if kind == StripKind::CentreTurn {
                    self.bundles(spec, -side, kind, &lanes);
                }
            }
        }
    }

    /// The roads of strips of one kind, in one direction.
    fn bundles(&mut self, spec: &RoadSpec, direction: f64, kind: StripKind, lanes: &[Vec<StripPiece>]) {
        let pieces = lanes[0].len();
        if self.network.lanes.len() + pieces * lanes.len() > MOST_LANES {
            if self.problems.is_empty() {
                let message = format!("the network would have more than {MOST_LANES} pieces of lanes");
                self.problem("scenario.count", "map.roads".to_owned(), message, "leave out roads, strips or spirals");
            }
            return;
        }
        let along = direction > 0.0;
        let strip = if kind == StripKind::Driving { String::new() } else { format!(".{}", kind.name()) };
        let node = |number: usize| {
            if along {
                format!("{}{strip}:{number}", spec.id)
            } else {
                format!("-{}{strip}:{}", spec.id, pieces - number)
            }
        };
        let part = if kind == StripKind::Driving { RoadPart::Open } else { RoadPart::Beside(kind) };
        let mut ids = Vec::with_capacity(pieces);
        for number in 0..pieces {
            let of = |strip: &Vec<StripPiece>| {
                if along { strip[number] } else { strip[pieces - 1 - number].reversed() }
            };
            let shapes: Vec<StripPiece> = lanes.iter().map(of).collect();
            ids.push(self.add(node(number), node(number + 1), part, &shapes));
        }
        let sign = if along { '+' } else { '-' };
        let name = format!("{}{sign}{strip}", spec.id);
        self.network.named.push(NamedRoad { name, pieces: ids, kind, speed_limit_mps: spec.speed_limit_mps });
    }

    /// Lanes follow each other along a road, and where one road ends and another of its kind begins.
    fn follow(&mut self) {
        let network = &mut self.network;
        let mut first = vec![None; network.roads.len()];
        let mut last = first.clone();
        for named in &network.named {
            first[usize::from(named.pieces[0].0)] = Some(named.kind);
            last[usize::from(named.pieces[named.pieces.len() - 1].0)] = Some(named.kind);
        }
        let of = |kinds: &[Option<StripKind>], lane: usize| kinds[usize::from(network.lanes[lane].road.0)];
        let joints = followers(&network.lanes, |lane| of(&last, lane).is_some(), |lane| of(&first, lane).is_some());
        network.followers = joints
            .into_iter()
            .enumerate()
            .map(|(lane, next)| {
                let leads = |next: &LaneId| {
                    let (own, next) = (&network.lanes[lane], usize::from(next.0));
                    let widths = (network.lanes[next].width_m, own.end_width_m);
                    of(&first, next) == of(&last, lane) && is_open(widths, true) && is_open(widths, false)
                };
                next.into_iter().filter(leads).collect()
            })
            .collect();
        for pair in network.named.iter().flat_map(|named| named.pieces.windows(2)) {
            for (lane, next) in
                network.roads[usize::from(pair[0].0)].lanes.iter().zip(&network.roads[usize::from(pair[1].0)].lanes)
            {
                network.followers[usize::from(lane.0)].push(*next);
            }
        }
    }

    fn add(&mut self, from: String, to: String, part: RoadPart, shapes: &[StripPiece]) -> RoadId {
        let road = RoadId(u16::try_from(self.network.roads.len()).expect("fewer roads than lanes, which are counted"));
        let mut lanes = Vec::with_capacity(shapes.len());
        for (index, shape) in shapes.iter().enumerate() {
            lanes.push(LaneId(u16::try_from(self.network.lanes.len()).expect("lanes are counted")));
            self.network.lanes.push(Lane {
                road,
                index: u8::try_from(index).expect("strips are counted"),
                centreline: shape.stretch.centreline(),
                length_m: shape.stretch.length_m,
                width_m: shape.width_m,
                end_width_m: shape.end_width_m,
            });
        }
        self.network.roads.push(Road { from, to, part, lanes });
        road
    }
}
