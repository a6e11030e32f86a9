//! What stands behind a noun and belongs to it: "(Vehicle 2)", "of the bus", "on a scooter", "'s trailer"; and loose wheels.

use super::noun::can_own;
use super::{Article, Chunker, Noun};
use crate::lexicon::{Adjective, Meaning, Occupant};
use crate::token::TokenKind;
use recrash_model::account::{Kind, KindGroup};

/// "a panel on the rear of a large white van fell off": so many words may stand between. [tokens]
const PART_WITHIN: usize = 11;

/// "a contractor's truck": the truck.
fn is_owned_vehicle(noun: &Noun, owned: &Noun) -> bool {
    let person = noun.kind == Some(Kind::Pedestrian) && noun.occupant.is_none();
    person && owned.kind.is_some_and(Kind::is_vehicle) && owned.occupant.is_none() && !owned.subject
}

impl Chunker<'_> {
    /// A noun with what stands behind it from `at` on and belongs to it; "'s rear bumper" is left to others.
    pub(super) fn finish(&self, mut noun: Noun, first: usize, at: usize) -> Option<(Noun, usize)> {
        let at = self.alias_behind(&mut noun, at);
        noun.subject |= self.is_own_by_what_follows(&noun, at);
        self.kind_in_brackets(&mut noun, at);
        if let Some((truck, behind)) = self.drawn_by(&noun, at) {
            return Some((truck, behind - first));
        }
        let at = self.vehicle_behind(&mut noun, at);
        // "a person in the driver's seat of the van" is somebody in the van.
        if noun.kind == Some(Kind::Pedestrian)
            && let Some((owner, behind)) = self.seated(at)
        {
            (noun.owner, noun.occupant, noun.kind) = (Some(Box::new(owner)), Some((Occupant::Rider, false)), None);
            return Some((noun, behind - first));
        }
        // "a man driving a van", "somebody behind the wheel of a pickup": its driver.
        if noun.kind == Some(Kind::Pedestrian)
            && let Some((owner, behind)) = self.driven(at)
        {
            (noun.owner, noun.occupant, noun.kind) = (Some(Box::new(owner)), Some((Occupant::Driver, false)), None);
            return Some((noun, behind - first));
        }
        let at = self.ride_behind(&mut noun, at);
        if self.text(at) != "'s" {
            return Some((noun, at - first));
        }
        // "the truck's flatbed trailer", "the AV's trailer" is the truck, or the AV.
        if let Some(behind) = self.trailer(at + 1)
            && (noun.kind.is_some_and(Kind::is_vehicle) || noun.subject && self.text(behind - 1) == "trailer")
        {
            noun.kind = match noun.kind {
                // "the tow truck's load" makes no other truck of it.
                Some(kind) if kind.group() == KindGroup::Truck && kind != Kind::TowTruck => {
                    Some(Kind::SemiTrailerTruck)
                }
                None if noun.subject => Some(Kind::SemiTrailerTruck),
                Some(Kind::Pickup) if self.text(behind - 1) == "trailer" => Some(Kind::PickupWithTrailer),
                kind => kind,
            };
            return Some((noun, behind - first));
        }
        // Read once: a chain of owners would be read twice at each of them.
        let owned = self.noun(at + 1).filter(|(owned, _)| owned.article == Article::None);
        let Some((owned, length)) = owned else { return Some((noun, at - first)) };
        let behind = at + 1 + length;
        if is_owned_vehicle(&noun, &owned) {
            return Some((Noun { article: noun.article, ..owned }, behind - first));
        }
        // "the van's driver": the owner of somebody inside.
        if owned.occupant.is_some() && owned.owner.is_none() {
            return Some((Noun { owner: Some(Box::new(noun)), ..owned }, behind - first));
        }
        Some((noun, at - first))
    }

    /// "a shuttle operated by Acme", "a test truck of our program", "a van in automated operation": the subject vehicle, by what stands behind it.
    fn is_own_by_what_follows(&self, noun: &Noun, at: usize) -> bool {
        let another = |adjective: &Adjective| matches!(adjective, Adjective::Another | Adjective::Other);
        let one = noun.article != Article::Definite && !noun.several && !noun.adjectives.iter().any(another);
        let vehicle = noun.kind.is_some_and(Kind::is_vehicle) && noun.occupant.is_none();
        let own = match (self.text(at), self.text(at + 1)) {
            ("operated", "by") => self.company(at + 2) || self.text(at + 2) == "us",
            ("of", "our") => {
                (at + 2..at + 4).any(|at| matches!(self.text(at), "program" | "fleet" | "company" | "test" | "testing"))
            }
            ("in", "automated" | "autonomous" | "driverless") => matches!(self.text(at + 2), "operation" | "mode"),
            _ => false,
        };
        one && vehicle && own && !self.names_subject()
    }

    /// Whether the words up to the end of this sentence call the subject vehicle by a name of its own.
    fn names_subject(&self) -> bool {
        (0..self.tokens.len()).any(|at| matches!(self.head(at), Some((Meaning::Subject, _))))
    }

    /// "the trailer of a truck": the truck.
    fn drawn_by(&self, noun: &Noun, at: usize) -> Option<(Noun, usize)> {
        if noun.kind != Some(Kind::Trailer) || noun.several || self.text(at) != "of" {
            return None;
        }
        let (truck, length) = self.noun(at + 1)?;
        let kind = match truck.kind? {
            kind if kind.group() == KindGroup::Truck => Kind::SemiTrailerTruck,
            Kind::Pickup => Kind::PickupWithTrailer,
            _ => return None,
        };
        Some((Noun { kind: Some(kind), ..truck }, at + 1 + length))
    }

    /// "the car (Vehicle 2)", "the motorcycle (Vehicle 2) operator".
    fn alias_behind(&self, noun: &mut Noun, at: usize) -> usize {
        let Some(number) = self.alias(at) else { return at };
        noun.subject |= number == 1;
        noun.number = Some(number).filter(|number| *number > 1);
        let behind = at + self.parenthesis(at);
        let Some((Meaning::Occupant(who), length)) = self.head(behind).filter(|_| noun.occupant.is_none()) else {
            return at;
        };
        let owner = noun.clone();
        (noun.owner, noun.occupant, noun.kind, noun.subject) = (Some(Box::new(owner)), Some((who, false)), None, false);
        behind + length
    }

    /// "Car 2 (Ford F-150 XLT)": what a numbered vehicle is.
    fn kind_in_brackets(&self, noun: &mut Noun, at: usize) {
        if noun.number.is_none() || noun.occupant.is_some() || self.text(at) != "(" || self.alias(at).is_some() {
            return;
        }
        let close = at + self.parenthesis(at);
        let kind = (at + 1..close).find_map(|at| match self.head(at) {
            Some((Meaning::Kind(kind), _)) if kind.is_vehicle() && kind != Kind::Vehicle => Some(kind),
            _ => None,
        });
        noun.kind = kind.filter(|_| noun.kind == Some(Kind::Vehicle)).or(noun.kind);
    }

    /// "the driver of the bus", "a passenger inside the van".
    fn vehicle_behind(&self, noun: &mut Noun, at: usize) -> usize {
        if noun.occupant.is_none() || noun.owner.is_some() {
            return at;
        }
        let behind = at + if self.text(at) == "(" { self.parenthesis(at) } else { 0 };
        if matches!(
            self.text(behind),
            "of" | "in"
                | "inside"
                | "from"
                | "operating"
                | "driving"
                | "on"
                | "within"
                | "aboard"
                | "exiting"
                | "leaving"
                | "entering"
                | "boarding"
        ) && let Some((owner, length)) = self.noun(behind + 1)
            && (owner.subject || owner.kind.is_some_and(can_own))
            && owner.kind != Some(Kind::Wheelchair)
            && owner.occupant.is_none()
        {
            // "the driver of a northbound van".
            noun.compass = noun.compass.or(owner.compass);
            noun.owner = Some(Box::new(owner));
            return behind + 1 + length;
        }
        at
    }

    /// Behind the words that tell who rides it: "an electric bicycle ridden by a food courier" is one.
    fn rider_behind(&self, noun: &Noun, at: usize) -> Option<usize> {
        let ridden = matches!(self.text(at), "ridden" | "operated" | "pedaled") && self.text(at + 1) == "by";
        let two_wheels = |kind: Kind| {
            matches!(kind.group(), KindGroup::Cyclist | KindGroup::Motorcycle)
                || matches!(kind, Kind::ScooterRider | Kind::Skateboarder)
        };
        if !ridden || !noun.kind.is_some_and(two_wheels) {
            return None;
        }
        let (rider, length) = self.noun(at + 2)?;
        let rides = rider.kind.is_none_or(|kind| kind.group() == KindGroup::OnFoot || two_wheels(kind));
        (rides && !rider.subject && rider.owner.is_none()).then_some(at + 2 + length)
    }

    /// "a person on a scooter", "a rider of a bicycle" is who rides it.
    fn ride_behind(&self, noun: &mut Noun, at: usize) -> usize {
        if let Some(behind) = self.rider_behind(noun, at) {
            return behind;
        }
        let on_foot = noun
            .kind
            .is_some_and(|kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist | KindGroup::Motorcycle))
            || (noun.occupant.is_some() && noun.owner.is_none());
        let rides = |at: usize| {
            matches!(self.text(at), "on" | "riding" | "operating" | "using" | "driving" | "who" | "was" | "were")
                || matches!(self.text(at), "of" | "in" | "his" | "her" | "top")
        };
        let ride = (at..at + 4).find(|&at| !rides(at)).unwrap_or(at + 4);
        if !on_foot || ride == at {
            return at;
        }
        let Some((ridden, length)) = self.noun(ride) else { return at };
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
        if !wheels || ridden.occupant.is_some() {
            return at;
        }
        // "a passenger in a wheelchair was being secured": somebody in the vehicle.
        if noun.occupant.is_some() && ridden.kind == Some(Kind::Wheelchair) {
            return ride + length;
        }
        (noun.kind, noun.occupant, noun.owner) = (ridden.kind, None, None);
        ride + length
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

    /// The vehicle that somebody drives by the words here, and the token behind it.
    fn driven(&self, at: usize) -> Option<(Noun, usize)> {
        let mut behind = at;
        while matches!(self.text(behind), "who" | "that" | "was" | "is" | "sitting") {
            behind += 1;
        }
        behind += match (self.text(behind), self.text(behind + 1), self.text(behind + 2), self.text(behind + 3)) {
            ("driving" | "operating" | "steering" | "piloting", ..) => 1,
            ("at" | "behind", "the", "wheel", "of") => 4,
            _ => return None,
        };
        let (owner, length) = self.noun(behind)?;
        let vehicle = owner.subject || owner.kind.is_some_and(Kind::is_vehicle);
        (vehicle && owner.occupant.is_none() && !owner.several).then_some((owner, behind + length))
    }

    /// Behind a trailer that stands here, with at most two words before it.
    fn trailer(&self, at: usize) -> Option<usize> {
        let found = (at..at + 3).find(|&at| matches!(self.text(at), "trailer" | "chassis" | "container" | "load"))?;
        (at..found).all(|at| self.tokens[at].kind == TokenKind::Word).then_some(found + 1)
    }

    /// "a row of traffic cones", "a set of barrels", "a flock of ducks": the things, the animals. A row of cars is a queue.
    pub(super) fn row_of(&self, first: usize) -> Option<(Noun, usize)> {
        const ROWS: [&str; 9] = ["row", "line", "set", "series", "string", "stack", "pile", "pair", "cluster"];
        const HERDS: [&str; 6] = ["flock", "herd", "pack", "family", "group", "pair"];
        let (rows, herds) = (ROWS.contains(&self.text(first + 1)), HERDS.contains(&self.text(first + 1)));
        let row = matches!(self.text(first), "a" | "the") && (rows || herds);
        if !row || self.text(first + 2) != "of" {
            return None;
        }
        // "traffic cones".
        let at = first + 3 + usize::from(self.text(first + 3) == "traffic");
        let (noun, length) = self.noun(at)?;
        let fits = noun.kind.is_some_and(|kind| match kind.group() {
            KindGroup::Object => rows,
            KindGroup::Animal => herds,
            _ => false,
        });
        let article = if self.text(first) == "the" { Article::Definite } else { Article::Indefinite };
        (fits && noun.article == Article::None)
            .then_some((Noun { article, several: true, ..noun }, at + length - first))
    }

    /// Behind a wheel or a tire that is on no vehicle: "a wheel came off a truck", and "the wheel" further on.
    pub(super) fn loose_wheel(&self, first: usize) -> Option<usize> {
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

    /// Behind a part that is on no vehicle any more: "a panel on the rear of a van fell off", and "the panel" further on.
    pub(super) fn loose_part(&self, first: usize) -> Option<usize> {
        const PARTS: [&str; 8] = ["panel", "bumper", "hood", "tailgate", "fender", "hubcap", "mirror", "grille"];
        let named = |at: usize| PARTS.contains(&self.text(at));
        let comes_off = |at: usize| {
            let comes = matches!(self.text(at), "came" | "fell" | "flew" | "broke" | "dropped" | "tore" | "detached");
            comes && matches!(self.text(at + 1), "off" | "from" | "loose")
        };
        let begins = |at: usize| {
            let part = (at + 1..at + 4).find(|&at| named(at)).filter(|_| matches!(self.text(at), "a" | "an"))?;
            let mut clause = (part + 1..part + PART_WITHIN)
                .take_while(|&at| !matches!(self.text(at), "." | "," | "and" | "when" | "as" | ""));
            let off = clause.find(|&at| comes_off(at))?;
            let own = self.noun(off + 2).is_some_and(|(noun, _)| noun.subject);
            (!own).then_some(part + 1)
        };
        let again = self.text(first) == "the"
            && named(first + 1)
            && self.text(first + 2) != "of"
            && (0..first).any(|at| begins(at).is_some_and(|end| self.text(end - 1) == self.text(first + 1)));
        begins(first).or(again.then_some(first + 2))
    }

    /// "several tires fell from a trailer", and "the tires", "one of the tires" further on. Behind it; whether it is one of them.
    pub(super) fn loose_wheels(&self, first: usize) -> Option<(usize, bool)> {
        let wheels = |at: usize| matches!(self.text(at), "wheels" | "tires");
        let loose = |at: usize| {
            wheels(at + 1)
                && matches!(self.text(at), "several" | "multiple" | "two" | "three" | "some")
                && matches!(self.text(at + 2), "fell" | "rolled" | "came" | "flew" | "bounced" | "detached")
        };
        if loose(first) {
            return Some((first + 2, false));
        }
        let one_of = self.text(first) == "one" && self.text(first + 1) == "of";
        let the = if one_of { first + 2 } else { first };
        let again = self.text(the) == "the" && wheels(the + 1) && self.text(the + 2) != "of" && (0..first).any(loose);
        again.then_some((the + 2, one_of))
    }
}
