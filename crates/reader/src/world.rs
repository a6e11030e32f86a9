//! Who is in the story, and who is meant by a noun.

use crate::chunk::{Article, Noun};
use crate::lexicon::{Adjective, Occupant, Relation};
use recrash_model::account::{Compass, Kind, KindGroup, LaneWord};

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
    /// More than one.
    pub several: bool,
    /// The headline named it, and the story has not yet.
    pub announced: bool,
    /// Where it is, seen from the subject vehicle, and the sentence that says so.
    pub relations: Vec<(Relation, usize)>,
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
    /// It was called a tractor.
    pub tractor: bool,
    /// It was called parked, or told to stand.
    pub parked: bool,
    /// Who tows it.
    pub towed_by: Option<Actor>,
}

impl Known {
    /// Notes where it is, once.
    pub fn place(&mut self, relation: Relation, sentence: usize) {
        if !self.relations.iter().any(|(known, _)| *known == relation) {
            self.relations.push((relation, sentence));
        }
    }
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
    /// Number of the sentence that is read.
    pub sentence: usize,
    /// Who the sentence, or the one before, is about.
    pub topic: Actor,
}

impl World {
    /// A world with the subject vehicle in it.
    pub fn new(own: crate::frame::Own<'_>) -> Self {
        let names = own.make.into_iter().map(str::to_owned).collect();
        let words = own.vehicle.split(|c: char| !c.is_alphanumeric());
        let vehicle = words.filter(|word| word.len() > 2).map(str::to_lowercase).collect();
        let subject = Known { kind: own.kind, names, ..Known::default() };
        Self { actors: vec![subject], clock: 0, vehicle, own_driver: false, plain: false, sentence: 0, topic: SUBJECT }
    }

    /// Who is meant by a noun. `hint`: where the words behind the noun say that it is, seen from the subject vehicle.
    pub fn resolve(&mut self, noun: &Noun, tokens: (usize, usize), hint: Option<Relation>) -> Actor {
        // "One of the cyclists" comes from where they all do.
        let group = noun.kind.filter(|_| noun.one_of).and_then(|kind| {
            let fits = |known: Kind| known == kind || kind == Kind::Vehicle;
            (1..self.actors.len())
                .rfind(|&group| self.actors[group].several && self.actors[group].kind.is_some_and(fits))
        });
        let actor = self.find(noun, hint).unwrap_or_else(|| self.add(noun));
        if let Some(group) = group.filter(|group| *group != actor) {
            let of = self.actors[group].clone();
            let known = &mut self.actors[actor];
            known.heading = known.heading.or(of.heading);
            known.group = Some(group);
            if known.relations.is_empty() {
                known.relations = of.relations;
            }
            if noun.kind == Some(Kind::Vehicle) && known.kind.is_none_or(|kind| kind == Kind::Vehicle) {
                (known.kind, known.kind_tokens) = (of.kind, of.kind_tokens);
            }
        }
        let actor = self.actors[actor].towed_by.unwrap_or(actor);
        self.clock += 1;
        let known = &mut self.actors[actor];
        known.sentence = Some(self.sentence);
        known.tractor |= noun.tractor;
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
        if let Some(relation) = relation_of(noun)
            && noun.occupant.is_none()
            && actor != SUBJECT
        {
            known.place(relation, self.sentence);
        }
        if let (Some(compass), true, None) = (noun.compass, noun.occupant.is_none(), known.heading) {
            known.heading = Some((compass, tokens.0, tokens.1));
        }
        actor
    }

    /// What a noun besides its own says of somebody: "Vehicle 2, a black van".
    pub fn describe(&mut self, actor: Actor, noun: &Noun, tokens: (usize, usize)) {
        if actor != SUBJECT {
            refine(&mut self.actors[actor], noun, tokens);
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
        self.actors[towed].towed_by = Some(tower);
        let kind = match self.actors[tower].kind {
            Some(Kind::HeavyTruck | Kind::SemiTrailerTruck) => Kind::SemiTrailerTruck,
            Some(kind) if !kind.is_vehicle() => kind,
            Some(Kind::TowTruck) => Kind::TowTruck,
            _ => Kind::PickupWithTrailer,
        };
        let trailer = self.actors[towed].kind == Some(Kind::Trailer);
        if tower != SUBJECT && trailer {
            self.actors[tower].kind = Some(kind);
        }
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

    fn find(&mut self, noun: &Noun, hint: Option<Relation>) -> Option<Actor> {
        if let Some((who, plain)) = noun.occupant {
            return Some(self.occupant(noun, who, plain, hint));
        }
        if noun.subject {
            return Some(SUBJECT);
        }
        if let Some(number) = noun.number {
            let known = self.latest(|known| known.number == Some(number));
            if known.is_some() {
                return known;
            }
        }
        let by_own_make = noun.article == Article::Definite
            && noun.names.iter().any(|name| self.actors[SUBJECT].names.contains(name));
        let unnamed = self.actors.len() == 1 && self.actors[SUBJECT].mentions == 0;
        if let (true, Article::Definite, Some(name)) =
            (unnamed, noun.article, noun.names.iter().find(|name| self.vehicle.contains(*name)))
        {
            self.actors[SUBJECT].names.push(name.clone());
            return Some(SUBJECT);
        }
        if by_own_make && !self.actors[1..].iter().any(|known| known.names.iter().any(|name| noun.names.contains(name)))
        {
            return Some(SUBJECT);
        }
        let kind = noun.kind?;
        // "The shuttle was in its lane": the first whom a story names as known is whom it is told of.
        let known = noun.article == Article::Definite && noun.adjectives.is_empty() && !noun.several;
        let things = self.actors[1..].iter().all(|known| known.kind.is_some_and(|kind| !acts(kind)));
        let unnamed = things && self.actors[SUBJECT].mentions == 0;
        if unnamed && known && hint.is_none() && matches!(kind.group(), KindGroup::Truck) {
            self.actors[SUBJECT].kind.get_or_insert(kind);
            return Some(SUBJECT);
        }
        if noun.article == Article::None
            && !noun.several
            && matches!(kind, Kind::Bus)
            && self.actors[SUBJECT].kind == Some(kind)
        {
            return Some(SUBJECT);
        }
        // "An Acme AV ("AV") Peterbilt semi-truck": what it is, behind its name.
        let alone = self.actors.len() == 1 && self.actors[SUBJECT].mentions > 0;
        let truck_name = kind == Kind::SemiTrailerTruck && !noun.names.is_empty();
        if noun.article == Article::None && !noun.several && alone && truck_name {
            self.actors[SUBJECT].kind.get_or_insert(kind);
            return Some(SUBJECT);
        }
        let has = |adjective: Adjective| noun.adjectives.contains(&adjective);
        // "The shuttle" of a story that a shuttle tells, and that knows no other one.
        let truck = |kind: Kind| matches!(kind, Kind::HeavyTruck | Kind::SemiTrailerTruck);
        let own = self.actors[SUBJECT]
            .kind
            .is_some_and(|own| own == kind && kind.group() == KindGroup::Truck || truck(own) && truck(kind));
        if own
            && noun.article == Article::Definite
            && !noun.several
            && !has(Adjective::Other)
            && !has(Adjective::Another)
            && !self.actors[1..]
                .iter()
                .any(|known| known.kind.is_some_and(|known| known == kind || truck(known) && truck(kind)))
        {
            return Some(SUBJECT);
        }
        // "The front of the tractor": of a truck that tells, unless another one was called so.
        let named_so = self.actors[1..].iter().any(|known| known.tractor);
        if noun.tractor
            && noun.article == Article::Definite
            && self.actors[SUBJECT].kind.is_some_and(truck)
            && !named_so
        {
            return Some(SUBJECT);
        }
        let fits = |known: &Known| {
            (known.kind.is_none() || known.kind.is_some_and(|known| same_kind(known, kind)))
                && (noun.number.is_none() || known.number.is_none() || noun.number == known.number)
                && !contradicts(&known.names, &noun.names)
        };
        if has(Adjective::Another) && noun.article == Article::Definite {
            let known = self.latest(|known| known.another && fits(known));
            if known.is_some() {
                return known;
            }
        }
        if has(Adjective::Another) {
            // A second one of a kind; the announced one only where nobody of the kind was met.
            let met = self.latest(|known| fits(known) && !known.announced).is_some();
            return if met { None } else { self.latest(|known| known.announced && fits(known)) };
        }
        if noun.article == Article::Indefinite
            || (noun.article == Article::None && noun.names.is_empty() && !noun.several)
        {
            return self.latest(|known| {
                known.announced
                    && fits(known)
                    && known.several == noun.several
                    && known.kind.is_none_or(|known| introduces(known, kind))
            });
        }
        if noun.several && noun.article == Article::None {
            // Traffic that comes is not what is parked there.
            return self.latest(|known| known.several && fits(known) && (known.parked || !has(Adjective::Parked)));
        }
        if has(Adjective::First) {
            let first = (1..self.actors.len()).find(|&actor| {
                let known = &self.actors[actor];
                fits(known) && known.mentions > 0 && known.several == noun.several && !known.another
            });
            if first.is_some() {
                return first;
            }
        }
        if let Some(relation) = relation_of(noun).or(hint) {
            let there = self.latest(|known| {
                known.several == noun.several
                    && fits(known)
                    && known.relations.iter().any(|(place, _)| *place == relation)
            });
            if there.is_some() {
                return there;
            }
        }
        // "The parked car" is who was called so; who drives is not.
        let parked = has(Adjective::Parked) && !noun.several;
        let called = self.latest(|known| parked && known.parked && fits(known) && !known.several);
        if called.is_some() {
            return called;
        }
        let fits = |known: &Known| fits(known) && !(parked && known.acted && !known.parked);
        let named = self.latest(|known| {
            !noun.names.is_empty() && known.names.iter().any(|name| noun.names.contains(name)) && fits(known)
        });
        let exact = self.latest(|known| known.kind == Some(kind) && fits(known) && known.several == noun.several);
        let wide = self.latest(|known| fits(known) && known.several == noun.several);
        // "the scooter rider" of "two people riding scooters".
        let rider = matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist | KindGroup::Motorcycle);
        let one_of =
            || self.latest(|known| rider && known.several && !noun.several && known.kind == Some(kind) && fits(known));
        let found = named.or(exact).or(wide).or_else(one_of);
        // "The vehicle" of a story that knows no other one.
        if found.is_none()
            && hint.is_none()
            && (kind == Kind::Vehicle || kind == Kind::PassengerCar && self.plain && self.actors.len() == 1)
            && noun.names.is_empty()
            && !has(Adjective::Other)
            && noun.article == Article::Definite
        {
            self.plain |= self.actors[SUBJECT].mentions == 0;
            return Some(SUBJECT);
        }
        if found.is_none()
            && noun.article == Article::Definite
            && !has(Adjective::Other)
            && self.actors[SUBJECT].kind.is_some_and(|own| own == kind || same_kind(own, kind))
            && kind.group() == KindGroup::Truck
        {
            return Some(SUBJECT);
        }
        if let (Some(found), Kind::Vehicle, true) = (found, kind, noun.names.is_empty())
            && !has(Adjective::Other)
            && noun.adjectives.is_empty()
            && noun.article == Article::Definite
            && self.actors[found].kind != Some(Kind::Vehicle)
            && self.topic == SUBJECT
            && self.actors[SUBJECT].last > self.actors[found].last
        {
            return Some(SUBJECT);
        }
        found
    }

    fn occupant(&mut self, noun: &Noun, who: Occupant, plain: bool, hint: Option<Relation>) -> Actor {
        if let Some(owner) = &noun.owner {
            let owner = (**owner).clone();
            // "The driver of the vehicle behind it".
            let placed = hint.filter(|_| !owner.subject);
            return self.find(&owner, placed).unwrap_or_else(|| self.add(&owner));
        }
        match who {
            // "A driver ran the light": nobody who was named.
            Occupant::Driver if plain && noun.article == Article::Indefinite => {
                self.latest(|known| known.announced).unwrap_or_else(|| {
                    self.actors.push(Known { kind: Some(Kind::Vehicle), ..Known::default() });
                    self.actors.len() - 1
                })
            }
            // "The driver behind it": of another vehicle.
            Occupant::Driver if plain && hint.is_some() => {
                let there = |known: &Known| known.relations.iter().any(|(place, _)| Some(*place) == hint);
                let known = self.latest(|known| known.kind.is_some_and(Kind::is_vehicle) && there(known));
                known.unwrap_or_else(|| {
                    self.actors.push(Known { kind: Some(Kind::Vehicle), ..Known::default() });
                    self.actors.len() - 1
                })
            }
            Occupant::Driver if plain && !self.own_driver => {
                self.latest(|known| known.kind.is_some_and(acts)).unwrap_or(SUBJECT)
            }
            // "The rider came off", told of a motorcycle.
            Occupant::Rider if noun.article == Article::Definite && !noun.several => self
                .latest(|known| known.acted)
                .filter(|&actor| {
                    let kind = self.actors[actor].kind.map(Kind::group);
                    let rides = matches!(kind, Some(KindGroup::Motorcycle | KindGroup::Cyclist));
                    rides && self.actors[actor].last > self.actors[SUBJECT].last
                })
                .unwrap_or(SUBJECT),
            _ => SUBJECT,
        }
    }

    fn add(&mut self, noun: &Noun) -> Actor {
        let another = noun.adjectives.contains(&Adjective::Another);
        self.actors.push(Known { several: noun.several, another, ..Known::default() });
        self.actors.len() - 1
    }

    /// Who else was named last.
    pub fn other(&self) -> Option<Actor> {
        self.latest(|known| known.kind.is_none_or(acts) && known.mentions > 0)
    }

    /// The thing that was named last.
    pub fn thing(&self) -> Option<Actor> {
        // "a bin that stood away from the curb": a curb is a place first.
        (1..self.actors.len())
            .max_by_key(|&actor| (self.actors[actor].kind != Some(Kind::Curb), self.actors[actor].last))
    }

    /// Somebody else of its kind, the one named last.
    pub fn like(&self, actor: Actor) -> Option<Actor> {
        let kind = self.actors[actor].kind?;
        (1..self.actors.len())
            .filter(|&other| other != actor && !self.actors[other].announced && !self.actors[other].several)
            .filter(|&other| self.actors[other].kind.is_some_and(|known| same_kind(known, kind)))
            .max_by_key(|&other| self.actors[other].last)
    }

    /// Who is called by this name.
    pub fn by_name(&self, name: &str) -> Option<Actor> {
        (1..self.actors.len()).rfind(|&actor| self.actors[actor].names.iter().any(|known| known == name))
    }
}

/// Whether somebody of this kind does things.
fn acts(kind: Kind) -> bool {
    !matches!(kind.group(), KindGroup::Object)
}

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

fn relation_of(noun: &Noun) -> Option<Relation> {
    noun.adjectives.iter().find_map(|adjective| match adjective {
        Adjective::Oncoming => Some(Relation::Opposite),
        Adjective::Following => Some(Relation::Behind),
        Adjective::Lead => Some(Relation::Ahead),
        _ => None,
    })
}

fn contradicts(known: &[String], said: &[String]) -> bool {
    !known.is_empty() && !said.is_empty() && !known.iter().any(|name| said.contains(name))
}

/// Whether "a" noun of the second kind can bring on somebody who was announced as the first.
fn introduces(announced: Kind, said: Kind) -> bool {
    let generic = matches!(announced, Kind::Vehicle | Kind::HeavyTruck | Kind::FirstResponder | Kind::PassengerCar)
        || announced.group() == KindGroup::Object;
    announced == said
        || said == Kind::Vehicle
        || announced == Kind::SemiTrailerTruck && said == Kind::HeavyTruck
        || (same_kind(announced, said)
            && (generic || !matches!(said, Kind::HeavyTruck | Kind::PassengerCar | Kind::Object)))
}

/// Whether a noun of the second kind can mean somebody known by the first.
pub fn same_kind(known: Kind, said: Kind) -> bool {
    if known == said {
        return true;
    }
    let (one, other) = (known.group(), said.group());
    match said {
        Kind::Vehicle => known.is_vehicle() || matches!(one, KindGroup::Motorcycle),
        Kind::HeavyTruck => {
            one == KindGroup::Truck || matches!(known, Kind::Pickup | Kind::PickupWithTrailer | Kind::Vehicle)
        }
        Kind::PassengerCar => matches!(known, Kind::Vehicle | Kind::PoliceCar),
        Kind::Trailer => matches!(
            known,
            Kind::SemiTrailerTruck
                | Kind::PickupWithTrailer
                | Kind::HeavyTruck
                | Kind::BoxTruck
                | Kind::ConstructionVehicle
        ),
        Kind::Object | Kind::Debris => one == KindGroup::Object,
        Kind::Pedestrian => one == KindGroup::OnFoot,
        Kind::Scooter => known == Kind::Moped,
        Kind::Pickup if known == Kind::PickupWithTrailer => true,
        _ if known == Kind::Vehicle => said.is_vehicle(),
        _ if known == Kind::HeavyTruck => other == KindGroup::Truck,
        Kind::Pickup => known == Kind::PickupWithTrailer,
        Kind::Minivan | Kind::Van => matches!(known, Kind::Van | Kind::Minivan),
        Kind::SemiTrailerTruck => known == Kind::Trailer,
        Kind::PoliceCar | Kind::Ambulance | Kind::FireTruck => {
            matches!(known, Kind::FirstResponder | Kind::PassengerCar | Kind::Suv)
        }
        Kind::FirstResponder => matches!(known, Kind::PoliceCar | Kind::Ambulance | Kind::FireTruck),
        Kind::Bus | Kind::SchoolBus => matches!(known, Kind::Bus | Kind::SchoolBus),
        _ => one == other && matches!(one, KindGroup::Motorcycle | KindGroup::Cyclist),
    }
}
