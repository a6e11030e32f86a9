//! The road around a crash: drawn from what is told of the place, with the ego's lane along the x axis.

mod arms;
pub(crate) mod drawn;
mod junction;
mod lanes;
pub(crate) mod pieces;
mod places;
pub(crate) mod way;
