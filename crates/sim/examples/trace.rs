//! Prints a run of one random scenario step by step: `trace SEED NUMBER EGO`.

use recrash_sim::{Ego, simulate};

#[path = "../tests/suite/common/mod.rs"]
mod common;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [seed, number, ego] = arguments.as_slice() else { panic!("trace SEED NUMBER EGO") };
    let ego: Ego = ego.parse().expect("an ego");
    let draft = common::random_draft(seed.parse().expect("a seed"), number.parse().expect("a number"));
    let scenario = common::checked(draft.expect("the draw is not fit to run"));
    let rollout = simulate(&scenario, ego);
    for step in 0..rollout.steps() {
        print!("{:5.1}", 0.1 * step as f64);
        for track in &rollout.actors {
            let s = track.states[step];
            print!(" | {:7.2} {:7.2} {:5.2} {:5.2} {:5.2} {:5.2}", s.x, s.y, s.heading, s.speed(), s.steer, s.throttle);
        }
        println!();
    }
    println!("{:?} {:?}", rollout.termination, rollout.events);
}
