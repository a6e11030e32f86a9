//! From which time to collision on a cut-in must be survived (eu2022-1426, Annex III, Part 1, 1.4.2; afgbv2022, Annex 1, Part 2,
//! 10.2.5).

/// Who travels in the vehicle under test: it sets how hard it may brake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Occupants {
    /// All seated and belted.
    Belted,
    /// Some stand or are not belted.
    Standing,
}

impl Occupants {
    /// Braking. [m/s^2]
    fn braking_mps2(self) -> f64 {
        match self {
            Self::Belted => 6.0,
            Self::Standing => 2.4,
        }
    }
}

/// Until braking begins. [s]
const REACTION_TIME_S: f64 = 0.1;
/// How fast braking builds up: 10 m/s^2 within 0.5 s. [m/s^3]
const BUILD_UP_MPS3: f64 = 20.0;

/// The least time to collision, at the moment when the other is 0.3 m into the lane, from which on a vehicle that closes with
/// this speed must not touch it: reaction, half the time in which braking builds up, and braking to equal speed. [s]
pub fn least_time_to_collision_s(closing_mps: f64, occupants: Occupants) -> f64 {
    let braking_mps2 = occupants.braking_mps2();
    closing_mps / (2.0 * braking_mps2) + 0.5 * braking_mps2 / BUILD_UP_MPS3 + REACTION_TIME_S
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_the_regulation() {
        let belted = [0.48, 0.71, 0.94, 1.18, 1.41, 1.64];
        let standing = [0.74, 1.32, 1.90, 2.47, 3.05, 3.63];
        for (occupants, table) in [(Occupants::Belted, belted), (Occupants::Standing, standing)] {
            for (closing_kmh, limit_s) in [10.0, 20.0, 30.0, 40.0, 50.0, 60.0].into_iter().zip(table) {
                let found_s = least_time_to_collision_s(closing_kmh / 3.6, occupants);
                assert_eq!(
                    (found_s * 100.0).round() / 100.0,
                    limit_s,
                    "{occupants:?} at {closing_kmh} km/h: {found_s}"
                );
            }
        }
    }
}
