//! How the partner came to where it touches, and who touched it first: courses and speeds, told backwards from the contact.

mod beside;
mod lateral;
mod line;
mod pace;
pub(crate) mod plan;
mod thrown;
mod turns;
