//! How fast, or how hard, something was done.

use super::Reading;
use crate::frame::Frame;
use crate::token::{Token, word};
use recrash_model::account::{Act, Kind, Manner};

/// "braked hard", "reacted with heavy braking", "came to an abrupt stop"; not "stopped on the hard shoulder", "behind a stopped heavy truck".
fn brakes_hard(words: &[Token]) -> bool {
    let brakes =
        |at: usize| ["brak", "stop", "slow", "halt", "decel"].iter().any(|stem| word(words, at).starts_with(stem));
    (0..words.len()).any(|at| match word(words, at) {
        "heavy" | "abrupt" | "sudden" | "emergency" => brakes(at + 1),
        // "behind a suddenly braking van": that one does.
        "heavily" | "abruptly" | "sharply" | "suddenly"
            if at > 0 && matches!(word(words, at - 1), "a" | "an" | "the") && word(words, at + 1).ends_with("ing") =>
        {
            false
        }
        "hard" | "heavily" | "abruptly" | "sharply" | "suddenly" => at > 0 && brakes(at - 1) || brakes(at + 1),
        "slammed" => (at + 1..at + 4).any(brakes),
        _ => false,
    })
}

/// "A pedestrian ran out from between two trucks", "who was jogging": on foot that is fast.
fn runs(reading: &Reading<'_>, frame: &Frame) -> bool {
    const RUNS: [&str; 10] = ["ran", "run", "running", "jog", "sprint", "dash", "dart", "rush", "bolt", "race"];
    let tokens = &reading.story.tokens;
    let Some(known) = frame.who.map(|who| &reading.story.world.actors[who]) else { return false };
    let moves = matches!(frame.act(), Some(Act::Follow | Act::Enter | Act::Cross | Act::PullOut | Act::Swerve));
    let word = tokens[frame.first..frame.end].iter().find(|token| !is_auxiliary(&token.text));
    let runner = known.kind_tokens.is_some_and(|(_, end)| matches!(tokens[end - 1].text.as_str(), "jogger" | "runner"));
    let runs = word.is_some_and(|token| RUNS.iter().any(|run| token.text.starts_with(run)));
    known.kind == Some(Kind::Pedestrian) && moves && (runs || runner)
}

/// Words before a verb.
fn is_auxiliary(word: &str) -> bool {
    matches!(word, "was" | "were" | "is" | "had" | "has" | "been" | "then" | "suddenly" | "who" | "quickly")
}

/// "slowly proceeded", "approached at a high rate of speed", "braked hard", "ran into the street".
pub(super) fn manner(reading: &Reading<'_>, number: usize) -> Option<Manner> {
    const SLOW: [&str; 3] = ["slow", "low", "walking"];
    const FAST: [&str; 5] = ["high", "extreme", "excessive", "fast", "rapid"];
    let (frames, tokens) = (&reading.story.frames, &reading.story.tokens);
    let frame = &frames[number];
    let sentence = reading.story.sentences[frame.sentence];
    let end = frames[number + 1..].iter().find(|next| next.first > frame.first).map_or(sentence.end, |next| next.first);
    // "an extreme rate of speed", "at a high speed", "at walking pace".
    let speed = |at: usize, of: &[&str]| {
        of.contains(&word(tokens, at))
            && (at + 1..end.min(at + 4)).any(|next| matches!(word(tokens, next), "speed" | "speeds" | "pace"))
    };
    let mut words = frame.first.saturating_sub(MANNER_BEFORE).max(sentence.first)..end.min(sentence.end);
    let around = &tokens[words.start..words.end.max(words.start)];
    let brakes = matches!(frame.act(), Some(Act::Slow | Act::Stop));
    if brakes && brakes_hard(around) {
        return Some(Manner::Fast);
    }
    if runs(reading, frame) {
        return Some(Manner::Fast);
    }
    words.find_map(|at| match word(tokens, at) {
        // "touched the slowly moving van".
        "slowly" if !frame.is_contact() || at < frame.first => Some(Manner::Slow),
        // "moved forward slightly".
        "slightly" if at > frame.first && tokens[frame.first..at].iter().any(|token| token.text == "forward") => {
            Some(Manner::Slow)
        }
        // "was slowing when a speeding van hit it".
        "speeding" if at >= frame.first && !brakes => Some(Manner::Fast),
        "rapidly" | "quickly" if frame.act() == Some(Act::Follow) => Some(Manner::Fast),
        _ if at > frame.first && speed(at, &SLOW) => Some(Manner::Slow),
        _ if at > frame.first && speed(at, &FAST) && !brakes => Some(Manner::Fast),
        _ => None,
    })
}

/// How it was done stands right before a verb, or behind it. [tokens]
const MANNER_BEFORE: usize = 1;
