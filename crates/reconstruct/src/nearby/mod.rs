//! Where others stand and drive who have no part in what the ego does, and those with one who do not fit where they are put first: in the
//! first place that shows what is told of them, where they hinder nobody.

mod along;
mod aside;
mod deeds;
mod hinders;
pub(crate) mod placed;
mod scene;
mod several;
mod tried;
mod way;
