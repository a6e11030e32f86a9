//! A subject vehicle that draws a trailer is as long as the two, and is touched where its trailer is where that is told.

use crate::others::told;
use crate::ways::made;
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_reconstruct::Reconstruction;

fn sideswiped(part: &str) -> Reconstruction {
    let text = format!(
        "The AV was traveling east at 45 mph in the right lane with its trailer. A pickup in the left lane changed lanes to the right, and the \
         right side of the pickup made contact with the left side of {part}."
    );
    made(&told(&text))
}

#[test]
fn its_trailer_is_touched_and_not_who_draws_it() {
    let shown = sideswiped("the AV's trailer");
    assert_eq!(shown.rollout.ego_track().length_m, 16.0);
    let zones = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::SvZones).expect("told");
    assert_eq!(zones.result, CheckResult::Shown, "{zones:?}");
    assert!(zones.observed.ends_with(", on the trailer"), "{zones:?}");
    let step = crate::ways::before_contact(&shown);
    let (ego, cp) = (&shown.rollout.ego_track().states[step], crate::others::track(&shown, "cp").states[step]);
    assert!(cp.x < ego.x + 3.0, "the pickup is not beside the front of the truck");
}

#[test]
fn a_vehicle_without_one_is_as_long_as_it_is() {
    let text = "The AV was traveling east at 45 mph in the right lane. A pickup in the left lane changed lanes to the right, and the right side of \
                the pickup made contact with the left side of the AV.";
    let shown = made(&told(text));
    assert!(shown.rollout.ego_track().length_m < 6.0);
    let zones = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::SvZones).expect("told");
    assert!(!zones.expected.contains("trailer"), "{zones:?}");
}
