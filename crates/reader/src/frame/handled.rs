//! Verbs that say something of a thing at hand, of a road or of a rider, where the lexicon has an act of a vehicle: "turned its lamps on",
//! "dropped off a passenger", "an alley running west". Rules of `SENSES` in `sense.rs`.

use super::parser::{Carry, Parser};
use super::row::{Spoken, single};
use crate::chunk::{Chunk, Noun};
use crate::lexicon::{Form, Occupant, Sense};
use crate::token::{Token, word};
use crate::world::SUBJECT;
use recrash_model::account::{Act, Kind, KindGroup};

/// "the lanes were closed", "a gate that was closed": it had been, and nothing comes down.
pub(super) fn is_closed(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let closed = verb.sense == Sense::Act(Act::Fall) && verb.word(parser) == "closed" && single(verb.placed());
    let next = word(parser.tokens, verb.placed().end);
    let comes_down = matches!(next, "by" | "on" | "onto" | "upon" | "as" | "while" | "behind" | "against");
    // "It closed its doors."
    let behind = parser.tokens[verb.placed().end..].iter().take(5).map(|token| token.text.as_str());
    let own =
        matches!(next, "its" | "his" | "her" | "their") && behind.into_iter().any(|word| word.starts_with("door"));
    (closed && (carry.be && !comes_down || own)).then_some(Sense::Other)
}

/// "launched it into its path", "the chair was launched": pushed.
pub(super) fn launches_another(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let launches = verb.sense == Sense::Act(Act::SetOff) && verb.word(parser).starts_with("launch");
    let object = matches!(verb.next(), Some(Chunk::Noun(_) | Chunk::Pronoun));
    (launches && single(verb.placed()) && (object || carry.be && verb.form == Form::Past)).then_some(Sense::Push)
}

/// "was dropping off a passenger" stands; "having dropped off its riders": nothing fell.
pub(super) fn drops_riders_off(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    const LETS_OFF: [&str; 8] = ["drop", "pick", "let", "load", "unload", "collect", "discharg", "board"];
    let drops = matches!(verb.sense, Sense::Act(Act::Fall) | Sense::Other | Sense::Yield)
        && LETS_OFF.iter().any(|stem| verb.word(parser).starts_with(stem));
    let drops = drops && (verb.sense == Sense::Act(Act::Fall) || carry.be && verb.form == Form::Ing);
    let rider =
        |chunk: &Chunk| matches!(chunk, Chunk::Noun(noun) if matches!(noun.occupant, Some((Occupant::Rider, _))));
    let named = |token: &Token| ["passenger", "rider", "customer"].iter().any(|stem| token.text.starts_with(stem));
    let within = &parser.tokens[verb.placed().first..verb.placed().end];
    let riders = within.iter().any(named) || verb.all[verb.at + 1..].iter().take(2).any(|placed| rider(&placed.chunk));
    let stands = carry.be && verb.form == Form::Ing;
    (drops && riders).then_some(if stands { Sense::Act(Act::Hold) } else { Sense::Other })
}

/// "an object that turned out to be a mattress".
pub(super) fn turns_out_to_be(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let behind = &parser.tokens[verb.placed().first + 1..];
    let words: Vec<&str> = behind.iter().take(5).map(|token| token.text.as_str()).collect();
    let be =
        words.first() == Some(&"out") && words.windows(2).any(|pair| pair == ["to", "be"] || pair == ["to", "have"]);
    (matches!(verb.sense, Sense::Act(Act::Turn)) && be).then_some(Sense::Other)
}

/// "its front wheel fell into a ditch": it met that, where the story tells of no contact behind it. "The wheel fell off": it met nothing.
pub(super) fn drops_into_a_hole(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let own = carry.subject.as_ref().is_some_and(|subject| subject.actor == SUBJECT);
    let drops = verb.sense == Sense::Act(Act::Fall) && own;
    let placed = verb.placed();
    let before = &parser.tokens[placed.first.saturating_sub(2)..placed.first];
    let wheel = before.iter().any(|token| matches!(token.text.as_str(), "wheel" | "wheels" | "tire" | "tires"));
    let into = |at: usize| parser.tokens.get(at).is_some_and(|token| token.text == "into");
    let touches = |pair: &[Token]| match (pair[0].text.as_str(), pair[1].text.as_str()) {
        ("made" | "making", "contact") => true,
        (word, _) => matches!(word, "struck" | "hit" | "collided" | "scraped" | "clipped" | "ended"),
    };
    let later = parser.tokens[placed.end..].windows(2).any(touches);
    (drops && wheel && !later && (into(placed.end) || into(placed.end - 1))).then_some(Sense::Contact)
}

/// "took off their seatbelts", "turned on its hazard lights": nobody moved.
pub(super) fn handles_a_thing(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let end = verb.placed().end;
    let own = |at: usize| matches!(word(parser.tokens, at), "its" | "his" | "her" | "their" | "the");
    let lamp = |at: usize| {
        ["light", "signal", "lamp", "flasher", "blinker", "indicator", "siren"]
            .iter()
            .any(|stem| word(parser.tokens, at).starts_with(stem))
    };
    let takes = verb.sense == Sense::Act(Act::SetOff)
        && word(parser.tokens, end - 1) == "off"
        && ["tak", "took"].iter().any(|stem| verb.word(parser).starts_with(stem));
    let turning = matches!(verb.sense, Sense::Act(Act::Turn) | Sense::Sided(Act::Turn, _))
        && verb.word(parser).starts_with("turn");
    let turns = turning && matches!(word(parser.tokens, end), "on" | "off") && own(end + 1);
    // "turned its left blinker on", "turned its sensors toward it".
    let first = verb.placed().first;
    let thing = |at: usize| {
        lamp(at)
            || ["hazard", "headlamp", "wiper", "engine", "attention", "sensor", "head"]
                .iter()
                .any(|stem| word(parser.tokens, at).starts_with(stem))
    };
    let its = turning && own(first + 1) && (first + 2..first + 6).any(thing);
    // "The front wheels of a van were turned to the left."
    let wheel = turning && carry.be && carry.subject.as_ref().is_some_and(|subject| subject.piece.is_some());
    (takes && own(end) || turns && (end + 2..end + 6).any(lamp) || its || wheel).then_some(Sense::Other)
}

/// "turned the steering wheel left": steered, and no corner.
pub(super) fn turns_the_wheel(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let Sense::Sided(Act::Turn, side) = verb.sense else { return None };
    let words = &parser.tokens[verb.placed().first..verb.placed().end];
    words
        .iter()
        .any(|token| matches!(token.text.as_str(), "wheel" | "steering"))
        .then_some(Sense::Sided(Act::Swerve, side))
}

/// "A passenger turned around": nobody drives back.
pub(super) fn turns_in_its_seat(_parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let rider = carry.subject.as_ref().is_some_and(|subject| subject.person == Some(Occupant::Rider));
    let closes = matches!(verb.sense, Sense::Act(Act::UTurn | Act::Turn | Act::Fall) | Sense::Sided(Act::Turn, _));
    (rider && closes).then_some(Sense::Other)
}

/// "was descending a hill", "dropped to 10 mph", "fell behind a bus", "blew by": what drives does not fall. Who rides a bike may.
pub(super) fn does_not_fall(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let subject = carry.subject.as_ref().filter(|_| verb.sense == Sense::Act(Act::Fall))?;
    let known = parser.world.actors[subject.actor].kind;
    let drives = subject.actor == SUBJECT || known.is_some_and(Kind::is_vehicle);
    let word = verb.word(parser);
    let end = verb.placed().end;
    let next = crate::token::word(parser.tokens, end);
    if !drives || subject.piece.is_some() {
        return None;
    }
    Some(match word {
        _ if word.starts_with("descend") => Sense::Act(Act::Follow),
        _ if (word.starts_with("drop") || matches!(word, "fell" | "falls" | "falling"))
            && matches!(next, "to" | "behind") =>
        {
            Sense::Act(Act::Slow)
        }
        _ if word.starts_with("bl") && matches!(next, "by" | "past") => Sense::Act(Act::Pass),
        _ if word == "closing" && matches!(next, "fast" | "quickly" | "rapidly" | "on" | "in") => Sense::Approach,
        _ => return None,
    })
}

/// "was coming down the hill", "was rolling north", of who drives or rides: it goes along. Only gates and arms come down.
pub(super) fn comes_along(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let acts = carry.subject.as_ref().is_some_and(|subject| parser.world.actors[subject.actor].acts());
    let end = verb.placed().end;
    let within = parser.tokens[verb.placed().first..end].iter();
    let down = verb.sense == Sense::Act(Act::Fall)
        && within.clone().any(|token| token.text == "coming")
        && within.clone().any(|token| token.text == "down");
    let way = parser.tokens[end..].iter().take(4).any(|token| {
        matches!(
            token.text.as_str(),
            "hill" | "street" | "road" | "slope" | "lane" | "block" | "avenue" | "alley" | "ramp"
        )
    });
    let rolls = verb.sense == Sense::Act(Act::Roll) && matches!(verb.next(), Some(Chunk::Compass(_)));
    (acts && (down && way || rolls && single(verb.placed()))).then_some(Sense::Act(Act::Follow))
}

/// "fell and slid to a stop", of who rides: it did not stop as who drives does.
pub(super) fn slides_to_a_stop(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let kind = carry.subject.as_ref().and_then(|subject| parser.world.actors[subject.actor].kind);
    let rides = kind.is_some_and(|kind| matches!(kind.group(), KindGroup::Motorcycle | KindGroup::Cyclist));
    let slides = verb.sense == Sense::Act(Act::Stop) && verb.word(parser).starts_with("slid");
    (rides && slides).then_some(Sense::Act(Act::LoseControl))
}

/// "went over the handlebars".
pub(super) fn goes_over_the_bars(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let goes = matches!(verb.word(parser), "went" | "going" | "go" | "flew" | "pitched");
    let behind = parser.tokens[verb.placed().first..].iter().skip(1).take(4).map(|token| token.text.as_str());
    let words: Vec<&str> = behind.collect();
    let over = words.first() == Some(&"over") && words.iter().any(|word| word.starts_with("handlebar"));
    (goes && over && matches!(verb.sense, Sense::Act(_))).then_some(Sense::Act(Act::Fall))
}

/// "an alley running between two streets": a road does not drive.
pub(super) fn is_of_an_alley(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let before = verb.placed().first.checked_sub(1).map_or("", |at| parser.tokens[at].text.as_str());
    let road =
        matches!(before, "alley" | "alleyway" | "street" | "road" | "roadway" | "lane" | "path" | "driveway" | "track");
    let runs = matches!(verb.word(parser), "running" | "leading" | "going" | "heading");
    let way = matches!(verb.next(), Some(Chunk::Preposition(_) | Chunk::Compass(_) | Chunk::Relation(_) | Chunk::Word));
    (road && runs && way && verb.sense == Sense::Act(Act::Follow) && !carry_is_of(verb)).then_some(Sense::Other)
}

/// Whether a comma or a verb of being stands right before a verb.
fn carry_is_of(verb: &Spoken<'_>) -> bool {
    matches!(verb.chunk_before(), Some(Chunk::Comma | Chunk::Be | Chunk::Joint(_)))
}

/// "came up the hill, standing on the pedals", "a person on a scooter, standing, came up": who rides so does not stand still.
pub(super) fn stands_as_it_rides(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let subject = carry.subject.as_ref().filter(|_| verb.sense == Sense::Act(Act::Hold))?;
    let rides = parser.world.actors[subject.actor].kind.is_some_and(|kind| {
        matches!(kind.group(), KindGroup::Cyclist | KindGroup::Motorcycle)
            || matches!(kind, Kind::ScooterRider | Kind::Skateboarder)
    });
    let placed = verb.placed();
    let upright = placed.end == placed.first + 1 && word(parser.tokens, placed.first) == "standing";
    let pedals = word(parser.tokens, placed.end) == "on"
        && (1..4).any(|on| {
            matches!(word(parser.tokens, placed.end + on), "pedals" | "pegs" | "footpegs" | "deck" | "board")
        });
    let up = matches!(word(parser.tokens, placed.end), "," | "up" | "upright")
        && placed.first > 0
        && word(parser.tokens, placed.first - 1) == ",";
    (rides && upright && (pedals || up)).then_some(Sense::Other)
}

/// "a sign that leaned over the road": what is fixed goes nowhere.
pub(super) fn leans(parser: &Parser<'_>, verb: &Spoken<'_>, carry: &Carry) -> Option<Sense> {
    let subject = carry.subject.as_ref().filter(|_| verb.sense == Sense::Act(Act::Drift))?;
    let fixed = matches!(
        parser.world.actors[subject.actor].kind,
        Some(Kind::Sign | Kind::Pole | Kind::Wall | Kind::TreeBranch | Kind::Barrier)
    );
    (fixed && verb.word(parser).starts_with("lean")).then_some(Sense::Other)
}

/// "went through a barricade", "drove through the fence": it ran into that.
pub(super) fn goes_through_a_barrier(parser: &Parser<'_>, verb: &Spoken<'_>, _carry: &Carry) -> Option<Sense> {
    let goes = matches!(verb.sense, Sense::Act(Act::Enter | Act::Follow));
    let through = parser.tokens[verb.placed().end - 1].text == "through";
    let bars = |noun: &Noun, end: usize| match noun.kind {
        Some(Kind::Barrier | Kind::Chain) => true,
        Some(Kind::Cone) => parser.tokens[end - 1].text.starts_with("barricade"),
        _ => false,
    };
    let barrier = verb.all.get(verb.at + 1).is_some_and(|placed| match &placed.chunk {
        Chunk::Noun(noun) => bars(noun, placed.end),
        _ => false,
    });
    (goes && through && barrier).then_some(Sense::Contact)
}
