//! What an account tells, in the terms of a staging; and what has to be assumed.

use crate::acts;
use crate::choices::Choices;
use crate::control;
use crate::ground::LANE_M;
use crate::kerb;
use crate::lateral;
use crate::layout::Layout;
use crate::others::{self, Extra};
use crate::phases::{self, CONTACT_S};
use crate::roadside;
use crate::side::{Side, Slant, Turning, side};
use crate::things::{self, Lies};
use crate::thrown::{self, Thrower};
use crate::touch::side_of;
use crate::trailer::{self, Rig};
use recrash_model::account::{
    Account, Act, ActFact, ContactState, CrashType, FirstContact, Kind, KindGroup, LeftRight, Origin, Party, PlaceKind,
    Source, Striker, Untold, told,
};
use recrash_model::account::{StandReason, Standing};
use recrash_model::metrics::CheckKind;
use recrash_model::narrative::FirstMover;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// Who leaves its lane leaves it by so much, who comes from the kerb or goes there by so much, and who changes lanes has done so much
/// of it at the contact. [m]
const DEPARTS_M: f64 = 1.6;
const KERB_M: f64 = 2.6;
const CHANGES_M: f64 = 2.2;

/// An ego that leaves the kerb, and touches one that is parked there, leaves it by so much. [m]
const LEAVES_KERB_M: f64 = 1.2;

/// Who pulls out has left the kerb by so much. [m]
const PULLS_OUT_M: f64 = 1.5;

/// An account, in the terms of a staging.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Told {
    pub(crate) crash_type: CrashType,
    pub(crate) place: PlaceKind,
    pub(crate) sv: Side,
    pub(crate) cp: Side,
    /// The partner is a thing that stands or lies.
    pub(crate) thing: Option<Kind>,
    /// The partner is a gate that swung as they met.
    pub(crate) gate_swings: bool,
    /// How the partner lies that the ego drives over, where told.
    pub(crate) lies: Option<Lies>,
    /// Which of the others the partner fell off, or came out from under, ahead of the ego.
    pub(crate) dropped: Option<usize>,
    /// The partner lies, hangs or stands across the entrance that the ego turned into.
    pub(crate) at_entrance: bool,
    /// The side of the road at whose edge the partner stands.
    pub(crate) edge: Option<LeftRight>,
    /// The partner is told to be parked at an angle to the road.
    pub(crate) diagonal: bool,
    /// The ego had changed lanes, and driven on, before it came to a thing.
    pub(crate) lane_changed: bool,
    /// The partner is on foot, or an animal, and is told to have come across.
    pub(crate) walks_across: bool,
    /// The partner is told to have rolled, slid or been pushed.
    pub(crate) slides: bool,
    pub(crate) origin: Origin,
    pub(crate) origin_told: bool,
    /// The partner came from the kerb behind the ego, round it.
    pub(crate) comes_round: bool,
    /// An oncoming partner left its own side.
    pub(crate) comes_over: bool,
    pub(crate) order: Option<FirstMover>,
    /// The kind of the partner whose trailer is told to have touched.
    pub(crate) trailer_of: Option<Kind>,
    /// Who comes by with a trailer that touches is drawn as two, where that shows what is told; and what is drawn.
    pub(crate) wanted_rig: Option<Rig>,
    pub(crate) rig: Option<Rig>,
    /// Somebody threw the partner at the subject vehicle; and who, where told.
    pub(crate) pushed: bool,
    pub(crate) pusher: Option<Kind>,
    pub(crate) thrower: Option<Thrower>,
    /// Who touched the partner first is told to stand: the partner ran into it.
    pub(crate) pusher_stands: bool,
    /// Who was pushed is told to have come along or slowed, and not to have stood.
    pub(crate) pushed_rolling: bool,
    /// So many of the others are told to have touched the partner first.
    pub(crate) throwers: usize,
    pub(crate) striker: Option<Striker>,
    /// Lanes in the ego's direction.
    pub(crate) lanes: Option<u8>,
    /// What is told of the road and of places on it beside.
    pub(crate) layout: Layout,
    /// The road has one lane more in each direction than is usual.
    pub(crate) more_lanes: bool,
    /// The road is crossed by one on which somebody is who has no part in what the ego does.
    pub(crate) crossed_near: bool,
    /// A stop for all: there is a sign on every arm.
    pub(crate) all_way: bool,
    /// The ego's light turned green when it had set off and come to a stop again.
    pub(crate) green_late: bool,
    /// Why the ego stood.
    pub(crate) reasons: Vec<StandReason>,
    /// Others than the two.
    pub(crate) others: usize,
    /// Whose door took part.
    pub(crate) door: Option<Striker>,
    /// Posted speed, where told. [m/s]
    pub(crate) posted_mps: Option<f64>,
    /// Whom the ego stood for, by what is told.
    pub(crate) wanted: Vec<Extra>,
    /// Those of them in the scene.
    pub(crate) extras: Vec<Extra>,
    /// A partner from beside was ahead of the ego at first, or behind it, where told.
    pub(crate) ahead: Option<bool>,
    /// The ego stood already when the partner began what it did.
    pub(crate) stood_before: bool,
    /// The ego stopped for a partner beside it that had begun to come over.
    pub(crate) gives_way_to_merge: bool,
    /// The partner backs: it began to when the ego had set off.
    pub(crate) backs_late: bool,
    /// The partner backs: it began to before the ego stopped, or moved up to where it stands.
    pub(crate) backs_early: bool,
    /// Who of the two backed first, where both did.
    pub(crate) backs_first: Option<Striker>,
    /// The partner is told to have been behind an ego that stood and set off, and not to have come up to it.
    pub(crate) queued: bool,
    /// Who was behind the ego in a queue stands close to it.
    pub(crate) close: bool,
    /// What the two did to each other before is not staged; it is asked for.
    pub(crate) plainly: bool,
    /// The partner comes straight to where it touches, also beside its lane.
    pub(crate) back_straight: bool,
    /// When they touch. [s]
    pub(crate) contact_s: f64,
    pub(crate) choices: Choices,
    pub(crate) assumed: Vec<String>,
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
        let gate_swings = thing.is_some_and(|kind| things::swings(kind, partner, told(&account.striker)));
        if gate_swings {
            // Its post stands.
            (cp.state, cp.state_told, cp.size) = (ContactState::Parked, false, Some(things::POST));
        }
        let origin = told(&account.came_from);
        let origin = if passed { lateral::passed_beside(account, &sv).or(origin) } else { origin };
        let origin_told = origin.is_some();
        let assumed_from =
            kerb::out_of_stall(account, crash_type, &sv, &cp).or_else(|| assumed_origin(crash_type, &sv, &cp));
        let origin = origin.or(assumed_from).unwrap_or(Origin::Behind);
        let comes_round = origin_told && lateral::comes_round(origin, partner, cp.state, cp.movement);
        let right = Some(LeftRight::Right);
        let origin = match comes_round {
            true if kerb::leaves_driveway(partner) => Origin::Driveway { side: right },
            true => Origin::Parked { side: right },
            false => origin,
        };
        let edge = Some(origin).filter(|_| !gate_swings && account.door.is_none());
        let edge = edge.and_then(|origin| roadside::side(account, &sv, &cp, lies, origin));
        if edge.is_some() && things::size(partner).is_none() {
            cp.size = roadside::size(kind).or(cp.size);
        }
        let dropped = things::dropped_by(account, partner, &sv, place).filter(|_| edge.is_none() && lies.is_none());
        if dropped.is_some() {
            cp.state = ContactState::Moving;
            assumed.retain(|assumed| !assumed.starts_with("the partner is "));
        }
        let diagonal = roadside::is_diagonal(partner, &cp);
        cp.backs_in = kerb::backs_in(partner, cp.state, origin, place);
        let striker = told(&account.striker);
        // What rolls into the ego's flank comes there after its front; that a thing is there first is only a rule.
        let on_flank = !sv.zones.is_empty() && !sv.zones.iter().any(|zone| zone.is_front());
        let into_flank = thing.is_some() && cp.state == ContactState::Moving && on_flank;
        let order = told(&account.order).filter(|_| !into_flank && dropped.is_none());
        let wanted_rig = trailer::rig(partner, &cp, origin);
        let pushed_rolling = (partner.did(Act::Follow) || partner.did(Act::Slow))
            && !(partner.did(Act::Stop) || partner.did(Act::Hold) || cp.state.stands());
        let sv_reverses = sv.state == ContactState::Reversing;
        let (backs_late, backs_early) = backs_behind(&account.sv, partner, origin);
        let (backs_late, backs_early) = match (cp.state, sv.state) {
            (ContactState::Reversing, ContactState::Moving | ContactState::SettingOff) => (backs_late, false),
            (ContactState::Reversing, ContactState::Stopped) => (false, backs_early),
            _ => (false, false),
        };
        let mut this = Self {
            crash_type,
            place,
            sv,
            cp,
            thing,
            slides: things::slides(partner) && dropped.is_none(),
            gate_swings,
            lies,
            dropped,
            at_entrance: things::is_at_entrance(partner) && edge.is_none() && !gate_swings,
            edge,
            diagonal,
            lane_changed: things::changed_lanes_before(account),
            walks_across: things::walks_across(origin, partner),
            origin,
            origin_told,
            comes_round,
            comes_over: lateral::comes_over(origin, partner, told(&partner.movement)),
            order,
            pushed: partner.did(Act::Pushed)
                || crash_type == CrashType::Secondary
                || account.others.iter().any(|other| other.touched_partner),
            pusher: others::pusher(account),
            thrower: thrown::thrower(account),
            pusher_stands: others::pusher_stands(account),
            pushed_rolling,
            throwers: account.others.iter().filter(|other| other.touched_partner).count().min(1),
            trailer_of: kind.filter(|_| trailer::touches(partner)),
            wanted_rig,
            rig: None,
            striker,
            lanes: told(&account.place.lanes),
            layout: Layout::of(account, partner),
            more_lanes: false,
            crossed_near: false,
            all_way: others::is_all_way(account),
            green_late: control::turns_green_late(&account.sv),
            reasons: others::reasons(account, origin),
            others: account.others.len(),
            door: told(&account.door),
            posted_mps: told(&account.place.posted_mps),
            wanted: Vec::new(),
            extras: Vec::new(),
            ahead: told(&account.ahead),
            stood_before: stood_before(&account.sv, partner),
            gives_way_to_merge: false,
            backs_late,
            backs_early,
            backs_first: backs_first(&account.sv, partner).filter(|_| !sv_reverses),
            queued: false,
            close: true,
            plainly: false,
            back_straight: false,
            contact_s: CONTACT_S,
            choices: Choices::default(),
            assumed,
        };
        this.queued = this.was_in_queue(account, partner);
        this.courses(&account.sv, partner);
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

    /// What the acts tell of the ways beside the movements.
    fn courses(&mut self, sv: &Party, partner: &Party) {
        self.reactions(sv, partner);
        self.goes_round(sv);
        let drives_on =
            |side: &Side| side.aside.is_some() && matches!(side.movement, Some(Movement::Straight | Movement::Passing));
        self.sv.dodges = (drives_on(&self.sv) || self.sv.stopped_aside.is_some()) && self.sv_aside().is_some();
        self.cp.dodges = drives_on(&self.cp) && self.cp_from_left_m().is_some();
        let along = matches!(self.origin, Origin::Ahead | Origin::Behind | Origin::Beside { .. });
        if self.cp.state == ContactState::Reversing && along {
            let before = |fact: &&ActFact| !fact.after_contact && !fact.begun;
            let reversed =
                partner.acts.iter().filter(before).find(|fact| fact.act == Act::Reverse).map(|fact| fact.step);
            let swing = |fact: &&ActFact| matches!(fact.act, Act::Turn | Act::Drift | Act::Swerve);
            let last = partner.acts.iter().filter(before).rfind(swing);
            self.cp.slants = last.and_then(|fact| match Some(fact.step) >= reversed {
                true => Some(Slant::Swung),
                false => {
                    (fact.act == Act::Turn).then_some(Slant::Stood { side: fact.side, oncoming: faces(sv, partner) })
                }
            });
        }
        // Who reverses out of the crossing road came along the ego's, turned into that, and stood there.
        if let (ContactState::Reversing, Origin::Cross { side }) = (self.cp.state, self.origin)
            && let Some(turned) = turned_off(partner)
        {
            self.cp.slants = Some(Slant::Stood { side: Some(turned), oncoming: turned != side });
        }
        // Who meets a thing after a turn may be in it yet; not what lies across where it turned into.
        if self.thing.is_some() && !self.at_entrance && self.sv.movement == Some(Movement::Straight) {
            self.sv.turned = false;
        }
        if things::lies_before_turn(self, sv) {
            (self.sv.turning, self.sv.turns_later) = (Turning::No, true);
        }
        // Whose turn no words tell has yet to begin it where it is hit from behind.
        let unsaid = sv.movement.as_ref().is_some_and(|movement| !matches!(movement.source, Source::Words { .. }))
            && !sv.acts.iter().any(|fact| fact.act == Act::Turn);
        let slows = self.sv.slowed_from.is_some() || self.sv.state == ContactState::Stopped;
        if unsaid && slows && self.origin == Origin::Behind && self.crash_type == CrashType::FrontToRear {
            let turns = matches!(self.sv.turning, Turning::Left | Turning::Right);
            self.sv.turns_later = turns && !self.enters();
        }
        // Who runs into the rear of who turns, or waits to, ahead of it has yet to turn.
        let in_line = self.crash_type == CrashType::FrontToRear || self.is_thrown();
        let follows = self.origin == Origin::Behind && in_line;
        let turns = matches!(self.cp.turning, Turning::Left | Turning::Right);
        if follows && turns && matches!(self.cp.state, ContactState::Moving | ContactState::SettingOff) {
            (self.cp.turning, self.cp.turns_later) = (Turning::No, true);
        }
        for side in [&mut self.sv, &mut self.cp].into_iter().filter(|side| side.turns_later) {
            side.acts.retain(|doing| !doing.is_turn());
        }
        if let Origin::Cross { side } = self.origin {
            self.cp.turns_wide = self.crash_type == CrashType::HeadOn;
            // To meet it head-on, who comes from the left turns to the right.
            let turn =
                partner.acts.iter().rev().find(|fact| fact.act == Act::Turn && !fact.after_contact && !fact.begun);
            let by_type = self.cp.turns_wide.then(|| side.other());
            let drives = self.cp.movement.is_none_or(|movement| {
                matches!(
                    movement,
                    Movement::Straight
                        | Movement::Passing
                        | Movement::LaneDeparture
                        | Movement::CrossingIntoOpposingLane
                )
            });
            if self.cp.turning == Turning::No && drives && self.cp.state == ContactState::Moving {
                self.cp.turning = match turn.and_then(|fact| fact.side).or(by_type) {
                    Some(LeftRight::Left) => Turning::Left,
                    Some(LeftRight::Right) => Turning::Right,
                    None => Turning::No,
                };
            }
        }
    }

    /// What the ego did because of the partner: when, and to which side.
    fn reactions(&mut self, sv: &Party, partner: &Party) {
        if self.sv.state != ContactState::Moving || self.thing.is_some() {
            return;
        }
        let turns = steps(partner, |act| act == Act::Turn).into_iter().min();
        let reacts = steps(sv, |act| matches!(act, Act::Slow | Act::Swerve | Act::Drift)).into_iter().min();
        let turning = matches!(self.cp.turning, Turning::Left | Turning::Right);
        self.sv.reacts = turning && !self.cp.stood_first && turns.is_some() && turns < reacts;
        // Who swerves from somebody that comes at it does so away from it.
        let swerves = !steps(sv, |act| act == Act::Swerve).is_empty();
        let straight =
            matches!(self.sv.movement, Some(Movement::Straight | Movement::LaneDeparture | Movement::Passing));
        if swerves && straight && self.sv.aside.is_none() && self.striker == Some(Striker::Cp) {
            self.sv.aside = match self.origin {
                Origin::Beside { side } | Origin::Cross { side } => Some(side.other()),
                _ => side_of(&self.sv.zones).map(|side| if side > 0.0 { LeftRight::Right } else { LeftRight::Left }),
            };
        }
    }

    /// The kinds of facts that are told and can be held against a rollout.
    pub(crate) fn kinds(&self) -> Vec<CheckKind> {
        let (sv, cp) = (&self.sv, &self.cp);
        let moves = !(self.thing.is_some() && cp.state.stands());
        let of = [
            (CheckKind::Contact, true),
            (CheckKind::Partner, true),
            (CheckKind::SvZones, !sv.zones.is_empty() || sv.only_above_or_below),
            (CheckKind::CpZones, !cp.zones.is_empty() && self.thing.is_none() || cp.only_above_or_below),
            (CheckKind::SvState, sv.state_told),
            (CheckKind::CpState, cp.state_told && moves || self.gate_swings),
            (CheckKind::SvSpeed, sv.impact_mps.is_some()),
            (CheckKind::CpSpeed, cp.impact_mps.is_some()),
            (CheckKind::SvMovement, sv.movement.is_some()),
            (CheckKind::CpMovement, cp.movement.is_some() && moves),
            (CheckKind::SvActs, !sv.acts.is_empty()),
            (CheckKind::CpActs, !cp.acts.is_empty() && moves),
            (CheckKind::Approach, self.origin_told && moves || self.edge.is_some() || self.lies.is_some()),
            (CheckKind::Order, self.order.is_some() && moves),
            (CheckKind::PassedOn, self.pushed),
            (CheckKind::SvLane, sv.lane.is_some()),
            (CheckKind::CpLane, cp.lane.is_some() && moves),
            (CheckKind::SvControl, sv.control.is_some()),
            (CheckKind::CpControl, cp.control.is_some() && moves),
            (CheckKind::Reason, sv.state.stands() && !self.reasons.is_empty()),
            (CheckKind::Others, self.others > 0),
            (CheckKind::Door, self.door.is_some()),
        ];
        of.into_iter().filter(|(_, told)| *told).map(|(kind, _)| kind).collect()
    }

    /// The same, choosing otherwise.
    pub(crate) fn choosing(mut self, choices: Choices) -> Self {
        self.choices = choices;
        if self.origin_told {
            self.assumed.retain(|assumed| !assumed.contains("speed at the contact"));
            self.speeds();
        }
        self
    }

    /// The same with a partner that comes straight to where it touches.
    pub(crate) fn coming_straight(&self) -> Self {
        Self { back_straight: true, ..self.clone() }
    }

    /// Whether the ego is told to have come into the junction.
    pub(crate) fn enters(&self) -> bool {
        !self.plainly && self.sv.enters()
    }

    /// The same without what they did to each other, where that is staged: it is asked for, and said not to be seen.
    pub(crate) fn plainly(&self) -> Option<Self> {
        let staged = self.enters() || self.sets_off_first() || self.sv.goes_round || self.does_before();
        staged.then(|| {
            let mut told = Self { plainly: true, ..self.clone() };
            if told.sv.goes_round {
                (told.sv.aside, told.sv.goes_round, told.sv.dodges) = (None, false, false);
            }
            told
        })
    }

    /// Whether a signal or sign is told.
    pub(crate) fn is_controlled(&self) -> bool {
        self.sv.control.is_some() || self.cp.control.is_some()
    }

    /// Everything to try: with those whom the ego stood for, with one of them, then without them.
    pub(crate) fn variants(self) -> Vec<Self> {
        let with_extras = |told: Self| {
            let all = others::choices(&told.wanted);
            all.into_iter().map(|extras| Self { extras, ..told.clone() }).collect::<Vec<_>>()
        };
        let with_rig = |told: Self| {
            let drawn = told.wanted_rig.map(|rig| {
                let cp = Side { size: Some(rig.tractor), ..told.cp.clone() };
                Self { rig: Some(rig), cp, ..told.clone() }
            });
            drawn.into_iter().chain([told])
        };
        // Who has no room in the ego's direction has it on a wider road.
        let with_lanes = |told: Self| {
            let may = told.lanes.is_none() && told.edge.is_none() && told.keeps_direction();
            let more = may.then(|| Self { more_lanes: true, ..told.clone() });
            [told].into_iter().chain(more)
        };
        let told = self.by_origin().into_iter().flat_map(Self::with_junction).flat_map(with_rig);
        told.flat_map(with_extras).flat_map(with_lanes).collect()
    }

    /// The same with every origin to try: the told one; where none is told the one that the type leaves, then the others.
    fn by_origin(self) -> Vec<Self> {
        if self.origin_told {
            return vec![self];
        }
        let (left, right) = (LeftRight::Left, LeftRight::Right);
        let mut origins = vec![self.origin];
        for other in [
            Origin::Behind,
            Origin::Cross { side: left },
            Origin::Cross { side: right },
            Origin::Opposite,
            Origin::Beside { side: left },
            Origin::Beside { side: right },
            Origin::Ahead,
            Origin::Stall { side: Some(left) },
            Origin::Stall { side: Some(right) },
        ] {
            if !origins.contains(&other) {
                origins.push(other);
            }
        }
        let with = |origin: Origin| {
            let mut told = Self { origin, ..self.clone() };
            told.assumed.push(format!("the partner comes {}", origin.words()));
            told.speeds();
            told
        };
        origins.into_iter().map(with).collect()
    }

    /// Whether somebody throws the partner at the ego from behind: both stood in one lane, or came along it.
    pub(crate) fn is_thrown(&self) -> bool {
        let changes =
            matches!(self.cp.movement, Some(Movement::ChangingLanes | Movement::Merging)) && self.cp.stood_first;
        let behind = self.origin == Origin::Behind && self.cp.state != ContactState::Reversing;
        self.pushed && behind && self.thing.is_none() && !changes
    }
}

/// A move out of the line that somebody drives on, to the right of it. [m]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aside {
    pub(crate) from_t_m: f64,
    pub(crate) to_t_m: f64,
    /// It is over before the contact.
    pub(crate) done: bool,
    /// It had left the other line for this one before.
    pub(crate) back: bool,
}

impl Told {
    /// How the ego leaves its line.
    pub(crate) fn sv_aside(&self) -> Option<Aside> {
        let (left, right) = (LeftRight::Left, LeftRight::Right);
        let back = self.sv.phases.contains(&phases::Phase::Reverses);
        let stopped = self.sv.stopped_aside.filter(|_| !back && !self.sv.came_to_park && !self.is_at_kerb());
        let stands = self.sv.state.stands() && stopped.is_none();
        if self.sv.turning != Turning::No || stands || self.sv.state == ContactState::Reversing {
            return None;
        }
        let movement = match stopped {
            Some(Act::LaneChange) => Movement::ChangingLanes,
            Some(Act::PullOut) => Movement::EnteringTraffic,
            Some(Act::PullOver | Act::Park) => Movement::ParkingManeuver,
            Some(_) => Movement::LaneDeparture,
            None => self.sv.movement?,
        };
        // Who makes room for another before it stops does so away from it.
        let makes_room = matches!(stopped, Some(Act::Drift | Act::Swerve)) && self.striker == Some(Striker::Cp);
        let towards = self.sv.aside.or(match self.origin {
            // For who has turned into the other direction it makes room at the kerb.
            Origin::Cross { .. } if makes_room && self.comes_against() => Some(right),
            Origin::Beside { side } | Origin::Cross { side } => Some(if makes_room { side.other() } else { side }),
            _ => None,
        });
        let towards = towards
            .or_else(|| side_of(&self.sv.zones).map(|side| if (side > 0.0) != makes_room { left } else { right }));
        let by = |usual: LeftRight, way_m: f64| if towards.unwrap_or(usual) == left { -way_m } else { way_m };
        let (from_t_m, to_t_m) = match movement {
            // Who runs into one that is parked ahead of it has not come far.
            _ if self.leaves_kerb() => (KERB_M, if self.stands_beside(false) { KERB_M - LEAVES_KERB_M } else { 0.0 }),
            Movement::ChangingLanes | Movement::Merging => (0.0, by(left, LANE_M)),
            Movement::CrossingIntoOpposingLane => (0.0, -LANE_M),
            Movement::LaneDeparture => (0.0, by(right, DEPARTS_M)),
            // From the kerb, or the one told.
            Movement::EnteringTraffic => (if self.sv.aside == Some(right) { -KERB_M } else { KERB_M }, 0.0),
            Movement::ParkingManeuver => (0.0, by(right, KERB_M)),
            // It changed lanes on its way.
            Movement::Straight if self.sv.changed_lanes && self.sv.aside.is_some() => (0.0, by(left, LANE_M)),
            // It dodged, or drifted, while it drove on.
            Movement::Straight | Movement::Passing if self.sv.aside.is_some() => (0.0, by(left, DEPARTS_M)),
            _ => return None,
        };
        let back = self.sv.returns && matches!(movement, Movement::ChangingLanes | Movement::Merging);
        let changed = movement == Movement::Straight && self.sv.changed_lanes;
        Some(Aside {
            from_t_m,
            to_t_m,
            done: (self.lane_changed || changed || self.sv.goes_round) && stopped.is_none(),
            back,
        })
    }

    /// How far to the left of where it touches the partner came along, of who goes about the ego's way or against it. [m]
    pub(crate) fn cp_from_left_m(&self) -> Option<f64> {
        let against = match self.origin {
            Origin::Behind | Origin::Ahead | Origin::Beside { .. } => 1.0,
            Origin::Opposite => -1.0,
            Origin::Parked { .. } if self.cp.state != ContactState::Reversing => 1.0,
            _ => return None,
        };
        let way_m = match self.cp.movement? {
            Movement::ChangingLanes | Movement::Merging => CHANGES_M,
            Movement::CrossingIntoOpposingLane => CHANGES_M,
            Movement::LaneDeparture => DEPARTS_M,
            Movement::EnteringTraffic | Movement::ParkingManeuver => PULLS_OUT_M,
            Movement::Straight if self.cp.aside.is_some() => DEPARTS_M,
            _ => return None,
        };
        // Who moves to its left came along on its right.
        let own_left = self.cp.aside.map(|side| if side == LeftRight::Left { -1.0 } else { 1.0 });
        let from_left = own_left.map(|own| own * against).or_else(|| match self.origin {
            // Who parks does so on the right; who came along behind the ego leaves its lane.
            _ if self.cp.movement == Some(Movement::ParkingManeuver) => Some(against),
            Origin::Behind if self.cp.merges_in => side_of(&self.sv.zones),
            Origin::Behind => side_of(&self.sv.zones).map(|side| -side),
            Origin::Beside { side } | Origin::Parked { side: Some(side) } => {
                Some(if side == LeftRight::Left { 1.0 } else { -1.0 })
            }
            _ => side_of(&self.sv.zones),
        });
        Some(from_left.unwrap_or(if against > 0.0 { -1.0 } else { 1.0 }) * way_m)
    }
}

impl Told {
    /// Whether the partner turns out of a crossing road into the ego's, against the ego's way.
    fn comes_against(&self) -> bool {
        let turns = match self.cp.turning {
            Turning::Left => LeftRight::Left,
            Turning::Right => LeftRight::Right,
            Turning::No | Turning::Round => return false,
        };
        self.origin == Origin::Cross { side: turns.other() }
    }
}

/// To which side somebody turned before it stood and reversed.
fn turned_off(party: &Party) -> Option<LeftRight> {
    let first = |of: fn(Act) -> bool| steps(party, of).into_iter().min();
    let stood = first(|act| matches!(act, Act::Stop | Act::Hold))?.min(first(|act| act == Act::Reverse)?);
    let turn = |fact: &&ActFact| fact.act == Act::Turn && !fact.after_contact && !fact.begun && fact.step < stood;
    party.acts.iter().rfind(turn).and_then(|fact| fact.side)
}

/// Steps of the story in which somebody did such things before the contact.
fn steps(party: &Party, of: fn(Act) -> bool) -> Vec<u32> {
    let before = party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun && of(fact.act));
    before.map(|fact| fact.step).collect()
}

/// Whether the partner that backs began to after the ego had set off; and whether before the ego stopped for it, or moved up.
fn backs_behind(sv: &Party, partner: &Party, origin: Origin) -> (bool, bool) {
    let first = |party: &Party, of: fn(Act) -> bool| steps(party, of).into_iter().min();
    let Some(backs) = first(partner, |act| act == Act::Reverse) else { return (false, false) };
    let sets_off = steps(sv, |act| act == Act::SetOff).into_iter().max();
    let stops = first(sv, |act| matches!(act, Act::Stop | Act::Hold | Act::PullOver | Act::Park));
    let in_lane = matches!(origin, Origin::Ahead | Origin::Behind);
    let early = in_lane && stops_for_who_backs(sv, partner)
        || sets_off.is_some_and(|at| at > backs)
        || stops.is_some_and(|at| at > backs);
    // Who backs behind what the ego did did so when that stood.
    let last = partner.acts.iter().rfind(|fact| fact.act == Act::Reverse && !fact.after_contact);
    let answers = last.is_some_and(|fact| fact.after_other >= stops && fact.after_other.is_some());
    (sets_off.is_some_and(|at| at < backs), early && !answers)
}

/// Whether the ego stopped for one that was reversing then: "came to a stop for a van that was backing up".
fn stops_for_who_backs(sv: &Party, partner: &Party) -> bool {
    let before = |fact: &&ActFact| !fact.after_contact && !fact.begun;
    let words = |fact: &ActFact| match &fact.source {
        Source::Words { start, end, text } => Some((*start, *end, text.to_lowercase())),
        _ => None,
    };
    let backs = partner.acts.iter().filter(before).find(|fact| fact.act == Act::Reverse).and_then(words);
    let stops = sv.acts.iter().filter(before).find(|fact| matches!(fact.act, Act::Stop | Act::Slow)).and_then(words);
    let (Some((backs, _, text)), Some((_, stops, _))) = (backs, stops) else { return false };
    let goes_on = text.starts_with("reversing") || text.starts_with("backing");
    let own = steps(sv, |act| act == Act::Reverse);
    goes_on && own.is_empty() && (0..SAME_BREATH).contains(&(backs as i64 - stops as i64))
}

/// What is told within so many bytes is told in one breath.
const SAME_BREATH: i64 = 130;

/// Whether one that stood at the contact did so before the partner began to do something: nothing is told of it behind that.
fn stood_before(sv: &Party, partner: &Party) -> bool {
    let begins = |act: Act| {
        matches!(act, Act::Reverse | Act::SetOff | Act::PullOut | Act::Enter | Act::Turn | Act::Pass | Act::LaneChange)
    };
    let begun = steps(partner, begins).into_iter().min();
    // That it stood yet is told when it is struck.
    let last = steps(sv, |act| act != Act::Hold).into_iter().max();
    told(&sv.standing) == Some(Standing::FromTheStart) || last.is_some() && begun.is_some() && last < begun
}

/// Who of the two is told to have backed first.
fn backs_first(sv: &Party, partner: &Party) -> Option<Striker> {
    let first = |party: &Party| {
        let backs = |fact: &&ActFact| fact.act == Act::Reverse && !fact.after_contact && !fact.begun;
        party.acts.iter().filter(backs).map(|fact| fact.step).min()
    };
    Some(if first(partner)? < first(sv)? { Striker::Cp } else { Striker::Sv })
}

/// From where a partner comes of whom nobody says it, where the type leaves no choice.
fn assumed_origin(crash_type: CrashType, sv: &Side, cp: &Side) -> Option<Origin> {
    let rear = |side: &Side| side.zones.iter().any(|zone| zone.is_rear());
    let front = |side: &Side| side.zones.iter().any(|zone| zone.is_front());
    match crash_type {
        CrashType::FrontToRear if rear(sv) => Some(Origin::Behind),
        CrashType::FrontToRear if front(sv) => Some(Origin::Ahead),
        CrashType::SingleVehicle => Some(Origin::Ahead),
        CrashType::Backing if cp.state == ContactState::Reversing => {
            Some(if rear(sv) && !front(sv) { Origin::Behind } else { Origin::Ahead })
        }
        CrashType::Backing => Some(Origin::Behind),
        CrashType::HeadOn => Some(Origin::Opposite),
        CrashType::Secondary if rear(sv) => Some(Origin::Behind),
        CrashType::Lateral => {
            let on = |zones: &[ContactZone]| sv.zones.iter().any(|zone| zones.contains(zone));
            use ContactZone as Z;
            if on(&[Z::Left, Z::FrontLeft, Z::RearLeft]) {
                Some(Origin::Beside { side: LeftRight::Left })
            } else if on(&[Z::Right, Z::FrontRight, Z::RearRight]) {
                Some(Origin::Beside { side: LeftRight::Right })
            } else {
                None
            }
        }
        _ => None,
    }
}

/// Whether the two are told to have gone in opposite directions.
fn faces(sv: &Party, partner: &Party) -> bool {
    let ways = told(&sv.heading).zip(told(&partner.heading));
    ways.is_some_and(|(sv, partner)| (3..=5).contains(&sv.eighths_to(partner)))
}
