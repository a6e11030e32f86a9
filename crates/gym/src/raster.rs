//! A picture from above: the ego looks up in it, and stands in its middle column, a quarter of its height above the bottom.

use crate::kinematics::{EgoFrame, Thing, others, thing};
use crate::scene::Scene;
use recrash_model::geometry::Vec2;
use recrash_sim::Observation;

/// Channels of a picture: ground (0 off the road, 128 road, 255 the route's lanes) and road users (255; 128 obstacles).
pub const CHANNELS: usize = 2;

/// Size of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Raster {
    /// Rows, and columns.
    pub pixels: usize,
    /// Size of a pixel. [m]
    pub pixel_m: f64,
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
