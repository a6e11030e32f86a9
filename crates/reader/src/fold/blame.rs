//! Who moved into whom, whose move brought it about, who was there first: each by a rule over the facts
//! (`docs/models/crash-types.md`).

use super::Reading;
use super::party::has_zone;
use super::types::{cp_state, group, sv_state, turn_side, turning};
use crate::lexicon::Sense;
use crate::world::SUBJECT;
use recrash_model::account::{
    Account, Act, ContactState, CrashType, Fact, Kind, KindGroup, LeftRight, Origin, Party, Role, Source, Striker, told,
};
use recrash_model::narrative::FirstMover;
use recrash_model::template::Movement;

/// Who moved into whom.
pub(crate) fn striker(reading: &Reading<'_>, account: &Account) -> Option<Fact<Striker>> {
    account.partner.as_ref()?;
    let rule = |value, name: &str| Some(Fact::by_rule(value, name));
    if group(account) == Some(KindGroup::Object) {
        let flies = account.partner.as_ref().filter(|partner| !is_fixed(partner)).is_some_and(|partner| {
            partner.did(Act::Fall) || partner.did(Act::Roll) || partner.did(Act::Pushed) || came_down(reading)
        });
        let sv_stands = sv_state(account).is_some_and(ContactState::stands);
        return match (flies, sv_stands) {
            (true, true) => rule(Striker::Cp, "a thing that moves into one that stands"),
            (true, false) if struck_thing(reading) => rule(Striker::Sv, "it struck a thing that came into its way"),
            (true, false) => rule(Striker::Cp, "a thing that moves into one that moves"),
            _ => rule(Striker::Sv, "things do not move"),
        };
    }
    if let Some(door) = &account.door {
        let first = reading.contacts.first.map(|number| &reading.story.frames[number]);
        let by_subject = first.is_some_and(|frame| frame.who == Some(SUBJECT));
        let by_partner = first.is_some_and(|frame| frame.who == reading.contacts.partner && frame.with.is_some());
        if door.value == Striker::Sv && by_subject || door.value == Striker::Cp && by_partner {
            return Some(door.clone());
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
    let meets = frame.sense == Sense::ContactMade
        && reading.story.tokens[frame.first..frame.end.max(frame.first + 2)]
            .iter()
            .any(|token| matches!(token.text.as_str(), "met" | "meet" | "meeting" | "together" | "each"));
    if meets && frame.who.is_none() && !sv_stands && !cp_stands {
        return Some(Fact { value: Striker::Both, source: reading.of(frame) });
    }
    // "Its front corner and that of the van collided".
    let twin = number.checked_sub(1).map(|before| &reading.story.frames[before]).into_iter();
    let twin = twin.chain(reading.story.frames.get(number + 1)).find(|other| {
        other.first == frame.first && other.is_contact() && other.who.is_some() && other.who != frame.who
    });
    let front = |party: &Party| has_zone(party, |zone| zone.is_front());
    let fronts = front(&account.sv) && account.partner.as_ref().is_some_and(front);
    if twin.is_some_and(|other| [other.who, frame.who].contains(&Some(SUBJECT))) && fronts {
        return Some(Fact { value: Striker::Both, source: reading.of(frame) });
    }
    // "It entered, making contact with the front of the other": the front moved into the side.
    let crossing = matches!(told(&account.came_from), Some(Origin::Cross { .. } | Origin::Opposite));
    if let (true, Some(front)) = (crossing, front_on_flank(account)) {
        return rule(front, FRONT_ON_SIDE);
    }
    if let Some(both) = converge(account) {
        return Some(both);
    }
    // Who backs away is met at its front by who comes.
    let alone = frame.who == Some(SUBJECT) && frame.object.is_some();
    let fore = |party: &Party| !party.zones.is_empty() && party.zones.iter().all(|zone| zone.value.is_front());
    if sv == Some(ContactState::Reversing) && fore(&account.sv) && !alone {
        return rule(Striker::Cp, BACKED_AWAY);
    }
    let value = match (frame.who, frame.object) {
        (Some(SUBJECT), _) => {
            // "The rear of the subject vehicle made contact with the front of the car": who moved forward into whom.
            let over = [Act::LaneChange, Act::Drift, Act::Swerve].into_iter().any(|act| account.sv.did(act));
            let plain = has_zone(&account.sv, |zone| zone == recrash_model::zones::ContactZone::Rear);
            let rear = has_zone(&account.sv, |zone| zone.is_rear()) && (plain || !over);
            if rear && sv != Some(ContactState::Reversing) { Striker::Cp } else { Striker::Sv }
        }
        (Some(who), _) if who != SUBJECT => Striker::Cp,
        (None, Some(SUBJECT)) => Striker::Cp,
        (None, Some(_)) => Striker::Sv,
        _ => return by_fronts(account),
    };
    Some(Fact { value, source: reading.of(frame) })
}

/// Whether the words of the contact say that the partner moved there: "the arm came down on it", "the gate swung into it".
fn came_down(reading: &Reading<'_>) -> bool {
    let Some(number) = reading.contacts.first else { return false };
    let frame = &reading.story.frames[number];
    let word = reading.story.tokens[frame.first].text.as_str();
    let moves = [
        "com", "came", "clos", "lower", "land", "fall", "fell", "swing", "swung", "drop", "toppl", "roll", "blew",
        "blow",
    ];
    let moves =
        moves.iter().chain(&["bounc", "flew", "fly", "slid", "tip", "tumbl"]).any(|stem| word.starts_with(stem));
    let comes = !(word.starts_with("com") || word.starts_with("came"))
        || reading.story.tokens[frame.first..frame.end].iter().any(|token| token.text == "down");
    let partner = reading.contacts.partner;
    let kind = partner.and_then(|partner| reading.story.world.actors[partner].kind);
    let wheel = kind == Some(Kind::LooseWheel);
    // "was struck by a ball".
    let struck = (word.starts_with("str") || word.starts_with("hit")) && frame.passive && frame.object == Some(SUBJECT);
    let hurled = struck && kind == Some(Kind::Debris);
    frame.who.is_some() && frame.who == partner && (wheel || hurled || moves && comes)
}

/// Whether the words have the subject vehicle, or a part of it, make contact with the thing.
fn struck_thing(reading: &Reading<'_>) -> bool {
    reading.contacts.first.is_some_and(|number| reading.story.frames[number].who == Some(SUBJECT))
}

fn striker_backed_away(account: &Account) -> bool {
    matches!(&account.striker, Some(Fact { source: Source::Rule { name }, .. }) if name == BACKED_AWAY)
}

/// Rule of a striker who comes to one that backs away.
const BACKED_AWAY: &str = "it backed away from one that came";

/// Whether both moved into each other: corner on corner where paths cross, side on side where one of them turns.
fn converge(account: &Account) -> Option<Fact<Striker>> {
    use recrash_model::zones::ContactZone as Z;
    let partner = account.partner.as_ref()?;
    let moving = |state: Option<ContactState>| state == Some(ContactState::Moving);
    if !moving(sv_state(account)) || !moving(cp_state(account)) {
        return None;
    }
    let told_as = |party: &Party, wanted: fn(Z) -> bool| {
        !party.zones.is_empty() && party.zones.iter().all(|zone| wanted(zone.value) && zone.source.is_told())
    };
    let corner = |zone: Z| matches!(zone, Z::FrontLeft | Z::FrontRight);
    let side = |zone: Z| matches!(zone, Z::Left | Z::Right);
    let over = |party: &Party| [Act::LaneChange, Act::Swerve, Act::Drift].into_iter().any(|act| party.did(act));
    let crossing = matches!(told(&account.came_from), Some(Origin::Cross { .. } | Origin::Opposite));
    let turns = turning(&account.sv) || turning(partner);
    let straight = !over(&account.sv) && !over(partner);
    let halts = !partner.did(Act::RunStop);
    if crossing && straight && halts && told_as(&account.sv, corner) && told_as(partner, corner) {
        return Some(Fact::by_rule(Striker::Both, "corner on corner where paths cross"));
    }
    (turns && straight && told_as(&account.sv, side) && told_as(partner, side))
        .then(|| Fact::by_rule(Striker::Both, "side on side where one of them turns"))
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

/// Whether the sentence of the contact says that it lay there.
fn lay(reading: &Reading<'_>) -> bool {
    reading.contacts.first.is_some_and(|number| {
        let sentence = reading.story.sentences[reading.story.frames[number].sentence];
        let words = &reading.story.tokens[sentence.first..sentence.end];
        words.iter().any(|token| matches!(token.text.as_str(), "motionless" | "lying" | "laying" | "deceased"))
    })
}

/// Things that stay where they are.
fn is_fixed(partner: &Party) -> bool {
    matches!(
        told(&partner.kind),
        Some(Kind::Wall | Kind::Pole | Kind::Curb | Kind::Barrier | Kind::Sign | Kind::Pothole | Kind::Chain)
    )
}

/// Whether a thing came into the way: one that is fixed does not, whatever a sentence makes its subject.
fn comes(reading: &Reading<'_>, partner: &Party) -> bool {
    let thrown = || {
        let Some(actor) = reading.contacts.partner else { return false };
        reading.before(actor).any(|(_, frame)| frame.sense == Sense::Push && frame.happened())
    };
    let moved = partner.acts.iter().any(|fact| !fact.after_contact && !matches!(fact.act, Act::Hold | Act::Stop));
    !is_fixed(partner) && (moved || thrown())
}

/// Where nobody tells whether the subject vehicle moved: what the other did may be enough.
fn role_of_other(reading: &Reading<'_>, account: &Account) -> Option<Fact<Role>> {
    let partner = account.partner.as_ref()?;
    let rule = |name: &str| Some(Fact::by_rule(Role::Responder, name));
    let broke = [Act::RunRed, Act::RunStop, Act::FailToYield, Act::WrongWay].into_iter().any(|act| partner.did(act));
    let over = [Act::LaneChange, Act::Drift, Act::Reverse, Act::Turn].into_iter().any(|act| partner.did(act))
        || told(&partner.movement) == Some(Movement::CrossingIntoOpposingLane);
    if told(&account.crash_type) == Some(CrashType::Secondary) {
        rule("a crash ahead or behind came to it")
    } else if group(account) == Some(KindGroup::Object) {
        if comes(reading, partner) { rule("something came into its way") } else { None }
    } else if told(&account.striker) != Some(Striker::Cp) || !account.sv.acts.is_empty() {
        None
    } else if told(&account.came_from) == Some(Origin::Behind)
        && told(&account.crash_type) == Some(CrashType::FrontToRear)
    {
        rule("it came from behind")
    } else if broke || over {
        rule("the other moved before it")
    } else {
        None
    }
}

/// Whose move brought it about.
pub(crate) fn role(reading: &Reading<'_>, account: &Account) -> Option<Fact<Role>> {
    let partner = account.partner.as_ref()?;
    let rule = |value, name: &str| Some(Fact::by_rule(value, name));
    let Some(sv) = sv_state(account) else { return role_of_other(reading, account) };
    if told(&account.door) == Some(Striker::Sv) {
        // A door that stood open, or that somebody backed into, brought nothing about.
        let opened = account.sv.did(Act::OpenDoor) && told(&account.crash_type) != Some(CrashType::Backing);
        return if opened {
            rule(Role::Initiator, "its door was opened")
        } else {
            rule(Role::Responder, "its door stood open")
        };
    }
    let sv_turns = turning(&account.sv);
    let striker = told(&account.striker);
    if told(&account.crash_type) == Some(CrashType::Secondary) {
        return rule(Role::Responder, "a crash ahead or behind came to it");
    }
    if sv.stands() {
        let over = account.sv.acts.iter().filter(|fact| !fact.after_contact).rev().nth(1).map(|fact| fact.act);
        let passed = told(&partner.movement) == Some(Movement::Passing);
        if over == Some(Act::LaneChange) && passed && !has_zone(&account.sv, |zone| zone.is_rear()) {
            return rule(Role::Both, "it stood in a change of lanes");
        }
        return rule(Role::Responder, "it stood");
    }
    if group(account) == Some(KindGroup::Object) {
        let flies =
            matches!(told(&partner.kind), Some(Kind::TreeBranch | Kind::LooseWheel | Kind::Cargo)) && !lay(reading);
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
        let both = striker_backed_away(account) || cp_state(account) == Some(ContactState::Reversing);
        if striker == Some(Striker::Both) {
            return rule(Role::Both, "both went backwards");
        }
        return if both { rule(Role::Responder, "it backed away") } else { rule(Role::Initiator, "it went backwards") };
    }
    let cp_stands = cp_state(account).is_some_and(ContactState::stands) && !partner.did(Act::OpenDoor);
    // "cut in front of it and braked to a stop".
    let before: Vec<Act> = partner.acts.iter().filter(|fact| !fact.after_contact).map(|fact| fact.act).collect();
    let cut = matches!(before.as_slice(), [.., Act::LaneChange | Act::Swerve, Act::Stop | Act::Slow]);
    let drove_on = told(&account.sv.movement) == Some(Movement::Straight);
    if cp_stands && !(cut && drove_on) {
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
        let manoeuvres =
            [Act::LaneChange, Act::Drift, Act::Swerve, Act::PullOut, Act::UTurn, Act::Turn, Act::SetOff, Act::Reverse]
                .into_iter()
                .any(|act| account.sv.did(act));
        let cp_only_on_its_way =
            partner.acts.iter().filter(|fact| !fact.after_contact).all(|fact| {
                matches!(fact.act, Act::Follow | Act::Pass | Act::Turn | Act::Enter | Act::Slow | Act::Leave)
            });
        let crosses = matches!(told(&account.came_from), Some(Origin::Cross { .. } | Origin::Sidewalk { .. }));
        let own_way = !manoeuvres
            && !sv_turns
            && !matches!(told(&account.sv.movement), Some(Movement::LeftTurn | Movement::RightTurn));
        if crosses && own_way && group(account) != Some(KindGroup::Car) {
            return rule(Role::Responder, "the other came across its way");
        }
        return match (cp_moves, manoeuvres) {
            (true, false) => rule(Role::Responder, "the other moved before it"),
            (true, true) if !cp_only_on_its_way => rule(Role::Both, "both moved"),
            _ => rule(Role::Initiator, "it moved into the other"),
        };
    }
    let crossing = matches!(
        told(&account.came_from),
        Some(Origin::Opposite | Origin::Cross { .. } | Origin::Beside { .. } | Origin::Driveway { .. })
    );
    if sv_turns && crossing && told(&account.crash_type) == Some(CrashType::Intersection) {
        let both_turn = turning(partner) || partner.did(Act::LaneChange);
        let straight_from_turn_lane = matches!(told(&account.came_from), Some(Origin::Beside { .. }));
        let came_to_flank =
            striker == Some(Striker::Cp) && matches!(told(&account.came_from), Some(Origin::Cross { .. }));
        let on_its_way = partner
            .acts
            .iter()
            .filter(|fact| !fact.after_contact)
            .all(|fact| matches!(fact.act, Act::Follow | Act::Enter | Act::Slow | Act::Cross));
        let drives_on = !partner.acts.is_empty() || told(&partner.movement) == Some(Movement::Straight);
        if told(&account.came_from) == Some(Origin::Opposite) && on_its_way && drives_on {
            return rule(Role::Initiator, "it turned across the way of one who came on");
        }
        return if both_turn || straight_from_turn_lane || came_to_flank {
            rule(Role::Responder, "the other came across")
        } else {
            rule(Role::Both, "it turned across another's way")
        };
    }
    let rides = group(account) == Some(KindGroup::Motorcycle) && told(&account.came_from) == Some(Origin::Opposite);
    let walks = rides || matches!(group(account), Some(KindGroup::OnFoot | KindGroup::Cyclist));
    let goes_straight = matches!(told(&partner.movement), Some(Movement::NmCrossing | Movement::Straight));
    let by_column = match told(&account.sv.movement) {
        Some(Movement::LeftTurn) => Some(LeftRight::Left),
        Some(Movement::RightTurn) => Some(LeftRight::Right),
        _ => None,
    };
    let hooked = turn_side(&account.sv).or(by_column).is_some_and(|side| {
        has_zone(&account.sv, |zone| {
            use recrash_model::zones::ContactZone as Z;
            match side {
                LeftRight::Left => matches!(zone, Z::Left | Z::FrontLeft | Z::RearLeft),
                LeftRight::Right => matches!(zone, Z::Right | Z::FrontRight | Z::RearRight),
            }
        })
    });
    let met = told(&account.came_from) != Some(Origin::Behind) || hooked;
    let turns = sv_turns || by_column.is_some();
    if walks && turns && goes_straight && !cp_moves && met {
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
    let cp_drove_on =
        partner.acts.iter().filter(|fact| !fact.after_contact).all(|fact| matches!(fact.act, Act::Follow | Act::Pass));
    if sv_changes && cp_drove_on && told(&account.crash_type) == Some(CrashType::Lateral) && !partner.acts.is_empty() {
        return rule(Role::Initiator, "it changed lanes into one that drove on");
    }
    let rear_alone = !account.sv.zones.is_empty() && account.sv.zones.iter().all(|zone| zone.value.is_rear());
    if sv_changes && rear_alone && (changed_before(account) || partner.did(Act::PullOut)) {
        return rule(Role::Responder, "struck at its rear when it had changed lanes, or before");
    }
    if sv_changes && !matches!(told(&account.crash_type), Some(CrashType::Intersection)) {
        return rule(Role::Both, "it changed lanes");
    }
    let cp_came_over = told(&partner.movement) == Some(Movement::CrossingIntoOpposingLane);
    let head_on = told(&account.crash_type) == Some(CrashType::HeadOn) && cp_moves;
    if sv_drifts && striker == Some(Striker::Both) && !cp_came_over && !head_on {
        return rule(Role::Both, "both moved over");
    }
    rule(Role::Responder, "the other moved into it")
}

/// Whether its change of lanes was over at a crash from behind, or only begun.
fn changed_before(account: &Account) -> bool {
    let last = account.sv.acts.iter().rfind(|fact| !fact.after_contact);
    told(&account.crash_type) == Some(CrashType::FrontToRear)
        && last.is_some_and(|fact| fact.act != Act::LaneChange || fact.begun)
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
        let comes = told(&account.striker) == Some(Striker::Cp);
        return if comes {
            rule(FirstMover::Sv, "a thing moved into its way")
        } else {
            rule(FirstMover::Cp, "things stand")
        };
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
                // Its front comes to one that goes backwards across its way.
                (ContactState::Moving | ContactState::SettingOff, _)
                    if fore(&account.sv) && told(&account.striker) == Some(Striker::Sv) =>
                {
                    FirstMover::Cp
                }
                (ContactState::Reversing, _) if striker_backed_away(account) => FirstMover::Sv,
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
    let under = |party: &Party| party.zones.iter().all(|zone| matches!(zone.value, Z::Bottom | Z::Top));
    let flank = |party: &Party| !under(party) && (side(party) || !has_zone(party, |zone| zone.is_front()));
    if partner.zones.is_empty() && !account.sv.zones.is_empty() {
        let value = if flank(&account.sv) { FirstMover::Sv } else { FirstMover::Cp };
        return rule(value, "whose flank is touched is there first");
    }
    let striker = told(&account.striker);
    let plain_side = |party: &Party| {
        !party.zones.is_empty() && party.zones.iter().all(|zone| matches!(zone.value, Z::Left | Z::Right))
    };
    let thrown = told(&account.crash_type) == Some(CrashType::Secondary);
    let drives = matches!(group(account), Some(KindGroup::Car | KindGroup::Truck));
    if plain_side(&account.sv) && plain_side(partner) && !thrown && drives {
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
