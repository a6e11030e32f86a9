//! From where the partner came, where the words do not tell it: sides, zones and movement columns.

use super::{Clues, forward};
use crate::fold::Reading;
use crate::fold::party::{has_zone, movement_column};
use crate::lexicon::Relation;
use recrash_model::account::{
    Account, Act, ActFact, ContactState, Fact, Kind, KindGroup, LeftRight, Origin, Party, told,
};
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone as Z;

/// Who moves over without a side told comes from the side that was touched, and who is parked stands there; an animal in the way is ahead.
pub(super) fn by_side(clues: &Clues<'_>, account: &Account) -> Option<Fact<Origin>> {
    let partner = account.partner.as_ref()?;
    let moved_over =
        [Act::LaneChange, Act::Swerve, Act::Drift, Act::Pass, Act::Pushed].into_iter().any(|act| partner.did(act));
    let stood_by = told(&partner.state).is_some_and(ContactState::stands) && account.sv.did(Act::Pass);
    let parked = told(&partner.state) == Some(ContactState::Parked) || stood_by;
    let swiped = clues.reading.contacts.first.is_some_and(|number| {
        let frame = &clues.reading.story.frames[number];
        clues.reading.story.tokens[frame.first].text.starts_with("sideswip")
    });
    let beside = moved_over || parked || swiped || clues.any(Relation::Beside);
    if let Some(origin) = turns_in_before(clues, account) {
        return Some(Fact::by_rule(
            origin,
            "who turns into the way of one that stands comes from the road that crosses",
        ));
    }
    if let (true, Some(side)) = (beside, zone_side(account)) {
        return Some(Fact::by_rule(Origin::Beside { side }, "the side that was touched"));
    }
    // Backwards, over an animal.
    let animal = told(&partner.kind).is_some_and(|kind| kind.group() == KindGroup::Animal);
    if animal && told(&account.sv.state) == Some(ContactState::Reversing) && zone_side(account).is_none() {
        return Some(Fact::by_rule(Origin::Behind, "who goes backwards meets who is behind it"));
    }
    // Backwards, into one that stands.
    let stands = told(&partner.state).is_some_and(ContactState::stands);
    let at_rear = account.sv.zones.iter().all(|zone| zone.value.is_rear());
    if stands && at_rear && told(&account.sv.state) == Some(ContactState::Reversing) {
        return Some(Fact::by_rule(Origin::Behind, "who goes backwards meets who stands behind it"));
    }
    let walks = told(&partner.kind).is_some_and(|kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Animal));
    let flank = !has_zone(&account.sv, |zone| zone.is_front() || zone.is_rear());
    let beside = flank || is_beside_on_foot(account, partner);
    if let (true, true, Some(side)) = (walks, beside, zone_side(account)) {
        return Some(Fact::by_rule(Origin::Cross { side }, "the side that somebody on foot touched"));
    }
    let animal = told(&partner.kind).is_some_and(|kind| kind.group() == KindGroup::Animal);
    let driven_over = has_zone(&account.sv, |zone| zone == Z::Bottom) && forward(account);
    (animal && (driven_over || has_zone(&account.sv, |zone| zone.is_front())))
        .then(|| Fact::by_rule(Origin::Ahead, "an animal that the front touches is ahead"))
}

/// Somebody on foot whom a corner touches, and neither the plain front nor the plain rear, comes from that side, whatever columns tell.
fn is_beside_on_foot(account: &Account, partner: &Party) -> bool {
    let backs = told(&account.sv.state) == Some(ContactState::Reversing);
    let plain = has_zone(&account.sv, |zone| matches!(zone, Z::Front | Z::Rear));
    told(&partner.kind) == Some(Kind::Pedestrian) && !backs && !plain && zone_side(account).is_some()
}

/// "It was waiting to leave the park when a van, turning right into the entrance, swung wide and struck it": from the road before it, to the
/// left of who waits for one that turns right.
fn turns_in_before(clues: &Clues<'_>, account: &Account) -> Option<Origin> {
    let partner = account.partner.as_ref()?;
    let turn = |party: &Party| {
        let turns = |fact: &&ActFact| fact.act == Act::Turn && !fact.after_contact;
        party.acts.iter().find(turns).and_then(|fact| fact.side)
    };
    let side = turn(partner)?;
    let stands = told(&account.sv.state).is_some_and(ContactState::stands);
    let elsewhere = partner.lane.is_some() || clues.any(Relation::Beside) || partner.did(Act::Pass);
    let rear = has_zone(&account.sv, |zone| zone.is_rear());
    // Who turns off beside it touches the side on which it turns: with its trailer, or a rear wheel.
    let cut_in = zone_side(account) == Some(side);
    (stands && !elsewhere && !rear && !cut_in && !account.sv.did(Act::Turn))
        .then_some(Origin::Cross { side: side.other() })
}

/// Where the words say nothing: by zones and movement columns, which tell front on rear and little else.
pub(super) fn by_columns(reading: &Reading<'_>, account: &Account) -> Option<Fact<Origin>> {
    let partner = account.partner.as_ref()?;
    let sv_rear = has_zone(&account.sv, |zone| zone.is_rear());
    let sv_front = has_zone(&account.sv, |zone| zone.is_front());
    let cp_front = has_zone(partner, |zone| zone.is_front());
    let cp_rear = has_zone(partner, |zone| zone.is_rear());
    let rule = |value: Origin| Some(Fact::by_rule(value, "zones of both and the movement columns"));
    // No animal changes lanes.
    if told(&partner.kind).is_some_and(|kind| matches!(kind.group(), KindGroup::Object | KindGroup::Animal)) {
        return None;
    }
    if is_beside_on_foot(account, partner) {
        return None;
    }
    let (cp, sv) = (movement_column(reading), reading.record.sv_movement.known());
    // Who ran a light or a sign crossed: met on its left it came from the right.
    let ran = partner.did(Act::RunRed) || partner.did(Act::RunStop);
    let (left, right) = (
        has_zone(partner, |zone| matches!(zone, Z::Left | Z::RearLeft | Z::FrontLeft)),
        has_zone(partner, |zone| matches!(zone, Z::Right | Z::RearRight | Z::FrontRight)),
    );
    if ran && sv_front && !sv_rear && left != right && !partner.did(Act::Turn) {
        return rule(Origin::Cross { side: if left { LeftRight::Right } else { LeftRight::Left } });
    }
    match cp {
        Some(Movement::Backing) if sv_front => return rule(Origin::Ahead),
        Some(Movement::CrossingIntoOpposingLane | Movement::WrongWay) if sv_front && cp_front => {
            return rule(Origin::Opposite);
        }
        // Out of a way across, or a stall there.
        Some(Movement::Backing) if !sv_rear || !cp_rear => {
            let backs = told(&account.sv.state) == Some(ContactState::Reversing);
            if let Some(side) = zone_side(account).filter(|_| !backs) {
                return rule(Origin::Cross { side });
            }
        }
        Some(Movement::Passing) => {
            let corner = account.sv.zones.iter().all(|zone| zone.value != Z::Rear);
            return rule(zone_side(account).filter(|_| corner).map_or(Origin::Behind, |side| Origin::Beside { side }));
        }
        _ => {}
    }
    if let (true, Some(side)) = (partner.did(Act::LaneChange), zone_side(account)) {
        return rule(Origin::Beside { side });
    }
    // It moved over before one in the next lane: corner on corner.
    let corner = !account.sv.zones.is_empty() && account.sv.zones.iter().all(|zone| zone.value != Z::Rear);
    if let (true, true, Some(side)) = (account.sv.did(Act::LaneChange), corner && sv_rear, zone_side(account)) {
        // It went away from that side: whoever met it there had followed it.
        let change = account.sv.acts.iter().find(|fact| fact.act == Act::LaneChange && !fact.after_contact);
        let away = change.is_some_and(|fact| fact.side == Some(side.other())) && cp == Some(Movement::Straight);
        return rule(if away { Origin::Behind } else { Origin::Beside { side } });
    }
    if sv_rear && cp_front && !sv_front {
        return rule(Origin::Behind);
    }
    // Told to touch its rear, and nothing told of the partner's own side or way.
    let into_rear = sv_rear
        && partner.zones.is_empty()
        && account.sv.zones.iter().all(|zone| zone.value.is_rear() && zone.source.is_told());
    let turns =
        [Act::Turn, Act::UTurn, Act::Reverse, Act::LaneChange, Act::Cross].into_iter().any(|act| partner.did(act));
    if into_rear && !turns && told(&account.sv.state) != Some(ContactState::Reversing) {
        return rule(Origin::Behind);
    }
    if sv_front && cp_rear && !sv_rear {
        // Parked, it stands beside the lane that a corner leaves.
        let corner = told(&partner.state) == Some(ContactState::Parked) && !square_front(account);
        return rule(zone_side(account).filter(|_| corner).map_or(Origin::Ahead, |side| Origin::Beside { side }));
    }
    let side = zone_side(account)?;
    // One way, side by side.
    let over = |movement| {
        matches!(
            movement,
            Some(
                Movement::ChangingLanes
                    | Movement::Merging
                    | Movement::LaneDeparture
                    | Movement::ParkingManeuver
                    | Movement::EnteringTraffic
                    | Movement::Parked
                    | Movement::Stopped
            )
        )
    };
    if over(cp)
        || matches!(sv, Some(Movement::ChangingLanes | Movement::Merging | Movement::Passing | Movement::LaneDeparture))
    {
        return rule(Origin::Beside { side });
    }
    let junction = reading.record.road.known() == Some(RoadType::Intersection);
    if sv == Some(Movement::LeftTurn) && junction && cp == Some(Movement::Straight) && side == LeftRight::Right {
        return rule(Origin::Opposite);
    }
    let flank = |party: &Party| !party.zones.is_empty() && !has_zone(party, |zone| zone.is_front() || zone.is_rear());
    if junction && cp_front && flank(&account.sv) {
        return rule(Origin::Cross { side });
    }
    if junction && sv_front && flank(partner) {
        // Its right flank is met by who comes to it from its right: it came from the left.
        let right = has_zone(partner, |zone| zone == Z::Right);
        return rule(Origin::Cross { side: if right { LeftRight::Left } else { LeftRight::Right } });
    }
    // Both went straight into a junction, corner on corner.
    let corner = |party: &Party| !party.zones.is_empty() && party.zones.iter().all(|zone| zone.value.is_front());
    let both = (sv, cp) == (Some(Movement::Straight), Some(Movement::Straight));
    let lanes = account.sv.lane.is_some() || partner.lane.is_some();
    if junction && both && corner(&account.sv) && corner(partner) && !lanes {
        return rule(Origin::Cross { side });
    }
    let straight = |movement| matches!(movement, Some(Movement::Straight | Movement::Stopped | Movement::Parked));
    (straight(cp) && straight(sv))
        .then(|| Fact::by_rule(Origin::Beside { side }, "zones of both and the movement columns"))
}

/// Which side of the subject vehicle was touched.
pub(super) fn zone_side(account: &Account) -> Option<LeftRight> {
    let left = has_zone(&account.sv, |zone| matches!(zone, Z::FrontLeft | Z::Left | Z::RearLeft));
    let right = has_zone(&account.sv, |zone| matches!(zone, Z::FrontRight | Z::Right | Z::RearRight));
    match (left, right) {
        (true, false) => Some(LeftRight::Left),
        (false, true) => Some(LeftRight::Right),
        _ => None,
    }
}

/// Whether the plain front of the subject vehicle is touched.
pub(super) fn square_front(account: &Account) -> bool {
    has_zone(&account.sv, |zone| zone == Z::Front)
}
