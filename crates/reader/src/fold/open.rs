//! What the words for somebody leave open: its lane, and what kind of truck it is.

use super::{Reading, TRUCK_MAKES};
use crate::chunk::{is_colour, is_determiner};
use crate::frame::Frame;
use crate::lexicon::Lexicon;
use crate::token::word;
use recrash_model::account::{Account, Act, Fact, Kind, LaneWord, Origin, Source, told};

/// The lane of who comes from behind and goes round in that of those who come towards it, where no other is told of it.
pub(super) fn oncoming_lane(reading: &Reading<'_>, account: &Account) -> Option<Fact<LaneWord>> {
    let actor = reading.contacts.partner?;
    let behind = told(&account.came_from) == Some(Origin::Behind);
    if !behind || account.partner.as_ref()?.lane.is_some() {
        return None;
    }
    let tokens = &reading.story.tokens;
    let goes = |frame: &Frame| {
        matches!(frame.act(), Some(Act::Pass | Act::LaneChange | Act::Drift | Act::Swerve | Act::Enter | Act::Cross))
    };
    let mut frames = reading.before(actor).filter(|(_, frame)| frame.happened() && goes(frame));
    frames.find_map(|(number, _)| {
        let (first, end) = reading.window(number);
        (first..end).find_map(|at| {
            let lane = if word(tokens, at + 1) == "traffic" { at + 2 } else { at + 1 };
            let there = matches!(word(tokens, at), "oncoming" | "opposing" | "opposite")
                && word(tokens, lane).starts_with("lane");
            (there && lane < end).then(|| reading.told(LaneWord::Opposing, at, lane + 1))
        })
    })
}

/// Whether the words for somebody name a truck of any size.
pub(super) fn is_any_truck(kind: &Fact<Kind>) -> bool {
    let Source::Words { text, .. } = &kind.source else { return false };
    // Sizes, loads and tasks are of large ones; colours and most makes of any.
    let lexicon = Lexicon::get();
    let make = |word: &str| lexicon.is_make(word) && !TRUCK_MAKES.contains(&word) || lexicon.is_model(word);
    let of_any =
        |word: &&str| is_determiner(word) || is_colour(word) || make(word) || matches!(*word, "another" | "work");
    let text = text.to_lowercase();
    let words: Vec<&str> = text.split(' ').skip_while(of_any).collect();
    let plain = [&["truck"][..], &["commercial", "vehicle"], &["utility", "truck"], &["commercial", "truck"]];
    kind.value == Kind::HeavyTruck && plain.contains(&words.as_slice())
}
