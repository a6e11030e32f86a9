//! Others than the two: who is told of besides them, and what they are to the ego.

use crate::ground::LANE_M;
use crate::near::Near;
use crate::phases::Phase;
pub(crate) use crate::role::{Extra, Role};
use crate::side::Turning;
use crate::told::{Aside, Told};
use crate::touch::side_of;
use recrash_model::account::{
    Account, Act, ActFact, ContactState, Fact, Kind, KindGroup, LeftRight, Origin, Other, PlaceKind, SignalState,
    Source, StandReason,
};
use recrash_model::rollout::{EventKind, Rollout};
use recrash_model::template::Movement;

/// Who is named no farther behind the words that the ego slowed or stood is whom it did so for; of who is on foot, and of animals, nor
/// farther before them. [byte]
const NAMED_WITHIN: usize = 70;
const NAMED_BEFORE: usize = 160;

/// Who is named no farther behind the words that the ego passed is whom it passed. [byte]
const PASSES_WITHIN: usize = 12;

/// Those to whom an ego gives way.
pub(crate) const GIVEN_WAY: [Role; 8] =
    [Role::Walker, Role::Animal, Role::Crosser, Role::Oncoming, Role::Lead, Role::Merger, Role::Backer, Role::Blocker];

/// Things in the way, by their words.
const THINGS: [(&str, Kind); 9] = [
    ("debris", Kind::Debris),
    ("shrub", Kind::TreeBranch),
    ("tree", Kind::TreeBranch),
    ("object", Kind::Object),
    ("cone", Kind::Cone),
    ("barricade", Kind::Cone),
    ("construction", Kind::Cone),
    ("fencing", Kind::Barrier),
    ("gate", Kind::Gate),
];

/// Why the ego stood. A crossing where nobody else is told of is nobody that it stood for, and the partner is not one of the others.
pub(crate) fn reasons(account: &Account, origin: Origin) -> Vec<StandReason> {
    let story = Story { account };
    let any = |of: fn(Kind) -> bool| account.others.iter().any(|other| of(other.kind.value) && story.is_met(other));
    let said = |reason: StandReason| account.sv.reasons.iter().any(|fact| fact.value == reason);
    let told = account.sv.reasons.iter().map(|fact| fact.value);
    // Where nobody else is named, it gave way to a partner that does not come from behind, or did what a queue, a light or a sign asks.
    let somebody = account.others.iter().any(|other| story.is_near(other) && !is_parked(other));
    let explained = origin != Origin::Behind
        || [StandReason::Queue, StandReason::RedLight, StandReason::StopSign].into_iter().any(said);
    // Whom it yields to is the partner, which nobody told to stand ahead.
    let yields = |fact: &&Fact<StandReason>| fact.value == StandReason::Yield;
    let yielded = account.sv.reasons.iter().find(yields).and_then(|fact| span(&fact.source));
    let leads = |fact: &Fact<StandReason>| {
        let partner = !matches!(origin, Origin::Behind | Origin::Ahead) && span(&fact.source) == yielded;
        fact.value == StandReason::LeadVehicle && (yielded.is_none() || somebody || !partner)
    };
    let leads = account.sv.reasons.iter().any(leads);
    // "A construction worker" is somebody, and a construction truck is whom it stands behind.
    let works = said(StandReason::LeadVehicle) || said(StandReason::Pedestrian) && any(is_on_foot);
    told.filter(|reason| match reason {
        StandReason::Pedestrian => any(is_on_foot),
        StandReason::Animal => any(|kind| kind.group() == KindGroup::Animal),
        StandReason::Yield => somebody || !explained,
        StandReason::BlockedPath => !works,
        StandReason::LeadVehicle => leads,
        _ => true,
    })
    .collect()
}

/// Whether a stop is told to be one for all arms.
pub(crate) fn is_all_way(account: &Account) -> bool {
    let features = account.place.features.iter().map(|fact| &fact.source);
    let signs = [Some(&account.sv), account.partner.as_ref()].into_iter().flatten().flat_map(|party| &party.controls);
    let said = features.chain(signs.map(|fact| &fact.source)).map(text);
    said.into_iter().any(|words| ALL_WAY.iter().any(|word| words.contains(word)))
}

/// Words for a stop with a sign on every arm.
const ALL_WAY: [&str; 6] = ["four-way", "four way", "4-way", "4 way", "all-way", "all way"];

/// Who threw the partner at the ego, where told.
pub(crate) fn pusher(account: &Account) -> Option<Kind> {
    account.others.iter().find(|other| other.touched_partner).map(|other| other.kind.value)
}

/// Whether who touched the partner first is told to stand, and to do nothing else.
pub(crate) fn pusher_stands(account: &Account) -> bool {
    let stands = |fact: &ActFact| matches!(fact.act, Act::Park | Act::Hold);
    let touched = account.others.iter().find(|other| other.touched_partner);
    let before = touched.map(|other| before_contact(other).map(stands).collect::<Vec<_>>());
    before.is_some_and(|list| !list.is_empty() && list.into_iter().all(|stands| stands))
}

/// Two others than the ego who touch, whom nobody had touched before and of whom it is not told. Who throws the partner does so.
pub(crate) fn crash(told: &Told, rollout: &Rollout) -> Option<String> {
    let mut touched = vec![false; rollout.actors.len()];
    let id = |number: usize| rollout.actors[number].id.as_str();
    rollout.events.iter().find_map(|event| match event.kind {
        EventKind::Contact { a, b, .. } => {
            let throws = told.pushed && [id(a), id(b)].iter().all(|id| matches!(*id, "cp" | "pusher"));
            let untold = a > 0 && !touched[a] && !touched[b] && !throws;
            (touched[a], touched[b]) = (a > 0, true);
            untold.then(|| format!("{} and {} touch at {:.2} s", id(a), id(b), event.time_s))
        }
        _ => None,
    })
}

/// Whether somebody is told to be parked.
fn is_parked(other: &Other) -> bool {
    text(&other.kind.source).contains("parked") || before_contact(other).any(|fact| text(&fact.source).contains("park"))
}

pub(crate) fn is_on_foot(kind: Kind) -> bool {
    matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist)
}

/// Everybody who has a part in what the ego does, by what is told.
pub(crate) fn wanted(told: &Told, account: &Account) -> Vec<Extra> {
    let story = Story { account };
    let mut list: Vec<Extra> = Vec::new();
    for (number, other) in account.others.iter().enumerate() {
        let kind = other.kind.value;
        let near = |list: &[Extra]| {
            let before = list.iter().filter(|extra| extra.role == Role::Near).count();
            let near = Near::of(other, &text(&other.kind.source), before).filter(|_| !other.touched_partner);
            let (awaited, several) = (story.is_near(other), other.several);
            let near = near.map(|near| if told.dropped == Some(number) { near.ahead() } else { near });
            near.map(|near| Extra { awaited, several, ..Extra::near(near, number, kind) })
        };
        // Traffic that an ego passes which is not told to have slowed or stood is there.
        let passes =
            |role: Role| role == Role::Crosser && !told.sv.state.stands() && story.reactions().next().is_none();
        let role = story.role(told, other).filter(|role| is_drawn(told, *role) && !passes(*role));
        let Some(role) = role else {
            list.extend(near(&list));
            continue;
        };
        let drives_on = story.drives_on(other).filter(|_| role == Role::Lead);
        let parked = other.acts.iter().any(|fact| text(&fact.source).contains("parked"));
        let sets_off = sets_off(told) && !parked && !leaves_lane(told) || lets_in_at_green(told, other);
        let goes = role == Role::Lead && sets_off || drives_on.is_some();
        let first = drives_on == Some(true);
        let again = role == Role::Lead && story.stands_again(other);
        match list.iter_mut().find(|extra| extra.role == role) {
            Some(known) if kind.partner_kind().is_none_or(|kind| known.kind.partner_kind() == Some(kind)) => {
                known.of.push(number);
                known.goes |= goes;
                known.parked |= parked;
                known.several = true;
                known.first |= first;
                known.again |= again;
            }
            Some(_) => list.extend(near(&list)),
            None => {
                let side = story.side(role, told, other);
                let awaited = story.is_near(other) || other.several;
                let behind = role == Role::Obstacle && story.is_back(other);
                let between = role == Role::Beside && story.is_between(told, other);
                let stays = role == Role::Walker && stays_close(other);
                list.push(Extra {
                    of: vec![number],
                    kind,
                    goes,
                    parked,
                    first,
                    again,
                    awaited,
                    behind,
                    between,
                    stays,
                    several: other.several,
                    side,
                    ..Extra::of_reason(role)
                });
            }
        }
    }
    for extra in list.iter_mut().filter(|extra| extra.again) {
        (extra.goes, extra.first) = (false, false);
    }
    for_reasons(&story, told, &mut list);
    list
}

/// The same with those of whom only a reason to stand tells.
fn for_reasons(story: &Story<'_>, told: &Told, list: &mut Vec<Extra>) {
    let blocked = told.reasons.contains(&StandReason::BlockedJunction) && told.sv.state == ContactState::Stopped;
    if blocked && told.thing.is_none() && list.iter().all(|extra| extra.role != Role::Beyond) {
        list.push(Extra::of_reason(Role::Beyond));
    }
    // A queue that leaves no room behind a junction stands there.
    let beyond = blocked && list.iter().any(|extra| extra.role == Role::Beyond);
    let waits = |reason: &StandReason| match reason {
        StandReason::Queue => !beyond,
        reason => *reason == StandReason::LeadVehicle,
    };
    let queue = told.reasons.iter().any(waits);
    if queue && is_drawn(told, Role::Lead) && list.iter().all(|extra| extra.role != Role::Lead) {
        let several = told.reasons.contains(&StandReason::Queue);
        list.insert(0, Extra { several, ..Extra::of_reason(Role::Lead) });
    }
    let in_way = list.iter().any(|extra| matches!(extra.role, Role::Lead | Role::Obstacle));
    let thing = thing_in_way(story.account).filter(|_| !in_way && is_drawn(told, Role::Thing));
    if let Some(kind) = thing.filter(|_| told.reasons.contains(&StandReason::BlockedPath)) {
        list.push(Extra { kind, ..Extra::of_reason(Role::Thing) });
    }
    // It gave way, and nobody says to whom.
    let named = story.account.others.iter().any(|other| story.is_near(other));
    let named = named || list.iter().any(|extra| GIVEN_WAY.contains(&extra.role));
    let role = if is_at_junction(told) { Role::Crosser } else { Role::Oncoming };
    if told.reasons.contains(&StandReason::Yield) && !named && is_drawn(told, role) {
        list.push(Extra::of_reason(role));
    }
}

/// What to try: all of them, all but one, one of them, and none.
pub(crate) fn choices(wanted: &[Extra]) -> Vec<Vec<Extra>> {
    let wanted: Vec<Extra> = wanted.iter().filter(|extra| extra.near.is_none()).cloned().collect();
    let without = |left_out: usize| {
        let kept = wanted.iter().enumerate().filter(|(number, _)| *number != left_out);
        kept.map(|(_, extra)| extra.clone()).collect::<Vec<_>>()
    };
    let mut list = vec![wanted.to_vec()];
    if wanted.len() > 2 {
        list.extend((0..wanted.len()).rev().map(without));
    }
    if wanted.len() > 1 {
        list.extend(wanted.iter().map(|extra| vec![extra.clone()]));
    }
    list.extend((!wanted.is_empty()).then(Vec::new));
    list
}

impl Told {
    /// From which side the partner comes across.
    pub(crate) fn comes_from_side(&self) -> Option<LeftRight> {
        match self.origin {
            Origin::Cross { side } => Some(side),
            Origin::Parked { side }
            | Origin::Driveway { side }
            | Origin::Stall { side }
            | Origin::Sidewalk { side } => side,
            _ => None,
        }
    }

    /// Whether the partner comes out of a space beside the road.
    fn comes_from_aside(&self) -> bool {
        matches!(self.origin, Origin::Driveway { .. } | Origin::Stall { .. } | Origin::Parked { .. })
    }
}

/// Whether one with this part can be drawn in this crash.
fn is_drawn(told: &Told, role: Role) -> bool {
    let drives = matches!(told.sv.state, ContactState::Stopped | ContactState::Moving | ContactState::SettingOff);
    match role {
        Role::Kerb | Role::Beside | Role::Near => true,
        Role::Obstacle | Role::Oncoming | Role::Merger | Role::Backer | Role::Abreast => drives,
        Role::Passed => told.thing.is_none(),
        // Who was in the way of an ego that stood, and has left, may have left something there.
        Role::Walker if told.thing.is_some() => drives && sets_off(told),
        // Ahead of a partner that is ahead itself, and stands or backs there.
        Role::Lead => drives && told.thing.is_none() && (told.origin != Origin::Ahead || waits_ahead(told)),
        Role::Slower | Role::Thing => drives && told.thing.is_none() && told.origin != Origin::Ahead,
        _ => drives && told.thing.is_none(),
    }
}

/// Whether the partner stands in the queue ahead of the ego, or backs out of it.
pub(crate) fn waits_ahead(told: &Told) -> bool {
    let queue = told.reasons.contains(&StandReason::Queue) && told.sv.state == ContactState::Stopped;
    queue && told.origin == Origin::Ahead && told.cp.state == ContactState::Reversing
}

/// Whether the ego stood, and is under way again at the contact.
pub(crate) fn sets_off(told: &Told) -> bool {
    let stood = told.sv.stood_first || told.sv.phases.contains(&Phase::Stands);
    told.sv.state == ContactState::SettingOff || told.sv.state == ContactState::Moving && stood
}

/// Whether the ego stood, and leaves its lane.
pub(crate) fn leaves_lane(told: &Told) -> bool {
    let leaves = |aside: Aside| aside.from_t_m == 0.0 && aside.to_t_m.abs() >= LANE_M;
    sets_off(told) && told.sv_aside().is_some_and(leaves)
}

/// Whether the ego stands on though its light has turned green, and lets in who comes from beside the road: the queue ahead, of which no
/// deed is told, has driven on.
fn lets_in_at_green(told: &Told, other: &Other) -> bool {
    let green = told.sv.control.is_some_and(|said| said.state == Some(SignalState::TurnedGreen));
    let blocked = told.reasons.iter().any(|why| matches!(why, StandReason::BlockedJunction | StandReason::BlockedPath));
    let stays = told.sv.state == ContactState::Stopped && green && !blocked;
    stays && told.comes_from_aside() && before_contact(other).next().is_none()
}

/// Whether the road that the ego is on crosses another one there.
fn is_at_junction(told: &Told) -> bool {
    told.place == PlaceKind::Intersection || told.is_controlled() || told.sv.turning != Turning::No
}

/// What a thing is that stood in the ego's way, by the words for why it stood.
fn thing_in_way(account: &Account) -> Option<Kind> {
    let reason = account.sv.reasons.iter().find(|fact| fact.value == StandReason::BlockedPath)?;
    let words = text(&reason.source);
    THINGS.iter().find(|(word, _)| words.contains(word)).map(|(_, kind)| *kind)
}

/// Whether the ego goes round something.
fn goes_round(told: &Told) -> bool {
    told.sv_aside().is_some_and(|aside| aside.from_t_m == 0.0 && told.sv.movement != Some(Movement::ParkingManeuver))
        || told.sv.movement == Some(Movement::Passing)
}

/// Whether the ego keeps its lane.
fn is_straight(told: &Told) -> bool {
    told.sv.turning == Turning::No && told.sv_aside().is_none()
}

/// What the words tell of somebody else.
struct Story<'a> {
    account: &'a Account,
}

impl Story<'_> {
    /// What the ego did for somebody: where the words stand. That it stood when it was struck, said with its name, is nothing of that.
    fn reactions(&self) -> impl Iterator<Item = (usize, usize)> {
        let reacts = |fact: &&ActFact| {
            let acts = matches!(fact.act, Act::Slow | Act::Stop | Act::Hold | Act::Swerve | Act::Drift);
            let named = ["the ", "a ", "its "].iter().any(|article| text(&fact.source).starts_with(article));
            acts && !fact.after_contact && !named
        };
        let acts = self.account.sv.acts.iter().filter(reacts).map(|fact| &fact.source);
        acts.chain(self.account.sv.reasons.iter().map(|fact| &fact.source)).filter_map(span)
    }

    /// Whether somebody is named with the words that the ego slowed or stood, or what it did is told with them: the headline may have
    /// named it.
    fn is_near(&self, other: &Other) -> bool {
        let acts = before_contact(other).map(|fact| &fact.source).filter(|_| self.is_of_headline(other));
        let named: Vec<(usize, usize)> = [&other.kind.source].into_iter().chain(acts).filter_map(span).collect();
        let near = |(start, end): (usize, usize)| {
            named.iter().any(|(first, last)| *first <= end + NAMED_WITHIN && (*first >= start || *last > start))
        };
        self.reactions().any(near)
    }

    /// Whether somebody is named before all that the ego is told to have done.
    fn is_of_headline(&self, other: &Other) -> bool {
        let begins = self.account.sv.acts.iter().filter_map(|fact| span(&fact.source)).map(|(start, _)| start).min();
        span(&other.kind.source).zip(begins).is_some_and(|((named, _), begins)| named < begins)
    }

    /// Whether somebody on foot, or an animal, is whom the ego slowed or stood for.
    fn is_met(&self, other: &Other) -> bool {
        let Some((named, end)) = span(&other.kind.source) else { return false };
        let before = self.reactions().any(|(start, _)| (end..end + NAMED_BEFORE).contains(&start));
        let turns = self.account.sv.acts.iter().filter(|fact| fact.act == Act::Turn && !fact.after_contact);
        let turns = turns
            .filter_map(|fact| span(&fact.source))
            .any(|(start, end)| (start..end + NAMED_BEFORE).contains(&named));
        let reacts = self.reactions().next().is_some();
        let crosses =
            |fact: &ActFact| matches!(fact.act, Act::Cross | Act::Enter | Act::RunRed | Act::PullOut | Act::UTurn);
        self.is_near(other) || reacts && before_contact(other).any(crosses) || before || turns
    }

    /// Whether who stood drove on; and whether it did so before the ego did.
    fn drives_on(&self, other: &Other) -> Option<bool> {
        let stood = |fact: &&ActFact| matches!(fact.act, Act::Stop | Act::Hold) && !fact.after_contact;
        let since = self.account.sv.acts.iter().chain(&other.acts).filter(stood).map(|fact| fact.step).min()?;
        let drives = |fact: &&ActFact| {
            fact.step > since && matches!(fact.act, Act::SetOff | Act::Follow | Act::Accelerate | Act::Leave)
        };
        let at = before_contact(other).find(drives)?.step;
        let moves = |fact: &&ActFact| {
            let moves = matches!(fact.act, Act::SetOff | Act::Follow | Act::Enter | Act::LaneChange | Act::Turn);
            moves && fact.step > since && !fact.after_contact
        };
        Some(self.account.sv.acts.iter().find(moves).is_some_and(|fact| at < fact.step))
    }

    /// Whether somebody stands, or comes to a stop, behind that the ego set off, and the ego slows or stops again.
    fn stands_again(&self, other: &Other) -> bool {
        let ego = || self.account.sv.acts.iter().filter(|fact| !fact.after_contact);
        let Some(off) = ego().filter(|fact| fact.act == Act::SetOff).map(|fact| fact.step).max() else { return false };
        let slows = ego().any(|fact| fact.step > off && matches!(fact.act, Act::Slow | Act::Stop));
        let last = before_contact(other).max_by_key(|fact| fact.step);
        slows && last.is_some_and(|fact| fact.step > off && matches!(fact.act, Act::Hold | Act::Stop))
    }

    fn role(&self, told: &Told, other: &Other) -> Option<Role> {
        // Who throws the partner is drawn there; and who comes afterwards is not.
        let later = !other.acts.is_empty() && other.acts.iter().all(|fact| fact.after_contact) && !self.is_near(other);
        if other.touched_partner || later {
            return None;
        }
        match other.kind.value.group() {
            KindGroup::OnFoot | KindGroup::Cyclist => self.is_met(other).then_some(Role::Walker),
            KindGroup::Animal => self.is_met(other).then_some(Role::Animal),
            KindGroup::Car | KindGroup::Truck | KindGroup::Motorcycle => self.vehicle(told, other),
            _ => None,
        }
    }

    /// Whether the partner goes round somebody who stands: it comes over from the opposite side, or passes where the ego is at the kerb.
    fn is_passed(&self, told: &Told) -> bool {
        let passes = |fact: &ActFact| matches!(fact.act, Act::Pass | Act::LaneChange) && !fact.after_contact;
        let at_kerb = told.sv.state == ContactState::Parked
            || told.sv.came_to_park
            || told.sv.movement == Some(Movement::EnteringTraffic);
        told.comes_over || at_kerb && self.account.partner.as_ref().is_some_and(|party| party.acts.iter().any(passes))
    }

    /// Whether the partner is told to pass between the ego and somebody: who is named right behind that; where nobody is, and the partner
    /// goes the ego's way, anybody.
    fn is_between(&self, told: &Told, other: &Other) -> bool {
        let between =
            |fact: &&ActFact| fact.act == Act::Pass && !fact.after_contact && text(&fact.source).contains("between");
        let acts = self.account.partner.iter().flat_map(|partner| &partner.acts).filter(between);
        let ends: Vec<usize> = acts.filter_map(|fact| Some(span(&fact.source)?.1)).collect();
        let named = |other: &Other| {
            let behind = |(start, _)| ends.iter().any(|end| (*end..=end + PASSES_WITHIN).contains(&start));
            span(&other.kind.source).is_some_and(behind)
        };
        match told.origin {
            Origin::Behind | Origin::Beside { .. } if !self.account.others.iter().any(named) => !ends.is_empty(),
            Origin::Behind | Origin::Beside { .. } | Origin::Opposite => named(other),
            _ => false,
        }
    }

    /// Whether somebody is told to drive, and to do nothing else.
    fn only_drives(&self, other: &Other) -> bool {
        before_contact(other).all(|fact| matches!(fact.act, Act::Follow | Act::Enter | Act::SetOff | Act::Slow))
    }

    /// Whether somebody who drives in the next lane has room there, beside an ego that keeps its own.
    fn keeps_abreast(&self, told: &Told, place: Option<Origin>) -> bool {
        let Some(Origin::Beside { side }) = place else { return false };
        let free = told.comes_from_side() != Some(side) && told.origin != Origin::Beside { side };
        // What came off it rolls out from beside it.
        let free = free || told.is_sliding();
        let drives = matches!(told.sv.state, ContactState::Moving | ContactState::SettingOff);
        free && drives && is_straight(told)
    }

    /// The step at which the ego is told to pass somebody.
    fn passes_at(&self, other: &Other) -> Option<u32> {
        let passes = |fact: &&ActFact| fact.act == Act::Pass && !fact.after_contact && !fact.begun;
        let acts = before_contact(other).map(|fact| &fact.source);
        let named: Vec<usize> =
            [&other.kind.source].into_iter().chain(acts).filter_map(|source| Some(span(source)?.0)).collect();
        let of = |fact: &&ActFact| {
            let within =
                |(start, end): (usize, usize)| named.iter().any(|at| (start..=end + PASSES_WITHIN).contains(at));
            span(&fact.source).is_some_and(within)
        };
        self.account.sv.acts.iter().filter(passes).find(of).map(|fact| fact.step)
    }

    /// Whether the ego has passed somebody, and is told to have come back into its lane then.
    fn is_back(&self, other: &Other) -> bool {
        let Some(passed) = self.passes_at(other) else { return false };
        let changes = |fact: &&ActFact| fact.act == Act::LaneChange && !fact.after_contact && !fact.begun;
        let changes: Vec<&ActFact> = self.account.sv.acts.iter().filter(changes).collect();
        match changes.as_slice() {
            [.., last] if last.step > passed => true,
            // "It merged to the right, and merged back to the left after passing the truck."
            [.., one, last] => one.side.is_some() && last.side == one.side.map(LeftRight::other),
            _ => false,
        }
    }

    /// Whether somebody was about to change lanes.
    fn merges_yet(&self, other: &Other) -> bool {
        other.acts.iter().any(|fact| fact.act == Act::LaneChange && fact.begun && !fact.after_contact)
    }

    /// Whether the ego moves over in its lane, or out of it, away from the side from which somebody comes.
    fn makes_room(&self, told: &Told, other: &Other) -> bool {
        let away = told.sv.aside.map(LeftRight::other).filter(|_| told.sv.turning == Turning::No);
        away.is_some() && away == self.came_from(other)
    }

    /// From which side somebody changes lanes.
    fn came_from(&self, other: &Other) -> Option<LeftRight> {
        let changes =
            before_contact(other).find(|fact| matches!(fact.act, Act::LaneChange | Act::PullOut | Act::Swerve));
        match other.place.as_ref().map(|fact| fact.value) {
            Some(Origin::Beside { side }) => Some(side),
            _ => changes.and_then(|fact| fact.side).map(LeftRight::other),
        }
    }

    fn vehicle(&self, told: &Told, other: &Other) -> Option<Role> {
        let words = text(&other.kind.source);
        let said = |of: &[&str]| of.iter().any(|word| words.contains(word));
        let did = |acts: &[Act]| before_contact(other).any(|fact| acts.contains(&fact.act));
        let place = other.place.as_ref().map(|fact| fact.value);
        // Of traffic without a deed it is told because the ego waits for it.
        let acts_not = before_contact(other).next().is_none();
        let near = self.is_near(other);
        let reacts = self.reactions().next().is_some();
        let because = |reason: StandReason| told.reasons.contains(&reason);
        let stands = did(&[Act::Hold, Act::Stop, Act::Park]) && !did(&[Act::SetOff, Act::Follow, Act::Reverse]);
        if stands && !other.several && !near && self.is_passed(told) {
            return Some(Role::Passed);
        }
        if stands && !other.several && self.is_between(told, other) {
            return Some(Role::Beside);
        }
        if is_parked(other) && !did(&[Act::PullOut, Act::SetOff, Act::Follow, Act::Reverse]) {
            let double = said(&["double"]) || before_contact(other).any(|fact| text(&fact.source).contains("double"));
            let waits =
                because(StandReason::BlockedPath) || because(StandReason::LeadVehicle) || place == Some(Origin::Ahead);
            let blocks = near && (waits || double);
            return match (other.several, goes_round(told) && told.thing.is_none_or(|thing| thing != other.kind.value)) {
                (true, _) => Some(Role::Kerb),
                (false, true) => Some(Role::Obstacle),
                (false, false) if blocks => Some(Role::Lead),
                (false, false) => (!did(&[Act::Park])).then_some(Role::Kerb),
            };
        }
        if stands && !other.several && self.is_back(other) && told.sv_aside().is_some() {
            return Some(Role::Obstacle);
        }
        // In the next lane, whether or not the ego slows as it goes by.
        let beside = matches!(place, Some(Origin::Beside { .. })) || place.is_none() && self.passes_at(other).is_some();
        if stands
            && beside
            && told.sv_aside().is_none()
            && !self.is_back(other)
            && !did(&[Act::LaneChange, Act::Enter, Act::PullOut, Act::Drift])
        {
            return Some(Role::Beside);
        }
        let drives = did(&[Act::Follow, Act::Enter, Act::SetOff]) && self.only_drives(other);
        if drives && self.keeps_abreast(told, place) {
            return Some(Role::Abreast);
        }
        if did(&[Act::Reverse]) && matches!(place, Some(Origin::Beside { .. })) && (near || reacts) {
            return Some(Role::Backer);
        }
        if place == Some(Origin::Opposite) || said(&["oncoming", "opposing"]) {
            let only_passes = !did(&[Act::Hold, Act::Stop, Act::Turn, Act::LaneChange, Act::Park, Act::Reverse]);
            // Of who turns across it, it is told only because that waits for it.
            let waits = near || other.several && (told.sv.turning == Turning::Left || acts_not);
            return (only_passes && (waits || did(&[Act::Follow]))).then_some(Role::Oncoming);
        }
        let queue = because(StandReason::Queue) || because(StandReason::LeadVehicle);
        let ahead = place == Some(Origin::Ahead) || said(&["lead", "preceding"]);
        let beside = matches!(place, Some(Origin::Beside { .. }));
        let across = matches!(place, Some(Origin::Cross { .. }));
        let crosses = said(&["cross", "bound traffic", "approaching traffic"]) || beside || across;
        let turns = told.sv.turning != Turning::No || because(StandReason::StopSign);
        let passes = turns && (because(StandReason::Yield) || did(&[Act::Follow]));
        // Crossing traffic that has not cleared the junction.
        let held = other.several && crosses && did(&[Act::Hold]) && told.sv.state == ContactState::Stopped;
        if held && (told.place == PlaceKind::Intersection || told.is_controlled()) && !beside && !queue {
            return Some(Role::Blocker);
        }
        let for_turn =
            told.sv.turning != Turning::No && said(&["cross"]) || across && (acts_not || did(&[Act::Follow]));
        let for_turn = for_turn && !because(StandReason::BlockedJunction);
        let waits = near || other.several && for_turn;
        if waits && !ahead && !queue && other.several && (crosses || passes || because(StandReason::Yield)) {
            let turns_left =
                told.sv.turning == Turning::Left && !because(StandReason::StopSign) && !said(&["cross"]) && !across;
            let junction = told.place == PlaceKind::Intersection || turns || said(&["cross"]) || across;
            return junction.then_some(if turns_left { Role::Oncoming } else { Role::Crosser });
        }
        let leaves = did(&[Act::LaneChange, Act::Enter, Act::PullOut, Act::Cross, Act::Reverse, Act::Pass, Act::Drift]);
        let pulls_out = did(&[Act::PullOut]) && !told.comes_from_aside();
        let came_over = did(&[Act::LaneChange])
            || pulls_out
            || beside && did(&[Act::Swerve, Act::SetOff])
            || ahead && near && did(&[Act::Drift])
            || self.merges_yet(other);
        let merges = came_over && !did(&[Act::Hold, Act::Stop, Act::Turn, Act::Cross]);
        let keeps_lane = is_straight(told) || self.makes_room(told, other);
        if merges
            && (near || reacts || self.makes_room(told, other))
            && !other.several
            && place != Some(Origin::Behind)
            && keeps_lane
        {
            return Some(Role::Merger);
        }
        let junction = told.place == PlaceKind::Intersection || told.is_controlled();
        let waits = near && told.sv.state == ContactState::Stopped && other.several;
        if waits && because(StandReason::BlockedJunction) {
            return Some(Role::Beyond);
        }
        let waits = waits && !queue;
        // Who drives elsewhere does not stand ahead.
        let elsewhere = did(&[Act::Follow]) && !did(&[Act::Hold, Act::Stop]) && !ahead && !queue;
        if waits && junction && elsewhere {
            return Some(Role::Blocker);
        }
        if !(near && !beside || ahead && reacts) || leaves || elsewhere || place == Some(Origin::Behind) {
            return None;
        }
        // Who stands somewhere, and is not told to have gone, stands yet when the ego drives on: not in its lane.
        let only_holds = !acts_not && before_contact(other).all(|fact| matches!(fact.act, Act::Hold | Act::Park));
        if only_holds && place.is_none() && sets_off(told) && is_straight(told) && !queue && !told.is_controlled() {
            return None;
        }
        // At green nobody stands before the line: who stops ahead does so behind the junction.
        let drawn = matches!(told.place, PlaceKind::Street | PlaceKind::Intersection);
        let behind = drawn && !matches!(told.origin, Origin::Cross { .. });
        let green = told.sv.control.is_some_and(|said| said.state == Some(SignalState::Green));
        if green
            && other.several
            && behind
            && told.sv.state == ContactState::Stopped
            && !queue
            && told.sv.turning == Turning::No
        {
            return Some(Role::Beyond);
        }
        let slows = said(&["slow"]) || did(&[Act::Slow, Act::Turn, Act::Park, Act::Stop]) && !did(&[Act::Hold]);
        let moves = matches!(told.sv.state, ContactState::Moving) && !sets_off(told);
        Some(if slows && moves { Role::Slower } else { Role::Lead })
    }

    /// On which side of the ego somebody is, or from which it comes.
    fn side(&self, role: Role, told: &Told, other: &Other) -> Option<LeftRight> {
        let passes = self.account.sv.acts.iter().find(|fact| fact.act == Act::Pass && !fact.after_contact);
        let passed = passes.and_then(|fact| fact.side).or(told.sv.aside).map(LeftRight::other);
        match other.place.as_ref().map(|fact| fact.value) {
            Some(Origin::Beside { side } | Origin::Cross { side }) => Some(side),
            // One that is parked is where the partner comes from, or on the right.
            _ if role == Role::Kerb && !other.several => match told.origin {
                Origin::Parked { side } | Origin::Driveway { side } | Origin::Sidewalk { side } => side,
                _ => None,
            }
            .or(Some(LeftRight::Right)),
            // Who changes to its right comes from the left.
            // From the lane beside it of which is told.
            _ if role == Role::Merger => self.came_from(other).or(match told.origin {
                Origin::Beside { side } => Some(side),
                _ => None,
            }),
            _ if role == Role::Obstacle && self.is_back(other) => None,
            // On the side where the partner touches the ego.
            _ if role == Role::Beside && self.is_between(told, other) => {
                side_of(&told.sv.zones).map(|side| if side > 0.0 { LeftRight::Left } else { LeftRight::Right })
            }
            _ => passed.filter(|_| matches!(role, Role::Obstacle | Role::Beside)),
        }
    }
}

/// Whether who is on foot is told last to stand or to stay, and not to have crossed.
fn stays_close(other: &Other) -> bool {
    let crosses = before_contact(other).any(|fact| fact.act == Act::Cross);
    !crosses && before_contact(other).last().is_some_and(|fact| matches!(fact.act, Act::Hold | Act::Stop))
}

fn before_contact(other: &Other) -> impl Iterator<Item = &ActFact> {
    other.acts.iter().filter(|fact| !fact.after_contact && !fact.begun)
}

/// Where the words of a fact stand.
fn span(source: &Source) -> Option<(usize, usize)> {
    match source {
        Source::Words { start, end, .. } => Some((*start, *end)),
        _ => None,
    }
}

pub(crate) fn text(source: &Source) -> String {
    match source {
        Source::Words { text, .. } => text.to_lowercase(),
        _ => String::new(),
    }
}
