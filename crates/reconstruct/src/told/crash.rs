//! An account, in the terms of a staging.

use crate::told::choices::Choices;
use crate::told::doing::Doing;
use crate::told::layout::{Counted, Layout};
use crate::told::lies::Lies;
use crate::told::others::{Extra, Role, Thrower};
use crate::told::phase::Phase;
use crate::told::rig::Rig;
use crate::told::side::{Side, Turning};
use recrash_model::account::{
    Act, Astride, ContactState, Control, ControlDevice, CrashType, EarlierTouch, Kind, LeftRight, Obeyed, Origin,
    PlaceKind, SignalState, StandReason, Striker,
};
use recrash_model::narrative::FirstMover;
use recrash_model::template::Movement;

/// How somebody that stood at a red light came over its line, and did not run it: to turn right, or by a little.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AtRed {
    Turns,
    Creeps,
}

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
    /// It is told to have opened: it lay across the way.
    pub(crate) gate_opens: bool,
    /// How the partner lies that the ego drives over, where told.
    pub(crate) lies: Option<Lies>,
    /// Which of the others the partner fell off, or came out from under, ahead of the ego.
    pub(crate) dropped: Option<usize>,
    /// It is a branch or the like that reaches into the ego's lane from this side.
    pub(crate) reaches_in: Option<LeftRight>,
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
    /// It is told in which direction the partner went.
    pub(crate) heading_told: bool,
    /// It is told to have gone, or faced, against the ego's way.
    pub(crate) faces: bool,
    /// The partner came from the kerb behind the ego, round it.
    pub(crate) comes_round: bool,
    /// An oncoming partner left its own side.
    pub(crate) comes_over: bool,
    pub(crate) order: Option<FirstMover>,
    /// The ego's own trailer is told to have been touched.
    pub(crate) sv_trailer: bool,
    /// The kind of the partner whose trailer is told to have touched.
    pub(crate) trailer_of: Option<Kind>,
    /// Who comes by with a trailer that touches is drawn as two, where that shows what is told; and what is drawn.
    pub(crate) wanted_rig: Option<Rig>,
    pub(crate) rig: Option<Rig>,
    /// Somebody threw the partner at the subject vehicle; and who, where told.
    pub(crate) pushed: bool,
    pub(crate) pusher: Option<Kind>,
    pub(crate) thrower: Option<Thrower>,
    /// How it touched the partner, where told.
    pub(crate) touch: Option<EarlierTouch>,
    /// Who touched the partner first is told to stand: the partner ran into it.
    pub(crate) pusher_stands: bool,
    /// It is told to have been fast.
    pub(crate) pusher_fast: bool,
    /// Who was pushed is told to have come along or slowed, and not to have stood.
    pub(crate) pushed_rolling: bool,
    /// So many of the others are told to have touched the partner first.
    pub(crate) throwers: usize,
    pub(crate) striker: Option<Striker>,
    /// It is words that tell who struck the other.
    pub(crate) strikes: Option<Striker>,
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
    /// Which of them are told over a line of the road.
    pub(crate) others_astride: Vec<(usize, Astride)>,
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
    /// The partner backed already as the ego came and stopped for it, before that backed too.
    pub(crate) backs_as_it_comes: bool,
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
    /// The partner turns out of any lane of its road, and not out of the one for its turn.
    pub(crate) any_lane: bool,
    /// When they touch. [s]
    pub(crate) contact_s: f64,
    pub(crate) choices: Choices,
    pub(crate) assumed: Vec<String>,
}

impl Told {
    /// Whether the partner does more than stand there, or swing.
    pub(crate) fn partner_acts(&self) -> bool {
        !(self.gate_swings || self.thing.is_some() && self.cp.state.stands())
    }

    /// Whether the ego is told to have come into the junction.
    pub(crate) fn enters(&self) -> bool {
        !self.plainly && self.sv.enters()
    }

    /// Whether a signal or sign is told.
    pub(crate) fn is_controlled(&self) -> bool {
        self.sv.control.is_some() || self.cp.control.is_some()
    }

    /// Whether somebody throws the partner at the ego from behind: both stood in one lane, or came along it.
    pub(crate) fn is_thrown(&self) -> bool {
        let changes =
            matches!(self.cp.movement, Some(Movement::ChangingLanes | Movement::Merging)) && self.cp.stood_first;
        let behind = self.origin == Origin::Behind && self.cp.state != ContactState::Reversing;
        self.pushed && behind && self.thing.is_none() && !changes && !self.touched_on_its_way()
    }

    /// Whether the partner made contact with another, with its front or along a flank.
    fn touched_on_its_way(&self) -> bool {
        let touch = self.touch.filter(|_| matches!(self.thrower, Some(Thrower::Beside(_))));
        touch.is_some_and(|touch| touch.by_partner && touch.of_partner.is_some_and(|zone| !zone.is_rear()))
    }

    /// How an ego that stood at a red light may have come over its line without running it: to turn right, where words tell that it did so at red, or
    /// where it came to a stand in its turn and nothing tells that the light changed, or that it waited for that; or by a little, to stand again. Of who drives on in its turn an account
    /// holds no words for a light that "changed": it may have waited for that.
    pub(crate) fn keeps_red(&self) -> Option<AtRed> {
        let red = |said: &Control| said.state == Some(SignalState::Red) && said.obeyed != Some(Obeyed::No);
        let moved_up = self.sv.phases.ends_with(&[Phase::Stands, Phase::Drives, Phase::Stands]);
        let creeps = self.sv.enters() && moved_up && self.sv.turning == Turning::No;
        // "stopped at the red light and, after cross traffic had cleared, turned right": at red, where nobody tells that it changed.
        let lets_by = self.wanted.iter().any(|extra| extra.role == Role::Crosser);
        let right = self.sv.turning == Turning::Right && (!self.sv.turns_later || lets_by);
        let waits = (self.sv.state.stands() || lets_by) && !self.layout.light_changes;
        let turns = right && (self.layout.on_red || waits);
        let how = match (turns, creeps) {
            (true, _) => Some(AtRed::Turns),
            (_, true) => Some(AtRed::Creeps),
            _ => None,
        };
        how.filter(|_| self.sv.control.as_ref().is_some_and(red))
    }

    /// Whether the ego is told last to have come to a stop at a light that turned yellow, and nobody who waited there set off for that.
    pub(crate) fn stops_at_yellow(&self) -> bool {
        let yellow = |said: Control| said.device == ControlDevice::Signal && said.state == Some(SignalState::Yellow);
        let last = self.sv.acts.iter().rfind(|doing| doing.act != Act::Hold);
        let stops = self.sv.state == ContactState::Stopped && last.is_some_and(Doing::comes_to_stand);
        let behind = self.origin == Origin::Behind;
        let waits = self.cp.stood_first || self.cp.state == ContactState::SettingOff || self.queued;
        stops && behind && self.sv.control.is_some_and(yellow) && !waits
    }

    /// Whether a partner with no light of its own comes through the junction towards an ego that stands at its red one.
    pub(crate) fn comes_through_red(&self) -> bool {
        let drives = self.cp.state == ContactState::Moving && self.cp.control.is_none();
        self.origin == Origin::Opposite && drives && self.sv.state == ContactState::Stopped
    }

    /// Whether a partner that enters traffic ahead of the ego, or beside it, is told to have come along there, and not to have stood.
    pub(crate) fn came_along_there(&self) -> bool {
        matches!(self.origin, Origin::Ahead | Origin::Beside { .. }) && self.cp.came_along
    }

    /// Which lane of its road one of the two is told to be in, counted from a side.
    pub(crate) fn counted(&self, of_ego: bool) -> Option<Counted> {
        if of_ego { self.layout.sv.counted } else { self.layout.cp.counted }
    }

    /// Whether the ego sets off at a signal with nobody ahead of it.
    pub(crate) fn sets_off_first(&self) -> bool {
        let at_signal = self.sv.control.is_some_and(|said| said.device == ControlDevice::Signal);
        // Who waits behind it sets the pace where it does.
        let waits = self.cp.stood_first || self.cp.state == ContactState::SettingOff || self.queued;
        let once = self.sv.phases.len() <= 3 && !waits && !self.plainly;
        self.sv.state == ContactState::SettingOff && at_signal && self.origin == Origin::Behind && once
    }
}
