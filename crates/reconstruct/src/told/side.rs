//! One side of a crash: what is told of one vehicle, person or thing, in the terms of a staging.

use crate::told::doing::Doing;
use crate::told::phase::Phase;
use crate::usual::STANDS_MPS;
use recrash_model::account::{Act, Astride, ContactState, Control, LaneWord, LeftRight, Manner};
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::Size;
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;
use recrash_model::zones::ContactZone;

/// How somebody turns before the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Turning {
    No,
    Left,
    Right,
    Round,
}

/// That somebody slowed, and from which speed, where told. [m/s]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Slowed(pub(crate) Option<f64>);

/// How somebody who reverses came to be at an angle to the road.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slant {
    /// It had turned, to this side where told, before it stood and reversed; out of the opposite direction, where that is told.
    Stood { side: Option<LeftRight>, oncoming: bool },
    /// It swung aside while it reversed.
    Swung,
}

/// One side of the crash.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Side {
    pub(crate) kind: PartnerKind,
    pub(crate) size: Option<Size>,
    pub(crate) state: ContactState,
    /// It stood before it moved, where told.
    pub(crate) stood_first: bool,
    /// It stood already when the story begins.
    pub(crate) stands_from_start: bool,
    /// It is parked, and is told to have come there.
    pub(crate) came_to_park: bool,
    /// It came along out of a lot or a driveway, and did not stop before the road.
    pub(crate) rolls_out: bool,
    /// It is told to have driven along before anything else.
    pub(crate) came_along: bool,
    /// It came to a stop before the last that it did.
    pub(crate) came_there: bool,
    /// Speed on the way there, of who is told to have slowed before the contact and still moved. [m/s]
    pub(crate) slowed_from: Option<Slowed>,
    /// It had slowed, and went on slowly since.
    pub(crate) slowed_early: bool,
    /// It brakes, or swerves, for the turn that the other has begun: late and hard.
    pub(crate) reacts: bool,
    /// It is told to have braked hard.
    pub(crate) brakes_hard: bool,
    /// The same, before it set off last.
    pub(crate) came_hard: bool,
    /// How fast it came before it stopped, where that is told and slower than is usual. [m/s]
    pub(crate) rolled_mps: Option<f64>,
    /// It is told to have gained speed while it drove, and to be under way at the contact.
    pub(crate) gains: bool,
    /// What it did last, ended by what it does at the contact, where that is more than the state says: of the ego.
    pub(crate) phases: Vec<Phase>,
    /// Everything that it is told to have done until the contact and that can be seen, in order.
    pub(crate) acts: Vec<Doing>,
    /// Whether the state is told.
    pub(crate) state_told: bool,
    pub(crate) movement: Option<Movement>,
    pub(crate) turning: Turning,
    /// It goes to turn where the other one it runs into turns or stands: it may have begun to.
    pub(crate) turns_later: bool,
    /// Its turn was over, or all but over.
    pub(crate) turned: bool,
    /// It is told to have come through the junction.
    pub(crate) crossed: bool,
    /// It was completing a lane change.
    pub(crate) completes: bool,
    /// It turns all the way into the road that the other is on, to meet it head-on.
    pub(crate) turns_wide: bool,
    /// To which side it moves out of its line, where told.
    pub(crate) aside: Option<LeftRight>,
    /// By what it left its line, where it did so before it came to a stop.
    pub(crate) stopped_aside: Option<Act>,
    /// It changed lanes on its way, and goes straight on since.
    pub(crate) changed_lanes: bool,
    /// It is told to merge into a lane that is no other than the one where they touch.
    pub(crate) merges_in: bool,
    /// It changed lanes on its way to its first stop: to this side, where told.
    pub(crate) came_over: Option<Option<LeftRight>>,
    /// It changed lanes to pass.
    pub(crate) passes: bool,
    /// It goes round the other one, on the side to which it leaves its line.
    pub(crate) goes_round: bool,
    /// It changed lanes, and goes back to the lane that it left.
    pub(crate) returns: bool,
    /// It is told to have dodged or drifted that way while it drove on.
    pub(crate) dodges: bool,
    /// It backs into a space at the kerb.
    pub(crate) backs_in: bool,
    /// It reverses, and is told to have been at an angle to the road.
    pub(crate) slants: Option<Slant>,
    pub(crate) zones: Vec<ContactZone>,
    /// It was touched on its roof or from below, and nowhere else.
    pub(crate) only_above_or_below: bool,
    /// Touched at its underside, and nowhere else.
    pub(crate) only_below: bool,
    /// How fast it is told to have driven last.
    pub(crate) manner: Option<Manner>,
    /// Speed at the contact, where told. [m/s]
    pub(crate) impact_mps: Option<f64>,
    /// That is told of how it came.
    pub(crate) came_so: bool,
    /// Speed at the contact that is staged. [m/s]
    pub(crate) speed_mps: f64,
    pub(crate) lane: Option<LaneWord>,
    /// Over which line of the road its body reaches, where told.
    pub(crate) astride: Option<Astride>,
    /// It is told to go there, and not to come along it.
    pub(crate) lane_to_come: bool,
    /// The signal or sign in front of it, where told.
    pub(crate) control: Option<Control>,
}

impl Side {
    /// The stated speed at the contact to which it is held: none where its stated state overrules that, since it stood by one of them and
    /// moved by the other. [m/s]
    pub(crate) fn binding_mps(&self) -> Option<f64> {
        let overruled = |mps: f64| self.state_told && (mps < STANDS_MPS) != self.state.stands();
        self.impact_mps.filter(|mps| !overruled(*mps))
    }

    /// Whether it parks, or comes from the kerb or out of a stall.
    pub(super) fn is_slow(&self) -> bool {
        matches!(self.movement, Some(Movement::EnteringTraffic | Movement::ParkingManeuver))
    }

    /// Whether it is told to run, on foot: "ran out from between two trucks".
    pub(crate) fn runs(&self) -> bool {
        self.kind == PartnerKind::Pedestrian
            && self.manner == Some(Manner::Fast)
            && self.state == ContactState::Moving
            && self.impact_mps.is_none()
    }

    /// Whether it stands parked, and is told to have come there: "drove ahead of it and parked".
    pub(crate) fn comes_to_park(&self) -> bool {
        let last = self.acts.iter().rev().find(|doing| !matches!(doing.act, Act::Hold | Act::OpenDoor));
        let comes = |doing: &Doing| matches!(doing.act, Act::Stop | Act::Park | Act::PullOver) && !doing.begun;
        self.state == ContactState::Parked && last.is_some_and(comes)
    }

    /// Whether it is told to have come into a junction.
    pub(crate) fn enters(&self) -> bool {
        self.acts.iter().any(Doing::is_entry)
    }

    /// Whether it left its line before its last stop and again behind it, and not to the other side.
    pub(super) fn goes_aside_twice(&self) -> bool {
        let Some(stop) = self.acts.iter().rposition(Doing::comes_to_stand) else { return false };
        let first = self.acts[..stop].iter().rfind(|doing| doing.leaves_line());
        let second = self.acts[stop..].iter().find(|doing| doing.leaves_line());
        let sides = first.zip(second).map(|(first, second)| first.side.zip(second.side));
        sides.is_some_and(|sides| sides.is_none_or(|(first, second)| first == second))
    }

    /// How often it is told to have set off from a stop since it left its line.
    pub(crate) fn ways_since_aside(&self) -> usize {
        let aside = self.acts.iter().rposition(|doing| doing.leaves_line()).unwrap_or(self.acts.len());
        let stops = self.acts.iter().skip(aside).filter(|doing| doing.comes_to_stand()).count();
        stops.saturating_sub(1)
    }

    /// To which side it passed last, or was about to.
    pub(crate) fn passes_on(&self) -> Option<LeftRight> {
        self.acts.iter().rev().find_map(Doing::passes_on)
    }
}

/// Length and width of one side's box. [m]
pub(crate) fn size_of(side: &Side) -> (f64, f64) {
    let spec = VehicleSpec::of(side.kind);
    side.size.map_or((spec.length_m, spec.width_m), |size| (size.length_m, size.width_m))
}

/// Who walks, or runs on four legs, comes across the kerb; who drives pulls out along it.
pub(crate) fn is_on_foot(kind: PartnerKind) -> bool {
    matches!(kind, PartnerKind::Pedestrian | PartnerKind::Animal)
}
