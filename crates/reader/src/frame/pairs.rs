//! What is told of several at once, or of a thing by what somebody else does: "both vehicles set off", "a box from a truck struck it".

use super::Frame;
use crate::lexicon::Sense;
use crate::token::Token;
use crate::world::{Actor, Known, SUBJECT, World};
use recrash_model::account::{Act, Kind};

/// Gives the frames of a story to whom they are told of.
pub(super) fn apply(frames: &mut Vec<Frame>, world: &mut World, tokens: &[Token]) {
    of_both(frames, world, tokens);
    came_off(frames, world, tokens);
    thrown(frames, world, tokens);
}

/// "It followed a van, and both vehicles stopped at a light": it and the only other one that is known by then, up to the crash.
fn of_both(frames: &mut Vec<Frame>, world: &mut World, tokens: &[Token]) {
    let met = |frame: &Frame| frame.is_contact() && frame.who.is_some() && frame.object.is_some();
    let crash =
        frames.iter().rposition(met).or_else(|| frames.iter().position(Frame::is_contact)).unwrap_or(frames.len());
    for number in (0..crash).rev() {
        let frame = &frames[number];
        let Some(pair) = frame.who.filter(|who| *who != SUBJECT && world.actors[*who].several) else { continue };
        if frame.act().is_none() || !says_both(tokens, frame.first) {
            continue;
        }
        let Some(other) = only_other(world, pair, frame.first) else { continue };
        let twin = Frame { who: Some(other), ..frame.clone() };
        frames[number].who = Some(SUBJECT);
        frames.insert(number + 1, twin);
        let (heading, lane) = (world.actors[pair].heading, world.actors[pair].lane);
        for actor in [SUBJECT, other] {
            let known = &mut world.actors[actor];
            (known.heading, known.lane) = (known.heading.or(heading), known.lane.or(lane));
        }
        world.actors[pair].mentions = 0;
    }
}

/// Whether "both vehicles" is the subject of the verb that begins here.
fn says_both(tokens: &[Token], first: usize) -> bool {
    let before = &tokens[first.saturating_sub(BOTH_BEFORE)..first];
    let pair = |words: &[Token]| {
        matches!(words[0].text.as_str(), "both" | "two")
            && matches!(words[1].text.as_str(), "vehicles" | "cars" | "trucks")
    };
    // "Both vehicles ahead stopped" tells of two others.
    let small = |token: &Token| {
        let word = token.text.as_str();
        matches!(
            word,
            "were" | "had" | "have" | "then" | "began" | "started" | "to" | "also" | "both" | "been" | "already"
        ) || word.ends_with("ly")
    };
    before.windows(2).rposition(pair).is_some_and(|at| before[at + 2..].iter().all(small))
}

/// "both vehicles began to proceed": so many words stand before the verb. [tokens]
const BOTH_BEFORE: usize = 4;

/// The only vehicle beside the subject vehicle that was named before a token.
fn only_other(world: &World, pair: Actor, first: usize) -> Option<Actor> {
    let known = |(actor, known): &(Actor, &Known)| {
        let named = known.kind_tokens.is_some_and(|(at, _)| at < first);
        *actor != pair && !known.several && named && known.kind.is_some_and(Kind::is_vehicle)
    };
    let mut others = world.actors.iter().enumerate().skip(1).filter(known);
    let (only, more) = (others.next()?, others.next());
    more.is_none().then_some(only.0)
}

/// "A box from a truck struck it": the box came off the truck.
fn came_off(frames: &mut Vec<Frame>, world: &World, tokens: &[Token]) {
    let first = frames.iter().position(Frame::is_contact);
    let Some(number) = first.filter(|number| frames[*number].object == Some(SUBJECT)) else {
        return;
    };
    let frame = &frames[number];
    let Some(who) = frame.who.filter(|who| is_loose(world, *who)) else { return };
    // "was struck by a box from a truck".
    let named = |end: usize| end < frame.first || frame.passive && end <= frame.end;
    let Some((_, end)) = world.actors[who].kind_tokens.filter(|(_, end)| named(*end)) else { return };
    let from = tokens.get(end).is_some_and(|next| matches!(next.text.as_str(), "from" | "off"));
    let vehicle = |known: &Known| {
        known.kind.is_some_and(Kind::is_vehicle)
            && known
                .kind_tokens
                .is_some_and(|(at, _)| (end..frame.first.max(end + OFF_WITHIN)).contains(&at) || at < end)
    };
    let own = world.actors.iter().skip(1).any(vehicle);
    let told = frames[..number].iter().any(|before| before.who == Some(who) && before.act().is_some());
    if from && own && !told {
        let falls = Frame {
            sense: Sense::Act(Act::Fall),
            object: None,
            on: None,
            with: None,
            end: end + 1,
            first: end,
            ..frame.clone()
        };
        frames.insert(number, falls);
    }
}

/// "a box from a large white truck": so near stands the vehicle. [tokens]
const OFF_WITHIN: usize = 6;

/// "A man threw a bottle toward it": the bottle came along.
fn thrown(frames: &mut Vec<Frame>, world: &World, tokens: &[Token]) {
    const THROWS: [&str; 6] = ["threw", "throw", "toss", "hurl", "lobb", "flung"];
    for number in (0..frames.len()).rev() {
        let frame = &frames[number];
        let throws = THROWS.iter().any(|stem| tokens[frame.first].text.starts_with(stem));
        let other = frame.who.is_some_and(|who| who != SUBJECT);
        let Some(thing) = frame.object.filter(|thing| throws && other && is_loose(world, *thing)) else { continue };
        if frame.happened() && frame.act().is_none() {
            let comes =
                Frame { who: Some(thing), object: None, sense: Sense::Act(Act::Roll), person: None, ..frame.clone() };
            frames.insert(number + 1, comes);
        }
    }
}

/// Whether it is a thing that may come off a vehicle, or be thrown.
fn is_loose(world: &World, actor: Actor) -> bool {
    let loose = |kind: Kind| {
        matches!(kind, Kind::Debris | Kind::LooseWheel | Kind::Cargo | Kind::Object | Kind::Cart | Kind::Cone)
    };
    world.actors[actor].kind.is_some_and(loose)
}
