//! Which numbers of a scenario may move, and how far, while its narrative stays true.

use recrash_model::narrative::Narrative;
use recrash_model::profile::SystemProfile;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::tuning::Parameter;

/// The numbers of a draft that may move, each with its bounds and the reason for them. The pointers are those of the
/// draft written as JSON.
pub fn parameters(_draft: &ScenarioDraft, _narrative: &Narrative, _profile: &SystemProfile) -> Vec<Parameter> {
    Vec::new()
}
