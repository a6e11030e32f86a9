//! Who turns as it touches: a rear corner that cuts in behind one that stands, or swings out.

use crate::ways::{before_contact, degrees_between, made, missed, partner, story};
use recrash_model::account::{Fact, Speed, SpeedMeaning};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::scenario::Place;
use recrash_model::zones::ContactZone;
use recrash_reconstruct::Reconstruction;

const CUTS_IN: &str = "The AV was stopped in its lane on Elm Street for a passenger pickup. A van traveling behind the AV passed the AV on \
                       the left, and the rear right corner of the van made contact with the rear left corner of the stationary AV.";

const ONCOMING: &str = "The AV was stopped on Elm Street as an oncoming van approached it. As the van passed the stopped AV, the rear left \
                        corner of the van made contact with the rear left corner of the AV.";

/// How far ahead of the ego's rear the partner's front is at the contact, seen the way the partner drives. [m]
fn front_beyond_m(made: &Reconstruction) -> f64 {
    let (ego, met) = (made.rollout.ego_track(), partner(made).1);
    let track = made.rollout.actors.iter().find(|track| track.id == "cp").expect("a partner");
    let at = ego.states[before_contact(made)];
    let rear = at.position() - Vec2::from_heading(at.heading) * (0.5 * ego.length_m);
    let Pose { position, heading } = met.pose();
    (position - rear).dot(Vec2::from_heading(heading)) + 0.5 * track.length_m
}

#[test]
fn who_passes_one_that_stands_touches_it_with_its_rear_by_its_turn() {
    // Who comes towards it does so out of the middle of its lane, and is seen to pass: its flank, a step from the corner.
    for (text, beyond_m) in [(CUTS_IN, 2.0), (ONCOMING, 0.5)] {
        let account = story(text);
        let shown = made(&account);
        assert!(front_beyond_m(&shown) > beyond_m, "its front is by: {}", front_beyond_m(&shown));
        let states = partner(&shown).0;
        let turned = degrees_between(states[states.len() - 1].heading, states[states.len() - 4].heading);
        assert!(turned > 2.0, "{turned}");
        // No tighter than a car drives, and along the road before.
        let tightest = states.windows(2).filter(|pair| pair[1].speed() > 0.5).map(|pair| {
            math::wrap_angle(pair[1].heading - pair[0].heading).abs() / pair[1].position().distance(pair[0].position())
        });
        assert!(tightest.fold(0.0, f64::max) < 1.0 / 4.0);
        assert!(degrees_between(2.0 * states[0].heading, 0.0) < 2.0, "{:?}", states[0]);
    }
}

#[test]
fn a_front_that_touches_does_not_pass_for_a_rear_that_does() {
    for text in [CUTS_IN, ONCOMING] {
        let front = missed(&story(text), |less| {
            let partner = less.partner.as_mut().expect("a partner");
            partner.zones.iter_mut().for_each(|zone| zone.value = ContactZone::Front);
        });
        assert_eq!(front, [CheckKind::CpZones]);
    }
}

#[test]
fn a_front_corner_does_not_pass_for_a_flank_and_a_rear_of_which_both_are_told() {
    let mut account = story(CUTS_IN);
    let partner = account.partner.as_mut().expect("a partner");
    partner.zones.push(Fact::by_rule(ContactZone::Right, "made for this test"));
    let front = missed(&account, |less| {
        let partner = less.partner.as_mut().expect("a partner");
        partner.zones.iter_mut().for_each(|zone| zone.value = ContactZone::FrontRight);
    });
    assert_eq!(front, [CheckKind::CpZones]);
}

#[test]
fn who_sets_off_towards_one_that_is_parked_is_not_there_from_the_start() {
    let mut account = story(
        "The AV was parked at the curb behind a parked van. The AV proceeded to maneuver forward and to the left, and the front right of the \
         AV made contact with the rear left corner of the parked van.",
    );
    account.sv.speeds.push(Fact::by_rule(Speed { mps: 0.9, meaning: SpeedMeaning::Impact }, "made for this test"));
    let shown = made(&account);
    let states = &shown.rollout.ego_track().states[..=before_contact(&shown)];
    let driven_m = states[0].position().distance(states[states.len() - 1].position());
    assert!(driven_m > 2.0, "{driven_m}");
    let order = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::Order).expect("an order");
    assert_eq!(order.result, CheckResult::Shown);
}

/// By how much the partner turns one way and back the other until the contact. [deg]
fn weaves_deg(made: &Reconstruction) -> f64 {
    let turns = partner(made).0[..=before_contact(made)]
        .windows(2)
        .map(|pair| math::wrap_angle(pair[1].heading - pair[0].heading));
    let (all, net) = turns.fold((0.0, 0.0), |(all, net), turn: f64| (all + turn.abs(), net + turn));
    (all - net.abs()).to_degrees()
}

#[test]
fn who_passes_in_a_lane_of_its_own_does_not_turn_away_to_rub_along_whom_it_passes() {
    for text in [
        "The AV was parked at the curb on Elm Street. A sedan passed the parked AV on its left, and the right side of the sedan made contact \
         with the rear left corner of the AV.",
        "The AV was stopped in the right lane. A bus traveling in the left lane passed the AV on the left, and the right side of the bus made \
         contact with the rear left of the AV.",
    ] {
        let shown = made(&story(text));
        assert!(weaves_deg(&shown) < 30.0, "{} degrees: {text}", weaves_deg(&shown));
        // It is on its own side of the ego all the way.
        let ego = shown.rollout.ego_track().states[before_contact(&shown)];
        assert!(partner(&shown).0[..=before_contact(&shown)].iter().all(|state| state.y > ego.y + 1.0), "{text}");
    }
}

#[test]
fn who_splits_lanes_comes_along_the_line_between_them() {
    let side = |words: &str| {
        let shown = made(&story(words));
        assert!(shown.is_true(), "{:?}", shown.verdict);
        let (states, _) = partner(&shown);
        states[0].y - shown.rollout.ego_track().states[0].y
    };
    let splits = "The AV was traveling north in the right lane. A lane-splitting motorcycle behind the AV passed the AV on the left, and the right \
                  side of the motorcycle made contact with the rear left of the AV.";
    let passes = splits.replace("lane-splitting ", "");
    assert!((1.2..2.2).contains(&side(splits)), "{}", side(splits));
    assert!(side(&passes).abs() < 1.0, "{}", side(&passes));
}

#[test]
fn a_chain_that_is_met_with_a_corner_hangs_across_the_lane() {
    let shown = made(&story(
        "The AV was traveling north when the front left of the AV made contact with a chain that was strung across the road.",
    ));
    let object = shown.draft.objects.first().expect("a chain");
    assert!(matches!(object.at, Place::Plane { y_m, .. } if y_m.abs() < 0.7), "{:?}", object.at);
}
