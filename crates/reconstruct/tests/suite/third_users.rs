//! For whom somebody slows, stops or waits is where it is told to be, and does what it is told to.

use crate::others::{shown_but, told, track};
use crate::ways::{before_contact, checks_without, made};
use recrash_model::account::StandReason;
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::scenario::{Actor, ActorPlan};

const SIREN: &str = "The AV was traveling north on Elm Street toward the intersection with Oak Street as an ambulance with its siren on was traveling west on \
                     Oak Street. The AV braked to a stop to yield to the ambulance. A van approached from behind and the front of the van made \
                     contact with the rear of the stationary AV.";
const CLEARED: &str = "The AV was stopped facing east at a red light at the intersection of Elm Street and Oak Street. After the light turned green and cross \
                       traffic cleared, the AV entered the intersection and began to turn left onto Oak Street, and came to a stop to yield to a pedestrian \
                       in the crosswalk. A van approached from behind and the front of the van made contact with the rear of the stationary AV.";
const TWO_ON_FOOT: &str = "The AV was traveling north on Elm Street and came to a stop to yield to a man standing beside the crosswalk and a group of students \
                           crossing the street. A van approached from behind and the front of the van made contact with the rear of the stationary AV.";
const BEHIND_THE_PARTNER: &str = "The AV was traveling north slowly, yielding to a line of cars stopped for a red light. An SUV that was stopped ahead of the AV began to \
                                  reverse, and the AV came to a stop. The rear of the SUV made contact with the front of the stationary AV.";

fn stands_from_the_start(actor: &mut Actor) {
    actor.plan = ActorPlan::standing(actor.plan.start.clone());
}

#[test]
fn an_ambulance_on_the_crossing_road_is_whom_the_ego_gives_way_to() {
    let account = told(SIREN);
    let shown = made(&account);
    let comes = |kind: PartnerKind| shown.rollout.actors.iter().filter(|track| track.kind == kind).count();
    assert_eq!(comes(PartnerKind::FirstResponder), 1);
    assert_eq!(shown.rollout.actors.len(), 3, "and nobody else comes along");
    let reason = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::Reason).expect("told");
    assert_eq!(reason.result, CheckResult::Shown, "{reason:?}");
    let without = checks_without(&account, |account| account.others.clear());
    let others = without.iter().find(|check| check.kind == CheckKind::Others).expect("told");
    assert_eq!(others.result, CheckResult::CannotBeShown);
}

#[test]
fn traffic_that_had_cleared_went_by_before_the_ego_set_off() {
    let shown = shown_but(CLEARED, "crosser", stands_from_the_start);
    let (crosser, ego) = (track(&shown, "crosser"), shown.rollout.ego_track());
    let off = ego.states.iter().position(|state| state.speed() > 0.5).expect("it sets off");
    assert!(crosser.states[0].y > ego.states[0].y && crosser.states[off].y < ego.states[off].y + 3.0, "it has crossed");
}

#[test]
fn who_stays_and_who_crosses_are_two() {
    let shown = made(&told(TWO_ON_FOOT));
    let (stays, walks, last) = (track(&shown, "bystander"), track(&shown, "walker"), before_contact(&shown));
    assert_eq!(stays.states[last].speed(), 0.0);
    assert!(walks.states[last].position().distance(walks.states[0].position()) > 5.0);
}

#[test]
fn a_queue_stands_ahead_of_a_partner_that_stood_in_it() {
    let mut account = told(BEHIND_THE_PARTNER);
    account.sv.reasons.retain(|fact| fact.value != StandReason::Queue);
    let shown = made(&account);
    let (near, cp) = (track(&shown, "near"), track(&shown, "cp"));
    assert!(
        (near.states[0].y - cp.states[0].y).abs() < 1.0 && near.states[0].x > cp.states[0].x + 4.0,
        "{:?}",
        near.states[0]
    );
}
