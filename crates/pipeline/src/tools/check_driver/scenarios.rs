//! A concrete scenario of a grid as a scenario of the simulators: a straight road of three lanes, cars, partners with plans.

use recrash_drivers::Concrete;
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{
    Approach, Author, EgoSpec, Environment, LateralMove, MapSpec, Partner, Policy, SCENARIO_FORMAT, ScenarioDraft,
    Source, Start, StraightMap, Traffic, Turn,
};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::Scenario;

/// Width of a lane: that of the grids, whose vehicles drive 3.5 m beside each other. [m]
pub const LANE_WIDTH_M: f64 = 3.5;
/// How far the vehicle that cuts out goes aside. [m]
const LEAVES_BY_M: f64 = 4.0;
/// Steady driving before a cut-in begins, so that every ego has settled. [s]
pub const SETTLING_S: f64 = 1.0;
/// Behind a leader an ego begins with the careful driver's time gap. [s]
const TIME_GAP_S: f64 = 2.0;
/// Runs end this long after all is decided, at the latest after the grids' own 35 s. [s]
const AFTERWARDS_S: f64 = 8.0;
const LONGEST_S: f64 = 35.0;
/// More steps than a run has.
const FOR_EVER: u32 = 1000;

/// The vehicles of all roles.
pub fn car() -> VehicleSpec {
    VehicleSpec::of(PartnerKind::PassengerCar)
}

/// The scenario; `None` where the simulators do not go so fast.
pub fn of(concrete: &Concrete) -> Option<Scenario> {
    let length_m = car().length_m;
    let (ego_mps, partners, decided_s) = match *concrete {
        Concrete::CutIn { ego_kmh, other_kmh, gap_m, lateral_mps } => {
            let (ego_mps, other_mps) = (ego_kmh / 3.6, other_kmh / 3.6);
            let ahead_m = gap_m + length_m + (ego_mps - other_mps) * SETTLING_S;
            let mut other = partner("cp1", 1, ahead_m, other_mps, holds(other_mps));
            let mut decided_s = gap_m / (ego_mps - other_mps);
            if lateral_mps > 0.0 {
                let duration_s = LANE_WIDTH_M / lateral_mps;
                other.lateral.push(LateralMove { start_s: SETTLING_S, duration_s, to_t_m: -LANE_WIDTH_M });
                decided_s = decided_s.max(duration_s);
            }
            (ego_mps, vec![other], SETTLING_S + decided_s)
        }
        Concrete::CutOut { speed_kmh, gap_m, lateral_mps } => {
            let speed_mps = speed_kmh / 3.6;
            let ahead_m = TIME_GAP_S * speed_mps + length_m;
            let duration_s = LEAVES_BY_M / lateral_mps;
            let mut leader = partner("cp1", 0, ahead_m, speed_mps, holds(speed_mps));
            leader.lateral.push(LateralMove { start_s: 0.0, duration_s, to_t_m: LEAVES_BY_M });
            let stands = Policy::Stopped { depart_step: None, target_speed_mps: 0.0 };
            let standing = partner("cp2", 0, ahead_m + gap_m + length_m, 0.0, stands);
            (speed_mps, vec![leader, standing], TIME_GAP_S + gap_m / speed_mps)
        }
        Concrete::Following { speed_kmh, deceleration_g } => {
            let speed_mps = speed_kmh / 3.6;
            let deceleration_mps2 = 9.81 * deceleration_g;
            let brakes = Policy::AccelThenBrake {
                accel_mag: -deceleration_mps2 / car().brake_demand_mps2,
                accel_steps: FOR_EVER,
                cruise_speed: 0.0,
                brake_step: FOR_EVER,
                brake_steps: 0,
                speed_kp: None,
            };
            let leader = partner("cp1", 0, TIME_GAP_S * speed_mps + length_m, speed_mps, brakes);
            (speed_mps, vec![leader], TIME_GAP_S + speed_mps / deceleration_mps2)
        }
    };
    let draft = draft(ego_mps, partners, (decided_s + AFTERWARDS_S).min(LONGEST_S));
    recrash_roads::check(draft).ok().map(|checked| checked.value)
}

/// Holds its speed, whatever happens.
fn holds(target_speed: f64) -> Policy {
    Policy::SuddenBrake { target_speed, brake_step: FOR_EVER, brake_steps: 0, speed_kp: None }
}

fn partner(id: &str, lane_offset: i8, delta_s_m: f64, speed_mps: f64, policy: Policy) -> Partner {
    Partner {
        id: id.to_owned(),
        kind: PartnerKind::PassengerCar,
        approach: Approach::Same,
        turn: Turn::Straight,
        lane_offset,
        start: Start::Offset { delta_s_m, delta_t_m: 0.0 },
        speed_mps,
        policy,
        lateral: Vec::new(),
    }
}

fn draft(ego_mps: f64, partners: Vec<Partner>, duration_s: f64) -> ScenarioDraft {
    ScenarioDraft {
        format: SCENARIO_FORMAT.to_owned(),
        id: "check-driver".to_owned(),
        source: Source { author: Author::Rules, ..Source::default() },
        map: MapSpec::S(StraightMap { lanes: 3, lane_width_m: LANE_WIDTH_M, approach_m: 300.0, length_m: 600.0 }),
        ego: EgoSpec { lane: 1, s_m: 10.0, speed_mps: ego_mps, target_speed_mps: ego_mps, ..EgoSpec::default() },
        partners,
        obstacles: Vec::new(),
        traffic: Traffic::default(),
        environment: Environment::default(),
        duration_s,
        ..ScenarioDraft::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_drivers::Grid;

    #[test]
    fn all_that_is_slow_enough_can_be_run() {
        for grid in Grid::ALL {
            for concrete in grid.scenarios().iter().step_by(97) {
                let fastest_kmh = match *concrete {
                    Concrete::CutIn { ego_kmh, .. } => ego_kmh,
                    Concrete::CutOut { speed_kmh, .. } | Concrete::Following { speed_kmh, .. } => speed_kmh,
                };
                assert_eq!(of(concrete).is_some(), fastest_kmh <= 80.0, "{concrete:?}");
            }
        }
    }
}
