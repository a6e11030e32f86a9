//! Movement of both sides just before the conflict, from their acts, states and columns.

use super::Reading;
use super::party::movement_column;
use crate::chunk::Joint;
use crate::frame::Frame;
use crate::lexicon::Sense;
use crate::token::word;
use crate::world::SUBJECT;
use recrash_model::account::{
    Account, Act, ActFact, ContactState, Fact, Kind, KindGroup, LeftRight, Origin, Party, Source, StandReason, told,
};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone as Z;

/// Movement of both sides just before the conflict.
pub(crate) fn movements(reading: &Reading<'_>, account: &mut Account) {
    account.sv.movement = of_subject(reading, account);
    let partner = account.partner.as_ref().map(|partner| of_partner(reading, account, partner));
    if let (Some(movement), Some(partner)) = (partner, &mut account.partner) {
        partner.movement = movement;
    }
}

fn drives_on() -> Option<Fact<Movement>> {
    Some(Fact::by_rule(Movement::Straight, "who is told to do nothing else drives on"))
}

/// Movement of the subject vehicle.
fn of_subject(reading: &Reading<'_>, account: &Account) -> Option<Fact<Movement>> {
    let sv = &account.sv;
    let column = reading.record.sv_movement.known();
    let kind = account.partner.as_ref().and_then(|partner| told(&partner.kind));
    let mut movement = movement(reading, &of_its_own(reading, sv, kind), column, "SV Pre-Crash Movement");
    let drives = matches!(told(&sv.state), Some(ContactState::Moving | ContactState::SettingOff));
    if movement.is_none() && drives {
        movement = drives_on();
    }
    // Who veers off the road leaves its lane.
    let fixed = matches!(kind, Some(Kind::Wall | Kind::Pole | Kind::Curb | Kind::Barrier));
    let veers = sv.acts.iter().find(|fact| fact.act == Act::Swerve && fact.happened());
    if let (true, Some(veers), Some(Movement::Straight) | None) = (fixed, veers, told(&movement)) {
        movement = Some(Fact { value: Movement::LaneDeparture, source: veers.source.clone() });
    }
    // Who stops in the lane for passengers is parked by the column, and stopped by the words.
    let riders = sv.reasons.iter().find(|reason| reason.value == StandReason::PickupDropoff);
    let said = reading.before(SUBJECT).any(|(_, frame)| frame.sense == Sense::Parked);
    let by_column = sv.state.as_ref().is_some_and(|state| !state.source.is_told()) && !said;
    if let (Some(Movement::Parked), true, false, Some(reason)) = (told(&movement), by_column, sv.did(Act::Park), riders)
    {
        movement = Some(Fact { value: Movement::Stopped, source: reason.source.clone() });
    }
    movement
}

/// The subject vehicle without what it did that did not lead to the conflict.
fn of_its_own(reading: &Reading<'_>, sv: &Party, partner: Option<Kind>) -> Party {
    let column = reading.record.sv_movement.known();
    let mut sv = sv.clone();
    // Whom else it passed.
    let passes_partner = reading.contacts.partner.is_none_or(|partner| {
        let mut passed = reading.before(SUBJECT).filter(|(_, frame)| frame.act() == Some(Act::Pass)).peekable();
        passed.peek().is_none() || passed.any(|(_, frame)| frame.object.is_none_or(|object| object == partner))
    });
    let elsewhere = !passes_partner && column.is_some_and(|column| column != Movement::Passing);
    sv.acts.retain(|fact| fact.act != Act::Pass || !elsewhere);
    // "proceeded straight past a stopped van".
    let straight_past = |fact: &ActFact| {
        fact.act == Act::Pass && fact.side.is_none() && format!("{} ", words_of(fact)).contains(" past ")
    };
    sv.acts.retain(|fact| column != Some(Movement::Straight) || !straight_past(fact));
    // Who touches a thing on its way out of a lot is in no traffic yet.
    let thing = partner.is_some_and(|kind| kind.group() == KindGroup::Object);
    sv.acts.retain(|fact| fact.act != Act::PullOut || !thing || column.is_none());
    // "After it made a right turn": by the column it drove on then.
    let turned = |fact: &ActFact| {
        let frame = reading.story.frames.get(fact.step as usize);
        fact.act == Act::Turn && frame.is_some_and(|frame| frame.joint == Some(Joint::After))
    };
    sv.acts.retain(|fact| !(turned(fact) && column == Some(Movement::Straight)));
    sv
}

/// Movement of the partner; a thing has none.
fn of_partner(reading: &Reading<'_>, account: &Account, partner: &Party) -> Option<Fact<Movement>> {
    let group = told(&partner.kind).map(Kind::group);
    if group == Some(KindGroup::Object) {
        return None;
    }
    let column = movement_column(reading);
    let movement = movement(reading, partner, column, "CP Pre-Crash Movement")
        .or_else(|| of_nothing_told(reading, account, partner, group));
    let passes = column == Some(Movement::Passing) || partner.did(Act::Pass);
    let from_side = matches!(
        told(&account.came_from),
        Some(Origin::Cross { .. } | Origin::Sidewalk { .. } | Origin::Driveway { .. })
    );
    let way = if passes { None } else { walked(reading, partner) };
    let crosses = match group {
        Some(KindGroup::OnFoot) => !passes && (partner.did(Act::Cross) || way.is_some() && from_side),
        Some(KindGroup::Cyclist) => way == Some(Walk::Crosswalk),
        _ => false,
    };
    if crosses {
        let movement = movement.map(|fact| Fact { value: Movement::NmCrossing, ..fact });
        return movement.or_else(|| Some(Fact::by_rule(Movement::NmCrossing, "who crosses on foot")));
    }
    let movement = match told(&partner.kind) {
        Some(Kind::Pedestrian | Kind::Wheelchair) => on_foot(partner, column, way, from_side),
        _ => movement?,
    };
    Some(by_way(reading, account, partner, movement))
}

/// Who is told to be thrown alone stood; who is told to do nothing drove on.
fn of_nothing_told(
    reading: &Reading<'_>,
    account: &Account,
    partner: &Party,
    group: Option<KindGroup>,
) -> Option<Fact<Movement>> {
    let drove = partner.acts.iter().any(|fact| matches!(fact.act, Act::Follow | Act::Turn | Act::Enter));
    if partner.did(Act::Pushed) && !drove {
        return Some(Fact::by_rule(Movement::Stopped, "who is told to be struck alone"));
    }
    let drives = matches!(group, Some(KindGroup::Car | KindGroup::Truck | KindGroup::Motorcycle | KindGroup::Cyclist));
    let strikes = reading.contacts.partner.is_some()
        && reading.contacts.first.is_some_and(|number| reading.story.frames[number].who == reading.contacts.partner);
    if drives && (account.came_from.is_some() || strikes) { drives_on() } else { None }
}

/// A movement of the partner held against the way from which it came.
fn by_way(reading: &Reading<'_>, account: &Account, partner: &Party, mut fact: Fact<Movement>) -> Fact<Movement> {
    let column = movement_column(reading);
    let origin = told(&account.came_from);
    let same_way = matches!(origin, Some(Origin::Behind | Origin::Beside { .. }));
    let oncoming = origin == Some(Origin::Opposite);
    let passed = passed_last(partner).filter(|_| same_way);
    if let (Movement::LeftTurn | Movement::RightTurn, Some(passed)) = (fact.value, passed) {
        fact = Fact { value: Movement::Passing, source: passed.source.clone() };
    } else if fact.value == Movement::Passing
        && oncoming
        && !(column == Some(Movement::Passing) && passes_another(reading))
    {
        fact.value = Movement::Straight;
    }
    // Who had left the kerb, and stood in a lane since then, enters no more.
    let before: Vec<Act> = partner.acts.iter().filter(|fact| !fact.after_contact).map(|fact| fact.act).collect();
    let left = before.iter().position(|act| *act == Act::PullOut);
    let stood = left.is_some_and(|left| before[left + 1..].iter().any(|act| act.stands()));
    if let (Movement::EnteringTraffic, true, true, Some(column)) = (fact.value, stood, same_way, column) {
        fact = Fact::of_column(column, "CP Pre-Crash Movement");
    }
    // Who comes along a crossing road changes no lanes.
    let moved_over = [Act::LaneChange, Act::Drift, Act::Swerve].into_iter().any(|act| partner.did(act));
    let across = account
        .came_from
        .as_ref()
        .is_some_and(|from| from.source.is_told() && matches!(from.value, Origin::Cross { .. }));
    if fact.value == Movement::ChangingLanes && !fact.source.is_told() && across && !moved_over {
        fact = drives_on().unwrap_or(fact);
    }
    if fact.value == Movement::Straight && same_way && drives_by(account, partner) {
        fact = Fact::by_rule(Movement::Passing, "who drives by one that stands");
    }
    if let (Movement::Straight, true, Some(column @ (Movement::WrongWay | Movement::CrossingIntoOpposingLane))) =
        (fact.value, oncoming, column)
    {
        fact.value = column;
    }
    let goes_on = matches!(fact.value, Movement::Straight | Movement::LaneDeparture | Movement::ChangingLanes);
    let over = || over_the_line(reading).or_else(|| into_its_lane(reading));
    if let (true, true, Some(source)) = (oncoming, goes_on, if oncoming { over() } else { None }) {
        fact = Fact { value: Movement::CrossingIntoOpposingLane, source };
    }
    fact
}

/// Who drives by one that stands, flank on flank, passes it.
fn drives_by(account: &Account, partner: &Party) -> bool {
    let side_on = |party: &Party| {
        let told: Vec<Z> = party.zones.iter().map(|zone| zone.value).collect();
        !told.is_empty()
            && told.iter().all(|zone| !matches!(zone, Z::Front | Z::Rear | Z::Top | Z::Bottom))
            && told.iter().any(|zone| matches!(zone, Z::Left | Z::Right))
    };
    let by_itself = partner
        .acts
        .iter()
        .filter(|fact| !fact.after_contact)
        .all(|fact| matches!(fact.act, Act::Follow | Act::Slow | Act::Accelerate | Act::SetOff));
    told(&account.sv.state).is_some_and(ContactState::stands)
        && account.door.is_none()
        && by_itself
        && side_on(&account.sv)
        && side_on(partner)
}

/// The words that bring the partner over the line between both directions, up to the contact.
fn over_the_line(reading: &Reading<'_>) -> Option<Source> {
    let actor = reading.contacts.partner?;
    let tokens = &reading.story.tokens;
    reading.before(actor).filter(|(_, frame)| frame.happened()).find_map(|(number, frame)| {
        let crosses = matches!(
            frame.act(),
            Some(Act::Drift | Act::Swerve | Act::Cross | Act::LaneChange | Act::LoseControl | Act::Follow | Act::Enter)
        );
        let (first, end) = reading.window(number);
        let line = (first..end).any(|at| {
            matches!(word(tokens, at), "centerline" | "centreline")
                || matches!(word(tokens, at), "center" | "yellow" | "dividing")
                    && word(tokens, at + 1).starts_with("line")
                || matches!(word(tokens, at), "opposite" | "opposing" | "oncoming")
                    && word(tokens, at + 1).starts_with("lane")
        });
        let over =
            (first..end).any(|at| matches!(tokens[at].text.as_str(), "over" | "across" | "crossed" | "crossing"));
        (crosses && line && over).then(|| reading.of(frame))
    })
}

/// The words that bring one who comes the other way to its left, and into the lane of the subject vehicle.
fn into_its_lane(reading: &Reading<'_>) -> Option<Source> {
    let actor = reading.contacts.partner?;
    let tokens = &reading.story.tokens;
    let over = |frame: &Frame| matches!(frame.act(), Some(Act::Drift | Act::Swerve | Act::LaneChange | Act::Enter));
    let mut moves = reading.before(actor).filter(|(_, frame)| frame.happened() && over(frame));
    let left = reading.before(actor).any(|(_, frame)| over(frame) && frame.side == Some(LeftRight::Left));
    let its_lane = |number: usize| {
        let (first, end) = reading.window(number);
        // "departed from its lane" is out of its own.
        let into =
            |at: usize| at > 0 && !matches!(word(tokens, at - 1), "from" | "of" | "left" | "leaving" | "departed");
        (first..end).any(|at| {
            word(tokens, at + 1) == "lane" && (word(tokens, at) == "'s" || word(tokens, at) == "its" && into(at))
        })
    };
    // "came over into its lane", and not "turned left and entered its lane".
    let (_, frame) = moves.find(|(number, _)| its_lane(*number))?;
    (left || frame.act() != Some(Act::Enter)).then(|| reading.of(frame))
}

/// Whether the partner goes round somebody else, up to the contact.
fn passes_another(reading: &Reading<'_>) -> bool {
    let Some(actor) = reading.contacts.partner else { return false };
    let passes = |frame: &crate::frame::Frame| frame.happened() && frame.act() == Some(Act::Pass);
    reading.before(actor).any(|(_, frame)| {
        passes(frame) && frame.object.is_some_and(|object| object != crate::world::SUBJECT && object != actor)
    })
}

/// The pass that came behind every turn.
fn passed_last(party: &Party) -> Option<&ActFact> {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact);
    let turned = before().filter(|fact| fact.act == Act::Turn).map(|fact| fact.step).max()?;
    before().find(|fact| fact.act == Act::Pass && fact.step > turned)
}

/// Ways that are not for vehicles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Walk {
    Crosswalk,
    Sidewalk,
}

/// On which of them the partner is told to be, up to the contact.
fn walked(reading: &Reading<'_>, partner: &Party) -> Option<Walk> {
    let actor = reading.contacts.partner?;
    let tokens = &reading.story.tokens;
    let named = |words: &[&str]| {
        reading.before(actor).filter(|(_, frame)| frame.happened()).any(|(number, _)| {
            let (first, end) = reading.window(number);
            (first..end).any(|at| {
                // "a crosswalk signal" is none.
                words.contains(&tokens[at].text.as_str()) && tokens.get(at + 1).is_none_or(|next| next.text != "signal")
            })
        })
    };
    let crossed = partner.acts.iter().any(|fact| fact.act == Act::Cross && words_of(fact).contains("crosswalk"));
    if crossed || named(&["crosswalk", "crosswalks"]) {
        Some(Walk::Crosswalk)
    } else {
        named(&["sidewalk"]).then_some(Walk::Sidewalk)
    }
}

/// What somebody on foot does who is not told to cross.
fn on_foot(partner: &Party, column: Option<Movement>, way: Option<Walk>, from_side: bool) -> Fact<Movement> {
    let of_feet = column.filter(|column| {
        matches!(
            column,
            Movement::NmCrossing
                | Movement::NmWaiting
                | Movement::NmAlongside
                | Movement::NmOnSidewalk
                | Movement::NmInRoadway
        )
    });
    let rule = "what somebody on foot does there";
    match (of_feet, way) {
        (Some(column), _) => Fact::of_column(column, "CP Pre-Crash Movement"),
        (None, _) if from_side || partner.did(Act::Enter) => Fact::by_rule(Movement::NmCrossing, rule),
        (None, Some(Walk::Sidewalk)) => Fact::by_rule(Movement::NmOnSidewalk, rule),
        (None, _) => Fact::by_rule(Movement::NmInRoadway, rule),
    }
}

fn words_of(fact: &ActFact) -> String {
    words(&fact.source)
}

/// The words of a source, written small.
fn words(source: &Source) -> String {
    match source {
        Source::Words { text, .. } => text.to_lowercase(),
        _ => String::new(),
    }
}

/// Movement of one side: of its state at the contact, of what it did last that says most, or of the column.
fn movement(reading: &Reading<'_>, party: &Party, column: Option<Movement>, name: &str) -> Option<Fact<Movement>> {
    if let (Some(ContactState::Reversing), Some(Movement::ParkingManeuver)) = (told(&party.state), column) {
        return Some(Fact::of_column(Movement::ParkingManeuver, name));
    }
    if let Some(of_state) = of_state(party) {
        return Some(of_state);
    }
    let course = Course { reading, party, column };
    let mut best: Option<(u8, Movement, &Source)> = None;
    for fact in party.acts.iter().filter(|fact| !fact.after_contact) {
        best = best.filter(|(_, known, source)| !course.has_done(*known, source, fact));
        let Some((weight, value)) = weight(fact, column) else { continue };
        // The last of those that say as much.
        if best.as_ref().is_none_or(|(known, ..)| weight >= *known) {
            best = Some((weight, value, &fact.source));
        }
    }
    // Who runs a red light comes along, and enters no traffic.
    let column = column.filter(|column| *column != Movement::EnteringTraffic || !party.did(Act::RunRed));
    match (best, column) {
        (Some((0, ..)) | None, Some(column)) if column != Movement::Stopped && column != Movement::Parked => {
            Some(Fact::of_column(column, name))
        }
        (Some((_, value, source)), _) => Some(Fact { value, source: source.clone() }),
        (None, Some(column)) => Some(Fact::of_column(column, name)),
        _ => None,
    }
}

/// Who stood or went backwards at the contact moves so.
fn of_state(party: &Party) -> Option<Fact<Movement>> {
    let state = party.state.as_ref()?;
    let value = match state.value {
        ContactState::Stopped => Movement::Stopped,
        ContactState::Parked => Movement::Parked,
        ContactState::Reversing => Movement::Backing,
        _ => return None,
    };
    Some(Fact { value, source: state.source.clone() })
}

/// What one side did, one act after the other.
struct Course<'a> {
    reading: &'a Reading<'a>,
    party: &'a Party,
    column: Option<Movement>,
}

impl<'a> Course<'a> {
    /// The frame that tells an act.
    fn frame_of(&self, fact: &ActFact) -> Option<&'a Frame> {
        self.reading.story.frames.get(fact.step as usize)
    }

    /// Whether who does this next has done with a movement that these words told.
    fn has_done(&self, movement: Movement, told: &Source, next: &ActFact) -> bool {
        let column = self.column;
        let approaches = || words_of(next).starts_with("approach");
        match (movement, next.act) {
            // Who goes on from a stop has done with going backwards; who "reversing, approached" it has not.
            (Movement::Backing, Act::SetOff | Act::Follow) => !approaches(),
            // So has who passes, and who turns where the column says so.
            (Movement::Backing, Act::Pass | Act::LaneChange) => true,
            (Movement::Backing, Act::Turn) => matches!(column, Some(Movement::LeftTurn | Movement::RightTurn)),
            // Who drives on has done with its turn.
            (Movement::LeftTurn | Movement::RightTurn, Act::Follow) => {
                !(self.keeps_on_turning(next) || approaches() && words(told).starts_with("turning"))
            }
            // "pulled into the parking lane, then swerved back": it parked no more.
            (Movement::ParkingManeuver, Act::Swerve | Act::PullOut | Act::SetOff | Act::Pass | Act::LaneChange) => {
                column != Some(Movement::ParkingManeuver)
            }
            // Who came out and then travels along has come out.
            (Movement::EnteringTraffic, Act::Follow) => {
                column != Some(Movement::EnteringTraffic) && words_of(next).starts_with("travel")
            }
            // Who changed lanes and then draws near is in its lane.
            (Movement::ChangingLanes, Act::Follow) => approaches() && !self.is_meanwhile(next),
            _ => false,
        }
    }

    /// "turned left and kept going": with its turn.
    fn keeps_on_turning(&self, next: &ActFact) -> bool {
        self.frame_of(next).is_some_and(|frame| {
            let word = |at: Option<usize>| at.map_or("", |at| self.reading.story.tokens[at].text.as_str());
            let on = |word: &str| ["kept", "keep", "continu"].iter().any(|stem| word.starts_with(stem));
            let turned = |other: &ActFact| other.act == Act::Turn && other.step < next.step;
            let turn = self.party.acts.iter().rev().find(|other| turned(other)).and_then(|turn| self.frame_of(turn));
            let near = turn.is_some_and(|turn| turn.sentence == frame.sentence);
            near && (on(word(Some(frame.first))) || on(word(frame.first.checked_sub(1))))
        })
    }

    /// "changed lanes as it approached": at the same time, in the sentence of the contact.
    fn is_meanwhile(&self, next: &ActFact) -> bool {
        let contact = self.reading.contacts.first.map(|number| self.reading.story.frames[number].sentence);
        let changed = |other: &&ActFact| other.act == Act::LaneChange && other.step < next.step;
        let change = self.party.acts.iter().rev().find(changed).and_then(|change| self.frame_of(change));
        self.frame_of(next).zip(change).is_some_and(|(near, change)| {
            near.joint == Some(Joint::While)
                && near.clause > change.clause
                && contact == Some(near.sentence)
                && near.sentence == change.sentence
        })
    }
}

/// "merged", "attempting a merge".
fn is_merge(words: &str) -> bool {
    words.starts_with("merg") || words.ends_with(" merge")
}

/// What an act says of the movement, and how much.
fn weight(fact: &ActFact, column: Option<Movement>) -> Option<(u8, Movement)> {
    Some(match (fact.act, fact.side) {
        (Act::Turn, Some(LeftRight::Left)) => (3, Movement::LeftTurn),
        (Act::Turn, Some(LeftRight::Right)) => (3, Movement::RightTurn),
        (Act::Turn, None) => match column {
            Some(Movement::LeftTurn) => (3, Movement::LeftTurn),
            Some(Movement::RightTurn) => (3, Movement::RightTurn),
            _ => return None,
        },
        (Act::UTurn, _) => (4, Movement::UTurn),
        (Act::Reverse, _) if column == Some(Movement::ParkingManeuver) => (4, Movement::ParkingManeuver),
        (Act::Reverse, _) => (4, Movement::Backing),
        (Act::LaneChange, _) if column == Some(Movement::EnteringTraffic) => (3, Movement::EnteringTraffic),
        (Act::LaneChange, _) if is_merge(&words_of(fact)) && column != Some(Movement::ChangingLanes) => {
            (3, Movement::Merging)
        }
        (Act::LaneChange, _) => (3, Movement::ChangingLanes),
        (Act::Pass, _) if column == Some(Movement::Passing) => (3, Movement::Passing),
        (Act::Pass, _) => (2, Movement::Passing),
        (Act::PullOut, _) => (3, Movement::EnteringTraffic),
        (Act::Park, _) => (3, Movement::ParkingManeuver),
        (Act::PullOver, _) => (1, Movement::ParkingManeuver),
        (Act::Swerve | Act::Drift, _) if column.is_none() => (1, Movement::LaneDeparture),
        (Act::WrongWay, _) => (4, Movement::WrongWay),
        (Act::Follow | Act::Slow | Act::SetOff | Act::Enter | Act::Accelerate | Act::RunRed | Act::RunStop, _) => {
            (0, Movement::Straight)
        }
        _ => return None,
    })
}
