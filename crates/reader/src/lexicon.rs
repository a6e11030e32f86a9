//! The lexicon: `data/lexicon.toml`, read once, and looked up by the words of a narrative.

use crate::token::{Token, TokenKind};
use recrash_model::account::{Act, Kind, LeftRight, PlaceKind, RoadFeature, StandReason};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::OnceLock;

const TEXT: &str = include_str!("../data/lexicon.toml");

/// Most words that a `*` of a phrase stands for; the "'s" of whose lane it is is none: "into the other van's lane".
const GAP: usize = 3;

/// Words that a `*` never stands for.
const NO_GAP: [&str; 17] = [
    "with", "contact", "and", "by", "when", "as", "while", "before", "after", "but", "then", "from", "u", "it", "they",
    "he", "she",
];

/// What a verb says. The lexicon names it as here, in small letters, or names an act of the account.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sense {
    /// Stands because it is parked.
    Parked,
    /// Touches.
    Contact,
    /// Touches; nobody is named before the words.
    ContactMade,
    /// Runs into the rear of.
    RearEnd,
    /// Goes backwards into.
    ReverseContact,
    /// Opens a door into.
    OpenDoorInto,
    /// The headline of a report: was in a collision with.
    Headline,
    /// Comes near.
    Approach,
    /// Faces, is located.
    Face,
    /// Gives way.
    Yield,
    /// Sees.
    See,
    /// A human takes over.
    TakeOver,
    /// Pushes another.
    Push,
    /// Damages.
    Damage,
    /// A signal turns green.
    LightGreen,
    /// A signal turns red.
    LightRed,
    /// A signal turns yellow.
    LightYellow,
    /// Somebody gets out.
    ExitVehicle,
    /// Tows.
    Tow,
    /// Anything else.
    Other,
    /// An act to one side: an act that has a `side` in the lexicon.
    #[serde(skip)]
    Sided(Act, LeftRight),
    /// An act of the account.
    #[serde(untagged)]
    Act(Act),
}

/// Form of a verb.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// `stop`.
    Base,
    /// `stops`.
    Present,
    /// `stopped`: past, or participle.
    Past,
    /// `stopping`.
    Ing,
}

/// Where somebody is, seen from somebody else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Relation {
    /// Behind.
    Behind,
    /// Ahead.
    Ahead,
    /// On the left.
    Left,
    /// On the right.
    Right,
    /// Beside, on no side that is told.
    Beside,
    /// From or in the opposite direction.
    Opposite,
    /// In the same direction.
    Same,
}

/// What the adjectives of a noun say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Adjective {
    /// It stands.
    Stopped,
    /// It is parked.
    Parked,
    /// It comes the other way.
    Oncoming,
    /// It follows.
    Following,
    /// It is ahead.
    Lead,
    /// It does something.
    Doing,
    /// It is not the one named before.
    Another,
    /// The first of them.
    First,
    /// The other one.
    Other,
    /// Nothing of use.
    Plain,
}

/// Part of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// At the front.
    Front,
    /// At the rear.
    Rear,
    /// On the left.
    Left,
    /// On the right.
    Right,
    /// Above.
    Top,
    /// Below.
    Bottom,
    /// Some part.
    Noun,
}

/// Somebody in or on a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Occupant {
    /// Who drives it.
    Driver,
    /// Who rides in it.
    Rider,
}

/// What a phrase is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// A name of the subject vehicle.
    Subject,
    /// A company.
    Company,
    /// A kind of road user or thing.
    Kind(Kind),
    /// A make.
    Make,
    /// Somebody in a vehicle.
    Occupant(Occupant),
    /// An adjective.
    Adjective(Adjective),
    /// A verb.
    Verb(Sense, Form),
    /// Where.
    Relation(Relation),
    /// A part.
    Part(Part),
}

/// A phrase that was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Found {
    /// What it is.
    pub meaning: Meaning,
    /// Tokens it takes.
    pub length: usize,
}

struct Phrase {
    rest: Vec<String>,
    meaning: Meaning,
}

/// How far the act of the next verb came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress {
    /// It happened.
    Real,
    /// It was tried.
    Tried,
    /// It was meant, and did not happen.
    Wished,
}

/// The words that the reader knows.
pub struct Lexicon {
    phrases: BTreeMap<String, Vec<Phrase>>,
    progress: BTreeMap<String, Progress>,
    models: Vec<String>,
    reasons: Vec<(Vec<String>, StandReason)>,
    features: Vec<(Vec<String>, RoadFeature)>,
    places: Vec<(Vec<String>, PlaceKind)>,
    drop: Vec<Vec<String>>,
    human: Vec<Vec<String>>,
    system: Vec<Vec<String>>,
}

#[derive(Deserialize)]
struct File {
    subject: Subject,
    kinds: BTreeMap<Kind, Vec<String>>,
    makes: Makes,
    occupants: Occupants,
    adjectives: BTreeMap<Adjective, Vec<String>>,
    verb: Vec<Verb>,
    begun: Begun,
    irregular: BTreeMap<String, Vec<String>>,
    relations: BTreeMap<Relation, Vec<String>>,
    parts: BTreeMap<Part, Vec<String>>,
    reasons: BTreeMap<StandReason, Vec<String>>,
    features: BTreeMap<RoadFeature, Vec<String>>,
    places: BTreeMap<PlaceKind, Vec<String>>,
    standing_phrases: Standing,
    driver: DriverWords,
}

#[derive(Deserialize)]
struct Subject {
    companies: Vec<String>,
    names: Vec<String>,
}

#[derive(Deserialize)]
struct Makes {
    models: Vec<String>,
    words: Vec<String>,
}

#[derive(Deserialize)]
struct Occupants {
    drivers: Vec<String>,
    riders: Vec<String>,
}

#[derive(Deserialize)]
struct Verb {
    sense: Sense,
    side: Option<LeftRight>,
    #[serde(default)]
    words: Vec<String>,
    #[serde(default)]
    fixed: Vec<String>,
}

#[derive(Deserialize)]
struct Begun {
    real: Vec<String>,
    tried: Vec<String>,
    wished: Vec<String>,
}

#[derive(Deserialize)]
struct Standing {
    drop: Vec<String>,
}

#[derive(Deserialize)]
struct DriverWords {
    human: Vec<String>,
    system: Vec<String>,
}

fn split(phrase: &str) -> Vec<String> {
    phrase.split_whitespace().map(str::to_owned).collect()
}

/// The phrases that a line of the lexicon stands for: "go/drive (over) to * lane" is four of them.
fn spelled(line: &str) -> Vec<String> {
    line.split_whitespace().fold(vec![String::new()], |begun, word| {
        let inner = word.strip_prefix('(').and_then(|word| word.strip_suffix(')'));
        let mut choices: Vec<&str> = inner.unwrap_or(word).split('/').collect();
        choices.extend(inner.map(|_| ""));
        let with = |begun: &String, word: &str| format!("{begun} {word}").trim().to_owned();
        begun.iter().flat_map(|begun| choices.iter().map(|word| with(begun, word)).collect::<Vec<_>>()).collect()
    })
}

/// The forms of a regular verb.
fn regular(base: &str) -> Vec<(String, Form)> {
    let last = base.chars().next_back().unwrap_or(' ');
    let before: Vec<char> = base.chars().rev().skip(1).take(2).collect();
    let vowel = |c: &char| "aeiou".contains(*c);
    let s = if base.ends_with("ss") || base.ends_with('x') || base.ends_with("sh") || base.ends_with("ch") {
        format!("{base}es")
    } else if last == 'y' && !before.first().is_some_and(vowel) {
        format!("{}ies", &base[..base.len() - 1])
    } else {
        format!("{base}s")
    };
    let doubled = [
        "stop", "clip", "tap", "skid", "slip", "nod", "slam", "drop", "rub", "stub", "swap", "tip", "quit", "drag",
        "step", "jog", "plug", "bag", "slap", "scrub", "grab", "permit", "transfer", "plan", "spot", "hop", "pop",
        "unplug",
    ]
    .contains(&base);
    let (past, ing) = if last == 'e' {
        (format!("{base}d"), format!("{}ing", &base[..base.len() - 1]))
    } else if last == 'y' && !before.first().is_some_and(vowel) {
        (format!("{}ied", &base[..base.len() - 1]), format!("{base}ing"))
    } else if doubled {
        (format!("{base}{last}ed"), format!("{base}{last}ing"))
    } else {
        (format!("{base}ed"), format!("{base}ing"))
    };
    vec![(base.to_owned(), Form::Base), (s, Form::Present), (past, Form::Past), (ing, Form::Ing)]
}

fn forms(base: &str, irregular: &BTreeMap<String, Vec<String>>) -> Vec<(String, Form)> {
    let Some(listed) = irregular.get(base) else { return regular(base) };
    let mut all = vec![(base.to_owned(), Form::Base)];
    for word in listed.iter().filter(|word| *word != base) {
        let form = if word.ends_with("ing") {
            Form::Ing
        } else if word.ends_with('s') && !matches!(word.as_str(), "was") {
            Form::Present
        } else {
            Form::Past
        };
        all.push((word.clone(), form));
    }
    // `hit`, `cut` and the like are their own past.
    if !all.iter().any(|(_, form)| *form == Form::Past) {
        all[0].1 = Form::Past;
    }
    all
}

/// Stands for the name of the company that reports, where the lexicon does not know it.
pub const COMPANY: &str = "thecompany";

impl Lexicon {
    /// The lexicon, read once.
    pub fn get() -> &'static Self {
        static LEXICON: OnceLock<Lexicon> = OnceLock::new();
        LEXICON.get_or_init(|| {
            let file: File = toml::from_str(TEXT).expect("the embedded lexicon is well formed, as a test holds");
            Self::of(file)
        })
    }

    fn of(mut file: File) -> Self {
        let mut lexicon = Self {
            phrases: BTreeMap::new(),
            progress: BTreeMap::new(),
            models: std::mem::take(&mut file.makes.models),
            reasons: lists(&file.reasons),
            features: lists(&file.features),
            places: lists(&file.places),
            drop: file.standing_phrases.drop.iter().map(|p| split(p)).collect(),
            human: file.driver.human.iter().map(|p| split(p)).collect(),
            system: file.driver.system.iter().map(|p| split(p)).collect(),
        };
        for phrase in &file.subject.names {
            lexicon.add(phrase, Meaning::Subject);
        }
        for phrase in &file.subject.companies {
            lexicon.add(phrase, Meaning::Company);
        }
        lexicon.add(COMPANY, Meaning::Company);
        for (kind, words) in &file.kinds {
            words.iter().for_each(|phrase| lexicon.add(phrase, Meaning::Kind(*kind)));
        }
        file.makes.words.iter().for_each(|phrase| lexicon.add(phrase, Meaning::Make));
        file.occupants.drivers.iter().for_each(|phrase| lexicon.add(phrase, Meaning::Occupant(Occupant::Driver)));
        file.occupants.riders.iter().for_each(|phrase| lexicon.add(phrase, Meaning::Occupant(Occupant::Rider)));
        for (adjective, words) in &file.adjectives {
            words.iter().for_each(|phrase| lexicon.add(phrase, Meaning::Adjective(*adjective)));
        }
        for (relation, words) in &file.relations {
            words.iter().for_each(|line| lexicon.add_all(line, Meaning::Relation(*relation)));
        }
        for (part, words) in &file.parts {
            words.iter().for_each(|phrase| lexicon.add(phrase, Meaning::Part(*part)));
        }
        lexicon.add_verbs(&file);
        for phrases in lexicon.phrases.values_mut() {
            phrases.sort_by_key(|phrase| std::cmp::Reverse(phrase.rest.len()));
        }
        lexicon
    }

    /// Verbs in all their forms, and the words that say how far another one came.
    fn add_verbs(&mut self, file: &File) {
        for verb in &file.verb {
            let sense = match (verb.sense, verb.side) {
                (Sense::Act(act), Some(side)) => Sense::Sided(act, side),
                (sense, _) => sense,
            };
            for phrase in verb.words.iter().flat_map(|line| spelled(line)) {
                let words = split(&phrase);
                let bends = words.iter().position(|word| word.ends_with('+')).unwrap_or(0);
                let Some(base) = words.get(bends).map(|word| word.trim_end_matches('+').to_owned()) else { continue };
                for (word, form) in forms(&base, &file.irregular) {
                    let mut bent = words.clone();
                    bent[bends] = word;
                    self.add(&bent.join(" "), Meaning::Verb(sense, form));
                }
            }
            verb.fixed.iter().for_each(|line| self.add_all(line, Meaning::Verb(sense, Form::Past)));
        }
        for (words, progress) in [
            (&file.begun.real, Progress::Real),
            (&file.begun.tried, Progress::Tried),
            (&file.begun.wished, Progress::Wished),
        ] {
            for word in words {
                for (form, _) in forms(word, &file.irregular) {
                    self.progress.insert(form, progress);
                }
            }
        }
    }

    /// All phrases of a line.
    fn add_all(&mut self, line: &str, meaning: Meaning) {
        spelled(line).iter().for_each(|phrase| self.add(phrase, meaning));
    }

    fn add(&mut self, phrase: &str, meaning: Meaning) {
        let mut words = split(phrase).into_iter();
        let Some(first) = words.next() else { return };
        self.phrases.entry(first).or_default().push(Phrase { rest: words.collect(), meaning });
    }

    /// The longest phrase at this token whose meaning is wanted.
    pub fn longest(&self, tokens: &[Token], at: usize, wanted: impl Fn(Meaning) -> bool) -> Option<Found> {
        let phrases = self.phrases.get(tokens.get(at)?.text.as_str())?;
        let mut best: Option<(Found, bool)> = None;
        for phrase in phrases.iter().filter(|phrase| wanted(phrase.meaning)) {
            let Some(length) = fits(&phrase.rest, tokens, at + 1) else { continue };
            // Of two that are as long, the one that names all its words.
            let exact = !phrase.rest.iter().any(|word| word == "*");
            if best.is_none_or(|(best, was)| best.length < length + 1 || best.length == length + 1 && exact && !was) {
                best = Some((Found { meaning: phrase.meaning, length: length + 1 }, exact));
            }
        }
        best.map(|(found, _)| found)
    }

    /// Whether a word is the name of a make.
    pub fn is_make(&self, word: &str) -> bool {
        let named = |phrases: &Vec<Phrase>| phrases.iter().any(|of| of.rest.is_empty() && of.meaning == Meaning::Make);
        self.phrases.get(word).is_some_and(named)
    }

    /// Whether a word is the name of a model of cars.
    pub fn is_model(&self, word: &str) -> bool {
        self.models.iter().any(|model| model == word)
    }

    /// How far the verb behind this word came, where the word says so.
    pub fn progress(&self, word: &str) -> Option<Progress> {
        self.progress.get(word).copied()
    }

    /// The reasons to stand that are named in these tokens, with the tokens that name them.
    pub fn reasons(&self, tokens: &[Token]) -> Vec<(StandReason, usize, usize)> {
        named(&self.reasons, tokens)
    }

    /// The features of the road that are named in these tokens.
    pub fn features(&self, tokens: &[Token]) -> Vec<(RoadFeature, usize, usize)> {
        named(&self.features, tokens)
    }

    /// The kinds of place that are named in these tokens.
    pub fn places(&self, tokens: &[Token]) -> Vec<(PlaceKind, usize, usize)> {
        named(&self.places, tokens)
    }

    /// Whether a sentence is a company's standing phrase, and tells no event.
    pub fn is_standing(&self, tokens: &[Token]) -> bool {
        self.drop.iter().any(|phrase| find(phrase, tokens).is_some())
    }

    /// Where these tokens say that a human drove: first token and count.
    pub fn human(&self, tokens: &[Token]) -> Option<(usize, usize)> {
        self.human.iter().find_map(|phrase| find(phrase, tokens))
    }

    /// Where these tokens say that the system drove: first token and count.
    pub fn system(&self, tokens: &[Token]) -> Option<(usize, usize)> {
        self.system.iter().find_map(|phrase| find(phrase, tokens))
    }
}

fn lists<T: Copy>(map: &BTreeMap<T, Vec<String>>) -> Vec<(Vec<String>, T)> {
    let phrases = |lines: &[String]| lines.iter().flat_map(|line| spelled(line)).collect::<Vec<_>>();
    map.iter().flat_map(|(value, lines)| phrases(lines).into_iter().map(|phrase| (split(&phrase), *value))).collect()
}

/// Which of these are named, each once, in the order of their first words.
fn named<T: Copy + PartialEq>(list: &[(Vec<String>, T)], tokens: &[Token]) -> Vec<(T, usize, usize)> {
    let mut all: Vec<(T, usize, usize)> = Vec::new();
    for (phrase, value) in list {
        if let Some((at, length)) = find(phrase, tokens) {
            match all.iter_mut().find(|(known, ..)| known == value) {
                Some(known) if known.1 > at => (known.1, known.2) = (at, length),
                Some(_) => {}
                None => all.push((*value, at, length)),
            }
        }
    }
    all.sort_by_key(|(_, at, _)| *at);
    all
}

/// Where a phrase stands in these tokens: first token and count.
pub fn find(phrase: &[String], tokens: &[Token]) -> Option<(usize, usize)> {
    let (first, rest) = phrase.split_first()?;
    (0..tokens.len())
        .filter(|&at| tokens[at].text == *first)
        .find_map(|at| fits(rest, tokens, at + 1).map(|length| (at, length + 1)))
}

/// How many tokens from `at` on the rest of a phrase takes, where it fits.
fn fits(rest: &[String], tokens: &[Token], at: usize) -> Option<usize> {
    let Some((word, others)) = rest.split_first() else { return Some(0) };
    if word == "*" {
        return (0..=GAP + 1).find_map(|gap| {
            let skipped = tokens.get(at..at + gap)?;
            let lane = matches!(others.first().map(String::as_str), Some("lane" | "path"));
            let owned = lane && skipped.iter().any(|token| token.text == "'s");
            if gap - usize::from(owned) > GAP {
                return None;
            }
            let inside =
                skipped.iter().all(|token| token.kind != TokenKind::Mark && !NO_GAP.contains(&token.text.as_str()));
            inside.then(|| fits(others, tokens, at + gap).map(|length| length + gap)).flatten()
        });
    }
    (tokens.get(at)?.text == *word).then(|| fits(others, tokens, at + 1).map(|length| length + 1)).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::token::tokens;

    fn at_start(text: &str) -> Option<Meaning> {
        Lexicon::get().longest(&tokens(text), 0, |_| true).map(|found| found.meaning)
    }

    fn verb_at_start(text: &str) -> Option<Meaning> {
        let verb = |meaning| matches!(meaning, Meaning::Verb(..));
        Lexicon::get().longest(&tokens(text), 0, verb).map(|found| found.meaning)
    }

    #[test]
    fn verbs_are_known_in_all_their_forms() {
        for text in
            ["stop here", "stops here", "stopped here", "stopping here", "came to a complete stop", "slowing to a stop"]
        {
            assert!(matches!(verb_at_start(text), Some(Meaning::Verb(Sense::Act(Act::Stop), _))), "{text}");
        }
        assert!(matches!(
            verb_at_start("made an unprotected left turn"),
            Some(Meaning::Verb(Sense::Sided(Act::Turn, LeftRight::Left), Form::Past))
        ));
        for text in ["rear ended by", "rear-ending", "double-parked there"] {
            assert!(matches!(verb_at_start(text), Some(Meaning::Verb(..))), "{text}");
        }
        assert!(matches!(verb_at_start("hit the pole"), Some(Meaning::Verb(Sense::Contact, _))));
    }

    /// A past form in the list would be taken for a base form, and "ran over" for no verb.
    #[test]
    fn verbs_are_listed_by_their_base_forms() {
        let file: toml::Table = toml::from_str(TEXT).unwrap();
        let irregular = file["irregular"].as_table().unwrap();
        let forms = irregular.iter().flat_map(|(_, forms)| forms.as_array().unwrap().get(2));
        let past: Vec<&str> =
            forms.filter_map(|form| form.as_str()).filter(|form| !irregular.contains_key(*form)).collect();
        let verbs = file["verb"].as_array().unwrap().iter().filter(|verb| verb["sense"].as_str() == Some("contact"));
        for phrase in verbs.flat_map(|verb| verb["words"].as_array().unwrap()).filter_map(|phrase| phrase.as_str()) {
            let first = phrase.split(' ').next().unwrap();
            assert!(!past.contains(&first), "{phrase}");
        }
    }

    #[test]
    fn a_line_may_stand_for_several_phrases() {
        assert_eq!(spelled("go (over/across) to * lane"), ["go over to * lane", "go across to * lane", "go to * lane"]);
        for text in ["went across to the left lane", "eased into the next lane", "pulled over to the far right lane"] {
            assert!(matches!(verb_at_start(text), Some(Meaning::Verb(Sense::Act(Act::LaneChange), _))), "{text}");
        }
    }

    /// Phrases with a second sense, for where the words behind them rule out the first: "swung into the lane" touches nobody.
    const SECOND_SENSES: [(&str, Sense, Sense); 6] = [
        ("fall onto", Sense::Contact, Sense::Act(Act::Fall)),
        ("knock into", Sense::Contact, Sense::Push),
        ("move back", Sense::Act(Act::Reverse), Sense::Act(Act::Drift)),
        ("nudge", Sense::Contact, Sense::Act(Act::Drift)),
        ("ride up", Sense::Contact, Sense::Act(Act::Follow)),
        ("swing into", Sense::Contact, Sense::Act(Act::Swerve)),
    ];

    /// Otherwise it would hang on the order of the file what a phrase means.
    #[test]
    fn no_phrase_has_two_meanings_of_one_sort() {
        let file: File = toml::from_str(TEXT).unwrap();
        let of_two = SECOND_SENSES.iter().flat_map(|(phrase, one, other)| {
            let (base, rest) = phrase.split_once(' ').unwrap_or((phrase, ""));
            let bent = forms(base, &file.irregular);
            bent.into_iter().map(move |(word, _)| (format!("{word} {rest}").trim().to_owned(), *one, *other))
        });
        let of_two: Vec<_> = of_two.collect();
        let (mut wrong, mut seen) = (Vec::new(), 0);
        for (first, phrases) in &Lexicon::get().phrases {
            for (at, phrase) in phrases.iter().enumerate() {
                let words = format!("{first} {}", phrase.rest.join(" ")).trim().to_owned();
                for other in phrases[..at].iter().filter(|other| other.rest == phrase.rest) {
                    match (other.meaning, phrase.meaning) {
                        (Meaning::Verb(one, _), Meaning::Verb(other, _))
                            if of_two.contains(&(words.clone(), one, other)) =>
                        {
                            seen += 1;
                        }
                        // "leaving room" is a form of "leave room", and listed for itself.
                        (Meaning::Verb(one, form), Meaning::Verb(other, as_form))
                            if one == other && form != as_form => {}
                        (one, other) if std::mem::discriminant(&one) != std::mem::discriminant(&other) => {}
                        (one, other) => wrong.push(format!("{words}: {one:?} and {other:?}")),
                    }
                }
            }
        }
        assert!(wrong.is_empty(), "{} phrases:\n{}", wrong.len(), wrong.join("\n"));
        assert_eq!(seen, of_two.len(), "of {of_two:?}");
    }

    #[test]
    fn a_side_stands_beside_acts_alone() {
        let file: File = toml::from_str(TEXT).unwrap();
        assert!(file.verb.iter().all(|verb| verb.side.is_none() || matches!(verb.sense, Sense::Act(_))));
    }

    #[test]
    fn the_longest_phrase_counts() {
        assert_eq!(at_start("passenger car"), Some(Meaning::Kind(Kind::PassengerCar)));
        assert_eq!(at_start("pickup truck"), Some(Meaning::Kind(Kind::Pickup)));
        assert_eq!(at_start("to the left of the bus"), Some(Meaning::Relation(Relation::Left)));
    }
}
