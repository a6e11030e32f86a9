//! The last pace of the partner, as far as no place is needed for it.

use crate::pace::lead::MOVES_UP_M;
use crate::pace::plain::{Pace, SETS_OFF_MPS2, pace, start_over};
use crate::told::crash::Told;
use crate::told::phase::Phase;
use crate::told::side::size_of;
use crate::usual::{STOOD_S, WALKS_MPS};
use recrash_model::account::ContactState;
use recrash_model::kinds::PartnerKind;
use recrash_model::template::Movement;

/// How far somebody goes until it touches the one that it waited behind, which set off earlier, and creeps. [m]
fn catches_up_m(told: &Told) -> f64 {
    let (ego_mps, cp_mps) = (told.sv.speed_mps, told.cp.speed_mps);
    let head_m = ego_mps * (0.5 * (cp_mps - ego_mps) / SETS_OFF_MPS2 + told.head_start_s()) + BEHIND_M;
    (head_m / (1.0 - ego_mps / cp_mps).max(0.1)).max(MOVES_UP_M)
}

/// Who waited behind somebody sets off so long after it, or before it where that is told. [s]
pub(crate) const FOLLOWS_S: f64 = 0.5;

impl Told {
    /// How much earlier than the partner that waited behind it the ego sets off: less than nothing where it is told to have done so after that. [s]
    pub(crate) fn head_start_s(&self) -> f64 {
        let behind = self.sv.acts.iter().any(|doing| doing.sets_off_behind(&self.cp.acts));
        if behind { -FOLLOWS_S } else { FOLLOWS_S }
    }
}

/// The partner's last pace, where it does not depend on what the ego does.
pub(crate) fn last_pace(told: &Told) -> Pace {
    let (cp, contact_s) = (&told.cp, told.contact_s);
    let rolling_mps = if cp.kind == PartnerKind::Pedestrian { WALKS_MPS } else { 5.0 };
    let usual = pace(contact_s, cp, rolling_mps, STOOD_S + told.choices.longer_s[1]);
    // Who stood behind an ego that moved up stood behind where that was; who comes round it has room for that.
    let moved_up = told.sv.state.stands() && told.sv.phases.iter().skip(1).any(|phase| *phase == Phase::Drives);
    let from_m = match told.waits_behind() {
        true if told.comes_round_ego() && told.close => COMES_ROUND_CLOSE_M,
        true if cp.movement == Some(Movement::Passing) => COMES_ROUND_M,
        true if moved_up => MOVES_UP_M + BEHIND_M,
        true if told.sv.state == ContactState::SettingOff => catches_up_m(told),
        true if usual.speed_mps > 0.0 => MOVES_UP_M,
        // Who stood and then passed has come by from there.
        false if told.passes_after_stand() => 0.5 * (size_of(cp).0 + size_of(&told.sv).0) + STANDS_SHORT_M,
        _ => return usual,
    };
    start_over(contact_s, cp.speed_mps, from_m).unwrap_or(usual)
}

/// Who stood behind the ego and comes round it has driven so far at the contact; farther where it has no room for that. [m]
const COMES_ROUND_CLOSE_M: f64 = 8.0;
const COMES_ROUND_M: f64 = 12.0;

/// Who stood, and passed the ego then, stood so far short of it at least. [m]
const STANDS_SHORT_M: f64 = 3.0;

/// Who stands behind the ego stands so far behind it. [m]
pub(crate) const BEHIND_M: f64 = 2.0;

/// Who backed first did so by so long. [s]
pub(crate) const BACKS_EARLIER_S: f64 = 1.0;
