//! What in a narrative contradicts its template or the profile, told before anything runs.

use recrash_model::narrative::{Fact, FactValue};
use recrash_model::profile::SystemProfile;
use recrash_model::scenario::Approach;
use recrash_model::template::{Movement, Template};

/// One sentence for each contradiction.
pub fn narrative_contradictions(facts: &[Fact], template: Template, profile: &SystemProfile) -> Vec<String> {
    facts
        .iter()
        .enumerate()
        .filter_map(|(i, fact)| Some(format!("facts[{i}]: {}", contradiction(&fact.value, template, profile)?)))
        .collect()
}

fn contradiction(fact: &FactValue, template: Template, profile: &SystemProfile) -> Option<String> {
    let moved = |who: &str, stated: Movement, wanted: Movement| {
        let (stated_label, wanted_label) = (stated.label().to_lowercase(), wanted.label().to_lowercase());
        (stated != wanted).then(|| format!("{who} is {stated_label}; the template says {wanted_label}"))
    };
    let fastest = profile.expresses.max_speed_mps;
    match *fact {
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
    use recrash_model::narrative::FactSource;
    use recrash_model::template::RoadType;

    const TEMPLATE: Template =
        Template { road: RoadType::Intersection, sv: Movement::Straight, cp: Movement::LeftTurn, work_zone: false };

    fn told(value: FactValue) -> Vec<String> {
        let profile: SystemProfile = toml::from_str(include_str!("../../../profiles/paper.toml")).unwrap();
        let fact = Fact { value, source: FactSource::Assumed { why: "test".into() } };
        narrative_contradictions(&[fact], TEMPLATE, &profile)
    }

    #[test]
    fn what_agrees_is_silent() {
        assert!(told(FactValue::CpMovement { movement: Movement::LeftTurn }).is_empty());
        assert!(told(FactValue::SvSpeed { speed_mps: 8.0 }).is_empty());
    }

    #[test]
    fn each_kind_of_contradiction_is_told() {
        use recrash_model::metrics::CollisionKind;
        for (value, word) in [
            (FactValue::SvMovement { movement: Movement::RightTurn }, "template"),
            (FactValue::CpMovement { movement: Movement::Straight }, "template"),
            (FactValue::Collision { kind: CollisionKind::HeadOn }, "excluded"),
            (FactValue::Approach { approach: Approach::Ring }, "ring"),
            (FactValue::CpSpeed { speed_mps: 300.0 }, "300"),
        ] {
            let told = told(value.clone());
            assert!(told.len() == 1 && told[0].contains(word), "{value:?}: {told:?}");
        }
    }
}
