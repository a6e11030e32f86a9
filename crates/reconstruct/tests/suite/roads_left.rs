//! What is told of the road by which somebody came, or only implied, is not asked for as a deed of its own.

use crate::acts::acts_without;
use crate::ways::{before_contact, made, partner, speeds, story};
use recrash_model::account::{Account, Act, ActFact, ContactState, Fact, LeftRight, Speed, SpeedMeaning};
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::template::Movement;
use recrash_reconstruct::{Reconstruction, held_against};

const TWO_TURNS: &str = "The AV turned left onto Elm Street and drove along it. It then made a right turn into the entrance of a parking \
                         lot, and the underside of the AV scraped the pavement.";

const LATE: &str = "The AV was traveling east on Elm Street. A sedan was stopped at the stop sign on Oak Street, to the right of the AV. \
                    When the AV entered the intersection, the sedan entered the intersection, and the front of the sedan made contact \
                    with the right side of the AV.";

const YET_TO_TURN: &str = "The AV slowed to a stop for a red light at the intersection with Oak Street with its right turn signal on. The AV \
                           proceeded forward slowly when a van approached from behind, and the front of the van made contact with the \
                           rear of the AV.";

/// What a fact is told to be, where it is checked.
fn told(made: &Reconstruction, kind: CheckKind) -> Option<&str> {
    made.verdict.checks.iter().find(|check| check.kind == kind).map(|check| check.expected.as_str())
}

/// What an account tells, held against a scene.
fn checks(account: &Account, made: Reconstruction) -> Vec<Check> {
    let scenario = recrash_roads::check(made.draft).expect("it ran").value;
    held_against(account, &scenario, &made.rollout).expect("it can be staged").checks
}

#[test]
fn of_two_turns_to_both_sides_the_last_is_driven() {
    assert_eq!(told(&made(&story(TWO_TURNS)), CheckKind::SvActs), Some("turned to the right"));
}

#[test]
fn who_only_by_what_it_did_has_set_off_may_have_done_so_before() {
    let account = story(LATE);
    let shown = made(&account);
    assert_eq!(told(&shown, CheckKind::CpActs), Some("stood, set off, entered the junction"));
    // What words put behind the other's deed is bound by it yet.
    let mut late = account.clone();
    let entry = late.partner.as_mut().expect("told").acts.iter_mut().find(|fact| fact.act == Act::Enter).expect("told");
    let mut set_off = entry.clone();
    (set_off.act, set_off.step) = (Act::SetOff, entry.step - 1);
    late.partner.as_mut().expect("told").acts.insert(1, set_off);
    let acts = checks(&late, shown).into_iter().find(|check| check.kind == CheckKind::CpActs).expect("told");
    assert_eq!(acts.result, CheckResult::CannotBeShown, "{acts:?}");
}

#[test]
fn who_stood_before_it_entered_the_junction_sets_off_from_its_line() {
    let account = story(
        "The AV was traveling east on Elm Street. A sedan that was initially stopped facing north on Oak Street proceeded forward \
         into the intersection, and the front of the sedan made contact with the right side of the AV.",
    );
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(states[0].speed() == 0.0 && met.speed() > 1.0, "{met:?}");
    let entered = acts_without(&account, CheckKind::CpActs, |less| {
        let partner = less.partner.as_mut().expect("told");
        partner.acts.retain(|fact| fact.act != Act::Enter);
        partner.state = Some(Fact::by_rule(ContactState::SettingOff, "a test"));
    });
    assert_eq!(entered, (CheckResult::CannotBeShown, "not that it entered the junction".to_owned()));
}

#[test]
fn an_ego_that_moves_aside_between_two_stands_drives() {
    let account = story(
        "The AV was stopped facing north on Elm Street. While the AV was stopped, a bus began to pass the AV to the left, and the AV \
         moved to the right and came to a stop. A sedan that was stopped behind the bus began to pass the AV to the left, and the \
         right side of the sedan made contact with the left side of the stationary AV.",
    );
    let speeds = speeds(&made(&account));
    let moves = speeds.iter().position(|speed| *speed > 0.5).expect("it moves");
    assert!(speeds[..moves].contains(&0.0) && speeds[moves..].contains(&0.0), "{speeds:?}");
}

#[test]
fn an_ego_that_sets_off_at_its_line_and_is_hit_from_behind_may_have_yet_to_turn() {
    let mut account = story(YET_TO_TURN);
    account.sv.movement = Some(Fact::of_column(Movement::RightTurn, "SV Pre-Crash Movement"));
    let shown = made(&account);
    // Words that tell of the turn ask for it.
    let last = account.sv.acts[account.sv.acts.len() - 1].clone();
    account.sv.acts.push(ActFact { act: Act::Turn, side: Some(LeftRight::Right), ..last });
    let turned = checks(&account, shown).into_iter().find(|check| check.kind == CheckKind::SvMovement).expect("told");
    assert_eq!(turned.result, CheckResult::NotShown, "{turned:?}");
}

const IN_TWO_GOES: &str = "The AV was traveling south in the right lane and moved to the left to change lanes in a queue of traffic. The AV stopped \
                           partly in the left lane and partly in the right lane for a red light. When the light turned green, the AV \
                           continued to change lanes to the left as a van in the left lane proceeded forward, and the right side of the \
                           van made contact with the left side of the AV.";

const HALF_OVER: &str = "The AV slowed to a stop in a queue of traffic for a red light. The AV moved to the left between a stopped sedan and a \
                         stopped van, and came to a stop partly in the next lane. The light turned green, and the AV proceeded forward and \
                         came to a stop as the van began proceeding forward, and the front right of the van made contact with the front \
                         left of the stationary AV.";

/// How far to the left of where it began the ego is where it stands, each time that it comes to a stand. [m]
fn stands_m(made: &Reconstruction) -> Vec<f64> {
    let ego = &made.rollout.ego_track().states[..=before_contact(made)];
    let halts = (1..ego.len()).filter(|at| ego[*at].speed() == 0.0 && ego[at - 1].speed() != 0.0);
    halts.map(|at| ego[at].y - ego[0].y).collect()
}

#[test]
fn an_ego_that_leaves_its_line_in_two_goes_stands_between_partly_over() {
    let mut account = story(IN_TWO_GOES);
    account.sv.movement = Some(Fact::of_column(Movement::ChangingLanes, "SV Pre-Crash Movement"));
    account.sv.speeds =
        vec![Fact::of_column(Speed { mps: 2.7, meaning: SpeedMeaning::Impact }, "SV Precrash Speed (MPH)")];
    let shown = made(&account);
    let met_m = shown.rollout.ego_track().states[before_contact(&shown)].y - shown.rollout.ego_track().states[0].y;
    let stands_m = stands_m(&shown);
    assert!((0.5..1.5).contains(&stands_m[0]) && met_m > stands_m[0] + 0.5, "{stands_m:?}, {met_m}");
}

#[test]
fn an_ego_that_moves_up_behind_that_was_half_over_before() {
    let stands_m = stands_m(&made(&story(HALF_OVER)));
    let [first, second, third] = stands_m[..] else { panic!("{stands_m:?}") };
    assert!(first.abs() < 0.1 && second > 0.2 && third > second, "{stands_m:?}");
}
