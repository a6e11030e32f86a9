//! Reconstructions of mini narratives, and what sabotage does to them.

mod across;
mod acts;
mod as_told;
mod astride;
mod between;
#[path = "../../../reader/tests/suite/common.rs"]
#[allow(dead_code, reason = "the reader's own tests use the rest")]
mod common;
mod courses;
mod doors;
mod drives;
mod earlier;
mod ego_way;
mod going_first;
mod in_step;
mod kerb;
mod lanes;
mod left_behind;
mod moves;
mod near;
mod near_deeds;
mod others;
mod own_way;
mod places;
mod places_of_others;
mod queues;
mod roads_left;
mod roadside;
mod sabotage;
mod speeds;
mod steps;
mod steps_between;
mod stories;
mod strips;
mod sweeps;
mod task;
mod things;
mod third_users;
mod walks;
mod ways;
mod who_was_first;
