//! The list of all facts that an account may state: when it states one, and how that is held against a rollout.

use crate::facts::held::{Crash, Found, Who};
use crate::told::crash::Told;
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::rollout::Rollout;
use recrash_roads::Scenario;

/// A fact that an account may state.
struct Stated {
    kind: CheckKind,
    /// Whether it is stated, whatever is staged.
    told: fn(&Told) -> bool,
    /// What a rollout shows of it; nothing where who it is about took no part in the contact.
    check: fn(&Crash<'_>) -> Option<Found>,
}

const fn stated(kind: CheckKind, told: fn(&Told) -> bool, check: fn(&Crash<'_>) -> Option<Found>) -> Stated {
    Stated { kind, told, check }
}

/// In the order of [`CheckKind::OF_ACCOUNTS`]. A new fact is a line here and one there.
const ALL: [Stated; CheckKind::OF_ACCOUNTS.len()] = [
    stated(CheckKind::Contact, |_| true, |crash| Some(crash.contact())),
    stated(CheckKind::Partner, |_| true, |crash| Some(crash.partner())),
    stated(
        CheckKind::SvZones,
        |told| !told.sv.zones.is_empty() || told.sv.only_above_or_below,
        |crash| Some(crash.sv_zones()),
    ),
    stated(
        CheckKind::CpZones,
        |told| !told.cp.zones.is_empty() && told.thing.is_none() || told.cp.only_above_or_below,
        |crash| Some(crash.cp_zones()),
    ),
    stated(CheckKind::SvState, |told| told.sv.state_told, |crash| crash.state(Who::Ego)),
    stated(
        CheckKind::CpState,
        |told| told.cp.state_told && told.partner_acts() || told.gate_swings,
        |crash| crash.cp_state(),
    ),
    stated(CheckKind::SvSpeed, |told| told.sv.binding_mps().is_some(), |crash| crash.speed(Who::Ego)),
    stated(CheckKind::CpSpeed, |told| told.cp.binding_mps().is_some(), |crash| crash.speed(Who::Partner)),
    stated(CheckKind::SvMovement, |told| told.sv.movement.is_some(), |crash| crash.movement(Who::Ego)),
    stated(
        CheckKind::CpMovement,
        |told| told.cp.movement.is_some() && told.partner_acts(),
        |crash| crash.movement(Who::Partner),
    ),
    stated(CheckKind::SvActs, |told| !told.sv.acts.is_empty(), |crash| crash.acts(Who::Ego)),
    stated(CheckKind::CpActs, |told| !told.cp.acts.is_empty() && told.partner_acts(), |crash| crash.acts(Who::Partner)),
    stated(
        CheckKind::Approach,
        |told| told.origin_told && told.partner_acts() || told.edge.is_some() || told.has_told_place(),
        |crash| crash.approach(),
    ),
    stated(CheckKind::Order, |told| told.order.is_some() && told.partner_acts(), |crash| crash.order()),
    stated(CheckKind::PassedOn, |told| told.pushed, |crash| Some(crash.passed_on())),
    stated(CheckKind::SvLane, |told| told.lane_word(true).is_some(), |crash| crash.lane(Who::Ego)),
    stated(
        CheckKind::CpLane,
        |told| told.lane_word(false).is_some() && told.partner_acts(),
        |crash| crash.lane(Who::Partner),
    ),
    stated(CheckKind::SvAstride, |told| told.sv.astride.is_some(), |crash| crash.astride(Who::Ego)),
    stated(
        CheckKind::CpAstride,
        |told| told.cp.astride.is_some() && told.thing.is_none(),
        |crash| crash.astride(Who::Partner),
    ),
    stated(CheckKind::OthersAstride, |told| !told.others_astride.is_empty(), |crash| crash.others_astride()),
    stated(CheckKind::SvControl, |told| told.sv.control.is_some(), |crash| crash.control(Who::Ego)),
    stated(
        CheckKind::CpControl,
        |told| told.cp.control.is_some() && told.partner_acts(),
        |crash| crash.control(Who::Partner),
    ),
    stated(CheckKind::Reason, |told| told.sv.state.stands() && !told.reasons.is_empty(), |crash| Some(crash.reason())),
    stated(CheckKind::Others, |told| told.others > 0, |crash| Some(crash.others())),
    stated(CheckKind::Door, |told| told.door.is_some(), |crash| crash.door()),
];

/// The kinds of facts that are stated.
pub(crate) fn kinds(told: &Told) -> Vec<CheckKind> {
    of(told).map(|fact| fact.kind).collect()
}

/// Every stated fact, held against a rollout.
pub(crate) fn facts(told: &Told, scenario: &Scenario, rollout: &Rollout) -> Vec<Check> {
    let crash = Crash::of(told, scenario, rollout);
    let missing = |expected: &str, observed: &str| Found {
        expected: expected.to_owned(),
        observed: observed.to_owned(),
        result: CheckResult::NotShown,
    };
    let found = |fact: &Stated| match &crash {
        Some(crash) => (fact.check)(crash)
            .unwrap_or_else(|| missing("what is stated of the partner", "it lies there, and does nothing")),
        None => missing("what is stated of the contact", "no contact"),
    };
    let held = |fact: &Stated| {
        let Found { expected, observed, result } = found(fact);
        Check { kind: fact.kind, expected, observed, result }
    };
    of(told).map(held).collect()
}

fn of(told: &Told) -> impl Iterator<Item = &'static Stated> {
    ALL.iter().filter(move |fact| (fact.told)(told))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_is_in_the_order_of_tables() {
        assert_eq!(ALL.map(|fact| fact.kind), CheckKind::OF_ACCOUNTS);
    }
}
