//! System profiles: the built-in ones, and any TOML file, which may name one of those as its base. Described in `docs/profiles.md`.

use crate::error::PipelineError;
use recrash_model::diagnostic::{Diagnostic, Location, Severity};
use recrash_model::profile::{PROFILE_FORMAT, SystemProfile};
use serde::Deserialize;
use std::path::Path;
use toml::{Table, Value};

const BUILT_IN: [(&str, &str); 2] =
    [("open", include_str!("../../../profiles/open.toml")), ("paper", include_str!("../../../profiles/paper.toml"))];

/// The field that names the built-in profile of which a profile has what it does not say itself.
const BASE: &str = "base";
/// Fields that a profile may leave out.
const OPTIONAL: [&str; 1] = ["tells"];

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

/// The text of a built-in profile, to write one's own after.
///
/// # Errors
/// There is no such profile.
pub fn profile_text(name: &str) -> Result<&'static str, PipelineError> {
    built_in(name).ok_or_else(|| {
        let known = PROFILE_NAMES.join(", ");
        PipelineError::bad_input(format!("there is no built-in profile \"{name}\"; there are: {known}"))
    })
}

fn built_in(name: &str) -> Option<&'static str> {
    BUILT_IN.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// What a profile is that has no base, or its own fields laid over those of its base; and everything that is wrong with its fields.
fn with_base(text: &str, name: &str) -> Result<(Table, bool), Vec<String>> {
    let mut own: Table = toml::from_str(text).map_err(|error| vec![error.to_string()])?;
    let base = own.remove(BASE);
    let all: Table = toml::from_str(BUILT_IN[0].1).map_err(|error| vec![error.to_string()])?;
    let mut problems = Vec::new();
    check_fields(text, "", &own, &all, base.is_none(), &mut problems);
    let laid = match base.as_ref().map(|base| base.as_str().and_then(built_in)) {
        None => own,
        Some(None) => {
            problems.push(format!("{BASE} is no built-in profile; there are: {}", PROFILE_NAMES.join(", ")));
            own
        }
        Some(Some(base)) => {
            let mut laid: Table = toml::from_str(base).map_err(|error| vec![error.to_string()])?;
            // Results of another profile must not go by the base's name.
            let stem = Path::new(name).file_stem().map_or_else(|| name.into(), |stem| stem.to_string_lossy());
            laid.insert("name".to_owned(), Value::String(stem.into_owned()));
            lay_over(&mut laid, own);
            laid
        }
    };
    if problems.is_empty() { Ok((laid, base.is_some())) } else { Err(problems) }
}

/// Fields of a table of a profile that there are not; and those that are missing, where all must be there.
fn check_fields(text: &str, path: &str, own: &Table, all: &Table, must_be_there: bool, problems: &mut Vec<String>) {
    let known: Vec<&str> = all.keys().map(String::as_str).collect();
    for field in own.keys().filter(|field| !all.contains_key(*field)) {
        let line =
            line_of(text, path.trim_end_matches('.'), field).map_or_else(String::new, |line| format!("line {line}: "));
        let hint = match recrash_roads::nearest(field, &known) {
            Some(meant) => format!("did you mean {path}{meant}?"),
            None => format!("there are: {}", known.join(", ")),
        };
        problems.push(format!("{line}there is no field {path}{field}; {hint}"));
    }
    for (field, value) in all {
        match (own.get(field), value) {
            (Some(Value::Table(own)), Value::Table(all)) => {
                check_fields(text, &format!("{path}{field}."), own, all, must_be_there, problems);
            }
            (None, _) if must_be_there && !OPTIONAL.contains(&field.as_str()) => {
                problems.push(format!(
                    "{path}{field} is missing; write it, or name a profile that has the rest: {BASE} = \"{DEFAULT_PROFILE}\""
                ));
            }
            _ => {}
        }
    }
}

/// The line of a field in a table of a TOML text.
fn line_of(text: &str, table: &str, field: &str) -> Option<usize> {
    let mut inside = "";
    let at = text.lines().position(|line| {
        let line = line.trim();
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.split(']').next()) {
            inside = name.trim();
        }
        let named = line.split('=').next().map(str::trim);
        inside == table && named == Some(field) || table.is_empty() && line == format!("[{field}]")
    });
    at.map(|at| at + 1)
}

/// Puts fields in the place of others; a list as a whole.
fn lay_over(base: &mut Table, own: Table) {
    for (field, value) in own {
        match (base.get_mut(&field), value) {
            (Some(Value::Table(base)), Value::Table(own)) => lay_over(base, own),
            (_, value) => drop(base.insert(field, value)),
        }
    }
}

fn parse(text: &str, name: &str) -> Result<SystemProfile, PipelineError> {
    let told = |message: String| {
        let location = Location { file: Some(name.to_owned()), ..Location::default() };
        Diagnostic::new(Severity::Error, "profile.invalid", location, message)
    };
    let all_bad = |messages: Vec<String>| PipelineError::BadInput {
        what: format!("{name} is not a usable profile"),
        diagnostics: messages.into_iter().map(told).collect(),
    };
    let bad = |message: String| all_bad(vec![message]);
    let (table, has_base) = with_base(text, name).map_err(all_bad)?;
    // Of a text of its own the line is told.
    let read = if has_base { SystemProfile::deserialize(table) } else { toml::from_str(text) };
    let profile = read.map_err(|e| bad(e.to_string()))?;
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
    fn a_profile_with_a_base_says_only_what_is_otherwise() {
        let text = "base = \"paper\"\n[failure]\nmin_gap_m = 0.5\n[excludes]\ncollisions = []\n";
        let (mine, paper) = (parse(text, "my/own.toml").unwrap(), load_profile("paper").unwrap());
        assert_eq!((mine.name.as_str(), mine.failure.min_gap_m), ("own", 0.5));
        assert!(mine.excludes.collisions.is_empty() && !paper.excludes.collisions.is_empty());
        let mut failure = paper.failure.clone();
        failure.min_gap_m = 0.5;
        assert_eq!((mine.failure, &mine.expresses, &mine.records), (failure, &paper.expresses, &paper.records));
        assert_eq!(load_profile("open").unwrap().excludes, mine.excludes);
    }

    #[test]
    fn everything_that_is_wrong_with_the_fields_is_told_at_once() {
        let told = |text: &str| match parse(text, "x.toml").unwrap_err() {
            PipelineError::BadInput { diagnostics, .. } => {
                diagnostics.into_iter().map(|told| told.message).collect::<Vec<_>>().join("\n")
            }
            other => panic!("{other:?}"),
        };
        let all = told("name = \"x\"\nmin_gap = 1.0\n[failure]\nmin_gapp_m = 1.0\n");
        for words in [
            "line 2: there is no field min_gap",
            "line 4: there is no field failure.min_gapp_m; did you mean failure.min_gap_m?",
            "ego is missing",
            "failure.min_gap_m is missing",
            "base = \"open\"",
        ] {
            assert!(all.contains(words), "{words}: {all}");
        }
        assert!(told("base = \"opn\"").contains("base is no built-in profile; there are: open, paper"));
        assert!(told("base = \"open\"\n[failure]\nmin_gap_m = \"a\"").contains("min_gap_m"));
        assert!(!told("base = \"open\"\nego_ = 1").contains("is missing"));
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
