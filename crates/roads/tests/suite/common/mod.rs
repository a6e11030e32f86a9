//! Maps for tests.

use recrash_model::narrative::Side;
use recrash_model::scenario::{CrossMap, CurveMap, MapSpec, MissingArm, RoundaboutMap, StraightMap, TeeMap};

/// S with an approach of 60 m and 80 m behind it.
pub fn straight(lanes: u8) -> MapSpec {
    MapSpec::S(StraightMap { lanes, lane_width_m: 3.5, approach_m: 60.0, length_m: 80.0 })
}

/// C of radius 50 m and 90 degrees.
pub fn curve(lanes: u8, direction: Side) -> MapSpec {
    MapSpec::C(CurveMap {
        lanes,
        lane_width_m: 3.5,
        approach_m: 60.0,
        radius_m: 50.0,
        angle_deg: 90.0,
        direction,
        length_m: 40.0,
    })
}

/// X with arms of 60 m.
pub fn cross(lanes: u8) -> MapSpec {
    MapSpec::X(CrossMap { lanes, lane_width_m: 3.5, approach_m: 60.0, arm_m: 60.0 })
}

/// T with arms of 60 m.
pub fn tee(lanes: u8, missing: MissingArm) -> MapSpec {
    MapSpec::T(TeeMap { lanes, lane_width_m: 3.5, approach_m: 60.0, arm_m: 60.0, missing })
}

/// O with exits of radius 10 m and an inner radius of 30 m.
pub fn roundabout(lanes: u8) -> MapSpec {
    MapSpec::O(RoundaboutMap {
        lanes,
        lane_width_m: 3.5,
        approach_m: 60.0,
        arm_m: 60.0,
        exit_radius_m: 10.0,
        inner_radius_m: 30.0,
    })
}
