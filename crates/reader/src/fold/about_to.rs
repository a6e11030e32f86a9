//! To which side somebody is told to be about to turn.

use super::Reading;
use super::sides::side_of;
use crate::frame::Frame;
use crate::lexicon::Progress;
use crate::world::Actor;
use recrash_model::account::{Act, ActFact, Fact, LeftRight};

/// "waiting to make an unprotected left turn", "in preparation for a left turn": of who is not told to have begun a turn.
pub(super) fn turns_next(reading: &Reading<'_>, actor: Actor, acts: &[ActFact]) -> Option<Fact<LeftRight>> {
    let turns = |fact: &ActFact| fact.act.turns() && !fact.after_contact;
    if acts.iter().any(turns) {
        return None;
    }
    let meant = reading
        .before(actor)
        .filter(|(_, frame)| frame.progress == Progress::Wished && !frame.negated && frame.act() == Some(Act::Turn));
    let sided = meant.filter(|(_, frame)| !goes_straight_instead(reading, frame)).filter_map(|(number, frame)| {
        Some(Fact { value: side_of(reading, actor, number, Act::Turn)?, source: reading.of(frame) })
    });
    sided.last().or_else(|| waits_for_arrow(reading, actor))
}

/// "planned to turn left, but the lane was full, so it continued straight".
fn goes_straight_instead(reading: &Reading<'_>, frame: &Frame) -> bool {
    let behind = reading.story.tokens.get(frame.end..reading.story.sentences[frame.sentence].end).unwrap_or_default();
    let but = behind.iter().position(|token| matches!(token.text.as_str(), "but" | "however" | "instead"));
    but.is_some_and(|but| behind[but..].iter().any(|token| matches!(token.text.as_str(), "straight" | "instead")))
}

/// "was waiting for the left turn arrow": what is told of somebody last before these words is told of who waits.
fn waits_for_arrow(reading: &Reading<'_>, actor: Actor) -> Option<Fact<LeftRight>> {
    let story = &reading.story;
    let until = reading.until().min(story.tokens.len());
    (0..until).find_map(|at| {
        let side = match story.word(at) {
            "left" => LeftRight::Left,
            "right" => LeftRight::Right,
            _ => return None,
        };
        let arrow = at + 1 + usize::from(story.word(at + 1) == "turn");
        let waits = (at.saturating_sub(4)..at).any(|at| story.word(at) == "for") && story.word(arrow) == "arrow";
        let frame = story.frames.iter().filter(|frame| frame.first <= at).max_by_key(|frame| frame.first)?;
        let sentence = &story.sentences[frame.sentence];
        let own = frame.who == Some(actor) && (sentence.first..sentence.end).contains(&at);
        (waits && own).then(|| reading.told(side, at, arrow + 1))
    })
}
