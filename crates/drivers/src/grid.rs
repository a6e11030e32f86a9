//! The four published grids of concrete scenarios (mattas2022).

use crate::driver::ReferenceDriver;

/// One scenario with all its numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Concrete {
    /// A slower vehicle comes in from the lane beside.
    CutIn {
        /// Of the vehicle under test, at the start. [km/h]
        ego_kmh: f64,
        /// Of the one that cuts in, throughout. [km/h]
        other_kmh: f64,
        /// Bumper to bumper, when the other has reached its lateral speed. [m]
        gap_m: f64,
        /// How fast it comes in. [m/s]
        lateral_mps: f64,
    },
    /// The vehicle ahead leaves the lane, and one stands there.
    CutOut {
        /// Of the vehicle under test and of the one ahead. [km/h]
        speed_kmh: f64,
        /// From the one ahead to the one that stands, when the former begins to leave. [m]
        gap_m: f64,
        /// How fast the one ahead leaves. [m/s]
        lateral_mps: f64,
    },
    /// The vehicle ahead brakes until it stands.
    Following {
        /// Of both at the start. [km/h]
        speed_kmh: f64,
        /// Of the one ahead, from the start and without any jerk. [g]
        deceleration_g: f64,
    },
}

/// One grid of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Grid {
    /// Cut-ins before a vehicle of 70 to 130 km/h.
    CutInFast,
    /// Cut-ins before a vehicle of 20 to 60 km/h.
    CutInSlow,
    /// Cut-outs at 10 to 130 km/h.
    CutOut,
    /// Braking leaders at 12 to 128 km/h.
    Following,
}

impl Grid {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::CutInFast, Self::CutInSlow, Self::CutOut, Self::Following];

    /// Name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::CutInFast => "cut-in-fast",
            Self::CutInSlow => "cut-in-slow",
            Self::CutOut => "cut-out",
            Self::Following => "following",
        }
    }

    /// The drivers whose sources cover it.
    pub fn drivers(self) -> impl Iterator<Item = ReferenceDriver> {
        let cut_in = matches!(self, Self::CutInFast | Self::CutInSlow);
        ReferenceDriver::ALL.into_iter().filter(move |&driver| cut_in || driver != ReferenceDriver::Regulation)
    }

    /// Its scenarios, in the order of the publication.
    pub fn scenarios(self) -> Vec<Concrete> {
        match self {
            Self::CutInFast => cut_ins(&[70, 90, 110, 130], 30, &evenly(1.0, 2.0, 60)),
            Self::CutInSlow => cut_ins(&[20, 30, 40, 50, 60], 10, &evenly(1.0, 1.0, 59)),
            Self::CutOut => cut_outs(),
            Self::Following => followings(),
        }
    }
}

/// `count` numbers from `start` on, with the bits of NumPy's `arange`: its step is that between its first two numbers.
fn evenly(start: f64, step: f64, count: u32) -> Vec<f64> {
    let between = (start + step) - start;
    (0..count).map(|number| start + f64::from(number) * between).collect()
}

fn cut_ins(ego_kmh: &[u32], other_step_kmh: usize, gaps_m: &[f64]) -> Vec<Concrete> {
    let lateral_mps = evenly(0.0, 0.1, 18);
    let mut scenarios = Vec::new();
    for &ego_kmh in ego_kmh {
        for other_kmh in (10..ego_kmh).step_by(other_step_kmh) {
            for &gap_m in gaps_m {
                scenarios.extend(lateral_mps.iter().map(|&lateral_mps| Concrete::CutIn {
                    ego_kmh: f64::from(ego_kmh),
                    other_kmh: f64::from(other_kmh),
                    gap_m,
                    lateral_mps,
                }));
            }
        }
    }
    scenarios
}

fn cut_outs() -> Vec<Concrete> {
    let lateral_mps = evenly(0.1, 0.2, 15);
    let mut scenarios = Vec::new();
    for speed_kmh in evenly(10.0, 10.0, 13) {
        for gap_m in evenly(2.0, 5.0, 30) {
            scenarios.extend(lateral_mps.iter().map(|&lateral_mps| Concrete::CutOut { speed_kmh, gap_m, lateral_mps }));
        }
    }
    scenarios
}

fn followings() -> Vec<Concrete> {
    let speeds_kmh = evenly(12.0, 2.0, 59);
    evenly(0.05, 0.05, 19)
        .into_iter()
        .flat_map(|deceleration_g| {
            speeds_kmh.iter().map(move |&speed_kmh| Concrete::Following { speed_kmh, deceleration_g })
        })
        .collect()
}
