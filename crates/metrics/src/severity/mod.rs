//! Severity of a contact, with a road user or with an obstacle: plane impact of two boxes by momentum, and the risk of injury by
//! published curves.
//!
//! Formulas, masses, sources and where they are valid: `docs/models/severity.md`.

mod injury;

use crate::contact::contact_geometry;
use injury::Struck;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::metrics::Metrics;
use recrash_model::rollout::{ActorState, ActorTrack, EventKind, PlacedObstacle, Rollout};
pub use recrash_model::severity::Impact;
use recrash_model::severity::{Severity, Suffered};

/// One of the two at the time of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Party {
    /// Kind.
    pub kind: PartnerKind,
    /// Mass; `None` for what stands firm. [kg]
    pub mass_kg: Option<f64>,
    /// Its box.
    pub outline: OrientedBox,
    /// Velocity of its centre over ground. [m/s]
    pub velocity: Vec2,
}

impl Party {
    fn of(track: &ActorTrack, state: &ActorState) -> Self {
        let outline = OrientedBox::new(state.pose(), track.length_m, track.width_m);
        Self { kind: track.kind, mass_kg: track.mass_kg(), outline, velocity: state.velocity() }
    }

    /// An obstacle, which stands. What stands firm has no share in the yielding of brach1983, as if its mass were infinite.
    fn standing(obstacle: &PlacedObstacle) -> Self {
        let mass_kg = obstacle.kind.mass_kg();
        Self { kind: PartnerKind::FixedObject, mass_kg, outline: obstacle.outline(), velocity: Vec2::default() }
    }
}

/// Severity of the ego's first contact with a road user; where it touches none, of its first with an obstacle that stands up, among
/// those that were measured (none before the handover). `None` where there is neither.
pub fn severity_of(rollout: &Rollout, metrics: &Metrics) -> Option<Severity> {
    let ego = rollout.actors.first()?;
    if let Some((actor, _, state, other)) = rollout.first_ego_contact() {
        let second = rollout.actors.get(actor)?;
        return Some(severity(&Party::of(ego, &state), &Party::of(second, &other), Impact::default()));
    }
    metrics.obstacles_hit.iter().find_map(|&hit| {
        let thing = rollout.obstacles.get(hit).filter(|thing| thing.kind.stands_up())?;
        let state = rollout.events.iter().find_map(|event| match event.kind {
            EventKind::ObstacleContact { actor: 0, obstacle, state } if obstacle == hit => Some(state),
            _ => None,
        })?;
        let found = severity(&Party::of(ego, &state), &Party::standing(thing), Impact::default());
        Some(Severity { obstacle: Some(thing.kind), nobody: None, ..found })
    })
}

/// Severity of a contact.
pub fn severity(first: &Party, second: &Party, impact: Impact) -> Severity {
    let relative = first.velocity - second.velocity;
    let normal = first.outline.contact_normal(&second.outline, relative);
    let geometry = contact_geometry(&first.outline, first.velocity, &second.outline, second.velocity);
    let impulse = impulse(first, second, normal, geometry.point, impact);
    let pair = injury::Pair {
        closing_speed_mps: relative.length(),
        struck: [
            Struck { kind: first.kind, zone: geometry.ego_zone, speed_mps: first.velocity.length() },
            Struck { kind: second.kind, zone: geometry.other_zone, speed_mps: second.velocity.length() },
        ],
    };
    Severity {
        closing_speed_mps: pair.closing_speed_mps,
        normal_speed_mps: relative.dot(normal).max(0.0),
        overlap: overlap(&first.outline, &second.outline, normal.left()),
        first: suffered(first, -impulse, &pair, 0),
        second: suffered(second, impulse, &pair, 1),
        obstacle: None,
        nobody: Some(second.kind).filter(|kind| !kind.has_people()),
    }
}

fn suffered(party: &Party, impulse: Vec2, pair: &injury::Pair, side: usize) -> Suffered {
    let delta_v_mps = party.mass_kg.map_or(0.0, |mass_kg| impulse.length() / mass_kg);
    let force_clock = (impulse.length() > 0.0).then(|| clock(&party.outline, -impulse));
    Suffered {
        impact_speed_mps: party.velocity.length(),
        mass_kg: party.mass_kg,
        delta_v_mps,
        force_clock,
        risks: injury::risks(pair, side, delta_v_mps, force_clock),
    }
}

/// The hour to which a direction points, seen from the box.
fn clock(outline: &OrientedBox, direction: Vec2) -> u8 {
    let clockwise = math::atan2(-direction.dot(outline.axis.left()), direction.dot(outline.axis));
    let hours = (clockwise * 6.0 / math::PI).round().rem_euclid(12.0);
    if hours < 0.5 { 12 } else { hours as u8 }
}

/// Share of the narrower shadow in a direction that both cover.
fn overlap(first: &OrientedBox, second: &OrientedBox, direction: Vec2) -> f64 {
    let (own, others) = (first.reach(direction), second.reach(direction));
    let shared = own + others - (second.centre - first.centre).dot(direction).abs();
    (shared / (2.0 * own.min(others))).clamp(0.0, 1.0)
}

/// Impulse on the second one: plane impact with one coefficient each across and along the plane of contact (brach1983). Neither
/// turns before. [kg m/s]
fn impulse(first: &Party, second: &Party, normal: Vec2, point: Vec2, impact: Impact) -> Vec2 {
    let along = normal.left();
    // What a unit impulse across and along changes of the relative velocity at the point, across, along and crosswise. [1/kg]
    let [mut across_across, mut along_along, mut across_along] = [0.0; 3];
    for party in [first, second] {
        let Some(mass_kg) = party.mass_kg else { continue };
        let (length, width) = (2.0 * party.outline.half_length, 2.0 * party.outline.half_width);
        let inertia = mass_kg * (math::sq(length) + math::sq(width)) / 12.0;
        let arm = point - party.outline.centre;
        let (turn_across, turn_along) = (arm.cross(normal), arm.cross(along));
        across_across += 1.0 / mass_kg + math::sq(turn_across) / inertia;
        along_along += 1.0 / mass_kg + math::sq(turn_along) / inertia;
        across_along += turn_across * turn_along / inertia;
    }
    let relative = first.velocity - second.velocity;
    let closing = relative.dot(normal);
    if closing <= 0.0 || across_across == 0.0 {
        return Vec2::default();
    }
    let (wanted_across, wanted_along) = ((1.0 + impact.restitution) * closing, relative.dot(along));
    let determinant = across_across * along_along - math::sq(across_along);
    // The two stick together along the plane, unless that takes more than friction gives.
    let sticking_across = (wanted_across * along_along - wanted_along * across_along) / determinant;
    let sticking_along = (wanted_along * across_across - wanted_across * across_along) / determinant;
    if sticking_along.abs() <= impact.friction * sticking_across {
        return normal * sticking_across + along * sticking_along;
    }
    let friction = impact.friction * sticking_along.signum();
    (normal + along * friction) * (wanted_across / (across_across + friction * across_along))
}

#[cfg(test)]
mod tests;
