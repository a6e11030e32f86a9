//! Lanes that lead the way by which somebody comes, and how it comes from the middle of one of them to where it touches.

use crate::ground::way::Ground;
use crate::pace::plain::Pace;
use crate::told::crash::Told;
use crate::told::side::{Turning, size_of};
use crate::touch::staging::Staging;
use crate::usual::LANE_M;
use recrash_model::account::{ContactState, LeftRight, Origin};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_roads::Course;

/// A way that is no farther off than this leads along a road. [rad]
const ALONG_RAD: f64 = 0.05;

/// Lanes of one direction: the way they lead, and the middle of each, from the leftmost, to the left of a line of that way through the
/// origin. [rad, m]
struct Lanes {
    way_rad: f64,
    lefts_m: Vec<f64>,
    /// The ego's line before it leaves that, to the left of the same. [m]
    own_m: f64,
}

impl Lanes {
    /// Those that lead the way that somebody came; nothing where none do.
    fn of(ground: &Ground, came: f64) -> Option<Self> {
        let quarters = (came / math::FRAC_PI_2).round();
        let way_rad = math::wrap_angle(quarters * math::FRAC_PI_2);
        let across = quarters.rem_euclid(2.0) == 1.0;
        if math::wrap_angle(came - way_rad).abs() > ALONG_RAD || across && !ground.junction {
            return None;
        }
        // The line between the two directions, which keep to the right of it.
        let middle = Vec2::new(0.0, ground.sv_pose(0.0).position.y + (f64::from(ground.lane) + 0.5) * ground.lane_m);
        let count = match math::cos(way_rad) {
            _ if across => ground.cross_lanes,
            cosine if cosine < -0.5 => ground.oncoming,
            _ => ground.lanes,
        };
        let middle_m = Vec2::from_heading(way_rad).cross(middle);
        let lefts_m: Vec<f64> = (0..count).map(|lane| middle_m - (lane as f64 + 0.5) * ground.lane_m).collect();
        let own_m = Vec2::from_heading(way_rad).cross(ground.sv_pose(0.0).position);
        (!lefts_m.is_empty()).then_some(Self { way_rad, lefts_m, own_m })
    }

    /// How far to the left a place is. [m]
    fn left_m(&self, place: Vec2) -> f64 {
        Vec2::from_heading(self.way_rad).cross(place)
    }

    /// Those that fit, the nearest to a line first. [m]
    fn nearest(&self, left_m: f64, fits: impl Fn(f64) -> bool) -> Vec<f64> {
        let mut list: Vec<f64> = self.lefts_m.iter().copied().filter(|lane_m| fits(*lane_m)).collect();
        list.sort_by(|a, b| (a - left_m).abs().total_cmp(&(b - left_m).abs()));
        list
    }

    /// Whether somebody may come along a lane: along the told one; from beside, along the next one to the ego's; from behind, along that.
    fn may_lead(&self, told: &Told, sv: Pose, lane_m: f64) -> bool {
        let several = self.lefts_m.len() > 1 && !told.turns_abreast();
        if let Some(number) = told.lane_number(false, self.lefts_m.len()).filter(|_| several) {
            return self.lefts_m.get(number) == Some(&lane_m);
        }
        // Beside whom it comes, and ahead of whom it is not, is to be seen when it sets out.
        let along = self.way_rad.abs() < 0.01 && sv.heading.abs() < TURNS_RAD;
        let aside = told.sv_aside().filter(|_| along);
        let (from_m, to_m) = match aside {
            Some(aside) => (self.own_m - aside.from_t_m, self.own_m - aside.to_t_m),
            None => (self.left_m(sv.position), self.left_m(sv.position)),
        };
        // Of who leaves its line beside the lane that it comes from, and no farther than beside the one that it goes to.
        let beside = |from_m: f64, to_m: f64| from_m > BESIDE_M && from_m.min(to_m) < FARTHEST_M;
        let from = told.bus_lane().map_or(told.origin, |side| Origin::Beside { side });
        match from {
            Origin::Beside { side: LeftRight::Left } => beside(lane_m - from_m, lane_m - to_m),
            Origin::Beside { side: LeftRight::Right } => beside(from_m - lane_m, to_m - lane_m),
            // Of who leaves its line also in the lane that it goes to.
            Origin::Behind if along && !told.drives_elsewhere() => {
                [from_m, to_m].into_iter().any(|own_m| self.nearest(own_m, |_| true).first() == Some(&lane_m))
            }
            _ => true,
        }
    }

    /// The pose in the middle of a lane, so far before a place. [m]
    fn before(&self, place: Vec2, back_m: f64, lane_m: f64) -> Pose {
        let way = Vec2::from_heading(self.way_rad);
        let position = place - way * back_m + way.left() * (lane_m - self.left_m(place));
        Pose { position, heading: self.way_rad }
    }
}

/// Who comes to the told zones out of the middle of its lane has left that so long before the contact, on so much of its way at least, where it
/// can; and feels no more than this sideways, in no bend tighter than this, or than so much of its length. [s, m, m/s^2, m]
const LEAVES_S: [f64; 5] = [2.5, 3.5, 5.0, 2.0, 1.5];
const LEAST_M: f64 = 4.0;
const SIDEWAYS_MPS2: f64 = 2.5;
const TIGHTEST_LEAD_M: f64 = 8.0;
const TIGHTEST_LENGTHS: f64 = 0.75;

/// Who stood behind the ego and goes round it steers no tighter, and drives straight on for so long first. [m]
const ROUND_M: f64 = 5.5;
const SETS_OFF_M: f64 = 1.0;

/// Who is no farther beside the middle of its lane where it touches keeps its line. [m]
const KEEPS_M: f64 = 0.7;

/// Who is not told to have left its lane does not come from a lane that is farther aside. [m]
const MOST_M: f64 = 4.0;

/// Who touches at an angle of more than this turns. [rad]
const TURNS_RAD: f64 = 0.6;

/// Who comes from beside does so in a lane that is so far beside the ego, at least. [m]
const BESIDE_M: f64 = 2.0;

/// And no farther, where no lane is told. [m]
const FARTHEST_M: f64 = 1.5 * LANE_M;

/// Who changes lanes goes aside by so much at least. [m]
const CHANGES_M: f64 = 1.0;

/// Who comes along a lane, and touches beside the middle of it, leaves that by a gentle bend shortly before: where it begins, and the poses
/// that it drives by to the contact.
pub(crate) fn from_lane(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let cp = staging.cp;
    let turn = math::wrap_angle(cp.heading - staging.cp_came);
    let moves = matches!(told.cp.state, ContactState::Moving | ContactState::SettingOff | ContactState::Stopped);
    let moves = moves && !told.comes_out_from_stand();
    let elsewhere = told.drives_elsewhere() || told.pulls_out_opposite();
    let elsewhere = elsewhere || told.meets_in_narrow() || told.squeezes_by();
    if !told.comes_along_lanes() || elsewhere || !moves || turn.abs() > TURNS_RAD || told.back_straight {
        return None;
    }
    let lanes = Lanes::of(&staging.ground, staging.cp_came)?;
    let speed_mps = pace.speed_mps.max(told.cp.speed_mps);
    let comes_round = told.comes_round_from_stand();
    let tightest_m = if comes_round { ROUND_M } else { TIGHTEST_LEAD_M };
    let tightest_m = tightest_m.max(TIGHTEST_LENGTHS * size_of(&told.cp).0).max(speed_mps * speed_mps / SIDEWAYS_MPS2);
    // Where it would come from without bending twice.
    let straight_m = lanes.left_m(cp.position) - turn.signum() * tightest_m * (1.0 - math::cos(turn));
    let lane_m = *lanes.nearest(straight_m, |lane_m| lanes.may_lead(told, staging.sv, lane_m)).first()?;
    let aside_m = (lane_m - straight_m).abs();
    if turn.abs() < 0.01 && aside_m < KEEPS_M || aside_m > MOST_M {
        return None;
    }
    let backs_m = LEAVES_S.map(|leaves_s| (leaves_s * speed_mps).max(LEAST_M));
    // Who stood close behind the ego begins to leave its line as it sets off.
    let at_once = comes_round.then_some(pace.driven_m - SETS_OFF_M);
    backs_m.into_iter().chain(at_once).find_map(|back_m| {
        let leaves = lanes.before(cp.position, back_m, lane_m);
        let mut course = Course::begin(arm_m);
        let before_m = if course.curve(leaves, cp, false) { pace.driven_m - course.length_m() } else { return None };
        let begin = Pose { position: leaves.position - Vec2::from_heading(leaves.heading) * before_m, ..leaves };
        (before_m > 0.5 && is_gentle(&course, tightest_m)).then(|| (begin, vec![leaves, cp]))
    })
}

/// Whether a line bends no tighter than this.
fn is_gentle(course: &Course, tightest_m: f64) -> bool {
    let steps = (course.length_m() / STEP_M).ceil() as usize;
    (0..=steps).all(|step| course.spot(STEP_M * step as f64).curvature.abs() * tightest_m <= 1.0)
}

/// A line is looked at in steps of this. [m]
const STEP_M: f64 = 0.5;

/// The lane from which somebody leaves its line for one beside it, on this side of that or on its other side: the nearest that is far enough
/// aside. [m]
pub(crate) fn left_lane_m(ground: &Ground, came: f64, (at, from): (Vec2, f64)) -> Option<f64> {
    let lanes = Lanes::of(ground, came)?;
    let (at_m, to_left) = (lanes.left_m(at), from * math::cos(lanes.way_rad) > 0.0);
    let fits = |lane_m: f64| if to_left { lane_m - at_m >= CHANGES_M } else { at_m - lane_m >= CHANGES_M };
    let lane_m = *lanes.nearest(at_m, fits).first()?;
    Some(lane_m * math::cos(lanes.way_rad).signum())
}

/// Who turns out of its lane drives straight on behind its bend for no longer; and turns a little tighter where that takes it into its lane.
/// [m]
const STRAIGHT_M: f64 = 15.0;
const TIGHTER: [f64; 2] = [1.0, 0.75];
const BEGINS_M: f64 = 0.3;

/// A bend out of the middle of a lane: where it ends, its radius, and how many lanes lie between that lane and the one for its turn. [m, 1]
#[derive(Debug, Clone, Copy)]
pub(crate) struct LaneBend {
    pub(crate) end: Pose,
    pub(crate) radius_m: f64,
    lanes_off: usize,
}

/// A bend that begins in the middle of a lane and leads to a pose: it ends there, or before it.
pub(crate) fn bend_from_lane(
    told: &Told,
    (ground, sv): (&Ground, Pose),
    end: Pose,
    (came, radius_m): (f64, f64),
) -> Option<LaneBend> {
    let lanes = Lanes::of(ground, came).filter(|_| !told.back_straight && told.comes_along_lanes())?;
    let arm_m = recrash_roads::arm_m(told.cp.kind, size_of(&told.cp).0);
    let (turn, way) = (math::wrap_angle(end.heading - came), Vec2::from_heading(end.heading));
    let axle_m = lanes.left_m(end.position - way * arm_m);
    let straight = |radius_m: f64, lane_m: f64| {
        let gains_m = turn.signum() * (axle_m - lane_m) - radius_m * (1.0 - math::cos(turn));
        let on_m = gains_m.max(0.0) / math::sin(turn).abs().max(0.1);
        (gains_m > -BEGINS_M && on_m < STRAIGHT_M).then_some(on_m)
    };
    let off = |lane: usize| if turn > 0.0 { lane } else { lanes.lefts_m.len() - 1 - lane };
    let bends = lanes.lefts_m.iter().enumerate().filter(|(_, lane_m)| lanes.may_lead(told, sv, **lane_m));
    let bends = bends.flat_map(|(lane, lane_m)| {
        let parts = TIGHTER.into_iter().enumerate();
        let lanes_off = if told.turns_out_of_other_way() && !told.any_lane { off(lane) } else { 0 };
        parts.filter_map(move |(tighter, part)| {
            let on_m = straight(radius_m * part, *lane_m)?;
            let end = Pose { position: end.position - way * on_m, ..end };
            Some(((lanes_off, tighter), on_m, LaneBend { end, radius_m: radius_m * part, lanes_off }))
        })
    });
    bends.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))).map(|(_, _, bend)| bend)
}

impl Told {
    /// Whether the partner turns out of the opposite direction or the crossing road, and no lane of that is told: "an oncoming sedan turned
    /// left" does so out of the lane beside the middle.
    pub(crate) fn turns_out_of_other_way(&self) -> bool {
        let turns = matches!(self.cp.turning, Turning::Left | Turning::Right);
        turns && matches!(self.origin, Origin::Opposite | Origin::Cross { .. }) && self.cp.lane.is_none()
    }
}

/// Who goes straight on has turned by no more than this. [rad]
const STRAIGHT_RAD: f64 = 0.26;

/// And in a narrow street by this it is worth as much as a metre beside its lane. [rad]
const SQUEEZES_RAD: f64 = 0.07;

/// How much somebody who touches so would have to bend to come there out of a lane of its direction: none, where it is in the middle of one;
/// [`NOWHERE`], where none leads there.
pub(super) fn bends(told: &Told, (ground, sv): (&Ground, Pose), cp: Pose, came: f64) -> u32 {
    let turn = math::wrap_angle(cp.heading - came);
    // By its way, where it goes with an ego that turns.
    let with_ego = told.sv.turning != Turning::No && !matches!(told.origin, Origin::Opposite | Origin::Cross { .. });
    let with_ego = with_ego && !told.goes_straight_beside();
    // Who comes over a crosswalk goes straight over it.
    if told.crosses_at_walk() && told.cp.turning == Turning::No {
        return (turn.abs() / STRAIGHT_RAD).ceil() as u32;
    }
    let elsewhere = !told.comes_along_lanes() || told.drives_elsewhere() || told.comes_along_kerb();
    if elsewhere || with_ego || told.cp.state == ContactState::Reversing {
        return 0;
    }
    if matches!(told.cp.turning, Turning::Left | Turning::Right) {
        let radius_m = turn_m(told);
        return bend_from_lane(told, (ground, sv), cp, (came, radius_m)).map_or(NOWHERE, |bend| bend.lanes_off as u32);
    }
    // Along the middle of a narrow street, as straight as it can.
    let over = told.origin == Origin::Opposite && (told.comes_over_line() || told.slows_for_who_came_over());
    if told.squeezes_by() || told.meets_in_narrow() || over {
        return (turn.abs() / SQUEEZES_RAD).round() as u32;
    }
    let Some(lanes) = Lanes::of(ground, came) else { return 0 };
    let comes_round = told.comes_round_from_stand();
    // Who pulls out from behind the ego is yet on its bend.
    let gained_m = if comes_round { turn.signum() * TIGHTEST_LEAD_M * (1.0 - math::cos(turn)) } else { 0.0 };
    let left_m = lanes.left_m(cp.position) - gained_m;
    let lane_m = lanes.nearest(left_m, |lane_m| lanes.may_lead(told, sv, lane_m)).first().copied();
    let off_m = lane_m.map_or(f64::from(NOWHERE), |lane_m| (lane_m - left_m).abs() - KEEPS_M).max(0.0);
    let aside = told.leaves_its_lane() || matches!(told.origin, Origin::Beside { .. });
    let weaves = if turn.abs() > STRAIGHT_RAD && !aside { 2 } else { 0 };
    if aside && !comes_round && off_m < LANE_M { 0 } else { (off_m.ceil() as u32 + weaves).min(NOWHERE) }
}

/// More than anybody bends.
const NOWHERE: u32 = 9;

/// Least radius of a turn, of the line that the rear axle drives on, and that in lengths of who is long; and what it feels sideways at
/// most in a wider one. [m, 1, m/s^2]
pub(crate) const TURN_M: f64 = 8.0;
const TURN_LENGTHS: f64 = 0.75;
const TURN_MPS2: f64 = 4.0;

/// Radius of the partner's turn. [m]
pub(crate) fn turn_m(told: &Told) -> f64 {
    let cp = &told.cp;
    TURN_M.max(TURN_LENGTHS * size_of(cp).0).max(cp.speed_mps * cp.speed_mps / TURN_MPS2)
}
