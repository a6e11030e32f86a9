//! Who a sentence speaks of: where it mentions the ego, the crash partner and others, and which of them a cue is about.

use super::pattern::Pattern;
use recrash_model::kinds::PartnerKind;
use recrash_model::record::CrashRecord;
use regex::Regex;
use std::ops::Range;
use std::sync::LazyLock;

/// Who is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Actor {
    /// The subject vehicle.
    Sv,
    /// The crash partner.
    Cp,
    /// Traffic in general, or a road user of another kind than the partner.
    Other,
}

/// A mention of somebody.
#[derive(Debug, Clone, PartialEq)]
struct Mention {
    actor: Actor,
    /// Where in the sentence. [bytes]
    at: Range<usize>,
    /// Whether it stands behind a preposition or owns the thing named (`behind the AV`, `the AV's lane`), so that it is
    /// no subject.
    oblique: bool,
}

/// The mentions of one sentence.
#[derive(Debug, Clone)]
pub struct Mentions {
    list: Vec<Mention>,
}

/// Finds mentions in the sentences of one record.
#[derive(Debug, Clone)]
pub struct Cast {
    /// First word of the reporting entity, which often names its vehicle.
    entity: Option<String>,
    kind: Option<PartnerKind>,
    /// Whether the narrative names the partner by its kind; then road users of other kinds are others.
    kind_named: bool,
}

/// The ego by its maker's or operator's name, or by a general one. Words that only look like a road user come first, so
/// that they are taken and mean nobody.
const NOBODY: &str = r"(?:[\w-]+ )?bike racks?|(?:non-)?avs?[ -](?:only )?lanes?|bik(?:e|ing) lanes?|bicycle lanes?|bus (?:lanes?|stop|bay|zone)|truck lanes?|car ?pool lanes?|test driver|safety driver|vehicle operator|(?:passenger|driver)(?:'s)?[- ]side|vehicle'?s? (?:hood|bumper|door)|parked (?:cars?|vehicles?|trucks?|vans?|suvs?)";
const EGO: &str = r"(?:waymo|zoox|cruise|apollo|argo|nuro|ghost|beep|kodiak|lucid|aurora|motional|avride|pony|weride|wayve|gatik|navya|easymile|may mobility|may(?: autonomous)? (?:vehicle|shuttle|av)s?|autonomous|automated|self-driving|driverless|subject|test|host|ego|ads-equipped|our(?: \w+)? (?:vehicle|car|av|truck|shuttle)|our)(?:'s)?(?:[ -](?:llc|inc|driver|operated|equipped|ai|prius|autonomous|automated|driving|motor))*(?:[ -](?:vehicle|av\w?|adv|car|truck|shuttle|robotaxi|taxi|suv|bus|van))?\b|\b(?:avs?|adv|ads|sv|robotaxi|shuttle|vehicle (?:1|one)|car (?:1|one)|v1|we)";
const TRAFFIC: &str = r"(?:oncoming |cross[- ]|crossing |stopped |slow |slower |slowing |the |other )?traffic|crossing guard|queue|police officer";
const FOUR_WHEELS: &str = r"passenger (?:cars?|vehicles?)|sport utility vehicle|suv|crossover|minivan|van|pick-?up(?: truck)?|police (?:car|vehicle|cruiser|suv)|patrol car|emergency vehicle|fire (?:truck|engine)|ambulance|golf cart|cart|rickshaw|station wagon|convertible|limousine|tow truck|delivery (?:truck|van|vehicle)|box truck|semi(?:-?trailer|-?truck)?|tractor(?:[- ]trailer)?|dump truck|garbage truck|tanker(?: truck)?|truck|(?:\w+ )?bus|trailer|sedan|hatchback|coupe|taxi|vehicle (?:2|two)|car (?:2|two)|v2|(?:other|second|another|third[- ]party|opposing|approaching) (?:vehicle|driver|car|party|motorist)|honda|toyota|ford|tesla|chevrolet|chevy|nissan|hyundai|kia|subaru|mazda|volkswagen|bmw|audi|mercedes(?:-benz)?|lexus|jeep|dodge|ram|gmc|cadillac|buick|acura|infiniti|volvo|range rover|driver|motorist|vehicle|car";
const TWO_WHEELS: &str = r"motorcycl\w+|motorbike|moped|(?:motor )?scooter(?:ist)?|e-?scooter|cyclist|bicyclist|bicycl\w+|e-?bike|bike|skateboard\w*|delivery robot|robot|(?:person|rider|man|woman|individual) (?:on|operating|riding)(?: an?)?(?: electric| motorized)? \w+";
const WALKING: &str = r"pedestrians?|person|people|child";
const ANIMAL: &str = r"deer|dog|coyote|horse|cow|animal";

static MENTION: LazyLock<Regex> = LazyLock::new(|| {
    let pattern = format!(
        r"(?i)\b(?:(?P<nobody>{NOBODY})|(?P<ego>{EGO})|(?P<traffic>{TRAFFIC})|(?P<two>{TWO_WHEELS})|(?P<four>{FOUR_WHEELS})|(?P<walk>{WALKING})|(?P<animal>{ANIMAL}))\b"
    );
    Regex::new(&pattern).expect("constant pattern")
});

/// How far before a mention its preposition is looked for. [bytes]
const OBLIQUE_WINDOW_BYTES: usize = 60;

/// What stands before a mention that is no subject.
static OBLIQUE_BEFORE: Pattern = Pattern::new(
    r"(?i)\b(?:of|with|behind|to|toward|towards|by|near|past|into|onto|at|for|in front|ahead|beside|alongside|left|right|approach(?:ed|es)?|passed|passing|overtook|overtaking|struck|hit|striking|hitting|following|trailing|contacted|sideswiped|sideswiping|clipped|avoid|in|across|from|next to)(?: of)?(?: the| a| an| another| our| its)?(?: (?:side|stopped|stationary|slowing|moving|turning))?\s*$",
);

/// A participle behind a mention: what follows is about that mention, whatever stands before it (`for a motorcyclist
/// travelling north`).
static PARTICIPLE_AFTER: Pattern = Pattern::new(
    r"(?i)^,? (?:that (?:was |were |had been )?|in the process of |which (?:was |were |had been )?|who (?:was |were )?|also )?(?:travell?ing|approaching|heading|driving|proceeding|coming|moving|going|turning|making|entering|facing|signall?ing|following|stopped (?:at|in|behind)|in the (?:left|right|adjacent|number|next)|operating)\b",
);

/// A part of somebody that acts in its place: `the front of the ...` at the beginning of a clause.
static PART_ACTS: Pattern = Pattern::new(
    r"(?i)(?:^|, |\b(?:and|when|as|while|where|then|before|after|that)\s+)(?:the |its )(?:[\w']+[ -]){0,4}?(?:front|rear|back|side|corner|bumper|mirror|door|fender|edge|part|portion|end|panel|trailer|tire|wheel)s? of (?:the|a|an|another)(?: (?:other|stopped|moving))?\s*$",
);

/// Words that may mean either vehicle.
const EITHER: [&str; 4] = ["vehicle", "car", "driver", "motorist"];

impl Cast {
    /// The cast of a record whose narrative has these sentences.
    pub fn new(record: &CrashRecord, sentences: &[&str]) -> Self {
        let entity = record
            .entity
            .split(|c: char| !c.is_alphanumeric())
            .next()
            .filter(|word| word.len() >= 4 && !matches!(word.to_lowercase().as_str(), "general" | "ford"))
            .map(str::to_owned);
        let kind = record.partner.known();
        let mut cast = Self { entity, kind, kind_named: false };
        cast.kind_named = sentences
            .iter()
            .flat_map(|sentence| MENTION.captures_iter(sentence))
            .any(|capture| cast.names_kind(&capture) == Some(true));
        cast
    }

    /// Whether a mention is of a person or an animal, and the partner is none.
    fn is_bystander(&self, capture: &regex::Captures) -> bool {
        capture.name("walk").is_some() && self.kind.is_some_and(|kind| kind != PartnerKind::Pedestrian)
            || capture.name("animal").is_some() && self.kind != Some(PartnerKind::Animal)
    }

    /// Whether a mention names the partner's kind; `None` where it names nobody in particular.
    fn names_kind(&self, capture: &regex::Captures) -> Option<bool> {
        let kind = self.kind?;
        let two = matches!(kind, PartnerKind::Motorcycle | PartnerKind::Cyclist | PartnerKind::OtherNonMotorist);
        if capture.name("two").is_some() {
            return Some(two);
        }
        if capture.name("walk").is_some() {
            return Some(kind == PartnerKind::Pedestrian);
        }
        if capture.name("animal").is_some() {
            return Some(kind == PartnerKind::Animal);
        }
        let text = capture.name("four")?.as_str().to_lowercase();
        let on_four_wheels = !two && !matches!(kind, PartnerKind::Pedestrian | PartnerKind::Animal);
        let named = match text.as_str() {
            t if t.starts_with("passenger") || t == "sedan" || t == "hatchback" || t == "coupe" => {
                kind == PartnerKind::PassengerCar
            }
            "suv" | "sport utility vehicle" => kind == PartnerKind::Suv,
            "van" | "minivan" => kind == PartnerKind::Van,
            t if t.starts_with("pick") => kind == PartnerKind::PickupTruck,
            t if t.ends_with("bus") => kind == PartnerKind::Bus,
            t if t.contains("semi") || t.contains("tractor") || t.ends_with("box truck") => {
                kind == PartnerKind::HeavyTruck
            }
            t if ["police", "patrol", "emergency", "fire", "ambulance"].iter().any(|word| t.starts_with(word)) => {
                kind == PartnerKind::FirstResponder
            }
            "truck" => matches!(kind, PartnerKind::HeavyTruck | PartnerKind::PickupTruck),
            _ if on_four_wheels => return None,
            _ => return Some(false),
        };
        Some(named)
    }

    /// Who is mentioned in a sentence, in order.
    pub fn mentions(&self, sentence: &str) -> Mentions {
        let mut list: Vec<Mention> = Vec::new();
        for capture in MENTION.captures_iter(sentence) {
            let whole = capture.get_match();
            let actor = if capture.name("nobody").is_some() || (self.kind_named && means_either(sentence, &whole)) {
                continue;
            } else if capture.name("ego").is_some() {
                Actor::Sv
            } else if capture.name("traffic").is_some() || self.is_bystander(&capture) {
                Actor::Other
            } else {
                match self.names_kind(&capture) {
                    Some(false) if self.kind_named => Actor::Other,
                    _ => Actor::Cp,
                }
            };
            list.push(mention(sentence, actor, whole.range()));
        }
        if let Some(entity) = &self.entity {
            for (start, word) in sentence.match_indices(entity.as_str()) {
                let at = start..start + word.len();
                match list.iter_mut().find(|m| m.at.start < at.end && at.start < m.at.end) {
                    Some(known) => known.actor = Actor::Sv,
                    None => list.push(mention(sentence, Actor::Sv, at)),
                }
            }
            list.sort_by_key(|m| m.at.start);
        }
        Mentions { list }
    }
}

fn mention(sentence: &str, actor: Actor, at: Range<usize>) -> Mention {
    let mut window = at.start.saturating_sub(OBLIQUE_WINDOW_BYTES);
    while !sentence.is_char_boundary(window) {
        window += 1;
    }
    let before = &sentence[window..at.start];
    let owner = sentence[at.end..].starts_with("'s") || sentence[..at.end].ends_with("'s");
    let acts = PARTICIPLE_AFTER.is_match(&sentence[at.end..]) || PART_ACTS.is_match(&sentence[..at.start]);
    let aside = before.ends_with('(');
    Mention { actor, oblique: aside || (!acts && (owner || OBLIQUE_BEFORE.is_match(before))), at }
}

/// Whether `vehicle` or `driver` stands there for either of the two.
fn means_either(sentence: &str, whole: &regex::Match) -> bool {
    let before = sentence[..whole.start()].to_ascii_lowercase();
    EITHER.contains(&whole.as_str().to_ascii_lowercase().as_str())
        && ["the ", "each ", "both ", "its ", "my "].iter().any(|word| before.ends_with(word))
}

impl Mentions {
    /// Whether this actor is mentioned at all.
    pub fn includes(&self, actor: Actor) -> bool {
        self.list.iter().any(|m| m.actor == actor)
    }

    /// Where this actor is mentioned. [bytes]
    pub fn starts(&self, actor: Actor) -> impl Iterator<Item = usize> + '_ {
        self.list.iter().filter(move |m| m.actor == actor).map(|m| m.at.start)
    }

    /// Where the mentions of this actor end. [bytes]
    pub fn ends(&self, actor: Actor) -> impl Iterator<Item = usize> + '_ {
        self.list.iter().filter(move |m| m.actor == actor).map(|m| m.at.end)
    }

    /// Whether a phrase at this place can be about a meeting of the two: both are mentioned, or one of them is.
    pub fn meets_at(&self, place: usize) -> bool {
        matches!(self.subject_at(place), Some(Actor::Sv | Actor::Cp))
    }

    /// Whom a cue at this place is about: the last subject before it, else the last mention before it, else the first
    /// after it.
    pub fn subject_at(&self, place: usize) -> Option<Actor> {
        let before = || self.list.iter().rev().filter(|m| m.at.end <= place);
        before()
            .find(|m| !m.oblique)
            .or_else(|| before().next())
            .or_else(|| self.list.iter().find(|m| m.at.start >= place))
            .map(|m| m.actor)
    }

    /// The last mention before a place, within a few words.
    pub fn nearest_before(&self, place: usize) -> Option<Actor> {
        self.list.iter().rev().find(|m| m.at.end <= place && m.at.end + 24 >= place).map(|m| m.actor)
    }

    /// Whom a phrase that ends at this place speaks of next: the first mention after it, within a few words.
    pub fn object_after(&self, place: usize) -> Option<Actor> {
        self.list.iter().find(|m| m.at.start >= place && m.at.start <= place + 24).map(|m| m.actor)
    }
}
