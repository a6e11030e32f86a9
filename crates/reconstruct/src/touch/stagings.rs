//! All ways of touching, the best first.

use crate::ground::drawn::ground_for;
use crate::told::crash::Told;
use crate::touch::bodies::bodies;
use crate::touch::staging::Staging;
use crate::touch::{doors, roadside};
use recrash_model::math;
use std::rc::Rc;

/// Ways of touching, the best first.
pub(crate) fn stagings(told: &Told) -> Vec<Staging> {
    let ground = Rc::new(ground_for(told));
    let by_part = told.door.is_some() || told.gate_swings;
    let mut found = match told.edge {
        _ if by_part => doors::stagings(told, &ground),
        Some(side) => roadside::stagings(told, &ground, side),
        None => bodies(told, &ground),
    };
    found.sort_by_key(|staging| staging.cost);
    // Of those that are almost the same, one.
    let mut kept: Vec<Staging> = Vec::new();
    for staging in found {
        let like = |other: &Staging| {
            other.cp.position.distance(staging.cp.position) < 0.25
                && math::wrap_angle(other.cp.heading - staging.cp.heading).abs() < 0.04
                && (other.sv_s_m - staging.sv_s_m).abs() < 0.5
                && other.bend.is_some() == staging.bend.is_some()
        };
        if kept.len() < MOST_TRIES && !kept.iter().any(like) {
            kept.push(staging);
        }
    }
    kept
}

/// So many ways of touching are tried of one telling, where none of the first of all shows every told fact.
pub(crate) const MOST_TRIES: usize = 400;
