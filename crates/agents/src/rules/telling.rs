//! An account told: a short text in plain sentences, and its facts, each with where it stands.

use recrash_model::account::{
    Account, Compass, ContactState, Fact as Told, Kind, LeftRight, Origin as From, Party, Source, StandReason, Striker,
    told,
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
        Ok(serde_json::Value::String(name)) => name.replace('_', " "),
        _ => "vehicle".to_owned(),
    };
    let article = if name.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
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

fn state_words(party: &Party) -> &'static str {
    match told(&party.state) {
        Some(ContactState::Stopped) => "stood",
        Some(ContactState::Parked) => "was parked",
        Some(ContactState::Reversing) => "was reversing",
        Some(ContactState::SettingOff) => "was setting off",
        Some(ContactState::Moving) | None => "was moving",
    }
}

fn zone_words(zones: &[Told<ContactZone>]) -> String {
    zones.iter().map(|zone| zone.value.label()).collect::<Vec<_>>().join(" and ")
}

fn text(account: &Account, template: Template) -> String {
    let mut sentences = Vec::new();
    let reasons: Vec<&str> = account.sv.reasons.iter().map(|reason| reason_words(reason.value)).collect();
    let why = if reasons.is_empty() { String::new() } else { format!(" {}", reasons.join(" and ")) };
    let heading =
        told(&account.sv.heading).map_or_else(String::new, |to: Compass| format!(", heading {}", compass(to)));
    sentences.push(format!("{}: the ego {}{why}{heading}.", template.road.label(), state_words(&account.sv)));
    if let Some(partner) = &account.partner {
        let who = kind_words(told(&partner.kind));
        let came = told(&account.came_from).map_or_else(String::new, |from| format!(" {}", from.words()));
        let doing = match told(&partner.movement) {
            Some(movement) => format!(" ({})", movement.label().to_lowercase()),
            None => String::new(),
        };
        sentences.push(format!("{} {}{came}{doing}.", capital(&who), state_words(partner)));
        let hit = match told(&account.striker) {
            Some(Striker::Sv) => "The ego moved into it",
            Some(Striker::Cp) => "It moved into the ego",
            Some(Striker::Both) => "They moved into each other",
            None => "They touched",
        };
        let zones = match (account.sv.zones.is_empty(), partner.zones.is_empty()) {
            (true, true) => String::new(),
            (false, true) => format!("; touched was the ego's {}", zone_words(&account.sv.zones)),
            (true, false) => format!("; touched was its {}", zone_words(&partner.zones)),
            (false, false) => {
                format!(
                    "; touched were the ego's {} and its {}",
                    zone_words(&account.sv.zones),
                    zone_words(&partner.zones)
                )
            }
        };
        sentences.push(format!("{hit}{zones}."));
    }
    let others = account.others.len();
    if others > 0 {
        sentences.push(format!("{others} more {} in the story.", if others == 1 { "is" } else { "are" }));
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
