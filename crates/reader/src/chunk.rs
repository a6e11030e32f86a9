//! Tokens of one sentence into chunks: who is named, verbs, where, lanes, and the small words between them.

use crate::lexicon::{Adjective, Form, Lexicon, Meaning, Occupant, Part, Relation, Sense};
use crate::token::{Token, TokenKind};
use recrash_model::account::{Compass, Kind, KindGroup, LaneWord, LeftRight};

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
    /// More than one.
    pub several: bool,
    /// Somebody in a vehicle.
    pub occupant: Option<(Occupant, bool)>,
    /// The vehicle of somebody, or of a part.
    pub owner: Option<Box<Noun>>,
}

/// A part of a vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// What the words say.
    pub parts: Vec<Part>,
    /// It is a door.
    pub door: bool,
    /// It is open, or opened.
    pub open: bool,
    /// Whose; `None` where that is not said.
    pub owner: Option<Noun>,
    /// `its`.
    pub its: bool,
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

const DETERMINERS: [&str; 14] =
    ["the", "this", "that", "these", "those", "its", "their", "his", "her", "our", "a", "an", "one", "any"];

/// Most tokens that name one part.
const LONGEST_PIECE: usize = 14;

const COLOURS: [&str; 14] = [
    "white", "black", "red", "blue", "silver", "gray", "grey", "green", "yellow", "orange", "brown", "tan", "gold",
    "beige",
];

/// Splits a sentence into chunks.
pub fn chunks(tokens: &[Token], first: usize, end: usize) -> Vec<Placed> {
    let chunker = Chunker { lexicon: Lexicon::get(), tokens: &tokens[..end], first };
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
        chunk: Chunk::Piece(Piece { owner: Some(noun.clone()), ..piece.clone() }),
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
}

impl Chunker<'_> {
    fn text(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |token| token.text.as_str())
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
        if let Some((lane, length)) = self.lane(at) {
            return (Some(Chunk::Lane(lane)), length);
        }
        if let Some(length) = self.run_in_words(at) {
            return (Some(Chunk::Not), length);
        }
        let joins = self.joint(at);
        if let Some((joint, length)) = joins {
            return (Some(Chunk::Joint(joint)), length);
        }
        let relation = self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Relation(_)));
        let relation = relation.filter(|found| !self.is_no_relation(at, found.length));
        let verb = self.verb(at, before);
        let piece = self.piece(at);
        let noun = self.noun(at);
        let spot = self.spot(at);
        let candidates = [
            relation.map(|found| found.length),
            verb.map(|(_, _, length)| length),
            piece.as_ref().map(|(_, length)| *length),
            noun.as_ref().map(|(_, length)| *length),
            spot.map(|(_, length)| length),
        ];
        let longest = candidates.iter().flatten().copied().max().unwrap_or(0);
        if longest > 0 {
            if let (Some(found), Some(length)) = (relation, candidates[0])
                && length == longest
                && let Meaning::Relation(relation) = found.meaning
            {
                return (Some(Chunk::Relation(relation)), length);
            }
            if let Some((spot, length)) = spot.filter(|(_, length)| *length == longest) {
                return (Some(Chunk::Spot(spot)), length);
            }
            if let Some((sense, form, length)) = verb.filter(|(_, _, length)| *length == longest) {
                return (Some(Chunk::Verb(sense, form)), length);
            }
            let thing = noun.as_ref().is_some_and(|(noun, length)| {
                *length == longest && noun.kind.is_some_and(|kind| kind.group() == KindGroup::Object)
            });
            if let Some((piece, length)) =
                piece.filter(|(piece, length)| *length == longest && (piece.owner.is_some() || !thing))
            {
                return (Some(Chunk::Piece(piece)), length);
            }
            if let Some((noun, length)) = noun {
                return (Some(Chunk::Noun(noun)), length);
            }
        }
        if let Some((compass, length)) = self.compass(at) {
            return (Some(Chunk::Compass(compass)), length);
        }
        self.small_word(at)
    }

    fn small_word(&self, at: usize) -> (Option<Chunk>, usize) {
        let word = self.text(at);
        let chunk = match word {
            "it" | "they" | "them" | "itself" | "he" | "she" | "him" => Chunk::Pronoun,
            "that" | "which" | "who" | "whom" => Chunk::Relative,
            "is" | "are" | "was" | "were" | "be" | "been" | "being" => Chunk::Be,
            "not" | "never" | "didn" | "wasn" | "couldn" | "without" | "unable" | "nor" | "neither" | "avoid"
            | "avoiding" | "avoided" => Chunk::Not,
            "fail" | "failed" | "failing" | "fails" | "refused" => Chunk::Not,
            "left" | "leftward" | "leftwards" => Chunk::Side(LeftRight::Left),
            "right" | "rightward" | "rightwards" => Chunk::Side(LeftRight::Right),
            _ => match PREPOSITIONS.iter().find(|known| **known == word) {
                Some(known) => Chunk::Preposition(known),
                None => Chunk::Word,
            },
        };
        (Some(chunk), 1)
    }

    fn joint(&self, at: usize) -> Option<(Joint, usize)> {
        let next = self.text(at + 1);
        Some(match self.text(at) {
            "and" | "then" | "but" | "however" | "subsequently" | "or" => (Joint::And, 1),
            "when" | "as" | "while" | "whereupon" | "during" => (Joint::While, 1),
            "after" | "once" => (Joint::After, 1),
            "following" if matches!(next, "the" | "this") && at == self.first => (Joint::After, 1),
            "before" | "until" => (Joint::Before, 1),
            "prior" if next == "to" => (Joint::Before, 2),
            "because" | "due" | "since" => (Joint::Because, 1),
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
            "fail" | "failed" | "failing" | "unable" if two == "to" => Some(2),
            "rather" if two == "than" => Some(2),
            "instead" if two == "of" => Some(2),
            _ => None,
        }
    }

    /// "on the right front of the van" is a part, "from the right lane" a lane.
    fn is_no_relation(&self, at: usize, length: usize) -> bool {
        let (last, behind) = (self.text(at + length - 1), at + length);
        let side = matches!(last, "left" | "right");
        let part = self
            .part(behind)
            .is_some_and(|(part, _)| part != Part::Noun || !matches!(self.text(behind), "side" | "half"));
        side && (part || matches!(self.text(behind), "lane" | "lanes" | "turn" | "most"))
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
            ["vehicle" | "unit" | "v", number, ")", ..] => number,
            [one, ")", ..] => one.strip_prefix('v')?,
            _ => return None,
        };
        number.parse().ok()
    }

    /// One of eight directions, and its tokens.
    fn compass(&self, at: usize) -> Option<(Compass, usize)> {
        let word = self.text(at);
        let bare = |word: &str| -> Option<Compass> {
            Some(match word {
                "north" => Compass::North,
                "northeast" => Compass::Northeast,
                "east" => Compass::East,
                "southeast" => Compass::Southeast,
                "south" => Compass::South,
                "southwest" => Compass::Southwest,
                "west" => Compass::West,
                "northwest" => Compass::Northwest,
                _ => return None,
            })
        };
        let stem =
            word.strip_suffix("bound").or_else(|| word.strip_suffix("bounds")).or_else(|| word.strip_suffix("erly"));
        if let Some(compass) = stem.filter(|stem| !stem.is_empty()).and_then(bare) {
            return Some((compass, 1));
        }
        match word {
            "nb" => return Some((Compass::North, 1)),
            "sb" => return Some((Compass::South, 1)),
            "eb" => return Some((Compass::East, 1)),
            "wb" => return Some((Compass::West, 1)),
            _ => {}
        }
        let mut compass = bare(word)?;
        let mut length = 1;
        // "south west bound".
        if let (Compass::North | Compass::South, Some(second)) =
            (compass, self.text(at + 1).strip_suffix("bound").and_then(bare).or_else(|| bare(self.text(at + 1))))
        {
            compass = match (compass, second) {
                (Compass::North, Compass::East) => Compass::Northeast,
                (Compass::North, Compass::West) => Compass::Northwest,
                (Compass::South, Compass::East) => Compass::Southeast,
                (Compass::South, Compass::West) => Compass::Southwest,
                _ => compass,
            };
            length = 2;
        }
        if self.text(at + length) == "bound" || self.text(at + length) == "bounds" {
            return Some((compass, length + 1));
        }
        // A street's name: "on West Elm Street", "US-9 South".
        let token = &self.tokens[at];
        let named_behind =
            self.tokens.get(at + length).is_some_and(|next| next.capital && next.kind != TokenKind::Name);
        let named_before = at > self.first && self.tokens[at - 1].kind == TokenKind::Number;
        if (token.capital && named_behind)
            || named_before
            || (token.capital && self.text(at.wrapping_sub(1)) == "street")
        {
            return None;
        }
        matches!(self.text(at + length), "side" | "of" | "corner" | "end" | "leg" | "curb" | "crosswalk")
            .then_some(())
            .map_or(Some((compass, length)), |()| None)
    }

    fn lane(&self, at: usize) -> Option<(LaneWord, usize)> {
        let word = self.text(at);
        if word == "shoulder" {
            return Some((LaneWord::Shoulder, 1));
        }
        // "the second lane from the right", "the second from the right lane": neither the first nor the last.
        if matches!(word, "second" | "third" | "2nd" | "3rd" | "number") {
            let words: Vec<&str> = (at + 1..at + 6).map(|at| self.text(at)).collect();
            match words.as_slice() {
                ["lane", "from", "the", "left" | "right", ..] | ["from", "the", "left" | "right", "lane", ..] => {
                    return Some((LaneWord::Center, 5));
                }
                ["lane", "from", "left" | "right", ..] => return Some((LaneWord::Center, 4)),
                ["to", "the", "left" | "right", "lane", ..] => return Some((LaneWord::Center, 5)),
                _ => {}
            }
        }
        let modifier = |word: &str| {
            matches!(
                word,
                "left"
                    | "of"
                    | "two"
                    | "three"
                    | "four"
                    | "right"
                    | "leftmost"
                    | "rightmost"
                    | "most"
                    | "center"
                    | "centre"
                    | "middle"
                    | "turn"
                    | "turning"
                    | "only"
                    | "hand"
                    | "through"
                    | "dedicated"
                    | "travel"
                    | "bike"
                    | "bicycle"
                    | "bus"
                    | "hov"
                    | "far"
                    | "adjacent"
                    | "number"
                    | "inside"
                    | "outside"
                    | "curb"
                    | "parking"
                    | "opposing"
                    | "opposite"
                    | "oncoming"
                    | "designated"
                    | "and"
                    | "second"
                    | "carpool"
                    | "same"
                    | "thru"
                    | "traffic"
                    | "driving"
                    | "merge"
                    | "slow"
                    | "fast"
                    | "passing"
                    | "straight"
                    | "next"
                    | "neighboring"
                    | "emergency"
            )
        };
        if !modifier(word) || matches!(word, "and" | "of" | "two" | "three" | "four") {
            return None;
        }
        let mut end = at;
        while end < self.tokens.len() && end < at + 7 {
            let here = self.text(end);
            if matches!(here, "lane" | "lanes") {
                break;
            }
            if !modifier(here) && self.compass(end).is_none() && self.tokens[end].kind != TokenKind::Number {
                return None;
            }
            end += 1;
        }
        if !matches!(self.text(end), "lane" | "lanes") {
            return None;
        }
        let words: Vec<&str> = (at..end).map(|at| self.text(at)).collect();
        let has = |word: &str| words.contains(&word);
        let left = has("left") || has("leftmost") || has("inside") || has("fast");
        let right = has("right") || has("rightmost") || has("outside") || has("slow");
        let turn = has("turn") || has("turning");
        let adjacent = has("adjacent") || has("next") || has("neighboring");
        // "the left adjacent lane" is a place beside somebody, and is told as a relation.
        if adjacent && !turn {
            return None;
        }
        let lane = if has("bike") || has("bicycle") {
            LaneWord::Bike
        } else if has("bus") {
            LaneWord::Bus
        } else if has("opposing") || has("opposite") || has("oncoming") {
            LaneWord::Opposing
        } else if has("parking") || has("curb") {
            LaneWord::Curb
        } else if has("emergency") {
            LaneWord::Shoulder
        } else if turn && left {
            LaneWord::LeftTurn
        } else if turn && right {
            LaneWord::RightTurn
        } else if left {
            LaneWord::Left
        } else if right {
            LaneWord::Right
        } else if has("center") || has("middle") || has("centre") {
            LaneWord::Center
        } else {
            return None;
        };
        Some((lane, end + 1 - at))
    }

    fn spot(&self, at: usize) -> Option<(Spot, usize)> {
        let (one, two) = (self.text(at), self.text(at + 1));
        Some(match (one, two) {
            (
                "parking" | "angled" | "perpendicular",
                "space" | "spot" | "stall" | "spaces" | "spots" | "stalls" | "position",
            ) => (Spot::Stall, 2),
            ("parking", "lot" | "garage" | "area" | "structure") => (Spot::Driveway, 2),
            ("stall" | "carport", _) => (Spot::Stall, 1),
            ("gas", "station") | ("driveway", "exit") => (Spot::Driveway, 2),
            ("driveway" | "garage" | "alley" | "alleyway" | "lot", _) => (Spot::Driveway, 1),
            ("sidewalk", _) => (Spot::Sidewalk, 1),
            ("side" | "cross", "street" | "road") => (Spot::SideStreet, 2),
            _ => return None,
        })
    }

    fn verb(&self, at: usize, before: &[Placed]) -> Option<(Sense, Form, usize)> {
        let token = &self.tokens[at];
        if token.capital && at > self.first {
            return None;
        }
        let found = self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Verb(..)))?;
        let Meaning::Verb(sense, form) = found.meaning else { return None };
        let word_before = if at > self.first { self.text(at - 1) } else { "" };
        // Behind an article or an adjective it is a noun: "the stop", "a lane change", "initial contact".
        let article = DETERMINERS.contains(&word_before) && word_before != "that" && word_before != "this";
        let adjective = matches!(
            word_before,
            "left"
                | "right"
                | "complete"
                | "full"
                | "initial"
                | "first"
                | "second"
                | "this"
                | "unprotected"
                | "physical"
                | "rear"
                | "front"
                | "of"
                | "'s"
                | "light"
                | "hard"
                | "minor"
                | "lane"
                | "no"
                | "any"
                | "further"
                | "secondary"
                | "three"
                | "u"
        );
        let single = found.length == 1;
        if form == Form::Base && !self.takes_base(at, before) {
            return None;
        }
        if sense == Sense::ContactMade {
            return Some((sense, form, found.length));
        }
        if article && (form == Form::Base || single) {
            return None;
        }
        if adjective && form == Form::Base && single {
            return None;
        }
        if matches!(word_before, "left" | "right") && matches!(self.text(at), "turn" | "turns" | "turning") && single {
            return None;
        }
        // A bare noun at the end of a prepositional phrase: "in contact", "under braking", "without impact".
        let behind_preposition =
            matches!(before.last().map(|placed| &placed.chunk), Some(Chunk::Preposition(word)) if *word != "to");
        if behind_preposition && form == Form::Base && single {
            return None;
        }
        // "right turn" as a noun: "during the right turn".
        if matches!(self.text(at), "left" | "right")
            && matches!(self.text(at + 1), "turn")
            && found.length == 2
            && form == Form::Base
        {
            return None;
        }
        // "parking lot", "driving lane", "parking space" are places.
        if matches!(self.text(at), "parking") && self.spot(at).is_some() {
            return None;
        }
        if matches!(self.text(at), "traveling" | "driving" | "turning" | "merging")
            && matches!(self.text(at + 1), "lane" | "lanes")
        {
            return None;
        }
        if self.text(at) == "back"
            && matches!(self.text(at + 1), "to" | "onto" | "into" | "of" | "pain" | "injury")
            && single
        {
            return None;
        }
        if self.text(at) == "cross" && matches!(self.text(at + 1), "traffic" | "street" | "road" | "walk") {
            return None;
        }
        if self.text(at) == "contacts" || (self.text(at) == "stop" && self.text(at + 1) == "sign") {
            return None;
        }
        Some((sense, form, found.length))
    }

    /// A base form is a verb only behind the words that call for one: "to stop", "did not stop", "to stop and wait".
    fn takes_base(&self, at: usize, before: &[Placed]) -> bool {
        let Some(word) = at.checked_sub(1).filter(|before| *before >= self.first).map(|at| self.text(at)) else {
            return false;
        };
        if word == "to"
            && at >= 2
            && matches!(self.text(at - 2), "prior" | "leading" | "due" | "led" | "subsequent" | "up" | "response")
        {
            return false;
        }
        if word.ends_with("ly") && at >= 2 && self.text(at - 2) == "to" {
            return true;
        }
        match word {
            "to" | "not" | "had" | "has" | "have" | "will" | "would" | "could" | "can" | "may" | "might" | "should"
            | "must" | "did" | "t" | "fully" | "suddenly" | "immediately" | "abruptly" | "slowly" | "also" | "then"
            | "safely" => true,
            "and" | "or" => {
                before.iter().rev().skip(1).take(4).any(|placed| matches!(placed.chunk, Chunk::Verb(_, Form::Base)))
            }
            _ => false,
        }
    }

    /// A part of a vehicle, with whose it is.
    fn piece(&self, first: usize) -> Option<(Piece, usize)> {
        let mut at = first;
        let mut its = false;
        if DETERMINERS.contains(&self.text(at)) {
            its = matches!(self.text(at), "its" | "their" | "his" | "her");
            at += 1;
        }
        let (mut parts, mut door, mut open, mut nouns) = (Vec::new(), false, false, 0);
        let mut last_joined = at;
        while at < self.tokens.len().min(first + LONGEST_PIECE) {
            let word = self.text(at);
            if matches!(word, "open" | "opened" | "opening") && self.tokens.get(at + 1).is_some() {
                (open, at) = (true, at + 1);
                continue;
            }
            if word == "and" && !parts.is_empty() && self.part(at + 1).is_some() && self.noun(at + 1).is_none() {
                at += 1;
                continue;
            }
            let Some((part, length)) = self.part(at) else { break };
            door |= (at..at + length).any(|at| matches!(self.text(at), "door" | "doors"));
            nouns +=
                usize::from(part == Part::Noun || (at..at + length).any(|at| matches!(self.text(at), "side" | "end")));
            if !parts.contains(&part) {
                parts.push(part);
            }
            at += length;
            last_joined = at;
        }
        at = at.min(last_joined.max(first));
        if parts.is_empty() || at == first {
            return None;
        }
        let placed = parts.iter().any(|part| *part != Part::Noun);
        let mut owner = None;
        if self.text(at) == "of" || (self.text(at) == "on" && nouns > 0) {
            let mut behind = at + 1;
            // "the rear of both the van and the bus" has one owner: the first.
            if matches!(self.text(behind), "both" | "another") {
                behind += usize::from(self.text(behind) == "both");
            }
            if let Some((noun, length)) =
                self.noun(behind).filter(|(noun, _)| noun.subject || noun.kind.is_some_and(can_own))
            {
                owner = Some(noun);
                at = behind + length;
            } else if self.text(behind) == "it" {
                (its, at) = (true, behind + 1);
            } else if self.text(at) == "of" {
                return None;
            }
        }
        // "the front", "the left" alone are places unless somebody owns them or a part is named.
        let sure = owner.is_some() || nouns > 0 || its;
        let plain_noun = parts == [Part::Noun] && owner.is_none() && !its && !door;
        let bare = placed && self.text(first) == "the" && self.ends_clause(at);
        if !(sure || bare) {
            return None;
        }
        if plain_noun
            && !matches!(
                self.text(at - 1),
                "mirror" | "bumper" | "sensor" | "wheel" | "tire" | "handlebar" | "handlebars" | "fender"
            )
        {
            return None;
        }
        let side_of_road = matches!(self.text(at - 1), "side" | "lane" | "edge" | "hand")
            && owner.is_none()
            && !its
            && !parts.iter().any(|part| matches!(part, Part::Front | Part::Rear))
            && matches!(self.text(at.wrapping_sub(2)), "left" | "right" | "hand")
            && self.text(at) == "of";
        if side_of_road {
            return None;
        }
        Some((Piece { parts, door, open, owner, its }, at - first))
    }

    fn ends_clause(&self, at: usize) -> bool {
        at >= self.tokens.len() || matches!(self.text(at), "," | "." | "and" | "by" | "when" | "while" | "as")
    }

    fn part(&self, at: usize) -> Option<(Part, usize)> {
        let found = self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Part(_)))?;
        let Meaning::Part(part) = found.meaning else { return None };
        // "driver" and "passenger" are sides only before a part.
        let alone = found.length == 1 && matches!(self.text(at), "driver" | "drivers" | "passenger" | "passengers");
        if alone || (found.length == 2 && self.text(at + 1) == "'s") {
            let behind = at + found.length;
            let next = self.lexicon.longest(self.tokens, behind, |meaning| matches!(meaning, Meaning::Part(_)))?;
            let is_part = matches!(next.meaning, Meaning::Part(Part::Noun | Part::Front | Part::Rear));
            let person =
                matches!(self.text(behind), "side") || !matches!(self.text(behind), "back" | "body" | "arm" | "window");
            if !is_part || !person {
                return None;
            }
        }
        if matches!(self.text(at), "back")
            && matches!(self.text(at + 1), "to" | "into" | "onto" | "out" | "up" | "down" | "and" | "in")
        {
            return None;
        }
        if matches!(self.text(at), "light")
            && !matches!(self.text(at.wrapping_sub(1)), "tail" | "head" | "brake" | "side")
        {
            return None;
        }
        Some((part, found.length))
    }

    /// Somebody or something that is named here.
    fn noun(&self, first: usize) -> Option<(Noun, usize)> {
        let mut noun = Noun {
            article: Article::None,
            subject: false,
            kind: None,
            number: None,
            names: Vec::new(),
            adjectives: Vec::new(),
            compass: None,
            several: false,
            occupant: None,
            owner: None,
        };
        let mut at = first;
        match self.text(at) {
            "the" | "this" | "that" | "these" | "those" | "its" | "their" | "our" | "his" | "her" => {
                noun.article = Article::Definite;
                at += 1;
            }
            "a" | "an" | "one" => {
                noun.article = Article::Indefinite;
                at += 1;
            }
            "another" => noun.article = Article::Indefinite,
            _ => {}
        }
        let mut company = false;
        let mut make = false;
        let mut strange = 0;
        let head = loop {
            if at >= self.tokens.len() || at > first + 10 || self.tokens[at].kind == TokenKind::Mark {
                return None;
            }
            if let Some(found) = self.head(at) {
                break found;
            }
            let known = self.lexicon.longest(self.tokens, at, |meaning| {
                matches!(meaning, Meaning::Adjective(_) | Meaning::Make | Meaning::Company)
            });
            if let Some(found) = known {
                match found.meaning {
                    Meaning::Adjective(adjective) => {
                        if COLOURS.contains(&self.text(at)) {
                            noun.names.push(self.text(at).to_owned());
                        }
                        noun.several |=
                            matches!(self.text(at), "several" | "multiple" | "many" | "two" | "three" | "four");
                        noun.adjectives.push(adjective);
                    }
                    Meaning::Make if self.tokens[at].capital || make => {
                        make = true;
                        noun.names.push(self.text(at).to_owned());
                    }
                    Meaning::Company if self.tokens[at].capital => company = true,
                    _ => return self.only_named(noun, first, at, company, make),
                }
                at += found.length;
                continue;
            }
            if let Some((compass, length)) = self.compass(at) {
                noun.compass = Some(compass);
                at += length;
                continue;
            }
            // Words nobody knows, between an article and a noun: models of cars.
            let token = &self.tokens[at];
            let unknown = (token.capital || token.kind != TokenKind::Word) && at > first && strange < 3;
            if !unknown || self.verb_stands(at) {
                return self.only_named(noun, first, at, company, make);
            }
            if token.capital && token.kind == TokenKind::Word {
                noun.names.push(token.text.clone());
            }
            strange += 1;
            at += 1;
        };
        self.heads(noun, first, at, company, make, head)
    }

    fn verb_stands(&self, at: usize) -> bool {
        !self.tokens[at].capital
            && self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Verb(..))).is_some()
    }

    /// "the Waymo", "a Toyota": a name without a noun.
    fn only_named(&self, mut noun: Noun, first: usize, at: usize, company: bool, make: bool) -> Option<(Noun, usize)> {
        let article = noun.article != Article::None;
        if at <= first || !article || !(company || make) {
            return None;
        }
        if company {
            noun.subject = true;
        } else {
            noun.kind = Some(Kind::Vehicle);
        }
        self.finish(noun, first, at)
    }

    fn head(&self, at: usize) -> Option<(Meaning, usize)> {
        let found = self.lexicon.longest(self.tokens, at, |meaning| {
            matches!(meaning, Meaning::Subject | Meaning::Kind(_) | Meaning::Occupant(_))
        })?;
        let part = self.part(at).map_or(0, |(_, length)| length);
        // "passenger side", "driver door" are parts.
        if matches!(found.meaning, Meaning::Occupant(_))
            && (part > found.length || (part > 0 && self.part(at + part).is_some()))
        {
            return None;
        }
        if matches!(self.text(at + found.length), "rack" | "racks" | "lane" | "lanes" | "path" | "share" | "yard")
            && !matches!(found.meaning, Meaning::Subject)
        {
            return None;
        }
        // "light", "sign" of "traffic sign" and "stop sign" are no things that are struck, unless they are.
        if self.text(at) == "traffic"
            && matches!(
                self.text(at + 1),
                "light"
                    | "lights"
                    | "signal"
                    | "signals"
                    | "circle"
                    | "lane"
                    | "lanes"
                    | "control"
                    | "congestion"
                    | "stop"
                    | "conditions"
                    | "queue"
                    | "sign"
                    | "cone"
                    | "barrier"
                    | "island"
                    | "cones"
            )
        {
            return None;
        }
        if matches!(self.text(at), "sign") && at > self.first && matches!(self.text(at - 1), "stop" | "yield") {
            return None;
        }
        Some((found.meaning, found.length))
    }

    fn heads(
        &self,
        mut noun: Noun,
        first: usize,
        at: usize,
        company: bool,
        make: bool,
        head: (Meaning, usize),
    ) -> Option<(Noun, usize)> {
        let mut at = at;
        let mut head = Some(head);
        let mut subject = company;
        let mut plural = false;
        while let Some((meaning, length)) = head {
            match meaning {
                Meaning::Subject => subject = true,
                Meaning::Kind(Kind::Trailer) if noun.kind.is_some_and(|kind| kind.group() == KindGroup::Truck) => {
                    noun.kind = Some(Kind::SemiTrailerTruck);
                }
                Meaning::Kind(Kind::Trailer) if noun.kind == Some(Kind::Pickup) => {
                    noun.kind = Some(Kind::PickupWithTrailer)
                }
                Meaning::Kind(kind) => {
                    noun.kind = Some(kind);
                    plural = matches!(self.text(at + length - 1), "people" | "personnel" | "traffic")
                        || self.text(at + length - 1).ends_with('s')
                            && !matches!(self.text(at + length - 1), "bus" | "debris" | "cross");
                }
                Meaning::Occupant(who) => {
                    let owner = Noun { occupant: None, owner: None, names: noun.names.clone(), ..noun.clone() };
                    let owned = subject || noun.kind.is_some() || make;
                    if owned {
                        noun.owner = Some(Box::new(Noun { subject, kind: noun.kind.or(Some(Kind::Vehicle)), ..owner }));
                    }
                    let plain = matches!(self.text(at), "driver" | "drivers") && length == 1;
                    noun.occupant = Some((who, plain));
                    noun.kind = None;
                    subject = false;
                }
                _ => {}
            }
            at += length;
            if let (Some(number), true) = (self.text(at).parse().ok(), noun.kind == Some(Kind::Vehicle)) {
                noun.number = Some(number);
                at += 1;
            }
            // "AV 2", "a different AV": another one of the same company.
            if let (true, Some(number)) =
                (subject, self.text(at).parse::<u8>().ok().filter(|number| (1..=4).contains(number)))
            {
                at += 1;
                if number > 1 {
                    (subject, noun.kind, noun.number) = (false, Some(Kind::PassengerCar), Some(number));
                }
            }
            // Another noun at once makes a compound: "pickup truck driver", "Waymo AV operator". An adjective does not.
            head = self.head(at).filter(|(next, _)| {
                self.text(at) != "'s" && !(matches!(next, Meaning::Subject) && noun.kind.is_some() && !subject)
            });
            if matches!(head, Some((Meaning::Kind(kind), _)) if noun.occupant.is_some() && !kind.is_vehicle()) {
                head = None;
            }
        }
        if subject
            && noun.occupant.is_none()
            && noun.adjectives.iter().any(|adjective| matches!(adjective, Adjective::Another | Adjective::Other))
        {
            subject = false;
            noun.kind = noun.kind.or(Some(Kind::PassengerCar));
        }
        noun.subject = (subject || self.text(first) == "our") && noun.occupant.is_none();
        noun.several |= plural;
        let alone = (first..at).any(|at| {
            matches!(self.text(at), "abandoned" | "parked" | "unattended" | "riderless" | "fallen" | "unoccupied")
        });
        if alone && matches!(noun.kind, Some(Kind::ScooterRider | Kind::Bicycle | Kind::EBike)) {
            noun.kind = Some(Kind::Scooter);
        }
        self.finish(noun, first, at)
    }

    /// What stands behind a noun and belongs to it: "(Vehicle 2)", "of the bus", "'s rear bumper" is left to others.
    fn finish(&self, mut noun: Noun, first: usize, at: usize) -> Option<(Noun, usize)> {
        let mut at = at;
        if let Some(number) = self.alias(at) {
            noun.subject |= number == 1;
            noun.number = Some(number).filter(|number| *number > 1);
        }
        if noun.occupant.is_some() && noun.owner.is_none() {
            let mut behind = at;
            if self.text(behind) == "(" {
                behind += self.parenthesis(behind);
            }
            if matches!(
                self.text(behind),
                "of" | "in" | "inside" | "from" | "operating" | "driving" | "on" | "within" | "aboard"
            ) && let Some((owner, length)) = self.noun(behind + 1)
                && (owner.subject || owner.kind.is_some_and(can_own))
                && owner.occupant.is_none()
            {
                noun.owner = Some(Box::new(owner));
                at = behind + 1 + length;
            }
        }
        // "a person on a scooter", "a rider of a bicycle" is who rides it.
        let on_foot = noun
            .kind
            .is_some_and(|kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist | KindGroup::Motorcycle))
            || (noun.occupant.is_some() && noun.owner.is_none());
        let mut ride = at;
        while matches!(
            self.text(ride),
            "on" | "riding"
                | "operating"
                | "using"
                | "who"
                | "was"
                | "were"
                | "of"
                | "in"
                | "his"
                | "her"
                | "top"
                | "driving"
        ) && ride < at + 4
        {
            ride += 1;
        }
        if on_foot
            && ride > at
            && let Some((ridden, length)) = self.noun(ride)
        {
            let wheels = matches!(
                ridden.kind,
                Some(
                    Kind::Bicycle
                        | Kind::EBike
                        | Kind::ScooterRider
                        | Kind::Skateboarder
                        | Kind::Motorcycle
                        | Kind::Moped
                        | Kind::Wheelchair
                )
            );
            if wheels && ridden.occupant.is_none() {
                let several = noun.several;
                noun.kind = ridden.kind;
                (noun.occupant, noun.owner, noun.several) = (None, None, several);
                at = ride + length;
            }
        }
        // Possessive: the owner of what follows, a part or somebody inside.
        if self.text(at) == "'s"
            && let Some((mut person, length)) = self.owned_person(at + 1)
        {
            person.owner = Some(Box::new(noun));
            return Some((person, at + 1 + length - first));
        }
        Some((noun, at - first))
    }

    fn owned_person(&self, at: usize) -> Option<(Noun, usize)> {
        let (noun, length) = self.noun(at).filter(|(noun, _)| noun.article == Article::None)?;
        (noun.occupant.is_some() && noun.owner.is_none()).then_some((noun, length))
    }
}

/// Whether a thing of this kind has parts and people in it.
fn can_own(kind: Kind) -> bool {
    kind.group() != KindGroup::Animal || kind == Kind::Animal
}
