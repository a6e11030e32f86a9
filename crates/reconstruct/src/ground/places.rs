//! Where along its way the ego may be at the contact, at a junction.

use crate::ground::lanes::has;
use crate::ground::pieces::{APPROACH_M, corner_m};
use crate::told::crash::{AtRed, Told};
use crate::told::near::{Does, Near};
use crate::told::others::Role;
use crate::told::side::{Turning, size_of};
use crate::told::{queue, sizes};
use crate::usual::{LEAD_GAP_M, ROOM_M};
use recrash_model::account::{ContactState, LeftRight, Origin, StandReason};
use recrash_model::kinds::PartnerKind;
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;

/// Places of who has yet to turn, from where the junction begins. [m]
const BEFORE_TURN_M: [f64; 3] = [-5.0, -2.0, -9.0];

/// Places to try along the way of an ego at a junction of a road with so many lanes, who turns there or is crossed, or goes straight on. [m]
pub(super) fn places(told: &Told, crossing: bool, at_kerb: bool, lanes: usize) -> Vec<f64> {
    if crossing || told.sv.turning != Turning::No {
        let later: &[f64] = if told.sv.turns_later { &BEFORE_TURN_M } else { &[] };
        return from_begin(&[&at_line(told), later, in_it(told)].concat());
    }
    let enters = told.enters() || told.is_followed_in();
    match enters && !at_kerb && told.edge.is_none() {
        true if told.sv.crossed => from_begin(&BEYOND_M.map(|beyond_m| 2.0 * corner_m(lanes) + beyond_m)),
        // No farther than who does not run its red light.
        true if told.keeps_red() == Some(AtRed::Creeps) => from_begin(&CREEPS_M),
        true => from_begin(&INSIDE_M),
        false => vec![before_it(told, at_kerb)],
    }
}

/// Along the ego's way, of places from where the junction begins. [m]
fn from_begin(places: &[f64]) -> Vec<f64> {
    places.iter().map(|place_m| APPROACH_M + place_m).collect()
}

/// Places of who stands at the line, or sets off there, before it turns or is crossed, from where the junction begins. [m]
pub(super) fn at_line(told: &Told) -> Vec<f64> {
    match told.sv.state {
        _ if told.enters() => Vec::new(),
        ContactState::Stopped if told.stops_at_line() => match queue_m(told) {
            // At the line, before the crosswalk.
            None if told.crosses_at_walk() => vec![-0.5 * size_of(&told.sv).0 - AT_LINE_M, -5.0, -8.0],
            Some(queue_m) => vec![-queue_m, -queue_m - 2.0],
            None => vec![-5.0, -8.0],
        },
        ContactState::SettingOff if told.sv.control.is_some() => vec![3.0, 1.0, 5.0, -3.0],
        _ => Vec::new(),
    }
}

/// Places of who is in the junction as it turns, or is crossed, from where that begins. [m]
fn in_it(told: &Told) -> &'static [f64] {
    let to_right = told.sv.turning == Turning::Right;
    let waits = told.sv.state == ContactState::Stopped && told.origin == Origin::Behind;
    match told.sv.turning != Turning::No {
        // Farther in it, who follows has begun it too.
        _ if told.turns_as_ego() && waits => &[9.0, 8.0, 6.0, 10.0, 14.0, 3.0, 18.0, 22.0, 28.0],
        _ if told.turns_as_ego() => &[14.0, 10.0, 6.0, 18.0, 3.0, 22.0, 28.0],
        // It has begun to turn.
        _ if waits && to_right => &[6.0, 10.0, 14.0, 3.0, 18.0, 22.0, 28.0],
        // A turn to the right is over sooner.
        _ if told.goes_straight_behind() && to_right => &[6.0, 5.0, 7.0, 8.0, 9.0, 10.0, 14.0, 18.0, 22.0],
        _ if told.goes_straight_behind() => &[8.0, 9.0, 10.0, 14.0, 18.0, 22.0],
        // Where it has begun to turn, and has not come to the partner's lane; a turn to the right is over sooner.
        _ if told.goes_straight_beside() && to_right => {
            &[6.0, 5.0, 7.0, 4.0, 8.0, 12.0, 11.0, 13.0, 10.0, 14.0, 6.0, 18.0, 3.0, 22.0, 28.0]
        }
        _ if told.goes_straight_beside() => &[12.0, 11.0, 13.0, 10.0, 14.0, 6.0, 18.0, 3.0, 22.0, 28.0],
        _ if told.turns_into_own_road() => &[26.0, 30.0, 22.0, 12.0, 8.0, 16.0, 5.0, 20.0],
        true => &[10.0, 14.0, 6.0, 18.0, 3.0, 22.0, 28.0],
        false => &[12.0, 8.0, 16.0, 5.0, 20.0],
    }
}

/// The place of who goes straight on and has not come into the junction, along its way: at the line, or behind who stands there. [m]
fn before_it(told: &Told, at_kerb: bool) -> f64 {
    let lead = has(told, Role::Lead);
    let behind = lead || told.origin == Origin::Ahead && told.thing.is_none();
    let both = lead && told.origin == Origin::Ahead;
    // What is long stands before the line too.
    let longer_m = if told.origin == Origin::Ahead { (size_of(&told.cp).0 - USUAL_M).max(0.0) } else { 0.0 };
    let before_m = match queue_m(told).filter(|_| !both) {
        _ if at_kerb => KERB_BEFORE_M,
        Some(queue_m) => queue_m,
        None if behind => 13.0 + longer_m,
        None => 5.0,
    };
    match told.sets_off_first() && before_m < USUAL_M {
        // From its line.
        true => APPROACH_M - over_line_m(told),
        false => APPROACH_M - before_m - if both { 10.0 } else { 0.0 },
    }
}

/// From the stop line to the middle of an ego that stands in a queue: the first of it stands at the line; of several there are as many as are drawn. [m]
fn queue_m(told: &Told) -> Option<f64> {
    let lead = told.extras.iter().find(|extra| extra.role == Role::Lead)?;
    let kind = lead.kind.partner_kind().unwrap_or(PartnerKind::PassengerCar);
    let long_m = sizes::size_of(lead.kind).map_or(VehicleSpec::of(kind).length_m, |size| size.length_m);
    // "behind a van and a hatchback": another one of them is of another kind.
    let stands = |near: Near| near.place == Some(Origin::Ahead) && near.does == Does::Stands;
    let two = told.wanted.iter().any(|extra| extra.near.is_some_and(stands));
    let ahead = if lead.several {
        lead.number as f64
    } else if two {
        2.0
    } else {
        1.0
    };
    let aside_m = if told.sv_aside().is_some() { ROOM_M } else { 0.0 };
    let stands_m = 0.5 * size_of(&told.sv).0 + ahead * (LEAD_GAP_M + long_m) + aside_m + FIRST_AT_LINE_M;
    // Who has set off behind it has come nearer to the line.
    let came_m = 0.5 * told.sv.speed_mps * told.sv.speed_mps / CAME_MPS2;
    // Who slows for it has yet to come to its stand.
    let slows = told.sv.state == ContactState::Moving && told.sv.slowed_from.is_some();
    let yet_m = if slows { 0.5 * told.sv.speed_mps * told.sv.speed_mps / BRAKES_MPS2 } else { 0.0 };
    Some(if queue::sets_off(told) { stands_m - came_m } else { stands_m + yet_m })
}

/// Who is no longer than this has room between the ego and the stop line. [m]
const USUAL_M: f64 = 6.0;

/// Who stands at the kerb does so before a junction by so much. [m]
const KERB_BEFORE_M: f64 = 10.0;

/// The first of a queue stands so far before the line. [m]
const FIRST_AT_LINE_M: f64 = 0.6;

/// No ego that sets off behind it comes nearer to the line by more than with this. [m/s^2]
const CAME_MPS2: f64 = 2.0;

/// An ego that has yet to stop behind it brakes with this, once it is hit. [m/s^2]
const BRAKES_MPS2: f64 = 5.0;

/// Who stands first at a signal stands so far before its line, and sets off from there for so long, for so far at least and at most.
/// [m, s, m]
const AT_LINE_M: f64 = 0.5;
const SETS_OFF_S: f64 = 4.0;
const SETS_OFF_M: (f64, f64) = (0.6, 2.8);

/// From where a junction begins back to the middle of an ego that sets off from its line. [m]
fn over_line_m(told: &Told) -> f64 {
    let driven_m = (SETS_OFF_S * told.sv.speed_mps).clamp(SETS_OFF_M.0, SETS_OFF_M.1);
    0.5 * size_of(&told.sv).0 + AT_LINE_M - driven_m
}

/// Places of who goes straight on and is told to be in the junction, where nobody crosses it or turns. [m]
const INSIDE_M: [f64; 3] = [2.5, 7.0, 12.0];

/// The same of who is over its line at red by a little. [m]
const CREEPS_M: [f64; 2] = [0.4, 0.0];

/// The same of who has come through it, from where it ends. [m]
const BEYOND_M: [f64; 3] = [4.0, 10.0, 2.0];

impl Told {
    /// Whether an ego that stands, and does not turn, stands before the junction: at a signal or a sign, or for somebody who walks across.
    fn stops_at_line(&self) -> bool {
        let walks = self.reasons.contains(&StandReason::Pedestrian) && has(self, Role::Walker);
        (self.sv.control.is_some() || walks) && self.sv.turning == Turning::No
    }

    /// Whether the partner runs into the rear of an ego that has begun its turn, and is told to make the same.
    fn turns_as_ego(&self) -> bool {
        let same = match self.sv.turning {
            Turning::Left => Movement::LeftTurn,
            Turning::Right => Movement::RightTurn,
            Turning::No | Turning::Round => return false,
        };
        self.origin == Origin::Behind && !self.sv.turns_later && self.cp.turns_later && self.cp.movement == Some(same)
    }

    /// Whether the partner turns out of a crossing road into the ego's, the ego's way.
    fn turns_into_own_road(&self) -> bool {
        let side = match self.cp.turning {
            Turning::Left => LeftRight::Left,
            Turning::Right => LeftRight::Right,
            Turning::No | Turning::Round => return false,
        };
        self.origin == Origin::Cross { side } && self.sv.turning == Turning::No && self.sv.state == ContactState::Moving
    }
}
