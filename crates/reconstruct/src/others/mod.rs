//! Where others than the two stand and drive who have a part in what the ego does, seen from how the two come to the contact.

pub(crate) mod actors;
pub(crate) mod beside;
mod crossing;
mod lane;
mod scene;
pub(crate) mod stand;
