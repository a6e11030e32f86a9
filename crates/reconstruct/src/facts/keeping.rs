//! Whether a partner keeps a lane of its own direction until it leaves it for what is told of it, and drives as a vehicle can.

use crate::facts::astride::astride;
use crate::told::crash::Told;
use crate::told::doing::Doing;
use crate::told::layout::strip_of;
use crate::told::side::Turning;
use crate::told::zones::side_of;
use crate::usual::{LANE_M, NARROW_M, STANDS_MPS, SWINGS_OUT_RAD, TIGHTEST_M, WHEELED_M, swing_rad};
use recrash_model::account::{ContactState, LeftRight, Origin};
use recrash_model::geometry::Vec2;
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::metrics::CheckResult;
use recrash_model::rollout::{ActorState, ActorTrack, STEP_S};
use recrash_model::scenario::StripKind;
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{RoadPart, Scenario};

/// Who keeps its lane is no farther beside its middle; who is narrow, where its box stays in the lane. [m]
pub(super) const KEEPS_M: f64 = 0.7;

/// Who is told to leave its lane may be on its way out of it for so long before the contact; who is not told to, comes to the told zones in
/// the last of its way. Who comes out of the ego's lane to pass goes along between two before; and for whom, oncoming, the ego stopped had come
/// over before that. [s]
const LEAVES_S: f64 = 3.0;
const PASSES_S: f64 = 5.0;
const CAME_OVER_S: f64 = 8.0;
const NEARS_S: f64 = 2.0;

/// Between lanes somebody who leaves its own is at more than this to them. [rad]
const CHANGES_RAD: f64 = 0.04;

pub(super) const fn is_for_narrow(kind: StripKind) -> bool {
    matches!(kind, StripKind::Bike | StripKind::Shoulder)
}

/// A lane leads no farther from somebody's way. [rad]
const ALONG_RAD: f64 = 0.8;

/// Its way is looked at in steps of this. [steps, s]
const EVERY: usize = 5;
const EVERY_S: f64 = 0.5;

impl Told {
    /// Whether the partner drives along a lane, and nothing is told that takes it out of that.
    pub(super) fn keeps_its_lane(&self) -> bool {
        let along_turn =
            self.sv.turning != Turning::No && !matches!(self.origin, Origin::Opposite | Origin::Cross { .. });
        let drives = self.cp.state != ContactState::Reversing;
        self.comes_along_lanes() && !self.leaves_its_lane() && drives && !along_turn && !self.is_thrown()
    }
}

/// For how long the partner is in no lane of its direction before it leaves its own for what is told; nothing of who does not come along
/// lanes. [s]
pub(super) fn off_lane_s(told: &Told, scenario: &Scenario, track: &ActorTrack, contact_s: f64) -> Option<f64> {
    if !told.comes_along_lanes()
        || told.drives_elsewhere()
        || told.pulls_out_opposite()
        || told.squeezes_by()
        || told.meets_in_narrow()
        || if told.cp_drives_over() { is_over(told, scenario, track, contact_s) } else { told.splits_lanes().is_some() }
    {
        return None;
    }
    let leaves = told.leaves_its_lane();
    let last_s = match leaves {
        true if told.passes_from_behind() => PASSES_S,
        true if told.origin == Origin::Opposite && told.slows_for_who_came_over() => CAME_OVER_S,
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

/// Whether the partner is seen over the line over which it is told.
fn is_over(told: &Told, scenario: &Scenario, track: &ActorTrack, contact_s: f64) -> bool {
    told.cp.astride.is_some_and(|over| astride(over, scenario, track, contact_s).0 == CheckResult::Shown)
}

/// Whether somebody is in no lane of its direction there. Nobody has to keep one in a junction, nor between two that it changes.
fn is_off(told: &Told, scenario: &Scenario, track: &ActorTrack, state: &ActorState, leaves: bool) -> bool {
    let network = scenario.network();
    let strip = told.cp.lane.and_then(strip_of);
    let narrow = track.width_m < NARROW_M;
    let mut off = true;
    for lane in network.lanes.iter().filter(|lane| !lane.is_far(state.position())) {
        let (s_m, t_m) = lane.local(state.position());
        if !(0.0..=lane.length_m).contains(&s_m) || t_m.abs() > 0.5 * lane.width_at(s_m) {
            continue;
        }
        let across_rad = math::wrap_angle(lane.heading(s_m) - state.heading).abs();
        let most_m = KEEPS_M.max(0.5 * (lane.width_at(s_m) - track.width_m));
        let may = match network.road(lane.road).part {
            RoadPart::Inner => return false,
            RoadPart::Beside(kind) => strip == Some(kind) || narrow && is_for_narrow(kind),
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

/// Who is told to drive straight on, or to pass, so far beside the ego at least, goes no farther out of its way. [m]
const BESIDE_M: f64 = 1.0;
const AWAY_M: f64 = 1.0;

/// What nobody would take for driving straight on is worse than a step from the told zones. [half seconds]
pub(crate) const ABSURD: usize = 4;

/// Who drives along the ego's road begins at no more to it; and who goes straight on bends by the second for a half second. [rad]
const BEGINS_RAD: f64 = 0.03;
const BENDS_RAD: f64 = 0.12;

/// In how many ways the partner weaves or swerves that nobody tells of.
pub(super) fn weaves(told: &Told, track: &ActorTrack, contact_s: f64) -> usize {
    if !told.comes_along_lanes() || told.cp.turning != Turning::No || told.is_thrown() {
        return 0;
    }
    let until = track.step_at(contact_s);
    let (first, last) = (&track.states[0], &track.states[until]);
    let along = Vec2::from_heading(first.heading);
    let aside_m = |state: &ActorState| along.cross(state.position() - first.position()).abs();
    let aside_m = track.states[..=until].iter().map(aside_m).fold(0.0, f64::max);
    let turned = math::wrap_angle(last.heading - first.heading).abs();
    let beside = matches!(told.origin, Origin::Beside { .. });
    let stays = !told.leaves_its_lane() || told.comes_straight_by() || told.passes_in_own_lane();
    let stays = stays && !told.squeezes_by() && !told.meets_in_narrow();
    let sideways = |pair: &[ActorState]| {
        let rate = math::wrap_angle(pair[1].heading - pair[0].heading).abs() / STEP_S;
        rate * pair[0].velocity().length()
    };
    // Whose rear touches swings it out, or cuts in.
    let rear = told.cp.zones.iter().any(|zone| zone.is_rear());
    // Who follows the ego through its turn turns with it.
    let swerves = !rear
        && !told.cp.turns_later
        && !told.cp.stood_first
        && !told.cp.acts.iter().any(Doing::is_swerve)
        && track.states[..=until].windows(2).any(|pair| sideways(pair) > SIDEWAYS_MPS2);
    let few = [stays && !beside && aside_m > ASIDE_M, swerves].into_iter().filter(|is| *is).count();
    let turns = track.states[..=until].windows(2).map(|pair| math::wrap_angle(pair[1].heading - pair[0].heading));
    let (all, net) = turns.fold((0.0, 0.0), |(all, net), turn| (all + turn.abs(), net + turn));
    let backs = told.cp.state == ContactState::Reversing;
    // Who drives along the ego's road begins along it.
    let road =
        matches!(told.origin, Origin::Ahead | Origin::Behind | Origin::Beside { .. }) && told.cp.slants.is_none();
    let bends = if stays && !backs { (turned / BENDS_RAD) as usize } else { 0 };
    let absurd = [
        road && stays && !told.diagonal && math::sin(first.heading).abs() > BEGINS_RAD,
        stays && turned > if backs { ASKEW_RAD } else { TURNS_RAD },
        stays && aside_m > OVER_M,
        stays && all - net.abs() > BACK_RAD,
    ];
    few + bends + ABSURD * absurd.into_iter().filter(|is| *is).count()
}

/// Who came along the road before it backed in line was at no more to it. [rad]
const CAME_ASKEW_RAD: f64 = 0.03;

/// Whether somebody who came along the ego's road, stood, and backs drove at an angle to that before.
pub(super) fn drives_askew(told: &Told, ego: &ActorTrack, track: &ActorTrack) -> bool {
    let along = matches!(told.origin, Origin::Ahead | Origin::Behind) && told.sv.turning == Turning::No;
    let backs = told.cp.state == ContactState::Reversing && told.cp.turning == Turning::No;
    let came = track.states[0].speed() > STANDS_MPS && told.cp.slants.is_none();
    let off = math::wrap_angle(track.states[0].heading - ego.states[0].heading).abs();
    along && backs && came && (CAME_ASKEW_RAD..ALONG_RAD).contains(&off)
}

/// Whether somebody that passes and is told to touch with its flank or rear still moves away from the other one as it touches: it would not
/// rub along it, but have left it.
pub(super) fn leaves_whom_it_passes(told: &Told, ego: &ActorTrack, track: &ActorTrack, contact_s: f64) -> bool {
    let beside = !told.cp.zones.is_empty() && !told.cp.zones.iter().any(|zone| zone.is_front());
    let step = track.step_at(contact_s);
    let (met, other) = (&track.states[step], ego.at(step));
    let along = Vec2::from_heading(other.heading);
    let away_mps = along.cross(met.velocity()) * along.cross(met.position() - other.position()).signum();
    told.passes_from_behind() && beside && away_mps > 0.0
}

/// Whether somebody that is told to drive straight on beside the ego, or by it, goes out of that one's way before they touch.
pub(super) fn goes_out_of_way(told: &Told, ego: &ActorTrack, track: &ActorTrack, contact_s: f64) -> bool {
    let stays = !told.leaves_its_lane() || told.comes_straight_by() || told.passes_in_own_lane();
    if !told.comes_along_lanes() || told.cp.turning != Turning::No || told.is_thrown() || !stays {
        return false;
    }
    let until = track.step_at(contact_s);
    let (first, own) = (&track.states[0], &ego.states[0]);
    let along = Vec2::from_heading(first.heading);
    let left_m = |of: Vec2| along.cross(of - first.position());
    let from_m = left_m(own.position());
    let away_m = |state: &ActorState| -from_m.signum() * left_m(state.position());
    from_m.abs() > BESIDE_M && track.states[..=until].iter().any(|state| away_m(state) > AWAY_M)
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
pub(super) fn is_tight(kind: PartnerKind, states: &[ActorState]) -> bool {
    turns(kind, states).any(|(turn, speed_mps)| {
        turn > SKIDS_RAD + most_rad(speed_mps) || turn > PIVOTS_RAD + STEP_S * speed_mps / TIGHTEST_M
    })
}

/// Whether it turns on the spot, slides or jumps, as nobody drives.
pub(super) fn slides(kind: PartnerKind, states: &[ActorState]) -> bool {
    turns(kind, states).any(|(turn, speed_mps)| turn > SLIDES_RAD + most_rad(speed_mps))
}

/// In how many ways somebody on wheels that drives forwards swings out to the other side before it turns: one for so much. [rad]
pub(super) fn swings(told: &Told, track: &ActorTrack, contact_s: f64) -> usize {
    let until = track.step_at(contact_s);
    let wheels = VehicleSpec::of(told.cp.kind).length_m > WHEELED_M && told.cp.state != ContactState::Reversing;
    let swing = swing_rad(track.states[..=until].iter().map(|state| state.heading));
    if wheels && told.cp.slants.is_none() { (swing / SWINGS_OUT_RAD) as usize } else { 0 }
}

/// Who runs into the rear of one that stands, on the side to which it is told to turn, has begun to. [rad]
const BEGUN_RAD: f64 = 0.09;

/// Whether somebody who has yet to turn for that has not begun to.
pub(super) fn is_before_turn(told: &Told, track: &ActorTrack, contact_s: f64) -> bool {
    let to = match told.cp.movement.filter(|_| told.cp.turns_later && told.sv.turning == Turning::No) {
        Some(Movement::LeftTurn) => LeftRight::Left,
        Some(Movement::RightTurn) => LeftRight::Right,
        _ => return false,
    };
    let until = track.step_at(contact_s);
    let turned = math::wrap_angle(track.states[until].heading - track.states[0].heading);
    told.sv.state.stands() && side_of(&told.sv.zones) == Some(to) && to.sign() * turned < BEGUN_RAD
}

impl Told {
    /// Whether the partner passes so, and is not told to have changed lanes, drifted or entered.
    fn passes_in_own_lane(&self) -> bool {
        let aside = |doing: &Doing| doing.is_aside() && !doing.is_pass();
        let plain = !self.cp.dodges && !self.cp.changed_lanes && !self.comes_along_kerb();
        let passes = self.cp.movement == Some(Movement::Passing) && self.has_own_lane();
        passes && plain && !self.cp.acts.iter().any(aside)
    }
}
