//! As many of them are there as are told.

use crate::others::told;
use crate::ways::made;
use recrash_model::rollout::ActorTrack;

fn queue_of(words: &str) -> String {
    format!(
        "The AV was stopped behind {words} at a red light on Elm Street. A van approached from behind and the front of the van made \
         contact with the rear of the stationary AV."
    )
}

/// So many are told by these words, and each stands apart from the others.
fn drawn(words: &str, id: &str) -> usize {
    let shown = made(&told(&queue_of(words)));
    let them: Vec<&ActorTrack> = shown.rollout.actors.iter().filter(|track| track.id.starts_with(id)).collect();
    for (number, one) in them.iter().enumerate() {
        let apart = |other: &&ActorTrack| (other.states[0].x - one.states[0].x).abs() > one.length_m;
        assert!(them[..number].iter().all(apart), "{words}");
    }
    them.len()
}

#[test]
fn three_cars_are_three_and_one_is_one() {
    assert_eq!(drawn("a car", "lead"), 1);
    assert_eq!(drawn("two cars", "lead"), 2);
    assert_eq!(drawn("three other cars", "lead"), 3);
    assert_eq!(drawn("several cars", "lead"), 3);
}
