//! Event frames: who did what, to whom, where, in which order; folded from the chunks of one sentence after the other.

mod adverbs;
mod attach;
mod build;
mod doors;
mod handled;
mod heading;
mod in_lane;
mod joint;
mod likewise;
mod maneuver;
mod named;
mod naming;
mod object;
mod pairs;
mod parser;
mod pronoun;
mod reword;
mod row;
mod sense;
mod stand;
mod subject;
mod supposed;
mod verb;
mod word;

pub use crate::world::Own;

use crate::chunk::{Joint, Piece, Spot};
use crate::lexicon::{Form, Lexicon, Meaning, Occupant, Part, Progress, Relation, Sense};
use crate::token::{Sentence, Token, is_crash_noun, word};
use crate::world::{Actor, Known, SUBJECT, World};
use parser::Parser;
use recrash_model::account::{Act, Compass, KindGroup, LaneWord, LeftRight};

/// One event.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Who; `None` where nobody is named.
    pub who: Option<Actor>,
    /// The part of it that is named.
    pub with: Option<Piece>,
    /// What.
    pub sense: Sense,
    /// Form of the verb.
    pub form: Form,
    /// To whom.
    pub object: Option<Actor>,
    /// The part of whom that is named.
    pub on: Option<Piece>,
    /// To which side.
    pub side: Option<LeftRight>,
    /// Where, seen from whom.
    pub relations: Vec<(Relation, Option<Actor>)>,
    /// A direction that belongs to it.
    pub heading: Option<(Compass, usize, usize)>,
    /// The direction is that of the road it goes into.
    pub onto: bool,
    /// Its lane.
    pub lane: Option<(LaneWord, usize, usize)>,
    /// Out of where.
    pub out_of: Option<Spot>,
    /// It did not happen.
    pub negated: bool,
    /// How far it came.
    pub progress: Progress,
    /// The words say that it stood: "was stopped", or an adjective.
    pub state: bool,
    /// Told of a noun in passing, not in a clause of its own.
    pub aside: bool,
    /// Its clause begins with this.
    pub joint: Option<Joint>,
    /// The second in a row "and": told of a person in the vehicle.
    pub person: Option<Occupant>,
    /// It is told of a noun by a relative clause or a participle.
    pub described: bool,
    /// The words behind a passive "by".
    pub passive: bool,
    /// Number of the clause in its sentence.
    pub clause: u32,
    /// Number of the sentence.
    pub sentence: usize,
    /// The sentence looks back: "prior to the collision".
    pub looks_back: bool,
    /// First token.
    pub first: usize,
    /// Token behind the last.
    pub end: usize,
}

impl Frame {
    /// The act of the account that it is, where it is one.
    pub fn act(&self) -> Option<Act> {
        match self.sense {
            Sense::Act(act) | Sense::Sided(act, _) => Some(act),
            Sense::Parked => Some(Act::Hold),
            Sense::Approach => Some(Act::Follow),
            Sense::ReverseContact => Some(Act::Reverse),
            Sense::OpenDoorInto => Some(Act::OpenDoor),
            Sense::Yield => None,
            _ => None,
        }
    }

    /// Whether it touches somebody.
    pub fn is_contact(&self) -> bool {
        matches!(
            self.sense,
            Sense::Contact | Sense::ContactMade | Sense::RearEnd | Sense::ReverseContact | Sense::OpenDoorInto
        ) && !self.negated
            && self.progress == Progress::Real
    }

    /// Whether it happened, or was begun.
    pub fn happened(&self) -> bool {
        !self.negated && self.progress != Progress::Wished
    }
}

/// The story of one narrative.
#[derive(Debug, Clone)]
pub struct Story {
    /// Tokens of the narrative.
    pub tokens: Vec<Token>,
    /// Its sentences.
    pub sentences: Vec<Sentence>,
    /// Whether a sentence is a standing phrase.
    pub standing: Vec<bool>,
    /// Events, in the order of the words.
    pub frames: Vec<Frame>,
    /// Who is in it.
    pub world: World,
}

impl Story {
    /// The word of a token; nothing where none is.
    pub(crate) fn word(&self, at: usize) -> &str {
        word(&self.tokens, at)
    }
}

/// Most tokens of a narrative that are read; the longest published one has a third of it.
const MOST_TOKENS: usize = 6_000;

/// What the words of a narrative tell.
struct Told {
    /// Whether a sentence is a standing phrase.
    standing: Vec<bool>,
    /// Events of the others.
    frames: Vec<Frame>,
    /// Who is in them.
    world: World,
}

/// Reads a narrative. `own`: kind of the subject vehicle, where it is known.
pub fn story(text: &str, own: Own<'_>) -> Story {
    let mut tokens = crate::token::tokens(text);
    tokens.truncate(MOST_TOKENS);
    naming::units(&mut tokens);
    naming::companies(&mut tokens, own);
    reword::apply(&mut tokens);
    let sentences = crate::token::sentences(&tokens);
    let told = best(&tokens, &sentences, own);
    let told = meets_stranger(&told, &tokens, &sentences, own).unwrap_or(told);
    let Told { standing, mut frames, mut world } = told;
    frames.retain(|frame| adverbs::names_door(frame, &tokens, &sentences));
    adverbs::apply(&mut frames, &tokens, &sentences);
    supposed::apply(&mut frames, &tokens, &sentences);
    doors::settle(&mut frames, &tokens, &sentences, &world);
    doors::touched(&mut frames, &tokens);
    meet_each_other(&mut frames);
    strikes_both(&mut frames, &mut world, &tokens);
    pairs::apply(&mut frames, &mut world, &tokens);
    stood_itself(&mut frames, &tokens, &sentences);
    fall_once(&mut frames, &world);
    no_one_meets_itself(&mut frames);
    Story { tokens, sentences, standing, frames, world }
}

/// "A gleeper struck it", where nobody but things is named: who is meant is told by the record.
fn meets_stranger(told: &Told, tokens: &[Token], sentences: &[Sentence], own: Own<'_>) -> Option<Told> {
    let thing = |known: &Known| known.kind.is_some_and(|kind| kind.group() == KindGroup::Object);
    let alone = told.world.actors.iter().skip(1).all(thing);
    let word = own.partner.filter(|_| alone)?;
    naming::strangers(tokens).into_iter().find_map(|stranger| {
        let mut named = tokens.to_vec();
        for token in named.iter_mut().filter(|token| token.text == stranger) {
            word.clone_into(&mut token.text);
        }
        let read = best(&named, sentences, own);
        let is_stranger = |actor: Actor| {
            read.world.actors[actor].kind_tokens.is_some_and(|(_, end)| tokens[end - 1].text == stranger)
        };
        let meets = |frame: &Frame| {
            let pair = [frame.who, frame.object];
            let other = pair.into_iter().flatten().find(|actor| *actor != SUBJECT);
            frame.is_contact() && pair.contains(&Some(SUBJECT)) && other.is_some_and(is_stranger)
        };
        let met = read.frames.iter().any(meets);
        met.then_some(read)
    })
}

/// "a sedan and a van collided": with each other.
fn meet_each_other(frames: &mut [Frame]) {
    for at in 1..frames.len() {
        let (before, after) = frames.split_at_mut(at);
        let (one, other) = (&mut before[at - 1], &mut after[0]);
        let pair = one.first == other.first && one.is_contact() && one.object.is_none() && other.object.is_none();
        if pair && one.who != other.who {
            (one.object, other.object) = (other.who, one.who);
        }
    }
}

/// Nobody touches itself: who is meant then.
fn no_one_meets_itself(frames: &mut [Frame]) {
    let about: Vec<(usize, Actor)> = frames
        .iter()
        .filter(|frame| frame.act().is_some() && !frame.aside)
        .filter_map(|frame| Some((frame.sentence, frame.who.filter(|who| *who != SUBJECT)?)))
        .collect();
    for frame in frames.iter_mut().filter(|frame| frame.is_contact()) {
        // "The fender and door panels touched the edge of the van's door": whose they are is not told, and the van's they are not.
        let panels = frame.with.as_ref().is_some_and(|piece| piece.door && piece.owner.is_none());
        if frame.who == frame.object && panels && frame.who.is_some_and(|who| who != SUBJECT) {
            (frame.who, frame.with) = (Some(SUBJECT), None);
        }
        if frame.who == Some(SUBJECT) && frame.object == Some(SUBJECT) {
            // "A cyclist behind did not stop when it slowed and struck its rear": whom the sentence is about.
            frame.who = about.iter().find(|(sentence, _)| *sentence == frame.sentence).map(|(_, who)| *who);
        }
    }
}

/// "A man threw a bottle at both cars", where one other is known at most: the subject vehicle is one of the two.
fn strikes_both(frames: &mut [Frame], world: &mut World, tokens: &[Token]) {
    let vehicle = |known: &Known| known.kind.is_some_and(recrash_model::account::Kind::is_vehicle);
    for frame in frames.iter_mut().filter(|frame| frame.is_contact()) {
        let (Some(who), Some(pair)) = (frame.who, frame.object.filter(|pair| *pair != SUBJECT)) else { continue };
        let known = &world.actors[pair];
        let Some((first, _)) = known.kind_tokens.filter(|_| known.several && vehicle(known) && who != SUBJECT) else {
            continue;
        };
        let both = (first.saturating_sub(1)..=first).any(|at| tokens[at].text == "both");
        let before = |other: &Known| other.kind_tokens.is_some_and(|(at, _)| at < first);
        let others = world.actors.iter().enumerate().skip(1);
        let named = others
            .filter(|(actor, other)| ![who, pair].contains(actor) && vehicle(other) && !other.several && before(other));
        if both && named.count() <= 1 {
            frame.object = Some(SUBJECT);
            world.actors[pair].mentions = 0;
        }
    }
}

/// "A cyclist fell while passing it. ... A cyclist came up from behind, passed it and fell": the first sentence told what came of it.
fn fall_once(frames: &mut Vec<Frame>, world: &World) {
    let rides = |actor: Actor| {
        let kind = world.actors[actor].kind.map(recrash_model::account::Kind::group);
        matches!(kind, Some(KindGroup::Cyclist | KindGroup::Motorcycle | KindGroup::OnFoot))
    };
    let falls = |frame: &&Frame| frame.act() == Some(Act::Fall) && frame.happened();
    let Some(first) = frames.first().map(|frame| frame.sentence) else { return };
    let early = frames.iter().filter(falls).find(|frame| frame.sentence == first).and_then(|frame| frame.who);
    let Some(who) = early.filter(|who| rides(*who)) else { return };
    if frames.iter().filter(falls).any(|frame| frame.who == Some(who) && frame.sentence > first) {
        frames.retain(|frame| frame.sentence > first || frame.who != Some(who) || frame.is_contact());
    }
}

/// "At the time of the contact, was stopped in traffic", "Was turning left": a sentence without its subject is of the subject vehicle.
fn stood_itself(frames: &mut [Frame], tokens: &[Token], sentences: &[Sentence]) {
    let mut begun: Vec<usize> = Vec::new();
    for frame in frames.iter_mut() {
        let first = sentences[frame.sentence].first;
        let from = frame.first - usize::from(frame.first > first && tokens[frame.first].text != "was");
        let head = from == first || from > first && tokens[from - 1].text == "," && tokens[first].text == "at";
        if frame.who.is_none()
            && !frame.passive
            && frame.act().is_some()
            && tokens[from].text == "was"
            && head
            && !begun.contains(&frame.sentence)
        {
            frame.who = Some(SUBJECT);
        }
        begun.push(frame.sentence);
    }
}

/// A narrative as its words tell it; where none tells a contact, a word that nobody knows may.
fn best(tokens: &[Token], sentences: &[Sentence], own: Own<'_>) -> Told {
    let read = parse(tokens, sentences, own, false);
    if read.frames.iter().any(Frame::is_contact) {
        return read;
    }
    let guessed = parse(tokens, sentences, own, true);
    if guessed.frames.iter().any(Frame::is_contact) { guessed } else { read }
}

/// Reads the sentences that are no standing phrases.
fn parse(tokens: &[Token], sentences: &[Sentence], own: Own<'_>, guesses: bool) -> Told {
    let lexicon = Lexicon::get();
    let mut standing = Vec::new();
    let (world, frames) = (World::new(own), Vec::new());
    let mut parser = Parser { tokens, lexicon, world, frames, sentence: 0, looks_back: false, guesses };
    for (number, sentence) in sentences.iter().enumerate() {
        let words = &tokens[sentence.first..sentence.end];
        let drop = lexicon.is_standing(words) && !tells_contact(words);
        standing.push(drop);
        if drop {
            continue;
        }
        (parser.sentence, parser.world.sentence) = (number, number);
        parser.looks_back = looks_back(words) || could_not_avoid(words);
        parser.read(*sentence);
    }
    Told { standing, frames: parser.frames, world: parser.world }
}

/// A sentence with a standing phrase in it may tell the crash all the same.
fn tells_contact(words: &[Token]) -> bool {
    let tells = |phrase: &str| {
        let phrase: Vec<String> = phrase.split(' ').map(str::to_owned).collect();
        crate::lexicon::find(&phrase, words).is_some()
    };
    let touches = |at: usize| {
        let found = Lexicon::get().longest(words, at, |meaning| {
            matches!(
                meaning,
                Meaning::Verb(
                    Sense::Contact | Sense::RearEnd | Sense::ReverseContact | Sense::OpenDoorInto,
                    Form::Past | Form::Ing
                )
            )
        });
        found.is_some() && !words[at].capital
    };
    tells("made contact") || tells("collision involving") || (0..words.len()).any(touches)
}

/// Whether a sentence looks back from the crash: "Prior to the collision", "In the seconds leading up to the impact".
pub(crate) fn looks_back(words: &[Token]) -> bool {
    let text: Vec<&str> = words.iter().take(8).map(|token| token.text.as_str()).collect();
    let behind = match text.as_slice() {
        ["before" | "preceding", behind @ ..] => behind,
        [
            "prior" | "leading" | "just" | "immediately" | "shortly" | "seconds" | "moments",
            "up" | "to" | "before" | "prior",
            behind @ ..,
        ] => behind,
        _ => return false,
    };
    behind.iter().take(LOOKS_BACK_WITHIN).any(|word| is_crash_noun(word) || *word == "event")
}

/// Words from "prior" up to the crash. [words]
const LOOKS_BACK_WITHIN: usize = 3;

/// "It moved to the right but was not able to avoid contact", told behind the contact.
fn could_not_avoid(words: &[Token]) -> bool {
    let text: Vec<&str> = words.iter().map(|token| token.text.as_str()).collect();
    let avoid = text.iter().position(|word| *word == "avoid").unwrap_or(0);
    text[..avoid].ends_with(&["unable", "to"]) || text[..avoid].ends_with(&["not", "able", "to"])
}

/// Whether an act goes to a side.
pub fn sided(act: Act) -> bool {
    matches!(
        act,
        Act::Turn
            | Act::UTurn
            | Act::LaneChange
            | Act::Drift
            | Act::Swerve
            | Act::Fall
            | Act::Pass
            | Act::PullOver
            | Act::PullOut
            | Act::Park
    )
}

/// The zone that the words of a part name.
pub fn zone_of(piece: &Piece) -> Option<recrash_model::zones::ContactZone> {
    use recrash_model::zones::ContactZone as Z;
    let has = |part: Part| piece.parts.contains(&part);
    let (front, rear) = (has(Part::Front), has(Part::Rear));
    let (left, right) = (has(Part::Left), has(Part::Right));
    // Doors are on the sides, whether in front or behind.
    if piece.door && (left != right) {
        return Some(if left { Z::Left } else { Z::Right });
    }
    Some(match (front && !rear, rear && !front, left && !right, right && !left) {
        (true, _, true, _) => Z::FrontLeft,
        (true, _, _, true) => Z::FrontRight,
        (_, true, true, _) => Z::RearLeft,
        (_, true, _, true) => Z::RearRight,
        (true, ..) => Z::Front,
        (_, true, ..) => Z::Rear,
        (_, _, true, _) => Z::Left,
        (_, _, _, true) => Z::Right,
        _ if has(Part::Top) => Z::Top,
        _ if has(Part::Bottom) => Z::Bottom,
        _ => return None,
    })
}
