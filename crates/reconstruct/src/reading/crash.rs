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
use crate::told::side::Turning;
use crate::told::times::CONTACT_S;
use recrash_model::account::{
    Account, Act, Astride, ContactState, CrashType, Fact, FirstContact, KindGroup, LaneLine, LaneWord, LeftRight,
    Origin, PlaceKind, Source, Striker, Untold, told,
};

/// Who comes towards the ego partly in that one's lane is over the line between the directions; not who is over one between two of its own.
fn over_from(over: &Fact<Astride>, origin: Origin) -> Astride {
    let words = text(&over.source);
    let of_sv =
        ["the av's", "waymo av's", "ego's", "opposing", "opposite", "oncoming"].iter().any(|word| words.contains(word));
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
        let crash_type = told(&account.crash_type)?;
        let place = told(&account.place.kind).unwrap_or(PlaceKind::Street);
        let mut assumed = Vec::new();
        let kind = told(&partner.kind);
        let thing = kind.filter(|kind| kind.group() == KindGroup::Object);
        let mut sv = side(&account.sv, None, &mut assumed, "ego");
        let mut cp = side(partner, kind, &mut assumed, "partner");
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
        let lies = thing.and_then(|_| Lies::of(partner, &sv, place));
        cp.size = lies.and_then(Lies::size).or_else(|| things::size(partner)).or(cp.size);
        // What "was propelled into the road" by nobody who is told came there.
        let by_nobody = thing.is_some() && account.others.is_empty() && things::is_pushed_by_nobody(partner);
        let gate_swings = thing.is_some_and(|kind| things::swings(kind, partner, told(&account.striker)));
        if gate_swings {
            // Its post stands.
            (cp.state, cp.state_told, cp.size) = (ContactState::Parked, false, Some(POST));
        }
        let origin = told(&account.came_from);
        let origin = if passed { origin::passed_beside(account, &sv).or(origin) } else { origin };
        let origin_told = origin.is_some();
        let assumed_from =
            origin::out_of_stall(account, crash_type, &sv, &cp).or_else(|| assumed_origin(crash_type, &sv, &cp));
        let origin = origin.or(assumed_from).unwrap_or(Origin::Behind);
        cp.astride = partner.astride.as_ref().map(|over| over_from(over, origin));
        let layout = Layout::of(account, partner);
        // Who rides along the sidewalk of the crossing road comes over the crosswalk, and along no lane.
        cp.lane = cp.lane.filter(|lane| *lane != LaneWord::Sidewalk || !matches!(origin, Origin::Cross { .. }));
        // A slip lane is the way of a right turn.
        let slips = layout.slip_lane && origin == Origin::Behind && account.sv.controls.is_empty();
        if slips && sv.turning == Turning::No && told(&account.sv.lane) != Some(LaneWord::Left) {
            (sv.turning, sv.stopped_aside) = (Turning::Right, None);
        }
        let comes_round = origin_told && origin::comes_round(origin, partner, cp.state, cp.movement);
        let right = Some(LeftRight::Right);
        let origin = match comes_round {
            true if origin::leaves_driveway(partner) => Origin::Driveway { side: right },
            true => Origin::Parked { side: right },
            false => {
                origin::at_left_kerb(account, (origin, &cp), thing.is_some() || layout.cp.in_lane).unwrap_or(origin)
            }
        };
        let edge = Some(origin).filter(|_| !gate_swings && account.door.is_none());
        let edge = edge.and_then(|origin| edge::side(account, &sv, &cp, lies, origin));
        if edge.is_some() && things::size(partner).is_none() {
            cp.size = edge::size(kind).or(cp.size);
        }
        let dropped = things::dropped_by(account, partner, &sv).filter(|_| edge.is_none() && lies.is_none());
        if dropped.is_some() {
            cp.state = ContactState::Moving;
            assumed.retain(|assumed| !assumed.starts_with("the partner is "));
        }
        let reaches_in = things::reaches_in(partner, account, &sv).filter(|_| edge.is_none() && cp.state.stands());
        cp.size = reaches_in.map(|_| things::REACHES_IN).or(cp.size);
        let diagonal = edge::is_diagonal(partner, &cp);
        cp.backs_in = origin::backs_in(partner, cp.state, origin, place);
        let striker = told(&account.striker);
        let by_words = account.striker.as_ref().is_some_and(|fact| matches!(fact.source, Source::Words { .. }));
        // What rolls into the ego's flank comes there after its front; that a thing is there first is only a rule.
        let on_flank = !sv.zones.is_empty() && !sv.zones.iter().any(|zone| zone.is_front());
        let into_flank = thing.is_some() && cp.state == ContactState::Moving && on_flank;
        let order = told(&account.order).filter(|_| !into_flank && dropped.is_none());
        let wanted_rig = trailer::rig(partner, &cp, origin);
        let pushed_rolling = (partner.did(Act::Follow) || partner.did(Act::Slow))
            && !(partner.did(Act::Stop) || partner.did(Act::Hold) || cp.state.stands());
        let sv_reverses = sv.state == ContactState::Reversing;
        let cp_reverses = cp.state == ContactState::Reversing;
        let (backs_late, backs_early) = backs_behind(&account.sv, partner, origin);
        let (backs_late, backs_early) = match (cp.state, sv.state) {
            (ContactState::Reversing, ContactState::Moving) if slows_behind(&account.sv, partner, origin) => {
                (backs_late, !backs_late)
            }
            (ContactState::Reversing, ContactState::Moving | ContactState::SettingOff) => (backs_late, false),
            (ContactState::Reversing, ContactState::Stopped) => (false, backs_early),
            _ => (false, false),
        };
        let movement = cp.movement.filter(|_| partner.movement.is_some());
        let mut this = Self {
            crash_type,
            place,
            sv,
            cp,
            thing,
            slides: things::slides(partner) && dropped.is_none(),
            gate_swings,
            reaches_in,
            gate_opens: gate_swings && things::opens(partner),
            lies,
            dropped,
            at_entrance: things::is_at_entrance(partner) && edge.is_none() && !gate_swings,
            edge,
            diagonal,
            lane_changed: things::changed_lanes_before(account),
            walks_across: origin::walks_across(origin, account, partner, sv_reverses),
            origin,
            origin_told,
            heading_told: partner.heading.is_some(),
            faces: courses::faces(&account.sv, partner),
            comes_round,
            comes_over: origin::comes_over(origin, [&account.sv, partner], movement)
                || origin::goes_round_another(origin, account, partner),
            order,
            pushed: partner.did(Act::Pushed) && !(cp_reverses || gate_swings || by_nobody)
                || crash_type == CrashType::Secondary
                || account.others.iter().any(|other| other.touched_partner),
            pusher: others::pusher(account),
            thrower: others::thrower(account),
            touch: others::touch(account),
            pusher_stands: others::pusher_stands(account),
            pusher_fast: others::pusher_fast(account),
            pushed_rolling,
            throwers: account.others.iter().filter(|other| other.touched_partner).count().min(1),
            sv_trailer: trailer::touches(&account.sv),
            trailer_of: kind.filter(|_| trailer::touches(partner)),
            wanted_rig,
            rig: None,
            striker,
            strikes: striker.filter(|_| by_words),
            lanes: told(&account.place.lanes),
            layout,
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
            assumed,
        };
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
