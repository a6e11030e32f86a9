//! Others than the two: who is told of besides them, and why the ego stood.

use crate::reading::acts::is_hard;
use crate::reading::story::{
    Story, has_siren, is_at_junction, is_parked, lets_in_at_green, parks_backwards, stays_close,
};
use crate::reading::words::{before_contact, span, text};
use crate::told::crash::Told;
use crate::told::near::Near;
use crate::told::others::{Extra, GIVEN_WAY, Role, Thrower};
use crate::told::queue::{leaves_lane, sets_off, waits_ahead};
use crate::told::zones::side_of;
use recrash_model::account::{
    self, Account, Act, ActFact, Astride, ContactState, Fact, Kind, KindGroup, Manner, Origin, Other, StandReason,
};

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
pub(super) fn reasons(account: &Account, origin: Origin) -> Vec<StandReason> {
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
    let works = said(StandReason::LeadVehicle) || said(StandReason::Pedestrian) && any(is_light);
    // "second in line": one vehicle stands ahead, and no more.
    let second =
        |fact: &&Fact<StandReason>| fact.value == StandReason::Queue && text(&fact.source).contains("second in");
    let one_ahead = account.sv.reasons.iter().any(|fact| second(&fact));
    let told = told.map(|reason| match reason {
        StandReason::Queue if one_ahead => StandReason::LeadVehicle,
        reason => reason,
    });
    told.filter(|reason| match reason {
        StandReason::Pedestrian => any(is_light),
        StandReason::Animal => any(|kind| kind.group() == KindGroup::Animal),
        StandReason::Yield => somebody || !explained,
        StandReason::BlockedPath => !works,
        StandReason::LeadVehicle => leads || one_ahead,
        _ => true,
    })
    .collect()
}

/// Whether a stop is told to be one for all arms.
pub(super) fn is_all_way(account: &Account) -> bool {
    let features = account.place.features.iter().map(|fact| &fact.source);
    let signs = [Some(&account.sv), account.partner.as_ref()].into_iter().flatten().flat_map(|party| &party.controls);
    let said = features.chain(signs.map(|fact| &fact.source)).map(text);
    said.into_iter().any(|words| ALL_WAY.iter().any(|word| words.contains(word)))
}

/// Words for a stop with a sign on every arm.
const ALL_WAY: [&str; 6] = ["four-way", "four way", "4-way", "4 way", "all-way", "all way"];

/// Who threw the partner at the ego, where told.
pub(super) fn pusher(account: &Account) -> Option<Kind> {
    account.others.iter().find(|other| other.touched_partner).map(|other| other.kind.value)
}

/// Whether who touched the partner first is told to have come fast.
pub(super) fn pusher_fast(account: &Account) -> bool {
    let fast = |fact: &ActFact| fact.manner == Some(Manner::Fast) && !is_hard(fact);
    account.others.iter().any(|other| other.touched_partner && before_contact(other).any(fast))
}

/// Whether who touched the partner first is told to stand, and to do nothing else.
pub(super) fn pusher_stands(account: &Account) -> bool {
    let stands = |fact: &ActFact| matches!(fact.act, Act::Park | Act::Hold);
    let touched = account.others.iter().find(|other| other.touched_partner);
    let before = touched.map(|other| before_contact(other).map(stands).collect::<Vec<_>>());
    before.is_some_and(|list| !list.is_empty() && list.into_iter().all(|stands| stands))
}

/// Whether it is somebody on foot or on a cycle.
fn is_light(kind: Kind) -> bool {
    matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist)
}

/// Everybody who has a part in what the ego does, by what is told.
pub(super) fn wanted(told: &Told, account: &Account) -> Vec<Extra> {
    let mut gathered = Gathered { story: Story { account }, told, list: Vec::new() };
    for (at, other) in account.others.iter().enumerate() {
        gathered.add(at, other);
    }
    let Gathered { story, mut list, .. } = gathered;
    for extra in list.iter_mut().filter(|extra| extra.again) {
        (extra.goes, extra.first) = (false, false);
    }
    for_reasons(&story, told, &mut list);
    list
}

/// Those who have a part, or are near, of the others that have been looked at.
struct Gathered<'a> {
    story: Story<'a>,
    told: &'a Told,
    list: Vec<Extra>,
}

impl Gathered<'_> {
    /// Adds one of the others: with its part, to those who have the same, or as one who is near where it has none, or is of another kind than they.
    fn add(&mut self, at: usize, other: &Other) {
        let Some(extra) = self.role(other).map(|role| self.extra(role, at, other)) else {
            return self.list.extend(self.near(at, other));
        };
        let kind = extra.kind.partner_kind();
        // "With a van parked at each side of the drive, a boy ran out from between the vans": those are parked.
        let parks = |known: &Extra| {
            let hides = extra.role == Role::Screen && known.role == Role::Kerb;
            hides && known.kind.partner_kind() == kind && other.acts.is_empty()
        };
        let same = |known: &Extra| known.role == extra.role && known.stays == extra.stays || parks(known);
        match self.list.iter_mut().find(|known| same(known)) {
            Some(known)
                if kind.is_none_or(|kind| known.kind.partner_kind() == Some(kind)) || is_of_queue(known, other) =>
            {
                join(known, extra, self.told);
            }
            Some(_) => self.list.extend(self.near(at, other)),
            None => self.list.push(extra),
        }
    }

    /// The part of one of the others, where it has one that is drawn.
    fn role(&self, other: &Other) -> Option<Role> {
        let (story, told) = (&self.story, self.told);
        let role = story.role(told, other).filter(|role| is_drawn(told, *role))?;
        let elsewhere = match role {
            // Traffic that an ego passes which is not told to have slowed or stood is there.
            Role::Crosser => !told.sv.state.stands() && story.reactions().next().is_none(),
            // Nor does traffic that went on before the ego stopped, for something else, stand in its way.
            Role::Lead => story.has_gone(told, other) || is_heard(other),
            _ => false,
        };
        (!elsewhere).then_some(role)
    }

    /// One of the others who has this part.
    fn extra(&self, role: Role, at: usize, other: &Other) -> Extra {
        let (story, told, kind) = (&self.story, self.told, other.kind.value);
        let acts_not = before_contact(other).next().is_none();
        let lead = role == Role::Lead;
        let parked = other.acts.iter().any(|fact| text(&fact.source).contains("parked"));
        let drives_on = story.drives_on(other).filter(|_| lead);
        let sets_off = sets_off(told) && !parked && !leaves_lane(told) || lets_in_at_green(told, other);
        let late = story.is_slowed_for_later(told, other);
        // Of whom no deed is told where the ego slows for it again, it has moved up as that did.
        let moves_up = (late || story.is_placed_as_it_slows(told, other)) && acts_not;
        let goes_out = role == Role::Passed && story.is_reason_to_go_out(told, other);
        Extra {
            of: vec![at],
            kind,
            goes: lead && sets_off || drives_on.is_some(),
            parks: lead && is_parking(other),
            parked,
            first: drives_on == Some(true),
            goes_out,
            slow: goes_out && acts_not,
            again: lead && (story.stands_again(other) || moves_up),
            late,
            early: role == Role::Crosser && story.is_gone_before(other)
                || matches!(role, Role::Crosser | Role::Oncoming) && story.goes_first(told, other),
            awaited: story.is_near(other) || other.several,
            behind: role == Role::Obstacle && story.is_back(other),
            between: role == Role::Beside && story.is_between(told, other),
            led: role == Role::Animal && story.led_by(other).is_some(),
            hides: other.hides,
            passed: matches!(role, Role::Kerb | Role::Obstacle) && story.goes_by(told, other),
            stays: role == Role::Walker && stays_close(other),
            runs: role == Role::Walker && kind == Kind::Pedestrian && runs(other),
            opposite: other.place.as_ref().is_some_and(|fact| fact.value == Origin::Opposite),
            several: other.several,
            number: number_of(other),
            side: story.side(role, told, other),
            astride: other.astride.as_ref().map(|fact| fact.value),
            ..Extra::of_reason(role)
        }
    }

    /// One of the others who is near and has no part, where it can be drawn.
    fn near(&self, at: usize, other: &Other) -> Option<Extra> {
        let (story, told) = (&self.story, self.told);
        let before = self.list.iter().filter(|extra| extra.role == Role::Near).count();
        let mut near = Near::of(other, &text(&other.kind.source), before).filter(|_| !other.touched_partner)?;
        near.after_turn = story.is_after_turn(told, other);
        if told.dropped == Some(at) {
            near = near.ahead();
        }
        if story.goes_first(told, other) {
            near = near.gone_first(Story::first_from(told) == Role::Oncoming);
        }
        if matches!(told.origin, Origin::Cross { .. }) && story.is_passed_by_partner(other) {
            near.place = near.place.or(Some(told.origin));
        }
        Some(Extra {
            awaited: story.is_near(other) || story.comes_with_siren(other),
            several: other.several,
            number: number_of(other),
            hides: other.hides,
            ..Extra::near(near, at, other.kind.value)
        })
    }
}

/// Adds one to those who have the same part.
fn join(known: &mut Extra, another: Extra, told: &Told) {
    let of_any_kind = known.kind.partner_kind().is_none();
    // "Behind a bus in traffic": one of them is a bus.
    if !known.several {
        known.more = Some(another.kind);
    } else if of_any_kind {
        known.more = Some(known.kind);
    }
    if of_any_kind {
        known.kind = another.kind;
    }
    known.of.extend(another.of);
    known.number = known.number.max(another.number);
    known.goes |= another.goes;
    known.parked |= another.parked;
    known.several = true;
    known.hides |= another.hides;
    if another.role == Role::Screen && known.role == Role::Kerb {
        known.side = told.comes_from_side();
    }
    known.first |= another.first;
    known.again |= another.again;
}

/// How many of them are drawn where several are told: as many as are counted, up to four, and three where they are more than a few.
fn number_of(other: &Other) -> usize {
    const MANY: [&str; 8] = ["several", "group", "crowd", "class", "many", "multiple", "handful", "numerous"];
    let words = text(&other.kind.source);
    let of = |word: &str| match word {
        "two" | "couple" | "pair" => Some(2),
        "three" => Some(3),
        "four" | "five" | "six" | "seven" | "eight" | "nine" | "ten" | "dozen" | "fifteen" | "twenty" => Some(4),
        word => MANY.contains(&word).then_some(3),
    };
    // "Four-door" counts nobody.
    words.split(|letter: char| !letter.is_alphanumeric() && letter != '-').find_map(of).unwrap_or(2)
}

/// Whether somebody is told to run before the contact.
fn runs(other: &Other) -> bool {
    before_contact(other).any(|fact| fact.manner == Some(Manner::Fast))
}

/// Whether somebody is on its way into a space at the kerb: "a parallel parking van".
fn is_parking(other: &Other) -> bool {
    let acts = before_contact(other).map(|fact| text(&fact.source));
    let parks = |words: String| words.contains("parallel parking") || words.ends_with("parking");
    parks_backwards(other) || acts.chain([text(&other.kind.source)]).any(parks)
}

/// Whether somebody with a siren is told of without a place or a deed: it is nobody who stands ahead.
fn is_heard(other: &Other) -> bool {
    has_siren(other) && other.place.is_none() && before_contact(other).next().is_none()
}

/// Whether somebody who is told ahead is the nearest of traffic that stands there, which may be of any kind.
fn is_of_queue(known: &Extra, other: &Other) -> bool {
    let ahead = other.place.as_ref().is_some_and(|fact| fact.value == Origin::Ahead);
    // "Traffic ahead braked for a stalled bus": that is its head.
    let head = text(&other.kind.source).contains("stalled");
    known.role == Role::Lead && known.several && known.kind.partner_kind().is_none() && ahead && !other.several && !head
}

/// The same with those of whom only a reason to stand tells.
fn for_reasons(story: &Story<'_>, told: &Told, list: &mut Vec<Extra>) {
    let blocked = told.reasons.contains(&StandReason::BlockedJunction) && told.sv.state == ContactState::Stopped;
    if blocked && told.thing.is_none() && list.iter().all(|extra| extra.role != Role::Beyond) {
        list.push(Extra::of_reason(Role::Beyond));
    }
    // A queue that leaves no room behind a junction stands there.
    let beyond = list.iter().any(|extra| extra.role == Role::Beyond);
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
    let named = story.account.others.iter().any(|other| story.is_near(other) || story.comes_with_siren(other));
    let named = named || list.iter().any(|extra| GIVEN_WAY.contains(&extra.role));
    // Who is about to turn left at no stop sign gives way to those who come towards it.
    let to_left = told.waits_to_turn_left() && Story::first_from(told) == Role::Oncoming;
    let role = if is_at_junction(told) && !to_left { Role::Crosser } else { Role::Oncoming };
    if told.reasons.contains(&StandReason::Yield) && !named && is_drawn(told, role) {
        list.push(Extra::of_reason(role));
    }
}

/// Whether one with this part can be drawn in this crash.
fn is_drawn(told: &Told, role: Role) -> bool {
    let drives = matches!(told.sv.state, ContactState::Stopped | ContactState::Moving | ContactState::SettingOff);
    match role {
        Role::Kerb | Role::Beside | Role::Near => true,
        Role::Obstacle | Role::Oncoming | Role::Merger | Role::Backer | Role::Abreast => drives,
        Role::Passed | Role::Screen => told.thing.is_none(),
        // Who was in the way of an ego that stood, and has left, may have left something there.
        Role::Walker if told.thing.is_some() => drives && sets_off(told),
        // Ahead of a partner that is ahead itself, and stands or backs there.
        Role::Lead => told.thing.is_none() && (drives && told.origin != Origin::Ahead || waits_ahead(told)),
        Role::Slower | Role::Thing => drives && told.thing.is_none() && told.origin != Origin::Ahead,
        _ => drives && told.thing.is_none(),
    }
}

/// What a thing is that stood in the ego's way, by the words for why it stood.
fn thing_in_way(account: &Account) -> Option<Kind> {
    let reason = account.sv.reasons.iter().find(|fact| fact.value == StandReason::BlockedPath)?;
    let words = text(&reason.source);
    THINGS.iter().find(|(word, _)| words.contains(word)).map(|(_, kind)| *kind)
}

/// Who of the others is told over a line of the road.
pub(super) fn astride(account: &Account) -> Vec<(usize, Astride)> {
    let all = account.others.iter().enumerate();
    all.filter_map(|(number, other)| Some((number, other.astride.as_ref()?.value))).collect()
}

/// How who touched the partner first did so, where that is told.
pub(super) fn touch(account: &Account) -> Option<account::EarlierTouch> {
    account.others.iter().find(|other| other.touched_partner)?.touch.as_ref().map(|fact| fact.value)
}

/// On which side of the partner it was by where that was touched: along a flank, or at a corner of its front by which it came over.
fn touched_side(account: &Account) -> Option<Thrower> {
    let zone = touch(account).filter(|touch| touch.by_partner)?.of_partner.filter(|zone| !zone.is_rear())?;
    side_of(&[zone]).map(Thrower::Beside)
}

/// From where who touched the partner first came, where that is told.
pub(super) fn thrower(account: &Account) -> Option<Thrower> {
    let other = account.others.iter().find(|other| other.touched_partner)?;
    let changes = |fact: &&account::ActFact| fact.act == account::Act::LaneChange && !fact.after_contact;
    match other.place.as_ref().map(|fact| fact.value) {
        Some(Origin::Beside { side }) => Some(Thrower::Beside(side)),
        Some(Origin::Cross { side }) => Some(Thrower::Cross(side)),
        Some(Origin::Ahead) => Some(Thrower::Ahead),
        Some(Origin::Opposite) => Some(Thrower::Opposite),
        // Who changes to its right comes from the left.
        _ => match other.acts.iter().find(changes) {
            Some(change) => change.side.map(|side| Thrower::Beside(side.other())),
            None => touched_side(account),
        },
    }
}
