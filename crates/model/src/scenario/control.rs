//! Control of traffic: signals with a program, stop and yield signs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What controls one way into a junction, or one place on a road. Its stop line lies across the road's end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Control {
    /// The road with direction whose end is controlled, such as `west+`; see [`super::Place`].
    pub at: String,
    /// The stop line lies this far before the road's end, 0 to 200. [m]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 200.0))]
    pub set_back_m: f64,
    /// Lanes it is for, 0 is the leftmost; all of them where none is named.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lanes: Vec<u8>,
    /// What stands there.
    pub device: Device,
}

/// A device that controls traffic.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Device {
    /// A signal: its phases follow each other, over and over.
    Signal {
        /// Phases, at least one, at most 16.
        program: Vec<Phase>,
        /// How long the program has been running when the scenario begins. [s]
        #[serde(default)]
        offset_s: f64,
    },
    /// A stop sign.
    StopSign {},
    /// A yield sign.
    YieldSign {},
}

/// What a signal shows for some time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Phase {
    /// What it shows.
    pub show: Aspect,
    /// For how long, 0.1 to 600. [s]
    #[schemars(range(min = 0.1, max = 600.0))]
    pub for_s: f64,
}

/// What a signal shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Aspect {
    /// Go.
    Green,
    /// Stop where that is still possible.
    Yellow,
    /// Stop.
    Red,
    /// As a stop sign.
    FlashingRed,
    /// Nothing, or a flashing yellow: the rules without a signal hold.
    Dark,
}

impl Aspect {
    /// For sentences.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Green => "green",
            Self::Yellow => "yellow",
            Self::Red => "red",
            Self::FlashingRed => "flashing red",
            Self::Dark => "dark",
        }
    }
}

impl Device {
    /// What a signal shows at a time; `None` for signs. [s]
    pub fn aspect(&self, time_s: f64) -> Option<Aspect> {
        let Self::Signal { program, offset_s } = self else { return None };
        let cycle_s: f64 = program.iter().map(|phase| phase.for_s).sum();
        let mut left_s = time_s + offset_s;
        left_s -= (left_s / cycle_s).floor() * cycle_s;
        for phase in program {
            if left_s < phase.for_s {
                return Some(phase.show);
            }
            left_s -= phase.for_s;
        }
        program.last().map(|phase| phase.show)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_runs_over_and_over_from_its_offset() {
        let phase = |show, for_s| Phase { show, for_s };
        let program = vec![phase(Aspect::Green, 10.0), phase(Aspect::Yellow, 3.0), phase(Aspect::Red, 7.0)];
        let signal = Device::Signal { program, offset_s: 4.0 };
        let shown: Vec<_> = [0.0, 5.9, 6.0, 9.0, 15.9, 16.0, 26.0].map(|t| signal.aspect(t).unwrap()).to_vec();
        use Aspect::{Green, Red, Yellow};
        assert_eq!(shown, [Green, Green, Yellow, Red, Red, Green, Yellow]);
        assert_eq!(Device::StopSign {}.aspect(0.0), None);
    }
}
