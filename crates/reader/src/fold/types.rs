//! What kind of crash it is: type and first contact, each by a rule over the facts
//! (`docs/models/crash-types.md`).

use super::Reading;
use super::party::{has_zone, movement_column};
use crate::lexicon::Sense;
use recrash_model::account::{
    Account, Act, ContactState, CrashType, Fact, FirstContact, Kind, KindGroup, LaneWord, LeftRight, Origin, Party,
    told,
};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone as Z;

pub(super) fn group(account: &Account) -> Option<KindGroup> {
    account.partner.as_ref().and_then(|partner| told(&partner.kind)).map(Kind::group)
}

pub(super) fn sv_state(account: &Account) -> Option<ContactState> {
    told(&account.sv.state)
}

pub(super) fn cp_state(account: &Account) -> Option<ContactState> {
    account.partner.as_ref().and_then(|partner| told(&partner.state))
}

/// Whether a turn of this side is under way at the contact: told last but for slowing and stopping.
pub(crate) fn turning(party: &Party) -> bool {
    let before: Vec<_> = party.acts.iter().filter(|fact| !fact.after_contact).collect();
    let Some(last) = before.iter().rposition(|fact| fact.act.turns()) else { return false };
    let later = &before[last + 1..];
    let done = match &before[last].source {
        recrash_model::account::Source::Words { text, .. } => {
            let text = text.to_lowercase();
            text.starts_with("completed") || text.starts_with("had ") || text.starts_with("finished")
        }
        _ => false,
    };
    !done
        && !later.iter().any(|fact| {
            matches!(fact.act, Act::Follow | Act::PullOver | Act::Park | Act::Pass | Act::Reverse | Act::LaneChange)
        })
}

/// The crash type: the first whose rule fits.
pub(crate) fn crash_type(reading: &Reading<'_>, account: &Account) -> Option<Fact<CrashType>> {
    let (value, name) = type_of(reading, account)?;
    Some(Fact::by_rule(value, name))
}

/// A crash and who took part in it.
struct Case<'a> {
    reading: &'a Reading<'a>,
    account: &'a Account,
    partner: &'a Party,
    sv: Option<ContactState>,
    cp: Option<ContactState>,
    /// A turn of the subject vehicle, or of the partner, is under way.
    sv_turns: bool,
    cp_turns: bool,
}

type Said = Option<(CrashType, &'static str)>;
type Rule = fn(&Case<'_>) -> Said;

const RULES: [Rule; 9] = [
    |case| case.thing(),
    |case| case.thrown(),
    |case| case.by_kind(),
    |case| case.not_touched(),
    |case| case.parked(),
    |case| case.backwards(),
    |case| case.door(),
    |case| case.along_the_side(),
    |case| case.by_origin(),
];

const FRONT_TO_REAR: Said = Some((CrashType::FrontToRear, "front on rear, one way"));
const LATERAL: Said = Some((CrashType::Lateral, "one way, side by side"));
const TURNED_ACROSS: Said = Some((CrashType::Intersection, "one turned across the other"));
const HEAD_ON: Said = Some((CrashType::HeadOn, "from opposite directions"));
const CROSSING: Said = Some((CrashType::Intersection, "crossing paths"));

fn type_of(reading: &Reading<'_>, account: &Account) -> Said {
    let partner = account.partner.as_ref()?;
    let (sv, cp) = (sv_state(account), cp_state(account));
    let (sv_turns, cp_turns) = (turning(&account.sv), turning(partner));
    let case = Case { reading, account, partner, sv, cp, sv_turns, cp_turns };
    RULES.iter().find_map(|rule| rule(&case))
}

fn front(party: &Party) -> bool {
    has_zone(party, Z::is_front)
}

fn rear(party: &Party) -> bool {
    has_zone(party, Z::is_rear)
}

impl Case<'_> {
    fn sv_stands(&self) -> bool {
        self.sv.is_some_and(ContactState::stands)
    }

    /// The partner moved over.
    fn sideways(&self) -> bool {
        [Act::LaneChange, Act::Swerve, Act::Drift].into_iter().any(|act| self.partner.did(act))
    }

    fn rear_end(&self) -> bool {
        let frames = &self.reading.story.frames;
        self.reading.contacts.first.is_some_and(|number| frames[number].sense == Sense::RearEnd)
    }

    fn thing(&self) -> Said {
        if group(self.account) != Some(KindGroup::Object) {
            return None;
        }
        Some(if told(&self.partner.kind) == Some(Kind::Cargo) || off_a_vehicle(self.reading) {
            (CrashType::Other, "cargo")
        } else {
            (CrashType::SingleVehicle, "a thing")
        })
    }

    fn thrown(&self) -> Said {
        let contacts = &self.reading.contacts;
        let touched = || self.account.others.iter().any(|other| other.touched_partner);
        let backs = self.partner.did(Act::Reverse) || self.cp == Some(ContactState::Reversing);
        let thrown = self.partner.did(Act::Pushed) && !backs
            || !contacts.earlier.is_empty() && touched()
            || separate(self.reading)
            || of_a_crash(self.reading);
        (!contacts.others_only && thrown && !drove_on(self.reading))
            .then_some((CrashType::Secondary, "another contact threw the partner at it"))
    }

    fn by_kind(&self) -> Said {
        let crash_type = match group(self.account)? {
            KindGroup::OnFoot => CrashType::Pedestrian,
            KindGroup::Cyclist => CrashType::Cyclist,
            KindGroup::Motorcycle => CrashType::Motorcycle,
            KindGroup::Animal | KindGroup::Other => CrashType::Other,
            _ => return None,
        };
        Some((crash_type, "kind of the partner"))
    }

    fn not_touched(&self) -> Said {
        self.reading.contacts.others_only.then_some((CrashType::Other, "the subject vehicle was not touched"))
    }

    fn parked(&self) -> Said {
        let moves = self.sv.is_some_and(|state| !state.stands() && state != ContactState::Reversing);
        (self.cp == Some(ContactState::Parked)
            && moves
            && !self.partner.did(Act::PullOut)
            && !double_parked(self.reading)
            && self.account.door.is_none())
        .then_some((CrashType::SingleVehicle, "an unoccupied parked vehicle"))
    }

    fn backwards(&self) -> Said {
        let backs = match told(&self.partner.movement) {
            Some(Movement::Backing) => true,
            Some(Movement::ParkingManeuver) => self.partner.did(Act::Reverse),
            _ => false,
        };
        (backs || [self.sv, self.cp].contains(&Some(ContactState::Reversing)))
            .then_some((CrashType::Backing, "one went backwards"))
    }

    fn door(&self) -> Said {
        self.account.door.is_some().then_some((CrashType::Other, "a door"))
    }

    /// Words for a touch along the side: "sideswiped", "grazed".
    fn along_the_side(&self) -> Said {
        let story = &self.reading.story;
        let along = self.reading.contacts.first.is_some_and(|number| {
            let word = story.tokens[story.frames[number].first].text.as_str();
            ["swip", "side", "scrap", "graz", "brush"].iter().any(|stem| word.starts_with(stem))
        });
        (along
            && matches!(told(&self.account.came_from), Some(Origin::Behind | Origin::Ahead))
            && !(rear(&self.account.sv) && front(self.partner))
            && !front_rear(self.account))
        .then_some((CrashType::Lateral, "a touch along the side"))
    }

    /// By where the partner came from, and which of the two turned.
    fn by_origin(&self) -> Said {
        match told(&self.account.came_from) {
            Some(Origin::Behind) => self.comes_from_behind(),
            Some(Origin::Ahead) => self.comes_from_ahead(),
            Some(Origin::Opposite) => self.comes_from_opposite(),
            Some(Origin::Beside { .. }) => self.comes_from_beside(),
            // It had turned into the road of the one that stands, and passed it left side on left side.
            Some(Origin::Cross { .. })
                if self.sv_stands()
                    && self.partner.did(Act::Turn)
                    && !self.cp_turns
                    && on_left(&self.account.sv)
                    && on_left(self.partner) =>
            {
                HEAD_ON
            }
            Some(Origin::Cross { .. } | Origin::Sidewalk { .. }) => CROSSING,
            Some(Origin::Stall { .. } | Origin::Driveway { .. }) => {
                Some((CrashType::Intersection, "out of a stall or a driveway"))
            }
            Some(Origin::Parked { .. }) => Some((CrashType::Lateral, "from the kerb beside it")),
            Some(Origin::Above) | None => by_columns(self.reading, self.account),
        }
    }

    fn comes_from_behind(&self) -> Said {
        let (sv, partner) = (&self.account.sv, self.partner);
        let passes = partner.did(Act::Pass);
        let at_rear = rear(sv) && (front(partner) || partner.zones.is_empty() && !passes);
        if self.rear_end() || at_rear {
            let passing = passes && !square(self.account);
            return if passing { Some((CrashType::Lateral, "it passed")) } else { FRONT_TO_REAR };
        }
        let flank = !sv.zones.is_empty() && !front(sv) && !rear(sv);
        if self.sv_turns && !self.sv_stands() && (flank || front(sv)) {
            return TURNED_ACROSS;
        }
        if sv.zones.is_empty() && partner.zones.is_empty() && !passes && !self.sideways() {
            return Some((CrashType::FrontToRear, "from behind"));
        }
        if self.cp_turns && turned_across(self.account) { TURNED_ACROSS } else { LATERAL }
    }

    fn comes_from_ahead(&self) -> Said {
        let (sv, partner) = (&self.account.sv, self.partner);
        if self.cp_turns && !front_rear(self.account) {
            return TURNED_ACROSS;
        }
        let (none, straight) = (sv.zones.is_empty(), !self.sideways());
        let on_its_way = straight && !sv.did(Act::Pass);
        let at_rear = self.rear_end()
            || front_rear(self.account)
            || front(sv) && (partner.zones.is_empty() || on_its_way)
            || none && rear(partner) && straight
            || none && partner.zones.is_empty() && on_its_way;
        if at_rear { FRONT_TO_REAR } else { LATERAL }
    }

    fn comes_from_opposite(&self) -> Said {
        let (sv, partner) = (&self.account.sv, self.partner);
        let movement = told(&partner.movement);
        let sv_left = self.sv_turns && turn_side(sv) == Some(LeftRight::Left);
        let column = told(&sv.movement) == Some(Movement::LeftTurn) && turn_side(sv).is_none();
        let cp_left = self.cp_turns && turn_side(partner) == Some(LeftRight::Left);
        let straight = movement.is_none_or(|movement| movement == Movement::Straight);
        let cp_somewhere = self.cp_turns && turn_side(partner).is_none() && straight;
        let cp_column = movement == Some(Movement::LeftTurn) && !partner.did(Act::Turn);
        let across = column
            || sv_left
            || cp_left
            || movement == Some(Movement::UTurn)
            || !self.sv_turns && (cp_somewhere || cp_column);
        // Left side on left side they passed each other, and only then it turned, or began to.
        let left = |party: &Party, corner: bool| {
            let left = |zone: Z| matches!(zone, Z::Left | Z::RearLeft) || corner && zone == Z::FrontLeft;
            !party.zones.is_empty() && party.zones.iter().all(|zone| left(zone.value))
        };
        let begun = partner.acts.iter().any(|fact| fact.act == Act::Turn && fact.begun);
        let abreast = left(sv, true) && left(partner, false) && (begun || partner.did(Act::Pass));
        if across && !abreast { TURNED_ACROSS } else { HEAD_ON }
    }

    fn comes_from_beside(&self) -> Said {
        let (sv, partner) = (&self.account.sv, self.partner);
        let both_turned = sv.did(Act::Turn) && partner.did(Act::Turn) || turn_together(self.account);
        let one_turns = self.sv_turns != self.cp_turns && !both_turned;
        if one_turns && !(self.sv_turns && self.sv_stands()) {
            return TURNED_ACROSS;
        }
        let at_rear = rear(sv) && front(partner) && square(self.account);
        if at_rear && !self.sideways() { FRONT_TO_REAR } else { LATERAL }
    }
}

/// Whether the thing came off a vehicle that drove: "a ladder dropped off the pickup".
fn off_a_vehicle(reading: &Reading<'_>) -> bool {
    let Some(actor) = reading.contacts.partner else { return false };
    let story = &reading.story;
    let vehicle = |word: &str| {
        story.world.actors.iter().skip(1).any(|known| {
            known.kind.is_some_and(Kind::is_vehicle)
                && known.kind_tokens.is_some_and(|(first, end)| {
                    story.tokens[first..end].iter().any(|token| token.text == word && token.text.len() > 2)
                })
        })
    };
    let struck = reading.contacts.first.is_some_and(|first| story.frames[first].who == Some(actor));
    struck
        && reading.before(actor).any(|(number, frame)| {
            let (first, end) = reading.window(number);
            let had = first > 0 && story.tokens[first - 1].text == "had";
            let of_it =
                ["detach", "separat", "broke", "tore"].iter().any(|stem| story.tokens[first].text.starts_with(stem));
            let from = story.tokens[first..end].iter().position(|token| matches!(token.text.as_str(), "from" | "off"));
            frame.act() == Some(Act::Fall)
                && frame.happened()
                && !had
                && !of_it
                && from.is_some_and(|at| story.tokens[first + at..end].iter().take(8).any(|token| vehicle(&token.text)))
        })
}

/// Whether the partner is one of several that collided: "Two vehicles collided. One of them spun into it".
fn of_a_crash(reading: &Reading<'_>) -> bool {
    let (Some(first), Some(partner)) = (reading.contacts.first, reading.contacts.partner) else { return false };
    let group = reading.story.world.actors[partner].group;
    group.is_some()
        && reading.story.frames[..first]
            .iter()
            .any(|frame| frame.is_contact() && frame.who == group && frame.object != Some(crate::world::SUBJECT))
}

/// Whether both go the same way round a corner, in lanes side by side: told as a turn, as a turn to come, or by the lane for it.
fn turn_together(account: &Account) -> bool {
    let way = |party: &Party| {
        let lane = party.lane.as_ref().and_then(|lane| match lane.value {
            LaneWord::LeftTurn => Some(LeftRight::Left),
            LaneWord::RightTurn => Some(LeftRight::Right),
            _ => None,
        });
        let movement = match told(&party.movement) {
            Some(Movement::LeftTurn) => Some(LeftRight::Left),
            Some(Movement::RightTurn) => Some(LeftRight::Right),
            _ => None,
        };
        turn_side(party).or(movement).or(lane)
    };
    let Some(partner) = &account.partner else { return false };
    way(&account.sv).is_some_and(|side| way(partner) == Some(side))
}

pub(crate) fn turn_side(party: &Party) -> Option<LeftRight> {
    party.acts.iter().rev().filter(|fact| !fact.after_contact).find_map(|fact| match fact.act {
        Act::Turn => fact.side,
        Act::UTurn => Some(LeftRight::Left),
        _ => None,
    })
}

/// Touched on the left, corners too.
fn on_left(party: &Party) -> bool {
    !party.zones.is_empty() && party.zones.iter().all(|zone| matches!(zone.value, Z::Left | Z::FrontLeft | Z::RearLeft))
}

/// The plain rear on the plain front.
fn square(account: &Account) -> bool {
    let Some(partner) = &account.partner else { return false };
    has_zone(&account.sv, |zone| zone == Z::Rear) && has_zone(partner, |zone| zone == Z::Front)
        || has_zone(&account.sv, |zone| zone == Z::Rear)
}

fn front_rear(account: &Account) -> bool {
    let Some(partner) = &account.partner else { return false };
    has_zone(&account.sv, |zone| zone.is_front()) && has_zone(partner, |zone| zone.is_rear())
}

fn turned_across(account: &Account) -> bool {
    has_zone(&account.sv, |zone| zone.is_front())
}

fn double_parked(reading: &Reading<'_>) -> bool {
    reading.story.tokens.windows(2).any(|pair| pair[0].text == "double" && pair[1].text == "parked")
}

/// Whether the partner touched somebody, and then went on of its own accord before it came to the subject vehicle.
fn drove_on(reading: &Reading<'_>) -> bool {
    let (Some(first), Some(partner)) = (reading.contacts.first, reading.contacts.partner) else { return false };
    let frames = &reading.story.frames;
    let earlier: Vec<usize> = reading.contacts.earlier.iter().copied().filter(|&number| number < first).collect();
    let struck_others = !earlier.is_empty() && earlier.iter().all(|&number| frames[number].who == Some(partner));
    struck_others
        && frames[earlier[earlier.len() - 1] + 1..first].iter().any(|frame| {
            frame.who == Some(partner)
                && frame.happened()
                && matches!(frame.act(), Some(Act::Follow | Act::Pass | Act::Turn | Act::Enter | Act::SetOff))
        })
}

/// "was involved in a separate collision", told up to the crash.
fn separate(reading: &Reading<'_>) -> bool {
    let end = reading
        .contacts
        .first
        .map_or(usize::MAX, |number| reading.story.sentences[reading.story.frames[number].sentence].end);
    let tokens = &reading.story.tokens[..end.min(reading.story.tokens.len())];
    tokens.windows(2).any(|pair| {
        matches!(pair[0].text.as_str(), "separate" | "previous" | "another")
            && matches!(pair[1].text.as_str(), "collision" | "crash")
    })
}

/// Where nobody tells from where the partner came: by zones and movement columns.
fn by_columns(reading: &Reading<'_>, account: &Account) -> Option<(CrashType, &'static str)> {
    let partner = account.partner.as_ref()?;
    let rule = "zones and movement columns";
    let cp = told(&partner.movement).or_else(|| movement_column(reading));
    let sv = told(&account.sv.movement).or_else(|| reading.record.sv_movement.known());
    let turn = |movement| matches!(movement, Some(Movement::LeftTurn | Movement::RightTurn | Movement::UTurn));
    if matches!(
        cp,
        Some(
            Movement::ChangingLanes
                | Movement::Passing
                | Movement::Merging
                | Movement::LaneDeparture
                | Movement::EnteringTraffic
                | Movement::ParkingManeuver
        )
    ) {
        return Some((CrashType::Lateral, rule));
    }
    if matches!(cp, Some(Movement::CrossingIntoOpposingLane | Movement::WrongWay)) {
        return Some((CrashType::HeadOn, rule));
    }
    if turn(cp) || turn(sv) {
        return Some((CrashType::Intersection, rule));
    }
    if matches!(sv, Some(Movement::ChangingLanes | Movement::Merging | Movement::Passing)) {
        return Some((CrashType::Lateral, rule));
    }
    let sides = |party: &Party| !party.zones.is_empty() && !has_zone(party, |zone| zone.is_front() || zone.is_rear());
    if sides(&account.sv)
        && has_zone(partner, |zone| zone.is_front())
        && reading.record.road.known() == Some(recrash_model::template::RoadType::Intersection)
    {
        return Some((CrashType::Intersection, rule));
    }
    if account.sv.zones.is_empty() && partner.zones.is_empty() {
        return None;
    }
    if has_zone(&account.sv, |zone| zone.is_front())
        && has_zone(partner, |zone| !zone.is_front() && !zone.is_rear())
        && reading.record.road.known() == Some(recrash_model::template::RoadType::Intersection)
    {
        return Some((CrashType::Intersection, rule));
    }
    Some((CrashType::Lateral, rule))
}

/// First harmful contact.
pub(crate) fn first_contact(reading: &Reading<'_>, account: &Account) -> Option<Fact<FirstContact>> {
    account.partner.as_ref()?;
    let rule = |value, name: &str| Some(Fact::by_rule(value, name));
    if reading.contacts.others_only {
        return rule(FirstContact::OthersOnly, "contacts of the story");
    }
    let touched_others = reading.contacts.first.is_some_and(|first| {
        let partner = reading.contacts.partner;
        let of_partner = |number: &usize| {
            let frame = &reading.story.frames[*number];
            *number < first && (frame.who == partner || frame.object == partner)
        };
        reading.contacts.earlier.iter().any(of_partner)
    });
    if touched_others || told(&account.crash_type) == Some(CrashType::Secondary) {
        return rule(FirstContact::PartnerAndOther, "contacts of the story");
    }
    if told(&account.crash_type) == Some(CrashType::SingleVehicle) || group(account) == Some(KindGroup::Object) {
        return rule(FirstContact::Object, "a thing, or a vehicle with nobody in it");
    }
    rule(FirstContact::SvAndPartner, "contacts of the story")
}
