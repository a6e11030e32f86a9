//! What an account tells, in the terms of a staging: plain data ([`crash::Told`], and the types that it holds), and questions to it that
//! need nothing else. It knows no account, no road and no rollout.

pub(crate) mod aside;
pub(crate) mod astride;
pub(crate) mod choices;
pub(crate) mod crash;
pub(crate) mod doing;
pub(crate) mod edge;
mod kerb;
mod lanes;
pub(crate) mod layout;
pub(crate) mod lies;
pub(crate) mod near;
pub(crate) mod others;
mod passing;
pub(crate) mod phase;
pub(crate) mod queue;
pub(crate) mod rig;
pub(crate) mod side;
pub(crate) mod sizes;
pub(crate) mod speeds;
pub(crate) mod things;
pub(crate) mod times;
mod walk;
pub(crate) mod zones;
