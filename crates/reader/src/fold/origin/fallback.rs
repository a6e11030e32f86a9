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
    // No animal changes lanes.
    let thing = |kind: Kind| matches!(kind.group(), KindGroup::Object | KindGroup::Animal);
    if told(&partner.kind).is_some_and(thing) || is_beside_on_foot(account, partner) {
        return None;
    }
    let touch = Touch::of(reading, account, partner);
    let origin = touch
        .ran_across()
        .or_else(|| touch.of_movement())
        .or_else(|| touch.moved_over())
        .or_else(|| touch.front_on_rear())
        .or_else(|| touch.at_side(touch.side?))?;
    Some(Fact::by_rule(origin, "zones of both and the movement columns"))
}

/// Where two touched, and how the columns say that they moved.
struct Touch<'a> {
    account: &'a Account,
    partner: &'a Party,
    /// Movement columns of the subject vehicle and of the partner.
    sv: Option<Movement>,
    cp: Option<Movement>,
    /// Whether zones of them are at the front or at the rear.
    sv_front: bool,
    sv_rear: bool,
    cp_front: bool,
    cp_rear: bool,
    /// The side of the subject vehicle that was touched.
    side: Option<LeftRight>,
    /// It was at a junction, by the column.
    junction: bool,
}

impl<'a> Touch<'a> {
    /// What zones and columns tell of the two.
    fn of(reading: &Reading<'_>, account: &'a Account, partner: &'a Party) -> Self {
        Self {
            account,
            partner,
            sv: reading.record.sv_movement.known(),
            cp: movement_column(reading),
            sv_front: has_zone(&account.sv, |zone| zone.is_front()),
            sv_rear: has_zone(&account.sv, |zone| zone.is_rear()),
            cp_front: has_zone(partner, |zone| zone.is_front()),
            cp_rear: has_zone(partner, |zone| zone.is_rear()),
            side: zone_side(account),
            junction: reading.record.road.known() == Some(RoadType::Intersection),
        }
    }

    /// Whether no zone of the subject vehicle is its plain rear.
    fn off_plain_rear(&self) -> bool {
        self.account.sv.zones.iter().all(|zone| zone.value != Z::Rear)
    }

    /// Beside, on the side that was touched.
    fn beside(&self) -> Option<Origin> {
        self.side.map(|side| Origin::Beside { side })
    }

    /// Whether the subject vehicle went backwards.
    fn backs(&self) -> bool {
        told(&self.account.sv.state) == Some(ContactState::Reversing)
    }

    /// Who ran a light or a sign crossed: met on its left it came from the right.
    fn ran_across(&self) -> Option<Origin> {
        let ran = self.partner.did(Act::RunRed) || self.partner.did(Act::RunStop);
        let left = has_zone(self.partner, |zone| matches!(zone, Z::Left | Z::RearLeft | Z::FrontLeft));
        let right = has_zone(self.partner, |zone| matches!(zone, Z::Right | Z::RearRight | Z::FrontRight));
        let across = ran && self.sv_front && !self.sv_rear && left != right && !self.partner.did(Act::Turn);
        across.then_some(Origin::Cross { side: if left { LeftRight::Right } else { LeftRight::Left } })
    }

    /// What the movement column of the partner says by itself.
    fn of_movement(&self) -> Option<Origin> {
        match self.cp? {
            Movement::Backing if self.sv_front => Some(Origin::Ahead),
            Movement::CrossingIntoOpposingLane | Movement::WrongWay if self.sv_front && self.cp_front => {
                Some(Origin::Opposite)
            }
            // Out of a way across, or a stall there.
            Movement::Backing if !self.sv_rear || !self.cp_rear => {
                self.side.filter(|_| !self.backs()).map(|side| Origin::Cross { side })
            }
            Movement::Passing => self.beside().filter(|_| self.off_plain_rear()).or(Some(Origin::Behind)),
            _ => None,
        }
    }

    /// One of the two moved over to the other.
    fn moved_over(&self) -> Option<Origin> {
        if self.partner.did(Act::LaneChange) && self.side.is_some() {
            return self.beside();
        }
        // It moved over before one in the next lane: corner on corner.
        let side =
            self.side.filter(|_| self.account.sv.did(Act::LaneChange) && self.sv_rear && self.off_plain_rear())?;
        // It went away from that side: whoever met it there had followed it.
        let change = self.account.sv.acts.iter().find(|fact| fact.act == Act::LaneChange && !fact.after_contact);
        let away = change.is_some_and(|fact| fact.side == Some(side.other())) && self.cp == Some(Movement::Straight);
        Some(if away { Origin::Behind } else { Origin::Beside { side } })
    }

    /// The front of one touched the rear of the other.
    fn front_on_rear(&self) -> Option<Origin> {
        if self.sv_rear && self.cp_front && !self.sv_front || self.met_at_rear() {
            return Some(Origin::Behind);
        }
        if !self.sv_front || !self.cp_rear || self.sv_rear {
            return None;
        }
        // Parked, it stands beside the lane that a corner leaves.
        let corner = told(&self.partner.state) == Some(ContactState::Parked) && !square_front(self.account);
        self.beside().filter(|_| corner).or(Some(Origin::Ahead))
    }

    /// Told to touch its rear, and nothing told of the partner's own side or way.
    fn met_at_rear(&self) -> bool {
        let into_rear = self.sv_rear
            && self.partner.zones.is_empty()
            && self.account.sv.zones.iter().all(|zone| zone.value.is_rear() && zone.source.is_told());
        let turns = [Act::Turn, Act::UTurn, Act::Reverse, Act::LaneChange, Act::Cross]
            .into_iter()
            .any(|act| self.partner.did(act));
        into_rear && !turns && !self.backs()
    }

    /// By the side that was touched, and the way of both.
    fn at_side(&self, side: LeftRight) -> Option<Origin> {
        use Movement as M;
        let moved_over = matches!(
            self.cp,
            Some(
                M::ChangingLanes
                    | M::Merging
                    | M::LaneDeparture
                    | M::ParkingManeuver
                    | M::EnteringTraffic
                    | M::Parked
                    | M::Stopped
            )
        ) || matches!(self.sv, Some(M::ChangingLanes | M::Merging | M::Passing | M::LaneDeparture));
        // One way, side by side.
        if moved_over {
            return self.beside();
        }
        if self.junction
            && let Some(origin) = self.in_junction(side)
        {
            return Some(origin);
        }
        let straight = |movement| matches!(movement, Some(M::Straight | M::Stopped | M::Parked));
        self.beside().filter(|_| straight(self.cp) && straight(self.sv))
    }

    /// At a junction, of two that do not go one way.
    fn in_junction(&self, side: LeftRight) -> Option<Origin> {
        let both = (self.sv, self.cp);
        if both == (Some(Movement::LeftTurn), Some(Movement::Straight)) && side == LeftRight::Right {
            return Some(Origin::Opposite);
        }
        let flank =
            |party: &Party| !party.zones.is_empty() && !has_zone(party, |zone| zone.is_front() || zone.is_rear());
        if self.cp_front && flank(&self.account.sv) {
            return Some(Origin::Cross { side });
        }
        if self.sv_front && flank(self.partner) {
            // Its right flank is met by who comes to it from its right: it came from the left.
            let right = has_zone(self.partner, |zone| zone == Z::Right);
            return Some(Origin::Cross { side: if right { LeftRight::Left } else { LeftRight::Right } });
        }
        // Both went straight into a junction, corner on corner.
        let corner = |party: &Party| !party.zones.is_empty() && party.zones.iter().all(|zone| zone.value.is_front());
        let straight = both == (Some(Movement::Straight), Some(Movement::Straight));
        let lanes = self.account.sv.lane.is_some() || self.partner.lane.is_some();
        (straight && corner(&self.account.sv) && corner(self.partner) && !lanes).then_some(Origin::Cross { side })
    }
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
