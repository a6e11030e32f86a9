use super::*;
use recrash_model::geometry::Pose;
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::{CollisionKind, Contact, EgoMetrics, Timed};
use recrash_model::rollout::{Event, EventKind, ROLLOUT_FORMAT, Role, Termination, TerminationKind};
use recrash_roads::{Centreline, Lane, LaneId, Road, RoadId};

/// A road without a lane.
fn no_road() -> RoadNetwork {
    RoadNetwork {
        map: MapSpec::default(),
        roads: Vec::new(),
        lanes: Vec::new(),
        followers: Vec::new(),
        named: Vec::new(),
        lines: Vec::new(),
        areas: Vec::new(),
    }
}

/// One lane through the origin.
fn lane_with_heading(heading: f64) -> RoadNetwork {
    let road = Road { from: "a".to_owned(), to: "b".to_owned(), part: RoadPart::Open, lanes: vec![LaneId(0)] };
    let lane = Lane {
        road: RoadId(0),
        index: 0,
        centreline: Centreline::Straight { start: Vec2::from_heading(heading) * -30.0, heading },
        length_m: 60.0,
        width_m: 3.5,
        end_width_m: 3.5,
    };
    RoadNetwork { roads: vec![road], lanes: vec![lane], followers: vec![Vec::new()], ..no_road() }
}

/// Steps before the contact.
const STEPS: usize = 60;

/// Where somebody is and how fast, by the time until the contact: x, y, heading and speed. [s; m, m, rad, m/s]
type Way = fn(f64) -> (f64, f64, f64, f64);

/// The same that may look around.
trait WayOf: Fn(f64) -> (f64, f64, f64, f64) {}
impl<T: Fn(f64) -> (f64, f64, f64, f64)> WayOf for T {}

fn track(id: &str, role: Role, way: impl WayOf) -> ActorTrack {
    let state = |step: usize| {
        let (x, y, heading, speed) = way((STEPS - 1 - step) as f64 * STEP_S);
        ActorState::moving(Pose { position: Vec2::new(x, y), heading }, speed)
    };
    ActorTrack {
        id: id.to_owned(),
        role,
        part_of: None,
        kind: PartnerKind::PassengerCar,
        length_m: 4.5,
        width_m: 1.9,
        mass_kg: None,
        appears_s: 0.0,
        gone_s: None,
        states: (0..STEPS).map(state).collect(),
    }
}

#[test]
fn the_rules_stand_in_the_order_of_the_table() {
    let asked: Vec<Cause> = RULES.iter().map(|(cause, _)| *cause).collect();
    assert_eq!(asked[..], Cause::ALL[..RULES.len()]);
}

/// The cause of a contact of two ways, with a zone on the ego; the road says nothing.
fn told(ego: Way, other: Way, ego_zone: ContactZone, phantom: Option<Timed>) -> Option<Cause> {
    told_on(&no_road(), ego, other, ego_zone, phantom)
}

/// That of a contact at its front.
fn told_with(network: &RoadNetwork, ego: impl WayOf, other: impl WayOf) -> Option<Cause> {
    told_on(network, ego, other, ContactZone::Front, None)
}

fn told_on(
    network: &RoadNetwork,
    ego: impl WayOf,
    other: impl WayOf,
    ego_zone: ContactZone,
    phantom: Option<Timed>,
) -> Option<Cause> {
    let actors = vec![track("ego", Role::Ego, ego), track("cp", Role::Partner, other)];
    let time_s = (STEPS - 1) as f64 * STEP_S;
    let (a_state, b_state) = (actors[0].states[STEPS - 1], actors[1].states[STEPS - 1]);
    let none = Timed { value: 0.0, time_s: 0.0 };
    let metrics = Metrics {
        partners: Vec::new(),
        obstacle_gaps: Vec::new(),
        contact: Some(Contact {
            actor: 1,
            id: "cp".to_owned(),
            time_s,
            ego_zone,
            other_zone: ContactZone::Front,
            kind: CollisionKind::Angle,
            relative_speed_mps: 5.0,
            ego_speed_mps: a_state.speed(),
            other_speed_mps: b_state.speed(),
        }),
        obstacles_hit: Vec::new(),
        min_gap: None,
        min_centre_distance: None,
        ego: EgoMetrics {
            max_deceleration: none,
            tyre_limit_mps2: recrash_model::vehicle::TYRE_LIMIT_MPS2,
            phantom_braking: phantom,
            max_reversals: 0,
            max_reversals_time_s: 0.0,
            max_lane_departure: none,
            distance_m: 0.0,
            mean_speed_mps: 0.0,
        },
        termination: TerminationKind::Contact,
        duration_s: time_s,
    };
    let rollout = Rollout {
        format: ROLLOUT_FORMAT.to_owned(),
        scenario_id: "case".to_owned(),
        simulator: "native".to_owned(),
        ego: "idm".to_owned(),
        obstacles: Vec::new(),
        events: vec![Event { time_s, kind: EventKind::Contact { a: 0, b: 1, a_state, b_state } }],
        termination: Termination { kind: TerminationKind::Contact, time_s },
        state_hash: String::new(),
        actors,
    };
    let contact = Finding { kind: FindingKind::Contact, time_s, value: 0.0, threshold: 0.0, sentence: String::new() };
    let near = Finding { kind: FindingKind::NearMiss, time_s: 1.0, ..contact.clone() };
    cause(network, &rollout, &metrics, &[near, contact])
}

/// Straight on at 10 m/s, to the contact at the origin.
const ON: Way = |before_s| (-10.0 * before_s, 0.0, 0.0, 10.0);
/// The same, braking with 5 m/s2 in the last second.
const BRAKING: Way = |before_s| {
    let braked_s = before_s.min(1.0);
    let x = -(5.0 * braked_s + 2.5 * braked_s * braked_s) - 10.0 * (before_s - braked_s);
    (x, 0.0, 0.0, 5.0 + 5.0 * braked_s)
};
const STANDING: Way = |_| (0.0, 0.0, 0.0, 0.0);
/// From the right.
const CROSSING: Way = |before_s| (3.0, -8.0 * before_s, math::FRAC_PI_2, 8.0);

#[test]
fn who_drives_on_did_not_react() {
    use ContactZone::Front;
    assert_eq!(told(ON, CROSSING, Front, None), Some(Cause::IgnoredCrossing));
    assert_eq!(told(ON, |_| (4.5, 0.0, 0.0, 0.0), Front, None), Some(Cause::IgnoredAhead));
    let oncoming: Way = |before_s| (4.5 + 9.0 * before_s, 0.0, math::PI, 9.0);
    assert_eq!(told(ON, oncoming, Front, None), Some(Cause::IgnoredOncoming));
    let cut_in: Way = |before_s| (4.5 - 6.0 * before_s, 1.6 * before_s.min(2.0), 0.0, 6.0);
    assert_eq!(told(ON, cut_in, Front, None), Some(Cause::MetCutIn));
}

#[test]
fn who_braked_braked_late_or_was_too_close() {
    use ContactZone::Front;
    assert_eq!(told(BRAKING, CROSSING, Front, None), Some(Cause::BrakedLate));
    // 20 m ahead at first, then braking to a stand.
    let far: Way = |before_s| (4.5 - 5.0 * (before_s - 3.0).max(0.0), 0.0, 0.0, if before_s > 3.0 { 5.0 } else { 1.0 });
    assert_eq!(told(BRAKING, far, Front, None), Some(Cause::BrakedLate));
    // Five metres ahead four seconds before.
    let close: Way = |before_s| (4.5 - 8.6 * before_s, 0.0, 0.0, 8.6);
    assert_eq!(told(BRAKING, close, Front, None), Some(Cause::FollowedTooClosely));
}

#[test]
fn who_creeps_since_it_braked_has_reacted() {
    use ContactZone::FrontLeft;
    let oncoming: Way = |before_s| (4.5 + 6.0 * before_s, 1.8, math::PI, 6.0);
    let creeps: Way = |before_s| (-0.8 * before_s, 0.0, 0.0, if before_s > 4.0 { 7.0 } else { 0.8 });
    assert_eq!(told(creeps, oncoming, FrontLeft, None), Some(Cause::BrakedLate));
    // Who sets off from a stand has not.
    let sets_off: Way = |before_s| {
        let speed = if before_s > 4.0 { 7.0 } else { 0.8 * f64::from(u8::from(before_s < 2.5)) };
        (-0.8 * before_s.min(2.5), 0.0, 0.0, speed)
    };
    assert_eq!(told(sets_off, oncoming, FrontLeft, None), Some(Cause::IgnoredOncoming));
}

#[test]
fn who_is_hit_from_behind_stood_braked_for_nothing_or_was_struck() {
    use ContactZone::Rear;
    let behind: Way = |before_s| (-4.5 - 15.0 * before_s, 0.0, 0.0, 15.0);
    assert_eq!(told(STANDING, behind, Rear, None), Some(Cause::StruckStanding));
    assert_eq!(told(ON, behind, Rear, None), Some(Cause::WasStruck));
    let just_before = Some(Timed { value: 4.0, time_s: 4.5 });
    assert_eq!(told(BRAKING, behind, Rear, just_before), Some(Cause::BrakedForNothing));
    let long_before = Some(Timed { value: 4.0, time_s: 0.5 });
    assert_eq!(told(BRAKING, behind, Rear, long_before), Some(Cause::WasStruck));
}

#[test]
fn who_stands_blocks_only_where_others_drive_another_way() {
    use ContactZone::{Left, Rear};
    let (across, along) = (lane_with_heading(math::FRAC_PI_2), lane_with_heading(0.0));
    assert_eq!(told_on(&across, STANDING, CROSSING, Left, None), Some(Cause::StoodInTheWay));
    assert_eq!(told_on(&along, STANDING, CROSSING, Left, None), Some(Cause::StruckStanding));
    let behind: Way = |before_s| (-4.5 - 15.0 * before_s, 0.0, 0.0, 15.0);
    assert_eq!(told_on(&across, STANDING, behind, Rear, None), Some(Cause::StruckStanding));
}

#[test]
fn who_turns_or_goes_aside_into_somebody_is_told_so() {
    let left: Way = |before_s| {
        let turned = math::FRAC_PI_2 * (1.0 - before_s / 3.0).clamp(0.0, 1.0);
        (-5.0 * before_s.max(1.0), 0.0, turned, 5.0)
    };
    let oncoming: Way = |before_s| (4.5 + 9.0 * before_s, 3.0, math::PI, 9.0);
    assert_eq!(told(left, oncoming, ContactZone::Right, None), Some(Cause::TurnedAcross));
    let aside: Way = |before_s| (-10.0 * before_s, -1.8 * before_s.min(1.5), 0.0, 10.0);
    let beside: Way = |before_s| (-10.0 * before_s, 1.9, 0.0, 10.0);
    assert_eq!(told(aside, beside, ContactZone::Left, None), Some(Cause::MovedInto));
}

#[test]
fn who_keeps_its_lane_in_a_bend_does_not_go_aside() {
    // To the left on 50 m; the ego at 15 m/s runs into one that drives 10 m/s.
    let on_bend = |s: f64| {
        let turned = s / 50.0;
        (50.0 * math::sin(turned), 50.0 - 50.0 * math::cos(turned), turned)
    };
    let mut bend = lane_with_heading(0.0);
    bend.lanes[0].length_m = 140.0;
    bend.lanes[0].centreline =
        Centreline::Arc { centre: Vec2::new(0.0, 50.0), radius: 50.0, start_angle: -math::FRAC_PI_2 - 2.0, turn: 1.0 };
    let behind = |before_s: f64| {
        let (x, y, heading) = on_bend(-15.0 * before_s);
        (x, y, heading, 15.0)
    };
    let ahead = |before_s: f64| {
        let (x, y, heading) = on_bend(4.5 - 10.0 * before_s);
        (x, y, heading, 10.0)
    };
    assert_eq!(told_with(&bend, behind, ahead), Some(Cause::IgnoredAhead));
    // Out of its lane, it does.
    let aside = |before_s: f64| {
        let (x, y, heading) = on_bend(-15.0 * before_s);
        let out_m = (2.0 - before_s).clamp(0.0, 2.0);
        (x + out_m * math::sin(heading), y - out_m * math::cos(heading), heading, 15.0)
    };
    assert_eq!(told_with(&bend, aside, ahead), Some(Cause::MovedInto));
}
