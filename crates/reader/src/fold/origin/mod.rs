//! From where the partner and the others come, seen from the subject vehicle before any turn.

mod fallback;
mod places;
mod road_user;

use super::Reading;
use super::party::has_zone;
use crate::frame::Frame;
use crate::lexicon::{Relation, Sense};
use crate::world::{Actor, SUBJECT};
use fallback::{by_columns, by_side, zone_side};
pub(super) use places::{at_curb, on_side_street, side_named_at, side_of_road_of};
use recrash_model::account::{
    Account, Act, ContactState, Fact, Kind, KindGroup, LaneWord, LeftRight, Origin, Source, told,
};
use recrash_model::zones::ContactZone as Z;
use road_user::of_road_user;

/// What is known of where somebody comes from.
pub(super) struct Clues<'a> {
    pub(super) reading: &'a Reading<'a>,
    pub(super) actor: Actor,
}

impl Clues<'_> {
    /// Where it is, as told up to the contact.
    fn relations(&self) -> impl Iterator<Item = Relation> {
        let contact =
            self.reading.contacts.first.map_or(usize::MAX, |number| self.reading.story.frames[number].sentence);
        let known = &self.reading.story.world.actors[self.actor];
        let early = known.relations.iter().any(|(_, sentence)| *sentence <= contact);
        let back = &self.reading.back;
        let told = move |sentence: usize| {
            sentence <= contact
                || back.contains(&sentence)
                || self.reading.looks_back_from_crash(sentence)
                || !early && self.reading.had_before(sentence)
        };
        known.relations.iter().filter(move |(_, sentence)| told(*sentence)).map(|(relation, _)| *relation)
    }

    pub(super) fn any(&self, relation: Relation) -> bool {
        self.relations().any(|known| known == relation)
    }

    fn side(&self) -> Option<LeftRight> {
        self.relations().find_map(|relation| match relation {
            Relation::Left => Some(LeftRight::Left),
            Relation::Right => Some(LeftRight::Right),
            _ => None,
        })
    }

    /// Tokens of a frame in which this relation, or any, is told.
    fn source(&self, wanted: impl Fn(&crate::frame::Frame) -> bool) -> Source {
        let reading = self.reading;
        let frame = reading.story.frames.iter().find(|frame| frame.who == Some(self.actor) && wanted(frame));
        match frame {
            Some(frame) => {
                let number = reading.story.frames.iter().position(|other| std::ptr::eq(other, frame)).unwrap_or(0);
                let (first, end) = reading.window(number);
                reading.words(first, end)
            }
            None => {
                let sentence = reading.contacts.first.map_or(0, |number| reading.story.frames[number].sentence);
                let sentence = reading.story.sentences[sentence];
                reading.words(sentence.first, sentence.end)
            }
        }
    }

    pub(super) fn has(&self, relation: Relation) -> Source {
        let reading = self.reading;
        let told = |frame: &Frame| frame.relations.iter().any(|(known, _)| *known == relation);
        // Of a noun alone: "a van in the next lane". The sentence that names it.
        let of_noun = || {
            let known = &reading.story.world.actors[self.actor];
            let (_, sentence) = known.relations.iter().find(|(known, _)| *known == relation)?;
            Some(reading.story.sentences[*sentence])
        };
        let by_frame = reading.story.frames.iter().any(|frame| frame.who == Some(self.actor) && told(frame));
        match of_noun().filter(|_| !by_frame) {
            Some(sentence) => reading.words(sentence.first, sentence.end),
            None => self.source(told),
        }
    }
}

/// Whether a partner from beside was ahead at first, or behind: as told before it left its line, or passed.
pub(crate) fn ahead(reading: &Reading<'_>, account: &Account) -> Option<Fact<bool>> {
    let Some(Origin::Beside { .. }) = told(&account.came_from) else { return None };
    let actor = reading.contacts.partner?;
    let leaves = |act: Act| matches!(act, Act::LaneChange | Act::Swerve | Act::Drift | Act::Pass | Act::Turn);
    let places = |relation: &Relation| matches!(relation, Relation::Ahead | Relation::Behind);
    let on_its_line = reading.before(actor).take_while(|(_, frame)| !frame.act().is_some_and(leaves));
    let mut seen =
        on_its_line.flat_map(|(number, frame)| frame.relations.iter().map(move |(relation, _)| (number, *relation)));
    let told_on_its_line = seen.find(|(_, relation)| places(relation));
    // Whoever changes lanes in front of it was ahead, and so was whom it came near.
    let cuts_in = || {
        let changes = |frame: &Frame| matches!(frame.act(), Some(Act::LaneChange | Act::Enter)) && frame.happened();
        let in_front = |frame: &Frame| {
            let told = frame.relations.iter().any(|(relation, _)| *relation == Relation::Ahead);
            // Who passed somebody before that came from farther back.
            told || cuts_off(reading, frame) && !reading.did(actor, Act::Pass)
        };
        let found = reading.before(actor).find(|(_, frame)| changes(frame) && in_front(frame));
        found.map(|(number, _)| (number, Relation::Ahead))
    };
    let neared = || {
        let near = |frame: &Frame| frame.sense == Sense::Approach && frame.happened() && frame.object == Some(actor);
        reading.before(SUBJECT).find(|(_, frame)| near(frame)).map(|(number, _)| (number, Relation::Ahead))
    };
    let of_itself = || in_its_own_words(reading, actor, leaves);
    let (number, relation) = told_on_its_line.or_else(of_itself).or_else(cuts_in).or_else(neared)?;
    let (first, end) = reading.window(number);
    Some(Fact { value: relation == Relation::Ahead, source: reading.words(first, end) })
}

/// "cut in front of the AV", "cut it off": the verb itself says where.
fn cuts_off(reading: &Reading<'_>, frame: &Frame) -> bool {
    let words: Vec<&str> =
        reading.story.tokens[frame.first..frame.end].iter().map(|token| token.text.as_str()).collect();
    matches!(words.as_slice(), ["cut" | "cutting" | "cuts", "in" | "off", ..])
}

/// "A van in the left lane and in front of the AV began to change lanes": told of whom, and not with what it did. With the number of the
/// frame in which it is told, or the first behind it.
fn in_its_own_words(reading: &Reading<'_>, actor: Actor, leaves: impl Fn(Act) -> bool) -> Option<(usize, Relation)> {
    let left = reading.before(actor).find(|(_, frame)| frame.happened() && frame.act().is_some_and(&leaves))?;
    let (relation, sentence) = reading.story.world.actors[actor].relations.iter().find(|(relation, sentence)| {
        matches!(relation, Relation::Ahead | Relation::Behind) && *sentence <= left.1.sentence
    })?;
    let number =
        reading.before(actor).find(|(_, frame)| frame.sentence >= *sentence).map_or(left.0, |(number, _)| number);
    Some((number, *relation))
}

/// From where the partner came.
pub(crate) fn came_from(reading: &Reading<'_>, account: &Account) -> Option<Fact<Origin>> {
    let partner = account.partner.as_ref()?;
    let kind = partner.kind.as_ref().map(|kind| kind.value);
    let Some(actor) = reading.contacts.partner else {
        let thing = kind.is_some_and(|kind| kind.group() == KindGroup::Object);
        let backs = told(&account.sv.state) == Some(ContactState::Reversing);
        return if thing && forward(account) {
            Some(Fact::by_rule(Origin::Ahead, "a thing that the subject vehicle drives into is ahead of it"))
        } else if thing && backs && account.sv.zones.iter().all(|zone| zone.value.is_rear()) {
            Some(Fact::by_rule(Origin::Behind, "a thing that the subject vehicle backs into is behind it"))
        } else {
            by_columns(reading, account)
        };
    };
    let clues = Clues { reading, actor };
    if kind.is_some_and(|kind| kind.group() == KindGroup::Object) {
        return of_thing(&clues, account);
    }
    let origin =
        of_road_user(&clues, account).or_else(|| by_columns(reading, account)).or_else(|| by_side(&clues, account));
    // Thrown "to the right" at its left side, it was on the left before.
    let thrown = reading.did(actor, Act::Pushed) || !reading.contacts.earlier.is_empty();
    match (origin.as_ref().map(|fact| fact.value), zone_side(account)) {
        (Some(Origin::Beside { side: told }), Some(side)) if thrown && told != side => {
            Some(Fact::by_rule(Origin::Beside { side }, "thrown at that side"))
        }
        _ => origin,
    }
}

fn forward(account: &Account) -> bool {
    told(&account.sv.state).is_some_and(|state| matches!(state, ContactState::Moving | ContactState::SettingOff))
}

fn of_thing(clues: &Clues<'_>, account: &Account) -> Option<Fact<Origin>> {
    if clues.reading.did(clues.actor, Act::Fall) && told(&account.partner.as_ref()?.kind) == Some(Kind::TreeBranch) {
        return Some(Fact { value: Origin::Above, source: clues.source(|frame| frame.act() == Some(Act::Fall)) });
    }
    if let Some(side) = clues.side() {
        return Some(Fact { value: Origin::Beside { side }, source: clues.has(relation_to(side)) });
    }
    let kind = told(&account.partner.as_ref()?.kind);
    let fixed = matches!(kind, Some(Kind::Wall | Kind::Pole | Kind::Curb | Kind::Gate | Kind::Barrier | Kind::Sign));
    // What runs along the road is met with its corner.
    let along = matches!(kind, Some(Kind::Curb | Kind::Barrier));
    let plain_front = has_zone(&account.sv, |zone| zone == Z::Front) && !along;
    if let (true, false, Some(side)) = (fixed, plain_front, zone_side(account)) {
        return Some(Fact::by_rule(
            Origin::Beside { side },
            "what stands beside the way is on the side that touches it",
        ));
    }
    let rolls = account.partner.as_ref()?.did(Act::Roll);
    // "rolling south", of one that goes west.
    let way = |party: &recrash_model::account::Party| party.heading.as_ref().map(|heading| heading.value);
    let across = way(&account.sv).zip(account.partner.as_ref().and_then(way)).map(|(own, other)| own.eighths_to(other));
    if let (true, Some(2 | 6)) = (rolls, across) {
        let side = if across == Some(2) { LeftRight::Left } else { LeftRight::Right };
        return Some(Fact::by_rule(Origin::Beside { side }, "what rolls across comes from where it rolls"));
    }
    if let Some(side) = came_off(clues, account).filter(|_| rolls) {
        return Some(Fact::by_rule(Origin::Beside { side }, "what rolls comes from the lane of whom it came off"));
    }
    if let (true, Some(side)) = (rolls, zone_side(account)) {
        return Some(Fact::by_rule(Origin::Beside { side }, "what rolls comes from the side that it touches"));
    }
    if let Some(flies) = flies_into(clues, account) {
        return Some(flies);
    }
    let lies = matches!(kind, Some(Kind::Debris | Kind::Pothole | Kind::Object | Kind::LooseWheel))
        && account.partner.as_ref()?.acts.is_empty();
    let on_road = forward(account)
        && (lies || zone_side(account).is_none() && !account.sv.zones.iter().any(|zone| zone.value.is_rear()));
    if on_road || has_zone(&account.sv, |zone| zone.is_front()) {
        return Some(Fact::by_rule(
            Origin::Ahead,
            "a thing that the front of the subject vehicle touches is ahead of it",
        ));
    }
    let reverses = told(&account.sv.state) == Some(ContactState::Reversing);
    if reverses && has_zone(&account.sv, |zone| zone.is_rear()) {
        return Some(Fact::by_rule(
            Origin::Behind,
            "a thing that the rear of the reversing subject vehicle touches is behind it",
        ));
    }
    zone_side(account).map(|side| Fact::by_rule(Origin::Beside { side }, "the side that the thing touches"))
}

/// "the wheel bounced into its right side": from there.
fn flies_into(clues: &Clues<'_>, account: &Account) -> Option<Fact<Origin>> {
    const MOVES: [&str; 8] = ["roll", "bounc", "slid", "skid", "flew", "fly", "tumbl", "blew"];
    let reading = clues.reading;
    let frame = &reading.story.frames[reading.contacts.first?];
    let verb = reading.story.tokens[frame.first].text.as_str();
    let moves = frame.who == Some(clues.actor) && !frame.passive && MOVES.iter().any(|stem| verb.starts_with(stem));
    let flank = account.sv.zones.iter().all(|zone| matches!(zone.value, Z::Left | Z::Right));
    let side = zone_side(account).filter(|_| moves && flank)?;
    Some(Fact { value: Origin::Beside { side }, source: reading.of(frame) })
}

/// Whether somebody is told to go the other way: its lanes are others.
pub(super) fn comes_against(clues: &Clues<'_>) -> bool {
    let actors = &clues.reading.story.world.actors;
    let heading = |actor: Actor| actors[actor].heading.map(|(compass, ..)| compass);
    let turn = heading(SUBJECT).zip(heading(clues.actor)).map(|(own, other)| own.eighths_to(other));
    matches!(turn, Some(3..=5))
}

/// The side on which the vehicle drives that lost a thing: the only other one that is told of.
fn came_off(clues: &Clues<'_>, account: &Account) -> Option<LeftRight> {
    let actors = || clues.reading.story.world.actors.iter().enumerate().skip(1);
    let vehicle = |kind: Option<Kind>| kind.is_some_and(Kind::is_vehicle);
    let mut others = actors().filter(|(actor, known)| *actor != clues.actor && vehicle(known.kind));
    // Off one that comes the other way: over from the lanes on the left.
    let against = |actor: Actor| {
        let other = Clues { reading: clues.reading, actor };
        comes_against(&other) || other.any(Relation::Opposite)
    };
    if actors().any(|(actor, known)| vehicle(known.kind) && against(actor)) {
        return Some(LeftRight::Left);
    }
    let (only, more) = (others.next(), others.next());
    let (lane, ..) = only.filter(|_| more.is_none())?.1.lane?;
    side_of_lane(account.sv.lane.as_ref()?.value, lane)
}

fn relation_to(side: LeftRight) -> Relation {
    match side {
        LeftRight::Left => Relation::Left,
        LeftRight::Right => Relation::Right,
    }
}

/// The relation told first.
pub(super) fn first_relation(clues: &Clues<'_>) -> Option<Relation> {
    clues.relations().find(|relation| *relation != Relation::Same)
}

/// Lanes from left to right.
fn lane_place(lane: LaneWord) -> Option<i32> {
    match lane {
        LaneWord::LeftTurn => Some(0),
        LaneWord::Left => Some(1),
        LaneWord::Center => Some(2),
        LaneWord::Right => Some(3),
        LaneWord::RightTurn | LaneWord::Bus => Some(4),
        LaneWord::Bike | LaneWord::Curb | LaneWord::Shoulder => Some(5),
        LaneWord::Opposing | LaneWord::Sidewalk => None,
    }
}

/// On which side of one lane another one is.
pub(super) fn side_of_lane(own: LaneWord, other: LaneWord) -> Option<LeftRight> {
    match lane_place(other)? - lane_place(own)? {
        0 => None,
        difference if difference < 0 => Some(LeftRight::Left),
        _ => Some(LeftRight::Right),
    }
}

/// On which side the partner's lane lies where both are counted from one side: "the third lane from the right", "the rightmost lane".
fn by_count(account: &Account) -> Option<LeftRight> {
    let count = |fact: &Option<Fact<LaneWord>>| match &fact.as_ref()?.source {
        Source::Words { text, .. } => counted(&text.to_lowercase()),
        _ => None,
    };
    let ((own, from), (other, side)) = (count(&account.sv.lane)?, count(&account.partner.as_ref()?.lane)?);
    match other.cmp(&own) {
        _ if from != side => None,
        std::cmp::Ordering::Less => Some(side),
        std::cmp::Ordering::Equal => None,
        std::cmp::Ordering::Greater => Some(side.other()),
    }
}

/// Which lane from which side the words for it count.
fn counted(words: &str) -> Option<(u8, LeftRight)> {
    let side = match (words.contains("left"), words.contains("right")) {
        (true, false) => LeftRight::Left,
        (false, true) => LeftRight::Right,
        _ => return None,
    };
    let number = words.split(|c: char| !c.is_alphanumeric()).find_map(|word| match word {
        "second" | "2nd" => Some(2),
        "third" | "3rd" => Some(3),
        "fourth" | "4th" => Some(4),
        "leftmost" | "rightmost" | "left" | "right" => Some(1),
        _ => None,
    })?;
    Some((number, side))
}

/// On which side the partner's lane lies.
fn lane_side(account: &Account) -> Option<LeftRight> {
    if let Some(side) = by_count(account) {
        return Some(side);
    }
    side_of_lane(account.sv.lane.as_ref()?.value, account.partner.as_ref()?.lane.as_ref()?.value)
}

/// The side from which the partner changed lanes towards the subject vehicle.
fn changed_from(account: &Account) -> Option<LeftRight> {
    let partner = account.partner.as_ref()?;
    let change = partner.acts.iter().find(|fact| fact.act.leaves_line() && !fact.after_contact)?;
    let from = change.side?.other();
    // Whoever moves over towards it touches it on that side.
    (zone_side(account) == Some(from)).then_some(from)
}
