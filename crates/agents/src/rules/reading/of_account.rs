//! What an account states, in the terms that the rules stage.

use super::approach::side_from_zones;
use super::{Reading, Relation};
use crate::rules::telling;
use recrash_model::account::{Account, CrashType, Kind, KindGroup, LeftRight, Origin, SpeedMeaning, Striker, told};
use recrash_model::metrics::CollisionKind;
use recrash_model::narrative::{Fact, FactSource, FactValue, Side};
use recrash_model::record::CrashRecord;

/// The reading that an account is. `record` is the one whose columns go beside it.
pub fn reading_of_account<'a>(record: &'a CrashRecord, account: &Account) -> Reading<'a> {
    let source = |source| telling::where_from(&account.report, source, "");
    let mut facts = telling::facts(account);
    facts.retain(|fact| !matches!(fact.value, FactValue::Approach { .. }));
    for (party, is_sv) in [(Some(&account.sv), true), (account.partner.as_ref(), false)] {
        let speeds = party.map(|party| party.speeds.as_slice()).unwrap_or_default();
        let driven = speeds.iter().find(|speed| speed.value.meaning != SpeedMeaning::Posted);
        facts.extend(driven.map(|speed| {
            let speed_mps = speed.value.mps;
            let value = if is_sv { FactValue::SvSpeed { speed_mps } } else { FactValue::CpSpeed { speed_mps } };
            Fact { value, source: source(&speed.source) }
        }));
    }
    let relation = account.came_from.as_ref().and_then(|from| {
        let beside = from.value == Origin::Behind && rides(account);
        // Who rides or walks and comes from behind comes up beside the ego, on the side that was touched.
        let beside = side_from_zones(record).filter(|_| beside).map(|side| Relation::Beside(Some(side)));
        Some((beside.or_else(|| relation(from.value))?, source(&from.source)))
    });
    let why = || FactSource::Assumed { why: "it follows from the type of the crash".to_owned() };
    Reading {
        record,
        tells: relation.is_some() || account.partner.is_some(),
        contradiction: None,
        collision: collision_of(account).map(|kind| (kind, why())),
        relation,
        facts,
    }
}

fn rides(account: &Account) -> bool {
    let group = account.partner.as_ref().and_then(|partner| told(&partner.kind)).map(Kind::group);
    matches!(group, Some(KindGroup::Cyclist | KindGroup::OnFoot))
}

fn relation(from: Origin) -> Option<Relation> {
    let side = |side: LeftRight| if side == LeftRight::Left { Side::Left } else { Side::Right };
    Some(match from {
        Origin::Behind | Origin::Ahead => Relation::Behind,
        Origin::Opposite => Relation::Oncoming,
        Origin::Beside { side: of } => Relation::Beside(Some(side(of))),
        Origin::Parked { side: of } => Relation::Beside(of.map(side)),
        Origin::Cross { side: of } => Relation::From(side(of)),
        Origin::Stall { side: of } | Origin::Driveway { side: of } | Origin::Sidewalk { side: of } => {
            of.map_or(Relation::Crossing, |of| Relation::From(side(of)))
        }
        Origin::Above => return None,
    })
}

/// The kind of collision that a type of crash is.
fn collision_of(account: &Account) -> Option<CollisionKind> {
    match told(&account.crash_type)? {
        CrashType::FrontToRear if told(&account.striker) == Some(Striker::Sv) => Some(CollisionKind::RearEndByEgo),
        CrashType::FrontToRear => Some(CollisionKind::RearEndOfEgo),
        CrashType::HeadOn => Some(CollisionKind::HeadOn),
        CrashType::Lateral => Some(CollisionKind::Sideswipe),
        CrashType::Intersection => Some(CollisionKind::Angle),
        _ => None,
    }
}
