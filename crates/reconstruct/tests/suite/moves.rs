//! Sides, sequence and bends of manoeuvres: where somebody passes, when it acts, and how hard it turns.

use crate::ways::{before_contact, degrees_between, made, partner, speeds, story};
use recrash_model::account::{Fact, Origin, PlaceKind, Speed, SpeedMeaning};
use recrash_model::math;
use recrash_model::rollout::{ActorState, STEP_S};
use recrash_model::template::Movement;
use recrash_reconstruct::Reconstruction;

/// When something is first so. [steps]
fn first(states: &[ActorState], is: impl Fn(&ActorState) -> bool) -> usize {
    states.iter().position(is).expect("it comes to be so")
}

fn ego(made: &Reconstruction) -> &[ActorState] {
    &made.rollout.ego_track().states[..=before_contact(made)]
}

#[test]
fn who_passes_one_that_stands_touches_it_from_beside() {
    let shown = made(&story(
        "The AV was stopped at a stop sign facing north. A car behind the AV passed the AV on the left, and the right side of \
         the car made contact with the left side of the stationary AV.",
    ));
    let ((states, met), ego) = (partner(&shown), ego(&shown)[0]);
    assert!((states[0].y - ego.y).abs() < 0.1, "it came along behind it");
    let last = shown.rollout.ego_track().states[before_contact(&shown)];
    assert!(last.x - met.x < 4.0 && met.y - last.y > 1.7, "{met:?} beside {last:?}");
}

#[test]
fn who_changes_lanes_to_pass_does_so_to_that_side() {
    let shown = made(&story(
        "The AV came to a stop in the right lane behind a van. The car behind the AV maneuvered into the left lane to pass both \
         vehicles. As the car passed the AV, the right side of the car made contact with the rear left corner of the AV.",
    ));
    let (states, met) = partner(&shown);
    assert!(states.iter().all(|state| state.y > -0.1) && met.y > 1.5, "{met:?}");
}

#[test]
fn who_comes_towards_the_ego_keeps_its_own_lane_until_late() {
    let shown = made(&story(
        "The AV was stopped facing north on Elm Street. A car traveling southbound on Elm Street proceeded forward, and the front of \
         the car made contact with the front of the stationary AV.",
    ));
    let (states, met) = partner(&shown);
    assert!(states[..50].iter().all(|state| state.y > 3.0) && met.y < 2.2, "{met:?}");
}

#[test]
fn an_ego_that_turns_across_stops_in_the_lane_of_who_comes() {
    let shown = made(&story(
        "The AV was traveling north and initiated a left turn at the intersection. The AV came to a stop before completing its turn due \
         to an oncoming sedan. The sedan continued straight through the intersection and the front of the sedan made \
         contact with the rear right of the AV.",
    ));
    let met = partner(&shown).1;
    let own_y_m = ego(&shown)[0].y;
    assert!(met.y - own_y_m > 1.7, "{met:?}");
}

const TURNS_ACROSS: &str = "The AV was traveling south in the leftmost lane. An SUV was traveling southbound ahead of and to the right of \
                            the AV in the center lane. The SUV initiated a left turn from the center lane, crossing into the AV's lane. \
                            The AV began braking and maneuvered to the left, and the front left of the SUV made contact with \
                            the right side of the AV.";

#[test]
fn who_turns_across_bends_no_harder_than_wheels_hold() {
    let shown = made(&story(TURNS_ACROSS));
    let (states, _) = partner(&shown);
    let sideways =
        |pair: &[ActorState]| math::wrap_angle(pair[1].heading - pair[0].heading).abs() / STEP_S * pair[0].speed();
    let most_mps2 = states.windows(2).map(sideways).fold(0.0, f64::max);
    assert!((2.0..=6.0).contains(&most_mps2), "{most_mps2}");
}

#[test]
fn who_brakes_for_a_turn_brakes_once_that_has_begun() {
    let shown = made(&story(TURNS_ACROSS));
    let (states, _) = partner(&shown);
    let turns = first(states, |state| (state.heading - states[0].heading).abs() > 0.02);
    let ego = ego(&shown);
    let brakes = first(ego, |state| state.speed() < ego[0].speed() - 0.1);
    assert!(brakes >= turns, "{brakes} and {turns}");
}

#[test]
fn who_backs_after_the_ego_has_set_off_does_so_then() {
    let shown = made(&story(
        "The AV was parked in a parking lot. A car passed the AV on the left, made a left turn, and came to a stop. While the car was \
         stopped, the AV proceeded forward. As the AV was passing behind the car, the car reversed, and the rear of the car made \
         contact with the left side of the AV.",
    ));
    let sets_off = speeds(&shown).iter().position(|speed| *speed > 0.1).expect("it sets off");
    let backs = first(partner(&shown).0, |state| state.speed() < -0.1);
    assert!(sets_off < backs, "{sets_off} and {backs}");
}

#[test]
fn who_backs_before_the_ego_stops_does_so_while_that_drives() {
    let shown = made(&story(
        "The AV was traveling north when a truck immediately ahead of the AV stopped and began to reverse. The AV came to a stop and the \
         rear of the truck made contact with the front of the AV.",
    ));
    let speeds = speeds(&shown);
    let backs = first(partner(&shown).0, |state| state.speed() < -0.1);
    assert!(speeds[backs] > 5.0, "{backs}: {speeds:?}");
}

#[test]
fn who_swerves_from_somebody_swerves_away() {
    let shown = made(&story(
        "The AV was traveling north. A truck from the right ran a red light and entered the intersection. The AV swerved and \
         the front of the truck made contact with the front right of the AV.",
    ));
    let ego = ego(&shown);
    assert!(ego[ego.len() - 1].y - ego[0].y > 0.5, "{:?}", ego[ego.len() - 1]);
}

#[test]
fn an_ego_that_changes_lanes_goes_to_the_told_side() {
    let mut account = story(
        "The AV was traveling in the rightmost lane and changed lanes to the right. A sedan behind the AV approached, and the front of the \
         sedan made contact with the rear of the AV.",
    );
    account.sv.movement = Some(Fact::by_rule(Movement::ChangingLanes, "made for this test"));
    let shown = made(&account);
    let ego = ego(&shown);
    assert!(ego[ego.len() - 1].y - ego[0].y < -0.8, "{:?}", ego[ego.len() - 1]);
}

#[test]
fn who_keeps_its_lane_behind_an_ego_that_leaves_it_comes_straight() {
    let mut account = story(
        "The AV was traveling in the rightmost lane and changed lanes to the right. A sedan behind the AV approached, and the front of the \
         sedan made contact with the rear of the AV.",
    );
    account.sv.movement = Some(Fact::by_rule(Movement::ChangingLanes, "made for this test"));
    let shown = made(&account);
    let ((states, met), ego) = (partner(&shown), ego(&shown));
    assert!(states.iter().all(|state| (state.y - met.y).abs() < 0.3 && (state.y - ego[0].y).abs() < 1.3), "{met:?}");
}

#[test]
fn who_backs_already_does_so_before_the_ego_moves_up() {
    let shown = made(&story(
        "The AV was traveling east when it slowed to a stop to yield to a truck that was reversing ahead of the AV. The AV proceeded \
         forward before coming to a stop. The truck continued to reverse and the rear of the truck made contact with the front of \
         the stationary AV.",
    ));
    let speeds = speeds(&shown);
    let backs = first(partner(&shown).0, |state| state.speed() < -0.1);
    let moves_up = speeds.windows(2).rposition(|pair| pair[0] == 0.0 && pair[1] > 0.0).expect("it moves up");
    assert!(backs < moves_up, "{backs} and {moves_up}");
}

#[test]
fn what_is_long_does_not_whip_round() {
    let shown = made(&story(
        "The AV was stopped facing east. A semi-trailer truck facing south was reversing from the right, and the rear left of the \
         semi-trailer truck made contact with the right side of the stationary AV.",
    ));
    let (states, _) = partner(&shown);
    let most_rad =
        states.windows(2).map(|pair| math::wrap_angle(pair[1].heading - pair[0].heading).abs()).fold(0.0, f64::max);
    assert!(most_rad / STEP_S < 0.4, "{most_rad}");
}

#[test]
fn who_set_off_and_brakes_in_the_junction_set_off_at_its_line() {
    let shown = made(&story(
        "The AV was stopped at a red light at an intersection. After the light turned green, the AV proceeded into the intersection. A car \
         from the right ran a red light, the AV braked, and the front of the car made contact with the front right of the AV.",
    ));
    let ego = ego(&shown);
    let most_mps = ego.iter().map(ActorState::speed).fold(0.0, f64::max);
    assert!(most_mps > ego[ego.len() - 1].speed() + 1.0, "it brakes");
    // The junction's arms begin 13 m from its middle, and the box is 4.5 m long.
    assert!(ego[0].x > -17.0, "{:?}", ego[0]);
}

#[test]
fn who_slows_for_a_stop_sign_and_is_hit_from_behind_has_not_stood_there() {
    let shown = made(&story(
        "The AV was traveling north with a sedan following behind. While the AV slowed as it approached a stop sign at the \
         intersection, the front of the sedan made contact with the rear of the AV.",
    ));
    let first = ego(&shown)[0].speed();
    assert!(first > 2.0, "it comes along: {first} m/s");
}

#[test]
fn who_drew_in_to_the_kerb_and_comes_out_again_was_there() {
    let mut account = story(
        "The AV was traveling behind an SUV on Elm Street. The SUV was traveling straight and pulled over to the right, and then it swerved to \
         its left, and the front left of the SUV made contact with the front right of the AV.",
    );
    account.partner.as_mut().expect("a partner").movement =
        Some(Fact::by_rule(Movement::EnteringTraffic, "made for this test"));
    let shown = made(&account);
    let (states, _) = partner(&shown);
    let states = &states[..=before_contact(&shown)];
    let least_m = states.iter().map(|state| state.y).fold(f64::MAX, f64::min);
    assert!(states[0].y.abs() < 0.5 && least_m < -1.7, "{} {least_m}", states[0].y);
    assert!(states.iter().all(|state| state.speed() > 1.0));
}

#[test]
fn who_follows_into_a_turn_does_not_swing_out_for_it() {
    let account = story(
        "The AV was making a right turn at the intersection with Elm Street and came to a stop. A sedan behind the AV was making a right turn as \
         well, and the front of the sedan made contact with the rear left of the AV.",
    );
    let shown = made(&account);
    let (states, _) = partner(&shown);
    let first = states[0].heading;
    let out_deg = states[..=before_contact(&shown)]
        .iter()
        .map(|state| math::wrap_angle(state.heading - first).to_degrees())
        .fold(0.0, f64::max);
    assert!(out_deg < 8.0, "{out_deg}");
}

#[test]
fn who_was_behind_as_the_light_turned_green_has_not_come_from_afar() {
    let mut account = story(
        "The AV was traveling on a highway on-ramp and slowed for a red light. The light turned green and the AV was proceeding forward. A sedan \
         traveling directly behind the AV proceeded forward, and the front of the sedan made contact with the rear of the AV.",
    );
    account.place.kind = Some(Fact::by_rule(PlaceKind::Highway, "made for this test"));
    account.sv.speeds = vec![Fact::by_rule(Speed { mps: 0.5, meaning: SpeedMeaning::Impact }, "made for this test")];
    let shown = made(&account);
    let (states, _) = partner(&shown);
    let most_mps = states[..=before_contact(&shown)].iter().map(|state| state.speed()).fold(0.0, f64::max);
    assert!(most_mps < 9.0, "{most_mps}");
}

#[test]
fn who_enters_from_a_crossing_street_comes_straight_along_it() {
    let account = story(
        "The AV was traveling north on Elm Street. A sedan ran the stop sign and pulled out of the street on the right, and the front of the sedan \
         made contact with the right side of the AV.",
    );
    assert!(
        matches!(account.came_from.as_ref().map(|fact| fact.value), Some(Origin::Cross { .. })),
        "{:?}",
        account.came_from
    );
    let shown = made(&account);
    let (states, _) = partner(&shown);
    let last = &states[before_contact(&shown)];
    assert!(degrees_between(last.heading, states[0].heading) < 16.0, "{} {}", last.heading, states[0].heading);
}

#[test]
fn who_is_seen_to_back_began_before_the_ego_slowed_for_it() {
    let mut account = story(
        "The AV was traveling north when it approached a truck ahead that was reversing. The AV slowed, and the truck continued reversing, and the \
         rear of the truck made contact with the front of the AV.",
    );
    account.sv.speeds = vec![Fact::by_rule(Speed { mps: 0.9, meaning: SpeedMeaning::Impact }, "made for this test")];
    account.order = None;
    let shown = made(&account);
    let (states, _) = partner(&shown);
    let backs = states.iter().position(|state| state.speed() < -0.05).expect("it backs");
    let own = ego(&shown);
    let slows = own.iter().position(|state| state.speed() < own[0].speed() - 0.3).expect("it slows");
    assert!(backs < slows, "{backs} {slows}");
}
