//! Speeds, as the words tell them: of the contact, of the way there, or posted.

use super::Reading;
use crate::frame::Frame;
use crate::lexicon::{Adjective, Form, Meaning, Sense};
use crate::token::{Token, TokenKind};
use crate::world::{Actor, SUBJECT, same_kind};
use recrash_model::account::{Act, Fact, Kind, Speed, SpeedMeaning};
use recrash_model::record::MPS_PER_MPH;

/// "slowed to about 6 mph", "accelerated to 5 mph": the words before the number, where nothing is told of a later speed. "Up to 10 mph" is
/// the most that it reached.
fn slowed_to(before: &[Token], frame: &Frame) -> bool {
    if before.windows(2).any(|pair| pair[0].text == "up" && pair[1].text == "to") {
        return false;
    }
    let to = before.iter().rev().find(|token| {
        !matches!(token.text.as_str(), "about" | "approximately" | "around" | "roughly" | "only" | "just" | "~")
    });
    matches!(frame.act(), Some(Act::Slow | Act::Accelerate))
        && frame.happened()
        && to.is_some_and(|token| token.text == "to")
}

/// "at the time of impact it was doing 30 mph", "was doing 30 mph at the moment of contact", "the crash signal was logged at 30 mph": no
/// other speed stands in between.
fn at_impact(tokens: &[Token], (first, end): (usize, usize), at: usize) -> bool {
    let word = |at: usize| tokens[at].text.as_str();
    let speed = |at: &usize| word(*at).ends_with("mph");
    let crash = |at: usize| matches!(word(at), "impact" | "crash" | "collision" | "contact");
    let mark = |at: usize| {
        let signal = at > first && crash(at - 1) && matches!(word(at), "signal" | "speed");
        let time = |at: usize| matches!(word(at), "time" | "moment" | "instant" | "point");
        signal || crash(at) && (first.max(at.saturating_sub(3))..at).any(time)
    };
    let before = || (first..at).rev().take_while(|at| !speed(at)).any(mark);
    let behind = || (at + 2..end.min(at + 9)).take_while(|at| !speed(at)).any(mark);
    let earlier = (first..end).any(|at| matches!(word(at), "before" | "prior"));
    !earlier && (before() || behind())
}

/// "was doing 2 mph when it struck the van", "struck it while traveling at 5 mph": nothing else happened in between.
fn is_until_contact(reading: &Reading<'_>, number: usize, at: usize) -> bool {
    let (frames, tokens) = (&reading.story.frames, &reading.story.tokens);
    let frame = &frames[number];
    let goes = frame.form == Form::Ing && frame.act() == Some(Act::Follow);
    let here = |other: &Frame| other.sentence == frame.sentence;
    let touches = |other: &&Frame| here(other) && other.is_contact();
    let behind = frames[number + 1..].iter().take_while(|other| here(other)).find(touches);
    if let Some(contact) = behind.filter(|_| goes) {
        let yields = |other: &Frame| other.who == frame.who && other.sense == Sense::Yield;
        let mut between = frames[number + 1..].iter().take_while(|other| other.first < contact.first);
        let when = tokens[at..contact.first.max(at)].iter().any(|token| token.text == "when");
        return when && between.all(|other| other.act().is_none() || other.aside || yields(other));
    }
    let before = frames[..number]
        .iter()
        .rev()
        .take_while(|other| here(other))
        .find(|other| other.act().is_some() || other.is_contact());
    let while_so = frame.first > 0 && tokens[frame.first - 1].text == "while";
    goes && while_so && before.is_some_and(Frame::is_contact)
}

/// "The AV was traveling at 4 mph", right behind the sentence of a contact, and nothing else: how fast it was then. With such a sentence
/// a story may also begin behind its headline.
pub(super) fn is_of_last_contact(reading: &Reading<'_>, sentence: usize) -> bool {
    const OTHER_TIME: [&str; 12] = [
        "before",
        "prior",
        "initially",
        "originally",
        "previously",
        "then",
        "after",
        "afterwards",
        "later",
        "until",
        "when",
        "as",
    ];
    let story = &reading.story;
    let Some(before) = sentence.checked_sub(1) else { return false };
    let touches = |frame: &Frame| frame.is_contact() && [frame.who, frame.object].contains(&Some(SUBJECT));
    let last = story.frames.iter().filter(|frame| touches(frame)).map(|frame| frame.sentence).max() == Some(before);
    let is_back = |sentence: usize| reading.back.contains(&sentence);
    let drove = |frame: &Frame| frame.sentence == before && frame.act().is_some_and(|act| act != Act::Hold);
    let no_headline = || is_back(before) || reading.before(SUBJECT).any(|(_, frame)| drove(frame));
    let goes = |frame: &Frame| frame.form == Form::Ing && frame.act() == Some(Act::Follow) || frame.state;
    let mut told = story.frames.iter().filter(|frame| frame.sentence == sentence);
    let range = story.sentences[sentence];
    let mut words = story.tokens[range.first..range.end].iter();
    last && (!is_back(sentence) || no_headline())
        && told.all(goes)
        && !words.any(|token| OTHER_TIME.contains(&token.text.as_str()))
}

/// Whether somebody braked or stopped behind this frame, before the contact.
fn slows_later(reading: &Reading<'_>, actor: Actor, number: usize) -> bool {
    reading.before(actor).any(|(later, frame)| {
        later > number && frame.happened() && matches!(frame.act(), Some(Act::Slow | Act::Stop | Act::Hold))
    })
}

/// "the speed of the van was 5 mph", "an impact from the van at 1 mph": whose speed it is by a noun, and whether that names the contact.
fn owner_of_speed(reading: &Reading<'_>, first: usize, at: usize) -> Option<(Actor, bool)> {
    let tokens = &reading.story.tokens;
    let word = |at: usize| tokens[at].text.as_str();
    let from = first.max(at.saturating_sub(OWNER_WITHIN));
    let ends = |at: &usize| matches!(word(*at), "," | "and" | "while" | "when" | "as") || word(*at).ends_with("mph");
    let noun = (from..at).rev().take_while(|at| !ends(at)).find(|at| {
        let speed = word(*at) == "speed" && word(at + 1) == "of";
        let impact = matches!(word(*at), "impact" | "contact" | "collision") && word(at + 1) == "from";
        speed || impact
    })?;
    let article = usize::from(crate::chunk::is_determiner(word(noun + 2)));
    let lexicon = crate::lexicon::Lexicon::get();
    let named = lexicon.longest(tokens, noun + 2 + article, |meaning| {
        matches!(meaning, Meaning::Subject | Meaning::Company | Meaning::Kind(_) | Meaning::Adjective(_))
    })?;
    // "the speed of the vehicle": of which one is not told.
    let behind = noun + 2 + article + named.length;
    let numbered = || tokens.get(behind).is_some_and(|token| token.kind == TokenKind::Number && token.text != "1");
    let owner = match named.meaning {
        Meaning::Subject | Meaning::Company => Some(SUBJECT),
        Meaning::Kind(Kind::Vehicle) if !numbered() => None,
        Meaning::Adjective(Adjective::Other | Adjective::Another) => reading.contacts.partner,
        // "the speed of the bus ahead", of whom the van struck: not the van's.
        Meaning::Kind(said) => {
            let fits = |who: &Actor| reading.story.world.actors[*who].kind.is_none_or(|known| same_kind(known, said));
            reading.contacts.partner.filter(fits)
        }
        _ => None,
    }?;
    // "upon impact from the van the AV was traveling at 20 mph": the verb says whose.
    let within = |frame: &Frame| frame.first > noun && frame.first < at && frame.who.is_some_and(|who| who != owner);
    (!reading.story.frames.iter().any(within)).then_some((owner, word(noun) != "speed"))
}

/// Whose speed it is stands so near before the number. [tokens]
const OWNER_WITHIN: usize = 14;

/// Speeds that the words tell of somebody.
pub(super) fn speeds(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<Speed>> {
    let tokens = &reading.story.tokens;
    let mut all = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        let joined = token.text.strip_suffix("mph").and_then(|number| number.parse::<f64>().ok());
        let unit = tokens.get(at + 1).map_or("", |next| next.text.as_str());
        // "for 2 miles" is no speed.
        let an_hour =
            || tokens.get(at + 2).is_some_and(|next| matches!(next.text.as_str(), "per" | "an" | "hour" | "/"));
        let apart = token
            .text
            .parse::<f64>()
            .ok()
            .filter(|_| token.kind == TokenKind::Number && (unit == "mph" || unit == "miles" && an_hour()));
        let Some(mph) = joined.or(apart).filter(|mph| *mph < 200.0) else { continue };
        let last_frame = reading
            .story
            .frames
            .iter()
            .enumerate()
            .rev()
            .find(|(_, frame)| frame.first < at && !frame.aside && frame.who.is_some());
        let Some((number, frame)) = last_frame else { continue };
        let sentence = reading.story.sentences[frame.sentence];
        let owner = owner_of_speed(reading, sentence.first, at);
        let impact = owner.is_some_and(|(_, impact)| impact)
            || at_impact(tokens, (sentence.first, sentence.end), at)
            || is_until_contact(reading, number, at)
            || is_of_last_contact(reading, frame.sentence);
        let in_time = impact || !reading.is_after(number);
        let who = owner.map(|(owner, _)| owner).or(frame.who);
        if who != Some(actor) || !(sentence.first..sentence.end).contains(&at) || !in_time {
            continue;
        }
        let near: Vec<&str> =
            tokens[at.saturating_sub(4)..tokens.len().min(at + 5)].iter().map(|token| token.text.as_str()).collect();
        let limit = near.iter().any(|word| matches!(*word, "zone" | "limit" | "posted"));
        let meaning = if limit {
            SpeedMeaning::Posted
        } else if frame.is_contact()
            || impact
            || slowed_to(&tokens[at.saturating_sub(4)..at], frame) && !slows_later(reading, actor, number)
        {
            SpeedMeaning::Impact
        } else {
            SpeedMeaning::Approach
        };
        all.push(reading.told(Speed { mps: mph * MPS_PER_MPH, meaning }, at, tokens.len().min(at + 2)));
    }
    all
}
