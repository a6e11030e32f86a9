//! Paraphrase and design by rules: no model, no network, the same answer every time. See `docs/models/rules.md`.
//!
//! From a record to a narrative:
//! - `text`: the narrative as sentences; `pattern`: the regular expressions they are searched with;
//! - `actors`: whom a sentence speaks of;
//! - `reading`: what columns and sentences state, as facts; what an account states, in the same terms;
//! - `paraphrase`: which crash is told, and the facts that nobody states; `writing`: its text, made from its facts;
//! - `telling`: an account told, in a suite that goes by accounts.
//!
//! From a narrative to a scenario:
//! - `staging`: which conflicts can be staged, and in which lanes;
//! - `rehearsal`: where and how two meet who follow their lanes and do not react;
//! - `timing`: the lanes and the start whose rehearsed meeting is most like the told one;
//! - `retry`: what the next try aims at, by what was wrong with the earlier ones;
//! - `limits`: greatest speeds; `design`: the scenario, from all of these.

mod actors;
mod design;
pub(crate) mod limits;
mod paraphrase;
pub(crate) mod pattern;
mod reading;
mod rehearsal;
mod retry;
mod staging;
pub(crate) mod telling;
mod text;
mod timing;
mod writing;

/// What of the rules tells how a narrative is staged.
pub(crate) mod staged {
    pub(crate) use super::writing::Facts;
}

pub(crate) use paraphrase::narrative_of;
pub use paraphrase::own_narrative;

use crate::{AgentError, Brief, Design, Feedback, Paraphrase};
use recrash_model::Outcome;
use recrash_model::labelled::LabelledAccount;
use recrash_model::narrative::Narrative;
use recrash_model::profile::SystemProfile;
use recrash_model::record::CrashRecord;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::template::Template;

/// The built-in rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rules;

/// Whether the rules can stage a crash of this template.
pub fn can_stage(template: &Template) -> bool {
    !staging::stagings(template).is_empty()
}

impl Rules {
    /// What the rules say happened in a record, whether or not it can be retold: for judging them by labels.
    pub fn account(&self, record: &CrashRecord, profile: &SystemProfile) -> LabelledAccount {
        reading::account(record, profile)
    }
}

impl Paraphrase for Rules {
    fn paraphrase(&self, brief: &Brief) -> Result<Outcome<Narrative>, AgentError> {
        paraphrase::paraphrase(brief)
    }
}

impl Design for Rules {
    fn design(&self, brief: &Brief, narrative: &Narrative, feedback: &[Feedback]) -> Result<ScenarioDraft, AgentError> {
        design::design(brief, narrative, feedback)
    }
}
