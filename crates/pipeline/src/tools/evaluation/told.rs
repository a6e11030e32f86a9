//! What an account says of the fields that the labels have.

use recrash_model::account::{Account, ContactState, KindGroup, SpeedMeaning, told};
use recrash_model::labelled::{CameFrom, LabelledAccount, Since};

/// An account in the terms of the labels.
pub fn in_labels(account: &Account) -> LabelledAccount {
    let (sv, partner) = (&account.sv, account.partner.as_ref());
    let state = told(&sv.state);
    let group = partner.and_then(|partner| told(&partner.kind)).map(recrash_model::account::Kind::group);
    let impact = sv.speeds.iter().find(|speed| speed.value.meaning == SpeedMeaning::Impact);
    LabelledAccount {
        crash_type: told(&account.crash_type),
        role: told(&account.role),
        striker: told(&account.striker),
        sv_state: state.map(Into::into),
        sv_since: state.and_then(|state| Since::of(state, told(&sv.standing))),
        driver: told(&account.driver),
        sv_movement: told(&sv.movement),
        cp_movement: partner.and_then(|partner| told(&partner.movement)),
        cp_unmoved: matches!(group, Some(KindGroup::Object | KindGroup::Animal)),
        came_from: told(&account.came_from).and_then(CameFrom::of),
        order: told(&account.order),
        first_contact: told(&account.first_contact),
        sv_zones: sv.zone_values(),
        cp_zones: partner.map(recrash_model::account::Party::zone_values).unwrap_or_default(),
        sv_impact_mps: if state.is_some_and(ContactState::stands) {
            Some(0.0)
        } else {
            impact.map(|speed| speed.value.mps)
        },
        ..LabelledAccount::default()
    }
}
