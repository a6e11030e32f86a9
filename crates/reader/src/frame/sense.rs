//! What a verb says here, where the words around it make another thing of it than the lexicon knows.
//!
//! A new rule goes into [`SENSES`]; each sees what the ones before it made of the verb.

use super::parser::{Carry, Parser};
use super::row::{Spoken, single};
use crate::chunk::Chunk;
use crate::lexicon::{Form, Occupant, Progress, Sense};
use crate::token::{Token, TokenKind};
use crate::world::SUBJECT;
use recrash_model::account::{Act, Compass, KindGroup, LeftRight};

type Rule = fn(&Parser<'_>, &Spoken<'_>, &Carry) -> Option<Sense>;

const SENSES: [Rule; 24] = [
    pulls_up_to,
    lies_on_its_side,
    stands_backed_up,
    remains_so,
    is_ridden,
    blows_another,
    nearly_stops,
    half_stops,
    moves_another,
    holds_a_thing,
    is_held_by,
    lies_between,
    drives_between_numbers,
    begins_to_move_over,
    begins_to_drive_past,
    reaches_in,
    gets_in,
    is_outside,
    is_of_a_hand,
    stands_open,
    swings_over,
    moves_itself,
    enters_a_slip_lane,
    tries_to_avoid,
];

impl Parser<'_> {
    /// What a verb says here.
    pub(super) fn sense_here(&self, verb: &Spoken<'_>, carry: &Carry) -> Sense {
        let mut verb = *verb;
        for rule in SENSES {
            verb.sense = rule(self, &verb, carry).unwrap_or(verb.sense);
        }
        verb.sense
    }
}

/// "moved forward into the intersection": it went there, and pushed nobody.
fn moves_itself(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let words: Vec<&str> =
        parser.tokens[verb.placed().first..].iter().take(5).map(|token| token.text.as_str()).collect();
    let road = matches!(words.get(1..), Some(["forward", "into", "the" | "an", "intersection" | "junction"]));
    (verb.sense == Sense::Push && road && !carry.be).then_some(Sense::Act(Act::Follow))
}

/// "entered the slip lane toward northbound Elm Street": where traffic keeps right, a turn to the right. Of one that goes back the other way it
/// is not, nor on a highway, where it is a ramp.
fn enters_a_slip_lane(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    if verb.sense != Sense::Act(Act::Enter) {
        return None;
    }
    let behind = &parser.tokens[verb.placed().end..];
    let clause = behind.iter().take(12).take_while(|token| token.text != "," && token.text != ".");
    let words: Vec<&str> = clause.map(|token| token.text.as_str()).collect();
    let ramp = words.iter().any(|word| matches!(*word, "highway" | "freeway" | "interstate" | "expressway" | "merged"));
    let slip = words.windows(2).take(3).any(|pair| pair == ["slip", "lane"]) && !ramp;
    let own = carry.subject.as_ref().and_then(|subject| parser.world.actors[subject.actor].heading);
    let back = own.is_some_and(|(compass, ..)| {
        let other = match compass {
            Compass::North => "south",
            Compass::South => "north",
            Compass::East => "west",
            Compass::West => "east",
            _ => return false,
        };
        words.iter().any(|word| word.starts_with(other))
    });
    (slip && !back).then_some(Sense::Sided(Act::Turn, LeftRight::Right))
}

/// "attempted to avoid the collision": it braked, where no other word tells what it did.
fn tries_to_avoid(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    const OTHERWISE: [&str; 18] = [
        "swerv",
        "steer",
        "veer",
        "brak",
        "slow",
        "decelerat",
        "stop",
        "maneuver",
        "accelerat",
        "turning",
        "moving",
        "changing",
        "merging",
        "pulling",
        "nudging",
        "reversing",
        "honk",
        "evasive",
    ];
    let avoids = verb.sense == Sense::Other && verb.word(parser).starts_with("avoid");
    if !avoids || carry.progress != Some(Progress::Tried) || carry.negated {
        return None;
    }
    let own = carry.subject.as_ref().is_some_and(|subject| subject.actor == SUBJECT);
    let behind = &parser.tokens[verb.placed().end..];
    let crash = |token: &Token| {
        matches!(token.text.as_str(), "collision" | "contact" | "crash" | "impact" | "accident" | "incident")
    };
    let whole = parser.tokens.iter().skip(carry_first(parser, verb)).take_while(|token| token.text != ".");
    let mut whole = whole.map(|token| token.text.as_str());
    let otherwise = whole.any(|word| OTHERWISE.iter().any(|stem| word.starts_with(stem)));
    (own && behind.iter().take(4).any(crash) && !otherwise).then_some(Sense::Act(Act::Slow))
}

/// The first token of the sentence of a verb.
fn carry_first(parser: &Parser<'_>, verb: &Spoken<'_>) -> usize {
    let before = &parser.tokens[..verb.placed().first];
    before.iter().rposition(|token| token.text == ".").map_or(0, |at| at + 1)
}

/// "pulled up to the van ahead": it came near. "Pulled up to the curb" is another thing.
fn pulls_up_to(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let words = &parser.tokens[verb.placed().first..verb.placed().end];
    let up = words.len() == 3 && words[0].text.starts_with("pull") && words[1].text == "up" && words[2].text == "to";
    let somebody = match verb.next()? {
        Chunk::Noun(noun) => noun.subject || noun.kind.is_some_and(|kind| kind.group() != KindGroup::Object),
        Chunk::Piece(_) | Chunk::Pronoun => true,
        _ => false,
    };
    (up && somebody && verb.sense == Sense::Act(Act::PullOver)).then_some(Sense::Approach)
}

/// "The motorcycle came to rest on its right side": it touches nobody.
fn lies_on_its_side(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    let word = |at: usize| parser.tokens.get(placed.end + at).map_or("", |token| token.text.as_str());
    let rests =
        parser.tokens[placed.first..placed.end].windows(2).any(|pair| pair[0].text == "rest" && pair[1].text == "on");
    let own = word(0) == "its" && (word(1) == "side" || word(2) == "side" || matches!(word(1), "roof" | "top"));
    (verb.sense == Sense::Contact && rests && own).then_some(Sense::Other)
}

/// "traffic was backed up" stands.
fn stands_backed_up(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    let backed = verb.sense == Sense::Act(Act::Reverse) && verb.form == Form::Past && verb.word(parser) == "backed";
    let remains = matches!(verb.chunk_before(), Some(Chunk::Verb(Sense::Act(Act::Hold), _)));
    let next = parser.tokens.get(placed.end).map_or("", |token| token.text.as_str());
    let away = matches!(next, "out" | "into" | "from") || !single(placed) && parser.tokens[placed.end - 1].text != "up";
    (backed && (carry.be || remains) && !away).then_some(Sense::Other)
}

/// "remained consistent", "remained in autonomous mode": nobody stands.
fn remains_so(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    if !verb.word(parser).starts_with("remain") || !single(placed) {
        return None;
    }
    let next = |at: usize| parser.tokens.get(placed.end + at).map_or("", |token| token.text.as_str());
    let so = matches!(
        next(0),
        "consistent" | "constant" | "engaged" | "unchanged" | "upright" | "active" | "green" | "red" | "steady" | "the"
    );
    let mode = next(0) == "in" && (1..4).any(|at| matches!(next(at), "mode" | "control" | "motion"));
    (so || mode).then_some(Sense::Other)
}

/// "a bicycle ridden by a courier" passes nobody.
fn is_ridden(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let ridden = verb.sense == Sense::Act(Act::Pass) && matches!(verb.word(parser), "ridden" | "driven");
    ridden.then_some(Sense::Other)
}

/// "The wind blew a cart into it".
fn blows_another(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let blows = verb.sense == Sense::Act(Act::Fall) && matches!(verb.word(parser), "blew" | "blow" | "blowing");
    (blows && matches!(verb.next(), Some(Chunk::Noun(_)))).then_some(Sense::Push)
}

/// "had almost come to rest".
fn nearly_stops(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let before = verb.placed().first.checked_sub(1).map_or("", |at| parser.tokens[at].text.as_str());
    let nearly = verb.sense == Sense::Act(Act::Stop) && matches!(before, "almost" | "nearly");
    nearly.then_some(Sense::Act(Act::Slow))
}

/// "failed to completely stop", "did not come to a full stop", "was unable to stop in time": it slowed. Of a sign or a light it is told that
/// it was run.
fn half_stops(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    if verb.sense != Sense::Act(Act::Stop) || !carry.negated {
        return None;
    }
    let placed = verb.placed();
    let word = |at: usize| parser.tokens.get(at).map_or("", |token| token.text.as_str());
    let around = placed.first.saturating_sub(1)..placed.end + 2;
    let whole = around.clone().any(|at| {
        matches!(word(at), "completely" | "fully" | "entirely" | "complete" | "full" | "quite" | "altogether")
    });
    let control = (placed.end..placed.end + 7).any(|at| matches!(word(at), "sign" | "light" | "signal" | "line"));
    (whole && !control).then_some(Sense::Act(Act::Slow))
}

/// "driving it forward into the van", "the impact moved the bus".
fn moves_another(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    parser.drives_another(verb, carry).then_some(Sense::Push)
}

/// "holding a phone", "held on to the rail".
fn holds_a_thing(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let word = verb.word(parser);
    let held = (word.starts_with("hold") || word == "held") && single(verb.placed());
    let thing = matches!(verb.next(), Some(Chunk::Word | Chunk::Preposition("on") | Chunk::Piece(_) | Chunk::Noun(_)));
    (held && thing).then_some(Sense::Other)
}

/// "a cable being held up by a worker": nobody stands.
fn is_held_by(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    let be = carry.be || !single(placed);
    let held = be && verb.sense == Sense::Act(Act::Hold) && parser.tokens[placed.end - 1].text == "held";
    let behind = |at: usize| parser.tokens.get(verb.placed().end + at).map_or("", |token| token.text.as_str());
    let by = behind(0) == "by" || matches!(behind(0), "up" | "aloft" | "open" | "down") && behind(1) == "by";
    (held && by).then_some(Sense::Other)
}

/// "a gate separating the lot from the street": nothing comes off.
fn lies_between(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let separates = verb.sense == Sense::Act(Act::Fall) && verb.word(parser) == "separating" && !carry.be;
    let from = parser.tokens.get(verb.placed().end).is_some_and(|next| next.text == "from");
    (separates && !from).then_some(Sense::Other)
}

/// "traveling between 10 and 15 mph": between two numbers is no gap.
fn drives_between_numbers(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    let number = parser.tokens.get(placed.end).is_some_and(|token| token.kind == TokenKind::Number);
    let between = parser.tokens[placed.end - 1].text == "between";
    (verb.sense == Sense::Act(Act::Pass) && between && number).then_some(Sense::Act(Act::Follow))
}

/// "began to move toward that lane", "started moving into the left lane": over, and nobody sets off.
fn begins_to_move_over(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    let moves = parser.tokens[placed.first..placed.end].iter().any(|token| token.text.starts_with("mov"));
    if verb.sense != Sense::Act(Act::SetOff) || !moves {
        return None;
    }
    let word = |at: usize| parser.tokens.get(placed.end + at).map_or("", |token| token.text.as_str());
    let lane = (1..7).take_while(|at| !matches!(word(*at), "," | "." | "and")).any(|at| word(at) == "lane");
    let over = word(0) == "over" || matches!(word(0), "left" | "right") || leads_aside(&word);
    match word(0) {
        "into" | "onto" if lane => Some(Sense::Act(Act::LaneChange)),
        "toward" | "towards" | "to" if lane => Some(Sense::Act(Act::Drift)),
        _ => over.then_some(Sense::Act(Act::Drift)),
    }
}

/// "began to drive past it", "started driving next to and mostly past it": it comes by. Next to it alone, it comes along.
fn begins_to_drive_past(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    let moves = parser.tokens[placed.first..placed.end]
        .iter()
        .any(|token| ["driv", "travel", "mov"].iter().any(|stem| token.text.starts_with(stem)));
    if verb.sense != Sense::Act(Act::SetOff) || !moves {
        return None;
    }
    let clause = parser.tokens[placed.end..].iter().take(6).map(|token| token.text.as_str());
    let words: Vec<&str> = clause.take_while(|word| !matches!(*word, "," | "." | "when" | "while" | "as")).collect();
    let beside = matches!(words.as_slice(), ["alongside", ..] | ["next", "to", ..]);
    match words.contains(&"past") {
        true => Some(Sense::Act(Act::Pass)),
        false => beside.then_some(Sense::Act(Act::Follow)),
    }
}

/// "came upon a double-parked van partially intruding into its lane": so it stands.
fn reaches_in(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let reaches = ["intrud", "encroach", "protrud", "jut"].iter().any(|stem| verb.word(parser).starts_with(stem));
    let last = carry.last.as_ref().filter(|last| last.actor != SUBJECT && last.end + 1 >= verb.placed().first)?;
    let parked = parser.world.actors[last.actor].parked;
    (reaches && parked && verb.sense == Sense::Act(Act::Drift)).then_some(Sense::Other)
}

/// "to the left", "toward its right".
fn leads_aside<'a>(word: &impl Fn(usize) -> &'a str) -> bool {
    matches!(word(0), "to" | "toward" | "towards")
        && matches!(word(1), "the" | "its")
        && matches!(word(2), "left" | "right")
}

/// "As the passenger entered the vehicle": the vehicle entered nothing.
fn gets_in(_parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let rider = carry.subject.as_ref().is_some_and(|subject| subject.person == Some(Occupant::Rider));
    (rider && verb.sense == Sense::Act(Act::Enter)).then_some(Sense::Other)
}

/// "The passengers approached the AV", "a passenger was standing beside it": who will ride in it is no vehicle.
fn is_outside(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    // "The AV, which had no passengers, was stopped", "causing the AV to wait".
    let at_once = |end: usize| !parser.tokens[end..verb.placed().first.max(end)].iter().any(|token| token.text == ",");
    let rider = carry.subject.as_ref().is_some_and(|subject| {
        subject.actor == SUBJECT && subject.person == Some(Occupant::Rider) && at_once(subject.end)
    });
    let walks = matches!(verb.sense, Sense::Approach | Sense::Act(Act::Hold | Act::Follow | Act::Cross));
    (rider && walks).then_some(Sense::Other)
}

/// "while his hand rested on the wheel": the vehicle did not rest.
fn is_of_a_hand(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let before = |by: usize| verb.placed().first.checked_sub(by).map_or("", |at| parser.tokens[at].text.as_str());
    let hand = matches!(before(1), "hand" | "hands" | "foot" | "feet" | "head" | "arm");
    // "The van on the other hand braked."
    let own = matches!(before(2), "his" | "her" | "their" | "s") || before(2).ends_with("'s");
    (hand && own && matches!(verb.sense, Sense::Act(_))).then_some(Sense::Other)
}

/// "parked with both doors open", "had its door open": it had been opened before.
fn stands_open(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    let had = parser.tokens[placed.first.saturating_sub(4)..placed.first]
        .iter()
        .any(|token| matches!(token.text.as_str(), "with" | "had" | "having"));
    let open = parser.tokens[placed.end - 1].text == "open";
    (verb.sense == Sense::Act(Act::OpenDoor) && had && open).then_some(Sense::Other)
}

/// "swung left into the van's lane" is no turn at a corner.
fn swings_over(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let Sense::Sided(Act::Turn, side) = verb.sense else { return None };
    let swings = ["sw", "cut", "hook"].iter().any(|stem| verb.word(parser).starts_with(stem));
    let behind = &parser.tokens[verb.placed().end..];
    let lane = behind.windows(2).take(5).any(|pair| pair[0].text == "'s" && pair[1].text == "lane");
    (swings && lane).then_some(Sense::Sided(Act::Drift, side))
}
