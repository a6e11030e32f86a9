//! Any text at all: the reader ends, in time that grows about as the text does, and every source stands in the text.

use crate::common::{account_of, each_source};
use proptest::prelude::*;

/// Words that the grammar takes apart, in any order.
const WORDS: [&str; 65] = [
    "the",
    "a",
    "AV",
    "van",
    "SUV",
    "it",
    "its",
    "that",
    "who",
    "was",
    "stopped",
    "struck",
    "by",
    "and",
    ",",
    ".",
    "(Vehicle 2)",
    "behind",
    "in front of",
    "to the left of",
    "rear",
    "front",
    "passenger side",
    "of",
    "'s",
    "bumper",
    "made contact with",
    "began to",
    "attempted to",
    "did not",
    "before",
    "after",
    "while",
    "when",
    "turn left",
    "turning",
    "reversing",
    "out of",
    "a parking stall",
    "northbound",
    "west",
    "left lane",
    "red light",
    "stop sign",
    "[XXX]",
    "[REDACTED",
    "25 mph",
    "25mph",
    "driver",
    "opened the",
    "door",
    "towing",
    "trailer",
    "pushed",
    "into",
    "another",
    "other",
    "Honda",
    "at",
    "with",
    "contact",
    "was made",
    "collision",
    "\u{2019}s",
    "\u{e9}",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn words_in_any_order_are_read(picks in prop::collection::vec(0..WORDS.len(), 1..120)) {
        let text = picks.iter().map(|pick| WORDS[*pick]).collect::<Vec<_>>().join(" ");
        if let Some(account) = account_of(&text) {
            let json = serde_json::to_value(&account).unwrap();
            each_source(&json, &mut |words| {
                let (start, end) = (words["start"].as_u64().unwrap() as usize, words["end"].as_u64().unwrap() as usize);
                assert_eq!(&text[start..end], words["text"].as_str().unwrap());
            });
        }
    }

    #[test]
    fn any_characters_are_read(text in "\\PC{0,300}") {
        let _ = account_of(&text);
    }

    #[test]
    fn the_same_text_gives_the_same_account(picks in prop::collection::vec(0..WORDS.len(), 1..60)) {
        let text = picks.iter().map(|pick| WORDS[*pick]).collect::<Vec<_>>().join(" ");
        prop_assert_eq!(account_of(&text), account_of(&text));
    }
}

#[test]
fn a_speed_may_be_the_last_word() {
    let account = account_of("A van struck the rear of the AV, which was traveling at 25mph").expect("an account");
    assert_eq!(account.sv.speeds.len(), 1);
}

#[test]
fn a_text_a_hundred_times_as_long_ends() {
    let sentence = "While the AV was stopped behind a van that was towing a trailer, an SUV approached it from behind and its \
front left made contact with the rear of the AV before it began to turn left onto northbound Elm Street. ";
    for text in
        [sentence.repeat(400), "the ".repeat(60_000), "(".repeat(50_000), "rear ".repeat(50_000), "[".repeat(50_000)]
    {
        let _ = account_of(&text);
    }
}
