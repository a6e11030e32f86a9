//! Surface, light and weather, of records and of scenarios.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Condition of the road surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Surface {
    /// Dry.
    #[default]
    Dry,
    /// Wet.
    Wet,
    /// Snow, slush or ice.
    SnowIce,
}

impl Surface {
    /// Friction relative to a dry road. Assumed: textbook ratios of locked-wheel friction at town speeds are 0.6 to 0.8
    /// for wet asphalt and 0.2 to 0.4 for packed snow (wong2008).
    pub const fn relative_friction(self) -> f64 {
        match self {
            Self::Dry => 1.0,
            Self::Wet => 0.7,
            Self::SnowIce => 0.3,
        }
    }
}

/// Light at the time of the crash.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Lighting {
    /// `Daylight`.
    #[default]
    Daylight,
    /// `Dawn / Dusk`.
    DawnDusk,
    /// `Dark - Lighted`.
    DarkLighted,
    /// `Dark - Not Lighted`.
    DarkNotLighted,
    /// `Dark - Unknown Lighting`.
    DarkUnknown,
}

/// Weather; a record may name several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Weather {
    /// Clear.
    #[default]
    Clear,
    /// Cloudy or partly cloudy.
    Cloudy,
    /// Rain.
    Rain,
    /// Snow.
    Snow,
    /// Fog, smoke or haze.
    Fog,
    /// Severe wind, hurricane or dust storm.
    SevereWind,
    /// Indoors.
    Indoor,
}
