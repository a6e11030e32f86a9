//! How the ego comes to the contact: its speeds and its plan. How the partner does is in `partner`, above how they touch.

pub(crate) mod pace;
pub(crate) mod plan;
