//! Beside the lanes: an ego that is parked stands at the kerb, who parks in reverse backs towards it, and who comes out of a stall or a
//! driveway begins behind it.

use crate::ground::Ground;
use crate::phases::Phase;
use crate::side::{self, Turning};
use crate::told::Told;
use crate::touch::{Staging, side_of, size_of};
use recrash_model::account::{
    Account, Act, ContactState, CrashType, LaneWord, LeftRight, Origin, Party, PlaceKind, RoadFeature, Source,
    StandReason,
};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::narrative::Side;
use recrash_model::rollout::{ActorState, ActorTrack, STEP_S};
use recrash_model::scenario::{Driveway, Place, StripKind};
use recrash_model::template::Movement;
use recrash_roads::{RoadPart, Scenario};

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
    /// Whether the ego stands at the kerb: it is parked, or is told to stand there or to have pulled over, and not to be in a lane.
    pub(crate) fn is_at_kerb(&self) -> bool {
        let stands = self.thing.is_some() && self.cp.state.stands();
        let parked = self.sv.state == ContactState::Parked || self.sv.came_to_park;
        let street = matches!(self.place, PlaceKind::Street | PlaceKind::Intersection | PlaceKind::Other);
        street && (parked || self.stops_at_kerb()) && !stands && !self.is_in_lane(true)
    }

    /// Whether one of the two is told to stand in a driving lane: by a word for the lane, double-parked, or passed by who takes the opposite
    /// side for it.
    fn is_in_lane(&self, of_ego: bool) -> bool {
        let (side, told) = if of_ego { (&self.sv, self.layout.sv) } else { (&self.cp, self.layout.cp) };
        // Who lets passengers in or out, and is passed, is in the way, but where words for the kerb tell otherwise.
        let boards = self.reasons.contains(&StandReason::PickupDropoff) && !told.at_kerb;
        let passes = self.cp.lane == Some(LaneWord::Opposing) || boards && self.cp.movement == Some(Movement::Passing);
        let passed = self.origin == Origin::Behind && passes && self.cp.state != ContactState::Reversing;
        side.lane.is_some_and(|lane| lane != LaneWord::Curb) || told.in_lane || of_ego && passed
    }

    /// Whether one that stands is told to do so beside the lanes of a street: parked, or at the kerb.
    pub(crate) fn stands_beside(&self, of_ego: bool) -> bool {
        let (side, told) = if of_ego { (&self.sv, self.layout.sv) } else { (&self.cp, self.layout.cp) };
        let street = matches!(self.place, PlaceKind::Street | PlaceKind::Intersection | PlaceKind::Other);
        let parked = side.state == ContactState::Parked || side.came_to_park || side.state.stands() && told.at_kerb;
        street && parked && !self.is_in_lane(of_ego) && (of_ego || self.thing.is_none())
    }

    /// Whether a partner that passes an ego at the kerb would come out from there: it came along the lane.
    pub(crate) fn swings_out(&self, ground: &Ground, turned: f64) -> bool {
        self.comes_along_kerb() && self.passes_from_behind() && ground.stands_m > 0.0 && turned > SWINGS_OUT_RAD
    }

    /// Whether a partner that is told to stand beside the lanes would stand in one, or askew.
    pub(crate) fn is_parked_otherwise(&self, ground: &Ground, cp: Pose) -> bool {
        let askew = math::sin(cp.heading).abs() > ASKEW && !self.diagonal;
        self.stands_beside(false) && (askew || ground.is_in_lanes(cp, 0.0, 0.0))
    }

    /// Whether an ego that stood at the kerb has just left it.
    pub(crate) fn leaves_kerb(&self) -> bool {
        let leaves = match self.sv.movement {
            Some(Movement::ChangingLanes | Movement::Merging | Movement::LaneDeparture) => true,
            Some(Movement::Straight | Movement::Passing) => self.sv.aside == Some(LeftRight::Left),
            _ => false,
        };
        let left = self.sv.aside != Some(LeftRight::Right);
        let moves =
            self.sv.state == ContactState::SettingOff || self.sv.state == ContactState::Moving && self.sv.stood_first;
        self.layout.sv.at_kerb && moves && leaves && left
    }

    /// Whether an ego that is not parked stopped at the kerb, and has not moved since.
    fn stops_at_kerb(&self) -> bool {
        let steps = self.sv.phases.first().is_none_or(|phase| *phase == Phase::Stands);
        let stops = self.sv.state == ContactState::Stopped && steps && self.sv.turning == Turning::No;
        let pulls_over =
            matches!(self.sv.stopped_aside, Some(Act::PullOver | Act::Park)) && self.origin != Origin::Opposite;
        let to_right = self.sv.aside != Some(LeftRight::Left);
        stops && to_right && (self.layout.sv.at_kerb || pulls_over)
    }

    /// Whether an ego that is told to have stood at the kerb from the start, and not to be passed from behind, stands there all the time.
    pub(crate) fn stays_at_kerb(&self) -> bool {
        let stood = self.sv.state == ContactState::Stopped && self.sv.stands_from_start && self.sv.phases.is_empty();
        stood && self.origin != Origin::Behind && self.is_at_kerb()
    }

    /// Whether who is told to stand beside the lanes does so: its middle is in no driving lane.
    pub(crate) fn stands_so(&self, of_ego: bool, scenario: &Scenario, at: &ActorState) -> bool {
        let network = scenario.network();
        let in_lane = network
            .lane_at(at.position(), at.heading)
            .is_some_and(|lane| !matches!(network.road(network.lane(lane).road).part, RoadPart::Beside(_)));
        !(self.stands_beside(of_ego) && in_lane)
    }

    /// Whether the partner reverses out of a stall or a driveway.
    pub(crate) fn backs_out(&self) -> bool {
        let beside = matches!(self.origin, Origin::Stall { .. } | Origin::Driveway { .. });
        beside && self.cp.state == ContactState::Reversing
    }
}

/// Who has turned out of the lane by more swings out. [rad]
const SWINGS_OUT_RAD: f64 = 0.02;

/// Sine of the angle to the road at which who is parked along it stands askew.
const ASKEW: f64 = 0.1;

/// Who drives beside the kerb until so long before the contact, with its flank by so much, comes from there. [s, m]
const BESIDE_S: f64 = 1.0;
const BESIDE_M: f64 = 0.3;

/// Whether somebody who comes along the lane beside which the ego is parked has driven where others park before it came to the ego.
pub(crate) fn comes_from_strip(scenario: &Scenario, track: &ActorTrack, until: usize) -> bool {
    let network = scenario.network();
    let flank_m = 0.5 * track.width_m - BESIDE_M;
    let before = until.saturating_sub((BESIDE_S / STEP_S) as usize);
    track.states[..before].iter().any(|state| {
        let flank = state.position() - Vec2::from_heading(state.heading).left() * flank_m;
        let lane = network.lane_at(flank, state.heading);
        lane.is_some_and(|lane| matches!(network.road(network.lane(lane).road).part, RoadPart::Beside(_)))
    })
}

impl Ground {
    /// Whether somebody of this width who stands here reaches into the lanes, by more than this.
    pub(crate) fn is_in_lanes(&self, at: Pose, width_m: f64, by_m: f64) -> bool {
        let (_, t_m) = self.beside(at.position);
        let edge_m = self.lane_edges_m[usize::from(t_m > 0.0)];
        t_m.abs() - 0.5 * width_m < edge_m - by_m
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
