//! Which contact of the story is the crash, and with whom.

use crate::frame::{Frame, Story};
use crate::lexicon::Sense;
use crate::world::{Actor, SUBJECT, same_kind};
use recrash_model::account::{Act, Kind, KindGroup};
use recrash_model::kinds::PartnerKind;
use recrash_model::record::CrashRecord;
use recrash_model::template::Movement;

/// The contacts of a story.
#[derive(Debug, Clone, Default)]
pub(crate) struct Contacts {
    /// Frame of the contact of the subject vehicle with its partner.
    pub first: Option<usize>,
    /// The partner.
    pub partner: Option<Actor>,
    /// Contacts of two others before it, by frame.
    pub earlier: Vec<usize>,
    /// The subject vehicle was not touched.
    pub others_only: bool,
    /// The columns tell of a second contact, with somebody of another sort.
    pub of_second: bool,
    /// Who the headline says it was: the story calls the partner otherwise.
    pub retold: Option<Actor>,
}

impl Contacts {
    /// Looks through a story.
    pub fn find(story: &Story, record: &CrashRecord) -> Self {
        let touching: Vec<(usize, Actor)> = story
            .frames
            .iter()
            .enumerate()
            .filter(|(_, frame)| frame.is_contact())
            .filter_map(|(number, frame)| with_whom(story, record, frame, number).map(|partner| (number, partner)))
            .collect();
        match touching.first() {
            Some(&first) => Self::of_touch(story, record, &touching, first),
            None => Self::of_no_touch(story, record),
        }
    }

    /// Of a story that tells the contact of the subject vehicle: which one, and with whom.
    fn of_touch(story: &Story, record: &CrashRecord, touching: &[(usize, Actor)], first: (usize, Actor)) -> Self {
        let frames = &story.frames;
        let again = told_again(story, touching, first);
        let (told, headline) = (&frames[first.0], first.1);
        let named = [told.who, told.object].contains(&Some(headline)) && !story.world.actors[headline].several;
        let retold = again.filter(|(_, other)| named && *other != headline).map(|_| headline);
        let (first, partner) = again.unwrap_or(first);
        let (first, partner) = as_column(story, record, touching, first, partner);
        let sort_of = |actor: Actor| story.world.actors[actor].kind.and_then(sort);
        let column = record.partner.known().and_then(column_sort);
        let as_told = sort_of(partner).is_none() || column.is_none() || sort_of(partner) == column;
        let earlier = (0..frames.len())
            .filter(|&number| between_others(&frames[number]) && comes_first(story, number, first, touching));
        Self {
            first: Some(first),
            partner: Some(partner),
            earlier: earlier.collect(),
            others_only: false,
            of_second: !as_told && touching.iter().any(|(number, actor)| *number > first && sort_of(*actor) == column),
            retold,
        }
    }

    /// Of a story that tells no contact of the subject vehicle: that of others, or what comes next to one.
    fn of_no_touch(story: &Story, record: &CrashRecord) -> Self {
        let frames = &story.frames;
        let mut contacts = Self::default();
        // The one that names parts tells most.
        let apart = |&number: &usize| between_others(&frames[number]);
        let others = (0..frames.len())
            .filter(apart)
            .find(|&number| frames[number].on.is_some() || frames[number].with.is_some())
            .or_else(|| (0..frames.len()).find(apart));
        contacts.partner = announced(story).or_else(|| only_other(story, record));
        if let (Some(number), Some(who)) = (others, others.and_then(|number| frames[number].who)) {
            let headline = frames
                .iter()
                .any(|frame| frame.sense == Sense::Headline && frame.who == Some(SUBJECT) && frame.object.is_some());
            // Where a column says that the subject vehicle was touched, the words for it are not understood.
            if !headline && record.sv_zones.is_empty() {
                contacts.others_only = true;
                contacts.partner = Some(who);
                contacts.first = Some(number);
            }
        }
        contacts.others_only |= frames.iter().any(|frame| {
            frame.negated && matches!(frame.sense, Sense::Contact) && [frame.who, frame.object].contains(&Some(SUBJECT))
        });
        // Without a contact of its own, the last thing the partner does is next to it.
        contacts.first = contacts.first.or_else(|| contacts.partner.and_then(|partner| last_act_of(story, partner)));
        contacts
    }

    /// Where somebody is told to have touched the partner, or the partner it, before the crash.
    pub fn with_partner<'a>(&self, story: &'a Story, actor: Actor) -> Option<&'a Frame> {
        self.earlier.iter().map(|&number| &story.frames[number]).find(|frame| {
            let pair = [frame.who, frame.object];
            pair.contains(&Some(actor)) && pair.contains(&self.partner)
        })
    }
}

/// The contact of a headline told again, in full, by the story.
fn told_again(story: &Story, touching: &[(usize, Actor)], (first, partner): (usize, Actor)) -> Option<(usize, Actor)> {
    let frames = &story.frames;
    let early = headline_of(story);
    let told = &frames[first];
    // "A van rear-ended it. ... A passenger car rear-ended it": the same one, called otherwise.
    let names = |frame: &Frame, other: Actor| {
        // "hit by the second of two vans. ... A second van": whom nothing else is told of.
        let only = frames.iter().all(|other| other.sentence == told.sentence || other.who != Some(partner));
        [frame.who, frame.object].contains(&Some(other)) && (!story.world.actors[other].another || only)
    };
    // "The collision took place on Elm Street" says where, and tells nothing else.
    let bare = |frame: &Frame| {
        frame.sense == Sense::ContactMade && frame.who.is_none() && frame.object.is_none() && frame.on.is_none()
    };
    let fuller = touching.iter().filter(|(number, _)| !bare(&frames[*number]));
    let again = fuller.chain(touching.iter().filter(|(number, _)| bare(&frames[*number]))).find(|(number, other)| {
        let frame = &frames[*number];
        told.sentence == early
            && frame.sentence > early
            && !shoved(story, frame)
            && (*other == partner || story.world.actors[*other].mentions > 1 || names(frame, *other))
            && alike(story, partner, *other)
    });
    // "... struck it from behind. It then struck the left side": two events, no headline.
    let full = told.on.is_some() || told.with.is_some() || !told.relations.is_empty();
    again.filter(|(number, _)| !(full && goes_on(story, *number))).copied()
}

/// The last thing that somebody does, before what came of it.
fn last_act_of(story: &Story, actor: Actor) -> Option<usize> {
    let frames = &story.frames;
    let headline = frames.iter().position(|frame| frame.sense == Sense::Headline);
    let acts = |frame: &Frame| {
        frame.who == Some(actor) && frame.act().is_some_and(|act| act != Act::Leave) && Some(frame.sentence) != headline
    };
    let before = |frame: &Frame| acts(frame) && !tells_harm(story, frame.sentence);
    frames.iter().rposition(before).or_else(|| frames.iter().rposition(acts))
}

/// Kinds that a column can hold against each other: whoever is on foot, on two wheels, an animal, or in a vehicle.
fn sort(kind: Kind) -> Option<KindGroup> {
    match kind.group() {
        KindGroup::Car | KindGroup::Truck => Some(KindGroup::Car),
        KindGroup::Object | KindGroup::Other => None,
        group => Some(group),
    }
}

/// The partner, unless it is of another sort than the column names and somebody of that sort is in the story.
fn as_column(
    story: &Story,
    record: &CrashRecord,
    touching: &[(usize, Actor)],
    first: usize,
    partner: Actor,
) -> (usize, Actor) {
    let unchanged = (first, partner);
    let Some(column) = record.partner.known().and_then(column_sort) else { return unchanged };
    let is = |actor: Actor| story.world.actors[actor].kind.and_then(sort) == Some(column);
    let said = story.world.actors[partner].kind.and_then(sort);
    // "the truck came back and its gate struck it": what stands does not strike, who came did.
    let stands = story.world.actors[partner].kind.is_some_and(|kind| {
        matches!(kind, Kind::Wall | Kind::Pole | Kind::Curb | Kind::Gate | Kind::Barrier | Kind::Sign | Kind::Chain)
    });
    // "She pushed a stroller, and its wheel touched it": it is she whom the column means.
    let pushed = matches!(column, KindGroup::OnFoot | KindGroup::Cyclist)
        && story.world.actors[partner].kind.is_some_and(|kind| kind.group() == KindGroup::Object);
    if (stands || pushed) && story.frames[first].who == Some(partner) {
        let sentence = story.frames[first].sentence;
        let came = story.frames[..first].iter().rev().find(|frame| {
            frame.sentence + 1 >= sentence && frame.act().is_some() && frame.happened() && frame.who.is_some_and(is)
        });
        return came.and_then(|frame| frame.who).map_or(unchanged, |actor| (first, actor));
    }
    if said.is_none_or(|said| said == column) {
        return unchanged;
    }
    // An animal that it struck before somebody ran into it was the first.
    let hit = &story.frames[first];
    if said == Some(KindGroup::Animal) && hit.who == Some(SUBJECT) && hit.object == Some(partner) && hit.happened() {
        return unchanged;
    }
    if let Some(&touch) = touching.iter().find(|(_, actor)| is(*actor)) {
        return touch;
    }
    // "An electric scooter struck it", by the words: no car that was only there. Nor is a cyclist who was there "a passenger vehicle".
    let light = matches!(said, Some(KindGroup::OnFoot | KindGroup::Cyclist | KindGroup::Motorcycle));
    let known = &story.world.actors[partner];
    let car = said == Some(KindGroup::Car) && (known.passenger || known.kind != Some(Kind::Vehicle));
    if (light && column == KindGroup::Car || car) && hit.who == Some(partner) && hit.object == Some(SUBJECT) {
        return unchanged;
    }
    let acting = |actor: &Actor| is(*actor) && !story.world.actors[*actor].several;
    let named = story.frames[..=first].iter().rev().filter_map(|frame| frame.who).find(acting);
    // "refused an ambulance", told after the crash.
    let end = story.sentences[story.frames[first].sentence].end;
    let before = |actor: usize| story.world.actors[actor].kind_tokens.is_none_or(|(at, _)| at < end);
    let any = || (1..story.world.actors.len()).find(|&actor| is(actor) && before(actor));
    named.or_else(any).map_or(unchanged, |actor| (first, actor))
}

fn column_sort(kind: PartnerKind) -> Option<KindGroup> {
    match kind {
        PartnerKind::PassengerCar
        | PartnerKind::Suv
        | PartnerKind::Van
        | PartnerKind::PickupTruck
        | PartnerKind::HeavyTruck
        | PartnerKind::Bus => Some(KindGroup::Car),
        PartnerKind::Motorcycle => Some(KindGroup::Motorcycle),
        PartnerKind::Cyclist => Some(KindGroup::Cyclist),
        PartnerKind::Pedestrian | PartnerKind::OtherNonMotorist => Some(KindGroup::OnFoot),
        PartnerKind::Animal => Some(KindGroup::Animal),
        _ => None,
    }
}

/// The sentence of the headline: the first of the story that tells anything, or that tells a contact behind what is no act of anybody: "The AV
/// was carrying a rider. A van hit it".
fn headline_of(story: &Story) -> usize {
    let tells = |frame: &&Frame| {
        let mode = frame.act() == Some(Act::Follow) && story.tokens[frame.first].text.starts_with("operat");
        !mode && (frame.act().is_some() || frame.is_contact() || frame.sense == Sense::Headline)
    };
    let first = story.frames.first().map_or(0, |frame| frame.sentence);
    let told = story.frames.iter().find(tells).map_or(first, |frame| frame.sentence);
    let touches = story.frames.iter().any(|frame| frame.sentence == told && frame.is_contact());
    if touches { told } else { first }
}

/// Whether the sentence of a frame says that it is one more event.
fn goes_on(story: &Story, number: usize) -> bool {
    let sentence = story.sentences[story.frames[number].sentence];
    // With what led to it told in between it is the same event, told in full.
    let first = story.frames.iter().find(|frame| frame.is_contact()).map_or(0, |frame| frame.sentence);
    let leads = |frame: &Frame| {
        (first + 1..story.frames[number].sentence).contains(&frame.sentence)
            && frame.act().is_some()
            && frame.happened()
    };
    let words: Vec<&str> = story.tokens[sentence.first..sentence.end].iter().map(|token| token.text.as_str()).collect();
    // "When it set off for the second time, a van hit it" is one touch.
    let contact = story.frames[number].first - sentence.first;
    let of_before = |at: usize| words.get(at + 1) == Some(&"time") && at < contact;
    let again = words
        .iter()
        .enumerate()
        .any(|(at, word)| matches!(*word, "again" | "second" | "another" | "third" | "times") && !of_before(at));
    if story.frames.iter().filter(|frame| leads(frame)).count() > 1 && !again {
        return false;
    }
    let words = &story.tokens[sentence.first..story.frames[number].first];
    words.iter().any(|token| matches!(token.text.as_str(), "then" | "again" | "subsequently"))
        || story.tokens[sentence.first..sentence.end]
            .iter()
            .any(|token| matches!(token.text.as_str(), "third" | "times"))
}

/// Whether the subject vehicle was pushed into somebody: what came of the crash.
fn shoved(story: &Story, contact: &Frame) -> bool {
    let pushes = |frame: &Frame| frame.sense == Sense::Push && frame.object == Some(SUBJECT) && frame.happened();
    contact.who == Some(SUBJECT) && story.frames.iter().any(|frame| frame.sentence == contact.sentence && pushes(frame))
}

fn alike(story: &Story, one: Actor, other: Actor) -> bool {
    match (story.world.actors[one].kind, story.world.actors[other].kind) {
        (Some(one), Some(other)) => same_kind(one, other) || same_kind(other, one),
        _ => true,
    }
}

/// Who touches the subject vehicle in this frame, or is touched by it.
fn with_whom(story: &Story, record: &CrashRecord, frame: &Frame, number: usize) -> Option<Actor> {
    match (frame.who, frame.object) {
        (Some(SUBJECT), Some(other)) | (Some(other), Some(SUBJECT)) if other != SUBJECT => Some(other),
        (Some(SUBJECT), Some(SUBJECT)) => None,
        (Some(SUBJECT), None) | (None, Some(SUBJECT)) => near(story, record, number),
        // "The van made contact": with whom, if not with the subject vehicle.
        // "two vehicles ahead collided".
        (Some(other), None) if story.world.actors[other].several && frame.on.is_none() => None,
        (Some(other), None) if frame.sense != Sense::ReverseContact => {
            let kind = story.world.actors[other].kind;
            // "The debris touched the rear bumper": of a thing that has none.
            let part = frame.on.as_ref().is_some_and(|piece| !piece.parts.is_empty());
            (part || kind.is_none_or(|kind| kind.group() != KindGroup::Object)).then_some(other)
        }
        (None, None) if frame.sense == Sense::ContactMade => near(story, record, number),
        _ => None,
    }
}

fn between_others(frame: &Frame) -> bool {
    let pair = [frame.who, frame.object];
    frame.is_contact()
        && !pair.contains(&Some(SUBJECT))
        && frame.who.is_some()
        && frame.object.is_some()
        && (frame.who != frame.object || frame.sense == Sense::ContactMade)
}

/// Whether a contact of two others came before the crash: told before it, told as the first, or followed by the crash told
/// again.
fn comes_first(story: &Story, number: usize, crash: usize, touching: &[(usize, Actor)]) -> bool {
    let frame = &story.frames[number];
    let says_first = story.tokens[frame.first.saturating_sub(2)..frame.end].iter().any(|token| token.text == "first");
    number < crash || says_first || touching.iter().any(|(touch, _)| *touch > number)
}

/// Who was named last before this frame, or announced.
fn near(story: &Story, record: &CrashRecord, number: usize) -> Option<Actor> {
    let before = |several: bool| {
        story.frames[..number].iter().rev().find_map(|frame| {
            let one = |actor: Actor| several || !story.world.actors[actor].several;
            let mut pair = [frame.who, frame.object].into_iter().flatten();
            pair.find(|&actor| actor != SUBJECT && lively(story, actor) && one(actor))
        })
    };
    // "The mirrors of the two vehicles touched": of two.
    let pair = story.frames[number].sense == Sense::ContactMade;
    let named = before(false).filter(|_| pair).or_else(|| before(true));
    named.or_else(|| announced(story)).or_else(|| only_other(story, record))
}

/// Whether a sentence tells what harm was done, or of exchanges of details: nobody drives there any more.
pub(super) fn tells_harm(story: &Story, sentence: usize) -> bool {
    let range = story.sentences[sentence];
    let harm = |word: &str| matches!(word, "injuries" | "injury" | "damage" | "exchanged" | "police");
    story.tokens[range.first..range.end].iter().any(|token| harm(&token.text))
}

fn lively(story: &Story, actor: Actor) -> bool {
    story.world.actors[actor].kind.is_none_or(|kind| kind.group() != KindGroup::Object)
}

/// Whom the headline names.
fn announced(story: &Story) -> Option<Actor> {
    let headline = story.frames.iter().find(|frame| frame.sense == Sense::Headline)?;
    [headline.object, headline.who].into_iter().flatten().find(|&actor| actor != SUBJECT)
}

/// The other road user of the story; of several the first whom the column means and who does what the column says.
fn only_other(story: &Story, record: &CrashRecord) -> Option<Actor> {
    let others: Vec<Actor> = (1..story.world.actors.len())
        .filter(|&actor| lively(story, actor) && story.world.actors[actor].towed_by.is_none())
        .collect();
    let stands = |actor: Actor| {
        story.frames.iter().any(|frame| frame.who == Some(actor) && frame.sense == Sense::Parked && frame.happened())
    };
    let parked = record.cp_movement.known().map(|movement| movement == Movement::Parked);
    let fits = |&&actor: &&Actor| {
        let kind = story.world.actors[actor].kind.and_then(Kind::partner_kind);
        let meant = kind.is_none() || record.partner.known().is_none_or(|column| kind == Some(column));
        meant && parked.is_none_or(|parked| parked == stands(actor))
    };
    others.iter().find(fits).or(others.first()).copied()
}
