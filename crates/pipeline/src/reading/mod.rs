//! What users give: crash files, scenario files, and what profiles and egos name.

pub(crate) mod accounts;
pub(crate) mod documents;
pub(crate) mod fetching;
pub(crate) mod named;
pub(crate) mod outcomes;
pub(crate) mod records;
pub(crate) mod retelling;
pub(crate) mod scenarios;
