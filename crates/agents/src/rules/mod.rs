//! Paraphrase and design by rules: no model, no network, the same answer every time.

use crate::{AgentError, Brief, Design, Feedback, Paraphrase};
use recrash_model::Outcome;
use recrash_model::narrative::Narrative;
use recrash_model::scenario::ScenarioDraft;

/// The built-in rules. See `docs/models/rules.md`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rules;

impl Paraphrase for Rules {
    fn paraphrase(&self, brief: &Brief) -> Result<Outcome<Narrative>, AgentError> {
        Err(AgentError::NoRecord { scenario_id: brief.scenario_id.to_owned() })
    }
}

impl Design for Rules {
    fn design(
        &self,
        brief: &Brief,
        _narrative: &Narrative,
        _feedback: &[Feedback],
    ) -> Result<ScenarioDraft, AgentError> {
        Err(AgentError::NoRecord { scenario_id: brief.scenario_id.to_owned() })
    }
}
