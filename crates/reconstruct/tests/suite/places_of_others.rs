//! Others come to where they are told to stand, go on where only the ego stays, and run into the partner from where they are told to come.

use crate::others::{shown_but, told, track};
use crate::ways::{before_contact, checks_without, made, partner, partner_without_acts, story};
use recrash_model::account::{Act, ActFact, ContactState, Fact, LeftRight, Origin, StandReason};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::scenario::{Actor, ActorPlan};
use recrash_model::template::Movement;
use recrash_reconstruct::{held_against, reconstruct};

const STANDS_AGAIN: &str = "The AV was stopped behind a sedan in a queue of traffic for a red light. The sedan proceeded forward, and the AV proceeded forward a short distance and \
                            came to a stop. A van approached from behind and the front of the van made contact with the rear of the stationary AV.";
const LETS_IN: &str = "The AV was stopped in a queue of traffic for a red light at the intersection of Elm Street and Oak Street. When the light turned green, the AV \
                       remained stopped. A van pulled out of a driveway on the right, and the front left of the van made contact with the right side of the AV.";
const NARROW: &str = "The AV was stopped on a narrow street, yielding to an oncoming van. The van proceeded forward and passed the AV, and the left side of the van made \
                      contact with the rear left of the AV.";
const COMES_AND_STOPS: &str = "The AV was stopped behind an SUV on Elm Street. A truck in the oncoming lane approached and came to a stop. The SUV began to reverse and the \
                               rear of the SUV made contact with the front of the stationary AV.";
const THROWN: &str = "The AV was stopped at a red light in the right lane on Elm Street, and a sedan was stopped behind it. A van in the left lane changed lanes to the right and \
                      made contact with the rear of the sedan, pushing the sedan into the AV. The front of the sedan made contact with the rear of the AV.";
const THROUGH: &str = "The AV was traveling north on Elm Street and slowed as it was proceeding through the intersection with Oak Street. A sedan approached from behind and \
                       the front of the sedan made contact with the rear of the AV.";

fn stands_from_the_start(actor: &mut Actor) {
    actor.plan = ActorPlan::standing(actor.plan.start.clone());
}

#[test]
fn who_is_told_to_stand_again_ahead_of_an_ego_that_moves_up_does_not_drive_on() {
    let mut account = told(STANDS_AGAIN);
    let stop = account.sv.acts.iter().rfind(|fact| fact.act == Act::Stop).expect("told").clone();
    let sedan = account.others.first_mut().expect("told");
    sedan.acts.push(recrash_model::account::ActFact { after_other: None, ..stop });
    let shown = made(&account);
    let (lead, ego, last) = (track(&shown, "lead"), shown.rollout.ego_track(), before_contact(&shown));
    assert!(lead.states[last].x - lead.states[0].x > 1.0, "it moves up");
    assert!(lead.states[last].speed() < 0.1 && lead.states[last].x - ego.states[last].x < 14.0, "and stands");
}

#[test]
fn a_queue_drives_on_at_green_where_only_the_ego_stays() {
    let shown = made(&told(LETS_IN));
    let (lead, last) = (track(&shown, "lead"), before_contact(&shown));
    assert!(lead.states[last].x - lead.states[0].x > 1.5 && lead.states[last].speed() > 1.0, "{:?}", lead.states[last]);
}

#[test]
fn the_partner_to_whom_the_ego_gives_way_is_nobody_ahead() {
    let mut account = story(NARROW);
    let yields = account.sv.reasons.iter().find(|fact| fact.value == StandReason::Yield).expect("told").source.clone();
    account.sv.reasons.retain(|fact| fact.value != StandReason::LeadVehicle);
    account.sv.reasons.push(Fact { value: StandReason::LeadVehicle, source: yields });
    let shown = made(&account);
    assert!(shown.rollout.actors.iter().all(|track| track.id != "lead"));
    assert!(shown.verdict.checks.iter().all(|check| check.kind != CheckKind::Reason), "{:?}", shown.verdict);
}

#[test]
fn who_is_told_to_come_along_and_stop_does_not_stand_from_the_start() {
    let shown = shown_but(COMES_AND_STOPS, "near", stands_from_the_start);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    assert!(near.states[0].speed() > 2.0 && near.states[last].speed() == 0.0, "{:?}", near.states[last]);
}

#[test]
fn who_throws_the_partner_comes_out_of_the_lane_where_it_is_told() {
    let mut account = story(THROWN);
    account.others.retain(|other| other.touched_partner);
    let thrower = account.others.first_mut().expect("told");
    thrower.place = Some(Fact::by_rule(Origin::Beside { side: LeftRight::Left }, "a test"));
    let shown = made(&account);
    let (pusher, (_, met)) = (track(&shown, "pusher"), partner(&shown));
    assert!(pusher.states[0].y - met.y > 2.0, "{:?}", pusher.states[0]);
    let passed = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::PassedOn).expect("told");
    assert_eq!(passed.result, CheckResult::Shown);
    // Told on the other side it is not shown.
    account.others[0].place = Some(Fact::by_rule(Origin::Beside { side: LeftRight::Right }, "a test"));
    let scenario = recrash_roads::check(shown.draft).expect("it ran").value;
    let verdict = held_against(&account, &scenario, &shown.rollout).expect("it can be staged");
    let passed = verdict.checks.iter().find(|check| check.kind == CheckKind::PassedOn).expect("told");
    assert_eq!(passed.result, CheckResult::CannotBeShown);
}

#[test]
fn an_ego_that_is_told_in_the_junction_of_a_street_is_in_one() {
    let account = story(THROUGH);
    assert!(account.sv.acts.iter().any(|fact| fact.act == Act::Enter), "{:?}", account.sv.acts);
    let shown = made(&account);
    let acts = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::SvActs).expect("told");
    assert!(acts.result == CheckResult::Shown && acts.expected.contains("entered the junction"), "{acts:?}");
    // On a road without one it is not shown.
    let mut without = account.clone();
    without.sv.acts.retain(|fact| fact.act != Act::Enter);
    without.sv.state = Some(Fact::by_rule(ContactState::Moving, "a test"));
    let plain = reconstruct(&without).expect("it can be staged");
    let scenario = recrash_roads::check(plain.draft).expect("it ran").value;
    let verdict = held_against(&account, &scenario, &plain.rollout).expect("it can be staged");
    let acts = verdict.checks.iter().find(|check| check.kind == CheckKind::SvActs).expect("told");
    assert_eq!(acts.result, CheckResult::CannotBeShown, "{acts:?}");
}

const RIDER: &str = "The AV was stopped facing north on Elm Street. A scooter rider behind the AV slowed and made contact with the rear of the AV.";

#[test]
fn who_rides_on_small_wheels_does_what_it_is_told_to_but_no_turn_is_asked_of_it() {
    let account = story(RIDER);
    let rider = account.partner.as_ref().expect("a partner");
    let slow = rider.acts.iter().find(|fact| fact.act == Act::Slow).expect("told").clone();
    let shown = made(&account);
    let acts = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::CpActs).expect("it is looked for");
    assert!(acts.result == CheckResult::Shown && acts.expected.contains("slowed"), "{acts:?}");
    // Who comes at one speed has not slowed.
    let less = checks_without(&account, |less| partner_without_acts(less, &[Act::Slow]));
    let acts = less.iter().find(|check| check.kind == CheckKind::CpActs).expect("told");
    assert_eq!(acts.result, CheckResult::CannotBeShown, "{acts:?}");
    // On small wheels it turns at once.
    let mut turns = account;
    let rider = turns.partner.as_mut().expect("a partner");
    rider.movement = Some(Fact::by_rule(Movement::Straight, "a test"));
    rider.acts.push(ActFact { act: Act::Turn, side: Some(LeftRight::Left), ..slow });
    let scenario = recrash_roads::check(shown.draft).expect("it ran").value;
    let verdict = held_against(&turns, &scenario, &shown.rollout).expect("it can be staged");
    let acts = verdict.checks.iter().find(|check| check.kind == CheckKind::CpActs).expect("told");
    assert!(acts.result == CheckResult::Shown && !acts.expected.contains("turned"), "{acts:?}");
}

const STOPS_AGAIN: &str = "The AV was stopped in a queue of traffic on Elm Street. A sedan that was stopped in front of the AV moved forward a little before stopping, and the AV \
                           moved forward a little and came to a stop. A van that was stopped behind the AV proceeded forward and the front of the van made contact with the \
                           rear of the stationary AV.";
const LINE_AHEAD: &str = "The AV was traveling north in the center lane of three lanes on Elm Street. As the AV approached a line of stopped cars ahead, it began to change lanes to \
                          the left, and a pickup truck in the left lane accelerated and the right side of the pickup truck made contact with the left side of the AV.";
const DOUBLE: &str = "The AV was traveling east in the left lane on Elm Street. A delivery van was double-parked. A sedan in the right lane changed lanes to the left and the front \
                      left of the sedan made contact with the rear right of the AV.";

#[test]
fn who_moved_up_ahead_and_stopped_again_has_not_driven_off() {
    let shown = made(&told(STOPS_AGAIN));
    let (lead, ego, last) = (track(&shown, "lead"), shown.rollout.ego_track(), before_contact(&shown));
    assert!(lead.states[last].x - lead.states[0].x > 1.0, "it moves up");
    assert!(lead.states[last].speed() < 0.1 && lead.states[last].x - ego.states[last].x < 14.0, "and stands");
    // Who is not told to have stopped drives on.
    let drives = made(&told(&STOPS_AGAIN.replace(" a little before stopping", "")));
    let lead = track(&drives, "lead");
    assert!(lead.states[before_contact(&drives)].speed() > 2.0, "{:?}", lead.states[last]);
}

#[test]
fn whom_the_ego_changes_lanes_for_stands_in_the_lane_that_it_leaves() {
    let shown = made(&told(LINE_AHEAD));
    let (near, ego, last) = (track(&shown, "near"), shown.rollout.ego_track(), before_contact(&shown));
    assert!((near.states[0].y - ego.states[0].y).abs() < 0.5, "{:?}", near.states[0]);
    assert!(near.states[0].x > ego.states[last].x + 4.0, "{:?}", near.states[0]);
}

#[test]
fn who_stands_in_a_lane_that_nobody_tells_does_so_on_the_egos_side_of_the_road() {
    let shown = made(&told(DOUBLE));
    let (near, ego) = (track(&shown, "near").states[0], shown.rollout.ego_track().states[before_contact(&shown)]);
    assert!(near.y < ego.y + 1.7 && near.x > ego.x && near.heading.abs() < 0.1, "{near:?}");
}
