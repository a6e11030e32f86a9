//! Right or wrong, field by field, and how sure a share of so many can be. Definitions: `docs/models/evaluation.md`.

use recrash_model::labelled::LabelledAccount;
use recrash_model::scenario::Approach;
use recrash_model::zones::ContactZone;
use serde::{Deserialize, Serialize};

/// 97.5th percentile of the normal distribution: two-sided 95 %.
const Z_95: f64 = 1.959_963_984_540_054;

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Field {
    /// Kind of road.
    Road,
    /// From where the partner came.
    Approach,
    /// Movement of the subject vehicle.
    SvMovement,
    /// Movement of the partner.
    CpMovement,
    /// Who was first.
    Order,
    /// Zones on the subject vehicle.
    SvZones,
    /// Zones on the partner.
    CpZones,
    /// Whether the profile excludes this collision.
    Excluded,
    /// Crash type.
    CrashType,
    /// Whose move brought the conflict about.
    Role,
    /// Who moved into whom.
    Striker,
    /// Whether the subject vehicle stood at the contact.
    SvState,
    /// Since when it stood or moved.
    SvSince,
    /// Who drove it at the contact.
    Driver,
    /// From where the partner came, finer than `approach`.
    CameFrom,
    /// First harmful contact.
    FirstContact,
    /// Speed of the subject vehicle at the contact.
    SvImpactMps,
}

impl Field {
    /// What is asked of who reads records, in the order of tables.
    pub const OF_RECORDS: [Self; 8] = [
        Self::Road,
        Self::Approach,
        Self::SvMovement,
        Self::CpMovement,
        Self::Order,
        Self::SvZones,
        Self::CpZones,
        Self::Excluded,
    ];

    /// What is asked of the reader of accounts, in the order of tables.
    pub const OF_ACCOUNTS: [Self; 14] = [
        Self::CrashType,
        Self::Role,
        Self::Striker,
        Self::SvState,
        Self::SvSince,
        Self::Driver,
        Self::SvMovement,
        Self::CpMovement,
        Self::CameFrom,
        Self::Order,
        Self::FirstContact,
        Self::SvZones,
        Self::CpZones,
        Self::SvImpactMps,
    ];

    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Road => "road",
            Self::Approach => "approach",
            Self::SvMovement => "SV movement",
            Self::CpMovement => "CP movement",
            Self::Order => "order",
            Self::SvZones => "SV zones",
            Self::CpZones => "CP zones",
            Self::Excluded => "exclusion",
            Self::CrashType => "crash type",
            Self::Role => "role",
            Self::Striker => "striker",
            Self::SvState => "SV standing",
            Self::SvSince => "since when",
            Self::Driver => "who drove",
            Self::CameFrom => "approach",
            Self::FirstContact => "first contact",
            Self::SvImpactMps => "SV impact speed",
        }
    }

    /// What an account says of this field, in the words of the labels; `unknown` where it says nothing.
    pub fn text(self, account: &LabelledAccount) -> String {
        let zones = |zones: &[ContactZone]| {
            let names: Vec<String> = zones.iter().map(|zone| word(Some(zone))).collect();
            if names.is_empty() { word::<()>(None) } else { names.join(";") }
        };
        match self {
            Self::Road => word(account.road),
            Self::Approach => word(account.approach.map(on_the_road)),
            Self::SvMovement => word(account.sv_movement),
            Self::CpMovement if account.cp_unmoved => "none".into(),
            Self::CpMovement => word(account.cp_movement),
            Self::Order => word(account.order),
            Self::SvZones => zones(&account.sv_zones),
            Self::CpZones => zones(&account.cp_zones),
            Self::Excluded => match account.excluded {
                Some(true) => "yes".into(),
                Some(false) => "no".into(),
                None => word::<()>(None),
            },
            Self::CrashType => word(account.crash_type),
            Self::Role => word(account.role),
            Self::Striker => word(account.striker),
            Self::SvState => word(account.sv_state),
            Self::SvSince => word(account.sv_since),
            Self::Driver => word(account.driver),
            Self::CameFrom => word(account.came_from),
            Self::FirstContact => word(account.first_contact),
            Self::SvImpactMps => account.sv_impact_mps.map_or_else(|| word::<()>(None), |mps| format!("{mps:.1}")),
        }
    }

    /// Whether what is said agrees with the label; `None` where the label says nothing.
    pub fn agrees(self, label: &LabelledAccount, said: &LabelledAccount) -> Option<bool> {
        fn same<T: PartialEq>(label: Option<T>, said: Option<T>) -> Option<bool> {
            label.map(|label| said == Some(label))
        }
        match self {
            Self::Road => same(label.road, said.road),
            Self::Approach => same(label.approach.map(on_the_road), said.approach.map(on_the_road)),
            Self::SvMovement => same(label.sv_movement, said.sv_movement),
            Self::CpMovement if label.cp_unmoved => Some(said.cp_unmoved),
            Self::CpMovement => same(label.cp_movement, said.cp_movement.filter(|_| !said.cp_unmoved)),
            Self::Order => same(label.order, said.order),
            Self::SvZones => zones_agree(&label.sv_zones, &said.sv_zones),
            Self::CpZones => zones_agree(&label.cp_zones, &said.cp_zones),
            Self::Excluded => same(label.excluded, said.excluded),
            Self::CrashType => same(label.crash_type, said.crash_type),
            Self::Role => same(label.role, said.role),
            Self::Striker => same(label.striker, said.striker),
            Self::SvState => same(label.sv_state, said.sv_state),
            Self::SvSince => same(label.sv_since, said.sv_since),
            Self::Driver => same(label.driver, said.driver),
            Self::CameFrom => same(label.came_from, said.came_from),
            Self::FirstContact => same(label.first_contact, said.first_contact),
            Self::SvImpactMps => {
                label.sv_impact_mps.map(|label| said.sv_impact_mps.is_some_and(|said| near(label, said)))
            }
        }
    }
}

/// The labels know no ring: who was on it counts as coming from the ego's road.
fn on_the_road(approach: Approach) -> Approach {
    if approach == Approach::Ring { Approach::Same } else { approach }
}

fn word<T: Serialize>(value: Option<T>) -> String {
    let text = value.and_then(|value| serde_json::to_value(value).ok());
    text.as_ref().and_then(|text| text.as_str()).unwrap_or("unknown").to_owned()
}

/// Impact speeds this far from the label's are right. [m/s]
const SPEED_TOLERANCE: f64 = 2.0;
/// So are those within this share of it.
const SPEED_SHARE: f64 = 0.25;

fn near(label: f64, said: f64) -> bool {
    (label - said).abs() <= SPEED_TOLERANCE.max(SPEED_SHARE * label)
}

/// At least half of all zones that either names are named by both.
fn zones_agree(label: &[ContactZone], said: &[ContactZone]) -> Option<bool> {
    let distinct = |zones: &[ContactZone]| ContactZone::ALL.map(|zone| zones.contains(&zone));
    let (label, said) = (distinct(label), distinct(said));
    let count = |is: fn(bool, bool) -> bool| label.iter().zip(&said).filter(|&(&a, &b)| is(a, b)).count();
    let (both, either) = (count(|a, b| a && b), count(|a, b| a || b));
    label.contains(&true).then_some(2 * both >= either)
}

/// How often a field was right.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FieldScore {
    /// Field.
    pub field: Field,
    /// Records where it agrees with the label.
    pub right: usize,
    /// Records whose label says something of it.
    pub scored: usize,
    /// Records whose label says that it cannot be told: they count neither way.
    pub unknown: usize,
    /// Share of the scored that is right; absent where none is scored.
    pub share: Option<f64>,
    /// Wilson 95 % interval of the share.
    pub interval: Option<(f64, f64)>,
    /// How often the two readers of the labels agree, where the labels say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub readers: Option<TwoReaders>,
}

/// How often two readers agree who did not see each other's answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TwoReaders {
    /// Records on which they agree.
    pub agreed: usize,
    /// Records of which both say something.
    pub both_told: usize,
}

impl FieldScore {
    /// From what agreed.
    pub fn of(field: Field, verdicts: &[Option<bool>], readers: Option<TwoReaders>) -> Self {
        let scored = verdicts.iter().flatten().count();
        let right = verdicts.iter().flatten().filter(|&&agrees| agrees).count();
        let share = (scored > 0).then(|| right as f64 / scored as f64);
        let unknown = verdicts.len() - scored;
        Self { field, right, scored, unknown, share, interval: wilson(right, scored), readers }
    }
}

/// Wilson's score interval of a share: (p + z^2/2n -+ z sqrt(p(1-p)/n + z^2/4n^2)) / (1 + z^2/n).
fn wilson(right: usize, scored: usize) -> Option<(f64, f64)> {
    if scored == 0 {
        return None;
    }
    let n = scored as f64;
    let p = right as f64 / n;
    let z2 = Z_95 * Z_95;
    let middle = p + z2 / (2.0 * n);
    let half = Z_95 * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
    let scale = 1.0 + z2 / n;
    Some((((middle - half) / scale).max(0.0), ((middle + half) / scale).min(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ContactZone::{Front, FrontLeft, FrontRight, Left, Rear};
    use recrash_model::template::Movement;

    #[test]
    fn wilson_intervals_are_those_of_the_textbook() {
        // Newcombe (1998), example of 81 of 263: 0.2553 to 0.3662.
        let (low, high) = wilson(81, 263).unwrap();
        assert!((low - 0.2553).abs() < 5e-5 && (high - 0.3662).abs() < 5e-5, "{low} {high}");
        assert_eq!(wilson(0, 0), None);
        assert_eq!(wilson(5, 5).unwrap().1, 1.0);
    }

    #[test]
    fn zones_agree_from_half_on() {
        assert_eq!(zones_agree(&[], &[Front]), None);
        assert_eq!(zones_agree(&[Front], &[]), Some(false));
        assert_eq!(zones_agree(&[Front], &[Front, FrontLeft]), Some(true));
        assert_eq!(zones_agree(&[Front], &[Front, FrontLeft, FrontRight]), Some(false));
        assert_eq!(zones_agree(&[Left, FrontLeft], &[FrontLeft, Left, FrontLeft]), Some(true));
        assert_eq!(zones_agree(&[Rear], &[Front]), Some(false));
    }

    #[test]
    fn what_the_label_does_not_know_counts_neither_way_and_what_the_reader_does_not_know_is_wrong() {
        let label = LabelledAccount { approach: Some(Approach::Same), ..LabelledAccount::default() };
        let ring = LabelledAccount { approach: Some(Approach::Ring), ..LabelledAccount::default() };
        assert_eq!(Field::Approach.agrees(&label, &ring), Some(true));
        assert_eq!(Field::Approach.agrees(&label, &LabelledAccount::default()), Some(false));
        assert_eq!(Field::Approach.agrees(&LabelledAccount::default(), &label), None);
        let score = FieldScore::of(Field::Approach, &[Some(true), Some(false), None], None);
        assert_eq!((score.right, score.scored, score.unknown), (1, 2, 1));
    }

    #[test]
    fn a_thing_has_no_movement_and_who_says_one_is_wrong() {
        let thing = LabelledAccount { cp_unmoved: true, ..LabelledAccount::default() };
        let car = LabelledAccount { cp_movement: Some(Movement::Parked), ..LabelledAccount::default() };
        assert_eq!(Field::CpMovement.agrees(&thing, &thing), Some(true));
        assert_eq!(Field::CpMovement.agrees(&thing, &car), Some(false));
        assert_eq!(Field::CpMovement.agrees(&car, &thing), Some(false));
        assert_eq!(Field::CpMovement.text(&thing), "none");
    }

    #[test]
    fn impact_speeds_agree_within_two_metres_a_second_or_a_quarter() {
        let at = |mps| LabelledAccount { sv_impact_mps: mps, ..LabelledAccount::default() };
        let agrees = |label, said| Field::SvImpactMps.agrees(&at(label), &at(said));
        assert_eq!(agrees(Some(0.0), Some(2.0)), Some(true));
        assert_eq!(agrees(Some(0.0), Some(2.1)), Some(false));
        assert_eq!(agrees(Some(20.0), Some(25.0)), Some(true));
        assert_eq!(agrees(Some(20.0), Some(14.9)), Some(false));
        assert_eq!(agrees(Some(20.0), None), Some(false));
        assert_eq!(agrees(None, Some(20.0)), None);
    }
}
