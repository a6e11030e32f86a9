//! One side: what the words tell of it, each by its file, and then what only the columns tell.

use super::Reading;
use super::about_to::turns_next;
use super::acts::acts;
use super::astride::astride;
use super::controls::controls;
use super::open::is_any_truck;
use super::reasons::reasons;
use super::speeds::speeds;
use super::standing::state;
use super::state::{partner_state, sv_speed, sv_state};
use super::touched::{by_trailer, zones};
use crate::chunk::bound;
use crate::frame::Frame;
use crate::lexicon::{Relation, Sense};
use crate::world::{Actor, SUBJECT, is_no_passenger_vehicle};
use recrash_model::account::{
    Account, Act, Astride, Compass, ContactState, Fact, Kind, KindGroup, LaneWord, LeftRight, Origin, Party, Source,
    Speed, SpeedMeaning, told,
};
use recrash_model::kinds::PartnerKind;
use recrash_model::record::Coded;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// What the words tell of one side.
pub(crate) fn party(reading: &Reading<'_>, actor: Actor) -> Party {
    let known = &reading.story.world.actors[actor];
    // Where it drove afterwards is no place of the crash.
    let end = reading.until();
    let before = |first: usize| first < end;
    let (state, standing) = state(reading, actor);
    let kind = match (known.kind, known.kind_tokens) {
        (Some(kind), Some((first, end))) => Some(reading.told(with_trailer(reading, actor, kind), first, end)),
        (Some(kind), None) => Some(Fact::of_column(kind, "Make")),
        _ => None,
    };
    let via = known.heading.and_then(|(_, _, end)| by_way_of(reading, end));
    let mut party = Party {
        kind,
        movement: None,
        state,
        standing,
        reasons: Vec::new(),
        acts: acts(reading, actor),
        heading: via
            .map(|(way, _)| way)
            .or(known.heading)
            .filter(|(_, first, _)| before(*first))
            .map(|(compass, first, end)| reading.told(compass, first, end))
            .or_else(|| across_from(reading, actor)),
        heading_after: via
            .map(|(_, (compass, first, end))| reading.told(compass, first, end))
            .or_else(|| after(reading, actor)),
        lane: known
            .lane
            .filter(|(_, first, _)| before(*first))
            .or_else(|| turn_lane_to_come(reading, actor))
            .or_else(|| in_the_same_lane(reading, actor))
            .or_else(|| in_the_lane_of_the_other_way(reading, actor))
            .map(|(lane, first, end)| reading.told(lane, first, end)),
        astride: astride(reading, actor),
        turns_next: None,
        speeds: speeds(reading, actor),
        zones: zones(reading, actor),
        controls: controls(reading, actor),
    };
    if told(&party.state).is_some_and(ContactState::stands) || (party.state.is_none() && actor == SUBJECT) {
        party.reasons = reasons(reading, actor);
    }
    party.turns_next = turns_next(reading, actor, &party.acts);
    party.lane = party.lane.take().filter(|lane| !is_strip_beside(lane, party.astride.as_ref()));
    party
}

/// "partially in the parking lane": and partly beside it, in a lane.
fn is_strip_beside(lane: &Fact<LaneWord>, astride: Option<&Fact<Astride>>) -> bool {
    let span = |source: &Source| match source {
        Source::Words { start, end, .. } => Some((*start, *end)),
        _ => None,
    };
    let strip = matches!(lane.value, LaneWord::Curb | LaneWord::Bike | LaneWord::Shoulder);
    let inside = |(of, within): ((usize, usize), (usize, usize))| within.0 <= of.0 && of.1 <= within.1;
    strip && span(&lane.source).zip(astride.and_then(|fact| span(&fact.source))).is_some_and(inside)
}

/// "was waiting in the center lane. A van coming up in the same lane": in that of the subject vehicle.
fn in_the_same_lane(reading: &Reading<'_>, actor: Actor) -> Option<(LaneWord, usize, usize)> {
    let (subject, known) = (&reading.story.world.actors[SUBJECT], &reading.story.world.actors[actor]);
    let (own, told, _) = subject.lane.filter(|_| actor != SUBJECT)?;
    if subject.heading.zip(known.heading).is_some_and(|(one, other)| one.0 != other.0) {
        return None;
    }
    let changes = reading.did(SUBJECT, Act::LaneChange) || reading.did(actor, Act::LaneChange);
    let (_, number) = known.relations.iter().find(|(relation, _)| *relation == Relation::Same)?;
    let sentence = reading.story.sentences[*number];
    let (first, words) = (sentence.first, &reading.story.tokens[sentence.first..sentence.end]);
    let at = words.windows(2).position(|pair| pair[0].text == "same" && pair[1].text == "lane")?;
    // A lane that is told later, such as the one in which it stopped, is not meant.
    (!changes && told < first + at).then_some((own, first + at, first + at + 2))
}

/// "A van going south entered the northbound lane to pass": the lane of those who come the other way.
fn in_the_lane_of_the_other_way(reading: &Reading<'_>, actor: Actor) -> Option<(LaneWord, usize, usize)> {
    let (own, ..) = reading.story.world.actors[actor].heading.filter(|_| actor != SUBJECT)?;
    let over = |frame: &Frame| {
        let (compass, first, end) = frame.heading?;
        let goes = matches!(frame.act(), Some(Act::Enter | Act::LaneChange | Act::Drift | Act::Swerve | Act::Pass));
        let lane = end + usize::from(matches!(reading.story.word(end), "travel" | "traffic" | "through"));
        let other = compass == own.turned(4) && matches!(reading.story.word(lane), "lane" | "lanes");
        (goes && other && frame.happened()).then_some((LaneWord::Opposing, first, lane + 1))
    };
    reading.before(actor).find_map(|(_, frame)| over(frame))
}

/// "passed the AV on the left to enter the left turn lane": the lane in which it is to be.
fn turn_lane_to_come(reading: &Reading<'_>, actor: Actor) -> Option<(LaneWord, usize, usize)> {
    let frames = &reading.story.frames;
    let (number, pass) = reading.before(actor).find(|(_, frame)| frame.act() == Some(Act::Pass) && !frame.negated)?;
    let mut behind = frames[number + 1..].iter().take_while(|frame| frame.sentence == pass.sentence);
    let entered = behind.find(|frame| frame.who == Some(actor) && frame.act() == Some(Act::Enter))?;
    let end = reading.story.sentences[entered.sentence].end;
    let lane = (entered.first + 1..end).take(LANE_WITHIN).find(|&at| reading.story.word(at) == "lane")?;
    let value = match entered.side? {
        LeftRight::Left => LaneWord::LeftTurn,
        LeftRight::Right => LaneWord::RightTurn,
    };
    matches!(reading.story.word(lane - 1), "turn" | "turning").then_some((value, entered.first, lane + 1))
}

/// The name of a lane that is entered is no longer, with its article. [tokens]
const LANE_WITHIN: usize = 7;

/// "The left side of the trailer made contact": whoever it was called before drew one.
fn with_trailer(reading: &Reading<'_>, actor: Actor, kind: Kind) -> Kind {
    match kind {
        Kind::HeavyTruck if by_trailer(reading, actor) => Kind::SemiTrailerTruck,
        Kind::Pickup if by_trailer(reading, actor) => Kind::PickupWithTrailer,
        kind => kind,
    }
}

/// The direction of the road that it goes into.
fn after(reading: &Reading<'_>, actor: Actor) -> Option<Fact<Compass>> {
    let (_, frame) = reading
        .before(actor)
        .find(|(_, frame)| frame.onto && frame.heading.is_some() && frame.happened() && frame.act().is_some())?;
    frame.heading.map(|(compass, first, end)| reading.told(compass, first, end))
}

/// "from southbound Elm Street to southbound Oak Street via eastbound Pine Street", behind the first of them: the way on which it came last, and
/// that on which it was to go.
fn by_way_of(reading: &Reading<'_>, end: usize) -> Option<(Way, Way)> {
    let story = &reading.story;
    let compass = |at: usize| bound(story.word(at)).map(|compass| (compass, at, at + 1));
    let sentence = story.sentences.iter().find(|sentence| (sentence.first..sentence.end).contains(&end))?;
    let via = (end..sentence.end).find(|&at| story.word(at) == "via")?;
    let to = (end..via).find(|&at| matches!(story.word(at), "to" | "onto"))?;
    Some((compass(via + 1)?, compass(to + 1)?))
}

/// A direction, with its tokens.
type Way = (Compass, usize, usize);

/// "left a lot on the west side of the street and crossed it": east.
fn across_from(reading: &Reading<'_>, actor: Actor) -> Option<Fact<Compass>> {
    if !reading.did(actor, Act::Cross) {
        return None;
    }
    let tokens = &reading.story.tokens;
    let leaves = |frame: &Frame| frame.act() == Some(Act::PullOut) && frame.happened();
    let (_, frame) = reading.before(actor).find(|(_, frame)| leaves(frame))?;
    let end = reading.story.sentences[frame.sentence].end.min(frame.end + 6);
    let at = (frame.end..end).find(|&at| tokens[at].text == "side" && tokens[at - 2].text == "the")?;
    let side = match tokens[at - 1].text.as_str() {
        "north" => Compass::North,
        "east" => Compass::East,
        "south" => Compass::South,
        "west" => Compass::West,
        _ => return None,
    };
    Some(reading.told(side.turned(4), at - 1, at + 1))
}

/// What only the columns tell, and the column speed; words win. `alone`: there is no partner, whom the columns take for one.
pub(crate) fn columns(reading: &Reading<'_>, account: &mut Account, alone: bool) {
    let record = reading.record;
    if let Some(mps) = record.sv_speed_mps {
        let speed = Speed { mps, meaning: SpeedMeaning::Impact };
        account.sv.speeds.push(Fact::of_column(speed, "SV Precrash Speed (MPH)"));
    }
    sv_state(reading, account);
    sv_speed(account);
    if account.sv.zones.is_empty() {
        account.sv.zones = ticked(reading, SUBJECT, &record.sv_zones, "SV Contact Area");
    }
    let partner_told = account.partner.is_some()
        || !matches!(record.partner, Coded::Blank | Coded::Unknown)
        || !record.cp_zones.is_empty();
    if alone || !partner_told {
        return;
    }
    let partner = account.partner.get_or_insert_with(Party::default);
    if partner.zones.is_empty() {
        let actor = reading.contacts.partner.unwrap_or(usize::MAX);
        partner.zones = ticked(reading, actor, &record.cp_zones, "CP Contact Area");
    }
    let column = match record.partner {
        Coded::Known(kind) => Some(kind_of(kind)).filter(|kind| !names_another(reading, *kind)),
        _ => None,
    };
    let vague = partner.kind.as_ref().is_none_or(|kind| kind.value == Kind::Vehicle);
    // "The truck" is a pickup where the column says so, and "a commercial vehicle" is a van.
    let light = matches!(column, Some(Kind::Pickup | Kind::Van | Kind::Suv | Kind::PassengerCar))
        && partner.kind.as_ref().is_some_and(is_any_truck);
    if let (true, Some(kind)) = (vague || light, column) {
        partner.kind = Some(Fact::of_column(kind, "Crash With"));
    }
    // Something that neither a word of ours nor the column knows is no road user.
    if partner.kind.is_none() && nobody_else(reading) {
        partner.kind = Some(Fact::by_rule(Kind::Object, "something that has no name of a road user"));
    }
    if partner.state.is_none() {
        let state = match movement_column(reading) {
            Some(Movement::Stopped) => Some(ContactState::Stopped),
            Some(Movement::Parked) => Some(ContactState::Parked),
            Some(Movement::Backing) => Some(ContactState::Reversing),
            Some(_) => Some(ContactState::Moving),
            None => None,
        };
        partner.state = state.map(|state| Fact::of_column(state, "CP Pre-Crash Movement"));
    } else {
        partner_state(reading, account);
    }
}

/// The movement that the column has for the partner, where it means that one.
pub(super) fn movement_column(reading: &Reading<'_>) -> Option<Movement> {
    let record = reading.record;
    let another = record.partner.known().is_some_and(|kind| names_another(reading, kind_of(kind)));
    record.cp_movement.known().filter(|_| !another)
}

/// "It yielded to a bus, and another vehicle struck it", "a cyclist merged, and a passenger vehicle struck it", of a column that names the
/// bus or a cyclist: another one of the story.
fn names_another(reading: &Reading<'_>, column: Kind) -> bool {
    let Some(partner) = reading.contacts.partner.map(|partner| &reading.story.world.actors[partner]) else {
        return false;
    };
    let plain = partner.kind == Some(Kind::Vehicle);
    let narrow = !matches!(column, Kind::Vehicle | Kind::PassengerCar | Kind::Object);
    let others = reading.story.world.actors.iter().skip(1);
    let met = others.filter(|other| other.mentions > 0).any(|other| other.kind == Some(column));
    let no_vehicle = !column.is_vehicle() && column.group() != KindGroup::Motorcycle;
    plain && narrow && met && (partner.another || partner.passenger && (is_no_passenger_vehicle(column) || no_vehicle))
}

/// "The rear of one that backed from ahead made contact with the rear of it" cannot be: where the column has its front, that was meant.
pub(crate) fn front_by_column(reading: &Reading<'_>, account: &mut Account) {
    let column = &reading.record.sv_zones;
    let backs = reading.contacts.partner.is_some_and(|partner| reading.did(partner, Act::Reverse));
    let ahead = told(&account.came_from) == Some(Origin::Ahead);
    let stands = told(&account.sv.state).is_some_and(ContactState::stands);
    let rear = !account.sv.zones.is_empty() && account.sv.zones.iter().all(|zone| zone.value == ContactZone::Rear);
    let front = !column.is_empty() && column.iter().all(|zone| zone.is_front());
    if backs && ahead && stands && rear && front {
        account.sv.zones = ticked(reading, SUBJECT, column, "SV Contact Area");
    }
}

/// Who passes on the left cannot touch with its own left flank: where the column has the other side, that was meant.
pub(crate) fn flank_by_column(reading: &Reading<'_>, account: &mut Account) {
    let Some(partner) = account.partner.as_ref() else { return };
    let on = |zones: &[ContactZone], side: LeftRight| {
        !zones.is_empty() && zones.iter().all(|zone| side_of_zone(*zone) == Some(side))
    };
    let same_way = matches!(told(&account.came_from), Some(Origin::Behind | Origin::Beside { .. }));
    let turns = [Act::Turn, Act::UTurn, Act::Reverse, Act::WrongWay].into_iter().any(|act| partner.did(act));
    let (own, words) = (account.sv.zone_values(), partner.zone_values());
    let column = &reading.record.cp_zones;
    let impossible = [LeftRight::Left, LeftRight::Right]
        .into_iter()
        .any(|side| on(&own, side) && on(&words, side) && on(column, side.other()));
    if partner.did(Act::Pass) && same_way && !turns && impossible {
        let actor = reading.contacts.partner.unwrap_or(usize::MAX);
        let zones = ticked(reading, actor, column, "CP Contact Area");
        account.partner.as_mut().expect("a partner").zones = zones;
    }
}

/// The side of a vehicle on which a zone lies.
fn side_of_zone(zone: ContactZone) -> Option<LeftRight> {
    use ContactZone as Z;
    match zone {
        Z::Left | Z::FrontLeft | Z::RearLeft => Some(LeftRight::Left),
        Z::Right | Z::FrontRight | Z::RearRight => Some(LeftRight::Right),
        Z::Front | Z::Rear | Z::Top | Z::Bottom => None,
    }
}

/// Zones of a column; of a mirror its corner is the side.
fn ticked(reading: &Reading<'_>, actor: Actor, zones: &[ContactZone], name: &str) -> Vec<Fact<ContactZone>> {
    use ContactZone as Z;
    let frame = reading.contacts.first.map(|number| &reading.story.frames[number]);
    let piece = frame.and_then(|frame| {
        if frame.who == Some(actor) {
            frame.with.as_ref()
        } else if frame.object == Some(actor) {
            frame.on.as_ref()
        } else {
            None
        }
    });
    let mirror = piece.is_some_and(|piece| piece.mirror);
    let zone = |zone: ContactZone| match zone {
        Z::FrontLeft | Z::RearLeft if mirror => Z::Left,
        Z::FrontRight | Z::RearRight if mirror => Z::Right,
        zone => zone,
    };
    zones.iter().map(|known| Fact::of_column(zone(*known), name)).collect()
}

/// Whether the words tell a contact, and of no other road user.
fn nobody_else(reading: &Reading<'_>) -> bool {
    let story = &reading.story;
    let touches = |frame: &Frame| {
        frame.is_contact()
            || frame.sense == Sense::Headline
            || matches!(frame.act(), Some(Act::Fall)) && frame.who == Some(SUBJECT)
    };
    let known = |kind: Option<Kind>| kind.is_some_and(|kind| kind.group() != KindGroup::Object);
    story.frames.iter().any(touches) && !story.world.actors.iter().skip(1).any(|actor| known(actor.kind))
}

/// Words that name an end or a side keep the one corner of it that the column ticks beside them: "rear-ended", and the left corner. Words
/// that name the corner say more than a column that ticks its end or its side, and stand alone.
pub(crate) fn refine(zones: &mut Vec<Fact<ContactZone>>, column: &[ContactZone], name: &str) {
    let [told] = zones.as_slice() else { return };
    if !told.source.is_told() || is_corner(told.value) {
        return;
    }
    let told = told.value;
    let mut corners = column.iter().filter(|ticked| is_corner(**ticked) && super::steps(told, **ticked) == 1);
    if let (Some(corner), None) = (corners.next(), corners.next()) {
        zones.push(Fact::of_column(*corner, name));
    }
}

/// Whether a zone is one of the four corners, and no whole end or side.
fn is_corner(zone: ContactZone) -> bool {
    use ContactZone as Z;
    matches!(zone, Z::FrontLeft | Z::FrontRight | Z::RearLeft | Z::RearRight)
}

fn kind_of(kind: PartnerKind) -> Kind {
    match kind {
        PartnerKind::PassengerCar => Kind::PassengerCar,
        PartnerKind::Suv => Kind::Suv,
        PartnerKind::Van => Kind::Van,
        PartnerKind::PickupTruck => Kind::Pickup,
        PartnerKind::HeavyTruck => Kind::HeavyTruck,
        PartnerKind::Bus => Kind::Bus,
        PartnerKind::Motorcycle => Kind::Motorcycle,
        PartnerKind::Cyclist => Kind::Bicycle,
        PartnerKind::Pedestrian => Kind::Pedestrian,
        PartnerKind::OtherNonMotorist => Kind::ScooterRider,
        PartnerKind::FirstResponder => Kind::FirstResponder,
        PartnerKind::Animal => Kind::Animal,
        PartnerKind::FixedObject => Kind::Object,
    }
}

/// Whether one of the zones of a side is wanted.
pub(crate) fn has_zone(party: &Party, wanted: impl Fn(ContactZone) -> bool) -> bool {
    party.zones.iter().any(|zone| wanted(zone.value))
}
