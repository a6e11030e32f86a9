//! Verbs make frames: of whom, in which state, how far it came, by whom it was done.

use super::Frame;
use super::adverbs::goes_about;
use super::parser::{Carry, Mention, Parser};
use super::row::{
    Spoken, another_finite, goes_on_behind_comma, looks_somewhere, names_doer, next_is_verb, next_preposition, single,
    transitive,
};
use super::sided;
use crate::chunk::{Chunk, Joint, Placed};
use crate::lexicon::{Form, Occupant, Progress, Sense};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Kind};

/// "whose driver was fast asleep": so far behind "whose" its clause may end. [tokens]
const WHOSE_WITHIN: usize = 6;

/// Who does what a verb tells, as its words name them.
struct Doer {
    who: Option<Mention>,
    /// It tells how somebody stood who was met: "came upon a truck stopped in the road".
    found: bool,
    /// It tells what who strikes did at once: "struck it in passing".
    meanwhile: bool,
}

impl Parser<'_> {
    /// A verb begins a frame.
    pub(super) fn verb(&mut self, sense: Sense, form: Form, all: &[Placed], at: usize, carry: &mut Carry) {
        if carry.place && carry.subject.is_none() || self.says_more_of_a_thing(all, at, carry) {
            return;
        }
        let mut verb = Spoken { sense, form, all, at };
        self.finds_its_clause(&verb, carry);
        verb.sense = self.sense_in_clause(&verb, carry);
        let finite = matches!(form, Form::Past | Form::Present) || form == Form::Ing && carry.be;
        leave_relative(&verb, carry);
        let own_progress = carry.progress;
        let leads = self.leads(&verb, carry);
        let led = matches!(verb.sense, Sense::Other | Sense::Push | Sense::Act(Act::Follow));
        if leads && led && next_is_verb(all, at) {
            return self.only_leads(&verb, carry);
        }
        go_back(&verb, carry);
        let both = self.of_both(verb.sense, all, at, carry);
        verb.sense = if both { Sense::ContactMade } else { verb.sense };
        let to = std::mem::take(&mut carry.to) && form == Form::Base;
        let purpose = to && !carry.began;
        let doer = self.doer(&mut verb, purpose, carry);
        carry.reduced &= !finite;
        let unknown = self.is_of_unknown(&verb, carry);
        // "A fault caused it to brake": it braked.
        let caused = carry.pushed && purpose && matches!(verb.sense, Sense::Act(_) | Sense::Sided(..));
        let who = doer.who.filter(|_| (!carry.stranger || caused) && !both && !unknown);
        let mut frame = self.begun_frame(&verb, who.as_ref(), carry);
        frame.described |= doer.meanwhile || doer.found;
        if leads {
            frame.progress = own_progress.unwrap_or(Progress::Real);
        }
        let described = doer.found || self.only_describes(&verb, carry);
        let be = std::mem::take(&mut carry.be);
        if self.tells_state(&verb, who.as_ref(), (be, described), carry) {
            frame.state = true;
            frame.sense = if verb.sense == Sense::Act(Act::Park) { Sense::Parked } else { Sense::Act(Act::Hold) };
        }
        self.how_far(&mut frame, &verb, purpose, carry);
        let leading = self.done_to(&mut frame, &verb, be, carry);
        carry.pushed &= verb.sense != Sense::Push;
        takes_over(&frame, &verb, carry);
        self.fill_gap(&mut frame, &verb, carry);
        self.went_on_into(&frame, carry);
        self.where_to(&mut frame, &verb, carry);
        let of_somebody = !(frame.passive || carry.stranger || unknown);
        let unnamed = frame.who.is_none()
            && of_somebody
            && !matches!(verb.sense, Sense::ContactMade | Sense::LightGreen | Sense::LightRed | Sense::LightYellow);
        let number = self.push(frame, carry);
        if unnamed || leading {
            carry.pending.push(number);
        }
        carry.has_verb |= finite && !described || unnamed || carry.stranger;
        self.carry_on(&verb, number, leads, carry);
    }

    /// "a turn lane that opens there", "a dolly attached to the truck": no event.
    fn says_more_of_a_thing(&self, all: &[Placed], at: usize, carry: &mut Carry) -> bool {
        if is_of_a_road(all, at, self.tokens[all[at].first].text.as_str()) {
            carry.be = false;
            return true;
        }
        if self.is_attached(all, at) {
            carry.attached = carry.last.as_ref().filter(|last| last.piece.is_none()).map(|last| last.actor);
            carry.be = false;
            return true;
        }
        false
    }

    /// Where a verb stands in its clause: behind "whose", before its subject, of a trailer that comes loose.
    fn finds_its_clause(&mut self, verb: &Spoken<'_>, carry: &mut Carry) {
        // "a van whose hood was up struck it", "whose driver was asleep ran into it".
        let first = verb.placed().first;
        let whose = self.tokens[first.saturating_sub(WHOSE_WITHIN)..first].iter().any(|token| token.text == "whose");
        let behind_noun = verb.chunk_before().is_some_and(|before| !matches!(before, Chunk::Be));
        carry.be &= !(whose && verb.form == Form::Past && behind_noun);
        let stands = matches!(verb.sense, Sense::Act(Act::Hold | Act::Stop | Act::Follow) | Sense::Approach);
        if stands && verb.form == Form::Past && !carry.be && self.inverts(verb.all, verb.at) {
            (carry.inverts, carry.subject, carry.last) = (true, None, None);
        }
        self.comes_loose(verb, carry);
    }

    /// What a verb tells in its clause; one that tells the contrary is denied no more.
    fn sense_in_clause(&self, verb: &Spoken<'_>, carry: &mut Carry) -> Sense {
        let sense = self.sense_here(verb, carry);
        let told_otherwise = match (verb.sense, sense) {
            // What did not end in a standstill was begun.
            (Sense::Act(Act::Stop), Sense::Act(Act::Slow)) => true,
            // "was not moving" tells that it stood.
            (Sense::Act(Act::Follow), Sense::Act(Act::Hold)) => true,
            // "failed to stay in its lane" tells that it left it.
            (Sense::Act(Act::Hold), Sense::Act(Act::Drift)) => true,
            _ => false,
        };
        carry.negated &= !told_otherwise;
        sense
    }

    /// Who does what a verb tells. One that tells how somebody stands tells no act.
    fn doer(&self, verb: &mut Spoken<'_>, purpose: bool, carry: &Carry) -> Doer {
        let so = self.stands_so(verb, carry);
        if so.as_ref().is_some_and(|(_, stood)| *stood) {
            verb.sense = Sense::Other;
        }
        let verb = &*verb;
        let found = self.stood_as_found(verb, carry);
        let meanwhile = self.did_so_in(verb, carry);
        let struck = self.stood_when_struck(verb, carry);
        let told = (found.is_some() || struck.is_some(), meanwhile.is_some());
        let who = meanwhile
            .or(struck)
            .or_else(|| self.was_turning(verb, carry))
            .or(so.map(|(mention, _)| mention))
            .or(found)
            .or_else(|| self.beside(verb, carry))
            .or_else(|| self.who_of(verb, carry, purpose))
            .or_else(|| self.left_out(verb, carry))
            .or_else(|| self.in_clause_of_object(verb, carry));
        Doer { who, found: told.0, meanwhile: told.1 }
    }

    /// "a van that it was following": whom the clause is about is the object.
    fn fill_gap(&mut self, frame: &mut Frame, verb: &Spoken<'_>, carry: &mut Carry) {
        let open = |gap: &Actor| transitive(verb.sense) && frame.object.is_none() && frame.who != Some(*gap);
        let Some(gap) = carry.gap.take().filter(open) else { return };
        let named =
            matches!(verb.next(), Some(Chunk::Noun(_) | Chunk::Pronoun | Chunk::Piece(_) | Chunk::Preposition(_)));
        frame.object = (!named).then_some(gap);
        if let (false, Sense::Act(Act::Follow)) = (named, verb.sense) {
            self.follows(frame.who, gap);
        }
    }

    /// "Seeing that the van was not going to yield, it braked": what is seen has a verb of its own.
    fn in_clause_of_object(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        let small = |placed: &&Placed| {
            matches!(placed.chunk, Chunk::Word | Chunk::Not | Chunk::Be | Chunk::Preposition("to"))
                || matches!(placed.chunk, Chunk::Verb(Sense::Act(Act::Follow), Form::Ing))
        };
        let before = &verb.all[..verb.at];
        let between = before.iter().rev().take_while(small).count();
        let (lead, row) = before.split_at(before.len() - between);
        let was =
            row.first().is_some_and(|placed| matches!(self.tokens[placed.first].text.as_str(), "was" | "were" | "is"));
        let last = carry.last.as_ref().filter(|last| lead.last().is_some_and(|noun| noun.end == last.end))?;
        let seen = carry.frame.is_some_and(|frame| {
            self.frames[frame].sense == Sense::See && self.frames[frame].object == Some(last.actor)
        });
        (was && seen && carry.subject.is_none()).then(|| last.clone())
    }

    /// "At the time of contact, was stopped for traffic": whose report it is.
    fn left_out(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        let stands = matches!(verb.sense, Sense::Act(Act::Stop | Act::Hold | Act::Follow | Act::Slow));
        let before = &verb.all[..verb.at];
        // "was" may be a chunk by itself, or a word of the verb.
        let (finite, lead) = match before {
            [lead @ .., be] if matches!(be.chunk, Chunk::Be) => (true, lead),
            lead => (verb.word(self) == "was", lead),
        };
        let named = lead.iter().any(|placed| matches!(placed.chunk, Chunk::Noun(_) | Chunk::Pronoun | Chunk::Verb(..)));
        let begins = lead.last().is_none_or(|last| matches!(last.chunk, Chunk::Comma)) && !named;
        let unnamed = carry.subject.is_none() && carry.main.is_none() && !carry.stranger;
        let by = next_preposition(verb.all, verb.at) == Some("by");
        let told = stands && finite && begins && unnamed && !by;
        told.then_some(Mention { actor: SUBJECT, piece: None, person: None, end: verb.placed().first })
    }

    /// "towing a trailer. ... The trailer came loose": from here on it is one by itself.
    fn comes_loose(&mut self, verb: &Spoken<'_>, carry: &mut Carry) {
        let named = verb.at.checked_sub(1).map(|at| &verb.all[at].chunk);
        let trailer = matches!(named, Some(Chunk::Noun(noun)) if noun.kind == Some(Kind::Trailer));
        // Told behind the crash it drew the trailer there.
        let loose = trailer && verb.sense == Sense::Act(Act::Fall) && !self.frames.iter().any(Frame::is_contact);
        let Some(subject) = carry.subject.as_mut().filter(|_| loose) else { return };
        if let Some(loose) = self.world.let_go(subject.actor) {
            subject.actor = loose;
        }
    }

    /// "began to", "attempted to", "was waiting to": how far the next verb came. Whether this one tells it.
    fn leads(&mut self, verb: &Spoken<'_>, carry: &mut Carry) -> bool {
        let Spoken { sense, form, all, at } = *verb;
        if !single(verb.placed()) {
            return false;
        }
        // "was forced to brake": so it did.
        let forced = carry.be
            && matches!(verb.word(self), "forced" | "caused" | "compelled" | "obliged")
            && next_is_verb(all, at);
        let forced = forced.then_some(Progress::Real);
        let Some(progress) = self.lexicon.progress(verb.word(self)).or(forced) else { return false };
        if !next_is_verb(all, at) && (sense != Sense::Other || looks_somewhere(all, at)) {
            return false;
        }
        // "before proceeding to turn": not done.
        let before = carry.joint == Some(Joint::Before) && carry.fresh && form == Form::Ing;
        carry.progress = Some(if before { Progress::Wished } else { progress });
        carry.began = true;
        carry.to &= sense != Sense::Other;
        true
    }

    /// A verb that only says how far the next one came makes no frame.
    fn only_leads(&mut self, verb: &Spoken<'_>, carry: &mut Carry) {
        let form = verb.form;
        carry.began = false;
        carry.lead_who = self.who_of(&Spoken { sense: Sense::Act(Act::Follow), ..*verb }, carry, false);
        carry.began = true;
        carry.lead_describes =
            form == Form::Ing && !carry.be && carry.lead_who.is_some() && carry.lead_who != carry.subject;
        carry.has_verb |= form != Form::Ing || carry.be;
    }

    /// The frame of a verb, with who does it.
    fn begun_frame(&mut self, verb: &Spoken<'_>, who: Option<&Mention>, carry: &mut Carry) -> Frame {
        let Spoken { sense, form, .. } = *verb;
        let mut frame = self.frame(who.map(|mention| mention.actor), sense, form, verb.placed(), carry);
        frame.person = who.and_then(|mention| mention.person);
        frame.with = who.and_then(|mention| mention.piece.clone());
        if frame.is_contact() && frame.with.is_none() {
            frame.with = carry.with.take();
        }
        if sense == Sense::TakeOver && frame.person == Some(Occupant::Driver) {
            frame.who = Some(SUBJECT);
            self.world.own_driver = true;
        }
        frame.described |= form == Form::Ing && !carry.be && who.is_some() && who != carry.subject.as_ref();
        frame.described |= std::mem::take(&mut carry.lead_describes);
        frame
    }

    /// "a van parked on the left began to move": the first verb describes, the second one tells.
    fn only_describes(&self, verb: &Spoken<'_>, carry: &Carry) -> bool {
        let describes = matches!(
            verb.sense,
            Sense::Act(Act::Stop | Act::Park | Act::Hold) | Sense::Parked | Sense::Face | Sense::Tow
        );
        describes
            && verb.form == Form::Past
            && verb.is_bare(self)
            && !carry.be
            && !carry.has_verb
            && carry.last_is(carry.subject.as_ref())
            && (another_finite(verb.all, verb.at)
                // "a van, first parked behind it, set off", "a van parked at the curb, opened its door".
                || (carry.after_comma || matches!(verb.sense, Sense::Parked | Sense::Act(Act::Park))) && goes_on_behind_comma(&verb.all[verb.at + 1..])
                || self.was_so_at_first(verb))
    }

    /// "a truck initially stopped behind it, and partly in the next lane, attempted to pass": how it was before its verb.
    fn was_so_at_first(&self, verb: &Spoken<'_>) -> bool {
        let before = verb.placed().first.checked_sub(1).map_or("", |at| self.tokens[at].text.as_str());
        let outer = |chunk: &Chunk| {
            !matches!(chunk, Chunk::Joint(joint) if *joint != Joint::And) && !matches!(chunk, Chunk::Relative)
        };
        let mut clause = verb.all[verb.at + 1..].iter().map(|placed| &placed.chunk).take_while(|chunk| outer(chunk));
        matches!(before, "initially" | "originally" | "previously")
            && clause.any(|chunk| matches!(chunk, Chunk::Verb(_, Form::Past | Form::Present)))
    }

    /// Whether a verb of stopping tells that somebody stood: "was stopped", "a truck stopped in the road", "while stopped".
    fn tells_state(
        &self,
        verb: &Spoken<'_>,
        who: Option<&Mention>,
        (be, described): (bool, bool),
        carry: &Carry,
    ) -> bool {
        if verb.form != Form::Past || !matches!(verb.sense, Sense::Act(Act::Stop | Act::Park | Act::Hold)) {
            return false;
        }
        if be || verb.sense == Sense::Act(Act::Hold) {
            return be;
        }
        let last = who.is_some() && carry.last_is(who);
        let inner = carry.governed || carry.joint.is_some_and(|joint| joint != Joint::And);
        let participle = inner && last && (carry.fresh || carry.governed);
        // "approached a truck stopped in the road": it stood there.
        let of_object = carry.has_verb && last && who != carry.subject.as_ref();
        // "Stopped in the left lane, it was struck".
        let fronted = carry.joint.is_none() && who.is_none() && carry.main.is_none() && carry.pending.is_empty();
        let while_so = carry.fresh && (carry.joint == Some(Joint::While) || fronted && !carry.stranger);
        // "There was a van parked on its right".
        let there = verb.at > 2
            && matches!(verb.all[verb.at - 1].chunk, Chunk::Noun(_))
            && matches!(verb.all[verb.at - 2].chunk, Chunk::Be)
            && self.tokens[verb.all[verb.at - 3].first].text == "there"
            || verb.at == 3 && self.tokens[verb.all[0].first].text == "there" && matches!(verb.all[1].chunk, Chunk::Be);
        described || verb.is_bare(self) && (participle || of_object || while_so || there)
    }

    /// How far a verb came that is told as a purpose, or behind "before".
    fn how_far(&self, frame: &mut Frame, verb: &Spoken<'_>, purpose: bool, carry: &Carry) {
        let waits = matches!(verb.sense, Sense::Yield | Sense::Act(Act::Hold | Act::Stop | Act::Slow));
        if purpose && !waits && frame.progress == Progress::Real {
            frame.progress = self.purpose(frame, verb, carry);
        }
        // "had a trajectory toward its lane": not there yet.
        let aims =
            || self.tokens[verb.placed().first..verb.placed().end].iter().any(|token| token.text == "trajectory");
        if frame.act() == Some(Act::Drift) && frame.progress == Progress::Real && aims() {
            frame.progress = Progress::Tried;
        }
        // "drove on before slowing to a stop", "before yielding": one after the other.
        let before = carry.joint == Some(Joint::Before) && carry.fresh && verb.form == Form::Ing && !waits;
        if before && frame.progress == Progress::Real {
            frame.progress = Progress::Wished;
        }
    }

    /// "moved forward to pass it": begun. "slowed to turn": not.
    fn purpose(&self, frame: &Frame, verb: &Spoken<'_>, carry: &Carry) -> Progress {
        let before = carry.frame.map(|before| &self.frames[before]);
        let before = before.filter(|before| before.who == frame.who && before.happened());
        let going = before.is_some_and(|before| goes_about(before.act()));
        // "entered the intersection to make a left turn": so it did.
        let enters = before.is_some_and(|before| {
            let words = &self.tokens[before.first..verb.placed().first];
            before.act() == Some(Act::Enter)
                && words.iter().any(|token| matches!(token.text.as_str(), "intersection" | "junction"))
        });
        let maneuvers = before.is_some_and(|before| self.tokens[before.first].text.starts_with("maneuver"));
        match frame.act() {
            // "pushed the van, causing it to turn": so it did.
            _ if carry.pushed => Progress::Real,
            Some(Act::Pass | Act::Park | Act::LaneChange) if going => Progress::Tried,
            Some(Act::Turn) if enters => Progress::Real,
            // "slowed to move into the right lane".
            Some(Act::LaneChange) if before.is_some_and(|before| before.act() == Some(Act::Slow)) => Progress::Tried,
            // "maneuvered to make a right turn".
            Some(Act::Turn) if maneuvers => Progress::Tried,
            _ => Progress::Wished,
        }
    }

    /// "was struck", "was shoved back", with or without a "by" behind it: who was named is to whom it was done. Whether he is named
    /// only later: "Struck by a coupe, a parked van ...".
    fn done_to(&mut self, frame: &mut Frame, verb: &Spoken<'_>, be: bool, carry: &Carry) -> bool {
        let Spoken { sense, form, all, at } = *verb;
        frame.passive = be && form == Form::Past && next_preposition(all, at) == Some("by");
        // "a ball, followed by a dog": without "was" too.
        let followed = sense == Sense::Act(Act::Follow) && matches!(verb.word(self), "followed" | "trailed" | "tailed")
            || verb.word(self) == "overtaken";
        frame.passive |= followed && form == Form::Past && matches!(verb.next(), Some(Chunk::Preposition("by")));
        // "was approached from behind by a bus", "while being overtaken".
        let passed = matches!(verb.word(self), "passed" | "overtaken" | "approached")
            && matches!(sense, Sense::Approach | Sense::Act(Act::Pass));
        let at_once = all[at.saturating_sub(2)..at].iter().any(|placed| matches!(placed.chunk, Chunk::Be));
        if be && form == Form::Past && passed && at_once {
            frame.passive = true;
            if !names_doer(all, at) && !ends_in_by(verb, self) {
                frame.object = frame.who.take();
            }
        }
        if be && verb.is_done_to() {
            frame.object = frame.who.take();
            frame.on = frame.with.take();
            frame.passive = true;
        }
        let first = carry.fresh && !be && carry.subject.is_none() && verb.is_done_to();
        let leading = first && (matches!(verb.next(), Some(Chunk::Preposition("by"))) || sense == Sense::RearEnd);
        frame.passive |= leading;
        let of_subject = frame.object == Some(SUBJECT) || leading && frame.object.is_none();
        if frame.passive && of_subject && frame.who.is_none() && !names_doer(all, at) {
            frame.who = self.struck_by(sense, verb.word(self));
        }
        leading
    }

    /// "stopped before rolling forward and striking it": what led to the contact was done.
    fn went_on_into(&mut self, frame: &Frame, carry: &Carry) {
        let Some(before) = carry.frame.filter(|_| carry.row && frame.is_contact() && frame.form == Form::Ing) else {
            return;
        };
        let before = &mut self.frames[before];
        let same = before.who == frame.who && before.joint == Some(Joint::Before) && before.form == Form::Ing;
        if same && !before.negated {
            before.progress = Progress::Real;
        }
    }

    /// The side and the place that the words of a verb, or those before it, name.
    fn where_to(&self, frame: &mut Frame, verb: &Spoken<'_>, carry: &mut Carry) {
        if frame.side.is_none() && frame.act().is_some_and(sided) {
            frame.side = self.side_in(verb.placed());
        }
        if frame.act() == Some(Act::PullOut) {
            frame.out_of = self.spot_in(verb.placed());
        }
        let comes = matches!(
            frame.act(),
            Some(Act::PullOut | Act::Enter | Act::Follow | Act::Reverse | Act::SetOff | Act::Drift | Act::Turn)
        );
        if comes && frame.out_of.is_none() && frame.who.is_some_and(|who| who != SUBJECT) {
            frame.out_of = carry.out_of.take();
        }
    }

    /// Keeps a frame, and one of the other of two subjects before it. Its number.
    fn push(&mut self, frame: Frame, carry: &Carry) -> usize {
        if let (Some(also), false) = (&carry.also, frame.passive) {
            let twin = Frame { who: Some(also.actor), with: also.piece.clone(), ..frame.clone() };
            self.frames.push(twin);
        }
        if let (Some(who), Some(Act::Hold | Act::Park | Act::Stop)) = (frame.who, frame.act()) {
            self.world.actors[who].parked = true;
        }
        self.frames.push(frame);
        self.frames.len() - 1
    }

    /// What a verb leaves for the chunks behind it.
    fn carry_on(&mut self, verb: &Spoken<'_>, number: usize, leads: bool, carry: &mut Carry) {
        carry.frame = Some(number);
        (carry.fresh, carry.governed, carry.row, carry.negated) = (false, false, false, false);
        (carry.preposition, carry.relation) = (None, None);
        // "an opening to change lanes and get round", "to move left and get by": both are meant.
        let wished = self.frames[number].progress == Progress::Wished && verb.form == Form::Base;
        let side = |placed: &&Placed| matches!(placed.chunk, Chunk::Side(_) | Chunk::Word);
        let skipped = verb.all[verb.at + 1..].iter().take(3).take_while(side).count();
        let next = |ahead: usize| verb.all.get(verb.at + 1 + skipped + ahead).map(|placed| &placed.chunk);
        let both = matches!((next(0), next(1)), (Some(Chunk::Joint(Joint::And)), Some(Chunk::Verb(_, Form::Base))));
        if wished && both && carry.progress.is_none() {
            carry.progress = Some(Progress::Wished);
        }
        let row = carry.progress.is_some() && (matches!(verb.next(), Some(Chunk::Joint(Joint::And))) || wished && both);
        if !(leads || row) {
            carry.progress = None;
        }
        carry.began = leads;
        carry.lead_who = None;
        let placed = verb.placed();
        let last = self.tokens[placed.end - 1].text.as_str();
        match verb.sense {
            _ if self.frames[number].passive && ends_in_by(verb, self) => carry.preposition = Some("by"),
            Sense::ContactMade if last == "between" => carry.preposition = Some("between"),
            // "contact by a cyclist was made".
            Sense::ContactMade if last == "by" => {
                let frame = &mut self.frames[number];
                (frame.form, frame.who, frame.with) = (Form::Past, None, None);
                carry.preposition = Some("by");
            }
            // "fell from a truck": the truck is behind "from".
            // "encroaching into the van's lane": the van does nothing.
            Sense::Act(Act::Drift | Act::LaneChange | Act::Swerve)
                if last == "into"
                    && self
                        .tokens
                        .get(verb.all.get(verb.at + 1).map_or(0, |next| next.end))
                        .is_some_and(|next| next.text == "'s") =>
            {
                carry.preposition = Some("of");
            }
            Sense::Act(Act::Fall | Act::Roll | Act::Enter) if !single(placed) => {
                let known = ["from", "off", "onto", "into", "over", "between", "behind"];
                carry.preposition = known.into_iter().find(|known| *known == last);
            }
            _ => {}
        }
    }
}

/// "a turn lane that opens there": what a road does.
fn is_of_a_road(all: &[Placed], at: usize, word: &str) -> bool {
    const ROADS_DO: [&str; 13] =
        ["run", "ran", "open", "begin", "began", "end", "widen", "split", "curv", "lead", "led", "becom", "became"];
    let Some([.., lane, that]) = all.get(..at) else { return false };
    matches!((&lane.chunk, &that.chunk), (Chunk::Lane(_), Chunk::Relative))
        && ROADS_DO.iter().any(|stem| word.starts_with(stem))
}

/// "was passed by a bus": "by" is a word of the verb.
fn ends_in_by(verb: &Spoken<'_>, parser: &Parser<'_>) -> bool {
    !single(verb.placed()) && parser.tokens[verb.placed().end - 1].text == "by"
}

/// "The driver disengaged it and steered left": who drives it.
fn takes_over(frame: &Frame, verb: &Spoken<'_>, carry: &mut Carry) {
    let by_driver = verb.sense == Sense::TakeOver && frame.person == Some(Occupant::Driver);
    if let Some(subject) = carry.subject.as_mut().filter(|_| by_driver) {
        subject.actor = SUBJECT;
    }
}

/// A finite verb behind a finished relative clause is of the clause around it.
fn leave_relative(verb: &Spoken<'_>, carry: &mut Carry) {
    if carry.relative
        && carry.has_verb
        && matches!(verb.form, Form::Past | Form::Present)
        && !carry.be
        && !carry.after_comma
        && !matches!(verb.chunk_before(), Some(Chunk::Joint(_)))
        && let Some(outer) = carry.outer.take()
    {
        carry.subject = Some(outer);
        (carry.has_verb, carry.relative) = (false, false);
    }
}

/// "The van slid back as the light changed, tapping its bumper": who the sentence is about.
fn go_back(verb: &Spoken<'_>, carry: &mut Carry) {
    let tells = matches!(verb.sense, Sense::Contact | Sense::Push | Sense::RearEnd) && verb.form == Form::Ing;
    if tells && carry.after_comma && !carry.be && carry.stranger && carry.joint.is_some() && carry.main.is_some() {
        (carry.subject, carry.stranger, carry.frame) = (carry.main.clone(), false, None);
    }
}
