//! An account told: a short text in plain sentences, and its facts, each with where it stands.

use recrash_model::account::{
    Account, Compass, ContactState, Fact as Told, Kind, KindGroup, LeftRight, Origin as From, Party, Source,
    StandReason, Striker, told,
};
use recrash_model::narrative::{Fact, FactSource, FactValue, NARRATIVE_FORMAT, Narrative, Origin};
use recrash_model::record::RecordRef;
use recrash_model::scenario::{Approach, Author};
use recrash_model::template::Template;
use recrash_model::zones::ContactZone;

/// The narrative of an account: our own sentences, and nothing that the account does not say.
pub fn tell(account: &Account, scenario_id: &str, template: Template) -> Narrative {
    let others = account.reports.iter().filter(|report| **report != account.report);
    Narrative {
        format: NARRATIVE_FORMAT.to_owned(),
        scenario_id: scenario_id.to_owned(),
        template,
        records: std::iter::once(&account.report).chain(others).cloned().collect(),
        text: text(account, template),
        facts: facts(account),
        origin: Origin::Own,
        author: Author::Rules,
    }
}

/// A kind in words.
fn kind_words(kind: Option<Kind>) -> String {
    let Some(kind) = kind else { return "somebody".to_owned() };
    let name = match serde_json::to_value(kind) {
        Ok(serde_json::Value::String(name)) => name.replace('_', " ").replace("suv", "SUV"),
        _ => "vehicle".to_owned(),
    };
    if name == "debris" {
        return name;
    }
    let article = if name == "SUV" || name.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    format!("{article} {name}")
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn reason_words(reason: StandReason) -> &'static str {
    match reason {
        StandReason::PickupDropoff => "for passengers",
        StandReason::Yield => "to give way",
        StandReason::Queue => "in a queue",
        StandReason::RedLight => "at a red light",
        StandReason::LeadVehicle => "behind a stopped vehicle",
        StandReason::StopSign => "at a stop sign",
        StandReason::Parked => "parked",
        StandReason::Pedestrian => "for somebody on foot",
        StandReason::BlockedPath => "because its way was blocked",
        StandReason::BlockedJunction => "to keep a junction clear",
        StandReason::Animal => "for an animal",
        StandReason::EmergencyVehicle => "for an emergency vehicle",
        StandReason::Barrier => "at a gate or crossing",
    }
}

/// How the ego was when they touched; nothing where that is not told.
fn state_words(state: ContactState) -> &'static str {
    match state {
        ContactState::Stopped => "stood",
        ContactState::Parked => "was parked",
        ContactState::Reversing => "was reversing",
        ContactState::SettingOff => "was setting off",
        ContactState::Moving => "was moving",
    }
}

/// Several words as one: `a, b and c`.
fn list(words: &[&str]) -> String {
    match words {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

fn zone_words(zones: &[Told<ContactZone>]) -> String {
    list(&zones.iter().map(|zone| zone.value.label()).collect::<Vec<_>>())
}

/// What the ego did.
fn ego_sentence(account: &Account, template: Template) -> String {
    let road = template.road.label();
    let heading = told(&account.sv.heading).map(compass);
    // Who was parked is not told to have been so a second time.
    let parked = told(&account.sv.state) == Some(ContactState::Parked);
    let reasons = account.sv.reasons.iter().map(|reason| reason.value);
    let reasons: Vec<&str> = reasons.filter(|&why| !(parked && why == StandReason::Parked)).map(reason_words).collect();
    let why = if reasons.is_empty() { String::new() } else { format!(" {}", list(&reasons)) };
    match (told(&account.sv.state), heading) {
        (Some(state), Some(to)) => format!("{road}: the ego {}{why}, heading {to}.", state_words(state)),
        (Some(state), None) => format!("{road}: the ego {}{why}.", state_words(state)),
        (None, Some(to)) => format!("{road}: the ego was heading {to}; whether it moved is not told."),
        (None, None) => format!("{road}: whether the ego moved is not told."),
    }
}

/// Where somebody was who is not told to have come: `ahead`.
fn place_words(from: From) -> String {
    let sided = |place: &str, side: Option<LeftRight>| match side {
        Some(LeftRight::Left) => format!("{place} on the left"),
        Some(LeftRight::Right) => format!("{place} on the right"),
        None => place.to_owned(),
    };
    match from {
        From::Behind => "behind".to_owned(),
        From::Ahead => "ahead".to_owned(),
        From::Opposite => "in the opposite direction".to_owned(),
        From::Beside { side } => sided("beside the ego,", Some(side)),
        From::Cross { side } => sided("on a crossing road", Some(side)),
        From::Stall { side } => sided("in a stall", side),
        From::Driveway { side } => sided("in a driveway", side),
        From::Parked { side } => sided("at the kerb", side),
        From::Sidewalk { side } => sided("on a sidewalk", side),
        From::Above => "above".to_owned(),
    }
}

/// What the partner did. Who is not told to have moved is where it was, and no more is said of it.
fn partner_sentence(partner: &Party, came_from: Option<From>) -> String {
    let kind = told(&partner.kind);
    let who = capital(&kind_words(kind));
    let is_thing = kind.is_some_and(|kind| kind.group() == KindGroup::Object);
    let origin = came_from.map_or_else(String::new, |from| format!(" {}", from.words()));
    let place = came_from.map_or_else(String::new, |from| format!(" {}", place_words(from)));
    let doing = match told(&partner.movement) {
        Some(movement) => format!(" ({})", movement.label().to_lowercase()),
        None => String::new(),
    };
    let did = match told(&partner.state) {
        Some(ContactState::Moving) if !is_thing && came_from.is_some() => format!("came{origin}"),
        Some(ContactState::Reversing) if came_from.is_some() => format!("came{origin}, reversing"),
        Some(ContactState::SettingOff) if came_from.is_some() => format!("set off{origin}"),
        Some(state) => format!("{}{place}", state_words(state)),
        None if !is_thing && came_from.is_some_and(comes) => format!("came{origin}"),
        None if came_from.is_some() => format!("was{place}"),
        None => "was there".to_owned(),
    };
    format!("{who} {did}{doing}.")
}

/// Whether to be told from there is to be told to have come.
fn comes(from: From) -> bool {
    !matches!(from, From::Ahead | From::Beside { .. } | From::Parked { .. })
}

/// Who touched whom, and where.
fn contact_sentence(account: &Account, partner: &Party) -> String {
    let hit = match told(&account.striker) {
        Some(Striker::Sv) => "The ego moved into it",
        Some(Striker::Cp) => "It moved into the ego",
        Some(Striker::Both) => "They moved into each other",
        None => "They touched",
    };
    let (ego, other) = (zone_words(&account.sv.zones), zone_words(&partner.zones));
    match (ego.is_empty(), other.is_empty()) {
        (true, true) => format!("{hit}."),
        (false, true) => format!("{hit}: the ego was touched at its {ego}."),
        (true, false) => format!("{hit}: the other was touched at its {other}."),
        (false, false) => format!("{hit}: the ego was touched at its {ego}, the other at its {other}."),
    }
}

fn text(account: &Account, template: Template) -> String {
    let mut sentences = vec![ego_sentence(account, template)];
    if let Some(partner) = &account.partner {
        sentences.push(partner_sentence(partner, told(&account.came_from)));
        sentences.push(contact_sentence(account, partner));
    }
    match account.others.len() {
        0 => {}
        1 => sentences.push("One more is named in the report.".to_owned()),
        others => sentences.push(format!("{others} more are named in the report.")),
    }
    sentences.join(" ")
}

fn compass(to: Compass) -> &'static str {
    match to {
        Compass::North => "north",
        Compass::Northeast => "north-east",
        Compass::East => "east",
        Compass::Southeast => "south-east",
        Compass::South => "south",
        Compass::Southwest => "south-west",
        Compass::West => "west",
        Compass::Northwest => "north-west",
    }
}

pub(crate) fn facts(account: &Account) -> Vec<Fact> {
    let report = &account.report;
    let mut all = Vec::new();
    let mut add = |value: FactValue, source: &Source, shown: &str| {
        all.push(Fact { value, source: where_from(report, source, shown) });
    };
    if let Some(fact) = &account.sv.movement {
        add(FactValue::SvMovement { movement: fact.value }, &fact.source, fact.value.label());
    }
    if let Some(partner) = &account.partner {
        if let Some(fact) = &partner.movement {
            add(FactValue::CpMovement { movement: fact.value }, &fact.source, fact.value.label());
        }
        if let Some((fact, kind)) = partner.kind.as_ref().and_then(|fact| Some((fact, fact.value.partner_kind()?))) {
            add(FactValue::Partner { kind }, &fact.source, kind.label());
        }
    }
    if let Some((fact, approach)) = account.came_from.as_ref().and_then(|fact| Some((fact, approach(fact.value)?))) {
        add(FactValue::Approach { approach }, &fact.source, &fact.value.words());
    }
    if let Some(fact) = &account.order {
        add(FactValue::Order { first: fact.value }, &fact.source, fact.value.words());
    }
    let zones = |party: &Party| party.zones.iter().map(|zone| zone.value).collect::<Vec<_>>();
    let cp_zones = account.partner.as_ref().map(|partner| &partner.zones[..]).unwrap_or_default();
    if let Some(first) = account.sv.zones.first().or(cp_zones.first()) {
        let value =
            FactValue::Contact { sv: zones(&account.sv), cp: account.partner.as_ref().map(zones).unwrap_or_default() };
        add(value, &first.source, &zone_words(&account.sv.zones));
    }
    all
}

pub(super) fn where_from(record: &RecordRef, source: &Source, shown: &str) -> FactSource {
    match source {
        Source::Words { text, .. } => FactSource::Words { record: record.clone(), words: text.clone() },
        Source::Column { name } => {
            FactSource::Column { record: record.clone(), column: name.clone(), text: shown.to_owned() }
        }
        Source::Rule { name } => FactSource::Assumed { why: format!("it follows from other facts: {name}") },
    }
}

/// The approach of the template's language that a place of origin belongs to.
fn approach(from: From) -> Option<Approach> {
    let of = |side: LeftRight| if side == LeftRight::Left { Approach::Left } else { Approach::Right };
    match from {
        From::Behind | From::Ahead | From::Beside { .. } | From::Parked { .. } => Some(Approach::Same),
        From::Opposite => Some(Approach::Opposite),
        From::Cross { side } => Some(of(side)),
        From::Stall { side } | From::Driveway { side } | From::Sidewalk { side } => side.map(of),
        From::Above => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::account::Fact as Said;

    fn said<T>(value: T) -> Said<T> {
        Said { value, source: Source::Rule { name: "test".to_owned() } }
    }

    fn party(kind: Kind, state: Option<ContactState>) -> Party {
        Party { kind: Some(said(kind)), state: state.map(said), ..Party::default() }
    }

    #[test]
    fn who_is_not_told_to_have_moved_is_not_said_to() {
        let beside = From::Beside { side: LeftRight::Right };
        for (kind, state, from, says) in [
            (Kind::Chain, None, From::Ahead, "A chain was ahead."),
            (Kind::Cone, Some(ContactState::Stopped), From::Ahead, "A cone stood ahead."),
            (Kind::Cart, Some(ContactState::Moving), From::Ahead, "A cart was moving ahead."),
            (Kind::Curb, None, beside, "A curb was beside the ego, on the right."),
            (Kind::Van, None, From::Ahead, "A van was ahead."),
            (Kind::Van, Some(ContactState::Parked), beside, "A van was parked beside the ego, on the right."),
            (Kind::Van, Some(ContactState::Moving), From::Behind, "A van came from behind."),
            (Kind::Van, Some(ContactState::Reversing), From::Ahead, "A van came from ahead, reversing."),
            (Kind::Suv, Some(ContactState::SettingOff), From::Behind, "An SUV set off from behind."),
        ] {
            assert_eq!(partner_sentence(&party(kind, state), Some(from)), says);
        }
    }

    #[test]
    fn several_words_are_joined_as_one_writes_them() {
        assert_eq!(list(&["front"]), "front");
        assert_eq!(list(&["front", "right"]), "front and right");
        assert_eq!(list(&["front", "right", "front right"]), "front, right and front right");
    }
}
