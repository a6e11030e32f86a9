//! Ways: from lane to lane along named roads, by the shortest connections.

use crate::lane::LaneId;
use crate::lane_change::HALF_CHANGE_M;
use crate::network::{RoadNetwork, RoadPart};
use crate::path::LanePath;
use crate::place::PlaceError;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// A change of lanes counts like so many metres: a way round a block is longer, and one that keeps its lane is preferred.
const CHANGE_M: f64 = 50.0;

/// A lane that is changed into is at least this wide there. [m]
const CHANGE_WIDTH_M: f64 = 2.0;

/// How many of the roads behind the first have been entered, and the lane.
type Stage = (usize, LaneId);

/// What way is wanted: positions in [`RoadNetwork::named`], and lanes on the first and last of them.
#[derive(Clone, Copy)]
struct Wish<'a> {
    roads: &'a [usize],
    lane: Option<u8>,
    last_lane: Option<u8>,
}

impl RoadNetwork {
    /// The shortest way along named roads, from the beginning of the first, in lane `lane`, to the end of the last: in
    /// lane `last_lane` there, or in any. Lanes are changed where no connection leads on from a lane, or as a lane is
    /// asked for.
    ///
    /// # Errors
    /// Where a road or lane is not known, or no way leads from one road to the next.
    pub fn way(&self, roads: &[String], lane: u8, last_lane: Option<u8>) -> Result<LanePath, PlaceError> {
        let known = self.known_roads(roads)?;
        self.known_lane(known[0], Some(lane), "lane")?;
        self.known_lane(known[known.len() - 1], last_lane, "lane")?;
        let lanes = self.shortest(Wish { roads: &known, lane: Some(lane), last_lane });
        let lanes = lanes.ok_or_else(|| self.no_way(&known, lane))?;
        Ok(LanePath::of_lanes(self, lanes))
    }

    /// The same against the lanes' direction: wrong way, or backwards along a lane. The roads are passed in the order
    /// given, the first from its end in lane `lane`, the last to its beginning; t counts to the right of the way.
    ///
    /// # Errors
    /// See [`Self::way`].
    pub fn way_against(&self, roads: &[String], lane: u8, last_lane: Option<u8>) -> Result<LanePath, PlaceError> {
        let mut known = self.known_roads(roads)?;
        self.known_lane(known[0], Some(lane), "lane")?;
        self.known_lane(known[known.len() - 1], last_lane, "lane")?;
        known.reverse();
        let lanes = self.shortest(Wish { roads: &known, lane: last_lane, last_lane: Some(lane) });
        let lanes = lanes.ok_or_else(|| self.no_way(&known, last_lane.unwrap_or(0)))?;
        Ok(LanePath::of_lanes(self, lanes).reversed())
    }

    fn known_roads(&self, roads: &[String]) -> Result<Vec<usize>, PlaceError> {
        if roads.is_empty() {
            return Err(PlaceError::new("roads", "a way has no road", "name at least one road, such as \"main+\""));
        }
        roads.iter().enumerate().map(|(number, name)| self.named_road(name, &format!("roads[{number}]"))).collect()
    }

    fn known_lane(&self, road: usize, lane: Option<u8>, field: &str) -> Result<(), PlaceError> {
        let Some(lane) = lane else { return Ok(()) };
        self.lane_of(&self.named[road], lane).map(drop).map_err(|error| PlaceError { field: field.to_owned(), ..error })
    }

    /// Says where a way breaks off.
    fn no_way(&self, roads: &[usize], lane: u8) -> PlaceError {
        let name = |number: usize| &self.named[roads[number]].name;
        for number in 1..roads.len() {
            let reached = |count: usize| {
                let any = Wish { roads: &roads[..count], lane: None, last_lane: None };
                self.shortest(any).is_some()
            };
            if !reached(number + 1) {
                let message = format!("no way leads from {:?} to {:?}", name(number - 1), name(number));
                let next = self.next_roads(roads[number - 1]);
                let hint = match next.as_slice() {
                    [] => "no road follows it".to_owned(),
                    next => format!("these follow it: {}", next.join(", ")),
                };
                return PlaceError::new(format!("roads[{number}]"), message, hint);
            }
        }
        let message = format!("no way leads from lane {lane} of {:?} to the lane asked for", name(0));
        PlaceError::new("lane", message, "allowed: a lane that leads there, or one beside it that is as long")
    }

    /// Names of the roads that follow a named road, behind connections.
    fn next_roads(&self, road: usize) -> Vec<String> {
        let first_of: BTreeMap<u16, &str> = self
            .named
            .iter()
            .filter_map(|named| named.pieces.first().map(|piece| (piece.0, named.name.as_str())))
            .collect();
        let Some(last) = self.named[road].pieces.last() else { return Vec::new() };
        let mut open: Vec<LaneId> =
            self.road(*last).lanes.iter().flat_map(|lane| self.followers[usize::from(lane.0)].clone()).collect();
        let mut seen = std::collections::BTreeSet::new();
        let mut names = std::collections::BTreeSet::new();
        while let Some(lane) = open.pop() {
            if !seen.insert(lane) {
                continue;
            }
            match first_of.get(&self.lane(lane).road.0) {
                Some(name) => {
                    names.insert((*name).to_owned());
                }
                None => open.extend(&self.followers[usize::from(lane.0)]),
            }
        }
        names.into_iter().collect()
    }

    /// Dijkstra's algorithm over lanes, and over how many of the roads have been entered.
    fn shortest(&self, wish: Wish<'_>) -> Option<Vec<LaneId>> {
        let first = |stage: usize| self.named[wish.roads[stage]].pieces.first().copied();
        let last_stage = wish.roads.len() - 1;
        let goal_road = self.named[wish.roads[last_stage]].pieces.last().copied()?;
        let micrometres = |metres: f64| (metres * 1e6).round() as u64;
        // Cost up to the end of a lane, and where it was entered from.
        let mut best: BTreeMap<Stage, (u64, Option<Stage>)> = BTreeMap::new();
        let mut open = BinaryHeap::new();
        for &lane in &self.road(first(0)?).lanes {
            if wish.lane.is_none_or(|wanted| self.lane(lane).index == wanted) {
                let cost = micrometres(self.lane(lane).length_m);
                best.insert((0, lane), (cost, None));
                open.push(Reverse((cost, 0, lane)));
            }
        }
        while let Some(Reverse((cost, stage, lane))) = open.pop() {
            if best[&(stage, lane)].0 < cost {
                continue;
            }
            let own = self.lane(lane);
            let there = stage == last_stage && own.road == goal_road;
            if there && wish.last_lane.is_none_or(|wanted| own.index == wanted) {
                let mut lanes = vec![lane];
                let mut at = (stage, lane);
                while let Some(before) = best[&at].1 {
                    lanes.push(before.1);
                    at = before;
                }
                lanes.reverse();
                return Some(lanes);
            }
            let mut reach = |stage_then: usize, next: LaneId, cost: u64| {
                let known = best.get(&(stage_then, next)).map_or(u64::MAX, |known| known.0);
                if cost < known {
                    best.insert((stage_then, next), (cost, Some((stage, lane))));
                    open.push(Reverse((cost, stage_then, next)));
                }
            };
            for &next in &self.followers[usize::from(lane.0)] {
                let enters = stage < last_stage && first(stage + 1) == Some(self.lane(next).road);
                reach(stage + usize::from(enters), next, cost + micrometres(self.lane(next).length_m));
            }
            for &next in self.road(own.road).lanes.iter().filter(|next| self.may_change(lane, **next)) {
                // Of the pieces of a road, one that is long enough for the change.
                let short_m = (2.0 * HALF_CHANGE_M - own.length_m).max(0.0);
                reach(stage, next, cost + micrometres(CHANGE_M + short_m));
            }
        }
        None
    }

    /// Whether a lane may be left for another beside it.
    fn may_change(&self, from: LaneId, to: LaneId) -> bool {
        let (own, other) = (self.lane(from), self.lane(to));
        let part = self.road(own.road).part;
        if own.index.abs_diff(other.index) != 1 || matches!(part, RoadPart::Inner | RoadPart::Beside(_)) {
            return false;
        }
        let widths = (own.width_at(0.5 * own.length_m), other.width_at(0.5 * other.length_m));
        let apart = own.position(0.5 * own.length_m, 0.0).distance(other.position(0.5 * other.length_m, 0.0));
        widths.0.min(widths.1) >= CHANGE_WIDTH_M && apart <= 0.5 * (widths.0 + widths.1) + 0.5
    }
}
