//! Lanes, routes, paths and conflicts against numbers a reader can work out by hand.

use crate::common::{cross, curve, roundabout, straight, tee};
use recrash_model::geometry::Vec2;
use recrash_model::math::{FRAC_PI_2, PI, wrap_angle};
use recrash_model::narrative::Side;
use recrash_model::scenario::{Approach, MapSpec, MissingArm, Turn};
use recrash_roads::{Lane, LanePath, RoadNetwork};

const APPROACHES: [Approach; 5] = [Approach::Same, Approach::Opposite, Approach::Left, Approach::Right, Approach::Ring];
const TURNS: [Turn; 3] = [Turn::Straight, Turn::Left, Turn::Right];

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

fn lane(network: &RoadNetwork, from: &str, to: &str, index: usize) -> Lane {
    let road = network.road_between(from, to).unwrap_or_else(|| panic!("no road {from} -> {to}"));
    *network.lane(network.road(road).lanes[index])
}

fn path(network: &RoadNetwork, approach: Approach, turn: Turn, lane: u8) -> LanePath {
    LanePath::new(network, network.route(approach, turn).expect("the way exists"), lane)
}

fn nodes(network: &RoadNetwork, approach: Approach, turn: Turn) -> Option<String> {
    let route = network.route(approach, turn)?;
    let mut names = vec![network.road(route[0]).from.clone()];
    for road in route {
        assert_eq!(names.last(), Some(&network.road(road).from), "a route has no holes");
        names.push(network.road(road).to.clone());
    }
    Some(names.join(" "))
}

fn every_map() -> Vec<MapSpec> {
    let mut maps = Vec::new();
    for lanes in 1..=4 {
        maps.extend([straight(lanes), cross(lanes), roundabout(lanes)]);
        maps.extend([curve(lanes, Side::Left), curve(lanes, Side::Right)]);
        maps.extend([MissingArm::Right, MissingArm::Ahead, MissingArm::Left].map(|missing| tee(lanes, missing)));
    }
    maps
}

#[test]
fn lanes_lie_side_by_side_with_the_rightmost_on_the_x_axis() {
    let network = RoadNetwork::build(&straight(2));
    let y = |from, to, index| lane(&network, from, to, index).position(0.0, 0.0).y;
    assert_eq!([y(">", ">>", 0), y(">", ">>", 1)], [3.5, 0.0]);
    assert!(close(y("->>", "->", 0), 7.0) && close(y("->>", "->", 1), 10.5));
}

#[test]
fn t_is_positive_to_the_right_of_travel() {
    let network = RoadNetwork::build(&straight(1));
    let there = lane(&network, ">", ">>", 0).position(3.0, 1.0);
    assert!(close(there.x, 3.0) && close(there.y, -1.0));
    let back = lane(&network, "->>", "->", 0).position(3.0, 1.0);
    assert!(close(back.x, 7.0) && close(back.y, 4.5));
}

#[test]
fn junction_connectors_have_the_closed_form_lengths() {
    for lanes in 1..=4_u8 {
        let network = RoadNetwork::build(&cross(lanes));
        let n = f64::from(lanes);
        for index in 0..lanes {
            let k = f64::from(index);
            let length = |to| lane(&network, ">>>", to, usize::from(index)).length_m;
            assert!(close(length("1X0_0_"), FRAC_PI_2 * (10.0 + (n - 1.0 - k) * 3.5)));
            assert!(close(length("1X1_0_"), 20.0 + (2.0 * n - 1.0) * 3.5));
            assert!(close(length("1X2_0_"), FRAC_PI_2 * (10.0 + (n + k) * 3.5)));
        }
    }
}

#[test]
fn a_curve_s_radius_is_that_of_the_rightmost_lane() {
    let left = RoadNetwork::build(&curve(2, Side::Left));
    assert!(close(lane(&left, ">>>", "1C0_0_", 1).length_m, FRAC_PI_2 * 50.0));
    assert!(close(lane(&left, ">>>", "1C0_0_", 0).length_m, FRAC_PI_2 * 46.5));
    assert!(close(lane(&left, "-1C0_0_", "->>>", 1).length_m, FRAC_PI_2 * 39.5));
    let right = RoadNetwork::build(&curve(2, Side::Right));
    assert!(close(lane(&right, ">>>", "1C0_0_", 0).length_m, FRAC_PI_2 * 53.5));
}

#[test]
fn a_roundabout_has_the_measured_arcs() {
    let network = RoadNetwork::build(&roundabout(2));
    let lengths = |from, to| [0, 1].map(|index| (lane(&network, from, to, index).length_m * 100.0).round() / 100.0);
    assert_eq!(lengths(">>>", "1O0_0_"), [14.14, 10.47]);
    assert_eq!(lengths("1O0_0_", "1O0_1_"), [19.37, 21.21]);
    assert_eq!(lengths("1O0_1_", "1O1_0_"), [17.80, 21.47]);
    assert_eq!(lengths("1O0_1_", "1O0_2_"), [14.14, 10.47]);
}

#[test]
fn routes_go_by_metadrive_s_node_names() {
    let x = RoadNetwork::build(&cross(2));
    let found = |approach, turn| nodes(&x, approach, turn).unwrap_or_default();
    assert_eq!(found(Approach::Same, Turn::Right), "> >> >>> 1X0_0_ 1X0_1_");
    assert_eq!(found(Approach::Same, Turn::Straight), "> >> >>> 1X1_0_ 1X1_1_");
    assert_eq!(found(Approach::Same, Turn::Left), "> >> >>> 1X2_0_ 1X2_1_");
    assert_eq!(found(Approach::Left, Turn::Straight), "-1X2_1_ -1X2_0_ 1X0_0_ 1X0_1_");
    assert_eq!(found(Approach::Left, Turn::Left), "-1X2_1_ -1X2_0_ 1X1_0_ 1X1_1_");
    assert_eq!(found(Approach::Left, Turn::Right), "-1X2_1_ -1X2_0_ ->>> ->> ->");
    assert_eq!(found(Approach::Right, Turn::Right), "-1X0_1_ -1X0_0_ 1X1_0_ 1X1_1_");
    assert_eq!(found(Approach::Right, Turn::Left), "-1X0_1_ -1X0_0_ ->>> ->> ->");
    assert_eq!(found(Approach::Opposite, Turn::Straight), "-1X1_1_ -1X1_0_ ->>> ->> ->");
    assert_eq!(found(Approach::Opposite, Turn::Left), "-1X1_1_ -1X1_0_ 1X0_0_ 1X0_1_");

    let o = RoadNetwork::build(&roundabout(2));
    let found = |approach, turn| nodes(&o, approach, turn).unwrap_or_default();
    assert_eq!(found(Approach::Same, Turn::Right), "> >> >>> 1O0_0_ 1O0_1_ 1O0_2_ 1O0_3_");
    assert_eq!(found(Approach::Same, Turn::Straight), "> >> >>> 1O0_0_ 1O0_1_ 1O1_0_ 1O1_1_ 1O1_2_ 1O1_3_");
    assert_eq!(found(Approach::Left, Turn::Right), "-1O2_3_ -1O2_2_ 1O3_0_ 1O3_1_ ->>> ->> ->");
    assert_eq!(found(Approach::Left, Turn::Straight), "-1O2_3_ -1O2_2_ 1O3_0_ 1O3_1_ 1O0_0_ 1O0_1_ 1O0_2_ 1O0_3_");
    assert_eq!(found(Approach::Ring, Turn::Right), "1O2_1_ 1O3_0_ 1O3_1_ 1O0_0_ 1O0_1_ 1O0_2_ 1O0_3_");

    assert_eq!(
        found(Approach::Ring, Turn::Left),
        "1O3_0_ 1O3_1_ 1O0_0_ 1O0_1_ 1O1_0_ 1O1_1_ 1O2_0_ 1O2_1_ 1O2_2_ 1O2_3_"
    );

    let s = RoadNetwork::build(&straight(2));
    assert_eq!(nodes(&s, Approach::Same, Turn::Straight).as_deref(), Some("> >> >>> 1S0_0_"));
    assert_eq!(nodes(&s, Approach::Opposite, Turn::Straight).as_deref(), Some("-1S0_0_ ->>> ->> ->"));
    let c = RoadNetwork::build(&curve(2, Side::Left));
    assert_eq!(nodes(&c, Approach::Opposite, Turn::Straight).as_deref(), Some("-1C0_1_ -1C0_0_ ->>> ->> ->"));
}

#[test]
fn no_way_passes_a_node_twice() {
    for map in every_map() {
        let network = RoadNetwork::build(&map);
        for (approach, turn) in APPROACHES.iter().flat_map(|approach| TURNS.map(|turn| (*approach, turn))) {
            let Some(text) = nodes(&network, approach, turn) else { continue };
            let names: Vec<&str> = text.split(' ').collect();
            let different: std::collections::BTreeSet<_> = names.iter().collect();
            assert_eq!(names.len(), different.len(), "{text}");
        }
    }
}

#[test]
fn ways_that_a_map_lacks_are_none() {
    for (map, ways) in [(straight(1), 2), (curve(1, Side::Left), 2), (cross(1), 12), (roundabout(1), 15)] {
        let network = RoadNetwork::build(&map);
        let found = APPROACHES.iter().flat_map(|a| TURNS.map(|t| network.route(*a, t))).flatten().count();
        assert_eq!(found, ways, "{}", map.letter());
    }
    for (missing, turn) in
        [(MissingArm::Right, Turn::Right), (MissingArm::Ahead, Turn::Straight), (MissingArm::Left, Turn::Left)]
    {
        let network = RoadNetwork::build(&tee(2, missing));
        let found = APPROACHES.iter().flat_map(|a| TURNS.map(|t| network.route(*a, t))).flatten().count();
        assert_eq!(found, 6);
        assert_eq!(network.route(Approach::Same, turn), None);
    }
}

#[test]
fn every_path_is_smooth_where_lanes_meet() {
    for map in every_map() {
        let network = RoadNetwork::build(&map);
        for approach in APPROACHES {
            for turn in TURNS {
                let Some(route) = network.route(approach, turn) else { continue };
                for lane in 0..map.carriageway().lanes {
                    let path = LanePath::new(&network, route.clone(), lane);
                    for pair in path.segments.windows(2) {
                        let (before, after) = (network.lane(pair[0].lane), network.lane(pair[1].lane));
                        let gap = before.position(before.length_m, 0.0).distance(after.position(0.0, 0.0));
                        let kink = wrap_angle(before.heading(before.length_m) - after.heading(0.0)).abs();
                        assert!(gap < 1e-9 && kink < 1e-9, "{map:?} {approach:?} {turn:?}: {gap} m, {kink} rad");
                    }
                }
            }
        }
    }
}

#[test]
fn pose_and_project_are_inverse_and_continue_straight_beyond_the_ends() {
    for map in every_map() {
        let network = RoadNetwork::build(&map);
        for approach in APPROACHES {
            for turn in TURNS {
                let Some(route) = network.route(approach, turn) else { continue };
                let path = LanePath::new(&network, route, 0);
                let mut hint = 0;
                let mut s = -20.0;
                while s < path.length_m + 20.0 {
                    let pose = path.pose(s, 1.25);
                    let found = path.project(pose.position, hint);
                    assert!((found.s - s).abs() < 1e-9 && (found.t - 1.25).abs() < 1e-9, "{map:?}: {s} {found:?}");
                    assert!(found.segment >= hint);
                    hint = found.segment;
                    s += 0.7;
                }
            }
        }
    }
}

#[test]
fn projection_never_goes_back_behind_the_hint() {
    let network = RoadNetwork::build(&cross(2));
    let path = path(&network, Approach::Same, Turn::Left, 0);
    let start = path.pose(5.0, 0.0).position;
    assert_eq!(path.project(start, 0).segment, 0);
    let found = path.project(start, 2);
    assert_eq!(found.segment, 2);
    assert!(close(found.s, 5.0), "along the tangent of the connector's beginning: {found:?}");
}

#[test]
fn crossing_straight_paths_conflict_where_their_lines_cross() {
    let network = RoadNetwork::build(&cross(2));
    let ego = path(&network, Approach::Same, Turn::Straight, 1);
    let from_left = path(&network, Approach::Left, Turn::Straight, 1);
    let conflict = ego.conflict(&from_left, 1.852, 1.852).expect("they cross");
    assert!(!conflict.merges);
    assert!(conflict.point.distance(Vec2::new(70.0, 0.0)) < 1e-9);
    assert!(close(conflict.s_a, 70.0) && close(conflict.s_b, 60.0 + 20.5), "{conflict:?}");
    let from_right = path(&network, Approach::Right, Turn::Straight, 1);
    let conflict = ego.conflict(&from_right, 1.852, 1.852).expect("they cross");
    assert!(conflict.point.distance(Vec2::new(80.5, 0.0)) < 1e-9);
}

#[test]
fn an_oncoming_left_turn_crosses_on_its_arc() {
    let network = RoadNetwork::build(&cross(1));
    let ego = path(&network, Approach::Same, Turn::Straight, 0);
    let turning = path(&network, Approach::Opposite, Turn::Left, 0);
    let conflict = ego.conflict(&turning, 1.852, 1.852).expect("they cross");
    // The oncoming lane ends at (83.5, 3.5); its arc has radius 13.5 around (83.5, -10): y = 0 at 10 above the centre.
    let x = 83.5 - (13.5_f64 * 13.5 - 100.0).sqrt();
    assert!(conflict.point.distance(Vec2::new(x, 0.0)) < 1e-9, "{conflict:?}");
    let on_other = turning.pose(conflict.s_b, 0.0).position;
    assert!(on_other.distance(conflict.point) < 1e-9);
}

#[test]
fn a_merge_begins_where_the_lateral_distance_is_half_of_both_widths() {
    let network = RoadNetwork::build(&cross(1));
    let ego = path(&network, Approach::Same, Turn::Right, 0);
    let from_left = path(&network, Approach::Left, Turn::Straight, 0);
    let conflict = ego.conflict(&from_left, 1.8, 2.2).expect("they merge");
    assert!(conflict.merges);
    // The arc has radius 10 around (60, -10); the straight is x = 70. Distance 2 at an angle with 10 cos = 8.
    let angle = (conflict.s_a - 60.0) / 10.0;
    assert!((conflict.point.x - 68.0).abs() < 1e-9, "{conflict:?}");
    assert!(angle > 0.0 && angle < FRAC_PI_2);
    assert!((from_left.pose(conflict.s_b, 0.0).position.y - conflict.point.y).abs() < 1e-9);
}

#[test]
fn a_ring_vehicle_conflicts_with_the_ego_s_entry_in_the_same_lane() {
    let network = RoadNetwork::build(&roundabout(2));
    for turn in TURNS {
        let ego = path(&network, Approach::Same, Turn::Straight, 1);
        let ring = path(&network, Approach::Ring, turn, 1);
        let conflict = ego.conflict(&ring, 1.852, 1.852).expect("they merge");
        assert!(conflict.merges);
        let entry_end = ego.segments[3].start_m;
        assert!(conflict.s_a < entry_end && conflict.s_a > entry_end - 10.48, "{turn:?} {conflict:?}");
    }
}

#[test]
fn paths_that_share_their_lane_or_run_side_by_side_do_not_conflict() {
    let network = RoadNetwork::build(&cross(2));
    let ego = path(&network, Approach::Same, Turn::Straight, 1);
    assert_eq!(ego.conflict(&ego, 1.852, 1.852), None);
    let beside = path(&network, Approach::Same, Turn::Straight, 0);
    assert_eq!(ego.conflict(&beside, 1.852, 1.852), None);
    let oncoming = path(&network, Approach::Opposite, Turn::Straight, 0);
    assert_eq!(ego.conflict(&oncoming, 1.852, 1.852), None);
    let turns_off = path(&network, Approach::Same, Turn::Right, 1);
    assert_eq!(ego.conflict(&turns_off, 1.852, 1.852), None);
}

#[test]
fn a_left_turn_from_the_outer_lane_crosses_a_straight_path_in_the_inner_one() {
    let network = RoadNetwork::build(&cross(2));
    let ego = path(&network, Approach::Same, Turn::Straight, 0);
    let turning = path(&network, Approach::Same, Turn::Left, 1);
    let conflict = ego.conflict(&turning, 1.852, 1.852).expect("they cross");
    assert!((conflict.point.y - 3.5).abs() < 1e-9 && !conflict.merges);
}

/// The analytic crossing against a fine march over both paths, for every pair of ways of every map.
#[test]
fn crossings_agree_with_a_numeric_search() {
    let mut crossings = 0;
    for map in [cross(2), tee(3, MissingArm::Left), roundabout(2)] {
        let network = RoadNetwork::build(&map);
        let last = map.carriageway().lanes - 1;
        for ego_turn in TURNS {
            for lane in [0, last] {
                let Some(route) = network.route(Approach::Same, ego_turn) else { continue };
                let ego = LanePath::new(&network, route, lane);
                for approach in [Approach::Left, Approach::Right, Approach::Opposite, Approach::Ring] {
                    for turn in TURNS {
                        let Some(route) = network.route(approach, turn) else { continue };
                        let other = LanePath::new(&network, route, lane);
                        let Some(found) = ego.conflict(&other, 1.852, 1.852) else {
                            assert!(least_distance(&ego, &other) > 0.3, "{ego_turn:?} {approach:?} {turn:?}");
                            continue;
                        };
                        if found.merges {
                            continue;
                        }
                        crossings += 1;
                        let on_other = other.pose(found.s_b, 0.0).position;
                        assert!(on_other.distance(found.point) < 1e-6);
                        let on_ego = ego.pose(found.s_a, 0.0).position;
                        assert!(on_ego.distance(found.point) < 1e-6);
                    }
                }
            }
        }
    }
    assert!(crossings >= 16, "{crossings}");
}

fn least_distance(a: &LanePath, b: &LanePath) -> f64 {
    let mut least = f64::INFINITY;
    for i in 0..(a.length_m as usize) {
        let p = a.pose(i as f64, 0.0).position;
        for j in 0..(b.length_m as usize * 2) {
            least = least.min(p.distance(b.pose(0.5 * j as f64, 0.0).position));
        }
    }
    least
}

#[test]
fn lane_at_prefers_lanes_in_the_vehicle_s_direction() {
    let network = RoadNetwork::build(&cross(2));
    let on = |x, y, heading| {
        network.lane_at(Vec2::new(x, y), heading).map(|id| {
            let lane = network.lane(id);
            (network.road(lane.road).from.clone(), lane.index)
        })
    };
    assert_eq!(on(30.0, 0.4, 0.0), Some((">>".to_owned(), 1)));
    assert_eq!(on(30.0, 3.0, 0.1), Some((">>".to_owned(), 0)));
    assert_eq!(on(30.0, 7.2, PI), Some(("->>>".to_owned(), 0)));
    assert_eq!(on(30.0, 7.2, 0.0), Some(("->>>".to_owned(), 0)), "on the wrong side, but on the road");
    assert_eq!(on(30.0, -1.8, 0.0), None, "off the road");
    assert_eq!(on(70.0, 0.0, 0.0), Some((">>>".to_owned(), 1)));
    assert_eq!(on(70.0, 0.0, -FRAC_PI_2), Some(("-1X2_0_".to_owned(), 1)));
}
