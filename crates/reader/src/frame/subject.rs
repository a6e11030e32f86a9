//! Of whom a verb is told, and what its own words name besides.

use super::Frame;
use super::parser::{Carry, Mention, Parser};
use super::row::{Spoken, another_finite};
use crate::chunk::{Chunk, Joint, Placed, Spot};
use crate::lexicon::{Form, Meaning, Relation, Sense};
use crate::token::word;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, KindGroup, LeftRight};

/// Participles that tell how somebody stands, and no act.
const HOW_ONE_STANDS: [&str; 12] = [
    "block", "obstruct", "encroach", "protrud", "occupy", "straddl", "jut", "extend", "stick", "reach", "imped",
    "overhang",
];

/// A noun has so many words at most, with those that place it: "from behind the slow box truck". [tokens]
const NOUN_WORDS: usize = 6;

impl Parser<'_> {
    /// What an adjective says that somebody does: "a passing van", "a left-turning bus".
    pub(super) fn doing(&self, placed: &Placed) -> Option<(Act, Option<LeftRight>)> {
        (placed.first..placed.end).find_map(|at| {
            let act = match self.tokens[at].text.as_str() {
                "passing" | "overtaking" | "splitting" => Act::Pass,
                "merging" => Act::LaneChange,
                "turning" => Act::Turn,
                "reversing" | "backing" => Act::Reverse,
                "crossing" => Act::Cross,
                _ => return None,
            };
            let side = match self.tokens[at.saturating_sub(1)].text.as_str() {
                "left" if act == Act::Turn => Some(LeftRight::Left),
                "right" if act == Act::Turn => Some(LeftRight::Right),
                _ => None,
            };
            Some((act, side))
        })
    }

    /// "the slowly moving AV".
    pub(super) fn rolls(&self, placed: &Placed) -> bool {
        self.tokens[placed.first..placed.end].iter().any(|token| matches!(token.text.as_str(), "moving" | "rolling"))
    }

    /// The side that the words of a verb name: "moved into the left lane".
    pub(super) fn side_in(&self, placed: &Placed) -> Option<LeftRight> {
        // "left its stall" is no side.
        let leaves = usize::from(self.tokens[placed.first].text == "left");
        // "pulled away from the right curb" is away from that side.
        let of_curb =
            |at: usize| self.tokens.get(at + 1).is_some_and(|next| matches!(next.text.as_str(), "curb" | "curbside"));
        (placed.first + leaves..placed.end).filter(|at| !of_curb(*at)).find_map(|at| {
            match self.tokens[at].text.as_str() {
                "left" | "leftmost" => Some(LeftRight::Left),
                "right" | "rightmost" => Some(LeftRight::Right),
                _ => None,
            }
        })
    }

    /// The place that the words of a verb name: "exited its parking stall".
    pub(super) fn spot_in(&self, placed: &Placed) -> Option<Spot> {
        self.tokens[placed.first..placed.end].iter().find_map(|token| match token.text.as_str() {
            // "left a row of parked cars".
            "stall" | "stalls" | "space" | "spot" | "carport" | "row" => Some(Spot::Stall),
            "driveway" | "lot" | "garage" | "alley" | "station" => Some(Spot::Driveway),
            "curb" => Some(Spot::Curb),
            _ => None,
        })
    }

    /// Who struck the subject vehicle where nobody is named: "was rear-ended", "was broadsided".
    pub(super) fn struck_by(&mut self, sense: Sense, word: &str) -> Option<Actor> {
        let rear = sense == Sense::RearEnd;
        let by_vehicle = rear || ["broadside", "sideswipe"].iter().any(|stem| word.starts_with(stem));
        if !by_vehicle {
            return None;
        }
        let actor = self.world.striker(rear);
        if rear {
            self.world.actors[actor].place(Relation::Behind, self.sentence);
        }
        Some(actor)
    }

    /// Verbs whose subject is named only now: "While stopped, the van ...".
    pub(super) fn settle(&mut self, actor: Actor, carry: &mut Carry) {
        let new = self.is_somebody_new(actor, carry);
        let ready = if self.waits_on(carry) { Vec::new() } else { std::mem::take(&mut carry.pending) };
        for pending in ready {
            let dangles = new && self.is_told_of_topic(&self.frames[pending], actor);
            if self.frames[pending].passive {
                self.frames[pending].object = Some(actor);
            } else {
                self.tell_of(pending, if dangles { self.world.topic } else { actor });
            }
        }
    }

    /// "While stopped at a light, a man began to cross": of somebody new it is not told.
    fn is_somebody_new(&self, actor: Actor, carry: &Carry) -> bool {
        if actor == SUBJECT || carry.main.is_some() || carry.inverts {
            return false;
        }
        let known = &self.world.actors[actor];
        // Only the headline has named it so far.
        let named_only = !known.acted && self.world.topic == SUBJECT && known.mentions == 2;
        known.mentions == 1 || named_only
    }

    /// Whether who is named here is not yet the one of whom the verbs before are told.
    fn waits_on(&self, carry: &Carry) -> bool {
        // "Stopped because traffic had not cleared, the AV was hit": the AV.
        let inner = carry.joint.is_some_and(|joint| matches!(joint, Joint::Because))
            && !carry.after_comma
            && carry.pending.iter().all(|number| self.frames[*number].clause < carry.clause);
        // "Letting a car go first, the AV drove on": the AV lets it.
        let lets = !carry.after_comma
            && carry.pending.last().is_some_and(|number| {
                let waiting = &self.frames[*number];
                waiting.sense == Sense::Yield && self.tokens[waiting.first].text == "letting"
            });
        inner || lets
    }

    /// Whether a verb before somebody new is told of whom the story is about.
    fn is_told_of_topic(&self, waiting: &Frame, actor: Actor) -> bool {
        // "Stopped behind it, a van set off": nobody stands behind itself.
        let by_topic = waiting.relations.iter().any(|(_, to)| *to == Some(self.world.topic));
        let stands = waiting.state && matches!(waiting.sense, Sense::Act(Act::Hold) | Sense::Parked) && !by_topic;
        // "It began to cross. While crossing, a van ...": who did so before.
        let goes_on = waiting.form == Form::Ing
            && waiting.act().is_some()
            && self.frames.iter().any(|before| {
                before.sentence < waiting.sentence
                    && before.who == Some(self.world.topic)
                    && !before.negated
                    && before.act() == waiting.act()
                    && !matches!(before.act(), Some(Act::Follow))
            });
        // "While passing the driveway, a van ...": who passes it is told before.
        let passes = waiting.form == Form::Ing
            && self.world.topic == SUBJECT
            && matches!(waiting.sense, Sense::Act(Act::Pass | Act::Enter) | Sense::Approach)
            && waiting.object != Some(SUBJECT)
            && !self.comes_so(waiting)
            && !waiting.relations.iter().any(|(_, to)| *to == Some(SUBJECT));
        stands || goes_on || passes || self.drives_in_lane(waiting, actor)
    }

    /// "While driving in its lane, a man ...": who walks has none.
    fn drives_in_lane(&self, waiting: &Frame, actor: Actor) -> bool {
        let lane = self.tokens[waiting.first..].iter().take(NOUN_WORDS).any(|token| token.text == "lane");
        let on_foot = self.world.actors[actor].kind.is_some_and(|kind| kind.group() == KindGroup::OnFoot);
        let verb = self.tokens[waiting.first].text.as_str();
        let driven = ["driv", "travel", "proceed"].iter().any(|stem| verb.starts_with(stem));
        lane && on_foot && driven && self.world.topic == SUBJECT
    }

    /// Who it was that a verb before the name told of: the places, the lane and the direction that it told are those of that one.
    fn tell_of(&mut self, pending: usize, who: Actor) {
        self.frames[pending].who = Some(who);
        let places: Vec<Relation> = self.frames[pending].relations.iter().map(|(place, _)| *place).collect();
        if who != SUBJECT && self.comes_so(&self.frames[pending]) {
            places.into_iter().for_each(|place| self.note(who, place));
        }
        // "Driving in the left lane, it ...".
        if let Some(lane) = self.frames[pending].lane.filter(|(_, first, _)| self.stands_in(*first)) {
            self.world.actors[who].lane.get_or_insert(lane);
        }
        // "While turning left from southbound Oak Street, it ...".
        if let (Some(heading), false) = (self.frames[pending].heading, self.frames[pending].onto) {
            self.world.actors[who].heading.get_or_insert(heading);
        }
    }

    /// "in the left lane": no way into one.
    fn stands_in(&self, lane: usize) -> bool {
        let before = self.tokens[lane.saturating_sub(3)..lane].iter().rev().map(|token| token.text.as_str());
        before
            .clone()
            .find(|word| matches!(*word, "in" | "within" | "using" | "into" | "onto" | "to" | "from" | "toward" | "of"))
            .is_some_and(|word| matches!(word, "in" | "within" | "using"))
    }

    /// "Approaching from behind, a van", "Overtaking on the left, a van", "While passing, a van", told of one that stands: who is named next
    /// comes so.
    fn comes_so(&self, waiting: &Frame) -> bool {
        let from = |relation: Relation| !matches!(relation, Relation::Ahead | Relation::Beside | Relation::Same);
        let comes = matches!(waiting.sense, Sense::Approach | Sense::Act(Act::Pass | Act::Enter | Act::Follow));
        let placed =
            waiting.relations.iter().any(|(relation, to)| from(*relation) && to.is_none_or(|to| to == SUBJECT));
        let at_once = matches!(self.tokens[waiting.first + 1].text.as_str(), "on" | "to" | "from");
        let aside = waiting.act() == Some(Act::Pass) && waiting.object.is_none() && waiting.side.is_some() && at_once;
        let mut told = self.frames.iter().rev().filter(|frame| frame.who == Some(SUBJECT) && frame.happened());
        let stands = told
            .find(|frame| frame.act().is_some())
            .is_some_and(|frame| frame.act().is_some_and(Act::rests) && frame.sentence < self.sentence);
        comes && (placed || aside) || stands && waiting.act() == Some(Act::Pass) && waiting.object.is_none()
    }

    /// Of whom a verb is told.
    pub(super) fn who_of(&self, verb: &Spoken<'_>, carry: &Carry, purpose: bool) -> Option<Mention> {
        if carry.reduced && verb.form == Form::Past && !carry.be {
            return carry.subject.clone();
        }
        if carry.pushed && purpose {
            return carry.last.clone();
        }
        if carry.began && carry.lead_who.is_some() {
            return carry.lead_who.clone();
        }
        let of_row = if verb.form == Form::Ing { self.of_participle_before(carry) } else { None };
        of_row
            .or_else(|| self.of_participle(verb.sense, verb.form, verb.placed(), carry))
            .or_else(|| self.of_governed(verb, carry))
            .or_else(|| self.of_described(verb, carry))
            .or_else(|| self.faces_so(verb, carry))
            .or_else(|| self.of_striker(verb, carry))
            .or_else(|| self.of_object(verb, carry, purpose))
            .or_else(|| carry.subject.clone())
    }

    /// "a van braking too late and striking", "a van traveling west attempting to turn": the second participle is of who does the first.
    fn of_participle_before(&self, carry: &Carry) -> Option<Mention> {
        let before = carry.frame.map(|frame| &self.frames[frame]).filter(|before| before.form == Form::Ing)?;
        if let Some(actor) = before.who.filter(|_| carry.row && !carry.be) {
            return Some(Mention { actor, piece: None, person: None, end: before.end });
        }
        let at_once = !(carry.be || carry.fresh || carry.after_comma || carry.began);
        let describes = before.described && !before.is_contact();
        carry.last.clone().filter(|last| at_once && describes && before.who == Some(last.actor))
    }

    /// "because of the cars blocking it": a participle right behind a governed noun, where the clause is about nobody.
    fn of_governed(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        let open = carry.subject.is_none()
            && verb.form == Form::Ing
            && !carry.be
            && carry.governed
            && !carry.fresh
            && !carry.after_comma;
        let near = |last: &Mention| verb.placed().first <= last.end + 1 && self.world.actors[last.actor].acts();
        carry.last.clone().filter(|last| open && near(last))
    }

    /// "yielded to a truck, which had no lights on, traveling south": the truck.
    fn of_described(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        let described = carry.described.as_ref().filter(|_| carry.after_comma && verb.form == Form::Ing)?;
        let of_other = carry.main.as_ref().is_none_or(|main| main.actor != described.actor);
        let moves = matches!(
            verb.sense,
            Sense::Act(Act::Follow | Act::Turn | Act::UTurn | Act::Park | Act::Reverse) | Sense::Sided(Act::Turn, _)
        );
        (verb.sense == Sense::Face || (of_other && moves)).then(|| described.clone())
    }

    /// "a truck stopped facing west", "stopped in a queue of traffic facing west": who stands there faces so.
    fn faces_so(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        let faces = verb.sense == Sense::Face && verb.form == Form::Ing && !carry.be;
        let frame = carry.frame.map(|frame| &self.frames[frame]).filter(|_| faces)?;
        let first = verb.placed().first;
        let stands_in_queue = |last: &Mention| {
            frame.act().is_some_and(Act::stands)
                && carry.governed
                && last.end == first
                && self.is_in_queue(frame.end, last.end)
        };
        let so = frame.state && frame.end == first || carry.last.as_ref().is_some_and(stands_in_queue);
        let actor = frame.who.filter(|_| so)?;
        Some(Mention { actor, piece: None, person: None, end: first })
    }

    /// "was struck by a van, traveling east": the van.
    fn of_striker(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        let struck = carry.frame.map(|frame| &self.frames[frame]).filter(|frame| frame.passive)?;
        let behind_comma = carry.after_comma && verb.form == Form::Ing;
        carry.last.clone().filter(|last| behind_comma && struck.who == Some(last.actor))
    }

    /// "yielding to a van stopped in the lane", "because of the cars parked there": a participle behind an object belongs to the object.
    fn of_object(&self, verb: &Spoken<'_>, carry: &Carry, purpose: bool) -> Option<Mention> {
        let (form, placed) = (verb.form, verb.placed());
        // Right behind the noun.
        let behind = carry.governed && carry.last.as_ref().is_some_and(|last| last.end == placed.first);
        let adjacent = carry.last.is_some() && !carry.after_comma && (!carry.fresh || behind);
        // "by crossing the line": who does the rest.
        let by = carry.preposition == Some("by");
        let participle = matches!(form, Form::Ing | Form::Past) && !carry.be && !purpose && !carry.began && !by;
        // "The van ahead of it stopped": the van, unless it has a verb of its own behind.
        let waits = carry.subject.is_some() && !carry.has_verb && carry.joint.is_none_or(|joint| joint != Joint::And);
        let of_place = carry.governed
            && carry.frame.is_none()
            && form == Form::Past
            && (!waits || another_finite(verb.all, verb.at));
        let of_object = adjacent
            && participle
            && (carry.has_verb || of_place)
            && self.touches_last(verb.sense, form, placed, carry);
        carry.last.clone().filter(|_| of_object)
    }

    /// Whether the noun that ends here stands behind "from behind", "from between".
    fn comes_from(&self, end: usize) -> bool {
        let words: Vec<&str> =
            self.tokens[end.saturating_sub(NOUN_WORDS)..end].iter().map(|token| token.text.as_str()).collect();
        words.windows(2).any(|pair| matches!(pair, ["from", "behind" | "between" | "under" | "underneath"]))
    }

    /// "directly towards the AV", "at the vehicle", behind a participle.
    fn goes_to_subject(&self, at: usize) -> bool {
        let adverb = usize::from(
            word(self.tokens, at).ends_with("ly") || matches!(word(self.tokens, at), "right" | "straight" | "back"),
        );
        let at = at + adverb;
        let article = usize::from(word(self.tokens, at + 1) == "the");
        let subject = |at: usize| {
            let named = self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Subject));
            named.is_some() || word(self.tokens, at) == crate::lexicon::COMPANY && word(self.tokens, at + 1) == "av"
        };
        matches!(word(self.tokens, at), "toward" | "towards") && subject(at + 1 + article)
    }

    /// Participles behind a noun that say by their own words whose they are.
    fn of_participle(&self, sense: Sense, form: Form, placed: &Placed, carry: &Carry) -> Option<Mention> {
        let last = carry.last.as_ref().filter(|_| form == Form::Ing && !carry.be)?;
        // "A wheel came from behind a truck rolling over": who came from there.
        let over = matches!(sense, Sense::Act(Act::Roll | Act::Fall | Act::Cross));
        if let Some(subject) = carry.subject.as_ref().filter(|_| over && last.end == placed.first)
            && self.comes_from(last.end)
        {
            return Some(subject.clone());
        }
        // "came up behind it driving fast": who comes does.
        let comes = carry.frame.map(|frame| &self.frames[frame]).filter(|frame| {
            let moves = matches!(frame.sense, Sense::Approach | Sense::Act(Act::Follow));
            moves && sense == Sense::Act(Act::Follow) && last.actor == SUBJECT && !carry.after_comma
        });
        if let Some(actor) = comes.and_then(|frame| frame.who).filter(|who| *who != SUBJECT) {
            return Some(Mention { actor, piece: None, person: None, end: placed.first });
        }
        let other = last.actor != SUBJECT && !carry.began;
        // "steered in reaction to a van in the next lane cutting in".
        if other && !carry.after_comma && self.is_reacted_to(last.end, placed.first) {
            return Some(last.clone());
        }
        // "braked for a van cutting in, apparently trying to turn": nobody guesses at what it does itself.
        let guessed = placed.first.checked_sub(1).is_some_and(|at| {
            matches!(self.tokens[at].text.as_str(), "apparently" | "presumably" | "seemingly" | "likely" | "possibly")
        });
        let before = carry.frame.map(|frame| &self.frames[frame]).filter(|frame| frame.form == Form::Ing);
        if let Some(actor) = before.and_then(|frame| frame.who).filter(|who| guessed && *who != SUBJECT) {
            return Some(Mention { actor, piece: None, person: None, end: placed.first });
        }
        // "braked for a man in the road, running towards it": nobody runs towards itself.
        let of_subject = carry.subject.as_ref().is_some_and(|subject| subject.actor == SUBJECT);
        if other && of_subject && self.world.actors[last.actor].acts() && self.goes_to_subject(placed.end) {
            return Some(last.clone());
        }
        // "the driver, seeing the van drifting over": whom the driver sees.
        let seen = carry.frame.is_some_and(|frame| {
            let before = &self.frames[frame];
            (before.sense, before.form, before.object) == (Sense::See, Form::Ing, Some(last.actor))
        });
        (other && seen && !carry.after_comma && last.end == placed.first).then(|| last.clone())
    }

    /// Whether the noun that ends here stands behind "in reaction to", and nothing parts it from the participle: to what it does.
    fn is_reacted_to(&self, end: usize, participle: usize) -> bool {
        let ends =
            |at: usize| matches!(word(self.tokens, at), "," | "." | "and" | "that" | "which" | "was" | "when" | "as");
        let noun = end.saturating_sub(2 * NOUN_WORDS)..end;
        let to = noun.rev().take_while(|at| !ends(*at)).find(|at| word(self.tokens, *at) == "to");
        let reacts = to.is_some_and(|to| {
            to > 0
                && matches!(
                    word(self.tokens, to - 1),
                    "reaction" | "response" | "reacting" | "responding" | "due" | "owing"
                )
        });
        reacts && !(end..participle).any(ends)
    }

    /// "with traffic still waiting ahead, a van struck it": of the noun behind "with".
    pub(super) fn beside(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        if verb.form != Form::Ing || carry.be || carry.began {
            return None;
        }
        let touches = carry.frame.is_some_and(|frame| self.frames[frame].is_contact());
        let word = |at: &usize| matches!(verb.all[*at].chunk, Chunk::Word);
        let noun = (0..verb.at).rev().take(3).find(|at| !word(at))?;
        let with = noun.checked_sub(1).is_some_and(|at| matches!(verb.all[at].chunk, Chunk::Preposition("with")));
        let named = carry.last.as_ref().filter(|last| last.end == verb.all[noun].end && last.piece.is_none())?;
        (with && !touches && self.world.actors[named.actor].acts()).then(|| named.clone())
    }

    /// "came upon a truck stopped in the road, blocking two lanes, and reaching into its own": of the truck, and whether it stands so.
    pub(super) fn stands_so(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<(Mention, bool)> {
        if verb.form != Form::Ing || carry.be || !(carry.after_comma || carry.row || carry.joint.is_some()) {
            return None;
        }
        let so = |word: &str| HOW_ONE_STANDS.iter().any(|stem| word.starts_with(stem));
        let last = self.frames.last().filter(|frame| frame.sentence == self.sentence)?;
        let who = last.who.filter(|who| *who != SUBJECT)?;
        let stood = last.state && matches!(last.sense, Sense::Act(Act::Hold) | Sense::Parked)
            || last.form == Form::Ing && last.sense == Sense::Other && so(&self.tokens[last.first].text);
        // "a sweeper traveling along the curb, encroaching into its lane".
        let moves = last.form == Form::Ing && last.act() == Some(Act::Follow);
        let apart = carry.subject.as_ref().is_some_and(|subject| subject.actor != who);
        // "partially encroaching": so it drives along, and does nothing.
        let stood = stood
            || moves
                && self.tokens[verb.placed().first - 1..verb.placed().first]
                    .iter()
                    .any(|token| matches!(token.text.as_str(), "partially" | "partly" | "slightly"));
        let mention = Mention { actor: who, piece: None, person: None, end: last.end };
        // "a pickup traveling along, towing a boat".
        let tows = moves && verb.sense == Sense::Tow;
        ((stood || moves) && apart && (so(verb.word(self)) || tows)).then_some((mention, stood && !tows))
    }

    /// "came upon a truck, which carried a pole, stopped in the road": of the truck. "It yielded to a truck, which turned, stopped, and
    /// waited": a row of what it did itself.
    pub(super) fn stood_as_found(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        let stops = matches!(verb.sense, Sense::Act(Act::Stop | Act::Hold | Act::Park) | Sense::Parked);
        if !stops || verb.form != Form::Past || carry.be || carry.row || !carry.after_comma {
            return None;
        }
        let found = self.frames.iter().rev().find(|frame| frame.sentence == self.sentence && !frame.described)?;
        let described = carry.described.as_ref().filter(|described| found.object == Some(described.actor))?;
        let of_other = carry.main.as_ref().is_some_and(|main| main.actor != described.actor);
        let row = verb.all[verb.at + 1..].windows(2).any(|pair| {
            matches!(pair[0].chunk, Chunk::Joint(Joint::And)) && matches!(pair[1].chunk, Chunk::Verb(..) | Chunk::Word)
        });
        (of_other && !row).then(|| described.clone())
    }

    /// "stopped for a procession crossing the street", "behind a contraption turning left": of a noun that nobody knows.
    pub(super) fn is_of_unknown(&self, verb: &Spoken<'_>, carry: &Carry) -> bool {
        let moves =
            matches!(verb.sense, Sense::Act(_) | Sense::Sided(..) | Sense::ReverseContact) && verb.form == Form::Ing;
        let Some([.., governs, article, noun]) = verb.all.get(..verb.at) else { return false };
        let word = |placed: &Placed| self.tokens[placed.first].text.as_str();
        let plain = matches!(noun.chunk, Chunk::Word)
            && matches!(article.chunk, Chunk::Word)
            && matches!(word(article), "a" | "an");
        let place = super::adverbs::PLACES.contains(&word(noun))
            || self.tokens[noun.first].capital
            || word(noun).ends_with("ly");
        let of = match governs.chunk {
            Chunk::Preposition(preposition) => matches!(preposition, "for" | "to" | "around"),
            Chunk::Relation(relation) => matches!(relation, Relation::Behind | Relation::Ahead | Relation::Beside),
            _ => false,
        };
        // "in an alley running between two streets", "on a road going past a school".
        let runs = matches!(self.tokens[verb.placed().first].text.as_str(), "running" | "going" | "coming" | "leading");
        let road = matches!(noun.chunk, Chunk::Spot(_))
            || matches!(noun.chunk, Chunk::Word)
                && matches!(word(noun), "road" | "street" | "ramp" | "path" | "drive" | "way");
        let way = matches!(verb.next(), Some(Chunk::Compass(_)));
        let at_once = !carry.be && !carry.after_comma && noun.end == verb.placed().first;
        moves && plain && of && !place && at_once || runs && road && !way && at_once && verb.form == Form::Ing
    }

    /// "A van struck it while turning", where it alone was told to turn: it does.
    pub(super) fn was_turning(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        let turns = verb.form == Form::Ing && matches!(verb.sense, Sense::Act(Act::Turn) | Sense::Sided(Act::Turn, _));
        let inner = carry.joint == Some(Joint::While) && carry.fresh && !carry.be && turns;
        let struck =
            self.frames.last().filter(|frame| inner && frame.sentence == self.sentence && frame.is_contact())?;
        let other = struck.who.filter(|who| *who != SUBJECT && struck.object == Some(SUBJECT))?;
        let side = if let Sense::Sided(_, side) = verb.sense { Some(side) } else { None };
        let turned = |who: Actor| {
            self.frames.iter().any(|frame| {
                let alike = side.is_none() || frame.side.is_none() || frame.side == side;
                frame.who == Some(who) && frame.act() == Some(Act::Turn) && !frame.negated && alike
            })
        };
        let own = turned(SUBJECT) && !turned(other);
        own.then_some(Mention { actor: SUBJECT, piece: None, person: None, end: verb.placed().first })
    }

    /// "struck it in passing", "hit its front in backing up": who strikes does.
    pub(super) fn did_so_in(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        let frame = carry.frame.map(|frame| &self.frames[frame]).filter(|frame| frame.is_contact() && !carry.be)?;
        let before = verb.placed().first.checked_sub(1).map_or("", |at| self.tokens[at].text.as_str());
        // "a gap in passing traffic".
        let thing = matches!(verb.next(), Some(Chunk::Noun(_) | Chunk::Piece(_)));
        let actor = frame.who.filter(|_| matches!(before, "in" | "upon") && verb.form == Form::Ing && !thing)?;
        Some(Mention { actor, piece: None, person: None, end: verb.placed().first })
    }

    /// "hit a van parked at the curb", "struck the rear of it, stopped at a light": who was struck stood. "Struck it, stopped, and left" is a
    /// row of what the other one did.
    pub(super) fn stood_when_struck(&self, verb: &Spoken<'_>, carry: &Carry) -> Option<Mention> {
        let stands = matches!(verb.sense, Sense::Act(Act::Stop | Act::Hold | Act::Park) | Sense::Parked);
        let frame =
            carry.frame.map(|frame| &self.frames[frame]).filter(|frame| frame.is_contact() && stands && !carry.be)?;
        let behind = verb.all[verb.at + 1..].iter().map(|placed| &placed.chunk);
        let row = behind.clone().any(|chunk| matches!(chunk, Chunk::Comma | Chunk::Joint(Joint::And)));
        let named = |placed: &Placed| matches!(placed.chunk, Chunk::Noun(_) | Chunk::Piece(_));
        let at_once = match verb.all.get(..verb.at)? {
            [.., noun] if named(noun) => true,
            [.., noun, comma] => named(noun) && matches!(comma.chunk, Chunk::Comma) && !row,
            _ => false,
        };
        let form = verb.form == Form::Past || verb.form == Form::Ing && verb.sense == Sense::Act(Act::Hold);
        let actor = frame.object.filter(|object| at_once && form && !frame.passive && frame.who != Some(*object))?;
        Some(Mention { actor, piece: None, person: None, end: verb.placed().first })
    }

    /// "in a queue of traffic", "in a line of cars".
    fn is_in_queue(&self, first: usize, end: usize) -> bool {
        let words: Vec<&str> = self.tokens[first.min(end)..end].iter().map(|token| token.text.as_str()).collect();
        matches!(words.as_slice(), ["in", "a" | "the", "queue" | "line", "of", ..])
    }

    /// Whether the noun named last stands right before.
    fn touches_last(&self, sense: Sense, form: Form, placed: &Placed, carry: &Carry) -> bool {
        let Some(last) = &carry.last else { return false };
        // The subject of the clause takes its own verbs; only objects are described by participles.
        if carry.subject.as_ref() == Some(last) {
            return false;
        }
        // Things are described by few verbs, and nobody by one that stands apart.
        let between = self.tokens.get(last.end..placed.first).unwrap_or_default();
        let place = carry.governed
            || carry.frame.is_some_and(|frame| {
                matches!(self.frames[frame].sense, Sense::Yield | Sense::See | Sense::Approach | Sense::Act(Act::Slow))
            });
        let describes =
            !matches!(sense, Sense::Push | Sense::Damage | Sense::Contact | Sense::RearEnd | Sense::TakeOver);
        let near = (between.len() <= 2 || form == Form::Past || (place && describes && between.len() <= 8))
            && between.iter().all(|token| !matches!(token.text.as_str(), "was" | "and" | "then" | ","));
        let known = &self.world.actors[last.actor];
        let lively = (known.acts() && (!known.several || between.is_empty()))
            || matches!(
                sense,
                Sense::Act(Act::Fall | Act::Roll | Act::Drift | Act::Park) | Sense::Other | Sense::Parked
            )
            // "a sign lying down in the lane".
            || sense == Sense::Act(Act::Hold) && form == Form::Ing && between.is_empty();
        if !near || !lively {
            return false;
        }
        // "and then for a cyclist approaching from behind": right behind the noun.
        // "alongside cars parked at the curb".
        let stands =
            matches!(sense, Sense::Act(Act::Park | Act::Stop | Act::Hold) | Sense::Parked) && form == Form::Past;
        let bare = carry.frame.is_none() && carry.governed && between.is_empty() && (form == Form::Ing || stands);
        bare || carry.frame.is_some_and(|frame| {
            let frame = &self.frames[frame];
            frame.object == Some(last.actor)
                || frame.relations.iter().any(|(_, actor)| *actor == Some(last.actor))
                || carry.governed
        })
    }
}
