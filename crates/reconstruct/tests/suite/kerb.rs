//! Who is told to stand at the kerb stands beside the lanes, and who is told to be in a lane counted from a side is in that.

use crate::ways::{made, story};
use recrash_model::account::{Fact, LeftRight, Origin};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::ActorTrack;
use recrash_model::scenario::{MapSpec, StripKind};
use recrash_reconstruct::{Reconstruction, reconstruct};

const PASSED: &str = "The AV was parked at the curb on Elm Street when a van traveling west passed the parked AV on the left and the right side of \
                      the van made contact with the rear left of the AV.";

const IN_LANE: &str = "The AV was parked in-lane on Elm Street with its hazard lights on. A van came out of a driveway on the right and the front of the van \
                       made contact with the right side of the AV.";

const STOPS: &str = "The AV stopped at the curb on Elm Street for a passenger drop-off. An SUV approached the AV from behind and passed the AV on the \
                          left, and the right side of the SUV made contact with the rear left of the stationary AV.";

const REAR_DOOR: &str = "The AV was traveling straight on Elm Street when an occupant of a parallel parked car opened its rear door into the right side of \
                         the AV.";

const THIRD: &str = "The AV was stopped in the third lane from the right on Elm Street for a red light. A sedan approached the AV from behind and the \
                     front of the sedan made contact with the rear of the AV.";

const MACHINE: &str = "The AV was stopped on Elm Street. A skid steer loader to the right of the AV began to reverse, and the rear of the skid steer \
                       loader made contact with the right side of the AV.";

const NARROW: &str = "The AV was stopped on a narrow street facing north when a sedan traveling southbound made contact with the front of the AV with \
                      its front.";

const ROLLS_OUT: &str = "The AV was traveling north on Elm Street when a pickup left a parking lot on the left without first stopping and turned right. \
                         The front of the pickup made contact with the left side of the AV.";

fn partner(made: &Reconstruction) -> &ActorTrack {
    made.rollout.actors.iter().find(|track| track.id == "cp").expect("a partner")
}

fn lanes(made: &Reconstruction) -> [usize; 2] {
    let MapSpec::G(map) = &made.draft.map else { panic!("a map of roads") };
    [&map.roads[0].right, &map.roads[0].left]
        .map(|strips| strips.iter().filter(|strip| strip.kind == StripKind::Driving).count())
}

#[test]
fn who_comes_out_without_stopping_has_not_stood() {
    let least = |words: &str| {
        let made = made(&story(words));
        assert!(made.is_true(), "{:?}", made.verdict);
        partner(&made).states.iter().take(85).map(|state| state.velocity().length()).fold(f64::MAX, f64::min)
    };
    let stops = ROLLS_OUT.replace(" without first stopping", "");
    assert!(least(ROLLS_OUT) > 1.5 && least(&stops) < 0.1, "{} {}", least(ROLLS_OUT), least(&stops));
}

#[test]
fn who_is_parked_in_a_lane_stands_in_it() {
    let middle = |words: &str| made(&story(words)).rollout.ego_track().states[0].y;
    let at_the_kerb = IN_LANE.replace("parked in-lane", "parked");
    assert!((middle(IN_LANE) - middle(&at_the_kerb)).abs() > 1.5, "{} {}", middle(IN_LANE), middle(&at_the_kerb));
}

#[test]
fn who_is_parked_at_the_kerb_is_passed_by_who_keeps_its_lane() {
    let made = made(&story(PASSED));
    let ego_y = made.rollout.ego_track().states[0].y;
    assert!((-3.4..-2.4).contains(&ego_y), "{ego_y}");
    let most = partner(&made).states.iter().take(85).map(|state| state.y).fold(0.0, f64::max);
    assert!(most < 0.5, "it swings out by {most} m");
}

#[test]
fn who_stops_at_the_kerb_comes_there() {
    let made = made(&story(STOPS));
    let ego = made.rollout.ego_track();
    assert!(ego.states[0].y.abs() < 0.1 && ego.states.last().unwrap().y < -2.4, "{:?}", ego.states.last());
}

#[test]
fn a_rear_door_is_hinged_behind_the_middle_of_a_car_beside_the_lanes() {
    // The door is at the rear, and touches the ego with what is the flank of its car.
    let mut account = story(REAR_DOOR);
    account.partner.as_mut().expect("a partner").zones.clear();
    let made = made(&account);
    let cp = made.draft.actors.iter().find(|actor| actor.id == "cp").unwrap();
    assert!(cp.parts[0].x_m < 0.0);
    let flank_m = partner(&made).states[0].y.abs() - 0.926;
    assert!(flank_m > 1.5, "{flank_m}");
}

#[test]
fn a_counted_lane_is_counted_from_its_side() {
    let made = made(&story(THIRD));
    let check = made.verdict.checks.iter().find(|check| check.kind == CheckKind::SvLane).unwrap();
    assert_eq!(check.result, CheckResult::Shown);
    assert_eq!(check.expected, "the third lane from the right");
    assert_eq!(check.observed, "lane 2 of 4, from the left");
}

#[test]
fn a_machine_has_the_size_of_its_name() {
    let made = made(&story(MACHINE));
    assert!(partner(&made).length_m < 4.0, "{}", partner(&made).length_m);
}

#[test]
fn a_narrow_street_has_a_lane_each_way() {
    assert_eq!(lanes(&made(&story(NARROW))), [1, 1]);
}

const OUT_AT_JUNCTION: &str = "The AV was traveling north and slowed for a stop sign at the intersection with Elm Street. A van that was parked at \
                               the curb on the right pulled out, and the front left of the van made contact with the right side of the AV.";

const BACK_AT_JUNCTION: &str = "The AV was traveling north and slowed for a stop sign at the intersection with Elm Street. A van that was parked \
                                at the curb on the left reversed, and the rear right of the van made contact with the left side of the AV.";

/// The strips on which somebody stood when it set out.
fn stood_on(made: &Reconstruction) -> Option<StripKind> {
    let scenario = recrash_roads::check(made.draft.clone()).expect("a sound scenario").value;
    let (network, state) = (scenario.network(), partner(made).states[0]);
    let lane = [0.0, std::f64::consts::PI]
        .into_iter()
        .find_map(|turn| network.lane_at(state.position(), state.heading + turn))?;
    match network.road(network.lane(lane).road).part {
        recrash_roads::RoadPart::Beside(kind) => Some(kind),
        _ => None,
    }
}

#[test]
fn who_leaves_the_kerb_before_a_junction_stood_where_others_park() {
    for (words, side) in [(OUT_AT_JUNCTION, LeftRight::Right), (BACK_AT_JUNCTION, LeftRight::Left)] {
        let mut account = story(words);
        account.came_from = Some(Fact::by_rule(Origin::Parked { side: Some(side) }, "made for this test"));
        let made = made(&account);
        assert!(made.is_true(), "{:?}", made.verdict);
        assert_eq!(stood_on(&made), Some(StripKind::Parking), "{:?}", partner(&made).states[0]);
    }
}

#[test]
fn who_comes_towards_a_standing_ego_in_a_narrow_street_comes_along_its_middle() {
    let most_deg = |words: &str| {
        let made = made(&story(words));
        assert!(made.is_true(), "{:?}", made.verdict);
        let states = &partner(&made).states[..85];
        let turned = |heading: f64| recrash_model::math::wrap_angle(heading - states[0].heading).to_degrees().abs();
        states.iter().map(|state| turned(state.heading)).fold(0.0, f64::max)
    };
    let wide = NARROW.replace("a narrow street", "Elm Street");
    assert!(most_deg(NARROW) < 8.0 && most_deg(NARROW) < most_deg(&wide), "{} {}", most_deg(NARROW), most_deg(&wide));
}

const AGAINST: &str = "The AV was traveling eastbound on Elm Street and a parked westbound sedan was on the other side of the street. The AV drifted to the left and \
                       the front left of the AV made contact with the front left of the sedan.";

#[test]
fn who_is_told_to_be_parked_against_the_egos_way_does_not_face_as_it_does() {
    let made = reconstruct(&story(AGAINST)).expect("it can be staged");
    let facing = made.rollout.ego_track().states[0].heading - partner(&made).states[0].heading;
    let against = recrash_model::math::wrap_angle(facing).abs() > 2.0;
    assert!((against && lanes(&made)[1] > 0) || made.missed().is_some(), "{:?}", made.verdict);
}

const BOTH_KERBS: &str = "The AV was traveling north on a narrow stretch of Elm Street with vehicles parked at the curb in both directions when it moved to \
                          the right and stopped to let a southbound box truck by. The box truck proceeded to pass the AV on the left, and the left side of \
                          the box truck made contact with the rear left side of the stationary AV.";

#[test]
fn vehicles_parked_at_both_kerbs_stand_at_both() {
    let made = made(&story(BOTH_KERBS));
    assert!(made.is_true(), "{:?}", made.verdict);
    let middle = made.rollout.ego_track().states[0].y;
    let kerbs = made.rollout.actors.iter().filter(|track| track.id.starts_with("kerb"));
    let sides: Vec<bool> = kerbs.map(|track| track.states[0].y > middle).collect();
    assert!(sides.contains(&true) && sides.contains(&false), "{sides:?}");
}

const DOUBLE_PARKED: &str = "The AV was traveling north on Elm Street and came to a stop as southbound traffic went around double-parked vans in the \
                             southbound lane. A sedan behind the AV passed the AV on the left, and the right side of the sedan made contact with the \
                             rear left side of the stationary AV.";

#[test]
fn a_row_that_is_double_parked_in_the_opposite_lane_is_at_no_kerb() {
    let made = made(&story(DOUBLE_PARKED));
    assert!(made.is_true(), "{:?}", made.verdict);
    assert!(made.rollout.actors.iter().all(|track| !track.id.starts_with("kerb")), "{:?}", made.draft.actors);
}
