//! One scenario and one run of it as one still picture (SVG): the roads and what lies on them, the way everybody drove, and
//! where all are at the start and at the ego's first contact, or at the end where it touches nobody.

use maud::{Markup, PreEscaped, html};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorTrack, EventKind, PlacedObstacle, Role, Rollout, STEP_S};
use recrash_model::scenario::{Aspect, Device, ObstacleKind};
use recrash_roads::{GroundShape, LineKind, RoadDrawing, Scenario};
use std::fmt::Write as _;

/// Around everybody's ways. [m]
const MARGIN_M: f64 = 9.0;
/// Least width and height of the picture. [m]
const LEAST_M: [f64; 2] = [44.0, 26.0];
/// Width of the picture where it is shown. [pixels]
const WIDTH_PX: f64 = 960.0;
/// Coordinates are whole numbers of these. [1/m]
const PER_M: f64 = 10.0;
/// Points that lie no farther from the line of their neighbours are left out. [m]
const STRAIGHT_M: f64 = 0.025;

/// What looks how, in tenths of metres; the colours are those of the report's page.
const STYLE: &str = ".g{fill:#dfe5dc}.rim{fill:none;stroke:#eef1f4;stroke-width:7;stroke-linejoin:round}.asphalt{fill:#59616a}\
    .bike{fill:#4c7564}.parking{fill:#656e78}.shoulder{fill:#646c74}.median{fill:#9aac8d}.sidewalk{fill:#c2c8cd}\
    .crosswalk{fill:#e6eaee}.driveway{fill:#7b838b}.building{fill:#a99f92}.l{fill:none}.edge{stroke:#eef1f4;stroke-width:1.5}\
    .lane{stroke:#f3f5f7;stroke-width:1.4;stroke-dasharray:30 45}.centre{stroke:#f2c230;stroke-width:1.6}\
    .guide{stroke:#8b949d;stroke-width:.6}.stall{stroke:#f3f5f7;stroke-width:.8}.stop{stroke:#f3f5f7;stroke-width:4.5}\
    .ego{color:#47b1f2}.partner,.part{color:#ff9a45}.traffic{color:#b9c1c9}.way{fill:none;stroke:currentColor;stroke-linejoin:round}\
    .b{fill:currentColor;stroke:#101820;stroke-width:1}.s{fill:currentColor;fill-opacity:.3;stroke:currentColor;stroke-width:1.2;\
    stroke-dasharray:5 3}.n{fill:none;stroke:#101820;stroke-width:1.2}.thing{fill:#ffd400;stroke:#101820;stroke-width:.6}\
    .cone{fill:#ff6a00}.solid{fill:#8d8478}.hole{fill:#33383d}.hit{fill:#ffe14d;stroke:#b00020}text{font-family:sans-serif;\
    fill:#101820;stroke:#fff;stroke-opacity:.8;paint-order:stroke;stroke-linejoin:round}";

/// Draws a run of a scenario. Same scenario and run, same bytes.
pub fn picture(scenario: &Scenario, rollout: &Rollout) -> String {
    let moment = Moment::of(rollout);
    let frame = Frame::about(rollout, &moment);
    let [left, top, width, height] = [frame.left, frame.top, frame.width, frame.height].map(whole);
    // A twelfth of a stroke of text is its halo.
    let letter = frame.width * PER_M / 62.0;
    let pixels = (WIDTH_PX * frame.height / frame.width).round();
    let drawn = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox={ (left) " " (top) " " (width) " " (height) }
            width=(WIDTH_PX) height=(pixels) font-size=(tenth(letter)) stroke-width=(tenth(letter / 6.0)) {
            title { (rollout.scenario_id) ": " (moment.says) }
            style { (PreEscaped(STYLE)) }
            rect.g x=(left) y=(top) width=(width) height=(height) {}
            (ground(&scenario.drawing(), &frame))
            (controls(scenario, moment.time_s, &frame))
            @for thing in &rollout.obstacles { (obstacle(thing, &frame)) }
            @for track in rollout.actors.iter().rev() { (way(track, moment.step, letter)) }
            @for track in rollout.actors.iter().rev() { (at_the_start(track, moment.step)) }
            @for track in rollout.actors.iter().rev() { (now(track, moment.step)) }
            @for point in &moment.hits { (hit(*point, letter)) }
            @for track in rollout.actors.iter().filter(|track| track.role != Role::Part) { (name(track, rollout.ego_track(), moment.step, letter)) }
            (caption(&moment, &frame, letter))
        }
    };
    drawn.into_string() + "\n"
}

/// The moment that is shown beside the start.
struct Moment {
    time_s: f64,
    step: usize,
    /// Where bodies have touched up to then.
    hits: Vec<Vec2>,
    says: String,
}

impl Moment {
    fn of(rollout: &Rollout) -> Self {
        let who = |actor: usize| rollout.actors[actor].id.as_str();
        let mut hits = Vec::new();
        let outline = |actor: usize, pose: Pose| {
            OrientedBox::new(pose, rollout.actors[actor].length_m, rollout.actors[actor].width_m)
        };
        for event in &rollout.events {
            let (first, pair, says) = match &event.kind {
                EventKind::Contact { a, b, a_state, b_state } => {
                    let pair = (outline(*a, a_state.pose()), outline(*b, b_state.pose()));
                    (*a, pair, format!("{} and {} touch", who(*a), who(*b)))
                }
                EventKind::ObstacleContact { actor, obstacle, state } => {
                    let thing = &rollout.obstacles[*obstacle];
                    let pair = (outline(*actor, state.pose()), thing.outline());
                    (*actor, pair, format!("{} touches a {}", who(*actor), thing.kind.label()))
                }
                EventKind::Gone { .. } => continue,
            };
            hits.push(between(&pair.0, &pair.1));
            if first == 0 {
                return Self::at(rollout, event.time_s, hits, says);
            }
        }
        let says = if hits.is_empty() { "no contact" } else { "the others touched, the ego nobody" };
        Self::at(rollout, rollout.termination.time_s, hits, says.to_owned())
    }

    fn at(rollout: &Rollout, time_s: f64, hits: Vec<Vec2>, says: String) -> Self {
        let step = ((time_s / STEP_S).round() as usize).min(rollout.steps() - 1);
        Self { time_s, step, hits, says }
    }
}

/// The middle of where two boxes overlap or come nearest, as nearly as a mark needs it.
fn between(a: &OrientedBox, b: &OrientedBox) -> Vec2 {
    let nearest = |of: &OrientedBox, point: Vec2| {
        let local = of.to_local(point);
        let inside = |value: f64, half: f64| value.clamp(-half, half);
        of.to_world(Vec2::new(inside(local.x, of.half_length), inside(local.y, of.half_width)))
    };
    let (mut on_a, mut on_b) = (a.centre, b.centre);
    for _ in 0..8 {
        on_a = nearest(a, on_b);
        on_b = nearest(b, on_a);
    }
    (on_a + on_b) * 0.5
}

/// What of the world is in the picture: y grows downwards. [m]
struct Frame {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl Frame {
    fn about(rollout: &Rollout, moment: &Moment) -> Self {
        let mut low = Vec2::new(f64::INFINITY, f64::INFINITY);
        let mut high = Vec2::new(f64::NEG_INFINITY, f64::NEG_INFINITY);
        for track in rollout.actors.iter().filter(|track| track.role != Role::Traffic) {
            for step in (0..=moment.step).filter(|step| track.is_present(*step)) {
                for corner in track.outline(step).corners() {
                    low = Vec2::new(low.x.min(corner.x), low.y.min(corner.y));
                    high = Vec2::new(high.x.max(corner.x), high.y.max(corner.y));
                }
            }
        }
        let middle = (low + high) * 0.5;
        let width = (high.x - low.x + 2.0 * MARGIN_M).max(LEAST_M[0]);
        // Long ways keep a strip that can be looked at.
        let height = (high.y - low.y + 2.0 * MARGIN_M).max(LEAST_M[1]).max(0.24 * width);
        let width = width.max(1.25 * height);
        Self { left: middle.x - 0.5 * width, top: -middle.y - 0.5 * height, width, height }
    }

    /// Whether a part of what these points span may be in it.
    fn shows(&self, points: &[Vec2]) -> bool {
        let spans = |of: &dyn Fn(&Vec2) -> f64, low: f64, size: f64| {
            let least = points.iter().map(of).fold(f64::INFINITY, f64::min);
            let most = points.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
            least <= low + size && most >= low
        };
        spans(&|point| point.x, self.left, self.width) && spans(&|point| -point.y, self.top, self.height)
    }
}

/// A length in the picture's units, as a whole number.
fn whole(value_m: f64) -> i64 {
    (value_m * PER_M).round() as i64
}

/// A number with one digit behind the point.
fn tenth(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

/// Adds a line to a path's data: the first point, then steps.
fn trace(data: &mut String, points: &[Vec2], closed: bool) {
    let mut last: Option<[i64; 2]> = None;
    for point in simplified(points) {
        let at = [whole(point.x), whole(-point.y)];
        let written = match last {
            None => write!(data, "M{} {}", at[0], at[1]),
            Some(last) if last == at => Ok(()),
            Some(last) => write!(data, "l{} {}", at[0] - last[0], at[1] - last[1]),
        };
        // Into a string.
        written.unwrap_or_default();
        last = Some(at);
    }
    data.push_str(if closed { "z" } else { "" });
}

/// The points that straight lines between them need (after Douglas and Peucker).
fn simplified(points: &[Vec2]) -> Vec<Vec2> {
    let [first, .., last] = points else { return points.to_vec() };
    let mut kept = vec![*first];
    let mut open = vec![(0, points.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let (a, b) = (points[from], points[to]);
        let along = b - a;
        let length = along.length();
        let off = |point: Vec2| {
            let away = point - a;
            if length < 1e-9 { away.length() } else { (along.x * away.y - along.y * away.x).abs() / length }
        };
        let farthest = (from + 1..to).max_by(|&i, &j| off(points[i]).total_cmp(&off(points[j])));
        match farthest {
            Some(at) if off(points[at]) > STRAIGHT_M => open.extend([(at, to), (from, at)]),
            _ => kept.push(b),
        }
    }
    if kept.len() == 1 {
        kept.push(*last);
    }
    kept
}

/// All areas of one look, each turned the same way round: where two overlap there is no hole.
fn areas<'a>(of: impl Iterator<Item = &'a [Vec2]>, frame: &Frame) -> String {
    let mut data = String::new();
    for points in of.filter(|points| frame.shows(points)) {
        let next = points.iter().cycle().skip(1);
        let twice_area: f64 = points.iter().zip(next).map(|(a, b)| a.x * b.y - a.y * b.x).sum();
        let mut points = points.to_vec();
        if twice_area < 0.0 {
            points.reverse();
        }
        trace(&mut data, &points, true);
    }
    data
}

/// Roads, what lies on and beside them, and their lines.
fn ground(drawing: &RoadDrawing, frame: &Frame) -> Markup {
    const LOOKS: [(GroundShape, &str); 8] = [
        (GroundShape::Sidewalk, "sidewalk"),
        (GroundShape::Median, "median"),
        (GroundShape::Shoulder, "shoulder"),
        (GroundShape::Bike, "bike"),
        (GroundShape::Parking, "parking"),
        (GroundShape::Driveway, "driveway"),
        (GroundShape::Crosswalk, "crosswalk"),
        (GroundShape::Building, "building"),
    ];
    const LINES: [(LineKind, &str); 6] = [
        (LineKind::Guide, "guide"),
        (LineKind::Edge, "edge"),
        (LineKind::Stall, "stall"),
        (LineKind::LaneDivider, "lane"),
        (LineKind::Centre, "centre"),
        (LineKind::Stop, "stop"),
    ];
    let asphalt = areas(drawing.surfaces.iter().map(Vec::as_slice), frame);
    let shaped = LOOKS.map(|(shape, class)| {
        let of = drawing.areas.iter().filter(|area| area.shape == shape).map(|area| area.points.as_slice());
        (class, areas(of, frame))
    });
    let lined = LINES.map(|(kind, class)| {
        let mut data = String::new();
        for line in drawing.lines.iter().filter(|line| line.kind == kind && frame.shows(&line.points)) {
            trace(&mut data, &line.points, false);
        }
        (class, data)
    });
    html! {
        path.rim d=(asphalt) {}
        path.asphalt d=(asphalt) {}
        @for (class, data) in shaped.iter().filter(|(_, data)| !data.is_empty()) { path class=(class) d=(data) {} }
        @for (class, data) in lined.iter().filter(|(_, data)| !data.is_empty()) { path class={ "l " (class) } d=(data) {} }
    }
}

/// Stop lines; beside each what stands there, a signal as it shows at that time.
fn controls(scenario: &Scenario, time_s: f64, frame: &Frame) -> Markup {
    let stands = scenario.draft().control.iter().flat_map(|control| {
        let lines = scenario.network().stop_lines(std::slice::from_ref(control));
        lines.into_iter().map(move |line| (line, &control.device))
    });
    html! {
        @for (line, device) in stands.filter(|(line, _)| frame.shows(line)) {
            @let data = { let mut data = String::new(); trace(&mut data, &line, false); data };
            @let out = (line[1] - line[0]) * (1.2 / line[1].distance(line[0]).max(0.1));
            @let [x, y] = [whole(line[1].x + out.x), whole(-line[1].y - out.y)];
            path class="l stop" d=(data) {}
            @match device {
                Device::StopSign {} => {
                    path d={ "M" (x - 4) " " (y - 9) "h8l5 5v8l-5 5h-8l-5-5v-8z" } fill="#d7301f" stroke="#fff" stroke-width="1.5" {}
                }
                Device::YieldSign {} => {
                    path d={ "M" (x - 10) " " (y - 8) "h20l-10 17z" } fill="#fff" stroke="#d7301f" stroke-width="3" {}
                }
                Device::Signal { .. } => {
                    circle cx=(x) cy=(y) r="9" fill=(lamp(device.aspect(time_s))) stroke="#101820" stroke-width="3" {}
                }
            }
        }
    }
}

fn lamp(aspect: Option<Aspect>) -> &'static str {
    match aspect {
        Some(Aspect::Green) => "#2fbf5b",
        Some(Aspect::Yellow) => "#ffc93c",
        Some(Aspect::Red | Aspect::FlashingRed) => "#e8382c",
        Some(Aspect::Dark) | None => "#33383d",
    }
}

/// A box about the origin that is put in its place.
fn boxed(class: &str, pose: Pose, length_m: f64, width_m: f64, pointed: bool) -> Markup {
    let [x, y] = [pose.position.x * PER_M, -pose.position.y * PER_M].map(tenth);
    let turned = tenth(-pose.heading * 180.0 / recrash_model::math::PI);
    let [half_length, half_width] = [0.5 * length_m * PER_M, 0.5 * width_m * PER_M].map(tenth);
    let bow = tenth((half_length - 1.4 * half_width).max(-half_length));
    html! {
        g transform={ "translate(" (x) " " (y) ")rotate(" (turned) ")" } {
            rect class=(class) x=(-half_length) y=(-half_width) width=(tenth(2.0 * half_length)) height=(tenth(2.0 * half_width)) {}
            @if pointed {
                path.n d={ "M" (bow) " " (tenth(-0.8 * half_width)) "L" (tenth(half_length - 0.3 * half_width)) " 0L" (bow) " " (tenth(0.8 * half_width)) } {}
            }
        }
    }
}

fn obstacle(thing: &PlacedObstacle, frame: &Frame) -> Markup {
    let class = match thing.kind {
        ObstacleKind::Cone => "thing cone",
        ObstacleKind::Wall | ObstacleKind::Kerb | ObstacleKind::Container => "thing solid",
        ObstacleKind::Pothole => "thing hole",
        ObstacleKind::Barrier
        | ObstacleKind::Warning
        | ObstacleKind::Pole
        | ObstacleKind::Gate
        | ObstacleKind::Chain
        | ObstacleKind::Debris => "thing",
    };
    let shown = frame.shows(&thing.outline().corners());
    html! { @if shown { (boxed(class, thing.pose, thing.length_m, thing.width_m, false)) } }
}

const fn class_of(role: Role) -> &'static str {
    match role {
        Role::Ego => "ego",
        Role::Partner => "partner",
        Role::Traffic => "traffic",
        Role::Part => "part",
    }
}

/// The way driven up to the moment shown.
fn way(track: &ActorTrack, until: usize, letter: f64) -> Markup {
    if matches!(track.role, Role::Part | Role::Traffic) {
        return html! {};
    }
    let points: Vec<Vec2> =
        (0..=until).filter(|step| track.is_present(*step)).map(|step| track.states[step].position()).collect();
    let mut data = String::new();
    if points.len() > 1 {
        trace(&mut data, &points, false);
    }
    // A line of one point: somebody who stands.
    let drawn = data.contains('l');
    html! { @if drawn { path class={ "way " (class_of(track.role)) } stroke-width=(tenth(letter / 4.0)) d=(data) {} } }
}

fn at_the_start(track: &ActorTrack, until: usize) -> Markup {
    let first = (track.appears_s / STEP_S).round() as usize;
    let moved = first <= until && track.states[first].position().distance(track.states[until].position()) > 0.5;
    html! {
        @if moved && track.role != Role::Part {
            g class=(class_of(track.role)) { (boxed("s", track.states[first].pose(), track.length_m, track.width_m, false)) }
        }
    }
}

fn now(track: &ActorTrack, step: usize) -> Markup {
    let pointed = track.role != Role::Part && !matches!(track.kind, PartnerKind::FixedObject);
    html! {
        @if track.is_present(step) {
            g class=(class_of(track.role)) { (boxed("b", track.states[step].pose(), track.length_m, track.width_m, pointed)) }
        }
    }
}

/// A star where bodies touch.
fn hit(point: Vec2, letter: f64) -> Markup {
    let [x, y] = [point.x * PER_M, -point.y * PER_M].map(tenth);
    let size = tenth(letter / 14.0);
    html! {
        path.hit transform={ "translate(" (x) " " (y) ")scale(" (size) ")" } stroke-width="1"
            d="M0-9l2 6 6-3-3 5 6 3-6 2 1 6-5-4-4 5v-6l-7 0 5-4-4-5 6 2z" {}
    }
}

/// The name of somebody, above its box; below it where the ego is above.
fn name(track: &ActorTrack, ego: &ActorTrack, step: usize, letter: f64) -> Markup {
    if !track.is_present(step) || track.role == Role::Traffic {
        return html! {};
    }
    let place = track.states[step].position();
    let below = track.role != Role::Ego && place.y < ego.states[step].position().y - 0.1;
    let heights = track.outline(step).corners().map(|corner| corner.y);
    let [x, y] = if below {
        [whole(place.x), whole(-heights.iter().copied().fold(place.y, f64::min)) + (1.05 * letter) as i64]
    } else {
        [whole(place.x), whole(-heights.iter().copied().fold(place.y, f64::max)) - (0.35 * letter) as i64]
    };
    html! { text x=(x) y=(y) text-anchor="middle" { (track.id) } }
}

/// When and what, and how long ten metres are.
fn caption(moment: &Moment, frame: &Frame, letter: f64) -> Markup {
    let [x, y] = [frame.left * PER_M + letter, frame.top * PER_M + 1.6 * letter].map(|value| value.round() as i64);
    let [right, bottom] =
        [frame.left + frame.width, frame.top + frame.height].map(|value| whole(value) - letter as i64);
    html! {
        text x=(x) y=(y) { (format!("{:.1} s: {}", moment.time_s, moment.says)) }
        path d={ "M" (right - 100) " " (bottom - 6) "v6h100v-6" } fill="none" stroke="#101820" {}
        text x=(right - 50) y=(bottom - (0.5 * letter) as i64) text-anchor="middle" { "10 m" }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_a_line_are_left_out_and_corners_stay() {
        let points = [[0.0, 0.0], [1.0, 0.01], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0]].map(|[x, y]| Vec2::new(x, y));
        assert_eq!(simplified(&points), [points[0], points[2], points[4]]);
        assert_eq!(simplified(&points[..2]), points[..2]);
    }

    #[test]
    fn two_boxes_touch_in_their_overlap() {
        let at = |x: f64, y: f64| OrientedBox::new(Pose { position: Vec2::new(x, y), heading: 0.0 }, 4.0, 2.0);
        let point = between(&at(0.0, 0.0), &at(4.0, 1.5));
        assert!((point.x - 2.0).abs() < 0.01 && (0.5..=1.0).contains(&point.y), "{point:?}");
    }
}
