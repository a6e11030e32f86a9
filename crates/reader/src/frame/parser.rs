//! One sentence after the other: subjects find their verbs, verbs their objects.

use super::Frame;
use super::adverbs::goes_about;
use super::row::{
    acts, another_finite, looks_somewhere, names_doer, next_is_verb, next_preposition, relation_behind, transitive,
};
use super::sided;
use crate::chunk::{Article, Chunk, Joint, Piece, Placed, Spot, chunks, is_determiner};
use crate::lexicon::{Form, Lexicon, Occupant, Progress, Relation, Sense};
use crate::token::{Sentence, Token};
use crate::world::{Actor, SUBJECT, World};
use recrash_model::account::{Act, Kind, KindGroup, LeftRight};

pub(super) struct Parser<'a> {
    pub(super) tokens: &'a [Token],
    pub(super) lexicon: &'static Lexicon,
    pub(super) world: World,
    pub(super) frames: Vec<Frame>,
    pub(super) sentence: usize,
    pub(super) looks_back: bool,
    /// Words that nobody knows may tell the contact: where no other words do.
    pub(super) guesses: bool,
}

/// What is carried from chunk to chunk.
#[derive(Default)]
pub(super) struct Carry {
    /// Who the clause is about.
    pub(super) subject: Option<Mention>,
    /// It has its verb.
    pub(super) has_verb: bool,
    /// Who the sentence is about.
    pub(super) main: Option<Mention>,
    /// Whom the sentence has been about so far.
    pub(super) mains: Vec<Actor>,
    /// Out of where who is named next comes: "From an alley, a van ..."
    pub(super) out_of: Option<Spot>,
    /// Noun named last.
    pub(super) last: Option<Mention>,
    /// The noun named last stands behind a preposition or a relation.
    pub(super) governed: bool,
    /// Frame that takes what follows.
    pub(super) frame: Option<usize>,
    /// Preposition or relation that waits for its noun.
    pub(super) preposition: Option<&'static str>,
    pub(super) relation: Option<Relation>,
    pub(super) be: bool,
    pub(super) negated: bool,
    pub(super) progress: Option<Progress>,
    pub(super) to: bool,
    pub(super) joint: Option<Joint>,
    pub(super) relative: bool,
    /// Who the clause around a relative clause is about, where it still waits for its verb.
    pub(super) outer: Option<Mention>,
    pub(super) after_comma: bool,
    /// Who began, tried or wished what the next verb tells.
    pub(super) lead_who: Option<Mention>,
    /// Number of the clause.
    pub(super) clause: u32,
    /// "and" stands between the last verb and the next.
    pub(super) row: bool,
    /// Who the relative clause before the comma was about.
    pub(super) described: Option<Mention>,
    /// The first of two subjects joined by "and".
    pub(super) also: Option<Mention>,
    /// Frames whose subject is named later: "While stopped, the van ..."
    pub(super) pending: Vec<usize>,
    /// Tokens of the last progress word.
    pub(super) began: bool,
    /// The clause begins here, and nothing but small words stood in it.
    pub(super) fresh: bool,
    pub(super) pushed: bool,
    /// A noun that nobody knows stands behind the preposition or relation: "at this time", "on Elm Street".
    pub(super) filled: bool,
    /// A clause behind "where" waits for its subject.
    pub(super) place: bool,
    /// "Neither", "no" stands before the subject.
    pub(super) nobody: bool,
    /// Where who is named next is: "From the right, a van ..."
    pub(super) lead: Option<Relation>,
    /// Where the clause names who it is about stand words that nobody knows: "a panel fell off".
    pub(super) stranger: bool,
    /// "Between" waits for the second of a pair.
    pub(super) pair: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mention {
    pub(super) actor: Actor,
    pub(super) piece: Option<Piece>,
    pub(super) person: Option<Occupant>,
    /// Token behind it.
    pub(super) end: usize,
}

impl Parser<'_> {
    pub(super) fn read(&mut self, sentence: Sentence) {
        let all = chunks(self.tokens, sentence.first, sentence.end);
        let mut carry = Carry { fresh: true, ..Carry::default() };
        for at in 0..all.len() {
            self.step(&all, at, &mut carry);
        }
        if let Some(main) = &carry.main {
            self.world.topic = main.actor;
            if !acts(self.world.actors[main.actor].kind) && main.actor != SUBJECT {
                self.world.topic = SUBJECT;
            }
        }
    }

    fn step(&mut self, all: &[Placed], at: usize, carry: &mut Carry) {
        let placed = &all[at];
        let next = all.get(at + 1).map(|placed| &placed.chunk);
        match &placed.chunk {
            // "its toolbox scratched the door": whose it is.
            Chunk::Noun(noun)
                if matches!(self.tokens[placed.first].text.as_str(), "its" | "their" | "his" | "her")
                    && all[at + 1..]
                        .iter()
                        .find(|placed| !matches!(placed.chunk, Chunk::Word | Chunk::Piece(_)))
                        .is_some_and(|placed| matches!(placed.chunk, Chunk::Verb(Sense::Contact, _)))
                    && noun.kind.is_some_and(|kind| kind.group() == KindGroup::Object && kind != Kind::Cargo) =>
            {
                let actor = self.its(carry);
                self.mention(Mention { actor, piece: None, person: None, end: placed.end }, placed, carry, next);
            }
            Chunk::Noun(noun) => {
                let hint = relation_behind(all, at, &self.world);
                let actor = match self.apposed(noun, all, at, carry) {
                    Some(actor) => {
                        self.world.describe(actor, noun, (placed.first, placed.end));
                        self.attribute(noun, actor, placed, carry);
                        (carry.governed, carry.after_comma) = (false, false);
                        return;
                    }
                    None => self.world.resolve(noun, (placed.first, placed.end), hint),
                };
                // "A van left its stall as the vehicle was going by": not the van.
                let plain = noun.kind == Some(Kind::Vehicle)
                    && noun.article == Article::Definite
                    && noun.adjectives.is_empty()
                    && noun.names.is_empty()
                    && noun.number.is_none()
                    && !noun.several
                    && noun.occupant.is_none();
                let of_main = carry.main.as_ref().is_some_and(|main| main.actor == actor && main.actor != SUBJECT);
                let other =
                    plain && of_main && carry.fresh && carry.joint == Some(Joint::While) && self.world.topic == SUBJECT;
                let actor = if other && matches!(next, Some(Chunk::Be | Chunk::Verb(..))) { SUBJECT } else { actor };
                // "one standing passenger": the vehicle does not stand.
                let described = if noun.occupant.is_some() { noun.owner.as_deref() } else { Some(noun) };
                if let Some(described) = described {
                    self.attribute(described, actor, placed, carry);
                }
                // "in a queue of westbound traffic": the direction is also that of who stands in it.
                if let (Some(compass), true, Some("of" | "in" | "behind")) =
                    (noun.compass, noun.several, carry.preposition)
                {
                    self.compass(compass, placed, carry);
                    carry.preposition = Some("of");
                }
                // "At this time a van ...": the van is not behind "at".
                if carry.filled && noun.article != Article::None {
                    (carry.preposition, carry.relation) = (None, None);
                    // "It opened its door at the moment a van was driving by": the van begins a clause.
                    if matches!(next, Some(Chunk::Be)) {
                        carry.frame = None;
                    }
                }
                let person = noun.occupant.map(|(who, _)| who);
                self.mention(Mention { actor, piece: None, person, end: placed.end }, placed, carry, next);
            }
            Chunk::Piece(piece) => {
                if carry.filled {
                    (carry.preposition, carry.relation) = (None, None);
                }
                let actor = match &piece.owner {
                    Some(owner) => {
                        let actor = self.world.resolve(owner, (placed.first, placed.end), None);
                        let actor = self.as_a_result(actor, placed.first);
                        self.attribute(owner, actor, placed, carry);
                        Some(actor)
                    }
                    None if at > 0 && self.tokens[all[at - 1].first].text == "whose" && carry.last.is_some() => {
                        carry.frame = None;
                        carry.last.as_ref().map(|last| last.actor)
                    }
                    None if piece.its => Some(self.its(carry)),
                    // "The edge of the open door touched": of whom it was opened.
                    None if piece.door && carry.fresh && self.door_of().is_some() => self.door_of(),
                    // "It set off, and the rear tire touched": of whom the sentence is about.
                    None if carry.fresh && matches!(next, Some(Chunk::Verb(..) | Chunk::Be)) => Some(self.its(carry)),
                    None => None,
                };
                match actor {
                    Some(actor) => {
                        self.mention(
                            Mention { actor, piece: Some(piece.clone()), person: None, end: placed.end },
                            placed,
                            carry,
                            next,
                        );
                    }
                    None => self.loose_piece(piece, placed, carry),
                }
            }
            // "It is at this time that ...": nobody.
            Chunk::Pronoun
                if matches!(next, Some(Chunk::Be))
                    && matches!(
                        all.get(at + 2).map(|placed| &placed.chunk),
                        Some(Chunk::Preposition("at" | "within") | Chunk::Relative)
                    ) => {}
            Chunk::Pronoun => {
                let actor = match self.waits_struck(all, at, carry) {
                    Some(struck) => struck,
                    None => self.not_itself(self.its(carry), carry),
                };
                self.mention(Mention { actor, piece: None, person: None, end: placed.end }, placed, carry, next);
            }
            Chunk::Relative => {
                // "at which time the operator ...": the operator is not behind "at".
                (carry.preposition, carry.relation) = (None, None);
                // "the bracket that holds the sensor": of a thing without a name.
                if self.of_a_word(all, at) {
                    (carry.outer, carry.subject) = (carry.subject.take(), None);
                    (carry.frame, carry.has_verb, carry.stranger) = (None, false, true);
                    carry.relative = true;
                    return;
                }
                if let Some(last) = carry.last.clone() {
                    if !carry.relative {
                        carry.outer = carry.subject.clone().filter(|_| !carry.has_verb);
                    }
                    carry.subject = Some(last);
                    carry.frame = None;
                    carry.has_verb = false;
                    carry.relative = true;
                    carry.fresh = false;
                    carry.governed = false;
                    (carry.be, carry.to, carry.progress) = (false, false, None);
                }
            }
            Chunk::Verb(sense, form) => self.verb(*sense, *form, all, at, carry),
            Chunk::Be => carry.be = true,
            Chunk::Not => {
                carry.negated = true;
                // "Neither car made contact": said before who it is.
                let word = self.tokens[placed.first].text.as_str();
                carry.nobody |=
                    matches!(word, "neither" | "nor") || carry.fresh && matches!(word, "no" | "nothing" | "nobody");
            }
            Chunk::Relation(relation) => self.relation(*relation, placed, carry, next),
            Chunk::Compass(compass) => self.compass(*compass, placed, carry),
            // "waiting on the AV's right".
            Chunk::Side(side) if self.side_of_subject(all, at) => {
                let relation = if *side == LeftRight::Left { Relation::Left } else { Relation::Right };
                self.relate(relation, Some(SUBJECT), carry);
            }
            Chunk::Side(side) => self.side(*side, carry),
            Chunk::Lane(lane) => self.lane(*lane, placed, carry),
            Chunk::Spot(spot) => self.spot(*spot, carry),
            Chunk::Preposition(word) => {
                // "out of" goes out.
                let out = *word == "of" && carry.preposition == Some("out");
                carry.preposition = if out { Some("out") } else { Some(word) };
                carry.relation = None;
                if *word == "to" {
                    carry.to = true;
                }
            }
            // "the corner of Oak Street and Elm Street": no clause begins.
            Chunk::Joint(Joint::And) if self.names_on_both_sides(all, at) => {}
            Chunk::Joint(joint) => self.joint(*joint, carry, &all[at + 1..]),
            Chunk::Comma => {
                self.leave_place(carry);
                carry.after_comma = true;
                // "The van, unable to stop, struck it": the comma ends what did not happen.
                carry.negated &= carry.nobody || !carry.has_verb && carry.frame.is_none() && carry.fresh;
                (carry.preposition, carry.relation, carry.be, carry.to) = (None, None, false, false);
                carry.progress = None;
                // "It waited and, although a message came, opened its door": who the sentence is about goes on.
                let goes_on = matches!(next, Some(Chunk::Verb(_, Form::Past | Form::Present)));
                if goes_on && carry.stranger && carry.joint.is_some() && carry.main.is_some() {
                    (carry.stranger, carry.row, carry.has_verb) = (false, true, true);
                    (carry.subject, carry.frame) = (carry.main.clone(), None);
                }
                carry.described = carry.subject.clone().filter(|_| carry.relative);
                if carry.relative && carry.has_verb {
                    // A relative clause ends at its comma.
                    carry.relative = false;
                    carry.subject = carry.main.clone();
                    carry.has_verb = carry.pending.is_empty() && carry.main.is_some();
                }
                return;
            }
            Chunk::Word if self.touches_by_parts(&self.tokens[placed.first].text, all, at, carry) => {
                self.verb(Sense::Contact, Form::Past, all, at, carry);
            }
            Chunk::Word if self.guesses && self.may_touch(all, at, carry) => {
                self.verb(Sense::Contact, Form::Past, all, at, carry);
            }
            // "The AV misjudged a van's speed and turned": what it did to the van.
            Chunk::Word if self.does_something(all, at, carry) => self.verb(Sense::Other, Form::Past, all, at, carry),
            Chunk::Word => {
                let word = self.tokens[placed.first].text.as_str();
                // "time to turn" is no turn; "at which time it turned" is one.
                let waits_for = !matches!(word, "time" | "space" | "room" | "set" | "order" | "ready" | "route")
                    || matches!(next, Some(Chunk::Preposition("to" | "for")));
                if let Some(progress) = self.lexicon.progress(word).filter(|_| waits_for) {
                    self.progress(progress, carry);
                }
                // "the junction where Elm Street merges with Oak Street": nobody of the story does that.
                if word == "where" {
                    (carry.subject, carry.frame, carry.has_verb) = (None, None, false);
                    (carry.place, carry.fresh) = (true, true);
                }
                // "The Fusion" of "a red Ford Fusion".
                if self.tokens[placed.first].capital
                    && placed.first > 0
                    && self.tokens[placed.first - 1].text == "the"
                    && let Some(actor) = self.world.by_name(word)
                {
                    let mention = Mention { actor, piece: None, person: None, end: placed.end };
                    self.mention(mention, placed, carry, next);
                    (carry.after_comma, carry.filled) = (false, false);
                    return;
                }
                // "a child chasing a ball": who chases goes on.
                let beside_noun = at > 0 && matches!(all[at - 1].chunk, Chunk::Noun(_));
                if word.ends_with("ing") && beside_noun && matches!(next, Some(Chunk::Noun(_))) {
                    carry.preposition = Some("of");
                    return;
                }
                let waits = carry.preposition.is_some() || carry.relation.is_some();
                // "at about 6 mph its bumper touched".
                carry.filled |= waits
                    && matches!(
                        word,
                        "mph" | "miles" | "feet" | "seconds" | "a.m" | "p.m" | "am" | "pm" | "mode" | "time"
                    );
                let clause = carry.fresh || carry.after_comma && carry.has_verb && carry.joint.is_some();
                let begins =
                    clause && !waits && matches!(word, "a" | "an" | "the" | "several" | "some" | "two" | "one");
                if begins && matches!(next, Some(Chunk::Word)) {
                    carry.stranger = true;
                }
                carry.filled |= waits && (is_determiner(word) || self.tokens[placed.first].capital);
                return;
            }
        }
        (carry.after_comma, carry.filled) = (false, false);
    }

    /// Behind a clause that tells of a place the sentence goes on with whom it is about.
    pub(super) fn leave_place(&self, carry: &mut Carry) {
        if std::mem::take(&mut carry.place) && carry.subject.is_none() {
            carry.subject = carry.main.clone();
            carry.has_verb = carry.main.is_some();
        }
    }

    fn progress(&mut self, progress: Progress, carry: &mut Carry) {
        carry.progress = Some(progress);
        carry.began = true;
    }

    fn mention(&mut self, mention: Mention, placed: &Placed, carry: &mut Carry, next: Option<&Chunk>) {
        let actor = mention.actor;
        let governed = carry.preposition.is_some() || carry.relation.is_some();
        if let Some(relation) = carry.relation.take() {
            self.relate(relation, Some(actor), carry);
            // "was eastbound alongside cars parked there": the cars.
            carry.be = false;
            carry.last = Some(mention);
            carry.governed = true;
            carry.preposition = None;
            return;
        }
        // "a heavy truck with a trailer": they are one.
        if let (Some("with"), Some(last), Some(Kind::Trailer)) =
            (carry.preposition, &carry.last, self.world.actors[actor].kind)
            && last.piece.is_none()
            && !carry.governed
            && self.world.actors[last.actor].kind.is_some_and(Kind::is_vehicle)
        {
            self.world.tow(last.actor, actor);
            carry.preposition = None;
            return;
        }
        if let Some(preposition) = carry.preposition.take() {
            self.object_of(preposition, &mention, placed, carry);
            carry.last = Some(mention);
            carry.governed = true;
            carry.to = false;
            return;
        }
        let has_object =
            |frames: &[Frame], frame: usize| frames[frame].object.is_some() || !transitive(frames[frame].sense);
        let open = carry.frame.filter(|&frame| !has_object(&self.frames, frame) && !carry.fresh);
        match open {
            // The object of the verb before.
            Some(frame) if !carry.after_comma => {
                // Nobody touches itself: "the van made contact with the van that was turning".
                let itself = self.frames[frame].sense == Sense::Contact
                    && self.frames[frame].who == Some(actor)
                    && actor != SUBJECT;
                let actor = if itself { self.world.like(actor).unwrap_or(actor) } else { actor };
                let mention = Mention { actor, ..mention };
                let taken = &mut self.frames[frame];
                taken.object = Some(actor);
                taken.on.clone_from(&mention.piece);
                taken.end = placed.end;
                carry.last = Some(mention);
                carry.governed = false;
                match taken.sense {
                    Sense::Act(Act::Follow) => {
                        let who = taken.who;
                        self.follows(who, actor);
                    }
                    Sense::Push => carry.pushed = true,
                    Sense::Headline if actor != SUBJECT => self.world.actors[actor].announced = true,
                    Sense::Tow => {
                        if let Some(tower) = taken.who {
                            self.world.tow(tower, actor);
                            // "a truck towing a trailer that was facing east": they are one.
                            if let Some(last) =
                                carry.last.as_mut().filter(|_| self.world.actors[actor].towed_by == Some(tower))
                            {
                                last.actor = tower;
                            }
                        }
                    }
                    _ => {}
                }
            }
            _ => {
                // A new subject; behind a comma that of the main clause: "As the van turned, it touched the wall".
                if carry.after_comma && carry.has_verb && !carry.relative && carry.joint.is_some() {
                    carry.joint = None;
                    carry.clause += 1;
                }
                let list = carry.has_verb && !carry.after_comma && !carry.fresh && !governed;
                if list && !matches!(next, Some(Chunk::Verb(..) | Chunk::Be | Chunk::Relation(_) | Chunk::Relative)) {
                    carry.last = Some(mention);
                    carry.governed = true;
                    return;
                }
                self.settle(actor, carry);
                if carry.main.is_none() || carry.joint == Some(Joint::And) || !carry.relative {
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
                carry.subject = Some(mention.clone());
                carry.last = Some(mention);
                carry.has_verb = false;
                carry.relative = false;
                carry.governed = false;
                let nobody = std::mem::take(&mut carry.nobody);
                carry.stranger = false;
                (carry.be, carry.to, carry.progress, carry.negated) = (false, false, None, nobody);
                carry.frame = None;
            }
        }
        carry.fresh = false;
    }

    fn verb(&mut self, sense: Sense, form: Form, all: &[Placed], at: usize, carry: &mut Carry) {
        if carry.place && carry.subject.is_none() {
            return;
        }
        let placed = &all[at];
        let word = self.tokens[placed.first].text.clone();
        // "traffic was backed up" stands.
        let before = at.checked_sub(1).map(|at| &all[at]);
        let remains = before.is_some_and(|before| matches!(before.chunk, Chunk::Verb(Sense::Act(Act::Hold), _)));
        let away =
            self.tokens.get(placed.end).is_some_and(|next| matches!(next.text.as_str(), "out" | "into" | "from"))
                || placed.end > placed.first + 1 && self.tokens[placed.end - 1].text != "up";
        let backed = sense == Sense::Act(Act::Reverse) && form == Form::Past && (carry.be || remains) && !away;
        let sense = if backed && word == "backed" { Sense::Other } else { sense };
        // "holding a phone", "held on to the rail".
        let carried = word.starts_with("hold") || word == "held";
        let on = matches!(
            all.get(at + 1).map(|placed| &placed.chunk),
            Some(Chunk::Word | Chunk::Preposition("on") | Chunk::Piece(_) | Chunk::Noun(_))
        );
        // "remained consistent", "remained in autonomous mode": nobody stands.
        let kept = word.starts_with("remain") && placed.end == placed.first + 1 && {
            let next = |at: usize| self.tokens.get(placed.end + at).map_or("", |token| token.text.as_str());
            matches!(
                next(0),
                "consistent"
                    | "constant"
                    | "engaged"
                    | "unchanged"
                    | "upright"
                    | "active"
                    | "green"
                    | "red"
                    | "steady"
                    | "the"
            ) || next(0) == "in" && (1..4).any(|at| matches!(next(at), "mode" | "control" | "motion"))
        };
        let sense = if kept { Sense::Other } else { sense };
        // "a bicycle ridden by a courier" passes nobody.
        let ridden = sense == Sense::Act(Act::Pass) && matches!(word.as_str(), "ridden" | "driven");
        let next = all.get(at + 1).map(|placed| &placed.chunk);
        let sense = if ridden { Sense::Other } else { sense };
        // "The wind blew a cart into it".
        let blows = sense == Sense::Act(Act::Fall) && matches!(word.as_str(), "blew" | "blow" | "blowing");
        let sense = if blows && matches!(next, Some(Chunk::Noun(_))) { Sense::Push } else { sense };
        // "had almost come to rest".
        let nearly = placed.first > 0 && matches!(self.tokens[placed.first - 1].text.as_str(), "almost" | "nearly");
        let sense = if nearly && sense == Sense::Act(Act::Stop) { Sense::Act(Act::Slow) } else { sense };
        let sense = if self.drives_another(sense, form, &word, all, at, carry) { Sense::Push } else { sense };
        let sense = if carried && on && placed.end == placed.first + 1 { Sense::Other } else { sense };
        // A finite verb behind a finished relative clause is of the clause around it.
        let finite = (matches!(form, Form::Past | Form::Present)) || (form == Form::Ing && carry.be);
        if carry.relative
            && carry.has_verb
            && finite
            && !carry.be
            && form != Form::Ing
            && !carry.after_comma
            && !matches!(all.get(at.wrapping_sub(1)).map(|placed| &placed.chunk), Some(Chunk::Joint(_)))
            && let Some(outer) = carry.outer.take()
        {
            carry.subject = Some(outer);
            (carry.has_verb, carry.relative) = (false, false);
        }
        // "began to", "attempted to", "was waiting to": how far the next verb came.
        let own_progress = carry.progress;
        let mut leads = false;
        if placed.end == placed.first + 1
            && let Some(progress) = self.lexicon.progress(&word)
            && (next_is_verb(all, at) || matches!(sense, Sense::Other) && !looks_somewhere(all, at))
        {
            // "before proceeding to turn": not done.
            let before = carry.joint == Some(Joint::Before) && carry.fresh && form == Form::Ing;
            self.progress(if before { Progress::Wished } else { progress }, carry);
            leads = true;
            let swallowed = matches!(sense, Sense::Other | Sense::Act(Act::Follow)) && next_is_verb(all, at);
            if sense == Sense::Other {
                carry.to = false;
            }
            if swallowed {
                carry.began = false;
                carry.lead_who =
                    self.who_of(Sense::Act(Act::Follow), form, placed, carry, false, another_finite(all, at));
                carry.began = true;
                carry.has_verb |= form != Form::Ing || carry.be;
                return;
            }
        }
        // "The van slid back as the light changed, tapping its bumper": who the sentence is about.
        let goes_back = carry.after_comma && form == Form::Ing && !carry.be && carry.stranger && carry.joint.is_some();
        if goes_back && matches!(sense, Sense::Contact | Sense::Push | Sense::RearEnd) && carry.main.is_some() {
            (carry.subject, carry.stranger, carry.frame) = (carry.main.clone(), false, None);
        }
        let both = self.of_both(sense, all, at, carry);
        let sense = if both { Sense::ContactMade } else { sense };
        let to = std::mem::take(&mut carry.to) && form == Form::Base;
        let purpose = to && !carry.began;
        let finite_behind = another_finite(all, at);
        let who = self.who_of(sense, form, placed, carry, purpose, finite_behind).filter(|_| !carry.stranger && !both);
        let mut frame = self.frame(who.as_ref().map(|mention| mention.actor), sense, form, placed, carry);
        if leads {
            frame.progress = own_progress.unwrap_or(Progress::Real);
        }
        frame.person = who.as_ref().and_then(|mention| mention.person);
        if sense == Sense::TakeOver && frame.person == Some(Occupant::Driver) {
            frame.who = Some(SUBJECT);
            self.world.own_driver = true;
        }
        frame.described |= form == Form::Ing && !carry.be && who.is_some() && who != carry.subject;
        frame.with = who.as_ref().and_then(|mention| mention.piece.clone());
        // "a van parked on the left began to move": the first verb describes, the second one tells.
        // "double-parked" is one word as well.
        let bare = placed.end == placed.first + 1 || sense == Sense::Act(Act::Park) && word != "pulled";
        let describes =
            matches!(sense, Sense::Act(Act::Stop | Act::Park | Act::Hold) | Sense::Parked | Sense::Face | Sense::Tow);
        let described = bare
            && form == Form::Past
            && !carry.be
            && describes
            && !carry.has_verb
            && carry.last_is(carry.subject.as_ref())
            && another_finite(all, at);
        let be = std::mem::take(&mut carry.be);
        if be && form == Form::Past && matches!(sense, Sense::Act(Act::Stop | Act::Park | Act::Hold)) {
            frame.state = true;
            frame.sense = if sense == Sense::Act(Act::Park) { Sense::Parked } else { Sense::Act(Act::Hold) };
        }
        if described && matches!(sense, Sense::Act(Act::Stop | Act::Park)) {
            frame.state = true;
            frame.sense = if sense == Sense::Act(Act::Park) { Sense::Parked } else { Sense::Act(Act::Hold) };
        }
        let participle = bare
            && !be
            && form == Form::Past
            && (carry.governed || carry.joint.is_some_and(|joint| joint != Joint::And))
            && who.is_some()
            && carry.last_is(who.as_ref());
        // "approached a truck stopped in the road": it stood there.
        let of_object = bare && !be && form == Form::Past && carry.has_verb && who.is_some() && who != carry.subject;
        let stood = participle && (carry.fresh || carry.governed) || of_object && carry.last_is(who.as_ref());
        if stood && matches!(sense, Sense::Act(Act::Stop | Act::Park)) {
            frame.state = true;
            frame.sense = if sense == Sense::Act(Act::Park) { Sense::Parked } else { Sense::Act(Act::Hold) };
        }
        if bare
            && carry.fresh
            && form == Form::Past
            && !be
            && matches!(sense, Sense::Act(Act::Stop | Act::Park))
            && carry.joint == Some(Joint::While)
        {
            frame.state = true;
            frame.sense = if sense == Sense::Act(Act::Park) { Sense::Parked } else { Sense::Act(Act::Hold) };
        }
        if purpose
            && !matches!(sense, Sense::Yield | Sense::Act(Act::Hold | Act::Stop | Act::Slow))
            && frame.progress == Progress::Real
        {
            // "moved forward to pass it": begun. "slowed to turn": not.
            let going = carry
                .frame
                .map(|frame| &self.frames[frame])
                .is_some_and(|before| before.who == frame.who && before.happened() && goes_about(before.act()));
            let enters = carry.frame.map(|frame| &self.frames[frame]).is_some_and(|before| {
                let words = &self.tokens[before.first..placed.first];
                before.who == frame.who
                    && before.happened()
                    && before.act() == Some(Act::Enter)
                    && words.iter().any(|token| matches!(token.text.as_str(), "intersection" | "junction"))
            });
            frame.progress =
                match (carry.pushed, going && matches!(frame.act(), Some(Act::Pass | Act::Park | Act::LaneChange))) {
                    (true, _) => Progress::Real,
                    (_, true) => Progress::Tried,
                    // "entered the intersection to make a left turn": so it did.
                    _ if enters && frame.act() == Some(Act::Turn) => Progress::Real,
                    _ => Progress::Wished,
                };
        }
        if carry.joint == Some(Joint::Before) && carry.fresh && frame.progress == Progress::Real && form == Form::Ing {
            frame.progress = Progress::Wished;
        }
        frame.passive = be && form == Form::Past && matches!(next_preposition(all, at), Some("by"));
        let done_to = matches!(sense, Sense::Contact | Sense::RearEnd | Sense::ReverseContact | Sense::Push);
        if be && form == Form::Past && done_to {
            // "was struck", "was shoved back", with or without a "by" behind it.
            frame.object = frame.who.take();
            frame.on = frame.with.take();
            frame.passive = true;
        }
        // "Struck by a coupe, a parked van ...": who is named next.
        let leading = carry.fresh && !be && carry.subject.is_none() && form == Form::Past && done_to;
        let leading = leading && (matches!(next, Some(Chunk::Preposition("by"))) || sense == Sense::RearEnd);
        frame.passive |= leading;
        let of_subject = frame.object == Some(SUBJECT) || leading && frame.object.is_none();
        if frame.passive && of_subject && frame.who.is_none() && !names_doer(all, at) {
            frame.who = self.struck_by(sense, &word);
        }
        if matches!(sense, Sense::Push) && carry.pushed {
            carry.pushed = false;
        }
        if frame.side.is_none() && frame.act().is_some_and(sided) {
            frame.side = self.side_in(placed);
        }
        if frame.act() == Some(Act::PullOut) {
            frame.out_of = self.spot_in(placed);
        }
        let comes = matches!(
            frame.act(),
            Some(Act::PullOut | Act::Enter | Act::Follow | Act::Reverse | Act::SetOff | Act::Drift | Act::Turn)
        );
        if comes && frame.out_of.is_none() && frame.who.is_some_and(|who| who != SUBJECT) {
            frame.out_of = carry.out_of.take();
        }
        let unnamed = frame.who.is_none()
            && !frame.passive
            && !carry.stranger
            && !matches!(sense, Sense::ContactMade | Sense::LightGreen | Sense::LightRed | Sense::LightYellow);
        if let (Some(also), false) = (&carry.also, frame.passive) {
            let mut twin = frame.clone();
            (twin.who, twin.with) = (Some(also.actor), also.piece.clone());
            self.frames.push(twin);
        }
        if let (Some(who), Some(Act::Hold | Act::Park | Act::Stop)) = (frame.who, frame.act()) {
            self.world.actors[who].parked = true;
        }
        self.frames.push(frame);
        let number = self.frames.len() - 1;
        if unnamed || leading {
            carry.pending.push(number);
        }
        carry.frame = Some(number);
        carry.has_verb |= (finite && !described) || carry.be || unnamed || carry.stranger;
        carry.fresh = false;
        carry.governed = false;
        carry.preposition = None;
        carry.relation = None;
        let row = carry.progress.is_some() && matches!(next, Some(Chunk::Joint(Joint::And)));
        if !(leads || row) {
            carry.progress = None;
        }
        carry.began = leads;
        carry.lead_who = None;
        if sense == Sense::ContactMade && self.tokens[placed.end - 1].text == "between" {
            carry.preposition = Some("between");
        }
        // "fell from a truck": the truck is behind "from".
        let last = self.tokens[placed.end - 1].text.as_str();
        if matches!(sense, Sense::Act(Act::Fall | Act::Roll | Act::Enter)) && placed.end > placed.first + 1 {
            carry.preposition =
                ["from", "off", "onto", "into", "over", "between", "behind"].into_iter().find(|known| *known == last);
        }
        // "contact by a cyclist was made".
        if sense == Sense::ContactMade && self.tokens[placed.end - 1].text == "by" {
            let frame = &mut self.frames[number];
            (frame.form, frame.who, frame.with) = (Form::Past, None, None);
            carry.preposition = Some("by");
        }
        carry.row = false;
        carry.negated = false;
    }
}

impl Carry {
    pub(super) fn last_is(&self, who: Option<&Mention>) -> bool {
        self.last.as_ref() == who
    }

    /// Whether the noun named last is the object of this frame, and not who does it.
    pub(super) fn governed_object(&self, frame: &Frame) -> bool {
        let Some(last) = &self.last else { return false };
        frame.object == Some(last.actor)
            && frame.who != Some(last.actor)
            && !matches!(
                frame.sense,
                Sense::Contact
                    | Sense::ContactMade
                    | Sense::Approach
                    | Sense::RearEnd
                    | Sense::Act(Act::Pass | Act::Follow | Act::Cross)
            )
    }
}
