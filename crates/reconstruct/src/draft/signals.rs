//! Signals and signs, drawn as they are told.

use crate::draft::lights::{Light, always, opposite};
use crate::ground::way::Ground;
use crate::told::crash::Told;
use crate::told::others::Role;
use crate::told::side::{Side, Turning};
use recrash_model::account::{Control as Said, ControlDevice, LeftRight, Origin, StandReason};
use recrash_model::scenario::{Actor, ActorPlan, Aspect, Control, Device, Phase, StripKind};

/// The arm by which the partner comes. What stood before a driveway, a stall or the kerb is at no arm; at the ego's it would be a sign
/// that nobody told.
pub(crate) const fn arm_of(origin: Origin) -> &'static str {
    match origin {
        Origin::Cross { side: LeftRight::Left } => "left-",
        Origin::Cross { side: LeftRight::Right } => "right-",
        Origin::Opposite => "ahead-",
        Origin::Behind | Origin::Ahead | Origin::Beside { .. } => "own-",
        _ => "",
    }
}

/// What is told to stand at one of the arms, and before whom.
type AtArm<'a> = (&'static str, &'a Side, Said);

/// The devices that are told, and on the other arms what goes with them.
pub(crate) fn devices(told: &Told, ground: &Ground, ego: &ActorPlan, actors: &[Actor]) -> Vec<Control> {
    if !ground.junction {
        return Vec::new();
    }
    let sides = [("own-", &told.sv), (arm_of(told.origin), &told.cp)];
    let said = sides.map(|(arm, side)| side.control.filter(|_| !arm.is_empty()).map(|said| (arm, side, said)));
    let mut list = signs(told, ground, said);
    let [own, partners] = said.map(|said| {
        let (_, side, said) = said.filter(|(_, _, said)| said.device == ControlDevice::Signal)?;
        let is_ego = std::ptr::eq(side, &told.sv);
        Some(Light { told, side, is_ego, said, ego, actors }.program())
    });
    // Who comes by an ego that waits at red; so does a partner that comes from there to an ego in the queue.
    let comes = actors.iter().any(|actor| actor.id == Role::Oncoming.id());
    let comes_by = comes || told.comes_through_red();
    match (own, partners) {
        (None, None) => {}
        (Some(own), None) if comes_by && told.reasons.contains(&StandReason::RedLight) => {
            list.extend(lights_past_red(own).map(|(arm, program)| at(arm, light(program))));
        }
        (own, partners) => {
            for (arm, program) in lights(told, comes_by, own, partners) {
                add(&mut list, ground, arm, light(program));
            }
        }
    }
    list
}

/// A signal that shows this.
const fn light(program: Vec<Phase>) -> Device {
    Device::Signal { program, offset_s: 0.0 }
}

/// A device at the line of an arm.
fn at(arm: &str, device: Device) -> Control {
    Control { at: arm.to_owned(), set_back_m: 0.0, lanes: Vec::new(), device }
}

/// Puts a device at an arm by which lanes lead in, where none is there yet: nobody comes to a line of a street that is one-way.
fn add(list: &mut Vec<Control>, ground: &Ground, arm: &str, device: Device) {
    let road = ground.map.roads.iter().find(|road| arm.strip_suffix('-') == Some(road.id.as_str()));
    let leads_in = road.is_some_and(|road| road.left.iter().any(|strip| strip.kind == StripKind::Driving));
    if leads_in && !list.iter().any(|control| control.at == arm) {
        list.push(at(arm, device));
    }
}

/// The told signs; at a stop that is told to be one for all there is one on every arm.
fn signs(told: &Told, ground: &Ground, said: [Option<AtArm<'_>>; 2]) -> Vec<Control> {
    let mut list: Vec<Control> = Vec::new();
    for (arm, _, said) in said.iter().flatten() {
        let device = match said.device {
            ControlDevice::Signal => continue,
            ControlDevice::StopSign => Device::StopSign {},
            ControlDevice::YieldSign => Device::YieldSign {},
        };
        if !list.iter().any(|control| control.at == *arm) {
            list.push(at(arm, device));
        }
    }
    if told.all_way && list.iter().any(|control| matches!(control.device, Device::StopSign {})) {
        for arm in ["own-", "ahead-", "left-", "right-"] {
            add(&mut list, ground, arm, Device::StopSign {});
        }
    }
    list
}

/// What the signals on all arms show where somebody comes by an ego that waits at red: that one has green, and all others have red.
fn lights_past_red(own: Vec<Phase>) -> [(&'static str, Vec<Phase>); 4] {
    let [ahead, left, right] = [Aspect::Green, Aspect::Red, Aspect::Red].map(always);
    [("own-", own), ("ahead-", ahead), ("left-", left), ("right-", right)]
}

/// What the signals on all arms show, where that of the ego, or of the partner, shows this: two arms that face each other the same, and the other
/// two the opposite.
fn lights(
    told: &Told,
    comes_by: bool,
    own: Option<Vec<Phase>>,
    partners: Option<Vec<Phase>>,
) -> impl Iterator<Item = (&'static str, Vec<Phase>)> {
    let cp_arm = arm_of(told.origin);
    let crosses = matches!(cp_arm, "left-" | "right-");
    let along = own.or_else(|| partners.clone().map(|of| if crosses { opposite(&of) } else { of }));
    let across = partners.clone().filter(|_| crosses).or_else(|| along.as_deref().map(opposite));
    // A light of its own that is told of who comes from ahead may show something else.
    let ahead = partners.filter(|_| cp_arm == "ahead-");
    // Nobody comes from there at green while the ego turns left on an arrow.
    let arrow = told.layout.arrow && told.sv.turning == Turning::Left && !comes_by;
    let ahead = ahead.or_else(|| arrow.then(|| always(Aspect::Red))).or_else(|| along.clone());
    let arms = [("own-", along), ("ahead-", ahead), ("left-", across.clone()), ("right-", across)];
    arms.into_iter().filter_map(|(arm, program)| Some((arm, program?)))
}
