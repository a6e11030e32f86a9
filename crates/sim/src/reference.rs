//! A competent and careful human driver: `reference`.
//!
//! It says what could have been avoided. In an emergency it reacts as the driver model of UN Regulation No. 157 does:
//! not before 1.15 s, then up to 0.774 g (`emergency.rs`). Before that it drives carefully: keeps two seconds behind
//! others, gives way where paths cross, slows for curves, and steers around what stands in its lane where its own
//! direction has room; all of it comfortably, and for those alone whom it has had the time to notice.
//! The regulation covers cut-in, cut-out and braking leads; what is taken over to crossings and to people on foot is
//! said in `docs/models/reference.md`.

use crate::chassis::Controls;
use crate::emergency::EmergencyResponse;
use crate::give_way::GiveWay;
use crate::idm::{IdmParameters, curve_limit};
use crate::scene::{Scene, Seen};
use crate::steering::LaneKeeper;
use crate::swerve::Swerve;
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::rollout::STEP_S;
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::constants::MERGED_M;
use recrash_plan::{Crossing, Manners, Stretch};

/// It looks this far ahead. [m]
const SIGHT_M: f64 = 100.0;

/// Room it wants on each side of itself. [m]
const SIDE_ROOM_M: f64 = 0.2;

/// Time it wants between itself and others at a crossing; as `idm`. [s]
const CROSSING_GAP_S: f64 = 1.0;

/// Time headway of the careful driver (UN R157, Annex 4, Appendix 3: the preceding vehicle is followed at 2.0 s). [s]
const TIME_HEADWAY_S: f64 = 2.0;

/// Deceleration that most drivers find comfortable (aashto2018: 11.2 ft/s^2). [m/s^2]
const COMFORTABLE_MPS2: f64 = 3.4;

/// Deceleration by which it regains its distance from somebody it is not closing on; assumed. [m/s^2]
const REGAINING_MPS2: f64 = 2.0;

/// Sideways acceleration it accepts in curves; assumed, a little below `idm`'s. [m/s^2]
const CURVE_MPS2: f64 = 3.0;

/// Below this time to collision a situation is dangerous (UN R157, Annex 4, Appendix 3). [s]
const DANGEROUS_TTC_S: f64 = 2.0;

/// Whoever in front brakes harder than this is a danger (UN R157, Annex 4, Appendix 3). [m/s^2]
const DANGEROUS_BRAKING_MPS2: f64 = 5.0;

/// Vehicles wander by this much in their lanes; who is further from its centre is changing lane (UN R157). [m]
const WANDERING_M: f64 = 0.375;

/// Slower sideways moves are not noticed as such; assumed. [m/s]
const DRIFT_MPS: f64 = 0.1;

/// Somebody beside whose side is further away than this is not cutting in yet. [m]
const BESIDE_M: f64 = 3.5;

/// Somebody beside whose middle is further behind than this comes in behind. [m]
const BEHIND_M: f64 = 1.5;

/// Acceleration with which it draws ahead of somebody who comes over; assumed. [m/s^2]
const HURRY_MPS2: f64 = 2.0;

/// Braking in an emergency goes on until what is left asks for no more than this; assumed. [m/s^2]
const RELAXED_MPS2: f64 = 1.0;

/// Slower than this along the road, somebody beside it is taken for who walks across. [m/s]
const ON_FOOT_MPS: f64 = 3.0;

/// On whose way people walk or drift: they must have left it this long before it comes, or not enter it before this long
/// after it has gone. [s]
const ON_FOOT_BEFORE_S: f64 = 0.5;
const ON_FOOT_AFTER_S: f64 = 1.0;

/// Two who would miss each other at a crossing by less than this are on a collision course. [s]
const COLLISION_COURSE_S: f64 = 0.3;

/// Somebody's speed in predictions, at least; and the acceleration that is allowed for, as `idm`. [m/s, m/s^2]
const SLOWEST_MPS: f64 = 0.5;
const ALLOWED_FOR_MPS2: f64 = 1.0;

/// Faster than this somebody drives across, and will not stay in the way. [m/s]
const DRIVING_ACROSS_MPS: f64 = 1.0;

/// This far into a crossing it still makes sense to stop; assumed. [m]
const STOP_SHORT_M: f64 = 2.0;

/// Who has stood this long will go on standing, and is driven around; assumed. [steps]
const PARKED_STEPS: u16 = 50;
const PARKED_MPS: f64 = 0.05;

/// It stops this much further behind what stands, so that it can still steer around it; assumed. [m]
const PULL_OUT_M: f64 = 6.0;

/// What it keeps in mind about another road user.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Attention {
    /// Steps since he began to matter.
    noticed: u16,
    /// Steps since he became a danger.
    danger: u16,
    /// Steps for which he has been coming over from beside.
    beside: u16,
    /// It has to draw ahead of him.
    hurry: bool,
    /// Steps he has stood.
    standing: u16,
    /// His speed a step ago. [m/s]
    speed_mps: f64,
}

/// Somebody or something it would run into.
#[derive(Debug, Clone, Copy)]
struct Encounter {
    /// Bumper to bumper. [m]
    gap_m: f64,
    /// Speed of the other along the way. [m/s]
    lead_mps: f64,
    /// Speed by which the gap shrinks. [m/s]
    closing_mps: f64,
}

impl Encounter {
    /// Deceleration that just avoids contact. [m/s^2]
    fn required_mps2(&self) -> f64 {
        math::sq(self.closing_mps.max(0.0)) / (2.0 * self.gap_m.max(0.1))
    }

    /// The same, with room left to pull out.
    fn with_room_to_pull_out(self) -> Self {
        Self { gap_m: (self.gap_m - PULL_OUT_M).max(0.1), ..self }
    }
}

/// What somebody else, and the line before his way, ask for.
struct Demand {
    /// The acceleration in comfort. [m/s^2]
    asked_mps2: f64,
    /// The deceleration without which the two touch. [m/s^2]
    required_mps2: f64,
    /// Whether it is an emergency.
    danger: bool,
}

/// On which end of it somebody beside it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Beside {
    Ahead,
    Behind,
}

/// The state of one such driver.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reference {
    parameters: IdmParameters,
    response: EmergencyResponse,
    comfortable_mps2: f64,
    regaining_mps2: f64,
    keeper: LaneKeeper,
    give_way: GiveWay,
    swerve: Swerve,
    full_throttle_mps2: f64,
    full_brake_mps2: f64,
}

impl Reference {
    pub(crate) fn new(spec: &VehicleSpec, target_mps: f64, surface: Surface) -> Self {
        let friction = surface.relative_friction();
        let parameters = IdmParameters {
            time_headway_s: TIME_HEADWAY_S,
            hardest_deceleration_mps2: COMFORTABLE_MPS2 * friction,
            curve_mps2: CURVE_MPS2 * friction,
            ..IdmParameters::town(target_mps)
        };
        Self {
            parameters,
            response: EmergencyResponse::UN_R157.on(friction),
            comfortable_mps2: COMFORTABLE_MPS2 * friction,
            regaining_mps2: REGAINING_MPS2 * friction,
            keeper: LaneKeeper::new(),
            give_way: GiveWay::default(),
            swerve: Swerve::default(),
            full_throttle_mps2: spec.max_acceleration_mps2,
            full_brake_mps2: spec.brake_demand_mps2,
        }
    }

    /// The hardest that it brakes on this surface. [m/s^2]
    pub(crate) fn hardest_mps2(&self) -> f64 {
        self.response.deceleration_mps2
    }

    pub(crate) fn decide(
        &mut self,
        scene: &Scene<'_>,
        me: usize,
        crossings: &[Crossing],
        attention: &mut [Attention],
    ) -> Controls {
        let seen = &scene.actors[me];
        let lane = scene.lanes.lane(scene.path_lane(me));
        for (mind, actor) in attention.iter_mut().zip(scene.actors) {
            mind.standing = if actor.speed < PARKED_MPS { mind.standing.saturating_add(1) } else { 0 };
        }
        let remembered: &[Attention] = attention;
        self.swerve.plan(scene, me, |other| remembered[other].standing >= PARKED_STEPS);
        self.give_way.count_standing(scene, me);

        let own_t = lane.local(seen.pose.position).1;
        let free = self.parameters.acceleration(seen.speed, None).max(-self.comfortable_mps2);
        let alone = free.min(curve_limit(&self.parameters, scene, me));
        let mut acceleration = alone;
        for obstacle in scene.obstacles {
            let outline = &obstacle.outline;
            let body = Body { axis: outline.axis, half_length: outline.half_length, half_width: outline.half_width };
            if let Some(view) = self.view(scene, me, own_t, outline.centre, &body)
                && view.side_m < 0.0
            {
                let standing = Encounter { gap_m: view.gap_m, lead_mps: 0.0, closing_mps: seen.speed };
                acceleration = acceleration.min(self.comfortable(seen.speed, &standing.with_room_to_pull_out()));
            }
        }
        for (other, mind) in attention.iter_mut().enumerate() {
            if other != me && scene.actors[other].present {
                acceleration = acceleration.min(self.react(scene, me, other, crossings, own_t, mind));
            }
            mind.speed_mps = scene.actors[other].speed;
        }
        // Nobody is in its way, and somebody beside needs the place.
        if acceleration == alone && attention.iter().any(|mind| mind.hurry) {
            acceleration = alone.max(HURRY_MPS2);
        }
        acceleration = acceleration.max(-self.hardest_mps2());
        let full = if acceleration >= 0.0 { self.full_throttle_mps2 } else { self.full_brake_mps2 };
        let (line, drift) = self.swerve.line(seen.speed);
        Controls {
            steer: self.keeper.steer(lane, seen.pose, line + scene.ego_beside_m, drift),
            throttle: acceleration / full.max(1e-3),
        }
        .clipped()
    }

    /// The acceleration that one other road user asks for, or nothing special. [m/s^2]
    fn react(
        &self,
        scene: &Scene<'_>,
        me: usize,
        other: usize,
        crossings: &[Crossing],
        own_t: f64,
        mind: &mut Attention,
    ) -> f64 {
        let (seen, actor) = (&scene.actors[me], &scene.actors[other]);
        mind.hurry = false;
        if let Some(side) = self.beside(scene, me, other, own_t) {
            mind.beside = mind.beside.saturating_add(1);
            return self.make_room(side, mind);
        }
        mind.beside = 0;
        let encounter = self.encounter(scene, me, other, crossings, own_t);
        let wanted = self.parameters.desired_speed_mps;
        let manners = Manners { gap_s: CROSSING_GAP_S };
        let lines = self.give_way.stop_lines(scene, me, crossings, wanted, manners);
        let line = lines.filter(|(crossing, _)| crossing.other == other).min_by(|a, b| a.1.total_cmp(&b.1));

        // Who is there when the scenario begins has been seen before.
        let known = ((self.response.onset_s() + self.response.ramp_s) / STEP_S).ceil() as u16 + 1;
        mind.noticed = match (encounter.is_some() || line.is_some(), scene.step) {
            (true, 0) => known,
            (true, _) => mind.noticed.saturating_add(1),
            (false, _) => mind.noticed.min(known).saturating_sub(1),
        };
        let mut demand = self.demand(scene, seen, actor, encounter.as_ref(), line, mind);
        if mind.danger > 0 && entering(scene, me, other, crossings) {
            // An emergency stop is carried through, even where its front is on the crossing already.
            demand.required_mps2 = demand.required_mps2.max(self.comfortable_mps2);
        }
        let goes_on = mind.danger > 0 && demand.required_mps2 > RELAXED_MPS2;
        mind.danger = match (demand.danger || goes_on, scene.step) {
            (true, 0) => known,
            (true, _) => mind.danger.saturating_add(1),
            (false, _) => 0,
        };
        self.respond(&demand, mind)
    }

    /// What somebody ahead asks for, and a line to stop at before his way.
    fn demand(
        &self,
        scene: &Scene<'_>,
        seen: &Seen,
        actor: &Seen,
        ahead: Option<&Encounter>,
        line: Option<(&Crossing, f64)>,
        mind: &Attention,
    ) -> Demand {
        let braking_mps2 = if scene.step > 0 { (mind.speed_mps - actor.speed) / STEP_S } else { 0.0 };
        let mut demand = Demand { asked_mps2: f64::INFINITY, required_mps2: 0.0, danger: false };
        if let Some(ahead) = ahead {
            let ttc = if ahead.closing_mps > 0.0 { ahead.gap_m / ahead.closing_mps } else { f64::INFINITY };
            let brakes_hard = braking_mps2 > DANGEROUS_BRAKING_MPS2 && ahead.gap_m < TIME_HEADWAY_S * seen.speed;
            demand.danger |= ttc < DANGEROUS_TTC_S || ahead.required_mps2() > self.comfortable_mps2 || brakes_hard;
            demand.required_mps2 = demand.required_mps2.max(ahead.required_mps2());
            let ahead = if mind.standing >= PARKED_STEPS { &ahead.with_room_to_pull_out() } else { ahead };
            demand.asked_mps2 = demand.asked_mps2.min(self.comfortable(seen.speed, ahead));
        }
        if let Some((crossing, distance)) = line {
            // It stops its usual room in front of the line; past that it still may stop at the line.
            let stop = Encounter { gap_m: distance.max(0.1), lead_mps: 0.0, closing_mps: seen.speed };
            let hard = stop.required_mps2();
            demand.danger |= hard > self.comfortable_mps2 && collision_course(scene, crossing, braking_mps2);
            demand.required_mps2 = demand.required_mps2.max(hard);
            demand.asked_mps2 = demand.asked_mps2.min(self.comfortable(seen.speed, &stop));
        }
        demand
    }

    /// The acceleration that follows a demand, as long as it has been noticed, or has been a danger. [m/s^2]
    fn respond(&self, demand: &Demand, mind: &Attention) -> f64 {
        // The foot is on the brake from the onset on, and comes down at the same rate as in an emergency.
        let noticed_s = (f64::from(mind.noticed) - 0.5) * STEP_S;
        let foot = self.response.deceleration(noticed_s);
        let mut acceleration =
            if noticed_s > self.response.onset_s() { demand.asked_mps2.max(-foot) } else { f64::INFINITY };
        if mind.danger > 0 {
            // The deceleration in the middle of the step for which it is held.
            let since_s = (f64::from(mind.danger) - 0.5) * STEP_S;
            if since_s > self.response.evaluation_s {
                acceleration = acceleration.min(0.0);
            }
            if demand.required_mps2 > RELAXED_MPS2 {
                acceleration = acceleration.min(-self.response.deceleration(since_s));
            }
        }
        acceleration
    }

    /// Where somebody beside, on the same way, comes over: on which end he is.
    fn beside(&self, scene: &Scene<'_>, me: usize, other: usize, own_t: f64) -> Option<Beside> {
        let (seen, actor) = (&scene.actors[me], &scene.actors[other]);
        let ahead = (actor.pose.position - seen.pose.position).dot(seen.forward);
        if ahead.abs() > seen.half_length + actor.half_length || actor.forward.dot(seen.forward) < 0.5 {
            return None;
        }
        let lane = scene.lanes.lane(scene.path_lane(me));
        let (s, t) = lane.local(actor.pose.position);
        let offset = t - own_t;
        let coming = -actor.velocity.dot(-Vec2::from_heading(lane.heading(s)).left()) * offset.signum();
        let side = offset.abs() - seen.half_width - actor.half_width;
        let leaves_his_lane = -actor.place.t * offset.signum() > WANDERING_M;
        (leaves_his_lane && coming > DRIFT_MPS && side < BESIDE_M).then_some(if ahead > -BEHIND_M {
            Beside::Ahead
        } else {
            Beside::Behind
        })
    }

    /// Lets somebody in who is coming over: falls back behind him, or draws ahead of him. [m/s^2]
    fn make_room(&self, side: Beside, mind: &mut Attention) -> f64 {
        let since_s = (f64::from(mind.beside) - 0.5) * STEP_S;
        mind.hurry = side == Beside::Behind && since_s > self.response.onset_s();
        let falls_back = side == Beside::Ahead && since_s > self.response.evaluation_s;
        if falls_back { -self.response.deceleration(since_s) } else { f64::INFINITY }
    }

    /// The law of `idm`, with comfortable braking. [m/s^2]
    fn comfortable(&self, speed_mps: f64, ahead: &Encounter) -> f64 {
        let least = if ahead.closing_mps > 0.0 { self.comfortable_mps2 } else { self.regaining_mps2 };
        self.parameters.acceleration(speed_mps, Some((ahead.gap_m, ahead.lead_mps))).max(-least)
    }

    /// Whether, and how, another road user is or will be in the way.
    fn encounter(
        &self,
        scene: &Scene<'_>,
        me: usize,
        other: usize,
        crossings: &[Crossing],
        own_t: f64,
    ) -> Option<Encounter> {
        let (seen, actor) = (&scene.actors[me], &scene.actors[other]);
        let body = Body { axis: actor.forward, half_length: actor.half_length, half_width: actor.half_width };
        let view = self.view(scene, me, own_t, actor.pose.position, &body)?;
        let along = actor.velocity.dot(view.forward);
        let crosses = crossings.iter().any(|crossing| crossing.me == me && crossing.other == other);
        let same_way = actor.forward.dot(view.forward) > 0.5;
        // Who drives across is a matter of who goes first.
        if crosses && !same_way && actor.speed > DRIVING_ACROSS_MPS {
            return None;
        }
        let in_front = Encounter { gap_m: view.gap_m, lead_mps: along.max(0.0), closing_mps: seen.speed - along };
        if view.side_m < 0.0 {
            return Some(in_front);
        }
        // How fast he comes nearer from the side.
        let coming = -actor.velocity.dot(-view.forward.left()) * view.offset_m.signum();
        if coming < DRIFT_MPS {
            return None;
        }
        if same_way && along > ON_FOOT_MPS {
            let from_centre = -actor.place.t * view.offset_m.signum();
            return (from_centre > WANDERING_M && view.side_m < BESIDE_M).then_some(in_front);
        }
        if crosses {
            return None;
        }
        let (enters, leaves) = (view.side_m / coming, (view.side_m + view.strip_m) / coming);
        let speed = seen.speed.max(0.5 * self.parameters.desired_speed_mps).max(1.0);
        let (arrive, gone) = (view.gap_m / speed, (view.gap_m + view.length_m) / speed);
        let meet = enters < gone + ON_FOOT_AFTER_S && arrive < leaves + ON_FOOT_BEFORE_S;
        meet.then_some(Encounter { gap_m: view.gap_m, lead_mps: 0.0, closing_mps: seen.speed })
    }

    /// Where a body is relative to the strip of road that it is going to drive; `None` behind it and out of sight.
    fn view(&self, scene: &Scene<'_>, me: usize, own_t: f64, position: Vec2, body: &Body) -> Option<View> {
        let seen = &scene.actors[me];
        if (position - seen.pose.position).length_squared() > SIGHT_M * SIGHT_M {
            return None;
        }
        let (distance, t, forward) = scene.ahead(me, position, SIGHT_M)?;
        if distance <= 0.0 {
            return None;
        }
        let (lengthways, sideways) = (body.axis.dot(forward).abs(), body.axis.cross(forward).abs());
        let half_across = body.half_length * sideways + body.half_width * lengthways;
        let half_along = body.half_length * lengthways + body.half_width * sideways;
        let gap_m = (distance - seen.half_length - half_along).max(0.1);
        let offset_m = t - self.swerve.expected(own_t, gap_m, seen.speed);
        let half_strip = half_across + seen.half_width + SIDE_ROOM_M;
        Some(View {
            gap_m,
            offset_m,
            side_m: offset_m.abs() - half_strip,
            strip_m: 2.0 * half_strip,
            length_m: 2.0 * (seen.half_length + half_along),
            forward,
        })
    }
}

/// A box, without its place.
struct Body {
    axis: Vec2,
    half_length: f64,
    half_width: f64,
}

/// Something seen from the driver's seat.
struct View {
    /// Bumper to bumper. [m]
    gap_m: f64,
    /// From the line it is going to drive, to the right. [m]
    offset_m: f64,
    /// Between the two sides, the wanted room taken off; negative in its way. [m]
    side_m: f64,
    /// How far somebody has to go sideways from the beginning to the end of being in its way. [m]
    strip_m: f64,
    /// How far it drives from reaching him to having passed him. [m]
    length_m: f64,
    /// The way's direction there.
    forward: Vec2,
}

/// Whether two would be on their crossing at the same time: this one at its speed, the other at his, or faster by what he
/// may be seen to accelerate.
fn collision_course(scene: &Scene<'_>, crossing: &Crossing, braking_mps2: f64) -> bool {
    let (me, other) = (&scene.actors[crossing.me], &scene.actors[crossing.other]);
    let (s, other_s) = (scene.path_s(crossing.me), scene.path_s(crossing.other));
    let (speed, other_speed) = (me.speed.max(SLOWEST_MPS), other.speed.max(SLOWEST_MPS));
    let (arrives, is_gone) = ((crossing.mine.from - s) / speed, (end(crossing, crossing.mine) - s) / speed);
    let acceleration = (-braking_mps2).max(ALLOWED_FOR_MPS2);
    let way = (crossing.theirs.from - other_s).max(0.0);
    let comes = ((math::sq(other_speed) + 2.0 * acceleration * way).sqrt() - other_speed) / acceleration;
    let leaves = (end(crossing, crossing.theirs) - other_s) / other_speed;
    arrives < leaves + COLLISION_COURSE_S && comes < is_gone + COLLISION_COURSE_S
}

/// Where a crossing ends on one of its paths; where the paths merge, from there on one simply follows the other. [m]
fn end(crossing: &Crossing, stretch: Stretch) -> f64 {
    if crossing.merges { stretch.from + MERGED_M } else { stretch.to }
}

/// Whether it is at the beginning of a crossing that somebody else is coming to.
fn entering(scene: &Scene<'_>, me: usize, other: usize, crossings: &[Crossing]) -> bool {
    let (s, other_s) = (scene.path_s(me), scene.path_s(other));
    let mut mutual = crossings.iter().filter(|crossing| crossing.me == me && crossing.other == other);
    mutual.any(|crossing| {
        (crossing.mine.from..crossing.mine.from + STOP_SHORT_M).contains(&s)
            && other_s < end(crossing, crossing.theirs)
            && scene.actors[other].speed > SLOWEST_MPS
            && collision_course(scene, crossing, 0.0)
    })
}
