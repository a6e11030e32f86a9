//! One sentence after the other: subjects find their verbs, verbs their objects.

use super::Frame;
use crate::chunk::{Chunk, Joint, Piece, Placed, Spot, chunks};
use crate::lexicon::{Form, Lexicon, Occupant, Progress, Relation, Sense};
use crate::token::{Sentence, Token};
use crate::world::{Actor, SUBJECT, World};
use recrash_model::account::{Act, Compass, Kind, KindGroup, LaneWord, LeftRight};

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

/// "was operating on public roads in autonomous mode": so near stands what drives it. [tokens]
const MODE_WITHIN: usize = 8;

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
    /// A form of "be" waits for its verb.
    pub(super) be: bool,
    /// What the next verb tells did not happen.
    pub(super) negated: bool,
    /// How far what the next verb tells came.
    pub(super) progress: Option<Progress>,
    /// "to" stands before the next verb.
    pub(super) to: bool,
    /// The clause begins with this.
    pub(super) joint: Option<Joint>,
    /// The clause is a relative one: "a van that was behind it".
    pub(super) relative: bool,
    /// Who the clause around a relative clause is about, where it still waits for its verb.
    pub(super) outer: Option<Mention>,
    /// A comma stands right before.
    pub(super) after_comma: bool,
    /// Who began, tried or wished what the next verb tells.
    pub(super) lead_who: Option<Mention>,
    /// Whom the last relative clause was about: "to which it yielded and which then stopped".
    pub(super) antecedent: Option<Mention>,
    /// Whom the relative clause is about, where it has a subject of its own: "a van that it was following".
    pub(super) gap: Option<Actor>,
    /// Who the clause is about was called "struck by a van", and its verb is still to come.
    pub(super) reduced: bool,
    /// What the next verb tells is told of a noun in passing: "struck by a van attempting to pass".
    pub(super) lead_describes: bool,
    /// Number of the clause.
    pub(super) clause: u32,
    /// Who goes on behind a clause between commas: "It stopped and, after a bus had gone by, turned".
    pub(super) resumes: Option<Mention>,
    /// "and" stands between the last verb and the next.
    pub(super) row: bool,
    /// Who the relative clause before the comma was about.
    pub(super) described: Option<Mention>,
    /// The first of two subjects joined by "and".
    pub(super) also: Option<Mention>,
    /// Frames whose subject is named later: "While stopped, the van ..."
    pub(super) pending: Vec<usize>,
    /// The verb before only says how far the next one came.
    pub(super) began: bool,
    /// The clause begins here, and nothing but small words stood in it.
    pub(super) fresh: bool,
    /// Somebody is pushed by the verb before.
    pub(super) pushed: bool,
    /// A noun that nobody knows stands behind the preposition or relation: "at this time", "on Elm Street".
    pub(super) filled: bool,
    /// A clause behind "where" waits for its subject.
    pub(super) place: bool,
    /// "Neither", "no" stands before the subject.
    pub(super) nobody: bool,
    /// Where who is named next is: "From the right, a van ..."
    pub(super) lead: Option<Relation>,
    /// Which way who is named next goes: "Northbound on Elm Street, a van ..." Whether the direction is a street's.
    pub(super) lead_heading: Option<((Compass, usize, usize), bool)>,
    /// In which lane who is named next is: "In the left lane, a van ..."
    pub(super) lead_lane: Option<(LaneWord, usize, usize)>,
    /// Where the clause names who it is about stand words that nobody knows: "a panel fell off".
    pub(super) stranger: bool,
    /// "Between" waits for the second of a pair.
    pub(super) pair: bool,
    /// The verb stands before its subject: "Behind it stood a van", "Parked at the curb was a van".
    pub(super) inverts: bool,
    /// The part with which the next verb is done.
    pub(super) with: Option<Piece>,
    /// A thing that is attached to who is named next.
    pub(super) attached: Option<Actor>,
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
        let begun = self.frames.len();
        self.world.first = sentence.first;
        for at in 0..all.len() {
            self.step(&all, at, &mut carry);
        }
        self.share(begun);
        self.did_likewise(&all, begun);
        self.announce_fall(begun);
        self.announce_touch(begun);
        if let Some(main) = &carry.main {
            self.world.topic = main.actor;
            if !self.world.actors[main.actor].acts() && main.actor != SUBJECT {
                self.world.topic = SUBJECT;
            }
        }
    }

    /// "A ball and a dog came from the left": what stands behind a verb of two is told of both.
    fn share(&mut self, begun: usize) {
        for at in begun + 1..self.frames.len() {
            let (before, after) = self.frames.split_at_mut(at);
            let (one, other) = (&mut before[at - 1], &after[0]);
            let twins =
                one.first == other.first && one.sense == other.sense && one.who != other.who && !one.is_contact();
            let Some(who) = one.who.filter(|_| twins && one.relations.is_empty()) else { continue };
            one.relations.clone_from(&other.relations);
            (one.side, one.out_of, one.end) = (one.side.or(other.side), one.out_of.or(other.out_of), other.end);
            let places: Vec<Relation> =
                other.relations.iter().filter(|(_, to)| to.is_none()).map(|(place, _)| *place).collect();
            if who != SUBJECT {
                places.into_iter().for_each(|place| self.world.actors[who].place(place, self.sentence));
            }
        }
    }

    /// "It was driving north when a cyclist fell while passing it": the first sentence tells what came of it, and the story brings the cyclist
    /// on anew.
    fn announce_fall(&mut self, begun: usize) {
        let first = self.frames.first().is_none_or(|frame| frame.sentence == self.sentence);
        let rides = |kind: Kind| matches!(kind.group(), KindGroup::Cyclist | KindGroup::Motorcycle | KindGroup::OnFoot);
        let frames = &self.frames[begun.min(self.frames.len())..];
        let falls = frames.iter().find(|frame| frame.act() == Some(Act::Fall) && frame.happened());
        let Some(who) = falls.and_then(|frame| frame.who).filter(|who| first && *who != SUBJECT) else { return };
        let meets =
            frames.iter().any(|frame| frame.who == Some(who) && frame.object == Some(SUBJECT) && !frame.is_contact());
        let known = &mut self.world.actors[who];
        known.announced |= meets && !known.several && known.mentions == 1 && known.kind.is_some_and(rides);
    }

    /// "A van struck it on Elm Street. It had stopped for a van that was backing up": the first sentence tells the touch and nothing that led
    /// to it, and the story brings the other one on anew.
    fn announce_touch(&mut self, begun: usize) {
        let begun = begun.min(self.frames.len());
        // "It was operating in autonomous mode": no story yet.
        let tells = |frame: &Frame| {
            let plain = frame.act() == Some(Act::Follow) && frame.heading.is_none() && frame.lane.is_none();
            let of_mode = |token: &Token| matches!(token.text.as_str(), "mode" | "autonomously" | "itself");
            let idle = plain && self.tokens[frame.end..].iter().take(MODE_WITHIN).any(of_mode);
            frame.act().is_some() && frame.happened() && !idle
        };
        if self.frames[..begun].iter().any(tells) {
            return;
        }
        let frames = &self.frames[begun..];
        let crash = |frame: &&Frame| frame.is_contact() || frame.sense == Sense::Headline && frame.object.is_none();
        let Some(touch) = frames.iter().find(crash) else { return };
        // "It and a van collided": a frame of each.
        let twin = frames.iter().find(|frame| frame.first == touch.first && frame.who != touch.who);
        let (Some(who), Some(object)) = (touch.who, touch.object.or(twin.and_then(|twin| twin.who))) else { return };
        let other = match (who, object) {
            (SUBJECT, other) | (other, SUBJECT) if other != SUBJECT => other,
            _ => return,
        };
        let leads = |frame: &Frame| {
            let told = frame.act().is_some_and(|act| act != Act::Hold) && frame.happened();
            let describes = frame.form == Form::Ing && frame.joint.is_none() && frame.who == Some(other);
            told && !(frame.aside || frame.described || describes || frame.is_contact())
        };
        let rides = |kind: Kind| {
            kind.is_vehicle()
                || matches!(kind.group(), KindGroup::Cyclist | KindGroup::Motorcycle)
                || kind == Kind::Gate
        };
        let told = frames.iter().any(leads);
        let rear_ends = touch.sense == Sense::RearEnd && who == other;
        let known = &mut self.world.actors[other];
        if !(told || known.several || known.another) && known.mentions == 1 && known.kind.is_some_and(rides) {
            known.announced = true;
            if rear_ends {
                known.place(Relation::Behind, self.sentence);
            }
        }
    }

    /// Reads one chunk.
    fn step(&mut self, all: &[Placed], at: usize, carry: &mut Carry) {
        let placed = &all[at];
        let next = all.get(at + 1).map(|placed| &placed.chunk);
        // Whether the comma and the filled preposition before it still stand before the next one.
        let stands = match &placed.chunk {
            Chunk::Noun(noun) => self.noun(noun, all, at, carry),
            Chunk::Piece(piece) => self.piece(piece, all, at, carry),
            Chunk::Pronoun => self.pronoun(all, at, carry),
            Chunk::Relative => self.relative(all, at, carry),
            Chunk::Comma => {
                self.leave_place(carry, self.goes_on(all, at));
                self.comma(placed.first, self.behind_small_words(all, at), carry)
            }
            Chunk::Word => self.word(all, at, carry),
            other => {
                match other {
                    Chunk::Verb(sense, form) => self.verb(*sense, *form, all, at, carry),
                    Chunk::Be if self.brings_on(all, at, carry) => {}
                    Chunk::Be if self.inverts(all, at) => carry.inverts = true,
                    Chunk::Be => carry.be = true,
                    Chunk::Not => self.not(placed, carry),
                    Chunk::Relation(relation) => self.relation(*relation, placed, carry, next),
                    Chunk::Compass(compass) => self.compass(*compass, placed, carry),
                    // "waiting on the AV's right".
                    Chunk::Side(side) if self.side_of_subject(all, at) => {
                        let relation = if *side == LeftRight::Left { Relation::Left } else { Relation::Right };
                        self.relate(relation, Some(SUBJECT), carry);
                    }
                    Chunk::Side(side) => self.side(*side, carry),
                    // "so that a bus lane ran between them": what a road does.
                    Chunk::Lane(_) if carry.fresh && carry.preposition.is_none() && begins_its_verb(next) => {
                        (carry.stranger, carry.subject) = (true, None);
                    }
                    Chunk::Lane(lane) => self.lane(*lane, placed, carry, next),
                    Chunk::Spot(spot) => self.spot(*spot, placed, carry),
                    Chunk::Preposition(word) => preposition(word, carry),
                    // "the corner of Oak Street and Elm Street": no clause begins.
                    Chunk::Joint(Joint::And) if self.names_on_both_sides(all, at) => {}
                    Chunk::Joint(joint) => {
                        let inner = at >= 2
                            && *joint != Joint::And
                            && matches!(all[at - 1].chunk, Chunk::Comma)
                            && matches!(all[at - 2].chunk, Chunk::Joint(Joint::And));
                        if inner {
                            carry.resumes.clone_from(&carry.main);
                        }
                        self.joint(*joint, carry, &all[at + 1..]);
                    }
                    _ => {}
                }
                false
            }
        };
        if !stands {
            (carry.after_comma, carry.filled) = (false, false);
        }
    }

    /// What stands behind a comma, past "then" and the like: "the van, going straight as the road bent, then struck it".
    fn behind_small_words<'c>(&self, all: &'c [Placed], at: usize) -> Option<&'c Chunk> {
        const SMALL: [&str; 6] = ["then", "also", "subsequently", "eventually", "thereafter", "finally"];
        let small = |placed: &&Placed| {
            matches!(placed.chunk, Chunk::Word | Chunk::Joint(Joint::And))
                && SMALL.contains(&self.tokens[placed.first].text.as_str())
        };
        all[at + 1..].iter().find(|placed| !small(placed)).map(|placed| &placed.chunk)
    }

    /// Whether behind a comma it is told what somebody did besides: ", and had slowed", ", so it slowed".
    fn goes_on(&self, all: &[Placed], at: usize) -> bool {
        const SMALL: [&str; 6] = ["and", "then", "had", "also", "so", "but"];
        let small = |placed: &&Placed| SMALL.contains(&self.tokens[placed.first].text.as_str());
        let next = all[at + 1..].iter().find(|placed| !small(placed)).map(|placed| &placed.chunk);
        matches!(next, Some(Chunk::Verb(_, Form::Past | Form::Present) | Chunk::Pronoun))
    }

    fn not(&self, placed: &Placed, carry: &mut Carry) {
        carry.negated = true;
        // "Neither car made contact": said before who it is.
        let word = self.tokens[placed.first].text.as_str();
        carry.nobody |= matches!(word, "neither" | "nor") || carry.fresh && matches!(word, "no" | "nothing" | "nobody");
    }
}

/// Whether a finite verb begins here.
const fn begins_its_verb(next: Option<&Chunk>) -> bool {
    matches!(next, Some(Chunk::Verb(_, Form::Past | Form::Present) | Chunk::Be))
}

fn preposition(word: &'static str, carry: &mut Carry) {
    // "out of" goes out.
    let out = word == "of" && carry.preposition == Some("out");
    // "past a row of parked cars".
    if word == "of" && matches!(carry.preposition, Some("past" | "around")) {
        return;
    }
    carry.preposition = if out { Some("out") } else { Some(word) };
    carry.relation = None;
    carry.to |= word == "to";
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
