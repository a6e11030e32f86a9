//! Files: written whole or not at all, never in the place of an input, read with a bound.

pub(crate) mod caches;
pub(crate) mod folders;
pub(crate) mod json;
pub(crate) mod output;
pub(crate) mod paths;
pub(crate) mod store;
