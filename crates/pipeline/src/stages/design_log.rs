//! How a scenario came to be designed: every try, who made it, and which was taken.

use crate::models::cast::RULES;
use recrash_model::Diagnostic;
use recrash_model::metrics::Check;
use recrash_model::scenario::{Author, ScenarioDraft};
use recrash_reconstruct::Reconstruction;
use recrash_report::Changed;
use serde::{Deserialize, Serialize};

/// What became of the designs of one scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DesignLog {
    /// `rules`, or the model that was asked first.
    pub asked: String,
    /// Answers that went back to the model, because of their form or of what the check or the rollout said.
    pub repairs: usize,
    /// Every try, in order.
    pub attempts: Vec<DesignAttempt>,
    /// Number of the try that was taken, from 0.
    pub taken: usize,
    /// Designers that did not come to a faithful scenario, and why.
    pub gave_up: Vec<String>,
    /// What nobody told, and was chosen.
    #[serde(default)]
    pub assumed: Vec<String>,
    /// What a model changed in what the rules staged of an account, change by change.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changed: Vec<String>,
}

/// One try.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DesignAttempt {
    /// The design.
    pub draft: ScenarioDraft,
    /// What the check said.
    pub diagnostics: Vec<Diagnostic>,
    /// Checks of faithfulness that failed; absent where it did not run.
    pub unfaithful: Option<Vec<Check>>,
}

impl DesignLog {
    /// Of the rules alone, at the first try.
    pub(super) fn by_rules(attempt: DesignAttempt) -> Self {
        let attempts = vec![attempt];
        Self { attempts, ..Self::asking(RULES) }
    }

    /// Of what the rules staged of an account, with what it does not show as told.
    pub(super) fn begun_with(made: &Reconstruction) -> Self {
        let missed = made.all_missed().cloned().collect();
        let first = DesignAttempt { draft: made.draft.clone(), diagnostics: Vec::new(), unfaithful: Some(missed) };
        Self { assumed: made.assumed.clone(), ..Self::by_rules(first) }
    }

    /// Before anything was tried.
    pub(super) fn asking(name: &str) -> Self {
        Self {
            asked: name.to_owned(),
            repairs: 0,
            attempts: Vec::new(),
            taken: 0,
            gave_up: Vec::new(),
            assumed: Vec::new(),
            changed: Vec::new(),
        }
    }

    /// What a model changed, and which one.
    pub(super) fn change(&self) -> Option<Changed> {
        let what = self.changed.join("; ");
        (!what.is_empty()).then(|| Changed { model: self.asked.clone(), what })
    }

    /// One word for tables: `rules`, `first answer`, `after repair` or `fallback`.
    pub fn outcome(&self) -> &'static str {
        match self.attempts.get(self.taken).map(|attempt| &attempt.draft.source.author) {
            _ if self.asked == RULES => "rules",
            None | Some(Author::Rules) if !self.gave_up.is_empty() => "fallback",
            _ if self.taken == 0 && self.repairs == 0 => "first answer",
            _ => "after repair",
        }
    }
}

impl DesignAttempt {
    /// The fewer the better: not runnable counts as worse than any unfaithfulness.
    pub(super) fn faults(&self) -> usize {
        self.unfaithful.as_ref().map_or(usize::MAX, Vec::len)
    }
}
