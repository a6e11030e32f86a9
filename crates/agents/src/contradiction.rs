//! What in a narrative contradicts its template or the profile, told before anything runs.

use recrash_model::metrics::CollisionKind;
use recrash_model::narrative::{Fact, FactSource, FactValue};
use recrash_model::profile::SystemProfile;
use recrash_model::scenario::Approach;
use recrash_model::template::{Movement, Template};
use recrash_model::zones::ContactZone;

/// One sentence for each contradiction: of single facts with template and profile, and of facts with each other.
pub fn narrative_contradictions(facts: &[Fact], template: Template, profile: &SystemProfile) -> Vec<String> {
    let single = facts
        .iter()
        .enumerate()
        .filter_map(|(i, fact)| Some(format!("facts[{i}]: {}", contradiction(fact, template, profile)?)));
    single.chain(told_twice(facts)).chain(story(facts, template, profile)).collect()
}

/// Facts of one sort that say different things.
fn told_twice(facts: &[Fact]) -> Vec<String> {
    let one_of_a_kind = |value: &FactValue| {
        matches!(
            value,
            FactValue::Approach { .. }
                | FactValue::SvMovement { .. }
                | FactValue::CpMovement { .. }
                | FactValue::Order { .. }
                | FactValue::SvSpeed { .. }
                | FactValue::CpSpeed { .. }
                | FactValue::CpLaneOffset { .. }
        )
    };
    let mut told = Vec::new();
    for (i, fact) in facts.iter().enumerate().filter(|(_, fact)| one_of_a_kind(&fact.value)) {
        let same = |earlier: &Fact| std::mem::discriminant(&earlier.value) == std::mem::discriminant(&fact.value);
        if let Some(earlier) = facts[..i].iter().position(|earlier| same(earlier) && earlier.value != fact.value) {
            told.push(format!("facts[{i}]: it says otherwise than facts[{earlier}]"));
        }
    }
    told
}

/// Facts that cannot be true together.
fn story(facts: &[Fact], template: Template, profile: &SystemProfile) -> Vec<String> {
    let approach = facts.iter().find_map(|fact| match fact.value {
        FactValue::Approach { approach } => Some(approach),
        _ => None,
    });
    let excludes = |kind| profile.excludes.collisions.contains(&kind);
    let both_straight = template.sv == Movement::Straight && template.cp == Movement::Straight;
    let mut told = Vec::new();
    if approach == Some(Approach::Opposite) && both_straight && excludes(CollisionKind::HeadOn) {
        told.push(
            "two that come towards each other and both go straight on meet head-on, which is excluded".to_owned(),
        );
    }
    for (i, fact) in facts.iter().enumerate() {
        match &fact.value {
            FactValue::CpLaneOffset { lanes } if *lanes != 0 && approach.is_some_and(|from| from != Approach::Same) => {
                told.push(format!("facts[{i}]: a partner from another road drives in no lane beside the ego"));
            }
            FactValue::Contact { sv, cp } if approach.is_none_or(|from| from == Approach::Same) => {
                let kind = match (sv.as_slice(), cp.as_slice()) {
                    ([ContactZone::Rear], [ContactZone::Front]) => CollisionKind::RearEndOfEgo,
                    ([ContactZone::Front], [ContactZone::Rear]) => CollisionKind::RearEndByEgo,
                    _ => continue,
                };
                if excludes(kind) {
                    told.push(format!("facts[{i}]: that is a {} collision, which is excluded", kind.label()));
                }
            }
            _ => {}
        }
    }
    told
}

fn contradiction(fact: &Fact, template: Template, profile: &SystemProfile) -> Option<String> {
    let moved = |who: &str, stated: Movement, wanted: Movement| {
        let (stated_label, wanted_label) = (stated.label().to_lowercase(), wanted.label().to_lowercase());
        (stated != wanted).then(|| format!("{who} is {stated_label}; the template says {wanted_label}"))
    };
    let fastest = profile.expresses.max_speed_mps;
    match fact.value {
        FactValue::SvMovement { movement } => moved("SV", movement, template.sv),
        FactValue::CpMovement { movement } => moved("CP", movement, template.cp),
        FactValue::Collision { kind } if profile.excludes.collisions.contains(&kind) => {
            Some(format!("a {} collision is excluded by the profile {}", kind.label(), profile.name))
        }
        FactValue::Approach { approach: Approach::Ring }
            if template.road != recrash_model::template::RoadType::TrafficCircle =>
        {
            Some("only a traffic circle has a ring".to_owned())
        }
        FactValue::Obstacles { .. } if !template.work_zone && !matches!(fact.source, FactSource::Words { .. }) => {
            Some("cones belong to work zones, and nobody tells of any here".to_owned())
        }
        FactValue::SvSpeed { speed_mps } | FactValue::CpSpeed { speed_mps }
            if !(0.0..=fastest * 2.0).contains(&speed_mps) =>
        {
            Some(format!("a speed of {speed_mps} m/s cannot be expressed; up to {fastest} can"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::narrative::Side;
    use recrash_model::scenario::ObstacleKind;
    use recrash_model::template::RoadType;

    const TEMPLATE: Template =
        Template { road: RoadType::Intersection, sv: Movement::Straight, cp: Movement::LeftTurn, work_zone: false };

    fn told_of(template: Template, values: &[FactValue]) -> Vec<String> {
        let profile: SystemProfile = toml::from_str(include_str!("../../../profiles/paper.toml")).unwrap();
        let fact =
            |value: &FactValue| Fact { value: value.clone(), source: FactSource::Assumed { why: "test".into() } };
        let facts: Vec<Fact> = values.iter().map(fact).collect();
        narrative_contradictions(&facts, template, &profile)
    }

    fn told(values: &[FactValue]) -> Vec<String> {
        told_of(TEMPLATE, values)
    }

    #[test]
    fn what_agrees_is_silent() {
        let approach = FactValue::Approach { approach: Approach::Same };
        assert!(told(&[FactValue::CpMovement { movement: Movement::LeftTurn }]).is_empty());
        assert!(told(&[FactValue::SvSpeed { speed_mps: 8.0 }, FactValue::SvSpeed { speed_mps: 8.0 }]).is_empty());
        assert!(told(&[approach, FactValue::CpLaneOffset { lanes: 1 }]).is_empty());
        let work_zone = Template { work_zone: true, ..TEMPLATE };
        assert!(told_of(work_zone, &[FactValue::Obstacles { kind: ObstacleKind::Cone, side: Side::Left }]).is_empty());
    }

    #[test]
    fn each_kind_of_contradiction_is_told() {
        use ContactZone::{Front, Rear};
        let approach = |approach| FactValue::Approach { approach };
        let straight = Template { cp: Movement::Straight, ..TEMPLATE };
        for (template, values, word) in [
            (TEMPLATE, vec![FactValue::SvMovement { movement: Movement::RightTurn }], "template"),
            (TEMPLATE, vec![FactValue::CpMovement { movement: Movement::Straight }], "template"),
            (TEMPLATE, vec![FactValue::Collision { kind: CollisionKind::HeadOn }], "excluded"),
            (TEMPLATE, vec![approach(Approach::Ring)], "ring"),
            (TEMPLATE, vec![FactValue::CpSpeed { speed_mps: 300.0 }], "300"),
            (TEMPLATE, vec![approach(Approach::Left), approach(Approach::Right)], "otherwise"),
            (TEMPLATE, vec![FactValue::SvSpeed { speed_mps: 5.0 }, FactValue::SvSpeed { speed_mps: 9.0 }], "otherwise"),
            (TEMPLATE, vec![FactValue::Obstacles { kind: ObstacleKind::Cone, side: Side::Left }], "cones"),
            (TEMPLATE, vec![approach(Approach::Left), FactValue::CpLaneOffset { lanes: -1 }], "lane beside"),
            (straight, vec![approach(Approach::Opposite)], "head-on"),
            (
                straight,
                vec![approach(Approach::Same), FactValue::Contact { sv: vec![Rear], cp: vec![Front] }],
                "rear-end of",
            ),
            (straight, vec![FactValue::Contact { sv: vec![Front], cp: vec![Rear] }], "rear-end by"),
        ] {
            let told = told_of(template, &values);
            assert!(told.len() == 1 && told[0].contains(word), "{values:?}: {told:?}");
        }
    }
}
