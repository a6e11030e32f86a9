//! The role that reads: corrections of what the built-in reader made of an incident, each with the words or the column it stands in,
//! checked one by one and laid over the reader's account.

mod answer;
mod cues;
mod held;

pub(super) use answer::AccountAnswer;

use answer::{OtherAnswer, PartyAnswer, Quoted, SpeedValue};
use held::{Held, no_column};
use recrash_model::account::{
    Account, CrashType, Fact, Kind, KindGroup, Origin, Other, Party, Source, Speed, SpeedMeaning, told,
};
use recrash_model::record::CrashRecord;
use recrash_model::scenario::Author;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// Fewest facts with words or columns that an account needs: fewer tell no crash.
const FEWEST_FACTS: usize = 3;
/// Speeds nearer than this are the same. [m/s]
const SAME_MPS: f64 = 0.02;
/// What follows from other facts, where a model says so.
const BY_MODEL: &str = "read by a language model";

/// The answer laid over `base`, the account that the built-in reader made of the same incident. `record` is the report whose
/// narrative speaks.
///
/// # Errors
/// Every fact that is not as its words or its column say, and every two that cannot both be true.
pub(super) fn account(
    answer: &AccountAnswer,
    base: &Account,
    record: &CrashRecord,
    model: &str,
) -> Result<Account, Vec<String>> {
    let mut account = base.clone();
    let mut held = Held { record, problems: Vec::new() };
    if answer.report != record.id.to_string() {
        held.problems.push(format!("report is {}; the report to read is {}", answer.report, record.id));
    }
    for path in &answer.nobody_tells {
        if !forget(&mut account, path) {
            held.problems.push(format!("nobody_tells: {path} is no fact that can be taken out"));
        }
    }
    lay_party(&mut held, "sv", &answer.sv, &mut account.sv);
    if answer.another_partner {
        without_partner(&mut account);
    }
    if let Some(partner) = &answer.partner {
        lay_party(&mut held, "partner", partner, account.partner.get_or_insert_default());
    }
    held.lay("came_from", &mut account.came_from, &answer.came_from, cues::origin, no_column);
    held.lay("ahead", &mut account.ahead, &answer.ahead, |_, words| cues::ahead(words), no_column);
    held.lay("striker", &mut account.striker, &answer.striker, cues::contact, no_column);
    held.lay("first_contact", &mut account.first_contact, &answer.first_contact, cues::contact, no_column);
    held.lay("driver", &mut account.driver, &answer.driver, cues::driver, no_column);
    held.lay("door", &mut account.door, &answer.door, |_, words| words.contains("door"), no_column);
    let place = &mut account.place;
    held.lay("place.kind", &mut place.kind, &answer.place.kind, cues::place, no_column);
    held.lay("place.lanes", &mut place.lanes, &answer.place.lanes, |_, words| words.contains("lane"), no_column);
    held.lay("place.arms", &mut place.arms, &answer.place.arms, |_, words| cues::arms(words), no_column);
    held.list("place.features", &mut place.features, &answer.place.features, cues::feature, no_column);
    if let Some(others) = &answer.others {
        account.others =
            others.iter().enumerate().filter_map(|(n, other)| lay_other(&mut held, n, other, base)).collect();
    }
    follow(&mut account.crash_type, answer.crash_type);
    follow(&mut account.role, answer.role);
    follow(&mut account.order, answer.order);
    account.author = Author::Model(model.to_owned());

    let mut problems = held.problems;
    let facts = told_facts(&account);
    if facts < FEWEST_FACTS && problems.is_empty() {
        problems.push(format!("it tells {facts} facts with their words; a crash takes {FEWEST_FACTS} at least"));
    }
    problems.extend(contradictions(&account));
    if problems.is_empty() { Ok(account) } else { Err(problems) }
}

/// Takes out the partner, and all that is said of what it did to the subject vehicle.
fn without_partner(account: &mut Account) {
    (account.partner, account.came_from, account.ahead) = (None, None, None);
    (account.striker, account.first_contact, account.door) = (None, None, None);
    (account.crash_type, account.role, account.order) = (None, None, None);
    account.sv.acts.iter_mut().for_each(|act| act.after_other = None);
}

/// Takes out a fact that nobody tells; whether there is one of that name.
fn forget(account: &mut Account, path: &str) -> bool {
    let party = |party: &mut Party, name: &str| {
        match name {
            "kind" => party.kind = None,
            "movement" => party.movement = None,
            "state" => party.state = None,
            "standing" => party.standing = None,
            "heading" => party.heading = None,
            "heading_after" => party.heading_after = None,
            "lane" => party.lane = None,
            "astride" => party.astride = None,
            "reasons" => party.reasons.clear(),
            "acts" => party.acts.clear(),
            "speeds" => party.speeds.clear(),
            "zones" => party.zones.clear(),
            "controls" => party.controls.clear(),
            _ => return false,
        }
        true
    };
    match path.split_once('.') {
        Some(("sv", name)) => return party(&mut account.sv, name),
        Some(("partner", name)) => return account.partner.as_mut().is_some_and(|known| party(known, name)),
        _ => {}
    }
    match path {
        "role" => account.role = None,
        "order" => account.order = None,
        "came_from" => account.came_from = None,
        "ahead" => account.ahead = None,
        "striker" => account.striker = None,
        "first_contact" => account.first_contact = None,
        "driver" => account.driver = None,
        "door" => account.door = None,
        "place.kind" => account.place.kind = None,
        "place.lanes" => account.place.lanes = None,
        "place.arms" => account.place.arms = None,
        _ => return false,
    }
    true
}

/// A fact that follows from others.
fn follow<T: Copy + PartialEq>(known: &mut Option<Fact<T>>, said: Option<T>) {
    if let Some(value) = said
        && told(known) != Some(value)
    {
        *known = Some(Fact::by_rule(value, BY_MODEL));
    }
}

/// A party's facts laid over those that are known of it.
fn lay_party(held: &mut Held, path: &str, answer: &PartyAnswer, party: &mut Party) {
    let (record, is_sv) = (held.record, path == "sv");
    let at = |name: &str| format!("{path}.{name}");
    let kind_column = |kind: Kind, name: &str| {
        let known = (name == "Crash With" && !is_sv).then_some(&record.partner)?.known()?;
        Some(kind.partner_kind() == Some(known))
    };
    let movement_column = |movement: Movement, name: &str| {
        let (own, known) = match is_sv {
            true => ("SV Pre-Crash Movement", record.sv_movement.known()),
            false => ("CP Pre-Crash Movement", record.cp_movement.known()),
        };
        (name == own).then(|| known == Some(movement))
    };
    let zone_column = |zone: ContactZone, name: &str| {
        let (own, known) = match is_sv {
            true => ("SV Contact Area", &record.sv_zones),
            false => ("CP Contact Area", &record.cp_zones),
        };
        (name == own).then(|| known.contains(&zone))
    };
    held.lay(&at("kind"), &mut party.kind, &answer.kind, cues::kind, kind_column);
    held.lay(&at("movement"), &mut party.movement, &answer.movement, cues::movement, movement_column);
    held.lay(&at("state"), &mut party.state, &answer.state, cues::state, no_column);
    held.lay(&at("standing"), &mut party.standing, &answer.standing, |_, words| cues::slows(words), no_column);
    held.list(&at("reasons"), &mut party.reasons, &answer.reasons, cues::reason, no_column);
    held.lay(&at("heading"), &mut party.heading, &answer.heading, cues::compass, no_column);
    held.lay(&at("heading_after"), &mut party.heading_after, &answer.heading_after, cues::compass, no_column);
    held.lay(&at("lane"), &mut party.lane, &answer.lane, cues::lane, no_column);
    held.lay(&at("astride"), &mut party.astride, &answer.astride, |_, words| cues::astride(words), no_column);
    held.list(&at("zones"), &mut party.zones, &answer.zones, cues::zone, zone_column);
    held.list(&at("controls"), &mut party.controls, &answer.controls, cues::control, no_column);
    if let Some(acts) = &answer.acts {
        party.acts = held.acts(&at("acts"), &party.acts, acts);
    }
    if let Some(speeds) = &answer.speeds {
        party.speeds = lay_speeds(held, path, speeds, &party.speeds);
    }
}

fn lay_speeds(held: &mut Held, path: &str, answer: &[Quoted<SpeedValue>], known: &[Fact<Speed>]) -> Vec<Fact<Speed>> {
    let of_column = (path == "sv").then_some(held.record.sv_speed_mps).flatten();
    let column = |speed: SpeedValue, name: &str| {
        (path == "sv" && name.starts_with("SV Precrash Speed"))
            .then(|| of_column.is_some_and(|known| (known - speed.mps).abs() <= 0.5))
    };
    let mut all = Vec::new();
    for (number, speed) in answer.iter().enumerate() {
        let SpeedValue { mps, meaning } = speed.value;
        let same = |fact: &&Fact<Speed>| fact.value.meaning == meaning && (fact.value.mps - mps).abs() < SAME_MPS;
        if let Some(same) = known.iter().find(same) {
            all.push(same.clone());
            continue;
        }
        let said = |speed: SpeedValue, words: &str| cues::speed(speed.mps, words);
        let fact = held.fact(&format!("{path}.speeds[{number}]"), &[], speed, said, column);
        all.extend(fact.map(|fact| Fact { value: Speed { mps, meaning }, source: fact.source }));
    }
    all
}

/// Somebody else of the answer: whom the draft calls by the same words, with what is said of it now.
fn lay_other(held: &mut Held, number: usize, answer: &OtherAnswer, base: &Account) -> Option<Other> {
    let path = format!("others[{number}]");
    let called = |other: &&Other| match (&other.kind.source, &answer.kind.words) {
        (Source::Words { text, .. }, Some(words)) => text == words,
        (Source::Words { .. }, None) => other.kind.value == answer.kind.value,
        _ => other.kind.value == answer.kind.value,
    };
    let known = base.others.iter().find(called);
    let kinds: Vec<Fact<Kind>> = known.map(|other| other.kind.clone()).into_iter().collect();
    let kind = held.fact(&format!("{path}.kind"), &kinds, &answer.kind, cues::kind, no_column)?;
    let acts = held.acts(&format!("{path}.acts"), known.map_or(&[], |other| &other.acts), &answer.acts);
    let mut place = known.and_then(|other| other.place.clone()).filter(|_| answer.place.is_some());
    held.lay(&format!("{path}.place"), &mut place, &answer.place, cues::whereabouts, no_column);
    let mut astride = known.and_then(|other| other.astride.clone()).filter(|_| answer.astride.is_some());
    held.lay(&format!("{path}.astride"), &mut astride, &answer.astride, |_, words| cues::astride(words), no_column);
    let mut touch = known.and_then(|other| other.touch.clone()).filter(|_| answer.touch.is_some());
    held.lay(&format!("{path}.touch"), &mut touch, &answer.touch, |_, words| cues::meets(words), no_column);
    let OtherAnswer { several, hides, touched_partner, .. } = *answer;
    Some(Other { kind, place, several, acts, astride, hides, touched_partner, touch })
}

/// How many facts about the two have words or a column.
fn told_facts(account: &Account) -> usize {
    let stands = |source: &Source| !matches!(source, Source::Rule { .. });
    let of_party = |party: &Party| {
        let single = [
            party.kind.as_ref().map(|fact| &fact.source),
            party.movement.as_ref().map(|fact| &fact.source),
            party.state.as_ref().map(|fact| &fact.source),
        ];
        let lists = party.acts.iter().map(|fact| &fact.source).chain(party.zones.iter().map(|fact| &fact.source));
        single.into_iter().flatten().chain(lists).filter(|source| stands(source)).count()
    };
    let shared = [
        account.came_from.as_ref().map(|fact| &fact.source),
        account.striker.as_ref().map(|fact| &fact.source),
        account.driver.as_ref().map(|fact| &fact.source),
    ];
    of_party(&account.sv)
        + account.partner.as_ref().map_or(0, of_party)
        + shared.into_iter().flatten().filter(|source| stands(source)).count()
}

/// Facts that cannot be true together.
fn contradictions(account: &Account) -> Vec<String> {
    let mut all = Vec::new();
    let crash_type = told(&account.crash_type);
    let group = account.partner.as_ref().and_then(|partner| told(&partner.kind)).map(Kind::group);
    let of_kind = match crash_type {
        Some(CrashType::Pedestrian) => Some(KindGroup::OnFoot),
        Some(CrashType::Cyclist) => Some(KindGroup::Cyclist),
        Some(CrashType::Motorcycle) => Some(KindGroup::Motorcycle),
        _ => None,
    };
    if let (Some(wanted), Some(group), Some(crash_type)) = (of_kind, group, crash_type)
        && wanted != group
    {
        all.push(format!("crash_type is {}; the partner is of another kind", crash_type.label()));
    }
    let fits = match (crash_type, told(&account.came_from)) {
        (Some(CrashType::FrontToRear), Some(from)) => !matches!(from, Origin::Opposite | Origin::Cross { .. }),
        // Who turned out of a crossing road may meet the other head-on, or along its flank.
        (Some(CrashType::HeadOn), Some(from)) => {
            !matches!(from, Origin::Behind | Origin::Beside { .. } | Origin::Above)
        }
        (Some(CrashType::Lateral), Some(from)) => !matches!(from, Origin::Opposite),
        _ => true,
    };
    if let (false, Some(crash_type), Some(from)) = (fits, crash_type, told(&account.came_from)) {
        all.push(format!("crash_type is {}; a partner {} has no such crash", crash_type.label(), from.words()));
    }
    for (who, party) in [("sv", Some(&account.sv)), ("partner", account.partner.as_ref())] {
        let Some(party) = party else { continue };
        let impact = party.speeds.iter().find(|speed| speed.value.meaning == SpeedMeaning::Impact);
        if let (Some(state), Some(speed)) = (told(&party.state), impact)
            && state.stands()
            && speed.value.mps > 1.0
        {
            all.push(format!("{who} is {}, and its speed at the contact {:.1} m/s", state.label(), speed.value.mps));
        }
    }
    all
}
