//! Where a partner is across its lane, as lane changes with an offset.

use super::Context;
use super::driven::Driven;
use super::expression::Sum;
use super::places::reference_to_centre;
use crate::xml::Element;
use recrash_model::rollout::STEP_S;
use recrash_model::scenario::{Partner, Start};
use recrash_model::vehicle::VehicleSpec;

/// Swaying by less than this is not told. [m]
const SWAY_M: f64 = 0.03;

/// A move that one shape follows no nearer than this is told as two. [m]
const NEAR_M: f64 = 0.2;

/// Parts of a move are no shorter than this. [steps]
const SHORTEST_PART: usize = 3;

/// Moves shorter than this do not scale with their target. [m]
const SHORT_MOVE_M: f64 = 0.3;

/// A sideways move from one place where the vehicle goes straight on to the next such place.
struct Piece {
    shape: Shape,
    start: Sum,
    duration: Sum,
    /// To the right of the way at its end. [m]
    t: Sum,
    t_m: f64,
    /// About where it ends along the way. [m]
    s_m: f64,
}

/// The sideways moves of a partner, as it drove them, or as they are meant where there is no rollout: when each piece
/// begins, as an attribute value, and its action.
pub(super) fn moves(context: &Context<'_>, position: usize, driven: Option<&Driven>) -> Vec<(String, Element)> {
    let pieces = pieces(context, position, driven);
    let lanes_right: Vec<i32> =
        pieces.iter().map(|piece| lanes_to_the_right(context, position, piece.s_m, piece.t_m)).collect();
    // A lane change counts lanes from the one that the entity is in by then, and halfway to another one that is
    // anyone's guess. So lanes have their own numbers where there is more than one; a sweep through a junction, where
    // numbers change, needs none.
    let crosses = lanes_right.iter().any(|&lanes| lanes != 0);
    let path = &context.scenario.partners()[position].path;
    let width = context.scenario.draft().map.carriageway().lane_width_m;
    let id = &context.scenario.draft().partners[position].id;
    pieces
        .into_iter()
        .zip(lanes_right)
        .map(|(piece, lanes)| {
            let (_, own) = context.map.lane(path.segments[path.segment_at(piece.s_m)].lane);
            let target = if crosses {
                Element::new("AbsoluteTargetLane").with("value", beside(own, lanes).to_string())
            } else {
                Element::new("RelativeTargetLane").with("entityRef", id).with("value", "0")
            };
            // Right of travel is right of the road on lanes along the reference line, left of it on the others.
            let offset =
                piece.t.plus(&Sum::constant(-f64::from(lanes) * width)).times(if own < 0 { -1.0 } else { 1.0 });
            let action = Element::new("PrivateAction").child(
                Element::new("LateralAction").child(
                    Element::new("LaneChangeAction").with("targetLaneOffset", offset.attribute()).children([
                        Element::new("LaneChangeActionDynamics")
                            .with("dynamicsShape", piece.shape.name())
                            .with("value", piece.duration.attribute())
                            .with("dynamicsDimension", "time"),
                        Element::new("LaneChangeTarget").child(target),
                    ]),
                ),
            );
            (piece.start.attribute(), action)
        })
        .collect()
}

fn pieces(context: &Context<'_>, position: usize, driven: Option<&Driven>) -> Vec<Piece> {
    let draft = context.scenario.draft();
    let partner = &draft.partners[position];
    let placement = &context.scenario.partners()[position];
    let number = |field: String, value: f64| {
        Sum::of(context.names.reference(&format!("/partners/{position}/{field}"), value), value)
    };
    let (mut from, mut from_m) = match partner.start {
        Start::Offset { delta_t_m, .. } => (number("start/delta_t_m".to_owned(), delta_t_m), delta_t_m),
        Start::ArrivalGap { .. } => (Sum::constant(placement.t_m), placement.t_m),
    };
    let mut list = Vec::new();
    // Before its first move it may be beside its line as well: in a bend a vehicle on tyres is.
    if let Some(driven) = driven {
        let until_s = partner.lateral.first().map_or(draft.duration_s, |step| step.start_s);
        let window =
            Window { begin: Sum::constant(0.0), begin_s: 0.0, duration: Sum::constant(0.0), duration_s: 0.0, until_s };
        let target = |t: f64| from.clone().plus(&Sum::constant(t - from_m));
        list = window.fitted(driven, None, target);
    }
    let mut travelled = placement.s_m;
    let mut clock = 0.0;
    for (count, step) in partner.lateral.iter().enumerate() {
        let at = |field: &str, value: f64| number(format!("lateral/{count}/{field}"), value);
        let (begin, duration, to) =
            (at("start_s", step.start_s), at("duration_s", step.duration_s), at("to_t_m", step.to_t_m));
        let until_s = partner.lateral.get(count + 1).map_or(draft.duration_s, |next| next.start_s);
        let window = Window { begin, begin_s: step.start_s, duration, duration_s: step.duration_s, until_s };
        let target = |t: f64| {
            if (step.to_t_m - from_m).abs() < SHORT_MOVE_M {
                return to.clone().plus(&Sum::constant(t - step.to_t_m));
            }
            let share = (t - from_m) / (step.to_t_m - from_m);
            from.clone().times(1.0 - share).plus(&to.clone().times(share))
        };
        // What no rollout tells is as meant. Its target speed is near enough to say where.
        travelled += (step.start_s - clock) * partner.policy.target_speed().max(0.0);
        clock = step.start_s;
        let known_s = driven.map_or(0.0, Driven::end_s);
        let end_m = (known_s < step.start_s + 2.0 * step.duration_s).then_some(step.to_t_m);
        let fitted = driven.map_or_else(Vec::new, |driven| window.fitted(driven, end_m, target));
        if fitted.is_empty() && end_m.is_some() {
            let start = window.begin.clone().plus(&Sum::constant(lag_s(partner)));
            let s_m = travelled.clamp(0.0, placement.path.length_m);
            let (duration, t) = (window.duration.clone(), to.clone());
            list.push(Piece { shape: Shape::Linear, start, duration, t, t_m: step.to_t_m, s_m });
        }
        list.extend(fitted);
        (from, from_m) = (to, step.to_t_m);
    }
    list
}

/// The time between the begin of one move and that of the next.
struct Window {
    begin: Sum,
    begin_s: f64,
    duration: Sum,
    duration_s: f64,
    until_s: f64,
}

impl Window {
    /// A time in terms of the move's begin and duration: within the move as a share of it, else so long after it.
    fn time(&self, time_s: f64) -> Sum {
        let since = time_s - self.begin_s;
        let within = if self.duration_s > 0.0 { (since / self.duration_s).min(1.0) } else { 0.0 };
        let rest = Sum::constant(since - within * self.duration_s);
        self.begin.clone().plus(&self.duration.clone().times(within)).plus(&rest)
    }

    /// What was driven, from turning point to turning point, so that no piece begins or ends on the slant; `target` says a
    /// lateral place in terms of parameters, and the last piece goes on to `end_m` where the record ends on the slant.
    fn fitted(&self, driven: &Driven, end_m: Option<f64>, target: impl Fn(f64) -> Sum) -> Vec<Piece> {
        let first = (self.begin_s / STEP_S - 1e-6).ceil() as usize;
        let last = ((self.until_s / STEP_S + 1e-6).floor() as usize).min(driven.places.len() - 1);
        if last <= first {
            return Vec::new();
        }
        let t: Vec<f64> = driven.places[first..=last].iter().map(|place| place.t).collect();
        let turns = turning_points(&t);
        let fitted = |begin: usize, end: usize| {
            let (from, to) = (t[begin], t[end]);
            let goes_on = |goal: &f64| end == t.len() - 1 && (goal - from) / (to - from) > 1.0;
            let goal = end_m.filter(goes_on).unwrap_or(to);
            let lever_s = driven.lever_s(first + begin, first + end);
            let touches = driven.touches && first + end == driven.places.len() - 1;
            (fit(&t[begin..=end], goal, lever_s, touches), goal)
        };
        let mut list = Vec::new();
        let off_m = |begin: usize, end: usize| match fitted(begin, end).0 {
            Some(fit) => fit.off_m,
            None => off_when_it_stays(&t[begin..=end], driven.lever_s(first + begin, first + end)),
        };
        for (begin, end) in turns.windows(2).flat_map(|pair| parts(pair[0], pair[1], &off_m)) {
            let (Some(Fit { shape, from_s, to_s, .. }), goal) = fitted(begin, end) else { continue };
            let at = |steps_s: f64| self.time(((first + begin) as f64 * STEP_S + steps_s).max(self.begin_s));
            let start = at(from_s);
            let duration = at(to_s).plus(&start.clone().times(-1.0));
            let s_m = driven.places[first + end].s;
            list.push(Piece { shape, start, duration, t: target(goal), t_m: goal, s_m });
        }
        list
    }
}

/// How a lane change goes from one side to the other.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Linear,
    Cubic,
    Sinusoidal,
}

impl Shape {
    fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Cubic => "cubic",
            Self::Sinusoidal => "sinusoidal",
        }
    }

    /// Share of the way sideways after a share of the time, both from 0 to 1.
    fn at(self, time: f64) -> f64 {
        let time = time.clamp(0.0, 1.0);
        match self {
            Self::Linear => time,
            Self::Cubic => time * time * (3.0 - 2.0 * time),
            Self::Sinusoidal => 0.5 - 0.5 * recrash_model::math::sincos(std::f64::consts::PI * time).1,
        }
    }
}

/// Positions of the first and the last, and between them of those from which a curve turns back by more than [`SWAY_M`].
fn turning_points(t: &[f64]) -> Vec<usize> {
    let mut turns = vec![0];
    // The highest and the lowest since the last turn, and whether that was a low (1) or a high (-1).
    let (mut high, mut low, mut sense) = (0, 0, 0);
    for at in 1..t.len() {
        high = if t[at] >= t[high] { at } else { high };
        low = if t[at] <= t[low] { at } else { low };
        if sense >= 0 && t[high] - t[at] > SWAY_M {
            turns.push(high);
            (low, sense) = (at, -1);
        } else if sense <= 0 && t[at] - t[low] > SWAY_M {
            turns.push(low);
            (high, sense) = (at, 1);
        }
    }
    turns.push(t.len() - 1);
    turns.dedup();
    turns
}

/// A shape over a time, and how far off the centre of the vehicle is in it at most. [s, s, m]
#[derive(Debug, Clone, Copy, PartialEq)]
struct Fit {
    shape: Shape,
    from_s: f64,
    to_s: f64,
    off_m: f64,
}

/// The parts in which a move from one position to another is told: the whole, or where no shape is near enough the two
/// parts that are followed best, each in parts again.
fn parts(begin: usize, end: usize, off_m: &impl Fn(usize, usize) -> f64) -> Vec<(usize, usize)> {
    let whole_m = off_m(begin, end);
    let best = (begin + SHORTEST_PART..=end.saturating_sub(SHORTEST_PART))
        .filter(|_| whole_m > NEAR_M)
        .map(|middle| (off_m(begin, middle).max(off_m(middle, end)), middle))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(parted_m, _)| *parted_m < whole_m);
    let Some((_, middle)) = best else { return vec![(begin, end)] };
    let mut list = parts(begin, middle, off_m);
    list.extend(parts(middle, end, off_m));
    list
}

/// How far the centre of a vehicle is off at most whose curve is told as none. [m]
fn off_when_it_stays(t: &[f64], lever_s: f64) -> f64 {
    let off = |around: &[f64]| around[1] - t[0] + (around[2] - around[0]) / (2.0 * STEP_S) * lever_s;
    t.windows(3).map(|around| off(around).abs()).fold(0.0, f64::max)
}

/// The shape that a curve goes from its first place to `goal` in, and when it begins and ends [s]; `None` where it
/// stays. The best is the one in which the centre of the vehicle is nearest, which goes sideways `lever_s` ahead of the
/// curve; at the end five times as near where the vehicle touches something there. Found by smaller and smaller steps of
/// begin and end, from where the first and the last tenth of the way are.
fn fit(t: &[f64], goal: f64, lever_s: f64, touches: bool) -> Option<Fit> {
    let (from, covered) = (t[0], t[t.len() - 1] - t[0]);
    if covered.abs() < SWAY_M {
        return None;
    }
    let until_s = (t.len() - 1) as f64 * STEP_S * (goal - from) / covered;
    let worst = |shape: Shape, begin_s: f64, end_s: f64| {
        if begin_s < 0.0 || end_s > until_s.max(STEP_S) || end_s - begin_s < 0.99 * STEP_S {
            return f64::INFINITY;
        }
        let off = |step: usize| {
            from + (goal - from) * shape.at((step as f64 * STEP_S - begin_s) / (end_s - begin_s)) - t[step]
        };
        let turned = |step: usize| (off(step + 1) - off(step - 1)) / (2.0 * STEP_S) * lever_s;
        let last = t.len() - 1;
        let at_end = off(last) + (off(last) - off(last - 1)) / STEP_S * lever_s;
        let most = (1..last).map(|step| (off(step) + turned(step)).abs()).fold(0.0, f64::max);
        if touches { most.max(5.0 * at_end.abs()) } else { most }
    };
    let crossing = |share: f64| {
        let step = t.iter().position(|at| (at - from) / covered >= share).unwrap_or(t.len() - 1);
        step as f64 * STEP_S
    };
    let fits = [Shape::Linear, Shape::Cubic, Shape::Sinusoidal].map(|shape| {
        let (mut begin_s, mut end_s) = (0.0, until_s.max(STEP_S));
        let mut least = worst(shape, begin_s, end_s);
        let (early_s, late_s) = (crossing(0.1), crossing(0.9).max(crossing(0.1) + STEP_S).min(end_s));
        let inner = worst(shape, early_s, late_s);
        if inner < least {
            (begin_s, end_s, least) = (early_s, late_s, inner);
        }
        for step_s in [0.4, 0.2, 0.1, 0.05, 0.02] {
            loop {
                let moves = [
                    (-1.0, 0.0),
                    (1.0, 0.0),
                    (0.0, -1.0),
                    (0.0, 1.0),
                    (-1.0, 1.0),
                    (1.0, -1.0),
                    (-1.0, -1.0),
                    (1.0, 1.0),
                ];
                let tries = moves.map(|(b, e)| (begin_s + b * step_s, end_s + e * step_s));
                let found = tries.map(|(b, e)| (worst(shape, b, e), b, e));
                let best = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).filter(|best| best.0 < least - 1e-4);
                let Some(best) = best else { break };
                (least, begin_s, end_s) = best;
            }
        }
        Fit { shape, from_s: begin_s, to_s: end_s, off_m: least }
    });
    fits.into_iter().min_by(|a, b| a.off_m.total_cmp(&b.off_m))
}

/// How late a steered vehicle follows a target that moves sideways: the time for some metres of way. Fitted to the native
/// simulator so that centres are nearest, from motorcycle to heavy truck. For moves that no rollout tells. [s]
fn lag_s(partner: &Partner) -> f64 {
    if reference_to_centre(partner.kind) == 0.0 {
        return 0.0;
    }
    let spec = VehicleSpec::of(partner.kind);
    let way = 1.6 + 0.25 * (spec.front_axle_m + spec.rear_axle_m);
    let lag = way / partner.policy.target_speed().max(1.0);
    (lag.min(1.0) * 100.0).round() / 100.0
}

/// How many lanes to the right of a partner's own a lateral place lies.
///
/// Lanes there are not count as the last one there is: a vehicle on the verge is beside the outermost lane.
fn lanes_to_the_right(context: &Context<'_>, position: usize, s: f64, t: f64) -> i32 {
    let network = context.scenario.network();
    let path = &context.scenario.partners()[position].path;
    let width = context.scenario.draft().map.carriageway().lane_width_m;
    let lane = path.segments[path.segment_at(s)].lane;
    let own = i32::from(network.lane(lane).index);
    let (road, _) = context.map.lane(lane);
    let count = i32::try_from(network.road(network.lane(lane).road).lanes.len()).unwrap_or(1);
    let least = if road.backward.is_some() { -count } else { 0 };
    let wanted = (t / width).round() as i32;
    wanted.clamp(least - own, count - 1 - own)
}

/// The number of the lane so many lanes to the right, in the direction that lane `own` is driven. There is no lane 0.
fn beside(own: i32, lanes_right: i32) -> i32 {
    let found = own + own.signum() * lanes_right;
    if found.signum() == own.signum() { found } else { found - own.signum() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_move_with_overshoot_has_two_pieces_and_the_shape_is_found() {
        let cubic = |step: i32| 3.0 * Shape::Cubic.at((f64::from(step) - 10.0) / 20.0);
        let mut t: Vec<f64> = (0..40).map(cubic).collect();
        t.extend((0..20).map(|step| 3.0 - 0.2 * Shape::Sinusoidal.at(f64::from(step) / 10.0)));
        let turns = turning_points(&t);
        assert_eq!(turns.len(), 4, "{turns:?}");
        let Fit { shape, from_s, to_s, .. } = fit(&t[turns[1]..=turns[2]], 3.0, 0.2, false).unwrap();
        let begin_s = turns[1] as f64 * STEP_S + from_s;
        assert_eq!(shape, Shape::Cubic);
        assert!((begin_s - 1.0).abs() < 0.02 && (to_s - from_s - 2.0).abs() < 0.03, "{begin_s} {}", to_s - from_s);
    }

    #[test]
    fn a_move_cut_short_goes_on_to_its_goal() {
        let t: Vec<f64> = (0..12).map(|step| 3.0 * Shape::Cubic.at(f64::from(step) / 20.0)).collect();
        let Fit { shape, from_s, to_s, .. } = fit(&t, 3.0, 0.2, false).unwrap();
        assert_eq!(shape, Shape::Cubic);
        assert!(from_s < 0.1 && (to_s - 2.0).abs() < 0.15, "{from_s} {to_s}");
        assert_eq!(fit(&t[..2], 3.0, 0.2, false), None);
    }

    #[test]
    fn lanes_are_counted_past_the_middle_of_the_road() {
        assert_eq!([beside(-1, 1), beside(-1, -1), beside(-2, -1), beside(1, -2), beside(2, 1)], [-2, 1, -1, -2, 3]);
    }
}
