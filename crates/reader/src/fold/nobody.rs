//! Nouns that name nobody beside the two: one of the two again, a part of it, or somebody who was not there.

use super::{Reading, whereabouts};
use crate::frame::Frame;
use crate::lexicon::Sense;
use crate::world::{Actor, Known, SUBJECT, same_kind};
use recrash_model::account::{Act, ActFact, Kind, KindGroup};

/// Whether a noun names one of the two again, or a part of it. Its tokens; what it is told to have done.
pub(super) fn is_one_of_the_two(
    reading: &Reading<'_>,
    (actor, kind): (Actor, Kind),
    (first, end): (usize, usize),
    acts: &[ActFact],
) -> bool {
    let story = &reading.story;
    let word = |at: Option<usize>| at.and_then(|at| story.tokens.get(at)).map_or("", |token| token.text.as_str());
    let back = |by: usize| word(first.checked_sub(by));
    let inside = |words: &[&str]| (first..end).any(|at| words.contains(&word(Some(at))));
    let partner = reading.contacts.partner;
    let idle = acts.iter().all(|fact| fact.after_contact);
    let another = inside(&["another", "second", "third"]);
    // "autonomous truck's mirror", "Olli is an 8-passenger shuttle", "the Kodiak AV Class 8 semi-truck".
    let own = idle && inside(&["autonomous", "automated"]) && !inside(&["other"]);
    // "which appears to be a cat".
    let seems = matches!((back(2), back(1)), ("to", "be"))
        && ["appear", "seem", "believe"].iter().any(|stem| back(3).starts_with(stem));
    let is = idle && (matches!(back(1), "is") || seems) && story.world.actors[actor].mentions == 1;
    let class = idle_or_drives(acts) && back(2) == "class" && back(1).parse::<u8>().is_ok();
    let told_once = is_of_headline(reading, actor, (first, end)) && idle;
    let headline = told_once && (whereabouts::place_of(reading, actor).is_none() || kind == Kind::Pickup);
    // "A collision involving two cars": of whom the story tells one by one.
    let counted = known_as_two(reading, actor, (first, end));
    // What anybody had to do: "causing vehicles to cross the line".
    let anybody = story.world.actors[actor].several && (1..3).any(|by| back(by) == "causing");
    // "Cut off by an oncoming vehicle, a pickup truck".
    let partner_begins = partner.and_then(|partner| story.world.actors[partner].kind_tokens).map(|(begins, _)| begins);
    let apposed = kind == Kind::Vehicle && word(Some(end)) == "," && partner_begins == Some(end + 1);
    // "Reported since one of the other vehicles was towed".
    let of_those = inside(&["other"]) && inside(&["one"]) && inside(&["vehicles", "cars"]);
    let the_other =
        idle && of_those || idle && partner.is_some() && word(Some(first)) == "the" && word(Some(first + 1)) == "other";
    own && !another
        || is_ridden_by_partner(reading, kind, first) && idle
        || is
        || class
        || headline
        || the_other
        || counted
        || anybody
        || apposed
        || is_towed_with(reading, (actor, kind), (first, end))
        || is_thing_again(reading, kind, end, another)
}

/// "Officers were directing traffic. A van set off when one of the officers waved": one of those told of before, of whom no more is told.
pub(super) fn is_one_of_those(known: &Known, acts: &[ActFact]) -> bool {
    known.group.is_some() && known.as_group && acts.iter().all(|fact| fact.after_contact)
}

/// Whether the headline counts both vehicles beside the subject vehicle.
fn known_as_two(reading: &Reading<'_>, actor: Actor, (first, _): (usize, usize)) -> bool {
    let story = &reading.story;
    let word = |at: Option<usize>| at.and_then(|at| story.tokens.get(at)).map_or("", |token| token.text.as_str());
    let back = |by: usize| word(first.checked_sub(by));
    let crash = matches!(back(2), "collision" | "crash" | "incident" | "accident");
    let one = |known: &Known| known.mentions > 0 && !known.several && known.kind.is_some_and(Kind::is_vehicle);
    let others = story.world.actors[1..].iter().filter(|known| one(known)).count();
    let two = crash && matches!(back(1), "with" | "involving") && word(Some(first)) == "two";
    two && others >= 2 && reading.contacts.partner.is_some_and(|partner| partner != actor)
}

/// "A cyclist on an electric bicycle", "a man riding a scooter": what the partner rides.
fn is_ridden_by_partner(reading: &Reading<'_>, kind: Kind, first: usize) -> bool {
    let story = &reading.story;
    let ridden =
        |kind: Kind| matches!(kind.group(), KindGroup::Cyclist | KindGroup::Motorcycle) || kind == Kind::Scooter;
    let rides = |kind: Kind| matches!(kind.group(), KindGroup::Cyclist | KindGroup::Motorcycle | KindGroup::OnFoot);
    let on = first.checked_sub(1).is_some_and(|at| matches!(story.tokens[at].text.as_str(), "on" | "riding"));
    let partner = reading.contacts.partner.and_then(|partner| story.world.actors[partner].kind);
    on && ridden(kind) && partner.is_some_and(rides)
}

/// Whether the headline of the crash names somebody so: "a collision with a van". It is the partner.
fn is_of_headline(reading: &Reading<'_>, actor: Actor, (first, end): (usize, usize)) -> bool {
    let story = &reading.story;
    let word = |at: Option<usize>| at.and_then(|at| story.tokens.get(at)).map_or("", |token| token.text.as_str());
    let back = |by: usize| word(first.checked_sub(by));
    let crash = matches!(back(2), "collision" | "crash" | "incident" | "accident");
    // "A collision with a third-party vehicle" is no third one.
    let third = |at: usize| word(Some(at)) == "third" && word(Some(at + 1)) != "party";
    let another = (first..end).any(|at| matches!(word(Some(at)), "another" | "second") || third(at));
    let partner = reading.contacts.partner.map(|partner| &story.world.actors[partner]);
    let vehicle =
        |kind: Option<Kind>| kind.is_some_and(|kind| kind.is_vehicle() || kind.group() == KindGroup::Motorcycle);
    let known = &story.world.actors[actor];
    matches!(back(1), "with" | "involving")
        && crash
        && !another
        && !known.several
        && vehicle(known.kind)
        && partner.is_some_and(|partner| vehicle(partner.kind) && !partner.another)
}

/// Whether only the headline tells the kind of somebody, which is the partner's: the story calls it a vehicle.
pub(super) fn is_called_by_headline(reading: &Reading<'_>, actor: Actor, (first, end): (usize, usize)) -> bool {
    let story = &reading.story;
    let (kind, partner) = (story.world.actors[actor].kind, reading.contacts.partner);
    let partner = partner.map(|partner| &story.world.actors[partner]).filter(|partner| partner.kind == kind);
    let Some((begins, _)) = partner.and_then(|partner| partner.kind_tokens) else { return false };
    let head = &story.tokens[end - 1].text;
    let again = story.tokens[end.min(begins)..begins].iter().any(|token| &token.text == head);
    begins > end && !again && is_of_headline(reading, actor, (first, end))
}

fn idle_or_drives(acts: &[ActFact]) -> bool {
    acts.iter().all(|fact| fact.after_contact || fact.act == Act::Follow)
}

/// A trailer and who draws it are one where one of them is the partner.
fn is_towed_with(reading: &Reading<'_>, (actor, kind): (Actor, Kind), (first, end): (usize, usize)) -> bool {
    let story = &reading.story;
    let Some(partner) = reading.contacts.partner else { return false };
    let known = &story.world.actors[partner];
    let words = |from: usize, to: usize| {
        let to = to.min(story.tokens.len());
        story.tokens[from.min(to)..to].iter().map(|token| token.text.as_str()).collect::<Vec<_>>()
    };
    // "The side of the heavy truck's trailer".
    let (from, to) = known.kind_tokens.unwrap_or((0, 0));
    let draws_it = |word: &&str| word.starts_with("truck") || word.starts_with("pickup");
    let of_trailer = words(from, to).last() == Some(&"trailer") && words(from, to).iter().any(draws_it);
    if of_trailer && words(first, end).iter().any(draws_it) {
        return true;
    }
    let draws = matches!(kind.group(), KindGroup::Truck | KindGroup::Car) && known.kind == Some(Kind::Trailer);
    if draws && kind != Kind::Trailer {
        return known.towed_by == Some(actor) || words(first, end + 6).contains(&"trailer");
    }
    // "A tow truck had stopped to load a disabled vehicle": that goes with it.
    let loads = words(first.saturating_sub(2), first).iter().any(|word| LOADS.contains(word));
    if known.kind == Some(Kind::TowTruck) && kind.is_vehicle() && loads {
        return true;
    }
    let drawn = kind == Kind::Trailer
        && known.kind.is_some_and(|kind| matches!(kind.group(), KindGroup::Truck | KindGroup::Car));
    let with = words(first.saturating_sub(3), end);
    drawn && ["with", "and", "pulling", "towing", "hauling", "its"].iter().any(|word| with.contains(word))
}

/// What a tow truck does with whom it is to tow.
const LOADS: [&str; 8] = ["load", "loading", "lift", "lifting", "lifted", "winch", "winching", "hoisting"];

/// "Another car that was waiting behind it drove around it", "a car behind it stopped in time", "before that, it had been following a bus", told
/// behind the crash: who had been there before. The tokens of its noun.
pub(super) fn had_been_there(reading: &Reading<'_>, actor: Actor, (first, end): (usize, usize)) -> bool {
    let (story, known) = (&reading.story, &reading.story.world.actors[actor]);
    let at = end + usize::from(matches!(story.word(end), "that" | "which" | "who" | ","));
    let at = match (story.word(at), story.word(at + 1)) {
        ("had", "been") => at + 2,
        ("was" | "were", _) if at > end => at + 1,
        _ => at,
    };
    let stays =
        matches!(story.word(at), "waiting" | "following" | "standing" | "traveling" | "queued" | "driving" | "riding");
    let beside = |at: usize| matches!(story.word(at), "behind" | "ahead" | "beside" | "alongside" | "next" | "in");
    let there = stays && beside(at + 1) || story.word(at) == "following" || story.word(end) == "behind";
    // Told of the subject vehicle as what it had done before.
    let back = |(number, frame): (usize, &Frame)| {
        let before = frame.who == Some(SUBJECT) && frame.act().is_some() && frame.first < first && end <= frame.end + 2;
        before && !reading.is_after(number) && known.sentence == Some(frame.sentence)
    };
    let told_back = story.frames.iter().enumerate().any(back);
    known.mentions == 1 && (there || told_back) && whereabouts::place_of(reading, actor).is_some()
}

/// A thing that is called as the partner is, or a part of a vehicle.
fn is_thing_again(reading: &Reading<'_>, kind: Kind, end: usize, another: bool) -> bool {
    let story = &reading.story;
    if kind.group() != KindGroup::Object || another {
        return false;
    }
    let head = story.tokens[end - 1].text.as_str();
    let part = end > 1 && story.tokens[end - 2].text == "tie" && head == "rod";
    let partner =
        reading.contacts.partner.filter(|partner| *partner != SUBJECT).map(|partner| &story.world.actors[partner]);
    let thing = |kind: Kind| matches!(kind.group(), KindGroup::Object | KindGroup::Other);
    let tokens = partner.filter(|partner| partner.kind.is_some_and(thing)).and_then(|partner| partner.kind_tokens);
    // What appeared to be a chair is one.
    let same = tokens.is_some_and(|(first, end)| {
        let named = &story.tokens[first..(end + 8).min(story.tokens.len())];
        let named = named.iter().take_while(|token| !matches!(token.text.as_str(), "." | "on" | "at" | "near" | "in"));
        named.into_iter().any(|token| token.text == head)
    });
    part || same
}

/// Whether a noun of a general remark names nobody who was there: "no injuries in either vehicle", "she called an ambulance", "signs that
/// require vehicles to stop", "took the sign for a pedestrian".
pub(super) fn is_remark(reading: &Reading<'_>, (first, end): (usize, usize), acts: &[ActFact]) -> bool {
    let tokens = &reading.story.tokens;
    let word = |at: Option<usize>| at.and_then(|at| tokens.get(at)).map_or("", |token| token.text.as_str());
    let back = |by: usize| word(first.checked_sub(by));
    let inside = |words: &[&str]| (first..end).any(|at| words.contains(&word(Some(at))));
    if acts.iter().any(|fact| !fact.after_contact) {
        return false;
    }
    let either = matches!(back(1), "either" | "neither") || inside(&["either", "neither"]);
    let called = matches!(back(1), "called" | "summoned" | "requested" | "call" | "contacted");
    let required = matches!(back(1), "require" | "requires" | "requiring");
    let taken_for = back(1) == "as"
        && (2..9)
            .any(|by| ["misclassif", "misidentif", "mistook", "listed"].iter().any(|stem| back(by).starts_with(stem)));
    // "Looking for cross traffic", "a truck-mounted sign".
    let looked_for = back(1) == "for" && matches!(back(2), "looking" | "checking" | "watching");
    // "There is no stop sign at the junction for vehicles on that street".
    let plural = matches!(word(end.checked_sub(1)), "vehicles" | "traffic" | "cars" | "drivers");
    let sign = (2..10).find(|by| matches!(back(*by), "sign" | "signs"));
    let none = sign.is_some_and(|by| (1..4).any(|more| back(by + more) == "no"));
    let signed = plural && back(1) == "for" && none;
    let mounted = word(Some(end)) == "mounted";
    let valet = inside(&["valet"]) && (word(Some(end)) == "parking" || inside(&["automated"]));
    let restricted = inside(&["traffic"])
        && (end..end + 3).any(|at| matches!(word(Some(at)), "restricted" | "prohibited" | "permitted"));
    // "was required to yield to through traffic", "caused vehicle damage".
    let through = usize::from(back(1) == "through");
    let to_yield = (back(3 + through), back(2 + through), back(1 + through)) == ("to", "yield", "to");
    let must = |stem: &&str| back(4 + through).starts_with(*stem);
    let owed = to_yield && ["require", "suppose", "oblige", "obligat", "expect", "instruct"].iter().any(must);
    let of_damage = matches!(word(Some(end)), "damage" | "damages" | "repair" | "repairs" | "maintenance");
    either
        || owed
        || of_damage
        || called
        || required
        || taken_for
        || looked_for
        || signed
        || mounted
        || valet
        || restricted
}

/// "With no other vehicles at the junction", "the lane was clear of traffic": nobody was there. Of "no vehicle but a van" the van was.
pub(super) fn is_denied(reading: &Reading<'_>, first: usize) -> bool {
    let word = |back: usize| first.checked_sub(back).map_or("", |at| reading.story.tokens[at].text.as_str());
    let inner = usize::from(matches!(word(1), "any" | "other" | "approaching" | "oncoming"));
    let inner = inner + usize::from(inner > 0 && word(1 + inner) == "any");
    let free = word(1 + inner) == "of" && matches!(word(2 + inner), "free" | "clear" | "devoid");
    matches!(word(1 + inner), "no" | "without" | "nor") || free
}

/// Whether somebody of whom no act is told is the partner, as the first sentence of the story named it: that tells the crash, and the
/// story tells it again; or a trailer, which somebody else pulls.
pub(super) fn is_named_before(reading: &Reading<'_>, actor: Actor, kind: Kind) -> bool {
    let story = &reading.story;
    let partner = reading.contacts.partner.and_then(|partner| story.world.actors[partner].kind);
    let same = partner.is_some_and(|partner| same_kind(partner, kind) || same_kind(kind, partner));
    let meets = |frame: &Frame| {
        let pair = [frame.who, frame.object];
        frame.is_contact() && pair.contains(&Some(SUBJECT)) && pair.contains(&Some(actor))
    };
    same && story.frames.iter().any(meets) || kind == Kind::Trailer
}

/// Whether a noun of which no act is told before the contact names nobody who was there: "a lane of traffic", "a passenger pickup", a
/// street that is called so; or somebody whom only the headline names, or what is told of afterwards. `again`: it is named again later.
pub(super) fn is_nobody(reading: &Reading<'_>, (first, end): (usize, usize), acts: &[ActFact], again: bool) -> bool {
    let story = &reading.story;
    let is = |at: Option<usize>, words: &[&str]| {
        at.and_then(|at| story.tokens.get(at)).is_some_and(|token| words.contains(&token.text.as_str()))
    };
    let inside = |words: &[&str]| (first..end).any(|at| is(Some(at), words));
    let pickup = inside(&["pickup", "pick"]) && inside(&["passenger", "rider", "customer", "requested"])
        || is(Some(end), &["pickup", "pick"]);
    let way = ["lane", "lanes", "flow", "direction", "side", "light", "lights", "rules"];
    let of_way = is(first.checked_sub(1), &["of"]) && is(first.checked_sub(2), &way) && inside(&["traffic"]);
    // "The signal for traffic", "in heavy traffic", "to merge into traffic".
    let before = |of: &[&str]| is(first.checked_sub(1), of);
    let signal =
        (first.saturating_sub(2)..first).any(|at| is(Some(at), &["signal", "signals", "light", "lights", "green"]));
    let heavy = inside(&["heavy", "light", "moderate"]) && before(&["in", "with", "by", "to"]);
    let any_traffic = inside(&["traffic"])
        && acts.is_empty()
        && (before(&["for"]) && signal || heavy || before(&["into", "directing"]) || is(Some(end), &["conditions"]));
    let adjective =
        is(Some(end), &["crosswalk", "crosswalks", "signal", "signals", "light", "lights", "control", "officer"])
            || inside(&["pedestrian"]) && (inside(&["traffic"]) || is(Some(end), &["traffic"]));
    // "The wheel slipped on the cable car rails".
    let rails = is(Some(end), &["rail", "rails", "track", "tracks"]);
    let capital = |at: usize| story.tokens.get(at).is_some_and(|token| token.capital);
    let street = end == first + 1 && capital(first) && capital(end) && first > 0;
    let involved = inside(&["involved"]) || is(Some(end), &["involved"]) || is(first.checked_sub(1), &["both"]);
    if pickup || of_way || any_traffic || adjective || rails || street || involved {
        return true;
    }
    if again || acts.iter().any(|fact| !fact.after_contact) {
        return false;
    }
    let contact = reading.contacts.first.map(|number| story.frames[number].sentence);
    let after = contact.is_some_and(|sentence| first >= story.sentences[sentence].end);
    // The crash, told before the story that tells it again.
    let again_told = |frame: &Frame| {
        frame.is_contact()
            && contact.is_some_and(|sentence| sentence > frame.sentence)
            && !inside(&["traffic", "another"])
    };
    let of_others = |number: usize| reading.contacts.earlier.contains(&number);
    let headline = story.frames.iter().enumerate().any(|(number, frame)| {
        let sentence = story.sentences[frame.sentence];
        (frame.sense == Sense::Headline || again_told(frame) && !of_others(number))
            && (sentence.first..sentence.end).contains(&first)
    });
    after || headline
}
