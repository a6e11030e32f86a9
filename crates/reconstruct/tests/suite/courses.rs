//! Ways of the two that nobody would take for what is told: swings, speeds, order and place of what came before.

use crate::others::track;
use crate::ways::{before_contact, degrees_between, made, partner, speeds, story};
use recrash_model::account::{Act, EarlierTouch, Fact, LeftRight, Origin};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::metrics::CheckKind;
use recrash_model::rollout::{ActorState, EventKind};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;
use recrash_reconstruct::{Reconstruction, held_against};

/// The ego's states until it is touched.
fn ego(made: &Reconstruction) -> &[ActorState] {
    &made.rollout.ego_track().states[..=before_contact(made)]
}

/// The first step in which somebody stands.
fn stands(states: &[ActorState]) -> usize {
    states.iter().position(|state| state.speed().abs() < 0.05).expect("it comes to a stand")
}

#[test]
fn who_goes_straight_on_beside_an_ego_that_turns_does_not_turn_with_it() {
    let mut account = story(
        "The AV was traveling north in the center lane and began to turn left at the intersection with Oak Street. A sedan to the left of the AV \
         traveling north in the left lane continued straight, and the right side of the sedan made contact with the left side of the AV.",
    );
    account.partner.as_mut().expect("a partner").movement =
        Some(Fact::by_rule(Movement::Straight, "made for this test"));
    let shown = made(&account);
    let (states, _) = partner(&shown);
    let most_deg = states.iter().map(|state| degrees_between(state.heading, states[0].heading)).fold(0.0, f64::max);
    assert!(most_deg < 16.0, "{most_deg}");
}

#[test]
fn who_swings_out_and_back_has_not_driven_straight_on() {
    let mut account = story(
        "The AV was stopped in the right lane. A car approached from behind and the front of the car made contact with the rear of the \
         stationary AV.",
    );
    account.partner.as_mut().expect("a partner").movement =
        Some(Fact::by_rule(Movement::Straight, "made for this test"));
    let shown = made(&account);
    let mut rollout = shown.rollout.clone();
    let track = rollout.actors.iter_mut().find(|track| track.id == "cp").expect("a partner");
    let last = before_contact(&shown);
    for (step, state) in track.states[..last].iter_mut().enumerate() {
        // A degree a step to one side, and back.
        let by = (last - step).min(step).min(60) as f64;
        state.heading += by.to_radians();
    }
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let verdict = held_against(&account, &scenario, &rollout).expect("it can be held");
    assert!(verdict.failures().any(|check| check.kind == CheckKind::CpMovement), "{verdict:?}");
}

#[test]
fn who_comes_over_from_ahead_is_about_as_fast() {
    let shown = made(&story(
        "The AV was traveling at 45 mph in the left lane on a highway. A sedan ahead of the AV in the right lane swerved to the left into the \
         lane of the AV, and the left side of the sedan made contact with the front right of the AV.",
    ));
    let (own, met) = (ego(&shown)[before_contact(&shown)], partner(&shown).1);
    assert!((own.speed() - met.speed()).abs() < 3.0, "{} and {}", own.speed(), met.speed());
}

#[test]
fn an_ego_behind_whom_the_thrown_one_stopped_stood_before() {
    let shown = made(&story(
        "The AV came to a stop at a red light. An SUV behind the AV then came to a stop behind the AV. A van struck the rear of the SUV, and \
         the SUV was pushed into the rear of the stationary AV.",
    ));
    let (own, other) = (stands(ego(&shown)), stands(partner(&shown).0));
    assert!(own + 15 < other, "{own} and {other}");
}

const STRUCK_BESIDE: &str = "The AV was stopped in the right lane at a red light. A sedan that was stopped behind the AV changed lanes to the left. \
                             The front left of the sedan made contact with the right side of a van that was traveling in the left lane, and \
                             the front right of the sedan then made contact with the rear left of the stationary AV.";

#[test]
fn whom_the_partner_struck_first_is_abreast_of_it() {
    let account = story(STRUCK_BESIDE);
    let touch = account.others.iter().find_map(|other| other.touch.clone()).expect("it is told how");
    let told =
        EarlierTouch { by_partner: true, of_partner: Some(ContactZone::FrontLeft), of_other: Some(ContactZone::Right) };
    assert_eq!(touch.value, told);
    let shown = made(&account);
    let other = track(&shown, "pusher");
    let first = shown.rollout.events.iter().find(|event| matches!(event.kind, EventKind::Contact { .. }));
    let step = (first.expect("a contact").time_s * 10.0) as usize;
    let (met, beside) = (&partner(&shown).0[step], &other.states[step]);
    assert!(beside.x > met.x - 0.5 && beside.y > met.y + 1.0, "{beside:?} beside {met:?}");
}

#[test]
fn who_rolls_back_from_straight_ahead_is_in_line() {
    let mut account = story(
        "The AV was parked at the curb on Elm Street. A pickup truck parked in front of the AV reversed and the rear of the pickup truck made \
         contact with the front of the AV.",
    );
    // Columns add corners.
    let more = |zone| Fact::by_rule(zone, "made for this test");
    account.sv.zones.push(more(ContactZone::FrontLeft));
    account.partner.as_mut().expect("a partner").zones.push(more(ContactZone::RearRight));
    account.came_from = Some(Fact::by_rule(Origin::Ahead, "made for this test"));
    let shown = made(&account);
    let ((states, met), own) = (partner(&shown), ego(&shown)[0]);
    assert!((states[0].y - own.y).abs() < 0.5 && (met.y - own.y).abs() < 0.5, "{:?} to {met:?}", states[0]);
    // One that backs out of the next lane was not there.
    let mut rollout = shown.rollout.clone();
    let track = rollout.actors.iter_mut().find(|track| track.id == "cp").expect("a partner");
    for state in &mut track.states[..before_contact(&shown)] {
        state.y += 2.5;
    }
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let verdict = held_against(&account, &scenario, &rollout).expect("it can be held");
    assert!(verdict.failures().any(|check| check.kind == CheckKind::Approach), "{verdict:?}");
}

#[test]
fn who_merged_behind_an_ego_that_brakes_then_is_in_its_lane_by_then() {
    let mut account = story(
        "The AV was traveling north in the right lane. A car from behind merged into the lane behind the AV. The AV then slowed, and the front of \
         the car made contact with the rear of the AV.",
    );
    account.came_from = Some(Fact::by_rule(Origin::Behind, "made for this test"));
    account.partner.as_mut().expect("a partner").movement =
        Some(Fact::by_rule(Movement::Merging, "made for this test"));
    let shown = made(&account);
    let (own, (states, met)) = (ego(&shown), partner(&shown));
    let brakes = own.iter().position(|state| state.speed() < own[0].speed() - 0.1).expect("it brakes");
    assert!((states[0].y - met.y).abs() > 2.5, "out of the next lane: {:?}", states[0]);
    assert!((states[brakes].y - met.y).abs() < 1.7, "{:?} when the ego brakes", states[brakes]);
}

#[test]
fn whom_the_ego_passes_as_it_leaves_its_line_stands_in_that() {
    let shown = made(&story(
        "The AV was traveling eastbound when it approached a truck stopped in the lane. As the AV passed to the left of the stationary truck, a sedan \
         traveling westbound approached the AV, and the AV came to a stop to yield to the sedan. The front of the sedan made contact with the \
         front of the stationary AV.",
    ));
    let (truck, own) = (&track(&shown, "obstacle").states[0], ego(&shown));
    assert!((truck.y - own[0].y).abs() < 0.5 && truck.x > own[own.len() - 1].x, "{truck:?}");
}

#[test]
fn who_is_told_to_stand_in_a_lane_is_at_no_kerb() {
    let shown = made(&story(
        "The AV was traveling north on Elm Street. A bus was stopped in the lane on Elm Street. A van approached from behind and the front of the van \
         made contact with the rear of the AV.",
    ));
    let near = shown.rollout.actors.iter().find(|track| track.id.starts_with("near"));
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    if let Some(near) = near {
        let network = scenario.network();
        let state = near.states[0];
        let lane = network.lane_at(state.position(), state.heading).expect("on a lane");
        let part = network.road(network.lane(lane).road).part;
        assert!(!matches!(part, recrash_roads::RoadPart::Beside(_)), "{state:?}");
    }
}

#[test]
fn an_ego_that_leaves_a_space_stood_in_it() {
    let mut account = story(
        "The AV was exiting a parking space on the right side of Elm Street when a van changed lanes to the right and the front right of the van made contact \
         with the front left of the AV.",
    );
    assert!(account.sv.did(Act::PullOut), "{:?}", account.sv.acts);
    account.came_from = Some(Fact::by_rule(Origin::Beside { side: LeftRight::Left }, "made for this test"));
    let shown = made(&account);
    let speeds = speeds(&shown);
    assert!(speeds[0] == 0.0 && speeds.iter().any(|mps| *mps > 0.5), "{speeds:?}");
}

#[test]
fn who_crosses_a_lot_comes_from_among_the_stalls() {
    let mut account = story(
        "The AV was stopped in a parking lot. A car crossed behind the AV from the left, and the front left of the car made contact with the rear left of \
         the stationary AV.",
    );
    account.came_from = Some(Fact::by_rule(Origin::Cross { side: LeftRight::Left }, "made for this test"));
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert_eq!(states[0].speed(), 0.0);
    assert!((states[0].position() - met.position()).length() < 15.0, "{:?} to {met:?}", states[0]);
    assert!(Vec2::from_heading(states[0].heading).y.abs() > 0.9);
}

#[test]
fn who_is_to_turn_where_it_touches_a_standing_ego_has_begun_to() {
    let turned_deg = |zone: ContactZone| {
        let mut account = story(
            "The AV was stopped in the right lane. A sedan approached the AV from behind, and the front left of the sedan made contact with the rear \
             right of the AV.",
        );
        account.sv.zones = vec![Fact::by_rule(zone, "made for this test")];
        account.partner.as_mut().expect("a partner").movement =
            Some(Fact::by_rule(Movement::RightTurn, "made for this test"));
        let shown = made(&account);
        let (states, last) = partner(&shown);
        math::wrap_angle(states[0].heading - last.heading).to_degrees()
    };
    assert!(turned_deg(ContactZone::RearRight) > 5.0, "{}", turned_deg(ContactZone::RearRight));
    assert!(turned_deg(ContactZone::Rear).abs() < 5.0, "{}", turned_deg(ContactZone::Rear));
}

#[test]
fn an_ego_that_drove_straight_on_after_its_turn_has_turned_whoever_crosses_its_way() {
    let shown = made(&story(
        "The AV made a left turn at the intersection and was proceeding straight when a sedan coming from the right ran a red light and the \
         front of the sedan made contact with the right side of the AV.",
    ));
    assert!(shown.missed().is_none(), "{:?}", shown.missed());
    let turned_deg =
        math::wrap_angle(ego(&shown)[before_contact(&shown)].heading - ego(&shown)[0].heading).to_degrees();
    assert!(turned_deg > 50.0, "{turned_deg}");
    assert!(shown.verdict.checks.iter().any(|check| check.kind == CheckKind::SvActs), "{:?}", shown.verdict);
}
