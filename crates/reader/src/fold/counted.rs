//! The act of a frame as it counts in the account: "proceeded" of one that stood is setting off.

use super::Reading;
use super::across::is_behind_begin;
use super::flashback;
use super::lanes::{comes_onto_a_lane, enters_a_lane, is_about_to_merge, waits_to_change};
use super::manner::manner;
use super::sides::lane_entered;
use super::speeds::is_of_last_contact;
use super::undone::not_done;
use crate::chunk::{Joint, Spot};
use crate::frame::Frame;
use crate::lexicon::{Form, Progress, Relation, Sense};
use crate::token::{Token, word};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, KindGroup, Manner};
use recrash_model::template::Movement;

/// The act of a frame, as it counts in the account, where the last one counted so.
pub(super) fn act_of(reading: &Reading<'_>, number: usize, frame: &Frame, so_far: Option<Act>) -> Option<Act> {
    if frame.negated {
        return not_done(reading, number, frame);
    }
    if went_by(reading, number, frame) {
        return Some(Act::Pass);
    }
    if frame.progress == Progress::Wished {
        return None;
    }
    // "When the light turned green, a car that was facing south proceeded": it stood.
    let faces = frame.sense == Sense::Face && turned_green(reading, frame);
    if faces && last_act(reading, number, frame, |_| true).is_none() {
        return Some(Act::Hold);
    }
    if yields_in_motion(reading, number, frame) {
        return Some(Act::Slow);
    }
    let act = frame.act()?;
    (!tells_no_act(reading, number, frame, act)).then(|| as_it_counts(reading, number, frame, act, so_far))
}

/// Whether a frame tells where or how somebody was, or the same once more, and nothing that it did then.
fn tells_no_act(reading: &Reading<'_>, number: usize, frame: &Frame, act: Act) -> bool {
    let told = match act {
        Act::Follow => {
            is_told_again(reading, number, frame)
                || is_of_a_lane(reading, frame)
                || in_headline(reading, frame)
                || is_of_last_contact(reading, frame.sentence)
                || names_mode(reading, number, frame)
        }
        Act::Enter => {
            // "turned left, entering the leftmost lane": with the turn.
            let with_turn =
                lane_entered(reading, frame).is_some() && moved_in_sentence(reading, number) == Some(Act::Turn);
            // "exited the intersection": of others it is where they had been.
            let exits = reading.story.tokens[frame.first].text.starts_with("exit");
            with_turn || exits && frame.who != Some(SUBJECT)
        }
        Act::LaneChange => is_about_to_merge(reading, number, frame) || comes_onto_a_lane(reading, number, frame),
        // "Its front wheel came off": it did not fall itself.
        Act::Fall => frame.who == Some(SUBJECT) && frame.with.is_some() && reading.doer(frame) == Some(SUBJECT),
        Act::Slow => {
            let moved = || last_act(reading, number, frame, |_| true);
            avoids(reading, frame) && moved().is_some_and(Act::stands)
        }
        _ => false,
    };
    told || waits_to_change(reading, number, frame)
}

/// What an act is by what went before, and by the words behind it.
fn as_it_counts(reading: &Reading<'_>, number: usize, frame: &Frame, act: Act, so_far: Option<Act>) -> Act {
    // "proceeded forward out of a stall".
    let comes_out = matches!(frame.out_of, Some(Spot::Stall | Spot::Driveway | Spot::Curb));
    match act {
        // "began to back up, moving into the AV's lane": on its way back.
        Act::LaneChange if frame.form == Form::Ing && moved_in_sentence(reading, number) == Some(Act::Reverse) => {
            Act::Drift
        }
        Act::Enter | Act::Follow if enters_illegally(reading, frame) => Act::RunRed,
        // "A dog came out from between two cars": no vehicle that leaves a place of its own.
        Act::PullOut if frame.who.is_some_and(|who| is_animal(reading, who)) => Act::Enter,
        Act::Enter if enters_a_lane(reading, number, frame) => Act::LaneChange,
        Act::Follow | Act::SetOff | Act::Drift if comes_out => Act::PullOut,
        Act::Follow if sets_off(reading, number, frame) => Act::SetOff,
        Act::Accelerate if leaves_rest(reading, frame) => Act::SetOff,
        Act::SetOff => of_setting_off(reading, number, frame, so_far),
        Act::Pass if passes_nobody(reading, frame) => Act::Follow,
        act => act,
    }
}

/// The words of a narrative from a frame on, written small.
fn words_from(reading: &Reading<'_>, frame: &Frame) -> String {
    reading.text[reading.story.tokens[frame.first].start..].to_lowercase()
}

/// Whether who is told to drive set off with that.
fn sets_off(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let words = words_from(reading, frame);
    goes_on_from_a_stand(reading, number, frame, &words)
        || sets_off_at_green(reading, number, frame)
        || leaves_rest(reading, frame)
        || sets_off_with_subject(reading, frame, &words)
        || last_act(reading, number, frame, |_| true).is_none() && goes_at_green(reading, frame, &words)
}

/// What "began to go" tells: of one that moved already, that it went on.
fn of_setting_off(reading: &Reading<'_>, number: usize, frame: &Frame, so_far: Option<Act>) -> Act {
    let moved = last_act(reading, number, frame, |_| true);
    // Who came along, or "began to proceed straight on", and was "beginning to enter" did not stand.
    let came = moved == Some(Act::Follow) || matches!(so_far, Some(Act::Follow | Act::Enter));
    if came && words_from(reading, frame).chars().take(24).collect::<String>().contains("enter") {
        return if enters_a_lane(reading, number, frame) { Act::LaneChange } else { Act::Enter };
    }
    // "It drove up on green and began to proceed through the junction": so it went on.
    if begins_to_go_on(reading, number, frame) || drives_already(reading, number, frame) {
        return Act::Follow;
    }
    match moved {
        _ if !gains_speed(reading, number, frame) => Act::SetOff,
        // "shifted into reverse and began to accelerate": still backwards.
        Some(Act::Reverse) => Act::Reverse,
        _ => Act::Accelerate,
    }
}

/// "into the lane in which it was driving": where, and nothing that it does then.
fn is_of_a_lane(reading: &Reading<'_>, frame: &Frame) -> bool {
    let tokens = &reading.story.tokens;
    let from = reading.story.sentences[frame.sentence].first.max(frame.first.saturating_sub(7));
    let words: Vec<&str> = tokens[from..frame.first].iter().map(|token| token.text.as_str()).collect();
    words.windows(3).any(|run| run == ["lane", "in", "which"]) && frame.form == Form::Ing
}

/// What somebody did last before a frame, in the same sentence.
fn moved_in_sentence(reading: &Reading<'_>, number: usize) -> Option<Act> {
    let frame = &reading.story.frames[number];
    let own = |other: &&Frame| other.who == frame.who && other.act().is_some() && other.happened();
    let before = reading.story.frames[..number].iter().rev().take_while(|other| other.sentence == frame.sentence);
    before.filter(own).find_map(Frame::act)
}

/// "It proceeded a little and stopped. While it was proceeding, a van behind it did so too": what it did before it stopped.
fn is_told_again(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let Some(who) = frame.who else { return false };
    let tokens = &reading.story.tokens;
    let was = frame.first > 0 && tokens[frame.first - 1].text == "was";
    let stem = |frame: &Frame| tokens[frame.first].text.get(..5).map(str::to_owned);
    let before: Vec<&Frame> = reading
        .before(who)
        .take_while(|(other, _)| *other < number)
        .map(|(_, frame)| frame)
        .filter(|frame| frame.happened())
        .collect();
    let same = before.iter().rposition(|before| stem(before) == stem(frame) && before.sentence < frame.sentence);
    let stopped = same.is_some_and(|same| before[same..].iter().any(|frame| frame.act() == Some(Act::Stop)));
    was && stopped && frame.joint == Some(Joint::While) && frame.form == Form::Ing
}

/// "attempted to avoid a collision": who stood could not brake.
pub(super) fn avoids(reading: &Reading<'_>, frame: &Frame) -> bool {
    reading.story.tokens[frame.first..frame.end].iter().any(|token| token.text.starts_with("avoid"))
}

/// "It merged into the right lane to pass a van, and began to merge back": it had gone by the van then.
pub(super) fn went_by(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    if frame.act() != Some(Act::Pass) || frame.negated || frame.who != Some(SUBJECT) {
        return false;
    }
    let changes = |frame: &Frame| frame.act() == Some(Act::LaneChange) && frame.happened();
    let main = reading.before(SUBJECT).filter(|(before, _)| *before < number).last().map(|(_, frame)| frame);
    let out = main.filter(|main| main.sentence == frame.sentence && changes(main));
    let Some(out) = out.filter(|_| frame.first > 0 && reading.story.tokens[frame.first - 1].text == "to") else {
        return false;
    };
    let words = |frame: &Frame| {
        let end = reading.story.sentences[frame.sentence].end.min(frame.end + 3);
        reading.story.tokens[frame.first..end].iter().any(|token| token.text == "back")
    };
    let returns = |(later, frame): (usize, &Frame)| {
        let other_side = frame.side.zip(out.side).is_some_and(|(back, out)| back != out);
        later > number && changes(frame) && (other_side || words(frame))
    };
    reading.before(SUBJECT).any(returns)
}

/// "It was turning, and began to accelerate", "shifted into reverse and began to accelerate": who moved gained speed, and did not set off.
pub(super) fn gains_speed(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let moves = |act: Act| matches!(act, Act::Follow | Act::Turn | Act::LaneChange | Act::Accelerate | Act::Reverse);
    let tokens = &reading.story.tokens;
    let says = |end: usize, stem: &str| tokens[frame.first..end].iter().any(|token| token.text.starts_with(stem));
    let last = last_act(reading, number, frame, |_| true);
    // "It reversed, and then began to accelerate forward".
    let forward = last == Some(Act::Reverse) && says((frame.end + 2).min(tokens.len()), "forward");
    frame.act() == Some(Act::SetOff) && says(frame.end, "accelerat") && !forward && last.is_some_and(moves)
}

/// Whether who drove along began to proceed "straight" or "through", and nothing told since had made it stand.
pub(super) fn begins_to_go_on(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let goes = (frame.first..frame.end)
        .any(|at| ["proceed", "continu", "driv"].iter().any(|stem| reading.story.word(at).starts_with(stem)));
    let on = goes
        && (reading.story.word(frame.end - 1) == "straight"
            || matches!(reading.story.word(frame.end), "straight" | "through"));
    let waits = |(other, before): (usize, &Frame)| other < number && before.sense == Sense::Yield && before.happened();
    let waited = reading.before(SUBJECT).any(waits);
    // Of others less is told: they may have stood.
    frame.who == Some(SUBJECT)
        && on
        && !waited
        && !turned_green(reading, frame)
        && last_act(reading, number, frame, |_| true) == Some(Act::Follow)
}

/// "moved to the right and began to travel along the curb": who drives already does not set off.
pub(super) fn drives_already(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let words: Vec<&str> =
        reading.story.tokens[frame.first..frame.end].iter().map(|token| token.text.as_str()).collect();
    let begins = words.first().is_some_and(|word| ["beg", "start"].iter().any(|stem| word.starts_with(stem)));
    let goes = words.iter().any(|word| ["travel", "driv", "proceed"].iter().any(|stem| word.starts_with(stem)));
    let Some(who) = frame.who.filter(|_| begins && goes && !turned_green(reading, frame)) else { return false };
    let before = reading.before(who).take_while(|(other, _)| *other < number).map(|(_, other)| other);
    let tells = |other: &&Frame| other.act().is_some() || other.sense == Sense::Yield;
    let last = before.filter(tells).last();
    last.is_some_and(|last| {
        let moves = matches!(last.act(), Some(Act::Drift | Act::LaneChange | Act::Turn | Act::Pass | Act::Swerve));
        moves && last.happened() && last.sentence == frame.sentence
    })
}

/// "It turned, and yielded to a man": who gives way to somebody and had not slowed since it drove has slowed for that.
fn yields_in_motion(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    // "began to yield to it"; "failed to yield" and "waited to yield" are none.
    let does = frame.form != Form::Base || frame.happened() && is_behind_begin(reading, frame);
    let to = frame.object.filter(|to| frame.sense == Sense::Yield && does && Some(*to) != frame.who);
    let slows = |act: Option<Act>| matches!(act, Some(Act::Stop | Act::Hold | Act::Slow | Act::Park | Act::PullOver));
    // "slowing and moving at 2 mph, yielding to it": told with the act itself.
    let same = |other: &&Frame| other.sentence == frame.sentence && other.who == frame.who && other.happened();
    let told = reading.story.frames.iter().filter(same).any(|other| slows(other.act()));
    let last = last_act(reading, number, frame, |_| true);
    // "traveling at a low speed, yielding to a queue": it was slow already.
    let creeps = frame.who.is_some_and(|who| {
        let before = reading.before(who).take_while(|(other, _)| *other < number).last();
        before.is_some_and(|(_, before)| {
            let word = reading.story.tokens[before.first].text.as_str();
            before.sentence == frame.sentence
                && ["crept", "creep", "inch", "edg", "nos"].iter().any(|stem| word.starts_with(stem))
        })
    });
    let slow = creeps
        || frame.who.is_some_and(|who| {
            let before = reading.before(who).take_while(|(other, _)| *other < number).last();
            before.is_some_and(|(last, before)| {
                before.sentence == frame.sentence
                    && frame.form == Form::Ing
                    && manner(reading, last) == Some(Manner::Slow)
            })
        });
    // "reversed without yielding".
    // "The AV was yielding to traffic when a van struck it": nothing else is told of it, and by the column it moved.
    let moves = !matches!(reading.record.sv_movement.known(), None | Some(Movement::Stopped | Movement::Parked));
    let was = frame.form == Form::Ing
        && frame.who == Some(SUBJECT)
        && moves
        && frame.first > 0
        && reading.story.tokens[frame.first - 1].text == "was";
    let drives = (last.is_some() || was) && !slows(last) && last != Some(Act::Reverse);
    to.is_some() && !told && drives && !slow && !reading.is_after(number)
}

/// "had a green arrow. A van illegally entered the junction": where a light is told of, against that.
fn enters_illegally(reading: &Reading<'_>, frame: &Frame) -> bool {
    let tokens = &reading.story.tokens;
    let illegal = |token: &Token| matches!(token.text.as_str(), "illegally" | "unlawfully");
    let near = frame.first.saturating_sub(1)..tokens.len().min(frame.end + 2);
    let end = reading.story.sentences[frame.sentence].end;
    let place = |token: &Token| matches!(token.text.as_str(), "intersection" | "junction");
    let light = |pair: &[Token]| {
        matches!(pair[0].text.as_str(), "green" | "red" | "traffic")
            && matches!(pair[1].text.as_str(), "light" | "signal" | "arrow")
    };
    // "illegally riding on the sidewalk came to the intersection" is none.
    let behind = tokens[frame.end..].iter().take(3);
    let goes_in = frame.act() == Some(Act::Enter)
        || behind.into_iter().any(|token| matches!(token.text.as_str(), "into" | "through"));
    // "illegally entered from the turn lane to go straight" breaks another rule.
    let lane = |token: &Token| matches!(token.text.as_str(), "lane" | "lanes");
    frame.who != Some(SUBJECT)
        && goes_in
        && !tokens[frame.first..end].iter().any(lane)
        && tokens[near].iter().any(illegal)
        && tokens[frame.first..end].iter().any(place)
        && tokens[..reading.until().min(tokens.len())].windows(2).any(light)
}

fn is_animal(reading: &Reading<'_>, actor: Actor) -> bool {
    reading.story.world.actors[actor].kind.is_some_and(|kind| kind.group() == KindGroup::Animal)
}

/// What somebody did last before a frame, of the frames that are wanted.
fn last_act(reading: &Reading<'_>, number: usize, frame: &Frame, wanted: impl Fn(&Frame) -> bool) -> Option<Act> {
    let before = reading.before(frame.who?).take_while(|(other, _)| *other < number);
    // What the headline tells of the crash came last.
    let before =
        before.filter(|(other, frame)| frame.who != Some(SUBJECT) || !flashback::is_state_at_crash(reading, *other));
    before.filter(|(_, frame)| frame.happened() && wanted(frame)).filter_map(|(_, frame)| frame.act()).last()
}

/// Whether the sentence is a headline: "was traveling north and was in a collision".
pub(super) fn in_headline(reading: &Reading<'_>, frame: &Frame) -> bool {
    reading.story.frames.iter().any(|other| other.sentence == frame.sentence && other.sense == Sense::Headline)
}

/// "After stopping at a sign, the AV, operating in autonomous mode, was about to turn": who drove it, and not that it did, where the sentence
/// tells of something else that it did.
pub(super) fn names_mode(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let tokens = &reading.story.tokens;
    let word = |at: usize| word(tokens, at);
    let drives = matches!(word(frame.first), "operating" | "operated" | "driven" | "driving");
    let clause = (frame.first..frame.first + MODE_WITHIN).map(word).take_while(|word| !matches!(*word, "," | "."));
    let mode = clause.into_iter().any(|word| word == "mode");
    let apposed = frame.first > 0 && word(frame.first - 1) == "," && drives && mode;
    let stands = |(other, before): (usize, &Frame)| {
        other < number
            && before.sentence == frame.sentence
            && before.happened()
            && before.act().is_some_and(Act::stands)
    };
    apposed && frame.who.is_some_and(|who| reading.before(who).any(stands))
}

/// "operating in fully autonomous mode": the mode is named within so many words. [tokens]
const MODE_WITHIN: usize = 7;

/// Who goes on from a standstill sets off.
fn goes_on_from_a_stand(reading: &Reading<'_>, number: usize, frame: &Frame, words: &str) -> bool {
    // "stopped at a red light, heading west", "stopped, following a pick-up": there it stands.
    let goes_on = ["continu", "remain", "heading", "following", "traveling", "travelling", "driving"];
    let goes_on = goes_on.iter().any(|start| words.starts_with(start));
    // "It reversed, and then proceeded forward".
    let forward = words.split([',', '.', ';']).next().is_some_and(|clause| clause.contains("forward"));
    let stood = |act: Option<Act>| match act {
        Some(Act::Reverse) => forward,
        act => act.is_some_and(Act::stands),
    };
    // "The stationary AV was in autonomous mode. It moved forward".
    let last = last_act(reading, number, frame, |frame| !frame.aside);
    let last = last.or_else(|| last_act(reading, number, frame, |_| true).filter(|_| frame.who == Some(SUBJECT)));
    !goes_on && frame.sense != Sense::Approach && stood(last)
}

/// "It slowed for a red light. After that had turned green it was moving forward": it had waited for that.
pub(super) fn sets_off_at_green(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let words = &reading.story.tokens[frame.first..frame.end];
    let forward = words.iter().any(|token| token.text == "forward") && turned_green(reading, frame);
    let slowed = frame.who.filter(|_| forward).and_then(|who| {
        reading
            .before(who)
            .filter(|(before, frame)| *before < number && frame.act().is_some() && frame.happened())
            .last()
    });
    let red = |(number, frame): (usize, &Frame)| {
        let (first, end) = reading.window(number);
        let red = reading.story.tokens[first..end].iter().any(|token| token.text == "red");
        frame.act() == Some(Act::Slow) && red
    };
    frame.act() == Some(Act::Follow) && slowed.is_some_and(red)
}

/// "moved forward from a standing position", "accelerated from a stop": who goes on so had stood. "from a stop sign" is a place.
pub(super) fn leaves_rest(reading: &Reading<'_>, frame: &Frame) -> bool {
    let sentence = reading.story.sentences[frame.sentence];
    let words = &reading.story.tokens[frame.first..sentence.end.min(frame.end + REST_WITHIN)];
    // "was driving as a bus pulled away from a stop": of somebody else.
    let ends = |word: &&str| matches!(*word, "as" | "when" | "while" | "and" | "after" | "before" | "until" | ",");
    let mut words = words.iter().map(|token| token.text.as_str()).take_while(|word| !ends(word));
    let from = words.any(|word| word == "from");
    let says_how = |word: &&str| matches!(*word, "a" | "an" | "its" | "the" | "complete" | "full" | "dead");
    let mut rest = words.skip_while(says_how);
    let stands = match (rest.next().unwrap_or_default(), rest.next().unwrap_or_default()) {
        ("stationary" | "stopped" | "standing" | "parked" | "resting", next) => matches!(next, "position" | "start"),
        ("stop" | "halt", next) => !matches!(next, "sign" | "line" | "bar" | "light" | "signal"),
        (word, _) => matches!(word, "standstill" | "rest"),
    };
    matches!(frame.act(), Some(Act::Follow | Act::Accelerate)) && frame.happened() && from && stands
}

/// "from a stop" stands so near behind the verb. [tokens]
const REST_WITHIN: usize = 10;

/// "Once the light turned green, it began to proceed, and a car behind it proceeded forward": so did that.
fn sets_off_with_subject(reading: &Reading<'_>, frame: &Frame, words: &str) -> bool {
    let Some(who) = frame.who.filter(|who| *who != SUBJECT) else { return false };
    let mut relations = reading.story.world.actors[who].relations.iter();
    let sets_off = |(number, other): (usize, &Frame)| {
        let goes = other.act() == Some(Act::SetOff) || sets_off_at_green(reading, number, other);
        other.sentence == frame.sentence && goes
    };
    ["proceed", "start", "beg", "mov"].iter().any(|start| words.starts_with(start))
        && relations.any(|(relation, sentence)| *relation == Relation::Behind && *sentence == frame.sentence)
        && turned_green(reading, frame)
        && reading.before(SUBJECT).any(sets_off)
}

/// "When the light turned green, the AV waited and the van in the next lane proceeded": told of nothing before, it had stood there too.
fn goes_at_green(reading: &Reading<'_>, frame: &Frame, words: &str) -> bool {
    let Some(who) = frame.who.filter(|who| *who != SUBJECT) else { return false };
    let known = &reading.story.world.actors[who];
    let first = reading.story.sentences[frame.sentence].first;
    let green = reading.story.tokens[first..frame.first].iter().any(|token| token.text == "green");
    let goes = ["proceed", "moved", "started", "began", "went"].iter().any(|start| words.starts_with(start));
    let own = reading.story.world.actors[SUBJECT].heading.map(|(heading, ..)| heading);
    let other_way = known.heading.is_some_and(|(heading, ..)| own.is_some_and(|own| own != heading));
    let comes = known.relations.iter().any(|(relation, _)| matches!(relation, Relation::Behind | Relation::Opposite));
    let stands = |other: &Frame| other.act().is_some_and(Act::stands);
    let waits = |other: &Frame| other.who == Some(SUBJECT) && other.sentence == frame.sentence && stands(other);
    // "It came to a stop beside a van. When the light turned green, ...": it stood already.
    let own = reading.before(SUBJECT).filter(|(_, other)| other.first < frame.first && other.happened());
    let stood = own.map(|(_, other)| other).filter(|other| other.act().is_some()).last().is_some_and(stands);
    goes && green
        && turned_green(reading, frame)
        && frame.form == Form::Past
        && !(other_way || comes)
        && (stood || reading.story.frames.iter().any(waits))
}

/// "passed a parked trailer", "passed behind the van".
fn passes_nobody(reading: &Reading<'_>, frame: &Frame) -> bool {
    let Some(object) = frame.object else {
        let places = |relation: &Relation| matches!(relation, Relation::Ahead | Relation::Behind);
        return frame.who == Some(SUBJECT) && frame.relations.iter().all(|(relation, _)| places(relation));
    };
    reading.story.world.actors[object].kind.is_some_and(|kind| kind.group() == KindGroup::Object)
}

/// Whether the sentence tells that a light turned green.
fn turned_green(reading: &Reading<'_>, frame: &Frame) -> bool {
    let sentence = reading.story.sentences[frame.sentence];
    let words = &reading.story.tokens[sentence.first..sentence.end];
    let turns = |word: &str| ["turned", "turn", "turns", "changed", "became"].contains(&word);
    words.windows(4).any(|words| turns(&words[0].text) && words[1..].iter().any(|word| word.text == "green"))
}
