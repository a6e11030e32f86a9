//! What is told of somebody between two stops, before the last one and behind it is drawn: every told act is seen in the way.

use crate::ways::{before_contact, checks_without, degrees_between, made, partner, speeds, story};
use recrash_model::account::{Account, Act, ContactState, Fact};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::ActorState;

const REACHED: &str = "The AV was traveling north on Oak Street when it came to a stop for a pedestrian. After the pedestrian left, the AV \
                       attempted to proceed forward and the front of the AV made contact with a traffic cone.";

const STOOD_AGAIN: &str = "The AV was stopped at a red light. When the light turned green, the AV proceeded forward, yielding to \
                           pedestrians. A van approached from behind and the front of the van made contact with the rear of the \
                           stationary AV.";

const SLOWED: &str = "The AV was traveling south when it began to brake for a stopped van. The AV began proceeding straight when the front \
                      right of the AV made contact with the left side of a sedan that was parked along the curb.";

const STEERED_AWAY: &str = "The AV was traveling east and passing a cyclist that was traveling in a bike lane when the cyclist veered left \
                            into the lane of the AV. The AV steered away from the cyclist, and the left side of the bicycle made \
                            contact with the right side of the AV.";

const INTO_A_LOT: &str = "The AV was traveling west on Oak Street when it turned left into a parking lot. As the AV was traveling through the \
                          parking lot, a truck ahead of the AV stopped, and the AV slowed to a stop as the truck began reversing. The \
                          rear of the truck made contact with the front of the AV.";

const CAME_BACK: &str = "The AV was traveling in the left lane of Oak Street when it changed lanes to the right to pass a stopped truck. The \
                         AV changed lanes to the left after passing the truck and came to a stop. A van approached in the right lane \
                         and the front left of the van made contact with the rear right of the stationary AV.";

const TRIED: &str = "The AV was stopped at a red light in the right lane of Oak Street. As the AV attempted to change lanes to the left, the AV \
                     slowed to a complete stop. A box truck that was traveling behind the AV passed the AV on the left, and the right \
                     side of the box truck made contact with the front left of the stationary AV.";

const SLOWING: &str = "The AV was stopped at a red light. When the light turned green, the AV accelerated into the intersection and was \
                       slowing to a stop when a sedan approached from behind and the front of the sedan made contact with the rear of \
                       the AV.";

const BACK_AND_FORTH: &str = "The AV was traveling south through an intersection when it came to a stop for a bus that was traveling north. \
                              The AV proceeded forward and came to a stop. The AV reversed and came to a stop. The AV proceeded forward \
                              and came to a stop. The bus turned left, and the left side of the bus made contact with the rear left of \
                              the stationary AV.";

const PUSHED: &str = "The AV was stopped at a red light. A sedan slowed to a stop behind the AV. After the light turned green, the AV proceeded \
                      a short distance and came to a stop. The sedan proceeded forward and came to a stop. A truck approached the sedan \
                      from behind and the front of the truck made contact with the rear of the sedan. The front of the sedan then made \
                      contact with the rear of the stationary AV.";

const CUT_IN: &str = "The AV was traveling north on Oak Street when a sedan to the left changed lanes to the right in front of the AV into \
                      the lane of the AV and came to a stop directly in front of the AV. The AV came to a stop. The sedan then \
                      reversed and the rear of the sedan made contact with the front of the stationary AV.";

const SLOW_TURN: &str = "The AV was traveling north on Elm Street when it came to a stop at the intersection of Oak Street. As the AV \
                         initiated a right turn onto Oak Street, a sedan approached the AV from behind. The front right of the sedan \
                         made contact with the rear left of the AV.";

fn party(account: &mut Account, kind: CheckKind) -> &mut Vec<recrash_model::account::ActFact> {
    match kind {
        CheckKind::SvActs => &mut account.sv.acts,
        _ => &mut account.partner.as_mut().expect("a partner").acts,
    }
}

/// Every told act is seen; and a scene of the same account without some is said not to show them all.
fn holds(account: &Account, kind: CheckKind, expected: &str, dropped: &[Act]) {
    let made = made(account);
    let check = made.verdict.checks.iter().find(|check| check.kind == kind).expect("told");
    assert_eq!((check.result, check.expected.as_str()), (CheckResult::Shown, expected), "{check:?}");
    let less = checks_without(account, |less| party(less, kind).retain(|fact| !dropped.contains(&fact.act)));
    let check = less.into_iter().find(|check| check.kind == kind).expect("told");
    assert_eq!(check.result, CheckResult::CannotBeShown, "{dropped:?} of {account:?}");
}

fn ego(account: &Account) -> Vec<ActorState> {
    let made = made(account);
    made.rollout.ego_track().states[..=before_contact(&made)].to_vec()
}

#[test]
fn what_is_told_between_two_steps_is_seen_in_the_way() {
    let (sv, cp) = (CheckKind::SvActs, CheckKind::CpActs);
    let told: [(&str, CheckKind, &str, &[Act]); 10] = [
        (REACHED, sv, "stopped, began: set off", &[Act::Stop]),
        (STOOD_AGAIN, sv, "stood, set off, slowed", &[Act::SetOff]),
        (SLOWED, sv, "slowed, set off", &[Act::Slow]),
        (STEERED_AWAY, sv, "passed, swerved to the left", &[Act::Swerve]),
        (INTO_A_LOT, sv, "turned to the left, stopped", &[Act::Turn]),
        (CAME_BACK, sv, "changed lanes to the right, changed lanes to the left, stopped, stood", &[Act::LaneChange]),
        (TRIED, sv, "stood, began: changed lanes to the left, stopped", &[Act::LaneChange]),
        (PUSHED, sv, "stood, set off, stopped", &[Act::SetOff]),
        (PUSHED, cp, "stopped, set off, stopped", &[Act::SetOff]),
        (CUT_IN, cp, "changed lanes to the right, stopped, reversed", &[Act::LaneChange]),
    ];
    for (text, kind, expected, dropped) in told {
        holds(&story(text), kind, expected, dropped);
    }
}

#[test]
fn who_is_told_to_have_reached_its_stop_stood_there_and_set_off() {
    let speeds = speeds(&made(&story(REACHED)));
    let stood = speeds.iter().position(|speed| *speed == 0.0).expect("it stands");
    assert!(speeds[0] > 3.0 && speeds[speeds.len() - 1] > 0.1 && stood < speeds.len() - 5, "{speeds:?}");
}

#[test]
fn who_set_off_from_its_last_stop_and_stands_moved_up() {
    let ego = ego(&story(STOOD_AGAIN));
    assert_eq!((ego[0].speed(), ego[ego.len() - 1].speed()), (0.0, 0.0));
    assert!(ego[ego.len() - 1].x - ego[0].x > 2.0);
}

#[test]
fn an_ego_that_came_back_into_its_lane_before_it_stopped_had_left_it() {
    let ego = ego(&story(CAME_BACK));
    let rightmost = ego.iter().map(|state| state.y).fold(f64::MAX, f64::min);
    let last = ego[ego.len() - 1];
    assert!(ego[0].y - rightmost > 2.5 && last.y - rightmost > 0.8 && last.speed() == 0.0, "{rightmost} {last:?}");
}

#[test]
fn who_tried_to_leave_its_lane_between_two_stops_did_so_a_little() {
    let ego = ego(&story(TRIED));
    assert!(ego[0].speed() == 0.0 && ego[ego.len() - 1].y - ego[0].y > 0.5);
}

#[test]
fn who_set_off_and_slowed_to_a_stop_that_it_did_not_reach_slows() {
    let mut account = story(SLOWING);
    account.sv.state = Some(Fact::of_column(ContactState::Moving, "SV Precrash Speed (MPH)"));
    (account.sv.movement, account.sv.standing) = (None, None);
    holds(&account, CheckKind::SvActs, "stood, gained speed, entered the junction, began: stopped", &[Act::Stop]);
}

#[test]
fn all_steps_are_drawn_where_there_are_more_than_are_checked() {
    let account = story(BACK_AND_FORTH);
    let expected = "entered the junction, stopped, set off, stopped, reversed, stopped, set off, stopped, stood";
    holds(&account, CheckKind::SvActs, expected, &[Act::Reverse]);
    let speeds = speeds(&made(&account));
    let stops = speeds.windows(2).filter(|pair| pair[0].abs() > 0.01 && pair[1].abs() <= 0.01).count();
    assert_eq!(stops, 4, "{speeds:?}");
}

#[test]
fn a_partner_that_cut_in_and_stopped_comes_over_from_the_next_lane() {
    let account = story(CUT_IN);
    let shown = made(&account);
    let states = &partner(&shown).0;
    let stood = states.iter().position(|state| state.speed() == 0.0).expect("it stands");
    assert!(states[0].y - states[stood].y > 3.0, "it comes from the left");
    assert!(degrees_between(states[0].heading, states[stood].heading) < 1.0, "along its lane");
}

#[test]
fn a_slow_ego_that_stood_before_its_turn_stands_before_the_junction() {
    let mut account = story(SLOW_TURN);
    let slow = recrash_model::account::Speed { mps: 0.9, meaning: recrash_model::account::SpeedMeaning::Impact };
    account.sv.speeds = vec![Fact::of_column(slow, "SV Precrash Speed (MPH)")];
    holds(&account, CheckKind::SvActs, "stopped, turned to the right", &[Act::Stop]);
    let ego = ego(&account);
    let stood = ego.iter().position(|state| state.speed() == 0.0).expect("it stands");
    assert!(degrees_between(ego[stood].heading, ego[0].heading) < 5.0, "before its turn");
}

const ROLLED: &str = "The AV was traveling north on Elm Street and was coming to a stop. A van approached from behind and the front of the van made \
                      contact with the rear of the AV.";

const BOTH_SET_OFF: &str = "The AV was stopped at the intersection of Elm Street and Oak Street. A sedan traveling west on Oak Street was stopped \
                            there too. The AV set off and entered the intersection, the sedan set off and entered the intersection, and the front of the \
                            sedan made contact with the front right of the AV.";

const BACKED_INTO: &str = "The AV was traveling north on Elm Street and came to a stop. A van stopped behind the AV. The AV then reversed and the rear of \
                           the AV made contact with the front of the van.";

const SLOWLY_OUT: &str = "The AV was stopped in a parking lot. A sedan in the parking stall to the right of the AV reversed out of the stall and the rear of the \
                          sedan made contact with the right side of the AV.";

#[test]
fn who_was_coming_to_a_stop_and_travelled_slowly_did_not_stand_first() {
    let mut account = story(ROLLED);
    (account.sv.state, account.sv.standing) = (Some(Fact::by_rule(ContactState::Moving, "made for this test")), None);
    account.sv.movement = Some(Fact::by_rule(recrash_model::template::Movement::Straight, "made for this test"));
    let last = account.sv.acts.last().expect("it was stopping").clone();
    account.sv.acts.push(recrash_model::account::ActFact {
        act: Act::Follow,
        step: last.step + 1,
        begun: false,
        ..last
    });
    let shown = made(&account);
    let speeds = speeds(&shown);
    assert!(speeds.iter().all(|mps| *mps > 0.2), "{speeds:?}");
    assert!(speeds[0] > speeds[speeds.len() - 1] + 0.8, "it slows");
}

#[test]
fn who_sets_off_and_comes_into_the_junction_does_so_from_before_it() {
    let account = story(BOTH_SET_OFF);
    let shown = made(&account);
    let acts = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::SvActs).expect("it is told");
    assert_eq!(acts.result, CheckResult::Shown, "{acts:?}");
}

#[test]
fn who_stopped_behind_an_ego_that_backs_came_along_behind_it() {
    let shown = made(&story(BACKED_INTO));
    let (van, ego) = (partner(&shown).0, &shown.rollout.ego_track().states);
    assert!(van.iter().zip(ego).all(|(van, ego)| van.x < ego.x - 3.0), "{:?}", van[0]);
    assert!(van[0].speed() > 1.0 && van[van.len() - 1].speed() == 0.0);
}

#[test]
fn an_ego_that_stood_from_the_start_stands_before_a_very_slow_one_backs() {
    let mut account = story(SLOWLY_OUT);
    let slow = recrash_model::account::Speed { mps: 0.45, meaning: recrash_model::account::SpeedMeaning::Impact };
    account.partner.as_mut().expect("a partner").speeds = vec![Fact::of_column(slow, "CP Precrash Speed (MPH)")];
    let hold = recrash_model::account::Standing::FromTheStart;
    account.sv.standing = Some(Fact::by_rule(hold, "made for this test"));
    let shown = made(&account);
    let moves = partner(&shown).0.iter().position(|state| state.speed() != 0.0).expect("it backs");
    assert!(speeds(&shown)[moves] < 0.1, "it stands by then: {:?}", speeds(&shown));
}
