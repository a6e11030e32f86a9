//! Where others than the two are, seen from the subject vehicle.

use super::Reading;
use super::origin::{
    Clues, at_curb, comes_against, first_relation, on_side_street, side_named_at, side_of_lane, side_of_road_of,
};
use super::{ahead, hides, touched};
use crate::chunk::bound;
use crate::frame::{Frame, zone_of};
use crate::lexicon::{Form, Relation, Sense};
use crate::token::Token;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Compass, Fact, Kind, KindGroup, LaneWord, LeftRight, Origin, Source};
use recrash_model::zones::ContactZone;

/// Where somebody else is: as told; else in its lane, beside that of the subject vehicle, or by the directions of the two.
pub(crate) fn place_of(reading: &Reading<'_>, actor: Actor) -> Option<Fact<Origin>> {
    let clues = Clues { reading, actor };
    let relation = first_relation(&clues);
    // Whom the subject vehicle goes around was in its way, and is beside it only then.
    let passed = |frame: &Frame| {
        frame.who == Some(SUBJECT)
            && frame.act() == Some(Act::Pass)
            && frame.object == Some(actor)
            && frame.side.is_some()
    };
    let relation = relation.filter(|relation| {
        !matches!(relation, Relation::Left | Relation::Right) || !reading.story.frames.iter().any(passed)
    });
    let value = relation.and_then(origin_of);
    let told = value.zip(relation).map(|(value, relation)| Fact { value, source: clues.has(relation) });
    comes_along_its_road(&clues, value)
        .or_else(|| stands_in_other_lane(&clues, value))
        .or(told)
        .or_else(|| behind_partner(reading, actor))
        .or_else(|| in_queue(&clues))
        .or_else(|| in_that_queue(&clues))
        .or_else(|| in_other_lane(&clues))
        .or_else(|| by_directions(&clues))
        .or_else(|| before_its_turn(&clues))
        .or_else(|| faces_its_way(&clues))
        .or_else(|| on_oncoming_side(&clues))
        .or_else(|| stands_in_oncoming_lane(&clues))
        .or_else(|| at_side_of_road(&clues))
        .or_else(|| told_afterwards(&clues))
        .or_else(|| stops_in_its_lane(&clues))
        .or_else(|| queue_waited_for(&clues))
        .or_else(|| in_slow_traffic(&clues))
        .or_else(|| approached(&clues))
        .or_else(|| by_another(&clues))
        .or_else(|| in_queue_of_partner(&clues))
        .or_else(|| in_next_lane(&clues))
        .or_else(|| goes_its_way(&clues))
        .or_else(|| stops_before_it(&clues))
        .or_else(|| stopped_for(&clues))
        .or_else(|| before_partner(&clues))
        .or_else(|| named_with_another(&clues))
        .or_else(|| ahead::ahead(&clues, queue_of(reading, actor)))
        .or_else(|| across_the_street(&clues))
        .or_else(|| on_cross_street(&clues))
}

/// Words in which who is parked across a street is told to block it. [tokens]
const BLOCKS_WITHIN: usize = 8;

/// "a van was double-parked across the street".
fn across_the_street(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, tokens) = (clues.reading, &clues.reading.story.tokens);
    let stands = |frame: &Frame| matches!(frame.act(), Some(Act::Hold | Act::Park)) && frame.happened();
    let vehicle = reading.story.world.actors[clues.actor].kind.is_some_and(Kind::is_vehicle);
    reading.before(clues.actor).filter(|(_, frame)| vehicle && stands(frame)).find_map(|(number, _)| {
        let (first, end) = reading.window(number);
        let at = (first..end.saturating_sub(2)).find(|&at| {
            let street = matches!(tokens[at + 2].text.as_str(), "street" | "road" | "roadway");
            // "parked across the street, blocking both lanes": athwart.
            let blocks = |token: &Token| token.text.starts_with("block") || token.text.starts_with("obstruct");
            let blocked = tokens[at..].iter().take(BLOCKS_WITHIN).take_while(|token| token.text != ".").any(blocks);
            tokens[at].text == "across" && tokens[at + 1].text == "the" && street && !blocked
        })?;
        Some(reading.told(Origin::Opposite, at, at + 3))
    })
}

/// "a tram on the cross street": there, though nobody tells on which side. Who strikes a partner comes from where it throws that at the
/// subject vehicle.
fn on_cross_street(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let actors = &reading.story.world.actors;
    let drives = actors[actor].kind.is_some_and(Kind::is_vehicle);
    // "Cross traffic" comes from either side.
    let (first, end) = actors[actor].kind_tokens?;
    let called = reading.story.tokens[first..end].iter().any(|token| token.text.starts_with("cross"));
    if !drives || called || !on_side_street(reading, actor) || actors[actor].heading.is_some() {
        return None;
    }
    let side = match (reading.contacts.with_partner(&reading.story, actor), reading.contacts.partner) {
        (Some(touch), Some(partner)) => {
            let zone = touched::earlier(reading, touch).and_then(|touch| touch.value.of_partner);
            let side = zone.and_then(flank);
            match actors[SUBJECT].heading?.0.eighths_to(actors[partner].heading?.0) {
                0 => side?,
                4 => side.map_or(LeftRight::Left, LeftRight::other),
                _ => return None,
            }
        }
        _ => LeftRight::Right,
    };
    let rule = "on the crossing road, on a side that is assumed where no word tells it";
    Some(Fact::by_rule(Origin::Cross { side }, rule))
}

/// "a bus in the leftmost lane stopped, as there was no room ahead", of one in the rightmost lane: beside it, whatever else is ahead.
fn stands_in_other_lane(clues: &Clues<'_>, place: Option<Origin>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let stands = |frame: &Frame| frame.act().is_some_and(Act::stands);
    let drives = |frame: &Frame| matches!(frame.act(), Some(Act::Follow | Act::LaneChange | Act::Turn | Act::PullOut));
    let any = |is: &dyn Fn(&Frame) -> bool| reading.before(actor).any(|(_, frame)| is(frame));
    let still = any(&stands) && !any(&drives);
    let own = place == Some(Origin::Ahead) && still && reading.story.world.actors[actor].lane.is_some();
    own.then(|| in_other_lane(clues)).flatten()
}

/// The place that a relation to the subject vehicle tells.
const fn origin_of(relation: Relation) -> Option<Origin> {
    match relation {
        Relation::Behind => Some(Origin::Behind),
        Relation::Ahead => Some(Origin::Ahead),
        Relation::Left => Some(Origin::Beside { side: LeftRight::Left }),
        Relation::Right => Some(Origin::Beside { side: LeftRight::Right }),
        Relation::Opposite => Some(Origin::Opposite),
        Relation::Same | Relation::Beside => None,
    }
}

/// "It struck a dog. A van traveling behind it then struck it too": told behind the crash, the van had been there before it.
fn told_afterwards(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let story = &reading.story;
    let known = &story.world.actors[actor];
    let contact = story.frames[reading.contacts.first?].sentence;
    known.relations.iter().filter(|(_, sentence)| *sentence > contact).find_map(|(relation, sentence)| {
        let value = origin_of(*relation)?;
        let told = |frame: &&Frame| {
            frame.who == Some(actor)
                && frame.sentence == *sentence
                && frame.relations.iter().any(|(other, _)| other == relation)
        };
        // "A van that was waiting behind it drove around it."
        let waited = |frame: &Frame| frame.act() == Some(Act::Hold) && (frame.form == Form::Ing || frame.described);
        let went = |frame: &Frame| frame.act() == Some(Act::Follow) && frame.form == Form::Ing;
        let drives = |frame: &Frame| (went(frame) || waited(frame)) && frame.happened();
        // "A bus then stopped behind it": it came up from there.
        let comes_up =
            |frame: &Frame| *relation == Relation::Behind && frame.act() == Some(Act::Stop) && frame.happened();
        match story.frames.iter().find(told) {
            Some(frame) => (drives(frame) || comes_up(frame)).then(|| Fact { value, source: reading.of(frame) }),
            // "A van directly ahead of it swerved".
            None => {
                let (first, end) = known.kind_tokens.filter(|(first, _)| *first >= story.sentences[*sentence].first)?;
                Some(reading.told(value, first, end))
            }
        }
    })
}

/// "It slowed for a van that had come along in the same lane and stopped there": the van is ahead.
fn stops_in_its_lane(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let actors = &reading.story.world.actors;
    let ((own, ..), (lane, first, end)) = (actors[SUBJECT].lane?, actors[actor].lane?);
    let stays = !reading.did(SUBJECT, Act::LaneChange) && !reading.did(SUBJECT, Act::Turn);
    let stops = reading.did(actor, Act::Stop) || reading.did(actor, Act::Hold);
    let reacts = |(_, frame): (usize, &Frame)| {
        let slows = frame.act().is_some_and(Act::slows);
        frame.object == Some(actor) && (slows || matches!(frame.sense, Sense::Yield | Sense::Approach))
    };
    let met = own == lane && stays && stops && reading.before(SUBJECT).any(reacts);
    met.then(|| reading.told(Origin::Ahead, first, end))
}

/// "It was yielding to a queue of cars", "slowed for a line of traffic": that is ahead of it, and not across its way.
fn queue_waited_for(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let (from, end) = queue_of(reading, actor)?;
    let across = |token: &Token| {
        matches!(
            token.text.as_str(),
            "across" | "crossing" | "oncoming" | "opposing" | "opposite" | "adjacent" | "next" | "on"
        )
    };
    let tokens = &reading.story.tokens;
    let elsewhere = tokens[from..(end + ACROSS_WITHIN).min(tokens.len())].iter().any(across);
    let waits = |(_, frame): (usize, &Frame)| {
        let slows = frame.sense == Sense::Yield || frame.act().is_some_and(Act::slows);
        frame.object == Some(actor) && slows && frame.happened()
    };
    // "was pulling out of a driveway", "waited at a stop sign", "to turn left": those cross its way.
    let leaves = [Act::Turn, Act::PullOut, Act::Enter, Act::LaneChange].iter().any(|act| reading.did(SUBJECT, *act));
    let sentence = reading.story.sentences.iter().find(|sentence| (sentence.first..sentence.end).contains(&from));
    let told = sentence.map_or(from..from, |sentence| sentence.first..from);
    let ways = |pair: &[Token]| {
        let (one, other) = (pair[0].text.as_str(), pair[1].text.as_str());
        matches!((one, other), ("stop" | "yield", "sign")) || one == "to" && matches!(other, "turn" | "enter" | "merge")
    };
    let stays = !leaves && !tokens[told].windows(2).any(ways);
    (stays && !elsewhere && reading.before(SUBJECT).any(waits)).then(|| reading.told(Origin::Ahead, from, end))
}

/// Words that place a queue across the road, or beside it, stand so near behind it. [tokens]
const ACROSS_WITHIN: usize = 6;

/// "Traffic came to a sudden stop, and it stopped": the traffic that it is in.
fn stops_before_it(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let known = &reading.story.world.actors[actor];
    let (first, end) = known.kind_tokens?;
    let traffic = reading.story.tokens[first..end].len() == 1 && reading.story.tokens[first].text == "traffic";
    let stops = |frame: &Frame| matches!(frame.act(), Some(Act::Stop | Act::Slow)) && frame.happened();
    let before = |(number, frame): (usize, &Frame)| {
        let next = reading.story.frames.get(number + 1);
        stops(frame)
            && next.is_some_and(|next| next.who == Some(SUBJECT) && stops(next) && next.sentence == frame.sentence)
    };
    let alone = known.heading.is_none() && known.lane.is_none() && known.relations.is_empty();
    (traffic && alone && reading.before(actor).any(before)).then(|| reading.told(Origin::Ahead, first, end))
}

/// "It was driving in stop-and-go traffic": who drives in it has it ahead.
fn in_slow_traffic(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let reading = clues.reading;
    let known = &reading.story.world.actors[clues.actor];
    let (first, end) = known.kind_tokens.filter(|_| known.several)?;
    let tokens = &reading.story.tokens;
    let from = (first.saturating_sub(5)..first + 1).find(|at| tokens[*at].text == "in")?;
    let words: Vec<&str> = tokens[from..end].iter().map(|token| token.text.as_str()).collect();
    let slow = words.iter().any(|word| matches!(*word, "go" | "congested" | "bumper" | "crawling"))
        || words.windows(2).any(|pair| matches!(pair, ["slow" | "slowly", "moving"]));
    let drives = |(number, frame): (usize, &Frame)| {
        let (begins, ends) = reading.window(number);
        frame.act() == Some(Act::Follow) && (begins..ends).contains(&from)
    };
    let traffic = words.last() == Some(&"traffic");
    (traffic && slow && reading.before(SUBJECT).any(drives)).then(|| reading.told(Origin::Ahead, from, end))
}

/// "It approached a truck traveling slowly": which drives ahead, and which it does not go past.
fn approached(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let known = &reading.story.world.actors[actor];
    let (first, end) = known.kind_tokens?;
    let met = |frame: &Frame| frame.object == Some(actor) && frame.happened();
    let (number, _) = reading.before(SUBJECT).find(|(_, frame)| frame.sense == Sense::Approach && met(frame))?;
    let passes = reading.before(SUBJECT).any(|(_, frame)| frame.act() == Some(Act::Pass) && met(frame));
    let drives = |(other, frame): (usize, &Frame)| {
        other == number + 1 && frame.form == Form::Ing && frame.act() == Some(Act::Follow)
    };
    let along = !known.several && known.kind.is_some_and(Kind::is_vehicle) && reading.before(actor).any(drives);
    // "It encountered a double-parked van": that stands in a lane.
    let in_lane = !known.several
        && reading.story.tokens[first..(end + 1).min(reading.story.tokens.len())]
            .windows(2)
            .any(|pair| pair[0].text == "double" && pair[1].text.starts_with("park"));
    (!passes && (along || in_lane || is_queue_met(reading, number))).then(|| reading.told(Origin::Ahead, first, end))
}

/// "It approached a queue of stopped traffic ahead": whatever it was called before, it stands in front of it.
fn is_queue_met(reading: &Reading<'_>, number: usize) -> bool {
    let (first, end) = reading.window(number);
    let clause = reading.story.tokens[first..end].iter().take_while(|token| token.text != ",");
    let words: Vec<&str> = clause.map(|token| token.text.as_str()).collect();
    let queue = words.windows(2).any(|pair| matches!(pair, ["queue" | "line", "of"])) || words.contains(&"queue");
    queue && !words.iter().any(|word| word.starts_with("park"))
}

/// "A van was stopped on the westbound side of Elm Street", of who goes east.
fn on_oncoming_side(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, tokens) = (clues.reading, &clues.reading.story.tokens);
    let (own, ..) = reading.story.world.actors[SUBJECT].heading?;
    let stands = |frame: &Frame| frame.act().is_some_and(Act::stands);
    reading.before(clues.actor).filter(|(_, frame)| stands(frame)).find_map(|(number, _)| {
        let (first, end) = reading.window(number);
        let at =
            (fronted(reading, number)..first.max(end.saturating_sub(1))).find(|&at| tokens[at + 1].text == "side")?;
        let way = bound(&tokens[at].text)?;
        (own.eighths_to(way) == 4).then(|| reading.told(Origin::Opposite, at, at + 2))
    })
}

/// The side of a vehicle on which a zone is.
const fn flank(zone: ContactZone) -> Option<LeftRight> {
    match zone {
        ContactZone::FrontLeft | ContactZone::Left | ContactZone::RearLeft => Some(LeftRight::Left),
        ContactZone::FrontRight | ContactZone::Right | ContactZone::RearRight => Some(LeftRight::Right),
        _ => None,
    }
}

/// "On the westbound side a van was double-parked": where the words of a clause begin that is the first of its sentence.
fn fronted(reading: &Reading<'_>, number: usize) -> usize {
    let frames = &reading.story.frames;
    let frame = &frames[number];
    let later = frames[..number].iter().any(|other| other.sentence == frame.sentence);
    if later { frame.first } else { reading.story.sentences[frame.sentence].first }
}

/// "A truck stopped in the adjacent oncoming lane": it came from there, where nothing tells that it went over.
fn stands_in_oncoming_lane(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let (lane, first, end) = reading.story.world.actors[actor].lane?;
    let acts = || reading.before(actor).filter_map(|(_, frame)| frame.act());
    let stands = acts().next().is_some() && acts().all(|act| act.stands());
    (lane == LaneWord::Opposing && stands).then(|| reading.told(Origin::Opposite, first, end))
}

/// "traffic ahead braked for a stalled bus": that is ahead too.
fn stopped_for(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let slows = |frame: &Frame| frame.act().is_some_and(Act::slows) && frame.happened();
    let for_it = |frame: &&Frame| frame.object == Some(actor) && slows(frame);
    let ahead = |frame: &&Frame| {
        let who = frame.who.filter(|who| ![SUBJECT, actor].contains(who));
        who.is_some_and(|who| first_relation(&Clues { reading, actor: who }) == Some(Relation::Ahead))
    };
    let frames = reading.story.frames.iter().enumerate().filter(|(number, _)| !reading.is_after(*number));
    let frame = frames.map(|(_, frame)| frame).find(|frame| for_it(frame) && ahead(frame))?;
    reading.story.world.actors[actor].kind.filter(|kind| kind.is_vehicle())?;
    Some(Fact { value: Origin::Ahead, source: reading.of(frame) })
}

/// "entered behind a car that had just cleared the junction", of a partner that crosses: the car came along its road.
fn before_partner(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let partner = reading.contacts.partner?;
    let actors = &reading.story.world.actors;
    let follows = actors[partner].seen_from.contains(&(Relation::Behind, actor));
    let (first, end) = actors[actor].kind_tokens.filter(|_| follows)?;
    // "appeared from behind a van": that stands in the line of sight.
    let place = first_place(reading, partner).filter(|_| !hides::hides(reading, actor, (first, end)))?;
    matches!(place, Origin::Opposite | Origin::Cross { .. }).then(|| reading.told(place, first, end))
}

/// "stood behind a van and a hatchback": where the van is.
fn named_with_another(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let actors = &reading.story.world.actors;
    let (first, end) = actors[actor].kind_tokens?;
    let article =
        usize::from(first > 0 && matches!(reading.story.word(first - 1), "a" | "an" | "the" | "two" | "another"));
    let and = first.checked_sub(1 + article).filter(|at| reading.story.word(*at) == "and")?;
    let ahead = |other: &usize| {
        let before = actors[*other].kind_tokens.is_some_and(|(_, end)| end == and);
        before && first_relation(&Clues { reading, actor: *other }) == Some(Relation::Ahead)
    };
    let vehicle = actors[actor].kind.is_some_and(Kind::is_vehicle);
    (1..actors.len()).find(ahead).filter(|_| vehicle).map(|_| reading.told(Origin::Ahead, first, end))
}

/// "a line of cars behind the truck": where the truck is.
fn by_another(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let known = &reading.story.world.actors[actor];
    let (first, end) = known.kind_tokens?;
    known.seen_from.iter().find_map(|(relation, other)| {
        let value = first_place(reading, *other)?;
        let there = match (relation, value) {
            (Relation::Behind | Relation::Ahead, Origin::Opposite | Origin::Cross { .. }) => true,
            (Relation::Behind, Origin::Behind) | (Relation::Ahead, Origin::Ahead) => true,
            // Of two that touched behind it, both are.
            (Relation::Ahead, Origin::Behind) => true,
            _ => false,
        };
        there.then(|| reading.told(value, first, end))
    })
}

/// Where another is by what is told of itself alone.
fn first_place(reading: &Reading<'_>, actor: Actor) -> Option<Origin> {
    let clues = Clues { reading, actor };
    let told = first_relation(&clues).and_then(origin_of);
    told.or_else(|| by_directions(&clues).map(|fact| fact.value))
        .or_else(|| behind_partner(reading, actor).map(|fact| fact.value))
}

/// The queue in which the partner stands, in the lane beside the subject vehicle, is there too.
fn in_queue_of_partner(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let reading = clues.reading;
    let partner = reading.contacts.partner?;
    let (first, end) = queue_of(reading, clues.actor)?;
    let value = in_next_lane(&Clues { reading, actor: partner })?.value;
    held_in(reading, partner, first, end).then(|| reading.told(value, first, end))
}

/// "a truck in the adjacent lane": beside it, though nobody tells on which side. Who comes over from there goes to the other side; of
/// a kerb the lanes are on the left.
fn in_next_lane(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let drives = reading.story.world.actors[actor].kind.is_some_and(Kind::is_vehicle);
    let words = match clues.has(Relation::Beside) {
        Source::Words { text, .. } => text.to_lowercase(),
        _ => return None,
    };
    let lane = ["adjacent lane", "next lane", "neighboring lane"].iter().any(|name| words.contains(name));
    let next = drives && clues.any(Relation::Beside) && lane;
    let comes = reading.before(actor).find(|(_, frame)| frame.side.is_some()).and_then(|(_, frame)| frame.side);
    let side = comes.map_or(LeftRight::Left, LeftRight::other);
    let rule = "in the next lane, on a side that is assumed where no word tells it";
    next.then(|| Fact::by_rule(Origin::Beside { side }, rule))
}

/// "went around the truck to the left and yielded to traffic in its direction of travel": on the side to which it goes, else behind it.
fn goes_its_way(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let known = &reading.story.world.actors[actor];
    let (first, end) = known.kind_tokens.filter(|_| known.several && known.kind.is_some_and(Kind::is_vehicle))?;
    let tokens = &reading.story.tokens;
    let words: Vec<&str> = tokens[end..]
        .iter()
        .take(WAY_WORDS)
        .take_while(|token| token.text != ".")
        .map(|token| token.text.as_str())
        .collect();
    let own = |at: usize| at > 0 && matches!(words[at - 1], "its" | "same" | "'s");
    let way = words.windows(3).position(|run| run == ["direction", "of", "travel"]).is_some_and(own);
    let (_, yields) =
        reading.before(SUBJECT).find(|(_, frame)| frame.sense == Sense::Yield && frame.object == Some(actor))?;
    let over = |frame: &Frame| {
        matches!(frame.act(), Some(Act::Pass | Act::LaneChange | Act::Drift | Act::Swerve | Act::PullOut))
    };
    let goes = |(_, frame): (usize, &Frame)| frame.side.filter(|_| over(frame) && frame.first < yields.first);
    let side = reading.before(SUBJECT).filter_map(goes).last();
    way.then(|| reading.told(side.map_or(Origin::Behind, |side| Origin::Beside { side }), first, end))
}

/// The words that say which way somebody goes stand no farther behind its name. [tokens]
const WAY_WORDS: usize = 12;

/// "a man standing on the south side of the road": left of who goes west. "Crossing from the south side": from there.
fn at_side_of_road(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let own = reading.story.world.actors[SUBJECT].heading.map(|(compass, ..)| compass);
    let stands = |act: Option<Act>| act.is_some_and(Act::stands);
    let walks = reading.story.world.actors[actor].kind.is_some_and(|kind| kind.group() == KindGroup::OnFoot);
    let turned = reading.did(SUBJECT, Act::Turn) || reading.did(SUBJECT, Act::UTurn);
    // "a van parked facing east on the north curb".
    let drives = reading.story.world.actors[actor].kind.is_some_and(Kind::is_vehicle);
    let parked = drives && reading.before(actor).any(|(_, frame)| frame.sense == Sense::Parked);
    // "Two vans stood at the curb on the north side of the street".
    let still = |frame: &Frame| frame.act().is_some_and(Act::rests);
    let parked = parked || drives && reading.before(actor).all(|(_, frame)| still(frame)) && at_curb(reading, actor);
    if !(walks || parked) || turned {
        return None;
    }
    let of = |frame: &Frame| reading.of(frame);
    let first = |act: &dyn Fn(Option<Act>) -> bool| {
        reading.before(actor).map(|(_, frame)| frame).find(|frame| act(frame.act()))
    };
    if let Some(side) = side_of_road_of(reading, actor, own, stands) {
        return Some(Fact { value: Origin::Beside { side }, source: of(first(&stands)?) });
    }
    if let Some((side, at)) = side_behind_its_name(reading, actor, own) {
        return Some(reading.told(Origin::Beside { side }, at, at + 2));
    }
    let crosses = |act: Option<Act>| matches!(act, Some(Act::Cross | Act::Enter));
    let side = side_of_road_of(reading, actor, own, crosses).filter(|_| walks)?;
    Some(Fact { value: Origin::Cross { side }, source: of(first(&crosses)?) })
}

/// "a cord held by a man on the west sidewalk": where who is named so stands, and the token that says it.
fn side_behind_its_name(reading: &Reading<'_>, actor: Actor, own: Option<Compass>) -> Option<(LeftRight, usize)> {
    let (_, end) = reading.story.world.actors[actor].kind_tokens?;
    let at = end + 1 + usize::from(reading.story.word(end + 1) == "the");
    let stands = matches!(reading.story.word(end), "on" | "at" | "along");
    side_named_at(reading, at, own).filter(|_| stands).map(|side| (side, at))
}

/// Who struck the rear of a partner that is behind, or of another that is, came from behind too.
fn behind_partner(reading: &Reading<'_>, actor: Actor) -> Option<Fact<Origin>> {
    let rear = |frame: &Frame| {
        let on = frame.on.as_ref().and_then(zone_of);
        frame.sense == Sense::RearEnd || on.is_some_and(|zone| zone.is_rear())
    };
    let struck = reading.contacts.earlier.iter().map(|number| &reading.story.frames[*number]);
    let frame = struck.into_iter().find(|frame| frame.who == Some(actor) && frame.object.is_some() && rear(frame))?;
    let struck = frame.object.filter(|struck| ![SUBJECT, actor].contains(struck))?;
    let behind = first_relation(&Clues { reading, actor: struck }) == Some(Relation::Behind);
    let across = by_directions(&Clues { reading, actor }).is_some();
    (behind && !across).then(|| Fact { value: Origin::Behind, source: reading.of(frame) })
}

/// The queue in which the subject vehicle stands is ahead of it.
fn in_queue(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (from, end) = queue_of(clues.reading, clues.actor)?;
    let held = held_in(clues.reading, SUBJECT, from, end);
    // "waited, yielding to a line of cars": it stands in none.
    let before = &clues.reading.story.tokens[from.saturating_sub(YIELDS_WITHIN)..from];
    let yields = before.iter().any(|token| token.text.starts_with("yield"));
    (held && !yields).then(|| clues.reading.told(Origin::Ahead, from, end))
}

/// To what somebody yields stands so near behind the verb. [tokens]
const YIELDS_WITHIN: usize = 3;

/// The tokens of somebody who is called a queue: "a queue of traffic".
fn queue_of(reading: &Reading<'_>, actor: Actor) -> Option<(usize, usize)> {
    let story = &reading.story;
    let (first, end) = story.world.actors[actor].kind_tokens?;
    let from = first.checked_sub(2)?;
    let queue = ["queue", "line"].contains(&story.word(from)) && story.word(from + 1) == "of";
    // "in queued traffic", "in a traffic queue".
    let traffic = story.word(end - 1) == "traffic"
        && (matches!(story.word(first - 1), "in" | "behind")
            || story.word(first) == "a" && story.word(from + 1) == "in");
    let stands =
        (first..end).any(|at| matches!(story.word(at), "queued" | "backed" | "stopped" | "standing" | "stationary"));
    let jam = matches!(story.word(end), "queue" | "jam" | "backup");
    // "stopped in traffic".
    let plain = end == first + 1 && story.word(first - 1) == "in";
    (queue || traffic && (stands || jam || plain)).then_some((from, end))
}

/// "Traffic was queued for the light, and it was standing in that queue": what it stands in is ahead of it.
fn in_that_queue(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let known = &reading.story.world.actors[actor];
    let queues = |(number, _): &(usize, &Frame)| {
        let (first, end) = reading.window(*number);
        (first..end).any(|at| {
            reading.story.word(at).starts_with("queue")
                || matches!(reading.story.word(at), "lined" | "backed" | "standstill")
        })
    };
    let (_, queue) = reading.before(actor).find(queues).filter(|_| known.several)?;
    if !known.kind.is_some_and(Kind::is_vehicle) {
        return None;
    }
    let stands = |frame: &Frame| frame.act().is_some_and(Act::stands) && frame.happened();
    reading.before(SUBJECT).filter(|(_, frame)| stands(frame)).find_map(|(number, _)| {
        let (first, end) = reading.window(number);
        (first..end.saturating_sub(1)).filter(|at| reading.story.word(*at) == "in").find_map(|at| {
            let line = matches!(reading.story.word(at + 1), "that" | "the" | "this")
                && at + 2 < end
                && matches!(reading.story.word(at + 2), "queue" | "line");
            let it = reading.story.word(at + 1) == "it" && reading.story.frames[number].sentence == queue.sentence;
            (line || it).then(|| reading.told(Origin::Ahead, at, at + if line { 3 } else { 2 }))
        })
    })
}

/// Whether somebody is told to stand in the queue that is named by these tokens.
fn held_in(reading: &Reading<'_>, who: Actor, from: usize, end: usize) -> bool {
    let story = &reading.story;
    let stands = |frame: &Frame| {
        let sentence = story.sentences[frame.sentence];
        let stands = frame.act().is_some_and(Act::stands) && frame.who == Some(who);
        stands
            && frame.first < from + 2
            && end <= sentence.end
            && !story.frames.iter().any(|other| between(frame, other, from + 2))
    };
    story.frames.iter().any(stands)
}

/// Whether a frame of somebody else stands between another frame and a token.
fn between(frame: &Frame, other: &Frame, token: usize) -> bool {
    other.who != frame.who && other.first > frame.first && other.first < token
}

/// Somebody in another lane than the subject vehicle, where that keeps its own.
fn in_other_lane(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let reading = clues.reading;
    let (own, _, _) = reading.story.world.actors[SUBJECT].lane?;
    if reading.did(SUBJECT, Act::LaneChange) || reading.did(SUBJECT, Act::Turn) || comes_against(clues) {
        return None;
    }
    let beside = |side: LeftRight| Origin::Beside { side };
    if let Some((lane, first, end)) = reading.story.world.actors[clues.actor].lane {
        return Some(reading.told(beside(side_of_lane(own, lane)?), first, end));
    }
    // In the adjacent lane: of the leftmost one on the right.
    let side = match own {
        LaneWord::Left | LaneWord::LeftTurn => LeftRight::Right,
        LaneWord::Right | LaneWord::RightTurn => LeftRight::Left,
        _ => return None,
    };
    clues.any(Relation::Beside).then(|| Fact { value: beside(side), source: clues.has(Relation::Beside) })
}

/// Somebody who is told to go the other way, or across.
fn by_directions(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let actors = &clues.reading.story.world.actors;
    let ((own, ..), (other, first, end)) = (actors[SUBJECT].heading?, actors[clues.actor].heading?);
    let aslant = || met_aslant(clues.reading, clues.actor, own.eighths_to(other));
    Some(clues.reading.told(met_from(own, other).or_else(aslant)?, first, end))
}

/// "A van going west in the next lane cut in", of one that goes east: the lane is next to that of another who goes west. "A group of
/// cyclists came south towards it" meets who goes west from its right.
fn comes_along_its_road(clues: &Clues<'_>, place: Option<Origin>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let fact = by_directions(clues)?;
    let turned = reading.did(SUBJECT, Act::Turn) || reading.did(SUBJECT, Act::UTurn);
    let stands = |frame: &Frame| matches!(frame.act(), Some(Act::Hold | Act::Park | Act::Reverse));
    let drives = reading.before(actor).any(|(_, frame)| frame.act() == Some(Act::Follow))
        && !reading.before(actor).any(|(_, frame)| stands(frame));
    let is_other_road = match place? {
        Origin::Beside { .. } => fact.value == Origin::Opposite && !turned,
        Origin::Opposite => matches!(fact.value, Origin::Cross { .. }) && !is_oncoming(reading, actor),
        _ => false,
    };
    (drives && is_other_road).then_some(fact)
}

/// "an oncoming van": so it is called, whatever way it is told to go.
fn is_oncoming(reading: &Reading<'_>, actor: Actor) -> bool {
    let named = reading.story.world.actors[actor].kind_tokens;
    let oncoming = |token: &Token| token.text == "oncoming";
    named.is_some_and(|(first, end)| reading.story.tokens[first..end].iter().any(oncoming))
}

/// From where somebody with this direction meets one with another.
fn met_from(own: Compass, other: Compass) -> Option<Origin> {
    Some(match own.eighths_to(other) {
        2 => Origin::Cross { side: LeftRight::Left },
        4 => Origin::Opposite,
        6 => Origin::Cross { side: LeftRight::Right },
        _ => return None,
    })
}

/// "traveling northbound, entered the junction at green", told of one that goes northwest, and struck the one that it met: on a road that
/// crosses aslant.
fn met_aslant(reading: &Reading<'_>, actor: Actor, eighths: u8) -> Option<Origin> {
    let enters =
        |frame: &Frame| matches!(frame.act(), Some(Act::Enter | Act::RunRed | Act::RunStop)) && frame.happened();
    let crosses = reading.before(actor).any(|(_, frame)| enters(frame));
    let strikes = reading.contacts.with_partner(&reading.story, actor).is_some();
    let side = match eighths {
        1 | 3 => LeftRight::Left,
        5 | 7 => LeftRight::Right,
        _ => return None,
    };
    (crosses && strikes).then_some(Origin::Cross { side })
}

/// "It slowed for a bus turning right onto northbound Elm Street": which came westbound.
fn before_its_turn(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let actors = &reading.story.world.actors;
    let (own, ..) = actors[SUBJECT].heading?;
    let turns = |frame: &Frame| frame.act() == Some(Act::Turn) && frame.onto && frame.happened();
    let (_, frame) = reading.before(actor).find(|(_, frame)| turns(frame))?;
    let (after, ..) = frame.heading?;
    let before = after.turned(if frame.side? == LeftRight::Right { 6 } else { 2 });
    let came = actors[actor].heading.is_none() && actors[actor].kind.is_some_and(Kind::is_vehicle);
    Some(Fact { value: met_from(own, before).filter(|_| came)?, source: reading.of(frame) })
}

/// "It yielded to a van facing west at the crosswalk", told of one that goes west: the van stands ahead.
fn faces_its_way(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let known = &reading.story.world.actors[actor];
    let ((own, ..), (other, first, end)) = (reading.story.world.actors[SUBJECT].heading?, known.heading?);
    let stays = !reading.did(SUBJECT, Act::Turn) && !reading.did(SUBJECT, Act::LaneChange);
    let stands = |frame: &Frame| {
        frame.sense == Sense::Face || frame.sense != Sense::Parked && frame.act().is_some_and(Act::stands)
    };
    let only_stands = !known.several && reading.before(actor).all(|(_, frame)| stands(frame));
    let met = |(_, frame): (usize, &Frame)| {
        let slows = frame.sense == Sense::Yield || frame.act().is_some_and(Act::slows);
        frame.object == Some(actor) && slows && frame.happened()
    };
    let ahead = known.kind.is_some_and(Kind::is_vehicle) && own == other && stays && only_stands;
    (ahead && reading.before(SUBJECT).any(met)).then(|| reading.told(Origin::Ahead, first, end))
}
