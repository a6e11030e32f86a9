//! What is told of the way to the contact is drawn; and a rollout without it does not pass for it.

use crate::common::account_of;
use recrash_model::account::{Account, Act, Fact, LeftRight, Origin};
use recrash_model::math;
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::rollout::{ActorState, Event, EventKind, Role};
use recrash_model::template::Movement;
use recrash_reconstruct::{Reconstruction, held_against, reconstruct};

const MOVED_UP: &str = "The AV was stopped in a queue of traffic for a red light. The AV proceeded forward a short distance and came to \
                        a stop. A car approached from behind and the front of the car made contact with the rear of the \
                        stationary AV.";

const REVERSED_FIRST: &str = "The AV was traveling north behind a truck when the truck came to a stop and the AV stopped behind it. The \
                              AV reversed and came to a stop. The truck reversed and the rear of the truck made contact with \
                              the front of the stationary AV.";

const FROM_THE_KERB: &str = "The AV was stopped in the right lane of Elm Street. A van that was parked at the curb behind the AV pulled out \
                             and passed the AV on the left, and the right side of the van made contact with the rear left corner \
                             of the stationary AV.";

const CROSSED_OVER: &str = "The AV was traveling east on Oak Street. An oncoming sedan drifted to its left, and the front of the sedan made \
                            contact with the front right of the AV.";

const TURNED_IN: &str = "The AV was stopped facing north at a red light at the intersection of Elm Street and Oak Street. A pickup truck \
                         traveling eastbound on Oak Street made a right turn onto southbound Elm Street, and the left side of the \
                         pickup truck made contact with the rear left of the stationary AV.";

const TURNED_OFF: &str = "The AV was traveling north behind a sedan when the sedan turned left and came to a stop. The sedan then reversed \
                          and the rear of the sedan made contact with the left side of the AV.";

const SWUNG_BACK: &str = "The AV was stopped behind a sedan. The sedan reversed, swerved to its left, and the rear right corner of the sedan \
                          made contact with the front left corner of the stationary AV.";

const CAT: &str = "The AV was traveling east when a cat emerged from between parked cars on the right side of the road and ran in front of \
                   the AV, and the front of the AV made contact with the cat.";

const DRIFTED: &str = "The AV was traveling in the right lane. A sedan behind it drifted to the right, and the front right of the sedan made \
                       contact with the rear left of the AV.";

const BALL: &str = "The AV was traveling east when a ball rolled into the roadway from the right and made contact with the front right of \
                    the AV.";

const GATE: &str = "The AV was traveling north when it stopped for a closed gate and began proceeding slowly forward. The gate began \
                    swinging open into the roadway and made contact with the front of the AV.";

/// The stories of this file, as they are shown.
pub fn shown() -> Vec<(String, Account, Reconstruction)> {
    let texts = [
        ("moved up", MOVED_UP),
        ("reversed first", REVERSED_FIRST),
        ("from the kerb", FROM_THE_KERB),
        ("crossed over", CROSSED_OVER),
        ("turned in", TURNED_IN),
        ("turned off", TURNED_OFF),
        ("swung back", SWUNG_BACK),
        ("cat", CAT),
        ("drifted", DRIFTED),
        ("ball", BALL),
        ("gate", GATE),
    ];
    let told = texts.map(|(name, text)| (name.to_owned(), story(text)));
    told.into_iter().map(|(name, account)| (name, account.clone(), made(&account))).collect()
}

pub fn story(text: &str) -> Account {
    account_of(text).expect("a story")
}

/// A staging that shows all that is told, whatever was told otherwise on the way to it.
pub fn made(account: &Account) -> Reconstruction {
    let made = reconstruct(account).expect("it can be staged");
    assert!(made.is_true(), "{:?}", made.verdict);
    let scenario = recrash_roads::check(made.draft.clone()).expect("it ran").value;
    let again = held_against(account, &scenario, &made.rollout).expect("it can be held");
    assert_eq!(again.failures().count(), 0, "{again:?}");
    assert_nobody_starts_in_touch(&made);
    made
}

/// A contact that there is from the beginning is in no list of events.
fn assert_nobody_starts_in_touch(made: &Reconstruction) {
    let users: Vec<_> = made.rollout.actors.iter().filter(|track| track.role != Role::Part).collect();
    for (at, one) in users.iter().enumerate().filter(|(_, track)| track.is_present(0)) {
        for other in users[..at].iter().filter(|track| track.is_present(0)) {
            let depth_m = one.outline(0).depth(&other.outline(0));
            assert!(depth_m < 1e-6, "{} begins {depth_m} m in {}", one.id, other.id);
        }
    }
}

/// What of an account is not shown by the staging of the same account without some of its facts.
pub fn missed(account: &Account, without: impl Fn(&mut Account)) -> Vec<CheckKind> {
    let checks = checks_without(account, without).into_iter();
    checks.filter(|check| check.result == CheckResult::NotShown).map(|check| check.kind).collect()
}

/// The facts of an account, held against the staging of the same account without some of them.
pub fn checks_without(account: &Account, without: impl Fn(&mut Account)) -> Vec<Check> {
    let mut less = account.clone();
    without(&mut less);
    assert!(less != *account, "nothing was taken away");
    let other = made(&less);
    let scenario = recrash_roads::check(other.draft).expect("it ran").value;
    held_against(account, &scenario, &other.rollout).expect("it can be staged").checks
}

pub fn without_acts(account: &mut Account, acts: &[Act]) {
    account.sv.acts.retain(|fact| !acts.contains(&fact.act));
}

/// The last step before the ego is touched.
pub fn before_contact(made: &Reconstruction) -> usize {
    let touches = |event: &Event| {
        matches!(event.kind, EventKind::Contact { a: 0, .. } | EventKind::ObstacleContact { actor: 0, .. })
    };
    let first = made.rollout.events.iter().find(|event| touches(event)).expect("a contact");
    (first.time_s * 10.0).ceil() as usize - 1
}

/// The ego's speeds until it is touched.
pub fn speeds(made: &Reconstruction) -> Vec<f64> {
    made.rollout.ego_track().states[..=before_contact(made)].iter().map(|state| state.speed()).collect()
}

#[test]
fn an_ego_that_moved_up_stands_moves_and_stands_again() {
    let account = story(MOVED_UP);
    let shown = made(&account);
    let speeds = speeds(&shown);
    let stood = speeds.iter().position(|speed| *speed == 0.0).expect("it stands");
    let moved = stood + speeds[stood..].iter().position(|speed| *speed > 1.0).expect("it moves up");
    assert!(speeds[moved..].contains(&0.0), "{speeds:?}");
    // The system under test takes over where it stands before that.
    let handover_s = shown.draft.ego.handover_s.expect("a handover");
    assert_eq!(speeds[(handover_s * 10.0) as usize], 0.0, "{handover_s}: {speeds:?}");
    assert_eq!(missed(&account, |less| without_acts(less, &[Act::SetOff, Act::Stop])), [CheckKind::SvState]);
}

#[test]
fn who_stood_behind_an_ego_that_moved_up_moves_up_too() {
    let account = story(
        "The AV was stopped at a red light. The AV proceeded forward a short distance and came to a stop. A truck that was \
         stopped behind the AV proceeded forward, and the front of the truck made contact with the rear of the stationary AV.",
    );
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert_eq!((states[0].speed(), shown.rollout.ego_track().states[0].speed()), (0.0, 0.0));
    assert!(met.x - states[0].x > 4.0 && met.speed() > 0.5, "{met:?}");
}

#[test]
fn who_is_told_behind_an_ego_that_moved_up_was_there_unless_it_came() {
    let begins = |told: &str| {
        let text = format!(
            "The AV was stopped at a red light. The AV proceeded forward a short distance and came to a stop. {told}"
        );
        let shown = made(&story(&text));
        let behind_m = shown.rollout.ego_track().states[0].x - partner(&shown).0[0].x;
        (behind_m, partner(&shown).0[0].speed())
    };
    let there = begins(
        "The van behind the AV proceeded forward as well, but did not stop when the AV came to a stop, and its front made contact with the rear of the AV.",
    );
    assert!(there.0 < 12.0 && there.1 == 0.0, "{there:?}");
    let came =
        begins("A van approached the AV from behind, and the front of the van made contact with the rear of the AV.");
    assert!(came.0 > 20.0 && came.1 > 1.0, "{came:?}");
}

#[test]
fn an_ego_that_reversed_before_it_stood_reverses() {
    let account = story(REVERSED_FIRST);
    let shown = made(&account);
    assert!(speeds(&shown).iter().any(|speed| *speed < -1.0));
    // So is that it did before the truck.
    let missed = missed(&account, |less| without_acts(less, &[Act::Reverse]));
    assert_eq!(missed, [CheckKind::SvState, CheckKind::CpState]);
}

pub fn partner_without_acts(account: &mut Account, acts: &[Act]) {
    account.partner.as_mut().expect("a partner").acts.retain(|fact| !acts.contains(&fact.act));
}

fn partner_moves(account: &mut Account, movement: Movement) {
    account.partner.as_mut().expect("a partner").movement = Some(Fact::by_rule(movement, "made for this test"));
}

/// The partner's states, and the one at the contact.
pub fn partner(made: &Reconstruction) -> (&[ActorState], ActorState) {
    let track = made.rollout.actors.iter().find(|track| track.id == "cp").expect("a partner");
    let last = before_contact(made);
    (&track.states[..=last], track.states[last])
}

pub fn degrees_between(one: f64, other: f64) -> f64 {
    math::wrap_angle(one - other).to_degrees().abs()
}

#[test]
fn who_pulls_out_and_passes_comes_from_the_kerb_behind() {
    let account = story(FROM_THE_KERB);
    let shown = made(&account);
    let ((states, _), ego) = (partner(&shown), shown.rollout.ego_track().states[before_contact(&shown)]);
    assert_eq!(states[0].speed(), 0.0);
    assert!(states[0].x < ego.x - 8.0 && states[0].y < -2.0, "{:?}", states[0]);
    let beside = missed(&account, |less| {
        partner_without_acts(less, &[Act::PullOut]);
        partner_moves(less, Movement::Straight);
    });
    assert!(beside.contains(&CheckKind::Approach), "{beside:?}");
}

#[test]
fn who_crosses_over_comes_from_its_own_side_wherever_it_hits_the_ego() {
    let account = story(CROSSED_OVER);
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(states[..50].iter().all(|state| state.y > 3.0), "it keeps its lane until then");
    assert!(met.y < 0.0, "{met:?}");
    // And who drove along the ego's lane all the way did not.
    let mut rollout = shown.rollout.clone();
    let track = rollout.actors.iter_mut().find(|track| track.id == "cp").expect("a partner");
    for state in &mut track.states[..before_contact(&shown)] {
        (state.y, state.heading) = (met.y, std::f64::consts::PI);
    }
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let verdict = held_against(&account, &scenario, &rollout).expect("it can be held");
    let straight: Vec<CheckKind> = verdict.failures().map(|check| check.kind).collect();
    assert!(straight.contains(&CheckKind::Approach) && straight.contains(&CheckKind::CpMovement), "{straight:?}");
}

#[test]
fn who_turns_into_the_egos_road_does_so_in_the_junction() {
    let account = story(TURNED_IN);
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(degrees_between(met.heading, math::PI) < 20.0, "{met:?}");
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    assert!(states.iter().all(|state| scenario.network().on_road(state.position())));
    let straight = missed(&account, |less| {
        partner_without_acts(less, &[Act::Turn]);
        partner_moves(less, Movement::Straight);
    });
    assert!(straight.contains(&CheckKind::CpMovement), "{straight:?}");
}

#[test]
fn a_told_turn_of_who_is_said_to_go_straight_on_from_a_crossing_road_is_drawn() {
    let mut account = story(TURNED_IN);
    partner_moves(&mut account, Movement::Straight);
    assert!(degrees_between(partner(&made(&account)).1.heading, math::PI) < 20.0);
    let straight = missed(&account, |less| partner_without_acts(less, &[Act::Turn]));
    assert!(straight.contains(&CheckKind::CpMovement), "{straight:?}");
}

#[test]
fn who_turned_off_before_it_reversed_stands_across_the_road() {
    let account = story(TURNED_OFF);
    let shown = made(&account);
    let backs = partner(&shown).0.iter().find(|state| state.speed() < -0.1).expect("it reverses");
    assert!((30.0..150.0).contains(&degrees_between(backs.heading, 0.0)));
    let parallel = missed(&account, |less| partner_without_acts(less, &[Act::Turn]));
    assert!(parallel.contains(&CheckKind::CpMovement), "{parallel:?}");
}

#[test]
fn who_swings_aside_while_it_reverses_comes_to_stand_at_an_angle() {
    let account = story(SWUNG_BACK);
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(degrees_between(states[0].heading, 0.0) < 1.0 && degrees_between(met.heading, 0.0) > 15.0);
    let parallel = missed(&account, |less| partner_without_acts(less, &[Act::Swerve]));
    assert!(parallel.contains(&CheckKind::CpMovement), "{parallel:?}");
}

#[test]
fn an_animal_runs_across_wherever_it_is_said_to_come_from() {
    for origin in
        [Origin::Parked { side: Some(LeftRight::Right) }, Origin::Beside { side: LeftRight::Right }, Origin::Ahead]
    {
        let mut account = story(CAT);
        account.came_from = Some(Fact::by_rule(origin, "made for this test"));
        account.order = None;
        let shown = made(&account);
        assert!(degrees_between(partner(&shown).0[0].heading, math::FRAC_PI_2) < 35.0, "{origin:?}");
        if !matches!(origin, Origin::Parked { .. }) {
            let along = missed(&account, |less| partner_without_acts(less, &[Act::Enter, Act::PullOut, Act::Cross]));
            assert!(along.contains(&CheckKind::Approach), "{origin:?}: {along:?}");
        }
    }
}

#[test]
fn who_is_told_to_have_drifted_while_it_drove_on_does() {
    let mut account = story(DRIFTED);
    account.came_from = Some(Fact::by_rule(Origin::Behind, "made for this test"));
    partner_moves(&mut account, Movement::Straight);
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(states[0].y - met.y > 1.0);
    let straight = missed(&account, |less| {
        partner_without_acts(less, &[Act::Drift]);
        // Else it comes to the told corner out of its lane.
        (less.sv.zones, less.partner.as_mut().expect("a partner").zones) = (Vec::new(), Vec::new());
    });
    assert!(straight.contains(&CheckKind::CpMovement), "{straight:?}");
}

#[test]
fn a_thing_that_rolled_into_the_way_rolls() {
    let account = story(BALL);
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(met.y - states[0].y > 3.0, "{:?} to {met:?}", states[0]);
    let lies = missed(&account, |less| {
        partner_without_acts(less, &[Act::Roll]);
        less.partner.as_mut().expect("a partner").state = None;
        // Its words tell it too.
        less.came_from = Some(Fact::by_rule(Origin::Beside { side: LeftRight::Right }, "made for this test"));
    });
    assert!(lies.contains(&CheckKind::CpState), "{lies:?}");
}

#[test]
fn a_gate_that_swung_swings_into_the_ego() {
    let account = story(GATE);
    let shown = made(&account);
    let last = before_contact(&shown);
    let arm = shown.rollout.actors.iter().find(|track| track.part_of.is_some()).expect("an arm");
    assert!(degrees_between(arm.states[last - 9].heading, arm.states[last].heading) > 20.0);
    let shut = missed(&account, |less| {
        partner_without_acts(less, &[Act::OpenDoor]);
        // Who struck tells it too.
        less.striker = None;
    });
    assert!(shut.contains(&CheckKind::CpState), "{shut:?}");
}

#[test]
fn who_reverses_out_of_a_crossing_road_moves_from_there() {
    let mut account = story(
        "The AV was traveling north. A van reversed out of a driveway on the left, and the rear of the van made contact with the \
         left side of the AV.",
    );
    account.came_from = Some(Fact::by_rule(Origin::Cross { side: LeftRight::Left }, "made for this test"));
    account.order = None;
    let shown = made(&account);
    let (states, met) = partner(&shown);
    assert!(states[0].y > met.y + 1.0 && met.speed() < 0.0, "{:?} to {met:?}", states[0]);
}

#[test]
fn who_runs_into_one_parked_at_the_kerb_comes_along_the_lane() {
    let account = story(
        "The AV was parked at the curb on Elm Street. A sedan approached from behind and the front right of the sedan made contact with the \
         rear left of the AV.",
    );
    let shown = made(&account);
    let (ego, states) = (shown.rollout.ego_track().states[0], partner(&shown).0);
    // In the lane, the ego beside it.
    assert!((states[0].y - ego.y - 2.9).abs() < 0.1, "{:?}", states[0]);
    assert!(states[states.len() - 1].y < states[0].y - 0.5);
}
