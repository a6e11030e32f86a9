//! Who is meant by a noun: rules in an order, each of which may say who it is, or that it is somebody new.
//!
//! A new rule goes into [`RULES`], before all that would say something else of its noun.

use super::kinds::{
    acts, contradicts, introduces, is_big_truck, is_no_passenger_vehicle, is_truck, relation_of, same_kind,
};
use super::{Actor, Known, SUBJECT, World};
use crate::chunk::{Article, Noun};
use crate::lexicon::{Adjective, Occupant, Relation};
use recrash_model::account::{Kind, KindGroup};

/// A noun with a kind, of whom it is asked who is meant.
struct Sought<'a> {
    noun: &'a Noun,
    kind: Kind,
    /// Where the words behind it say that it is, seen from the subject vehicle.
    hint: Option<Relation>,
}

/// What a rule says.
enum Meant {
    /// Somebody who is known.
    Known(Actor),
    /// Somebody new.
    New,
}

type Rule = fn(&mut World, &Sought<'_>) -> Option<Meant>;

/// Who is meant by a noun with a kind: the first rule that says something counts.
const RULES: [Rule; 18] = [
    World::one_of_a_herd,
    World::told_of_first,
    World::own_bus,
    World::own_shuttle,
    World::own_trailer,
    World::behind_own_name,
    World::own_truck,
    World::own_tractor,
    World::counted_again,
    World::another,
    World::brought_on,
    World::group,
    World::first,
    World::there,
    World::elsewhere,
    World::parked,
    World::by_direction,
    World::of_kind,
];

impl Sought<'_> {
    fn has(&self, adjective: Adjective) -> bool {
        self.noun.adjectives.contains(&adjective)
    }

    fn is_definite(&self) -> bool {
        self.noun.article == Article::Definite
    }

    /// Whether kind, number and names allow that somebody is meant.
    fn fits(&self, known: &Known) -> bool {
        let noun = self.noun;
        known.kind.is_none_or(|known| same_kind(known, self.kind) && !(noun.passenger && is_no_passenger_vehicle(known)))
            && (noun.number.is_none() || known.number.is_none() || noun.number == known.number)
            && !contradicts(&known.names, &noun.names)
            // "A van two cars behind it ran into the sedan right behind it".
            && !(known.farther && self.hint.is_some())
    }
}

impl World {
    /// Who is meant by a noun; `None` where it is somebody new.
    pub(super) fn find(&mut self, noun: &Noun, hint: Option<Relation>) -> Option<Actor> {
        if let Some((who, plain)) = noun.occupant {
            return Some(self.occupant(noun, who, plain, hint));
        }
        if noun.subject {
            return Some(self.standing_namesake(noun).unwrap_or(SUBJECT));
        }
        if let Some(known) = self.by_number(noun) {
            return Some(known);
        }
        if self.is_own_name(noun) {
            return Some(SUBJECT);
        }
        let sought = Sought { noun, kind: noun.kind?, hint };
        match RULES.iter().find_map(|rule| rule(self, &sought)) {
            Some(Meant::Known(actor)) => Some(actor),
            Some(Meant::New) | None => None,
        }
    }

    /// "The stopped AV", where another one of the name was told to stand, and this one passes it.
    fn standing_namesake(&self, noun: &Noun) -> Option<Actor> {
        let stands = |adjective: &Adjective| matches!(adjective, Adjective::Stopped | Adjective::Parked);
        if noun.article != Article::Definite || noun.several || !noun.adjectives.iter().any(stands) {
            return None;
        }
        self.latest(|known| known.namesake && known.parked && !known.several)
    }

    /// "Vehicle 2".
    fn by_number(&self, noun: &Noun) -> Option<Actor> {
        let number = noun.number?;
        self.latest(|known| known.number == Some(number))
    }

    /// "The Volvo", in the report of whose vehicle is one.
    fn is_own_name(&mut self, noun: &Noun) -> bool {
        if noun.article != Article::Definite {
            return false;
        }
        let unnamed = self.actors.len() == 1 && self.actors[SUBJECT].mentions == 0;
        let vehicle = noun.names.iter().find(|name| self.vehicle.contains(*name));
        if let (true, Some(name)) = (unnamed, vehicle) {
            self.actors[SUBJECT].names.push(name.clone());
            return true;
        }
        let called = |known: &Known| known.names.iter().any(|name| noun.names.contains(name));
        called(&self.actors[SUBJECT]) && !self.actors[1..].iter().any(called)
    }

    /// "The shuttle was in its lane": the first whom a story names as known is whom it is told of.
    fn told_of_first(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        // "Shuttle 4 was halted behind cars"; "Box truck struck the AV" tells of another one.
        let numbered = sought.noun.shuttle && self.counted;
        let bare = sought.noun.article == Article::None && self.begins && self.actors.len() == 1 && numbered;
        let known = (sought.is_definite() || bare) && sought.noun.adjectives.is_empty() && !sought.noun.several;
        let things = self.actors[1..].iter().all(|known| !known.acts());
        let unnamed = things && self.actors[SUBJECT].mentions == 0;
        if !(unnamed && known && sought.hint.is_none() && sought.kind.group() == KindGroup::Truck) {
            return None;
        }
        self.actors[SUBJECT].kind.get_or_insert(sought.kind);
        Some(Meant::Known(SUBJECT))
    }

    /// "Shuttle was stopped", told by a shuttle.
    fn own_bus(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let bare = sought.noun.article == Article::None && !sought.noun.several;
        let own = sought.kind == Kind::Bus && self.actors[SUBJECT].kind == Some(Kind::Bus);
        (bare && own).then_some(Meant::Known(SUBJECT))
    }

    /// "The shuttle", of a vehicle that was called otherwise before, where no other one is a bus.
    fn own_shuttle(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let own = self.actors[SUBJECT].mentions > 0 && self.actors[SUBJECT].kind.is_none_or(|kind| kind == Kind::Bus);
        let plain = sought.is_definite() && sought.noun.adjectives.is_empty() && !sought.noun.several;
        let bus = |known: &Known| known.kind.is_some_and(|kind| matches!(kind, Kind::Bus | Kind::SchoolBus));
        let only = !self.actors[1..].iter().any(bus);
        let meant = sought.noun.shuttle && own && plain && only && !self.strikes;
        (meant && sought.hint.is_none()).then_some(Meant::Known(SUBJECT))
    }

    /// "The left side of the trailer", where nobody else is known who may draw one.
    fn own_trailer(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let own = self.actors[SUBJECT].kind;
        let truck = own.is_none_or(is_big_truck) && self.actors[SUBJECT].mentions > 0;
        let plain = sought.is_definite() && sought.noun.adjectives.is_empty() && !sought.noun.several;
        let may = |kind: Kind| is_truck(kind) || same_kind(kind, Kind::Trailer) || own.is_none() && kind.is_vehicle();
        let draws = |known: &Known| known.kind.is_some_and(may);
        let only = !self.actors[1..].iter().any(draws);
        (sought.kind == Kind::Trailer && truck && plain && only && !self.strikes).then_some(Meant::Known(SUBJECT))
    }

    /// "An Acme AV ("AV") Peterbilt semi-truck": what it is, behind its name.
    fn behind_own_name(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let alone = self.actors.len() == 1 && self.actors[SUBJECT].mentions > 0;
        let bare = sought.noun.article == Article::None && !sought.noun.several;
        if !(bare && alone && sought.kind == Kind::SemiTrailerTruck && !sought.noun.names.is_empty()) {
            return None;
        }
        self.actors[SUBJECT].kind.get_or_insert(sought.kind);
        Some(Meant::Known(SUBJECT))
    }

    /// "The shuttle" of a story that a shuttle tells, and that knows no other one.
    fn own_truck(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let alike = |known: Kind| known == sought.kind || is_big_truck(known) && is_big_truck(sought.kind);
        let own = self.actors[SUBJECT].kind.is_some_and(|own| alike(own) && own.group() == KindGroup::Truck);
        let same = !sought.has(Adjective::Other) && !sought.has(Adjective::Another);
        let only = || !self.actors[1..].iter().any(|known| known.kind.is_some_and(alike));
        (own && sought.is_definite() && !sought.noun.several && same && only()).then_some(Meant::Known(SUBJECT))
    }

    /// "The front of the tractor": of a truck that tells, unless another one was called so.
    fn own_tractor(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let own = self.actors[SUBJECT].kind.is_some_and(is_big_truck);
        let only = || !self.actors[1..].iter().any(|known| known.tractor);
        (sought.noun.tractor && sought.is_definite() && own && only()).then_some(Meant::Known(SUBJECT))
    }

    /// "A second van ..., and it hit a second van": named so once more.
    fn counted_again(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let noun = sought.noun;
        let ordinal = noun.ordinal?;
        self.latest(|known| known.ordinal == Some(ordinal) && sought.fits(known) && known.several == noun.several)
            .map(Meant::Known)
    }

    /// "Another van" is a second one of a kind: the announced one only where nobody of the kind was met. "The second van" may be
    /// who was brought on so.
    fn another(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        if !sought.has(Adjective::Another) {
            return None;
        }
        let again = self.latest(|known| sought.is_definite() && known.another && sought.fits(known));
        let met = || self.latest(|known| sought.fits(known) && !known.announced).is_some();
        let announced = || self.latest(|known| known.announced && sought.fits(known));
        let actor = again.or_else(|| if met() { None } else { announced() });
        Some(actor.map_or(Meant::New, Meant::Known))
    }

    /// "A van" brings on somebody: who was announced, or somebody new.
    fn brought_on(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let noun = sought.noun;
        let bare = noun.article == Article::None && noun.names.is_empty() && !noun.several;
        if noun.article != Article::Indefinite && !bare {
            return None;
        }
        // "A van two cars behind it" is not whom it met.
        if self.apart {
            return Some(Meant::New);
        }
        // "Bicycle was going fast", at the head of a sentence, of the one bicycle: the article was left out.
        if let Some(actor) =
            self.only_one(sought).filter(|_| bare && noun.adjectives.is_empty() && noun.number.is_none())
        {
            return Some(Meant::Known(actor));
        }
        let announced = self.latest(|known| {
            known.announced
                && sought.fits(known)
                && known.several == noun.several
                && !self.is_no_car(sought, known)
                // "A van rear-ended it. It had stopped behind a van": another one.
                && !(self.before && known.relations.iter().any(|(place, _)| *place == Relation::Behind))
                && known.kind.is_none_or(|known| introduces(known, sought.kind))
        });
        Some(announced.map_or(Meant::New, Meant::Known))
    }

    /// "It was rear-ended. ... A bus overtook it": not the one that is announced, where the record says that it was a car, or the bus is
    /// told to be beside it.
    fn is_no_car(&self, sought: &Sought<'_>, known: &Known) -> bool {
        let large = matches!(sought.kind, Kind::Bus | Kind::SchoolBus | Kind::Tram);
        let beside = matches!(sought.hint, Some(Relation::Left | Relation::Right | Relation::Beside));
        let behind = known.relations.iter().any(|(place, _)| *place == Relation::Behind);
        large && (self.with_car || beside && behind) && known.announced && known.kind == Some(Kind::Vehicle)
    }

    /// The only one of just this kind who was met.
    fn only_one(&self, sought: &Sought<'_>) -> Option<Actor> {
        let own = self.begins && sought.kind != Kind::Trailer;
        let alike = |known: &Known| own && known.kind == Some(sought.kind) && known.mentions > 0 && sought.fits(known);
        let mut all = (1..self.actors.len()).filter(|&actor| alike(&self.actors[actor]));
        let (only, more) = (all.next()?, all.next());
        let known = &self.actors[only];
        (more.is_none() && !known.several && !known.announced && sought.hint.is_none()).then_some(only)
    }

    /// "Two deer ran out of the brush. It struck one of the deer": what they did that one did.
    fn one_of_a_herd(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let herd = |known: &Known| known.several && sought.fits(known);
        let one = sought.noun.one_of && sought.kind == Kind::Animal;
        self.latest(herd).filter(|_| one).map(Meant::Known)
    }

    /// "Parked cars": a group, the one that was named or a new one. "The parked cars" are not "a line of cars behind it".
    fn group(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let parked = sought.has(Adjective::Parked);
        let definite = sought.is_definite() && parked;
        if !sought.noun.several || sought.noun.article != Article::None && !definite {
            return None;
        }
        // Traffic that comes is not what is parked there.
        let as_parked = |known: &Known| known.parked || !parked || definite && known.relations.is_empty();
        Some(
            self.latest(|known| known.several && sought.fits(known) && as_parked(known))
                .map_or(Meant::New, Meant::Known),
        )
    }

    /// "The first van".
    fn first(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        if !sought.has(Adjective::First) {
            return None;
        }
        let is_first = |known: &Known| {
            sought.fits(known) && known.mentions > 0 && known.several == sought.noun.several && !known.another
        };
        (1..self.actors.len()).find(|&actor| is_first(&self.actors[actor])).map(Meant::Known)
    }

    /// "The oncoming van", "the van behind it": who is known to be there.
    fn there(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let relation = relation_of(sought.noun).or(sought.hint)?;
        let there = |known: &Known| known.relations.iter().any(|(place, _)| *place == relation);
        self.latest(|known| known.several == sought.noun.several && sought.fits(known) && there(known))
            .map(Meant::Known)
    }

    /// "The van behind it", where the only van that is known is ahead of it: another one.
    fn elsewhere(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let other_end = match sought.hint? {
            Relation::Behind => Relation::Ahead,
            Relation::Ahead => Relation::Behind,
            _ => return None,
        };
        let noun = sought.noun;
        if noun.several || !noun.names.is_empty() || noun.number.is_some() || !sought.kind.is_vehicle() {
            return None;
        }
        let fitting = |known: &Known| sought.fits(known) && !known.several;
        let latest = self.latest(fitting)?;
        let placed = &self.actors[latest].relations;
        // Told of it alone, and as where it stood: who passes is ahead and behind.
        let there = placed.len() == 1 && placed[0].0 == other_end;
        there.then_some(Meant::New)
    }

    /// "The parked car" is who was called so.
    fn parked(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        if !sought.has(Adjective::Parked) || sought.noun.several {
            return None;
        }
        self.latest(|known| known.parked && sought.fits(known) && !known.several).map(Meant::Known)
    }

    /// "The southbound van": who was told to go that way.
    fn by_direction(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let compass = sought.noun.compass.filter(|_| sought.is_definite())?;
        let goes = |known: &Known| known.heading.is_some_and(|(heading, ..)| heading == compass);
        self.latest(|known| known.several == sought.noun.several && sought.fits(known) && goes(known)).map(Meant::Known)
    }

    /// "A car moved up, and the front of the SUV touched it", where no SUV was told of: the only one who moved in that sentence.
    fn slip_of_the_pen(&self, sought: &Sought<'_>, found: Option<Actor>) -> Option<Actor> {
        let noun = sought.noun;
        let plain = sought.is_definite() && noun.adjectives.is_empty() && noun.names.is_empty() && !noun.several;
        let unmet = found.is_none_or(|found| self.actors[found].announced && self.actors[found].mentions == 1);
        let car = |kind: Kind| kind.group() == KindGroup::Car && kind != Kind::Vehicle;
        if !(self.touches && plain && unmet && sought.hint.is_none() && noun.number.is_none() && car(sought.kind)) {
            return None;
        }
        let drives = |known: &&Known| !known.several && !known.announced && known.kind.is_some_and(Kind::is_vehicle);
        let mut others = self.actors[1..].iter().filter(drives);
        let (only, more) = (others.next()?, others.next());
        let here = only.acted && only.sentence == Some(self.sentence) && only.kind.is_some_and(car);
        let actor = self.actors.iter().position(|known| std::ptr::eq(known, only))?;
        (here && more.is_none()).then_some(actor)
    }

    /// "The first van yielded to the second van and moved over, and the front of the van touched it": of two of a kind that are told apart,
    /// the one that the sentence is about.
    fn subject_of_two(&self, sought: &Sought<'_>) -> Option<Actor> {
        let noun = sought.noun;
        let plain = sought.is_definite() && noun.adjectives.is_empty() && noun.names.is_empty() && !noun.several;
        let one = |known: &Known| known.kind == Some(sought.kind) && !known.several && known.mentions > 0;
        let apart = |known: &Known| one(known) && (known.another || known.ordinal.is_some());
        let main = self.main.filter(|main| *main != SUBJECT && plain && sought.hint.is_none())?;
        let known = &self.actors[main];
        let two = self.actors[1..].iter().filter(|known| one(known)).count() == 2;
        let here = known.sentence == Some(self.sentence) && one(known) && sought.fits(known);
        (two && here && self.actors[1..].iter().any(apart)).then_some(main)
    }

    /// "The van": who is called by its names, else is of just this kind, else of one that this may mean; else the subject vehicle,
    /// where nobody else can be meant.
    fn of_kind(&mut self, sought: &Sought<'_>) -> Option<Meant> {
        let Sought { noun, kind, hint } = *sought;
        // Who drives is not "the parked car".
        let parked = sought.has(Adjective::Parked) && !noun.several;
        let fits = |known: &Known| {
            sought.fits(known) && !(parked && known.acted && !known.parked) && !self.is_no_car(sought, known)
        };
        let as_many = |known: &Known| known.several == noun.several && fits(known);
        let called = |known: &Known| known.names.iter().any(|name| noun.names.contains(name));
        // "the scooter rider" of "two people riding scooters".
        let rider = matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist | KindGroup::Motorcycle);
        let one_of = rider && !noun.several;
        let found = self
            .latest(|known| called(known) && fits(known))
            .or_else(|| self.subject_of_two(sought))
            .or_else(|| self.latest(|known| known.kind == Some(kind) && as_many(known) && !known.is_bystander()))
            .or_else(|| {
                self.latest(|known| kind == Kind::HeavyTruck && as_many(known) && known.kind.is_some_and(is_truck))
            })
            .or_else(|| self.latest(as_many))
            .or_else(|| self.latest(|known| one_of && known.several && known.kind == Some(kind) && fits(known)));
        if let Some(meant) = self.slip_of_the_pen(sought, found) {
            return Some(Meant::Known(meant));
        }
        let known = sought.is_definite() && !sought.has(Adjective::Other);
        let Some(found) = found else {
            // "The vehicle" of a story that knows no other one.
            let only = kind == Kind::Vehicle || kind == Kind::PassengerCar && self.is_only_car(noun);
            // "Close to the parked cars": a group is none of the two.
            let group = noun.several && sought.has(Adjective::Parked);
            // "The lead vehicle", "the oncoming vehicle": seen from it, and so another one.
            let seen = relation_of(noun).is_some();
            // "A bus came over, and the passenger vehicle ...": the bus it is not.
            let third = noun.passenger && self.actors.len() > 1;
            if known && only && hint.is_none() && noun.names.is_empty() && !group && !seen && !third {
                self.plain |= self.actors[SUBJECT].mentions == 0;
                return Some(Meant::Known(SUBJECT));
            }
            // "The truck" of a story that a shuttle tells.
            let own = self.actors[SUBJECT].kind.is_some_and(|own| same_kind(own, kind));
            return (known && own && kind.group() == KindGroup::Truck).then_some(Meant::Known(SUBJECT));
        };
        // "The vehicle" is whom the story is about rather than a van that was named before.
        let plain = kind == Kind::Vehicle && noun.names.is_empty() && noun.adjectives.is_empty();
        let goes_on = self.topic == SUBJECT && self.actors[SUBJECT].last > self.actors[found].last;
        let other_kind = self.actors[found].kind != Some(Kind::Vehicle);
        if !(plain && known && other_kind && goes_on) {
            return Some(Meant::Known(found));
        }
        // "A van passed it and the vehicle behind it": seen from it, and so another one than both.
        let here = self.actors[found].sentence == Some(self.sentence);
        Some(match hint {
            None => Meant::Known(SUBJECT),
            Some(_) if here => Meant::New,
            Some(_) => Meant::Known(found),
        })
    }

    /// "The car" where no other one is told of, nor a crash with one.
    fn is_only_car(&self, noun: &Noun) -> bool {
        let met = self.with_vehicle || self.actors[1..].iter().any(|known| known.kind.is_none_or(Kind::is_vehicle));
        let own = !noun.several && self.actors[SUBJECT].mentions > 0 && !self.strikes;
        self.plain && self.actors.len() == 1 || !met && own
    }

    /// Whose driver, passenger or rider is meant.
    fn occupant(&mut self, noun: &Noun, who: Occupant, plain: bool, hint: Option<Relation>) -> Actor {
        if let Some(owner) = &noun.owner {
            // "The driver of the vehicle behind it".
            let placed = hint.filter(|_| !owner.subject);
            return self.find(owner, placed).unwrap_or_else(|| self.add(owner));
        }
        match who {
            // "A driver ran the light": nobody who was named.
            Occupant::Driver if plain && noun.article == Article::Indefinite => {
                self.latest(|known| known.announced).unwrap_or_else(|| self.add_vehicle())
            }
            // "The driver behind it": of another vehicle.
            Occupant::Driver if plain && hint.is_some() => {
                let there = |known: &Known| known.relations.iter().any(|(place, _)| Some(*place) == hint);
                let known = self.latest(|known| known.kind.is_some_and(Kind::is_vehicle) && there(known));
                known.unwrap_or_else(|| self.add_vehicle())
            }
            // "The at-fault driver", "the adverse driver": of another vehicle.
            Occupant::Driver if plain && noun.adjectives.contains(&Adjective::Other) => {
                let known = self.latest(|known| known.kind.is_some_and(Kind::is_vehicle) && !known.several);
                known.unwrap_or_else(|| self.add_vehicle())
            }
            Occupant::Driver if plain && !self.own_driver => {
                // "one or both vehicles" is no vehicle that somebody drives.
                self.latest(|known| known.kind.is_some_and(acts) && !known.several).unwrap_or(SUBJECT)
            }
            // "The rider came off", told of a motorcycle. "The passenger" rides in a vehicle.
            Occupant::Rider if plain && noun.article == Article::Definite && !noun.several => self
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

    fn add_vehicle(&mut self) -> Actor {
        self.actors.push(Known { kind: Some(Kind::Vehicle), ..Known::default() });
        self.actors.len() - 1
    }
}
