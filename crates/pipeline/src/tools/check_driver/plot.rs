//! Where drivers crash, as SVG: a panel for each driver and speed at the start.

use super::{Column, Verdict};
use recrash_drivers::{Concrete, Grid};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

const PANEL: (f64, f64) = (150.0, 108.0);
const GAP: (f64, f64) = (16.0, 30.0);
const LEFT: f64 = 92.0;
const TOP: f64 = 64.0;
/// Shades from no crash over some to crashes only.
const SHADES: [&str; 5] = ["#e3f1e3", "#fdd0c7", "#f7927f", "#dc4a38", "#95150d"];
const NOT_RUN: &str = "#d8d8d8";

/// Where a scenario stands in the plot.
struct Place {
    panel: i64,
    x: i64,
    y: i64,
}

/// Thousandths, so that equal numbers are one key.
fn key(value: f64) -> i64 {
    (value * 1000.0).round() as i64
}

fn place(scenario: &Concrete) -> Place {
    match *scenario {
        Concrete::CutIn { ego_kmh, gap_m, lateral_mps, .. } => {
            Place { panel: key(ego_kmh), x: key(gap_m), y: key(lateral_mps) }
        }
        Concrete::CutOut { speed_kmh, gap_m, lateral_mps } => {
            Place { panel: key(speed_kmh), x: key(gap_m), y: key(lateral_mps) }
        }
        Concrete::Following { speed_kmh, deceleration_g } => {
            Place { panel: 0, x: key(speed_kmh), y: key(deceleration_g) }
        }
    }
}

/// Names of the axes.
fn axes(grid: Grid) -> [&'static str; 2] {
    match grid {
        Grid::CutInFast | Grid::CutInSlow => ["gap [m]", "lateral speed [m/s]"],
        Grid::CutOut => ["gap to the standing one [m]", "lateral speed [m/s]"],
        Grid::Following => ["speed [km/h]", "deceleration [g]"],
    }
}

/// The plot of a grid.
pub fn svg(grid: Grid, scenarios: &[Concrete], columns: &[Column]) -> String {
    let places: Vec<Place> = scenarios.iter().map(place).collect();
    let ranks = |of: fn(&Place) -> i64| -> BTreeMap<i64, usize> {
        let all: BTreeSet<i64> = places.iter().map(of).collect();
        all.into_iter().enumerate().map(|(rank, key)| (key, rank)).collect()
    };
    let (panels, xs, ys) = (ranks(|place| place.panel), ranks(|place| place.x), ranks(|place| place.y));
    let cell = (PANEL.0 / xs.len().max(1) as f64, PANEL.1 / ys.len().max(1) as f64);
    let width = LEFT + panels.len() as f64 * (PANEL.0 + GAP.0) + 8.0;
    let height = TOP + columns.len() as f64 * (PANEL.1 + GAP.1) + 8.0;
    let [x_name, y_name] = axes(grid);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\" \
         font-family=\"sans-serif\" font-size=\"11\" role=\"img\">\n<title>{name}: where drivers crash</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
         <text x=\"8\" y=\"18\" font-size=\"14\">{name}: where drivers crash</text>\n\
         <text x=\"8\" y=\"34\">x: {x_name}, y: {y_name}; green without a crash, the darker the red, the more of the other's speeds end in one; grey was \
         not run, white not tried</text>\n",
        name = grid.name()
    );
    for (row, column) in columns.iter().enumerate() {
        let top = TOP + row as f64 * (PANEL.1 + GAP.1);
        let _ = writeln!(out, "<text x=\"8\" y=\"{:.0}\">{}</text>", top + 0.5 * PANEL.1, escaped(&column.driver));
        for (&speed, &number) in &panels {
            let left = LEFT + number as f64 * (PANEL.0 + GAP.0);
            let _ = writeln!(
                out,
                "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{}\" height=\"{}\" fill=\"#fff\" stroke=\"#888\"/>",
                PANEL.0, PANEL.1
            );
            if row == 0 && panels.len() > 1 {
                let _ = writeln!(out, "<text x=\"{left:.1}\" y=\"{:.1}\">{} km/h</text>", top - 6.0, speed / 1000);
            }
            ticks(&mut out, [left, top], [&xs, &ys]);
            for (shade, path) in paths(&places, column, speed, [&xs, &ys], cell, [left, top]) {
                let _ = writeln!(out, "<path fill=\"{shade}\" d=\"{path}\"/>");
            }
        }
    }
    out.push_str("</svg>\n");
    out
}

/// First and last number of each axis.
fn ticks(out: &mut String, [left, top]: [f64; 2], [xs, ys]: [&BTreeMap<i64, usize>; 2]) {
    let number = |key: Option<(&i64, &usize)>| key.map_or(0.0, |(&key, _)| key as f64 / 1000.0);
    let (bottom, right) = (top + PANEL.1, left + PANEL.0);
    let (first_x, last_x) = (number(xs.first_key_value()), number(xs.last_key_value()));
    let (first_y, last_y) = (number(ys.first_key_value()), number(ys.last_key_value()));
    let _ = writeln!(
        out,
        "<g fill=\"#555\" font-size=\"9\"><text x=\"{left:.1}\" y=\"{y:.1}\">{first_x}</text>\
         <text x=\"{right:.1}\" y=\"{y:.1}\" text-anchor=\"end\">{last_x}</text>\
         <text x=\"{x:.1}\" y=\"{bottom:.1}\" text-anchor=\"end\">{first_y}</text>\
         <text x=\"{x:.1}\" y=\"{high:.1}\" text-anchor=\"end\">{last_y}</text></g>",
        y = bottom + 10.0,
        x = left - 2.0,
        high = top + 8.0
    );
}

/// By shade, the cells of a panel as one path.
fn paths(
    places: &[Place],
    column: &Column,
    panel: i64,
    [xs, ys]: [&BTreeMap<i64, usize>; 2],
    cell: (f64, f64),
    [left, top]: [f64; 2],
) -> BTreeMap<&'static str, String> {
    // Crashes, and scenarios that were driven.
    let mut cells: BTreeMap<(usize, usize), (usize, usize)> = BTreeMap::new();
    for (place, verdict) in places.iter().zip(&column.verdicts).filter(|(place, _)| place.panel == panel) {
        let counted = cells.entry((ys[&place.y], xs[&place.x])).or_default();
        counted.0 += usize::from(verdict.crashed());
        counted.1 += usize::from(*verdict != Verdict::NotRun);
    }
    let mut paths: BTreeMap<&'static str, String> = BTreeMap::new();
    // Neighbours of one shade are one rectangle: row, first cell, cells.
    let mut run: Option<(&'static str, usize, usize, usize)> = None;
    let mut draw = |(shade, y, x, cells): (&'static str, usize, usize, usize)| {
        let from = (left + x as f64 * cell.0, top + PANEL.1 - (y + 1) as f64 * cell.1);
        let wide = cells as f64 * cell.0;
        let path = paths.entry(shade).or_default();
        let _ = write!(path, "M{:.1} {:.1}h{wide:.2}v{:.2}h-{wide:.2}z", from.0, from.1, cell.1);
    };
    for ((y, x), (crashes, driven)) in cells {
        let shade = if driven == 0 { NOT_RUN } else { SHADES[(crashes * (SHADES.len() - 1)).div_ceil(driven)] };
        run = match run {
            Some((same, row, first, count)) if same == shade && row == y && first + count == x => {
                Some((same, row, first, count + 1))
            }
            other => {
                other.into_iter().for_each(&mut draw);
                Some((shade, y, x, 1))
            }
        };
    }
    run.into_iter().for_each(draw);
    paths
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}
