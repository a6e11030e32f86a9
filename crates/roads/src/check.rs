//! The one door from a draft to a runnable scenario.

use crate::scenario::Scenario;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::{Diagnostic, Outcome};

/// Checks a draft. Gives every problem at once, each with its JSON path, the value, what is allowed and a hint.
///
/// # Errors
/// Diagnostics of which at least one is an error.
pub fn check(_draft: ScenarioDraft) -> Result<Outcome<Scenario>, Vec<Diagnostic>> {
    unimplemented!()
}

/// Reads a draft from JSON: `recrash.scenario/1`, or the paper's dialect, which is converted.
///
/// # Errors
/// One diagnostic per problem of syntax or type, with line and JSON path.
pub fn read_draft(_json: &str) -> Result<Outcome<ScenarioDraft>, Vec<Diagnostic>> {
    unimplemented!()
}
