//! What a narrative says happened, in the terms of the labels: for judging any agent by what it tells.

use recrash_model::labelled::LabelledAccount;
use recrash_model::metrics::CollisionKind;
use recrash_model::narrative::{FactValue, Narrative};
use recrash_model::profile::SystemProfile;

/// The account a narrative gives of its record.
///
/// A narrative that takes the record's place tells another story: of such a one only what its reason says counts, that the
/// record describes an excluded kind of collision.
pub fn account_of(narrative: &Narrative, profile: &SystemProfile) -> LabelledAccount {
    let mut account = LabelledAccount { road: Some(narrative.template.road.into()), ..LabelledAccount::default() };
    if let Some(reason) = narrative.origin.reason() {
        let reason = plain(reason);
        account.collision = profile.excludes.collisions.iter().copied().find(|kind| names_kind(&reason, *kind));
        account.excluded = Some(account.collision.is_some());
        return account;
    }
    for fact in &narrative.facts {
        match &fact.value {
            FactValue::SvMovement { movement } => account.sv_movement = Some(*movement),
            FactValue::CpMovement { movement } => account.cp_movement = Some(*movement),
            FactValue::Approach { approach } => account.approach = Some(*approach),
            FactValue::Order { first } => account.order = Some(*first),
            FactValue::Contact { sv, cp } => (account.sv_zones, account.cp_zones) = (sv.clone(), cp.clone()),
            FactValue::Collision { kind } => account.collision = Some(*kind),
            _ => {}
        }
    }
    account.excluded = Some(account.collision.is_some_and(|kind| profile.excludes.collisions.contains(&kind)));
    account
}

/// Whether a reason names this kind of collision. Nobody says "rear-end of the ego" by our name for it alone.
fn names_kind(reason: &str, kind: CollisionKind) -> bool {
    let words: &[&str] = match kind {
        CollisionKind::RearEndByEgo | CollisionKind::RearEndOfEgo => &["rear end", "from behind"],
        CollisionKind::HeadOn => &["head on"],
        CollisionKind::Angle | CollisionKind::Sideswipe => return false,
    };
    words.iter().any(|word| reason.contains(word))
}

fn plain(text: &str) -> String {
    text.to_lowercase().replace(['-', '_'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::narrative::{Fact, FactSource, NARRATIVE_FORMAT, Origin};
    use recrash_model::scenario::{Approach, Author};
    use recrash_model::template::{Movement, RoadType, Template};

    fn narrative(origin: Origin, values: Vec<FactValue>) -> Narrative {
        let fact = |value| Fact { value, source: FactSource::Assumed { why: "test".into() } };
        Narrative {
            format: NARRATIVE_FORMAT.into(),
            scenario_id: "t".into(),
            template: Template {
                road: RoadType::Intersection,
                sv: Movement::Straight,
                cp: Movement::Straight,
                work_zone: false,
            },
            records: Vec::new(),
            text: String::new(),
            facts: values.into_iter().map(fact).collect(),
            origin,
            author: Author::Rules,
        }
    }

    fn account(origin: Origin, values: Vec<FactValue>) -> LabelledAccount {
        let profile = toml::from_str(include_str!("../../../profiles/paper.toml")).unwrap();
        account_of(&narrative(origin, values), &profile)
    }

    #[test]
    fn facts_of_a_retold_record_are_its_account() {
        let values = vec![
            FactValue::Approach { approach: Approach::Left },
            FactValue::SvMovement { movement: Movement::Straight },
            FactValue::Collision { kind: CollisionKind::Angle },
        ];
        let account = account(Origin::Own, values);
        assert_eq!((account.approach, account.excluded), (Some(Approach::Left), Some(false)));
    }

    #[test]
    fn an_alternative_tells_why_and_nothing_else() {
        let values = || vec![FactValue::Approach { approach: Approach::Left }];
        let why = |reason: &str| account(Origin::Invented { reason: reason.into() }, values());
        assert_eq!((why("a Rear-end collision").excluded, why("a Rear-end collision").approach), (Some(true), None));
        assert_eq!(why("it tells nothing").excluded, Some(false));
    }
}
