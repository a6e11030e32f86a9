//! Who moved into whom (`docs/models/crash-types.md`).

use super::Reading;
use super::party::has_zone;
use super::types::{cp_state, group, sv_state, turning};
use crate::frame::Frame;
use crate::lexicon::Sense;
use crate::world::SUBJECT;
use recrash_model::account::{Account, Act, ContactState, Fact, Kind, KindGroup, Origin, Party, Source, Striker, told};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone as Z;

/// Rule of a striker who comes to one that backs away.
const BACKED_AWAY: &str = "it backed away from one that came";

/// Rule of a striker by whose front touches whose side.
const FRONT_ON_SIDE: &str = "the front of one on the side of the other";

/// Rule of a striker of whom the words say nothing.
const BY_FRONTS: &str = "whose front took part";

fn by_rule(value: Striker, name: &str) -> Option<Fact<Striker>> {
    Some(Fact::by_rule(value, name))
}

fn rule_of(account: &Account) -> Option<&str> {
    match &account.striker {
        Some(Fact { source: Source::Rule { name }, .. }) => Some(name),
        _ => None,
    }
}

/// Whether the subject vehicle backed away from who struck it.
pub(super) fn struck_who_backed_away(account: &Account) -> bool {
    rule_of(account) == Some(BACKED_AWAY)
}

/// Whether zones alone tell who struck.
pub(super) fn of_zones_alone(account: &Account) -> bool {
    matches!(rule_of(account), Some(BY_FRONTS | FRONT_ON_SIDE))
}

/// Who moved into whom: a thing, a door, who stood, and then by the words of the contact and the zones of both.
pub(crate) fn striker(reading: &Reading<'_>, account: &Account) -> Option<Fact<Striker>> {
    let partner = account.partner.as_ref()?;
    if group(account) == Some(KindGroup::Object) {
        return of_thing(reading, account, partner);
    }
    if let Some(door) = by_door(reading, account) {
        return Some(door);
    }
    let (sv, cp) = (sv_state(account), cp_state(account));
    let sv_stands = sv.is_some_and(ContactState::stands);
    let cp_stands = cp.is_some_and(ContactState::stands) && !partner.did(Act::OpenDoor);
    match (sv_stands, cp_stands) {
        (true, false) => return by_rule(Striker::Cp, "one stood"),
        (false, true) => return by_rule(Striker::Sv, "one stood"),
        _ => {}
    }
    let Some(number) = reading.contacts.first else { return by_fronts(account) };
    let frame = &reading.story.frames[number];
    if meet(reading, frame) && !sv_stands || both_fronts_told(reading, account, number) {
        return Some(Fact { value: Striker::Both, source: reading.of(frame) });
    }
    // "It entered, making contact with the front of the other": the front moved into the side.
    let crossing = matches!(told(&account.came_from), Some(Origin::Cross { .. } | Origin::Opposite));
    if let (true, Some(front)) = (crossing, front_on_flank(account)) {
        return by_rule(front, FRONT_ON_SIDE);
    }
    if let Some(both) = converge(account) {
        return Some(both);
    }
    // Who backs away is met at its front by who comes.
    let alone = frame.who == Some(SUBJECT) && frame.object.is_some();
    let fore = |party: &Party| !party.zones.is_empty() && party.zones.iter().all(|zone| zone.value.is_front());
    if sv == Some(ContactState::Reversing) && fore(&account.sv) && !alone {
        return by_rule(Striker::Cp, BACKED_AWAY);
    }
    if let Some(came) = came_over(account).filter(|_| is_between(reading, frame)) {
        return by_rule(came, "who came over, of two of whom neither is said to have struck");
    }
    let value = match (frame.who, frame.object) {
        (Some(SUBJECT), _) if rear_was_met(account) && !runs_over(reading, frame, account) => Striker::Cp,
        (Some(SUBJECT), _) => Striker::Sv,
        (Some(_), _) | (None, Some(SUBJECT)) => Striker::Cp,
        (None, Some(_)) => Striker::Sv,
        (None, None) => return by_fronts(account),
    };
    Some(Fact { value, source: reading.of(frame) })
}

/// Things do not move, unless they are told to.
fn of_thing(reading: &Reading<'_>, account: &Account, partner: &Party) -> Option<Fact<Striker>> {
    let acts = [Act::Fall, Act::Roll, Act::Pushed].into_iter().any(|act| partner.did(act));
    // "The gate swung open and touched it".
    let swung = told(&partner.kind) == Some(Kind::Gate)
        && partner.did(Act::OpenDoor)
        && reading.contacts.first.is_some_and(|number| reading.story.frames[number].who == reading.contacts.partner);
    let flies = !is_fixed(partner) && (acts || came_down(reading)) || swung;
    match (flies, sv_state(account).is_some_and(ContactState::stands)) {
        (true, true) => by_rule(Striker::Cp, "a thing that moves into one that stands"),
        (true, false) if struck_thing(reading) => by_rule(Striker::Sv, "it struck a thing that came into its way"),
        (true, false) => by_rule(Striker::Cp, "a thing that moves into one that moves"),
        _ => by_rule(Striker::Sv, "things do not move"),
    }
}

/// Whose door was opened into the other.
fn by_door(reading: &Reading<'_>, account: &Account) -> Option<Fact<Striker>> {
    let door = account.door.as_ref()?;
    let frame = &reading.story.frames[reading.contacts.first?];
    let touches = match door.value {
        Striker::Sv => frame.who == Some(SUBJECT),
        Striker::Cp => frame.who == reading.contacts.partner && frame.with.is_some(),
        Striker::Both => false,
    };
    touches.then(|| door.clone())
}

/// "the vehicles met".
fn meet(reading: &Reading<'_>, frame: &Frame) -> bool {
    let tokens = &reading.story.tokens;
    let words = &tokens[frame.first..tokens.len().min(frame.end.max(frame.first + 2))];
    frame.sense == Sense::ContactMade
        && frame.who.is_none()
        && words.iter().any(|token| matches!(token.text.as_str(), "met" | "meet" | "meeting" | "together" | "each"))
}

/// "Contact was between the left side of the AV and the right side of the van": which is named first says nothing.
fn is_between(reading: &Reading<'_>, frame: &Frame) -> bool {
    let words = &reading.story.tokens[frame.first..frame.end];
    frame.sense == Sense::ContactMade && words.iter().any(|token| token.text == "between")
}

/// Who alone of the two left its line.
fn came_over(account: &Account) -> Option<Striker> {
    let over = |party: &Party| [Act::LaneChange, Act::Drift, Act::Swerve].into_iter().any(|act| party.did(act));
    match (over(&account.sv), account.partner.as_ref().is_some_and(over)) {
        (true, false) => Some(Striker::Sv),
        (false, true) => Some(Striker::Cp),
        _ => None,
    }
}

/// "Its front corner and that of the van collided".
fn both_fronts_told(reading: &Reading<'_>, account: &Account, number: usize) -> bool {
    let frames = &reading.story.frames;
    let frame = &frames[number];
    let is_twin = |other: &&Frame| {
        other.first == frame.first && other.is_contact() && other.who.is_some() && other.who != frame.who
    };
    let before = number.checked_sub(1).map(|before| &frames[before]);
    let twin = before.into_iter().chain(frames.get(number + 1)).find(is_twin);
    let front = |party: &Party| has_zone(party, |zone| zone.is_front());
    twin.is_some_and(|other| [other.who, frame.who].contains(&Some(SUBJECT)))
        && front(&account.sv)
        && account.partner.as_ref().is_some_and(front)
}

/// "The rear of the subject vehicle made contact with the front of the car": who moved forward into whom.
fn rear_was_met(account: &Account) -> bool {
    let over = [Act::LaneChange, Act::Drift, Act::Swerve].into_iter().any(|act| account.sv.did(act));
    let plain = has_zone(&account.sv, |zone| zone == Z::Rear);
    let rear = has_zone(&account.sv, |zone| zone.is_rear()) && (plain || !over);
    rear && sv_state(account) != Some(ContactState::Reversing)
}

/// "The rear wheel of the AV made contact with the dog" as it went on: a wheel that goes over somebody is not met by it.
fn runs_over(reading: &Reading<'_>, frame: &Frame, account: &Account) -> bool {
    let from = frame.first.saturating_sub(PART_WITHIN).max(reading.story.sentences[frame.sentence].first);
    let wheel = |word: &str| ["tire", "tyre", "wheel"].iter().any(|stem| word.starts_with(stem));
    let by_wheel = reading.story.tokens[from..frame.first].iter().any(|token| wheel(&token.text));
    let small = matches!(group(account), Some(KindGroup::OnFoot | KindGroup::Animal));
    let goes = matches!(sv_state(account), Some(ContactState::Moving | ContactState::SettingOff));
    frame.with.is_some() && by_wheel && small && goes
}

/// The part that touches stands so near before its verb. [tokens]
const PART_WITHIN: usize = 8;

/// Whether the words of the contact say that the partner moved there: "the arm came down on it", "the gate swung into it".
fn came_down(reading: &Reading<'_>) -> bool {
    let Some(number) = reading.contacts.first else { return false };
    let frame = &reading.story.frames[number];
    let word = reading.story.tokens[frame.first].text.as_str();
    let moves = [
        "com", "came", "clos", "lower", "land", "fall", "fell", "swing", "swung", "drop", "toppl", "roll", "blew",
        "blow",
    ];
    let moves =
        moves.iter().chain(&["bounc", "flew", "fly", "slid", "tip", "tumbl"]).any(|stem| word.starts_with(stem));
    let comes = !(word.starts_with("com") || word.starts_with("came"))
        || reading.story.tokens[frame.first..frame.end].iter().any(|token| token.text == "down");
    let partner = reading.contacts.partner;
    let kind = partner.and_then(|partner| reading.story.world.actors[partner].kind);
    let wheel = kind == Some(Kind::LooseWheel);
    // "was struck by a ball".
    let struck = (word.starts_with("str") || word.starts_with("hit")) && frame.passive && frame.object == Some(SUBJECT);
    let hurled = struck && kind == Some(Kind::Debris);
    frame.who.is_some() && frame.who == partner && (wheel || hurled || moves && comes)
}

/// Whether the words have the subject vehicle, or a part of it, make contact with the thing.
fn struck_thing(reading: &Reading<'_>) -> bool {
    reading.contacts.first.is_some_and(|number| reading.story.frames[number].who == Some(SUBJECT))
}

/// Whether both moved into each other: corner on corner where paths cross, side on side where one of them turns.
fn converge(account: &Account) -> Option<Fact<Striker>> {
    let partner = account.partner.as_ref()?;
    let moving = |state: Option<ContactState>| state == Some(ContactState::Moving);
    if !moving(sv_state(account)) || !moving(cp_state(account)) {
        return None;
    }
    let told_as = |party: &Party, wanted: fn(Z) -> bool| {
        !party.zones.is_empty() && party.zones.iter().all(|zone| wanted(zone.value) && zone.source.is_told())
    };
    let corner = |zone: Z| matches!(zone, Z::FrontLeft | Z::FrontRight);
    let side = |zone: Z| matches!(zone, Z::Left | Z::Right);
    let over = |party: &Party| [Act::LaneChange, Act::Swerve, Act::Drift].into_iter().any(|act| party.did(act));
    let crossing = matches!(told(&account.came_from), Some(Origin::Cross { .. } | Origin::Opposite));
    let turns = turning(&account.sv) || turning(partner);
    let straight = !over(&account.sv) && !over(partner);
    let halts = !partner.did(Act::RunStop);
    if crossing && straight && halts && told_as(&account.sv, corner) && told_as(partner, corner) {
        return Some(Fact::by_rule(Striker::Both, "corner on corner where paths cross"));
    }
    (turns && straight && told_as(&account.sv, side) && told_as(partner, side))
        .then(|| Fact::by_rule(Striker::Both, "side on side where one of them turns"))
}

/// Whose front alone touches a side that is no corner.
fn front_on_flank(account: &Account) -> Option<Striker> {
    let partner = account.partner.as_ref()?;
    let front = |party: &Party| {
        !party.zones.is_empty()
            && party.zones.iter().all(|zone| zone.value.is_front())
            && has_zone(party, |zone| zone == Z::Front)
    };
    let flank = |party: &Party| {
        !party.zones.is_empty()
            && party.zones.iter().all(|zone| matches!(zone.value, Z::Left | Z::Right | Z::RearLeft | Z::RearRight))
    };
    match (front(&account.sv) && flank(partner), front(partner) && flank(&account.sv)) {
        (true, false) => Some(Striker::Sv),
        (false, true) => Some(Striker::Cp),
        _ => None,
    }
}

/// Whose front alone took part moved into the other.
fn by_fronts(account: &Account) -> Option<Fact<Striker>> {
    let partner = account.partner.as_ref()?;
    let over = |party: &Party| {
        [Act::LaneChange, Act::Swerve, Act::Drift].into_iter().any(|act| party.did(act))
            || matches!(
                told(&party.movement),
                Some(Movement::ChangingLanes | Movement::Merging | Movement::LaneDeparture)
            )
    };
    match (over(&account.sv), over(partner)) {
        (true, false) => return Some(Fact::by_rule(Striker::Sv, "who moved over")),
        (false, true) => return Some(Fact::by_rule(Striker::Cp, "who moved over")),
        _ => {}
    }
    let front = |party: &Party| has_zone(party, |zone| zone.is_front());
    let value = match (front(&account.sv), front(partner)) {
        (true, false) => Striker::Sv,
        (false, true) => Striker::Cp,
        _ => return None,
    };
    Some(Fact::by_rule(value, BY_FRONTS))
}

/// Things that stay where they are.
pub(super) fn is_fixed(partner: &Party) -> bool {
    matches!(
        told(&partner.kind),
        Some(Kind::Wall | Kind::Pole | Kind::Curb | Kind::Barrier | Kind::Sign | Kind::Pothole | Kind::Chain)
    )
}
