//! Who is in a run: kinds, sizes, and names as rollouts have them.

use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{EGO_ID, Role};
use recrash_model::scenario::ScenarioDraft;

/// An actor, as it is introduced to a recorder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CastMember {
    /// What it is to the scenario.
    pub role: Role,
    /// Kind.
    pub kind: PartnerKind,
    /// Length of its box. [m]
    pub length_m: f64,
    /// Width of its box. [m]
    pub width_m: f64,
    /// The step at which it appears.
    pub appears: u32,
    /// Of a part: its owner's position in the cast.
    pub owner: Option<u16>,
    /// Of a part: its position among its owner's.
    pub part: u16,
}

impl CastMember {
    /// The name of the actor at this position of the cast, as rollouts have it.
    pub fn id(&self, draft: &ScenarioDraft, position: usize) -> String {
        match self.role {
            Role::Ego => EGO_ID.to_owned(),
            Role::Partner => {
                let (partners, position) = (draft.partners.len(), position - 1);
                if position < partners { &draft.partners[position].id } else { &draft.actors[position - partners].id }
                    .clone()
            }
            Role::Traffic => format!("traffic{}", position - draft.partners.len() - draft.actors.len()),
            Role::Part => {
                let part = usize::from(self.part);
                match usize::from(self.owner.unwrap_or(0)) {
                    0 => format!("{EGO_ID}.{}", draft.ego.parts[part].id),
                    owner => {
                        let actor = &draft.actors[owner - 1 - draft.partners.len()];
                        format!("{}.{}", actor.id, actor.parts[part].id)
                    }
                }
            }
        }
    }

    /// The mass of the actor at this position of the cast, where the scenario gives it one. [kg]
    pub(crate) fn own_mass_kg(&self, draft: &ScenarioDraft, position: usize) -> Option<f64> {
        let number = position.checked_sub(1 + draft.partners.len()).filter(|_| self.role == Role::Partner)?;
        draft.actors.get(number)?.mass_kg
    }
}
