//! In which lanes the two are drawn, and who is abreast of whom.

use crate::common::account_of;
use crate::ways::{before_contact, degrees_between, made, partner, speeds, story};
use recrash_model::account::{Fact, LaneWord, LeftRight, Origin, Speed, SpeedMeaning, Untold};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::ActorState;
use recrash_model::scenario::{MapSpec, StripKind};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;
use recrash_reconstruct::{Reconstruction, held_against, off_lane_s, reconstruct};

/// Lanes of the ego's first road: those that go its way, and those that come towards it.
pub(crate) fn lanes(made: &Reconstruction) -> (usize, usize) {
    let MapSpec::G(map) = &made.draft.map else { panic!("a graph") };
    let driving = |strips: &[recrash_model::scenario::Strip]| {
        strips.iter().filter(|strip| strip.kind == StripKind::Driving).count()
    };
    (driving(&map.roads[0].right), driving(&map.roads[0].left))
}

#[test]
fn who_comes_towards_a_stopped_ego_and_scrapes_by_does_so_on_a_narrow_street_and_almost_along_it() {
    let text = "The AV was traveling north on Elm Street when it came to a stop to yield to a van traveling southbound. As the van passed \
                the stationary AV, the left side of the van made contact with the left side of the AV.";
    let made = made(&story(text));
    assert_eq!(lanes(&made), (1, 1));
    let states = partner(&made).0;
    assert!(states.iter().all(|state| degrees_between(state.heading, std::f64::consts::PI) < 6.0), "{states:?}");
}

#[test]
fn who_swerves_over_from_beside_an_ego_that_changes_lanes_comes_along_a_lane_of_its_own_direction() {
    let text = "The AV was completing a lane change to the left when a sedan beside it swerved into that lane from the left, and the right \
                side of the sedan made contact with the front left of the AV.";
    let made = made(&story(text));
    let side = partner(&made).0[0].y - made.rollout.ego_track().states[0].y;
    assert!(lanes(&made).0 >= 3 || side < 5.0, "{:?} lanes, {side} m aside", lanes(&made));
}

#[test]
fn who_merges_in_front_of_an_ego_that_stops_for_it_was_abreast_when_that_slowed() {
    let text = "The AV was traveling west in the center lane. A box truck in the left lane slowed and began to merge into the center lane. \
                The AV slowed and came to a stop, yielding to the box truck. While the AV remained stopped, the box truck continued \
                merging and the right side of the box truck made contact with the front left of the AV.";
    let made = made(&story(text));
    let ego = &made.rollout.ego_track().states;
    let slows = speeds(&made).windows(2).position(|pair| pair[1] < pair[0] - 0.05).expect("it slows");
    let behind_m = ego[slows].x - partner(&made).0[slows].x;
    assert!(behind_m.abs() < 9.0, "{behind_m} m behind");
}

#[test]
fn who_was_backing_when_the_ego_stopped_for_it_backs_before_that_slows() {
    let text = "The AV was traveling south when it slowed to a stop to yield to a heavy truck that was reversing. While the AV was stopped, \
                the heavy truck continued to reverse and the rear of the heavy truck made contact with the front of the AV.";
    let made = made(&story(text));
    let until = before_contact(&made);
    let slows = speeds(&made).windows(2).take(until).position(|pair| pair[1] < pair[0] - 0.05).expect("it slows");
    let backs = partner(&made).0.iter().position(|state| state.speed() < -0.1).expect("it backs");
    assert!(backs <= slows, "backs at {backs}, slows at {slows}");
}

#[test]
fn what_touches_only_the_roof_cannot_be_shown() {
    let mut account =
        account_of("The AV was turning into a covered stall when it made contact with the edge of a wall.")
            .expect("a story");
    account.sv.zones = vec![Fact::by_rule(ContactZone::Top, "ticked")];
    assert_eq!(reconstruct(&account).err(), Some(Untold::FromAbove));
}

#[test]
fn an_ego_that_hardly_moves_came_up_to_who_was_ahead_beside_it() {
    let text = "The AV was traveling north when it approached a street sweeper along the right curb. As the AV began to maneuver left \
                around it, the street sweeper veered left into the lane and its front left made contact with the rear right of the \
                AV. The AV was traveling at 1 mph.";
    let made = made(&story(text));
    let (ego, sweeper) = (&made.rollout.ego_track().states[0], &partner(&made).0[0]);
    assert!(sweeper.x > ego.x + 3.0, "{} m ahead", sweeper.x - ego.x);
}

#[test]
fn who_touches_beside_its_lane_comes_along_the_middle_of_that_until_late() {
    for text in [
        "The AV was stopped on Elm Street. A sedan behind the AV failed to stop and the front left of the sedan made contact with the rear \
         right of the AV.",
        "The AV was traveling north. A truck in the left lane drifted to the right and the right side of the truck made contact with the \
         left side of the AV.",
        "The AV was traveling north through the intersection. A van from the left ran a red light and the front of the van made contact \
         with the left side of the AV.",
    ] {
        let account = story(text);
        assert_eq!(off_lane_s(&account, &made(&account)), Some(0.0), "{text}");
    }
}

#[test]
fn who_turns_across_begins_its_turn_in_the_middle_of_a_lane_of_its_direction() {
    let account = story(
        "The AV was traveling north straight through the intersection. An oncoming sedan made a left turn and the front of the sedan made \
         contact with the front left of the AV.",
    );
    let shown = made(&account);
    let MapSpec::G(map) = &shown.draft.map else { panic!("a graph") };
    assert_eq!(off_lane_s(&account, &shown), Some(0.0), "{:?}", map.roads[0]);
    let states = partner(&shown).0;
    assert!(degrees_between(states[0].heading, std::f64::consts::PI) < 1.0 && states[0].y > 3.0, "{:?}", states[0]);
}

#[test]
fn who_turned_off_before_it_backs_came_along_its_own_side() {
    let account = story(
        "The AV was traveling northbound when a pickup truck traveling southbound turned left in front of the AV and came to a stop. The \
         pickup truck then reversed and its rear made contact with the left side of the AV.",
    );
    let shown = made(&account);
    let first = partner(&shown).0[0];
    let side_m = first.y - shown.rollout.ego_track().states[0].y;
    assert!(degrees_between(first.heading, std::f64::consts::PI) > 90.0 || side_m > 3.0, "{first:?}");
}

/// How far ahead of the ego the partner is when the scene begins, and how far to its left. [m]
fn begins(made: &Reconstruction) -> (f64, f64) {
    let (ego, other) = (&made.rollout.ego_track().states[0], &partner(made).0[0]);
    (other.x - ego.x, other.y - ego.y)
}

#[test]
fn who_stood_behind_an_ego_and_goes_round_it_begins_on_its_line_and_pulls_out_to_the_told_side() {
    let text = "The AV was stopped in a queue of traffic at a red light on Elm Street. A sedan that was stopped directly behind the AV began to \
                pass the AV on the left, and the front right of the sedan made contact with the rear left of the stationary AV.";
    let shown = made(&story(text));
    let (ahead_m, left_m) = begins(&shown);
    assert!(ahead_m < -3.0 && left_m.abs() < 1.0, "{ahead_m} m ahead, {left_m} m to the left");
    let (states, met) = partner(&shown);
    assert!(met.y > states[0].y + 0.5, "{met:?}");
}

#[test]
fn who_comes_from_beside_does_so_along_the_next_lane_or_the_told_one() {
    let text = "The AV was traveling north in the rightmost lane of Elm Street. A van traveling in the second lane from the right made a right \
                turn into a garage, and the front right of the van made contact with the left side of the AV.";
    let shown = made(&story(text));
    let (_, left_m) = begins(&shown);
    assert!((2.4..4.4).contains(&left_m), "{left_m} m to the left");
}

#[test]
fn two_that_turn_side_by_side_come_along_two_lanes_of_their_direction() {
    let text = "The AV was in the right of two left turn lanes at the intersection of Elm Street and Oak Street and made a left turn. A sedan in \
                the left turn lane to the left of the AV also made a left turn and drifted to its right, and the front right of the sedan made \
                contact with the left side of the AV.";
    let mut account = story(text);
    let lane = |lane| Some(Fact::by_rule(lane, "lanes"));
    account.sv.lane = lane(LaneWord::LeftTurn);
    account.partner.as_mut().expect("a partner").lane = lane(LaneWord::LeftTurn);
    account.came_from = Some(Fact::by_rule(Origin::Beside { side: LeftRight::Left }, "beside"));
    let shown = made(&account);
    let (_, left_m) = begins(&shown);
    assert!((2.6..4.2).contains(&left_m), "{left_m} m to the left");
}

/// The lane of its direction in which the partner begins, and how many there are; 0 is the leftmost. Of who comes towards the ego, which is
/// in the rightmost lane.
fn oncoming_lane(made: &Reconstruction) -> (usize, usize) {
    let (own, oncoming) = lanes(made);
    (((begins(made).1 / 3.4).round() as usize).checked_sub(own).expect("its own side"), oncoming)
}

#[test]
fn who_turns_left_out_of_the_opposite_direction_does_so_out_of_the_lane_beside_the_middle() {
    let texts = [
        "The AV was traveling north straight through the intersection. An oncoming sedan made a left turn and the front left of the sedan \
         made contact with the rear left of the AV.",
        "The AV was stopped in the intersection of Elm Street and Oak Street. A van traveling in the opposite direction began to turn left, \
         and the left side of the van made contact with the rear left of the AV.",
        "As the AV was driving north through the junction, a pickup from the opposite direction turned left across its path and struck the \
         left side of the AV with its front.",
    ];
    for text in texts {
        let shown = made(&story(text));
        assert_eq!(oncoming_lane(&shown), (0, 2), "{text}");
    }
}

#[test]
fn who_turns_left_out_of_a_told_lane_does_so_out_of_that() {
    let mut account = story(
        "The AV was traveling north straight through the intersection. An oncoming sedan made a left turn and the front left of the sedan \
         made contact with the rear left of the AV.",
    );
    account.partner.as_mut().expect("a partner").lane = Some(Fact::by_rule(LaneWord::Right, "the lane"));
    assert_eq!(oncoming_lane(&made(&account)), (1, 2));
}

#[test]
fn who_turns_off_out_of_a_lane_beside_the_ego_has_not_come_along_the_other_side() {
    for text in [
        "The AV was traveling south in the right lane of Elm Street. A sedan on the left of the AV changed lanes and made a right turn across \
         the right lane into a garage, and the front right of the sedan made contact with the rear left of the AV.",
        "The AV was in the rightmost lane of Pine Road when a van beside it on the left changed lanes, then began to turn right towards a \
         filling station, and the right side of the van made contact with the front left of the AV.",
    ] {
        let shown = made(&story(text));
        let own = lanes(&shown).0 as f64;
        let states = &partner(&shown).0[..before_contact(&shown)];
        let left_m = states.iter().map(|state| state.y - shown.rollout.ego_track().states[0].y).fold(0.0, f64::max);
        assert!(left_m < 3.4 * (own - 0.5), "{left_m} m to the left, {own} lanes: {text}");
    }
}

#[test]
fn who_creeps_into_an_ego_that_stands_came_to_a_stop_behind_it() {
    let text = "The AV was stopped in a queue of traffic on Elm Street. A sedan behind the AV accelerated and the front of the sedan made contact \
                with the rear of the stationary AV.";
    let mut account = story(text);
    let speed = Speed { mps: 2.0, meaning: SpeedMeaning::Impact };
    account.partner.as_mut().expect("a partner").speeds = vec![Fact::by_rule(speed, "told")];
    let shown = made(&account);
    let (ahead_m, left_m) = begins(&shown);
    assert!(ahead_m < -5.0 && left_m.abs() < 1.0, "{ahead_m} m ahead, {left_m} m to the left");
    assert!(partner(&shown).0.iter().any(|state| state.speed() < 0.1), "it stands");
}

#[test]
fn a_told_lane_counts_only_along_its_direction_and_in_the_middle_of_it() {
    let text = "The AV was traveling north in the right lane. A sedan in the left lane changed lanes to the right and the front right of the sedan \
                made contact with the left side of the AV.";
    let account = story(text);
    let shown = made(&account);
    let lane = |change: &dyn Fn(&mut ActorState)| {
        let mut rollout = shown.rollout.clone();
        let track = rollout.actors.iter_mut().find(|track| track.id == "cp").expect("a partner");
        change(&mut track.states[0]);
        let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
        let verdict = held_against(&account, &scenario, &rollout).expect("it can be held");
        verdict.checks.into_iter().find(|check| check.kind == CheckKind::CpLane).map(|check| check.result)
    };
    assert_eq!(lane(&|_| {}), Some(CheckResult::Shown));
    assert_eq!(lane(&|state| state.y += 0.9), Some(CheckResult::NotShown));
    assert_eq!(lane(&|state| state.heading += std::f64::consts::PI), Some(CheckResult::NotShown));
}

#[test]
fn who_backs_in_line_stays_along_the_road() {
    let text = "The AV was stopped behind a sedan at a red light on Elm Street. The sedan directly in front of the AV rolled backwards and the rear \
                of the sedan made contact with the front of the stationary AV.";
    let shown = made(&story(text));
    let states = partner(&shown).0;
    assert!(states.iter().all(|state| degrees_between(state.heading, 0.0) < 5.2), "{states:?}");
}

#[test]
fn who_pulls_out_from_the_far_kerb_stood_there() {
    let text = "The AV was stopped on Elm Street. A van traveling in the opposite direction that was stopped at the curb pulled out into the \
                lane, crossed over, and the front left of the van made contact with the front left of the stationary AV.";
    let mut account = story(text);
    account.came_from = Some(Fact::by_rule(Origin::Opposite, "opposite"));
    account.partner.as_mut().expect("a partner").movement =
        Some(Fact::by_rule(Movement::EnteringTraffic, "pulled out"));
    let shown = made(&account);
    let (_, left_m) = begins(&shown);
    assert!(left_m > 5.1, "{left_m} m to the left");
}

#[test]
fn who_changes_lanes_from_a_stand_does_not_turn_across_the_road() {
    let text = "The AV was stopped behind a parked van. The AV began to change lanes to the left at 7 mph, and a sedan traveling in the left \
                lane made contact with the left side of the AV with its front right.";
    let made = made(&story(text));
    let states = &made.rollout.ego_track().states[..=before_contact(&made)];
    let most = states.iter().map(|state| degrees_between(state.heading, 0.0)).fold(0.0, f64::max);
    assert!(states[0].speed() < 0.1 || speeds(&made).iter().any(|speed| *speed < 0.1));
    assert!(most < 25.0, "{most} degrees");
}

#[test]
fn who_backs_to_an_ego_that_backs_away_does_so_in_its_lane() {
    let text = "The AV was stopped behind an SUV in its lane on Elm Street. The SUV began to reverse. The AV reversed at 3 mph away from the \
                SUV, and the rear of the SUV made contact with the front of the AV.";
    let made = made(&story(text));
    let states = &partner(&made).0[..=before_contact(&made)];
    let ego = made.rollout.ego_track().states[before_contact(&made)];
    assert!(states.iter().all(|state| (state.y - ego.y).abs() < 1.5), "{:?}", states[0]);
}
