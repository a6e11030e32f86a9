//! The checks of told facts against a rollout, a file for each kind of fact, and `held` that asks for all. No staging is looked at here.

mod acts;
mod astride;
mod contact;
mod edge;
pub(crate) mod held;
mod junction;
pub(crate) mod keeping;
mod lane;
pub(crate) mod movement;
pub(crate) mod near;
mod origin;
mod phases;
pub(crate) mod seen;
pub(crate) mod signals;
mod state;
pub(crate) mod strays;
mod things;
mod thrown;
