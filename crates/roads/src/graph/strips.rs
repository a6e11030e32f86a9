//! From a road's reference line and strips to lanes.
//!
//! A strip of one width lies beside the line, exactly. Widths that differ at a road's ends change in an S made of two
//! parabolas, so that lanes lead out of a road as its line does: half of the change on half of the way. Lanes beside such a
//! strip are pairs of arcs between exact poses.

use crate::curve::{self, Stretch};
use crate::reference_line::ReferenceLine;
use recrash_model::geometry::Pose;
use recrash_model::math;
use recrash_model::scenario::{RoadSpec, Strip, StripKind};

/// A road whose strips change in width is cut into at least so many parts.
const TAPER_PARTS: f64 = 4.0;

/// A side of a reference line: +1 is right of it, with lanes along the line; -1 is left, with lanes against it.
pub(crate) const RIGHT: f64 = 1.0;
/// See [`RIGHT`].
pub(crate) const LEFT: f64 = -1.0;

/// How much of a change of width is done at a share of a road's length, and its slope there.
pub(crate) fn taper(u: f64) -> (f64, f64) {
    let u = u.clamp(0.0, 1.0);
    if u < 0.5 { (2.0 * u * u, 4.0 * u) } else { (1.0 - 2.0 * math::sq(1.0 - u), 4.0 * (1.0 - u)) }
}

/// The strips of one side.
pub(crate) fn side_of(spec: &RoadSpec, side: f64) -> &[Strip] {
    if side > 0.0 { &spec.right } else { &spec.left }
}

/// Width of a strip at a share of its road's length. [m]
pub(crate) fn width_m(strip: &Strip, u: f64) -> f64 {
    let (from, to) = strip.widths_m();
    from + (to - from) * taper(u).0
}

/// How far the inner edge of a strip is from the reference line at a share of the road's length; that of the strip after
/// the last is the side's width. [m]
pub fn inner_edge_m(strips: &[Strip], index: usize, u: f64) -> f64 {
    strips[..index].iter().map(|strip| width_m(strip, u)).sum()
}

/// How far the middle of a strip is from the reference line at a share of the road's length, and how fast that changes
/// along it. [m]
fn middle_m(strips: &[Strip], index: usize, u: f64, length_m: f64) -> (f64, f64) {
    let middle = inner_edge_m(strips, index, u) + 0.5 * width_m(&strips[index], u);
    let grows = |strip: &Strip| strip.widths_m().1 - strip.widths_m().0;
    let all = strips[..index].iter().map(grows).sum::<f64>() + 0.5 * grows(&strips[index]);
    (middle, all * taper(u).1 / length_m)
}

/// Where the middle of a strip begins or ends, facing along the reference line.
pub(crate) fn strip_end(spec: &RoadSpec, line: &ReferenceLine, side: f64, index: usize, at_end: bool) -> Pose {
    let (s, u) = if at_end { (line.length_m, 1.0) } else { (0.0, 0.0) };
    curve::beside(line.pose(s), side * middle_m(side_of(spec, side), index, u, line.length_m).0)
}

/// A piece of a strip.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StripPiece {
    pub(crate) stretch: Stretch,
    /// Width at its beginning. [m]
    pub(crate) width_m: f64,
    /// Width at its end. [m]
    pub(crate) end_width_m: f64,
}

impl StripPiece {
    pub(crate) fn reversed(&self) -> Self {
        Self { stretch: self.stretch.reversed(), width_m: self.end_width_m, end_width_m: self.width_m }
    }
}

/// The parts of a reference line that lanes are made along.
pub(crate) struct Parts<'a> {
    line: &'a ReferenceLine,
    /// Stretches with where they begin.
    parts: Vec<(Stretch, f64)>,
    tapered: bool,
}

impl<'a> Parts<'a> {
    /// Of a road.
    pub(crate) fn of(spec: &RoadSpec, line: &'a ReferenceLine) -> Self {
        let tapered = spec.right.iter().chain(&spec.left).any(|strip| strip.widths_m().0 != strip.widths_m().1);
        let mut parts = Vec::new();
        let mut s = 0.0;
        for stretch in &line.stretches {
            let longest = if tapered { line.length_m / TAPER_PARTS } else { f64::INFINITY };
            let count = (stretch.length_m / longest - 1e-9).ceil().max(1.0);
            let each = stretch.length_m / count;
            for part in 0..count as u32 {
                let from = each * f64::from(part);
                parts.push((stretch.part(from, from + each), s + from));
            }
            s += stretch.length_m;
        }
        Self { line, parts, tapered }
    }

    /// How many pieces each strip has: two for each part where widths change.
    pub(crate) fn pieces(&self) -> usize {
        self.parts.len() * if self.tapered { 2 } else { 1 }
    }

    /// The pieces of a strip along the reference line. `None` where it bends back in itself.
    pub(crate) fn strip(&self, strips: &[Strip], side: f64, index: usize) -> Option<Vec<StripPiece>> {
        let length_m = self.line.length_m;
        let mut pieces = Vec::with_capacity(self.pieces());
        for (number, (stretch, s)) in self.parts.iter().enumerate() {
            let u = |along: f64| (s + along) / length_m;
            let width = |along: f64| width_m(&strips[index], u(along));
            let (middle, _) = middle_m(strips, index, 0.0, length_m);
            if 1.0 + stretch.curvature * side * middle_m(strips, index, u(0.0), length_m).0 < 0.01 {
                return None;
            }
            let mut push = |stretch: Stretch, from: f64, to: f64| {
                pieces.push(StripPiece { stretch, width_m: width(from), end_width_m: width(to) });
            };
            let whole = stretch.length_m;
            if !self.tapered {
                push(stretch.beside(side * middle), 0.0, whole);
            } else if strips[..=index].iter().all(|strip| strip.widths_m().0 == strip.widths_m().1) {
                push(stretch.part(0.0, 0.5 * whole).beside(side * middle), 0.0, 0.5 * whole);
                push(stretch.part(0.5 * whole, whole).beside(side * middle), 0.5 * whole, whole);
            } else {
                // Where the line's curvature jumps, a slanted strip would have a kink: its heading there is the mean.
                let curvature = |part: Option<&(Stretch, f64)>| part.map_or(stretch.curvature, |part| part.0.curvature);
                let before = curvature(number.checked_sub(1).and_then(|number| self.parts.get(number)));
                let after = curvature(self.parts.get(number + 1));
                let pose = |along: f64, neighbour: f64| {
                    let (middle, slope) = middle_m(strips, index, u(along), length_m);
                    let t = side * middle;
                    let mean = 0.5 * (stretch.curvature + neighbour);
                    let pose = curve::beside(stretch.pose(along), t);
                    Pose { heading: pose.heading - math::atan2(side * slope, 1.0 + mean * t), ..pose }
                };
                let [first, second] = curve::biarc(pose(0.0, before), pose(whole, after))?;
                push(first, 0.0, 0.5 * whole);
                push(second, 0.5 * whole, whole);
            }
        }
        Some(pieces)
    }
}

/// The strips of a side that are for one thing, from the reference line outwards.
pub(crate) fn of_kind(strips: &[Strip], kind: StripKind) -> Vec<usize> {
    (0..strips.len()).filter(|index| strips[*index].kind == kind).collect()
}
