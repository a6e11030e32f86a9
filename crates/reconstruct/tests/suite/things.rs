//! Things lie as they are told, others do not crash by themselves, and who parks or comes out from beside the road does so.

use crate::ways::{before_contact, degrees_between, made, missed, partner, partner_without_acts, speeds, story};
use recrash_model::account::{Account, Act, Fact, Kind, LeftRight, Origin, Source, StandReason};
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_model::rollout::EventKind;
use recrash_model::scenario::{MapSpec, ObjectSpec, ObstacleKind, Place, StripKind};
use recrash_model::zones::ContactZone;
use recrash_reconstruct::{Reconstruction, held_against, reconstruct};
use recrash_records::{SAMPLE_CSV, SAMPLE_NAME, SourceText, ingest};

const BEHIND_TWO: &str = "The AV was traveling north when it came to a stop behind a sedan and yielded to a pedestrian crossing the street. A \
                          van approached from behind and the front of the van made contact with the rear of the stationary AV.";

const BUMP: &str = "The AV was traveling east when the underside of the AV made contact with a speed bump.";

const PAVEMENT: &str =
    "The AV was traveling east on Elm Street when the underside of the AV made contact with the pavement.";

const COVER: &str =
    "The AV was traveling east on Elm Street when the undercarriage of the AV scraped a steel drain cover.";

const HOLE_IN_IT: &str =
    "The AV was traveling east on Elm Street when the underside of the AV made contact with a pothole.";

const HURLED: &str = "The AV was traveling east in the right lane when a piece of debris was propelled into the roadway and made contact with the front \
                      right of the AV.";

const TRIMMER: &str =
    "The AV was traveling east in a parking lot when the front left of the AV made contact with a string trimmer.";

const EDGE: &str = "The AV was traveling north on Elm Street. As the AV turned left into a parking lot, the underside of the AV made contact \
                    with the driveway pavement.";

const HOLE: &str = "The AV was traveling south in the right lane. The AV changed lanes to the left lane and continued traveling south when \
                    the front left of the AV made contact with a pothole.";

const REAR_WHEEL: &str =
    "The AV was traveling north on Elm Street when the rear right tire of the AV made contact with a pothole.";

const ANIMAL: &str =
    "The AV was traveling north on Elm Street when the AV made contact with a small dog that was lying in the roadway.";

const ROLLED_IN: &str = "The AV was traveling east when the left side of the AV made contact with an object that was rolling into the AV's lane \
                         from the left side of the road. The AV moved to the right but was not able to avoid contact.";

const BACKED_IN: &str = "The AV was parked at the curb facing south when an SUV attempting to parallel park in front of the AV reversed, and \
                         the rear of the SUV made contact with the front of the stationary AV.";

const BACKED_OUT: &str = "The AV was parked at the curb when an SUV reversed out of a driveway on the left side of the street, and the rear \
                          right of the SUV made contact with the left side of the stationary AV.";

const STALL: &str = "The AV was traveling north, passing a sedan that was stopped in a perpendicular parking space. The sedan began reversing \
                     and the rear right corner of the sedan made contact with the left side of the AV.";

const DRIVEWAY: &str = "The AV was stopped at the curb when a sedan exiting a driveway behind the AV passed the AV on the left, and the right \
                        side of the sedan made contact with the rear left of the stationary AV.";

const CHAIN: &str = "The AV was stopped in traffic. A sedan behind the AV was rear-ended by a pickup truck, causing the front of the sedan to \
                     make contact with the rear of the stationary AV.";

const TRAILER: &str = "The AV was traveling north on a narrow street when it came to a stop to yield to an oncoming heavy truck. As the heavy \
                       truck passed the stationary AV, the left side of the heavy truck's trailer made contact with the rear left side \
                       of the AV.";

const TRAILER_OF_TRUCK: &str = "The AV was traveling north on a narrow street when it came to a stop to yield to an oncoming heavy truck. As the \
                                heavy truck passed the stationary AV, the left side of the flat trailer attached to the heavy truck made \
                                contact with the rear left side of the AV.";

const BARRED: &str = "The AV was traveling north on Elm Street. The AV turned left into a parking lot and the front of the AV made contact with a chain \
                      across the entrance.";

const FALLEN: &str = "The AV was traveling east in the right lane when the front of the AV made contact with a fallen street sign that was lying in the lane.";

const OVERHANGS: &str = "The AV was traveling east on Elm Street when the front right of the AV made contact with a tree branch that was hanging over the lane.";

const BLEW_OFF: &str = "The AV was traveling in the center lane of a highway behind a flatbed truck when a sheet of plywood blew off the flatbed truck and \
                        struck the front of the AV.";

/// The stories of this file, as they are shown.
pub fn shown() -> Vec<(String, Account, Reconstruction)> {
    let texts =
        [BEHIND_TWO, BUMP, TRIMMER, EDGE, HOLE, ROLLED_IN, BACKED_IN, BACKED_OUT, STALL, DRIVEWAY, CHAIN, TRAILER];
    texts.into_iter().map(|text| (text[..40].to_owned(), story(text), made(&story(text)))).collect()
}

/// Whether two others touch whom nobody had touched before; who throws the partner does so.
fn others_crash(made: &Reconstruction) -> bool {
    let actors = &made.rollout.actors;
    let mut touched = vec![false; actors.len()];
    made.rollout.events.iter().any(|event| match event.kind {
        EventKind::Contact { a, b, .. } => {
            let throws = [a, b].iter().any(|number| actors[*number].id == "pusher");
            let crash = a > 0 && !touched[a] && !touched[b] && !throws;
            (touched[a], touched[b]) = (a > 0, true);
            crash
        }
        _ => false,
    })
}

/// The thing that lies on the road.
pub fn thing(made: &Reconstruction) -> (&ObjectSpec, f64, f64) {
    let object = made.draft.objects.first().expect("a thing");
    let Place::Plane { x_m, y_m, .. } = object.at else { panic!("{:?}", object.at) };
    (object, x_m, y_m)
}

#[test]
fn nobody_crashes_of_whom_it_is_not_told() {
    let sources = [SourceText { name: SAMPLE_NAME, bytes: SAMPLE_CSV.as_bytes() }];
    let mut profile: SystemProfile =
        toml::from_str(include_str!("../../../../profiles/paper.toml")).expect("a profile");
    profile.records.dedupe = Dedupe::None;
    let records = ingest(&sources, &profile).expect("the sample").value.records;
    let accounts: Vec<_> = recrash_reader::incidents(&records).iter().filter_map(recrash_reader::account).collect();
    assert!(accounts.len() > 20, "{}", accounts.len());
    for account in &accounts {
        let Ok(made) = reconstruct(account) else { continue };
        assert!(!made.is_true() || !others_crash(&made), "{}", account.report);
    }
}

#[test]
fn who_crosses_between_the_ego_and_the_one_ahead_runs_into_nobody() {
    let account = story(BEHIND_TWO);
    let shown = made(&account);
    let ids: Vec<&str> = shown.rollout.actors.iter().map(|track| track.id.as_str()).collect();
    assert!(ids.contains(&"lead") && ids.contains(&"walker"), "{ids:?}");
    assert!(!others_crash(&shown));
}

#[test]
fn a_crosswalk_and_the_partner_are_nobody_that_the_ego_stood_for() {
    let mut account = story(CHAIN);
    account.sv.reasons.push(Fact::by_rule(StandReason::Pedestrian, "made for this test"));
    assert!(made(&account).rollout.actors.iter().all(|track| track.id != "walker"));
}

#[test]
fn a_speed_bump_lies_across_the_lane() {
    let account = story(BUMP);
    let shown = made(&account);
    let (object, _, y_m) = thing(&shown);
    let size = object.size.expect("its size");
    assert!(size.width_m > 3.0 && size.length_m < 1.0 && y_m.abs() < 0.1, "{object:?}");
}

#[test]
fn what_the_underside_scrapes_is_no_hole_under_a_wheel() {
    let pavement = made(&story(PAVEMENT));
    let (object, ..) = thing(&pavement);
    assert!(object.kind == ObstacleKind::Kerb && object.size.is_some_and(|size| size.width_m > 3.0), "{object:?}");
    let cover = made(&story(COVER));
    let (object, _, y_m) = thing(&cover);
    let ego = cover.rollout.ego_track().states[before_contact(&cover)];
    assert!(object.kind == ObstacleKind::Pothole && (y_m - ego.y).abs() < 0.1, "{object:?}");
    // A hole is under a wheel, whatever touched the road there.
    let hole = made(&story(HOLE_IN_IT));
    let (object, _, y_m) = thing(&hole);
    let ego = hole.rollout.ego_track().states[before_contact(&hole)];
    assert!(object.kind == ObstacleKind::Pothole && (y_m - ego.y).abs() > 0.3, "{object:?}");
}

#[test]
fn what_was_hurled_into_the_road_by_nobody_comes_there() {
    let shown = made(&story(HURLED));
    assert!(shown.is_true(), "{:?}", shown.verdict);
    assert!(shown.verdict.checks.iter().all(|check| check.kind != CheckKind::PassedOn));
    // Who pushed it is not drawn.
    let mut account = story(HURLED);
    let acts = &mut account.partner.as_mut().unwrap().acts;
    let push = acts.iter_mut().find(|fact| fact.act == Act::Pushed).unwrap();
    push.source = Source::Words { start: 0, end: 15, text: "pushed a pallet".to_owned() };
    let pushed = made(&account);
    let by = pushed.verdict.checks.iter().find(|check| check.kind == CheckKind::PassedOn).unwrap();
    assert_eq!(by.result, CheckResult::CannotBeShown, "{by:?}");
}

#[test]
fn a_tool_is_small() {
    let account = story(TRIMMER);
    let shown = made(&account);
    let (object, ..) = thing(&shown);
    assert!(object.kind == ObstacleKind::Debris && object.size.is_some_and(|size| size.width_m < 1.0), "{object:?}");
}

#[test]
fn a_raised_pavement_lies_across_the_entry() {
    let shown = made(&story(EDGE));
    let (object, x_m, y_m) = thing(&shown);
    assert!(object.kind == ObstacleKind::Kerb && object.size.is_some_and(|size| size.width_m > 3.0), "{object:?}");
    // The arm to the left begins 13 m from the junction's centre, which is 5.1 m to the left of the ego's line.
    assert!((17.0..20.0).contains(&y_m) && x_m.abs() < 5.0, "{object:?}");
    let ego = shown.rollout.ego_track().states[before_contact(&shown)];
    assert!(degrees_between(ego.heading, 90.0_f64.to_radians()) < 35.0, "{ego:?}");
}

#[test]
fn a_hole_lies_under_the_told_wheel_where_the_lane_change_is_over() {
    let shown = made(&story(HOLE));
    let (object, _, y_m) = thing(&shown);
    let last = before_contact(&shown);
    let (ego, before) = (shown.rollout.ego_track().states[last], shown.rollout.ego_track().states[last - 10]);
    assert!((y_m - ego.y - 0.7).abs() < 0.2, "{object:?} {ego:?}");
    assert!(ego.heading.abs() < 0.01 && (ego.y - before.y).abs() < 0.05 && ego.y > 3.0, "{ego:?}");
}

#[test]
fn a_thing_that_is_told_to_roll_in_with_its_way_rolls() {
    let mut account = story(ROLLED_IN);
    // As the reader has it where the words stand with the way alone.
    partner_without_acts(&mut account, &[Act::Roll]);
    account.partner.as_mut().expect("a thing").state = None;
    let source = Source::Words { start: 0, end: 0, text: "rolling into the AV's lane".to_owned() };
    account.came_from = Some(Fact { value: Origin::Beside { side: LeftRight::Left }, source });
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(states[0].y > 3.0 && met.speed() > 1.0 && met.y < 2.0, "{met:?}");
    // The ego moved away from it before.
    let ego = shown.rollout.ego_track().states[before_contact(&shown)];
    assert!(ego.y < -0.5, "{ego:?}");
    let lies = missed(&account, |less| {
        less.came_from = Some(Fact::by_rule(Origin::Beside { side: LeftRight::Left }, "made for this test"));
    });
    assert!(lies.contains(&CheckKind::CpState), "{lies:?}");
}

#[test]
fn who_parks_in_reverse_swings_towards_the_kerb() {
    let account = story(BACKED_IN);
    let shown = made(&account);
    let (states, met) = partner(&shown);
    let ego = shown.rollout.ego_track().states[0];
    let MapSpec::G(map) = &shown.draft.map else { panic!("{:?}", shown.draft.map) };
    assert!(map.roads[0].right.iter().any(|strip| strip.kind == StripKind::Parking));
    // The ego stands in the parking strip; the SUV came along the lane, stood, and backs in.
    assert!(ego.y < -2.5, "{ego:?}");
    let stood = states.iter().position(|state| state.speed() == 0.0).expect("it stands");
    assert!(states[0].speed() > 1.0 && states[stood].y.abs() < 0.1 && states[stood].x > met.x + 5.0);
    assert!(met.y < -0.8 && (15.0..40.0).contains(&met.heading.to_degrees()), "{met:?}");
    let straight = missed(&account, |less| partner_without_acts(less, &[Act::Park]));
    assert!(straight.contains(&CheckKind::CpMovement), "{straight:?}");
}

#[test]
fn who_backs_out_of_a_driveway_begins_behind_the_kerb() {
    let account = story(BACKED_OUT);
    let shown = made(&account);
    let (states, met) = partner(&shown);
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    assert!(states[0].y > met.y + 6.0 && degrees_between(states[0].heading, 0.0) > 30.0, "{:?}", states[0]);
    assert!(scenario.network().area("main.driveways[0]").is_some());
    assert!(states.iter().all(|state| scenario.network().on_road(state.position())));
    let along = missed(&account, |less| {
        less.came_from = Some(Fact::by_rule(Origin::Beside { side: LeftRight::Left }, "made for this test"));
    });
    assert!(along.contains(&CheckKind::Approach), "{along:?}");
}

#[test]
fn who_backs_out_of_a_stall_beside_the_road_stands_crosswise_in_it() {
    let account = story(STALL);
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(degrees_between(states[0].heading, 0.0) > 30.0 && states[0].y > met.y + 3.0, "{:?}", states[0]);
    let MapSpec::G(map) = &shown.draft.map else { panic!("{:?}", shown.draft.map) };
    assert!(map.roads[0].left.iter().any(|strip| strip.kind == StripKind::Stalls));
}

#[test]
fn who_comes_out_of_a_driveway_behind_the_ego_turns_from_there() {
    let account = story(DRIVEWAY);
    let shown = made(&account);
    let (states, met) = partner(&shown);
    let ego = shown.rollout.ego_track().states[before_contact(&shown)];
    assert!(states[0].x < ego.x && states[0].y < -5.0 && degrees_between(states[0].heading, 0.0) > 60.0);
    assert!(met.heading < states[0].heading - 0.3, "{met:?}");
}

#[test]
fn who_threw_the_partner_is_of_the_told_kind() {
    let account = story(CHAIN);
    let shown = made(&account);
    let pusher = shown.rollout.actors.iter().find(|track| track.id == "pusher").expect("who threw it");
    assert_eq!(pusher.kind, PartnerKind::PickupTruck);
    let car = missed(&account, |less| {
        for other in less.others.iter_mut().filter(|other| other.touched_partner) {
            other.kind = Fact::by_rule(Kind::PassengerCar, "made for this test");
        }
    });
    assert_eq!(car, [CheckKind::PassedOn]);
    assert!(speeds(&shown).len() > 50);
}

#[test]
fn a_trailer_that_touched_touches_and_who_draws_it_gets_by() {
    for text in [TRAILER, TRAILER_OF_TRUCK] {
        let shown = made(&story(text));
        let (step, actors) = (before_contact(&shown) + 1, &shown.rollout.actors);
        let trailer = actors.iter().find(|track| track.id == "cp.trailer").expect("a trailer");
        let tractor = actors.iter().find(|track| track.id == "cp").expect("who draws it");
        let ego = shown.rollout.ego_track();
        assert!(trailer.outline(step).overlaps(&ego.outline(step)));
        assert!((0..=step).all(|step| !tractor.outline(step).overlaps(&ego.outline(step))));
    }
}

#[test]
fn what_a_rear_wheel_is_told_to_have_met_goes_under_that() {
    let shown = made(&story(REAR_WHEEL));
    let zones = |made: &Reconstruction, account: &Account| {
        let scenario = recrash_roads::check(made.draft.clone()).expect("it ran").value;
        let verdict = held_against(account, &scenario, &made.rollout).expect("it can be staged");
        verdict.checks.into_iter().find(|check| check.kind == CheckKind::SvZones).expect("zones").result
    };
    let mut account = story(REAR_WHEEL);
    assert_eq!(zones(&shown, &account), CheckResult::Shown, "{:?}", shown.verdict);
    account.sv.zones = vec![Fact::by_rule(ContactZone::RearLeft, "made for this test")];
    assert_eq!(zones(&shown, &account), CheckResult::NotShown);
}

#[test]
fn an_animal_that_touched_the_underside_is_clear_of_the_sides() {
    let mut account = story(ANIMAL);
    account.sv.zones = vec![Fact::by_rule(ContactZone::Bottom, "ticked")];
    let shown = made(&account);
    let zones = |left_m: f64| {
        let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
        let mut rollout = shown.rollout.clone();
        let events = rollout.events.iter_mut().filter_map(|event| match &mut event.kind {
            EventKind::Contact { a: 0, b_state, .. } => Some(b_state),
            _ => None,
        });
        events.for_each(|state| state.y += left_m);
        let verdict = held_against(&account, &scenario, &rollout).expect("it can be staged");
        verdict.checks.into_iter().find(|check| check.kind == CheckKind::SvZones).expect("zones").result
    };
    assert_eq!(zones(0.0), CheckResult::Shown, "{:?}", shown.verdict);
    assert_eq!([zones(2.0), zones(-2.0)], [CheckResult::CannotBeShown; 2]);
}

#[test]
fn what_bars_an_entrance_is_across_the_way_of_who_turns_in() {
    let shown = made(&story(BARRED));
    let (object, ..) = thing(&shown);
    let Place::Plane { heading_deg, .. } = object.at else { panic!("{:?}", object.at) };
    let ego = shown.rollout.ego_track().states[before_contact(&shown)];
    let off = degrees_between(heading_deg.to_radians(), ego.heading);
    assert!(
        ego.heading > 1.0 && object.size.is_some_and(|size| size.width_m > 3.0) && off < 20.0,
        "{object:?} {ego:?}"
    );
    // Lengthwise it bars nothing.
    let mut draft = shown.draft.clone();
    let Place::Plane { heading_deg, .. } = &mut draft.objects[0].at else { panic!("{:?}", draft.objects[0].at) };
    *heading_deg += 90.0;
    let scenario = recrash_roads::check(draft).expect("it can be drawn").value;
    let rollout = recrash_sim::simulate(&scenario, recrash_sim::Ego::Recorded);
    let held = held_against(&story(BARRED), &scenario, &rollout).expect("told");
    assert!(held.failures().any(|check| check.kind == CheckKind::Approach), "{held:?}");
}

#[test]
fn a_sign_that_has_fallen_lies_across_the_lane_and_one_that_stands_does_not() {
    let shown = made(&story(FALLEN));
    let (object, ..) = thing(&shown);
    assert!(object.kind == ObstacleKind::Debris && object.size.is_some_and(|size| size.width_m > 1.5), "{object:?}");
    let stands = made(&story(&FALLEN.replace("a fallen street sign that was lying in the lane", "a street sign")));
    assert_eq!(thing(&stands).0.kind, ObstacleKind::Warning);
}

#[test]
fn a_branch_that_hangs_into_the_lane_does_so_from_beside_it() {
    let width_m = |text: &str| thing(&made(&story(text))).0.size.map_or(0.0, |size| size.width_m);
    let shown = made(&story(OVERHANGS));
    let (object, _, y_m) = thing(&shown);
    let right_m = shown.rollout.ego_track().states[0].y - y_m + 0.5 * object.size.map_or(0.0, |size| size.width_m);
    assert!(right_m > 2.5, "{object:?}");
    assert!(width_m(&OVERHANGS.replace("hanging over", "lying in")) < 1.0);
}

#[test]
fn what_blows_off_the_truck_ahead_comes_along_with_it_on_a_highway_too() {
    let account = story(BLEW_OFF);
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(states[0].speed() > 10.0 && met.speed() < states[0].speed() - 5.0, "{:?} {met:?}", states[0]);
    let truck = shown.rollout.actors.iter().find(|track| track.id == "near").expect("the truck");
    let last = before_contact(&shown);
    assert!((truck.states[last].y - truck.states[0].y).abs() < 0.5, "{:?}", truck.states[last]);
    let behind_m = truck.states[0].x - states[0].x - 0.5 * truck.length_m;
    assert!((0.0..4.0).contains(&behind_m), "{behind_m}");
    // What had fallen off lay there.
    let lying = "the front of the AV made contact with a sheet of plywood lying in the lane";
    let lay =
        story(&BLEW_OFF.replace("a sheet of plywood blew off the flatbed truck and struck the front of the AV", lying));
    assert!(made(&lay).rollout.actors.iter().all(|track| track.id != "cp"));
}
