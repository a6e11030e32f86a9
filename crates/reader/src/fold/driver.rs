//! Who drove at the contact: the system, a human, or a human who took over.

use super::Reading;
use super::contact::tells_harm;
use crate::frame::{Frame, Story};
use crate::lexicon::{Lexicon, Occupant, Sense};
use crate::token::{Sentence, Token, is_crash_noun};
use crate::world::SUBJECT;
use recrash_model::account::{Act, Driver, Fact};
use recrash_model::record::{Coded, Engagement};

/// Who drove at the contact.
pub(super) fn driver(reading: &Reading<'_>) -> Option<Fact<Driver>> {
    let story = &reading.story;
    let took_over = story.frames.iter().enumerate().find(|(number, frame)| takes_over(reading, *number, frame));
    let mut said = Said::default();
    for sentence in &story.sentences {
        let words = &story.tokens[sentence.first..sentence.end];
        said.handed_over |= just_before(words);
        if let Some(at) = by_hand_for(words) {
            return Some(reading.told(Driver::HumanTookOver, sentence.first + at, sentence.first + at + 3));
        }
        let (human, system) = named(story, *sentence);
        let at_crash = human.or(system).filter(|_| at_impact(words)).or(human.filter(|_| at_the_time(words)));
        if let Some((value, at, length)) = at_crash {
            let by_then = || said.handed_over || took_over.is_some() || ends_autonomy(words) || later(story, *sentence);
            let value = if value == Driver::Human && by_then() { Driver::HumanTookOver } else { value };
            return Some(reading.told(value, at, at + length));
        }
        let in_time_before = has_any(words, &["30", "seconds", "prior", "within"]);
        if !in_time_before && !sentence_after(reading, sentence.first) {
            let changes = has_any(words, &["transitioned", "disengaged", "switched", "transition"]);
            said.human = said.human.or(human.filter(|_| !changes));
            said.system = said.system.or(system);
        }
    }
    if let Some((_, frame)) = took_over {
        return Some(Fact { value: Driver::HumanTookOver, source: reading.of(frame) });
    }
    // Driven by hand, and by the system within the half minute before.
    if let Some((_, at, length)) = said.human.filter(|_| said.handed_over) {
        return Some(reading.told(Driver::HumanTookOver, at, at + length));
    }
    if let (None, Some(frame)) = (&said.human, by_hand(reading)) {
        return Some(Fact { value: Driver::HumanTookOver, source: reading.of(frame) });
    }
    if let Some((value, at, length)) = said.human.or(said.system) {
        return Some(reading.told(value, at, at + length));
    }
    match reading.record.engagement {
        Coded::Known(Engagement::Ads | Engagement::Adas) => {
            Some(Fact::of_column(Driver::System, "Automation System Engaged?"))
        }
        Coded::Known(Engagement::NotEngaged) => Some(Fact::of_column(Driver::Human, "Engagement Status")),
        _ => None,
    }
}

/// Who is said to drive, with the first token that says so, and their count.
type Named = (Driver, usize, usize);

/// What the sentences say that tell of no moment.
#[derive(Default)]
struct Said {
    human: Option<Named>,
    system: Option<Named>,
    /// The system drove, or handed over, in the half minute before.
    handed_over: bool,
}

/// Whether a sentence says that a human drove, and that the system did.
fn named(story: &Story, sentence: Sentence) -> (Option<Named>, Option<Named>) {
    let lexicon = Lexicon::get();
    let words = &story.tokens[sentence.first..sentence.end];
    let human = lexicon.human(words).map(|(at, length)| (Driver::Human, sentence.first + at, length));
    let system = lexicon.system(words).map(|(at, length)| (Driver::System, sentence.first + at, length));
    (human.filter(|(_, at, _)| !of_another(story, *at)), system)
}

/// Whether one of some words stands here.
fn has_any(words: &[Token], wanted: &[&str]) -> bool {
    words.iter().any(|token| wanted.contains(&token.text.as_str()))
}

/// "was disengaged at the time", "no longer in autonomous mode": the system drove until then.
fn ends_autonomy(words: &[Token]) -> bool {
    has_any(words, &["disengaged", "longer", "switched", "off"])
}

/// "Autonomy had been active within the 30 seconds before", told in one of the two sentences behind.
fn later(story: &Story, sentence: Sentence) -> bool {
    let rest = story.sentences.iter().filter(|other| other.first >= sentence.end);
    rest.take(2).any(|other| just_before(&story.tokens[other.first..other.end]))
}

/// Whether a human took the subject vehicle over before the contact.
fn takes_over(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    frame.sense == Sense::TakeOver
        && frame.happened()
        && frame.who.is_none_or(|who| who == SUBJECT)
        && (!reading.is_after(number) || is_told_again(reading, number) || had_done(reading, frame))
}

/// Whether the contact is told once more behind this frame: in full, where it was told first as a headline, or without the parts that met.
fn is_told_again(reading: &Reading<'_>, number: usize) -> bool {
    let story = &reading.story;
    let Some(first) = reading.contacts.first.map(|first| &story.frames[first]) else { return false };
    let early = story.standing.iter().position(|standing| !standing);
    let headline = Some(first.sentence) == early;
    let bare = first.on.is_none() && first.with.is_none();
    let again = |frame: &Frame| {
        frame.is_contact()
            && !frame.looks_back
            && !frame.aside
            && (headline || frame.on.is_some() || frame.with.is_some())
            && [frame.who, frame.object].contains(&Some(SUBJECT))
    };
    (headline || bare) && story.frames[number + 1..].iter().any(again)
}

/// Whether a sentence tells of the moment of the crash: "At impact", "by the time of the contact".
fn at_impact(words: &[Token]) -> bool {
    let crash = |token: &Token| is_crash_noun(&token.text);
    let begins = words.first().is_some_and(|token| matches!(token.text.as_str(), "at" | "by"));
    let moment = |run: &[Token]| {
        matches!(run[0].text.as_str(), "at" | "by")
            && matches!(run[2].text.as_str(), "moment" | "time" | "instant")
            && run[3].text == "of"
            && run[4..].iter().any(crash)
    };
    begins && words.iter().take(7).any(crash) || words.windows(6).any(moment)
}

/// "was being driven manually at the time".
fn at_the_time(words: &[Token]) -> bool {
    let ends = |at: usize| words.get(at).is_none_or(|token| matches!(token.text.as_str(), "." | "," | ";" | "and"));
    (3..words.len()).any(|at| {
        let run: Vec<&str> = words[at - 2..=at].iter().map(|token| token.text.as_str()).collect();
        run == ["at", "the", "time"] && ends(at + 1)
    })
}

/// Whether the words at this token tell of another vehicle: "a second one, operating in manual mode, struck it".
fn of_another(story: &Story, at: usize) -> bool {
    let last = story.frames.iter().rev().find(|frame| frame.first <= at && !frame.aside && frame.who.is_some());
    last.is_some_and(|frame| {
        let sentence = story.sentences[frame.sentence];
        (sentence.first..sentence.end).contains(&at)
            && frame.who.is_some_and(|who| who != SUBJECT)
            && ["operat", "driv"].iter().any(|stem| story.tokens[frame.first].text.starts_with(stem))
    })
}

/// "It struck the van, which at that time had disengaged": told behind the contact, and done before it.
fn had_done(reading: &Reading<'_>, frame: &Frame) -> bool {
    let contact = reading.contacts.first.map(|number| reading.story.frames[number].sentence);
    let before = frame.first.checked_sub(1).map(|at| reading.story.tokens[at].text.as_str());
    let sentence = reading.story.sentences[frame.sentence];
    let words: Vec<&str> =
        reading.story.tokens[frame.first..sentence.end].iter().map(|token| token.text.as_str()).collect();
    // "It disengaged before the impact", told behind it.
    let until = words
        .iter()
        .position(|word| matches!(*word, "before" | "prior"))
        .is_some_and(|at| words[at..].iter().take(5).any(|word| is_crash_noun(word)));
    until || contact == Some(frame.sentence) && before == Some("had")
}

/// The first thing that the human at the wheel did to the vehicle before the contact.
fn by_hand<'a>(reading: &'a Reading<'_>) -> Option<&'a Frame> {
    let contact = reading.contacts.first.map(|number| reading.story.frames[number].sentence)?;
    reading.before(SUBJECT).map(|(_, frame)| frame).find(|frame| {
        frame.sentence + 1 >= contact
            && frame.person == Some(Occupant::Driver)
            && frame.happened()
            && matches!(frame.act(), Some(Act::Slow | Act::Swerve | Act::Stop | Act::Turn | Act::LaneChange))
    })
}

/// Whether a sentence says that the system drove, or handed over, in the half minute before: "autonomy was engaged within the
/// 30 second period".
fn just_before(words: &[Token]) -> bool {
    let any = |wanted: &[&str]| has_any(words, wanted);
    any(&["second", "seconds"])
        && any(&["within", "prior", "before", "earlier", "less", "during", "in"])
        && any(&["autonomy", "disengaged", "autonomous", "autonomously", "engaged"])
        && !any(&["not", "minutes"])
}

/// Where a sentence says "in manual mode for approximately 10 seconds prior": the system drove until then.
fn by_hand_for(words: &[Token]) -> Option<usize> {
    let any = |wanted: &[&str]| has_any(words, wanted);
    let at =
        words.windows(3).position(|run| run[0].text == "manual" && run[1].text == "mode" && run[2].text == "for")?;
    (any(&["seconds"]) && any(&["prior", "before"])).then_some(at)
}

/// Whether a sentence stands behind the one of the contact; where nobody tells that, whether it tells what came of it.
fn sentence_after(reading: &Reading<'_>, token: usize) -> bool {
    let story = &reading.story;
    let Some(number) = reading.contacts.first else {
        let here = story.sentences.iter().position(|sentence| (sentence.first..sentence.end).contains(&token));
        return here.is_some_and(|sentence| tells_harm(story, sentence));
    };
    token >= story.sentences[story.frames[number].sentence].end
}
