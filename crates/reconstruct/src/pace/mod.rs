//! How somebody's speed comes to what it is at the contact, whoever it is: speeds, told backwards from there.

pub(crate) mod last;
pub(crate) mod lead;
pub(crate) mod plain;
