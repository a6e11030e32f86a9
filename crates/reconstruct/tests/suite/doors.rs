//! Doors that are told to have stood open when the other came, and doors that were opened into it.

use crate::ways::{before_contact, made, story};
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::scenario::{Deed, Trigger};
use recrash_reconstruct::{Reconstruction, held_against, reconstruct};

const WITH_ITS_DOOR_OPEN: &str = "The AV was traveling west when it approached a van parked on the right curb with its front left door open. The right \
                                  side of the AV made contact with the open front left door of the parked van.";

const OPENED_BEFORE: &str = "The AV was parked on Elm Street. A passenger in the AV opened the rear left door, and a sedan that was stopped behind the AV \
                             began to maneuver around the AV to the left. The right side of the sedan made contact with the open rear left door of \
                             the AV.";

const OPENED_INTO: &str = "The AV was parked at the curb on Elm Street. A sedan began to pass the AV on the left. As the sedan passed the AV, a passenger \
                           in the AV opened the rear left door, and the right side of the sedan made contact with the open rear left door of the AV.";

fn door(made: &Reconstruction) -> &Check {
    made.verdict.checks.iter().find(|check| check.kind == CheckKind::Door).expect("told")
}

/// So long before the contact the door begins to open. [s]
fn opened_before_s(made: &Reconstruction) -> f64 {
    let cp = made.draft.actors.iter().filter(|actor| actor.id == "cp").map(|actor| &actor.plan);
    let plans = made.draft.ego.recorded.iter().chain(cp);
    let mut acts = plans.flat_map(|plan| &plan.acts).filter(|act| matches!(act.deed, Deed::Part { .. }));
    let Some(Trigger::TimeS(opens_s)) = acts.next().expect("a door").when else { panic!("at a time") };
    0.1 * before_contact(made) as f64 - opens_s
}

#[test]
fn a_door_that_nobody_opened_stands_open_all_along() {
    let shown = made(&story(WITH_ITS_DOOR_OPEN));
    assert_eq!(door(&shown).result, CheckResult::Shown, "{:?}", door(&shown));
    assert!(opened_before_s(&shown) > 8.0, "{}", opened_before_s(&shown));
}

#[test]
fn a_door_that_was_opened_before_the_other_set_off_stands_open() {
    let shown = made(&story(OPENED_BEFORE));
    assert_eq!(door(&shown).result, CheckResult::Shown, "{:?}", door(&shown));
    assert!(opened_before_s(&shown) > 2.0, "{}", opened_before_s(&shown));
    let into = made(&story(OPENED_INTO));
    assert!(opened_before_s(&into) < 1.5, "{}", opened_before_s(&into));
    // A door that opens into the other is none that had stood open.
    let scenario = recrash_roads::check(into.draft).expect("it ran").value;
    let checks = held_against(&story(OPENED_BEFORE), &scenario, &into.rollout).expect("it can be staged").checks;
    let swung = checks.iter().find(|check| check.kind == CheckKind::Door).expect("told");
    assert_eq!(swung.result, CheckResult::NotShown, "{swung:?}");
}

#[test]
fn an_opening_door_had_not_stood_open() {
    let opening = WITH_ITS_DOOR_OPEN
        .replace(" with its front left door open", "")
        .replace("open front left", "opening front left");
    let shown = reconstruct(&story(&opening)).expect("it can be staged");
    assert_eq!(door(&shown).expected, "the partner's door");
    assert!(opened_before_s(&shown) < 2.5, "{}", opened_before_s(&shown));
    assert_eq!(door(&made(&story(WITH_ITS_DOOR_OPEN))).expected, "the partner's door, which stood open");
}
