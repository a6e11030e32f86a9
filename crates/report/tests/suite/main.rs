//! Tests of the crate as its users see it, in one binary: a file a subject.

mod browser;
#[path = "../../examples/demo/drive.rs"]
mod drive;
mod golden;
mod hostile;
mod obstacles;
mod retold;
#[path = "../../examples/demo/roads.rs"]
mod roads;
#[path = "../../examples/demo/suite.rs"]
mod suite;
