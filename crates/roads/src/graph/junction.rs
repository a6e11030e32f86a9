//! Junctions: connections from every lane that leads in to the arms that its turns lead to.

use super::areas::{self, Mouth};
use super::strips::{self, LEFT, RIGHT, StripPiece};
use super::{Builder, is_open, problem};
use crate::curve;
use crate::lane::LaneId;
use crate::network::RoadPart;
use recrash_model::geometry::{OrientedBox, Pose};
use recrash_model::math;
use recrash_model::scenario::{RoadStart, StripKind, Turn};

/// Arms within this angle of straight on are straight on. [rad]
const STRAIGHT_RAD: f64 = 35.0 / 180.0 * math::PI;

/// The tightest turn across a junction, in the middle of its lane. [m]
const LEAST_TURN_RADIUS_M: f64 = 2.0;

/// How much of an arm is looked at where arms may not overlap. [m]
const MOUTH_M: f64 = 1.0;

/// An arm of a junction.
struct Arm {
    /// Position of its road in the map.
    road: usize,
    /// Whether its road begins at the junction, rather than ends.
    begins: bool,
    /// At the end of its reference line, facing away from the junction.
    mouth: Pose,
}

/// A way of getting from one arm to another.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Turn(Turn),
    UTurn,
}

impl Builder<'_> {
    /// The connections of a junction.
    pub(super) fn junction(&mut self, position: usize) {
        let arms = self.arms(position);
        if arms.len() < 2 || arms.len() > 8 {
            let message = format!("{:?} has {} arms", self.map.junctions[position].id, arms.len());
            let hint = "allowed: 2 to 8; roads that begin with {\"arm\": ...} and roads in its ends are its arms";
            self.problem("scenario.junction", format!("map.junctions[{position}]"), message, hint);
            return;
        }
        if self.arms_overlap(position, &arms) {
            return;
        }
        let mut mouths: Vec<Mouth> = arms.iter().map(|arm| self.mouth(arm)).collect();
        mouths.sort_by(|a, b| a.pose.heading.total_cmp(&b.pose.heading));
        self.mouths.push(mouths);
        for from in 0..arms.len() {
            let ways: Vec<Option<Way>> = (0..arms.len()).map(|to| self.way(position, &arms, from, to)).collect();
            self.connect_driving(position, &arms, from, &ways);
            self.connect_strip(position, &arms, from, &ways, StripKind::Bike, Turn::Straight);
            self.connect_strip(position, &arms, from, &ways, StripKind::CentreTurn, Turn::Left);
        }
    }

    fn arms(&self, position: usize) -> Vec<Arm> {
        let junction = &self.map.junctions[position];
        let mut arms = Vec::new();
        for (road, spec) in self.map.roads.iter().enumerate() {
            let line = &self.network.lines[road];
            if matches!(&spec.start, RoadStart::Arm { junction: at, .. } if *at == junction.id) {
                arms.push(Arm { road, begins: true, mouth: line.pose(0.0) });
            }
            if junction.ends.contains(&spec.id) {
                arms.push(Arm { road, begins: false, mouth: curve::turned_round(line.pose(line.length_m)) });
            }
        }
        arms
    }

    /// How wide an arm is where it begins.
    fn mouth(&self, arm: &Arm) -> Mouth {
        let (spec, line) = (&self.map.roads[arm.road], &self.network.lines[arm.road]);
        let (s, u) = if arm.begins { (0.0, 0.0) } else { (line.length_m, 1.0) };
        let sides = if arm.begins { [RIGHT, LEFT] } else { [LEFT, RIGHT] };
        let strips = sides.map(|side| strips::side_of(spec, side));
        Mouth {
            pose: Pose { heading: math::wrap_angle(arm.mouth.heading), ..arm.mouth },
            paved: sides.map(|side| areas::paved_edge(spec, line, side, s)),
            whole: strips.map(|strips| strips::inner_edge_m(strips, strips.len(), u)),
            sidewalk: strips.map(|strips| strips.last().is_some_and(|strip| strip.kind == StripKind::Sidewalk)),
        }
    }

    /// Says which arms overlap.
    fn arms_overlap(&mut self, position: usize, arms: &[Arm]) -> bool {
        let outline = |arm: &Arm| {
            let Mouth { pose, whole: [right, left], .. } = self.mouth(arm);
            let middle = curve::straight(curve::beside(pose, 0.5 * (right - left)), MOUTH_M).pose(0.5 * MOUTH_M);
            OrientedBox::new(middle, MOUTH_M, right + left)
        };
        let boxes: Vec<OrientedBox> = arms.iter().map(outline).collect();
        let mut found = false;
        for (a, b) in (0..arms.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
            if boxes[a].overlaps(&boxes[b]) {
                found = true;
                let name = |arm: &Arm| self.map.roads[arm.road].id.clone();
                let message = format!(
                    "the arms {:?} and {:?} of {:?} overlap where they begin",
                    name(&arms[a]),
                    name(&arms[b]),
                    self.map.junctions[position].id
                );
                let hint = "allowed: arms side by side; let them begin farther from the centre (from_m), \
                            at bearings farther apart, or with fewer strips";
                let path = format!("map.roads[{}].start", arms[a].road);
                self.problems.push(problem("scenario.arms-overlap", path, message, hint));
            }
        }
        found
    }

    /// How one gets from an arm to another, if at all.
    fn way(&self, position: usize, arms: &[Arm], from: usize, to: usize) -> Option<Way> {
        if from == to {
            let name = &self.map.roads[arms[from].road].id;
            return self.map.junctions[position].u_turns.contains(name).then_some(Way::UTurn);
        }
        let turned = math::wrap_angle(arms[to].mouth.heading - arms[from].mouth.heading - math::PI);
        Some(Way::Turn(if turned.abs() <= STRAIGHT_RAD {
            Turn::Straight
        } else if turned > 0.0 {
            Turn::Left
        } else {
            Turn::Right
        }))
    }

    /// The lanes of a kind that lead into the junction, or out of it, by an arm and are open there; leftmost first.
    fn lanes(&self, arm: &Arm, kind: StripKind, leads_in: bool) -> Vec<LaneId> {
        let id = &self.map.roads[arm.road].id;
        let sign = if arm.begins == leads_in { '-' } else { '+' };
        let strip = if kind == StripKind::Driving { String::new() } else { format!(".{}", kind.name()) };
        let name = format!("{id}{sign}{strip}");
        let Some(named) = self.network.named.iter().find(|named| named.name == name) else { return Vec::new() };
        let piece = if leads_in { named.pieces.last() } else { named.pieces.first() };
        let lanes = piece.map_or_else(Vec::new, |piece| self.network.road(*piece).lanes.clone());
        let open = |lane: &LaneId| {
            let lane = self.network.lane(*lane);
            is_open((lane.width_m, lane.end_width_m), leads_in)
        };
        lanes.into_iter().filter(open).collect()
    }

    fn connect_driving(&mut self, position: usize, arms: &[Arm], from: usize, ways: &[Option<Way>]) {
        let arm = &arms[from];
        let lanes = self.lanes(arm, StripKind::Driving, true);
        let spec = &self.map.roads[arm.road];
        let side = strips::side_of(spec, if arm.begins { LEFT } else { RIGHT });
        let written: Vec<&[Turn]> = strips::of_kind(side, StripKind::Driving)
            .into_iter()
            .filter(|index| is_open(side[*index].widths_m(), !arm.begins))
            .map(|index| side[index].turns.as_slice())
            .collect();
        let leads = |to: usize, turn: Turn| {
            ways[to] == Some(Way::Turn(turn)) && !self.lanes(&arms[to], StripKind::Driving, false).is_empty()
        };
        let present = |turn: Turn| (0..arms.len()).any(|to| leads(to, turn));
        let usual = usual_turns(lanes.len(), [Turn::Straight, Turn::Left, Turn::Right].map(present));
        let mut pairs = Vec::new();
        for (to, way) in ways.iter().enumerate() {
            let Some(way) = way else { continue };
            let allowed: Vec<LaneId> = (0..lanes.len())
                .filter(|lane| match way {
                    Way::UTurn => *lane == 0,
                    Way::Turn(turn) if written[*lane].is_empty() => usual[*lane].contains(turn),
                    Way::Turn(turn) => written[*lane].contains(turn),
                })
                .map(|lane| lanes[lane])
                .collect();
            let out = self.lanes(&arms[to], StripKind::Driving, false);
            let count = allowed.len().min(out.len());
            let from_right = *way == Way::Turn(Turn::Right);
            for number in 0..count {
                pairs.push(if from_right {
                    (allowed[allowed.len() - count + number], out[out.len() - count + number], to)
                } else {
                    (allowed[number], out[number], to)
                });
            }
        }
        for (own, theirs, to) in pairs {
            let turns = ways[to] != Some(Way::Turn(Turn::Straight));
            let least = if to == from { 0.0 } else { LEAST_TURN_RADIUS_M };
            self.connect(position, (&arms[from], own), (&arms[to], theirs), turns, least, RoadPart::Inner);
        }
    }

    /// Connects the innermost strips of a kind: bicycle lanes straight on, a centre turn lane to the left.
    fn connect_strip(
        &mut self,
        position: usize,
        arms: &[Arm],
        from: usize,
        ways: &[Option<Way>],
        kind: StripKind,
        turn: Turn,
    ) {
        let Some(own) = self.lanes(&arms[from], kind, true).first().copied() else { return };
        let (to_kind, part) = if kind == StripKind::CentreTurn {
            (StripKind::Driving, RoadPart::Inner)
        } else {
            (kind, RoadPart::Beside(kind))
        };
        for (to, way) in ways.iter().enumerate() {
            if *way != Some(Way::Turn(turn)) {
                continue;
            }
            if let Some(theirs) = self.lanes(&arms[to], to_kind, false).first().copied() {
                let turns = turn != Turn::Straight;
                self.connect(position, (&arms[from], own), (&arms[to], theirs), turns, LEAST_TURN_RADIUS_M, part);
            }
        }
    }

    /// One connection: a road of one lane for each line and arc of it.
    fn connect(
        &mut self,
        position: usize,
        (from_arm, from): (&Arm, LaneId),
        (to_arm, to): (&Arm, LaneId),
        turns: bool,
        least_radius_m: f64,
        part: RoadPart,
    ) {
        let (own, theirs) = (*self.network.lane(from), *self.network.lane(to));
        let pose =
            |lane: &crate::lane::Lane, s: f64| Pose { position: lane.position(s, 0.0), heading: lane.heading(s) };
        let stretches = curve::connection(pose(&own, own.length_m), pose(&theirs, 0.0), turns);
        let radius = stretches.as_deref().map_or(0.0, curve::least_radius_m);
        let Some(stretches) = stretches.filter(|_| radius >= least_radius_m) else {
            let name = |arm: &Arm| self.map.roads[arm.road].id.clone();
            let junction = self.map.junctions[position].id.clone();
            let (a, b) = (name(from_arm), name(to_arm));
            let message =
                format!("from {a:?} to {b:?} across {junction:?} a lane would turn with a radius of {radius:.1} m");
            let hint = format!(
                "allowed: from {least_radius_m} m; let the arms begin farther from the centre (from_m), \
                 or leave this turn out (turns of the lanes of {a:?})"
            );
            self.problem("scenario.turn-too-tight", format!("map.junctions[{position}]"), message, hint);
            return;
        };
        let length_m: f64 = stretches.iter().map(|stretch| stretch.length_m).sum();
        let node = |network: &crate::RoadNetwork, number: usize| match number {
            0 => network.road(own.road).to.clone(),
            _ if number == stretches.len() => network.road(theirs.road).from.clone(),
            _ => format!("{}:{}:{}:{number}", self.map.junctions[position].id, from.0, to.0),
        };
        let width = |s: f64| own.end_width_m + (theirs.width_m - own.end_width_m) * s / length_m;
        let (mut s, mut last) = (0.0, from);
        for (number, stretch) in stretches.iter().enumerate() {
            let end = s + stretch.length_m;
            let piece = StripPiece { stretch: *stretch, width_m: width(s), end_width_m: width(end) };
            let nodes = (node(&self.network, number), node(&self.network, number + 1));
            let road = self.add(nodes.0, nodes.1, part, &[piece]);
            let next = self.network.road(road).lanes[0];
            self.network.followers.push(Vec::new());
            self.network.followers[usize::from(last.0)].push(next);
            last = next;
            s = end;
        }
        self.network.followers[usize::from(last.0)].push(to);
    }
}

/// The turns of each lane where none are written: everybody straight on, the leftmost also left, the rightmost also right.
/// Where nothing lies straight on, the left half turns left and the right half right. `present`: straight, left, right.
fn usual_turns(lanes: usize, present: [bool; 3]) -> Vec<Vec<Turn>> {
    let [straight, left, right] = present;
    (0..lanes)
        .map(|lane| {
            let last = lane + 1 == lanes;
            let (turns_left, turns_right) = if straight {
                (lane == 0, last)
            } else {
                (!right || 2 * lane < lanes, !left || 2 * (lane + 1) > lanes)
            };
            [(straight, Turn::Straight), (left && turns_left, Turn::Left), (right && turns_right, Turn::Right)]
                .into_iter()
                .filter_map(|(allowed, turn)| allowed.then_some(turn))
                .collect()
        })
        .collect()
}
