//! A reconstruction that was sabotaged is not called true.

use crate::stories::shown;
use recrash_model::account::{Account, ContactState, Obeyed, SignalState, told};
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::Answer;
use recrash_model::scenario::{Aspect, Deed, Device, Leg, Place, ScenarioDraft};
use recrash_model::zones::ContactZone;
use recrash_reconstruct::held_against;
use recrash_sim::{Ego, simulate};

/// Whether the sabotaged draft is refused, or at least one told fact is not shown.
fn is_caught(account: &Account, draft: ScenarioDraft) -> bool {
    let Ok(checked) = recrash_roads::check(draft) else { return true };
    let verdict =
        held_against(account, &checked.value, &simulate(&checked.value, Ego::Recorded)).expect("it was staged");
    verdict.faithful() == Answer::No
}

/// Applies a sabotage to every reconstruction that it can be applied to; all of them are caught, and there are some.
fn caught(what: &str, least: usize, sabotage: impl Fn(&Account, &mut ScenarioDraft) -> bool) {
    let mut tried = 0;
    for (name, account, made) in shown() {
        let mut draft = made.draft.clone();
        if sabotage(&account, &mut draft) {
            tried += 1;
            assert!(is_caught(&account, draft), "{what} passes in {name:?}");
        }
    }
    assert!(tried >= least, "{what}: tried on {tried}");
}

fn partner_state(account: &Account) -> Option<ContactState> {
    account.partner.as_ref().and_then(|partner| told(&partner.state))
}

fn moved(place: &mut Place, by_x: f64, by_y: f64) {
    if let Place::Plane { x_m, y_m, .. } = place {
        *x_m += by_x;
        *y_m += by_y;
    }
}

#[test]
fn a_partner_far_off() {
    caught("a partner 40 m aside", 30, |_, draft| {
        let Some(partner) = draft.actors.first_mut() else { return false };
        moved(&mut partner.plan.start, 0.0, 40.0);
        for leg in &mut partner.plan.course {
            if let Leg::Curve { to, .. } = leg {
                moved(to, 0.0, 40.0);
            }
        }
        true
    });
}

#[test]
fn another_kind_of_partner() {
    caught("another kind", 30, |_, draft| {
        let Some(partner) = draft.actors.first_mut() else { return false };
        partner.kind = match partner.kind {
            PartnerKind::Bus => PartnerKind::PassengerCar,
            _ => PartnerKind::Bus,
        };
        true
    });
}

#[test]
fn a_standing_ego_that_rolls() {
    caught("a rolling ego", 8, |account, draft| {
        let stood = told(&account.sv.state) == Some(ContactState::Stopped);
        let Some(recorded) = draft.ego.recorded.as_mut().filter(|_| stood) else { return false };
        let Some(act) = recorded.acts.first_mut() else { return false };
        act.deed = Deed::Speed { to_mps: 1.5, rate_mps2: 2.0 };
        recorded.acts.truncate(1);
        true
    });
}

#[test]
fn a_standing_partner_that_drives_on() {
    caught("a partner that never stood", 1, |account, draft| {
        let stood = partner_state(account) == Some(ContactState::SettingOff);
        let Some(partner) = draft.actors.first_mut().filter(|_| stood) else { return false };
        partner.plan.speed_mps = 4.0;
        partner.plan.acts.clear();
        true
    });
}

#[test]
fn a_reversing_partner_that_drives_forward() {
    caught("a partner in forward gear", 3, |account, draft| {
        let reversed = partner_state(account) == Some(ContactState::Reversing);
        let Some(partner) = draft.actors.first_mut().filter(|_| reversed) else { return false };
        for leg in &mut partner.plan.course {
            if let Leg::Curve { to, reverse } = leg {
                *reverse = false;
                if let Place::Plane { heading_deg, .. } = to {
                    *heading_deg += 180.0;
                }
            }
        }
        if let Place::Plane { heading_deg, .. } = &mut partner.plan.start {
            *heading_deg += 180.0;
        }
        true
    });
}

#[test]
fn nobody_comes() {
    caught("an empty road", 30, |_, draft| {
        draft.actors.clear();
        draft.objects.clear();
        true
    });
}

#[test]
fn a_contact_on_the_other_side() {
    caught("a partner mirrored to the other side", 3, |account, draft| {
        let on = |zones: &[recrash_model::account::Fact<ContactZone>], sides: [ContactZone; 3]| {
            !zones.is_empty() && zones.iter().all(|zone| sides.contains(&zone.value))
        };
        let left = on(&account.sv.zones, [ContactZone::FrontLeft, ContactZone::Left, ContactZone::RearLeft]);
        let right = on(&account.sv.zones, [ContactZone::FrontRight, ContactZone::Right, ContactZone::RearRight]);
        if !left && !right || !draft.ego.route.iter().all(|road| road.starts_with("main")) {
            return false;
        }
        let Some(partner) = draft.actors.first_mut() else { return false };
        let mirror = |place: &mut Place| {
            if let Place::Plane { y_m, heading_deg, .. } = place {
                (*y_m, *heading_deg) = (-*y_m, -*heading_deg);
            }
        };
        mirror(&mut partner.plan.start);
        for leg in &mut partner.plan.course {
            if let Leg::Curve { to, .. } = leg {
                mirror(to);
            }
        }
        true
    });
}

#[test]
fn a_partner_that_nobody_throws() {
    caught("a partner that comes by itself", 1, |_, draft| {
        let all = draft.actors.len();
        draft.actors.retain(|actor| actor.id != "pusher");
        draft.actors.len() < all
    });
}

#[test]
fn a_signal_or_sign_that_is_gone() {
    caught("a junction without its signals and signs", 3, |_, draft| {
        let there = !draft.control.is_empty();
        draft.control.clear();
        there
    });
}

#[test]
fn a_red_light_that_is_green() {
    caught("a red light that is green", 2, |account, draft| {
        let red =
            account.sv.controls.last().is_some_and(|fact| {
                fact.value.state == Some(SignalState::Red) && fact.value.obeyed == Some(Obeyed::Yes)
            });
        for control in &mut draft.control {
            if let Device::Signal { program, .. } = &mut control.device {
                program.iter_mut().for_each(|phase| phase.show = Aspect::Green);
            }
        }
        red && !draft.control.is_empty()
    });
}
