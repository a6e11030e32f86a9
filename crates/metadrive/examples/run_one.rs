//! Runs scenario files on MetaDrive: `run_one PYTHON idm|recorded SCENARIO.json...`. One line each: how it ended, or why it was
//! refused.

use recrash_metadrive::{Drive, Metadrive, Options};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let python = arguments.next().expect("an interpreter");
    let drive = if arguments.next().as_deref() == Some("recorded") { Drive::Recorded } else { Drive::MetadriveIdm };
    let metadrive = Metadrive::start(Options::new(python)).unwrap_or_else(|error| panic!("{error}"));
    for path in arguments {
        let text = std::fs::read_to_string(&path).expect("a scenario file");
        let draft = recrash_roads::read_draft(&text).expect("a scenario").value;
        let scenario = recrash_roads::check(draft).unwrap_or_else(|found| panic!("{path}: {found:#?}")).value;
        match metadrive.simulate(&scenario, &drive) {
            Ok(rollout) => {
                let first = rollout.first_ego_contact().map(|(other, time_s, ..)| (&rollout.actors[other].id, time_s));
                println!("{path}: {:?} after {} s, {first:?}", rollout.termination.kind, rollout.termination.time_s);
                if let Some(folder) = std::env::var_os("ROLLOUTS") {
                    let file = std::path::Path::new(&folder).join(format!("{}.json", rollout.scenario_id));
                    std::fs::write(file, serde_json::to_vec(&rollout).expect("serialises")).expect("written");
                }
            }
            Err(error) => println!("{path}: {error}"),
        }
    }
}
