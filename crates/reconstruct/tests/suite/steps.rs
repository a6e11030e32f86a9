//! What is told of the steps before the contact, one after the other, is drawn; and a rollout without one does not pass for it.

use crate::ways::{
    before_contact, degrees_between, made, missed, partner, partner_without_acts, speeds, story, without_acts,
};
use recrash_model::account::{Account, Act, Fact, LeftRight};
use recrash_model::metrics::CheckKind;
use recrash_model::template::Movement;

const STOPPED_AHEAD: &str = "The AV was traveling north behind a sedan. The sedan came to a stop and the AV came to a stop behind it. The \
                             sedan then reversed and the rear of the sedan made contact with the front of the stationary AV.";

const WAITED: &str = "The AV was traveling east in the right lane of Oak Street when it came to a stop at a red light at the intersection of \
                      Elm Street. When the light turned green, the AV proceeded into the intersection. A sedan ran a red light from the \
                      left, and the front of the sedan made contact with the left side of the AV.";

const TURNED: &str = "The AV was traveling north on Elm Street and made a right turn onto Oak Street, and came to a stop for a queue of \
                      traffic. A van approached from behind and the front of the van made contact with the rear of the stationary AV.";

const CHANGED: &str = "The AV was traveling in the left lane of Elm Street when it changed lanes to the right lane and came to a stop. A van \
                       approached from behind and the front of the van made contact with the rear of the stationary AV.";

const BACKED_FIRST: &str = "The AV was traveling north and came to a stop behind a truck. The truck began reversing and the AV reversed until \
                            it came to a stop. The truck continued reversing and the rear of the truck made contact with the front of \
                            the stationary AV.";

#[test]
fn a_partner_that_came_and_stood_before_it_reversed_does() {
    let account = story(STOPPED_AHEAD);
    let shown = made(&account);
    let speeds: Vec<f64> = partner(&shown).0.iter().map(|state| state.speed()).collect();
    let stood = speeds.iter().position(|speed| *speed == 0.0).expect("it stands");
    assert!(speeds[0] > 3.0 && speeds[stood..].iter().any(|speed| *speed < -0.5), "{speeds:?}");
    assert!(
        missed(&account, |less| partner_without_acts(less, &[Act::Follow, Act::Stop])).contains(&CheckKind::CpState)
    );
}

#[test]
fn an_ego_that_came_to_a_stop_before_it_drove_on_comes_along_first() {
    let account = story(WAITED);
    let speeds = speeds(&made(&account));
    assert!(speeds[0] > 3.0 && speeds.contains(&0.0) && speeds[speeds.len() - 1] > 1.0, "{speeds:?}");
    assert!(missed(&account, |less| without_acts(less, &[Act::Stop])).contains(&CheckKind::SvState));
}

#[test]
fn an_ego_that_turned_before_it_came_to_a_stop_has_turned() {
    let account = story(TURNED);
    let shown = made(&account);
    let ego = shown.rollout.ego_track();
    assert!(degrees_between(ego.states[0].heading, ego.states[80].heading) > 20.0);
    // Who comes behind it comes by the same way.
    assert!(degrees_between(partner(&shown).0[0].heading, ego.states[0].heading) < 1.0);
    assert!(missed(&account, |less| without_acts(less, &[Act::Turn])).contains(&CheckKind::SvMovement));
}

#[test]
fn an_ego_that_left_its_lane_before_it_came_to_a_stop_has_left_it() {
    let account = story(CHANGED);
    let ego = &made(&account).rollout.actors[0];
    assert!(ego.states[0].y - ego.states[80].y > 0.8);
    assert!(missed(&account, |less| without_acts(less, &[Act::LaneChange])).contains(&CheckKind::SvMovement));
}

#[test]
fn who_is_told_to_back_first_does() {
    let account = story(BACKED_FIRST);
    let shown = made(&account);
    let backs = |speeds: &[f64]| speeds.iter().position(|speed| *speed < -0.2).expect("it reverses");
    let partner: Vec<f64> = partner(&shown).0.iter().map(|state| state.speed()).collect();
    assert!(backs(&partner) < backs(&speeds(&shown)));
    let swapped = |less: &mut Account| {
        let truck = less.partner.as_mut().expect("a partner").acts.iter_mut();
        truck.filter(|fact| fact.act == Act::Reverse).for_each(|fact| fact.step += 20);
    };
    assert_eq!(missed(&account, swapped), [CheckKind::CpState]);
}

#[test]
fn who_goes_round_the_ego_stands_behind_it_in_its_lane_first() {
    let account = story(
        "The AV was stopped for a queue of traffic. A van that was stopped behind the AV proceeded to pass the AV on the left, and the right \
         side of the van made contact with the rear left corner of the stationary AV.",
    );
    let shown = made(&account);
    let (states, met) = partner(&shown);
    let stood = states.iter().find(|state| state.speed() == 0.0).expect("it stands");
    let ego = shown.rollout.ego_track().states[80];
    assert!((stood.y - ego.y).abs() < 0.3, "{stood:?}");
    // Its side rubs along the ego: it is beside it, and comes in.
    assert!(met.y - ego.y > 1.5 && met.vy < -0.05, "{met:?}");
    assert_eq!(
        account.partner.as_ref().and_then(|party| party.acts.iter().find_map(|fact| fact.side)),
        Some(LeftRight::Left)
    );
}

#[test]
fn who_is_told_to_have_gained_speed_does() {
    let account = story(
        "The AV was stopped for a queue of traffic. A van approached from behind, accelerated, and the front of the van made contact with the \
         rear of the stationary AV.",
    );
    let speeds: Vec<f64> = partner(&made(&account)).0.iter().map(|state| state.speed()).collect();
    assert!(speeds[speeds.len() - 1] > speeds[0] + 1.0, "{speeds:?}");
    assert_eq!(missed(&account, |less| partner_without_acts(less, &[Act::Accelerate])), [CheckKind::CpState]);
}

#[test]
fn who_stood_before_the_other_began_to_reverse_does() {
    let account = story(
        "The AV was stopped for a passenger pickup. A pickup truck reversed out of a driveway on the right, and the rear of the \
         pickup truck made contact with the right side of the stationary AV.",
    );
    let shown = made(&account);
    let (states, _) = partner(&shown);
    let begins = states.iter().position(|state| state.speed() < -0.1).expect("it reverses");
    let ego = speeds(&shown);
    assert!(ego[0] > 3.0 && ego[begins] == 0.0, "{begins}: {ego:?}");
}

#[test]
fn a_queue_sets_off_from_its_head() {
    let account = story(
        "The AV was stopped at a red light at the intersection of Elm Street and Oak Street, and a van was stopped behind it. When the light \
         turned green, the AV began to proceed. The van began to proceed and the front of the van made contact with the rear of the AV.",
    );
    let shown = made(&account);
    let (states, _) = partner(&shown);
    let last_stand = |speeds: &[f64]| speeds.iter().rposition(|speed| *speed == 0.0).expect("it stands");
    let partner: Vec<f64> = states.iter().map(|state| state.speed()).collect();
    assert!(last_stand(&speeds(&shown)) < last_stand(&partner), "{partner:?}");
}

#[test]
fn an_ego_that_leaves_its_lane_between_two_stops_stands_first() {
    let account = story(
        "The AV was stopped behind a double-parked sedan. The AV began to proceed, changed lanes to the left, and came to a stop for traffic. \
         The sedan reversed and the rear left of the sedan made contact with the right side of the stationary AV.",
    );
    let shown = made(&account);
    let ego = &shown.rollout.ego_track().states;
    let moved = ego.iter().position(|state| state.speed() > 0.5).expect("it drives");
    let beside = |step: usize| ego[step].y - ego[0].y;
    assert!(ego[..moved].iter().any(|state| state.speed() == 0.0) && beside(120) > 0.8, "{}", beside(120));
}

#[test]
fn who_did_not_stop_in_time_never_stands() {
    let account = story(
        "The AV was traveling north when it came to a stop for a queue of traffic. A sedan following the AV did not stop in time, and the \
         front of the sedan made contact with the rear of the stationary AV at approximately 6 mph.",
    );
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(states.iter().all(|state| state.speed() > 1.0) && states[0].speed() > met.speed() + 1.0, "{met:?}");
}

#[test]
fn an_ego_that_makes_room_moves_away_from_who_comes() {
    let account = story(
        "The AV was traveling on a narrow street when it steered to make room for an oncoming truck and came to a stop. The front left of the \
         truck made contact with the front left of the stationary AV.",
    );
    let ego = &made(&account).rollout.actors[0].states;
    assert!(ego[80].y - ego[0].y < -0.3, "{}", ego[80].y - ego[0].y);
}

#[test]
fn who_changed_lanes_behind_the_ego_comes_out_of_the_other_lane() {
    let account = story(
        "The AV was stopped for a queue of traffic. An SUV changed lanes into the lane of the AV, approached from behind, and the front of \
         the SUV made contact with the rear of the stationary AV.",
    );
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!((states[0].y - met.y).abs() > 2.5, "{} {}", states[0].y, met.y);
}

#[test]
fn who_set_off_and_slowed_again_does() {
    let account = story(
        "The AV was stopped at a red light behind other traffic, and a sedan was stopped behind the AV. When the light turned green, the AV \
         proceeded forward and then slowed for a pedestrian. The sedan proceeded forward and the front of the sedan made contact with the \
         rear of the AV.",
    );
    let shown = made(&account);
    let ego = speeds(&shown);
    let (fastest, last) = (ego.iter().copied().fold(0.0, f64::max), ego[ego.len() - 1]);
    assert!(ego.contains(&0.0) && fastest > last + 1.5, "{ego:?}");
    // Who stood behind it sets off after it.
    let begins = |speeds: &[f64]| speeds.iter().rposition(|speed| *speed == 0.0).expect("it stands");
    let sedan: Vec<f64> = partner(&shown).0.iter().map(|state| state.speed()).collect();
    assert!(begins(&sedan) > begins(&ego), "{sedan:?}");
    // One that keeps its speed does not pass for it.
    assert!(missed(&account, |less| without_acts(less, &[Act::Slow])).contains(&CheckKind::SvState));
}

#[test]
fn who_turns_behind_the_ego_comes_by_its_way() {
    let account = story(
        "The AV was making a right turn at the intersection of Elm Street and braked for a pedestrian. A sedan making a right turn behind the \
         AV made contact with the rear of the AV with its front.",
    );
    let shown = made(&account);
    let states = partner(&shown).0;
    let turned = |from: usize| degrees_between(states[from].heading, states[states.len() - 1].heading);
    // As the lane turns, and no sharper.
    assert!(turned(states.len() - 6) < 35.0, "{}", turned(states.len() - 6));
}

#[test]
fn who_stood_went_on_and_came_to_a_stop_again_does() {
    let account = story(
        "The AV was stopped at a red light. When the light turned green the AV approached the intersection, braked for a pedestrian and came \
         to a stop. A van approached from behind and the front of the van made contact with the rear of the stationary AV.",
    );
    let speeds = speeds(&made(&account));
    let fastest = speeds.iter().copied().fold(0.0, f64::max);
    assert!(speeds[0] == 0.0 && fastest > 1.0 && speeds[speeds.len() - 1] == 0.0, "{speeds:?}");
    assert!(missed(&account, |less| without_acts(less, &[Act::Slow])).contains(&CheckKind::SvState));
}

#[test]
fn who_cuts_in_front_of_the_ego_was_ahead_of_it() {
    let account = story(
        "The AV was traveling in the right lane and slowing for traffic when a sedan in the left lane changed lanes in front of the AV. The \
         front left of the AV made contact with the right side of the sedan.",
    );
    let shown = made(&account);
    let states = partner(&shown).0;
    assert!(states[0].x > shown.rollout.ego_track().states[0].x, "{:?}", states[0]);
}

const TURN_OVER: &str = "The AV was traveling north on Elm Street and made a left turn onto Oak Street. As the AV was completing the left turn, it \
                         began slowing and a sedan traveling behind the AV made contact with the rear of the AV with its front.";

const BACKED_OUT: &str = "The AV pulled over to the right curb of Elm Street. While the AV waited for its passenger, a sedan began reversing out \
                          of a driveway on the right and the rear of the sedan made contact with the right side of the stationary AV.";

const TURNED_ABREAST: &str = "The AV was traveling north in the rightmost left turn lane and made a left turn onto Oak Street. A sedan turning left \
                              in the leftmost left turn lane next to the AV crossed into the lane of the AV and the front right of the \
                              sedan made contact with the left side of the AV.";

#[test]
fn a_turn_that_is_all_but_done_has_been_driven() {
    let account = story(TURN_OVER);
    assert!(account.sv.acts.iter().any(|fact| fact.act == Act::Turn && fact.done), "{:?}", account.sv.acts);
    let turned = |account: &Account| {
        let shown = made(account);
        let states = &shown.rollout.ego_track().states;
        degrees_between(states[before_contact(&shown)].heading, states[0].heading)
    };
    assert!(turned(&account) > 60.0, "{}", turned(&account));
    // Not told to be over it may be met on its way.
    let mut account = account;
    account.sv.acts.iter_mut().for_each(|fact| fact.done = false);
    assert!(turned(&account) < 60.0, "{}", turned(&account));
}

#[test]
fn who_backs_out_towards_an_ego_that_waits_does_so_while_it_stands() {
    let shown = made(&story(BACKED_OUT));
    let stood = speeds(&shown).iter().position(|speed| *speed == 0.0).expect("it stands");
    let backs = partner(&shown).0.iter().position(|state| state.speed() < 0.0).expect("it backs");
    assert!(stood < backs, "stands from step {stood}, backs from step {backs}");
}

#[test]
fn two_in_lanes_for_one_turn_are_side_by_side() {
    let shown = made(&story(TURNED_ABREAST));
    assert_eq!(shown.draft.ego.lane, 1, "the second from the left");
}

const YET_TO_TURN: &str = "The AV was traveling in the right lane of Elm Street and was slowing for the intersection of Oak Street when the front of a \
                           sedan following the AV made contact with the rear of the AV.";

#[test]
fn a_turn_that_only_a_column_tells_is_yet_to_come_where_one_is_hit_from_behind() {
    let mut account = story(YET_TO_TURN);
    account.sv.movement = Some(Fact::of_column(Movement::RightTurn, "SV Pre-Crash Movement"));
    let shown = made(&account);
    let states = &shown.rollout.ego_track().states;
    assert!(degrees_between(states[before_contact(&shown)].heading, states[0].heading) < 10.0);
    assert_eq!(shown.draft.ego.route, ["own-", "right+"], "it goes there");
    // Whose turn the words tell has begun it.
    let mut account =
        story(&YET_TO_TURN.replace("was slowing for the intersection of", "was slowing while turning right onto"));
    account.sv.movement = Some(Fact::of_column(Movement::RightTurn, "SV Pre-Crash Movement"));
    let shown = made(&account);
    let states = &shown.rollout.ego_track().states;
    assert!(degrees_between(states[before_contact(&shown)].heading, states[0].heading) > 10.0);
}

#[test]
fn who_stopped_and_then_went_on_stood_before_it_did() {
    let text = "The AV was traveling north on Elm Street. A sedan following the AV stopped behind the AV and then continued forward and struck the rear of \
                the AV.";
    let shown = recrash_reconstruct::reconstruct(&story(text)).expect("it can be staged");
    let state = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::CpState).expect("it is told");
    assert_eq!(state.expected, "moving, had stood");
    assert!(partner(&shown).0.iter().any(|state| state.speed() == 0.0), "it stands");
}

#[test]
fn who_comes_out_of_a_side_street_into_traffic_bends_into_it() {
    let mut account = story(
        "The AV was traveling north on Elm Street when a sedan coming out of a side street on the left made contact with the left side of the AV.",
    );
    account.partner.as_mut().expect("told").movement =
        Some(Fact::of_column(Movement::EnteringTraffic, "CP Pre-Crash Movement"));
    let shown = recrash_reconstruct::reconstruct(&account).expect("it can be staged");
    let (states, met) = partner(&shown);
    let bends = degrees_between(states[0].heading, met.heading) > 9.0;
    let movement = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::CpMovement).expect("it is told");
    assert!(bends || movement.result != recrash_model::metrics::CheckResult::Shown, "{movement:?}");
}
