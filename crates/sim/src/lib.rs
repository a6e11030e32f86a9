//! The native simulator: deterministic, two-dimensional, without a screen.
//!
//! One scenario and one ego give one rollout. Physics steps take 0.02 s, decisions are made every 0.1 s, and the order is
//! always the same: sense, decide, move, collide, record; every actor decides on the same frozen world. It cannot fail:
//! whatever a checked scenario asks for, a run ends with a termination that is data.
//!
//! - [`simulate`] runs one scenario and keeps everything.
//! - [`Runner`] runs many, with a [`Recorder`] that keeps what is wanted; a step allocates nothing.
//! - [`Run`] is one run that others drive: reset, observe, step, snapshot, restore. The two above are users of it.
//! - [`Native`] is it as one [`recrash_roads::Simulator`] among others.
//! - [`EgoDriver`] is the seat for a driver from outside, see [`Runner::run_with`].
//! - The models behind it are described in `docs/models`: vehicle, metadrive-idm, idm, reference, policies.
//!
//! What this crate does **not** do: it never sees a crash record, opens no file, reads no clock and starts no thread.

mod cast;
mod chassis;
mod contacts;
mod driver;
mod ego;
mod emergency;
mod give_way;
mod halts;
mod idm;
mod impact;
mod lanes;
mod metadrive_idm;
mod movement;
mod native;
mod recorder;
mod reference;
mod run;
mod runner;
mod scene;
mod script;
mod steering;
mod swerve;
mod world;

pub use cast::CastMember;
pub use chassis::{Chassis, Controls, PHYSICS_STEP_S, VehicleState, WheelCommand};
pub use driver::{EgoDriver, Observation};
pub use ego::{Ego, Seat, UnknownEgo};
pub use emergency::EmergencyResponse;
pub use idm::IdmParameters;
pub use native::Native;
pub use recorder::{Recorder, RolloutRecorder, Summary, SummaryRecorder};
pub use run::{Run, Snapshot};
pub use runner::Runner;

use recrash_model::rollout::Rollout;
use recrash_roads::Scenario;

/// Runs one scenario.
///
/// For many runs keep a [`Runner`]: it reuses its memory.
pub fn simulate(scenario: &Scenario, ego: Ego) -> Rollout {
    rehearse(scenario, ego).named()
}

/// The same for a search, which runs many and keeps one: the rollout has no hash of its states ([`Rollout::named`]).
pub fn rehearse(scenario: &Scenario, ego: Ego) -> Rollout {
    let mut recorder = RolloutRecorder::new();
    Runner::new().run(scenario, ego, &mut recorder);
    recorder.unnamed().unwrap_or_else(|| unreachable!("a run begins and ends"))
}
