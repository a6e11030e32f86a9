//! Told lanes and sides of the road, and how far a turn has come: of the ego and of who it meets.

use crate::lanes::lanes;
use crate::ways::{before_contact, degrees_between, made, partner, speeds, story};
use recrash_model::account::{Fact, PlaceKind};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_reconstruct::Reconstruction;

/// The partner beside the ego's first line, to the left, at so many seconds before the contact. [m]
fn left_before(made: &Reconstruction, before_s: f64) -> f64 {
    let at = before_contact(made) - (before_s * 10.0) as usize;
    partner(made).0[at].y - made.rollout.ego_track().states[0].y
}

#[test]
fn an_ego_that_turns_right_over_the_bicycle_lane_is_met_in_that_early_in_its_turn() {
    let text = "The AV was traveling south on Elm Street and made a right turn onto Oak Street across the bike lane. A cyclist traveling south \
                in the bike lane to the right of the AV ran into the right side of the AV with the front of the bicycle.";
    let shown = made(&story(text));
    let until = before_contact(&shown);
    let (ego, met) = (&shown.rollout.ego_track().states[until], partner(&shown).1);
    let turned = degrees_between(ego.heading, 0.0);
    assert!((15.0..55.0).contains(&turned), "{turned} degrees");
    let first = partner(&shown).0[0];
    assert!((met.y - first.y).abs() < 0.7 && degrees_between(met.heading, 0.0) < 8.0, "{met:?}");
}

#[test]
fn an_ego_that_waits_to_turn_left_does_so_in_the_lane_beside_the_middle() {
    let text = "The AV was stopped on Elm Street to yield to oncoming traffic, waiting to make an unprotected left turn at the intersection \
                with Oak Street. A van from behind struck the rear of the AV.";
    let account = story(text);
    let shown = made(&account);
    let seen = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::SvLane).expect("it is asked");
    assert_eq!((seen.result, seen.observed.as_str()), (CheckResult::Shown, "lane 1 of 2, from the left"), "{seen:?}");
    let plain = story(&text.replace(", waiting to make an unprotected left turn at", " at"));
    assert!(made(&plain).verdict.checks.iter().all(|check| check.kind != CheckKind::SvLane));
}

#[test]
fn an_ego_that_goes_round_a_stopped_truck_leaves_its_lane_and_who_comes_towards_it_does_not() {
    let text = "The AV was traveling north on Elm Street and approached a garbage truck that was stopped in its lane. The AV moved partly \
                into the oncoming lane to pass the garbage truck. A van came from the other direction in its own lane, and the left side of \
                the AV made contact with the left side of the van.";
    let shown = made(&story(text));
    let ego = shown.rollout.ego_track();
    let aside_m = ego.states[before_contact(&shown)].y - ego.states[0].y;
    assert!(aside_m > 1.0, "{aside_m} m");
    assert!((left_before(&shown, 0.0) - left_before(&shown, 6.0)).abs() < 0.7);
    let truck = shown.rollout.actors.iter().find(|track| track.id == "obstacle").expect("a truck");
    let lane_m = truck.states[0].y - ego.states[0].y;
    assert!(lane_m.abs() < 1.7, "{lane_m} m beside the lane");
}

#[test]
fn who_drives_the_wrong_way_and_drifts_when_the_ego_has_stopped_was_on_that_side_before() {
    let text = "The AV was traveling north in the right lane of a divided road. A sedan was driving the wrong way, southbound, in the \
                northbound lanes. The AV moved to the right edge and stopped. The sedan drifted toward the curb and the front left of the \
                sedan made contact with the front left of the AV.";
    let shown = made(&story(text));
    let left_m = left_before(&shown, 8.0);
    assert!(left_m < 4.5, "{left_m} m to the left");
}

#[test]
fn who_had_come_over_when_the_ego_stopped_for_that_is_over_the_line_as_it_brakes() {
    let text = "The AV was traveling west on Elm Street. A truck traveling eastbound on Elm Street began maneuvering left into the path of the \
                AV and the AV came to a stop. The truck continued and the front left of the truck made contact with the front left of the AV.";
    let shown = made(&story(text));
    let slows = speeds(&shown).windows(2).position(|pair| pair[1] < pair[0] - 0.05).expect("it slows");
    let states = partner(&shown).0;
    assert!(states[0].y - states[slows].y > 0.8, "{} m over", states[0].y - states[slows].y);
}

#[test]
fn who_has_stopped_in_a_narrow_street_stands_along_it() {
    let text = "The AV was traveling north on a street with parked cars on both sides. An oncoming SUV stopped to let the AV through. The AV \
                proceeded and the left side of the AV made contact with the left side of the stopped SUV.";
    let shown = made(&story(text));
    assert_eq!(lanes(&shown), (1, 1));
    assert!(degrees_between(partner(&shown).1.heading, std::f64::consts::PI) < 3.0, "{:?}", partner(&shown).1);
}

#[test]
fn who_comes_towards_an_ego_on_a_highway_does_so_in_a_lane_of_its_own() {
    let text = "The AV was traveling north on a two-lane stretch of Highway 18. A truck traveling southbound crossed the center line and the left \
                side of the truck made contact with the left side of the AV.";
    let mut account = story(text);
    account.place.kind = Some(Fact::by_rule(PlaceKind::Highway, "ticked"));
    assert_eq!(lanes(&made(&account)), (1, 1));
}

#[test]
fn who_comes_in_the_bus_lane_towards_an_ego_that_turns_left_is_in_the_outer_lane() {
    let text = "The AV was making an unprotected left turn from southbound Elm Street onto Oak Street. A sedan traveling northbound on Elm Street \
                in the bus lane continued into the intersection and the front of the sedan made contact with the rear right of the AV.";
    let left_m = left_before(&made(&story(text)), 6.0);
    assert!(left_m > 5.0, "{left_m} m to the left");
}

#[test]
fn a_lane_with_a_number_is_counted_from_the_left() {
    let text = "The AV was stopped in traffic in the number two lane of Elm Street. A motorcycle passed the AV on the left and its right side \
                made contact with the left side of the AV.";
    let shown = made(&story(text));
    let seen = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::SvLane).expect("it is told");
    assert_eq!((seen.result, seen.observed.as_str()), (CheckResult::Shown, "lane 2 of 3, from the left"), "{seen:?}");
}

#[test]
fn who_is_fast_does_not_slow_for_the_end_of_its_way_before_it_touches() {
    let text = "The AV was traveling north in the left lane at 44 mph when a sedan approached from directly behind at a high rate of speed and \
                the front of the sedan made contact with the rear of the AV.";
    let shown = made(&story(text));
    let states = &partner(&shown).0[..=before_contact(&shown)];
    let fastest = states.iter().map(|state| state.speed()).fold(0.0, f64::max);
    let last = states[states.len() - 1];
    assert!(last.speed() > fastest - 0.1, "{} of {fastest} m/s", last.speed());
    assert!((last.y - states[0].y).abs() < 0.1, "{last:?}");
}

#[test]
fn who_squeezes_by_in_a_narrow_street_comes_along_one_line() {
    let text = "The AV was traveling north on a narrow portion of Elm Street when it slowed to a stop to yield to a van traveling southbound. As \
                the van proceeded straight to pass, the left side of the van made contact with the rear left of the AV.";
    let shown = made(&story(text));
    let aside_m = left_before(&shown, 8.0) - left_before(&shown, 2.0);
    assert!(aside_m.abs() < 0.1 && left_before(&shown, 8.0) < 3.0, "{aside_m} m");
}

#[test]
fn who_is_told_right_behind_and_by_a_column_to_change_lanes_leaves_the_lane_of_the_ego() {
    let text = "The AV was traveling north in the left lane and came to a stop for a scooter. A sedan traveling directly behind the AV made \
                contact with the rear right of the AV with its front left.";
    let mut account = story(text);
    let changes = |behind: bool| {
        let movement = recrash_model::template::Movement::ChangingLanes;
        let partner = account.partner.as_mut().expect("a partner");
        partner.movement = Some(Fact::of_column(movement, "CP Pre-Crash Movement"));
        if let (false, Some(from)) = (behind, account.came_from.as_mut()) {
            from.source = recrash_model::account::Source::Rule { name: "a picture".to_owned() };
        }
        left_before(&made(&account), 8.0).abs()
    };
    let [right_behind, elsewhere] = [true, false].map(changes);
    assert!(right_behind < 0.3 && elsewhere > 2.0, "{right_behind} and {elsewhere} m beside");
}
