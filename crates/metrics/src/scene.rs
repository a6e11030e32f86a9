//! A rollout made ready for measuring: boxes per step, the window that counts, and positions along the ego's way.

use crate::swept::time_to_collision;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::math;
use recrash_model::rollout::{ActorState, Rollout, STEP_S};
use recrash_model::scenario::{Device, MissionStop};
use recrash_model::surroundings::Surface;
use recrash_roads::path::SegmentShape;
use recrash_roads::{LanePath, PathPoint, RoadNetwork, Scenario};
use std::ops::Range;

/// Slower than this the ego stands, and its jitter is no oscillation. [m/s] (full brakes make MetaDrive vehicles jitter by 0.24 m/s)
pub const STANDSTILL_MPS: f64 = 0.3;

/// Who drives a run that shows the record alone: nothing is handed over in it.
const RECORDED: &str = "recorded";

/// The way the ego was to take, how fast, where it was to stop, and from when on it is tested.
#[derive(Debug, Clone)]
pub struct EgoWay<'a> {
    /// Roads.
    pub network: &'a RoadNetwork,
    /// Its lanes.
    pub path: &'a LanePath,
    /// Speed it wants. [m/s]
    pub target_speed_mps: f64,
    /// Stop lines on the path: where the ego's centre is when its front is there, and what stands there. [m]
    pub lines: Vec<(f64, &'a Device)>,
    /// Stops of its task.
    pub stops: &'a [MissionStop],
    /// When the system under test takes over from the recorded driver; 0 where it drives from the beginning. [s]
    pub handover_s: f64,
    /// What the road is like.
    pub surface: Surface,
}

impl<'a> EgoWay<'a> {
    /// The ego's way in a scenario.
    pub fn of(scenario: &'a Scenario) -> Self {
        let draft = scenario.draft();
        let lines = scenario.ego_stop_lines().map(|line| (line.at_m, &draft.control[line.control].device));
        Self {
            lines: lines.collect(),
            stops: &draft.ego.stops,
            handover_s: draft.ego.handover_s.unwrap_or(0.0),
            surface: draft.environment.surface,
            ..Self::plain(scenario.network(), &scenario.ego().path, draft.ego.target_speed_mps)
        }
    }

    /// A way without a place to stop, driven by one driver.
    pub fn plain(network: &'a RoadNetwork, path: &'a LanePath, target_speed_mps: f64) -> Self {
        Self { network, path, target_speed_mps, lines: Vec::new(), stops: &[], handover_s: 0.0, surface: Surface::Dry }
    }
}

/// The first step that counts: the handover's, but the first of all where the recorded driver drives to the end.
pub fn first_step(rollout: &Rollout, handover_s: f64) -> usize {
    if rollout.ego == RECORDED { 0 } else { (handover_s / STEP_S).round() as usize }
}

/// The ego's first contact with a road user.
#[derive(Debug, Clone, Copy)]
pub struct FirstContact {
    /// The other's position in [`Rollout::actors`].
    pub actor: usize,
    /// When. [s]
    pub time_s: f64,
    /// The ego.
    pub ego: ActorState,
    /// The other.
    pub other: ActorState,
}

/// A rollout, its boxes, and the steps that count: those with finite states from the handover up to the ego's first contact.
/// What the recorded driver did before is not the system's; what a simulator makes of vehicles after they touched is not
/// measured.
#[derive(Debug)]
pub struct Scene<'a> {
    /// The rollout.
    pub rollout: &'a Rollout,
    /// The first step that counts.
    pub first: usize,
    /// Per actor, its boxes from the beginning up to the last step that counts.
    pub outlines: Vec<Vec<OrientedBox>>,
    /// Boxes of the obstacles.
    pub obstacles: Vec<OrientedBox>,
    /// First contact.
    pub contact: Option<FirstContact>,
    /// End of the measured window. [s]
    pub end_s: f64,
}

impl<'a> Scene<'a> {
    /// Makes a rollout ready. Never fails: a rollout without actors gives a scene without boxes.
    pub fn new(rollout: &'a Rollout, handover_s: f64) -> Self {
        let contact = rollout
            .first_ego_contact()
            .filter(|&(actor, ..)| actor > 0 && actor < rollout.actors.len())
            .map(|(actor, time_s, ego, other)| FirstContact { actor, time_s, ego, other });
        // A state recorded at the instant of the contact still counts; the tolerance is for the rounding of k * 0.1.
        let last_s = contact.map_or(f64::INFINITY, |contact| contact.time_s + 1e-9);
        let outlines: Vec<Vec<OrientedBox>> = rollout
            .actors
            .iter()
            .map(|track| {
                let counts = |&(step, state): &(usize, &ActorState)| time_of(step) <= last_s && state.is_finite();
                track.states.iter().enumerate().take_while(counts).map(|(step, _)| track.outline(step)).collect()
            })
            .collect();
        let recorded = outlines.first().map_or(0, Vec::len);
        let end_s = contact.map_or(time_of(recorded.saturating_sub(1)), |contact| contact.time_s);
        let obstacles = rollout.obstacles.iter().map(|obstacle| obstacle.outline()).collect();
        Self { rollout, first: first_step(rollout, handover_s), outlines, obstacles, contact, end_s }
    }

    /// The steps that count for the ego.
    pub fn counted(&self) -> Range<usize> {
        self.first.min(self.steps())..self.steps()
    }

    /// The steps at which an actor is in the world, up to the last that counts.
    pub fn present(&self, actor: usize) -> Range<usize> {
        let last = self.outlines.get(actor).map_or(0, Vec::len);
        let is_present = |step: &usize| self.rollout.actors[actor].is_present(*step);
        let first = (0..last).find(is_present).unwrap_or(last);
        first..(first..last).find(|step| !is_present(step)).unwrap_or(last)
    }

    /// The steps that count for the ego at which an actor is in the world.
    pub fn counted_with(&self, actor: usize) -> Range<usize> {
        let (counted, present) = (self.counted(), self.present(actor));
        counted.start.max(present.start)..counted.end.min(present.end)
    }

    /// The ego's boxes at the steps that count, each with its step.
    pub fn ego(&self) -> impl Iterator<Item = (usize, &OrientedBox)> {
        let outlines = self.outlines.first().map_or(&[][..], Vec::as_slice);
        outlines.iter().enumerate().skip(self.first)
    }

    /// Number of steps up to the last that counts, for the ego and an actor together.
    pub fn steps_with(&self, actor: usize) -> usize {
        self.steps().min(self.outlines.get(actor).map_or(0, Vec::len))
    }

    /// Number of steps up to the last that counts for the ego.
    pub fn steps(&self) -> usize {
        self.outlines.first().map_or(0, Vec::len)
    }

    /// State of an actor at a step that counts.
    pub fn state(&self, actor: usize, step: usize) -> &ActorState {
        &self.rollout.actors[actor].states[step]
    }

    /// Velocity of an actor's centre over ground. [m/s]
    pub fn velocity(&self, actor: usize, step: usize) -> Vec2 {
        self.state(actor, step).velocity()
    }

    /// Speed of an actor along its heading. [m/s]
    pub fn speed(&self, actor: usize, step: usize) -> f64 {
        self.state(actor, step).velocity().dot(self.outlines[actor][step].axis)
    }

    /// Longitudinal acceleration of an actor over the step that begins at `step`; over the last one, that of the one
    /// before; nil with a single state. [m/s^2]
    pub fn acceleration(&self, actor: usize, step: usize) -> f64 {
        let count = self.outlines[actor].len();
        if count < 2 {
            return 0.0;
        }
        let from = step.min(count - 2);
        (self.speed(actor, from + 1) - self.speed(actor, from)) / STEP_S
    }

    /// Boxes of an actor and its contact state, where the first contact is with it, at that instant.
    pub fn contact_boxes(&self) -> Option<(FirstContact, OrientedBox, OrientedBox)> {
        let contact = self.contact?;
        let (ego, other) = (&self.rollout.actors[0], &self.rollout.actors[contact.actor]);
        Some((
            contact,
            OrientedBox::new(contact.ego.pose(), ego.length_m, ego.width_m),
            OrientedBox::new(contact.other.pose(), other.length_m, other.width_m),
        ))
    }
}

/// An actor and its parts: a gap to one is a gap to the nearest of them.
pub(crate) fn with_parts(rollout: &Rollout, actor: usize) -> Vec<usize> {
    let parts = (0..rollout.actors.len()).filter(|&part| rollout.actors[part].part_of == Some(actor));
    std::iter::once(actor).chain(parts).collect()
}

/// Least gap between the boxes of two, each given with its parts, at a step; infinite where one has no state then. [m]
pub(crate) fn gap_at(rollout: &Rollout, (mine, theirs): (&[usize], &[usize]), step: usize) -> f64 {
    // Parts of who is not in the world are where it will be.
    let in_world = |of: &[usize]| if rollout.actors[of[0]].is_present(step) { of.len() } else { 1 };
    let outlines = |of: &[usize]| -> Vec<OrientedBox> {
        let tracks = of[..in_world(of)].iter().map(|&actor| &rollout.actors[actor]);
        tracks.filter(|track| step < track.states.len()).map(|track| track.outline(step)).collect()
    };
    let (mine, theirs) = (outlines(mine), outlines(theirs));
    let gaps = mine.iter().flat_map(|own| theirs.iter().map(|other| own.gap(other)));
    gaps.fold(f64::INFINITY, f64::min)
}

/// Time of a step. [s]
#[inline]
pub fn time_of(step: usize) -> f64 {
    step as f64 * STEP_S
}

/// Unit vector along the way at a point of it.
fn forward_at(way: &EgoWay<'_>, point: Vec2, place: PathPoint) -> Vec2 {
    let segment = &way.path.segments[place.segment];
    match segment.shape {
        SegmentShape::Straight { forward, .. } => forward,
        // Across the radius: no angle is needed.
        SegmentShape::Arc { centre, turn, .. } if (0.0..=segment.length_m).contains(&(place.s - segment.start_m)) => {
            let outward = point - centre;
            let length = outward.length();
            if length > 1e-9 { outward.left() * (turn / length) } else { outward }
        }
        SegmentShape::Arc { .. } => Vec2::from_heading(way.path.pose(place.s, 0.0).heading),
    }
}

/// A box in the coordinates of the ego's way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Along {
    /// Centre along the way. [m]
    pub s: f64,
    /// Centre to the right of the way. [m]
    pub t: f64,
    /// Segment of the way.
    pub segment: usize,
    /// Cosine of the heading relative to the way.
    pub cos: f64,
    /// Unit vector of the way there.
    pub forward: Vec2,
    /// The box with the way straightened: x along it, y to its left.
    pub outline: OrientedBox,
    /// Half of the extent along the way. [m]
    pub half_along: f64,
    /// Half of the extent across it. [m]
    pub half_across: f64,
}

impl Along {
    /// A box on a way, looked for from segment `hint` on.
    pub fn of(way: &EgoWay<'_>, outline: &OrientedBox, hint: usize) -> Self {
        let place = way.path.project(outline.centre, hint);
        let forward = forward_at(way, outline.centre, place);
        let (cos, turned) = (outline.axis.dot(forward), forward.cross(outline.axis));
        let sin = turned.abs();
        Self {
            s: place.s,
            t: place.t,
            segment: place.segment,
            cos,
            forward,
            outline: OrientedBox { centre: Vec2::new(place.s, -place.t), axis: Vec2::new(cos, turned), ..*outline },
            half_along: outline.half_length * cos.abs() + outline.half_width * sin,
            half_across: outline.half_length * sin + outline.half_width * cos.abs(),
        }
    }

    /// The ego along its way, step by step.
    pub fn track(way: &EgoWay<'_>, outlines: &[OrientedBox]) -> Vec<Self> {
        let mut segment = 0;
        outlines
            .iter()
            .map(|outline| {
                let along = Self::of(way, outline, segment);
                segment = along.segment;
                along
            })
            .collect()
    }

    /// Free space along the way from this box's front to the rear of `other`, where `other` is ahead and its extent
    /// across comes within `margin_m` of this one's. [m]
    pub fn free_space_to(&self, other: &Self, margin_m: f64) -> Option<f64> {
        if (other.t - self.t).abs() >= self.half_across + other.half_across + margin_m {
            return None;
        }
        let free = other.s - self.s - other.half_along - self.half_along;
        (free > 0.0).then_some(free)
    }

    /// How far this box goes along the way until it touches `other`, both turned as they are; `None` where it never does, or
    /// does already. [m]
    pub fn way_to_contact(&self, other: &Self) -> Option<f64> {
        // The time to collision at 1 m/s is the distance.
        let way = time_to_collision(&self.outline, Vec2::new(1.0, 0.0), &other.outline, Vec2::default());
        way.filter(|&way| way > 0.0)
    }

    /// Whether the box drives within 45 degrees of the way.
    pub fn goes_along(&self) -> bool {
        self.cos > math::cos(math::PI / 4.0)
    }
}
