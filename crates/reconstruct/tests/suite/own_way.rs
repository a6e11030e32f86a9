//! Who is not told to have been elsewhere comes along its own lane, by its own turn, with its own end first; and others beside the ego have a
//! lane there.

use crate::others::track;
use crate::ways::{before_contact, degrees_between, made, partner, story};
use recrash_model::account::{Account, Fact, LeftRight};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;
use recrash_reconstruct::Reconstruction;

/// How far to the left of the ego the partner is at a step, seen along the road. [m]
fn left_m(made: &Reconstruction, step: usize) -> f64 {
    partner(made).0[step].y - made.rollout.ego_track().states[step].y
}

/// By how much the partner has turned until the contact, to the left. [deg]
fn turned_deg(made: &Reconstruction) -> f64 {
    let states = partner(made).0;
    let turned = states[before_contact(made)].heading - states[0].heading;
    recrash_model::math::wrap_angle(turned).to_degrees()
}

fn shows(made: &Reconstruction, kind: CheckKind) -> bool {
    made.verdict.checks.iter().any(|check| check.kind == kind && check.result == CheckResult::Shown)
}

#[test]
fn who_merges_behind_the_ego_comes_from_a_side_that_has_a_lane() {
    let made = made(&story(
        "The AV was traveling north in the right lane of Elm Street and slowed for traffic. A sedan merged into the lane behind the AV and \
         the front of the sedan made contact with the rear of the AV.",
    ));
    assert!(left_m(&made, 0) > 2.5, "{} m", left_m(&made, 0));
}

#[test]
fn who_backs_towards_the_ego_from_behind_does_so_with_its_rear() {
    let made = made(&story(
        "The AV was reversing out of a parking stall. A van behind the AV was also reversing, and the rear of the van made contact with the \
         rear of the AV.",
    ));
    let (ego, van) = (&made.rollout.ego_track().states[0], &partner(&made).0[0]);
    assert!(degrees_between(van.heading, ego.heading) > 140.0, "{van:?}");
    assert!(van.x < ego.x - 4.0, "{van:?} {ego:?}");
}

#[test]
fn who_runs_into_the_outer_corner_of_an_ego_in_its_turn_turns_with_it() {
    let made = made(&story(
        "The AV was making a right turn onto Oak Street. A sedan behind the AV was also making a right turn, and the front of the sedan made \
         contact with the rear left corner of the AV.",
    ));
    assert!(turned_deg(&made) < -15.0, "{} degrees", turned_deg(&made));
}

#[test]
fn who_changes_lanes_by_a_column_alone_has_come_to_the_line() {
    let mut account = story(
        "The AV was traveling north on Elm Street and slowed for traffic. A sedan approached from behind and made contact with the rear left \
         corner of the AV.",
    );
    account.partner.as_mut().expect("a partner").movement = Some(Fact::by_rule(Movement::ChangingLanes, "ticked"));
    let made = made(&account);
    let moved_m = left_m(&made, before_contact(&made)) - left_m(&made, 0);
    assert!(moved_m.abs() > 1.4, "{moved_m} m");
}

#[test]
fn who_drives_beside_the_ego_on_the_right_has_a_lane_there() {
    let made = made(&story(
        "The AV was traveling north on Elm Street and slowed for a van that was traveling in the right adjacent lane. A sedan approached \
         from behind and the front of the sedan made contact with the rear of the AV.",
    ));
    let (van, last) = (track(&made, "abreast"), before_contact(&made));
    let aside_m = made.rollout.ego_track().states[last].y - van.states[last].y;
    assert!((2.0..4.0).contains(&aside_m), "{aside_m} m");
    assert!(shows(&made, CheckKind::Others));
}

#[test]
fn who_encroaches_from_beside_comes_towards_the_ego() {
    let slows = "The AV was traveling north in the right lane on Elm Street. An SUV in the left adjacent lane drifted into the AV's lane and the AV slowed. A sedan approached \
                 from behind and the front of the sedan made contact with the rear of the AV.";
    // Where the ego slows for it, it comes into the lane.
    for (text, id) in [(slows.to_owned(), "merger"), (slows.replace(" and the AV slowed", ""), "near")] {
        let made = made(&story(&text));
        let (suv, last) = (track(&made, id), before_contact(&made));
        assert!(suv.states[0].y > made.rollout.ego_track().states[0].y, "on the left");
        assert!(suv.states[last].y < suv.states[0].y - 0.6, "{:?}", suv.states[last]);
    }
}

#[test]
fn who_goes_round_one_that_stands_ahead_leaves_its_line() {
    let made = made(&story(
        "The AV was traveling north on Elm Street and was maneuvering around a truck that was stopped ahead of it, when the front right of the AV made \
         contact with the rear left of the truck.",
    ));
    let ego = &made.rollout.ego_track().states;
    let aside_m = ego[before_contact(&made)].y - ego[0].y;
    assert!(aside_m > 0.5, "{aside_m} m");
}

#[test]
fn who_rolls_back_from_ahead_does_so_in_line_where_no_zone_of_it_is_told() {
    let made = made(&story(
        "The AV was stopped on Elm Street behind a sedan. The sedan reversed and made contact with the front of the stationary AV.",
    ));
    assert!(left_m(&made, 0).abs() < 1.0, "{} m", left_m(&made, 0));
    assert!(turned_deg(&made).abs() < 5.0);
}

#[test]
fn who_enters_from_a_crossing_road_by_a_column_crosses_straight() {
    let mut account = story(
        "The AV was traveling north through the intersection of Elm Street and Oak Street. A sedan traveling west on Oak Street ran a red \
         light and the front of the sedan made contact with the right side of the AV.",
    );
    account.partner.as_mut().expect("a partner").movement = Some(Fact::by_rule(Movement::EnteringTraffic, "ticked"));
    let made = made(&account);
    assert!(turned_deg(&made).abs() < 9.0, "{} degrees", turned_deg(&made));
}

#[test]
fn all_of_an_end_that_is_ticked_is_touched_in_the_middle() {
    let mut account = story(
        "The AV was traveling north on Elm Street and slowed for traffic. A sedan approached from behind and made contact with the rear of \
         the AV.",
    );
    let ticked = [ContactZone::RearLeft, ContactZone::Rear, ContactZone::RearRight];
    account.sv.zones = ticked.map(|zone| Fact::by_rule(zone, "ticked")).to_vec();
    let made = made(&account);
    let last = before_contact(&made);
    assert!(left_m(&made, last).abs() < 0.9, "{} m", left_m(&made, last));
}

#[test]
fn who_passes_on_a_bicycle_comes_by_beside_the_ego() {
    let made = made(&story(
        "The AV was slowing on Elm Street. A cyclist passed the AV on the left, and the front of the bicycle made contact with the rear left of \
         the AV.",
    ));
    let last = before_contact(&made);
    assert!(left_m(&made, last) > 0.9, "{} m", left_m(&made, last));
}

/// Lanes in the ego's direction to one side of it.
fn lanes_beside(made: &Reconstruction, side: LeftRight) -> usize {
    let recrash_model::scenario::MapSpec::G(map) = &made.draft.map else { panic!("a graph") };
    let driving = |strip: &&recrash_model::scenario::Strip| strip.kind == recrash_model::scenario::StripKind::Driving;
    let road = &map.roads[0];
    let lanes = road.right.iter().filter(driving).count().max(road.left.iter().filter(driving).count());
    let own = made.draft.ego.lane as usize;
    if side == LeftRight::Left { own } else { lanes - own - 1 }
}

#[test]
fn who_changes_lanes_beyond_the_ego_s_outermost_lane_has_one_more_there() {
    let right = made(&story(
        "The AV was traveling in the right lane. A bus to the right of the AV changed lanes to the left, and the left side of the bus made \
         contact with the right side of the AV.",
    ));
    assert!(lanes_beside(&right, LeftRight::Right) >= 1);
    let left = made(&story(
        "The AV was stopped in the left lane. A sedan behind the AV changed lanes to the left, and the front right of the sedan made contact \
         with the rear left of the AV.",
    ));
    assert!(lanes_beside(&left, LeftRight::Left) >= 1);
}

fn slowed_again(text: &str) -> Account {
    let account = story(text);
    assert_eq!(account.others.len(), 1, "{:?}", account.others);
    account
}

#[test]
fn for_whom_the_ego_slows_after_it_set_off_it_slows_then() {
    let made = made(&slowed_again(
        "The AV was stopped at a stop sign on Elm Street. The AV began to move forward, then slowed down for a pedestrian who was crossing. A sedan \
         approached from behind and the front of the sedan made contact with the rear of the AV.",
    ));
    let (walker, last) = (track(&made, "walker"), before_contact(&made));
    let ego = made.rollout.ego_track();
    let met = (last - 30..=last).any(|step| {
        let (a, b) = (walker.states[step - 1].y - ego.states[step].y, walker.states[step].y - ego.states[step].y);
        a * b <= 0.0 && walker.states[step].x > ego.states[step].x
    });
    assert!(met, "{:?}", walker.states[last]);
}

#[test]
fn who_sets_off_at_the_kerb_into_one_that_is_parked_ahead_was_beside_the_lanes() {
    let made = made(&story(
        "The AV was parked at the curb on Elm Street when the driver accelerated and the front of the AV made contact with the rear of a sedan that was \
         parked ahead of it.",
    ));
    assert!(made.rollout.ego_track().states[0].y < -1.5, "{:?}", made.rollout.ego_track().states[0]);
}

#[test]
fn who_passes_an_ego_that_has_yet_to_turn_comes_by_beside_it() {
    let mut account = story(
        "The AV was traveling north in the right lane of Elm Street and was slowing. A sedan passed the AV on the left and the front right of \
         the sedan made contact with the front left of the AV.",
    );
    account.sv.movement = Some(Fact::of_column(Movement::RightTurn, "SV Pre-Crash Movement"));
    let made = made(&account);
    assert!(made.missed().is_none(), "{:?}", made.missed());
    let movement = made.verdict.checks.iter().find(|check| check.kind == CheckKind::SvMovement);
    assert_eq!(movement.map(|check| check.expected.as_str()), Some("right turn, or yet to begin"));
}

const TURNS_ACROSS: &str = "The AV was traveling north in the right lane and approaching the intersection with Oak Street. A truck traveling north in the \
                            left lane began to turn right onto Oak Street, and the front right of the truck made contact with the left side \
                            of the AV.";

const COMES_UP: &str = "The AV was traveling north in the right lane and slowing. A motorcycle approached the AV from behind and the front of the \
                        motorcycle made contact with the rear left of the AV.";

#[test]
fn an_ego_of_which_a_column_alone_tells_a_turn_has_yet_to_begin_it_while_it_comes_along() {
    for text in [TURNS_ACROSS, COMES_UP] {
        let mut account = story(text);
        account.sv.movement = Some(Fact::of_column(Movement::RightTurn, "SV Pre-Crash Movement"));
        let made = made(&account);
        let met = made.rollout.ego_track().states[before_contact(&made)];
        assert!(met.heading.abs() < 0.1, "{text}: {met:?}");
    }
    // Told in words it is met in the turn.
    let turning = TURNS_ACROSS.replace("approaching the intersection with", "turning right onto");
    let mut account = story(&turning);
    account.sv.movement = Some(Fact::of_column(Movement::RightTurn, "SV Pre-Crash Movement"));
    let made = made(&account);
    assert!(made.rollout.ego_track().states[before_contact(&made)].heading < -0.3);
}

#[test]
fn an_ego_whose_turn_a_column_tells_is_met_in_it_beside_where_no_words_tell_a_way_to_it() {
    let mut account = story(
        "The AV was traveling north. A sedan approaching from behind attempted to pass on the left and struck the left side of the AV.",
    );
    account.sv.movement = Some(Fact::of_column(Movement::LeftTurn, "SV Pre-Crash Movement"));
    let made = made(&account);
    let movement = made.verdict.checks.iter().find(|check| check.kind == CheckKind::SvMovement);
    assert_eq!(movement.map(|check| check.expected.as_str()), Some("left turn"));
    let met = made.rollout.ego_track().states[before_contact(&made)];
    assert!(met.heading > 0.3, "{met:?}");
}

#[test]
fn an_ego_that_left_off_its_turn_to_stop_stands_in_it() {
    let made = made(&story(
        "The AV began to enter the intersection to turn right onto Oak Street, but stopped before completing the turn to yield to a pedestrian. A \
         pickup behind the AV made contact with the rear of the AV.",
    ));
    let ego = &made.rollout.ego_track().states[..=before_contact(&made)];
    assert!(ego[ego.len() - 1].heading < -0.2, "{:?}", ego[ego.len() - 1]);
}

#[test]
fn who_comes_from_the_side_of_an_ego_that_drove_on_after_its_turn_does_so_from_that_side() {
    let mut account = story(
        "The AV was traveling on Elm Street, completed a right turn onto Oak Street and proceeded straight through the intersection with Main Street. \
         A scooter traveling on Main Street came from the right and the front of the scooter made contact with the right side of the AV.",
    );
    account.sv.movement = Some(Fact::by_rule(Movement::Straight, "made for this test"));
    account.came_from =
        Some(Fact::by_rule(recrash_model::account::Origin::Cross { side: LeftRight::Right }, "made for this test"));
    let made = made(&account);
    let (states, met) = partner(&made);
    let ego = made.rollout.ego_track().states[before_contact(&made)];
    let right = recrash_model::geometry::Vec2::from_heading(ego.heading).left() * -1.0;
    assert!(right.dot(states[0].position() - met.position()) > 5.0, "{:?}", states[0]);
}
