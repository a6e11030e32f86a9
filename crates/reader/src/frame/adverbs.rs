//! What the words behind a verb make of it: "emerged in reverse", "entered against the signal", "passed in front of the bus".

use super::Frame;
use crate::chunk::{Piece, is_of_traffic};
use crate::lexicon::{Form, Part, Progress, Relation, Sense};
use crate::token::{Sentence, Token};
use crate::world::SUBJECT;
use recrash_model::account::Act;

/// Places that are passed on the way, and are nobody.
pub(super) const PLACES: [&str; 26] = [
    "sign",
    "line",
    "light",
    "signal",
    "intersection",
    "junction",
    "driveway",
    "corner",
    "entrance",
    "entry",
    "exit",
    "street",
    "road",
    "curve",
    "bend",
    "circle",
    "crosswalk",
    "ramp",
    "lot",
    "alley",
    "space",
    "spot",
    "stall",
    "curb",
    "gap",
    "block",
];

/// Reads the words behind every verb of moving once more.
pub(super) fn apply(frames: &mut Vec<Frame>, tokens: &[Token], sentences: &[Sentence]) {
    let mut number = 0;
    while number < frames.len() {
        let end = behind(frames, number, sentences);
        let frame = &frames[number];
        let words: Vec<&str> = tokens[frame.first..end].iter().map(|token| token.text.as_str()).collect();
        if backwards(frame, &words) || still_backwards(frames, number, &words) {
            frames[number].sense = Sense::Act(Act::Reverse);
        } else if out_from_behind(frame, &words) {
            frames[number].sense = Sense::Act(Act::Enter);
        } else if turns_back_in(frames, number, &words) {
            frames[number].sense = Sense::Act(Act::LaneChange);
        } else if passes_nobody(frame, &words) {
            frames[number].sense = Sense::Act(Act::Follow);
        } else if pulls_out_to_pass(frames, number, &words) {
            frames[number].sense = Sense::Act(Act::Drift);
        } else if pulls_out_to_a_lane(frames, number, tokens, sentences) {
            frames[number].sense = Sense::Act(Act::LaneChange);
        } else if headed_as_it_stands(frames, number, &words) {
            frames[number].sense = Sense::Face;
        } else if leaves_a_control(frames, number, tokens, sentences)
            || leaves_a_queue(frames, number, tokens, sentences)
        {
            frames[number].sense = Sense::Act(Act::SetOff);
        } else if against_traffic(frame, &words) {
            frames[number].sense = Sense::Act(Act::WrongWay);
        }
        if frames[number].is_contact() && frames[number].with.is_none() {
            frames[number].with = own_part(&frames[number], &words);
        }
        if begins_to_pass(frames, number, tokens) {
            let taken = &frames[number];
            let sets_off = Frame { sense: Sense::Act(Act::SetOff), object: None, side: None, ..taken.clone() };
            frames.insert(number, sets_off);
            number += 1;
        }
        let frame = &frames[number];
        if frame.act() == Some(Act::Pass) && frame.side.is_none() && frame.who != Some(SUBJECT) {
            frames[number].side = frames[number].on.as_ref().and_then(Piece::side);
        }
        let frame = &frames[number];
        let goes =
            matches!(frame.act(), Some(Act::Follow | Act::Enter | Act::Cross | Act::Turn | Act::SetOff | Act::Pass));
        if goes
            && frame.happened()
            && frame.who != Some(SUBJECT)
            && (against_signal(&words) || at_its_red(frame, tokens, sentences))
        {
            let ran = Frame { sense: Sense::Act(Act::RunRed), side: None, ..frame.clone() };
            frames.insert(number + 1, ran);
            number += 1;
        }
        number += 1;
    }
}

/// "drove its front end into", "scraped its right side along": the part that touches stands within the verb.
fn own_part(frame: &Frame, words: &[&str]) -> Option<Piece> {
    let verb = &words[..frame.end.saturating_sub(frame.first).min(words.len())];
    let into = verb.iter().position(|word| matches!(*word, "into" | "against" | "along" | "on" | "past" | "down"))?;
    let own = verb[..into].iter().position(|word| matches!(*word, "its" | "their"))?;
    let mut parts = verb[own + 1..into].iter().filter_map(|word| match *word {
        "front" | "nose" => Some(Part::Front),
        "rear" | "tail" => Some(Part::Rear),
        "left" | "driver" => Some(Part::Left),
        "right" | "passenger" => Some(Part::Right),
        _ => None,
    });
    let mut piece = Piece::of(parts.next()?);
    piece.parts.extend(parts);
    Some(piece)
}

/// The token behind the words of a frame: where the next one begins, or the sentence ends.
fn behind(frames: &[Frame], number: usize, sentences: &[Sentence]) -> usize {
    let frame = &frames[number];
    let end = sentences[frame.sentence].end;
    let next = frames[number + 1..].iter().find(|next| next.sentence == frame.sentence && next.first > frame.first);
    next.map_or(end, |next| next.first).clamp(frame.end.min(end), end)
}

/// "came out in reverse", "left its stall tail first", "rolled backwards".
fn backwards(frame: &Frame, words: &[&str]) -> bool {
    let moves = matches!(
        frame.act(),
        Some(
            Act::Follow
                | Act::PullOut
                | Act::Enter
                | Act::SetOff
                | Act::Drift
                | Act::Roll
                | Act::Accelerate
                | Act::Park
        )
    );
    let parks = frame.act() == Some(Act::Park)
        && words.first().is_some_and(|word| word.starts_with("revers") || word.starts_with("back"));
    let pair =
        |one: &[&str], two: &[&str]| words.windows(2).any(|pair| one.contains(&pair[0]) && two.contains(&pair[1]));
    let says = pair(&["in"], &["reverse"])
        || pair(&["tail", "rear", "end"], &["first"])
        || words.iter().any(|word| matches!(*word, "backward" | "backwards" | "rearward" | "rearwards"));
    // "crossed the street in reverse".
    let over = matches!(frame.act(), Some(Act::Cross | Act::Turn)) && pair(&["in"], &["reverse"]);
    over || moves && frame.sense != Sense::Parked && (says || parks)
}

/// "shifted into reverse and came back until ...".
fn still_backwards(frames: &[Frame], number: usize, words: &[&str]) -> bool {
    let frame = &frames[number];
    let before = frames[..number].iter().rev().find(|before| before.who == frame.who);
    let reverses = before.is_some_and(|before| {
        before.sentence == frame.sentence && before.act() == Some(Act::Reverse) && before.happened()
    });
    let back = words.first().is_some_and(|word| matches!(*word, "came" | "coming" | "rolled" | "moved" | "kept"))
        && words
            .get(1)
            .is_some_and(|word| matches!(*word, "back" | "until" | "into" | "toward" | "towards" | "coming"));
    matches!(frame.act(), Some(Act::Follow | Act::Roll | Act::Drift)) && reverses && back
}

/// "changed lanes to pass it and turned back into its lane": no turn.
fn turns_back_in(frames: &[Frame], number: usize, words: &[&str]) -> bool {
    let frame = &frames[number];
    let back = words.windows(2).any(|pair| pair[0] == "back" && matches!(pair[1], "in" | "into"));
    frame.sense == Sense::Act(Act::Turn)
        && back
        && frames[..number].iter().any(|before| {
            before.who == frame.who && matches!(before.act(), Some(Act::Pass | Act::LaneChange)) && !before.negated
        })
}

/// "began to move around it", told of one that stands: it sets off first.
fn begins_to_pass(frames: &[Frame], number: usize, tokens: &[Token]) -> bool {
    let frame = &frames[number];
    if frame.act() != Some(Act::Pass) || frame.progress != Progress::Real || !frame.happened() {
        return false;
    }
    let words = &tokens[frame.first.saturating_sub(3)..frame.end];
    let begins = words.iter().any(|token| matches!(token.text.as_str(), "began" | "begins" | "started" | "starts"));
    let before = frames[..number].iter().rev().find(|other| {
        other.who == frame.who && other.act().is_some() && other.happened() && other.progress == Progress::Real
    });
    begins && before.is_some_and(|other| other.act().is_some_and(Act::stands) && !other.aside)
}

/// "emerged on the right from behind a stopped bus": into view, and from no kerb.
fn out_from_behind(frame: &Frame, words: &[&str]) -> bool {
    let hidden =
        words.windows(2).any(|pair| pair[0] == "from" && matches!(pair[1], "behind" | "between" | "around" | "beyond"));
    frame.act() == Some(Act::PullOut)
        && frame.out_of.is_none()
        && hidden
        && words.first().is_some_and(|word| word.starts_with("emerg"))
}

/// "passed in front of the bus", "drove past the yield sign".
fn passes_nobody(frame: &Frame, words: &[&str]) -> bool {
    if frame.act() != Some(Act::Pass) || frame.who == Some(SUBJECT) || frame.object.is_some() || frame.side.is_some() {
        return false;
    }
    let across = frame
        .relations
        .iter()
        .any(|(relation, to)| matches!(relation, Relation::Ahead | Relation::Behind) && to.is_some());
    let own = frame.end - frame.first;
    let place = words.iter().skip(own).take(4).any(|word| PLACES.contains(word));
    across || place && frame.relations.is_empty()
}

/// "pulled out over the line to get by": begun to pass, and from no kerb.
fn pulls_out_to_pass(frames: &[Frame], number: usize, words: &[&str]) -> bool {
    let frame = &frames[number];
    if frame.act() != Some(Act::PullOut) || frame.out_of.is_some() {
        return false;
    }
    let from = words.iter().any(|word| matches!(*word, "from" | "curb" | "kerb"))
        || frames[..number].iter().any(|before| before.who == frame.who && before.sense == Sense::Parked);
    let passes = frames[number + 1..].iter().take(2).any(|next| {
        next.sentence == frame.sentence && next.who == frame.who && next.act() == Some(Act::Pass) && next.happened()
    });
    let over =
        words.windows(2).any(|pair| pair[1].starts_with("line") && matches!(pair[0], "center" | "yellow" | "dividing"))
            || words.iter().any(|word| matches!(*word, "centerline" | "centreline"));
    !from && (passes || over)
}

/// "A coupe that was stopped behind it pulled out into the left lane": out of the queue, and from no kerb.
fn pulls_out_to_a_lane(frames: &[Frame], number: usize, tokens: &[Token], sentences: &[Sentence]) -> bool {
    let frame = &frames[number];
    if frame.act() != Some(Act::PullOut) || frame.out_of.is_some() {
        return false;
    }
    let text = |from: usize, to: usize| {
        let to = to.min(tokens.len());
        tokens[from.min(to)..to].iter().map(|token| token.text.as_str())
    };
    let behind: Vec<&str> = text(frame.first, behind(frames, number, sentences)).collect();
    let into = behind.iter().position(|word| matches!(*word, "into" | "toward" | "towards" | "to" | "onto"));
    let lane = into.is_some_and(|into| behind[into..].iter().take(6).any(|word| *word == "lane"));
    let aside = |word: &str| {
        matches!(
            word,
            "curb"
                | "curbside"
                | "kerb"
                | "stall"
                | "driveway"
                | "lot"
                | "parked"
                | "parking"
                | "shoulder"
                | "from"
                | "alley"
        )
    };
    let own = |before: &&Frame| before.who == frame.who && before.act().is_some();
    let Some(before) = frames[..number].iter().rposition(|before| own(&before)) else { return false };
    let stood = frames[before].act().is_some_and(Act::stands) && frames[before].happened();
    let parked = frames[..number].iter().any(|before| before.who == frame.who && before.sense == Sense::Parked);
    let placed = frames[before].relations.iter().any(|(relation, _)| matches!(relation, Relation::Behind | Relation::Ahead))
            || text(frames[before].first, frames[before].end + 5).any(|word| word == "lane")
            // "Directly to its rear a coupe had been stopped".
            || text(sentences[frames[before].sentence].first, frames[before].first)
                .any(|word| matches!(word, "behind" | "rear"));
    let begin = sentences[frames[before].sentence].first;
    let from_aside = text(begin, frame.first.max(begin)).any(aside) || behind.iter().any(|word| aside(word));
    lane && stood && placed && !parked && !from_aside
}

/// "had stopped in a lot, headed north": where it faces.
fn headed_as_it_stands(frames: &[Frame], number: usize, words: &[&str]) -> bool {
    let frame = &frames[number];
    let before = frames[..number]
        .last()
        .filter(|before| (before.sentence, before.clause, before.who) == (frame.sentence, frame.clause, frame.who));
    frame.act() == Some(Act::Follow)
        && words.first() == Some(&"headed")
        && before.is_some_and(|before| before.act().is_some_and(Act::stands) && before.happened())
}

/// "had been waiting at the stop sign and now pulled out": sets off, and from no kerb.
fn leaves_a_control(frames: &[Frame], number: usize, tokens: &[Token], sentences: &[Sentence]) -> bool {
    let frame = &frames[number];
    if frame.act() != Some(Act::PullOut) || frame.out_of.is_some() {
        return false;
    }
    let Some(before) = frames[..number].iter().rposition(|before| before.who == frame.who && before.act().is_some())
    else {
        return false;
    };
    let stood = frames[before].act().is_some_and(Act::stands) && frames[before].sense != Sense::Parked;
    let end = behind(frames, before, sentences);
    stood
        && frames[before].happened()
        && tokens[frames[before].first..end]
            .iter()
            .any(|token| matches!(token.text.as_str(), "sign" | "light" | "signal"))
}

/// "It stood behind a bus, and the bus pulled away": on along the lane, and from no kerb.
fn leaves_a_queue(frames: &[Frame], number: usize, tokens: &[Token], sentences: &[Sentence]) -> bool {
    let frame = &frames[number];
    let words = &tokens[frame.first..behind(frames, number, sentences)];
    let says = |of: &[&str]| words.iter().any(|token| of.contains(&token.text.as_str()));
    let away = says(&["away"]) && !says(&["from", "curb", "kerb", "parking", "stall", "driveway", "lot", "side"]);
    let before = &frames[..number];
    let waits = |other: &Frame| {
        let stands = other.act().is_some_and(Act::stands) && other.happened();
        let behind = |(relation, to): &(Relation, Option<usize>)| *relation == Relation::Behind && *to == frame.who;
        // "behind a truck at the side of the street": out of there.
        let aside = ["curb", "kerb", "parking", "side", "shoulder", "parked", "stall", "driveway", "lot"];
        let said = &tokens[other.first..sentences[other.sentence].end];
        let aside = said.iter().any(|token| aside.contains(&token.text.as_str()));
        other.who == Some(SUBJECT) && stands && !aside && other.relations.iter().any(behind)
    };
    let parked = before.iter().any(|other| other.who == frame.who && other.sense == Sense::Parked);
    let leaves = frame.act() == Some(Act::PullOut) && frame.out_of.is_none() && frame.who.is_some();
    leaves && away && !parked && before.iter().any(waits)
}

/// "came into the street on the wrong side, against the traffic". "Went against the traffic laws" is no way.
fn against_traffic(frame: &Frame, words: &[&str]) -> bool {
    let moves = matches!(frame.act(), Some(Act::Follow | Act::Enter | Act::SetOff));
    let against = (0..words.len()).any(|at| match &words[at..] {
        ["against", "the", "traffic", next, ..] | ["against", "traffic", next, ..] => !is_of_traffic(next),
        ["the", "wrong", "side" | "way" | "direction", ..] => true,
        _ => false,
    });
    moves && against && frame.happened() && frame.who != Some(SUBJECT)
}

/// "entered the crosswalk at a run against the pedestrian signal".
fn against_signal(words: &[&str]) -> bool {
    // "came in on red", and not "turned right on red".
    let turns = words.first().is_some_and(|word| ["turn", "ma", "took"].iter().any(|stem| word.starts_with(stem)));
    let on_red = words.windows(2).any(|pair| pair == ["on", "red"]) && !turns;
    on_red
        || words.iter().enumerate().any(|(at, word)| {
            let next = &words[at + 1..words.len().min(at + 5)];
            *word == "against"
                && !next.contains(&"pole")
                && next.iter().any(|word| matches!(*word, "signal" | "signals" | "red" | "hand"))
        })
}

/// "A coupe whose light was red drove in", "in violation of the red light, it drove in".
fn at_its_red(frame: &Frame, tokens: &[Token], sentences: &[Sentence]) -> bool {
    let words: Vec<&str> =
        tokens[sentences[frame.sentence].first..frame.first].iter().map(|token| token.text.as_str()).collect();
    let last = &words[words.len().saturating_sub(9)..];
    let whose = last.windows(4).any(|run| matches!(run, ["whose", "light" | "signal", "was", "red"]));
    let violation = last.windows(5).any(|run| matches!(run, ["in", "violation", "of", ..]) && run.contains(&"red"));
    matches!(frame.act(), Some(Act::Enter | Act::Follow | Act::Cross | Act::Turn)) && (whose || violation)
}

/// Whether a frame tells a purpose that was gone about: "swung out to get past".
pub(super) fn goes_about(act: Option<Act>) -> bool {
    matches!(
        act,
        Some(Act::Follow | Act::SetOff | Act::Drift | Act::Accelerate | Act::Reverse | Act::PullOut | Act::Swerve)
    )
}

/// Doors are opened only where the sentence names one: "a driveway opening".
pub(super) fn names_door(frame: &Frame, tokens: &[Token], sentences: &[Sentence]) -> bool {
    let sentence = sentences[frame.sentence];
    let opens = frame.sense == Sense::Act(Act::OpenDoor);
    let word = |text: &str| {
        text.starts_with("door")
            || matches!(text, "hatch" | "trunk" | "liftgate" | "tailgate" | "hood" | "gate" | "gates" | "ramp")
    };
    // "the lane that opens on the left".
    let lane = tokens[sentence.first.max(frame.first.saturating_sub(3))..frame.first]
        .iter()
        .any(|token| matches!(token.text.as_str(), "lane" | "lanes" | "pocket" | "road" | "street" | "gap"));
    !opens
        || frame.form == Form::Present && !lane
        || frame.progress == Progress::Wished
        || tokens[sentence.first..sentence.end].iter().any(|token| word(&token.text))
}
