//! What a model says of an account: corrections of what the built-in reader made of it, in the form in which the reader's account
//! is shown to it. A field that is left out stays as it was; a list that is given takes the place of the old one.

use recrash_model::account::{
    Account, Act, ActFact, Astride, Compass, ContactState, Control, CrashType, Driver, EarlierTouch, Fact,
    FirstContact, Kind, LaneWord, LeftRight, Manner, Origin, Other, Party, Place, PlaceKind, RoadFeature, Role, Source,
    Speed, SpeedMeaning, StandReason, Standing, Striker, told,
};
use recrash_model::narrative::FirstMover;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A fact, and where it stands: neither words nor column are needed where the draft has the same fact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::llm) struct Quoted<T> {
    /// The fact.
    pub value: T,
    /// Words of the narrative that say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 300))]
    pub words: Option<String>,
    /// Or the column that does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
}

/// A speed and what it is the speed of.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::llm) struct SpeedValue {
    /// The speed. [m/s]
    #[schemars(range(min = 0.0, max = 60.0))]
    pub mps: f64,
    /// Of what.
    pub meaning: SpeedMeaning,
}

/// One thing that a road user did, in the order of the story.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::llm) struct ActAnswer {
    /// What.
    pub act: Act,
    /// To which side, seen from who does it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<LeftRight>,
    /// Place in the order of everybody's acts; what is done at the same time has the same number.
    #[schemars(range(max = 99))]
    pub step: u32,
    /// It came after the contact.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub after_contact: bool,
    /// It was begun or tried, and the contact came before it was done.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub begun: bool,
    /// It is told to have been done, or all but done, before what comes next.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub done: bool,
    /// Of SV and partner: the `step` of the other one's act after which the words put it ("then", "as", "when").
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after_other: Option<u32>,
    /// How fast, where words say so and no number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manner: Option<Manner>,
    /// Words of the narrative that say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 300))]
    pub words: Option<String>,
}

/// What is told of one of the two. What is null stays as the draft has it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(in crate::llm) struct PartyAnswer {
    /// What it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kind: Option<Quoted<Kind>>,
    /// Movement just before the conflict; who stood before it was hit is `stopped`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub movement: Option<Quoted<Movement>>,
    /// State at the contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub state: Option<Quoted<ContactState>>,
    /// How long it had stood, where it stood at the contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standing: Option<Quoted<Standing>>,
    /// Why it stood, where it stood at the contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 6))]
    pub reasons: Option<Vec<Quoted<StandReason>>>,
    /// What it did, in order.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 24))]
    pub acts: Option<Vec<ActAnswer>>,
    /// Direction it was going or facing first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heading: Option<Quoted<Compass>>,
    /// Direction of the street it turned or moved into.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heading_after: Option<Quoted<Compass>>,
    /// Its lane, first told.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lane: Option<Quoted<LaneWord>>,
    /// Over which line its body reaches, of who is partly in one lane and partly elsewhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub astride: Option<Quoted<Astride>>,
    /// Speeds told.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 4))]
    pub speeds: Option<Vec<Quoted<SpeedValue>>>,
    /// Where it was touched first.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 4))]
    pub zones: Option<Vec<Quoted<ContactZone>>>,
    /// Signals and signs in front of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 4))]
    pub controls: Option<Vec<Quoted<Control>>>,
}

/// Somebody or something else in the story.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::llm) struct OtherAnswer {
    /// What it is, with the words that name it.
    pub kind: Quoted<Kind>,
    /// Where it is, seen from SV.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<Quoted<Origin>>,
    /// More than one: a queue, parked cars.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub several: bool,
    /// What it did, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 24))]
    pub acts: Vec<ActAnswer>,
    /// Over which line its body reaches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub astride: Option<Quoted<Astride>>,
    /// Somebody came out from behind it, or from between several of it, or could not be seen for it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub hides: bool,
    /// It and the partner touched before the contact with SV.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub touched_partner: bool,
    /// How they did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touch: Option<Quoted<EarlierTouch>>,
}

/// Where it happened.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(in crate::llm) struct PlaceAnswer {
    /// Kind of place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kind: Option<Quoted<PlaceKind>>,
    /// What the road has there.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 16))]
    pub features: Option<Vec<Quoted<RoadFeature>>>,
    /// Lanes in SV's direction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lanes: Option<Quoted<u8>>,
    /// Arms of the junction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arms: Option<Quoted<u8>>,
}

/// Corrections of the draft account of the first report's crash. What is null stays as the draft has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::llm) struct AccountAnswer {
    /// The first report, such as `30270-7733/1`.
    pub report: String,
    /// What the draft has and nobody tells: paths such as `sv.lane` or `came_from`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 24))]
    pub nobody_tells: Vec<String>,
    /// Type of the crash, which follows from the facts below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crash_type: Option<CrashType>,
    /// Whose move brought the conflict about: follows from the facts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<Role>,
    /// Who was at the place of the conflict first: follows from the facts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<FirstMover>,
    /// The subject vehicle.
    #[serde(default)]
    pub sv: PartyAnswer,
    /// The partner is somebody else than in the draft: nothing that the draft says of its partner stays.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub another_partner: bool,
    /// The partner: the first road user or thing that SV touched, or that touched it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub partner: Option<PartyAnswer>,
    /// From where the partner came, seen from SV before any turn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub came_from: Option<Quoted<Origin>>,
    /// Whether a partner from beside was ahead of SV before it left its line, or behind it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ahead: Option<Quoted<bool>>,
    /// Who moved into whom.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub striker: Option<Quoted<Striker>>,
    /// First harmful contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_contact: Option<Quoted<FirstContact>>,
    /// Who drove SV at the contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub driver: Option<Quoted<Driver>>,
    /// Whose door took part, where one did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub door: Option<Quoted<Striker>>,
    /// Where it happened.
    #[serde(default)]
    pub place: PlaceAnswer,
    /// Everybody and everything else in the story.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 12))]
    pub others: Option<Vec<OtherAnswer>>,
}

impl<T: Copy> Quoted<T> {
    fn of(fact: &Fact<T>) -> Self {
        let (words, column) = match &fact.source {
            Source::Words { text, .. } => (Some(text.clone()), None),
            Source::Column { name } => (None, Some(name.clone())),
            Source::Rule { .. } => (None, None),
        };
        Self { value: fact.value, words, column }
    }

    fn of_known(fact: &Option<Fact<T>>) -> Option<Self> {
        fact.as_ref().map(Self::of)
    }

    fn of_each(facts: &[Fact<T>]) -> Option<Vec<Self>> {
        (!facts.is_empty()).then(|| facts.iter().map(Self::of).collect())
    }
}

impl SpeedValue {
    fn of(speed: &Fact<Speed>) -> Quoted<Self> {
        let Quoted { value: Speed { mps, meaning }, words, column } = Quoted::of(speed);
        Quoted { value: Self { mps: (mps * 100.0).round() / 100.0, meaning }, words, column }
    }
}

impl ActAnswer {
    fn of(fact: &ActFact) -> Self {
        let words = match &fact.source {
            Source::Words { text, .. } => Some(text.clone()),
            Source::Column { .. } | Source::Rule { .. } => None,
        };
        let ActFact { act, side, step, after_contact, begun, done, manner, after_other, source: _ } = fact.clone();
        Self { act, side, step, after_contact, begun, done, after_other, manner, words }
    }
}

impl PartyAnswer {
    fn of(party: &Party) -> Self {
        let list = |found: Vec<ActAnswer>| (!found.is_empty()).then_some(found);
        let speeds: Vec<Quoted<SpeedValue>> = party.speeds.iter().map(SpeedValue::of).collect();
        Self {
            kind: Quoted::of_known(&party.kind),
            movement: Quoted::of_known(&party.movement),
            state: Quoted::of_known(&party.state),
            standing: Quoted::of_known(&party.standing),
            reasons: Quoted::of_each(&party.reasons),
            acts: list(party.acts.iter().map(ActAnswer::of).collect()),
            heading: Quoted::of_known(&party.heading),
            heading_after: Quoted::of_known(&party.heading_after),
            lane: Quoted::of_known(&party.lane),
            astride: Quoted::of_known(&party.astride),
            speeds: (!speeds.is_empty()).then_some(speeds),
            zones: Quoted::of_each(&party.zones),
            controls: Quoted::of_each(&party.controls),
        }
    }
}

impl OtherAnswer {
    fn of(other: &Other) -> Self {
        Self {
            kind: Quoted::of(&other.kind),
            place: Quoted::of_known(&other.place),
            several: other.several,
            acts: other.acts.iter().map(ActAnswer::of).collect(),
            astride: Quoted::of_known(&other.astride),
            hides: other.hides,
            touched_partner: other.touched_partner,
            touch: Quoted::of_known(&other.touch),
        }
    }
}

impl PlaceAnswer {
    fn of(place: &Place) -> Self {
        Self {
            kind: Quoted::of_known(&place.kind),
            features: Quoted::of_each(&place.features),
            lanes: Quoted::of_known(&place.lanes),
            arms: Quoted::of_known(&place.arms),
        }
    }
}

impl AccountAnswer {
    /// An account as a model is shown it, and answers it.
    pub fn of(account: &Account) -> Self {
        Self {
            report: account.report.to_string(),
            nobody_tells: Vec::new(),
            crash_type: told(&account.crash_type),
            role: told(&account.role),
            order: told(&account.order),
            sv: PartyAnswer::of(&account.sv),
            another_partner: false,
            partner: account.partner.as_ref().map(PartyAnswer::of),
            came_from: Quoted::of_known(&account.came_from),
            ahead: Quoted::of_known(&account.ahead),
            striker: Quoted::of_known(&account.striker),
            first_contact: Quoted::of_known(&account.first_contact),
            driver: Quoted::of_known(&account.driver),
            door: Quoted::of_known(&account.door),
            place: PlaceAnswer::of(&account.place),
            others: (!account.others.is_empty()).then(|| account.others.iter().map(OtherAnswer::of).collect()),
        }
    }
}
