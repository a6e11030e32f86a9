//! Metrics, findings and faithfulness: what a rollout says about the ego, and whether it is true to its record.

pub use crate::conflict::CollisionKind;

use crate::conflict::{FirstMover, Side};
use crate::rollout::TerminationKind;
use crate::scenario::Approach;
use crate::template::Template;
use crate::vehicle::TYRE_LIMIT_MPS2;
use crate::zones::ContactZone;
use serde::{Deserialize, Serialize};

/// A value and when it was taken.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Timed {
    /// Value, in the unit of the field.
    pub value: f64,
    /// Time. [s]
    pub time_s: f64,
}

/// Metrics of one rollout.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// Per scripted partner and background vehicle, in the rollout's order.
    pub partners: Vec<PartnerMetrics>,
    /// Per obstacle, least box gap to the ego. [m]
    pub obstacle_gaps: Vec<Timed>,
    /// The ego's first contact with a road user.
    pub contact: Option<Contact>,
    /// Obstacles the ego touched.
    pub obstacles_hit: Vec<usize>,
    /// Least box gap between the ego and any scripted partner (background traffic where there is none). [m]
    pub min_gap: Option<Timed>,
    /// Least distance between the centres of the ego and any scripted partner. [m]
    pub min_centre_distance: Option<Timed>,
    /// About the ego alone.
    pub ego: EgoMetrics,
    /// How the rollout ended.
    pub termination: TerminationKind,
    /// How long it lasted. [s]
    pub duration_s: f64,
}

/// Metrics of the ego and one other road user. Absent where the measure is not defined at any step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PartnerMetrics {
    /// Position in [`crate::rollout::Rollout::actors`].
    pub actor: usize,
    /// Name.
    pub id: String,
    /// Least box gap, doors, mirrors, arms and trailers of both included. [m]
    pub min_gap: Timed,
    /// Least distance of the centres. [m]
    pub min_centre_distance: Timed,
    /// Least time to collision. [s]
    pub min_ttc: Option<Timed>,
    /// Post-encroachment time of the first conflict area; negative never. [s]
    pub pet: Option<Timed>,
    /// Greatest deceleration rate to avoid a crash. [m/s^2]
    pub max_drac: Option<Timed>,
    /// Greatest constant deceleration the ego needed to stay behind it, given how the other brakes. [m/s^2]
    #[serde(default)]
    pub max_required_deceleration: Option<Timed>,
    /// Least time headway (bumper to bumper) while following it. [s]
    pub min_headway: Option<Timed>,
}

/// A contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// The other's position in [`crate::rollout::Rollout::actors`].
    pub actor: usize,
    /// The other's name.
    pub id: String,
    /// When. [s]
    pub time_s: f64,
    /// Zone on the ego.
    pub ego_zone: ContactZone,
    /// Zone on the other.
    pub other_zone: ContactZone,
    /// Kind by geometry.
    pub kind: CollisionKind,
    /// Magnitude of the relative velocity. [m/s]
    pub relative_speed_mps: f64,
    /// Speed of the ego. [m/s]
    pub ego_speed_mps: f64,
    /// Speed of the other. [m/s]
    pub other_speed_mps: f64,
}

/// About the ego alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EgoMetrics {
    /// Hardest braking. [m/s^2, positive]
    pub max_deceleration: Timed,
    /// The hardest that tyres let it brake on this road. [m/s^2, positive]
    #[serde(default = "on_a_dry_road")]
    pub tyre_limit_mps2: f64,
    /// Hardest braking with nothing in its way. [m/s^2, positive]
    pub phantom_braking: Option<Timed>,
    /// Most changes between braking and accelerating within the profile's window.
    pub max_reversals: u32,
    /// When the window with the most of them ended; 0 where there are none. [s]
    #[serde(default)]
    pub max_reversals_time_s: f64,
    /// Farthest a corner went beyond its lane's edge. [m]
    pub max_lane_departure: Timed,
    /// Distance driven. [m]
    pub distance_m: f64,
    /// Mean speed. [m/s]
    pub mean_speed_mps: f64,
}

fn on_a_dry_road() -> f64 {
    TYRE_LIMIT_MPS2
}

/// Time series of one rollout, for plots: one value per recorded step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Time. [s]
    pub time_s: Vec<f64>,
    /// Speed of the ego. [m/s]
    pub ego_speed_mps: Vec<f64>,
    /// Longitudinal acceleration of the ego over the step that begins here; the last one is repeated. [m/s^2]
    pub ego_acceleration_mps2: Vec<f64>,
    /// Per scripted partner, in the rollout's order.
    pub partners: Vec<PartnerSeries>,
}

/// Time series of one scripted partner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PartnerSeries {
    /// Position in [`crate::rollout::Rollout::actors`].
    pub actor: usize,
    /// Name.
    pub id: String,
    /// Speed. [m/s]
    pub speed_mps: Vec<f64>,
    /// Longitudinal acceleration, as the ego's. [m/s^2]
    pub acceleration_mps2: Vec<f64>,
    /// Box gap to the ego. [m]
    pub gap_m: Vec<f64>,
    /// Distance of the centres. [m]
    pub centre_distance_m: Vec<f64>,
    /// Time to collision with the ego; `None` where they would never touch. [s]
    pub ttc_s: Vec<Option<f64>>,
}

/// What a rollout shows about the ego.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// What.
    pub kind: FindingKind,
    /// When. [s]
    pub time_s: f64,
    /// Measured value, in the unit of the sentence.
    pub value: f64,
    /// Threshold it crossed, in the same unit.
    pub threshold: f64,
    /// One sentence for the report.
    pub sentence: String,
}

/// Kind of finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FindingKind {
    /// Contact with a road user.
    Contact,
    /// Contact with an obstacle.
    ObstacleContact,
    /// Box gap to a partner below the profile's threshold.
    NearMiss,
    /// The ego left the road.
    OffRoad,
    /// The ego stood still and never arrived.
    Stuck,
    /// Hard braking.
    HardBraking,
    /// Braking that tyres do not give: what it came to so is no result of a real vehicle.
    BrakingBeyondTyres,
    /// Braking with nothing in the way.
    PhantomBraking,
    /// Braking and accelerating in turn.
    Oscillation,
    /// A corner left the lane.
    LaneDeparture,
}

impl FindingKind {
    /// All kinds.
    pub const ALL: [Self; 10] = [
        Self::Contact,
        Self::ObstacleContact,
        Self::NearMiss,
        Self::OffRoad,
        Self::Stuck,
        Self::HardBraking,
        Self::BrakingBeyondTyres,
        Self::PhantomBraking,
        Self::Oscillation,
        Self::LaneDeparture,
    ];

    /// Whether a finding of this kind makes the scenario a failed one; the others are odd behaviour worth a look.
    pub fn is_failure(self) -> bool {
        matches!(self, Self::Contact | Self::ObstacleContact | Self::NearMiss | Self::OffRoad | Self::Stuck)
    }

    /// Whether something is hit or the road is left: more serious than the other failures.
    pub fn is_crash(self) -> bool {
        matches!(self, Self::Contact | Self::ObstacleContact | Self::OffRoad)
    }

    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::ObstacleContact => "obstacle contact",
            Self::NearMiss => "near miss",
            Self::OffRoad => "off road",
            Self::Stuck => "stuck",
            Self::HardBraking => "hard braking",
            Self::BrakingBeyondTyres => "braking beyond tyres",
            Self::PhantomBraking => "phantom braking",
            Self::Oscillation => "oscillation",
            Self::LaneDeparture => "lane departure",
        }
    }
}

/// What the rollout must show to be true to its record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Expectation {
    /// Template of the record.
    pub template: Template,
    /// Approach of the partner the narrative states.
    pub approach: Option<Approach>,
    /// On which side of the ego a partner from the ego's own road drives, where the narrative states it.
    #[serde(default)]
    pub side: Option<Side>,
    /// Who reached the place where the paths cross first; absent where the paths do not cross or the record does not tell.
    #[serde(default)]
    pub order: Option<FirstMover>,
    /// Speed told of the ego, as far as the map allows it. [m/s]
    #[serde(default)]
    pub sv_speed_mps: Option<f64>,
    /// Speed told of the partner, as far as the map allows it. [m/s]
    #[serde(default)]
    pub cp_speed_mps: Option<f64>,
    /// Contact zones of the record on the ego; empty where they do not bind (alternative narratives).
    pub sv_zones: Vec<ContactZone>,
    /// Contact zones of the record on the partner; empty where they do not bind.
    pub cp_zones: Vec<ContactZone>,
    /// Kinds of collision that must not happen.
    pub excluded: Vec<CollisionKind>,
    /// Whether the narrative names obstacles (cones, barriers) although the record has no work zone.
    #[serde(default)]
    pub obstacles_named: bool,
}

/// One check of faithfulness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// What is compared.
    pub kind: CheckKind,
    /// What the record says.
    pub expected: String,
    /// What the rollout shows.
    pub observed: String,
    /// Result.
    pub result: CheckResult,
}

/// What a check compares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CheckKind {
    /// Kind of road driven on.
    Road,
    /// Obstacles where, and only where, there is a work zone or the narrative names some, and none in a junction.
    WorkZone,
    /// Movement of the ego, from its path.
    SvMovement,
    /// Movement of the partner, from its path.
    CpMovement,
    /// What the ego is told to have done until the contact, one after the other.
    SvActs,
    /// The same of the partner.
    CpActs,
    /// Side from which the partner came, or on which it drove.
    Approach,
    /// Who reached the place where the paths cross first.
    Order,
    /// Speed of the ego against the one told.
    SvSpeed,
    /// Speed of the partner against the one told.
    CpSpeed,
    /// The partner is part of the closest encounter.
    Encounter,
    /// Contact zones.
    ContactZones,
    /// Kinds of collision the profile excludes.
    ExcludedCollision,
    /// The first contact of the ego is with the partner.
    Contact,
    /// Kind of the partner.
    Partner,
    /// Zone of the contact on the ego.
    SvZones,
    /// Zone of the contact on the partner.
    CpZones,
    /// Whether the ego stood, moved, set off or went backwards at the contact.
    SvState,
    /// The same of the partner.
    CpState,
    /// Somebody else touched the partner before it touched the ego.
    PassedOn,
    /// Lane of the ego when the scene begins.
    SvLane,
    /// Lane of the partner when the scene begins.
    CpLane,
    /// The ego's body over the told line of the road, when it is told there.
    SvAstride,
    /// The partner's.
    CpAstride,
    /// Those of others.
    OthersAstride,
    /// What the ego's signal or sign showed, and whether it obeyed it.
    SvControl,
    /// The same of the partner's.
    CpControl,
    /// Why the ego stood.
    Reason,
    /// Everybody else in the story.
    Others,
    /// A door took part.
    Door,
    /// The system under test came into the situation of the record.
    Situation,
}

impl CheckKind {
    /// Those that an account is held to, in the order of tables.
    pub const OF_ACCOUNTS: [Self; 25] = [
        Self::Contact,
        Self::Partner,
        Self::SvZones,
        Self::CpZones,
        Self::SvState,
        Self::CpState,
        Self::SvSpeed,
        Self::CpSpeed,
        Self::SvMovement,
        Self::CpMovement,
        Self::SvActs,
        Self::CpActs,
        Self::Approach,
        Self::Order,
        Self::PassedOn,
        Self::SvLane,
        Self::CpLane,
        Self::SvAstride,
        Self::CpAstride,
        Self::OthersAstride,
        Self::SvControl,
        Self::CpControl,
        Self::Reason,
        Self::Others,
        Self::Door,
    ];

    /// What it is about: stagings are judged by that.
    pub fn class(self) -> CheckClass {
        match self {
            Self::Road
            | Self::WorkZone
            | Self::Encounter
            | Self::ContactZones
            | Self::ExcludedCollision
            | Self::Situation => CheckClass::OfTemplates,
            Self::Contact
            | Self::Partner
            | Self::SvZones
            | Self::CpZones
            | Self::SvState
            | Self::CpState
            | Self::SvSpeed
            | Self::CpSpeed
            | Self::Door => CheckClass::Touch,
            Self::Approach | Self::Order | Self::SvLane | Self::CpLane => CheckClass::Place,
            Self::SvMovement | Self::CpMovement => CheckClass::Movement,
            Self::SvActs | Self::CpActs => CheckClass::Acts,
            Self::PassedOn => CheckClass::Push,
            Self::SvAstride | Self::CpAstride => CheckClass::Astride,
            Self::SvControl | Self::CpControl => CheckClass::Signal,
            Self::Reason | Self::Others => CheckClass::Others,
            Self::OthersAstride => CheckClass::OthersAstride,
        }
    }

    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Road => "road",
            Self::WorkZone => "work zone",
            Self::SvMovement => "SV movement",
            Self::CpMovement => "CP movement",
            Self::SvActs => "SV acts",
            Self::CpActs => "CP acts",
            Self::Approach => "approach",
            Self::Order => "order",
            Self::SvSpeed => "SV speed",
            Self::CpSpeed => "CP speed",
            Self::Encounter => "encounter",
            Self::ContactZones => "contact zones",
            Self::ExcludedCollision => "excluded collisions",
            Self::Contact => "contact",
            Self::Partner => "partner kind",
            Self::SvZones => "SV zones",
            Self::CpZones => "CP zones",
            Self::SvState => "SV state",
            Self::CpState => "CP state",
            Self::PassedOn => "thrown by another",
            Self::SvLane => "SV lane",
            Self::CpLane => "CP lane",
            Self::SvAstride => "SV over a line",
            Self::CpAstride => "CP over a line",
            Self::OthersAstride => "others over a line",
            Self::SvControl => "SV signal or sign",
            Self::CpControl => "CP signal or sign",
            Self::Reason => "why the SV stood",
            Self::Others => "others in the story",
            Self::Door => "door",
            Self::Situation => "situation met",
        }
    }

    /// What else a failure of this check may mean than a scenario that is not true to its record.
    pub fn doubt(self) -> Option<&'static str> {
        (self == Self::Order).then_some(
            "Who comes first is up to the ego as well: one that gives way where the record's did not never gets into the \
             record's crash. Then neither the scenario nor the ego is at fault, and the run says nothing about that crash.",
        )
    }
}

/// What a check is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CheckClass {
    /// No account is held to it: a template is, or the system under test.
    OfTemplates,
    /// Who touches whom, where on both, and how fast.
    Touch,
    /// From where the partner came, in which lane each was, and who was there first.
    Place,
    /// Which way each of the two came.
    Movement,
    /// What each of the two did, one act after the other.
    Acts,
    /// Who threw the partner at the ego.
    Push,
    /// Whether one of the two is over a line of the road.
    Astride,
    /// What signals and signs showed, and who obeyed them.
    Signal,
    /// Who else was there, and why the ego stood.
    Others,
    /// Whether one of those is over a line of the road.
    OthersAstride,
}

impl CheckClass {
    /// Whether it is something that the two did: without it the crash is another one.
    pub const fn is_deed(self) -> bool {
        matches!(self, Self::Movement | Self::Acts | Self::Push)
    }
}

/// What became of one stated fact: shown, not shown, cannot be shown, not stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CheckResult {
    /// The rollout shows what is told.
    Shown,
    /// It shows something else.
    NotShown,
    /// It is told, and this rollout cannot show it: contact zones without a contact, say.
    CannotBeShown,
    /// Nothing is told about it.
    NotTold,
}

/// A verdict of three values: nothing that failed is not yet a yes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// It holds, and everything it rests on was checked.
    Yes,
    /// It does not.
    No,
    /// Nothing speaks against it, and not everything was checked.
    Unchecked,
}

impl Answer {
    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Yes => "yes",
            Self::No => "no",
            Self::Unchecked => "unchecked",
        }
    }
}

/// Whether a rollout is true to its record, fact by fact; without checks where there is no record to be true to.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Verdict {
    /// Every check.
    pub checks: Vec<Check>,
}

impl Verdict {
    /// Whether the rollout is true to its record: yes where every told fact is shown, no where one is not, unchecked where
    /// one cannot be shown or nothing was told.
    pub fn faithful(&self) -> Answer {
        let any = |result| self.told().any(|check| check.result == result);
        if any(CheckResult::NotShown) {
            Answer::No
        } else if any(CheckResult::CannotBeShown) || !any(CheckResult::Shown) {
            Answer::Unchecked
        } else {
            Answer::Yes
        }
    }

    /// The checks of told facts: whether a system under test came into the situation is none.
    fn told(&self) -> impl Iterator<Item = &Check> {
        self.checks.iter().filter(|check| check.kind != CheckKind::Situation)
    }

    /// The told facts that the rollout does not show.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        self.told().filter(|check| check.result == CheckResult::NotShown)
    }

    /// The told facts that the rollout cannot show.
    pub fn unchecked(&self) -> impl Iterator<Item = &Check> {
        self.told().filter(|check| check.result == CheckResult::CannotBeShown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// Every kind there is: the error for an unknown one lists their names.
    fn all_kinds() -> BTreeSet<CheckKind> {
        let error = serde_json::from_str::<CheckKind>("\"?\"").unwrap_err().to_string();
        let names = error.split('`').skip(3).step_by(2);
        names.map(|name| serde_json::from_value(name.into()).expect(name)).collect()
    }

    #[test]
    fn the_kinds_of_accounts_are_all_that_are_not_of_templates() {
        let all = all_kinds();
        assert!(all.contains(&CheckKind::Road) && all.contains(&CheckKind::Situation), "{all:?}");
        // What a template is held to besides: the same words, asked of accounts too.
        let of_accounts = all.into_iter().filter(|kind| kind.class() != CheckClass::OfTemplates);
        assert_eq!(of_accounts.collect::<BTreeSet<_>>(), BTreeSet::from(CheckKind::OF_ACCOUNTS));
    }

    fn verdict(results: &[CheckResult]) -> Answer {
        let check = |&result| Check { kind: CheckKind::Road, expected: String::new(), observed: String::new(), result };
        Verdict { checks: results.iter().map(check).collect() }.faithful()
    }

    #[test]
    fn yes_asks_for_every_told_fact_and_nothing_that_failed_is_not_yet_a_yes() {
        use CheckResult::{CannotBeShown, NotShown, NotTold, Shown};
        assert_eq!(verdict(&[Shown, NotTold, Shown]), Answer::Yes);
        assert_eq!(verdict(&[Shown, CannotBeShown]), Answer::Unchecked);
        assert_eq!(verdict(&[Shown, CannotBeShown, NotShown]), Answer::No);
        assert_eq!(verdict(&[NotTold, NotTold]), Answer::Unchecked);
        assert_eq!(verdict(&[]), Answer::Unchecked);
    }
}
