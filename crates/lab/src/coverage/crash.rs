//! Crash type, role, road, control and kind of partner: each alone, in pairs, and all five together.

use super::competency::group;
use super::{NOT_TOLD, Place, Plan, Values, words, words_or_not_told};
use recrash_model::account::{
    Account, Control, ControlDevice, CrashType, KindGroup, Party, PlaceKind, RoadFeature, Role, told,
};

/// One of the five.
struct Axis {
    id: &'static str,
    name: &'static str,
    value: fn(&Account) -> String,
    place: fn(&Account) -> Place,
    values: fn() -> Vec<String>,
}

const AXES: [Axis; 5] = [
    Axis {
        id: "crash-type",
        name: "crash type",
        value: crash_type,
        place: |account| alone(crash_type(account)),
        values: || CrashType::ALL.iter().map(|kind| kind.label().to_lowercase()).collect(),
    },
    Axis {
        id: "role",
        name: "role",
        value: role,
        place: |account| alone(role(account)),
        values: || [Role::Initiator, Role::Responder, Role::Both].iter().map(words).collect(),
    },
    Axis {
        id: "road",
        name: "road",
        value: road,
        place: |account| alone(road(account)),
        values: || ROADS.iter().map(words).collect(),
    },
    Axis {
        id: "control",
        name: "control",
        value: control,
        place: |account| alone(control(account)),
        values: || DEVICES.iter().map(words).chain([NO_CONTROL.to_owned()]).collect(),
    },
    Axis {
        id: "partner",
        name: "partner",
        value: partner,
        place: |account| alone(partner(account)),
        values: || PARTNERS.iter().map(words).collect(),
    },
];

/// Every kind of place.
pub(super) const ROADS: [PlaceKind; 9] = {
    use PlaceKind::{Alley, Circle, Driveway, Garage, Highway, Intersection, Other, ParkingLot, Street};
    [Intersection, Street, Highway, Circle, ParkingLot, Garage, Alley, Driveway, Other]
};

const DEVICES: [ControlDevice; 3] = [ControlDevice::Signal, ControlDevice::StopSign, ControlDevice::YieldSign];
const NO_CONTROL: &str = "not stated";

const PARTNERS: [KindGroup; 8] = {
    use KindGroup::{Animal, Car, Cyclist, Motorcycle, Object, OnFoot, Other, Truck};
    [Car, Truck, Motorcycle, Cyclist, OnFoot, Animal, Object, Other]
};

/// The five alone, in pairs and together.
pub(super) fn plans() -> Vec<Plan> {
    let mut plans = vec![together(), pairs()];
    plans.extend(AXES.into_iter().map(|axis| {
        let listed = (axis.values)().into_iter().map(|value| vec![value]).collect();
        Plan::listing((axis.id, axis.name), &[axis.name], listed, axis.place)
    }));
    plans
}

fn together() -> Plan {
    let place = |account: &Account| Place::In(vec![AXES.iter().map(|axis| (axis.value)(account)).collect()]);
    Plan {
        id: "crash",
        name: "Crash type x role x road x control x partner",
        axes: AXES.iter().map(|axis| axis.name).collect(),
        listed: Vec::new(),
        possible: AXES.iter().map(|axis| (axis.values)().len()).product(),
        overlapping: false,
        place,
    }
}

fn pairs() -> Plan {
    let listed = pairs_of(|axis| (axis.values)());
    let place = |account: &Account| Place::In(pairs_of(|axis| vec![(axis.value)(account)]));
    Plan::listing(("crash-pairs", "The same, two at a time"), &["one", "the other"], listed, place).overlapping()
}

/// Every pair of values of two axes.
fn pairs_of(values: impl Fn(&Axis) -> Vec<String>) -> Vec<Values> {
    let named = |axis: &Axis| -> Vec<String> {
        values(axis).into_iter().map(|value| format!("{}: {value}", axis.name)).collect()
    };
    let mut pairs = Vec::new();
    for (at, first) in AXES.iter().enumerate() {
        for second in &AXES[at + 1..] {
            let seconds = named(second);
            pairs.extend(named(first).iter().flat_map(|one| seconds.iter().map(|two| vec![one.clone(), two.clone()])));
        }
    }
    pairs
}

fn alone(value: String) -> Place {
    Place::In(vec![vec![value]])
}

fn crash_type(account: &Account) -> String {
    told(&account.crash_type).map_or_else(|| NOT_TOLD.to_owned(), |kind| kind.label().to_lowercase())
}

fn role(account: &Account) -> String {
    words_or_not_told(told(&account.role))
}

fn road(account: &Account) -> String {
    words_or_not_told(told(&account.place.kind))
}

/// The signal or sign of the place, whoever it is in front of: a signal before a stop sign before a yield sign.
fn control(account: &Account) -> String {
    let there = |device: ControlDevice| {
        let feature = match device {
            ControlDevice::Signal => RoadFeature::Signal,
            ControlDevice::StopSign => RoadFeature::StopSign,
            ControlDevice::YieldSign => RoadFeature::YieldSign,
        };
        account.place.features.iter().any(|told| told.value == feature)
            || std::iter::once(&account.sv).chain(&account.partner).any(|party| has_control(party, device))
    };
    DEVICES.into_iter().find(|&device| there(device)).map_or_else(|| NO_CONTROL.to_owned(), |device| words(&device))
}

/// Whether this stands in front of a road user.
pub(super) fn has_control(party: &Party, wanted: ControlDevice) -> bool {
    party.controls.iter().any(|told| {
        let Control { device, .. } = told.value;
        device == wanted
    })
}

fn partner(account: &Account) -> String {
    words_or_not_told(group(account))
}
