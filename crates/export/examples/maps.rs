//! Writes one map of each type into a folder.
use recrash_model::scenario::MapSpec;
use recrash_roads::RoadNetwork;
fn main() {
    let folder = std::env::args().nth(1).expect("a folder");
    for (name, json) in [
        ("s", r#"{"type":"S","lanes":3,"lane_width_m":3.5,"approach_m":60,"length_m":200}"#),
        (
            "c",
            r#"{"type":"C","lanes":2,"lane_width_m":3.5,"approach_m":60,"radius_m":50,"angle_deg":90,"direction":"left","length_m":60}"#,
        ),
        (
            "cr",
            r#"{"type":"C","lanes":2,"lane_width_m":3.7,"approach_m":60,"radius_m":50,"angle_deg":75,"direction":"right","length_m":60}"#,
        ),
        ("x", r#"{"type":"X","lanes":2,"lane_width_m":3.5,"approach_m":60,"arm_m":60}"#),
        ("x1", r#"{"type":"X","lanes":1,"lane_width_m":3.5,"approach_m":60,"arm_m":60}"#),
        ("t", r#"{"type":"T","lanes":2,"lane_width_m":3.5,"approach_m":60,"arm_m":60,"missing":"left"}"#),
        (
            "o",
            r#"{"type":"O","lanes":2,"lane_width_m":3.5,"approach_m":60,"arm_m":60,"exit_radius_m":10,"inner_radius_m":30}"#,
        ),
    ] {
        let map: MapSpec = serde_json::from_str(json).expect(name);
        let network = RoadNetwork::build(&map);
        std::fs::write(format!("{folder}/{name}.xodr"), recrash_export::opendrive_document(&network, name))
            .expect("written");
    }
}
