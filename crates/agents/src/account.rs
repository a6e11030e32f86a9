//! What an account says, in the terms of the labels of records: for judging any agent by what it reads.

use crate::rules::{collision_of, telling};
use recrash_model::account::Account;
use recrash_model::labelled::LabelledAccount;
use recrash_model::narrative::FactValue;
use recrash_model::profile::SystemProfile;

/// An account in the terms of the labels of records.
pub fn account_of(account: &Account, profile: &SystemProfile) -> LabelledAccount {
    let collision = collision_of(account);
    let mut labelled = LabelledAccount {
        road: Some(account.template().road.into()),
        collision,
        excluded: Some(collision.is_some_and(|kind| profile.excludes.collisions.contains(&kind))),
        ..LabelledAccount::default()
    };
    for fact in telling::facts(account) {
        match fact.value {
            FactValue::SvMovement { movement } => labelled.sv_movement = Some(movement),
            FactValue::CpMovement { movement } => labelled.cp_movement = Some(movement),
            FactValue::Approach { approach } => labelled.approach = Some(approach),
            FactValue::Order { first } => labelled.order = Some(first),
            FactValue::Contact { sv, cp } => (labelled.sv_zones, labelled.cp_zones) = (sv, cp),
            _ => {}
        }
    }
    labelled
}
