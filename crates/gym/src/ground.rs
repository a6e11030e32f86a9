//! What a scene stands on, seen from above: which cells are road, and which of the ego's route.

use recrash_model::geometry::Vec2;
use recrash_roads::Scenario;

/// Size of a cell of the ground. [m]
const CELL_M: f64 = 0.5;

/// Ground beyond the road on each side. [m]
const MARGIN_M: f64 = 2.0;

/// Most cells of a scene's ground: a square kilometre.
const MOST_CELLS: usize = 4_000_000;

/// What a scene stands on, seen from above.
#[derive(Debug, Clone)]
pub(crate) struct Ground {
    corner: Vec2,
    columns: usize,
    rows: usize,
    cells: Vec<u8>,
}

impl Ground {
    /// Draws the lanes of a scenario.
    pub(crate) fn of(scenario: &Scenario) -> Self {
        let lanes = &scenario.network().lanes;
        let (mut low, mut high) =
            (Vec2::new(f64::INFINITY, f64::INFINITY), Vec2::new(f64::NEG_INFINITY, f64::NEG_INFINITY));
        let points: Vec<(Vec2, u8)> = lanes
            .iter()
            .enumerate()
            .flat_map(|(number, lane)| {
                let on_route = scenario.ego().path.segments.iter().any(|segment| usize::from(segment.lane.0) == number);
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

    pub(crate) fn shade(&self, point: Vec2) -> u8 {
        self.cell(point).map_or(0, |cell| self.cells[cell])
    }
}
