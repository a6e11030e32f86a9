//! Things that move by themselves: what rolls, slides or is pushed into the way, and gates; and who walks or
//! runs into it.

use crate::lateral::is_on_foot;
use crate::pace::{Pace, start_over};
use crate::told::Told;
use recrash_model::account::{Act, ContactState, Kind, LeftRight, Origin, Party, Striker, told};
use recrash_model::math;
use recrash_model::scenario::Size;
use recrash_model::template::Movement;

/// How fast a thing is that rolls or slides, from how far away. [m/s, m]
pub(crate) const SLIDES_MPS: f64 = 2.0;
const SLIDES_M: f64 = 4.0;

/// Whether it is told of a thing that it came into the way. What has fallen lies there.
pub(crate) fn slides(thing: &Party) -> bool {
    let acts = [Act::Roll, Act::Pushed, Act::Enter, Act::Cross, Act::Swerve, Act::Drift, Act::LaneChange];
    acts.into_iter().any(|act| thing.did(act))
}

/// Whether it is told of a gate or a barrier that it swung, came down, was opened or struck as the two met.
pub(crate) fn swings(kind: Kind, thing: &Party, striker: Option<Striker>) -> bool {
    let acts = [Act::OpenDoor, Act::Fall, Act::SetOff, Act::Turn, Act::Roll, Act::Swerve, Act::Drift, Act::Enter];
    let moves = striker == Some(Striker::Cp) || told(&thing.state).is_some_and(|state| !state.stands());
    matches!(kind, Kind::Gate | Kind::Barrier) && (moves || acts.into_iter().any(|act| thing.did(act)))
}

/// Size of the post of a gate that swings. [m]
pub(crate) const POST: Size = Size { length_m: 0.3, width_m: 0.3 };

impl Told {
    /// Whether the partner is a thing that came into the way by itself.
    pub(crate) fn is_sliding(&self) -> bool {
        self.thing.is_some() && self.slides && self.cp.state == ContactState::Moving
    }

    /// Whether the partner comes across from aside: a thing, somebody on foot, or an animal.
    pub(crate) fn comes_across(&self) -> bool {
        self.is_sliding() || self.walks_across && self.cp.state == ContactState::Moving
    }
}

/// Whether it is told of somebody on foot, or of an animal, that it went into the ego's way or across.
pub(crate) fn walks_across(origin: Origin, partner: &Party) -> bool {
    let along = matches!(origin, Origin::Ahead | Origin::Beside { .. });
    let on_foot = told(&partner.kind).and_then(Kind::partner_kind).is_some_and(is_on_foot);
    let crosses = told(&partner.movement) == Some(Movement::NmCrossing);
    let enters = [Act::Cross, Act::Enter, Act::PullOut].into_iter().any(|act| partner.did(act));
    along && on_foot && (crosses || enters)
}

/// It lies or stands aside, and then comes.
pub(crate) fn pace(told: &Told) -> Option<Pace> {
    told.comes_across().then(|| start_over(told.contact_s, told.cp.speed_mps, SLIDES_M)).flatten()
}

/// Across the ego's lane: from the told side, or from both.
pub(crate) fn headings(told: &Told) -> Vec<f64> {
    let from = match told.origin {
        Origin::Beside { side } | Origin::Cross { side } => vec![side],
        _ => vec![LeftRight::Right, LeftRight::Left],
    };
    let across = |side: LeftRight| if side == LeftRight::Left { -math::FRAC_PI_2 } else { math::FRAC_PI_2 };
    from.into_iter().flat_map(|side| [0.0, 0.5, -0.5].map(|off| across(side) + off)).collect()
}
