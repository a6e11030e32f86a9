//! From where the partner and the others come, seen from the subject vehicle before any turn.

use super::Reading;
use super::fallback::{by_columns, by_side, square_front, zone_side};
use super::party::has_zone;
use crate::chunk::Spot;
use crate::frame::Frame;
use crate::lexicon::{Relation, Sense};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{
    Account, Act, Compass, ContactState, Fact, Kind, KindGroup, LaneWord, LeftRight, Origin, Source, told,
};
use recrash_model::zones::ContactZone as Z;

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
        let told = move |sentence: usize| sentence <= contact || !early && self.reading.had_before(sentence);
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
        self.source(|frame| frame.relations.iter().any(|(known, _)| *known == relation))
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
        let in_front = |frame: &Frame| frame.relations.iter().any(|(relation, _)| *relation == Relation::Ahead);
        let found = reading.before(actor).find(|(_, frame)| changes(frame) && in_front(frame));
        found.map(|(number, _)| (number, Relation::Ahead))
    };
    let neared = || {
        let near = |frame: &Frame| frame.sense == Sense::Approach && frame.happened() && frame.object == Some(actor);
        reading.before(SUBJECT).find(|(_, frame)| near(frame)).map(|(number, _)| (number, Relation::Ahead))
    };
    let (number, relation) = told_on_its_line.or_else(cuts_in).or_else(neared)?;
    let (first, end) = reading.window(number);
    Some(Fact { value: relation == Relation::Ahead, source: reading.words(first, end) })
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

pub(super) fn forward(account: &Account) -> bool {
    told(&account.sv.state).is_some_and(|state| matches!(state, ContactState::Moving | ContactState::SettingOff))
}

fn of_thing(clues: &Clues<'_>, account: &Account) -> Option<Fact<Origin>> {
    if clues.reading.did(clues.actor, Act::Fall) && told(&account.partner.as_ref()?.kind) == Some(Kind::TreeBranch) {
        return Some(Fact { value: Origin::Above, source: clues.source(|frame| frame.act() == Some(Act::Fall)) });
    }
    if let Some(side) = clues.side() {
        return Some(Fact {
            value: Origin::Beside { side },
            source: clues.has(if side == LeftRight::Left { Relation::Left } else { Relation::Right }),
        });
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
    if let Some(side) = came_off(clues, account).filter(|_| rolls) {
        return Some(Fact::by_rule(Origin::Beside { side }, "what rolls comes from the lane of whom it came off"));
    }
    if let (true, Some(side)) = (rolls, zone_side(account)) {
        return Some(Fact::by_rule(Origin::Beside { side }, "what rolls comes from the side that it touches"));
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

/// The side on which the vehicle drives that lost a thing: the only other one that is told of.
fn came_off(clues: &Clues<'_>, account: &Account) -> Option<LeftRight> {
    let actors = || clues.reading.story.world.actors.iter().enumerate().skip(1);
    let vehicle = |kind: Option<Kind>| kind.is_some_and(Kind::is_vehicle);
    let mut others = actors().filter(|(actor, known)| *actor != clues.actor && vehicle(known.kind));
    let (only, more) = (others.next(), others.next());
    let (lane, ..) = only.filter(|_| more.is_none())?.1.lane?;
    match lane_place(lane)? - lane_place(account.sv.lane.as_ref()?.value)? {
        0 => None,
        difference if difference < 0 => Some(LeftRight::Left),
        _ => Some(LeftRight::Right),
    }
}

fn of_road_user(clues: &Clues<'_>, account: &Account) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let walks = told(&account.partner.as_ref()?.kind)
        .is_some_and(|kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Animal | KindGroup::Cyclist));
    let side = clues.side().or_else(|| side_of_road(reading, actor, account).filter(|_| walks));
    let frames = || reading.before(actor).filter(|(_, frame)| frame.happened());
    let did = |act: Act| frames().any(|(_, frame)| frame.act() == Some(act));
    let told_as = |value: Origin, source: Source| Some(Fact { value, source });
    let sv_stands = told(&account.sv.state).is_some_and(ContactState::stands);
    // Thrown at its plain rear, from whatever lane it was in.
    let thrown = did(Act::Pushed) || !reading.contacts.earlier.is_empty();
    let all_rear = !account.sv.zones.is_empty() && account.sv.zones.iter().all(|zone| zone.value == Z::Rear);
    if thrown && all_rear && told(&account.sv.state) != Some(ContactState::Reversing) {
        return Some(Fact::by_rule(Origin::Behind, "thrown at the rear"));
    }
    let parked = frames().any(|(_, frame)| frame.sense == Sense::Parked)
        || told(&account.partner.as_ref()?.state) == Some(ContactState::Parked);
    // Out of a stall, a driveway, a lot.
    let heading = account.partner.as_ref()?.heading.as_ref();
    // After a turn that is done, its new direction counts.
    let turned = if super::types::turning(&account.sv) { None } else { account.sv.heading_after.as_ref() };
    let own = turned.map(|fact| fact.value).or_else(|| after_its_turn(account));
    // Who faces one way and goes backwards comes from there.
    let backs_from = did(Act::Reverse) && faces_only(reading, actor);
    let turn = own.zip(heading).map(|(own, other)| own.eighths_to(other.value.turned(if backs_from { 4 } else { 0 })));
    // Out of a spot at the other side of the road, and then on: it comes the other way.
    let drove_on = |number: usize| {
        turn == Some(4)
            && frames().any(|(later, frame)| {
                later > number && matches!(frame.act(), Some(Act::Follow | Act::SetOff | Act::Drift))
            })
    };
    if let Some((number, frame)) =
        frames().find(|(_, frame)| frame.out_of.is_some()).filter(|(number, _)| !drove_on(*number))
    {
        let (first, end) = reading.window(number);
        let source = reading.words(first, end);
        match frame.out_of {
            // Out of a spot at the kerb, backwards: it was ahead of who is touched in front.
            Some(Spot::Stall)
                if did(Act::Reverse)
                    && square_front(account)
                    && (at_curb(reading, actor) || clues.any(Relation::Ahead)) =>
            {
                return told_as(Origin::Ahead, source);
            }
            // Both go backwards, and meet at their rears.
            Some(Spot::Stall)
                if did(Act::Reverse)
                    && told(&account.sv.state) == Some(ContactState::Reversing)
                    && !account.sv.zones.is_empty()
                    && account.sv.zones.iter().all(|zone| zone.value.is_rear()) =>
            {
                return told_as(Origin::Behind, source);
            }
            // Out of the space behind it, or a row of them there.
            Some(Spot::Stall) if parked && behind_first(clues) && !did(Act::Reverse) => {
                return told_as(Origin::Behind, source);
            }
            Some(Spot::Stall) if at_curb(reading, actor) => {
                return told_as(Origin::Parked { side: side.or_else(|| zone_side(account)) }, source);
            }
            Some(Spot::Stall) => return told_as(Origin::Stall { side: side.or_else(|| zone_side(account)) }, source),
            Some(Spot::SideStreet) if side.is_some() => {
                return told_as(side.map_or(Origin::Opposite, |side| Origin::Cross { side }), source);
            }
            Some(Spot::Driveway | Spot::SideStreet) => {
                return told_as(Origin::Driveway { side: side.or_else(|| zone_side(account)) }, source);
            }
            Some(Spot::Curb) => return told_as(Origin::Parked { side: side.or_else(|| zone_side(account)) }, source),
            Some(Spot::Sidewalk) => {
                return told_as(Origin::Sidewalk { side: side.or_else(|| zone_side(account)) }, source);
            }
            None => {}
        }
    }
    let stall = in_stall(reading, actor).filter(|_| {
        // Parked ahead of it, and backwards: no stall across.
        !(did(Act::Reverse) && clues.any(Relation::Ahead) && square_front(account))
    });
    if let (true, true, Some(source)) = (
        parked,
        did(Act::Turn) || did(Act::PullOut) || did(Act::SetOff) || did(Act::Reverse) || did(Act::Follow),
        stall,
    ) {
        if behind_first(clues) && !did(Act::Reverse) {
            return told_as(Origin::Behind, source);
        }
        return told_as(Origin::Stall { side: side.or_else(|| zone_side(account)) }, source);
    }
    // It stood in a driveway, and came out of it backwards.
    if parked
        && did(Act::Reverse)
        && let Some(source) = stood_in(reading, actor, &["driveway", "driveways"])
    {
        let across = clues.any(Relation::Opposite).then_some(LeftRight::Left);
        return told_as(Origin::Driveway { side: side.or(across).or_else(|| zone_side(account)) }, source);
    }
    // It was ahead in one lane, and the subject vehicle left that lane.
    if let (Some(Relation::Ahead), Some(change)) =
        (first_relation(clues), account.sv.acts.iter().find(|fact| fact.act == Act::LaneChange && !fact.after_contact))
        && let Some(moved) = change.side
        && (did(Act::Swerve) || did(Act::LaneChange) || did(Act::Turn))
    {
        return told_as(Origin::Beside { side: moved.other() }, change.source.clone());
    }
    let ahead = clues.any(Relation::Ahead);
    let behind = clues.any(Relation::Behind);
    if did(Act::Reverse) && !behind {
        // Backwards out of a way across.
        if let (Some(2 | 6), Some(heading), false) = (turn, heading, square_front(account)) {
            let side = if turn == Some(2) { LeftRight::Left } else { LeftRight::Right };
            return told_as(Origin::Cross { side }, heading.source.clone());
        }
        if ahead || lead_of_subject(reading, actor) {
            return told_as(Origin::Ahead, clues.source(|frame| frame.act() == Some(Act::Reverse)));
        }
        if clues.any(Relation::Opposite) {
            // In the opposing lane, which is on the left.
            return told_as(
                side.or(Some(LeftRight::Left)).map_or(Origin::Opposite, |side| Origin::Beside { side }),
                clues.has(Relation::Opposite),
            );
        }
        if let Some(side) = side {
            // Its rear on a flank: it stood across.
            let only = |party: &recrash_model::account::Party, wanted: fn(Z) -> bool| {
                !party.zones.is_empty() && party.zones.iter().all(|zone| wanted(zone.value))
            };
            let across = only(&account.sv, |zone| matches!(zone, Z::Left | Z::Right))
                && only(account.partner.as_ref()?, |zone| zone == Z::Rear);
            let value = if across { Origin::Cross { side } } else { Origin::Beside { side } };
            return told_as(value, clues.source(|frame| frame.act() == Some(Act::Reverse)));
        }
        if has_zone(&account.sv, |zone| zone.is_front()) && !matches!(turn, Some(2..=6)) {
            return Some(Fact::by_rule(Origin::Ahead, "who goes backwards into the front was ahead"));
        }
    }
    if parked && did(Act::OpenDoor) {
        return told_as(
            Origin::Parked { side: side.or_else(|| zone_side(account)) },
            clues.source(|frame| frame.sense == Sense::Parked || frame.act() == Some(Act::OpenDoor)),
        );
    }
    if let Some(side) = side.filter(|_| on_side_street(reading, actor) && !did(Act::Pass)) {
        let relation = if side == LeftRight::Left { Relation::Left } else { Relation::Right };
        return told_as(Origin::Cross { side }, clues.has(relation));
    }
    let pulled_on =
        frames().find(|(_, frame)| frame.act() == Some(Act::PullOut)).is_some_and(|(number, _)| drove_on(number));
    let leaves_curb = !pulled_on
        && did(Act::PullOut)
        && (parked || did(Act::Hold) || frames().any(|(_, frame)| frame.act() == Some(Act::PullOut)));
    let crosses = matches!(turn, Some(2 | 6));
    // "entered traffic from a stop sign on the right", "from a side street": no kerb.
    let from_road = frames().find(|(number, frame)| {
        let (first, end) = reading.window(*number);
        let words = &reading.story.tokens[first..end.min(first + 14)];
        let from = words.iter().position(|token| token.text == "from");
        let road = |word: &str| matches!(word, "intersection" | "sign" | "street" | "avenue" | "road" | "alley");
        let curb = |word: &str| matches!(word, "curb" | "side" | "parked" | "spot" | "space" | "stall" | "lane");
        frame.act() == Some(Act::PullOut)
            && from.is_some_and(|from| {
                words[from..].iter().any(|token| road(&token.text))
                    && !words[from..].iter().any(|token| curb(&token.text))
            })
    });
    if let (Some((number, _)), Some(side), false) = (from_road, side.or_else(|| zone_side(account)), parked) {
        let (first, end) = reading.window(number);
        return told_as(Origin::Cross { side }, reading.words(first, end));
    }
    if leaves_curb && (parked || !(behind_first(clues) || crosses)) {
        let source = clues.source(|frame| frame.act() == Some(Act::PullOut));
        return told_as(Origin::Parked { side: side.or_else(|| zone_side(account)) }, source);
    }
    let first = first_relation(clues);
    // Beside it, before it passes or changes lanes.
    let beside = |side: LeftRight| {
        let relation = if side == LeftRight::Left { Relation::Left } else { Relation::Right };
        told_as(Origin::Beside { side }, clues.has(relation))
    };
    let moved_over = did(Act::LaneChange) || did(Act::Swerve) || did(Act::Drift);
    if let Some(side) = lane_side(account).filter(|_| behind && moved_over) {
        return Some(Fact::by_rule(Origin::Beside { side }, "lanes of both"));
    }
    if behind
        && !matches!(
            first,
            Some(Relation::Left | Relation::Right | Relation::Ahead | Relation::Opposite | Relation::Beside)
        )
    {
        return told_as(Origin::Behind, clues.has(Relation::Behind));
    }
    // Who drives the other way comes from there, and is beside it then.
    let other_way = turn == Some(4)
        && !(did(Act::Turn) || did(Act::UTurn) || did(Act::WrongWay))
        && told(&account.partner.as_ref()?.state) == Some(ContactState::Moving);
    if first == Some(Relation::Beside)
        && !other_way
        && let Some(side) = lane_side(account).or_else(|| zone_side(account))
    {
        return told_as(Origin::Beside { side }, clues.has(Relation::Beside));
    }
    let crossing = did(Act::Cross)
        || account.partner.as_ref().is_some_and(|partner| partner.did(Act::RunRed) || partner.did(Act::RunStop))
            && first_is_side(clues)
        || frames().any(|(_, frame)| {
            matches!(frame.sense, Sense::Act(Act::Enter | Act::RunRed | Act::RunStop))
                && frame.relations.iter().any(|(relation, _)| matches!(relation, Relation::Left | Relation::Right))
        })
        || frames().any(|(_, frame)| {
            frame.relations.iter().any(|(relation, _)| matches!(relation, Relation::Left | Relation::Right))
                && matches!(frame.sense, Sense::Approach)
                && !did(Act::Pass)
        })
        || on_side_street(reading, actor);
    // "entered the circle without giving way".
    let gave_no_way = frames().any(|(_, frame)| frame.act() == Some(Act::Enter))
        && account.partner.as_ref().is_some_and(|partner| partner.did(Act::FailToYield))
        && !sv_stands;
    if let (true, None, Some(side), None) = (gave_no_way, side, zone_side(account), turn) {
        return Some(Fact::by_rule(Origin::Cross { side }, "the side that was touched by one who came in"));
    }
    if let Some(eighths) = turn {
        let source = Source::Rule { name: "directions of both".to_owned() };
        let opposite_side = clues.any(Relation::Opposite) || account.partner.as_ref()?.did(Act::WrongWay);
        match eighths {
            // Facing the other way and going backwards it goes the same way, beside.
            4 if did(Act::Reverse) && !other_way && zone_side(account).is_some() => {
                let side = zone_side(account)?;
                return told_as(Origin::Beside { side }, heading?.source.clone());
            }
            2 => return told_as(Origin::Cross { side: LeftRight::Left }, heading?.source.clone()),
            6 => return told_as(Origin::Cross { side: LeftRight::Right }, heading?.source.clone()),
            3..=5 if !did(Act::Pass) || opposite_side || eighths == 4 => {
                return told_as(Origin::Opposite, heading?.source.clone());
            }
            0 | 1 | 7 => {
                if ahead {
                    if let Some(side) = side.or_else(|| lane_side(account)) {
                        return beside(side);
                    }
                    return told_as(Origin::Ahead, clues.has(Relation::Ahead));
                }
                if let Some(side) = side.filter(|_| !did(Act::Pass) || first_is_side(clues)) {
                    return beside(side);
                }
                if let Some(side) = lane_side(account).filter(|_| did(Act::Pass)) {
                    return Some(Fact { value: Origin::Beside { side }, source });
                }
                if did(Act::Pass) {
                    return told_as(Origin::Behind, clues.source(|frame| frame.act() == Some(Act::Pass)));
                }
                if let Some(side) = lane_side(account) {
                    return Some(Fact { value: Origin::Beside { side }, source });
                }
                let moved_over = if did(Act::LaneChange) { zone_side(account) } else { None };
                if let Some(side) = changed_from(account).or(moved_over) {
                    return told_as(
                        Origin::Beside { side },
                        clues.source(|frame| frame.act() == Some(Act::LaneChange)),
                    );
                }
                let flank = !account.sv.zones.is_empty()
                    && account.sv.zones.iter().all(|zone| matches!(zone.value, Z::Left | Z::Right));
                if let (true, false, Some(side)) = (flank, sv_stands, zone_side(account)) {
                    return Some(Fact { value: Origin::Beside { side }, source });
                }
                if sv_stands || has_zone(&account.sv, |zone| zone.is_rear()) {
                    return Some(Fact { value: Origin::Behind, source });
                }
            }
            _ => {}
        }
    }
    if let (Some(own), Some(other)) = (climbs(reading, SUBJECT), climbs(reading, actor))
        && own != other
        && turn.is_none()
    {
        return Some(Fact::by_rule(Origin::Opposite, "one uphill, the other downhill"));
    }
    if did(Act::WrongWay) && !crosses {
        return told_as(Origin::Opposite, clues.source(|frame| frame.act() == Some(Act::WrongWay)));
    }
    if clues.any(Relation::Opposite) && !did(Act::Pass) {
        return told_as(Origin::Opposite, clues.has(Relation::Opposite));
    }
    if crossing && let Some(side) = side {
        return told_as(
            Origin::Cross { side },
            clues.has(if side == LeftRight::Left { Relation::Left } else { Relation::Right }),
        );
    }
    if ahead
        && side.is_none()
        && moved_over
        && let Some(side) = lane_side(account)
    {
        return Some(Fact::by_rule(Origin::Beside { side }, "lanes of both"));
    }
    if ahead && side.is_none() {
        return told_as(Origin::Ahead, clues.has(Relation::Ahead));
    }
    // Front on flank at a junction, from that side: across.
    let only = |party: &recrash_model::account::Party, wanted: fn(Z) -> bool| {
        !party.zones.is_empty() && party.zones.iter().all(|zone| wanted(zone.value))
    };
    let stops = account.place.features.iter().any(|feature| {
        matches!(
            feature.value,
            recrash_model::account::RoadFeature::StopSign | recrash_model::account::RoadFeature::Signal
        )
    });
    let flank = only(&account.sv, |zone| matches!(zone, Z::Left | Z::Right))
        && account.partner.as_ref().is_some_and(|partner| only(partner, |zone| zone == Z::Front));
    let across = flank && stops && !sv_stands && !moved_over && !did(Act::Pass) && !did(Act::Turn);
    if let (true, Some(side)) = (across && zone_side(account) == side, side) {
        let relation = if side == LeftRight::Left { Relation::Left } else { Relation::Right };
        return told_as(Origin::Cross { side }, clues.has(relation));
    }
    if let Some(side) = side.filter(|_| first_is_side(clues) || !did(Act::Pass)) {
        let kind = told(&account.partner.as_ref()?.kind);
        if kind.is_some_and(|kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Animal)) {
            return told_as(
                Origin::Cross { side },
                clues.has(if side == LeftRight::Left { Relation::Left } else { Relation::Right }),
            );
        }
        return beside(side);
    }
    if clues.any(Relation::Opposite) {
        return told_as(Origin::Opposite, clues.has(Relation::Opposite));
    }
    if did(Act::Pass) && passes_subject(reading, actor) {
        return Some(Fact::by_rule(Origin::Behind, "who passes comes from behind"));
    }
    if let Some(side) = lane_side(account).or_else(|| changed_from(account)) {
        return Some(Fact::by_rule(Origin::Beside { side }, "lanes of both"));
    }
    // Who changes lanes into the leftmost one comes from the right.
    let edge = account.sv.lane.as_ref().and_then(|lane| match lane.value {
        LaneWord::Left | LaneWord::LeftTurn => Some(LeftRight::Right),
        LaneWord::Right | LaneWord::RightTurn | LaneWord::Curb => Some(LeftRight::Left),
        _ => None,
    });
    let into_ours = frames().any(|(_, frame)| frame.act() == Some(Act::LaneChange) && frame.object == Some(SUBJECT));
    if let (true, Some(side)) = (into_ours && zone_side(account).is_none_or(|touched| Some(touched) == edge), edge) {
        return Some(Fact::by_rule(Origin::Beside { side }, "into the lane at the edge of the road"));
    }
    // Both turn the same way, side by side.
    if reading.did(SUBJECT, Act::Turn)
        && did(Act::Turn)
        && let Some(side) = zone_side(account)
    {
        return Some(Fact::by_rule(Origin::Beside { side }, "the side that was touched, where both turn"));
    }
    if told(&account.sv.state) == Some(ContactState::Reversing)
        && let Some(side) = zone_side(account)
    {
        return Some(Fact::by_rule(Origin::Beside { side }, "the side that was touched, where it goes backwards"));
    }
    if let (true, Some(side)) = (on_side_street(reading, actor) && !did(Act::Pass), zone_side(account)) {
        return Some(Fact::by_rule(Origin::Cross { side }, "the side that was touched by one on a road that crosses"));
    }
    // Who turns and is met by one of whom no direction is told: the side that was touched tells it.
    let turning =
        super::types::turning(&account.sv) && !super::types::turning(account.partner.as_ref()?) && !did(Act::Pass);
    if let (true, Some(side)) = (turning && !has_zone(&account.sv, |zone| zone.is_rear()), zone_side(account)) {
        if parked {
            return Some(Fact::by_rule(Origin::Beside { side }, "the side that a parked one is touched with"));
        }
        let left = super::types::turn_side(&account.sv) == Some(LeftRight::Left);
        // Who ran a red light where it had green crossed.
        let ran_red = |frame: &Frame| frame.who != Some(SUBJECT) && frame.act() == Some(Act::RunRed);
        if left && side == LeftRight::Right && !reading.story.frames.iter().any(ran_red) {
            return Some(Fact::by_rule(Origin::Opposite, "the right side of a vehicle turning left that was touched"));
        }
        return Some(Fact::by_rule(Origin::Cross { side }, "the side of a turning vehicle that was touched"));
    }
    let rear_ended = reading.contacts.first.is_some_and(|number| reading.story.frames[number].sense == Sense::RearEnd);
    if rear_ended {
        let by_subject = reading.contacts.first.is_some_and(|number| reading.story.frames[number].who == Some(SUBJECT));
        return Some(Fact::by_rule(if by_subject { Origin::Ahead } else { Origin::Behind }, "front on rear"));
    }
    None
}

/// The side of the road from which somebody comes, where its words name it: "from the north side of the street", "between cars on the
/// right side of the road".
fn side_of_road(reading: &Reading<'_>, actor: Actor, account: &Account) -> Option<LeftRight> {
    let own = after_its_turn(account);
    let tokens = &reading.story.tokens;
    let word = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    let compass = |at: usize| match word(at) {
        "north" | "northern" => Some(Compass::North),
        "east" | "eastern" => Some(Compass::East),
        "south" | "southern" => Some(Compass::South),
        "west" | "western" => Some(Compass::West),
        _ => None,
    };
    let road = |at: usize| (at..at + 5).any(|at| matches!(word(at), "road" | "roadway" | "street" | "alley" | "lot"));
    let comes =
        |act: Option<Act>| matches!(act, Some(Act::Enter | Act::Cross | Act::PullOut | Act::Follow | Act::Swerve));
    reading.before(actor).filter(|(_, frame)| comes(frame.act())).find_map(|(_, frame)| {
        let (first, end) = (frame.first, reading.story.sentences[frame.sentence].end);
        (first..end).find_map(|at| {
            let kerb = matches!(word(at + 1), "sidewalk" | "curb");
            match word(at) {
                "left" if kerb || word(at + 1) == "side" && road(at + 2) => Some(LeftRight::Left),
                "right" if kerb || word(at + 1) == "side" && road(at + 2) => Some(LeftRight::Right),
                _ if kerb || word(at + 1) == "side" => match own?.eighths_to(compass(at)?) {
                    1..=3 => Some(LeftRight::Right),
                    5..=7 => Some(LeftRight::Left),
                    _ => None,
                },
                _ => None,
            }
        })
    })
}

/// Whether somebody is told to go uphill (or downhill).
fn climbs(reading: &Reading<'_>, actor: Actor) -> Option<bool> {
    let tokens = &reading.story.tokens;
    reading.before(actor).find_map(|(number, frame)| {
        let (first, end) = reading.window(number);
        let goes = matches!(frame.act(), Some(Act::Follow | Act::SetOff | Act::Drift | Act::Pass));
        tokens[first..end].iter().filter(|_| goes).find_map(|token| match token.text.as_str() {
            "uphill" => Some(true),
            "downhill" => Some(false),
            _ => None,
        })
    })
}

/// Whether the words put somebody at the kerb.
fn at_curb(reading: &Reading<'_>, actor: Actor) -> bool {
    let tokens = &reading.story.tokens;
    reading.before(actor).any(|(number, _)| {
        let (first, end) = reading.window(number);
        tokens[first..end].iter().any(|token| matches!(token.text.as_str(), "curb" | "curbside" | "kerb" | "parallel"))
    })
}

/// Whether the words put somebody on a road that crosses.
fn on_side_street(reading: &Reading<'_>, actor: Actor) -> bool {
    let tokens = &reading.story.tokens;
    reading.before(actor).any(|(number, frame)| {
        let (first, end) = reading.window(number);
        // "A coupe on the cross street ran the light": between its name and its verb.
        let named = reading.story.world.actors[actor].kind_tokens.map_or(first, |(_, end)| end);
        let sentence = reading.story.sentences[frame.sentence];
        let first = if (sentence.first..first).contains(&named) { named } else { first };
        let word = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
        (first..end).any(|at| {
            let road = matches!(word(at + 1), "street" | "road" | "streets");
            let crosses = matches!(word(at), "side" | "cross" | "crossing" | "intersecting" | "perpendicular");
            // "the street on its left".
            let there = matches!(word(at), "street" | "road")
                && matches!(word(at + 1), "on" | "to")
                && (at + 2..at + 4).any(|at| matches!(word(at), "left" | "right"));
            crosses && road || there
        })
    })
}

/// Whether the direction of somebody is the one that it faces, and not the one that it drives.
fn faces_only(reading: &Reading<'_>, actor: Actor) -> bool {
    reading.story.world.actors[actor].heading.is_some_and(|(_, first, _)| {
        reading.story.tokens[first.saturating_sub(2)..first]
            .iter()
            .any(|token| matches!(token.text.as_str(), "facing" | "faced" | "oriented" | "pointed" | "pointing"))
    })
}

/// Direction of the subject vehicle, after a turn that is done where no street is told.
fn after_its_turn(account: &Account) -> Option<Compass> {
    let heading = account.sv.heading.as_ref()?.value;
    let mut turns = account.sv.acts.iter().filter(|fact| !fact.after_contact && matches!(fact.act, Act::Turn));
    let (only, more) = (turns.next(), turns.next());
    match only {
        Some(only) if more.is_none() && !super::types::turning(&account.sv) => match only.side {
            Some(LeftRight::Left) => Some(heading.turned(6)),
            Some(LeftRight::Right) => Some(heading.turned(2)),
            None => Some(heading),
        },
        _ => Some(heading),
    }
}

/// The relation told first.
pub(super) fn first_relation(clues: &Clues<'_>) -> Option<Relation> {
    clues.relations().find(|relation| *relation != Relation::Same)
}

fn first_is_side(clues: &Clues<'_>) -> bool {
    matches!(first_relation(clues), Some(Relation::Left | Relation::Right))
}

fn behind_first(clues: &Clues<'_>) -> bool {
    first_relation(clues) == Some(Relation::Behind)
}

fn passes_subject(reading: &Reading<'_>, actor: Actor) -> bool {
    reading
        .before(actor)
        .any(|(_, frame)| frame.act() == Some(Act::Pass) && frame.object.is_none_or(|object| object == SUBJECT))
}

/// The subject vehicle stood behind it, or followed it.
fn lead_of_subject(reading: &Reading<'_>, actor: Actor) -> bool {
    reading.before(SUBJECT).any(|(_, frame)| {
        frame.relations.contains(&(Relation::Behind, Some(actor)))
            || (frame.sense == Sense::Yield && frame.object == Some(actor))
    })
}

/// The words that place somebody in a stall.
fn in_stall(reading: &Reading<'_>, actor: Actor) -> Option<Source> {
    stood_in(reading, actor, &["stall", "stalls", "space", "spot", "carport", "spaces"])
}

/// Where it stood in a place of one of these names.
fn stood_in(reading: &Reading<'_>, actor: Actor, names: &[&str]) -> Option<Source> {
    let tokens = &reading.story.tokens;
    reading.before(actor).find_map(|(number, frame)| {
        let (first, end) = reading.window(number);
        let at = (first..end).find(|&at| names.contains(&tokens[at].text.as_str()))?;
        (frame.sense == Sense::Parked || frame.act() == Some(Act::Hold) || frame.sense == Sense::Face)
            .then(|| reading.words(frame.first, at + 1))
    })
}

/// Lanes from left to right.
pub(super) fn lane_place(lane: LaneWord) -> Option<i32> {
    match lane {
        LaneWord::LeftTurn => Some(0),
        LaneWord::Left => Some(1),
        LaneWord::Center => Some(2),
        LaneWord::Right => Some(3),
        LaneWord::RightTurn | LaneWord::Bus => Some(4),
        LaneWord::Bike | LaneWord::Curb | LaneWord::Shoulder => Some(5),
        LaneWord::Opposing => None,
    }
}

/// On which side the partner's lane lies.
fn lane_side(account: &Account) -> Option<LeftRight> {
    let own = lane_place(account.sv.lane.as_ref()?.value)?;
    let other = lane_place(account.partner.as_ref()?.lane.as_ref()?.value)?;
    match other - own {
        0 => None,
        difference if difference < 0 => Some(LeftRight::Left),
        _ => Some(LeftRight::Right),
    }
}

/// The side from which the partner changed lanes towards the subject vehicle.
fn changed_from(account: &Account) -> Option<LeftRight> {
    let partner = account.partner.as_ref()?;
    let change = partner
        .acts
        .iter()
        .find(|fact| matches!(fact.act, Act::LaneChange | Act::Swerve | Act::Drift) && !fact.after_contact)?;
    let from = change.side?.other();
    // Whoever moves over towards it touches it on that side.
    (zone_side(account) == Some(from)).then_some(from)
}
