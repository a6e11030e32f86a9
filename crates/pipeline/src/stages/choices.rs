//! What was chosen for a suite: whether it can be done, told before the work begins.

use crate::error::PipelineError;
use crate::models::cast::RULES;
use crate::simulators::check_simulator;
use crate::suite::Suite;
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
    let staged_by = [&cast.design, &cast.tune].into_iter().find(|name| *name != RULES);
    if let (Tells::Accounts, Some(model)) = (suite.profile().records.tells, staged_by) {
        return Err(PipelineError::bad_input(format!(
            "the profile {} goes by accounts: a model may read reports there (paraphrase), and reconstructions and their variations are \
             computed; {model} designs and tunes in suites that go by templates: choose the profile paper",
            suite.profile().name
        )));
    }
    if let (Tells::Templates, Some(model)) = (suite.profile().records.tells, &cast.review) {
        return Err(PipelineError::bad_input(format!(
            "the profile {} goes by templates: no recorded driver is run there that {model} could hold against a report (review); choose \
             the profile open",
            suite.profile().name
        )));
    }
    check_simulator(suite.options().simulator, suite.ego())
}
