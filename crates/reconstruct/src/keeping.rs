//! Whether a partner keeps a lane of its own direction until it leaves it for what is told of it, and drives as a vehicle can.

use crate::acts::Doing;
use crate::came::{TIGHTEST_M, WHEELED_M};
use crate::extras::STANDS_MPS;
use crate::ground::LANE_M;
use crate::lateral::is_on_foot;
use crate::side::Turning;
use crate::strips::strip_of;
use crate::told::Told;
use recrash_model::account::{ContactState, LaneWord, Origin};
use recrash_model::geometry::Vec2;
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{ActorState, ActorTrack, STEP_S};
use recrash_model::scenario::StripKind;
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{RoadPart, Scenario};

/// Who keeps its lane is no farther beside its middle; who is narrow, where its box stays in the lane. [m]
const KEEPS_M: f64 = 0.7;

/// Who is told to leave its lane may be on its way out of it for so long before the contact; who is not told to, comes to the told zones in
/// the last of its way. Who comes out of the ego's lane to pass goes along between two before. [s]
const LEAVES_S: f64 = 3.0;
const PASSES_S: f64 = 5.0;
const NEARS_S: f64 = 2.0;

/// Between lanes somebody who leaves its own is at more than this to them. [rad]
const CHANGES_RAD: f64 = 0.04;

/// A lane leads no farther from somebody's way. [rad]
const ALONG_RAD: f64 = 0.8;

/// Its way is looked at in steps of this. [steps, s]
const EVERY: usize = 5;
const EVERY_S: f64 = 0.5;

impl Told {
    /// Whether the partner drives along lanes until it touches, or leaves them: none of who walks, stands from the start, or comes out of
    /// what is beside them.
    pub(crate) fn comes_along_lanes(&self) -> bool {
        let along = matches!(
            self.origin,
            Origin::Behind | Origin::Ahead | Origin::Beside { .. } | Origin::Opposite | Origin::Cross { .. }
        );
        let drives = !is_on_foot(self.cp.kind) && !matches!(self.cp.kind, PartnerKind::FixedObject);
        along && drives && self.thing.is_none() && self.cp.state != ContactState::Parked && !self.comes_across()
    }

    /// Whether the partner is told to have gone aside before the contact: turned, changed lanes, drifted, passed, pulled out or parked.
    pub(crate) fn leaves_its_lane(&self) -> bool {
        let cp = &self.cp;
        let goes_on = cp.movement.is_none_or(|movement| {
            matches!(movement, Movement::Straight | Movement::Stopped | Movement::Backing | Movement::WrongWay)
        });
        !goes_on
            || cp.turning != Turning::No
            || cp.dodges
            || cp.slants.is_some()
            || cp.backs_in
            || self.comes_over
            || self.comes_along_kerb()
            || cp.acts.iter().any(Doing::is_aside)
    }

    /// Whether the partner drives along a lane, and nothing is told that takes it out of that.
    pub(crate) fn keeps_its_lane(&self) -> bool {
        let along_turn =
            self.sv.turning != Turning::No && !matches!(self.origin, Origin::Opposite | Origin::Cross { .. });
        let drives = self.cp.state != ContactState::Reversing;
        self.comes_along_lanes() && !self.leaves_its_lane() && drives && !along_turn && !self.is_thrown()
    }

    /// Whether the partner is told to have driven where no lane of its direction is.
    pub(crate) fn drives_elsewhere(&self) -> bool {
        self.cp.movement == Some(Movement::WrongWay) || self.cp.lane == Some(LaneWord::Opposing)
    }
}

/// For how long the partner is in no lane of its direction before it leaves its own for what is told; nothing of who does not come along
/// lanes. [s]
pub(crate) fn off_lane_s(told: &Told, scenario: &Scenario, track: &ActorTrack, contact_s: f64) -> Option<f64> {
    if !told.comes_along_lanes() || told.drives_elsewhere() || told.pulls_out_opposite() {
        return None;
    }
    let leaves = told.leaves_its_lane();
    let last_s = match leaves {
        true if told.passes_from_behind() => PASSES_S,
        true => LEAVES_S,
        false => NEARS_S,
    };
    let until_s = contact_s - last_s;
    let until = ((until_s / EVERY_S).floor().max(0.0) as usize * EVERY).min(track.states.len() - 1);
    let off = |state: &&ActorState| state.speed() > -STANDS_MPS && is_off(told, scenario, track, state, leaves);
    // Who has turned out of its road is in no lane of that any more.
    let first = track.states[0].heading;
    let on_road = |state: &&ActorState| !leaves || math::wrap_angle(state.heading - first).abs() < ALONG_RAD;
    let steps = track.states[..=until].iter().step_by(EVERY).take_while(on_road).filter(off).count();
    Some(EVERY_S * steps as f64)
}

/// Whether somebody is in no lane of its direction there. Nobody has to keep one in a junction, nor between two that it changes.
fn is_off(told: &Told, scenario: &Scenario, track: &ActorTrack, state: &ActorState, leaves: bool) -> bool {
    let network = scenario.network();
    let strip = told.cp.lane.and_then(strip_of);
    let narrow = track.width_m < 1.2;
    let mut off = true;
    for lane in &network.lanes {
        let (s_m, t_m) = lane.local(state.position());
        if !(0.0..=lane.length_m).contains(&s_m) || t_m.abs() > 0.5 * lane.width_at(s_m) {
            continue;
        }
        let across_rad = math::wrap_angle(lane.heading(s_m) - state.heading).abs();
        let most_m = KEEPS_M.max(0.5 * (lane.width_at(s_m) - track.width_m));
        let may = match network.road(lane.road).part {
            RoadPart::Inner => return false,
            RoadPart::Beside(kind) => {
                strip == Some(kind) || narrow && matches!(kind, StripKind::Bike | StripKind::Shoulder)
            }
            _ => true,
        };
        let changes = leaves && (CHANGES_RAD..ALONG_RAD).contains(&across_rad);
        if may && across_rad < ALONG_RAD && (t_m.abs() <= most_m || changes) {
            off = false;
        }
    }
    off
}

/// Who is not told to leave its lane goes aside by no more, and turns by no more; and who is not told to swerve or turn feels no more sideways.
/// [m, rad, m/s^2]
const ASIDE_M: f64 = 0.5;
const TURNS_RAD: f64 = 0.26;
const SIDEWAYS_MPS2: f64 = 3.0;

/// Who comes from beside, and is not told to have left its lane, comes no farther over; nobody turns one way and back the other by more who is
/// not told to go aside; and who rolls back in line is at no more to the road. [m, rad, rad]
const OVER_M: f64 = 0.5 * LANE_M;
const BACK_RAD: f64 = 0.35;
const ASKEW_RAD: f64 = 0.09;

/// What nobody would take for driving straight on is worse than a step from the told zones. [half seconds]
pub(crate) const ABSURD: usize = 4;

/// In how many ways the partner weaves or swerves that nobody tells of.
pub(crate) fn weaves(told: &Told, track: &ActorTrack, contact_s: f64) -> usize {
    if !told.comes_along_lanes() || told.cp.turning != Turning::No || told.is_thrown() {
        return 0;
    }
    let until = ((contact_s / STEP_S) as usize).min(track.states.len() - 1);
    let (first, last) = (&track.states[0], &track.states[until]);
    let along = Vec2::from_heading(first.heading);
    let aside_m = |state: &ActorState| along.cross(state.position() - first.position()).abs();
    let aside_m = track.states[..=until].iter().map(aside_m).fold(0.0, f64::max);
    let turned = math::wrap_angle(last.heading - first.heading).abs();
    let beside = matches!(told.origin, Origin::Beside { .. });
    let stays = !told.leaves_its_lane() || told.comes_straight_by() || told.passes_in_own_lane();
    let sideways = |pair: &[ActorState]| {
        let rate = math::wrap_angle(pair[1].heading - pair[0].heading).abs() / STEP_S;
        rate * pair[0].velocity().length()
    };
    // Whose rear touches swings it out, or cuts in.
    let rear = told.cp.zones.iter().any(|zone| zone.is_rear());
    let swerves = !rear
        && !told.cp.stood_first
        && !told.cp.acts.iter().any(Doing::is_swerve)
        && track.states[..=until].windows(2).any(|pair| sideways(pair) > SIDEWAYS_MPS2);
    let few = [stays && !beside && aside_m > ASIDE_M, swerves].into_iter().filter(|is| *is).count();
    let turns = track.states[..=until].windows(2).map(|pair| math::wrap_angle(pair[1].heading - pair[0].heading));
    let (all, net) = turns.fold((0.0, 0.0), |(all, net), turn| (all + turn.abs(), net + turn));
    let backs = told.cp.state == ContactState::Reversing;
    let absurd = [
        stays && turned > if backs { ASKEW_RAD } else { TURNS_RAD },
        stays && aside_m > OVER_M,
        stays && all - net.abs() > BACK_RAD,
    ];
    few + ABSURD * absurd.into_iter().filter(|is| *is).count()
}

/// Who is behind somebody is not abreast of it; and who is in the next lane is no farther aside. [m]
const BEHIND_M: f64 = 0.0;
const NEXT_M: f64 = 1.5 * LANE_M + KEEPS_M;

impl Told {
    /// Whether the partner is told to be behind the ego, and nothing tells that it was in another lane then.
    fn is_in_line_behind(&self) -> bool {
        let straight = !matches!(self.sv.turning, Turning::Left | Turning::Right);
        let other_lane = self.cp.lane.is_some()
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
    pub(crate) fn begins_in_line(&self) -> bool {
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

    /// Whether a partner that is told beside the ego, and in no farther lane, is farther off than the next one.
    pub(crate) fn is_far_beside(&self, ego: &ActorTrack, track: &ActorTrack) -> bool {
        let (own, other) = (&ego.states[0], &track.states[0]);
        let aside_m = Vec2::from_heading(own.heading).cross(other.position() - own.position()).abs();
        let beside = matches!(self.origin, Origin::Beside { .. }) && self.comes_along_lanes();
        let aside = self.sv_aside().is_some();
        beside && !aside && (self.cp.lane.is_none() || self.sv.lane.is_none()) && !self.is_at_kerb() && aside_m > NEXT_M
    }

    /// Whether an oncoming partner is told to have gone straight by the ego, and not to have come over.
    fn comes_straight_by(&self) -> bool {
        let aside = |doing: &Doing| doing.is_aside() && !doing.is_pass();
        self.is_passed_by_oncoming() && !self.comes_over && !self.cp.dodges && !self.cp.acts.iter().any(aside)
    }

    /// Whether the partner comes by in a lane of its own: it has not to come out of the ego's for that, nor round who stands in it.
    pub(crate) fn has_own_lane(&self) -> bool {
        let beside = match self.origin {
            Origin::Beside { .. } => true,
            Origin::Behind => self.comes_along_kerb() || self.cp.movement == Some(Movement::Passing),
            Origin::Opposite => self.comes_straight_by(),
            _ => false,
        };
        beside && self.cp.turning == Turning::No && (!self.passes_from_behind() || self.comes_along_kerb())
    }

    /// Whether the partner passes so, and is not told to have changed lanes, drifted or entered.
    fn passes_in_own_lane(&self) -> bool {
        let aside = |doing: &Doing| doing.is_aside() && !doing.is_pass();
        let plain = !self.cp.dodges && !self.cp.changed_lanes && !self.comes_along_kerb();
        let passes = self.cp.movement == Some(Movement::Passing) && self.has_own_lane();
        passes && plain && !self.cp.acts.iter().any(aside)
    }

    /// Whether a partner that is told behind the ego is beside its lane, or ahead of it.
    pub(crate) fn is_beside_line(&self, ego: &ActorTrack, track: &ActorTrack) -> bool {
        let sets_out = track.states.iter().position(|state| state.velocity().length() > STANDS_MPS).unwrap_or(0);
        let (own, other) = (&ego.states[sets_out.min(ego.states.len() - 1)], &track.states[sets_out]);
        let (forward, way) = (Vec2::from_heading(own.heading), other.position() - own.position());
        let overlap_m = 0.5 * (ego.width_m + track.width_m) - forward.cross(way).abs();
        self.is_in_line_behind() && (overlap_m < 0.0 || way.dot(forward) > BEHIND_M)
    }
}

/// Whether somebody that passes and is told to touch with its flank or rear still moves away from the other one as it touches: it would not
/// rub along it, but have left it.
pub(crate) fn leaves_whom_it_passes(told: &Told, ego: &ActorTrack, track: &ActorTrack, contact_s: f64) -> bool {
    let beside = !told.cp.zones.is_empty() && !told.cp.zones.iter().any(|zone| zone.is_front());
    let step = ((contact_s / STEP_S) as usize).min(track.states.len() - 1);
    let (met, other) = (&track.states[step], &ego.states[step.min(ego.states.len() - 1)]);
    let along = Vec2::from_heading(other.heading);
    let away_mps = along.cross(met.velocity()) * along.cross(met.position() - other.position()).signum();
    told.passes_from_behind() && beside && away_mps > 0.0
}

/// What somebody feels sideways at most; it turns by no more than the second and what its circle or that allows in a step, nor by the third,
/// however slow it is, and what its circle allows; by the fourth and the first of these nobody turns who drives. [m/s^2, rad]
const SKIDS_MPS2: f64 = 6.0;
const SKIDS_RAD: f64 = 0.03;
const PIVOTS_RAD: f64 = 0.005;
const SLIDES_RAD: f64 = 0.07;

/// By how much somebody on wheels turns in steps in which its axle rolls, and how fast that does; nothing of who walks. [rad, m/s]
fn turns(kind: PartnerKind, states: &[ActorState]) -> impl Iterator<Item = (f64, f64)> {
    let wheels = VehicleSpec::of(kind).length_m > WHEELED_M;
    // Who pivots swings its middle: that does not roll. Where it changes gear it stands for a step.
    let steps = states.windows(2).map(|pair| (math::wrap_angle(pair[1].heading - pair[0].heading).abs(), pair[0]));
    steps.map(|(turn, state)| (turn, state.speed().abs())).filter(move |(_, mps)| wheels && *mps > STANDS_MPS)
}

/// What somebody turns at most in a step, by its circle and what it feels sideways. [rad]
fn most_rad(speed_mps: f64) -> f64 {
    STEP_S * (speed_mps / TIGHTEST_M).min(SKIDS_MPS2 / speed_mps)
}

/// Whether somebody turns tighter than it can.
pub(crate) fn is_tight(kind: PartnerKind, states: &[ActorState]) -> bool {
    turns(kind, states).any(|(turn, speed_mps)| {
        turn > SKIDS_RAD + most_rad(speed_mps) || turn > PIVOTS_RAD + STEP_S * speed_mps / TIGHTEST_M
    })
}

/// Whether it turns on the spot, slides or jumps, as nobody drives.
pub(crate) fn slides(kind: PartnerKind, states: &[ActorState]) -> bool {
    turns(kind, states).any(|(turn, speed_mps)| turn > SLIDES_RAD + most_rad(speed_mps))
}
