//! Networks of roads, plans and control, as MetaDrive's Python takes them.

use super::LaneName;
use crate::acts::{PartTrack, ReplayTrack, replay};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{EGO_ID, STEP_S};
use recrash_model::scenario::{Device, MissionStop, PartKind, ScenarioDraft};
use recrash_roads::{Centreline, Lane, LaneId, RoadPart, Scenario};
use serde::Serialize;

/// The recorded driver drives to the end.
pub const NO_HANDOVER: u32 = u32::MAX;

/// What a scenario has besides the paper's: nothing of it on one that the paper could have had.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scene {
    /// Lanes of a network of roads.
    pub lanes: Vec<LaneShape>,
    /// What the recorded driver does, up to the handover.
    pub recorded: Option<Planned>,
    /// The step at which the ego's policy takes over.
    pub handover: u32,
    /// How fast the ego turns there. [rad/s]
    pub handover_turns_radps: f64,
    /// Road users with a plan, in the scenario's order.
    pub planned: Vec<Planned>,
    /// Boxes that belong to others, in the order of rollouts.
    pub parts: Vec<PlannedPart>,
    /// Signals and signs.
    pub control: Vec<Device>,
    /// Stop lines on the ego's way: where its centre is then, and which control. [m]
    pub lines: Vec<(f64, usize)>,
    /// Stops of the ego's task.
    pub stops: Vec<MissionStop>,
    /// The replay of plans ends at this step, and why.
    pub ends: Option<(u32, String)>,
}

/// A lane of a network of roads.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LaneShape {
    /// The name that MetaDrive gets to know it by.
    pub name: LaneName,
    /// Its centre line.
    pub line: LaneLine,
    /// Length. [m]
    pub length_m: f64,
    /// Widths at its beginning and end. [m]
    pub widths_m: (f64, f64),
}

/// A centre line. [m, rad]
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "as in `recrash_roads::Centreline`")]
pub enum LaneLine {
    Straight { start: [f64; 2], end: [f64; 2] },
    Arc { centre: [f64; 2], radius: f64, start_angle: f64, turn: f64 },
}

/// Somebody with a plan.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Planned {
    /// Name.
    pub id: String,
    /// Kind.
    pub kind: PartnerKind,
    /// Length of its box. [m]
    pub length_m: f64,
    /// Width of its box. [m]
    pub width_m: f64,
    /// x, y [m], heading [rad], velocity along x and y [m/s], for every step; the last counts on.
    pub states: Vec<[f64; 5]>,
    /// The first step at which it is there.
    pub appears: u32,
    /// The step at which it leaves.
    pub gone: Option<u32>,
    /// From this step on its plan changes nothing any more.
    pub over: u32,
    /// The lane it is on, where it is on one, each from a step on.
    pub lanes: Vec<(u32, Option<LaneName>)>,
}

/// A box that belongs to somebody.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedPart {
    /// Name.
    pub id: String,
    /// Kind of its owner.
    pub kind: PartnerKind,
    /// Its owner among the actors of the run.
    pub owner: usize,
    /// Length of its box. [m]
    pub length_m: f64,
    /// Width of its box. [m]
    pub width_m: f64,
    /// x, y [m], heading [rad] for every step, seen from the owner where that is the ego; the last counts on.
    pub states: Vec<[f64; 3]>,
}

impl Scene {
    /// Of a scenario whose recorded driver drives up to a step; `None` where it has nothing that the paper could not have had.
    ///
    /// # Errors
    /// What MetaDrive cannot hold.
    pub(super) fn of(scenario: &Scenario, handover: u32) -> Result<Option<Self>, String> {
        let draft = scenario.draft();
        if is_plain(draft) {
            return Ok(None);
        }
        let network = draft.map.network().is_some();
        fits(draft)?;
        let names = LaneNames::of(scenario);
        if network && names.passes_twice() {
            return Err("the ego's way passes a road twice".to_owned());
        }
        let replay = replay(scenario, handover);
        let size = recrash_model::vehicle::VehicleSpec::of(scenario.ego().kind);
        let handover_turns_radps = replay.ego.as_ref().map_or(0.0, |track| track.turns_radps);
        let recorded =
            replay.ego.map(|track| planned(&names, EGO_ID, (scenario.ego().kind, size.length_m, size.width_m), track));
        let actors = draft.actors.iter().zip(scenario.actors()).zip(replay.actors);
        let others = actors.map(|((actor, placement), track)| {
            planned(&names, &actor.id, (placement.kind, placement.length_m, placement.width_m), track)
        });
        let planned: Vec<Planned> = others.collect();
        let mut parts = parts(scenario, &planned, replay.parts);
        if recorded.is_none() {
            parts.extend(resting_parts(scenario));
        }
        Ok(Some(Self {
            lanes: if network { lanes(&names) } else { Vec::new() },
            handover: if recorded.is_some() { handover } else { 0 },
            handover_turns_radps,
            recorded,
            planned,
            parts,
            control: draft.control.iter().map(|control| control.device.clone()).collect(),
            lines: scenario.ego_stop_lines().map(|line| (line.at_m, line.control)).collect(),
            stops: draft.ego.stops.clone(),
            ends: replay.ends,
        }))
    }
}

/// Whether a scenario has nothing that the paper could not have had.
fn is_plain(draft: &ScenarioDraft) -> bool {
    draft.map.network().is_none()
        && draft.actors.is_empty()
        && draft.control.is_empty()
        && draft.ego.recorded.is_none()
        && draft.ego.stops.is_empty()
        && draft.ego.parts.is_empty()
        && draft.ego.size.is_none()
}

/// Whether MetaDrive can hold the ego; else why not.
fn fits(draft: &ScenarioDraft) -> Result<(), String> {
    if draft.ego.size.is_some() {
        return Err("the ego is not as large as its kind".to_owned());
    }
    if draft.ego.parts.iter().any(|part| part.kind == PartKind::Trailer) {
        return Err("the ego draws a trailer".to_owned());
    }
    Ok(())
}

/// Boxes that belong to those with a plan, and to a recorded ego.
fn parts(scenario: &Scenario, planned: &[Planned], tracks: Vec<PartTrack>) -> Vec<PlannedPart> {
    let first_actor = 1 + scenario.draft().partners.len();
    let of = |track: PartTrack| {
        let (owner, kind) = match track.owner {
            0 => (EGO_ID, scenario.ego().kind),
            number => (planned[number - first_actor].id.as_str(), planned[number - first_actor].kind),
        };
        part(owner, kind, track)
    };
    tracks.into_iter().map(of).collect()
}

/// Those of an ego that nobody has recorded: at rest.
fn resting_parts(scenario: &Scenario) -> impl Iterator<Item = PlannedPart> {
    scenario.draft().ego.parts.iter().map(|own| {
        let attached = crate::acts::Attached { owner: 0, part: own.clone() };
        let at = attached.pose(&crate::acts::PartState::resting(own, 0.0), Pose::default());
        let states = vec![[at.position.x, at.position.y, at.heading]];
        part(EGO_ID, scenario.ego().kind, PartTrack { owner: 0, part: own.clone(), states })
    })
}

/// The step at which a scenario hands over, where it has a recorded driver.
pub fn handover(scenario: &Scenario) -> u32 {
    (scenario.draft().ego.handover_s.unwrap_or(0.0) / STEP_S).round() as u32
}

/// MetaDrive's names of a scenario's lanes.
///
/// A network's roads are not joined at nodes as MetaDrive's are, and two of them may join the same places: those of the
/// ego's way are joined by names of their own, and every other road is alone.
pub(super) struct LaneNames<'a> {
    scenario: &'a Scenario,
    network: bool,
    /// Roads of the ego's way, each once in a row.
    way: Vec<u16>,
}

impl<'a> LaneNames<'a> {
    pub(super) fn of(scenario: &'a Scenario) -> Self {
        let mut way: Vec<u16> = scenario.ego().path.roads.iter().map(|road| road.0).collect();
        way.dedup();
        Self { scenario, network: scenario.draft().map.network().is_some(), way }
    }

    fn passes_twice(&self) -> bool {
        let mut roads = self.way.clone();
        roads.sort_unstable();
        roads.windows(2).any(|pair| pair[0] == pair[1])
    }

    pub(super) fn name(&self, id: LaneId) -> LaneName {
        let lane = self.scenario.network().lane(id);
        let road = self.scenario.network().road(lane.road);
        if !self.network {
            return (road.from.clone(), road.to.clone(), lane.index);
        }
        let (from, to) = match self.way.iter().position(|known| *known == lane.road.0) {
            Some(place) => (format!("way{place}"), format!("way{}", place + 1)),
            None => (format!("road{}:0", lane.road.0), format!("road{}:1", lane.road.0)),
        };
        (from, to, lane.index)
    }

    /// The lane a point is on: one of the ego's way before any other, as MetaDrive finds it for who drives that way.
    fn at(&self, x: f64, y: f64, heading: f64) -> Option<LaneName> {
        let (network, point) = (self.scenario.network(), Vec2::new(x, y));
        let path = &self.scenario.ego().path;
        let own = path.segments.iter().map(|segment| segment.lane).filter(|id| network.lane(*id).contains(point));
        let off = |id: &LaneId| network.lane(*id).local(point).1.abs();
        let own = own.min_by(|a, b| off(a).total_cmp(&off(b)));
        own.or_else(|| network.lane_at(point, heading)).map(|id| self.name(id))
    }
}

/// The lanes of a network, but those that nobody may drive on.
fn lanes(names: &LaneNames<'_>) -> Vec<LaneShape> {
    let network = names.scenario.network();
    let paved = |lane: &Lane| !matches!(network.road(lane.road).part, RoadPart::Beside(kind) if !kind.is_paved());
    let shape = |(position, lane): (usize, &Lane)| {
        let point = |at: Vec2| [at.x, at.y];
        let line = match lane.centreline {
            Centreline::Straight { .. } => LaneLine::Straight {
                start: point(lane.position(0.0, 0.0)),
                end: point(lane.position(lane.length_m, 0.0)),
            },
            Centreline::Arc { centre, radius, start_angle, turn } => {
                LaneLine::Arc { centre: point(centre), radius, start_angle, turn }
            }
        };
        LaneShape {
            name: names.name(LaneId(u16::try_from(position).expect("lanes are counted"))),
            line,
            length_m: lane.length_m,
            widths_m: (lane.width_m, lane.end_width_m),
        }
    };
    network.lanes.iter().enumerate().filter(|(_, lane)| paved(lane)).map(shape).collect()
}

fn planned(names: &LaneNames<'_>, id: &str, body: (PartnerKind, f64, f64), track: ReplayTrack) -> Planned {
    let mut lanes: Vec<(u32, Option<LaneName>)> = Vec::new();
    for (step, [x, y, heading, ..]) in track.states.iter().enumerate() {
        let lane = names.at(*x, *y, *heading);
        if lanes.last().is_none_or(|(_, last)| *last != lane) {
            lanes.push((step as u32, lane));
        }
    }
    let (kind, length_m, width_m) = body;
    let ReplayTrack { states, appears, gone, over, .. } = track;
    Planned { id: id.to_owned(), kind, length_m, width_m, states, appears, gone, over, lanes }
}

fn part(owner: &str, kind: PartnerKind, track: PartTrack) -> PlannedPart {
    let PartTrack { owner: number, part, states } = track;
    let (length_m, width_m) = (part.length_m, part.width_m);
    PlannedPart { id: format!("{owner}.{}", part.id), kind, owner: number, length_m, width_m, states }
}
