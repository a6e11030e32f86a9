//! Who or what is named, and parts of vehicles.

use super::{Article, COLOURS, Chunker, DETERMINERS, LONGEST_PIECE, Noun, PREPOSITIONS, Piece};
use crate::lexicon::{Adjective, Meaning, Occupant, Part};
use crate::token::TokenKind;
use recrash_model::account::{Kind, KindGroup};

impl Chunker<'_> {
    /// A part of a vehicle, with whose it is.
    pub(super) fn piece(&self, first: usize) -> Option<(Piece, usize)> {
        if self.loose_wheel(first).is_some() {
            return None;
        }
        let mut at = first;
        let mut its = false;
        if DETERMINERS.contains(&self.text(at)) {
            its = matches!(self.text(at), "its" | "their" | "his" | "her");
            at += 1;
        }
        // "a van, left of it, turned": where it was.
        let aside = matches!(self.text(at), "left" | "right") && self.text(at + 1) == "of";
        if aside && at == first && at > self.first && self.tokens[at - 1].kind == TokenKind::Mark {
            return None;
        }
        let (mut parts, mut door, mut mirror, mut open, mut nouns) = (Vec::new(), false, false, false, 0);
        let mut last_joined = at;
        while at < self.tokens.len().min(first + LONGEST_PIECE) {
            let word = self.text(at);
            if matches!(word, "open" | "opened" | "opening") && self.tokens.get(at + 1).is_some() {
                (open, at) = (true, at + 1);
                continue;
            }
            // "the roof-mounted sensor dome".
            if word == "mounted" && !parts.is_empty() && self.part(at + 1).is_some() {
                at += 1;
                continue;
            }
            if word == "and" && !parts.is_empty() && self.part(at + 1).is_some() && self.noun(at + 1).is_none() {
                at += 1;
                continue;
            }
            // "its front, passenger side bumper".
            let side = |at: usize| matches!(self.part(at), Some((Part::Left | Part::Right, length)) if self.part(at + length).is_some());
            if word == ","
                && parts.iter().all(|part| matches!(part, Part::Front | Part::Rear))
                && !parts.is_empty()
                && side(at + 1)
            {
                at += 1;
                continue;
            }
            let Some((part, length)) = self.part(at) else { break };
            door |= (at..at + length).any(|at| matches!(self.text(at), "door" | "doors"));
            mirror |= (at..at + length).any(|at| self.text(at) == "mirror");
            nouns +=
                usize::from(part == Part::Noun || (at..at + length).any(|at| matches!(self.text(at), "side" | "end")));
            if !parts.contains(&part) {
                parts.push(part);
            }
            at += length;
            last_joined = at;
        }
        at = at.min(last_joined.max(first));
        if parts.is_empty() || at == first {
            return None;
        }
        let placed = parts.iter().any(|part| *part != Part::Noun);
        let ours = self.text(first) == "our";
        let mut owner = ours.then(|| Noun { subject: true, ..Noun::unnamed() });
        if self.text(at) == "of" || (self.text(at) == "on" && nouns > 0) {
            let mut behind = at + 1;
            // "the rear of both the van and the bus" has one owner: the first.
            if matches!(self.text(behind), "both" | "another") {
                behind += usize::from(self.text(behind) == "both");
            }
            // "the edge of the open door".
            let door = (behind + 1..behind + 4).find(|&at| matches!(self.text(at), "door" | "doors"));
            if let Some(further) = door.filter(|_| DETERMINERS.contains(&self.text(behind)) && self.text(at) == "of")
                && let Some((inner, length)) = self.piece(behind).filter(|(inner, _)| inner.door)
                && further < behind + length
            {
                for part in inner.parts {
                    if !parts.contains(&part) {
                        parts.push(part);
                    }
                }
                let open = open || inner.open;
                return Some((
                    Piece { parts, door: true, mirror, open, owner: inner.owner, its: its || inner.its },
                    behind + length - first,
                ));
            }
            if let Some((noun, length)) =
                self.noun(behind).filter(|(noun, _)| noun.subject || noun.kind.is_some_and(can_own))
            {
                owner = Some(noun);
                at = behind + length;
                // "the center of the van's front bumper".
                if self.text(at) == "'s" {
                    let mut further = at + 1;
                    while let Some((part, length)) = self.part(further) {
                        if !parts.contains(&part) {
                            parts.push(part);
                        }
                        further += length;
                        at = further;
                    }
                }
            } else if matches!(self.text(behind), "its" | "their") && self.part(behind + 1).is_some() {
                let mut further = behind + 1;
                while let Some((part, length)) = self.part(further) {
                    if !parts.contains(&part) {
                        parts.push(part);
                    }
                    further += length;
                }
                (its, at) = (true, further);
            } else if self.text(behind) == "it" {
                (its, at) = (true, behind + 1);
            } else if self.text(at) == "of" {
                return None;
            }
        }
        // "the front", "the left" alone are places unless somebody owns them or a part is named.
        let possessed = first > self.first && self.text(first - 1) == "'s" && placed;
        let sure = owner.is_some() || nouns > 0 || its || possessed;
        let plain_noun = parts == [Part::Noun] && owner.is_none() && !its && !door;
        let bare = placed && self.text(first) == "the" && self.ends_clause(at);
        if !(sure || bare) {
            return None;
        }
        if plain_noun
            && !matches!(
                self.text(at - 1),
                "mirror" | "bumper" | "sensor" | "wheel" | "tire" | "handlebar" | "handlebars" | "fender"
            )
        {
            return None;
        }
        let side_of_road = matches!(self.text(at - 1), "side" | "lane" | "edge" | "hand")
            && owner.is_none()
            && !its
            && !parts.iter().any(|part| matches!(part, Part::Front | Part::Rear))
            && matches!(self.text(at.wrapping_sub(2)), "left" | "right" | "hand")
            && self.text(at) == "of";
        if side_of_road {
            return None;
        }
        Some((Piece { parts, door, mirror, open, owner, its }, at - first))
    }

    pub(super) fn ends_clause(&self, at: usize) -> bool {
        at >= self.tokens.len() || matches!(self.text(at), "," | "." | "and" | "by" | "when" | "while" | "as")
    }

    pub(super) fn part(&self, at: usize) -> Option<(Part, usize)> {
        let found = self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Part(_)))?;
        let Meaning::Part(part) = found.meaning else { return None };
        // "driver" and "passenger" are sides only before a part.
        let alone = found.length == 1 && matches!(self.text(at), "driver" | "drivers" | "passenger" | "passengers");
        if alone || (found.length == 2 && self.text(at + 1) == "'s") {
            let behind = at + found.length;
            let next = self.lexicon.longest(self.tokens, behind, |meaning| matches!(meaning, Meaning::Part(_)))?;
            let is_part = matches!(next.meaning, Meaning::Part(Part::Noun | Part::Front | Part::Rear));
            let person =
                matches!(self.text(behind), "side") || !matches!(self.text(behind), "back" | "body" | "arm" | "window");
            if !is_part || !person {
                return None;
            }
        }
        if matches!(self.text(at), "back")
            && matches!(self.text(at + 1), "to" | "into" | "onto" | "out" | "up" | "down" | "and" | "in")
        {
            return None;
        }
        if matches!(self.text(at), "light")
            && !matches!(self.text(at.wrapping_sub(1)), "tail" | "head" | "brake" | "side")
        {
            return None;
        }
        Some((part, found.length))
    }

    /// Behind a wheel or a tire that is on no vehicle: "a wheel came off a truck", and "the wheel" further on.
    fn loose_wheel(&self, first: usize) -> Option<usize> {
        let wheel = |at: usize| matches!(self.text(at), "wheel" | "tire");
        let loose = |at: usize| {
            wheel(at + 1)
                && matches!(self.text(at), "a" | "loose" | "detached" | "stray" | "spare" | "runaway")
                && !matches!(
                    self.text(at + 2),
                    "of" | "well"
                        | "rim"
                        | "tread"
                        | "debris"
                        | "carcass"
                        | "scrap"
                        | "change"
                        | "shop"
                        | "stop"
                        | "arch"
                )
        };
        let begins = loose(first);
        let again =
            self.text(first) == "the" && wheel(first + 1) && self.text(first + 2) != "of" && (0..first).any(loose);
        (begins || again).then_some(first + 2)
    }

    /// Somebody or something that is named here.
    pub(super) fn noun(&self, first: usize) -> Option<(Noun, usize)> {
        let mut noun = Noun::unnamed();
        if let Some(behind) = self.loose_wheel(first) {
            let definite = self.text(first) == "the";
            noun.article = if definite { Article::Definite } else { Article::Indefinite };
            noun.kind = Some(Kind::LooseWheel);
            return Some((noun, behind - first));
        }
        let mut at = first;
        let mut one_of = false;
        match self.text(at) {
            "the" | "this" | "that" | "these" | "those" | "its" | "their" | "our" | "his" | "her" => {
                noun.article = Article::Definite;
                at += 1;
            }
            // "one of the cyclists", "each of the vans".
            "one" if self.text(at + 1) == "of" && matches!(self.text(at + 2), "the" | "these" | "those" | "them") => {
                noun.article = Article::Indefinite;
                (one_of, at) = (true, at + if self.text(at + 2) == "them" { 2 } else { 3 });
            }
            "a" | "an" | "one" => {
                noun.article = Article::Indefinite;
                at += 1;
            }
            // "another of our test cars".
            "another" if self.text(at + 1) == "of" && matches!(self.text(at + 2), "our" | "its" | "their" | "the") => {
                let (inner, length) = self.noun(at + 2)?;
                let vehicle = inner.kind.filter(|_| !inner.subject).unwrap_or(Kind::Vehicle);
                let adjectives = vec![Adjective::Another];
                let another = Noun { article: Article::Indefinite, kind: Some(vehicle), adjectives, ..Noun::unnamed() };
                return Some((another, 2 + length));
            }
            "another" => noun.article = Article::Indefinite,
            _ => {}
        }
        let mut company = false;
        let mut make = false;
        let mut strange = 0;
        // "one of them": of those named before.
        if one_of && self.text(at) == "them" {
            (noun.one_of, noun.kind, noun.article) = (true, Some(Kind::Vehicle), Article::Indefinite);
            return Some((noun, at + 1 - first));
        }
        let head = loop {
            if at >= self.tokens.len() || at > first + 10 || self.tokens[at].kind == TokenKind::Mark {
                return self.only_named(noun, first, at.min(self.tokens.len()), company, make);
            }
            if let Some(found) = self.head(at) {
                break found;
            }
            // "an unoccupied and parked van".
            let adjective = |at: usize| {
                self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Adjective(_))).is_some()
            };
            // "stopped at the light and another van came": two nouns.
            let begins = DETERMINERS.contains(&self.text(at + 1)) || self.text(at + 1) == "another";
            if self.text(at) == "and"
                && !noun.adjectives.is_empty()
                && adjective(at + 1)
                && adjective(at - 1)
                && !begins
            {
                at += 1;
                continue;
            }
            // "the slowly moving van".
            if self.text(at).ends_with("ly") && noun.article != Article::None && adjective(at + 1) {
                at += 1;
                continue;
            }
            // "the larger piece of the pallet".
            if self.measures(at)
                && noun.article != Article::None
                && let Some((inner, length)) = self.noun(at + 2)
                && inner.kind.is_some_and(|kind| kind.group() == KindGroup::Object)
            {
                return Some((Noun { article: noun.article, ..inner }, at + 2 + length - first));
            }
            let known = self.lexicon.longest(self.tokens, at, |meaning| {
                matches!(meaning, Meaning::Adjective(_) | Meaning::Make | Meaning::Company)
            });
            if let Some(found) = known {
                match found.meaning {
                    Meaning::Adjective(adjective)
                        if make && (!matches!(adjective, Adjective::Plain) || self.verb_stands(at)) =>
                    {
                        return self.only_named(noun, first, at, company, make);
                    }
                    Meaning::Adjective(adjective) => {
                        if COLOURS.contains(&self.text(at)) {
                            noun.names.push(self.text(at).to_owned());
                        }
                        noun.several |=
                            matches!(self.text(at), "several" | "multiple" | "many" | "two" | "three" | "four");
                        noun.adjectives.push(adjective);
                    }
                    Meaning::Make if self.tokens[at].capital || make => {
                        make = true;
                        noun.names.push(self.text(at).to_owned());
                    }
                    // "May's vehicle", "Nuro's Prius".
                    Meaning::Company if self.tokens[at].capital && self.text(at + found.length) == "'s" => {
                        let behind = at + found.length + 1;
                        let vehicle = |at: usize| {
                            self.head(at).is_some_and(|(meaning, _)| {
                                matches!(meaning, Meaning::Subject)
                                    || matches!(meaning, Meaning::Kind(kind) if kind.is_vehicle())
                            })
                        };
                        if !(vehicle(behind) || vehicle(behind + 1)) || self.part(behind).is_some() {
                            company = true;
                            at += found.length;
                            return self.only_named(noun, first, at, company, make);
                        }
                        company = true;
                        at = behind;
                        continue;
                    }
                    Meaning::Company if self.tokens[at].capital => {
                        company = true;
                        // "a Tern-operated shuttle".
                        let behind = self.text(at + found.length);
                        at += usize::from(matches!(behind, "operated" | "equipped" | "owned" | "branded" | "built"));
                    }
                    _ => return self.only_named(noun, first, at, company, make),
                }
                at += found.length;
                continue;
            }
            if let Some((compass, length)) = self.compass(at) {
                noun.compass = Some(compass);
                at += length;
                continue;
            }
            // Words nobody knows, between an article and a noun: models of cars.
            let token = &self.tokens[at];
            let unknown = (token.capital || token.kind != TokenKind::Word) && at > first && strange < 3;
            let described = noun.article != Article::None && strange < 2 && self.may_describe(at);
            if !(unknown || described) || self.verb_stands(at) {
                return self.only_named(noun, first, at, company, make);
            }
            if token.capital && token.kind == TokenKind::Word {
                noun.names.push(token.text.clone());
            }
            strange += 1;
            at += 1;
        };
        let (mut noun, length) = self.heads(noun, first, at, company, make, head)?;
        // "a single car collision", "South Van Ness".
        let crash = matches!(self.text(first + length), "collision" | "crash" | "accident" | "incident");
        let street = noun.article == Article::None
            && length == 1
            && first > self.first
            && self.tokens[first].capital
            && self.text(first) == "van"
            && self.tokens.get(first + 1).is_some_and(|next| next.capital);
        if crash && !noun.subject && noun.occupant.is_none() && noun.number.is_none() || street {
            return None;
        }
        if one_of {
            (noun.one_of, noun.several) = (noun.several, false);
            noun.article = if noun.one_of { Article::Indefinite } else { Article::Definite };
        }
        Some((noun, length))
    }

    /// Whether a word that nobody knows may stand before a noun, as in "a charter bus": no small word, and the noun is next.
    fn may_describe(&self, at: usize) -> bool {
        let word = self.text(at);
        let small = matches!(
            word,
            "and"
                | "or"
                | "but"
                | "then"
                | "when"
                | "as"
                | "while"
                | "that"
                | "which"
                | "who"
                | "where"
                | "is"
                | "was"
                | "were"
                | "are"
                | "be"
                | "been"
                | "had"
                | "has"
                | "have"
                | "it"
                | "they"
                | "not"
                | "due"
                | "because"
                | "after"
                | "before"
                | "until"
                | "once"
                | "if"
                | "than"
                | "'s"
                | "side"
                | "part"
                | "half"
                | "end"
                | "corner"
                | "middle"
                | "edge"
                | "top"
                | "back"
                | "both"
                | "all"
                | "some"
                | "only"
                | "did"
                | "could"
                | "would"
                | "time"
                | "same"
                | "during"
                | "behind"
                | "between"
        ) || PREPOSITIONS.contains(&word)
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

    pub(super) fn verb_stands(&self, at: usize) -> bool {
        !self.tokens[at].capital
            && self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Verb(..))).is_some()
    }

    /// "the Waymo", "a Toyota": a name without a noun.
    pub(super) fn only_named(
        &self,
        mut noun: Noun,
        first: usize,
        at: usize,
        company: bool,
        make: bool,
    ) -> Option<(Noun, usize)> {
        let article = noun.article != Article::None;
        if at <= first || !article || !(company || make) {
            return None;
        }
        if company {
            noun.subject = true;
        } else {
            noun.kind = Some(Kind::Vehicle);
        }
        self.finish(noun, first, at)
    }

    pub(super) fn head(&self, at: usize) -> Option<(Meaning, usize)> {
        let found = self.lexicon.longest(self.tokens, at, |meaning| {
            matches!(meaning, Meaning::Subject | Meaning::Kind(_) | Meaning::Occupant(_))
        })?;
        let part = self.part(at).map_or(0, |(_, length)| length);
        // "passenger side", "driver door" are parts.
        if matches!(found.meaning, Meaning::Occupant(_))
            && (part > found.length || (part > 0 && self.part(at + part).is_some()))
        {
            return None;
        }
        if matches!(self.text(at + found.length), "rack" | "racks" | "lane" | "lanes" | "path" | "share" | "yard")
            && !matches!(found.meaning, Meaning::Subject)
        {
            return None;
        }
        // "light", "sign" of "traffic sign" and "stop sign" are no things that are struck, unless they are.
        if self.text(at) == "traffic"
            && matches!(
                self.text(at + 1),
                "light"
                    | "lights"
                    | "signal"
                    | "signals"
                    | "circle"
                    | "lane"
                    | "lanes"
                    | "control"
                    | "congestion"
                    | "stop"
                    | "conditions"
                    | "queue"
                    | "sign"
                    | "cone"
                    | "barrier"
                    | "island"
                    | "cones"
            )
        {
            return None;
        }
        // "the leaf of the gate", "a tight fit": names of models are written large.
        let model = self.lexicon.is_model(self.text(at));
        let of_company = self.text(at) == "pilot"
            && (self.text(at + 1).starts_with("assist")
                || at > 0 && matches!(self.tokens[at - 1].text.as_str(), "drive" | "highway"));
        if model && found.length == 1 && (!self.tokens[at].capital || of_company) {
            return None;
        }
        if matches!(self.text(at), "sign") && at > self.first && matches!(self.text(at - 1), "stop" | "yield") {
            return None;
        }
        Some((found.meaning, found.length))
    }

    pub(super) fn heads(
        &self,
        mut noun: Noun,
        first: usize,
        at: usize,
        company: bool,
        make: bool,
        head: (Meaning, usize),
    ) -> Option<(Noun, usize)> {
        let mut at = at;
        let mut head = Some(head);
        let mut subject = company;
        let mut plural = false;
        while let Some((meaning, length)) = head {
            match meaning {
                Meaning::Subject => {
                    subject = true;
                    // "An automated shuttle": "the shuttle" further on.
                    noun.kind = noun.kind.or(match self.text(at + length - 1) {
                        _ if length == 1 => None,
                        "shuttle" | "bus" => Some(Kind::Bus),
                        "truck" => Some(Kind::HeavyTruck),
                        _ => None,
                    });
                }
                Meaning::Kind(Kind::Trailer) if noun.kind.is_some_and(|kind| kind.group() == KindGroup::Truck) => {
                    noun.kind = Some(Kind::SemiTrailerTruck);
                }
                Meaning::Kind(Kind::Trailer) if noun.kind == Some(Kind::Pickup) => {
                    noun.kind = Some(Kind::PickupWithTrailer)
                }
                Meaning::Kind(kind) => {
                    if length == 1 && self.lexicon.is_model(self.text(at)) {
                        noun.names.push(self.text(at).to_owned());
                    }
                    noun.tractor = length == 1 && self.text(at) == "tractor";
                    // "a passenger sedan" carries passengers, and is none.
                    if kind.is_vehicle() && matches!(noun.occupant, Some((Occupant::Rider, _))) {
                        (noun.occupant, noun.owner) = (None, None);
                    }
                    noun.kind = Some(kind);
                    plural = matches!(self.text(at + length - 1), "people" | "personnel" | "traffic")
                        || self.text(at + length - 1).ends_with('s')
                            && !matches!(self.text(at + length - 1), "bus" | "debris" | "cross");
                }
                Meaning::Occupant(who) => {
                    let owner = Noun { occupant: None, owner: None, names: noun.names.clone(), ..noun.clone() };
                    let owned = subject || noun.kind.is_some() || make;
                    if owned {
                        noun.owner = Some(Box::new(Noun { subject, kind: noun.kind.or(Some(Kind::Vehicle)), ..owner }));
                    }
                    let plain = matches!(self.text(at), "driver" | "drivers") && length == 1;
                    noun.occupant = Some((who, plain));
                    noun.kind = None;
                    subject = false;
                }
                _ => {}
            }
            at += length;
            let numbered = noun.kind == Some(Kind::Vehicle) || self.text(at - 1) == "car";
            if let (Some(number), true) = (self.text(at).parse().ok(), numbered) {
                // "car 1" is who reports.
                subject |= number == 1;
                noun.number = Some(number).filter(|number| *number > 1);
                at += 1;
            }
            // "AV 2", "a different AV": another one of the same company.
            if let (true, Some(number)) =
                (subject, self.text(at).parse::<u8>().ok().filter(|number| (1..=4).contains(number)))
            {
                at += 1;
                if number > 1 {
                    (subject, noun.kind, noun.number) = (false, Some(Kind::PassengerCar), Some(number));
                }
            }
            // Another noun at once makes a compound: "pickup truck driver", "Waymo AV operator". An adjective does not.
            head = self.head(at).filter(|(next, _)| {
                self.text(at) != "'s" && !(matches!(next, Meaning::Subject) && noun.kind.is_some() && !subject)
            });
            if matches!(head, Some((Meaning::Kind(kind), _)) if noun.occupant.is_some() && !kind.is_vehicle()) {
                head = None;
            }
        }
        if subject
            && noun.occupant.is_none()
            && noun.adjectives.iter().any(|adjective| matches!(adjective, Adjective::Another | Adjective::Other))
        {
            subject = false;
            noun.kind = noun.kind.or(Some(Kind::PassengerCar));
        }
        noun.subject = (subject || self.text(first) == "our") && noun.occupant.is_none();
        noun.several |= plural;
        let alone = (first..at).any(|at| {
            matches!(self.text(at), "abandoned" | "parked" | "unattended" | "riderless" | "fallen" | "unoccupied")
        });
        if alone && matches!(noun.kind, Some(Kind::ScooterRider | Kind::Bicycle | Kind::EBike)) {
            noun.kind = Some(Kind::Scooter);
        }
        self.finish(noun, first, at)
    }

    /// What stands behind a noun and belongs to it: "(Vehicle 2)", "of the bus", "'s rear bumper" is left to others.
    pub(super) fn finish(&self, mut noun: Noun, first: usize, at: usize) -> Option<(Noun, usize)> {
        let mut at = at;
        if let Some(number) = self.alias(at) {
            noun.subject |= number == 1;
            noun.number = Some(number).filter(|number| *number > 1);
            // "the motorcycle (Vehicle 2) operator".
            let behind = at + self.parenthesis(at);
            if let Some((Meaning::Occupant(who), length)) = self.head(behind).filter(|_| noun.occupant.is_none()) {
                let owner = noun.clone();
                (noun.owner, noun.occupant, noun.kind, noun.subject) =
                    (Some(Box::new(owner)), Some((who, false)), None, false);
                at = behind + length;
            }
        }
        if noun.occupant.is_some() && noun.owner.is_none() {
            let mut behind = at;
            if self.text(behind) == "(" {
                behind += self.parenthesis(behind);
            }
            if matches!(
                self.text(behind),
                "of" | "in" | "inside" | "from" | "operating" | "driving" | "on" | "within" | "aboard"
            ) && let Some((owner, length)) = self.noun(behind + 1)
                && (owner.subject || owner.kind.is_some_and(can_own))
                && owner.occupant.is_none()
            {
                noun.owner = Some(Box::new(owner));
                at = behind + 1 + length;
            }
        }
        // "a person in the driver's seat of the van" is somebody in the van.
        if noun.kind == Some(Kind::Pedestrian)
            && let Some((owner, behind)) = self.seated(at)
        {
            (noun.owner, noun.occupant, noun.kind) = (Some(Box::new(owner)), Some((Occupant::Rider, false)), None);
            return Some((noun, behind - first));
        }
        // "a person on a scooter", "a rider of a bicycle" is who rides it.
        let on_foot = noun
            .kind
            .is_some_and(|kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist | KindGroup::Motorcycle))
            || (noun.occupant.is_some() && noun.owner.is_none());
        let mut ride = at;
        while matches!(
            self.text(ride),
            "on" | "riding"
                | "operating"
                | "using"
                | "who"
                | "was"
                | "were"
                | "of"
                | "in"
                | "his"
                | "her"
                | "top"
                | "driving"
        ) && ride < at + 4
        {
            ride += 1;
        }
        if on_foot
            && ride > at
            && let Some((ridden, length)) = self.noun(ride)
        {
            let wheels = matches!(
                ridden.kind,
                Some(
                    Kind::Bicycle
                        | Kind::EBike
                        | Kind::ScooterRider
                        | Kind::Skateboarder
                        | Kind::Motorcycle
                        | Kind::Moped
                        | Kind::Wheelchair
                )
            );
            if wheels && ridden.occupant.is_none() {
                let several = noun.several;
                noun.kind = ridden.kind;
                (noun.occupant, noun.owner, noun.several) = (None, None, several);
                at = ride + length;
            }
        }
        // "the truck's flatbed trailer" is the truck.
        if let Some(behind) = (self.text(at) == "'s").then(|| self.trailer(at + 1)).flatten()
            && noun.kind.is_some_and(Kind::is_vehicle)
        {
            if noun.kind.is_some_and(|kind| kind.group() == KindGroup::Truck) {
                noun.kind = Some(Kind::SemiTrailerTruck);
            }
            return Some((noun, behind - first));
        }
        // Possessive: the owner of what follows, a part or somebody inside.
        if self.text(at) == "'s"
            && let Some((mut person, length)) = self.owned_person(at + 1)
        {
            person.owner = Some(Box::new(noun));
            return Some((person, at + 1 + length - first));
        }
        Some((noun, at - first))
    }

    /// The vehicle in which somebody is by the words here, and the token behind it: "sitting in the back seat of the van".
    fn seated(&self, at: usize) -> Option<(Noun, usize)> {
        let mut behind = at;
        while matches!(self.text(behind), "who" | "was" | "sitting" | "seated" | "sat" | "waiting") {
            behind += 1;
        }
        if !matches!(self.text(behind), "in" | "inside" | "aboard") {
            return None;
        }
        behind += 1;
        if let Some(seat) = (behind..behind + 6).find(|&at| self.text(at) == "seat") {
            behind = seat + 1 + usize::from(matches!(self.text(seat + 1), "of" | "in"));
        }
        let (owner, length) = self.noun(behind)?;
        let vehicle = owner.subject
            || owner.kind.is_some_and(Kind::is_vehicle)
                && (owner.kind != Some(Kind::Vehicle) || !owner.names.is_empty());
        (vehicle && owner.occupant.is_none() && !owner.several).then_some((owner, behind + length))
    }

    /// Behind a trailer that stands here, with at most two words before it.
    fn trailer(&self, at: usize) -> Option<usize> {
        let found = (at..at + 3).find(|&at| matches!(self.text(at), "trailer" | "chassis" | "container" | "load"))?;
        (at..found).all(|at| self.tokens[at].kind == TokenKind::Word).then_some(found + 1)
    }

    pub(super) fn owned_person(&self, at: usize) -> Option<(Noun, usize)> {
        let (noun, length) = self.noun(at).filter(|(noun, _)| noun.article == Article::None)?;
        (noun.occupant.is_some() && noun.owner.is_none()).then_some((noun, length))
    }
}

/// Whether a thing of this kind has parts and people in it.
fn can_own(kind: Kind) -> bool {
    kind.group() != KindGroup::Animal || kind == Kind::Animal
}
