//! The loop over a run that the simulator owns: a driver decides, a recorder looks on.

use crate::chassis::Controls;
use crate::driver::{EgoDriver, Observation};
use crate::ego::{Ego, Seat};
use crate::recorder::Recorder;
use crate::run::Run;
use recrash_model::rollout::{Substeps, Termination};
use recrash_roads::Scenario;
use std::convert::Infallible;

/// Runs scenarios from beginning to end, one after the other, in the memory of one [`Run`].
#[derive(Debug, Clone, Default)]
pub struct Runner {
    run: Option<Run>,
    substeps: Substeps,
}

impl Runner {
    /// One without anything prepared.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same, with another physics step from the next run on.
    #[must_use]
    pub fn stepping(self, substeps: Substeps) -> Self {
        Self { substeps, ..self }
    }

    /// Runs a scenario. It cannot fail: however a run goes, it ends with a [`Termination`]. Where there is nothing to test,
    /// the recorded driver drives, and is named.
    pub fn run<R: Recorder>(&mut self, scenario: &Scenario, ego: Ego, recorder: &mut R) -> Termination {
        let ego = if scenario.draft().is_tested() { ego } else { Ego::Recorded };
        let run = self.begin(scenario, Seat::BuiltIn(ego));
        recorder.begin(scenario, ego.name(), run.cast());
        let Ok(termination) = finish(run, recorder, |_| Ok::<_, Infallible>(None));
        termination
    }

    /// Runs a scenario with a driver from outside, who is not asked where there is nothing to test.
    ///
    /// # Errors
    /// The driver's own. What the recorder has of the run until then is not a whole one.
    pub fn run_with<D: EgoDriver, R: Recorder>(
        &mut self,
        scenario: &Scenario,
        driver: &mut D,
        recorder: &mut R,
    ) -> Result<Termination, D::Error> {
        if !scenario.draft().is_tested() {
            return Ok(self.run(scenario, Ego::Recorded, recorder));
        }
        let run = self.begin(scenario, Seat::Outside);
        driver.begin(scenario, run.cast())?;
        recorder.begin(scenario, driver.name(), run.cast());
        let termination = finish(run, recorder, |observation| driver.decide(observation).map(Some))?;
        driver.end(termination)?;
        Ok(termination)
    }

    fn begin(&mut self, scenario: &Scenario, seat: Seat) -> &mut Run {
        let run = self.run.get_or_insert_with(Run::empty);
        run.reset_in(scenario, seat, self.substeps);
        run
    }
}

/// Steps a run to its end.
fn finish<R: Recorder, E>(
    run: &mut Run,
    recorder: &mut R,
    mut decide: impl FnMut(&Observation<'_>) -> Result<Option<Controls>, E>,
) -> Result<Termination, E> {
    loop {
        if let Some(termination) = run.termination() {
            recorder.step(run.observe().states);
            recorder.end(termination);
            return Ok(termination);
        }
        let controls = decide(&run.observe())?;
        run.step(controls);
        recorder.step(run.decided());
        for event in run.events() {
            recorder.event(event);
        }
    }
}
