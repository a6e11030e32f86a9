//! Others who have no part in what the ego does, each in the first place that shows what is told of it, where it hinders nobody.

use crate::draft::signals;
use crate::facts::seen::Seen;
use crate::ground::way::Ground;
use crate::nearby::hinders::hinders_nobody;
use crate::nearby::scene::Scene;
use crate::told::crash::Told;
use crate::told::others::{Extra, Role};
use recrash_model::account::StandReason;
use recrash_model::rollout::Rollout;
use recrash_model::scenario::ScenarioDraft;
use recrash_roads::check_on;
use recrash_sim::Ego;

/// The crash with them: of each the first place that shows what is told of it. What is assumed is said.
pub(crate) fn with_near(
    told: &Told,
    ground: &Ground,
    begun: (ScenarioDraft, Rollout),
) -> (ScenarioDraft, Rollout, Vec<String>) {
    let (mut draft, mut rollout) = begun;
    let mut assumed = Vec::new();
    // Who stands ahead, and is told only by why the ego stood, may be the partner.
    for extra in told.wanted.iter().filter(|extra| extra.role != Role::Lead || !extra.of.is_empty()) {
        let id = extra.id();
        if rollout.actors.iter().any(|track| track.id == id) {
            continue;
        }
        let Some(scene) = Scene::of(told, ground, &rollout) else { break };
        let scene = Scene { turned: extra.near.is_some_and(|near| near.after_turn), ..scene };
        if let Some(with) = scene.with_first(extra, (&draft, &rollout)) {
            (draft, rollout) = with;
            if let Some(near) = extra.near {
                assumed.push(format!("where {id} is that has no part in what the ego does: {}", near.words()));
            }
            assumed.extend(extra.assumed());
        }
    }
    for extra in told.wanted.iter().filter(|extra| extra.several) {
        let Some(scene) = Scene::of(told, ground, &rollout) else { break };
        if let Some(with) = scene.with_more(extra, (&draft, &rollout)) {
            (draft, rollout) = with;
        }
    }
    (draft, rollout, assumed)
}

impl<'a> Scene<'a> {
    /// The same with somebody in the first of its places that shows what is told of it: one in which the ego stands for whom it gave way to
    /// goes before the others.
    fn with_first(&self, extra: &Extra, begun: (&ScenarioDraft, &Rollout)) -> Option<(ScenarioDraft, Rollout)> {
        let (draft, rollout) = begun;
        let gives_way = extra.awaited && extra.near.is_some() && self.told.reasons.contains(&StandReason::Yield);
        let mut best = None;
        for actor in self.actors(extra) {
            let mut with = draft.clone();
            with.actors.push(actor);
            let recorded = with.ego.recorded.clone()?;
            with.control = signals::devices(self.told, self.ground, &recorded, &with.actors);
            let Ok(checked) = check_on(with, Some(&self.ground.network)) else { continue };
            let driven = recrash_sim::rehearse(&checked.value, Ego::Recorded);
            let seen = Seen::new(self.told, &driven, self.contact_s);
            if !hinders_nobody(&extra.id(), &checked.value, (rollout, &driven)) || !seen.holds(extra) {
                continue;
            }
            let waited_for = !gives_way || seen.reason(StandReason::Yield);
            let found = || (checked.value.draft().clone(), driven.clone());
            if waited_for {
                return Some(found());
            }
            best = best.or_else(|| Some(found()));
        }
        best
    }
}
