//! Who waits ahead of the ego at first, and goes on then: it is there before that, and moves as it is told.

use crate::others::{shown_but, track};
use crate::ways::{before_contact, speeds};
use recrash_model::scenario::{Actor, ActorPlan};

const FOR_A_SIREN: &str = "The AV was stopped in a queue of traffic for a red light at the intersection of Elm Street and Oak Street. When the light turned green \
                           and traffic ahead advanced, the AV proceeded a short distance and came to a stop before entering the intersection, as it detected a \
                           siren. A van approached from behind and the front of the van made contact with the rear of the stationary AV.";

fn stands_from_the_start(actor: &mut Actor) {
    actor.plan = ActorPlan::standing(actor.plan.start.clone());
}

#[test]
fn a_queue_that_advances_stood_ahead_of_an_ego_that_then_stops_for_something_else() {
    let shown = shown_but(FOR_A_SIREN, "lead", stands_from_the_start);
    let (lead, ego) = (track(&shown, "lead"), speeds(&shown));
    let lead_off = lead.states.iter().position(|state| state.speed() > 0.2).expect("it drives on");
    let ego_off = ego.iter().position(|speed| *speed > 0.2).expect("it moves up");
    assert!(lead.states[0].speed() == 0.0 && lead_off < ego_off, "{lead_off}, {ego_off}");
    assert!(ego[before_contact(&shown)] < 0.1, "it stands again");
}
