//! What drivers are shown.

use crate::common::{Memory, batch, gallery, scenario, settings};
use recrash_gym::{Actions, Autoreset, FIELDS_ALWAYS, FIELDS_OF_OTHER, Raster, Rays, Settings, View, ViewError};
use recrash_sim::{Run, Seat};

fn shown(name: &str, view: View) -> Memory {
    let mut batch = batch(&[scenario(name)], 1, Settings { view, ..settings(Autoreset::NextStep) });
    let mut memory = Memory::of(&batch);
    batch.reset(Some(1), None, None, memory.lend()).unwrap();
    memory
}

/// The value of a field, in its unit.
fn always(memory: &Memory, name: &str) -> f64 {
    let at = FIELDS_ALWAYS.iter().position(|field| field.name == name).unwrap();
    f64::from(memory.numbers[at]) * FIELDS_ALWAYS[at].scale
}

/// The value of a field of the nth other.
fn of_other(memory: &Memory, other: usize, name: &str) -> f64 {
    let at = FIELDS_OF_OTHER.iter().position(|field| field.name == name).unwrap();
    let number = memory.numbers[FIELDS_ALWAYS.len() + other * FIELDS_OF_OTHER.len() + at];
    f64::from(number) * FIELDS_OF_OTHER[at].scale
}

#[test]
fn the_nearest_come_first_in_the_frame_of_the_ego() {
    let name = "crashes/29-left-turn-across";
    let memory = shown(name, View::Kinematic { neighbours: 2 });
    // Two seconds in; the oncoming car is the only other.
    let scenario = scenario(name);
    let mut run = Run::new(&scenario, Seat::Outside);
    for _ in 0..20 {
        run.step(None);
    }
    let observation = run.observe();
    let (ego, other) = (observation.states[0], observation.states[1]);
    assert!((always(&memory, "speed") - ego.speed()).abs() < 1e-5);
    assert_eq!(of_other(&memory, 0, "there"), 1.0);
    let apart = other.position() - ego.position();
    let forward = recrash_model::geometry::Vec2::from_heading(ego.heading);
    assert!((of_other(&memory, 0, "x") - apart.dot(forward)).abs() < 1e-4);
    assert!((of_other(&memory, 0, "y") - forward.cross(apart)).abs() < 1e-4);
    let relative = other.velocity() - ego.velocity();
    assert!((of_other(&memory, 0, "relative_vx") - relative.dot(forward)).abs() < 1e-4);
    assert!(of_other(&memory, 0, "heading_cos") < -0.9);
    assert_eq!(of_other(&memory, 1, "there"), 0.0);
    // Both signals are green, and the ego drives along its route.
    assert_eq!(
        (always(&memory, "line_there"), always(&memory, "line_green"), always(&memory, "line_red")),
        (1.0, 1.0, 0.0)
    );
    assert!(always(&memory, "route_cos") > 0.999 && always(&memory, "route_right").abs() < 0.3);
    assert!((always(&memory, "route_20_x") - 20.0).abs() < 0.1 && always(&memory, "route_20_y").abs() < 0.5);
    assert!((always(&memory, "time_left") - 7.0).abs() < 1e-4);
}

#[test]
fn the_first_observation_has_the_signal_and_no_sign() {
    // Red for 6 s, of which the recorded driver sees nothing: it drives for none.
    let mut draft = scenario("control/04-red-then-green").draft().clone();
    draft.ego.handover_s = Some(0.0);
    let scenario = recrash_roads::check(draft).unwrap().value;
    let view = View::Kinematic { neighbours: 1 };
    let mut batch = batch(&[scenario], 1, Settings { view, ..settings(Autoreset::NextStep) });
    let mut memory = Memory::of(&batch);
    batch.reset(Some(1), None, None, memory.lend()).unwrap();
    let seen = |memory: &Memory| ["line_sign", "line_red", "line_green"].map(|name| always(memory, name));
    assert_eq!(seen(&memory), [0.0, 1.0, 0.0]);
    for step in 1..=60 {
        batch.step(Actions::Numbers(&[-6.0, 0.0]), memory.lend()).unwrap();
        assert_eq!(seen(&memory), if step < 60 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] }, "{step}");
    }
}

#[test]
fn more_neighbours_change_nothing_of_the_first() {
    for scenario in gallery() {
        let numbers = |neighbours: usize| {
            let view = View::Kinematic { neighbours };
            let mut batch =
                batch(std::slice::from_ref(&scenario), 1, Settings { view, ..settings(Autoreset::NextStep) });
            let mut memory = Memory::of(&batch);
            batch.reset(Some(1), None, None, memory.lend()).unwrap();
            batch.step(Actions::Numbers(&[0.0, 0.0]), memory.lend()).unwrap();
            memory.numbers
        };
        let (few, many) = (numbers(1), numbers(8));
        assert_eq!(few[..], many[..few.len()], "{}", scenario.draft().id);
        assert!(many.iter().all(|number| (-1.0..=1.0).contains(number)));
        // Boxes that overlap the ego's are nearer than what is one car's length off.
        let rows: Vec<f32> = many[FIELDS_ALWAYS.len()..].chunks(9).map(|row| row[0]).collect();
        assert!(rows.windows(2).all(|pair| pair[0] >= pair[1]), "there, then not: {rows:?}");
    }
}

#[test]
fn a_ray_forward_ends_at_the_car_ahead() {
    let memory = shown("crashes/32-lead-reverses", View::Rays(Rays::new(8, 50.0)));
    let kinematic = shown("crashes/32-lead-reverses", View::Kinematic { neighbours: 1 });
    let forward_m = f64::from(memory.numbers[FIELDS_ALWAYS.len()]) * 50.0;
    let rear_m = of_other(&kinematic, 0, "x") - 0.5 * of_other(&kinematic, 0, "length");
    assert!((0.0..50.0).contains(&rear_m) && (forward_m - rear_m).abs() < 0.05, "{forward_m} {rear_m}");
    // Nobody is behind.
    assert_eq!(memory.numbers[FIELDS_ALWAYS.len() + 4], 1.0);
}

#[test]
fn a_picture_has_the_road_under_the_ego_and_somebody_where_somebody_is() {
    let memory = shown("crashes/32-lead-reverses", View::Raster(Raster { pixels: 64, pixel_m: 1.0 }));
    let kinematic = shown("crashes/32-lead-reverses", View::Kinematic { neighbours: 1 });
    let (ground, users) = memory.bytes.split_at(64 * 64);
    assert_eq!(ground[47 * 64 + 31], 255);
    assert!(ground.contains(&0) && ground.contains(&255));
    let (row, column) = (48.0 - of_other(&kinematic, 0, "x"), 32.0 - of_other(&kinematic, 0, "y"));
    assert!((0.0..64.0).contains(&row) && (0.0..64.0).contains(&column));
    assert_eq!(users[row as usize * 64 + column as usize], 255);
    let painted = users.iter().filter(|shade| **shade > 0).count();
    // A car of some 4.5 m by 1.9 m.
    assert!((4..=16).contains(&painted), "{painted}");
}

#[test]
fn views_that_cannot_be_are_told() {
    let wrong = [
        View::Kinematic { neighbours: 0 },
        View::Kinematic { neighbours: 33 },
        View::Rays(Rays::new(0, 50.0)),
        View::Rays(Rays::new(8, f64::NAN)),
        View::Raster(Raster { pixels: 4, pixel_m: 1.0 }),
        View::Raster(Raster { pixels: 64, pixel_m: 0.0 }),
    ];
    for view in wrong {
        assert!(view.check().is_err(), "{view:?}");
    }
    let text = ViewError::Neighbours(40).to_string();
    assert_eq!(text, "40 neighbours: a view has 1 to 32");
}
