//! What approaches, turns and maps are called, in a scenario file and in messages.

use recrash_model::scenario::{Approach, MapSpec, Turn};

/// Every approach and its name in a scenario file.
pub(super) const APPROACHES: [(Approach, &str); 5] = [
    (Approach::Same, "same"),
    (Approach::Opposite, "opposite"),
    (Approach::Left, "left"),
    (Approach::Right, "right"),
    (Approach::Ring, "ring"),
];

/// Every turn and its name in a scenario file.
pub(super) const TURNS: [(Turn, &str); 3] =
    [(Turn::Straight, "straight"), (Turn::Left, "left"), (Turn::Right, "right")];

/// The name of an approach in a scenario file.
pub(super) fn approach_name(approach: Approach) -> &'static str {
    APPROACHES.iter().find(|(each, _)| *each == approach).map_or("", |(_, name)| name)
}

/// The name of a turn in a scenario file.
pub(super) fn turn_name(turn: Turn) -> &'static str {
    TURNS.iter().find(|(each, _)| *each == turn).map_or("", |(_, name)| name)
}

/// The name of a map in a message.
pub(super) fn map_name(map: &MapSpec) -> &'static str {
    match map {
        MapSpec::S(_) => "a straight road (map S)",
        MapSpec::C(_) => "a curve (map C)",
        MapSpec::X(_) => "a four-way intersection (map X)",
        MapSpec::T(_) => "this three-way intersection (map T)",
        MapSpec::O(_) => "a roundabout (map O)",
        MapSpec::G(_) => "a network of roads (map G)",
    }
}
