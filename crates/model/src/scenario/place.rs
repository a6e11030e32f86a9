//! Places: on a lane, or anywhere in the plane.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where the centre of something is, and which way it faces: one of three forms.
///
/// Roads are named by id and direction: `main+` is driven the way `main` was drawn, `main-` the other way. A strip beside
/// the driving lanes is named after a dot: `main+.parking`, `main-.bike`, `main+.sidewalk`. On the paper's blocks the roads
/// are `ego+` (towards the block) and `ego-`, `right+` (away from the block) and `right-`, `ahead±`, `left±`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "RawPlace", into = "RawPlace")]
#[schemars(with = "RawPlace")]
pub enum Place {
    /// On a lane, or beside it.
    Lane {
        /// Road with direction.
        road: String,
        /// Lane of that road and direction, 0 is the leftmost.
        lane: u8,
        /// Along the lane.
        along: Along,
        /// To the right of the lane's centre line. [m]
        t_m: f64,
        /// Facing, to the left of the lane's direction; 180 faces against it. [deg]
        heading_deg: f64,
    },
    /// In the plane.
    Plane {
        /// [m]
        x_m: f64,
        /// [m]
        y_m: f64,
        /// Anticlockwise from +x. [deg]
        heading_deg: f64,
    },
}

/// A distance along a lane, counted from one of its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Along {
    /// From the beginning. [m]
    FromStart(f64),
    /// Before the end. [m]
    BeforeEnd(f64),
}

impl Place {
    /// On lane 0 of a road, `s_m` from its beginning, in its middle, facing along it.
    pub fn on(road: &str, s_m: f64) -> Self {
        Self::Lane { road: road.to_owned(), lane: 0, along: Along::FromStart(s_m), t_m: 0.0, heading_deg: 0.0 }
    }

    /// In the plane. [m, m, deg]
    pub const fn at(x_m: f64, y_m: f64, heading_deg: f64) -> Self {
        Self::Plane { x_m, y_m, heading_deg }
    }
}

#[derive(Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RawPlace {
    /// Road with direction, such as `main+` or `main+.parking`; with `s_m` or `to_end_m`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    road: Option<String>,
    /// Lane, 0 is the leftmost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lane: Option<u8>,
    /// From the beginning of the road. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -200.0, max = 2000.0))]
    s_m: Option<f64>,
    /// Before the end of the road. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -200.0, max = 2000.0))]
    to_end_m: Option<f64>,
    /// To the right of the lane's centre. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -50.0, max = 50.0))]
    t_m: Option<f64>,
    /// In the plane; with `y_m`. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -2000.0, max = 2000.0))]
    x_m: Option<f64>,
    /// In the plane. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -2000.0, max = 2000.0))]
    y_m: Option<f64>,
    /// Facing: to the left of the lane's direction, or of +x. [deg]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -360.0, max = 360.0))]
    heading_deg: Option<f64>,
}

impl TryFrom<RawPlace> for Place {
    type Error = String;

    fn try_from(raw: RawPlace) -> Result<Self, String> {
        let heading_deg = raw.heading_deg.unwrap_or(0.0);
        let along = match (raw.s_m, raw.to_end_m) {
            (Some(s_m), None) => Some(Along::FromStart(s_m)),
            (None, Some(to_end_m)) => Some(Along::BeforeEnd(to_end_m)),
            _ => None,
        };
        match (raw.road, along, raw.x_m, raw.y_m) {
            (Some(road), Some(along), None, None) => {
                let (lane, t_m) = (raw.lane.unwrap_or(0), raw.t_m.unwrap_or(0.0));
                Ok(Self::Lane { road, lane, along, t_m, heading_deg })
            }
            (None, None, Some(x_m), Some(y_m)) if raw.lane.is_none() && raw.t_m.is_none() && raw.s_m.is_none() => {
                Ok(Self::Plane { x_m, y_m, heading_deg })
            }
            _ => Err("a place is {\"road\", \"s_m\"} or {\"road\", \"to_end_m\"}, each with \"lane\", \"t_m\" and \
                      \"heading_deg\" where wanted; or {\"x_m\", \"y_m\", \"heading_deg\"}"
                .to_owned()),
        }
    }
}

impl From<Place> for RawPlace {
    fn from(place: Place) -> Self {
        let unless_zero = |value: f64| (value != 0.0).then_some(value);
        match place {
            Place::Lane { road, lane, along, t_m, heading_deg } => {
                let (s_m, to_end_m) = match along {
                    Along::FromStart(s_m) => (Some(s_m), None),
                    Along::BeforeEnd(to_end_m) => (None, Some(to_end_m)),
                };
                Self {
                    road: Some(road),
                    lane: (lane != 0).then_some(lane),
                    s_m,
                    to_end_m,
                    t_m: unless_zero(t_m),
                    heading_deg: unless_zero(heading_deg),
                    ..Self::default()
                }
            }
            Place::Plane { x_m, y_m, heading_deg } => {
                Self { x_m: Some(x_m), y_m: Some(y_m), heading_deg: unless_zero(heading_deg), ..Self::default() }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn each_form_is_read_as_it_was_written() {
        let forms = [
            json!({ "road": "main+", "s_m": 10.0 }),
            json!({ "road": "main-.bike", "lane": 1, "to_end_m": 3.0, "t_m": -0.5, "heading_deg": 180.0 }),
            json!({ "x_m": 1.0, "y_m": -2.0, "heading_deg": 90.0 }),
        ];
        for form in forms {
            let place: Place = serde_json::from_value(form.clone()).unwrap();
            assert_eq!(serde_json::to_value(&place).unwrap(), form);
        }
    }

    #[test]
    fn half_a_form_and_two_forms_are_refused() {
        for form in [
            json!({ "road": "main+" }),
            json!({ "road": "main+", "s_m": 1.0, "to_end_m": 2.0 }),
            json!({ "road": "main+", "s_m": 1.0, "x_m": 2.0 }),
            json!({ "x_m": 1.0 }),
        ] {
            assert!(serde_json::from_value::<Place>(form.clone()).is_err(), "{form}");
        }
    }
}
