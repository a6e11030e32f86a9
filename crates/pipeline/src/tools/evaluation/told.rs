//! What an account says of the fields that the labels have.

use recrash_model::account::{
    Account, Act, ActFact, ContactState, Kind, KindGroup, LeftRight, Origin, Party, Source, SpeedMeaning, StandReason,
    Standing, told,
};
use recrash_model::labelled::{CameFrom, LabelledAccount, Since};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone as Z;

/// An account in the terms of the labels.
pub fn in_labels(account: &Account) -> LabelledAccount {
    let (sv, partner) = (&account.sv, account.partner.as_ref());
    let state = told(&sv.state);
    let impact = sv.speeds.iter().find(|speed| speed.value.meaning == SpeedMeaning::Impact);
    LabelledAccount {
        crash_type: told(&account.crash_type),
        role: told(&account.role),
        striker: told(&account.striker),
        sv_state: state.map(Into::into),
        sv_since: since(account),
        driver: told(&account.driver),
        sv_movement: told(&sv.movement),
        cp_movement: partner.and_then(|partner| told(&partner.movement)),
        cp_unmoved: matches!(group(account), Some(KindGroup::Object | KindGroup::Animal)),
        came_from: came_from(account),
        order: told(&account.order),
        first_contact: told(&account.first_contact),
        sv_zones: sv.zone_values(),
        cp_zones: partner.map(Party::zone_values).unwrap_or_default(),
        sv_impact_mps: if state.is_some_and(ContactState::stands) {
            Some(0.0)
        } else {
            impact.map(|speed| speed.value.mps)
        },
        ..LabelledAccount::default()
    }
}

fn group(account: &Account) -> Option<KindGroup> {
    account.partner.as_ref().and_then(|partner| told(&partner.kind)).map(Kind::group)
}

/// Since when it stood or moved: an account tells whether it came to a stop in the story, the labels how long ago that was.
fn since(account: &Account) -> Option<Since> {
    let sv = &account.sv;
    let state = told(&sv.state)?;
    let before: Vec<&ActFact> = sv.acts.iter().filter(|fact| !fact.after_contact).collect();
    let stands = |fact: &&ActFact| fact.act.stands();
    let last_stop = before.iter().rposition(stands);
    Some(match state {
        ContactState::Parked if !waits_for_riders(sv) => Since::Parked,
        ContactState::Parked => Since::Long,
        ContactState::Stopped if waits_for_riders(sv) || stood_long(sv, &before) => Since::Long,
        ContactState::Stopped if told(&sv.standing)? == Standing::FromTheStart => Since::Long,
        ContactState::Stopped => Since::Just,
        ContactState::SettingOff => Since::SettingOff,
        ContactState::Moving | ContactState::Reversing
            if last_stop.is_some_and(|at| sets_off(account, &before[at..])) =>
        {
            Since::SettingOff
        }
        ContactState::Moving | ContactState::Reversing => Since::UnderWay,
    })
}

/// Whether who moves has only just begun to, by what it did from its last stop on.
fn sets_off(account: &Account, since: &[&ActFact]) -> bool {
    match since {
        // Still slowing to the stop when it is struck from behind.
        [stop] => stop.act == Act::Hold || told(&account.came_from) != Some(Origin::Behind),
        [_, _] => true,
        [_, first, later @ ..] => {
            first.act == Act::SetOff && later.iter().all(|fact| matches!(fact.act, Act::Drift | Act::Swerve))
        }
        [] => false,
    }
}

/// Whether it stood for a while: it "remains" so, or is first told as standing and not as coming to a stop.
fn stood_long(sv: &Party, before: &[&ActFact]) -> bool {
    let moved = before.iter().rposition(|fact| !matches!(fact.act, Act::Stop | Act::Hold | Act::OpenDoor));
    let stood = &before[moved.map_or(0, |at| at + 1)..];
    let begins = |fact: &ActFact, words: &[&str]| match &fact.source {
        Source::Words { text, .. } => words.iter().any(|word| text.to_lowercase().starts_with(word)),
        _ => false,
    };
    let remains = stood.iter().any(|fact| begins(fact, &["remain"]));
    // "the stopped vehicle" tells no time.
    let in_passing = stood.iter().all(|fact| begins(fact, &["the ", "a "]));
    let slowed = moved.is_some_and(|at| before[at].act == Act::Slow);
    let came = told(&sv.standing) == Some(Standing::Stopping);
    remains || !in_passing && !slowed && !came && stood.iter().all(|fact| fact.act == Act::Hold)
}

fn waits_for_riders(sv: &Party) -> bool {
    sv.reasons.iter().any(|reason| reason.value == StandReason::PickupDropoff)
}

/// From where the partner came. An account tells where somebody starts, the labels where it is met: who passes from behind is
/// beside, so is who stands parked there; a thing at the side of the way is on that side.
fn came_from(account: &Account) -> Option<CameFrom> {
    let partner = account.partner.as_ref()?;
    let parked = told(&partner.state) == Some(ContactState::Parked);
    let thing = group(account) == Some(KindGroup::Object);
    Some(match told(&account.came_from)? {
        Origin::Behind => alongside(account).map_or(CameFrom::Behind, beside),
        Origin::Ahead => CameFrom::Ahead,
        Origin::Opposite => CameFrom::Opposite,
        Origin::Beside { side } if thing => from_side(side),
        Origin::Beside { side } => beside(side),
        Origin::Parked { side } if parked => beside(side?),
        // It had come away from the kerb, and passed.
        Origin::Parked { .. } if told(&partner.movement) == Some(Movement::Passing) => {
            alongside(account).map_or(CameFrom::Behind, beside)
        }
        Origin::Cross { side } => from_side(side),
        Origin::Stall { side } | Origin::Driveway { side } | Origin::Parked { side } | Origin::Sidewalk { side } => {
            from_side(side?)
        }
        // The labels know no above: what falls on it is a thing ahead.
        Origin::Above => CameFrom::Ahead,
    })
}

/// The side on which one from behind is met: where the flank is touched, or a rear corner by one that is past it with its front.
fn alongside(account: &Account) -> Option<LeftRight> {
    let partner = account.partner.as_ref()?;
    let sv = worded(&account.sv);
    if sv.is_empty() {
        // Nobody tells where it was touched, and it was passed on a side.
        return partner.acts.iter().find(|fact| fact.act == Act::Pass && !fact.after_contact)?.side;
    }
    let any = |zones: &[Z]| zones.iter().any(|zone| sv.contains(zone));
    let (left, right) = (any(&[Z::FrontLeft, Z::Left, Z::RearLeft]), any(&[Z::FrontRight, Z::Right, Z::RearRight]));
    let side = match (left, right) {
        (true, false) => LeftRight::Left,
        (false, true) => LeftRight::Right,
        _ => return None,
    };
    let flank = any(&[Z::FrontLeft, Z::Left, Z::FrontRight, Z::Right]);
    let cp = worded(partner);
    // A rear corner by one that passes, and not with its plain front; by one that changes lanes, with its front past it.
    let passes = partner.acts.iter().any(|fact| fact.act == Act::Pass && !fact.after_contact);
    let moves_over =
        matches!(told(&partner.movement), Some(Movement::Passing | Movement::ChangingLanes | Movement::Merging));
    let past = passes && !cp.contains(&Z::Front) || moves_over && cp.iter().all(|zone| !zone.is_front());
    (!sv.contains(&Z::Rear) && (flank || !cp.is_empty() && past)).then_some(side)
}

/// Zones as the words name them, without the corners that a column adds; else those of the column.
fn worded(party: &Party) -> Vec<Z> {
    let worded: Vec<Z> = party.zones.iter().filter(|zone| zone.source.is_told()).map(|zone| zone.value).collect();
    if worded.is_empty() { party.zone_values() } else { worded }
}

fn beside(side: LeftRight) -> CameFrom {
    match side {
        LeftRight::Left => CameFrom::BesideLeft,
        LeftRight::Right => CameFrom::BesideRight,
    }
}

fn from_side(side: LeftRight) -> CameFrom {
    match side {
        LeftRight::Left => CameFrom::Left,
        LeftRight::Right => CameFrom::Right,
    }
}
