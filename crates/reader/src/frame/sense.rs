//! What a verb says here, where the words around it make another thing of it than the lexicon knows.
//!
//! A new rule goes into [`SENSES`]; each sees what the ones before it made of the verb.

use super::handled::{
    comes_along, does_not_fall, drops_into_a_hole, drops_riders_off, goes_over_the_bars, goes_through_a_barrier,
    handles_a_thing, is_closed, is_of_an_alley, launches_another, leans, slides_to_a_stop, stands_as_it_rides,
    turns_in_its_seat, turns_out_to_be, turns_the_wheel,
};
use super::parser::{Carry, Parser};
use super::row::{Spoken, single};
use crate::chunk::Chunk;
use crate::lexicon::{Form, Occupant, Progress, Sense};
use crate::token::{Token, TokenKind, is_crash_noun, word};
use crate::world::SUBJECT;
use recrash_model::account::{Act, Compass, Kind, KindGroup, LeftRight};

type Rule = fn(&Parser<'_>, &Spoken<'_>, &Carry) -> Option<Sense>;

const SENSES: [Rule; 57] = [
    lowers_a_part,
    goes_up_or_down,
    goes_down_a_hill,
    goes_forward_into,
    goes_down_a_road,
    is_operated_by,
    goes_through_no_junction,
    breaks_a_part,
    pulls_up_to,
    lies_on_its_side,
    stands_backed_up,
    reaches_back,
    remains_so,
    does_not_move,
    sits_inside,
    is_ridden,
    stands_as_it_rides,
    leans,
    goes_through_a_barrier,
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
    stands_over,
    gets_in,
    is_outside,
    is_of_a_hand,
    stands_open,
    swings_over,
    moves_itself,
    enters_a_slip_lane,
    tries_to_avoid,
    is_closed,
    launches_another,
    drops_riders_off,
    turns_out_to_be,
    leaves_its_lane,
    moves_a_little_aside,
    moves_over_a_little,
    handles_a_thing,
    turns_the_wheel,
    turns_in_its_seat,
    drops_into_a_hole,
    does_not_fall,
    is_denied_within,
    slides_over,
    comes_along,
    goes_over_the_bars,
    slides_to_a_stop,
    is_of_an_alley,
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
    let crash = |token: &Token| is_crash_noun(&token.text);
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
    let word = |at: usize| word(parser.tokens, placed.end + at);
    let rests =
        parser.tokens[placed.first..placed.end].windows(2).any(|pair| pair[0].text == "rest" && pair[1].text == "on");
    let own = word(0) == "its" && (word(1) == "side" || word(2) == "side" || matches!(word(1), "roof" | "top"));
    (verb.sense == Sense::Contact && rests && own).then_some(Sense::Other)
}

/// "an AV operated by Acme was stopped": it did not drive.
fn is_operated_by(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let by = parser.tokens.get(verb.placed().end).is_some_and(|next| next.text == "by");
    (by && verb.word(parser) == "operated" && single(verb.placed())).then_some(Sense::Other)
}

/// "drove through a parking garage", "going through a work zone": it enters no intersection.
fn goes_through_no_junction(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    const PLACES: [&str; 14] = [
        "garage",
        "lot",
        "alley",
        "alleyway",
        "tunnel",
        "zone",
        "neighborhood",
        "curve",
        "area",
        "structure",
        "bend",
        "gate",
        "campus",
        "park",
    ];
    let placed = verb.placed();
    let through = verb.sense == Sense::Act(Act::Enter) && parser.tokens[placed.end - 1].text == "through";
    let mut noun = parser.tokens[placed.end..].iter().take(5).take_while(|token| token.kind == TokenKind::Word);
    let place = noun.find_map(|token| match token.text.as_str() {
        "intersection" | "junction" | "the" | "light" => (token.text != "the").then_some(false),
        word => PLACES.contains(&word).then_some(true),
    });
    (through && place == Some(true)).then_some(Sense::Act(Act::Follow))
}

/// "knocked the left mirror of the AV", "took off its mirror": a part is touched, and nobody pushed.
fn breaks_a_part(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let words = &parser.tokens[verb.placed().first..verb.placed().end];
    let knocks = verb.sense == Sense::Push && words.len() == 1 && words[0].text.starts_with("knock");
    let takes =
        words.len() == 2 && ["take", "took", "taking"].contains(&words[0].text.as_str()) && words[1].text == "off";
    let part = matches!(verb.next(), Some(Chunk::Piece(piece)) if !piece.its);
    (part && (knocks || takes)).then_some(Sense::Contact)
}

/// "went down Elm Street": it went along there, and did not fall.
fn goes_down_a_road(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let end = verb.placed().end;
    let down = verb.sense == Sense::Act(Act::LoseControl) && parser.tokens[end - 1].text == "down";
    let next = parser.tokens.get(end)?;
    let road = next.capital || next.text.contains("xxx") || matches!(next.text.as_str(), "the" | "a" | "its");
    let ground =
        parser.tokens.get(end + 1).is_some_and(|next| matches!(next.text.as_str(), "ground" | "pavement" | "side"));
    (down && road && !ground).then_some(Sense::Act(Act::Follow))
}

/// "started lowering a loading ramp", "lowered its boom": what it lowers does not fall.
fn lowers_a_part(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    const PARTS: [&str; 9] = ["ramp", "boom", "liftgate", "gate", "platform", "blade", "plow", "window", "tailgate"];
    let lowers = verb.sense == Sense::Act(Act::Fall) && verb.word(parser).starts_with("lower") && !carry.be;
    let active = verb.form == Form::Ing || carry.subject.is_some() && !carry.be;
    let mut behind =
        parser.tokens[verb.placed().end..].iter().take(5).take_while(|token| token.kind == TokenKind::Word);
    (lowers && active && behind.any(|token| PARTS.contains(&token.text.as_str()))).then_some(Sense::Other)
}

/// "The barrier arm went up", "the gate came down": a gate goes nowhere.
fn goes_up_or_down(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let subject = carry.subject.as_ref().filter(|subject| subject.piece.is_none())?;
    let gate = matches!(parser.world.actors[subject.actor].kind, Some(Kind::Gate | Kind::Barrier));
    let moves = matches!(verb.sense, Sense::Act(Act::Follow | Act::Roll | Act::LoseControl | Act::SetOff));
    let words = &parser.tokens[verb.placed().first + 1..];
    let way = words.iter().take(1).map(|token| token.text.as_str()).next()?;
    match way {
        "up" | "open" | "back" if gate && moves => Some(Sense::Other),
        "down" | "closed" | "shut" if gate && moves => Some(Sense::Act(Act::Fall)),
        _ => None,
    }
}

/// "descended the hill": who drives or rides there falls nowhere.
fn goes_down_a_hill(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    const SLOPES: [&str; 8] = ["hill", "slope", "ramp", "street", "road", "grade", "incline", "driveway"];
    let descends = verb.sense == Sense::Act(Act::Fall) && verb.word(parser).starts_with("descend");
    let acts = carry.subject.as_ref().is_some_and(|subject| parser.world.actors[subject.actor].acts());
    let mut behind = parser.tokens[verb.placed().end..].iter().take(4);
    (descends && acts && behind.any(|token| SLOPES.contains(&token.text.as_str()))).then_some(Sense::Act(Act::Follow))
}

/// "moved forward into its rear bumper": nobody is pushed.
fn goes_forward_into(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let words = &parser.tokens[verb.placed().first..verb.placed().end];
    let at_once = words.len() == 3 && words[1].text == "forward" && words[2].text == "into";
    let touches = matches!(verb.next(), Some(Chunk::Noun(_) | Chunk::Piece(_) | Chunk::Pronoun)) && !carry.be;
    (verb.sense == Sense::Push && at_once && words[0].text.starts_with("mov") && touches).then_some(Sense::Contact)
}

/// "traffic was backed up" stands.
fn stands_backed_up(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    let backed = verb.sense == Sense::Act(Act::Reverse) && verb.form == Form::Past && verb.word(parser) == "backed";
    let remains = matches!(verb.chunk_before(), Some(Chunk::Verb(Sense::Act(Act::Hold), _)));
    let next = word(parser.tokens, placed.end);
    let up = parser.tokens[placed.end - 1].text == "up";
    // "Northbound traffic was backed up from the next light."
    let several = carry.subject.as_ref().is_some_and(|subject| parser.world.actors[subject.actor].several);
    let from = next == "from" && !(up && several && carry.be);
    let away = matches!(next, "out" | "into") || from || !single(placed) && !up;
    // "in backed-up traffic".
    let adjective = backed && matches!(next, "traffic" | "vehicles" | "cars") && carry.preposition.is_some();
    // "Vehicles in the next lane were backed up": they stand.
    if backed && up && carry.be && several && !away {
        return Some(Sense::Act(Act::Hold));
    }
    (backed && (carry.be || remains) && !away || adjective).then_some(Sense::Other)
}

/// "a queue that reached back from the light" goes nowhere.
fn reaches_back(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let several = carry.subject.as_ref().is_some_and(|subject| parser.world.actors[subject.actor].several);
    let next = word(parser.tokens, verb.placed().end);
    (several && verb.sense == Sense::Approach && next == "back").then_some(Sense::Other)
}

/// "remained consistent", "remained in autonomous mode", "staying within its lane": nobody stands.
fn remains_so(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    let stays = ["remain", "stay", "keep", "kept"].iter().any(|stem| verb.word(parser).starts_with(stem));
    if !stays || !single(placed) {
        return None;
    }
    if goes_along(parser, verb) && !stood_before(parser, carry) {
        return Some(Sense::Other);
    }
    let next = |at: usize| word(parser.tokens, placed.end + at);
    let so = matches!(
        next(0),
        "consistent" | "constant" | "engaged" | "unchanged" | "upright" | "active" | "green" | "red" | "steady" | "the"
    );
    let mode = next(0) == "in" && (1..4).any(|at| matches!(next(at), "mode" | "control" | "motion"));
    (so || mode).then_some(Sense::Other)
}

/// "in its lane", "within the lines", "to the right", "by the curb", behind a verb of staying: along which somebody drives.
fn goes_along(parser: &Parser<'_>, verb: &Spoken<'_>) -> bool {
    let behind = &parser.tokens[verb.placed().end..];
    let clause = behind.iter().take(8).take_while(|token| token.kind != TokenKind::Mark && token.text != "and");
    let words: Vec<&str> = clause.map(|token| token.text.as_str()).collect();
    let lane = |word: &&str| matches!(*word, "lane" | "lanes" | "lines" | "boundaries" | "markings" | "path");
    let edge = |word: &&str| matches!(*word, "curb" | "edge" | "side" | "shoulder" | "right" | "left");
    match words.first() {
        Some(&("in" | "within" | "inside")) => words.iter().skip(1).take(4).any(lane),
        Some(&("to" | "by" | "along" | "near" | "beside")) => words.iter().skip(1).take(3).any(&edge),
        Some(&"close") => words.iter().skip(2).take(3).any(edge),
        Some(&"on") => words.get(1) == Some(&"course"),
        _ => false,
    }
}

/// Whether the clause is about somebody of whom the last that is told is that it stands.
fn stood_before(parser: &Parser<'_>, carry: &Carry) -> bool {
    let Some(subject) = &carry.subject else { return false };
    let own = |frame: &&super::Frame| frame.who == Some(subject.actor) && frame.happened() && frame.act().is_some();
    let last = parser.frames.iter().rev().find(own);
    last.is_some_and(|last| last.act().is_some_and(Act::rests))
}

/// "was not moving", "had not moved": it stood. "Did not move over" is told of the lane.
fn does_not_move(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let moves = verb.sense == Sense::Act(Act::Follow) && verb.word(parser).starts_with("mov") && single(verb.placed());
    let next = word(parser.tokens, verb.placed().end);
    let way = matches!(
        next,
        "over"
            | "aside"
            | "into"
            | "onto"
            | "to"
            | "toward"
            | "left"
            | "right"
            | "out"
            | "off"
            | "up"
            | "back"
            | "away"
    );
    (moves && carry.negated && !way).then_some(Sense::Act(Act::Hold))
}

/// "A safety driver sat behind the wheel", "two riders sitting in the back": the vehicle does not stand.
fn sits_inside(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let sits = ["sit", "sat", "seated"].iter().any(|stem| verb.word(parser).starts_with(stem));
    let behind = &parser.tokens[verb.placed().end..];
    let words: Vec<&str> = behind.iter().take(6).map(|token| token.text.as_str()).collect();
    let seat = |word: &&str| matches!(*word, "seat" | "seats" | "wheel" | "inside");
    let inside = matches!(words.first(), Some(&("in" | "behind" | "on" | "at"))) && words.iter().take(5).any(seat)
        || matches!(words.as_slice(), ["in", "the" | "its", "back" | "front" | "rear", ..] | ["inside", ..]);
    (sits && verb.sense == Sense::Act(Act::Hold) && inside).then_some(Sense::Other)
}

/// "a bicycle ridden by a courier" passes nobody.
fn is_ridden(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let by = matches!(verb.next(), Some(Chunk::Preposition("by"))) && verb.form == Form::Past;
    let ridden = verb.sense == Sense::Act(Act::Pass) && matches!(verb.word(parser), "ridden" | "driven")
        || by && verb.word(parser) == "operated";
    ridden.then_some(Sense::Other)
}

/// "The wind blew a cart into it". What "blew off a truck" came off it.
fn blows_another(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let blows = verb.sense == Sense::Act(Act::Fall) && matches!(verb.word(parser), "blew" | "blow" | "blowing");
    let off = matches!(parser.tokens[verb.placed().end - 1].text.as_str(), "off" | "of" | "from");
    (blows && !off && matches!(verb.next(), Some(Chunk::Noun(_)))).then_some(Sense::Push)
}

/// "had almost come to rest".
fn nearly_stops(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let before = verb.placed().first.checked_sub(1).map_or("", |at| parser.tokens[at].text.as_str());
    let within = &parser.tokens[verb.placed().first..verb.placed().end];
    let says = |word: &str| matches!(word, "almost" | "nearly");
    let nearly = verb.sense == Sense::Act(Act::Stop) && (says(before) || within.iter().any(|token| says(&token.text)));
    nearly.then_some(Sense::Act(Act::Slow))
}

/// "failed to completely stop", "did not come to a full stop", "was unable to stop in time": it slowed. Of a sign or a light it is told that
/// it was run.
fn half_stops(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    if verb.sense != Sense::Act(Act::Stop) || !carry.negated {
        return None;
    }
    let placed = verb.placed();
    let around = placed.first.saturating_sub(1)..placed.end + 2;
    let whole = around.clone().any(|at| {
        matches!(
            word(parser.tokens, at),
            "completely" | "fully" | "entirely" | "complete" | "full" | "quite" | "altogether"
        )
    });
    let control =
        (placed.end..placed.end + 7).any(|at| matches!(word(parser.tokens, at), "sign" | "light" | "signal" | "line"));
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
    let behind = |at: usize| word(parser.tokens, verb.placed().end + at);
    let by = behind(0) == "by" || matches!(behind(0), "up" | "aloft" | "open" | "down") && behind(1) == "by";
    // "was held up by traffic" stands.
    let waits =
        (1..6).any(|at| matches!(behind(at), "traffic" | "light" | "signal" | "train" | "queue" | "congestion"));
    (held && by && !waits).then_some(Sense::Other)
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
    let word = |at: usize| word(parser.tokens, placed.end + at);
    let lane = (1..7).take_while(|at| !matches!(word(*at), "," | "." | "and")).any(|at| word(at) == "lane");
    let far = how_far(&word);
    let over = word(0) == "over" || matches!(word(far), "left" | "right") || leads_aside(&|at| word(far + at));
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
    // "began to move off past the stop line" passes nobody.
    let past = words.iter().position(|word| *word == "past").map(|at| placed.end + at + 1);
    let somebody = |chunk: &Chunk| matches!(chunk, Chunk::Noun(_) | Chunk::Pronoun | Chunk::Piece(_));
    let passed = past.and_then(|past| verb.all.iter().find(|chunk| chunk.first == past || chunk.first == past + 1));
    match past.is_some() {
        true => passed.is_some_and(|passed| somebody(&passed.chunk)).then_some(Sense::Act(Act::Pass)),
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

/// "was parked, encroaching on the lane", "halted straddling two lanes": it stands there, and goes nowhere.
fn stands_over(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    const OVER: [&str; 10] =
        ["intrud", "encroach", "protrud", "jut", "straddl", "lean", "overlap", "reach", "project", "crossing"];
    let over = verb.sense == Sense::Act(Act::Drift)
        && verb.form == Form::Ing
        && OVER.iter().any(|stem| verb.word(parser).starts_with(stem));
    let who = carry.subject.as_ref().or(carry.last.as_ref()).filter(|_| over && !carry.be && !carry.began)?.actor;
    let last = parser.frames.iter().rev().find(|frame| frame.who == Some(who) && frame.act().is_some())?;
    let stood = last.act().is_some_and(Act::rests) && last.happened();
    (stood && last.sentence == parser.sentence).then_some(Sense::Other)
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

/// "failed to stay within its lane": it came out of it.
fn leaves_its_lane(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let stays = ["remain", "stay", "keep"].iter().any(|stem| verb.word(parser).starts_with(stem));
    let behind = &parser.tokens[verb.placed().end..];
    let words: Vec<&str> = behind.iter().take(4).map(|token| token.text.as_str()).collect();
    let lane =
        matches!(words.as_slice(), ["in" | "within" | "to", ..]) && words.iter().any(|word| word.starts_with("lane"));
    (stays && carry.negated && lane && single(verb.placed())).then_some(Sense::Act(Act::Drift))
}

/// "moved a little to the left", "proceeded a short distance to the right": over.
fn moves_a_little_aside(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    const MOVES: [&str; 4] = ["mov", "proceed", "pull", "advanc"];
    let moves = matches!(verb.sense, Sense::Act(Act::Follow | Act::SetOff))
        && MOVES.iter().any(|stem| verb.word(parser).starts_with(stem));
    let word = |at: usize| word(parser.tokens, verb.placed().end + at);
    let far = how_far(&word);
    // "proceeded a short distance to the left of the van": that is where it was.
    let there = word(far + 3) == "of";
    // "proceeded slowly to the left turn lane".
    let lane = (far + 3..far + 6).any(|at| matches!(word(at), "lane" | "lanes"));
    // "pulled forward slowly to the left": it set off.
    let within = &parser.tokens[verb.placed().first..verb.placed().end];
    let on = within.iter().any(|token| matches!(token.text.as_str(), "forward" | "ahead" | "up"));
    let sets_off = on && verb.sense == Sense::Act(Act::SetOff);
    (moves && far > 0 && leads_aside(&|at| word(far + at)) && !(there || lane || sets_off))
        .then_some(Sense::Act(Act::Drift))
}

/// "slightly", "a little", "a few feet": so many words tell how far.
fn how_far<'a>(word: &impl Fn(usize) -> &'a str) -> usize {
    let little = |word: &str| matches!(word, "distance" | "way" | "amount" | "feet" | "inches" | "meters");
    match (word(0), word(1), word(2)) {
        ("a", "little" | "bit", next) => 2 + usize::from(next == "bit"),
        ("a" | "some" | "about" | "several", _, last) if little(last) => 3,
        ("several" | "some", last, _) if little(last) => 2,
        ("slightly" | "gradually" | "partly" | "slowly" | "further" | "abruptly" | "suddenly", ..) => 1,
        _ => 0,
    }
}

/// "moved over slightly to make room", "moved over within its lane", "moved over toward the curb": no lane is changed.
fn moves_over_a_little(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let placed = verb.placed();
    let over = placed.end - placed.first == 2 && parser.tokens[placed.end - 1].text == "over";
    let behind = parser.tokens[placed.end..].iter().take(10).take_while(|token| token.kind != TokenKind::Mark);
    let words: Vec<&str> = behind.map(|token| token.text.as_str()).take_while(|word| *word != "and").collect();
    let within = words.windows(3).any(|run| matches!(run, ["within" | "in", "its" | "the", "lane"]));
    let lane = words.iter().any(|word| matches!(*word, "lane" | "lanes"));
    let little = words.iter().any(|word| {
        matches!(
            *word,
            "slightly"
                | "left"
                | "right"
                | "curb"
                | "edge"
                | "side"
                | "shoulder"
                | "bit"
                | "little"
                | "feet"
                | "inches"
        )
    });
    let room = words.windows(2).any(|pair| matches!(pair, ["make" | "give", ..])) && words.contains(&"room");
    let moves = verb.sense == Sense::Act(Act::LaneChange) && over;
    (moves && (within || !lane && (little || room))).then_some(Sense::Act(Act::Drift))
}

/// "drove past a stop sign without stopping": the verb before has said it.
fn is_denied_within(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let before = verb.placed().first.checked_sub(1).map_or("", |at| parser.tokens[at].text.as_str());
    let ran = matches!(verb.chunk_before(), Some(Chunk::Verb(Sense::Act(Act::RunStop | Act::RunRed), _)));
    (before == "without" && ran && !carry.negated && verb.form == Form::Ing).then_some(Sense::Other)
}

/// "slid into its lane", of no wet road: over.
fn slides_over(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let slides = verb.sense == Sense::Act(Act::LoseControl) && verb.word(parser).starts_with("slid");
    let behind = parser.tokens[verb.placed().end..].iter().take(6).map(|token| token.text.as_str());
    let words: Vec<&str> = behind.collect();
    let into = words.first() == Some(&"into") && words.contains(&"lane");
    let slippery =
        |token: &Token| matches!(token.text.as_str(), "ice" | "icy" | "wet" | "snow" | "slippery" | "slick" | "oil");
    let first = carry_first(parser, verb);
    let whole = parser.tokens[first..].iter().take_while(|token| token.text != ".");
    (slides && into && !whole.into_iter().any(slippery)).then_some(Sense::Act(Act::Drift))
}
