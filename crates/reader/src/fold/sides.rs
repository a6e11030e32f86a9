//! To which side an act goes.

use super::Reading;
use crate::frame::{Frame, sided};
use crate::lexicon::{Form, Sense};
use crate::token::word;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, ActFact, LaneWord, LeftRight};
use recrash_model::template::Movement;

/// To which side an act goes: as told with it, else by the lane that it leads into or begins in, else by the column.
pub(super) fn side_of(reading: &Reading<'_>, actor: Actor, number: usize, act: Act) -> Option<LeftRight> {
    let frame = &reading.story.frames[number];
    let told =
        || frame.side.or_else(|| to_lane(reading, actor, frame, act)).or_else(|| to_that_lane(reading, frame, act));
    let turn_lane = || match reading.story.world.actors[actor].lane?.0 {
        LaneWord::LeftTurn => Some(LeftRight::Left),
        LaneWord::RightTurn => Some(LeftRight::Right),
        _ => None,
    };
    let changes = act == Act::LaneChange;
    let entered = || if changes { side_of_lane_entered(reading, frame) } else { None };
    let signalled = || if moves_over(act) || act == Act::Turn { side_signalled(reading, frame) } else { None };
    let goes_on = || if changes { side_as_before(reading, number) } else { None };
    let passes = || if changes { side_of_pass(reading, number) } else { None };
    let side = if sided(act) { told().or_else(entered).or_else(signalled) } else { None };
    let kerb = || if changes { away_from_the_kerb(reading, actor, frame) } else { None };
    let meant = || if changes { as_signaled(reading, actor, frame) } else { None };
    let cuts_in = || if changes { side_of_cut_in(reading, number) } else { None };
    let side = side.or_else(goes_on).or_else(passes).or_else(meant).or_else(kerb).or_else(cuts_in);
    let turn_meant = || if act == Act::Turn { side_meant(reading, number) } else { None };
    side.or_else(turn_meant)
        .or_else(|| into_turn_lane(reading, actor, frame, act))
        .or_else(|| if act == Act::Turn { turn_lane() } else { None })
        .or_else(|| turned_by_column(reading, actor, act))
}

/// "cut into the AV's lane. The AV swerved left": it goes the way that the AV then goes to get out of its way.
fn side_of_cut_in(reading: &Reading<'_>, number: usize) -> Option<LeftRight> {
    let frame = &reading.story.frames[number];
    if frame.who == Some(SUBJECT) || frame.object != Some(SUBJECT) {
        return None;
    }
    let evades = |(other, later): &(usize, &Frame)| {
        *other > number
            && later.sentence <= frame.sentence + 1
            && later.act().is_some_and(Act::leaves_line)
            && later.happened()
    };
    reading.before(SUBJECT).find(evades).and_then(|(_, later)| later.side)
}

/// "slowed to turn left. As it began this turn, ...": to the side of the turn that was meant or begun before.
fn side_meant(reading: &Reading<'_>, number: usize) -> Option<LeftRight> {
    let frames = &reading.story.frames;
    let frame = &frames[number];
    let turns = |other: &&Frame| other.who == frame.who && other.act() == Some(Act::Turn) && !other.negated;
    let last = frames[..number].iter().rfind(turns)?;
    // Who comes out of a lot turns onto the road by that.
    let out = |other: &Frame| other.who == frame.who && (other.act() == Some(Act::PullOut) || other.out_of.is_some());
    last.side.filter(|_| frame.sentence <= last.sentence + 2 && !frames[..number].iter().any(out))
}

/// Acts that lead over to a side of the way.
const fn moves_over(act: Act) -> bool {
    matches!(act, Act::LaneChange | Act::Drift | Act::PullOut)
}

/// "put on its left turn signal and began to change lanes": the side for which it had signalled, with nothing done between.
fn side_signalled(reading: &Reading<'_>, frame: &Frame) -> Option<LeftRight> {
    let (tokens, frames) = (&reading.story.tokens, &reading.story.frames);
    let first = reading.story.sentences[frame.sentence.saturating_sub(1)].first;
    let lamp = |at: &usize| matches!(word(tokens, *at), "signal" | "indicator" | "blinker" | "blinkers" | "indicators");
    let at = (first + 2..frame.first).rev().find(lamp)?;
    let side = (at - 2..at).find_map(|at| match word(tokens, at) {
        "left" => Some(LeftRight::Left),
        "right" => Some(LeftRight::Right),
        _ => None,
    })?;
    let of_signal = frames.iter().rfind(|other| other.first <= at)?;
    let between = |other: &Frame| other.first > at && other.first < frame.first && other.act().is_some();
    let own = of_signal.who == frame.who && of_signal.sense == Sense::Other && of_signal.happened();
    (own && !frames.iter().any(between)).then_some(side)
}

/// "signalled to change lanes to the right turn lane. While changing lanes, ...", "continued to change lanes", "moved to the left to change
/// lanes": to the side told before.
fn side_as_before(reading: &Reading<'_>, number: usize) -> Option<LeftRight> {
    let (tokens, frames) = (&reading.story.tokens, &reading.story.frames);
    let frame = &frames[number];
    let word = |back: usize| frame.first.checked_sub(back).map_or("", |at| tokens[at].text.as_str());
    let meanwhile = word(1) == "while" && frame.form == Form::Ing;
    // "while changing lanes back" goes to the other one.
    let back = tokens[frame.first..(frame.end + 2).min(tokens.len())].iter().any(|token| token.text == "back");
    let goes_on = !back && (meanwhile || (1..3).any(|back| word(back).starts_with("continu")));
    let over = |other: &&Frame| {
        other.who == frame.who && other.side.is_some() && !other.negated && other.act().is_some_and(moves_over)
    };
    let purpose = word(1) == "to"
        && number.checked_sub(1).is_some_and(|last| over(&&frames[last]) && frames[last].sentence == frame.sentence);
    frames[..number].iter().rfind(over).filter(|_| goes_on || purpose)?.side
}

/// "attempted to change lanes and pass to the left of it": to the side on which it passes.
fn side_of_pass(reading: &Reading<'_>, number: usize) -> Option<LeftRight> {
    let frame = &reading.story.frames[number];
    let next = reading.story.frames.get(number + 1)?;
    let same = next.sentence == frame.sentence && next.who == frame.who && next.act() == Some(Act::Pass);
    next.side.filter(|_| same && next.happened())
}

/// "with its left turn signal on to change lanes. While changing lanes, it stopped": to the side that it had signaled.
fn as_signaled(reading: &Reading<'_>, actor: Actor, frame: &Frame) -> Option<LeftRight> {
    let from = reading.story.sentences[frame.sentence.saturating_sub(1)].first;
    let words: Vec<&str> = reading.story.tokens[from..frame.first].iter().map(|token| token.text.as_str()).collect();
    let (at, side) = words.windows(3).enumerate().rev().find_map(|(at, run)| match run {
        ["its", side @ ("left" | "right"), "turn" | "signal" | "indicator" | "blinker"] => Some((from + at, *side)),
        _ => None,
    })?;
    // Of whom that sentence tells.
    let sentence = reading.story.sentences.iter().rposition(|sentence| sentence.first <= at);
    let of_subject =
        |other: &Frame| other.who == Some(SUBJECT) && Some(other.sentence) == sentence && other.first <= at;
    let own = actor == SUBJECT && reading.story.frames.iter().any(of_subject);
    match Some(side).filter(|_| own && frame.form == Form::Ing)? {
        "left" => Some(LeftRight::Left),
        _ => Some(LeftRight::Right),
    }
}

/// "A coupe traveling along the curb entered the next lane": the lanes are on its left.
fn away_from_the_kerb(reading: &Reading<'_>, actor: Actor, frame: &Frame) -> Option<LeftRight> {
    let along = reading.before(actor).take_while(|(_, before)| before.first < frame.first).any(|(number, before)| {
        let (first, end) = reading.window(number);
        let words = &reading.story.tokens[first..end.min(frame.first).max(first)];
        let curb = words.windows(3).any(|run| {
            run[0].text == "along" && run[1].text == "the" && matches!(run[2].text.as_str(), "curb" | "curbside")
        });
        // "along the curb on the left side of the street".
        let left = words.iter().any(|token| token.text == "left");
        curb && !left && before.act() == Some(Act::Follow)
    });
    (along && actor != SUBJECT).then_some(LeftRight::Left)
}

/// "moved right, and then recentered itself": back to the other side.
pub(super) fn back_to_the_middle(
    reading: &Reading<'_>,
    frame: &Frame,
    act: Act,
    before: &[ActFact],
) -> Option<LeftRight> {
    let words = &reading.story.tokens[frame.first..frame.end];
    let has = |word: &str| words.iter().any(|token| token.text.starts_with(word));
    let middle = has("recenter") || (has("center") || has("middle")) && !has("line") && !has("cross");
    let aside = |fact: &&ActFact| fact.act.leaves_line();
    let last = before.iter().rfind(aside)?;
    last.side.map(LeftRight::other).filter(|_| middle && act == Act::Drift)
}

/// "began to move toward that lane": the lane that was named last.
fn to_that_lane(reading: &Reading<'_>, frame: &Frame, act: Act) -> Option<LeftRight> {
    let tokens = &reading.story.tokens;
    let end = reading.story.sentences[frame.sentence].end.min(frame.end + 4);
    let that = (frame.first..end)
        .any(|at| tokens[at].text == "that" && tokens.get(at + 1).is_some_and(|next| next.text == "lane"));
    if !that || !matches!(act, Act::Drift | Act::LaneChange) {
        return None;
    }
    let from = reading.story.sentences[frame.sentence.saturating_sub(1)].first;
    (from..frame.first).rev().filter(|at| tokens[*at].text == "lane").find_map(|lane| {
        tokens[lane.saturating_sub(3)..lane].iter().find_map(|token| match token.text.as_str() {
            "left" | "leftmost" => Some(LeftRight::Left),
            "right" | "rightmost" => Some(LeftRight::Right),
            _ => None,
        })
    })
}

/// The tokens from a verb of entering up to the lane that is entered.
pub(super) fn lane_entered(reading: &Reading<'_>, frame: &Frame) -> Option<(usize, usize)> {
    const NAMES: [&str; 16] = [
        "turn",
        "turning",
        "bike",
        "bicycle",
        "bus",
        "center",
        "left",
        "right",
        "leftmost",
        "rightmost",
        "number",
        "singular",
        "adjacent",
        "next",
        "second",
        "third",
    ];
    let end = reading.story.sentences[frame.sentence].end.min(frame.first + LANE_WITHIN);
    let stops = |at: &usize| {
        matches!(reading.story.word(*at), "," | "and" | "intersection" | "junction" | "from" | "at" | "of" | "as")
    };
    let lane = (frame.first + 1..end).take_while(|at| !stops(at)).find(|&at| reading.story.word(at) == "lane")?;
    let partly = frame.first.checked_sub(1).is_some_and(|at| matches!(reading.story.word(at), "partially" | "partly"));
    // "entered the AV's lane".
    let named =
        reading.story.word(lane - 1) == "'s" || (frame.first..lane).any(|at| NAMES.contains(&reading.story.word(at)));
    (named && !partly).then_some((frame.first, lane))
}

/// The name of a lane that is entered is no longer, with the verb. [tokens]
const LANE_WITHIN: usize = 10;

/// The side of a lane that is entered: that of a turn lane, which lies outside, or as told behind it.
fn side_of_lane_entered(reading: &Reading<'_>, frame: &Frame) -> Option<LeftRight> {
    let (first, lane) = lane_entered(reading, frame)?;
    let end = reading.story.sentences[frame.sentence].end.min(lane + 5);
    let (at, side) = (first..end).find_map(|at| match reading.story.word(at) {
        "left" | "leftmost" => Some((at, LeftRight::Left)),
        "right" | "rightmost" | "bike" | "bicycle" | "bus" => Some((at, LeftRight::Right)),
        _ => None,
    })?;
    // "entered the AV's lane from the right": to the left.
    let from = at > lane + 2 && reading.story.word(at - 2) == "from";
    Some(if from { side.other() } else { side })
}

/// The side to which the subject vehicle changed lanes, by the column, when it "proceeded into the right turn lane".
fn into_turn_lane(reading: &Reading<'_>, actor: Actor, frame: &Frame, act: Act) -> Option<LeftRight> {
    let column = reading.record.sv_movement.known() == Some(Movement::ChangingLanes);
    if act != Act::Enter || actor != SUBJECT || !column || !frame.happened() {
        return None;
    }
    let words: Vec<&str> =
        reading.story.tokens[frame.first..frame.end].iter().map(|token| token.text.as_str()).collect();
    let has = |word: &str| words.contains(&word);
    match (has("turn") && has("lane"), has("left"), has("right")) {
        (true, true, false) => Some(LeftRight::Left),
        (true, false, true) => Some(LeftRight::Right),
        _ => None,
    }
}

/// The side of a lane change that is told by lanes: from the left lane into the centre.
fn to_lane(reading: &Reading<'_>, actor: Actor, frame: &Frame, act: Act) -> Option<LeftRight> {
    if !matches!(act, Act::LaneChange | Act::Drift) {
        return None;
    }
    // A lane that is told behind it is not the one that it left.
    if let Some(side) = lane_on_a_side(reading, frame) {
        return Some(side);
    }
    let own =
        reading.story.world.actors[actor].lane.filter(|(_, first, _)| *first < frame.first).map(|(lane, ..)| lane);
    let into = frame.lane.map(|(lane, ..)| lane);
    match (own, into) {
        (Some(LaneWord::Left), Some(LaneWord::Center)) => Some(LeftRight::Right),
        (Some(LaneWord::Right), Some(LaneWord::Center)) => Some(LeftRight::Left),
        (_, Some(LaneWord::Opposing)) => Some(LeftRight::Left),
        _ => None,
    }
}

/// "pulled into the lane on its left".
fn lane_on_a_side(reading: &Reading<'_>, frame: &Frame) -> Option<LeftRight> {
    let end = reading.story.sentences[frame.sentence].end.min(frame.end + 4);
    let words: Vec<&str> =
        reading.story.tokens[frame.first..end.max(frame.first)].iter().map(|token| token.text.as_str()).collect();
    words.windows(4).find_map(|run| match run {
        ["lane", "on" | "to", "its" | "the", "left"] => Some(LeftRight::Left),
        ["lane", "on" | "to", "its" | "the", "right"] => Some(LeftRight::Right),
        _ => None,
    })
}

/// The side of a turn that only the column tells.
fn turned_by_column(reading: &Reading<'_>, actor: Actor, act: Act) -> Option<LeftRight> {
    let own = reading.record.sv_movement.known().filter(|_| actor == SUBJECT);
    let other = reading.record.cp_movement.known().filter(|_| Some(actor) == reading.contacts.partner);
    match own.or(other).filter(|_| act == Act::Turn)? {
        Movement::LeftTurn => Some(LeftRight::Left),
        Movement::RightTurn => Some(LeftRight::Right),
        _ => None,
    }
}
