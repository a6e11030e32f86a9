//! An account, read whole: everything that is told of the crash, and what has to be assumed.

use crate::reading::order::{
    backs_behind, backs_first, backs_on_arrival, slows_behind, stood_before, turns_green_late,
};
use crate::reading::origin::{self, assumed_origin};
use crate::reading::side::side;
use crate::reading::things::{self, POST};
use crate::reading::words::text;
use crate::reading::{acts, courses, edge, others, trailer};
use crate::told::choices::Choices;
use crate::told::crash::Told;
use crate::told::layout::Layout;
use crate::told::lies::Lies;
use crate::told::side::{Side, Turning};
use crate::told::times::CONTACT_S;
use recrash_model::account::{
    Account, Act, Astride, ContactState, CrashType, Fact, FirstContact, Kind, KindGroup, LaneLine, LaneWord, LeftRight,
    Origin, Party, PlaceKind, Source, Striker, Untold, told,
};
use recrash_model::narrative::FirstMover;

/// What stands before "vehicle" where that is the subject vehicle.
const SUBJECTS: [&str; 9] =
    ["ego", "subject", "autonomous", "automated", "test", "host", "driverless", "self-driving", "our"];

/// Whether words name something of the subject vehicle, whatever company runs it: "the Zoox AV's lane", "the ego vehicle's lane".
fn names_subjects(words: &str) -> bool {
    let words: Vec<String> = words.split_whitespace().map(|word| word.replace('\u{2019}', "'")).collect();
    let is_subject = |at: usize| match words[at].as_str() {
        "av's" | "adv's" | "ego's" | "sv's" => true,
        "vehicle's" => at > 0 && SUBJECTS.contains(&words[at - 1].as_str()),
        _ => false,
    };
    (0..words.len()).any(is_subject)
}

/// Who comes towards the ego partly in that one's lane is over the line between the directions; not who is over one between two of its own.
fn over_from(over: &Fact<Astride>, origin: Origin) -> Astride {
    let words = text(&over.source);
    let of_sv = names_subjects(&words) || ["opposing", "opposite", "oncoming"].iter().any(|word| words.contains(word));
    match (over.value.line, origin) {
        (LaneLine::Lanes, Origin::Opposite) if of_sv => Astride { line: LaneLine::Centre, side: None, ..over.value },
        _ => over.value,
    }
}

impl Told {
    /// # Errors
    /// Why it cannot be staged.
    pub(crate) fn of(account: &Account) -> Result<Self, Untold> {
        let this = Self::read(account).ok_or(Untold::NoAccount)?;
        if told(&account.first_contact) == Some(FirstContact::OthersOnly) {
            return Err(Untold::OthersOnly);
        }
        match (this.place, this.origin) {
            (PlaceKind::Circle, _) => Err(Untold::Place),
            (_, Origin::Above) => Err(Untold::FromAbove),
            _ if this.thing.is_some() && things::is_overhead(&account.sv) => Err(Untold::FromAbove),
            // What it scrapes where the road bends on a hill has no edge, and no road here has heights.
            _ if this.lies == Some(Lies::Edge) && things::is_on_slope(account) => Err(Untold::Place),
            _ => Ok(this),
        }
    }

    /// Whether or not it can be staged; nothing where no partner or no kind of crash is told.
    pub(crate) fn read(account: &Account) -> Option<Self> {
        let partner = &things::partner(account)?;
        let mut reading = Reading::of(account, partner)?;
        let came = reading.came();
        let met = reading.met(came.origin);
        let mut this = reading.told(came, met);
        this.stands_before_parked(&account.sv);
        this.queued = this.was_in_queue(account, partner);
        this.back_straight = this.cp_drives_over();
        this.courses(account, partner);
        this.phases();
        this.gives_way_to_merge = this.stops_for_merge(&account.sv, partner);
        this.wanted = others::wanted(&this, account);
        // Nothing is told of them that can be looked at.
        let assumed = this.wanted.iter().filter(|extra| extra.is_assumed());
        this.others -= assumed.map(|extra| extra.of.len()).sum::<usize>();
        if this.origin_told {
            this.speeds();
        }
        Some(this)
    }
}

/// What is told of the ego and of its partner; and whether it passed that.
fn sides(account: &Account, partner: &Party, kind: Option<Kind>, assumed: &mut Vec<String>) -> (Side, Side, bool) {
    let mut sv = side(&account.sv, None, assumed, "ego");
    let mut cp = side(partner, kind, assumed, "partner");
    cp.movement = origin::movement_over(told(&account.came_from), partner).or(cp.movement);
    acts::passes_where_touched(&mut cp.acts, &sv.zones);
    let passed = acts::passes_partner(&account.sv, partner, &account.others);
    if !passed {
        sv.acts.retain(|doing| !doing.is_pass());
    }
    // Beside one that turns it shows nothing.
    if sv.turning != Turning::No {
        cp.acts.retain(|doing| !doing.is_begun_pass());
    }
    (sv, cp, passed)
}

/// An account as it is read: the two sides, and what the rest is read with.
struct Reading<'a> {
    account: &'a Account,
    partner: &'a Party,
    crash_type: CrashType,
    place: PlaceKind,
    /// What the partner is, and what thing it is.
    kind: Option<Kind>,
    thing: Option<Kind>,
    sv: Side,
    cp: Side,
    /// The ego passed the partner.
    passed: bool,
    lies: Option<Lies>,
    gate_swings: bool,
    layout: Layout,
    assumed: Vec<String>,
}

/// From where the partner came; whether that is told; and whether it came from the kerb behind the ego, round it.
struct Came {
    origin: Origin,
    is_told: bool,
    round: bool,
}

/// How the ego met what stands at the edge of the road, what fell off a vehicle ahead, or what reaches into its lane.
struct Met {
    edge: Option<LeftRight>,
    dropped: Option<usize>,
    reaches_in: Option<LeftRight>,
    diagonal: bool,
}

impl<'a> Reading<'a> {
    fn of(account: &'a Account, partner: &'a Party) -> Option<Self> {
        let crash_type = told(&account.crash_type)?;
        let place = told(&account.place.kind).unwrap_or(PlaceKind::Street);
        let kind = told(&partner.kind);
        let thing = kind.filter(|kind| kind.group() == KindGroup::Object);
        let mut assumed = Vec::new();
        let (sv, mut cp, passed) = sides(account, partner, kind, &mut assumed);
        let lies = thing.and_then(|_| Lies::of(partner, &sv, place));
        cp.size = lies.and_then(Lies::size).or_else(|| things::size(partner)).or(cp.size);
        let gate_swings = thing.is_some_and(|kind| things::swings(kind, partner, told(&account.striker)));
        if gate_swings {
            // Its post stands.
            (cp.state, cp.state_told, cp.size) = (ContactState::Parked, false, Some(POST));
        }
        let layout = Layout::of(account, partner);
        Some(Self {
            account,
            partner,
            crash_type,
            place,
            kind,
            thing,
            sv,
            cp,
            passed,
            lies,
            gate_swings,
            layout,
            assumed,
        })
    }

    /// From where the partner came, and what of the two depends on that.
    fn came(&mut self) -> Came {
        let (account, partner) = (self.account, self.partner);
        let origin = told(&account.came_from);
        let beside = if self.passed { origin::passed_beside(account, &self.sv) } else { None };
        let by_words = beside.or(origin);
        let origin = by_words.or_else(|| self.assumed_origin()).unwrap_or(Origin::Behind);
        self.cp.astride = partner.astride.as_ref().map(|over| over_from(over, origin));
        // Who rides along the sidewalk of the crossing road comes over the crosswalk, and along no lane.
        let crosses = matches!(origin, Origin::Cross { .. });
        self.cp.lane = self.cp.lane.filter(|lane| *lane != LaneWord::Sidewalk || !crosses);
        if self.takes_slip_lane(origin) {
            (self.sv.turning, self.sv.stopped_aside) = (Turning::Right, None);
        }
        let cp = &self.cp;
        let round = by_words.is_some() && origin::comes_round(origin, partner, cp.state, cp.movement);
        let right = Some(LeftRight::Right);
        let origin = match round {
            true if origin::leaves_driveway(partner) => Origin::Driveway { side: right },
            true => Origin::Parked { side: right },
            false => {
                let elsewhere = self.thing.is_some() || self.layout.cp.in_lane;
                origin::at_left_kerb(account, (origin, cp), elsewhere).unwrap_or(origin)
            }
        };
        Came { origin, is_told: by_words.is_some(), round }
    }

    /// From where a partner came of which no words tell it.
    fn assumed_origin(&self) -> Option<Origin> {
        let (account, crash_type, sv, cp) = (self.account, self.crash_type, &self.sv, &self.cp);
        origin::out_of_stall(account, crash_type, sv, cp).or_else(|| assumed_origin(crash_type, sv, cp))
    }

    /// Whether the ego goes by a slip lane: that is the way of a right turn.
    fn takes_slip_lane(&self, origin: Origin) -> bool {
        let slips = self.layout.slip_lane && origin == Origin::Behind && self.account.sv.controls.is_empty();
        slips && self.sv.turning == Turning::No && told(&self.account.sv.lane) != Some(LaneWord::Left)
    }

    /// How the ego met a partner that has a place of its own, and what of that one depends on it.
    fn met(&mut self, origin: Origin) -> Met {
        let (account, partner) = (self.account, self.partner);
        let sv = &self.sv;
        let edge = match !self.gate_swings && account.door.is_none() {
            true => edge::side(account, sv, &self.cp, self.lies, origin),
            false => None,
        };
        if edge.is_some() && things::size(partner).is_none() {
            self.cp.size = edge::size(self.kind).or(self.cp.size);
        }
        let dropped = things::dropped_by(account, partner, sv).filter(|_| edge.is_none() && self.lies.is_none());
        if dropped.is_some() {
            self.cp.state = ContactState::Moving;
            self.assumed.retain(|assumed| !assumed.starts_with("the partner is "));
        }
        let stands = self.cp.state.stands();
        let reaches_in = things::reaches_in(partner, account, sv).filter(|_| edge.is_none() && stands);
        self.cp.size = reaches_in.map(|_| things::REACHES_IN).or(self.cp.size);
        self.cp.backs_in = origin::backs_in(partner, self.cp.state, origin, self.place);
        Met { edge, dropped, reaches_in, diagonal: edge::is_diagonal(partner, &self.cp) }
    }

    /// Who came there first, where that is told. What rolls into the ego's flank comes there after its front; that a thing is there first is only a
    /// rule.
    fn order(&self, dropped: bool) -> Option<FirstMover> {
        let on_flank = !self.sv.zones.is_empty() && !self.sv.zones.iter().any(|zone| zone.is_front());
        let into_flank = self.thing.is_some() && self.cp.state == ContactState::Moving && on_flank;
        told(&self.account.order).filter(|_| !into_flank && !dropped)
    }

    /// Whether somebody pushed the partner at the ego.
    fn is_pushed(&self) -> bool {
        let others = &self.account.others;
        // What "was propelled into the road" by nobody who is told came there.
        let by_nobody = self.thing.is_some() && others.is_empty() && things::is_pushed_by_nobody(self.partner);
        let backs = self.cp.state == ContactState::Reversing;
        self.partner.did(Act::Pushed) && !(backs || self.gate_swings || by_nobody)
            || self.crash_type == CrashType::Secondary
            || others.iter().any(|other| other.touched_partner)
    }

    /// Whether who was pushed came along or slowed, and had not stood.
    fn is_pushed_rolling(&self) -> bool {
        let partner = self.partner;
        (partner.did(Act::Follow) || partner.did(Act::Slow))
            && !(partner.did(Act::Stop) || partner.did(Act::Hold) || self.cp.state.stands())
    }

    /// Whether a partner that backs began to late, behind what the ego did, or early, before that.
    fn backs(&self, origin: Origin) -> (bool, bool) {
        let (sv, partner) = (&self.account.sv, self.partner);
        let (late, early) = backs_behind(sv, partner, origin);
        match (self.cp.state, self.sv.state) {
            (ContactState::Reversing, ContactState::Moving) if slows_behind(sv, partner, origin) => (late, !late),
            (ContactState::Reversing, ContactState::Moving | ContactState::SettingOff) => (late, false),
            (ContactState::Reversing, ContactState::Stopped) => (false, early),
            _ => (false, false),
        }
    }

    /// Whether an oncoming partner left its own side.
    fn comes_over(&self, origin: Origin) -> bool {
        let movement = self.cp.movement.filter(|_| self.partner.movement.is_some());
        origin::comes_over(origin, [&self.account.sv, self.partner], movement)
            || origin::goes_round_another(origin, self.account, self.partner)
    }

    /// All that is told, and nothing yet of what is staged of it.
    fn told(self, came: Came, met: Met) -> Told {
        let Self { account, partner, kind, thing, gate_swings, .. } = self;
        let (Came { origin, is_told, round }, Met { edge, dropped, reaches_in, diagonal }) = (came, met);
        let (backs_late, backs_early) = self.backs(origin);
        let sv_reverses = self.sv.state == ContactState::Reversing;
        let striker = told(&account.striker);
        let by_words = account.striker.as_ref().is_some_and(|fact| matches!(fact.source, Source::Words { .. }));
        Told {
            crash_type: self.crash_type,
            place: self.place,
            thing,
            slides: things::slides(partner) && dropped.is_none(),
            gate_swings,
            reaches_in,
            gate_opens: gate_swings && things::opens(partner),
            lies: self.lies,
            dropped,
            at_entrance: things::is_at_entrance(partner) && edge.is_none() && !gate_swings,
            edge,
            diagonal,
            lane_changed: things::changed_lanes_before(account),
            walks_across: origin::walks_across(origin, account, partner, sv_reverses),
            origin,
            origin_told: is_told,
            heading_told: partner.heading.is_some(),
            faces: courses::faces(&account.sv, partner),
            comes_round: round,
            comes_over: self.comes_over(origin),
            order: self.order(dropped.is_some()),
            pushed: self.is_pushed(),
            pusher: others::pusher(account),
            thrower: others::thrower(account),
            touch: others::touch(account),
            pusher_stands: others::pusher_stands(account),
            pusher_fast: others::pusher_fast(account),
            pushed_rolling: self.is_pushed_rolling(),
            throwers: account.others.iter().filter(|other| other.touched_partner).count().min(1),
            sv_trailer: trailer::touches(&account.sv),
            trailer_of: kind.filter(|_| trailer::touches(partner)),
            wanted_rig: trailer::rig(partner, &self.cp, origin),
            rig: None,
            striker,
            strikes: striker.filter(|_| by_words),
            lanes: told(&account.place.lanes),
            more_lanes: false,
            crossed_near: false,
            all_way: others::is_all_way(account),
            green_late: turns_green_late(&account.sv),
            reasons: others::reasons(account, origin),
            others: account.others.len(),
            others_astride: others::astride(account),
            door: told(&account.door),
            posted_mps: told(&account.place.posted_mps),
            wanted: Vec::new(),
            extras: Vec::new(),
            ahead: told(&account.ahead),
            stood_before: stood_before(&account.sv, partner),
            gives_way_to_merge: false,
            backs_late,
            backs_early,
            backs_as_it_comes: backs_on_arrival(&account.sv, partner, origin),
            // Of two that back the partner can have begun to before.
            backs_first: backs_first(&account.sv, partner).filter(|first| !sv_reverses || *first == Striker::Cp),
            queued: false,
            close: true,
            plainly: false,
            back_straight: false,
            any_lane: false,
            contact_s: CONTACT_S,
            choices: Choices::default(),
            sv: self.sv,
            cp: self.cp,
            layout: self.layout,
            assumed: self.assumed,
        }
    }
}
