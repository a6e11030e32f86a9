//! A picture from above: the ego looks up in it, and stands in its middle column, a quarter of its height above the bottom.

use crate::kinematics::{EgoFrame, Thing, others, thing};
use crate::scene::Scene;
use recrash_model::geometry::Vec2;
use recrash_sim::Observation;

/// Channels of a picture: ground (0 off the road, 128 road, 255 the route's lanes) and road users (255; 128 obstacles).
pub const CHANNELS: usize = 2;

/// Size of a cell of the ground. [m]
const CELL_M: f64 = 0.5;

/// Ground beyond the road on each side. [m]
const MARGIN_M: f64 = 2.0;

/// Most cells of a scene's ground: a square kilometre.
const MOST_CELLS: usize = 4_000_000;

/// Size of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Raster {
    /// Rows, and columns.
    pub pixels: usize,
    /// Size of a pixel. [m]
    pub pixel_m: f64,
}

/// What a scene stands on, seen from above.
#[derive(Debug, Clone)]
pub(crate) struct Ground {
    corner: Vec2,
    columns: usize,
    rows: usize,
    cells: Vec<u8>,
}

impl Ground {
    /// Draws the lanes of a scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        let lanes = &scene.scenario.network().lanes;
        let (mut low, mut high) =
            (Vec2::new(f64::INFINITY, f64::INFINITY), Vec2::new(f64::NEG_INFINITY, f64::NEG_INFINITY));
        let points: Vec<(Vec2, u8)> = lanes
            .iter()
            .enumerate()
            .flat_map(|(number, lane)| {
                let on_route =
                    scene.scenario.ego().path.segments.iter().any(|segment| usize::from(segment.lane.0) == number);
                let shade = if on_route { 255 } else { 128 };
                let along = (lane.length_m / (0.8 * CELL_M)).ceil() as usize;
                (0..=along).flat_map(move |step| {
                    let s_m = (step as f64 * 0.8 * CELL_M).min(lane.length_m);
                    let half_m = 0.5 * lane.width_at(s_m);
                    let across = (2.0 * half_m / (0.8 * CELL_M)).ceil().max(1.0) as usize;
                    (0..=across).map(move |side| {
                        (lane.position(s_m, -half_m + 2.0 * half_m * side as f64 / across as f64), shade)
                    })
                })
            })
            .collect();
        for (point, _) in &points {
            (low.x, low.y) = (low.x.min(point.x), low.y.min(point.y));
            (high.x, high.y) = (high.x.max(point.x), high.y.max(point.y));
        }
        let corner = low - Vec2::new(MARGIN_M, MARGIN_M);
        let size = high - corner + Vec2::new(MARGIN_M, MARGIN_M);
        let columns = ((size.x / CELL_M).ceil().max(1.0) as usize).min(MOST_CELLS);
        let rows = ((size.y / CELL_M).ceil().max(1.0) as usize).min((MOST_CELLS / columns).max(1));
        let mut ground = Self { corner, columns, rows, cells: vec![0; columns * rows] };
        for (point, shade) in points {
            if let Some(cell) = ground.cell(point) {
                ground.cells[cell] = ground.cells[cell].max(shade);
            }
        }
        ground
    }

    fn cell(&self, point: Vec2) -> Option<usize> {
        let place = (point - self.corner) * (1.0 / CELL_M);
        if place.x < 0.0 || place.y < 0.0 {
            return None;
        }
        let (column, row) = (place.x as usize, place.y as usize);
        (column < self.columns && row < self.rows).then(|| row * self.columns + column)
    }

    fn shade(&self, point: Vec2) -> u8 {
        self.cell(point).map_or(0, |cell| self.cells[cell])
    }
}

impl Raster {
    /// Bytes of a picture.
    pub(crate) const fn bytes(&self) -> usize {
        CHANNELS * self.pixels * self.pixels
    }

    /// Where the middle of a pixel is in the ego's frame: rows from the top, columns from the left. [m]
    fn place(&self, row: usize, column: usize) -> Vec2 {
        let (pixels, row, column) = (self.pixels as f64, row as f64 + 0.5, column as f64 + 0.5);
        Vec2::new(0.75 * pixels - row, 0.5 * pixels - column) * self.pixel_m
    }

    pub(crate) fn write(&self, scene: &Scene, observation: &Observation<'_>, frame: &EgoFrame, out: &mut [u8]) {
        let (ground, users) = out.split_at_mut(self.pixels * self.pixels);
        match &scene.ground {
            None => ground.fill(0),
            Some(drawn) => {
                let (ego, forward) = (observation.states[0].position(), observation.forward(0));
                let across = forward.left() * -self.pixel_m;
                for (row, shades) in ground.chunks_exact_mut(self.pixels).enumerate() {
                    let first = self.place(row, 0);
                    let mut point = ego + forward * first.x + forward.left() * first.y;
                    for shade in shades {
                        *shade = drawn.shade(point);
                        point = point + across;
                    }
                }
            }
        }
        users.fill(0);
        let reach_m = self.pixel_m * self.pixels as f64;
        others(scene, observation, |least_m, number| {
            if least_m < reach_m {
                let shade = if usize::from(number) < scene.outlines.len() { 255 } else { 128 };
                self.paint(&thing(scene, observation, number), frame, shade, users);
            }
        });
    }

    /// Paints a box: every pixel whose middle lies in it, and the one with its centre.
    fn paint(&self, thing: &Thing, frame: &EgoFrame, shade: u8, users: &mut [u8]) {
        let outline = &thing.outline;
        let (centre, axis) = (frame.seen(outline.centre), frame.turned(outline.axis));
        let (half, pixels) = (0.5 * self.pixels as f64, self.pixels as f64);
        let (row, column) = (0.75 * pixels - centre.x / self.pixel_m, half - centre.y / self.pixel_m);
        let reach = outline.radius() / self.pixel_m + 1.0;
        let range = |at: f64| (at - reach).clamp(0.0, pixels) as usize..(at + reach).clamp(0.0, pixels) as usize;
        for row in range(row) {
            for column in range(column) {
                let apart = self.place(row, column) - centre;
                if apart.dot(axis).abs() <= outline.half_length && apart.cross(axis).abs() <= outline.half_width {
                    users[row * self.pixels + column] = shade;
                }
            }
        }
        if (0.0..pixels).contains(&row) && (0.0..pixels).contains(&column) {
            users[row as usize * self.pixels + column as usize] = shade;
        }
    }
}
