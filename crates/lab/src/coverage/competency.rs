//! The second dimension of the UN guidance: behavioural competencies, as far as an account tells that one was asked for.

use super::{Place, Plan};
use recrash_model::account::{
    Account, Act, ContactState, CrashType, Driver, FirstContact, Kind, KindGroup, LeftRight, MatrixEvent, MatrixObject,
    Origin, RoadFeature, StandReason, Striker, told,
};
use recrash_model::template::Movement;

const RESPOND: &str = "detect and respond to";
const MANOEUVRE: &str = "manoeuvre";
const FALLBACK: &str = "fallback";

/// A competency, and whether an account asks for it.
type Competency = (&'static str, &'static str, fn(&Account) -> bool);

const COMPETENCIES: [Competency; 35] = {
    use MatrixEvent as E;
    [
        (RESPOND, "a vehicle ahead that slows, stops or sets off", |a| {
            vehicle_event(a, &[E::LeadDecelerating, E::LeadStopped, E::LeadAccelerating])
        }),
        (RESPOND, "a vehicle that changes lanes, cuts in or comes over from beside", |a| {
            vehicle_event(a, &[E::ChangingLanes, E::CuttingIn, E::EncroachingAdjacent])
        }),
        (RESPOND, "a vehicle that cuts out", |a| vehicle_event(a, &[E::CuttingOut])),
        (RESPOND, "an oncoming vehicle that comes over", |a| vehicle_event(a, &[E::EncroachingOpposing])),
        (RESPOND, "a vehicle that turns", |a| vehicle_event(a, &[E::Turning])),
        (RESPOND, "a vehicle that enters the road", |a| vehicle_event(a, &[E::EnteringRoadway])),
        (RESPOND, "a vehicle from behind", |a| is_vehicle(a) && told(&a.came_from) == Some(Origin::Behind)),
        (RESPOND, "a vehicle that stands or is parked", |a| {
            is_vehicle(a) && partner_state(a).is_some_and(ContactState::stands)
        }),
        (RESPOND, "a vehicle that goes backwards", |a| {
            is_vehicle(a) && partner_state(a) == Some(ContactState::Reversing)
        }),
        (RESPOND, "a door that opens", |a| matches!(told(&a.door), Some(Striker::Cp | Striker::Both))),
        (RESPOND, "a motorcycle", |a| group(a) == Some(KindGroup::Motorcycle)),
        (RESPOND, "a cyclist", |a| group(a) == Some(KindGroup::Cyclist)),
        (RESPOND, "somebody on foot", |a| group(a) == Some(KindGroup::OnFoot)),
        (RESPOND, "an animal", |a| group(a) == Some(KindGroup::Animal)),
        (RESPOND, "a thing", |a| group(a) == Some(KindGroup::Object)),
        (RESPOND, "an emergency vehicle", emergency),
        (RESPOND, "a school bus", |a| partner_kind(a) == Some(Kind::SchoolBus)),
        (RESPOND, "rails and what runs on them", |a| has(a, RoadFeature::Rails) || partner_kind(a) == Some(Kind::Tram)),
        (RESPOND, "a work zone", |a| has(a, RoadFeature::WorkZone)),
        (RESPOND, "a crash among others", |a| {
            let others =
                matches!(told(&a.first_contact), Some(FirstContact::PartnerAndOther | FirstContact::OthersOnly));
            others || told(&a.crash_type) == Some(CrashType::Secondary)
        }),
        (MANOEUVRE, "go along its lane", |a| moves(a, &[Movement::Straight], &[Act::Follow])),
        (MANOEUVRE, "turn left", |a| moves(a, &[Movement::LeftTurn], &[]) || turned(a, LeftRight::Left)),
        (MANOEUVRE, "turn right", |a| moves(a, &[Movement::RightTurn], &[]) || turned(a, LeftRight::Right)),
        (MANOEUVRE, "turn round", |a| moves(a, &[Movement::UTurn], &[Act::UTurn])),
        (MANOEUVRE, "change lanes or merge", |a| {
            moves(a, &[Movement::ChangingLanes, Movement::Merging], &[Act::LaneChange])
        }),
        (MANOEUVRE, "pass", |a| moves(a, &[Movement::Passing], &[Act::Pass])),
        (MANOEUVRE, "set off or enter traffic", |a| {
            moves(a, &[Movement::EnteringTraffic], &[Act::SetOff, Act::PullOut])
                || told(&a.sv.state) == Some(ContactState::SettingOff)
        }),
        (MANOEUVRE, "park or pull over", |a| moves(a, &[Movement::ParkingManeuver], &[Act::Park, Act::PullOver])),
        (MANOEUVRE, "go backwards", |a| {
            moves(a, &[Movement::Backing], &[Act::Reverse]) || told(&a.sv.state) == Some(ContactState::Reversing)
        }),
        (MANOEUVRE, "stop and stand in traffic", |a| told(&a.sv.state) == Some(ContactState::Stopped)),
        (MANOEUVRE, "stand parked", |a| told(&a.sv.state) == Some(ContactState::Parked)),
        (MANOEUVRE, "let passengers in or out", |a| stood_for(a, StandReason::PickupDropoff)),
        (MANOEUVRE, "let a door of its own open", |a| matches!(told(&a.door), Some(Striker::Sv | Striker::Both))),
        (MANOEUVRE, "give way standing", |a| stood_for(a, StandReason::Yield)),
        (FALLBACK, "a human takes over before the contact", |a| told(&a.driver) == Some(Driver::HumanTookOver)),
    ]
};

pub(super) fn plan() -> Plan {
    let values = |(kind, name, _): &Competency| vec![(*kind).to_owned(), (*name).to_owned()];
    let listed = COMPETENCIES.iter().map(values).collect();
    Plan::listing(("behavioural-competency", "Behavioural competency"), &["kind", "competency"], listed, |account| {
        let asked: Vec<Vec<String>> = COMPETENCIES
            .iter()
            .filter(|(_, _, asks)| asks(account))
            .map(|(kind, name, _)| vec![(*kind).to_owned(), (*name).to_owned()])
            .collect();
        if asked.is_empty() { Place::Outside("no competency is told to be asked for") } else { Place::In(asked) }
    })
    .overlapping()
}

pub(super) fn partner_kind(account: &Account) -> Option<Kind> {
    told(&account.partner.as_ref()?.kind)
}

pub(super) fn group(account: &Account) -> Option<KindGroup> {
    partner_kind(account).map(Kind::group)
}

pub(super) fn has(account: &Account, feature: RoadFeature) -> bool {
    account.place.features.iter().any(|told| told.value == feature)
}

pub(super) fn emergency(account: &Account) -> bool {
    use Kind::{Ambulance, FireTruck, FirstResponder, PoliceCar};
    matches!(partner_kind(account), Some(PoliceCar | Ambulance | FireTruck | FirstResponder))
}

fn is_vehicle(account: &Account) -> bool {
    partner_kind(account).is_some_and(Kind::is_vehicle)
}

fn partner_state(account: &Account) -> Option<ContactState> {
    told(&account.partner.as_ref()?.state)
}

fn vehicle_event(account: &Account, events: &[MatrixEvent]) -> bool {
    told(&account.matrix).is_some_and(|cell| cell.object == MatrixObject::Vehicle && events.contains(&cell.event))
}

fn moves(account: &Account, movements: &[Movement], acts: &[Act]) -> bool {
    told(&account.sv.movement).is_some_and(|movement| movements.contains(&movement))
        || acts.iter().any(|&act| account.sv.did(act))
}

fn turned(account: &Account, side: LeftRight) -> bool {
    account.sv.acts.iter().any(|fact| fact.act == Act::Turn && !fact.after_contact && fact.side == Some(side))
}

fn stood_for(account: &Account, reason: StandReason) -> bool {
    account.sv.reasons.iter().any(|fact| fact.value == reason)
}
