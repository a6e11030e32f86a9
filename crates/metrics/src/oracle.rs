//! The geometry of this crate against shapely: `oracle/boxes.py` made the numbers.

use crate::polygon::ConvexPolygon;
use crate::swept::time_to_collision;
use recrash_model::geometry::{OrientedBox, Pose, Vec2};

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
