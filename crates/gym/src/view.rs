//! What a driver is shown.

use crate::ground::Ground;
use crate::kinematics::{EgoFrame, FIELDS_ALWAYS, FIELDS_OF_OTHER, MOST_NEIGHBOURS, write_always, write_nearest};
use crate::raster::Raster;
use crate::rays::Rays;
use crate::scene::Scene;
use recrash_sim::Observation;

/// What a driver is shown in every step.
#[derive(Debug, Clone, PartialEq)]
pub enum View {
    /// [`FIELDS_ALWAYS`], then [`FIELDS_OF_OTHER`] of so many others, the nearest first.
    Kinematic {
        /// How many, at most [`MOST_NEIGHBOURS`].
        neighbours: usize,
    },
    /// [`FIELDS_ALWAYS`], then the rays' distances, then their speeds.
    Rays(Rays),
    /// [`FIELDS_ALWAYS`], and a picture from above.
    Raster(Raster),
}

/// What no view can be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ViewError {
    /// Too many or no neighbours.
    #[error("{0} neighbours: a view has 1 to {MOST_NEIGHBOURS}")]
    Neighbours(usize),
    /// Too many or no rays, or rays that reach nowhere.
    #[error("{0} rays that reach {1} m: a view has 1 to 1024 that reach 1 to 1000 m")]
    Rays(usize, f64),
    /// A picture that is none.
    #[error("{0} pixels of {1} m: a picture has 8 to 512 in each row, each of 0.05 to 10 m")]
    Raster(usize, f64),
}

impl View {
    /// Checks its numbers.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self) -> Result<(), ViewError> {
        match self {
            Self::Kinematic { neighbours } if !(1..=MOST_NEIGHBOURS).contains(neighbours) => {
                Err(ViewError::Neighbours(*neighbours))
            }
            Self::Rays(rays) if !(1..=1024).contains(&rays.count()) || !(1.0..=1000.0).contains(&rays.range_m) => {
                Err(ViewError::Rays(rays.count(), rays.range_m))
            }
            Self::Raster(raster) if !(8..=512).contains(&raster.pixels) || !(0.05..=10.0).contains(&raster.pixel_m) => {
                Err(ViewError::Raster(raster.pixels, raster.pixel_m))
            }
            _ => Ok(()),
        }
    }

    /// How many numbers it has.
    pub fn numbers(&self) -> usize {
        FIELDS_ALWAYS.len()
            + match self {
                Self::Kinematic { neighbours } => neighbours * FIELDS_OF_OTHER.len(),
                Self::Rays(rays) => 2 * rays.count(),
                Self::Raster(_) => 0,
            }
    }

    /// How many bytes its picture has.
    pub fn bytes(&self) -> usize {
        if let Self::Raster(raster) = self { raster.bytes() } else { 0 }
    }

    /// Draws what the view needs of a scene beforehand.
    pub(crate) fn prepare(&self, scene: &mut Scene) {
        if matches!(self, Self::Raster(_)) && scene.ground.is_none() {
            scene.ground = Some(Ground::of(&scene.scenario));
        }
    }

    pub(crate) fn write(&self, scene: &Scene, observation: &Observation<'_>, numbers: &mut [f32], bytes: &mut [u8]) {
        let frame = EgoFrame::of(observation);
        let (always, rest) = numbers.split_at_mut(FIELDS_ALWAYS.len());
        write_always(scene, observation, &frame, always);
        match self {
            Self::Kinematic { .. } => write_nearest(scene, observation, &frame, rest),
            Self::Rays(rays) => rays.write(scene, observation, &frame, rest),
            Self::Raster(raster) => raster.write(scene, observation, &frame, bytes),
        }
    }
}
