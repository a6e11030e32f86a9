//! Verbs: the longest phrase of the lexicon that is one, unless the words around it make it a noun, an adjective or a place.
//!
//! A new rule of English that says "here it is no verb" goes into [`NO_VERB`].

use super::{Chunk, Chunker, DETERMINERS, Joint, Placed};
use crate::lexicon::{Form, Found, Meaning, Part, Relation, Sense};
use crate::token::TokenKind;
use recrash_model::account::{Act, KindGroup, LeftRight};

/// A phrase that the lexicon knows as a verb, and what stands around it.
struct Candidate<'a> {
    chunker: &'a Chunker<'a>,
    /// Chunks before it.
    before: &'a [Placed],
    sense: Sense,
    form: Form,
    /// First token.
    at: usize,
    /// Tokens that it takes.
    length: usize,
    /// The word before it in its sentence.
    word_before: &'a str,
}

/// A phrase is no verb where one of these says so, whichever it is: their order does not matter.
const NO_VERB: [fn(&Candidate<'_>) -> bool; 24] = [
    |verb| verb.is_of_a_device(),
    |verb| verb.is_determined(),
    |verb| verb.is_described(),
    |verb| verb.is_turn_of_a_side(),
    |verb| verb.ends_a_prepositional_phrase(),
    |verb| verb.is_a_mark(),
    |verb| verb.is_one_of_maneuvers(),
    |verb| verb.is_bare_turn(),
    |verb| verb.is_signaled(),
    |verb| verb.is_of_a_head(),
    |verb| verb.is_a_parking_place(),
    |verb| verb.is_of_parking(),
    |verb| verb.is_of_a_lane(),
    |verb| verb.is_the_back(),
    |verb| verb.is_of_a_pace_or_street(),
    |verb| verb.is_a_speed(),
    |verb| verb.is_a_side_moved_to(),
    |verb| verb.is_an_opening(),
    |verb| verb.is_cross_traffic(),
    |verb| verb.is_a_crossing(),
    |verb| verb.is_a_sliding_door(),
    |verb| verb.is_contacts_or_stop_sign(),
    |verb| verb.is_mounted_on_a_vehicle(),
    |verb| verb.is_after_a_drop_off(),
];

impl Candidate<'_> {
    fn word(&self, ahead: usize) -> &str {
        self.chunker.text(self.at + ahead)
    }

    /// The word that stands `ahead` words behind the phrase.
    fn behind(&self, ahead: usize) -> &str {
        self.chunker.text(self.at + self.length + ahead)
    }

    fn last_word(&self) -> &str {
        self.chunker.text(self.at + self.length - 1)
    }

    fn is_single(&self) -> bool {
        self.length == 1
    }

    /// Behind an article: "the stop", "a lane change".
    fn is_determined(&self) -> bool {
        // "whose brakes had failed".
        if self.word_before == "whose" && self.is_single() {
            return true;
        }
        let article = DETERMINERS.contains(&self.word_before) && !matches!(self.word_before, "that" | "this");
        article && (self.form == Form::Base || self.is_single())
    }

    /// Behind an adjective: "initial contact", "a complete stop".
    fn is_described(&self) -> bool {
        let adjective = matches!(
            self.word_before,
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
        adjective && self.form == Form::Base && self.is_single()
    }

    /// "in the left turning lane", "after its right turn".
    fn is_turn_of_a_side(&self) -> bool {
        matches!(self.word_before, "left" | "right")
            && matches!(self.word(0), "turn" | "turns" | "turning")
            && self.is_single()
    }

    /// A bare noun at the end of a prepositional phrase: "in contact", "under braking", "without impact".
    fn ends_a_prepositional_phrase(&self) -> bool {
        let governed =
            matches!(self.before.last().map(|placed| &placed.chunk), Some(Chunk::Preposition(word)) if *word != "to");
        governed && self.form == Form::Base && self.is_single()
    }

    /// "minor scratches to both vehicles".
    fn is_a_mark(&self) -> bool {
        matches!(self.word(0), "scratches" | "scrapes" | "dents" | "marks" | "bumps" | "dings" | "scuffs")
            && matches!(
                self.word_before,
                "minor"
                    | "slight"
                    | "light"
                    | "small"
                    | "some"
                    | "surface"
                    | "visible"
                    | "cosmetic"
                    | "superficial"
                    | "few"
                    | "multiple"
                    | "several"
                    | "paint"
                    | "and"
                    | "of"
                    | "with"
                    | "had"
            )
    }

    /// "with its engine running", "its blinker going".
    fn is_of_a_device(&self) -> bool {
        let device =
            matches!(self.word_before, "engine" | "motor" | "blinker" | "blinkers" | "lights" | "flashers" | "hazards")
                || matches!(self.word_before, "signal" | "siren" | "sirens" | "wipers" | "radio" | "meter");
        device && self.is_single() && matches!(self.word(0), "running" | "going" | "working")
    }

    /// "during the right turn".
    fn is_bare_turn(&self) -> bool {
        matches!(self.word(0), "left" | "right")
            && self.word(1) == "turn"
            && self.length == 2
            && self.form == Form::Base
    }

    /// "without using turn signals", "its left blinker to turn": no turn yet.
    fn is_signaled(&self) -> bool {
        let lamp = |word: &str| {
            matches!(
                word,
                "signal" | "signals" | "indicator" | "indicators" | "blinker" | "blinkers" | "lamp" | "lamps"
            )
        };
        let to = self.word_before == "to" && self.at >= 2 && lamp(self.chunker.text(self.at - 2));
        self.word(0) == "turn" && to || self.last_word() == "turn" && lamp(self.behind(0))
    }

    /// "whose head was turned left", "turned his head": who drives looks there.
    fn is_of_a_head(&self) -> bool {
        let passive =
            self.at >= 2 && self.chunker.text(self.at - 2) == "head" && matches!(self.word_before, "was" | "is");
        let own = matches!(self.behind(0), "his" | "her" | "their") && self.behind(1) == "head";
        self.word(0).starts_with("turn") && (passive || own || self.word_before == "head")
    }

    /// "after a series of maneuvers", "a lane for left turn maneuvers".
    fn is_one_of_maneuvers(&self) -> bool {
        let counted = self.word(0) == "maneuvers"
            && matches!(
                self.word_before,
                "few" | "several" | "some" | "multiple" | "many" | "various" | "more" | "such"
            );
        matches!(self.word(0), "maneuver" | "maneuvers") && self.is_single() && (counted || self.is_kind_of_maneuver())
    }

    fn is_kind_of_maneuver(&self) -> bool {
        matches!(self.word_before, "of" | "turn" | "turning" | "change" | "parking" | "backing" | "reversing")
    }

    /// "in a parking lot", "a parking space".
    fn is_a_parking_place(&self) -> bool {
        // "an area designated for parking".
        let designated = self.word_before == "for" && self.is_single();
        self.word(0) == "parking" && (designated || self.chunker.spot(self.at).is_some())
    }

    /// "its rear parking sensor", "in a parallel parking space", "from a parked position".
    fn is_of_parking(&self) -> bool {
        let named = matches!(self.last_word(), "parking" | "parked")
            && matches!(
                self.behind(0),
                "sensor"
                    | "sensors"
                    | "brake"
                    | "light"
                    | "lights"
                    | "camera"
                    | "lot"
                    | "garage"
                    | "structure"
                    | "area"
                    | "space"
                    | "spot"
                    | "stall"
                    | "bay"
                    | "lane"
                    | "meter"
                    | "position"
                    | "attendant"
                    | "enforcement"
                    | "aisle"
            );
        named && (self.word(0) != "parking" || self.word_before != "was") && self.length <= 2
    }

    /// "the driving lane".
    fn is_of_a_lane(&self) -> bool {
        // "in autonomous driving mode", "its driving system".
        let system = self.word(0) == "driving"
            && self.is_single()
            && matches!(
                self.word(1),
                "mode" | "system" | "systems" | "task" | "tasks" | "function" | "software" | "stack" | "platform"
            );
        system
            || matches!(self.word(0), "traveling" | "driving" | "turning" | "merging")
                && matches!(self.word(1), "lane" | "lanes")
    }

    /// "it moved back into its lane", "back pain".
    fn is_the_back(&self) -> bool {
        self.word(0) == "back"
            && matches!(self.word(1), "to" | "onto" | "into" | "of" | "pain" | "injury")
            && self.is_single()
    }

    /// "at walking pace", "from crossing streets".
    fn is_of_a_pace_or_street(&self) -> bool {
        self.form == Form::Ing
            && self.is_single()
            && matches!(self.word(1), "pace" | "speed" | "speeds" | "street" | "streets" | "roads")
    }

    /// "at slow speeds".
    fn is_a_speed(&self) -> bool {
        let how = matches!(self.word_before, "slow" | "low" | "high" | "reduced" | "moderate" | "excessive" | "slower");
        let adjusts = self.at >= 2 && matches!(self.chunker.text(self.at - 2), "to" | "at" | "of" | "with");
        self.word(0) == "speeds" && (how || adjusts || matches!(self.word_before, "at" | "to" | "of"))
    }

    /// "moved left without signaling".
    fn is_a_side_moved_to(&self) -> bool {
        let moves = ["mov", "veer", "turn", "steer", "swerv", "merg", "drift", "shift", "slid", "swung", "pull"];
        self.word(0) == "left" && moves.iter().any(|stem| self.word_before.starts_with(stem))
    }

    /// "behind a driveway opening".
    fn is_an_opening(&self) -> bool {
        self.word(0) == "opening"
            && self.is_single()
            && matches!(self.word_before, "driveway" | "gate" | "fence" | "median" | "wall" | "an" | "the")
    }

    /// "the cross traffic".
    fn is_cross_traffic(&self) -> bool {
        self.word(0) == "cross" && matches!(self.word(1), "traffic" | "street" | "road" | "walk")
    }

    /// "at a railroad crossing", "a pedestrian crossing sign". "For a deer crossing the road" is one.
    fn is_a_crossing(&self) -> bool {
        let named = matches!(self.word_before, "railroad" | "railway" | "pedestrian" | "school" | "deer" | "cattle");
        // "at an unprotected crossing", "for the same crossing".
        let plain = matches!(
            self.word_before,
            "unprotected" | "unmarked" | "marked" | "level" | "grade" | "controlled" | "same"
        ) && self.is_single();
        if self.word(0) == "crossing" && plain {
            return true;
        }
        // "At the Oak Street crossing it stopped".
        let street =
            matches!(self.word_before, "street" | "avenue" | "road" | "st" | "ave" | "rd" | "boulevard" | "[xxx]");
        if self.word(0) == "crossing"
            && street
            && self.is_single()
            && matches!(self.word(1), "it" | "they" | "," | "." | "")
        {
            return true;
        }
        self.word(0) == "crossing"
            && named
            && (matches!(self.word(1), "sign" | "signal" | "light" | "guard")
                || matches!(self.word(1), "" | "." | ",") && self.chunker.is_behind_a_place_word(self.at - 1))
    }

    /// "a truck-mounted sign".
    fn is_mounted_on_a_vehicle(&self) -> bool {
        let before = self.at.checked_sub(1).and_then(|at| self.chunker.head(at));
        before.is_some() && self.is_single() && self.chunker.is_mounted_on(self.at)
    }

    /// "the sliding door".
    fn is_a_sliding_door(&self) -> bool {
        self.word(0) == "sliding" && matches!(self.word(1), "door" | "doors" | "gate")
    }

    /// "the stop sign", "stop signs facing the other road".
    fn is_contacts_or_stop_sign(&self) -> bool {
        self.word(0) == "contacts" || self.word(0) == "stop" && matches!(self.word(1), "sign" | "signs")
    }

    /// "stood there following a rider drop-off": after it.
    fn is_after_a_drop_off(&self) -> bool {
        let article = usize::from(matches!(self.behind(0), "a" | "the" | "its" | "this"));
        let rider = usize::from(matches!(self.behind(article), "passenger" | "rider" | "customer"));
        let event = article + rider;
        let off = matches!((self.behind(event), self.behind(event + 1)), ("drop", "off") | ("pick", "up"));
        let one = matches!(self.behind(event), "dropoff") || self.behind(event) == "pickup" && rider > 0;
        self.word(0) == "following" && self.is_single() && (one || off && self.behind(event + 2) != "truck")
    }

    /// "climbed the curb" is a contact; a hill is climbed too.
    fn climbs_nothing(&self) -> bool {
        let over = ["climb", "mount", "hop", "jump", "ride", "rode", "roll", "go", "went"];
        let last = self.last_word();
        let climbs = matches!(last, "up" | "over" | "onto" | "on" | "climb")
            || matches!(last, "climbed" | "climbs" | "climbing" | "mounted" | "mounting" | "mounts")
            || matches!(last, "hopped" | "hopping" | "hops" | "jumped" | "jumping" | "jumps");
        let behind = self.at + self.length;
        self.sense == Sense::Contact
            && over.iter().any(|stem| self.word(0).starts_with(stem))
            && climbs
            && !self.chunker.noun(behind).is_some_and(|(noun, _)| {
                noun.subject || noun.kind.is_some_and(|kind| kind.group() == KindGroup::Object)
            })
            && self.chunker.piece(behind).is_none_or(|(piece, _)| {
                // "rode up on the right side".
                let side = |part: &Part| matches!(part, Part::Left | Part::Right);
                piece.owner.is_none() && !piece.its && piece.parts.iter().all(side)
            })
    }
}

impl Chunker<'_> {
    /// The verb that begins here: what it says, its form, and the tokens that it takes.
    pub(super) fn verb(&self, at: usize, before: &[Placed]) -> Option<(Sense, Form, usize)> {
        let token = self.tokens.get(at)?;
        // "AV stationary at a red light", in the style of telegrams.
        let named = matches!(before, [Placed { chunk: Chunk::Noun(noun), end, .. }] if noun.subject && *end == at);
        if named && matches!(token.text.as_str(), "stationary" | "motionless" | "idle" | "static") {
            return Some((Sense::Act(Act::Hold), Form::Past, 1));
        }
        if token.capital && at > self.first || self.leads_on(at, before) {
            return None;
        }
        let found = self.verb_phrase(at)?;
        let Meaning::Verb(sense, form) = found.meaning else { return None };
        // "was run into".
        let done = self.text(at) == "run" && matches!(before.last().map(|placed| &placed.chunk), Some(Chunk::Be));
        let perfect = form == Form::Base && at > self.first && self.is_perfect(at, before);
        let form = if done && sense == Sense::Contact || perfect { Form::Past } else { form };
        let word_before = if at > self.first { self.text(at - 1) } else { "" };
        let verb = Candidate { chunker: self, before, sense, form, at, length: found.length, word_before };
        if verb.climbs_nothing() || form == Form::Base && !self.takes_base(at, before) {
            return None;
        }
        if sense != Sense::ContactMade && NO_VERB.iter().any(|says| says(&verb)) {
            return None;
        }
        // "coming from the left": where it comes from stands behind.
        let side = verb.behind(0) == "the" && matches!(verb.behind(1), "left" | "right" | "opposite" | "rear");
        // "came from the AV's right".
        let side = side || self.side_of_its_owner(at + found.length - 1).is_some();
        let from = sense == Sense::Approach && found.length > 1 && verb.last_word() == "from" && side;
        // "turning right onto the left lane" is a right turn.
        let said = match verb.word(1) {
            "left" => Some(LeftRight::Left),
            "right" => Some(LeftRight::Right),
            _ => None,
        };
        if let (Sense::Sided(Act::Turn, side), Some(said)) = (sense, said)
            && side != said
            && found.length > 2
        {
            return Some((Sense::Sided(Act::Turn, said), form, 2));
        }
        // "nudged to its right": the side stands behind.
        let to = found.length > 1
            && matches!(verb.last_word(), "to" | "toward" | "towards")
            && self
                .relation(at + found.length - 1)
                .is_some_and(|(relation, length)| length > 1 && matches!(relation, Relation::Left | Relation::Right));
        Some((sense, form, if from || to { found.length - 1 } else { found.length }))
    }

    /// "was stopped on Elm Street headed north": heading so, where the clause has its verb, or "while in the left lane" has none of its own. "It
    /// stopped, then headed north" tells what it did next.
    fn leads_on(&self, at: usize, before: &[Placed]) -> bool {
        let ends = |placed: &&Placed| matches!(placed.chunk, Chunk::Comma | Chunk::Joint(_));
        let verb = |placed: &&Placed| matches!(placed.chunk, Chunk::Verb(..) | Chunk::Be);
        let begins = before.iter().rposition(|placed| ends(&placed)).map_or(0, |joint| joint + 1);
        let (outer, clause) = before.split_at(begins);
        let named =
            clause.iter().any(|placed| matches!(placed.chunk, Chunk::Noun(_) | Chunk::Pronoun | Chunk::Relative));
        let meanwhile = outer.last().is_some_and(|joint| matches!(joint.chunk, Chunk::Joint(Joint::While))) && !named;
        let relative = clause.iter().any(|placed| matches!(placed.chunk, Chunk::Relative));
        let told = clause.iter().any(|placed| verb(&placed)) || meanwhile && outer.iter().any(|placed| verb(&placed));
        // "After leaving a driveway the van headed toward it": that is its verb.
        let subject = before.last().is_some_and(|placed| matches!(placed.chunk, Chunk::Noun(_) | Chunk::Pronoun));
        matches!(self.text(at), "headed" | "bound") && told && !relative && !subject
    }

    /// The longest verb of the lexicon here that the words behind it allow: "rolled into the roadway" touches nobody.
    fn verb_phrase(&self, at: usize) -> Option<Found> {
        let found = self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Verb(..)))?;
        let Meaning::Verb(sense, _) = found.meaning else { return Some(found) };
        let (behind, last) = (at + found.length, self.text(at + found.length - 1));
        let touches = |sense| matches!(sense, Sense::Contact | Sense::ReverseContact | Sense::OpenDoorInto);
        let turns = |sense| matches!(sense, Sense::Act(Act::Turn) | Sense::Sided(Act::Turn, _));
        let wrong_way = |sense| sense == Sense::Act(Act::WrongWay);
        let lane = matches!(self.text(behind), "lane" | "lanes" | "pocket" | "only" | "bay");
        // "began to slow to turn": two acts, of which it began the first.
        let two = (at..behind).filter(|&at| self.text(at) == "to").count() > 1;
        let others = |allowed: &dyn Fn(Sense) -> bool| {
            self.lexicon.longest(
                self.tokens,
                at,
                |meaning| matches!(meaning, Meaning::Verb(sense, _) if allowed(sense)),
            )
        };
        if touches(sense) && self.goes_to_a_place(behind) {
            return others(&|sense| !touches(sense));
        }
        // "began merging to the left turn lane" is no turn.
        if turns(sense) && (lane && last == "turn" || two) {
            return others(&|sense| !turns(sense));
        }
        // "moved back into its lane", "came back from there": no way backward.
        let reverses = |sense| sense == Sense::Act(Act::Reverse);
        if reverses(sense) && last == "back" && self.comes_back(at, behind) {
            return others(&|sense| !reverses(sense));
        }
        // "pulled into the parking lane": it parks there.
        let over = |sense| sense == Sense::Act(Act::LaneChange);
        if over(sense) && self.text(at).starts_with("pull") && (at..behind).any(|at| self.text(at) == "parking") {
            return others(&|sense| !over(sense));
        }
        // "started its left blinker", "a left side": no turn.
        if turns(sense)
            && matches!(last, "left" | "right")
            && !self.text(at).starts_with("turn")
            && self.is_of_a_side(behind)
        {
            return others(&|sense| !turns(sense));
        }
        // "drove against traffic laws" is no way.
        if wrong_way(sense) && last == "traffic" && super::is_of_traffic(self.text(behind)) {
            return others(&|sense| !wrong_way(sense));
        }
        Some(found)
    }

    /// "went back to the left", "came back over": to where it had been.
    fn comes_back(&self, at: usize, behind: usize) -> bool {
        const GOES: [&str; 15] = [
            "go", "went", "gone", "com", "cam", "mov", "drift", "eas", "driv", "drov", "travel", "settl", "start",
            "drop", "fell",
        ];
        GOES.iter().any(|stem| self.text(at).starts_with(stem))
            && matches!(
                self.text(behind),
                "to" | "toward"
                    | "towards"
                    | "over"
                    | "in"
                    | "into"
                    | "onto"
                    | "on"
                    | "out"
                    | "from"
                    | "and"
                    | "for"
                    | "inside"
                    | "along"
                    | "up"
                    | "behind"
                    | "around"
                    | "across"
                    | "through"
                    | "down"
            )
    }

    /// Whether a side here is that of a thing: "its left blinker", "the right lane".
    fn is_of_a_side(&self, at: usize) -> bool {
        const THINGS: [&str; 22] = [
            "lane",
            "side",
            "signal",
            "blinker",
            "indicator",
            "front",
            "rear",
            "door",
            "mirror",
            "bumper",
            "wheel",
            "corner",
            "fender",
            "tire",
            "edge",
            "curb",
            "turn",
            "hand",
            "arrow",
            "headlight",
            "window",
            "most",
        ];
        THINGS.iter().any(|thing| self.text(at).starts_with(thing))
    }

    /// Whether the words behind "into" or "onto" name a place: "the roadway", "the van's lane".
    fn goes_to_a_place(&self, at: usize) -> bool {
        if !matches!(self.text(at - 1), "into" | "onto") {
            return false;
        }
        // "drove into oncoming traffic", "ran into the junction".
        if self.text(at) == "traffic" || self.text(at + 1) == "traffic" || self.is_a_place(at) {
            return true;
        }
        // "rolled into the middle of its lane".
        let of =
            self.text(at) == "the" && matches!(self.text(at + 1), "middle" | "center") && self.text(at + 2) == "of";
        if of && (at + 3..at + 8).any(|at| matches!(self.text(at), "lane" | "lanes" | "roadway" | "road" | "street")) {
            return true;
        }
        let begins = match self.noun(at) {
            Some((_, length)) if self.text(at + length) == "'s" => at + length + 1,
            Some(_) => return false,
            None => at,
        };
        (begins..begins + 4).any(|at| {
            matches!(
                self.text(at),
                "roadway" | "road" | "street" | "lane" | "lanes" | "intersection" | "path" | "crosswalk" | "traffic"
            )
        })
    }

    /// "having come to a stop", "had just run a light", "had slowed and come to a stop": participles that look like base forms.
    fn is_perfect(&self, at: usize, before: &[Placed]) -> bool {
        if !matches!(self.text(at), "come" | "run" | "become" | "overcome") {
            return false;
        }
        let adverb = |at: usize| {
            self.text(at).ends_with("ly")
                || matches!(
                    self.text(at),
                    "just" | "already" | "only" | "since" | "now" | "once" | "not" | "also" | "then"
                )
        };
        let has = |at: usize| {
            let back = (self.first..at).rev().find(|at| !adverb(*at));
            back.filter(|back| matches!(self.text(*back), "had" | "has" | "have" | "having"))
        };
        let row = || {
            let last = before.iter().rev().find(|placed| matches!(placed.chunk, Chunk::Verb(..) | Chunk::Be));
            last.is_some_and(|last| matches!(last.chunk, Chunk::Verb(_, Form::Past)) && has(last.first).is_some())
        };
        has(at).is_some() || at > self.first && matches!(self.text(at - 1), "and" | "then") && row()
    }

    /// "the next parking lot", "a yard", where no thing of it is named: "the wall of", "the garage door".
    fn is_a_place(&self, at: usize) -> bool {
        const PLACES: [&str; 17] = [
            "junction",
            "crossing",
            "crossroads",
            "roundabout",
            "driveway",
            "lot",
            "garage",
            "alley",
            "alleyway",
            "tunnel",
            "zone",
            "stall",
            "shoulder",
            "yard",
            "plaza",
            "station",
            "bay",
        ];
        let end = (at..at + 4).take_while(|&at| self.tokens.get(at).is_some_and(|token| token.kind == TokenKind::Word));
        let place = end.into_iter().find(|&at| PLACES.contains(&self.text(at)));
        place.is_some_and(|place| self.head(place + 1).is_none() && self.part(place + 1).is_none())
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
        // "could only brake".
        if word == "only" && at >= 2 && self.text(at - 2) == "could" {
            return true;
        }
        match word {
            "to" | "not" | "had" | "has" | "have" | "will" | "would" | "could" | "can" | "may" | "might" | "should"
            | "must" | "did" | "t" | "fully" | "suddenly" | "immediately" | "abruptly" | "slowly" | "also" | "then"
            | "safely" | "almost" | "nearly" => true,
            "and" | "or" => {
                // "began to speed up and turn right": the verb before it ends in one.
                let infinitive = |placed: &Placed| self.ends_in_infinitive(placed) && !self.has_verb_behind(at);
                before.iter().rev().skip(1).take(4).any(|placed| {
                    matches!(placed.chunk, Chunk::Verb(_, Form::Base)) || word == "and" && infinitive(placed)
                })
            }
            _ => false,
        }
    }

    /// "began to accelerate", "started to move forward".
    fn ends_in_infinitive(&self, placed: &Placed) -> bool {
        matches!(placed.chunk, Chunk::Verb(..))
            && (placed.first + 1..placed.end.saturating_sub(1)).any(|at| self.text(at) == "to")
    }

    /// "and contact was made": a noun, with its own verb behind it.
    fn has_verb_behind(&self, at: usize) -> bool {
        (at + 1..at + 3).any(|at| matches!(self.text(at), "was" | "were" | "is" | "occurred" | "between" | "with"))
    }
}
