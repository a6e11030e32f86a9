//! This crate against independent programs: `oracle/boxes.py` (shapely) and `oracle/crime.py` (CommonRoad-CriMe) made
//! the numbers. Where definitions differ and why: `docs/models/metric-oracles.md`.

use crate::encroachment::post_encroachment_time;
use crate::following::Following;
use crate::swept::time_to_collision;
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::math;
use recrash_model::polygon::ConvexPolygon;

/// Size of the vehicles in `crime.py`. [m]
const LENGTH_M: f64 = 4.515;
const WIDTH_M: f64 = 1.852;

/// Rows of numbers below a header; `inf` is infinite.
fn numbers<const COLUMNS: usize>(csv: &str) -> Vec<[f64; COLUMNS]> {
    let rows = csv.lines().skip(1).map(|row| {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
        cells.try_into().expect("one number per column")
    });
    rows.collect()
}

/// One sample of `crime_following.csv`.
struct FollowingSample {
    ours: Following,
    ego_acceleration: f64,
    ego_keeps_its_speed: bool,
    ttc: Option<f64>,
    crime_hw: f64,
    crime_ttc: f64,
    crime_thw: f64,
    crime_a_long_req: f64,
}

fn following_samples() -> Vec<FollowingSample> {
    let rows = numbers::<12>(include_str!("../oracle/crime_following.csv"));
    let samples =
        rows.iter().map(|&[drive, _, ego_x, ego_v, other_x, other_v, ego_a, other_a, hw, ttc, thw, a_req]| {
            let boxed =
                |x: f64| OrientedBox::new(Pose { position: Vec2::new(x, 0.0), heading: 0.0 }, LENGTH_M, WIDTH_M);
            let (ego, other) = (boxed(ego_x), boxed(other_x));
            FollowingSample {
                ours: Following {
                    gap_m: ego.gap(&other),
                    speed_mps: ego_v,
                    leader_speed_mps: other_v,
                    leader_acceleration_mps2: other_a,
                },
                ego_acceleration: ego_a,
                ego_keeps_its_speed: rows.iter().filter(|row| row[0] == drive).all(|row| row[3] == ego_v),
                ttc: time_to_collision(&ego, Vec2::new(ego_v, 0.0), &other, Vec2::new(other_v, 0.0)),
                crime_hw: hw,
                crime_ttc: ttc,
                crime_thw: thw,
                crime_a_long_req: a_req,
            }
        });
    samples.collect()
}

#[test]
fn the_gap_ahead_is_crimes_headway_distance() {
    let samples = following_samples();
    assert_eq!(samples.len(), 1200);
    for sample in samples {
        assert!((sample.ours.gap_m - sample.crime_hw).abs() < 1e-6, "{} {}", sample.ours.gap_m, sample.crime_hw);
    }
}

#[test]
fn time_to_collision_is_crimes_where_nobody_accelerates() {
    let mut compared = 0;
    for sample in following_samples() {
        // CriMe takes accelerations into account from a difference of 0.1 m/s^2 on.
        if sample.ego_acceleration.abs() > 1e-6 || sample.ours.leader_acceleration_mps2.abs() > 1e-6 {
            continue;
        }
        match sample.ttc {
            // The file's speeds are rounded to 1e-9 m/s, which long times feel.
            Some(ttc) => {
                let tolerance = (1e-7 * ttc).max(1e-6);
                assert!((ttc - sample.crime_ttc).abs() < tolerance, "{ttc} {}", sample.crime_ttc);
            }
            // CriMe divides by accelerations of 1e-15: millions of years are never.
            None => assert!(sample.crime_ttc > 1e9, "{}", sample.crime_ttc),
        }
        compared += 1;
    }
    assert!(compared > 700, "{compared}");
}

#[test]
fn headway_is_crimes_within_its_step_where_the_ego_keeps_its_speed() {
    let mut compared = 0;
    for sample in following_samples() {
        // CriMe waits for the ego's front to pass the spot, in steps of 0.1 s, and no longer than the drive lasts.
        let Some(ours) = sample.ours.headway_s().filter(|_| sample.ego_keeps_its_speed) else { continue };
        if sample.crime_thw.is_finite() {
            assert!((-1e-6..=0.1 + 1e-6).contains(&(sample.crime_thw - ours)), "{ours} {}", sample.crime_thw);
            compared += 1;
        }
    }
    assert!(compared > 150, "{compared}");
}

#[test]
fn required_deceleration_is_crimes_behind_a_leader_that_does_not_brake() {
    let (mut compared, mut with_drac) = (0, 0);
    for sample in following_samples() {
        // CriMe drops the sign of the leader's acceleration, and asks for braking behind a faster leader as well.
        let Some(drac) = sample.ours.drac_mps2().filter(|_| sample.ours.leader_acceleration_mps2 >= -1e-9) else {
            continue;
        };
        let required = sample.ours.required_deceleration_mps2();
        assert!((required + sample.crime_a_long_req).abs() < 1e-6, "{required} {}", sample.crime_a_long_req);
        compared += 1;
        if sample.ours.leader_acceleration_mps2 < 1e-9 {
            assert!((drac - required).abs() < 1e-6);
            with_drac += 1;
        }
    }
    assert!(compared > 300 && with_drac > 250, "{compared} {with_drac}");
}

#[test]
fn post_encroachment_time_is_crimes_within_its_steps_and_no_less_on_oblique_crossings() {
    let (mut square, mut oblique) = (0, 0);
    for [heading, ego_v, ego_at, other_v, other_at, steps, crime] in
        numbers::<7>(include_str!("../oracle/crime_crossing.csv"))
    {
        let step_s = 0.02;
        let track = |heading: f64, speed: f64, at: f64| -> Vec<OrientedBox> {
            let states = (0..steps as usize).map(|step| {
                let position = Vec2::from_heading(heading) * (speed * (step as f64 * step_s - at));
                OrientedBox::new(Pose { position, heading }, LENGTH_M, WIDTH_M)
            });
            states.collect()
        };
        let (ego, other) = (track(0.0, ego_v, ego_at), track(heading, other_v, other_at));
        let pet = post_encroachment_time((&ego, 0..ego.len()), (&other, 0..other.len()), step_s);
        let ours = pet.expect("their paths cross").value;
        if (heading.abs() - math::FRAC_PI_2).abs() < 1e-6 {
            // CriMe enters and leaves on whole steps, up to one outwards each.
            let agrees =
                if crime.is_finite() { (0.0..=2.0 * step_s + 1e-6).contains(&(ours - crime)) } else { ours < 0.05 };
            assert!(agrees, "{heading} {ours} {crime}");
            square += 1;
        } else if crime.is_finite() {
            // CriMe's area is left as a whole and entered as a whole; no spot of it sees less.
            assert!(ours >= crime - 1e-6, "{heading} {ours} {crime}");
            oblique += 1;
        }
    }
    assert!(square >= 25 && oblique >= 15, "{square} {oblique}");
}

struct Pair {
    boxes: [OrientedBox; 2],
    velocities: [Vec2; 2],
    gap: f64,
    shared_area: f64,
    shared_centre: Option<Vec2>,
    ttc: Option<f64>,
}

fn pairs() -> Vec<Pair> {
    let rows = include_str!("../oracle/boxes.csv").lines().skip(1);
    rows.map(|row| {
        let cells: Vec<Option<f64>> = row.split(',').map(|cell| cell.parse().ok()).collect();
        let number = |column: usize| cells[column].expect("a number");
        let boxed = |from: usize| {
            let pose = Pose { position: Vec2::new(number(from + 2), number(from + 3)), heading: number(from + 4) };
            OrientedBox::new(pose, number(from), number(from + 1))
        };
        let boxes = [boxed(0), boxed(6)];
        Pair {
            velocities: [boxes[0].axis * number(5), boxes[1].axis * number(11)],
            boxes,
            gap: number(12),
            shared_area: number(13),
            shared_centre: cells[14].zip(cells[15]).map(|(x, y)| Vec2::new(x, y)),
            ttc: cells[16],
        }
    })
    .collect()
}

#[test]
fn gaps_agree_with_shapely() {
    for (number, pair) in pairs().iter().enumerate() {
        let gap = pair.boxes[0].gap(&pair.boxes[1]);
        assert!((gap - pair.gap).abs() < 1e-9, "pair {number}: {gap}, shapely {}", pair.gap);
    }
}

#[test]
fn shared_areas_agree_with_shapely() {
    let mut overlapping = 0;
    for (number, pair) in pairs().iter().enumerate() {
        let shared = ConvexPolygon::overlap(&pair.boxes[0], &pair.boxes[1]);
        assert!((shared.area() - pair.shared_area).abs() < 1e-9, "pair {number}: {}", shared.area());
        if let Some(expected) = pair.shared_centre.filter(|_| pair.shared_area > 1e-6) {
            let centre = shared.centroid().expect("they overlap");
            assert!(centre.distance(expected) < 1e-7, "pair {number}: {centre:?}, shapely {expected:?}");
            overlapping += 1;
        }
    }
    assert!(overlapping > 20, "only {overlapping} pairs overlap");
}

#[test]
fn times_to_collision_agree_with_stepping_by_shapely() {
    let mut on_course = 0;
    for (number, pair) in pairs().iter().enumerate() {
        let [a, b] = &pair.boxes;
        // The oracle looks 10 s ahead.
        let ttc = time_to_collision(a, pair.velocities[0], b, pair.velocities[1]).filter(|&ttc| ttc <= 10.0);
        match (ttc, pair.ttc) {
            (None, None) => {}
            (Some(ttc), Some(expected)) => {
                assert!((ttc - expected).abs() < 1e-6, "pair {number}: {ttc}, stepped {expected}");
                on_course += usize::from(ttc > 0.0);
            }
            (ttc, expected) => panic!("pair {number}: {ttc:?}, stepped {expected:?}"),
        }
    }
    assert!(on_course > 100, "only {on_course} pairs are on a collision course");
}
