//! What somebody did, in order, each act with its side.

use super::Reading;
use super::across::begins;
use super::counted::{act_of, went_by};
use super::manner::manner;
use super::sides::{back_to_the_middle, side_of};
use super::{entry, flashback, nominal};
use crate::chunk::Joint;
use crate::frame::Frame;
use crate::lexicon::{Form, Progress, Relation, Sense};
use crate::token::Token;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Account, Act, ActFact, Kind, LeftRight};

/// What somebody did, in order; the same act told twice in a row once.
pub(super) fn acts(reading: &Reading<'_>, actor: Actor) -> Vec<ActFact> {
    let mut all: Vec<ActFact> = Vec::new();
    let (order, at_crash) = flashback::in_order(reading, actor);
    for number in order {
        let frame = &reading.story.frames[number];
        let pushed = is_pushed(reading, actor, number, frame);
        if reading.doer(frame) != Some(actor) && !pushed {
            continue;
        }
        tells_of_earlier(reading, number, frame, &mut all);
        let so_far = all.last().map(|fact| fact.act);
        let act = if pushed { Some(Act::Pushed) } else { act_of(reading, number, frame, so_far) };
        let Some(act) = act else { continue };
        let last = at_crash.filter(|_| flashback::is_state_at_crash(reading, number) && actor == SUBJECT);
        if last.is_some() && all.iter().rfind(|fact| !fact.after_contact).is_some_and(stands) {
            continue;
        }
        let fact = ActFact { step: last.unwrap_or(number) as u32, ..fact_of(reading, actor, number, act, &all) };
        let entry = entry::beside(reading, frame, &fact);
        if let Some(entry) = entry.as_ref().filter(|entry| entry.before) {
            enters(&mut all, &entry.fact);
        }
        add(reading, frame, fact, &mut all);
        if let Some(entry) = entry.filter(|entry| !entry.before) {
            enters(&mut all, &entry.fact);
        }
    }
    if reading.contacts.partner == Some(actor) {
        if all.iter().all(|fact| fact.after_contact) {
            all.splice(0..0, of_group(reading, actor));
        }
        with_contact(reading, actor, &mut all);
    }
    told_ahead(reading, &mut all);
    nominal::add_turn(reading, actor, &mut all);
    all
}

/// Whether a frame tells that another one pushed or threw somebody.
fn is_pushed(reading: &Reading<'_>, actor: Actor, number: usize, frame: &Frame) -> bool {
    let done_to = frame.object == Some(actor);
    let thrown = done_to && Some(actor) == reading.contacts.partner && reading.contacts.earlier.contains(&number);
    let push = done_to && frame.sense == Sense::Push && frame.happened();
    thrown || push && !merely_caused(reading, number, frame)
}

/// Takes from a frame what it tells of acts before: left off, or done by then.
fn tells_of_earlier(reading: &Reading<'_>, number: usize, frame: &Frame, all: &mut [ActFact]) {
    if is_not_completed(reading, frame) {
        all.iter_mut().filter(|fact| Some(fact.act) == frame.act() && !fact.after_contact).for_each(leave_off);
    }
    if leaves_the_junction(reading, number, frame) {
        let turn = all.iter_mut().rfind(|fact| fact.act == Act::Turn && !fact.after_contact);
        turn.into_iter().for_each(|turn| (turn.begun, turn.done) = (false, true));
    }
}

/// What is told of one act, behind those before it.
fn fact_of(reading: &Reading<'_>, actor: Actor, number: usize, act: Act, before: &[ActFact]) -> ActFact {
    let frame = &reading.story.frames[number];
    let went_by = went_by(reading, number, frame);
    let side = side_of(reading, actor, number, act)
        .or_else(|| back_to_the_middle(reading, frame, act, before))
        .or_else(|| before.last().and_then(|out| out.side).filter(|_| act == Act::Pass && went_by));
    ActFact {
        act,
        side,
        step: number as u32,
        after_contact: reading.is_after(number),
        begun: frame.progress == Progress::Tried && !went_by
            || begins_to_pass(reading, actor, frame, act, side)
            || act == Act::UTurn && is_under_way(reading, frame),
        done: is_done(reading, frame),
        after_other: None,
        manner: manner(reading, number),
        source: entry::words(reading, frame, act),
    }
}

/// Adds an act in its place, or what it tells more of the one before.
fn add(reading: &Reading<'_>, frame: &Frame, fact: ActFact, all: &mut Vec<ActFact>) {
    let in_passing = frame.aside && all.iter().any(|known| known.act == fact.act);
    match all.last_mut() {
        Some(last) if is_the_same(last, &fact) => tell_again(last, fact),
        _ if in_passing => {}
        // "stopped after making a left turn": it turned first.
        Some(last) if came_before(reading, frame, &fact, last) => {
            let step = std::mem::replace(&mut last.step, fact.step);
            all.insert(all.len() - 1, ActFact { step, ..fact });
        }
        _ => all.push(fact),
    }
}

/// Whether an act is the one before it, told once more.
fn is_the_same(last: &ActFact, fact: &ActFact) -> bool {
    last.act == fact.act
        && last.after_contact == fact.after_contact
        && (last.side == fact.side || fact.side.is_none() || last.side.is_none())
}

/// Adds what is told of an act that was told before.
fn tell_again(last: &mut ActFact, fact: ActFact) {
    last.side = last.side.or(fact.side);
    // "It began to pass. While passing, it touched it".
    last.begun &= !matches!(fact.act, Act::Pass | Act::Enter) || fact.begun;
    last.manner = fact.manner.or(last.manner);
    // The last word on it is that it was done.
    if fact.done {
        (last.done, last.source) = (true, fact.source);
    }
}

/// Whether an act that is told behind another one led to that: "stopped after making a left turn".
fn came_before(reading: &Reading<'_>, frame: &Frame, fact: &ActFact, last: &ActFact) -> bool {
    stands(last) && tells_where(reading, frame)
        || (stands(last) || last.act == Act::Follow) && is_behind_after(reading, frame, last.step as usize)
        || enters_as_it_stops(reading, fact, frame, last)
}

/// "Several boxes fell off a truck, and it struck one of them": what all of them did before, of whom it is told of none alone.
fn of_group(reading: &Reading<'_>, actor: Actor) -> Vec<ActFact> {
    let known = &reading.story.world.actors[actor];
    let Some(group) = known.group.filter(|group| *group != SUBJECT && *group != actor) else { return Vec::new() };
    let thing = !known.acts();
    let shared =
        |fact: &ActFact| !fact.after_contact && (thing || matches!(fact.act, Act::Follow | Act::Enter | Act::Cross));
    acts(reading, group).into_iter().filter(shared).collect()
}

/// "was unable to complete the lane change": what it had told of it was begun.
fn is_not_completed(reading: &Reading<'_>, frame: &Frame) -> bool {
    let word = reading.story.tokens[frame.first].text.as_str();
    frame.negated && sided_course(frame.act()) && ["complet", "finish"].iter().any(|stem| word.starts_with(stem))
}

/// "as it exited the intersection", "approached the exit of the intersection": a turn that it made there is done by then.
fn leaves_the_junction(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let (first, end) = reading.window(number);
    let words: Vec<&str> =
        reading.story.tokens[first..end.min(first + JUNCTION_WITHIN)].iter().map(|token| token.text.as_str()).collect();
    let exits = words[0].starts_with("exit") || words[0].starts_with("approach") && words.contains(&"exit");
    let turns = frame.who == Some(SUBJECT) || reading.did(SUBJECT, Act::Turn);
    exits && turns && words.contains(&"intersection") && frame.happened() && !reading.is_after(number)
}

/// The intersection stands so near behind the verb of leaving it. [tokens]
const JUNCTION_WITHIN: usize = 6;

/// Acts that take a way of which some may be left.
fn sided_course(act: Option<Act>) -> bool {
    matches!(act, Some(Act::LaneChange | Act::Turn | Act::UTurn | Act::Pass | Act::Park))
}

fn leave_off(fact: &mut ActFact) {
    (fact.begun, fact.done) = (true, false);
}

/// "It began to maneuver around the truck": it was about to pass it. Told with a side, it had gone out to that.
fn begins_to_pass(reading: &Reading<'_>, actor: Actor, frame: &Frame, act: Act, side: Option<LeftRight>) -> bool {
    actor == SUBJECT && act == Act::Pass && side.is_none() && begins(reading, frame)
}

/// Adds that somebody came into the intersection, once; the last word on it is that it did.
fn enters(all: &mut Vec<ActFact>, fact: &ActFact) {
    match all.iter_mut().rfind(|known| known.act == Act::Enter) {
        Some(known) if known.begun && !fact.begun => *known = fact.clone(),
        Some(_) => {}
        None => all.push(fact.clone()),
    }
}

/// "was attempting a multi-point turn", "in the process of turning around": not done yet.
fn is_under_way(reading: &Reading<'_>, frame: &Frame) -> bool {
    let tokens = &reading.story.tokens;
    let before = &tokens[frame.first.saturating_sub(3)..frame.first];
    let process = before.windows(2).any(|pair| pair[0].text == "process" && pair[1].text == "of");
    process || tokens[frame.first].text.starts_with("attempt")
}

/// An act before the contact of which nothing more is told than that it was.
fn plain(reading: &Reading<'_>, act: Act, number: usize) -> ActFact {
    ActFact {
        act,
        side: None,
        step: number as u32,
        after_contact: false,
        begun: false,
        done: false,
        after_other: None,
        manner: None,
        source: reading.of(&reading.story.frames[number]),
    }
}

/// "It stopped at a red light alongside a van. Both set off": the van had stood there too.
pub(super) fn stood_alongside(reading: &Reading<'_>, actor: Actor, mut acts: Vec<ActFact>) -> Vec<ActFact> {
    let known = &reading.story.world.actors[actor];
    let at_its_side = |(relation, to): &(Relation, Option<Actor>)| {
        matches!(relation, Relation::Beside | Relation::Left | Relation::Right) && *to == Some(actor)
    };
    let stands = |frame: &Frame| frame.act().is_some_and(Act::stands) && frame.happened();
    let stood = reading.before(SUBJECT).find(|(_, frame)| stands(frame) && frame.relations.iter().any(at_its_side));
    let Some((number, frame)) = stood.filter(|_| known.kind.is_some_and(Kind::is_vehicle) && !known.several) else {
        return acts;
    };
    let own = |fact: &ActFact| {
        let told = &reading.story.frames[fact.step as usize];
        fact.step as usize <= number || stands(told) || told.sentence == frame.sentence
    };
    if acts.is_empty() || acts.iter().any(own) {
        return acts;
    }
    let fact = plain(reading, Act::Hold, number);
    acts.insert(0, fact);
    acts
}

/// "It passed the van and went into the intersection. While passing it, it touched its mirror": of an intersection that it was only on its
/// way into, the words are not kept.
fn told_ahead(reading: &Reading<'_>, all: &mut [ActFact]) {
    for at in 1..all.len().saturating_sub(1) {
        let again = all[at - 1].act == Act::Pass && all[at + 1].act == Act::Pass && !all[at + 1].after_contact;
        if all[at].act == Act::Enter && again {
            all[at].source = reading.of(&reading.story.frames[all[at].step as usize]);
        }
    }
}

/// "was rear-ended at low speed by a van", "touched its bumper at high speed": how who struck came, told with the contact itself.
fn with_contact(reading: &Reading<'_>, actor: Actor, all: &mut Vec<ActFact>) {
    let Some(number) = reading.contacts.first else { return };
    let frame = &reading.story.frames[number];
    let Some(manner) = manner(reading, number).filter(|_| frame.who == Some(actor)) else { return };
    if let Some(last) = all.iter_mut().rfind(|fact| !fact.after_contact) {
        last.manner = last.manner.or(Some(manner));
        return;
    }
    let fact = ActFact { manner: Some(manner), ..plain(reading, Act::Follow, number) };
    all.insert(0, fact);
}

/// "nudged away from it": away from the side on which the other one is.
pub(super) fn move_away(account: &mut Account) {
    use recrash_model::account::{Origin, Source, told};
    let side = match told(&account.came_from) {
        Some(Origin::Beside { side } | Origin::Cross { side }) => side,
        Some(Origin::Parked { side } | Origin::Stall { side } | Origin::Driveway { side }) => match side {
            Some(side) => side,
            None => return,
        },
        _ => return,
    };
    for fact in account.sv.acts.iter_mut().filter(|fact| matches!(fact.act, Act::Drift | Act::Swerve)) {
        let away =
            matches!(&fact.source, Source::Words { text, .. } if text.contains("away") || text.contains("a nudge"));
        if away && fact.side.is_none() && !fact.after_contact {
            fact.side = Some(side.other());
        }
    }
}

/// "completed its left turn", "after it had turned", "had turned".
fn is_done(reading: &Reading<'_>, frame: &Frame) -> bool {
    let first = reading.story.word(frame.first);
    // "A van that had made the turn before it".
    let had = (1..3).any(|back| frame.first.checked_sub(back).is_some_and(|at| reading.story.word(at) == "had"));
    // "It had just crossed the intersection".
    let through = || {
        (frame.first..frame.end).any(|at| {
            ["cross", "through", "travers", "clear"].iter().any(|stem| reading.story.word(at).starts_with(stem))
        })
    };
    let passed = match frame.act() {
        Some(Act::Turn | Act::UTurn) => true,
        Some(Act::Enter | Act::Cross) => through(),
        _ => false,
    };
    let turned = had && passed && frame.progress == Progress::Real;
    // "After the light changed and it began its turn": begun.
    frame.joint == Some(Joint::After) && !begins(reading, frame)
        || turned
        || ["complet", "finish", "exit"].iter().any(|start| first.starts_with(start))
}

fn stands(fact: &ActFact) -> bool {
    fact.act.stands()
}

/// Whether an act is told behind "after", of the clause with the act of this number before it: "stopped after turning left".
fn is_behind_after(reading: &Reading<'_>, frame: &Frame, before: usize) -> bool {
    let main = &reading.story.frames[before];
    let after = frame.first.checked_sub(1).is_some_and(|at| reading.story.word(at) == "after")
        && reading.story.word(frame.first).ends_with("ing");
    // "stopped, having turned left".
    let having = frame
        .first
        .checked_sub(2)
        .is_some_and(|at| reading.story.word(at) == "," && reading.story.word(at + 1) == "having");
    let behind = after || having;
    behind && main.sentence == frame.sentence && main.joint != Some(Joint::After)
}

/// "It was stopped, and was partially in the next lane": where it stood, to which it had come before.
pub(super) fn tells_where(reading: &Reading<'_>, frame: &Frame) -> bool {
    let words = &reading.story.tokens[frame.first..frame.end];
    let partly = words.iter().any(|token| matches!(token.text.as_str(), "partially" | "partly"));
    frame.act() == Some(Act::Drift) && partly && matches!(words[0].text.as_str(), "was" | "were" | "is")
}

/// "slowed to a stop while entering the intersection": it came in, and stopped there.
fn enters_as_it_stops(reading: &Reading<'_>, fact: &ActFact, frame: &Frame, last: &ActFact) -> bool {
    let stop = &reading.story.frames[last.step as usize];
    let inner = frame.joint == Some(Joint::While) && stop.joint != Some(Joint::While) && frame.form == Form::Ing;
    fact.act == Act::Enter
        && last.act == Act::Stop
        && inner
        && stop.sentence == frame.sentence
        && frame.clause > stop.clause
}

/// "It slid on the wet road. This caused the front of the car to touch it": nobody pushed the car.
fn merely_caused(reading: &Reading<'_>, number: usize, frame: &Frame) -> bool {
    let tokens = &reading.story.tokens;
    let word = tokens[frame.first].text.as_str();
    let before = &tokens[reading.story.sentences[frame.sentence].first..frame.first];
    let blow = |token: &Token| {
        matches!(token.text.as_str(), "impact" | "collision" | "contact" | "force" | "crash" | "hit" | "struck")
    };
    let touched = reading.story.frames[..number].iter().any(|other| {
        let of_others = other.is_contact() && ![other.who, other.object].contains(&Some(SUBJECT));
        // "causing it to brake" pushes nobody.
        let pushes = !tokens[other.first].text.starts_with("caus");
        of_others || pushes && other.sense == Sense::Push && other.happened()
    });
    word.starts_with("caus") && !touched && !before.iter().any(blow)
}
