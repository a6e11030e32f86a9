//! One side of a crash: what is told of one vehicle, person or thing, in the terms of a staging.

use crate::acts::{self, Doing};
use crate::phases::{self, Phase};
use crate::sizes;
use crate::things;
use recrash_model::account::{
    Act, ActFact, ContactState, Control, ControlDevice, Fact, Kind, KindGroup, LaneWord, LeftRight, Manner, Obeyed,
    Party, SignalState, Source, SpeedMeaning, StandReason, Standing, told,
};
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::Size;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// How somebody turns before the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Turning {
    No,
    Left,
    Right,
    Round,
}

/// That somebody slowed, and from which speed, where told. [m/s]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Slowed(pub(crate) Option<f64>);

/// How somebody who reverses came to be at an angle to the road.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slant {
    /// It had turned, to this side where told, before it stood and reversed; out of the opposite direction, where that is told.
    Stood { side: Option<LeftRight>, oncoming: bool },
    /// It swung aside while it reversed.
    Swung,
}

/// One side of the crash.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Side {
    pub(crate) kind: PartnerKind,
    pub(crate) size: Option<Size>,
    pub(crate) state: ContactState,
    /// It stood before it moved, where told.
    pub(crate) stood_first: bool,
    /// It stood already when the story begins.
    pub(crate) stands_from_start: bool,
    /// It is parked, and is told to have come there.
    pub(crate) came_to_park: bool,
    /// It came to a stop before the last that it did.
    pub(crate) came_there: bool,
    /// Speed on the way there, of who is told to have slowed before the contact and still moved. [m/s]
    pub(crate) slowed_from: Option<Slowed>,
    /// It brakes, or swerves, for the turn that the other has begun: late and hard.
    pub(crate) reacts: bool,
    /// It is told to have gained speed while it drove, and to be under way at the contact.
    pub(crate) gains: bool,
    /// What it did last, ended by what it does at the contact, where that is more than the state says: of the ego.
    pub(crate) phases: Vec<Phase>,
    /// Everything that it is told to have done until the contact and that can be seen, in order.
    pub(crate) acts: Vec<Doing>,
    /// Whether the state is told.
    pub(crate) state_told: bool,
    pub(crate) movement: Option<Movement>,
    pub(crate) turning: Turning,
    /// It goes to turn where the other one it runs into turns or stands: it may have begun to.
    pub(crate) turns_later: bool,
    /// Its turn was over, or all but over.
    pub(crate) turned: bool,
    /// It was completing a lane change.
    pub(crate) completes: bool,
    /// It turns all the way into the road that the other is on, to meet it head-on.
    pub(crate) turns_wide: bool,
    /// To which side it moves out of its line, where told.
    pub(crate) aside: Option<LeftRight>,
    /// By what it left its line, where it did so before it came to a stop.
    pub(crate) stopped_aside: Option<Act>,
    /// It changed lanes on its way, and goes straight on since.
    pub(crate) changed_lanes: bool,
    /// It is told to merge into a lane that is no other than the one where they touch.
    pub(crate) merges_in: bool,
    /// It changed lanes on its way to its first stop: to this side, where told.
    pub(crate) came_over: Option<Option<LeftRight>>,
    /// It changed lanes to pass.
    pub(crate) passes: bool,
    /// It goes round the other one, on the side to which it leaves its line.
    pub(crate) goes_round: bool,
    /// It changed lanes, and goes back to the lane that it left.
    pub(crate) returns: bool,
    /// It is told to have dodged or drifted that way while it drove on.
    pub(crate) dodges: bool,
    /// It backs into a space at the kerb.
    pub(crate) backs_in: bool,
    /// It reverses, and is told to have been at an angle to the road.
    pub(crate) slants: Option<Slant>,
    pub(crate) zones: Vec<ContactZone>,
    /// It was touched on its roof or from below, and nowhere else.
    pub(crate) only_above_or_below: bool,
    /// Touched at its underside, and nowhere else.
    pub(crate) only_below: bool,
    /// How fast it is told to have driven last.
    pub(crate) manner: Option<Manner>,
    /// Speed at the contact, where told. [m/s]
    pub(crate) impact_mps: Option<f64>,
    /// Speed at the contact that is staged. [m/s]
    pub(crate) speed_mps: f64,
    pub(crate) lane: Option<LaneWord>,
    /// The signal or sign in front of it, where told.
    pub(crate) control: Option<Control>,
}

impl Side {
    /// Whether it parks, or comes from the kerb or out of a stall.
    pub(crate) fn is_slow(&self) -> bool {
        matches!(self.movement, Some(Movement::EnteringTraffic | Movement::ParkingManeuver))
    }

    /// Whether it is told to have come into a junction.
    pub(crate) fn enters(&self) -> bool {
        self.acts.iter().any(Doing::is_entry)
    }

    /// To which side it passed last, or was about to.
    pub(crate) fn passes_on(&self) -> Option<LeftRight> {
        self.acts.iter().rev().find_map(Doing::passes_on)
    }
}

/// What is told of one side.
pub(crate) fn side(party: &Party, kind: Option<Kind>, assumed: &mut Vec<String>, who: &str) -> Side {
    let kind = kind.or_else(|| told(&party.kind));
    let partner_kind = kind.and_then(Kind::partner_kind);
    if partner_kind.is_none() && who == "partner" {
        assumed.push("the partner is a passenger car".to_owned());
    }
    let movement = told(&party.movement);
    let impact_mps =
        party.speeds.iter().find(|speed| speed.value.meaning == SpeedMeaning::Impact).map(|speed| speed.value.mps);
    let state = told(&party.state);
    let slides = state.is_none() && kind.is_some_and(|kind| kind.group() == KindGroup::Object) && things::slides(party);
    let state = if slides { Some(ContactState::Moving) } else { state };
    let state_told = state.is_some();
    let state = state.unwrap_or_else(|| match movement {
        Some(Movement::Stopped) => ContactState::Stopped,
        Some(Movement::Parked) => ContactState::Parked,
        Some(Movement::Backing) => ContactState::Reversing,
        _ if impact_mps == Some(0.0) => ContactState::Stopped,
        _ if kind.is_some_and(|kind| kind.group() == KindGroup::Object) => ContactState::Stopped,
        _ => ContactState::Moving,
    });
    // Who moves backwards moves.
    let backs = state == ContactState::Moving
        && (movement == Some(Movement::Backing) || parks_backing(party))
        && !went_on(party);
    let state = if backs { ContactState::Reversing } else { state };
    // Who parks in the story comes to a stop in it.
    let came_to_park = who == "ego" && state == ContactState::Parked && came_there(party);
    let state = if came_to_park { ContactState::Stopped } else { state };
    if !state_told {
        assumed.push(format!("the {who} is {} at the contact", state.label()));
    }
    let turned = |side: LeftRight| {
        party.acts.iter().any(|fact| fact.act == Act::Turn && fact.side == Some(side) && !fact.after_contact)
    };
    let turning = match movement {
        Some(Movement::LeftTurn) => Turning::Left,
        Some(Movement::RightTurn) => Turning::Right,
        Some(Movement::UTurn) => Turning::Round,
        None if turned(LeftRight::Left) => Turning::Left,
        None if turned(LeftRight::Right) => Turning::Right,
        Some(Movement::Stopped) if who == "ego" => turned_before_its_stop(party),
        Some(Movement::Straight) if who == "ego" => turned_before(party),
        _ => Turning::No,
    };
    // The last before the contact is the one that led to it. Who enters a lane beside its own does so to a side.
    let aside = party
        .acts
        .iter()
        .filter(|fact| (leaves_line(fact.act) || fact.act == Act::Enter) && !fact.after_contact)
        .filter_map(|fact| fact.side)
        .next_back();
    // It stood where it did something after it, or held its place.
    let last = party.acts.iter().filter(|fact| !fact.after_contact).map(|fact| fact.step).max();
    let stood_first = state == ContactState::Moving
        && party.acts.iter().any(|fact| {
            let stands = match fact.act {
                Act::Hold | Act::SetOff => true,
                Act::Stop => Some(fact.step) < last,
                _ => false,
            };
            stands && !fact.after_contact && !fact.begun
        });
    let slows = party.acts.iter().any(|fact| matches!(fact.act, Act::Slow | Act::Stop) && !fact.after_contact);
    let slows = slows && (!stood_first || slowed_after_its_stand(party));
    let slowed_from = (slows && !gained_last(party) && state == ContactState::Moving).then(|| {
        let approach = party.speeds.iter().find(|speed| speed.value.meaning == SpeedMeaning::Approach);
        Slowed(approach.map(|speed| speed.value.mps).filter(|_| !stood_first))
    });
    // Of somebody on foot, an animal or a thing the state says enough.
    let rides = |kind: Kind| matches!(kind, Kind::ScooterRider | Kind::Skateboarder);
    let drives = kind.is_none_or(|kind| {
        rides(kind) || !matches!(kind.group(), KindGroup::OnFoot | KindGroup::Animal | KindGroup::Object)
    });
    let phases = match state_told && state != ContactState::Parked && (drives || who == "ego") {
        true => phases::told(party, state),
        false => Vec::new(),
    };
    let mut acts = if drives || who == "ego" { acts::told(party, state) } else { Vec::new() };
    if kind.is_some_and(rides) {
        // On small wheels it turns at once.
        acts.retain(|doing| !doing.is_turn());
    }
    let stopped = last_way(party).filter(|_| state == ContactState::Stopped && turning == Turning::No && who == "ego");
    let stopped_aside = stopped.filter(|fact| leaves_line(fact.act) || fact.act == Act::Pass && fact.side.is_some());
    let aside = stopped_aside.and_then(|fact| fact.side).or(aside);
    let stopped_aside = stopped_aside.map(|fact| fact.act);
    let gains = gained_last(party) && state == ContactState::Moving && !stood_first && phases.is_empty();
    let changed_lanes = matches!(movement, None | Some(Movement::Straight))
        && party.acts.iter().any(|fact| fact.act == Act::LaneChange && !fact.after_contact && !fact.begun);
    let passes = movement == Some(Movement::ChangingLanes)
        && party.acts.iter().any(|fact| fact.act == Act::Pass && !fact.after_contact && !fact.begun);
    Side {
        aside,
        changed_lanes,
        merges_in: merges_in(party, movement),
        came_over: came_over(party),
        passes,
        goes_round: false,
        returns: returns(party),
        gains,
        reacts: false,
        stopped_aside,
        turns_later: false,
        turned: turning != Turning::No
            && (party.acts.iter().any(|fact| fact.act == Act::Turn && fact.done)
                || movement == Some(Movement::Straight)
                || movement == Some(Movement::Stopped) && went_on_straight(party)),
        completes: is_completing(party, movement),
        turns_wide: false,
        dodges: false,
        slants: None,
        backs_in: false,
        slowed_from,
        stood_first,
        came_to_park,
        came_there: came_there(party),
        stands_from_start: told(&party.standing) == Some(Standing::FromTheStart),
        phases,
        acts,
        kind: partner_kind.unwrap_or_default(),
        size: kind.and_then(|kind| sizes::told(party, kind).or_else(|| size_of(kind))),
        state,
        state_told,
        movement,
        turning,
        only_above_or_below: !party.zones.is_empty()
            && party.zone_values().iter().all(|zone| matches!(zone, ContactZone::Top | ContactZone::Bottom)),
        only_below: !party.zones.is_empty() && party.zone_values().iter().all(|zone| *zone == ContactZone::Bottom),
        zones: party
            .zone_values()
            .into_iter()
            .filter(|z| !matches!(z, ContactZone::Top | ContactZone::Bottom))
            .collect(),
        manner: manner(party),
        impact_mps,
        speed_mps: 0.0,
        lane: told(&party.lane),
        control: control(party),
    }
}

/// How fast somebody is told to have driven last, since it stood; who moved slowly where no word of it stands with the last that it did
/// went on so.
fn manner(party: &Party) -> Option<Manner> {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact);
    let stood =
        before().filter(|fact| matches!(fact.act, Act::Stop | Act::Hold) && !fact.begun).map(|fact| fact.step).max();
    let since = before().filter(|fact| Some(fact.step) > stood);
    let last =
        since.filter(|fact| fact.manner.is_some() || fact.act == Act::Accelerate).max_by_key(|fact| fact.step)?;
    last.manner
}

/// Whether the first that is told of somebody who is parked is how it came there.
fn came_there(party: &Party) -> bool {
    let stands = |fact: &&ActFact| {
        matches!(fact.act, Act::Stop | Act::PullOver | Act::Hold | Act::Park) && !fact.after_contact && !fact.begun
    };
    let first = party.acts.iter().filter(stands).min_by_key(|fact| fact.step);
    first.is_some_and(|fact| matches!(fact.act, Act::Stop | Act::PullOver))
}

/// To which side somebody changed lanes before it first stood; who passed on one side came back to the other.
fn came_over(party: &Party) -> Option<Option<LeftRight>> {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let stands = before().filter(|fact| matches!(fact.act, Act::Stop | Act::Hold)).map(|fact| fact.step).min()?;
    let last =
        before().filter(|fact| fact.act == Act::LaneChange && fact.step < stands).max_by_key(|fact| fact.step)?;
    let passed = before().filter(|fact| fact.act == Act::Pass && fact.step < last.step).find_map(|fact| fact.side);
    Some(last.side.or(passed.map(LeftRight::other)))
}

/// Whether the last two lane changes before the contact that are told of somebody go to opposite sides.
fn returns(party: &Party) -> bool {
    let changes = party.acts.iter().filter(|fact| fact.act == Act::LaneChange && !fact.after_contact);
    let sides: Vec<LeftRight> = changes.filter_map(|fact| fact.side).collect();
    matches!(sides.as_slice(), [.., before, last] if before != last)
}

/// Whether somebody is told to have been completing a lane change.
fn is_completing(party: &Party, movement: Option<Movement>) -> bool {
    let changes = matches!(movement, Some(Movement::ChangingLanes | Movement::Merging));
    let last = party.acts.iter().rfind(|fact| fact.act == Act::LaneChange && !fact.after_contact && !fact.begun);
    changes && last.is_some_and(|fact| fact.done)
}

/// Whether somebody who stood and set off is told to have slowed after it.
fn slowed_after_its_stand(party: &Party) -> bool {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let last = before().map(|fact| fact.step).max();
    // Who moves at the contact had not come to a stop that is told last.
    let reached = |fact: &ActFact| matches!(fact.act, Act::Hold | Act::SetOff | Act::Stop) && Some(fact.step) < last;
    let stood = before().filter(|fact| reached(fact)).map(|fact| fact.step).max();
    before().filter(|fact| matches!(fact.act, Act::Slow | Act::Stop)).map(|fact| fact.step).max() > stood
}

/// Whether the last that is told of somebody is that it reversed, and parked.
fn parks_backing(party: &Party) -> bool {
    let acts: Vec<Act> = party.acts.iter().filter(|fact| !fact.after_contact).map(|fact| fact.act).collect();
    acts.ends_with(&[Act::Reverse, Act::Park])
}

/// Whether somebody is told to have driven on, forwards, after it had backed.
fn went_on(party: &Party) -> bool {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let backed = before().filter(|fact| fact.act == Act::Reverse).map(|fact| fact.step).max();
    let goes = |act: Act| matches!(act, Act::Enter | Act::Cross | Act::Pass);
    backed.is_some_and(|backed| before().any(|fact| fact.step > backed && goes(fact.act)))
}

/// Whether the last change of speed before the contact that is told is a gain.
fn gained_last(party: &Party) -> bool {
    let changes = |fact: &&ActFact| {
        matches!(fact.act, Act::Accelerate | Act::Slow | Act::Stop) && !fact.after_contact && !fact.begun
    };
    party.acts.iter().rfind(changes).is_some_and(|fact| fact.act == Act::Accelerate)
}

/// Whether somebody who does this leaves the line that it drives on, without a turn.
fn leaves_line(act: Act) -> bool {
    matches!(act, Act::LaneChange | Act::Drift | Act::Swerve | Act::PullOut | Act::PullOver | Act::Park)
}

/// What somebody who came to a stop did last before it, of what tells its way.
fn last_way(party: &Party) -> Option<&ActFact> {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let last_stop = before().filter(|fact| matches!(fact.act, Act::Stop | Act::Hold)).map(|fact| fact.step).max();
    let stopping = told(&party.standing) == Some(Standing::Stopping);
    let stood = if stopping { u32::MAX } else { last_stop? };
    let goes_on = |fact: &ActFact| match (&fact.source, fact.act) {
        // "advanced", in its turn.
        (Source::Words { text, .. }, Act::Follow) => text.to_lowercase().starts_with("travel"),
        (_, act) => {
            leaves_line(act)
                || matches!(act, Act::Pass | Act::Turn | Act::UTurn | Act::Enter | Act::Reverse | Act::Follow)
        }
    };
    let goes_on = |fact: &ActFact| goes_on(fact) && !(stopping && fact.act == Act::Park);
    let came = stopping || told(&party.standing) == Some(Standing::CameToStop);
    // A way from a stop that it had made to the next was driven, also where it was only begun.
    let first_stop = before().filter(|fact| matches!(fact.act, Act::Stop | Act::Hold)).map(|fact| fact.step).min();
    let begun = |fact: &&ActFact| {
        let between = first_stop.is_some_and(|first| first < fact.step) && fact.step < stood;
        fact.begun && !fact.after_contact && leaves_line(fact.act) && between && stops_after(party, fact.step)
    };
    // Whom it had passed when it came back it passed before that.
    let earlier = |fact: &ActFact| fact.act == Act::Pass && fact.done && fact.side.is_none();
    let way = |fact: &&ActFact| came && fact.step < stood && goes_on(fact) && !earlier(fact);
    before().filter(way).chain(party.acts.iter().filter(begun)).max_by_key(|fact| fact.step)
}

/// Whether the next that is told of somebody's stands behind a step is that it came to a stop.
fn stops_after(party: &Party, step: u32) -> bool {
    let stands = |fact: &&ActFact| {
        matches!(fact.act, Act::Stop | Act::Hold) && !fact.after_contact && !fact.begun && fact.step > step
    };
    party.acts.iter().filter(stands).min_by_key(|fact| fact.step).is_some_and(|fact| fact.act == Act::Stop)
}

/// The turn that somebody had begun or done before it came to a stop. Who stops at a light or a sign has yet to turn.
fn turned_before_its_stop(party: &Party) -> Turning {
    let entered = party.acts.iter().any(|fact| fact.act == Act::Enter && !fact.after_contact && !fact.begun);
    let at_line = |fact: &Fact<StandReason>| matches!(fact.value, StandReason::RedLight | StandReason::StopSign);
    let waits = party.reasons.iter().any(at_line) && !entered;
    let last = last_way(party).filter(|_| !waits);
    match last.filter(|fact| fact.act == Act::Turn).and_then(|fact| fact.side) {
        Some(LeftRight::Left) => Turning::Left,
        Some(LeftRight::Right) => Turning::Right,
        // It went straight on since.
        None if last.is_some_and(|fact| matches!(fact.act, Act::Follow | Act::Enter)) => turned_before(party),
        None => Turning::No,
    }
}

/// Whether somebody who came to a stop had turned, and gone straight on since.
fn went_on_straight(party: &Party) -> bool {
    last_way(party).is_some_and(|fact| matches!(fact.act, Act::Follow | Act::Enter))
}

/// The turn that somebody who goes straight on since had done before.
fn turned_before(party: &Party) -> Turning {
    let turn = |fact: &&ActFact| fact.act == Act::Turn && !fact.after_contact && !fact.begun;
    let stands = |fact: &ActFact| matches!(fact.act, Act::Stop | Act::Hold) && !fact.after_contact;
    let turn = party.acts.iter().find(turn).filter(|turn| {
        party.controls.is_empty() && !party.acts.iter().any(|fact| stands(fact) && fact.step <= turn.step)
    });
    match turn.and_then(|fact| fact.side) {
        Some(LeftRight::Left) => Turning::Left,
        Some(LeftRight::Right) => Turning::Right,
        None => Turning::No,
    }
}

/// The signal or sign in front of somebody; who is told to have run one had one.
fn control(party: &Party) -> Option<Control> {
    let ran = |device, state| Some(Control { device, state, obeyed: Some(Obeyed::No) });
    if party.did(Act::RunRed) {
        return ran(ControlDevice::Signal, Some(SignalState::Red));
    }
    if party.did(Act::RunStop) {
        return ran(ControlDevice::StopSign, None);
    }
    // What is said last is nearest to the contact.
    party.controls.last().map(|fact| fact.value)
}

/// Sizes of kinds that are longer or shorter than the group they belong to; usual ones, assumed. [m]
pub(crate) fn size_of(kind: Kind) -> Option<Size> {
    let size = |length_m: f64, width_m: f64| Some(Size { length_m, width_m });
    match kind {
        Kind::SemiTrailerTruck => size(16.0, 2.6),
        Kind::BoxTruck | Kind::FoodTruck => size(7.5, 2.4),
        Kind::PickupWithTrailer => size(11.0, 2.1),
        Kind::Ambulance => size(6.8, 2.3),
        Kind::FireTruck => size(10.0, 2.5),
        Kind::Tram => size(22.0, 2.6),
        Kind::Forklift => size(3.0, 1.2),
        Kind::ConstructionVehicle => size(6.0, 2.4),
        Kind::PoliceCar | Kind::FirstResponder => size(4.9, 2.0),
        Kind::Trailer => size(5.0, 2.2),
        Kind::DeliveryRobot | Kind::Cart | Kind::Scooter => size(0.8, 0.6),
        Kind::Wall | Kind::Curb => size(6.0, 0.3),
        Kind::Gate | Kind::Chain | Kind::Barrier => size(0.2, 4.0),
        Kind::Pole | Kind::Sign | Kind::Cone => size(0.3, 0.3),
        Kind::Debris | Kind::LooseWheel | Kind::TreeBranch | Kind::Cargo | Kind::Object | Kind::Pothole => {
            size(0.6, 0.6)
        }
        _ => None,
    }
}

/// Whether somebody is told to change lanes "into" something that is no lane with a name, to no side: into the lane of whom it touches.
fn merges_in(party: &Party, movement: Option<Movement>) -> bool {
    let into = |source: &Source| matches!(source, Source::Words { text, .. } if text.to_lowercase().ends_with(" into"));
    let changes = |fact: &&ActFact| fact.act == Act::LaneChange && !fact.after_contact && !fact.begun;
    let last = party.acts.iter().rfind(changes);
    let merges = matches!(movement, Some(Movement::Merging | Movement::ChangingLanes)) && party.lane.is_none();
    merges && last.is_some_and(|fact| fact.side.is_none() && into(&fact.source))
}
