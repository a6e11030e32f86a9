//! What the system under test is given: its task, the speed that it wants, and the surroundings; and what lies under it.

use crate::stories;
use crate::ways::{before_contact, made, story};
use recrash_model::account::{Account, Fact};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::scenario::ScenarioDraft;
use recrash_model::surroundings::{Lighting, Surface, Weather};
use recrash_reconstruct::held_against;
use recrash_sim::{Ego, simulate};

const BOARDS: &str = "The AV was parked at the curb on Elm Street for a passenger drop-off with its hazard lights activated. A van approached \
                      from behind and the front right of the van made contact with the rear left of the stationary AV.";

const PULLED_UP: &str = "The AV had pulled up to the curb on Elm Street for a passenger pickup. While the AV was stopped, a sedan reversed out of a driveway on the \
                         right and the rear of the sedan made contact with the right side of the stopped AV.";

const NARROW: &str = "The AV was traveling west on Elm Street when it came to a stop to yield to an oncoming van on a narrow road with parked \
                      vehicles on both sides of the street. As the van was passing the stopped AV, the front left of the van made contact with \
                      the front left of the AV.";

const STOP_SIGN: &str = "The AV was stopped, yielding for a stop sign at the intersection of Elm Street and Oak Street. A van approached from \
                         behind and the front of the van made contact with the rear of the stationary AV.";

const SCRAPES: &str = "The AV was traveling north on Elm Street. As the AV turned left into a parking lot, the underside of the AV made contact \
                       with the driveway pavement.";

const UNDER_A_POLE: &str = "The AV was traveling east when the underside of the AV made contact with a pole.";

const ROLLS: &str = "The AV was traveling east when the left side of the AV made contact with an object that was rolling into the AV's lane from \
                     the left side of the road.";

const SWINGS: &str = "The AV was traveling north through an open gate when the gate began to close and the gate made contact with the left \
                      side of the AV.";

fn result(draft: &ScenarioDraft, account: &Account, kind: CheckKind) -> Option<CheckResult> {
    let scenario = recrash_roads::check(draft.clone()).expect("it can run").value;
    let verdict = held_against(account, &scenario, &simulate(&scenario, Ego::Recorded)).expect("it can be staged");
    verdict.checks.iter().find(|check| check.kind == kind).map(|check| check.result)
}

#[test]
fn who_stands_for_passengers_stands_where_its_task_has_it_stop() {
    let account = story(BOARDS);
    let shown = made(&account).draft;
    assert_eq!(result(&shown, &account, CheckKind::Reason), Some(CheckResult::Shown));
    let mut elsewhere = shown.clone();
    elsewhere.ego.stops[0].s_m += 3.0;
    assert_eq!(result(&elsewhere, &account, CheckKind::Reason), Some(CheckResult::CannotBeShown));
    let mut in_the_lane = shown.clone();
    in_the_lane.ego.stops[0].t_m = 0.0;
    assert_eq!(
        result(&in_the_lane, &account, CheckKind::Reason),
        Some(CheckResult::CannotBeShown),
        "it is at the kerb"
    );
    let mut none = shown;
    none.ego.stops.clear();
    assert_eq!(result(&none, &account, CheckKind::Reason), Some(CheckResult::CannotBeShown));
}

#[test]
fn why_somebody_stood_and_what_is_assumed_is_said_in_words() {
    let said = |words: &str, kind: CheckKind| {
        let made = made(&story(words));
        let check = made.verdict.checks.iter().find(|check| check.kind == kind).map(|check| check.expected.clone());
        (check, made.assumed)
    };
    assert_eq!(said(BOARDS, CheckKind::Reason).0.as_deref(), Some("pick-up or drop-off"));
    assert_eq!(said(STOP_SIGN, CheckKind::Reason).0.as_deref(), Some("stop sign"));
    for words in [BOARDS, NARROW, STOP_SIGN, SWINGS] {
        let assumed = said(words, CheckKind::Reason).1;
        assert!(!assumed.iter().any(|text| text.contains(['{', '}']) || *text != text.to_lowercase()), "{assumed:?}");
    }
}

#[test]
fn who_pulled_up_for_passengers_stands_where_it_pulled_up_to() {
    let account = story(PULLED_UP);
    let shown = made(&account).draft;
    assert_eq!(result(&shown, &account, CheckKind::Reason), Some(CheckResult::Shown));
    let mut in_the_lane = shown;
    in_the_lane.ego.stops[0].t_m = 0.0;
    assert_eq!(result(&in_the_lane, &account, CheckKind::Reason), Some(CheckResult::CannotBeShown), "it pulled over");
}

#[test]
fn who_gives_way_to_its_partner_or_at_a_sign_waits_for_nobody_else() {
    let account = story(NARROW);
    assert_eq!(result(&made(&account).draft, &account, CheckKind::Reason), None);
    let account = story(STOP_SIGN);
    assert_eq!(result(&made(&account).draft, &account, CheckKind::Reason), Some(CheckResult::Shown));
}

#[test]
fn who_is_tested_wants_no_less_than_the_recorded_driver_drove() {
    for (name, _, made) in stories::shown() {
        let ego = &made.draft.ego;
        let recorded = ego.recorded.as_ref().expect("a recorded driver");
        assert!(ego.target_speed_mps >= recorded.speed_mps, "{name}: {} m/s", ego.target_speed_mps);
        // Along its lane: who drifts out of it is a little faster.
        let before = &made.rollout.ego_track().states[..=before_contact(&made)];
        let fastest = before.iter().map(|state| state.speed()).fold(0.0, f64::max);
        assert!(ego.target_speed_mps > 0.9 * fastest, "{name}: {} m/s, driven {fastest}", ego.target_speed_mps);
    }
}

#[test]
fn the_surroundings_are_those_that_are_told() {
    let mut account = story(BOARDS);
    account.place.surface = Some(Fact::of_column(Surface::Wet, "Roadway Surface"));
    account.place.lighting = Some(Fact::of_column(Lighting::DarkLighted, "Lighting"));
    account.place.weather = vec![Fact::of_column(Weather::Rain, "Weather"), Fact::of_column(Weather::Fog, "Weather")];
    let environment = made(&account).draft.environment;
    assert_eq!(
        (environment.surface, environment.lighting, environment.weather),
        (Surface::Wet, Lighting::DarkLighted, Weather::Rain)
    );
}

#[test]
fn what_touches_the_underside_comes_under_the_ego() {
    let account = story(SCRAPES);
    let shown = made(&account).draft;
    assert_eq!(result(&shown, &account, CheckKind::SvZones), Some(CheckResult::Shown));
    // One that stops as it touches has nothing under it.
    let mut stops = shown;
    stops.duration_s = 9.0;
    assert_eq!(result(&stops, &account, CheckKind::SvZones), Some(CheckResult::CannotBeShown));
    let account = story(UNDER_A_POLE);
    assert_eq!(result(&made(&account).draft, &account, CheckKind::SvZones), Some(CheckResult::CannotBeShown));
}

#[test]
fn what_rolls_into_the_way_is_light_and_what_stands_fast_is_not() {
    let mass_kg = |text: &str| {
        let draft = made(&story(text)).draft;
        draft.actors.iter().find(|actor| actor.id == "cp").map(|actor| actor.mass_kg)
    };
    assert_eq!(mass_kg(ROLLS), Some(Some(20.0)));
    assert_eq!(mass_kg(SWINGS), Some(None), "a gate's post stands fast");
}
