//! The second stage: records to picks; and studies of the choice.

use super::{StageReport, StageWork, cases, names};
use crate::embedding::{Embeds, KeptRows, for_strategy};
use crate::error::PipelineError;
use crate::store::to_json;
use crate::suite::{Stage, Suite, Work};
use rayon::prelude::*;
use recrash_model::record::RecordSet;
use recrash_model::selection::{BudgetRow, Stability, Strategy};
use recrash_model::{Diagnostic, Outcome};
use recrash_select::{Embedding, SelectError, SelectOptions, budget_table, elbow, select_with, stability};
use serde::{Deserialize, Serialize};

/// Format tag of [`SelectionStudy`].
const STUDY_FORMAT: &str = "recrash.selection-study/1";

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
            budget: chosen.budget,
            seed: suite.seed().child("select"),
            dimensions: chosen.dimensions,
            template_weight: chosen.template_weight,
            weighting: chosen.weighting,
            restarts: chosen.restarts,
        };
        let profile = cases::text_of(suite.profile());
        let inputs = vec![records, profile, format!("{options:?}"), embeds.fingerprint().to_owned()];
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

fn bad_choice(error: SelectError) -> PipelineError {
    PipelineError::bad_input(error.to_string())
}

/// Runs the stage.
pub(super) fn run(work: &StageWork) -> Result<StageReport, PipelineError> {
    let choice = Choice::new(work.suite)?;
    let mut report = work.whole(&choice.inputs, || {
        let (records, embedding, kept) = choice.read()?;
        let embedding = for_strategy(&embedding, &records, choice.options.strategy);
        let outcome = select_with(&records, work.suite.profile(), &choice.options, &embedding);
        let Outcome { value, diagnostics } = outcome.map_err(bad_choice)?;
        let mut files =
            vec![(names::SELECTION.into(), to_json(&value)), (names::SELECTION_REMARKS.into(), to_json(&diagnostics))];
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
        let of_strategy = |&strategy: &Strategy| {
            let embedding = for_strategy(&plain, &records, strategy);
            let options = SelectOptions { strategy, ..self.options.clone() };
            let stability = stability(&records, profile, &options, &embedding, seeds)?;
            Ok(StrategyStudy { strategy, stability })
        };
        let strategies = Strategy::ALL.par_iter().map(of_strategy).collect::<Result<_, _>>().map_err(bad_choice)?;

        let embedding = for_strategy(&plain, &records, self.options.strategy);
        let mut tried: Vec<usize> = BUDGETS.into_iter().filter(|&budget| budget < records.usable.len()).collect();
        tried.push(self.options.budget);
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
