//! Whose move brought it about: rules in an order, the first that says something counts (`docs/models/crash-types.md`).

use super::Reading;
use super::party::has_zone;
use super::striker::{is_fixed, of_zones_alone, struck_who_backed_away};
use super::types::{cp_state, group, sv_state, turn_side, turning};
use crate::lexicon::Sense;
use recrash_model::account::{
    Account, Act, ActFact, ContactState, CrashType, Fact, Kind, KindGroup, LeftRight, Origin, Other, Party,
    RoadFeature, Role, StandReason, Striker, told,
};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone as Z;

/// A crash and who took part in it.
struct Case<'a> {
    reading: &'a Reading<'a>,
    account: &'a Account,
    partner: &'a Party,
    /// State of the subject vehicle.
    state: ContactState,
    striker: Option<Striker>,
    crash_type: Option<CrashType>,
    came_from: Option<Origin>,
    group: Option<KindGroup>,
}

type Said = Option<(Role, &'static str)>;
type Rule = fn(&Case<'_>) -> Said;

const RULES: [Rule; 22] = [
    |case| case.own_door(),
    |case| case.thrown(),
    |case| case.stood(),
    |case| case.gave_way_to_another(),
    |case| case.thing(),
    |case| case.lying_animal(),
    |case| case.other_broke_a_rule(),
    |case| case.went_backwards(),
    |case| case.moved_into_one_that_stood(),
    |case| case.other_came_across_at_a_junction(),
    |case| case.struck(),
    |case| case.turned_across(),
    |case| case.turned_across_who_walks(),
    |case| case.turned_round(),
    |case| case.crossed_from_a_stop(),
    |case| case.stood_within_its_change(),
    |case| case.changed_lanes_into_one_beside(),
    |case| case.changed_lanes_into_one_that_drove_on(),
    |case| case.struck_at_its_rear(),
    |case| case.changed_lanes(),
    |case| case.both_moved_over(),
    |_| Some((Role::Responder, "the other moved into it")),
];

/// Whose move brought it about.
pub(crate) fn role(reading: &Reading<'_>, account: &Account) -> Option<Fact<Role>> {
    let partner = account.partner.as_ref()?;
    let Some(state) = sv_state(account) else { return role_of_other(reading, account) };
    let case = Case {
        reading,
        account,
        partner,
        state,
        striker: told(&account.striker),
        crash_type: told(&account.crash_type),
        came_from: told(&account.came_from),
        group: group(account),
    };
    let (role, name) = RULES.iter().find_map(|rule| rule(&case))?;
    Some(Fact::by_rule(role, name))
}

/// Where nobody tells whether the subject vehicle moved: what the other did may be enough.
fn role_of_other(reading: &Reading<'_>, account: &Account) -> Option<Fact<Role>> {
    let partner = account.partner.as_ref()?;
    let crash_type = told(&account.crash_type);
    let over = partner.did_any(&[Act::LaneChange, Act::Drift, Act::Reverse, Act::Turn])
        || told(&partner.movement) == Some(Movement::CrossingIntoOpposingLane);
    let name = if crash_type == Some(CrashType::Secondary) {
        "a crash ahead or behind came to it"
    } else if group(account) == Some(KindGroup::Object) {
        comes(reading, partner).then_some("something came into its way")?
    } else if told(&account.striker) != Some(Striker::Cp) || !account.sv.acts.is_empty() {
        return None;
    } else if told(&account.came_from) == Some(Origin::Behind) && crash_type == Some(CrashType::FrontToRear) {
        "it came from behind"
    } else if broke_a_rule(partner) || over {
        "the other moved before it"
    } else {
        return None;
    };
    Some(Fact::by_rule(Role::Responder, name))
}

/// Whether all that somebody did up to the contact is among these.
fn did_only(party: &Party, acts: &[Act]) -> bool {
    party.acts.iter().filter(|fact| !fact.after_contact).all(|fact| acts.contains(&fact.act))
}

fn broke_a_rule(partner: &Party) -> bool {
    partner.did_any(&[Act::RunRed, Act::RunStop, Act::FailToYield, Act::WrongWay])
}

/// Whether a thing came into the way: one that is fixed does not, whatever a sentence makes its subject.
fn comes(reading: &Reading<'_>, partner: &Party) -> bool {
    let thrown = || {
        let Some(actor) = reading.contacts.partner else { return false };
        reading.before(actor).any(|(_, frame)| frame.sense == Sense::Push && frame.happened())
    };
    let moved = partner.acts.iter().any(|fact| !fact.after_contact && !fact.act.stands());
    !is_fixed(partner) && (moved || thrown())
}

impl Case<'_> {
    /// Whether the partner made a move of its own.
    fn other_moves(&self) -> bool {
        let moves = [
            Act::LaneChange,
            Act::Turn,
            Act::UTurn,
            Act::Swerve,
            Act::Drift,
            Act::PullOut,
            Act::Reverse,
            Act::Pass,
            Act::OpenDoor,
        ];
        self.partner.did_any(&moves)
    }

    /// Whether it left its lane, or came into one.
    fn changes(&self) -> bool {
        self.account.sv.did_any(&[Act::LaneChange, Act::UTurn, Act::PullOut])
    }

    fn is_across(&self) -> bool {
        matches!(self.came_from, Some(Origin::Cross { .. }))
    }

    fn is_beside(&self) -> bool {
        matches!(self.came_from, Some(Origin::Beside { .. }))
    }

    /// The side of a turn of which only the column tells.
    fn turn_by_column(&self) -> Option<LeftRight> {
        match told(&self.account.sv.movement) {
            Some(Movement::LeftTurn) => Some(LeftRight::Left),
            Some(Movement::RightTurn) => Some(LeftRight::Right),
            _ => None,
        }
    }

    /// Its own door: one that stood open, or that somebody backed into, brought nothing about.
    fn own_door(&self) -> Said {
        if told(&self.account.door) != Some(Striker::Sv) {
            return None;
        }
        let opened = self.account.sv.did(Act::OpenDoor) && self.crash_type != Some(CrashType::Backing);
        Some(if opened { (Role::Initiator, "its door was opened") } else { (Role::Responder, "its door stood open") })
    }

    fn thrown(&self) -> Said {
        let thrown = self.crash_type == Some(CrashType::Secondary);
        thrown.then_some((Role::Responder, "a crash ahead or behind came to it"))
    }

    fn stood(&self) -> Said {
        if !self.state.stands() {
            return None;
        }
        let sv = &self.account.sv;
        let over = sv.acts.iter().filter(|fact| !fact.after_contact).rev().nth(1).map(|fact| fact.act);
        let passed = told(&self.partner.movement) == Some(Movement::Passing);
        Some(if over == Some(Act::LaneChange) && passed && !has_zone(sv, Z::is_rear) {
            (Role::Both, "it stood in a change of lanes")
        } else {
            (Role::Responder, "it stood")
        })
    }

    /// It moved aside for another that came over, and into something that stood there.
    fn gave_way_to_another(&self) -> Said {
        let over = [Act::LaneChange, Act::Drift, Act::Swerve];
        let comes = |fact: &ActFact| !fact.after_contact && (over.contains(&fact.act) || fact.act == Act::Turn);
        let vehicle = |other: &Other| other.kind.value.is_vehicle() && other.acts.iter().any(comes);
        let aside = self.account.sv.did_any(&over);
        let single = self.crash_type == Some(CrashType::SingleVehicle);
        let gave = single && aside && self.account.others.iter().any(vehicle);
        gave.then_some((Role::Responder, "it gave way to another"))
    }

    fn thing(&self) -> Said {
        if self.group != Some(KindGroup::Object) {
            return None;
        }
        let flies = matches!(told(&self.partner.kind), Some(Kind::TreeBranch | Kind::LooseWheel | Kind::Cargo))
            && !self.lay()
            && !self.is_plant();
        Some(if flies || comes(self.reading, self.partner) {
            (Role::Responder, "something came into its way")
        } else {
            (Role::Initiator, "it moved into a thing")
        })
    }

    fn lying_animal(&self) -> Said {
        let lying = self.group == Some(KindGroup::Animal) && self.lay();
        lying.then_some((Role::Initiator, "it moved into an animal that lay there"))
    }

    /// "a bush", "some hedges": what stands where it grows, unless it is told to fall.
    fn is_plant(&self) -> bool {
        const PLANTS: [&str; 9] =
            ["bush", "bushes", "hedge", "hedges", "shrub", "shrubs", "shrubbery", "vegetation", "foliage"];
        let story = &self.reading.story;
        let named = self.reading.contacts.partner.and_then(|partner| story.world.actors[partner].kind_tokens);
        let plant = named.is_some_and(|(first, end)| {
            story.tokens[first..end].iter().any(|token| PLANTS.contains(&token.text.as_str()))
        });
        plant && !self.partner.did(Act::Fall)
    }

    /// Whether the sentence of the contact says that it lay there, or grew.
    fn lay(&self) -> bool {
        let story = &self.reading.story;
        self.reading.contacts.first.is_some_and(|number| {
            let sentence = story.sentences[story.frames[number].sentence];
            let words = &story.tokens[sentence.first..sentence.end];
            let lay = ["motionless", "lying", "laying", "deceased"];
            // "a hedge growing at the wall".
            let grows = ["growing", "overgrown", "extending", "protruding", "overhanging"];
            words.iter().any(|token| lay.contains(&token.text.as_str()) || grows.contains(&token.text.as_str()))
        })
    }

    fn other_broke_a_rule(&self) -> Said {
        let broke = broke_a_rule(self.partner) && !self.account.sv.did(Act::RunRed);
        broke.then_some((Role::Responder, "the other broke a rule"))
    }

    fn went_backwards(&self) -> Said {
        if self.state != ContactState::Reversing {
            return None;
        }
        let both = struck_who_backed_away(self.account) || cp_state(self.account) == Some(ContactState::Reversing);
        Some(if self.striker == Some(Striker::Both) {
            (Role::Both, "both went backwards")
        } else if both {
            (Role::Responder, "it backed away")
        } else {
            (Role::Initiator, "it went backwards")
        })
    }

    fn moved_into_one_that_stood(&self) -> Said {
        let partner = self.partner;
        let stood = cp_state(self.account).is_some_and(ContactState::stands) && !partner.did(Act::OpenDoor);
        // "cut in front of it and braked to a stop".
        let before: Vec<Act> = partner.acts.iter().filter(|fact| !fact.after_contact).map(|fact| fact.act).collect();
        let cut = matches!(before.as_slice(), [.., Act::LaneChange | Act::Swerve, Act::Stop | Act::Slow]);
        let drove_on = told(&self.account.sv.movement) == Some(Movement::Straight);
        (stood && !(cut && drove_on)).then_some((Role::Initiator, "it moved into one that stood"))
    }

    fn other_came_across_at_a_junction(&self) -> Said {
        let own_way = !self.account.sv.did_any(&[Act::Turn, Act::UTurn, Act::LaneChange, Act::PullOut]);
        let across = self.partner.did_any(&[Act::Turn, Act::UTurn, Act::PullOut, Act::Cross]);
        let junction = self.crash_type == Some(CrashType::Intersection);
        (junction && own_way && across).then_some((Role::Responder, "the other turned or came out across its way"))
    }

    /// It moved into the other by the words; what zones alone say of it is not enough to blame it.
    fn struck(&self) -> Said {
        let told_so = self.striker == Some(Striker::Sv) && !of_zones_alone(self.account);
        if !told_so || self.crash_type == Some(CrashType::Other) {
            return None;
        }
        let moves =
            [Act::LaneChange, Act::Drift, Act::Swerve, Act::PullOut, Act::UTurn, Act::Turn, Act::SetOff, Act::Reverse];
        let manoeuvres = self.account.sv.did_any(&moves);
        let on_its_way = [Act::Follow, Act::Pass, Act::Turn, Act::Enter, Act::Slow, Act::Leave];
        let crosses = self.is_across() || matches!(self.came_from, Some(Origin::Sidewalk { .. }));
        let own_way = !manoeuvres && !turning(&self.account.sv) && self.turn_by_column().is_none();
        if crosses && own_way && self.group != Some(KindGroup::Car) {
            return Some((Role::Responder, "the other came across its way"));
        }
        Some(match (self.other_moves(), manoeuvres) {
            (true, false) => (Role::Responder, "the other moved before it"),
            (true, true) if !did_only(self.partner, &on_its_way) => (Role::Both, "both moved"),
            _ => (Role::Initiator, "it moved into the other"),
        })
    }

    fn turned_across(&self) -> Said {
        let opposite = self.came_from == Some(Origin::Opposite);
        let crossing =
            opposite || self.is_across() || self.is_beside() || matches!(self.came_from, Some(Origin::Driveway { .. }));
        if !turning(&self.account.sv) || !crossing || self.crash_type != Some(CrashType::Intersection) {
            return None;
        }
        let partner = self.partner;
        let on_its_way = did_only(partner, &[Act::Follow, Act::Enter, Act::Slow, Act::Cross]);
        let drives_on = !partner.acts.is_empty() || told(&partner.movement) == Some(Movement::Straight);
        if opposite && on_its_way && drives_on {
            return Some((Role::Initiator, "it turned across the way of one who came on"));
        }
        let both_turn = turning(partner) || partner.did(Act::LaneChange);
        let came_to_flank = self.striker == Some(Striker::Cp) && self.is_across();
        Some(if both_turn || self.is_beside() || came_to_flank {
            (Role::Responder, "the other came across")
        } else {
            (Role::Both, "it turned across another's way")
        })
    }

    fn turned_across_who_walks(&self) -> Said {
        let rides = self.group == Some(KindGroup::Motorcycle) && self.came_from == Some(Origin::Opposite);
        let walks = rides || matches!(self.group, Some(KindGroup::OnFoot | KindGroup::Cyclist));
        let straight = matches!(told(&self.partner.movement), Some(Movement::NmCrossing | Movement::Straight));
        let turns = turning(&self.account.sv) || self.turn_by_column().is_some();
        let hooked = turn_side(&self.account.sv).or(self.turn_by_column()).is_some_and(|side| {
            has_zone(&self.account.sv, |zone| match side {
                LeftRight::Left => matches!(zone, Z::Left | Z::FrontLeft | Z::RearLeft),
                LeftRight::Right => matches!(zone, Z::Right | Z::FrontRight | Z::RearRight),
            })
        });
        let met = self.came_from != Some(Origin::Behind) || hooked;
        (walks && turns && straight && !self.other_moves() && met)
            .then_some((Role::Initiator, "it turned across the way of one who went on"))
    }

    fn turned_round(&self) -> Said {
        let turned = self.account.sv.did(Act::UTurn) && !self.other_moves();
        (turned && self.came_from != Some(Origin::Ahead))
            .then_some((Role::Initiator, "it turned round before one that drove on"))
    }

    /// It stood for a sign or for others, and then crossed the way of one who had nothing to stop for.
    fn crossed_from_a_stop(&self) -> Said {
        let (sv, place) = (&self.account.sv, &self.account.place);
        let before: Vec<Act> = sv.acts.iter().filter(|fact| !fact.after_contact).map(|fact| fact.act).collect();
        let stood = before.iter().position(|act| act.stands());
        let went = before.iter().rposition(|act| matches!(act, Act::SetOff | Act::Cross | Act::Enter | Act::Turn));
        let feature = |wanted: RoadFeature| place.features.iter().any(|feature| feature.value == wanted);
        let waits = feature(RoadFeature::StopSign)
            || sv.reasons.iter().any(|reason| matches!(reason.value, StandReason::StopSign | StandReason::Yield));
        let crossed = self.is_across() && stood.zip(went).is_some_and(|(stood, went)| stood < went);
        let other_stops = self.partner.did_any(&[Act::Stop, Act::Hold, Act::SetOff]) || self.ignored_a_stop();
        (crossed && waits && !feature(RoadFeature::Signal) && !other_stops && !self.other_moves())
            .then_some((Role::Initiator, "it crossed from a stop before one that drove on"))
    }

    /// Whether the partner is told not to have stopped, wherever it should have.
    fn ignored_a_stop(&self) -> bool {
        let Some(actor) = self.reading.contacts.partner else { return false };
        self.reading
            .before(actor)
            .any(|(_, frame)| frame.negated && (frame.act() == Some(Act::Stop) || frame.sense == Sense::Yield))
    }

    /// It had come to a stop half over in the next lane, and both went on from there.
    fn stood_within_its_change(&self) -> Said {
        let before: Vec<Act> =
            self.account.sv.acts.iter().filter(|fact| !fact.after_contact).map(|fact| fact.act).collect();
        let half = matches!(before.as_slice(), [.., Act::LaneChange, Act::Stop | Act::Hold, Act::LaneChange]);
        let lateral = self.crash_type == Some(CrashType::Lateral) && self.is_beside();
        (half && lateral && self.striker == Some(Striker::Cp) && !self.other_moves())
            .then_some((Role::Both, "it stood half over, and both went on"))
    }

    fn changed_lanes_into_one_beside(&self) -> Said {
        let sv = &self.account.sv;
        let passes = told(&self.partner.movement) == Some(Movement::Passing) || self.partner.did(Act::Accelerate);
        // Struck at its rear it was there already.
        let beside = self.striker == Some(Striker::Sv) || has_zone(sv, |zone| !zone.is_rear());
        let over = sv.did(Act::LaneChange) && self.is_beside() && self.crash_type == Some(CrashType::Lateral);
        (over && beside && !self.other_moves() && !passes)
            .then_some((Role::Initiator, "it changed lanes into one that drove on"))
    }

    fn changed_lanes_into_one_that_drove_on(&self) -> Said {
        let drove_on = !self.partner.acts.is_empty() && did_only(self.partner, &[Act::Follow, Act::Pass]);
        (self.changes() && drove_on && self.crash_type == Some(CrashType::Lateral))
            .then_some((Role::Initiator, "it changed lanes into one that drove on"))
    }

    fn struck_at_its_rear(&self) -> Said {
        let sv = &self.account.sv;
        let rear_alone = !sv.zones.is_empty() && sv.zones.iter().all(|zone| zone.value.is_rear());
        // Whether its change of lanes was over at a crash from behind, or only begun.
        let last = sv.acts.iter().rfind(|fact| !fact.after_contact);
        let changed_before = self.crash_type == Some(CrashType::FrontToRear)
            && last.is_some_and(|fact| fact.act != Act::LaneChange || fact.begun);
        (self.changes() && rear_alone && (changed_before || self.partner.did(Act::PullOut)))
            .then_some((Role::Responder, "struck at its rear when it had changed lanes, or before"))
    }

    fn changed_lanes(&self) -> Said {
        let junction = self.crash_type == Some(CrashType::Intersection);
        (self.changes() && !junction).then_some((Role::Both, "it changed lanes"))
    }

    fn both_moved_over(&self) -> Said {
        let drifts = self.account.sv.did_any(&[Act::Drift, Act::Swerve]);
        let other_came_over = told(&self.partner.movement) == Some(Movement::CrossingIntoOpposingLane);
        let head_on = self.crash_type == Some(CrashType::HeadOn) && self.other_moves();
        (drifts && self.striker == Some(Striker::Both) && !other_came_over && !head_on)
            .then_some((Role::Both, "both moved over"))
    }
}
