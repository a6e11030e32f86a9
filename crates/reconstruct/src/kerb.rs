//! Beside the lanes: an ego that is parked stands at the kerb, who parks in reverse backs towards it, and who comes out of a stall or a
//! driveway begins behind it.

use crate::ground::Ground;
use crate::phases::Phase;
use crate::side;
use crate::told::Told;
use crate::touch::{Staging, side_of, size_of};
use recrash_model::account::{
    Account, Act, ContactState, CrashType, LaneWord, LeftRight, Origin, Party, PlaceKind, RoadFeature, Source,
};
use recrash_model::math;
use recrash_model::narrative::Side;
use recrash_model::scenario::{Driveway, Place, StripKind};
use recrash_model::template::Movement;

/// Angles of who backs into a space at the kerb, to the road; its rear points to the kerb. [deg]
const BACKS_IN_DEG: [f64; 7] = [25.0, 30.0, 20.0, 35.0, 12.0, 5.0, 0.0];

/// How far somebody has backed into a space at the kerb at the contact. [m]
pub(crate) const BACKS_IN_M: f64 = 7.5;

/// Nobody backs farther, or drives farther out of a driveway. [m]
const FARTHEST_M: f64 = 14.0;

/// Whether the partner is told to have backed into a space at the kerb, ahead of the ego or behind it.
pub(crate) fn backs_in(partner: &Party, state: ContactState, origin: Origin, place: PlaceKind) -> bool {
    let at_kerb = matches!(place, PlaceKind::Street | PlaceKind::Intersection | PlaceKind::Other);
    let along = matches!(origin, Origin::Ahead | Origin::Behind);
    at_kerb && along && state == ContactState::Reversing && partner.did(Act::Park)
}

/// What somebody did who backed into a space: it came along, stood beside it, and reversed.
pub(crate) const BACKED_IN: [Phase; 3] = [Phase::Drives, Phase::Stands, Phase::Reverses];

/// Headings of who backs into a space on the right. [rad]
pub(crate) fn headings() -> impl Iterator<Item = (f64, f64)> {
    BACKS_IN_DEG.into_iter().map(|degrees| (0.0, degrees * math::PI / 180.0))
}

/// Out of which stall somebody backs of whom nobody says from where it came, where the place has stalls beside the road.
pub(crate) fn out_of_stall(
    account: &Account,
    crash_type: CrashType,
    sv: &side::Side,
    cp: &side::Side,
) -> Option<Origin> {
    let stalls = account.place.features.iter().any(|feature| feature.value == RoadFeature::Stall);
    let backs = crash_type == CrashType::Backing && cp.state == ContactState::Reversing;
    let side = side_of(&sv.zones).filter(|_| stalls && backs)?;
    Some(Origin::Stall { side: Some(if side > 0.0 { LeftRight::Left } else { LeftRight::Right }) })
}

/// Whether somebody who pulled out is told to have done so from a driveway.
pub(crate) fn leaves_driveway(partner: &Party) -> bool {
    let driveway = |source: &Source| match source {
        Source::Words { text, .. } => text.to_lowercase().contains("driveway"),
        _ => false,
    };
    partner.acts.iter().any(|fact| fact.act == Act::PullOut && !fact.after_contact && driveway(&fact.source))
}

impl Told {
    /// Whether the ego is parked at the kerb. Whom somebody from behind has to go round is in its lane.
    pub(crate) fn is_at_kerb(&self) -> bool {
        let goes_round = self.cp.lane == Some(LaneWord::Opposing) || self.cp.movement == Some(Movement::Passing);
        let in_the_way = self.origin == Origin::Behind && goes_round && self.cp.state != ContactState::Reversing;
        let on_lane = self.sv.lane.is_some_and(|lane| lane != LaneWord::Curb);
        let stands = self.thing.is_some() && self.cp.state.stands();
        (self.sv.state == ContactState::Parked || self.sv.came_to_park) && !stands && !on_lane && !in_the_way
    }

    /// Whether the partner reverses out of a stall or a driveway.
    pub(crate) fn backs_out(&self) -> bool {
        let beside = matches!(self.origin, Origin::Stall { .. } | Origin::Driveway { .. });
        beside && self.cp.state == ContactState::Reversing
    }
}

/// Width of a driveway, and how far it reaches behind the kerb. [m]
const DRIVEWAY_M: (f64, f64) = (7.0, 9.0);

/// The driveway where a partner begins that comes out of one, beside the road that the ego is on.
pub(crate) fn driveway(told: &Told, ground: &Ground, begins: &Place) -> Option<Driveway> {
    let Place::Plane { x_m, y_m, .. } = *begins else { return None };
    let there = matches!(told.origin, Origin::Driveway { .. }) && !ground.junction && told.place != PlaceKind::Highway;
    let side = if y_m > 0.0 { Side::Left } else { Side::Right };
    there.then(|| Driveway { side, s_m: x_m + ground.begins_m(), width_m: DRIVEWAY_M.0, depth_m: DRIVEWAY_M.1 })
}

/// How far somebody has come at the contact who began in a stall or in a driveway, behind the kerb. [m]
pub(crate) fn out_m(told: &Told, staging: &Staging) -> f64 {
    let strip_m = StripKind::Parking.usual_width_m();
    let (half_m, position) = (0.5 * size_of(&told.cp).0, staging.cp.position);
    // It came from the side to which it faces, of who reverses.
    let gear = if told.cp.state == ContactState::Reversing { 1.0 } else { -1.0 };
    let sine = gear * math::sin(staging.cp_came);
    let lane_edge_m = staging.ground.kerbs_m[usize::from(sine < 0.0)] - 0.5 * strip_m;
    let begins_m = match told.origin {
        Origin::Stall { .. } => lane_edge_m + half_m,
        _ => lane_edge_m + strip_m + half_m,
    };
    let aside_m = begins_m - position.y * sine.signum();
    (aside_m / sine.abs().max(0.3)).clamp(0.0, FARTHEST_M)
}
