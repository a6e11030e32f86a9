//! Whether the facts of an account make one possible picture: zones of both, turns, movements and from where the partner came.
//!
//! A point of contact has a direction seen from each of the two. Seen from the subject vehicle it is `p` eighths of a turn
//! clockwise of straight ahead; the partner points `r` eighths clockwise of it. Then the partner is touched at `p + 4 - r`: who
//! goes the same way (`r` = 0) touches a left side with its right side, who comes the other way (`r` = 4) with its left side.
//! Turns widen `r` to a range. Every origin is weighed by this, by where it lets the contact be, and by how it goes with the
//! movements of both; `docs/models/crash-types.md` has the table.
//!
//! What the words say is the heaviest weight, not the only one: it falls where it makes an impossible picture and another
//! origin makes a good one.

use recrash_model::account::{
    Account, Act, ContactState, Fact, Kind, KindGroup, LeftRight, Origin, Party, Place, PlaceKind, Source, told,
};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone as Z;

/// Origins as far as a picture tells them apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Way {
    /// Behind, in its lane.
    Behind,
    /// Ahead, in its lane.
    Ahead,
    /// In the next lane.
    Beside(LeftRight),
    /// From the opposite direction.
    Opposite,
    /// From a crossing way, a driveway, the kerb.
    Cross(LeftRight),
}

const WAYS: [Way; 7] = [
    Way::Behind,
    Way::Ahead,
    Way::Beside(LeftRight::Left),
    Way::Beside(LeftRight::Right),
    Way::Opposite,
    Way::Cross(LeftRight::Left),
    Way::Cross(LeftRight::Right),
];

impl Way {
    /// The way of an origin; `None` where it is none.
    pub fn of(origin: Origin) -> Option<Self> {
        Some(match origin {
            Origin::Behind => Self::Behind,
            Origin::Ahead => Self::Ahead,
            Origin::Opposite => Self::Opposite,
            Origin::Beside { side } => Self::Beside(side),
            Origin::Cross { side } => Self::Cross(side),
            Origin::Stall { side }
            | Origin::Driveway { side }
            | Origin::Parked { side }
            | Origin::Sidewalk { side } => Self::Cross(side?),
            Origin::Above => return None,
        })
    }

    /// The plain origin of a way.
    pub fn origin(self) -> Origin {
        match self {
            Self::Behind => Origin::Behind,
            Self::Ahead => Origin::Ahead,
            Self::Opposite => Origin::Opposite,
            Self::Beside(side) => Origin::Beside { side },
            Self::Cross(side) => Origin::Cross { side },
        }
    }

    /// The same on the other side.
    fn mirrored(self) -> Option<Self> {
        match self {
            Self::Beside(side) => Some(Self::Beside(side.other())),
            Self::Cross(side) => Some(Self::Cross(side.other())),
            _ => None,
        }
    }

    /// Eighths of a turn by which the partner points clockwise of the subject vehicle before any turn.
    fn points(self) -> i32 {
        match self {
            Self::Behind | Self::Ahead | Self::Beside(_) => 0,
            Self::Cross(LeftRight::Left) => 2,
            Self::Opposite => 4,
            Self::Cross(LeftRight::Right) => 6,
        }
    }
}

/// The four faces of a vehicle that a zone belongs to, in eighths of a turn clockwise of its front.
fn faces(zone: Z) -> &'static [i32] {
    match zone {
        Z::Front => &[0],
        Z::FrontRight => &[0, 2],
        Z::Right => &[2],
        Z::RearRight => &[2, 4],
        Z::Rear => &[4],
        Z::RearLeft => &[4, 6],
        Z::Left => &[6],
        Z::FrontLeft => &[0, 6],
        Z::Top | Z::Bottom => &[],
    }
}

/// Steps of two eighths between two directions. [eighths of a turn]
fn apart(one: i32, other: i32) -> i32 {
    let difference = (one - other).rem_euclid(8);
    difference.min(8 - difference)
}

/// What a picture is made of.
struct Scene<'a> {
    sv: &'a Party,
    cp: &'a Party,
    place: &'a Place,
}

impl Scene<'_> {
    /// How well the zones of both fit, by the best pair of faces: 4 where they do, less the further they are off.
    fn touches(&self, way: Way) -> i32 {
        let (sv_from, sv_to) = turn(self.sv);
        let (cp_from, cp_to) = turn(self.cp);
        // Who parks, backs, or backs out of a stall may point anywhere.
        let anywhere = matches!(told(&self.cp.state), Some(ContactState::Parked | ContactState::Reversing))
            || matches!(
                told(&self.cp.movement),
                Some(Movement::Parked | Movement::Backing | Movement::ParkingManeuver)
            );
        if anywhere {
            return 0;
        }
        // A turn of the partner adds to its direction, one of the subject vehicle takes away.
        let (from, to) = (way.points() + cp_from - sv_to, way.points() + cp_to - sv_from);
        let best = |sv: &Z, cp: &Z| {
            let pairs = faces(*sv).iter().flat_map(|p| faces(*cp).iter().map(move |q| (*p, *q)));
            let off = |(p, q): (i32, i32)| (from..=to).map(|r| apart(p + 4 - r, q)).min().unwrap_or(0);
            pairs.map(off).min()
        };
        let zones = |party: &Party| party.zones.iter().map(|zone| zone.value).collect::<Vec<_>>();
        let (sv, cp) = (zones(self.sv), zones(self.cp));
        match sv.iter().flat_map(|one| cp.iter().filter_map(|other| best(one, other))).min() {
            None => 0,
            Some(0) => 3,
            Some(1) => 1,
            Some(2) => -3,
            Some(_) => -5,
        }
    }

    fn backs_across(&self, way: Way) -> bool {
        matches!(way, Way::Cross(_))
            && (told(&self.cp.state) == Some(ContactState::Reversing)
                || told(&self.cp.movement) == Some(Movement::Backing))
    }

    /// Whether the partner can be where the subject vehicle is touched.
    fn stands_there(&self, way: Way) -> i32 {
        let at = |face: i32| self.sv.zones.iter().any(|zone| faces(zone.value).contains(&face));
        let plain = |face: i32| self.sv.zones.iter().any(|zone| faces(zone.value) == [face]);
        let (front, right, rear, left) = (at(0), at(2), at(4), at(6));
        if !(front || right || rear || left) {
            return 0;
        }
        // Who has turned can be on either side.
        let by_its_rear = self.cp.zones.iter().any(|zone| faces(zone.value).contains(&4));
        let turns =
            if self.backs_across(way) { !by_its_rear } else { turn(self.sv) != (0, 0) || turn(self.cp) != (0, 0) };
        let backs = told(&self.sv.state) == Some(ContactState::Reversing);
        let side = |here: bool, there: bool| match (here, there) {
            (true, _) => 2,
            (false, _) if turns => 0,
            (false, true) => -4,
            (false, false) => -1,
        };
        match way {
            Way::Behind if plain(4) && !plain(0) => 3,
            Way::Behind if rear => 1,
            Way::Behind if front && !(left || right) => -5,
            Way::Behind => -1,
            Way::Ahead if backs => -1,
            Way::Ahead if plain(0) && !plain(4) => 3,
            Way::Ahead if front => 1,
            Way::Ahead if rear && !(left || right) => -5,
            Way::Ahead => -2,
            Way::Beside(LeftRight::Left) => side(left, right),
            Way::Beside(LeftRight::Right) => side(right, left),
            // Who turns left across shows the right side.
            Way::Opposite if turn(self.sv).0 < 0 && !(front || right) => -3,
            Way::Opposite if front || left => 1,
            Way::Opposite if right => 0,
            Way::Opposite => -3,
            Way::Cross(LeftRight::Left) if front && !right => 1,
            Way::Cross(LeftRight::Right) if front && !left => 1,
            Way::Cross(LeftRight::Left) => side(left, right) - 1,
            Way::Cross(LeftRight::Right) => side(right, left) - 1,
        }
    }

    /// How it goes with the movements of both and with the road.
    fn moves(&self, way: Way) -> i32 {
        // Nobody on foot drives in the next lane.
        let on_foot = told(&self.cp.kind).map(Kind::group) == Some(KindGroup::OnFoot);
        let crosses = i32::from(on_foot && matches!(way, Way::Cross(_)));
        self.of_partner(way)
            + self.of_own(way)
            + self.of_passing(way)
            + self.of_one_lane(way)
            + self.of_road(way)
            + crosses
    }

    /// How it goes with the movement of the partner.
    fn of_partner(&self, way: Way) -> i32 {
        use Movement as M;
        match told(&self.cp.movement) {
            Some(M::Passing) => match way {
                Way::Beside(_) => 3,
                Way::Behind => 2,
                Way::Opposite => 0,
                Way::Ahead | Way::Cross(_) => -3,
            },
            Some(M::ChangingLanes | M::Merging | M::LaneDeparture) => match way {
                Way::Beside(_) => 3,
                Way::Behind | Way::Ahead => 0,
                Way::Opposite | Way::Cross(_) => -2,
            },
            Some(M::CrossingIntoOpposingLane | M::WrongWay) => match way {
                Way::Opposite => 2,
                // Who passes in the opposing lane is told so too.
                Way::Cross(_) | Way::Beside(_) | Way::Behind => 0,
                Way::Ahead => -3,
            },
            Some(M::Backing) => match way {
                Way::Ahead => 2,
                Way::Cross(_) => 1,
                Way::Beside(_) => 0,
                Way::Behind | Way::Opposite => -2,
            },
            Some(M::LeftTurn | M::UTurn) => match way {
                Way::Opposite => 2,
                Way::Cross(_) => 1,
                Way::Beside(_) => 0,
                Way::Behind | Way::Ahead => -1,
            },
            Some(M::RightTurn) => match way {
                Way::Cross(_) | Way::Beside(_) => 1,
                _ => 0,
            },
            Some(M::EnteringTraffic) => match way {
                Way::Cross(_) => 2,
                Way::Beside(_) => 0,
                _ => -1,
            },
            Some(M::Parked) => match way {
                Way::Beside(_) | Way::Ahead => 1,
                // Pushed into one that stands, or met by one that backs.
                Way::Behind
                    if told(&self.sv.state).is_some_and(|state| state.stands() || state == ContactState::Reversing) =>
                {
                    1
                }
                _ => -6,
            },
            Some(M::NmCrossing) => match way {
                Way::Cross(_) => 3,
                Way::Ahead => 0,
                _ => -2,
            },
            _ => 0,
        }
    }

    /// How it goes with the movement of the subject vehicle.
    fn of_own(&self, way: Way) -> i32 {
        use Movement as M;
        match told(&self.sv.movement) {
            Some(M::ChangingLanes | M::Merging) => match way {
                Way::Beside(_) => 2,
                Way::Behind | Way::Ahead => 0,
                Way::Opposite | Way::Cross(_) => -1,
            },
            Some(M::LeftTurn) if way == Way::Opposite => 2,
            Some(M::EnteringTraffic) if matches!(way, Way::Cross(_)) => 2,
            _ => 0,
        }
    }

    /// How it goes with a pass that is told, and is not the movement.
    fn of_passing(&self, way: Way) -> i32 {
        match way {
            _ if told(&self.cp.movement) == Some(Movement::Passing) || !self.cp.did(Act::Pass) => 0,
            Way::Behind | Way::Beside(_) => 2,
            Way::Opposite => 0,
            Way::Ahead | Way::Cross(_) => -2,
        }
    }

    /// In one lane the front of one touches the rear of the other.
    fn of_one_lane(&self, way: Way) -> i32 {
        use Movement as M;
        let touched = |face: i32| self.cp.zones.iter().any(|zone| faces(zone.value).contains(&face));
        let forward = !matches!(told(&self.cp.movement), Some(M::Backing | M::ParkingManeuver | M::Parked));
        match way {
            Way::Ahead if forward && touched(0) && !touched(4) => -3,
            Way::Behind if forward && touched(4) && !touched(0) => -3,
            _ => 0,
        }
    }

    /// How it goes with the road.
    fn of_road(&self, way: Way) -> i32 {
        match (told(&self.place.kind), way) {
            (Some(PlaceKind::Highway), Way::Opposite | Way::Cross(_)) => -3,
            (Some(PlaceKind::Intersection | PlaceKind::ParkingLot), Way::Cross(_)) => 1,
            _ => 0,
        }
    }

    fn weigh(&self, way: Way) -> i32 {
        self.touches(way) + self.stands_there(way) + self.moves(way)
    }
}

/// The range of directions that a turn gives, in eighths of a turn clockwise.
fn turn(party: &Party) -> (i32, i32) {
    let mut range = (0, 0);
    let mut add = |side: Option<LeftRight>, eighths: i32| match side {
        Some(LeftRight::Left) => range.0 = range.0.min(-eighths),
        Some(LeftRight::Right) => range.1 = range.1.max(eighths),
        None => {}
    };
    match told(&party.movement) {
        Some(Movement::LeftTurn) => add(Some(LeftRight::Left), 2),
        Some(Movement::RightTurn) => add(Some(LeftRight::Right), 2),
        Some(Movement::UTurn) => add(Some(LeftRight::Left), 4),
        _ => {}
    }
    for fact in party.acts.iter().filter(|fact| !fact.after_contact) {
        match fact.act {
            Act::Turn => add(fact.side, 2),
            Act::UTurn => add(Some(LeftRight::Left), 4),
            _ => {}
        }
    }
    range
}

/// What the words add to the origin that they tell.
const TOLD: i32 = 8;

/// What a rule of the words adds: lanes, directions.
const BY_RULE: i32 = 4;

/// What the side of a turning vehicle adds.
const BY_TURN: i32 = 7;

/// What columns alone add.
const BY_COLUMNS: i32 = 1;

/// The least weight of an origin that nobody tells.
const UNTOLD: i32 = 3;

/// The name of the rule.
const RULE: &str = "the picture of zones, movements and road";

/// Holds an origin against the picture: another one where the picture of the told one is impossible and that one's is good,
/// and one where none is told. `None`: it stays as it is.
pub(crate) fn settle(account: &Account) -> Option<Fact<Origin>> {
    let cp = account.partner.as_ref()?;
    let group = told(&cp.kind).map(Kind::group);
    if matches!(group, Some(KindGroup::Object | KindGroup::Animal)) {
        return None;
    }
    // Across its rear, as told.
    let by_words = account.came_from.as_ref().is_some_and(|fact| fact.source.is_told());
    let rear = !account.sv.zones.is_empty() && account.sv.zones.iter().all(|zone| zone.value.is_rear());
    if by_words && rear && matches!(told(&account.came_from), Some(Origin::Cross { .. })) {
        return None;
    }
    let scene = Scene { sv: &account.sv, cp, place: &account.place };
    let (weight, way) = WAYS
        .iter()
        .map(|&way| (scene.weigh(way), way))
        .max_by_key(|(weight, way)| (*weight, std::cmp::Reverse(*way)))?;
    let origin = match &account.came_from {
        None => scene.untold(weight, way)?.origin(),
        Some(now) => match Way::of(now.value) {
            None => scene.with_side(now.value)?,
            Some(told_way) => {
                // From the kerb is beside and across at once; from behind may mean beside, where it is met.
                let kin = match (told_way, now.value) {
                    (Way::Cross(side), Origin::Parked { .. }) => scene.weigh(Way::Beside(side)),
                    _ => i32::MIN,
                };
                let have = scene.weigh(told_way).max(kin) + prior(&now.source);
                let same_family = matches!((told_way, way), (Way::Behind, Way::Beside(_)));
                (weight > have && !same_family).then(|| way.origin())?
            }
        },
    };
    Some(Fact::by_rule(origin, RULE))
}

/// What the source of an origin adds to its weight.
fn prior(source: &Source) -> i32 {
    match source {
        Source::Rule { name } if name.starts_with("zones") => BY_COLUMNS,
        Source::Rule { name } if name.contains("turning vehicle") => BY_TURN,
        Source::Rule { .. } | Source::Column { .. } => BY_RULE,
        _ => TOLD,
    }
}

impl Scene<'_> {
    /// The heaviest way, where nobody tells any; left and right that weigh the same are told by nobody.
    fn untold(&self, weight: i32, way: Way) -> Option<Way> {
        let tie = way.mirrored().is_some_and(|mirrored| self.weigh(mirrored) == weight);
        let lane = [Way::Behind, Way::Ahead].into_iter().find(|lane| tie && self.weigh(*lane) >= UNTOLD);
        lane.or((weight >= UNTOLD && !tie).then_some(way))
    }

    /// An origin whose side nobody told gets the side, and stays what it is.
    fn with_side(&self, origin: Origin) -> Option<Origin> {
        let left = self.weigh(Way::Cross(LeftRight::Left)).max(self.weigh(Way::Beside(LeftRight::Left)));
        let right = self.weigh(Way::Cross(LeftRight::Right)).max(self.weigh(Way::Beside(LeftRight::Right)));
        let side = match (turned_towards(self.sv, self.cp), left.cmp(&right)) {
            (Some(met), _) => met.other(),
            (None, std::cmp::Ordering::Greater) => LeftRight::Left,
            (None, std::cmp::Ordering::Less) => LeftRight::Right,
            (None, std::cmp::Ordering::Equal) => return None,
        };
        let side = Some(side);
        Some(match origin {
            Origin::Stall { .. } => Origin::Stall { side },
            Origin::Driveway { .. } => Origin::Driveway { side },
            Origin::Parked { .. } => Origin::Parked { side },
            Origin::Sidewalk { .. } => Origin::Sidewalk { side },
            _ => return None,
        })
    }
}

/// The side of a place out of which one turned that met a standing one with its left on the left: of a turn to the right, the left.
fn turned_towards(sv: &Party, cp: &Party) -> Option<LeftRight> {
    let on_left = |party: &Party| {
        let left = |zone: &Z| matches!(zone, Z::Left | Z::FrontLeft | Z::RearLeft);
        let zones = party.zone_values();
        zones.iter().any(left) && zones.iter().all(|zone| left(zone) || *zone == Z::Front)
    };
    let turned = cp.acts.iter().find(|fact| fact.act == Act::Turn && !fact.after_contact)?;
    let stands = told(&sv.state).is_some_and(ContactState::stands);
    turned.side.map(LeftRight::other).filter(|_| stands && on_left(sv) && on_left(cp))
}

#[cfg(test)]
mod tests {
    use super::*;
    use LeftRight::{Left, Right};

    fn party(zones: &[Z], movement: Movement) -> Party {
        let state = match movement {
            Movement::Stopped => ContactState::Stopped,
            Movement::Backing => ContactState::Reversing,
            _ => ContactState::Moving,
        };
        Party {
            zones: zones.iter().map(|zone| Fact::by_rule(*zone, "made")).collect(),
            movement: Some(Fact::by_rule(movement, "made")),
            state: Some(Fact::by_rule(state, "made")),
            ..Party::default()
        }
    }

    /// The heaviest of all origins.
    fn best(sv: (&[Z], Movement), cp: (&[Z], Movement)) -> Way {
        let (sv, cp, place) = (party(sv.0, sv.1), party(cp.0, cp.1), Place::default());
        let scene = Scene { sv: &sv, cp: &cp, place: &place };
        WAYS.into_iter().max_by_key(|way| (scene.weigh(*way), std::cmp::Reverse(*way))).unwrap()
    }

    #[test]
    fn sides_tell_the_direction() {
        let stands = Movement::Stopped;
        let on = Movement::Straight;
        assert_eq!(best((&[Z::Left], stands), (&[Z::Left], on)), Way::Opposite);
        assert_eq!(best((&[Z::Left], stands), (&[Z::Right], on)), Way::Beside(Left));
        assert_eq!(best((&[Z::Right], stands), (&[Z::Left], on)), Way::Beside(Right));
        assert_eq!(best((&[Z::Rear], stands), (&[Z::Front], on)), Way::Behind);
        assert_eq!(best((&[Z::Front], on), (&[Z::Rear], on)), Way::Ahead);
        assert_eq!(best((&[Z::Left], on), (&[Z::Front], on)), Way::Cross(Left));
        assert_eq!(best((&[Z::Right], on), (&[Z::Front], on)), Way::Cross(Right));
        assert_eq!(best((&[Z::Front], on), (&[Z::Right], on)), Way::Cross(Left));
    }

    #[test]
    fn a_turn_turns_the_sides() {
        // Across from the other direction: its front meets the right side of who turns left.
        assert_eq!(best((&[Z::Right], Movement::LeftTurn), (&[Z::Front], Movement::Straight)), Way::Opposite);
        // Who turns right out of the lane on the left shows its right side.
        assert_eq!(best((&[Z::FrontLeft], Movement::Straight), (&[Z::Right], Movement::RightTurn)), Way::Beside(Left));
    }

    #[test]
    fn movements_weigh_where_zones_do_not() {
        assert_eq!(best((&[Z::RearLeft], Movement::Stopped), (&[], Movement::Passing)), Way::Beside(Left));
        assert_eq!(best((&[], Movement::Straight), (&[], Movement::NmCrossing)), Way::Cross(Left));
        assert_eq!(best((&[Z::Front], Movement::Stopped), (&[], Movement::Backing)), Way::Ahead);
    }
}
