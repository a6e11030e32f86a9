//! How fast the two are at the contact: as told, or such that who closes on whom does.

use crate::told::crash::Told;
use crate::told::doing::Doing;
use crate::told::side::{Side, Slowed, Turning, size_of};
use crate::usual::{RUNS_MPS, SLIDES_MPS, TURNS_MPS, WALKS_MPS, WHEELED_M};
use recrash_model::account::{ContactState, Manner, Origin, PlaceKind};
use recrash_model::kinds::PartnerKind;
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;

/// Speed at which a partner that is thrown at the ego meets it, about. [m/s]
const THROWN_MPS: f64 = 4.0;

/// Who comes after an ego that comes to a stop, and does not stop, is no slower. [m/s]
const AFTER_MPS: f64 = 5.2;

/// Who sets off behind an ego that moves is faster than it by so much. [m/s]
const SETS_OFF_FASTER_MPS: f64 = 1.0;

/// Who backs towards an ego that backs away is faster than it by so much. [m/s]
const BACKS_FASTER_MPS: f64 = 0.5;

/// Who turns beside an ego that turns is faster than it by so much. [m/s]
const ABREAST_MPS: f64 = 1.0;

/// An ego that is no faster than this creeps, and who was ahead beside its line drives so. [m/s]
const CREEPS_MPS: f64 = 0.5;
const NEARED_MPS: f64 = 1.2;

/// What is no longer goes as fast as people walk. [m]
const ROBOT_M: f64 = 0.8;

/// Who drives side by side with the ego is hardly faster. [m/s]
const SIDE_BY_SIDE_MPS: f64 = 0.6;

/// Who merges in front of an ego that stops for it does so slowly. [m/s]
const MERGES_MPS: f64 = 1.5;

/// Who comes up to the other one, or is come up to, beside it or in its lane, is so much faster or slower. [m/s]
const OTHER_PACE_MPS: f64 = 2.5;

/// Who is run into from behind at a told speed moves at half of that, or slower by [`OTHER_PACE_MPS`], where that is more.
const OVERTAKEN_SHARE: f64 = 0.5;

/// An ego that was coming to a stop is no faster. [m/s]
const STOPS_MPS: f64 = 2.5;

/// Nobody who moves is slower. [m/s]
const SLOWEST_MPS: f64 = 0.4;

/// Highest speed in a turn of who comes up beside the ego. [m/s]
const FASTEST_TURN_MPS: f64 = 7.0;

impl Told {
    /// Speed at the contact of somebody who drives, by the posted speed, or the usual one of such a place: who comes up behind
    /// somebody that stands brakes, late; who passes or drifts has slowed; who crosses has slowed a little. [m/s]
    fn driven_mps(&self) -> f64 {
        let usual_mps = match self.place {
            PlaceKind::Highway => 27.0,
            place if place.is_off_street() => 5.0,
            _ => 11.2,
        };
        // In a turn nobody drives at the posted speed.
        if self.origin == Origin::Behind && matches!(self.sv.turning, Turning::Left | Turning::Right) {
            return TURNS_MPS;
        }
        let share = match self.origin {
            Origin::Behind | Origin::Ahead => 0.5,
            Origin::Beside { .. } => 0.6,
            Origin::Cross { .. } | Origin::Opposite => 0.7,
            _ => 0.4,
        };
        let speed_mps = share * self.posted_mps.unwrap_or(usual_mps);
        // Else it would be ahead of an ego that comes to a stop.
        let comes_after = matches!(self.origin, Origin::Behind | Origin::Beside { .. }) && usual_mps > 6.0;
        if comes_after { speed_mps.max(AFTER_MPS) } else { speed_mps }
    }

    /// Whether a partner that was ahead in the next lane comes over into the way of an ego that keeps its lane, and nobody tells that it was
    /// slow, had slowed, or was passed: it came along about as fast.
    fn comes_over_ahead(&self) -> bool {
        let cp = &self.cp;
        let slow =
            cp.slowed_from.is_some() || cp.stood_first || !cp.phases.is_empty() || cp.manner == Some(Manner::Slow);
        let passed = self.sv.movement == Some(Movement::Passing) || self.sv.acts.iter().any(Doing::is_pass);
        let over = cp.dodges || cp.acts.iter().any(Doing::goes_aside);
        let wheels = VehicleSpec::of(cp.kind).length_m > WHEELED_M;
        self.ahead == Some(true) && over && wheels && !slow && !passed && self.sv_aside().is_none()
    }

    /// Whether the partner is told to have driven beside an ego that drives, and not to have come up to it, or to turn.
    pub(crate) fn drives_abreast(&self) -> bool {
        let drives =
            |side: &Side| side.state == ContactState::Moving && side.turning == Turning::No && !side.stood_first;
        self.layout.abreast && drives(&self.sv) && drives(&self.cp)
    }

    /// No faster is an ego of which no speed is told, where one that comes from behind is told to run into it at one. [m/s]
    fn overtaken_mps(&self) -> f64 {
        let moves = matches!(self.sv.state, ContactState::Moving | ContactState::SettingOff);
        let comes_mps =
            self.cp.impact_mps.filter(|_| self.origin == Origin::Behind && moves && !self.cp.state.stands());
        match (self.sv.impact_mps, comes_mps) {
            (None, Some(mps)) => (mps - OTHER_PACE_MPS).max(OVERTAKEN_SHARE * mps).max(SLOWEST_MPS),
            _ => f64::INFINITY,
        }
    }

    /// Speeds at the contact: as told, or such that who closes on whom does.
    pub(crate) fn speeds(&mut self) {
        if self.nears_ahead() && self.sv.phases.is_empty() {
            self.sv.slowed_from = self.sv.slowed_from.or(Some(Slowed(None)));
        }
        self.sv.speed_mps = self.sv_mps();
        self.cp.speed_mps = self.cp_mps();
        let untold = self.cp.impact_mps.is_none();
        if untold {
            self.cp.speed_mps = self.cp_mps_by_ego();
        }
        self.cp.speed_mps = self.dropped_mps().unwrap_or(self.cp.speed_mps);
        if untold && self.gives_way_to_merge {
            self.cp.speed_mps = MERGES_MPS;
        }
        // Who gained speed came at the usual one.
        if untold && self.cp.gains {
            self.cp.speed_mps += GAINS_MPS;
        }
        if untold && !self.is_thrown() {
            self.cp.speed_mps *= self.choices.partner_speed;
        }
        if self.sv.impact_mps.is_none() && !self.sv.state.stands() {
            self.assumed.push(format!("the ego's speed at the contact: {:.1} m/s", self.sv.speed_mps));
        }
        if untold && !self.cp.state.stands() {
            let words = manner_words(self.cp.manner);
            self.assumed.push(format!("the partner's speed at the contact: {:.1} m/s{words}", self.cp.speed_mps));
        }
    }

    /// Whether the ego came up to one that was ahead beside its line, and hardly moves: it came faster.
    fn nears_ahead(&self) -> bool {
        let (sv, cp) = (&self.sv, &self.cp);
        let beside_ahead = matches!(self.origin, Origin::Beside { .. }) && self.ahead == Some(true);
        let creeps = sv.impact_mps.is_some_and(|mps| mps <= CREEPS_MPS) && sv.state == ContactState::Moving;
        let neared = beside_ahead && creeps && sv.turning == Turning::No && !sv.stood_first;
        neared && cp.turning == Turning::No && cp.state == ContactState::Moving
    }

    /// Usual speed at the contact of one of the two, by what it does there. [m/s]
    fn usual_mps(&self, side: &Side) -> f64 {
        let crosses = matches!(self.origin, Origin::Cross { .. });
        match side.state {
            ContactState::Stopped | ContactState::Parked => 0.0,
            // It has come from its line.
            ContactState::SettingOff if (side.control.is_some() || side.enters() || self.all_way) && crosses => 4.0,
            ContactState::SettingOff => 1.5,
            ContactState::Reversing => 1.2,
            ContactState::Moving if side.kind == PartnerKind::Pedestrian => WALKS_MPS,
            ContactState::Moving if side.is_slow() => 3.0,
            ContactState::Moving if side.stood_first => 4.0,
            ContactState::Moving => match side.kind {
                PartnerKind::Animal => 4.0,
                PartnerKind::FixedObject if self.is_sliding() => SLIDES_MPS,
                PartnerKind::OtherNonMotorist if size_of(side).0 <= ROBOT_M => WALKS_MPS,
                PartnerKind::Cyclist | PartnerKind::OtherNonMotorist => 4.5,
                _ if side.turning != Turning::No => TURNS_MPS,
                _ => self.driven_mps(),
            },
        }
    }

    /// The same or less, where stalls or a gate are near; an alley is driven along. [m/s]
    fn fit_mps(&self, mps: f64) -> f64 {
        if self.place.is_lot() || self.place == PlaceKind::Driveway { mps.min(3.0) } else { mps }
    }

    /// The usual speed of one of the two, as far as words tell how fast it drove. [m/s]
    fn usual_as_told_mps(&self, side: &Side) -> f64 {
        as_told(side.manner, self.fit_mps(self.usual_mps(side)), self.place.is_off_street(), self.posted_mps)
    }

    /// The ego's speed. [m/s]
    fn sv_mps(&self) -> f64 {
        let sv = &self.sv;
        let mps = match (sv.impact_mps, sv.state.stands()) {
            (_, true) => 0.0,
            (Some(told), false) => told.max(SLOWEST_MPS),
            (None, false) => {
                let slowed_mps = sv.slowed_from.and_then(|slowed| slowed.0).unwrap_or(f64::INFINITY);
                let stops = sv.acts.last().is_some_and(Doing::is_begun_stop);
                self.usual_as_told_mps(sv).min(if stops { slowed_mps.min(STOPS_MPS) } else { slowed_mps })
            }
        };
        mps.min(self.overtaken_mps())
    }

    /// The partner's speed, whatever that of the ego is. [m/s]
    fn cp_mps(&self) -> f64 {
        let cp = &self.cp;
        match (cp.impact_mps, cp.state.stands()) {
            // It is thrown at the ego.
            _ if self.is_thrown() => THROWN_MPS,
            (_, true) => 0.0,
            (Some(told), false) => told.max(SLOWEST_MPS),
            (None, false) if self.queues() => self.fit_mps(QUEUED_MPS),
            (None, false) if let Some(mps) = fast_mps(cp) => mps,
            (None, false) => self.usual_as_told_mps(cp),
        }
    }

    /// The same by that of the ego, where none is told of the partner: who closes on whom does. [m/s]
    fn cp_mps_by_ego(&self) -> f64 {
        let (sv, cp) = (&self.sv, &self.cp);
        let behind = self.origin == Origin::Behind;
        let mut mps = cp.speed_mps;
        // Who sets off behind an ego that moves is faster.
        let sets_off = cp.state == ContactState::SettingOff || self.queues();
        if sets_off && behind {
            mps = mps.max(sv.speed_mps + SETS_OFF_FASTER_MPS);
        }
        // So is who set off behind an ego that slowed again: as fast as that was between.
        let slowed = sv.stood_first && sv.slowed_from.is_some();
        if behind && (cp.stood_first || sets_off) && slowed {
            mps = mps.max(sv.speed_mps + STARTS_AND_SLOWS_MPS);
        }
        if cp.state == ContactState::Moving && !self.comes_across() {
            mps = self.moving_mps_by_ego(mps);
        }
        // Who backs towards an ego that backs away is faster.
        let both_back = cp.state == ContactState::Reversing && sv.state == ContactState::Reversing;
        if both_back && self.origin == Origin::Ahead {
            mps = mps.max(sv.speed_mps + BACKS_FASTER_MPS);
        }
        mps
    }

    /// Speed of a partner that moves forwards and comes by the ego's road, by that of the ego: faster where it comes up to that, slower where it is
    /// come up to. [m/s]
    fn moving_mps_by_ego(&self, mps: f64) -> f64 {
        let (sv, turning, sv_mps) = (&self.sv, self.cp.turning, self.sv.speed_mps);
        let beside = matches!(self.origin, Origin::Beside { .. });
        let was_ahead = self.ahead == Some(true) && turning == Turning::No;
        match self.origin {
            // Whom the ego passes, and who was ahead of it, is slower.
            _ if beside && sv_mps > 0.5 && (sv.movement == Some(Movement::Passing) || was_ahead) => {
                // Of an ego that slows, as fast as that is at the end: it came faster.
                let slower = if sv.slowed_from.is_some() { sv_mps } else { sv_mps - OTHER_PACE_MPS };
                let least = if self.comes_over_ahead() { sv_mps - OTHER_PACE_MPS } else { 0.0 };
                mps.max(least).min(slower.max(0.4))
            }
            _ if self.nears_ahead() => NEARED_MPS,
            _ if beside && self.drives_abreast() => sv_mps + SIDE_BY_SIDE_MPS,
            // Who turns beside an ego that turns is hardly faster.
            _ if beside && sv.turning != Turning::No && turning == sv.turning => sv_mps + ABREAST_MPS,
            // Who turns across from beside came up beside it, and slowed for its turn.
            _ if beside && matches!(turning, Turning::Left | Turning::Right) => {
                mps.max((sv_mps + OTHER_PACE_MPS).min(FASTEST_TURN_MPS))
            }
            Origin::Behind | Origin::Beside { .. }
                if sv.state != ContactState::Reversing && !self.cp.stood_first && !self.queues() =>
            {
                mps.max(sv_mps + OTHER_PACE_MPS)
            }
            // Who turns round ahead of it came along as fast as it.
            Origin::Ahead if sv_mps > 0.5 && turning == Turning::Round => mps.min(sv_mps),
            Origin::Ahead if sv_mps > 0.5 => mps.min((sv_mps - 2.0).max(0.3)),
            _ => mps,
        }
    }
}

impl Told {
    /// How fast somebody drives on a street there who is told to be fast. [m/s]
    pub(crate) fn fast_mps(&self) -> f64 {
        as_told(Some(Manner::Fast), 0.0, false, self.posted_mps)
    }
}

/// Who is told to be slow is no faster than this: in a lot, a garage, a driveway or an alley, and elsewhere. [m/s]
pub(crate) const SLOWLY_MPS: (f64, f64) = (2.0, 2.8);

/// Who is told to be fast drives so many times as fast as is posted, or as is usual where nothing is, and faster by so much at most.
/// [m/s]
const FAST_SHARE: f64 = 1.4;
const FASTER_BY_MPS: f64 = 9.0;
const FAST_MPS: (f64, f64) = (5.0, 11.2);

/// Who rides is no faster where told to be fast. [m/s]
const RIDES_FAST_MPS: f64 = 8.0;

/// The speed of who has no engine, and is told to be fast. [m/s]
fn fast_mps(side: &Side) -> Option<f64> {
    match side.kind {
        PartnerKind::Pedestrian => Some(RUNS_MPS),
        PartnerKind::Cyclist | PartnerKind::OtherNonMotorist => Some(RIDES_FAST_MPS),
        _ => None,
    }
    .filter(|_| side.manner == Some(Manner::Fast))
}

/// A usual speed at the contact, as far as words tell how fast somebody drove.
fn as_told(manner: Option<Manner>, usual_mps: f64, off_street: bool, posted_mps: Option<f64>) -> f64 {
    let of = |(lot, road): (f64, f64)| if off_street { lot } else { road };
    match manner {
        None => usual_mps,
        Some(Manner::Slow) => usual_mps.min(of(SLOWLY_MPS)),
        Some(Manner::Fast) => {
            let allowed_mps = posted_mps.unwrap_or(of(FAST_MPS));
            usual_mps.max((FAST_SHARE * allowed_mps).min(allowed_mps + FASTER_BY_MPS))
        }
    }
}

/// For sentences.
const fn manner_words(manner: Option<Manner>) -> &'static str {
    match manner {
        None => "",
        Some(Manner::Slow) => ", as it is told to be slow",
        Some(Manner::Fast) => ", as it is told to be fast",
    }
}

/// Who was in a queue behind the ego runs into it at this speed. [m/s]
const QUEUED_MPS: f64 = 4.0;

/// Who set off and slowed again was faster by so much between. [m/s]
pub(crate) const STARTS_AND_SLOWS_MPS: f64 = 3.0;

/// Who gained speed before the contact gained so much, at most half of it. [m/s]
pub(crate) const GAINS_MPS: f64 = 3.0;
