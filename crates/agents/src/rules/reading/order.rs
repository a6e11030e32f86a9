//! Who was at the place of the conflict first.

use super::{Relation, only};
use recrash_model::metrics::CollisionKind;
use recrash_model::narrative::FirstMover;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// What tells who was first.
pub(super) struct Met<'a> {
    pub(super) relation: Option<Relation>,
    pub(super) collision: Option<CollisionKind>,
    /// Of the ego, of the partner.
    pub(super) movements: (Option<Movement>, Option<Movement>),
    /// On the ego, on the partner.
    pub(super) zones: (&'a [ContactZone], &'a [ContactZone]),
}

/// Who stood there was first; so was who was hit on its rear or side by the other's front; those that drove side by side
/// were there together.
pub(super) fn first(met: &Met) -> Option<FirstMover> {
    let stands = |movement: Option<Movement>| matches!(movement, Some(Movement::Stopped | Movement::Parked));
    match (stands(met.movements.0), stands(met.movements.1)) {
        (true, false) => return Some(FirstMover::Sv),
        (false, true) => return Some(FirstMover::Cp),
        _ => {}
    }
    let (sv, cp) = met.zones;
    match (met.relation, met.collision) {
        (_, Some(CollisionKind::RearEndOfEgo)) => return Some(FirstMover::Sv),
        (_, Some(CollisionKind::RearEndByEgo)) => return Some(FirstMover::Cp),
        (Some(Relation::Behind), _) if only(sv, ContactZone::is_rear) => return Some(FirstMover::Sv),
        // Who turns off across the other's way cannot be beside it then.
        (Some(Relation::Beside(_)), _) if !turns(met.movements.0) && !turns(met.movements.1) => {
            return Some(FirstMover::Both);
        }
        _ => {}
    }
    let flank = |zones: &[ContactZone]| zones.iter().any(|zone| is_flank(*zone));
    match (only(sv, ContactZone::is_front), only(cp, ContactZone::is_front)) {
        (true, true) => Some(FirstMover::Both),
        (true, false) if flank(cp) => Some(FirstMover::Cp),
        (false, true) if flank(sv) => Some(FirstMover::Sv),
        // Of those who are not asked for their contact areas the ego's tell.
        (true, _) if cp.is_empty() => Some(FirstMover::Cp),
        (false, _) if cp.is_empty() && flank(sv) => Some(FirstMover::Sv),
        _ if matches!(met.relation, Some(Relation::Beside(_))) => Some(FirstMover::Both),
        _ => None,
    }
}

fn turns(movement: Option<Movement>) -> bool {
    matches!(movement, Some(Movement::LeftTurn | Movement::RightTurn))
}

fn is_flank(zone: ContactZone) -> bool {
    matches!(zone, ContactZone::Left | ContactZone::Right) || zone.is_rear()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ContactZone::{Front, FrontLeft, Left, Rear, Right};
    use Movement::{Stopped, Straight};

    fn met<'a>(sv: &'a [ContactZone], cp: &'a [ContactZone]) -> Met<'a> {
        Met { relation: None, collision: None, movements: (Some(Straight), Some(Straight)), zones: (sv, cp) }
    }

    #[test]
    fn who_was_hit_by_a_front_was_first() {
        assert_eq!(first(&met(&[Left], &[Front])), Some(FirstMover::Sv));
        assert_eq!(first(&met(&[Front], &[Right])), Some(FirstMover::Cp));
        assert_eq!(first(&met(&[Front, FrontLeft], &[Front])), Some(FirstMover::Both));
        assert_eq!(first(&met(&[Rear], &[])), Some(FirstMover::Sv));
        assert_eq!(first(&met(&[], &[])), None);
    }

    #[test]
    fn who_stood_was_first_and_side_by_side_is_together() {
        let standing = Met { movements: (Some(Straight), Some(Stopped)), ..met(&[Front], &[Front]) };
        assert_eq!(first(&standing), Some(FirstMover::Cp));
        let beside = Met { relation: Some(Relation::Beside(None)), ..met(&[Left], &[Front]) };
        assert_eq!(first(&beside), Some(FirstMover::Both));
    }
}
