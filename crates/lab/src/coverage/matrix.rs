//! The objects-by-events matrix of EU 2022/1426, Annex III, Appendix 1.

use super::{Place, Plan, words};
use recrash_model::account::{Account, MatrixCell, MatrixEvent, MatrixObject, Origin, told};

/// Events of each object.
const ROWS: [(MatrixObject, &[MatrixEvent]); 6] = {
    use MatrixEvent::{
        AlongRoad, ChangingLanes, CrossingInCrosswalk, CrossingOutsideCrosswalk, CuttingIn, CuttingOut,
        EncroachingAdjacent, EncroachingOpposing, EnteringRoadway, LeadAccelerating, LeadDecelerating, LeadStopped,
        MovingIntoLane, RidingBeside, RidingInLane, StaticInLane, Turning,
    };
    [
        (
            MatrixObject::Vehicle,
            &[
                LeadDecelerating,
                LeadStopped,
                LeadAccelerating,
                ChangingLanes,
                CuttingIn,
                Turning,
                EncroachingOpposing,
                EncroachingAdjacent,
                EnteringRoadway,
                CuttingOut,
            ],
        ),
        (MatrixObject::Pedestrian, &[CrossingInCrosswalk, CrossingOutsideCrosswalk, AlongRoad]),
        (
            MatrixObject::Cyclist,
            &[RidingInLane, RidingBeside, AlongRoad, CrossingInCrosswalk, CrossingOutsideCrosswalk],
        ),
        (MatrixObject::Animal, &[StaticInLane, MovingIntoLane, AlongRoad]),
        (MatrixObject::Debris, &[StaticInLane]),
        (MatrixObject::OtherObject, &[StaticInLane, MovingIntoLane]),
    ]
};

pub(super) fn plan() -> Plan {
    let listed = ROWS
        .into_iter()
        .flat_map(|(object, events)| events.iter().map(move |event| vec![words(&object), words(event)]))
        .collect();
    Plan::listing(
        ("eu-2022-1426", "Objects by events, EU 2022/1426, Annex III, Appendix 1"),
        &["object", "event"],
        listed,
        |account| match told(&account.matrix) {
            Some(MatrixCell { object, event }) => Place::In(vec![vec![words(&object), words(&event)]]),
            None => Place::Outside(why_outside(account)),
        },
    )
}

fn why_outside(account: &Account) -> &'static str {
    match (&account.partner, told(&account.came_from)) {
        (None, _) => "nobody and nothing was touched",
        (_, Some(Origin::Behind)) => "the other came from behind: the matrix has no such event",
        (_, Some(Origin::Above)) => "it came from above: the matrix has no such event",
        (_, Some(_)) => "no event of the matrix fits",
        (_, None) => "from where the other came is not told",
    }
}
