//! What was chosen for a suite: whether it can be done, told before the work begins.

use crate::error::PipelineError;
use crate::models::Models;
use crate::models::cast::RULES;
use crate::simulators::check_simulator;
use crate::suite::{Stage, Suite, names};
use recrash_model::profile::Tells;
use recrash_search::Searcher;

/// Checks what a run needs only after its models were asked, which may cost: the ego, its program, and the optimiser.
///
/// # Errors
/// One of them is not there.
pub fn check_choices(suite: &Suite) -> Result<(), PipelineError> {
    suite.options().searcher.parse::<Searcher>().map_err(PipelineError::bad_input)?;
    super::invent::check(suite)?;
    let cast = &suite.options().cast;
    if let (Tells::Accounts, true) = (suite.profile().records.tells, cast.tune != RULES) {
        return Err(PipelineError::bad_input(format!(
            "the profile {} goes by accounts: a model may read reports there (paraphrase) and change what is staged of them (design); \
             variations are computed, and {} tunes in suites that go by templates: choose the profile paper",
            suite.profile().name,
            cast.tune
        )));
    }
    if let (Tells::Templates, Some(model)) = (suite.profile().records.tells, &cast.review) {
        return Err(PipelineError::bad_input(format!(
            "the profile {} goes by templates: no recorded driver is run there that {model} could hold against a report (review); choose \
             the profile open",
            suite.profile().name
        )));
    }
    check_simulator(suite.options().simulator, suite.ego(), suite.python())
}

/// Starts the ego and sees whether the models can be asked, before any work is done: a run may take long to come to either.
///
/// # Errors
/// The ego or a model is one that only the suite names, the ego does not start, or a key is missing.
pub fn must_be_ready(suite: &Suite) -> Result<(), PipelineError> {
    suite.simulator()?;
    // What was begun may need no further answer.
    let is_begun = suite.output_hash(Stage::Records, Stage::Records.name(), names::RECORDS).is_ok();
    suite.models().filter(|_| !is_begun).map_or(Ok(()), Models::ready)
}
