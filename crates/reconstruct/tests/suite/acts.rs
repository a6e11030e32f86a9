//! What each of the two is told to have done is seen in the way that it drives, in order; where it is not, that is said.

use crate::ways::{
    before_contact, checks_without, degrees_between, made, partner, partner_without_acts, speeds, story, without_acts,
};
use recrash_model::account::{Account, Act, ContactState, CrashType, Fact, LeftRight, Origin};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

const DROPPED_OFF: &str = "The AV was traveling north when it came to a stop for a passenger drop-off. While the AV was parked, an SUV \
                           approached from behind and the front of the SUV made contact with the rear of the parked AV.";

const WENT_ROUND: &str = "The AV was traveling east when it approached a stopped sedan. The AV changed lanes to the left to pass the \
                          sedan. As the AV changed lanes to the right, the sedan began moving forward, and the right side of the AV \
                          made contact with the front left of the sedan.";

const TURNED_OFF: &str = "The AV was traveling north when a sedan traveling in front of the AV turned left towards a driveway and stopped in \
                          the lane. As the AV passed behind the stopped sedan, the sedan reversed and the rear of the sedan made contact \
                          with the left side of the AV.";

const ONCOMING: &str = "The AV was traveling south on Oak Street when it slowed for a pickup truck that was traveling north and making a left \
                        turn into a driveway. The pickup truck came to a stop partially in the lane, and the AV continued forward. While \
                        the AV was passing behind the pickup truck, the pickup truck reversed and the rear of the pickup truck made \
                        contact with the right side of the AV.";

const ACROSS: &str = "The AV was traveling south and approached a pickup truck that was stopped in the lane facing east after making a left turn \
                      towards an alley. As the AV passed the pickup truck, the pickup truck reversed and the rear of the pickup truck \
                      made contact with the left side of the AV.";

const SLOWED: &str = "As the AV was slowing to a stop for a red light, a sedan approached from behind and the front of the sedan made \
                      contact with the rear of the AV.";

const PASSED: &str = "The AV was stopped at a red light on Elm Street. A van that was stopped behind the AV passed the AV on the left, and the right side \
                      of the van made contact with the left side of the AV.";

/// What of an account's acts a scene without some of its facts is said to show.
pub fn acts_without(account: &Account, kind: CheckKind, without: impl Fn(&mut Account)) -> (CheckResult, String) {
    let mut checks = checks_without(account, without).into_iter();
    let check = checks.find(|check| check.kind == kind).expect("told");
    (check.result, check.observed)
}

fn shows(account: &Account, kind: CheckKind) {
    let made = made(account);
    let check = made.verdict.checks.iter().find(|check| check.kind == kind).expect("told");
    assert_eq!(check.result, CheckResult::Shown, "{check:?}");
}

#[test]
fn an_ego_that_came_to_a_stop_and_parked_comes_to_the_kerb() {
    let account = story(DROPPED_OFF);
    shows(&account, CheckKind::SvActs);
    let shown = made(&account);
    let (speeds, ego) = (speeds(&shown), shown.rollout.ego_track());
    let at = before_contact(&shown);
    assert!(speeds[0] > 3.0 && speeds[at] == 0.0 && speeds[at - 10] == 0.0, "{speeds:?}");
    assert!(ego.states[0].y - ego.states[at].y > 1.5, "it goes over to the kerb");
    assert!(shown.draft.ego.handover_s.is_some(), "it is brought there by the system under test");
    let stood = acts_without(&account, CheckKind::SvActs, |less| without_acts(less, &[Act::Stop]));
    assert_eq!(stood, (CheckResult::CannotBeShown, "not that it stopped".to_owned()));
}

#[test]
fn an_ego_that_left_its_lane_and_came_back_does_both() {
    let account = story(WENT_ROUND);
    shows(&account, CheckKind::SvActs);
    let shown = made(&account);
    let ego = &shown.rollout.ego_track().states[..=before_contact(&shown)];
    let farthest = ego.iter().map(|state| state.y).fold(f64::MIN, f64::max);
    assert!(farthest - ego[0].y > 2.5 && farthest - ego[ego.len() - 1].y > 0.8, "out to the left, and back");
    let first = |less: &mut Account| {
        let at = less.sv.acts.iter().position(|fact| fact.act == Act::LaneChange).expect("told");
        less.sv.acts.remove(at);
    };
    let once = acts_without(&account, CheckKind::SvActs, first);
    assert_eq!(once, (CheckResult::CannotBeShown, "not that it changed lanes to the left".to_owned()));
}

#[test]
fn a_partner_that_turned_off_and_stopped_before_it_reversed_comes_there() {
    for (text, side) in [(TURNED_OFF, LeftRight::Left), (ONCOMING, LeftRight::Left), (ACROSS, LeftRight::Left)] {
        let account = story(text);
        assert!(
            account.partner.as_ref().is_some_and(|partner| partner.acts.iter().any(|fact| fact.side == Some(side)))
        );
        shows(&account, CheckKind::CpActs);
        let shown = made(&account);
        let states = &partner(&shown).0;
        let backs = states.iter().position(|state| state.speed() < -0.1).expect("it reverses");
        assert!(
            states[0].speed() > 2.0 && degrees_between(states[0].heading, states[backs].heading) > 25.0,
            "{states:?}"
        );
        let less = if text == ACROSS { Act::Turn } else { Act::Stop };
        let stood = acts_without(&account, CheckKind::CpActs, |account| partner_without_acts(account, &[less]));
        assert_eq!(stood.0, CheckResult::CannotBeShown, "{stood:?}");
    }
}

#[test]
fn who_was_slowing_to_a_stop_need_not_have_come_to_it() {
    let mut account = story(SLOWED);
    account.sv.state = Some(Fact::of_column(ContactState::Moving, "SV Precrash Speed (MPH)"));
    (account.sv.movement, account.sv.standing) = (None, None);
    shows(&account, CheckKind::SvActs);
    let made = made(&account);
    let check = made.verdict.checks.iter().find(|check| check.kind == CheckKind::SvActs).expect("told");
    assert_eq!(check.expected, "began: stopped");
    assert!(speeds(&made)[before_contact(&made)] > 0.1, "it moves yet");
}

#[test]
fn who_is_told_to_pass_and_touches_with_its_flank_has_come_beside() {
    let account = story(PASSED);
    assert!(account.partner.as_ref().is_some_and(|partner| partner.acts.iter().any(|fact| fact.act == Act::Pass)));
    shows(&account, CheckKind::CpActs);
    // One that is told to run into the rear has not.
    let without = |less: &mut Account| {
        let partner = less.partner.as_mut().expect("told");
        partner.zones = vec![Fact::by_rule(ContactZone::Front, "a test")];
        less.sv.zones = vec![Fact::by_rule(ContactZone::Rear, "a test")];
        partner.acts.retain(|fact| fact.act != Act::Pass);
        partner.movement = Some(Fact::by_rule(Movement::Straight, "a test"));
        less.came_from = Some(Fact::by_rule(Origin::Behind, "a test"));
        less.crash_type = Some(Fact::by_rule(CrashType::FrontToRear, "a test"));
    };
    let behind = acts_without(&account, CheckKind::CpActs, without);
    assert_eq!(behind, (CheckResult::CannotBeShown, "not that it passed on the left".to_owned()));
}
