//! Reports that tell the crash first, and then how it came to it.

use super::Reading;
use super::contact::Contacts;
use crate::frame::{Frame, Story};
use crate::lexicon::{Form, Sense};
use crate::token::{MONTHS, Token, is_crash_noun};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::Act;
use std::ops::Range;

/// The sentences behind the one of the crash that tell what had been before it; empty where the story goes straight on.
pub(super) fn told_back(story: &Story, contacts: &Contacts) -> Range<usize> {
    let Some(contact) = contacts.first.map(|number| &story.frames[number]) else { return 0..0 };
    let lead = contact.sentence;
    let acts = |frame: &&Frame| frame.act().is_some() && frame.happened() && !frame.aside;
    if !contact.is_contact() {
        return until_the_impact(story, lead);
    }
    let anew = begins_anew(story, contacts, contact);
    if !anew.is_empty() {
        return anew;
    }
    if leads_to_the_contact(story, contacts, lead + 1) {
        return lead + 1..lead + 2;
    }
    if story.frames.iter().filter(acts).any(|frame| frame.sentence < lead) {
        return told_again(story, contact);
    }
    let tells = |sentence: &usize| story.frames.iter().any(|frame| frame.sentence == *sentence && !frame.aside);
    let next = (lead + 1..story.sentences.len()).find(tells);
    let begins = (lead + 1..story.sentences.len()).find(|&sentence| {
        had_been(story, contacts, sentence) || Some(sentence) == next && was_under_way(story, sentence)
    });
    let Some(begin) = begins.or_else(|| begins_behind_headline(story, contacts, lead)) else { return 0..0 };
    let end = (begin..story.sentences.len()).find(|&sentence| is_aftermath(story, sentence));
    begin..end.unwrap_or(story.sentences.len())
}

/// The frames in the order of what happened, of somebody: the state in which the headline has the subject vehicle comes last, where the
/// story is told again behind it; and the frame of the contact to which that belongs. What the headline and the story both tell was done once.
pub(super) fn in_order(reading: &Reading<'_>, actor: Actor) -> (Vec<usize>, Option<usize>) {
    let all = 0..reading.story.frames.len();
    let last = |number: &usize| actor == SUBJECT && is_state_at_crash(reading, *number);
    let touches = |number: &usize| reading.story.frames[*number].is_contact() && !reading.is_after(*number);
    let (at_crash, mut order): (Vec<usize>, Vec<usize>) = all.clone().partition(last);
    order.retain(|number| !is_told_once_more(reading, *number) && !is_where_it_operates(reading, *number));
    let contact = all.rev().find(touches).filter(|_| !at_crash.is_empty());
    // What came of it stays behind.
    let after = order.iter().position(|number| reading.is_after(*number)).unwrap_or(order.len());
    order.splice(after..after, at_crash);
    (order, contact)
}

/// "The AV was stopped when it was rear-ended. The AV was traveling north and slowing for a light, and a van struck it": a state at the
/// crash, and not the first that it did.
pub(super) fn is_state_at_crash(reading: &Reading<'_>, number: usize) -> bool {
    let frame = &reading.story.frames[number];
    let stands = frame.who == Some(SUBJECT) && frame.act() == Some(Act::Hold) && frame.happened();
    if !stands || reading.is_after(number) || !tells_the_crash(reading, frame.sentence) {
        return false;
    }
    let tells = |other: &Frame| other.act().is_some() || other.sense == Sense::Yield;
    let behind = || {
        let later = reading.before(SUBJECT).filter(|(_, other)| other.sentence > frame.sentence);
        later.filter(|(_, other)| !other.aside && !other.described && other.happened() && tells(other))
    };
    let Some((_, next)) = behind().next() else { return false };
    // Who was about to leave its place had stood there first.
    let leaves = matches!(
        next.act(),
        Some(Act::Hold | Act::SetOff | Act::PullOut | Act::Reverse | Act::Accelerate | Act::OpenDoor)
    );
    // "The AV drove west and stopped", and not "drove on".
    let stops =
        |(_, other): (usize, &Frame)| matches!(other.act(), Some(Act::Stop | Act::Hold | Act::Slow | Act::Park));
    let under_way = next.form == Form::Ing && goes_behind(reading, next, &["was", "been"]);
    let had = goes_behind(reading, next, &["had"]);
    !leaves && (under_way || had || behind().any(stops))
}

/// Whether one of these words stands right before a verb.
fn goes_behind(reading: &Reading<'_>, frame: &Frame, words: &[&str]) -> bool {
    let story = &reading.story;
    let from = story.sentences[frame.sentence].first.max(frame.first.saturating_sub(3));
    story.tokens[from..=frame.first].iter().any(|token| words.contains(&token.text.as_str()))
}

/// Whether a sentence tells that the subject vehicle was touched, or touched somebody.
fn tells_the_crash(reading: &Reading<'_>, sentence: usize) -> bool {
    let touches = |frame: &Frame| frame.is_contact() && [frame.who, frame.object].contains(&Some(SUBJECT));
    reading.story.frames.iter().any(|frame| frame.sentence == sentence && touches(frame))
}

/// "An AV operating in Oakland was hit by a van. It stood at a light": of the headline, where it is in service.
fn is_where_it_operates(reading: &Reading<'_>, number: usize) -> bool {
    let frame = &reading.story.frames[number];
    if is_only_a_mode(reading, number) {
        return true;
    }
    let words = &reading.story.tokens[frame.first..(frame.first + 3).min(reading.story.tokens.len())];
    let operates =
        words[0].text == "operating" && words.iter().any(|token| token.text == "in") && frame.form == Form::Ing;
    let later = |(_, other): (usize, &Frame)| {
        other.sentence > frame.sentence && !other.aside && other.happened() && other.act().is_some()
    };
    frame.who == Some(SUBJECT)
        && operates
        && words.last().is_some_and(|token| token.capital)
        && tells_the_crash(reading, frame.sentence)
        && reading.before(SUBJECT).any(later)
}

/// "The AV, operating autonomously, was stopped at a light": who drives it, and no way that it came.
fn is_only_a_mode(reading: &Reading<'_>, number: usize) -> bool {
    let (frames, tokens) = (&reading.story.frames, &reading.story.tokens);
    let frame = &frames[number];
    let operates = ["operat", "driving", "driven"].iter().any(|stem| tokens[frame.first].text.starts_with(stem));
    if frame.who != Some(SUBJECT) || frame.act() != Some(Act::Follow) || !operates || frame.heading.is_some() {
        return false;
    }
    // Who set off later was on its way, whatever it stood for.
    let leaves = |(later, other): (usize, &Frame)| {
        let moves = matches!(
            other.act(),
            Some(Act::SetOff | Act::Enter | Act::Turn | Act::Follow | Act::LaneChange | Act::Pass)
        );
        later > number && moves && other.happened()
    };
    if reading.before(SUBJECT).any(leaves) {
        return false;
    }
    let mut own = reading.before(SUBJECT).skip_while(|(other, _)| *other <= number).map(|(_, other)| other);
    let Some(next) = own.find(|other| other.act().is_some() && other.happened()) else { return false };
    let between: Vec<&str> =
        tokens[frame.first..next.first.max(frame.first)].iter().map(|token| token.text.as_str()).collect();
    let mode = between.iter().take(6).any(|word| {
        ["autonom", "manual", "itself", "supervis", "driverless"].iter().any(|stem| word.starts_with(stem))
    });
    let way =
        between.iter().any(|word| matches!(*word, "on" | "along" | "lane" | "toward" | "through" | "street" | "road"));
    next.act() == Some(Act::Hold) && next.sentence == frame.sentence && mode && !way
}

/// "It rolled back into a coupe. It was parked on a hill. It rolled back until it met the coupe": the headline tells an act that the story
/// tells where it tells the contact again.
fn is_told_once_more(reading: &Reading<'_>, number: usize) -> bool {
    let frames = &reading.story.frames;
    let frame = &frames[number];
    let Some(contact) = reading.contacts.first.map(|contact| frames[contact].sentence) else { return false };
    let until = contact.max(reading.back.end.saturating_sub(1));
    let moves = frame.act().is_some_and(|act| !matches!(act, Act::Hold | Act::Follow | Act::Leave));
    if !moves || frame.sentence >= until || !frame.happened() {
        return false;
    }
    // "A rider opened a door of the AV into a taxi."
    if !tells_the_crash(reading, frame.sentence) && frame.act() != Some(Act::OpenDoor) {
        return false;
    }
    let again = |other: &Frame| {
        let later = other.sentence > frame.sentence && other.sentence <= until && other.happened() && !other.aside;
        later && other.who == frame.who && other.act() == frame.act()
    };
    let leads = |other: &Frame| other.sentence < frame.sentence && other.act().is_some() && !other.aside;
    frames.iter().any(again) && !frames.iter().any(leads)
}

/// "A van struck it. The van initially waited. ... It set off and drove into it": the sentences from the one that says how it began up to
/// the one that tells the crash again.
fn begins_anew(story: &Story, contacts: &Contacts, contact: &Frame) -> Range<usize> {
    let one = |actor: Option<usize>| actor == Some(SUBJECT) || actor.is_some() && actor == contacts.partner;
    let initially = |sentence: usize| {
        let range = story.sentences[sentence];
        let words = &story.tokens[range.first..range.end.min(range.first + HOW_IT_BEGAN)];
        words.iter().any(|token| token.text == "initially")
    };
    let next = contact.sentence + 1;
    if next >= story.sentences.len() || !initially(next) || is_aftermath(story, next) {
        return 0..0;
    }
    let touches =
        |frame: &&Frame| frame.is_contact() && one(frame.who) && one(frame.object) && frame.who != frame.object;
    let again = story.frames.iter().filter(touches).map(|frame| frame.sentence).find(|sentence| *sentence > next);
    again
        .filter(|again| !(next..=*again).any(|sentence| is_aftermath(story, sentence)))
        .map_or(0..0, |again| next..again + 1)
}

/// "On May 3, at about 2:40 PM, a van bumped the AV on Elm Street. The AV drove north, ...": a sentence that tells when, and the contact
/// with nothing that led to it, is a headline, and the story begins behind it.
fn begins_behind_headline(story: &Story, contacts: &Contacts, lead: usize) -> Option<usize> {
    let range = story.sentences[lead];
    let words: Vec<&str> = story.tokens[range.first..range.end].iter().map(|token| token.text.as_str()).collect();
    let clock = words.iter().any(|word| matches!(*word, "am" | "pm" | "a.m" | "p.m" | "a.m." | "p.m."));
    let month = |token: &Token| token.capital && MONTHS.contains(&token.text.as_str());
    let date = story.tokens[range.first..range.end].iter().any(month);
    let led = |frame: &Frame| frame.sentence == lead && !frame.aside && !frame.is_contact() && frame.act().is_some();
    let one = |actor: Option<usize>| actor == Some(SUBJECT) || actor.is_some() && actor == contacts.partner;
    let tells =
        |frame: &Frame| frame.sentence == lead + 1 && one(frame.who) && frame.happened() && frame.act().is_some();
    let next = story.sentences.get(lead + 1)?;
    let mut begin = story.tokens[next.first..next.end.min(next.first + 8)].iter().map(|token| token.text.as_str());
    let goes_on =
        begin.any(|word| matches!(word, "then" | "after" | "following" | "upon" | "subsequently" | "continued"));
    let headline = (clock || date) && !story.frames.iter().any(led);
    (headline && !goes_on && story.frames.iter().any(tells) && !is_aftermath(story, lead + 1)).then_some(lead + 1)
}

/// "It braked hard before making contact", "was still slowing down prior to the impact", of one of the two: what led to it.
fn leads_to_the_contact(story: &Story, contacts: &Contacts, sentence: usize) -> bool {
    let Some(range) = story.sentences.get(sentence) else { return false };
    let words: Vec<&str> = story.tokens[range.first..range.end].iter().map(|token| token.text.as_str()).collect();
    let touch =
        |word: &&str| matches!(*word, "contact" | "impact" | "collision" | "colliding" | "collided" | "impacting");
    // "contact information" is exchanged afterwards.
    let names = |rest: &[&str]| {
        let at = rest.iter().take(4).position(touch);
        at.is_some_and(|at| !matches!(rest.get(at + 1), Some(&("information" | "details" | "info"))))
    };
    let until = (1..words.len()).find(|&at| match words[at] {
        "before" => names(&words[at + 1..]),
        "prior" => words.get(at + 1) == Some(&"to") && names(&words[at + 2..]),
        _ => false,
    });
    let Some(until) = until.map(|at| range.first + at) else { return false };
    let one = |actor: Option<usize>| actor == Some(SUBJECT) || actor.is_some() && actor == contacts.partner;
    let mut told = story.frames.iter().filter(|frame| frame.sentence == sentence && !frame.aside);
    let leads = told.any(|frame| frame.first < until && one(frame.who) && frame.act().is_some() && frame.happened());
    // A second contact, or one with something else, came after the first.
    let goes_on =
        |word: &&str| matches!(*word, "then" | "second" | "another" | "again" | "further" | "subsequently" | "next");
    let of_else = |frame: &Frame| {
        let behind = frame.sentence == sentence && frame.first > until && frame.is_contact();
        behind && [frame.who, frame.object].into_iter().flatten().any(|actor| !one(Some(actor)))
    };
    let else_met = story.frames.iter().any(of_else);
    leads && !words.iter().any(goes_on) && !else_met && !is_aftermath(story, sentence)
}

/// "It struck a van. It was coming to a stop before it made contact": who strikes then had only slowed.
pub(super) fn stops_too_late(story: &mut Story, contacts: &Contacts) {
    let Some(contact) = contacts.first.map(|number| &story.frames[number]) else { return };
    let (striker, next) = (contact.who, contact.sentence + 1);
    if !contact.is_contact() || !leads_to_the_contact(story, contacts, next) {
        return;
    }
    let stops = |frame: &&mut Frame| frame.act() == Some(Act::Stop) && frame.form == Form::Ing && frame.who == striker;
    for frame in story.frames.iter_mut().filter(|frame| frame.sentence == next).filter(stops) {
        frame.sense = Sense::Act(Act::Slow);
    }
}

/// "Initially" stands among the first words of a sentence that says how it began. [tokens]
const HOW_IT_BEGAN: usize = 6;

/// Where nobody tells the contact, all that is told is told of the time before it, up to what came of it.
fn until_the_impact(story: &Story, lead: usize) -> Range<usize> {
    let over = |sentence: &usize| {
        let stops = |frame: &Frame| {
            let ends = matches!(frame.act(), Some(Act::Park | Act::PullOver)) || frame.sense == Sense::TakeOver;
            frame.sentence == *sentence && frame.who == Some(SUBJECT) && ends
        };
        let words = story.sentences[*sentence];
        let mut words = story.tokens[words.first..words.end].iter().map(|token| token.text.as_str());
        // "At the time of the impact": told of that moment.
        let then = words.next() == Some("at") && words.take(5).any(is_crash_noun);
        then || is_aftermath(story, *sentence) || story.frames.iter().any(stops)
    };
    0..(lead + 1..story.sentences.len()).find(over).unwrap_or(story.sentences.len())
}

/// The sentences behind the crash up to the one that tells it a second time, with what led to it: "reversed and struck it. ... The system
/// braked. The van reversed and struck it."
fn told_again(story: &Story, contact: &Frame) -> Range<usize> {
    let led = |sentence: usize, act: Option<Act>| {
        let here = |frame: &Frame| frame.sentence == sentence && frame.who == contact.who && frame.act() == act;
        act.is_some_and(|act| act != Act::Follow) && story.frames.iter().any(|frame| here(frame) && frame.happened())
    };
    let before = || story.frames.iter().filter(|frame| frame.sentence == contact.sentence && frame.who == contact.who);
    let touches = |sentence: usize| {
        let same = |frame: &Frame| frame.who == contact.who && matches!(frame.object, None | Some(SUBJECT));
        let ours = |frame: &Frame| frame.is_contact() && same(frame) && frame.sentence == sentence;
        story.frames.iter().any(ours)
    };
    let more = |sentence: usize| {
        let range = story.sentences[sentence];
        let words = &story.tokens[range.first..range.end];
        words.iter().any(|token| matches!(token.text.as_str(), "again" | "then" | "second" | "another"))
    };
    let begin = contact.sentence + 1;
    let again = (begin..story.sentences.len()).find(|&sentence| {
        touches(sentence)
            && !more(sentence)
            && !is_aftermath(story, sentence)
            && before().any(|frame| led(sentence, frame.act()))
    });
    again.map_or(0..0, |again| begin..again + 1)
}

/// "had been traveling", "had stopped", of one of the two.
fn had_been(story: &Story, contacts: &Contacts, sentence: usize) -> bool {
    let one = |frame: &&Frame| frame.who.is_some() && (frame.who == Some(SUBJECT) || frame.who == contacts.partner);
    let told = story.frames.iter().filter(|frame| frame.sentence == sentence && !frame.aside && !frame.negated);
    told.filter(one).any(|frame| {
        let from = story.sentences[sentence].first.max(frame.first.saturating_sub(4));
        let had = story.tokens[from..=frame.first].iter().any(|token| token.text == "had");
        had && !matches!(frame.act(), None | Some(Act::Leave | Act::PullOver | Act::Pushed))
    })
}

/// "was heading north", "was northbound": how things stood when it happened.
fn was_under_way(story: &Story, sentence: usize) -> bool {
    let words = story.sentences[sentence];
    // "Driving south, it was nearing a gate": the main verb.
    let fronted = |frame: &&Frame| frame.form == Form::Ing && frame.first <= words.first + 1;
    let here = || story.frames.iter().filter(|frame| frame.sentence == sentence && !frame.aside);
    let Some(first) = here().find(|frame| !fronted(frame)).or_else(|| here().next()) else {
        return false;
    };
    let was = |at: usize| matches!(story.tokens[at].text.as_str(), "was" | "were");
    let bound = (words.first + 1..words.end).any(|at| was(at - 1) && story.tokens[at].text.ends_with("bound"));
    let stands = |at: usize| was(at) || matches!(story.tokens[at].text.as_str(), "stood" | "sat");
    let stood = first.act() == Some(Act::Hold) && stands(first.first);
    let going = (first.form == Form::Ing || stood)
        && first.act().is_some_and(|act| act != Act::Leave)
        && (first.first.saturating_sub(2).max(words.first)..=first.first).any(|at| was(at) || stood && stands(at));
    first.happened() && (bound || going)
}

/// "The tow truck had been traveling behind it", "for the police car", of one that was named before: it is in the story.
fn is_known_vehicle(story: &Story, sentence: usize, words: &[Token]) -> bool {
    let [first, second, ..] = words else { return false };
    let vehicle = matches!(second.text.as_str(), "truck" | "car" | "vehicle" | "cruiser" | "suv" | "motorcycle");
    let before = &story.tokens[..story.sentences[sentence].first];
    vehicle && before.windows(2).any(|pair| pair[0].text == first.text && pair[1].text == second.text)
}

/// What came of the crash: harm, police, exchanges of details, who left.
fn is_aftermath(story: &Story, sentence: usize) -> bool {
    const AFTERMATH: [&str; 22] = [
        "injury",
        "injuries",
        "injured",
        "hurt",
        "police",
        "officer",
        "officers",
        "damage",
        "damaged",
        "exchanged",
        "towed",
        "tow",
        "scene",
        "reported",
        "reportable",
        "afterwards",
        "thereafter",
        "subsequently",
        "hospital",
        "incident",
        "pictures",
        "photographs",
    ];
    let words = story.sentences[sentence];
    let left = |frame: &Frame| frame.sentence == sentence && frame.act() == Some(Act::Leave) && frame.happened();
    let harmed = |frame: &Frame| frame.sentence == sentence && frame.sense == Sense::Damage;
    let tokens = &story.tokens[words.first..words.end];
    let after = tokens.iter().take(2).any(|token| matches!(token.text.as_str(), "after" | "following"))
        && tokens.iter().take(6).any(|token| {
            matches!(token.text.as_str(), "contact" | "collision" | "crash" | "impact" | "accident" | "this" | "that")
        });
    // "The operator took over and pulled to the side."
    let sense = |wanted: fn(&Frame) -> bool| {
        story.frames.iter().any(|frame| frame.sentence == sentence && frame.who == Some(SUBJECT) && wanted(frame))
    };
    let parks = sense(|frame| frame.sense == Sense::TakeOver)
        && sense(|frame| matches!(frame.act(), Some(Act::Park | Act::PullOver)));
    after
        || parks
        || tokens.iter().enumerate().any(|(at, token)| {
            AFTERMATH.contains(&token.text.as_str()) && !is_known_vehicle(story, sentence, &tokens[at..])
        })
        || story.frames.iter().any(|frame| left(frame) || harmed(frame))
}
