//! System profiles: the built-in ones, and any TOML file.

use crate::error::PipelineError;
use recrash_model::diagnostic::{Diagnostic, Location, Severity};
use recrash_model::profile::{PROFILE_FORMAT, SystemProfile};
use std::path::Path;

const BUILT_IN: [(&str, &str); 2] =
    [("open", include_str!("../../../profiles/open.toml")), ("paper", include_str!("../../../profiles/paper.toml"))];

/// The profile where nobody names one.
pub const DEFAULT_PROFILE: &str = BUILT_IN[0].0;

/// Names of the built-in profiles.
pub const PROFILE_NAMES: [&str; 2] = [BUILT_IN[0].0, BUILT_IN[1].0];

/// A built-in profile by name, or a TOML file by path.
///
/// # Errors
/// No such profile or file, or a file that is no profile: with line and key.
pub fn load_profile(name_or_path: &str) -> Result<SystemProfile, PipelineError> {
    if let Some((name, text)) = BUILT_IN.iter().find(|(name, _)| *name == name_or_path) {
        return parse(text, name);
    }
    let path = Path::new(name_or_path);
    if path.extension().is_none_or(|e| e != "toml") && !path.exists() {
        return Err(PipelineError::bad_input(format!(
            "there is no profile \"{name_or_path}\"; built in: {}; or give the path of a .toml file",
            PROFILE_NAMES.join(", ")
        )));
    }
    let text = crate::files::store::read_text(path, 1 << 20)?;
    parse(&text, name_or_path)
}

fn parse(text: &str, name: &str) -> Result<SystemProfile, PipelineError> {
    let bad = |message: String| PipelineError::BadInput {
        what: format!("{name} is not a usable profile"),
        diagnostics: vec![Diagnostic::new(
            Severity::Error,
            "profile.invalid",
            Location { file: Some(name.to_owned()), ..Location::default() },
            message,
        )],
    };
    let profile: SystemProfile = toml::from_str(text).map_err(|e| bad(e.to_string()))?;
    if profile.format != PROFILE_FORMAT {
        return Err(bad(format!("format is \"{}\"; this version reads \"{PROFILE_FORMAT}\"", profile.format)));
    }
    let f = &profile.failure;
    let e = &profile.expresses;
    for (key, value) in [
        ("failure.min_gap_m", f.min_gap_m),
        ("failure.hard_braking_mps2", f.hard_braking_mps2),
        ("failure.phantom_braking_mps2", f.phantom_braking_mps2),
        ("failure.oscillation_window_s", f.oscillation_window_s),
        ("failure.lane_departure_m", f.lane_departure_m),
        ("expresses.max_speed_mps", e.max_speed_mps),
    ] {
        if !(value.is_finite() && value > 0.0) {
            return Err(bad(format!("{key} is {value}; it must be a positive number")));
        }
    }
    if !(0.0..=e.max_speed_mps).contains(&e.min_speed_mps) {
        let (least, most) = (e.min_speed_mps, e.max_speed_mps);
        return Err(bad(format!(
            "expresses.min_speed_mps is {least}; it must be a number from 0 to max_speed_mps, {most}"
        )));
    }
    if !(0.0..=1.0).contains(&e.max_traffic_density) {
        let density = e.max_traffic_density;
        return Err(bad(format!("expresses.max_traffic_density is {density}; it must be a number from 0 to 1")));
    }
    if f.oscillation_reversals == 0 {
        return Err(bad("failure.oscillation_reversals is 0; every run has that many, so it must be 1 or more".into()));
    }
    if profile.templates().is_empty() {
        return Err(bad("expresses no template: road_types, sv_movements and cp_movements each need a value".into()));
    }
    Ok(profile)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_profile_is_readable_and_named_as_its_file() {
        for name in PROFILE_NAMES {
            assert_eq!(load_profile(name).unwrap().name, name);
        }
    }

    #[test]
    fn the_paper_profile_spans_54_templates() {
        assert_eq!(load_profile("paper").unwrap().templates().len(), 3 * 3 * 3 * 2);
    }

    #[test]
    fn a_wrong_key_is_named_with_its_line() {
        let error = parse(&BUILT_IN[0].1.replace("min_gap_m", "min_gapp"), "x.toml").unwrap_err();
        let PipelineError::BadInput { diagnostics, .. } = error else { panic!("{error:?}") };
        assert!(diagnostics[0].message.contains("min_gapp"), "{}", diagnostics[0].message);
        assert!(diagnostics[0].message.contains("line"), "{}", diagnostics[0].message);
    }

    #[test]
    fn a_number_that_makes_no_sense_is_named() {
        let paper = BUILT_IN[1].1;
        for (key, from, to) in [
            ("min_speed_mps", "min_speed_mps = 1.0", "min_speed_mps = nan"),
            ("min_speed_mps", "min_speed_mps = 1.0", "min_speed_mps = -1.0"),
            ("min_speed_mps", "min_speed_mps = 1.0", "min_speed_mps = 30.0"),
            ("max_speed_mps", "max_speed_mps = 22.2", "max_speed_mps = inf"),
            ("max_traffic_density", "max_traffic_density = 0.3", "max_traffic_density = nan"),
            ("min_gap_m", "min_gap_m = 2.0", "min_gap_m = -2.0"),
            ("oscillation_reversals", "oscillation_reversals = 4", "oscillation_reversals = 0"),
        ] {
            assert!(paper.contains(from), "{from}");
            let error = parse(&paper.replace(from, to), "x.toml").unwrap_err();
            let PipelineError::BadInput { diagnostics, .. } = error else { panic!("{error:?}") };
            assert!(diagnostics[0].message.contains(key), "{to}: {}", diagnostics[0].message);
        }
    }

    #[test]
    fn an_unknown_name_lists_the_known_ones() {
        assert!(load_profile("papper").unwrap_err().to_string().contains("built in: open, paper"));
    }
}
