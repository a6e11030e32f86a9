//! What kind of crash it is: type, role, striker, order, first contact. Each by a rule over the facts
//! (`docs/models/crash-types.md`).

use super::Reading;
use super::party::has_zone;
use crate::lexicon::Sense;
use crate::world::SUBJECT;
use recrash_model::account::{
    Account, Act, ContactState, CrashType, Fact, FirstContact, Kind, KindGroup, LeftRight, Origin, Party, Role, Source,
    Striker, told,
};
use recrash_model::narrative::FirstMover;
use recrash_model::template::Movement;

fn group(account: &Account) -> Option<KindGroup> {
    account.partner.as_ref().and_then(|partner| told(&partner.kind)).map(Kind::group)
}

fn sv_state(account: &Account) -> Option<ContactState> {
    told(&account.sv.state)
}

fn cp_state(account: &Account) -> Option<ContactState> {
    account.partner.as_ref().and_then(|partner| told(&partner.state))
}

/// Who moved into whom.
pub(crate) fn striker(reading: &Reading<'_>, account: &Account) -> Option<Fact<Striker>> {
    account.partner.as_ref()?;
    let rule = |value, name: &str| Some(Fact::by_rule(value, name));
    if group(account) == Some(KindGroup::Object) {
        let flies = account
            .partner
            .as_ref()
            .is_some_and(|partner| partner.did(Act::Fall) || partner.did(Act::Roll) || partner.did(Act::Pushed));
        let sv_stands = sv_state(account).is_some_and(ContactState::stands);
        return match (flies, sv_stands) {
            (true, true) => rule(Striker::Cp, "a thing that moves into one that stands"),
            (true, false) => rule(Striker::Both, "a thing that moves into one that moves"),
            _ => rule(Striker::Sv, "things do not move"),
        };
    }
    if let Some(door) = &account.door {
        let first = reading.contacts.first.map(|number| &reading.story.frames[number]);
        let by_subject = first.is_some_and(|frame| frame.who == Some(SUBJECT));
        if door.value == Striker::Sv && by_subject {
            return Some(Fact { value: Striker::Sv, source: door.source.clone() });
        }
    }
    let (sv, cp) = (sv_state(account), cp_state(account));
    let sv_stands = sv.is_some_and(ContactState::stands);
    let cp_stands = cp.is_some_and(ContactState::stands)
        && !account.partner.as_ref().is_some_and(|partner| partner.did(Act::OpenDoor));
    if sv_stands && !cp_stands {
        return rule(Striker::Cp, "one stood");
    }
    if cp_stands && !sv_stands {
        return rule(Striker::Sv, "one stood");
    }
    let Some(number) = reading.contacts.first else { return by_fronts(account) };
    let frame = &reading.story.frames[number];
    // "It entered, making contact with the front of the other": the front moved into the side.
    let crossing = matches!(told(&account.came_from), Some(Origin::Cross { .. } | Origin::Opposite));
    if let (true, Some(front)) = (crossing, front_on_flank(account)) {
        return rule(front, FRONT_ON_SIDE);
    }
    let value = match (frame.who, frame.object) {
        (Some(SUBJECT), _) => {
            // "The rear of the subject vehicle made contact with the front of the car": who moved forward into whom.
            let rear = has_zone(&account.sv, |zone| zone.is_rear());
            if rear && sv != Some(ContactState::Reversing) { Striker::Cp } else { Striker::Sv }
        }
        (Some(who), _) if who != SUBJECT => Striker::Cp,
        (None, Some(SUBJECT)) => Striker::Cp,
        (None, Some(_)) => Striker::Sv,
        _ => return by_fronts(account),
    };
    Some(Fact { value, source: reading.of(frame) })
}

/// Rule of a striker by whose front touches whose side.
const FRONT_ON_SIDE: &str = "the front of one on the side of the other";

/// Whose front alone touches a side that is no corner.
fn front_on_flank(account: &Account) -> Option<Striker> {
    use recrash_model::zones::ContactZone as Z;
    let partner = account.partner.as_ref()?;
    let front = |party: &Party| {
        !party.zones.is_empty()
            && party.zones.iter().all(|zone| zone.value.is_front())
            && has_zone(party, |zone| zone == Z::Front)
    };
    let flank = |party: &Party| {
        !party.zones.is_empty()
            && party.zones.iter().all(|zone| matches!(zone.value, Z::Left | Z::Right | Z::RearLeft | Z::RearRight))
    };
    match (front(&account.sv) && flank(partner), front(partner) && flank(&account.sv)) {
        (true, false) => Some(Striker::Sv),
        (false, true) => Some(Striker::Cp),
        _ => None,
    }
}

/// Rule of a striker of whom the words say nothing.
const BY_FRONTS: &str = "whose front took part";

/// Whose front alone took part moved into the other.
fn by_fronts(account: &Account) -> Option<Fact<Striker>> {
    let partner = account.partner.as_ref()?;
    let over = |party: &Party| {
        [Act::LaneChange, Act::Swerve, Act::Drift].into_iter().any(|act| party.did(act))
            || matches!(
                told(&party.movement),
                Some(Movement::ChangingLanes | Movement::Merging | Movement::LaneDeparture)
            )
    };
    match (over(&account.sv), over(partner)) {
        (true, false) => return Some(Fact::by_rule(Striker::Sv, "who moved over")),
        (false, true) => return Some(Fact::by_rule(Striker::Cp, "who moved over")),
        _ => {}
    }
    let front = |party: &Party| has_zone(party, |zone| zone.is_front());
    let value = match (front(&account.sv), front(partner)) {
        (true, false) => Striker::Sv,
        (false, true) => Striker::Cp,
        _ => return None,
    };
    Some(Fact::by_rule(value, BY_FRONTS))
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
        return Some(if told(&partner.kind) == Some(Kind::Cargo) {
            (CrashType::Other, "cargo")
        } else {
            (CrashType::SingleVehicle, "a thing")
        });
    }
    if !reading.contacts.others_only
        && (partner.did(Act::Pushed)
            || !reading.contacts.earlier.is_empty() && account.others.iter().any(|other| other.touched_partner)
            || separate(reading))
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
                let passing = completed_pass(partner) && !square(account);
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
                || (cp_turns && turn_side(partner) == Some(LeftRight::Left) && !sv_turns)
                || told(&partner.movement) == Some(Movement::UTurn);
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
        Some(Origin::Cross { .. }) => Some((CrashType::Intersection, "crossing paths")),
        Some(Origin::Stall { .. } | Origin::Driveway { .. }) => {
            Some((CrashType::Intersection, "out of a stall or a driveway"))
        }
        Some(Origin::Parked { .. }) => Some((CrashType::Lateral, "from the kerb beside it")),
        Some(Origin::Sidewalk { .. }) => Some((CrashType::Intersection, "crossing paths")),
        Some(Origin::Beside { .. }) => {
            let both_turned = account.sv.did(Act::Turn) && partner.did(Act::Turn);
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

pub(crate) fn turn_side(party: &Party) -> Option<LeftRight> {
    party.acts.iter().rev().filter(|fact| !fact.after_contact).find_map(|fact| match fact.act {
        Act::Turn => fact.side,
        Act::UTurn => Some(LeftRight::Left),
        _ => None,
    })
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

/// It was past the rear: what touched was not its front.
fn completed_pass(partner: &Party) -> bool {
    partner.did(Act::Pass)
        && partner.acts.iter().any(|fact| fact.act == Act::Pass && !fact.begun && !fact.after_contact)
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

/// Whether the sentence of the contact says that it lay there.
fn lay(reading: &Reading<'_>) -> bool {
    reading.contacts.first.is_some_and(|number| {
        let sentence = reading.story.sentences[reading.story.frames[number].sentence];
        let words = &reading.story.tokens[sentence.first..sentence.end];
        words.iter().any(|token| matches!(token.text.as_str(), "motionless" | "lying" | "laying" | "deceased"))
    })
}

/// Whether a thing came into the way: one that is fixed does not, whatever a sentence makes its subject.
fn comes(reading: &Reading<'_>, partner: &Party) -> bool {
    let fixed = matches!(
        told(&partner.kind),
        Some(Kind::Wall | Kind::Pole | Kind::Curb | Kind::Barrier | Kind::Sign | Kind::Pothole | Kind::Chain)
    );
    let thrown = || {
        let Some(actor) = reading.contacts.partner else { return false };
        reading.before(actor).any(|(_, frame)| frame.sense == Sense::Push && frame.happened())
    };
    let moved = partner.acts.iter().any(|fact| !fact.after_contact && !matches!(fact.act, Act::Hold | Act::Stop));
    !fixed && (moved || thrown())
}

/// Whose move brought it about.
pub(crate) fn role(reading: &Reading<'_>, account: &Account) -> Option<Fact<Role>> {
    let partner = account.partner.as_ref()?;
    let rule = |value, name: &str| Some(Fact::by_rule(value, name));
    let sv = sv_state(account)?;
    if told(&account.door) == Some(Striker::Sv) {
        return rule(Role::Initiator, "its door was opened");
    }
    let sv_turns = turning(&account.sv);
    let striker = told(&account.striker);
    if told(&account.crash_type) == Some(CrashType::Secondary) {
        return rule(Role::Responder, "a crash ahead or behind came to it");
    }
    if sv.stands() {
        if sv_turns && matches!(told(&account.crash_type), Some(CrashType::Intersection)) {
            return rule(Role::Both, "it stood across another's way in a turn");
        }
        return rule(Role::Responder, "it stood");
    }
    if group(account) == Some(KindGroup::Object) {
        let flies = matches!(told(&partner.kind), Some(Kind::TreeBranch | Kind::LooseWheel | Kind::Cargo));
        let appears = flies || comes(reading, partner);
        return if appears {
            rule(Role::Responder, "something came into its way")
        } else {
            rule(Role::Initiator, "it moved into a thing")
        };
    }
    if group(account) == Some(KindGroup::Animal) && lay(reading) {
        return rule(Role::Initiator, "it moved into an animal that lay there");
    }
    let broke = [Act::RunRed, Act::RunStop, Act::FailToYield, Act::WrongWay].into_iter().any(|act| partner.did(act));
    if broke && !account.sv.did(Act::RunRed) {
        return rule(Role::Responder, "the other broke a rule");
    }
    if sv == ContactState::Reversing {
        let both = cp_state(account) == Some(ContactState::Reversing);
        return if both { rule(Role::Responder, "it backed away") } else { rule(Role::Initiator, "it went backwards") };
    }
    let cp_stands = cp_state(account).is_some_and(ContactState::stands) && !partner.did(Act::OpenDoor);
    if cp_stands {
        return rule(Role::Initiator, "it moved into one that stood");
    }
    let sv_changes = account.sv.did(Act::LaneChange) || account.sv.did(Act::UTurn) || account.sv.did(Act::PullOut);
    let sv_drifts = account.sv.did(Act::Drift) || account.sv.did(Act::Swerve);
    let cp_moves = [
        Act::LaneChange,
        Act::Turn,
        Act::UTurn,
        Act::Swerve,
        Act::Drift,
        Act::PullOut,
        Act::Reverse,
        Act::Pass,
        Act::OpenDoor,
    ]
    .into_iter()
    .any(|act| partner.did(act));
    let own_way = ![Act::Turn, Act::UTurn, Act::LaneChange, Act::PullOut].into_iter().any(|act| account.sv.did(act));
    let across = [Act::Turn, Act::UTurn, Act::PullOut, Act::Cross].into_iter().any(|act| partner.did(act));
    if told(&account.crash_type) == Some(CrashType::Intersection) && own_way && across {
        return rule(Role::Responder, "the other turned or came out across its way");
    }
    // What zones alone say of it is not enough to blame it.
    let by_zones = matches!(
        &account.striker,
        Some(Fact { source: Source::Rule { name }, .. }) if name == BY_FRONTS || name == FRONT_ON_SIDE
    );
    if striker == Some(Striker::Sv) && !by_zones && told(&account.crash_type) != Some(CrashType::Other) {
        return if cp_moves {
            rule(Role::Both, "both moved")
        } else {
            rule(Role::Initiator, "it moved into the other")
        };
    }
    let crossing = matches!(
        told(&account.came_from),
        Some(Origin::Opposite | Origin::Cross { .. } | Origin::Beside { .. } | Origin::Driveway { .. })
    );
    if sv_turns && crossing && told(&account.crash_type) == Some(CrashType::Intersection) {
        let both_turn = turning(partner) || partner.did(Act::LaneChange);
        let straight_from_turn_lane = matches!(told(&account.came_from), Some(Origin::Beside { .. }));
        return if both_turn || straight_from_turn_lane {
            rule(Role::Responder, "the other came across")
        } else {
            rule(Role::Both, "it turned across another's way")
        };
    }
    let walks = matches!(group(account), Some(KindGroup::OnFoot | KindGroup::Cyclist));
    let goes_straight = matches!(told(&partner.movement), Some(Movement::NmCrossing | Movement::Straight));
    if walks && sv_turns && goes_straight && !cp_moves && told(&account.came_from) != Some(Origin::Behind) {
        return rule(Role::Initiator, "it turned across the way of one who went on");
    }
    if account.sv.did(Act::UTurn) && !cp_moves && told(&account.came_from) != Some(Origin::Ahead) {
        return rule(Role::Initiator, "it turned round before one that drove on");
    }
    if crossed_from_stop(account) && !cp_moves && !ignored_a_stop(reading) {
        return rule(Role::Initiator, "it crossed from a stop before one that drove on");
    }
    let over = account.sv.did(Act::LaneChange) && matches!(told(&account.came_from), Some(Origin::Beside { .. }));
    let passes = told(&partner.movement) == Some(Movement::Passing) || partner.did(Act::Accelerate);
    // Struck at its rear it was there already.
    let beside = striker == Some(Striker::Sv) || has_zone(&account.sv, |zone| !zone.is_rear());
    if over && beside && !cp_moves && !passes && told(&account.crash_type) == Some(CrashType::Lateral) {
        return rule(Role::Initiator, "it changed lanes into one that drove on");
    }
    if sv_changes && !matches!(told(&account.crash_type), Some(CrashType::Intersection)) {
        return rule(Role::Both, "it changed lanes");
    }
    if sv_drifts && striker == Some(Striker::Both) {
        return rule(Role::Both, "both moved over");
    }
    let _ = reading;
    rule(Role::Responder, "the other moved into it")
}

/// Whether the partner is told not to have stopped, wherever it should have.
fn ignored_a_stop(reading: &Reading<'_>) -> bool {
    let Some(actor) = reading.contacts.partner else { return false };
    reading
        .before(actor)
        .any(|(_, frame)| frame.negated && (frame.act() == Some(Act::Stop) || frame.sense == Sense::Yield))
}

/// Whether it stood for a sign or for others, and then crossed the way of one who had nothing to stop for.
fn crossed_from_stop(account: &Account) -> bool {
    let Some(partner) = &account.partner else { return false };
    use recrash_model::account::{RoadFeature, StandReason};
    let before: Vec<Act> = account.sv.acts.iter().filter(|fact| !fact.after_contact).map(|fact| fact.act).collect();
    let stood = before.iter().position(|act| matches!(act, Act::Stop | Act::Hold));
    let went = before.iter().rposition(|act| matches!(act, Act::SetOff | Act::Cross | Act::Enter | Act::Turn));
    let waits = account.place.features.iter().any(|feature| feature.value == RoadFeature::StopSign)
        || account.sv.reasons.iter().any(|reason| matches!(reason.value, StandReason::StopSign | StandReason::Yield));
    let signal = account.place.features.iter().any(|feature| feature.value == RoadFeature::Signal);
    let stops = partner.did(Act::Stop) || partner.did(Act::Hold) || partner.did(Act::SetOff);
    matches!(told(&account.came_from), Some(Origin::Cross { .. }))
        && stood.zip(went).is_some_and(|(stood, went)| stood < went)
        && waits
        && !signal
        && !stops
}

/// Who was at the place of the conflict first.
pub(crate) fn order(account: &Account) -> Option<Fact<FirstMover>> {
    let partner = account.partner.as_ref()?;
    let rule = |value, name: &str| Some(Fact::by_rule(value, name));
    let sv_stands = sv_state(account)?.stands();
    let cp_stands = cp_state(account).is_some_and(ContactState::stands);
    if group(account) == Some(KindGroup::Object) {
        return rule(FirstMover::Cp, "things stand");
    }
    if account.door.as_ref().is_some_and(|door| door.value == Striker::Cp) {
        return rule(FirstMover::Sv, "a door was opened into it");
    }
    match (sv_stands, cp_stands) {
        (true, false) => return rule(FirstMover::Sv, "who stands is there first"),
        (false, true) => return rule(FirstMover::Cp, "who stands is there first"),
        _ => {}
    }
    match told(&account.crash_type)? {
        CrashType::FrontToRear => {
            let lead = has_zone(&account.sv, |zone| zone.is_rear()) && told(&account.came_from) != Some(Origin::Ahead);
            return rule(if lead { FirstMover::Sv } else { FirstMover::Cp }, "who is ahead is there first");
        }
        CrashType::HeadOn => return rule(FirstMover::Both, "they meet"),
        CrashType::Secondary if has_zone(&account.sv, |zone| zone.is_rear()) => {
            return rule(FirstMover::Sv, "who is ahead is there first");
        }
        CrashType::Secondary if told(&account.came_from) == Some(Origin::Ahead) => {
            return rule(FirstMover::Cp, "who is ahead is there first");
        }
        // Who goes backwards comes to the other.
        CrashType::Backing => {
            let rear = |party: &Party| has_zone(party, |zone| zone.is_rear());
            let fore = |party: &Party| has_zone(party, |zone| zone.is_front());
            let value = match (sv_state(account)?, cp_state(account)) {
                // Both go backwards: whose rear comes to the other's front.
                (ContactState::Reversing, Some(ContactState::Reversing)) if fore(&account.sv) && rear(partner) => {
                    FirstMover::Sv
                }
                (ContactState::Reversing, Some(ContactState::Reversing)) if rear(&account.sv) && fore(partner) => {
                    FirstMover::Cp
                }
                (ContactState::Reversing, Some(ContactState::Reversing)) => FirstMover::Both,
                // Its front comes to the side of one that goes backwards.
                (ContactState::Moving | ContactState::SettingOff, _)
                    if fore(&account.sv) && !partner.zones.is_empty() && !rear(partner) && !fore(partner) =>
                {
                    FirstMover::Cp
                }
                (ContactState::Reversing, _) => FirstMover::Cp,
                _ => FirstMover::Sv,
            };
            return rule(value, "who goes backwards comes to the other");
        }
        _ => {}
    }
    // Whose front touches comes later than whose flank is touched.
    let front = |party: &Party| has_zone(party, |zone| zone.is_front());
    // A side that is named with its front corner is a side.
    use recrash_model::zones::ContactZone as Z;
    let side = |party: &Party| {
        has_zone(party, |zone| matches!(zone, Z::Left | Z::Right))
            && party.zones.iter().filter(|zone| zone.value.is_front()).all(|zone| zone.value != Z::Front)
            && party.zones.iter().any(|zone| zone.source.is_told())
    };
    let flank = |party: &Party| !party.zones.is_empty() && (side(party) || !has_zone(party, |zone| zone.is_front()));
    if partner.zones.is_empty() && !account.sv.zones.is_empty() {
        let value = if flank(&account.sv) { FirstMover::Sv } else { FirstMover::Cp };
        return rule(value, "whose flank is touched is there first");
    }
    let striker = told(&account.striker);
    let plain_side = |party: &Party| {
        !party.zones.is_empty() && party.zones.iter().all(|zone| matches!(zone.value, Z::Left | Z::Right))
    };
    let thrown = told(&account.crash_type) == Some(CrashType::Secondary);
    if plain_side(&account.sv) && plain_side(partner) && !thrown {
        return rule(FirstMover::Both, "side on side they converge");
    }
    match (front(&account.sv), flank(&account.sv), front(partner), flank(partner)) {
        (_, true, _, true) if striker == Some(Striker::Cp) => rule(FirstMover::Sv, "the other came to its flank"),
        (_, true, _, true) if striker == Some(Striker::Sv) => rule(FirstMover::Cp, "it came to the other's flank"),
        (_, true, true, _) => rule(FirstMover::Sv, "whose flank is touched is there first"),
        (true, _, _, true) => rule(FirstMover::Cp, "whose flank is touched is there first"),
        _ => rule(FirstMover::Both, "at about the same time"),
    }
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
