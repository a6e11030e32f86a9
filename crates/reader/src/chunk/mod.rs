//! Tokens of one sentence into chunks: who is named, verbs, where, lanes, and the small words between them.

mod behind;
mod group;
mod head;
mod noun;
mod piece;
mod places;
mod town;
mod verb;

pub use head::is_of_traffic;
pub use piece::is_along_a_side;
pub use places::bound;

use crate::lexicon::{Adjective, Form, Found, Lexicon, Meaning, Occupant, Part, Relation, Sense};
use crate::token::{Token, TokenKind, word};
use recrash_model::account::{Compass, Kind, KindGroup, LaneWord, LeftRight};
use std::cell::Cell;

/// How a noun is introduced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Article {
    /// `the`, `this`, `its`.
    Definite,
    /// `a`, `an`, `one`.
    Indefinite,
    /// Nothing.
    None,
}

/// Somebody or something that is named.
#[derive(Debug, Clone, PartialEq)]
pub struct Noun {
    /// Article.
    pub article: Article,
    /// It is the subject vehicle.
    pub subject: bool,
    /// Kind.
    pub kind: Option<Kind>,
    /// The number of `Vehicle 2`.
    pub number: Option<u8>,
    /// Makes and colours, to know it again by.
    pub names: Vec<String>,
    /// Adjectives.
    pub adjectives: Vec<Adjective>,
    /// Direction, as in "an eastbound van".
    pub compass: Option<Compass>,
    /// One of several: "one of the cyclists".
    pub one_of: bool,
    /// It is called a tractor, the front half of a truck.
    pub tractor: bool,
    /// It is called a shuttle.
    pub shuttle: bool,
    /// It is called the second, or so.
    pub ordinal: Option<u8>,
    /// It is called a passenger vehicle, and is no bus.
    pub passenger: bool,
    /// It is another one with a name of the subject vehicle: "a different AV".
    pub namesake: bool,
    /// More than one.
    pub several: bool,
    /// Somebody in a vehicle.
    pub occupant: Option<(Occupant, bool)>,
    /// The vehicle of somebody, or of a part.
    pub owner: Option<Box<Noun>>,
}

impl Noun {
    /// "the vehicle", or somebody in it: which one, the story tells.
    pub fn is_plain_vehicle(&self) -> bool {
        self.kind == Some(Kind::Vehicle)
            && self.article == Article::Definite
            && self.adjectives.is_empty()
            && self.names.is_empty()
            && self.number.is_none()
            && !self.several
    }

    /// A noun of which nothing is said yet.
    fn unnamed() -> Self {
        Self {
            article: Article::None,
            subject: false,
            kind: None,
            number: None,
            names: Vec::new(),
            adjectives: Vec::new(),
            compass: None,
            one_of: false,
            tractor: false,
            shuttle: false,
            ordinal: None,
            passenger: false,
            namesake: false,
            several: false,
            occupant: None,
            owner: None,
        }
    }
}

/// A part of a vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// What the words say.
    pub parts: Vec<Part>,
    /// It is a door.
    pub door: bool,
    /// It is a mirror.
    pub mirror: bool,
    /// It is open, or opened.
    pub open: bool,
    /// Whose; `None` where that is not said.
    pub owner: Option<Noun>,
    /// `its`.
    pub its: bool,
}

impl Piece {
    /// On which side it is, where it names one.
    pub(crate) fn side(&self) -> Option<LeftRight> {
        match (self.parts.contains(&Part::Left), self.parts.contains(&Part::Right)) {
            (true, false) => Some(LeftRight::Left),
            (false, true) => Some(LeftRight::Right),
            _ => None,
        }
    }

    /// A door of which no more is said.
    pub(crate) fn a_door() -> Self {
        Self { door: true, ..Self::of(Part::Noun) }
    }

    /// A part of which no more is said than on which side it is.
    pub(crate) fn of(part: Part) -> Self {
        Self { parts: vec![part], door: false, mirror: false, open: false, owner: None, its: false }
    }
}

/// A chunk of a sentence.
#[derive(Debug, Clone, PartialEq)]
pub enum Chunk {
    /// Somebody or something.
    Noun(Noun),
    /// A part.
    Piece(Piece),
    /// A verb.
    Verb(Sense, Form),
    /// Where.
    Relation(Relation),
    /// A direction.
    Compass(Compass),
    /// To the left or right, with nothing behind it.
    Side(LeftRight),
    /// A lane.
    Lane(LaneWord),
    /// A place that somebody comes out of, or goes into.
    Spot(Spot),
    /// `it`, `they`.
    Pronoun,
    /// `that`, `which`, `who`.
    Relative,
    /// A form of `be`.
    Be,
    /// `to` before a verb, and the like.
    Preposition(&'static str),
    /// A word that joins clauses.
    Joint(Joint),
    /// `not`, `without`, `failed to`.
    Not,
    /// A comma.
    Comma,
    /// Any other word.
    Word,
}

/// Places beside the road.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spot {
    /// A stall.
    Stall,
    /// A driveway, a garage, a lot, an alley.
    Driveway,
    /// The kerb.
    Curb,
    /// A sidewalk.
    Sidewalk,
    /// A crossing road.
    SideStreet,
}

/// Words that join clauses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Joint {
    /// `and`, `then`, `but`.
    And,
    /// `when`, `as`, `while`.
    While,
    /// `after`, `once`.
    After,
    /// `before`, `until`.
    Before,
    /// `because`.
    Because,
}

/// A chunk and its tokens.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// The chunk.
    pub chunk: Chunk,
    /// First token.
    pub first: usize,
    /// Token behind the last.
    pub end: usize,
}

const PREPOSITIONS: [&str; 28] = [
    "to", "of", "with", "by", "on", "in", "at", "into", "onto", "for", "from", "through", "between", "against",
    "across", "around", "past", "over", "under", "within", "near", "out", "along", "off", "up", "upon", "toward",
    "towards",
];

/// "so the driver of the van could": so far behind "so" stands what tells a purpose. [tokens]
const PURPOSE_WITHIN: usize = 10;

const DETERMINERS: [&str; 14] =
    ["the", "this", "that", "these", "those", "its", "their", "his", "her", "our", "a", "an", "one", "any"];

/// Whether a noun begins with this word.
pub fn is_determiner(word: &str) -> bool {
    DETERMINERS.contains(&word)
}

const COLOURS: [&str; 14] = [
    "white", "black", "red", "blue", "silver", "gray", "grey", "green", "yellow", "orange", "brown", "tan", "gold",
    "beige",
];

/// Whether a word is a colour of vehicles.
pub fn is_colour(word: &str) -> bool {
    COLOURS.contains(&word)
}

/// Splits a sentence into chunks.
pub fn chunks(tokens: &[Token], first: usize, end: usize) -> Vec<Placed> {
    let chunker = Chunker { lexicon: Lexicon::get(), tokens: &tokens[..end], first, depth: Cell::new(0) };
    let mut all: Vec<Placed> = Vec::new();
    let mut at = first;
    while at < end {
        let (chunk, length) = chunker.next(at, &all);
        let next = at + length.max(1);
        if let Some(chunk) = chunk {
            all.push(Placed { chunk, first: at, end: next });
            give_owner(&mut all, tokens);
        }
        at = next;
    }
    all
}

/// "the van's rear bumper", "the van rear bumper": the noun before a part is whose part it is.
fn give_owner(all: &mut Vec<Placed>, tokens: &[Token]) {
    let [.., before, last] = all.as_slice() else { return };
    let Chunk::Piece(piece) = &last.chunk else { return };
    let determined = DETERMINERS.contains(&tokens[last.first].text.as_str());
    if piece.owner.is_some() || piece.its || determined {
        return;
    }
    let possessive = tokens[before.first].text == "'s";
    let noun = if possessive { all.len().checked_sub(3).map(|at| &all[at]) } else { Some(before) };
    let Some(Placed { chunk: Chunk::Noun(noun), first, end }) = noun else { return };
    let adjacent = possessive || *end == last.first;
    if !adjacent || noun.occupant.is_some() {
        return;
    }
    let merged = Placed {
        // "the cars rear bumper" is one car's.
        chunk: Chunk::Piece(Piece { owner: Some(Noun { several: false, ..noun.clone() }), ..piece.clone() }),
        first: *first,
        end: last.end,
    };
    all.truncate(all.len() - if possessive { 3 } else { 2 });
    all.push(merged);
}

struct Chunker<'a> {
    lexicon: &'static Lexicon,
    tokens: &'a [Token],
    first: usize,
    /// So many nouns are being read, one in another.
    depth: Cell<usize>,
}

impl Chunker<'_> {
    fn text(&self, at: usize) -> &str {
        word(self.tokens, at)
    }

    fn next(&self, at: usize, before: &[Placed]) -> (Option<Chunk>, usize) {
        let token = &self.tokens[at];
        if token.kind == TokenKind::Mark {
            return match token.text.as_str() {
                "(" => (None, self.parenthesis(at)),
                "," | ":" => (Some(Chunk::Comma), 1),
                _ => (None, 1),
            };
        }
        if let Some(length) = self.opening(at) {
            return (Some(Chunk::Comma), length);
        }
        if let Some((piece, length)) = self.that_of(at, before) {
            return (Some(Chunk::Piece(piece)), length);
        }
        if let Some((lane, length)) = self.lane(at) {
            let chunk = if self.is_partly_there(at) { Chunk::Word } else { Chunk::Lane(lane) };
            return (Some(chunk), length);
        }
        if let Some(length) = self.run_in_words(at) {
            return (Some(Chunk::Not), length);
        }
        let joins = self.joint(at);
        if let Some((joint, length)) = joins {
            return (Some(Chunk::Joint(joint)), length);
        }
        self.longest(at, before)
            .or_else(|| self.compass(at).map(|(compass, length)| (Chunk::Compass(compass), length)))
            .map_or_else(|| self.small_word(at), |(chunk, length)| (Some(chunk), length))
    }

    /// Words before the subject that say nothing of anybody: "At some point the van", "For unknown reasons the van".
    fn opening(&self, at: usize) -> Option<usize> {
        if at != self.first {
            return None;
        }
        let words: Vec<&str> = (at..at + 5).map(|at| self.text(at)).collect();
        let length = match words.as_slice() {
            ["at", "some" | "one" | "that" | "this" | "which", "point" | "moment" | "stage" | "time", ..] => 3,
            ["for", "reasons", "not", "known", ..] => 4,
            ["for", "reasons" | "reason", "unknown" | "unclear", ..] => 3,
            ["for", "unknown" | "some", "reasons" | "reason", ..] => 3,
            ["for", "no" | "an" | "some", "apparent" | "unknown" | "known", "reason" | "reasons", ..] => 4,
            ["all", "of", "a", "sudden", ..] => 4,
            _ => return None,
        };
        is_determiner(self.text(at + length)).then_some(length)
    }

    /// The longest of relation, place, verb, part and noun; of two as long, the first of these.
    fn longest(&self, at: usize, before: &[Placed]) -> Option<(Chunk, usize)> {
        let relation = self.relation(at).map(|(relation, length)| (Chunk::Relation(relation), length));
        let spot = self.spot(at).map(|(spot, length)| (Chunk::Spot(spot), length));
        let verb = self.verb(at, before).map(|(sense, form, length)| (Chunk::Verb(sense, form), length));
        let noun = self.noun(at);
        let thing = noun.as_ref().filter(|(noun, _)| noun.kind.is_some_and(|kind| kind.group() == KindGroup::Object));
        let thing = thing.map(|(_, length)| *length);
        // A thing is named before a part of nobody as long.
        let piece =
            self.piece(at).filter(|(piece, length)| piece.owner.is_some() || piece.its || thing != Some(*length));
        let piece = piece.map(|(piece, length)| (Chunk::Piece(piece), length));
        let noun = noun.map(|(noun, length)| (Chunk::Noun(noun), length));
        let all = [relation, spot, verb, piece, noun];
        all.into_iter().flatten().reduce(|best, next| if next.1 > best.1 { next } else { best })
    }

    /// Where somebody is, seen from somebody else.
    fn relation(&self, at: usize) -> Option<(Relation, usize)> {
        if let Some(found) = self.side_of_its_owner(at) {
            return Some(found);
        }
        let found = self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Relation(_)));
        let Some(Found { meaning: Meaning::Relation(relation), length }) = found else { return self.in_next_lane(at) };
        (!self.is_no_relation(at, length)).then_some((relation, length))
    }

    /// "to the AV's left", "on the alley's right side": beside it, or on that side of the road. "The AV's left rear corner" is a part.
    fn side_of_its_owner(&self, at: usize) -> Option<(Relation, usize)> {
        let (word, street) =
            (self.text(at), matches!(self.text(at + 2), "street" | "road" | "roadway" | "alley" | "alleyway"));
        let length = match self.noun(at + 1) {
            Some((noun, length)) if (noun.subject || noun.is_plain_vehicle()) && noun.occupant.is_none() => length,
            _ if street && is_determiner(self.text(at + 1)) => 2,
            _ => return None,
        };
        let side = at + 2 + length;
        let relation = match self.text(side) {
            "left" => Relation::Left,
            "right" => Relation::Right,
            _ => return None,
        };
        let edge = usize::from(matches!(self.text(side + 1), "side" | "edge"));
        let end = side + 1 + edge;
        let touched = || (self.first.max(at.saturating_sub(2))..at).any(|at| self.touches_at(at));
        let place = match word {
            "to" | "from" | "off" => true,
            "on" | "at" | "along" => {
                if street {
                    edge == 1
                } else {
                    edge == 0 && !touched()
                }
            }
            _ => false,
        };
        (place && self.text(side - 1) == "'s" && self.part(end).is_none()).then_some((relation, end - at))
    }

    /// Whether a verb of touching stands here.
    fn touches_at(&self, at: usize) -> bool {
        let touches = |meaning| matches!(meaning, Meaning::Verb(Sense::Contact | Sense::RearEnd, _));
        self.lexicon.longest(self.tokens, at, touches).is_some()
    }

    /// "in the adjacent leftmost turn only lane": on the left, and what lane it is stands behind.
    fn in_next_lane(&self, at: usize) -> Option<(Relation, usize)> {
        let next = matches!(self.text(at), "in" | "from")
            && self.text(at + 1) == "the"
            && matches!(self.text(at + 2), "adjacent" | "neighboring");
        let (_, length) = self.lane(at + 3).filter(|_| next)?;
        let relation = (at + 3..at + 3 + length).find_map(|at| match self.text(at) {
            "left" | "leftmost" => Some(Relation::Left),
            "right" | "rightmost" => Some(Relation::Right),
            _ => None,
        })?;
        Some((relation, 3))
    }

    fn small_word(&self, at: usize) -> (Option<Chunk>, usize) {
        let word = self.text(at);
        let chunk = match word {
            "the" if matches!(self.text(at + 1), "latter" | "former") && self.text(at + 2) != "'s" => {
                return (Some(Chunk::Pronoun), 2);
            }
            // "the two drove on".
            "the" if self.text(at + 1) == "two" && self.does_at_once(at + 2) => return (Some(Chunk::Pronoun), 2),
            // "Both were northbound".
            "both" if matches!(self.text(at + 1), "were" | "are" | "had") || self.does_at_once(at + 1) => {
                Chunk::Pronoun
            }
            "itself" if at > self.first && matches!(self.text(at - 1), "was" | "is" | "had" | "also") => Chunk::Word,
            "it" | "they" | "them" | "itself" | "he" | "she" | "him" => Chunk::Pronoun,
            "we" | "us" => Chunk::Noun(Noun { subject: true, ..Noun::unnamed() }),
            "that" if self.is_demonstrative(at) => Chunk::Word,
            "that" | "which" | "who" | "whom" => Chunk::Relative,
            // "it got sideswiped by a bus".
            "got" | "gets" if matches!(self.verb(at + 1, &[]), Some((_, Form::Past, _))) => Chunk::Be,
            "is" | "are" | "was" | "were" | "be" | "been" | "being" => Chunk::Be,
            "no" | "nothing" | "nobody" if at == self.first => Chunk::Not,
            // "shows that no part of it came into contact".
            "no" if (self.text(at - 1), self.text(at + 1)) == ("that", "part") => Chunk::Not,
            "not" | "never" | "didn" | "wasn" | "couldn" | "without" | "unable" | "nor" | "neither" | "avoid"
            | "avoiding" | "avoided" => Chunk::Not,
            "failed" if matches!(self.text(at.saturating_sub(1)), "had" | "brakes" | "engine" | "steering") => {
                Chunk::Word
            }
            "fail" | "failed" | "failing" | "fails" | "refused" | "omitted" | "neglected" => Chunk::Not,
            "left" | "leftward" | "leftwards" => Chunk::Side(LeftRight::Left),
            "right" | "rightward" | "rightwards" => Chunk::Side(LeftRight::Right),
            _ => match PREPOSITIONS.iter().find(|known| **known == word) {
                Some(known) => Chunk::Preposition(known),
                None => Chunk::Word,
            },
        };
        (Some(chunk), 1)
    }

    /// "both moved off", and not "both stopped vehicles".
    fn does_at_once(&self, at: usize) -> bool {
        self.noun(at).is_none() && matches!(self.verb(at, &[]), Some((_, Form::Past, _)))
    }

    /// "in that lane", "entered that lane": no relative stands behind a preposition, or before a place.
    fn is_demonstrative(&self, at: usize) -> bool {
        let governed = at > self.first && PREPOSITIONS.contains(&self.text(at - 1));
        let next = at + 1;
        let lane = (next..next + 3).any(|at| matches!(self.text(at), "lane" | "lanes"));
        let place = self.lane(next).is_some()
            || self.spot(next).is_some()
            || lane && matches!(self.text(next), "lane" | "turn" | "turning" | "left" | "right" | "same")
            || matches!(self.text(next), "street" | "road" | "queue" | "intersection" | "junction");
        governed || !is_determiner(self.text(next)) && place
    }

    /// "the moment it set off", "at the very instant the van braked": when. "The second van" and "at the time of the crash" are not.
    fn moment(&self, at: usize) -> Option<usize> {
        let the = at + usize::from(self.text(at) == "at");
        let very = usize::from(matches!(self.text(the + 1), "very" | "same" | "exact" | "precise"));
        let noun = the + 1 + very;
        let time = matches!(self.text(noun), "moment" | "instant")
            || self.text(noun) == "second" && the == at
            || self.text(noun) == "time" && the > at;
        let behind = noun + 1 + usize::from(matches!(self.text(noun + 1), "that" | "when"));
        let clause = matches!(self.text(behind), "it" | "they" | "he" | "she" | "the" | "a" | "an" | "our" | "its");
        (self.text(the) == "the" && time && clause).then_some(behind - at)
    }

    /// "so a van could turn", "so it could turn": what room was made for. ", so the van swerved" is what came of it.
    fn is_purpose(&self, at: usize) -> bool {
        let apart = at > self.first && !matches!(self.text(at - 1), "," | "do" | "did" | "doing" | "done" | "and");
        let next = at + 1;
        let named = self.noun(next).is_some() || matches!(self.text(next), "it" | "they" | "he" | "she");
        let ends = |at: &usize| self.tokens.get(*at).is_some_and(|token| token.kind == TokenKind::Mark);
        let mut clause = (next..self.tokens.len().min(next + PURPOSE_WITHIN)).take_while(|at| !ends(at));
        apart
            && named
            && clause.any(|at| !self.tokens[at].capital && matches!(self.text(at), "could" | "might" | "would" | "can"))
    }

    fn joint(&self, at: usize) -> Option<(Joint, usize)> {
        let next = self.text(at + 1);
        // "turned so as to park": in order to.
        if self.text(at) == "as" && next == "to" && at > self.first && self.text(at - 1) == "so" {
            return None;
        }
        if next == "go" && at > self.first && self.text(at - 1) == "stop" {
            return None;
        }
        // "To then make contact": one clause.
        if self.text(at) == "then" && at > self.first && self.text(at - 1) == "to" {
            return None;
        }
        Some(match self.text(at) {
            "and" | "then" | "but" | "however" | "subsequently" | "or" => (Joint::And, 1),
            "when" | "as" | "while" | "whereupon" | "during" => (Joint::While, 1),
            "after" | "once" => (Joint::After, 1),
            "following" if matches!(next, "the" | "this") && at == self.first => (Joint::After, 1),
            "before" | "until" => (Joint::Before, 1),
            "prior" if next == "to" => (Joint::Before, 2),
            "the" | "at" if self.moment(at).is_some() => (Joint::While, self.moment(at)?),
            "so" if next == "that" => (Joint::Because, 2),
            "so" if self.is_purpose(at) => (Joint::Because, 1),
            "in" if next == "order" && self.text(at + 2) == "that" => (Joint::Because, 3),
            "because" | "due" | "since" | "although" | "though" | "whereas" => (Joint::Because, 1),
            _ => return None,
        })
    }

    /// `failed to`, `did not`, `without` are one negation each.
    fn run_in_words(&self, at: usize) -> Option<usize> {
        let (one, two) = (self.text(at), self.text(at + 1));
        match one {
            "did" | "does" | "do" | "was" | "were" | "is" | "could" | "would" | "had" | "has" | "have"
                if two == "not" =>
            {
                Some(2)
            }
            "fail" | "failed" | "failing" | "unable" | "omitted" | "neglected" if two == "to" => Some(2),
            "rather" if two == "than" => Some(2),
            "instead" if two == "of" => Some(2),
            _ => None,
        }
    }

    /// "on the right front of the van" is a part, "from the right lane" a lane.
    fn is_no_relation(&self, at: usize, length: usize) -> bool {
        let (last, behind) = (self.text(at + length - 1), at + length);
        // "on its left side mirror", "from the front door to the rear wheel".
        let mirror = matches!(last, "side" | "front")
            && matches!(self.text(behind), "mirror" | "mirrors" | "door" | "doors" | "window");
        let side = matches!(last, "left" | "right" | "rear") || mirror;
        // "at the rear of its passenger side".
        let own = behind + usize::from(is_determiner(self.text(behind)));
        let of_a_side = last == "of"
            && own > behind
            && self.part(own + usize::from(self.text(own) == "own")).is_some_and(|(part, length)| {
                matches!(part, Part::Left | Part::Right) && (length > 1 || self.text(own + length) == "side")
            });
        if of_a_side && behind > 1 && matches!(self.text(behind - 2), "rear" | "back" | "front") {
            return true;
        }
        let part = self
            .part(behind)
            .is_some_and(|(part, _)| part != Part::Noun || !matches!(self.text(behind), "side" | "half"));
        side && (part || matches!(self.text(behind), "lane" | "lanes" | "turn"))
    }

    fn parenthesis(&self, at: usize) -> usize {
        (at + 1..self.tokens.len().min(at + 40)).find(|&end| self.text(end) == ")").map_or(1, |end| end + 1 - at)
    }

    /// The number of "(Vehicle 2)" behind a noun that ends here.
    fn alias(&self, at: usize) -> Option<u8> {
        if self.text(at) != "(" {
            return None;
        }
        let inside: Vec<&str> = (at + 1..at + 5).map(|at| self.text(at)).collect();
        let number = match inside.as_slice() {
            ["vehicle" | "unit" | "v" | "car", number, ")", ..] => number,
            [one, ")", ..] => one.strip_prefix('v')?,
            _ => return None,
        };
        number.parse().ok()
    }
}
