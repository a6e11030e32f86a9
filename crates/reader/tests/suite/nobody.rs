//! Nouns that name nobody beside the two, and those that do.

use crate::common::{self, account_of};
use recrash_model::account::Kind;
use recrash_model::kinds::PartnerKind;
use recrash_model::record::Coded;
use recrash_model::zones::ContactZone;

fn others(text: &str) -> Vec<Kind> {
    account_of(text).expect("an account").others.iter().map(|other| other.kind.value).collect()
}

#[test]
fn one_of_the_two_is_nobody_else() {
    let texts = [
        "The AV was in a minor collision with a commercial vehicle. While the AV was traveling through a parking lot, a van backed out of a \
         parking space. The AV came to a stop and the rear of the van made contact with the front of the AV.",
        "The AV was traveling north. The right mirror of a pickup truck made contact with the autonomous truck's left \
         side mirror.",
        "A van reversed out of a parking space and struck the right side of the AV. The AV came to a stop. In summary, the other car did not give way.",
        "The AV was traveling west in a parking lot when a heavy truck in front of the AV stopped. The heavy truck began to reverse and the rear of \
         the heavy truck's trailer made contact with the front of the AV.",
        "The AV was stopped in the right turn lane to yield to a heavy truck with an oversized trailer. The heavy truck proceeded forward and the \
         right side of the heavy truck made contact with the left side of the AV.",
        "The AV was traveling west when its right front contacted the curb, causing tie rod and cosmetic damage.",
        "The AV was traveling west when a remote controlled toy robot entered the roadway from the right, and the front of the AV made contact with the \
         remote controlled robot.",
    ];
    for text in texts {
        assert_eq!(others(text), [], "{text}");
    }
}

#[test]
fn a_general_remark_names_nobody() {
    let before = "The AV was stopped at a red light on Elm Street when a sedan made contact with the rear of the AV.";
    let remarks = [
        "The airbags did not deploy in either vehicle.",
        "The driver called an ambulance.",
        "There are stop signs that require vehicles to stop before entering the intersection.",
        "The AV had misclassified a speed limit sign as a pedestrian.",
        "This was in preparation for the Automated Valet Parking demonstration.",
        "The passenger of the AV was looking for cross traffic.",
        "There was a truck-mounted sign.",
    ];
    for remark in remarks {
        for text in [format!("{before} {remark}"), format!("{remark} {before}")] {
            assert_eq!(others(&text), [], "{text}");
        }
    }
}

#[test]
fn whom_only_the_headline_calls_so_is_a_vehicle() {
    let text = "The AV was in a collision involving a van on Elm Street. The AV was traveling west on Elm Street and came to a stop behind a \
                double-parked vehicle. A van approached from behind and made contact with the rear of the AV.";
    assert_eq!(others(text), [Kind::Vehicle]);
    let again = "The AV was in a collision involving a van on Elm Street. The AV was traveling west on Elm Street and came to a stop behind a \
                 parked van. Another van approached from behind and made contact with the rear of the AV.";
    assert_eq!(others(again), [Kind::Van]);
}

#[test]
fn what_columns_say_against_the_words_is_said_in_words() {
    let mut told = common::record(
        "1-1",
        1,
        "The AV was stopped at a red light on Elm Street when a pickup truck made contact with the rear of the AV with its front.",
    );
    told.sv_zones = vec![ContactZone::Front, ContactZone::FrontLeft];
    told.partner = Coded::Known(PartnerKind::Pedestrian);
    told.sv_speed_mps = Some(4.0);
    let account = recrash_reader::account(&recrash_reader::incidents(&[told])[0]).expect("an account");
    let said: Vec<_> = account.contradictions.iter().map(|one| (one.kept.as_str(), one.against.as_str())).collect();
    for both in [
        ("rear in words", "front, front left in SV Contact Area"),
        ("stopped in words", "4.0 m/s in SV Precrash Speed (MPH)"),
        ("pickup truck in words", "pedestrian in Crash With"),
    ] {
        assert!(said.contains(&both), "{said:?}");
    }
}

#[test]
fn a_column_speed_that_is_zero_or_is_not_contradicts_a_state_of_the_other_kind() {
    let stopped = "The AV was stopped at a red light on Elm Street when a pickup truck made contact with the rear of the AV with its front.";
    let moving = "The AV was traveling north on Elm Street when a pickup truck behind it made contact with the rear of the AV with its front.";
    for (words, mps, kept) in [
        (stopped, 0.0, None),
        (stopped, 0.5, Some("stopped in words")),
        (stopped, 1.4, Some("stopped in words")),
        (moving, 5.0, None),
        (moving, 0.0, Some("moving in words")),
    ] {
        let mut told = common::record("1-1", 1, words);
        told.sv_speed_mps = Some(mps);
        let account = recrash_reader::account(&recrash_reader::incidents(&[told])[0]).expect("an account");
        let said = account.contradictions.iter().find(|one| one.about == "sv.state");
        assert_eq!(said.map(|one| one.kept.as_str()), kept, "{words} {mps}");
        assert!(account.sv.speeds.iter().any(|speed| speed.value.mps == mps), "it is kept: {:?}", account.sv.speeds);
    }
}

#[test]
fn whom_the_headline_counts_the_story_tells_one_by_one() {
    let text = "The AV was in a collision involving two cars on Elm Street. The AV was stopped on Elm Street. A red sedan approached the AV from behind, and a \
                blue van made contact with the rear of the red sedan. The front of the red sedan then made contact with the rear of the AV.";
    assert_eq!(others(text), [Kind::Van]);
}

#[test]
fn what_stands_behind_a_comma_says_who_it_was() {
    let text = "The AV was traveling east when it was cut off by an oncoming vehicle, a pickup truck heading west. The pickup truck was turning left and \
                the front of the AV made contact with the right side of the pickup truck.";
    assert_eq!(others(text), []);
}

#[test]
fn traffic_that_comes_is_not_what_is_parked() {
    let text = "The AV was stopped to yield to oncoming traffic on Elm Street with parked vehicles on both sides of the street. A van passed the stopped AV and the \
                right side of the van made contact with the left side of the AV.";
    assert_eq!(others(text), [Kind::Vehicle, Kind::Vehicle]);
}

#[test]
fn a_motorcycle_that_only_the_headline_names_is_a_vehicle() {
    let text = "The AV was in a collision involving a motorcycle on Elm Street. The AV slowed to a stop to yield to a vehicle stopped in its lane. A motorcycle \
                approached from behind and made contact with the rear of the AV.";
    assert_eq!(others(text), [Kind::Vehicle]);
}
