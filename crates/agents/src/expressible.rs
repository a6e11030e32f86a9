//! Whether a design keeps to what the system under test and its simulator can express.

use recrash_model::profile::SystemProfile;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::{Diagnostic, Location, Severity};

/// What of a design is beyond its profile: speeds and the density of traffic. Roads and movements are the template's,
/// which was chosen from what can be expressed.
pub fn inexpressible(draft: &ScenarioDraft, profile: &SystemProfile) -> Vec<Diagnostic> {
    let can = &profile.expresses;
    let most = can.max_speed_mps;
    let partners = draft.partners.iter().enumerate();
    let numbers =
        std::iter::once(("traffic.density".to_owned(), draft.traffic.density, (0.0, can.max_traffic_density)))
            .chain([("ego.target_speed_mps".to_owned(), draft.ego.target_speed_mps, (can.min_speed_mps, most))])
            .chain(
                partners.map(|(at, partner)| {
                    (format!("partners[{at}].policy"), partner.policy.target_speed(), (0.0, most))
                }),
            );
    numbers
        .filter(|(_, value, (least, most))| !(least..=most).contains(&value))
        .map(|(path, value, (least, most))| {
            let message = format!("it is {value}; the profile {} expresses {least} to {most}", profile.name);
            Diagnostic::new(Severity::Error, "scenario.inexpressible", Location::at_path(path), message)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::scenario::Policy;

    #[test]
    fn what_is_beyond_the_profile_is_told_with_its_place() {
        let profile = toml::from_str(include_str!("../../../profiles/paper.toml")).unwrap();
        let mut draft: ScenarioDraft =
            serde_json::from_str(include_str!("../../export/tests/cases/x-crossing.json")).unwrap();
        assert_eq!(inexpressible(&draft, &profile), []);
        draft.traffic.density = 0.4;
        draft.ego.target_speed_mps = 0.5;
        draft.partners[0].policy = Policy::IdmNominal { target_speed_mps: 30.0 };
        let told = inexpressible(&draft, &profile);
        let places: Vec<&str> = told.iter().filter_map(|problem| problem.location.path.as_deref()).collect();
        assert_eq!(places, ["traffic.density", "ego.target_speed_mps", "partners[0].policy"]);
        assert_eq!(told[0].message, "it is 0.4; the profile paper expresses 0 to 0.3");
    }
}
