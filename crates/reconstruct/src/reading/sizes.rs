//! Sizes by the words for a machine, where its kind says too little.

use recrash_model::account::{Kind, Party, Source};
use recrash_model::scenario::Size;

/// Length and width by words for machines; usual ones, assumed. [m]
const MACHINES_M: [(&[&str], f64, f64); 5] = [
    (&["skid", "bobcat"], 3.4, 1.8),
    (&["roller"], 4.5, 2.0),
    (&["lift"], 3.0, 1.8),
    (&["excavator", "loader", "backhoe", "bulldozer"], 7.0, 2.5),
    (&["truck", "mixer", "crane"], 8.5, 2.5),
];

/// The size of a machine whose words tell which it is.
pub(super) fn told(party: &Party, kind: Kind) -> Option<Size> {
    let text = match &party.kind.as_ref()?.source {
        Source::Words { text, .. } if kind == Kind::ConstructionVehicle => text.to_lowercase(),
        _ => return None,
    };
    let named = MACHINES_M.iter().find(|(names, ..)| names.iter().any(|name| text.contains(name)));
    named.map(|&(_, length_m, width_m)| Size { length_m, width_m })
}
