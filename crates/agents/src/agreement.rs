//! Whether a narrative tells the crash that the account of its incident tells.

use crate::rules::staged::Facts;
use recrash_model::account::{Account, ContactState, CrashType, Kind, KindGroup, LeftRight, Origin, Source, told};
use recrash_model::metrics::CollisionKind;
use recrash_model::narrative::{Narrative, Side};
use recrash_model::profile::SystemProfile;
use recrash_model::scenario::Approach;
use recrash_model::template::Movement;

/// What of an account speaks against a narrative of its incident, in words for a reason: another kind of collision, another
/// place the partner came from, another movement, an ego that stood. What the account does not tell speaks against nothing.
pub fn disagreement(narrative: &Narrative, account: &Account, profile: &SystemProfile) -> Option<String> {
    let excludes = |kinds: &[CollisionKind]| kinds.iter().any(|kind| profile.excludes.collisions.contains(kind));
    match told(&account.crash_type) {
        Some(kind @ CrashType::FrontToRear)
            if excludes(&[CollisionKind::RearEndByEgo, CollisionKind::RearEndOfEgo]) =>
        {
            return Some(format!("it was a {} crash, which the profile \"{}\" excludes", kind.label(), profile.name));
        }
        Some(kind @ CrashType::HeadOn) if excludes(&[CollisionKind::HeadOn]) => {
            return Some(format!("it was a {} crash, which the profile \"{}\" excludes", kind.label(), profile.name));
        }
        _ => {}
    }
    if let Some(ContactState::Stopped | ContactState::Parked) = told(&account.sv.state) {
        return Some("the ego stood".to_owned());
    }
    let partner = account.partner.as_ref();
    let movements = [
        (Who::Ego, told(&account.sv.movement), narrative.template.sv),
        (Who::Partner, partner.and_then(|partner| told(&partner.movement)), narrative.template.cp),
    ];
    for (who, said, wanted) in movements {
        if let Some(said) = said.filter(|said| !goes_as(*said, wanted, who)) {
            return Some(format!("{} was {}", who.words(), said.label().to_lowercase()));
        }
    }
    let facts = Facts(&narrative.facts);
    let came_from = account.came_from.as_ref()?;
    let from = came_from.value;
    let rides = partner.and_then(|partner| told(&partner.kind)).map(Kind::group);
    // Who goes along on the sidewalk and over the crosswalk is beside the road, and crosses it: where that is only inferred, both are
    // the same. And who comes from behind on it comes up beside the ego.
    let inferred = matches!(came_from.source, Source::Rule { .. }) && side_of(from) == facts.side();
    let on_the_sidewalk = matches!(rides, Some(KindGroup::Cyclist | KindGroup::OnFoot))
        && facts.approach() == Some(Approach::Same)
        && (inferred || (from == Origin::Behind && facts.side().is_some()));
    if on_the_sidewalk {
        return None;
    }
    (!is_same_way(from, facts.approach()?, facts.side())).then(|| format!("the partner came {}", from.words()))
}

/// The two of a crash.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Who {
    Ego,
    Partner,
}

impl Who {
    fn words(self) -> &'static str {
        match self {
            Self::Ego => "the ego",
            Self::Partner => "the partner",
        }
    }
}

/// Whether a told movement is the template's. Partners are staged moving over too, and coming out of side roads; egos are not.
fn goes_as(said: Movement, wanted: Movement, who: Who) -> bool {
    match said {
        Movement::Passing | Movement::NmCrossing => wanted == Movement::Straight,
        Movement::ChangingLanes | Movement::Merging | Movement::EnteringTraffic if who == Who::Partner => true,
        said => said == wanted,
    }
}

/// On which side a place of origin is.
fn side_of(from: Origin) -> Option<Side> {
    let side = match from {
        Origin::Beside { side } | Origin::Cross { side } => Some(side),
        Origin::Stall { side } | Origin::Driveway { side } | Origin::Sidewalk { side } => side,
        Origin::Behind | Origin::Ahead | Origin::Opposite | Origin::Parked { .. } | Origin::Above => None,
    };
    side.map(|side| if side == LeftRight::Left { Side::Left } else { Side::Right })
}

/// Whether a place of origin is an approach of the templates.
fn is_same_way(from: Origin, approach: Approach, side: Option<Side>) -> bool {
    match from {
        Origin::Opposite => approach == Approach::Opposite,
        Origin::Beside { .. } => approach == Approach::Same && (side.is_none() || side == side_of(from)),
        Origin::Cross { .. } | Origin::Stall { .. } | Origin::Driveway { .. } | Origin::Sidewalk { .. } => {
            match side_of(from) {
                Some(Side::Left) => approach == Approach::Left,
                Some(Side::Right) => approach == Approach::Right,
                None => true,
            }
        }
        Origin::Behind | Origin::Ahead | Origin::Parked { .. } | Origin::Above => false,
    }
}
