//! Wires the stages, and owns everything outside them: files, the clock, the environment, threads.
//!
//! [`Suite`] is a folder on disk with one stage after the other in it. [`Suite::run_stage`] runs one, reading what the
//! stages before wrote; a unit of work whose inputs have not changed is skipped, and what is written is written whole.
//! So a run killed at any moment goes on where it stopped, and ends with the same bytes.
//!
//! What this crate does **not** do: it prints nothing. Progress is told through [`Progress`], results are values.

mod agents;
mod bench_sim;
mod caches;
mod doctor;
mod embed_bench;
mod embedding;
mod error;
mod evaluation;
mod exporting;
mod external;
mod fetching;
mod importing;
mod journal;
mod judging;
mod ledger;
mod models;
mod options;
mod parity;
mod profiles;
mod progress;
mod prompting;
mod recording;
mod responses;
mod scenario_files;
mod scoring;
mod secrets;
mod simulator;
mod stages;
mod store;
mod suite;
#[cfg(feature = "parquet")]
mod sweep;
mod weights;

pub use agents::{AgentLog, Cast};
pub use bench_sim::{SimBench, SimBenchRequest, bench_sim};
pub use doctor::{DoctorItem, DoctorRequest, State as DoctorState, doctor};
pub use embed_bench::{BenchSide, EmbedBench, EmbedBenchRequest, bench_embedding};
pub use embedding::EmbeddingKind;
pub use error::PipelineError;
pub use evaluation::{Disagreement, Evaluation, EvaluationRequest, Field, FieldScore, Half, HalfScore, evaluate};
pub use exporting::{ExportReport, ExportRequest, export};
pub use external::{EGO_COMMAND_PREFIX, EgoCommand, EgoFault, ExternalEgo, Patience};
pub use fetching::{CrashKind, FetchRequest, Fetched, PublishedEdition, fetch};
pub use importing::{ImportRequest, Imported, SourceFormat, import};
pub use judging::run_scenario;
pub use ledger::{LedgerReport, ModelSum, Sum as LedgerSum, ledger};
pub use models::{AnswerMode, ModelAccess};
pub use options::{Options, RecordSource};
pub use parity::{
    Agreement, Apart, GAP_TOLERANCE_M, OpenLoop, OpenLoopLimit, OpenLoopRequest, Pair, PairOutcome, Parity,
    ParityRequest, ParitySource, ParityTable, TIME_TOLERANCE_S, Threshold, open_loop, parity, random_scenario,
};
pub use profiles::{PROFILE_NAMES, load_profile};
pub use progress::{NoProgress, Progress, ProgressEvent};
pub use prompting::{Prompt, PromptRequest, prompt};
pub use recording::{TableFormat, read_records, write_records};
pub use recrash_agents::llm::{Caps, Role, Spent};
pub use recrash_child::end_all as end_programs;
pub use recrash_export::{Format, PartnersAs};
pub use recrash_fetch::Limits as FetchLimits;
pub use recrash_model::run::JudgedRun;
pub use recrash_records::{Distribution, FILTER_HELP, TableRows, distributions};
pub use recrash_roads::scenario_schema as schema;
pub use scenario_files::{FileRequest, FileRun, read_scenario, simulate_file};
pub use simulator::{Simulator, SimulatorKind, check_choices, start_simulator};
pub use stages::{
    CaseSummary, DesignAttempt, DesignLog, Failure, FallbackReason, ModelSummary, RunSummary, SelectionStudy,
    StageReport, StrategyStudy, Summary,
};
pub use store::{Store, WriteFile, remove_unfinished};
pub use suite::{Permissions, Resources, Stage, Suite};
#[cfg(feature = "parquet")]
pub use sweep::{Sweep, SweepRequest, SweepSummary, SweptScenario, Vary, write_scenario};
pub use weights::{PullRequest, Pulled, Weights, WeightsSource, find_weights, is_published_model, pull_model};
