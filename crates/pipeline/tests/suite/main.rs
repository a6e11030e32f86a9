//! Tests of the crate as its users see it, in one binary: a file a subject.

mod external_ego;
mod full_disk;
mod parity;
mod pictures;
mod remaking;
