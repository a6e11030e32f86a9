//! Changes of lanes, and what is none.

use super::Reading;
use super::sides::lane_entered;
use crate::frame::Frame;
use crate::lexicon::{Progress, Sense};
use crate::token::Token;
use crate::world::SUBJECT;
use recrash_model::account::{Act, Kind};

/// "entered the left turn lane", of who drove along before: it changed lanes. Out of a place beside the road, or from a crossing one,
/// it comes into a lane by that.
pub(super) fn enters_a_lane(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let Some(who) = frame.who else { return false };
    let Some((first, lane)) = lane_entered(reading, frame) else { return false };
    let words = &reading.story.tokens[first..lane];
    let oncoming = |token: &Token| matches!(token.text.as_str(), "oncoming" | "opposing" | "opposite" | "slip");
    let wheels = reading.story.world.actors[who].kind.is_none_or(Kind::is_vehicle);
    let came = |(_, before): (usize, &Frame)| {
        matches!(before.act(), Some(Act::Follow | Act::Slow | Act::Accelerate)) && before.happened()
    };
    let elsewhere = |(_, before): (usize, &Frame)| {
        let act = before.act();
        before.out_of.is_some()
            || matches!(
                act,
                Some(Act::PullOut | Act::Cross | Act::Turn | Act::UTurn | Act::Reverse | Act::Hold | Act::Pass)
            )
    };
    let before = || reading.before(who).take_while(|(other, _)| *other < number);
    // "entered the right turn lane and turned right": on its way to the turn.
    let turns = reading.before(who).any(|(other, later)| other > number && later.act() == Some(Act::Turn));
    let placed = !reading.story.world.actors[who].relations.is_empty();
    // "crossed the line and entered the AV's lane".
    let owned = reading.story.tokens[lane - 1].text == "'s";
    let drifts = |(_, before): (usize, &Frame)| before.act() == Some(Act::Drift) && before.happened();
    let own = |actor: usize| reading.story.world.actors[actor].heading.map(|(heading, ..)| heading);
    let same_way = own(who).zip(own(SUBJECT)).is_none_or(|(one, other)| one == other);
    let drove = match owned {
        true => same_way && (before().any(drifts) || placed && (before().any(came) || comes_over(reading, lane))),
        false => before().any(came) || placed && who != SUBJECT,
    };
    wheels && !turns && !words.iter().any(oncoming) && drove && frame.out_of.is_none() && !before().any(elsewhere)
}

/// "entered into the AV's lane from the right", on a road of which no junction is told: out of the lane there.
fn comes_over(reading: &Reading<'_>, lane: usize) -> bool {
    let tokens = &reading.story.tokens;
    let from = lane + 1 + 2 * usize::from(tokens.get(lane + 2).is_some_and(|next| next.text == "travel"));
    let words: Vec<&str> = tokens[from.min(tokens.len())..].iter().take(4).map(|token| token.text.as_str()).collect();
    let side =
        matches!(words.as_slice(), ["from", "the" | "its", "left" | "right", next] if !matches!(*next, "side" | "of"));
    let road = |word: &str| {
        let junction = matches!(word, "intersection" | "junction" | "sign" | "light" | "signal");
        junction || matches!(word, "driveway" | "lot" | "alley" | "curb")
    };
    side && !tokens[..reading.until().min(tokens.len())].iter().any(|token| road(&token.text))
}

/// "A van entered the left lane of Elm Street", "left the kerb, and as it was entering the right lane": it came onto the road there, out of no
/// lane beside that.
pub(super) fn comes_onto_a_lane(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let Some(who) = frame.who.filter(|_| reading.story.tokens[frame.first].text.starts_with("enter")) else {
        return false;
    };
    let known = &reading.story.world.actors[who];
    let placed = !known.relations.is_empty() || known.lane.is_some_and(|(_, first, _)| first < frame.first);
    let before = || reading.before(who).take_while(|(other, _)| *other < number).map(|(_, frame)| frame);
    let drove = before().any(|before| {
        before.happened()
            && matches!(before.act(), Some(Act::Follow | Act::Slow | Act::Accelerate | Act::LaneChange | Act::Drift))
    });
    // "was stopped at the curb, and proceeded to merge".
    let from_kerb = before().any(|before| {
        let (first, end) = (before.first, reading.story.sentences[before.sentence].end);
        let kerb = |at: usize| matches!(reading.story.tokens[at].text.as_str(), "curb" | "curbside");
        before.act().is_some_and(Act::stands) && (first..end.min(first + KERB_WITHIN)).any(kerb)
    });
    from_kerb || !placed && !drove
}

/// "was stopped facing north at the south curb": the kerb stands so near behind the verb. [tokens]
const KERB_WITHIN: usize = 8;

/// "was stopped at a yield sign, attempting to merge": it waited for that.
pub(super) fn waits_to_change(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let from = reading.story.sentences[frame.sentence].first.max(frame.first.saturating_sub(2));
    let attempts = reading.story.tokens[from..frame.first].iter().any(|token| token.text == "attempting");
    let changes = frame.act() == Some(Act::LaneChange) && frame.progress == Progress::Tried;
    let Some(who) = frame.who.filter(|_| attempts && changes) else { return false };
    let last = reading.before(who).take_while(|(other, _)| *other < number).map(|(_, frame)| frame).last();
    last.is_some_and(|last| last.sentence == frame.sentence && last.act() == Some(Act::Hold))
}

/// "While attempting a merge onto Elm Street, it stopped to give way": from one road onto another, which is no change of lanes, and was still
/// to come.
pub(super) fn is_about_to_merge(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let Some(who) = frame.who else { return false };
    let tokens = &reading.story.tokens;
    let end = reading.story.sentences[frame.sentence].end.min(frame.first + MERGE_WITHIN);
    let clause: Vec<&str> =
        tokens[frame.first..end].iter().map(|token| token.text.as_str()).take_while(|word| *word != ",").collect();
    let merge = clause.iter().position(|word| word.starts_with("merg"));
    let Some(behind) = merge.map(|merge| &clause[merge + 1..]) else { return false };
    let road = matches!(behind.first(), Some(&("onto" | "into")))
        && !behind.iter().any(|word| matches!(*word, "lane" | "lanes" | "traffic" | "gap" | "space" | "path" | "'s"));
    let waits = |frame: &Frame| {
        let stops = frame.act().is_some_and(Act::stands) || frame.sense == Sense::Yield;
        stops && frame.happened()
    };
    road && reading.before(who).any(|(later, frame)| later > number && waits(frame))
}

/// A merge and the road onto which it leads stand within so many words. [tokens]
const MERGE_WITHIN: usize = 12;
