//! Who is in front of the subject vehicle by the words at its name: the cars in front, the line in which it drives, whom it goes past.

use super::Reading;
use super::origin::Clues;
use crate::frame::Frame;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Fact, Kind, Origin};

/// The first of these that says so.
pub(super) fn ahead(clues: &Clues<'_>, queue: Option<(usize, usize)>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let (first, end) = reading.story.world.actors[actor].kind_tokens?;
    if !reading.story.world.actors[actor].kind.is_some_and(Kind::is_vehicle) {
        return None;
    }
    let told = |(first, end): (usize, usize)| reading.told(Origin::Ahead, first, end);
    let run = named_in_front(reading, (first, end))
        .or_else(|| queue.and_then(|queue| line_driven_in(reading, queue)))
        .or_else(|| traffic_driven_in(reading, (first, end)))
        .or_else(|| gone_past(reading, actor, (first, end)));
    run.map(told)
}

/// "waiting for the cars in front to clear the junction", "as the van ahead had stopped"; not "the van in front of the bus".
fn named_in_front(reading: &Reading<'_>, (first, end): (usize, usize)) -> Option<(usize, usize)> {
    let length = match (reading.story.word(end), reading.story.word(end + 1)) {
        ("in", "front") => 2,
        ("directly" | "immediately" | "just", "ahead") => 2,
        ("ahead", _) => 1,
        _ => return None,
    };
    let of = matches!(reading.story.word(end + length), "of" | "'s");
    (!of && is_told_of_subject(reading, first)).then_some((first, end + length))
}

/// "was driving behind a line of slow traffic", "was eastbound in a line of cars".
fn line_driven_in(reading: &Reading<'_>, (from, end): (usize, usize)) -> Option<(usize, usize)> {
    let word = |at: usize| reading.story.word(at);
    let article = usize::from(from > 0 && matches!(word(from - 1), "a" | "the" | "this" | "that" | "long"));
    let before = from.checked_sub(1 + article).map_or("", word);
    let along = matches!(before, "in" | "behind" | "within" | "with");
    let elsewhere =
        (end..end + LANE_WITHIN).any(|at| matches!(word(at), "adjacent" | "next" | "oncoming" | "opposing"));
    (along && !elsewhere && is_told_of_subject(reading, from)).then_some((from, end))
}

/// Words that say in which lane a line is stand so near behind it. [tokens]
const LANE_WITHIN: usize = 4;

/// "was moving with dense traffic", "keeping pace with surrounding traffic": that in which it drives; not "waited for a gap in traffic".
fn traffic_driven_in(reading: &Reading<'_>, (first, end): (usize, usize)) -> Option<(usize, usize)> {
    let small = |at: usize| {
        let quality = matches!(
            reading.story.word(at),
            "dense" | "heavy" | "moderate" | "light" | "slow" | "surrounding" | "other"
        );
        quality
            || matches!(reading.story.word(at), "the" | "flow" | "of" | "rush" | "hour" | "moving" | "free" | "flowing")
    };
    let from = (first.saturating_sub(TRAFFIC_WITHIN)..first).rev().find(|at| !small(*at))?;
    let there = matches!(reading.story.word(from), "in" | "with" | "within" | "amid")
        && reading.story.word(end - 1) == "traffic";
    let gap =
        from > 0 && matches!(reading.story.word(from - 1), "gap" | "break" | "opening" | "space" | "lull" | "hole");
    let drives = |frame: &Frame| !matches!(frame.act(), Some(Act::LaneChange | Act::PullOut | Act::Enter | Act::Turn));
    let own = frame_over(reading, first).is_none_or(|frame| frame.who == Some(SUBJECT) && drives(frame));
    let along = (first..end).all(|at| small(at) || reading.story.word(at) == "traffic");
    (there && along && !gap && own).then_some((from, end))
}

/// Such words stand so near before the traffic. [tokens]
const TRAFFIC_WITHIN: usize = 6;

/// "changed lanes in order to get ahead of a bus that was slowing": that was before it in its lane. Who stands is looked at elsewhere.
fn gone_past(reading: &Reading<'_>, actor: Actor, (first, end): (usize, usize)) -> Option<(usize, usize)> {
    let article = usize::from(first > 0 && matches!(reading.story.word(first - 1), "a" | "an" | "the"));
    let at = first.checked_sub(article)?;
    let past = |at: usize| match (reading.story.word(at.saturating_sub(2)), reading.story.word(at.saturating_sub(1))) {
        ("ahead", "of") => Some(2),
        (_, "around" | "round" | "past") => Some(1),
        _ => None,
    };
    let goes = at.checked_sub(past(at)? + 2).is_some_and(|to| {
        reading.story.word(to) == "to"
            && matches!(reading.story.word(to + 1), "get" | "go" | "move" | "drive" | "pull" | "steer" | "maneuver")
    });
    let leaves = |(_, frame): (usize, &Frame)| {
        frame.act() == Some(Act::LaneChange)
            && frame.first < first
            && reading.story.sentences[frame.sentence].end > first
    };
    let stands = |act: Act| act.rests();
    let still = reading.before(actor).filter_map(|(_, frame)| frame.act()).any(stands);
    (goes && !still && reading.before(SUBJECT).any(leaves)).then_some((first, end))
}

/// Whether the clause in which a token stands is of the subject vehicle.
pub(super) fn is_told_of_subject(reading: &Reading<'_>, at: usize) -> bool {
    frame_over(reading, at).is_some_and(|frame| frame.who == Some(SUBJECT))
}

/// The frame in whose words a token stands.
fn frame_over<'a>(reading: &'a Reading<'_>, at: usize) -> Option<&'a Frame> {
    let over = |(number, frame): &(usize, &Frame)| {
        let (begins, ends) = reading.window(*number);
        !frame.aside && (begins..ends).contains(&at)
    };
    reading.story.frames.iter().enumerate().filter(over).map(|(_, frame)| frame).next_back()
}
