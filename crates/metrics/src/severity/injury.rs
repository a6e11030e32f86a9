//! Published risk curves. A curve that does not cover a contact says nothing.

use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::record::MPS_PER_MPH;
use recrash_model::severity::{InjuryOutcome, InjuryRisk, RiskCurve};
use recrash_model::zones::ContactZone;

const KMH_PER_MPS: f64 = 3.6;

/// One side of a contact, as the curves ask for it.
#[derive(Debug, Clone, Copy)]
pub struct Struck {
    pub kind: PartnerKind,
    pub zone: ContactZone,
    /// [m/s]
    pub speed_mps: f64,
}

/// Both sides.
#[derive(Debug, Clone, Copy)]
pub struct Pair {
    /// [m/s]
    pub closing_speed_mps: f64,
    pub struck: [Struck; 2],
}

/// Risks to one side, worst outcome last within a curve.
pub fn risks(pair: &Pair, side: usize, delta_v_mps: f64, force_clock: Option<u8>) -> Vec<InjuryRisk> {
    let (own, other) = (pair.struck[side], pair.struck[1 - side]);
    let mut risks = occupants(own.kind, delta_v_mps, force_clock);
    risks.extend(pedestrian(own.kind, other));
    risks.extend(met_by_a_front(own, other, pair.closing_speed_mps));
    risks
}

/// The logistic function.
fn logistic(z: f64) -> f64 {
    1.0 / (1.0 + math::exp(-z))
}

/// A passenger vehicle, from car to pickup.
fn is_light_vehicle(kind: PartnerKind) -> bool {
    use PartnerKind::{FirstResponder, PassengerCar, PickupTruck, Suv, Van};
    matches!(kind, PassengerCar | Suv | Van | PickupTruck | FirstResponder)
}

const BY_DELTA_V: [InjuryOutcome; 6] = {
    use InjuryOutcome::{Fatal, Mais1, Mais2, Mais3, Mais4, Mais5};
    [Mais1, Mais2, Mais3, Mais4, Mais5, Fatal]
};

/// Intercept and slope per mph of delta-v, by outcome, force from the front (wang2022).
const FRONTAL: [(f64, f64); 6] =
    [(-1.4930, 0.0854), (-4.9429, 0.1425), (-6.9774, 0.1620), (-8.4254, 0.1586), (-8.8355, 0.1566), (-9.0422, 0.1571)];

/// The same, force from behind (wang2022).
const REAR: [(f64, f64); 6] = [
    (-1.8199, 0.0671),
    (-6.1818, 0.1482),
    (-8.0329, 0.1793),
    (-11.8787, 0.2210),
    (-12.1944, 0.2276),
    (-12.1982, 0.2255),
];

/// Below, hardly any vehicle is towed, and the sample holds towed ones; above, we know of no point of the curves. Assumed. [mph]
const DELTA_V_MPH: std::ops::RangeInclusive<f64> = 5.0..=55.0;

/// Occupants by delta-v, where the force comes from the front or from behind.
fn occupants(kind: PartnerKind, delta_v_mps: f64, force_clock: Option<u8>) -> Vec<InjuryRisk> {
    let delta_v_mph = delta_v_mps / MPS_PER_MPH;
    let coefficients = match force_clock {
        Some(11 | 12 | 1) => FRONTAL,
        Some(5..=7) => REAR,
        _ => return Vec::new(),
    };
    if !is_light_vehicle(kind) || !DELTA_V_MPH.contains(&delta_v_mph) {
        return Vec::new();
    }
    let risk = |(outcome, (intercept, slope)): (InjuryOutcome, (f64, f64))| InjuryRisk {
        outcome,
        probability: logistic(intercept + slope * delta_v_mph),
        curve: RiskCurve::Wang2022,
    };
    BY_DELTA_V.into_iter().zip(coefficients).map(risk).collect()
}

/// The risks at which a speed is published (tefft2013).
const PUBLISHED_RISKS: [f64; 5] = [0.10, 0.25, 0.50, 0.75, 0.90];
/// Speeds of the striking vehicle at which the average risk of an injury of AIS 4 or more is as above. [mph]
const SEVERE_MPH: [f64; 5] = [17.1, 24.9, 33.0, 40.8, 48.1];
/// The same for death. [mph]
const DEATH_MPH: [f64; 5] = [24.1, 32.5, 40.6, 48.0, 54.6];

/// A pedestrian whom a light vehicle strikes with its front.
fn pedestrian(kind: PartnerKind, other: Struck) -> Vec<InjuryRisk> {
    if kind != PartnerKind::Pedestrian || !is_light_vehicle(other.kind) || !other.zone.is_front() {
        return Vec::new();
    }
    let speed_mph = other.speed_mps / MPS_PER_MPH;
    [(InjuryOutcome::Mais4, SEVERE_MPH), (InjuryOutcome::Fatal, DEATH_MPH)]
        .into_iter()
        .filter_map(|(outcome, speeds)| {
            let probability = between_published(speeds, speed_mph)?;
            Some(InjuryRisk { outcome, probability, curve: RiskCurve::Tefft2013 })
        })
        .collect()
}

/// Straight in the logarithm of the odds between published points; `None` outside of them.
fn between_published(speeds_mph: [f64; 5], speed_mph: f64) -> Option<f64> {
    let after = (1..5).find(|&point| speed_mph <= speeds_mph[point]).filter(|_| speed_mph >= speeds_mph[0])?;
    let log_odds = |point: usize| math::ln(PUBLISHED_RISKS[point] / (1.0 - PUBLISHED_RISKS[point]));
    let share = (speed_mph - speeds_mph[after - 1]) / (speeds_mph[after] - speeds_mph[after - 1]);
    Some(logistic(log_odds(after - 1) + share * (log_odds(after) - log_odds(after - 1))))
}

/// Intercept, slope per km/h of closing speed, slope per year of age, the age that is asked about, and the closing speed up to
/// which we ask [km/h] (lubbe2022; ages are the medians of its samples, that of motorcyclists assumed, limits assumed).
struct MetByAFront {
    intercept: f64,
    per_kmh: f64,
    per_year: f64,
    age_years: f64,
    up_to_kmh: f64,
}

/// Somebody who meets the front of a car or SUV: at least seriously hurt, or dead.
fn met_by_a_front(own: Struck, other: Struck, closing_speed_mps: f64) -> Option<InjuryRisk> {
    let is_car = |kind| matches!(kind, PartnerKind::PassengerCar | PartnerKind::Suv);
    if !is_car(other.kind) || !other.zone.is_front() {
        return None;
    }
    let curve = |intercept, per_kmh, per_year, age_years, up_to_kmh| MetByAFront {
        intercept,
        per_kmh,
        per_year,
        age_years,
        up_to_kmh,
    };
    let curve = match own.kind {
        PartnerKind::Pedestrian => curve(-6.190, 0.078, 0.038, 46.0, 100.0),
        PartnerKind::Cyclist => curve(-7.467, 0.079, 0.047, 39.0, 100.0),
        PartnerKind::Motorcycle => curve(-4.555, 0.040, 0.011, 40.0, 150.0),
        kind if is_car(kind) && own.zone.is_front() => curve(-7.654, 0.041, 0.021, 39.0, 150.0),
        _ => return None,
    };
    let closing_kmh = closing_speed_mps * KMH_PER_MPS;
    (closing_kmh <= curve.up_to_kmh).then(|| InjuryRisk {
        outcome: InjuryOutcome::Mais3,
        probability: logistic(curve.intercept + curve.per_kmh * closing_kmh + curve.per_year * curve.age_years),
        curve: RiskCurve::Lubbe2022,
    })
}
