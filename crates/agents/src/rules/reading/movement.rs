//! What each of the two was doing just before they met: the column, unless the narrative plainly says otherwise.

use super::super::actors::Actor;
use super::super::pattern::Pattern;
use super::{MEETING, Relation, Sentence, told_turns};
use recrash_model::template::Movement;

/// Words about the state of motion. Who is "slowing to a stop" still rolls; who is "stopped for" somebody does not.
static STATE: Pattern = Pattern::new(concat!(
    r"(?i)\b(?:(?P<parked>(?:legally |illegally |double[- ])?parked)",
    r"|(?P<stood>(?:was|were|been|is|remain(?:ed|ing)|fully|while|being|had|already|previously|completely)",
    r"(?: \w+ly| already| also)? stopped",
    r"|stopped (?:at|for|in|behind|and|facing|before|due|on|to|because|with|waiting|while|short|again|directly|prior)",
    r"|(?:came|come|slowed|braked|brought|decelerated)(?: \w+ly| itself| down)? to an? (?:\w+ ){0,2}?(?:stop|halt)",
    r"|stopped$|stopped[,.]|stationary|at rest|at an? (?:complete |full )?(?:stop|standstill)",
    r"|(?:remained|was|while) (?:\w+ )?waiting)",
    r"|(?P<back>revers(?:ed|es|ing)|back(?:ed|ing)(?: up| out| into)?|in reverse)",
    r"|(?P<go>began|begun|start(?:ed|ing)|proceed\w*|continu\w+|accelerat\w+|resum\w+|inch\w+|crept|creep\w*",
    r"|advanc\w+|mov(?:ed|ing)|enter(?:ed|ing)|travel\w*|driv(?:ing|en)|drove|set off|pull(?:ed|ing) \w+",
    r"|pass(?:ed|ing)|turn(?:ed|ing) (?:left|right)|made|making|merg(?:ed|ing)|chang(?:ed|ing) lanes|overt\w+",
    r"|approach(?:ed|ing)|cross(?:ed|ing)|swerv\w+|edg(?:ed|ing)|roll(?:ed|ing)))\b",
));

/// Before a mention: the one mentioned stands.
static STANDING_BEFORE: Pattern = Pattern::new(r"(?i)\b(?:stationary|stopped|parked|standing|motionless)(?: \w+)?\s*$");

/// The beginning of a sentence that goes back.
static BEFORE: Pattern = Pattern::new(
    r"(?i)^(?:prior to|before|at the time of|moments? before|just before|immediately before|leading up to)\b",
);

/// What makes a meeting's subject the one that was met.
static PASSIVE_BEFORE: Pattern = Pattern::new(r"(?i)\b(?:was|were|been|being|got|is)(?: \w+ly)? $");

static PASSING: Pattern = Pattern::new(
    r"(?i)\b(?:(?:attempt\w* to|tried to|trying to|began to) (?:pass|overtake|go around)|pass(?:ed|ing)(?: by)?|overtook|overtaking|went around|drove around|maneuver\w* around)\b",
);
/// A state of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Parked,
    Stood,
    Backed,
    Went,
}

/// What the narrative says of one actor before the two met.
#[derive(Debug, Default)]
struct Story {
    last: Option<State>,
    /// It met the other actively (`made contact with`), so it moved.
    met: bool,
}

/// The movement of an actor: `column`, unless the narrative's plain words are others.
pub(super) fn movement(
    sentences: &[Sentence],
    actor: Actor,
    column: Option<Movement>,
    relation: Option<Relation>,
) -> Option<Movement> {
    use Movement::{Backing, LeftTurn, Parked, Passing, RightTurn, Stopped, Straight};
    let story = story(sentences, actor);
    let other = if actor == Actor::Sv { Actor::Cp } else { Actor::Sv };
    let beside = matches!(relation, None | Some(Relation::Beside(_) | Relation::Behind));
    if matches!(column, None | Some(Straight)) && beside && actor == Actor::Cp && passes(sentences, actor, other) {
        return Some(Passing);
    }
    let stands = matches!(story.last, Some(State::Stood | State::Parked)) && !(actor == Actor::Cp && story.met);
    match (column, story.last) {
        (Some(Straight | LeftTurn | RightTurn), _) if stands => return Some(Stopped),
        (Some(Straight) | None, Some(State::Backed)) => return Some(Backing),
        (None, Some(State::Parked)) if stands => return Some(Parked),
        (None, Some(State::Stood)) if stands => return Some(Stopped),
        _ => {}
    }
    let (left, right, straight) = told_turns(before_they_met(sentences), actor);
    match column {
        Some(Straight | Passing) | None if !straight && left != right => Some(if left { LeftTurn } else { RightTurn }),
        Some(column) => Some(column),
        None if straight => Some(Straight),
        None => None,
    }
}

/// The sentences up to the first that tells the meeting.
fn before_they_met<'s, 't>(sentences: &'s [Sentence<'t>]) -> &'s [Sentence<'t>] {
    let meets = |sentence: &Sentence| MEETING.find_iter(sentence.text).any(|found| tells_meeting(sentence, &found));
    &sentences[..sentences.iter().position(meets).map_or(sentences.len(), |met| met + 1)]
}

fn story(sentences: &[Sentence], actor: Actor) -> Story {
    let mut story = Story::default();
    let mut met = false;
    for sentence in sentences {
        // After the meeting, only what goes back before it.
        met &= !BEFORE.is_match(sentence.text);
        if met {
            continue;
        }
        let meeting = MEETING.find_iter(sentence.text).find(|found| tells_meeting(sentence, found));
        let until = meeting.map_or(sentence.text.len(), |found| found.start());
        for found in STATE.captures_iter(sentence.text) {
            let whole = found.get_match();
            let after = &sentence.text[whole.end()..];
            if whole.start() >= until || after.starts_with(" sign") {
                continue;
            }
            if sentence.mentions.subject_at(whole.start()) != Some(actor) {
                continue;
            }
            story.last = Some(if found.name("parked").is_some() {
                State::Parked
            } else if found.name("stood").is_some() {
                State::Stood
            } else if found.name("back").is_some() {
                State::Backed
            } else {
                State::Went
            });
        }
        let Some(meeting) = meeting else { continue };
        let passive = PASSIVE_BEFORE.is_match(&sentence.text[..meeting.start()]);
        story.met = !passive && sentence.mentions.subject_at(meeting.start()) == Some(actor);
        if sentence.mentions.starts(actor).any(|at| STANDING_BEFORE.is_match(&sentence.text[..at])) {
            story.last = Some(State::Stood);
        }
        met = true;
    }
    story
}

/// Whether a word of meeting tells of this one: not "a rear-end collision", which sums up.
fn tells_meeting(sentence: &Sentence, found: &regex::Match) -> bool {
    let after = sentence.text[found.end()..].trim_start();
    let sums_up = ["collision", "crash", "accident"].iter().any(|noun| after.starts_with(noun));
    !sums_up && sentence.mentions.meets_at(found.start())
}

/// Whether the narrative says that one passed the other, before or when they met.
fn passes(sentences: &[Sentence], actor: Actor, other: Actor) -> bool {
    before_they_met(sentences).iter().any(|sentence| {
        PASSING.find_iter(sentence.text).any(|found| {
            let passes_by = sentence.mentions.subject_at(found.start()) == Some(actor)
                && sentence.mentions.object_after(found.end()) == Some(other);
            // "a passing truck"
            passes_by
                || (found.as_str() == "passing" && sentence.mentions.starts(actor).any(|at| at == found.end() + 1))
        })
    })
}
