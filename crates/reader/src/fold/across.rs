//! Which acts of one of the two the words put behind acts of the other.

use super::Reading;
use crate::chunk::Joint;
use crate::frame::Frame;
use crate::lexicon::{Form, Progress, Sense};
use recrash_model::account::{Act, ActFact, Party};

/// Tells each act of the two behind which one of the other's it came, where the words say so.
pub(super) fn settle(reading: &Reading<'_>, sv: &mut Party, partner: &mut Party) {
    let (of_sv, of_partner) = (steps(sv), steps(partner));
    order(reading, &mut sv.acts, &of_partner);
    order(reading, &mut partner.acts, &of_sv);
}

fn steps(party: &Party) -> Vec<u32> {
    party.acts.iter().filter(|fact| !fact.after_contact).map(|fact| fact.step).collect()
}

fn order(reading: &Reading<'_>, acts: &mut [ActFact], others: &[u32]) {
    let enters: Vec<u32> = acts.iter().filter(|fact| fact.act == Act::Enter).map(|fact| fact.step).collect();
    for fact in acts.iter_mut().filter(|fact| !fact.after_contact) {
        let goes = enters.contains(&fact.step) && goes_in(reading, fact);
        let comes = |other: &&u32| comes_behind(reading, **other as usize, (fact.step as usize, goes));
        fact.after_other = others.iter().filter(comes).max().copied();
    }
}

/// "proceeded straight into the intersection": with a verb for who drives on something happened.
fn goes_in(reading: &Reading<'_>, fact: &ActFact) -> bool {
    let frame = reading.story.frames.get(fact.step as usize);
    frame.is_some_and(|frame| {
        frame.act() == Some(Act::Follow) && frame.form == Form::Past && !frame.state && frame.happened()
    })
}

/// Whether the words put the second of two frames behind the first, or let it answer that; of the second also whether something happened with
/// a verb for who drives on, which is so in the sentence of the first alone.
fn comes_behind(reading: &Reading<'_>, first: usize, (second, goes): (usize, bool)) -> bool {
    let frames = &reading.story.frames;
    let (Some(one), Some(two)) = (frames.get(first), frames.get(second)) else { return false };
    let goes = goes && one.sentence == two.sentence;
    let happens = |frame: &Frame| happens(reading, frame) || goes && std::ptr::eq(frame, two);
    let unclear = |frame: &Frame| frame.aside || frame.described || frame.looks_back;
    // What is told of before the crash behind its headline is no sequel of that.
    let back = |frame: &Frame| reading.back.contains(&frame.sentence);
    // "both vehicles set off": at once.
    let at_once = one.first == two.first;
    if unclear(one) || unclear(two) || had(reading, two) || back(one) != back(two) || at_once {
        return false;
    }
    // "The AV had pulled over. A van began to back up": over by then. "The AV was stopped. A van pulled out": it stood by then.
    let stood = one.act() == Some(Act::Hold) && one.happened();
    if stood || had(reading, one) {
        let inner = two.joint.filter(is_inner).is_some();
        return first < second && !inner && (stood || happens(one)) && happens(two);
    }
    match (one.sentence == two.sentence, one.joint.filter(is_inner), two.joint.filter(is_inner)) {
        // "As the van backed, the AV stopped", "the AV stopped as the van backed": it answered what the clause tells first. "It stopped
        // when the van backed" leaves that open.
        (true, Some(Joint::While | Joint::After), None) => {
            let behind =
                || ends(frames, first) && !begins_with_when(reading, second, first) && !is_sequel(reading, two);
            happens(two) && opens(reading, first) && (first < second || behind())
        }
        // "It was turning when the van pulled out": what went on had begun.
        // "It began to pass when the van pulled out".
        (true, None, Some(Joint::While)) => {
            let begun = || begins(reading, one) && begins_with_when(reading, first, second);
            first < second && (goes_on(reading, one) || begun()) && happens(two)
        }
        // "It stopped before the van turned".
        (true, None, Some(Joint::Before)) => happens(one) && happens(two),
        (true, Some(_), _) | (true, _, Some(_)) => false,
        (true, None, None) => first < second && happens(one) && happens(two),
        // One sentence after the other tells one thing after the other.
        (false, inner, _) => first < second && inner != Some(Joint::Before) && happens(one) && happens(two),
    }
}

/// Whether a clause is the last of its sentence: of another one, what stands behind it may be what it belongs to.
fn ends(frames: &[Frame], number: usize) -> bool {
    let (frame, behind) = (&frames[number], &frames[number + 1..]);
    behind.iter().all(|next| next.sentence != frame.sentence || next.joint == frame.joint)
}

/// Whether a frame is the first that its clause tells of somebody.
fn opens(reading: &Reading<'_>, number: usize) -> bool {
    let frames = &reading.story.frames;
    let frame = &frames[number];
    let same = |before: &Frame| {
        before.sentence == frame.sentence
            && before.who == frame.who
            && before.joint == frame.joint
            && happens(reading, before)
    };
    !frames[..number].iter().any(same)
}

/// Whether "when" stands between two frames.
fn begins_with_when(reading: &Reading<'_>, main: usize, inner: usize) -> bool {
    let frames = &reading.story.frames;
    let between = frames[main].first..frames[inner].first;
    reading.story.tokens[between].iter().any(|token| token.text == "when")
}

/// "It then stopped as the van came nearer": "then" binds it to what was told before.
fn is_sequel(reading: &Reading<'_>, frame: &Frame) -> bool {
    let from = reading.story.sentences[frame.sentence].first.max(frame.first.saturating_sub(2));
    let before = &reading.story.tokens[from..frame.first];
    before.iter().any(|token| matches!(token.text.as_str(), "then" | "thereupon" | "subsequently"))
}

/// Whether a clause belongs to another one.
fn is_inner(joint: &Joint) -> bool {
    !matches!(joint, Joint::And)
}

/// Whether a frame tells something that happened, and not how things were: "stopped", "began to turn".
fn happens(reading: &Reading<'_>, frame: &Frame) -> bool {
    // Of giving way only what counts as slowing is an act.
    let event = frame.sense == Sense::Yield
        || frame.act().is_some_and(|act| !matches!(act, Act::Follow | Act::Hold | Act::Pushed));
    let told = matches!(frame.form, Form::Past | Form::Present) || frame.progress == Progress::Tried;
    event && (told || is_begun(reading, frame)) && !frame.state && frame.happened()
}

/// "began to turn", "started passing".
pub(super) fn begins(reading: &Reading<'_>, frame: &Frame) -> bool {
    frame.act().is_some() && is_behind_begin(reading, frame)
}

/// "began to ...", "started ...": whatever follows.
pub(super) fn is_behind_begin(reading: &Reading<'_>, frame: &Frame) -> bool {
    let from = reading.story.sentences[frame.sentence].first.max(frame.first.saturating_sub(3));
    let before = &reading.story.tokens[from..=frame.first];
    before.iter().any(|token| ["beg", "start"].iter().any(|stem| token.text.starts_with(stem)))
}

/// "began to turn", "proceeded to make a turn", "started reversing".
fn is_begun(reading: &Reading<'_>, frame: &Frame) -> bool {
    const BEGINS: [&str; 4] = ["beg", "start", "proceed", "continu"];
    let from = reading.story.sentences[frame.sentence].first.max(frame.first.saturating_sub(4));
    let before = &reading.story.tokens[from..frame.first];
    before.iter().any(|token| BEGINS.iter().any(|stem| token.text.starts_with(stem)))
}

/// "was turning".
fn goes_on(reading: &Reading<'_>, frame: &Frame) -> bool {
    let tokens = &reading.story.tokens;
    let was = |token: &crate::token::Token| matches!(token.text.as_str(), "was" | "were");
    frame.form == Form::Ing && tokens[frame.first.saturating_sub(2)..frame.first].iter().any(was)
}

/// "had turned": before what is told with it.
fn had(reading: &Reading<'_>, frame: &Frame) -> bool {
    let from = reading.story.sentences[frame.sentence].first.max(frame.first.saturating_sub(3));
    reading.story.tokens[from..=frame.first].iter().any(|token| token.text == "had")
}
