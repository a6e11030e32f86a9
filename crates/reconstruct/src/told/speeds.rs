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
            PlaceKind::ParkingLot | PlaceKind::Garage | PlaceKind::Driveway | PlaceKind::Alley => 5.0,
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
        let (driven_mps, slides) = (self.driven_mps(), self.is_sliding());
        // Who came up to one that was ahead beside its line, and hardly moves, came faster.
        let beside_ahead = matches!(self.origin, Origin::Beside { .. }) && self.ahead == Some(true);
        let creeps = self.sv.impact_mps.is_some_and(|mps| mps <= CREEPS_MPS) && self.sv.state == ContactState::Moving;
        let neared = beside_ahead && creeps && self.sv.turning == Turning::No && !self.sv.stood_first;
        let neared = neared && self.cp.turning == Turning::No && self.cp.state == ContactState::Moving;
        if neared && self.sv.phases.is_empty() {
            self.sv.slowed_from = self.sv.slowed_from.or(Some(Slowed(None)));
        }
        let (crosses, all_way) = (matches!(self.origin, Origin::Cross { .. }), self.all_way);
        let usual = |side: &Side| match side.state {
            ContactState::Stopped | ContactState::Parked => 0.0,
            // It has come from its line.
            ContactState::SettingOff if (side.control.is_some() || side.enters() || all_way) && crosses => 4.0,
            ContactState::SettingOff => 1.5,
            ContactState::Reversing => 1.2,
            ContactState::Moving if side.kind == PartnerKind::Pedestrian => WALKS_MPS,
            ContactState::Moving if side.is_slow() => 3.0,
            ContactState::Moving if side.stood_first => 4.0,
            ContactState::Moving => match side.kind {
                PartnerKind::Pedestrian => WALKS_MPS,
                PartnerKind::Animal => 4.0,
                PartnerKind::FixedObject if slides => SLIDES_MPS,
                PartnerKind::OtherNonMotorist if size_of(side).0 <= ROBOT_M => WALKS_MPS,
                PartnerKind::Cyclist | PartnerKind::OtherNonMotorist => 4.5,
                _ if side.turning != Turning::No => TURNS_MPS,
                _ => driven_mps,
            },
        };
        let slow = matches!(self.place, PlaceKind::ParkingLot | PlaceKind::Garage | PlaceKind::Driveway);
        let fit = |speed: f64| if slow { speed.min(3.0) } else { speed };
        self.sv.speed_mps = match (self.sv.impact_mps, self.sv.state.stands()) {
            (_, true) => 0.0,
            (Some(told), false) => told.max(SLOWEST_MPS),
            (None, false) => {
                let stops = self.sv.acts.last().is_some_and(Doing::is_begun_stop);
                let slowed_mps = self.sv.slowed_from.and_then(|slowed| slowed.0).unwrap_or(f64::INFINITY);
                as_told(self.sv.manner, fit(usual(&self.sv)), slow, self.posted_mps).min(if stops {
                    slowed_mps.min(STOPS_MPS)
                } else {
                    slowed_mps
                })
            }
        };
        self.sv.speed_mps = self.sv.speed_mps.min(self.overtaken_mps());
        self.cp.speed_mps = match (self.cp.impact_mps, self.cp.state.stands()) {
            // It is thrown at the ego.
            _ if self.is_thrown() => THROWN_MPS,
            (_, true) => 0.0,
            (Some(told), false) => told.max(SLOWEST_MPS),
            (None, false) if self.queues() => fit(QUEUED_MPS),
            (None, false) if let Some(mps) = fast_mps(&self.cp) => mps,
            (None, false) => as_told(self.cp.manner, fit(usual(&self.cp)), slow, self.posted_mps),
        };
        // Who sets off behind an ego that moves is faster.
        let sets_off = self.cp.state == ContactState::SettingOff || self.queues();
        if self.cp.impact_mps.is_none() && sets_off && self.origin == Origin::Behind {
            self.cp.speed_mps = self.cp.speed_mps.max(self.sv.speed_mps + SETS_OFF_FASTER_MPS);
        }
        // So is who set off behind an ego that slowed again: as fast as that was between.
        let waits = self.cp.stood_first || sets_off;
        let slowed = self.sv.stood_first && self.sv.slowed_from.is_some();
        if self.cp.impact_mps.is_none() && self.origin == Origin::Behind && waits && slowed {
            self.cp.speed_mps = self.cp.speed_mps.max(self.sv.speed_mps + STARTS_AND_SLOWS_MPS);
        }
        if self.cp.impact_mps.is_none() && self.cp.state == ContactState::Moving && !self.comes_across() {
            let sv = self.sv.speed_mps;
            match self.origin {
                // Whom the ego passes, and who was ahead of it, is slower.
                Origin::Beside { .. }
                    if sv > 0.5
                        && (self.sv.movement == Some(Movement::Passing)
                            || self.ahead == Some(true) && self.cp.turning == Turning::No) =>
                {
                    // Of an ego that slows, as fast as that is at the end: it came faster.
                    let slower = if self.sv.slowed_from.is_some() { sv } else { sv - OTHER_PACE_MPS };
                    let least = if self.comes_over_ahead() { sv - OTHER_PACE_MPS } else { 0.0 };
                    self.cp.speed_mps = self.cp.speed_mps.max(least).min(slower.max(0.4));
                }
                Origin::Beside { .. } if neared => self.cp.speed_mps = NEARED_MPS,
                Origin::Beside { .. } if self.drives_abreast() && self.cp.impact_mps.is_none() => {
                    self.cp.speed_mps = sv + SIDE_BY_SIDE_MPS
                }
                // Who turns beside an ego that turns is hardly faster.
                Origin::Beside { .. } if self.sv.turning != Turning::No && self.cp.turning == self.sv.turning => {
                    self.cp.speed_mps = sv + ABREAST_MPS;
                }
                // Who turns across from beside came up beside it, and slowed for its turn.
                Origin::Beside { .. } if matches!(self.cp.turning, Turning::Left | Turning::Right) => {
                    self.cp.speed_mps = self.cp.speed_mps.max((sv + OTHER_PACE_MPS).min(FASTEST_TURN_MPS));
                }
                Origin::Behind | Origin::Beside { .. }
                    if self.sv.state != ContactState::Reversing && !self.cp.stood_first && !self.queues() =>
                {
                    self.cp.speed_mps = self.cp.speed_mps.max(sv + OTHER_PACE_MPS);
                }
                // Who turns round ahead of it came along as fast as it.
                Origin::Ahead if sv > 0.5 && self.cp.turning == Turning::Round => {
                    self.cp.speed_mps = self.cp.speed_mps.min(sv);
                }
                Origin::Ahead if sv > 0.5 => self.cp.speed_mps = self.cp.speed_mps.min((sv - 2.0).max(0.3)),
                _ => {}
            }
        }
        // Who backs towards an ego that backs away is faster.
        let both_back = self.cp.state == ContactState::Reversing && self.sv.state == ContactState::Reversing;
        if self.cp.impact_mps.is_none() && both_back && self.origin == Origin::Ahead {
            self.cp.speed_mps = self.cp.speed_mps.max(self.sv.speed_mps + BACKS_FASTER_MPS);
        }
        self.cp.speed_mps = self.dropped_mps().unwrap_or(self.cp.speed_mps);
        if self.cp.impact_mps.is_none() && self.gives_way_to_merge {
            self.cp.speed_mps = MERGES_MPS;
        }
        // Who gained speed came at the usual one.
        if self.cp.impact_mps.is_none() && self.cp.gains {
            self.cp.speed_mps += GAINS_MPS;
        }
        if self.cp.impact_mps.is_none() && !self.is_thrown() {
            self.cp.speed_mps *= self.choices.partner_speed;
        }
        if self.sv.impact_mps.is_none() && !self.sv.state.stands() {
            self.assumed.push(format!("the ego's speed at the contact: {:.1} m/s", self.sv.speed_mps));
        }
        if self.cp.impact_mps.is_none() && !self.cp.state.stands() {
            let words = manner_words(self.cp.manner);
            self.assumed.push(format!("the partner's speed at the contact: {:.1} m/s{words}", self.cp.speed_mps));
        }
    }
}

impl Told {
    /// How fast somebody drives on a street there who is told to be fast. [m/s]
    pub(crate) fn fast_mps(&self) -> f64 {
        as_told(Some(Manner::Fast), 0.0, false, self.posted_mps)
    }
}

/// Who is told to be slow is no faster than this: in a lot, a garage or a driveway, and elsewhere. [m/s]
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
fn as_told(manner: Option<Manner>, usual_mps: f64, in_lot: bool, posted_mps: Option<f64>) -> f64 {
    let of = |(lot, road): (f64, f64)| if in_lot { lot } else { road };
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
