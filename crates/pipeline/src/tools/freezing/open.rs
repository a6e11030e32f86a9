//! A frozen suite, opened: every file of it is as it was frozen.

use super::hash_of;
use crate::error::PipelineError;
use crate::files::store::{is_plain_name, read_text};
use crate::reading::documents::read_document;
use crate::reading::scenarios::{not_runnable, scenario_from};
use crate::suite::SUITE_FILE;
use rayon::prelude::*;
use recrash_model::frozen::{FROZEN_FILE, FROZEN_FORMAT, FrozenSuite, FrozenTest, scenario_content};
use recrash_roads::{MAX_SCENARIO_BYTES, Scenario};
use std::path::Path;

/// A frozen suite with its scenarios.
pub(crate) struct Opened {
    pub suite: FrozenSuite,
    /// In the order of the suite's tests.
    pub scenarios: Vec<Scenario>,
}

impl Opened {
    /// Opens a frozen suite.
    ///
    /// # Errors
    /// It is none, a file of it is not as it was frozen, or a scenario cannot be run by this version.
    pub fn read(dir: &Path) -> Result<Self, PipelineError> {
        let list = dir.join(FROZEN_FILE);
        if !list.is_file() {
            let why = match dir.join(SUITE_FILE).is_file() {
                true => "it is a suite; `recrash freeze` makes a frozen one of it".to_owned(),
                false => {
                    format!("there is no {FROZEN_FILE} in it, so it is no frozen suite; `recrash freeze` makes one")
                }
            };
            return Err(PipelineError::bad_input(format!("{}: {why}", dir.display())));
        }
        let suite: FrozenSuite = read_document(&list, "frozen suite", FROZEN_FORMAT)?;
        let bad = |why: String| PipelineError::bad_input(format!("{}: {why}", list.display()));
        for (at, pair) in suite.tests.windows(2).enumerate() {
            if pair[0].id >= pair[1].id {
                return Err(bad(format!(
                    "tests[{}].id: \"{}\" is not in order, or is there twice",
                    at + 1,
                    pair[1].id
                )));
            }
        }
        if suite.content != FrozenSuite::content_of(&suite.profile, &suite.tests) {
            return Err(bad(format!(
                "content: \"{}\" is not the name of these tests and limits; freeze the suite again",
                suite.content
            )));
        }
        let scenario = |(at, test): (usize, &FrozenTest)| scenario_of(dir, at, test);
        let scenarios = suite.tests.par_iter().enumerate().map(scenario).collect::<Result<_, _>>()?;
        Ok(Self { suite, scenarios })
    }
}

fn scenario_of(dir: &Path, at: usize, test: &FrozenTest) -> Result<Scenario, PipelineError> {
    let list = dir.join(FROZEN_FILE);
    let bad =
        |field: &str, why: &str| PipelineError::bad_input(format!("{}: tests[{at}].{field}: {why}", list.display()));
    if !is_plain_name(&test.scenario) {
        return Err(bad("scenario", "it leads out of the suite, or is no plain name"));
    }
    let path = dir.join(&test.scenario);
    let is_file = std::fs::symlink_metadata(&path).is_ok_and(|is| is.file_type().is_file());
    if !is_file {
        return Err(bad("scenario", &format!("there is no file {}", test.scenario)));
    }
    let text = read_text(&path, MAX_SCENARIO_BYTES as u64)?;
    if hash_of(&text) != test.sha256 {
        let why = format!("{} is not as it was frozen; bring it back, or freeze the suite again", test.scenario);
        return Err(bad("sha256", &why));
    }
    let scenario = scenario_from(&text).map_err(|diagnostics| not_runnable(&path, diagnostics))?.value;
    if scenario.draft().id != test.id {
        return Err(bad("id", &format!("the scenario in {} is called {}", test.scenario, scenario.draft().id)));
    }
    if scenario_content(scenario.draft()) != test.content {
        return Err(bad("content", &format!("it is not the name of what {} runs", test.scenario)));
    }
    Ok(scenario)
}
