//! Accounts: what the reports of one incident tell, read once. Typed facts, each with the words or the column it comes
//! from. What nobody tells is `None`, never guessed.
//!
//! The subject vehicle is `sv`, the one it had its crash with the partner. A reconstruction is built from an account, and
//! each of its facts can be held against a rollout.

mod acts;
mod astride;
mod place;
mod set;
mod types;
mod untold;

pub use acts::{Act, ActFact, ContactState, LeftRight, Manner, Speed, SpeedMeaning, StandReason, Standing};
pub use astride::{Astride, AstrideWhen, LaneLine};
pub use place::{Compass, Control, ControlDevice, LaneWord, Obeyed, Place, PlaceKind, RoadFeature, SignalState};
pub use set::{ACCOUNTS_FORMAT, AccountSet, FactShare, TypeShare, UntoldIncident};
pub use types::{
    CrashType, Driver, FirstContact, Kind, KindGroup, MatrixCell, MatrixEvent, MatrixObject, Origin, PrecrashScenario,
    Role, Striker,
};

pub use untold::Untold;

use crate::conflict::FirstMover;
use crate::origin::RecordRef;
use crate::scenario::Author;
use crate::template::{Movement, RoadType, Template};
use crate::zones::ContactZone;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

/// Format tag of accounts.
pub const ACCOUNT_FORMAT: &str = "recrash.account/1";

/// Where a fact stands.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Words of the narrative that speaks.
    Words {
        /// First byte of the words in the narrative. [byte]
        start: usize,
        /// Byte behind the words. [byte]
        end: usize,
        /// The words as they stand there.
        text: String,
    },
    /// A column of the report that speaks.
    Column {
        /// Name of the column.
        name: String,
    },
    /// Other facts of this account, by the named rule.
    Rule {
        /// What the rule looks at.
        name: String,
    },
}

impl Source {
    /// Whether the fact stands in the words of the narrative: in no column, and by no rule.
    pub fn is_told(&self) -> bool {
        matches!(self, Self::Words { .. })
    }
}

/// A value and where it stands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Fact<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub source: Source,
}

impl<T> Fact<T> {
    /// A value out of a column.
    pub fn of_column(value: T, name: &str) -> Self {
        Self { value, source: Source::Column { name: name.to_owned() } }
    }

    /// A value that follows from other facts.
    pub fn by_rule(value: T, name: &str) -> Self {
        Self { value, source: Source::Rule { name: name.to_owned() } }
    }
}

/// The value of a fact that may not be told.
pub fn told<T: Copy>(fact: &Option<Fact<T>>) -> Option<T> {
    fact.as_ref().map(|fact| fact.value)
}

/// What the reports of one incident tell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Account {
    /// [`ACCOUNT_FORMAT`].
    #[serde(deserialize_with = "known_format")]
    pub format: String,
    /// The incident.
    pub incident: String,
    /// The report whose narrative was read.
    pub report: RecordRef,
    /// Every report of the incident.
    pub reports: Vec<RecordRef>,
    /// Hash of the narrative that was read.
    pub text_hash: String,
    /// Words of the narrative, the company's standing phrases left out.
    pub words: u32,
    /// Which of the eleven crash types it is.
    pub crash_type: Option<Fact<CrashType>>,
    /// Whether the subject vehicle's own move brought the conflict about.
    pub role: Option<Fact<Role>>,
    /// Who moved into whom.
    pub striker: Option<Fact<Striker>>,
    /// NHTSA's pre-crash scenario.
    pub scenario: Option<Fact<PrecrashScenario>>,
    /// Cell of the objects-by-events matrix of EU 2022/1426, Annex III, Appendix 1.
    pub matrix: Option<Fact<MatrixCell>>,
    /// First harmful contact.
    pub first_contact: Option<Fact<FirstContact>>,
    /// Where it happened.
    pub place: Place,
    /// The subject vehicle.
    pub sv: Party,
    /// The partner: the first road user or object that the subject vehicle touched, or that touched it.
    pub partner: Option<Party>,
    /// From where the partner came, seen from the subject vehicle before any turn.
    pub came_from: Option<Fact<Origin>>,
    /// Whether a partner from beside was ahead of the subject vehicle before it left its line, or behind it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ahead: Option<Fact<bool>>,
    /// Who was at the place of the conflict first.
    pub order: Option<Fact<FirstMover>>,
    /// Who drove the subject vehicle at the contact.
    pub driver: Option<Fact<Driver>>,
    /// Everybody and everything else in the story.
    pub others: Vec<Other>,
    /// Whether a door took part: which vehicle's.
    pub door: Option<Fact<Striker>>,
    /// Somebody was injured.
    pub injury: Option<Fact<bool>>,
    /// Somebody or something was damaged.
    pub damage: Option<Fact<bool>>,
    /// The partner left without stopping.
    pub partner_left: Option<Fact<bool>>,
    /// Where words and columns, or two facts, cannot both be true.
    pub contradictions: Vec<Contradiction>,
    /// Who read it: the built-in reader, or a language model whose facts are laid over the reader's.
    #[serde(default, skip_serializing_if = "Author::is_rules")]
    pub author: Author,
}

fn known_format<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    crate::formats::known(deserializer, ACCOUNT_FORMAT)
}

impl Account {
    /// Road and movements as the categorical columns would have them: as told, else as the state at the contact has it.
    pub fn template(&self) -> Template {
        let movement = |party: &Party| {
            told(&party.movement).unwrap_or(match told(&party.state) {
                Some(ContactState::Stopped) => Movement::Stopped,
                Some(ContactState::Parked) => Movement::Parked,
                Some(ContactState::Reversing) => Movement::Backing,
                Some(ContactState::SettingOff | ContactState::Moving) | None => Movement::Straight,
            })
        };
        let road = match told(&self.place.kind) {
            Some(PlaceKind::Intersection) => RoadType::Intersection,
            Some(PlaceKind::Highway) => RoadType::Highway,
            Some(PlaceKind::Circle) => RoadType::TrafficCircle,
            Some(PlaceKind::ParkingLot) => RoadType::ParkingLot,
            Some(PlaceKind::Garage) => RoadType::ParkingGarage,
            Some(PlaceKind::Street | PlaceKind::Alley | PlaceKind::Driveway | PlaceKind::Other) | None => {
                RoadType::Street
            }
        };
        let work_zone = self.place.features.iter().any(|feature| feature.value == RoadFeature::WorkZone);
        // A thing stands.
        let cp = self.partner.as_ref().map_or(Movement::Parked, movement);
        Template { road, sv: movement(&self.sv), cp, work_zone }
    }
}

/// One of the two sides.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Party {
    /// Kind.
    pub kind: Option<Fact<Kind>>,
    /// Movement just before the conflict; who stood before it was hit is `stopped`.
    pub movement: Option<Fact<Movement>>,
    /// State at the contact.
    pub state: Option<Fact<ContactState>>,
    /// How long it had stood, where it stood at the contact.
    pub standing: Option<Fact<Standing>>,
    /// Why it stood, where it stood at the contact.
    pub reasons: Vec<Fact<StandReason>>,
    /// What it did, in order.
    pub acts: Vec<ActFact>,
    /// Direction it was going or facing first.
    pub heading: Option<Fact<Compass>>,
    /// Direction of the street it turned or moved into.
    pub heading_after: Option<Fact<Compass>>,
    /// Its lane, first told.
    pub lane: Option<Fact<LaneWord>>,
    /// Over which line of the road its body reaches, who is partly in one lane and partly elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub astride: Option<Fact<Astride>>,
    /// To which side it is told to be about to turn, of who has not begun a turn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turns_next: Option<Fact<LeftRight>>,
    /// Speeds told, with what they mean.
    pub speeds: Vec<Fact<Speed>>,
    /// Where it was touched; empty where that is not told.
    pub zones: Vec<Fact<ContactZone>>,
    /// Signals and signs in front of it.
    pub controls: Vec<Fact<Control>>,
}

impl Party {
    /// Whether it did this, at any time up to the contact.
    pub fn did(&self, act: Act) -> bool {
        self.acts.iter().any(|fact| fact.act == act && !fact.after_contact)
    }

    /// Whether it did one of these, at any time up to the contact.
    pub fn did_any(&self, acts: &[Act]) -> bool {
        acts.iter().any(|act| self.did(*act))
    }

    /// Its contact zones without their sources.
    pub fn zone_values(&self) -> Vec<ContactZone> {
        self.zones.iter().map(|fact| fact.value).collect()
    }
}

/// Somebody or something else in the story.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Other {
    /// Kind.
    pub kind: Fact<Kind>,
    /// Where it is, seen from the subject vehicle.
    pub place: Option<Fact<Origin>>,
    /// More than one: a queue, parked cars.
    pub several: bool,
    /// What it did, in order.
    pub acts: Vec<ActFact>,
    /// Over which line of the road its body reaches, who is partly in one lane and partly elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub astride: Option<Fact<Astride>>,
    /// Who came out from behind it, or from between several of it, could not be seen for it before.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub hides: bool,
    /// It touched the partner, or the partner it, before the contact with the subject vehicle.
    pub touched_partner: bool,
    /// How, where that is told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touch: Option<Fact<EarlierTouch>>,
}

/// How the partner and another touched before the crash.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct EarlierTouch {
    /// The partner made contact with the other, and not that with it.
    pub by_partner: bool,
    /// Where the partner was touched.
    pub of_partner: Option<ContactZone>,
    /// Where the other was.
    pub of_other: Option<ContactZone>,
}

/// Two facts that cannot both be true.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Contradiction {
    /// What they are about: `sv.zones`.
    pub about: String,
    /// What the account keeps, and where it stands.
    pub kept: String,
    /// What stands against it.
    pub against: String,
}
