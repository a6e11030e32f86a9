//! The account, folded from the event frames and held against the columns.

mod about_to;
mod across;
mod acts;
mod ahead;
mod astride;
mod begun;
mod contact;
mod controls;
mod counted;
mod driver;
mod entry;
mod flashback;
mod hides;
mod lanes;
mod manner;
mod movement;
mod nobody;
mod nominal;
mod open;
mod order;
mod origin;
mod party;
mod picture;
mod place;
mod reasons;
mod role;
mod scenario;
mod sides;
mod speeds;
mod standing;
mod state;
mod striker;
mod touched;
mod types;
mod undone;
mod whereabouts;

use crate::chunk::Piece;
use crate::frame::{Frame, Story, looks_back, story};
use crate::lexicon::{Form, Lexicon, Meaning, Sense};
use crate::token::is_crash_noun;
use crate::world::{Actor, Own, SUBJECT, is_no_passenger_vehicle};
use contact::Contacts;
use recrash_model::account::{
    ACCOUNT_FORMAT, Account, Act, ContactState, Contradiction, Fact, Kind, KindGroup, LaneWord, Origin, Other, Party,
    Source, Speed, SpeedMeaning, Striker, told,
};
use recrash_model::incident::Incident;
use recrash_model::kinds::PartnerKind;
use recrash_model::record::{Coded, CrashRecord, Severity};
use recrash_model::scenario::Author;
use recrash_model::zones::ContactZone;
use std::ops::Range;

/// Everything the fold looks at.
pub(crate) struct Reading<'a> {
    pub text: &'a str,
    pub record: &'a CrashRecord,
    pub story: Story,
    pub contacts: Contacts,
    /// Sentences behind that of the contact that tell what had been before.
    pub back: Range<usize>,
}

impl Reading<'_> {
    /// Words of the narrative, by tokens.
    pub fn words(&self, first: usize, end: usize) -> Source {
        let tokens = &self.story.tokens;
        let (start, end) = (tokens[first].start, tokens[end.max(first + 1) - 1].end);
        Source::Words { start, end, text: self.text[start..end].to_owned() }
    }

    /// The words of a frame.
    pub fn of(&self, frame: &Frame) -> Source {
        self.words(frame.first, frame.end)
    }

    /// A fact of these tokens.
    pub fn told<T>(&self, value: T, first: usize, end: usize) -> Fact<T> {
        Fact { value, source: self.words(first, end) }
    }

    /// Who does what a frame tells: "the wheel of a van came off and rolled over" is told of the wheel.
    pub fn doer(&self, frame: &Frame) -> Option<Actor> {
        let loose = |actor: &Actor| {
            let kind = self.story.world.actors[*actor].kind;
            matches!(kind, Some(Kind::LooseWheel | Kind::Debris | Kind::Cargo | Kind::Object))
        };
        // "A panel on the rear of the van fell off": no part of the van that still is one.
        let part = frame.with.is_some() && frame.act() == Some(Act::Fall);
        let comes_off = matches!(frame.act(), Some(Act::Roll | Act::Fall))
            && (frame.who == Some(SUBJECT) || part && frame.who.is_some());
        self.contacts.partner.filter(loose).filter(|_| comes_off).or(frame.who)
    }

    /// The token behind all that tells of the time up to the contact.
    pub fn until(&self) -> usize {
        let contact = self.contacts.first.map(|number| self.story.frames[number].sentence);
        let last = contact.map(|sentence| sentence.max(self.back.end.saturating_sub(1)));
        last.map_or(usize::MAX, |sentence| self.story.sentences[sentence].end)
    }

    /// Whether a frame comes after the contact.
    pub fn is_after(&self, number: usize) -> bool {
        let frame = &self.story.frames[number];
        let Some(contact) = self.contacts.first else { return false };
        let at = &self.story.frames[contact];
        // "Before it set off, a van struck it".
        let until = frame.sentence == at.sentence
            && frame.joint == Some(crate::chunk::Joint::Before)
            && (at.joint != frame.joint || at.sense == Sense::ContactMade)
            && !frame.is_contact();
        if until && frame.progress != crate::lexicon::Progress::Wished {
            return true;
        }
        if self.is_left_behind(number) {
            return true;
        }
        if number <= contact
            || self.back.contains(&frame.sentence)
            || self.is_told_back(frame)
            || self.is_in_vain(frame)
            || self.avoids_what_was_met(number)
            || frame.sentence > at.sentence && frame.who != Some(SUBJECT) && self.had_before(frame.sentence)
            || frame.looks_back
            || self.is_of_having(frame) && frame.sentence == at.sentence
            || self.had_been_at(frame)
            || self.had_attempted(frame, contact)
            || frame.aside && frame.sentence == at.sentence
        {
            return false;
        }
        // "made contact while passing": at the same time.
        let between = at.end.min(frame.first)..frame.first;
        let simultaneous = frame.sentence == at.sentence
            && frame.joint == Some(crate::chunk::Joint::While)
            && frame.clause > at.clause
            && self.story.tokens[between].iter().any(|token| {
                matches!(token.text.as_str(), "while" | "as" | "when" | "moment" | "instant" | "second" | "time")
            })
            && !self.is_of_a_sequel(number, contact);
        // "It hit a tire, which then went under it".
        let goes_on = frame.first > 0 && self.story.tokens[frame.first - 1].text == "then" && number > contact;
        if goes_on && frame.described && frame.sentence == at.sentence {
            return true;
        }
        // "It hit the vehicle, which was stopped": told again, with what was so then.
        let retold = frame.act() == Some(Act::Hold)
            && (frame.described || frame.joint == Some(crate::chunk::Joint::While))
            && self.story.frames[number.saturating_sub(2)..number].iter().any(|other| {
                other.sentence == frame.sentence
                    && other.is_contact()
                    && [(other.who, other.object), (other.object, other.who)].contains(&(at.who, at.object))
            });
        !(simultaneous || retold || frame.described && frame.sentence == at.sentence)
    }

    /// "struck it, having failed to stop": told of the time before.
    fn is_of_having(&self, frame: &Frame) -> bool {
        let word = |back: usize| frame.first.checked_sub(back).map_or("", |at| self.story.tokens[at].text.as_str());
        (1..4).any(|back| word(back) == "having" && word(back + 1) == ",")
    }

    /// "A van struck it and then left the scene", told as the headline: what came of it.
    fn is_left_behind(&self, number: usize) -> bool {
        let frame = &self.story.frames[number];
        let touches = |other: &Frame| other.sentence == frame.sentence && other.is_contact();
        frame.act() == Some(Act::Leave) && self.story.frames[..number].iter().any(touches)
    }

    /// "was struck by a van attempting to pass it": what it had been about.
    fn had_attempted(&self, frame: &Frame, contact: usize) -> bool {
        let at = &self.story.frames[contact];
        let from = at.end.min(frame.first);
        let mut words = self.story.tokens[from..frame.first].iter().map(|token| token.text.as_str());
        let attempts = words.next().is_some_and(|word| matches!(word, "attempting" | "trying" | "seeking"));
        attempts && frame.sentence == at.sentence && frame.form == Form::Base
    }

    /// "It was struck. It had been braking for a dog": told of the time before, of whomever.
    fn had_been_at(&self, frame: &Frame) -> bool {
        let word = |back: usize| frame.first.checked_sub(back).map_or("", |at| self.story.tokens[at].text.as_str());
        let going = !matches!(frame.act(), None | Some(Act::Hold | Act::Leave | Act::Pushed));
        going && frame.form == crate::lexicon::Form::Ing && (word(2), word(1)) == ("had", "been")
    }

    /// "struck it, then drove off when the light changed": the clause belongs to what came of the crash.
    fn is_of_a_sequel(&self, number: usize, contact: usize) -> bool {
        let (frames, at) = (&self.story.frames, &self.story.frames[contact]);
        let sequel = |frame: &Frame| {
            frame.clause > at.clause
                && frame.clause < frames[number].clause
                && frame.joint == at.joint
                && frame.form != crate::lexicon::Form::Ing
                && frame.act().is_some()
                && frame.who.is_some()
        };
        frames[contact + 1..number].iter().any(sequel)
    }

    /// Whether a sentence behind the crash tells what had been before it: "The other car had run the light".
    pub fn had_before(&self, sentence: usize) -> bool {
        let tokens = &self.story.tokens;
        self.story.frames.iter().find(|frame| frame.sentence == sentence && !frame.aside).is_some_and(|frame| {
            let had = frame.first > 0 && tokens[frame.first - 1].text == "had";
            let goes_on = matches!(
                frame.act(),
                Some(Act::Leave | Act::Pushed | Act::Hold | Act::Stop | Act::PullOver | Act::Park)
            );
            had && frame.act().is_some() && !goes_on && !frame.described
        })
    }

    /// "It braked, but the contact was unavoidable", told behind the contact.
    fn is_in_vain(&self, frame: &Frame) -> bool {
        let range = self.story.sentences[frame.sentence];
        let words: Vec<&str> =
            self.story.tokens[range.first..range.end].iter().map(|token| token.text.as_str()).collect();
        let has = |word: &str| words.contains(&word);
        let in_vain = has("unavoidable")
            || has("avoid") && ["unable", "not", "late", "impossible"].into_iter().any(has)
            || has("still") && has("occurred");
        // Of a second one it is told what came of the first.
        let second = ["second", "another", "further", "secondary"].into_iter().any(has);
        in_vain && !second && matches!(frame.act(), Some(Act::Slow | Act::Swerve | Act::Drift))
    }

    /// "It struck a crate in the lane. A van in front of it swerved to avoid the crate": the van had come there first.
    fn avoids_what_was_met(&self, number: usize) -> bool {
        let (frames, tokens) = (&self.story.frames, &self.story.tokens);
        let frame = &frames[number];
        let Some(partner) = self.contacts.partner.filter(|_| frame.who.is_some_and(|who| who != SUBJECT)) else {
            return false;
        };
        let thing = self.story.world.actors[partner].kind.map(Kind::group);
        let lies = matches!(thing, Some(KindGroup::Object | KindGroup::Animal));
        let first = self.story.sentences[frame.sentence].first;
        let then = tokens[first..frame.first].iter().any(|token| matches!(token.text.as_str(), "then" | "after"));
        let avoids = |other: &Frame| {
            other.sentence == frame.sentence
                && other.object == Some(partner)
                && tokens[other.first].text.starts_with("avoid")
        };
        let mut behind = frames[number + 1..].iter().take(2);
        // "kept it from changing lanes to avoid it": nobody did.
        let did = frame.form != Form::Ing && frame.happened();
        lies && !then && did && frame.who != Some(partner) && frame.act().is_some() && behind.any(avoids)
    }

    /// "Prior to the collision, it came to a stop", told behind the collision; and the sentences behind that one, up to those that name the
    /// collision again.
    fn is_told_back(&self, frame: &Frame) -> bool {
        let names = |sentence: usize| {
            let range = self.story.sentences[sentence];
            (range.first..range.end).filter(|&at| is_crash_noun(self.story.word(at))).count()
        };
        let touched =
            |sentence: usize| self.story.frames.iter().any(|frame| frame.sentence == sentence && frame.is_contact());
        let mut back = (0..frame.sentence).rev().take_while(|&before| names(before + 1) == 0 && !touched(before + 1));
        let begun = back.any(|sentence| self.looks_back_from_crash(sentence) && names(sentence) == 1);
        self.looks_back_from_crash(frame.sentence) || begun && frame.act() != Some(Act::Leave)
    }

    /// Whether a sentence begins with "prior to the collision".
    pub fn looks_back_from_crash(&self, sentence: usize) -> bool {
        let sentence = self.story.sentences[sentence];
        looks_back(&self.story.tokens[sentence.first..sentence.end])
    }

    /// Frames of somebody up to the contact.
    pub fn before(&self, actor: Actor) -> impl Iterator<Item = (usize, &Frame)> {
        self.story
            .frames
            .iter()
            .enumerate()
            .filter(move |(number, frame)| frame.who == Some(actor) && !self.is_after(*number))
    }

    /// Whether somebody did this before the contact.
    pub fn did(&self, actor: Actor, act: Act) -> bool {
        self.before(actor).any(|(_, frame)| frame.happened() && frame.act() == Some(act))
    }

    /// The tokens that belong to a frame: up to the next frame of somebody else, or the end of the sentence.
    pub fn window(&self, number: usize) -> (usize, usize) {
        let frames = &self.story.frames;
        let frame = &frames[number];
        let sentence = self.story.sentences[frame.sentence];
        let next = frames[number + 1..]
            .iter()
            .find(|next| {
                next.sentence == frame.sentence
                    && !next.aside
                    && next.who.is_some()
                    && next.who != frame.who
                    && next.first > frame.first
            })
            .map_or(sentence.end, |next| next.first);
        (frame.first, next.max(frame.end).min(sentence.end))
    }
}

/// The account of an incident; `None` where no narrative of it can be read.
pub fn account(incident: &Incident) -> Option<Account> {
    let report = incident.spoken()?;
    let record = &report.record;
    let text = record.narrative.as_str();
    let (make, company) = (own_make(record), company(record));
    let partner = record.partner.known().and_then(partner_word);
    let own =
        Own { kind: own_kind(record), make: make.as_deref(), company: &company, vehicle: &record.vehicle, partner };
    let mut story = story(text, own);
    let contacts = Contacts::find(&story, record);
    let of_first = contacts.of_second.then(|| without_contact(record));
    let record = of_first.as_ref().unwrap_or(record);
    flashback::stops_too_late(&mut story, &contacts);
    begun::apply(&mut story);
    let back = flashback::told_back(&story, &contacts);
    let reading = Reading { text, record, story, contacts, back };
    let own_rider = hurts_its_own_rider(&reading);
    let mut account = drafted(&reading, incident, &report.text_hash, own_rider);
    if let Some(partner) = &mut account.partner {
        across::settle(&reading, &mut account.sv, partner);
    }
    party::columns(&reading, &mut account, own_rider);
    touched::keep_damaged_side(&reading, &mut account.sv.zones);
    // A gate that swings open is no door.
    let kind = account.partner.as_ref().and_then(|partner| told(&partner.kind));
    let is_thing = kind.is_some_and(|kind| kind.group() == KindGroup::Object && kind != Kind::Door);
    account.door = account.door.filter(|_| !is_thing);
    account.came_from = origin::came_from(&reading, &account);
    party::front_by_column(&reading, &mut account);
    party::flank_by_column(&reading, &mut account);
    if let (Some(lane), Some(partner)) = (open::oncoming_lane(&reading, &account), &mut account.partner) {
        partner.lane = Some(lane);
    }
    along_the_sidewalk(&mut account);
    movement::movements(&reading, &mut account);
    hold_against_picture(&reading, &mut account);
    acts::move_away(&mut account);
    account.ahead = origin::ahead(&reading, &account);
    account.striker = striker::striker(&reading, &account);
    account.crash_type = types::crash_type(&reading, &account);
    account.role = role::role(&reading, &account);
    account.order = order::order(&account);
    account.first_contact = types::first_contact(&reading, &account);
    account.scenario = scenario::scenario(&account);
    account.matrix = scenario::matrix(&account);
    account.contradictions.extend(contradictions(&account, record));
    party::refine(&mut account.sv.zones, &record.sv_zones, "SV Contact Area");
    if let Some(partner) = &mut account.partner {
        party::refine(&mut partner.zones, &record.cp_zones, "CP Contact Area");
    }
    Some(account)
}

/// The account as far as the words tell it by themselves.
fn drafted(reading: &Reading<'_>, incident: &Incident, text_hash: &str, own_rider: bool) -> Account {
    Account {
        format: ACCOUNT_FORMAT.to_owned(),
        incident: incident.id.clone(),
        report: reading.record.id.clone(),
        reports: incident.references(),
        text_hash: text_hash.to_owned(),
        words: words_of(&reading.story),
        crash_type: None,
        role: None,
        striker: None,
        scenario: None,
        matrix: None,
        first_contact: None,
        place: place::place(reading),
        sv: party::party(reading, SUBJECT),
        partner: reading.contacts.partner.filter(|_| !own_rider).map(|actor| party::party(reading, actor)),
        came_from: None,
        ahead: None,
        order: None,
        driver: driver::driver(reading),
        others: others(reading),
        door: door(reading),
        injury: injury(reading),
        damage: None,
        partner_left: left(reading),
        contradictions: Vec::new(),
        author: Author::Rules,
    }
}

/// Another origin where that of the words makes an impossible picture of zones and movements.
fn hold_against_picture(reading: &Reading<'_>, account: &mut Account) {
    let Some(origin) = picture::settle(account) else { return };
    if let Some(told) = account.came_from.take().filter(|told| told.source.is_told()) {
        account.contradictions.push(Contradiction {
            about: "came_from".to_owned(),
            kept: format!("{}, by zones and movements", origin.value.words()),
            against: format!("{} in words", told.value.words()),
        });
    }
    account.came_from = Some(origin);
    movement::movements(reading, account);
}

/// A record without what its columns tell of the contact.
fn without_contact(record: &CrashRecord) -> CrashRecord {
    CrashRecord {
        partner: Coded::Blank,
        cp_movement: Coded::Blank,
        sv_zones: Vec::new(),
        cp_zones: Vec::new(),
        sv_speed_mps: None,
        ..record.clone()
    }
}

/// Who comes across from a sidewalk along which it went is in no lane of the road; a rider along that of the crossing road comes over the
/// crosswalk.
fn along_the_sidewalk(account: &mut Account) {
    let along = matches!(
        told(&account.came_from),
        Some(Origin::Behind | Origin::Ahead | Origin::Beside { .. } | Origin::Opposite)
    );
    let across = matches!(told(&account.came_from), Some(Origin::Cross { .. }));
    let rides =
        |kind: Kind| kind.group() == KindGroup::Cyclist || matches!(kind, Kind::ScooterRider | Kind::Skateboarder);
    let rides = account.partner.as_ref().and_then(|partner| told(&partner.kind)).is_some_and(rides);
    if let Some(partner) = account.partner.as_mut().filter(|_| !(along || across && rides)) {
        partner.lane = partner.lane.take().filter(|lane| lane.value != LaneWord::Sidewalk);
    }
}

/// Works out again what follows from the other facts of an account, where somebody else has read some of them.
pub fn refold(account: &mut Account) {
    account.scenario = scenario::scenario(account);
    account.matrix = scenario::matrix(account);
}

/// What the reader calls the road user that the column names.
fn partner_word(kind: PartnerKind) -> Option<&'static str> {
    Some(match kind {
        PartnerKind::PassengerCar => "car",
        PartnerKind::Suv => "suv",
        PartnerKind::Van => "van",
        PartnerKind::PickupTruck => "pickup",
        PartnerKind::HeavyTruck => "truck",
        PartnerKind::Bus => "bus",
        PartnerKind::Motorcycle => "motorcycle",
        PartnerKind::Cyclist => "bicyclist",
        PartnerKind::Pedestrian | PartnerKind::OtherNonMotorist => "pedestrian",
        PartnerKind::Animal => "animal",
        PartnerKind::FirstResponder | PartnerKind::FixedObject => return None,
    })
}

/// Makes of large trucks only.
const TRUCK_MAKES: [&str; 6] = ["peterbilt", "freightliner", "kenworth", "international", "mack", "navistar"];

/// Kind of the subject vehicle, by its make, where that makes trucks or shuttles only, or by its model, which some call a shuttle.
fn own_kind(record: &CrashRecord) -> Option<Kind> {
    let vehicle = record.vehicle.to_lowercase();
    if TRUCK_MAKES.iter().any(|make| vehicle.contains(make)) || vehicle.contains("volvo vnl") {
        return Some(Kind::SemiTrailerTruck);
    }
    if ["sienna", "pacifica"].iter().any(|model| vehicle.contains(model)) {
        return Some(Kind::Minivan);
    }
    // Whole words: "Autonomous" is no Autonom.
    let shuttle = ["navya", "olli", "easymile", "palette", "autonom", "ohmio"];
    vehicle.split(|c: char| !c.is_alphanumeric()).any(|word| shuttle.contains(&word)).then_some(Kind::Bus)
}

/// The first word of the name of the company that reports, written small.
fn company(record: &CrashRecord) -> String {
    let name: String = record.entity.chars().take_while(|c| c.is_alphanumeric()).collect();
    name.to_lowercase()
}

/// The first word of the company's name, where the vehicle is called by it: "the Volvo".
fn own_make(record: &CrashRecord) -> Option<String> {
    let name = company(record);
    record.vehicle.to_lowercase().contains(&name).then_some(name).filter(|name| !name.is_empty())
}

fn words_of(story: &Story) -> u32 {
    let told = story.sentences.iter().zip(&story.standing).filter(|(_, standing)| !**standing);
    told.map(|(sentence, _)| (sentence.end - sentence.first) as u32).sum()
}

/// "was in a collision involving a passenger of the AV": who rode in it, and nobody whom it met.
fn hurts_its_own_rider(reading: &Reading<'_>) -> bool {
    let story = &reading.story;
    let company = company(reading.record);
    let own = |at: usize| {
        let rider =
            matches!(story.word(at), "passenger" | "occupant" | "rider") && matches!(story.word(at + 1), "of" | "in");
        rider
            && story.word(at + 2) == "the"
            && (["av", "ego", "subject", "shuttle"].contains(&story.word(at + 3)) || story.word(at + 3) == company)
    };
    story.frames.iter().any(|frame| frame.sense == Sense::Headline && (frame.first..frame.end + 3).any(own))
}

/// Everybody else who is in the story up to the contact.
fn others(reading: &Reading<'_>) -> Vec<Other> {
    let story = &reading.story;
    // "It was rear-ended. A bus came over. A passenger vehicle struck its rear": the bus was not who is told of first.
    let retold = reading.contacts.retold.filter(|&retold| {
        let passenger = reading.contacts.partner.is_some_and(|partner| story.world.actors[partner].passenger);
        !(passenger && story.world.actors[retold].kind.is_some_and(is_no_passenger_vehicle))
    });
    let is_partner = |actor| [reading.contacts.partner, retold].contains(&Some(actor));
    let mut all = Vec::new();
    for (actor, known) in story.world.actors.iter().enumerate().skip(1) {
        let (Some(kind), false) = (known.kind, is_partner(actor) || known.announced || known.towed_by.is_some()) else {
            continue;
        };
        let acts = acts::acts(reading, actor);
        // "made contact with one of the tires": the others went with it.
        let of_partner =
            reading.contacts.partner.is_some_and(|partner| story.world.actors[partner].group == Some(actor));
        let lively = kind.group() != KindGroup::Object || !acts.is_empty() && !of_partner;
        let (first, end) = known.kind_tokens.unwrap_or((0, 1));
        if !lively || known.mentions == 0 || kind == Kind::Curb {
            continue;
        }
        let touch = reading.contacts.with_partner(story, actor);
        let touched_partner = touch.is_some();
        let again = known.sentence.is_some_and(|last| first < story.sentences[last].first);
        let nobody = nobody::is_nobody(reading, (first, end), &acts, again)
            && !nobody::had_been_there(reading, actor, (first, end))
            || acts.is_empty() && nobody::is_named_before(reading, actor, kind)
            || nobody::is_one_of_the_two(reading, (actor, kind), (first, end), &acts)
            || nobody::is_remark(reading, (first, end), &acts)
            || nobody::is_one_of_those(known, &acts)
            || known.mentions == 1 && nobody::is_denied(reading, first);
        if !touched_partner && nobody {
            continue;
        }
        // Whom the story tells of by the headline's words is another one.
        let kind = if nobody::is_called_by_headline(reading, actor, (first, end)) { Kind::Vehicle } else { kind };
        all.push(Other {
            kind: reading.told(kind, first, end),
            place: whereabouts::place_of(reading, actor),
            several: known.several,
            acts: nominal::waits_to_cross(reading, actor, acts::stood_alongside(reading, actor, acts)),
            astride: astride::astride(reading, actor),
            hides: hides::hides(reading, actor, (first, end)),
            touched_partner,
            touch: touch.and_then(|frame| touched::earlier(reading, frame)),
        });
    }
    all
}

/// "the doors were standing open": so many words behind it tell how a door stands.
const STANDS_WITHIN: usize = 3;

/// Whether a door took part.
fn door(reading: &Reading<'_>) -> Option<Fact<Striker>> {
    let frames = &reading.story.frames;
    let open = |piece: &Option<Piece>| piece.as_ref().is_some_and(|piece| piece.door && piece.open);
    let opened = frames
        .iter()
        .enumerate()
        .find(|(number, frame)| frame.act() == Some(Act::OpenDoor) && frame.happened() && !reading.is_after(*number))
        .filter(|(number, frame)| !stood_open(reading, *number, frame));
    let door = |piece: &Option<Piece>| piece.as_ref().is_some_and(|piece| piece.door);
    let stands_open = |frame: &Frame| {
        let words = &reading.story.tokens[..reading.story.sentences[frame.sentence].end];
        let doors = (0..words.len()).filter(|at| matches!(words[*at].text.as_str(), "door" | "doors"));
        let states = |at: usize| words[at + 1..].iter().take(STANDS_WITHIN).take_while(|token| token.text != ",");
        let own = owner_of_door(frame) == Some(SUBJECT);
        let open = |at: usize| states(at).any(|token| matches!(token.text.as_str(), "open" | "ajar"));
        doors.into_iter().any(|at| open(at) && is_door_of_subject(reading, at).is_none_or(|of| of == own))
    };
    // "and the door swung into the AV".
    let swings = |frame: &Frame| {
        let verb = reading.story.tokens[frame.first].text.as_str();
        matches!(verb, "swung" | "swings" | "swinging" | "flew" | "blew") && !frame.passive
    };
    // "was struck by the door of a van that was parked".
    let of_parked = |frame: &Frame| {
        frames.iter().any(|other| {
            frame.who.is_some() && other.who == frame.who && other.sense == Sense::Parked && other.happened()
        })
    };
    let (_, frame) = opened.or_else(|| {
        frames.iter().enumerate().find(|(_, frame)| {
            let stands = (door(&frame.with) || door(&frame.on)) && stands_open(frame);
            let opens = stands || door(&frame.with) && (of_parked(frame) || swings(frame));
            frame.is_contact() && (open(&frame.with) || open(&frame.on) || opens)
        })
    })?;
    let owner = match frame.act() {
        Some(Act::OpenDoor) => frame.who,
        _ if open(&frame.with) || door(&frame.with) && !open(&frame.on) => frame.who,
        _ => frame.object,
    }?;
    let value = if owner == SUBJECT { Striker::Sv } else { Striker::Cp };
    let opens = frame.act() == Some(Act::OpenDoor);
    let (first, end) = if opens { entry::of_door(reading, frame) } else { (frame.first, frame.end) };
    Some(reading.told(value, first, end))
}

/// Whose door takes part in a contact.
fn owner_of_door(frame: &Frame) -> Option<Actor> {
    let door = |piece: &Option<Piece>| piece.as_ref().is_some_and(|piece| piece.door);
    if door(&frame.with) { frame.who } else { frame.object }
}

/// "A van with its rear doors open", "the AV's door stood open": whether the door at this token is the subject vehicle's, by who is named last
/// before it in the sentence.
fn is_door_of_subject(reading: &Reading<'_>, at: usize) -> Option<bool> {
    let story = &reading.story;
    let sentence = story.sentences.iter().find(|sentence| (sentence.first..sentence.end).contains(&at))?;
    let named = |meaning| match meaning {
        Meaning::Subject => true,
        Meaning::Kind(kind) => kind.is_vehicle(),
        _ => false,
    };
    let mut before = (sentence.first..at).rev();
    let found = before.find_map(|at| Lexicon::get().longest(&story.tokens, at, named))?;
    Some(found.meaning == Meaning::Subject)
}

/// "Its passengers opened the doors and got out. The van passed, and its flank touched it": the crash is none of a door where another came
/// by later, and touched something else.
fn stood_open(reading: &Reading<'_>, number: usize, opened: &Frame) -> bool {
    let frames = &reading.story.frames;
    let Some(contact) = reading.contacts.first.filter(|contact| *contact > number) else { return false };
    let crash = &frames[contact];
    let part = |piece: &Option<Piece>| piece.as_ref().is_some_and(|piece| !piece.door && !piece.parts.is_empty());
    let passes = |frame: &Frame| {
        let by = matches!(frame.act(), Some(Act::Pass | Act::Drift | Act::LaneChange));
        by && frame.who == reading.contacts.partner && frame.sentence > opened.sentence && frame.happened()
    };
    let own = opened.who == Some(SUBJECT);
    own && part(&crash.with) && part(&crash.on) && frames[number..contact].iter().any(passes)
}

fn injury(reading: &Reading<'_>) -> Option<Fact<bool>> {
    match reading.record.severity {
        Coded::Known(Severity::None) => Some(Fact::of_column(false, "Highest Injury Severity Alleged")),
        Coded::Known(_) => Some(Fact::of_column(true, "Highest Injury Severity Alleged")),
        _ => None,
    }
}

fn left(reading: &Reading<'_>) -> Option<Fact<bool>> {
    let partner = reading.contacts.partner?;
    // "clipped its mirror and drove on".
    let goes_on = |frame: &Frame| {
        let on =
            matches!(reading.story.word(frame.first), "drove" | "went" | "continued" | "rode" | "kept" | "carried")
                && (frame.first + 1..frame.end + 2)
                    .any(|at| matches!(reading.story.word(at), "on" | "going" | "driving"));
        on && frame.act() == Some(Act::Follow)
    };
    let contact = reading.contacts.first?;
    let mut own = reading.story.frames.iter().enumerate().filter(|(_, frame)| frame.who == Some(partner));
    let (_, frame) = own.find(|(number, frame)| {
        let later =
            *number > contact && reading.is_after(*number) && frame.sentence == reading.story.frames[contact].sentence;
        frame.happened() && (frame.act() == Some(Act::Leave) || later && goes_on(frame))
    })?;
    Some(Fact { value: true, source: reading.of(frame) })
}

/// Where the words and the columns cannot both be true.
fn contradictions(account: &Account, record: &CrashRecord) -> Vec<Contradiction> {
    let mut all = Vec::new();
    let mut add =
        |about: &str, kept: String, against: String| all.push(Contradiction { about: about.to_owned(), kept, against });
    let zones = [
        ("sv.zones", Some(&account.sv), &record.sv_zones, "SV Contact Area"),
        ("partner.zones", account.partner.as_ref(), &record.cp_zones, "CP Contact Area"),
    ];
    for (about, party, column, name) in zones {
        let told: Vec<_> = party
            .into_iter()
            .flat_map(|party| &party.zones)
            .filter(|zone| zone.source.is_told())
            .map(|zone| zone.value)
            .collect();
        let near = told.iter().any(|zone| column.iter().any(|other| steps(*zone, *other) <= 1));
        if !told.is_empty() && !column.is_empty() && !near {
            add(about, format!("{} in words", joined(&told)), format!("{} in {name}", joined(column)));
        }
    }
    for (about, party) in [("sv.state", Some(&account.sv)), ("partner.state", account.partner.as_ref())] {
        if let Some((state, speed)) = party.and_then(state_against_speed) {
            let kept = format!("{} {}", state.value.label(), stands_in(&state.source));
            add(about, kept, format!("{:.1} m/s {}", speed.value.mps, stands_in(&speed.source)));
        }
    }
    if let (Some(kind), Coded::Known(column)) =
        (account.partner.as_ref().and_then(|partner| partner.kind.as_ref()), &record.partner)
        && kind.source.is_told()
        && let Some(told) = kind.value.partner_kind()
        && told != *column
        && !alike(told, *column)
    {
        add("partner.kind", format!("{} in words", told.label()), format!("{} in Crash With", column.label()));
    }
    all
}

/// A state at the contact, and a speed of that moment that cannot both be true: it stood, and the speed is not zero, or the other way round.
/// A column's speed is of that moment, whatever was made of it.
fn state_against_speed(party: &Party) -> Option<(&Fact<ContactState>, &Fact<Speed>)> {
    let state = party.state.as_ref()?;
    let at_contact =
        |fact: &Fact<Speed>| fact.value.meaning == SpeedMeaning::Impact || matches!(fact.source, Source::Column { .. });
    let against = |fact: &&Fact<Speed>| at_contact(fact) && (fact.value.mps > 0.0) == state.value.stands();
    party.speeds.iter().find(against).map(|speed| (state, speed))
}

/// Where a fact stands, for sentences.
fn stands_in(source: &Source) -> String {
    match source {
        Source::Words { .. } => "in words".to_owned(),
        Source::Column { name } => format!("in {name}"),
        Source::Rule { name } => format!("by the rule: {name}"),
    }
}

fn joined(zones: &[ContactZone]) -> String {
    zones.iter().map(|zone| zone.label()).collect::<Vec<_>>().join(", ")
}

fn alike(one: PartnerKind, other: PartnerKind) -> bool {
    use PartnerKind as P;
    let car = |kind| matches!(kind, P::PassengerCar | P::Suv | P::Van | P::PickupTruck | P::FirstResponder);
    let big = |kind| matches!(kind, P::HeavyTruck | P::Bus | P::PickupTruck | P::Van);
    (car(one) && car(other))
        || (big(one) && big(other))
        || (one == P::Cyclist && other == P::OtherNonMotorist)
        || (one == P::OtherNonMotorist)
}

/// Steps between two zones around the box; 8 where there is no such way.
pub(crate) fn steps(one: ContactZone, other: ContactZone) -> u8 {
    one.steps_apart(other).unwrap_or(8)
}
