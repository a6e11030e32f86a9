//! Speeds, as the words tell them: of the contact, of the way there, or posted.

use super::Reading;
use crate::frame::Frame;
use crate::lexicon::{Adjective, Form, Meaning, Sense};
use crate::token::{Sentence, Token, TokenKind, word};
use crate::world::{Actor, SUBJECT, same_kind};
use recrash_model::account::{Act, Fact, Kind, Speed, SpeedMeaning};
use recrash_model::record::MPS_PER_MPH;

/// "slowed to about 6 mph", "accelerated to 5 mph", "the speed fell from 24 mph to 12 mph": the words before the number, where nothing is told of a later speed. "Up to 10 mph" is
/// the most that it reached.
fn slowed_to(before: &[Token], frame: &Frame) -> bool {
    if before.windows(2).any(|pair| pair[0].text == "up" && pair[1].text == "to") {
        return false;
    }
    let to = before.iter().rev().find(|token| {
        !matches!(token.text.as_str(), "about" | "approximately" | "around" | "roughly" | "only" | "just" | "~")
    });
    matches!(frame.act(), Some(Act::Slow | Act::Accelerate | Act::Fall))
        && frame.happened()
        && to.is_some_and(|token| token.text == "to")
}

/// "The two touched, and the AV was traveling at 6 mph at that moment": told behind a contact, of when that was.
fn at_that_moment(reading: &Reading<'_>, number: usize, at: usize) -> bool {
    let tokens = &reading.story.tokens;
    let words: Vec<&str> = tokens[at..tokens.len().min(at + 8)].iter().map(|token| token.text.as_str()).collect();
    let then = |three: &[&str]| matches!(three, ["at", "that", "moment" | "time" | "instant" | "point"]);
    let tells = |frame: &&Frame| !frame.aside && (frame.is_contact() || frame.act().is_some());
    // "The van struck a parked sedan": no contact with the subject vehicle.
    let own = |frame: &Frame| frame.who == Some(SUBJECT) || frame.object.is_none_or(|object| object == SUBJECT);
    let before = reading.story.frames[..number].iter().rev().find(tells);
    words.windows(3).any(then) && before.is_some_and(|frame| frame.is_contact() && own(frame))
}

/// "at the time of impact it was doing 30 mph", "was doing 30 mph at the moment of contact", "the crash signal was logged at 30 mph": no
/// other speed stands in between.
fn at_impact(tokens: &[Token], (first, end): (usize, usize), at: usize) -> bool {
    let speed = |at: &usize| word(tokens, *at).ends_with("mph");
    // An incident or an accident lasts longer than the touch.
    let crash = |at: usize| matches!(word(tokens, at), "impact" | "crash" | "collision" | "contact");
    let mark = |at: usize| {
        let signal = at > first && crash(at - 1) && matches!(word(tokens, at), "signal" | "speed");
        let time = |at: usize| matches!(word(tokens, at), "time" | "moment" | "instant" | "point");
        signal || crash(at) && (first.max(at.saturating_sub(3))..at).any(time)
    };
    let before = || (first..at).rev().take_while(|at| !speed(at)).any(mark);
    let behind = || (at + 2..end.min(at + 9)).take_while(|at| !speed(at)).any(mark);
    let earlier = (first..end).any(|at| matches!(word(tokens, at), "before" | "prior"));
    !earlier && (before() || behind())
}

/// "struck it while traveling", "the AV, which was traveling", "collided, with the AV going": at once with what stands before.
fn is_meanwhile(tokens: &[Token], frame: &Frame) -> bool {
    let word = |back: usize| frame.first.checked_sub(back).map_or("", |at| tokens[at].text.as_str());
    let ending = || (2..=NAME + 2).any(|back| word(back) == "with" && word(back + 1) == ",");
    let which = word(1) == "which" || word(2) == "which" && matches!(word(1), "was" | "were");
    word(1) == "while" || which || ending()
}

/// "was doing 2 mph when it struck the van", "struck it while traveling at 5 mph": nothing else happened in between.
fn is_until_contact(reading: &Reading<'_>, number: usize, at: usize) -> bool {
    let (frames, tokens) = (&reading.story.frames, &reading.story.tokens);
    let frame = &frames[number];
    // "was still moving" is one verb.
    let going = || frame.end > frame.first && tokens[frame.end - 1].text.ends_with("ing");
    let goes = frame.act() == Some(Act::Follow) && (frame.form == Form::Ing || going());
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
        .find(|other| other.first != frame.first && (other.act().is_some() || other.is_contact()));
    goes && is_meanwhile(tokens, frame) && before.is_some_and(Frame::is_contact)
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
    reading
        .before(actor)
        .any(|(later, frame)| later > number && frame.happened() && frame.act().is_some_and(Act::slows))
}

/// Who is meant by a name, of which these words tell: the subject vehicle, or the partner of a kind that fits.
fn owner_named(reading: &Reading<'_>, meaning: Meaning) -> Option<Actor> {
    let kind = |who: Actor| reading.story.world.actors[who].kind;
    match meaning {
        Meaning::Subject | Meaning::Company => Some(SUBJECT),
        Meaning::Kind(Kind::Vehicle) => None,
        Meaning::Adjective(Adjective::Other | Adjective::Another) => reading.contacts.partner,
        // "the speed of the bus ahead", of whom the van struck: not the van's.
        Meaning::Kind(said) => {
            let fits = |who: &Actor| kind(*who).is_none_or(|known| same_kind(known, said));
            let own = || kind(SUBJECT).is_some_and(|known| same_kind(known, said)).then_some(SUBJECT);
            reading.contacts.partner.filter(fits).or_else(own)
        }
        _ => None,
    }
}

/// A name that ends right before a token: "the van" before "'s" or "at".
fn named_before(reading: &Reading<'_>, first: usize, end: usize) -> Option<Meaning> {
    let lexicon = crate::lexicon::Lexicon::get();
    (first.max(end.saturating_sub(NAME))..end).find_map(|at| {
        let named = lexicon.longest(&reading.story.tokens, at, |meaning| {
            matches!(meaning, Meaning::Subject | Meaning::Company | Meaning::Kind(_))
        })?;
        (at + named.length == end).then_some(named.meaning)
    })
}

/// A name has so many words at most. [tokens]
const NAME: usize = 3;

/// "the two collided, the AV at 19 mph by then": whose it is by a noun right before it, behind a comma.
fn owner_at(reading: &Reading<'_>, first: usize, at: usize) -> Option<Actor> {
    let about =
        |at: &usize| matches!(reading.story.word(*at), "about" | "approximately" | "around" | "roughly" | "only");
    let to = (first..at).rev().find(|at| !about(at)).filter(|to| reading.story.word(*to) == "at")?;
    let begins = (first.max(to.saturating_sub(NAME + 2))..to).rev().find(|at| reading.story.word(*at) == ",")?;
    owner_named(reading, named_before(reading, begins + 1, to)?)
}

/// "the speed of the van was 5 mph", "an impact from the van at 1 mph", "its speed when struck": whose speed it is by a noun, and whether that
/// names the contact.
fn owner_of_speed(reading: &Reading<'_>, first: usize, at: usize) -> Option<(Actor, bool)> {
    let tokens = &reading.story.tokens;
    let from = first.max(at.saturating_sub(OWNER_WITHIN));
    let struck = |at: usize| word(tokens, at) == "when" && matches!(word(tokens, at + 1), "struck" | "hit");
    let ends = |at: &usize| {
        matches!(word(tokens, *at), "," | "and" | "while" | "when" | "as") && !struck(*at)
            || word(tokens, *at).ends_with("mph")
    };
    let owned = |at: usize| at > first && word(tokens, at) == "speed" && word(tokens, at - 1) == "'s" && struck(at + 1);
    let noun = (from..at).rev().take_while(|at| !ends(at)).find(|at| {
        let speed = word(tokens, *at) == "speed" && word(tokens, at + 1) == "of";
        let impact = matches!(word(tokens, *at), "impact" | "contact" | "collision") && word(tokens, at + 1) == "from";
        speed || impact || owned(*at)
    })?;
    if owned(noun) {
        return Some((owner_named(reading, named_before(reading, first, noun - 1)?)?, true));
    }
    let article = usize::from(crate::chunk::is_determiner(word(tokens, noun + 2)));
    let lexicon = crate::lexicon::Lexicon::get();
    let named = lexicon.longest(tokens, noun + 2 + article, |meaning| {
        matches!(meaning, Meaning::Subject | Meaning::Company | Meaning::Kind(_) | Meaning::Adjective(_))
    })?;
    // "the speed of the vehicle": of which one is not told.
    let behind = noun + 2 + article + named.length;
    let numbered = tokens.get(behind).is_some_and(|token| token.kind == TokenKind::Number && token.text != "1");
    let owner = match named.meaning {
        Meaning::Kind(Kind::Vehicle) if numbered => reading.contacts.partner,
        meaning => owner_named(reading, meaning),
    }?;
    let when_struck = (noun..at).any(struck);
    // "upon impact from the van the AV was traveling at 20 mph": the verb says whose.
    let within = |frame: &Frame| frame.first > noun && frame.first < at && frame.who.is_some_and(|who| who != owner);
    (when_struck || !reading.story.frames.iter().any(within))
        .then_some((owner, word(tokens, noun) != "speed" || when_struck))
}

/// Whose speed it is stands so near before the number. [tokens]
const OWNER_WITHIN: usize = 14;

/// The frame with which a speed is told: the last before it. Behind "struck the van, which was at rest, at 8 mph" it is not that of who rests.
fn told_with<'a>(reading: &'a Reading<'_>, at: usize, mph: f64) -> Option<(usize, &'a Frame)> {
    let behind_comma = at >= 2 && reading.story.tokens[at - 1].text == "at" && reading.story.tokens[at - 2].text == ",";
    let all = || reading.story.frames.iter().enumerate().rev();
    let here = |frame: &Frame| frame.first < at && !frame.aside;
    let told = |frame: &Frame| here(frame) && frame.who.is_some();
    let last = all().find(|(_, frame)| told(frame))?;
    let rests = behind_comma && mph > 0.0 && last.1.act() == Some(Act::Hold);
    let touches = |frame: &Frame| told(frame) && frame.is_contact() && frame.sentence == last.1.sentence;
    // "The van and the AV collided, the AV at 19 mph": of both.
    let both = all().find(|(_, frame)| here(frame)).filter(|(_, frame)| frame.who.is_none() && frame.is_contact());
    let both = both.filter(|(_, frame)| owner_at(reading, reading.story.sentences[frame.sentence].first, at).is_some());
    both.or_else(|| all().find(|(_, frame)| rests && touches(frame))).or(Some(last))
}

/// Speeds that the words tell of somebody.
pub(super) fn speeds(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<Speed>> {
    let tokens = &reading.story.tokens;
    let mut all = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        let joined = token.text.strip_suffix("mph").and_then(|number| number.parse::<f64>().ok());
        let unit = word(tokens, at + 1);
        // "for 2 miles" is no speed.
        let an_hour =
            || tokens.get(at + 2).is_some_and(|next| matches!(next.text.as_str(), "per" | "an" | "hour" | "/"));
        let apart = token
            .text
            .parse::<f64>()
            .ok()
            .filter(|_| token.kind == TokenKind::Number && (unit == "mph" || unit == "miles" && an_hour()));
        let Some(mph) = joined.or(apart).filter(|mph| *mph < 200.0) else { continue };
        let Some((number, frame)) = told_with(reading, at, mph) else { continue };
        let within = |sentence: &&Sentence| (sentence.first..sentence.end).contains(&at);
        let Some(sentence) = reading.story.sentences.iter().find(within) else { continue };
        let touches = |frame: &Frame| frame.is_contact() && (sentence.first..at).contains(&frame.first);
        let named = owner_at(reading, sentence.first, at);
        let named = named.map(|owner| (owner, reading.story.frames.iter().any(touches)));
        let owner = owner_of_speed(reading, sentence.first, at).or(named);
        let then = owner.is_some_and(|(_, impact)| impact)
            || at_impact(tokens, (sentence.first, sentence.end), at)
            || at_that_moment(reading, number, at);
        let impact = then || is_until_contact(reading, number, at) || is_of_last_contact(reading, frame.sentence);
        let in_time = impact || !reading.is_after(number);
        let who = owner.map(|(owner, _)| owner).or(frame.who);
        // "The speed of the AV when struck was 8 mph", "at the moment of contact": told with no verb of its own.
        let told_here = reading.story.sentences[frame.sentence].first == sentence.first;
        if who != Some(actor) || !(told_here || owner.is_some() && then) || !in_time {
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
