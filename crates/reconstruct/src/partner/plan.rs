//! The partner until the contact, and who touches it first; or the thing that it is.

use crate::pace::lead::before;
use crate::partner::line::{OwnWay, course_to};
use crate::partner::pace::partner_paces;
use crate::partner::{lateral, thrown, turns};
use crate::told::crash::Told;
use crate::told::lies::Lies;
use crate::told::others::Thrower;
use crate::told::rig::Rig;
use crate::told::side::size_of;
use crate::touch::staging::Staging;
use recrash_model::account::Kind;
use recrash_model::geometry::Pose;
use recrash_model::scenario::{Actor, ActorPlan, ObjectSpec, ObstacleKind, Place, Size};

pub(crate) fn partner(told: &Told, staging: &Staging) -> (Vec<Actor>, Vec<ObjectSpec>) {
    let cp = &told.cp;
    let at = |pose: Pose| Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees());
    let (length_m, width_m) = size_of(cp);
    if let Some(thing) = told.thing
        && cp.state.stands()
        && staging.door.is_none()
    {
        let size = Some(Size { length_m, width_m });
        return (Vec::new(), vec![ObjectSpec { kind: obstacle_kind(thing, told), at: at(staging.cp), size }]);
    }
    if told.is_thrown() {
        return (thrown::thrown(told, staging), Vec::new());
    }
    let (lead, pace) = partner_paces(told, staging);
    let arm_m = recrash_roads::arm_m(cp.kind, length_m);
    let actor = |plan: ActorPlan| Actor {
        id: "cp".to_owned(),
        kind: cp.kind,
        size: cp.size,
        mass_kg: told.thing.filter(|_| !told.gate_swings).and_then(mass_kg),
        parts: told.rig.iter().map(Rig::part).collect(),
        plan,
    };
    let driven_m = pace.driven_m;
    let (plan, begin) = match driven_m {
        0.0 => (ActorPlan::standing(at(staging.cp)), staging.cp),
        _ => course_to(told, staging, pace, at),
    };
    let own = OwnWay { course: plan.course.clone(), begin, driven_m };
    let plan = match lead {
        Some(lead) => before(lead, plan, begin, lateral::came_over(told, &staging.ground, arm_m)),
        None => turns::turns_off(told, staging, begin, &plan, arm_m).unwrap_or(plan),
    };
    let stands = plan.course.is_empty();
    let mut actors = vec![actor(plan)];
    if stands {
        return (actors, Vec::new());
    }
    let toucher = || match told.thrower {
        _ if told.pusher_stands => thrown::grazed(told, staging),
        Some(Thrower::Cross(_) | Thrower::Opposite) => {
            thrown::across(told, staging).unwrap_or_else(|| thrown::nudger(told, staging, own))
        }
        Some(Thrower::Ahead) => thrown::ahead(told, staging).unwrap_or_else(|| thrown::nudger(told, staging, own)),
        _ => thrown::nudger(told, staging, own),
    };
    actors.extend((told.pushed && told.thing.is_none()).then(toucher));
    (actors, Vec::new())
}

/// Usual masses of things that move, assumed; none of what stands fast. [kg]
const fn mass_kg(kind: Kind) -> Option<f64> {
    match kind {
        Kind::Cone => ObstacleKind::Cone.mass_kg(),
        Kind::Debris | Kind::Object | Kind::Scooter | Kind::Sign | Kind::TreeBranch => ObstacleKind::Debris.mass_kg(),
        Kind::LooseWheel | Kind::Cart => Some(30.0),
        Kind::Cargo | Kind::Barrier => Some(50.0),
        _ => None,
    }
}

/// What is told as a wall, and is no longer than this, is a pole. [m]
const SLIM_M: f64 = 0.5;

/// How a thing is drawn.
fn obstacle_kind(kind: Kind, told: &Told) -> ObstacleKind {
    let slim = size_of(&told.cp).0 < SLIM_M;
    match kind {
        Kind::Pothole if matches!(told.lies, Some(Lies::Bump | Lies::Edge)) => ObstacleKind::Kerb,
        Kind::Wall if slim => ObstacleKind::Pole,
        Kind::Object if told.edge.is_some() => ObstacleKind::Wall,
        Kind::Debris if told.edge.is_some() => ObstacleKind::Container,
        Kind::Wall => ObstacleKind::Wall,
        Kind::Curb => ObstacleKind::Kerb,
        Kind::Gate => ObstacleKind::Gate,
        Kind::Chain => ObstacleKind::Chain,
        Kind::Barrier => ObstacleKind::Barrier,
        Kind::Cone => ObstacleKind::Cone,
        // One that lies across the lane is none that stands.
        Kind::Sign | Kind::Pole if size_of(&told.cp).1 > SLIM_M => ObstacleKind::Debris,
        Kind::Pole => ObstacleKind::Pole,
        Kind::Sign => ObstacleKind::Warning,
        Kind::Pothole => ObstacleKind::Pothole,
        _ => ObstacleKind::Debris,
    }
}
