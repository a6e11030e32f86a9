//! Lanes and timing: rehearses every lane plan of a staging at many starts, and takes the start whose meeting is most
//! like the told one.

use super::rehearsal::{Meeting, Motion, Rehearsal, holds_speed};
use super::retry::{Aim, Plan as Attempt, Tried};
use super::staging::{ConflictKind, Ground};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::metrics::CollisionKind;
use recrash_model::scenario::{Approach, LateralMove, MapSpec, Policy, Turn};
use recrash_model::surroundings::Surface;
use recrash_model::template::{Movement, Template};
use recrash_model::vehicle::VehicleSpec;
use recrash_model::zones::ContactZone;
use recrash_plan::Plan;
use recrash_roads::{LanePath, RoadNetwork, RoadPart};

/// Starts are looked at from minus to plus this arrival gap. [s]
const WIDEST_GAP_S: f64 = 3.0;
/// In steps of this. [s]
const GAP_STEP_S: f64 = 0.05;
/// Starts beside the ego are looked at from minus to plus this. [m]
const WIDEST_SHIFT_M: f64 = 10.0;
/// In steps of this. [m]
const SHIFT_STEP_M: f64 = 0.5;
/// A turn shows from here on. [rad]
const TURN_SHOWS_RAD: f64 = 25.0 * math::PI / 180.0;
/// A move to the side shows from this many lane widths on; half a lane is the measure of the check, the rest is margin.
const SHIFT_SHOWS_LANES: f64 = 0.56;
/// Penalty of what no check would pass.
const WRONG: f64 = 10.0;

/// The contact the facts tell of; empty lists where they tell nothing.
#[derive(Debug, Clone, Copy)]
pub struct Wanted<'a> {
    /// Zones on the ego.
    pub sv: &'a [ContactZone],
    /// Zones on the partner.
    pub cp: &'a [ContactZone],
    /// Kinds of collision that must not happen.
    pub excluded: &'a [CollisionKind],
    /// Whether the partner reaches the conflict first.
    pub partner_first: bool,
}

/// What is fixed before lanes and timing are chosen.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// Template.
    pub template: &'a Template,
    /// What lies under it.
    pub ground: Ground,
    /// How the two get into conflict.
    pub conflict: ConflictKind,
    /// +1 where the partner comes over to the right, -1 to the left.
    pub towards: f64,
    /// Kind of partner.
    pub kind: PartnerKind,
    /// The ego's start along its lane. [m]
    pub ego_start_m: f64,
    /// The ego's speed. [m/s]
    pub ego_mps: f64,
    /// The partner's target speed. [m/s]
    pub partner_mps: f64,
    /// What a partner whose path meets the ego's does, and its first speed. [m/s]
    pub policy: &'a Policy,
    /// See [`Self::policy`].
    pub start_mps: f64,
    /// What is wanted.
    pub wanted: Wanted<'a>,
}

/// A way for both through one map.
pub struct Course {
    /// Roads.
    pub network: RoadNetwork,
    /// Lanes in each direction.
    pub lanes: u8,
    /// The ego's lane number.
    pub ego_lane: u8,
    /// The ego's way.
    pub ego: Way,
    /// The partner's way.
    pub partner: Way,
}

/// A way through the map, with the places that matter.
pub struct Way {
    /// Lanes.
    pub path: LanePath,
    /// Where the block begins; half way on a road without. [m]
    pub block_m: f64,
    /// Where the ring of a roundabout begins.
    ring_m: Option<f64>,
    /// The last part of the block: the connector of a junction, the way out of a circle.
    last_part: Option<(f64, f64)>,
}

impl Course {
    /// The ways of both, where the map has them.
    pub fn new(map: &MapSpec, ego: (Turn, u8), partner: (Approach, Turn, u8)) -> Option<Self> {
        let network = RoadNetwork::build(map);
        let lanes = map.carriageway().lanes;
        let ego_way = Way::new(&network, Approach::Same, ego.0, ego.1)?;
        let partner = Way::new(&network, partner.0, partner.1, partner.2)?;
        Some(Self { network, lanes, ego_lane: ego.1, ego: ego_way, partner })
    }
}

impl Way {
    fn new(network: &RoadNetwork, approach: Approach, turn: Turn, lane: u8) -> Option<Self> {
        let roads = network.route(approach, turn)?;
        let inside: Vec<usize> = (0..roads.len())
            .filter(|n| matches!(network.road(roads[*n]).part, RoadPart::Inner | RoadPart::Ring))
            .collect();
        let path = LanePath::new(network, roads, lane);
        let start = |n: usize| path.segments.get(n).map_or(path.length_m, |segment| segment.start_m);
        let block_m = inside.first().map_or(0.5 * path.length_m, |n| start(*n));
        let last_part = inside.last().map(|n| (start(*n), start(*n + 1)));
        let ring = (0..path.roads.len()).find(|n| network.road(path.roads[*n]).part == RoadPart::Ring);
        let ring_m = ring.map(start);
        Some(Self { block_m, ring_m, last_part, path })
    }
}

/// Where a partner starts and what it does sideways.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Arrival gap [s] of paths that meet, or start ahead of the ego [m] of parallel ones.
    pub start: f64,
    /// Start to the right of its lane's centre. [m]
    pub start_t_m: f64,
    /// Its target speed. [m/s]
    pub partner_mps: f64,
    /// Its sideways move.
    pub lateral: Option<LateralMove>,
    /// Whether it goes back to its lane then.
    pub returns: bool,
    /// How far back on its arm it would start; the ego must start later where this is too far. [m]
    pub partner_start_m: f64,
    /// The lower, the more like what is wanted.
    score: f64,
}

/// The best timing on each course, best course first: `(position in courses, timing)`.
pub fn best_timings(task: &Task, courses: &[Course], plan: &Attempt) -> Vec<(usize, Timing)> {
    let mut found: Vec<(usize, Timing)> = courses
        .iter()
        .enumerate()
        .filter_map(|(position, course)| {
            let mut timing = match task.conflict {
                ConflictKind::Paths => time_paths(task, course, plan)?,
                ConflictKind::Sideways => time_sideways(task, course, plan)?,
            };
            // Lane plans are in order of preference.
            timing.score += 0.4 * position as f64;
            Some((position, timing))
        })
        .collect();
    found.sort_by(|a, b| a.1.score.total_cmp(&b.1.score).then(a.0.cmp(&b.0)));
    found
}

/// Paths that cross or merge: looks for the arrival gap.
fn time_paths(task: &Task, course: &Course, plan: &Attempt) -> Option<Timing> {
    let spec = VehicleSpec::of(task.kind);
    let ego_spec = VehicleSpec::of(PartnerKind::PassengerCar);
    let (ego_path, path) = (&course.ego.path, &course.partner.path);
    let conflict = ego_path.conflict(path, ego_spec.width_m, spec.width_m)?;
    let meets_s = (conflict.s_a - task.ego_start_m) / task.ego_mps;
    let (from_s, until_s) = (meets_s - 5.0, meets_s + 5.0);
    let ego = Motion::ego(ego_path, task.ego_start_m, task.ego_mps, until_s);
    let does = partner_plan(task, task.policy, 0.0);
    let motion = |gap_s: f64| {
        let start_m = conflict.s_b - task.partner_mps * (meets_s + gap_s);
        Motion::partner(path, does, Vec::new(), start_m, task.start_mps, until_s)
    };
    // Who sets off, or slows for a bend, arrives later than the arrival gap says, which counts with the target speed.
    let lost_s = meets_s - motion(0.0).driven(meets_s) / task.partner_mps;
    let lost_s = (lost_s * 100.0).round().max(0.0) / 100.0;
    let rehearsal = Rehearsal::new(&ego, from_s, until_s);
    let count = (2.0 * WIDEST_GAP_S / GAP_STEP_S).round() as usize;
    let tries: Vec<(f64, Option<Meeting>)> = (0..=count)
        .map(|n| {
            let gap_s = -WIDEST_GAP_S - lost_s + GAP_STEP_S * n as f64;
            (gap_s, rehearsal.with(&motion(gap_s)))
        })
        .collect();
    let (start, score) = choose(task, course, plan, &tries, -lost_s, 0.3)?;
    Some(Timing {
        start,
        start_t_m: 0.0,
        partner_mps: task.partner_mps,
        lateral: None,
        returns: false,
        partner_start_m: motion(start).start_m,
        score,
    })
}

/// The plan of the partner with a policy, from this offset to the right of its lane on.
fn partner_plan(task: &Task, policy: &Policy, start_t_m: f64) -> Plan {
    Plan::new(task.kind, policy, start_t_m, Surface::Dry)
}

/// How a partner comes over that drives beside the ego.
struct MoveOver {
    /// When the two meet. [s]
    meets_s: f64,
    /// Where on its way the partner is then. [m]
    place_m: f64,
    /// Its speed, at which it keeps beside the ego. [m/s]
    partner_mps: f64,
    /// Its start to the right of its lane's centre. [m]
    start_t_m: f64,
    lateral: LateralMove,
}

/// Parallel paths: the partner drives beside the ego and comes over; looks for its place beside the ego.
fn time_sideways(task: &Task, course: &Course, plan: &Attempt) -> Option<Timing> {
    let touch = plan.aim == Aim::Touch;
    let MoveOver { meets_s, place_m, partner_mps, start_t_m, lateral } = move_over(task, course, touch);
    let until_s = meets_s + 8.0;
    let ego = Motion::ego(&course.ego.path, task.ego_start_m, task.ego_mps, until_s);
    let does = partner_plan(task, &holds_speed(partner_mps), start_t_m);
    let motion = |shift_m: f64| {
        let start_m = place_m + shift_m - partner_mps * meets_s;
        Motion::partner(&course.partner.path, does, vec![lateral], start_m, partner_mps, until_s)
    };
    let rehearsal = Rehearsal::new(&ego, lateral.start_s - 1.0, until_s);
    let count = (2.0 * WIDEST_SHIFT_M / SHIFT_STEP_M).round() as usize;
    // As the start is written in the scenario: ahead of the ego at time 0.
    let ahead = |shift_m: f64| motion(shift_m).start_m - task.ego_start_m;
    let tries: Vec<(f64, Option<Meeting>)> = (0..=count)
        .map(|n| {
            let shift_m = -WIDEST_SHIFT_M + SHIFT_STEP_M * n as f64;
            let meeting = rehearsal.with(&motion(shift_m));
            // Where the two come closest elsewhere, on the way out say, it is another conflict.
            (ahead(shift_m), meeting.filter(|meeting| (meeting.time_s - meets_s).abs() < 3.0))
        })
        .collect();
    let (start, score) = choose(task, course, plan, &tries, ahead(0.0), 1.5)?;
    let start = tenths(start);
    let partner_start_m = task.ego_start_m + start;
    // Who does not touch notices, and goes back; unless the move is its movement.
    let is_its_movement = task.ground == Ground::Road && task.template.cp != Movement::Straight;
    let returns = !touch && !is_its_movement;
    Some(Timing { start, start_t_m, partner_mps, lateral: Some(lateral), returns, partner_start_m, score })
}

/// Where and when the two meet beside each other, and the partner's move there.
fn move_over(task: &Task, course: &Course, touch: bool) -> MoveOver {
    let on_road = task.ground == Ground::Road;
    let (ego_m, place_m) = (meeting_place(task, &course.ego), meeting_place(task, &course.partner));
    let meets_s = (ego_m - task.ego_start_m) / task.ego_mps;
    // The partner keeps beside the ego on the inside or outside of the curve.
    let block = course.ego.block_m;
    let ratio = if ego_m > block && !on_road { (place_m - block) / (ego_m - block) } else { 1.0 };
    let (from_t, to_t, move_s) = sideways(task, course.network.map.carriageway().lane_width_m, touch);
    let ahead_of_meeting_s = if on_road { move_s } else { 0.7 * move_s };
    MoveOver {
        meets_s,
        place_m,
        partner_mps: (task.ego_mps * ratio * 100.0).round() / 100.0,
        start_t_m: tenths(from_t * task.towards),
        lateral: LateralMove {
            start_s: tenths((meets_s - ahead_of_meeting_s).max(0.5)),
            duration_s: move_s,
            to_t_m: (to_t * task.towards * 20.0).round() / 20.0,
        },
    }
}

/// Where on a way the two meet: late in the movement that must show; in a circle past the second exit, still on the ring. [m]
fn meeting_place(task: &Task, way: &Way) -> f64 {
    match way.last_part {
        Some((exit_m, _)) if task.ground == Ground::Circle => way.block_m + 0.75 * (exit_m - way.block_m),
        Some((from, to)) if task.template.cp != Movement::Straight => from + 0.85 * (to - from),
        Some((from, to)) => from + 0.5 * (to - from),
        None => task.ego_start_m + 5.5 * task.ego_mps,
    }
}

/// From where to where the partner moves towards the ego's side, and for how long. [m], [m], [s]
///
/// On a road without junction a move of half a lane counts as a turn to that side. A partner whose move must show starts on
/// the far side of its lane, so that it has moved so far before the two can touch, and comes over slowly, so that its corner
/// does not lead by much.
fn sideways(task: &Task, lane_m: f64, touch: bool) -> (f64, f64, f64) {
    let spec = VehicleSpec::of(task.kind);
    let ego_spec = VehicleSpec::of(PartnerKind::PassengerCar);
    let clearance_m = lane_m - 0.5 * ego_spec.width_m - 0.5 * spec.width_m;
    let far_m = (SHIFT_SHOWS_LANES * lane_m - clearance_m + 0.06 * spec.length_m).clamp(0.3, 1.2);
    let turns = task.template.cp != Movement::Straight;
    let (from_t, to_t, move_s) = match (task.ground == Ground::Road, turns) {
        (true, false) if touch => (0.0, 0.8 * lane_m, 2.5),
        (true, false) => (0.0, lane_m, 3.0),
        (true, true) => (-far_m, lane_m, 4.5),
        // Who goes straight through a junction comes over slowly: a heading that differs by more than a few degrees
        // would be a turn begun.
        (false, false) if touch => (0.0, clearance_m + 0.6, (clearance_m / (0.1 * task.ego_mps)).clamp(2.0, 6.0)),
        (false, true) if touch => (0.0, clearance_m + 0.6, 2.0),
        (false, _) => (0.0, 0.4 * clearance_m, 2.0),
    };
    (from_t, to_t, tenths(move_s))
}

fn tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

/// The start with the lowest score, and that score. Scores are smoothed over their neighbours, so that the middle of a
/// range of good starts wins over its edge; `near` is how close to an earlier try is too close.
fn choose(
    task: &Task,
    course: &Course,
    plan: &Attempt,
    tries: &[(f64, Option<Meeting>)],
    middle: f64,
    near: f64,
) -> Option<(f64, f64)> {
    let scores: Vec<f64> = tries
        .iter()
        .map(|(start, meeting)| match meeting {
            Some(meeting) => score(task, course, plan, *start - middle, meeting) + penalty(course, plan, *start, near),
            None => 6.0 * WRONG,
        })
        .collect();
    let smoothed = |n: usize| {
        let from = n.saturating_sub(3);
        let to = (n + 3).min(scores.len() - 1);
        let around = scores[from..=to].iter().sum::<f64>() / (to - from + 1) as f64;
        0.6 * scores[n] + 0.4 * around
    };
    let best = (0..tries.len()).min_by(|a, b| smoothed(*a).total_cmp(&smoothed(*b)))?;
    (scores[best] < 6.0 * WRONG).then(|| (tries[best].0, smoothed(best)))
}

/// Penalty of a start that is nearly one of the earlier tries.
fn penalty(course: &Course, plan: &Attempt, start: f64, near: f64) -> f64 {
    let same = |tried: &&Tried| tried.lanes == course.lanes && tried.ego_lane == course.ego_lane;
    plan.tried.iter().filter(same).map(|tried| 4.0 * (1.0 - (tried.start - start).abs() / near).max(0.0)).sum()
}

/// How far a meeting is from the wanted one.
fn score(task: &Task, course: &Course, plan: &Attempt, shift: f64, meeting: &Meeting) -> f64 {
    let mut score = 0.0;
    let wanted = &task.wanted;
    let touched = meeting.gap_m <= 0.0;
    // Below 2 m the checks predict the contact from the closest approach.
    if touched || meeting.gap_m < 2.0 {
        score += zone_steps(wanted.sv, meeting.ego_zone) + zone_steps(wanted.cp, meeting.partner_zone);
        if meeting.kind.is_some_and(|kind| wanted.excluded.contains(&kind)) {
            score += 2.0 * WRONG;
        }
    }
    match plan.aim {
        Aim::Touch => {
            if !touched {
                return score + 2.0 * WRONG + meeting.gap_m;
            }
            score += WRONG * unseen_movement(task, course, meeting);
        }
        Aim::Pass(gap_m) => {
            score += 2.0 * (meeting.gap_m - gap_m).abs();
            // Paths that meet are passed one after the other; the partner ahead of the ego has the lower arrival gap and
            // the greater distance ahead.
            let partner_first = if task.conflict == ConflictKind::Paths { shift < 0.0 } else { shift > 0.0 };
            if partner_first != (wanted.partner_first != plan.swap_order) {
                score += 0.5 * WRONG;
            }
            if touched {
                score += 2.0 * WRONG;
            }
        }
    }
    score
}

/// Steps around the box between a zone and the nearest wanted one; more than one step fails the check.
fn zone_steps(wanted: &[ContactZone], shown: ContactZone) -> f64 {
    let nearest = wanted.iter().filter_map(|zone| zone.steps_apart(shown)).min();
    match nearest {
        None | Some(0) => 0.0,
        Some(1) => 1.0,
        Some(steps) => f64::from(steps) + 0.5 * WRONG,
    }
}

/// How much of the movements does not show by the time of the meeting: 0 where all does.
fn unseen_movement(task: &Task, course: &Course, meeting: &Meeting) -> f64 {
    let lane_m = course.network.map.carriageway().lane_width_m;
    let share = |shown: f64, needed: f64| (1.0 - shown / needed).clamp(0.0, 1.0);
    let turn = |movement: Movement, turned: f64| match movement {
        Movement::LeftTurn => share(turned, TURN_SHOWS_RAD),
        Movement::RightTurn => share(-turned, TURN_SHOWS_RAD),
        _ => 0.0,
    };
    match task.ground {
        // Who is on the ring is seen to circle, which is all of a left turn and the beginning of going straight.
        Ground::Circle => {
            let entered_m = meeting.ego_nose_m - course.ego.ring_m.unwrap_or(0.0) - 0.5;
            let must_leave = task.template.sv == Movement::RightTurn || task.template.cp == Movement::RightTurn;
            f64::from(u8::from(entered_m < 0.0)) + if must_leave { 0.5 } else { 0.0 }
        }
        Ground::Junction => turn(task.template.sv, meeting.ego_turned) + turn(task.template.cp, meeting.partner_turned),
        Ground::Road if task.template.cp == Movement::Straight => 0.0,
        Ground::Road => share(meeting.partner_shifted_m, SHIFT_SHOWS_LANES * lane_m),
    }
}

#[cfg(test)]
mod tests {
    use super::super::limits::most_speed;
    use super::super::staging::{ground, stagings};
    use super::*;
    use recrash_model::scenario::CrossMap;
    use recrash_model::template::RoadType;

    fn turn(movement: Movement) -> Turn {
        match movement {
            Movement::LeftTurn => Turn::Left,
            Movement::RightTurn => Turn::Right,
            _ => Turn::Straight,
        }
    }

    /// The table of stagings against the road network: wherever paths are said to meet they do, in every lane plan, and
    /// there is a contact that is neither rear-end nor head-on, and both movements show by then.
    #[test]
    fn every_lane_plan_of_the_table_has_a_meeting_worth_staging() {
        let mut plans = 0;
        for (sv, cp) in Movement::PAPER.into_iter().flat_map(|sv| Movement::PAPER.map(|cp| (sv, cp))) {
            let template = Template { road: RoadType::Intersection, sv, cp, work_zone: false };
            for staging in stagings(&template).iter().filter(|s| s.conflict == ConflictKind::Paths) {
                for (number, lanes) in staging.lanes.iter().enumerate() {
                    plans += 1;
                    let map = CrossMap { lanes: lanes.lanes, lane_width_m: 3.5, approach_m: 60.0, arm_m: 120.0 };
                    let partner = (staging.approach, turn(cp), lanes.partner);
                    let course = Course::new(&MapSpec::X(map), (turn(sv), lanes.ego), partner).expect("both ways");
                    let ground = ground(&template, staging);
                    let partner_mps = most_speed(ground, turn(cp)).min(8.0);
                    let policy = holds_speed(partner_mps);
                    let task = Task {
                        template: &template,
                        ground,
                        conflict: staging.conflict,
                        towards: 1.0,
                        kind: PartnerKind::PassengerCar,
                        ego_start_m: 5.0,
                        ego_mps: most_speed(ground, turn(sv)).min(8.0),
                        partner_mps,
                        policy: &policy,
                        start_mps: partner_mps,
                        wanted: Wanted { sv: &[], cp: &[], excluded: &[], partner_first: true },
                    };
                    let excluded = [CollisionKind::RearEndByEgo, CollisionKind::RearEndOfEgo, CollisionKind::HeadOn];
                    let wanted = Wanted { excluded: &excluded, ..task.wanted };
                    let plan = Attempt { aim: Aim::Touch, ..super::super::retry::plan(&[], true, false) };
                    let timing = time_paths(&Task { wanted, ..task }, &course, &plan);
                    let timing = timing.unwrap_or_else(|| panic!("{template} {staging:?} {lanes:?}: never meet"));
                    // The best plan of each way shows both movements fully; the others may leave a little to the tuner.
                    let most = if number == 0 { 1.0 } else { 0.5 * WRONG };
                    assert!(timing.score < most, "{template} {staging:?} {lanes:?}: {}", timing.score);
                }
            }
        }
        assert!(plans > 40, "{plans}");
    }

    #[test]
    fn zones_one_step_apart_are_nearly_right_and_others_wrong() {
        use ContactZone::{Front, FrontLeft, Left, Rear};
        assert_eq!(zone_steps(&[], Rear), 0.0);
        assert_eq!(zone_steps(&[Front, Left], Left), 0.0);
        assert_eq!(zone_steps(&[Front], FrontLeft), 1.0);
        assert!(zone_steps(&[Front], Rear) > 4.0);
    }
}
