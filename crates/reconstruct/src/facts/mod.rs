//! The checks of stated facts against a rollout, a file for each kind of fact: `list` names them all, `held` asks. How the crash was staged
//! is not asked, but for the roads, signals and stops of its scenario.

mod acts;
mod astride;
mod contact;
mod edge;
mod held;
mod junction;
pub(crate) mod keeping;
mod lane;
pub(crate) mod list;
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
