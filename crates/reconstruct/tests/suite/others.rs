//! Others of the story are there as they are told; and a rollout in which they are not does not pass for it.

use crate::ways::{before_contact, degrees_between, made, partner, speeds, story};
use recrash_model::account::{Account, Fact};
use recrash_model::geometry::Vec2;
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::ActorTrack;
use recrash_model::scenario::{Actor, ActorPlan, Aspect, Deed, Device, Place, ScenarioDraft, Trigger};
use recrash_model::template::Movement;
use recrash_reconstruct::{Reconstruction, held_against};
use recrash_sim::{Ego, simulate};

const STRUCK: &str = "A van approached from behind and the front of the van made contact with the rear of the AV.";
const WALKER: &str =
    "The AV was traveling north on Elm Street and slowed to yield to a pedestrian crossing the street.";
const BUS: &str = "The AV was traveling north when it came to a stop behind a bus that was stopped ahead of the AV.";
const MOVES_OFF: &str = "The AV was stopped in a queue of traffic for a red light at the intersection of Elm Street and Oak Street, and a van \
                         was stopped behind it. When the light turned green and traffic ahead advanced, the AV began to proceed. The van \
                         began to proceed and the front of the van made contact with the rear of the AV.";
const MOVES_UP: &str = "The AV was stopped in a queue of traffic. The AV proceeded forward a short distance and came to a stop. A van \
                        approached from behind and the front of the van made contact with the rear of the stationary AV.";
const ONCOMING: &str = "The AV was traveling north on Elm Street and came to a stop to yield to oncoming traffic before making a left turn onto \
                        Oak Street. A van approached from behind and the front of the van made contact with the rear of the stationary AV.";
const CROSSING: &str = "The AV was stopped at a stop sign at the intersection of Elm Street and Oak Street, yielding to cross traffic. A van \
                        approached from behind and the front of the van made contact with the rear of the stationary AV.";
const SLOWS: &str = "The AV was traveling north when a leading sedan began to slow, prompting the AV to slow.";
const MERGES: &str = "The AV was traveling north when a sedan to the left of the AV changed lanes to the right in front of the AV, and the AV \
                      slowed.";
const ROUND: &str = "The AV was traveling north and changed lanes to the left to pass a double-parked truck. The front of the AV made contact \
                     with a traffic cone.";
const KERB: &str = "The AV was stopped on a narrow street with vehicles parked at the curb. A van approached from behind and the front of the \
                    van made contact with the rear of the stationary AV.";

const BLOCKED: &str = "The AV came to a stop at a red light at the intersection of Elm Street and Oak Street. When the light turned green, the \
                       AV remained stopped as vehicles traveling on Oak Street were still occupying the intersection. A van approached \
                       from behind and the front of the van made contact with the rear of the stationary AV.";
const NO_ROOM: &str = "The AV was stopped at a green light at the intersection of Elm Street and Oak Street to keep the intersection clear, \
                       as traffic was stopped on the other side. A van approached from behind and the front of the van made contact with \
                       the rear of the stationary AV.";
const OVERTAKEN: &str = "The AV was pulling out of a parking space at the right curb with a second vehicle stopped in the lane, when a van \
                         passed the second vehicle and changed lanes to the right, and the front right of the van made contact with the \
                         front left of the AV.";

const GOES_BY: &str = "The AV was traveling south in the left lane on Elm Street when it began to slow as it passed a bus that was stopped in the right lane.";
const BACKS_OUT: &str = "The AV was traveling east when a sedan in a parking space on the right reversed out into the lane of the AV, and the AV slowed to \
                         a stop to yield to the sedan.";
const BUS_BY: &str =
    "The AV was traveling east on Elm Street when a bus that was traveling west approached in the oncoming direction.";
const FOR_CLEARANCE: &str = "The AV was stopped facing south on Elm Street at a stop sign at the intersection with Oak Street, waiting for westbound traffic \
                             to clear.";
const MAKES_ROOM: &str = "The AV was traveling east in the left lane when an SUV in the right lane merged into the left lane in front of the AV. The AV \
                          maneuvered to the left and the front left of the AV made contact with the median curb.";
const EMERGES: &str = "The AV was traveling east on Elm Street with vehicles parked at the curb in both directions. A dog entered the street from the left \
                       and the front of the AV made contact with the dog.";

const ROUND_AND_BACK: &str = "The AV was traveling north and navigated around a double-parked truck stopped in the right lane. After re-entering the right lane, \
                              the AV came to a stop behind a van. The van reversed and the rear of the van made contact with the front of the AV.";
const STRUCK_PARKED: &str = "The AV was traveling west on Elm Street in the center lane when a sedan traveling west in the right lane ahead of the AV made \
                             contact with a van parked at the curb. The sedan then moved into the lane of the AV, and the left side of the sedan made \
                             contact with the front right of the AV.";
const PULLS_OUT: &str = "The AV was parked in the right lane on Elm Street. A sedan that was stopped behind the AV began to change lanes to the left lane. As \
                         the sedan crossed the lane line, the front of a pickup truck made contact with the left side of the sedan, causing the front right \
                         side of the sedan to then make contact with the rear left side of the AV.";

const BETWEEN: &str = "The AV was stopped in the lane on Elm Street for a passenger drop-off. A cyclist traveling north behind the AV passed between the AV and a \
                       van that was parked, and the cyclist made contact with the rear left side of the AV.";
const ABREAST: &str = "The AV was traveling north in the center lane when a tire came off a van traveling in the right lane. The tire rolled into the lane of \
                       the AV and the front of the AV made contact with the tire.";
const IN_ITS_TURN: &str = "The AV was traveling north on Elm Street and was making a right turn onto Oak Street. The AV advanced and came to a stop to yield \
                           to cross traffic.";

const AT_RED: &str = "The AV was traveling west on Elm Street, preparing to make a left turn onto Oak Street from the left turn lane. The AV entered the \
                      intersection to make the left turn, but came to a stop when the traffic light turned red, yielding to oncoming traffic. While the AV \
                      remained stopped, a sedan that was turning behind the AV passed the AV on the left and the front right of the sedan made contact with \
                      the rear left of the AV.";
const SLOW_AHEAD: &str = "The AV was traveling south in the right lane on Elm Street. The AV began to slow and drifted to the right in response to slow \
                          traffic ahead. A sedan approached from behind and the front of the sedan made contact with the rear of the AV.";

const DEBRIS: &str = "The AV was traveling north on Elm Street and slowed to a stop due to debris in its lane.";
const FOR_ANIMAL: &str =
    "The AV was traveling north on Elm Street and came to a stop to yield to a dog that ran into the road.";
const TO_NOBODY: &str = "The AV was traveling north on Elm Street and came to a stop to give way.";
const FOR_FIRE_TRUCK: &str = "The AV was traveling north on a narrow street and came to a stop to yield to a fire truck traveling south. As the fire truck passed \
                              the stopped AV, the left side of the fire truck made contact with the rear left of the AV.";
const FULL_BEHIND: &str = "The AV was traveling north in a queue of traffic on Elm Street and slowed to a stop before the intersection with Oak Street to keep the \
                           intersection clear.";
const CHANGES_BEHIND: &str = "The AV was stopped behind a bus that was stopped ahead of the AV, and began to change lanes to the left. The front left of the AV \
                              made contact with the right side of a van that was traveling in the left lane.";
const RIGHT_AT_LIGHT: &str = "The AV was making a right turn at a traffic light onto Oak Street. The AV advanced and came to a stop as it yielded to cross traffic. Just \
                              when the AV began to move again, it was rear ended by a van behind.";
const TRAILER_ACROSS: &str = "The AV was traveling north in the center of three lanes when it came to a stop, yielding to a heavy truck which crossed into the center \
                              lane in front of the AV. A van traveling in the right lane changed lanes to the left, and the front left of the van made contact with the \
                              rear right of the stationary AV.";
const PASSED_IN_TRAFFIC: &str = "The AV was stopped in traffic on Elm Street at the intersection with Oak Street. A van that was stopped behind the AV passed it on the left, crossing the double \
                                 yellow line, and the right side of the van made contact with the rear left of the AV.";
const BUS_BACKS: &str = "The AV was traveling north and stopped behind a bus that was parked at the curb in front of the AV. The bus then reversed and the rear of the \
                         bus made contact with the front of the stationary AV.";

pub(crate) fn told(text: &str) -> Account {
    let whole = if text.contains("made contact") { text.to_owned() } else { format!("{text} {STRUCK}") };
    story(&whole)
}

pub(crate) fn track<'a>(made: &'a Reconstruction, id: &str) -> &'a ActorTrack {
    let ids: Vec<&str> = made.rollout.actors.iter().map(|track| track.id.as_str()).collect();
    made.rollout.actors.iter().find(|track| track.id == id).unwrap_or_else(|| panic!("{id} of {ids:?}"))
}

fn others(draft: &ScenarioDraft, account: &Account) -> Option<CheckResult> {
    let scenario = recrash_roads::check(draft.clone()).expect("it can run").value;
    let verdict = held_against(account, &scenario, &simulate(&scenario, Ego::Recorded)).expect("it can be staged");
    verdict.checks.iter().find(|check| check.kind == CheckKind::Others).map(|check| check.result)
}

/// A staging that shows the others as told; and does not where one of them is changed so.
pub(crate) fn shown_but(text: &str, id: &str, change: impl Fn(&mut Actor)) -> Reconstruction {
    let account = told(text);
    let shown = made(&account);
    assert_eq!(others(&shown.draft, &account), Some(CheckResult::Shown), "{:?}", shown.verdict);
    track(&shown, id);
    let mut gone = shown.draft.clone();
    gone.actors.retain(|actor| actor.id != id);
    assert_eq!(others(&gone, &account), Some(CheckResult::CannotBeShown), "{id} is gone");
    let mut changed = shown.draft.clone();
    change(changed.actors.iter_mut().find(|actor| actor.id == id).expect("it is there"));
    assert_eq!(others(&changed, &account), Some(CheckResult::CannotBeShown), "{id} is changed");
    shown
}

/// A staging that holds why the ego stood; and does not without this one.
fn shown_reason(text: &str, id: &str) -> Reconstruction {
    let account = told(text);
    let shown = made(&account);
    let reason = |draft: &ScenarioDraft| {
        let scenario = recrash_roads::check(draft.clone()).expect("it can run").value;
        let verdict = held_against(&account, &scenario, &simulate(&scenario, Ego::Recorded)).expect("it can be staged");
        verdict.checks.iter().find(|check| check.kind == CheckKind::Reason).map(|check| check.result)
    };
    assert_eq!(reason(&shown.draft), Some(CheckResult::Shown), "{:?}", shown.verdict);
    let mut gone = shown.draft.clone();
    gone.actors.retain(|actor| actor.id != id);
    assert_eq!(reason(&gone), Some(CheckResult::CannotBeShown), "{id} is gone");
    shown
}

pub(crate) fn moved(plan: &mut ActorPlan, by_x_m: f64, by_y_m: f64) {
    let places = plan.course.iter_mut().filter_map(|leg| match leg {
        recrash_model::scenario::Leg::Curve { to, .. } => Some(to),
        _ => None,
    });
    for place in places.chain([&mut plan.start]) {
        if let Place::Plane { x_m, y_m, .. } = place {
            (*x_m, *y_m) = (*x_m + by_x_m, *y_m + by_y_m);
        }
    }
}

fn stands_from_the_start(actor: &mut Actor) {
    actor.plan = ActorPlan::standing(actor.plan.start.clone());
}

#[test]
fn an_ego_that_slows_for_somebody_on_foot_could_stop_before_it() {
    let shown = shown_but(WALKER, "walker", stands_from_the_start);
    let (walker, ego) = (track(&shown, "walker"), shown.rollout.ego_track());
    let last = before_contact(&shown);
    let (at, from) = (walker.states[last], ego.states[last]);
    let room_m = at.x - from.x - 0.5 * ego.length_m;
    assert!(walker.kind == PartnerKind::Pedestrian && from.speed() > 0.1, "{from:?}");
    assert!(room_m > 0.2 * from.speed() * from.speed() && room_m < 20.0, "{room_m}");
    // It crosses the ego's way.
    assert!(walker.states[0].y < from.y - 2.0 && at.y > from.y - 0.5, "{at:?}");
}

#[test]
fn who_stands_ahead_is_of_the_told_kind() {
    let shown = shown_but(BUS, "lead", |lead| lead.kind = PartnerKind::PassengerCar);
    assert_eq!(track(&shown, "lead").kind, PartnerKind::Bus);
}

#[test]
fn a_queue_that_moves_off_does_so_at_green_and_before_the_ego() {
    let shown = shown_but(MOVES_OFF, "lead", stands_from_the_start);
    let sets_off = |id: &str| track(&shown, id).states.iter().position(|state| state.speed() > 0.2).expect("it drives");
    let ego = speeds(&shown).iter().position(|speed| *speed > 0.2).expect("it drives");
    let (lead, partner) = (sets_off("lead"), sets_off("cp"));
    assert!(lead < ego && ego < partner, "{lead}, {ego}, {partner}");
    let own = shown.draft.control.iter().find(|control| control.at == "own-").expect("a signal");
    let Device::Signal { .. } = own.device else { panic!("{own:?}") };
    let green_s =
        (0..120).map(|step| 0.1 * f64::from(step)).find(|at_s| own.device.aspect(*at_s) == Some(Aspect::Green));
    assert!(green_s.is_some_and(|green_s| green_s < 0.1 * lead as f64), "{green_s:?}, {lead}");
}

#[test]
fn who_drives_on_after_the_ego_did_not_make_way_for_it() {
    shown_but(MOVES_OFF, "lead", |lead| {
        for act in &mut lead.plan.acts {
            act.when = Some(Trigger::TimeS(8.8));
        }
    });
}

#[test]
fn behind_an_ego_that_moves_up_nobody_ahead_stood_in_its_way() {
    let shown = made(&told(MOVES_UP));
    let (lead, ego) = (track(&shown, "lead"), shown.rollout.ego_track());
    let gap = |step: usize| lead.states[step].x - ego.states[step].x;
    let last = before_contact(&shown);
    assert!(lead.states[last].x - lead.states[0].x > 2.0, "it moved up");
    assert!((60..=last).all(|step| gap(step) < 14.0 && gap(step) > 6.0), "{}", gap(last));
    assert_eq!(lead.states[last].speed(), 0.0);
}

#[test]
fn oncoming_traffic_that_the_ego_yields_to_comes_by_in_its_own_lane() {
    let shown = shown_but(ONCOMING, "oncoming", |oncoming| moved(&mut oncoming.plan, 150.0, 0.0));
    let (oncoming, ego) = (track(&shown, "oncoming"), shown.rollout.ego_track());
    let by =
        (0..before_contact(&shown)).find(|step| oncoming.states[*step].x < ego.states[*step].x).expect("it comes by");
    assert!(
        ego.states[by].speed() < 0.1 && oncoming.states[by].y - ego.states[by].y > 2.5,
        "{:?}",
        oncoming.states[by]
    );
}

#[test]
fn crossing_traffic_has_a_road_and_no_red_light() {
    let shown = shown_but(CROSSING, "crosser", stands_from_the_start);
    let crosser = track(&shown, "crosser");
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let (states, _) = partner(&shown);
    assert!(crosser.states[..states.len()].iter().all(|state| scenario.network().on_road(state.position())));
    // It would go on at red: the ego's light is green, and nobody crosses.
    let green = "The AV was stopped at a green light at the intersection of Elm Street and Oak Street, yielding to cross traffic. A van \
                 approached from behind and the front of the van made contact with the rear of the stationary AV.";
    let without = made(&told(green));
    let words = without.verdict.checks.iter().find(|check| check.kind == CheckKind::Others).expect("others are told");
    assert!(words.expected.contains("crossing") && words.result == CheckResult::CannotBeShown, "{words:?}");
    assert!(without.rollout.actors.iter().all(|track| track.id != "crosser"));
}

#[test]
fn who_slows_ahead_of_the_ego_slows_first() {
    let shown = shown_but(SLOWS, "slower", |slower| slower.plan.acts.clear());
    let slows = |speeds: Vec<f64>| speeds.iter().position(|speed| *speed < speeds[0] - 0.3).expect("it slows");
    let slower: Vec<f64> = track(&shown, "slower").states.iter().map(|state| state.speed()).collect();
    assert!(slows(slower) < slows(speeds(&shown)));
}

#[test]
fn who_cuts_in_comes_from_the_told_side() {
    let shown = shown_but(MERGES, "merger", |merger| {
        merger.plan.acts.retain(|act| !matches!(act.deed, Deed::Shift { .. }));
    });
    let (merger, last) = (track(&shown, "merger"), before_contact(&shown));
    let ego = shown.rollout.ego_track().states[last];
    assert!(merger.states[0].y > ego.y + 2.5, "it was on the left");
    assert!(merger.states[last].x > ego.x + 4.0 && (merger.states[last].y - ego.y).abs() < 1.0);
}

#[test]
fn whom_the_ego_goes_round_stands_in_the_lane_that_it_leaves() {
    let shown = shown_but(ROUND, "obstacle", |obstacle| moved(&mut obstacle.plan, 0.0, 8.0));
    let (obstacle, ego) = (track(&shown, "obstacle"), shown.rollout.ego_track());
    assert!((obstacle.states[0].y - ego.states[0].y).abs() < 0.5 && obstacle.states[0].x > ego.states[0].x);
    assert_eq!(obstacle.kind, PartnerKind::HeavyTruck);
}

#[test]
fn whom_the_partner_goes_round_stands_where_it_goes_by() {
    let shown = shown_but(OVERTAKEN, "passed", |passed| moved(&mut passed.plan, 0.0, -12.0));
    let (passed, (states, met)) = (track(&shown, "passed"), partner(&shown));
    let by = states.iter().position(|state| state.x > passed.states[0].x).expect("it goes by");
    assert!((2.0..5.0).contains(&(states[by].y - passed.states[0].y).abs()) && met.x > passed.states[0].x + 3.0);
}

#[test]
fn who_still_is_in_the_junction_stands_across_the_egos_way() {
    let shown = shown_but(BLOCKED, "blocker", |blocker| moved(&mut blocker.plan, 0.0, 12.0));
    let (blocker, ego) = (track(&shown, "blocker").states[0], shown.rollout.ego_track().states[before_contact(&shown)]);
    assert!(degrees_between(blocker.heading, ego.heading) > 80.0 && blocker.x - ego.x < 25.0, "{blocker:?}");
}

#[test]
fn one_vehicle_that_is_told_to_block_the_junction_stands_across_it() {
    let text = "The AV was traveling north on Elm Street and came to a stop for a bus that was blocking the intersection with Oak Street.";
    let shown = shown_but(text, "blocker", |blocker| moved(&mut blocker.plan, 0.0, 14.0));
    let (blocker, ego) = (track(&shown, "blocker").states[0], shown.rollout.ego_track().states[before_contact(&shown)]);
    assert!(degrees_between(blocker.heading, ego.heading) > 80.0 && blocker.x > ego.x, "{blocker:?}");
}

#[test]
fn who_leaves_no_room_stands_behind_the_junction() {
    let shown = shown_reason(NO_ROOM, "beyond");
    let (beyond, ego) = (track(&shown, "beyond").states[0], shown.rollout.ego_track().states[before_contact(&shown)]);
    assert!(degrees_between(beyond.heading, ego.heading) < 10.0 && beyond.x - ego.x > 28.0, "{beyond:?}");
}

#[test]
fn a_row_of_parked_vehicles_stands_beside_the_lanes() {
    let shown = shown_but(KERB, "kerb", |kerb| moved(&mut kerb.plan, 90.0, 0.0));
    let ego = shown.rollout.ego_track().states[before_contact(&shown)];
    assert!((track(&shown, "kerb").states[0].y - ego.y).abs() > 2.5);
}

#[test]
fn one_parked_vehicle_stands_on_the_side_from_which_the_partner_comes() {
    let account = told(
        "The AV was traveling north. A sedan exiting a driveway on the left entered the roadway in front of a van parked at the curb, and \
         the front of the sedan made contact with the left side of the AV.",
    );
    let shown = made(&account);
    let (kerb, ego) = (track(&shown, "kerb"), shown.rollout.ego_track().states[before_contact(&shown)]);
    assert!(kerb.kind == PartnerKind::Van && kerb.states[0].y > ego.y + 2.5, "{:?}", kerb.states[0]);
    assert!(shown.rollout.actors.iter().all(|track| track.id != "kerb-2"));
}

#[test]
fn words_that_name_nobody_bring_nobody() {
    let texts = [
        "The AV was stopped in traffic for a red light before a pedestrian crosswalk.",
        "The AV was stopped in the lane of traffic for a passenger pickup.",
    ];
    for text in texts {
        let account = told(text);
        let quiet = account.others.iter().all(|other| !other.kind.value.is_vehicle() || other.several);
        assert!(quiet, "{:?}", account.others);
        assert!(made(&account).rollout.actors.iter().all(|track| !matches!(track.id.as_str(), "walker" | "crosser")));
    }
}

#[test]
fn whom_the_ego_passes_in_its_lane_stands_in_the_next_one() {
    let shown = shown_but(GOES_BY, "beside", |bus| moved(&mut bus.plan, 0.0, 3.4));
    let (bus, ego) = (track(&shown, "beside"), shown.rollout.ego_track().states[before_contact(&shown)]);
    assert_eq!(bus.kind, PartnerKind::Bus);
    assert!(
        (bus.states[0].y - ego.y + 3.4).abs() < 0.5 && (bus.states[0].x - ego.x).abs() < 8.0,
        "{:?}",
        bus.states[0]
    );
}

#[test]
fn who_backs_out_does_so_from_the_told_side_and_ahead_of_the_ego() {
    let shown = shown_but(BACKS_OUT, "backer", stands_from_the_start);
    let (backer, last) = (track(&shown, "backer"), before_contact(&shown));
    let ego = shown.rollout.ego_track().states[last];
    assert!(
        backer.states[0].y < ego.y - 5.0 && backer.states[last].y > backer.states[0].y + 3.0,
        "{:?}",
        backer.states[last]
    );
    assert!(backer.states[last].x > ego.x + 3.0 && backer.states.iter().any(|state| state.speed() < -1.0));
    shown_reason(BACKS_OUT, "backer");
}

#[test]
fn who_comes_towards_the_ego_passes_it_though_nobody_waits() {
    let shown = shown_but(BUS_BY, "oncoming", stands_from_the_start);
    let (bus, last) = (track(&shown, "oncoming"), before_contact(&shown));
    assert!(bus.kind == PartnerKind::Bus && degrees_between(bus.states[last].heading, 0.0) > 170.0);
}

#[test]
fn traffic_of_the_crossing_direction_comes_from_its_side() {
    let shown = shown_but(FOR_CLEARANCE, "crosser", stands_from_the_start);
    let (crosser, ego) = (track(&shown, "crosser"), shown.rollout.ego_track().states[0]);
    assert!(crosser.states[0].y > ego.y + 10.0, "westbound, of one who faces south: from the left");
}

#[test]
fn whom_the_ego_makes_room_for_is_in_the_lane_that_it_leaves() {
    let shown = shown_but(MAKES_ROOM, "merger", |merger| {
        merger.plan.acts.retain(|act| !matches!(act.deed, Deed::Shift { .. }));
    });
    let (merger, last) = (track(&shown, "merger"), before_contact(&shown));
    let began = shown.rollout.ego_track().states[0];
    assert!(
        merger.states[0].y < began.y - 2.5 && (merger.states[last].y - began.y).abs() < 1.7,
        "{:?}",
        merger.states[last]
    );
}

#[test]
fn an_animal_crosses_a_street_and_comes_out_behind_who_is_parked_there() {
    let account = story(EMERGES);
    let shown = made(&account);
    let roads = match &shown.draft.map {
        recrash_model::scenario::MapSpec::G(map) => map.roads.len(),
        other => panic!("{other:?}"),
    };
    assert_eq!(roads, 1, "no road crosses it");
    let (animal, _) = partner(&shown);
    let ego = shown.rollout.ego_track();
    let parked = shown.rollout.actors.iter().filter(|track| track.id.starts_with("kerb"));
    let parked =
        parked.map(|track| (track, track.states[0])).find(|(_, at)| at.y > ego.states[0].y).expect("on the left");
    let out = animal.iter().find(|state| state.y < parked.1.y).expect("it comes across");
    let short_m = out.x - parked.1.x - 0.5 * parked.0.length_m;
    assert!((0.0..3.0).contains(&short_m), "{short_m}");
}

#[test]
fn whom_the_ego_has_gone_round_stands_in_the_lane_to_which_it_came_back() {
    let shown = shown_but(ROUND_AND_BACK, "obstacle", |truck| moved(&mut truck.plan, 60.0, 0.0));
    let (truck, ego) = (track(&shown, "obstacle").states[0], shown.rollout.ego_track());
    let (began, met) = (ego.states[0], ego.states[before_contact(&shown)]);
    assert!(truck.x > began.x && truck.x < met.x && truck.y < began.y - 2.5, "{truck:?}");
}

#[test]
fn whom_the_partner_strikes_first_stands_where_it_is_told_to_be_parked() {
    let shown = shown_but(STRUCK_PARKED, "pusher", |van| moved(&mut van.plan, 0.0, -6.0));
    let (van, (states, met)) = (track(&shown, "pusher"), partner(&shown));
    let last = before_contact(&shown);
    assert_eq!(van.kind, PartnerKind::Van);
    assert!(van.states[..last - 4].iter().all(|state| state.speed() == 0.0), "it stands");
    assert!(van.states[0].y < met.y - 1.0 && states[last].speed() > 1.0, "on the side away from the ego");
}

#[test]
fn who_pulls_out_from_behind_is_struck_on_its_way() {
    let shown = made(&story(PULLS_OUT));
    assert!(shown.is_true(), "{:?}", shown.verdict);
    let (states, met) = partner(&shown);
    let ego = shown.rollout.ego_track().states[0];
    assert!(
        states[0].speed() == 0.0 && (states[0].y - ego.y).abs() < 1.5 && met.y > states[0].y + 0.7,
        "{:?}, {met:?}",
        states[0]
    );
    assert_eq!(track(&shown, "pusher").kind, PartnerKind::PickupTruck);
}

#[test]
fn who_is_passed_between_stands_on_the_side_that_is_touched() {
    let shown = shown_but(BETWEEN, "beside", |van| moved(&mut van.plan, 0.0, -6.8));
    let (van, (states, _)) = (track(&shown, "beside"), partner(&shown));
    let ego = shown.rollout.ego_track().states[before_contact(&shown)];
    let between = states[before_contact(&shown)].y;
    assert!(van.kind == PartnerKind::Van && van.states[0].y > between && between > ego.y, "{between}");
}

#[test]
fn who_drives_in_the_next_lane_stays_there_beside_the_ego() {
    let shown = shown_but(ABREAST, "abreast", stands_from_the_start);
    let (van, last) = (track(&shown, "abreast"), before_contact(&shown));
    let ego = shown.rollout.ego_track().states[last];
    assert!((van.states[last].y - ego.y + 3.4).abs() < 0.3 && (van.states[last].x - ego.x).abs() < 8.0);
    assert!(van.states[last].speed() > 5.0);
}

#[test]
fn crossing_traffic_goes_by_an_ego_that_waits_in_its_turn() {
    let shown = shown_but(IN_ITS_TURN, "crosser", stands_from_the_start);
    let ego = shown.rollout.ego_track().states[before_contact(&shown)];
    assert!(ego.heading.to_degrees() < -5.0, "{ego:?}");
}

#[test]
fn crossing_traffic_that_stands_in_the_junction_is_across_it() {
    let text = "The AV was stopped facing north on Elm Street at a red light at the intersection with Oak Street. When the light turned green, cross \
                traffic remained stopped in the intersection and the AV remained stationary.";
    let shown = shown_but(text, "blocker", |blocker| moved(&mut blocker.plan, 0.0, 14.0));
    assert!(degrees_between(track(&shown, "blocker").states[0].heading, 0.0) > 80.0);
}

#[test]
fn a_thing_in_the_way_lies_ahead_and_is_said_to_be_assumed() {
    let shown = shown_reason(DEBRIS, "thing");
    let (thing, last) = (track(&shown, "thing"), before_contact(&shown));
    let ego = shown.rollout.ego_track().states[last];
    assert_eq!(thing.kind, PartnerKind::FixedObject);
    assert!((3.0..9.0).contains(&(thing.states[0].x - ego.x)), "{:?}", thing.states[0]);
    assert!(shown.assumed.iter().any(|words| words.contains("a thing")), "{:?}", shown.assumed);
}

#[test]
fn an_ego_gives_way_to_an_animal() {
    shown_reason(FOR_ANIMAL, "animal");
}

#[test]
fn who_gives_way_to_nobody_who_is_named_does_so_to_somebody_assumed() {
    let shown = shown_reason(TO_NOBODY, "oncoming");
    assert!(shown.assumed.iter().any(|words| words.contains("comes by from ahead")), "{:?}", shown.assumed);
}

/// Whether the ego stands for what is told, once one actor of the scene is changed so.
fn reason_but(text: &str, id: &str, change: impl Fn(&mut Actor)) -> Option<CheckResult> {
    let account = told(text);
    let shown = made(&account);
    let result = |draft: ScenarioDraft| {
        let scenario = recrash_roads::check(draft).expect("it can run").value;
        let verdict = held_against(&account, &scenario, &simulate(&scenario, Ego::Recorded)).expect("it can be staged");
        verdict.checks.iter().find(|check| check.kind == CheckKind::Reason).map(|check| check.result)
    };
    assert_eq!(result(shown.draft.clone()), Some(CheckResult::Shown), "{:?}", shown.verdict);
    let mut draft = shown.draft;
    change(draft.actors.iter_mut().find(|actor| actor.id == id).expect("it is there"));
    result(draft)
}

#[test]
fn the_emergency_vehicle_that_the_ego_waits_for_may_be_the_partner() {
    let open = Some(CheckResult::CannotBeShown);
    assert_eq!(reason_but(FOR_FIRE_TRUCK, "cp", |actor| actor.kind = PartnerKind::Bus), open, "a bus is none");
}

#[test]
fn a_parked_partner_ahead_blocks_the_way() {
    assert_eq!(reason_but(BUS_BACKS, "cp", |_| {}), Some(CheckResult::Shown));
}

#[test]
fn a_queue_that_leaves_no_room_stands_behind_the_junction() {
    shown_reason(FULL_BEHIND, "beyond");
}

#[test]
fn whom_the_ego_stood_behind_stays_where_the_ego_leaves_its_lane() {
    let shown = shown_but(CHANGES_BEHIND, "lead", |actor| moved(&mut actor.plan, 60.0, 0.0));
    let lead = &track(&shown, "lead").states[..before_contact(&shown)];
    assert!(lead.iter().all(|state| state.speed() < 0.1), "{lead:?}");
}

#[test]
fn who_turns_right_before_crossing_traffic_does_so_at_red() {
    let mut account = story(RIGHT_AT_LIGHT);
    let turns = || Some(Fact::by_rule(Movement::RightTurn, "a column"));
    account.sv.movement = turns();
    account.partner.as_mut().expect("a van").movement = turns();
    let shown = made(&account);
    assert_eq!(others(&shown.draft, &account), Some(CheckResult::Shown), "{:?}", shown.verdict);
    let shows = |at: &str| shown.draft.control.iter().find(|control| control.at == at)?.device.aspect(0.0);
    assert_eq!([shows("own-"), shows("left-")], [Some(Aspect::Red), Some(Aspect::Green)]);
    let mut stands = shown.draft.clone();
    stands_from_the_start(stands.actors.iter_mut().find(|actor| actor.id == "crosser").expect("it crosses"));
    assert_eq!(others(&stands, &account), Some(CheckResult::CannotBeShown));
}

#[test]
fn who_crosses_into_the_lane_ahead_of_an_ego_that_stands_does_not_touch_it() {
    let shown = shown_but(TRAILER_ACROSS, "merger", |actor| moved(&mut actor.plan, 80.0, 0.0));
    assert_eq!(track(&shown, "merger").kind, PartnerKind::HeavyTruck);
}

#[test]
fn who_is_told_is_there_though_the_partner_swings_farther_than_it_would_alone() {
    shown_but(PASSED_IN_TRAFFIC, "lead", |actor| moved(&mut actor.plan, 60.0, 0.0));
}

#[test]
fn who_comes_by_an_ego_that_waits_at_red_has_green() {
    let shown = shown_but(AT_RED, "oncoming", |oncoming| {
        oncoming.plan = ActorPlan::standing(oncoming.plan.start.clone());
    });
    let (oncoming, last) = (track(&shown, "oncoming"), before_contact(&shown));
    let ego = shown.rollout.ego_track().states[last];
    assert!(oncoming.states[0].x > ego.x && oncoming.states[last].x < ego.x, "{:?}", oncoming.states[last]);
}

#[test]
fn slow_traffic_ahead_of_an_ego_that_drifts_slows_ahead() {
    let shown = shown_but(SLOW_AHEAD, "slower", |slower| slower.plan.acts.clear());
    let (slower, last) = (track(&shown, "slower"), before_contact(&shown));
    assert!(slower.states[last].x > shown.rollout.ego_track().states[last].x + 4.0);
    assert!(slower.states[last].speed() < slower.states[0].speed() - 0.8);
}

const COMES_IN: &str = "The AV was traveling north in the center lane of three lanes on Elm Street when a hatchback in the adjacent right lane changed lanes to the left, and \
                        the test driver disengaged.";
const CUTS_IN: &str = "The AV was traveling south in the right lane on Elm Street when a hatchback cut into the lane of the AV. The AV swerved to the left and the front left \
                       of the AV made contact with the right side of a pickup truck that was traveling in the left lane.";
const HEADS_OVER: &str = "The AV was traveling north in the center lane on Elm Street. A box truck in the next lane to the right began to drift toward the lane of the AV, so the \
                          AV slowed to a stop.";
const RIDES_IN: &str = "The AV was traveling north on Elm Street when a bicyclist changed lanes to the left in front of the AV, and the AV slowed.";
const BY_PARKED: &str = "The AV was traveling north in the left lane on Elm Street and was passing a parked bus when a sedan in the right lane moved to the left, and the front \
                         left of the sedan made contact with the front right of the AV.";
const MOVES_ON: &str =
    "The AV was traveling north on Elm Street. Traffic ahead of the AV was moving. The AV slowed to make a delivery.";
const STEPS_OUT: &str = "The AV was stopped at a red light at the intersection of Elm Street and Oak Street. When the light turned green, the AV began to move. A pedestrian \
                         then stepped off the curb and crossed the street, and the AV braked. A van behind the AV accelerated and the front of the van made contact with the \
                         rear of the AV.";
const IN_LANE: &str = "The AV was traveling west in the right lane on Elm Street when it approached a delivery van that was parked in-lane, and the AV slowed to a stop to yield \
                       to the delivery van.";
const MAKES_WAY: &str = "The AV was traveling east on Elm Street and moved to the right to make room for an oncoming bus. The front right of the AV made contact with the left \
                         side mirror of a sedan that was parked at the curb.";
const ANSWERS: &str = "The AV was traveling east in the right lane of two lanes on Elm Street. A sedan pulled out of a driveway on the right and entered the lane of the AV. The \
                       AV braked and changed lanes to the left. The sedan continued turning left and the left side of the sedan made contact with the front of the AV.";

/// Whether somebody who was beside the ego, to its left or right, is ahead of it in the lane where that came.
fn has_come_in(shown: &Reconstruction, left: f64) -> bool {
    let (merger, last) = (track(shown, "merger"), before_contact(shown));
    let ego = &shown.rollout.ego_track().states;
    let ahead = Vec2::from_heading(ego[0].heading);
    let aside_m = |step: usize| ahead.cross(merger.states[step].position() - ego[0].position());
    let before_m = ahead.dot(merger.states[last].position() - ego[last].position());
    left * aside_m(0) > 2.5 && aside_m(last).abs() < 1.0 && before_m > 4.0
}

#[test]
fn who_changes_lanes_towards_the_ego_comes_into_its_lane_though_it_does_not_slow_for_that() {
    let keeps = |merger: &mut Actor| merger.plan.acts.retain(|act| !matches!(act.deed, Deed::Shift { .. }));
    assert!(has_come_in(&shown_but(COMES_IN, "merger", keeps), -1.0));
    // Who cuts in, and is not told from where, comes from the side from which the ego swerves.
    assert!(has_come_in(&shown_but(CUTS_IN, "merger", keeps), -1.0));
    let other_way =
        CUTS_IN.replace("the right lane on", "the left lane on").replace("swerved to the left", "swerved to the right");
    let other_way = other_way
        .replace("front left of the AV", "front right of the AV")
        .replace("the right side of a", "the left side of a");
    assert!(has_come_in(&made(&told(&other_way.replace("in the left lane.", "in the right lane."))), 1.0));
}

#[test]
fn who_heads_over_or_rides_into_the_egos_lane_is_why_it_slows() {
    assert!(has_come_in(&made(&told(HEADS_OVER)), -1.0));
    let shown = made(&told(RIDES_IN));
    assert!(track(&shown, "merger").kind == PartnerKind::Cyclist && has_come_in(&shown, -1.0));
}

#[test]
fn one_that_is_parked_and_passed_is_abreast_where_the_partner_comes_over() {
    let shown = made(&told(BY_PARKED));
    let (kerb, ego) = (track(&shown, "kerb"), shown.rollout.ego_track().states[before_contact(&shown)]);
    assert!(kerb.kind == PartnerKind::Bus && (kerb.states[0].x - ego.x).abs() < 4.0, "{:?}", kerb.states[0]);
    assert!((kerb.states[0].y - ego.y).abs() > 4.0, "beside the lanes");
}

#[test]
fn traffic_that_is_told_to_move_ahead_of_an_ego_that_moves_does_not_stand() {
    let shown = shown_but(MOVES_ON, "near", stands_from_the_start);
    let near = track(&shown, "near");
    assert!(near.states[..=before_contact(&shown)].iter().all(|state| state.speed() > 2.0));
    assert!(shown.rollout.actors.iter().all(|track| track.id != "lead"));
}

#[test]
fn who_steps_out_after_the_ego_has_set_off_does_not_cross_before() {
    let shown = made(&told(STEPS_OUT));
    let (walker, ego) = (track(&shown, "walker"), shown.rollout.ego_track());
    let off = ego.states.iter().position(|state| state.speed() > 1.0).expect("it sets off");
    assert!(walker.states[off].y < ego.states[off].y - 2.0, "{:?}", walker.states[off]);
    let last = before_contact(&shown);
    assert!(walker.states[last].y > ego.states[last].y - 2.0 && walker.states[last].x > ego.states[last].x);
}

#[test]
fn one_parked_in_the_lane_for_which_the_ego_stops_stands_ahead_in_it() {
    let shown = made(&told(IN_LANE));
    let (lead, ego) = (track(&shown, "lead"), shown.rollout.ego_track().states[before_contact(&shown)]);
    assert!(lead.kind == PartnerKind::Van && (lead.states[0].y - ego.y).abs() < 0.5, "{:?}", lead.states[0]);
    assert!(shown.rollout.actors.iter().all(|track| !matches!(track.id.as_str(), "oncoming" | "kerb")));
}

#[test]
fn who_comes_towards_an_ego_that_goes_aside_for_it_comes_by() {
    let shown = shown_but(MAKES_WAY, "oncoming", |oncoming| moved(&mut oncoming.plan, 150.0, 0.0));
    let (oncoming, last) = (track(&shown, "oncoming"), before_contact(&shown));
    let ego = shown.rollout.ego_track();
    assert!(oncoming.kind == PartnerKind::Bus && ego.states[last].y < ego.states[0].y - 0.3);
    assert!(oncoming.states[0].x > ego.states[0].x && oncoming.states[last].x < ego.states[last].x);
}

#[test]
fn an_ego_that_changes_lanes_for_who_comes_out_does_so_after_that() {
    let shown = made(&story(ANSWERS));
    let ((states, _), ego) = (partner(&shown), shown.rollout.ego_track());
    let moves = ego.states.iter().position(|state| state.y > ego.states[0].y + 0.5).expect("it changes lanes");
    // The front of the sedan is out of the driveway.
    assert!(states[moves].y > states[0].y + 1.0, "{:?} at {moves}", states[moves]);
}

const SIGN: &str = "The AV was traveling north on Elm Street and came to a stop at a four-way stop at the intersection with Oak Street to yield to another vehicle.";
const STEADY: &str = "The AV was traveling north in the center lane of three lanes on Elm Street. An SUV was traveling in the right lane. The AV slowed.";

#[test]
fn whom_the_ego_yields_to_at_a_stop_sign_is_on_the_crossing_road() {
    let shown = shown_but(SIGN, "crosser", stands_from_the_start);
    assert!(shown.rollout.actors.iter().all(|track| track.id != "lead"));
    // Who is told to stand ahead does.
    let ahead = made(&told(&SIGN.replace("another vehicle", "another vehicle that was stopped ahead of the AV")));
    assert!(ahead.rollout.actors.iter().all(|track| track.id != "crosser"));
}

#[test]
fn who_drives_abreast_does_not_brake_with_an_ego_that_slows() {
    let shown = shown_but(STEADY, "abreast", |abreast| moved(&mut abreast.plan, 60.0, 0.0));
    let abreast = track(&shown, "abreast");
    let speeds: Vec<f64> = (0..=before_contact(&shown)).map(|step| abreast.states[step].speed()).collect();
    assert!(speeds.iter().all(|speed| (speed - speeds[0]).abs() < 0.1) && speeds[0] > 4.0, "{speeds:?}");
}

const PARKING: &str = "The AV was traveling north in the right lane on Elm Street and slowed to a stop for a pickup truck that was parallel parking in front of the AV.";

#[test]
fn who_is_parking_ahead_stands_half_out_of_the_lane() {
    let shown = made(&told(PARKING));
    let (lead, ego) = (track(&shown, "lead").states[0], shown.rollout.ego_track().states[before_contact(&shown)]);
    assert!((1.0..2.5).contains(&(ego.y - lead.y)) && lead.heading > 0.2, "{lead:?}");
    // Who stands there does not.
    let stands = made(&told(&PARKING.replace("parallel parking", "stopped")));
    let (lead, ego) = (track(&stands, "lead").states[0], stands.rollout.ego_track().states[before_contact(&stands)]);
    assert!((ego.y - lead.y).abs() < 0.5 && lead.heading.abs() < 0.1, "{lead:?}");
}

const ROUND_PARKED: &str = "The AV was traveling north on Elm Street and moved to the left to go around a van parked on the right, and was moving back to the right when a \
                            sedan from behind made contact with the rear of the AV.";

#[test]
fn whom_the_ego_is_told_to_go_round_is_not_just_parked_beside_it() {
    let made = recrash_reconstruct::reconstruct(&told(ROUND_PARKED)).expect("it can be staged");
    let others = made.verdict.checks.iter().find(|check| check.kind == CheckKind::Others).expect("one is told");
    assert!(others.expected.contains("goes round"), "{others:?}");
}

#[test]
fn who_comes_towards_an_ego_before_that_goes_aside_is_not_made_room_for() {
    let account = told(MAKES_WAY);
    let mut early = made(&account).draft;
    let oncoming = early.actors.iter_mut().find(|actor| actor.id == "oncoming").expect("it is there");
    moved(&mut oncoming.plan, -25.0, 0.0);
    assert_eq!(others(&early, &account), Some(CheckResult::CannotBeShown));
}

#[test]
fn a_lane_change_that_is_executed_is_not_cut_in() {
    let words = "a hatchback cut into the lane of the AV";
    let executed = CUTS_IN.replace(words, "a hatchback executed a lane change");
    assert!(executed != CUTS_IN);
    let made = recrash_reconstruct::reconstruct(&told(&executed)).expect("it can be staged");
    assert!(made.rollout.actors.iter().all(|track| track.id != "merger"), "{:?}", made.verdict);
}
