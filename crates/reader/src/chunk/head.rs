//! The head of a noun: the word that says who or what it is, and where the same word says another thing.

use super::Chunker;
use crate::lexicon::{Found, Meaning};
use recrash_model::account::{Kind, KindGroup};

/// A word that may be the head of a noun, where it stands.
struct Word {
    at: usize,
    found: Found,
    /// What it names, where it is a kind.
    kind: Option<Kind>,
    /// The token behind it.
    end: usize,
}

impl Word {
    fn is_subject(&self) -> bool {
        self.found.meaning == Meaning::Subject
    }
}

impl Chunker<'_> {
    /// The word at this token, where it says who or what a noun is, and its tokens.
    pub(super) fn head(&self, at: usize) -> Option<(Meaning, usize)> {
        let found = self.lexicon.longest(self.tokens, at, |meaning| {
            matches!(meaning, Meaning::Subject | Meaning::Kind(_) | Meaning::Occupant(_))
        })?;
        let kind = match found.meaning {
            Meaning::Kind(kind) => Some(kind),
            _ => None,
        };
        let word = Word { at, found, kind, end: at + found.length };
        (!self.says_another_thing(&word)).then_some((found.meaning, found.length))
    }

    /// Whether a word says another thing here, and heads no noun.
    fn says_another_thing(&self, word: &Word) -> bool {
        self.calls_a_company(word)
            || self.may_be_a_car(word)
            || self.is_in_a_part(word)
            || self.is_in_a_place(word)
            || self.is_served_there(word)
            || self.is_for_walkers(word)
            || self.is_an_owned_arm(word)
            || self.measures_a_distance(word)
            || self.names_a_thing(word)
            || self.is_no_model(word)
            || self.is_of_a_sign(word)
    }

    /// "the Pony AV": a company that is called as an animal is, written large.
    fn calls_a_company(&self, word: &Word) -> bool {
        word.kind == Some(Kind::Animal) && self.tokens[word.at].capital && self.company(word.at)
    }

    /// "police officer", where the story tells of none on foot.
    fn may_be_a_car(&self, word: &Word) -> bool {
        word.kind == Some(Kind::Pedestrian) && !self.is_on_foot(word.at, word.found.length)
    }

    /// "the side of its cargo body", "passenger side", "driver door".
    fn is_in_a_part(&self, word: &Word) -> bool {
        let part = self.part(word.at).map_or(0, |(_, length)| length);
        let longer = part > word.found.length;
        match word.found.meaning {
            Meaning::Kind(Kind::Cargo) => longer,
            Meaning::Occupant(_) => longer || (part > 0 && self.part(word.at + part).is_some()),
            _ => false,
        }
    }

    /// "the bike-shared lane", "a wheelchair ramp": parts and places.
    fn is_in_a_place(&self, word: &Word) -> bool {
        let of_place = matches!(
            self.text(word.end),
            "rack" | "racks" | "lane" | "lanes" | "path" | "share" | "shared" | "yard" | "ramp" | "ramps"
        );
        of_place && !word.is_subject()
    }

    /// "the tram line", "train tracks", "a bus stop": places.
    fn is_served_there(&self, word: &Word) -> bool {
        let served = matches!(
            self.text(word.end - 1),
            "tram" | "train" | "bus" | "rail" | "streetcar" | "trolley" | "railroad" | "railway" | "shuttle"
        );
        let place = matches!(
            self.text(word.end),
            "line" | "lines" | "track" | "tracks" | "stop" | "island" | "platform" | "station" | "shelter" | "depot"
        );
        served && place && !word.is_subject()
    }

    /// "a pedestrian beacon", "a HAWK signal": what is for people, or called by an animal, is neither.
    fn is_for_walkers(&self, word: &Word) -> bool {
        let next = self.text(word.end);
        let place = matches!(
            next,
            "beacon" | "beacons" | "signal" | "button" | "bridge" | "overpass" | "refuge" | "walkway" | "crosswalk"
        );
        // "at a pedestrian crossing": "a pedestrian crossing the street" is somebody.
        let behind = self.text(word.end + 1);
        let ends = || matches!(behind, "" | "." | ",") && self.is_behind_a_place_word(word.at);
        let place = place || next == "crossing" && (matches!(behind, "sign" | "signal" | "light") || ends());
        let walks = word.kind.is_some_and(|kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist));
        let animal = word.kind == Some(Kind::Animal);
        let named = animal && self.tokens[word.at].capital && matches!(next, "pedestrian" | "crosswalk");
        place && (walks || animal) || named
    }

    /// "its boom", "the crane's arm": a part, and no gate.
    fn is_an_owned_arm(&self, word: &Word) -> bool {
        let owned = word.at > self.first
            && matches!(self.text(word.at - 1), "its" | "'s")
            && matches!(self.text(word.at), "boom" | "arm");
        owned && word.kind == Some(Kind::Gate)
    }

    /// "half a car length", "two vehicle lengths": how far.
    fn measures_a_distance(&self, word: &Word) -> bool {
        matches!(self.text(word.end), "length" | "lengths") && word.kind.is_some_and(Kind::is_vehicle)
    }

    /// "the bus only lane", "its vehicle speed", "a traffic light".
    fn names_a_thing(&self, word: &Word) -> bool {
        let only = self.text(word.end) == "only" && matches!(self.text(word.end + 1), "lane" | "lanes");
        match self.text(word.at) {
            "vehicle" => only || matches!(self.text(word.end), "speed" | "speeds"),
            "traffic" => only || is_of_traffic(self.text(word.at + 1)),
            _ => only,
        }
    }

    /// "the leaf of the gate", "a tight fit": names of models are written large.
    fn is_no_model(&self, word: &Word) -> bool {
        let at = word.at;
        let model = self.lexicon.is_model(self.text(at));
        let of_company = || {
            self.text(at) == "pilot"
                && (self.text(at + 1).starts_with("assist")
                    || at > 0 && matches!(self.tokens[at - 1].text.as_str(), "drive" | "highway"))
        };
        let small = model && (!self.tokens[at].capital || of_company());
        let town = || (model || word.kind == Some(Kind::Animal)) && self.is_a_town(at);
        word.found.length == 1 && (small || town())
    }

    /// "sign" of "stop sign" is no thing that is struck.
    fn is_of_a_sign(&self, word: &Word) -> bool {
        self.text(word.at) == "sign" && word.at > self.first && matches!(self.text(word.at - 1), "stop" | "yield")
    }

    /// "a police officer directing traffic", "was waved on by a police officer": of an officer of whom the story tells nothing like that, nobody
    /// knows whether it is a car.
    fn is_on_foot(&self, at: usize, length: usize) -> bool {
        const FOOT: [&str; 11] =
            ["direct", "stand", "stood", "wav", "walk", "gestur", "motion", "beckon", "whistl", "stepp", "conducting"];
        let end = at + length;
        let police = matches!(self.text(at), "police" | "patrol" | "law");
        if !police || !matches!(self.text(end - 1), "officer" | "officers") {
            return true;
        }
        let tells = |at: usize| {
            let word = self.text(at);
            let stop = word == "conducting" && self.text(at + 1) != "traffic" && self.text(at + 2) != "traffic";
            word == "foot" || FOOT.iter().any(|stem| word.starts_with(stem)) && !stop
        };
        // "A police officer ran into the road, and it struck the police officer": told of any mention.
        let on_foot = |at: usize| {
            let begins = (0..at).rfind(|&at| self.text(at) == ".").map_or(0, |stop| stop + 1);
            let ends = (at..self.tokens.len()).find(|&at| self.text(at) == ".").unwrap_or(self.tokens.len());
            let met = at.saturating_sub(5).max(begins)..at;
            (begins..ends).any(tells) || met.into_iter().any(|at| matches!(self.text(at), "struck" | "hit" | "contact"))
        };
        let officer = |at: usize| matches!(self.text(at), "officer" | "officers") && self.text(at + 1) != "'s";
        let stop = (0..self.tokens.len()).any(|at| self.text(at) == "traffic" && self.text(at + 1) == "stop");
        let next = self.text(end);
        let drives = matches!(next, "'s" | "'" | "vehicle" | "car" | "with" | "in" | "riding" | "driving") || stop;
        !drives && (0..self.tokens.len()).any(|at| officer(at) && on_foot(at))
    }
}

/// Whether "traffic" before this word is nobody who drives: "traffic light", "traffic rules".
pub fn is_of_traffic(word: &str) -> bool {
    const NAMES: [&str; 23] = [
        "light",
        "lights",
        "signal",
        "signals",
        "circle",
        "lane",
        "lanes",
        "control",
        "controls",
        "congestion",
        "stop",
        "conditions",
        "sign",
        "cone",
        "barrier",
        "island",
        "cones",
        "rules",
        "rule",
        "law",
        "laws",
        "regulations",
        "code",
    ];
    NAMES.contains(&word)
}
