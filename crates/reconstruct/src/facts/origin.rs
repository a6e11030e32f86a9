//! From where the partner is told to come, held against where it began.

use crate::facts::keeping::KEEPS_M;
use crate::told::crash::Told;
use crate::told::side::{Slant, Turning, is_on_foot};
use crate::usual::{LANE_M, STANDS_MPS};
use recrash_model::account::{ContactState, CrashType, LeftRight, Origin};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::rollout::{ActorState, ActorTrack, step_of};
use recrash_model::scenario::StripKind;
use recrash_model::template::Movement;
use recrash_roads::{RoadPart, Scenario};

/// Who is less aside than this is beside nobody. [m]
const ASIDE_M: f64 = 1.0;

/// Who is farther aside than this does not come along the ego's lane. [m]
const BESIDE_M: f64 = 5.0;

/// Who is told behind is no farther ahead. [m]
const BEHIND_MOST_M: f64 = 2.0;

/// Who comes along the opposite side behind the ego is not farther aside than this. [m]
const OPPOSITE_M: f64 = 8.5;

/// Who comes over from its own side, or from the kerb, is farther aside than this when it sets out. [m]
const OVER_M: f64 = 2.0;

/// Who turned off before it reversed is so much farther aside. [m]
const TURNED_OFF_M: f64 = 3.0;

pub(super) fn origin_words(told: &Told) -> String {
    let more = match (told.comes_over, told.comes_round, told.comes_across()) {
        _ if told.drives_abreast() => ", side by side",
        (true, ..) => ", on its own side",
        (_, true, _) => ", behind",
        (_, _, true) => ", across",
        _ => "",
    };
    told.origin.words() + more
}

/// Whether the partner comes from where it is told, seen from the ego when it sets out.
pub(super) fn origin(told: &Told, ego: &ActorTrack, other: &ActorTrack, time_s: f64) -> (bool, String) {
    let view = SetOut::of(told, ego, other, time_s);
    let shown = view.comes_from_there() && (!told.drives_abreast() || is_abreast(ego, other, time_s));
    let SetOut { ahead_m, left_m, facing_deg, .. } = view;
    let along = if ahead_m < 0.0 { "behind" } else { "ahead" };
    let aside = if left_m < 0.0 { "to the right" } else { "to the left" };
    let (ahead_m, left_m) = (ahead_m.abs(), left_m.abs());
    (shown, format!("{ahead_m:.0} m {along}, {left_m:.0} m {aside}, facing {facing_deg:.0} degrees"))
}

/// The partner, seen from the ego when it sets out.
struct SetOut<'a> {
    told: &'a Told,
    ego: &'a ActorTrack,
    other: &'a ActorTrack,
    /// It stood when the story begins.
    stood: bool,
    /// When it begins to back. [steps]
    backs: Option<usize>,
    ahead_m: f64,
    left_m: f64,
    /// How it faces, by how the ego does. [deg]
    facing_deg: f64,
    /// The same, by how the ego does when they touch; and whether it is behind where the ego is then. [deg]
    to_met_deg: f64,
    behind_met: bool,
}

/// Whether somebody at this angle goes across. [deg]
fn is_crosswise(angle_deg: f64) -> bool {
    (30.0..150.0).contains(&angle_deg.abs())
}

/// Whether somebody at this angle who goes across comes from a side. [deg]
fn comes_from(side: LeftRight, angle_deg: f64) -> bool {
    if side == LeftRight::Left { angle_deg < 0.0 } else { angle_deg > 0.0 }
}

/// Whether the partner turned off before it stood and reversed.
const fn turned_off(told: &Told) -> bool {
    matches!(told.cp.slants, Some(Slant::Stood { .. }))
}

impl<'a> SetOut<'a> {
    /// The two when the partner sets out, and where they touch.
    fn of(told: &'a Told, ego: &'a ActorTrack, other: &'a ActorTrack, time_s: f64) -> Self {
        let moves = other.states.iter().position(|state| !state.stands()).unwrap_or(0);
        // Of who backs into a space, or had turned off: when it begins to back.
        let backs = other.states.iter().position(|state| state.speed() < -STANDS_MPS);
        let sets_out = backs.filter(|_| told.cp.backs_in || turned_off(told)).unwrap_or(moves);
        let met = ego.at(step_of(time_s));
        let (own, state) = (ego.at(sets_out), &other.states[sets_out]);
        let forward = Vec2::from_heading(own.heading);
        let way = state.position() - own.position();
        Self {
            told,
            ego,
            other,
            stood: moves > 0,
            backs,
            ahead_m: way.dot(forward),
            left_m: forward.cross(way),
            facing_deg: math::wrap_angle(state.heading - own.heading).to_degrees(),
            to_met_deg: math::wrap_angle(state.heading - met.heading).to_degrees(),
            behind_met: (state.position() - met.position()).dot(Vec2::from_heading(met.heading)) < 0.0,
        }
    }

    /// Whether the partner reverses at the contact.
    fn reverses(&self) -> bool {
        self.told.cp.state == ContactState::Reversing
    }

    /// Whether it is on this side of the ego.
    fn is_beside(&self, side: LeftRight) -> bool {
        if side == LeftRight::Left { self.left_m > ASIDE_M } else { self.left_m < -ASIDE_M }
    }

    /// Whether it faces about as the ego does; across that, who comes across.
    fn faces_that_way(&self) -> bool {
        match self.told.comes_across() {
            true => is_crosswise(self.facing_deg),
            false => self.facing_deg.abs() < 60.0 || self.reverses(),
        }
    }

    /// Whether it comes from where it is told.
    fn comes_from_there(&self) -> bool {
        let (told, facing_deg) = (self.told, self.facing_deg);
        match told.origin {
            Origin::Behind => self.is_behind(),
            Origin::Ahead => self.is_ahead(),
            Origin::Opposite => facing_deg.abs() > 120.0 && (!told.comes_over || self.left_m > OVER_M),
            Origin::Beside { side } => {
                let along = facing_deg.abs() < 60.0 || told.comes_across();
                along && self.faces_that_way() && self.is_beside(side)
            }
            // Over the road that the ego turns into it comes from a side of that.
            Origin::Cross { side } if told.turns_over_walk().is_some() && comes_from(side, self.to_met_deg) => {
                is_crosswise(self.to_met_deg)
            }
            Origin::Cross { side } => {
                // Who reverses moves against where it faces.
                let backwards = || math::wrap_angle((facing_deg + 180.0).to_radians()).to_degrees();
                let moves_deg = if self.reverses() { backwards() } else { facing_deg };
                is_crosswise(moves_deg) && comes_from(side, moves_deg)
            }
            Origin::Stall { side }
            | Origin::Driveway { side }
            | Origin::Parked { side }
            | Origin::Sidewalk { side } => {
                side.is_none_or(|side| self.is_beside(side)) && self.comes_out() || told.cp.state.stands()
            }
            Origin::Above => false,
        }
    }

    /// Whether it comes along behind the ego.
    fn is_behind(&self) -> bool {
        let told = self.told;
        let lane_m = if told.leaves_opposite() { OPPOSITE_M } else { BESIDE_M };
        let in_line = !(told.begins_in_line() && told.is_beside_line(self.ego, self.other));
        // Who backs towards the ego begins behind its rear.
        let least_m = if told.backs_from_behind() { -0.5 * self.ego.length_m } else { BEHIND_MOST_M };
        self.ahead_m < least_m && self.faces_that_way() && self.left_m.abs() < lane_m && in_line
    }

    /// Whether it comes along, or stands, ahead of the ego.
    fn is_ahead(&self) -> bool {
        let told = self.told;
        let on_foot = is_on_foot(self.other.kind) && !told.comes_across();
        let faces = self.faces_that_way() || on_foot || told.cp.state.stands();
        let beside_m = BESIDE_M + if turned_off(told) { TURNED_OFF_M } else { 0.0 };
        // Who rolls back in line overlaps the ego when it begins to.
        let in_line = !told.backs_in_line() || self.backs.is_none_or(|step| overlaps(self.ego, self.other, step));
        self.ahead_m > -2.0 && faces && self.left_m.abs() < beside_m && in_line
    }

    /// Whether who stood beside the lanes, or backs out from there, comes out; who does so round the ego from behind it.
    fn comes_out(&self) -> bool {
        let told = self.told;
        let driveway = matches!(told.origin, Origin::Driveway { .. });
        let out = is_crosswise(self.facing_deg) || !(driveway || matches!(told.origin, Origin::Stall { .. }));
        // Who comes out of a driveway is behind the place where an ego stands then.
        let behind = self.ahead_m < 0.0 || told.sv.state.stands() && driveway && self.behind_met;
        !(told.stood_beside() || told.backs_out())
            || self.stood && self.left_m.abs() > OVER_M && out && (!told.comes_round || behind)
    }
}

/// Who drives side by side does so this long before the contact, and is no farther ahead or behind than their lengths and this. [s, m]
const ABREAST_S: f64 = 3.0;
const ABREAST_M: f64 = 1.0;

/// Whether two drive side by side before they touch.
fn is_abreast(ego: &ActorTrack, other: &ActorTrack, time_s: f64) -> bool {
    let step = ego.step_at(time_s - ABREAST_S);
    let (own, state) = (&ego.states[step], &other.states[step]);
    let along_m = Vec2::from_heading(own.heading).dot(state.position() - own.position()).abs();
    along_m < 0.5 * (ego.length_m + other.length_m) + ABREAST_M
}

/// Cosine of the angle to a lane at which somebody goes along it.
const ALONG: f64 = 0.7;

/// Whether somebody who comes over a crosswalk came along a lane for vehicles.
pub(super) fn comes_by_lane(told: &Told, scenario: &Scenario, other: &ActorTrack, time_s: f64) -> bool {
    let network = scenario.network();
    let until = other.step_at(time_s);
    let along = |state: &ActorState| {
        let lane = network.lane_at(state.position(), state.heading).map(|id| network.lane(id));
        lane.is_some_and(|lane| {
            let off = math::wrap_angle(lane.heading(lane.local(state.position()).0) - state.heading);
            network.road(lane.road).part == RoadPart::Open && math::cos(off).abs() > ALONG
        })
    };
    told.crosses_at_walk() && other.states[..=until].iter().step_by(10).any(along)
}

/// Who is longer than this has no room in a driveway. [m]
const LONG_M: f64 = 7.0;

/// Whether who comes out of a stall or a driveway began beside the one that is drawn for it.
pub(super) fn begins_elsewhere(told: &Told, scenario: &Scenario, other: &ActorTrack) -> bool {
    let (network, first) = (scenario.network(), other.states[0]);
    let comes_out = told.stood_beside() || told.backs_out();
    match told.origin {
        Origin::Stall { .. } if comes_out => {
            let stalls =
                |lane: &recrash_roads::Lane| network.road(lane.road).part == RoadPart::Beside(StripKind::Stalls);
            let mut rows = network.lanes.iter().filter(|lane| stalls(lane)).peekable();
            rows.peek().is_some() && !rows.any(|lane| lane.contains(first.position()))
        }
        Origin::Driveway { .. } if comes_out && other.length_m < LONG_M => {
            let mut drives = network.areas.iter().filter(|area| area.name.contains(".driveways[")).peekable();
            drives.peek().is_some() && !drives.any(|area| area.contains(first.position()))
        }
        _ => false,
    }
}

/// Whether somebody overlaps the ego across its way at a step.
fn overlaps(ego: &ActorTrack, other: &ActorTrack, step: usize) -> bool {
    let (own, state) = (ego.at(step), &other.states[step]);
    let aside_m = Vec2::from_heading(own.heading).cross(state.position() - own.position()).abs();
    aside_m < 0.5 * (ego.width_m + other.width_m)
}

/// Who is behind somebody is not abreast of it; and who is in the next lane is no farther aside. [m]
const BEHIND_M: f64 = 0.0;
const NEXT_M: f64 = 1.5 * LANE_M + KEEPS_M;

impl Told {
    /// Whether a partner that is told beside the ego, and in no farther lane, is farther off than the next one.
    pub(super) fn is_far_beside(&self, ego: &ActorTrack, track: &ActorTrack) -> bool {
        let (own, other) = (&ego.states[0], &track.states[0]);
        let aside_m = Vec2::from_heading(own.heading).cross(other.position() - own.position()).abs();
        let beside = matches!(self.origin, Origin::Beside { .. }) && self.comes_along_lanes();
        let aside = self.sv_aside().is_some();
        beside && !aside && (self.cp.lane.is_none() || self.sv.lane.is_none()) && !self.is_at_kerb() && aside_m > NEXT_M
    }

    /// Whether a partner that is told behind the ego is beside its lane, or ahead of it; or one that is told ahead of it beside its lane.
    pub(super) fn is_beside_line(&self, ego: &ActorTrack, track: &ActorTrack) -> bool {
        let sets_out = track.states.iter().position(|state| !state.stands()).unwrap_or(0);
        let (own, other) = (ego.at(sets_out), &track.states[sets_out]);
        let (forward, way) = (Vec2::from_heading(own.heading), other.position() - own.position());
        let overlap_m = 0.5 * (ego.width_m + track.width_m) - forward.cross(way).abs();
        self.is_in_line_ahead() && overlap_m < 0.0
            || self.is_in_line_behind() && (overlap_m < 0.0 || way.dot(forward) > BEHIND_M)
    }

    /// Whether the ego is told to have run into the rear of who was ahead of it, and nothing tells that this was in another lane.
    fn is_in_line_ahead(&self) -> bool {
        let straight = self.sv.turning == Turning::No && self.sv_aside().is_none();
        let stays = self.cp.lane.is_none() && self.cp.came_over.is_none() && !self.leaves_its_lane();
        let moved = self.cp.state != ContactState::Reversing && self.comes_along_lanes();
        self.origin == Origin::Ahead && self.crash_type == CrashType::FrontToRear && straight && stays && moved
    }

    /// Whether the partner is told to be behind the ego, and nothing tells that it was in another lane then.
    fn is_in_line_behind(&self) -> bool {
        let straight = !matches!(self.sv.turning, Turning::Left | Turning::Right);
        let other_lane = self.cp.lane.is_some() && !self.cp.lane_to_come
            || self.leaves_opposite()
            || self.cp.changed_lanes
            || self.cp.movement == Some(Movement::EnteringTraffic);
        self.origin == Origin::Behind
            && straight
            && !other_lane
            && self.sv_aside().is_none()
            && self.comes_along_lanes()
    }

    /// Whether the partner has to begin in the ego's lane: it is told to be behind, and not to have come by, or over, without a stand there.
    fn begins_in_line(&self) -> bool {
        let comes_by = matches!(
            self.cp.movement,
            Some(
                Movement::Passing
                    | Movement::ChangingLanes
                    | Movement::Merging
                    | Movement::CrossingIntoOpposingLane
                    | Movement::LaneDeparture
            )
        );
        let drives = self.cp.state != ContactState::Reversing;
        self.is_in_line_behind() && drives && (!comes_by || self.cp.stood_first) && !self.comes_along_kerb()
    }
}
