//! The first contact of a rollout: who and which parts touch, and who touched the partner before.

use crate::told::crash::Told;
use crate::told::rig::{ID, Rig};
use crate::told::zones::{side_of, zones_off};
use crate::touch::opening;
use recrash_model::account::Kind;
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::narrative::FirstMover;
use recrash_model::rollout::{ActorState, ActorTrack, EventKind, Rollout, STEP_S};
use recrash_model::zones::ContactZone;

/// Nearer to the middle than this a contact is on neither side. [m]
const MIDDLE_M: f64 = 0.1;

/// Whether a contact lies within a step of a told zone, and not on the other side of the vehicle than all told ones.
pub(super) fn is_near(told: &[ContactZone], seen: ContactZone, outline: &OrientedBox, point: Vec2) -> bool {
    let aside_m = outline.to_local(point).y;
    let other_side = side_of(told).is_some_and(|side| side.sign() * aside_m < -MIDDLE_M);
    zones_off(told, seen) <= 1 && !other_side
}

/// When somebody came to the place of the contact is looked for in such steps; who came by so much earlier was first. [s]
const LOOKS_S: f64 = 0.01;
const FIRST_S: f64 = 0.1;

/// Who come within this time come together. [s]
const TOGETHER_S: f64 = 1.0;

pub(super) struct Touch<'a> {
    pub(super) time_s: f64,
    pub(super) ego: ActorState,
    pub(super) other: ActorState,
    pub(super) kind: PartnerKind,
    pub(super) other_box: OrientedBox,
    pub(super) track: Option<&'a ActorTrack>,
}

pub(super) fn zone_words(zones: &[ContactZone]) -> String {
    zones.iter().map(|zone| zone.label()).collect::<Vec<_>>().join(" or ")
}

/// Who is told to have been first, and by how much it has to be.
pub(super) fn order_words(first: FirstMover) -> String {
    match first {
        FirstMover::Sv | FirstMover::Cp => format!("{}, by more than {FIRST_S:.2} s", first.words()),
        FirstMover::Both => format!("{}, within {TOGETHER_S:.2} s", first.words()),
    }
}

/// Whether who is told to have been first was at the place of the contact first, and by how much.
pub(super) fn order(
    first: FirstMover,
    [ego, other]: [(&ActorTrack, f64); 2],
    point: Vec2,
    time_s: f64,
) -> (bool, String) {
    let there_s = |(track, reach_m): (&ActorTrack, f64)| {
        let until = (time_s / LOOKS_S).round() as usize + 1;
        // Farther off it covers nothing, however it is turned.
        let far_m = track.length_m + track.width_m + 2.0 * reach_m;
        let covers = |step: &usize| {
            let pose = pose_at(track, LOOKS_S * *step as f64);
            if pose.position.distance(point) > far_m {
                return false;
            }
            let outline = OrientedBox::new(pose, track.length_m, track.width_m);
            let local = outline.to_local(point);
            local.x.abs() <= outline.half_length + reach_m && local.y.abs() <= outline.half_width + reach_m
        };
        // Who passed the place before, and came back to it, is there when it is back.
        let last = (0..until).rfind(&covers);
        let since = last.map(|last| (0..last).rfind(|step| !covers(step)).map_or(0, |step| step + 1));
        since.map_or(time_s, |step| LOOKS_S * step as f64)
    };
    let (ego_s, other_s) = (there_s(ego), there_s(other));
    let earlier_s = other_s - ego_s;
    let shown = match first {
        FirstMover::Sv => earlier_s > FIRST_S,
        FirstMover::Cp => earlier_s < -FIRST_S,
        FirstMover::Both => earlier_s.abs() <= TOGETHER_S,
    };
    let observed = match (ego_s < other_s, earlier_s.abs()) {
        (_, 0.0) => "both at once".to_owned(),
        (true, by_s) => format!("the ego, by {by_s:.2} s"),
        (false, by_s) => format!("the partner, by {by_s:.2} s"),
    };
    (shown, observed)
}

/// A part is met where it is no farther from the other than this at the contact: tracks tell where it is every 0.1 s. [m]
pub(super) const MET_M: f64 = 0.06;

/// The part of the ego's, or of the other's, that touched, where bodies did not.
pub(super) fn parts_that_touch(
    rollout: &Rollout,
    touch: &Touch<'_>,
    ego_box: &OrientedBox,
) -> (Option<OrientedBox>, Option<OrientedBox>) {
    if ego_box.overlaps(&touch.other_box) {
        return (None, None);
    }
    let number = touch.track.and_then(|track| rollout.actors.iter().position(|other| other.id == track.id));
    let met = |owner: Option<usize>, other: &OrientedBox| {
        let of_owner = rollout.actors.iter().filter(|track| owner.is_some() && track.part_of == owner);
        let body = if owner == Some(0) { ego_box } else { &touch.other_box };
        let boxes = of_owner.map(|track| outline_at(track, touch.time_s)).filter(|part| opening::is_open(body, part));
        boxes
            .map(|part| (part.nearest_points(other).2, part))
            .filter(|(gap, _)| *gap < MET_M)
            .map(|(_, part)| part)
            .next()
    };
    match met(Some(0), &touch.other_box) {
        Some(part) => (Some(part), None),
        None => (None, met(number, ego_box)),
    }
}

/// A part that has turned by less than this in the last 0.3 s does not swing. [rad]
const SWINGS_RAD: f64 = 0.05;

/// Whether the part of somebody that touches was swinging then.
pub(super) fn swung(rollout: &Rollout, owner: &ActorTrack, part: &OrientedBox, time_s: f64) -> bool {
    let number = rollout.actors.iter().position(|other| other.id == owner.id);
    let parts = rollout.actors.iter().filter(|track| track.part_of == number);
    let before = parts.map(|track| outline_at(track, (time_s - 0.3).max(0.0)));
    before.map(|before| math::acos(before.axis.dot(part.axis).clamp(-1.0, 1.0))).any(|turned| turned > SWINGS_RAD)
}

/// A box between two steps.
fn outline_at(track: &ActorTrack, time_s: f64) -> OrientedBox {
    OrientedBox::new(pose_at(track, time_s), track.length_m, track.width_m)
}

/// Its pose.
fn pose_at(track: &ActorTrack, time_s: f64) -> Pose {
    let at = (time_s / STEP_S).min((track.states.len() - 1) as f64);
    let (step, share) = (at.floor() as usize, at - at.floor());
    let (from, to) = (&track.states[step], &track.states[(step + 1).min(track.states.len() - 1)]);
    let position = from.position() + (to.position() - from.position()) * share;
    let heading = from.heading + math::wrap_angle(to.heading - from.heading) * share;
    Pose { position, heading }
}

/// Whom else the partner touched before.
pub(super) fn toucher<'a>(rollout: &'a Rollout, touch: &Touch<'_>) -> Option<&'a ActorTrack> {
    rollout.actors.get(thrower(rollout, touch.time_s)?)
}

/// Number of whom the partner touched first before this time, the ego aside. [s]
pub(super) fn thrower(rollout: &Rollout, until_s: f64) -> Option<usize> {
    let number = rollout.actors.iter().position(|track| track.id == "cp")?;
    rollout.events.iter().take_while(|event| event.time_s < until_s).find_map(|event| match event.kind {
        EventKind::Contact { a, b, .. } if a != 0 && (a == number || b == number) => {
            Some(if a == number { b } else { a })
        }
        _ => None,
    })
}

pub(super) fn first_touch(rollout: &Rollout) -> Option<Touch<'_>> {
    rollout.events.iter().find_map(|event| match &event.kind {
        EventKind::Contact { a: 0, b, a_state, b_state } => {
            let track = rollout.actors.get(*b)?;
            Some(Touch {
                time_s: event.time_s,
                ego: *a_state,
                other: *b_state,
                kind: track.kind,
                other_box: OrientedBox::new(b_state.pose(), track.length_m, track.width_m),
                track: Some(track),
            })
        }
        EventKind::ObstacleContact { actor: 0, obstacle, state } => {
            let placed = rollout.obstacles.get(*obstacle)?;
            Some(Touch {
                time_s: event.time_s,
                ego: *state,
                other: ActorState::moving(placed.pose, 0.0),
                kind: PartnerKind::FixedObject,
                other_box: placed.outline(),
                track: None,
            })
        }
        _ => None,
    })
}

/// Two others than the ego who touch, whom nobody had touched before and of whom it is not told. Who throws the partner does so.
pub(super) fn crash(told: &Told, rollout: &Rollout) -> Option<String> {
    let mut touched = vec![false; rollout.actors.len()];
    let id = |number: usize| rollout.actors[number].id.as_str();
    rollout.events.iter().find_map(|event| match event.kind {
        EventKind::Contact { a, b, .. } => {
            let throws = told.pushed && [id(a), id(b)].contains(&"cp");
            let untold = a > 0 && !touched[a] && !touched[b] && !throws;
            (touched[a], touched[b]) = (a > 0, true);
            untold.then(|| format!("{} and {} touch at {:.2} s", id(a), id(b), event.time_s))
        }
        _ => None,
    })
}

/// Whether the partner draws one.
pub(super) fn is_drawn(rollout: &Rollout) -> bool {
    rollout.actors.iter().any(|track| track.part_of.is_some() && track.id == format!("cp.{ID}"))
}

/// From the front of a rigid one to its trailer. [m]
fn tractor_m(told: &Told) -> f64 {
    told.trailer_of.and_then(Rig::of).map_or(0.0, |rig| rig.tractor.length_m)
}

/// Whether the place of a contact is on the trailer of an ego that draws one, which is a truck.
pub(super) fn is_on_own_trailer(outline: &OrientedBox, point: Vec2) -> bool {
    let tractor_m = Rig::of(Kind::SemiTrailerTruck).map_or(0.0, |rig| rig.tractor.length_m);
    outline.to_local(point).x < outline.half_length - tractor_m
}

/// Whether the place of a contact is on the trailer, of a rigid one.
pub(super) fn is_on_trailer(told: &Told, outline: &OrientedBox, point: Vec2) -> bool {
    outline.to_local(point).x < outline.half_length - tractor_m(told)
}
