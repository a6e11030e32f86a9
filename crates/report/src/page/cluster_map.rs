//! The cluster map: one mark per usable record, its shape and colour by template, the picks large and numbered.

use super::Context;
use crate::view::SuiteView;
use crate::words::{self, fixed, thousands};
use maud::{Markup, html};
use recrash_model::selection::{MapPoint, Selection};
use recrash_model::template::Template;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 440.0;
const MARGIN: f64 = 26.0;
/// Shapes of marks, as paths about the origin.
const SHAPES: [&str; 6] = [
    "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0",
    "M-3.6 -3.6h7.2v7.2h-7.2z",
    "M0 -4.8L4.4 3.4H-4.4z",
    "M0 -5L5 0L0 5L-5 0z",
    "M0 4.8L4.4 -3.4H-4.4z",
    "M-1.5 -4.6h3v3.1h3.1v3h-3.1v3.1h-3v-3.1h-3.1v-3h3.1z",
];
/// Number of colours in the style sheet; prime to the number of shapes, so that 42 templates differ.
const COLOURS: usize = 7;

/// Marks at most; more could not be told apart. [count]
const MOST_MARKS: usize = 1200;
/// Picks that get a number and make room for each other; more are only drawn large. [count]
const MOST_LABELS: usize = 120;

fn is_pick(suite: &SuiteView, point: &MapPoint) -> bool {
    suite.selection.clusters[point.cluster].pick_index == point.record
}

/// The points that have a mark, in the order of the records: those that lead somewhere; of too many the picks first, and then
/// others, evenly taken.
pub fn shown(suite: &SuiteView) -> Vec<&MapPoint> {
    let selection = &suite.selection;
    let leads =
        |point: &&MapPoint| point.record < suite.records.records.len() && point.cluster < selection.clusters.len();
    let points: Vec<&MapPoint> = selection.map.iter().filter(leads).collect();
    if points.len() <= MOST_MARKS {
        return points;
    }
    let (picks, others): (Vec<&MapPoint>, Vec<&MapPoint>) = points.into_iter().partition(|point| is_pick(suite, point));
    let picks = evenly(picks, MOST_MARKS);
    let others = evenly(others, MOST_MARKS - picks.len());
    let mut shown: Vec<&MapPoint> = picks.into_iter().chain(others).collect();
    shown.sort_by_key(|point| point.record);
    shown
}

/// So many of a list at most, evenly taken.
fn evenly<T>(list: Vec<T>, most: usize) -> Vec<T> {
    if list.len() <= most {
        return list;
    }
    let all = list.len();
    // The i-th is taken where the number of those taken goes up.
    let taken = |upto: usize| upto * most / all;
    list.into_iter().enumerate().filter(|(i, _)| taken(i + 1) > taken(*i)).map(|(_, item)| item).collect()
}

/// The map with its legend and the place where details are told.
pub fn map(context: &Context) -> Markup {
    let selection = &context.suite.selection;
    let points = shown(context.suite);
    let picks = points.iter().filter(|point| is_pick(context.suite, point)).count();
    if points.iter().filter(|point| point.x.is_finite() && point.y.is_finite()).count() == 0 {
        return html! { p.empty { "No record has a place on the map." } };
    }
    let embedding = &selection.embedding;
    html! {
        p.muted {
            "Each mark is a record, at the first two principal components of what the clusters were made from: its template and its narrative ("
            (words::clean(&embedding.name, 80)) ", " (embedding.dimensions) " dimensions kept, "
            (fixed(embedding.explained_variance * 100.0, 0).unwrap_or_default()) "\u{a0}% of the variance). Dense spots are stretched. "
            @if picks <= MOST_LABELS { "Large and numbered: the picks. " } @else { "Large: the picks. " }
            @if points.len() < selection.map.len() { (thousands(points.len())) " of " (thousands(selection.map.len())) " records are drawn. " }
            "Point at a mark, or put the focus on the map and use the arrow keys."
        }
        .map-grid {
            (picture(context, &points, picks <= MOST_LABELS))
            .map-side {
                #map-detail.map-detail role="status" aria-live="polite" { p.muted { "No record chosen." } }
                (legend(selection))
            }
        }
    }
}

/// The marks of the records, and over them those of the picks, with their numbers where there is room.
fn picture(context: &Context, points: &[&MapPoint], numbered: bool) -> Markup {
    let selection = &context.suite.selection;
    let layout = Layout::of(points, |point| numbered && is_pick(context.suite, point));
    let order = |template: Option<Template>| {
        selection
            .templates
            .iter()
            .position(|count| Some(count.template) == template)
            .unwrap_or(selection.templates.len())
    };
    let template_of = |point: &MapPoint| order(context.suite.records.records[point.record].template());
    html! {
        svg #map viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="application" tabindex="0" aria-label="Map of the records; arrow keys go from mark to mark" aria-describedby="map-detail" {
            defs { @for (shape, path) in SHAPES.iter().enumerate() { path id={ "mark-" (shape) } d=(path) {} } }
            @for (index, point) in points.iter().enumerate() {
                @let t = template_of(point);
                @let (x, y) = layout.marks[index];
                use.mark.{ "c" (t % COLOURS) } href={ "#mark-" (t % SHAPES.len()) } x=(text(x)) y=(text(y)) data-point=(index) data-template=(t) {}
            }
            @for (index, point) in points.iter().enumerate() {
                @let cluster = &selection.clusters[point.cluster];
                @if cluster.pick_index == point.record {
                    @let ((mx, my), (x, y)) = (layout.marks[index], layout.labels[index]);
                    @if (mx - x).abs() + (my - y).abs() > 4.0 { line.leader x1=(text(mx)) y1=(text(my)) x2=(text(x)) y2=(text(y)) {} }
                    g.pick data-point=(index) data-template=(template_of(point)) transform={ "translate(" (text(x)) " " (text(y)) ")" } {
                        @if numbered {
                            circle.{ "c" (template_of(point) % COLOURS) } r="10" {}
                            text y="3.6" text-anchor="middle" { (cluster.number) }
                        } @else { circle.{ "c" (template_of(point) % COLOURS) } r="5" {} }
                    }
                }
            }
            circle #map-ring r="12" cx="-50" cy="-50" {}
        }
    }
}

/// The marks of the templates.
fn legend(selection: &Selection) -> Markup {
    html! {
        ul.legend aria-label="Templates" {
            @for (t, count) in selection.templates.iter().enumerate() {
                li { button type="button" data-template=(t) aria-pressed="false" {
                    svg.icon viewBox="-6 -6 12 12" aria-hidden="true" { path.{ "c" (t % COLOURS) } d=(SHAPES[t % SHAPES.len()]) {} }
                    span { (words::template(&count.template)) } span.muted { " " (count.records) }
                } }
            }
        }
    }
}

/// Share of a mark's place that is its rank along the axis; the rest is its value. Templates pull the records into a few
/// dense spots, and ranks stretch those. (Chosen by eye.)
const RANK_SHARE: f64 = 0.65;

/// Places of the marks in the picture, and of the picks' labels, which make room for each other.
struct Layout {
    marks: Vec<(f64, f64)>,
    labels: Vec<(f64, f64)>,
}

impl Layout {
    fn of(points: &[&MapPoint], is_pick: impl Fn(&MapPoint) -> bool) -> Self {
        let xs = stretched(points, |point| point.x);
        let ys = stretched(points, |point| point.y);
        let place =
            |(x, y): (f64, f64)| (MARGIN + x * (WIDTH - 2.0 * MARGIN), HEIGHT - MARGIN - y * (HEIGHT - 2.0 * MARGIN));
        let marks: Vec<(f64, f64)> = xs.into_iter().zip(ys).map(place).collect();
        let mut labels = marks.clone();
        let picks: Vec<usize> = (0..points.len()).filter(|&i| is_pick(points[i])).collect();
        part(&mut labels, &picks);
        Self { marks, labels }
    }
}

/// Values of an axis in [0, 1], stretched where they are dense. What is not finite goes to the middle.
fn stretched(points: &[&MapPoint], of: fn(&MapPoint) -> f64) -> Vec<f64> {
    let mut order: Vec<f64> = points.iter().map(|point| of(point)).filter(|value| value.is_finite()).collect();
    order.sort_by(f64::total_cmp);
    let (Some(&low), Some(&high)) = (order.first(), order.last()) else { return vec![0.5; points.len()] };
    let width = (high - low).max(1e-12);
    let last = (order.len() - 1).max(1) as f64;
    let place = |value: f64| {
        if !value.is_finite() {
            return 0.5;
        }
        let before = order.partition_point(|other| *other < value);
        let upto = order.partition_point(|other| *other <= value);
        let rank = 0.5 * (before + upto - 1) as f64 / last;
        RANK_SHARE * rank + (1.0 - RANK_SHARE) * (value - low) / width
    };
    points.iter().map(|point| place(of(point))).collect()
}

/// Moves labels that cover each other apart, each by half of what is missing, a fixed number of times.
fn part(labels: &mut [(f64, f64)], picks: &[usize]) {
    const APART: f64 = 22.0;
    for _ in 0..60 {
        for (position, &a) in picks.iter().enumerate() {
            for &b in &picks[position + 1..] {
                let (dx, dy) = (labels[b].0 - labels[a].0, labels[b].1 - labels[a].1);
                let distance = (dx * dx + dy * dy).sqrt();
                if distance >= APART {
                    continue;
                }
                // Labels on the very same spot part along a line that depends on nothing but their numbers.
                let (ux, uy) = if distance > 1e-6 { (dx / distance, dy / distance) } else { (0.8, 0.6) };
                let push = 0.5 * (APART - distance);
                for (label, sign) in [(a, -1.0), (b, 1.0)] {
                    let at = &mut labels[label];
                    at.0 = (at.0 + sign * push * ux).clamp(12.0, WIDTH - 12.0);
                    at.1 = (at.1 + sign * push * uy).clamp(12.0, HEIGHT - 12.0);
                }
            }
        }
    }
}

fn text(value: f64) -> String {
    fixed(value, 1).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(values: &[(f64, f64)]) -> Vec<MapPoint> {
        values.iter().enumerate().map(|(record, &(x, y))| MapPoint { record, cluster: 0, x, y }).collect()
    }

    #[test]
    fn the_order_along_an_axis_stays_and_equal_values_stay_equal() {
        let points = points(&[(0.0, 0.0), (0.001, 0.0), (0.001, 0.0), (10.0, f64::NAN)]);
        let places = stretched(&points.iter().collect::<Vec<_>>(), |point| point.x);
        assert_eq!(places[0], 0.0);
        assert!(places[0] < places[1] && places[1] == places[2] && places[2] < places[3]);
        assert!((places[3] - 1.0).abs() < 1e-12);
        assert_eq!(stretched(&points.iter().collect::<Vec<_>>(), |point| point.y)[3], 0.5);
    }

    #[test]
    fn too_many_are_thinned_evenly() {
        assert_eq!(evenly((0..10).collect(), 5), [1, 3, 5, 7, 9]);
        assert_eq!(evenly((0..3).collect(), 5), [0, 1, 2]);
        assert_eq!(evenly((0..7).collect::<Vec<_>>(), 0), [0; 0]);
    }

    #[test]
    fn labels_on_one_spot_make_room() {
        let points = points(&[(1.0, 1.0); 4]);
        let layout = Layout::of(&points.iter().collect::<Vec<_>>(), |_| true);
        for (i, a) in layout.labels.iter().enumerate() {
            for b in &layout.labels[i + 1..] {
                assert!(((a.0 - b.0).abs() + (a.1 - b.1).abs()) > 15.0, "{:?}", layout.labels);
            }
        }
    }
}
