//! The pre-crash scenario and the cell of the matrix, from what kind of crash it is.

use super::types::{turn_side, turning};
use recrash_model::account::{
    Account, Act, ContactState, CrashType, Fact, Kind, KindGroup, LeftRight, MatrixCell, MatrixEvent, MatrixObject,
    Origin, Party, PrecrashScenario, told,
};

fn group(account: &Account) -> Option<KindGroup> {
    account.partner.as_ref().and_then(|partner| told(&partner.kind)).map(Kind::group)
}

/// Whether the subject vehicle made a manoeuvre before.
fn manoeuvre(account: &Account) -> bool {
    [Act::Turn, Act::UTurn, Act::LaneChange, Act::Pass, Act::Reverse, Act::PullOut, Act::Park, Act::PullOver]
        .into_iter()
        .any(|act| account.sv.did(act))
}

/// NHTSA's pre-crash scenario.
pub(crate) fn scenario(account: &Account) -> Option<Fact<PrecrashScenario>> {
    use PrecrashScenario as S;
    let partner = account.partner.as_ref()?;
    let moved = manoeuvre(account);
    let either = |with: S, without: S| if moved { with } else { without };
    let crash_type = told(&account.crash_type)?;
    let value = match crash_type {
        _ if either_did(account, partner, Act::RunRed) => S::RunningRedLight,
        _ if either_did(account, partner, Act::RunStop) => S::RunningStopSign,
        CrashType::Pedestrian => either(S::PedestrianWithManeuver, S::Pedestrian),
        CrashType::Cyclist => either(S::CyclistWithManeuver, S::Cyclist),
        CrashType::SingleVehicle => either(S::ObjectWithManeuver, S::Object),
        CrashType::Backing => S::Backing,
        CrashType::FrontToRear | CrashType::Secondary => in_one_lane(account, partner),
        CrashType::Motorcycle => match told(&account.came_from) {
            Some(Origin::Behind | Origin::Ahead) => in_one_lane(account, partner),
            _ => S::Other,
        },
        CrashType::HeadOn if moved || partner.did(Act::Pass) || partner.did(Act::LaneChange) => S::OppositeWithManeuver,
        CrashType::HeadOn => S::Opposite,
        CrashType::Intersection => at_junction(account, partner),
        CrashType::Lateral => side_by_side(account, partner),
        CrashType::Other => match group(account) {
            Some(KindGroup::Animal) => either(S::AnimalWithManeuver, S::Animal),
            _ => S::Other,
        },
    };
    Some(Fact::by_rule(value, "crash type, acts and control"))
}

/// Whether one of the two did this.
fn either_did(account: &Account, partner: &Party, act: Act) -> bool {
    partner.did(act) || account.sv.did(act)
}

/// One behind the other: by what the one ahead did.
fn in_one_lane(account: &Account, partner: &Party) -> PrecrashScenario {
    use PrecrashScenario as S;
    let ahead = matches!(told(&account.came_from), Some(Origin::Ahead));
    let (lead, following) = if ahead { (partner, &account.sv) } else { (&account.sv, partner) };
    if following.did(Act::LaneChange) || following.did(Act::Pass) {
        return S::FollowingWithManeuver;
    }
    match told(&lead.state) {
        Some(state) if state.stands() => S::LeadStopped,
        Some(ContactState::SettingOff) => S::LeadAccelerating,
        _ if lead.did(Act::Slow) || lead.did(Act::Stop) => S::LeadDecelerating,
        _ => S::LeadSlower,
    }
}

/// At a junction: by who turned to where.
fn at_junction(account: &Account, partner: &Party) -> PrecrashScenario {
    use PrecrashScenario as S;
    let signal =
        account.place.features.iter().any(|feature| feature.value == recrash_model::account::RoadFeature::Signal);
    let turn = turn_side(&account.sv).or_else(|| turn_side(partner));
    match (told(&account.came_from), turn) {
        (Some(Origin::Opposite), Some(LeftRight::Left)) if signal => S::LeftTurnOppositeSignal,
        (Some(Origin::Opposite), Some(LeftRight::Left)) => S::LeftTurnOpposite,
        (Some(Origin::Beside { .. } | Origin::Behind | Origin::Ahead), Some(_)) => S::TurningSameDirection,
        (_, Some(LeftRight::Right)) if signal => S::RightTurnSignal,
        (_, Some(_)) => S::TurningCrossing,
        _ => S::StraightCrossing,
    }
}

/// Side by side: by what either did.
fn side_by_side(account: &Account, partner: &Party) -> PrecrashScenario {
    use PrecrashScenario as S;
    let did = |act: Act| either_did(account, partner, act);
    if did(Act::Park) || did(Act::PullOut) {
        S::ParkingSameDirection
    } else if did(Act::LaneChange) || did(Act::Pass) {
        S::ChangingLanesSameDirection
    } else if turning(&account.sv) || turning(partner) {
        S::TurningSameDirection
    } else {
        S::DriftingSameDirection
    }
}

/// Cell of the matrix of EU 2022/1426; what comes from behind has none.
pub(crate) fn matrix(account: &Account) -> Option<Fact<MatrixCell>> {
    use {MatrixEvent as E, MatrixObject as O};
    let partner = account.partner.as_ref()?;
    let kind = told(&partner.kind)?;
    let origin = told(&account.came_from);
    let crosswalk =
        account.place.features.iter().any(|feature| feature.value == recrash_model::account::RoadFeature::Crosswalk);
    let crossing = if crosswalk { E::CrossingInCrosswalk } else { E::CrossingOutsideCrosswalk };
    let cell = match kind.group() {
        KindGroup::OnFoot => match origin {
            Some(Origin::Cross { .. }) | None => (O::Pedestrian, crossing),
            Some(Origin::Sidewalk { .. }) => (O::Pedestrian, E::AlongRoad),
            _ => return None,
        },
        KindGroup::Cyclist => match origin {
            Some(Origin::Cross { .. } | Origin::Sidewalk { .. }) => (O::Cyclist, crossing),
            Some(Origin::Ahead) => (O::Cyclist, E::RidingInLane),
            Some(Origin::Beside { .. }) => (O::Cyclist, E::RidingBeside),
            _ => return None,
        },
        KindGroup::Animal => (O::Animal, E::MovingIntoLane),
        KindGroup::Object => {
            let moves = partner.did(Act::Fall) || partner.did(Act::Roll);
            if kind == Kind::Debris || kind == Kind::Object {
                (O::Debris, E::StaticInLane)
            } else {
                (O::OtherObject, if moves { E::MovingIntoLane } else { E::StaticInLane })
            }
        }
        _ => {
            let event = match origin? {
                Origin::Behind | Origin::Above => return None,
                Origin::Ahead => match told(&partner.state) {
                    Some(state) if state.stands() => E::LeadStopped,
                    Some(ContactState::SettingOff) => E::LeadAccelerating,
                    _ if partner.did(Act::Turn) => E::Turning,
                    _ => E::LeadDecelerating,
                },
                Origin::Opposite if partner.did(Act::Turn) => E::Turning,
                Origin::Opposite => E::EncroachingOpposing,
                Origin::Beside { .. } if partner.did(Act::LaneChange) => E::CuttingIn,
                Origin::Beside { .. } if partner.did(Act::Turn) => E::Turning,
                Origin::Beside { .. } => E::EncroachingAdjacent,
                Origin::Cross { .. } if partner.did(Act::Turn) => E::Turning,
                Origin::Cross { .. }
                | Origin::Stall { .. }
                | Origin::Driveway { .. }
                | Origin::Parked { .. }
                | Origin::Sidewalk { .. } => E::EnteringRoadway,
            };
            (O::Vehicle, event)
        }
    };
    Some(Fact::by_rule(MatrixCell { object: cell.0, event: cell.1 }, "kind, origin and acts"))
}
