//! The least time to collision that a driver survives in a cut-in, beside the limits of EU 2022/1426.

use super::{Verdict, run, scenarios};
use crate::error::PipelineError;
use crate::simulators::Simulator;
use rayon::prelude::*;
use recrash_drivers::{Concrete, Occupants, ReferenceDriver, WIDTH_M, drive, least_time_to_collision_s};
use serde::Serialize;

/// Closing speeds of the regulation's table. [km/h]
const CLOSING_KMH: [f64; 6] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0];
/// Speed of the vehicle under test: nearly as fast as the simulators go. [km/h]
const EGO_KMH: f64 = 70.0;
/// How fast the other comes in. [m/s]
const LATERAL_MPS: f64 = 1.0;
/// How far it is in the lane when time to collision counts. [m]
const INTRUSION_M: f64 = 0.3;
/// Longest time to collision that is tried, how far down from there at a time, and how finely in the end. [s]
const LONGEST_S: f64 = 8.0;
const COARSE_S: f64 = 0.25;
const FINE_S: f64 = 0.01;

/// One closing speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitCheck {
    /// Closing speed. [km/h]
    pub closing_kmh: f64,
    /// From this time to collision on nobody may be touched. [s]
    pub belted_s: f64,
    /// The same where occupants stand or are not belted. [s]
    pub standing_s: f64,
    /// From where on each driver touches nobody.
    pub survived: Vec<Survived>,
}

/// One driver at one closing speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Survived {
    /// Driver.
    pub driver: String,
    /// From this time to collision on it touches nobody; absent where it crashes at 8 s. [s]
    pub from_s: Option<f64>,
    /// Whether it touches nobody from the regulation's limit on.
    pub keeps_belted: bool,
    /// The same for the limit with standing or unbelted occupants.
    pub keeps_standing: bool,
}

/// Every driver at every closing speed.
pub fn check(simulator: Option<&dyn Simulator>) -> Result<Vec<LimitCheck>, PipelineError> {
    CLOSING_KMH.par_iter().map(|&closing_kmh| at(closing_kmh, simulator)).collect()
}

fn at(closing_kmh: f64, simulator: Option<&dyn Simulator>) -> Result<LimitCheck, PipelineError> {
    let limit_s = |occupants| least_time_to_collision_s(closing_kmh / 3.6, occupants);
    let (belted_s, standing_s) = (limit_s(Occupants::Belted), limit_s(Occupants::Standing));
    let of = |driver: &str, from_s: Option<f64>| {
        // The search knows hundredths.
        let keeps = |limit_s: f64| from_s.is_some_and(|from_s| from_s <= limit_s + 0.5 * FINE_S);
        Survived { driver: driver.to_owned(), from_s, keeps_belted: keeps(belted_s), keeps_standing: keeps(standing_s) }
    };
    let mut survived = Vec::new();
    for driver in ReferenceDriver::ALL {
        let from_s = least(|time_s| Ok(drive(&cut_in(closing_kmh, time_s, WIDTH_M), driver).is_none()))?;
        survived.push(of(driver.name(), from_s));
    }
    if let Some(simulator) = simulator {
        let width_m = scenarios::car().width_m;
        let from_s = least(|time_s| Ok(run(simulator, &cut_in(closing_kmh, time_s, width_m))? == Verdict::Avoided))?;
        survived.push(of(simulator.ego(), from_s));
    }
    Ok(LimitCheck { closing_kmh, belted_s, standing_s, survived })
}

/// The cut-in in which time to collision is this when the other is so far in the lane, if nobody has reacted by then.
fn cut_in(closing_kmh: f64, time_to_collision_s: f64, width_m: f64) -> Concrete {
    let gap_to_marking_m = 0.5 * (scenarios::LANE_WIDTH_M - width_m);
    let drifts_s = (gap_to_marking_m + INTRUSION_M) / LATERAL_MPS;
    let gap_m = closing_kmh / 3.6 * (time_to_collision_s + drifts_s);
    Concrete::CutIn { ego_kmh: EGO_KMH, other_kmh: EGO_KMH - closing_kmh, gap_m, lateral_mps: LATERAL_MPS }
}

/// The least time from which on it holds: down from the longest until it fails, then by halving.
fn least(mut holds: impl FnMut(f64) -> Result<bool, PipelineError>) -> Result<Option<f64>, PipelineError> {
    let time_s = |number: u32| f64::from(number) * FINE_S;
    let coarse = (COARSE_S / FINE_S) as u32;
    let mut fails = (LONGEST_S / FINE_S) as u32;
    while fails > 0 && holds(time_s(fails))? {
        fails -= coarse;
    }
    let mut held = fails + coarse;
    if time_s(held) > LONGEST_S {
        return Ok(None);
    }
    while held - fails > 1 {
        let middle = fails + (held - fails) / 2;
        if holds(time_s(middle))? {
            held = middle;
        } else {
            fails = middle;
        }
    }
    Ok(Some(time_s(held)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_holds_from_there_on() {
        assert_eq!(least(|time_s| Ok(time_s >= 1.235)).expect("no error"), Some(1.24));
        assert_eq!(least(|time_s| Ok((0.2..0.8).contains(&time_s) || time_s >= 1.8)).expect("no error"), Some(1.8));
        assert_eq!(least(|_| Ok(true)).expect("no error"), Some(0.01));
        assert_eq!(least(|_| Ok(false)).expect("no error"), None);
    }
}
