//! What the user chose, and the command that says it.

use crate::embedding::EmbeddingKind;
use crate::error::PipelineError;
use crate::files::paths::quoted;
use crate::models::cast::Cast;
use crate::profiles::{DEFAULT_PROFILE, load_profile};
use crate::simulators::SimulatorKind;
use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_model::selection::{Strategy, Weighting};
use recrash_model::tuning::Aim;
use recrash_select::SelectOptions;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Where crash records come from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RecordSource {
    /// The built-in sample.
    Sample,
    /// SGO files, or those of another database where there is a mapping. A name that is no file here is looked up among
    /// the downloaded ones.
    Files(Vec<PathBuf>),
}

/// What the user chose. Everything that can change a byte of the results, and nothing else.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Options {
    /// Crash records.
    pub records: RecordSource,
    /// Which reports of one incident are merged; as the profile has it where not given.
    #[serde(default)]
    pub dedupe: Option<Dedupe>,
    /// Keeps the records of which this filter is true.
    #[serde(default)]
    pub filter: Option<String>,
    /// Mapping file: the records are those of another database.
    #[serde(default)]
    pub mapping: Option<PathBuf>,
    /// Profile: a built-in name or a path.
    pub profile: String,
    /// Scenarios to make, at most; all that can be told where not given.
    pub budget: Option<usize>,
    /// Also invents a crash for every template of the profile that no record is of.
    #[serde(default)]
    pub invent: bool,
    /// How the picks are chosen.
    pub strategy: Strategy,
    /// How much one record counts in sharing out the picks.
    #[serde(default)]
    pub weighting: Weighting,
    /// Weight of a template against a narrative: the length of its one-hot vector in the clustering space.
    #[serde(default = "default_template_weight")]
    pub template_weight: f64,
    /// Principal components of the embedding that enter the clustering space.
    #[serde(default = "default_dimensions")]
    pub dimensions: usize,
    /// Runs of k-means, of which the best is kept.
    #[serde(default = "default_restarts")]
    pub restarts: usize,
    /// Which embedding of the narratives.
    #[serde(default)]
    pub embedding: EmbeddingKind,
    /// Folder with the files of the embedding model; looked for where not given.
    #[serde(default)]
    pub model_dir: Option<PathBuf>,
    /// Who plays which role.
    #[serde(default)]
    pub cast: Cast,
    /// Simulator.
    #[serde(default)]
    pub simulator: SimulatorKind,
    /// Ego to run; the profile's where not given.
    pub ego: Option<String>,
    /// Points the search of each scenario may score.
    pub tune_budget: usize,
    /// Optimiser of the search.
    pub searcher: String,
    /// What the search looks for.
    #[serde(default)]
    pub aim: Aim,
    /// Seed of everything random.
    pub seed: u64,
}

fn default_template_weight() -> f64 {
    SelectOptions::default().template_weight
}

fn default_dimensions() -> usize {
    SelectOptions::default().dimensions
}

fn default_restarts() -> usize {
    SelectOptions::default().restarts
}

impl Default for Options {
    fn default() -> Self {
        Self {
            records: RecordSource::Sample,
            dedupe: None,
            filter: None,
            mapping: None,
            profile: DEFAULT_PROFILE.into(),
            budget: Some(20),
            invent: false,
            strategy: Strategy::Stratified,
            weighting: Weighting::default(),
            template_weight: default_template_weight(),
            dimensions: default_dimensions(),
            restarts: default_restarts(),
            embedding: EmbeddingKind::default(),
            model_dir: None,
            cast: Cast::default(),
            simulator: SimulatorKind::Native,
            ego: None,
            tune_budget: 160,
            searcher: "cma".into(),
            aim: Aim::default(),
            seed: 1,
        }
    }
}

impl Options {
    /// The model that stages what the rules do not show as told, where one designs and every incident that can be told is to be one: a
    /// smaller suite has enough of those that the rules tell.
    pub fn stager(&self) -> Option<&str> {
        self.cast.designer().filter(|_| self.budget.is_none())
    }

    /// The command that makes the suite, without the output folder.
    pub fn command(&self) -> String {
        let default = Self::default();
        let mut words = vec!["recrash run".to_owned()];
        if let RecordSource::Files(files) = &self.records {
            words.extend(files.iter().map(|f| format!("--records {}", quoted(&f.to_string_lossy()))));
        }
        let mut option = |name: &str, value: String, default: String| {
            if value != default {
                words.push(format!("--{name} {}", quoted(&value)));
            }
        };
        let mapping = self.mapping.as_ref().map(|file| file.to_string_lossy().into_owned());
        option("mapping", mapping.unwrap_or_default(), String::new());
        option("dedupe", self.dedupe.map(dedupe_name).unwrap_or_default(), String::new());
        option("where", self.filter.clone().unwrap_or_default(), String::new());
        option("profile", self.profile.clone(), default.profile);
        option("budget", budget_name(self.budget), budget_name(default.budget));
        option("strategy", self.strategy.name().into(), default.strategy.name().into());
        option("weighting", self.weighting.name().into(), default.weighting.name().into());
        option("template-weight", self.template_weight.to_string(), default.template_weight.to_string());
        option("dimensions", self.dimensions.to_string(), default.dimensions.to_string());
        option("restarts", self.restarts.to_string(), default.restarts.to_string());
        option("embedding", self.embedding.name().into(), default.embedding.name().into());
        let model_dir = self.model_dir.as_ref().map(|dir| dir.to_string_lossy().into_owned());
        option("model-dir", model_dir.unwrap_or_default(), String::new());
        option("paraphrase", self.cast.paraphrase.clone(), default.cast.paraphrase);
        option("model-reads", self.cast.reads.name().into(), default.cast.reads.name().into());
        option("design", self.cast.design.clone(), default.cast.design);
        option("tune", self.cast.tune.clone(), default.cast.tune);
        option("rounds", self.cast.rounds.to_string(), default.cast.rounds.to_string());
        option("review", self.cast.review.clone().unwrap_or_default(), String::new());
        option("repairs", self.cast.repairs.to_string(), default.cast.repairs.to_string());
        option("sim", self.simulator.name().into(), default.simulator.name().into());
        option("ego", self.ego.clone().unwrap_or_default(), String::new());
        option("tune-budget", self.tune_budget.to_string(), default.tune_budget.to_string());
        option("searcher", self.searcher.clone(), default.searcher);
        option("aim", self.aim.name().into(), default.aim.name().into());
        option("seed", self.seed.to_string(), default.seed.to_string());
        words.extend(self.invent.then(|| "--invent".to_owned()));
        words.join(" ")
    }

    /// Refuses paths that a suite file cannot hold.
    ///
    /// # Errors
    /// A path is not UTF-8.
    pub(crate) fn must_be_text(&self) -> Result<(), PipelineError> {
        let records: &[PathBuf] = match &self.records {
            RecordSource::Sample => &[],
            RecordSource::Files(files) => files,
        };
        let all = records.iter().chain(&self.mapping).chain(&self.model_dir);
        match all.into_iter().find(|path| path.to_str().is_none()) {
            None => Ok(()),
            Some(path) => Err(PipelineError::bad_input(format!(
                "{}: the path is not UTF-8, and a suite keeps its paths as text; rename it, or use a link with another name",
                path.display()
            ))),
        }
    }

    /// The profile, with what the options change in it.
    ///
    /// # Errors
    /// There is no such profile, or the file is none.
    pub(crate) fn system_profile(&self) -> Result<SystemProfile, PipelineError> {
        let mut profile = load_profile(&self.profile)?;
        profile.records.dedupe = self.dedupe.unwrap_or(profile.records.dedupe);
        Ok(profile)
    }
}

/// A budget as it is typed.
fn budget_name(budget: Option<usize>) -> String {
    budget.map_or("all".to_owned(), |budget| budget.to_string())
}

fn dedupe_name(dedupe: Dedupe) -> String {
    serde_json::to_value(dedupe).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::cast::Reads;

    #[test]
    fn the_command_names_every_option() {
        let default = Options::default();
        // Whoever adds an option adds it here, and to the command.
        let Options {
            records: _,
            dedupe: _,
            filter: _,
            mapping: _,
            profile: _,
            budget: _,
            invent: _,
            strategy: _,
            weighting: _,
            template_weight: _,
            dimensions: _,
            restarts: _,
            embedding: _,
            model_dir: _,
            cast: Cast { paraphrase: _, design: _, tune: _, rounds: _, repairs: _, reads: _, review: _ },
            simulator: _,
            ego: _,
            tune_budget: _,
            searcher: _,
            aim: _,
            seed: _,
        } = &default;
        let cast = |change: fn(&mut Cast)| {
            let mut options = Options::default();
            change(&mut options.cast);
            options
        };
        let name = || "x".to_owned();
        let others = [
            ("--records x", Options { records: RecordSource::Files(vec!["x".into()]), ..default.clone() }),
            ("--dedupe none", Options { dedupe: Some(Dedupe::None), ..default.clone() }),
            ("--where x", Options { filter: Some(name()), ..default.clone() }),
            ("--mapping x", Options { mapping: Some("x".into()), ..default.clone() }),
            ("--profile x", Options { profile: name(), ..default.clone() }),
            ("--budget all", Options { budget: None, ..default.clone() }),
            ("--invent", Options { invent: true, ..default.clone() }),
            ("--strategy kmeans", Options { strategy: Strategy::Kmeans, ..default.clone() }),
            ("--weighting severity", Options { weighting: Weighting::Severity, ..default.clone() }),
            ("--template-weight 7", Options { template_weight: 7.0, ..default.clone() }),
            ("--dimensions 7", Options { dimensions: 7, ..default.clone() }),
            ("--restarts 7", Options { restarts: 7, ..default.clone() }),
            ("--embedding minilm", Options { embedding: EmbeddingKind::Minilm, ..default.clone() }),
            ("--model-dir x", Options { model_dir: Some("x".into()), ..default.clone() }),
            ("--paraphrase x", cast(|cast| cast.paraphrase = "x".to_owned())),
            ("--design x", cast(|cast| cast.design = "x".to_owned())),
            ("--tune x", cast(|cast| cast.tune = "x".to_owned())),
            ("--rounds 7", cast(|cast| cast.rounds = 7)),
            ("--repairs 7", cast(|cast| cast.repairs = 7)),
            ("--model-reads all", cast(|cast| cast.reads = Reads::All)),
            ("--review x", cast(|cast| cast.review = Some("x".to_owned()))),
            ("--sim metadrive", Options { simulator: SimulatorKind::Metadrive, ..default.clone() }),
            ("--ego x", Options { ego: Some(name()), ..default.clone() }),
            ("--tune-budget 7", Options { tune_budget: 7, ..default.clone() }),
            ("--searcher x", Options { searcher: name(), ..default.clone() }),
            ("--aim severity", Options { aim: Aim::Severity, ..default.clone() }),
            ("--seed 7", Options { seed: 7, ..default.clone() }),
        ];
        for (words, options) in others {
            assert_eq!(options.command(), format!("recrash run {words}"));
        }
    }

    #[test]
    fn the_command_names_what_differs_from_the_defaults_and_quotes_it() {
        assert_eq!(Options::default().command(), "recrash run");
        let options = Options {
            records: RecordSource::Files(vec!["my file.csv".into()]),
            dedupe: Some(Dedupe::Incident),
            filter: Some("road = street".into()),
            budget: Some(5),
            strategy: Strategy::Kmeans,
            ..Options::default()
        };
        assert_eq!(
            options.command(),
            "recrash run --records 'my file.csv' --dedupe incident --where 'road = street' --budget 5 --strategy kmeans"
        );
    }
}
