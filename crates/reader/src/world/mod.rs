//! Who is in the story, and who is meant by a noun.

mod kinds;
mod meant;

use crate::chunk::Noun;
use crate::lexicon::{Adjective, Relation};
use kinds::{acts, relation_of};
use recrash_model::account::{Compass, Kind, KindGroup, LaneWord};

pub use kinds::{is_no_passenger_vehicle, same_kind};

/// Somebody or something in the story, by its place in [`World::actors`].
pub type Actor = usize;

/// The subject vehicle.
pub const SUBJECT: Actor = 0;

/// What is known of somebody.
#[derive(Debug, Clone, Default)]
pub struct Known {
    /// Kind.
    pub kind: Option<Kind>,
    /// Tokens of the noun that told the kind.
    pub kind_tokens: Option<(usize, usize)>,
    /// Makes and colours.
    pub names: Vec<String>,
    /// The number of "Vehicle 2".
    pub number: Option<u8>,
    /// "A second one", "another": it was brought on as another one of its kind.
    pub another: bool,
    /// It was brought on as the second, or so.
    pub ordinal: Option<u8>,
    /// Others are told to stand between it and the subject vehicle.
    pub farther: bool,
    /// It was brought on as another one with a name of the subject vehicle.
    pub namesake: bool,
    /// More than one.
    pub several: bool,
    /// The headline named it, and the story has not yet.
    pub announced: bool,
    /// Where it is, seen from the subject vehicle, and the sentence that says so.
    pub relations: Vec<(Relation, usize)>,
    /// Where it is, seen from another than the subject vehicle.
    pub seen_from: Vec<(Relation, Actor)>,
    /// Direction first told, with its tokens.
    pub heading: Option<(Compass, usize, usize)>,
    /// Lane first told, with its tokens.
    pub lane: Option<(LaneWord, usize, usize)>,
    /// When it was named last.
    pub last: usize,
    /// The sentence that named it last.
    pub sentence: Option<usize>,
    /// How often it was named.
    pub mentions: usize,
    /// A clause was about it.
    pub acted: bool,
    /// The group that it is one of.
    pub group: Option<Actor>,
    /// Where it is, is where its group is, of itself nothing is told.
    pub as_group: bool,
    /// It was called a tractor.
    pub tractor: bool,
    /// It was called a passenger vehicle.
    pub passenger: bool,
    /// It was called parked, or told to stand.
    pub parked: bool,
    /// Who tows it.
    pub towed_by: Option<Actor>,
}

impl Known {
    /// Whether it does things: it is no thing, as far as is told.
    pub fn acts(&self) -> bool {
        self.kind.is_none_or(acts)
    }

    /// Whether it was told of for its place alone: "passed it and the vehicle behind it".
    fn is_bystander(&self) -> bool {
        self.kind == Some(Kind::Vehicle) && !self.acted && self.mentions == 1 && !self.relations.is_empty()
    }

    /// Notes where it is, once.
    pub fn place(&mut self, relation: Relation, sentence: usize) {
        if !self.relations.iter().any(|(known, _)| *known == relation) {
            // "Two cars were ahead. One of them was on its left": there.
            if std::mem::take(&mut self.as_group) {
                self.relations.clear();
            }
            self.relations.push((relation, sentence));
        }
    }
}

/// What is known of the subject vehicle beforehand.
#[derive(Debug, Clone, Copy, Default)]
pub struct Own<'a> {
    /// Its kind.
    pub kind: Option<Kind>,
    /// The make by which the company that reports calls it.
    pub make: Option<&'a str>,
    /// The first word of the company's name, written small: a vehicle called by it is the subject vehicle, as with companies that
    /// the lexicon knows.
    pub company: &'a str,
    /// What the record calls the vehicle: it is meant by "the Volvo" where nobody was named before.
    pub vehicle: &'a str,
    /// A word for the road user that the record says it crashed with: meant by a noun that nobody knows, where nobody else is named.
    pub partner: Option<&'a str>,
}

/// Everybody in the story.
#[derive(Debug, Clone)]
pub struct World {
    /// The subject vehicle first.
    pub actors: Vec<Known>,
    clock: usize,
    /// Words of what the record calls the subject vehicle.
    vehicle: Vec<String>,
    /// "The driver" drives the subject vehicle.
    pub own_driver: bool,
    /// The subject vehicle was first called "the vehicle".
    pub plain: bool,
    /// The noun that is looked up owns the part which touches: "the front of the van made contact".
    pub touches: bool,
    /// Its clause tells that it struck the subject vehicle, or was struck by it, which it cannot be then.
    pub strikes: bool,
    /// A number stands behind the noun that is looked up: "Shuttle 4".
    pub counted: bool,
    /// So many others are told to stand between the noun that is looked up and the subject vehicle.
    pub apart: bool,
    /// The noun that is looked up stands behind "behind": "stopped behind a van".
    pub before: bool,
    /// Who the sentence that is read is about, as far as it is read.
    pub main: Option<Actor>,
    /// The record says that it crashed with a car.
    with_car: bool,
    /// It says that it crashed with a vehicle of any kind.
    with_vehicle: bool,
    /// The noun that is looked up begins its sentence.
    begins: bool,
    /// First token of the sentence that is read.
    pub first: usize,
    /// Number of the sentence that is read.
    pub sentence: usize,
    /// Who the sentence, or the one before, is about.
    pub topic: Actor,
}

impl World {
    /// A world with the subject vehicle in it.
    pub fn new(own: Own<'_>) -> Self {
        let names = own.make.into_iter().map(str::to_owned).collect();
        let words = own.vehicle.split(|c: char| !c.is_alphanumeric());
        let vehicle = words.filter(|word| word.len() > 2).map(str::to_lowercase).collect();
        let subject = Known { kind: own.kind, names, ..Known::default() };
        Self {
            actors: vec![subject],
            clock: 0,
            vehicle,
            own_driver: false,
            plain: false,
            touches: false,
            strikes: false,
            counted: false,
            apart: false,
            before: false,
            main: None,
            with_car: own.partner == Some("car"),
            with_vehicle: matches!(own.partner, Some("car" | "suv" | "van" | "pickup" | "truck" | "bus")),
            begins: false,
            first: 0,
            sentence: 0,
            topic: SUBJECT,
        }
    }

    /// Who is meant by a noun. `hint`: where the words behind the noun say that it is, seen from the subject vehicle.
    pub fn resolve(&mut self, noun: &Noun, tokens: (usize, usize), hint: Option<Relation>) -> Actor {
        // "One of the cyclists" comes from where they all do.
        let group = noun.kind.filter(|_| noun.one_of).and_then(|kind| {
            let fits = |known: Kind| known == kind || kind == Kind::Vehicle || ride(kind, known);
            (1..self.actors.len())
                .rfind(|&group| self.actors[group].several && self.actors[group].kind.is_some_and(fits))
        });
        self.begins = tokens.0 == self.first;
        let actor = self.find(noun, hint).unwrap_or_else(|| self.add(noun));
        if let Some(group) = group.filter(|group| *group != actor) {
            self.join(actor, group, noun);
        }
        let actor = self.actors[actor].towed_by.unwrap_or(actor);
        self.clock += 1;
        let known = &mut self.actors[actor];
        known.sentence = Some(self.sentence);
        known.tractor |= noun.tractor;
        known.passenger |= noun.passenger && noun.occupant.is_none();
        known.parked |= noun.occupant.is_none() && noun.adjectives.contains(&Adjective::Parked);
        known.last = self.clock;
        known.mentions += 1;
        if actor == SUBJECT && noun.subject {
            // "The Prius" of "a Parcelway Prius".
            let new = noun.names.iter().filter(|name| crate::lexicon::Lexicon::get().is_model(name));
            known.names.extend(new.cloned());
        }
        if actor != SUBJECT
            && let Some(owner) = noun.owner.as_deref().filter(|_| noun.occupant.is_some())
        {
            refine(known, owner, tokens);
        } else if actor != SUBJECT && noun.occupant.is_none() {
            refine(known, noun, tokens);
        } else if noun.subject && noun.kind.is_some_and(|kind| kind.group() == KindGroup::Truck) {
            known.kind = known.kind.or(noun.kind);
        }
        let drawn = noun.tractor || matches!(noun.kind, Some(Kind::Trailer | Kind::SemiTrailerTruck));
        if actor == SUBJECT && noun.occupant.is_none() && drawn {
            self.draws_own_trailer();
        }
        let known = &mut self.actors[actor];
        if let Some(relation) = relation_of(noun)
            && noun.occupant.is_none()
            && actor != SUBJECT
        {
            known.place(relation, self.sentence);
        }
        if let (Some(compass), true, None) =
            (noun.compass, noun.occupant.is_none() || noun.owner.is_some(), known.heading)
        {
            known.heading = Some((compass, tokens.0, tokens.1));
        }
        actor
    }

    /// One of a group goes where that goes, and is where it is; and is what it is, where its noun says no more.
    fn join(&mut self, actor: Actor, group: Actor, noun: &Noun) {
        let of = self.actors[group].clone();
        let known = &mut self.actors[actor];
        known.heading = known.heading.or(of.heading);
        known.group = Some(group);
        if known.relations.is_empty() {
            (known.relations, known.as_group) = (of.relations, true);
        }
        let generic = noun.kind.is_some_and(|kind| kind == Kind::Vehicle || of.kind.is_some_and(|of| ride(kind, of)));
        if generic && known.kind.is_none_or(|kind| matches!(kind, Kind::Vehicle | Kind::Pedestrian)) {
            (known.kind, known.kind_tokens) = (of.kind, of.kind_tokens);
        }
    }

    /// What a noun besides its own says of somebody: "Vehicle 2, a black van".
    pub fn describe(&mut self, actor: Actor, noun: &Noun, tokens: (usize, usize)) {
        if actor != SUBJECT {
            refine(&mut self.actors[actor], noun, tokens);
            // "an object, apparently a chair".
            let known = &mut self.actors[actor];
            if known.kind == Some(Kind::Object) && noun.kind.is_some_and(|kind| kind.group() == KindGroup::Object) {
                (known.kind, known.kind_tokens) = (noun.kind, Some(tokens));
            }
        } else if self.actors[SUBJECT].kind.is_none() {
            self.actors[SUBJECT].kind = noun.kind;
        }
        for name in &noun.names {
            if !self.actors[actor].names.contains(name) {
                self.actors[actor].names.push(name.clone());
            }
        }
    }

    /// Who struck the subject vehicle where nobody is named: who is known to be behind it, or acted last; else somebody who is
    /// named later.
    pub fn striker(&mut self, behind: bool) -> Actor {
        let there = |known: &Known| known.relations.iter().any(|(relation, _)| *relation == Relation::Behind);
        let known = self.latest(|known| {
            known.kind.is_some_and(|kind| kind.is_vehicle() || kind.group() == KindGroup::Motorcycle)
                && !known.several
                && if behind { there(known) } else { known.acted }
        });
        known.unwrap_or_else(|| {
            self.actors.push(Known { kind: Some(Kind::Vehicle), announced: true, ..Known::default() });
            self.actors.len() - 1
        })
    }

    /// One tows the other: from here on they are one.
    pub fn tow(&mut self, tower: Actor, towed: Actor) {
        if tower == towed || towed == SUBJECT || self.actors[tower].towed_by.is_some() {
            return;
        }
        // "struck a parked trailer, dragging it".
        if tower == SUBJECT && self.actors[towed].parked {
            return;
        }
        self.actors[towed].towed_by = Some(tower);
        let kind = match self.actors[tower].kind {
            Some(Kind::HeavyTruck | Kind::SemiTrailerTruck) => Kind::SemiTrailerTruck,
            Some(kind) if !kind.is_vehicle() => kind,
            Some(kind) if kind.group() == KindGroup::Truck => kind,
            _ => Kind::PickupWithTrailer,
        };
        // "A pickup pulling a food truck trailer": no pickup pulls a truck.
        let pulled = [Kind::Trailer, Kind::SemiTrailerTruck];
        let trailer = match self.actors[tower].kind {
            Some(Kind::Pickup) => self.actors[towed].kind.is_some_and(|kind| pulled.contains(&kind)),
            _ => self.actors[towed].kind == Some(Kind::Trailer),
        };
        if tower == SUBJECT && trailer {
            self.draws_own_trailer();
        } else if trailer {
            self.actors[tower].kind = Some(kind);
        }
    }

    /// "Our trailer", "the AV's trailer": whoever the subject vehicle was called before, it is a truck that draws one.
    fn draws_own_trailer(&mut self) {
        let known = &mut self.actors[SUBJECT];
        if matches!(known.kind, None | Some(Kind::HeavyTruck | Kind::Trailer)) {
            known.kind = Some(Kind::SemiTrailerTruck);
        }
    }

    /// Who towed a trailer tows it no more: the trailer.
    pub fn let_go(&mut self, tower: Actor) -> Option<Actor> {
        let towed = |known: &Known| known.towed_by == Some(tower) && known.kind == Some(Kind::Trailer);
        let loose = self.actors.iter().position(towed)?;
        self.actors[loose].towed_by = None;
        let known = &mut self.actors[tower];
        known.kind = match known.kind {
            Some(Kind::PickupWithTrailer) => Some(Kind::Pickup),
            kind => kind,
        };
        Some(loose)
    }

    /// Who is meant by `it`.
    pub fn pronoun(&self) -> Actor {
        self.topic
    }

    fn latest(&self, wanted: impl Fn(&Known) -> bool) -> Option<Actor> {
        (1..self.actors.len())
            .filter(|&actor| wanted(&self.actors[actor]))
            .max_by_key(|&actor| (self.actors[actor].acted, self.actors[actor].last))
    }

    fn add(&mut self, noun: &Noun) -> Actor {
        let another = noun.adjectives.contains(&Adjective::Another);
        let (several, ordinal, namesake) = (noun.several, noun.ordinal, noun.namesake);
        let farther = self.apart;
        self.actors.push(Known { several, another, ordinal, namesake, farther, ..Known::default() });
        self.actors.len() - 1
    }

    /// Who else was named last.
    pub fn other(&self) -> Option<Actor> {
        self.latest(|known| known.acts() && known.mentions > 0)
    }

    /// The thing that was named last.
    pub fn thing(&self) -> Option<Actor> {
        // "a bin that stood away from the curb": a curb is a place first.
        (1..self.actors.len())
            .max_by_key(|&actor| (self.actors[actor].kind != Some(Kind::Curb), self.actors[actor].last))
    }

    /// Another one of its kind: who is known, or somebody new.
    pub fn twin(&mut self, actor: Actor) -> Actor {
        self.like(actor).unwrap_or_else(|| {
            let known = Known { kind: self.actors[actor].kind, another: true, mentions: 1, ..Known::default() };
            self.actors.push(known);
            self.actors.len() - 1
        })
    }

    /// Somebody else of its kind, the one named last.
    pub fn like(&self, actor: Actor) -> Option<Actor> {
        let kind = self.actors[actor].kind?;
        (1..self.actors.len())
            .filter(|&other| other != actor && !self.actors[other].announced && !self.actors[other].several)
            .filter(|&other| self.actors[other].kind.is_some_and(|known| same_kind(known, kind)))
            .max_by_key(|&other| self.actors[other].last)
    }

    /// Somebody else of its kind, where nobody touches itself: also whom only the headline has named so far.
    pub fn other_like(&mut self, actor: Actor) -> Option<Actor> {
        let kind = self.actors[actor].kind;
        let announced = |other: &Actor| self.actors[*other].announced && self.actors[*other].kind == kind;
        let found =
            self.like(actor).or_else(|| (1..self.actors.len()).find(|other| *other != actor && announced(other)))?;
        self.clock += 1;
        let known = &mut self.actors[found];
        (known.last, known.sentence, known.acted, known.announced) = (self.clock, Some(self.sentence), true, false);
        Some(found)
    }

    /// Who is called by this name.
    pub fn by_name(&self, name: &str) -> Option<Actor> {
        (1..self.actors.len()).rfind(|&actor| self.actors[actor].names.iter().any(|known| known == name))
    }
}

/// "Two children on bicycles ..., one of the children": whether those of the first kind may be those who ride as the second.
fn ride(said: Kind, known: Kind) -> bool {
    let rides = matches!(known.group(), KindGroup::Cyclist | KindGroup::OnFoot) && known != Kind::Pedestrian;
    said == Kind::Pedestrian && rides
}

/// Takes over what a noun says of somebody: its kind where that says more, names, number.
fn refine(known: &mut Known, noun: &Noun, tokens: (usize, usize)) {
    let finer = match (known.kind, noun.kind) {
        (None, Some(_)) => true,
        (Some(Kind::Vehicle), Some(kind)) => kind != Kind::Vehicle,
        (Some(Kind::HeavyTruck), Some(kind)) => {
            kind.group() == KindGroup::Truck && kind != Kind::HeavyTruck && kind != Kind::Trailer
        }
        (Some(Kind::Pickup), Some(Kind::PickupWithTrailer)) => true,
        (Some(Kind::Bicycle), Some(Kind::EBike)) => true,
        (Some(Kind::PassengerCar), Some(Kind::PoliceCar)) => true,
        _ => false,
    };
    if finer {
        known.kind = noun.kind;
        known.kind_tokens = Some(tokens);
    }
    for name in &noun.names {
        if !known.names.contains(name) {
            known.names.push(name.clone());
        }
    }
    known.number = known.number.or(noun.number);
    known.several |= noun.several;
    let real = noun.kind.is_some();
    known.announced &= !real;
}
