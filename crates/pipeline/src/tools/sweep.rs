//! Very many rollouts around a few scenarios, one row each in a Parquet file.
//!
//! What is in memory is one row group, whatever the number of rollouts; rows come in the order of their numbers, and the
//! file has the same bytes for any number of threads. Columns: `docs/sweep.md`.

use crate::error::PipelineError;
use crate::files::output::{Begun, Output, Outputs};
use crate::files::paths;
use crate::files::store::{Store, io};
use crate::profiles::load_profile;
use crate::reading::named;
use crate::reading::scenarios::read_scenario;
use crate::simulators::external::{Patience, default_python};
use crate::simulators::{Simulator, SimulatorKind, drives_on_metadrive_alone, start_simulator};
use crate::suite::names;
use crate::suite::{Suite, refuse_untrusted, thread_pool};
use crate::tools::tuning::movable;
use rayon::prelude::*;
use recrash_metrics::{findings, measure};
use recrash_model::Seed;
use recrash_model::metrics::{Contact, PartnerMetrics, Timed};
use recrash_model::profile::SystemProfile;
use recrash_model::rollout::{Rollout, TerminationKind};
use recrash_model::scenario::{NOTHING_TO_TEST, ScenarioDraft};
use recrash_model::selection::Selection;
use recrash_model::tuning::{Parameter, TuneLog, apply};
use recrash_records::{Column, ParquetWriter};
use recrash_roads::Scenario;
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Rollouts between two reports of progress.
const CHUNK: u64 = 2048;
/// Rows of a row group, which is what is kept in memory.
const GROUP_ROWS: usize = 32 * CHUNK as usize;

/// A number of the scenario that varies, as typed: `POINTER=MIN:MAX`.
#[derive(Debug, Clone, PartialEq)]
pub struct Vary {
    pointer: String,
    min: f64,
    max: f64,
}

impl std::str::FromStr for Vary {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = "it must be POINTER=MIN:MAX, such as /partners/0/speed_mps=5:12";
        let (pointer, range) = text.rsplit_once('=').ok_or(wanted)?;
        let (min, max) = range.split_once(':').ok_or(wanted)?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite()).ok_or(wanted);
        let (min, max) = (number(min)?, number(max)?);
        if !pointer.starts_with('/') {
            return Err(format!("{wanted}: a JSON pointer begins with /"));
        }
        if min > max {
            return Err(format!("{wanted}: {min} is more than {max}"));
        }
        Ok(Self { pointer: pointer.to_owned(), min, max })
    }
}

/// What to sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepRequest<'a> {
    /// A scenario file, or the folder of a suite: its tuned scenarios in turn.
    pub source: &'a Path,
    /// What varies in a scenario file. Where empty: what the suite's search might move, or what a search would.
    pub vary: &'a [Vary],
    /// Rollouts.
    pub rollouts: u64,
    /// Profile with the failure criteria, and the ego where none is named.
    pub profile: Option<&'a str>,
    /// The profile of scenarios that are no suite's, where none is named.
    pub default_profile: &'a str,
    /// Ego.
    pub ego: Option<&'a str>,
    /// How long answers of an external ego are waited for.
    pub patience: Patience,
    /// Seed of the samples.
    pub seed: u64,
    /// Worker threads; as many as there are cores where not given.
    pub threads: Option<usize>,
    /// Whether a program that only the suite names is started as the ego.
    pub trust: bool,
    /// The file to write: the table, or the scenario of one rollout.
    pub out: &'a Path,
}

/// What came of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepSummary {
    /// Always `recrash.sweep/1`.
    pub format: String,
    /// Rollouts, those among them that could not be run.
    pub rollouts: u64,
    /// Rollouts by verdict.
    pub verdicts: BTreeMap<String, u64>,
    /// The rollout with the least gap: its number, and the gap. [m]
    pub closest: Option<(u64, f64)>,
    /// Scenarios and what varied in each.
    pub scenarios: Vec<SweptScenario>,
    /// Scenarios of the suite that were not swept, because their tuned files are not there.
    pub passed_over: Vec<String>,
    /// Scenarios that were not swept, because no number of theirs may move.
    pub fixed: Vec<String>,
    /// Scenarios that were not swept, because their ego was parked and there is nothing to test.
    pub parked: Vec<String>,
    /// The table.
    #[serde(serialize_with = "paths::as_text")]
    pub file: PathBuf,
}

/// One of the scenarios of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweptScenario {
    /// Scenario.
    pub id: String,
    /// What varied.
    pub parameters: Vec<Parameter>,
}

/// A sweep with everything read, ready to run.
pub struct Sweep {
    points: SweepPoints,
    ego: String,
    simulator: SimulatorKind,
    patience: Patience,
    rollouts: u64,
    threads: Option<usize>,
    output: Output,
    passed_over: Vec<String>,
    fixed: Vec<String>,
    parked: Vec<String>,
}

/// What varies in which scenarios: any rollout of a sweep is made of its number alone, wherever and in whatever order.
pub struct SweepPoints {
    bases: Vec<Base>,
    /// Pointers of all scenarios, each once, in order of first appearance.
    pointers: Vec<String>,
    profile: SystemProfile,
    seed: Seed,
}

struct Base {
    draft: ScenarioDraft,
    parameters: Vec<Parameter>,
}

impl Sweep {
    /// Reads and checks what a sweep needs.
    ///
    /// # Errors
    /// A file cannot be read or is no scenario, something varies that is no number of it, nothing varies in any, or there is
    /// nothing to test in any.
    /// The file to write cannot be, or is one of those that are read.
    pub fn prepare(request: &SweepRequest) -> Result<Self, PipelineError> {
        let saved = if request.source.is_dir() { Suite::saved_options(request.source)? } else { None };
        let default = saved.as_ref().map_or(request.default_profile, |options| &options.profile);
        let profile_name = request.profile.unwrap_or(default).to_owned();
        let profile = load_profile(&profile_name)?;
        let saved_ego = saved.as_ref().and_then(|options| options.ego.clone());
        let ego = request.ego.map(str::to_owned).or(saved_ego).unwrap_or_else(|| profile.ego.clone());
        refuse_untrusted(&ego, request.trust || request.ego.is_some())?;
        let read = named::of_profile_and_ego(Some(&profile_name), Some(&ego));
        let output = Outputs::of_inputs(read.into_iter().chain([request.source.to_owned()])).claim(request.out)?;
        let files = scenario_files(request.source)?;
        let bases = files.iter().map(|file| base(file, request.vary, &profile)).collect::<Result<Vec<_>, _>>()?;
        let passed_over = passed_over(request.source, &bases);
        let name = request.source.display().to_string();
        let (bases, parked) = tested(bases, &name)?;
        let (bases, fixed) = parted(bases, &name)?;
        let points = SweepPoints::new(bases, profile, request.seed);
        let (rollouts, threads, patience) = (request.rollouts, request.threads, request.patience);
        let simulator = if drives_on_metadrive_alone(&ego) { SimulatorKind::Metadrive } else { SimulatorKind::Native };
        Ok(Self { points, ego, simulator, patience, rollouts, threads, output, passed_over, fixed, parked })
    }

    /// Ego that drives.
    pub fn ego(&self) -> &str {
        &self.ego
    }

    /// The scenario of one rollout, to look at it or run it again.
    ///
    /// # Errors
    /// There is no such rollout.
    pub fn draft(&self, number: u64) -> Result<ScenarioDraft, PipelineError> {
        if number >= self.rollouts {
            return Err(PipelineError::bad_input(format!("there is no rollout {number} of {}", self.rollouts)));
        }
        self.points.draft(number)
    }

    /// Scenarios of the suite that are not swept, because their tuned files are not there.
    pub fn passed_over(&self) -> &[String] {
        &self.passed_over
    }

    /// Scenarios that are not swept, because no number of theirs may move.
    pub fn fixed(&self) -> &[String] {
        &self.fixed
    }

    /// Scenarios that are not swept, because there is nothing to test in them.
    pub fn parked(&self) -> &[String] {
        &self.parked
    }

    /// Writes the scenario of one rollout.
    ///
    /// # Errors
    /// There is no such rollout, or the file cannot be written.
    pub fn write_draft(&self, number: u64) -> Result<(), PipelineError> {
        self.output.write(recrash_roads::write_draft(&self.draft(number)?).as_bytes())
    }

    /// Runs everything and writes the table; a regular file whole or not at all. `progress` is told how many rollouts are
    /// done.
    ///
    /// # Errors
    /// The table cannot be written, or the ego cannot be started. A rollout cannot fail: it gets its verdict.
    pub fn run(&self, progress: &(dyn Fn(u64) + Sync)) -> Result<SweepSummary, PipelineError> {
        let threads = thread_pool(self.threads.unwrap_or(0))?;
        let workers = threads.current_num_threads();
        let simulator = start_simulator(self.simulator, &self.ego, &default_python(), workers, self.patience)?;
        let failed = |source| io("write", self.output.name(), source);
        let (begun, summary) = self.write(self.output.begin()?, &threads, &simulator, progress, &failed)?;
        begun.finish().map_err(failed)?;
        Ok(summary)
    }

    fn write(
        &self,
        sink: Begun,
        threads: &rayon::ThreadPool,
        simulator: &dyn Simulator,
        progress: &(dyn Fn(u64) + Sync),
        failed: &dyn Fn(std::io::Error) -> PipelineError,
    ) -> Result<(Begun, SweepSummary), PipelineError> {
        let empty = self.points.columns(&[]);
        let columns = empty.iter().map(|(name, column)| (name.as_str(), column));
        let mut writer = ParquetWriter::new(sink, "rollouts", columns, &self.notes()).map_err(failed)?;
        let mut summary = self.empty_summary();
        let mut rows: Vec<Row> = Vec::with_capacity(GROUP_ROWS.min(self.rollouts as usize));
        let mut done = 0;
        while done < self.rollouts {
            let end = (done + CHUNK).min(self.rollouts);
            let chunk = threads.install(|| self.points.rows(done..end, simulator));
            chunk.iter().for_each(|row| summary.count(row));
            rows.extend(chunk);
            done = end;
            if rows.len() >= GROUP_ROWS || done == self.rollouts {
                writer.write(self.points.columns(&rows).iter().map(|(_, column)| column)).map_err(failed)?;
                rows.clear();
            }
            progress(done);
        }
        Ok((writer.finish().map_err(failed)?, summary))
    }

    /// What the file says about itself.
    fn notes(&self) -> Vec<(&'static str, String)> {
        let ids: Vec<&str> = self.points.bases.iter().map(|base| base.draft.id.as_str()).collect();
        vec![
            ("recrash.version", env!("CARGO_PKG_VERSION").to_owned()),
            ("recrash.ego", self.ego.clone()),
            ("recrash.profile", self.points.profile.name.clone()),
            ("recrash.scenarios", ids.join(",")),
        ]
    }

    fn empty_summary(&self) -> SweepSummary {
        let scenarios = self
            .points
            .bases
            .iter()
            .map(|base| SweptScenario { id: base.draft.id.clone(), parameters: base.parameters.clone() });
        SweepSummary {
            format: "recrash.sweep/1".to_owned(),
            rollouts: 0,
            verdicts: BTreeMap::new(),
            closest: None,
            scenarios: scenarios.collect(),
            passed_over: self.passed_over.clone(),
            fixed: self.fixed.clone(),
            parked: self.parked.clone(),
            file: self.output.name().to_owned(),
        }
    }
}

impl SweepPoints {
    /// Around scenarios that stand in no file: `vary` in each of them, or what a search would move where it is empty. Those
    /// with nothing to test are left out.
    ///
    /// # Errors
    /// There is no scenario, what varies is no number of one, nothing varies in any, or there is nothing to test in any.
    pub fn around(
        scenarios: &[&Scenario],
        vary: &[Vary],
        profile: SystemProfile,
        seed: u64,
    ) -> Result<Self, PipelineError> {
        if scenarios.is_empty() {
            return Err(PipelineError::bad_input("there is no scenario to sweep".to_owned()));
        }
        let base = |scenario: &&Scenario| based(scenario.draft(), vary, &scenario.draft().id, None, &profile);
        let bases = scenarios.iter().map(base).collect::<Result<Vec<_>, _>>()?;
        let (bases, _) = tested(bases, "these scenarios")?;
        let (bases, _) = parted(bases, "these scenarios")?;
        Ok(Self::new(bases, profile, seed))
    }

    fn new(bases: Vec<Base>, profile: SystemProfile, seed: u64) -> Self {
        let mut pointers: Vec<String> = Vec::new();
        for parameter in bases.iter().flat_map(|base| &base.parameters) {
            if !pointers.contains(&parameter.pointer) {
                pointers.push(parameter.pointer.clone());
            }
        }
        Self { bases, pointers, profile, seed: Seed(seed).child("sweep") }
    }

    /// A table of these rollouts, a row each in the order of their numbers; on so many threads, or as many as there are cores for 0.
    ///
    /// # Errors
    /// There cannot be so many threads.
    pub fn table(
        &self,
        numbers: Range<u64>,
        simulator: &dyn Simulator,
        threads: usize,
    ) -> Result<Vec<(String, Column)>, PipelineError> {
        let pool = thread_pool(threads)?;
        Ok(self.columns(&pool.install(|| self.rows(numbers, simulator))))
    }

    /// The scenario of one rollout.
    ///
    /// # Errors
    /// The sampled values do not fit the scenario.
    pub fn draft(&self, number: u64) -> Result<ScenarioDraft, PipelineError> {
        let (base, values, _) = self.point(number);
        let mut draft = apply(&base.draft, &base.parameters, &values).map_err(PipelineError::bad_input)?;
        draft.id = format!("{}-{number}", draft.id);
        Ok(draft)
    }

    fn rows(&self, numbers: Range<u64>, simulator: &dyn Simulator) -> Vec<Row> {
        numbers.into_par_iter().map(|number| self.row(number, simulator)).collect()
    }

    /// Which scenario a rollout is of, the sampled values, and the seed they come from.
    fn point(&self, number: u64) -> (&Base, Vec<f64>, u64) {
        let base = &self.bases[(number % self.bases.len() as u64) as usize];
        let seed = self.seed.child(&number.to_string());
        let mut rng = seed.rng();
        let sample = |parameter: &Parameter| {
            let value = rng.range(parameter.min, parameter.max);
            if parameter.integer { value.round() } else { value }
        };
        (base, base.parameters.iter().map(sample).collect(), seed.0)
    }

    fn row(&self, number: u64, simulator: &dyn Simulator) -> Row {
        let (base, values, seed) = self.point(number);
        let by_pointer = |pointer: &String| {
            base.parameters.iter().position(|parameter| parameter.pointer == *pointer).map(|at| values[at])
        };
        let parameters = self.pointers.iter().map(by_pointer).collect();
        let row = Row { number, scenario: base.draft.id.clone(), seed, parameters, outcome: Err(String::new()) };
        let draft = match apply(&base.draft, &base.parameters, &values) {
            Ok(draft) => draft,
            Err(_) => return Row { outcome: Err(REFUSED.to_owned()), ..row },
        };
        let Ok(checked) = recrash_roads::check(draft) else {
            return Row { outcome: Err(REFUSED.to_owned()), ..row };
        };
        match simulator.run(&checked.value) {
            Ok(rollout) => Row { outcome: Ok(self.outcome(&checked.value, &rollout)), ..row },
            Err(_) => Row { outcome: Err(EGO_FAILED.to_owned()), ..row },
        }
    }

    fn outcome(&self, scenario: &Scenario, rollout: &Rollout) -> Outcome {
        let metrics = measure(scenario, rollout, &self.profile.failure);
        let found = findings(rollout, scenario.draft().ego.handover_s.unwrap_or(0.0), &metrics, &self.profile.failure);
        // The most serious failure stands first among the kinds.
        let failure = found.iter().map(|finding| finding.kind).filter(|kind| kind.is_failure()).min();
        let least = |of: fn(&PartnerMetrics) -> Option<Timed>| {
            let values = metrics.partners.iter().filter_map(of).map(|timed| timed.value);
            values.filter(|value| value.is_finite()).min_by(f64::total_cmp)
        };
        Outcome {
            verdict: failure.map_or("passed", |kind| kind.label()),
            failed: failure.is_some(),
            termination: termination_name(metrics.termination),
            duration_s: metrics.duration_s,
            min_gap: metrics.min_gap.filter(|gap| gap.value.is_finite()),
            min_ttc_s: least(|partner| partner.min_ttc),
            pet_s: least(|partner| partner.pet),
            contact: metrics.contact,
            max_deceleration_mps2: metrics.ego.max_deceleration.value,
            state_hash: rollout.state_hash.clone(),
        }
    }

    /// The table's columns with these rows.
    fn columns(&self, rows: &[Row]) -> Vec<(String, Column)> {
        fn of<T>(rows: &[Row], value: impl Fn(&Outcome) -> Option<T>) -> Vec<Option<T>> {
            rows.iter().map(|row| row.outcome.as_ref().ok().and_then(&value)).collect()
        }
        let text = |value: fn(&Outcome) -> Option<String>| Column::Text(of(rows, value));
        let number = |value: fn(&Outcome) -> Option<f64>| Column::Number(of(rows, value));
        let verdict = |row: &Row| match &row.outcome {
            Ok(outcome) => outcome.verdict.to_owned(),
            Err(why) => why.clone(),
        };
        let mut columns = vec![
            ("rollout".to_owned(), Column::Whole(rows.iter().map(|row| Some(row.number as i64)).collect())),
            ("scenario".to_owned(), Column::Text(rows.iter().map(|row| Some(row.scenario.clone())).collect())),
            // Sixteen digits: not every reader has whole numbers of 64 bits without a sign.
            ("seed".to_owned(), Column::Text(rows.iter().map(|row| Some(format!("{:016x}", row.seed))).collect())),
        ];
        for (at, pointer) in self.pointers.iter().enumerate() {
            columns.push((pointer.clone(), Column::Number(rows.iter().map(|row| row.parameters[at]).collect())));
        }
        let results = [
            ("verdict", Column::Text(rows.iter().map(|row| Some(verdict(row))).collect())),
            ("failed", Column::Flag(of(rows, |o| Some(o.failed)))),
            ("termination", text(|o| Some(o.termination.to_owned()))),
            ("duration_s", number(|o| Some(o.duration_s))),
            ("min_gap_m", number(|o| o.min_gap.map(|gap| gap.value))),
            ("min_gap_time_s", number(|o| o.min_gap.map(|gap| gap.time_s))),
            ("min_ttc_s", number(|o| o.min_ttc_s)),
            ("pet_s", number(|o| o.pet_s)),
            ("contact_kind", text(|o| o.contact.as_ref().map(|contact| contact.kind.label().to_owned()))),
            ("contact_time_s", number(|o| o.contact.as_ref().map(|contact| contact.time_s))),
            ("relative_speed_mps", number(|o| o.contact.as_ref().map(|contact| contact.relative_speed_mps))),
            ("ego_max_deceleration_mps2", number(|o| Some(o.max_deceleration_mps2))),
            ("state_hash", text(|o| Some(o.state_hash.clone()))),
        ];
        columns.extend(results.map(|(name, column)| (name.to_owned(), column)));
        columns
    }
}

/// Verdict of a rollout whose sampled scenario the check refuses.
const REFUSED: &str = "refused";
/// Verdict of a rollout that an external ego failed to drive.
const EGO_FAILED: &str = "ego failed";

/// One rollout; without an outcome the verdict that stands for it.
struct Row {
    number: u64,
    scenario: String,
    seed: u64,
    parameters: Vec<Option<f64>>,
    outcome: Result<Outcome, String>,
}

struct Outcome {
    verdict: &'static str,
    failed: bool,
    termination: &'static str,
    duration_s: f64,
    min_gap: Option<Timed>,
    min_ttc_s: Option<f64>,
    pet_s: Option<f64>,
    contact: Option<Contact>,
    max_deceleration_mps2: f64,
    state_hash: String,
}

impl SweepSummary {
    fn count(&mut self, row: &Row) {
        self.rollouts += 1;
        let verdict = match &row.outcome {
            Ok(outcome) => outcome.verdict,
            Err(why) => why,
        };
        *self.verdicts.entry(verdict.to_owned()).or_default() += 1;
        if let Some(gap) = row.outcome.as_ref().ok().and_then(|outcome| outcome.min_gap)
            && self.closest.is_none_or(|(_, least)| gap.value < least)
        {
            self.closest = Some((row.number, gap.value));
        }
    }
}

/// As rollouts have it.
fn termination_name(kind: TerminationKind) -> &'static str {
    match kind {
        TerminationKind::Arrived => "arrived",
        TerminationKind::Contact => "contact",
        TerminationKind::Timeout => "timeout",
        TerminationKind::Stuck => "stuck",
        TerminationKind::OffRoad => "off_road",
        TerminationKind::Diverged => "diverged",
    }
}

/// The scenario file, or those of a suite: the tuned ones, by name.
fn scenario_files(source: &Path) -> Result<Vec<PathBuf>, PipelineError> {
    if !source.is_dir() {
        return Ok(vec![source.to_owned()]);
    }
    let folder = source.join("6-tuned");
    let none = || {
        PipelineError::bad_input(format!(
            "{} has no tuned scenarios; give a scenario file, or a suite that `recrash run` has made",
            source.display()
        ))
    };
    let entries = std::fs::read_dir(&folder).map_err(|_| none())?;
    let mut files: Vec<PathBuf> = entries.filter_map(Result::ok).map(|entry| entry.path()).collect();
    // Beside ID.json lie ID.search.json, ID.run.json and others.
    files.retain(|file| {
        file.extension().is_some_and(|e| e == "json")
            && file.file_stem().is_some_and(|stem| !stem.to_string_lossy().contains('.'))
    });
    files.sort();
    if files.is_empty() { Err(none()) } else { Ok(files) }
}

/// Scenarios of a suite without a tuned file: it was deleted, or the scenario was never made.
fn passed_over(source: &Path, bases: &[Base]) -> Vec<String> {
    // A folder with scenario files alone has no selection, and lacks nothing.
    let selection: Option<Selection> = Store::at(source).read_json(names::SELECTION).ok();
    let ids = selection.into_iter().flat_map(|selection| selection.clusters).map(|cluster| cluster.scenario_id);
    ids.filter(|id| !bases.iter().any(|base| base.draft.id == *id)).collect()
}

fn base(file: &Path, vary: &[Vary], profile: &SystemProfile) -> Result<Base, PipelineError> {
    let (scenario, _) = read_scenario(file)?;
    let searched = if vary.is_empty() { searched(file)? } else { None };
    based(scenario.draft(), vary, &file.display().to_string(), searched, profile)
}

/// A scenario with what varies in it: what was asked for, what a suite's search moved, or what one would move.
fn based(
    draft: &ScenarioDraft,
    vary: &[Vary],
    name: &str,
    searched: Option<Vec<Parameter>>,
    profile: &SystemProfile,
) -> Result<Base, PipelineError> {
    let parameters = match searched {
        _ if !vary.is_empty() => varied(draft, vary, name)?,
        Some(found) => found,
        None => movable(draft, profile),
    };
    Ok(Base { draft: draft.clone(), parameters })
}

/// The scenarios in which there is something to test, and the ids of the others.
fn tested(bases: Vec<Base>, name: &str) -> Result<(Vec<Base>, Vec<String>), PipelineError> {
    let (tested, parked): (Vec<Base>, Vec<Base>) = bases.into_iter().partition(|base| base.draft.is_tested());
    let parked: Vec<String> = parked.into_iter().map(|base| base.draft.id).collect();
    match &parked[..] {
        [id] if tested.is_empty() => Err(PipelineError::bad_input(format!("{id}: {NOTHING_TO_TEST}"))),
        [_, ..] if tested.is_empty() => {
            Err(PipelineError::bad_input(format!("{name}: every ego was parked, so there is nothing to test")))
        }
        _ => Ok((tested, parked)),
    }
}

/// The scenarios in which something varies, and the ids of the others.
fn parted(bases: Vec<Base>, name: &str) -> Result<(Vec<Base>, Vec<String>), PipelineError> {
    let (moving, fixed): (Vec<Base>, Vec<Base>) = bases.into_iter().partition(|base| !base.parameters.is_empty());
    if moving.is_empty() {
        return Err(PipelineError::bad_input(format!(
            "nothing varies in {name}; say what shall vary, as POINTER=MIN:MAX"
        )));
    }
    Ok((moving, fixed.into_iter().map(|base| base.draft.id).collect()))
}

/// What the search of a suite might move, where its log lies beside the scenario.
fn searched(file: &Path) -> Result<Option<Vec<Parameter>>, PipelineError> {
    let id = file.file_stem().unwrap_or_default().to_string_lossy();
    let log = names::tune_log(&id);
    let (folder, log) = (Store::at(&file.with_file_name("")), log.rsplit('/').next().unwrap_or_default());
    if !folder.path(log).exists() {
        return Ok(None);
    }
    let found = folder.read_json::<TuneLog>(log)?.parameters;
    // What an account leaves open stands at no place in the scenario.
    Ok(found.iter().all(|parameter| parameter.pointer.starts_with('/')).then_some(found))
}

fn varied(draft: &ScenarioDraft, vary: &[Vary], name: &str) -> Result<Vec<Parameter>, PipelineError> {
    let document = serde_json::to_value(draft).unwrap_or_default();
    let parameter = |vary: &Vary| {
        let number = document
            .pointer(&vary.pointer)
            .filter(|value| value.is_number())
            .ok_or_else(|| PipelineError::bad_input(format!("{}: there is no such number in {name}", vary.pointer)))?;
        Ok(Parameter {
            pointer: vary.pointer.clone(),
            unit: String::new(),
            min: vary.min,
            max: vary.max,
            start: number.as_f64().unwrap_or(vary.min),
            integer: !number.is_f64(),
            reason: "asked for".to_owned(),
        })
    };
    vary.iter().map(parameter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_varies_is_read_from_what_is_typed() {
        let vary: Vary = "/partners/0/speed_mps=5:12.5".parse().unwrap();
        assert_eq!(vary, Vary { pointer: "/partners/0/speed_mps".to_owned(), min: 5.0, max: 12.5 });
        for wrong in ["speed=1:2", "/a=1", "/a=2:1", "/a=x:1", "/a=0:inf", ""] {
            assert!(wrong.parse::<Vary>().is_err(), "{wrong}");
        }
    }
}
