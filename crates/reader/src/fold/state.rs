//! State of the subject vehicle at the contact: the words held against the column speed and the movement column.

use super::reasons::reasons;
use super::{Reading, nominal};
use crate::frame::Frame;
use crate::lexicon::{Form, Sense};
use crate::world::SUBJECT;
use recrash_model::account::{
    Account, Act, ContactState, Fact, KindGroup, Party, SpeedMeaning, StandReason, Standing, told,
};
use recrash_model::template::Movement;

/// State of the subject vehicle: the words, the column speed and the movement column, which each know a part of it.
pub(super) fn sv_state(reading: &Reading<'_>, account: &mut Account) {
    let clues = Clues::of(reading, account);
    let (value, words, zero, yields, to_stop) = (clues.state(), clues.words, clues.zero, clues.yields, clues.to_stop);
    if let (true, Some(ContactState::Moving)) = (to_stop, value) {
        slow_only(account);
    }
    if let Some(value) = value {
        let name = if zero { "SV Precrash Speed (MPH)" } else { "SV Pre-Crash Movement" };
        account.sv.state = Some(Fact::of_column(value, name));
        if value.stands() {
            account.sv.standing.get_or_insert_with(|| {
                let how = match words {
                    Some(ContactState::Moving) if yields => Standing::CameToStop,
                    Some(ContactState::Moving) => Standing::Stopping,
                    _ if nominal::is_in_turn(reading, SUBJECT) => Standing::CameToStop,
                    _ => Standing::FromTheStart,
                };
                Fact::of_column(how, name)
            });
            if account.sv.reasons.is_empty() {
                account.sv.reasons = reasons(reading, SUBJECT);
            }
        }
    }
    if told(&account.sv.state) == Some(ContactState::Parked) && account.sv.reasons.is_empty() {
        account.sv.reasons.push(Fact::by_rule(StandReason::Parked, "it was parked"));
    }
}

/// What words and columns tell of the state of the subject vehicle.
struct Clues<'a> {
    reading: &'a Reading<'a>,
    account: &'a Account,
    /// The state as the words tell it.
    words: Option<ContactState>,
    /// The movement column.
    column: Option<Movement>,
    /// The column speed is blank.
    no_speed: bool,
    /// The column speed is none.
    zero: bool,
    /// It rolls, by the column speed.
    rolls: bool,
    /// It "slowed to stop", by the words: a purpose.
    to_stop: bool,
    /// It was coming to a stop, by the words.
    stopping: bool,
    /// It was yielding, by the words, and no number says that it moved.
    yields: bool,
    /// It moved into something, by the words of the contact.
    moves: bool,
}

impl<'a> Clues<'a> {
    /// What is known before the state is settled.
    fn of(reading: &'a Reading<'_>, account: &'a Account) -> Self {
        let speed = reading.record.sv_speed_mps;
        let column = reading.record.sv_movement.known();
        let to_stop = slowed_to_stop(reading);
        let stopping = told(&account.sv.standing) == Some(Standing::Stopping) || to_stop;
        let rolls = speed.is_some_and(|speed| speed > if stopping { 0.3 } else { 0.6 });
        Self {
            reading,
            account,
            words: told(&account.sv.state),
            column,
            no_speed: speed.is_none(),
            zero: speed.is_some_and(|speed| speed < 0.1),
            // "accelerated up to 10 mph, then stopped": the column speed is that of before.
            rolls: rolls && !(column == Some(Movement::Stopped) && was_told_before(account)),
            to_stop,
            stopping,
            yields: speed.is_none() && yields_last(reading) && !told_speed(account, |mps| mps > 0.0),
            moves: moves_at_contact(reading),
        }
    }

    /// The state, where the columns know it better than the words.
    fn state(&self) -> Option<ContactState> {
        let stands_by_column = matches!(self.column, Some(Movement::Stopped | Movement::Parked));
        let Some(words) = self.words else { return self.untold() };
        match words {
            // It moved into something, and backwards by the column.
            _ if words != ContactState::Reversing && self.moves && self.column == Some(Movement::Backing) => {
                Some(ContactState::Reversing)
            }
            // In the lane, for passengers.
            ContactState::Parked => {
                let riders = self.account.sv.reasons.iter().any(|why| why.value == StandReason::PickupDropoff);
                (riders && self.column == Some(Movement::Stopped)).then_some(ContactState::Stopped)
            }
            // "came to a stop to yield to a truck": in its lane, whatever the column calls it.
            ContactState::Stopped if self.column == Some(Movement::Parked) => {
                (!waits_in_traffic(self.account)).then_some(ContactState::Parked)
            }
            ContactState::Stopped => (self.had_yet_to_stop() || self.had_gone_on()).then_some(ContactState::Moving),
            // "As it set off, a van struck it" is plain.
            ContactState::SettingOff => {
                let stood = stands_by_column && self.zero && !self.moves && !sets_off_at_contact(self.reading);
                stood.then_some(ContactState::Stopped)
            }
            ContactState::Moving if stands_by_column && !self.moves => self.had_come_to_stand(),
            ContactState::Moving | ContactState::Reversing => None,
        }
    }

    /// The columns alone.
    fn untold(&self) -> Option<ContactState> {
        match self.column {
            Some(Movement::Parked) => Some(ContactState::Parked),
            Some(Movement::Stopped) => Some(ContactState::Stopped),
            Some(Movement::Backing) => Some(ContactState::Reversing),
            _ if self.zero => Some(ContactState::Stopped),
            Some(_) => Some(ContactState::Moving),
            None => (self.rolls || self.moves).then_some(ContactState::Moving),
        }
    }

    /// Told to come to a stop, it was on its way to that.
    fn had_yet_to_stop(&self) -> bool {
        let unknown = self.stopping && self.no_speed;
        match self.column {
            // "was struck while stopping for a light", and no number says more.
            None | Some(Movement::Straight) if unknown && stops_at_contact(self.reading) => true,
            // "was coming to a stop when a van struck it": the column tells what it was about.
            None | Some(Movement::Straight | Movement::Stopped) if unknown => {
                !told_speed(self.account, |mps| mps == 0.0) && (is_stopping_when(self.reading) || self.moves)
            }
            _ => false,
        }
    }

    /// Told to stand, it rolled or drove in numbers.
    fn had_gone_on(&self) -> bool {
        let held = || self.account.sv.acts.iter().any(|fact| fact.act == Act::Hold && !fact.after_contact);
        let drives = self.reading.record.sv_speed_mps.is_some_and(|speed| speed >= DRIVES_MPS);
        let column = self.column.filter(|movement| *movement != Movement::Stopped);
        // Told to come to a stop, and still rolling in numbers.
        self.rolls && (self.stopping || self.moves) && !held()
            // It moved into something.
            || self.rolls && self.moves && column.is_some()
            // It stopped, drove on, and both columns say so.
            || drives && column.is_some_and(|movement| movement != Movement::Parked) && !holds_at_contact(self.reading)
    }

    /// Told to move, and standing by the column: it had come to that.
    fn had_come_to_stand(&self) -> Option<ContactState> {
        // "was operating in autonomous mode, yielding to traffic, when a van struck it", and by the column it stood.
        if self.yields && self.column == Some(Movement::Stopped) {
            return Some(ContactState::Stopped);
        }
        // "had pulled over", and no number says more.
        let last = self.account.sv.acts.iter().rfind(|fact| !fact.after_contact);
        if self.no_speed && last.is_some_and(|fact| matches!(fact.act, Act::PullOver | Act::Park)) {
            let parked = self.column == Some(Movement::Parked);
            return Some(if parked { ContactState::Parked } else { ContactState::Stopped });
        }
        // Slowing in words, standing in numbers.
        (self.zero && !turns_meanwhile(self.reading)).then_some(ContactState::Stopped)
    }
}

/// Whether the last that is told of the subject vehicle is that it "slowed to stop", a purpose.
fn slowed_to_stop(reading: &Reading<'_>) -> bool {
    let acts = reading.before(SUBJECT).filter(|(_, frame)| frame.happened() && frame.act().is_some());
    acts.last().is_some_and(|(_, frame)| {
        let words: Vec<&str> =
            reading.story.tokens[frame.first..frame.end].iter().map(|token| token.text.as_str()).collect();
        let slows = words.first().is_some_and(|word| word.starts_with("slow"));
        frame.act() == Some(Act::Stop) && slows && words.ends_with(&["to", "stop"])
    })
}

/// It slowed, and did not come to stand.
fn slow_only(account: &mut Account) {
    let mut acts = account.sv.acts.iter_mut().rev();
    if let Some(stop) = acts.find(|fact| fact.act == Act::Stop && !fact.after_contact) {
        stop.act = Act::Slow;
    }
    account.sv.standing = None;
}

/// Whether the words tell the column's speed of the way there. [m/s]: as near as a report rounds.
fn was_told_before(account: &Account) -> bool {
    let column = account.sv.speeds.iter().find(|speed| !speed.source.is_told()).map(|speed| speed.value.mps);
    let before = |mps: f64| {
        account.sv.speeds.iter().any(|speed| {
            speed.source.is_told()
                && speed.value.meaning == SpeedMeaning::Approach
                && (speed.value.mps - mps).abs() < ROUNDED_MPS
        })
    };
    column.is_some_and(before)
}

/// Speeds that are this near are the same one: half a mile per hour. [m/s]
const ROUNDED_MPS: f64 = 0.25;

/// Who is this fast at the contact does not stand. [m/s]
const DRIVES_MPS: f64 = 2.0;

/// A column speed of one that stands by its words, and by the movement column, is that of its way there.
pub(super) fn sv_speed(account: &mut Account) {
    let stands = account.sv.state.as_ref().is_some_and(|state| state.source.is_told() && state.value.stands());
    for speed in account.sv.speeds.iter_mut().filter(|speed| stands && !speed.source.is_told()) {
        if speed.value.mps >= DRIVES_MPS {
            speed.value.meaning = SpeedMeaning::Approach;
        }
    }
}

/// State of a partner that had come to a stop, by its words, and touches one that stands: it went on, or had yet to stop.
pub(super) fn partner_state(reading: &Reading<'_>, account: &mut Account) {
    // It was parked, and backs by the column; or its rear moved into who stands.
    let backs = reading.record.cp_movement.known() == Some(Movement::Backing);
    let rear_alone = |party: &Party| !party.zones.is_empty() && party.zones.iter().all(|zone| zone.value.is_rear());
    if let Some(partner) = account.partner.as_mut().filter(|partner| backs && rear_alone(partner))
        && told(&partner.state).is_some_and(ContactState::stands)
        && account.door.is_none()
    {
        partner.state = Some(Fact::of_column(ContactState::Reversing, "CP Pre-Crash Movement"));
        (partner.standing, partner.reasons) = (None, Vec::new());
        return;
    }
    let stands = told(&account.sv.state).is_some_and(ContactState::stands) && account.door.is_none();
    let (Some(partner), true) = (&mut account.partner, stands) else { return };
    let drives = told(&partner.kind).is_some_and(|kind| matches!(kind.group(), KindGroup::Car | KindGroup::Truck));
    let strikes = reading.contacts.first.is_some_and(|number| {
        reading.contacts.partner.is_some() && reading.story.frames[number].who == reading.contacts.partner
    });
    let stopped = told(&partner.state) == Some(ContactState::Stopped);
    if !(drives && strikes && stopped) || partner.did(Act::Pushed) || partner.did(Act::Park) {
        return;
    }
    let came = partner.did(Act::Follow) && partner.did(Act::Stop) || partner.did(Act::Hold);
    let value = if came { ContactState::SettingOff } else { ContactState::Moving };
    partner.state = Some(Fact::by_rule(value, "of two that touch one moves"));
    (partner.standing, partner.reasons) = (None, Vec::new());
}

/// Whether the sentence of the contact says that the subject vehicle stands.
fn holds_at_contact(reading: &Reading<'_>) -> bool {
    let Some(contact) = reading.contacts.first else { return false };
    let sentence = reading.story.frames[contact].sentence;
    reading.before(SUBJECT).any(|(_, frame)| frame.sentence == sentence && frame.act() == Some(Act::Hold))
}

/// Whether the sentence of the contact says last of the subject vehicle that it was about to stop.
fn stops_at_contact(reading: &Reading<'_>) -> bool {
    let Some(contact) = reading.contacts.first else { return false };
    let sentence = reading.story.frames[contact].sentence;
    let last = reading.before(SUBJECT).filter(|(_, frame)| frame.happened()).last();
    last.is_some_and(|(number, frame)| {
        let while_it = number > contact && frame.joint == Some(crate::chunk::Joint::While);
        frame.sentence == sentence && while_it && frame.act() == Some(Act::Stop)
    })
}

/// Whether the sentence of the contact tells last of the subject vehicle that it "was coming to a stop when" the other came.
fn is_stopping_when(reading: &Reading<'_>) -> bool {
    let Some(contact) = reading.contacts.first else { return false };
    let (frames, tokens) = (&reading.story.frames, &reading.story.tokens);
    let last = reading.before(SUBJECT).take_while(|(number, _)| *number < contact);
    let last = last.filter(|(_, frame)| frame.happened() && frame.act().is_some()).last();
    last.is_some_and(|(_, frame)| {
        let word = |back: usize| frame.first.checked_sub(back).map_or("", |at| tokens[at].text.as_str());
        let was = (0..3).any(|back| word(back) == "was") || (word(2), word(1)) == ("process", "of");
        let between = frame.end..frames[contact].first.max(frame.end);
        frame.act() == Some(Act::Stop)
            && frame.form == Form::Ing
            && was
            && frame.sentence == frames[contact].sentence
            && tokens[between].iter().any(|token| token.text == "when")
    })
}

/// Whether the last that is told of the subject vehicle before the contact is that it "was yielding".
fn yields_last(reading: &Reading<'_>) -> bool {
    let tells = |frame: &Frame| frame.happened() && (frame.act().is_some() || frame.sense == Sense::Yield);
    let contact = reading.contacts.first.unwrap_or(0);
    let before = reading.before(SUBJECT).filter(|(number, frame)| *number < contact && tells(frame));
    before.last().is_some_and(|(_, frame)| frame.sense == Sense::Yield && frame.form == Form::Ing)
}

/// Whether somebody is told to stand for others on the road, or for a light or a sign, and not for its passengers.
fn waits_in_traffic(account: &Account) -> bool {
    let rides = account.sv.reasons.iter().any(|reason| reason.value == StandReason::PickupDropoff);
    let waits = |reason: &Fact<StandReason>| {
        use StandReason as R;
        let traffic = matches!(
            reason.value,
            R::Yield | R::Queue | R::RedLight | R::StopSign | R::LeadVehicle | R::BlockedJunction
        );
        traffic && reason.source.is_told()
    };
    !rides && account.sv.reasons.iter().any(waits)
}

/// Whether words tell such a speed of the subject vehicle.
fn told_speed(account: &Account, of: impl Fn(f64) -> bool) -> bool {
    account.sv.speeds.iter().any(|speed| speed.value.meaning != SpeedMeaning::Posted && of(speed.value.mps))
}

/// Whether the sentence of the contact says that the subject vehicle sets off.
fn sets_off_at_contact(reading: &Reading<'_>) -> bool {
    let Some(contact) = reading.contacts.first else { return false };
    let sentence = reading.story.frames[contact].sentence;
    reading.before(SUBJECT).any(|(_, frame)| {
        frame.sentence == sentence
            && frame.happened()
            && matches!(frame.act(), Some(Act::SetOff | Act::Follow | Act::Enter | Act::Turn))
    })
}

/// Whether the last that is told of the subject vehicle is that the other came "as it began to turn".
fn turns_meanwhile(reading: &Reading<'_>) -> bool {
    let acts = reading.before(SUBJECT).filter(|(_, frame)| frame.happened() && frame.act().is_some());
    acts.last().is_some_and(|(_, frame)| {
        frame.act() == Some(Act::Turn) && frame.joint == Some(crate::chunk::Joint::While) && !frame.described
    })
}

/// Whether the words of the contact's own clause say that the subject vehicle moved into something.
pub(super) fn moves_at_contact(reading: &Reading<'_>) -> bool {
    reading.contacts.first.is_some_and(|number| reading.story.frames[number].who == Some(SUBJECT))
}
