//! Why somebody stood.

use super::Reading;
use super::controls::{in_its_queue, is_lamp, shown};
use crate::frame::Frame;
use crate::lexicon::{COMPANY, Lexicon, Meaning, Progress, Relation, Sense};
use crate::token::{Token, word};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Fact, Kind, KindGroup, SignalState, Source, StandReason};

/// Why somebody stood: named with the last thing that made it stand.
pub(super) fn reasons(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<StandReason>> {
    let mut why = Why { reading, all: Vec::new() };
    let mut since = 0;
    for (number, frame) in reading.before(actor) {
        if moves(frame) && !frame.aside && number > since {
            why.all.clear();
        }
        let waits = stands(frame) || (frame.progress == Progress::Wished && !why.all.is_empty());
        if waits && !frame.negated {
            since = number;
            why.of_stand(number, frame);
        }
    }
    why.told_most()
}

/// Whether a frame tells that somebody stood, or was about to.
fn stands(frame: &Frame) -> bool {
    matches!(frame.act(), Some(Act::Hold | Act::Stop | Act::Slow | Act::PullOver))
        || frame.act() == Some(Act::Park) && frame.progress == Progress::Real
        || matches!(frame.sense, Sense::Yield | Sense::Parked)
}

/// Whether a frame tells that somebody drove on.
fn moves(frame: &Frame) -> bool {
    frame.happened()
        && matches!(
            frame.act(),
            Some(Act::SetOff | Act::Enter | Act::Turn | Act::Reverse | Act::LaneChange | Act::Follow | Act::Pass)
        )
}

/// The reasons that were found so far.
struct Why<'a> {
    reading: &'a Reading<'a>,
    all: Vec<Fact<StandReason>>,
}

impl Why<'_> {
    /// Whether a reason was found.
    fn has(&self, reason: StandReason) -> bool {
        self.all.iter().any(|known| known.value == reason)
    }

    /// Adds a reason, once.
    fn add(&mut self, reason: Fact<StandReason>) {
        if !self.has(reason.value) {
            self.all.push(reason);
        }
    }

    /// Adds why somebody stood of whom this frame tells it.
    fn of_stand(&mut self, number: usize, frame: &Frame) {
        let reading = self.reading;
        let (first, end) = reading.window(number);
        // A reason may stand before: "due to a queue, it stopped".
        let leads = self.all.is_empty() && !frame.aside;
        let begins = if leads { lead_in(reading, number).unwrap_or(first) } else { first };
        let sentence = reading.story.sentences[frame.sentence];
        let (own, end) = (end.min(sentence.end), in_its_queue(reading, number, end).min(sentence.end));
        // What happened while it stood is not why: "was stopped when an ambulance passed".
        let stood = frame.act() == Some(Act::Hold);
        let then = (frame.end..end).find(|at| stood && reading.story.tokens[*at].text == "when").unwrap_or(end);
        self.named(begins, own, then);
        if let Some(reason) = because(reading, number).filter(|_| self.all.is_empty()) {
            self.all.push(reason);
        }
        if let Some((reason, at, length)) = blocked_by(reading, end) {
            self.add(reading.told(reason, at, at + length));
        }
        self.by_whom(number, frame);
    }

    /// Adds the reasons that words name between two tokens; behind `own` they are told of a queue.
    fn named(&mut self, begins: usize, own: usize, end: usize) {
        let (reading, tokens) = (self.reading, &self.reading.story.tokens);
        let named = Lexicon::get().reasons(&tokens[begins..end]);
        let red = (begins..end).find(|at| matches!(shown(reading, *at, end), Some((_, Some(SignalState::Red), _))));
        if let Some(at) = red {
            self.add(reading.told(StandReason::RedLight, at, at + 1));
        }
        for (reason, at, length) in named.iter().copied() {
            // Words that say more say all: "waiting for the" of "waiting for the intersection to clear".
            let within = |(other, from, count): &(StandReason, usize, usize)| {
                *other != reason && rank(*other) < rank(reason) && *from < at + length && at < from + count
            };
            // "behind a van that was letting out passengers": why the van stood.
            let of_queue = begins + at >= own && !matches!(reason, StandReason::RedLight | StandReason::Queue);
            if !of_queue && !says_another_thing(reading, reason, begins + at, length) && !named.iter().any(within) {
                self.add(reading.told(reason, begins + at, begins + at + length));
            }
        }
    }

    /// Adds why by whom it stood for, or behind.
    fn by_whom(&mut self, number: usize, frame: &Frame) {
        let reading = self.reading;
        let actors = &reading.story.world.actors;
        let behind = frame.relations.iter().find_map(|(relation, to)| {
            let to = (*to).filter(|to| *to != SUBJECT)?;
            (*relation == Relation::Behind).then_some(to)
        });
        let yields = matches!(frame.sense, Sense::Yield | Sense::Act(Act::Stop | Act::Slow | Act::Hold));
        let yields_to = frame.object.filter(|_| yields);
        if let Some(reason) = yields_to.and_then(|to| actors[to].kind).and_then(waits_for)
            && self.all.is_empty()
        {
            self.all.push(Fact { value: reason, source: reading.of(frame) });
        }
        // Whom it met is in front of it only where that is told.
        let met = |lead: &Actor| {
            let ahead = |(relation, _): &(Relation, usize)| *relation == Relation::Ahead;
            Some(*lead) == reading.contacts.partner && !actors[*lead].relations.iter().any(ahead)
        };
        let lead = behind.or(yields_to.filter(|lead| !met(lead)));
        let Some(lead) = lead.filter(|lead| actors[*lead].kind.is_some_and(Kind::is_vehicle)) else { return };
        let ahead = behind.is_some() || stands_still(reading, lead, number);
        if ahead && !actors[lead].several {
            let parked = reading.before(lead).any(|(_, frame)| frame.sense == Sense::Parked);
            let value = if parked { StandReason::BlockedPath } else { StandReason::LeadVehicle };
            self.add(Fact { value, source: reading.of(frame) });
        }
    }

    /// The two that say most; of those whose words lie within those of another, that one.
    fn told_most(mut self) -> Vec<Fact<StandReason>> {
        self.all.sort_by_key(|reason| rank(reason.value));
        let mut kept: Vec<Fact<StandReason>> = Vec::new();
        for reason in self.all {
            if !kept.iter().any(|other| is_within(&reason.source, &other.source)) {
                kept.push(reason);
            }
        }
        kept.truncate(2);
        kept
    }
}

/// Whether words that name a reason say another thing here.
fn says_another_thing(reading: &Reading<'_>, reason: StandReason, at: usize, length: usize) -> bool {
    let tokens = &reading.story.tokens;
    let other = match reason {
        StandReason::Pedestrian => is_a_place(tokens, at),
        // "slowing for a passenger car".
        StandReason::PickupDropoff => tokens.get(at + length).is_some_and(|next| {
            matches!(next.text.as_str(), "car" | "cars" | "vehicle" | "vehicles" | "van" | "sedan" | "suv")
        }),
        StandReason::RedLight => is_lamp(reading, (at, length)) || shows_another_colour(reading, at, length),
        StandReason::Queue => is_behind_it(tokens, at + length),
        _ => false,
    };
    other || is_of_another(tokens, at, reason)
}

/// "let" of "to let out a passenger": words within those of another reason say nothing more.
fn is_within(words: &Source, others: &Source) -> bool {
    match (words, others) {
        (Source::Words { start, end, .. }, Source::Words { start: from, end: until, .. }) => {
            start >= from && end <= until && end - start < until - from
        }
        _ => false,
    }
}

/// "stopped because cars ahead had stopped", "so a woman could cross": why, told in the clause behind.
fn because(reading: &Reading<'_>, number: usize) -> Option<Fact<StandReason>> {
    let (story, frame) = (&reading.story, &reading.story.frames[number]);
    let other = |(_, next): &(usize, &Frame)| next.first > frame.first && !next.aside && next.who != frame.who;
    let here = |(_, next): &(usize, &Frame)| next.sentence == frame.sentence;
    let (at, next) = story.frames.iter().enumerate().skip(number + 1).take_while(here).find(other)?;
    // "as cars ahead were queued", and not "as a van hit it".
    let stands = next.act().is_some_and(Act::stands) && next.happened();
    let queued = stands && next.who.is_some_and(|who| story.world.actors[who].several);
    let why = |token: &Token| matches!(token.text.as_str(), "because" | "since" | "so") || queued && token.text == "as";
    let joint = (frame.end..next.first.max(frame.end)).find(|at| why(&story.tokens[*at]))?;
    let who = next.who.filter(|_| !next.is_contact())?;
    let (_, end) = reading.window(at);
    let named = Lexicon::get().reasons(&story.tokens[joint..end]);
    if let Some((reason, from, length)) = named.into_iter().min_by_key(|(reason, ..)| rank(*reason)) {
        return Some(reading.told(reason, joint + from, joint + from + length));
    }
    let known = &story.world.actors[who];
    let kind = known.kind?;
    let stands = next.act().is_some_and(Act::slows) && next.happened();
    let ahead = known.relations.iter().any(|(relation, _)| *relation == Relation::Ahead);
    let value = match waits_for(kind) {
        Some(reason) => reason,
        None if !kind.is_vehicle() => return None,
        None if stands && known.several => StandReason::Queue,
        None if stands && ahead => StandReason::LeadVehicle,
        None if next.progress == Progress::Wished => StandReason::Yield,
        None => return None,
    };
    Some(Fact { value, source: reading.of(next) })
}

/// "stopped for a bus discharging riders": why the bus stood.
fn is_of_another(tokens: &[Token], at: usize, reason: StandReason) -> bool {
    let kind = |at: usize| Lexicon::get().longest(tokens, at, |meaning| matches!(meaning, Meaning::Kind(_))).is_some();
    let ing = tokens[at].text.ends_with("ing");
    reason == StandReason::PickupDropoff && ing && at.checked_sub(1).is_some_and(kind)
}

/// "was stopped at a red light with a line of vehicles behind it": it stands in no queue for that. The token behind "line of".
fn is_behind_it(tokens: &[Token], end: usize) -> bool {
    let several = matches!(word(tokens, end), "vehicles" | "cars" | "traffic" | "trucks");
    let at = end + usize::from(several);
    let own = matches!(
        (word(tokens, at + 1), word(tokens, at + 2)),
        ("it" | "them", _) | ("the", "av" | "vehicle" | "subject" | "ego" | COMPANY)
    );
    word(tokens, at) == "behind" && own
}

/// "stopped for a paramedic on foot": why, by whom it stops for.
fn waits_for(kind: Kind) -> Option<StandReason> {
    match kind {
        Kind::PoliceCar | Kind::Ambulance | Kind::FireTruck | Kind::FirstResponder => {
            Some(StandReason::EmergencyVehicle)
        }
        kind => match kind.group() {
            KindGroup::OnFoot | KindGroup::Cyclist => Some(StandReason::Pedestrian),
            KindGroup::Animal => Some(StandReason::Animal),
            _ => None,
        },
    }
}

/// "stopped behind a van that was blocking the intersection": what the clause about the van, which begins before this token, tells of the way.
fn blocked_by(reading: &Reading<'_>, behind: usize) -> Option<(StandReason, usize, usize)> {
    let tokens = &reading.story.tokens;
    let word = |back: usize| behind.checked_sub(back).map_or("", |at| tokens[at].text.as_str());
    if !(matches!(word(2), "that" | "which") && matches!(word(1), "was" | "is" | "had")) {
        return None;
    }
    let ends = |token: &Token| matches!(token.text.as_str(), "," | "." | "and" | "when" | "as");
    let clause = tokens[behind..].iter().position(ends).map_or(tokens.len(), |length| behind + length);
    let named = Lexicon::get().reasons(&tokens[behind..clause]);
    let blocks = |reason: StandReason| matches!(reason, StandReason::BlockedJunction | StandReason::BlockedPath);
    let most = named.into_iter().filter(|(reason, ..)| blocks(*reason)).min_by_key(|(reason, ..)| rank(*reason));
    most.map(|(reason, at, length)| (reason, behind + at, length))
}

/// "just past the crosswalk", "short of the crosswalk": where, and for nobody.
fn is_a_place(tokens: &[Token], at: usize) -> bool {
    let word = |back: usize| at.checked_sub(back).map_or("", |at| tokens[at].text.as_str());
    let article = usize::from(matches!(word(1), "the" | "a" | "its"));
    tokens[at].text == "crosswalk"
        && matches!(word(1 + article), "past" | "beyond" | "before" | "behind" | "over" | "near" | "of" | "after")
}

/// "by a green traffic light": a light of which no red is told makes nobody stand.
fn shows_another_colour(reading: &Reading<'_>, at: usize, length: usize) -> bool {
    let tokens = &reading.story.tokens;
    let red = |token: &Token| token.text == "red" || token.text == "stoplight";
    let until = reading.until().min(tokens.len());
    let stop = tokens[at..at + length].iter().any(|token| token.text == "stop" || token.text == "stoplight");
    let green = tokens[..at].iter().any(|token| token.text == "green");
    green && !stop && !tokens[..until].iter().any(red)
}

fn stands_still(reading: &Reading<'_>, actor: Actor, number: usize) -> bool {
    reading
        .story
        .frames
        .iter()
        .skip(number)
        .take(3)
        .any(|frame| frame.who == Some(actor) && frame.act().is_some_and(Act::stands))
}

/// Where the clause of a frame begins, where a reason leads it in.
fn lead_in(reading: &Reading<'_>, number: usize) -> Option<usize> {
    let frame = &reading.story.frames[number];
    let sentence = reading.story.sentences[frame.sentence];
    // "After dropping off a rider, it stopped", "vehicles were queued, so it stopped": why, told in a clause before.
    let riders = |other: &Frame| {
        let word = reading.story.tokens[other.first].text.as_str();
        let lets = ["drop", "pick", "let", "load", "unload"].iter().any(|stem| word.starts_with(stem));
        other.sense == Sense::Other && lets || other.sense == Sense::See
    };
    let queue = |other: &Frame| {
        let several = other.who.is_some_and(|who| reading.story.world.actors[who].several && who != SUBJECT);
        several && !other.is_contact() && matches!(other.act(), None | Some(Act::Hold | Act::Stop))
    };
    let mut before = reading.story.frames[..number].iter().rev();
    let before =
        before.find(|other| other.sentence == frame.sentence && !other.aside && !riders(other) && !queue(other));
    Some(before.map_or(sentence.first, |before| before.end)).filter(|first| *first < frame.first)
}

/// Which of several reasons says most.
fn rank(reason: StandReason) -> u8 {
    match reason {
        StandReason::PickupDropoff => 0,
        StandReason::BlockedJunction => 1,
        StandReason::Animal => 2,
        StandReason::EmergencyVehicle => 3,
        StandReason::Barrier => 4,
        StandReason::Queue => 5,
        StandReason::Pedestrian => 6,
        StandReason::RedLight => 7,
        StandReason::LeadVehicle => 8,
        StandReason::BlockedPath => 9,
        StandReason::Yield => 10,
        StandReason::StopSign => 11,
        StandReason::Parked => 12,
    }
}
