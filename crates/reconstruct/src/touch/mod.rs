//! How two touch: headings, speeds and the zones that meet, searched for what fits what is told.
//!
//! Everything is seen from the road that the ego came along: x ahead, y to its left.

mod bodies;
mod boxes;
mod doors;
mod fit;
mod headings;
pub(crate) mod lanes;
pub(crate) mod opening;
mod roadside;
pub(crate) mod staging;
pub(crate) mod stagings;
pub(crate) mod sweep;
