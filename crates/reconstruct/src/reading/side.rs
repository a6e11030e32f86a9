//! What is told of one side of the crash.

use crate::reading::acts::is_hard;
use crate::reading::turns::{last_way, leaves_line, turned_before, turned_before_its_stop, went_on_straight};
use crate::reading::{acts, phases, sizes, things, words};
use crate::told::doing::Doing;
use crate::told::phase::Phase;
use crate::told::side::{Side, Slowed, Turning};
use crate::told::sizes::size_of;
use crate::told::speeds::SLOWLY_MPS;
use crate::usual::ROLLING_MPS;
use recrash_model::account::{
    Act, ActFact, ContactState, Control, ControlDevice, Kind, KindGroup, LeftRight, Manner, Obeyed, Party, SignalState,
    Source, SpeedMeaning, Standing, told,
};
use recrash_model::kinds::PartnerKind;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// What is told of one side.
pub(super) fn side(party: &Party, kind: Option<Kind>, assumed: &mut Vec<String>, who: &str) -> Side {
    let kind = kind.or_else(|| told(&party.kind));
    let partner_kind = partner_kind(kind);
    if partner_kind.is_none() && who == "partner" {
        assumed.push("the partner is a passenger car".to_owned());
    }
    let half = Half::of(party, kind, who == "ego");
    let Half { movement, impact_mps, state, state_told, came_to_park, turning, .. } = half;
    if !state_told {
        assumed.push(format!("the {who} is {} at the contact", state.label()));
    }
    let (phases, acts) = (half.phases(), half.acts());
    let stopped_aside = half.stopped_aside();
    let came_mps = half.came_mps();
    let zones = party.zone_values();
    let above_or_below = |zone: &ContactZone| matches!(zone, ContactZone::Top | ContactZone::Bottom);
    Side {
        aside: stopped_aside.and_then(|fact| fact.side).or(half.aside()),
        changed_lanes: matches!(movement, None | Some(Movement::Straight)) && half.has_done(Act::LaneChange),
        merges_in: merges_in(party, movement),
        came_over: came_over(party),
        passes: movement == Some(Movement::ChangingLanes) && half.has_done(Act::Pass),
        goes_round: false,
        returns: returns(party),
        gains: gained_last(party) && half.moves() && !half.stood_first() && phases.is_empty(),
        reacts: false,
        brakes_hard: brakes_hard(party, true),
        came_hard: brakes_hard(party, false),
        rolled_mps: half.rolled_mps().filter(|_| phases.is_empty()),
        slowed_early: slowed_early(party),
        stopped_aside: stopped_aside.map(|fact| fact.act),
        turns_later: false,
        turned: half.has_turned(),
        crossed: acts::has_crossed(party),
        completes: is_completing(party, movement) || acts.iter().any(|doing| doing.within_lane),
        turns_wide: false,
        dodges: false,
        slants: None,
        backs_in: false,
        slowed_from: half.slowed_from(),
        stood_first: half.stood_first(),
        came_to_park,
        came_along: came_along(party),
        came_there: came_there(party),
        rolls_out: rolls_out(party),
        stands_from_start: told(&party.standing) == Some(Standing::FromTheStart),
        phases,
        acts,
        kind: partner_kind.unwrap_or_default(),
        size: kind.and_then(|kind| sizes::told(party, kind).or_else(|| size_of(kind))),
        state,
        state_told,
        movement,
        turning,
        only_above_or_below: !zones.is_empty() && zones.iter().all(above_or_below),
        only_below: !zones.is_empty() && zones.iter().all(|zone| *zone == ContactZone::Bottom),
        zones: zones.into_iter().filter(|zone| !above_or_below(zone)).collect(),
        manner: manner(party),
        impact_mps: impact_mps.or(came_mps),
        came_so: came_mps.is_some(),
        speed_mps: 0.0,
        lane: told(&party.lane),
        astride: told(&party.astride),
        lane_to_come: party.lane.as_ref().is_some_and(|fact| goes_there(&fact.source)),
        control: control(party),
    }
}

/// As what somebody is drawn; a robot of the sidewalk is no vehicle of the road.
fn partner_kind(kind: Option<Kind>) -> Option<PartnerKind> {
    match kind? {
        Kind::DeliveryRobot => Some(PartnerKind::OtherNonMotorist),
        kind => kind.partner_kind(),
    }
}

/// Whether somebody rides on small wheels.
const fn rides(kind: Kind) -> bool {
    matches!(kind, Kind::ScooterRider | Kind::Skateboarder)
}

/// How somebody moves at the contact and came there, by which the rest of its side is read.
struct Half<'a> {
    party: &'a Party,
    kind: Option<Kind>,
    is_ego: bool,
    movement: Option<Movement>,
    /// Told speed at the contact. [m/s]
    impact_mps: Option<f64>,
    state: ContactState,
    state_told: bool,
    /// It is parked at last, and comes to a stop in the story.
    came_to_park: bool,
    turning: Turning,
    /// It stood on its way, by what it did.
    stood: bool,
}

/// A told speed of somebody. [m/s]
fn told_mps(party: &Party, meaning: SpeedMeaning) -> Option<f64> {
    party.speeds.iter().find(|told| told.value.meaning == meaning).map(|told| told.value.mps)
}

impl<'a> Half<'a> {
    /// How somebody moves and came there, by the words, by its movement or by what is usual.
    fn of(party: &'a Party, kind: Option<Kind>, is_ego: bool) -> Self {
        let movement = told(&party.movement);
        let impact_mps = told_mps(party, SpeedMeaning::Impact);
        let thing = kind.is_some_and(|kind| kind.group() == KindGroup::Object);
        let slides = told(&party.state).is_none() && thing && things::slides(party);
        let said = if slides { Some(ContactState::Moving) } else { told(&party.state) };
        let state = said.unwrap_or(match movement {
            Some(Movement::Stopped) => ContactState::Stopped,
            Some(Movement::Parked) => ContactState::Parked,
            Some(Movement::Backing) => ContactState::Reversing,
            _ if impact_mps == Some(0.0) || thing => ContactState::Stopped,
            _ => ContactState::Moving,
        });
        let backs = (movement == Some(Movement::Backing) || parks_backing(party)) && !went_on(party);
        let came_to_park = is_ego && state == ContactState::Parked && came_there(party);
        let state = match state {
            // Who moves backwards moves.
            ContactState::Moving if backs => ContactState::Reversing,
            // Who parks in the story comes to a stop in it.
            _ if came_to_park => ContactState::Stopped,
            state => state,
        };
        let turning = turning(party, movement, is_ego);
        let stood = state == ContactState::Moving && stood_on_its_way(party);
        let state_told = said.is_some();
        Self { party, kind, is_ego, movement, impact_mps, state, state_told, came_to_park, turning, stood }
    }

    /// Whether it drives forwards at the contact.
    fn moves(&self) -> bool {
        self.state == ContactState::Moving
    }

    /// Whether it is told to have done this before the contact, and not only begun to.
    fn has_done(&self, act: Act) -> bool {
        self.party.acts.iter().any(|fact| fact.act == act && !fact.after_contact && !fact.begun)
    }

    /// Whether it stood before it moved: also an ego that left a space.
    fn stood_first(&self) -> bool {
        self.stood || self.is_ego && self.moves() && leaves_space(self.party)
    }

    /// Whether it slowed, since it stood.
    fn slows(&self) -> bool {
        let slows = |fact: &ActFact| matches!(fact.act, Act::Slow | Act::Stop) && !fact.after_contact;
        self.party.acts.iter().any(slows) && (!self.stood || slowed_after_its_stand(self.party))
    }

    /// That it slowed and still moved, and from which speed.
    fn slowed_from(&self) -> Option<Slowed> {
        let came_at = told_mps(self.party, SpeedMeaning::Approach).or_else(|| faster_than(self.party, self.impact_mps));
        let slowed = self.slows() && !gained_last(self.party) && self.moves();
        slowed.then(|| Slowed(came_at.filter(|_| !self.stood)))
    }

    /// "Came up from behind at 23 mph and struck it": who is told to come so fast, and of no change of speed, struck it so fast. [m/s]
    fn came_mps(&self) -> Option<f64> {
        let turns = self.turning != Turning::No;
        let steady = self.moves() && !turns && !self.stood && !self.slows() && !gained_last(self.party);
        told_mps(self.party, SpeedMeaning::Approach).filter(|_| steady && self.impact_mps.is_none())
    }

    /// How fast an ego that stands came before it stopped, where that is slow. [m/s]
    fn rolled_mps(&self) -> Option<f64> {
        let slow = |mps: &f64| (LEAST_ROLLED_MPS..ROLLING_MPS).contains(mps);
        let came_mps = told_mps(self.party, SpeedMeaning::Approach).filter(slow);
        let stops = self.is_ego && self.state == ContactState::Stopped;
        came_mps.or_else(|| rolled_slowly(self.party)).filter(|_| stops)
    }

    /// Whether more than its state is read: of somebody on foot, an animal or a thing that says enough.
    fn drives(&self) -> bool {
        let light = |kind: Kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Animal | KindGroup::Object);
        self.is_ego || self.kind.is_none_or(|kind| rides(kind) || !light(kind))
    }

    /// What it did last, where its state is told.
    fn phases(&self) -> Vec<Phase> {
        match self.state_told && self.state != ContactState::Parked && self.drives() {
            true => phases::told(self.party, self.state),
            false => Vec::new(),
        }
    }

    /// What it did until the contact that can be seen.
    fn acts(&self) -> Vec<Doing> {
        let mut acts = if self.drives() { acts::told(self.party, self.state) } else { Vec::new() };
        if self.kind.is_some_and(rides) {
            // On small wheels it turns at once.
            acts.retain(|doing| !doing.is_turn());
        }
        acts
    }

    /// To which side it left its line: the last before the contact is the one that led to it. Who enters a lane beside its own does so to a side.
    fn aside(&self) -> Option<LeftRight> {
        let leaves = |fact: &&ActFact| (leaves_line(fact.act) || fact.act == Act::Enter) && !fact.after_contact;
        self.party.acts.iter().filter(leaves).filter_map(|fact| fact.side).next_back()
    }

    /// By what an ego that stands left its line before it came to a stop.
    fn stopped_aside(&self) -> Option<&'a ActFact> {
        let stands = self.is_ego && self.state == ContactState::Stopped && self.turning == Turning::No;
        let last = last_way(self.party).filter(|_| stands);
        last.filter(|fact| leaves_line(fact.act) || fact.act == Act::Pass && fact.side.is_some())
    }

    /// Whether its turn was over, or all but over.
    fn has_turned(&self) -> bool {
        let done = || self.party.acts.iter().any(|fact| fact.act == Act::Turn && fact.done);
        let straight = match self.movement {
            Some(Movement::Straight) => true,
            Some(Movement::Stopped) => went_on_straight(self.party),
            _ => false,
        };
        self.turning != Turning::No && (straight || done())
    }
}

/// How somebody turns before the contact.
fn turning(party: &Party, movement: Option<Movement>, is_ego: bool) -> Turning {
    let turned = |side: LeftRight| {
        party.acts.iter().any(|fact| fact.act == Act::Turn && fact.side == Some(side) && !fact.after_contact)
    };
    match movement {
        Some(Movement::LeftTurn) => Turning::Left,
        Some(Movement::RightTurn) => Turning::Right,
        Some(Movement::UTurn) => Turning::Round,
        None if turned(LeftRight::Left) => Turning::Left,
        None if turned(LeftRight::Right) => Turning::Right,
        Some(Movement::Stopped) if is_ego => turned_before_its_stop(party),
        Some(Movement::Straight) if is_ego => turned_before(party),
        _ => Turning::No,
    }
}

/// Whether somebody stood before the contact: where it did something after its stop, or held its place; "was coming to a stop and traveling
/// slowly" tells one thing twice.
fn stood_on_its_way(party: &Party) -> bool {
    let does_more = |stop: &ActFact| {
        let tells_twice = |later: &ActFact| later.act == Act::Follow && is_under_way(stop);
        party.acts.iter().any(|later| !later.after_contact && later.step > stop.step && !tells_twice(later))
    };
    party.acts.iter().any(|fact| {
        let stands = match fact.act {
            Act::Hold | Act::SetOff => true,
            Act::Stop => does_more(fact),
            _ => false,
        };
        stands && !fact.after_contact && !fact.begun
    })
}

/// So much faster than at the contact is more than is usual of who slows. [m/s]
const MUCH_FASTER_MPS: f64 = 4.0;

/// A column's speed where words tell a much lower one at the contact: with that it came, and slowed then. [m/s]
fn faster_than(party: &Party, impact_mps: Option<f64>) -> Option<f64> {
    let at_contact = party.speeds.iter().filter(|fact| fact.value.meaning == SpeedMeaning::Impact);
    let mut column = at_contact.filter(|fact| matches!(fact.source, Source::Column { .. })).map(|fact| fact.value.mps);
    column.next_back().filter(|mps| impact_mps.is_some_and(|impact| *mps > impact + MUCH_FASTER_MPS))
}

/// Whether a stop is told on its way, and not as done: "was coming to a stop", "was stopping".
fn is_under_way(stop: &ActFact) -> bool {
    let text = words::text(&stop.source);
    text.split(|letter: char| !letter.is_alphanumeric()).any(|word| matches!(word, "coming" | "stopping" | "braking"))
}

/// Whether somebody is told to have braked hard since it last set off, or before that.
fn brakes_hard(party: &Party, since: bool) -> bool {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact);
    let set_off = before().filter(|fact| fact.act == Act::SetOff).map(|fact| fact.step).max();
    before().any(|fact| (Some(fact.step) > set_off) == since && is_hard(fact))
}

/// Who is slower than this before its stop stood before that. [m/s]
const LEAST_ROLLED_MPS: f64 = 1.5;

/// Whether somebody is told to have come along slowly before it first stopped: nobody who does is faster than this. [m/s]
fn rolled_slowly(party: &Party) -> Option<f64> {
    let stops = party.acts.iter().position(|fact| fact.act == Act::Stop && !fact.after_contact)?;
    let last = party.acts[..stops].iter().rfind(|fact| fact.act == Act::Follow)?;
    (last.manner == Some(Manner::Slow)).then_some(SLOWLY_MPS.1)
}

/// How fast somebody is told to have driven last, since it stood; who moved slowly where no word of it stands with the last that it did
/// went on so.
fn manner(party: &Party) -> Option<Manner> {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact);
    let stood =
        before().filter(|fact| matches!(fact.act, Act::Stop | Act::Hold) && !fact.begun).map(|fact| fact.step).max();
    let since = before().filter(|fact| Some(fact.step) > stood && !is_hard(fact));
    let last =
        since.filter(|fact| fact.manner.is_some() || fact.act == Act::Accelerate).max_by_key(|fact| fact.step)?;
    last.manner
}

/// Whether the first that is told of somebody is that it came out of a space, or from the kerb: it stood there, and not in a lot that it left.
fn leaves_space(party: &Party) -> bool {
    let first = party.acts.iter().filter(|fact| !fact.after_contact).min_by_key(|fact| fact.step);
    let words = |fact: &ActFact| match &fact.source {
        Source::Words { text, .. } => text.to_lowercase(),
        _ => String::new(),
    };
    let of_lot = |text: String| ["lot", "garage", "driveway"].iter().any(|word| text.contains(word));
    first.is_some_and(|fact| fact.act == Act::PullOut && !fact.begun && !of_lot(words(fact)))
}

/// Whether somebody that came out of a lot or a driveway is told to have come along there, and not to have stood; or not to have stopped before
/// the road.
fn rolls_out(party: &Party) -> bool {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let out = before().find(|fact| fact.act == Act::PullOut).map(|fact| fact.step);
    let stood = before().any(|fact| matches!(fact.act, Act::Stop | Act::Hold | Act::SetOff | Act::Park));
    let came = before().any(|fact| fact.act == Act::Follow && Some(fact.step) < out);
    let no_stop = |fact: &ActFact| fact.act == Act::FailToYield && words::text(&fact.source).contains("stop");
    let ran = before().any(|fact| fact.act == Act::RunStop || no_stop(fact));
    out.is_some() && !stood && (came || ran)
}

/// Whether the first that is told of somebody is that it drove along.
fn came_along(party: &Party) -> bool {
    let first = party.acts.iter().filter(|fact| !fact.after_contact).min_by_key(|fact| fact.step);
    first.is_some_and(|fact| fact.act == Act::Follow)
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

/// Whether somebody who slowed is told to have gone on then, forward or slowly: "slowed behind it, and proceeded forward at a low speed".
fn slowed_early(party: &Party) -> bool {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let slowed = before().filter(|fact| matches!(fact.act, Act::Slow | Act::Stop)).map(|fact| fact.step).max();
    let on = |fact: &ActFact| {
        let forward = || words::text(&fact.source).contains("forward");
        fact.act == Act::Follow && (fact.manner == Some(Manner::Slow) || forward())
    };
    slowed.is_some() && before().any(|fact| Some(fact.step) > slowed && on(fact))
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

/// Whether words tell that somebody goes to a lane: "to enter the turn lane".
fn goes_there(source: &Source) -> bool {
    let goes = |text: &str| ["enter ", "merge ", "move ", "get "].iter().any(|verb| text.starts_with(verb));
    matches!(source, Source::Words { text, .. } if goes(&text.to_lowercase()))
}

/// Whether somebody is told to change lanes "into" something that is no lane with a name, to no side: into the lane of whom it touches.
fn merges_in(party: &Party, movement: Option<Movement>) -> bool {
    let into = |source: &Source| matches!(source, Source::Words { text, .. } if text.to_lowercase().ends_with(" into"));
    let changes = |fact: &&ActFact| fact.act == Act::LaneChange && !fact.after_contact && !fact.begun;
    let last = party.acts.iter().rfind(changes);
    let merges = matches!(movement, Some(Movement::Merging | Movement::ChangingLanes)) && party.lane.is_none();
    merges && last.is_some_and(|fact| fact.side.is_none() && into(&fact.source))
}
