//! The cluster map: one mark per usable record, its shape and colour by template, the picks large and numbered.

use super::Context;
use crate::words::{self, fixed};
use maud::{Markup, html};
use recrash_model::selection::MapPoint;
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

/// The map with its legend and the place where details are told.
pub fn map(context: &Context) -> Markup {
    let selection = &context.suite.selection;
    let points: Vec<&MapPoint> = selection
        .map
        .iter()
        .filter(|point| {
            context.suite.records.records.get(point.record).is_some() && point.cluster < selection.clusters.len()
        })
        .collect();
    if points.iter().filter(|point| point.x.is_finite() && point.y.is_finite()).count() == 0 {
        return html! { p.empty { "No record has a place on the map." } };
    }
    let frame = Frame::around(&points);
    let order = |template: Option<Template>| {
        selection
            .templates
            .iter()
            .position(|count| Some(count.template) == template)
            .unwrap_or(selection.templates.len())
    };
    let template_of = |point: &MapPoint| order(context.suite.records.records[point.record].template());
    let embedding = &selection.embedding;
    html! {
        p.muted {
            "Each mark is a record, at the first two principal components of what the clusters were made from: its template and its narrative ("
            (words::clean(&embedding.name, 80)) ", " (embedding.dimensions) " dimensions kept, "
            (fixed(embedding.explained_variance * 100.0, 0).unwrap_or_default()) "\u{a0}% of the variance). Large and numbered: the picks. "
            "Point at a mark, or put the focus on the map and use the arrow keys."
        }
        .map-grid {
            svg #map viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="application" tabindex="0" aria-label="Map of the records; arrow keys go from mark to mark" aria-describedby="map-detail" {
                defs { @for (shape, path) in SHAPES.iter().enumerate() { path id={ "mark-" (shape) } d=(path) {} } }
                @for (index, point) in points.iter().enumerate() {
                    @let t = template_of(point);
                    @let (x, y) = frame.place(point);
                    use.mark.{ "c" (t % COLOURS) } href={ "#mark-" (t % SHAPES.len()) } x=(x) y=(y) data-point=(index) data-template=(t) {}
                }
                @for (index, point) in points.iter().enumerate() {
                    @let cluster = &selection.clusters[point.cluster];
                    @if cluster.pick_index == point.record {
                        @let (x, y) = frame.place(point);
                        g.pick data-point=(index) data-template=(template_of(point)) transform={ "translate(" (x) " " (y) ")" } {
                            circle.{ "c" (template_of(point) % COLOURS) } r="10" {}
                            text y="3.6" text-anchor="middle" { (cluster.number) }
                        }
                    }
                }
                circle #map-ring r="12" cx="-50" cy="-50" {}
            }
            .map-side {
                #map-detail.map-detail role="status" aria-live="polite" { p.muted { "No record chosen." } }
                ul.legend aria-label="Templates" {
                    @for (t, count) in selection.templates.iter().enumerate() {
                        li { button type="button" data-template=(t) aria-pressed="false" {
                            svg.icon viewBox="-6 -6 12 12" aria-hidden="true" { path.{ "c" (t % COLOURS) } d=(SHAPES[t % SHAPES.len()]) {} }
                            span { (count.template) } span.muted { " " (count.records) }
                        } }
                    }
                }
            }
        }
    }
}

/// From the clustering space to the picture.
struct Frame {
    low: (f64, f64),
    scale: (f64, f64),
}

impl Frame {
    fn around(points: &[&MapPoint]) -> Self {
        let range = |of: fn(&MapPoint) -> f64| {
            let finite = points.iter().map(|point| of(point)).filter(|value| value.is_finite());
            let (low, high) =
                finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
            (low, (high - low).max(1e-9))
        };
        let (x, y) = (range(|point| point.x), range(|point| point.y));
        Self { low: (x.0, y.0), scale: ((WIDTH - 2.0 * MARGIN) / x.1, (HEIGHT - 2.0 * MARGIN) / y.1) }
    }

    fn place(&self, point: &MapPoint) -> (String, String) {
        let text = |value: f64| fixed(value, 1).unwrap_or_else(|| "-50".to_owned());
        let x = MARGIN + (point.x - self.low.0) * self.scale.0;
        let y = HEIGHT - MARGIN - (point.y - self.low.1) * self.scale.1;
        (text(x), text(y))
    }
}
