//! What names in a scenario's plans mean.

use super::programme::Who;
use recrash_model::rollout::EGO_ID;
use recrash_model::scenario::ScenarioDraft;

/// What names in a draft mean.
#[derive(Debug, Clone, Copy)]
pub struct Names<'a>(pub &'a ScenarioDraft);

impl Who for Names<'_> {
    fn actor(&self, id: &str) -> Option<u16> {
        if id == EGO_ID {
            return Some(0);
        }
        let partners = self.0.partners.iter().map(|partner| &partner.id);
        let position = partners.chain(self.0.actors.iter().map(|actor| &actor.id)).position(|other| other == id)?;
        u16::try_from(position + 1).ok()
    }

    fn act(&self, actor: &str, act: &str) -> Option<u8> {
        let plan = if actor == EGO_ID {
            self.0.ego.recorded.as_ref()?
        } else {
            &self.0.actors.iter().find(|other| other.id == actor)?.plan
        };
        let position = plan.acts.iter().position(|other| other.id.as_deref() == Some(act))?;
        u8::try_from(position).ok()
    }

    fn control(&self, at: &str) -> Option<u16> {
        let position = self.0.control.iter().position(|control| control.at == at)?;
        u16::try_from(position).ok()
    }
}
