//! The case files, one per map, and a rollout of each that no simulator made.

use recrash_model::rollout::{
    ActorState, ActorTrack, EGO_ID, ROLLOUT_FORMAT, Role, Rollout, STEP_S, Termination, TerminationKind,
};
use recrash_model::scenario::ScenarioDraft;
use recrash_model::tuning::Parameter;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{Placement, Scenario};

pub const CASES: [(&str, &str); 5] = [
    ("s-cut-in", include_str!("../../cases/s-cut-in.json")),
    ("c-work-zone", include_str!("../../cases/c-work-zone.json")),
    ("x-crossing", include_str!("../../cases/x-crossing.json")),
    ("t-right-turn", include_str!("../../cases/t-right-turn.json")),
    ("o-entry", include_str!("../../cases/o-entry.json")),
];

pub fn draft(json: &str) -> ScenarioDraft {
    recrash_roads::read_draft(json).expect("a case is a scenario").value
}

pub fn scenario(json: &str) -> Scenario {
    recrash_roads::check(draft(json)).expect("a case passes the check").value
}

/// Everybody drives on at the speed they start with, for this many steps.
pub fn straight_on(scenario: &Scenario, steps: usize) -> Rollout {
    let track = |id: &str, role: Role, placement: &Placement| {
        let spec = VehicleSpec::of(placement.kind);
        let states = (0..=steps).map(|step| {
            let s = placement.s_m + placement.speed_mps * STEP_S * step as f64;
            ActorState::moving(placement.path.pose(s, placement.t_m), placement.speed_mps)
        });
        let (length_m, width_m) = (spec.length_m, spec.width_m);
        ActorTrack {
            id: id.to_owned(),
            role,
            part_of: None,
            mass_kg: None,
            appears_s: 0.0,
            gone_s: None,
            kind: placement.kind,
            length_m,
            width_m,
            states: states.collect(),
        }
    };
    let mut actors = vec![track(EGO_ID, Role::Ego, scenario.ego())];
    for (partner, placement) in scenario.draft().partners.iter().zip(scenario.partners()) {
        actors.push(track(&partner.id, Role::Partner, placement));
    }
    Rollout {
        format: ROLLOUT_FORMAT.to_owned(),
        scenario_id: scenario.draft().id.clone(),
        simulator: "none".to_owned(),
        ego: "none".to_owned(),
        actors,
        obstacles: scenario.obstacles().iter().map(|obstacle| obstacle.placed).collect(),
        events: Vec::new(),
        termination: Termination { kind: TerminationKind::Timeout, time_s: STEP_S * steps as f64 },
        state_hash: String::new(),
    }
}

/// The ego's target speed and the first partner's start may move.
pub fn two_parameters(scenario: &Scenario) -> Vec<Parameter> {
    let document = serde_json::to_value(scenario.draft()).expect("serialises");
    let pointers = [
        ("/ego/target_speed_mps", "m/s", 1.0),
        ("/partners/0/start/arrival_gap_s", "s", 0.5),
        ("/partners/0/start/delta_s_m", "m", 3.0),
        ("/obstacles/0/t_m", "m", 0.25),
    ];
    let found = pointers.into_iter().filter_map(|(pointer, unit, around)| {
        let start = document.pointer(pointer)?.as_f64()?;
        Some(Parameter {
            pointer: pointer.to_owned(),
            unit: unit.to_owned(),
            min: start - around,
            max: start + around,
            start,
            integer: false,
            reason: "a test".to_owned(),
        })
    });
    found.collect()
}
