//! Partners that leave the kerb, a stall, a driveway or their lane: from where they do, and when.

use crate::acts::Doing;
use crate::came::WHEELED_M;
use crate::ground::{Ground, LANE_M};
use crate::lanes;
use crate::pace::{Pace, ego_paces, first_time, start_over, when};
use crate::phases::{Beside, STOPS_SHORT_M};
use crate::side::{Side, Slant, Turning};
use crate::strips::strip_of;
use crate::told::Told;
use crate::touch::{Staging, side_of, size_of};
use recrash_model::account::{
    Account, Act, ContactState, LaneWord, LeftRight, Origin, Party, PlaceKind, Source, Standing, told,
};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::scenario::{ActorPlan, Deed, Leg, Place, StripKind};
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::Course;

/// From how far away somebody pulls out at least. [m]
pub(crate) const PULL_OUT_M: f64 = 8.0;

/// Length of a way out of the line, so that its bends have this radius at least. [m]
const LEAST_RADIUS_M: f64 = 10.0;

/// Who leaves its lane has begun so long before the contact, on so much of its way at least and at most. [s, m]
const LEAVES_S: f64 = 2.5;
const LEAVES_M: (f64, f64) = (12.0, 60.0);

/// Who comes over in front of an ego that stops for it began to so long before that slowed. [s]
const BEGUN_S: f64 = 0.7;

/// Who walks, or runs on four legs, comes across the kerb; who drives pulls out along it.
pub(crate) fn is_on_foot(kind: PartnerKind) -> bool {
    matches!(kind, PartnerKind::Pedestrian | PartnerKind::Animal)
}

/// Whether the partner pulled out from the kerb behind the ego, and came round it: told are that it pulled out or entered traffic,
/// and that it passed or came by on the left. Traffic keeps to the right, and so does who is parked.
pub(crate) fn comes_round(origin: Origin, partner: &Party, state: ContactState, movement: Option<Movement>) -> bool {
    let passes = movement == Some(Movement::Passing) || partner.did(Act::Pass);
    let from_there = match origin {
        Origin::Parked { .. } => passes,
        Origin::Behind | Origin::Beside { side: LeftRight::Left } => true,
        _ => false,
    };
    let pulls_out = partner.did(Act::PullOut) || movement == Some(Movement::EnteringTraffic);
    from_there && pulls_out && state == ContactState::Moving
}

/// Where a partner is whom the ego passes: beside it, where only a rule says that it comes from behind.
pub(crate) fn passed_beside(account: &Account, sv: &Side) -> Option<Origin> {
    let from = account.came_from.as_ref()?;
    let by_rule = matches!(from.source, Source::Rule { .. }) && from.value == Origin::Behind;
    let touched = side_of(&sv.zones).filter(|_| by_rule && sv.state == ContactState::Moving)?;
    Some(Origin::Beside { side: if touched > 0.0 { LeftRight::Left } else { LeftRight::Right } })
}

/// Whether an oncoming partner is told to have left its own side.
pub(crate) fn comes_over(origin: Origin, partner: &Party, movement: Option<Movement>) -> bool {
    let left = |act: Act| partner.acts.iter().any(|fact| fact.act == act && !fact.after_contact && !fact.begun);
    let told = match movement {
        Some(Movement::CrossingIntoOpposingLane | Movement::LaneDeparture | Movement::ChangingLanes) => true,
        Some(Movement::Straight | Movement::Passing) | None => left(Act::Drift) || left(Act::Swerve),
        _ => false,
    };
    origin == Origin::Opposite && told
}

impl Told {
    /// The ego that passes the partner on the other side goes round it there.
    pub(crate) fn goes_round(&mut self, sv: &Party) {
        let pass = sv.acts.iter().rfind(|fact| fact.act == Act::Pass && !fact.after_contact && !fact.begun);
        let Some(to) = pass.and_then(|fact| fact.side).filter(|_| self.sv.acts.iter().any(Doing::is_pass)) else {
            return;
        };
        let beside =
            matches!(self.origin, Origin::Beside { side } | Origin::Parked { side: Some(side) } if side == to.other());
        if beside && self.sv.movement == Some(Movement::Passing) && self.sv.aside.is_none() {
            (self.sv.aside, self.sv.goes_round) = (Some(to), true);
        }
    }

    /// Whether the partner comes along the ego's lane behind it and passes it.
    pub(crate) fn passes_from_behind(&self) -> bool {
        let own_lane = match (self.cp.lane, self.sv.lane) {
            (Some(cp), sv) if strip_of(cp).is_some() => sv != Some(cp),
            (Some(LaneWord::Opposing), _) => false,
            (Some(cp), Some(sv)) => cp != sv,
            _ => self.bus_lane().is_some(),
        };
        let own_lane = own_lane || self.leaves_to_who_passes();
        // Who changes lanes to pass has not come back where it touches no front.
        let pulls_out = self.cp.passes && !self.sv.zones.iter().any(|zone| zone.is_front());
        self.origin == Origin::Behind
            && (self.cp.movement == Some(Movement::Passing) || pulls_out || self.goes_out())
            && matches!(self.cp.state, ContactState::Moving | ContactState::SettingOff)
            && self.cp.turning == Turning::No
            && !own_lane
    }

    /// On which side of the ego the partner passes it in the lane for buses, in which the ego is not.
    pub(crate) fn bus_lane(&self) -> Option<LeftRight> {
        let alone = self.cp.lane == Some(LaneWord::Bus) && self.sv.lane != Some(LaneWord::Bus);
        let touched =
            || side_of(&self.sv.zones).map(|side| if side > 0.0 { LeftRight::Left } else { LeftRight::Right });
        self.cp.passes_on().or_else(touched).filter(|_| alone && self.origin == Origin::Behind)
    }

    /// Whether the ego changes into the lane in which the partner passes it, and meets it on that side.
    fn leaves_to_who_passes(&self) -> bool {
        let left_m = self.sv_aside().map_or(0.0, |aside| aside.from_t_m - aside.to_t_m);
        let touched = side_of(&self.sv.zones).unwrap_or(0.0);
        self.cp.movement == Some(Movement::Passing) && left_m * touched >= LANE_M
    }

    /// Whether the partner stood behind the ego and changes lanes to the side on which it touches it then: out of the ego's lane.
    fn goes_out(&self) -> bool {
        let to = self.cp.aside.or_else(|| self.cp.passes_on());
        let touched = side_of(&self.sv.zones).map(|side| if side > 0.0 { LeftRight::Left } else { LeftRight::Right });
        let changes = self.cp.movement == Some(Movement::ChangingLanes);
        changes && self.cp.stood_first && to.is_some() && to == touched && !self.plainly
    }

    /// Whether the ego stopped for an oncoming partner that had begun to come over.
    fn stops_for_who_comes_over(&self) -> bool {
        !self.plainly && self.comes_over && self.sv.acts.iter().any(|doing| doing.answers(&self.cp.acts))
    }

    /// Whether the partner stood behind the ego, and comes out of its lane to go round it.
    pub(crate) fn comes_out_from_stand(&self) -> bool {
        let stood = self.cp.stood_first || self.cp.state == ContactState::SettingOff;
        self.passes_from_behind() && stood && self.sv.turning == Turning::No && !self.plainly
    }

    /// Whether the partner's way is staged by what it did before.
    pub(crate) fn does_before(&self) -> bool {
        self.comes_out_from_stand() || self.stops_for_who_comes_over() || self.passes_after_stand()
    }

    /// Whether the partner comes along the lane beside which the ego is parked.
    pub(crate) fn comes_along_kerb(&self) -> bool {
        self.is_at_kerb()
            && self.origin == Origin::Behind
            && self.cp.state == ContactState::Moving
            && !self.cp.stood_first
            && !self.is_thrown()
    }

    /// Whether an oncoming partner that drives straight on touches an ego that stands on the ego's side of the road. Nobody tells that it
    /// left its own: it does so late.
    pub(crate) fn is_met_on_wrong_side(&self, ground: &Ground, cp: Pose) -> bool {
        self.is_met_by_oncoming() && cp.position.y < ground.opposing_y_m() - 0.5 * LANE_M
    }

    /// Whether an oncoming partner drives straight on past an ego that stands, and touches it.
    pub(crate) fn is_met_by_oncoming(&self) -> bool {
        self.origin == Origin::Opposite
            && self.cp.turning == Turning::No
            && self.sv.state.stands()
            && self.thing.is_none()
            && self.door.is_none()
            && matches!(self.cp.movement, None | Some(Movement::Straight | Movement::Passing))
    }

    /// Whether an oncoming partner that drives straight on touches an ego that goes straight on or stands.
    pub(crate) fn is_passed_by_oncoming(&self) -> bool {
        self.origin == Origin::Opposite
            && self.cp.turning == Turning::No
            && self.sv.turning == Turning::No
            && self.thing.is_none()
            && (matches!(self.cp.movement, None | Some(Movement::Straight | Movement::Passing))
                || self.pulls_out_opposite())
    }

    /// Whether an oncoming partner pulled out from the kerb of its own side.
    pub(crate) fn pulls_out_opposite(&self) -> bool {
        let pulls_out = self.cp.movement == Some(Movement::EnteringTraffic) && self.cp.state == ContactState::Moving;
        self.origin == Origin::Opposite && pulls_out && self.cp.turning == Turning::No && self.thing.is_none()
    }

    /// Whether the partner came along behind the ego on the opposite side, and changed from there into a lane of its own direction.
    pub(crate) fn leaves_opposite(&self) -> bool {
        let changes = matches!(self.cp.movement, Some(Movement::ChangingLanes | Movement::Merging));
        self.origin == Origin::Behind && self.cp.lane == Some(LaneWord::Opposing) && changes
    }

    /// Whether the partner has to keep to the lanes of the ego's direction: nobody tells that it left them.
    pub(crate) fn keeps_direction(&self) -> bool {
        let along = matches!(self.origin, Origin::Ahead | Origin::Behind | Origin::Beside { .. });
        let over = matches!(
            self.cp.movement,
            Some(Movement::CrossingIntoOpposingLane | Movement::WrongWay | Movement::UTurn | Movement::Passing)
        );
        // Who backs out of the lane ahead does so in that.
        let backs = self.origin == Origin::Ahead && self.cp.state == ContactState::Reversing;
        let backs = backs && self.cp.slants.is_none() && !self.cp.backs_in;
        let drives = (self.cp.state == ContactState::Moving || backs) && self.cp.turning == Turning::No;
        let street = !matches!(
            self.place,
            PlaceKind::Highway | PlaceKind::ParkingLot | PlaceKind::Garage | PlaceKind::Driveway | PlaceKind::Alley
        );
        along && !over && drives && street && self.cp.lane != Some(LaneWord::Opposing) && self.thing.is_none()
    }

    /// Whether the ego came to a stop for a partner beside it that had begun to come over into its lane.
    pub(crate) fn stops_for_merge(&self, sv: &Party, partner: &Party) -> bool {
        let step = |party: &Party, of: fn(Act) -> bool| {
            let before = party.acts.iter().filter(|fact| !fact.after_contact && of(fact.act));
            before.map(|fact| fact.step).min()
        };
        let over = step(partner, |act| matches!(act, Act::LaneChange | Act::Drift | Act::Swerve | Act::Enter));
        let slows = step(sv, |act| matches!(act, Act::Slow | Act::Stop));
        let came = told(&sv.standing) == Some(Standing::CameToStop) && self.sv.state == ContactState::Stopped;
        let merges = matches!(self.cp.movement, Some(Movement::ChangingLanes | Movement::Merging));
        let drives = self.cp.state == ContactState::Moving && !self.cp.stood_first && self.cp.phases.is_empty();
        let simple = self.sv.phases.is_empty() && self.thing.is_none() && self.cp.turning == Turning::No;
        let beside = matches!(self.origin, Origin::Beside { .. }) && self.ahead != Some(false);
        came && merges && drives && simple && beside && over.is_some() && over < slows
    }

    /// Whether the partner stood beside the lanes before it came: at the kerb, in a stall or in a driveway.
    pub(crate) fn stood_beside(&self) -> bool {
        let beside = matches!(self.origin, Origin::Parked { .. } | Origin::Stall { .. } | Origin::Driveway { .. });
        beside && self.cp.state == ContactState::Moving && !is_on_foot(self.cp.kind) && self.thing.is_none()
    }
}

/// The line at the kerb that the partner stood on, to the left of the ego's line. [m]
fn kerb_y_m(told: &Told, staging: &Staging) -> Option<f64> {
    if told.pulls_out_opposite() {
        let strip = staging.ground.beside.contains(&StripKind::Parking) && !staging.ground.junction;
        return strip.then_some(staging.ground.kerbs_m[0]);
    }
    let Origin::Parked { side } = told.origin else { return None };
    if !told.stood_beside() {
        return None;
    }
    let [left_m, right_m] = staging.ground.kerbs_m;
    let on_left = side.map_or(staging.cp.heading < 0.0, |side| side == LeftRight::Left);
    let (kerb_m, cp_m) = if on_left { (left_m, staging.cp.position.y) } else { (right_m, -staging.cp.position.y) };
    // Before a junction the road has two directions: it came out into the leftmost lane.
    if on_left && staging.ground.junction && staging.ground.lane > 0 {
        return Some(staging.sv.position.y + f64::from(staging.ground.lane) * LANE_M);
    }
    let aside_m = kerb_m.max(cp_m);
    Some(if on_left { aside_m } else { -aside_m })
}

/// The pace of a partner that pulls out from the kerb: from a stand, as far away as its way needs.
pub(crate) fn from_kerb(told: &Told, staging: &Staging) -> Option<Pace> {
    let aside_m = (kerb_y_m(told, staging)? - staging.cp.position.y).abs();
    let length_m = (4.0 * LEAST_RADIUS_M * aside_m).sqrt().max(PULL_OUT_M);
    start_over(told.contact_s, told.cp.speed_mps, length_m)
}

/// The line that a partner came along before it left it for the contact, to the left of the ego's line; nothing where it is
/// not told to have left one. [m]
pub(crate) fn line_y_m(told: &Told, staging: &Staging) -> Option<f64> {
    if told.comes_across() {
        return None;
    }
    // Who backs into a space at the kerb stood beside it, in the lane.
    if told.cp.backs_in {
        return Some(0.0);
    }
    if told.comes_along_kerb() && staging.ground.stands_m > 0.0 {
        return Some(0.0);
    }
    if told.comes_over || told.is_met_on_wrong_side(&staging.ground, staging.cp) {
        return Some(staging.ground.oncoming_y_m(told.cp.lane).max(staging.cp.position.y));
    }
    if told.leaves_opposite() {
        return Some(staging.ground.opposing_y_m());
    }
    kerb_y_m(told, staging)
        .or_else(|| told.strip_y_m(&staging.ground))
        .or_else(|| {
            let from_left_m = told.cp_from_left_m()?;
            let left = (staging.cp.position, from_left_m);
            let lane_m = lanes::left_lane_m(&staging.ground, staging.cp_came, left).filter(|_| !told.back_straight);
            Some(lane_m.unwrap_or(staging.cp.position.y + from_left_m))
        })
        .or_else(|| {
            beside(told).map(|side| staging.sv.position.y + if side == LeftRight::Left { LANE_M } else { -LANE_M })
        })
}

/// How far somebody drives who leaves its line for where it touches, in no tighter bend than who sets off steers; nothing of who walks. [m]
pub(crate) fn room_m(told: &Told, staging: &Staging) -> f64 {
    let (cp, length_m) = (staging.cp, size_of(&told.cp).0);
    if VehicleSpec::of(told.cp.kind).length_m <= WHEELED_M {
        return 0.0;
    }
    let (turn, came) = (math::wrap_angle(cp.heading - staging.cp_came), Vec2::from_heading(staging.cp_came));
    let line_y_m = line_y_m(told, staging).filter(|_| told.cp.turning == Turning::No);
    // Its rear axle goes over from one line to the other.
    let arm_m = recrash_roads::arm_m(told.cp.kind, length_m);
    let swings_m = arm_m * math::sin(turn.abs());
    let aside_m = line_y_m.map_or(swings_m, |line_y_m| {
        let over = Vec2::new(0.0, cp.position.y - line_y_m) - Vec2::from_heading(cp.heading) * arm_m;
        came.cross(over).abs()
    });
    let radius_m = STOOD_RADIUS_M.max(STOOD_LENGTHS * length_m);
    (4.0 * radius_m * aside_m).sqrt() + radius_m * turn.abs()
}

/// On which side of the ego's lane the partner comes along.
fn beside(told: &Told) -> Option<LeftRight> {
    match told.origin {
        // It keeps its lane where the ego changes lanes.
        Origin::Beside { side } => told.sv_aside().is_none().then_some(side),
        Origin::Behind if told.cp.lane == Some(LaneWord::Opposing) => Some(LeftRight::Left),
        _ => None,
    }
}

/// Who leaves its lane keeps it until then: where it begins, and the poses that it drives by to the contact.
pub(crate) fn keeps_lane(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let leaves = matches!(
        told.cp.movement,
        Some(
            Movement::ChangingLanes | Movement::Merging | Movement::CrossingIntoOpposingLane | Movement::LaneDeparture
        )
    );
    let leaves = leaves && !told.passes_from_behind()
        || told.comes_along_kerb() && staging.ground.stands_m > 0.0 && !told.passes_from_behind()
        || told.strip_y_m(&staging.ground).is_some() && told.cp.turning == Turning::No;
    let over = told.comes_over || told.is_met_on_wrong_side(&staging.ground, staging.cp);
    if !(leaves || told.cp.dodges || over) || told.cp.state != ContactState::Moving || pace.speed_mps == 0.0 {
        return None;
    }
    let (cp, came) = (staging.cp, Vec2::from_heading(staging.cp_came));
    let line_y_m = line_y_m(told, staging)?;
    let usual_m = (LEAVES_S * told.cp.speed_mps).clamp(LEAVES_M.0, LEAVES_M.1);
    // It had begun before the ego slowed.
    let since_m = pace.driven_m - pace.speed_mps * (first_time(&pace.acts) - BEGUN_S);
    let ego_brakes_s = || first_time(&ego_paces(told, &staging.ground, staging.sv_s_m).1.acts);
    let over_m = match told.gives_way_to_merge {
        true => since_m.max(usual_m),
        false if told.stops_for_who_comes_over() => {
            (told.cp.speed_mps * (told.contact_s - ego_brakes_s() + BEGUN_S)).clamp(usual_m, LEAVES_M.1)
        }
        false => usual_m,
    };
    let leaves = Pose { position: Vec2::new(cp.position.x - came.x * over_m, line_y_m), heading: staging.cp_came };
    let mut course = Course::begin(arm_m);
    let before_m = if course.curve(leaves, cp, false) { pace.driven_m - course.length_m() } else { return None };
    let begin = Pose { position: leaves.position - came * before_m, ..leaves };
    (before_m > 1.0).then(|| (begin, vec![leaves, cp]))
}

/// Who passes has come out of the ego's lane so far before the contact, and does so on so much of its way at most. [m]
const OUT_M: f64 = 6.0;
const COMES_OUT_M: f64 = 24.0;

/// Who comes out to pass has not gone to the other side by more than this before. [m]
const DIPS_M: f64 = 0.3;

/// Who is at more than this to its road, away from whom it passes, is on its way out. [rad]
const AWAY_RAD: f64 = 0.02;

/// The same of who stood close behind it, with no tighter bend, or of so much of its length. [m]
const STOOD_OUT_M: f64 = 4.0;
const STOOD_RADIUS_M: f64 = 5.5;
const STOOD_LENGTHS: f64 = 0.5;

/// Who comes from behind the ego and passes it comes out of its lane, goes along beside it, and then comes too near: where it begins, and
/// the poses that it drives by.
pub(crate) fn comes_by(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    if !told.passes_from_behind() {
        return None;
    }
    let cp = staging.cp;
    let comes_in = math::wrap_angle(cp.heading - staging.cp_came);
    // Who stood close behind has less room for it.
    let stood = told.comes_round_from_stand();
    let (out_m, radius_m) = if stood { (STOOD_OUT_M, STOOD_RADIUS_M) } else { (OUT_M, LEAST_BY_RADIUS_M) };
    // Who touches on its way out does not go along beside the ego first.
    if stood && comes_in * (cp.position.y - staging.sv.position.y) > 0.0 {
        return None;
    }
    let out_y_m = cp.position.y - 0.5 * out_m * comes_in;
    // An ego that turns came along its line.
    let turns = matches!(told.sv.turning, Turning::Left | Turning::Right);
    let leaves = told.sv_aside().is_some();
    let along = told.comes_along_kerb() || turns || leaves;
    let own_y_m = if along { staging.ground.sv_pose(0.0).position.y } else { staging.sv.position.y };
    // Who is yet on its way out comes straight out of its lane, and does not go to the side of whom it passes for that first.
    let side = (cp.position.y - staging.sv.position.y).signum();
    if !stood && comes_in * side > AWAY_RAD {
        let late = lanes::from_lane(told, staging, pace, arm_m);
        if late.is_some() || (own_y_m - out_y_m) * side > DIPS_M {
            return late;
        }
    }
    let back_m = (pace.driven_m - 0.5).min(out_m + COMES_OUT_M);
    let bends_m = (4.0 * radius_m * (out_y_m - own_y_m).abs()).sqrt();
    if back_m - out_m < bends_m {
        return None;
    }
    between_lines(staging, pace, arm_m, [(back_m, own_y_m), (out_m, out_y_m)])
}

/// Who changed into the ego's lane behind it is back on its line so far before the contact, and took so long for it. [m]
const CHANGED_M: f64 = 8.0;
const CHANGES_OVER_M: f64 = 30.0;

/// Who changed lanes behind the ego, and then came straight on: from the lane that it left, the one on its left where there is one.
pub(crate) fn changed_behind(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let ground = &staging.ground;
    if !told.cp.changed_lanes || told.origin != Origin::Behind || told.cp.state != ContactState::Moving {
        return None;
    }
    let from = match told.cp.aside {
        Some(to) => to.other(),
        None if ground.lane > 0 => LeftRight::Left,
        None if ground.lanes > 1 => LeftRight::Right,
        None => return None,
    };
    let line_y_m = staging.sv.position.y + if from == LeftRight::Left { LANE_M } else { -LANE_M };
    between_lines(staging, pace, arm_m, [(CHANGED_M + CHANGES_OVER_M, line_y_m), (CHANGED_M, staging.cp.position.y)])
}

/// The lane from which somebody came over before it stopped ahead of the ego, or beside it: the told one, else the one on its left where
/// there is one.
pub(crate) fn came_over(told: &Told, ground: &Ground, arm_m: f64) -> Option<Beside> {
    let from = match told.cp.came_over? {
        Some(to) => to.other(),
        None if ground.lane > 0 => LeftRight::Left,
        None if ground.lanes > 1 => LeftRight::Right,
        None => return None,
    };
    let along = matches!(told.origin, Origin::Ahead | Origin::Behind);
    along.then_some(Beside { left_m: if from == LeftRight::Left { LANE_M } else { -LANE_M }, arm_m })
}

/// Along one line until so far before the contact, over to another by so far, and on to the contact: where it begins, and the poses that it
/// drives by. Of each line how far before the contact and where beside the road's axis. [m]
fn between_lines(staging: &Staging, pace: &Pace, arm_m: f64, lines: [(f64, f64); 2]) -> Option<(Pose, Vec<Pose>)> {
    let (cp, came) = (staging.cp, Vec2::from_heading(staging.cp_came));
    let [leaves, joins] = lines.map(|(back_m, y_m)| Pose {
        position: Vec2::new(cp.position.x - came.x * back_m, y_m),
        heading: staging.cp_came,
    });
    let mut course = Course::begin(arm_m);
    if !(course.curve(leaves, joins, false) && course.curve(joins, cp, false)) {
        return None;
    }
    let before_m = pace.driven_m - course.length_m();
    let begin = Pose { position: leaves.position - came * before_m.max(0.0), ..leaves };
    (before_m > 0.02).then(|| (begin, vec![leaves, joins, cp]))
}

/// No bend of who comes out to pass is tighter. [m]
const LEAST_BY_RADIUS_M: f64 = 7.0;

/// Least radius of a turn, of the line that the rear axle drives on, and that in lengths of who is long; and what it feels sideways at
/// most in a wider one. [m, 1, m/s^2]
const TURN_M: f64 = 8.0;
const TURN_LENGTHS: f64 = 0.75;
const TURN_MPS2: f64 = 4.0;

/// Radius of the partner's turn. [m]
pub(crate) fn turn_m(told: &Told) -> f64 {
    let cp = &told.cp;
    TURN_M.max(TURN_LENGTHS * size_of(cp).0).max(cp.speed_mps * cp.speed_mps / TURN_MPS2)
}

/// Who has turned into the ego's road meets it so far behind its turn, or farther. [m]
const BEHIND_TURN_M: f64 = 1.0;

/// Who turns drives straight on, and then by one bend to the contact, or into the ego's road and along it: where it begins, and the
/// poses that it drives by.
pub(crate) fn turns_in(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let cp = staging.cp;
    let turn = math::wrap_angle(cp.heading - staging.cp_came);
    if !matches!(told.cp.turning, Turning::Left | Turning::Right) || told.cp.state == ContactState::Reversing {
        return None;
    }
    if let Some(found) = into_the_road(told, staging, pace, arm_m) {
        return Some(found);
    }
    let radius_m = turn_m(told).min(pace.driven_m / turn.abs());
    let came = staging.cp_came;
    bend_from_lane(told, staging, (cp, came, radius_m), pace, arm_m)
        .or_else(|| by_bend(bend_before(cp, came, radius_m, arm_m), vec![cp], pace, arm_m))
}

/// Along the middle of a lane, by a bend of about this radius, and straight on to a pose where it has to.
fn bend_from_lane(
    told: &Told,
    staging: &Staging,
    (end, came, radius_m): (Pose, f64, f64),
    pace: &Pace,
    arm_m: f64,
) -> Option<(Pose, Vec<Pose>)> {
    let (bent, radius_m) = lanes::bend_from_lane(told, (&staging.ground, staging.sv), end, (came, radius_m))?;
    let poses = if bent.position.distance(end.position) > 0.1 { vec![bent, end] } else { vec![end] };
    by_bend(bend_before(bent, came, radius_m, arm_m), poses, pace, arm_m)
}

/// Where a bend of this radius that ends in a pose begins.
fn bend_before(end: Pose, came: f64, radius_m: f64, arm_m: f64) -> Pose {
    let (turn, way) = (math::wrap_angle(end.heading - came), Vec2::from_heading(came));
    let axle = end.position - Vec2::from_heading(end.heading) * arm_m;
    let (along_m, aside_m) = (radius_m * math::sin(turn.abs()), radius_m * (1.0 - math::cos(turn)) * turn.signum());
    Pose { position: axle - way * (along_m - arm_m) - way.left() * aside_m, heading: came }
}

/// Straight on to where a bend begins, and by these poses then.
fn by_bend(bends: Pose, poses: Vec<Pose>, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let mut course = Course::begin(arm_m);
    let mut from = bends;
    for pose in &poses {
        if !course.curve(from, *pose, false) {
            return None;
        }
        from = *pose;
    }
    let before_m = pace.driven_m - course.length_m();
    let begin = Pose { position: bends.position - Vec2::from_heading(bends.heading) * before_m, ..bends };
    match before_m > 0.5 {
        true => Some((begin, [bends].into_iter().chain(poses).collect())),
        false => (before_m > -0.02).then_some((bends, poses)),
    }
}

/// Who comes along the crossing road and turns into the ego's, towards it, does so in the junction and not where it meets the ego.
fn into_the_road(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let (cp, ground) = (staging.cp, &staging.ground);
    let towards = Vec2::from_heading(cp.heading).x < -0.8;
    let (Origin::Cross { side }, true, true) = (told.origin, ground.junction, towards) else { return None };
    // The lane nearest to the ego from the left, the one beside the middle from the right.
    let lane_m = match side {
        LeftRight::Left => -(ground.lanes as f64 - 0.5) * LANE_M,
        LeftRight::Right => 0.5 * LANE_M,
    };
    let turned = Pose { heading: math::PI, ..cp };
    let bends = bend_before(turned, staging.cp_came, turn_m(told), arm_m);
    let behind_m = lane_m - bends.position.x;
    if behind_m < BEHIND_TURN_M {
        return None;
    }
    let by = |pose: Pose| Pose { position: pose.position + Vec2::new(behind_m, 0.0), ..pose };
    by_bend(by(bends), vec![by(turned), cp], pace, arm_m)
}

/// Who turns off the road and stops there comes along it with this speed, brakes by so much, and stands so long before it reverses.
/// [m/s, m/s^2, s]
const TURNS_OFF_MPS: f64 = 4.0;
const TURNS_OFF_MPS2: f64 = 2.0;
const TURNED_STANDS_S: f64 = 1.0;

/// The same plan of who reverses, with how it came there before: along the road, by a bend to where it stands. Nothing where it is not
/// told to have come, or has no time to.
pub(crate) fn turns_off(
    told: &Told,
    staging: &Staging,
    begin: Pose,
    plan: &ActorPlan,
    arm_m: f64,
) -> Option<ActorPlan> {
    let crosses = matches!(told.origin, Origin::Cross { .. });
    let came_there = told.cp.came_there || crosses;
    let Some(Slant::Stood { oncoming, .. }) = told.cp.slants.filter(|_| came_there) else { return None };
    let came = if oncoming { math::PI } else { 0.0 };
    let stands_s = ((first_time(&plan.acts) - TURNED_STANDS_S) * 10.0).floor() / 10.0;
    let braking_s = TURNS_OFF_MPS / TURNS_OFF_MPS2;
    let driven_m = TURNS_OFF_MPS * (stands_s - 0.5 * braking_s);
    let pace = Pace { speed_mps: TURNS_OFF_MPS, acts: Vec::new(), driven_m: driven_m + STOPS_SHORT_M };
    let turn = math::wrap_angle(begin.heading - came).abs();
    let radius_m = TURN_M.min(driven_m / turn.max(0.1));
    let from_lane = bend_from_lane(told, staging, (begin, came, radius_m), &pace, arm_m);
    let bends = || by_bend(bend_before(begin, came, radius_m, arm_m), vec![begin], &pace, arm_m);
    let (start, poses) = from_lane.or_else(bends)?;
    let at = |pose: Pose| Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees());
    let legs = poses.into_iter().map(|pose| Leg::Curve { to: at(pose), reverse: false });
    let stop = when(stands_s - braking_s, Deed::Stop { rate_mps2: TURNS_OFF_MPS2, at_m: None });
    Some(ActorPlan {
        start: at(start),
        speed_mps: TURNS_OFF_MPS,
        course: legs.chain(plan.course.clone()).collect(),
        acts: [stop].into_iter().chain(plan.acts.clone()).collect(),
        ..plan.clone()
    })
}
