//! Where one clause ends and the next begins: "and", "when", "after", "before", "because", a comma, "that".

use super::Frame;
use super::parser::{Carry, Mention, Parser};
use super::row::{another_finite, goes_on_behind_comma};
use super::supposed::expects;
use crate::chunk::{Article, Chunk, Joint, Placed};
use crate::lexicon::{Form, Progress, Relation, Sense};
use crate::token::is_crash_noun;
use crate::world::SUBJECT;
use recrash_model::account::{Act, Kind, KindGroup};

impl Parser<'_> {
    /// A joint ends a clause and begins the next, unless it joins two words of one.
    pub(super) fn joint(&mut self, joint: Joint, carry: &mut Carry, behind: &[Placed]) {
        let next = behind
            .iter()
            .take(3)
            .map(|placed| &placed.chunk)
            .find(|chunk| joint != Joint::And || !matches!(chunk, Chunk::Word));
        let within_clause = joint == Joint::And
            && (self.is_one_way(carry, behind)
                || self.says_more_of_driver(carry, behind)
                || self.is_second_of_pair(next, carry, behind)
                || is_row_of_nouns(next, carry));
        if within_clause {
            return;
        }
        carry.also = None;
        if self.is_of_main_besides(joint, carry, behind) {
            (carry.subject, carry.relative) = (carry.main.clone(), false);
        }
        if let Some(mention) = self.seen_leaving(joint, behind, carry) {
            carry.subject = Some(mention);
        }
        self.leave_place(carry, false);
        carry.reduced = false;
        carry.clause += 1;
        (carry.preposition, carry.relation, carry.be, carry.to) = (None, None, false, false);
        if joint == Joint::And && matches!(next, Some(Chunk::Verb(..) | Chunk::Not | Chunk::Be)) {
            self.goes_on_with_verb(next, carry, behind);
        } else {
            begin_clause(joint, next, carry);
        }
    }

    /// "rolled across the street and into the van", "maneuvered forward and to the left": one way.
    fn is_one_way(&mut self, carry: &mut Carry, behind: &[Placed]) -> bool {
        let into = matches!(
            behind.first().map(|placed| &placed.chunk),
            Some(Chunk::Preposition("into" | "against" | "around" | "past"))
        );
        // "maneuvered forward and to the left", "went around and to the left of it": so too.
        let aside = behind.first().is_some_and(|placed| {
            let to = placed.first >= 2 && self.tokens[placed.first].text == "to";
            to && matches!(self.tokens[placed.first - 2].text.as_str(), "forward" | "around" | "past")
                && matches!(placed.chunk, Chunk::Relation(Relation::Left | Relation::Right))
        });
        if !(into || aside) || carry.frame.is_none() {
            return false;
        }
        (carry.preposition, carry.relation) = (None, None);
        // "forward and to the right at the fork": a way.
        let fork = |at: usize| {
            self.tokens.get(at).is_some_and(|token| {
                matches!(token.text.as_str(), "fork" | "split" | "intersection" | "junction" | "corner" | "lane")
            })
        };
        let end = behind[0].end;
        if aside && !(end..end + 3).any(fork) {
            self.goes_aside(carry);
        }
        true
    }

    /// "driving on the right, and overlapping its lane, the van passed": more of who drives.
    fn says_more_of_driver(&self, carry: &mut Carry, behind: &[Placed]) -> bool {
        let unknown = behind
            .first()
            .filter(|placed| matches!(placed.chunk, Chunk::Word) && self.tokens[placed.first].text.ends_with("ing"));
        let takes = matches!(behind.get(1).map(|placed| &placed.chunk), Some(Chunk::Noun(_) | Chunk::Piece(_)));
        let says_more = unknown.is_some() && takes && carry.subject.is_some();
        if says_more {
            (carry.preposition, carry.relation, carry.frame) = (Some("of"), None, None);
        }
        says_more
    }

    /// "between the van and a parked car": the second of a pair, and no new clause.
    fn is_second_of_pair(&self, next: Option<&Chunk>, carry: &mut Carry, behind: &[Placed]) -> bool {
        if !is_named(next) {
            return false;
        }
        let ends = behind.get(1).is_none_or(|placed| match placed.chunk {
            // "and the van, coming from the left, hit it".
            Chunk::Comma => !is_inserted(&behind[2..]),
            // "and the van then reversed" is a clause of its own.
            Chunk::Joint(joint) => joint != Joint::And || self.tokens[placed.first].text == "and",
            _ => false,
        });
        let second = ends && carry.has_verb
            || std::mem::take(&mut carry.pair)
            || self.is_passed_too(carry, behind)
            || self.is_other_side(carry, behind);
        if second {
            carry.preposition = Some("and");
        }
        second
    }

    /// "It passed the van which was waiting while also running the light": it ran the light.
    fn is_of_main_besides(&self, joint: Joint, carry: &Carry, behind: &[Placed]) -> bool {
        let known = |placed: &&Placed| !matches!(placed.chunk, Chunk::Word);
        let ing = matches!(behind.iter().find(known).map(|placed| &placed.chunk), Some(Chunk::Verb(_, Form::Ing)));
        let stands = carry.frame.is_some_and(|frame| self.frames[frame].act() == Some(Act::Hold));
        let besides = behind.first().is_some_and(|placed| self.tokens[placed.first].text == "also");
        joint == Joint::While
            && (stands || besides)
            && ing
            && carry.relative
            && carry.has_verb
            && carry.main.is_some()
            && !self.did_to(carry)
    }

    /// "braked and steered", "did not slow down or stop": another verb of the same clause.
    fn goes_on_with_verb(&self, next: Option<&Chunk>, carry: &mut Carry, behind: &[Placed]) {
        // "braked shortly before the impact and steered to the right": no clause began there.
        if carry.joint == Some(Joint::Before) && carry.frame.is_none() && self.is_behind_time(behind) {
            (carry.joint, carry.stranger) = (None, false);
        }
        // "did not slow down or stop" denies both.
        let or = behind.first().is_some_and(|next| next.first > 0 && self.tokens[next.first - 1].text == "or");
        carry.negated = or
            && matches!(next, Some(Chunk::Verb(_, Form::Base)))
            && carry.frame.is_some_and(|frame| self.frames[frame].negated);
        carry.row = true;
        if carry.relative {
            // "a van that was behind it and struck it" goes on with the van.
            carry.has_verb = true;
        }
        if !matches!(next, Some(Chunk::Verb(_, Form::Base))) {
            carry.progress = None;
        }
        // "approached a light that was red and stopped": no light does.
        let stops =
            matches!(next, Some(Chunk::Verb(Sense::Act(Act::Stop | Act::Hold | Act::Slow) | Sense::Yield, Form::Past)));
        if stops && carry.relative && carry.stranger && carry.main.is_some() {
            (carry.subject, carry.stranger, carry.relative, carry.frame) = (carry.main.clone(), false, false, None);
        }
        if let Some(main) = self.saw_and_did(next, carry) {
            (carry.subject, carry.has_verb, carry.relative) = (Some(main), true, false);
        }
    }

    /// "before the impact and", "prior to contact and": a time stands before that "and".
    fn is_behind_time(&self, behind: &[Placed]) -> bool {
        let and = behind.first().map_or(0, |placed| placed.first.saturating_sub(1));
        let words: Vec<&str> =
            self.tokens[and.saturating_sub(4)..and].iter().map(|token| token.text.as_str()).collect();
        let time = words.last().is_some_and(|word| is_crash_noun(word));
        time && words.iter().any(|word| matches!(*word, "before" | "prior"))
    }

    /// "moved forward and to the left": over, besides.
    fn goes_aside(&mut self, carry: &mut Carry) {
        let Some(frame) = carry.frame.map(|frame| self.frames[frame].clone()) else { return };
        let moves = matches!(frame.sense, Sense::Act(Act::Follow | Act::SetOff | Act::Accelerate));
        if moves {
            self.frames.push(Frame { sense: Sense::Act(Act::Drift), side: None, ..frame });
            carry.frame = Some(self.frames.len() - 1);
        }
    }

    /// "It stopped when it saw a truck attempting to turn while leaving a lot": who stops leaves none.
    fn seen_leaving(&self, joint: Joint, behind: &[Placed], carry: &Carry) -> Option<Mention> {
        let verb = behind.iter().map(|placed| &placed.chunk).find(|chunk| !matches!(chunk, Chunk::Word))?;
        let leaves = matches!(verb, Chunk::Verb(Sense::Act(Act::PullOut), Form::Ing));
        let last = &self.frames[carry.frame?];
        let turns = matches!(last.sense, Sense::Act(Act::Turn) | Sense::Sided(Act::Turn, _))
            || last.progress == Progress::Tried;
        let who = last.who.filter(|who| *who != SUBJECT && joint == Joint::While && leaves && turns)?;
        let here = |frame: &&Frame| frame.sentence == self.sentence && frame.who == Some(SUBJECT);
        let mut own = self.frames.iter().filter(here);
        let stops = own.any(|frame| frame.act().is_some_and(Act::stands));
        let last = carry.last.clone().filter(|last| last.actor == who);
        last.filter(|_| stops && carry.subject.as_ref().is_some_and(|subject| subject.actor == SUBJECT))
    }

    /// "was struck by a van that crossed the line while heading east": whoever did it to somebody goes on, and not whom it was done to.
    fn did_to(&self, carry: &Carry) -> bool {
        let done_by = |frame: &Frame| {
            let who = carry.subject.as_ref().map(|subject| subject.actor);
            frame.sentence == self.sentence
                && frame.passive
                && frame.is_contact()
                && frame.who.is_some()
                && frame.who == who
        };
        self.frames.iter().rev().take(3).any(done_by)
    }

    /// "A van passed it and the car behind it by crossing the line": a second one that was passed, and nobody who does anything.
    fn is_passed_too(&self, carry: &Carry, behind: &[Placed]) -> bool {
        let placed = matches!(behind.get(1).map(|placed| &placed.chunk), Some(Chunk::Relation(_)));
        let Some(frame) = carry.frame.map(|frame| &self.frames[frame]) else { return false };
        let passes = frame.act() == Some(Act::Pass) && frame.object.is_some();
        let between = self.tokens[frame.first..frame.end].iter().any(|token| token.text == "between");
        placed && passes && !between && !carry.after_comma && !another_finite(behind, 0)
    }

    /// "A cyclist passing between the AV and the curb hit it": what it passes on the other side.
    fn is_other_side(&self, carry: &Carry, behind: &[Placed]) -> bool {
        let Some(frame) = carry.frame.map(|frame| &self.frames[frame]) else { return false };
        let between = self.tokens[frame.first..frame.end].iter().any(|token| token.text == "between");
        let does = matches!(behind.get(1).map(|placed| &placed.chunk), Some(Chunk::Verb(..)));
        // "between two parked cars and": both are named.
        let both = frame.object.is_none_or(|object| self.world.actors[object].several);
        between && does && !both && behind[0].first == frame.end + 1
    }

    /// "As it slowed, there was a van passing": a clause of its own, about who is named behind it.
    pub(super) fn brings_on(&self, all: &[Placed], at: usize, carry: &mut Carry) -> bool {
        let there = at > 0 && self.tokens[all[at - 1].first].text == "there" && carry.frame.is_some();
        let noun = matches!(all.get(at + 1).map(|next| &next.chunk), Some(Chunk::Noun(noun)) if noun.article == Article::Indefinite);
        let does = matches!(all.get(at + 2).map(|next| &next.chunk), Some(Chunk::Verb(_, Form::Ing)));
        if !(there && noun && does) {
            return false;
        }
        (carry.frame, carry.subject, carry.joint) = (None, None, None);
        (carry.has_verb, carry.relative, carry.fresh, carry.governed) = (false, false, true, false);
        (carry.preposition, carry.relation, carry.progress, carry.to) = (None, None, None, false);
        carry.clause += 1;
        true
    }

    /// "Behind it stood a van", "Ahead of it, likewise stopped, was a van", "Parked at the curb was a van": the verb before its subject.
    pub(super) fn inverts(&self, all: &[Placed], at: usize) -> bool {
        let begins =
            all[..at].iter().rposition(|placed| matches!(placed.chunk, Chunk::Joint(_))).map_or(0, |joint| joint + 1);
        let clause = &all[begins..at];
        let plain = |placed: &&Placed| !matches!(placed.chunk, Chunk::Word | Chunk::Comma);
        let stands = |sense: Sense| matches!(sense, Sense::Act(Act::Hold | Act::Stop | Act::Park) | Sense::Parked);
        let opens = clause.iter().find(plain).is_some_and(|placed| match placed.chunk {
            Chunk::Relation(_) => true,
            Chunk::Verb(sense, Form::Past | Form::Ing) => stands(sense),
            _ => false,
        });
        let governed = (begins..at).all(|at| match all[at].chunk {
            Chunk::Noun(_) | Chunk::Pronoun => {
                at > begins && matches!(all[at - 1].chunk, Chunk::Relation(_) | Chunk::Preposition(_))
            }
            Chunk::Piece(_) | Chunk::Relative | Chunk::Be => false,
            Chunk::Verb(_, form) => {
                form == Form::Ing || !matches!(all[at.saturating_sub(1)].chunk, Chunk::Pronoun | Chunk::Noun(_))
            }
            _ => true,
        });
        let Some(named) = all[at + 1..].iter().position(|placed| !matches!(placed.chunk, Chunk::Word)) else {
            return false;
        };
        let named = at + 1 + named;
        let somebody = matches!(&all[named].chunk, Chunk::Noun(noun)
            if (noun.article == Article::Indefinite || noun.several && noun.article == Article::None) && noun.occupant.is_none());
        opens && governed && somebody && !another_finite(all, named)
    }

    /// "It detected that the bus was stopping and moved back": who saw what went on did so.
    fn saw_and_did(&self, next: Option<&Chunk>, carry: &Carry) -> Option<Mention> {
        let main = carry.main.as_ref().filter(|main| carry.subject.as_ref() != Some(main))?;
        let frame = &self.frames[carry.frame?];
        let past = matches!(next, Some(Chunk::Verb(_, Form::Past)));
        if past && frame.who != Some(main.actor) && self.expects(main, frame) {
            return Some(main.clone());
        }
        let seen = frame.form == Form::Ing && frame.who != Some(main.actor) && frame.sentence == self.sentence;
        let saw = self.frames.iter().rfind(|before| {
            before.sentence == self.sentence && before.sense == Sense::See && before.who == Some(main.actor)
        })?;
        let that = self.tokens[saw.end..frame.first].first().is_some_and(|token| token.text == "that");
        (seen && that && past).then(|| main.clone())
    }

    /// "It predicted that the van would wait and passed it": who expects something of another goes on.
    fn expects(&self, main: &Mention, frame: &Frame) -> bool {
        let would = frame.first > 0 && matches!(self.tokens[frame.first - 1].text.as_str(), "would" | "will" | "might");
        would && expects(self.tokens.get(main.end..frame.first).unwrap_or_default())
    }

    /// "that", "which", "who": the clause behind it is about the noun named last.
    pub(super) fn relative(&mut self, all: &[Placed], at: usize, carry: &mut Carry) -> bool {
        // "at which time the operator ...": the operator is not behind "at".
        (carry.preposition, carry.relation) = (None, None);
        // "the bracket that holds the sensor": of a thing without a name.
        // "along an alley, which lies east of Elm Street": of the alley.
        let which = self.tokens[all[at].first].text == "which" && at > 1 && matches!(all[at - 1].chunk, Chunk::Comma);
        if self.of_a_word(all, at) || which && matches!(all[at - 2].chunk, Chunk::Spot(_)) {
            (carry.outer, carry.subject) = (carry.subject.take(), None);
            (carry.frame, carry.has_verb, carry.stranger) = (None, false, true);
            carry.relative = true;
            return true;
        }
        if let Some(last) = carry.last.clone() {
            let last = if self.tokens[all[at].first].text == "who" { self.person_of(last) } else { last };
            let last = self.placed_by_it(all, at, carry).unwrap_or(last);
            let once_more = at > 0 && matches!(all[at - 1].chunk, Chunk::Joint(Joint::And));
            let last = carry.antecedent.take().filter(|_| once_more).unwrap_or(last);
            carry.antecedent = Some(last.clone());
            if !carry.relative {
                carry.outer = carry.subject.clone().filter(|_| !carry.has_verb);
            }
            (carry.subject, carry.frame, carry.has_verb) = (Some(last), None, false);
            (carry.relative, carry.fresh, carry.governed) = (true, false, false);
            (carry.be, carry.to, carry.progress) = (false, false, None);
            // "The impact pushed it into a van that was standing there": of the van.
            carry.stranger &= at == 0 || !matches!(all[at - 1].chunk, Chunk::Noun(_));
        }
        false
    }

    /// "The van behind it, which had been waiting": the van, of which no verb has told yet; "was struck by the van behind it, which had set
    /// off": the van too.
    fn placed_by_it(&self, all: &[Placed], at: usize, carry: &Carry) -> Option<Mention> {
        let back = at - usize::from(at > 0 && matches!(all[at - 1].chunk, Chunk::Comma));
        let [.., noun, relation, by] = &all[..back] else { return None };
        let it = match &by.chunk {
            Chunk::Pronoun => true,
            Chunk::Noun(noun) => noun.subject,
            _ => false,
        };
        let placed = matches!(noun.chunk, Chunk::Noun(_)) && matches!(relation.chunk, Chunk::Relation(_)) && it;
        let subject = carry.subject.clone();
        let agent = || {
            let frame =
                carry.frame.map(|frame| &self.frames[frame]).filter(|frame| frame.passive && frame.is_contact())?;
            let actor = frame.who.filter(|actor| placed && *actor != SUBJECT && noun.end == relation.first)?;
            Some(Mention { actor, piece: None, person: None, end: noun.end })
        };
        subject.filter(|subject| placed && !carry.has_verb && subject.end == relation.first).or_else(agent)
    }

    /// "yielded to a fire truck, with its siren on, traveling south": behind the second comma it is still told of the truck.
    fn set_off_by_with(&self, comma: usize) -> Option<Mention> {
        const WITHIN: usize = 10;
        let first = comma.saturating_sub(WITHIN);
        let before = (first..comma).rev().find(|&at| self.tokens[at].text == ",")?;
        if self.tokens[before + 1].text != "with" {
            return None;
        }
        let met = |frame: &&Frame| frame.sentence == self.sentence && frame.first < before && frame.object.is_some();
        let frame =
            self.frames.iter().rev().find(met).filter(|frame| matches!(frame.sense, Sense::Yield | Sense::See))?;
        let actor = frame.object.filter(|actor| *actor != SUBJECT && self.world.actors[*actor].acts())?;
        Some(Mention { actor, piece: None, person: None, end: before })
    }

    pub(super) fn comma(&mut self, comma: usize, next: Option<&Chunk>, carry: &mut Carry) -> bool {
        carry.after_comma = true;
        // "The van, unable to stop, struck it": the comma ends what did not happen.
        carry.negated &= carry.nobody || !carry.has_verb && carry.frame.is_none() && carry.fresh;
        (carry.preposition, carry.relation, carry.be, carry.to) = (None, None, false, false);
        carry.progress = None;
        // "It waited and, although a message came, opened its door": who the sentence is about goes on.
        let goes_on = matches!(next, Some(Chunk::Verb(_, Form::Past | Form::Present)));
        // "It stopped and, after a bus had gone by, turned": it turned.
        if let Some(main) = carry.resumes.take_if(|_| goes_on) {
            (carry.stranger, carry.row, carry.has_verb, carry.joint) = (false, true, true, None);
            (carry.subject, carry.main, carry.frame) = (Some(main.clone()), Some(main), None);
            carry.clause += 1;
        }
        if goes_on && carry.stranger && carry.joint.is_some() && carry.main.is_some() {
            (carry.stranger, carry.row, carry.has_verb) = (false, true, true);
            (carry.subject, carry.frame) = (carry.main.clone(), None);
        }
        // "It moved up once the van ahead had turned, then stopped": it stopped.
        let then = carry.joint == Some(Joint::After) && carry.has_verb && !carry.relative;
        if let (true, [.., before, _]) =
            (goes_on && then && self.tokens[comma + 1].text == "then", carry.mains.as_slice())
        {
            let main = Some(Mention { actor: *before, piece: None, person: None, end: comma });
            (carry.subject, carry.main) = (main.clone(), main);
            (carry.row, carry.joint, carry.frame) = (true, None, None);
            carry.clause += 1;
        }
        // "a van that stood facing east, across the road, attempting to turn": still of the van.
        let still = carry
            .described
            .take()
            .filter(|described| carry.frame.is_none_or(|frame| self.frames[frame].who == Some(described.actor)));
        carry.described =
            carry.subject.clone().filter(|_| carry.relative).or(still).or_else(|| self.set_off_by_with(comma));
        if carry.relative && carry.has_verb {
            // A relative clause ends at its comma.
            carry.relative = false;
            carry.subject = carry.main.clone();
            carry.has_verb = carry.pending.is_empty() && carry.main.is_some();
        }
        true
    }

    /// "touched one of the pedestrians, who stood to the right of the AV, who fell": whoever is named last and is no vehicle.
    fn person_of(&self, last: Mention) -> Mention {
        let known = &self.world.actors;
        let person = |actor: usize| {
            let kind = known[actor].kind.map(Kind::group);
            matches!(kind, Some(KindGroup::OnFoot | KindGroup::Cyclist | KindGroup::Motorcycle))
                && known[actor].sentence == Some(self.sentence)
        };
        let vehicle =
            last.person.is_none() && (last.actor == SUBJECT || known[last.actor].kind.is_some_and(Kind::is_vehicle));
        let found = (1..known.len()).filter(|actor| person(*actor)).max_by_key(|actor| known[*actor].last);
        match found.filter(|_| vehicle) {
            Some(actor) => Mention { actor, piece: None, person: None, end: last.end },
            None => last,
        }
    }

    /// Behind a clause that tells of a place the sentence goes on with whom it is about: "approached a lot where cars were parked, and slowed".
    pub(super) fn leave_place(&self, carry: &mut Carry, goes_on: bool) {
        if std::mem::take(&mut carry.place) && (carry.subject.is_none() || goes_on) {
            (carry.subject, carry.frame) = (carry.main.clone(), carry.frame.filter(|_| !goes_on));
            (carry.has_verb, carry.stranger) = (carry.main.is_some(), false);
        }
    }
}

/// Whether somebody, or a part, is named here.
const fn is_named(chunk: Option<&Chunk>) -> bool {
    matches!(chunk, Some(Chunk::Noun(_) | Chunk::Piece(_)))
}

/// "the van and the bus": nouns in a row.
fn is_row_of_nouns(next: Option<&Chunk>, carry: &mut Carry) -> bool {
    let nouns = is_named(next) && !carry.has_verb && !carry.after_comma && carry.subject.is_some();
    if nouns {
        carry.also = carry.subject.clone();
    }
    nouns
}

/// "when", "after", "and the van": a clause of its own, of whom it is about or of who is named next.
fn begin_clause(joint: Joint, next: Option<&Chunk>, carry: &mut Carry) {
    if joint != Joint::And {
        (carry.lead_heading, carry.lead_lane) = (None, None);
        carry.joint = Some(joint);
        if !(is_named(next) || matches!(next, Some(Chunk::Pronoun))) {
            // "while stopped", "before turning": of whom the clause is about, or of who is named next.
            carry.has_verb = carry.subject.is_some();
        }
    }
    (carry.stranger, carry.relative, carry.governed, carry.fresh) = (false, false, false, true);
    (carry.progress, carry.negated, carry.frame) = (None, false, None);
}

/// Whether the words behind a comma say more of the noun before it, and its verb is still to come: "a van, coming from the left, hit it",
/// "a van, first parked behind it, set off".
fn is_inserted(behind: &[Placed]) -> bool {
    let says = behind.iter().map(|placed| &placed.chunk).find(|chunk| !matches!(chunk, Chunk::Word));
    match says {
        Some(Chunk::Verb(_, Form::Ing) | Chunk::Not | Chunk::Relative) => true,
        Some(Chunk::Verb(_, Form::Past) | Chunk::Relation(_)) => goes_on_behind_comma(behind),
        _ => false,
    }
}
