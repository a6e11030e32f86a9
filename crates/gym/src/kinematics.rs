//! What stands around the ego, as numbers from -1 to 1: the ego, its route, what controls traffic, its task, and the nearest
//! others.

use crate::scene::Scene;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::rollout::ActorState;
use recrash_model::scenario::Aspect;
use recrash_sim::Observation;

/// Most neighbours of a view.
pub const MOST_NEIGHBOURS: usize = 32;

/// One number of an observation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    /// Name.
    pub name: &'static str,
    /// Unit before it was divided.
    pub unit: &'static str,
    /// What it was divided by. What is beyond -1 and 1 then is cut.
    pub scale: f64,
}

const fn field(name: &'static str, unit: &'static str, scale: f64) -> Field {
    Field { name, unit, scale }
}

/// Places ahead on the route that are shown. [m]
const AHEAD_M: [f64; 4] = [5.0, 10.0, 20.0, 40.0];

/// About the ego, its route, control and task: there in every observation.
pub const FIELDS_ALWAYS: [Field; 31] = [
    field("speed", "m/s", 30.0),
    field("sideways_speed", "m/s", 5.0),
    field("steer", "1", 1.0),
    field("throttle", "1", 1.0),
    field("target_speed", "m/s", 30.0),
    field("grip", "1", 1.0),
    field("time_left", "s", 120.0),
    field("route_right", "m", 5.0),
    field("route_cos", "1", 1.0),
    field("route_sin", "1", 1.0),
    field("route_left_to_go", "m", 200.0),
    field("route_5_x", "m", 50.0),
    field("route_5_y", "m", 50.0),
    field("route_10_x", "m", 50.0),
    field("route_10_y", "m", 50.0),
    field("route_20_x", "m", 50.0),
    field("route_20_y", "m", 50.0),
    field("route_40_x", "m", 50.0),
    field("route_40_y", "m", 50.0),
    field("line_there", "1", 1.0),
    field("line_distance", "m", 100.0),
    field("line_green", "1", 1.0),
    field("line_yellow", "1", 1.0),
    field("line_red", "1", 1.0),
    field("line_flashing_red", "1", 1.0),
    field("line_dark", "1", 1.0),
    field("line_sign", "1", 1.0),
    field("stop_there", "1", 1.0),
    field("stop_distance", "m", 100.0),
    field("stop_right", "m", 5.0),
    field("stop_duration", "s", 120.0),
];

/// About each of the nearest others, in the ego's frame: x forward, y left.
pub const FIELDS_OF_OTHER: [Field; 9] = [
    field("there", "1", 1.0),
    field("x", "m", 100.0),
    field("y", "m", 100.0),
    field("relative_vx", "m/s", 30.0),
    field("relative_vy", "m/s", 30.0),
    field("heading_cos", "1", 1.0),
    field("heading_sin", "1", 1.0),
    field("length", "m", 20.0),
    field("width", "m", 5.0),
];

/// Somebody or something that the ego sees.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Thing {
    pub(crate) outline: OrientedBox,
    pub(crate) velocity: Vec2,
}

/// The frame of the ego: its place, its direction, its velocity.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EgoFrame {
    position: Vec2,
    forward: Vec2,
    velocity: Vec2,
}

impl EgoFrame {
    pub(crate) fn of(observation: &Observation<'_>) -> Self {
        let ego = &observation.states[0];
        Self { position: ego.position(), forward: observation.forward(0), velocity: ego.velocity() }
    }

    /// A direction as the ego sees it.
    #[inline]
    pub(crate) fn turned(&self, vector: Vec2) -> Vec2 {
        Vec2::new(self.forward.dot(vector), self.forward.cross(vector))
    }

    /// A place as the ego sees it.
    #[inline]
    pub(crate) fn seen(&self, point: Vec2) -> Vec2 {
        self.turned(point - self.position)
    }

    /// A velocity relative to the ego's, as the ego sees it.
    #[inline]
    pub(crate) fn relative(&self, velocity: Vec2) -> Vec2 {
        self.turned(velocity - self.velocity)
    }
}

/// Calls `with` for everybody and everything but the ego that is in the world, with a lower bound of its distance. [m]
pub(crate) fn others(scene: &Scene, observation: &Observation<'_>, mut with: impl FnMut(f64, u16)) {
    let ego = observation.states[0].position();
    for (actor, outline) in scene.outlines.iter().enumerate().skip(1) {
        let present = outline.owner.map_or(actor, usize::from);
        if outline.owner != Some(0) && observation.is_present(present) && observation.is_present(actor) {
            with(observation.states[actor].position().distance(ego) - outline.radius_m, actor as u16);
        }
    }
    let actors = scene.outlines.len() as u16;
    for (number, outline) in scene.obstacles.iter().enumerate() {
        with(outline.centre.distance(ego) - outline.radius(), actors + number as u16);
    }
}

/// What [`others`] has named.
pub(crate) fn thing(scene: &Scene, observation: &Observation<'_>, number: u16) -> Thing {
    let number = usize::from(number);
    if let Some(obstacle) = number.checked_sub(scene.outlines.len()) {
        return Thing { outline: scene.obstacles[obstacle], velocity: Vec2::default() };
    }
    let (state, size): (&ActorState, _) = (&observation.states[number], &scene.outlines[number]);
    let outline = OrientedBox {
        centre: state.position(),
        axis: observation.forward(number),
        half_length: 0.5 * size.length_m,
        half_width: 0.5 * size.width_m,
    };
    Thing { outline, velocity: state.velocity() }
}

/// Writes numbers one after the other, each divided by its scale and cut to -1 and 1.
struct Pen<'a> {
    out: &'a mut [f32],
    fields: &'static [Field],
    at: usize,
}

impl<'a> Pen<'a> {
    fn new(out: &'a mut [f32], fields: &'static [Field]) -> Self {
        Self { out, fields, at: 0 }
    }

    #[inline]
    fn put(&mut self, value: f64) {
        self.out[self.at] = (value / self.fields[self.at].scale).clamp(-1.0, 1.0) as f32;
        self.at += 1;
    }

    fn put_all(&mut self, values: impl IntoIterator<Item = f64>) {
        values.into_iter().for_each(|value| self.put(value));
    }
}

/// Writes [`FIELDS_ALWAYS`].
pub(crate) fn write_always(scene: &Scene, observation: &Observation<'_>, frame: &EgoFrame, out: &mut [f32]) {
    let (draft, ego) = (scene.scenario.draft(), &observation.states[0]);
    let own = frame.turned(frame.velocity);
    let (_, direction) = scene.way.at(observation.route_s_m);
    let direction = frame.turned(direction);
    let mut pen = Pen::new(out, &FIELDS_ALWAYS);
    pen.put_all([own.x, own.y, ego.steer, ego.throttle, draft.ego.target_speed_mps]);
    pen.put_all([draft.environment.surface.relative_friction(), draft.duration_s - observation.time_s]);
    pen.put_all([observation.route_t_m, direction.x, direction.y, scene.way.length_m - observation.route_s_m]);
    for ahead_m in AHEAD_M {
        let point = frame.seen(scene.way.at(observation.route_s_m + ahead_m).0);
        pen.put_all([point.x, point.y]);
    }
    let next = observation.lines.iter().filter(|line| line.at_m > observation.route_s_m);
    match next.min_by(|a, b| a.at_m.total_cmp(&b.at_m)) {
        None => pen.put_all([0.0; 8]),
        Some(line) => {
            let shows = observation.signals.get(line.control).copied().flatten();
            let lit = |aspect: Option<Aspect>| if shows == aspect { 1.0 } else { 0.0 };
            pen.put_all([1.0, line.at_m - observation.route_s_m]);
            pen.put_all(
                [Aspect::Green, Aspect::Yellow, Aspect::Red, Aspect::FlashingRed, Aspect::Dark].map(Some).map(lit),
            );
            pen.put(lit(None));
        }
    }
    match observation.stops.first() {
        None => pen.put_all([0.0; 4]),
        Some(stop) => {
            pen.put_all([1.0, stop.s_m - observation.route_s_m, stop.t_m, stop.for_s.unwrap_or(draft.duration_s)]);
        }
    }
}

/// Writes [`FIELDS_OF_OTHER`] of the nearest others, the nearest first; zeros where there are no more.
pub(crate) fn write_nearest(scene: &Scene, observation: &Observation<'_>, frame: &EgoFrame, out: &mut [f32]) {
    let mut nearest = [(f64::INFINITY, 0_u16); MOST_NEIGHBOURS];
    let wanted = out.len() / FIELDS_OF_OTHER.len();
    let mut found = 0;
    others(scene, observation, |distance, number| {
        let mut place = found;
        while place > 0 && nearest[place - 1].0 > distance {
            if place < wanted {
                nearest[place] = nearest[place - 1];
            }
            place -= 1;
        }
        if place < wanted {
            nearest[place] = (distance, number);
            found = (found + 1).min(wanted);
        }
    });
    let (filled, empty) = out.split_at_mut(found * FIELDS_OF_OTHER.len());
    for (row, &(_, number)) in filled.chunks_exact_mut(FIELDS_OF_OTHER.len()).zip(&nearest) {
        let Thing { outline, velocity } = thing(scene, observation, number);
        let (place, speed, axis) = (frame.seen(outline.centre), frame.relative(velocity), frame.turned(outline.axis));
        let (length, width) = (2.0 * outline.half_length, 2.0 * outline.half_width);
        Pen::new(row, &FIELDS_OF_OTHER)
            .put_all([1.0, place.x, place.y, speed.x, speed.y, axis.x, axis.y, length, width]);
    }
    empty.fill(0.0);
}
