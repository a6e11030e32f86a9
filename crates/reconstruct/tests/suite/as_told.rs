//! The two, and others, meet as who reads the report would draw it: from where, with which corner, and who moves how.

use crate::ways::{before_contact, made, partner, speeds, story};
use recrash_model::account::Fact;
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::{ActorState, ActorTrack};
use recrash_model::scenario::{MapSpec, RoadStart, StripKind};
use recrash_model::template::Movement;
use recrash_reconstruct::Reconstruction;

fn shown(text: &str) -> Reconstruction {
    made(&story(text))
}

fn track<'a>(made: &'a Reconstruction, id: &str) -> &'a ActorTrack {
    made.rollout.actors.iter().find(|track| track.id == id).unwrap_or_else(|| panic!("{id} is drawn"))
}

fn ego(made: &Reconstruction) -> &[ActorState] {
    &made.rollout.ego_track().states
}

/// Driving lanes of the ego's road that go its way.
fn lanes(made: &Reconstruction) -> usize {
    let MapSpec::G(map) = &made.draft.map else { panic!("a graph") };
    map.roads[0].right.iter().filter(|strip| strip.kind == StripKind::Driving).count()
}

/// How far the partner is beside the ego's line at first, to the left of it. [m]
fn beside_m(made: &Reconstruction, at: usize) -> f64 {
    partner(made).0[at].y - ego(made)[0].y
}

const CHANGES: &str = "The AV was traveling north in the right lane on Elm Street. The AV began a left lane change, and the front left of the \
                       AV made contact with the right side of a sedan that was traveling straight in the left lane.";

const PULLS_OUT: &str = "The AV was stopped behind a truck in the right lane on Elm Street. The AV began a left lane change, and the front left \
                         of the AV made contact with the right side of a sedan that was passing the AV in the left lane.";

#[test]
fn an_ego_that_changes_lanes_comes_with_its_corner_to_who_keeps_its_own() {
    for text in [CHANGES, PULLS_OUT] {
        let made = shown(text);
        let until = before_contact(&made);
        let aside = partner(&made).0[..=until]
            .iter()
            .map(|state| state.y)
            .fold((f64::MAX, f64::MIN), |(least, most), y| (least.min(y), most.max(y)));
        assert!(aside.1 - aside.0 < 0.5, "{aside:?}: {text}");
        assert!(ego(&made)[until].y - ego(&made)[0].y > 0.8, "it is to be seen: {text}");
    }
}

#[test]
fn who_is_told_to_have_struck_a_front_does_so_with_no_rear_corner() {
    let made = shown(
        "The AV was traveling north on Elm Street and entered the intersection with Oak Street on a green light. A bicyclist from the right \
         failed to stop for a red light and the bicyclist made contact with the front of the AV.",
    );
    let until = before_contact(&made);
    let beyond_m = beside_m(&made, until);
    assert!(beyond_m < 0.3, "its middle is {beyond_m} m beyond the ego's");
}

#[test]
fn who_changes_lanes_to_the_right_behind_the_ego_has_a_lane_there() {
    for text in [
        "The AV was stopped on Elm Street behind traffic. A sedan traveling behind the AV began to change lanes to the right, and the front left \
         of the sedan made contact with the rear right of the stationary AV.",
        "The AV was stopped in the right lane on Elm Street behind traffic. A sedan that was stopped behind the AV attempted to change lanes to \
         the right and the front of the sedan made contact with the rear of the stationary AV.",
    ] {
        let made = shown(text);
        let MapSpec::G(map) = &made.draft.map else { panic!("a graph") };
        let width_m: f64 =
            map.roads[0].right.iter().filter(|strip| strip.kind == StripKind::Driving).count() as f64 * 3.4;
        // The ego's road begins at the line between its directions.
        let RoadStart::At { y_m, .. } = map.roads[0].start else { panic!("a street") };
        let to_right_m = width_m - (y_m - ego(&made)[0].y);
        assert!(to_right_m > 4.0, "{to_right_m} m of {} lanes: {text}", lanes(&made));
    }
}

#[test]
fn an_ego_that_has_crossed_the_junction_is_met_behind_it() {
    let made = shown(
        "The AV was traveling south on Elm Street in the right lane of three lanes. After the AV crossed the intersection with Oak Street, a \
         sedan in the middle lane moved into the right lane, and the right side of the sedan made contact with the front left of the AV.",
    );
    let MapSpec::G(map) = &made.draft.map else { panic!("a graph") };
    let RoadStart::Arm { from_m, .. } = map.roads[0].start else { panic!("a junction") };
    let at = ego(&made)[before_contact(&made)];
    assert!(at.x > map.junctions[0].x_m + from_m, "{at:?}");
}

#[test]
fn who_parks_behind_an_ego_at_the_kerb_meets_it_from_the_strip() {
    let account = story(
        "The AV was parked at the curb on Elm Street. A pickup truck attempted to parallel park behind the AV, and the front of the pickup truck \
         made contact with the rear of the stationary AV.",
    );
    let made = made(&account);
    let beside_m = beside_m(&made, before_contact(&made));
    assert!(beside_m.abs() < 1.2, "{beside_m} m beside the ego");
}

#[test]
fn who_follows_through_the_same_turn_is_seen_turning() {
    let mut account = story(
        "The AV was making a left turn onto Oak Street when a sedan behind it made contact with the rear of the AV with its front.",
    );
    account.partner.as_mut().expect("a sedan").movement = Some(Fact::by_rule(Movement::LeftTurn, "ticked"));
    let made = made(&account);
    let states = partner(&made).0;
    let turned = states[before_contact(&made)].heading - states[0].heading;
    assert!(turned.to_degrees() > 15.0, "{} degrees", turned.to_degrees());
}

#[test]
fn whom_the_partner_struck_ahead_of_the_ego_is_ahead_of_it() {
    let account = story(
        "The AV was traveling north on Elm Street behind an SUV and entered the intersection with Oak Street on a green light. A sedan from the \
         right ran a red light and made contact with the SUV, and the front of the AV then made contact with the left side of the sedan.",
    );
    let made = made(&account);
    let thrown = made.verdict.checks.iter().find(|check| check.kind == CheckKind::PassedOn);
    assert_eq!(thrown.map(|check| check.result), Some(CheckResult::Shown));
    let (other, until) = (track(&made, "pusher"), before_contact(&made));
    for step in [0, until] {
        let (own, ahead) = (ego(&made)[step], other.states[step]);
        assert!(ahead.x > own.x + 2.0 && (ahead.y - own.y).abs() < 1.7, "{own:?}, {ahead:?}");
    }
}

#[test]
fn who_is_on_foot_walks_out_from_where_it_stood() {
    let made = shown(
        "The AV was stopped for a red light on Elm Street at Oak Street. A pedestrian was standing on the left. The light turned green and the \
         AV proceeded forward. The pedestrian stepped into the roadway and the AV came to a stop. The pedestrian walked into the left side of \
         the stationary AV.",
    );
    let until = before_contact(&made);
    let states = partner(&made).0;
    let fastest = states[..=until].iter().map(|state| state.velocity().length()).fold(0.0, f64::max);
    assert!(fastest < 1.6, "{fastest} m/s");
    let sets_off = states.iter().position(|state| state.velocity().length() > 0.1).expect("it walks");
    let stops = speeds(&made)[..until].iter().rposition(|mps| *mps > 0.1).expect("it drove");
    assert!(sets_off < stops, "walks at {sets_off}, stands at {stops}");
}

#[test]
fn an_animal_that_the_ego_stops_for_comes_out_behind_who_is_parked_there() {
    let made = shown(
        "The AV was traveling east on Elm Street when it slowed to a stop for a dog that ran into the roadway from in front of a parked car on \
         the right side. A sedan approached from behind and the front of the sedan made contact with the rear of the stationary AV.",
    );
    let (dog, car) = (track(&made, "animal"), track(&made, "kerb"));
    let short_m = dog.states[0].x - car.states[0].x - 0.5 * car.length_m;
    assert!((0.0..3.0).contains(&short_m), "{short_m} m");
}

#[test]
fn who_is_double_parked_stands_in_a_lane() {
    let made = shown(
        "The AV was traveling in the left lane on Elm Street. A delivery truck was double parked in the right lane. A minivan behind the AV in \
         the right lane merged into the left lane and the front left of the minivan made contact with the rear right of the AV.",
    );
    assert!(made.rollout.actors.iter().all(|track| track.id != "kerb"), "nobody stands at the kerb");
}

#[test]
fn a_partner_that_backs_across_a_street_has_no_crossing_road() {
    let made = shown(
        "The AV was traveling south on Elm Street past a truck parked at the curb on the right when a forklift on the left, which was facing the \
         east side of the road, began to reverse and the rear of the forklift made contact with the left side of the AV.",
    );
    let MapSpec::G(map) = &made.draft.map else { panic!("a graph") };
    assert!(map.junctions.is_empty());
}

#[test]
fn a_gate_that_opens_lay_across_the_way() {
    let text = |deed: &str| {
        format!(
            "The AV was traveling north when it stopped for a gate and began proceeding slowly forward. The gate began {deed} and made contact \
             with the front of the AV."
        )
    };
    let arm_turned = |text: &str| {
        let made = shown(text);
        let arm = track(&made, "cp.arm").states[0];
        recrash_model::math::sin(arm.heading).abs()
    };
    assert!(arm_turned(&text("swinging open into the roadway")) > 0.9, "across it");
    assert!(arm_turned(&text("closing")) < 0.1, "along it");
}
