//! The fourth dimension of the UN guidance: rules of the road, by the articles of the Vienna Convention on Road Traffic of
//! 1968, and whom each binds in the story.

use super::competency::{emergency, group, has, partner_kind};
use super::crash::has_control;
use super::{Place, Plan, Values};
use recrash_model::account::{
    Account, Act, ContactState, ControlDevice, CrashType, Kind, KindGroup, Origin, Party, PlaceKind, RoadFeature,
    StandReason, Striker, told,
};
use recrash_model::template::Movement;

/// Who is bound by a rule.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Sv,
    Other,
}

impl Side {
    fn name(self) -> &'static str {
        match self {
            Self::Sv => "subject vehicle",
            Self::Other => "other road user",
        }
    }
}

/// One side of an account.
struct Bound<'a> {
    account: &'a Account,
    side: Side,
    party: &'a Party,
}

impl Bound<'_> {
    fn did(&self, acts: &[Act]) -> bool {
        self.party.did_any(acts)
    }

    fn moved(&self, movements: &[Movement]) -> bool {
        told(&self.party.movement).is_some_and(|movement| movements.contains(&movement))
    }

    fn is(&self, kind: CrashType) -> bool {
        told(&self.account.crash_type) == Some(kind)
    }
}

/// A rule, whom it can bind as far as an account tells, and whether it binds this side.
type Rule = (&'static str, &'static [Side], fn(&Bound<'_>) -> bool);

const BOTH: &[Side] = &[Side::Sv, Side::Other];

const RULES: [Rule; 19] = [
    ("art. 5: signals", BOTH, |of| has_control(of.party, ControlDevice::Signal) || of.did(&[Act::RunRed])),
    ("art. 5: stop and yield signs", BOTH, |of| {
        [ControlDevice::StopSign, ControlDevice::YieldSign].into_iter().any(|device| has_control(of.party, device))
            || of.did(&[Act::RunStop])
    }),
    ("art. 10: place on the carriageway", BOTH, |of| {
        let across = [Movement::CrossingIntoOpposingLane, Movement::WrongWay, Movement::LaneDeparture];
        of.did(&[Act::WrongWay, Act::Drift]) || of.moved(&across)
    }),
    ("art. 11: passing", BOTH, |of| of.did(&[Act::Pass]) || of.moved(&[Movement::Passing])),
    ("art. 13: posted limit, where a speed is told", BOTH, |of| {
        of.account.place.posted_mps.is_some() && !of.party.speeds.is_empty()
    }),
    ("art. 13: distance to the vehicle ahead", BOTH, |of| {
        let follows = match of.side {
            Side::Sv => Origin::Ahead,
            Side::Other => Origin::Behind,
        };
        of.is(CrashType::FrontToRear) && told(&of.account.came_from) == Some(follows)
    }),
    ("art. 14: changing lanes and merging", BOTH, |of| {
        of.did(&[Act::LaneChange]) || of.moved(&[Movement::ChangingLanes, Movement::Merging])
    }),
    ("art. 14: entering traffic", BOTH, |of| of.did(&[Act::PullOut]) || of.moved(&[Movement::EnteringTraffic])),
    ("art. 14: turning round", BOTH, |of| of.did(&[Act::UTurn]) || of.moved(&[Movement::UTurn])),
    ("art. 14: going backwards", BOTH, |of| {
        let state = told(&of.party.state) == Some(ContactState::Reversing);
        state || of.did(&[Act::Reverse]) || of.moved(&[Movement::Backing])
    }),
    ("art. 16: turning", BOTH, |of| of.did(&[Act::Turn]) || of.moved(&[Movement::LeftTurn, Movement::RightTurn])),
    ("art. 18: giving way at junctions", BOTH, |of| {
        let junction = told(&of.account.place.kind) == Some(PlaceKind::Intersection);
        of.did(&[Act::FailToYield]) || junction && of.is(CrashType::Intersection)
    }),
    ("art. 19: level crossings", BOTH, |of| has(of.account, RoadFeature::Rails)),
    ("art. 21: towards people on foot", &[Side::Sv], |of| group(of.account) == Some(KindGroup::OnFoot)),
    ("art. 23: standing and parking", BOTH, |of| {
        let for_itself = [StandReason::PickupDropoff, StandReason::Parked];
        told(&of.party.state) == Some(ContactState::Parked)
            || of.did(&[Act::Park, Act::PullOver])
            || of.party.reasons.iter().any(|reason| for_itself.contains(&reason.value))
    }),
    ("art. 24: doors", BOTH, |of| match told(&of.account.door) {
        Some(Striker::Sv) => of.side == Side::Sv,
        Some(Striker::Cp) => of.side == Side::Other,
        Some(Striker::Both) => true,
        None => false,
    }),
    ("art. 25: motorways", BOTH, |of| told(&of.account.place.kind) == Some(PlaceKind::Highway)),
    ("art. 31: after a crash", &[Side::Other], |of| told(&of.account.partner_left) == Some(true)),
    ("art. 34: vehicles with priority, rail vehicles", BOTH, |of| {
        emergency(of.account) || partner_kind(of.account) == Some(Kind::Tram)
    }),
];

pub(super) fn plan() -> Plan {
    let listed = RULES
        .iter()
        .flat_map(|(rule, sides, _)| sides.iter().map(|side| vec![(*rule).to_owned(), side.name().to_owned()]))
        .collect();
    Plan::listing(("rules-of-the-road", "Rules of the road"), &["rule", "who is bound"], listed, |account| {
        let at_stake = values(account);
        if at_stake.is_empty() { Place::Outside("no rule is told to be at stake") } else { Place::In(at_stake) }
    })
    .overlapping()
}

fn values(account: &Account) -> Vec<Values> {
    // Things and animals are bound by no rule.
    let partner =
        account.partner.as_ref().filter(|_| !matches!(group(account), Some(KindGroup::Object | KindGroup::Animal)));
    let other = partner.map(|party| Bound { account, side: Side::Other, party });
    let sides = [Some(Bound { account, side: Side::Sv, party: &account.sv }), other];
    let of_side = |bound: Bound<'_>| {
        let binds = RULES.iter().filter(|(_, sides, binds)| sides.contains(&bound.side) && binds(&bound));
        binds.map(|(rule, _, _)| vec![(*rule).to_owned(), bound.side.name().to_owned()]).collect::<Vec<_>>()
    };
    sides.into_iter().flatten().flat_map(of_side).collect()
}
