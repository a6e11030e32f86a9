//! Who or what is named: an article, words before the head, the head or heads; what stands behind it is in [`super::behind`].

use super::{Article, Chunker, DETERMINERS, Noun, PREPOSITIONS, is_colour};
use crate::lexicon::{Adjective, Found, Meaning, Occupant};
use crate::token::TokenKind;
use recrash_model::account::{Kind, KindGroup};

/// Most words that tell what trailer it is: "flat-bed". [tokens]
const TRAILER_NAME: usize = 3;

/// Most tokens before the head of a noun.
pub(super) const LONGEST_LEAD: usize = 10;

/// Words that describe no noun behind them.
const SMALL: [&str; 53] = [
    "and", "or", "but", "then", "when", "as", "while", "that", "which", "who", "where", "is", "was", "were", "are",
    "be", "been", "had", "has", "have", "it", "they", "not", "due", "because", "after", "before", "until", "once",
    "if", "than", "'s", "side", "part", "half", "end", "corner", "middle", "edge", "top", "back", "both", "all",
    "some", "only", "did", "could", "would", "time", "same", "during", "behind", "between",
];

/// A noun that is being read.
struct Draft {
    noun: Noun,
    first: usize,
    /// The token behind what is read.
    at: usize,
    /// "one of the" stands before it.
    one_of: bool,
    /// It is called by the name of a company, or of the subject vehicle.
    subject: bool,
    /// It is called by a make.
    make: bool,
    /// The last head is a plural.
    plural: bool,
    /// Words before the head that nobody knows.
    strange: usize,
}

/// What a word before the head makes of a noun.
enum Lead {
    /// It goes on.
    On,
    /// Its head begins here.
    Head(Meaning, usize),
    /// It has no head.
    Ends,
    /// It is this noun.
    Whole(Noun, usize),
}

/// "a stopped van", "a parked van".
pub(super) fn stands(adjective: &Adjective) -> bool {
    matches!(adjective, Adjective::Stopped | Adjective::Parked)
}

/// So many nouns stand in one another at most: "the driver of the van's trailer".
const MOST_NESTED: usize = 5;

impl Chunker<'_> {
    /// Somebody or something that is named here.
    pub(super) fn noun(&self, first: usize) -> Option<(Noun, usize)> {
        // Each may be read more than once by those around it.
        let depth = self.depth.get();
        if depth == MOST_NESTED {
            return None;
        }
        self.depth.set(depth + 1);
        let noun = self.noun_here(first);
        self.depth.set(depth);
        noun
    }

    fn noun_here(&self, first: usize) -> Option<(Noun, usize)> {
        if let Some(loose) = self.loose(first) {
            return Some(loose);
        }
        if let Some(group) = self.crowd_again(first) {
            return Some((group, 2));
        }
        // "another of our test cars".
        if self.text(first) == "another"
            && self.text(first + 1) == "of"
            && matches!(self.text(first + 2), "our" | "its" | "their" | "the")
        {
            return self.another_of(first + 2).map(|(noun, length)| (noun, 2 + length));
        }
        // "what appeared to be a plastic chair": a chair.
        if self.text(first) == "what"
            && matches!(self.text(first + 1), "appeared" | "appears" | "seemed" | "seems" | "looked")
            && (self.text(first + 2), self.text(first + 3)) == ("to", "be")
        {
            return self.noun(first + 4).map(|(noun, length)| (noun, 4 + length));
        }
        if let Some(row) = self.row_of(first) {
            return Some(row);
        }
        let mut draft = self.article(first);
        if let Some(behind) = self.one_of_them(&draft) {
            let noun = Noun { one_of: true, kind: Some(Kind::Vehicle), ..draft.noun };
            return Some((noun, behind - first));
        }
        let head = loop {
            match self.lead(&mut draft) {
                Lead::On => {}
                Lead::Head(meaning, length) => break (meaning, length),
                Lead::Ends => return self.only_named(draft),
                Lead::Whole(noun, length) => return Some((noun, length)),
            }
        };
        let one_of = draft.one_of;
        let (mut noun, length) = self.heads(draft, head)?;
        if self.is_mounted_on(first + length)
            || self.names_a_crash(&noun, first + length)
            || self.names_a_street(&noun, first, length)
        {
            return None;
        }
        if noun.article == Article::None
            && let Some(kind) = noun.kind.filter(|_| !noun.several)
            && let Some(before) = self.shares_with(first, kind)
        {
            noun.article = before.article;
            noun.adjectives.extend(before.adjectives.into_iter().filter(stands));
        }
        if one_of {
            // "one of the deer".
            (noun.one_of, noun.several) = (noun.several || noun.kind == Some(Kind::Animal), false);
            noun.article = if noun.one_of { Article::Indefinite } else { Article::Definite };
        }
        Some((noun, length))
    }

    /// A wheel or a part that came off, or several.
    fn loose(&self, first: usize) -> Option<(Noun, usize)> {
        let one = |kind: Kind, behind: usize| {
            let article = if self.text(first) == "the" { Article::Definite } else { Article::Indefinite };
            (Noun { article, kind: Some(kind), ..Noun::unnamed() }, behind - first)
        };
        if let Some(behind) = self.loose_wheel(first) {
            return Some(one(Kind::LooseWheel, behind));
        }
        if let Some(behind) = self.loose_part(first) {
            return Some(one(Kind::Debris, behind));
        }
        let (behind, one_of) = self.loose_wheels(first)?;
        let article = match self.text(first) {
            "the" => Article::Definite,
            _ if one_of => Article::Indefinite,
            _ => Article::None,
        };
        let noun = Noun { article, kind: Some(Kind::LooseWheel), several: !one_of, one_of, ..Noun::unnamed() };
        Some((noun, behind - first))
    }

    /// "one of them", "one of these,": of those named before. The token behind it.
    fn one_of_them(&self, draft: &Draft) -> Option<usize> {
        let those = matches!(self.text(draft.at.checked_sub(1)?), "these" | "those");
        match self.text(draft.at) {
            _ if !draft.one_of => None,
            // The article has taken "these".
            "them" => Some(draft.at + usize::from(!those)),
            "," if those => Some(draft.at),
            _ => None,
        }
    }

    /// A draft with its article.
    fn article(&self, first: usize) -> Draft {
        let (article, length) = match self.text(first) {
            // "one of the cyclists", "one of them".
            "one" if self.text(first + 1) == "of" && matches!(self.text(first + 2), "the" | "these" | "those") => {
                (Article::Indefinite, 3)
            }
            "one" if self.text(first + 1) == "of" && self.text(first + 2) == "them" => (Article::Indefinite, 2),
            // "the second of two vans".
            "the"
                if matches!(self.text(first + 1), "first" | "second" | "third" | "last")
                    && self.text(first + 2) == "of"
                    && matches!(self.text(first + 3), "two" | "three" | "four" | "several") =>
            {
                (Article::Indefinite, 3)
            }
            // "a group of four cyclists".
            "a" | "the" if self.is_group(first) => {
                (if self.text(first) == "a" { Article::Indefinite } else { Article::Definite }, 3)
            }
            "a" | "an" | "one" => (Article::Indefinite, 1),
            "the" | "this" | "that" | "these" | "those" | "its" | "their" | "our" | "his" | "her" => {
                (Article::Definite, 1)
            }
            // It is an adjective as well.
            "another" => (Article::Indefinite, 0),
            _ => (Article::None, 0),
        };
        let group = self.is_group(first);
        let mut noun = Noun { article, several: group, ..Noun::unnamed() };
        if length == 3 && !group && self.text(first) == "the" {
            noun.adjectives.push(Adjective::Another);
        }
        // "a crowd of about fifteen dirt bikes".
        let about = group && matches!(self.text(first + length), "about" | "around" | "some" | "roughly" | "nearly");
        let (at, one_of) = (first + length + usize::from(about), length > 1 && !group);
        Draft { noun, first, at, one_of, subject: false, make: false, plural: false, strange: 0 }
    }

    /// Reads the next word before the head.
    fn lead(&self, draft: &mut Draft) -> Lead {
        let at = draft.at;
        if at >= self.tokens.len() || at > draft.first + LONGEST_LEAD || self.tokens[at].kind == TokenKind::Mark {
            return Lead::Ends;
        }
        let determined = draft.noun.article != Article::None;
        let head = self.head(at);
        let carried = head.as_ref().map_or(1, |(_, length)| *length);
        if let Some(behind) = self.is_carried(at + carried).filter(|_| determined) {
            draft.at = behind;
            return Lead::On;
        }
        if let Some((meaning, length)) = head {
            return Lead::Head(meaning, length);
        }
        if let Some(behind) = self.behind_adverb(draft) {
            draft.at = behind;
            return Lead::On;
        }
        // "the larger piece of the pallet".
        if self.measures(at)
            && determined
            && let Some((inner, length)) = self.noun(at + 2)
            && inner.kind.is_some_and(|kind| kind.group() == KindGroup::Object)
        {
            return Lead::Whole(Noun { article: draft.noun.article, ..inner }, at + 2 + length - draft.first);
        }
        // "A Tern ADS-equipped car": who has one is told of. "An ADS-equipped van of another company" is somebody else's.
        let equipped = matches!(self.text(at), "ads" | "av" | "autonomy") && self.text(at + 1) == "equipped";
        if equipped && self.vehicle(at + 2) {
            let others = self.text(at + 3) == "of" && matches!(self.text(at + 4), "another" | "a");
            (draft.subject, draft.at) = (draft.subject || !others, at + 2);
            return Lead::On;
        }
        let known = self.lexicon.longest(self.tokens, at, |meaning| {
            matches!(meaning, Meaning::Adjective(_) | Meaning::Make | Meaning::Company)
        });
        if let Some(found) = known {
            return self.known_lead(found, draft);
        }
        if let Some((compass, length)) = self.compass(at) {
            // "came westbound our car": a direction of who came.
            if !determined && super::is_determiner(self.text(at + length)) {
                return Lead::Ends;
            }
            draft.noun.compass = Some(compass);
            draft.at += length;
            return Lead::On;
        }
        self.unknown_lead(draft)
    }

    /// "the slowly moving van", "a by then stopped van", "an unoccupied and parked van": the token behind the words before an adjective.
    fn behind_adverb(&self, draft: &Draft) -> Option<usize> {
        let (at, determined) = (draft.at, draft.noun.article != Article::None);
        if self.text(at) == "by" && matches!(self.text(at + 1), "then" | "now") && determined && self.adjective(at + 2)
        {
            return Some(at + 2);
        }
        let adverb = self.text(at).ends_with("ly")
            || matches!(self.text(at), "then" | "still" | "now" | "already" | "just" | "almost" | "once");
        let intensifies = adverb && determined && self.adjective(at + 1);
        (self.joins_adjectives(at, &draft.noun) || intensifies).then_some(at + 1)
    }

    /// Reads a word that nobody knows, between an article and a noun: models of cars.
    fn unknown_lead(&self, draft: &mut Draft) -> Lead {
        let at = draft.at;
        let token = &self.tokens[at];
        let unknown = (token.capital || token.kind != TokenKind::Word) && at > draft.first && draft.strange < 3;
        let described = draft.noun.article != Article::None && draft.strange < 2 && self.may_describe(at);
        if !(unknown || described) || self.verb_stands(at) {
            return Lead::Ends;
        }
        if token.capital && token.kind == TokenKind::Word {
            draft.noun.names.push(token.text.clone());
        }
        (draft.strange, draft.at) = (draft.strange + 1, at + 1);
        Lead::On
    }

    /// Reads an adjective, a make or a company before the head.
    fn known_lead(&self, found: Found, draft: &mut Draft) -> Lead {
        let (at, word) = (draft.at, self.text(draft.at));
        let capital = self.tokens[at].capital;
        match found.meaning {
            Meaning::Adjective(adjective)
                if draft.make && (!matches!(adjective, Adjective::Plain) || self.verb_stands(at)) =>
            {
                return Lead::Ends;
            }
            Meaning::Adjective(adjective) => {
                if is_colour(word) {
                    draft.noun.names.push(word.to_owned());
                }
                draft.noun.several |= matches!(word, "several" | "multiple" | "many" | "two" | "three" | "four");
                draft.noun.ordinal = draft.noun.ordinal.or(match word {
                    "second" => Some(2),
                    "third" => Some(3),
                    "fourth" => Some(4),
                    _ => None,
                });
                draft.noun.adjectives.push(adjective);
                // "the other party's van".
                let behind = at + found.length;
                if self.text(behind - 1) == "party" && self.text(behind) == "'s" && self.vehicle(behind + 1) {
                    draft.at += 1;
                }
            }
            Meaning::Make if capital || draft.make => {
                draft.make = true;
                draft.noun.names.push(word.to_owned());
            }
            // "May's vehicle", "Nuro's Prius".
            Meaning::Company if capital && self.text(at + found.length) == "'s" => {
                draft.subject = true;
                let behind = at + found.length + 1;
                let owns = (self.vehicle(behind) || self.vehicle(behind + 1)) && self.part(behind).is_none();
                draft.at = if owns { behind } else { at + found.length };
                return if owns { Lead::On } else { Lead::Ends };
            }
            Meaning::Company if capital => {
                draft.subject = true;
                // "a Tern-operated shuttle".
                let behind = self.text(at + found.length);
                draft.at += usize::from(matches!(behind, "operated" | "equipped" | "owned" | "branded" | "built"));
            }
            _ => return Lead::Ends,
        }
        draft.at += found.length;
        Lead::On
    }

    fn adjective(&self, at: usize) -> bool {
        self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Adjective(_))).is_some()
    }

    pub(super) fn company(&self, at: usize) -> bool {
        self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Company)).is_some()
    }

    /// "an unoccupied and parked van". "stopped at the light and another van came": two nouns.
    fn joins_adjectives(&self, at: usize, noun: &Noun) -> bool {
        self.text(at) == "and"
            && !noun.adjectives.is_empty()
            && self.adjective(at + 1)
            && self.adjective(at - 1)
            && !(DETERMINERS.contains(&self.text(at + 1)) || self.text(at + 1) == "another")
    }

    /// Whether a vehicle is named right here.
    fn vehicle(&self, at: usize) -> bool {
        match self.head(at) {
            Some((Meaning::Subject, _)) => true,
            Some((Meaning::Kind(kind), _)) => kind.is_vehicle(),
            _ => false,
        }
    }

    /// "a gravel-hauling truck" is a truck: the token behind the participle, where a vehicle is named there.
    fn is_carried(&self, behind: usize) -> Option<usize> {
        let carries = matches!(self.text(behind), "hauling" | "carrying" | "towing" | "collecting" | "delivering");
        let carrier = self.text(behind + 1);
        // "a truck carrying cars" is no cars.
        let load = carrier == "trailer" || carrier.ends_with('s') && carrier != "bus";
        (carries && !load && self.vehicle(behind + 1)).then_some(behind + 1)
    }

    /// "a truck-mounted sign" names no truck. "A truck mounted the curb" does.
    pub(super) fn is_mounted_on(&self, behind: usize) -> bool {
        let next = self.text(behind + 1);
        let small = DETERMINERS.contains(&next) || PREPOSITIONS.contains(&next) || matches!(next, "and" | "curbs");
        let word = self.tokens.get(behind + 1).is_some_and(|token| token.kind == TokenKind::Word);
        self.text(behind) == "mounted" && word && !small
    }

    /// "a single car collision".
    fn names_a_crash(&self, noun: &Noun, behind: usize) -> bool {
        matches!(self.text(behind), "collision" | "crash" | "accident" | "incident")
            && !noun.subject
            && noun.occupant.is_none()
            && noun.number.is_none()
    }

    /// Whether a word that nobody knows may stand before a noun, as in "a charter bus": no small word, and the noun is next.
    fn may_describe(&self, at: usize) -> bool {
        let word = self.text(at);
        let small = SMALL.contains(&word)
            || PREPOSITIONS.contains(&word)
            || DETERMINERS.contains(&word)
            || word.ends_with("ly")
            || word.ends_with("ed")
            || word.ends_with("ing");
        let known = self.part(at).is_some() || self.spot(at).is_some() || self.lane(at).is_some();
        !small
            && !known
            && self.tokens[at].kind == TokenKind::Word
            && (self.head(at + 1).is_some() || self.measures(at + 1))
    }

    /// Whether the words here are a piece of something: "the larger piece of the pallet".
    fn measures(&self, at: usize) -> bool {
        let piece = matches!(
            self.text(at),
            "piece" | "pieces" | "part" | "section" | "chunk" | "strip" | "sheet" | "fragment" | "remains" | "pile"
        );
        piece && self.text(at + 1) == "of"
    }

    fn verb_stands(&self, at: usize) -> bool {
        !self.tokens[at].capital
            && self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Verb(..))).is_some()
    }
    /// "the Waymo", "a Toyota": a name without a noun.
    fn only_named(&self, draft: Draft) -> Option<(Noun, usize)> {
        let Draft { mut noun, first, at, subject, make, .. } = draft;
        let at = at.min(self.tokens.len());
        // "the third party", "the other party": who drives it.
        let party = at > first && self.text(at - 1) == "party" && noun.adjectives.contains(&Adjective::Other);
        if at <= first || noun.article == Article::None || !(subject || make || party) {
            return None;
        }
        if !subject && (first..at).any(|at| self.names_a_place(at)) {
            return None;
        }
        if subject {
            noun.subject = true;
        } else {
            noun.kind = Some(Kind::Vehicle);
        }
        self.finish(noun, first, at)
    }

    /// Reads the heads of a noun. Another one at once makes a compound: "pickup truck driver", "Waymo AV operator".
    fn heads(&self, mut draft: Draft, head: (Meaning, usize)) -> Option<(Noun, usize)> {
        let mut next = Some(head);
        while let Some((meaning, length)) = next {
            match meaning {
                Meaning::Subject => {
                    draft.subject = true;
                    // "An automated shuttle": "the shuttle" further on.
                    draft.noun.kind = draft.noun.kind.or(match self.text(draft.at + length - 1) {
                        _ if length == 1 => None,
                        "shuttle" | "bus" => Some(Kind::Bus),
                        "truck" => Some(Kind::HeavyTruck),
                        _ => None,
                    });
                }
                Meaning::Kind(kind) => self.kind_head(kind, length, &mut draft),
                Meaning::Occupant(who) => self.occupant_head(who, length, &mut draft),
                _ => {}
            }
            draft.at += length;
            self.numbered(&mut draft);
            next = self.next_head(&draft);
        }
        let at = self.with_trailer(&mut draft);
        let Draft { mut noun, first, mut subject, plural, .. } = draft;
        if subject
            && noun.occupant.is_none()
            && noun.adjectives.iter().any(|adjective| matches!(adjective, Adjective::Another | Adjective::Other))
        {
            (subject, noun.namesake) = (false, true);
            noun.kind = noun.kind.or(Some(Kind::PassengerCar));
        }
        noun.subject = (subject || self.text(first) == "our") && noun.occupant.is_none();
        noun.several |= plural;
        // "The traffic was backed up": all that drives there, whoever reports it.
        if plural
            && at > first
            && self.text(at - 1) == "traffic"
            && noun.adjectives.is_empty()
            && noun.compass.is_none()
        {
            noun.article = Article::None;
        }
        let alone = (first..at).any(|at| {
            matches!(self.text(at), "abandoned" | "parked" | "unattended" | "riderless" | "fallen" | "unoccupied")
        });
        if alone && matches!(noun.kind, Some(Kind::ScooterRider | Kind::Bicycle | Kind::EBike)) {
            noun.kind = Some(Kind::Scooter);
        }
        self.finish(noun, first, at)
    }

    /// "a truck and flat-bed trailer" is one. The token behind it, or behind the noun.
    fn with_trailer(&self, draft: &mut Draft) -> usize {
        let kind = match draft.noun.kind {
            Some(kind) if kind.group() == KindGroup::Truck => Kind::SemiTrailerTruck,
            Some(Kind::Pickup) => Kind::PickupWithTrailer,
            None if draft.subject => Kind::SemiTrailerTruck,
            _ => return draft.at,
        };
        let own = |at: usize| {
            let named = |meaning| matches!(meaning, Meaning::Kind(Kind::Trailer));
            self.lexicon.longest(self.tokens, at, named).map(|found| (at, at + found.length))
        };
        let tells = |at: usize| {
            let word = self.text(at);
            let another = matches!(word, "another" | "second" | "third" | "different" | "other" | "parked" | "stopped");
            !another && (self.adjective(at) || matches!(word, "flat" | "bed" | "flatbed" | "box" | "utility" | "its"))
        };
        // "a truck and its trailer", "a pickup with a trailer in tow".
        let joined = match (self.text(draft.at), self.text(draft.at + 1)) {
            ("and" | "with", "its") | ("with", "a" | "an") => 2,
            ("and", _) => 1,
            _ => return draft.at,
        };
        let from = draft.at + joined;
        let trailer = (from..=from + TRAILER_NAME).find_map(own);
        let named = trailer.filter(|(trailer, _)| (from..*trailer).all(tells)).map(|(_, behind)| behind);
        match named.filter(|_| !draft.plural && draft.noun.occupant.is_none()) {
            Some(behind) => {
                draft.noun.kind = Some(kind);
                let towed = match (self.text(behind), self.text(behind + 1)) {
                    ("in", "tow") => 2,
                    ("attached" | "hitched", next) if next != "to" => 1,
                    _ => 0,
                };
                behind + towed
            }
            None => draft.at,
        }
    }

    /// A head that names a kind; "truck trailer", "pickup with trailer" are one.
    fn kind_head(&self, kind: Kind, length: usize, draft: &mut Draft) {
        let (word, last) = (self.text(draft.at), self.text(draft.at + length - 1));
        let noun = &mut draft.noun;
        match (kind, noun.kind) {
            (Kind::Trailer, Some(before)) if before.group() == KindGroup::Truck => {
                noun.kind = Some(Kind::SemiTrailerTruck);
            }
            (Kind::Trailer, Some(Kind::Pickup)) => noun.kind = Some(Kind::PickupWithTrailer),
            _ => {
                if length == 1 && self.lexicon.is_model(word) {
                    noun.names.push(word.to_owned());
                }
                noun.tractor = length == 1 && word == "tractor";
                noun.shuttle = last == "shuttle";
                noun.passenger = kind == Kind::Vehicle && word == "passenger";
                // "a passenger sedan" carries passengers, and is none.
                if kind.is_vehicle() && matches!(noun.occupant, Some((Occupant::Rider, _))) {
                    (noun.occupant, noun.owner) = (None, None);
                }
                noun.kind = Some(kind);
                draft.plural = matches!(last, "people" | "personnel" | "traffic" | "children" | "men" | "women")
                    || last.ends_with('s')
                        && !matches!(last, "bus" | "debris" | "cross")
                        && !self.lexicon.is_model(last);
            }
        }
    }

    /// A head that names somebody in a vehicle; what stands before it is the vehicle: "the van driver".
    fn occupant_head(&self, who: Occupant, length: usize, draft: &mut Draft) {
        let plain = matches!(self.text(draft.at), "driver" | "drivers" | "rider" | "riders") && length == 1;
        let noun = &mut draft.noun;
        if draft.subject || noun.kind.is_some() || draft.make {
            let kind = noun.kind.or(Some(Kind::Vehicle));
            let owner = Noun { subject: draft.subject, kind, occupant: None, owner: None, ..noun.clone() };
            noun.owner = Some(Box::new(owner));
        }
        (noun.occupant, noun.kind, draft.subject) = (Some((who, plain)), None, false);
    }

    /// A number behind a head: "vehicle 2", "car 1", "AV 2".
    fn numbered(&self, draft: &mut Draft) {
        let noun = &mut draft.noun;
        let may_be_numbered = noun.kind == Some(Kind::Vehicle) || self.text(draft.at - 1) == "car";
        if let (Some(number), true) = (self.text(draft.at).parse().ok(), may_be_numbered) {
            // "car 1" is who reports.
            draft.subject |= number == 1;
            noun.number = Some(number).filter(|number| *number > 1);
            // "Car 2" is a name.
            noun.kind = Some(Kind::Vehicle);
            draft.at += 1;
        }
        // "AV 2", "a different AV": another one of the same company.
        let of_company = self.text(draft.at).parse::<u8>().ok().filter(|number| (1..=4).contains(number));
        if let (true, Some(number)) = (draft.subject, of_company) {
            draft.at += 1;
            if number > 1 {
                (draft.subject, noun.kind, noun.number) = (false, Some(Kind::PassengerCar), Some(number));
            }
        }
    }

    /// The head that follows at once.
    fn next_head(&self, draft: &Draft) -> Option<(Meaning, usize)> {
        let (meaning, length) = self.head(draft.at)?;
        let noun = &draft.noun;
        let no_more = self.text(draft.at) == "'s"
            // "a Prius test vehicle" is the subject vehicle.
            || matches!(meaning, Meaning::Subject)
                && noun.kind.is_some()
                && !draft.subject
                && !(self.lexicon.is_model(self.text(draft.at - 1)) && self.text(draft.at) == "test")
            || matches!(meaning, Meaning::Kind(kind) if noun.occupant.is_some() && !kind.is_vehicle());
        (!no_more).then_some((meaning, length))
    }
}

/// Whether a thing of this kind has parts and people in it.
pub(super) fn can_own(kind: Kind) -> bool {
    kind.group() != KindGroup::Animal || kind == Kind::Animal
}
