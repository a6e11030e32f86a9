//! From where the partner came, where that is not told in a word.

use crate::reading::order::steps;
use crate::reading::words::text;
use crate::told::side::{Side, is_on_foot};
use crate::told::zones::side_of;
use recrash_model::account::{
    Account, Act, ActFact, ContactState, CrashType, Kind, LaneWord, LeftRight, Origin, Other, Party, PlaceKind,
    RoadFeature, Source, told,
};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// Whether the partner pulled out from the kerb behind the ego, and came round it: told are that it pulled out or entered traffic,
/// and that it passed or came by on the left. Traffic keeps to the right, and so does who is parked.
pub(super) fn comes_round(origin: Origin, partner: &Party, state: ContactState, movement: Option<Movement>) -> bool {
    let passes = movement == Some(Movement::Passing) || partner.did(Act::Pass);
    let from_there = match origin {
        Origin::Parked { .. } => passes,
        Origin::Behind | Origin::Beside { side: LeftRight::Left } => true,
        _ => false,
    };
    let pulls_out = partner.did(Act::PullOut) || movement == Some(Movement::EnteringTraffic);
    from_there && pulls_out && state == ContactState::Moving
}

/// Where a partner is whom the ego passes: beside it, where only a rule says that it comes from behind.
pub(super) fn passed_beside(account: &Account, sv: &Side) -> Option<Origin> {
    let from = account.came_from.as_ref()?;
    let by_rule = matches!(from.source, Source::Rule { .. }) && from.value == Origin::Behind;
    let touched = side_of(&sv.zones).filter(|_| by_rule && sv.state == ContactState::Moving)?;
    Some(Origin::Beside { side: touched })
}

/// Where a partner is that is parked on a street, of which only the opposite side is told: at the left kerb, and in no lane. Who is told to head or
/// face another way than the ego is not moved there: it would face as the ego does.
pub(super) fn at_left_kerb(account: &Account, (origin, cp): (Origin, &Side), elsewhere: bool) -> Option<Origin> {
    let faces =
        |text: String| ["facing", "faced", "heading", "headed", "oncoming"].iter().any(|word| text.contains(word));
    let partner = account.partner.as_ref()?;
    let acts = partner.acts.iter().filter(|fact| !fact.after_contact).map(|fact| &fact.source);
    let from = account.came_from.iter().map(|fact| &fact.source);
    let kind = partner.kind.iter().map(|fact| &fact.source);
    let told_way = partner.heading.is_some() || acts.chain(from).chain(kind).map(text).any(faces);
    let place = told(&account.place.kind).unwrap_or(PlaceKind::Street);
    let street = place.is_street();
    let parked = cp.state == ContactState::Parked && cp.lane.is_none_or(|lane| lane == LaneWord::Curb);
    let there = origin == Origin::Opposite && street && parked && !elsewhere && !told_way;
    there.then_some(Origin::Parked { side: Some(LeftRight::Left) })
}

/// Whether an oncoming partner is told to have left its own side.
pub(super) fn comes_over(origin: Origin, [sv, partner]: [&Party; 2], movement: Option<Movement>) -> bool {
    // "It stopped for a car in its lanes, and that drifted towards the kerb": it was on the wrong side before.
    let answers = |fact: &ActFact| matches!(fact.act, Act::Slow | Act::Stop | Act::Drift | Act::Swerve);
    let answered = |step: u32| sv.acts.iter().any(|fact| fact.step <= step && answers(fact) && !fact.after_contact);
    let left = |act: Act| partner.acts.iter().any(|fact| fact.act == act && !fact.after_contact && !fact.begun);
    let told = match movement {
        Some(Movement::CrossingIntoOpposingLane | Movement::LaneDeparture | Movement::ChangingLanes) => true,
        Some(Movement::Straight | Movement::Passing) | None => left(Act::Drift) || left(Act::Swerve),
        // Against the flow at last, and not all the way: it went over to its left.
        Some(Movement::WrongWay) => partner.acts.iter().any(|fact| {
            let over = matches!(fact.act, Act::LaneChange | Act::Drift | Act::Swerve) && !fact.begun;
            let late = fact.act == Act::Drift && fact.after_other.is_some_and(answered);
            over && !late && !fact.after_contact && fact.side != Some(LeftRight::Right)
        }),
        _ => false,
    };
    origin == Origin::Opposite && told
}

/// Whether an oncoming partner is told to go round another one that stands: "moved over to get around a stalled van".
pub(super) fn goes_round_another(origin: Origin, account: &Account, partner: &Party) -> bool {
    let stands = |fact: &ActFact| matches!(fact.act, Act::Hold | Act::Park | Act::Stop) && !fact.after_contact;
    let named = |words: &str| {
        let is = |other: &&Other| {
            let kind = text(&other.kind.source);
            let name = kind.split_whitespace().next_back();
            name.is_some_and(|name| words.split_whitespace().any(|word| word == name))
        };
        let mut all = account.others.iter().filter(|other| !other.several && other.acts.iter().any(stands));
        all.any(|other| is(&other))
    };
    let round = |words: &str| words.split_whitespace().any(|word| matches!(word, "around" | "round" | "past" | "by"));
    let goes = |fact: &ActFact| {
        let words = text(&fact.source);
        fact.act == Act::Pass && !fact.after_contact && round(&words) && named(&words)
    };
    origin == Origin::Opposite && partner.acts.iter().any(goes)
}

/// How an oncoming partner moves that a column has on the wrong side, and words bring over there from a lane of its own.
pub(super) fn movement_over(origin: Option<Origin>, partner: &Party) -> Option<Movement> {
    let leaves = |fact: &ActFact| matches!(fact.act, Act::Drift | Act::Swerve | Act::LaneChange);
    let over = partner.acts.iter().any(|fact| leaves(fact) && !fact.after_contact && !fact.begun);
    let by_column = partner
        .movement
        .as_ref()
        .is_some_and(|fact| fact.value == Movement::WrongWay && !matches!(fact.source, Source::Words { .. }));
    let own_lane = partner.lane.as_ref().is_some_and(|fact| fact.value != LaneWord::Opposing);
    (origin == Some(Origin::Opposite) && by_column && over && own_lane).then_some(Movement::CrossingIntoOpposingLane)
}

/// Whether the partner is told to have backed into a space at the kerb, ahead of the ego or behind it.
pub(super) fn backs_in(partner: &Party, state: ContactState, origin: Origin, place: PlaceKind) -> bool {
    let at_kerb = place.is_street();
    let along = matches!(origin, Origin::Ahead | Origin::Behind);
    at_kerb && along && state == ContactState::Reversing && partner.did(Act::Park)
}

/// Out of which stall somebody backs of whom nobody says from where it came, where the place has stalls beside the road.
pub(super) fn out_of_stall(account: &Account, crash_type: CrashType, sv: &Side, cp: &Side) -> Option<Origin> {
    let stalls = account.place.features.iter().any(|feature| feature.value == RoadFeature::Stall);
    let backs = crash_type == CrashType::Backing && cp.state == ContactState::Reversing;
    let side = side_of(&sv.zones).filter(|_| stalls && backs)?;
    Some(Origin::Stall { side: Some(side) })
}

/// Whether somebody who pulled out is told to have done so from a driveway.
pub(super) fn leaves_driveway(partner: &Party) -> bool {
    let driveway = |source: &Source| match source {
        Source::Words { text, .. } => text.to_lowercase().contains("driveway"),
        _ => false,
    };
    partner.acts.iter().any(|fact| fact.act == Act::PullOut && !fact.after_contact && driveway(&fact.source))
}

/// From where a partner comes of whom nobody says it, where the type leaves no choice.
pub(super) fn assumed_origin(crash_type: CrashType, sv: &Side, cp: &Side) -> Option<Origin> {
    let rear = |side: &Side| side.zones.iter().any(|zone| zone.is_rear());
    let front = |side: &Side| side.zones.iter().any(|zone| zone.is_front());
    match crash_type {
        CrashType::FrontToRear if rear(sv) => Some(Origin::Behind),
        CrashType::FrontToRear if front(sv) => Some(Origin::Ahead),
        CrashType::SingleVehicle => Some(Origin::Ahead),
        CrashType::Backing if cp.state == ContactState::Reversing => {
            Some(if rear(sv) && !front(sv) { Origin::Behind } else { Origin::Ahead })
        }
        CrashType::Backing => Some(Origin::Behind),
        CrashType::HeadOn => Some(Origin::Opposite),
        CrashType::Secondary if rear(sv) => Some(Origin::Behind),
        CrashType::Lateral => {
            let on = |zones: &[ContactZone]| sv.zones.iter().any(|zone| zones.contains(zone));
            use ContactZone as Z;
            if on(&[Z::Left, Z::FrontLeft, Z::RearLeft]) {
                Some(Origin::Beside { side: LeftRight::Left })
            } else if on(&[Z::Right, Z::FrontRight, Z::RearRight]) {
                Some(Origin::Beside { side: LeftRight::Right })
            } else {
                None
            }
        }
        _ => None,
    }
}

/// Whether it is told of somebody on foot, or of an animal, that it went into the ego's way or across; who walks behind an ego that backs does.
/// Not who comes along behind it, towards it.
pub(super) fn walks_across(origin: Origin, account: &Account, partner: &Party, sv_backs: bool) -> bool {
    // Who stood beside the ego's way, and then stepped out, came from there.
    let stood = steps(partner, |act| matches!(act, Act::Hold | Act::Stop)).into_iter().max();
    let steps_out = steps(partner, |act| matches!(act, Act::Cross | Act::Enter)).into_iter().max();
    let stood = stood.is_some() && steps_out > stood;
    let from_stand = matches!(origin, Origin::Cross { .. }) && stood;
    let along = matches!(origin, Origin::Ahead | Origin::Beside { .. }) || from_stand;
    let on_foot = told(&partner.kind).and_then(Kind::partner_kind).is_some_and(is_on_foot);
    let crosses = told(&partner.movement) == Some(Movement::NmCrossing);
    let enters = [Act::Cross, Act::Enter, Act::PullOut].into_iter().any(|act| partner.did(act));
    let comes_along = account
        .came_from
        .as_ref()
        .map(|fact| text(&fact.source))
        .is_some_and(|words| ["toward", "from behind"].iter().any(|word| words.contains(word)) && !enters);
    let stands = partner.did(Act::Hold) || partner.did(Act::Stop);
    let walks = origin == Origin::Behind && sv_backs && !stands && !comes_along;
    (along && (crosses || enters) || walks) && on_foot
}
