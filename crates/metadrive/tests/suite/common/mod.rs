//! Scenarios for tests.

use recrash_roads::{Scenario, check, read_draft};
use serde_json::{Value, json};

/// A draft on X with a partner from the left that meets the ego.
pub fn crossing() -> Value {
    json!({
        "format": "recrash.scenario/1",
        "id": "crossing",
        "source": {"author": "person"},
        "map": {"type": "X", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "arm_m": 60.0},
        "ego": {"turn": "straight", "lane": 1, "s_m": 5.0, "speed_mps": 8.0, "target_speed_mps": 8.0},
        "partners": [{
            "id": "cp1", "kind": "passenger_car", "approach": "left", "turn": "straight", "lane_offset": 0,
            "start": {"arrival_gap_s": 0.0}, "speed_mps": 8.0,
            "policy": {"type": "sudden_brake", "target_speed": 8.0, "brake_step": 9000, "brake_steps": 0}
        }],
        "obstacles": [],
        "duration_s": 20.0
    })
}

/// A draft, checked.
#[track_caller]
pub fn checked(draft: &Value) -> Scenario {
    let draft = read_draft(&draft.to_string()).unwrap_or_else(|problems| panic!("{problems:#?}"));
    check(draft.value).unwrap_or_else(|problems| panic!("{problems:#?}")).value
}
