//! Writes scenarios with every place resolved, and what the native simulator makes of them: the input of
//! `oracle/closed_loop.py`, one JSON line each.
//!
//!     cargo run -p recrash-sim --example resolve -- SCENARIO.json...
//!     cargo run -p recrash-sim --example resolve -- --random COUNT SEED
//!     cargo run -p recrash-sim --example resolve -- --trials

use recrash_model::rollout::Rollout;
use recrash_model::scenario::{ObstacleKind, ScenarioDraft};
use recrash_roads::{Placement, Scenario, check, read_draft};
use recrash_sim::{Ego, simulate};
use serde_json::{Value, json};

#[path = "../tests/suite/common/mod.rs"]
mod common;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let drafts: Vec<ScenarioDraft> = match arguments.as_slice() {
        [flag, count, seed] if flag == "--random" => {
            let (count, seed) = (count.parse().expect("a count"), seed.parse().expect("a seed"));
            (0..).filter_map(|n| common::random_draft(seed, n)).take(count).collect()
        }
        [flag] if flag == "--trials" => common::trials(),
        files => files
            .iter()
            .map(|file| {
                let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
                read_draft(&text).unwrap_or_else(|problems| panic!("{file}: {problems:?}")).value
            })
            .collect(),
    };
    for draft in drafts {
        let id = draft.id.clone();
        match check(draft) {
            Ok(checked) => println!("{}", resolved(&checked.value)),
            Err(problems) => eprintln!("{id}: {problems:?}"),
        }
    }
}

fn resolved(scenario: &Scenario) -> Value {
    let draft = scenario.draft();
    let mut ego = place(scenario, scenario.ego());
    ego["target_speed_mps"] = json!(draft.ego.target_speed_mps);
    let partners: Vec<Value> = draft
        .partners
        .iter()
        .zip(scenario.partners())
        .map(|(partner, placement)| {
            let mut value = place(scenario, placement);
            value["policy"] = serde_json::to_value(&partner.policy).expect("plain data");
            value["lateral"] = serde_json::to_value(&partner.lateral).expect("plain data");
            value
        })
        .collect();
    let obstacles: Vec<Value> = scenario
        .obstacles()
        .iter()
        .map(|obstacle| {
            let lane = scenario.network().lane(obstacle.lane);
            let road = scenario.network().road(lane.road);
            let kind = match obstacle.placed.kind {
                ObstacleKind::Cone => "cone",
                ObstacleKind::Barrier => "barrier",
                ObstacleKind::Warning => "warning",
            };
            let pose = obstacle.placed.pose;
            json!({ "kind": kind, "lane": [road.from, road.to, lane.index], "x": pose.position.x, "y": pose.position.y,
                    "heading": pose.heading })
        })
        .collect();
    json!({
        "id": draft.id, "map": draft.map, "ego": ego, "partners": partners, "obstacles": obstacles,
        "max_steps": (draft.duration_s * 10.0).round(), "native": outcome(&simulate(scenario, Ego::MetadriveIdm)),
        "draft": draft,
    })
}

fn place(scenario: &Scenario, placement: &Placement) -> Value {
    let network = scenario.network();
    let segment = placement.path.segments[placement.path.segment_at(placement.s_m)];
    let lane = network.lane(segment.lane);
    let road = network.road(lane.road);
    let last = network.road(*placement.path.roads.last().expect("a path has roads"));
    let at = placement.path.segment_at(placement.s_m);
    let mut route = vec![road.from.as_str()];
    route.extend(placement.path.roads[at..].iter().map(|&road| network.road(road).to.as_str()));
    json!({ "lane": [road.from, road.to, lane.index], "s_m": placement.s_m - segment.start_m, "t_m": placement.t_m,
            "route": route, "speed_mps": placement.speed_mps, "destination": last.to })
}

fn outcome(rollout: &Rollout) -> Value {
    let tracks: Vec<Vec<[f64; 6]>> = rollout
        .actors
        .iter()
        .map(|track| {
            track.states.iter().map(|s| [s.x, s.y, s.heading, s.velocity().length(), s.steer, s.throttle]).collect()
        })
        .collect();
    json!({ "end": rollout.termination.kind, "time_s": rollout.termination.time_s, "tracks": tracks,
            "contact": rollout.first_ego_contact().map(|(other, time, ..)| (other, time)) })
}
