//! Nouns, parts and pronouns: who is meant by them, and whether a clause begins with them or they belong to the verb before.

use super::Frame;
use super::parser::{Carry, Mention, Parser};
use super::row::{another_finite, goes_on_behind_comma, relation_behind, transitive};
use crate::chunk::{Article, Chunk, Joint, Noun, Piece, Placed};
use crate::lexicon::{Adjective, Form, Occupant, Relation, Sense};
use crate::token::{TokenKind, number, word};
use crate::world::{Actor, SUBJECT, same_kind};
use recrash_model::account::{Act, Kind, KindGroup};

/// Words between a noun and those that count who stands before it: "located", "that was stopped". [tokens]
const FARTHER_WITHIN: usize = 6;

/// "The shuttle struck the rear of the AV": whether what stands behind a noun tells that it met the subject vehicle.
fn meets_subject(behind: &[Placed]) -> bool {
    let ends = |placed: &Placed| matches!(&placed.chunk, Chunk::Joint(joint) if *joint != Joint::And);
    let clause = &behind[..behind.iter().position(ends).unwrap_or(behind.len())];
    let contact = clause.iter().position(|placed| matches!(placed.chunk, Chunk::Verb(Sense::Contact, _)));
    let object = contact.and_then(|contact| {
        clause[contact..].iter().find_map(|placed| match &placed.chunk {
            Chunk::Noun(noun) => Some(noun.subject && noun.occupant.is_none()),
            Chunk::Piece(piece) => piece.owner.as_ref().map(|owner| owner.subject),
            _ => None,
        })
    });
    object == Some(true)
}

impl Parser<'_> {
    /// Somebody or something is named. Whether the comma and the filled preposition before it still stand before what follows.
    pub(super) fn noun(&mut self, noun: &Noun, all: &[Placed], at: usize, carry: &mut Carry) -> bool {
        let placed = &all[at];
        if self.counts_between(placed) && carry.last.is_some() {
            return true;
        }
        let next = all.get(at + 1).map(|placed| &placed.chunk);
        if self.is_own_thing(noun, all, at) {
            let actor = self.its(&self.tokens[placed.first].text, carry);
            self.mention(Mention { actor, piece: None, person: None, end: placed.end }, placed, carry, next);
            return false;
        }
        if self.is_what_it_is(noun, all, at, carry) {
            self.stands_in_line(noun, placed, carry);
            return true;
        }
        if self.is_of_anyone(noun, all, at) {
            (carry.preposition, carry.relation) = (None, None);
            return true;
        }
        // "The line of cars ahead came to a halt": those who stand in it did.
        if carry.preposition == Some("of") && carry.frame.is_none() && self.begins_with_row(placed.first) {
            (carry.preposition, carry.governed) = (None, false);
        }
        if let Some(actor) = self.apposed(noun, all, at, carry) {
            self.world.describe(actor, noun, (placed.first, placed.end));
            self.attribute(noun, actor, placed, carry);
            (carry.governed, carry.after_comma) = (false, false);
            return true;
        }
        let actor = self.meant(noun, all, at, carry);
        // "one standing passenger": the vehicle does not stand.
        let described = if noun.occupant.is_some() { noun.owner.as_deref() } else { Some(noun) };
        if let Some(described) = described {
            self.attribute(described, actor, placed, carry);
        }
        // "in a queue of westbound traffic": the direction is also that of who stands in it.
        if let (Some(compass), true, Some("of" | "in" | "behind")) = (noun.compass, noun.several, carry.preposition) {
            self.compass(compass, placed, carry);
            carry.preposition = Some("of");
        }
        self.leave_preposition(noun, all, at, carry);
        self.begin_outer_clause(noun, all, at, carry);
        let person = noun.occupant.map(|(who, _)| who);
        self.mention(Mention { actor, piece: None, person, end: placed.end }, placed, carry, next);
        false
    }

    /// "was the third car in line at a light": it stood there.
    fn stands_in_line(&mut self, noun: &Noun, placed: &Placed, carry: &mut Carry) {
        if self.is_in_line(noun, placed.end) && carry.be {
            let mut stands = self.frame(Some(SUBJECT), Sense::Act(Act::Hold), Form::Past, placed, carry);
            stands.state = true;
            self.frames.push(stands);
            carry.frame = Some(self.frames.len() - 1);
        }
    }

    /// "a vehicle's driving task", "in a driver's eyes": nobody of the story.
    fn is_of_anyone(&self, noun: &Noun, all: &[Placed], at: usize) -> bool {
        let end = all[at].end;
        let anyone =
            noun.article == Article::Indefinite && (noun.kind == Some(Kind::Vehicle) || noun.occupant.is_some());
        let owns = self.tokens.get(end).is_some_and(|next| next.text == "'s");
        let of_road =
            self.tokens[end..].iter().take(5).any(|token| matches!(token.text.as_str(), "lane" | "path" | "way"));
        let thing = matches!(all.get(at + 2).map(|placed| &placed.chunk), Some(Chunk::Word | Chunk::Verb(..)));
        anyone && owns && thing && !of_road
    }

    /// Who is meant by a noun, by what the story and the words around it tell.
    fn meant(&mut self, noun: &Noun, all: &[Placed], at: usize, carry: &Carry) -> Actor {
        let placed = &all[at];
        self.world.main = carry.main.as_ref().map(|main| main.actor);
        self.world.apart = self.stands_farther(placed.end) || self.goes_on_foot(noun, placed.end);
        self.world.before = carry.relation == Some(Relation::Behind);
        self.world.strikes = meets_subject(&all[at + 1..]);
        self.world.counted = self.tokens[placed.first..].iter().take(2).any(|token| token.kind == TokenKind::Number);
        let actor = self.world.resolve(noun, (placed.first, placed.end), relation_behind(all, at));
        (self.world.apart, self.world.before) = (false, false);
        (self.world.strikes, self.world.counted) = (false, false);
        let verb = matches!(all.get(at + 1).map(|next| &next.chunk), Some(Chunk::Be | Chunk::Verb(..)));
        let actor = if verb && self.is_vehicle_of_story(noun, actor, carry) { SUBJECT } else { actor };
        let actor = if self.is_who_stands(noun, actor, carry) { SUBJECT } else { actor };
        let actor = self.whose_driver(noun, actor, placed, carry);
        let actor = self.behind_its_like(noun, actor, carry);
        self.who_does_so(noun, actor, all, at)
    }

    /// "At this time a van ...": the van is not behind "at".
    fn leave_preposition(&self, noun: &Noun, all: &[Placed], at: usize, carry: &mut Carry) {
        let green = at > 0 && crate::chunk::is_colour(&self.tokens[all[at - 1].first].text);
        let apart = (carry.preposition != Some("to") || green) && self.stands_apart(all, at);
        if (carry.filled || apart) && noun.article != Article::None {
            (carry.preposition, carry.relation) = (None, None);
            // "It opened its door at the moment a van was driving by": the van begins a clause.
            if matches!(all.get(at + 1).map(|next| &next.chunk), Some(Chunk::Be)) {
                carry.frame = None;
            }
        }
    }

    /// "As it was passing the van a coupe reversed": the coupe begins the clause around it.
    fn begin_outer_clause(&self, noun: &Noun, all: &[Placed], at: usize, carry: &mut Carry) {
        let frame = carry.frame.map(|frame| &self.frames[frame]);
        let open = frame.is_some_and(|frame| {
            frame.object.is_none() && transitive(frame.sense) && !matches!(frame.act(), Some(Act::Follow | Act::Slow))
        });
        let inner = carry.joint.is_some_and(|joint| joint != Joint::And) && carry.has_verb && !carry.relative;
        let loose = carry.preposition.is_none() && carry.relation.is_none() && !(carry.be || carry.fresh || open);
        let slows = frame.is_some_and(|frame| frame.act() == Some(Act::Slow));
        let known = noun.article == Article::Definite && slows;
        if loose && inner && carry.mains.len() == 1 && (noun.article == Article::Indefinite || known) {
            // "When it braked the van behind it did not stop".
            let behind = &all[at + 1..];
            let mut clause = behind.iter().take_while(|next| !matches!(next.chunk, Chunk::Comma | Chunk::Joint(_)));
            let denied = clause.any(|next| matches!(next.chunk, Chunk::Not));
            carry.after_comma |= another_finite(all, at) || goes_on_behind_comma(behind) || denied;
        }
    }

    /// "The line of cars", "and a row of vans": a noun behind "of" that a clause begins with.
    fn begins_with_row(&self, first: usize) -> bool {
        let word = |back: usize| first.checked_sub(back).map_or(".", |at| self.tokens[at].text.as_str());
        let row = matches!(word(2), "line" | "row" | "queue" | "column" | "string" | "stream") && word(1) == "of";
        let begins = matches!(word(4), "." | "," | "and" | "when" | "while" | "as" | "because" | "since" | "but");
        row && matches!(word(3), "a" | "the") && begins
    }

    /// "At low speed it moved", "Near the junction the van braked": nothing but an adverb stands between a preposition and what it governs.
    fn stands_apart(&self, all: &[Placed], at: usize) -> bool {
        let Some(before) = at.checked_sub(1).map(|at| &all[at]) else { return false };
        let word = self.tokens[before.first].text.as_str();
        let between = word.ends_with("ly")
            || matches!(
                word,
                "all" | "both" | "half" | "only" | "just" | "involving" | "even" | "also" | "about" | "what"
            )
            || matches!(
                word,
                "approximately" | "around" | "over" | "almost" | "nearly" | "whose" | "directly" | "right"
            );
        match before.chunk {
            Chunk::Word if matches!(word, "crossing" | "building" | "landing") => true,
            Chunk::Word => !between && (!word.ends_with("ing") || self.tokens[before.first].capital),
            Chunk::Spot(_) | Chunk::Lane(_) | Chunk::Compass(_) => true,
            _ => false,
        }
    }

    /// "two vehicles" of "a van located two vehicles behind it": how far, and nobody.
    fn counts_between(&self, placed: &Placed) -> bool {
        let first = placed.first;
        self.stands_farther(first)
            && placed.end == first + 2
            && number(&self.tokens[first].text).is_some()
            && matches!(self.tokens[placed.end].text.as_str(), "behind" | "back" | "ahead")
    }

    /// "a van located two vehicles behind it": others stand in between.
    fn stands_farther(&self, end: usize) -> bool {
        let behind: Vec<&str> =
            self.tokens[end..].iter().take(FARTHER_WITHIN).map(|token| token.text.as_str()).collect();
        behind.windows(3).any(|row| {
            number(row[0]).is_some_and(|count| count > 1)
                && matches!(row[1], "vehicles" | "cars")
                && matches!(row[2], "behind" | "back" | "ahead")
        })
    }

    /// "A woman pushing a stroller", "a man walking a dog": not who rides, and was announced.
    fn goes_on_foot(&self, noun: &Noun, end: usize) -> bool {
        let next = |at: usize| word(self.tokens, end + at);
        let on_foot = matches!(next(0), "pushing" | "walking" | "jogging" | "strolling");
        let rides = |kind: Kind| matches!(kind, Kind::Skateboarder | Kind::ScooterRider | Kind::Wheelchair);
        let rider = self.world.actors.iter().any(|known| known.announced && known.kind.is_some_and(rides));
        // "A man walking his bicycle", "pushing her scooter".
        let own = matches!(next(1), "his" | "her" | "their" | "its");
        noun.kind == Some(Kind::Pedestrian) && on_foot && rider && !own
    }

    /// "The AV was the lead vehicle stopped at a light", "waited as the first car in line": what it is, and nobody else.
    fn is_what_it_is(&self, noun: &Noun, all: &[Placed], at: usize, carry: &Carry) -> bool {
        let one_of = noun.one_of && noun.kind.is_some_and(Kind::is_vehicle) && carry.be;
        let first = one_of
            || self.is_in_line(noun, all[at].end)
            || noun.adjectives.iter().any(|adjective| matches!(adjective, Adjective::Lead | Adjective::First));
        let vehicle = noun.kind.is_some_and(Kind::is_vehicle) && noun.occupant.is_none() && !noun.several;
        let of_subject =
            carry.subject.as_ref().is_some_and(|subject| subject.actor == SUBJECT && subject.piece.is_none());
        let as_one = at > 0 && self.tokens[all[at - 1].first].text == "as" && !another_finite(all, at);
        first && vehicle && of_subject && (carry.be || as_one)
    }

    /// "the third car in line".
    fn is_in_line(&self, noun: &Noun, end: usize) -> bool {
        let line = matches!(word(self.tokens, end + 1), "line" | "queue")
            || word(self.tokens, end + 1) == "the" && matches!(word(self.tokens, end + 2), "line" | "queue");
        noun.ordinal.is_some() && word(self.tokens, end) == "in" && line
    }

    /// "its toolbox scratched the door": whose it is does so.
    fn is_own_thing(&self, noun: &Noun, all: &[Placed], at: usize) -> bool {
        let thing = noun.kind.is_some_and(|kind| kind.group() == KindGroup::Object && kind != Kind::Cargo);
        let its = matches!(self.tokens[all[at].first].text.as_str(), "its" | "their" | "his" | "her");
        let verb = || all[at + 1..].iter().find(|placed| !matches!(placed.chunk, Chunk::Word | Chunk::Piece(_)));
        its && thing && verb().is_some_and(|placed| matches!(placed.chunk, Chunk::Verb(Sense::Contact, _)))
    }

    /// "A van left its stall as the vehicle was going by": not the van.
    fn is_vehicle_of_story(&self, noun: &Noun, actor: Actor, carry: &Carry) -> bool {
        let plain = noun.is_plain_vehicle() && noun.occupant.is_none();
        let of_main = carry.main.as_ref().is_some_and(|main| main.actor == actor && actor != SUBJECT);
        plain && of_main && carry.fresh && carry.joint == Some(Joint::While) && self.world.topic == SUBJECT
    }

    /// "The car turning left", "the turning car", of two cars: the one that was told to do so.
    fn who_does_so(&self, noun: &Noun, actor: Actor, all: &[Placed], at: usize) -> Actor {
        let kind = noun.kind.filter(|_| noun.article == Article::Definite && !noun.several && noun.occupant.is_none());
        let Some(kind) = kind.filter(|kind| kind.is_vehicle() && actor != SUBJECT) else { return actor };
        let (act, side) = match all.get(at + 1).map(|placed| &placed.chunk) {
            Some(Chunk::Verb(Sense::Sided(act, side), Form::Ing)) => (*act, Some(*side)),
            Some(Chunk::Verb(
                Sense::Act(act @ (Act::Turn | Act::LaneChange | Act::Reverse | Act::Hold)),
                Form::Ing,
            )) => (*act, None),
            _ => match self.doing(&all[at]).filter(|_| noun.adjectives.contains(&Adjective::Doing)) {
                Some(doing) => doing,
                None => return actor,
            },
        };
        let fits = |who: Actor| {
            let known = &self.world.actors[who];
            who != SUBJECT && !known.several && known.kind.is_some_and(|known| same_kind(known, kind))
        };
        let did = |frame: &&Frame| {
            let same = frame.act() == Some(act) && (side.is_none() || frame.side == side);
            same && frame.sentence < self.sentence && frame.happened() && frame.who.is_some_and(fits)
        };
        let own = self
            .frames
            .iter()
            .any(|frame| frame.who == Some(actor) && frame.act() == Some(act) && frame.sentence < self.sentence);
        if own { actor } else { self.frames.iter().rev().find(did).and_then(|frame| frame.who).unwrap_or(actor) }
    }

    /// "a van whose driver was texting": who is named before drives it.
    fn whose_driver(&self, noun: &Noun, actor: Actor, placed: &Placed, carry: &Carry) -> Actor {
        let whose = placed.first > 0 && self.tokens[placed.first - 1].text == "whose" && noun.occupant.is_some();
        carry.last.as_ref().filter(|_| whose && noun.owner.is_none()).map_or(actor, |last| last.actor)
    }

    /// "A second van came up behind the van that had stopped": nobody is behind itself.
    fn behind_its_like(&self, noun: &Noun, actor: Actor, carry: &Carry) -> Actor {
        let own = carry.subject.as_ref().is_some_and(|subject| subject.actor == actor) && actor != SUBJECT;
        let placed =
            carry.relation.is_some() && noun.article == Article::Definite && noun.occupant.is_none() && !noun.several;
        if own && placed { self.world.like(actor).unwrap_or(actor) } else { actor }
    }

    /// "It stood at the curb. A van went by and clipped the parked vehicle": who was told to stand, where no other one was.
    fn is_who_stands(&mut self, noun: &Noun, actor: Actor, carry: &Carry) -> bool {
        let called = noun.adjectives.iter().any(|word| matches!(word, Adjective::Stopped | Adjective::Parked));
        let plain = matches!(noun.kind, Some(Kind::Vehicle | Kind::PassengerCar))
            && noun.names.is_empty()
            && noun.number.is_none();
        let known = &self.world.actors[actor];
        let of_main = carry.subject.as_ref().is_some_and(|subject| subject.actor == actor || subject.actor != SUBJECT);
        let new = known.mentions == 1;
        let other = known.parked && !new && carry.subject.as_ref().is_none_or(|subject| subject.actor != actor);
        let one = noun.article == Article::Definite && !noun.several && noun.occupant.is_none();
        let stands =
            called && plain && one && actor != SUBJECT && self.world.actors[SUBJECT].parked && of_main && !other;
        if stands && new {
            self.world.actors[actor].mentions = 0;
        }
        stands
    }

    pub(super) fn piece(&mut self, piece: &Piece, all: &[Placed], at: usize, carry: &mut Carry) -> bool {
        let placed = &all[at];
        let next = all.get(at + 1).map(|placed| &placed.chunk);
        if carry.filled {
            (carry.preposition, carry.relation) = (None, None);
        }
        let Some(actor) = self.whose(piece, all, at, carry) else {
            self.loose_piece(piece, placed, carry);
            return false;
        };
        let mention = Mention { actor, piece: Some(piece.clone()), person: None, end: placed.end };
        self.mention(mention, placed, carry, next);
        false
    }

    /// Whose a part is.
    fn whose(&mut self, piece: &Piece, all: &[Placed], at: usize, carry: &mut Carry) -> Option<Actor> {
        let placed = &all[at];
        if let Some(owner) = &piece.owner {
            let hint = relation_behind(all, at);
            let verb = all.get(at + 1).map(|next| &next.chunk);
            self.world.touches = matches!(verb, Some(Chunk::Verb(Sense::Contact, _)));
            self.world.main = carry.main.as_ref().map(|main| main.actor);
            self.world.apart = self.stands_farther(placed.end);
            let actor = self.world.resolve(owner, (placed.first, placed.end), hint);
            (self.world.touches, self.world.apart) = (false, false);
            let told = owner.compass.is_some()
                || owner.adjectives.iter().any(|word| matches!(word, Adjective::First | Adjective::Another));
            let actor = if told { actor } else { self.as_a_result(actor, placed.first) };
            let actor = if self.is_who_stands(owner, actor, carry) { SUBJECT } else { actor };
            let actor = self.who_does_so(owner, actor, all, at);
            self.attribute(owner, actor, placed, carry);
            return Some(actor);
        }
        // "a van whose door".
        if at > 0
            && self.tokens[all[at - 1].first].text == "whose"
            && let Some(last) = &carry.last
        {
            carry.frame = None;
            return Some(last.actor);
        }
        let word =
            self.tokens[placed.first..placed.end].iter().find(|token| matches!(token.text.as_str(), "its" | "it"));
        if piece.its {
            let word = word.map_or("their", |token| &token.text);
            let actor = self.part_behind_object(carry).unwrap_or_else(|| self.its(word, carry));
            // "As a cyclist rode past it, its rear door was opened": who rides has none.
            let kind = self.world.actors[actor].kind.filter(|_| piece.door && actor != SUBJECT);
            let rides =
                |kind: Kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist | KindGroup::Motorcycle);
            return Some(if kind.is_some_and(rides) { SUBJECT } else { actor });
        }
        // "The edge of the open door touched": of whom it was opened.
        let door = if piece.door && carry.fresh { self.door_of() } else { None };
        // "It set off, and the rear tire touched": of whom the sentence is about.
        let verb = matches!(all.get(at + 1).map(|placed| &placed.chunk), Some(Chunk::Verb(..) | Chunk::Be));
        door.or_else(|| (carry.fresh && verb).then(|| self.its("its", carry)))
    }

    pub(super) fn pronoun(&mut self, all: &[Placed], at: usize, carry: &mut Carry) -> bool {
        let chunk = |ahead: usize| all.get(at + ahead).map(|placed| &placed.chunk);
        // "It is at this time that ...": nobody.
        if matches!(chunk(1), Some(Chunk::Be))
            && matches!(chunk(2), Some(Chunk::Preposition("at" | "within") | Chunk::Relative))
        {
            return false;
        }
        // "Having slowed until it was nearly stopped, the AV": who is named behind.
        let inner = matches!(carry.joint, Some(Joint::Before | Joint::While | Joint::Because)) && carry.fresh;
        if inner
            && carry.main.is_none()
            && !carry.pending.is_empty()
            && carry.subject.is_none()
            && self.world.topic != SUBJECT
        {
            return false;
        }
        // "As it drove around the AV, a coupe scraped it": who is named behind, since nobody drives around itself.
        if self.is_before_its_noun(all, at, carry) {
            return false;
        }
        if self.stands_apart(all, at) {
            (carry.preposition, carry.relation) = (None, None);
        }
        let struck = self.waits_struck(all, at, carry).or_else(|| self.closes(all, at));
        let actor = struck.unwrap_or_else(|| self.not_itself(self.its(&self.tokens[all[at].first].text, carry), carry));
        let actor = self.not_who_stands(actor, all, at, carry);
        let actor = if self.stops_because(all, at, carry) { SUBJECT } else { actor };
        let actor = self.flew_there(all, at, carry).unwrap_or(actor);
        let actor = if self.is_named_behind(all, at, carry) { SUBJECT } else { actor };
        let actor = self.latter(all[at].first).unwrap_or(actor);
        let both = self.both(all, at).filter(|_| carry.main.is_none());
        let mention = Mention { actor: both.unwrap_or(actor), piece: None, person: None, end: all[at].end };
        self.mention(mention, &all[at], carry, chunk(1));
        if both.is_some() {
            carry.also = carry.subject.clone().map(|subject| Mention { actor: SUBJECT, ..subject });
        }
        false
    }

    /// "launched the crate into its path, where it hit the hood": the thing that came there.
    fn flew_there(&self, all: &[Placed], at: usize, carry: &Carry) -> Option<Actor> {
        let hits = matches!(all.get(at + 1).map(|placed| &placed.chunk), Some(Chunk::Verb(Sense::Contact, _)));
        let last = self.frames.last().filter(|frame| carry.place && hits && frame.sentence == self.sentence)?;
        let thing = |actor: &Actor| *actor != SUBJECT && !self.world.actors[*actor].acts();
        if last.sense == Sense::Push { last.object.filter(thing) } else { last.who.filter(thing) }
    }

    /// Whether "it" in a clause in front cannot be the subject vehicle, which that clause names besides: "When it backed up toward the AV, a van".
    fn is_before_its_noun(&self, all: &[Placed], at: usize, carry: &Carry) -> bool {
        let fronted = carry.main.is_none() && carry.joint == Some(Joint::While) && carry.clause == 1 && carry.fresh;
        let Some(comma) = all[at..].iter().position(|placed| matches!(placed.chunk, Chunk::Comma)) else {
            return false;
        };
        let named =
            all[at + 1..at + comma].iter().any(|placed| matches!(&placed.chunk, Chunk::Noun(noun) if noun.subject));
        let behind = all[at + comma..].iter().find(|placed| !matches!(placed.chunk, Chunk::Comma | Chunk::Word));
        let other = behind.is_some_and(|placed| match &placed.chunk {
            Chunk::Noun(noun) => !noun.subject,
            Chunk::Piece(piece) => piece.owner.as_ref().is_some_and(|owner| !owner.subject),
            _ => false,
        });
        let it = self.tokens[all[at].first].text == "it";
        fronted && named && other && it && self.its("it", carry) == SUBJECT
    }

    /// "A van struck it. Once it had stopped, the AV was hit": whom the sentence is about, named behind the comma.
    fn is_named_behind(&self, all: &[Placed], at: usize, carry: &Carry) -> bool {
        let fronted = carry.main.is_none() && carry.joint.is_some_and(|joint| joint != Joint::And) && carry.clause == 1;
        let Some(comma) = all[at..].iter().position(|placed| matches!(placed.chunk, Chunk::Comma)) else {
            return false;
        };
        let clause = &all[at + 1..at + comma];
        let stops = clause.iter().any(|placed| {
            matches!(
                placed.chunk,
                Chunk::Verb(Sense::Act(Act::Stop | Act::Hold | Act::Slow | Act::Park) | Sense::Parked, _)
            )
        });
        let other = clause.iter().any(|placed| matches!(placed.chunk, Chunk::Noun(_) | Chunk::Pronoun));
        let behind = all[at + comma..].iter().find(|placed| !matches!(placed.chunk, Chunk::Comma | Chunk::Word));
        let named = behind.is_some_and(|placed| matches!(&placed.chunk, Chunk::Noun(noun) if noun.subject));
        fronted && stops && !other && named && self.tokens[all[at].first].text == "it"
    }

    /// "Because a truck blocked the lane, it stopped": whom the story is about.
    fn stops_because(&self, all: &[Placed], at: usize, carry: &Carry) -> bool {
        let because = carry.joint == Some(Joint::Because) && carry.after_comma && carry.has_verb && carry.clause == 1;
        let verb = all[at + 1..]
            .iter()
            .find(|placed| !matches!(placed.chunk, Chunk::Word | Chunk::Be))
            .map(|placed| &placed.chunk);
        let gives_way = matches!(
            verb,
            Some(Chunk::Verb(Sense::Act(Act::Stop | Act::Hold | Act::Slow) | Sense::Yield | Sense::TakeOver, _))
        );
        because && gives_way && self.world.topic == SUBJECT && self.tokens[all[at].first].text == "it"
    }

    /// "the latter": who was named last; "the former": who was before that.
    fn latter(&self, first: usize) -> Option<Actor> {
        let mut named: Vec<Actor> =
            (0..self.world.actors.len()).filter(|actor| self.world.actors[*actor].mentions > 0).collect();
        named.sort_by_key(|actor| std::cmp::Reverse(self.world.actors[*actor].last));
        let back = match (self.tokens[first].text.as_str(), self.tokens.get(first + 1)?.text.as_str()) {
            ("the", "latter") => 0,
            ("the", "former") => 1,
            _ => return None,
        };
        named.get(back).copied()
    }

    /// "Both were northbound", "They entered the junction together": the only other vehicle, besides the subject vehicle.
    fn both(&self, all: &[Placed], at: usize) -> Option<Actor> {
        let together = || all[at..].iter().any(|placed| self.tokens[placed.first].text == "together");
        let both = match self.tokens[all[at].first].text.as_str() {
            "both" => true,
            "the" => self.tokens.get(all[at].first + 1).is_some_and(|next| next.text == "two"),
            "they" => together(),
            _ => false,
        };
        let known = &self.world.actors;
        let mut others = (1..known.len()).filter(|actor| {
            let other = &known[*actor];
            other.mentions > 0 && !other.several && other.kind.is_some_and(Kind::is_vehicle)
        });
        let (only, more) = (others.next()?, others.next());
        (both && more.is_none() && known[SUBJECT].mentions > 0).then_some(only)
    }

    /// Somebody is named: where somebody is, behind a preposition, as the object of the verb before, or as who a clause is about.
    pub(super) fn mention(&mut self, mention: Mention, placed: &Placed, carry: &mut Carry, next: Option<&Chunk>) {
        if let Some(thing) = carry.attached.take() {
            self.attach(thing, mention.actor);
        }
        if let Some(relation) = carry.relation.take() {
            self.relate(relation, Some(mention.actor), carry);
            // "was eastbound alongside cars parked there": the cars.
            (carry.be, carry.governed, carry.preposition) = (false, true, None);
            carry.last = Some(mention);
            return;
        }
        if self.is_own_trailer(&mention, carry) {
            if let Some(last) = &carry.last {
                self.world.tow(last.actor, mention.actor);
            }
            carry.preposition = None;
            return;
        }
        if let Some(preposition) = carry.preposition.take() {
            // "a coupe east of the van reversed": where the coupe was.
            let place = preposition == "of" && placed.first >= 2 && {
                let word = self.tokens[placed.first - 2].text.as_str();
                matches!(word, "north" | "south" | "east" | "west") && carry.frame.is_none()
            };
            if place && carry.subject.is_some() {
                return;
            }
            self.object_of(preposition, &mention, placed, carry);
            carry.last = Some(mention);
            (carry.governed, carry.to) = (true, false);
            return;
        }
        let open = carry.frame.filter(|&frame| {
            let frame = &self.frames[frame];
            frame.object.is_none() && transitive(frame.sense) && !carry.fresh
        });
        match open {
            Some(frame) if !carry.after_comma && !carry.inverts || self.was_inserted(frame) => {
                self.object(frame, mention, placed, carry);
            }
            _ => self.subject(mention, carry, next),
        }
    }

    /// "struck, with its front, the rear of it": the object stands behind what is inserted.
    fn was_inserted(&self, frame: usize) -> bool {
        let frame = &self.frames[frame];
        let inserted = frame.with.is_some() && word(self.tokens, frame.end + 1) == "with"
            || word(self.tokens, frame.end + 1) == "at";
        frame.is_contact() && inserted && word(self.tokens, frame.end) == ","
    }

    /// "a dolly attached to the back of the truck": what is told of it in the sentence is told of the truck.
    fn attach(&mut self, thing: Actor, vehicle: Actor) {
        let kind = |actor: Actor| self.world.actors[actor].kind;
        let drawn = kind(thing).is_some_and(|kind| kind.group() == KindGroup::Object || kind == Kind::Trailer);
        let draws = vehicle != SUBJECT && kind(vehicle).is_some_and(Kind::is_vehicle);
        if !drawn || !draws || thing == vehicle {
            return;
        }
        self.world.tow(vehicle, thing);
        for frame in self.frames.iter_mut().filter(|frame| frame.sentence == self.sentence) {
            for actor in [&mut frame.who, &mut frame.object] {
                *actor = actor.map(|actor| if actor == thing { vehicle } else { actor });
            }
        }
    }

    /// "a heavy truck with a trailer": they are one.
    fn is_own_trailer(&self, mention: &Mention, carry: &Carry) -> bool {
        let vehicle = |last: &Mention| self.world.actors[last.actor].kind.is_some_and(Kind::is_vehicle);
        carry.preposition == Some("with")
            && self.world.actors[mention.actor].kind == Some(Kind::Trailer)
            && (!carry.governed || carry.last.as_ref().is_some_and(|last| self.tokens[last.end].text == "with"))
            && carry.last.as_ref().is_some_and(|last| last.piece.is_none() && vehicle(last))
    }

    /// The object of the verb before.
    fn object(&mut self, frame: usize, mention: Mention, placed: &Placed, carry: &mut Carry) {
        let actor = mention.actor;
        let taken = &mut self.frames[frame];
        // Nobody touches itself: "the van made contact with the van that was turning".
        let itself = taken.sense == Sense::Contact && taken.who == Some(actor) && actor != SUBJECT;
        let like = if itself { self.world.other_like(actor) } else { None };
        // "A deer leaped into its path. Its front hit the deer": nobody's own front does.
        // "Its rear rubbed against the corner of the halted vehicle": called only a vehicle, it is the other one.
        let owner = mention.piece.as_ref().and_then(|piece| piece.owner.as_ref());
        let other = owner.is_some_and(|owner| owner.kind == Some(Kind::Vehicle) && owner.names.is_empty());
        let own = itself && like.is_none() && taken.with.as_ref().is_some_and(|piece| piece.its);
        if own && !other {
            taken.who = Some(SUBJECT);
        }
        let actor = like.unwrap_or(if own && other { SUBJECT } else { actor });
        taken.object = Some(actor);
        taken.on.clone_from(&mention.piece);
        taken.end = placed.end;
        // "went past the left side of the van".
        if taken.sense == Sense::Act(Act::Pass) {
            taken.side = taken.side.or(mention.piece.as_ref().and_then(Piece::side));
        }
        // "A van stood ahead of it. It began to go around the van": nobody goes around itself.
        if taken.who == Some(actor) && actor != SUBJECT && taken.sense == Sense::Act(Act::Pass) {
            taken.who = Some(SUBJECT);
            for mention in
                [&mut carry.subject, &mut carry.main].into_iter().flatten().filter(|mention| mention.actor == actor)
            {
                mention.actor = SUBJECT;
            }
        }
        // "a passenger opened the taxi's rear door": a passenger of the taxi.
        let rider = taken.person == Some(Occupant::Rider) && taken.who == Some(SUBJECT);
        if rider
            && taken.sense == Sense::Act(Act::OpenDoor)
            && taken.on.as_ref().is_some_and(|piece| piece.door && piece.owner.is_some())
        {
            taken.who = Some(actor);
        }
        let (sense, who) = (taken.sense, taken.who);
        carry.last = Some(Mention { actor, ..mention });
        (carry.governed, carry.fresh) = (false, false);
        match (sense, who) {
            (Sense::Act(Act::Follow), who) => self.follows(who, actor),
            (Sense::Push, _) => carry.pushed = true,
            (Sense::Headline, _) if actor != SUBJECT => self.world.actors[actor].announced = true,
            (Sense::Tow, Some(tower)) => {
                self.world.tow(tower, actor);
                // "a truck towing a trailer that was facing east": they are one.
                let one = self.world.actors[actor].towed_by == Some(tower);
                if let Some(last) = carry.last.as_mut().filter(|_| one) {
                    last.actor = tower;
                }
            }
            _ => {}
        }
    }

    /// "Northbound on Elm Street, a van", "In the left lane, it": which way, and in which lane. A street's direction is said of the subject
    /// vehicle alone, and who walks has no lane.
    fn led_by(&mut self, actor: Actor, carry: &mut Carry) {
        let (heading, lane) = (carry.lead_heading.take(), carry.lead_lane.take());
        let known = &mut self.world.actors[actor];
        let drives = actor == SUBJECT
            || known.kind.is_some_and(|kind| kind.is_vehicle() || kind.group() == KindGroup::Motorcycle);
        if let Some((heading, _)) = heading.filter(|(_, street)| drives && (actor == SUBJECT || !street)) {
            known.heading.get_or_insert(heading);
        }
        if let Some(lane) = lane.filter(|_| drives && !(carry.place && actor == SUBJECT)) {
            known.lane.get_or_insert(lane);
        }
    }

    /// Who a clause is about; behind a comma the main one: "As the van turned, it touched the wall".
    fn subject(&mut self, mention: Mention, carry: &mut Carry, next: Option<&Chunk>) {
        let actor = mention.actor;
        if carry.after_comma && carry.has_verb && !carry.relative && carry.joint.is_some() {
            carry.joint = None;
            carry.clause += 1;
        }
        let list = carry.has_verb && !carry.after_comma && !carry.fresh && !carry.inverts;
        if list && !matches!(next, Some(Chunk::Verb(..) | Chunk::Be | Chunk::Relation(_) | Chunk::Relative)) {
            carry.last = Some(mention);
            carry.governed = true;
            return;
        }
        carry.reduced = false;
        self.settle(actor, carry);
        if carry.main.is_none() || !carry.place && (carry.joint == Some(Joint::And) || !carry.relative) {
            carry.main = Some(mention.clone());
            carry.mains.push(actor);
        }
        if carry.also.as_ref().is_some_and(|also| carry.subject.as_ref() != Some(also) || also.actor == actor) {
            carry.also = None;
        }
        self.world.actors[actor].acted = true;
        if let Some(relation) = carry.lead.take().filter(|_| actor != SUBJECT) {
            self.note(actor, relation);
        }
        self.led_by(actor, carry);
        let inverts = std::mem::take(&mut carry.inverts);
        // "a van that it was following reversed": a clause within the other one.
        let inner = carry.relative && carry.outer.is_some() && !carry.has_verb && carry.frame.is_none();
        carry.gap = carry.subject.as_ref().filter(|_| inner).map(|subject| subject.actor);
        carry.subject = Some(mention.clone());
        carry.last = Some(mention);
        (carry.has_verb, carry.relative, carry.governed, carry.fresh) = (inverts, inner, false, false);
        (carry.be, carry.to, carry.progress) = (false, false, None);
        carry.negated = std::mem::take(&mut carry.nobody);
        (carry.frame, carry.stranger, carry.with) = (None, false, None);
    }
}
