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

/// Who backs into a space ahead, for whom the ego stops, and who is told only to stand there.
fn parks(does: &str) -> (f64, String) {
    let text = format!(
        "The AV was traveling eastbound on Elm Street and came to a stop behind a van that was {does}. A car approached from behind and the \
         front of the car made contact with the rear of the stationary AV."
    );
    let shown = made(&told(&text));
    let (lead, ego) = (crate::others::track(&shown, "lead"), shown.rollout.ego_track());
    let last = crate::ways::before_contact(&shown);
    (ego.states[last].y - lead.states[last].y, lead.kind.label().to_owned())
}

#[test]
fn a_van_that_backs_into_a_space_stands_there_beside_the_lane() {
    let ((aside_m, kind), (in_lane_m, _)) = (parks("backing into a parking space"), parks("stopped in the lane"));
    assert_eq!(kind, "van");
    assert!(aside_m > 1.0 && in_lane_m.abs() < 0.5, "{aside_m}, {in_lane_m}");
}
