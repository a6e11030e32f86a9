use super::*;
use crate::progress::NoProgress;
use recrash_model::rollout::{Rollout, Termination};
use recrash_roads::{RunError, Scenario};
use recrash_sim::{CastMember, Controls, EgoDriver, Observation, RolloutRecorder, Runner};
use std::convert::Infallible;

/// An ego that holds its speed, whatever happens.
struct Blind;

impl EgoDriver for Blind {
    type Error = Infallible;

    fn name(&self) -> &str {
        "blind"
    }

    fn begin(&mut self, _: &Scenario, _: &[CastMember]) -> Result<(), Infallible> {
        Ok(())
    }

    fn decide(&mut self, observation: &Observation<'_>) -> Result<Controls, Infallible> {
        let ego = observation.states[0];
        Ok(Controls { steer: 0.0, throttle: if ego.speed() < 50.0 / 3.6 { 0.2 } else { 0.0 } })
    }

    fn end(&mut self, _: Termination) -> Result<(), Infallible> {
        Ok(())
    }
}

struct BlindSimulator;

impl Simulator for BlindSimulator {
    fn name(&self) -> &str {
        "native"
    }

    fn version(&self) -> &str {
        "test"
    }

    fn ego(&self) -> &str {
        "blind"
    }

    fn run(&self, scenario: &Scenario) -> Result<Rollout, RunError> {
        let mut recorder = RolloutRecorder::new();
        let Ok(_) = Runner::new().run_with(scenario, &mut Blind, &mut recorder);
        recorder.finish().ok_or_else(|| RunError::new(scenario, "no rollout"))
    }
}

fn blind(concrete: Concrete) -> Verdict {
    run(&BlindSimulator, &concrete).expect("it can be run")
}

fn crash(verdict: Verdict) -> (f64, f64) {
    let Verdict::Crashed { ego_mps, other_mps } = verdict else { panic!("{verdict:?}") };
    (ego_mps, other_mps)
}

#[test]
fn a_blind_ego_meets_what_the_grid_says() {
    // Who cuts in keeps its speed.
    let cut_in = Concrete::CutIn { ego_kmh: 50.0, other_kmh: 30.0, gap_m: 20.0, lateral_mps: 1.0 };
    let (ego_mps, other_mps) = crash(blind(cut_in));
    assert!((ego_mps - 13.9).abs() < 0.3 && (other_mps - 8.3).abs() < 0.3, "{ego_mps} {other_mps}");
    // Who stays in his lane is passed.
    assert_eq!(
        blind(Concrete::CutIn { ego_kmh: 50.0, other_kmh: 30.0, gap_m: 20.0, lateral_mps: 0.0 }),
        Verdict::Avoided
    );
    // Behind the one that cuts out, one stands.
    let (ego_mps, other_mps) = crash(blind(Concrete::CutOut { speed_kmh: 50.0, gap_m: 42.0, lateral_mps: 1.5 }));
    assert!((ego_mps - 13.9).abs() < 0.3 && other_mps == 0.0, "{ego_mps} {other_mps}");
    // Who brakes comes to a stand.
    let (ego_mps, other_mps) = crash(blind(Concrete::Following { speed_kmh: 50.0, deceleration_g: 0.6 }));
    assert!((ego_mps - 13.9).abs() < 0.3 && other_mps < 0.1, "{ego_mps} {other_mps}");
}

#[test]
fn the_leader_brakes_as_hard_as_the_grid_says() {
    for deceleration_g in [0.1, 0.3, 0.5, 0.7] {
        let scenario = scenarios::of(&Concrete::Following { speed_kmh: 70.0, deceleration_g }).expect("slow enough");
        let rollout = BlindSimulator.run(&scenario).expect("it can be run");
        let leader = &rollout.actors[1].states;
        let braked_mps2 = (leader[3].speed() - leader[18].speed()) / 1.5;
        assert!((braked_mps2 - 9.81 * deceleration_g).abs() < 0.25, "{deceleration_g} g: {braked_mps2} m/s2");
    }
}

#[test]
fn one_in_ten_is_spread_over_all_numbers() {
    let all = Grid::CutOut.scenarios();
    let some = spread(all.clone(), 10);
    assert!((560..=610).contains(&some.len()), "{}", some.len());
    let laterals: std::collections::BTreeSet<u64> = some
        .iter()
        .map(|scenario| if let Concrete::CutOut { lateral_mps, .. } = scenario { lateral_mps.to_bits() } else { 0 })
        .collect();
    assert_eq!(laterals.len(), 15);
    assert_eq!(spread(all.clone(), 1).len(), all.len());
}

#[test]
fn an_ego_stands_beside_the_reference_drivers() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("check");
    let request =
        CheckDriverRequest { ego: Some("idm".to_owned()), patience: Patience::default(), every: 200, out: out.clone() };
    let check = check_driver(&request, &NoProgress).expect("it runs");
    assert_eq!(check.grids.len(), 4 + 4 + 3 + 3 + 4);
    assert!(check.grids.iter().all(|grid| (grid.driver == "idm") == grid.avoided_by.is_some()));
    let fast = check.grids.iter().find(|grid| grid.driver == "idm" && grid.grid == "cut-in-fast").expect("a row");
    assert!(fast.not_run > fast.scenarios && fast.scenarios > 0);
    assert!(check.limits.iter().all(|limit| limit.survived.len() == 5));
    for name in
        ["check-driver.json", "verdicts.csv", "cut-in-fast.svg", "cut-in-slow.svg", "cut-out.svg", "following.svg"]
    {
        assert!(out.join(name).metadata().is_ok_and(|file| file.len() > 500), "{name}");
    }
}
