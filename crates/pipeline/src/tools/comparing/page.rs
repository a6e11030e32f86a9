//! The page of a comparison: what changed, and both egos in one scene.

use crate::error::PipelineError;
use crate::files::output::Output;
use crate::files::paths::quoted;
use crate::simulators::SimulatorKind;
use crate::tools::testing::{Bench, TestRequest};
use rayon::prelude::*;
use recrash_lab::run_scenario;
use recrash_model::comparison::{Change, Compared, Comparison, TypeRow, shown_p};
use recrash_report::{PairView, PairsView, RunTrace, TableView};
use recrash_roads::{Scenario, Simulator};
use std::path::{Path, PathBuf};

/// Tests that the page plays, the gravest changes first.
const PLAYED: usize = 30;

/// Both egos, set up to drive again: results hold no tracks.
pub struct PageRequest {
    /// The frozen suite, how programs are waited for, and the threads; the ego is not used.
    pub test: TestRequest,
    /// Egos of both sides where they are programs: those that only a results file names are not started.
    pub egos: [Option<String>; 2],
    /// The results, as they were named.
    pub results: [PathBuf; 2],
}

impl PageRequest {
    /// The command that makes the page again.
    fn command(&self, page: &Output) -> String {
        let word = |path: &Path| quoted(&path.to_string_lossy());
        let [base, new] = self.results.each_ref().map(|path| word(path));
        let mut command =
            format!("recrash compare {base} {new} --suite {} --page {}", word(&self.test.frozen), word(page.name()));
        for (option, ego) in ["--base-ego", "--new-ego"].into_iter().zip(&self.egos) {
            if let Some(ego) = ego {
                command.push_str(&format!(" {option} {}", quoted(ego)));
            }
        }
        command
    }
}

/// Writes the page.
///
/// # Errors
/// The suite cannot be opened, an ego cannot be started or fails, or the file cannot be written.
pub fn write_page(request: &PageRequest, comparison: &Comparison, output: &Output) -> Result<(), PipelineError> {
    let bench = |side: usize| -> Result<Bench, PipelineError> {
        let named = request.egos[side].clone();
        let told = &comparison.egos[side];
        crate::suite::refuse_untrusted(told, named.is_some())?;
        let ego = Some(named.unwrap_or_else(|| told.clone()));
        Bench::set_up(&TestRequest { ego, simulator: SimulatorKind::Native, ..request.test.clone() })
    };
    let benches = [bench(0)?, bench(1)?];
    let changed: Vec<&Compared> = Change::ALL
        .into_iter()
        .filter(|change| {
            use Change::{Better, Broken, Fixed, Flaky, Unmet, Worse};
            matches!(change, Broken | Worse | Fixed | Better | Flaky | Unmet)
        })
        .flat_map(|change| comparison.of(change))
        .collect();
    let suite = &benches[0].opened;
    let pair = |test: &&Compared| -> Option<Result<PairView, PipelineError>> {
        let at = suite.suite.tests.iter().position(|known| known.id == test.id)?;
        Some(play(test, &suite.scenarios[at], &benches))
    };
    let shown = &changed[..changed.len().min(PLAYED)];
    let pairs = benches[0].threads.install(|| shown.par_iter().filter_map(pair).collect::<Result<Vec<_>, _>>())?;
    let view = PairsView {
        title: format!("{} against {}", comparison.egos[1], comparison.egos[0]),
        generated_by: format!("recrash {}", env!("CARGO_PKG_VERSION")),
        command: request.command(output),
        names: comparison.egos.clone(),
        criteria: benches[0].profile().failure.clone(),
        tables: vec![types(comparison)],
        pairs,
        more: changes(&changed[shown.len()..]),
    };
    output.write(recrash_report::pairs_html(&view).as_bytes())
}

fn play(test: &Compared, scenario: &Scenario, benches: &[Bench; 2]) -> Result<PairView, PipelineError> {
    let trace = |bench: &Bench| -> Result<RunTrace, PipelineError> {
        let simulator: &dyn Simulator = &*bench.simulator;
        let run = run_scenario(scenario, simulator, bench.profile(), None)?;
        Ok(RunTrace { series: recrash_metrics::series(&run.rollout), run })
    };
    Ok(PairView {
        title: test.id.clone(),
        remark: format!("{}: {}", test.change.label(), test.why),
        drawing: scenario.drawing(),
        first: trace(&benches[0])?,
        second: Some(trace(&benches[1])?),
    })
}

fn types(comparison: &Comparison) -> TableView {
    let used: Vec<Change> =
        Change::ALL.into_iter().filter(|change| comparison.all.changes.contains_key(change)).collect();
    let fixed = ["crash type", "tests", "failed before", "failed now"].map(str::to_owned);
    let row = |row: &TypeRow| {
        let counts = [row.tests, row.base_failed, row.new_failed];
        let changes = used.iter().map(|change| row.changes.get(change).copied().unwrap_or(0));
        let numbers = counts.into_iter().chain(changes).map(|count| count.to_string());
        std::iter::once(row.crash_type.to_owned()).chain(numbers).chain([shown_p(row.p)]).collect()
    };
    TableView {
        caption: format!(
            "{}. By crash type; p is McNemar's of broken against fixed",
            recrash_report::comparison::sentence(comparison)
        ),
        header: fixed
            .into_iter()
            .chain(used.iter().map(|change| change.label().to_owned()))
            .chain(["p".to_owned()])
            .collect(),
        rows: comparison.by_type.iter().chain([&comparison.all]).map(row).collect(),
    }
}

/// What changed and is not played.
fn changes(changed: &[&Compared]) -> Option<TableView> {
    let row = |test: &&Compared| vec![test.id.clone(), test.change.label().to_owned(), test.why.clone()];
    (!changed.is_empty()).then(|| TableView {
        caption: format!("{} more that changed, not played on this page", changed.len()),
        header: ["test", "change", "what"].map(str::to_owned).to_vec(),
        rows: changed.iter().map(row).collect(),
    })
}
