//! What is told to stand at the edge of the road: kerbs, walls, poles, bins, and who is parked along it.

use crate::reading::things;
use crate::told::lies::Lies;
use crate::told::side::Side;
use crate::told::zones::side_of;
use recrash_model::account::{
    Account, ContactState, CrashType, Kind, LaneWord, LeftRight, Origin, Party, Source, told,
};
use recrash_model::scenario::Size;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// Length and width of what goes along the road, where the words for it do not say more. [m]
const ALONG: Size = Size { length_m: 8.0, width_m: 0.3 };

/// The same of a gate that is open. [m]
const OPEN_GATE: Size = Size { length_m: 4.0, width_m: 0.2 };

/// On which side of the ego's road the partner stands, at its edge.
pub(super) fn side(account: &Account, sv: &Side, cp: &Side, lies: Option<Lies>, origin: Origin) -> Option<LeftRight> {
    let partner = account.partner.as_ref()?;
    let touched = side_of(&sv.zones);
    let beside = match origin {
        Origin::Beside { side } | Origin::Parked { side: Some(side) } => Some(side),
        _ => None,
    };
    // No pole stands in a lane.
    let usual = (told(&partner.kind) == Some(Kind::Pole)).then_some(LeftRight::Right);
    let side = beside.or(touched).or(sv.aside).or(usual)?;
    let drives = matches!(sv.state, ContactState::Moving | ContactState::SettingOff)
        && !matches!(
            sv.movement,
            Some(Movement::ChangingLanes | Movement::Merging | Movement::EnteringTraffic | Movement::UTurn)
        );
    let outermost = match sv.lane {
        None => true,
        Some(LaneWord::Right | LaneWord::RightTurn) => side == LeftRight::Right,
        Some(LaneWord::Left | LaneWord::LeftTurn) => side == LeftRight::Left,
        Some(_) => false,
    };
    let other_side = |of: Option<LeftRight>| of == Some(side.other());
    let fits = outermost && !other_side(touched) && !other_side(sv.aside);
    let by_its_rear = !sv.zones.is_empty() && sv.zones.iter().all(|zone| zone.is_rear());
    let there = lies.is_none() && stands_there(account, partner, (sv, cp), beside.is_some());
    (there && drives && fits && !by_its_rear).then_some(side)
}

/// Whether such a partner stands at the edge of the road.
fn stands_there(account: &Account, partner: &Party, (sv, cp): (&Side, &Side), beside: bool) -> bool {
    let Some(kind) = told(&partner.kind) else { return false };
    let words = |source: &Source| matches!(source, Source::Words { .. });
    let told_beside = beside && account.came_from.as_ref().is_some_and(|from| words(&from.source));
    match kind {
        _ if !cp.state.stands() => false,
        Kind::Curb => true,
        // Else it is ahead.
        Kind::Pole => !things::lies_down(partner),
        Kind::Wall | Kind::Barrier => beside || !sv.zones.contains(&ContactZone::Front),
        Kind::Gate => beside,
        Kind::Object if things::is_fixed(partner) => true,
        Kind::Debris | Kind::Object | Kind::Sign | Kind::Cone | Kind::Cart => told_beside,
        _ => {
            let types = [CrashType::SingleVehicle, CrashType::Lateral, CrashType::Other];
            let type_fits = told(&account.crash_type).is_some_and(|kind| types.contains(&kind));
            kind.is_vehicle()
                && cp.state == ContactState::Parked
                && beside
                && type_fits
                && !is_parked_so(partner, "double")
        }
    }
}

/// Whether somebody is told to be parked in such a way.
fn is_parked_so(partner: &Party, word: &str) -> bool {
    let sources = [partner.kind.as_ref().map(|fact| &fact.source), partner.state.as_ref().map(|fact| &fact.source)];
    let acts = partner.acts.iter().map(|fact| &fact.source);
    sources.into_iter().flatten().chain(acts).any(|source| match source {
        Source::Words { text, .. } => text.to_lowercase().contains(word),
        _ => false,
    })
}

/// Whether the partner is told to be parked at an angle to the road.
pub(super) fn is_diagonal(partner: &Party, cp: &Side) -> bool {
    cp.state == ContactState::Parked && is_parked_so(partner, "diagonal")
}

/// The size of what goes along the road.
pub(super) fn size(kind: Option<Kind>) -> Option<Size> {
    match kind? {
        Kind::Curb | Kind::Wall | Kind::Barrier => Some(ALONG),
        Kind::Gate => Some(OPEN_GATE),
        _ => None,
    }
}
