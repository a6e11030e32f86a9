//! What stands at the edge of the road: kerbs, walls, poles, bins that are told to stand beside it, and who is parked along it; and the ego
//! that comes too near, by its turn or by a drift.

use crate::came::sv_at_contact;
use crate::ground::{Ground, LANE_M};
use crate::pace::{Pace, ego_paces, when};
use crate::side::{Side, Turning};
use crate::things::{self, Lies};
use crate::told::{Aside, Told};
use crate::touch::{Staging, points, side_of, size_of, touch, zones_off};
use recrash_model::account::{
    Account, ContactState, CrashType, Kind, LaneWord, LeftRight, Origin, Party, PlaceKind, Source, told,
};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::math;
use recrash_model::rollout::ActorState;
use recrash_model::scenario::{Deed, Size, StripKind};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;
use recrash_roads::{RoadPart, Scenario};
use std::rc::Rc;

/// Length and width of what goes along the road, where the words for it do not say more. [m]
const ALONG: Size = Size { length_m: 8.0, width_m: 0.3 };

/// The same of a gate that is open. [m]
const OPEN_GATE: Size = Size { length_m: 4.0, width_m: 0.2 };

/// On which side of the ego's road the partner stands, at its edge.
pub(crate) fn side(account: &Account, sv: &Side, cp: &Side, lies: Option<Lies>, origin: Origin) -> Option<LeftRight> {
    let partner = account.partner.as_ref()?;
    let touched = side_of(&sv.zones).map(|side| if side > 0.0 { LeftRight::Left } else { LeftRight::Right });
    let beside = match origin {
        Origin::Beside { side } | Origin::Parked { side: Some(side) } => Some(side),
        _ => None,
    };
    // No pole stands in a lane.
    let usual = (told(&partner.kind) == Some(Kind::Pole)).then_some(LeftRight::Right);
    let side = beside.or(touched).or(sv.aside).or(usual)?;
    let drives = matches!(sv.state, ContactState::Moving | ContactState::SettingOff)
        && !matches!(
            sv.movement,
            Some(Movement::ChangingLanes | Movement::Merging | Movement::EnteringTraffic | Movement::UTurn)
        );
    let outermost = match sv.lane {
        None => true,
        Some(LaneWord::Right | LaneWord::RightTurn) => side == LeftRight::Right,
        Some(LaneWord::Left | LaneWord::LeftTurn) => side == LeftRight::Left,
        Some(_) => false,
    };
    let other_side = |of: Option<LeftRight>| of == Some(side.other());
    let fits = outermost && !other_side(touched) && !other_side(sv.aside);
    let by_its_rear = !sv.zones.is_empty() && sv.zones.iter().all(|zone| zone.is_rear());
    let there = lies.is_none() && stands_there(account, partner, (sv, cp), beside.is_some());
    (there && drives && fits && !by_its_rear).then_some(side)
}

/// Whether such a partner stands at the edge of the road.
fn stands_there(account: &Account, partner: &Party, (sv, cp): (&Side, &Side), beside: bool) -> bool {
    let Some(kind) = told(&partner.kind) else { return false };
    let words = |source: &Source| matches!(source, Source::Words { .. });
    let told_beside = beside && account.came_from.as_ref().is_some_and(|from| words(&from.source));
    match kind {
        _ if !cp.state.stands() => false,
        Kind::Curb => true,
        // Else it is ahead.
        Kind::Pole => true,
        Kind::Wall | Kind::Barrier => beside || !sv.zones.contains(&ContactZone::Front),
        Kind::Gate => beside,
        Kind::Object if things::is_fixed(partner) => true,
        Kind::Debris | Kind::Object | Kind::Sign | Kind::Cone | Kind::Cart => told_beside,
        _ => {
            let types = [CrashType::SingleVehicle, CrashType::Lateral, CrashType::Other];
            let type_fits = told(&account.crash_type).is_some_and(|kind| types.contains(&kind));
            kind.is_vehicle()
                && cp.state == ContactState::Parked
                && beside
                && type_fits
                && !is_parked_so(partner, "double")
        }
    }
}

/// Whether somebody is told to be parked in such a way.
fn is_parked_so(partner: &Party, word: &str) -> bool {
    let sources = [partner.kind.as_ref().map(|fact| &fact.source), partner.state.as_ref().map(|fact| &fact.source)];
    let acts = partner.acts.iter().map(|fact| &fact.source);
    sources.into_iter().flatten().chain(acts).any(|source| match source {
        Source::Words { text, .. } => text.to_lowercase().contains(word),
        _ => false,
    })
}

/// Whether the partner is told to be parked at an angle to the road.
pub(crate) fn is_diagonal(partner: &Party, cp: &Side) -> bool {
    cp.state == ContactState::Parked && is_parked_so(partner, "diagonal")
}

/// The size of what goes along the road.
pub(crate) fn size(kind: Option<Kind>) -> Option<Size> {
    match kind? {
        Kind::Curb | Kind::Wall | Kind::Barrier => Some(ALONG),
        Kind::Gate => Some(OPEN_GATE),
        _ => None,
    }
}

impl Told {
    /// Whether the partner is parked along the road at whose edge it stands.
    fn is_parked_along(&self) -> bool {
        self.edge.is_some() && self.thing.is_none()
    }

    /// What lies beside the outermost lane on the side where the partner stands.
    pub(crate) fn beside_edge(&self) -> Vec<StripKind> {
        let lot =
            matches!(self.place, PlaceKind::ParkingLot | PlaceKind::Garage | PlaceKind::Driveway | PlaceKind::Alley);
        let parks = self.is_parked_along() || self.sv.movement == Some(Movement::ParkingManeuver) && !lot;
        match (parks, self.place) {
            (true, _) if self.diagonal => vec![StripKind::Stalls, StripKind::Sidewalk],
            (true, _) => vec![StripKind::Parking, StripKind::Sidewalk],
            (false, PlaceKind::Highway) if self.sv.movement != Some(Movement::Straight) => vec![StripKind::Shoulder],
            (false, PlaceKind::Highway) => Vec::new(),
            (false, _) if lot => Vec::new(),
            (false, _) => vec![StripKind::Sidewalk],
        }
    }

    /// Whether the edge is that of a median, which parts the two directions.
    pub(crate) fn edge_is_median(&self) -> bool {
        let street = matches!(self.place, PlaceKind::Street | PlaceKind::Intersection | PlaceKind::Other);
        self.edge == Some(LeftRight::Left) && self.thing.is_some() && (street || self.sv.turning != Turning::No)
    }

    /// From the middle of the outermost lane to the partner's flank: behind the strip beside it, but a small thing stands in that; who is parked
    /// stands by the lane, or in the middle of its strip where the ego pulls over too. [m]
    fn edge_m(&self) -> f64 {
        let strip = self.beside_edge().first().copied().filter(|strip| strip.is_paved() && !self.edge_is_median());
        let strip_m = strip.map_or(0.0, StripKind::usual_width_m);
        let width_m = size_of(&self.cp).1;
        let on_strip_m = match (self.is_parked_along(), self.sv.movement) {
            (true, Some(Movement::ParkingManeuver)) => (0.5 * (strip_m - width_m)).max(0.0),
            (true, _) => 0.0,
            (false, _) if strip_m > 0.0 && !self.goes_along() => strip_m - width_m,
            (false, _) => strip_m,
        };
        0.5 * LANE_M + on_strip_m
    }

    /// Whether the partner is a thing that goes along the road.
    fn goes_along(&self) -> bool {
        self.thing.is_some() && size_of(&self.cp).0 > LONG_M
    }
}

/// What is longer goes along the road. [m]
const LONG_M: f64 = 2.5;

/// An ego that has stood, and driven no farther since, drifts by this share of it. [m]
const LEAST_DRIFT_M: f64 = 7.0;
const DRIFTS: f64 = 0.12;

/// No ego drifts by more to the contact. [m]
const FARTHEST_M: f64 = 5.0;

/// Ways in which the ego comes to the edge of its road and touches what stands there.
pub(crate) fn stagings(told: &Told, ground: &Ground, side: LeftRight) -> Vec<Staging> {
    // Seen from the ego's line to the right, and from what stands there to the flank that is nearer.
    let right = if side == LeftRight::Right { 1.0 } else { -1.0 };
    let (corner, within) = ((1.0, -right), (1.0, -0.75 * right));
    let flank_only = !told.sv.zones.is_empty() && !told.sv.zones.iter().any(|zone| zone.is_front());
    let in_passing = told.is_parked_along() && told.sv.movement != Some(Movement::ParkingManeuver);
    let sv_points = match told.goes_along() || in_passing || flank_only {
        true => vec![corner],
        false => vec![within, corner],
    };
    let mut found = Vec::new();
    let mut trial = 0;
    for sv_s_m in ground.places() {
        for &sv_point in &sv_points {
            let Some((ground, sv)) = drifted(told, ground, sv_s_m, sv_point, right * told.edge_m()) else { continue };
            let ground = Rc::new(ground);
            let along = ground.pose(ground.beside(at(told, sv, sv_point)).0, 0.0).heading;
            for &(turned, cp_point) in &ways(told, right) {
                trial += 1;
                let heading = math::wrap_angle(along + turned);
                let Some((cp, sv_seen, cp_seen)) = touch(told, sv, heading, sv_point, cp_point) else { continue };
                let cp_off = if told.thing.is_some() { 0 } else { zones_off(&told.cp.zones, cp_seen) };
                let cost = (zones_off(&told.sv.zones, sv_seen) + cp_off, trial);
                found.push(Staging {
                    ground: Rc::clone(&ground),
                    sv_s_m,
                    sv,
                    cp,
                    cp_came: heading,
                    bend: None,
                    cp_follows_m: None,
                    door: None,
                    cost,
                });
            }
        }
    }
    found
}

/// Speeds in a turn to what is met at the end of it, changes of speed, and how long somebody is seen before it sets off. [m/s, m/s^2, s]
const TURNS_MPS: [f64; 4] = [3.0, 4.0, 5.0, 6.0];
const GAINS_MPS2: f64 = 1.6;
const SLOWS_MPS2: f64 = 1.5;
const SEEN_S: f64 = 1.0;

/// Who turns to what it meets at the edge of the road that it enters, or across it, and is slow there, has been faster in its turn: it comes along, or
/// from its stop line where it stood.
pub(crate) fn slows_in_turn(told: &Told, past_line_m: Option<f64>) -> Option<Pace> {
    let (sv, end_s) = (&told.sv, told.contact_s);
    let turns = (told.edge.is_some() || told.stands_across() || told.at_entrance)
        && matches!(sv.turning, Turning::Left | Turning::Right);
    let line_m = past_line_m.filter(|_| turns && sv.state == ContactState::Moving && sv.phases.is_empty())?;
    let slows = |from_mps: f64| {
        let over_s = (from_mps - sv.speed_mps) / SLOWS_MPS2;
        let brake = when(end_s - over_s, Deed::Speed { to_mps: sv.speed_mps, rate_mps2: SLOWS_MPS2 });
        (over_s, 0.5 * (from_mps + sv.speed_mps) * over_s, brake)
    };
    let faster = TURNS_MPS.into_iter().filter(|mps| *mps > sv.speed_mps);
    if !sv.stood_first {
        if sv.speed_mps * end_s > line_m {
            return None;
        }
        return faster.into_iter().find_map(|from_mps| {
            let (over_s, over_m, brake) = slows(from_mps);
            let driven_m = from_mps * (end_s - over_s) + over_m;
            (driven_m > line_m).then(|| Pace { speed_mps: from_mps, acts: vec![brake], driven_m })
        });
    }
    faster.into_iter().find_map(|most_mps| {
        let (over_s, over_m, brake) = slows(most_mps);
        let gaining_s = most_mps / GAINS_MPS2;
        let holds_m = line_m - over_m - 0.5 * most_mps * gaining_s;
        let from_s = end_s - over_s - gaining_s - holds_m / most_mps;
        let go = when(from_s, Deed::Speed { to_mps: most_mps, rate_mps2: GAINS_MPS2 });
        (holds_m > 0.0 && from_s > SEEN_S).then(|| Pace { speed_mps: 0.0, acts: vec![go, brake], driven_m: line_m })
    })
}

/// How the partner may face, against the road, and where it may be touched; `near`: its flank that is nearer to the ego, where it faces as the
/// road goes. [rad]
fn ways(told: &Told, near: f64) -> Vec<(f64, (f64, f64))> {
    if told.diagonal {
        // Its rear to the road, and the corner of it that is nearest.
        return vec![(-0.25 * math::PI * near, (-1.0, near)), (-0.75 * math::PI * near, (-1.0, -near))];
    }
    if told.goes_along() {
        return [-0.5, 0.0, 0.5].map(|along| (0.0, (along, near))).to_vec();
    }
    if !told.is_parked_along() {
        return vec![(0.0, (-1.0, near))];
    }
    let zones = if told.cp.zones.is_empty() { &ContactZone::ALL[..8] } else { &told.cp.zones[..] };
    let on_flank = [(0.0, near), (math::PI, -near)].into_iter().flat_map(|(turned, near)| {
        let at = zones.iter().flat_map(|zone| points(*zone)).copied();
        at.filter(move |point| point.1 * near > 0.9).map(move |point| (turned, point))
    });
    let corners = [(0.0, near), (math::PI, -near)]
        .into_iter()
        .flat_map(|(turned, near)| [-1.0, 1.0].map(|end| (turned, (end, near))));
    on_flank.chain(corners).collect()
}

/// A point of the ego's outline, in shares of half of its length and width.
fn at(told: &Told, sv: Pose, point: (f64, f64)) -> Vec2 {
    let (length_m, width_m) = size_of(&told.sv);
    OrientedBox::new(sv, length_m, width_m).to_world(Vec2::new(point.0 * 0.5 * length_m, point.1 * 0.5 * width_m))
}

/// The ground with the drift that brings a point of the ego to a line beside its own at the contact, and where the ego is then.
fn drifted(told: &Told, ground: &Ground, sv_s_m: f64, point: (f64, f64), line_m: f64) -> Option<(Ground, Pose)> {
    let pace = ego_paces(told, ground, sv_s_m).1;
    // Who stood shortly before stands beside its line already.
    let stood = pace.speed_mps == 0.0 && pace.driven_m < LEAST_DRIFT_M;
    let by_m = (line_m.signum() * DRIFTS * pace.driven_m, 1.0);
    let mut to_t_m = 2.0 * (line_m + point.1 * 0.5 * size_of(&told.sv).1);
    for _ in 0..12 {
        let (by_m, gain) = if stood { by_m } else { (to_t_m, 1.4) };
        let ground = ground.drifting(Aside { from_t_m: to_t_m - by_m, to_t_m, done: false, back: false });
        let sv = sv_at_contact(told, &ground, sv_s_m)?;
        let off_m = line_m - ground.beside(at(told, sv, point)).1;
        if off_m.abs() < 0.005 {
            return Some((ground, sv));
        }
        to_t_m += gain * off_m;
        if to_t_m.abs() > 2.0 * FARTHEST_M {
            return None;
        }
    }
    None
}

/// What stands at the edge reaches no farther into a lane. [m]
const INTO_LANE_M: f64 = 0.15;

/// What goes along the road is at no greater angle to it, and who is told to be parked diagonally at no smaller one. [deg]
const ALONG_DEG: f64 = 15.0;

pub(crate) fn words(side: LeftRight) -> String {
    let side = if side == LeftRight::Left { "left" } else { "right" };
    format!("at the edge of the road, on the {side}")
}

/// Whether what the ego touches stands at the edge of the road that it is on, on the told side, and along it where it is long.
pub(crate) fn check(
    told: &Told,
    side: LeftRight,
    scenario: &Scenario,
    ego: &ActorState,
    other: &OrientedBox,
) -> (bool, String) {
    let network = scenario.network();
    let left = Vec2::from_heading(ego.heading).cross(other.centre - ego.position()) > 0.0;
    let seen_on = if left { LeftRight::Left } else { LeftRight::Right };
    let part = |point: Vec2| network.lane_at(point, ego.heading).map(|lane| network.road(network.lane(lane).road).part);
    let (long_m, wide_m) = ((other.half_length - INTO_LANE_M).max(0.0), (other.half_width - INTO_LANE_M).max(0.0));
    let shares = || [-1.0, -0.5, 0.0, 0.5, 1.0].into_iter();
    let within = shares().flat_map(|x| shares().map(move |y| Vec2::new(x * long_m, y * wide_m)));
    let in_lane = within
        .map(|local| part(other.to_world(local)))
        .any(|part| part.is_some_and(|part| !matches!(part, RoadPart::Beside(_))));
    let road = network.lane_at(ego.position(), ego.heading).map(|lane| {
        let lane = network.lane(lane);
        lane.heading(lane.local(ego.position()).0)
    });
    let angle = road.map_or(0.0, |road| {
        let angle = math::wrap_angle(math::atan2(other.axis.y, other.axis.x) - road).to_degrees().abs();
        angle.min(180.0 - angle)
    });
    let along = 2.0 * other.half_length < LONG_M || (angle <= ALONG_DEG) != told.diagonal;
    let place = if in_lane { "in a lane" } else { "beside the lanes" };
    let seen = format!("{place}, on the {}, at {angle:.0} degrees to the road", if left { "left" } else { "right" });
    (seen_on == side && !in_lane && along, seen)
}
