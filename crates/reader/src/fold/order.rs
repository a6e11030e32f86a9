//! Who was at the place of the conflict first (`docs/models/crash-types.md`).

use super::party::has_zone;
use super::striker::struck_who_backed_away;
use super::types::{cp_state, group, sv_state};
use recrash_model::account::{Account, Act, ContactState, CrashType, Fact, KindGroup, Origin, Party, Striker, told};
use recrash_model::narrative::FirstMover;
use recrash_model::zones::ContactZone as Z;

type Said = Option<(FirstMover, &'static str)>;

/// Who was at the place of the conflict first: who stands, who is ahead, else whose flank is touched.
pub(crate) fn order(account: &Account) -> Option<Fact<FirstMover>> {
    let partner = account.partner.as_ref()?;
    let state = sv_state(account)?;
    let (value, name) = match by_standing(account, state) {
        Some(said) => said,
        None => {
            let crash_type = told(&account.crash_type)?;
            by_type(account, partner, state, crash_type).or_else(|| by_zones(account, partner))?
        }
    };
    Some(Fact::by_rule(value, name))
}

/// A thing, a door, and who stands.
fn by_standing(account: &Account, state: ContactState) -> Said {
    if group(account) == Some(KindGroup::Object) {
        let comes = told(&account.striker) == Some(Striker::Cp);
        // "A bottle was thrown at it": they meet.
        let rolls = account.partner.as_ref().is_some_and(|partner| partner.did(Act::Roll));
        let front = !account.sv.zones.is_empty() && account.sv.zones.iter().all(|zone| zone.value == Z::Front);
        if comes && rolls && front && !state.stands() {
            return Some((FirstMover::Both, "a thing that comes across meets its front"));
        }
        return Some(if comes {
            (FirstMover::Sv, "a thing moved into its way")
        } else {
            (FirstMover::Cp, "things stand")
        });
    }
    // One that stands open was there.
    let opened = account.partner.as_ref().is_some_and(|partner| partner.did(Act::OpenDoor));
    let drove_on = told(&account.striker) == Some(Striker::Sv) && !state.stands();
    if told(&account.door) == Some(Striker::Cp) && (opened || !drove_on) {
        return Some((FirstMover::Sv, "a door was opened into it"));
    }
    // Who is pushed into it comes, whatever it stood for before.
    let pushed = account.partner.as_ref().is_some_and(|partner| partner.did(Act::Pushed));
    match (state.stands(), !pushed && cp_state(account).is_some_and(ContactState::stands)) {
        (true, false) => Some((FirstMover::Sv, "who stands is there first")),
        (false, true) => Some((FirstMover::Cp, "who stands is there first")),
        _ => None,
    }
}

/// Types of crash in which one is ahead, or goes backwards.
fn by_type(account: &Account, partner: &Party, state: ContactState, crash_type: CrashType) -> Said {
    let rear = has_zone(&account.sv, |zone| zone.is_rear());
    let from_ahead = told(&account.came_from) == Some(Origin::Ahead);
    let ahead = |value: FirstMover| Some((value, "who is ahead is there first"));
    match crash_type {
        CrashType::FrontToRear => ahead(if rear && !from_ahead { FirstMover::Sv } else { FirstMover::Cp }),
        CrashType::HeadOn => Some((FirstMover::Both, "they meet")),
        CrashType::Secondary if rear => ahead(FirstMover::Sv),
        CrashType::Secondary if from_ahead => ahead(FirstMover::Cp),
        CrashType::Backing => Some((backing(account, partner, state)?, "who goes backwards comes to the other")),
        _ => None,
    }
}

/// Who goes backwards comes to the other.
fn backing(account: &Account, partner: &Party, state: ContactState) -> Option<FirstMover> {
    let rear = |party: &Party| has_zone(party, |zone| zone.is_rear());
    let fore = |party: &Party| has_zone(party, |zone| zone.is_front());
    Some(match (state, cp_state(account)) {
        // Both go backwards: whose rear comes to the other's front.
        (ContactState::Reversing, Some(ContactState::Reversing)) if fore(&account.sv) && rear(partner) => {
            FirstMover::Sv
        }
        (ContactState::Reversing, Some(ContactState::Reversing)) if rear(&account.sv) && fore(partner) => {
            FirstMover::Cp
        }
        (ContactState::Reversing, Some(ContactState::Reversing)) => FirstMover::Both,
        // Its front comes to the side of one that goes backwards.
        (ContactState::Moving | ContactState::SettingOff, _)
            if fore(&account.sv) && !partner.zones.is_empty() && !rear(partner) && !fore(partner) =>
        {
            FirstMover::Cp
        }
        // Its front comes to one that goes backwards across its way.
        (ContactState::Moving | ContactState::SettingOff, _)
            if fore(&account.sv) && told(&account.striker) == Some(Striker::Sv) =>
        {
            FirstMover::Cp
        }
        // With a corner of its front it may have come to one that goes backwards, of which no part is told.
        (ContactState::Moving | ContactState::SettingOff, Some(ContactState::Reversing))
            if partner.zones.is_empty() && only_front(&account.sv) && on_corner(&account.sv) =>
        {
            return None;
        }
        (ContactState::Reversing, _) if struck_who_backed_away(account) => FirstMover::Sv,
        (ContactState::Reversing, _) => FirstMover::Cp,
        _ => FirstMover::Sv,
    })
}

fn only_front(party: &Party) -> bool {
    party.zones.iter().all(|zone| zone.value.is_front())
}

/// Whose front touches comes later than whose flank is touched.
fn by_zones(account: &Account, partner: &Party) -> Said {
    let front = |party: &Party| has_zone(party, |zone| zone.is_front());
    // A side that is named with its front corner is a side.
    let side = |party: &Party| {
        has_zone(party, |zone| matches!(zone, Z::Left | Z::Right))
            && party.zones.iter().filter(|zone| zone.value.is_front()).all(|zone| zone.value != Z::Front)
            && party.zones.iter().any(|zone| zone.source.is_told())
    };
    let under = |party: &Party| party.zones.iter().all(|zone| matches!(zone.value, Z::Bottom | Z::Top));
    let flank = |party: &Party| !under(party) && (side(party) || !has_zone(party, |zone| zone.is_front()));
    let striker = told(&account.striker);
    if partner.zones.is_empty() && !account.sv.zones.is_empty() {
        // By which part it struck a corner nobody tells.
        if !flank(&account.sv) && striker == Some(Striker::Cp) && on_corner(&account.sv) && !comes_before(partner) {
            return None;
        }
        let value = if flank(&account.sv) { FirstMover::Sv } else { FirstMover::Cp };
        return Some((value, "whose flank is touched is there first"));
    }
    let plain_side = |party: &Party| {
        !party.zones.is_empty() && party.zones.iter().all(|zone| matches!(zone.value, Z::Left | Z::Right))
    };
    let thrown = told(&account.crash_type) == Some(CrashType::Secondary);
    let drives = matches!(group(account), Some(KindGroup::Car | KindGroup::Truck));
    if plain_side(&account.sv) && plain_side(partner) && !thrown && drives {
        return Some((FirstMover::Both, "side on side they converge"));
    }
    // "steered over and struck its front corner": the flank came to the corner, as that came along.
    let corner = !account.sv.zones.is_empty()
        && account.sv.zones.iter().all(|zone| matches!(zone.value, Z::FrontLeft | Z::FrontRight));
    let steers = (partner.did(Act::Drift) || partner.did(Act::Swerve)) && !partner.did(Act::Pass);
    let steers = steers && told(&account.ahead) != Some(true);
    if corner && plain_side(partner) && steers && striker == Some(Striker::Cp) && drives {
        return Some((FirstMover::Both, "at about the same time"));
    }
    Some(match (front(&account.sv), flank(&account.sv), front(partner), flank(partner)) {
        (_, true, _, true) if striker == Some(Striker::Cp) => (FirstMover::Sv, "the other came to its flank"),
        (_, true, _, true) if striker == Some(Striker::Sv) => (FirstMover::Cp, "it came to the other's flank"),
        (_, true, true, _) => (FirstMover::Sv, "whose flank is touched is there first"),
        (true, _, _, true) => (FirstMover::Cp, "whose flank is touched is there first"),
        _ => (FirstMover::Both, "at about the same time"),
    })
}

/// Whether a corner or a side of somebody was touched, and not the front alone.
fn on_corner(party: &Party) -> bool {
    party.zones.iter().any(|zone| !matches!(zone.value, Z::Front | Z::Bottom | Z::Top))
}

/// Whether somebody came before the other one, where that meets its flank: it cut in, turned or pulled out there.
fn comes_before(party: &Party) -> bool {
    [Act::LaneChange, Act::Drift, Act::Swerve, Act::Turn, Act::UTurn, Act::PullOut].iter().any(|act| party.did(*act))
}
