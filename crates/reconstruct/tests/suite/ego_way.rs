//! How the ego comes to the contact: within its lane, from the speed that a column has, at red, and where it stops.

use crate::common::record;
use crate::ways::{before_contact, checks_without, made, story};
use recrash_model::account::{Account, Act, Fact, Source, Speed, SpeedMeaning};
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::record::{Coded, CrashRecord};
use recrash_model::scenario::{Aspect, Device};
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone;
use recrash_reconstruct::Reconstruction;

const WITHIN: &str = "The AV was traveling west in the center lane on Elm Street. A sedan in the right lane began to change lanes to the left. The AV slowed \
                      and moved to the left within its lane, and the front left of the sedan made contact with the right side of the AV.";

const BRAKED: &str = "The AV was traveling north on Elm Street. A van traveling south crossed over the center line into the AV's lane. The AV braked and the \
                      front of the van made contact with the front of the AV, the AV at 10 mph by then.";

const STEERED: &str = "The AV was traveling north on Elm Street. A van traveling south crossed over the center line into the AV's lane. The test driver \
                       braked shortly before the impact and steered aside. The front left of the van made contact with the left side of the AV.";

const ON_RED: &str = "The AV stopped at a red light at the intersection of Elm Street and Oak Street and then turned right on red. A van traveling straight \
                      through on green from the left made contact with the left side of the AV with its front.";

const WALKER: &str = "The AV stopped at the intersection of Elm Street and Oak Street for a pedestrian who was crossing in front of it. A van coming from the \
                      left on Oak Street turned right and the left side of the van made contact with the front left of the stationary AV.";

const EDGE: &str = "The AV was stopped at the right edge of the lane on Elm Street. A van approached from behind and passed the AV on the left, and the \
                    right side of the van made contact with the left side of the AV.";

fn ego_y(made: &Reconstruction, step: usize) -> f64 {
    made.rollout.ego_track().states[step].y
}

/// How far the ego has gone aside as it is touched.
fn aside_m(made: &Reconstruction) -> f64 {
    ego_y(made, before_contact(made)) - ego_y(made, 0)
}

/// The same account without the words that it stayed in its lane.
fn leaves_lane(account: &mut Account) {
    for fact in account.sv.acts.iter_mut().filter(|fact| fact.act == Act::Drift) {
        if let Source::Words { text, .. } = &mut fact.source {
            *text = text.replace(" within its lane", "");
        }
    }
}

#[test]
fn who_moves_over_within_its_lane_does_not_leave_it() {
    let within = aside_m(&made(&story(WITHIN)));
    let farther = aside_m(&made(&story(&WITHIN.replace(" within its lane", ""))));
    assert!((0.5..0.75).contains(&within) && farther > 0.9, "{within} {farther}");
    let checks = checks_without(&story(WITHIN), leaves_lane);
    let acts = checks.iter().find(|check| check.kind == CheckKind::SvActs).unwrap();
    assert_ne!(acts.result, CheckResult::Shown, "{acts:?}");
}

#[test]
fn who_slowed_came_as_fast_as_its_column_says() {
    let mut account = story(BRAKED);
    let source = Source::Column { name: "SV Precrash Speed (MPH)".to_owned() };
    account.sv.speeds.push(Fact { value: Speed { mps: 13.0, meaning: SpeedMeaning::Impact }, source });
    let made = made(&account);
    let ego = made.rollout.ego_track();
    let at_contact = ego.states[before_contact(&made)].speed();
    assert!((ego.states[0].speed() - 13.0).abs() < 0.1 && (at_contact - 4.5).abs() < 0.4, "{at_contact}");
}

#[test]
fn who_steers_aside_before_it_is_struck_does_so_away_from_the_other() {
    let mut account = story(STEERED);
    account.sv.movement = Some(Fact::of_column(Movement::Straight, "SV Pre-Crash Movement"));
    assert!(aside_m(&made(&account)) < -0.5);
}

#[test]
fn who_turns_on_red_has_red_and_the_other_green() {
    let made = made(&story(ON_RED));
    let shows = |arm: &str| {
        let device = made.draft.control.iter().find(|control| control.at == arm).map(|control| &control.device);
        let Some(Device::Signal { program, .. }) = device else { panic!("a signal at {arm}") };
        program.iter().map(|phase| phase.show).collect::<Vec<_>>()
    };
    assert_eq!((shows("own-"), shows("left-")), (vec![Aspect::Red], vec![Aspect::Green]));
}

#[test]
fn who_stops_for_a_walker_stands_before_the_junction() {
    let made = made(&story(WALKER));
    let ego = made.rollout.ego_track();
    assert!(ego.states[before_contact(&made)].x + 0.5 * ego.length_m < -10.0, "{:?}", ego.states.last());
}

#[test]
fn who_stands_at_the_edge_of_its_lane_is_beside_its_middle() {
    let middle = |words: &str| ego_y(&made(&story(words)), 0);
    let by_m = middle(&EDGE.replace(" at the right edge of the lane", "")) - middle(EDGE);
    assert!((by_m - 0.6).abs() < 0.05, "{by_m}");
}

#[test]
fn who_comes_up_behind_an_ego_is_not_in_touch_with_it_from_the_beginning() {
    let text = "The AV was making a right turn at an intersection with a traffic light from westbound Elm Street onto Oak Street. The AV advanced and \
                then came to a stop to yield to cross traffic. Just when the AV began to move again, it was rear ended by a passenger car behind it.";
    let turns = Coded::Known(Movement::RightTurn);
    let record = CrashRecord {
        road: Coded::Known(RoadType::Intersection),
        partner: Coded::Known(PartnerKind::PassengerCar),
        sv_movement: turns.clone(),
        cp_movement: turns,
        posted_speed_mps: Some(20.1168),
        sv_speed_mps: Some(0.44704),
        sv_zones: vec![ContactZone::RearLeft, ContactZone::Rear],
        cp_zones: vec![ContactZone::Front, ContactZone::FrontRight],
        ..record("1-1", 1, text)
    };
    // Of every reconstruction of a story it is asked that nobody begins in touch with anybody.
    made(&recrash_reader::account(&recrash_reader::incidents(&[record])[0]).expect("a story"));
}
