//! What kind of crash it is: type and first contact, each by a rule over the facts
//! (`docs/models/crash-types.md`).

use super::Reading;
use super::party::has_zone;
use crate::lexicon::Sense;
use recrash_model::account::{
    Account, Act, ContactState, CrashType, Fact, FirstContact, Kind, KindGroup, LaneWord, LeftRight, Origin, Party,
    told,
};
use recrash_model::template::Movement;

pub(super) fn group(account: &Account) -> Option<KindGroup> {
    account.partner.as_ref().and_then(|partner| told(&partner.kind)).map(Kind::group)
}

pub(super) fn sv_state(account: &Account) -> Option<ContactState> {
    told(&account.sv.state)
}

pub(super) fn cp_state(account: &Account) -> Option<ContactState> {
    account.partner.as_ref().and_then(|partner| told(&partner.state))
}

/// Whether a turn of this side is under way at the contact: told last but for slowing and stopping.
pub(crate) fn turning(party: &Party) -> bool {
    let before: Vec<_> = party.acts.iter().filter(|fact| !fact.after_contact).collect();
    let Some(last) = before.iter().rposition(|fact| matches!(fact.act, Act::Turn | Act::UTurn)) else { return false };
    let later = &before[last + 1..];
    let done = match &before[last].source {
        recrash_model::account::Source::Words { text, .. } => {
            let text = text.to_lowercase();
            text.starts_with("completed") || text.starts_with("had ") || text.starts_with("finished")
        }
        _ => false,
    };
    !done
        && !later.iter().any(|fact| {
            matches!(fact.act, Act::Follow | Act::PullOver | Act::Park | Act::Pass | Act::Reverse | Act::LaneChange)
        })
}

/// The crash type: the first whose rule fits.
pub(crate) fn crash_type(reading: &Reading<'_>, account: &Account) -> Option<Fact<CrashType>> {
    let (value, name) = type_of(reading, account)?;
    Some(Fact::by_rule(value, name))
}

fn type_of(reading: &Reading<'_>, account: &Account) -> Option<(CrashType, &'static str)> {
    let partner = account.partner.as_ref()?;
    if group(account) == Some(KindGroup::Object) {
        return Some(if told(&partner.kind) == Some(Kind::Cargo) || off_a_vehicle(reading) {
            (CrashType::Other, "cargo")
        } else {
            (CrashType::SingleVehicle, "a thing")
        });
    }
    if !reading.contacts.others_only
        && (partner.did(Act::Pushed) && !partner.did(Act::Reverse)
            || !reading.contacts.earlier.is_empty() && account.others.iter().any(|other| other.touched_partner)
            || separate(reading)
            || of_a_crash(reading))
        && !drove_on(reading)
    {
        return Some((CrashType::Secondary, "another contact threw the partner at it"));
    }
    match group(account) {
        Some(KindGroup::OnFoot) => return Some((CrashType::Pedestrian, "kind of the partner")),
        Some(KindGroup::Cyclist) => return Some((CrashType::Cyclist, "kind of the partner")),
        Some(KindGroup::Motorcycle) => return Some((CrashType::Motorcycle, "kind of the partner")),
        Some(KindGroup::Animal | KindGroup::Other) => return Some((CrashType::Other, "kind of the partner")),
        _ => {}
    }
    if reading.contacts.others_only {
        return Some((CrashType::Other, "the subject vehicle was not touched"));
    }
    let sv = sv_state(account);
    let cp = cp_state(account);
    let sv_moves = sv.is_some_and(|state| !state.stands());
    if cp == Some(ContactState::Parked)
        && sv_moves
        && sv != Some(ContactState::Reversing)
        && !partner.did(Act::PullOut)
        && !double_parked(reading)
        && account.door.is_none()
    {
        return Some((CrashType::SingleVehicle, "an unoccupied parked vehicle"));
    }
    if cp == Some(ContactState::Reversing)
        || sv == Some(ContactState::Reversing)
        || told(&partner.movement) == Some(Movement::Backing)
        || told(&partner.movement) == Some(Movement::ParkingManeuver) && partner.did(Act::Reverse)
    {
        return Some((CrashType::Backing, "one went backwards"));
    }
    if account.door.is_some() {
        return Some((CrashType::Other, "a door"));
    }
    let origin = told(&account.came_from);
    let front = |party: &Party| has_zone(party, |zone| zone.is_front());
    let rear = |party: &Party| has_zone(party, |zone| zone.is_rear());
    let flank = |party: &Party| {
        !party.zones.is_empty() && party.zones.iter().all(|zone| !zone.value.is_front() && !zone.value.is_rear())
    };
    let (sv_turns, cp_turns) = (turning(&account.sv), turning(partner));
    let rear_end = reading.contacts.first.is_some_and(|number| reading.story.frames[number].sense == Sense::RearEnd);
    // Words for a touch along the side.
    let along = reading.contacts.first.is_some_and(|number| {
        let frame = &reading.story.frames[number];
        let word = reading.story.tokens[frame.first].text.as_str();
        ["swip", "side", "scrap", "graz", "brush"].iter().any(|stem| word.starts_with(stem))
    });
    if along
        && matches!(origin, Some(Origin::Behind | Origin::Ahead))
        && !(rear(&account.sv) && front(partner))
        && !front_rear(account)
    {
        return Some((CrashType::Lateral, "a touch along the side"));
    }
    let sideways = partner.did(Act::LaneChange) || partner.did(Act::Swerve) || partner.did(Act::Drift);
    match origin {
        Some(Origin::Behind) => {
            if rear_end
                || (rear(&account.sv) && front(partner))
                || (rear(&account.sv) && partner.zones.is_empty() && !partner.did(Act::Pass))
            {
                let passing = partner.did(Act::Pass) && !square(account);
                return Some(if passing {
                    (CrashType::Lateral, "it passed")
                } else {
                    (CrashType::FrontToRear, "front on rear, one way")
                });
            }
            if sv_turns && !sv.is_some_and(ContactState::stands) && (flank(&account.sv) || front(&account.sv)) {
                return Some((CrashType::Intersection, "one turned across the other"));
            }
            if account.sv.zones.is_empty() && partner.zones.is_empty() && !partner.did(Act::Pass) && !sideways {
                return Some((CrashType::FrontToRear, "from behind"));
            }
            if cp_turns && turned_across(account) {
                return Some((CrashType::Intersection, "one turned across the other"));
            }
            Some((CrashType::Lateral, "one way, side by side"))
        }
        Some(Origin::Ahead) => {
            if cp_turns && !front_rear(account) {
                return Some((CrashType::Intersection, "one turned across the other"));
            }
            if rear_end
                || front_rear(account)
                || (front(&account.sv) && partner.zones.is_empty())
                || (account.sv.zones.is_empty() && rear(partner) && !sideways)
                || (account.sv.zones.is_empty() && partner.zones.is_empty() && !sideways && !account.sv.did(Act::Pass))
                || (front(&account.sv) && !sideways && !account.sv.did(Act::Pass))
            {
                return Some((CrashType::FrontToRear, "front on rear, one way"));
            }
            Some((CrashType::Lateral, "one way, side by side"))
        }
        Some(Origin::Opposite) => {
            let column = told(&account.sv.movement) == Some(Movement::LeftTurn) && turn_side(&account.sv).is_none();
            let across = column
                || (sv_turns && turn_side(&account.sv) == Some(LeftRight::Left))
                || (cp_turns
                    && turn_side(partner) == Some(LeftRight::Left)
                    && !(sv_turns && turn_side(&account.sv) == Some(LeftRight::Left)))
                || told(&partner.movement) == Some(Movement::UTurn)
                || cp_turns
                    && turn_side(partner).is_none()
                    && !sv_turns
                    && told(&partner.movement).is_none_or(|movement| movement == Movement::Straight)
                || told(&partner.movement) == Some(Movement::LeftTurn) && !partner.did(Act::Turn) && !sv_turns;
            // Left side on left side they passed each other, and only then it turned, or began to.
            let left = |party: &Party, corner: bool| {
                use recrash_model::zones::ContactZone as Z;
                !party.zones.is_empty()
                    && party
                        .zones
                        .iter()
                        .all(|zone| matches!(zone.value, Z::Left | Z::RearLeft) || corner && zone.value == Z::FrontLeft)
            };
            let begun = partner.acts.iter().any(|fact| fact.act == Act::Turn && fact.begun);
            let abreast = left(&account.sv, true) && left(partner, false) && (begun || partner.did(Act::Pass));
            Some(if across && !abreast {
                (CrashType::Intersection, "one turned across the other")
            } else {
                (CrashType::HeadOn, "from opposite directions")
            })
        }
        // It had turned into the road of the one that stands, and passed it left side on left side.
        Some(Origin::Cross { .. })
            if sv.is_some_and(ContactState::stands)
                && partner.did(Act::Turn)
                && !cp_turns
                && on_left(&account.sv)
                && on_left(partner) =>
        {
            Some((CrashType::HeadOn, "from opposite directions"))
        }
        Some(Origin::Cross { .. }) => Some((CrashType::Intersection, "crossing paths")),
        Some(Origin::Stall { .. } | Origin::Driveway { .. }) => {
            Some((CrashType::Intersection, "out of a stall or a driveway"))
        }
        Some(Origin::Parked { .. }) => Some((CrashType::Lateral, "from the kerb beside it")),
        Some(Origin::Sidewalk { .. }) => Some((CrashType::Intersection, "crossing paths")),
        Some(Origin::Beside { .. }) => {
            let both_turned = account.sv.did(Act::Turn) && partner.did(Act::Turn) || turn_together(account);
            let one_turns = sv_turns != cp_turns && !both_turned;
            if one_turns && !(sv_turns && sv.is_some_and(ContactState::stands)) {
                return Some((CrashType::Intersection, "one turned across the other"));
            }
            if rear(&account.sv) && front(partner) && square(account) && !sideways {
                return Some((CrashType::FrontToRear, "front on rear, one way"));
            }
            Some((CrashType::Lateral, "one way, side by side"))
        }
        Some(Origin::Above) | None => by_columns(reading, account),
    }
}

/// Whether the thing came off a vehicle that drove: "a ladder dropped off the pickup".
fn off_a_vehicle(reading: &Reading<'_>) -> bool {
    let Some(actor) = reading.contacts.partner else { return false };
    let story = &reading.story;
    let vehicle = |word: &str| {
        story.world.actors.iter().skip(1).any(|known| {
            known.kind.is_some_and(Kind::is_vehicle)
                && known.kind_tokens.is_some_and(|(first, end)| {
                    story.tokens[first..end].iter().any(|token| token.text == word && token.text.len() > 2)
                })
        })
    };
    let struck = reading.contacts.first.is_some_and(|first| story.frames[first].who == Some(actor));
    struck
        && reading.before(actor).any(|(number, frame)| {
            let (first, end) = reading.window(number);
            let had = first > 0 && story.tokens[first - 1].text == "had";
            let of_it =
                ["detach", "separat", "broke", "tore"].iter().any(|stem| story.tokens[first].text.starts_with(stem));
            let from = story.tokens[first..end].iter().position(|token| matches!(token.text.as_str(), "from" | "off"));
            frame.act() == Some(Act::Fall)
                && frame.happened()
                && !had
                && !of_it
                && from.is_some_and(|at| story.tokens[first + at..end].iter().take(8).any(|token| vehicle(&token.text)))
        })
}

/// Whether the partner is one of several that collided: "Two vehicles collided. One of them spun into it".
fn of_a_crash(reading: &Reading<'_>) -> bool {
    let (Some(first), Some(partner)) = (reading.contacts.first, reading.contacts.partner) else { return false };
    let group = reading.story.world.actors[partner].group;
    group.is_some()
        && reading.story.frames[..first]
            .iter()
            .any(|frame| frame.is_contact() && frame.who == group && frame.object != Some(crate::world::SUBJECT))
}

/// Whether both go the same way round a corner, in lanes side by side: told as a turn, as a turn to come, or by the lane for it.
fn turn_together(account: &Account) -> bool {
    let way = |party: &Party| {
        let lane = party.lane.as_ref().and_then(|lane| match lane.value {
            LaneWord::LeftTurn => Some(LeftRight::Left),
            LaneWord::RightTurn => Some(LeftRight::Right),
            _ => None,
        });
        let movement = match told(&party.movement) {
            Some(Movement::LeftTurn) => Some(LeftRight::Left),
            Some(Movement::RightTurn) => Some(LeftRight::Right),
            _ => None,
        };
        turn_side(party).or(movement).or(lane)
    };
    let Some(partner) = &account.partner else { return false };
    way(&account.sv).is_some_and(|side| way(partner) == Some(side))
}

pub(crate) fn turn_side(party: &Party) -> Option<LeftRight> {
    party.acts.iter().rev().filter(|fact| !fact.after_contact).find_map(|fact| match fact.act {
        Act::Turn => fact.side,
        Act::UTurn => Some(LeftRight::Left),
        _ => None,
    })
}

/// Touched on the left, corners too.
fn on_left(party: &Party) -> bool {
    use recrash_model::zones::ContactZone as Z;
    !party.zones.is_empty() && party.zones.iter().all(|zone| matches!(zone.value, Z::Left | Z::FrontLeft | Z::RearLeft))
}

/// The plain rear on the plain front.
fn square(account: &Account) -> bool {
    use recrash_model::zones::ContactZone as Z;
    let Some(partner) = &account.partner else { return false };
    has_zone(&account.sv, |zone| zone == Z::Rear) && has_zone(partner, |zone| zone == Z::Front)
        || has_zone(&account.sv, |zone| zone == Z::Rear)
}

fn front_rear(account: &Account) -> bool {
    let Some(partner) = &account.partner else { return false };
    has_zone(&account.sv, |zone| zone.is_front()) && has_zone(partner, |zone| zone.is_rear())
}

fn turned_across(account: &Account) -> bool {
    has_zone(&account.sv, |zone| zone.is_front())
}

fn double_parked(reading: &Reading<'_>) -> bool {
    reading.story.tokens.windows(2).any(|pair| pair[0].text == "double" && pair[1].text == "parked")
}

/// Whether the partner touched somebody, and then went on of its own accord before it came to the subject vehicle.
fn drove_on(reading: &Reading<'_>) -> bool {
    let (Some(first), Some(partner)) = (reading.contacts.first, reading.contacts.partner) else { return false };
    let frames = &reading.story.frames;
    let earlier: Vec<usize> = reading.contacts.earlier.iter().copied().filter(|&number| number < first).collect();
    let struck_others = !earlier.is_empty() && earlier.iter().all(|&number| frames[number].who == Some(partner));
    struck_others
        && frames[earlier[earlier.len() - 1] + 1..first].iter().any(|frame| {
            frame.who == Some(partner)
                && frame.happened()
                && matches!(frame.act(), Some(Act::Follow | Act::Pass | Act::Turn | Act::Enter | Act::SetOff))
        })
}

/// "was involved in a separate collision", told up to the crash.
fn separate(reading: &Reading<'_>) -> bool {
    let end = reading
        .contacts
        .first
        .map_or(usize::MAX, |number| reading.story.sentences[reading.story.frames[number].sentence].end);
    let tokens = &reading.story.tokens[..end.min(reading.story.tokens.len())];
    tokens.windows(2).any(|pair| {
        matches!(pair[0].text.as_str(), "separate" | "previous" | "another")
            && matches!(pair[1].text.as_str(), "collision" | "crash")
    })
}

/// Where nobody tells from where the partner came: by zones and movement columns.
fn by_columns(reading: &Reading<'_>, account: &Account) -> Option<(CrashType, &'static str)> {
    let partner = account.partner.as_ref()?;
    let rule = "zones and movement columns";
    let cp = told(&partner.movement).or_else(|| reading.record.cp_movement.known());
    let sv = told(&account.sv.movement).or_else(|| reading.record.sv_movement.known());
    let turn = |movement| matches!(movement, Some(Movement::LeftTurn | Movement::RightTurn | Movement::UTurn));
    if matches!(
        cp,
        Some(
            Movement::ChangingLanes
                | Movement::Passing
                | Movement::Merging
                | Movement::LaneDeparture
                | Movement::EnteringTraffic
                | Movement::ParkingManeuver
        )
    ) {
        return Some((CrashType::Lateral, rule));
    }
    if matches!(cp, Some(Movement::CrossingIntoOpposingLane | Movement::WrongWay)) {
        return Some((CrashType::HeadOn, rule));
    }
    if turn(cp) || turn(sv) {
        return Some((CrashType::Intersection, rule));
    }
    if matches!(sv, Some(Movement::ChangingLanes | Movement::Merging | Movement::Passing)) {
        return Some((CrashType::Lateral, rule));
    }
    let sides = |party: &Party| !party.zones.is_empty() && !has_zone(party, |zone| zone.is_front() || zone.is_rear());
    if sides(&account.sv)
        && has_zone(partner, |zone| zone.is_front())
        && reading.record.road.known() == Some(recrash_model::template::RoadType::Intersection)
    {
        return Some((CrashType::Intersection, rule));
    }
    if account.sv.zones.is_empty() && partner.zones.is_empty() {
        return None;
    }
    if has_zone(&account.sv, |zone| zone.is_front())
        && has_zone(partner, |zone| !zone.is_front() && !zone.is_rear())
        && reading.record.road.known() == Some(recrash_model::template::RoadType::Intersection)
    {
        return Some((CrashType::Intersection, rule));
    }
    Some((CrashType::Lateral, rule))
}

/// First harmful contact.
pub(crate) fn first_contact(reading: &Reading<'_>, account: &Account) -> Option<Fact<FirstContact>> {
    account.partner.as_ref()?;
    let rule = |value, name: &str| Some(Fact::by_rule(value, name));
    if reading.contacts.others_only {
        return rule(FirstContact::OthersOnly, "contacts of the story");
    }
    let touched_others = reading.contacts.first.is_some_and(|first| {
        let partner = reading.contacts.partner;
        let of_partner = |number: &usize| {
            let frame = &reading.story.frames[*number];
            *number < first && (frame.who == partner || frame.object == partner)
        };
        reading.contacts.earlier.iter().any(of_partner)
    });
    if touched_others || told(&account.crash_type) == Some(CrashType::Secondary) {
        return rule(FirstContact::PartnerAndOther, "contacts of the story");
    }
    if told(&account.crash_type) == Some(CrashType::SingleVehicle) || group(account) == Some(KindGroup::Object) {
        return rule(FirstContact::Object, "a thing, or a vehicle with nobody in it");
    }
    rule(FirstContact::SvAndPartner, "contacts of the story")
}
