//! A rehearsal: both follow their lanes as told, and nobody reacts. It shows where and how they would meet, so that a
//! design can choose lanes and timing that make the told meeting happen. The simulator has the last word.

use recrash_model::geometry::{OrientedBox, Pose};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::metrics::CollisionKind;
use recrash_model::polygon::ConvexPolygon;
use recrash_model::scenario::{LateralMove, Policy};
use recrash_model::surroundings::Surface;
use recrash_model::zones::ContactZone;
use recrash_plan::{Alone, Plan, Way, drift};
use recrash_roads::LanePath;

/// Time step: at 20 m/s a metre. [s]
const STEP_S: f64 = 0.05;
/// Farther apart than this the gap is not looked at. [m]
const FAR_M: f64 = 25.0;
/// Headings this near to each other, or to opposite, are in line (`docs/models/contact-zones.md`). [rad]
const ALIGNED_RAD: f64 = 30.0 * math::PI / 180.0;

/// How one of the two moves along its path: what its plan does with nobody else on the road (`recrash_plan`).
#[derive(Debug, Clone)]
pub struct Motion<'a> {
    /// Lanes it follows.
    pub path: &'a LanePath,
    /// Start along the path. [m]
    pub start_m: f64,
    plan: Plan,
    way: Way,
    alone: Alone,
}

impl<'a> Motion<'a> {
    /// An ego, which holds its speed through bends too.
    pub fn ego(path: &'a LanePath, start_m: f64, speed_mps: f64, until_s: f64) -> Self {
        let plan = Plan::new(PartnerKind::PassengerCar, &holds_speed(speed_mps), 0.0, Surface::Dry);
        let way = Way::default();
        let alone = Alone::new(&plan, &way, start_m, speed_mps, until_s);
        Self { path, start_m, plan, way, alone }
    }

    /// A partner from its start, along the path and to the right of it, and from its first speed on. [m, m, m/s]
    pub fn partner(
        path: &'a LanePath,
        plan: Plan,
        moves: Vec<LateralMove>,
        start_m: f64,
        start_mps: f64,
        until_s: f64,
    ) -> Self {
        let way = Way::along(path, &plan, moves);
        let alone = Alone::new(&plan, &way, start_m, start_mps, until_s);
        Self { path, start_m, plan, way, alone }
    }

    /// Distance driven after a time. [m]
    pub fn driven(&self, time_s: f64) -> f64 {
        self.alone.driven(time_s)
    }

    /// Offset to the right of the lane's centre, and how fast it grows. [m, m/s]
    fn offset(&self, time_s: f64) -> (f64, f64) {
        self.way.line(&self.plan, time_s)
    }

    fn outline(&self, time_s: f64) -> OrientedBox {
        let (pose, rate) = self.along_lane(time_s);
        self.outline_at(time_s, pose, rate)
    }

    /// Where its centre is, with the heading of its lane, and how fast it moves to the right of that. [m/s]
    fn along_lane(&self, time_s: f64) -> (Pose, f64) {
        let (t, rate) = self.offset(time_s);
        (self.path.pose(self.start_m + self.driven(time_s), t), rate)
    }

    fn outline_at(&self, time_s: f64, pose: Pose, rate: f64) -> OrientedBox {
        let drift = drift(rate, self.alone.speed(time_s), self.plan.greatest_drift_rad);
        let pose = Pose { heading: pose.heading + drift, ..pose };
        OrientedBox::new(pose, 2.0 * self.plan.half_length_m, 2.0 * self.plan.half_width_m)
    }
}

/// Holds a speed, whoever and whatever is near.
pub fn holds_speed(target_speed: f64) -> Policy {
    Policy::SuddenBrake { target_speed, brake_step: 0, brake_steps: 0, speed_kp: None }
}

/// How the two met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// When they touched, or came closest. [s]
    pub time_s: f64,
    /// Gap between the boxes then; nil where they touched. [m]
    pub gap_m: f64,
    /// Zone on the ego.
    pub ego_zone: ContactZone,
    /// Zone on the partner.
    pub partner_zone: ContactZone,
    /// How far each had turned by then, left positive. [rad]
    pub ego_turned: f64,
    /// How far the partner had turned.
    pub partner_turned: f64,
    /// Where the ego's nose was along its path. [m]
    pub ego_nose_m: f64,
    /// How far the partner had moved sideways out of its lane. [m]
    pub partner_shifted_m: f64,
    /// Kind of collision, where it is one that profiles exclude.
    pub kind: Option<CollisionKind>,
}

/// An ego between two times, which any number of partners can meet.
pub struct Rehearsal<'a> {
    ego: &'a Motion<'a>,
    at_start: OrientedBox,
    /// When, and its outline then. [s]
    outlines: Vec<(f64, OrientedBox)>,
}

impl<'a> Rehearsal<'a> {
    /// Of an ego between these times. [s]
    pub fn new(ego: &'a Motion<'a>, from_s: f64, until_s: f64) -> Self {
        let steps = ((until_s - from_s) / STEP_S).ceil().clamp(0.0, 2000.0) as u32;
        let times = (0..=steps).map(|step| from_s.max(0.0) + f64::from(step) * STEP_S);
        Self { ego, at_start: ego.outline(0.0), outlines: times.map(|time_s| (time_s, ego.outline(time_s))).collect() }
    }

    /// Lets both drive and tells how they meet.
    pub fn with(&self, partner: &Motion) -> Option<Meeting> {
        let mut closest: Option<(f64, f64, &OrientedBox)> = None;
        for (time_s, outline) in &self.outlines {
            let (pose, rate) = partner.along_lane(*time_s);
            if outline.centre.distance(pose.position) > FAR_M {
                continue;
            }
            let other = partner.outline_at(*time_s, pose, rate);
            let gap = if outline.overlaps(&other) { 0.0 } else { outline.nearest_points(&other).2 };
            if closest.is_none_or(|(least, ..)| gap < least) {
                closest = Some((gap, *time_s, outline));
            }
            if gap <= 0.0 {
                break;
            }
        }
        closest.map(|(gap_m, time_s, outline)| self.meeting(partner, gap_m, time_s, outline))
    }

    fn meeting(&self, partner: &Motion, gap_m: f64, time_s: f64, a: &OrientedBox) -> Meeting {
        let b = partner.outline(time_s);
        let (on_ego, on_partner) = match ConvexPolygon::overlap(a, &b).mean_corner() {
            Some(middle) => (middle, middle),
            None => {
                let (on_ego, on_partner, _) = a.nearest_points(&b);
                (on_ego, on_partner)
            }
        };
        let (ego_zone, partner_zone) = (ContactZone::at(a, on_ego), ContactZone::at(&b, on_partner));
        let turned =
            |from: &OrientedBox, to: &OrientedBox| math::atan2(from.axis.cross(to.axis), from.axis.dot(to.axis));
        Meeting {
            time_s,
            gap_m,
            ego_zone,
            partner_zone,
            ego_turned: turned(&self.at_start, a),
            partner_turned: turned(&partner.outline(0.0), &b),
            ego_nose_m: self.ego.start_m + self.ego.driven(time_s) + self.ego.plan.half_length_m,
            partner_shifted_m: (partner.offset(time_s).0 - partner.plan.start_t_m).abs(),
            kind: kind_of(a, ego_zone, &b, partner_zone),
        }
    }
}

fn kind_of(
    ego: &OrientedBox,
    ego_zone: ContactZone,
    partner: &OrientedBox,
    partner_zone: ContactZone,
) -> Option<CollisionKind> {
    let turn = math::atan2(ego.axis.cross(partner.axis), ego.axis.dot(partner.axis)).abs();
    let apart = (partner.centre - ego.centre).dot(ego.axis.left()).abs();
    let in_line = apart < ego.half_width + partner.half_width - 0.4 * ego.half_width;
    if turn <= ALIGNED_RAD && in_line {
        if ego_zone.is_front() && partner_zone.is_rear() {
            return Some(CollisionKind::RearEndByEgo);
        }
        if ego_zone.is_rear() && partner_zone.is_front() {
            return Some(CollisionKind::RearEndOfEgo);
        }
    }
    let head_on = turn >= math::PI - ALIGNED_RAD && ego_zone.is_front() && partner_zone.is_front() && in_line;
    head_on.then_some(CollisionKind::HeadOn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::scenario::{Approach, CrossMap, MapSpec, Turn};
    use recrash_roads::RoadNetwork;

    const SPEED: f64 = 10.0;

    fn network() -> RoadNetwork {
        RoadNetwork::build(&MapSpec::X(CrossMap { lanes: 1, lane_width_m: 3.5, approach_m: 60.0, arm_m: 60.0 }))
    }

    fn path(network: &RoadNetwork, approach: Approach) -> LanePath {
        LanePath::new(network, network.route(approach, Turn::Straight).expect("a way straight on"), 0)
    }

    /// A box of 4 m by 2 m that holds a speed.
    fn motion(path: &LanePath, start_m: f64, speed_mps: f64) -> Motion<'_> {
        let plan = Plan::new(PartnerKind::PassengerCar, &holds_speed(speed_mps), 0.0, Surface::Dry);
        let plan = Plan { half_length_m: 2.0, half_width_m: 1.0, ..plan };
        Motion::partner(path, plan, Vec::new(), start_m, speed_mps, 10.0)
    }

    /// A partner from the left that reaches the crossing point `gap_s` after the ego.
    fn crossing(gap_s: f64) -> Meeting {
        let network = network();
        let (ego, other) = (path(&network, Approach::Same), path(&network, Approach::Left));
        let conflict = ego.conflict(&other, 2.0, 2.0).expect("they cross");
        let ego = motion(&ego, conflict.s_a - 30.0, SPEED);
        let partner = motion(&other, conflict.s_b - 30.0 - gap_s * SPEED, SPEED);
        Rehearsal::new(&ego, 0.0, 6.0).with(&partner).expect("they come near")
    }

    #[test]
    fn at_right_angles_the_later_one_hits_the_side_of_the_earlier_one() {
        // At 10 m/s a car of 4 m clears the way of one of 2 m in (2 * 2 + 2 * 1) / 10 = 0.6 s.
        let ego_first = crossing(0.3);
        assert_eq!((ego_first.gap_m, ego_first.partner_zone), (0.0, ContactZone::Front));
        assert_eq!(ego_first.ego_zone, ContactZone::Left);
        let partner_first = crossing(-0.3);
        assert_eq!((partner_first.ego_zone, partner_first.partner_zone), (ContactZone::Front, ContactZone::Right));
        assert_eq!(ego_first.kind.or(partner_first.kind), None);
    }

    #[test]
    fn who_comes_later_than_the_other_needs_to_clear_the_way_passes() {
        // 0.4 s of 10 m/s behind the ego's rear, across the diagonal of what is left.
        let passing = crossing(0.8);
        assert!(passing.gap_m > 0.3 && passing.gap_m < 2.0, "{passing:?}");
        assert!(crossing(-0.8).gap_m > 0.3);
        assert_eq!(crossing(0.0).gap_m, 0.0);
    }

    #[test]
    fn in_line_and_front_to_rear_is_a_rear_end_collision() {
        let network = network();
        let path = path(&network, Approach::Same);
        let slow = motion(&path, 20.0, 5.0);
        let meeting = Rehearsal::new(&motion(&path, 5.0, SPEED), 0.0, 6.0).with(&slow).expect("they come near");
        assert_eq!(meeting.kind, Some(CollisionKind::RearEndByEgo));
        // 15 m apart, 4 m of cars, 5 m/s faster: 2.2 s.
        assert!((meeting.time_s - 2.2).abs() <= 0.05 + 1e-9, "{meeting:?}");
    }
}
