//! Computed severity against the harm that records report.

use crate::ranks::Ranks;
use recrash_model::Seed;
use recrash_model::record::{OfVehicles, Severity as Injury};
use recrash_model::severity::{HarmLevel, RankAgreement, SeverityAgreement};

/// Seed of the resamples.
const SEED: Seed = Seed(1);

/// A crash that is told with a contact of two road users, and what its record reports of harm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HarmCase {
    /// Greater change of velocity of the two, where the recorded driver crashes. [m/s]
    pub delta_v_mps: f64,
    /// The speeds of both at the contact are told, or they stood.
    pub speeds_told: bool,
    /// Speed of the subject vehicle before the crash, as its column has it. [m/s]
    pub reported_speed_mps: Option<f64>,
    /// Highest injury alleged, where known.
    pub injury: Option<Injury>,
    /// Whose vehicle was towed.
    pub towed: OfVehicles,
    /// Whose air bags deployed.
    pub airbags: OfVehicles,
}

/// What could tell harm.
type Measure = (&'static str, fn(&HarmCase) -> Option<f64>);
/// What is reported of it, in levels from 0 for none.
type Outcome = (&'static str, fn(&HarmCase) -> Option<usize>);

const MEASURES: [Measure; 3] = [
    ("computed delta-v", |case| Some(case.delta_v_mps)),
    ("computed delta-v, speeds told", |case| Some(case.delta_v_mps).filter(|_| case.speeds_told)),
    ("speed column of the subject vehicle", |case| case.reported_speed_mps),
];

const OUTCOMES: [Outcome; 4] = [
    ("injury", |case| case.injury.map(|injury| injury as usize)),
    ("a vehicle was towed", |case| case.towed.any().map(usize::from)),
    ("the partner's vehicle was towed", |case| case.towed.cp.map(usize::from)),
    ("air bags deployed", |case| case.airbags.any().map(usize::from)),
];

/// How far computed severity goes with what is reported.
pub fn severity_agreement(cases: &[HarmCase]) -> SeverityAgreement {
    let mut ranks = Vec::new();
    for (outcome, level_of) in OUTCOMES {
        for (measure, value_of) in MEASURES {
            let pairs: Vec<(f64, usize)> =
                cases.iter().filter_map(|case| Some((value_of(case)?, level_of(case)?))).collect();
            let found = Ranks::of(&pairs);
            let seed = SEED.child(outcome).child(measure);
            ranks.push(RankAgreement {
                measure: measure.to_owned(),
                outcome: outcome.to_owned(),
                incidents: pairs.len(),
                harmed: pairs.iter().filter(|(_, level)| *level > 0).count(),
                spearman: found.spearman(seed),
                kendall: found.kendall(seed),
            });
        }
    }
    let by_injury = [Injury::None, Injury::Minor, Injury::Moderate, Injury::Serious, Injury::Fatality];
    SeverityAgreement {
        contacts: cases.len(),
        speeds_told: cases.iter().filter(|case| case.speeds_told).count(),
        ranks,
        by_injury: by_injury.into_iter().filter_map(|injury| level(cases, injury)).collect(),
    }
}

fn level(cases: &[HarmCase], injury: Injury) -> Option<HarmLevel> {
    let of = cases.iter().filter(|case| case.injury == Some(injury));
    let mut values: Vec<f64> = of.map(|case| case.delta_v_mps).collect();
    values.sort_by(f64::total_cmp);
    let (low, high) = (*values.get(values.len().checked_sub(1)? / 2)?, *values.get(values.len() / 2)?);
    Some(HarmLevel {
        injury: serde_json::to_value(injury).ok()?.as_str()?.to_owned(),
        incidents: values.len(),
        median_delta_v_mps: (low + high) / 2.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(delta_v_mps: f64, injury: Option<Injury>, towed: OfVehicles) -> HarmCase {
        HarmCase {
            delta_v_mps,
            speeds_told: delta_v_mps > 2.0,
            reported_speed_mps: None,
            injury,
            towed,
            airbags: OfVehicles::default(),
        }
    }

    #[test]
    fn unknown_harm_is_not_counted_as_none() {
        let (yes, no, unknown) = (
            OfVehicles { sv: None, cp: Some(true) },
            OfVehicles { sv: Some(false), cp: Some(false) },
            OfVehicles { sv: Some(false), cp: None },
        );
        let cases = [
            case(1.0, Some(Injury::None), no),
            case(2.0, None, no),
            case(3.0, Some(Injury::Serious), yes),
            case(9.0, Some(Injury::Minor), unknown),
        ];
        let agreement = severity_agreement(&cases);
        let of = |measure: &str, outcome: &str| {
            let found = agreement.ranks.iter().find(|of| of.measure == measure && of.outcome == outcome).unwrap();
            (found.incidents, found.harmed, found.spearman.map(|rho| rho.value))
        };
        assert_eq!((agreement.contacts, agreement.speeds_told), (4, 2));
        assert_eq!(of("computed delta-v", "injury"), (3, 2, Some(0.5)));
        assert_eq!(of("computed delta-v, speeds told", "injury"), (2, 2, Some(-1.0)));
        let (towed, harmed, rho) = of("computed delta-v", "a vehicle was towed");
        assert_eq!((towed, harmed), (3, 1));
        assert!((rho.unwrap() - 0.75_f64.sqrt()).abs() < 1e-12);
        assert_eq!(of("computed delta-v", "air bags deployed"), (0, 0, None));
        assert_eq!(of("speed column of the subject vehicle", "injury"), (0, 0, None));
        let levels: Vec<(&str, f64)> =
            agreement.by_injury.iter().map(|level| (level.injury.as_str(), level.median_delta_v_mps)).collect();
        assert_eq!(levels, [("none", 1.0), ("minor", 9.0), ("serious", 3.0)]);
    }
}
