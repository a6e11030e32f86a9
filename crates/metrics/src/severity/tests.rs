use super::*;
use recrash_model::geometry::Pose;
use recrash_model::severity::{InjuryOutcome, RiskCurve};
use recrash_model::vehicle::VehicleSpec;

const SMOOTH: Impact = Impact { restitution: 0.0, friction: 0.0 };

/// A road user at a place, with a heading [degrees] and a speed along it. [m, m/s]
fn party(kind: PartnerKind, [x, y]: [f64; 2], degrees: f64, speed_mps: f64, [length, width]: [f64; 2]) -> Party {
    let outline =
        OrientedBox::new(Pose { position: Vec2::new(x, y), heading: degrees * math::PI / 180.0 }, length, width);
    Party { kind, mass_kg: VehicleSpec::mass_kg(kind), outline, velocity: outline.axis * speed_mps }
}

fn car(place: [f64; 2], degrees: f64, speed_mps: f64) -> Party {
    party(PartnerKind::PassengerCar, place, degrees, speed_mps, [4.5, 1.8])
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 0.01 * expected.abs().max(1e-9), "{found} is not {expected}");
}

#[test]
fn equal_masses_head_on_each_lose_their_speed() {
    let found = severity(&car([0.0, 0.0], 0.0, 10.0), &car([4.45, 0.0], 180.0, 10.0), Impact::default());
    close(found.first.delta_v_mps, 10.0);
    close(found.second.delta_v_mps, 10.0);
    close(found.closing_speed_mps, 20.0);
    close(found.normal_speed_mps, 20.0);
    close(found.overlap, 1.0);
    assert_eq!((found.first.force_clock, found.second.force_clock), (Some(12), Some(12)));
}

#[test]
fn restitution_gives_back_its_share() {
    let bouncing = Impact { restitution: 0.2, friction: 0.5 };
    let found = severity(&car([0.0, 0.0], 0.0, 15.0), &car([4.45, 0.0], 0.0, 5.0), bouncing);
    close(found.first.delta_v_mps, 6.0);
    close(found.second.delta_v_mps, 6.0);
    assert_eq!((found.first.force_clock, found.second.force_clock), (Some(12), Some(6)));
}

#[test]
fn a_truck_on_a_car_goes_on_with_it() {
    let truck = party(PartnerKind::HeavyTruck, [0.0, 0.0], 0.0, 20.0, [9.1, 2.4]);
    let found = severity(&truck, &car([6.75, 0.0], 0.0, 0.0), Impact::default());
    let (heavy, light) = (10_000.0, 1500.0);
    close(found.first.delta_v_mps, 20.0 * light / (heavy + light));
    close(found.second.delta_v_mps, 20.0 * heavy / (heavy + light));
    close(found.first.impact_speed_mps, 20.0);
}

#[test]
fn what_stands_firm_takes_all_speed() {
    let wall = party(PartnerKind::FixedObject, [3.2, 0.0], 0.0, 0.0, [2.0, 4.0]);
    let found = severity(&car([0.0, 0.0], 0.0, 12.0), &wall, Impact::default());
    close(found.first.delta_v_mps, 12.0);
    assert_eq!((found.second.delta_v_mps, found.second.mass_kg), (0.0, None));
}

#[test]
fn smooth_oblique_impact_stops_only_what_goes_across_the_plane() {
    // It moves 30 degrees off its heading: the part of 20 m/s across the plane is shared by equal masses, the rest stays.
    let (sin, cos) = (math::sin(math::PI / 6.0), math::cos(math::PI / 6.0));
    let first = Party { velocity: Vec2::new(20.0 * cos, 20.0 * sin), ..car([0.0, 0.0], 0.0, 0.0) };
    let found = severity(&first, &car([4.45, 0.0], 0.0, 0.0), SMOOTH);
    close(found.normal_speed_mps, 20.0 * cos);
    close(found.first.delta_v_mps, 10.0 * cos);
    close(found.second.delta_v_mps, 10.0 * cos);
    close(found.closing_speed_mps, 20.0);
}

#[test]
fn rough_sides_slide_with_friction_times_the_blow() {
    let first = Party { velocity: Vec2::new(10.0, 40.0), ..car([0.0, 0.0], 0.0, 0.0) };
    // The arm is along the blow, so that the blow turns nobody, and friction adds at a right angle.
    let found = severity(&first, &car([4.45, 0.0], 0.0, 0.0), Impact { restitution: 0.0, friction: 0.3 });
    close(found.first.delta_v_mps, 5.0 * (1.0 + math::sq(0.3_f64)).sqrt());
}

#[test]
fn a_blow_beside_the_middle_turns_the_struck_one_and_moves_it_less() {
    let middle = severity(&car([0.0, 0.0], 0.0, 10.0), &car([3.1, 0.0], 90.0, 0.0), SMOOTH);
    let end = severity(&car([0.0, 0.0], 0.0, 10.0), &car([3.1, 2.0], 90.0, 0.0), SMOOTH);
    close(middle.second.delta_v_mps, 5.0);
    assert!(end.second.delta_v_mps < 4.6, "{}", end.second.delta_v_mps);
    assert_eq!(middle.second.force_clock, Some(9));
}

#[test]
fn the_plane_of_contact_is_the_one_that_closed_last() {
    // 0.3 m deep along and 0.1 m across: a small overlap from behind, not a sideswipe.
    let behind = severity(&car([0.0, 0.0], 0.0, 15.0), &car([4.2, 1.7], 0.0, 0.0), SMOOTH);
    close(behind.normal_speed_mps, 15.0);
    close(behind.overlap, 0.1 / 1.8);
    // The same place, reached from the side.
    let drifting = Party { velocity: Vec2::new(0.0, 1.0), ..car([0.0, 0.0], 0.0, 0.0) };
    let beside = severity(&drifting, &car([4.2, 1.7], 0.0, 0.0), SMOOTH);
    close(beside.normal_speed_mps, 1.0);
    assert_eq!(beside.first.force_clock, Some(9));
}

#[test]
fn who_drives_apart_suffers_nothing() {
    let found = severity(&car([0.0, 0.0], 0.0, 5.0), &car([4.45, 0.0], 0.0, 9.0), Impact::default());
    assert_eq!((found.first.delta_v_mps, found.second.delta_v_mps), (0.0, 0.0));
    assert_eq!(found.first.force_clock, None);
    assert!(found.first.risks.is_empty() && found.second.risks.is_empty());
}

#[test]
fn the_clock_tells_where_the_force_comes_from() {
    let outline = car([0.0, 0.0], 30.0, 0.0).outline;
    let hours = [(0.0, 12), (-30.0, 1), (-90.0, 3), (-180.0, 6), (90.0, 9), (14.0, 12), (29.0, 11)];
    for (degrees, hour) in hours {
        let direction = Vec2::from_heading((30.0 + degrees) * math::PI / 180.0);
        assert_eq!(clock(&outline, direction), hour, "{degrees}");
    }
}

fn risk(found: &Suffered, outcome: InjuryOutcome, curve: RiskCurve) -> Option<f64> {
    found.risks.iter().find(|risk| risk.outcome == outcome && risk.curve == curve).map(|risk| risk.probability)
}

fn same_risk(found: Option<f64>, expected: f64) {
    assert!((found.expect("covered") - expected).abs() < 1e-5, "{found:?} is not {expected}");
}

/// A car of equal mass from ahead or from behind, so that the ego's delta-v is this. [mph]
fn by_delta_v(delta_v_mph: f64, from_behind: bool) -> Suffered {
    let speed_mps = 2.0 * delta_v_mph * 0.44704;
    let (ego, other) = if from_behind {
        (car([0.0, 0.0], 0.0, 0.0), car([-4.45, 0.0], 0.0, speed_mps))
    } else {
        (car([0.0, 0.0], 0.0, speed_mps), car([4.45, 0.0], 0.0, 0.0))
    };
    severity(&ego, &other, Impact::default()).first
}

#[test]
fn occupants_at_five_delta_v_from_the_front_and_from_behind() {
    use InjuryOutcome::{Fatal, Mais1, Mais2, Mais3};
    // Computed in Python from the coefficients of wang2022: delta-v [mph], outcome, front, rear.
    let points = [
        (10.0, Mais1, 0.345_47, 0.240_69),
        (20.0, Mais2, 0.109_79, 0.038_50),
        (30.0, Mais3, 0.107_42, 0.065_75),
        (40.0, Fatal, 0.059_63, 0.039_99),
        (50.0, Mais3, 0.754_47, 0.717_50),
    ];
    for (delta_v_mph, outcome, front, rear) in points {
        let found = |from_behind| risk(&by_delta_v(delta_v_mph, from_behind), outcome, RiskCurve::Wang2022);
        same_risk(found(false), front);
        same_risk(found(true), rear);
    }
}

#[test]
fn occupants_hit_from_the_side_or_beyond_the_region_are_not_told() {
    let side = severity(&car([0.0, 0.0], 90.0, 0.0), &car([-3.1, 0.0], 0.0, 15.0), Impact::default());
    assert_eq!(side.first.force_clock, Some(9));
    assert_eq!(risk(&side.first, InjuryOutcome::Mais3, RiskCurve::Wang2022), None);
    for delta_v_mph in [3.0, 60.0] {
        assert_eq!(risk(&by_delta_v(delta_v_mph, false), InjuryOutcome::Mais3, RiskCurve::Wang2022), None);
    }
}

/// A car strikes somebody who stands, with its front.
fn struck(kind: PartnerKind, speed_mps: f64) -> Suffered {
    severity(&car([0.0, 0.0], 0.0, speed_mps), &party(kind, [2.4, 0.0], 90.0, 0.0, [0.5, 0.5]), Impact::default())
        .second
}

#[test]
fn pedestrians_at_the_ten_published_points() {
    let risks = [0.10, 0.25, 0.50, 0.75, 0.90];
    let severe = [17.1, 24.9, 33.0, 40.8, 48.1];
    let death = [24.1, 32.5, 40.6, 48.0, 54.6];
    for (outcome, speeds) in [(InjuryOutcome::Mais4, severe), (InjuryOutcome::Fatal, death)] {
        for (probability, speed_mph) in risks.into_iter().zip(speeds) {
            // A hair inside, since the last point ends the region.
            let suffered = struck(PartnerKind::Pedestrian, (speed_mph + (0.5 - probability) * 1e-9) * 0.44704);
            close(risk(&suffered, outcome, RiskCurve::Tefft2013).expect("covered"), probability);
        }
    }
    let slow = struck(PartnerKind::Pedestrian, 5.0);
    assert_eq!(risk(&slow, InjuryOutcome::Fatal, RiskCurve::Tefft2013), None);
}

#[test]
fn a_tenth_of_those_met_by_a_cars_front_is_badly_hurt_at_the_published_speeds() {
    // lubbe2022, abstract, in whole km/h: pedestrians, cyclists, motorcyclists.
    for (kind, kmh) in [(PartnerKind::Pedestrian, 29.0), (PartnerKind::Cyclist, 44.0), (PartnerKind::Motorcycle, 48.0)]
    {
        let at =
            |kmh: f64| risk(&struck(kind, kmh / 3.6), InjuryOutcome::Mais3, RiskCurve::Lubbe2022).expect("covered");
        assert!(at(kmh - 1.0) < 0.1 && at(kmh + 1.0) > 0.1, "{kind:?}: {} at {kmh} km/h", at(kmh));
    }
    let drivers = |kmh: f64| {
        let found = severity(&car([0.0, 0.0], 0.0, kmh / 7.2), &car([4.45, 0.0], 180.0, kmh / 7.2), Impact::default());
        risk(&found.first, InjuryOutcome::Mais3, RiskCurve::Lubbe2022).expect("covered")
    };
    assert!(drivers(110.0) < 0.1 && drivers(114.0) > 0.1);
}

#[test]
fn pedestrians_and_cyclists_at_five_closing_speeds() {
    // Computed in Python from the coefficients of lubbe2022 at the median ages of its samples.
    let points = [
        (10.0, 0.025_04, 0.007_81),
        (30.0, 0.108_90, 0.036_83),
        (50.0, 0.367_72, 0.156_57),
        (70.0, 0.734_58, 0.474_02),
        (90.0, 0.929_43, 0.813_97),
    ];
    for (kmh, walking, cycling) in points {
        for (kind, expected) in [(PartnerKind::Pedestrian, walking), (PartnerKind::Cyclist, cycling)] {
            let found = risk(&struck(kind, kmh / 3.6), InjuryOutcome::Mais3, RiskCurve::Lubbe2022);
            same_risk(found, expected);
        }
    }
}

#[test]
fn people_who_walk_into_a_standing_cars_side_are_not_told() {
    let walker = party(PartnerKind::Pedestrian, [0.0, -1.1], 90.0, 1.5, [0.5, 0.5]);
    assert!(severity(&walker, &car([0.0, 0.0], 0.0, 0.0), Impact::default()).first.risks.is_empty());
}
