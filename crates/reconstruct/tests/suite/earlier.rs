//! What is told to have been earlier is: who backs first, who rolls out without a stop, who slowed and went on, who came over from its own
//! side, who went away from whom it lets by.

use crate::others::track;
use crate::ways::{before_contact, degrees_between, made, partner, speeds, story};
use recrash_model::account::{Account, Act, Fact, Origin};
use recrash_model::rollout::ActorState;
use recrash_model::scenario::ObstacleKind;
use recrash_model::template::Movement;

const BOTH_BACK: &str = "The AV slowed to a stop behind a sedan. The sedan began reversing, and the AV reversed to make room. The sedan continued \
                         reversing and the rear of the sedan made contact with the front of the AV.";

const ROLLS_OUT: &str = "The AV was traveling north on Elm Street when a sedan exited a parking lot on the right without stopping and turned left \
                         onto Elm Street. The front left of the sedan made contact with the front right of the AV.";

const WENT_ON: &str = "The AV was traveling north on Elm Street. The AV slowed for a speed bump and proceeded forward at a low speed, and the front \
                       of the AV made contact with the rear of a sedan that was stopped ahead.";

const CAME_OVER: &str = "The AV was traveling north on Elm Street. A sedan traveling south on Elm Street veered left, and the front left of the sedan \
                         made contact with the front left of the AV.";

const LET_BY: &str = "The AV was stopped in a lane. The AV began to change lanes and came to a stop. A van that was stopped behind the AV passed the \
                      AV on the left, and the right side of the van made contact with the rear left of the stationary AV.";

const QUEUE: &str = "The AV was stopped in a queue of traffic for a red light. After the light turned green and traffic ahead advanced, the AV \
                     proceeded forward, then slowed to a stop for an SUV stopped directly in front of the AV. A van approached from behind and \
                     the front of the van made contact with the rear of the stationary AV.";

const PAVEMENT: &str = "The AV was traveling north on Elm Street. As the AV turned left into a parking lot, the underside of the AV made contact \
                        with the pavement.";

const DOLLY: &str = "The AV was traveling north behind a box truck when a hand truck fell from the box truck ahead of the AV, and the underside \
                     of the AV made contact with the hand truck.";

fn backs(states: &[ActorState]) -> usize {
    states.iter().position(|state| state.speed() < -0.1).expect("it backs")
}

#[test]
fn of_two_that_back_the_one_that_is_told_to_does_so_first() {
    let shown = made(&story(BOTH_BACK));
    let (own, other) = (backs(&shown.rollout.ego_track().states), backs(partner(&shown).0));
    assert!(other + 5 < own, "{other} and {own}");
}

#[test]
fn who_leaves_a_lot_without_stopping_has_not_stood() {
    let account = story(ROLLS_OUT);
    let stood = |text: &str| partner(&made(&story(text))).0.iter().any(|state| state.speed() < 0.1);
    assert!(account.partner.as_ref().is_some_and(|partner| partner.did(Act::FailToYield)));
    assert!(!stood(ROLLS_OUT));
    // Of whom it is not told, it stood before the road.
    assert!(stood(&ROLLS_OUT.replace(" without stopping", "")));
}

#[test]
fn who_slowed_and_went_on_does_not_brake_into_the_contact() {
    let brakes = |text: &str| {
        let shown = made(&story(text));
        let (speeds, last) = (speeds(&shown), before_contact(&shown));
        assert!(speeds[0] > speeds[last] + 0.8, "{speeds:?}");
        speeds[last - 15] > speeds[last] + 0.2
    };
    assert!(!brakes(WENT_ON));
    assert!(brakes(&WENT_ON.replace(" and proceeded forward at a low speed", "")));
}

#[test]
fn who_drives_the_wrong_way_at_last_came_on_its_own_side() {
    let mut account = story(CAME_OVER);
    let wrong_way = Fact::by_rule(Movement::WrongWay, "made for this test");
    account.partner.as_mut().expect("a partner").movement = Some(wrong_way);
    let from_m = |account: &Account| {
        let shown = made(account);
        partner(&shown).0[0].y - shown.rollout.ego_track().states[0].y
    };
    assert!(from_m(&account) > 2.0);
    account.partner.as_mut().expect("a partner").acts.clear();
    assert!(from_m(&account) < 2.0);
}

#[test]
fn who_is_passed_on_its_way_to_another_lane_had_gone_away_from_there() {
    let moved_m = |text: &str| {
        let shown = made(&story(text));
        let states = &shown.rollout.ego_track().states;
        states[before_contact(&shown)].y - states[0].y
    };
    assert!(moved_m(LET_BY) < -0.8);
    assert!(moved_m(&LET_BY.replace("change lanes and", "change lanes to the left and")) > 0.8);
}

#[test]
fn the_nearest_of_a_queue_is_of_the_kind_that_is_told_of_it() {
    let shown = made(&story(QUEUE));
    let (lead, ego, last) = (track(&shown, "lead"), shown.rollout.ego_track(), before_contact(&shown));
    assert_eq!(lead.kind.label(), "SUV");
    assert!((lead.states[last].y - ego.states[last].y).abs() < 1.0 && lead.states[last].speed() < 0.1);
}

#[test]
fn pavement_that_is_scraped_is_raised_and_no_hole() {
    let kind = |text: &str| made(&story(text)).draft.objects[0].kind;
    assert_eq!(kind(PAVEMENT), ObstacleKind::Kerb);
    assert_eq!(kind(&PAVEMENT.replace("the pavement", "a hole in the pavement")), ObstacleKind::Pothole);
    assert_eq!(kind(&PAVEMENT.replace("the pavement", "a speed bump")), ObstacleKind::Kerb);
}

#[test]
fn a_hand_truck_falls_off_who_drives_ahead() {
    let shown = made(&story(DOLLY));
    let (states, met) = partner(&shown);
    assert!(states[0].speed() > 2.0 && met.speed() < states[0].speed() - 1.0, "{:?} to {met:?}", states[0]);
    // One that lay there did not.
    let lay = made(&story(&DOLLY.replace("fell from the box truck ahead of the AV", "was lying ahead of the AV")));
    assert!(lay.rollout.actors.iter().all(|track| track.id != "cp"));
}

#[test]
fn who_stood_behind_an_ego_that_turns_comes_out_of_its_lane() {
    let mut account = story(
        "The AV was stopped at a red light. After the light turned green, the AV proceeded forward and began a right turn. As the AV was \
         slowing, a sedan that was stopped behind the AV proceeded forward, and the front of the sedan made contact with the rear of the AV.",
    );
    account.came_from = Some(Fact::by_rule(Origin::Behind, "made for this test"));
    let partner_of = account.partner.as_mut().expect("a partner");
    partner_of.movement = Some(Fact::by_rule(Movement::Straight, "made for this test"));
    let shown = made(&account);
    let aside_m = partner(&shown).0[0].y - shown.rollout.ego_track().states[0].y;
    assert!(aside_m.abs() < 1.0, "{aside_m}");
}

const THROWN_ACROSS: &str = "The AV was stopped at a red light on Elm Street at Oak Street, facing south. A sedan traveling north on Elm Street ran a red \
                             light. The sedan was struck by a van traveling east on Oak Street, and the front of the sedan then made contact \
                             with the front of the stationary AV.";

const THROWN_HEAD_ON: &str = "The AV was stopped at a stop sign on Elm Street at Oak Street, facing south. A sedan that was stopped facing east on Oak \
                              Street began a left turn onto northbound Elm Street. An SUV traveling north on Elm Street entered the \
                              intersection, and the front of the SUV made contact with the right side of the sedan. The front of the sedan \
                              then made contact with the front left of the stationary AV.";

#[test]
fn who_throws_the_partner_comes_along_its_own_road() {
    let heading = |text: &str| {
        let shown = made(&story(text));
        let ego = shown.rollout.ego_track().states[0].heading;
        degrees_between(track(&shown, "pusher").states[0].heading, ego)
    };
    assert!((80.0..100.0).contains(&heading(THROWN_ACROSS)));
    assert!(heading(THROWN_HEAD_ON) > 170.0);
    // Of whom it is not told from where it came.
    assert!(heading(&THROWN_ACROSS.replace("by a van traveling east on Oak Street", "by a van")) > 170.0);
}

#[test]
fn who_goes_straight_on_meets_an_ego_that_has_just_begun_its_turn() {
    let mut account = story(
        "The AV was traveling north on Elm Street in the right lane when it began to turn right into a parking lot. A sedan approached from \
         behind and the front of the sedan made contact with the rear of the AV.",
    );
    account.partner.as_mut().expect("a partner").movement =
        Some(Fact::by_rule(Movement::Straight, "made for this test"));
    let shown = made(&account);
    let ego = shown.rollout.ego_track();
    let turned = degrees_between(ego.states[before_contact(&shown)].heading, ego.states[0].heading);
    assert!((20.0..45.0).contains(&turned), "{turned}");
}

const BACKS_INTO_A_STALL: &str = "The AV was traveling north in a parking lot and came to a stop behind a van. The van reversed to park in a stall, and the \
                                  right side of the van made contact with the front of the stationary AV.";

#[test]
fn who_backs_into_a_stall_swings_round() {
    let shown = made(&story(BACKS_INTO_A_STALL));
    let (states, met) = partner(&shown);
    assert!(degrees_between(met.heading, states[0].heading) > 8.0, "{:?} to {met:?}", states[0]);
}

const ADVANCED: &str = "The AV was traveling north on Elm Street, slowing for traffic ahead. As traffic ahead advanced, the AV proceeded forward and came to \
                        a stop for a red light at the intersection of Elm Street and Oak Street. A van approached from behind and the front \
                        of the van made contact with the rear of the stationary AV.";

#[test]
fn traffic_that_went_on_before_the_ego_stopped_does_not_stand_ahead_of_it() {
    let stands_ahead = |text: &str| {
        let shown = made(&story(text));
        let (ego, last) = (shown.rollout.ego_track(), before_contact(&shown));
        let at = &ego.states[last];
        let others = shown.rollout.actors.iter().filter(|track| !["ego", "cp"].contains(&track.id.as_str()));
        let mut others = others.map(|track| &track.states[last]);
        others.any(|state| state.x > at.x && (state.y - at.y).abs() < 1.0 && state.speed() < 0.1)
    };
    assert!(!stands_ahead(ADVANCED));
    let queue = ADVANCED.replace("for a red light at", "behind traffic that was stopped for a red light at");
    assert!(stands_ahead(&queue));
}
