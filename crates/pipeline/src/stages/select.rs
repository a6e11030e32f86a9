//! The second stage: records to picks; and studies of the choice.

use super::{StageReport, StageWork, cases, invent};
use crate::embedding::{Embeds, KeptRows, for_strategy};
use crate::error::PipelineError;
use crate::files::json::{to_compact_json, to_json};
use crate::files::store::sha256;
use crate::suite::names;
use crate::suite::{Stage, Suite, Work};
use rayon::prelude::*;
use recrash_model::record::{CrashRecord, RecordSet};
use recrash_model::selection::{BudgetRow, Cluster, Selection, Stability, Strategy};
use recrash_model::{Diagnostic, Outcome};
use recrash_select::{Embedding, SelectError, SelectOptions, budget_table, elbow, select_onward, stability};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Format tag of [`SelectionStudy`].
const STUDY_FORMAT: &str = "recrash.selection-study/1";

/// Format tag of the kept groups.
const GROUPS_FORMAT: &str = "recrash.selection-groups/1";

/// Budgets that a study tries, as far as there are records for them; the suite's own is always among them.
const BUDGETS: [usize; 18] = [2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 25, 30, 40, 50, 60, 80, 100, 150];

/// How much a choice depends on the seed and the strategy, and how large the budget should be
/// (`2-selection.study.json`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SelectionStudy {
    /// Always `recrash.selection-study/1`.
    pub format: String,
    /// Embedding of the narratives.
    pub embedding: String,
    /// Every strategy at the suite's budget, over many seeds.
    pub strategies: Vec<StrategyStudy>,
    /// The suite's strategy at many budgets.
    pub budgets: Vec<BudgetRow>,
    /// Budget at the elbow of the inertia.
    pub elbow: Option<usize>,
    /// Budget with the greatest silhouette.
    pub best_silhouette: Option<usize>,
}

/// One strategy over many seeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StrategyStudy {
    /// Strategy.
    pub strategy: Strategy,
    /// What its choices have in common.
    pub stability: Stability,
}

/// What a choice is made from, and what decides it.
struct Choice<'a> {
    suite: &'a Suite,
    embeds: Embeds,
    remarks: Vec<Diagnostic>,
    options: SelectOptions,
    /// What goes into the hash of the inputs.
    inputs: Vec<String>,
}

impl<'a> Choice<'a> {
    fn new(suite: &'a Suite) -> Result<Self, PipelineError> {
        let chosen = suite.options();
        let records = suite.output_hash(Stage::Records, Stage::Records.name(), names::RECORDS)?;
        let (embeds, remarks) = Embeds::choose(chosen.embedding, chosen.model_dir.as_deref(), suite.python())?;
        let options = SelectOptions {
            strategy: chosen.strategy,
            budget: chosen.budget.unwrap_or(usize::MAX),
            seed: suite.seed().child("select"),
            dimensions: chosen.dimensions,
            template_weight: chosen.template_weight,
            weighting: chosen.weighting,
            restarts: chosen.restarts,
        };
        invent::check(suite)?;
        let profile = cases::text_of(suite.profile());
        let mut inputs = vec![records, profile, format!("{options:?}"), embeds.fingerprint().to_owned()];
        inputs.extend(chosen.invent.then(|| "with invented ones".to_owned()));
        Ok(Self { suite, embeds, remarks, options, inputs })
    }

    /// Records, the rows of their narratives, and the rows to keep.
    fn read(&self) -> Result<(RecordSet, Embedding, KeptRows), PipelineError> {
        let store = self.suite.store();
        let records: RecordSet = store.read_json(names::RECORDS)?;
        let kept = KeptRows::read(&store.read_or_empty(names::EMBEDDING));
        let (embedding, kept) = self.embeds.embed(&records, kept).map_err(bad_choice)?;
        Ok((records, embedding, kept))
    }
}

/// The groups of a choice by the records' names, for the next one to go on from (`2-selection.groups.json`).
#[derive(Serialize, Deserialize)]
struct Groups {
    /// Always [`GROUPS_FORMAT`].
    format: String,
    /// What was chosen by: groups of another choice are no beginning.
    chosen_by: String,
    /// Names of the records of each group, the pick first.
    groups: Vec<Vec<String>>,
}

impl Choice<'_> {
    /// The options, where all are asked for with as many picks as there are records.
    fn within(&self, records: &RecordSet) -> SelectOptions {
        let budget = match self.suite.options().budget {
            Some(budget) => budget,
            None => records.usable.len().max(1),
        };
        SelectOptions { budget, ..self.options.clone() }
    }

    /// Profile and options.
    fn chosen_by(&self) -> String {
        sha256(self.inputs[1..].join("\n").as_bytes())
    }

    fn groups(&self, records: &RecordSet, selection: &Selection) -> Groups {
        let names = names_of(records);
        let of = |cluster: &Cluster| {
            // The pick stands first; the others stay in their order.
            let others = cluster.members.iter().filter(|&&at| at != cluster.pick_index);
            std::iter::once(&cluster.pick_index).chain(others).map(|&at| names[at].clone()).collect()
        };
        let groups = selection.clusters.iter().filter(|cluster| !cluster.invented).map(of).collect();
        Groups { format: GROUPS_FORMAT.to_owned(), chosen_by: self.chosen_by(), groups }
    }

    /// Where the records of the last choice's groups stand today; nothing where there is none of this kind, or the caller
    /// wants a new one.
    fn earlier(&self, records: &RecordSet) -> Vec<Vec<usize>> {
        let kept: Option<Groups> =
            serde_json::from_slice(&self.suite.store().read_or_empty(names::SELECTION_GROUPS)).ok();
        let is_of_this = |kept: &Groups| kept.format == GROUPS_FORMAT && kept.chosen_by == self.chosen_by();
        let Some(kept) = kept.filter(is_of_this).filter(|_| !self.suite.permissions().reselect) else {
            return Vec::new();
        };
        let at: BTreeMap<String, usize> = names_of(records).into_iter().zip(0..).collect();
        // A pick that is gone stays as a place that no record has, so that its group is known to have none.
        let place = |(number, name): (usize, &String)| match at.get(name) {
            None if number == 0 => Some(usize::MAX),
            found => found.copied(),
        };
        kept.groups.iter().map(|group| group.iter().enumerate().filter_map(place).collect()).collect()
    }
}

/// A name for each record: its reference, and which of those that share it.
fn names_of(records: &RecordSet) -> Vec<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let mut name = |record: &CrashRecord| {
        let id = record.id.to_string();
        let times = seen.entry(id.clone()).or_default();
        *times += 1;
        format!("{id}#{times}")
    };
    records.records.iter().map(&mut name).collect()
}

fn bad_choice(error: SelectError) -> PipelineError {
    PipelineError::bad_input(error.to_string())
}

/// Runs the stage.
pub(super) fn run(work: &StageWork) -> Result<StageReport, PipelineError> {
    let choice = Choice::new(work.suite)?;
    if work.suite.permissions().reselect {
        // The same records gave other picks where an earlier choice was there to go on from.
        work.suite.outdate(Stage::Select.name());
    }
    let mut report = work.whole(&choice.inputs, || {
        let (records, embedding, kept) = choice.read()?;
        let embedding = for_strategy(&embedding, &records, choice.options.strategy);
        let earlier = choice.earlier(&records);
        let options = choice.within(&records);
        let outcome = select_onward(&records, work.suite.profile(), &options, &embedding, &earlier);
        let Outcome { mut value, mut diagnostics } = outcome.map_err(bad_choice)?;
        if work.suite.options().invent {
            diagnostics.extend(invent::add(&mut value, &records));
        }
        let mut files = vec![
            (names::SELECTION.into(), to_json(&value)),
            (names::SELECTION_REMARKS.into(), to_json(&diagnostics)),
            (names::SELECTION_GROUPS.into(), to_compact_json(&choice.groups(&records, &value))),
        ];
        files.extend(kept.write().map(|bytes| (names::EMBEDDING.into(), bytes)));
        Ok(files)
    })?;
    report.diagnostics = choice.remarks;
    let told: Vec<Diagnostic> = work.suite.store().read_json(names::SELECTION_REMARKS)?;
    report.diagnostics.extend(told);
    Ok(report)
}

impl Suite {
    /// Repeats the selection under `seeds` seeds with every strategy, and at many budgets; kept in the suite until the
    /// inputs change.
    ///
    /// # Errors
    /// As of the stages records and select, and where `seeds` is below 2.
    pub fn study_selection(&self, seeds: usize) -> Result<SelectionStudy, PipelineError> {
        let choice = Choice::new(self)?;
        let mut inputs = choice.inputs.clone();
        inputs.push(seeds.to_string());
        self.in_pool(|| {
            self.unit(&Work { name: "study", inputs: &inputs, editable: &[] }, || {
                let study = choice.study(seeds)?;
                Ok(vec![(names::SELECTION_STUDY.into(), to_json(&study))])
            })
        })?;
        self.store().read_json(names::SELECTION_STUDY)
    }
}

impl Choice<'_> {
    fn study(&self, seeds: usize) -> Result<SelectionStudy, PipelineError> {
        let (records, plain, _) = self.read()?;
        let profile = self.suite.profile();
        let within = self.within(&records);
        let of_strategy = |&strategy: &Strategy| {
            let embedding = for_strategy(&plain, &records, strategy);
            let options = SelectOptions { strategy, ..within.clone() };
            let stability = stability(&records, profile, &options, &embedding, seeds)?;
            Ok(StrategyStudy { strategy, stability })
        };
        let strategies = Strategy::ALL.par_iter().map(of_strategy).collect::<Result<_, _>>().map_err(bad_choice)?;

        let embedding = for_strategy(&plain, &records, self.options.strategy);
        let mut tried: Vec<usize> = BUDGETS.into_iter().filter(|&budget| budget < records.usable.len()).collect();
        tried.push(within.budget);
        tried.sort_unstable();
        tried.dedup();
        let rows =
            tried.par_iter().map(|&budget| budget_table(&records, profile, &self.options, &embedding, &[budget]));
        let rows: Vec<Vec<BudgetRow>> = rows.collect::<Result<_, _>>().map_err(bad_choice)?;
        let budgets: Vec<BudgetRow> = rows.into_iter().flatten().collect();
        let silhouettes = budgets.iter().filter_map(|row| Some((row.budget, row.silhouette?)));
        let best = silhouettes.reduce(|best, row| if row.1 > best.1 { row } else { best });
        Ok(SelectionStudy {
            format: STUDY_FORMAT.to_owned(),
            embedding: embedding.name().to_owned(),
            strategies,
            elbow: elbow(&budgets),
            best_silhouette: best.map(|(budget, _)| budget),
            budgets,
        })
    }
}
