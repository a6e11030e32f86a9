//! The ground: ways off the street, narrow streets, stalls, and where three roads meet.

use crate::ways::{before_contact, degrees_between, made, partner, story};
use recrash_model::account::{Fact, PlaceKind};
use recrash_model::metrics::CheckKind;
use recrash_model::scenario::{GraphMap, MapSpec, RoadSpec, StripKind};
use recrash_reconstruct::Reconstruction;

const NOSE_OUT: &str = "The AV was traveling west on Elm Street. An SUV was stopped in a driveway on the south side of Elm Street. The SUV began to turn left onto \
                        Elm Street, and the front of the SUV made contact with the left side of the AV.";

const INTO_LOT: &str = "The AV was traveling north on Elm Street and began to turn left into a parking lot. A motorcycle traveling behind the AV passed the \
                        AV on the left, and the front of the motorcycle made contact with the left side of the AV.";

const INTO_STREET: &str = "The AV was traveling north on Elm Street and began to turn left onto Oak Street. A motorcycle traveling behind the AV passed the \
                           AV on the left, and the front of the motorcycle made contact with the left side of the AV.";

const OTHER_INTO_LOT: &str = "The AV was traveling north in the right lane of Elm Street. A sedan traveling north in the left lane began to turn right into a \
                              driveway, and the right side of the sedan made contact with the front left of the AV.";

const OUT_OF_ALLEY: &str = "The AV was turning right out of an alley onto Elm Street. A sedan traveling on Elm Street from the left made contact with the \
                            left side of the AV with its front.";

const TEE: &str = "The AV was traveling north on Elm Street and began to turn left at the T-intersection with Oak Street. A sedan traveling behind the AV \
                   made contact with the rear of the AV.";

const NARROW: &str = "The AV was traveling north on a narrow portion of Elm Street when it slowed to a stop to yield to a van traveling south on Elm Street. \
                      While the AV was stopped, the van proceeded straight, and the left side of the van made contact with the rear left of the AV.";

const STALL: &str = "The AV was driving through a parking lot when a sedan reversed out of a parking stall on the right, and the rear of the sedan made \
                     contact with the right side of the AV.";

fn map(shown: &Reconstruction) -> &GraphMap {
    match &shown.draft.map {
        MapSpec::G(map) => map,
        other => panic!("{other:?}"),
    }
}

fn lanes(road: &RoadSpec) -> [usize; 2] {
    [&road.right, &road.left].map(|side| side.iter().filter(|strip| strip.kind == StripKind::Driving).count())
}

fn road<'a>(map: &'a GraphMap, id: &str) -> Option<&'a RoadSpec> {
    map.roads.iter().find(|road| road.id == id)
}

#[test]
fn who_stood_in_a_driveway_comes_out_of_it_beside_the_road() {
    let mut account = story(NOSE_OUT);
    account.place.kind = Some(Fact::by_rule(PlaceKind::Street, "made for this test"));
    let shown = made(&account);
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let (states, met) = partner(&shown);
    let drive = scenario.network().area("main.driveways[0]").expect("a driveway");
    assert!(map(&shown).junctions.is_empty() && drive.contains(states[0].position()));
    assert!(degrees_between(met.heading, states[0].heading) > 15.0, "{met:?}");
}

#[test]
fn a_way_off_the_street_has_one_lane_each_way_and_nothing_across() {
    let shown = made(&story(INTO_LOT));
    let into = map(&shown);
    assert_eq!(road(into, "driveway").map(lanes), Some([1, 1]), "{:?}", into.roads);
    assert!(road(into, "right").is_none() && road(into, "ahead").map(lanes) == Some([2, 2]));
    let others = made(&story(OTHER_INTO_LOT));
    let others = map(&others);
    assert!(road(others, "right").map(lanes) == Some([1, 1]) && road(others, "left").is_none(), "{:?}", others.roads);
    let street = made(&story(INTO_STREET));
    let street = map(&street);
    assert!(street.roads.len() == 4 && street.roads.iter().all(|road| lanes(road) == [2, 2]), "{:?}", street.roads);
}

#[test]
fn an_alley_out_of_which_the_ego_turns_ends_at_the_street() {
    let shown = made(&story(OUT_OF_ALLEY));
    let map = map(&shown);
    assert_eq!(road(map, "own").map(lanes), Some([1, 1]), "{:?}", map.roads);
    assert!(road(map, "ahead").is_none() && road(map, "left").map(lanes) == Some([2, 2]));
}

#[test]
fn three_roads_meet_at_a_tee() {
    let shown = made(&story(TEE));
    let ids: Vec<&str> = map(&shown).roads.iter().map(|road| road.id.as_str()).collect();
    assert_eq!(ids, ["own", "left", "right"]);
}

#[test]
fn who_passes_in_a_narrow_street_hardly_leaves_its_lane() {
    let shown = made(&story(NARROW));
    let main = &map(&shown).roads[0];
    assert!(main.right[0].width_m == Some(2.7) && lanes(main) == [1, 1], "{main:?}");
    let (states, met) = partner(&shown);
    assert!((states[0].y - met.y).abs() < 0.8, "{:?}, {met:?}", states[0]);
}

#[test]
fn who_backs_out_of_a_stall_stood_in_the_row_of_stalls() {
    let account = story(STALL);
    let shown = made(&account);
    let ((states, _), ego) = (partner(&shown), shown.rollout.ego_track());
    let main = &map(&shown).roads[0];
    assert_eq!(main.right.last().map(|strip| strip.kind), Some(StripKind::Stalls), "{main:?}");
    let (aside_m, last) = (ego.states[0].y - states[0].y, before_contact(&shown));
    assert!((3.5..5.5).contains(&aside_m) && states[last].y > states[0].y + 0.5, "{aside_m}");
    // Behind the stalls it is in none.
    let mut draft = shown.draft.clone();
    let cp = draft.actors.iter_mut().find(|actor| actor.id == "cp").expect("a partner");
    if let recrash_model::scenario::Place::Plane { y_m, .. } = &mut cp.plan.start {
        *y_m -= 4.0;
    }
    let scenario = recrash_roads::check(draft).expect("it can run").value;
    let rollout = recrash_sim::simulate(&scenario, recrash_sim::Ego::Recorded);
    let held = recrash_reconstruct::held_against(&account, &scenario, &rollout).expect("it can be held");
    assert!(held.failures().any(|check| check.kind == CheckKind::Approach), "it began behind the stalls: {held:?}");
}
