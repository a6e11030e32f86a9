//! What somebody did not do who should have: a stop, a yield.

use super::Reading;
use crate::chunk::Spot;
use crate::frame::Frame;
use crate::lexicon::{Lexicon, Sense};
use crate::world::SUBJECT;
use recrash_model::account::{Act, RoadFeature};

/// What somebody did who did not stop or yield where it should.
pub(super) fn not_done(reading: &Reading<'_>, number: usize, frame: &Frame) -> Option<Act> {
    let stops = matches!(frame.act(), Some(Act::Stop | Act::Slow)) || frame.sense == Sense::Yield;
    if !stops || frame.aside || went_back(reading, number, frame) {
        return None;
    }
    let (first, end) = reading.window(number);
    let named = Lexicon::get().features(&reading.story.tokens[first..end]);
    if named.iter().any(|(feature, ..)| *feature == RoadFeature::StopSign) || goes_past_a_sign(reading, frame) {
        Some(Act::RunStop)
    } else if named.iter().any(|(feature, ..)| *feature == RoadFeature::Signal)
        || drives_in_at_red(reading, number, frame)
    {
        Some(Act::RunRed)
    } else if frame.sense == Sense::Yield || comes_out_so(reading, number, frame) {
        Some(Act::FailToYield)
    } else {
        None
    }
}

/// "came past a stop sign without stopping".
fn goes_past_a_sign(reading: &Reading<'_>, frame: &Frame) -> bool {
    let from = reading.story.sentences[frame.sentence].first.max(frame.first.saturating_sub(7));
    let words: Vec<&str> = reading.story.tokens[from..frame.first].iter().map(|token| token.text.as_str()).collect();
    let past =
        words.windows(4).any(|run| matches!(run, ["past" | "through" | "by", "a" | "the" | "its", "stop", "sign"]));
    frame.act() == Some(Act::Stop) && past && words.last() == Some(&"without")
}

/// "Facing a red signal, it failed to stop and drove into the intersection": the light is told before.
fn drives_in_at_red(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let frames = &reading.story.frames;
    let first = reading.story.sentences[frame.sentence].first;
    let own = |other: &Frame| other.sentence == frame.sentence && other.who == frame.who;
    let others = frames[..number].iter().any(|other| other.sentence == frame.sentence && other.who != frame.who);
    let red = reading.story.tokens[first..frame.first]
        .windows(2)
        .any(|pair| pair[0].text == "red" && matches!(pair[1].text.as_str(), "light" | "signal" | "traffic" | "arrow"));
    let enters = |other: &Frame| {
        own(other) && other.happened() && matches!(other.act(), Some(Act::Enter | Act::Cross | Act::Turn | Act::Follow))
    };
    frame.act() == Some(Act::Stop) && red && !others && frames[number + 1..].iter().any(enters)
}

/// "A van left a lot and, without stopping, turned left", "turned out of an alley without first stopping": where nothing but the road calls for a
/// stop; not "pulled out, struck it, and drove on without stopping".
fn comes_out_so(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let out = |other: &&Frame| {
        let spot = matches!(other.out_of, Some(Spot::Driveway | Spot::Stall | Spot::SideStreet));
        other.happened() && (spot || other.act() == Some(Act::PullOut))
    };
    let goes_on = |other: &&Frame| !out(other) && !matches!(other.act(), None | Some(Act::Turn | Act::Enter));
    let before = reading.story.frames[..number].iter().rev().filter(|before| before.who == frame.who);
    let own = || before.clone().take_while(|before| before.sentence == frame.sentence);
    let others = frame.who.is_some_and(|who| who != SUBJECT) && frame.act() == Some(Act::Stop);
    others && own().take_while(|before| !goes_on(before)).any(|before| out(&before))
}

/// "rolled back from the light, and failed to stop": it did not stop going backwards, and ran nothing.
fn went_back(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let before = reading.story.frames[..number].iter().rev();
    let mut own = before.filter(|before| before.sentence == frame.sentence && before.who == frame.who);
    let last = own.find_map(|before| before.act().filter(|_| before.happened()));
    frame.who.is_some() && matches!(last, Some(Act::Reverse | Act::Roll))
}
