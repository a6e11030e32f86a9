//! Others and things are where they are told when the two touch, and not only at some time before.

use crate::others::{moved, shown_but, told, track};
use crate::ways::{before_contact, degrees_between, made, partner, story};
use recrash_model::account::Untold;
use recrash_model::rollout::ActorState;
use recrash_model::scenario::{Aspect, Device};
use recrash_reconstruct::{Reconstruction, reconstruct};

const BETWEEN_AT_KERB: &str = "The AV was stopped at the curb facing east on Elm Street for a passenger drop-off. A cyclist traveling east approached from \
                               behind and passed between the AV and a sedan that was stopped to the left of the AV, and the cyclist made \
                               contact with the left side of the stationary AV.";

const SPIKES: &str = "The AV was traveling north on Elm Street when it turned left into a parking garage. As the AV proceeded straight through the exit of \
                      the garage, the front of the AV made contact with tire spikes.";

const ROPE: &str = "The AV was traveling north on Elm Street when it made a right turn into a parking lot. As the AV entered the lot, the front of the AV made \
                    contact with a chain across the entrance.";

const FROM_UNDER: &str = "The AV was traveling south in the left lane of Elm Street when debris appeared from under the van in front of the AV. The front of the AV \
                          made contact with the debris.";

const WAITS_OPPOSITE: &str = "The AV was traveling north on Elm Street and began to make a left turn at the intersection with Oak Street. A southbound van slowed \
                              down on the opposite side of the intersection. A sedan traveling south passed the van on the right, entered the \
                              intersection, and the front right of the sedan made contact with the right side of the AV.";

const GREEN_AT_LAST: &str = "The AV was stopped at the curb facing north on Elm Street when a bus traveling north in the right lane came to a stop to the left of the AV \
                             in a queue of traffic for a red light at the intersection with Oak Street. The AV proceeded forward and came to a stop. \
                             When the light turned green and the traffic ahead advanced, the bus proceeded forward and the right side of the bus made \
                             contact with the front left of the stationary AV.";

const ON_A_HILL: &str = "The AV was traveling north on a steep hill. As the AV turned left onto Oak Street, the underside of the AV made contact with the pavement.";

fn ego_met(made: &Reconstruction) -> ActorState {
    made.rollout.ego_track().states[before_contact(made)]
}

#[test]
fn who_is_passed_between_stands_abreast_of_an_ego_at_the_kerb() {
    let shown = shown_but(BETWEEN_AT_KERB, "beside", |sedan| moved(&mut sedan.plan, 6.0, 0.0));
    let (sedan, ego) = (track(&shown, "beside").states[0], ego_met(&shown));
    let cyclist = partner(&shown).1;
    assert!((sedan.x - ego.x).abs() < 2.0, "{sedan:?}, {ego:?}");
    assert!(ego.y < cyclist.y && cyclist.y < sedan.y, "{cyclist:?}");
}

#[test]
fn what_lies_or_hangs_across_an_entrance_is_met_behind_the_turn() {
    for text in [SPIKES, ROPE] {
        let shown = made(&story(text));
        let ego = shown.rollout.ego_track();
        let turned = degrees_between(ego_met(&shown).heading, ego.states[0].heading);
        assert!(turned > 70.0, "{turned} degrees: {text}");
    }
}

#[test]
fn what_comes_from_under_the_one_ahead_begins_right_behind_that() {
    let shown = made(&told(FROM_UNDER));
    let (debris, van, ego) = (partner(&shown).0, track(&shown, "near"), shown.rollout.ego_track());
    let last = before_contact(&shown);
    let gap_m = van.states[0].x - debris[0].x - 0.5 * van.length_m;
    assert!((0.0..2.0).contains(&gap_m) && (van.states[0].y - ego.states[0].y).abs() < 0.5, "{gap_m}");
    assert!(debris[last].speed() < ego.states[last].speed() - 3.0, "it slides");
    assert!(van.states[last].speed() > ego.states[last].speed() - 0.5 && van.states[last].x > ego.states[last].x + 8.0);
}

#[test]
fn who_slowed_opposite_is_there_when_the_two_touch() {
    let shown = made(&told(WAITS_OPPOSITE));
    let (van, last) = (track(&shown, "near"), before_contact(&shown));
    assert!(van.states[last].x > ego_met(&shown).x + 5.0, "{:?}", van.states[last]);
    assert!(van.states[last].speed() < van.states[0].speed() - 0.8);
}

#[test]
fn who_is_ahead_of_an_ego_at_the_kerb_stands_in_the_lane_and_the_light_turns_green_for_it() {
    let shown = made(&told(GREEN_AT_LAST));
    let (lead, last) = (track(&shown, "lead"), before_contact(&shown));
    let (bus, ego) = (partner(&shown).0, ego_met(&shown));
    assert!(lead.states[0].y > ego.y + 2.0 && lead.states[0].x > bus[last].x, "{:?}", lead.states[0]);
    let own = shown.draft.control.iter().find(|control| control.at == "own-").expect("a light");
    let Device::Signal { program, .. } = &own.device else { panic!("a signal") };
    let goes_s = 0.1 * lead.states.iter().position(|state| state.speed() > 0.1).expect("it goes") as f64;
    assert!(program[0].show == Aspect::Red && (goes_s - program[0].for_s).abs() < 1.0, "{goes_s}, {program:?}");
}

#[test]
fn a_pavement_that_is_scraped_on_a_hill_is_no_kerb() {
    assert_eq!(reconstruct(&story(ON_A_HILL)).unwrap_err(), Untold::Place);
}

const SCRAPED_OPPOSITE: &str = "The AV was traveling north on Elm Street and the front left of the AV made contact with the rear left of a sedan that was parked \
                                facing south on Elm Street.";

const LEFT_KERB: &str = "The AV was pulling out of a parking spot on Elm Street when the front left of the AV made contact with the rear of a sedan that was \
                         parked ahead of the AV.";

#[test]
fn one_that_is_parked_on_the_opposite_side_stands_at_the_left_kerb_unless_it_is_told_to_face_the_ego() {
    let opposite = |text: &str| {
        let mut account = story(text);
        account.came_from =
            Some(recrash_model::account::Fact::by_rule(recrash_model::account::Origin::Opposite, "made for this test"));
        account
    };
    let facing = reconstruct(&opposite(SCRAPED_OPPOSITE));
    let faces = |made: &Reconstruction| {
        degrees_between(partner(made).0[0].heading, made.rollout.ego_track().states[0].heading) > 120.0
    };
    assert!(facing.is_ok_and(|made| made.missed().is_some() || faces(&made)));
    let shown = made(&opposite(&SCRAPED_OPPOSITE.replace("facing south on", "on")));
    let (states, met) = partner(&shown);
    assert!(met.y > shown.rollout.ego_track().states[0].y + 2.0 && states[0].speed() == 0.0, "{met:?}");
}

#[test]
fn who_pulls_out_and_meets_one_with_its_left_corner_left_the_left_kerb() {
    let shown = made(&story(LEFT_KERB));
    let ego = &shown.rollout.ego_track().states;
    assert!(ego[before_contact(&shown)].y < ego[0].y - 0.2, "{:?}", ego[0]);
    let right = made(&story(&LEFT_KERB.replace("front left", "front right")));
    let ego = &right.rollout.ego_track().states;
    assert!(ego[before_contact(&right)].y > ego[0].y + 0.2, "{:?}", ego[0]);
}
