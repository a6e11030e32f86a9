//! The scenario of a staging: both of the two, the others, the road, and its signals and signs.

mod lights;
pub(crate) mod scenario;
pub(crate) mod signals;
